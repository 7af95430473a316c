//! Cam-and-spring mechanisms with a prescribed force: the family.
//!
//! Source: S. Sánchez-Salinas, A. García-Agúndez, J. López-Martínez, D. García-Vallejo, "Experimental validation of a constant-force
//! mechanism and analysis of its performance with a calibrated multibody model", Mechanism and Machine Theory 173 (2022). Theory,
//! corrections and limits of validity: `docs/theory/cam.md`.

mod analysis;
mod checks;
mod cut;
mod design;
mod duty;
mod explain;
mod figures;
mod influence;
mod jet;
mod law;
mod measured;
mod mechanism;
mod metrics;
mod motion;
mod parts;
mod path;
mod profile_figures;
mod release;
mod reproduce;
mod rest;
mod rules;
mod scene;
mod spec;
mod springs;
mod statements;
mod store;
mod study;
mod synthesis;
mod table;
pub mod torque;

use forcewright_base::diagnostics::{Diagnostics, Explanation};
use forcewright_contract::family::{Analysis, Mechanism as Family, Progress};
use forcewright_contract::metrics::results;
use forcewright_contract::objective::Objectives;
use forcewright_contract::reproduction::Reproduction;
use forcewright_contract::studies::{Free, Purpose as StudyPurpose, Studies};
use forcewright_contract::synthesis::{Skeleton, Synthesiser};
use forcewright_model::{Counter, Curve, Metric, NoPart, Outcome, PartSet};
use forcewright_study::evaluator::Evaluator;
use forcewright_study::task::Task;

use metrics::CamMetrics;

pub use analysis::{Behaviour, Measured, Station, measure};
pub use cut::{Cut, CutError, CutSide, PathPoint, Purpose, SIDES};
pub use design::{Built, Design, DisplayUnits, Material, Requirements};
pub use influence::{Influence, InfluencedStation, ProfileInfluence};
pub use jet::Jet;
pub use law::{ForceLaw, LawError};
pub use measured::{Measured as MeasuredProfile, MeasuredError, Points, RandomProfile, Smoothed, measured as measure_profile};
pub use mechanism::{Bodies, Drive, Instant, Mechanism, NotAssembled, Pose, Sense, SideForces, SpringMass, Stop};
pub use metrics::METRICS;
pub use motion::{Law, Moment, Motion, prescribed};
pub use parts::Making;
pub use path::{Corner, Flaws, NormalError, Place, SidePath, Vector, curvature_per_m, frame};
pub use release::{End, Release, Released, release};
pub use rest::{RestForces, SENSES};
pub use spec::Spec;
pub use springs::{Bank, Spring, SpringLaw};

/// The family.
pub struct Cam;

/// A design of either kind.
#[derive(Clone, Debug)]
pub enum Kind {
    /// Rollers on straight cams move a slider: a force over a travel.
    Slider(Box<Design>),
    /// Rollers on a disc turn a shaft: a torque over an angle.
    Disc(Box<torque::Design>),
}

impl Kind {
    /// The design with a slider; none of a disc.
    pub fn slider(self) -> Option<Design> {
        match self {
            Self::Slider(design) => Some(*design),
            Self::Disc(_) => None,
        }
    }
}

impl Family for Cam {
    type Spec = Spec;
    type Design = Kind;

    const ID: &'static str = "cam";
    const TITLE: &'static str = "Cam-and-spring mechanism";

    fn resolve(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<Kind> {
        if spec.design.disc.present.is_some() {
            return torque::design::resolve(spec, diagnostics).map(|design| Kind::Disc(Box::new(design)));
        }
        design::resolve(spec, diagnostics).map(|design| Kind::Slider(Box::new(design)))
    }

    fn analyse(design: &Kind, progress: Progress<'_>) -> Analysis {
        match design {
            Kind::Slider(design) => analyse_slider(design, progress),
            Kind::Disc(design) => torque::analyse(design, progress),
        }
    }

    fn parts(design: &Kind) -> Result<PartSet, NoPart> {
        match design {
            Kind::Slider(design) => parts::parts(design),
            Kind::Disc(design) => torque::parts::parts(design),
        }
    }

    fn studies(spec: &Spec) -> &Studies {
        &spec.studies
    }

    fn evaluator(spec: &Spec, design: &Kind, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>> {
        match design {
            Kind::Slider(design) => study::evaluator(spec, design, free, diagnostics),
            Kind::Disc(design) => torque::study::evaluator(spec, design, free, diagnostics),
        }
    }

    fn task(spec: &Spec, design: &Kind, free: &[Free], purpose: StudyPurpose, diagnostics: &mut Diagnostics) -> Option<Task> {
        match design {
            Kind::Slider(design) => study::task(spec, design, free, purpose, diagnostics),
            Kind::Disc(design) => torque::study::task(spec, design, free, purpose, diagnostics),
        }
    }

    fn skeleton() -> Option<Skeleton> {
        Some(synthesis::SKELETON)
    }

    fn synthesiser(spec: &Spec, design: &Kind, diagnostics: &mut Diagnostics) -> Option<Box<dyn Synthesiser>> {
        synthesis::synthesiser(spec, torque::no_disc(spec, design, diagnostics)?, diagnostics)
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

/// Analyses a cam with a slider.
fn analyse_slider(design: &Design, progress: Progress<'_>) -> Analysis {
    let stated = [statements::model(design), statements::limits(design)];
    let behaviour = match Behaviour::of(design) {
        Ok(behaviour) => behaviour,
        Err(error) => {
            let message = format!("the cam cannot be cut: {error:?}");
            return Analysis::refused::<Cam>(&design.title, message, stated, statements::sources(design));
        }
    };
    progress(1.0);
    let measured = measure(design, &behaviour);
    let outcome = Outcome {
        mechanism: Cam::ID,
        title: design.title.clone(),
        status: statements::status(design, &behaviour),
        error_estimate: None,
        metrics: metrics_of(design.requirements.as_ref(), &design.units, &measured),
        checks: checks::checks(design, &behaviour, &measured),
        curves: curves_of(design, &behaviour),
        counters: vec![
            Counter { name: "stations", count: (behaviour.stations.len() + behaviour.window.len()) as u64 },
            Counter { name: "path_evaluations", count: behaviour.evaluations },
        ],
        sources: statements::sources(design),
        warnings: statements::warnings(design, &behaviour, &measured),
    };
    let mut figures = figures::figures(design, &behaviour, &measured);
    figures.extend(motion::curves::figure(design, &behaviour));
    let [model, limits] = stated;
    let duty = Some(duty::duty(design, &behaviour, &measured));
    Analysis { outcome, figures, model, limits, duty }
}

/// The metrics as outputs see them.
fn metrics_of(requirements: Option<&Requirements>, units: &DisplayUnits, measured: &Measured) -> Vec<Metric> {
    results::<CamMetrics>(|i| measured.value(i), |i| rules::display_unit(requirements, units, i))
}

/// Curves over the travel and over time.
fn curves_of(design: &Design, behaviour: &Behaviour) -> Vec<Curve> {
    let mut all = figures::curves(design, behaviour);
    all.extend(motion::curves::curves(design, behaviour));
    all
}
