//! Problems with known answers, and the means to state them.

mod classic;
mod degenerate;
mod minimax;
mod programmes;

use num_dual::Dual64;

use super::{Problem, Rejected, Settings, Solution, Values, minimise};

/// Objective and constraints as functions of dual numbers, so that derivatives are exact; `None` rejects the point.
type Functions = Box<dyn Fn(&[Dual64]) -> Option<(Dual64, Vec<Dual64>)>>;

/// A problem of the tests.
pub(super) struct Given {
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
    pub(super) row_lower: Vec<f64>,
    pub(super) row_upper: Vec<f64>,
    pub(super) functions: Functions,
}

impl Given {
    /// Constraints `c ≥ 0`, variables without bounds.
    pub(super) fn new(variables: usize, constraints: usize, functions: impl Fn(&[Dual64]) -> (Dual64, Vec<Dual64>) + 'static) -> Self {
        Self {
            lower: vec![f64::NEG_INFINITY; variables],
            upper: vec![f64::INFINITY; variables],
            row_lower: vec![0.0; constraints],
            row_upper: vec![f64::INFINITY; constraints],
            functions: Box::new(move |x| Some(functions(x))),
        }
    }

    pub(super) fn within(mut self, lower: &[f64], upper: &[f64]) -> Self {
        (self.lower, self.upper) = (lower.to_vec(), upper.to_vec());
        self
    }

    pub(super) fn rows(mut self, lower: &[f64], upper: &[f64]) -> Self {
        (self.row_lower, self.row_upper) = (lower.to_vec(), upper.to_vec());
        self
    }

    pub(super) fn solve(&mut self, start: &[f64]) -> Solution {
        self.solve_with(start, &Settings::default())
    }

    pub(super) fn solve_with(&mut self, start: &[f64], settings: &Settings) -> Solution {
        minimise(self, start, settings, &mut |_| true)
    }
}

impl Problem for Given {
    fn lower(&self) -> &[f64] {
        &self.lower
    }
    fn upper(&self) -> &[f64] {
        &self.upper
    }
    fn constraint_lower(&self) -> &[f64] {
        &self.row_lower
    }
    fn constraint_upper(&self) -> &[f64] {
        &self.row_upper
    }
    fn evaluate(&mut self, x: &[f64], gradients: bool, out: &mut Values) -> Result<(), Rejected> {
        for (v, (l, u)) in x.iter().zip(self.lower.iter().zip(&self.upper)) {
            assert!(l <= v && v <= u, "asked outside of the bounds: {v} not in [{l}, {u}]");
        }
        let n = x.len();
        let mut duals: Vec<Dual64> = x.iter().map(|&v| Dual64::from(v)).collect();
        for j in 0..if gradients { n } else { 1.min(n) } {
            duals[j].eps = 1.0;
            let (f, c) = (self.functions)(&duals).ok_or(Rejected)?;
            duals[j].eps = 0.0;
            out.objective = f.re;
            out.gradient[j] = f.eps;
            for (i, c) in c.iter().enumerate() {
                out.constraints[i] = c.re;
                out.jacobian[i * n + j] = c.eps;
            }
        }
        Ok(())
    }
}

pub(super) fn close(got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance, "{got} is not {want} within {tolerance}");
}
