//! Forces on a slider at rest at many travels and nothing else: what a search and a scatter of many cams ask for.
//!
//! The equations are those of [`Mechanism::forces`] without motion. They are written for numbers that may carry derivatives, so that
//! [`crate::influence`] has exact ones.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::cut::SIDES;
use crate::jet::Jet;
use crate::mechanism::{Mechanism, NotAssembled, Pose, Sense};
use crate::path::Vector;

/// The ways in which friction may act on a slider at rest; forces of [`Mechanism::rest_forces`] are in this order.
pub const SENSES: [Sense; 3] = [Sense::Frictionless, Sense::Up, Sense::Down];

/// Forces on the slider along its travel: without friction, about to move up, about to move down, N.
pub type RestForces = [f64; SENSES.len()];

/// What the equations need of a number.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    fn constant(value: f64) -> Self;
    fn value(self) -> f64;
    fn root(self) -> Self;
}

impl Number for f64 {
    #[inline]
    fn constant(value: f64) -> Self {
        value
    }

    #[inline]
    fn value(self) -> f64 {
        self
    }

    #[inline]
    fn root(self) -> Self {
        self.sqrt()
    }
}

impl Number for Jet {
    fn constant(value: f64) -> Self {
        Self::constant(value)
    }

    fn value(self) -> f64 {
        Self::value(&self)
    }

    fn root(self) -> Self {
        self.sqrt()
    }
}

/// A roller of a slider at rest: its place and the direction of its path, of any length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestingRoller<T> {
    pub(crate) at: [T; 2],
    pub(crate) slope: [T; 2],
    pub(crate) joint: Vector,
}

impl<T: Number> RestingRoller<T> {
    #[inline]
    pub(crate) fn of(pose: &Pose, side: usize) -> Self {
        let place = &pose.places[side];
        Self { at: place.at.map(T::constant), slope: place.slope.map(T::constant), joint: pose.joints[side] }
    }
}

#[inline]
fn cross<T: Number>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[1] - a[1] * b[0]
}

impl Mechanism {
    /// Forces at rest at given travels, m, of a slider on its axis, written over `out`; not numbers where friction locks the rollers. Each position is sought from the one before it: even
    /// travels in their order take the least time. Returns how often a path was evaluated.
    ///
    /// # Errors
    /// [`NotAssembled`] where a brace does not reach its path; the forces before it are in `out`.
    pub fn rest_forces(&self, travels_m: &[f64], out: &mut Vec<RestForces>) -> Result<u64, NotAssembled> {
        out.clear();
        let symmetric = self.symmetric([0.0; 3]);
        let mut near: Option<Pose> = None;
        let mut evaluations = 0;
        for travel_m in travels_m {
            let pose = near.insert(self.pose_near([*travel_m, 0.0], near.as_ref())?);
            evaluations += u64::from(pose.evaluations);
            out.push(self.at_rest(&[0, 1].map(|side| RestingRoller::of(pose, side)), symmetric));
        }
        Ok(evaluations)
    }

    /// Forces on the slider with its rollers at given places, in the order of [`SENSES`].
    #[inline]
    pub(crate) fn at_rest<T: Number>(&self, rollers: &[RestingRoller<T>; SIDES], symmetric: bool) -> [T; 3] {
        let [right, left] = rollers.map(|roller| roller.at);
        let apart = [-(right[0] + left[0]), left[1] - right[1]];
        let distance = (apart[0] * apart[0] + apart[1] * apart[1]).root();
        let [tension, rate] = self.springs.tension_n(distance.value());
        let tension = (distance - T::constant(distance.value())) * T::constant(rate) + T::constant(tension);
        let pull = apart.map(|c| c * tension / distance);
        let on_right = self.rest_at_joint(0, &rollers[0], pull);
        let on_left = if symmetric { on_right } else { self.rest_at_joint(1, &rollers[1], [pull[0], -pull[1]]) };
        let slider = T::constant(self.bodies.slider_kg * self.gravity_m_per_s2);
        std::array::from_fn(|i| on_right[i] + on_left[i] + slider)
    }

    /// What a side needs from the joint along the travel.
    #[inline]
    fn rest_at_joint<T: Number>(&self, side: usize, roller: &RestingRoller<T>, pull: [T; 2]) -> [T; 3] {
        let (b, g) = (&self.bodies, self.gravity_m_per_s2);
        let over = T::constant(-1.0 / self.brace_m[side]);
        let brace = [0, 1].map(|k| (roller.at[k] - T::constant(roller.joint[k])) * over);
        // Half of a brace's weight bears on its roller across it.
        let across = brace[0] * T::constant(-0.5 * b.brace_kg * g);
        let across_brace = [-(across * brace[1]), across * brace[0]];
        let weight = T::constant((b.roller_kg + 0.5 * self.springs.mass_kg()) * g);
        let at_roller = [-pull[0] - across_brace[0], weight - pull[1] - across_brace[1]];
        let still = across_brace[1] + T::constant(b.brace_kg * g);
        // Neither the tension nor the sign of N depends on the length of these two.
        let along = roller.slope;
        let sense = T::constant(self.springs.sense());
        let normal = [along[1] * sense, -along[0] * sense];
        let gear = brace[0] * along[0] + brace[1] * along[1];
        let rolls = if (brace[1] * gear).value() < 0.0 { -self.friction() } else { self.friction() };
        [0.0, rolls, -rolls].map(|friction| {
            let solve = |friction: f64| {
                let contact = [0, 1].map(|k| normal[k] - along[k] * T::constant(friction));
                (cross(contact, brace), cross(contact, at_roller))
            };
            let pulls = |frame: T| (cross(at_roller, brace) * frame).value() < 0.0;
            let (mut frame, mut tension) = solve(friction);
            if friction != 0.0 && pulls(frame) {
                // As in `Mechanism::forces`: the cam would have to pull anyway, or friction locks the rollers.
                let (unlocked, _) = solve(0.0);
                (frame, tension) = if pulls(unlocked) { solve(-friction) } else { (T::constant(f64::NAN), tension) };
            }
            tension / frame * brace[1] + still
        })
    }
}
