//! Tables for workshop and purchase: the spring, what to measure, how it goes together.

use std::f64::consts::PI;

use forcewright_base::maths;
use forcewright_base::units::format_number;
use forcewright_elements::gears::{Wheel, involute};
use forcewright_elements::wrap_spring::{Coil, Effect, Hand, Sense, effect, wire_tolerance_m};
use forcewright_model::Sheet;

use super::{PIN, PIN_IN_CARRIER, PIN_IN_PLANET, fitted};
use crate::analysis::Behaviour;
use crate::design::Design;
use crate::sizes::{AIR, Sizes, long};

fn sheet(name: &str, caption: &str, columns: &[&str], rows: Vec<Vec<String>>) -> Sheet {
    Sheet { name: name.to_owned(), caption: caption.to_owned(), columns: columns.iter().map(|&c| c.to_owned()).collect(), rows }
}

fn mm(m: f64) -> String {
    format_number(1e3 * m, 6)
}

pub(super) fn sheets(design: &Design, behaviour: &Behaviour, sizes: &Sizes) -> Vec<Sheet> {
    vec![spring(design, behaviour), inspection(design, sizes), assembly(design, behaviour, sizes)]
}

/// The spring to be ordered.
fn spring(design: &Design, behaviour: &Behaviour) -> Sheet {
    let spring = &design.built.spring;
    let turns = spring.hub_turns + spring.free_turns + spring.unsupported_turns;
    let mut rows: Vec<[String; 3]> = Vec::new();
    let mut row = |name: &str, value: String, remark: &str| rows.push([name.to_owned(), value, remark.to_owned()]);
    let grade = design.wire.grade.map_or_else(|| "as agreed".to_owned(), |g| format!("EN 10270-1 {}", g.name));
    row("wire", grade, "");
    let tolerance = wire_tolerance_m(spring.wire_m).map_or_else(|| "not tabulated".to_owned(), |m| format!("± {} mm", mm(m)));
    row(
        "wire diameter / mm",
        mm(spring.wire_m),
        &format!("standard: {tolerance}; asked for: {}", range(spring.wire_m, design.scatter.wire_m)),
    );
    row("inner diameter, free / mm", mm(spring.inner_m), &format!("asked for: {}", range(spring.inner_m, design.scatter.inner_m)));
    row("mean diameter, free / mm", mm(spring.inner_m + spring.wire_m), "");
    row("hand", if spring.right_hand { "right" } else { "left" }.to_owned(), "as a common screw is right-handed");
    row("turns", format_number(turns, 5), "all");
    row("turns on the hub", format_number(spring.hub_turns, 4), "its end lies free");
    row("turns off the hub", format_number(spring.free_turns, 4), "they open before the bore is reached");
    row("turns in the bore", format_number(spring.bore_turns, 4), "next to the ring");
    let coil = Coil {
        wire_m: spring.wire_m,
        radius_m: 0.5 * (spring.inner_m + spring.wire_m),
        turns,
        gap_m: (AIR - 1.0) * spring.wire_m,
        // As it is drawn: bent along the axis, through the seat.
        ends_m: super::coil(design).ends_m().iter().sum(),
    };
    if let Ok(winding) = coil.winding(design.wire.density_kg_per_m3.unwrap_or(1.0)) {
        row("length of wire / mm", mm(winding.wire_length_m), "with the end that is bent along the axis, through the seat");
        row("length of the body / mm", mm(winding.body_m), "a tenth of the wire between turns");
        if design.wire.density_kg_per_m3.is_some() {
            row("mass / g", format_number(1e3 * winding.mass_kg, 4), "");
        }
    }
    let stresses = behaviour.clutch.stresses();
    row("bending stress on the hub / MPa", format_number(1e-6 * stresses.hub_pa, 4), "lasting");
    row("bending stress in the bore / MPa", format_number(1e-6 * stresses.bore_pa, 4), "at each shift");
    if let Some(strength_pa) = design.wire.tensile_pa {
        row("least tensile strength / MPa", format_number(1e-6 * strength_pa, 4), "");
    }
    row("torque that opens it to the bore / N·mm", format_number(1e3 * behaviour.statics.transition_nm, 4), "to be tested on a sample");
    let rows = rows.into_iter().map(|r| r.to_vec()).collect();
    sheet("spring", "The spring to be ordered.", &["what", "value", "remark"], rows)
}

fn range(value_m: f64, [low, high]: [f64; 2]) -> String {
    if low < high { format!("{} to {} mm", mm(value_m + low), mm(value_m + high)) } else { "no tolerance given".to_owned() }
}

/// Span over k teeth (m), Wildhaber: `m cos α ((k − ½)π + z inv α + 2x tan α)`, thinner by the backlash.
fn span(wheel: &Wheel) -> (u32, f64) {
    let spec = &wheel.spec;
    let alpha = spec.rack.pressure_angle_rad;
    let z = f64::from(spec.teeth);
    // Jaws touch near the middle of the flanks.
    let wanted = z * alpha / PI + 0.5 + 2.0 * spec.profile_shift * maths::tan(alpha) / PI;
    let k = (2..=spec.teeth.max(2)).min_by(|a, b| (f64::from(*a) - wanted).abs().total_cmp(&(f64::from(*b) - wanted).abs())).unwrap_or(2);
    let teeth = (f64::from(k) - 0.5) * PI + z * involute(alpha) + 2.0 * spec.profile_shift * maths::tan(alpha);
    (k, maths::cos(alpha) * (spec.module_m * teeth - spec.thinning_m))
}

/// What is measured on the parts.
fn inspection(design: &Design, sizes: &Sizes) -> Sheet {
    let mut rows = vec![
        vec!["hub".to_owned(), "diameter of surface A".to_owned(), mm(design.built.hub_m), range(design.built.hub_m, design.scatter.hub_m)],
        vec![
            "friction ring".to_owned(),
            "bore, surface B".to_owned(),
            mm(design.built.bore_m),
            range(design.built.bore_m, design.scatter.bore_m),
        ],
    ];
    for (wheel, name) in sizes.wheels.iter().zip(["sun", "planet"]) {
        let (k, span_m) = span(wheel);
        rows.push(vec![name.to_owned(), format!("span over {k} teeth"), mm(span_m), "thinner is backlash".to_owned()]);
        rows.push(vec![name.to_owned(), "tip diameter".to_owned(), mm(2.0 * wheel.tip_radius_m), String::new()]);
    }
    rows.push(vec!["ring".to_owned(), "tip diameter, inside".to_owned(), mm(2.0 * sizes.wheels[2].tip_radius_m), String::new()]);
    rows.push(vec!["carrier".to_owned(), "radius of the pins".to_owned(), mm(sizes.arm_m), "even spacing".to_owned()]);
    for (part, what, fit) in [
        ("pins", "diameter", PIN),
        ("carrier", "holes for the pins, pressed", PIN_IN_CARRIER),
        ("planet", "hole for the pin, running", PIN_IN_PLANET),
    ] {
        rows.push(vec![part.to_owned(), what.to_owned(), mm(sizes.pins_m), fitted(design, fit, sizes.pins_m)]);
    }
    sheet("inspection", "What to measure: nominal sizes in mm, and what is allowed.", &["part", "what", "size / mm", "allowed"], rows)
}

/// How it goes together.
fn assembly(design: &Design, behaviour: &Behaviour, sizes: &Sizes) -> Sheet {
    let gears = &design.built.gears;
    let hand = if design.built.spring.right_hand { Hand::Right } else { Hand::Left };
    // In closing, the planets push the ring against the sense of the input; that must open the coil, seen from the input.
    let closing = [Sense::Clockwise, Sense::Counterclockwise].into_iter().find(|ring| effect(hand, *ring) == Effect::Opens);
    let input = match closing {
        Some(Sense::Clockwise) => "counterclockwise",
        _ => "clockwise",
    };
    let set = &behaviour.train.set;
    let backlash = set.sun_planet.backlash();
    let rows = vec![
        ("sense of the input that closes the hand, seen from the input".to_owned(), input.to_owned()),
        ("distance of sun and planets / mm".to_owned(), mm(sizes.arm_m)),
        ("planets, evenly spaced".to_owned(), gears.planets.to_string()),
        ("backlash of sun and planet at the pitch circle / mm".to_owned(), mm(backlash.circumferential_m)),
        ("gap between planets / mm".to_owned(), mm(set.neighbour_gap_m())),
        ("radial interference of spring and hub / mm".to_owned(), mm(design.built.gaps_m()[0])),
        ("radial gap of spring and bore / mm".to_owned(), mm(design.built.gaps_m()[1])),
        (
            "turns of the input before the shift, output held".to_owned(),
            format_number(behaviour.clutch.dead_turns() * behaviour.statics.leverage(), 4),
        ),
    ];
    let along = [
        ("outer diameter / mm", sizes.envelope_m[0]),
        ("length along the axis, without play / mm", sizes.envelope_m[1]),
        ("spacers of ring and seat, without play / mm", sizes.ring_spacers_m()),
        ("friction ring up to the seat, long / mm", long(sizes.friction_ring)),
        ("spacers of friction ring and chassis / mm", sizes.chassis_spacers_m()),
    ];
    let rows = rows.into_iter().chain(along.map(|(what, m)| (what.to_owned(), mm(m))));
    let rows = rows.map(|(a, b)| vec![a, b]).collect();
    sheet("assembly", "How it goes together.", &["what", "value"], rows)
}
