//! Smooth plane curves fitted by B-splines and by arcs, with measured errors.
//!
//! A curve is a function of a parameter in [0, 1]. It must be smooth with a speed that does not vanish; what the parameter means does not
//! matter.

use std::fmt;

mod arcs;
mod spline;

pub use arcs::{Arcs, arcs};
pub use spline::{FittedSpline, spline};

use crate::piece::Piece;
use crate::profile::Segment;
use crate::spline::Spline;
use crate::vector::{Vector, along, cross, distance, dot, sub};

/// A place of a curve with its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oriented {
    /// Where, m.
    pub point_m: [f64; 2],
    /// Unit tangent in the direction of the growing parameter.
    pub tangent: [f64; 2],
}

impl Oriented {
    fn is_finite(&self) -> bool {
        self.point_m.iter().chain(&self.tangent).all(|x| x.is_finite())
    }
}

/// Why a curve is not fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FitError {
    /// The tolerance is not a positive number.
    Tolerance {
        /// What was asked for, m.
        tolerance_m: f64,
    },
    /// A point or a tangent is not finite.
    NotFinite {
        /// The parameter.
        parameter: f64,
    },
    /// As many pieces as there may be are not enough: the curve has a kink, or rounding is larger than the tolerance.
    TooFine {
        /// The number of pieces.
        pieces: usize,
        /// The error that remained, m.
        error_m: f64,
    },
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tolerance { tolerance_m } => write!(f, "a curve cannot be fitted within {tolerance_m} m; give a length above 0"),
            Self::NotFinite { parameter } => write!(f, "the curve is not finite at its parameter {parameter}"),
            Self::TooFine { pieces, error_m } => write!(f, "{pieces} pieces still leave an error of {error_m} m; allow more"),
        }
    }
}

impl std::error::Error for FitError {}

fn check(curve: &dyn Fn(f64) -> Oriented, tolerance_m: f64) -> Result<(), FitError> {
    if !(tolerance_m > 0.0 && tolerance_m.is_finite()) {
        return Err(FitError::Tolerance { tolerance_m });
    }
    let probes = (0..=64).map(|k| f64::from(k) / 64.0);
    match probes.into_iter().find(|u| !curve(*u).is_finite()) {
        Some(parameter) => Err(FitError::NotFinite { parameter }),
        None => Ok(()),
    }
}

/// Length of a smooth curve over a chord between two places of it, to fourth order of the angles between chord and tangents.
fn length_of(from: &Oriented, to: &Oriented) -> f64 {
    let chord = sub(to.point_m, from.point_m);
    let length = distance(to.point_m, from.point_m);
    if length <= 0.0 {
        return 0.0;
    }
    // sines of the angles from the chord to the tangents
    let (a, b) = (cross(chord, from.tangent) / length, cross(chord, to.tangent) / length);
    length * (1.0 + (2.0 * a * a - a * b + 2.0 * b * b) / 30.0)
}

/// The line or the arc that a curve is, if it is one within a tolerance (of the order of rounding, else use the fits): one segment, or
/// two for more than most of a circle.
pub(crate) fn line_or_arc(curve: &dyn Fn(f64) -> Oriented, tolerance_m: f64) -> Option<Vec<Segment>> {
    const PROBES: i32 = 24;
    let (start, half, end) = (curve(0.0), curve(0.5), curve(1.0));
    let whole = Piece::arc_by_tangent(start.point_m, start.tangent, half.point_m);
    let probes = || (1..PROBES).map(|k| curve(f64::from(k) / f64::from(PROBES)));
    let chord = sub(end.point_m, start.point_m);
    let length = distance(end.point_m, start.point_m);
    let straight = |place: Oriented| {
        let to = sub(place.point_m, start.point_m);
        cross(chord, to).abs() <= tolerance_m * length && dot(to, chord) >= 0.0 && dot(place.tangent, chord) > 0.0
    };
    if length > 0.0 && probes().all(straight) {
        return Some(vec![Segment::Line { to_m: end.point_m }]);
    }
    let Piece::Arc { centre, sweep_rad, .. } = whole else { return None };
    let radius = distance(start.point_m, centre);
    let round = |place: Oriented| {
        let from_centre = sub(place.point_m, centre);
        (distance(place.point_m, centre) - radius).abs() <= tolerance_m && cross(from_centre, place.tangent) * sweep_rad > 0.0
    };
    if sweep_rad.abs() > 1.01 * std::f64::consts::PI || !probes().chain([end]).all(round) {
        return None;
    }
    let arc = |to_m: Vector| Segment::Arc { to_m, centre_m: centre, counterclockwise: sweep_rad > 0.0 };
    if sweep_rad.abs() > 0.9 * std::f64::consts::PI {
        return Some(vec![arc(half.point_m), arc(end.point_m)]);
    }
    Some(vec![arc(end.point_m)])
}

impl Spline {
    /// The spline as arcs and lines, for exchange formats without splines: joined smoothly, with its ends and end tangents, within a
    /// distance of it.
    ///
    /// # Errors
    /// [`FitError`], which is [`FitError::NotFinite`] if the spline is not valid.
    pub fn to_arcs(&self, tolerance_m: f64) -> Result<Arcs, FitError> {
        let cubics: Vec<Piece> = self.beziers_m().into_iter().map(Piece::Cubic).collect();
        if cubics.is_empty() {
            return Err(FitError::NotFinite { parameter: 0.0 });
        }
        arcs(&|u| place_of(&cubics, u), tolerance_m)
    }
}

/// A place of cubics in a row, each with its equal share of the parameter.
fn place_of(cubics: &[Piece], u: f64) -> Oriented {
    let scaled = u * cubics.len() as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a parameter in [0, 1]")]
    let index = (scaled as usize).min(cubics.len() - 1);
    let t = scaled - index as f64;
    Oriented { point_m: cubics[index].point(t), tangent: cubics[index].tangent(t) }
}

/// The place of a curve that is nearest to a point, by Newton's method from a guess: its parameter and distance. `speed` is the length
/// per parameter, roughly.
fn nearest_on(curve: &dyn Fn(f64) -> Oriented, point: Vector, guess: f64, speed: f64) -> (f64, f64) {
    let mut u = guess;
    let mut place = curve(u);
    for _ in 0..8 {
        let step = dot(sub(point, place.point_m), place.tangent) / speed;
        if step.is_nan() || step.abs() <= 1e-12 {
            break;
        }
        u = (u + step).clamp(0.0, 1.0);
        place = curve(u);
    }
    // Without what is left along the tangent: the distance to the tangent is that to the curve to second order.
    let to = sub(point, place.point_m);
    let foot = along(point, place.tangent, -dot(to, place.tangent));
    (u, distance(foot, place.point_m))
}
