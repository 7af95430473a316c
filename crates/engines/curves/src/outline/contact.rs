//! The circle that touches two curves: where the curves at its radius beside them cross.

use crate::chords::crossing_of_chords;
use crate::fit::Oriented;
use crate::vector::{Vector, along, cross, distance, dot, norm, right, scale, sub};

/// Chords of each curve between which crossings are looked for, the shorter the nearer to the joint.
const CHORDS: usize = 96;
const ITERATIONS: usize = 30;
/// Step of the differences that give the derivatives for Newton's method.
const DIFFERENCE: f64 = 1e-6;

/// Part of a boundary that leaves a joint, by a parameter that grows away from it.
pub(super) struct Arm<'a> {
    /// The boundary, with the tangent that has material to the left: not always the direction of the parameter.
    pub(super) rim: &'a dyn Fn(f64) -> Oriented,
    pub(super) range: [f64; 2],
    /// Length per parameter, m.
    pub(super) speed_m: f64,
}

impl Arm<'_> {
    /// The centre of a circle outside that touches the boundary.
    pub(super) fn beside(&self, at: f64, radius_m: f64) -> Vector {
        let place = (self.rim)(at);
        along(place.point_m, right(place.tangent), radius_m)
    }

    /// Places dense at the start.
    pub(super) fn places(&self) -> Vec<f64> {
        let [start, end] = self.range;
        let part = |k: usize| k as f64 / CHORDS as f64;
        (0..=CHORDS).map(|k| start + (end - start) * part(k) * part(k)).collect()
    }
}

/// Where a circle touches two arms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub(super) at: [f64; 2],
    pub(super) centre_m: Vector,
}

/// The circle outside both arms that touches them nearest to the joint, to about `exact_m`; with radius 0 their crossing.
pub(super) fn touch(arms: [&Arm; 2], radius_m: f64, exact_m: f64) -> Option<Contact> {
    let places = arms.map(Arm::places);
    let lines = [0, 1].map(|k: usize| places[k].iter().map(|at| arms[k].beside(*at, radius_m)).collect::<Vec<Vector>>());
    let mut crossings = Vec::new();
    for i in 0..CHORDS {
        for j in 0..CHORDS {
            let chords = [[lines[0][i], lines[0][i + 1]], [lines[1][j], lines[1][j + 1]]];
            if let Some([s, t]) = crossing_of_chords(chords[0], chords[1]) {
                let at = |k: usize, index: usize, part: f64| {
                    let (from, to) = (places[k][index], places[k][index + 1]);
                    from + part * (to - from)
                };
                let (a, b) = (at(0, i, s), at(1, j, t));
                let reach = (a - arms[0].range[0]) * arms[0].speed_m + (b - arms[1].range[0]) * arms[1].speed_m;
                let widths = [places[0][i + 1] - places[0][i], places[1][j + 1] - places[1][j]];
                crossings.push((reach, [a, b], widths));
            }
        }
    }
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
    crossings.into_iter().find_map(|(_, at, widths)| settle(arms, radius_m, exact_m, at, widths))
}

/// Newton's method from a crossing of chords; refused if it leaves them by more than their length.
fn settle(arms: [&Arm; 2], radius_m: f64, exact_m: f64, start: [f64; 2], widths: [f64; 2]) -> Option<Contact> {
    let mut at = start;
    for _ in 0..ITERATIONS {
        let [a, b] = [0, 1].map(|k: usize| arms[k].beside(at[k], radius_m));
        let off = sub(b, a);
        let slope = |k: usize| {
            // A curve beside another has its tangent; only its speed needs a difference.
            let [low, high] = [at[k] - DIFFERENCE, at[k] + DIFFERENCE].map(|place| arms[k].beside(place, radius_m));
            let tangent = (arms[k].rim)(at[k]).tangent;
            scale(tangent, dot(tangent, sub(high, low)) / (2.0 * DIFFERENCE))
        };
        let (by_a, by_b) = (slope(0), slope(1));
        let denominator = cross(by_a, by_b);
        let steps = [cross(off, by_b) / denominator, cross(off, by_a) / denominator];
        if !(steps[0].is_finite() && steps[1].is_finite()) {
            return None;
        }
        at = [at[0] + steps[0], at[1] + steps[1]];
        if (0..2).any(|k| (at[k] - start[k]).abs() > 2.0 * widths[k]) {
            return None;
        }
        if norm([steps[0] * arms[0].speed_m, steps[1] * arms[1].speed_m]) <= 1e-4 * exact_m {
            break;
        }
    }
    let [a, b] = [0, 1].map(|k: usize| arms[k].beside(at[k], radius_m));
    let within = (0..2).all(|k| at[k] >= arms[k].range[0] && at[k] <= arms[k].range[1]);
    (within && distance(a, b) <= exact_m).then_some(Contact { at, centre_m: a })
}
