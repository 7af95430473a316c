//! The equations of motion as a first-order system, and projection onto the constraints.

use crate::energy::Energy;
use crate::error::Stop;
use crate::frames::{Frames, Snapshot};
use crate::integrator::Equations;
use crate::kkt::Kkt;
use crate::model::System;
use crate::rows::Rows;

/// Works that are integrated with the motion: dissipated, of drivers, applied.
pub(crate) const WORKS: usize = 3;
/// Largest miss of a position row, over its scale, that projection may leave.
const DRIFT: f64 = 1e-8;

/// State `y = [q, q̇, works]`; buffers are kept.
pub(crate) struct Dynamics<'a> {
    pub(crate) system: &'a System,
    pub(crate) frames: Frames,
    rows: Rows,
    pub(crate) kept: Vec<usize>,
    kkt: Kkt,
    pub(crate) acceleration: Vec<f64>,
    pub(crate) multipliers: Vec<f64>,
    pub(crate) evaluations: usize,
    /// Room for projections.
    change: Vec<f64>,
    right: Vec<f64>,
}

impl<'a> Dynamics<'a> {
    /// For a position that satisfies the constraints: rows that depend on others there are left out.
    pub(crate) fn new(system: &'a System, time_s: f64, q: &[f64]) -> Self {
        let n = system.coordinates();
        let mut frames = system.frames_at(q);
        frames.set_velocities(&vec![0.0; n]);
        let mut rows = Rows::default();
        rows.evaluate(&system.constraints, n, system.rows, &frames, time_s);
        let kept = system.scaled_basis(&rows).independent().to_vec();
        let kkt = Kkt::new(&system.mass, n);
        Self {
            system,
            frames,
            rows,
            kept,
            kkt,
            acceleration: vec![0.0; n],
            multipliers: Vec::new(),
            evaluations: 0,
            change: vec![0.0; n],
            right: Vec::new(),
        }
    }

    pub(crate) fn size(&self) -> usize {
        2 * self.system.coordinates() + WORKS
    }

    /// Moves the frames to a state.
    pub(crate) fn place(&mut self, y: &[f64]) {
        let n = self.system.coordinates();
        self.frames.set_positions(&y[..n]);
        self.frames.set_velocities(&y[n..2 * n]);
    }

    fn evaluate(&mut self, time_s: f64) {
        let system = self.system;
        self.rows.evaluate(&system.constraints, system.coordinates(), system.rows, &self.frames, time_s);
        self.rows.keep(&self.kept);
    }

    /// Accelerations and multipliers at a state, with the powers of dampers, drivers and loads.
    fn solve(&mut self, time_s: f64, y: &[f64]) -> Result<[f64; WORKS], Stop> {
        let system = self.system;
        self.evaluations += 1;
        self.place(y);
        self.evaluate(time_s);
        let power = system.generalised_forces(&Snapshot { time_s, system, frames: &self.frames }, &mut self.acceleration);
        self.kkt.factor(&self.rows).map_err(|singular| self.singular(singular.column))?;
        self.multipliers.clear();
        self.multipliers.extend_from_slice(&self.rows.gamma);
        self.kkt.solve(&self.rows, &mut self.acceleration, &mut self.multipliers);
        // The force of a driver is −λ, its rate −∂c/∂t.
        let driver: f64 = self.multipliers.iter().zip(&self.rows.by_time).map(|(multiplier, by_time)| multiplier * by_time).sum();
        Ok([power.dissipated, driver, power.applied])
    }

    fn singular(&self, column: usize) -> Stop {
        if !self.rows.jacobian.iter().all(|entry| entry.is_finite()) {
            return Stop::NotFinite;
        }
        let part = match self.kept.get(column) {
            Some(row) => self.system.row_name(*row),
            None => self.kkt.massless(column - self.kept.len()).map_or_else(String::new, |k| self.system.coordinate_name(k)),
        };
        Stop::Singular { part }
    }

    /// Brings positions and velocities back to the constraints by the smallest change in the metric of the masses. The equations must
    /// have been solved at this very state: their factors are used. Whether anything changed.
    pub(crate) fn project(&mut self, time_s: f64, y: &mut [f64]) -> Result<bool, Stop> {
        let n = self.system.coordinates();
        let (mut changed, mut before) = (false, f64::INFINITY);
        loop {
            let (row, miss) = self.system.worst_row(&self.rows.value, &self.kept);
            if !miss.is_finite() {
                return Err(Stop::NotFinite);
            }
            let limit = self.system.closing_limit(&y[..n]);
            if miss <= limit || miss > 0.5 * before {
                if miss > DRIFT + limit {
                    return Err(Stop::Drift { row: self.system.row_name(row) });
                }
                break;
            }
            before = miss;
            self.right.clear();
            self.right.extend(self.rows.value.iter().map(|c| -c));
            self.change.fill(0.0);
            self.kkt.solve(&self.rows, &mut self.change, &mut self.right);
            for (q, change) in y[..n].iter_mut().zip(&self.change) {
                *q += change;
            }
            changed = true;
            self.place(y);
            self.evaluate(time_s);
        }
        Ok(self.project_velocity(time_s, y) || changed)
    }

    /// The same for velocities only, at the rows evaluated last.
    fn project_velocity(&mut self, time_s: f64, y: &mut [f64]) -> bool {
        let n = self.system.coordinates();
        self.right.clear();
        let mut matters = false;
        for (k, by_time) in self.rows.by_time.iter().enumerate() {
            let terms = self.rows.row(k).iter().zip(&y[n..2 * n]).map(|(d, v)| d * v);
            let (miss, size) = terms.fold((*by_time, by_time.abs()), |(sum, size), term| (sum + term, size + term.abs()));
            matters |= miss.abs() > 1e-13 * size;
            self.right.push(-miss);
        }
        if !matters {
            return false;
        }
        self.change.fill(0.0);
        self.kkt.solve(&self.rows, &mut self.change, &mut self.right);
        for (v, change) in y[n..2 * n].iter_mut().zip(&self.change) {
            *v += change;
        }
        self.place(y);
        self.evaluate(time_s);
        true
    }

    /// Energies of the state in the frames.
    pub(crate) fn energy(&self, y: &[f64]) -> Energy {
        let [kinetic_j, potential_j] = self.system.stored_energy(&self.frames);
        let works = &y[2 * self.system.coordinates()..];
        Energy { kinetic_j, potential_j, dissipated_j: works[0], driver_work_j: works[1], applied_work_j: works[2] }
    }
}

impl Equations for Dynamics<'_> {
    type Error = Stop;

    fn rate(&mut self, time_s: f64, y: &[f64], out: &mut [f64]) -> Result<(), Stop> {
        let n = self.system.coordinates();
        let powers = self.solve(time_s, y)?;
        out[..n].copy_from_slice(&y[n..2 * n]);
        out[n..2 * n].copy_from_slice(&self.acceleration);
        out[2 * n..].copy_from_slice(&powers);
        if out.iter().all(|value| value.is_finite()) { Ok(()) } else { Err(Stop::NotFinite) }
    }
}
