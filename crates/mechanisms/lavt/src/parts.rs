//! What is made of a design: gears with their pins, hub, spring, friction ring, plates of carrier and chassis, and the tables of spring, fits
//! and assembly.
//!
//! The gears are the drawn ones of [`forcewright_elements::gears`]; what carries them is simple: plates and sleeves with the diameters that
//! matter. Keys, bearings and housing are the business of the machine around.

mod sheets;

use std::f64::consts::TAU;

use forcewright_base::fits::Fit;
use forcewright_base::maths;
use forcewright_base::units::{Dimension, format_si};
use forcewright_contract::gears::GearPart;
use forcewright_contract::judge::Comparison;
use forcewright_curves::Profile;
use forcewright_elements::gears::{GearError, ToothProfile};
use forcewright_model::{Body, Check, Coil, CoilEnd, Hole, NoPart, Part, PartSet, Plate, Section, Sense, Turned, Winding};

use crate::analysis::Behaviour;
use crate::design::Design;
use crate::sizes::{AIR, BEND, Sizes, long};

/// Distance of the drawn teeth from the exact ones, modules.
const CHORD: f64 = 5e-4;
/// Least wall between a bore and the roots of teeth, modules.
const LEAST_WALL: f64 = 1.0;
/// Holes that bolt the friction ring and the plates together.
const BOLTS: u32 = 4;
/// Pins of the planets: ground, pressed into the carrier; the planets turn on them.
const PIN: &str = "h6";
const PIN_IN_CARRIER: &str = "P7";
const PIN_IN_PLANET: &str = "F8";

/// Why no finite elements of them are of use.
const RIGID: &str = "the parts of a transmission are taken as rigid";

fn no_gear(name: &str, error: &GearError) -> NoPart {
    NoPart {
        code: "E0820",
        message: format!("the {name} cannot be drawn: {error}"),
        help: "change its profile shift, tip shortening or bore; `forcewright synthesise` finds shifts that run".to_owned(),
    }
}

/// The parts of a design.
///
/// # Errors
/// [`NoPart`] where a gear cannot be drawn or a part leaves no material.
pub(crate) fn parts(design: &Design) -> Result<PartSet, NoPart> {
    let behaviour = Behaviour::of(design).map_err(|error| NoPart {
        code: "E0820",
        message: error.to_string(),
        help: "see `forcewright check`".to_owned(),
    })?;
    let sizes = Sizes::of(design, &behaviour.train);
    let mut parts = gears(design, &sizes)?;
    parts.push(pin(design, &sizes)?);
    parts.push(sleeve(design, "hub", "Hub with surface A", [long(sizes.hub), design.built.hub_m, sizes.shaft_m], hub_notes(design))?);
    parts.push(spring(design)?);
    parts.push(seat(design, &sizes, leg_m(design)));
    parts.push(friction_ring(design, &sizes)?);
    parts.extend(carrier(design, &sizes));
    parts.push(chassis(design, &sizes));
    let sheets = sheets::sheets(design, &behaviour, &sizes);
    let checks = walls(design, &sizes);
    Ok(PartSet { parts, marks: Vec::new(), sheets, display: design.units.length.clone(), checks })
}

fn hole(centre_m: [f64; 2], diameter_m: f64, purpose: &str) -> Hole {
    Hole { centre_m, diameter_m, purpose: purpose.to_owned() }
}

fn gears(design: &Design, sizes: &Sizes) -> Result<Vec<Part>, NoPart> {
    let gears = &design.built.gears;
    let names = [("sun", "Sun gear"), ("planet", "Planet gear"), ("ring", "Ring gear")];
    let density = design.gear_material.as_ref().and_then(|m| m.density_kg_per_m3);
    let mut all = Vec::new();
    for (i, (wheel, (name, title))) in sizes.wheels.iter().zip(names).enumerate() {
        let tooth = ToothProfile::new(wheel, None).map_err(|error| no_gear(name, &error))?;
        let holes = match i {
            0 => vec![hole([0.0; 2], sizes.sun_bore_m, "shaft of the input")],
            1 => vec![hole([0.0; 2], sizes.pins_m, "pin of the carrier")],
            _ => rim_holes(sizes),
        };
        let gear = GearPart {
            name,
            title,
            tooth: &tooth,
            thickness_m: gears.face_m,
            chord_error_m: CHORD * gears.module_m,
            outer_radius_m: (i == 2).then_some(0.5 * sizes.ring_m),
            holes,
            material: density.map(|density| ("gears", Some(density))),
            display: &design.units.length,
        };
        let mut part = gear.part().map_err(|error| no_gear(name, &error))?;
        if i == 1 {
            part.count = gears.planets as usize;
            part.notes.push(format!("Hole for the pin: {}.", fitted(design, PIN_IN_PLANET, sizes.pins_m)));
        }
        if gears.backlash_m > 0.0 {
            part.notes.push(format!(
                "Teeth are thinner by {} for the backlash, half of it on each flank.",
                format_si(0.5 * gears.backlash_m, &design.units.length, 3)
            ));
        }
        all.push(part);
    }
    Ok(all)
}

/// A fit and its limits of size.
fn fitted(design: &Design, fit: &str, diameter_m: f64) -> String {
    let limits_m = Fit::parse(fit).ok().and_then(|fit| fit.deviations_m(diameter_m).ok());
    // ISO 286 has not every position at every diameter.
    limits_m.map_or_else(|| "its play as agreed".to_owned(), |limits_m| format!("{fit}, {}", limits_of_size(design, diameter_m, limits_m)))
}

/// What the planets turn on.
fn pin(design: &Design, sizes: &Sizes) -> Result<Part, NoPart> {
    let length_m = sizes.second_plate[1] - sizes.first_plate[0];
    let notes = vec![
        format!("Ground: diameter {}.", fitted(design, PIN, sizes.pins_m)),
        "Pressed into both plates of the carrier, flush; the planets turn on them.".to_owned(),
    ];
    let one = sleeve(design, "pin", "Pin of a planet", [length_m, sizes.pins_m, 0.0], notes)?;
    Ok(Part { count: design.built.gears.planets as usize, ..one })
}

/// Holes that bolt ring and seat together, in the rim outside of the teeth.
fn rim_holes(sizes: &Sizes) -> Vec<Hole> {
    around(BOLTS, sizes.screw_circle_m, sizes.screw_m, "screw or pin of ring and seat")
}

/// Holes that bolt friction ring and chassis together.
fn bolt_holes(sizes: &Sizes, purpose: &str) -> Vec<Hole> {
    around(BOLTS, sizes.bolt_circle_m, sizes.bolt_m, purpose)
}

/// Diameter of the hole through the seat: a wire is left beside the spring's leg.
pub(crate) fn seat_hole_m(design: &Design) -> f64 {
    let wire_m = design.built.spring.wire_m;
    2.0 * (leg_m(design) - 1.5 * wire_m).max(wire_m)
}

/// The disc on the ring that takes the end of the spring; the carrier passes through its middle.
fn seat(design: &Design, sizes: &Sizes, leg_m: f64) -> Part {
    let wire_m = design.built.spring.wire_m;
    let mut holes = rim_holes(sizes);
    holes.push(hole([leg_m, 0.0], 1.05 * wire_m, "end of the spring, along the axis"));
    holes.push(hole([0.0; 2], seat_hole_m(design), "hub and shaft of the output"));
    let notes = vec![
        format!(
            "It stands off the ring by {} and what play the carrier's plate needs, which turns between them: spacers on the screws.",
            format_si(sizes.ring_spacers_m(), &design.units.length, 4)
        ),
        "The hole for the spring is tight: its end must not tilt. It ends flush with the side of the carrier.".to_owned(),
    ];
    plate(design, "ring-seat", "Seat of the spring on the ring", [sizes.ring_m, sizes.plate_m()], holes, notes)
}

/// Limits of size of a diameter.
fn limits_of_size(design: &Design, value_m: f64, deviations_m: [f64; 2]) -> String {
    let length = |m: f64| format_si(m, &design.units.length, 6);
    if deviations_m[0] < deviations_m[1] {
        format!("{} to {}", length(value_m + deviations_m[0]), length(value_m + deviations_m[1]))
    } else {
        format!("{}, no tolerance given", length(value_m))
    }
}

fn hub_notes(design: &Design) -> Vec<String> {
    vec![
        format!("Surface A: diameter {}; the shift depends on it.", limits_of_size(design, design.built.hub_m, design.scatter.hub_m)),
        "The spring slips on it in mode II: hard and smooth, ground if it can be.".to_owned(),
        "It is fastened to the carrier, coaxial with the ring.".to_owned(),
    ]
}

/// The ring that the spring is caught in: a plate as thick as its turns are long, so that it has holes for bolts.
fn friction_ring(design: &Design, sizes: &Sizes) -> Result<Part, NoPart> {
    let bore_m = design.built.bore_m;
    let inside =
        sizes.bolt_circle_m - 0.5 * sizes.bolt_m > 0.5 * bore_m && sizes.bolt_circle_m + 0.5 * sizes.bolt_m < 0.5 * sizes.chassis_m;
    if !inside {
        let length = |m: f64| format_si(m, &design.units.length, 4);
        return Err(NoPart {
            code: "E0820",
            message: format!(
                "the friction ring cannot be made: from a bore of {} to a diameter of {} it has no room for bolts of {}",
                length(bore_m),
                length(sizes.chassis_m),
                length(sizes.bolt_m)
            ),
            help: "`parts.chassis_diameter` larger, or `parts.ring_wall` smaller".to_owned(),
        });
    }
    let mut holes = bolt_holes(sizes, "bolt to the chassis");
    holes.push(hole([0.0; 2], bore_m, "surface B"));
    let title = "Friction ring with surface B";
    Ok(plate(design, "friction-ring", title, [sizes.chassis_m, long(sizes.friction_ring)], holes, bore_notes(design)))
}

fn bore_notes(design: &Design) -> Vec<String> {
    vec![
        format!(
            "Surface B: diameter {}; the torque of the shift depends on it.",
            limits_of_size(design, design.built.bore_m, design.scatter.bore_m)
        ),
        "It is bolted to the chassis, coaxial with the hub: an eccentric bore is touched early on one side.".to_owned(),
        "It must reach up to the ring's seat: no turn of the spring may hang between them.".to_owned(),
    ]
}

fn sleeve(design: &Design, name: &str, title: &str, [length_m, outer_m, bore_m]: [f64; 3], notes: Vec<String>) -> Result<Part, NoPart> {
    let body =
        Turned { bore_diameter_m: bore_m, sections: vec![Section::Plain { length_m, radius_m: 0.5 * outer_m }], drillings: Vec::new() };
    body.check().map_err(|error| NoPart {
        code: "E0820",
        message: format!("the {name} cannot be made: {error}"),
        help: "`parts.hub_bore` smaller, or a larger hub".to_owned(),
    })?;
    Ok(Part {
        name: name.to_owned(),
        title: title.to_owned(),
        count: 1,
        material: None,
        density_kg_per_m3: design.making.density_kg_per_m3,
        notes,
        body: Body::Turned(body),
    })
}

/// The spring as it is wound, free: it lies on the hub below and goes into the ring above.
fn coil(design: &Design) -> Coil {
    let spring = &design.built.spring;
    let turns = spring.hub_turns + spring.free_turns + spring.unsupported_turns;
    Coil {
        wire_m: spring.wire_m,
        radius_m: 0.5 * (spring.inner_m + spring.wire_m),
        windings: vec![Winding::even(turns, AIR * spring.wire_m)],
        is_right_handed: spring.right_hand,
        start_rad: 0.0,
        // As long as the seat is thick: beyond it the carrier turns.
        ends: [CoilEnd::Cut, CoilEnd::Axial { bend_m: BEND * spring.wire_m, length_m: design.making.plate_m(design.built.gears.module_m) }],
    }
}

fn spring(design: &Design) -> Result<Part, NoPart> {
    let body = coil(design);
    body.check().map_err(|error| NoPart {
        code: "E0820",
        message: format!("the spring cannot be wound: {error}"),
        help: "`spring.inner_diameter` larger, or `spring.wire_diameter` smaller".to_owned(),
    })?;
    Ok(Part {
        name: "spring".to_owned(),
        title: "Wrap spring".to_owned(),
        count: 1,
        material: design.wire.grade.map(|grade| format!("spring steel wire EN 10270-1 {}", grade.name)),
        density_kg_per_m3: design.wire.density_kg_per_m3,
        notes: spring_notes(design),
        body: Body::Coil(body),
    })
}

/// Distance of the spring's leg from the axis, m.
pub(crate) fn leg_m(design: &Design) -> f64 {
    coil(design).line().pieces().last().map_or(0.0, |leg| {
        let [x, y, _] = leg.at(1.0).point_m;
        maths::hypot(x, y)
    })
}

fn spring_notes(design: &Design) -> Vec<String> {
    let length = |m: f64| format_si(m, &design.units.length, 6);
    let spring = &design.built.spring;
    vec![
        format!("Inner diameter, free: {}; the shift depends on it.", limits_of_size(design, spring.inner_m, design.scatter.inner_m)),
        format!("Wire: diameter {}.", limits_of_size(design, spring.wire_m, design.scatter.wire_m)),
        "The lower end, cut square, lies free on the hub; the upper one goes through the seat of the ring.".to_owned(),
        format!("The leg lies {} from the axis.", length(leg_m(design))),
        "Drawn free and even, a tenth of the wire between turns; `spring.csv` says how it is ordered.".to_owned(),
    ]
}

fn plate(design: &Design, name: &str, title: &str, [diameter_m, depth_m]: [f64; 2], holes: Vec<Hole>, notes: Vec<String>) -> Part {
    Part {
        name: name.to_owned(),
        title: title.to_owned(),
        count: 1,
        material: None,
        density_kg_per_m3: design.making.density_kg_per_m3,
        notes,
        body: Body::Plate(Plate {
            depth_m,
            outline: Profile::circle([0.0; 2], 0.5 * diameter_m),
            cutouts: Vec::new(),
            holes,
            fillets: None,
            trial: Err(RIGID.to_owned()),
        }),
    }
}

/// Holes on a circle, the first on the x axis.
fn around(count: u32, radius_m: f64, diameter_m: f64, purpose: &str) -> Vec<Hole> {
    let one = |i: u32| {
        let (sin, cos) = maths::sin_cos(TAU * f64::from(i) / f64::from(count));
        hole([radius_m * cos, radius_m * sin], diameter_m, purpose)
    };
    (0..count).map(one).collect()
}

/// Both plates: the sun passes through the one, the other carries hub and shaft of the output.
fn carrier(design: &Design, sizes: &Sizes) -> [Part; 2] {
    let size_m = [sizes.carrier_m, sizes.plate_m()];
    let pins = |middle: Hole| {
        let mut holes = around(design.built.gears.planets, sizes.arm_m, sizes.pins_m, "pin of a planet");
        holes.push(middle);
        holes
    };
    let notes = |own: &str| {
        vec![
            format!("Pins of the planets on a radius of {}.", format_si(sizes.arm_m, &design.units.length, 6)),
            format!("Holes for the pins: {}.", fitted(design, PIN_IN_CARRIER, sizes.pins_m)),
            own.to_owned(),
        ]
    };
    let [sun, shaft] = [hole([0.0; 2], sizes.sun_hole_m, "sun with its shaft"), hole([0.0; 2], sizes.shaft_m, "shaft of the output")];
    [
        plate(design, "carrier-input", "Plate of the carrier at the input", size_m, pins(sun), notes("The sun turns in its middle.")),
        plate(
            design,
            "carrier-output",
            "Plate of the carrier at the output",
            size_m,
            pins(shaft),
            notes("Fastened to the shaft of the output, on which the hub sits."),
        ),
    ]
}

fn chassis(design: &Design, sizes: &Sizes) -> Part {
    let mut holes = bolt_holes(sizes, "bolt to the friction ring");
    holes.push(hole([0.0; 2], sizes.shaft_m, "bearing of the output"));
    let spacers = format!(
        "It stands off the friction ring by {}, in which the hub turns: spacers on the bolts.",
        format_si(sizes.chassis_spacers_m(), &design.units.length, 4)
    );
    plate(design, "chassis", "Plate of the chassis", [sizes.chassis_m, sizes.plate_m()], holes, vec![spacers])
}

/// LAVT020: walls between bores and roots, and between the holes of the carrier.
fn walls(design: &Design, sizes: &Sizes) -> Vec<Check> {
    let least_m = LEAST_WALL * design.built.gears.module_m;
    let one = |name: &str, wall_m: f64, basis: &str, fix: &str| {
        Comparison {
            code: "LAVT020",
            name: format!("{name}_wall"),
            title: format!("Wall of the {name}"),
            required: false,
            value: Some(wall_m),
            limit: Some(least_m),
            sense: Sense::AtLeast,
            dimension: Dimension::Length,
            display: design.units.length.clone(),
            scale: None,
            basis: format!("{basis}; a module is kept"),
            fix: fix.to_owned(),
            missing: String::new(),
            partial: false,
            broken: false,
        }
        .judge()
    };
    let teeth = "wall between the bore and the roots of the teeth";
    let [sun, planet, _] = &sizes.wheels;
    let middle_m = sizes.sun_hole_m.max(sizes.shaft_m);
    let holes = "wall between the holes for the pins and the one in the middle, of the plate where it is less";
    vec![
        one("sun", sun.root_radius_m - 0.5 * sizes.sun_bore_m, teeth, "`parts.sun_bore` smaller, or a larger module"),
        one("planet", planet.root_radius_m - 0.5 * sizes.pins_m, teeth, "`parts.planet_bore` smaller, or a larger module"),
        one("carrier", sizes.arm_m - 0.5 * (sizes.pins_m + middle_m), holes, "`parts.planet_bore` or `parts.hub_bore` smaller"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the limits of ISO 286: no pin is loose in the carrier, none is tight in a planet, and neither by much.
    #[test]
    fn pins_are_pressed_into_the_carrier_and_turn_in_the_planets() {
        for tenths in 5..=500 {
            let diameter_m = 1e-4 * f64::from(tenths);
            let [pin, plate, planet] = [PIN, PIN_IN_CARRIER, PIN_IN_PLANET]
                .map(|fit| Fit::parse(fit).expect("a fit").deviations_m(diameter_m).unwrap_or_else(|e| panic!("{diameter_m}: {e}")));
            assert!(plate[1] <= pin[0] + 1e-12 && pin[1] - plate[0] < 45e-6, "{diameter_m}: {pin:?} {plate:?}");
            assert!(planet[0] > pin[1] && planet[1] - pin[0] < 85e-6, "{diameter_m}: {pin:?} {planet:?}");
        }
    }
}
