#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts and places in small samples")]

use std::f64::consts::PI;

use forcewright_base::maths::{powi, sin};

use super::*;
use crate::sampling::{Correlation, Distribution, Population};

fn singles(n: usize) -> Vec<Vec<usize>> {
    (0..n).map(|i| vec![i]).collect()
}

fn indices_of(plan: &SensitivityPlan, points: u64, model: impl Fn(&mut [f64]) -> f64) -> SobolIndices {
    let mut tally = SensitivityTally::new(plan, 1);
    let mut x = vec![0.0; plan.parameters * plan.rows(points) as usize];
    plan.fill(0, &mut x);
    let y: Vec<f64> = x.chunks_exact_mut(plan.parameters).map(model).collect();
    y.chunks_exact(plan.rows_per_base()).for_each(|rows| tally.record(rows));
    tally.indices(0, Confidence::P95).unwrap()
}

fn assert_near(name: &str, got: &[Estimate], want: &[f64], slack: f64) {
    for (i, (got, want)) in got.iter().zip(want).enumerate() {
        let half = got.interval.high - got.value;
        assert!((got.value - want).abs() < slack, "{name} {i}: {got:?} {want}");
        // Of a 95 % interval the fourfold is never missed in practice.
        assert!((got.value - want).abs() <= 4.0 * half + 1e-9 && half < 3.0 * slack, "{name} {i}: {got:?} {want}");
    }
}

/// T. Ishigami, T. Homma 1990, `sin x₁ + a sin² x₂ + b x₃⁴ sin x₁` on (−π, π)³; closed forms as in Saltelli et al., "Global
/// Sensitivity Analysis", 2008: `S` = (0.3139, 0.4424, 0), `S_T` = (0.5576, 0.4424, 0.2437) for a = 7, b = 0.1.
#[test]
fn the_function_of_ishigami() {
    let (a, b) = (7.0, 0.1);
    let v1 = 0.5 * (1.0 + b * powi(PI, 4) / 5.0) * (1.0 + b * powi(PI, 4) / 5.0);
    let (v2, v13) = (a * a / 8.0, b * b * powi(PI, 8) * (1.0 / 18.0 - 1.0 / 50.0));
    let v = v1 + v2 + v13;
    let want_first = [v1 / v, v2 / v, 0.0];
    let want_total = [(v1 + v13) / v, v2 / v, v13 / v];
    for (got, published) in want_first.iter().chain(&want_total).zip([0.3139, 0.4424, 0.0, 0.5576, 0.4424, 0.2437]) {
        assert!((got - published).abs() < 6e-5, "{got} {published}");
    }
    let plan = SensitivityPlan::new(3, singles(3), 16, 1).unwrap();
    let found = indices_of(&plan, 4096, |u| {
        let x = [0, 1, 2].map(|i| PI * (2.0 * u[i] - 1.0));
        sin(x[0]) + a * sin(x[1]) * sin(x[1]) + b * powi(x[2], 4) * sin(x[0])
    });
    assert_near("first", &found.first, &want_first, 2e-3);
    assert_near("total", &found.total, &want_total, 1e-3);
    assert_near("mean", &[found.mean], &[0.5 * a], 2e-3);
    assert_near("variance", &[found.variance], &[v], 0.02);
}

/// Sobol's g-function `∏ (|4xᵢ − 2| + aᵢ) / (1 + aᵢ)`: `V_i = 1/(3 (1 + a_i)²)`, `V = ∏ (1 + V_i) − 1`,
/// `V_Ti = V_i ∏_{j≠i} (1 + V_j)` (Saltelli et al. 2010).
#[test]
fn the_g_function() {
    let a = [0.0, 0.5, 3.0, 9.0, 99.0, 99.0];
    let v = a.map(|a| 1.0 / (3.0 * (1.0 + a) * (1.0 + a)));
    let all: f64 = v.iter().map(|v| 1.0 + v).product();
    let plan = SensitivityPlan::new(6, singles(6), 16, 5).unwrap();
    let model = |u: &mut [f64]| u.iter().zip(a).map(|(u, a)| ((4.0 * u - 2.0).abs() + a) / (1.0 + a)).product();
    let found = indices_of(&plan, 4096, model);
    assert_near("first", &found.first, &v.map(|v| v / (all - 1.0)), 3e-3);
    assert_near("total", &found.total, &v.map(|v| v * all / (1.0 + v) / (all - 1.0)), 3e-3);
}

/// A large constant must not cost digits: of `10⁹ + y` the indices are those of `y`.
#[test]
fn a_large_mean_costs_no_digits() {
    let plan = SensitivityPlan::new(2, singles(2), 8, 2).unwrap();
    let model = |offset: f64| move |u: &mut [f64]| offset + u[0] + 3.0 * u[1];
    let (near, far) = (indices_of(&plan, 128, model(0.0)), indices_of(&plan, 128, model(1e9)));
    for (a, b) in near.first.iter().chain(&near.total).zip(far.first.iter().chain(&far.total)) {
        assert!((a.value - b.value).abs() < 1e-6, "{a:?} {b:?}");
    }
    assert!((far.mean.value - 1e9 - 2.0).abs() < 1e-3);
}

/// `y = x₀ + x₁ + x₂` of standard normals with ρ between the first and the last: the pair has `(2 + 2ρ)/(3 + 2ρ)` of the variance.
#[test]
fn a_correlated_pair_is_one_factor() {
    let rho = 0.8;
    let normal = Distribution::normal(0.0, 1.0).unwrap();
    let population = Population::independent(vec![normal; 3]).correlate(&[0, 2], Correlation::common(2, rho).unwrap()).unwrap();
    let plan = SensitivityPlan::new(3, population.factors(), 8, 3).unwrap();
    assert_eq!(plan.factors(), [vec![0, 2], vec![1]]);
    let found = indices_of(&plan, 1024, |u| {
        population.draw(u);
        u.iter().sum()
    });
    let pair = (2.0 + 2.0 * rho) / (3.0 + 2.0 * rho);
    assert_near("first", &found.first, &[pair, 1.0 - pair], 2e-3);
    assert_near("total", &found.total, &[pair, 1.0 - pair], 2e-3);
}

#[test]
fn rows_can_be_made_in_any_order() {
    let plan = SensitivityPlan::new(3, vec![vec![1], vec![0, 2]], 4, 8).unwrap();
    let mut all = vec![0.0; 3 * plan.rows(4) as usize];
    plan.fill(0, &mut all);
    let mut tail = vec![0.0; 3 * 7];
    plan.fill(13, &mut tail);
    assert_eq!(all[39..60], tail);
    // A, B, A with the second from B, A with the first and third from B.
    let (a, b) = (&all[..3], &all[3..6]);
    assert_eq!(all[6..9], [a[0], b[1], a[2]]);
    assert_eq!(all[9..12], [b[0], a[1], b[2]]);
}

#[test]
fn what_cannot_be_said_is_not_said() {
    let not_once = |factors| SensitivityPlan::new(2, factors, 8, 0).unwrap_err();
    assert_eq!(not_once(vec![vec![0]]), SensitivityError::NotOnce { parameter: 1 });
    assert_eq!(not_once(vec![vec![0], vec![0, 1]]), SensitivityError::NotOnce { parameter: 0 });
    assert_eq!(not_once(vec![vec![0], vec![1, 2]]), SensitivityError::NotOnce { parameter: 2 });
    assert!(matches!(SensitivityPlan::new(129, singles(129), 8, 0), Err(SensitivityError::Sobol(_))));
    let plan = SensitivityPlan::new(1, singles(1), 2, 0).unwrap();
    let mut tally = SensitivityTally::new(&plan, 2);
    assert!(tally.indices(0, Confidence::P95).is_none() && tally.indices(7, Confidence::P95).is_none());
    // Outputs: one constant, one varying with one base point that failed.
    for rows in [[1.0, 0.0, 1.0, 1.0, 1.0, 0.5], [1.0, 2.0, 1.0, 3.0, 1.0, 2.5], [1.0, f64::NAN, 1.0, 1.0, 1.0, 0.5]] {
        tally.record(&rows);
    }
    tally.record(&[]);
    assert!(tally.indices(0, Confidence::P95).is_none());
    assert_eq!(tally.indices(1, Confidence::P95).unwrap().skipped, 2);
}
