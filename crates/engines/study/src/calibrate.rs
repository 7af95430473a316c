//! Parameters of a design from a measured curve: estimates with intervals, what the measurement cannot tell apart, and what it shows that
//! no values of the parameters explain.
//!
//! [`fit`] sees a [`Model`], parameters in and a value per measured point out; [`Curve`] makes one of an
//! [`Evaluator`](crate::evaluator::Evaluator) and a bench. Nonlinear least squares within bounds by Levenberg and Marquardt, with normal
//! priors and losses that far points do not spoil; Student's intervals from the tangents at the optimum, and intervals of the profile
//! likelihood, which need no tangents. Theory: `docs/theory/calibrate.md`.

mod curve;
mod filter;
mod identify;
mod linear;
mod loss;
mod profile;
mod residuals;
mod search;
mod stations;

use std::fmt;

pub use curve::{Bench, BenchParameter, Branch, Curve, CurveError};
pub use filter::{Filter, FilterError};
pub use identify::{Identified, Loose};
pub use loss::{Loss, mad};
pub use residuals::{Against, LackOfFit, Residuals, Runs, SignTest, Stretch};
pub use search::Stop;

pub(crate) use linear::Singular;
use linear::Triangle;
use search::{Found, MOST_ROUNDS, Place, Problem};

use crate::evaluator::{Evaluation, Failure, Workspace};
use crate::sampling::{Confidence, Estimate, Interval, student};

/// A value per measured point, for any values of the parameters: a pure function.
pub trait Model: Sync {
    /// Room for one thread.
    fn room(&self) -> Workspace {
        Workspace::new(())
    }

    /// Values of the points at `x`, SI, and a row of derivatives for each if `derivatives` is set.
    ///
    /// # Errors
    /// [`Failure`] where there are none.
    fn predict(&self, x: &[f64], derivatives: bool, room: &mut Workspace, out: &mut Evaluation) -> Result<(), Failure>;
}

/// The values that a parameter may take, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Smallest.
    pub lower: f64,
    /// Largest.
    pub upper: f64,
}

/// What is known of a parameter beside the measurement: a normal distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Its mean, SI.
    pub mean: f64,
    /// Its standard deviation, SI, positive.
    pub sd: f64,
}

/// A parameter that is looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its path in the project file, for messages.
    pub name: String,
    /// Where the search begins, SI.
    pub start: f64,
    /// The values that it may take.
    pub limits: Limits,
    /// What is a large change of it, SI, positive: parameters are compared by it.
    pub scale: f64,
    /// What is known of it already.
    pub prior: Option<Prior>,
}

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Plan {
    /// How much far points count.
    pub loss: Loss,
    /// Of all intervals.
    pub confidence: Confidence,
    /// Whether intervals of the profile likelihood are looked for.
    pub profiles: bool,
    /// What the model itself is wrong by, over the largest value measured: less is not called unexplained.
    pub accuracy: f64,
}

impl Default for Plan {
    fn default() -> Self {
        Self { loss: Loss::Squares, confidence: Confidence::P95, profiles: true, accuracy: 1e-4 }
    }
}

/// What was measured.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    /// Places, SI: for the order of the residuals and for repeats. Points of one branch come together.
    pub x: &'a [f64],
    /// Values that are fitted, SI: filtered, if they were.
    pub y: &'a [f64],
    /// Values as they were measured: the scatter and what is unexplained are judged by them, since a filter makes errors that depend on
    /// each other.
    pub raw: &'a [f64],
    /// Number of points of each branch.
    pub branches: &'a [usize],
}

/// Where a calibration stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// The search.
    Search {
        /// Finished rounds.
        rounds: usize,
        /// Weighted squares with those of the priors.
        squares: f64,
    },
    /// Intervals of the profile likelihood.
    Intervals {
        /// Ends that were found, two per parameter.
        found: usize,
        /// Ends that are looked for.
        of: usize,
    },
}

/// Is told where a calibration stands, and says whether to go on. Several threads ask, one after the other.
pub type Watch<'a> = &'a mut (dyn FnMut(Progress) -> bool + Send);

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq)]
pub enum CalibrateError {
    /// No parameter.
    NoParameter,
    /// Not one place, value and raw value per point.
    Shape {
        /// Places, values, raw values, points in branches.
        lengths: [usize; 4],
    },
    /// Too few points for the parameters. Points that repeat each other exactly are one.
    TooFew {
        /// Different points.
        points: usize,
        /// Parameters.
        parameters: usize,
    },
    /// Bounds the wrong way round, a scale or a prior that is not positive, a number that is not finite.
    Parameter {
        /// Its name.
        name: String,
    },
    /// A measured value is not finite.
    NotFinite,
    /// The model has no values where the search begins.
    NoStart(Failure),
}

impl fmt::Display for CalibrateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoParameter => f.write_str("there is no parameter to look for"),
            Self::Shape { lengths: [x, y, raw, points] } => write!(f, "{x} places, {y} values, {raw} raw values, {points} in branches"),
            Self::TooFew { points, parameters } => {
                write!(f, "{points} different points are too few for {parameters} parameters: at least {} are needed", parameters + 2)
            }
            Self::Parameter { name } => write!(f, "bounds, start, scale or prior of `{name}` make no sense"),
            Self::NotFinite => f.write_str("a measured value is not a finite number"),
            Self::NoStart(failure) => write!(f, "the design of the file has no curve: {}", failure.reason),
        }
    }
}

impl std::error::Error for CalibrateError {}

/// The bound that an estimate lies at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// The lower.
    Lower,
    /// The upper.
    Upper,
}

/// What was found of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimated {
    /// The parameter.
    pub parameter: Parameter,
    /// The estimate with Student's interval, within the bounds; unbounded on both sides where nothing is known, as after a search that did
    /// not come to its end ([`Fit::stop`]).
    pub estimate: Estimate,
    /// Standard error; infinite where nothing is known, 0 at a bound where the search came to its end.
    pub error: f64,
    /// Interval of the profile likelihood, within the bounds, where it was looked for: about an optimum that is one.
    pub profile: Option<Interval>,
    /// The bound that holds it, if one does.
    pub at: Option<Bound>,
}

/// A fit.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The parameters.
    pub parameters: Vec<Estimated>,
    /// Correlations of the estimates, row by row; 0 beside a parameter that is at a bound or not determined.
    pub correlations: Vec<f64>,
    /// Scatter of a point about the curve, one standard deviation, SI.
    pub noise: f64,
    /// Degrees of freedom that it is known with: points less parameters, of which those count in part that a prior holds; what no point
    /// determines takes none.
    pub degrees: f64,
    /// Values of the model at the start.
    pub before: Vec<f64>,
    /// Values of the model at the estimates.
    pub after: Vec<f64>,
    /// Standard error of the curve at each point, from the covariance of the parameters.
    pub curve_error: Vec<f64>,
    /// Weight of each point, 1 where it counts in full.
    pub weights: Vec<f64>,
    /// What the measurement can tell of the parameters.
    pub identified: Identified,
    /// What the curve does not explain.
    pub residuals: Residuals,
    /// How the search ended.
    pub stop: Stop,
    /// Whether the search came to its end, whatever became of the profiles. If not, nothing is known of errors and intervals.
    pub ended: bool,
    /// Rounds of the search.
    pub rounds: usize,
}

impl Fit {
    /// Student's quantile of all intervals.
    pub fn quantile(&self, confidence: Confidence) -> f64 {
        student(self.degrees, confidence)
    }
}

/// Times that a fit begins again from a better place that a profile found.
const MOST_RESTARTS: usize = 3;
/// Rounds of weights and scatter.
const MOST_WEIGHTINGS: usize = 100;
/// Change of all parameters, in standard errors, below which weights rest.
const AT_REST: f64 = 1e-6;
/// Singular values below this part of the largest are rounding: the parameters of these directions are not determined.
const RANK: f64 = 1e-9;
/// Share of a parameter in such a direction from which it counts as not determined.
const INVOLVED: f64 = 1e-3;

/// Estimates the parameters of a model from what was measured. Told to stop by `watch`, it keeps the best parameters so far, and those
/// intervals of the profile likelihood that it has.
///
/// ```
/// use forcewright_study::calibrate::{Limits, Measured, Model, Parameter, Plan, fit};
/// use forcewright_study::evaluator::{Evaluation, Failure, Workspace};
///
/// /// F = k x
/// struct Spring(Vec<f64>);
/// impl Model for Spring {
///     fn predict(&self, k: &[f64], _: bool, _: &mut Workspace, out: &mut Evaluation) -> Result<(), Failure> {
///         out.values = self.0.iter().map(|x| k[0] * x).collect();
///         out.jacobian = self.0.clone();
///         Ok(())
///     }
/// }
/// let (x, y) = (vec![1.0, 2.0, 3.0, 4.0], vec![2.1, 3.9, 6.2, 7.9]);
/// let rate = Parameter { name: "rate".into(), start: 1.0, limits: Limits { lower: 0.0, upper: 1e3 }, scale: 1.0, prior: None };
/// let measured = Measured { x: &x, y: &y, raw: &y, branches: &[4] };
/// let found = fit(&Spring(x.clone()), &[rate], measured, &Plan::default(), &mut |_| true)?;
/// // k = Σ x y / Σ x² = 60.1/30
/// assert!((found.parameters[0].estimate.value - 60.1 / 30.0).abs() < 1e-12);
/// assert!(found.parameters[0].estimate.interval.contains(2.0));
/// # Ok::<(), forcewright_study::calibrate::CalibrateError>(())
/// ```
///
/// # Errors
/// [`CalibrateError`]: parameters or points that make no sense, or a start without values.
pub fn fit(
    model: &dyn Model,
    parameters: &[Parameter],
    measured: Measured<'_>,
    plan: &Plan,
    watch: Watch<'_>,
) -> Result<Fit, CalibrateError> {
    check(parameters, &measured)?;
    let limits: Vec<Limits> = parameters.iter().map(|p| p.limits).collect();
    let start: Vec<f64> = parameters.iter().map(|p| p.start).collect();
    let mut room = model.room();
    let mut before = Evaluation::default();
    model.predict(&start, false, &mut room, &mut before).map_err(CalibrateError::NoStart)?;
    let sizes: Vec<f64> = parameters.iter().map(|p| p.scale).collect();
    let weighted = Weighting { model, parameters, limits: &limits, sizes: &sizes, measured, loss: plan.loss };
    let search = &mut |rounds, squares| watch(Progress::Search { rounds, squares });
    let settled = weighted.settle(&start, &mut room, search).map_err(CalibrateError::NoStart)?;
    let Judged { settled, known, profiles, ended } = weighted.judged(settled, plan, &mut room, watch);
    let t = student(known.degrees, plan.confidence);
    let each = parameters.iter().enumerate().zip(profiles).map(|((i, parameter), profile)| {
        let (value, at) = (settled.found.place.x[i], known.at[i]);
        // Tangents beside the optimum are no knowledge.
        let error = if ended { known.errors[i] } else { f64::INFINITY };
        // Nor is a bound that holds an estimate: its interval reaches as far as the likelihood says.
        let half = if at.is_some() { f64::INFINITY } else { t * error };
        let student = Interval { low: (value - half).max(parameter.limits.lower), high: (value + half).min(parameter.limits.upper) };
        let interval = profile.filter(|_| at.is_some()).unwrap_or(student);
        Estimated { parameter: parameter.clone(), estimate: Estimate { value, interval }, error, profile, at }
    });
    let each = each.collect();
    let after = settled.found.place.out.values.clone();
    let raw: Vec<f64> = measured.raw.iter().zip(&after).map(|(m, v)| m - v).collect();
    let largest = measured.y.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
    let jacobian = &settled.found.place.out.jacobian;
    let residuals = Residuals::of(&measured, &raw, (jacobian, parameters.len()), (known.noise, plan.accuracy * largest), plan.loss);
    Ok(Fit {
        parameters: each,
        correlations: known.correlations(),
        noise: known.noise,
        degrees: known.degrees,
        before: before.values,
        curve_error: known.curve_error(jacobian),
        after,
        identified: Identified::of(jacobian, &settled, parameters, &known),
        weights: settled.weights.clone(),
        residuals,
        stop: settled.found.stop,
        ended,
        rounds: settled.rounds,
    })
}

fn check(parameters: &[Parameter], measured: &Measured<'_>) -> Result<(), CalibrateError> {
    let points = measured.y.len();
    let lengths = [measured.x.len(), points, measured.raw.len(), measured.branches.iter().sum()];
    if lengths.iter().any(|n| *n != points) {
        return Err(CalibrateError::Shape { lengths });
    }
    if parameters.is_empty() {
        return Err(CalibrateError::NoParameter);
    }
    let different = different(measured);
    if different < parameters.len() + 2 {
        return Err(CalibrateError::TooFew { points: different, parameters: parameters.len() });
    }
    let sound = |p: &Parameter| {
        let prior = p.prior.is_none_or(|q| q.mean.is_finite() && q.sd > 0.0 && q.sd.is_finite());
        p.start.is_finite() && p.scale > 0.0 && p.scale.is_finite() && p.limits.lower < p.limits.upper && prior
    };
    if let Some(wrong) = parameters.iter().find(|p| !sound(p)) {
        return Err(CalibrateError::Parameter { name: wrong.name.clone() });
    }
    let all = measured.x.iter().chain(measured.y).chain(measured.raw);
    if all.copied().all(f64::is_finite) { Ok(()) } else { Err(CalibrateError::NotFinite) }
}

/// How many points differ in place or value from all others: what is there twice scatters no more than once.
fn different(measured: &Measured<'_>) -> usize {
    let mut all: Vec<[u64; 2]> = measured.x.iter().zip(measured.raw).map(|(x, y)| [x.to_bits(), y.to_bits()]).collect();
    all.sort_unstable();
    all.dedup();
    all.len()
}

/// A fit whose weights and scatter are looked for together with its parameters.
struct Weighting<'a> {
    model: &'a dyn Model,
    parameters: &'a [Parameter],
    limits: &'a [Limits],
    sizes: &'a [f64],
    measured: Measured<'a>,
    loss: Loss,
}

/// Parameters with the weights and the scatter that belong to them.
struct Settled {
    found: Found,
    weights: Vec<f64>,
    /// Scatter of a point.
    noise: f64,
    /// Scatter by which residuals are far.
    scale: f64,
    /// Loss of the points.
    loss: Loss,
    rounds: usize,
}

/// What the optimum says.
struct Judged {
    settled: Settled,
    known: Known,
    profiles: Vec<Option<Interval>>,
    /// Whether the search came to its end, whatever became of the profiles.
    ended: bool,
}

impl Weighting<'_> {
    /// Tangents and profiles where a search ended; if a profile finds a better place, again from there.
    fn judged(&self, mut settled: Settled, plan: &Plan, room: &mut Workspace, watch: Watch<'_>) -> Judged {
        let none = vec![None; self.parameters.len()];
        let mut restarts = 0;
        loop {
            self.forgive(&mut settled, plan.accuracy);
            let known = Known::of(&settled, self.parameters);
            let mut ended = settled.found.stop == Stop::Converged;
            if !plan.profiles || !ended {
                return Judged { settled, known, profiles: none, ended };
            }
            let t = student(known.degrees, plan.confidence);
            let found = profile::intervals(self, &settled, &known, t, &mut *watch);
            let mut profiles = found.intervals;
            if let Some(better) = found.better {
                if found.whole && restarts < MOST_RESTARTS {
                    restarts += 1;
                    let search = &mut |rounds, squares| watch(Progress::Search { rounds, squares });
                    if let Ok(next) = self.settle(&better, room, search) {
                        settled = Settled { rounds: settled.rounds + next.rounds, ..next };
                        continue;
                    }
                }
                // What is known not to be the optimum has no intervals, unless it is so by less than the model knows.
                settled.found.stop = Stop::Stalled;
                self.forgive(&mut settled, plan.accuracy);
                (ended, profiles) = (settled.found.stop == Stop::Converged, none);
            }
            if !found.whole {
                settled.found.stop = Stop::Interrupted;
            }
            return Judged { settled, known, profiles, ended };
        }
    }

    /// Where all is explained as well as the model knows, its own rounding stops the search: that is an end.
    fn forgive(&self, settled: &mut Settled, accuracy: f64) {
        let squares: f64 = self.measured.raw.iter().zip(&settled.found.place.out.values).map(|(m, v)| (m - v) * (m - v)).sum();
        let size = accuracy * self.measured.y.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
        if settled.found.stop == Stop::Stalled && squares <= self.measured.raw.len() as f64 * size * size {
            settled.found.stop = Stop::Converged;
        }
    }

    /// Fits, weighs, and fits again, until nothing changes.
    fn settle(&self, start: &[f64], room: &mut Workspace, watch: &mut dyn FnMut(usize, f64) -> bool) -> Result<Settled, Failure> {
        let points = self.measured.y.len();
        let mut settled = self.once(start, &vec![1.0; points], (0.0, 0), room, watch)?;
        // Tukey's loss has several minima: it begins where Huber's ends, and keeps its scatter.
        let stages: &[Loss] = match self.loss {
            Loss::Squares => &[Loss::Squares],
            Loss::Tukey => &[Loss::Huber, Loss::Tukey],
            Loss::Huber => &[Loss::Huber],
            Loss::SoftL1 => &[Loss::SoftL1],
        };
        let alone = self.parameters.iter().all(|p| p.prior.is_none());
        if self.loss == Loss::Squares && alone {
            self.judge(&mut settled, Loss::Squares, true);
            return Ok(settled);
        }
        for loss in stages {
            for _ in 0..MOST_WEIGHTINGS {
                self.judge(&mut settled, *loss, *loss != Loss::Tukey);
                let last = settled;
                settled = self.once(&last.found.place.x, &last.weights, (last.noise, last.rounds), room, watch)?;
                (settled.scale, settled.loss) = (last.scale, last.loss);
                let known = Known::of(&last, self.parameters);
                let moved = last.found.place.x.iter().zip(&settled.found.place.x).zip(&known.errors);
                if settled.found.stop == Stop::Interrupted
                    || moved.into_iter().all(|((a, b), e)| e.is_infinite() || (a - b).abs() <= AT_REST * e)
                {
                    break;
                }
            }
            self.judge(&mut settled, *loss, *loss != Loss::Tukey);
        }
        Ok(settled)
    }

    /// A search with weights; priors count by the scatter of the points.
    fn once(
        &self,
        start: &[f64],
        weights: &[f64],
        (noise, before): (f64, usize),
        room: &mut Workspace,
        watch: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Settled, Failure> {
        let roots: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
        let priors = self.priors(noise);
        let problem = Problem {
            model: self.model,
            measured: self.measured.y,
            roots: &roots,
            priors: &priors,
            limits: self.limits,
            sizes: self.sizes,
            rounds: MOST_ROUNDS,
        };
        let found = problem.search(start, room, &mut |rounds, squares| watch(before + rounds, squares))?;
        let rounds = before + found.rounds;
        Ok(Settled { found, weights: weights.to_vec(), noise, scale: noise, loss: Loss::Squares, rounds })
    }

    /// Priors as residuals of points with a scatter.
    fn priors(&self, noise: f64) -> Vec<Option<[f64; 2]>> {
        self.parameters.iter().map(|p| p.prior.map(|prior| [prior.mean, noise / prior.sd])).collect()
    }

    /// Scatter and weights by the residuals. Huber & Ronchetti, eq. (7.83): of least squares it is the root of the squares over the degrees.
    fn judge(&self, settled: &mut Settled, loss: Loss, rescale: bool) {
        let known = Known::of(settled, self.parameters);
        let residual =
            |measured: &[f64]| -> Vec<f64> { measured.iter().zip(&settled.found.place.out.values).map(|(m, v)| m - v).collect() };
        // A filter takes errors away: their size is that of the raw ones.
        let (raw, fitted) = (residual(self.measured.raw), residual(self.measured.y));
        let n = raw.len() as f64;
        settled.loss = loss;
        if loss == Loss::Squares {
            settled.noise = (raw.iter().map(|r| r * r).sum::<f64>() / known.degrees).sqrt();
            settled.scale = settled.noise;
            settled.weights = vec![1.0; raw.len()];
            return;
        }
        if rescale {
            settled.scale = mad(&fitted, self.parameters.len());
        }
        let s = settled.scale.max(f64::MIN_POSITIVE);
        settled.weights = fitted.iter().map(|r| loss.weight(r / s)).collect();
        let far = if self.measured.raw == self.measured.y { s } else { mad(&raw, self.parameters.len()).max(f64::MIN_POSITIVE) };
        let bends: Vec<f64> = raw.iter().map(|r| loss.bend(r / far)).collect();
        let mean = bends.iter().sum::<f64>() / n;
        let scatter = bends.iter().map(|b| (b - mean) * (b - mean)).sum::<f64>() / n;
        let parameters = n - known.degrees;
        let correction = 1.0 + parameters / n * scatter / (mean * mean);
        let pull: f64 = raw.iter().map(|r| loss.weight(r / far) * r).map(|psi| psi * psi).sum();
        settled.noise = correction * (pull / known.degrees).sqrt() / mean;
    }
}

/// What the tangents at an optimum say.
struct Known {
    /// Parameters that no bound holds.
    free: Vec<usize>,
    /// The bound that holds a parameter.
    at: Vec<Option<Bound>>,
    /// Covariance of the free parameters over the square of the noise, row by row; infinite where nothing is known.
    unit: Vec<f64>,
    /// The same of the directions alone that are determined.
    firm: Vec<f64>,
    /// The same with the weights of the points, for profiles.
    weighted: Vec<f64>,
    /// Standard errors of all.
    errors: Vec<f64>,
    noise: f64,
    degrees: f64,
}

impl Known {
    fn of(settled: &Settled, parameters: &[Parameter]) -> Self {
        let Place { x, out, .. } = &settled.found.place;
        let n = parameters.len();
        let at: Vec<Option<Bound>> = parameters
            .iter()
            .zip(x)
            .map(|(p, x)| {
                let bound = |b: f64| b.is_finite() && (x - b).abs() <= 4.0 * f64::EPSILON * b.abs().max(p.scale);
                if bound(p.limits.lower) { Some(Bound::Lower) } else { bound(p.limits.upper).then_some(Bound::Upper) }
            })
            .collect();
        let free: Vec<usize> = (0..n).filter(|i| at[*i].is_none()).collect();
        let scales: Vec<f64> = free.iter().map(|i| parameters[*i].scale).collect();
        let priors: Vec<Option<f64>> = free.iter().map(|i| parameters[*i].prior.map(|p| settled.noise / p.sd)).collect();
        let plain = scaled(&out.jacobian, (n, &free), &scales, None);
        let heavy = scaled(&out.jacobian, (n, &free), &scales, Some(&settled.weights));
        let ([firm, unit], determined) = covariance(&plain, &priors, &scales);
        // Each prior takes the part of its parameter that the points do not determine; what nothing determines takes no point.
        let held: f64 = priors.iter().enumerate().filter_map(|(k, p)| p.map(|root| root * root * unit[k * free.len() + k])).sum();
        let points = out.values.len() as f64;
        let degrees = (points - determined + held.min(determined)).max(1.0);
        let mut errors = vec![0.0; n];
        for (k, i) in free.iter().enumerate() {
            errors[*i] = settled.noise * unit[k * free.len() + k].sqrt();
        }
        let ([_, weighted], _) = covariance(&heavy, &priors, &scales);
        Self { unit, firm, weighted, errors, noise: settled.noise, degrees, at, free }
    }

    /// Correlations of all parameters.
    fn correlations(&self) -> Vec<f64> {
        let (n, m) = (self.at.len(), self.free.len());
        let mut all = vec![0.0; n * n];
        (0..n).for_each(|i| all[i * n + i] = 1.0);
        for (a, i) in self.free.iter().enumerate() {
            for (b, j) in self.free.iter().enumerate().filter(|(b, _)| *b != a) {
                let size = (self.unit[a * m + a] * self.unit[b * m + b]).sqrt();
                all[i * n + j] = if size.is_finite() && size > 0.0 { (self.unit[a * m + b] / size).clamp(-1.0, 1.0) } else { 0.0 };
            }
        }
        all
    }

    /// Standard error of the values at the points; of what is not determined nothing counts, since it does not move the curve.
    fn curve_error(&self, jacobian: &[f64]) -> Vec<f64> {
        let (n, m) = (self.at.len(), self.free.len());
        let one = |row: &[f64]| {
            let sum: f64 = (0..m * m).map(|k| row[self.free[k / m]] * self.firm[k] * row[self.free[k % m]]).sum();
            self.noise * sum.max(0.0).sqrt()
        };
        jacobian.chunks_exact(n.max(1)).map(one).collect()
    }
}

/// The triangle of a scaled Jacobian's free columns, with a weight per row if any.
fn scaled(jacobian: &[f64], (n, free): (usize, &[usize]), scales: &[f64], weights: Option<&[f64]>) -> Triangle {
    let rows: Vec<f64> = jacobian
        .chunks_exact(n.max(1))
        .enumerate()
        .flat_map(|(p, row)| {
            let root = weights.map_or(1.0, |w| w[p].sqrt());
            free.iter().zip(scales).map(move |(i, s)| row[*i] * s * root)
        })
        .collect();
    let points = jacobian.len() / n.max(1);
    Triangle::of(free.len(), &rows, &vec![0.0; points])
}

/// Inverse of `JᵀJ` with priors, of scaled columns, unscaled: in the directions that are determined, and with those that are not, infinite;
/// and how many are determined.
fn covariance(triangle: &Triangle, priors: &[Option<f64>], scales: &[f64]) -> ([Vec<f64>; 2], f64) {
    let m = triangle.n;
    let mut rows = triangle.r.clone();
    let mut zeros = vec![0.0; m];
    for (k, prior) in priors.iter().enumerate() {
        if let Some(root) = prior {
            rows.extend((0..m).map(|j| if j == k { root * scales[k] } else { 0.0 }));
            zeros.push(0.0);
        }
    }
    let singular = Singular::of(m, &Triangle::of(m, &rows, &zeros).r);
    let most = singular.values.first().copied().unwrap_or(0.0);
    let (mut firm, mut open, mut determined) = (vec![0.0; m * m], vec![0.0; m * m], 0.0);
    for (value, vector) in singular.values.iter().zip(&singular.vectors) {
        determined += f64::from(u8::from(*value > RANK * most));
        for k in 0..m * m {
            let share = vector[k / m] * vector[k % m];
            if *value > RANK * most {
                firm[k] += scales[k / m] * scales[k % m] * share / (value * value);
            } else if vector[k / m].abs() > INVOLVED && vector[k % m].abs() > INVOLVED {
                open[k] = f64::INFINITY.copysign(share);
            }
        }
    }
    let all = firm.iter().zip(&open).map(|(f, o)| f + o).collect();
    ([firm, all], determined)
}
