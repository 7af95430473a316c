//! Readers that know the formats and nothing of the writers.

use std::collections::BTreeMap;

use forcewright_base::maths;
use forcewright_fabricate::{Format, Options, write};
use forcewright_model::Part;

pub(crate) fn bytes(part: &Part, format: Format) -> Vec<u8> {
    write(part, format, &Options::default()).unwrap()
}

pub(crate) fn text(part: &Part, format: Format) -> String {
    String::from_utf8(bytes(part, format)).unwrap()
}

/// A corner of a polyline: x, y, and the bulge of what follows.
pub(crate) type Corner = [f64; 3];

/// The polylines of a drawing, which must be closed, and the radii of its circles.
pub(crate) fn dxf(text: &str) -> (Vec<Vec<Corner>>, Vec<f64>) {
    let lines: Vec<&str> = text.lines().collect();
    let (mut polylines, mut radii, mut kind) = (Vec::<Vec<Corner>>::new(), Vec::new(), "");
    for pair in lines.chunks_exact(2) {
        let value = || pair[1].parse::<f64>().unwrap();
        match (kind, pair[0]) {
            (_, "0") => {
                kind = pair[1];
                if kind == "LWPOLYLINE" {
                    polylines.push(Vec::new());
                }
            }
            ("LWPOLYLINE", "70") => assert_eq!(pair[1], "1", "an open polyline"),
            ("LWPOLYLINE", "10") => polylines.last_mut().unwrap().push([value(), 0.0, 0.0]),
            ("LWPOLYLINE", "20") => polylines.last_mut().unwrap().last_mut().unwrap()[1] = value(),
            ("LWPOLYLINE", "42") => polylines.last_mut().unwrap().last_mut().unwrap()[2] = value(),
            ("CIRCLE", "40") => radii.push(value()),
            _ => {}
        }
    }
    (polylines, radii)
}

fn sides(corners: &[Corner]) -> impl Iterator<Item = (&Corner, &Corner)> {
    corners.iter().zip(corners.iter().cycle().skip(1))
}

/// Straight lines between the corners, and what arcs add: `r²/2 (φ − sin φ)`.
pub(crate) fn area_of_bulges(corners: &[Corner]) -> f64 {
    let side = |(a, b): (&Corner, &Corner)| {
        let angle = 4.0 * maths::atan2(a[2], 1.0);
        let chord = maths::hypot(b[0] - a[0], b[1] - a[1]);
        let radius = 0.5 * chord / maths::sin(0.5 * angle);
        let beyond = if a[2].abs() > 0.0 { 0.5 * radius * radius * (angle - maths::sin(angle)) } else { 0.0 };
        0.5 * (a[0] * b[1] - b[0] * a[1]) + beyond
    };
    sides(corners).map(side).sum()
}

/// Number of corners where the direction changes by more than `limit_rad`.
pub(crate) fn kinks(corners: &[Corner], limit_rad: f64) -> usize {
    let ends = |(a, b): (&Corner, &Corner)| {
        let (chord, half) = (maths::atan2(b[1] - a[1], b[0] - a[0]), 2.0 * maths::atan2(a[2], 1.0));
        (chord - half, chord + half)
    };
    let directions: Vec<(f64, f64)> = sides(corners).map(ends).collect();
    let turns = directions.iter().zip(directions.iter().cycle().skip(1)).map(|(one, next)| next.0 - one.1);
    turns.filter(|turn| maths::sin(0.5 * turn).abs() > 0.5 * limit_rad).count()
}

/// What an entity of a STEP file refers to.
pub(crate) fn references(entity: &str) -> Vec<&str> {
    let mut outside =
        entity.split('\'').step_by(2).flat_map(|piece| piece.match_indices('#').map(move |(at, _)| &piece[at..])).collect::<Vec<_>>();
    for reference in &mut outside {
        let digits = reference[1..].find(|c: char| !c.is_ascii_digit()).map_or(reference.len(), |end| end + 1);
        *reference = &reference[..digits];
    }
    outside
}

/// The entities of a STEP file by their numbers.
pub(crate) struct Step<'a> {
    entities: BTreeMap<&'a str, &'a str>,
}

impl<'a> Step<'a> {
    /// Reads a file in which everything that is referred to is there.
    pub(crate) fn new(text: &'a str) -> Self {
        let lines = text.lines().filter_map(|line| line.strip_suffix(';')?.split_once('='));
        let entities: BTreeMap<&str, &str> = lines.filter(|(id, _)| id.starts_with('#')).collect();
        for entity in entities.values() {
            assert!(references(entity).iter().all(|reference| entities.contains_key(reference)), "{entity} refers to nothing");
        }
        Self { entities }
    }

    pub(crate) fn entity(&self, id: &str) -> &'a str {
        self.entities[id]
    }

    pub(crate) fn of_kind(&self, kind: &str) -> Vec<&'a str> {
        self.entities.values().filter(|entity| entity.split('(').next() == Some(kind)).copied().collect()
    }

    fn numbers(&self, id: &str) -> [f64; 3] {
        let (_, list) = self.entity(id).split_once(",(").unwrap();
        let numbers: Vec<f64> = list.trim_end_matches(')').split(',').map(|number| number.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    }

    /// The normal of a plane.
    pub(crate) fn axis(&self, plane: &str) -> [f64; 3] {
        self.numbers(references(self.entity(references(plane)[0]))[1])
    }

    /// Where the edges of a bound begin, in the order in which they are passed.
    pub(crate) fn corners_of_bound(&self, bound: &str) -> Vec<[f64; 3]> {
        let chain = references(self.entity(references(self.entity(bound))[0]));
        let begin = |oriented: &str| {
            let is_forward = self.entity(oriented).ends_with(".T.)");
            let edge = references(self.entity(references(self.entity(oriented))[0]));
            self.numbers(references(self.entity(edge[usize::from(!is_forward)]))[0])
        };
        chain.into_iter().map(begin).collect()
    }
}

/// Unit normal of a polygon in space, by Newell's sums.
pub(crate) fn newell(corners: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        for (axis, sum) in sum.iter_mut().enumerate() {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            *sum += (a[u] - b[u]) * (a[v] + b[v]);
        }
    }
    let length = sum.iter().map(|coordinate| coordinate * coordinate).sum::<f64>().sqrt();
    sum.map(|coordinate| coordinate / length)
}

/// A triangle mesh, with equal corners joined.
pub(crate) struct Mesh {
    pub(crate) normals: Vec<[f32; 3]>,
    corners: Vec<[f32; 3]>,
    faces: Vec<[usize; 3]>,
}

impl Mesh {
    pub(crate) fn of_stl(bytes: &[u8]) -> Self {
        let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
        assert_eq!(bytes.len(), 84 + 50 * count);
        let mut mesh = Self { normals: Vec::new(), corners: Vec::new(), faces: Vec::new() };
        let mut known = BTreeMap::new();
        for triangle in bytes[84..].chunks_exact(50) {
            let number = |at: usize| f32::from_le_bytes(triangle[4 * at..4 * at + 4].try_into().unwrap());
            let vector = |at: usize| [number(at), number(at + 1), number(at + 2)];
            mesh.normals.push(vector(0));
            mesh.faces.push([3, 6, 9].map(|at| {
                let corner = vector(at);
                *known.entry(corner.map(f32::to_bits)).or_insert_with(|| {
                    mesh.corners.push(corner);
                    mesh.corners.len() - 1
                })
            }));
        }
        mesh
    }

    pub(crate) fn of_3mf(bytes: &[u8]) -> Self {
        let model = unpacked(bytes, "3D/3dmodel.model");
        let document = roxmltree::Document::parse(&model).unwrap();
        assert_eq!(document.root_element().attribute("unit"), Some("millimeter"));
        let all = |tag: &'static str| {
            document.descendants().filter(move |node| node.has_tag_name(("http://schemas.microsoft.com/3dmanufacturing/core/2015/02", tag)))
        };
        let corners = all("vertex").map(|node| ["x", "y", "z"].map(|name| node.attribute(name).unwrap().parse().unwrap())).collect();
        let faces = all("triangle").map(|node| ["v1", "v2", "v3"].map(|name| node.attribute(name).unwrap().parse().unwrap())).collect();
        Self { normals: Vec::new(), corners, faces }
    }

    pub(crate) fn triangles(&self) -> impl Iterator<Item = [[f32; 3]; 3]> {
        self.faces.iter().map(|face| face.map(|corner| self.corners[corner]))
    }

    /// Every side is passed once in each direction, and every triangle has an area.
    pub(crate) fn check_closed(&self, name: &str) {
        let mut passes = BTreeMap::new();
        for &[a, b, c] in &self.faces {
            for side in [(a, b), (b, c), (c, a)] {
                *passes.entry(side).or_insert(0) += 1;
            }
        }
        for (&(from, to), &count) in &passes {
            assert!(count == 1 && passes.get(&(to, from)) == Some(&1), "{name}: a side is passed {count} times");
        }
        for [a, b, c] in self.triangles() {
            assert!(normal(a, b, c).iter().all(|coordinate| coordinate.is_finite()), "{name}: a flat triangle {a:?} {b:?} {c:?}");
        }
    }

    /// Corners less sides plus faces.
    pub(crate) fn euler(&self) -> i64 {
        let (corners, faces) = (i64::try_from(self.corners.len()).unwrap(), i64::try_from(self.faces.len()).unwrap());
        corners - faces * 3 / 2 + faces
    }

    /// By the divergence theorem: a sixth of all triple products.
    pub(crate) fn volume_mm3(&self) -> f64 {
        let triple = |[a, b, c]: [[f64; 3]; 3]| {
            a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        self.triangles().map(|corners| triple(corners.map(|corner| corner.map(f64::from)))).sum::<f64>() / 6.0
    }
}

/// Unit normal of a triangle; not finite without an area.
pub(crate) fn normal(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> [f64; 3] {
    let from_a = |p: [f32; 3]| [0, 1, 2].map(|axis| f64::from(p[axis]) - f64::from(a[axis]));
    let (u, v) = (from_a(b), from_a(c));
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    n.map(|coordinate| coordinate / length)
}

/// A stored file of an archive, found by the directory at its end.
fn unpacked(bytes: &[u8], wanted: &str) -> String {
    let short = |at: usize| usize::from(u16::from_le_bytes(bytes[at..at + 2].try_into().unwrap()));
    let long = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let end = bytes.len() - 22;
    assert_eq!(&bytes[end..end + 4], b"PK\x05\x06");
    let (count, mut at) = (short(end + 10), long(end + 16));
    for _ in 0..count {
        assert_eq!(&bytes[at..at + 4], b"PK\x01\x02");
        let (size, name, local) = (long(at + 20), short(at + 28), long(at + 42));
        if &bytes[at + 46..at + 46 + name] == wanted.as_bytes() {
            let content = local + 30 + short(local + 26) + short(local + 28);
            return String::from_utf8(bytes[content..content + size].to_vec()).unwrap();
        }
        at += 46 + name;
    }
    panic!("no {wanted}");
}
