//! Applied forces: springs, dampers, loads. Generalised forces, power and stored energy.

use std::fmt;
use std::sync::Arc;

use crate::body::{BodyId, Point};
use crate::frames::{Frames, Marker, Snapshot};
use crate::law::Law;
use crate::path::{cross, dot, minus};

/// A force, N in the ground frame, of time and state.
pub type ForceFunction = dyn Fn(&Snapshot<'_>) -> [f64; 2] + Send + Sync;

/// A force at a point.
#[derive(Clone)]
pub enum Load {
    /// Fixed in the ground frame, N.
    Fixed([f64; 2]),
    /// Turns with the body, N in the body's frame.
    Following([f64; 2]),
    /// Of time and state, N in the ground frame.
    Function(Arc<ForceFunction>),
}

/// A torque on a body.
#[derive(Clone)]
pub enum Torque {
    /// N·m, counter-clockwise.
    Fixed(f64),
    /// Of time and state, N·m.
    Function(Arc<dyn Fn(&Snapshot<'_>) -> f64 + Send + Sync>),
}

/// What acts on bodies besides gravity and constraints.
#[derive(Debug, Clone)]
pub enum Force {
    /// A spring between two points; tension is positive.
    Spring {
        /// One end.
        a: Point,
        /// The other end.
        b: Point,
        /// Force over the distance of the ends.
        law: Law,
    },
    /// A viscous damper between two points.
    Damper {
        /// One end.
        a: Point,
        /// The other end.
        b: Point,
        /// N·s/m, ≥ 0.
        damping_n_s_per_m: f64,
    },
    /// A torsion spring; the torque on `a` is minus the law of `θ_a − θ_b`.
    TorsionSpring {
        /// One body.
        a: BodyId,
        /// The other.
        b: BodyId,
        /// Torque over the relative angle.
        law: Law,
    },
    /// A viscous torsion damper.
    TorsionDamper {
        /// One body.
        a: BodyId,
        /// The other.
        b: BodyId,
        /// N·m·s/rad, ≥ 0.
        damping_nm_s_per_rad: f64,
    },
    /// A force from outside at a point.
    Push {
        /// Where.
        at: Point,
        /// How much.
        load: Load,
    },
    /// A torque on `on`, reacted by `from` (the ground for one from outside).
    Torque {
        /// The body that feels it.
        on: BodyId,
        /// The body that feels the opposite.
        from: BodyId,
        /// How much.
        torque: Torque,
    },
}

impl fmt::Debug for Load {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fixed(force) => write!(f, "Fixed({force:?})"),
            Self::Following(force) => write!(f, "Following({force:?})"),
            Self::Function(_) => f.write_str("Function"),
        }
    }
}

impl fmt::Debug for Torque {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fixed(torque) => write!(f, "Fixed({torque})"),
            Self::Function(_) => f.write_str("Function"),
        }
    }
}

/// A force with its points relative to centres of mass.
#[derive(Debug, Clone)]
pub(crate) enum Element {
    Spring { a: Marker, b: Marker, law: Law },
    Damper { a: Marker, b: Marker, damping: f64 },
    TorsionSpring { a: BodyId, b: BodyId, law: Law },
    TorsionDamper { a: BodyId, b: BodyId, damping: f64 },
    Push { at: Marker, load: Load },
    Torque { on: BodyId, from: BodyId, torque: Torque },
}

/// Power of what does not store energy, W.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Power {
    pub(crate) dissipated: f64,
    pub(crate) applied: f64,
}

impl Element {
    /// Adds its generalised forces and returns its power.
    pub(crate) fn apply(&self, snapshot: &Snapshot<'_>, q: &mut [f64]) -> Power {
        let frames = snapshot.frames;
        let mut power = Power::default();
        match self {
            Self::Spring { a, b, law } => {
                let line = Line::between(a, b, frames);
                line.pull(law.at(line.length)[0], q);
            }
            Self::Damper { a, b, damping } => {
                let line = Line::between(a, b, frames);
                line.pull(damping * line.rate, q);
                power.dissipated = damping * line.rate * line.rate;
            }
            Self::TorsionSpring { a, b, law } => {
                let torque = law.at(frames.body(*a).angle - frames.body(*b).angle)[0];
                twist(*a, *b, -torque, q);
            }
            Self::TorsionDamper { a, b, damping } => {
                let rate = frames.body(*a).w - frames.body(*b).w;
                twist(*a, *b, -damping * rate, q);
                power.dissipated = damping * rate * rate;
            }
            Self::Push { at, load } => {
                let place = frames.place(at);
                let force = match load {
                    Load::Fixed(force) => *force,
                    Load::Following(force) => frames.body(at.body).turned(*force),
                    Load::Function(f) => f(snapshot),
                };
                push(at.body, place.arm, force, q);
                power.applied = dot(force, place.v);
            }
            Self::Torque { on, from, torque } => {
                let torque = match torque {
                    Torque::Fixed(torque) => *torque,
                    Torque::Function(f) => f(snapshot),
                };
                twist(*on, *from, torque, q);
                power.applied = torque * (frames.body(*on).w - frames.body(*from).w);
            }
        }
        power
    }

    /// Energy stored, J.
    pub(crate) fn energy_j(&self, frames: &Frames) -> f64 {
        match self {
            Self::Spring { a, b, law } => law.at(Line::between(a, b, frames).length)[1],
            Self::TorsionSpring { a, b, law } => law.at(frames.body(*a).angle - frames.body(*b).angle)[1],
            _ => 0.0,
        }
    }
}

/// The line between two markers.
struct Line {
    bodies: [BodyId; 2],
    arms: [[f64; 2]; 2],
    /// Unit vector from b to a; zero where the ends coincide, and then no force acts.
    direction: [f64; 2],
    length: f64,
    rate: f64,
}

impl Line {
    fn between(a: &Marker, b: &Marker, frames: &Frames) -> Self {
        let (pa, pb) = (frames.place(a), frames.place(b));
        let gap = minus(pa.r, pb.r);
        let length = dot(gap, gap).sqrt();
        let direction = if length > 0.0 { [gap[0] / length, gap[1] / length] } else { [0.0; 2] };
        let rate = dot(direction, minus(pa.v, pb.v));
        Self { bodies: [a.body, b.body], arms: [pa.arm, pb.arm], direction, length, rate }
    }

    /// Draws the ends together with a force.
    fn pull(&self, tension: f64, q: &mut [f64]) {
        let force = [tension * self.direction[0], tension * self.direction[1]];
        push(self.bodies[0], self.arms[0], [-force[0], -force[1]], q);
        push(self.bodies[1], self.arms[1], force, q);
    }
}

fn push(body: BodyId, arm: [f64; 2], force: [f64; 2], q: &mut [f64]) {
    if let Some(k) = body.column() {
        q[k] += force[0];
        q[k + 1] += force[1];
        q[k + 2] += cross(arm, force);
    }
}

fn twist(on: BodyId, from: BodyId, torque: f64, q: &mut [f64]) {
    for (body, torque) in [(on, torque), (from, -torque)] {
        if let Some(k) = body.column() {
            q[k + 2] += torque;
        }
    }
}
