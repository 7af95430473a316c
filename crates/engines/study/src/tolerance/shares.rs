//! Which variables matter: ends of one at a time, and shares of the variance.

use super::run::{Points, designs};
use super::{Plan, REPLICATES, Study, known};
use crate::evaluator::{Evaluation, Evaluator, Workspace};
use crate::sampling::{Population, SensitivityError, SensitivityPlan, SensitivityTally, SobolIndices};

/// The limiting measures with one variable at the ends of its tolerance, all others nominal.
#[derive(Clone, Debug, PartialEq)]
pub struct Tornado {
    /// Index of the variable.
    pub variable: usize,
    /// Its lower and upper end, SI.
    pub ends: [f64; 2],
    /// Per limiting measure: its values at both ends, SI; `None` where the design, or the measure, has none.
    pub values: Vec<[Option<f64>; 2]>,
}

impl Tornado {
    /// How far a limiting measure moves between the ends and its nominal value, SI; infinite where it has no value at an end.
    pub fn reach(&self, place: usize, nominal: Option<f64>) -> f64 {
        let values = self.values.get(place).copied().unwrap_or_default();
        let all = [nominal, values[0], values[1]];
        let found = || all.iter().filter_map(|v| *v);
        if all.contains(&None) {
            // All of them missing says nothing of this variable.
            return if found().next().is_some() { f64::INFINITY } else { 0.0 };
        }
        found().fold(f64::NEG_INFINITY, f64::max) - found().fold(f64::INFINITY, f64::min)
    }
}

/// Sobol indices of a measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Share {
    /// Index of the measure.
    pub measure: usize,
    /// First and total indices, per factor.
    pub indices: SobolIndices,
}

/// The ends of every variable that scatters, the one with the largest relative effect on any limiting measure first.
pub(super) fn tornado(evaluator: &dyn Evaluator, population: &Population, study: &Study, workspace: &mut Workspace) -> Vec<Tornado> {
    let nominal: Vec<f64> = study.variables.iter().map(|v| v.nominal).collect();
    let (mut out, mut measured) = (Evaluation::default(), Vec::new());
    let mut all = Vec::new();
    for (variable, marginal) in population.marginals().iter().enumerate() {
        let half = marginal.half_width();
        if half.is_nan() || half <= 0.0 {
            continue;
        }
        let ends = [marginal.mean() - half, marginal.mean() + half];
        let mut values = vec![[None; 2]; study.limiting.len()];
        for (side, end) in ends.into_iter().enumerate() {
            let mut x = nominal.clone();
            x[variable] = end;
            if evaluator.evaluate(&x, false, &mut out, workspace).is_ok() {
                evaluator.measure(&x, &out.values, &mut measured, workspace);
                for (pair, index) in values.iter_mut().zip(&study.limiting) {
                    pair[side] = measured.get(*index).copied().and_then(known);
                }
            }
        }
        all.push(Tornado { variable, ends, values });
    }
    let before = |place: usize| study.nominal_measures.get(study.limiting[place]).copied().flatten();
    let widest: Vec<f64> = (0..study.limiting.len())
        .map(|i| all.iter().map(|t| t.reach(i, before(i))).filter(|r| r.is_finite()).fold(0.0, f64::max))
        .collect();
    let effect = |t: &Tornado| {
        let relative = |i: usize| if widest[i] > 0.0 { t.reach(i, before(i)) / widest[i] } else { 0.0 };
        (0..widest.len()).map(relative).fold(0.0, f64::max)
    };
    all.sort_by(|a, b| effect(b).total_cmp(&effect(a)));
    all
}

/// The points of the indices, if they are asked for.
pub(super) fn plan(plan: &Plan, parameters: usize) -> Result<Option<SensitivityPlan>, SensitivityError> {
    if plan.sensitivity_points == 0 || parameters == 0 {
        return Ok(None);
    }
    // Other points than those of the sample.
    SensitivityPlan::new(parameters, plan.population.factors(), REPLICATES, plan.seed.wrapping_add(1)).map(Some)
}

/// The indices of every limiting measure that varies; `None` if it was stopped.
pub(super) fn of_variance(
    evaluator: &dyn Evaluator,
    plan: &Plan,
    points: &SensitivityPlan,
    study: &Study,
    watch: &mut dyn FnMut(u64) -> bool,
) -> Option<Vec<Share>> {
    let limiting = &study.limiting;
    let mut tally = SensitivityTally::new(points, limiting.len());
    let of_base = points.rows_per_base() * limiting.len();
    let mut rows: Vec<f64> = Vec::with_capacity(of_base);
    let all = Points { count: points.rows(plan.sensitivity_points), fill: Box::new(|first, out| points.fill(first, out)) };
    let finished = designs(evaluator, &plan.population, &all, watch, &mut |chunk| {
        for design in chunk.designs() {
            let measures = design.unwrap_or_default();
            rows.extend(limiting.iter().map(|i| measures.get(*i).copied().unwrap_or(f64::NAN)));
            if rows.len() >= of_base {
                tally.record(&rows);
                rows.clear();
            }
        }
    });
    let indices = |place: usize| tally.indices(place, plan.confidence).map(|indices| Share { measure: limiting[place], indices });
    finished.then(|| (0..limiting.len()).filter_map(indices).collect())
}
