//! The two ways to a quadratic programme, active sets and interior points, are independent: they must agree, and satisfy the conditions.

use super::super::active::{Guess, Side};
use super::super::dual::Dual;
use super::super::hessian::dot;
use super::super::interior;
use super::super::outcome::Counters;
use super::super::qp::{Answer, Outcome, Qp, QpSolver};

/// Numbers in [−1, 1): the 64-bit linear congruential generator of D. E. Knuth's MMIX, "The Art of Computer Programming", vol. 2, 3.3.4.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Data of a random programme; `B·Bᵀ + I` is positive definite. With `tight`, rows contradict each other.
struct Data {
    n: usize,
    hessian: Vec<f64>,
    gradient: Vec<f64>,
    rows: Vec<f64>,
    row_lower: Vec<f64>,
    row_upper: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl Data {
    fn random(n: usize, m: usize, tight: bool, seed: u64) -> Self {
        let mut r = Numbers(seed);
        let b: Vec<f64> = (0..n * n).map(|_| r.next()).collect();
        let entry = |i: usize, j: usize| dot(&b[i * n..(i + 1) * n], &b[j * n..(j + 1) * n]) + f64::from(u8::from(i == j));
        let hessian = (0..n * n).map(|k| entry(k / n, k % n)).collect();
        let gradient = (0..n).map(|_| 8.0 * r.next()).collect();
        let rows = (0..n * m).map(|_| r.next()).collect();
        let shift = if tight { -0.6 } else { 0.0 };
        let row_lower: Vec<f64> = (0..m).map(|_| -0.5 - shift + 0.4 * r.next()).collect();
        let row_upper = row_lower.iter().map(|l| l + 1.0).collect();
        Self { n, hessian, gradient, rows, row_lower, row_upper, lower: vec![-0.4; n], upper: vec![0.3; n] }
    }

    fn qp(&self, penalty: f64) -> Qp<'_> {
        Qp {
            n: self.n,
            hessian: &self.hessian,
            gradient: &self.gradient,
            rows: &self.rows,
            row_lower: &self.row_lower,
            row_upper: &self.row_upper,
            lower: &self.lower,
            upper: &self.upper,
            penalty,
            firm_from: self.row_lower.len(),
        }
    }
}

fn value(qp: &Qp<'_>, d: &[f64]) -> f64 {
    let curved: f64 = (0..qp.n).map(|j| d[j] * dot(&qp.hessian[j * qp.n..(j + 1) * qp.n], d)).sum();
    let excess: f64 =
        (0..qp.row_lower.len()).map(|i| (qp.row_lower[i] - dot(qp.row(i), d)).max(dot(qp.row(i), d) - qp.row_upper[i]).max(0.0)).sum();
    0.5 * curved + dot(qp.gradient, d) + if qp.penalty.is_finite() { qp.penalty * excess } else { 0.0 }
}

fn assert_near(a: &Answer, b: &Answer, tolerance: f64) {
    for (a, b) in [(&a.step, &b.step), (&a.rows, &b.rows), (&a.bounds, &b.bounds)] {
        for (x, y) in a.iter().zip(b) {
            assert!((x - y).abs() < tolerance, "{x} {y}");
        }
    }
}

#[test]
fn active_sets_and_interior_points_agree() {
    for seed in 0..20 {
        let data = Data::random(8, 40, false, seed);
        let qp = data.qp(f64::INFINITY);
        let (mut solver, mut counters) = (QpSolver::default(), Counters::default());
        assert_eq!(solver.solve(&qp, &mut counters), Outcome::Solved);
        let other = interior::solve(&qp, &Guess::default()).unwrap();
        assert_near(&solver.answer, &other, 1e-6);
        assert!(value(&qp, &solver.answer.step) <= value(&qp, &other.step) + 1e-8);
    }
}

#[test]
fn elastic_programmes_agree_and_prices_are_respected() {
    for seed in 0..20 {
        let data = Data::random(6, 24, true, seed);
        assert_eq!(interior::solve(&data.qp(f64::INFINITY), &Guess::default()).unwrap_err(), Outcome::Infeasible);
        for price in [0.5, 10.0] {
            let qp = data.qp(price);
            let (mut solver, mut counters) = (QpSolver::default(), Counters::default());
            assert_eq!(solver.solve(&qp, &mut counters), Outcome::Solved);
            let other = interior::solve(&qp, &Guess::default()).unwrap();
            assert_near(&solver.answer, &other, 1e-5);
            assert!(solver.answer.rows.iter().all(|y| y.abs() <= price * (1.0 + 1e-12)));
            assert!((value(&qp, &solver.answer.step) - value(&qp, &other.step)).abs() < 1e-7);
        }
    }
}

/// The interior-point answer becomes exact: stationarity to rounding.
#[test]
fn a_remembered_set_needs_no_interior_points() {
    let data = Data::random(14, 100, false, 3);
    let qp = data.qp(f64::INFINITY);
    let (mut solver, mut counters) = (QpSolver::default(), Counters::default());
    solver.solve(&qp, &mut counters);
    let first = solver.answer.clone();
    let interior_before = counters.interior_qps;
    solver.solve(&qp, &mut counters);
    assert_eq!((counters.qps, counters.interior_qps), (2, interior_before));
    assert_near(&solver.answer, &first, 1e-12);
    for j in 0..14 {
        let forces: f64 = (0..100).map(|i| first.rows[i] * qp.row(i)[j]).sum();
        let left = qp.gradient[j] + dot(&qp.hessian[j * 14..(j + 1) * 14], &first.step) - forces - first.bounds[j];
        assert!(left.abs() < 1e-12, "{left}");
    }
}

/// With two equations, firm and at a price that some rows are not worth.
#[test]
fn the_dual_method_finds_what_interior_points_find() {
    for seed in 0..40 {
        let mut data = Data::random(9, 40, seed % 2 == 1, seed);
        data.row_upper[..2].copy_from_slice(&data.row_lower[..2]);
        for penalty in [f64::INFINITY, 10.0, 0.5] {
            let qp = data.qp(penalty);
            let (mut dual, mut guess, mut found) = (Dual::default(), Guess::default(), Answer::default());
            let outcome = dual.solve(&qp).unwrap();
            match interior::solve(&qp, &Guess::default()) {
                Ok(other) => {
                    assert_eq!(outcome, Outcome::Solved);
                    dual.read(&mut guess, &mut found);
                    assert_near(&found, &other, 1e-5);
                    let exceeded = guess.rows.iter().any(|side| matches!(side, Side::Below | Side::Above));
                    assert_eq!(exceeded, found.rows.iter().any(|y| y.abs() >= penalty));
                }
                Err(other) => assert_eq!(outcome, other),
            }
        }
    }
}

/// min ½d² − 3d with d ≤ 1: at the price γ the multiplier, 3 − d, reaches γ where d = 3 − γ, unless that is below 1.
#[test]
fn a_row_is_exceeded_where_it_is_not_worth_its_price() {
    for (penalty, step, multiplier) in [(0.5, 2.5, -0.5), (2.5, 1.0, -2.0), (f64::INFINITY, 1.0, -2.0)] {
        let qp = Qp {
            n: 1,
            hessian: &[1.0],
            gradient: &[-3.0],
            rows: &[1.0],
            row_lower: &[f64::NEG_INFINITY],
            row_upper: &[1.0],
            lower: &[-10.0],
            upper: &[10.0],
            penalty,
            firm_from: 1,
        };
        let (mut dual, mut guess, mut found) = (Dual::default(), Guess::default(), Answer::default());
        assert_eq!(dual.solve(&qp), Some(Outcome::Solved));
        dual.read(&mut guess, &mut found);
        assert!((found.step[0] - step).abs() < 1e-15 && (found.rows[0] - multiplier).abs() < 1e-15, "{found:?}");
    }
}
