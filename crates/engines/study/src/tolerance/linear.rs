//! What the Jacobian at the nominal design says of the scatter.

use rayon::prelude::*;

use super::run::{drawn, in_order, points};
use super::{Kept, Plan, Study, Verdicts, rounded};
use crate::differences::jacobian_with_steps;
use crate::evaluator::{Evaluation, Evaluator, Workspace};
use crate::sampling::{Distribution, Yield};

/// Largest factor of a tolerance that is looked at.
pub const MOST_SCALE: f64 = 4.0;
/// Designs behind each needed tolerance: their yield is right to about half a point of per cent.
const SCALED_SAMPLES: u64 = 1024;
/// Halvings of the range of a factor.
const HALVINGS: usize = 12;

/// The tolerance that a variable would need for the target yield, all others as they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Needed {
    /// Index of the variable.
    pub variable: usize,
    /// Factor of its half width: below 1 it must be tightened, above there is room, [`MOST_SCALE`] stands for that and more. `None` if
    /// not even zero is enough.
    pub scale: Option<f64>,
}

/// The linearised estimate: the station vectors are linear in the variables, the measures are those of the linear vectors.
#[derive(Clone, Debug)]
pub struct Linear {
    /// Derivatives of the values: a row per value, a column per variable, SI.
    pub jacobian: Vec<f64>,
    /// Part of the designs that keep to everything.
    pub all: Yield,
    /// The same for each measure with a limit.
    pub kept: Vec<Kept>,
    /// Needed tolerances, per variable that scatters.
    pub needed: Vec<Needed>,
}

/// The estimate; `None` if a neighbour of the nominal design has no values.
pub(super) fn estimate(
    evaluator: &dyn Evaluator,
    plan: &Plan,
    study: &Study,
    limited: &[usize],
    workspace: &mut Workspace,
) -> Option<Linear> {
    let nominal: Vec<f64> = study.variables.iter().map(|v| v.nominal).collect();
    // Steps as large as the deviations: the secant through what really occurs, far above the noise of the values.
    let steps: Vec<f64> = plan.population.marginals().iter().map(Distribution::sd).collect();
    let mut at = Evaluation { values: study.nominal.clone(), jacobian: Vec::new() };
    jacobian_with_steps(evaluator, &nominal, &steps, &mut at, workspace).ok()?;
    let model = Model { evaluator, plan, nominal, values: &study.nominal, jacobian: &at.jacobian };

    let sample = points(plan, rounded(plan.linear_samples)).ok()?;
    let mut verdicts = Verdicts::new(&study.measures, limited);
    let chunk = |first: u64| {
        let designs = drawn(&plan.population, &sample, first);
        let mut values = Vec::new();
        designs.chunks_exact(model.nominal.len().max(1)).map(|x| model.measured(x, &mut values)).collect::<Vec<_>>()
    };
    in_order(sample.count, &mut |_| true, &chunk, &mut |chunk: Vec<Vec<f64>>| chunk.iter().for_each(|m| verdicts.add(Some(m))));

    let needed = if limited.is_empty() { Vec::new() } else { model.needed()? };
    let (all, kept) = (verdicts.all.estimate(plan.confidence), verdicts.kept(plan.confidence));
    Some(Linear { all, kept, needed, jacobian: at.jacobian })
}

struct Model<'a> {
    evaluator: &'a dyn Evaluator,
    plan: &'a Plan,
    nominal: Vec<f64>,
    values: &'a [f64],
    jacobian: &'a [f64],
}

impl Model<'_> {
    /// The linear values of a design.
    fn extrapolate(&self, x: &[f64], out: &mut Vec<f64>) {
        let n = self.nominal.len().max(1);
        let row = |row: &[f64]| row.iter().zip(x).zip(&self.nominal).map(|((j, x), at)| j * (x - at)).sum::<f64>();
        out.clear();
        out.extend(self.values.iter().zip(self.jacobian.chunks_exact(n)).map(|(value, jacobian)| value + row(jacobian)));
    }

    fn measured(&self, x: &[f64], values: &mut Vec<f64>) -> Vec<f64> {
        let mut measured = Vec::new();
        self.extrapolate(x, values);
        self.evaluator.measure(x, values, &mut measured);
        measured.into_iter().map(|m| m.unwrap_or(f64::NAN)).collect()
    }

    /// The factor that each variable's half width would need.
    fn needed(&self) -> Option<Vec<Needed>> {
        let sample = points(self.plan, SCALED_SAMPLES).ok()?;
        let mut designs = Vec::new();
        in_order(sample.count, &mut |_| true, &|first| drawn(&self.plan.population, &sample, first), &mut |chunk| designs.extend(chunk));
        let marginals = self.plan.population.marginals();
        let scattering: Vec<usize> = (0..marginals.len()).filter(|i| marginals[*i].half_width() > 0.0).collect();
        let scale = |variable: &usize| Needed { variable: *variable, scale: self.largest_scale(*variable, &designs) };
        Some(scattering.par_iter().map(scale).collect())
    }

    /// The largest factor up to [`MOST_SCALE`] with the target yield: that of bisection, as if the yield fell with the factor.
    fn largest_scale(&self, variable: usize, designs: &[f64]) -> Option<f64> {
        let good = |scale: f64| self.yield_at(variable, scale, designs) >= self.plan.target;
        if good(MOST_SCALE) {
            return Some(MOST_SCALE);
        }
        // Around 1 first, so that the answer agrees with the yield as it is.
        let (mut low, mut high) = if good(1.0) {
            (1.0, MOST_SCALE)
        } else if good(0.0) {
            (0.0, 1.0)
        } else {
            return None;
        };
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            if good(middle) { low = middle } else { high = middle }
        }
        Some(low)
    }

    /// The linear yield with the deviations of one variable from its mean scaled.
    fn yield_at(&self, variable: usize, scale: f64, designs: &[f64]) -> f64 {
        let n = self.nominal.len().max(1);
        let mean = self.plan.population.marginals()[variable].mean();
        let (mut x, mut values, mut good) = (Vec::new(), Vec::new(), 0_usize);
        let measures = self.evaluator.measures();
        for design in designs.chunks_exact(n) {
            x.clear();
            x.extend_from_slice(design);
            x[variable] = mean + scale * (design[variable] - mean);
            let found = self.measured(&x, &mut values);
            good += usize::from(measures.iter().zip(found).all(|(measure, value)| measure.met(value)));
        }
        good as f64 / (designs.len() / n).max(1) as f64
    }
}
