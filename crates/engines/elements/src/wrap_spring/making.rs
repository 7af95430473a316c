//! What is needed to have a coil made: hand, length of wire, room, tolerances, ends.

use std::f64::consts::PI;

use super::{WrapSpringError, bending_pa, not_negative, positive, wahl_factors};
use crate::springs::wire;
use forcewright_base::maths::hypot;

/// Hand of a helix. A right-hand one goes away from the viewer as it is followed clockwise, like the usual screw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hand {
    /// Like a usual screw.
    Right,
    /// Its mirror image.
    Left,
}

/// Sense of a torque on an end of a coil, seen from outside along the axis towards that end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// As the hands of a clock go.
    Clockwise,
    /// Against them.
    Counterclockwise,
}

/// What a torque does to a coil.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// It becomes wider, with fewer turns: slips off a hub, reaches a bore.
    Opens,
    /// It becomes narrower, with more turns: locks on a hub.
    Closes,
}

/// What a torque on one end does, the other end being held. Looked at from outside, both ends of a coil are alike.
///
/// ```
/// use forcewright_elements::wrap_spring::{Effect, Hand, Sense, effect};
///
/// // The end of a right-hand coil, turned clockwise, unwinds it.
/// assert_eq!(effect(Hand::Right, Sense::Clockwise), Effect::Opens);
/// ```
pub fn effect(hand: Hand, sense: Sense) -> Effect {
    match (hand, sense) {
        (Hand::Right, Sense::Clockwise) | (Hand::Left, Sense::Counterclockwise) => Effect::Opens,
        (Hand::Right, Sense::Counterclockwise) | (Hand::Left, Sense::Clockwise) => Effect::Closes,
    }
}

/// A coil to be wound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coil {
    /// Wire diameter, m; above 0.
    pub wire_m: f64,
    /// Mean radius, m; above half of the wire diameter.
    pub radius_m: f64,
    /// All turns; above 0.
    pub turns: f64,
    /// Gap between neighbouring turns, m; at least 0, and 0 for a close-wound coil.
    pub gap_m: f64,
    /// Length of wire in both ends beyond the turns, m; at least 0.
    pub ends_m: f64,
}

/// What winding it takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Winding {
    /// Length of wire, m, with the ends.
    pub wire_length_m: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Axial length of the free coil over the wire, m: `N (d + gap) + d`.
    pub body_m: f64,
    /// Axial length with all turns touching, m: `(N + 1) d`, as N turns of a helix have N + 1 wires on top of each other where they begin.
    pub solid_m: f64,
}

impl Coil {
    /// Wire, mass and axial lengths, for a density (kg/m³, above 0).
    ///
    /// # Errors
    /// [`WrapSpringError::Value`], [`WrapSpringError::NoHole`]
    pub fn winding(&self, density_kg_per_m3: f64) -> Result<Winding, WrapSpringError> {
        positive("wire_m", self.wire_m)?;
        positive("radius_m", self.radius_m)?;
        positive("turns", self.turns)?;
        not_negative("gap_m", self.gap_m)?;
        not_negative("ends_m", self.ends_m)?;
        positive("density_kg_per_m3", density_kg_per_m3)?;
        let index = 2.0 * self.radius_m / self.wire_m;
        if index <= 1.0 {
            return Err(WrapSpringError::NoHole { index });
        }
        let pitch_m = self.wire_m + self.gap_m;
        let wire_length_m = self.turns * hypot(2.0 * PI * self.radius_m, pitch_m) + self.ends_m;
        Ok(Winding {
            wire_length_m,
            mass_kg: density_kg_per_m3 * 0.25 * PI * self.wire_m * self.wire_m * wire_length_m,
            body_m: self.turns * pitch_m + self.wire_m,
            solid_m: (self.turns + 1.0) * self.wire_m,
        })
    }

    /// Axial room (m) that the coil takes at its longest while it turns closed by some turns (at least 0), with a clearance (m, at least
    /// 0): `N d` grows by a wire for each turn. Opening makes it shorter.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`], [`WrapSpringError::NoHole`]
    pub fn room_m(&self, closing_turns: f64, clearance_m: f64) -> Result<f64, WrapSpringError> {
        not_negative("closing_turns", closing_turns)?;
        not_negative("clearance_m", clearance_m)?;
        let body_m = self.winding(1.0)?.body_m;
        Ok(body_m + closing_turns * (self.wire_m + self.gap_m) + clearance_m)
    }
}

/// What an end leg, or tang, carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Force on it, N.
    pub force_n: f64,
    /// Bending stress at the inside of its bend, Pa.
    pub stress_pa: f64,
}

/// An end leg that carries a torque (N·m, at least 0): its force acts at a distance from the axis (`arm_m`, m), and at another from the bend
/// that joins the leg to the coil (`leg_m`, m).
///
/// The stress is that of bending with Wahl's inner factor for the index of the bend, twice its mean radius over the wire. A tang that is
/// bent sharply has the largest stress of the whole spring.
///
/// # Errors
/// [`WrapSpringError::Value`]: with the `index` of the bend if that has no inner radius.
pub fn leg(torque_nm: f64, arm_m: f64, leg_m: f64, bend_radius_m: f64, wire_m: f64) -> Result<Leg, WrapSpringError> {
    not_negative("torque_nm", torque_nm)?;
    positive("arm_m", arm_m)?;
    not_negative("leg_m", leg_m)?;
    positive("bend_radius_m", bend_radius_m)?;
    positive("wire_m", wire_m)?;
    let force_n = torque_nm / arm_m;
    let factor = wahl_factors(2.0 * bend_radius_m / wire_m)?.inner;
    Ok(Leg { force_n, stress_pa: factor * bending_pa(force_n * leg_m, wire_m) })
}

/// Permissible deviation (± m) of the diameter of spring wire of EN 10270-1; absent outside 0.28 … 11 mm, for which it was at hand. See
/// `data/spring_wire.toml`.
pub fn wire_tolerance_m(wire_m: f64) -> Option<f64> {
    // Nominal diameters come in steps: one between two of them belongs to the wider tolerance. The slack is far below any step.
    let row = wire().diameter_tolerances_m.iter().find(|[up_to_m, _]| wire_m <= up_to_m * (1.0 + 1e-9));
    row.filter(|_| wire_m >= 0.28e-3).map(|[_, tolerance_m]| *tolerance_m)
}

/// Mean diameters up to which a row holds, mm, and deviations (± mm) of the grades 1, 2 and 3, each for spring indices up to 8, 14 and 20.
const MEAN_DIAMETER_MM: [(f64, [[f64; 3]; 3]); 12] = [
    (1.0, [[0.05, 0.07, 0.10], [0.07, 0.10, 0.15], [0.10, 0.15, 0.20]]),
    (1.6, [[0.05, 0.07, 0.10], [0.08, 0.10, 0.15], [0.15, 0.20, 0.30]]),
    (2.5, [[0.07, 0.10, 0.15], [0.10, 0.15, 0.20], [0.20, 0.30, 0.40]]),
    (4.0, [[0.10, 0.10, 0.15], [0.15, 0.20, 0.25], [0.30, 0.40, 0.50]]),
    (6.3, [[0.10, 0.15, 0.20], [0.20, 0.25, 0.30], [0.40, 0.50, 0.60]]),
    (10.0, [[0.15, 0.15, 0.20], [0.25, 0.30, 0.35], [0.50, 0.60, 0.70]]),
    (16.0, [[0.15, 0.20, 0.25], [0.30, 0.35, 0.40], [0.60, 0.70, 0.80]]),
    (25.0, [[0.20, 0.25, 0.30], [0.35, 0.45, 0.50], [0.70, 0.90, 1.00]]),
    (31.5, [[0.25, 0.30, 0.35], [0.40, 0.50, 0.60], [0.80, 1.00, 1.20]]),
    (40.0, [[0.25, 0.30, 0.35], [0.50, 0.60, 0.70], [1.00, 1.20, 1.50]]),
    (50.0, [[0.30, 0.40, 0.50], [0.60, 0.80, 0.90], [1.20, 1.50, 1.80]]),
    (63.0, [[0.40, 0.50, 0.60], [0.80, 1.00, 1.10], [1.50, 2.00, 2.30]]),
];

/// Permissible deviation (± m) of the mean diameter of a cold-coiled spring of round wire in a grade 1 (fine) to 3 (coarse); absent outside
/// mean diameters of 0.63 … 63 mm and spring indices of 4 … 20.
///
/// From DIN 2095 for compression springs (`din2095`), as the maker Sodemann prints it, and DIN 2097 for extension springs (`din2097`), as
/// Gutekunst does: the values are the same. DIN 2194 for torsion springs could not be looked up. The table says what a coil is like that comes off the machine: gaps of a few tenths of a millimetre, as clutches have them, need a coil
/// that is sorted or ground to its hub.
pub fn mean_diameter_tolerance_m(mean_m: f64, wire_m: f64, grade: u8) -> Option<f64> {
    let index = mean_m / wire_m;
    let column = [8.0, 14.0, 20.0].iter().position(|limit| index <= *limit)?;
    let row = MEAN_DIAMETER_MM.iter().find(|(up_to_mm, _)| mean_m <= 1e-3 * up_to_mm)?;
    let grade = usize::from(grade).checked_sub(1)?;
    let in_range = index >= 4.0 && mean_m >= 0.63e-3;
    row.1.get(grade).filter(|_| in_range).map(|line| 1e-3 * line[column])
}
