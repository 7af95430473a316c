//! States over time, and the forces in them.

use crate::body::BodyId;
use crate::frames::{Frames, Marker, Snapshot};
use crate::model::{JointId, System};
use crate::path::cross;
use crate::rows::{Constraint, Rows};

/// A sequence of states of one system.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    coordinates: usize,
    rows: usize,
    times: Vec<f64>,
    values: Vec<f64>,
}

/// A state: times, coordinates, velocities, accelerations, multipliers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant<'a> {
    /// Time, s.
    pub time_s: f64,
    /// Coordinates, m and rad.
    pub q: &'a [f64],
    /// Their first derivatives.
    pub velocity: &'a [f64],
    /// Their second derivatives.
    pub acceleration: &'a [f64],
    /// Lagrange multipliers of all rows, in the sense `M q̈ + Dᵀ λ = Q`; 0 for redundant rows.
    pub multipliers: &'a [f64],
}

/// What a joint does to its first body (`a`), at that body's point of the joint; the second body feels the opposite.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reaction {
    /// Force, N, in the ground frame.
    pub force_n: [f64; 2],
    /// Torque, N·m, counter-clockwise.
    pub torque_nm: f64,
}

/// Force between a roller and its cam.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactForce {
    /// Pressing the two together, N; negative where the roller would lift off.
    pub normal_n: f64,
    /// On the roller along the rising parameter of the path, N.
    pub traction_n: f64,
}

impl History {
    pub(crate) fn new(system: &System, capacity: usize) -> Self {
        let (coordinates, rows) = (system.coordinates(), system.rows());
        let values = Vec::with_capacity(capacity * (3 * coordinates + rows));
        Self { coordinates, rows, times: Vec::with_capacity(capacity), values }
    }

    /// Adds a state; multipliers are those of the kept rows.
    pub(crate) fn push(&mut self, time_s: f64, [q, v, a]: [&[f64]; 3], multipliers: &[f64], kept: &[usize]) {
        self.times.push(time_s);
        for part in [q, v, a] {
            self.values.extend_from_slice(part);
        }
        let first = self.values.len();
        self.values.resize(first + self.rows, 0.0);
        for (multiplier, &row) in multipliers.iter().zip(kept) {
            self.values[first + row] = *multiplier;
        }
    }

    /// Number of states.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// A state by number; none beyond the last.
    pub fn get(&self, index: usize) -> Option<Instant<'_>> {
        let time_s = *self.times.get(index)?;
        let n = self.coordinates;
        let stride = 3 * n + self.rows;
        let values = &self.values[index * stride..(index + 1) * stride];
        let (q, rest) = values.split_at(n);
        let (velocity, rest) = rest.split_at(n);
        let (acceleration, multipliers) = rest.split_at(n);
        Some(Instant { time_s, q, velocity, acceleration, multipliers })
    }

    /// The last state.
    pub fn last(&self) -> Option<Instant<'_>> {
        self.len().checked_sub(1).and_then(|k| self.get(k))
    }

    /// All states in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Instant<'_>> {
        // Every index is below the length; the default is never taken.
        (0..self.len()).map(|k| self.get(k).unwrap_or(Instant { time_s: 0.0, q: &[], velocity: &[], acceleration: &[], multipliers: &[] }))
    }
}

impl System {
    /// Force or torque of a driver on the mechanism along its coordinate: minus its multiplier (Sánchez-Salinas et al. 2022, section
    /// 4), N or N·m. None if there is no such joint; for joints with several rows that of the first.
    pub fn driver_force(&self, instant: &Instant<'_>, driver: JointId) -> Option<f64> {
        let rows = self.joint_rows(driver)?;
        instant.multipliers.get(rows.start).map(|multiplier| -multiplier)
    }

    /// Normal force and traction of a contact; none if the joint is no contact.
    pub fn contact_force(&self, instant: &Instant<'_>, contact: JointId) -> Option<ContactForce> {
        let first = self.joint_rows(contact)?.start;
        let Constraint::Contact(rows) = &self.constraints[contact.0] else { return None };
        let [normal_n, traction_n] =
            rows.forces(&self.frames_at(instant.q), [*instant.multipliers.get(first)?, *instant.multipliers.get(first + 1)?]);
        Some(ContactForce { normal_n, traction_n })
    }

    /// What a joint does to its first body at its first point; for a contact, what the cam does to the roller, at its centre. None if
    /// there is no such joint or the state is not one of this system.
    pub fn reaction(&self, instant: &Instant<'_>, joint: JointId) -> Option<Reaction> {
        let joint_rows = self.joint_rows(joint)?;
        let frames = self.frames_of(instant)?;
        let mut rows = Rows::default();
        rows.evaluate(&self.constraints, self.coordinates(), self.rows, &frames, instant.time_s);
        let multipliers = instant.multipliers.get(joint_rows.clone())?;
        let wrench = |body: BodyId| {
            body.column().map(|column| {
                let mut sum = [0.0; 3];
                for (row, multiplier) in joint_rows.clone().zip(multipliers) {
                    for (target, entry) in sum.iter_mut().zip(&rows.row(row)[column..column + 3]) {
                        *target -= entry * multiplier;
                    }
                }
                (frames.body(body).r, sum)
            })
        };
        let (a, b) = self.constraints[joint.0].ends();
        let at = frames.place(&a).r;
        // On the ground nothing is written: it feels the opposite of the other body.
        let (sign, (centre, [x, y, torque])) = match wrench(a.body) {
            Some(wrench) => (1.0, wrench),
            None => (-1.0, wrench(b)?),
        };
        let arm = [at[0] - centre[0], at[1] - centre[1]];
        Some(Reaction { force_n: [sign * x, sign * y], torque_nm: sign * (torque - cross(arm, [x, y])) })
    }

    /// Kinetic and potential energy of a state, J; none if it is not one of this system.
    pub fn kinetic_and_potential_j(&self, instant: &Instant<'_>) -> Option<[f64; 2]> {
        self.frames_of(instant).map(|frames| self.stored_energy(&frames))
    }

    /// Calls a function with a view of a state: poses, points and their velocities by name. None if it is not one of this system.
    pub fn look<T>(&self, instant: &Instant<'_>, f: impl FnOnce(&Snapshot<'_>) -> T) -> Option<T> {
        self.frames_of(instant).map(|frames| f(&Snapshot { time_s: instant.time_s, system: self, frames: &frames }))
    }

    fn frames_of(&self, instant: &Instant<'_>) -> Option<Frames> {
        let n = self.coordinates();
        if instant.q.len() != n || instant.velocity.len() != n {
            return None;
        }
        let mut frames = self.frames_at(instant.q);
        frames.set_velocities(instant.velocity);
        Some(frames)
    }
}

impl Constraint {
    /// First point and second body.
    fn ends(&self) -> (Marker, BodyId) {
        match self {
            Self::Pin { a, b } | Self::Along { a, b, .. } | Self::Prismatic { a, b, .. } | Self::Rod { a, b, .. } => (*a, b.body),
            Self::Angle { a, b, .. } => (Marker { body: *a, p: [0.0; 2] }, *b),
            Self::Contact(contact) => (contact.centre, contact.cam.body),
            Self::Parameter { .. } => (Marker { body: crate::GROUND, p: [0.0; 2] }, crate::GROUND),
            Self::Skate { at, .. } => (*at, crate::GROUND),
        }
    }
}
