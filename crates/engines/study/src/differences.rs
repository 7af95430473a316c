//! Derivatives by central differences, for evaluators that have no better ones.

use crate::evaluator::{Evaluation, Evaluator, Failure, Workspace};

/// Step relative to the scale of a variable: with an error of 1e-5 in the values, derivatives are right to about 1e-3 of what the whole
/// scale changes.
const STEP: f64 = 1e-2;

/// Fills the Jacobian at `x` by central differences of the values; one-sided where a bound is near.
///
/// # Errors
/// [`Failure`] of a neighbour.
pub fn jacobian(evaluator: &dyn Evaluator, x: &[f64], out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
    let steps: Vec<f64> = evaluator.variables().iter().map(|v| STEP * v.scale()).collect();
    jacobian_with_steps(evaluator, x, &steps, out, workspace)
}

/// The same with a step for each variable; a column is zero where the step is.
///
/// # Errors
/// [`Failure`] of a neighbour.
pub fn jacobian_with_steps(
    evaluator: &dyn Evaluator,
    x: &[f64],
    steps: &[f64],
    out: &mut Evaluation,
    workspace: &mut Workspace,
) -> Result<(), Failure> {
    let variables = evaluator.variables();
    let (columns, rows) = (variables.len(), out.values.len());
    out.jacobian.clear();
    out.jacobian.resize(rows * columns, 0.0);
    let mut neighbour = Evaluation::default();
    for (column, (variable, step)) in variables.iter().zip(steps).enumerate() {
        let ends = [(x[column] - step).max(variable.lower), (x[column] + step).min(variable.upper)];
        let span = ends[1] - ends[0];
        if span <= 0.0 || span.is_nan() {
            continue;
        }
        for (end, sign) in ends.into_iter().zip([-1.0, 1.0]) {
            let mut moved = x.to_vec();
            moved[column] = end;
            evaluator.evaluate(&moved, false, &mut neighbour, workspace)?;
            for (row, value) in neighbour.values.iter().enumerate() {
                out.jacobian[row * columns + column] += sign * value / span;
            }
        }
    }
    Ok(())
}
