//! The ℓ₁ merit function and the search along a step.
//!
//! A step is judged by the worst of the last points, not by the present one alone: L. Grippo, F. Lampariello and S. Lucidi, "A nonmonotone
//! line search technique for Newton's method", SIAM Journal on Numerical Analysis 23 (1986). Along curved constraints most whole steps
//! raise the merit function a little and would each cost a correction.
//!
//! `φ(z) = f(z) + Σ ρᵢ·violationᵢ(z)`: S.-P. Han, "A globally convergent method for nonlinear programming", Journal of Optimization
//! Theory and Applications 22 (1977); penalties after Powell 1978 (named in full at the Hessian).

use std::collections::VecDeque;

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
/// A step whose parts are rejected down to this length is not followed any further.
const SHORTEST: f64 = 1e-8;
/// Points short of a rejected one whose merit is too high, before a new programme is asked.
const MOST_TOO_HIGH: usize = 3;
/// A step is judged by the worst of the present point and of so many before it.
const MEMORY: usize = 3;

/// Penalties of the merit function, and the last points that it judged.
#[derive(Debug, Clone)]
pub(super) struct Merit {
    pub(super) penalties: Vec<f64>,
    /// Objective and violations, since the penalties change.
    past: VecDeque<(f64, Vec<f64>)>,
}

impl Merit {
    pub(super) fn new(constraints: usize) -> Self {
        Self { penalties: vec![0.0; constraints], past: VecDeque::new() }
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
        self.weigh(point.objective, violations(&point.constraints, &model.row_lower, &model.row_upper))
    }

    fn weigh(&self, objective: f64, outside: impl Iterator<Item = f64>) -> f64 {
        objective + self.penalties.iter().zip(outside).map(|(rho, v)| rho * v).sum::<f64>()
    }

    /// Keeps a point in mind that is left, or from which a step failed: each failure makes the judgement stricter.
    pub(super) fn remember(&mut self, model: &Model<'_>, point: &Point) {
        let outside = violations(&point.constraints, &model.row_lower, &model.row_upper).collect();
        self.past.push_back((point.objective, outside));
        if self.past.len() > MEMORY {
            self.past.pop_front();
        }
    }

    /// Forgets all points.
    pub(super) fn forget(&mut self) {
        self.past.clear();
    }

    /// The worst value, by the present penalties, of a point and of those in mind.
    fn worst(&self, present: f64) -> f64 {
        self.past.iter().map(|(objective, outside)| self.weigh(*objective, outside.iter().copied())).fold(present, f64::max)
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
    /// A better point, with derivatives.
    pub(super) next: Option<Box<Point>>,
    /// The part of the step taken: 1 for a corrected whole step. Without a point, the part of its length to try next; 0 for none.
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

/// Looks along a step of the quadratic programme for a point of less merit.
pub(super) struct LineSearch<'a> {
    pub(super) merit: &'a Merit,
    pub(super) qp: &'a Qp<'a>,
    pub(super) point: &'a Point,
    pub(super) step: &'a [f64],
}

impl LineSearch<'_> {
    /// Whole step first, then with its constraints corrected to second order (against the effect of N. Maratos; Nocedal & Wright,
    /// sections 15.6 and 18.3); shorter ones only where points are rejected. Where the merit is too high, a new programme within a
    /// shorter reach finds a better step than a part of this one.
    pub(super) fn run(&self, model: &mut Model<'_>, solver: &mut QpSolver) -> Found {
        let start = self.merit.value(model, self.point);
        let slope = self.merit.slope(self.qp, self.step).min(0.0);
        let noise = 10.0 * f64::EPSILON * (start.abs() + self.point.objective.abs());
        let worst = self.merit.worst(start) + noise;
        let length = self.step.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
        let size = self.point.z.iter().fold(1.0_f64, |m, z| m.max(z.abs()));
        let shortest = (f64::EPSILON * size).max(SHORTEST * length.min(1.0));
        let (mut rejected, mut too_high) = (None, 0);
        let mut part = 1.0;
        while part * length > shortest && part > 1e-14 {
            let mut trial = self.moved(self.step, part);
            let limit = if rejected.is_none() { worst } else { start + noise } + SUFFICIENT * part * slope;
            let mut next = AFTER_REJECTION;
            if model.evaluate(&mut trial).is_ok() {
                let merit = self.merit.value(model, &trial);
                if merit <= limit {
                    if model.evaluate_with_gradients(&mut trial).is_ok() {
                        return Found::step(Box::new(trial), part, rejected);
                    }
                    rejected = Some(part);
                } else {
                    if part >= 1.0
                        && let Some(corrected) = self.corrected(&trial, model, solver, limit)
                    {
                        return Found::step(corrected, 1.0, None);
                    }
                    // Where the parabola through the merit here and there, with the slope here, is least.
                    let least = -slope * part / (2.0 * (merit - start - part * slope));
                    next = if least.is_finite() { least.clamp(0.1, 0.5) } else { next };
                    too_high += 1;
                    if rejected.is_none() || too_high >= MOST_TOO_HIGH {
                        return Found { next: None, part: next * part, rejected };
                    }
                }
            } else {
                rejected = Some(part);
            }
            part *= next;
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

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 + 2·0.5 = 2 and 3 + 2·0: by the penalties of now, not those of then.
    #[test]
    fn the_worst_of_the_last_points_is_by_present_penalties() {
        let mut merit = Merit::new(1);
        merit.past.extend([(1.0, vec![0.5]), (3.0, vec![0.0])]);
        assert_eq!([merit.worst(2.5), merit.worst(4.0)].map(f64::to_bits), [3.0_f64, 4.0].map(f64::to_bits));
        merit.penalties[0] = 8.0;
        assert_eq!(merit.worst(2.5).to_bits(), 5.0_f64.to_bits());
        merit.forget();
        assert_eq!(merit.worst(2.5).to_bits(), 2.5_f64.to_bits());
    }
}
