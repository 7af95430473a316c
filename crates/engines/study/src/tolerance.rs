//! How well a design survives its making: many designs drawn from the scatter of its numbers, and what becomes of its requirements.
//!
//! [`study`] sees an [`Evaluator`] and a [`Population`], never a mechanism. Designs are drawn by scrambled Sobol points in independent
//! replicates, evaluated in chunks on all threads, and counted in the order of their numbers: the same bits for any number of threads.
//! Beside what was sampled stands what the Jacobian of the station vectors says ([`Linear`]), which also tells what tolerance each
//! parameter would need; [`Tornado`] and Sobol indices tell which of them matter.

mod linear;
mod run;
mod shares;

use std::fmt;

pub use linear::{Linear, MOST_SCALE, Needed};
pub use shares::{Share, Tornado};

use crate::evaluator::{Evaluation, Evaluator, Failure, Measure, Output, Variable};
use crate::sampling::{Confidence, Fan, Population, SensitivityError, SobolError, Yield, YieldTally};

/// Independent replicates of the sample: enough for an interval of the yield.
pub const REPLICATES: usize = 16;

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Plan {
    /// How the variables of the evaluator scatter, in their order.
    pub population: Population,
    /// Designs to draw; rounded up to a multiple of [`REPLICATES`]. A power of two is best.
    pub samples: u64,
    /// Decides which.
    pub seed: u64,
    /// The yield asked for, between ½ and 1 for the needed tolerances.
    pub target: f64,
    /// Of all intervals.
    pub confidence: Confidence,
    /// Designs of the linearised estimate, likewise rounded up.
    pub linear_samples: u64,
    /// Points per replicate behind the Sobol indices, each of which costs a design per independent factor and two more; 0 for none.
    pub sensitivity_points: u64,
}

impl Plan {
    /// A plan with the usual sizes: 16 384 linear samples, 32 points per replicate for the indices.
    pub fn new(population: Population, samples: u64, seed: u64, target: f64) -> Self {
        Self { population, samples, seed, target, confidence: Confidence::P95, linear_samples: 1 << 14, sensitivity_points: 32 }
    }
}

/// Why there is no study.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ToleranceError {
    /// Not one distribution per variable.
    Shape {
        /// Variables.
        variables: usize,
        /// Distributions.
        distributions: usize,
    },
    /// More variables than there are points for.
    Points(SobolError),
    /// No plan for the indices.
    Sensitivity(SensitivityError),
    /// The nominal design has no values.
    Nominal(Failure),
}

impl fmt::Display for ToleranceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape { variables, distributions } => write!(f, "{variables} variables have {distributions} distributions"),
            Self::Points(error) => error.fmt(f),
            Self::Sensitivity(error) => error.fmt(f),
            Self::Nominal(failure) => write!(f, "the nominal design has no curve: {}", failure.reason),
        }
    }
}

impl std::error::Error for ToleranceError {}

/// Part of the designs that keep to a requirement.
#[derive(Clone, Debug)]
pub struct Kept {
    /// Index of the measure.
    pub measure: usize,
    /// The part, with its interval.
    pub found: Yield,
}

/// Why designs have no values, and how many.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reason {
    /// In the words of the first of them.
    pub text: String,
    /// Designs with this reason; numbers in the words are not told apart.
    pub count: u64,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Study {
    /// The outputs of the evaluator.
    pub outputs: Vec<Output>,
    /// Where the values of each stand, SI; empty where they stand nowhere in particular.
    pub stations: Vec<Vec<f64>>,
    /// The measures of the evaluator.
    pub measures: Vec<Measure>,
    /// Those that something is required of, or all where nothing is: what [`Study::tornado`] and [`Study::shares`] are about.
    pub limiting: Vec<usize>,
    /// The variables of the evaluator.
    pub variables: Vec<Variable>,
    /// The nominal design's values, SI.
    pub nominal: Vec<f64>,
    /// The nominal design's measures, SI.
    pub nominal_measures: Vec<Option<f64>>,
    /// Part of the designs that keep to everything; one without values does not.
    pub all: Yield,
    /// The same for each measure with a limit.
    pub kept: Vec<Kept>,
    /// Designs without values, most frequent reason first.
    pub failures: Vec<Reason>,
    /// A station per value: the fan of every output.
    pub fan: Fan,
    /// A station per measure: its distribution.
    pub spread: Fan,
    /// What the Jacobian says; `None` if a neighbour of the nominal design has no values.
    pub linear: Option<Linear>,
    /// Ends of each variable, all others nominal, largest effect first. Empty if the study was interrupted before.
    pub tornado: Vec<Tornado>,
    /// Shares of the variance of each limiting measure that varies, per factor of [`Population::factors`].
    pub shares: Vec<Share>,
    /// The sets of variables that scatter independently of each other.
    pub factors: Vec<Vec<usize>>,
    /// The yield asked for.
    pub target: f64,
    /// Whether it was stopped: what is there is of the designs drawn until then.
    pub interrupted: bool,
}

impl Study {
    /// Whether the yield asked for is reached.
    pub fn target_met(&self) -> bool {
        self.all.estimate.value >= self.target
    }

    /// Whether linearised and sampled yield differ by more than the interval and two points of per cent: then the linearisation, and
    /// what rests on it, is not good enough.
    pub fn linear_is_off(&self) -> bool {
        let apart = |sampled: &Yield, linear: &Yield| {
            let value = linear.estimate.value;
            !sampled.estimate.interval.contains(value) && (value - sampled.estimate.value).abs() > 0.02
        };
        self.linear.as_ref().is_some_and(|linear| {
            apart(&self.all, &linear.all) || self.kept.iter().zip(&linear.kept).any(|(a, b)| apart(&a.found, &b.found))
        })
    }
}

/// Counts verdicts of designs, in their order.
struct Verdicts<'a> {
    measures: &'a [Measure],
    limited: &'a [usize],
    all: YieldTally,
    each: Vec<YieldTally>,
    next: usize,
}

impl<'a> Verdicts<'a> {
    fn new(measures: &'a [Measure], limited: &'a [usize]) -> Self {
        let tally = YieldTally::new(REPLICATES);
        Self { measures, limited, each: vec![tally.clone(); limited.len()], all: tally, next: 0 }
    }

    /// Counts the next design; `None` has no values.
    fn add(&mut self, found: Option<&[f64]>) {
        let mut good = found.is_some();
        for (tally, index) in self.each.iter_mut().zip(self.limited) {
            let met = found.is_some_and(|values| self.measures[*index].met(values.get(*index).copied().unwrap_or(f64::NAN)));
            tally.record(self.next, met);
            good &= met;
        }
        self.all.record(self.next, good);
        self.next += 1;
    }

    fn kept(&self, confidence: Confidence) -> Vec<Kept> {
        self.limited.iter().zip(&self.each).map(|(measure, tally)| Kept { measure: *measure, found: tally.estimate(confidence) }).collect()
    }
}

/// The measures with a limit.
fn limited(measures: &[Measure]) -> Vec<usize> {
    (0..measures.len()).filter(|i| measures[*i].lower > f64::NEG_INFINITY || measures[*i].upper < f64::INFINITY).collect()
}

/// A measure that has a value.
fn known(value: f64) -> Option<f64> {
    (!value.is_nan()).then_some(value)
}

/// A multiple of the replicates.
fn rounded(samples: u64) -> u64 {
    samples.max(1).div_ceil(REPLICATES as u64).saturating_mul(REPLICATES as u64)
}

/// Draws the designs and judges them. `watch` is given the finished fraction and says whether to go on.
///
/// # Errors
/// [`ToleranceError`]: distributions that do not fit the variables, or a nominal design without values.
pub fn study(evaluator: &dyn Evaluator, plan: &Plan, watch: &mut dyn FnMut(f64) -> bool) -> Result<Study, ToleranceError> {
    let (variables, measures) = (evaluator.variables(), evaluator.measures());
    if variables.len() != plan.population.len() {
        return Err(ToleranceError::Shape { variables: variables.len(), distributions: plan.population.len() });
    }
    let limited = limited(measures);
    let limiting = if limited.is_empty() { (0..measures.len()).collect() } else { limited.clone() };
    let x: Vec<f64> = variables.iter().map(|v| v.nominal).collect();
    let mut workspace = evaluator.workspace();
    let mut nominal = Evaluation::default();
    evaluator.evaluate(&x, false, &mut nominal, &mut workspace).map_err(ToleranceError::Nominal)?;
    let mut measured = Vec::new();
    evaluator.measure(&x, &nominal.values, &mut measured, &mut workspace);
    let nominal_measures = measured.into_iter().map(known).collect();

    let shares_plan = shares::plan(plan, variables.len()).map_err(ToleranceError::Sensitivity)?;
    let rows = shares_plan.as_ref().map_or(0, |p| p.rows(plan.sensitivity_points));
    let samples = rounded(plan.samples);
    let whole = (samples + rows) as f64;
    let mut done = 0.0;
    let mut stage = |part: f64, begun: f64| watch((begun + part) / whole);

    let points = run::points(plan, samples)?;
    let mut sampled = Sampled::new(measures, &limited, nominal.values.len());
    let finished =
        run::designs(evaluator, &plan.population, &points, &mut |made| stage(made as f64, done), &mut |chunk| sampled.add(chunk));
    let mut study = sampled.into_study(plan, variables, limiting, (nominal.values, nominal_measures));
    study.outputs = evaluator.outputs().to_vec();
    study.stations = (0..study.outputs.len()).map(|output| evaluator.stations(output)).collect();
    study.interrupted = !finished;
    if !finished {
        return Ok(study);
    }
    done = samples as f64;
    study.tornado = shares::tornado(evaluator, &plan.population, &study, &mut workspace);
    if let Some(shares_plan) = &shares_plan {
        let found = shares::of_variance(evaluator, plan, shares_plan, &study, &mut |made| stage(made as f64, done));
        study.interrupted = found.is_none();
        study.shares = found.unwrap_or_default();
    }
    if !study.interrupted {
        study.linear = linear::estimate(evaluator, plan, &study, &limited, &mut workspace);
    }
    Ok(study)
}

/// What is counted while designs come in.
struct Sampled<'a> {
    verdicts: Verdicts<'a>,
    fan: Fan,
    spread: Fan,
    reasons: run::Reasons,
    /// Chunks that are not yet in the fans.
    waiting: Vec<run::Chunk>,
}

/// Chunks that go into the fans at once: the bins of a station, which are more than the nearest memory holds for all of them, are then
/// at hand for most of their values.
const TOGETHER: usize = 16;

impl<'a> Sampled<'a> {
    fn new(measures: &'a [Measure], limited: &'a [usize], values: usize) -> Self {
        let verdicts = Verdicts::new(measures, limited);
        let (fan, spread) = (Fan::new(values), Fan::new(measures.len()));
        Self { verdicts, fan, spread, reasons: run::Reasons::default(), waiting: Vec::with_capacity(TOGETHER) }
    }

    fn add(&mut self, chunk: run::Chunk) {
        for design in chunk.designs() {
            self.verdicts.add(design.ok());
            if let Err(reason) = design {
                self.reasons.add(reason);
            }
        }
        self.waiting.push(chunk);
        if self.waiting.len() == TOGETHER {
            self.empty();
        }
    }

    fn empty(&mut self) {
        self.fan.add_all(&self.waiting.iter().flat_map(run::Chunk::values));
        self.spread.add_all(&self.waiting.iter().flat_map(run::Chunk::measures));
        self.waiting.clear();
    }

    fn into_study(
        mut self,
        plan: &Plan,
        variables: &[Variable],
        limiting: Vec<usize>,
        (nominal, nominal_measures): (Vec<f64>, Vec<Option<f64>>),
    ) -> Study {
        self.empty();
        Study {
            outputs: Vec::new(),
            stations: Vec::new(),
            measures: self.verdicts.measures.to_vec(),
            limiting,
            variables: variables.to_vec(),
            nominal,
            nominal_measures,
            all: self.verdicts.all.estimate(plan.confidence),
            kept: self.verdicts.kept(plan.confidence),
            failures: self.reasons.sorted(),
            fan: self.fan,
            spread: self.spread,
            linear: None,
            tornado: Vec::new(),
            shares: Vec::new(),
            factors: plan.population.factors(),
            target: plan.target,
            interrupted: false,
        }
    }
}

#[cfg(test)]
mod tests;
