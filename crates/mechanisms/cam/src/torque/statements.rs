//! What a report says in words: status, model, limits, sources, warnings.

use forcewright_base::units::format_si;
use forcewright_model::{Citation, Statement, Status, StatusKind, Warning};

use super::analysis::Behaviour;
use super::design::Design;
use super::mechanism::Stop;
use crate::analysis::{LOCKED_FROM, Measured};
use crate::mechanism::Sense;
use crate::statements::{cited, locked_start, sliding, statement};

/// How the analysis ended.
pub(crate) fn status(design: &Design, behaviour: &Behaviour) -> Status {
    let turn = |rad: f64| format_si(rad, &design.units.travel, 4);
    if let Some((at, Stop::Locks(sense))) = behaviour.stopped {
        let way = if sense == Sense::Down { "back" } else { "against the springs" };
        return Status {
            kind: StatusKind::NotConverged,
            message: format!("at a turn of {} friction locks the rollers: no torque turns the disc {way}", turn(at)),
            advice: Some("make `rolling_arm` or `guide_friction` smaller, or `start_radius` larger: the pressure angle is too large for so much friction".to_owned()),
        };
    }
    if let Some((at, Stop::NotAssembled(why))) = behaviour.stopped {
        return Status {
            kind: StatusKind::NotConverged,
            message: format!(
                "from a turn of {} on no roller stands on the disc: it misses its guide by {}",
                turn(at),
                format_si(why.gap_m.abs(), &design.units.length, 3)
            ),
            advice: Some("choose rollers nearer to those for which the disc was cut".to_owned()),
        };
    }
    if design.motion.is_some() && behaviour.motion.is_none() {
        return Status {
            kind: StatusKind::NotConverged,
            message: "the motion passes places where no roller stands on the disc, or needs more than any torque".to_owned(),
            advice: Some("begin it a little later, or shorten `motion.rise_turn`".to_owned()),
        };
    }
    let message = format!("computed over the whole turn of {}, up and down", turn(design.purpose.turn_rad));
    Status { kind: StatusKind::Complete, message, advice: None }
}

/// Which equations were solved and how.
pub(crate) fn model(design: &Design) -> Vec<Statement> {
    let path = if design.purpose.friction == 0.0 && design.purpose.guide_friction == 0.0 {
        "The work of the wanted torque equals the energy of the springs, ∫T dθ = E: the path of the rollers' centres on the disc follows in closed form. Derivatives are exact."
    } else {
        "The path follows from the balance of the torques with friction in one direction, integrated over the springs' deformation with a method of fifth order. Derivatives come from the equation itself."
    };
    vec![
        statement("Cam", path),
        statement(
            "Forces",
            "One roller with its follower along its guide tells both: the lobes are equal and half a turn apart, so that the shaft carries a torque and no force. Rolling resistance is a force μN against the way of the roller, μ the arm over the radius; friction of a guide is in proportion to the force across it.",
        ),
        statement(
            "Window",
            "Means, standard deviations and the loop are integrals over the turn of the window by Simpson's rule on 400 panels; extremes are taken at their ends and middles.",
        ),
    ]
}

/// What is not modelled.
pub(crate) fn limits(design: &Design) -> Vec<Statement> {
    let mut all = vec![
        statement("Rigid parts", "Axles, guides, shaft and cam do not bend; the contact between roller and cam is stiff."),
        statement(
            "Friction",
            "Rolling resistance and friction of the guides. Friction in the shaft's bearings, in the rollers' axles and between the coils of springs is not in the numbers.",
        ),
        statement(
            "Plane",
            "The springs are taken in the plane of the disc, between the axles: as a pair, one before and one behind the disc, they pass the shaft. The guides are level, so that weight does no work.",
        ),
    ];
    if design.motion.is_some() {
        all.push(statement(
            "Contact in the motion",
            "The rollers are kept on the cam also where they would lift off; the check of the contact says where that is.",
        ));
    }
    all
}

/// Works that were used.
pub(crate) fn sources(design: &Design) -> Vec<Citation> {
    cited("springs between two rollers on a cam, rolling friction as an arm over a radius; the disc is not theirs", &design.materials)
}

/// Things to know about a result.
pub(crate) fn warnings(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Warning> {
    let mut all = Vec::new();
    let turn = |rad: f64| format_si(rad, &design.units.travel, 4);
    let lost = measured.get("undercut_turn").unwrap_or(0.0);
    if lost > 0.0 && behaviour.window_rad[0] < lost {
        all.push(Warning {
            code: "W0601",
            message: format!(
                "the cam is undercut up to a turn of {}, and the window begins at {}: part of its torque is that of a roller on a corner",
                turn(lost),
                turn(behaviour.window_rad[0])
            ),
        });
    }
    if let Some(slack) = behaviour.stations.iter().rfind(|s| s.still.spring_n * design.purpose.springs.sense() < 0.0) {
        all.push(Warning {
            code: "W0602",
            message: format!(
                "up to a turn of {} the springs are {} than without force: a real one goes slack there, and the torque is smaller than computed",
                turn(slack.turn_rad()),
                if design.built.extension { "shorter" } else { "longer" }
            ),
        });
    }
    if let Some(stuck) = behaviour.stations.iter().skip(1).find(|s| s.down.torque_nm <= 0.0) {
        all.push(Warning {
            code: "W0608",
            message: format!(
                "from a turn of {} on the springs do not turn the disc back by themselves: friction holds it",
                turn(stuck.turn_rad())
            ),
        });
    }
    let least = LOCKED_FROM * design.purpose.turn_rad;
    if let Some(first) = behaviour.stations.first().filter(|s| s.turn_rad() > least && behaviour.mechanism.pose(0.0).is_ok()) {
        all.push(locked_start(&turn(first.turn_rad()), "no torque turns the disc away from there"));
    }
    all.extend(sliding(design.friction, measured));
    all
}
