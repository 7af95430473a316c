//! The ℓ₁ merit function and the search along a step.
//!
//! `φ(z) = f(z) + Σ ρᵢ·violationᵢ(z)`: S.-P. Han, "A globally convergent method for nonlinear programming", Journal of Optimization
//! Theory and Applications 22 (1977); penalties after Powell 1978 (named in full at the Hessian).

use super::hessian::dot;
use super::model::{Model, Point, violations};
use super::qp::{Outcome, Qp, QpSolver};

/// Least part of the predicted decrease that a step must bring.
const SUFFICIENT: f64 = 1e-4;
/// Penalties stay above the multipliers by this factor …
const MARGIN: f64 = 1.2;
/// … and above this part of the largest multiplier, so that no limit is free to cross.
const FLOOR: f64 = 0.3;
/// After a rejected point the step is shortened by this.
const AFTER_REJECTION: f64 = 0.25;

/// Penalties of the merit function.
#[derive(Debug, Clone)]
pub(super) struct Merit {
    pub(super) penalties: Vec<f64>,
}

impl Merit {
    pub(super) fn new(constraints: usize) -> Self {
        Self { penalties: vec![0.0; constraints] }
    }

    /// Follows the multipliers: up at once, down by half of the difference.
    pub(super) fn follow(&mut self, multipliers: &[f64]) {
        let largest = multipliers.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
        for (rho, y) in self.penalties.iter_mut().zip(multipliers) {
            let wanted = (MARGIN * y.abs()).max(FLOOR * largest);
            *rho = wanted.max(0.5 * (*rho + wanted));
        }
    }

    pub(super) fn value(&self, model: &Model<'_>, point: &Point) -> f64 {
        let outside = violations(&point.constraints, &model.row_lower, &model.row_upper);
        point.objective + self.penalties.iter().zip(outside).map(|(rho, v)| rho * v).sum::<f64>()
    }

    /// Predicted change of the merit function over the whole step (negative).
    pub(super) fn slope(&self, qp: &Qp<'_>, step: &[f64]) -> f64 {
        let change = |(i, rho): (usize, &f64)| {
            let (l, u, value) = (qp.row_lower[i], qp.row_upper[i], dot(qp.row(i), step));
            rho * ((l - value).max(value - u).max(0.0) - l.max(-u).max(0.0))
        };
        let change: f64 = self.penalties.iter().enumerate().map(change).sum();
        dot(qp.gradient, step) + change
    }
}

/// What the search along the step found.
pub(super) struct Found {
    /// A better point, with derivatives; `None` if there is none on the whole step.
    pub(super) next: Option<Box<Point>>,
    /// The part of the step taken: 1 for a corrected whole step, 0 for none.
    pub(super) part: f64,
    /// The shortest part that was rejected.
    pub(super) rejected: Option<f64>,
}

impl Found {
    fn step(next: Box<Point>, part: f64, rejected: Option<f64>) -> Self {
        Self { next: Some(next), part, rejected }
    }

    pub(super) fn nothing(rejected: Option<f64>) -> Self {
        Self { next: None, part: 0.0, rejected }
    }
}

/// Searches along a step of the quadratic programme for a point of less merit.
pub(super) struct LineSearch<'a> {
    pub(super) merit: &'a Merit,
    pub(super) qp: &'a Qp<'a>,
    pub(super) point: &'a Point,
    pub(super) step: &'a [f64],
}

impl LineSearch<'_> {
    /// Whole step first, then with its constraints corrected to second order (against the effect of N. Maratos; Nocedal & Wright,
    /// sections 15.6 and 18.3), then shorter ones.
    pub(super) fn run(&self, model: &mut Model<'_>, solver: &mut QpSolver) -> Found {
        let start = self.merit.value(model, self.point);
        let slope = self.merit.slope(self.qp, self.step).min(0.0);
        let noise = 10.0 * f64::EPSILON * (start.abs() + self.point.objective.abs());
        let length = self.step.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
        let size = self.point.z.iter().fold(1.0_f64, |m, z| m.max(z.abs()));
        let mut rejected = None;
        let mut part = 1.0;
        while part * length > f64::EPSILON * size && part > 1e-14 {
            let mut trial = self.moved(self.step, part);
            let mut next = AFTER_REJECTION * part;
            if model.evaluate(&mut trial).is_ok() {
                let merit = self.merit.value(model, &trial);
                if merit <= start + SUFFICIENT * part * slope + noise {
                    if model.evaluate_with_gradients(&mut trial).is_ok() {
                        return Found::step(Box::new(trial), part, rejected);
                    }
                    rejected = Some(part);
                } else {
                    if part >= 1.0
                        && let Some(corrected) = self.corrected(&trial, model, solver, start + SUFFICIENT * slope + noise)
                    {
                        return Found::step(corrected, 1.0, None);
                    }
                    let parabola = -slope * part * part / (2.0 * (merit - start - part * slope));
                    next = if parabola.is_finite() { parabola.clamp(0.1 * part, 0.5 * part) } else { next };
                }
            } else {
                rejected = Some(part);
            }
            part = next;
        }
        Found::nothing(rejected)
    }

    fn moved(&self, step: &[f64], part: f64) -> Point {
        let towards = |(z, (d, (l, u))): (&f64, (&f64, (&f64, &f64)))| {
            // At the whole step a bound that is reached is reached exactly.
            let target = z + part * d;
            if part >= 1.0 && d <= l {
                z + l
            } else if part >= 1.0 && d >= u {
                z + u
            } else {
                target
            }
        };
        let z = self.point.z.iter().zip(step.iter().zip(self.qp.lower.iter().zip(self.qp.upper))).map(towards).collect();
        Point { z, ..Point::default() }
    }

    /// The step whose linearised constraints are shifted by what the whole step found, if its merit is low enough.
    fn corrected(&self, whole: &Point, model: &mut Model<'_>, solver: &mut QpSolver, limit: f64) -> Option<Box<Point>> {
        let mut shift: Vec<f64> = (0..whole.constraints.len())
            .map(|i| whole.constraints[i] - self.point.constraints[i] - dot(self.qp.row(i), self.step))
            .collect();
        shift.resize(self.qp.row_lower.len(), 0.0);
        let shifted = |bounds: &[f64]| bounds.iter().zip(&shift).map(|(b, s)| b - s).collect::<Vec<f64>>();
        let (row_lower, row_upper) = (shifted(self.qp.row_lower), shifted(self.qp.row_upper));
        let programme = Qp { row_lower: &row_lower, row_upper: &row_upper, ..*self.qp };
        if solver.solve(&programme, &mut model.counters) != Outcome::Solved {
            return None;
        }
        let mut trial = self.moved(&solver.answer.step, 1.0);
        let good = model.evaluate(&mut trial).is_ok() && self.merit.value(model, &trial) <= limit;
        (good && model.evaluate_with_gradients(&mut trial).is_ok()).then(|| Box::new(trial))
    }
}
