//! Forcewright: passive force-shaping mechanisms of robots. A force curve in; a toleranced, manufacturable, calibrated mechanism out.
//!
//! This is the library that programs depend on. A project file is loaded ([`Loaded::from_file`]), understood by its family, and
//! analysed ([`Loaded::solve`]); the report goes to the outputs in [`report`].
//!
//! ```
//! use forcewright::{Choices, Loaded};
//!
//! let text = forcewright::gallery::find("compliant/lan-table3").expect("in the gallery").text;
//! let loaded = Loaded::from_text("lan-table3.toml", text, &Choices::default()).map_err(|e| e.render(false))?;
//! let report = loaded.solve("lan-table3.toml", "", &mut |_| true);
//! let force = report.outcome.metric("force_at_end").expect("the path reaches the end");
//! assert!((force.value - 9.746).abs() < 1e-3);
//! assert!(report.outcome.requirements_met());
//! # Ok::<(), String>(())
//! ```

mod calibrate;
mod compare;
mod export;
mod front;
pub mod gallery;
mod load;
mod optimise;
mod pareto;
mod settings;
pub mod sweep;
mod synthesise;
mod tolerance;

pub use forcewright_base as base;
pub use forcewright_cam as cam;
pub use forcewright_capstan as capstan;
pub use forcewright_compliant as compliant;
pub use forcewright_contract as contract;
pub use forcewright_curves as curves;
pub use forcewright_elements as elements;
pub use forcewright_fabricate as fabricate;
pub use forcewright_lavt as lavt;
pub use forcewright_model as model;
pub use forcewright_report as report;
pub use forcewright_study as study;

pub use calibrate::{Calibrated, NoCalibration};
pub use compare::{Compared, Comparison, MeasureRow, compare};
pub use export::Exported;
pub use forcewright_contract::project::{Choices, DiskFiles, FileError, Files};
pub use front::{Front, FrontPoint, FrontProgress, FrontTask, Origin};
pub use load::{Loaded, Refused};
pub use optimise::{Optimised, Robust, Robustness, Rounded, Wording};
pub use pareto::{Choice as ParetoChoice, Goal as ParetoGoal, Pareto, ParetoDesign, ParetoProgress, ParetoTask};
pub use synthesise::{Designed, Stage, SynthesisProgress, SynthesisTask, Synthesised, Way};
pub use tolerance::{NoTolerance, ToleranceChoices, Toleranced};

use forcewright_base::diagnostics::Explanation;
use forcewright_contract::family::{Entry, Family};
use forcewright_contract::reproduction::Reproduction;

/// The version of this library.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Every family. A new one costs its folder and a line here.
pub static FAMILIES: &[&dyn Family] = &[
    &Entry::<forcewright_compliant::Compliant>::new(),
    &Entry::<forcewright_cam::Cam>::new(),
    &Entry::<forcewright_capstan::Capstan>::new(),
    &Entry::<forcewright_lavt::Lavt>::new(),
];

/// A family by its name in project files.
pub fn family(id: &str) -> Option<&'static dyn Family> {
    FAMILIES.iter().copied().find(|f| f.id() == id)
}

/// The long story of every code, in order.
pub fn explanations() -> impl Iterator<Item = &'static Explanation> {
    let calibrations = forcewright_contract::calibration::CODES;
    let studies = forcewright_contract::scatter::CODES
        .iter()
        .chain(optimise::sizes::CODES)
        .chain(optimise::global::CODES)
        .chain(tolerance::CODES)
        .chain(calibrations)
        .chain(calibrate::CODES)
        .chain(synthesise::CODES)
        .chain(export::CODES)
        .chain(compare::CODES);
    forcewright_contract::codes::CODES.iter().chain(sweep::CODES).chain(studies).chain(FAMILIES.iter().flat_map(|f| f.explanations()))
}

/// Every paper whose numbers are reproduced.
pub fn reproductions() -> impl Iterator<Item = &'static Reproduction> {
    FAMILIES.iter().flat_map(|f| f.reproductions())
}

/// The README's Rust example compiles.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
