//! The transmission as pictures: the gears through both modes, the spring under its torque, and a section along the axis.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_elements::gears::{ToothProfile, Wheel};
use forcewright_model::{Axis, Film, Frame, Item, Look, Role, Scene};

use crate::analysis::Behaviour;
use crate::design::Design;
use crate::gears::wheels;

/// Frames of a film in each of its two stretches.
const FRAMES: [usize; 2] = [9, 17];
/// Turn of the input in mode I and in mode II that a film shows, as turns of the carrier.
const TURNS: [f64; 2] = [0.25, 1.0 / 3.0];
/// Distance of a drawn tooth from the exact one, modules.
const CHORD: f64 = 0.02;
/// Points of a circle.
const ROUND: usize = 72;

type Point = [f64; 2];

fn named(look: Look, name: &'static str) -> Role {
    Role::Named(look, name)
}

fn turned(points: &[Point], angle_rad: f64, centre: Point) -> Vec<Point> {
    let (sin, cos) = maths::sin_cos(angle_rad);
    points.iter().map(|[x, y]| [centre[0] + cos * x - sin * y, centre[1] + sin * x + cos * y]).collect()
}

fn circle(radius_m: f64) -> Vec<Point> {
    (0..=ROUND)
        .map(|i| {
            let (sin, cos) = maths::sin_cos(TAU * i as f64 / ROUND as f64);
            [radius_m * cos, radius_m * sin]
        })
        .collect()
}

fn line(points: Vec<Point>, width_m: f64, role: Role) -> Item {
    Item::Line { points, width_m, role, values: None }
}

/// The corners of a drawn gear; `None` where its teeth cannot be drawn.
fn teeth(wheel: &Wheel) -> Option<Vec<Point>> {
    let chord_m = CHORD * wheel.spec.module_m;
    Some(ToothProfile::new(wheel, None).ok()?.outline(0.2 * chord_m).ok()?.profile.tessellate(chord_m))
}

/// The gears as they are drawn, and how they are set.
struct Train {
    sun: Vec<Point>,
    planet: Vec<Point>,
    ring: Vec<Point>,
    teeth: [f64; 3],
    planets: usize,
    arm_m: f64,
    pin_m: f64,
}

impl Train {
    fn new(design: &Design, behaviour: &Behaviour) -> Option<Self> {
        let [sun, planet, ring] = wheels(&design.built.gears).ok()?;
        let outer_m = ring.root_radius_m + design.making.ring_wall_m;
        // One line around both boundaries, with a cut between them.
        let inner = teeth(&ring)?;
        let mut whole = circle(outer_m);
        let near = inner
            .iter()
            .enumerate()
            .min_by(|a, b| maths::hypot(a.1[0] - outer_m, a.1[1]).total_cmp(&maths::hypot(b.1[0] - outer_m, b.1[1])));
        let start = near.map_or(0, |(i, _)| i);
        whole.extend(inner[start..].iter().chain(&inner[..=start]));
        Some(Self {
            sun: teeth(&sun)?,
            planet: teeth(&planet)?,
            ring: whole,
            teeth: design.built.gears.teeth.map(f64::from),
            planets: usize::try_from(design.built.gears.planets).ok()?,
            arm_m: behaviour.train.set.sun_planet.centre_distance_m,
            pin_m: 0.35 * planet.root_radius_m,
        })
    }

    /// The gears with these turns of sun and carrier; the ring follows from them.
    fn items(&self, sun_rad: f64, carrier_rad: f64) -> Vec<Item> {
        let [z_sun, z_planet, z_ring] = self.teeth;
        // Willis: all turns less that of the carrier. At rest sun and carrier point to the right, and the ring is set so that the first
        // planet's teeth stand in its spaces.
        let rolled_rad = sun_rad - carrier_rad;
        let planet_rest_rad = PI - PI / z_planet;
        let ring_rest_rad = -(TAU / z_ring) * ((-planet_rest_rad * z_planet / TAU) + 0.5);
        let ring_rad = ring_rest_rad + carrier_rad - rolled_rad * z_sun / z_ring;
        let mut items = vec![Item::Body { corners: turned(&self.ring, ring_rad, [0.0; 2]), role: named(Look::Plate, "ring") }];
        let mut pins = Vec::new();
        for i in 0..self.planets {
            let place_rad = TAU * i as f64 / self.planets as f64;
            let at_rad = place_rad + carrier_rad;
            let (sin, cos) = maths::sin_cos(at_rad);
            let centre = [self.arm_m * cos, self.arm_m * sin];
            // A tooth of the sun at this place of the carrier needs a space of the planet.
            let sun_phase = place_rad * z_sun / TAU;
            let own_rad = at_rad + PI - (TAU / z_planet) * (0.5 - sun_phase) - rolled_rad * z_sun / z_planet;
            items.push(Item::Body { corners: turned(&self.planet, own_rad, centre), role: named(Look::Plate, "planets") });
            pins.push(centre);
        }
        items.push(Item::Body { corners: turned(&self.sun, sun_rad, [0.0; 2]), role: named(Look::Plate, "sun") });
        for pin in &pins {
            items.push(line(vec![[0.0; 2], *pin], 0.5 * self.pin_m, named(Look::Bar, "carrier")));
        }
        items.extend(pins.iter().map(|pin| Item::Disc { centre: *pin, radius_m: self.pin_m, role: named(Look::Axis, "pins") }));
        items
    }
}

/// The gears through both modes; `None` where their teeth cannot be drawn.
pub(crate) fn gears(design: &Design, behaviour: &Behaviour) -> Option<Film> {
    let train = Train::new(design, behaviour)?;
    let ratio = behaviour.statics.ratio;
    let mut frames = Vec::new();
    let [one, two] = TURNS;
    for i in 0..FRAMES[0] {
        let turns = one * i as f64 / (FRAMES[0] - 1) as f64;
        let note = "mode I: the spring holds ring and carrier together, all turns as one".to_owned();
        frames.push(Frame { at: TAU * turns, note, items: train.items(TAU * turns, TAU * turns) });
    }
    if behaviour.statics.grip_nm.is_some() {
        for i in 1..FRAMES[1] {
            let carrier = two * i as f64 / (FRAMES[1] - 1) as f64;
            let (sun_rad, carrier_rad) = (TAU * (one + carrier / ratio), TAU * (one + carrier));
            let note = "mode II: the bore holds the ring, the carrier turns slowly".to_owned();
            frames.push(Frame { at: sun_rad, note, items: train.items(sun_rad, carrier_rad) });
        }
    }
    let stage = Scene {
        items: Vec::new(),
        scale: None,
        words: ["", ""],
        display: design.units.length.clone(),
        description: "Sun, planets and ring seen along the axis, with the arms of the carrier.".to_owned(),
    };
    let degrees = Unit::parse("deg").unwrap_or_else(|_| Unit::si(Dimension::Angle));
    let axis = Axis { name: "input_turn", label: "Turn of the input".to_owned(), dimension: Dimension::Angle, display: degrees };
    Some(Film { axis, stage, chosen: 0, frames })
}

/// The spring under a growing torque, seen along its axis.
pub(crate) fn spring(design: &Design, behaviour: &Behaviour) -> Film {
    let clutch = &behaviour.clutch;
    let statics = &behaviour.statics;
    let wire_m = design.built.spring.wire_m;
    let most_nm = 1.1 * statics.transition_nm.min(statics.hub_nm);
    let count = FRAMES[0] + FRAMES[1];
    let bore_m = clutch.bore_radius_m();
    let frames = (0..count).map(|i| {
        let torque_nm = most_nm * i as f64 / (count - 1) as f64;
        let carried_nm = torque_nm.min(statics.hub_nm).min(statics.transition_nm);
        let radius_m = clutch.open_radius_m(carried_nm).ok().flatten().map_or(bore_m, |r| r.min(bore_m));
        let note = if torque_nm > statics.hub_nm && statics.grip_nm.is_none() {
            "the spring slips on the hub and opens no further"
        } else if torque_nm >= statics.transition_nm {
            "the bore carries what is more"
        } else {
            "the spring opens and carries the torque to the hub"
        };
        let items = vec![line(circle(radius_m), wire_m, named(Look::Wire, "turns off the hub"))];
        Frame { at: torque_nm, note: note.to_owned(), items }
    });
    let frames: Vec<Frame> = frames.collect();
    let stage = Scene {
        items: vec![
            line(circle(0.5 * design.built.bore_m + 0.5 * wire_m), wire_m, named(Look::Plate, "bore")),
            Item::Disc { centre: [0.0; 2], radius_m: 0.5 * design.built.hub_m, role: named(Look::Moving, "hub") },
            line(circle(clutch.hub_radius_m()), wire_m, named(Look::Comb, "turns on the hub")),
        ],
        scale: None,
        words: ["", ""],
        display: design.units.length.clone(),
        description: "Hub, turns of the spring and bore seen along the axis, to scale.".to_owned(),
    };
    let axis = Axis {
        name: "spring_torque",
        label: "Torque on the spring".to_owned(),
        dimension: Dimension::Torque,
        display: design.units.torque.clone(),
    };
    Film { axis, stage, chosen: frames.len() / 2, frames }
}

fn block(x: [f64; 2], r: [f64; 2], role: Role) -> Item {
    Item::Body { corners: vec![[x[0], r[0]], [x[1], r[0]], [x[1], r[1]], [x[0], r[1]]], role }
}

/// Upper half of a section along the axis, which is the x axis.
pub(crate) fn section(design: &Design, behaviour: &Behaviour) -> Scene {
    let (built, making) = (&design.built, &design.making);
    let set = &behaviour.train.set;
    let spring = &built.spring;
    let (face_m, plate_m, wire_m) = (built.gears.face_m, making.plate_m, spring.wire_m);
    let [sun, planet, ring] = [set.sun_planet.pinion, set.planet_ring.pinion, set.planet_ring.wheel];
    let arm_m = set.sun_planet.centre_distance_m;
    let outer_m = ring.root_radius_m + making.ring_wall_m;
    let pitch_m = 1.1 * wire_m;
    let coil_x = |turn: f64| face_m + plate_m + (turn + 0.5) * pitch_m;
    let bore_end = coil_x(spring.unsupported_turns + spring.bore_turns) - 0.5 * pitch_m;
    let off_hub = spring.unsupported_turns + spring.free_turns;
    let total = off_hub + spring.hub_turns;
    let hub_x = [coil_x(off_hub) - 0.5 * pitch_m, coil_x(total) + 0.5 * wire_m];
    let shaft_m = 0.5 * making.hub_bore_m;
    let bore_outer_m = (0.5 * built.bore_m + making.ring_wall_m).max(outer_m);
    let mut items = vec![
        block([0.0, face_m], [ring.tip_radius_m, outer_m], named(Look::Plate, "ring")),
        // Its rim reaches over the carrier to the seat of the spring's end.
        block([face_m, face_m + 0.55 * plate_m], [ring.root_radius_m, outer_m], named(Look::Plate, "ring")),
        block([face_m + 0.55 * plate_m, face_m + plate_m], [0.5 * built.bore_m - 2.0 * wire_m, outer_m], named(Look::Plate, "ring")),
        block([0.0, face_m], [arm_m - planet.tip_radius_m, arm_m + planet.tip_radius_m], named(Look::Moving, "planet and sun")),
        block([-2.0 * plate_m, face_m], [0.0, sun.tip_radius_m.min(arm_m - planet.root_radius_m)], named(Look::Moving, "planet and sun")),
        block([-0.5 * plate_m, 0.0], [arm_m - 0.5 * planet.root_radius_m, arm_m + 0.5 * planet.root_radius_m], named(Look::Bar, "carrier")),
        block([face_m, face_m + 0.5 * plate_m], [0.0, arm_m + 0.5 * planet.root_radius_m], named(Look::Bar, "carrier")),
        block([face_m + 0.5 * plate_m, hub_x[1]], [0.0, shaft_m], named(Look::Bar, "carrier")),
        block(hub_x, [shaft_m, 0.5 * built.hub_m], named(Look::Plate, "hub, surface A")),
        block(
            [coil_x(spring.unsupported_turns) - 0.5 * pitch_m, bore_end],
            [0.5 * built.bore_m, bore_outer_m],
            named(Look::Plate, "bore, surface B"),
        ),
        block([-plate_m, hub_x[1] + plate_m], [bore_outer_m + wire_m, bore_outer_m + wire_m + 0.5 * plate_m], named(Look::Rail, "chassis")),
    ];
    let clutch = &behaviour.clutch;
    let free_m = clutch.dimensions().neutral_radius_m;
    let whole = (0_u32..).map(f64::from).take_while(|turn| *turn <= total);
    for turn in whole {
        let radius_m = if turn >= off_hub { clutch.hub_radius_m() } else { free_m };
        items.push(Item::Disc { centre: [coil_x(turn), radius_m], radius_m: 0.5 * wire_m, role: named(Look::Wire, "spring") });
    }
    items.push(line(vec![[-2.0 * plate_m, 0.0], [hub_x[1] + 2.0 * plate_m, 0.0]], 0.0, Role::Construction));
    let [hub_gap, bore_gap] = built.gaps_m();
    let length = |m: f64| format_si(m, &design.units.length, 4);
    Scene {
        items,
        scale: None,
        words: ["", ""],
        display: design.units.length.clone(),
        description: format!(
            "Upper half of a section along the axis: gears on the left, the spring with {} turns on the hub (δa {}) and {} in the bore (δb {}).",
            format_number(spring.hub_turns, 3),
            length(hub_gap),
            format_number(spring.bore_turns, 3),
            length(bore_gap)
        ),
    }
}
