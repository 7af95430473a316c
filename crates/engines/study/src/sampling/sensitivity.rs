//! Which parameters an output owes its variance to.

use std::fmt;

use super::interval::{Confidence, Estimate};
use super::sobol::{Replicates, SobolError};

/// Why there is no plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensitivityError {
    /// Every point needs two coordinates per parameter; there are not so many.
    Sobol(SobolError),
    /// The factors are not a partition of the parameters: this one is in none or in several.
    NotOnce {
        /// Index of the parameter.
        parameter: usize,
    },
}

impl fmt::Display for SensitivityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sobol(error) => write!(f, "two coordinates per parameter are needed: {error}"),
            Self::NotOnce { parameter } => write!(f, "parameter {parameter} must be in exactly one factor"),
        }
    }
}

impl std::error::Error for SensitivityError {}

/// The points at which a model must be evaluated for its Sobol indices.
///
/// From a point of the unit cube in twice the dimensions come two independent points A and B, and for each factor the point A with the
/// coordinates of that factor from B: `factors + 2` evaluations per base point (A. Saltelli et al., "Variance based sensitivity
/// analysis of model output", Computer Physics Communications 181, 259–270, 2010). In this order, base point after base
/// point, replicate after replicate in turn, they are the rows of the plan.
///
/// A factor is a set of parameters. The indices are shares of the variance only for factors that are independent of each other, so
/// correlated parameters must be one factor together ([`super::Population::factors`]); the index is then that of the group. To divide
/// it among the members is refused: with correlated inputs the indices of the single ones depend on which is asked first, and their
/// sum is no longer the variance.
#[derive(Debug, Clone)]
pub struct SensitivityPlan {
    factors: Vec<Vec<usize>>,
    parameters: usize,
    base: Replicates,
}

impl SensitivityPlan {
    /// A plan for factors that together hold each of the parameters `0..parameters` once.
    ///
    /// # Errors
    /// More than 128 parameters, or no partition.
    pub fn new(parameters: usize, factors: Vec<Vec<usize>>, replicates: usize, seed: u64) -> Result<Self, SensitivityError> {
        let base = Replicates::new(parameters.saturating_mul(2), replicates, seed).map_err(SensitivityError::Sobol)?;
        let named = || factors.iter().flatten();
        let once = |parameter: usize| named().filter(|p| **p == parameter).count() == 1;
        let unknown = named().copied().find(|p| *p >= parameters);
        if let Some(parameter) = unknown.or_else(|| (0..parameters).find(|p| !once(*p))) {
            return Err(SensitivityError::NotOnce { parameter });
        }
        Ok(Self { factors, parameters, base })
    }

    /// The factors.
    pub fn factors(&self) -> &[Vec<usize>] {
        &self.factors
    }

    /// Evaluations per base point.
    pub fn rows_per_base(&self) -> usize {
        self.factors.len() + 2
    }

    /// Evaluations for so many base points in each replicate. Take a power of two.
    pub fn rows(&self, points_per_replicate: u64) -> u64 {
        points_per_replicate.saturating_mul((self.base.count() * self.rows_per_base()) as u64)
    }

    /// Writes the rows `first`, `first + 1`, … as points of the open unit cube, as many as fit.
    pub fn fill(&self, first: u64, out: &mut [f64]) {
        let (n, per_base) = (self.parameters, self.rows_per_base() as u64);
        if n == 0 {
            return;
        }
        let mut pair = vec![0.0; 2 * n];
        let mut of = None;
        for (i, out) in out.chunks_exact_mut(n).enumerate() {
            let row = first.wrapping_add(i as u64);
            if of != Some(row / per_base) {
                of = Some(row / per_base);
                self.base.sample(row / per_base, &mut pair);
            }
            let (a, b) = pair.split_at(n);
            match row % per_base {
                0 => out.copy_from_slice(a),
                1 => out.copy_from_slice(b),
                slot => {
                    out.copy_from_slice(a);
                    #[allow(clippy::cast_possible_truncation, reason = "less than the number of factors and two")]
                    for &parameter in &self.factors[slot as usize - 2] {
                        out[parameter] = b[parameter];
                    }
                }
            }
        }
    }
}

/// Sobol indices of one output: shares of its variance, per factor, in the order of the plan.
#[derive(Debug, Clone, PartialEq)]
pub struct SobolIndices {
    /// Mean of the output, in its unit.
    pub mean: Estimate,
    /// Variance of the output, in the square of its unit.
    pub variance: Estimate,
    /// What would go away on average if this factor were known exactly: `S = Var(E(y|x)) / Var(y)`.
    pub first: Vec<Estimate>,
    /// What would be left on average if all others were known exactly: `S_T = E(Var(y|others)) / Var(y)`; more than the first-order
    /// index if the factor interacts with others.
    pub total: Vec<Estimate>,
    /// Base points left out because an evaluation had no finite value; the indices are then those of the rest.
    pub skipped: u64,
}

/// Sums of one output over the base points of one replicate, all relative to one value of the output.
#[derive(Debug, Clone, Default)]
struct Sums {
    count: f64,
    a: f64,
    b: f64,
    a_squared: f64,
    b_squared: f64,
    /// Per factor: Σ y, Σ y², Σ y b and Σ (y − a)², with y at the mixed point.
    mixed: Vec<[f64; 4]>,
}

/// Turns outputs at the rows of a [`SensitivityPlan`] into Sobol indices.
///
/// First-order indices by A. Janon, T. Klein, A. Lagnoux, M. Nodet, C. Prieur, "Asymptotic normality and efficiency of two Sobol index
/// estimators", ESAIM: Probability and Statistics 18, 342–364, 2014, the efficient one, `T_N`; total indices by M. J. W. Jansen,
/// "Analysis of variance designs for model output", Computer Physics Communications 117, 35–43, 1999. Each replicate gives a value;
/// their mean is the estimate and Student's interval its error. (With very few points a ratio is biased, of the order of one over the
/// points, which the interval does not show.)
///
/// ```
/// use forcewright_study::sampling::{Confidence, SensitivityPlan, SensitivityTally};
///
/// // y = x₀ + 2 x₁ with uniform x: shares 1/5 and 4/5.
/// let plan = SensitivityPlan::new(2, vec![vec![0], vec![1]], 8, 1)?;
/// let mut tally = SensitivityTally::new(&plan, 1);
/// let mut points = vec![0.0; 2 * plan.rows(64) as usize];
/// plan.fill(0, &mut points);
/// let outputs: Vec<f64> = points.chunks_exact(2).map(|x| x[0] + 2.0 * x[1]).collect();
/// outputs.chunks_exact(plan.rows_per_base()).for_each(|y| tally.record(y));
/// let indices = tally.indices(0, Confidence::P95).ok_or("no variance")?;
/// assert!((indices.first[1].value - 0.8).abs() < 1e-3 && (indices.total[0].value - 0.2).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct SensitivityTally {
    outputs: usize,
    factors: usize,
    replicates: usize,
    /// To which the next base point belongs.
    next_replicate: usize,
    /// Replicate by replicate, output by output.
    sums: Vec<Sums>,
    /// Per output: the value that all sums are relative to, so that a small variance of large numbers keeps its digits.
    origin: Vec<Option<f64>>,
    skipped: Vec<u64>,
}

impl SensitivityTally {
    /// Nothing recorded yet.
    pub fn new(plan: &SensitivityPlan, outputs: usize) -> Self {
        let factors = plan.factors.len();
        let empty = Sums { mixed: vec![[0.0; 4]; factors], ..Sums::default() };
        let sums = vec![empty; plan.base.count() * outputs];
        let (replicates, origin, skipped) = (plan.base.count(), vec![None; outputs], vec![0; outputs]);
        Self { outputs, factors, replicates, next_replicate: 0, sums, origin, skipped }
    }

    /// Adds all evaluations of the next base point: [`SensitivityPlan::rows_per_base`] rows of the outputs. Base points must come in
    /// the order of the plan. Values that are missing count as not finite.
    pub fn record(&mut self, rows: &[f64]) {
        let replicate = self.next_replicate;
        self.next_replicate = (replicate + 1) % self.replicates;
        for output in 0..self.outputs {
            let value = |row: usize| rows.get(row * self.outputs + output).copied().unwrap_or(f64::NAN);
            if !(0..self.factors + 2).all(|row| value(row).is_finite()) {
                self.skipped[output] += 1;
                continue;
            }
            let origin = *self.origin[output].get_or_insert(value(0));
            let sums = &mut self.sums[replicate * self.outputs + output];
            let (a, b) = (value(0) - origin, value(1) - origin);
            sums.count += 1.0;
            sums.a += a;
            sums.b += b;
            sums.a_squared += a * a;
            sums.b_squared += b * b;
            for (factor, mixed) in sums.mixed.iter_mut().enumerate() {
                let y = value(factor + 2) - origin;
                let terms = [y, y * y, y * b, (y - a) * (y - a)];
                mixed.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
            }
        }
    }

    /// The indices of an output; `None` if it does not vary, or nothing was recorded for it in some replicate.
    pub fn indices(&self, output: usize, confidence: Confidence) -> Option<SobolIndices> {
        let origin = (*self.origin.get(output)?)?;
        let sums = || self.sums.iter().skip(output).step_by(self.outputs);
        let variance = |s: &Sums| {
            let mean = 0.5 * (s.a + s.b) / s.count;
            0.5 * (s.a_squared + s.b_squared) / s.count - mean * mean
        };
        // Written so that NaN, of a replicate without points, fails as well.
        if !sums().all(|s| variance(s) > 0.0) {
            return None;
        }
        let over_replicates = |f: &dyn Fn(&Sums) -> f64| Estimate::of_mean(&sums().map(f).collect::<Vec<f64>>(), confidence);
        let per_factor = |f: fn(&Sums, usize) -> f64| (0..self.factors).map(|i| over_replicates(&|s| f(s, i))).collect();
        Some(SobolIndices {
            mean: over_replicates(&|s| origin + 0.5 * (s.a + s.b) / s.count),
            variance: over_replicates(&variance),
            first: per_factor(first_order),
            total: (0..self.factors).map(|i| over_replicates(&|s| 0.5 * s.mixed[i][3] / s.count / variance(s))).collect(),
            skipped: self.skipped[output],
        })
    }
}

/// `T_N` of Janon et al. 2014: the correlation of the outputs at B and at the mixed point, with their pooled mean and variance. The two
/// points have nothing but the factor in common.
fn first_order(sums: &Sums, factor: usize) -> f64 {
    let [y, y_squared, y_b, _] = sums.mixed[factor];
    let n = sums.count;
    let mean = 0.5 * (sums.b + y) / n;
    let spread = 0.5 * (sums.b_squared + y_squared) / n - mean * mean;
    // With a handful of points, all of B and of the mixed ones may agree although A varies.
    if spread > 0.0 { (y_b / n - mean * mean) / spread } else { 0.0 }
}

#[cfg(test)]
mod tests;
