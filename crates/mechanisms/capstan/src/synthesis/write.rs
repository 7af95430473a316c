//! A size as sections of a project file.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::synthesis::Proposal;
use forcewright_elements::grooves::Groove;

use super::sizing::{Asked, Frame, Merits, Rope, Size};
use crate::design::DisplayUnits;
use crate::geometry::Belt;
use crate::whole::{count, few, small};

/// Density of the drums for their moments of inertia where the project gives none, kg/m³: aluminium.
const ALUMINIUM_KG_PER_M3: f64 = 2700.0;

/// A proposal for a size; `kept` says whether no other one is better in everything.
pub(super) fn proposal(asked: &Asked, size: &Size, merits: &Merits, kept: bool) -> Proposal {
    let units = &asked.template.units;
    let length = |m: f64| format_si(m, &units.length, 4);
    let frame = &size.frame;
    let rope = &asked.ropes[frame.rope];
    let cable = cable(rope);
    let (count, name) =
        if frame.cables == 1 { ("a cable".to_owned(), "one-cable") } else { (format!("{} cables", frame.cables), "cables") };
    Proposal {
        topology: name,
        title: format!("{count} {cable}, input drum of {}", length(2.0 * frame.input_m)),
        sections: sections(asked, size),
        settings: settings(asked),
        sizes: vec![
            ("Cables", format!("{} × {cable}", frame.cables)),
            ("Input drum", length(2.0 * frame.input_m)),
            ("Centre distance", length(frame.distance_m)),
            ("Extra turns", frame.turns.to_string()),
            ("Preload", format_si(size.preload_n, &units.force, 4)),
            ("Width", length(size.width_m)),
            ("Stiffness", format_si(merits.stiffness_nm_per_rad, &units.stiffness, 4)),
            ("Shaft load", format_si(merits.shaft_load_n, &units.force, 4)),
            ("Drums, at the output", format!("{} kg·m²", format_number(density(asked) * merits.inertia_m5, 3))),
            ("Trade-off", if kept { "not dominated" } else { "dominated" }.to_owned()),
        ],
        state: state(size),
        cost: size.cost_m3,
        parts: 2 + frame.cables as usize,
    }
}

/// Of the drums, kg/m³.
pub(super) fn density(asked: &Asked) -> f64 {
    asked.template.making.density_kg_per_m3.unwrap_or(ALUMINIUM_KG_PER_M3)
}

/// Construction and diameter.
pub(super) fn cable(rope: &Rope) -> String {
    format!("{} {}", rope.construction.name, millimetres(rope.diameter_m))
}

/// What a design does, for the comparison of arrangements.
pub(super) fn row(name: String, merits: &Merits, torque_nm: f64, units: &DisplayUnits) -> Vec<String> {
    let dash = || "–".to_owned();
    vec![
        name,
        format_si(merits.stiffness_nm_per_rad, &units.stiffness, 4),
        merits.lost_motion_rad.map_or_else(dash, |rad| format_si(rad, &units.small_angle, 3)),
        merits.slip_nm.map_or_else(dash, |nm| format_number(nm / torque_nm, 3)),
        merits.safety.map_or_else(dash, |s| format_number(s, 3)),
        format_si(merits.shaft_load_n, &units.force, 4),
        format_si(merits.width_m, &units.length, 4),
    ]
}

fn state(size: &Size) -> Vec<f64> {
    let f = &size.frame;
    vec![
        f.rope as f64,
        f64::from(f.cables),
        f64::from(f.turns),
        f64::from(f.apart),
        f.input_m,
        f.distance_m,
        f64::from(size.between),
        size.preload_n,
        size.width_m,
        size.cost_m3,
    ]
}

/// The size of a proposal.
pub(super) fn read(state: &[f64]) -> Option<Size> {
    let [rope, cables, turns, apart, input_m, distance_m, between, preload_n, width_m, cost_m3] = *state else { return None };
    let frame = Frame { rope: count(rope), cables: few(cables), turns: few(turns), apart: small(apart), input_m, distance_m };
    Some(Size { frame, between: small(between), preload_n, width_m, cost_m3 })
}

fn millimetres(m: f64) -> String {
    format!("{} mm", format_number(1e3 * m, 9))
}

/// The envelope as limits that an analysis tests.
fn settings(asked: &Asked) -> Vec<String> {
    let [diameter_m, width_m, length_m] = asked.envelope_m;
    let sides = [
        ("output_drum_diameter", diameter_m),
        ("input_drum_length", width_m),
        ("output_drum_length", width_m),
        ("length_over_drums", length_m),
    ];
    // A limit that the file has of its own is not replaced by a weaker one.
    let has = |name: &str, side_m: f64| {
        asked.limits.iter().any(|l| l.name::<crate::metrics::CapstanMetrics>() == name && l.max.is_some_and(|max| max <= side_m))
    };
    let wanted = sides.into_iter().filter(|(name, side_m)| side_m.is_finite() && !has(name, *side_m));
    wanted.map(|(name, side_m)| format!("requirements.limits.{name}.max=\"{}\"", millimetres(side_m))).collect()
}

fn sections(asked: &Asked, size: &Size) -> String {
    let built = asked.built(&size.frame, size.between, size.preload_n);
    let rope = &asked.ropes[size.frame.rope];
    let quoted = |m: f64| format!("\"{}\"", millimetres(m));
    let rad = |x: f64| format!("\"{} deg\"", format_number(x.to_degrees(), 9));
    let mut text = String::from("\n# Sized by `forcewright synthesise`. Diameters are to the middle of the cable.\n[design]\n");
    let mut line = |key: &str, value: String| {
        let _ = writeln!(text, "{key} = {value}");
    };
    line("input_diameter", quoted(2.0 * built.radii_m[0]));
    line("output_diameter", quoted(2.0 * built.radii_m[1]));
    line("diameters", "\"rope centre\"".to_owned());
    line("centre_distance", quoted(built.distance_m));
    line("belt", if built.belt == Belt::Open { "\"open\"" } else { "\"crossed\"" }.to_owned());
    line("extra_turns", built.extra_turns.to_string());
    line("travel", rad(built.travel_rad));
    line("output_anchor_wrap", rad(built.guard_rad));
    line("starts", built.starts.to_string());
    line("friction", format_number(built.friction, 9));
    let groove = match built.seat.groove {
        Groove::Vee { half_angle_rad } => format!("profile = \"v\", angle = {}", rad(2.0 * half_angle_rad)),
        Groove::Round { half_angle_rad, .. } => format!("profile = \"round\", seat_angle = {}", rad(2.0 * half_angle_rad)),
        _ => "profile = \"flat\"".to_owned(),
    };
    line("groove", format!("{{ {groove}, pitch = {} }}", quoted(built.pitch_m)));
    for cable in &built.cables {
        let _ = writeln!(text, "\n[[design.cables]]\nuse = \"{} {}\"", rope.construction.name, millimetres(rope.diameter_m));
        let _ = writeln!(text, "lines = [{}, {}]", cable.lines[0], cable.lines[1]);
        let _ = writeln!(text, "preload = \"{} N\"", format_number(cable.preload_n, 9));
        if cable.preload_loss > 0.0 {
            let _ = writeln!(text, "preload_loss = {}", format_number(cable.preload_loss, 9));
        }
        if let Some(loss) = cable.bending_loss {
            let _ = writeln!(text, "bending_loss = {}", format_number(loss, 9));
        }
    }
    bearings(&mut text, asked);
    text
}

fn bearings(text: &mut String, asked: &Asked) {
    let bearings = &asked.template.built.bearings;
    let mut lines = String::new();
    let unit = |si: f64, dimension: Dimension| format!("\"{} {}\"", format_number(si, 9), Unit::si(dimension).symbol());
    if let Some(friction) = bearings.friction {
        let _ = writeln!(lines, "friction = {}", format_number(friction, 9));
    }
    for (name, bore) in ["input_bore", "output_bore"].into_iter().zip(bearings.bores_m) {
        if let Some(bore) = bore {
            let _ = writeln!(lines, "{name} = {}", unit(bore, Dimension::Length));
        }
    }
    for (name, drag) in ["input_drag", "output_drag"].into_iter().zip(bearings.drags_nm) {
        if drag > 0.0 {
            let _ = writeln!(lines, "{name} = \"{} N*m\"", format_number(drag, 9));
        }
    }
    if !lines.is_empty() {
        let _ = write!(text, "\n[design.bearings]\n{lines}");
    }
}
