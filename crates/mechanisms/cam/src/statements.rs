//! What a report says in words: status, model, limits, sources, warnings.

use forcewright_base::units::{format_number, format_si};
use forcewright_model::{Citation, Statement, Status, StatusKind, Warning};

use crate::analysis::{Behaviour, LOCKED_FROM, Measured};
use crate::design::{Design, Material};
use crate::mechanism::{Sense, SpringMass, Stop};
use crate::release::End;

pub(crate) fn statement(title: &str, text: impl Into<String>) -> Statement {
    Statement { title: title.to_owned(), text: text.into() }
}

/// How the analysis ended.
pub(crate) fn status(design: &Design, behaviour: &Behaviour) -> Status {
    let travel = |s: f64| format_si(s, &design.units.travel, 4);
    if let Some((s, Stop::Locks(sense))) = behaviour.stopped {
        let way = if sense == Sense::Down { "back" } else { "along its travel" };
        return Status {
            kind: StatusKind::NotConverged,
            message: format!("at a travel of {} friction locks the rollers: no force moves the slider {way}", travel(s)),
            advice: Some("make `rolling_arm` smaller, the rollers larger, or the braces longer: the pressure angle is too large for so much friction".to_owned()),
        };
    }
    if let Some((s, Stop::NotAssembled(why))) = behaviour.stopped {
        let side = ["right", "left"][why.side];
        return Status {
            kind: StatusKind::NotConverged,
            message: format!(
                "from a travel of {} on the mechanism cannot be assembled: the {side} brace misses the path of its roller by {}",
                travel(s),
                format_si(why.gap_m.abs(), &design.units.length, 3)
            ),
            advice: Some(
                if design.built.is_as_meant() {
                    "lengthen `brace_length`, or shorten `stroke`"
                } else {
                    "make `[errors]` smaller, or `brace_length` larger"
                }
                .to_owned(),
            ),
        };
    }
    if design.moves() && behaviour.motion.is_none() {
        let (message, advice) = if design.free_guide {
            ("in the motion the free slider runs away from its axis", "guide it, or move it more slowly")
        } else {
            (
                "the motion passes places where the mechanism cannot be assembled, or where friction locks it",
                "shorten `motion.rise`, or begin later",
            )
        };
        return Status { kind: StatusKind::NotConverged, message: message.to_owned(), advice: Some(advice.to_owned()) };
    }
    if let Some(release) = &behaviour.release
        && let End::NotAssembled(_) | End::Unsettled = release.end
    {
        let what = if release.end == End::Unsettled { "cannot be integrated further" } else { "leaves the cam" };
        let time = format_si(release.time_s, &design.units.time, 3);
        return Status {
            kind: StatusKind::NotConverged,
            message: format!("after {time} the motion of the released slider {what}"),
            advice: Some("watch it for a shorter `motion.duration`".to_owned()),
        };
    }
    let end = travel(design.purpose.stroke_m);
    let mut message = format!("computed over the whole stroke of {end}, up and down");
    if let Some(release) = &behaviour.release {
        let what = match release.end {
            End::Stop { far: true } => "is at the end of its travel",
            End::Stop { far: false } => "is at the start of its travel",
            End::Rest => "is at rest, held by friction,",
            _ => "still moves",
        };
        message = format!("{message}; let go, the slider {what} after {}", format_si(release.time_s, &design.units.time, 3));
    }
    Status { kind: StatusKind::Complete, message, advice: None }
}

/// Which equations were solved and how.
pub(crate) fn model(design: &Design) -> Vec<Statement> {
    let path = if design.purpose.friction == 0.0 {
        "The work of the wanted force equals the energy of the springs, W(s) = E: the path of the rollers' centres follows in closed form, without integrating a differential equation. Derivatives are exact."
    } else {
        "The path follows from equilibrium with rolling friction in one direction, eq. (2) of Sánchez-Salinas et al. in the form that is regular at the start, integrated with a method of fifth order. Derivatives come from the equation itself."
    };
    let springs = match design.built.bodies.springs {
        SpringMass::Bar => {
            "The springs' mass moves as a bar between the axles: half of it along the travel, a sixth outwards with each roller."
        }
        SpringMass::Halves => "Half of the springs' mass sits on each roller.",
    };
    let mut all = vec![
        statement("Cam", path),
        statement(
            "Forces",
            "Slider, braces, rollers and springs by Newton and Euler at each instant, both sides by themselves, rolling resistance as a force μN against the way of each roller, μ the arm over the radius. At rest this is eq. (1) of Sánchez-Salinas et al.; without friction it is the Lagrangian with V(s) and M(s).",
        ),
        statement("Springs", springs),
        statement(
            "Window",
            "Means, standard deviations and the loop are integrals over the travel of the window by Simpson's rule on 400 panels; extremes are taken at their ends and middles.",
        ),
    ];
    all.extend(crate::profile_figures::statement(design));
    all
}

/// What is not modelled.
pub(crate) fn limits(design: &Design) -> Vec<Statement> {
    let mut all = vec![
        statement("Rigid parts", "Braces, axles and cam do not bend; the contact between roller and cam is stiff."),
        statement(
            "Friction",
            "Only rolling resistance, in proportion to the normal force. Friction in joints, in the guide of the slider and between the coils of springs is not in the numbers.",
        ),
    ];
    if design.free_guide && design.motion.is_some() {
        all.push(statement(
            "Free slider in the motion",
            "It begins at rest where nothing pushes it sideways and swings undamped; rolling resistance is taken against the way along the travel.",
        ));
    }
    if design.release.is_some() {
        all.push(statement(
            "Release",
            "A free slider is let go where nothing pushes it sideways; rolling resistance is taken against the way along the travel. Stops are rigid and end the motion; the cable has no mass and does not stretch, the pulley no inertia; where the cable becomes taut, slider and mass take one speed at once.",
        ));
    }
    if design.moves() {
        all.push(statement(
            "Contact in the motion",
            "The rollers are kept on the cam also where they would lift off; the check of the contact says where that is.",
        ));
    }
    all
}

/// Works that were used.
pub(crate) fn sources(design: &Design) -> Vec<Citation> {
    let paper = "arrangement, equilibrium with rolling friction (1), path (2)–(3), motion (17)";
    cited(paper, &design.materials)
}

/// The paper of the family, for what it was used, and the sources of material data.
pub(crate) fn cited(used_for: &'static str, materials: &[Option<Material>; 2]) -> Vec<Citation> {
    let mut all = vec![Citation {
        key: "sanchez2022",
        text: "S. Sánchez-Salinas, A. García-Agúndez, J. López-Martínez, D. García-Vallejo: Experimental validation of a constant-force mechanism and analysis of its performance with a calibrated multibody model. Mechanism and Machine Theory 173 (2022) 104819.",
        used_for,
    }];
    let mut keys: Vec<&'static str> = Vec::new();
    for key in materials.iter().flatten().flat_map(|m| &m.sources) {
        if !keys.contains(key) {
            keys.push(key);
        }
    }
    all.extend(keys.into_iter().map(|key| Citation {
        key,
        text: "Source of material data; see REFERENCES.bib.",
        used_for: "values of the material catalogue",
    }));
    all
}

/// Things to know about a result.
pub(crate) fn warnings(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Warning> {
    let mut all = Vec::new();
    let travel = |s: f64| format_si(s, &design.units.travel, 4);
    let lost = measured.get("undercut_travel").unwrap_or(0.0);
    if lost > 0.0 && behaviour.window_m[0] < lost {
        all.push(Warning {
            code: "W0601",
            message: format!(
                "the cam is undercut up to a travel of {}, and the window begins at {}: part of its force is that of a roller on a corner",
                travel(lost),
                travel(behaviour.window_m[0])
            ),
        });
    }
    if let Some(slack) = behaviour.stations.iter().rfind(|s| s.still.spring_n * design.purpose.springs.sense() < 0.0) {
        all.push(Warning {
            code: "W0602",
            message: format!(
                "up to a travel of {} the springs are {} than without force: a real one goes slack there, and the force is smaller than computed",
                travel(slack.travel_m),
                if design.built.extension { "shorter" } else { "longer" }
            ),
        });
    }
    if let Some(k) = measured.get("lateral_stiffness_min")
        && k < 0.0
        && !design.free_guide
    {
        all.push(Warning {
            code: "W0603",
            message: format!(
                "a slider that is free to move sideways turns away from the axis (lateral stiffness {}): it needs its guide",
                format_si(k, &design.units.stiffness, 3)
            ),
        });
    }
    if let Some(stuck) = behaviour.stations.iter().skip(1).find(|s| s.down.force_n <= 0.0) {
        let at = format_si(stuck.travel_m, &design.units.travel, 4);
        let message = format!("from a travel of {at} on the springs do not draw the slider back by themselves: friction holds it");
        all.push(Warning { code: "W0608", message });
    }
    let least = LOCKED_FROM * design.purpose.stroke_m;
    if let Some(first) = behaviour.stations.first().filter(|s| s.travel_m > least && behaviour.mechanism.pose([0.0; 2]).is_ok()) {
        let end = format_si(first.travel_m, &design.units.travel, 4);
        all.push(locked_start(&end, "no force pulls the slider away from there"));
    }
    all.extend(crate::profile_figures::warning(design));
    all.extend(crate::profile_figures::uncovered(design, behaviour));
    all.extend(sliding(design.friction, measured));
    all
}

/// A start from which friction lets nothing move.
pub(crate) fn locked_start(end: &str, what: &str) -> Warning {
    Warning { code: "W0609", message: format!("up to {end} friction locks the rollers: {what}; begin beyond it") }
}

/// Rollers that slide.
pub(crate) fn sliding(friction: Option<f64>, measured: &Measured) -> Option<Warning> {
    let (friction, needed) = (friction?, measured.get("friction_needed_max")?);
    (needed > friction).then(|| Warning {
        code: "W0604",
        message: format!(
            "rolling needs a friction of {}, {} is there: the rollers slide",
            format_number(needed, 3),
            format_number(friction, 3)
        ),
    })
}
