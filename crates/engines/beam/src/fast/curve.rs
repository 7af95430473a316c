//! The curve of one design: the choice of the polynomial degree, and the general path where that is not enough.

use super::gradient::ForceGradient;
use super::outputs::{CurveStates, GeneralStates};
use super::states::FastStates;
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
    states: FastStates,
    general_states: Option<GeneralStates>,
    response: Response,
    hasty: bool,
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
            states: FastStates::default(),
            general_states: None,
            response: Response::default(),
            hasty: false,
        }
    }

    /// Whether a design that the fast path is made for, but fails on, is left with [`Status::StepTooSmall`] where it failed instead of
    /// being handed to the general path: near a fold or a branch, mostly, and at a hundred times the cost. For searches, which have other
    /// designs to look at. Off at first.
    pub fn set_hasty(&mut self, hasty: bool) {
        self.hasty = hasty;
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
        self.solve_all(network, stations_m, settings, parameters, &[])?;
        Ok(&self.response)
    }

    /// As [`CurveSolver::solve_with_gradient`], with the states at some displacements, m, in any order, from 0 to the last station. At
    /// each, force, stiffness, stress and places of beams are known with their derivatives by the same parameters and by the displacement.
    ///
    /// States are solved for at the polynomial degree that checked the curve, so that derivatives are as accurate as the curve: of 32
    /// random designs at 1e-4 and 1e-5, those of no output were wrong by more than 4.1 times the accuracy asked for, relative to the
    /// largest of their kind. Where the general path computes the curve, it computes the states, and at many times the cost.
    ///
    /// ```
    /// use forcewright_beam::{Beam, CurveSolver, Derivatives, Drive, Network, Node, Output, Parameter, Section, Settings, Shape, Support};
    /// // A curved cantilever, its end pushed 10 mm sideways.
    /// let section = Section { young_pa: 2e9, thickness_m: 1e-3, depth_m: 1e-2, poisson: None };
    /// let nodes = vec![
    ///     Node { position_m: [0.0, 0.0], support: Support::Clamped },
    ///     Node { position_m: [0.1, 0.0], support: Support::Free },
    /// ];
    /// let beams = vec![Beam::new(0, 1, Shape::from_chord([0.1, 0.0], &[0.8])?, section)];
    /// let network = Network::new(nodes, beams, Drive::Displacement { node: 1, direction: [0.0, 1.0] });
    /// let mut solver = CurveSolver::new();
    /// let settings = Settings { accuracy: 1e-5, ..Settings::default() };
    /// let mut states = solver.solve_with_states(&network, &[5e-3, 10e-3], &settings, &[Parameter::Depth(0)], &[10e-3])?;
    /// let mut derivatives = Derivatives::default();
    /// states.derivatives(0, &[Output::Force, Output::PeakStress { beam: None }], &mut derivatives)?;
    /// // The force is proportional to the depth; the stress does not depend on it.
    /// let [force, stress] = [0, 1].map(|i| derivatives.by_parameter[i] * section.depth_m / derivatives.value[i]);
    /// assert!((force - 1.0).abs() < 1e-4 && stress.abs() < 1e-4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`NetworkError`] if network, stations, settings or the displacements of the states make no sense.
    pub fn solve_with_states(
        &mut self,
        network: &Network,
        stations_m: &[f64],
        settings: &Settings,
        parameters: &[Parameter],
        states_m: &[f64],
    ) -> Result<CurveStates<'_>, NetworkError> {
        let last = stations_m.last().copied().unwrap_or(-1.0);
        if let Some(index) = states_m.iter().position(|at| !(0.0..=last).contains(at)) {
            return Err(NetworkError::States { index });
        }
        self.solve_all(network, stations_m, settings, parameters, states_m)?;
        Ok(self.states())
    }

    /// The curve that was solved last, with its states, for more of their outputs. Without states if there were none, or if the network
    /// was refused.
    pub fn states(&self) -> CurveStates<'_> {
        match &self.general_states {
            Some(states) => CurveStates::general(&self.response, states),
            None => CurveStates::fast(&self.response, &self.states),
        }
    }

    fn solve_all(
        &mut self,
        network: &Network,
        stations_m: &[f64],
        settings: &Settings,
        parameters: &[Parameter],
        states_m: &[f64],
    ) -> Result<(), NetworkError> {
        self.general_states = None;
        self.states.set(parameters);
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
        // The derivative by an arm exists where there is none.
        let driven = driven && !parameters.iter().any(|p| matches!(p, Parameter::Arm { .. }));
        let model = driven.then(|| Model::new(network, settings.theory));
        if let Some(model) = model.filter(|m| m.plain) {
            let task = Task { network, model: &model, stations_m, accuracy };
            self.gradient.set(parameters);
            let mut reached_m = 0.0;
            for level in if task.tight() { 2..4 } else { 0..4 } {
                let run = self.run(level, &task, &mut counters, !parameters.is_empty());
                match run.and_then(|()| self.run_states(level, &task, states_m, &mut counters)) {
                    Ok(()) => {
                        let out = &mut self.response;
                        (out.status, out.general, out.counters) = (Status::Complete, false, counters);
                        return Ok(());
                    }
                    Err(why) => {
                        reached_m = self.reached(level) * model.length_m;
                        if why == GiveUp::Unsafe {
                            break;
                        }
                    }
                }
            }
            if self.hasty {
                let out = &mut self.response;
                out.clear();
                (out.status, out.general, out.counters) = (Status::StepTooSmall { control: reached_m }, false, counters);
                self.states.set(parameters);
                return Ok(());
            }
        }
        self.general((network, stations_m, settings), parameters, states_m, counters)
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

    /// The largest displacement of a walk, dimensionless.
    fn reached(&self, level: usize) -> f64 {
        let controls = match level {
            0 => &self.small.controls,
            1 => &self.medium.controls,
            2 => &self.large.controls,
            _ => &self.huge.controls,
        };
        controls.iter().copied().fold(0.0, f64::max)
    }

    fn run_states(&mut self, level: usize, task: &Task, at_m: &[f64], counters: &mut Counters) -> Result<(), GiveUp> {
        if at_m.is_empty() {
            return Ok(());
        }
        let out = (counters, &mut self.states);
        match level {
            0 => self.small.solve_states(task, at_m, out, Some(&mut self.medium)),
            1 => self.medium.solve_states(task, at_m, out, Some(&mut self.large)),
            2 => self.large.solve_states(task, at_m, out, Some(&mut self.huge)),
            _ => self.huge.solve_states(task, at_m, out, None::<&mut Walker<14, 20, 6>>),
        }
    }

    fn general(
        &mut self,
        (network, stations_m, settings): (&Network, &[f64], &Settings),
        parameters: &[Parameter],
        states_m: &[f64],
        before: Counters,
    ) -> Result<(), NetworkError> {
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
        if !states_m.is_empty() {
            let points = states_m.iter().map(|at| path.at(*at).ok()).collect();
            self.general_states = Some(GeneralStates { path, points, parameters: parameters.to_vec() });
        }
        Ok(())
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
