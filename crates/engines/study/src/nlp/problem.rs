//! What the optimiser asks of its caller.

/// Minimise `f(x)` subject to `cl ≤ c(x) ≤ cu` and `xl ≤ x ≤ xu`, with exact first derivatives.
///
/// Units are the caller's: the optimiser scales variables, constraints and objective by itself, so metres beside pascals do no harm.
/// `f` and `c` should be continuously differentiable near the path of the iterates; second derivatives are never asked for.
pub trait Problem {
    /// Lower bounds of the variables; `-inf` for none. Their number is the number of variables. Equal to the upper bound: the variable
    /// is fixed.
    fn lower(&self) -> &[f64];

    /// Upper bounds of the variables; `inf` for none.
    fn upper(&self) -> &[f64];

    /// Lower bounds of the constraints; `-inf` for none. Their number is the number of constraints. Equal to the upper bound: an
    /// equality.
    fn constraint_lower(&self) -> &[f64];

    /// Upper bounds of the constraints; `inf` for none.
    fn constraint_upper(&self) -> &[f64];

    /// Whether the derivatives by this variable are constants, whatever the values of all. Then its part of a step is believed at any
    /// length. A bound on largest values is such a variable: held back, it would hold back those that raise the values.
    fn is_linear(&self, _variable: usize) -> bool {
        false
    }

    /// Values at `x`, which is always inside the bounds, and derivatives too where `gradients` is true.
    ///
    /// A call with `gradients` follows a call without at the same point, except for the start and, where variables are fixed, the end;
    /// so an expensive analysis can be kept from one to the other.
    ///
    /// # Errors
    /// [`Rejected`] where the point cannot be evaluated. Numbers that are not finite count as a rejection too. The optimiser shortens
    /// its step; at the start it gives up.
    fn evaluate(&mut self, x: &[f64], gradients: bool, out: &mut Values) -> Result<(), Rejected>;
}

/// Values and derivatives at a point, in buffers that come with the right lengths.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Values {
    /// Objective `f`.
    pub objective: f64,
    /// `∂f/∂x`, one entry per variable.
    pub gradient: Vec<f64>,
    /// Constraint functions `c`.
    pub constraints: Vec<f64>,
    /// `∂c/∂x`: a row per constraint, row-major.
    pub jacobian: Vec<f64>,
}

impl Values {
    /// Zeros for a number of variables and of constraints.
    pub fn zeros(variables: usize, constraints: usize) -> Self {
        Self {
            objective: 0.0,
            gradient: vec![0.0; variables],
            constraints: vec![0.0; constraints],
            jacobian: vec![0.0; variables * constraints],
        }
    }

    /// Whether the buffers have the lengths asked for and every number that was asked for is finite.
    pub(super) fn sound(&self, variables: usize, constraints: usize, gradients: bool) -> bool {
        let finite = |v: &[f64]| v.iter().all(|x| x.is_finite());
        self.constraints.len() == constraints
            && self.objective.is_finite()
            && finite(&self.constraints)
            && (!gradients
                || self.gradient.len() == variables
                    && self.jacobian.len() == variables * constraints
                    && finite(&self.gradient)
                    && finite(&self.jacobian))
    }
}

/// The point cannot be evaluated: an analysis failed there, or a function is not defined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rejected;
