//! The plate as a closed mesh of triangles.

use crate::cap::{self, Polygon};
use crate::error::Error;
use crate::shape::Shape;

/// A closed surface of triangles, mm; seen from outside they run counterclockwise.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mesh {
    pub(crate) corners: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[usize; 3]>,
}

/// The plate between `z = 0` and its depth, with chords within `chord` mm of the boundary.
///
/// Corners are rounded to single precision before triangles are made of them: what is written is then closed and never folded over.
#[allow(clippy::cast_possible_truncation, reason = "rounding to single precision is meant")]
pub(crate) fn extruded(shape: &Shape, chord: f64) -> Result<Mesh, Error> {
    let rounded = |corner: [f64; 2]| corner.map(|coordinate| f64::from(coordinate as f32));
    let polygon = |each: crate::shape::Loop| Polygon::new(each.boundary, each.points(chord).into_iter().map(rounded));
    let polygons: Vec<Polygon> = shape.loops().map(polygon).collect::<Result<_, _>>()?;
    let cap = cap::triangles(&polygons)?;
    let plane =
        |z: f64| polygons.iter().flat_map(|polygon| &polygon.corners).map(move |corner| [corner[0] as f32, corner[1] as f32, z as f32]);
    let corners: Vec<[f32; 3]> = plane(0.0).chain(plane(shape.depth)).collect();
    // Corner `k` of the bottom is below corner `k + top`.
    let top = corners.len() / 2;
    let mut triangles = Vec::with_capacity(2 * (cap.len() + top));
    triangles.extend(cap.iter().map(|&[a, b, c]| [a, c, b]));
    triangles.extend(cap.iter().map(|triangle| triangle.map(|corner| corner + top)));
    let mut first = 0;
    for polygon in &polygons {
        let count = polygon.corners.len();
        for k in 0..count {
            let (here, next) = (first + k, first + (k + 1) % count);
            triangles.extend([[here, next, next + top], [here, next + top, here + top]]);
        }
        first += count;
    }
    Ok(Mesh { corners, triangles })
}
