//! What an optimisation is asked for, in terms of an evaluator's values.

use std::ops::Range;

use crate::evaluator::Evaluator;

/// Limits on values that are smooth: a requirement, at every station.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// The requirement, in words: "stress".
    pub name: String,
    /// Key in the project file that relaxes it: `requirements.stress`.
    pub key: String,
    /// Names of the checks that it serves: `stress`, `safety_factor`.
    pub checks: Vec<&'static str>,
    /// The values limited, among all.
    pub values: Range<usize>,
    /// Smallest value allowed, SI; −∞ without one.
    pub lower: f64,
    /// Largest value allowed, SI; ∞ without one.
    pub upper: f64,
    /// What is a large change of these values, SI.
    pub scale: f64,
    /// Symbol of the SI unit.
    pub unit: &'static str,
    /// Whether the values are of the stretch in a band, which falls apart where the band is left between two values.
    pub in_band: bool,
}

/// Values that stay within a band around a level: |v/level − 1| ≤ half width.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// The values, among all.
    pub values: Range<usize>,
    /// The level, SI; `None` where it is free.
    pub level: Option<f64>,
    /// The half width; `None` where it is what is minimised.
    pub half_width: Option<f64>,
    /// Names of the checks that it serves: `force`.
    pub checks: Vec<&'static str>,
}

/// What is made small.
#[derive(Clone, Debug, PartialEq)]
pub enum Goal {
    /// The half width of the band without one.
    HalfWidth,
    /// A weighted sum of variables, by their index: a window's length, the thickness.
    Variables(Vec<(usize, f64)>),
    /// A weighted sum of values.
    Values(Vec<(usize, f64)>),
    /// The largest size of some values, of either sign, over their scale.
    Largest {
        /// The values, among all.
        values: Range<usize>,
        /// What is a large change of them, SI.
        scale: f64,
    },
    /// The sum of squares of `(v − target)/scale`.
    Squares {
        /// The values, among all.
        values: Range<usize>,
        /// Wanted, SI, one per value.
        targets: Vec<f64>,
        /// What is a large difference, SI.
        scale: f64,
    },
}

/// What is made small, with what stays within a band meanwhile.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// What is made small.
    pub goal: Goal,
    /// The bands.
    pub bands: Vec<Band>,
    /// Variables kept at their values, by index.
    pub held: Vec<usize>,
}

/// An optimisation: over the variables of an evaluator.
pub struct Task {
    /// Computes the values.
    pub evaluator: Box<dyn Evaluator>,
    /// The goal in words: "`flat_ratio` as large as possible".
    pub title: String,
    /// What is optimised, one after the other, each from where the one before ended: the last is the goal, those before lead to it from
    /// designs that are far away.
    pub steps: Vec<Step>,
    /// The limits, kept in every step.
    pub limits: Vec<Limit>,
    /// Names of the checks of what the goal itself makes better.
    pub sought: Vec<&'static str>,
}

impl Task {
    /// Whether a check of the full analysis is served by a limit, a band or the goal of the search.
    pub fn sees(&self, check: &str) -> bool {
        let bands = self.steps.last().into_iter().flat_map(|s| &s.bands);
        let served = self.limits.iter().map(|l| &l.checks).chain(bands.map(|b| &b.checks));
        served.chain([&self.sought]).any(|own| own.contains(&check))
    }
}

impl std::fmt::Debug for Task {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Task").field("title", &self.title).field("steps", &self.steps).field("limits", &self.limits).finish_non_exhaustive()
    }
}
