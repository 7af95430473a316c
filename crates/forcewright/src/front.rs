//! What a limit costs: the best goal over the values of one key of the project file.
//!
//! For each value the search of `[optimise]` is run with the key at that value; goals over values are the Pareto front of the goal against
//! the limit that the key sets (ε-constraint method: Y. Y. Haimes, L. S. Lasdon, D. A. Wismer, "On a bicriterion formulation of the
//! problems of integrated system identification and system optimization", IEEE Transactions on Systems, Man, and Cybernetics SMC-1 (1971)
//! 296–297). Points help each other: each is searched for from the designs of those before it too, then, backwards, from those after it;
//! and one whose limits the design of another keeps has no worse a goal than that. So the front is monotone where the key only loosens.

mod document;
mod pages;

use std::path::{Path, PathBuf};

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Sources};
use forcewright_base::units::Unit;
use forcewright_contract::project::Files;
use forcewright_model::StatusKind;
use forcewright_study::evaluator::Variable;
use forcewright_study::optimise::Progress;

use crate::optimise::{Beginnings, Changed, shortfall};
use crate::sweep::Axis;
use crate::sweep::axis::{MetricColumn, metrics_of};
use crate::{Loaded, Optimised, Refused};

/// Most points of a front: each is a search.
const MOST_POINTS: u64 = 1000;
/// Two designs are the same if no variable differs by more than this part of its range; then a search from one is a search from the other.
const SAME: f64 = 0.02;
/// Changes of the goal, relative to it: one that is none, and one that is worth a trifle of a limit.
const EQUAL: f64 = 1e-6;
const SLIGHT: f64 = 1e-3;
/// A miss of a requirement, relative to it, that nothing made could show.
const TRIFLE: f64 = 1e-4;

/// Where the search of a front stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontProgress {
    /// The point, from 0, in the order of the values.
    pub point: usize,
    /// 0 on the way forwards, 1 on the way back, 2 where designs of other points are tried as they are.
    pub pass: usize,
    /// Starts of this search; 0 where it is as many as a search of the whole range leads to.
    pub starts: usize,
    /// Where it stands.
    pub search: Progress,
}

/// Where the design of a point comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// From a start, from 0; the first is the design of the file.
    Start(usize),
    /// Searched for from the design of another point, from 0.
    Point(usize),
    /// The design of another point as it is.
    Taken(usize),
}

/// A point of a front.
pub struct FrontPoint {
    /// The value of the key as typed.
    pub value: String,
    /// The same, SI.
    pub si: f64,
    /// The best that was found for it.
    pub found: Optimised,
    /// Where that comes from.
    pub origin: Origin,
    /// Starts searched from.
    pub starts: usize,
    /// Designs computed.
    pub evaluations: u64,
    /// Name of its project file.
    pub file: String,
    /// Whether a search leads from the design of the point before to this one, or back, or they are the same; the first: yes.
    pub follows: bool,
    /// What was searched from, and where that led, in the order of its variables.
    led: Vec<[Vec<f64>; 2]>,
}

impl FrontPoint {
    /// The goal of the full analysis, SI, or that of the search where the analysis does not know it.
    pub fn goal(&self) -> Option<f64> {
        self.found.best.as_ref()?;
        self.found.goal().2[1]
    }
}

/// The best goal over the values of a key.
pub struct Front {
    /// The key, as in `--set`.
    pub key: String,
    /// Its values as typed: `0.5..1.58:6`.
    pub spec: String,
    /// Their unit.
    pub unit: Unit,
    /// Points with a search, in the order of the values.
    pub points: Vec<FrontPoint>,
    /// How many values there are.
    pub asked: usize,
    /// Whether it was interrupted: values without a point, or points that were not searched for to the end.
    pub interrupted: bool,
    /// SHA-256 of the project without the key's values.
    pub input_sha256: String,
    metrics: Vec<MetricColumn>,
}

/// A value of the key, with the project that it makes.
struct Value {
    text: String,
    si: f64,
    loaded: Loaded,
    variables: Vec<Variable>,
}

/// A front that can be searched for.
pub struct FrontTask<'a> {
    project: &'a Loaded,
    axis: Axis,
    values: Vec<Value>,
    unit: Unit,
}

impl Loaded {
    /// The Pareto front of the goal of `[optimise]` against a key of the project: the search of [`Self::optimise`] for each value of
    /// `axis`, each from the designs of the others too. Project files are meant for `folder`; what they extend is named from there.
    /// `starts`, `seed` and `watch` are as there; a front that is interrupted keeps its points so far.
    ///
    /// ```
    /// use forcewright::{Choices, DiskFiles, Loaded, sweep::Axis};
    ///
    /// // The thickest strip whose stress keeps the limit pushes hardest: σ ∝ w, F ∝ w³, so half the safety factor is eight times the force.
    /// let strip = forcewright::gallery::find("cantilever").expect("in the gallery").text.replace("stiffness =", "# stiffness =");
    /// let text = strip.replace("travel = \"5 mm\"", "travel = \"0.05 mm\"") + "[optimise]\nobjective = { maximise = \"force_at_end\" }\n\
    ///     variables = { \"design.thickness\" = { range = [\"0.2 mm\", \"80 mm\"] } }\n[model]\nbeam = \"inextensible\"\n";
    /// let loaded = Loaded::from_text("strip.toml", &text, &Choices::default()).map_err(|e| e.render(false))?;
    /// let axis = Axis::parse("requirements.stress.safety_factor=8,4").map_err(|e| e.to_string())?;
    /// let front = loaded.front(&DiskFiles, &axis, "".as_ref(), (None, None), &|_| true).map_err(|e| e.render(false))?;
    /// let force: Vec<f64> = front.points.iter().filter_map(|p| p.goal()).collect();
    /// // A limit keeps a reserve of up to 1e-4 of itself, which the force feels three times.
    /// assert!((force[1] / force[0] / 8.0 - 1.0).abs() < 6e-4);
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// [`Refused`] if the values are no numbers of the key, the project cannot be used with one of them, or [`Self::optimise`] refuses it.
    pub fn front(
        &self,
        files: &dyn Files,
        axis: &Axis,
        folder: &Path,
        (starts, seed): (Option<u32>, Option<u32>),
        watch: &(dyn Fn(&FrontProgress) -> bool + Sync),
    ) -> Result<Front, Refused> {
        self.front_task(files, axis)?.search(files, folder, (starts, seed), watch)
    }

    /// The front that [`Self::front`] searches for, with everything checked that can be before the work.
    ///
    /// # Errors
    /// As [`Self::front`].
    pub fn front_task(&self, files: &dyn Files, axis: &Axis) -> Result<FrontTask<'_>, Refused> {
        let values = axis.listed(MOST_POINTS + 1).zip(axis.unit());
        let (texts, unit) = values.ok_or_else(|| not_a_front(axis, "a front needs numbers: a range with its count, or a list"))?;
        if texts.len() as u64 > MOST_POINTS {
            return Err(not_a_front(axis, &format!("a front has at most {MOST_POINTS} points, each of which is a search")));
        }
        let name = self.name();
        let text = self.project.sources.iter().next().map_or_else(String::new, |s| s.text.to_string());
        let mut values = Vec::new();
        for typed in texts {
            let mut choices = self.project.choices.clone();
            choices.set.push(format!("{}={typed}", axis.key));
            let path = Path::new(&name);
            let typed_here = |refused: Refused| refused.typed_as("--front", 1);
            let loaded = Self::from_file(&Changed { files, path, text: &text }, path, &choices).map_err(typed_here)?;
            let (task, _) = loaded.task().map_err(typed_here)?;
            let variables = task.evaluator.variables().to_vec();
            if variables.iter().any(|v| v.path == axis.key || v.path.starts_with(&format!("{}.", axis.key))) {
                return Err(not_a_front(axis, "the search changes it: it is among the variables of `[optimise]`"));
            }
            values.push(Value { si: axis.si(&typed).unwrap_or(f64::NAN), text: typed, loaded, variables });
        }
        Ok(FrontTask { project: self, axis: axis.clone(), values, unit })
    }
}

fn not_a_front(axis: &Axis, why: &str) -> Refused {
    let mut diagnostics = Diagnostics::default();
    let shown: String = format!("{}={}", axis.key, axis.spec).chars().take(80).collect();
    diagnostics.push(
        Diagnostic::placeless("E0130", format!("`--front {shown}` cannot be searched: {why}"))
            .help("write a range `requirements.stress.safety_factor=1..2:5` or a list `requirements.stress.safety_factor=1,1.5,2`"),
    );
    Refused { diagnostics, sources: Sources::default(), file_missing: false }
}

/// Whether two designs are the same, or near enough that a search from one is one from the other.
fn same(variables: &[Variable], a: &[f64], b: &[f64]) -> bool {
    variables.iter().zip(a.iter().zip(b)).all(|(v, (a, b))| (a - b).abs() <= SAME * v.scale())
}

/// What the full analysis says of a design found.
#[derive(Clone, Copy)]
struct Standing {
    /// The goal, small where it is good.
    goal: f64,
    /// By how much requirements are missed; 0 if they are met, infinite if that is not known.
    missed: f64,
}

impl Standing {
    /// With a goal that is a metric, or not.
    fn of(found: &Optimised, metric: bool) -> Self {
        let (Some(best), Some(after)) = (&found.best, &found.after) else { return Self { goal: f64::INFINITY, missed: f64::INFINITY } };
        let value = after.outcome.metric(&found.wording.objective).map(|m| if found.wording.large { -m.value } else { m.value });
        let goal = if metric { value.unwrap_or(f64::INFINITY) } else { best.goal };
        let complete = after.outcome.status.kind == StatusKind::Complete;
        let missed = if found.met() { 0.0 } else { shortfall(after).max(f64::MIN_POSITIVE) };
        Self { goal, missed: if complete { missed } else { f64::INFINITY } }
    }

    /// Whether it is better than another for the same limits. Of two that both keep to them but for a trifle the goal decides, and the
    /// trifle only if the goals are nearly equal.
    fn beats(self, other: Self) -> bool {
        if self.missed.max(other.missed) > TRIFLE {
            return self.missed < other.missed;
        }
        let least = match (self.missed > 0.0, other.missed > 0.0) {
            (true, false) => SLIGHT,
            (false, true) => -SLIGHT,
            _ => EQUAL,
        };
        self.goal.is_finite() && (!other.goal.is_finite() || other.goal - self.goal > least * other.goal.abs())
    }
}

impl FrontTask<'_> {
    /// How many points there will be.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there are none; never.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The values of the key, as typed.
    pub fn values(&self) -> Vec<String> {
        self.values.iter().map(|v| v.text.clone()).collect()
    }

    /// Searches for it, as [`Loaded::front`].
    ///
    /// # Errors
    /// [`Refused`] if the project cannot be written with other numbers.
    pub fn search(
        &self,
        files: &dyn Files,
        folder: &Path,
        (starts, seed): (Option<u32>, Option<u32>),
        watch: &(dyn Fn(&FrontProgress) -> bool + Sync),
    ) -> Result<Front, Refused> {
        self.project.starts_allowed(starts)?;
        let mut run = Run { task: self, files, folder, asked: (starts, seed), watch, points: Vec::new(), interrupted: false };
        run.forwards()?;
        run.backwards()?;
        run.take()?;
        run.mark();
        Ok(Front {
            key: self.axis.key.clone(),
            spec: self.axis.spec.clone(),
            unit: self.unit.clone(),
            points: run.points,
            asked: self.values.len(),
            interrupted: run.interrupted,
            input_sha256: self.project.input_sha256.clone(),
            metrics: metrics_of(self.project.family),
        })
    }

    /// The name of a point's project file.
    fn file(&self, point: usize) -> String {
        let name = PathBuf::from(self.project.name());
        let digits = self.values.len().to_string().len().max(2);
        format!("{}-front-{:0digits$}.toml", name.file_stem().unwrap_or_default().to_string_lossy(), point + 1)
    }
}

/// A front on the way.
struct Run<'a> {
    task: &'a FrontTask<'a>,
    files: &'a dyn Files,
    folder: &'a Path,
    asked: (Option<u32>, Option<u32>),
    watch: &'a (dyn Fn(&FrontProgress) -> bool + Sync),
    points: Vec<FrontPoint>,
    interrupted: bool,
}

impl Run<'_> {
    /// The search of one point, from these designs beside its own starts.
    fn search(&mut self, (point, pass): (usize, usize), from: Beginnings) -> Result<Optimised, Refused> {
        let value = &self.task.values[point];
        let starts = from.starts.unwrap_or(value.loaded.starts()) as usize + from.more.len();
        let watch = |search: &Progress| (self.watch)(&FrontProgress { point, pass, starts, search: *search });
        let found = value.loaded.optimise_from(self.files, &self.folder.join(self.task.file(point)), from, &watch)?;
        self.interrupted |= found.search.interrupted;
        Ok(found)
    }

    /// Whether the analysis tells the goal.
    fn goal_is_metric(&self) -> bool {
        let objective = self.points.first().map_or("", |p| &p.found.wording.objective);
        metrics_of(self.task.project.family).iter().any(|m| m.name == objective)
    }

    /// The design of a point in the variables of another.
    fn design(&self, of: usize, point: usize) -> Option<Vec<f64>> {
        let found = &self.points[of].found;
        let best = found.best.as_ref()?;
        let variables = &self.task.values[point].variables;
        let value = |v: &Variable| found.variables.iter().position(|o| o.path == v.path).and_then(|i| best.x.get(i)).copied();
        Some(variables.iter().map(|v| value(v).unwrap_or(v.nominal).max(v.lower).min(v.upper)).collect())
    }

    /// Designs of other points, each once and with its point, without those near `known` ones.
    fn designs(&self, others: impl Iterator<Item = usize>, point: usize, mut known: Vec<Vec<f64>>) -> Vec<(usize, Vec<f64>)> {
        let variables = &self.task.values[point].variables;
        let mut found = Vec::new();
        for other in others {
            let Some(x) = self.design(other, point).filter(|x| !known.iter().any(|k| same(variables, k, x))) else { continue };
            known.push(x.clone());
            found.push((other, x));
        }
        found
    }

    /// Each point from its own starts, then from the designs of those before, the nearest first. Apart, because of a search only its best
    /// is analysed in full, and that may not be the best in full.
    fn forwards(&mut self) -> Result<(), Refused> {
        for point in 0..self.task.values.len() {
            let (starts, seed) = self.asked;
            let found = self.search((point, 0), Beginnings { starts, seed, ..Beginnings::default() })?;
            if self.interrupted && found.best.is_none() && point > 0 {
                break;
            }
            let value = &self.task.values[point];
            let mut new = FrontPoint {
                value: value.text.clone(),
                si: value.si,
                origin: Origin::Start(found.search.best.unwrap_or(0)),
                starts: 0,
                evaluations: 0,
                file: self.task.file(point),
                follows: true,
                led: Vec::new(),
                found,
            };
            count(&mut new, None);
            self.points.push(new);
            self.improve((point, 0), (0..point).rev())?;
            if self.interrupted {
                break;
            }
        }
        Ok(())
    }

    /// Each point again from the designs of those after it, the nearest first.
    fn backwards(&mut self) -> Result<(), Refused> {
        (0..self.points.len()).rev().try_for_each(|point| self.improve((point, 1), point + 1..self.points.len()))
    }

    /// Searches for a point from the designs of others that nothing was searched from yet.
    fn improve(&mut self, (point, pass): (usize, usize), others: impl Iterator<Item = usize>) -> Result<(), Refused> {
        let metric = self.goal_is_metric();
        let known = self.points[point].led.iter().map(|[start, _]| start.clone());
        let known = known.chain(self.points[point].found.best.as_ref().map(|b| b.x.clone())).collect();
        let more = self.designs(others, point, known);
        if more.is_empty() || self.interrupted {
            return Ok(());
        }
        let starts = more.iter().map(|m| m.1.clone()).collect();
        let found =
            self.search((point, pass), Beginnings { starts: Some(0), seed: self.asked.1, more: starts, local: true, as_they_are: false })?;
        let own = &mut self.points[point];
        count(own, Some(&found));
        if Standing::of(&found, metric).beats(Standing::of(&own.found, metric)) {
            own.origin = origin(&found, &more).unwrap_or(own.origin);
            own.found = found;
        }
        Ok(())
    }

    /// Where the design of another point keeps a point's limits and has a better goal, it is that of this point too. Not where limits are
    /// kept against scatter, which is another at each design.
    fn take(&mut self) -> Result<(), Refused> {
        let all = 0..self.points.len();
        let designs: Vec<Vec<(usize, Vec<f64>)>> =
            all.clone().map(|point| self.designs(all.clone().filter(|o| *o != point), point, Vec::new())).collect();
        let metric = self.goal_is_metric();
        let before: Vec<Standing> = self.points.iter().map(|p| Standing::of(&p.found, metric)).collect();
        for (point, mut others) in designs.into_iter().enumerate() {
            others.sort_by(|a, b| before[a.0].goal.total_cmp(&before[b.0].goal));
            for (other, x) in others {
                // At the best, it keeps all requirements here.
                let worth = Standing { missed: 0.0, ..before[other] }.beats(before[point]);
                if self.interrupted || self.points[point].found.robustness.is_some() || !worth {
                    break;
                }
                let from = Beginnings { starts: Some(0), seed: self.asked.1, more: vec![x], local: true, as_they_are: true };
                let found = self.search((point, 2), from)?;
                let kept = found.met() && found.best.as_ref().is_some_and(|b| b.feasible(TRIFLE));
                self.points[point].evaluations += evaluations(&found);
                if kept && Standing::of(&found, metric).beats(before[point]) {
                    (self.points[point].found, self.points[point].origin) = (found, Origin::Taken(other));
                    break;
                }
            }
        }
        Ok(())
    }

    /// Marks points to whose design none leads from that of the point before, nor back.
    fn mark(&mut self) {
        for point in 1..self.points.len() {
            let leads = |from: usize, to: usize| {
                let variables = &self.task.values[to].variables;
                let (Some(start), Some(end)) = (self.design(from, to), self.design(to, to)) else { return false };
                let led = |[a, b]: &[Vec<f64>; 2]| same(variables, a, &start) && same(variables, b, &end);
                same(variables, &start, &end) || self.points[to].led.iter().any(led)
            };
            self.points[point].follows = leads(point - 1, point) || leads(point, point - 1);
        }
    }
}

/// The point that the best design was searched for from, if it was one.
fn origin(found: &Optimised, more: &[(usize, Vec<f64>)]) -> Option<Origin> {
    let best = found.best.as_ref()?;
    more.iter().find(|(_, x)| *x == best.start).map(|(point, _)| Origin::Point(*point))
}

fn evaluations(found: &Optimised) -> u64 {
    found.search.evaluations()
}

/// Adds what a search did to a point: another one, or that of its own design.
fn count(point: &mut FrontPoint, found: Option<&Optimised>) {
    let found = found.unwrap_or(&point.found);
    let runs = found.search.runs.iter().map(|r| [r.start.clone(), r.x.clone()]);
    // The best of them may have been searched for further.
    let best = found.best.iter().map(|b| [b.start.clone(), b.x.clone()]);
    let led: Vec<_> = runs.chain(best).collect();
    point.evaluations += evaluations(found);
    point.starts += found.search.runs.len();
    point.led.extend(led);
}
