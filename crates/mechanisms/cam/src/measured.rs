//! Profiles as they were made: measured points brought to the design, and random errors of a process.
//!
//! The measured points of both sides are registered to the designed cam as one rigid body, with weights that take the sting out of
//! outliers; what is left along the normal is smoothed over the way of the roller and laid on the exact path. Derivatives of the design
//! stay exact that way: only the small deviation is smoothed, not the profile.

use std::sync::Arc;

use forcewright_curves::plane::{CurvePoint, Mirrored, PlaneCurve};
use forcewright_curves::registration::{Cloud, Options, Placed, Registration, RegistrationError, register};
use forcewright_curves::smoothing::{Amount, SmoothingError, SmoothingSpline, spline};
use forcewright_curves::waviness::{Waviness, WavinessTable};

use crate::cut::{Cut, SIDES};
use crate::jet::Jet;
use crate::path::{ArcLength, NormalError, corner};

/// What was measured of a cam.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Motion from the measured points to the design, and how well they fit.
    pub registration: Registration,
    /// Which side each of the clouds of the registration belongs to.
    pub sides: Vec<usize>,
    /// What was taken as the profile's error of each side.
    pub errors: [Option<Arc<Smoothed>>; SIDES],
    /// Travel of the slider, m, and deviation, m, of the points that count, of each side, in the order of the travel.
    pub points: [Vec<[f64; 2]>; SIDES],
}

/// Why measured points are of no use.
#[derive(Clone, Debug, PartialEq)]
pub enum MeasuredError {
    /// They cannot be brought to the design.
    Registration(RegistrationError),
    /// Their deviations cannot be smoothed.
    Smoothing(SmoothingError),
}

impl std::fmt::Display for MeasuredError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Registration(error) => error.fmt(f),
            Self::Smoothing(error) => error.fmt(f),
        }
    }
}

/// Points measured on the surface of a cam, in coordinates of the drawing or of a measuring machine nearly so.
#[derive(Clone, Debug, Default)]
pub struct Points {
    /// Right and left side, m; x to the right.
    pub sides_m: [Vec<[f64; 2]>; SIDES],
    /// Standard deviation of the measurement along the normal, m; by cross-validation where it is not known.
    pub noise_m: Option<f64>,
}

/// The exact profile of a side: the path offset by the roller, in coordinates of the side.
struct Flank<'a> {
    cut: &'a Cut,
    side: usize,
    roller_m: f64,
    range_m: [f64; 2],
}

impl PlaneCurve for Flank<'_> {
    fn range(&self) -> [f64; 2] {
        self.range_m
    }

    fn at(&self, lambda_m: f64) -> CurvePoint {
        let p = self.cut.at(self.side, lambda_m);
        let lower = |j: Jet| Jet([j.derivative(1), j.derivative(2), 0.5 * j.derivative(3), 0.0]);
        let (dx, dy) = (lower(p.x), lower(p.y));
        let speed = (dx * dx + dy * dy).sqrt();
        let r = self.roller_m * self.cut.purpose().springs.sense();
        let (x, y) = (p.x - dy / speed * r, p.y + dx / speed * r);
        let pick = |order: usize| [x.derivative(order), y.derivative(order)];
        CurvePoint { point_m: pick(0), first_m: pick(1), second_m: pick(2) }
    }
}

/// A smoothed deviation over the arc length of the path, constant beyond its ends.
#[derive(Clone, Debug)]
pub struct Smoothed {
    spline: SmoothingSpline<1>,
}

impl NormalError for Smoothed {
    fn at(&self, arc_m: f64) -> [f64; 3] {
        let [from, to] = self.spline.range();
        let inside = arc_m.clamp(from, to);
        let [e, slope, bend, _] = self.spline.derivatives(inside).map(|d| d[0]);
        if arc_m.to_bits() == inside.to_bits() { [e, slope, bend] } else { [e, 0.0, 0.0] }
    }
}

/// Registers measured points and smooths what is left.
///
/// # Errors
/// [`MeasuredError`]
pub fn measured(cut: &Cut, roller_m: f64, points: &Points) -> Result<Measured, MeasuredError> {
    let flank = |side: usize| {
        let [from, to] = cut.range_m();
        let start = corner(cut, side, roller_m).map_or(from, |c| c.lambda_m);
        // Next to the cusp the profile has no direction.
        Flank { cut, side, roller_m, range_m: [start + 1e-6 * (to - from), to] }
    };
    let (right, left) = (flank(0), Mirrored(flank(1)));
    let mut clouds = Vec::new();
    let mut sides = Vec::new();
    for (side, points_m) in points.sides_m.iter().enumerate() {
        if !points_m.is_empty() {
            let curve: &dyn PlaneCurve = if side == 0 { &right } else { &left };
            clouds.push(Cloud { curve, points_m });
            sides.push(side);
        }
    }
    let registration = register(&clouds, &Options::default()).map_err(MeasuredError::Registration)?;
    let mut errors = [None, None];
    let mut kept = [Vec::new(), Vec::new()];
    for (cloud, side) in sides.iter().copied().enumerate() {
        let arc = ArcLength::of(cut, side);
        // Distances are counted to the left of the curve: away from a cam between the rollers on the left side's mirror image.
        let sign = cut.purpose().springs.sense() * if side == 0 { -1.0 } else { 1.0 };
        let mut good: Vec<&Placed> = registration.points[cloud].iter().filter(|p| !p.beyond_end && !p.outlier).collect();
        good.sort_by(|a, b| a.parameter.total_cmp(&b.parameter));
        let places: Vec<f64> = good.iter().map(|p| arc.at(p.parameter)).collect();
        let values: Vec<[f64; 1]> = good.iter().map(|p| [sign * p.error_m]).collect();
        let amount = points.noise_m.map_or(Amount::CrossValidated, |deviation| Amount::Residual { deviation });
        let smooth = spline(&places, &values, None, amount).map_err(MeasuredError::Smoothing)?;
        errors[side] = Some(Arc::new(Smoothed { spline: smooth }));
        kept[side] = good.iter().map(|p| [cut.at(side, p.parameter).s.value(), sign * p.error_m]).collect();
    }
    Ok(Measured { registration, sides, errors, points: kept })
}

/// Two errors of the same profile.
#[derive(Debug)]
struct Sum([Arc<dyn NormalError>; 2]);

impl NormalError for Sum {
    fn at(&self, arc_m: f64) -> [f64; 3] {
        let [a, b] = self.0.each_ref().map(|e| e.at(arc_m));
        std::array::from_fn(|i| a[i] + b[i])
    }
}

/// A random error as a normal error.
#[derive(Debug)]
struct Random {
    wave: Waviness,
    /// Where it is needed often.
    table: Option<WavinessTable>,
}

impl NormalError for Random {
    fn at(&self, arc_m: f64) -> [f64; 3] {
        self.table.as_ref().and_then(|table| table.derivatives(arc_m)).unwrap_or_else(|| self.wave.derivatives(arc_m))
    }
}

/// Places per correlation length at which a draw is tabulated: between them it is exact to 1e-13 of its deviation, its slope to 1e-11.
const FINE: f64 = 16.0;
/// More places than this take longer than the draw itself where it is needed.
const MOST_PLACES: f64 = 20_000.0;

/// A random error of each side: standard deviation and correlation length, m, and a seed. `None` where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomProfile {
    /// Standard deviation along the normal, m.
    pub deviation_m: f64,
    /// Length over which deviations keep together, m.
    pub correlation_m: f64,
    /// The draw.
    pub seed: u64,
}

impl RandomProfile {
    /// The draw of a side; both sides are drawn apart.
    pub fn of(&self, side: usize) -> Option<Arc<dyn NormalError>> {
        Some(Arc::new(Random { wave: self.wave(side)?, table: None }))
    }

    /// The same draw, tabulated over a length from the start of the path, m: 20 times faster, with differences of rounding.
    pub fn along(&self, side: usize, length_m: f64) -> Option<Arc<dyn NormalError>> {
        let wave = self.wave(side)?;
        let step_m = self.correlation_m / FINE;
        let table = (length_m / step_m < MOST_PLACES).then(|| wave.table([0.0, length_m], step_m));
        Some(Arc::new(Random { wave, table }))
    }

    /// The waves of a side; `None` without deviation.
    pub(crate) fn wave(&self, side: usize) -> Option<Waviness> {
        let seed = self.seed.wrapping_mul(2).wrapping_add(side as u64);
        Waviness::new(self.deviation_m, self.correlation_m, seed).filter(|_| self.deviation_m > 0.0)
    }
}

/// What the profile of a side deviates, all together.
pub(crate) fn together(first: Option<Arc<dyn NormalError>>, second: Option<Arc<dyn NormalError>>) -> Option<Arc<dyn NormalError>> {
    match (first, second) {
        (Some(a), Some(b)) => Some(Arc::new(Sum([a, b]))),
        (a, b) => a.or(b),
    }
}
