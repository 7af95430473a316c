//! The narrow waist between mechanisms and studies: numbers in, vectors of numbers out.
//!
//! A family compiles a design into an [`Evaluator`] for some of its numbers. Names are resolved once; after that a study sets numbers
//! and reads *station vectors* (force at displacements, stress at beams), which are smooth, with their exact Jacobian. What people are
//! shown and what limits are set on (a flat range, a largest stress) has kinks; it is computed from the station vectors by
//! [`Evaluator::measure`], so that sampled and linearised studies share one definition.

use std::any::Any;
use std::ops::Range;

/// A number of a design that a study changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Path in the project file: `design.nodes.n3.at.x`; one that stands in no file, as a window's start, has a name without a dot.
    pub path: String,
    /// Symbol of its SI unit; `1` for pure numbers.
    pub unit: &'static str,
    /// Its value in the design, SI.
    pub nominal: f64,
    /// Smallest value that it may take, SI.
    pub lower: f64,
    /// Largest value that it may take, SI.
    pub upper: f64,
}

impl Variable {
    /// Width of its range where that is finite, else the size of its value: what a search counts in. Steps of differences come from elsewhere
    /// ([`crate::differences::Steps`]): a range may be far wider than what matters.
    pub fn scale(&self) -> f64 {
        let width = self.upper - self.lower;
        if width.is_finite() && width > 0.0 { width } else { self.nominal.abs().max(1e-12) }
    }
}

/// A vector of values that belong together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    /// What it is: `force`.
    pub name: String,
    /// Symbol of its SI unit.
    pub unit: &'static str,
    /// Its places among all values.
    pub values: Range<usize>,
}

/// A number for people and limits, computed from the values of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Stable name of the metric: `flat_ratio`.
    pub name: String,
    /// What it is held against, in words: the title of a requirement; empty where nothing is required of it.
    pub requirement: String,
    /// Symbol of its SI unit.
    pub unit: &'static str,
    /// Smallest value that the requirements allow; −∞ without one.
    pub lower: f64,
    /// Largest value that the requirements allow; ∞ without one.
    pub upper: f64,
}

impl Measure {
    /// Whether a value keeps to the requirement; not-a-number does not, unless nothing is required.
    pub fn met(&self, value: f64) -> bool {
        let free = self.lower == f64::NEG_INFINITY && self.upper == f64::INFINITY;
        free || (value >= self.lower && value <= self.upper)
    }
}

/// Values of one design.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evaluation {
    /// All outputs, one after the other, SI.
    pub values: Vec<f64>,
    /// Derivatives: a row per value, a column per variable, SI. Empty if they were not asked for.
    pub jacobian: Vec<f64>,
}

/// Why a design has no values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// In words.
    pub reason: String,
}

/// Room that is reused from design to design; each thread has its own. What it holds never changes a result.
pub struct Workspace(Box<dyn Any + Send>);

impl Workspace {
    /// Room of any kind.
    pub fn new<T: Send + 'static>(room: T) -> Self {
        Self(Box::new(room))
    }

    /// The room, if it is of the kind that its evaluator made.
    pub fn get<T: 'static>(&mut self) -> Option<&mut T> {
        self.0.downcast_mut()
    }
}

impl std::fmt::Debug for Workspace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Workspace")
    }
}

/// A design compiled for a study. A pure function of the numbers that it is given.
pub trait Evaluator: Send + Sync {
    /// The numbers that vary, in the order of every `x`.
    fn variables(&self) -> &[Variable];

    /// The numbers of the project file at `x`, each with its path, SI. One per variable whose path is that of a number; families whose
    /// variables mean several numbers override it.
    fn numbers(&self, x: &[f64]) -> Vec<(String, f64)> {
        self.variables().iter().zip(x).filter(|(v, _)| v.path.contains('.')).map(|(v, x)| (v.path.clone(), *x)).collect()
    }

    /// The vectors computed, in the order of [`Evaluation::values`].
    fn outputs(&self) -> &[Output];

    /// Where the values of an output stand, SI: displacements of a curve. Empty if they stand nowhere in particular.
    fn stations(&self, _output: usize) -> Vec<f64> {
        Vec::new()
    }

    /// Numbers computed from them.
    fn measures(&self) -> &[Measure];

    /// Room for one thread.
    fn workspace(&self) -> Workspace;

    /// Values at `x`, SI, and their Jacobian if `derivatives` is set.
    ///
    /// # Errors
    /// [`Failure`] where the design cannot be built or its path does not reach the end.
    fn evaluate(&self, x: &[f64], derivatives: bool, out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure>;

    /// Derivatives of the values marked in `rows` at `x`, where `out` holds the values; the rows of the others are zero. A family that
    /// keeps what it computed for the values in the workspace overrides it.
    ///
    /// # Errors
    /// As [`Evaluator::evaluate`].
    fn differentiate(&self, x: &[f64], rows: &[bool], out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        self.evaluate(x, true, out, workspace)?;
        crate::differences::keep(rows, self.variables().len(), &mut out.jacobian);
        Ok(())
    }

    /// The measures of values that were evaluated, or extrapolated, at `x`; not a number in `out` where a measure has no value there.
    fn measure(&self, x: &[f64], values: &[f64], out: &mut Vec<f64>, workspace: &mut Workspace);

    /// Values of many designs, `x` one after the other, handed to `sink` in their order. Families that compute several at once override it;
    /// the numbers are the same up to their accuracy, and each is a pure function of its own `x`.
    fn evaluate_all(&self, designs: &[f64], workspace: &mut Workspace, sink: &mut dyn FnMut(usize, Result<&Evaluation, &Failure>)) {
        one_by_one(self, designs, workspace, sink);
    }
}

/// [`Evaluator::evaluate_all`] by [`Evaluator::evaluate`].
pub fn one_by_one<E: Evaluator + ?Sized>(
    evaluator: &E,
    designs: &[f64],
    workspace: &mut Workspace,
    sink: &mut dyn FnMut(usize, Result<&Evaluation, &Failure>),
) {
    let mut out = Evaluation::default();
    for (index, x) in designs.chunks_exact(evaluator.variables().len().max(1)).enumerate() {
        match evaluator.evaluate(x, false, &mut out, workspace) {
            Ok(()) => sink(index, Ok(&out)),
            Err(failure) => sink(index, Err(&failure)),
        }
    }
}
