//! The balance of energy.

use crate::frames::Frames;
use crate::model::System;

/// Energies at an instant and works since the start, J.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energy {
    /// Kinetic energy.
    pub kinetic_j: f64,
    /// Potential energy of gravity (0 at ordinate 0) and springs.
    pub potential_j: f64,
    /// Turned into heat by dampers.
    pub dissipated_j: f64,
    /// Work of drivers on the mechanism.
    pub driver_work_j: f64,
    /// Work of applied forces and torques.
    pub applied_work_j: f64,
}

impl Energy {
    /// What stays constant: kinetic + potential + dissipated − driver work − applied work.
    pub fn balance_j(&self) -> f64 {
        self.kinetic_j + self.potential_j + self.dissipated_j - self.driver_work_j - self.applied_work_j
    }
}

/// How well the balance was kept over a simulation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EnergyAudit {
    /// At the start.
    pub start: Energy,
    /// Where the simulation ended.
    pub end: Energy,
    /// Largest deviation of the balance from its start at the ends of steps, J.
    pub worst_drift_j: f64,
}

impl System {
    /// Kinetic and potential energy of what is in the frames.
    pub(crate) fn stored_energy(&self, frames: &Frames) -> [f64; 2] {
        let (mut kinetic, mut potential) = (0.0, 0.0);
        for (frame, mass) in frames.bodies[1..].iter().zip(self.mass.chunks_exact(3)) {
            kinetic += 0.5 * (mass[0] * (frame.v[0] * frame.v[0] + frame.v[1] * frame.v[1]) + mass[2] * frame.w * frame.w);
            potential -= mass[0] * (self.gravity[0] * frame.r[0] + self.gravity[1] * frame.r[1]);
        }
        let springs: f64 = self.elements.iter().map(|element| element.energy_j(frames)).sum();
        [kinetic, potential + springs]
    }
}
