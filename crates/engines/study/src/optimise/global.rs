//! A task as a search of the whole range: its last step by values alone.
//!
//! What [`crate::posing`] has as unknowns beside the variables follows from the values here: the level of a band is the middle between its
//! largest and smallest value, the half width the distance of either from that, the largest value itself. The ends of a window are
//! searched for: they move the stations whose values these are.

use std::sync::{Mutex, PoisonError};

use super::{Progress, Reserve, Settings, near};
use crate::cma;
use crate::evaluator::{Evaluation, Workspace};
use crate::posing::inner_bounds;
use crate::task::{Band, Goal, Step, Task};

/// Designs from which the search by gradients goes on.
const MOST_POLISHED: usize = 8;
/// A restart ends where its designs differ by so little, relative, and in parts of the ranges: the search by gradients does the rest.
const GOAL_TOLERANCE: f64 = 1e-4;
const STEP_TOLERANCE: f64 = 1e-3;
/// Restarts in a row without a gain after which the search is over, and restarts with larger populations at most.
const PATIENCE: usize = 8;
const MOST_RESTARTS: usize = 20;
/// Below this ratio of the middle to half the distance of its ends a band says little, and nothing where the middle is negative.
const LEAST_MIDDLE: f64 = 1e-3;
/// Beyond that all are as bad.
const MOST_NEGATIVE: f64 = -1e9;

/// What a search of the whole range is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Global {
    /// Designs that it computes at most.
    pub evaluations: u64,
}

/// Where a search of the whole range stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Generation {
    /// The run, from 0.
    pub run: usize,
    /// Designs computed so far.
    pub evaluations: u64,
}

/// A design that the search of the whole range led to.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The design, SI.
    pub x: Vec<f64>,
    /// Its goal, as [`super::Run::goal`].
    pub goal: f64,
    /// Its largest violation, relative to the scale of its limit.
    pub violation: f64,
    /// The runs of the search that ended there.
    pub members: Vec<usize>,
}

/// What a search of the whole range did.
#[derive(Clone, Debug, PartialEq)]
pub struct Explored {
    /// Its runs, in their order.
    pub runs: Vec<cma::Run>,
    /// Designs computed.
    pub evaluations: u64,
    /// Those of them without values.
    pub failed: u64,
    /// The different designs that runs ended at, the best first; each is the start of a search by gradients, after that from the design.
    pub places: Vec<Place>,
    /// Designs beyond those that no search went on from.
    pub left: usize,
}

/// The last step of a task.
struct Whole<'a> {
    task: &'a Task,
    step: &'a Step,
    reserve: &'a Reserve,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// Rooms that no thread uses at the moment.
    rooms: Mutex<Vec<(Workspace, Evaluation)>>,
}

impl<'a> Whole<'a> {
    fn new(task: &'a Task, step: &'a Step, reserve: &'a Reserve) -> Self {
        let variables = task.evaluator.variables();
        let end = |of: fn(&crate::evaluator::Variable) -> f64| {
            variables.iter().enumerate().map(|(i, v)| if step.held.contains(&i) { v.nominal } else { of(v) }).collect()
        };
        Self { task, step, reserve, lower: end(|v| v.lower), upper: end(|v| v.upper), rooms: Mutex::new(Vec::new()) }
    }

    fn goal(&self, x: &[f64], values: &[f64]) -> f64 {
        match &self.step.goal {
            Goal::HalfWidth => {
                let own = self.step.bands.iter().filter(|b| b.half_width.is_none());
                own.map(|b| self.deviation(b, values)).fold(0.0, f64::max)
            }
            Goal::Variables(weights) => weights.iter().map(|(i, w)| w * x[*i]).sum(),
            Goal::Values(weights) => weights.iter().map(|(i, w)| w * values[*i]).sum(),
            Goal::Largest { values: range, scale } => values[range.clone()].iter().fold(0.0_f64, |m, v| m.max(v.abs())) / scale,
            Goal::Squares { values: range, targets, scale } => {
                values[range.clone()].iter().zip(targets).map(|(v, t)| (v - t) / scale * ((v - t) / scale)).sum()
            }
        }
    }

    /// The half width of the narrowest band that holds these values: the largest of `|v/F − 1|`, for the best level F where it is free,
    /// and of the reserve from its edges.
    fn deviation(&self, band: &Band, values: &[f64]) -> f64 {
        let own = &values[band.values.clone()];
        let (high, low) = own.iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(h, l), v| (h.max(*v), l.min(*v)));
        if let Some(level) = band.level {
            let off = |(at, v): (usize, &f64)| (v / level - 1.0).abs() + self.reserve.of_band(at);
            return band.values.clone().zip(own).map(off).fold(0.0, f64::max);
        }
        let reserve = band.values.clone().map(|at| self.reserve.of_band(at)).fold(0.0, f64::max);
        let (middle, half) = (f64::midpoint(high, low), 0.5 * (high - low));
        let ratio = if half > 0.0 || middle <= 0.0 { (middle / half).max(MOST_NEGATIVE) } else { f64::INFINITY };
        // Where the middle comes near to zero and beyond, on along the tangent: worse the further.
        let width = if ratio >= LEAST_MIDDLE { 1.0 / ratio } else { (2.0 - ratio / LEAST_MIDDLE) / LEAST_MIDDLE };
        width + reserve
    }

    /// By how much limits and bands are missed: one number of each, that of its worst value.
    fn misses(&self, values: &[f64]) -> Vec<f64> {
        let limits = self.task.limits.iter().map(|limit| {
            let miss = |at: usize| {
                let [lower, upper] = inner_bounds(limit, self.reserve, at);
                (lower - values[at] / limit.scale).max(values[at] / limit.scale - upper)
            };
            limit.values.clone().map(miss).fold(f64::NEG_INFINITY, f64::max)
        });
        let bands = self.step.bands.iter().filter_map(|b| b.half_width.map(|half| self.deviation(b, values) - half));
        limits.chain(bands).collect()
    }
}

impl cma::Problem for Whole<'_> {
    fn lower(&self) -> &[f64] {
        &self.lower
    }

    fn upper(&self) -> &[f64] {
        &self.upper
    }

    fn assess(&self, x: &[f64]) -> Option<cma::Assessment> {
        // A thread that panicked holds no room.
        let free = self.rooms.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let (mut workspace, mut found) = free.unwrap_or_else(|| (self.task.evaluator.workspace(), Evaluation::default()));
        let done = self.task.evaluator.evaluate(x, false, &mut found, &mut workspace);
        let known = done.is_ok().then(|| cma::Assessment { goal: self.goal(x, &found.values), misses: self.misses(&found.values) });
        self.rooms.lock().unwrap_or_else(PoisonError::into_inner).push((workspace, found));
        known
    }
}

impl Task {
    /// The limit or band that a design misses most, by the name of the limit or of the band's check, and by how much: relative to the limit
    /// itself, or to what is a large change of it where it is zero; to the half width of a band. `None` where nothing is missed, or there are
    /// no values.
    pub fn largest_miss(&self, x: &[f64]) -> Option<(String, f64)> {
        let (step, reserve) = (self.steps.last()?, Reserve::default());
        let whole = Whole::new(self, step, &reserve);
        let mut found = Evaluation::default();
        self.evaluator.evaluate(x, false, &mut found, &mut self.evaluator.workspace()).ok()?;
        let limits = self.limits.iter().map(|limit| {
            let size = |bound: f64| if bound.abs() > 0.0 { bound.abs() } else { limit.scale };
            let miss = |v: &f64| ((limit.lower - v) / size(limit.lower)).max((v - limit.upper) / size(limit.upper));
            // A side without a limit is infinitely far away: ∞/∞ is no number, and no miss.
            let values = found.values.get(limit.values.clone()).unwrap_or_default();
            (limit.name.clone(), values.iter().map(miss).fold(0.0, f64::max))
        });
        let bands = step.bands.iter().filter_map(|band| {
            let half = band.half_width?;
            let name = band.checks.first().copied().unwrap_or("band");
            Some((name.to_owned(), (whole.deviation(band, &found.values) - half) / half))
        });
        limits.chain(bands).filter(|(_, miss)| *miss > 0.0).reduce(|most, next| if next.1 > most.1 { next } else { most })
    }
}

/// The goal of a task at a design, and the largest violation, as the search of the whole range sees them.
#[cfg(test)]
pub(super) fn standing(task: &Task, x: &[f64]) -> Option<(f64, f64)> {
    let found = cma::Problem::assess(&Whole::new(task, task.steps.last()?, &Reserve::default()), x)?;
    Some((found.goal, found.misses.iter().fold(0.0, |m, g| m.max(*g))))
}

/// Searches the whole range. `go_on` sees every generation; whether it was interrupted comes with what was found.
pub(super) fn explore(task: &Task, settings: &Settings, asked: Global, go_on: &dyn Fn(&Progress) -> bool) -> Option<Explored> {
    let step = task.steps.last()?;
    let problem = Whole::new(task, step, &settings.reserve);
    let own = cma::Settings {
        evaluations: asked.evaluations,
        seed: settings.seed,
        restarts: MOST_RESTARTS,
        patience: PATIENCE,
        goal_tolerance: GOAL_TOLERANCE,
        step_tolerance: STEP_TOLERANCE,
        kept: settings.nlp.feasibility,
        ..cma::Settings::default()
    };
    let nominal: Vec<f64> = task.evaluator.variables().iter().map(|v| v.nominal).collect();
    let watch = |p: &cma::Progress| {
        let (goal, violation) = p.best.map_or((f64::NAN, f64::INFINITY), |b| (b.goal, b.violation));
        let global = Some(Generation { run: p.run, evaluations: p.evaluations });
        go_on(&Progress { start: 0, step: task.steps.len() - 1, iteration: p.generation, goal, violation, global })
    };
    // Ranges that make no sense are for the search by gradients to tell, which calls them malformed.
    let found = cma::minimise(&problem, &nominal, &own, &watch).ok()?;
    let mut ends: Vec<(usize, &cma::Point)> = found.runs.iter().enumerate().filter_map(|(i, r)| Some((i, r.best.as_ref()?))).collect();
    ends.sort_by(|a, b| a.1.compare(b.1).then(a.0.cmp(&b.0)));
    let mut places: Vec<Place> = Vec::new();
    for (run, end) in ends {
        match places.iter_mut().find(|p| near(task.evaluator.as_ref(), &p.x, &end.x)) {
            Some(place) => place.members.push(run),
            None => places.push(Place { x: end.x.clone(), goal: end.goal, violation: end.violation, members: vec![run] }),
        }
    }
    let left = places.len().saturating_sub(MOST_POLISHED);
    places.truncate(MOST_POLISHED);
    Some(Explored { runs: found.runs, evaluations: found.evaluations, failed: found.failed, places, left })
}
