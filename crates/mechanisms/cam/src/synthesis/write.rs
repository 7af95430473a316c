//! A size as sections of a project file.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::synthesis::Proposal;
use forcewright_elements::springs::Helix;

use super::sizing::{Asked, Size};

/// A proposal for a size.
pub(super) fn proposal(asked: &Asked, size: &Size, length: &Unit) -> Proposal {
    let show = |si: f64| format_si(si, length, 4);
    let rate = format!("{} N/mm", format_number(1e-3 * size.rate_n_per_m, 6));
    let wire = size.helix.map_or_else(String::new, |h| format!(", {}", wound_as(&h, length)));
    let [wire_m, mean_m, coils] = size.helix.map_or([0.0; 3], |h| [h.wire_m, h.mean_m, h.coils]);
    Proposal {
        topology: if size.helix.is_none() { "springs" } else { "free-springs" },
        title: format!("{} of {rate}, rollers of {}", springs(size), show(2.0 * size.roller_m)),
        sections: sections(asked, size),
        settings: room(asked.room_m),
        sizes: vec![
            ("Room", format!("{} × {}", show(size.width_m), show(size.height_m))),
            ("Springs", format!("{} × {rate}, {}{wire}", format_number(size.count, 2), show(size.rest_m))),
            ("Braces", show(size.brace_m)),
            ("Hysteresis", format!("{} %", format_number(100.0 * size.hysteresis, 3))),
        ],
        state: vec![
            size.count,
            size.rate_n_per_m,
            size.rest_m,
            size.most_m,
            size.spring_kg,
            wire_m,
            mean_m,
            coils,
            size.start_m,
            size.brace_m,
            size.roller_m,
            size.width_m,
            size.height_m,
            size.hysteresis,
        ],
        cost: size.cost_m3(),
        parts: 4,
    }
}

fn springs(size: &Size) -> String {
    if size.count > 1.0 { format!("{} springs", format_number(size.count, 2)) } else { "a spring".to_owned() }
}

/// How a spring is wound, in words.
fn wound_as(helix: &Helix, length: &Unit) -> String {
    let show = |si: f64| format_si(si, length, 4);
    format!("wire {}, mean diameter {}, {} coils", show(helix.wire_m), show(helix.mean_m), format_number(helix.coils, 4))
}

/// The size of a proposal.
pub(super) fn read(state: &[f64]) -> Option<Size> {
    let [count, rate_n_per_m, rest_m, most_m, spring_kg, wire_m, mean_m, coils, start_m, brace_m, roller_m, width_m, height_m, hysteresis] =
        *state
    else {
        return None;
    };
    let helix = (wire_m > 0.0).then_some(Helix { wire_m, mean_m, coils });
    Some(Size { count, rate_n_per_m, rest_m, most_m, spring_kg, helix, start_m, brace_m, roller_m, width_m, height_m, hysteresis })
}

/// The room as limits that an analysis tests.
pub(super) fn room(room_m: [f64; 2]) -> Vec<String> {
    let side = |(name, side): (&str, f64)| {
        side.is_finite().then(|| format!("requirements.limits.{name}.max=\"{} mm\"", format_number(1e3 * side, 7)))
    };
    ["width", "height"].into_iter().zip(room_m).filter_map(side).collect()
}

fn millimetre() -> Unit {
    Unit::parse("mm").unwrap_or_else(|_| Unit::si(Dimension::Length))
}

/// `[design]` with what its cam is cut for.
fn sections(asked: &Asked, size: &Size) -> String {
    let mm = |si: f64| format!("\"{} mm\"", format_number(1e3 * si, 7));
    let mut text = String::from("\n# Sized by `forcewright synthesise`.\n[design]\n");
    let mut line = |key: &str, value: String| {
        let _ = writeln!(text, "{key} = {value}");
    };
    line("brace_length", mm(size.brace_m));
    line("roller_diameter", mm(2.0 * size.roller_m));
    line("stroke", mm(asked.stroke_m));
    line("rolling_arm", mm(asked.arm_m));
    text.push_str("\n[design.profile]\n");
    let mut line = |key: &str, value: String| {
        let _ = writeln!(text, "{key} = {value}");
    };
    let newton = |n: f64| format!("\"{} N\"", format_number(n, 9));
    if asked.law.is_constant() {
        line("for_force", newton(asked.law.force_n(0.0)[0]));
    } else {
        let points: Vec<String> =
            asked.law.kinks_m().zip(asked.law.levels_n()).map(|(s, f)| format!("[{}, {}]", mm(s), newton(f))).collect();
        line("for_profile", format!("[{}]", points.join(", ")));
    }
    let rate = |n_per_m: f64| format!("\"{} N/mm\"", format_number(1e-3 * n_per_m, 9));
    line("for_rate", rate(size.count * size.rate_n_per_m));
    line("for_rest_length", mm(size.rest_m));
    line("for_start_length", mm(size.start_m));
    text.push_str("\n[design.springs]\n");
    if let Some(helix) = &size.helix {
        let (wire, most) = (wound_as(helix, &millimetre()), mm(size.most_m).replace('"', ""));
        let _ = writeln!(
            text,
            "# Each: {wire}, full loops; {} by EN 10270-1, within 0.45 of its strength up to {most} (EN 13906-2).",
            asked.grade
        );
    }
    let mut line = |key: &str, value: String| {
        let _ = writeln!(text, "{key} = {value}");
    };
    line("rate", rate(size.rate_n_per_m));
    line("count", format_number(size.count, 2));
    line("rest_length", mm(size.rest_m));
    line("max_length", mm(size.most_m));
    if size.spring_kg > 0.0 {
        line("mass", format!("\"{} g\"", format_number(1e3 * size.spring_kg, 6)));
    }
    text
}
