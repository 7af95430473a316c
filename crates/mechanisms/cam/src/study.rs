//! The family seen by studies.

pub(crate) mod knobs;
pub(crate) mod many;
mod sensitivity;
pub(crate) mod task;

use forcewright_base::diagnostics::Diagnostics;
use forcewright_contract::objective::Objectives;
use forcewright_contract::studies::{Free, Purpose};
use forcewright_study::evaluator::Evaluator;
use forcewright_study::task::Task;

use crate::design::Design;
use crate::spec::Spec;
use knobs::Knobs;
use many::Many;

/// What can be optimised.
pub(crate) const OBJECTIVES: &[Objectives] =
    &[Objectives { of: "cams with a slider", goals: task::FORCE.goals }, Objectives { of: "torque cams", goals: task::TORQUE.goals }];

pub(crate) use sensitivity::Scatter;

/// The design as studies that look at many see it.
pub(crate) fn evaluator(spec: &Spec, design: &Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>> {
    let knobs = Knobs::new(spec, free, Purpose::Scatter, diagnostics)?;
    Some(Box::new(Many::new(design, knobs)))
}

/// The search that `[optimise]` asks for.
pub(crate) fn task(spec: &Spec, design: &Design, free: &[Free], purpose: Purpose, diagnostics: &mut Diagnostics) -> Option<Task> {
    let knobs = Knobs::new(spec, free, purpose, diagnostics)?;
    let many = Many::new(design, knobs);
    let wanted = many.wanted_n();
    let asked = (&task::FORCE, wanted.as_slice());
    task::task(Box::new(many), asked, design.requirements.as_ref(), &spec.studies.optimise.objective, diagnostics)
}
