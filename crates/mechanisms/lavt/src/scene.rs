//! The transmission as pictures: the gears through both modes, the spring under its torque, and a section along the axis.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_elements::gears::{ToothProfile, Wheel};
use forcewright_model::{Axis, Film, Frame, Item, Look, Role, Scene};

use crate::analysis::Behaviour;
use crate::design::Design;
use crate::parts::{leg_m, seat_hole_m};
use crate::sizes::{Sizes, long};

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
    /// Its teeth, and the radius of its outside.
    ring: Vec<Point>,
    ring_m: f64,
    teeth: [f64; 3],
    planets: usize,
    arm_m: f64,
    pin_m: f64,
}

impl Train {
    fn new(design: &Design, behaviour: &Behaviour) -> Option<Self> {
        let Sizes { wheels: [sun, planet, ring], ring_m, arm_m, pins_m, .. } = Sizes::of(design, &behaviour.train);
        Some(Self {
            sun: teeth(&sun)?,
            planet: teeth(&planet)?,
            ring: teeth(&ring)?,
            ring_m: 0.5 * ring_m,
            teeth: design.built.gears.teeth.map(f64::from),
            planets: usize::try_from(design.built.gears.planets).ok()?,
            arm_m,
            pin_m: 0.5 * pins_m,
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
        let mut items = vec![
            Item::Disc { centre: [0.0; 2], radius_m: self.ring_m, role: named(Look::Plate, "ring") },
            Item::Body { corners: turned(&self.ring, ring_rad, [0.0; 2]), role: named(Look::Opening, "") },
        ];
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

/// Upper half of a section along the axis, which is the x axis: the parts at the places and with the sizes that [`Sizes`] gives them.
pub(crate) fn section(design: &Design, behaviour: &Behaviour) -> Scene {
    let (built, spring) = (&design.built, &design.built.spring);
    let sizes = Sizes::of(design, &behaviour.train);
    let shaft_m = 0.5 * sizes.shaft_m;
    let end_m = sizes.envelope_m[1];
    let beyond_m = long(sizes.first_plate);
    let mut items = discs(design, &sizes);
    items.push(block([sizes.gears[0] - 2.0 * beyond_m, sizes.gears[1]], [0.0, sun_tip_m(&sizes)], named(Look::Moving, "sun and planet")));
    items.push(block([sizes.second_plate[0], end_m + beyond_m], [0.0, shaft_m], named(Look::Moving, "shaft of the output")));
    items.push(block(sizes.hub, [shaft_m, 0.5 * built.hub_m], named(Look::Plate, "hub, surface A")));
    items.extend(coil(design, behaviour, &sizes));
    items.push(line(vec![[-2.0 * beyond_m, 0.0], [end_m + 2.0 * beyond_m, 0.0]], 0.0, named(Look::Axis, "axis")));
    let [hub_gap, bore_gap] = built.gaps_m();
    let length = |m: f64| format_si(m, &design.units.length, 4);
    Scene {
        items,
        scale: None,
        words: ["", ""],
        display: design.units.length.clone(),
        description: format!(
            "Upper half of a section along the axis: gears on the left, the spring with {} turns on the hub (δa {}) and {} in the bore (δb {}). {} long without shafts and axial play, diameter {}.",
            format_number(spring.hub_turns, 3),
            length(hub_gap),
            format_number(spring.bore_turns, 3),
            length(bore_gap),
            length(end_m),
            length(sizes.envelope_m[0]),
        ),
    }
}

/// The sun ends where the planet begins.
fn sun_tip_m(sizes: &Sizes) -> f64 {
    let [sun, planet, _] = &sizes.wheels;
    sun.tip_radius_m.min(sizes.arm_m - planet.root_radius_m)
}

/// Rings, plates, bolts and pins around the middle.
fn discs(design: &Design, sizes: &Sizes) -> Vec<Item> {
    let [_, planet, ring] = &sizes.wheels;
    let half = |diameter_m: f64| 0.5 * diameter_m;
    let (ring_m, chassis_m, carrier_m) = (half(sizes.ring_m), half(sizes.chassis_m), half(sizes.carrier_m));
    let around = |circle_m: f64, diameter_m: f64| [circle_m - half(diameter_m), circle_m + half(diameter_m)];
    let [screws, bolts] = [around(sizes.screw_circle_m, sizes.screw_m), around(sizes.bolt_circle_m, sizes.bolt_m)];
    let [ring_look, carrier, fixed] = [named(Look::Plate, "ring and its seat"), named(Look::Bar, "carrier"), named(Look::Plate, "chassis")];
    let (bolt, spacer) = (named(Look::Rail, "screws"), named(Look::Rail, "spacers"));
    let wall_m = sizes.wall_m;
    vec![
        block(sizes.gears, [ring.tip_radius_m, ring_m], ring_look),
        block(sizes.second_plate, around(sizes.screw_circle_m, 0.8 * wall_m), spacer),
        block(sizes.seat, [half(seat_hole_m(design)), ring_m], ring_look),
        block([sizes.gears[0], sizes.seat[1]], screws, bolt),
        block(sizes.gears, around(sizes.arm_m, 2.0 * planet.tip_radius_m), named(Look::Moving, "sun and planet")),
        block(sizes.first_plate, [half(sizes.sun_hole_m), carrier_m], carrier),
        block(sizes.second_plate, [half(sizes.shaft_m), carrier_m], carrier),
        block([sizes.first_plate[0], sizes.second_plate[1]], around(sizes.arm_m, sizes.pins_m), named(Look::Bar, "pin")),
        block(sizes.friction_ring, [half(design.built.bore_m), chassis_m], named(Look::Plate, "friction ring, surface B")),
        block([sizes.friction_ring[1], sizes.chassis[0]], around(sizes.bolt_circle_m, 0.8 * wall_m), spacer),
        block(sizes.chassis, [half(sizes.shaft_m), chassis_m], fixed),
        block([sizes.friction_ring[0], sizes.chassis[1]], bolts, bolt),
    ]
}

/// The wire where it passes through the section, and its end in the seat.
fn coil(design: &Design, behaviour: &Behaviour, sizes: &Sizes) -> Vec<Item> {
    let spring = &design.built.spring;
    let role = named(Look::Wire, "spring");
    let off_hub = spring.unsupported_turns + spring.free_turns;
    let total = off_hub + spring.hub_turns;
    let free_m = behaviour.clutch.dimensions().neutral_radius_m;
    let leg_m = leg_m(design);
    let from_m = sizes.seat[1] + sizes.first_turn_m;
    let mut items = vec![block([sizes.seat[0], from_m], [leg_m - 0.5 * spring.wire_m, leg_m + 0.5 * spring.wire_m], role)];
    items.extend((0_u32..).map(f64::from).take_while(|turn| *turn <= total).map(|turn| {
        // Where it climbs onto the hub it is halfway.
        let climbed = (turn - off_hub + 0.5).clamp(0.0, 1.0);
        let radius_m = free_m + climbed * (behaviour.clutch.hub_radius_m() - free_m);
        Item::Disc { centre: [from_m + turn * sizes.pitch_m, radius_m], radius_m: 0.5 * spring.wire_m, role }
    }));
    items
}
