//! Limits kept in spite of the scatter of making.
//!
//! Around the design found, every value is a linear function of what scatters. Each limit and each band moves inwards by what the scatter
//! takes: by as many standard deviations as a percentile of the normal distribution asks for, or by the sum of all tolerances at their
//! worst ends. The search is repeated from there, and the scatter is looked at again at the design that it leads to, until the limits rest:
//! X. Du, W. Chen, "Sequential optimization and reliability assessment method for efficient probabilistic design", Journal of Mechanical
//! Design 126 (2004) 225–233. What it leads to is drawn and judged, so that the linearisation need not be believed.

use forcewright_base::diagnostics::Diagnostics;
use forcewright_contract::scatter::Scattering;
use forcewright_contract::studies::{Optimise, Purpose};
use forcewright_model::Outcome;
use forcewright_study::evaluator::Evaluation;
use forcewright_study::optimise::{Reserve, Run};
use forcewright_study::sampling::{LinearModel, Yield, normal};
use forcewright_study::task::Task;

use super::TIGHTER;
use crate::{Loaded, Refused, ToleranceChoices};

/// The part of the designs that keep each limit, where the file does not say.
const PERCENTILE: f64 = 0.95;

/// What of the scatter limits are kept against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Robust {
    /// Each limit is kept by this part of the designs.
    Percentile(f64),
    /// Each limit is kept at the worst ends of all tolerances.
    WorstCase,
}

impl Robust {
    /// What `[optimise]` asks for.
    pub(super) fn asked(section: &Optimise) -> Option<Self> {
        match section.robust.as_ref().map(|r| r.value)? {
            "percentile" => Some(Self::Percentile(section.percentile.as_ref().map_or(PERCENTILE, |p| p.value.si))),
            "worst_case" => Some(Self::WorstCase),
            _ => None,
        }
    }

    /// How far an output goes beyond its value at the nominal design, in the unit of the output.
    fn reach(self, model: &LinearModel, output: usize, value: f64) -> f64 {
        // Where the zone of a tolerance is not centred on the nominal value, its middle counts.
        let off = (model.means()[output] - value).abs();
        match self {
            Self::Percentile(part) => off + normal::quantile(part) * model.sd(output),
            // Half of what each parameter moves it by over its tolerance, all at once.
            Self::WorstCase => off + model.contributions(output).iter().map(|c| c.half_range.abs()).sum::<f64>(),
        }
    }
}

/// Moves limits further inwards, of what is asked and so of what is reserved in all, where the full analysis of the design at `x` leaves less
/// than the scatter takes because between two stations of the search a value comes nearer to its limit than at any of them: at each design
/// by another distance.
pub(super) fn raise((asked, reserve): (&mut Reserve, &mut Reserve), task: &Task, x: &[f64], outcome: &Outcome) {
    let mut found = Evaluation::default();
    if task.evaluator.evaluate(x, false, &mut found, &mut task.evaluator.workspace()).is_err() {
        return;
    }
    asked.limits.resize(reserve.limits.len(), 0.0);
    for limit in &task.limits {
        let room = |value: f64| f64::min(value - limit.lower, limit.upper - value);
        let metrics = limit.checks.iter().filter_map(|name| outcome.metric(name)).filter(|m| m.dimension.si_symbol() == limit.unit);
        let left = metrics.map(|m| room(m.value)).fold(f64::INFINITY, f64::min);
        let taken = |at: usize| reserve.limits[at] - asked.limits[at];
        let spare = |at: usize| room(found.values[at]) - taken(at);
        let tightest = limit.values.clone().reduce(|least, at| if spare(at) < spare(least) { at } else { least });
        // What the stations leave may be less yet, but that is for the search to mend.
        let missing = tightest.map_or(0.0, |at| f64::min(taken(at), room(found.values[at]) - asked.limits[at]) - left);
        // What is at its limit exactly is held there, as a clamp on a wall: the stations do not hide it.
        if missing > 0.0 && left.abs() > 0.0 {
            for reserve in [&mut *asked, &mut *reserve] {
                reserve.limits[limit.values.clone()].iter_mut().for_each(|r| *r += TIGHTER * missing);
            }
        }
    }
}

/// What the scatter of making does to the designs before and after a search that limits it.
#[derive(Clone, Debug)]
pub struct Robustness {
    /// What limits are kept against.
    pub against: Robust,
    /// Numbers that scatter.
    pub scattering: usize,
    /// Times that the scatter was looked at.
    pub rounds: usize,
    /// Whether the limits had come to rest.
    pub settled: bool,
    /// The part of the designs drawn that meet every requirement that a tolerance study sees: around the design of the file, and around
    /// that found; `None` where that design has no curve.
    pub yields: [Option<Yield>; 2],
}

impl Loaded {
    /// The part of the designs made from this project that meet every requirement.
    pub(super) fn drawn(&self) -> Option<Yield> {
        self.tolerance(ToleranceChoices::default(), &mut |_| true).ok().map(|found| found.study.all)
    }

    /// What scatters in this project.
    pub(super) fn scattering(&self) -> Result<Scattering, Refused> {
        let mut diagnostics = Diagnostics::default();
        let section = &self.understood.studies().tolerance;
        let place = section.present.as_ref().map_or(self.project.root, |p| p.span);
        let found = section.scattering(self.understood.numbers(), place, &mut diagnostics);
        found.ok_or_else(|| self.refused(diagnostics))
    }

    /// How far inside its limits the design of this project, which a run has ended at, must be kept: `asked` and what the scatter takes.
    /// `None` if the design has no derivatives.
    ///
    /// # Errors
    /// [`Refused`] if nothing scatters, or what scatters cannot vary.
    pub(super) fn reserve(&self, task: &Task, run: &Run, robust: Robust, asked: &Reserve) -> Result<Option<Reserve>, Refused> {
        let Scattering { free, population } = self.scattering()?;
        let mut diagnostics = Diagnostics::default();
        let refused = |diagnostics| self.refused(diagnostics);
        let Some(around) = self.understood.task(&free, Purpose::Scatter, &mut diagnostics).filter(|_| !diagnostics.has_errors()) else {
            return Err(refused(diagnostics));
        };
        let evaluator = around.evaluator;
        // What is no number of the file, such as the window, is where the run has put it.
        let of_run = |path: &str| task.evaluator.variables().iter().zip(&run.x).find(|(v, _)| v.path == path).map(|(_, x)| *x);
        let variables = evaluator.variables();
        let x: Vec<f64> = variables.iter().map(|v| of_run(&v.path).filter(|_| !v.path.contains('.')).unwrap_or(v.nominal)).collect();
        let mut found = Evaluation::default();
        if evaluator.evaluate(&x, true, &mut found, &mut evaluator.workspace()).is_err() {
            return Ok(None);
        }
        let (all, own) = (variables.len(), population.len());
        let rows = |level: Option<&[f64]>| -> Vec<f64> {
            let row = |row: &[f64]| -> Vec<f64> {
                row[..own].iter().zip(level.into_iter().flatten().chain(std::iter::repeat(&0.0))).map(|(d, l)| d - l).collect()
            };
            found.jacobian.chunks_exact(all.max(1)).flat_map(row).collect()
        };
        let model = |jacobian: Vec<f64>| LinearModel::about(&x[..own], &found.values, jacobian, &population).ok();
        let mut reserve = asked.clone();
        let count = task.evaluator.outputs().iter().map(|o| o.values.end).max().unwrap_or(0);
        reserve.limits.resize(count, 0.0);
        reserve.bands.resize(count, 0.0);
        if let Some(model) = model(rows(None)) {
            // Where the scatter moves other nodes than the search does, other places are looked at: the worst of a kind speaks for all.
            for (own, other) in task.evaluator.outputs().iter().zip(evaluator.outputs()) {
                let reach = |at: usize| robust.reach(&model, at, found.values[at]);
                let same = own.values.len() == other.values.len();
                let worst = if same { 0.0 } else { other.values.clone().map(reach).fold(0.0, f64::max) };
                for (at, there) in own.values.clone().zip(other.values.clone().map(Some).chain(std::iter::repeat(None))) {
                    reserve.limits[at] = asked.limits.get(at).copied().unwrap_or(0.0) + there.filter(|_| same).map_or(worst, reach);
                }
            }
        }
        for band in task.steps.last().into_iter().flat_map(|s| &s.bands) {
            // The forces of the window come first, at the same places, whatever varies.
            let Some(values) = found.values.get(band.values.clone()) else { continue };
            let (high, low) = values.iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(h, l), v| (h.max(*v), l.min(*v)));
            let level = band.level.unwrap_or_else(|| f64::midpoint(high, low));
            // A level that is free follows the scatter, as each device is set by itself.
            let mean = |column: usize| band.values.clone().map(|at| found.jacobian[at * all + column]).sum::<f64>() / values.len() as f64;
            let follows: Vec<f64> = (0..own).map(|column| if band.level.is_none() { mean(column) } else { 0.0 }).collect();
            let Some(model) = model(rows(Some(&follows))) else { continue };
            for at in band.values.clone() {
                reserve.bands[at] = asked.bands.get(at).copied().unwrap_or(0.0) + robust.reach(&model, at, found.values[at]) / level.abs();
            }
        }
        Ok(Some(reserve))
    }
}
