//! Two-speed load-adaptive transmissions of planetary gears and a wrap-spring clutch: the family.
//!
//! Source: C. Butin, D. Chablat, Y. Aoustin, D. Gouaillier, "Design of a Two-Speed Load Adaptive Variable Transmission for Energetic
//! Optimization of an Accessible Prosthetic Hand", J. Mechanisms Robotics 15(1), 2023. Theory, corrections and limits of validity:
//! `docs/theory/lavt.md`.

mod analysis;
mod bench;
mod checks;
mod closing;
mod design;
mod duty;
mod explain;
mod figures;
mod gears;
mod metrics;
mod parts;
mod reproduce;
mod scene;
mod sizes;
mod spec;
mod statements;
mod statics;
mod study;
mod synthesis;

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

use closing::figures::Closings;
use metrics::LavtMetrics;
use study::Transmissions;

pub use analysis::{Behaviour, NoTransmission, Over, measure};
pub use bench::{Bench, Friction, Known, Lines, Mode, Part, Run, Shift, Wave};
pub use closing::{ClosingSettings, Ending, Energies, Grasp, Instant, OneSpeed, Phase, grasp, grasp_one_speed, grasp_with};
pub use design::{
    Battery, Built, Design, DisplayUnits, GearMaterial, Gears, Hand, Lever, Loss, Making, Motor, Requirements, Scatter, Source, Spring,
    WireMaterial,
};
pub use gears::{Tightest, Train};
pub use metrics::{METRICS, Measured};
pub use spec::Spec;
pub use statics::{State, Statics, clutch};

/// The family.
pub struct Lavt;

impl Mechanism for Lavt {
    type Spec = Spec;
    type Design = Design;

    const ID: &'static str = "lavt";
    const TITLE: &'static str = "Two-speed transmission";

    fn resolve(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<Design> {
        design::resolve(spec, diagnostics)
    }

    fn analyse(design: &Design, progress: Progress<'_>) -> Analysis {
        let mut stated = [statements::model(design), statements::limits(design)];
        stated[0].extend(bench::statements(design));
        let behaviour = match Behaviour::of(design) {
            Ok(behaviour) => behaviour,
            Err(error) => return Analysis::refused::<Self>(&design.title, error.to_string(), stated, statements::sources(design)),
        };
        progress(1.0);
        let measured = measure(design, &behaviour);
        let closings = Closings::of(design, &behaviour);
        let display = |i: usize| checks::display_unit(design.requirements.as_ref(), &design.units, i);
        let outcome = Outcome {
            mechanism: Self::ID,
            title: design.title.clone(),
            status: statements::status(design, &behaviour),
            error_estimate: None,
            metrics: results::<LavtMetrics>(|i| measured.value(i), display),
            checks: checks::checks(design, &behaviour, &measured),
            curves: (figures::curves(design, &behaviour).into_iter())
                .chain(bench::curves(design))
                .chain(closings.iter().flat_map(Closings::curves))
                .collect(),
            counters: behaviour.grasp.iter().map(|g| Counter { name: "closing_evaluations", count: g.evaluations }).collect(),
            sources: statements::sources(design),
            warnings: statements::warnings(design, &behaviour).into_iter().chain(bench::warnings(design)).collect(),
        };
        let mut figures = figures::figures(design, &behaviour, &measured);
        figures.extend(bench::figure(design, &behaviour));
        figures.extend(closings.iter().flat_map(Closings::figures));
        let [model, limits] = stated;
        let duty = Some(duty::duty(&measured));
        Analysis { outcome, figures, model, limits, duty }
    }

    fn parts(design: &Design) -> Result<PartSet, NoPart> {
        parts::parts(design)
    }

    fn studies(spec: &Spec) -> &Studies {
        &spec.studies
    }

    fn evaluator(_: &Spec, design: &Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>> {
        Some(Box::new(Many::<Transmissions>::new(&study::drawn(design, free), free, diagnostics)?))
    }

    fn task(spec: &Spec, design: &Design, free: &[Free], purpose: Purpose, diagnostics: &mut Diagnostics) -> Option<Task> {
        let drawn = (purpose == Purpose::Scatter).then(|| study::drawn(design, free));
        measuring::task::<Transmissions>(drawn.as_ref().unwrap_or(design), &spec.studies.optimise.objective, free, diagnostics)
    }

    fn skeleton() -> Option<Skeleton> {
        Some(synthesis::SKELETON)
    }

    fn synthesiser(spec: &Spec, design: &Design, diagnostics: &mut Diagnostics) -> Option<Box<dyn Synthesiser>> {
        synthesis::synthesiser(spec, design, diagnostics)
    }

    fn objectives() -> &'static [Objectives] {
        &[Objectives { of: "", goals: Transmissions::OBJECTIVES }]
    }

    fn explanations() -> &'static [Explanation] {
        explain::CODES
    }

    fn reproductions() -> &'static [Reproduction] {
        reproduce::ALL
    }
}
