//! From `[optimise]` to a better project file.

mod document;
mod pages;
mod wording;

pub use wording::Wording;

use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::units::Unit;
use forcewright_contract::edit::{self, EditError};
use forcewright_contract::project::{Choices, FileError, Files};
use forcewright_model::{CheckState, Report};
use forcewright_study::evaluator::Variable;
use forcewright_study::optimise::{Progress, Run, Search, Settings, again, search};
use forcewright_study::task::Task;

use crate::{Loaded, Refused};

/// Rounds in which limits are tightened where the full analysis finds them missed by what the search does not see.
const ROUNDS: usize = 6;
/// The margin of the first of them, and how it grows.
const FIRST_MARGIN: f64 = 1e-4;
const MARGIN_GROWTH: f64 = 4.0;
/// A violation that a margin can mend.
const NEARLY_KEPT: f64 = 1e-4;

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
    /// All runs.
    pub search: Search,
    /// The best run, if any start could be analysed; the last step of it may have been repeated with a margin.
    pub best: Option<Run>,
    /// The goal at the start, as [`Run::goal`].
    pub goal_before: Option<f64>,
    /// The margin of the best run, relative to each limit.
    pub margin: f64,
    /// The margin that the project file asks for.
    pub margin_asked: f64,
    /// The project file with the numbers of the best run and the settings of the command line, comments kept.
    pub text: Option<String>,
    /// The design of the file.
    pub before: Report,
    /// The design found.
    pub after: Option<Report>,
    /// What was said about the study.
    pub diagnostics: Diagnostics,
}

/// The project's files with another text in one place.
struct Changed<'a> {
    files: &'a dyn Files,
    path: &'a Path,
    text: &'a str,
}

impl Files for Changed<'_> {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        if path == self.path { Ok(self.text.to_owned()) } else { self.files.read(path) }
    }
}

/// A design found, as a file and analysed.
struct Candidate {
    run: Run,
    margin: f64,
    text: String,
    report: Report,
}

impl Candidate {
    /// The largest relative distance by which a requirement is missed; infinite where one could not be assessed.
    fn shortfall(&self) -> f64 {
        let missed = self.report.outcome.checks.iter().filter(|c| c.required && c.state != CheckState::Met);
        missed.map(|c| c.margin.filter(|_| c.state == CheckState::Missed).map_or(f64::INFINITY, |m| -m)).fold(0.0, f64::max)
    }
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
                Diagnostic::error("E0317", self.project.root, "there is no `[optimise]`")
                    .label("from this file")
                    .help("add `[optimise]` with `objective = { maximise = \"flat_ratio\" }` and `variables`; `forcewright new optimise-lan-box` has both"),
            );
            return Err(Refused { diagnostics, sources: self.project.sources.clone(), file_missing: false });
        }
        let free = section.free(self.understood.numbers(), &mut diagnostics);
        let task = if diagnostics.has_errors() { None } else { self.understood.task(&free, &mut diagnostics) };
        match task.filter(|_| !diagnostics.has_errors()) {
            Some(task) => Ok((task, diagnostics)),
            None => Err(Refused { diagnostics, sources: self.project.sources.clone(), file_missing: false }),
        }
    }

    /// The number of searches that `[optimise]` asks for.
    pub fn starts(&self) -> u32 {
        self.understood.studies().optimise.starts.as_ref().map_or(1, |s| s.value)
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
        let (task, diagnostics) = self.task()?;
        let section = &self.understood.studies().optimise;
        let settings = Settings {
            starts: starts.unwrap_or(self.starts()) as usize,
            seed: u64::from(seed.unwrap_or(section.seed.as_ref().map_or(1, |s| s.value))),
            margin: section.margin.as_ref().map_or(0.0, |m| m.value.si),
            ..Settings::default()
        };
        let variables = task.evaluator.variables().to_vec();
        let nominal: Vec<f64> = variables.iter().map(|v| v.nominal).collect();
        // What cannot be written is refused before the work, not after.
        self.with_design(files, target, &task.evaluator.numbers(&nominal))?;
        let before = self.solve(&self.name(), "", &mut |_| true);
        let wording = self.wording(&task, Some(&before));
        let stopped = AtomicBool::new(false);
        let go_on = |progress: &Progress| {
            let on = watch(progress);
            stopped.fetch_or(!on, Ordering::Relaxed);
            on
        };
        let mut found = search(&task, &settings, &go_on);
        let best = found.best.map(|i| found.runs[i].clone()).filter(|run| !run.goal.is_nan());
        let kept = match best {
            Some(run) => Some(self.kept((files, target), (&task, &settings), run, &go_on, &stopped)?),
            None => None,
        };
        found.interrupted |= stopped.into_inner();
        let margin = kept.as_ref().map_or(settings.margin, |k| k.margin);
        let (best, text, after) = kept.map_or((None, None, None), |k| (Some(k.run), Some(k.text), Some(k.report)));
        Ok(Optimised {
            title: task.title.clone(),
            units: variables.iter().map(|v| self.unit_of(v, &before)).collect(),
            goal_before: task.goal_at(&nominal),
            wording,
            variables,
            search: found,
            best,
            margin,
            margin_asked: settings.margin,
            text,
            before,
            after,
            diagnostics,
        })
    }

    /// The best run as a file; where the full analysis misses a requirement, that of a run further inside the limits which meets all.
    /// Where none does, the one that misses least.
    fn kept(
        &self,
        (files, target): (&dyn Files, &Path),
        (task, settings): (&Task, &Settings),
        run: Run,
        go_on: &(dyn Fn(&Progress) -> bool + Sync),
        stopped: &AtomicBool,
    ) -> Result<Candidate, Refused> {
        let candidate = |run: Run, margin| {
            let (text, report) = self.with_design(files, target, &task.evaluator.numbers(&run.x))?;
            Ok(Candidate { run, margin, text, report })
        };
        let mut best = candidate(run, settings.margin)?;
        let mut settings = settings.clone();
        let mut from = best.run.clone();
        for _ in 1..ROUNDS {
            if best.report.outcome.requirements_met() || stopped.load(Ordering::Relaxed) || !from.feasible(NEARLY_KEPT) {
                break;
            }
            settings.margin = if settings.margin > 0.0 { settings.margin * MARGIN_GROWTH } else { FIRST_MARGIN };
            let mut next = again(task, &settings, &from, go_on);
            if next.goal.is_nan() {
                break;
            }
            next.history.splice(0..0, from.history);
            from = next;
            let next = candidate(from.clone(), settings.margin)?;
            if next.shortfall() < best.shortfall() {
                best = next;
            }
        }
        Ok(best)
    }

    /// The project file's name, as given.
    fn name(&self) -> String {
        self.project.sources.iter().next().map_or_else(String::new, |s| s.name.clone())
    }

    /// The unit in which people are shown a variable: the one typed, if it is a number of the file.
    fn unit_of(&self, variable: &Variable, result: &Report) -> Unit {
        let number = self.understood.numbers().iter().find(|n| n.path == variable.path);
        number.map_or_else(|| wording::display(variable.unit, Some(&result.outcome)), |n| n.unit.clone())
    }

    /// The project file with other numbers, and its analysis.
    fn with_design(&self, files: &dyn Files, target: &Path, values: &[(String, f64)]) -> Result<(String, Report), Refused> {
        let text = self.written(target, values).map_err(|error| {
            let mut diagnostics = Diagnostics::default();
            diagnostics.push(
                Diagnostic::error("E0318", self.project.root, error.to_string())
                    .label("in this file")
                    .help("write that number in a table of its own, or without dotted keys"),
            );
            Refused { diagnostics, sources: self.project.sources.clone(), file_missing: false }
        })?;
        let choices = Choices { variant: self.project.choices.variant.clone(), set: Vec::new() };
        let loaded = Self::from_file(&Changed { files, path: target, text: &text }, target, &choices)?;
        let report = loaded.solve(&target.display().to_string(), "", &mut |_| true);
        Ok((text, report))
    }

    fn written(&self, target: &Path, values: &[(String, f64)]) -> Result<String, EditError> {
        let numbers = self.understood.numbers();
        let changed: Vec<(usize, f64)> =
            values.iter().filter_map(|(path, si)| Some((numbers.iter().position(|n| n.path == *path)?, *si))).collect();
        let original = self.project.sources.iter().next().map_or_else(String::new, |s| s.text.to_string());
        let variant = self.project.choices.variant.as_deref();
        let set = edit::with_settings(&original, &self.project.choices.set, variant)?;
        let text = edit::with_values(&set, numbers, &changed, variant)?;
        match way(target, Path::new(&self.name())) {
            Some(way) => edit::with_base_from(&text, &way),
            None => Ok(text),
        }
    }
}

/// The way from the folder of one file to that of another, with forward slashes; `None` if it is the same folder.
fn way(from: &Path, to: &Path) -> Option<String> {
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
