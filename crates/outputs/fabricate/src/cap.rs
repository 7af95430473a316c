//! The plane of a part in triangles, and what only they show: boundaries that meet or lie where they cannot.

use forcewright_curves::vector::{cross, sub};
use spade::handles::{FixedVertexHandle, InnerTag};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};

use crate::error::{Boundary, Error, Place, Problem};
use crate::shape::{Point, Shape};

/// A boundary by its corners, material to the left.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Polygon {
    boundary: Boundary,
    pub(crate) corners: Vec<Point>,
}

impl Polygon {
    /// The polygon without corners that repeat the one before.
    pub(crate) fn new(boundary: Boundary, corners: impl IntoIterator<Item = Point>) -> Result<Self, Error> {
        // Nothing that small is meant, and predicates on it would underflow.
        let sound = |coordinate: f64| if coordinate.abs() < 1e-30 { 0.0 } else { coordinate };
        let mut corners: Vec<Point> = corners.into_iter().map(|corner| corner.map(sound)).collect();
        corners.dedup();
        while corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            return Err(Error { place: Place::Boundary(boundary), problem: Problem::TooSmall });
        }
        Ok(Self { boundary, corners })
    }
}

/// Whether the boundaries keep apart, to a thousandth of a millimetre where they are curved.
pub(crate) fn check(shape: &Shape) -> Result<(), Error> {
    let polygons: Vec<Polygon> = shape.loops().map(|each| Polygon::new(each.boundary, each.points(1e-3))).collect::<Result<_, _>>()?;
    triangles(&polygons).map(|_| ())
}

/// Triangles of the material, counterclockwise, by the numbers of corners as they follow one another through all polygons.
///
/// A constrained Delaunay triangulation with exact predicates: every corner and every side is kept, no triangle is flat.
pub(crate) fn triangles(polygons: &[Polygon]) -> Result<Vec<[usize; 3]>, Error> {
    let plane = Plane::new(polygons);
    plane.refuse_equal_corners()?;
    // One by one and in order: loading all at once goes through hash tables, whose order changes from run to run.
    let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    for corner in &plane.corners {
        let impossible = |_| Error { place: Place::Part, problem: Problem::NotFinite };
        cdt.insert(Point2::new(corner[0], corner[1])).map_err(impossible)?;
    }
    let handle = FixedVertexHandle::from_index;
    for &[from, to] in &plane.sides {
        if cdt.try_add_constraint(handle(from), handle(to)).is_empty() {
            return Err(plane.meeting([from, to]));
        }
    }
    let inside = inside(&cdt);
    for &[from, to] in &plane.sides {
        // A side through a corner of another one is in the triangulation in parts.
        let side = cdt.get_edge_from_neighbors(handle(from), handle(to)).ok_or_else(|| plane.meeting([from, to]))?;
        if !inside[side.face().index()] {
            return Err(Error { place: Place::Boundary(plane.boundary_of(from)), problem: Problem::Misplaced });
        }
    }
    let kept = cdt.inner_faces().filter(|face| inside[face.index()]);
    Ok(kept.map(|face| face.vertices().map(|vertex| vertex.index())).collect())
}

/// For each face whether an odd number of sides separates it from what is outside of everything.
pub(crate) fn inside(cdt: &ConstrainedDelaunayTriangulation<Point2<f64>>) -> Vec<bool> {
    let mut inside = vec![None; cdt.num_all_faces()];
    inside[cdt.outer_face().index()] = Some(false);
    let mut open = Vec::new();
    let enter = |inside: &mut Vec<Option<bool>>, open: &mut Vec<_>, edge: spade::handles::FixedDirectedEdgeHandle| {
        let edge = cdt.directed_edge(edge);
        let (here, there) = (edge.face(), edge.rev().face());
        let (Some(here), Some(face), None) = (inside[here.index()], there.as_inner(), inside[there.index()]) else { return };
        inside[face.index()] = Some(here != edge.is_constraint_edge());
        open.push(face.fix());
    };
    for edge in cdt.convex_hull() {
        enter(&mut inside, &mut open, edge.fix());
        enter(&mut inside, &mut open, edge.fix().rev());
    }
    while let Some(face) = open.pop() {
        for edge in cdt.face::<InnerTag>(face).adjacent_edges() {
            enter(&mut inside, &mut open, edge.fix());
        }
    }
    inside.into_iter().map(|face| face.unwrap_or(false)).collect()
}

/// All corners and sides, and to which boundary they belong.
struct Plane<'a> {
    polygons: &'a [Polygon],
    corners: Vec<Point>,
    sides: Vec<[usize; 2]>,
}

impl<'a> Plane<'a> {
    fn new(polygons: &'a [Polygon]) -> Self {
        let (mut corners, mut sides) = (Vec::new(), Vec::new());
        for polygon in polygons {
            let (first, count) = (corners.len(), polygon.corners.len());
            corners.extend_from_slice(&polygon.corners);
            sides.extend((0..count).map(|k| [first + k, first + (k + 1) % count]));
        }
        Self { polygons, corners, sides }
    }

    fn boundary_of(&self, corner: usize) -> Boundary {
        let mut first = 0;
        let holds = |polygon: &&Polygon| {
            first += polygon.corners.len();
            corner < first
        };
        self.polygons.iter().find(holds).map_or(Boundary::Outline, |polygon| polygon.boundary)
    }

    fn refuse_equal_corners(&self) -> Result<(), Error> {
        let mut order: Vec<usize> = (0..self.corners.len()).collect();
        let key = |&corner: &usize| self.corners[corner];
        let by_place = |a: &usize, b: &usize| key(a)[0].total_cmp(&key(b)[0]).then(key(a)[1].total_cmp(&key(b)[1]));
        order.sort_by(|a, b| by_place(a, b).then(a.cmp(b)));
        let equal = order.windows(2).find(|pair| by_place(&pair[0], &pair[1]).is_eq());
        equal.map_or(Ok(()), |pair| Err(self.meet(pair[1], pair[0])))
    }

    /// The error that names this side and the first other one that it touches.
    fn meeting(&self, [from, to]: [usize; 2]) -> Error {
        let (a, b) = (self.corners[from], self.corners[to]);
        let turns = |a: Point, b: Point, c: Point| cross(sub(b, a), sub(c, a)).total_cmp(&0.0) as i32;
        let touches = |&&[p, q]: &&[usize; 2]| {
            let (c, d) = (self.corners[p], self.corners[q]);
            p != from && p != to && q != from && q != to && turns(a, b, c) * turns(a, b, d) <= 0 && turns(c, d, a) * turns(c, d, b) <= 0
        };
        let other = self.sides.iter().find(touches).map_or(from, |side| side[0]);
        self.meet(from, other)
    }

    fn meet(&self, corner: usize, other: usize) -> Error {
        // Of two boundaries the later one is at fault, however it was noticed.
        let (here, there) = (self.boundary_of(corner.max(other)), self.boundary_of(corner.min(other)));
        let problem = if here == there { Problem::MeetsItself } else { Problem::Meets(there) };
        Error { place: Place::Boundary(here), problem }
    }
}
