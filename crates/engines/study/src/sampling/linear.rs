//! What a linear model says of scatter: variances, contributions, yield, and the tolerance that would be enough.

use std::fmt;

use forcewright_base::roots;

use super::interval::{Confidence, Interval};
use super::{Correlation, CorrelationError, Population, Replicates, SIGMAS_IN_TOLERANCE, SobolError, Yield, YieldTally, normal};

/// Why there is no linear model, or no answer from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LinearError {
    /// A vector or matrix has not as many entries as the others require.
    Shape {
        /// Entries required.
        wanted: usize,
        /// Entries given.
        given: usize,
    },
    /// A value is infinite or not a number, or a variance negative.
    NotFinite,
    /// The covariances contradict each other.
    Covariance(CorrelationError),
    /// There is no such output or parameter.
    NoSuchIndex {
        /// The index.
        index: usize,
    },
    /// A yield to be reached must be above ½ and below 1.
    Target {
        /// The yield asked for.
        target: f64,
    },
    /// Too many parameters for a sample.
    Sobol(SobolError),
}

impl fmt::Display for LinearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape { wanted, given } => write!(f, "{wanted} entries are needed, but {given} are given"),
            Self::NotFinite => write!(f, "a value is infinite or not a number, or a variance is negative"),
            Self::Covariance(error) => write!(f, "the covariances are impossible: {error}"),
            Self::NoSuchIndex { index } => write!(f, "there is no output or parameter {index}"),
            Self::Target { target } => write!(f, "a yield of {target} cannot be asked for; it must lie between 0.5 and 1"),
            Self::Sobol(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for LinearError {}

/// What one parameter does to one output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contribution {
    /// Index of the parameter.
    pub parameter: usize,
    /// Change of the output, with its sign and in its unit, when this parameter alone goes up by half the width of its tolerance
    /// ([`Distribution::half_width`](super::Distribution::half_width)). Down, it is the opposite: the two ends of a bar of a tornado
    /// chart.
    pub half_range: f64,
    /// Share of the variance of the output, `J_i (C Jᵀ)_i / (J C Jᵀ)`. Shares add up to 1; that of a correlated parameter includes its
    /// half of what it has in common with others, and may be negative. All are 0 if the output does not vary.
    pub share: f64,
}

/// Outputs as linear functions of parameters that scatter: `y = mean + J (x − mean x)`.
///
/// Means, variances and contributions hold for every distribution of the parameters; yields take the outputs for normally distributed,
/// exact for normal parameters, and good for sums of many small effects.
///
/// ```
/// use forcewright_study::sampling::{Interval, LinearModel};
///
/// // y = 10 + 3 a − b with standard deviations 0.1 and 0.4: √(0.09 + 0.16) = 0.5.
/// let model = LinearModel::new(vec![10.0], vec![3.0, -1.0], &[0.01, 0.0, 0.0, 0.16])?;
/// assert!((model.sd(0) - 0.5).abs() < 1e-15);
/// let limits = Interval { low: 9.0, high: 11.0 };
/// assert!((model.yield_of(0, limits)? - 0.954_499_7).abs() < 1e-7);
/// // For 99 % within ±1, σ may be 0.38822 only. That leaves nothing for a: b alone is beyond it.
/// assert_eq!(model.scale_for_yield(0, 0, limits, 0.99)?, None);
/// assert!((model.scale_for_yield(1, 0, limits, 0.99)?.ok_or("none")? - 0.616).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct LinearModel {
    mean: Vec<f64>,
    /// Outputs by parameters, each times the standard deviation of the parameter: the change per score.
    per_score: Vec<f64>,
    /// Half the width of the tolerance of each parameter, in its standard deviations.
    half_widths: Vec<f64>,
    parameters: usize,
    correlation: Correlation,
}

impl LinearModel {
    /// From the means of the outputs (their values where the parameters have their means), the Jacobian (outputs by parameters,
    /// row-major) and the covariances of the parameters (row-major). Tolerances are taken to be three standard deviations.
    ///
    /// # Errors
    /// [`LinearError`]: shapes that do not fit, numbers that are not finite, covariances that contradict each other.
    pub fn new(mean: Vec<f64>, jacobian: Vec<f64>, covariance: &[f64]) -> Result<Self, LinearError> {
        let parameters = covariance.len().isqrt();
        let shape = |wanted: usize, given: usize| if wanted == given { Ok(()) } else { Err(LinearError::Shape { wanted, given }) };
        shape(parameters * parameters, covariance.len())?;
        shape(mean.len() * parameters, jacobian.len())?;
        let sd: Vec<f64> = (0..parameters).map(|i| covariance[i * parameters + i].sqrt()).collect();
        if !mean.iter().chain(&jacobian).chain(covariance).chain(&sd).all(|v| v.is_finite()) {
            return Err(LinearError::NotFinite);
        }
        let entry = |index: usize| {
            let (i, j) = (index / parameters, index % parameters);
            let scale = sd[i] * sd[j];
            if i == j {
                1.0
            } else if scale > 0.0 {
                let rho = covariance[index] / scale;
                // A perfect correlation may be off by a rounding.
                if (rho.abs() - 1.0).abs() < 1e-14 { 1.0_f64.copysign(rho) } else { rho }
            } else if covariance[index] == 0.0 {
                0.0
            } else {
                f64::INFINITY
            }
        };
        let matrix: Vec<f64> = (0..covariance.len()).map(entry).collect();
        let correlation = Correlation::new(parameters, &matrix).map_err(LinearError::Covariance)?;
        let mut per_score = jacobian;
        if parameters > 0 {
            per_score.chunks_exact_mut(parameters).for_each(|row| row.iter_mut().zip(&sd).for_each(|(j, sd)| *j *= sd));
        }
        Ok(Self { mean, per_score, half_widths: vec![SIGMAS_IN_TOLERANCE; parameters], parameters, correlation })
    }

    /// From the values and the Jacobian at a point (the nominal parameters) and how the parameters scatter. Where the zone of a tolerance
    /// is not centred on the nominal value, the mean of the outputs is `value + J (mean x − point)`.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn about(point: &[f64], values: &[f64], jacobian: Vec<f64>, population: &Population) -> Result<Self, LinearError> {
        let n = population.len();
        if point.len() != n || jacobian.len() != n * values.len() {
            let (wanted, given) = if point.len() == n { (n * values.len(), jacobian.len()) } else { (n, point.len()) };
            return Err(LinearError::Shape { wanted, given });
        }
        let offset: Vec<f64> = population.marginals().iter().zip(point).map(|(d, p)| d.mean() - p).collect();
        let shift = |output: usize| dot(&jacobian[output * n..(output + 1) * n], &offset);
        let mean = values.iter().enumerate().map(|(output, value)| value + shift(output)).collect();
        let mut model = Self::new(mean, jacobian, &population.covariance())?;
        for (half_width, marginal) in model.half_widths.iter_mut().zip(population.marginals()) {
            if marginal.sd() > 0.0 {
                *half_width = marginal.half_width() / marginal.sd();
            }
        }
        Ok(model)
    }

    /// Mean of each output.
    pub fn means(&self) -> &[f64] {
        &self.mean
    }

    /// Standard deviation of an output, 0 if there is no such output.
    pub fn sd(&self, output: usize) -> f64 {
        let row = self.row(output);
        dot(row, &self.along(row)).max(0.0).sqrt()
    }

    /// What each parameter does to an output, largest range first.
    pub fn contributions(&self, output: usize) -> Vec<Contribution> {
        let row = self.row(output);
        let along = self.along(row);
        let variance = dot(row, &along);
        let share = |i: usize| if variance > 0.0 { row[i] * along[i] / variance } else { 0.0 };
        let one = |i: usize| Contribution { parameter: i, half_range: self.half_widths[i] * row[i], share: share(i) };
        let mut all: Vec<Contribution> = (0..row.len()).map(one).collect();
        all.sort_by(|a, b| b.half_range.abs().total_cmp(&a.half_range.abs()));
        all
    }

    /// Part of all specimens whose output lies within limits (which may be infinite): `Φ((high − m)/σ) − Φ((low − m)/σ)`.
    ///
    /// # Errors
    /// No such output.
    pub fn yield_of(&self, output: usize, limits: Interval) -> Result<f64, LinearError> {
        let mean = *self.mean.get(output).ok_or(LinearError::NoSuchIndex { index: output })?;
        Ok(normal_within(mean, self.sd(output), limits))
    }

    /// Part of all specimens whose outputs all lie within their limits, from samples of the linear model: 16 replicates of
    /// `points_per_replicate`, of which a power of two is best.
    ///
    /// # Errors
    /// Not one pair of limits per output, or too many parameters.
    pub fn joint_yield(&self, limits: &[Interval], plan: JointPlan) -> Result<Yield, LinearError> {
        let mut tally = YieldTally::new(JointPlan::REPLICATES);
        self.sample(limits.len(), plan, |replicate, scores| {
            let inside = |(output, limits): (usize, &Interval)| limits.contains(self.mean[output] + dot(self.row(output), scores));
            tally.record(replicate, limits.iter().enumerate().all(inside));
        })?;
        Ok(tally.estimate(plan.confidence))
    }

    /// The largest factor by which the tolerance of one parameter can be multiplied, all others held, so that an output still reaches
    /// the yield; below 1 the tolerance must be tightened. Correlations stay as they are. `None` if no tolerance of this parameter is
    /// enough, not even zero; infinite if it does not matter.
    ///
    /// The yield of one output falls as its standard deviation grows: the largest standard deviation is the root of a monotone function,
    /// and the factor that of a quadratic one.
    ///
    /// # Errors
    /// No such output or parameter, or a target not between ½ and 1.
    pub fn scale_for_yield(&self, parameter: usize, output: usize, limits: Interval, target: f64) -> Result<Option<f64>, LinearError> {
        let mean = *self.mean.get(output).ok_or(LinearError::NoSuchIndex { index: output })?;
        self.check(parameter, target)?;
        let Some(sd) = largest_sd(mean, limits, target) else { return Ok(None) };
        let row = self.row(output);
        let along = self.along(row);
        let own = row[parameter] * row[parameter];
        let shared = row[parameter] * along[parameter] - own;
        let rest = (dot(row, &along) - own - 2.0 * shared).max(0.0);
        Ok(largest_root(own, shared, rest - sd * sd))
    }

    /// The same for all outputs together, [`Self::joint_yield`] instead of the yield of one: the largest factor at which, of the same
    /// samples, as many as asked for are good. Every sample is good in an interval of factors, so this is exact for the sample; against
    /// the truth it is as uncertain as the yield.
    ///
    /// # Errors
    /// Not one pair of limits per output, no such parameter, a target not between ½ and 1, or too many parameters.
    pub fn scale_for_joint_yield(
        &self,
        parameter: usize,
        limits: &[Interval],
        target: f64,
        plan: JointPlan,
    ) -> Result<Option<f64>, LinearError> {
        self.check(parameter, target)?;
        let mut good = Vec::new();
        let mut samples = 0.0;
        self.sample(limits.len(), plan, |_, scores| {
            let mut factors = Interval { low: 0.0, high: f64::INFINITY };
            for (output, limits) in limits.iter().enumerate() {
                let own = self.row(output)[parameter] * scores[parameter];
                let others = self.mean[output] + dot(self.row(output), scores) - own;
                factors = intersection(factors, solution(others, own, *limits));
            }
            samples += 1.0;
            if factors.low <= factors.high {
                good.push(factors);
            }
        })?;
        Ok(last_covered(&good, target * samples))
    }

    fn check(&self, parameter: usize, target: f64) -> Result<(), LinearError> {
        if parameter >= self.parameters {
            return Err(LinearError::NoSuchIndex { index: parameter });
        }
        if 0.5 < target && target < 1.0 { Ok(()) } else { Err(LinearError::Target { target }) }
    }

    /// Change of an output per score of each parameter.
    fn row(&self, output: usize) -> &[f64] {
        let begin = output.min(self.mean.len()) * self.parameters;
        self.per_score.get(begin..begin + self.parameters).unwrap_or_default()
    }

    /// For each parameter `Σ_j ρ_ij row_j`: the change that goes along with one score of it.
    fn along(&self, row: &[f64]) -> Vec<f64> {
        let mut alone = vec![0.0; self.parameters];
        for (i, change) in row.iter().enumerate() {
            alone.iter_mut().zip(self.correlation.row(i)).for_each(|(sum, l)| *sum += change * l);
        }
        (0..row.len()).map(|i| dot(self.correlation.row(i), &alone)).collect()
    }

    /// Hands replicate and correlated scores of every sample to `each`.
    fn sample(&self, limits: usize, plan: JointPlan, mut each: impl FnMut(usize, &[f64])) -> Result<(), LinearError> {
        if limits != self.mean.len() {
            return Err(LinearError::Shape { wanted: self.mean.len(), given: limits });
        }
        let replicates = Replicates::new(self.parameters, JointPlan::REPLICATES, plan.seed).map_err(LinearError::Sobol)?;
        let (mut alone, mut scores) = (vec![0.0; self.parameters], vec![0.0; self.parameters]);
        for sample in 0..plan.points_per_replicate.saturating_mul(JointPlan::REPLICATES as u64) {
            replicates.sample(sample, &mut alone);
            for coordinate in &mut alone {
                *coordinate = normal::quantile(*coordinate);
            }
            for (i, score) in scores.iter_mut().enumerate() {
                *score = dot(&self.correlation.row(i)[..=i], &alone);
            }
            each(replicates.replicate_of(sample), &scores);
        }
        Ok(())
    }
}

/// How a linear model of several outputs is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointPlan {
    /// Points in each of the 16 replicates; a power of two is best.
    pub points_per_replicate: u64,
    /// Decides the points.
    pub seed: u64,
    /// Of the interval of the yield.
    pub confidence: Confidence,
}

impl JointPlan {
    const REPLICATES: usize = 16;
}

impl Default for JointPlan {
    /// 16 384 samples.
    fn default() -> Self {
        Self { points_per_replicate: 1024, seed: 1, confidence: Confidence::P95 }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn normal_within(mean: f64, sd: f64, limits: Interval) -> f64 {
    if sd > 0.0 { normal::between((limits.low - mean) / sd, (limits.high - mean) / sd) } else { f64::from(limits.contains(mean)) }
}

/// The standard deviation at which the yield is just the target (above ½); `None` if the mean is not inside.
fn largest_sd(mean: f64, limits: Interval, target: f64) -> Option<f64> {
    let room = (mean - limits.low).min(limits.high - mean);
    if room.is_nan() || room <= 0.0 {
        return None;
    }
    if limits.low.is_infinite() || limits.high.is_infinite() {
        return Some(room / normal::quantile(target));
    }
    // The density is nowhere above 1/(σ√2π), so that beyond this the yield is below the target.
    let most = (limits.high - limits.low) * normal::density(0.0) / target;
    roots::root(|sd| normal_within(mean, sd, limits) - target, 0.0, most, 0.0).ok()
}

/// The largest `s ≥ 0` with `own s² + 2 shared s + rest ≤ 0`.
fn largest_root(own: f64, shared: f64, rest: f64) -> Option<f64> {
    if own == 0.0 {
        return (rest <= 0.0).then_some(f64::INFINITY);
    }
    let discriminant = shared * shared - own * rest;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    // Without cancellation for either sign.
    let largest = if shared > 0.0 { -rest / (shared + root) } else { (root - shared) / own };
    (largest >= 0.0).then_some(largest)
}

fn intersection(a: Interval, b: Interval) -> Interval {
    Interval { low: a.low.max(b.low), high: a.high.min(b.high) }
}

/// The factors `s` with `others + s own` within limits.
fn solution(others: f64, own: f64, limits: Interval) -> Interval {
    if own == 0.0 {
        let all = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };
        return if limits.contains(others) { all } else { Interval { low: 1.0, high: -1.0 } };
    }
    let (a, b) = ((limits.low - others) / own, (limits.high - others) / own);
    Interval { low: a.min(b), high: a.max(b) }
}

/// The largest number that lies in at least `wanted` of the intervals.
fn last_covered(intervals: &[Interval], wanted: f64) -> Option<f64> {
    let sorted = |end: fn(&Interval) -> f64| {
        let mut ends: Vec<f64> = intervals.iter().map(end).collect();
        ends.sort_by(|a, b| b.total_cmp(a));
        ends
    };
    let (highs, lows) = (sorted(|i| i.high), sorted(|i| i.low));
    let mut begin_later = 0;
    for (reach, high) in highs.iter().enumerate() {
        while lows.get(begin_later).is_some_and(|low| low > high) {
            begin_later += 1;
        }
        // Equal ends are counted at the last of them, which is the same number.
        if (reach + 1 - begin_later) as f64 >= wanted {
            return Some(*high);
        }
    }
    None
}

#[cfg(test)]
mod tests;
