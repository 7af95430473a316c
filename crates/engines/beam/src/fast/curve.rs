//! The curve of one design: the choice of the polynomial degree, and the general path where that is not enough.

use super::gradient::ForceGradient;
use super::walk::{GiveUp, Task, Walker};
use crate::counters::Counters;
use crate::error::{NetworkError, Status};
use crate::gradient::{Output, Parameter};
use crate::model::Model;
use crate::network::{Drive, Joints, Network, Settings};
use crate::path::{Path, check_stations, trace};

/// Force and stress over displacement.
#[derive(Clone, Debug, Default)]
pub struct Response {
    /// Force on the drive at each station, N; the drawn network.
    pub force_n: Vec<f64>,
    /// Its slope, N/m.
    pub stiffness_n_per_m: Vec<f64>,
    /// Largest stress over all beams and both faces at each station, Pa.
    pub stress_pa: Vec<f64>,
    /// The beam that carries it.
    pub stress_beam: Vec<usize>,
    /// How the path ended; stations beyond its end are missing.
    pub status: Status,
    /// Derivatives of the force: a row per station, a column per parameter asked for; N per SI unit of the parameter. Empty if none
    /// were asked for, NaN where the general path has none.
    pub force_gradient: Vec<f64>,
    /// Estimated error of the force, relative to the largest.
    pub error_estimate: f64,
    /// Estimated error of the stress, relative to the largest; at most ten times the accuracy asked for, or the next polynomial
    /// degree is used. From the general path that of the force and the stress together.
    pub stress_error_estimate: f64,
    /// Whether the general path computed it.
    pub general: bool,
    /// Negative eigenvalues less multipliers at the end: 0 where the state is stable under prescribed displacement. `None` from the
    /// general path.
    pub instability: Option<i64>,
    /// Work done.
    pub counters: Counters,
}

/// Solves curves one after another in the same buffers. A curve depends on nothing but its own arguments.
#[derive(Debug)]
pub struct CurveSolver {
    small: Walker<5, 8, 3>,
    medium: Walker<7, 11, 4>,
    large: Walker<9, 13, 4>,
    huge: Walker<14, 20, 6>,
    gradient: ForceGradient,
    response: Response,
}

impl Default for CurveSolver {
    fn default() -> Self {
        Self::new()
    }
}

impl CurveSolver {
    /// Empty buffers and the tables of all resolutions.
    pub fn new() -> Self {
        Self {
            small: Walker::new(),
            medium: Walker::new(),
            large: Walker::new(),
            huge: Walker::new(),
            gradient: ForceGradient::default(),
            response: Response::default(),
        }
    }

    /// The curve of a network whose drive is a displacement, at ascending stations ≥ 0, m.
    ///
    /// The force is accurate to [`Settings::accuracy`] of the largest one, the stress to ten times that, by the estimates in the result.
    ///
    /// # Errors
    /// [`NetworkError`] if network, stations or settings make no sense.
    pub fn solve(&mut self, network: &Network, stations_m: &[f64], settings: &Settings) -> Result<&Response, NetworkError> {
        self.solve_with_gradient(network, stations_m, settings, &[])
    }

    /// As [`CurveSolver::solve`], with the derivatives of the force by some parameters in [`Response::force_gradient`]. A parameter that
    /// names what the network does not have changes nothing.
    ///
    /// # Errors
    /// [`NetworkError`] if network, stations or settings make no sense.
    pub fn solve_with_gradient(
        &mut self,
        network: &Network,
        stations_m: &[f64],
        settings: &Settings,
        parameters: &[Parameter],
    ) -> Result<&Response, NetworkError> {
        // The chords are checked by the quadrature that computes the curve, and where that is in doubt by the general path.
        if network.check_parts(false).is_err() {
            network.check()?;
        }
        check_stations(stations_m)?;
        let accuracy = settings.accuracy;
        if !(accuracy > 0.0 && accuracy < 1.0) {
            return Err(NetworkError::Accuracy { accuracy });
        }
        let mut counters = Counters::default();
        let driven = matches!(network.drive, Drive::Displacement { .. }) && settings.joints == Joints::Point && !stations_m.is_empty();
        let model = driven.then(|| Model::new(network, settings.theory));
        if let Some(model) = model.filter(|m| m.plain) {
            let task = Task { network, model: &model, stations_m, accuracy };
            self.gradient.set(parameters);
            for level in if task.tight() { 2..4 } else { 0..4 } {
                match self.run(level, &task, &mut counters, !parameters.is_empty()) {
                    Ok(()) => {
                        let out = &mut self.response;
                        (out.status, out.general, out.counters) = (Status::Complete, false, counters);
                        return Ok(out);
                    }
                    Err(GiveUp::Unresolved) => {}
                    Err(GiveUp::Unsafe) => break,
                }
            }
        }
        self.general(network, stations_m, settings, parameters, counters)
    }

    fn run(&mut self, level: usize, task: &Task, counters: &mut Counters, with_gradient: bool) -> Result<(), GiveUp> {
        let out = &mut self.response;
        let gradient = with_gradient.then_some(&mut self.gradient);
        match level {
            0 => self.small.run(task, counters, out, Some(&mut self.medium), gradient),
            1 => self.medium.run(task, counters, out, Some(&mut self.large), gradient),
            2 => self.large.run(task, counters, out, Some(&mut self.huge), gradient),
            _ => self.huge.run(task, counters, out, None::<&mut Walker<14, 20, 6>>, gradient),
        }
    }

    fn general(
        &mut self,
        network: &Network,
        stations_m: &[f64],
        settings: &Settings,
        parameters: &[Parameter],
        before: Counters,
    ) -> Result<&Response, NetworkError> {
        let path = trace(network, stations_m, settings, &mut |_| true)?;
        let out = &mut self.response;
        out.clear();
        for point in &path.points {
            out.force_n.push(point.force);
            out.stiffness_n_per_m.push(point.stiffness);
            let (beam, peak) = point.peak_stress().map_or((0, 0.0), |(beam, peak)| (beam, peak.stress_pa));
            out.stress_pa.push(peak);
            out.stress_beam.push(beam);
        }
        if !parameters.is_empty() {
            general_gradient(&path, parameters, &mut out.force_gradient);
        }
        out.status = path.status;
        out.error_estimate = path.error_estimate.unwrap_or(f64::INFINITY);
        out.stress_error_estimate = out.error_estimate;
        out.general = true;
        out.instability = None;
        out.counters = before + path.counters;
        Ok(out)
    }

    /// Numbers that the buffers have room for: constant once the largest network has been solved.
    pub fn room(&self) -> usize {
        let response = &self.response;
        let out = response.force_n.capacity() + response.stress_pa.capacity() + response.force_gradient.capacity();
        self.small.room() + self.medium.room() + self.large.room() + self.huge.room() + self.gradient.room() + out
    }
}

fn general_gradient(path: &Path, parameters: &[Parameter], out: &mut Vec<f64>) {
    let mut gradients = path.gradients().ok();
    for point in &path.points {
        let gradient = gradients.as_mut().and_then(|g| g.at(point, &[Output::Force]).ok()?.pop());
        out.extend(parameters.iter().map(|p| gradient.as_ref().map_or(f64::NAN, |g| g.by(*p).unwrap_or(0.0))));
    }
}

impl Response {
    pub(super) fn clear(&mut self) {
        self.force_gradient.clear();
        self.force_n.clear();
        self.stiffness_n_per_m.clear();
        self.stress_pa.clear();
        self.stress_beam.clear();
    }
}
