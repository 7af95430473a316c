//! Cable drives with grooved drums: the family.
//!
//! Source: J. M. Longval, C. Gosselin, "Grooved multi-helix high-stiffness capstan drive". Theory, corrections and limits of validity:
//! `docs/theory/capstan.md`.

mod analysis;
mod checks;
mod design;
mod duty;
mod explain;
mod figures;
pub mod geometry;
mod losses;
mod metrics;
mod parts;
mod reproduce;
mod scene;
mod spec;
mod statements;
mod statics;
mod study;
mod synthesis;
mod tension;
mod whole;

use forcewright_base::diagnostics::{Diagnostics, Explanation};
use forcewright_contract::family::{Analysis, Mechanism, Progress};
use forcewright_contract::measuring::{self, Many, Measuring};
use forcewright_contract::metrics::results;
use forcewright_contract::objective::Objectives;
use forcewright_contract::reproduction::Reproduction;
use forcewright_contract::studies::{Free, Purpose, Studies};
use forcewright_contract::synthesis::{Skeleton, Synthesiser};
use forcewright_model::{Counter, NoPart, Outcome, PartSet};
use forcewright_study::evaluator::Evaluator;
use forcewright_study::task::Task;

use metrics::CapstanMetrics;
use study::CableDrives;

pub use analysis::{Behaviour, Measured, NoDrive, measure};
pub use design::{Bearings, Built, Cable, Design, DisplayUnits, Making, Requirements, Seat, Source};
pub use losses::{Losses, Torques, shaft_load_n};
pub use metrics::METRICS;
pub use spec::Spec;
pub use statics::{Loaded, Loop, Place, Statics};

/// The family.
pub struct Capstan;

impl Mechanism for Capstan {
    type Spec = Spec;
    type Design = Design;

    const ID: &'static str = "capstan";
    const TITLE: &'static str = "Cable drive";

    fn resolve(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<Design> {
        design::resolve(spec, diagnostics)
    }

    fn analyse(design: &Design, progress: Progress<'_>) -> Analysis {
        let stated = [statements::model(design), statements::limits(design)];
        let behaviour = match Behaviour::of(design) {
            Ok(behaviour) => behaviour,
            Err(error) => return Analysis::refused::<Self>(&design.title, error.to_string(), stated, statements::sources(design)),
        };
        progress(1.0);
        let measured = measure(design, &behaviour);
        let display = |i: usize| checks::display_unit(design.requirements.as_ref(), &design.units, i);
        let outcome = Outcome {
            mechanism: Self::ID,
            title: design.title.clone(),
            status: statements::status(design, &behaviour),
            error_estimate: None,
            metrics: results::<CapstanMetrics>(|i| measured.value(i), display),
            checks: checks::checks(design, &behaviour, &measured),
            curves: figures::curves(design, &behaviour),
            counters: vec![Counter { name: "states", count: behaviour.states }],
            sources: statements::sources(design),
            warnings: statements::warnings(design, &behaviour, &measured),
        };
        let figures = figures::figures(design, &behaviour, &measured);
        let [model, limits] = stated;
        let duty = Some(duty::duty(design, &measured));
        Analysis { outcome, figures, model, limits, duty }
    }

    fn parts(design: &Design) -> Result<PartSet, NoPart> {
        parts::parts(design)
    }

    fn studies(spec: &Spec) -> &Studies {
        &spec.studies
    }

    fn evaluator(_: &Spec, design: &Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>> {
        Some(Box::new(Many::<CableDrives>::new(design, free, diagnostics)?))
    }

    fn task(spec: &Spec, design: &Design, free: &[Free], _: Purpose, diagnostics: &mut Diagnostics) -> Option<Task> {
        measuring::task::<CableDrives>(design, &spec.studies.optimise.objective, free, diagnostics)
    }

    fn skeleton() -> Option<Skeleton> {
        Some(synthesis::SKELETON)
    }

    fn synthesiser(spec: &Spec, design: &Design, diagnostics: &mut Diagnostics) -> Option<Box<dyn Synthesiser>> {
        synthesis::synthesiser(spec, design, diagnostics)
    }

    fn objectives() -> &'static [Objectives] {
        &[Objectives { of: "", goals: CableDrives::OBJECTIVES }]
    }

    fn explanations() -> &'static [Explanation] {
        explain::CODES
    }

    fn reproductions() -> &'static [Reproduction] {
        reproduce::ALL
    }
}
