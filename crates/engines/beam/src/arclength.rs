//! Steps along the arc length of a path, through limit points of the control.
//!
//! E. Riks, "An incremental approach to the solution of snapping and buckling problems", Int. J. Solids Struct. 15 (1979); H. B.
//! Keller, "Numerical solution of bifurcation and nonlinear eigenvalue problems" (1977). State and control together are the unknowns;
//! the additional equation keeps the correction perpendicular to the path. At a limit point the tangent by the state alone has no
//! inverse, the bordered one does.
//!
//! The arc length s counts rotations in rad and displacements with the weight of the stepper; forces do not count.

use forcewright_base::{
    dense::{Lu, Singular},
    roots,
};

use crate::{
    assembly::System,
    stepping::{CONVERGED, Failure, Interrupted, Knot, LARGEST_CORRECTION, LARGEST_DEFECT, MOST_ITERATIONS, ROUNDING, Stepper, larger},
};

/// Weight of a dimensionless load in the arc length: only so that a network that hardly moves has a direction.
const LOAD_WEIGHT: f64 = 1e-3;

/// Largest difference between the mean slope of the control over a step and that of its ends, relative to the larger of those.
const LARGEST_BEND: f64 = 0.2;

/// A state with its derivative by the arc length, dimensionless.
#[derive(Debug, Clone)]
pub(crate) struct ArcKnot {
    /// Arc length from rest.
    pub(crate) way: f64,
    pub(crate) control: f64,
    /// Derivative of the control by the arc length.
    pub(crate) control_rate: f64,
    pub(crate) state: Vec<f64>,
    pub(crate) rate: Vec<f64>,
    /// Number of unstable motions before and after; they differ at a limit point only.
    pub(crate) instability: [usize; 2],
    pub(crate) fold: bool,
}

/// The tangent bordered by one row: that of the step.
#[derive(Debug, Default)]
pub(crate) struct Border {
    lu: Lu,
    matrix: Vec<f64>,
    rhs: Vec<f64>,
    /// The row over a whole state, and over the control of a force drive.
    row: Vec<f64>,
    row_control: f64,
    /// The part of the bubbles' residual in the row.
    constant: f64,
}

impl Border {
    /// Factors the system that was just evaluated together with the row.
    fn factor(&mut self, system: &System) -> Result<(), Singular> {
        let model = system.model;
        let (m, rows) = (model.unknowns, model.solved);
        // The last column is the driven unknown, or the load.
        let (size, columns) = (rows + 1, rows + usize::from(model.kinematic));
        self.matrix.clear();
        self.matrix.resize(size * size, 0.0);
        for row in 0..rows {
            self.matrix[row * size..row * size + columns].copy_from_slice(&system.matrix[row * m..row * m + columns]);
        }
        let last = &mut self.matrix[rows * size..];
        last[..columns].copy_from_slice(&self.row[..columns]);
        self.constant = 0.0;
        let bubbles = system.resolution.basis.bubbles;
        for (index, beam) in model.beams.iter().enumerate() {
            let first = m + index * bubbles;
            let sum = system.elements[index].project(&self.row[first..first + bubbles]);
            for (place, value) in [beam.ends[0], beam.ends[1], Some(beam.force), Some(beam.force + 1)].iter().zip(sum) {
                if let Some(place) = place.filter(|place| *place < columns) {
                    last[place] -= value;
                }
            }
            self.constant += sum[4];
        }
        if !model.kinematic {
            last[rows] = self.row_control;
            for (place, factor) in model.pull.iter().filter(|(place, _)| *place < rows) {
                self.matrix[place * size + rows] = -factor;
            }
        }
        self.lu.factor(size, size, &self.matrix)
    }

    /// Newton step into [`System::change`]; returns that of the control.
    fn newton_step(&mut self, system: &mut System) -> f64 {
        let rows = system.model.solved;
        self.rhs.clear();
        self.rhs.extend(system.residual[..rows].iter().map(|r| -r));
        self.rhs.push(self.constant);
        self.solve(system, 1.0)
    }

    /// Direction of the path into [`System::change`], of length 1 along the row; returns its component along the control.
    fn tangent(&mut self, system: &mut System) -> f64 {
        self.rhs.clear();
        self.rhs.resize(system.model.solved, 0.0);
        self.rhs.push(1.0);
        self.solve(system, 0.0)
    }

    fn solve(&mut self, system: &mut System, residual: f64) -> f64 {
        let (rows, kinematic) = (system.model.solved, system.model.kinematic);
        self.lu.solve(&mut self.rhs);
        let moved = rows + usize::from(kinematic);
        system.change.fill(0.0);
        system.change[..moved].copy_from_slice(&self.rhs[..moved]);
        system.expand(residual);
        if kinematic { system.model.projection * self.rhs[rows] } else { self.rhs[rows] }
    }
}

/// Length of an arc from its chord and the difference of the unit tangents at its ends: exact for circles.
fn arc_length(chord: f64, turn: f64) -> f64 {
    // (φ/2)/sin(φ/2) with 2 sin(φ/2) = turn.
    let s = 0.25 * turn * turn;
    chord * (1.0 + s * (1.0 / 6.0 + s * (3.0 / 40.0)))
}

/// Value and slope of the cubic through two knots at s in [0, 1], with the derivative scaled to s.
pub(crate) fn control_between(a: &ArcKnot, b: &ArcKnot, s: f64) -> f64 {
    let h = b.way - a.way;
    let (turned, rise) = (1.0 - s, b.control - a.control);
    a.control + rise * s * s * (3.0 - 2.0 * s) + h * s * turned * (a.control_rate * turned - b.control_rate * s)
}

impl Stepper<'_> {
    /// Square root of the weighted sum of squares.
    fn length_of(&self, v: impl Iterator<Item = f64>, control: f64) -> f64 {
        let load = if self.system.model.kinematic { 0.0 } else { LOAD_WEIGHT * control };
        v.zip(&self.weights).map(|(v, w)| (w * v) * (w * v)).fold(load * load, |sum, square| sum + square).sqrt()
    }

    /// Distance along the path between two knots, the later one without its place.
    fn way_between(&self, a: &ArcKnot, b: &ArcKnot) -> f64 {
        let chord = self.length_of(a.state.iter().zip(&b.state).map(|(a, b)| b - a), b.control - a.control);
        let turn = self.length_of(a.rate.iter().zip(&b.rate).map(|(a, b)| b - a), b.control_rate - a.control_rate);
        arc_length(chord, turn)
    }

    /// Knots along the control, as knots along the arc.
    pub(crate) fn along_arc(&self, natural: &[Knot]) -> Vec<ArcKnot> {
        let mut arc: Vec<ArcKnot> = Vec::with_capacity(natural.len());
        for knot in natural {
            let length = self.length_of(knot.tangent.iter().copied(), 1.0).max(f64::MIN_POSITIVE);
            let mut next = ArcKnot {
                way: 0.0,
                control: knot.control,
                control_rate: 1.0 / length,
                state: knot.state.clone(),
                rate: knot.tangent.iter().map(|t| t / length).collect(),
                instability: [knot.instability; 2],
                fold: false,
            };
            if let Some(last) = arc.last() {
                next.way = last.way + self.way_between(last, &next);
            }
            arc.push(next);
        }
        arc
    }

    /// Makes the row of the step perpendicular to a direction.
    fn aim(&self, border: &mut Border, rate: &[f64], control_rate: f64) {
        border.row.clear();
        border.row.extend(rate.iter().zip(&self.weights).map(|(r, w)| w * w * r));
        border.row_control = if self.system.model.kinematic { 0.0 } else { LOAD_WEIGHT * LOAD_WEIGHT * control_rate };
    }

    /// Newton's method from [`Stepper::state`] and a control with the row of the border. Returns the control.
    fn correct_across(&mut self, border: &mut Border, mut control: f64) -> Result<f64, Failure> {
        let mut last = f64::INFINITY;
        for iteration in 0..MOST_ITERATIONS {
            if self.counters.newton_iterations >= self.budget {
                return Err(Failure::OutOfBudget);
            }
            self.counters.newton_iterations += 1;
            self.counters.residual_evaluations += 1;
            self.counters.factorisations += 1;
            if self.system.evaluate(&self.state, control).is_err() || border.factor(&self.system).is_err() {
                return Err(Failure::Diverged);
            }
            let change = border.newton_step(&mut self.system);
            let load = if self.system.model.kinematic { 0.0 } else { 1e-2 * change.abs() / control.abs().max(1.0) };
            let size = larger(self.correction_size(), load);
            // Written so that NaN fails.
            if !(size < 0.5 && size < 2.0 * last) {
                return Err(Failure::Diverged);
            }
            for (x, c) in self.state.iter_mut().zip(&self.system.change) {
                *x += c;
            }
            control += change;
            if size <= CONVERGED || (iteration >= 2 && size <= ROUNDING && size > 0.25 * last) {
                self.remember_holding();
                return Ok(control);
            }
            last = size;
        }
        Err(Failure::Diverged)
    }

    /// The knot at the state just corrected, with the tangent in the sense of the border.
    fn knot_here(&mut self, border: &mut Border, control: f64) -> Option<ArcKnot> {
        let control_rate = border.tangent(&mut self.system);
        let length = self.length_of(self.system.change.iter().copied(), control_rate);
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        Some(ArcKnot {
            way: 0.0,
            control,
            control_rate: control_rate / length,
            state: self.state.clone(),
            rate: self.system.change.iter().map(|t| t / length).collect(),
            instability: [self.instability(); 2],
            fold: false,
        })
    }

    /// One step of a given length from the last knot. Returns the next knot and its distance from the prediction.
    pub(crate) fn step_along(&mut self, border: &mut Border, arc: &[ArcKnot], step: f64) -> Result<(ArcKnot, f64), Interrupted> {
        let here = &arc[arc.len() - 1];
        let older = arc.iter().rev().skip(1).take(6).find(|k| step <= 3.0 * (here.way - k.way));
        let control = if let Some(older) = older {
            self.place_between(older, here, here.way + step)
        } else {
            for (p, (x, t)) in self.predicted.iter_mut().zip(here.state.iter().zip(&here.rate)) {
                *p = x + step * t;
            }
            here.control + step * here.control_rate
        };
        self.state.copy_from_slice(&self.predicted);
        self.aim(border, &here.rate, here.control_rate);
        let control = self.correct_across(border, control).map_err(|failure| match failure {
            Failure::Diverged => Interrupted::Rejected,
            Failure::OutOfBudget => Interrupted::OutOfBudget,
        })?;
        let distance = self.distance_from_prediction();
        if distance.is_nan() || distance > LARGEST_CORRECTION {
            return Err(Interrupted::Rejected);
        }
        let mut next = self.knot_here(border, control).ok_or(Interrupted::Rejected)?;
        let way = self.way_between(here, &next);
        next.way = here.way + way;
        if !self.is_smooth_arc(here, &next) {
            return Err(Interrupted::Rejected);
        }
        self.counters.steps += 1;
        Ok((next, distance))
    }

    /// The test of [`Stepper::is_smooth`] along the arc.
    fn is_smooth_arc(&self, from: &ArcKnot, to: &ArcKnot) -> bool {
        let half = 0.5 * (to.way - from.way);
        let (mut change, mut defect) = (0.0, 0.0);
        for (i, w) in self.weights.iter().enumerate() {
            let moved = to.state[i] - from.state[i];
            change = larger(change, (w * moved).abs());
            defect = larger(defect, (w * (moved - half * (from.rate[i] + to.rate[i]))).abs());
        }
        // A control that turns twice within a step would hide two limit points.
        let chord = (to.control - from.control) / (to.way - from.way);
        let hidden = from.control_rate * to.control_rate > 0.0 && chord * from.control_rate <= 0.0;
        let bend = (chord - 0.5 * (from.control_rate + to.control_rate)).abs();
        let plain = bend <= LARGEST_BEND * from.control_rate.abs().max(to.control_rate.abs()) + 1e-6 * to.control.abs();
        defect <= LARGEST_DEFECT * change + CONVERGED && !hidden && plain
    }

    /// Hermite interpolation, or extrapolation, of the state into [`Stepper::predicted`]; returns the control.
    fn place_between(&mut self, a: &ArcKnot, b: &ArcKnot, way: f64) -> f64 {
        let h = b.way - a.way;
        let s = (way - b.way) / h;
        // Written from the end b, so that it returns b exactly at s = 0.
        let from_a = s * s * (3.0 + 2.0 * s);
        let (slope_a, slope_b) = (h * s * s * (1.0 + s), h * s * (1.0 + s) * (1.0 + s));
        let cubic = |a: f64, b: f64, rate_a: f64, rate_b: f64| b + from_a * (a - b) + slope_a * rate_a + slope_b * rate_b;
        for (i, target) in self.predicted.iter_mut().enumerate() {
            *target = cubic(a.state[i], b.state[i], a.rate[i], b.rate[i]);
        }
        cubic(a.control, b.control, a.control_rate, b.control_rate)
    }

    /// The equilibrium at an arc length between two knots.
    pub(crate) fn knot_between(&mut self, border: &mut Border, a: &ArcKnot, b: &ArcKnot, way: f64) -> Option<ArcKnot> {
        let control = self.place_between(a, b, way);
        self.state.copy_from_slice(&self.predicted);
        let s = (way - a.way) / (b.way - a.way);
        let rate: Vec<f64> = a.rate.iter().zip(&b.rate).map(|(a, b)| a + s * (b - a)).collect();
        self.aim(border, &rate, a.control_rate + s * (b.control_rate - a.control_rate));
        let control = self.correct_across(border, control).ok()?;
        let distance = self.distance_from_prediction();
        if distance.is_nan() || distance > LARGEST_CORRECTION {
            return None;
        }
        let mut knot = self.knot_here(border, control)?;
        knot.way = way;
        Some(knot)
    }

    /// The equilibrium at a control between two knots with no limit point between them.
    pub(crate) fn knot_at(&mut self, border: &mut Border, a: &ArcKnot, b: &ArcKnot, control: f64) -> Option<ArcKnot> {
        let s = roots::root(|s| control_between(a, b, s) - control, 0.0, 1.0, 1e-15).ok()?;
        let way = a.way + s * (b.way - a.way);
        self.place_between(a, b, way);
        self.drive_to(control);
        self.state.copy_from_slice(&self.predicted);
        let rate: Vec<f64> = a.rate.iter().zip(&b.rate).map(|(a, b)| a + s * (b - a)).collect();
        self.aim(border, &rate, a.control_rate + s * (b.control_rate - a.control_rate));
        let found = self.correct(control).is_ok() && self.distance_from_prediction() <= LARGEST_CORRECTION;
        if found && border.factor(&self.system).is_ok() {
            let mut knot = self.knot_here(border, control)?;
            knot.way = way;
            return Some(knot);
        }
        // Next to a limit point: along the arc instead.
        let miss = |knot: Option<ArcKnot>| knot.map_or(f64::NAN, |k| k.control - control);
        let way = roots::root(|way| miss(self.knot_between(border, a, b, way)), a.way, b.way, 1e-14).ok()?;
        self.knot_between(border, a, b, way)
    }

    /// Solves once more at a knot: across the path at limit points, at its control elsewhere. Returns the control.
    pub(crate) fn solve_at(&mut self, border: &mut Border, knot: &ArcKnot) -> Option<f64> {
        self.state.copy_from_slice(&knot.state);
        if !knot.fold && self.correct(knot.control).is_ok() {
            return Some(knot.control);
        }
        self.state.copy_from_slice(&knot.state);
        self.aim(border, &knot.rate, knot.control_rate);
        self.correct_across(border, knot.control).ok()
    }

    /// The limit point between two knots whose controls run in opposite senses.
    pub(crate) fn limit_between(&mut self, border: &mut Border, a: &ArcKnot, b: &ArcKnot) -> Option<ArcKnot> {
        let rate = |knot: Option<ArcKnot>| knot.map_or(f64::NAN, |k| k.control_rate);
        let step = b.way - a.way;
        let way = roots::root(|way| rate(self.knot_between(border, a, b, way)), a.way, b.way, 1e-11 * step).ok()?;
        let mut limit = self.knot_between(border, a, b, way)?;
        limit.fold = true;
        // The eigenvalue that vanishes here has a sign only at a distance.
        let aside = 1e-3 * step;
        let before = self.knot_between(border, a, b, (way - aside).max(a.way)).map_or(a.instability[1], |k| k.instability[0]);
        let after = self.knot_between(border, a, b, (way + aside).min(b.way)).map_or(b.instability[0], |k| k.instability[0]);
        limit.instability = [before, after];
        Some(limit)
    }
}
