//! Rigid zones where beams of finite thickness meet in a joint.
//!
//! Two beams that leave a node at an angle α are one block of material as far as the inner face of each lies inside the other:
//!
//! `s_i = (h_j + h_i cos α)/sin α`
//!
//! with half thicknesses h and beams taken as straight near the node. Where the corner of the inner faces would lie behind the node
//! of beam j, the face of beam i leaves through the end of beam j instead, at `s_i = h_i tan(π − α)`; where it would lie behind the
//! node of beam i, beam i has no zone. Of several beams at a node the one with the longest zone counts. A beam is rigid along its
//! zones and bends between them. Fillets, which lengthen the zones, are not part of it.

use forcewright_base::maths;

use crate::{
    error::NetworkError,
    network::{Joint, Joints, Network, is_zero},
};

/// Least part of a beam that has to remain flexible.
const LEAST_FLEXIBLE: f64 = 0.05;

/// The rigid zone at one end of a beam.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Zone {
    /// How far it reaches along the beam, m.
    pub(crate) length_m: f64,
    /// What it depends on; `None` if there is no zone.
    pub(crate) cause: Option<Cause>,
}

/// What the length of a zone depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cause {
    /// The other beam, and its end.
    pub(crate) beam: usize,
    pub(crate) end: usize,
    /// By the direction of this beam at the node, m/rad; that of the other has the opposite sign.
    pub(crate) by_angle: f64,
    /// By the thickness of this beam at the node.
    pub(crate) by_own_thickness: f64,
    /// By the thickness of the other.
    pub(crate) by_other_thickness: f64,
}

/// The zones of all beams.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Zones {
    /// Per beam: the zones at its start and end.
    pub(crate) at: Vec<[Zone; 2]>,
    /// Per beam: the places between which it bends.
    pub(crate) flexible: Vec<[f64; 2]>,
}

/// A side of a beam that is joined rigidly to its node.
struct Side {
    beam: usize,
    end: usize,
    /// Direction in which the beam leaves, rad.
    angle: f64,
    half_m: f64,
    /// From the node to the place, m.
    arm_m: [f64; 2],
}

impl Zones {
    /// Beams that meet in points.
    pub(crate) fn none(network: &Network) -> Self {
        let count = network.beams.len();
        Self { at: vec![[Zone::default(); 2]; count], flexible: vec![[0.0, 1.0]; count] }
    }

    /// Zones at all rigid joints; hinges have none. On a rigid body, beams meet where their arms end at the same place.
    ///
    /// # Errors
    /// [`NetworkError::AllRigid`] where zones leave next to nothing of a beam.
    pub(crate) fn of(network: &Network) -> Result<Self, NetworkError> {
        let mut zones = Self::none(network);
        for node in 0..network.nodes.len() {
            let ends = ends_at(network, node);
            for own in &ends {
                for other in ends.iter().filter(|o| (o.beam, o.end) != (own.beam, own.end) && is_zero(between(o.arm_m, own.arm_m))) {
                    let zone = pair(own, other);
                    let longest = &mut zones.at[own.beam][own.end];
                    if zone.length_m > longest.length_m {
                        *longest = zone;
                    }
                }
            }
        }
        for (beam, b) in network.beams.iter().enumerate() {
            let length_m = b.shape.length_m();
            let [start, end] = zones.at[beam].map(|z| z.length_m / length_m);
            let left = 1.0 - start - end;
            if left.is_nan() || left < LEAST_FLEXIBLE {
                return Err(NetworkError::AllRigid { beam, rigid_m: (start + end) * length_m });
            }
            zones.flexible[beam] = [start, 1.0 - end];
        }
        Ok(zones)
    }
}

impl Network {
    /// Checks that joints leave every beam something to bend; beams that meet in points always do. Not part of [`Network::check`],
    /// because it depends on [`crate::Settings::joints`].
    ///
    /// # Errors
    /// [`NetworkError::AllRigid`] names the first beam that is rigid nearly all along. The network must be sound otherwise.
    pub fn check_joints(&self, joints: Joints) -> Result<(), NetworkError> {
        match joints {
            Joints::Point => Ok(()),
            Joints::Overlap => Zones::of(self).map(|_| ()),
        }
    }
}

fn ends_at(network: &Network, node: usize) -> Vec<Side> {
    let mut ends = Vec::new();
    for (beam, b) in network.beams.iter().enumerate() {
        let sides = [(b.start, b.start_joint, 0.0, 0.0), (b.end, b.end_joint, 1.0, std::f64::consts::PI)];
        for (end, (at, joint, u, turn)) in sides.into_iter().enumerate() {
            if at == node && joint == Joint::Rigid {
                ends.push(Side { beam, end, angle: b.shape.angle_at(u) + turn, half_m: 0.5 * b.thickness_at(u), arm_m: b.arms_m[end] });
            }
        }
    }
    ends
}

fn between(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// The zone of `own` where it meets `other`.
fn pair(own: &Side, other: &Side) -> Zone {
    let difference = own.angle - other.angle;
    let (sin, cos) = maths::sin_cos(difference);
    // α in (0, π), growing with `difference` where the sine is positive.
    let (alpha_sin, sign) = (sin.abs(), if sin < 0.0 { -1.0 } else { 1.0 });
    let (own_reach, other_reach) = (other.half_m + own.half_m * cos, own.half_m + other.half_m * cos);
    if own_reach <= 0.0 {
        return Zone::default();
    }
    let (length_m, by_alpha, by_own, by_other) = if other_reach >= 0.0 {
        (own_reach / alpha_sin, -other_reach / (alpha_sin * alpha_sin), cos / alpha_sin, 1.0 / alpha_sin)
    } else {
        (own.half_m * alpha_sin / -cos, -own.half_m / (cos * cos), alpha_sin / -cos, 0.0)
    };
    let cause = Cause {
        beam: other.beam,
        end: other.end,
        by_angle: sign * by_alpha,
        by_own_thickness: 0.5 * by_own,
        by_other_thickness: 0.5 * by_other,
    };
    Zone { length_m, cause: Some(cause) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn end(angle: f64, half_m: f64) -> Side {
        Side { beam: 0, end: 0, angle, half_m, arm_m: [0.0; 2] }
    }

    #[test]
    fn corners_in_closed_form() {
        // Right angle: half the thickness of the other. Equal beams at any angle: h/tan(α/2).
        assert!((pair(&end(0.0, 1.0), &end(FRAC_PI_2, 3.0)).length_m - 3.0).abs() < 1e-15);
        for alpha in [0.3, 1.0, 2.0, 3.0] {
            let want = 1.0 / maths::tan(0.5 * alpha);
            assert!((pair(&end(0.2 + alpha, 1.0), &end(0.2, 1.0)).length_m - want).abs() < 1e-13);
            assert!((pair(&end(0.2 - alpha, 1.0), &end(0.2, 1.0)).length_m - want).abs() < 1e-13);
        }
        // In line there is no block, however thick they are.
        for (own, other) in [(1.0, 1.0), (1.0, 3.0), (3.0, 1.0)] {
            assert!(pair(&end(PI, own), &end(0.0, other)).length_m < 1e-15);
        }
        // Thin against thick at 135°: through the end of the thick one, at h tan 45°.
        assert!((pair(&end(0.75 * PI, 1.0), &end(0.0, 2.0)).length_m - 1.0).abs() < 1e-15);
        assert!(pair(&end(0.75 * PI, 2.0), &end(0.0, 1.0)).length_m <= 0.0);
    }

    #[test]
    fn dependence_against_differences() {
        for (angle, own, other) in [(0.8, 1.0, 1.4), (-0.8, 1.0, 1.4), (2.0, 0.7, 1.0), (2.6, 0.3, 1.0), (-2.6, 0.3, 1.0)] {
            let value = |a: f64, h: f64, g: f64| pair(&end(a, h), &end(0.0, g)).length_m;
            let cause = pair(&end(angle, own), &end(0.0, other)).cause.unwrap();
            let step = 1e-6;
            let slope = |f: &dyn Fn(f64) -> f64| (f(step) - f(-step)) / (2.0 * step);
            assert!((slope(&|s| value(angle + s, own, other)) - cause.by_angle).abs() < 1e-8);
            assert!((0.5 * slope(&|s| value(angle, own + s, other)) - cause.by_own_thickness).abs() < 1e-8);
            assert!((0.5 * slope(&|s| value(angle, own, other + s)) - cause.by_other_thickness).abs() < 1e-8);
        }
    }
}
