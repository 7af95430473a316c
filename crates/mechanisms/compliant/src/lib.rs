//! Compliant constant-force mechanisms of flexible beams: the family.
//!
//! Source: C.-C. Lan, J.-H. Wang, Y.-H. Chen, "A Compliant Constant-Force Mechanism for Adaptive Robot End-Effector Operations", IEEE
//! ICRA 2010. Theory, corrections and limits of validity: `docs/theory/compliant.md`.

mod analysis;
mod bodies;
mod checks;
mod crossing;
mod design;
mod duty;
mod endurance;
mod explain;
mod figures;
mod force_curve;
mod layout;
mod loads;
mod material;
mod metrics;
mod pads;
mod parts;
mod reproduce;
mod room;
mod rules;
mod scenario;
mod scene;
mod spec;
mod stack;
mod statements;
mod status;
mod study;
mod sway;
mod synthesis;

use forcewright_base::diagnostics::{Diagnostics, Explanation};
use forcewright_contract::family::{Analysis, Mechanism, Progress};
use forcewright_contract::metrics::results;
use forcewright_contract::objective::Objectives;
use forcewright_contract::reproduction::Reproduction;
use forcewright_contract::studies::{Free, Purpose, Studies};
use forcewright_contract::synthesis::{Skeleton, Synthesiser};
use forcewright_model::{Counter, NoPart, Outcome, PartSet};

use forcewright_study::evaluator::Evaluator;
use forcewright_study::task::Task;

use analysis::display_unit;
use metrics::CompliantMetrics;

pub use analysis::{Behaviour, LargestStress, Measured, Snap, measure};
pub use bodies::{Body, DrawnNode};
pub use crossing::{Crossing, first_crossing};
pub use design::{Design, DisplayUnits, Envelope, Requirements, StressLimit};
pub use endurance::{FatigueLimit, Fibre, Goodman, HoldLimit};
pub use force_curve::{Extrema, ForceCurve, Interval, Turn};
pub use layout::{Circle, Layout, Mirror, Rows};
pub use loads::Control;
pub use material::{Endured, Material};
pub use metrics::METRICS;
pub use parts::Making;
pub use room::{Margin, Nearest, margin, nearest};
pub use scenario::{Contact, Flat, Join, Pass, Profile, Stop, Surface, SurfaceRun, TipPath, Touch, Why};
pub use scenario::{Lateral, LateralMap, Row, Shortfall, Summary, TipState};
pub use spec::Spec;
pub use stack::Stack;
pub use sway::Sway;

/// The family.
pub struct Compliant;

impl Mechanism for Compliant {
    type Spec = Spec;
    type Design = Design;

    const ID: &'static str = "compliant";
    const TITLE: &'static str = "Compliant mechanism of flexible beams";

    fn resolve(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<Design> {
        design::resolve(spec, diagnostics)
    }

    fn analyse(design: &Design, progress: Progress<'_>) -> Analysis {
        let stated = [statements::model(design), statements::limits(design)];
        let behaviour = match Behaviour::of(design, progress) {
            Ok(behaviour) => behaviour,
            Err(error) => return Analysis::refused::<Self>(&design.title, error.to_string(), stated, statements::sources(design)),
        };
        let trusted = behaviour.trusted(design);
        let measured = measure(design, &trusted);
        let counters = behaviour.path.counters;
        let count = |name, count| Counter { name, count };
        let outcome = Outcome {
            mechanism: Self::ID,
            title: design.title.clone(),
            status: status::status(design, &behaviour, &measured),
            error_estimate: behaviour.path.error_estimate.map(|e| e.max(behaviour.interpolation_error)),
            metrics: results::<CompliantMetrics>(|i| measured.value(i), |i| display_unit(design, i)),
            checks: checks::checks(design, &trusted, &measured),
            curves: figures::curves(design, &behaviour, &measured),
            counters: vec![
                count("stations", behaviour.path.points.len() as u64),
                count("polynomial_degree", behaviour.path.degree as u64),
                count("newton_iterations", counters.newton_iterations),
                count("residual_evaluations", counters.residual_evaluations),
                count("factorisations", counters.factorisations),
                count("steps", counters.steps),
                count("rejected_steps", counters.rejected_steps),
            ],
            sources: statements::sources(design),
            warnings: statements::warnings(design, &trusted, &measured),
        };
        let figures = figures::figures(design, &behaviour, &measured);
        let [model, limits] = stated;
        let duty = Some(duty::duty(design, &trusted, &measured));
        Analysis { outcome, figures, model, limits, duty }
    }

    fn parts(design: &Design) -> Result<PartSet, NoPart> {
        parts::parts(design)
    }

    fn studies(spec: &Spec) -> &Studies {
        &spec.studies
    }

    fn evaluator(spec: &Spec, design: &Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>> {
        study::evaluator(spec, design, free, diagnostics)
    }

    fn task(spec: &Spec, design: &Design, free: &[Free], purpose: Purpose, diagnostics: &mut Diagnostics) -> Option<Task> {
        study::task(spec, design, free, purpose, diagnostics)
    }

    fn skeleton() -> Option<Skeleton> {
        Some(synthesis::SKELETON)
    }

    fn synthesiser(spec: &Spec, design: &Design, diagnostics: &mut Diagnostics) -> Option<Box<dyn Synthesiser>> {
        synthesis::synthesiser(spec, design, diagnostics)
    }

    fn objectives() -> &'static [Objectives] {
        study::OBJECTIVES
    }

    fn explanations() -> &'static [Explanation] {
        explain::CODES
    }

    fn reproductions() -> &'static [Reproduction] {
        reproduce::ALL
    }
}
