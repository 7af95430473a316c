//! The goal of a search in the words of its objective.

use forcewright_base::units::{Unit, format_si};
use forcewright_model::Outcome;
use forcewright_study::task::{Goal, Task};

/// Turns a goal, which is small where it is good, into what the objective asks for.
#[derive(Clone, Debug)]
pub struct Wording {
    /// The quantity: a metric, or what the goal is of it.
    pub name: String,
    /// The unit in which people are shown it.
    pub unit: Unit,
    /// Name of the objective in the project file.
    pub objective: String,
    /// Whether it is made large.
    pub large: bool,
    form: Form,
}

/// How a value follows from a goal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// The goal times this.
    Times(f64),
    /// The root of the mean square: the goal is the sum of squares of this many numbers, times the scale.
    Root { count: f64, scale: f64 },
}

impl Wording {
    pub(super) fn new(task: &Task, objective: &str, large: bool, result: Option<&Outcome>) -> Self {
        let outputs = task.evaluator.outputs();
        let output = |at: usize| outputs.iter().find(|o| o.values.contains(&at));
        let unit_of = |at: usize| output(at).map_or("1", |o| o.unit);
        let sign = if large { -1.0 } else { 1.0 };
        let (name, unit, form) = match task.steps.last().map(|s| &s.goal) {
            // A sum over several values is the objective itself: the hysteresis of many forces is a ratio.
            Some(Goal::Values(weights)) if weights.len() > 1 => {
                let metric = result.and_then(|r| r.metric(objective));
                (objective.to_owned(), metric.map_or("1", |m| m.dimension.si_symbol()), Form::Times(sign))
            }
            Some(Goal::Values(weights)) => {
                let (at, weight) = weights.first().copied().unwrap_or((0, sign));
                (objective.to_owned(), unit_of(at), Form::Times(1.0 / weight))
            }
            // What is made small is the largest value, whatever the objective is called.
            Some(Goal::Largest { values, scale }) if large => {
                let name = output(values.start).map_or(objective, |o| o.name.as_str());
                (format!("largest {name}"), unit_of(values.start), Form::Times(*scale))
            }
            Some(Goal::Largest { values, scale }) => (objective.to_owned(), unit_of(values.start), Form::Times(*scale)),
            Some(Goal::Squares { values, scale, .. }) => {
                let name = if values.len() == 1 { format!("|{objective}|") } else { format!("{objective}, root of the mean square") };
                (name, unit_of(values.start), Form::Root { count: values.len().max(1) as f64, scale: *scale })
            }
            Some(Goal::HalfWidth) => (objective.to_owned(), "%", Form::Times(sign)),
            Some(Goal::Variables(_)) | None => (objective.to_owned(), "1", Form::Times(sign)),
        };
        let own = result.and_then(|r| r.metric(objective)).filter(|m| name == objective && m.dimension.si_symbol() == unit);
        let unit = own.map_or_else(|| display(unit, result), |m| m.display.clone());
        Self { name, unit, objective: objective.to_owned(), large, form }
    }

    /// The goal of a metric's value, if the goal is that metric but for a factor.
    pub(super) fn goal(&self, value: f64) -> Option<f64> {
        match self.form {
            Form::Times(factor) if self.name == self.objective => Some(value / factor),
            _ => None,
        }
    }

    /// The value of a goal, SI.
    pub fn value(&self, goal: f64) -> f64 {
        match self.form {
            Form::Times(factor) => factor * goal,
            Form::Root { count, scale } => scale * (goal.max(0.0) / count).sqrt(),
        }
    }

    /// The value of a goal for people: `flat_ratio 0.686`.
    pub fn show(&self, goal: f64) -> String {
        format!("{} {}", self.name, format_si(self.value(goal), &self.unit, 4))
    }
}

/// The unit in which people are shown a quantity of an SI unit: that of a result where it has one.
pub(super) fn display(si: &str, result: Option<&Outcome>) -> Unit {
    let common = match si {
        "m" => "mm",
        "Pa" => "MPa",
        "N/m" => "N/mm",
        other => other,
    };
    let of_result = result.and_then(|r| r.metrics.iter().find(|m| m.dimension.si_symbol() == si && si != "1"));
    of_result
        .map(|m| m.display.clone())
        .or_else(|| Unit::parse(common).ok())
        .unwrap_or_else(|| Unit::si(forcewright_base::units::Dimension::Ratio))
}
