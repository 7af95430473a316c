//! Springs: what their files hold, against the helix that their wire is said to follow.
#![allow(clippy::unwrap_used, reason = "test code, in helpers too")]

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use forcewright_base::maths;
use forcewright_fabricate::{Error, Format, Options, Place, Problem, write};
use forcewright_model::{Body, Coil, CoilEnd, CoilError, Part, Winding};
use proptest::prelude::*;

#[allow(dead_code, unreachable_pub, missing_docs, reason = "shared with an example and other tests, which use all of it")]
mod common;
#[allow(dead_code, clippy::unwrap_used, reason = "test code, shared with other tests")]
mod reading;

use common::springs::{Spring, coil, part_of, springs};
use reading::{Mesh, bytes, text};

fn options(facet_error_m: f64) -> Options {
    Options { facet_error_m, ..Options::default() }
}

/// Springs of one pitch, cut at both ends: wire, mean radius, pitch (mm), turns, hand, start.
fn plain() -> Vec<Part> {
    let of = |name: &str, [wire, radius, pitch, turns, start]: [f64; 5], is_right_handed| {
        let coil = coil(1e-3 * wire, 1e-3 * radius, vec![Winding::even(turns, 1e-3 * pitch)], start, [CoilEnd::Cut; 2]);
        part_of(name, Coil { is_right_handed, ..coil })
    };
    vec![
        of("close", [1.0, 6.0, 1.1, 3.7, 0.3], true),
        of("left", [0.8, 4.0, 1.0, 2.4, -1.0], false),
        of("open", [1.5, 5.0, 6.0, 3.2, 2.0], true),
        of("steep", [2.0, 4.0, 40.0, 1.4, 0.0], true),
    ]
}

/// The textbook helix, mm: middle of the wire at an angle from its begin, and its derivative.
fn helix(coil: &Coil, angle: f64) -> ([f64; 3], [f64; 3]) {
    let (radius, rise) = (1e3 * coil.radius_m, 1e3 * coil.windings[0].pitch_m[0] / TAU);
    let hand = if coil.is_right_handed { 1.0 } else { -1.0 };
    let (sin, cos) = maths::sin_cos(hand * angle + coil.start_rad);
    ([radius * cos, radius * sin, rise * angle], [-hand * radius * sin, hand * radius * cos, rise])
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt()
}

/// Distance of a point from the helix, mm, by halving steps from the nearest of many places; and where along it.
fn from_helix(coil: &Coil, point: [f64; 3]) -> (f64, f64) {
    let last = TAU * coil.turns();
    let at = |angle: f64| apart(helix(coil, angle).0, point);
    let count = 60.0 * coil.turns().ceil();
    let mut best = (f64::MAX, 0.0);
    let mut k = 0.0;
    while k <= count {
        let angle = last * k / count;
        best = if at(angle) < best.0 { (at(angle), angle) } else { best };
        k += 1.0;
    }
    let mut step = last / count;
    while step > 1e-11 {
        let (low, high) = ((best.1 - step).max(0.0), (best.1 + step).min(last));
        if at(low) < best.0 {
            best = (at(low), low);
        } else if at(high) < best.0 {
            best = (at(high), high);
        } else {
            step *= 0.5;
        }
    }
    best
}

#[test]
fn meshes_are_closed_and_hold_the_volume() {
    for Spring { part, volume_m3, surface_m2, .. } in springs() {
        assert!((part.volume_m3() / volume_m3 - 1.0).abs() < 1e-13, "{}", part.name);
        assert!((part.mass_kg().unwrap() / (7850.0 * volume_m3) - 1.0).abs() < 1e-13);
        assert!((part.coil().unwrap().surface_m2() / surface_m2 - 1.0).abs() < 1e-13);
        for facet_error_m in [5e-5, 5e-6] {
            let mesh = Mesh::of_stl(&write(&part, Format::Stl, &options(facet_error_m)).unwrap());
            let packed = Mesh::of_3mf(&write(&part, Format::ThreeMf, &options(facet_error_m)).unwrap());
            assert_eq!(mesh.triangles().collect::<Vec<_>>(), packed.triangles().collect::<Vec<_>>(), "{}", part.name);
            mesh.check_closed(&part.name);
            assert_eq!(mesh.euler(), 2, "{}", part.name);
            let error = mesh.volume_mm3() - volume_m3 * 1e9;
            assert!(error < 0.0 && error > -(facet_error_m * 1e3 + 1e-5) * surface_m2 * 1e6, "{}: {error}", part.name);
        }
    }
}

/// What facets take off a volume falls with the error that they are allowed.
#[test]
fn volumes_converge() {
    for Spring { part, volume_m3, .. } in springs() {
        let missing = |facet_error_m: f64| {
            1.0 - Mesh::of_stl(&write(&part, Format::Stl, &options(facet_error_m)).unwrap()).volume_mm3() / (1e9 * volume_m3)
        };
        let ratio = missing(1.6e-5) / missing(4e-6);
        assert!((ratio / 4.0 - 1.0).abs() < 0.2, "{}: {ratio}", part.name);
    }
}

/// Corners lie on the wire, and middles of sides and of triangles as near as was promised; somewhere hardly nearer.
#[test]
fn facets_lie_as_near_as_promised() {
    for facet_error_m in [5e-5, 2e-5] {
        let allowed = 1e3 * facet_error_m;
        let mut worst: f64 = 0.0;
        for part in plain() {
            let coil = part.coil().unwrap();
            let (radius, last) = (500.0 * coil.wire_m, TAU * coil.turns());
            let mesh = Mesh::of_stl(&write(&part, Format::Stl, &options(facet_error_m)).unwrap());
            for [a, b, c] in mesh.triangles().map(|t| t.map(|corner| corner.map(f64::from))).step_by(7) {
                let on = from_helix(coil, a).0;
                assert!((on - radius).abs() < 1e-5, "{}: a corner {on} mm from the middle", part.name);
                let mean = |weights: [f64; 3]| [0, 1, 2].map(|k| weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k]);
                for weights in [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [1.0 / 3.0; 3]] {
                    let (distance, angle) = from_helix(coil, mean(weights));
                    // Not on the ends.
                    if angle > 1e-6 && angle < last - 1e-6 {
                        worst = worst.max((distance - radius).abs());
                    }
                }
            }
        }
        assert!(worst < allowed + 1e-5 && worst > 0.5 * allowed, "{worst} mm, allowed {allowed} mm");
    }
}

/// Where a half plane through the axis cuts a mesh: for each closed cut its area, the height of its centroid, and least and greatest radius.
fn cuts(mesh: &Mesh, angle: f64) -> Vec<[f64; 4]> {
    let (sin, cos) = maths::sin_cos(angle);
    let mut chords: Vec<[[f64; 2]; 2]> = Vec::new();
    for corners in mesh.triangles().map(|t| t.map(|c| c.map(f64::from))) {
        let side = |p: [f64; 3]| p[1] * cos - p[0] * sin;
        let mut ends = [[0.0; 2]; 2];
        let mut found = 0;
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            if (side(a) < 0.0) != (side(b) < 0.0) {
                let share = side(a) / (side(a) - side(b));
                let at = [0, 1, 2].map(|x| a[x] + share * (b[x] - a[x]));
                ends[usize::from(side(a) < 0.0)] = [at[2], at[0] * cos + at[1] * sin];
                found += 1;
            }
        }
        if found == 2 && ends[0][1] > 0.0 {
            chords.push(ends);
        }
    }
    // Cuts of turns lie one above the other, with gaps between.
    chords.sort_by(|a, b| a[0][0].min(a[1][0]).total_cmp(&b[0][0].min(b[1][0])));
    let mut groups: Vec<Vec<[[f64; 2]; 2]>> = Vec::new();
    let mut top = f64::NEG_INFINITY;
    for chord in chords {
        if chord[0][0].min(chord[1][0]) > top {
            groups.push(Vec::new());
        }
        top = top.max(chord[0][0].max(chord[1][0]));
        groups.last_mut().unwrap().push(chord);
    }
    let measures = |group: Vec<[[f64; 2]; 2]>| {
        let [mut area, mut first, mut low, mut high] = [0.0, 0.0, f64::MAX, 0.0_f64];
        // From a point nearby, lest sums cancel.
        let z = group[0][0][0];
        for [[a, b], [c, d]] in group {
            let part = 0.5 * ((a - z) * d - (c - z) * b);
            area += part;
            first += part * (a + c - 2.0 * z) / 3.0;
            low = f64::min(low, b.min(d));
            high = high.max(b.max(d));
        }
        [area.abs(), z + first / area, low, high]
    };
    groups.into_iter().map(measures).collect()
}

/// Mean radius, pitch, hand and start of the middle of the wire, as they can be measured on the mesh: half planes cut a helical tube in
/// shapes that are symmetric about the height of its middle, between R − d/2 and R + d/2.
#[test]
fn the_middle_of_the_wire_is_measured() {
    for part in plain().into_iter().take(3) {
        let coil = part.coil().unwrap();
        let mesh = Mesh::of_stl(&write(&part, Format::Stl, &options(1e-6)).unwrap());
        for angle in [0.9, 2.5, 4.0, 5.5] {
            let hand = if coil.is_right_handed { 1.0 } else { -1.0 };
            // Not where the plane meets an end.
            let first = (hand * (angle - coil.start_rad)).rem_euclid(TAU);
            let pitch = 1e3 * coil.windings[0].pitch_m[0];
            let found = cuts(&mesh, angle);
            let wanted: Vec<f64> = (0..4).map(|k| (first / TAU + f64::from(k)) * pitch).filter(|z| *z < pitch * coil.turns()).collect();
            assert_eq!(found.len(), wanted.len(), "{}", part.name);
            for ([area, z, low, high], wanted) in found.into_iter().zip(wanted) {
                if wanted < 0.3 * pitch || wanted > pitch * (coil.turns() - 0.3) {
                    continue;
                }
                assert!((z - wanted).abs() < 1e-3, "{}: {z} for {wanted}", part.name);
                assert!((0.5 * (low + high) - 1e3 * coil.radius_m).abs() < 2e-3 && (high - low - 1e3 * coil.wire_m).abs() < 4e-3);
                let lead = maths::atan2(pitch, TAU * 1e3 * coil.radius_m);
                let across = 0.25e6 * PI * coil.wire_m * coil.wire_m / maths::cos(lead);
                assert!((area / across - 1.0).abs() < 2e-2, "{}: {area} for {across}", part.name);
            }
        }
    }
}

/// The corners of a mesh as numbers to be compared.
fn corners(mesh: &Mesh, change: impl Fn([f32; 3]) -> [f32; 3]) -> BTreeSet<[u32; 3]> {
    mesh.triangles().flatten().map(|corner| change(corner).map(|x| (x + 0.0).to_bits())).collect()
}

#[test]
fn the_other_hand_is_the_mirror_image() {
    for Spring { part, .. } in springs() {
        let mut other = part.clone();
        if let Body::Coil(coil) = &mut other.body {
            (coil.is_right_handed, coil.start_rad) = (!coil.is_right_handed, -coil.start_rad);
        }
        let [mesh, image] = [&part, &other].map(|part| Mesh::of_stl(&bytes(part, Format::Stl)));
        assert!(corners(&mesh, |c| c) == corners(&image, |[x, y, z]| [x, -y, z]), "{}", part.name);
        assert!(corners(&mesh, |c| c) != corners(&image, |c| c), "{}", part.name);
    }
}

#[test]
fn solids_are_closed_shells() {
    for Spring { part, faces, .. } in springs() {
        let file = text(&part, Format::Step);
        let step = reading::Step::new(&file);
        assert_eq!((step.of_kind("MANIFOLD_SOLID_BREP").len(), step.of_kind("CLOSED_SHELL").len()), (1, 1));
        assert_eq!(step.of_kind("ADVANCED_FACE").len(), faces, "{}", part.name);
        let oriented = step.of_kind("ORIENTED_EDGE");
        let passed: BTreeSet<(&str, bool)> =
            oriented.iter().map(|entity| (*reading::references(entity).last().unwrap(), entity.ends_with(".T.)"))).collect();
        let edges = step.of_kind("EDGE_CURVE").len();
        assert_eq!((oriented.len(), passed.len()), (2 * edges, 2 * edges), "{}", part.name);
        let count = |kind| i64::try_from(step.of_kind(kind).len()).unwrap();
        assert_eq!(count("VERTEX_POINT") - count("EDGE_CURVE") + count("ADVANCED_FACE"), 2, "{}", part.name);
        assert_eq!(count("PLANE"), 2);
    }
}

/// The textbook sum over basis functions of degree 5 with clamped knots 0, 1, 2, … (Cox and de Boor).
fn basis(count: usize, i: usize, degree: usize, t: f64) -> f64 {
    let last = count - 5;
    let knot = |k: usize| k.saturating_sub(5).min(last) as f64;
    if degree == 0 {
        return f64::from(u8::from(knot(i) <= t && t < knot(i + 1)));
    }
    let share = |above: f64, span: f64, lower: usize| if span > 0.0 { above / span * basis(count, lower, degree - 1, t) } else { 0.0 };
    share(t - knot(i), knot(i + degree) - knot(i), i) + share(knot(i + degree + 1) - t, knot(i + degree + 1) - knot(i + 1), i + 1)
}

/// Control points and weights of a rational surface, row by row.
fn net(step: &reading::Step<'_>, surface: &str) -> Vec<Vec<([f64; 3], f64)>> {
    let between = |text: &str, from: &str| text.split_once(from).unwrap().1.split_once("))").unwrap().0.to_owned();
    let point = |id: &str| -> [f64; 3] {
        let list = step.entity(id).split_once(",(").unwrap().1.trim_end_matches(')');
        list.split(',').map(|number| number.parse().unwrap()).collect::<Vec<f64>>().try_into().unwrap()
    };
    let points = between(surface, "B_SPLINE_SURFACE(3,5,((");
    let weights = between(surface, "RATIONAL_B_SPLINE_SURFACE(((").replace("((", "");
    let row = |(points, weights): (&str, &str)| points.split(',').map(point).zip(weights.split(',').map(|w| w.parse().unwrap())).collect();
    points.split("),(").zip(weights.split("),(")).map(row).collect()
}

/// 10⁻⁷ mm, and what twelve decimals leave.
#[test]
fn surfaces_of_solids_follow_the_wire() {
    let mut worst: f64 = 0.0;
    for part in plain() {
        let coil = part.coil().unwrap();
        let file = text(&part, Format::Step);
        let step = reading::Step::new(&file);
        let surfaces: Vec<&str> = step.of_kind("").into_iter().filter(|entity| entity.contains("RATIONAL_B_SPLINE_SURFACE")).collect();
        assert_eq!(surfaces.len() + 2, step.of_kind("ADVANCED_FACE").len());
        for surface in surfaces {
            let net = net(&step, surface);
            let along = net[0].len();
            for (k, l) in (0..9).flat_map(|k| (0..24).map(move |l| (k, l))) {
                let (u, v) = (f64::from(k) / 8.0, (f64::from(l) + 0.37) / 24.0 * (along - 5) as f64);
                let bernstein = [(1.0 - u) * (1.0 - u) * (1.0 - u), 3.0 * u * (1.0 - u) * (1.0 - u), 3.0 * u * u * (1.0 - u), u * u * u];
                let (mut point, mut weight) = ([0.0; 3], 0.0);
                for (row, a) in net.iter().zip(bernstein) {
                    for (i, (control, w)) in row.iter().enumerate() {
                        let b = if (i as f64 - v).abs() < 8.0 { basis(along, i, 5, v) } else { 0.0 };
                        weight += a * b * w;
                        (0..3).for_each(|axis| point[axis] += a * b * w * control[axis]);
                    }
                }
                worst = worst.max((from_helix(coil, point.map(|x| x / weight)).0 - 500.0 * coil.wire_m).abs());
            }
        }
    }
    assert!(worst <= 1e-7 && worst > 1e-10, "{worst} mm");
}

/// The open polylines of a layer of a drawing, and the radii of its circles.
fn drawn(drawing: &str, layer: &str) -> (Vec<Vec<[f64; 2]>>, Vec<f64>) {
    let lines: Vec<&str> = drawing.lines().collect();
    let (mut chains, mut radii) = (Vec::<Vec<[f64; 2]>>::new(), Vec::new());
    let (mut kind, mut is_here) = ("", false);
    for pair in lines.chunks_exact(2) {
        match (kind, pair[0]) {
            (_, "0") => (kind, is_here) = (pair[1], false),
            (_, "8") => {
                is_here = pair[1] == layer;
                if is_here && kind == "LWPOLYLINE" {
                    chains.push(Vec::new());
                }
            }
            ("LWPOLYLINE", "70") if is_here => assert_eq!(pair[1], "0", "a closed polyline"),
            ("LWPOLYLINE", "10") if is_here => chains.last_mut().unwrap().push([pair[1].parse().unwrap(), 0.0]),
            ("LWPOLYLINE", "20") if is_here => chains.last_mut().unwrap().last_mut().unwrap()[1] = pair[1].parse().unwrap(),
            ("CIRCLE", "40") if is_here => radii.push(pair[1].parse().unwrap()),
            _ => {}
        }
    }
    (chains, radii)
}

/// A place of the middle of the wire: z, x, depth towards the eye, and its direction in the picture.
struct Spot {
    at: [f64; 2],
    depth: f64,
    heading: [f64; 2],
}

/// Whether a ball of a radius about some place covers a point before a depth.
fn is_covered(places: &[Spot], radius: f64, at: [f64; 2], depth: f64) -> bool {
    places.iter().any(|place| {
        let left = radius * radius - (at[0] - place.at[0]) * (at[0] - place.at[0]) - (at[1] - place.at[1]) * (at[1] - place.at[1]);
        left > 0.0 && place.depth + left.sqrt() > depth
    })
}

fn from_chains(chains: &[Vec<[f64; 2]>], point: [f64; 2]) -> f64 {
    let one = |pair: &[[f64; 2]]| {
        let (u, v) = ([pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]], [point[0] - pair[0][0], point[1] - pair[0][1]]);
        let share = ((u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1])).clamp(0.0, 1.0);
        maths::hypot(v[0] - share * u[0], v[1] - share * u[1])
    };
    chains.iter().flat_map(|chain| chain.windows(2).map(one)).fold(f64::MAX, f64::min)
}

/// Lines of the side view against balls along the textbook helix: what is drawn is a contour that nothing covers, and every contour that
/// nothing comes near to covering is drawn.
#[test]
fn drawings_show_what_is_seen() {
    for part in plain() {
        let coil = part.coil().unwrap();
        let drawing = text(&part, Format::Dxf);
        let (chains, _) = drawn(&drawing, "OUTLINE");
        let radius = 500.0 * coil.wire_m;
        let last = TAU * coil.turns();
        let count = 1500.0 * coil.turns().ceil();
        let mut places = Vec::new();
        let mut k = 0.0;
        while k <= count {
            let ([x, y, z], [u, _, w]) = helix(coil, last * k / count);
            let length = maths::hypot(u, w);
            places.push(Spot { at: [z, x], depth: y, heading: [w / length, u / length] });
            k += 1.0;
        }
        let ends = [&places[0], &places[places.len() - 1]].map(|place| place.at);
        let is_at_end = |p: [f64; 2]| ends.iter().any(|e| maths::hypot(p[0] - e[0], p[1] - e[1]) < 1.1 * radius);
        for point in chains.iter().flatten().step_by(3).copied().filter(|p| !is_at_end(*p)) {
            let is_contour = |place: &&Spot| {
                let off = [point[0] - place.at[0], point[1] - place.at[1]];
                (maths::hypot(off[0], off[1]) - radius).abs() < 2e-3
                    && (off[0] * place.heading[0] + off[1] * place.heading[1]).abs() < 0.2 * radius
            };
            let seen =
                places.iter().filter(is_contour).any(|place| !is_covered(&places, radius - 5e-3, point, place.depth + 0.05 * radius));
            assert!(seen, "{}: {point:?} is drawn and not seen", part.name);
        }
        let mut checked = 0;
        for place in places.iter().step_by(11) {
            for side in [1.0, -1.0] {
                let point = [place.at[0] - side * radius * place.heading[1], place.at[1] + side * radius * place.heading[0]];
                if is_at_end(point) || is_covered(&places, radius + 5e-3, point, place.depth + 0.3 * radius) {
                    continue;
                }
                checked += 1;
                let distance = from_chains(&chains, point);
                assert!(distance < 2e-3, "{}: {point:?} is seen and {distance} mm from what is drawn", part.name);
            }
        }
        assert!(checked > 100, "{checked}");
    }
}

#[test]
fn drawings_have_their_layers_and_sizes() {
    for Spring { part, wire_length_m, .. } in springs() {
        let coil = part.coil().unwrap();
        let drawing = text(&part, Format::Dxf);
        let (chains, _) = drawn(&drawing, "OUTLINE");
        let radii = [0.5e3 * coil.outer_diameter_m(), 0.5e3 * coil.inner_diameter_m()];
        assert!(drawn(&drawing, "END").1.iter().zip(radii).all(|(found, wanted)| (found - wanted).abs() < 1e-9));
        assert!((drawn(&drawing, "CENTRE").1[0] - 1e3 * coil.radius_m).abs() < 1e-9);
        let extent = coil.extent_m();
        for (axis, of) in [(0, 2), (1, 0)] {
            let all = || chains.iter().flatten().map(|point| point[axis]);
            let found = [all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max)];
            assert!((0..2).all(|k| (found[k] - 1e3 * extent[k][of]).abs() < 2.1e-3), "{}: {found:?} {extent:?}", part.name);
        }
        let note = format!("{:.6}", 1e3 * wire_length_m);
        let note = format!("Wire {} long", note.trim_end_matches('0').trim_end_matches('.'));
        assert!(drawing.contains(&note), "{note}");
        let picture = text(&part, Format::Svg);
        let document = roxmltree::Document::parse(&picture).unwrap();
        let count =
            |tag: &'static str| document.descendants().filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", tag))).count();
        assert_eq!(count("circle"), 3);
        assert!(count("path") >= chains.len() + 3);
    }
}

#[test]
fn what_cannot_be_wound_is_refused_in_every_format() {
    let mut part = springs().remove(0).part;
    if let Body::Coil(coil) = &mut part.body {
        coil.windings[0].pitch_m = [1e-3; 2];
    }
    for format in Format::ALL {
        let Error { place, problem } = write(&part, format, &Options::default()).unwrap_err();
        assert!(place == Place::Part && matches!(problem, Problem::Coil(CoilError::Touches { .. })), "{problem}");
    }
    let part = springs().remove(0).part;
    let error = write(&part, Format::Inp, &Options::default()).unwrap_err();
    assert_eq!(error.problem, Problem::OnlyPlates { format: Format::Inp });
    let error = write(&part, Format::Stl, &options(1e-9)).unwrap_err();
    assert!(matches!(error.problem, Problem::TooManyCorners { .. }), "{error}");
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![6 => 1e-4..0.02, 2 => prop::sample::select(vec![0.0, 1e-7, -1.0, 900.0, f64::NAN]), 1 => any::<f64>()]
}

fn any_end() -> impl Strategy<Value = CoilEnd> {
    (0..5_u8, number(), number()).prop_map(|(kind, bend_m, length_m)| match kind {
        0 => CoilEnd::Cut,
        1 => CoilEnd::Tangential { length_m },
        2 => CoilEnd::Axial { bend_m, length_m },
        3 => CoilEnd::Outward { bend_m, length_m },
        _ => CoilEnd::Inward { bend_m, length_m },
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn no_spring_makes_a_writer_panic(
        sizes in [number(), number()], turns in prop_oneof![0.0..6.0, any::<f64>()], pitches in [number(), number()],
        start_rad in any::<f64>(), ends in [any_end(), any_end()], is_even in any::<bool>()
    ) {
        let pitch_m = if is_even { [pitches[0]; 2] } else { pitches };
        let part = part_of("any", coil(sizes[0].min(sizes[1]), sizes[0].max(sizes[1]), vec![Winding { turns, pitch_m }], start_rad, ends));
        for format in Format::ALL {
            let _ = write(&part, format, &Options { arc_error_m: 1e-4, facet_error_m: 1e-4, element_m: None });
        }
    }

    #[test]
    fn sound_springs_are_written_whole(
        index in 3.0..20.0, gap in 1.02..3.0, turns in 0.3..6.0, is_right_handed in any::<bool>(), start_rad in -4.0..4.0, kinds in [0..4_u8, 0..4_u8]
    ) {
        let wire_m = 1e-3;
        let end = |kind| match kind {
            0 => CoilEnd::Cut,
            1 => CoilEnd::Tangential { length_m: 7e-3 },
            2 => CoilEnd::Axial { bend_m: 1.2e-3, length_m: 4e-3 },
            _ => CoilEnd::Outward { bend_m: 1e-3, length_m: 5e-3 },
        };
        let wound = coil(wire_m, 0.5 * index * wire_m, vec![Winding::even(turns, gap * wire_m)], start_rad, kinds.map(end));
        let part = part_of("sound", Coil { is_right_handed, ..wound });
        let Ok(stl) = write(&part, Format::Stl, &options(2e-5)) else {
            // Legs that meet, or too little of a gap.
            let is_touching = part.coil().is_some_and(|coil| matches!(coil.check(), Err(CoilError::Touches { .. })));
            prop_assert!(is_touching);
            return Ok(());
        };
        let mesh = Mesh::of_stl(&stl);
        mesh.check_closed("sound");
        prop_assert_eq!(mesh.euler(), 2);
        prop_assert!((mesh.volume_mm3() / (part.volume_m3() * 1e9) - 1.0).abs() < 0.03);
        for format in [Format::Dxf, Format::Svg, Format::Step] {
            prop_assert!(write(&part, format, &Options::default()).is_ok());
        }
    }
}
