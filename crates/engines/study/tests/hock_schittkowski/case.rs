//! One problem of the set: its data, its formulas over dual numbers, its known answer.

use num_dual::{Dual64, DualNum};

/// A value with its derivative along one variable.
pub(crate) type Number = Dual64;

/// Objective and constraints of a problem at a point.
pub(crate) type Formula = fn(&[Number]) -> (Number, Vec<Number>);

/// Bounds of an inequality constraint as the book writes it, c(x) ≥ 0.
pub(crate) const AT_LEAST_ZERO: (f64, f64) = (0.0, f64::INFINITY);

/// Bounds of an equality constraint, c(x) = 0.
pub(crate) const ZERO: (f64, f64) = (0.0, 0.0);

/// A problem in the numbering of Hock and Schittkowski.
pub(crate) struct Case {
    pub(crate) number: u32,
    pub(crate) start: Vec<f64>,
    pub(crate) lower: Vec<f64>,
    pub(crate) upper: Vec<f64>,
    /// Lower and upper bound of each constraint.
    pub(crate) constraints: Vec<(f64, f64)>,
    pub(crate) optimum: f64,
    pub(crate) minimiser: Vec<f64>,
    formula: Formula,
}

/// Values and first derivatives at a point.
pub(crate) struct Evaluation {
    pub(crate) objective: f64,
    pub(crate) gradient: Vec<f64>,
    pub(crate) constraints: Vec<f64>,
    /// One row per constraint.
    pub(crate) jacobian: Vec<Vec<f64>>,
}

impl Case {
    /// A problem without bounds or constraints; the known answer is still to be set.
    pub(crate) fn new(number: u32, start: &[f64], formula: Formula) -> Self {
        let n = start.len();
        Self {
            number,
            start: start.to_vec(),
            lower: vec![f64::NEG_INFINITY; n],
            upper: vec![f64::INFINITY; n],
            constraints: Vec::new(),
            optimum: f64::NAN,
            minimiser: Vec::new(),
            formula,
        }
    }

    /// Sets the lower bounds of the variables.
    pub(crate) fn lower(mut self, lower: &[f64]) -> Self {
        self.lower = lower.to_vec();
        self
    }

    /// Sets the upper bounds of the variables.
    pub(crate) fn upper(mut self, upper: &[f64]) -> Self {
        self.upper = upper.to_vec();
        self
    }

    /// Sets the bounds of the constraints, in the order in which the formula returns them.
    pub(crate) fn subject_to(mut self, constraints: &[(f64, f64)]) -> Self {
        self.constraints = constraints.to_vec();
        self
    }

    /// Sets the published optimum and minimiser.
    pub(crate) fn solution(mut self, optimum: f64, minimiser: &[f64]) -> Self {
        self.optimum = optimum;
        self.minimiser = minimiser.to_vec();
        self
    }

    /// Objective and constraints, without derivatives.
    pub(crate) fn values(&self, x: &[f64]) -> (f64, Vec<f64>) {
        let point: Vec<Number> = x.iter().map(|&value| constant(value)).collect();
        let (objective, constraints) = (self.formula)(&point);
        (objective.re, constraints.iter().map(|value| value.re).collect())
    }

    /// Values and exact first derivatives: one sweep with a unit tangent per variable.
    pub(crate) fn evaluate(&self, x: &[f64]) -> Evaluation {
        let (objective, constraints) = self.values(x);
        let mut jacobian = vec![vec![0.0; x.len()]; constraints.len()];
        let mut gradient = vec![0.0; x.len()];
        let mut point: Vec<Number> = x.iter().map(|&value| constant(value)).collect();
        for j in 0..x.len() {
            point[j].eps = 1.0;
            let (objective, constraints) = (self.formula)(&point);
            point[j].eps = 0.0;
            gradient[j] = objective.eps;
            for (row, constraint) in jacobian.iter_mut().zip(&constraints) {
                row[j] = constraint.eps;
            }
        }
        Evaluation { objective, gradient, constraints, jacobian }
    }
}

/// The variables by name: `let [x1, x2] = variables(x)`.
pub(crate) fn variables<const N: usize>(x: &[Number]) -> [Number; N] {
    assert_eq!(x.len(), N);
    std::array::from_fn(|i| x[i])
}

/// A number without derivative.
pub(crate) fn constant(value: f64) -> Number {
    Number::from_re(value)
}

pub(crate) fn square(x: Number) -> Number {
    x * x
}

pub(crate) fn cube(x: Number) -> Number {
    x * x * x
}

pub(crate) fn fourth(x: Number) -> Number {
    square(square(x))
}

/// Sum of the squares of the values.
pub(crate) fn sum_of_squares(values: &[Number]) -> Number {
    values.iter().map(|&value| square(value)).sum()
}

/// Product of the values.
pub(crate) fn product(values: &[Number]) -> Number {
    values.iter().copied().product()
}

/// Scalar product of constant coefficients with the variables.
pub(crate) fn dot(coefficients: &[f64], x: &[Number]) -> Number {
    coefficients.iter().zip(x).map(|(&coefficient, &value)| value * coefficient).sum()
}

/// A term of a posynomial: coefficient times the variables to constant powers.
pub(crate) fn monomial(coefficient: f64, exponents: &[f64], x: &[Number]) -> Number {
    exponents.iter().zip(x).map(|(&exponent, value)| value.powf(exponent)).product::<Number>() * coefficient
}
