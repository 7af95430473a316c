//! What an analysis found: status, metrics, checks, curves.

use forcewright_base::units::{Dimension, Unit};

use crate::{Check, CheckState, Citation, Curve};

/// How a solve ended, in words that scripts may rely on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StatusKind {
    /// Everything asked for was computed to the accuracy asked for.
    Complete,
    /// There is no equilibrium beyond a point of the path (a limit point).
    NoEquilibriumBeyond,
    /// Beyond a point of the path the equilibrium is unstable: a real part leaves it there (a bifurcation).
    UnstableBeyond,
    /// The solver could not go on, for a numerical reason that the message names.
    NotConverged,
    /// Computed, but the accuracy asked for was not reached.
    ReducedAccuracy,
    /// The user stopped it.
    Interrupted,
}

impl StatusKind {
    /// The word in result documents.
    pub fn word(self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::NoEquilibriumBeyond => "no equilibrium beyond",
            Self::UnstableBeyond => "unstable beyond",
            Self::NotConverged => "not converged",
            Self::ReducedAccuracy => "reduced accuracy",
            Self::Interrupted => "interrupted",
        }
    }
}

/// How a solve ended: what was reached, and why it stopped.
#[derive(Clone, Debug)]
pub struct Status {
    /// The kind.
    pub kind: StatusKind,
    /// In words, with the number reached.
    pub message: String,
    /// What to try.
    pub advice: Option<String>,
}

/// A named number.
#[derive(Clone, Debug)]
pub struct Metric {
    /// Stable name for scripts and requirements.
    pub name: &'static str,
    /// Value, SI.
    pub value: f64,
    /// Its quantity.
    pub dimension: Dimension,
    /// The unit in which people are shown it.
    pub display: Unit,
    /// One sentence.
    pub doc: &'static str,
    /// Whether it belongs in the short list that the command line prints.
    pub key: bool,
}

/// A count of work done: exact on every machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counter {
    /// Stable name: `newton_iterations`.
    pub name: &'static str,
    /// How many.
    pub count: u64,
}

/// Something to know about a result.
#[derive(Clone, Debug)]
pub struct Warning {
    /// Stable code; `explain` knows it.
    pub code: &'static str,
    /// In words, with numbers.
    pub message: String,
}

/// What an analysis found.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Family: `compliant`.
    pub mechanism: &'static str,
    /// The project's title.
    pub title: String,
    /// How it ended.
    pub status: Status,
    /// Estimated error of the forces relative to the largest one, where the solver estimates it.
    pub error_estimate: Option<f64>,
    /// Named numbers, in a stable order.
    pub metrics: Vec<Metric>,
    /// Requirements first, in the order of the language; then the family's own checks.
    pub checks: Vec<Check>,
    /// Curves.
    pub curves: Vec<Curve>,
    /// Work done.
    pub counters: Vec<Counter>,
    /// Works whose equations or data were used.
    pub sources: Vec<Citation>,
    /// Things to know.
    pub warnings: Vec<Warning>,
}

impl Outcome {
    /// A metric by name.
    pub fn metric(&self, name: &str) -> Option<&Metric> {
        self.metrics.iter().find(|m| m.name == name)
    }

    /// A curve by name.
    pub fn curve(&self, name: &str) -> Option<&Curve> {
        self.curves.iter().find(|c| c.name == name)
    }

    /// A check by name.
    pub fn check(&self, name: &str) -> Option<&Check> {
        self.checks.iter().find(|c| c.name == name)
    }

    /// Whether every requirement of the project file is met. One that could not be assessed is not met.
    pub fn requirements_met(&self) -> bool {
        self.checks.iter().filter(|c| c.required).all(|c| c.state == CheckState::Met)
    }
}
