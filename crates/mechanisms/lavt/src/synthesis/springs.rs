//! Springs between hub and bore: what of them a gear set asks for, and how far they are from failing.
//!
//! All that gears see of a spring are torques. For one wire, radius and pair of gaps (a [`Seat`]) the moments at the corners of the
//! tolerances are computed once; turns and friction enter as factors that are the same for every seat.

use std::f64::consts::TAU;

use forcewright_base::maths::{exp, ln_1p};
use forcewright_elements::wrap_spring::{END_LOSS_TURNS, opening_slip_nm};

use super::asked::{Asked, can_be_wound};
use super::gears::Class;
use crate::analysis::{PERMISSIBLE, corners_of};
use crate::design::{Built, Source};
use crate::statics::clutch;

/// A limit is kept by so much, so that rounding of the numbers that are written does not matter.
pub(super) const INSIDE: f64 = 1e-9;
/// Steps of Newton's method, of which it needs about five.
const MOST_STEPS: usize = 60;

/// Moments of a spring at one corner of the tolerances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    /// `M_A`, N·m.
    pub hub_nm: f64,
    /// `τ_t`, N·m.
    pub transition_nm: f64,
    flexural_n_m2: f64,
    radius_m: f64,
    interference_m: f64,
}

/// A wire on a radius with its gaps, without turns.
#[derive(Clone, Debug)]
pub(super) struct Seat {
    /// Wire, radius, gap, difference in the grid.
    pub place: [usize; 4],
    /// `M_A` as designed, N·m.
    pub hub_nm: f64,
    /// Distinct corners.
    pub corners: Vec<Corner>,
    /// Those of which no other has less on the hub and more to the bore: the others hold more with any friction.
    pub weakest: Vec<Corner>,
    /// Least and largest `τ_t` and largest `M_A` of the corners, N·m.
    pub transitions_nm: [f64; 2],
    pub most_hub_nm: f64,
    /// Largest stress of the corners, Pa, and the permissible one over it; infinite where the strength is not known.
    pub stress_pa: f64,
    pub safety: f64,
    /// Diameter of the bore and of the wire, m.
    pub bore_m: f64,
    pub wire_m: f64,
}

impl Seat {
    /// A place of the grid: wire, radius, gap, difference; `None` where there is no spring at some corner.
    pub(super) fn new(asked: &Asked, place: [usize; 4]) -> Option<Self> {
        let [wire, radius, gap, difference] = place;
        let built = asked.spring([wire, radius, gap, difference, 0, 0]);
        if !can_be_wound(&built) {
            return None;
        }
        let nominal = clutch(&built, Source::Corrected).ok()?;
        let scatter = asked.scatter(&built, wire)?;
        let mut corners: Vec<Corner> = Vec::with_capacity(16);
        let mut stress_pa: f64 = 0.0;
        for built in corners_of(&built, &scatter) {
            let (corner, pa) = corner(&built)?;
            stress_pa = stress_pa.max(pa);
            if !corners.contains(&corner) {
                corners.push(corner);
            }
        }
        let weaker = |a: &Corner, b: &Corner| a.hub_nm <= b.hub_nm && a.transition_nm >= b.transition_nm;
        let weakest: Vec<Corner> = corners
            .iter()
            .enumerate()
            .filter(|(i, c)| !corners.iter().enumerate().any(|(j, o)| weaker(o, c) && (!weaker(c, o) || j < *i)))
            .map(|(_, c)| *c)
            .collect();
        let least = |of: fn(&Corner) -> f64| corners.iter().map(of).fold(f64::INFINITY, f64::min);
        let most = |of: fn(&Corner) -> f64| corners.iter().map(of).fold(0.0, f64::max);
        Some(Self {
            place,
            hub_nm: nominal.hub_moment_nm(),
            weakest,
            transitions_nm: [least(|c| c.transition_nm), most(|c| c.transition_nm)],
            most_hub_nm: most(|c| c.hub_nm),
            corners,
            stress_pa,
            safety: asked.wires[wire].tensile_pa.map_or(f64::INFINITY, |pa| PERMISSIBLE * pa / stress_pa),
            bore_m: built.bore_m,
            wire_m: built.spring.wire_m,
        })
    }

    /// Whether the wire lasts.
    pub(super) fn lasts(&self, asked: &Asked) -> bool {
        self.safety >= asked.safety * (1.0 + INSIDE) && self.stress_pa * (1.0 + INSIDE) <= asked.stress_pa
    }

    /// Whether the spring reaches the bore at every corner, with a factor of slip.
    pub(super) fn shifts(&self, slip: f64) -> bool {
        self.weakest.iter().all(|c| c.hub_nm * slip > c.transition_nm * (1.0 + INSIDE))
    }

    /// Least torque on the spring that the bore holds at the corners, N·m, for factors of slip and grip with which it shifts.
    pub(super) fn held_nm(&self, slip: f64, grip: f64) -> f64 {
        let one = |c: &Corner| c.transition_nm + (c.hub_nm * slip - c.transition_nm) * grip;
        self.weakest.iter().map(one).fold(f64::INFINITY, f64::min)
    }

    /// Whether a class takes a spring that slips on the hub by a factor of slip at the largest friction, apart from what the bore holds.
    pub(super) fn suits(&self, class: &Class, slip: f64) -> bool {
        let [least_nm, most_nm] = self.transitions_nm;
        if least_nm < class.transition_nm[0] || most_nm > class.transition_nm[1] || self.most_hub_nm * slip > class.most_slip_nm {
            return false;
        }
        // Mode II with the input torque: it has passed the blocked interval.
        let clear = |hub_nm: f64, transition_nm: f64| {
            class.driven_nm - hub_nm * slip > class.mode_1_nm(transition_nm) * (1.0 + INSIDE) && transition_nm < class.needed_nm
        };
        clear(self.most_hub_nm, most_nm) || self.corners.iter().all(|c| clear(c.hub_nm, c.transition_nm))
    }

    /// Part of the least friction that still holds a torque on the spring (N·m) at every corner, for the exponents of hub and bore with the
    /// least friction; at most 1 for a spring that holds it.
    pub(super) fn friction_left(&self, needed_nm: f64, hub: f64, bore: f64) -> f64 {
        self.weakest.iter().map(|c| c.friction(needed_nm, hub, bore)).fold(0.0, f64::max)
    }

    /// By how much the hub may be less tight at every corner until a torque (N·m) is no longer held, m on the radius.
    pub(super) fn gap_left_m(&self, needed_nm: f64, slip: f64, grip: f64) -> f64 {
        self.corners.iter().map(|c| c.gap_m(needed_nm, slip, grip)).fold(f64::INFINITY, f64::min)
    }
}

/// Moments at a corner, and the larger stress of hub and bore, Pa.
fn corner(built: &Built) -> Option<(Corner, f64)> {
    let spring = clutch(built, Source::Corrected).ok()?;
    let stresses = spring.stresses();
    let corner = Corner {
        hub_nm: spring.hub_moment_nm(),
        transition_nm: spring.transition_nm(),
        flexural_n_m2: spring.flexural_n_m2(),
        radius_m: spring.dimensions().neutral_radius_m,
        interference_m: spring.dimensions().hub_interference_m,
    };
    Some((corner, stresses.hub_pa.max(stresses.bore_pa)))
}

impl Corner {
    /// Root s of `M (1 − e^(−x s)) − τ_t = (τ − τ_t) e^(−y s)`: all friction times s. The left side less the right one is concave and
    /// grows, so that Newton's method from below stays below.
    fn friction(&self, needed_nm: f64, hub: f64, bore: f64) -> f64 {
        let reach = -ln_1p(-self.transition_nm / self.hub_nm) / hub;
        let excess_nm = needed_nm - self.transition_nm;
        if excess_nm <= 0.0 {
            return reach;
        }
        let mut s = reach;
        for _ in 0..MOST_STEPS {
            let (left, right) = (exp(-hub * s), excess_nm * exp(-bore * s));
            let value = self.hub_nm * (1.0 - left) - self.transition_nm - right;
            let next = s - value / (self.hub_nm * hub * left + bore * right);
            // Not a number where no friction is enough.
            if next.is_nan() || next <= s * (1.0 + 1e-14) {
                break;
            }
            s = next;
        }
        s
    }

    /// Interference less that with which the torque is just held: from `τ = τ_t + (M s − τ_t) g` and `M = EI δ/(r (r + δ))`.
    fn gap_m(&self, needed_nm: f64, slip: f64, grip: f64) -> f64 {
        let excess_nm = (needed_nm - self.transition_nm).max(0.0);
        let moment_nm = (self.transition_nm + excess_nm / grip) / slip;
        let r = self.radius_m;
        self.interference_m - moment_nm * r * r / (self.flexural_n_m2 - moment_nm * r)
    }
}

/// What turns and friction do, for each number of turns of the grid.
#[derive(Clone, Debug)]
pub(super) struct Factors {
    /// `2π (N_A − 0.2) μ` and `2π N_B μ` with the least friction.
    pub exponents: [Vec<f64>; 2],
    /// `1 − exp(−2π (N_A − 0.2) μ)` with the least, usual and largest friction.
    pub slip: [Vec<f64>; 3],
    /// `exp(2π N_B μ)` with the least friction.
    pub grip: Vec<f64>,
}

impl Factors {
    pub(super) fn new(asked: &Asked) -> Self {
        let frictions = asked.frictions();
        let hub = |friction: f64| asked.hub_turns.iter().map(move |n| TAU * (n - END_LOSS_TURNS).max(0.0) * friction);
        let bore = |friction: f64| asked.bore_turns.iter().map(move |n| TAU * n * friction);
        Self {
            exponents: [hub(frictions[0][0]).collect(), bore(frictions[0][1]).collect()],
            slip: frictions.map(|[friction, _]| hub(friction).map(|x| opening_slip_nm(1.0, x)).collect()),
            grip: bore(frictions[0][1]).map(exp).collect(),
        }
    }
}
