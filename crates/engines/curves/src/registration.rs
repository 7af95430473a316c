//! Rigid registration of measured points to design curves, with weights that take the sting out of outliers.
//!
//! Each point is compared with the nearest place of its curve; the motion that makes the normal distances least in the sense of the
//! weights is taken, places and weights are found anew, until the motion rests: iterative closest points by iteratively reweighted least
//! squares (`bergstrom2014`), with Newton's method for the nearest place and Gauss–Newton steps that let points slide along the curve.
//! Theory: `docs/theory/curves.md`.
//!
//! ```
//! use forcewright_curves::plane::{CurvePoint, PlaneCurve};
//! use forcewright_curves::registration::{Cloud, Options, register};
//!
//! /// y = x² / 2
//! struct Parabola;
//! impl PlaneCurve for Parabola {
//!     fn range(&self) -> [f64; 2] {
//!         [-1.0, 1.0]
//!     }
//!     fn at(&self, x: f64) -> CurvePoint {
//!         CurvePoint { point_m: [x, 0.5 * x * x], first_m: [1.0, x], second_m: [0.0, 1.0] }
//!     }
//! }
//!
//! // Measured a little too high and too far to the right.
//! let points_m: Vec<[f64; 2]> = (-8..9).map(|k| 0.1 * f64::from(k)).map(|x| [x + 0.03, 0.5 * x * x + 0.02]).collect();
//! let found = register(&[Cloud { curve: &Parabola, points_m: &points_m }], &Options::default()).expect("a curve with a shape");
//! assert!(found.converged && found.angle_rad.abs() < 1e-12);
//! assert!((found.shift_m[0] + 0.03).abs() < 1e-12 && (found.shift_m[1] + 0.02).abs() < 1e-12);
//! ```

mod nearest;
mod step;

use std::fmt;

use crate::bounds::{Bounds, Motion};
use crate::plane::PlaneCurve;
use crate::vector::{add, dot, rotate, sub};
use nearest::Table;

/// Points that belong to one curve.
#[derive(Clone, Copy)]
pub struct Cloud<'a> {
    /// The design.
    pub curve: &'a dyn PlaneCurve,
    /// Measured points in any order, m.
    pub points_m: &'a [[f64; 2]],
}

/// How much a point counts, by its distance from the design over a robust scale of all distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Weights {
    /// All the same: least squares.
    Equal,
    /// 1 within `1.345` scales, falling with one over the distance outside (`huber1964`; constant for 95 % efficiency).
    Huber,
    /// `(1 − (e / 4.685 s)²)²`, and nothing outside (`beaton-tukey1974`; constant for 95 % efficiency).
    #[default]
    Tukey,
}

/// Limit of [`Weights::Huber`] in scales.
const HUBER: f64 = 1.345;

/// Limit of [`Weights::Tukey`] in scales.
const TUKEY: f64 = 4.685;

/// Standard deviation over median absolute value, of a normal distribution.
const FROM_MEDIAN: f64 = 1.4826;

/// Smallest scale, m: less is rounding.
const LEAST_SCALE_M: f64 = 1e-12;

impl Weights {
    fn of(self, in_scales: f64) -> f64 {
        let size = in_scales.abs();
        match self {
            Self::Equal => 1.0,
            Self::Huber => 1.0_f64.min(HUBER / size),
            Self::Tukey if size < TUKEY => {
                let inside = 1.0 - (size / TUKEY) * (size / TUKEY);
                inside * inside
            }
            Self::Tukey => 0.0,
        }
    }
}

/// How to register.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Weights; default Tukey's.
    pub weights: Weights,
    /// First guess of the angle, rad; default 0.
    pub start_angle_rad: f64,
    /// First guess of the shift, m; default none.
    pub start_shift_m: [f64; 2],
    /// The motion rests when no point moves farther, as a part of the size of the cloud or its distance from
    /// the origin; default 1e-14 (a few roundings).
    pub tolerance: f64,
    /// Most steps; default 100.
    pub iterations: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { weights: Weights::default(), start_angle_rad: 0.0, start_shift_m: [0.0; 2], tolerance: 1e-14, iterations: 100 }
    }
}

/// A measured point against the design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Where the motion brings it, m.
    pub point_m: [f64; 2],
    /// Parameter of the nearest place of its curve.
    pub parameter: f64,
    /// Distance from it along the normal, m: positive to the left of the curve's direction.
    pub error_m: f64,
    /// What it counts, from 0 to 1.
    pub weight: f64,
    /// Whether the nearest place is an end of the curve. It says nothing of the profile then, counts nothing and is in no statistic.
    pub beyond_end: bool,
    /// Whether it is farther away than 4.685 scales, for all kinds of weights.
    pub outlier: bool,
}

/// The motion from the measured points to the design, and how well they fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Registration {
    /// Turn about the origin, rad, before the shift.
    pub angle_rad: f64,
    /// Shift, m, after the turn.
    pub shift_m: [f64; 2],
    /// Standard deviation of the angle, rad: `scale · √(Jᵀ W J)⁻¹`. Like those of the shift, for errors without correlation between points;
    /// form errors with a correlation length of `m` points make it about `√(2.5 m)` times as large.
    pub angle_deviation_rad: f64,
    /// Standard deviations of the shift, m.
    pub shift_deviation_m: [f64; 2],
    /// Robust standard deviation of the distances, m: 1.4826 times the median of their absolute values; at least 1e-12.
    pub scale_m: f64,
    /// `√(Σ w e² / Σ w)`, m.
    pub weighted_rms_m: f64,
    /// `√(Σ e² / n)` of all points that are not beyond an end, m.
    pub rms_m: f64,
    /// Steps of the motion.
    pub iterations: usize,
    /// Whether the motion rests. If not, the result is that after the last step.
    pub converged: bool,
    /// All points in their order, one list for each cloud.
    pub points: Vec<Vec<Placed>>,
}

impl Registration {
    /// The motion from measured points to the design.
    pub fn motion(&self) -> Motion {
        Motion::new(self.angle_rad, self.shift_m)
    }

    /// Cloud and index of the outliers.
    pub fn outliers(&self) -> impl Iterator<Item = (usize, usize)> {
        let of_cloud = |(cloud, points): (usize, &Vec<Placed>)| {
            let far = points.iter().enumerate().filter(|(_, placed)| placed.outlier);
            far.map(|(index, _)| (cloud, index)).collect::<Vec<_>>()
        };
        self.points.iter().enumerate().flat_map(of_cloud)
    }
}

/// Why points cannot be registered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RegistrationError {
    /// Fewer than three points count.
    TooFew {
        /// How many.
        points: usize,
    },
    /// A point, a first guess or a place of a curve is not finite, or a range is empty.
    NotFinite {
        /// Which cloud, from 0.
        cloud: usize,
    },
    /// The points may slide along the curves without a change: lines and concentric circles do not hold them.
    Free,
}

impl fmt::Display for RegistrationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew { points } => write!(f, "{points} points lie beside a curve; registration needs at least 3. Give a first guess"),
            Self::NotFinite { cloud } => {
                write!(f, "a point, a first guess or the curve of cloud {cloud} is not finite, or its range is empty")
            }
            Self::Free => write!(f, "the points can slide along the curve; measure where its normals differ and do not meet in one point"),
        }
    }
}

impl std::error::Error for RegistrationError {}

/// The rigid motion that brings measured points nearest to their design curves; all clouds move together.
///
/// # Errors
/// [`RegistrationError`]
pub fn register(clouds: &[Cloud<'_>], options: &Options) -> Result<Registration, RegistrationError> {
    let start = [options.start_angle_rad, options.start_shift_m[0], options.start_shift_m[1]];
    let mut tables = Vec::with_capacity(clouds.len());
    for (index, cloud) in clouds.iter().enumerate() {
        let finite = cloud.points_m.iter().flatten().chain(&start).all(|x| x.is_finite());
        let table = Table::new(cloud.curve).filter(|_| finite).ok_or(RegistrationError::NotFinite { cloud: index })?;
        tables.push(table);
    }
    let points = || clouds.iter().flat_map(|cloud| cloud.points_m.iter().copied());
    let size = Bounds::of(points()).extent_m();
    // Rounding of a cloud far from the origin is that of its distance.
    let least_step_m = options.tolerance * points().flatten().fold(size, |reach, x| reach.max(x.abs()));
    let (mut angle_rad, mut shift_m) = (options.start_angle_rad, options.start_shift_m);
    let mut found = compare(clouds, &tables, options.weights, angle_rad, shift_m)?;
    let mut iterations = 0;
    loop {
        let step = step::step(&found.arms, shift_m, size)?;
        let rests = step.angle_rad.abs() * size + step.shift_m[0].abs().max(step.shift_m[1].abs()) <= least_step_m;
        if rests || iterations >= options.iterations {
            let [angle_deviation_rad, x_deviation_m, y_deviation_m] = step.deviations.map(|unit| unit * found.scale_m);
            let mean_square = |weight: fn(&Arm) -> f64| {
                let sum = found.arms.iter().map(|arm| weight(arm) * arm.error_m * arm.error_m).sum::<f64>();
                sum / found.arms.iter().map(weight).sum::<f64>()
            };
            return Ok(Registration {
                angle_rad,
                shift_m,
                angle_deviation_rad,
                shift_deviation_m: [x_deviation_m, y_deviation_m],
                scale_m: found.scale_m,
                weighted_rms_m: mean_square(|arm| arm.weight).sqrt(),
                rms_m: mean_square(|_| 1.0).sqrt(),
                iterations,
                converged: rests,
                points: found.points,
            });
        }
        angle_rad += step.angle_rad;
        shift_m = add(shift_m, step.shift_m);
        iterations += 1;
        found = compare(clouds, &tables, options.weights, angle_rad, shift_m)?;
    }
}

/// What a point that counts says about the motion.
struct Arm {
    point_m: [f64; 2],
    normal: [f64; 2],
    error_m: f64,
    weight: f64,
}

/// All points against the design for one motion.
struct Compared {
    points: Vec<Vec<Placed>>,
    arms: Vec<Arm>,
    scale_m: f64,
}

fn compare(
    clouds: &[Cloud<'_>],
    tables: &[Table],
    weights: Weights,
    angle_rad: f64,
    shift_m: [f64; 2],
) -> Result<Compared, RegistrationError> {
    let mut points: Vec<Vec<Placed>> = Vec::with_capacity(clouds.len());
    let mut arms = Vec::new();
    for (index, (cloud, table)) in clouds.iter().zip(tables).enumerate() {
        let mut placed = Vec::with_capacity(cloud.points_m.len());
        for measured in cloud.points_m {
            let point_m = add(rotate(*measured, angle_rad), shift_m);
            let nearest = table.nearest(cloud.curve, point_m);
            let to = sub(point_m, nearest.place.point_m);
            let (error_m, beyond_end) = (dot(to, nearest.normal), nearest.is_end);
            if !error_m.is_finite() {
                return Err(RegistrationError::NotFinite { cloud: index });
            }
            if !beyond_end {
                arms.push(Arm { point_m, normal: nearest.normal, error_m, weight: 1.0 });
            }
            placed.push(Placed { point_m, parameter: nearest.parameter, error_m, weight: 0.0, beyond_end, outlier: false });
        }
        points.push(placed);
    }
    if arms.len() < 3 {
        return Err(RegistrationError::TooFew { points: arms.len() });
    }
    let scale_m = (FROM_MEDIAN * median(arms.iter().map(|arm| arm.error_m.abs()).collect())).max(LEAST_SCALE_M);
    for arm in &mut arms {
        arm.weight = weights.of(arm.error_m / scale_m);
    }
    for placed in points.iter_mut().flatten().filter(|placed| !placed.beyond_end) {
        placed.weight = weights.of(placed.error_m / scale_m);
        placed.outlier = placed.error_m.abs() >= TUKEY * scale_m;
    }
    Ok(Compared { points, arms, scale_m })
}

/// The middle one of some values, or the mean of the two in the middle.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len() % 2 == 1 { values[half] } else { 0.5 * (values[half - 1] + values[half]) }
}
