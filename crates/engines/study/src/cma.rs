//! Search of a whole range without derivatives: for landscapes that are rough or have many basins.
//!
//! CMA-ES: N. Hansen, "The CMA evolution strategy: a tutorial", arXiv:1604.00772 (`hansen2016`), with weighted recombination, negative weights
//! of the worse half, updates of rank one and μ, and cumulation of the step size; restarts with populations large and small, BIPOP: N. Hansen,
//! "Benchmarking a BI-population CMA-ES on the BBOB-2009 function testbed", GECCO 2009 companion (`hansen2009`), after A. Auger, N. Hansen,
//! "A restart CMA evolution strategy with increasing population size", CEC 2005 (`auger2005`).
//!
//! - *Ranges* are the image of all numbers: nothing is drawn outside of them, and an end is met exactly.
//! - *Limits* come first (`deb2000`): a point that keeps all of them is better than one that does not, of two that do not that of the smaller
//!   sum of misses. The distribution becomes thin across a limit and goes on along it: an optimum at a limit, or in a corner of several,
//!   is approached as one inside. An augmented Lagrangian (A. Atamna, A. Auger, N. Hansen, FOGA 2017) in its
//!   place found fewer of the optima of the tests, to fewer digits.
//! - *Points without values* are worse than all others.
//! - *Only the order counts* for what is drawn and how the distribution adapts: any increasing function of the goal leads the same way. Where
//!   it stops does not: tolerances of the goal and of gains are relative differences, which such a function changes.
//!
//! Random numbers are drawn by one thread, points are computed by many: the same seed gives the same bits for any number of threads.
//!
//! ```
//! use forcewright_base::maths::cos;
//! use forcewright_study::cma::{Assessment, Problem, Settings, minimise};
//!
//! /// L. A. Rastrigin's function of two variables: 121 minima, the least of them 0 at the origin.
//! struct Eggs;
//!
//! impl Problem for Eggs {
//!     fn lower(&self) -> &[f64] {
//!         &[-5.12, -5.12]
//!     }
//!     fn upper(&self) -> &[f64] {
//!         &[5.12, 5.12]
//!     }
//!     fn assess(&self, x: &[f64]) -> Option<Assessment> {
//!         let one = |x: &f64| x * x - 10.0 * cos(2.0 * std::f64::consts::PI * x) + 10.0;
//!         Some(Assessment { goal: x.iter().map(one).sum(), misses: Vec::new() })
//!     }
//! }
//!
//! let found = minimise(&Eggs, &[4.0, -3.0], &Settings::default(), &|_| true)?;
//! assert!(found.best.is_some_and(|best| best.goal < 1e-8));
//! # Ok::<(), forcewright_study::cma::CmaError>(())
//! ```

mod bounds;
mod strategy;

use std::cmp::Ordering;
use std::fmt;

use forcewright_base::maths::powf;
use rayon::prelude::*;

use crate::random::Random;
use bounds::Boxed;
use strategy::{Draw, Strategy, Worn, usual_population};

/// Draws until a start has values, and generations without any in a row.
const TRIES: usize = 100;
const MOST_EMPTY: usize = 10;
/// A distribution that has become so much longer diverges, or its first step was far too small: `hansen2016`, appendix B.3.
const LONGER: f64 = 1e4;
/// Points of a generation at most, before their number doubles: more than any budget has room for.
const MOST_POINTS: usize = 1 << 20;
/// Least small step, `hansen2009`: 0.01 of the first.
const SMALL_STEP: f64 = -2.0;
/// Times that the population doubles at most: more than any budget has room for.
const MOST_DOUBLINGS: usize = 20;

/// Why a problem cannot be searched.
#[derive(Clone, Debug, PartialEq)]
pub enum CmaError {
    /// Lower ends, upper ends and start have different numbers of values.
    Shape {
        /// Lower ends.
        lower: usize,
        /// Upper ends.
        upper: usize,
        /// Values of the start.
        start: usize,
    },
    /// A range is empty, or an end of it is no number, or on its wrong side of all numbers.
    Range {
        /// Which variable.
        variable: usize,
        /// Its lower end.
        lower: f64,
        /// Its upper end.
        upper: f64,
    },
    /// The start of a variable is no finite number.
    Start {
        /// Which variable.
        variable: usize,
        /// Its value.
        value: f64,
    },
    /// The population is too large.
    Population {
        /// The number asked for.
        points: usize,
    },
    /// The first step is no finite number above 0.
    Step {
        /// The step.
        step: f64,
    },
}

impl fmt::Display for CmaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape { lower, upper, start } => {
                write!(f, "{lower} lower ends, {upper} upper ends and a start of {start} values do not go together")
            }
            Self::Range { variable, lower, upper } => write!(f, "the range of variable {variable} from {lower} to {upper} is empty"),
            Self::Start { variable, value } => write!(f, "variable {variable} starts at {value}"),
            Self::Population { points } => write!(f, "a generation of {points} points is too large; it has at most {MOST_POINTS}"),
            Self::Step { step } => write!(f, "the first step is {step}, and must be finite and above 0"),
        }
    }
}

impl std::error::Error for CmaError {}

/// A goal and by how much limits are missed.
#[derive(Clone, Debug, PartialEq)]
pub struct Assessment {
    /// Small where it is good.
    pub goal: f64,
    /// One per limit, relative to what is a large miss of it; 0 or less where it is kept.
    pub misses: Vec<f64>,
}

/// What is searched. A pure function of a point.
pub trait Problem: Sync {
    /// Smallest value of each variable; −∞ without one.
    fn lower(&self) -> &[f64];

    /// Largest values; ∞ without one. One that is equal to the smallest is fixed.
    fn upper(&self) -> &[f64];

    /// The goal at a point and by how much limits are missed; `None` where there are no values. What is no number is taken
    /// for none.
    fn assess(&self, x: &[f64]) -> Option<Assessment>;
}

/// What a search is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Points computed at most; the start is always.
    pub evaluations: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// First standard deviation, as part of the ranges; of a variable without two ends, of its value at the start. Default 0.3.
    pub step: f64,
    /// Points of the first generations, at most 2²⁰; 0 or 1: 4 + 3 ln n. Restarts have more of them, or fewer.
    pub population: usize,
    /// Restarts with a population twice as large as the one before; those with smaller ones in between are not counted.
    pub restarts: usize,
    /// The search ends after so many restarts in a row that found nothing better by `least_gain`, relative to the goal; 0: it does not.
    pub patience: usize,
    /// Relative.
    pub least_gain: f64,
    /// A restart ends where the goals of its last generations differ by less than this part of them …
    pub goal_tolerance: f64,
    /// … or its standard deviations are less than this part of the ranges.
    pub step_tolerance: f64,
    /// A limit is kept if it is missed by no more.
    pub kept: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            evaluations: 100_000,
            seed: 1,
            step: 0.3,
            population: 0,
            restarts: 9,
            patience: 0,
            least_gain: 1e-4,
            goal_tolerance: 1e-12,
            step_tolerance: 1e-12,
            kept: 0.0,
        }
    }
}

/// A point with what is known of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The variables.
    pub x: Vec<f64>,
    /// The goal.
    pub goal: f64,
    /// The sum of the misses of limits; those that count as kept add nothing.
    pub excess: f64,
    /// The largest miss of a limit; 0 if none is missed at all.
    pub violation: f64,
}

impl Point {
    /// The better of two by feasibility first: of two that keep all limits the better goal, of two that do not the smaller sum of misses.
    pub fn compare(&self, other: &Self) -> Ordering {
        self.standing().compare(&other.standing())
    }

    fn standing(&self) -> Standing {
        Standing { excess: self.excess, goal: self.goal }
    }
}

/// What points are compared by.
#[derive(Clone, Copy, Debug)]
struct Standing {
    excess: f64,
    goal: f64,
}

impl Standing {
    /// Of a point without values.
    const NONE: Self = Self { excess: f64::INFINITY, goal: f64::INFINITY };

    fn compare(&self, other: &Self) -> Ordering {
        // Beyond the limits the goal counts between equals, so that designs far from all of them have an order.
        self.excess.total_cmp(&other.excess).then(self.goal.total_cmp(&other.goal))
    }

    /// By how much it is worse than another, relative to either, in what decides between them.
    fn worse_by(&self, other: &Self) -> f64 {
        let part = |a: f64, b: f64| if a.to_bits() == b.to_bits() { 0.0 } else { (a - b) / a.abs().max(b.abs()) };
        let by = part(self.excess, other.excess);
        if by.abs() > 0.0 { by } else { part(self.goal, other.goal) }
    }
}

/// How one of the runs ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The goals of the last generations are equal to the tolerance.
    Goal,
    /// The steps have become shorter than the tolerance.
    Step,
    /// Steps are lost in rounding, or the distribution is as long and thin as numbers can tell.
    Rounding,
    /// Goals have not become better for long.
    Stagnation,
    /// Steps became longer and longer.
    Divergence,
    /// After its part of the points, or all of them.
    Evaluations,
    /// No point of many generations, or no start, has values.
    Nothing,
    /// It was told to.
    Interrupted,
}

/// One of the runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Points of a generation.
    pub population: usize,
    /// Generations.
    pub generations: usize,
    /// Points computed.
    pub evaluations: u64,
    /// How it ended.
    pub stop: Stop,
    /// The best point of it, if any has values.
    pub best: Option<Point>,
}

/// Where a search stands, after a generation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress<'a> {
    /// The run, from 0.
    pub run: usize,
    /// Its generation, from 0.
    pub generation: usize,
    /// Points computed so far.
    pub evaluations: u64,
    /// The middle of the distribution.
    pub mean: &'a [f64],
    /// The best point so far.
    pub best: Option<&'a Point>,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The best point, if any has values.
    pub best: Option<Point>,
    /// All runs: the first from the start, then restarts.
    pub runs: Vec<Run>,
    /// Points computed, those without values too.
    pub evaluations: u64,
    /// Points without values.
    pub failed: u64,
    /// Whether it was interrupted.
    pub interrupted: bool,
}

/// Searches the whole range, the first time from a start, which has a value for each variable; what lies outside of its range is taken at
/// its end. `watch` sees every generation, and ends the search by returning `false`.
///
/// # Errors
/// [`CmaError`] if ranges and start do not go together, a range is empty or an end of it no number, the start is not finite, the population
/// is too large, or the first step is not finite and above 0.
pub fn minimise(problem: &dyn Problem, start: &[f64], settings: &Settings, watch: &dyn Fn(&Progress) -> bool) -> Result<Found, CmaError> {
    check(problem.lower(), problem.upper(), start, settings)?;
    let variables = Boxed::new(problem.lower(), problem.upper(), start);
    let found = Found { best: None, runs: Vec::new(), evaluations: 0, failed: 0, interrupted: false };
    let mut search = Search { problem, settings, watch, variables, random: Random::new(settings.seed), found };
    search.all(start);
    Ok(search.found)
}

/// Whether a search makes sense.
fn check(lower: &[f64], upper: &[f64], start: &[f64], settings: &Settings) -> Result<(), CmaError> {
    if lower.len() != upper.len() || lower.len() != start.len() {
        return Err(CmaError::Shape { lower: lower.len(), upper: upper.len(), start: start.len() });
    }
    for (variable, ((lower, upper), value)) in lower.iter().zip(upper).zip(start).enumerate() {
        let (lower, upper, value) = (*lower, *upper, *value);
        // Neither end may be the other infinity: between them there is no number.
        let some = lower <= upper && lower < f64::INFINITY && upper > f64::NEG_INFINITY;
        if !some {
            return Err(CmaError::Range { variable, lower, upper });
        }
        if !value.is_finite() {
            return Err(CmaError::Start { variable, value });
        }
    }
    if settings.population > MOST_POINTS {
        return Err(CmaError::Population { points: settings.population });
    }
    if !(settings.step.is_finite() && settings.step > 0.0) {
        return Err(CmaError::Step { step: settings.step });
    }
    Ok(())
}

/// The size of a run.
struct Launch {
    population: usize,
    step: f64,
    /// Points that it may compute.
    evaluations: u64,
}

struct Search<'a> {
    problem: &'a dyn Problem,
    settings: &'a Settings,
    watch: &'a dyn Fn(&Progress) -> bool,
    variables: Boxed,
    random: Random,
    found: Found,
}

impl Search<'_> {
    /// All runs: two regimes that have used as many points each, `hansen2009`.
    fn all(&mut self, start: &[f64]) {
        let n = self.variables.len();
        let usual = if self.settings.population > 1 { self.settings.population } else { usual_population(n) };
        let (mut doublings, mut spent, mut vain) = (0, [0_u64; 2], 0);
        for restart in 0.. {
            let left = self.settings.evaluations.saturating_sub(self.found.evaluations);
            let small = doublings > 0 && spent[1] < spent[0];
            let mut launch = Launch { population: usual, step: self.settings.step, evaluations: left };
            if small {
                let (part, shorter) = (self.random.unit(), self.random.unit());
                let largest = (1_usize << doublings) as f64;
                let factor = powf(0.5 * largest, part * part).max(1.0);
                launch.population = Self::rounded(factor * usual as f64);
                launch.step *= powf(10.0, SMALL_STEP * shorter);
                launch.evaluations = left.min(spent[0].div_ceil(2));
            } else if restart > 0 {
                if doublings >= self.settings.restarts.min(MOST_DOUBLINGS) {
                    break;
                }
                doublings += 1;
                launch.population = usual << doublings;
            }
            let before = self.found.best.clone();
            let run = self.run(restart, if restart == 0 { Some(start) } else { None }, &launch);
            spent[usize::from(small)] += run.evaluations;
            let stop = run.stop;
            self.found.runs.push(run);
            vain = if self.better(before.as_ref()) { 0 } else { vain + 1 };
            let over = self.found.interrupted || n == 0 || self.found.evaluations >= self.settings.evaluations;
            let whole = stop == Stop::Evaluations && launch.evaluations == left;
            if over || whole || self.settings.patience > 0 && vain >= self.settings.patience {
                break;
            }
        }
    }

    /// A population, at least the smallest that has an order.
    fn rounded(population: f64) -> usize {
        (2_usize..=1 << 30).take_while(|p| *p as f64 <= population).last().unwrap_or(2)
    }

    /// Whether the best is better than one before by what counts.
    fn better(&self, before: Option<&Point>) -> bool {
        let gain = |now: &Point| before.is_none_or(|b| b.standing().worse_by(&now.standing()) > self.settings.least_gain);
        self.found.best.as_ref().is_some_and(gain)
    }

    /// Computes points: those with values, in their order.
    fn computed(&mut self, points: &[Vec<f64>]) -> Vec<Option<Point>> {
        let (problem, variables, kept) = (self.problem, &self.variables, self.settings.kept);
        let one = |y: &Vec<f64>| {
            let x = variables.values(y);
            let Assessment { goal, misses } = problem.assess(&x)?;
            let excess = misses.iter().filter(|m| m.is_nan() || **m > kept).fold(0.0, |sum, m| sum + m);
            let violation = misses.iter().fold(0.0_f64, |m, g| m.max(*g));
            (goal.is_finite() && excess.is_finite()).then_some(Point { x, goal, excess, violation })
        };
        let all: Vec<_> = points.par_iter().map(one).collect();
        self.found.evaluations += all.len() as u64;
        self.found.failed += all.iter().filter(|found| found.is_none()).count() as u64;
        all
    }

    /// Takes points into account for the best of a run and of all.
    fn keep(&mut self, best: &mut Option<Point>, all: &[Option<Point>]) {
        for point in all.iter().flatten() {
            for best in [&mut *best, &mut self.found.best] {
                if best.as_ref().is_none_or(|b| point.compare(b).is_lt()) {
                    *best = Some(point.clone());
                }
            }
        }
    }

    /// A start with values: that given, else one drawn.
    fn begin(&mut self, start: Option<&[f64]>, run: &mut Run) -> Option<Vec<f64>> {
        for attempt in 0..TRIES {
            let x = if let Some(start) = start.filter(|_| attempt == 0) {
                start.to_vec()
            } else {
                let random = &mut self.random;
                self.variables.spread(|| random.unit())
            };
            let y = self.variables.point(&x);
            let all = self.computed(std::slice::from_ref(&y));
            run.evaluations += 1;
            self.keep(&mut run.best, &all);
            if all.iter().any(Option::is_some) {
                return Some(y);
            }
            if self.found.evaluations >= self.settings.evaluations || self.variables.len() == 0 {
                break;
            }
        }
        None
    }

    fn run(&mut self, number: usize, start: Option<&[f64]>, launch: &Launch) -> Run {
        let mut run = Run { population: launch.population, generations: 0, evaluations: 0, stop: Stop::Nothing, best: None };
        let Some(mean) = self.begin(start, &mut run) else { return run };
        if mean.is_empty() {
            run.stop = Stop::Step;
            return run;
        }
        let mut trend = Trend::new(mean.len(), launch.population);
        let mut strategy = Strategy::new(mean, launch.step, launch.population);
        let batch = launch.population as u64;
        run.stop = loop {
            if run.evaluations + batch > launch.evaluations {
                break Stop::Evaluations;
            }
            let draws = strategy.draws(&mut self.random);
            let places: Vec<Vec<f64>> = draws.iter().map(|d| strategy.place(d)).collect();
            let all = self.computed(&places);
            run.evaluations += batch;
            self.keep(&mut run.best, &all);
            let progress = Progress {
                run: number,
                generation: run.generations,
                evaluations: self.found.evaluations,
                mean: &self.variables.values(&strategy.mean),
                best: self.found.best.as_ref(),
            };
            run.generations += 1;
            if !(self.watch)(&progress) {
                self.found.interrupted = true;
                break Stop::Interrupted;
            }
            let standings: Vec<Standing> = all.iter().map(|p| p.as_ref().map_or(Standing::NONE, Point::standing)).collect();
            if let Some(stop) = self.after(&mut strategy, &mut trend, (&draws, &standings), launch) {
                break stop;
            }
        };
        run
    }

    /// Lets the distribution learn from a generation; how the run ends, if it does.
    fn after(&self, strategy: &mut Strategy, trend: &mut Trend, (draws, all): (&[Draw], &[Standing]), launch: &Launch) -> Option<Stop> {
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|a, b| all[*a].compare(&all[*b]));
        let of_rank = |rank: usize| all[order[rank.min(order.len() - 1)]];
        let best = of_rank(0);
        if !best.excess.is_finite() {
            // At the edge of what has values a small generation may miss them by chance.
            trend.empty += 1;
            return (trend.empty >= MOST_EMPTY).then_some(Stop::Nothing);
        }
        trend.empty = 0;
        let ranked: Vec<&Draw> = order.iter().map(|i| &draws[*i]).collect();
        strategy.learn(&ranked);
        if of_rank(all.len() / 4 + 1).compare(&best).is_eq() {
            strategy.widen();
        }
        trend.add(best, of_rank(all.len() / 2), of_rank(all.len()));
        let settings = self.settings;
        match strategy.worn() {
            Some(Worn::Broken) => Some(Stop::Divergence),
            Some(Worn::NoEffect | Worn::Condition) => Some(Stop::Rounding),
            // Where all goals are equal, steps become longer in search of others.
            None if strategy.longest() > LONGER * launch.step => {
                Some(if trend.all_equal(settings.goal_tolerance) { Stop::Goal } else { Stop::Divergence })
            }
            None if strategy.widest() < settings.step_tolerance => Some(Stop::Step),
            None if trend.level(settings.goal_tolerance) => Some(Stop::Goal),
            None => trend.stagnant().then_some(Stop::Stagnation),
        }
    }
}

/// Values of the generations of a run: `hansen2016`, appendix B.3.
struct Trend {
    n: usize,
    population: usize,
    best: Vec<Standing>,
    middle: Vec<Standing>,
    /// The worst of the last generation.
    worst: Standing,
    /// Generations without values in a row.
    empty: usize,
}

impl Trend {
    fn new(n: usize, population: usize) -> Self {
        Self { n, population, best: Vec::new(), middle: Vec::new(), worst: Standing::NONE, empty: 0 }
    }

    fn add(&mut self, best: Standing, middle: Standing, worst: Standing) {
        self.best.push(best);
        self.middle.push(middle);
        self.worst = worst;
    }

    /// Whether the best of the last generations, and all of the last, are equal to a tolerance. Where some of the last miss a limit and the best
    /// do not, as at every optimum on a limit, the best decide.
    fn level(&self, tolerance: f64) -> bool {
        self.equal(10 + (30 * self.n).div_ceil(self.population), tolerance)
    }

    /// The same of all generations.
    fn all_equal(&self, tolerance: f64) -> bool {
        self.equal(self.best.len(), tolerance)
    }

    fn equal(&self, count: usize, tolerance: f64) -> bool {
        let Some(last) = self.best.len().checked_sub(count).map(|from| &self.best[from..]) else { return false };
        let Some(first) = last.first() else { return false };
        let also = if self.worst.excess > 0.0 && first.excess <= 0.0 { first } else { &self.worst };
        let (low, high) = last
            .iter()
            .fold((also, also), |(l, h), v| (if v.compare(l).is_lt() { v } else { l }, if v.compare(h).is_gt() { v } else { h }));
        high.worse_by(low) <= tolerance
    }

    /// Whether neither the best nor the middle values of the last part of a long history are better than those of the part before it.
    fn stagnant(&self) -> bool {
        let least = 120 + 30 * self.n / self.population;
        let long = (self.best.len() / 5).clamp(least, 20_000);
        if self.best.len() < long {
            return false;
        }
        let no_better = |values: &[Standing]| {
            let own = &values[values.len() - long..];
            let part = (long * 3 / 10).max(1);
            median(&own[long - part..]).compare(&median(&own[..part])).is_ge()
        };
        no_better(&self.best) && no_better(&self.middle)
    }
}

/// The lower of the middle ones: what only the order decides.
fn median(values: &[Standing]) -> Standing {
    let mut all = values.to_vec();
    all.sort_by(Standing::compare);
    all.get((all.len().max(1) - 1) / 2).copied().unwrap_or(Standing::NONE)
}
