//! A design as sections of a project file.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::synthesis::Proposal;

use super::asked::Asked;
use super::front::Point;
use super::gears::Sound;
use super::search::{Found, designed};
use crate::design::{Design, DisplayUnits};
use crate::metrics::LavtMetrics;

/// What a design is chosen for: name for files, for people.
pub(super) const ROLES: [(&str, &str); 7] = [
    ("small", "smallest"),
    ("strong", "largest output torque"),
    ("efficient", "best efficiency"),
    ("slippery", "least friction needed"),
    ("loose", "loosest fits"),
    ("balanced", "compromise"),
    ("between", "another trade-off"),
];

/// A proposal for a point of the front, chosen for a role.
pub(super) fn proposal(asked: &Asked, found: &Found, point: &Point, role: usize) -> Proposal {
    let sound = &found.sets[point.set as usize];
    let design = designed(asked, sound, point.place);
    let units = &asked.template.units;
    let length = |m: f64| format_si(m, &units.length, 4);
    let (built, spring) = (&design.built, &design.built.spring);
    let [sun, planet, ring] = built.gears.teeth;
    let row = Row::new(asked, point, units);
    let (topology, chosen) = ROLES[role.min(ROLES.len() - 1)];
    let teeth = format!("{sun}/{planet}/{ring} teeth");
    Proposal {
        topology,
        title: format!("{chosen}: {teeth}, wire of {} on a hub of {}", length(spring.wire_m), length(built.hub_m)),
        sections: sections(asked, &design, point),
        settings: settings(asked),
        sizes: vec![
            ("Chosen for", chosen.to_owned()),
            ("Sun, planet, ring", format!("{sun}, {planet}, {ring}, {} planets", built.gears.planets)),
            ("Wire", length(spring.wire_m)),
            ("Hub and bore", format!("{} and {}", length(built.hub_m), length(built.bore_m))),
            ("Turns on hub and in bore", format!("{} and {}", format_number(spring.hub_turns, 4), format_number(spring.bore_turns, 4))),
            ("Output torque", row.output),
            ("Efficiency", row.efficiency),
            ("Friction needed", row.friction),
            ("Room between the gaps", row.gap),
            ("Volume", row.volume),
        ],
        state: state(sound, &design),
        cost: point.objectives[0],
        parts: 1,
    }
}

/// Objectives for people.
pub(super) struct Row {
    pub volume: String,
    pub output: String,
    pub efficiency: String,
    pub friction: String,
    pub gap: String,
}

impl Row {
    pub(super) fn new(asked: &Asked, point: &Point, units: &DisplayUnits) -> Self {
        let [volume_m3, output, efficiency, friction, gap] = point.objectives;
        let least = asked.frictions()[0][0];
        Self {
            volume: volume(volume_m3),
            output: format_si(-output, &units.torque, 4),
            efficiency: percent(-efficiency),
            friction: format_number(friction * least, 3),
            gap: format_si(-gap, &units.length, 3),
        }
    }
}

pub(super) fn volume(m3: f64) -> String {
    Unit::parse("cm^3").map_or_else(|_| format_number(m3, 4), |unit| format_si(m3, &unit, 4))
}

pub(super) fn percent(ratio: f64) -> String {
    format!("{} %", format_number(100.0 * ratio, 4))
}

fn state(sound: &Sound, design: &Design) -> Vec<f64> {
    let Design { built, .. } = design;
    let counts = [sound.set.sun, sound.set.planet, sound.set.number].map(f64::from);
    let spring = &built.spring;
    let sizes = [built.gears.module_m, spring.wire_m, spring.inner_m, built.hub_m, built.bore_m, spring.hub_turns, spring.bore_turns];
    counts.into_iter().chain(sizes).collect()
}

fn millimetres(m: f64) -> String {
    format!("{} mm", format_number(1e3 * m, 12))
}

/// Room and stress as limits that an analysis tests.
fn settings(asked: &Asked) -> Vec<String> {
    let stress = format!("{} MPa", format_number(1e-6 * asked.stress_pa, 9));
    let [outer_m, length_m] = asked.envelope_m;
    let all = [
        ("outer_diameter", outer_m, millimetres(outer_m)),
        ("length", length_m, millimetres(length_m)),
        ("spring_stress_max", asked.stress_pa, stress),
    ];
    // A limit that the file has of its own is not replaced by a weaker one.
    let has = |name: &str, most: f64| asked.limits.iter().any(|l| l.name::<LavtMetrics>() == name && l.max.is_some_and(|max| max <= most));
    let wanted = all.into_iter().filter(|(name, most, _)| most.is_finite() && !has(name, *most));
    wanted.map(|(name, _, text)| format!("requirements.limits.{name}.max=\"{text}\"")).collect()
}

fn sections(asked: &Asked, design: &Design, point: &Point) -> String {
    let (built, gears, spring) = (&design.built, &design.built.gears, &design.built.spring);
    let number = |x: f64| format_number(x, 12);
    let half = |m: f64| if m > 0.0 { format!(" ± {}", millimetres(m)) } else { String::new() };
    let mut text = String::from("\n# Sized by `forcewright synthesise`.\n[design.gears]\n");
    let [sun, planet, _] = gears.teeth;
    let _ = writeln!(text, "sun = {sun}\nplanet = {planet}\nplanets = {}\nmodule = \"{}\"", gears.planets, millimetres(gears.module_m));
    let _ = writeln!(text, "face_width = \"{}\"", millimetres(gears.face_m));
    let each = |of: [f64; 3]| format!("{{ sun = {}, planet = {}, ring = {} }}", number(of[0]), number(of[1]), number(of[2]));
    let _ = writeln!(text, "profile_shift = {}\ntip_shortening = {}", each(gears.shift), each(gears.shortening));
    if gears.backlash_m > 0.0 {
        let _ = writeln!(text, "backlash = \"{}\"", millimetres(gears.backlash_m));
    }
    if let Some(friction) = gears.friction {
        let _ = writeln!(text, "friction = {}", number(friction));
    }
    let wire = asked.wires[usize::from(point.place[0])];
    let _ = writeln!(text, "\n[design.spring]\nwire_diameter = \"{}{}\"", millimetres(spring.wire_m), half(wire.half_m));
    let _ = writeln!(text, "inner_diameter = \"{}{}\"", millimetres(spring.inner_m), half(asked.spring_half_m));
    let _ = writeln!(text, "hub_turns = {}\nfree_turns = {}", number(spring.hub_turns), number(spring.free_turns));
    let _ = writeln!(text, "bore_turns = {}", number(spring.bore_turns));
    let _ = writeln!(text, "\n[design.hub]\ndiameter = \"{}{}\"", millimetres(built.hub_m), asked.hub_made.text);
    let _ = writeln!(text, "\n[design.bore]\ndiameter = \"{}{}\"", millimetres(built.bore_m), asked.bore_made.text);
    let range = |i: usize| {
        let half = asked.friction_half[i];
        let range = if half > 0.0 { format!(" ± {}", number(half)) } else { String::new() };
        format!("\"{}{range}\"", number(asked.friction[i]))
    };
    let _ = writeln!(text, "\n[design.friction]\nhub = {}\nbore = {}", range(0), range(1));
    text
}

/// A torque for people.
pub(super) fn torque(nm: f64, units: &DisplayUnits) -> String {
    debug_assert!(units.torque.is(Dimension::Torque));
    format_si(nm, &units.torque, 4)
}
