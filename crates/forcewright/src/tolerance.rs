//! From `±` and `[tolerance]` to the yield of a design.

pub(crate) mod document;
mod page;
mod picture;

use std::fmt;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Explanation, Sources};
use forcewright_base::units::{Dimension, Tolerance, Unit};
use forcewright_contract::describe::Slot;
use forcewright_contract::family::Progress;
use forcewright_contract::scatter::Scattering;
use forcewright_model::Report;
use forcewright_study::sampling::Population;
use forcewright_study::tolerance::{Plan, Study, ToleranceError, study};

use crate::{Loaded, Refused};

/// Samples, seed and target where the file gives none: as its description says.
const SAMPLES: u32 = 4096;
const SEED: u32 = 1;
const TARGET: f64 = 0.95;

/// Codes of tolerance studies beyond those of the project file.
pub(crate) const CODES: &[Explanation] = &[
    Explanation {
        code: "E0324",
        title: "the nominal design has no curve",
        text: "A tolerance study begins with the design as it is meant. That one does not reach the end of its travel, or cannot be built; `forcewright solve` says why. Exit code 3.",
    },
    Explanation {
        code: "W0512",
        title: "the linearised estimate is off",
        text: "The yield from the Jacobian at the nominal design differs from the sampled one by more than the interval and two points of per cent: over the scatter of this design, the requirements do not follow the parameters linearly. Believe the sampled yield; the needed tolerances, which rest on the linearisation, are a hint only.",
    },
    Explanation {
        code: "W0513",
        title: "nothing is required",
        text: "The yield is the part of the designs that keep to the requirements. Without any, it is the part that reaches the end of the travel. Add `[requirements]`.",
    },
];

/// What replaces the words of the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ToleranceChoices {
    /// Designs drawn.
    pub samples: Option<u32>,
    /// Seed of the draws.
    pub seed: Option<u32>,
    /// Designs of the linearised yield; without it 16 384.
    pub linear: Option<u32>,
}

/// Why there is no yield.
#[derive(Debug)]
pub enum NoTolerance {
    /// The project asks for what cannot be done.
    Refused(Refused),
    /// The study could not begin.
    Study(ToleranceError),
}

impl fmt::Display for NoTolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(refused) => f.write_str(&refused.render(false)),
            Self::Study(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for NoTolerance {}

/// The yield of a design, and what it depends on.
pub struct Toleranced {
    /// What was found.
    pub study: Study,
    /// How the numbers scatter, in the order of the study's variables.
    pub population: Population,
    /// The unit in which each was typed.
    pub units: Vec<Unit>,
    /// The tolerance that was typed behind each, if one was.
    pub typed: Vec<Option<Tolerance>>,
    /// Designs asked for.
    pub samples: u32,
    /// Seed of the draws.
    pub seed: u32,
    /// The design as it is meant.
    pub nominal: Report,
    /// What was said about the study.
    pub diagnostics: Diagnostics,
    /// The texts that they point into.
    pub sources: Sources,
}

impl Loaded {
    /// Draws designs from the scatter of making, as `±` and `[tolerance]` of the project say, and judges each by the requirements. The
    /// result depends on the project, samples and seed only: the same bits on any machine with any number of threads.
    ///
    /// ```
    /// use forcewright::{Choices, Loaded, ToleranceChoices};
    ///
    /// let text = forcewright::gallery::find("lan-table3").expect("in the gallery").text;
    /// let loaded = Loaded::from_text("lan-table3.toml", text, &Choices::default()).map_err(|e| e.render(false))?;
    /// // The file has 1 mm ± 0.02 mm, three standard deviations: 64 designs tell little more than that most are good.
    /// let choices = ToleranceChoices { samples: Some(64), ..ToleranceChoices::default() };
    /// let found = loaded.tolerance(choices, &mut |_| true).map_err(|e| e.to_string())?;
    /// assert_eq!(found.study.variables[0].path, "design.thickness");
    /// // F ∝ w³: two per cent of the thickness are six of the force, and the band is five wide.
    /// assert!(found.study.all.estimate.value > 0.5 && found.study.all.samples == 64);
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// [`NoTolerance`]: nothing scatters, what scatters cannot vary, or the nominal design has no curve.
    pub fn tolerance(&self, choices: ToleranceChoices, progress: Progress<'_>) -> Result<Toleranced, NoTolerance> {
        let mut diagnostics = Diagnostics::default();
        let section = &self.understood.studies().tolerance;
        let place = section.present.as_ref().map_or(self.project.root, |p| p.span);
        let scattering = section.scattering(self.understood.numbers(), place, &mut diagnostics);
        let ready = scattering.and_then(|s| Some((self.understood.evaluator(&s.free, &mut diagnostics)?, s)));
        let Some((evaluator, Scattering { free, population })) = ready.filter(|_| !diagnostics.has_errors()) else {
            let sources = self.project.sources.clone();
            return Err(NoTolerance::Refused(Refused { diagnostics, sources, file_missing: false }));
        };
        let of = |slot: &Slot<u32>, usual: u32| slot.as_ref().map_or(usual, |s| s.value);
        let samples = choices.samples.unwrap_or_else(|| of(&section.samples, SAMPLES));
        let seed = choices.seed.unwrap_or_else(|| of(&section.seed, SEED));
        let target = section.target.as_ref().map_or(TARGET, |t| t.value.si);
        let usual = Plan::new(population.clone(), u64::from(samples), u64::from(seed), target);
        let plan = Plan { linear_samples: choices.linear.map_or(usual.linear_samples, u64::from), ..usual };
        let study = study(&*evaluator, &plan, progress).map_err(NoTolerance::Study)?;
        if study.measures.iter().all(|m| m.requirement.is_empty()) {
            let help = "add `[requirements]`, such as `force = { nominal = \"10 N\", band = \"5 %\" }`";
            diagnostics.push(Diagnostic::warning("W0513", place, "nothing is required of this design").label("in this file").help(help));
        }
        if study.linear_is_off() {
            diagnostics.push(
                Diagnostic::warning("W0512", place, "the linearised yield differs from the sampled one; needed tolerances are a hint only")
                    .label("in this file"),
            );
        }
        let nominal = self.solve("", "", &mut |_| true);
        let units = free.iter().map(|f| f.number.unit.clone()).collect();
        let typed = free.iter().map(|f| f.number.tolerance).collect();
        Ok(Toleranced { study, population, units, typed, samples, seed, nominal, diagnostics, sources: self.project.sources.clone() })
    }
}

impl Toleranced {
    /// The unit in which people are shown a measure: that of the metric of the same name.
    pub fn unit_of(&self, measure: usize) -> Unit {
        let Some(measure) = self.study.measures.get(measure) else { return Unit::si(Dimension::Ratio) };
        let metric = self.nominal.outcome.metric(&measure.name).map(|m| m.display.clone());
        metric.unwrap_or_else(|| display(measure.unit))
    }
}

/// A unit for people of values in an SI unit.
fn display(symbol: &str) -> Unit {
    let handy = match symbol {
        "m" => "mm",
        "Pa" => "MPa",
        "N/m" => "N/mm",
        "1" => "%",
        other => other,
    };
    Unit::parse(handy).unwrap_or_else(|_| Unit::si(Dimension::Ratio))
}
