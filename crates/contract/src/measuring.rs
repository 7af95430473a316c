//! A family seen by studies through its metrics: one curve and every metric at any values of the numbers that vary.
//!
//! Families whose analysis takes microseconds need no more: derivatives are differences. Those with gradients of their own write their
//! evaluators themselves.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_study::differences::{self, Steps};
use forcewright_study::evaluator::{Evaluation, Evaluator, Failure, Measure, Output, Variable, Workspace};
use forcewright_study::task::{self, Limit, Step, Task};

use crate::metrics::{self, Metrics, Values};
use crate::objective::{Goal, goal_of};
use crate::studies::{Free, Objective};

/// Step of a difference, over values that are right to rounding and a few digits more.
const STEP: f64 = 1e-6;

/// What a requirement asks of a metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// Smallest value.
    pub lower: f64,
    /// Largest value.
    pub upper: f64,
    /// Name of the requirement.
    pub requirement: &'static str,
    /// Its path in a project.
    pub key: &'static str,
}

/// What a family provides.
pub trait Measuring: Send + Sync + 'static {
    /// Its metrics.
    type Metrics: Metrics + Send + Sync;
    /// Its design.
    type Design: Clone + Send + Sync;
    /// What a number changes.
    type Knob: Copy + Send + Sync;

    /// Name and SI unit of the curve.
    const CURVE: (&'static str, &'static str);
    /// What can be optimised.
    const OBJECTIVES: &'static [Goal];
    /// What designs of this family are called: "two-speed transmissions".
    const PLURAL: &'static str;

    /// What a path means, or why a study cannot change it.
    ///
    /// # Errors
    /// Why, in a few words.
    fn knob(path: &str) -> Result<Self::Knob, &'static str>;

    /// Sets a number, SI.
    fn set(design: &mut Self::Design, knob: Self::Knob, si: f64);

    /// Places of the curve, SI: the same for every value of the numbers.
    fn stations(base: &Self::Design) -> Vec<f64>;

    /// The curve at its places, and the metrics.
    ///
    /// # Errors
    /// Why nothing could be computed.
    fn evaluated(design: &Self::Design, stations: &[f64], curve: &mut Vec<f64>) -> Result<Values<Self::Metrics>, String>;

    /// What takes the place of a metric that a design lacks though the first one has it: what a limit on it should see; `None` if such a
    /// design counts as failed.
    fn instead(_name: &str) -> Option<f64> {
        None
    }

    /// What the requirements ask of a metric, besides its limits by name.
    fn asked(design: &Self::Design, name: &str) -> Vec<Asked>;

    /// Limits on its metrics.
    fn limits(design: &Self::Design) -> &[metrics::Limit];
}

/// See the module.
pub struct Many<F: Measuring> {
    knobs: Vec<F::Knob>,
    variables: Vec<Variable>,
    base: F::Design,
    stations: Vec<f64>,
    /// Metrics that the design has, by their index.
    metrics: Vec<usize>,
    nominal: Values<F::Metrics>,
    outputs: Vec<Output>,
    measures: Vec<Measure>,
    steps: Steps,
}

impl<F: Measuring> Many<F> {
    /// A design with the numbers that vary; E0313 for one that cannot.
    pub fn new(design: &F::Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Self> {
        let before = diagnostics.errors();
        let mut knobs = Vec::new();
        for free in free {
            match F::knob(&free.number.path) {
                Ok(knob) => knobs.push(knob),
                Err(why) => diagnostics.push(
                    Diagnostic::error("E0313", free.number.span, format!("a study cannot change `{}`", free.number.path))
                        .label(why)
                        .help("take it out of the study's numbers"),
                ),
            }
        }
        let stations = F::stations(design);
        if diagnostics.errors() > before {
            return None;
        }
        // A design that cannot be computed says so when it is evaluated.
        let nominal = F::evaluated(design, &stations, &mut Vec::new()).unwrap_or_else(|_| Values::none());
        let all = F::Metrics::ALL;
        let metrics: Vec<usize> = (0..all.len()).filter(|i| nominal.value(*i).or_else(|| F::instead(all[*i].name)).is_some()).collect();
        let mut outputs = vec![Output { name: F::CURVE.0.to_owned(), unit: F::CURVE.1, values: 0..stations.len() }];
        outputs.extend(metrics.iter().enumerate().map(|(place, index)| {
            let at = stations.len() + place;
            Output { name: all[*index].name.to_owned(), unit: all[*index].dimension.si_symbol(), values: at..at + 1 }
        }));
        let variables = free.iter().map(|free| Variable {
            path: free.number.path.clone(),
            unit: free.number.dimension.si_symbol(),
            nominal: free.number.si,
            lower: free.lower,
            upper: free.upper,
        });
        Some(Self {
            knobs,
            variables: variables.collect(),
            base: design.clone(),
            measures: metrics.iter().map(|index| measure_of::<F>(design, *index)).collect(),
            stations,
            metrics,
            nominal,
            outputs,
            steps: Steps::new(STEP),
        })
    }

    /// Place of a metric among the values.
    fn place(&self, name: &str) -> Option<usize> {
        self.metrics.iter().position(|i| F::Metrics::ALL[*i].name == name).map(|place| self.stations.len() + place)
    }
}

/// A metric with what the requirements ask of it.
fn measure_of<F: Measuring>(design: &F::Design, index: usize) -> Measure {
    let info = &F::Metrics::ALL[index];
    let (mut lower, mut upper, mut requirement) = (f64::NEG_INFINITY, f64::INFINITY, "");
    for asked in F::asked(design, info.name) {
        (lower, upper, requirement) = (lower.max(asked.lower), upper.min(asked.upper), asked.requirement);
    }
    for limit in F::limits(design).iter().filter(|l| l.metric == index) {
        (lower, upper, requirement) = (lower.max(limit.min.unwrap_or(lower)), upper.min(limit.max.unwrap_or(upper)), info.name);
    }
    Measure { name: info.name.to_owned(), requirement: requirement.to_owned(), unit: info.dimension.si_symbol(), lower, upper }
}

impl<F: Measuring> Evaluator for Many<F> {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn stations(&self, output: usize) -> Vec<f64> {
        if output == 0 { self.stations.clone() } else { Vec::new() }
    }

    fn measures(&self) -> &[Measure] {
        &self.measures
    }

    fn workspace(&self) -> Workspace {
        Workspace::new(())
    }

    fn evaluate(&self, x: &[f64], derivatives: bool, out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        let mut design = self.base.clone();
        for (knob, x) in self.knobs.iter().zip(x) {
            F::set(&mut design, *knob, *x);
        }
        out.values.clear();
        let measured = F::evaluated(&design, &self.stations, &mut out.values).map_err(|reason| Failure { reason })?;
        for index in &self.metrics {
            let name = F::Metrics::ALL[*index].name;
            let value = measured.value(*index).or_else(|| F::instead(name));
            out.values.push(value.ok_or_else(|| Failure { reason: format!("{name} has no value") })?);
        }
        out.jacobian.clear();
        if derivatives { self.steps.jacobian(self, x, out, workspace) } else { Ok(()) }
    }

    fn differentiate(&self, x: &[f64], rows: &[bool], out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        self.steps.jacobian(self, x, out, workspace)?;
        differences::keep(rows, self.variables.len(), &mut out.jacobian);
        Ok(())
    }

    fn measure(&self, _: &[f64], values: &[f64], out: &mut Vec<f64>, _: &mut Workspace) {
        out.clear();
        match values.get(self.stations.len()..) {
            Some(metrics) if metrics.len() == self.metrics.len() => out.extend(metrics),
            _ => out.resize(self.measures.len(), f64::NAN),
        }
    }
}

/// The search that `[optimise]` asks for.
pub fn task<F: Measuring>(
    design: &F::Design,
    objective: &crate::describe::Section<Objective>,
    free: &[Free],
    diagnostics: &mut Diagnostics,
) -> Option<Task> {
    let (name, large) = goal_of(objective, F::OBJECTIVES, diagnostics)?;
    for (span, what) in [(objective.window.as_ref().map(|w| w.span), "window"), (objective.target.as_ref().map(|t| t.span), "target")] {
        if let Some(span) = span {
            let error = Diagnostic::error("E0305", span, format!("the objectives of {} have no `{what}`", F::PLURAL)).label("not needed");
            diagnostics.push(error.help("remove it"));
            return None;
        }
    }
    let many = Many::<F>::new(design, free, diagnostics)?;
    let Some(place) = many.place(name) else {
        let at = objective.minimise.as_ref().or(objective.maximise.as_ref()).map(|m| m.span).unwrap_or_default();
        let error = Diagnostic::error("E0302", at, format!("`{name}` has no value for this design")).label("this objective");
        diagnostics.push(error.help("`solve` says what is missing for it"));
        return None;
    };
    let scale = |name: &str| many.nominal.get(name).map_or(1.0, f64::abs).max(1e-9);
    let limits = many.measures.iter().filter(|m| !m.requirement.is_empty() && m.name != name).filter_map(|m| {
        let at = many.place(&m.name)?;
        let typed = F::asked(design, &m.name).first().map(|a| a.key.to_owned());
        let key = typed.unwrap_or_else(|| format!("requirements.limits.{}", m.name));
        // A check is called after its requirement, or after the metric that is limited by name.
        let asked = F::asked(design, &m.name).into_iter().map(|a| a.requirement);
        let checks = F::Metrics::ALL.iter().filter(|i| i.name == m.name).map(|i| i.name).chain(asked).collect();
        let (values, unit, scale) = (at..at + 1, m.unit, scale(&m.name));
        Some(Limit { name: m.requirement.clone(), key, checks, values, lower: m.lower, upper: m.upper, scale, unit, in_band: false })
    });
    let limits = limits.collect();
    let sign = if large { -1.0 } else { 1.0 };
    let goal = task::Goal::Values(vec![(place, sign / scale(name))]);
    let title = format!("`{name}` as {} as possible", if large { "large" } else { "small" });
    let sought = std::iter::once(name).chain(F::asked(design, name).into_iter().map(|a| a.requirement)).collect();
    Some(Task { evaluator: Box::new(many), title, steps: vec![Step { goal, bands: Vec::new(), held: Vec::new() }], limits, sought })
}
