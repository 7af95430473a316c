//! Torque cams: a disc on a shaft with two equal lobes between two rollers, which springs draw together or push apart.
//!
//! The core is that of cams with a slider: the work of what is wanted is the energy of the springs. Theory: `docs/theory/cam.md`,
//! "Torque cams".

pub(crate) mod analysis;
pub(crate) mod checks;
mod cut;
pub(crate) mod design;
mod duty;
pub(crate) mod figures;
mod losses;
mod mechanism;
mod motion;
pub(crate) mod outline;
pub(crate) mod parts;
mod room;
mod scene;
pub(crate) mod statements;
pub(crate) mod study;

pub use analysis::{Behaviour, Station};
pub use cut::{Cut, CutError, Purpose};
pub use design::{Built, Design};
pub use mechanism::{Bodies, Corner, Drive, Instant, Mechanism, NotAssembled, Pose, Stop};
pub use motion::{Moment, prescribed};

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_contract::family::{Analysis, Mechanism as _, Progress};
use forcewright_model::{Counter, Outcome};

use crate::spec::Spec;
use crate::{Cam, Kind};

/// Analyses a torque cam.
pub(crate) fn analyse(design: &Design, progress: Progress<'_>) -> Analysis {
    let stated = [statements::model(design), statements::limits(design)];
    let behaviour = match Behaviour::of(design) {
        Ok(behaviour) => behaviour,
        Err(error) => {
            let message = format!("the disc cannot be cut: {error:?}");
            return Analysis::refused::<Cam>(&design.title, message, stated, statements::sources(design));
        }
    };
    progress(1.0);
    let measured = analysis::measure(design, &behaviour);
    let mut checks = checks::checks(design, &behaviour, &measured);
    losses::advise(design, &behaviour, &mut checks);
    let outcome = Outcome {
        mechanism: Cam::ID,
        title: design.title.clone(),
        status: statements::status(design, &behaviour),
        error_estimate: None,
        metrics: crate::metrics_of(design.requirements.as_ref(), &design.units, &measured),
        checks,
        curves: figures::curves(design, &behaviour),
        counters: vec![
            Counter { name: "stations", count: (behaviour.stations.len() + behaviour.window.len()) as u64 },
            Counter { name: "path_evaluations", count: behaviour.evaluations },
        ],
        sources: statements::sources(design),
        warnings: statements::warnings(design, &behaviour, &measured),
    };
    let [model, limits] = stated;
    let duty = Some(duty::duty(design, &behaviour, &measured));
    let figures = figures::figures(design, &behaviour, &measured);
    Analysis { outcome, figures, model, limits, duty }
}

/// The design of a cam with a slider. E0616: synthesis does not know torque cams.
pub(crate) fn no_disc<'a>(spec: &Spec, design: &'a Kind, diagnostics: &mut Diagnostics) -> Option<&'a crate::Design> {
    match design {
        Kind::Slider(design) => Some(design),
        Kind::Disc(_) => {
            let place = spec.design.disc.present.as_ref().map(|p| p.span).unwrap_or_default();
            diagnostics.push(
                Diagnostic::error("E0616", place, "synthesise does not know torque cams")
                    .label("a torque cam")
                    .help("`optimise` searches for a better one from a first design, and `sweep` analyses any number of them"),
            );
            None
        }
    }
}
