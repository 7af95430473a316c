//! From `[pareto]` to project files of which none is better than another in every goal.
//!
//! A design is the project with some settings more, and what counts is its full analysis, as [`Loaded::solve`] makes it: its metrics are
//! the goals, its checks the limits. So the study knows no family, and every point of the front is verified.

mod document;
mod lines;
mod pages;
mod values;

pub use values::Choice;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Severity, Span};
use forcewright_base::text::closest;
use forcewright_base::units::{Dimension, Unit};
use forcewright_contract::describe::Located;
use forcewright_contract::project::Files;
use forcewright_contract::studies;
use forcewright_model::{Check, CheckState, Outcome, Report, StatusKind};
use forcewright_study::pareto::{Assessment, Front, Kind, Member, Problem, Settings, Stop, Unassessed, search, spread};
use rayon::prelude::*;

pub use forcewright_study::pareto::Progress as ParetoProgress;

use crate::optimise::Changed;
use crate::sweep::Snapshot;
use crate::sweep::axis::{MetricColumn, metrics_of};
use crate::{Loaded, Refused};

/// Most designs that get a project file; all are in the table.
const MOST_FILES: usize = 24;
/// Generations without growth of the front after which a search ends, and what is none, relative to its hypervolume.
const PATIENCE: usize = 15;
const LEAST_GAIN: f64 = 1e-4;
/// What settings of a design are called where they are wrong.
const VARIED: &str = "[pareto.vary]";
/// What a check that could not be assessed, or has no margin, is missed by.
const UNKNOWN: f64 = 1.0;

/// A goal of a trade-off.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// The metric.
    pub name: String,
    /// Whether it is made large.
    pub large: bool,
    /// Its quantity.
    pub dimension: Dimension,
    /// The unit in which people are shown it.
    pub unit: Unit,
}

/// A design of a front.
#[derive(Clone, Debug)]
pub struct ParetoDesign {
    /// Its values as typed, one per choice.
    pub values: Vec<String>,
    /// Its goals, SI, in their order.
    pub goals: Vec<f64>,
    /// The metrics of the family, SI, in the order of its list.
    pub(crate) metrics: Vec<Option<f64>>,
    /// The check that is kept with the smallest margin, or missed by most: its title and margin.
    pub tightest: Option<(String, f64)>,
    /// All requirements together, and the other checks that it must keep.
    pub met: bool,
    /// Name and text of its project file, if it has one.
    pub file: Option<(String, String)>,
    /// The analysis of that file.
    pub report: Option<Report>,
}

/// What a search for a trade-off found.
pub struct Pareto {
    /// The goals, those that are made small first.
    pub goals: Vec<Goal>,
    /// What was varied.
    pub choices: Vec<Choice>,
    /// The designs, in the order of the first goal, the best first; if none keeps every limit, the nearest alone.
    pub designs: Vec<ParetoDesign>,
    /// What the search did.
    pub search: Front,
    /// Generations and population asked for, and the seed.
    pub asked: Settings,
    /// Whether every check had to be kept, or the requirements only.
    pub all_checks: bool,
    /// The design of the file.
    pub before: Report,
    /// What the file has of each choice, as typed.
    present: Vec<Option<String>>,
    /// SHA-256 of the project.
    pub input_sha256: String,
    metrics: Vec<MetricColumn>,
}

impl Pareto {
    /// Whether the designs keep every limit.
    pub fn met(&self) -> bool {
        !self.search.front.is_empty()
    }

    /// Whether it was interrupted.
    pub fn interrupted(&self) -> bool {
        self.search.stop == Stop::Interrupted
    }
}

/// A trade-off that can be searched for.
pub struct ParetoTask<'a> {
    project: &'a Loaded,
    files: Snapshot,
    goals: Vec<Goal>,
    choices: Vec<Choice>,
    all_checks: bool,
    settings: Settings,
    metrics: Vec<MetricColumn>,
    before: Report,
}

impl Loaded {
    /// The trade-off that `[pareto]` of the project asks for, ready to be searched, with everything checked that can be before the work.
    /// `population`, `generations` and `seed` replace those of the file.
    ///
    /// ```
    /// use std::sync::atomic::AtomicBool;
    ///
    /// use forcewright::{Choices, DiskFiles, Loaded};
    ///
    /// // A thicker strip is stiffer and its stress is higher: every thickness is a compromise. σ ∝ w and F ∝ w³.
    /// let strip = forcewright::gallery::find("cantilever").expect("in the gallery").text.replace("stiffness =", "# stiffness =");
    /// let text = strip.replace("travel = \"5 mm\"", "travel = \"0.05 mm\"") + "[pareto]\nmaximise = [\"force_at_end\"]\n\
    ///     minimise = [\"stress_max\"]\npopulation = 8\ngenerations = 3\nvary = { \"design.thickness\" = { range = [\"0.4 mm\", \"0.8 mm\"] } }\n\
    ///     [model]\nbeam = \"inextensible\"\n";
    /// let loaded = Loaded::from_text("strip.toml", &text, &Choices::default()).map_err(|e| e.render(false))?;
    /// let task = loaded.pareto_task(&DiskFiles, (None, None, None)).map_err(|e| e.render(false))?;
    /// let found = task.search(&DiskFiles, "".as_ref(), &AtomicBool::new(false), &|_| ()).map_err(|e| e.render(false))?;
    /// assert_eq!(found.designs.len() as u64, found.search.evaluations);
    /// // What is made small comes first.
    /// let cube = |d: &forcewright::ParetoDesign| d.goals[1] / (d.goals[0] * d.goals[0] * d.goals[0]);
    /// assert!(found.designs.iter().all(|d| (cube(d) / cube(&found.designs[0]) - 1.0).abs() < 1e-3));
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// [`Refused`] if the project has no `[pareto]`, or asks for what cannot be done.
    pub fn pareto_task(
        &self,
        files: &dyn Files,
        (population, generations, seed): (Option<u32>, Option<u32>, Option<u32>),
    ) -> Result<ParetoTask<'_>, Refused> {
        let mut diagnostics = Diagnostics::default();
        let section = &self.understood.studies().pareto;
        if section.present.is_none() {
            diagnostics.push(Diagnostic::error("E0317", self.project.root, "there is no `[pareto]`").label("from this file").help(
                "add `[pareto]` with two goals in `minimise` and `maximise`, and `[pareto.vary]`; `forcewright new pareto-handle` has both",
            ));
            return Err(self.refused(diagnostics));
        }
        let metrics = metrics_of(self.family);
        let before = self.solve(&self.name(), "", &mut |_| true);
        let goals = self.goals(section, &metrics, &before.outcome, &mut diagnostics);
        let numbers = self.understood.numbers();
        let choices: Vec<Choice> = section.vary.iter().filter_map(|m| Choice::of(m, numbers, &mut diagnostics)).collect();
        if choices.is_empty() && !diagnostics.has_errors() {
            diagnostics.push(
                Diagnostic::error("E0921", self.place_of(&["pareto", "vary"]), "nothing is varied")
                    .label("here")
                    .help("add `[pareto.vary]` with a path and its values: `\"design.thickness\" = { range = [\"0.8 mm\", \"1.2 mm\"] }`"),
            );
        }
        if diagnostics.has_errors() {
            return Err(self.refused(diagnostics));
        }
        let count = |own: Option<u32>, slot: &Option<Located<u32>>, usual: usize| {
            own.or(slot.as_ref().map(|s| s.value)).map_or(usual, |n| n as usize)
        };
        let people = count(population, &section.population, 40);
        let settings = Settings {
            // Parents come in pairs.
            population: (people + people % 2).max(4),
            generations: count(generations, &section.generations, 40),
            seed: count(seed, &section.seed, 1) as u64,
            patience: PATIENCE,
            least_gain: LEAST_GAIN,
            ..Settings::default()
        };
        let all_checks = section.checks.as_ref().is_none_or(|c| c.value == "all");
        let name = self.name();
        let text = self.project.sources.iter().next().map_or_else(String::new, |s| s.text.to_string());
        let path = Path::new(&name);
        let (again, files) =
            Snapshot::of(&Changed { files, path, text: &text }, |files| Self::from_file(files, path, &self.project.choices));
        again?;
        let task = ParetoTask { project: self, files, goals, choices, all_checks, settings, metrics, before };
        task.find_mistakes()?;
        Ok(task)
    }

    /// The goals in the order of the file, those that are made small first.
    fn goals(&self, section: &studies::Pareto, metrics: &[MetricColumn], now: &Outcome, diagnostics: &mut Diagnostics) -> Vec<Goal> {
        let mut goals: Vec<Goal> = Vec::new();
        for (slot, large) in [(&section.minimise, false), (&section.maximise, true)] {
            for name in slot.iter().flat_map(|names| &names.value) {
                let mut refuse = |message: String, help: String| {
                    diagnostics.push(Diagnostic::error("E0920", name.span, message).label("this goal").help(help));
                };
                let shown: String = name.value.chars().take(60).collect();
                let Some(metric) = metrics.iter().find(|m| m.name == name.value) else {
                    let near = closest(&name.value, metrics.iter().map(|m| m.name.as_str()));
                    let help = near.map_or_else(
                        || "a goal is a metric, as in `requirements.limits`".to_owned(),
                        |near| format!("did you mean `{near}`?"),
                    );
                    refuse(format!("there is no metric `{shown}`"), help);
                    continue;
                };
                if goals.iter().any(|g| g.name == name.value) {
                    refuse(format!("`{shown}` is a goal twice"), "name it once, in `minimise` or in `maximise`".to_owned());
                    continue;
                }
                let unit = now.metric(&metric.name).map_or_else(|| Unit::si(metric.dimension), |m| m.display.clone());
                goals.push(Goal { name: metric.name.clone(), large, dimension: metric.dimension, unit });
            }
        }
        if !(2..=3).contains(&goals.len()) && !diagnostics.has_errors() {
            let place =
                section.minimise.as_ref().or(section.maximise.as_ref()).map_or_else(|| self.place_of(&["pareto"]), |names| names.span);
            let message = format!("a trade-off has two or three goals, not {}", goals.len());
            let help = "name metrics in `minimise` and `maximise`; with one goal, `forcewright optimise` finds more with less work";
            diagnostics.push(Diagnostic::error("E0920", place, message).label("here").help(help));
        }
        goals
    }
}

/// What is kept of the analysis of a design.
struct Known {
    metrics: Vec<Option<f64>>,
    tightest: Option<(String, f64)>,
}

/// The margin of a check that a design must keep; what could not be assessed is missed.
fn margin(check: &Check) -> f64 {
    match (check.state, check.margin) {
        // Beside rounding, a margin says the same as the state.
        (CheckState::Met, margin) => margin.unwrap_or(f64::INFINITY).max(0.0),
        (CheckState::Missed, margin) => -margin.map_or(UNKNOWN, |m| (-m).max(f64::MIN_POSITIVE)),
        (CheckState::NotAssessed, _) => -UNKNOWN,
    }
}

impl ParetoTask<'_> {
    /// The goals.
    pub fn goals(&self) -> &[Goal] {
        &self.goals
    }

    /// What is varied.
    pub fn choices(&self) -> &[Choice] {
        &self.choices
    }

    /// Designs of a generation, and generations after the first.
    pub fn size(&self) -> (usize, usize) {
        (self.settings.population, self.settings.generations)
    }

    fn settings_of(&self, values: &[String]) -> Vec<String> {
        self.choices.iter().zip(values).map(|(choice, value)| format!("{}={value}", choice.key)).collect()
    }

    fn values(&self, x: &[f64]) -> Vec<String> {
        self.choices.iter().zip(x).map(|(choice, x)| choice.text(*x)).collect()
    }

    fn load(&self, settings: &[String]) -> Result<Loaded, Refused> {
        let mut choices = self.project.project.choices.clone();
        choices.set.extend_from_slice(settings);
        let name = self.project.name();
        Loaded::from_file(&self.files, Path::new(&name), &choices).map_err(|refused| refused.typed_as(VARIED, settings.len()))
    }

    /// Whether a value is no value of its key, or its key no key. Values that the project cannot have (out of range, a design that does not
    /// close) are none: such designs have no values.
    fn find_mistakes(&self) -> Result<(), Refused> {
        let mut found: Vec<Diagnostic> = Vec::new();
        for choice in &self.choices {
            for (index, value) in choice.telling().into_iter().enumerate() {
                let Err(refused) = self.load(&[format!("{}={value}", choice.key)]) else { continue };
                // What was typed for this run stands in the file: its key, or the value.
                let place = |span: Span| {
                    let typed = refused.sources.get(span.source).is_some_and(|s| s.name == VARIED);
                    typed.then(|| if span.start <= choice.key.len() { choice.place } else { choice.place_of(index) })
                };
                // Codes of reading, and words that nobody knows; a number out of range is a number.
                let slip = |d: &Diagnostic| d.severity == Severity::Error && (d.unknown_word || d.code < "E0400" && d.code != "E0204");
                for own in refused.diagnostics.in_file_order().into_iter().filter(|d| slip(d)) {
                    let Some(span) = own.span.and_then(place) else { continue };
                    let related = own.related.iter().filter_map(|(s, text)| Some((place(*s)?, text.clone()))).collect();
                    let told = Diagnostic { span: Some(span), related, ..own.clone() };
                    if !found.iter().any(|d| (d.code, d.span, &d.message) == (told.code, told.span, &told.message)) {
                        found.push(told);
                    }
                }
            }
        }
        if found.is_empty() {
            return Ok(());
        }
        let mut diagnostics = Diagnostics::default();
        for told in found {
            diagnostics.push(told);
        }
        Err(self.project.refused(diagnostics))
    }

    /// Whether a design must keep a check: requirements, and what the family checks by itself if all are asked for.
    fn counts(&self, check: &Check) -> bool {
        check.required || self.all_checks && check.state != CheckState::NotAssessed
    }

    /// Searches for it. Project files are meant for `folder`; what they extend is named from there. `watch` sees every design, from any
    /// thread; `stop` ends the search, and keeps what was found. The same seed gives the same designs for any number of threads.
    ///
    /// # Errors
    /// [`Refused`] if the project cannot be written with other values.
    pub fn search(
        &self,
        files: &dyn Files,
        folder: &Path,
        stop: &AtomicBool,
        watch: &(dyn Fn(&ParetoProgress) + Sync),
    ) -> Result<Pareto, Refused> {
        // What cannot be written is refused before the work, not after.
        let first: Vec<String> = self.choices.iter().filter_map(|c| c.telling().into_iter().next()).collect();
        let target = folder.join(self.file(0));
        let (written, files) = Snapshot::of(files, |files| {
            // These values may be none of a design, and then nothing is read: what files read, the project as it is does too.
            let _ = self.project.rewritten(files, &target, &[]);
            self.written(files, &target, &first)
        });
        if let Err(refused) = written
            && refused.diagnostics.in_file_order().iter().any(|d| d.code == "E0318")
        {
            return Err(refused);
        }
        let run = Run { task: self, kinds: self.choices.iter().map(Choice::kind).collect(), stop, known: Mutex::default() };
        let start: Option<Vec<f64>> = self.choices.iter().map(|c| c.present(&self.project.project.tree)).collect();
        let starts: Vec<Vec<f64>> = start.into_iter().collect();
        let watching = |progress: &ParetoProgress| {
            watch(progress);
            !stop.load(Ordering::Relaxed)
        };
        let found = search(&run, &self.settings, &starts, &watching).map_err(|malformed| {
            let mut diagnostics = Diagnostics::default();
            let place = self.project.place_of(&["pareto", "vary"]);
            diagnostics.push(Diagnostic::error("E0921", place, malformed.to_string()).label("here"));
            self.project.refused(diagnostics)
        })?;
        let known = run.known.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        let designs = self.designs(&files, folder, &found, &known)?;
        Ok(Pareto {
            goals: self.goals.clone(),
            choices: self.choices.clone(),
            designs,
            search: found,
            asked: self.settings.clone(),
            all_checks: self.all_checks,
            before: self.before.clone(),
            present: self.choices.iter().map(|c| c.typed(&self.project.project.tree)).collect(),
            input_sha256: self.project.input_sha256.clone(),
            metrics: self.metrics.clone(),
        })
    }

    /// The designs of the front, or the nearest, with the files of those that are spread best over it.
    fn designs(
        &self,
        files: &Snapshot,
        folder: &Path,
        found: &Front,
        known: &BTreeMap<Vec<String>, Known>,
    ) -> Result<Vec<ParetoDesign>, Refused> {
        let mut members: Vec<&Member> = found.front.iter().chain(&found.nearest).collect();
        // Numbers that differ by less than is typed are the same design.
        let mut seen: Vec<Vec<String>> = Vec::new();
        members.retain(|member| {
            let values = self.values(&member.x);
            let new = !seen.contains(&values);
            if new {
                seen.push(values);
            }
            new
        });
        let chosen = spread(&members, MOST_FILES);
        let mut designs: Vec<ParetoDesign> = members.iter().zip(seen).map(|(member, values)| self.design(member, values, known)).collect();
        let texts: Vec<(usize, String, Report)> = chosen
            .into_par_iter()
            .map(|at| {
                let name = self.file(at);
                let (text, report) = self.written(files, &folder.join(&name), &designs[at].values)?;
                Ok((at, text, report))
            })
            .collect::<Result<_, Refused>>()?;
        for (at, text, report) in texts {
            designs[at].file = Some((self.file(at), text));
            designs[at].report = Some(report);
        }
        Ok(designs)
    }

    fn design(&self, member: &Member, values: Vec<String>, known: &BTreeMap<Vec<String>, Known>) -> ParetoDesign {
        let goals = self.goals.iter().zip(&member.objectives).map(|(goal, v)| if goal.large { -v } else { *v }).collect();
        let (metrics, tightest) = known.get(&values).map_or_else(Default::default, |k| (k.metrics.clone(), k.tightest.clone()));
        ParetoDesign { values, goals, metrics, tightest, met: member.feasible(), file: None, report: None }
    }

    /// A design as a project file, and the analysis of that file.
    fn written(&self, files: &dyn Files, target: &Path, values: &[String]) -> Result<(String, Report), Refused> {
        let loaded = self.load(&self.settings_of(values))?;
        let (text, again) = loaded.rewritten(files, target, &[])?;
        let report = again.solve(&target.display().to_string(), "", &mut |_| true);
        Ok((text, report))
    }

    /// The name of a design's project file.
    fn file(&self, design: usize) -> String {
        let name = PathBuf::from(self.project.name());
        format!("{}-pareto-{:03}.toml", name.file_stem().unwrap_or_default().to_string_lossy(), design + 1)
    }
}

/// A search on the way.
struct Run<'a> {
    task: &'a ParetoTask<'a>,
    kinds: Vec<Kind>,
    stop: &'a AtomicBool,
    /// What was found, by values.
    known: Mutex<BTreeMap<Vec<String>, Known>>,
}

impl Problem for Run<'_> {
    fn variables(&self) -> &[Kind] {
        &self.kinds
    }

    fn goals(&self) -> usize {
        self.task.goals.len()
    }

    fn assess(&self, x: &[f64]) -> Result<Assessment, Unassessed> {
        let values = self.task.values(x);
        let loaded = self.task.load(&self.task.settings_of(&values)).map_err(|refused| {
            let first = refused.diagnostics.in_file_order().into_iter().find(|d| d.severity == Severity::Error);
            Unassessed::Failed(first.map_or_else(|| "refused".to_owned(), |d| format!("{}: {}", d.code, d.message)))
        })?;
        let outcome = loaded.solve("", "", &mut |_| !self.stop.load(Ordering::Relaxed)).outcome;
        match outcome.status.kind {
            StatusKind::Complete => {}
            StatusKind::Interrupted => return Err(Unassessed::Interrupted),
            kind => return Err(Unassessed::Failed(kind.word().to_owned())),
        }
        let mut objectives = Vec::new();
        for goal in &self.task.goals {
            match outcome.metric(&goal.name).map(|m| m.value).filter(|v| v.is_finite()) {
                Some(value) => objectives.push(if goal.large { -value } else { value }),
                None => return Err(Unassessed::Failed(format!("`{}` is not known", goal.name))),
            }
        }
        let checks: Vec<(&Check, f64)> = outcome.checks.iter().filter(|c| self.task.counts(c)).map(|c| (c, margin(c))).collect();
        let tightest = checks.iter().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(check, margin)| (check.title.clone(), *margin));
        let metrics =
            self.task.metrics.iter().map(|m| outcome.metric(&m.name).map(|found| found.value).filter(|v| v.is_finite())).collect();
        let mut known = self.known.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        known.insert(values, Known { metrics, tightest });
        Ok(Assessment { objectives, violations: checks.iter().map(|(_, margin)| -margin).collect() })
    }
}
