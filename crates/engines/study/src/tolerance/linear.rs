//! What the Jacobian at the nominal design says of the scatter.

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::run::{Rooms, drawn, in_order, points};
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
    let model = Model { rooms: Rooms::new(evaluator), evaluator, plan, nominal, values: &study.nominal, jacobian: &at.jacobian };

    let sample = points(plan, rounded(plan.linear_samples)).ok()?;
    let mut verdicts = Verdicts::new(&study.measures, limited);
    let count = evaluator.measures().len();
    let chunk = |first: u64| {
        let designs = drawn(&plan.population, &sample, first);
        let each = designs.len() / model.nominal.len().max(1);
        let mut all = Vec::with_capacity(each * count);
        model.each(&designs, |measures| {
            all.extend_from_slice(measures);
            ControlFlow::Continue(())
        });
        (each, all)
    };
    let mut add = |(each, all): (usize, Vec<f64>)| (0..each).for_each(|i| verdicts.add(all.get(i * count..(i + 1) * count)));
    in_order(sample.count, &mut |_| true, &chunk, &mut add);

    let needed = if limited.is_empty() { Vec::new() } else { model.needed()? };
    let (all, kept) = (verdicts.all.estimate(plan.confidence), verdicts.kept(plan.confidence));
    Some(Linear { all, kept, needed, jacobian: at.jacobian })
}

struct Model<'a> {
    rooms: Rooms<'a>,
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

    /// Hands the measures of designs, which are there one after the other, to `sink`, until that has seen enough.
    fn each(&self, designs: &[f64], mut sink: impl FnMut(&[f64]) -> ControlFlow<()>) {
        let (mut values, mut measured) = (Vec::new(), Vec::new());
        self.rooms.with(|room| {
            for x in designs.chunks_exact(self.nominal.len().max(1)) {
                self.extrapolate(x, &mut values);
                self.evaluator.measure(x, &values, &mut measured, room);
                if sink(&measured).is_break() {
                    break;
                }
            }
        });
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
        let good = |scale: f64| self.keeps_target(variable, scale, designs);
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

    /// Whether the linear yield, with the deviations of one variable from its mean scaled, is the target's. The designs are counted until
    /// the others cannot change the answer.
    fn keeps_target(&self, variable: usize, scale: f64, designs: &[f64]) -> bool {
        let n = self.nominal.len().max(1);
        let mean = self.plan.population.marginals()[variable].mean();
        let mut scaled = designs.to_vec();
        scaled.iter_mut().skip(variable).step_by(n).for_each(|x| *x = mean + scale * (*x - mean));
        let all = designs.len() / n;
        let enough = |good: usize| good as f64 / all.max(1) as f64 >= self.plan.target;
        let (measures, mut good, mut left) = (self.evaluator.measures(), 0, all);
        self.each(&scaled, |found| {
            good += usize::from(measures.iter().zip(found).all(|(measure, value)| measure.met(*value)));
            left -= 1;
            if enough(good) || !enough(good + left) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        enough(good)
    }
}
