//! A spring in STEP: two half tubes for each turn at most, and its two plane ends.
//!
//! Across, a half tube is a half circle as a rational cubic, which is exact. Along, the middle of the wire and both unit vectors across it
//! are one spline of degree 5 with values in nine dimensions, within [`crate::turned::fitted_within`]'s error; the surface is linear in
//! them, so its control points are theirs, and its edges lie on it to rounding. Straight legs are cylinders.

use forcewright_model::{Part, WireKind, WirePiece, WireStation};

use super::{Wound, middle, millimetres};
use crate::shape::MM_PER_M;
use crate::step::{Entity, OUTER, Step, document, real};
use crate::text::{length, ratio};
use crate::turned::{DEGREE, curve, fitted_within, knots};

/// The half circle from (1, 0) to (−1, 0) as a rational cubic: control points and weights.
const HALF: [([f64; 2], f64); 4] = [([1.0, 0.0], 1.0), ([1.0, 2.0], 1.0 / 3.0), ([-1.0, 2.0], 1.0 / 3.0), ([-1.0, 0.0], 1.0)];
/// Spans for an angle of one radian to begin with.
const SPANS_PER_RAD: f64 = 3.0;

pub(crate) fn write(part: &Part, wound: &Wound<'_>) -> String {
    document(part, |step| faces(step, wound))
}

/// Where faces meet: vertices on the sides of the normal and opposite, and the half circles from the first to the second and back.
struct Joint {
    vertices: [Entity; 2],
    halves: [Entity; 2],
}

/// All faces from the lower end upwards, then both ends.
fn faces(step: &mut Step, wound: &Wound<'_>) -> Vec<Entity> {
    let (Some(lower), Some(upper)) = (wound.end(false), wound.end(true)) else { return Vec::new() };
    let first = joint(step, &lower, wound.radius);
    let mut below = Joint { vertices: first.vertices.clone(), halves: first.halves.clone() };
    let mut faces = Vec::new();
    for piece in wound.line.pieces() {
        let turns = piece.turned_rad() / std::f64::consts::TAU;
        let parts = count((turns - 1e-9).ceil());
        for part in 0..parts {
            let share = |end: usize| (part + end) as f64 / parts as f64;
            let above = joint(step, &piece.at(share(1)), wound.radius);
            faces.extend(half_tubes(step, piece, [share(0), share(1)], wound.radius, [&below, &above]));
            below = above;
        }
    }
    let [one, other] = &first.halves;
    let bound = step.bound(&[(other, false), (one, false)], OUTER);
    faces.push(end(step, &lower, -1.0, &bound));
    let [one, other] = &below.halves;
    let bound = step.bound(&[(one, true), (other, true)], OUTER);
    faces.push(end(step, &upper, 1.0, &bound));
    faces
}

/// At least one.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive number")]
fn count(parts: f64) -> usize {
    parts.max(1.0) as usize
}

/// A circle around the wire.
fn joint(step: &mut Step, station: &WireStation, radius: f64) -> Joint {
    let vertices = [1.0, -1.0].map(|side| {
        let point = step.point(&millimetres(station.around_m(radius / MM_PER_M, [side, 0.0])));
        step.add(format_args!("VERTEX_POINT('',{point})"))
    });
    let frame = step.frame_in_space(&middle(station), station.tangent, station.normal);
    let circle = step.add(format_args!("CIRCLE('',{frame},{})", real(&length(radius))));
    let halves =
        [(0, 1), (1, 0)].map(|(from, to)| step.add(format_args!("EDGE_CURVE('',{},{},{circle},.T.)", vertices[from], vertices[to])));
    Joint { vertices, halves }
}

/// A plane end, seen along the wire (`sign` 1) or against it (−1).
fn end(step: &mut Step, station: &WireStation, sign: f64, bound: &Entity) -> Entity {
    let frame = step.frame_in_space(&middle(station), station.tangent.map(|x| sign * x), station.normal);
    let plane = step.add(format_args!("PLANE('',{frame})"));
    step.face(std::slice::from_ref(bound), &plane, true)
}

/// Both halves of the wire between two joints.
fn half_tubes(step: &mut Step, piece: &WirePiece, shares: [f64; 2], radius: f64, [below, above]: [&Joint; 2]) -> [Entity; 2] {
    let sweep = (piece.kind() != WireKind::Straight).then(|| Sweep::new(piece, shares, radius));
    let begin = piece.at(shares[0]);
    let rails = [0, 1].map(|side| {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let curve = match &sweep {
            Some(sweep) => {
                let points: Vec<Entity> = sweep.row([sign, 0.0], radius).iter().map(|point| step.point(point)).collect();
                curve(step, &points)
            }
            None => step.line(&millimetres(begin.around_m(radius / MM_PER_M, [sign, 0.0])), begin.tangent),
        };
        step.add(format_args!("EDGE_CURVE('',{},{},{curve},.T.)", below.vertices[side], above.vertices[side]))
    });
    let cylinder = sweep.is_none().then(|| {
        let frame = step.frame_in_space(&middle(&begin), begin.tangent, begin.normal);
        step.add(format_args!("CYLINDRICAL_SURFACE('',{frame},{})", real(&length(radius))))
    });
    [0, 1].map(|half| {
        let (left, right) = (&rails[half], &rails[1 - half]);
        let bound = step.bound(&[(&below.halves[half], true), (right, true), (&above.halves[half], false), (left, false)], OUTER);
        let surface = match (&sweep, &cylinder) {
            (Some(sweep), _) => sweep.surface(step, if half == 0 { 1.0 } else { -1.0 }, radius),
            (None, Some(cylinder)) => cylinder.clone(),
            (None, None) => String::new(),
        };
        step.face(&[bound], &surface, true)
    })
}

/// Control points of the middle of the wire, its normal and its binormal over part of a piece.
struct Sweep {
    control: Vec<[f64; 9]>,
}

impl Sweep {
    fn new(piece: &WirePiece, [from, to]: [f64; 2], radius: f64) -> Self {
        let frame = |x: f64| {
            let station = piece.at(from + (to - from) * x);
            let ([a, b, c], [d, e, f], [g, h, i]) = (middle(&station), station.normal, station.binormal);
            [a, b, c, d, e, f, g, h, i]
        };
        // A point of the surface is m + r (cos φ n + sin φ b): its error is at most that of m and r times that of n and b together.
        let error = |spline: &[f64; 9], truth: &[f64; 9]| {
            let squares = |from: usize, to: usize| (from..to).map(|k| (spline[k] - truth[k]) * (spline[k] - truth[k])).sum::<f64>();
            squares(0, 3).sqrt() + radius * squares(3, 9).sqrt()
        };
        let spans = count((piece.turned_rad() * (to - from) * SPANS_PER_RAD).ceil());
        Self { control: fitted_within(frame, spans, error) }
    }

    /// Control points along the wire at a place of its cross section, in radii.
    fn row(&self, [across, up]: [f64; 2], radius: f64) -> Vec<[f64; 3]> {
        let point = |c: &[f64; 9]| [0, 1, 2].map(|k| c[k] + radius * (across * c[3 + k] + up * c[6 + k]));
        self.control.iter().map(point).collect()
    }

    /// The half tube on the side of the binormal (`side` 1) or opposite (−1); its own normal points outwards.
    fn surface(&self, step: &mut Step, side: f64, radius: f64) -> Entity {
        let mut rows = Vec::new();
        let mut weights = Vec::new();
        for (place, weight) in HALF {
            let points = self.row(place.map(|x| side * x), radius);
            let points: Vec<Entity> = points.iter().map(|point| step.point(point)).collect();
            weights.push(format!("({})", vec![real(&ratio(weight)); points.len()].join(",")));
            rows.push(format!("({})", points.join(",")));
        }
        let (counts, knots) = knots(self.control.len());
        step.add(format_args!(
            "(BOUNDED_SURFACE()B_SPLINE_SURFACE(3,{DEGREE},({}),.UNSPECIFIED.,.F.,.F.,.F.)\
             B_SPLINE_SURFACE_WITH_KNOTS((4,4),({counts}),(0.,1.),({knots}),.UNSPECIFIED.)GEOMETRIC_REPRESENTATION_ITEM()\
             RATIONAL_B_SPLINE_SURFACE(({}))REPRESENTATION_ITEM('')SURFACE())",
            rows.join(","),
            weights.join(",")
        ))
    }
}
