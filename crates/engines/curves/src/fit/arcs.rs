//! Arcs in a row with common tangents.
//!
//! Two places of a curve with their tangents are joined by a biarc: two arcs that share a tangent, here the one whose two tangent lengths
//! are equal (K. M. Bolton, "Biarc curves", Computer-Aided Design 7(2), 1975). Each biarc reaches as far as the tolerance lets it.

use super::{FitError, Oriented, check};
use crate::piece::Piece;
use crate::profile::Segment;
use crate::vector::{Vector, add, along, distance, dot, scale, sub};

/// Places of the curve per biarc at which its error is measured.
const PROBES: usize = 24;
/// Halvings in the search for the farthest end of a biarc.
const HALVINGS: usize = 24;
/// The end of a biarc is looked for to this part of its parameter.
const CLOSE_ENOUGH: f64 = 0.01;
const MOST: usize = 20_000;

/// Arcs and lines, each beginning where the one before ends and in its direction, and their distance from the curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Arcs {
    /// Lines and arcs.
    pub segments: Vec<Segment>,
    /// The largest distance from the curve that was found, m, at 24 places per pair of arcs.
    pub error_m: f64,
}

/// Arcs, and lines where it is straight, within a distance of a curve: smoothly joined, with its ends and end tangents.
///
/// # Errors
/// [`FitError`].
pub fn arcs(curve: &dyn Fn(f64) -> Oriented, tolerance_m: f64) -> Result<Arcs, FitError> {
    check(curve, tolerance_m)?;
    let (mut segments, mut error_m, mut start): (_, f64, _) = (Vec::new(), 0.0, 0.0);
    while start < 1.0 {
        let too_fine = FitError::TooFine { pieces: segments.len(), error_m: tolerance_m };
        let reach = farthest(curve, start, tolerance_m).filter(|_| segments.len() < MOST).ok_or(too_fine)?;
        segments.extend(reach.pieces.iter().filter(|piece| piece.length() > 0.0).map(segment));
        error_m = error_m.max(reach.error_m);
        start = reach.end;
    }
    Ok(Arcs { segments, error_m })
}

/// A biarc that is near enough.
struct Reach {
    /// The parameter at which it ends.
    end: f64,
    pieces: [Piece; 2],
    error_m: f64,
}

/// The biarc that reaches as far as it may.
fn farthest(curve: &dyn Fn(f64) -> Oriented, start: f64, tolerance_m: f64) -> Option<Reach> {
    let mut found = biarc_within(curve, start, 1.0, tolerance_m);
    let mut far = 1.0;
    for _ in 0..HALVINGS {
        let near = found.as_ref().map_or(start, |reach| reach.end);
        if far - near <= CLOSE_ENOUGH * (near - start) {
            break;
        }
        let trial = 0.5 * (near + far);
        match biarc_within(curve, start, trial, tolerance_m) {
            Some(reach) => found = Some(reach),
            None => far = trial,
        }
    }
    found
}

fn segment(piece: &Piece) -> Segment {
    match *piece {
        Piece::Arc { to, centre, sweep_rad, .. } => Segment::Arc { to_m: to, centre_m: centre, counterclockwise: sweep_rad > 0.0 },
        _ => Segment::Line { to_m: piece.to() },
    }
}

/// The biarc between two places if it is near enough, with its error.
fn biarc_within(curve: &dyn Fn(f64) -> Oriented, start: f64, end: f64, tolerance_m: f64) -> Option<Reach> {
    let (from, to) = (curve(start), curve(end));
    let (pieces, direction) = biarc(&from, &to)?;
    let joint = pieces[0].to();
    let mut error_m: f64 = 0.0;
    for k in 1..PROBES {
        let place = curve(start + (end - start) * k as f64 / PROBES as f64);
        let piece = &pieces[usize::from(dot(sub(place.point_m, joint), direction) > 0.0)];
        let t = piece.nearest(place.point_m);
        if dot(piece.tangent(t), place.tangent) <= 0.0 {
            return None;
        }
        error_m = error_m.max(distance(piece.point(t), place.point_m));
        if error_m.is_nan() || error_m > tolerance_m {
            return None;
        }
    }
    Some(Reach { end, pieces, error_m })
}

/// The biarc with equal tangent lengths and the direction in which its arcs join. `None` for tangents that it cannot join.
fn biarc(from: &Oriented, to: &Oriented) -> Option<([Piece; 2], Vector)> {
    let chord = sub(to.point_m, from.point_m);
    let square = dot(chord, chord);
    let both = add(from.tangent, to.tangent);
    // |chord − d·both| = 2 d, the positive root, in the form without cancellation
    let forward = dot(chord, both);
    let bend = 2.0 * (1.0 - dot(from.tangent, to.tangent)).max(0.0);
    let length = square / (forward + (forward * forward + bend * square).sqrt());
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let first = along(from.point_m, from.tangent, length);
    let second = along(to.point_m, to.tangent, -length);
    let joint = scale(add(first, second), 0.5);
    let direction = sub(second, first);
    let pieces = [
        Piece::arc_by_tangent(from.point_m, from.tangent, joint),
        Piece::arc_by_tangent(to.point_m, scale(to.tangent, -1.0), joint).reversed(),
    ];
    Some((pieces, direction))
}
