//! Room between the corner at the tip of a tooth and the fillet of its mate. Theory: `docs/theory/gears.md`.

use std::f64::consts::{FRAC_PI_2, PI};

use forcewright_base::maths::{acos, atan2, cos, sin_cos};
use forcewright_base::roots;

use super::fillet::{Arc, Trochoid};
use super::{Kind, Mesh, Wheel};

/// Looks at the way of a corner through a fillet, in and out.
const LOOKS: i32 = 12;
/// Of the reference radius: rooms below are rounding. Where contact begins at the end of the fillet, room is 0 by definition.
const ROUNDING: f64 = 1e-12;

/// The fillet of a gear, from the flank to the root circle.
enum Fillet {
    Trochoid(Trochoid),
    Arc(Arc),
}

impl Fillet {
    /// Radius (m) and angle from the middle of the space (rad).
    fn point(&self, place: f64) -> (f64, f64) {
        match self {
            Self::Trochoid(trochoid) => trochoid.point(place),
            Self::Arc(arc) => arc.point(place),
        }
    }
}

/// A tip corner of a mate on its way past the fillet of a gear, the flank of that corner in contact.
struct Passing {
    fillet: Fillet,
    /// Places on the fillet: where it leaves the flank, and the deepest to which the corner comes.
    ends: [f64; 2],
    centre_distance_m: f64,
    tip_radius_m: f64,
    /// Of the mate's centre, seen from the gear: its side, and the side of it on which the pitch point lies.
    sides: [f64; 2],
    /// Turns of the gear per turn of the mate.
    ratio: f64,
    /// From the pitch point to the middle of the space of the gear, and to the corner of the mate, when they touch there, rad.
    at_pitch_rad: [f64; 2],
}

impl Passing {
    /// None if the corner does not come so deep as the fillet.
    fn new(gear: &Wheel, mate: &Wheel, centre_distance_m: f64, pressure_angle_rad: f64) -> Option<Self> {
        let (sign, fillet, [form, root]) = match gear.spec.kind {
            Kind::External => {
                let trochoid = Trochoid::new(gear);
                let end = trochoid.end(gear).0;
                (1.0, Fillet::Trochoid(trochoid), [end, FRAC_PI_2])
            }
            Kind::Internal => {
                let arc = Arc::new(gear)?;
                (-1.0, Fillet::Arc(arc), [arc.end_rad(gear), 0.0])
            }
        };
        let sides = match (gear.spec.kind, mate.spec.kind) {
            (Kind::External, Kind::External) => [1.0, -1.0],
            (Kind::External, Kind::Internal) => [-1.0, -1.0],
            (Kind::Internal, _) => [1.0, 1.0],
        };
        let deepest_m = (centre_distance_m + sides[1] * mate.tip_radius_m).abs();
        // Above 0 where the fillet is reached.
        let below = |place: f64| (fillet.point(place).0 - deepest_m) * sign;
        if below(form) <= 0.0 {
            return None;
        }
        let deep = if below(root) >= 0.0 { root } else { roots::root(below, form, root, 1e-13).ok()? };
        let half_rad = |wheel: &Wheel, radius_m: f64| wheel.tooth_angle_rad(radius_m) / 2.0;
        let pitch_m = |wheel: &Wheel| wheel.base_radius_m / cos(pressure_angle_rad);
        let at_pitch_rad = [
            PI / f64::from(gear.spec.teeth) - half_rad(gear, pitch_m(gear)),
            half_rad(mate, pitch_m(mate)) - half_rad(mate, mate.tip_radius_m),
        ];
        let ratio = f64::from(mate.spec.teeth) / f64::from(gear.spec.teeth);
        Some(Self { fillet, ends: [form, deep], centre_distance_m, tip_radius_m: mate.tip_radius_m, sides, ratio, at_pitch_rad })
    }

    /// Room along the circle about the gear, m. From −1, on the way in, over 0, where the corner is deepest, to 1, on the way out.
    fn room_m(&self, way: f64) -> f64 {
        let ([form, deep], [side, towards]) = (self.ends, self.sides);
        let (a, tip_m) = (self.centre_distance_m, self.tip_radius_m);
        let (radius_m, fillet_rad) = self.fillet.point(deep + (form - deep) * way * way);
        // Where the corner passes this radius, from the direction of the pitch point.
        let cosine = (radius_m * radius_m - a * a - tip_m * tip_m) / (2.0 * towards * a * tip_m);
        let turned_rad = acos(cosine.clamp(-1.0, 1.0)).copysign(way);
        let (sin, cos) = sin_cos(turned_rad);
        let corner_rad = atan2(tip_m * sin, side * (a + towards * tip_m * cos));
        let middle_rad = (turned_rad - self.at_pitch_rad[1]) * self.ratio + self.at_pitch_rad[0];
        (corner_rad - middle_rad + fillet_rad) * radius_m
    }

    fn least_m(&self) -> f64 {
        let at = |k: i32| f64::from(k.clamp(-LOOKS, LOOKS)) / f64::from(LOOKS);
        let room = |way: f64| self.room_m(way);
        let coarse = (-LOOKS..=LOOKS).min_by(|a, b| room(at(*a)).total_cmp(&room(at(*b)))).unwrap_or(0);
        roots::minimise(room, at(coarse - 1), at(coarse + 1), 1e-7).value.min(room(at(coarse)))
    }
}

/// Least room of the tip corner of a mate in the fillet of a gear, along the circle about the gear, m. None where it does not come so deep.
pub(super) fn room_m(gear: &Wheel, mate: &Wheel, centre_distance_m: f64, pressure_angle_rad: f64) -> Option<f64> {
    let least_m = Passing::new(gear, mate, centre_distance_m, pressure_angle_rad)?.least_m();
    Some(if least_m.abs() <= ROUNDING * gear.reference_radius_m { 0.0 } else { least_m })
}

/// Rooms of the wheel's tip in the fillet of the pinion, and of the pinion's tip in that of the wheel, m.
pub(super) fn rooms_m(mesh: &Mesh) -> [Option<f64>; 2] {
    let Mesh { pinion, wheel, centre_distance_m, pressure_angle_rad } = mesh;
    [(pinion, wheel), (wheel, pinion)].map(|(gear, mate)| room_m(gear, mate, *centre_distance_m, *pressure_angle_rad))
}
