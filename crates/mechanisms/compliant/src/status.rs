//! How the solve ended, in words.

use forcewright_base::units::{Dimension, Unit, format_si};
use forcewright_beam::{Jump, Status};
use forcewright_model::{self as model, StatusKind as K};

use crate::analysis::{Behaviour, Measured, Snap};
use crate::design::Design;
use crate::loads::Control;

/// What grows, in words.
struct Words<'a> {
    design: &'a Design,
}

impl Words<'_> {
    fn symbol(&self) -> &'static str {
        match self.design.control {
            Control::Travel => "Δ",
            Control::Force => "F",
        }
    }

    fn what(&self) -> &'static str {
        match self.design.control {
            Control::Travel => "travel",
            Control::Force => "load",
        }
    }

    fn displacement(&self, x_m: f64) -> String {
        format_si(x_m, &self.design.units.displacement, 6)
    }

    /// A force on the drawn network, shown for the whole layout.
    fn force(&self, force_n: f64) -> String {
        format_si(self.design.copies() * force_n, &self.design.units.force, 6)
    }

    fn show(&self, control: f64) -> String {
        match self.design.control {
            Control::Travel => self.displacement(self.design.layers() * control),
            Control::Force => self.force(control),
        }
    }

    /// `Δ = 5 mm`.
    fn at(&self, control: f64) -> String {
        format!("{} = {}", self.symbol(), self.show(control))
    }

    fn node(&self, index: usize) -> &str {
        self.design.node_names.get(index).map_or("?", String::as_str)
    }

    /// What a slowly driven device does at the limit point.
    fn snap(&self, snap: Snap) -> String {
        let jump = match snap {
            Snap::Lands(jump) => jump,
            Snap::Nowhere => {
                return format!("; up to {} this path has no stable state to land on", self.at(self.design.load_end));
            }
        };
        let millijoule = Unit::parse("mJ").unwrap_or_else(|_| Unit::si(Dimension::Energy));
        let energy = format_si(self.design.copies() * jump.released_j, &millijoule, 4);
        let Jump { force_before, force_after, displacement_before, displacement_after, .. } = jump;
        let (short, force) = (
            |x: f64| format_si(x, &self.design.units.displacement, 4),
            |f: f64| format_si(self.design.copies() * f, &self.design.units.force, 4),
        );
        match self.design.control {
            Control::Travel => format!(
                "; driven by displacement it jumps there to another shape, the force from {} to {}, and sets {energy} free",
                force(force_before),
                force(force_after)
            ),
            Control::Force => format!(
                "; driven by a force it jumps there from Δ = {} to {} and sets {energy} free",
                short(displacement_before),
                short(displacement_after)
            ),
        }
    }
}

/// How the solve ended, in words.
pub(crate) fn status(design: &Design, behaviour: &Behaviour, measured: &Measured) -> model::Status {
    let words = Words { design };
    if let Some(failed) = unfinished_stage(&words, behaviour) {
        return failed;
    }
    if let Some((stage, part)) = behaviour.branching_load {
        return branching_load(&words, stage, part);
    }
    if let Some(from) = behaviour.unstable_from_m {
        let end = if behaviour.whole { String::new() } else { format!(" ({})", ending(&words, behaviour).1) };
        return model::Status {
            kind: K::UnstableBeyond,
            message: format!(
                "the path branches at Δ = {}: beyond, a real part leaves the computed shape sideways{end}",
                words.displacement(from)
            ),
            advice: Some(
                "give the design the imperfection of a real part (a small bend, a shifted node) and follow the branch that it takes"
                    .to_owned(),
            ),
        };
    }
    if behaviour.whole && behaviour.curve.is_none() {
        return model::Status {
            kind: K::ReducedAccuracy,
            message: "the node moves back while the force grows: there is no force over the displacement to measure".to_owned(),
            advice: Some("prescribe `travel` instead, or another direction".to_owned()),
        };
    }
    let (kind, message, advice) = ending(&words, behaviour);
    let parts = [Some(message), crate::scenario::status(design, measured), crate::scenario::lateral::status(design, behaviour)];
    let message = parts.into_iter().flatten().collect::<Vec<_>>().join("; ");
    let interrupted = behaviour.lateral.as_ref().is_some_and(|map| map.interrupted);
    model::Status { kind: if interrupted { K::Interrupted } else { kind }, message, advice }
}

fn ending(words: &Words<'_>, behaviour: &Behaviour) -> (K, String, Option<String>) {
    let key = &words.design.load_key;
    let whole = words.show(words.design.load_end);
    let what = words.what();
    match behaviour.path.status {
        Status::Complete => (K::Complete, format!("the whole {what} of {whole} was computed"), None),
        Status::NotResolved { error_estimate, accuracy } => (
            K::ReducedAccuracy,
            format!("the forces are accurate to about {error_estimate:.1e} of the largest one, not to the {accuracy:.1e} asked for"),
            Some("split strongly bent beams, or ask for less by `model.accuracy`".to_owned()),
        ),
        Status::NoEquilibriumBeyond { control } => (
            K::NoEquilibriumBeyond,
            format!(
                "there is no neighbouring equilibrium beyond {}: the mechanism snaps before the {what} of {whole}{}",
                words.at(control),
                behaviour.snap.map_or_else(String::new, |s| words.snap(s))
            ),
            Some(match words.design.control {
                Control::Travel => format!("shorten `{key}` to less than {}, or change the shape", words.show(control)),
                Control::Force => {
                    format!("lower `{key}` to less than {}, prescribe `travel` instead, or change the shape", words.show(control))
                }
            }),
        ),
        Status::PulledStraight { control, beam } => (
            K::NoEquilibriumBeyond,
            format!(
                "beam `{}` is pulled straight at {}: without stretching the force grows without limit",
                words.design.beam_names.get(beam).map_or("?", String::as_str),
                words.at(control)
            ),
            Some(format!("shorten `{key}` to less than {}, or use `model.beam = \"reissner\"`", words.show(control))),
        ),
        Status::StepTooSmall { control } => (
            K::NotConverged,
            format!("the solver's steps became too small at {}", words.at(control)),
            Some(format!("the equilibrium may branch there: break the symmetry of the design a little, or shorten `{key}`")),
        ),
        Status::OverConstrained { beam } => (
            K::NotConverged,
            format!(
                "the force in beam `{}` is undetermined at rest: inextensible beams are over-constrained here",
                words.design.beam_names.get(beam).map_or("?", String::as_str)
            ),
            Some("use `model.beam = \"reissner\"`, or bend the beam a little".to_owned()),
        ),
        Status::Mechanism { node } => (
            K::NotConverged,
            format!("node `{}` can move at rest without a force", words.node(node)),
            Some("add a support, or make a hinge rigid".to_owned()),
        ),
        Status::IterationLimit { control, limit } => (
            K::NotConverged,
            format!("stopped at {} after {limit} Newton iterations", words.at(control)),
            Some(format!("shorten `{key}`, or ask for less by `model.accuracy`")),
        ),
        Status::Stopped { control } => (K::Interrupted, format!("stopped on request at {}", words.at(control)), None),
        _ => (K::NotConverged, "the solver stopped".to_owned(), None),
    }
}

/// A load before the last one that the mechanism does not bear in the computed shape.
fn branching_load(words: &Words<'_>, stage: usize, part: f64) -> model::Status {
    let drives = &words.design.network.before;
    let node = drives.get(stage).map_or("?", |s| words.node(s.drive.node()));
    model::Status {
        kind: K::UnstableBeyond,
        message: format!(
            "load {} of {}, on node `{node}`, passes a branch at {} % of it: a real part leaves the computed shape there",
            stage + 1,
            drives.len() + 1,
            forcewright_base::units::format_number(100.0 * part, 3)
        ),
        advice: Some("lower this load, or give the design the imperfection of a real part (a small bend, a shifted node)".to_owned()),
    }
}

/// A load before the last one that could not be carried out.
fn unfinished_stage(words: &Words<'_>, behaviour: &Behaviour) -> Option<model::Status> {
    let (done, all) = (behaviour.path.before.len(), words.design.network.before.len());
    let stage = words.design.network.before.get(done)?;
    let (Status::NoEquilibriumBeyond { control: reached }
    | Status::StepTooSmall { control: reached }
    | Status::PulledStraight { control: reached, .. }
    | Status::IterationLimit { control: reached, .. }) = behaviour.path.status
    else {
        return None;
    };
    let part = forcewright_base::units::format_number(100.0 * reached / stage.to.abs(), 3);
    let (kind, why) = match behaviour.path.status {
        Status::PulledStraight { .. } => (K::NoEquilibriumBeyond, "a beam is pulled straight at"),
        Status::NoEquilibriumBeyond { .. } => (K::NoEquilibriumBeyond, "there is no neighbouring equilibrium beyond"),
        _ => (K::NotConverged, "the solver came no further than"),
    };
    Some(model::Status {
        kind,
        message: format!(
            "load {} of {}, on node `{}`, cannot be carried out: {why} {part} % of it",
            done + 1,
            all + 1,
            words.node(stage.drive.node())
        ),
        advice: Some("lower this load, or carry it out after another one".to_owned()),
    })
}
