//! Drawings of a spring: from the side as it is seen, and what is needed of it along the axis.

use forcewright_model::WireKind;

use super::sight::Sight;
use super::{Wound, middle};
use crate::shape::{Circle, MM_PER_M, Point};

/// From the side view to the view along the axis, and by how much centre lines stand out, in mean radii.
const ROOM: f64 = 0.5;
const OUT: f64 = 0.2;

/// An open chain of points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) points: Vec<Point>,
}

/// Two views of a spring side by side, mm: from the side with z to the right and x upwards, and to its left (first angle) from the upper end.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Views {
    /// What is seen from the side.
    pub(crate) outline: Vec<Line>,
    /// The cylinders around and inside the windings, from the end.
    pub(crate) end: [Circle; 2],
    /// The axis in both views, and the middles of bends and legs from the end.
    pub(crate) centre: Vec<Line>,
    /// The middle of the wire in its windings, from the end.
    pub(crate) mean: Circle,
    /// Least and greatest coordinates.
    pub(crate) extent: [Point; 2],
}

/// The views with lines within `chord` mm.
pub(crate) fn views(wound: &Wound<'_>, chord: f64) -> Views {
    let coil = wound.coil;
    let [low, high] = coil.extent_m().map(|point| point.map(|m| m * MM_PER_M));
    let (radius, out) = (coil.radius_m * MM_PER_M, OUT * coil.radius_m * MM_PER_M);
    let outer = 0.5 * coil.outer_diameter_m() * MM_PER_M;
    // How far the view from the end goes to its right, towards −y.
    let right = outer.max(-low[1]) + out;
    let at = [low[2] - ROOM * radius - right, 0.0];
    let circle = |radius: f64| Circle { centre: at, radius };
    let line = |from: Point, to: Point| Line { points: vec![from, to] };
    let cross = outer + out;
    let mut centre = vec![
        line([low[2] - out, 0.0], [high[2] + out, 0.0]),
        line([at[0] - cross, 0.0], [at[0] + cross, 0.0]),
        line([at[0], -cross], [at[0], cross]),
    ];
    let from_end = |[x, y, _]: [f64; 3]| [at[0] - y, x];
    for piece in wound.line.pieces().iter().filter(|piece| piece.kind() != WireKind::Wound) {
        let bent = piece.kind() == WireKind::Bend;
        let by_angle = piece.turned_rad() / (8.0 * chord / (piece.radius_m() * MM_PER_M)).sqrt();
        let count = if bent { by_angle.ceil().clamp(1.0, 1e4) } else { 1.0 };
        let mut points = Vec::new();
        let mut k = 0.0;
        while k <= count {
            points.push(from_end(middle(&piece.at(k / count))));
            k += 1.0;
        }
        let size = points.iter().map(|p| (p[0] - points[0][0]).abs().max((p[1] - points[0][1]).abs())).fold(0.0, f64::max);
        // A leg along the axis is a point from there.
        if size > chord {
            centre.push(Line { points });
        }
    }
    let outline = Sight::new(wound, chord).lines().into_iter().map(|points| Line { points }).collect::<Vec<_>>();
    let end = [circle(outer), circle(0.5 * coil.inner_diameter_m() * MM_PER_M)];
    let corners = [[at[0] - cross, -cross], [at[0] + cross, cross], [low[2], low[0]], [high[2], high[0]]];
    let points = outline.iter().chain(&centre).flat_map(|line| &line.points).copied().chain(corners);
    let mut extent = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for point in points {
        for k in 0..2 {
            extent[0][k] = extent[0][k].min(point[k]);
            extent[1][k] = extent[1][k].max(point[k]);
        }
    }
    Views { outline, end, centre, mean: circle(radius), extent }
}
