//! Requirements and rules against what was found.

use forcewright_base::units::{format_number, format_si};
use forcewright_contract::judge::Comparison;
use forcewright_model::{Check, Sense};

use super::analysis::{Behaviour, Station};
use super::design::Design;
use super::mechanism::Stop;
use crate::analysis::{Measured, extent};
use crate::design::Requirements;
use crate::rules::{Rules, percent};

/// Requirements in the order of the language, then the family's own rules.
pub(crate) fn checks(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Check> {
    let turn = |rad: f64| format_si(rad, &design.units.travel, 4);
    let rules = Rules {
        requirements: design.requirements.as_ref(),
        units: &design.units,
        measured,
        unreached: behaviour.stopped.map(|(at, why)| {
            let what = if matches!(why, Stop::Locks(_)) { "friction locks the disc" } else { "no roller stands on the disc" };
            format!("{what} at a turn of {}; see the status", turn(at))
        }),
        moves: [design.motion.is_some(), behaviour.motion.is_some()],
        arm_m: design.built.arm_m,
        lengths_m: design.built.lengths_m,
        friction: design.friction,
        materials: &design.materials,
    };
    let mut all = Vec::new();
    if let Some(requirements) = &design.requirements {
        all.extend(torque(&rules, requirements, behaviour));
        all.extend(turned(design, &rules, requirements, behaviour));
        all.extend(rules.hysteresis(requirements));
        all.extend(rules.limits(requirements));
    }
    all.extend(undercut(design, &rules));
    all.extend(rules.springs());
    all.extend(rules.contact(behaviour.motion.is_some()));
    all.extend(rules.rolling());
    all.extend(rules.pressure());
    all
}

/// CAM014: the torque within its band, both ways.
fn torque(rules: &Rules<'_>, requirements: &Requirements, behaviour: &Behaviour) -> Option<Check> {
    let (law, band) = requirements.force.as_ref()?;
    let window = &behaviour.window;
    let ratio = |pick: fn(&Station) -> f64| extent(window, |s| pick(s) / law.force_n(s.turn_rad())[0]);
    let fix = if window.is_empty() {
        String::new()
    } else {
        let ([_, high], [low, _]) = (ratio(|s| s.up.torque_nm.max(s.down.torque_nm)), ratio(|s| s.up.torque_nm.min(s.down.torque_nm)));
        let (middle, half) = (f64::midpoint(high, low), (high - low) / (high + low));
        if half <= *band && middle > 0.0 {
            format!("springs of {} % of their rate bring the torque into the middle of its band", format_number(100.0 / middle, 4))
        } else {
            format!(
                "even in the middle of its band the torque differs by ±{} %: less friction, a shorter window, or a disc cut for these springs",
                format_number(100.0 * half, 3)
            )
        }
    };
    let basis = "largest |T/T_required − 1| over the window, disc turned up or down";
    let base = rules.base("CAM014", "torque", "Torque inside its band, up and down", "torque_deviation");
    Some(Comparison { limit: Some(*band), display: percent(), fix, basis: basis.to_owned(), ..base }.judge())
}

/// CAM015: the turn that is reached, undercut or not.
fn turned(design: &Design, rules: &Rules<'_>, requirements: &Requirements, behaviour: &Behaviour) -> Option<Check> {
    let wanted = requirements.stroke_m?;
    let turn = |rad: f64| format_si(rad, &design.units.travel, 4);
    let start = behaviour.stations.first().map_or(0.0, Station::turn_rad);
    let reached = behaviour.stopped.map_or(design.purpose.turn_rad, |(at, _)| at) - start;
    let comparison = Comparison {
        value: Some(reached),
        limit: Some(wanted * (1.0 - 1e-12)),
        sense: Sense::AtLeast,
        display: design.units.travel.clone(),
        basis: "turn for which the disc is cut, the rollers stand on it, and it can be turned".to_owned(),
        fix: match behaviour.stopped {
            None if start > 0.0 && behaviour.mechanism.pose(0.0).is_ok() => {
                format!(
                    "friction locks the first {}: less of it, springs stretched more at the start, or a larger `design.turn`",
                    turn(start)
                )
            }
            None => "raise `design.turn`; spring length and disc grow with it".to_owned(),
            Some((_, Stop::Locks(_))) => "friction locks the disc on the way: less of it, or a larger `start_radius`".to_owned(),
            Some((_, Stop::NotAssembled(_))) => {
                "no roller stands on the disc from there: rollers nearer to those for which it was cut".to_owned()
            }
        },
        ..rules.base("CAM015", "turn", "Turn", "undercut_turn")
    };
    Some(comparison.judge())
}

/// CAM003: a roller larger than the path allows cuts the start of the cam away.
fn undercut(design: &Design, rules: &Rules<'_>) -> Option<Check> {
    let radius = rules.measured.get("path_curvature_radius_min")?;
    let lost = format_si(rules.measured.get("undercut_turn").unwrap_or(0.0), &design.units.travel, 4);
    let unit = &design.units.length;
    let diameter = format_si(2.0 * radius * (1.0 - 1e-4), unit, 4);
    let title = "Undercut: roller radius against the path's radius of curvature";
    let comparison = Comparison {
        required: false,
        value: Some(design.cut_roller_m),
        limit: Some(radius),
        display: unit.clone(),
        basis:
            "the cam is the path offset by the roller's radius r; where the path is convex it has the radius ϱ − r, so r must not exceed ϱ"
                .to_owned(),
        fix: format!(
            "below a turn of {lost} the roller rides on a corner of the cam and the torque is not the one wanted: a roller diameter of at most {diameter} removes the undercut, and so do springs that are stretched more at the start"
        ),
        ..rules.base("CAM003", "undercut", title, "path_curvature_radius_min")
    };
    Some(comparison.judge())
}
