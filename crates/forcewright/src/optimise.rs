//! From `[optimise]` to a better project file.

pub(crate) mod document;
pub(crate) mod global;
mod pages;
mod robust;
pub(crate) mod sizes;
mod wording;

pub use robust::{Robust, Robustness};
pub use sizes::Rounded;
pub use wording::Wording;

use std::ops::Range;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::units::Unit;
use forcewright_contract::edit::{self, EditError};
use forcewright_contract::objective;
use forcewright_contract::project::{Choices, FileError, Files};
use forcewright_contract::studies::Purpose;
use forcewright_model::{Check, CheckState, Report};
use forcewright_study::evaluator::Variable;
use forcewright_study::optimise::{Progress, Reserve, Run, Search, Settings, again, search};
use forcewright_study::task::{Limit, Task};

use crate::gallery::EXAMPLES;
use crate::settings::whole_lists;
use crate::sweep::Snapshot;
use crate::{Loaded, Refused, family};

/// Rounds in which limits are tightened where the full analysis finds them missed by what the search does not see.
const ROUNDS: usize = 8;
/// By how much, relative to what was missed.
const TIGHTER: f64 = 1.25;
/// By how much more in each round than in the one before: between stations a limit gives way by less than it is moved.
const HARDER: f64 = 2.0;
/// A round must leave at most this part of what is missed; after so many in a row that do not, a design is given up.
const NEARER: f64 = 0.7;
const MOST_IN_VAIN: usize = 2;
/// The least by which a limit moves, relative to its scale, and a band, relative to its level: beyond what a search leaves open.
const LEAST_MOVE: f64 = 3e-6;
/// A requirement of the stretch in a band that is missed by more than this part of its scale is not the doing of its own limit but of the
/// band, which was left between stations.
const BEYOND: f64 = 0.01;
/// A goal that is worse than the search says by more than this part of it.
const FALLEN: f64 = 0.005;
/// By how much such a band is narrowed.
const NARROWER: f64 = 1e-4;
/// What a search that begins from a limit missed leaves open.
const CLOSELY_KEPT: f64 = 1e-6;
/// A violation that a margin can mend.
const NEARLY_KEPT: f64 = 1e-4;

/// A check that is missed by more than this part of its limit, beside others missed by less, is missed because of those: a clutch that slips
/// has no efficiency. Limits are moved for those first.
const BESIDE: f64 = 0.2;

/// The least by which the goal of a search must promise to be better than what was kept, relative to that.
const PROMISING: f64 = 1e-3;
/// Times that the scatter is looked at, and the change of what it takes, relative to the most, below which limits are at rest.
const MOST_LOOKS: usize = 8;
const AT_REST: f64 = 0.02;

/// What an optimisation found.
pub struct Optimised {
    /// The goal in words.
    pub title: String,
    /// The goal's values in words.
    pub wording: Wording,
    /// The numbers that varied.
    pub variables: Vec<Variable>,
    /// The unit in which people are shown each of them.
    pub units: Vec<Unit>,
    /// Seed of the starts, or of the search of the whole range.
    pub seed: u64,
    /// All runs.
    pub search: Search,
    /// The best run, if any start could be analysed; the last step of it may have been repeated with a margin.
    pub best: Option<Run>,
    /// The goal at the start, as [`Run::goal`].
    pub goal_before: Option<f64>,
    /// How far inside its limits the best run was kept.
    pub reserve: Reserve,
    /// The limits that were moved further inwards than asked, because the full analysis found them missed: each with the largest move, SI,
    /// and its unit.
    pub tightened: Vec<(String, f64, &'static str)>,
    /// What the scatter of making does, if limits are kept against it.
    pub robustness: Option<Robustness>,
    /// What rounding to sizes did, if numbers can only be had in some.
    pub rounded: Option<Rounded>,
    /// The project file with the numbers of the best run and the settings of the command line, comments kept.
    pub text: Option<String>,
    /// Names of the checks of requirements that the search does not see: the full analysis tells in the end whether they are met.
    pub unseen: Vec<String>,
    /// Of each place that a search of the whole range led to the limit that is missed most, and by how much relative to itself.
    pub place_misses: Vec<Option<(String, f64)>>,
    /// The design of the file.
    pub before: Report,
    /// The design found.
    pub after: Option<Report>,
    /// What was said about the study.
    pub diagnostics: Diagnostics,
}

/// Where a search starts.
#[derive(Default)]
pub(crate) struct Beginnings {
    /// Starts from the design and spread over the ranges; without it those of the file.
    pub(crate) starts: Option<u32>,
    /// Their seed; without it that of the file.
    pub(crate) seed: Option<u32>,
    /// Starts beside those, as [`Settings::more_starts`].
    pub(crate) more: Vec<Vec<f64>>,
    /// Whether only designs near to those are searched for, though the file asks for the whole range.
    pub(crate) local: bool,
    /// Whether they are judged as they are, without a step.
    pub(crate) as_they_are: bool,
}

/// The project's files with another text in one place.
pub(crate) struct Changed<'a> {
    pub(crate) files: &'a dyn Files,
    pub(crate) path: &'a Path,
    pub(crate) text: &'a str,
}

impl Files for Changed<'_> {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        if path == self.path { Ok(self.text.to_owned()) } else { self.files.read(path) }
    }
}

/// Moves the limits that the full analysis found missed inwards, by a little more than that; whether there were any.
fn tighten(reserve: &mut Reserve, task: &Task, found: &Candidate, tighter: f64) -> bool {
    let count = task.evaluator.outputs().iter().map(|o| o.values.end).max().unwrap_or(0);
    reserve.limits.resize(count, 0.0);
    reserve.bands.resize(count, 0.0);
    // A flat range at the edge of its band all along falls apart where the band is exceeded by next to nothing.
    let mut narrower = if found.fell() { NARROWER } else { 0.0_f64 };
    let missed = || missed(&found.report).filter(|c| c.state == CheckState::Missed && task.sees(&c.name));
    let far = |check: &Check| check.margin.is_none_or(|m| -m > BESIDE);
    let beside = missed().any(|c| !far(c));
    let mut moved = false;
    for check in missed().filter(|c| !(beside && far(c))) {
        let by = check.value.zip(check.limit).map_or(0.0, |(value, limit)| (value - limit).abs());
        // A check may be of another quantity than its limit, as a safety factor: of itself both miss as much.
        let relative = check.limit.filter(|limit| limit.abs() > 0.0).map(|limit| by / limit.abs());
        let size = |limit: &Limit| [limit.lower, limit.upper].into_iter().filter(|b| b.is_finite()).fold(0.0_f64, |m, b| m.max(b.abs()));
        let missed = |limit: &Limit| relative.map_or(by, |part| part * size(limit));
        let own: Vec<&Limit> = task.limits.iter().filter(|limit| limit.checks.contains(&check.name.as_str())).collect();
        let astray = |limit: &Limit| limit.in_band && missed(limit) > BEYOND * limit.scale;
        for limit in own.iter().filter(|limit| !astray(limit)) {
            reserve.limits[limit.values.clone()].iter_mut().for_each(|r| *r += tighter * missed(limit) + LEAST_MOVE * limit.scale);
            moved = true;
        }
        // The band's own check says by how much it is too wide; a stroke far too short, that it is.
        if check.name == "force" && by <= BEYOND {
            narrower = narrower.max(tighter * by + LEAST_MOVE);
        } else if check.name == "force" || own.iter().any(|limit| astray(limit)) {
            narrower = narrower.max(NARROWER);
        }
    }
    reserve.bands.iter_mut().for_each(|r| *r += narrower);
    moved || narrower > 0.0 && task.steps.last().is_some_and(|s| !s.bands.is_empty())
}

/// A design found, as a file and analysed.
#[derive(Clone)]
struct Candidate {
    run: Run,
    reserve: Reserve,
    text: String,
    report: Report,
    /// The goal by the full analysis where that knows it, else by the search. Smaller is better.
    goal: f64,
}

impl Candidate {
    fn new(run: Run, reserve: &Reserve, (text, report): (String, Report), wording: &Wording) -> Self {
        let goal = report.outcome.metric(&wording.objective).and_then(|m| wording.goal(m.value)).unwrap_or(run.goal);
        Self { run, reserve: reserve.clone(), text, report, goal }
    }

    fn met(&self) -> bool {
        self.report.outcome.requirements_met()
    }

    /// Whether the full analysis finds the goal much worse than the search.
    fn fell(&self) -> bool {
        self.goal > self.run.goal + FALLEN * self.run.goal.abs()
    }

    /// Fewer requirements missed; of as many, missed by less; of those that miss nothing the better goal.
    fn beats(&self, other: &Self) -> bool {
        let missed = |of: &Self| missed(&of.report).count();
        match missed(self).cmp(&missed(other)) {
            std::cmp::Ordering::Equal if missed(self) == 0 => self.goal < other.goal,
            std::cmp::Ordering::Equal => shortfall(&self.report) < shortfall(&other.report),
            order => order.is_lt(),
        }
    }

    /// Whether it came nearer than another to what it misses: it misses fewer, or one of them by much less.
    fn nearer(&self, other: &Self) -> bool {
        let (now, before) = (missed(&self.report).count(), missed(&other.report).count());
        let less = |check: &Check| {
            let then = missed(&other.report).find(|c| c.name == check.name).map(short_of);
            then.is_some_and(|then| short_of(check) <= NEARER * then)
        };
        now < before || now == before && missed(&self.report).any(less)
    }
}

/// Requirements that a design misses, or that could not be assessed.
pub(crate) fn missed(report: &Report) -> impl Iterator<Item = &Check> {
    report.outcome.checks.iter().filter(|c| c.required && c.state != CheckState::Met)
}

/// The relative distance by which a requirement is missed; infinite where it could not be assessed.
fn short_of(check: &Check) -> f64 {
    check.margin.filter(|_| check.state == CheckState::Missed).map_or(f64::INFINITY, |m| -m)
}

/// The largest relative distance by which a requirement is missed; infinite where one could not be assessed.
pub(crate) fn shortfall(report: &Report) -> f64 {
    missed(report).map(short_of).fold(0.0, f64::max)
}

impl Loaded {
    /// The search that `[optimise]` of the project asks for, ready to run, and what was said about it.
    ///
    /// # Errors
    /// [`Refused`] if the project has no `[optimise]`, or asks for what cannot be done.
    pub fn task(&self) -> Result<(Task, Diagnostics), Refused> {
        let mut diagnostics = Diagnostics::default();
        let section = &self.understood.studies().optimise;
        if section.present.is_none() {
            diagnostics.push(
                Diagnostic::error("E0317", self.project.root, "there is no `[optimise]`").label("from this file").help(self.how_to_ask()),
            );
            return Err(self.refused(diagnostics));
        }
        global::check(section, &mut diagnostics);
        let free = section.free(self.understood.numbers(), &mut diagnostics);
        let task = if diagnostics.has_errors() { None } else { self.understood.task(&free, Purpose::Search, &mut diagnostics) };
        match task.filter(|_| !diagnostics.has_errors()) {
            Some(task) => Ok((task, diagnostics)),
            None => Err(self.refused(diagnostics)),
        }
    }

    /// What an `[optimise]` of this family looks like.
    fn how_to_ask(&self) -> String {
        let Some(family) = self.project.mechanism().and_then(|(id, _)| family(id)) else { return String::new() };
        let of_family = format!("{}/", family.id());
        let example = EXAMPLES.iter().find(|e| e.name.starts_with(&of_family) && e.text.contains("\n[optimise]"));
        let example =
            example.and_then(|e| e.name.rsplit('/').next()).map_or_else(String::new, |name| format!("; `forcewright new {name}` has both"));
        format!("add `[optimise]` with {} and `variables`{example}", objective::advice(family.objectives()))
    }

    /// The number of searches that `[optimise]` asks for; 0 where it is as many as a search of the whole range leads to.
    pub fn starts(&self) -> u32 {
        let section = &self.understood.studies().optimise;
        if section.global() { 0 } else { section.starts.as_ref().map_or(1, |s| s.value) }
    }

    /// The values of the search's goal in words, in the units of a result where one is given.
    pub fn wording(&self, task: &Task, result: Option<&Report>) -> Wording {
        let objective = &self.understood.studies().optimise.objective;
        let (name, large) = match (&objective.minimise, &objective.maximise) {
            (_, Some(name)) => (name.value.as_str(), true),
            (Some(name), None) => (name.value.as_str(), false),
            (None, None) => ("goal", false),
        };
        Wording::new(task, name, large, result.map(|r| &r.outcome))
    }

    /// Searches for a better design, as `[optimise]` of the project asks, for a file at `target`; what that extends is named from there.
    /// `starts` and `seed` replace those of the file. `watch` sees every iteration, from any thread, and ends the search by returning
    /// `false`: the best design so far is kept.
    ///
    /// The full analysis has the last word on every requirement. Where it finds one missed by what the search does not see between its
    /// stations, the last step is repeated from there a little further inside the limits, until all are met.
    ///
    /// ```
    /// use forcewright::{Choices, DiskFiles, Loaded};
    ///
    /// // The thickest strip whose stress keeps the limit pushes hardest.
    /// let strip = forcewright::gallery::find("cantilever").expect("in the gallery").text.replace("stiffness =", "# stiffness =");
    /// let text = strip + "[optimise]\nobjective = { maximise = \"force_at_end\" }\n\
    ///     variables = { \"design.thickness\" = { range = [\"0.2 mm\", \"3 mm\"] } }\n";
    /// let loaded = Loaded::from_text("strip.toml", &text, &Choices::default()).map_err(|e| e.render(false))?;
    /// let found = loaded.optimise(&DiskFiles, "strip.toml".as_ref(), (None, None), &|_| true).map_err(|e| e.render(false))?;
    /// let best = found.best.as_ref().expect("a design");
    /// assert_eq!(best.active[0].key, "requirements.stress");
    /// assert!(found.after.is_some_and(|report| report.outcome.requirements_met()));
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// [`Refused`] if the project has no `[optimise]`, asks for what cannot be done, or cannot be written with other numbers.
    pub fn optimise(
        &self,
        files: &dyn Files,
        target: &Path,
        (starts, seed): (Option<u32>, Option<u32>),
        watch: &(dyn Fn(&Progress) -> bool + Sync),
    ) -> Result<Optimised, Refused> {
        self.starts_allowed(starts)?;
        self.optimise_from(files, target, Beginnings { starts, seed, ..Beginnings::default() }, watch)
    }

    fn settings(&self, from: Beginnings) -> Settings {
        let section = &self.understood.studies().optimise;
        let mut settings = Settings {
            starts: from.starts.unwrap_or(self.starts()) as usize,
            global: if from.local || from.as_they_are { None } else { global::asked(section) },
            more_starts: from.more,
            seed: u64::from(from.seed.unwrap_or(section.seed.as_ref().map_or(1, |s| s.value))),
            reserve: Reserve { margin: section.margin.as_ref().map_or(0.0, |m| m.value.si), ..Reserve::default() },
            ..Settings::default()
        };
        if from.as_they_are {
            settings.nlp.iteration_limit = 0;
        }
        settings
    }

    /// The same from starts that are known otherwise.
    pub(crate) fn optimise_from(
        &self,
        files: &dyn Files,
        target: &Path,
        from: Beginnings,
        watch: &(dyn Fn(&Progress) -> bool + Sync),
    ) -> Result<Optimised, Refused> {
        let (task, diagnostics) = self.task()?;
        let section = &self.understood.studies().optimise;
        let settings = self.settings(from);
        let robust = Robust::asked(section);
        if robust.is_some() {
            // Whether anything scatters is found out before the work, not after.
            self.scattering()?;
        }
        let variables = task.evaluator.variables().to_vec();
        let places = self.places(&variables)?;
        let nominal: Vec<f64> = variables.iter().map(|v| v.nominal).collect();
        // What cannot be written is refused before the work, not after.
        let (possible, files) = Snapshot::of(files, |files| self.rewritten(files, target, &task.evaluator.numbers(&nominal)));
        possible?;
        let files = &files;
        let before = self.solve(&self.name(), "", &mut |_| true);
        let wording = self.wording(&task, Some(&before));
        let stopped = AtomicBool::new(false);
        let go_on = |progress: &Progress| {
            let on = watch(progress);
            stopped.fetch_or(!on, Ordering::Relaxed);
            on
        };
        let mut found = search(&task, &settings, &go_on);
        let order = to_judge(&found);
        let judge = |run: &usize| self.kept((files, target), (&task, &settings), found.runs[*run].clone(), &go_on, &stopped);
        let judged = best_of(&order, &found.runs, &stopped, &judge)?;
        found.best = judged.as_ref().map(|(run, _)| *run).or(found.best);
        let mut kept = judged.map(|(_, candidate)| candidate);
        let mut robustness = None;
        if let Some((found, robust)) = kept.take_if(|_| robust.is_some()).zip(robust) {
            let (found, looked) = self.hardened((files, target), (&task, &settings), (found, robust), &go_on, &stopped)?;
            (kept, robustness) = (Some(found), Some(looked));
        }
        let mut rounded = None;
        if let Some(found) = kept.take_if(|_| !places.is_empty()) {
            let (found, sizes) = self.at_sizes((files, target), &settings, (found, &places), &go_on, &stopped)?;
            (kept, rounded) = (Some(found), sizes);
        }
        found.interrupted |= stopped.into_inner();
        let reserve = kept.as_ref().map_or(settings.reserve, |k| k.reserve.clone());
        let (best, text, after) = kept.map_or((None, None, None), |k| (Some(k.run), Some(k.text), Some(k.report)));
        let places = found.explored.iter().flat_map(|e| &e.places);
        Ok(Optimised {
            title: task.title.clone(),
            units: variables.iter().map(|v| self.unit_of(v, &before)).collect(),
            goal_before: task.goal_at(&nominal),
            unseen: before.outcome.checks.iter().filter(|c| c.required && !task.sees(&c.name)).map(|c| c.name.clone()).collect(),
            place_misses: places.map(|p| task.largest_miss(&p.x)).collect(),
            wording,
            variables,
            seed: settings.seed,
            search: found,
            best,
            tightened: if robustness.is_some() { Vec::new() } else { tightened(&task, &reserve) },
            reserve,
            robustness,
            rounded,
            text,
            before,
            after,
            diagnostics,
        })
    }

    /// A run as a file; where the full analysis misses a requirement, that of a run further inside the limits which meets all.
    /// Where none does, the one that misses least.
    fn kept(
        &self,
        (files, target): (&dyn Files, &Path),
        (task, settings): (&Task, &Settings),
        run: Run,
        go_on: &(dyn Fn(&Progress) -> bool + Sync),
        stopped: &AtomicBool,
    ) -> Result<Candidate, Refused> {
        let candidate = |run: Run, reserve: &Reserve| {
            let (text, report) = self.with_design(files, target, &task.evaluator.numbers(&run.x))?;
            Ok(Candidate::new(run, reserve, (text, report), &self.wording(task, None)))
        };
        let mut settings = settings.clone();
        settings.nlp.feasibility = settings.nlp.feasibility.min(CLOSELY_KEPT);
        let mut last = candidate(run, &settings.reserve)?;
        let mut best = last.clone();
        let (mut tighter, mut vain) = (TIGHTER, 0);
        for _ in 1..ROUNDS {
            let done = best.met() && !best.fell() || vain >= MOST_IN_VAIN;
            if done || stopped.load(Ordering::Relaxed) || !last.run.feasible(NEARLY_KEPT) {
                break;
            }
            // What is missed may be none of what the search sees.
            if !tighten(&mut settings.reserve, task, &last, tighter) {
                break;
            }
            tighter *= HARDER;
            let mut next = again(task, &settings, &last.run, go_on);
            if next.goal.is_nan() {
                break;
            }
            next.history.splice(0..0, last.run.history);
            last = candidate(next, &settings.reserve)?;
            let nearer = last.met() || last.nearer(&best);
            if last.beats(&best) {
                best = last.clone();
            }
            vain = if nearer { 0 } else { vain + 1 };
        }
        Ok(best)
    }

    /// The best run searched on from, with its limits moved inwards by what the scatter around each next design takes, until they rest.
    fn hardened(
        &self,
        (files, target): (&dyn Files, &Path),
        (task, settings): (&Task, &Settings),
        (mut found, robust): (Candidate, Robust),
        go_on: &(dyn Fn(&Progress) -> bool + Sync),
        stopped: &AtomicBool,
    ) -> Result<(Candidate, Robustness), Refused> {
        let mut asked = found.reserve.clone();
        let choices = Choices { variant: self.project.choices.variant.clone(), set: Vec::new() };
        let project = |text: &str| Self::from_file(&Changed { files, path: target, text }, target, &choices);
        let (mut rounds, mut best, mut lacking) = (0, found.clone(), f64::INFINITY);
        loop {
            let Some(mut reserve) = project(&found.text)?.reserve(task, &found.run, robust, &asked)? else { break };
            robust::raise((&mut asked, &mut reserve), task, &found.run.x, &found.report.outcome);
            rounds += 1;
            let lacks = if found.run.feasible(NEARLY_KEPT) { reserve.lacking(&found.reserve, task) } else { f64::INFINITY };
            // Of those that keep what their own scatter takes, the best; else the one that lacks least of it.
            let nearer = if lacks.max(lacking) <= AT_REST { found.goal < best.goal } else { lacks < lacking };
            if (found.met(), nearer) >= (best.met(), true) {
                (best, lacking) = (found.clone(), lacks);
            }
            if rounds >= MOST_LOOKS || reserve.rests(&found.reserve, task, AT_REST) || stopped.load(Ordering::Relaxed) {
                break;
            }
            let mut next = again(task, &Settings { reserve: reserve.clone(), ..settings.clone() }, &found.run, go_on);
            if next.goal.is_nan() {
                break;
            }
            next.history.splice(0..0, found.run.history);
            let written = self.with_design(files, target, &task.evaluator.numbers(&next.x))?;
            found = Candidate::new(next, &reserve, written, &self.wording(task, None));
        }
        let (found, settled) = (best, lacking <= AT_REST);
        let yields = if stopped.load(Ordering::Relaxed) { [None, None] } else { [self.drawn(), project(&found.text)?.drawn()] };
        let scattering = self.scattering()?.free.len();
        Ok((found, Robustness { against: robust, scattering, rounds, settled, yields }))
    }

    /// The project file's name, as given.
    pub(crate) fn name(&self) -> String {
        self.project.sources.iter().next().map_or_else(String::new, |s| s.name.clone())
    }

    /// The unit in which people are shown a variable: the one typed, if it is a number of the file.
    fn unit_of(&self, variable: &Variable, result: &Report) -> Unit {
        let number = self.understood.numbers().iter().find(|n| n.path == variable.path);
        number.map_or_else(|| wording::display(variable.unit, Some(&result.outcome)), |n| n.unit.clone())
    }

    /// The project file with other numbers, and its analysis.
    fn with_design(&self, files: &dyn Files, target: &Path, values: &[(String, f64)]) -> Result<(String, Report), Refused> {
        let (text, loaded) = self.rewritten(files, target, values)?;
        let report = loaded.solve(&target.display().to_string(), "", &mut |_| true);
        Ok((text, report))
    }

    /// The project file with other numbers, understood.
    pub(crate) fn rewritten(&self, files: &dyn Files, target: &Path, values: &[(String, f64)]) -> Result<(String, Self), Refused> {
        let text = self.written(target, values).map_err(|error| {
            let mut diagnostics = Diagnostics::default();
            diagnostics.push(
                Diagnostic::error("E0318", self.project.root, error.to_string())
                    .label("in this file")
                    .help("write that number in a table of its own, or without dotted keys"),
            );
            self.refused(diagnostics)
        })?;
        let choices = Choices { variant: self.project.choices.variant.clone(), set: Vec::new() };
        let loaded = Self::from_file(&Changed { files, path: target, text: &text }, target, &choices)?;
        Ok((text, loaded))
    }

    fn written(&self, target: &Path, values: &[(String, f64)]) -> Result<String, EditError> {
        let numbers = self.understood.numbers();
        let changed: Vec<(usize, f64)> =
            values.iter().filter_map(|(path, si)| Some((numbers.iter().position(|n| n.path == *path)?, *si))).collect();
        let original = self.project.sources.iter().next().map_or_else(String::new, |s| s.text.to_string());
        let variant = self.project.choices.variant.as_deref();
        let settings = &self.project.choices.set;
        let set = edit::with_settings(&original, settings, variant).or_else(|error| {
            let whole = whole_lists(settings, &self.project.tree).ok_or(error)?;
            edit::with_settings(&original, &whole, variant)
        })?;
        let text = edit::with_values(&set, numbers, &changed, variant)?;
        match way(target, Path::new(&self.name())) {
            Some(way) => edit::with_base_from(&text, &way),
            None => Ok(text),
        }
    }
}

/// The order in which runs are judged by the full analysis: the best of each basin, the best first; the others that keep all limits; then
/// those that miss least. Which of them meets its requirements only that analysis tells.
fn to_judge(found: &Search) -> Vec<usize> {
    let mut order: Vec<usize> = found.basins.iter().map(|b| b.best).collect();
    let mut others: Vec<usize> = found.basins.iter().flat_map(|b| b.members.iter().copied().filter(|i| *i != b.best)).collect();
    others.sort_by(|a, b| found.runs[*a].goal.total_cmp(&found.runs[*b].goal).then(a.cmp(b)));
    order.extend(others);
    let mut rest: Vec<usize> = (0..found.runs.len()).filter(|i| !order.contains(i)).collect();
    rest.sort_by(|a, b| found.runs[*a].violation.total_cmp(&found.runs[*b].violation).then(a.cmp(b)));
    order.extend(rest);
    order.retain(|i| !found.runs[*i].goal.is_nan());
    order
}

/// The best of what runs lead to, looked at in their order until one meets all requirements, with its run. As many at a time as there are
/// threads; what the order would not have come to is thrown away, so that their number changes nothing.
fn best_of(
    order: &[usize],
    runs: &[Run],
    stopped: &AtomicBool,
    judge: &(dyn Fn(&usize) -> Result<Candidate, Refused> + Sync),
) -> Result<Option<(usize, Candidate)>, Refused> {
    let mut kept: Option<(usize, Candidate)> = None;
    // One that meets all is beaten by none whose search promised hardly more: what the full analysis finds costs the rest.
    let enough = |kept: &Option<(usize, Candidate)>, run: usize| {
        let promises = |k: &Candidate| runs[run].feasible(NEARLY_KEPT) && k.goal > runs[run].goal + PROMISING * k.goal.abs();
        kept.as_ref().is_some_and(|(_, k)| k.met() && !promises(k) || stopped.load(Ordering::Relaxed))
    };
    for some in order.chunks(rayon::current_num_threads()) {
        if some.iter().all(|run| enough(&kept, *run)) {
            continue;
        }
        let judged: Vec<Result<Candidate, Refused>> = some.par_iter().map(judge).collect();
        for (run, next) in some.iter().zip(judged) {
            if enough(&kept, *run) {
                continue;
            }
            let next = next?;
            if kept.as_ref().is_none_or(|(_, k)| next.beats(k)) {
                kept = Some((*run, next));
            }
        }
    }
    Ok(kept)
}

/// The limits that were moved inwards, each with the largest move, SI, and its unit.
fn tightened(task: &Task, reserve: &Reserve) -> Vec<(String, f64, &'static str)> {
    let largest = |values: &[f64], range: Range<usize>| values.get(range).map_or(0.0, |own| own.iter().copied().fold(0.0, f64::max));
    let limits = task.limits.iter().map(|l| (l.name.clone(), largest(&reserve.limits, l.values.clone()), l.unit));
    let band = ("band".to_owned(), largest(&reserve.bands, 0..reserve.bands.len()), "1");
    limits.chain([band]).filter(|(_, by, _)| *by > 0.0).collect()
}

/// The way from the folder of one file to that of another, with forward slashes; `None` if it is the same folder.
pub(crate) fn way(from: &Path, to: &Path) -> Option<String> {
    let folder = |path: &Path| path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
    let (from, to) = (folder(from), folder(to));
    if from == to {
        return None;
    }
    // Links are followed, since `..` of a link is not where the link lies.
    let real = |path: &Path| path.canonicalize().or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_owned());
    let (from, to) = (real(&from), real(&to));
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return Some(to.to_string_lossy().into_owned());
    }
    let up = from.components().skip(shared).map(|_| Component::ParentDir);
    let way: PathBuf = up.chain(to.components().skip(shared)).collect();
    let parts: Vec<_> = way.components().map(|c| c.as_os_str().to_string_lossy().into_owned()).collect();
    if parts.is_empty() { None } else { Some(parts.join("/")) }
}

#[cfg(test)]
mod tests;
