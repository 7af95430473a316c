//! Forward dynamics: the mechanism moves by itself, or driven in part.

use std::cmp::Ordering;
use std::fmt;
use std::sync::Arc;

use forcewright_base::maths;
use forcewright_base::roots;

use crate::dynamics::Dynamics;
use crate::energy::{Energy, EnergyAudit};
use crate::error::Stop;
use crate::frames::Snapshot;
use crate::history::History;
use crate::integrator::{Equations, Stepper};
use crate::inverse::{Grid, MOST_INSTANTS};
use crate::model::System;

/// How a motion is integrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Dormand & Prince 5(4) with steps chosen by the local error; positions and velocities are projected onto the constraints after
    /// each step.
    Adaptive {
        /// Local error of a step, relative to the size of the mechanism, 1 rad and the fastest velocities so far; 1e-4 … 1e-13.
        accuracy: f64,
        /// Longest step, s; infinite for none. Events closer together than a quarter of a step may be missed.
        longest_step_s: f64,
    },
    /// The classical Runge–Kutta method with equal steps.
    Fixed {
        /// Number of steps.
        steps: usize,
        /// Whether to project after each step.
        project: bool,
    },
}

/// Which states are kept.
#[derive(Debug, Clone, PartialEq)]
pub enum Outputs {
    /// The start and the end of every step.
    Steps,
    /// Equally spaced states: so many intervals, at most ten million.
    Grid(usize),
    /// States at given times, s, rising; those outside the interval are left out.
    At(Vec<f64>),
}

/// Which changes of sign are an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Crossing {
    /// From below zero.
    Rising,
    /// From above zero.
    Falling,
    /// Either.
    Any,
}

/// A function of the state whose zeros matter.
#[derive(Clone)]
pub struct Event {
    /// The function.
    pub function: Arc<dyn Fn(&Snapshot<'_>) -> f64 + Send + Sync>,
    /// Which zeros.
    pub crossing: Crossing,
    /// Whether the simulation ends there.
    pub terminal: bool,
}

impl fmt::Debug for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Event({:?}, terminal: {})", self.crossing, self.terminal)
    }
}

/// What to simulate.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Start, s.
    pub start_s: f64,
    /// End, s, after the start.
    pub end_s: f64,
    /// How.
    pub method: Method,
    /// What to keep; events are always kept.
    pub outputs: Outputs,
    /// Events to find.
    pub events: Vec<Event>,
    /// Most steps, accepted and refused.
    pub max_steps: usize,
}

impl Settings {
    /// From 0 to an end, adaptive to 1e-9, 200 intervals kept, no events, at most a million steps.
    pub fn until(end_s: f64) -> Self {
        let method = Method::Adaptive { accuracy: 1e-9, longest_step_s: f64::INFINITY };
        Self { start_s: 0.0, end_s, method, outputs: Outputs::Grid(200), events: Vec::new(), max_steps: 1_000_000 }
    }

    /// Another local error, see [`Method::Adaptive`].
    pub fn accuracy(mut self, accuracy: f64) -> Self {
        self.method = Method::Adaptive { accuracy, longest_step_s: f64::INFINITY };
        self
    }

    /// One event more.
    pub fn event(mut self, crossing: Crossing, terminal: bool, function: impl Fn(&Snapshot<'_>) -> f64 + Send + Sync + 'static) -> Self {
        self.events.push(Event { function: Arc::new(function), crossing, terminal });
        self
    }

    fn is_valid(&self) -> bool {
        let method = match self.method {
            Method::Adaptive { accuracy, longest_step_s } => accuracy > 0.0 && accuracy < 1.0 && longest_step_s > 0.0,
            Method::Fixed { steps, .. } => steps > 0,
        };
        let outputs = match &self.outputs {
            Outputs::At(times) => times.windows(2).all(|t| t[1] > t[0]) && times.iter().all(|t| t.is_finite()),
            Outputs::Grid(steps) => (1..=MOST_INSTANTS).contains(steps),
            Outputs::Steps => true,
        };
        method && outputs && Grid { start_s: self.start_s, end_s: self.end_s, steps: 1 }.is_valid()
    }

    fn output_times(&self) -> Vec<f64> {
        match &self.outputs {
            Outputs::Steps => Vec::new(),
            Outputs::Grid(steps) => {
                let grid = Grid { start_s: self.start_s, end_s: self.end_s, steps: *steps };
                (0..=*steps).map(|k| grid.time_s(k)).collect()
            }
            Outputs::At(times) => times.iter().copied().filter(|t| (self.start_s..=self.end_s).contains(t)).collect(),
        }
    }
}

/// An event that happened.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Which of the events asked for.
    pub event: usize,
    /// When, s.
    pub time_s: f64,
    /// Its state in the history.
    pub state: usize,
}

/// A motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// States kept, in order of time.
    pub history: History,
    /// Energies of the states kept.
    pub energies: Vec<Energy>,
    /// Events, in order of time.
    pub hits: Vec<Hit>,
    /// The balance of energy.
    pub audit: EnergyAudit,
    /// How it ended.
    pub stop: Stop,
    /// When, s.
    pub reached_s: f64,
    /// Rows that follow from the rows before them; their multipliers are given as 0.
    pub redundant: Vec<String>,
    /// Steps accepted.
    pub steps: usize,
    /// Steps refused for their error.
    pub refused: usize,
    /// Times that accelerations were computed.
    pub evaluations: usize,
}

impl System {
    /// The motion from given coordinates and velocities (one per coordinate; empty for rest). Both are brought onto the constraints
    /// first: coordinates as by [`System::assemble`], velocities by the smallest change of kinetic energy's metric.
    ///
    /// A failure is a result: [`Simulation::stop`] says why it ended, the history what was reached.
    pub fn simulate(&self, q: &[f64], velocity: &[f64], settings: &Settings) -> Simulation {
        let mut simulation = Simulation {
            history: History::new(self, 0),
            energies: Vec::new(),
            hits: Vec::new(),
            audit: EnergyAudit::default(),
            stop: Stop::Reached,
            reached_s: settings.start_s,
            redundant: Vec::new(),
            steps: 0,
            refused: 0,
            evaluations: 0,
        };
        if !settings.is_valid() || (!velocity.is_empty() && velocity.len() != self.coordinates()) {
            simulation.stop = Stop::Settings;
            return simulation;
        }
        let q = match self.assemble(settings.start_s, q, &[]) {
            Ok(assembled) => assembled.q,
            Err(error) => {
                simulation.stop = Stop::NotAssembled(error);
                return simulation;
            }
        };
        let dynamics = Dynamics::new(self, settings.start_s, &q);
        simulation.redundant = (0..self.rows).filter(|row| !dynamics.kept.contains(row)).map(|row| self.row_name(row)).collect();
        let mut run = Run::new(dynamics, settings, simulation);
        let outcome = run.go(&q, velocity);
        let mut simulation = run.simulation;
        simulation.stop = outcome.err().unwrap_or(Stop::Reached);
        simulation.evaluations = run.dynamics.evaluations;
        simulation
    }
}

/// What happens inside a step, by its place.
#[derive(Clone, Copy)]
enum Mark {
    Output,
    Event(usize),
}

struct Run<'a> {
    dynamics: Dynamics<'a>,
    settings: &'a Settings,
    simulation: Simulation,
    stepper: Stepper,
    /// State at the end of the step, projected.
    next: Vec<f64>,
    next_rate: Vec<f64>,
    inside: Vec<f64>,
    inside_rate: Vec<f64>,
    first: Vec<f64>,
    /// Fastest velocity so far over the coordinate's scale, 1/s.
    fastest: f64,
    outputs: Vec<f64>,
    next_output: usize,
    /// Values of the events at the start of the step.
    event_values: Vec<f64>,
    previous_error: f64,
    /// Length to try after the step that was good.
    advice_s: f64,
}

impl<'a> Run<'a> {
    fn new(dynamics: Dynamics<'a>, settings: &'a Settings, simulation: Simulation) -> Self {
        let size = dynamics.size();
        Self {
            stepper: Stepper::new(size, matches!(settings.method, Method::Adaptive { .. })),
            next: vec![0.0; size],
            next_rate: vec![0.0; size],
            inside: vec![0.0; size],
            inside_rate: vec![0.0; size],
            first: Vec::new(),
            fastest: 1.0 / (settings.end_s - settings.start_s),
            outputs: settings.output_times(),
            next_output: 0,
            event_values: Vec::new(),
            previous_error: 1e-4,
            advice_s: settings.end_s - settings.start_s,
            dynamics,
            settings,
            simulation,
        }
    }

    fn go(&mut self, q: &[f64], velocity: &[f64]) -> Result<(), Stop> {
        let (n, settings) = (q.len(), self.settings);
        let mut time = settings.start_s;
        let mut y = std::mem::take(&mut self.stepper.start);
        y[..n].copy_from_slice(q);
        if !velocity.is_empty() {
            y[n..2 * n].copy_from_slice(velocity);
        }
        self.dynamics.rate(time, &y, &mut self.stepper.stages[0])?;
        if self.dynamics.project(time, &mut y)? {
            self.dynamics.rate(time, &y, &mut self.stepper.stages[0])?;
        }
        self.stepper.start.clone_from(&y);
        self.first = y;
        self.begin(time)?;
        let mut step = self.first_step();
        while time < settings.end_s {
            if self.simulation.steps + self.simulation.refused >= settings.max_steps {
                return Err(Stop::TooManySteps);
            }
            let (length, last) = self.clipped(time, step);
            step = match self.attempt(time, length) {
                Ok(Some(better)) => {
                    self.simulation.refused += 1;
                    better
                }
                Ok(None) => {
                    let end = if last { settings.end_s } else { time + length };
                    step = self.accept(end)?;
                    time = end;
                    step
                }
                // Beyond a place where the equations fail: come nearer to it.
                Err(stop) if length < 1e-12 * (settings.end_s - settings.start_s) || !self.is_adaptive() => return Err(stop),
                Err(_) => {
                    self.simulation.refused += 1;
                    0.25 * length
                }
            };
            // Written so that a step that is no number ends it as well.
            if (time + step).partial_cmp(&time) != Some(Ordering::Greater) {
                return Err(Stop::StepTooSmall);
            }
        }
        Ok(())
    }

    fn is_adaptive(&self) -> bool {
        matches!(self.settings.method, Method::Adaptive { .. })
    }

    /// Length of the next step, and whether it ends the interval.
    fn clipped(&self, time: f64, step: f64) -> (f64, bool) {
        let left = self.settings.end_s - time;
        match self.settings.method {
            Method::Fixed { steps, .. } => {
                let Settings { start_s, end_s, .. } = *self.settings;
                let k = self.simulation.steps + 1;
                (Grid { start_s, end_s, steps }.time_s(k) - time, k >= steps)
            }
            // A last step slightly longer is better than a tiny one.
            Method::Adaptive { longest_step_s, .. } => {
                let step = step.min(longest_step_s);
                if step >= left || 1.01 * step >= left { (left, true) } else { (step, false) }
            }
        }
    }

    /// Records the start.
    fn begin(&mut self, time: f64) -> Result<(), Stop> {
        self.next.copy_from_slice(&self.stepper.start);
        let energy = self.dynamics.energy(&self.next);
        self.simulation.audit = EnergyAudit { start: energy, end: energy, worst_drift_j: 0.0 };
        self.event_values = (0..self.settings.events.len()).map(|k| self.event_value(k, time, None)).collect();
        if self.outputs.first() == Some(&time) || self.settings.outputs == Outputs::Steps {
            self.next_output += usize::from(self.settings.outputs != Outputs::Steps);
            self.sample(time, None)?;
        }
        Ok(())
    }

    /// A step that changes the state by about a hundredth of what matters.
    fn first_step(&self) -> f64 {
        let duration = self.settings.end_s - self.settings.start_s;
        let system = self.dynamics.system;
        let n = system.coordinates();
        let rate = &self.stepper.stages[0];
        let fastest = (0..n).fold(self.fastest, |m, k| m.max((rate[k] / system.coordinate_scale[k]).abs()));
        let change = (0..n).fold(fastest, |m, k| m.max((rate[n + k] / (system.coordinate_scale[k] * fastest)).abs()));
        (0.01 / change).min(duration)
    }

    /// Tries a step: none if it is good, else a better length.
    fn attempt(&mut self, time: f64, length: f64) -> Result<Option<f64>, Stop> {
        self.stepper.step(&mut self.dynamics, time, length)?;
        let Method::Adaptive { accuracy, .. } = self.settings.method else { return Ok(None) };
        let error = self.error_norm() / accuracy;
        if error.is_nan() {
            return Err(Stop::NotFinite);
        }
        if error > 1.0 {
            return Ok(Some(length * (0.9 * maths::powf(error, -0.2)).clamp(0.1, 0.9)));
        }
        // PI controller: Hairer & Wanner, volume II, section IV.2, with the exponents of DOPRI5.
        let grow = 0.9 * maths::powf(error.max(1e-10), -0.17) * maths::powf(self.previous_error, 0.04);
        self.previous_error = error.max(1e-4);
        self.advice_s = length * grow.clamp(0.2, 10.0);
        Ok(None)
    }

    /// Root of the mean square of the local error over what matters.
    fn error_norm(&self) -> f64 {
        let system = self.dynamics.system;
        let n = system.coordinates();
        let fastest = self.fastest.max(self.speed());
        let mut sum = 0.0;
        for (k, scale) in system.coordinate_scale.iter().enumerate() {
            let position = self.stepper.error[k] / scale.max((self.stepper.end[k] - self.first[k]).abs());
            let velocity = self.stepper.error[n + k] / (scale * fastest);
            sum += position * position + velocity * velocity;
        }
        (sum / (2 * n).max(1) as f64).sqrt()
    }

    /// Fastest velocity at the end of the step over the coordinate's scale.
    fn speed(&self) -> f64 {
        let system = self.dynamics.system;
        let n = system.coordinates();
        (0..n).fold(0.0, |m: f64, k| m.max((self.stepper.end[n + k] / system.coordinate_scale[k]).abs()))
    }

    /// Projects the end, records what lies in the step, and moves on. Returns the length to try next.
    fn accept(&mut self, end: f64) -> Result<f64, Stop> {
        self.simulation.steps += 1;
        self.fastest = self.fastest.max(self.speed());
        self.next.copy_from_slice(&self.stepper.end);
        let last = self.stepper.stages.len() - 1;
        self.next_rate.copy_from_slice(&self.stepper.stages[last]);
        // The last stage was computed at the end: its factors are there.
        let project = !matches!(self.settings.method, Method::Fixed { project: false, .. });
        if project && self.dynamics.project(end, &mut self.next)? {
            self.dynamics.rate(end, &self.next, &mut self.next_rate)?;
        }
        let energy = self.dynamics.energy(&self.next);
        let reached = self.between_ends(end)?;
        if let Some((event, time)) = reached {
            self.simulation.reached_s = time;
            return Err(Stop::Event { index: event });
        }
        let audit = &mut self.simulation.audit;
        audit.end = energy;
        audit.worst_drift_j = audit.worst_drift_j.max((energy.balance_j() - audit.start.balance_j()).abs());
        self.simulation.reached_s = end;
        self.stepper.start.copy_from_slice(&self.next);
        self.stepper.stages[0].copy_from_slice(&self.next_rate);
        Ok(self.advice_s)
    }

    /// Outputs and events of the step in order of time; a terminal event with its time, if one ends it.
    fn between_ends(&mut self, end: f64) -> Result<Option<(usize, f64)>, Stop> {
        let mut marks: Vec<(f64, Mark)> = Vec::new();
        if self.settings.outputs == Outputs::Steps {
            marks.push((1.0, Mark::Output));
        }
        while let Some(&time) = self.outputs.get(self.next_output).filter(|time| **time <= end) {
            let share = if time < end { (time - self.stepper.time_s) / self.stepper.step_s } else { 1.0 };
            marks.push((share.clamp(0.0, 1.0), Mark::Output));
            self.next_output += 1;
        }
        self.find_events(end, &mut marks);
        marks.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (share, mark) in marks {
            let time = if share < 1.0 { self.stepper.time_s + share * self.stepper.step_s } else { end };
            self.sample(time, (share < 1.0).then_some(share))?;
            if let Mark::Event(event) = mark {
                let state = self.simulation.history.len() - 1;
                self.simulation.hits.push(Hit { event, time_s: time, state });
                if self.settings.events[event].terminal {
                    if let Some(energy) = self.simulation.energies.last() {
                        self.simulation.audit.end = *energy;
                    }
                    return Ok(Some((event, time)));
                }
            }
        }
        Ok(None)
    }

    /// Looks for changes of sign in quarters of the step and refines them by Brent's method on the dense output.
    fn find_events(&mut self, end: f64, marks: &mut Vec<(f64, Mark)>) {
        for k in 0..self.settings.events.len() {
            let mut before = (0.0, self.event_values[k]);
            for quarter in 1..=4 {
                let share = 0.25 * f64::from(quarter);
                let value = self.event_at(k, share, end);
                let rising = before.1 < 0.0 && value >= 0.0;
                let falling = before.1 > 0.0 && value <= 0.0;
                let wanted = match self.settings.events[k].crossing {
                    Crossing::Rising => rising,
                    Crossing::Falling => falling,
                    Crossing::Any => rising || falling,
                };
                if wanted && let Ok(root) = roots::root(|share| self.event_at(k, share, end), before.0, share, 1e-15) {
                    marks.push((root, Mark::Event(k)));
                }
                before = (share, value);
            }
            self.event_values[k] = before.1;
        }
    }

    fn event_at(&mut self, event: usize, share: f64, end: f64) -> f64 {
        if share >= 1.0 {
            return self.event_value(event, end, None);
        }
        self.event_value(event, self.stepper.time_s + share * self.stepper.step_s, Some(share))
    }

    /// Value of an event inside the step, or at its projected end.
    fn event_value(&mut self, event: usize, time_s: f64, share: Option<f64>) -> f64 {
        self.look_at(share);
        let system = self.dynamics.system;
        (self.settings.events[event].function)(&Snapshot { time_s, system, frames: &self.dynamics.frames })
    }

    fn look_at(&mut self, share: Option<f64>) {
        match share {
            Some(share) => self.stepper.between(share, &mut self.inside),
            None => self.inside.copy_from_slice(&self.next),
        }
        self.dynamics.place(&self.inside);
    }

    /// Keeps a state, on the constraints, with its accelerations and multipliers.
    fn sample(&mut self, time_s: f64, share: Option<f64>) -> Result<(), Stop> {
        self.look_at(share);
        let n = self.dynamics.system.coordinates();
        let mut y = std::mem::take(&mut self.inside);
        self.dynamics.rate(time_s, &y, &mut self.inside_rate)?;
        let project = !matches!(self.settings.method, Method::Fixed { project: false, .. });
        if project && self.dynamics.project(time_s, &mut y)? {
            self.dynamics.rate(time_s, &y, &mut self.inside_rate)?;
        }
        let dynamics = &self.dynamics;
        self.simulation.history.push(time_s, [&y[..n], &y[n..2 * n], &dynamics.acceleration], &dynamics.multipliers, &dynamics.kept);
        self.simulation.energies.push(dynamics.energy(&y));
        self.inside = y;
        Ok(())
    }
}
