//! Prescribed motions of the disc, and the torque that they need.

use super::mechanism::{Instant, Mechanism, NotAssembled};
use crate::analysis::JUST_ABOVE;
use crate::mechanism::Sense;
use crate::motion::Motion;

/// An instant of a motion.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// s.
    pub time_s: f64,
    /// Turn θ, rad.
    pub turn_rad: f64,
    /// rad/s.
    pub speed_rad_per_s: f64,
    /// Forces in the motion.
    pub moving: Instant,
    /// Forces at rest at the same place, with the same friction.
    pub resting: Instant,
}

/// Forces over a motion whose travel is the turn in rad, at even times in each phase.
///
/// # Errors
/// [`NotAssembled`] if no roller stands on the disc on the way, or the motion needs more than any torque.
pub fn prescribed(mechanism: &Mechanism, motion: &Motion) -> Result<Vec<Moment>, NotAssembled> {
    let above = JUST_ABOVE * mechanism.cut.purpose().turn_rad;
    let one = |(sense, time_s, [turn_rad, speed, acceleration]): (Sense, f64, [f64; 3])| {
        let at = |turn: f64| {
            let pose = mechanism.pose(turn)?;
            let moving = mechanism.forces(&pose, [speed, acceleration], sense);
            let resting = mechanism.at_rest(&pose, sense);
            Ok(Moment { time_s, turn_rad, speed_rad_per_s: speed, moving, resting })
        };
        let found: Moment = at(turn_rad)?;
        let is_determined = |m: &Moment| (m.moving.torque_nm + m.resting.torque_nm).is_finite();
        // At the start of a path that leaves straight outwards: 0/0, whose limit is the torque just above.
        let found = if is_determined(&found) { found } else { at(turn_rad + above)? };
        if is_determined(&found) { Ok(found) } else { Err(NotAssembled { gap_m: f64::NAN }) }
    };
    motion.instants().map(one).collect()
}
