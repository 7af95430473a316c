//! Sizes of the parts and their places along the axis: the same for metrics, parts, section and synthesis.
//!
//! From the input to the output: the first plate of the carrier, the gears, its second plate, the seat of the spring on the ring, the spring
//! with the friction ring around its one end and the hub in the other, the plate of the chassis. Parts that run against each other are
//! taken to touch: axial play, bearings and the shafts outside are the machine's.

use forcewright_elements::gears::Wheel;

use crate::design::Design;
use crate::gears::Train;

/// Turns beside each other, over the wire: a little air.
pub(crate) const AIR: f64 = 1.1;
/// Bend of the end that goes into the seat, in the middle of the wire, wires.
pub(crate) const BEND: f64 = 1.5;
/// What the hub is longer than the coil on it, wires.
const COLLAR: f64 = 0.5;
/// Plates along the axis: two of the carrier, the seat, that of the chassis.
const PLATES: f64 = 4.0;
/// Bores of sun and planets where the project gives none, over their root diameters.
const BORE: f64 = 1.0 / 3.0;
/// Hole through the hub where the project gives none, over the diameter of the hub; and the wall that it leaves to the pins of the carrier,
/// modules.
const SHAFT: f64 = 0.5;
const SHAFT_WALL: f64 = 1.05;
/// Bolts over the wall in which they stand.
const BOLT: f64 = 0.5;
/// Part of a wall that leaves room for bolts: all of it, but for rounding.
const ROOM: f64 = 1.0 - 1e-9;

/// Length of the spring with its hub, from the seat to the chassis, m.
fn spring_m(turns: f64, wire_m: f64) -> f64 {
    (AIR * turns + BEND + 0.5 + COLLAR) * wire_m
}

/// Length of the whole, m.
pub(crate) fn length_m([face_m, plate_m]: [f64; 2], turns: f64, wire_m: f64) -> f64 {
    face_m + PLATES * plate_m + spring_m(turns, wire_m)
}

/// Diameter over the ring, m.
pub(crate) fn ring_m(ring_root_m: f64, wall_m: f64) -> f64 {
    2.0 * (ring_root_m + wall_m)
}

/// Diameter of chassis and friction ring, m: the one that is typed, or a wall for bolts outside of ring and bore.
fn chassis_m(ring_root_m: f64, bore_m: f64, wall_m: f64, typed: Option<f64>) -> f64 {
    typed.unwrap_or_else(|| ring_m(ring_root_m, wall_m).max(bore_m) + 2.0 * wall_m)
}

/// Outer diameter of the whole, m.
pub(crate) fn outer_m(ring_root_m: f64, bore_m: f64, wall_m: f64, chassis: Option<f64>) -> f64 {
    ring_m(ring_root_m, wall_m).max(chassis_m(ring_root_m, bore_m, wall_m, chassis))
}

/// Volume of the cylinder of a diameter and a length, m³.
pub(crate) fn envelope_m3([outer_m, length_m]: [f64; 2]) -> f64 {
    0.25 * std::f64::consts::PI * outer_m * outer_m * length_m
}

/// From and to along the axis, m.
pub(crate) type Along = [f64; 2];

/// Sizes of a design, m. Places along the axis count from the outside of the carrier at the input.
#[derive(Clone, Debug)]
pub(crate) struct Sizes {
    /// Outer diameter and length of the whole.
    pub envelope_m: [f64; 2],
    /// Sun, planet, ring.
    pub wheels: [Wheel; 3],
    /// From the axis to the pins.
    pub arm_m: f64,
    pub pins_m: f64,
    pub sun_bore_m: f64,
    /// Hole for the sun in the first plate of the carrier.
    pub sun_hole_m: f64,
    /// Diameter of the carrier's plates.
    pub carrier_m: f64,
    /// Shaft of the output, and the holes for it.
    pub shaft_m: f64,
    pub ring_m: f64,
    /// Of the ring outside of its teeth, and of the friction ring outside of its bolts.
    pub wall_m: f64,
    /// Screws of ring and seat: their circle, and their holes.
    pub screw_circle_m: f64,
    pub screw_m: f64,
    pub chassis_m: f64,
    /// Bolts of friction ring and chassis: their circle, and their holes.
    pub bolt_circle_m: f64,
    pub bolt_m: f64,
    pub first_plate: Along,
    pub gears: Along,
    pub second_plate: Along,
    pub seat: Along,
    pub friction_ring: Along,
    pub hub: Along,
    pub chassis: Along,
    /// From the seat to the middle of the wire where it begins to wind, and from there from turn to turn.
    pub first_turn_m: f64,
    pub pitch_m: f64,
}

/// Length between two places.
pub(crate) fn long([from_m, to_m]: Along) -> f64 {
    to_m - from_m
}

impl Sizes {
    pub(crate) fn of(design: &Design, train: &Train) -> Self {
        let (built, making, spring) = (&design.built, &design.making, &design.built.spring);
        let [wall_m, plate_m] = [making.wall_m(built.gears.module_m), making.plate_m(built.gears.module_m)];
        let set = &train.set;
        let wheels = [set.sun_planet.pinion, set.planet_ring.pinion, set.planet_ring.wheel];
        let [sun, planet, ring] = &wheels;
        let arm_m = set.sun_planet.centre_distance_m;
        let pins_m = making.planet_bore_m.unwrap_or(2.0 * BORE * planet.root_radius_m);
        let ring_m = ring_m(ring.root_radius_m, wall_m);
        let chassis_m = chassis_m(ring.root_radius_m, built.bore_m, wall_m, making.chassis_m);
        let wire_m = spring.wire_m;
        let pitch_m = AIR * wire_m;
        let after = |[_, from_m]: Along, length_m: f64| [from_m, from_m + length_m];
        let first_plate = [0.0, plate_m];
        let gears = after(first_plate, built.gears.face_m);
        let second_plate = after(gears, plate_m);
        let seat = after(second_plate, plate_m);
        let turns = spring.hub_turns + spring.free_turns + spring.unsupported_turns;
        let whole = after(seat, spring_m(turns, wire_m));
        let first_turn_m = BEND * wire_m;
        // Turns that nothing supports lie before it, and without them it reaches up to the seat.
        let before_m = if spring.unsupported_turns > 0.0 { first_turn_m + spring.unsupported_turns * pitch_m } else { 0.0 };
        let to_m = first_turn_m + (spring.unsupported_turns + spring.bore_turns) * pitch_m;
        let root_m = ring.root_radius_m;
        Self {
            envelope_m: [outer_m(root_m, built.bore_m, wall_m, making.chassis_m), length_m([built.gears.face_m, plate_m], turns, wire_m)],
            arm_m,
            pins_m,
            sun_bore_m: making.sun_bore_m.unwrap_or(2.0 * BORE * sun.root_radius_m),
            sun_hole_m: 2.0 * sun.tip_radius_m + 2.0 * built.gears.module_m,
            carrier_m: 2.0 * arm_m + 3.0 * pins_m,
            shaft_m: making.hub_bore_m.unwrap_or_else(|| {
                let beside_pins_m = 2.0 * arm_m - pins_m - 2.0 * SHAFT_WALL * built.gears.module_m;
                (SHAFT * built.hub_m).min(beside_pins_m.max(built.gears.module_m))
            }),
            ring_m,
            wall_m,
            screw_circle_m: 0.5 * (root_m + 0.5 * ring_m),
            screw_m: 0.4 * wall_m,
            chassis_m,
            bolt_circle_m: bolt_circle_m(wall_m, ring_m.max(built.bore_m), built.bore_m, chassis_m),
            bolt_m: BOLT * wall_m,
            first_plate,
            gears,
            second_plate,
            seat,
            friction_ring: [seat[1] + before_m, seat[1] + to_m],
            hub: [whole[1] - spring.hub_turns * pitch_m - (0.5 + COLLAR) * wire_m, whole[1]],
            chassis: after(whole, plate_m),
            first_turn_m,
            pitch_m,
            wheels,
        }
    }

    /// Thickness of the plates of carrier and chassis, and of the seat.
    pub(crate) fn plate_m(&self) -> f64 {
        long(self.seat)
    }

    /// What the seat stands off the ring.
    pub(crate) fn ring_spacers_m(&self) -> f64 {
        long(self.second_plate)
    }

    /// What the chassis stands off the friction ring.
    pub(crate) fn chassis_spacers_m(&self) -> f64 {
        self.chassis[0] - self.friction_ring[1]
    }
}

/// In the middle of what is outside of ring and bore, or, where the chassis has no wall there, of what is outside of the bore.
fn bolt_circle_m(wall_m: f64, outside_m: f64, bore_m: f64, chassis_m: f64) -> f64 {
    let has_room = chassis_m - outside_m >= 2.0 * wall_m * ROOM;
    0.25 * (chassis_m + if has_room { outside_m } else { bore_m })
}
