//! The family seen by studies.

mod knobs;
mod line;
mod mass;
mod scatter;
mod search;
mod task;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_beam::Drive;
use forcewright_contract::describe::Origin;
use forcewright_contract::objective::Objectives;
use forcewright_contract::studies::{Free, Purpose};
use forcewright_study::evaluator::Evaluator;
use forcewright_study::task::Task;

use crate::design::Design;
use crate::spec::Spec;
use knobs::Knobs;
use scatter::Scatter;

/// What can be optimised.
pub(crate) const OBJECTIVES: &[Objectives] = &[Objectives { of: "", goals: task::OBJECTIVES }];

/// The design as studies that look at many see it.
pub(crate) fn evaluator(spec: &Spec, design: &Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>> {
    check_drive(spec, design, diagnostics)?;
    let knobs = Knobs::new(spec, design, free, Purpose::Scatter, diagnostics)?;
    let place = spec.studies.tolerance.present.as_ref().map(|p| p.span).unwrap_or_default();
    say_what_is_left(&scatter::not_measured(design), "is not looked at by this study", place, diagnostics);
    Some(Box::new(Scatter::new(design, knobs, given(spec))))
}

/// The accuracy that the file asks for.
fn given(spec: &Spec) -> Option<f64> {
    spec.model.accuracy.as_ref().filter(|a| a.origin == Origin::File).map(|a| a.value.si)
}

/// The search that `[optimise]` asks for.
pub(crate) fn task(spec: &Spec, design: &Design, free: &[Free], purpose: Purpose, diagnostics: &mut Diagnostics) -> Option<Task> {
    check_drive(spec, design, diagnostics)?;
    let knobs = Knobs::new(spec, design, free, purpose, diagnostics)?;
    task::task(design, knobs, (&spec.studies.optimise, given(spec)), diagnostics)
}

/// Studies look at forces over a prescribed displacement from rest.
fn check_drive(spec: &Spec, design: &Design, diagnostics: &mut Diagnostics) -> Option<()> {
    if let Some(series) = spec.layout.series.as_ref().filter(|s| s.value > 1) {
        diagnostics.push(
            Diagnostic::error("E0316", series.span, "studies look at one layer: layers in series scatter each by itself, and may part")
                .label("several layers")
                .help("leave out `series` and give the travel of one layer; stack the result"),
        );
        return None;
    }
    if matches!(design.network.drive, Drive::Displacement { .. }) && design.network.before.is_empty() {
        return Some(());
    }
    let span = spec.load.last().map(|l| l.name.span).unwrap_or_default();
    diagnostics.push(
        Diagnostic::error("E0316", span, "studies need one load that prescribes a displacement")
            .label("this load")
            .help("give `travel` instead of `force`, `moment` or `rotation`, and no load before it"),
    );
    None
}

fn say_what_is_left(names: &[&str], what: &str, place: forcewright_base::diagnostics::Span, diagnostics: &mut Diagnostics) {
    for name in names {
        diagnostics.push(Diagnostic::warning("W0511", place, format!("`{name}` {what}")).label("of the requirements"));
    }
}
