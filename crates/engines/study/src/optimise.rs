//! Searching for better designs: one or many starts, or the whole range, the basins that they lead to, and what limits the best.

mod global;

pub use global::{Explored, Generation, Global, Place};

use rayon::prelude::*;

use crate::evaluator::{Evaluator, Variable};
use crate::nlp::{self, Stop};
use crate::posing::{Posing, Source};
use crate::sampling::Sobol;
use crate::task::Task;

/// Two runs lie in the same basin if no variable differs by more than this part of its range.
const SAME: f64 = 0.02;
/// A multiplier below this part of the largest is rounding.
const IDLE: f64 = 1e-6;

/// Tolerance, least gain and most iterations of steps that lead to the last one.
const ON_THE_WAY: f64 = 1e-2;
const MOST_ON_THE_WAY: usize = 10;

/// A variable is at the end of its range if it is no further from it than this part of it.
pub const AT_ITS_END: f64 = 1e-6;

/// So many starts are spread over the ranges; of further ones half begin near to the best designs that those before have found …
const ALL_SPREAD: usize = 4;
/// … at most so many of them in turn …
const MOST_CENTRES: usize = 4;
/// … within this part of the ranges.
const NEARBY: f64 = 0.3;

/// What a search is asked for.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Number of starts: the first from the design, the others spread over the ranges by a scrambled Sobol sequence, or near to what those
    /// before have found. More starts have the same first ones. With [`Self::more_starts`] it may be 0.
    pub starts: usize,
    /// In place of starts spread over the ranges: a search of the whole range, from whose best designs searches go on. The first start is
    /// the design still.
    pub global: Option<Global>,
    /// Starts beside those, SI, each one value per variable; a value beyond its range starts at its end.
    pub more_starts: Vec<Vec<f64>>,
    /// Seed of the starts after the first, and of the search of the whole range.
    pub seed: u64,
    /// How far inside its limits the design is kept.
    pub reserve: Reserve,
    /// Of the optimiser.
    pub nlp: nlp::Settings,
}

impl Default for Settings {
    fn default() -> Self {
        // A design is made to four digits.
        let nlp = nlp::Settings { tolerance: 1e-5, feasibility: 1e-5, iteration_limit: 200, least_gain: 1e-4, ..nlp::Settings::default() };
        Self { starts: 1, global: None, more_starts: Vec::new(), seed: 1, reserve: Reserve::default(), nlp }
    }
}

/// How far inside its limits and bands a design is kept.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reserve {
    /// From every limit, relative to it.
    pub margin: f64,
    /// Beside that, per value, from its limits, SI; empty: nothing.
    pub limits: Vec<f64>,
    /// Per value, from the edges of its bands, relative to their levels; empty: nothing.
    pub bands: Vec<f64>,
}

impl Reserve {
    pub(crate) fn of_limit(&self, value: usize) -> f64 {
        self.limits.get(value).copied().unwrap_or(0.0)
    }

    pub(crate) fn of_band(&self, value: usize) -> f64 {
        self.bands.get(value).copied().unwrap_or(0.0)
    }

    /// By how much another reserve falls short of this one, from a limit or from a band: as part of the largest of this one from the same
    /// limit, the largest of all; 0 where it lacks nothing.
    pub fn lacking(&self, other: &Self, task: &Task) -> f64 {
        let short = |own: &dyn Fn(usize) -> f64, other: &dyn Fn(usize) -> f64, values: std::ops::Range<usize>| {
            let most = values.clone().fold(f64::MIN_POSITIVE, |m, at| m.max(own(at)));
            values.fold(0.0_f64, |m, at| m.max((own(at) - other(at)) / most))
        };
        let limits = task.limits.iter().map(|l| short(&|at| self.of_limit(at), &|at| other.of_limit(at), l.values.clone()));
        limits.fold(short(&|at| self.of_band(at), &|at| other.of_band(at), 0..self.bands.len()), f64::max)
    }

    /// Whether no distance from a limit differs from that of another reserve by more than this part of the largest from that limit, nor
    /// any from a band.
    pub fn rests(&self, other: &Self, task: &Task, part: f64) -> bool {
        let near = |own: &dyn Fn(usize) -> f64, other: &dyn Fn(usize) -> f64, values: std::ops::Range<usize>| {
            let most = values.clone().fold(0.0_f64, |m, at| m.max(own(at).abs()));
            values.into_iter().all(|at| (own(at) - other(at)).abs() <= part * most)
        };
        let limits = task.limits.iter().all(|l| near(&|at| self.of_limit(at), &|at| other.of_limit(at), l.values.clone()));
        limits && near(&|at| self.of_band(at), &|at| other.of_band(at), 0..self.bands.len().max(other.bands.len()))
    }
}

/// Where a search stands: one start, one iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The start, from 0.
    pub start: usize,
    /// The step of the task, from 0.
    pub step: usize,
    /// The iteration of that step.
    pub iteration: usize,
    /// The goal's value at the best point so far, as [`Run::goal`].
    pub goal: f64,
    /// The largest violation there, relative to the scale of its limit.
    pub violation: f64,
    /// Of a search of the whole range, which has no start, and whose iterations are generations.
    pub global: Option<Generation>,
}

/// What of a design holds the optimum back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// A requirement.
    Limit,
    /// The end of a variable's range.
    Range,
    /// The value at which a variable is held, as one that can be had in sizes only.
    Size,
}

/// A limit or range that holds the optimum back.
#[derive(Clone, Debug, PartialEq)]
pub struct Active {
    /// What it is.
    pub hold: Hold,
    /// The limit in words, or the path of the variable at the end of its range, or held.
    pub name: String,
    /// Key in the project file that relaxes it.
    pub key: String,
    /// The limit's value, or that of the variable, SI.
    pub bound: f64,
    /// Symbol of the SI unit.
    pub unit: &'static str,
    /// What the goal would gain, to first order, if the limit were relaxed by one percent of its own size, or of what is a large change
    /// where it is zero; the range of a variable by one percent of itself.
    pub gain: f64,
    /// How many of its values are at the limit.
    pub places: usize,
}

/// One local search.
#[derive(Clone, Debug)]
pub struct Run {
    /// Where it started, SI.
    pub start: Vec<f64>,
    /// Where it ended, SI.
    pub x: Vec<f64>,
    /// The value of the goal at its end, in the unit of the goal: the half width of the band, the weighted sum, the largest value, the
    /// sum of squares. Smaller is better.
    pub goal: f64,
    /// Largest violation of a limit, relative to its scale.
    pub violation: f64,
    /// Distance from the optimality conditions, scaled.
    pub kkt_residual: f64,
    /// How it ended.
    pub stop: Stop,
    /// The goal and the violation at the best point, iteration by iteration, of the last step.
    pub history: Vec<[f64; 2]>,
    /// Iterations of all steps.
    pub iterations: usize,
    /// Designs evaluated.
    pub evaluations: u64,
    /// What holds it back, the strongest first.
    pub active: Vec<Active>,
}

impl Run {
    /// Whether its end keeps to all limits.
    pub fn feasible(&self, tolerance: f64) -> bool {
        self.violation <= tolerance && self.goal.is_finite()
    }
}

/// Runs that ended at the same design.
#[derive(Clone, Debug, PartialEq)]
pub struct Basin {
    /// The best of them, by its index.
    pub best: usize,
    /// All of them.
    pub members: Vec<usize>,
}

/// What a search found.
#[derive(Clone, Debug)]
pub struct Search {
    /// What the search of the whole range did, if one was asked for.
    pub explored: Option<Explored>,
    /// All runs, in the order of their starts: the design, the places of the search of the whole range, those given; without those that had
    /// not begun when it was interrupted.
    pub runs: Vec<Run>,
    /// The best: the feasible one of the least goal, or the one of the least violation.
    pub best: Option<usize>,
    /// Feasible runs by where they ended, the best basin first.
    pub basins: Vec<Basin>,
    /// Whether it was interrupted.
    pub interrupted: bool,
}

impl Search {
    /// Designs computed in all.
    pub fn evaluations(&self) -> u64 {
        self.runs.iter().map(|r| r.evaluations).sum::<u64>() + self.explored.as_ref().map_or(0, |e| e.evaluations)
    }
}

/// Searches from one or many starts, or the whole range. `watch` sees every iteration of every start, from any thread, and stops all of
/// them by returning `false`; the best so far is kept. The same seed gives the same bits for any number of threads.
pub fn search(task: &Task, settings: &Settings, watch: &(dyn Fn(&Progress) -> bool + Sync)) -> Search {
    let interrupted = std::sync::atomic::AtomicBool::new(false);
    let go_on = |progress: &Progress| {
        let on = !interrupted.load(std::sync::atomic::Ordering::Relaxed) && watch(progress);
        if !on {
            interrupted.store(true, std::sync::atomic::Ordering::Relaxed);
        }
        on
    };
    let tolerance = kept(settings);
    let explored = settings.global.and_then(|asked| global::explore(task, settings, asked, &go_on));
    let places = explored.as_ref().map_or(&[][..], |e| &e.places);
    let run = |(index, start): (usize, Vec<f64>)| {
        // Starts that have not begun when it is interrupted never do; the first, and the best place, always do, so that there is a best.
        let begins = index <= usize::from(!places.is_empty()) || !interrupted.load(std::sync::atomic::Ordering::Relaxed);
        let place = index.checked_sub(1).and_then(|i| places.get(i));
        begins.then(|| {
            place.map_or_else(|| run_steps(task, settings, (index, start, 0), &go_on), |p| polished(task, settings, (index, p), &go_on))
        })
    };
    let evaluator = task.evaluator.as_ref();
    let mut runs: Vec<Option<Run>> = Vec::new();
    for starts in all_starts(evaluator, settings, places) {
        // All of those before have ended when these begin, so that the number of threads changes nothing.
        let (first, starts) = (runs.len(), around_the_best(evaluator, &runs, starts, tolerance));
        runs.par_extend(starts.into_par_iter().enumerate().map(|(index, start)| run((first + index, start))));
    }
    let runs: Vec<Run> = runs.into_iter().flatten().collect();
    let feasible: Vec<usize> = (0..runs.len()).filter(|i| runs[*i].feasible(tolerance)).collect();
    let least = |indices: &[usize], of: &dyn Fn(&Run) -> f64| {
        indices.iter().copied().filter(|i| !of(&runs[*i]).is_nan()).reduce(|best, i| if of(&runs[i]) < of(&runs[best]) { i } else { best })
    };
    let all: Vec<usize> = (0..runs.len()).collect();
    let best = least(&feasible, &|r| r.goal).or_else(|| least(&all, &|r| r.violation));
    let basins = basins(task.evaluator.as_ref(), &runs, feasible);
    Search { explored, best, basins, interrupted: interrupted.into_inner(), runs }
}

/// Starts of a round: each with whether it is moved near to what the rounds before have found.
type Round = Vec<(Vec<f64>, bool)>;

/// The starts of a round; those that are to be near to the best designs that were found in their places: as far from them as those lie from
/// the middle of their range, on a smaller scale. Starts stay what they are where nothing was found.
fn around_the_best(evaluator: &dyn Evaluator, runs: &[Option<Run>], starts: Round, tolerance: f64) -> Vec<Vec<f64>> {
    let found: Vec<&Run> = runs.iter().flatten().collect();
    let feasible = (0..found.len()).filter(|i| found[*i].feasible(tolerance)).collect();
    let mut best = basins(evaluator, &found, feasible);
    best.truncate(MOST_CENTRES);
    let moved = |start: Vec<f64>, centre: &[f64]| {
        let scattered = |((v, x), own): ((&Variable, f64), &f64)| {
            // What is no number of the design, such as a window, begins where it ended.
            let free = v.path.contains('.') && v.lower.is_finite() && v.upper.is_finite();
            let off = if free { NEARBY * (x - f64::midpoint(v.lower, v.upper)) } else { 0.0 };
            (own + off).clamp(v.lower, v.upper)
        };
        evaluator.variables().iter().zip(start).zip(centre).map(scattered).collect()
    };
    let mut centres = best.iter().map(|b| &found[b.best].x).cycle();
    let start = |(start, near): (Vec<f64>, bool)| match if near { centres.next() } else { None } {
        Some(centre) => moved(start, centre),
        None => start,
    };
    starts.into_iter().map(start).collect()
}

/// Searches on from where a run ended, with other settings; only the last step of the task.
pub fn again(task: &Task, settings: &Settings, run: &Run, watch: &(dyn Fn(&Progress) -> bool + Sync)) -> Run {
    let last = task.steps.len().saturating_sub(1);
    let mut next = run_steps(task, settings, (0, run.x.clone(), last), &|p| watch(p));
    next.start.clone_from(&run.start);
    next.iterations += run.iterations;
    next.evaluations += run.evaluations;
    next
}

/// Searches on from a place of a search of the whole range; what it was, where that finds nothing as good.
fn polished(task: &Task, settings: &Settings, (index, place): (usize, &Place), go_on: &dyn Fn(&Progress) -> bool) -> Run {
    let tolerance = kept(settings);
    // Steps that lead near from afar would lead away; where limits are missed, there is nothing to lead away from.
    let first = if place.violation <= tolerance { task.steps.len().saturating_sub(1) } else { 0 };
    let mut run = run_steps(task, settings, (index, place.x.clone(), first), go_on);
    let lost = match (place.violation <= tolerance, run.feasible(tolerance)) {
        (true, true) => run.goal - place.goal > settings.nlp.least_gain * place.goal.abs(),
        (false, false) => run.violation.is_nan() || run.violation > place.violation,
        (place, run) => place && !run,
    };
    if lost {
        // With what limits it there, as far as that can be known.
        let still = Settings { nlp: nlp::Settings { iteration_limit: 0, ..settings.nlp.clone() }, ..settings.clone() };
        let here = run_steps(task, &still, (index, place.x.clone(), task.steps.len().saturating_sub(1)), &|_| true);
        let (active, kkt_residual) = (here.active, here.kkt_residual);
        let stop = if run.stop == Stop::Interrupted { run.stop } else { Stop::Stalled };
        run.evaluations += here.evaluations;
        run = Run { x: place.x.clone(), goal: place.goal, violation: place.violation, stop, active, kkt_residual, ..run };
    }
    run
}

/// A violation that counts as none.
fn kept(settings: &Settings) -> f64 {
    settings.nlp.feasibility.max(1e-6) * 10.0
}

/// The starts of the settings in their rounds, the design itself if there are none. Of more starts the first are those of fewer: the fifth
/// to the eighth are near to the best of those before, as are the later ones of every doubling of their number after that.
fn all_starts(evaluator: &dyn Evaluator, settings: &Settings, places: &[Place]) -> Vec<Round> {
    let variables = evaluator.variables();
    let more = settings.more_starts.iter().filter(|x| x.len() == variables.len());
    let more: Vec<Vec<f64>> = more.map(|x| x.iter().zip(variables).map(|(x, v)| x.max(v.lower).min(v.upper)).collect()).collect();
    let fixed = |starts: Vec<Vec<f64>>| starts.into_iter().map(|start| (start, false)).collect::<Round>();
    if settings.global.is_some() {
        let nominal = variables.iter().map(|v| v.nominal).collect();
        return vec![fixed(std::iter::once(nominal).chain(places.iter().map(|p| p.x.clone())).chain(more).collect())];
    }
    let mut own = if settings.starts == 0 && !more.is_empty() { Vec::new() } else { starts(evaluator, settings) };
    let mut later = own.split_off(own.len().min(ALL_SPREAD));
    own.extend(more);
    let mut rounds = vec![fixed(own)];
    let (mut near, mut spread) = (ALL_SPREAD, ALL_SPREAD);
    while !later.is_empty() {
        let next = later.split_off(later.len().min(near + spread));
        rounds.push(later.into_iter().enumerate().map(|(index, start)| (start, index < near)).collect());
        (later, near) = (next, spread);
        spread *= 2;
    }
    rounds
}

/// The design itself, and points spread over the ranges that are finite.
fn starts(evaluator: &dyn Evaluator, settings: &Settings) -> Vec<Vec<f64>> {
    let variables = evaluator.variables();
    let nominal: Vec<f64> = variables.iter().map(|v| v.nominal).collect();
    let mut starts = vec![nominal];
    let spread = |v: &Variable| v.lower.is_finite() && v.upper.is_finite();
    let dimensions = variables.iter().filter(|v| spread(v)).count();
    let Ok(sobol) = Sobol::scrambled(dimensions.max(1), settings.seed) else { return starts };
    let mut point = vec![0.0; dimensions.max(1)];
    for index in 1..settings.starts.max(1) {
        sobol.point(index as u64, &mut point);
        let mut parts = point.iter();
        let mut part = |v: &Variable| if spread(v) { parts.next() } else { None };
        let x = variables.iter().map(|v| part(v).map_or(v.nominal, |part| v.lower + part * (v.upper - v.lower)));
        starts.push(x.collect());
    }
    starts
}

fn run_steps(task: &Task, settings: &Settings, (index, start, first): (usize, Vec<f64>, usize), go_on: &dyn Fn(&Progress) -> bool) -> Run {
    let mut run = Run {
        x: start.clone(),
        start,
        goal: f64::NAN,
        violation: f64::INFINITY,
        kkt_residual: f64::INFINITY,
        stop: Stop::StartRejected,
        history: Vec::new(),
        iterations: 0,
        evaluations: 0,
        active: Vec::new(),
    };
    for (number, step) in task.steps.iter().enumerate().skip(first) {
        let Some(mut posing) = Posing::new(task, step, &run.x, &settings.reserve) else { break };
        let start = posing.start.clone();
        // Limits come with their scales.
        let mut nlp = nlp::Settings { constraint_scales: vec![1.0; posing.sources.len()], ..settings.nlp.clone() };
        if number + 1 < task.steps.len() {
            // A step on the way need only lead near.
            (nlp.tolerance, nlp.least_gain, nlp.iteration_limit) = (ON_THE_WAY, ON_THE_WAY, nlp.iteration_limit.min(MOST_ON_THE_WAY));
        }
        run.history.clear();
        let history = &mut run.history;
        let solution = nlp::minimise(&mut posing, &start, &nlp, &mut |p: &nlp::Progress| {
            history.push([p.best_objective, p.best_violation]);
            go_on(&Progress {
                start: index,
                step: number,
                iteration: p.iteration,
                goal: p.best_objective,
                violation: p.best_violation,
                global: None,
            })
        });
        run.iterations += solution.counters.iterations;
        run.evaluations += posing.evaluations;
        run.stop = solution.stop;
        if matches!(solution.stop, Stop::StartRejected | Stop::Malformed) {
            break;
        }
        run.x = posing.design(&solution.x);
        run.goal = solution.objective;
        run.violation = solution.violation;
        run.kkt_residual = solution.kkt_residual.optimality();
        run.active = active(task, &posing, &solution);
        // A step on the way that fails leaves a start as good as any.
        if solution.stop == Stop::Interrupted {
            // Runs are compared by the goal of the last step.
            if let Some(last) = task.steps.last().filter(|_| number + 1 < task.steps.len()) {
                let standing = Posing::new(task, last, &run.x, &settings.reserve).and_then(|mut p| p.standing());
                (run.goal, run.violation) = standing.unwrap_or((f64::NAN, f64::INFINITY));
            }
            break;
        }
    }
    run
}

/// What holds the optimum back, with what relaxing it would gain.
fn active(task: &Task, posing: &Posing, solution: &nlp::Solution) -> Vec<Active> {
    let mut found: Vec<Active> = Vec::new();
    for (source, multiplier) in posing.sources.iter().zip(&solution.multipliers) {
        let Source::Limit(index, _) = *source else { continue };
        let limit = &task.limits[index];
        if *multiplier == 0.0 {
            continue;
        }
        let bound = if *multiplier > 0.0 { limit.lower } else { limit.upper };
        let relaxed = 0.01 * if bound == 0.0 { 1.0 } else { bound.abs() / limit.scale };
        let gain = multiplier.abs() * relaxed;
        if let Some(known) = found.iter_mut().find(|a| a.key == limit.key && a.bound.to_bits() == bound.to_bits()) {
            known.gain += gain;
            known.places += 1;
        } else {
            let (name, key) = (limit.name.clone(), limit.key.clone());
            found.push(Active { hold: Hold::Limit, name, key, bound, unit: limit.unit, gain, places: 1 });
        }
    }
    let ends = task.evaluator.variables().iter().zip(posing.design(&solution.x)).zip(&solution.bound_multipliers);
    for (index, ((variable, x), multiplier)) in ends.enumerate().filter(|(_, (_, multiplier))| **multiplier != 0.0) {
        let end = if *multiplier > 0.0 { variable.lower } else { variable.upper };
        let (hold, bound) = if posing.holds(index) { (Hold::Size, x) } else { (Hold::Range, end) };
        // What is estimated of a bound that is not met is no price of it.
        if (x - bound).abs() <= AT_ITS_END * variable.scale() {
            let (name, key) = (variable.path.clone(), variable.path.clone());
            found.push(Active { hold, name, key, bound, unit: variable.unit, gain: 0.01 * multiplier.abs(), places: 1 });
        }
    }
    let most = found.iter().map(|a| a.gain).fold(0.0, f64::max);
    found.retain(|a| a.gain > IDLE * most);
    found.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    found
}

/// Whether two designs lie in the same basin.
fn near(evaluator: &dyn Evaluator, a: &[f64], b: &[f64]) -> bool {
    evaluator.variables().iter().zip(a.iter().zip(b)).fold(0.0_f64, |m, (v, (a, b))| m.max((a - b).abs() / v.scale())) <= SAME
}

/// Groups runs by where they ended.
fn basins<R: std::borrow::Borrow<Run>>(evaluator: &dyn Evaluator, runs: &[R], mut feasible: Vec<usize>) -> Vec<Basin> {
    let run = |index: usize| -> &Run { runs[index].borrow() };
    feasible.sort_by(|a, b| run(*a).goal.total_cmp(&run(*b).goal).then(a.cmp(b)));
    let mut basins: Vec<Basin> = Vec::new();
    for index in feasible {
        match basins.iter_mut().find(|b| near(evaluator, &run(b.best).x, &run(index).x)) {
            Some(basin) => basin.members.push(index),
            None => basins.push(Basin { best: index, members: vec![index] }),
        }
    }
    basins
}

impl Task {
    /// The goal at a design, in its own unit: what [`Run::goal`] is at the end of a run. `None` if it has no values.
    pub fn goal_at(&self, x: &[f64]) -> Option<f64> {
        Some(Posing::new(self, self.steps.last()?, x, &Reserve::default())?.standing()?.0)
    }
}

#[cfg(test)]
mod tests;
