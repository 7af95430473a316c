//! Smoothing splines of degree five through noisy values.
//!
//! The spline minimises `Σ wᵢ |yᵢ − f(tᵢ)|² + λ ∫ |f‴|² dt`: no smoother function is as near to the values. Of degree five, because a
//! force that follows from a measured curve needs its curvature, and an acceleration the slope of that. How much is smoothed follows
//! from the standard deviation of the values or, if that is unknown, from the values themselves. Time and memory grow with the number of
//! values, not faster. Theory: `docs/theory/curves.md`; the method is that of `reinsch1967` one degree higher.
//!
//! ```
//! use forcewright_curves::smoothing::{self, Amount};
//!
//! let points: Vec<[f64; 2]> = (0..50).map(|k| [f64::from(k), f64::from(k * k) + 0.1 * f64::from(k % 2)]).collect();
//! let parameters: Vec<f64> = points.iter().map(|p| p[0]).collect();
//! let values: Vec<[f64; 1]> = points.iter().map(|p| [p[1]]).collect();
//! let smooth = smoothing::spline(&parameters, &values, None, Amount::CrossValidated).expect("more than four points");
//! let [value, slope, second, _] = smooth.derivatives(25.0);
//! assert!((value[0] - 625.05).abs() < 0.01 && (slope[0] - 50.0).abs() < 0.01 && (second[0] - 2.0).abs() < 0.01);
//! ```

mod banded;
mod system;

use std::f64::consts::TAU;
use std::fmt;

use forcewright_base::maths::{exp, ln, powi};
use forcewright_base::roots;

use crate::plane::{CurvePoint, PlaneCurve};
use crate::vector::distance;
use system::{Solved, System, third_on_span};

/// How much is smoothed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// So much that the mean square of what is left is that of the noise: `Σ w |y − f|² = n σ²` (`reinsch1967`), with the standard
    /// deviation of a coordinate of weight 1, in [`curve`] that across the curve. Smooths a little too much, as the spline follows a part of
    /// the noise.
    Residual {
        /// In the unit of the values; above 0.
        deviation: f64,
    },
    /// So much that the expected mean square distance from the truth is least, for noise of a known standard deviation:
    /// `Σ w |y − f|² − 2 σ² tr(I − A)` is least (`craven-wahba1979`).
    Risk {
        /// In the unit of the values; above 0.
        deviation: f64,
    },
    /// By generalised cross-validation: `Σ w |y − f|² / tr(I − A)²` is least (`craven-wahba1979`). Needs noise without correlation between
    /// neighbours: noise that is smooth itself passes for signal.
    CrossValidated,
    /// Ripples of this wavelength keep half of their height, shorter ones less by the sixth power; above 0.
    Cutoff {
        /// In the unit of the parameter.
        wavelength: f64,
    },
}

/// Why there is no smoothing spline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SmoothingError {
    /// Fewer than four different parameters are left.
    TooFew {
        /// How many.
        places: usize,
    },
    /// Lists of different lengths.
    Lengths {
        /// Number of parameters.
        parameters: usize,
        /// Number of values or weights.
        others: usize,
    },
    /// A parameter, value or weight is not finite, or a weight is not above 0.
    Value {
        /// Which, from 0.
        index: usize,
    },
    /// A parameter is smaller than the one before it.
    Order {
        /// Which, from 0.
        index: usize,
    },
    /// A standard deviation or wavelength is not a number above 0.
    Amount {
        /// What was given.
        value: f64,
    },
    /// The spaces between the parameters differ by more than arithmetic can bear.
    Spacing,
}

impl fmt::Display for SmoothingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew { places } => write!(f, "{places} different places are too few for a smoothing spline; it needs at least 4"),
            Self::Lengths { parameters, others } => write!(f, "{parameters} parameters, but {others} values or weights"),
            Self::Value { index } => write!(f, "entry {index} is not finite, or its weight is not above 0"),
            Self::Order { index } => write!(f, "parameter {index} is smaller than the one before it; sort the values"),
            Self::Amount { value } => write!(f, "smoothing by {value} is not possible; give a number above 0"),
            Self::Spacing => write!(f, "the spaces between the parameters differ too much; thin out the dense places"),
        }
    }
}

impl std::error::Error for SmoothingError {}

/// What the smoothing did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smoothness {
    /// Wavelength of ripples that keep half of their height, in the unit of the parameter, at the mean spacing.
    pub cutoff: f64,
    /// Root of the weighted mean square of what was taken away, in the unit of the values; all coordinates together.
    pub residual: f64,
    /// `tr A`: how many free numbers the spline used for each coordinate; from 3 to the number of places.
    pub freedom: f64,
    /// Estimate of the standard deviation as in [`Amount::Residual`]: the root of `Σ w |y − f|² / tr(I − A)`, per coordinate.
    pub noise: f64,
    /// Number of places after those at the same parameter were joined.
    pub places: usize,
    /// Whether the wanted amount lies outside what is computed: from about half a spacing to about 400 spacings for `cutoff`. The result
    /// is then that at the border.
    pub limited: bool,
}

/// Border of the logarithm of `λ`, for knots that ascend by 1 and weights of 1. Beyond the upper one rounding in the matrix reaches what it
/// says of the smoothest functions; below the lower one the spline goes through the values.
const LOG_LAMBDA: [f64; 2] = [-18.0, 25.0];

/// Places nearer than this part of the mean spacing are joined.
const JOINED: f64 = 1e-4;

/// Value, three derivatives, and the second half of a quintic: coefficients of the powers of the distance from the left end over their
/// factorials 1, 1, 2, 6, 24, 60.
type Span<const K: usize> = [[f64; K]; 6];

/// A smoothing spline of degree five with values of `K` coordinates; four times continuously differentiable, and beyond its ends the
/// parabola that continues it.
#[derive(Clone, Debug, PartialEq)]
pub struct SmoothingSpline<const K: usize> {
    knots: Vec<f64>,
    /// One more than there are spans: the last one lies beyond the end.
    spans: Vec<Span<K>>,
    smoothness: Smoothness,
}

impl<const K: usize> SmoothingSpline<K> {
    /// First and last parameter.
    pub fn range(&self) -> [f64; 2] {
        [self.knots[0], self.knots[self.knots.len() - 1]]
    }

    /// The parameters of the places, ascending.
    pub fn parameters(&self) -> &[f64] {
        &self.knots
    }

    /// What the smoothing did.
    pub fn smoothness(&self) -> Smoothness {
        self.smoothness
    }

    /// Value and first three derivatives at a parameter.
    pub fn derivatives(&self, parameter: f64) -> [[f64; K]; 4] {
        let after = self.knots.partition_point(|knot| *knot <= parameter);
        let span = after.saturating_sub(1);
        let [f, f1, f2, mut a, mut b, mut c] = self.spans[span];
        if after == 0 {
            (a, b, c) = ([0.0; K], [0.0; K], [0.0; K]);
        }
        let s = parameter - self.knots[span];
        let each = |value: &dyn Fn(usize) -> f64| std::array::from_fn(value);
        [
            each(&|k| f[k] + s * (f1[k] + s * (f2[k] / 2.0 + s * (a[k] / 6.0 + s * (b[k] / 24.0 + s * c[k] / 60.0))))),
            each(&|k| f1[k] + s * (f2[k] + s * (a[k] / 2.0 + s * (b[k] / 6.0 + s * c[k] / 12.0)))),
            each(&|k| f2[k] + s * (a[k] + s * (b[k] / 2.0 + s * c[k] / 3.0))),
            each(&|k| a[k] + s * (b[k] + s * c[k])),
        ]
    }

    /// Value at a parameter.
    pub fn value(&self, parameter: f64) -> [f64; K] {
        self.derivatives(parameter)[0]
    }
}

impl PlaneCurve for SmoothingSpline<2> {
    fn range(&self) -> [f64; 2] {
        SmoothingSpline::range(self)
    }

    fn at(&self, parameter: f64) -> CurvePoint {
        let [point_m, first_m, second_m, _] = self.derivatives(parameter);
        CurvePoint { point_m, first_m, second_m }
    }
}

/// A smoothing spline through the points of a plane curve in their order, m. The parameter is the sum of the chords from the first point,
/// m; points at the same place are joined, with the sum of their weights. Weights are the inverse squares of standard deviations, relative
/// to that of a point of weight 1; all 1 if not given.
///
/// # Errors
/// [`SmoothingError`]
pub fn curve(points_m: &[[f64; 2]], weights: Option<&[f64]>, amount: Amount) -> Result<SmoothingSpline<2>, SmoothingError> {
    let mut along = 0.0;
    let chords = points_m.iter().enumerate().map(|(k, point)| {
        along += k.checked_sub(1).map_or(0.0, |before| distance(*point, points_m[before]));
        along
    });
    let parameters: Vec<f64> = chords.collect();
    // What noise moves a point along the curve, its parameter follows: only the part across is left.
    smoothed(&parameters, points_m, weights, amount, 1)
}

/// A smoothing spline through values at parameters that do not descend. Values at the same parameter are joined, with the sum of their
/// weights. Weights as for [`curve`].
///
/// # Errors
/// [`SmoothingError`]
pub fn spline<const K: usize>(
    parameters: &[f64],
    values: &[[f64; K]],
    weights: Option<&[f64]>,
    amount: Amount,
) -> Result<SmoothingSpline<K>, SmoothingError> {
    smoothed(parameters, values, weights, amount, K)
}

/// With the number of coordinates in which the noise shows.
fn smoothed<const K: usize>(
    parameters: &[f64],
    values: &[[f64; K]],
    weights: Option<&[f64]>,
    amount: Amount,
    noisy: usize,
) -> Result<SmoothingSpline<K>, SmoothingError> {
    check(parameters, values, weights, amount)?;
    let places = joined(parameters, values, weights);
    let count = places.len();
    if count < 4 {
        return Err(SmoothingError::TooFew { places: count });
    }
    let origin = places[0].0;
    let spacing = (places[count - 1].0 - origin) / (count - 1) as f64;
    let scaled = places.iter().map(|place| (place.0 - origin) / spacing).collect();
    let system = System::new(scaled, places.iter().map(|place| place.1).collect(), places.iter().map(|place| place.2).collect());
    let (solved, log_lambda, limited) = choose(&system, amount, spacing, noisy as f64).ok_or(SmoothingError::Spacing)?;
    let freedom_left = system.freedom_left(&solved);
    let smoothness = Smoothness {
        cutoff: TAU * spacing * exp(log_lambda / 6.0),
        residual: (solved.residual / places.iter().map(|place| place.2).sum::<f64>()).sqrt(),
        freedom: count as f64 - freedom_left,
        noise: (solved.residual / (freedom_left * noisy as f64)).sqrt(),
        places: count,
        limited,
    };
    let spans = spans(&system.knots, &solved, spacing);
    Ok(SmoothingSpline { knots: places.iter().map(|place| place.0).collect(), spans, smoothness })
}

fn check<const K: usize>(parameters: &[f64], values: &[[f64; K]], weights: Option<&[f64]>, amount: Amount) -> Result<(), SmoothingError> {
    for others in [values.len(), weights.map_or(parameters.len(), <[f64]>::len)] {
        if others != parameters.len() {
            return Err(SmoothingError::Lengths { parameters: parameters.len(), others });
        }
    }
    for (index, (parameter, value)) in parameters.iter().zip(values).enumerate() {
        let weight = weights.map_or(1.0, |weights| weights[index]);
        if !(parameter.is_finite() && value.iter().all(|x| x.is_finite()) && weight > 0.0 && weight.is_finite()) {
            return Err(SmoothingError::Value { index });
        }
    }
    if let Some(index) = parameters.windows(2).position(|pair| pair[1] < pair[0]) {
        return Err(SmoothingError::Order { index: index + 1 });
    }
    let given = match amount {
        Amount::Residual { deviation } | Amount::Risk { deviation } => Some(deviation),
        Amount::Cutoff { wavelength } => Some(wavelength),
        Amount::CrossValidated => None,
    };
    match given.filter(|value| !(*value > 0.0 && value.is_finite())) {
        Some(value) => Err(SmoothingError::Amount { value }),
        None => Ok(()),
    }
}

/// Parameter, value and weight of each place.
fn joined<const K: usize>(parameters: &[f64], values: &[[f64; K]], weights: Option<&[f64]>) -> Vec<(f64, [f64; K], f64)> {
    let whole = parameters.last().map_or(0.0, |last| last - parameters[0]);
    let near = JOINED * whole / parameters.len() as f64;
    let mut places: Vec<(f64, [f64; K], f64)> = Vec::with_capacity(parameters.len());
    for (k, (parameter, value)) in parameters.iter().zip(values).enumerate() {
        let weight = weights.map_or(1.0, |weights| weights[k]);
        match places.last_mut() {
            Some((at, mean, sum)) if parameter - *at <= near => {
                let part = weight / (*sum + weight);
                *at += part * (parameter - *at);
                for (m, v) in mean.iter_mut().zip(value) {
                    *m += part * (v - *m);
                }
                *sum += weight;
            }
            _ => places.push((*parameter, *value, weight)),
        }
    }
    places
}

/// The spline for the amount, the logarithm of its `λ` for weights of 1 on average, and whether that is at its border. Absent if no system
/// could be solved.
fn choose<const K: usize>(system: &System<K>, amount: Amount, spacing: f64, noisy: f64) -> Option<(Solved<K>, f64, bool)> {
    let mean_weight = system.mean_weight();
    let count = system.knots.len() as f64;
    let solve = |log_lambda: f64| system.solve(mean_weight * exp(log_lambda));
    let log_lambda = match amount {
        Amount::Cutoff { wavelength } => 6.0 * ln(wavelength / (TAU * spacing)),
        Amount::Residual { deviation } => {
            let target = count * noisy * deviation * deviation;
            // grows with λ
            let excess = |log_lambda: f64| solve(log_lambda).map_or(f64::INFINITY, |solved| solved.residual / target - 1.0);
            let [low, high] = LOG_LAMBDA;
            if excess(high) < 0.0 {
                f64::INFINITY
            } else if excess(low) > 0.0 {
                f64::NEG_INFINITY
            } else {
                // One more power of ten changes the residual by less than that: far more digits than the amount deserves.
                roots::root(excess, low, high, 1e-10).ok()?
            }
        }
        Amount::Risk { deviation } => least(|log_lambda| {
            let solved = solve(log_lambda)?;
            Some(solved.residual - 2.0 * noisy * deviation * deviation * system.freedom_left(&solved))
        }),
        Amount::CrossValidated => least(|log_lambda| {
            let solved = solve(log_lambda)?;
            let left = system.freedom_left(&solved) / count;
            Some(solved.residual / (left * left))
        }),
    };
    let bounded = log_lambda.clamp(LOG_LAMBDA[0], LOG_LAMBDA[1]);
    let limited = (log_lambda - bounded).abs() > 0.0;
    Some((solve(bounded)?, bounded, limited))
}

/// Where a criterion is least over all `λ`: the least of a table, then between its neighbours. Infinite if that is the end of the table.
fn least(criterion: impl Fn(f64) -> Option<f64>) -> f64 {
    const STEPS: i32 = 43;
    let [low, high] = LOG_LAMBDA;
    let place = |k: i32| low + (high - low) * f64::from(k) / f64::from(STEPS);
    let value = |at: f64| criterion(at).unwrap_or(f64::INFINITY);
    let best = (0..=STEPS).map(|k| (value(place(k)), k)).min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, k)| k);
    match best {
        0 => f64::NEG_INFINITY,
        STEPS => f64::INFINITY,
        k => roots::minimise(value, place(k - 1), place(k + 1), 1e-6).x,
    }
}

/// The spline in powers of the distance from each knot, in the unit of the parameter.
///
/// Its third derivative is known on each span. Value, slope and second derivative at a knot follow from the values at the knots beside it.
fn spans<const K: usize>(knots: &[f64], solved: &Solved<K>, spacing: f64) -> Vec<Span<K>> {
    let count = knots.len();
    let thirds: Vec<[[f64; K]; 3]> = (0..count - 1).map(|span| third_on_span(knots, &solved.gamma, span)).collect();
    let width = |span: usize| knots[span + 1] - knots[span];
    let mut spans: Vec<Span<K>> = vec![[[0.0; K]; 6]; count];
    for k in 0..K {
        let third = |span: usize| thirds[span].map(|c| c[k]);
        let value = |knot: usize| solved.fitted[knot][k];
        let mut slopes = vec![[0.0; 2]; count];
        for (i, slope) in slopes.iter_mut().enumerate().take(count - 1).skip(1) {
            let (before, after) = (width(i - 1), width(i));
            // Slopes of the parabolas that are left of the chords when the third derivative is taken off.
            let left = (value(i) - value(i - 1) + rise(shifted(third(i - 1), before), -before)[0]) / before;
            let right = (value(i + 1) - value(i) - rise(third(i), after)[0]) / after;
            *slope = [(left * after + right * before) / (before + after), 2.0 * (right - left) / (before + after)];
        }
        slopes[0] = continued(slopes[1], shifted(third(0), width(0)), -width(0));
        slopes[count - 1] = continued(slopes[count - 2], third(count - 2), width(count - 2));
        for (i, span) in spans.iter_mut().enumerate() {
            let [a, b, c] = if i + 1 < count { third(i) } else { [0.0; 3] };
            let unscaled = [value(i), slopes[i][0], slopes[i][1], a, b, c];
            for (power, (entry, coefficient)) in (0..).zip(span.iter_mut().zip(unscaled)) {
                entry[k] = coefficient / powi(spacing, power);
            }
        }
    }
    spans
}

/// A quadratic about a place at a distance from that about which it is given.
fn shifted([a, b, c]: [f64; 3], distance: f64) -> [f64; 3] {
    [a + distance * (b + distance * c), b + 2.0 * distance * c, c]
}

/// What a third derivative, a quadratic of the distance, adds to value, slope and second derivative over a distance.
fn rise([a, b, c]: [f64; 3], s: f64) -> [f64; 3] {
    [
        s * s * s * (a / 6.0 + s * (b / 24.0 + s * c / 60.0)),
        s * s * (a / 2.0 + s * (b / 6.0 + s * c / 12.0)),
        s * (a + s * (b / 2.0 + s * c / 3.0)),
    ]
}

/// Slope and second derivative at a distance.
fn continued([slope, second]: [f64; 2], third: [f64; 3], distance: f64) -> [f64; 2] {
    let [_, more_slope, more_second] = rise(third, distance);
    [slope + second * distance + more_slope, second + more_second]
}
