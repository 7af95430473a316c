//! Derivatives by central differences, for evaluators that have no better ones.

use std::sync::OnceLock;

use crate::evaluator::{Evaluation, Evaluator, Failure, Workspace};

/// Neighbours at which the effect of a variable is looked at, at most.
const LOOKS: usize = 4;
/// By how much a step is changed at once.
const LEAP: f64 = 1e3;
/// How far a step may be from the asked part of a variable's size, as a factor.
const APART: f64 = 1e2;
/// Largest step, over the size of its variable.
const LONGEST: f64 = 0.1;
/// Largest step of a variable that has no size, over the width of its range.
const WIDEST: f64 = 1e-2;

/// Steps for central differences. They come from what each variable does and from the size of its value, never from the values that it may
/// take: a freedom may be as wide as what the language admits.
#[derive(Debug)]
pub struct Steps {
    relative: f64,
    at_nominal: OnceLock<Vec<f64>>,
}

impl Steps {
    /// Steps that change the first output by about `relative` of its size, and each variable by not much more or less: the third root of the
    /// error of the values, so that rounding and curvature cost about the same.
    pub fn new(relative: f64) -> Self {
        Self { relative, at_nominal: OnceLock::new() }
    }

    /// The step of each variable at `x`, SI. Those at the nominal design are found once.
    pub fn at(&self, evaluator: &dyn Evaluator, x: &[f64], workspace: &mut Workspace) -> Vec<f64> {
        let own = self.at_nominal.get_or_init(|| self.found(evaluator, workspace));
        let variables = evaluator.variables().iter();
        let one = |((variable, own), x): ((&crate::evaluator::Variable, &f64), &f64)| {
            let size = variable.nominal.abs();
            if size > 0.0 { own * (x.abs() / size).max(1.0) } else { own.max(self.relative * x.abs()) }
        };
        variables.zip(own).zip(x).map(one).collect()
    }

    /// Fills the Jacobian at `x`, where `out` holds the values; see [`jacobian_with_steps`].
    ///
    /// # Errors
    /// [`Failure`] of a neighbour.
    pub fn jacobian(&self, evaluator: &dyn Evaluator, x: &[f64], out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        let steps = self.at(evaluator, x, workspace);
        jacobian_with_steps(evaluator, x, &steps, out, workspace)
    }

    fn found(&self, evaluator: &dyn Evaluator, workspace: &mut Workspace) -> Vec<f64> {
        let nominal: Vec<f64> = evaluator.variables().iter().map(|v| v.nominal).collect();
        let mut here = Evaluation::default();
        let known = evaluator.evaluate(&nominal, false, &mut here, workspace).is_ok();
        let curve = evaluator.outputs().first().map_or(0..0, |o| o.values.clone());
        let effect = |x: &[f64], workspace: &mut Workspace| -> Option<f64> {
            let mut there = Evaluation::default();
            evaluator.evaluate(x, false, &mut there, workspace).ok()?;
            let (a, b) = (here.values.get(curve.clone())?, there.values.get(curve.clone())?);
            let size = |all: &mut dyn Iterator<Item = f64>| all.map(|v| v * v).sum::<f64>().sqrt();
            Some(size(&mut a.iter().zip(b).map(|(a, b)| b - a)) / size(&mut a.iter().copied()))
        };
        (0..nominal.len()).map(|column| self.one(evaluator, (&nominal, column), known, effect, workspace)).collect()
    }

    /// The step of a variable at the nominal design.
    fn one(
        &self,
        evaluator: &dyn Evaluator,
        (nominal, column): (&[f64], usize),
        known: bool,
        effect: impl Fn(&[f64], &mut Workspace) -> Option<f64>,
        workspace: &mut Workspace,
    ) -> f64 {
        let Some(variable) = evaluator.variables().get(column) else { return 0.0 };
        let (size, width) = (variable.nominal.abs(), variable.upper - variable.lower);
        let (mut step, least, most) = if size > 0.0 {
            (self.relative * size, self.relative / APART * size, (self.relative * APART).min(LONGEST) * size)
        } else {
            // No size of its own: what it does says how large it is.
            let width = if width.is_finite() { width } else { 1.0 };
            (self.relative * width.min(1.0), 0.0, WIDEST * width)
        };
        for _ in 0..LOOKS {
            if !known {
                break;
            }
            let mut x = nominal.to_vec();
            x[column] += if x[column] + step <= variable.upper { step } else { -step };
            let factor = match effect(&x, workspace) {
                // Nothing is seen: too small a step, perhaps.
                Some(seen) if seen <= 0.0 => LEAP,
                Some(seen) if seen.is_finite() => self.relative / seen,
                _ => 1.0 / LEAP,
            };
            let next = (step * factor.clamp(1.0 / LEAP, LEAP)).clamp(least, most);
            let settled = next >= 0.2 * step && next <= 5.0 * step;
            step = next;
            if settled {
                break;
            }
        }
        step
    }
}

/// Fills the Jacobian at `x` by central differences of the values, where `out` holds those at `x`; one-sided where a bound is near. A column
/// is zero where the step is.
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

/// Makes the rows of a Jacobian of so many columns zero that nobody asked for.
pub fn keep(rows: &[bool], columns: usize, jacobian: &mut [f64]) {
    jacobian.chunks_exact_mut(columns.max(1)).zip(rows).filter(|(_, wanted)| !**wanted).for_each(|(row, _)| row.fill(0.0));
}

#[cfg(test)]
mod tests {
    use forcewright_base::maths::exp;

    use super::*;
    use crate::evaluator::{Measure, Output, Variable};

    /// `y = a t³ (1 + s) e^{−b t}`, with rounding as of a solver, for numbers of any size in ranges of any width.
    struct Model {
        variables: Vec<Variable>,
        outputs: Vec<Output>,
    }

    const TRUTH: [f64; 4] = [2e11, 0.85e-3, 3.0, 0.0];
    const POINTS: usize = 20;

    impl Model {
        fn new(half_widths: [f64; 4]) -> Self {
            let variable = |(nominal, half): (f64, f64)| Variable {
                path: "design.x".to_owned(),
                unit: "1",
                nominal,
                lower: nominal - half,
                upper: nominal + half,
            };
            let output = Output { name: "force".to_owned(), unit: "N", values: 0..POINTS };
            Self { variables: TRUTH.into_iter().zip(half_widths).map(variable).collect(), outputs: vec![output] }
        }

        fn value([a, t, b, s]: [f64; 4], i: usize) -> f64 {
            a * t * t * t * (1.0 + s * 1e6 * (i as f64 / 10.0)) * exp(-b * i as f64 / 10.0)
        }
    }

    impl Evaluator for Model {
        fn variables(&self) -> &[Variable] {
            &self.variables
        }
        fn outputs(&self) -> &[Output] {
            &self.outputs
        }
        fn measures(&self) -> &[Measure] {
            &[]
        }
        fn workspace(&self) -> Workspace {
            Workspace::new(())
        }
        fn evaluate(&self, x: &[f64], _: bool, out: &mut Evaluation, _: &mut Workspace) -> Result<(), Failure> {
            if x[1] <= 0.0 {
                return Err(Failure { reason: "no thickness".to_owned() });
            }
            let x = [x[0], x[1], x[2], x[3]];
            out.values = (0..POINTS).map(|i| Self::value(x, i) * (1.0 + 1e-12 * f64::from(u8::from(i.is_multiple_of(2))))).collect();
            out.jacobian.clear();
            Ok(())
        }
        fn measure(&self, _: &[f64], _: &[f64], _: &mut Vec<f64>, _: &mut Workspace) {}
    }

    /// Derivatives do not depend on how far a number may go, not even of one that is 0 and moves the curve by millionths of its unit.
    #[test]
    fn ranges_do_not_matter() {
        for (half_widths, x) in [
            ([1e9, 1e-5, 0.1, 1e-9], TRUTH),
            ([1e30, 1.0, 1e9, 1e9], TRUTH),
            ([1e30, f64::INFINITY, 1e9, f64::INFINITY], TRUTH),
            ([1e30, 1.0, 1e9, 1e9], [3.1e11, 2.4e-3, 0.7, 3e-7]),
        ] {
            let model = Model::new(half_widths);
            let (mut out, mut workspace) = (Evaluation::default(), model.workspace());
            model.evaluate(&x, false, &mut out, &mut workspace).unwrap();
            Steps::new(1e-5).jacobian(&model, &x, &mut out, &mut workspace).unwrap();
            let [a, t, b, s] = x;
            for i in 0..POINTS {
                let (y, u) = (out.values[i], i as f64 / 10.0);
                let exact = [y / a, 3.0 * y / t, -u * y, a * t * t * t * 1e6 * u * exp(-b * u)];
                for (k, exact) in exact.into_iter().enumerate() {
                    let found = out.jacobian[4 * i + k];
                    assert!(
                        (found - exact).abs() <= 1e-6 * exact.abs().max(y / x[k].max(1e-6)),
                        "{half_widths:?} {s} {i} {k}: {found} {exact}"
                    );
                }
            }
        }
    }

    #[test]
    fn rows_that_nobody_asked_for_are_zero() {
        let mut jacobian = vec![1.0, 2.0, 3.0, 4.0];
        keep(&[false, true], 2, &mut jacobian);
        assert!(jacobian[..2].iter().all(|v| v.abs() <= 0.0) && jacobian[2..].iter().all(|v| *v > 2.0));
    }
}
