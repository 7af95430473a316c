//! What the quadratic programme of an iteration is made of.

use super::hessian::dot;
use super::model::{Model, Point, violations};
use super::qp::Qp;
use super::walls::{self, Walls};

/// The linearisation at a point with the walls after its rows, in owned form; [`Subproblem::qp`] lends it.
pub(super) struct Subproblem {
    rows: Vec<f64>,
    row_lower: Vec<f64>,
    row_upper: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl Subproblem {
    pub(super) fn new(model: &Model<'_>, point: &Point, walls: &Walls, reach: f64) -> Self {
        let minus = |bounds: &[f64], values: &[f64]| bounds.iter().zip(values).map(|(b, v)| b - v).collect::<Vec<f64>>();
        let mut lower = minus(&model.lower, &point.z);
        let mut upper = minus(&model.upper, &point.z);
        // Rounding must not put the present point outside.
        for ((l, u), linear) in lower.iter_mut().zip(&mut upper).zip(&model.linear) {
            let reach = if *linear { f64::INFINITY } else { reach };
            (*l, *u) = (l.clamp(-reach, 0.0), u.clamp(0.0, reach));
        }
        let mut row_lower = minus(&model.row_lower, &point.constraints);
        let mut row_upper = minus(&model.row_upper, &point.constraints);
        let mut rows = point.jacobian.clone();
        walls.append(&point.z, &mut rows, &mut row_upper);
        row_lower.resize(row_upper.len(), f64::NEG_INFINITY);
        Self { rows, row_lower, row_upper, lower, upper }
    }

    /// Number of constraints, without the walls.
    pub(super) fn constraints(&self) -> usize {
        self.row_lower.len() - walls::COUNT
    }

    pub(super) fn qp<'a>(&'a self, point: &'a Point, hessian: &'a [f64], gradient: &'a [f64], penalty: f64) -> Qp<'a> {
        Qp {
            n: point.z.len(),
            hessian,
            gradient,
            rows: &self.rows,
            row_lower: &self.row_lower,
            row_upper: &self.row_upper,
            lower: &self.lower,
            upper: &self.upper,
            penalty,
            firm_from: self.constraints(),
        }
    }

    /// Sum of the violations of the linearised constraints after a step.
    pub(super) fn excess(&self, step: &[f64]) -> f64 {
        let (n, m) = (step.len(), self.constraints());
        let values: Vec<f64> = (0..m).map(|i| dot(&self.rows[i * n..(i + 1) * n], step)).collect();
        violations(&values, &self.row_lower[..m], &self.row_upper[..m]).sum()
    }
}
