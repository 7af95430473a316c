//! Several goals at once: the designs of which none is better in everything, for numbers, whole numbers and choices.
//!
//! NSGA-II: K. Deb, A. Pratap, S. Agarwal, T. Meyarivan, "A fast and elitist multiobjective genetic algorithm: NSGA-II", IEEE Transactions
//! on Evolutionary Computation 6(2) (2002) 182–197. Beside its population, all designs found that keep every limit and that none dominates
//! are kept in an archive, which is thinned where it is crowded. No design is computed twice.
//!
//! Random numbers are drawn by one thread, designs are computed by many: the same seed gives the same bits for any number of threads.
//!
//! ```
//! use forcewright_study::pareto::{Assessment, Kind, Problem, Settings, Unassessed, search};
//!
//! /// J. D. Schaffer, 1985: x² and (x − 2)², of which every x between 0 and 2 is a compromise.
//! struct Schaffer(Vec<Kind>);
//!
//! impl Problem for Schaffer {
//!     fn variables(&self) -> &[Kind] {
//!         &self.0
//!     }
//!     fn goals(&self) -> usize {
//!         2
//!     }
//!     fn assess(&self, x: &[f64]) -> Result<Assessment, Unassessed> {
//!         Ok(Assessment { objectives: vec![x[0] * x[0], (x[0] - 2.0) * (x[0] - 2.0)], violations: Vec::new() })
//!     }
//! }
//!
//! let problem = Schaffer(vec![Kind::Real { lower: -100.0, upper: 100.0 }]);
//! let found = search(&problem, &Settings { population: 40, ..Settings::default() }, &[], &|_| true)?;
//! assert!(found.front.len() > 50 && found.front.iter().all(|m| (-1e-2..=2.01).contains(&m.x[0])));
//! # Ok::<(), forcewright_study::pareto::Malformed>(())
//! ```

mod rank;
mod vary;
mod volume;

pub use volume::hypervolume;

use std::collections::BTreeSet;
use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use rayon::prelude::*;

use crate::random::Random;
use crate::sampling::Sobol;

/// Tries to make a child that was not computed before, per child wanted.
const TRIES: usize = 50;
/// Reference point of the hypervolume: this part of the width of the front beyond its worst values.
const BEYOND: f64 = 0.1;
/// Most goals: hypervolume and crowding say little of more.
const MOST_GOALS: usize = 8;

/// What values a variable has. All are handed on as doubles: a whole number as itself, a choice by its place, from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// Any number of a range.
    Real {
        /// Smallest.
        lower: f64,
        /// Largest.
        upper: f64,
    },
    /// Whole numbers, both ends included.
    Whole {
        /// Smallest.
        lower: i64,
        /// Largest.
        upper: i64,
    },
    /// One of some things without an order.
    Choice {
        /// How many there are.
        count: usize,
    },
}

/// What is known of a design.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assessment {
    /// The goals, each small where it is good.
    pub objectives: Vec<f64>,
    /// By how much each limit is missed, relative to what is a large miss of it; 0 or less where it is kept.
    pub violations: Vec<f64>,
}

/// Why nothing is known of a design.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unassessed {
    /// It cannot be built or computed, in words.
    Failed(String),
    /// It was told to stop.
    Interrupted,
}

/// What is searched. A pure function of the numbers of a design.
pub trait Problem: Sync {
    /// The variables, in the order of every `x`.
    fn variables(&self) -> &[Kind];

    /// How many goals there are.
    fn goals(&self) -> usize;

    /// Computes a design; whole numbers and choices in `x` are exact.
    ///
    /// # Errors
    /// [`Unassessed`] where there are no values; the search goes on with other designs, or ends.
    fn assess(&self, x: &[f64]) -> Result<Assessment, Unassessed>;
}

/// What a search is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Designs of a generation; an even number, at least 4.
    pub population: usize,
    /// Generations after the first.
    pub generations: usize,
    /// Designs computed at most.
    pub evaluations: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Most designs of the front, at least 4.
    pub capacity: usize,
    /// The search ends if the hypervolume of the front has grown by less than `least_gain` in so many generations; 0: it does not.
    pub patience: usize,
    /// Relative.
    pub least_gain: f64,
    /// Probability with which two parents are crossed, 0 to 1.
    pub crossover: f64,
    /// Distribution index of the crossover, 0 or more: large ones keep children near to their parents.
    pub crossover_index: f64,
    /// The same of the mutation.
    pub mutation_index: f64,
}

impl Default for Settings {
    /// Operators as in section IV B of Deb et al. 2002.
    fn default() -> Self {
        Self {
            population: 60,
            generations: 100,
            evaluations: u64::MAX,
            seed: 1,
            capacity: 100,
            patience: 0,
            least_gain: 1e-4,
            crossover: 0.9,
            crossover_index: 20.0,
            mutation_index: 20.0,
        }
    }
}

/// Why there is no search.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Malformed {
    /// No variable, or one without values or with ends that are no numbers, by its index.
    Variable(usize),
    /// No goal, or more than eight.
    Goals(usize),
    /// A setting beyond its range, by its name.
    Setting(&'static str),
    /// A first design without a value for each variable, by its index.
    Start(usize),
}

impl fmt::Display for Malformed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Variable(index) => write!(f, "variable {index} has no values"),
            Self::Goals(count) => write!(f, "{count} goals; there may be 1 to {MOST_GOALS}"),
            Self::Setting(name) => write!(f, "`{name}` is beyond its range"),
            Self::Start(index) => write!(f, "first design {index} does not have a value for each variable"),
        }
    }
}

impl std::error::Error for Malformed {}

/// A design with its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// The design.
    pub x: Vec<f64>,
    /// Its goals; empty if it has no values.
    pub objectives: Vec<f64>,
    /// Sum of what limits are missed by; 0 if all are kept, ∞ if the design has no values.
    pub violation: f64,
}

impl Member {
    /// Whether it keeps all limits.
    pub fn feasible(&self) -> bool {
        self.violation <= 0.0
    }
}

/// Where a search stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The generation, from 0.
    pub generation: usize,
    /// Designs computed so far, with this one.
    pub evaluations: u64,
    /// Designs of the front before this generation.
    pub front: usize,
}

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// After its generations.
    Generations,
    /// After its evaluations.
    Evaluations,
    /// The front did not grow any more.
    Settled,
    /// No design was found that had not been computed: most often, all there are.
    Exhausted,
    /// It was told to.
    Interrupted,
}

/// State of a search after a generation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Generation {
    /// Designs computed so far.
    pub evaluations: u64,
    /// Designs of the front.
    pub front: usize,
    /// Growth of its hypervolume since `patience` generations before, relative; not a number before that.
    pub gain: f64,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Front {
    /// Designs that keep all limits and that none found dominates, in the order of their goals.
    pub front: Vec<Member>,
    /// Where nothing keeps all limits: the design that misses them least, if any has values.
    pub nearest: Option<Member>,
    /// Designs computed.
    pub evaluations: u64,
    /// Of these, those that keep all limits.
    pub feasible: u64,
    /// Of these, those without values.
    pub failed: u64,
    /// Why some of them have none: reasons with how often each was given, the most frequent first.
    pub reasons: Vec<(String, u64)>,
    /// State after each generation.
    pub history: Vec<Generation>,
    /// How it ended.
    pub stop: Stop,
    /// Whether the front had more designs than it may have, and was thinned.
    pub thinned: bool,
}

/// Most reasons that are kept.
const MOST_REASONS: usize = 64;

/// Searches for the front. The first generation has the designs `starts` (values beyond a range are taken at its end) and points spread
/// over the ranges by a scrambled Sobol sequence. `watch` sees every design computed, from any thread, and ends the search by returning
/// `false`: the front so far is kept.
///
/// # Errors
/// [`Malformed`] for a problem without variables or goals, or settings beyond their ranges.
pub fn search(
    problem: &dyn Problem,
    settings: &Settings,
    starts: &[Vec<f64>],
    watch: &(dyn Fn(&Progress) -> bool + Sync),
) -> Result<Front, Malformed> {
    check(problem, settings, starts)?;
    let mut run = Run::new(problem, settings, watch);
    let first = run.first(starts);
    let mut population = run.computed(first, 0);
    let stop = loop {
        let generation = run.history.len();
        run.note();
        if run.stopped.load(Ordering::Relaxed) {
            break Stop::Interrupted;
        }
        if generation >= settings.generations {
            break Stop::Generations;
        }
        if run.evaluations.load(Ordering::Relaxed) >= settings.evaluations {
            break Stop::Evaluations;
        }
        if settings.patience > 0 && run.history.last().is_some_and(|h| h.gain < settings.least_gain) {
            break Stop::Settled;
        }
        population = run.survivors(population);
        let children = run.offspring(&population);
        if children.is_empty() {
            break Stop::Exhausted;
        }
        population.extend(run.computed(children, generation + 1));
    };
    Ok(run.front(stop))
}

fn check(problem: &dyn Problem, settings: &Settings, starts: &[Vec<f64>]) -> Result<(), Malformed> {
    let variables = problem.variables();
    let sound = |kind: &Kind| match kind {
        Kind::Real { lower, upper } => lower <= upper && (upper - lower).is_finite(),
        // Beyond 2⁵³ whole numbers are no doubles.
        Kind::Whole { lower, upper } => lower <= upper && lower.unsigned_abs().max(upper.unsigned_abs()) < 1 << 53,
        Kind::Choice { count } => *count > 0,
    };
    if let Some(wrong) = variables.iter().position(|kind| !sound(kind)).or(variables.is_empty().then_some(0)) {
        return Err(Malformed::Variable(wrong));
    }
    if !(1..=MOST_GOALS).contains(&problem.goals()) {
        return Err(Malformed::Goals(problem.goals()));
    }
    let index = |v: f64| (0.0..=1e3).contains(&v);
    let settings_kept = [
        ("population", settings.population >= 4 && settings.population.is_multiple_of(2)),
        ("capacity", settings.capacity >= 4),
        ("least_gain", settings.least_gain >= 0.0),
        ("crossover", (0.0..=1.0).contains(&settings.crossover)),
        ("crossover_index", index(settings.crossover_index)),
        ("mutation_index", index(settings.mutation_index)),
    ];
    if let Some((name, _)) = settings_kept.iter().find(|(_, kept)| !kept) {
        return Err(Malformed::Setting(name));
    }
    match starts.iter().position(|x| x.len() != variables.len() || !x.iter().all(|v| v.is_finite())) {
        Some(wrong) => Err(Malformed::Start(wrong)),
        None => Ok(()),
    }
}

/// A search on the way.
struct Run<'a> {
    problem: &'a dyn Problem,
    settings: &'a Settings,
    watch: &'a (dyn Fn(&Progress) -> bool + Sync),
    random: Random,
    stopped: AtomicBool,
    evaluations: AtomicU64,
    /// Bits of every design computed.
    seen: BTreeSet<Vec<u64>>,
    archive: Vec<Member>,
    nearest: Option<Member>,
    feasible: u64,
    failed: u64,
    reasons: Vec<(String, u64)>,
    history: Vec<Generation>,
    /// Goals of the archive after each of the last generations.
    before: Vec<Vec<Vec<f64>>>,
    thinned: bool,
}

fn bits(x: &[f64]) -> Vec<u64> {
    // Zero has two signs.
    x.iter().map(|v| (v + 0.0).to_bits()).collect()
}

impl<'a> Run<'a> {
    fn new(problem: &'a dyn Problem, settings: &'a Settings, watch: &'a (dyn Fn(&Progress) -> bool + Sync)) -> Self {
        Self {
            problem,
            settings,
            watch,
            random: Random::new(settings.seed),
            stopped: AtomicBool::new(false),
            evaluations: AtomicU64::new(0),
            seen: BTreeSet::new(),
            archive: Vec::new(),
            nearest: None,
            feasible: 0,
            failed: 0,
            reasons: Vec::new(),
            history: Vec::new(),
            before: Vec::new(),
            thinned: false,
        }
    }

    /// The designs of the first generation, each once.
    fn first(&mut self, starts: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let kinds = self.problem.variables();
        let mut designs = Vec::new();
        for start in starts {
            let x: Vec<f64> = kinds.iter().zip(start).map(|(kind, v)| kind.rounded(*v)).collect();
            self.add(x, &mut designs);
        }
        let sobol = Sobol::scrambled(kinds.len(), self.settings.seed).ok();
        let mut point = vec![0.0; kinds.len()];
        for index in 0..(self.settings.population * TRIES) as u64 {
            if designs.len() >= self.settings.population {
                break;
            }
            match &sobol {
                Some(sobol) => sobol.point(index, &mut point),
                None => point.fill_with(|| self.random.unit()),
            }
            self.add(vary::placed(kinds, &point), &mut designs);
        }
        designs
    }

    /// Adds a design that was not computed yet, while there may be more of them; whether it did.
    fn add(&mut self, x: Vec<f64>, designs: &mut Vec<Vec<f64>>) -> bool {
        let room = self.evaluations.load(Ordering::Relaxed) + (designs.len() as u64) < self.settings.evaluations;
        let new = room && self.seen.insert(bits(&x));
        if new {
            designs.push(x);
        }
        new
    }

    /// Computes designs, keeps what belongs to the front, and gives those that were computed, in their order.
    fn computed(&mut self, designs: Vec<Vec<f64>>, generation: usize) -> Vec<Member> {
        let (problem, front) = (self.problem, self.archive.len());
        let compute = |x: Vec<f64>| {
            if self.stopped.load(Ordering::Relaxed) {
                return (x, Err(Unassessed::Interrupted));
            }
            let found = problem.assess(&x);
            if found == Err(Unassessed::Interrupted) {
                self.stopped.store(true, Ordering::Relaxed);
                return (x, found);
            }
            let evaluations = self.evaluations.fetch_add(1, Ordering::Relaxed) + 1;
            if !(self.watch)(&Progress { generation, evaluations, front }) {
                self.stopped.store(true, Ordering::Relaxed);
            }
            (x, found)
        };
        let found: Vec<_> = designs.into_par_iter().map(compute).collect();
        let members: Vec<Member> = found.into_iter().filter_map(|(x, found)| self.judged(x, found)).collect();
        self.keep(&members);
        members
    }

    /// A design with its values; `None` if it was not computed.
    fn judged(&mut self, x: Vec<f64>, found: Result<Assessment, Unassessed>) -> Option<Member> {
        let goals = self.problem.goals();
        let sound = |a: &Assessment| {
            let numbers = a.objectives.iter().all(|v| v.is_finite()) && !a.violations.iter().any(|v| v.is_nan());
            a.objectives.len() == goals && numbers
        };
        let found = match found {
            Ok(found) if sound(&found) => Ok(found),
            Ok(_) => Err("a goal or a limit is not a number".to_owned()),
            Err(Unassessed::Failed(reason)) => Err(reason),
            Err(Unassessed::Interrupted) => return None,
        };
        match found {
            Ok(Assessment { objectives, violations }) => {
                let violation = violations.iter().map(|v| v.max(0.0)).sum::<f64>();
                self.feasible += u64::from(violation <= 0.0);
                Some(Member { x, objectives, violation })
            }
            Err(reason) => {
                self.failed += 1;
                match self.reasons.iter().position(|(known, _)| *known == reason) {
                    Some(known) => self.reasons[known].1 += 1,
                    None if self.reasons.len() < MOST_REASONS => self.reasons.push((reason, 1)),
                    None => {}
                }
                Some(Member { x, objectives: Vec::new(), violation: f64::INFINITY })
            }
        }
    }

    /// Takes new designs into the archive, and thins it one by one where it is crowded (S. Kukkonen, K. Deb, "Improved pruning of
    /// non-dominated solutions based on crowding distance for bi-objective optimization problems", IEEE Congress on Evolutionary Computation
    /// 2006: after each that is taken away, distances are computed anew).
    fn keep(&mut self, members: &[Member]) {
        for new in members {
            if !new.feasible() {
                let nearer = self.nearest.as_ref().is_none_or(|n| new.violation < n.violation);
                if nearer && new.violation.is_finite() {
                    self.nearest = Some(new.clone());
                }
                continue;
            }
            if !self.archive.iter().any(|old| rank::dominates(&old.objectives, &new.objectives)) {
                self.archive.retain(|old| !rank::dominates(&new.objectives, &old.objectives));
                self.archive.push(new.clone());
            }
        }
        self.archive.sort_by(rank::in_order);
        while self.archive.len() > self.settings.capacity {
            self.thinned = true;
            let crowded = most_crowded(&self.archive.iter().collect::<Vec<_>>());
            self.archive.remove(crowded);
        }
    }

    /// Notes where the search stands after a generation.
    fn note(&mut self) {
        let goals: Vec<Vec<f64>> = self.archive.iter().map(|m| m.objectives.clone()).collect();
        let patience = self.settings.patience.max(1);
        let gain = if self.before.len() < patience { f64::NAN } else { growth(&self.before[self.before.len() - patience], &goals) };
        self.before.push(goals);
        if self.before.len() > patience {
            self.before.remove(0);
        }
        let evaluations = self.evaluations.load(Ordering::Relaxed);
        self.history.push(Generation { evaluations, front: self.archive.len(), gain });
    }

    /// The best of parents and children, front by front, of the last one those in the emptiest places.
    fn survivors(&self, members: Vec<Member>) -> Vec<Member> {
        if members.len() <= self.settings.population {
            return members;
        }
        let ranked = ranked(&members);
        let mut order: Vec<usize> = (0..members.len()).collect();
        order.sort_by(|a, b| ranked[*a].0.cmp(&ranked[*b].0).then(ranked[*b].1.total_cmp(&ranked[*a].1)));
        let mut kept = vec![false; members.len()];
        order.iter().take(self.settings.population).for_each(|i| kept[*i] = true);
        members.into_iter().zip(kept).filter(|(_, kept)| *kept).map(|(m, _)| m).collect()
    }

    /// Children of pairs, each the better of two drawn, none computed before.
    fn offspring(&mut self, population: &[Member]) -> Vec<Vec<f64>> {
        let kinds = self.problem.variables();
        let ranked = ranked(population);
        let mut children = Vec::new();
        if population.is_empty() {
            return children;
        }
        for _ in 0..self.settings.population * TRIES {
            if children.len() >= self.settings.population {
                break;
            }
            let parents = [(); 2].map(|()| {
                let (a, b) = (self.random.below(population.len()), self.random.below(population.len()));
                let first = ranked[a].0 < ranked[b].0 || ranked[a].0 == ranked[b].0 && ranked[a].1 >= ranked[b].1;
                population[if first { a } else { b }].x.as_slice()
            });
            for child in vary::children(kinds, parents, self.settings, &mut self.random) {
                if children.len() < self.settings.population {
                    self.add(child, &mut children);
                }
            }
        }
        // Where choices are few, parents soon have no children but those known: others are drawn anywhere.
        for _ in 0..self.settings.population * TRIES {
            if children.len() >= self.settings.population {
                break;
            }
            let point: Vec<f64> = kinds.iter().map(|_| self.random.unit()).collect();
            self.add(vary::placed(kinds, &point), &mut children);
        }
        children
    }

    fn front(self, stop: Stop) -> Front {
        let mut reasons = self.reasons;
        reasons.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
        Front {
            nearest: if self.archive.is_empty() { self.nearest } else { None },
            front: self.archive,
            evaluations: self.evaluations.into_inner(),
            feasible: self.feasible,
            failed: self.failed,
            reasons,
            history: self.history,
            stop,
            thinned: self.thinned,
        }
    }
}

/// Some designs of a front, at most so many, spread over it as well as crowding tells: their places, in their order. The best of each goal
/// are among them if there is room.
pub fn spread(members: &[&Member], most: usize) -> Vec<usize> {
    let mut chosen: Vec<usize> = (0..members.len()).collect();
    while chosen.len() > most {
        let own: Vec<&Member> = chosen.iter().map(|i| members[*i]).collect();
        chosen.remove(most_crowded(&own));
    }
    chosen
}

/// The place of the most crowded design; the first of equals.
fn most_crowded(members: &[&Member]) -> usize {
    let distances = rank::crowding(members);
    (0..distances.len()).reduce(|a, b| if distances[b] < distances[a] { b } else { a }).unwrap_or(0)
}

/// Number of the front and crowding distance in it, of each design.
fn ranked(members: &[Member]) -> Vec<(usize, f64)> {
    let ranks = rank::fronts(members);
    let mut distances = vec![0.0; members.len()];
    for rank in 0..=ranks.iter().copied().max().unwrap_or(0) {
        let own: Vec<usize> = (0..members.len()).filter(|i| ranks[*i] == rank).collect();
        let found = rank::crowding(&own.iter().map(|i| &members[*i]).collect::<Vec<_>>());
        own.iter().zip(found).for_each(|(i, distance)| distances[*i] = distance);
    }
    ranks.into_iter().zip(distances).collect()
}

/// The growth of the hypervolume from one front to the next, relative to the latter, both with the reference point and the widths of their
/// union; ∞ from none to some, not a number while there is none.
fn growth(before: &[Vec<f64>], now: &[Vec<f64>]) -> f64 {
    let Some(first) = now.first() else { return f64::NAN };
    if before.is_empty() {
        return f64::INFINITY;
    }
    let both = || before.iter().chain(now);
    let scaled = |points: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let part = |(goal, v): (usize, &f64)| {
            let low = both().map(|p| p[goal]).fold(f64::INFINITY, f64::min);
            let high = both().map(|p| p[goal]).fold(f64::NEG_INFINITY, f64::max);
            if high > low { (v - low) / (high - low) } else { 0.0 }
        };
        points.iter().map(|p| p.iter().enumerate().map(part).collect()).collect()
    };
    let reference = vec![1.0 + BEYOND; first.len()];
    let [old, new] = [before, now].map(|points| hypervolume(&scaled(points), &reference));
    (new - old) / new
}
