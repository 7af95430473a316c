//! The whole outline of a gear in lines that files hold: arcs, and a spline for each involute and trochoid.

use std::f64::consts::TAU;

use forcewright_curves::vector::{Vector, rotate};
use forcewright_curves::{Profile, Segment, Spline, fit};

use super::piece::{Curve, Piece, Region};
use super::{Arc, ToothProfile};
use crate::gears::{GearError, Kind};

/// The closed outline of a gear.
#[derive(Clone, Debug, PartialEq)]
pub struct GearOutline {
    /// Counterclockwise around an external gear, clockwise around the hole of a ring: material lies to the left. Tooth 0 is centred on the x axis.
    pub profile: Profile,
    /// Largest distance between a spline and the exact tooth that was found, m; arcs are exact.
    pub error_m: f64,
    /// Segments per tooth: six, fewer where an arc has no length, two more with tip relief.
    pub segments_per_tooth: usize,
}

/// A drawn piece with its end, seen from the tip to the root on the side that faces counterclockwise.
struct Drawn {
    start_m: Vector,
    segment: Segment,
}

fn mirror([x, y]: Vector) -> Vector {
    [x, -y]
}

fn arc(to_m: Vector, centre_m: Vector, counterclockwise: bool) -> Segment {
    Segment::Arc { to_m, centre_m, counterclockwise }
}

/// The image of a segment.
fn image(segment: &Segment, point: impl Fn(Vector) -> Vector, mirrored: bool) -> Segment {
    match segment {
        Segment::Line { to_m } => Segment::Line { to_m: point(*to_m) },
        Segment::Arc { to_m, centre_m, counterclockwise } => arc(point(*to_m), point(*centre_m), *counterclockwise != mirrored),
        Segment::Spline(spline) => {
            Segment::Spline(Spline { control_m: spline.control_m.iter().map(|p| point(*p)).collect(), knots: spline.knots.clone() })
        }
    }
}

/// The same curve from its end to its start.
fn reversed(segment: &Segment, start_m: Vector) -> Segment {
    match segment {
        Segment::Line { .. } => Segment::Line { to_m: start_m },
        Segment::Arc { centre_m, counterclockwise, .. } => arc(start_m, *centre_m, !counterclockwise),
        Segment::Spline(spline) => Segment::Spline(spline.reversed()),
    }
}

/// Begins and ends where its neighbours do, to the last bit.
fn joined(segment: Segment, start_m: Vector, end_m: Vector) -> Segment {
    match segment {
        Segment::Spline(mut spline) => {
            if let [first, .., last] = spline.control_m.as_mut_slice() {
                (*first, *last) = (start_m, end_m);
            }
            Segment::Spline(spline)
        }
        Segment::Arc { centre_m, counterclockwise, .. } => arc(end_m, centre_m, counterclockwise),
        Segment::Line { .. } => Segment::Line { to_m: end_m },
    }
}

impl Drawn {
    fn of(piece: &Piece, start_m: Vector, end_m: Vector, tolerance_m: f64) -> Result<(Self, f64), GearError> {
        let (segment, error_m) = match &piece.curve {
            Curve::Arc(Arc { centre_m, angles_rad: [from, to], .. }) => (arc(end_m, *centre_m, to > from), 0.0),
            Curve::Flank(_) | Curve::Trochoid(_) => {
                let fitted = fit::spline(&|u| piece.oriented(u), tolerance_m).map_err(GearError::Outline)?;
                (Segment::Spline(fitted.spline), fitted.error_m)
            }
        };
        Ok((Self { start_m, segment: joined(segment, start_m, end_m) }, error_m))
    }
}

/// The outline of a tooth profile.
pub(super) fn outline(tooth: &ToothProfile, tolerance_m: f64) -> Result<GearOutline, GearError> {
    let teeth = tooth.wheel().spec.teeth;
    // Flank and fillet; the arcs of tip and root go over to the neighbours.
    let side: Vec<&Piece> = tooth.pieces().iter().filter(|piece| !matches!(piece.region, Region::Tip | Region::Root)).collect();
    let has_root = tooth.pieces().iter().any(|piece| piece.region == Region::Root);
    let mut corners: Vec<Vector> = side.iter().map(|piece| piece.oriented(0.0).point_m).collect();
    corners.extend(side.last().map(|piece| piece.oriented(1.0).point_m));
    let mut upper = Vec::with_capacity(side.len());
    let mut error_m: f64 = 0.0;
    for (piece, ends) in side.iter().zip(corners.windows(2)) {
        let (drawn, error) = Drawn::of(piece, ends[0], ends[1], tolerance_m)?;
        upper.push(drawn);
        error_m = error_m.max(error);
    }
    let (tip, root) = (corners[0], corners[corners.len() - 1]);
    let mut whole: Vec<Segment> = Vec::new();
    for drawn in upper.iter().rev() {
        whole.push(image(&reversed(&drawn.segment, drawn.start_m), mirror, true));
    }
    whole.push(arc(tip, [0.0; 2], true));
    whole.extend(upper.into_iter().map(|drawn| drawn.segment));
    let turned = |k: u32| move |point: Vector| if k == 0 { point } else { rotate(point, TAU * f64::from(k) / f64::from(teeth)) };
    let begin = |k: u32| turned(k % teeth)(mirror(root));
    let mut segments = Vec::new();
    for k in 0..teeth {
        segments.extend(whole.iter().map(|segment| image(segment, turned(k), false)));
        let next_m = begin(k + 1);
        if has_root {
            segments.push(arc(next_m, [0.0; 2], true));
        } else if let Some(last) = segments.pop() {
            // The fillets of two teeth meet in the middle of the space.
            let start_m = segments.last().map_or(begin(k), Segment::end_m);
            segments.push(joined(last, start_m, next_m));
        }
    }
    let profile = Profile { start_m: begin(0), segments };
    let segments_per_tooth = whole.len() + usize::from(has_root);
    let profile = if tooth.wheel().spec.kind == Kind::Internal { profile.reversed() } else { profile };
    Ok(GearOutline { profile, error_m, segments_per_tooth })
}
