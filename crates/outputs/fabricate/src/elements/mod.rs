//! The plane of a part in triangles of six nodes with curved sides, for finite elements.

mod boundary;
mod curve;

use std::collections::BTreeMap;

use forcewright_curves::vector::{cross, dot, norm, sub};
use spade::handles::FixedVertexHandle;
use spade::{AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation as _};

pub(crate) use boundary::Region;
use boundary::{Elastic, Side};

use crate::cap;
use crate::error::Problem;
use crate::shape::{Point, Shape};

/// Least angle asked for, degrees: what refinement reaches with certainty is about 20, in practice 30.
const LEAST_ANGLE_DEG: f64 = 30.0;
/// More triangles than anybody waits for; wide places are meshed coarser than asked for below that.
const MOST_TRIANGLES: u32 = 200_000;
/// Rounds of smoothing.
const ROUNDS: usize = 8;

type Cdt = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// Quadratic triangles, mm.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Elements {
    pub(crate) nodes: Vec<Point>,
    /// Corners counterclockwise, then the nodes amid the sides 1–2, 2–3 and 3–1.
    pub(crate) triangles: Vec<[usize; 6]>,
    /// Nodes on the border of each grip, ascending.
    pub(crate) gripped: Vec<Vec<usize>>,
}

/// The part between its grips in triangles with sides of about `size` mm. Nodes of the boundary lie on
/// the boundary, but for those amid sides that would fold an element over.
///
/// Delaunay refinement (J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", J. Algorithms 18, 1995)
/// of the boundary as chords, smoothing of what is inside, then chords bent onto their curves.
pub(crate) fn mesh(shape: &Shape, grips: &[Region], size: f64) -> Result<Elements, Problem> {
    let elastic = Elastic::new(shape, grips, size)?;
    let (cdt, shift) = refined(&elastic, size)?;
    let inside = cap::inside(&cdt);
    let kept = cdt.inner_faces().filter(|face| inside[face.index()]);
    let triangles: Vec<[usize; 3]> = kept.map(|face| face.vertices().map(|vertex| vertex.index())).collect();
    let mut nodes: Vec<Point> = cdt.vertices().map(|v| [v.position().x - shift[0], v.position().y - shift[1]]).collect();
    let sides = elastic.sides.iter().map(|side| split(&cdt, side)).collect::<Option<Vec<_>>>();
    let sides: Vec<Side> = sides.ok_or(Problem::Mesh { what: "its boundary cannot be followed" })?.concat();
    let mut fixed = vec![false; nodes.len()];
    for side in &sides {
        fixed[side.ends[0]] = true;
        nodes[side.ends[0]] = elastic.curves[side.curve].at(side.range[0]);
    }
    smooth(&mut nodes, &triangles, &fixed);
    let mut elements = quadratic(&nodes, &triangles, &sides, &elastic, grips.len());
    straighten(&mut elements);
    if elements.triangles.iter().any(|triangle| is_folded(&elements.nodes, triangle)) {
        return Err(Problem::Mesh { what: "an element is folded over; smaller ones would not be" });
    }
    Ok(elements)
}

/// The refined triangulation, and by how much it is shifted: spade refuses coordinates that rounding has left beside zero.
fn refined(elastic: &Elastic, size: f64) -> Result<(Cdt, Point), Problem> {
    let bound = |of: fn(f64, f64) -> f64, k: usize, start: f64| elastic.corners.iter().map(|p| p[k]).fold(start, of);
    let low = [0, 1].map(|k| bound(f64::min, k, f64::INFINITY));
    let high = [0, 1].map(|k| bound(f64::max, k, f64::NEG_INFINITY));
    let extent = (high[0] - low[0]).max(high[1] - low[1]);
    let shift = low.map(|x| extent - x);
    let mut cdt = Cdt::new();
    for (index, corner) in elastic.corners.iter().enumerate() {
        let handle = cdt.insert(Point2::new(corner[0] + shift[0], corner[1] + shift[1]));
        if handle.map(|handle| handle.index()) != Ok(index) {
            return Err(Problem::Mesh { what: "two corners of its boundary coincide" });
        }
    }
    let mut twice_area = 0.0;
    for side in &elastic.sides {
        let [from, to] = side.ends.map(FixedVertexHandle::from_index);
        cdt.try_add_constraint(from, to);
        if cdt.get_edge_from_neighbors(from, to).is_none_or(|edge| !edge.is_constraint_edge()) {
            return Err(Problem::Mesh { what: "chords of its boundary cross; smaller elements would keep them apart" });
        }
        twice_area += cross(elastic.corners[side.ends[0]], elastic.corners[side.ends[1]]);
    }
    let largest = (0.5 * size * size).max(0.5 * twice_area / f64::from(MOST_TRIANGLES));
    let parameters = RefinementParameters::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_deg(LEAST_ANGLE_DEG))
        .with_max_allowed_area(largest)
        .with_min_required_area(1e-4 * size * size)
        .with_max_additional_vertices(MOST_TRIANGLES as usize);
    if cdt.refine(parameters).refinement_complete { Ok((cdt, shift)) } else { Err(Problem::Mesh { what: "it takes too many elements" }) }
}

/// The parts of a side after refinement, which puts new corners on it.
fn split(cdt: &Cdt, side: &Side) -> Option<Vec<Side>> {
    let place = |index: usize| {
        let p = cdt.get_vertex(FixedVertexHandle::from_index(index))?.position();
        Some([p.x, p.y])
    };
    let (start, end) = (place(side.ends[0])?, place(side.ends[1])?);
    let along = sub(end, start);
    let square = dot(along, along);
    let (mut parts, mut here) = (Vec::new(), (side.ends[0], 0.0));
    while here.0 != side.ends[1] {
        let vertex = cdt.get_vertex(FixedVertexHandle::from_index(here.0))?;
        let ahead = vertex.out_edges().filter(|edge| edge.is_constraint_edge()).filter_map(|edge| {
            let p = sub(place(edge.to().index())?, start);
            let share = dot(along, p) / square;
            let beside = cross(along, p).abs() / square;
            (share > here.1 && share <= 1.0 + 1e-9 && beside < 1e-9).then_some((edge.to().index(), share))
        });
        let next = ahead.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let place = |share: f64| side.range[0] + share * (side.range[1] - side.range[0]);
        let share = if next.0 == side.ends[1] { 1.0 } else { next.1 };
        parts.push(Side { ends: [here.0, next.0], range: [place(here.1), place(share)], ..*side });
        here = (next.0, share);
    }
    Some(parts)
}

/// Moves inner corners to the middle of their neighbours where that makes the worst triangle around better.
fn smooth(nodes: &mut [Point], triangles: &[[usize; 3]], fixed: &[bool]) {
    let mut around: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    for (index, triangle) in triangles.iter().enumerate() {
        for corner in triangle {
            around[*corner].push(index);
        }
    }
    for _ in 0..ROUNDS {
        for corner in (0..nodes.len()).filter(|corner| !fixed[*corner] && !around[*corner].is_empty()) {
            let worst = |nodes: &[Point]| around[corner].iter().map(|t| shape_of(nodes, &triangles[*t])).fold(f64::INFINITY, f64::min);
            let (before, old) = (worst(nodes), nodes[corner]);
            // Every neighbour is in two of the triangles around.
            let others = || around[corner].iter().flat_map(|t| triangles[*t]).filter(|other| *other != corner);
            let count = others().count() as f64;
            nodes[corner] = [0, 1].map(|k| others().map(|other| nodes[other][k]).sum::<f64>() / count);
            if worst(nodes) <= before {
                nodes[corner] = old;
            }
        }
    }
}

/// Area over the sum of squares of its sides, scaled to 1 for equal sides; negative if it is turned over.
fn shape_of(nodes: &[Point], triangle: &[usize; 3]) -> f64 {
    let [a, b, c] = triangle.map(|corner| nodes[corner]);
    let sides = [sub(b, a), sub(c, b), sub(a, c)];
    let squares: f64 = sides.iter().map(|side| dot(*side, *side)).sum();
    2.0 * 3.0_f64.sqrt() * cross(sides[0], sub(c, a)) / squares
}

/// Nodes amid the sides, on the curves where there are any; only nodes that triangles have.
fn quadratic(corners: &[Point], triangles: &[[usize; 3]], sides: &[Side], elastic: &Elastic, grips: usize) -> Elements {
    let key = |a: usize, b: usize| (a.min(b), a.max(b));
    let curved: BTreeMap<(usize, usize), &Side> = sides.iter().map(|side| (key(side.ends[0], side.ends[1]), side)).collect();
    let mut number = vec![usize::MAX; corners.len()];
    let mut nodes = Vec::new();
    for corner in triangles.iter().flatten() {
        if number[*corner] == usize::MAX {
            number[*corner] = nodes.len();
            nodes.push(corners[*corner]);
        }
    }
    let mut amid: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let mut quadratic = Vec::with_capacity(triangles.len());
    for &[a, b, c] in triangles {
        let middles = [(a, b), (b, c), (c, a)].map(|(from, to)| {
            *amid.entry(key(from, to)).or_insert_with(|| {
                nodes.push(match curved.get(&key(from, to)) {
                    Some(side) => elastic.curves[side.curve].at(f64::midpoint(side.range[0], side.range[1])),
                    None => [0, 1].map(|k| f64::midpoint(corners[from][k], corners[to][k])),
                });
                nodes.len() - 1
            })
        });
        quadratic.push([number[a], number[b], number[c], middles[0], middles[1], middles[2]]);
    }
    let mut gripped = vec![Vec::new(); grips];
    for side in sides {
        if let Some(grip) = side.grip {
            gripped[grip].extend(side.ends.map(|corner| number[corner]));
            gripped[grip].extend(amid.get(&key(side.ends[0], side.ends[1])));
        }
    }
    for nodes in &mut gripped {
        nodes.sort_unstable();
        nodes.dedup();
    }
    Elements { nodes, triangles: quadratic, gripped }
}

/// Makes the sides of triangles straight that bending has folded over.
fn straighten(elements: &mut Elements) {
    for triangle in &elements.triangles {
        if is_folded(&elements.nodes, triangle) {
            for k in 0..3 {
                let [from, to] = [triangle[k], triangle[(k + 1) % 3]].map(|corner| elements.nodes[corner]);
                elements.nodes[triangle[k + 3]] = [0, 1].map(|axis| f64::midpoint(from[axis], to[axis]));
            }
        }
    }
}

/// Whether the map from the plain triangle turns over at one of its nodes.
fn is_folded(nodes: &[Point], triangle: &[usize; 6]) -> bool {
    let place = triangle.map(|node| nodes[node]);
    let at = |r: f64, s: f64| {
        let t = 1.0 - r - s;
        let by_r = [1.0 - 4.0 * t, 4.0 * r - 1.0, 0.0, 4.0 * (t - r), 4.0 * s, -4.0 * s];
        let by_s = [1.0 - 4.0 * t, 0.0, 4.0 * s - 1.0, -4.0 * r, 4.0 * r, 4.0 * (t - s)];
        let sum = |weights: [f64; 6]| [0, 1].map(|k| weights.iter().zip(&place).map(|(w, p)| w * p[k]).sum::<f64>());
        cross(sum(by_r), sum(by_s))
    };
    let scale = norm(sub(place[1], place[0]));
    [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.0), (0.5, 0.5), (0.0, 0.5)].iter().any(|&(r, s)| at(r, s) <= 1e-6 * scale * scale)
}
