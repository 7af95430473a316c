//! Are the problems written down rightly? Judged without a solver: at the published minimisers and by difference quotients.

use super::case::{Case, Evaluation};
use super::cases;

/// The printed digits of the book and of Schittkowski's programs reproduce their optima to this share.
const OPTIMUM_SHARE: f64 = 2e-8;

/// First-order conditions cannot hold at the minimiser of problem 13: its constraint gradients are parallel, the objective's is not.
const WITHOUT_MULTIPLIERS: [u32; 1] = [13];

#[test]
fn definitions_match_the_published_optima() {
    let mut wrong = Vec::new();
    for case in cases() {
        let at = case.evaluate(&case.minimiser);
        let error = (at.objective - case.optimum).abs() / (1.0 + case.optimum.abs());
        let violation = scaled_violation(&case, &at);
        let residual = stationarity_residual(&case, &at);
        let stationary = residual <= 1e-3 || WITHOUT_MULTIPLIERS.contains(&case.number);
        if !(error <= OPTIMUM_SHARE && violation <= 1e-5 && stationary) {
            wrong.push(format!(
                "HS{}: f {} for {}, violation {violation:.1e}, residual {residual:.1e}",
                case.number, at.objective, case.optimum
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn gradients_are_the_limits_of_difference_quotients() {
    for case in cases() {
        let start: Vec<f64> =
            case.start.iter().zip(case.lower.iter().zip(&case.upper)).map(|(x, (&lower, &upper))| x.clamp(lower, upper)).collect();
        let at = case.evaluate(&start);
        for j in 0..start.len() {
            let step = 1e-5 * start[j].abs().max(1e-2);
            let shifted = |sign: f64| {
                let mut x = start.clone();
                x[j] += sign * step;
                case.values(&x)
            };
            let (ahead, behind) = (shifted(1.0), shifted(-1.0));
            let check = |exact: f64, ahead: f64, behind: f64, what: &str| {
                let quotient = (ahead - behind) / (2.0 * step);
                let scale = exact.abs().max(1e-6 * (1.0 + ahead.abs()) / step.min(1.0));
                assert!((quotient - exact).abs() <= 1e-4 * scale, "HS{} {what} x{}: {exact} for {quotient}", case.number, j + 1);
            };
            check(at.gradient[j], ahead.0, behind.0, "objective");
            for (row, (ahead, behind)) in at.jacobian.iter().zip(ahead.1.iter().zip(&behind.1)) {
                check(row[j], *ahead, *behind, "constraint");
            }
        }
    }
}

#[test]
fn every_problem_is_complete() {
    let cases = cases();
    assert!(cases.len() >= 90);
    assert!(cases.windows(2).all(|pair| pair[0].number < pair[1].number));
    for case in cases {
        let n = case.start.len();
        assert!([case.lower.len(), case.upper.len(), case.minimiser.len()] == [n; 3], "HS{}", case.number);
        assert_eq!(case.values(&case.start).1.len(), case.constraints.len(), "HS{}", case.number);
    }
}

/// Largest violation of a bound or constraint, measured in relative changes of the variables where the constraint is steep.
fn scaled_violation(case: &Case, at: &Evaluation) -> f64 {
    let steepness = at.jacobian.iter().map(|row| largest(&weigh(case, row)).max(1.0));
    let outside = |value: f64, (lower, upper): (f64, f64)| (lower - value).max(value - upper);
    let of_constraints = at.constraints.iter().zip(&case.constraints).map(|(&value, &bounds)| outside(value, bounds));
    let of_bounds = case.minimiser.iter().zip(case.lower.iter().zip(&case.upper)).map(|(&x, (&lower, &upper))| outside(x, (lower, upper)));
    of_constraints.zip(steepness).map(|(violation, steepness)| violation / steepness).chain(of_bounds).fold(0.0, f64::max)
}

/// What is left of the objective's gradient after the best combination of active constraint gradients with admissible signs, as a
/// share of the gradient.
fn stationarity_residual(case: &Case, at: &Evaluation) -> f64 {
    let mut columns = Vec::new();
    let mut add = |value: f64, (lower, upper): (f64, f64), row: Vec<f64>| {
        let size = largest(&row);
        let near = |bound: f64| (value - bound).abs() <= 1e-4 * size.max(1e-3);
        if near(lower) {
            columns.push(row.iter().map(|entry| entry / size).collect());
        }
        if near(upper) {
            columns.push(row.iter().map(|entry| -entry / size).collect());
        }
    };
    for (row, (&value, &bounds)) in at.jacobian.iter().zip(at.constraints.iter().zip(&case.constraints)) {
        add(value, bounds, weigh(case, row));
    }
    for (j, &value) in case.minimiser.iter().enumerate() {
        let mut row = vec![0.0; case.minimiser.len()];
        row[j] = 1.0;
        add(value, (case.lower[j], case.upper[j]), weigh(case, &row));
    }
    let gradient = weigh(case, &at.gradient);
    let at_start = weigh(case, &case.evaluate(&case.start).gradient);
    let size = largest(&gradient).max(1e-2 * largest(&at_start));
    largest(&residual_of_non_negative_fit(&columns, &gradient)) / size.max(1e-9)
}

/// A gradient with its components weighed by the size of their variables.
fn weigh(case: &Case, gradient: &[f64]) -> Vec<f64> {
    gradient.iter().zip(&case.minimiser).map(|(entry, x)| entry * x.abs().max(1.0)).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| value.abs().max(largest))
}

fn scalar_product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// target − Σ λᵢ columnᵢ for the λ ≥ 0 that make it shortest: Lawson and Hanson, "Solving Least Squares Problems", algorithm NNLS.
fn residual_of_non_negative_fit(columns: &[Vec<f64>], target: &[f64]) -> Vec<f64> {
    let mut multipliers = vec![0.0; columns.len()];
    let mut passive: Vec<usize> = Vec::new();
    loop {
        let mut residual = target.to_vec();
        for (column, multiplier) in columns.iter().zip(&multipliers) {
            for (entry, column) in residual.iter_mut().zip(column) {
                *entry -= multiplier * column;
            }
        }
        let descent = |i: usize| scalar_product(&columns[i], &residual);
        let entering = (0..columns.len()).filter(|i| !passive.contains(i)).max_by(|&i, &j| descent(i).total_cmp(&descent(j)));
        let Some(entering) = entering.filter(|&i| descent(i) > 1e-10 * largest(target)) else {
            return residual;
        };
        passive.push(entering);
        loop {
            let chosen: Vec<&[f64]> = passive.iter().map(|&i| columns[i].as_slice()).collect();
            let wanted = least_squares(&chosen, target);
            let pairs = passive.iter().copied().zip(wanted);
            let limit = |(i, wanted): (usize, f64)| if wanted > 0.0 { 1.0 } else { multipliers[i] / (multipliers[i] - wanted) };
            let share = pairs.clone().map(limit).fold(1.0, f64::min);
            for (i, wanted) in pairs {
                multipliers[i] += share * (wanted - multipliers[i]);
            }
            if share >= 1.0 {
                break;
            }
            passive.retain(|&i| multipliers[i] > 1e-14 * largest(target));
            (0..columns.len()).filter(|i| !passive.contains(i)).for_each(|i| multipliers[i] = 0.0);
        }
    }
}

/// Coefficients of the combination of independent columns nearest to the target, by modified Gram-Schmidt.
fn least_squares(columns: &[&[f64]], target: &[f64]) -> Vec<f64> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut triangle: Vec<Vec<f64>> = Vec::new();
    for column in columns {
        let mut rest = column.to_vec();
        let mut entries = Vec::new();
        for direction in &basis {
            let share = scalar_product(direction, &rest);
            rest.iter_mut().zip(direction).for_each(|(entry, direction)| *entry -= share * direction);
            entries.push(share);
        }
        let length = scalar_product(&rest, &rest).sqrt();
        entries.push(length);
        basis.push(rest.iter().map(|entry| entry / length).collect());
        triangle.push(entries);
    }
    let mut coefficients: Vec<f64> = basis.iter().map(|direction| scalar_product(direction, target)).collect();
    for j in (0..columns.len()).rev() {
        coefficients[j] /= triangle[j][j];
        for i in 0..j {
            coefficients[i] -= triangle[j][i] * coefficients[j];
        }
    }
    coefficients
}
