//! The problem as the method sees it: fixed variables left out, everything of order one.
//!
//! `x = start + scale·z`. The objective and each constraint are divided by the largest entry of their gradient in `z` at the start, so
//! that neither the units nor a factor on a function changes the path of the iterates.

use super::Settings;
use super::outcome::Counters;
use super::problem::{Problem, Rejected, Values};

/// Bounds beyond this count as none.
const INFINITE: f64 = 1e20;

/// Values and derivatives in scaled quantities, at `z`.
#[derive(Debug, Clone, Default)]
pub(super) struct Point {
    pub(super) z: Vec<f64>,
    pub(super) objective: f64,
    pub(super) gradient: Vec<f64>,
    pub(super) constraints: Vec<f64>,
    pub(super) jacobian: Vec<f64>,
}

/// The scaled problem.
pub(super) struct Model<'p> {
    problem: &'p mut dyn Problem,
    /// Indices of the variables that are not fixed.
    free: Vec<usize>,
    x_lower: Vec<f64>,
    x_upper: Vec<f64>,
    /// The start, projected; fixed variables keep these values.
    origin: Vec<f64>,
    scale: Vec<f64>,
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
    /// Whether all is linear in a variable.
    pub(super) linear: Vec<bool>,
    pub(super) row_lower: Vec<f64>,
    pub(super) row_upper: Vec<f64>,
    objective_scale: f64,
    row_scale: Vec<f64>,
    x: Vec<f64>,
    values: Values,
    pub(super) counters: Counters,
}

/// The search cannot begin.
pub(super) enum NoStart {
    Malformed,
    Rejected,
}

fn unbounded_as_infinite(bounds: &[f64]) -> Vec<f64> {
    bounds.iter().map(|&b| if b.abs() >= INFINITE { f64::INFINITY.copysign(b) } else { b }).collect()
}

/// Whether each pair of bounds leaves room; NaN does not.
fn ordered(lower: &[f64], upper: &[f64]) -> bool {
    lower.len() == upper.len() && lower.iter().zip(upper).all(|(l, u)| l <= u && *l < INFINITE && *u > -INFINITE)
}

impl<'p> Model<'p> {
    /// Evaluates the start, projected into the bounds, and chooses the scales there.
    pub(super) fn new(problem: &'p mut dyn Problem, start: &[f64], settings: &Settings) -> Result<(Self, Point), NoStart> {
        let (x_lower, x_upper) = (problem.lower().to_vec(), problem.upper().to_vec());
        let (row_lower, row_upper) = (problem.constraint_lower().to_vec(), problem.constraint_upper().to_vec());
        let (n, m) = (x_lower.len(), row_lower.len());
        let sound = ordered(&x_lower, &x_upper)
            && ordered(&row_lower, &row_upper)
            && start.len() == n
            && start.iter().all(|x| x.is_finite())
            && (settings.scales.is_empty() || settings.scales.len() == n)
            && (settings.constraint_scales.is_empty() || settings.constraint_scales.len() == m);
        if !sound {
            return Err(NoStart::Malformed);
        }
        let origin: Vec<f64> = start.iter().zip(x_lower.iter().zip(&x_upper)).map(|(x, (l, u))| x.clamp(*l, *u)).collect();
        let free: Vec<usize> = (0..n).filter(|&j| x_lower[j] < x_upper[j]).collect();
        let (low, high) = (unbounded_as_infinite(&x_lower), unbounded_as_infinite(&x_upper));
        let scale: Vec<f64> = free
            .iter()
            .map(|&j| {
                let asked = settings.scales.get(j).copied().filter(|s| *s > 0.0 && s.is_finite());
                let range = Some(high[j] - low[j]).filter(|r| r.is_finite());
                let size = Some(origin[j].abs()).filter(|s| *s > 0.0);
                asked.or(range).or(size).unwrap_or(1.0)
            })
            .collect();
        let bound = |b: &[f64]| free.iter().zip(&scale).map(|(&j, s)| (b[j] - origin[j]) / s).collect::<Vec<_>>();
        let (lower, upper) = (bound(&low), bound(&high));
        let linear = free.iter().map(|&j| problem.is_linear(j)).collect();
        let mut model = Self {
            problem,
            x: origin.clone(),
            x_lower,
            x_upper,
            origin,
            lower,
            upper,
            linear,
            row_lower: unbounded_as_infinite(&row_lower),
            row_upper: unbounded_as_infinite(&row_upper),
            objective_scale: 1.0,
            row_scale: vec![1.0; m],
            values: Values::zeros(n, m),
            counters: Counters::default(),
            scale,
            free,
        };
        let mut point = Point { z: vec![0.0; model.free.len()], ..Point::default() };
        model.evaluate_with_gradients(&mut point).map_err(|Rejected| NoStart::Rejected)?;
        model.choose_scales(&point, &settings.constraint_scales);
        model.fill(&mut point, true);
        Ok((model, point))
    }

    pub(super) fn variables(&self) -> usize {
        self.free.len()
    }

    /// Largest change of a variable in which not all is linear, in its scale.
    pub(super) fn length(&self, step: &[f64]) -> f64 {
        step.iter().zip(&self.linear).filter(|(_, linear)| !**linear).fold(0.0, |m, (d, _)| m.max(d.abs()))
    }

    /// Scales from the values at the start. A constraint far from its limit compared to its gradient is scaled by that distance: its
    /// gradient there says nothing of the gradient where it matters.
    fn choose_scales(&mut self, start: &Point, asked: &[f64]) {
        let largest = |v: &[f64]| v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let positive = |s: f64| if s > 0.0 { s } else { 1.0 };
        self.objective_scale = positive(largest(&start.gradient).max(1e-8 * start.objective.abs()));
        let n = self.variables();
        for (i, c) in start.constraints.iter().enumerate() {
            let distance = (c - self.row_lower[i]).abs().min((self.row_upper[i] - c).abs());
            let distance = if distance.is_finite() { distance } else { 0.0 };
            let own = || positive(largest(&start.jacobian[i * n..(i + 1) * n]).max(0.1 * distance));
            let scale = asked.get(i).copied().filter(|s| *s > 0.0 && s.is_finite()).unwrap_or_else(own);
            self.row_scale[i] = scale;
            self.row_lower[i] /= scale;
            self.row_upper[i] /= scale;
        }
    }

    /// Objective and constraints at `point.z`.
    pub(super) fn evaluate(&mut self, point: &mut Point) -> Result<(), Rejected> {
        self.counters.evaluations += 1;
        self.call(point, false)
    }

    /// The same with derivatives.
    pub(super) fn evaluate_with_gradients(&mut self, point: &mut Point) -> Result<(), Rejected> {
        self.counters.gradient_evaluations += 1;
        self.call(point, true)
    }

    fn call(&mut self, point: &mut Point, gradients: bool) -> Result<(), Rejected> {
        self.place(&point.z);
        let answer = self.problem.evaluate(&self.x, gradients, &mut self.values);
        if answer.is_err() || !self.values.sound(self.origin.len(), self.row_scale.len(), gradients) {
            self.counters.rejections += 1;
            self.values = Values::zeros(self.origin.len(), self.row_scale.len());
            return Err(Rejected);
        }
        self.fill(point, gradients);
        Ok(())
    }

    /// Sets `x`; a bound reached in `z` is reached exactly.
    fn place(&mut self, z: &[f64]) {
        for (k, &j) in self.free.iter().enumerate() {
            let x = self.origin[j] + self.scale[k] * z[k];
            self.x[j] = if z[k] <= self.lower[k] {
                self.x_lower[j]
            } else if z[k] >= self.upper[k] {
                self.x_upper[j]
            } else {
                x.clamp(self.x_lower[j], self.x_upper[j])
            };
        }
    }

    fn fill(&self, point: &mut Point, gradients: bool) {
        let values = &self.values;
        let total = self.origin.len();
        point.objective = values.objective / self.objective_scale;
        point.constraints.clear();
        point.constraints.extend(values.constraints.iter().zip(&self.row_scale).map(|(c, r)| c / r));
        point.gradient.clear();
        point.jacobian.clear();
        if gradients {
            let columns = || self.free.iter().zip(&self.scale);
            point.gradient.extend(columns().map(|(&j, s)| values.gradient[j] * s / self.objective_scale));
            for (i, r) in self.row_scale.iter().enumerate() {
                point.jacobian.extend(columns().map(|(&j, s)| values.jacobian[i * total + j] * s / r));
            }
        }
    }

    /// The point in the caller's variables.
    pub(super) fn x_of(&mut self, z: &[f64]) -> Vec<f64> {
        self.place(z);
        self.x.clone()
    }

    /// The objective in the caller's unit.
    pub(super) fn objective_of(&self, scaled: f64) -> f64 {
        scaled * self.objective_scale
    }

    /// Constraints in the caller's units, and the largest violation there.
    pub(super) fn constraints_of(&self, scaled: &[f64]) -> (Vec<f64>, f64) {
        let values: Vec<f64> = scaled.iter().zip(&self.row_scale).map(|(c, r)| c * r).collect();
        let (lower, upper) = (self.problem.constraint_lower(), self.problem.constraint_upper());
        let violation = values.iter().zip(lower.iter().zip(upper)).fold(0.0_f64, |v, (c, (l, u))| v.max(l - c).max(c - u));
        (values, violation)
    }

    /// Multipliers in the caller's units: rates of the objective, or else of the sum of scaled violations.
    pub(super) fn multipliers_of(&self, scaled: &[f64], of_objective: bool) -> Vec<f64> {
        let unit = if of_objective { self.objective_scale } else { 1.0 };
        scaled.iter().zip(&self.row_scale).map(|(y, r)| y * unit / r).collect()
    }

    /// Multipliers of the bounds in the caller's units; those of fixed variables need the derivatives at the point.
    pub(super) fn bound_multipliers_of(&mut self, z: &[f64], multipliers: &[f64], bounds: &[f64], of_objective: bool) -> Vec<f64> {
        let total = self.origin.len();
        let unit = if of_objective { self.objective_scale } else { 1.0 };
        let mut all = vec![0.0; total];
        for ((&j, s), mu) in self.free.iter().zip(&self.scale).zip(bounds) {
            all[j] = mu * unit / s;
        }
        if self.free.len() < total {
            let mut point = Point { z: z.to_vec(), ..Point::default() };
            let known = self.evaluate_with_gradients(&mut point).is_ok();
            for j in (0..total).filter(|j| !self.free.contains(j)) {
                let forces = multipliers.iter().enumerate().map(|(i, y)| y * self.values.jacobian[i * total + j]);
                let own = if of_objective { self.values.gradient[j] } else { 0.0 };
                all[j] = if known { own - forces.sum::<f64>() } else { f64::NAN };
            }
        }
        all
    }
}

/// By how much each row lies outside its bounds (≥ 0).
pub(super) fn violations<'a>(values: &'a [f64], lower: &'a [f64], upper: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    values.iter().zip(lower.iter().zip(upper)).map(|(c, (l, u))| (l - c).max(c - u).max(0.0))
}
