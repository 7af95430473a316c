//! What is made of a design: gears, hub, spring, friction ring, plates of carrier and chassis, and the tables of spring, fits and assembly.
//!
//! The gears are the drawn ones of [`forcewright_elements::gears`]; what carries them is simple: plates and sleeves with the diameters that
//! matter. Keys, bearings and housing are the business of the machine around.

mod sheets;

use std::f64::consts::TAU;

use forcewright_base::maths;
use forcewright_base::units::{Dimension, format_si};
use forcewright_contract::gears::GearPart;
use forcewright_contract::judge::Comparison;
use forcewright_curves::Profile;
use forcewright_elements::gears::{GearError, ToothProfile, Wheel};
use forcewright_model::{Body, Check, Coil, CoilEnd, Hole, NoPart, Part, PartSet, Plate, Section, Sense, Turned, Winding};

use crate::analysis::Behaviour;
use crate::design::Design;
use crate::gears::wheels;

/// Distance of the drawn teeth from the exact ones, modules.
const CHORD: f64 = 5e-4;
/// Turns beside each other, over the wire: a little air.
pub(crate) const AIR: f64 = 1.1;
/// Bend of the end that goes into the ring, in the middle of the wire, and the leg beyond it, wires.
const BEND: f64 = 1.5;
const LEG: f64 = 3.0;
/// Least wall between a bore and the roots of teeth, modules.
const LEAST_WALL: f64 = 1.0;
/// Bores of sun and planets where the project gives none, over their root diameters.
const BORE: f64 = 1.0 / 3.0;
/// Holes that bolt the friction ring and the plates together.
const BOLTS: u32 = 4;

/// Why no finite elements of them are of use.
const RIGID: &str = "the parts of a transmission are taken as rigid";

fn no_gear(name: &str, error: &GearError) -> NoPart {
    NoPart {
        code: "E0820",
        message: format!("the {name} cannot be drawn: {error}"),
        help: "change its profile shift, tip shortening or bore; `forcewright synthesise` finds shifts that run".to_owned(),
    }
}

/// Sizes that parts and tables share, m.
struct Sizes {
    wheels: [Wheel; 3],
    arm_m: f64,
    outer_m: f64,
    pins_m: f64,
    sun_bore_m: f64,
    hub_length_m: f64,
    bore_length_m: f64,
    chassis_m: f64,
}

impl Sizes {
    fn of(design: &Design, behaviour: &Behaviour) -> Result<Self, NoPart> {
        let refused = |message: String| NoPart { code: "E0820", message, help: "see `forcewright check`".to_owned() };
        let wheels = wheels(&design.built.gears).map_err(refused)?;
        let [sun, planet, ring] = &wheels;
        let (making, spring) = (&design.making, &design.built.spring);
        let pitch_m = AIR * spring.wire_m;
        let outer_m = 2.0 * (ring.root_radius_m + making.ring_wall_m);
        Ok(Self {
            arm_m: behaviour.train.set.sun_planet.centre_distance_m,
            outer_m,
            pins_m: making.planet_bore_m.unwrap_or(2.0 * BORE * planet.root_radius_m),
            sun_bore_m: making.sun_bore_m.unwrap_or(2.0 * BORE * sun.root_radius_m),
            hub_length_m: (spring.hub_turns + 1.0) * pitch_m,
            bore_length_m: (spring.bore_turns + 0.5) * pitch_m,
            chassis_m: making.chassis_m.unwrap_or(outer_m.max(design.built.bore_m) + 2.0 * making.ring_wall_m),
            wheels,
        })
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
    let sizes = Sizes::of(design, &behaviour)?;
    let mut parts = gears(design, &sizes)?;
    parts.push(sleeve(
        design,
        "hub",
        "Hub with surface A",
        [sizes.hub_length_m, design.built.hub_m, design.making.hub_bore_m],
        &hub_notes(design),
    )?);
    parts.push(spring(design)?);
    parts.push(seat(design, &sizes, leg_m(&coil(design))));
    parts.push(sleeve(
        design,
        "friction-ring",
        "Friction ring with surface B",
        [sizes.bore_length_m, sizes.chassis_m, design.built.bore_m],
        &bore_notes(design),
    )?);
    parts.push(carrier(design, &sizes));
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
            _ => rim_holes(design, sizes),
        };
        let gear = GearPart {
            name,
            title,
            tooth: &tooth,
            thickness_m: gears.face_m,
            chord_error_m: CHORD * gears.module_m,
            outer_radius_m: (i == 2).then_some(0.5 * sizes.outer_m),
            holes,
            material: density.map(|density| ("gears", Some(density))),
            display: &design.units.length,
        };
        let mut part = gear.part().map_err(|error| no_gear(name, &error))?;
        if i == 1 {
            part.notes.push(format!("Make {} of them.", gears.planets));
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

/// Holes that bolt ring and seat together, in the rim outside of the teeth.
fn rim_holes(design: &Design, sizes: &Sizes) -> Vec<Hole> {
    let middle_m = 0.5 * (sizes.wheels[2].root_radius_m + 0.5 * sizes.outer_m);
    around(BOLTS, middle_m, 0.4 * design.making.ring_wall_m, "screw or pin of ring and seat")
}

/// The disc on the ring that takes the end of the spring; the carrier passes through its middle.
fn seat(design: &Design, sizes: &Sizes, leg_m: f64) -> Part {
    let wire_m = design.built.spring.wire_m;
    let mut holes = rim_holes(design, sizes);
    holes.push(hole([leg_m, 0.0], 1.05 * wire_m, "end of the spring, along the axis"));
    holes.push(hole([0.0; 2], 2.0 * (leg_m - 1.5 * wire_m).max(wire_m), "hub and carrier"));
    let notes = vec![
        "It stands off the ring by the thickness of the carrier's plate, which turns between them: washers on the screws.".to_owned(),
        "The hole for the spring is tight: its end must not tilt.".to_owned(),
    ];
    plate(design, "ring-seat", "Seat of the spring on the ring", sizes.outer_m, holes, notes)
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

fn bore_notes(design: &Design) -> Vec<String> {
    vec![
        format!(
            "Surface B: diameter {}; the torque of the shift depends on it.",
            limits_of_size(design, design.built.bore_m, design.scatter.bore_m)
        ),
        "It is fastened to the chassis, coaxial with the hub: an eccentric bore is touched early on one side.".to_owned(),
        "It must reach up to the ring: no turn of the spring may hang between them.".to_owned(),
    ]
}

fn sleeve(design: &Design, name: &str, title: &str, [length_m, outer_m, bore_m]: [f64; 3], notes: &[String]) -> Result<Part, NoPart> {
    let body =
        Turned { bore_diameter_m: bore_m, sections: vec![Section::Plain { length_m, radius_m: 0.5 * outer_m }], drillings: Vec::new() };
    body.check().map_err(|error| NoPart {
        code: "E0820",
        message: format!("the {name} cannot be made: {error}"),
        help: "`parts.hub_bore` smaller, or `parts.chassis_diameter` larger".to_owned(),
    })?;
    Ok(Part {
        name: name.to_owned(),
        title: title.to_owned(),
        count: 1,
        material: None,
        density_kg_per_m3: design.making.density_kg_per_m3,
        notes: notes.to_vec(),
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
        ends: [CoilEnd::Cut, CoilEnd::Axial { bend_m: BEND * spring.wire_m, length_m: LEG * spring.wire_m }],
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
        notes: spring_notes(design, &body),
        body: Body::Coil(body),
    })
}

/// Distance of the leg from the axis, m.
fn leg_m(coil: &Coil) -> f64 {
    coil.line().pieces().last().map_or(0.0, |leg| {
        let [x, y, _] = leg.at(1.0).point_m;
        maths::hypot(x, y)
    })
}

fn spring_notes(design: &Design, coil: &Coil) -> Vec<String> {
    let length = |m: f64| format_si(m, &design.units.length, 6);
    let spring = &design.built.spring;
    vec![
        format!("Inner diameter, free: {}; the shift depends on it.", limits_of_size(design, spring.inner_m, design.scatter.inner_m)),
        format!("Wire: diameter {}.", limits_of_size(design, spring.wire_m, design.scatter.wire_m)),
        "The lower end, cut square, lies free on the hub; the upper one goes into the ring.".to_owned(),
        format!("The leg lies {} from the axis.", length(leg_m(coil))),
        "Drawn free and even, a tenth of the wire between turns; `spring.csv` says how it is ordered.".to_owned(),
    ]
}

fn plate(design: &Design, name: &str, title: &str, diameter_m: f64, holes: Vec<Hole>, notes: Vec<String>) -> Part {
    Part {
        name: name.to_owned(),
        title: title.to_owned(),
        count: 1,
        material: None,
        density_kg_per_m3: design.making.density_kg_per_m3,
        notes,
        body: Body::Plate(Plate {
            depth_m: design.making.plate_m,
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

fn carrier(design: &Design, sizes: &Sizes) -> Part {
    let mut holes = around(design.built.gears.planets, sizes.arm_m, sizes.pins_m, "pin of a planet");
    // The tip of the sun passes through the plate on the side of the input.
    holes.push(hole([0.0; 2], 2.0 * sizes.wheels[0].tip_radius_m + 2.0 * design.built.gears.module_m, "sun with its shaft"));
    let diameter_m = 2.0 * sizes.arm_m + 3.0 * sizes.pins_m;
    let notes = vec![
        format!("Pins of the planets on a radius of {}.", format_si(sizes.arm_m, &design.units.length, 6)),
        "Make two: one on each side of the planets; the one away from the input carries the hub and has no hole in its middle but the output's."
            .to_owned(),
    ];
    plate(design, "carrier", "Plate of the carrier", diameter_m, holes, notes)
}

fn chassis(design: &Design, sizes: &Sizes) -> Part {
    let bolt_m = 0.5 * design.making.ring_wall_m;
    let circle_m = 0.25 * (sizes.chassis_m + design.built.bore_m.max(sizes.outer_m));
    let mut holes = around(BOLTS, circle_m, bolt_m, "bolt to the friction ring");
    holes.push(hole([0.0; 2], design.making.hub_bore_m, "bearing of the output"));
    plate(design, "chassis", "Plate of the chassis", sizes.chassis_m, holes, Vec::new())
}

/// LAVT020: walls between bores and roots.
fn walls(design: &Design, sizes: &Sizes) -> Vec<Check> {
    let least_m = LEAST_WALL * design.built.gears.module_m;
    let one = |(name, wheel, bore_m): (&str, &Wheel, f64)| {
        Comparison {
            code: "LAVT020",
            name: format!("{name}_wall"),
            title: format!("Wall of the {name}"),
            required: false,
            value: Some(wheel.root_radius_m - 0.5 * bore_m),
            limit: Some(least_m),
            sense: Sense::AtLeast,
            dimension: Dimension::Length,
            display: design.units.length.clone(),
            scale: None,
            basis: "wall between the bore and the roots of the teeth; a module is kept".to_owned(),
            fix: format!("`parts.{name}_bore` smaller, or a larger module"),
            missing: String::new(),
            partial: false,
            broken: false,
        }
        .judge()
    };
    [("sun", &sizes.wheels[0], sizes.sun_bore_m), ("planet", &sizes.wheels[1], sizes.pins_m)].into_iter().map(one).collect()
}
