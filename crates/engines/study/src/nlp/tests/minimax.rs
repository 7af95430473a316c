//! Minimax problems as epigraphs: least `t` with `−t ≤ eᵢ(x) ≤ t`. At a vertex one more constraint is active than there are
//! parameters, and nothing is curved in `t`.
//!
//! Published values: L. Lukšan and J. Vlček, "Test problems for nonsmooth unconstrained and linearly constrained optimization",
//! Technical report 798, Institute of Computer Science, Academy of Sciences of the Czech Republic, 2000.

use forcewright_base::maths;
use num_dual::{Dual64, DualNum};

use super::super::{Settings, Solution, Stop};
use super::{Given, close};

/// Variables `(x, t)`; rows `e − t ≤ 0` and `e + t ≥ 0`.
pub(in super::super) fn epigraph(parameters: usize, errors: usize, error: impl Fn(usize, &[Dual64]) -> Dual64 + 'static) -> Given {
    let infinite = f64::INFINITY;
    Given::new(parameters + 1, 2 * errors, move |v| {
        let (x, t) = v.split_at(parameters);
        let e: Vec<Dual64> = (0..errors).map(|i| error(i, x)).collect();
        (t[0], e.iter().map(|e| *e - t[0]).chain(e.iter().map(|e| *e + t[0])).collect())
    })
    .rows(&[vec![-infinite; errors], vec![0.0; errors]].concat(), &[vec![0.0; errors], vec![infinite; errors]].concat())
}

fn polynomial(x: &[Dual64], at: f64) -> Dual64 {
    x.iter().rev().fold(Dual64::from(0.0), |sum, c| sum * at + *c)
}

/// A grid of [−1, 1] with the extrema of the Chebyshev polynomial of a degree and points between.
fn grid(degree: usize, between: usize) -> Vec<f64> {
    let count = degree * between;
    (0..=count).map(|k| maths::cos(std::f64::consts::PI * k as f64 / count as f64)).collect()
}

fn solved(mut problem: Given, start: &[f64]) -> Solution {
    let solution = problem.solve(start);
    assert_eq!(solution.stop, Stop::Converged);
    assert!(solution.violation < 1e-8);
    solution
}

/// xⁿ is approximated best by xⁿ − 2¹⁻ⁿ·Tₙ(x), with the error 2¹⁻ⁿ (P. L. Chebyshev 1854).
#[test]
fn powers_by_lower_powers() {
    for (degree, power) in [(3, 3), (6, 6), (8, 8)] {
        let points = grid(degree, 8);
        let count = points.len();
        let problem = epigraph(degree, count, move |i, x| -polynomial(x, points[i]) + maths::powi(points[i], power));
        let mut start = vec![0.0; degree];
        start.push(1.0);
        let solution = solved(problem, &start);
        close(solution.objective, 2.0 * maths::powi(0.5, power), 1e-12);
        if degree == 3 {
            // x³ − T₃/4 = ¾·x
            for (got, want) in solution.x.iter().zip([0.0, 0.75, 0.0]) {
                close(*got, want, 1e-11);
            }
        }
        // The multipliers of an epigraph sum to 1, lower ones positive and upper ones negative.
        let sum: f64 = solution.multipliers.iter().map(|y| y.abs()).sum();
        close(sum, 1.0, 1e-10);
    }
}

/// |x| by a parabola: x² + 1/8, error 1/8 at −1, −1/2, 0, 1/2, 1.
#[test]
fn modulus_by_a_parabola() {
    let points: Vec<f64> = (-20..=20).map(|k| f64::from(k) / 20.0).collect();
    let solution = solved(epigraph(3, 41, move |i, x| polynomial(x, points[i]) - points[i].abs()), &[0.0, 0.0, 0.0, 1.0]);
    for (got, want) in solution.x.iter().zip([0.125, 0.0, 1.0, 0.125]) {
        close(*got, want, 1e-11);
    }
}

/// eˣ on [0, 1] by a line: slope e − 1, error (2 − e + (e − 1)·ln(e − 1))/2 in closed form; the inner extremum ln(e − 1) is in the grid.
#[test]
fn exponential_by_a_line() {
    let slope = std::f64::consts::E - 1.0;
    let inner = maths::ln(slope);
    let points: Vec<f64> = (0..=50).map(|k| f64::from(k) / 50.0).chain([inner]).collect();
    let solution = solved(epigraph(2, 52, move |i, x| polynomial(x, points[i]) - maths::exp(points[i])), &[0.0, 0.0, 3.0]);
    close(solution.x[1], slope, 1e-11);
    close(solution.objective, 0.5 * (1.0 - slope + slope * inner), 1e-12);
}

/// Nonlinear in the parameters: exponential by a rational function, "EXP".
#[test]
fn exponential_by_a_rational_function() {
    let problem = epigraph(5, 21, |i, x| {
        let t = -1.0 + 0.1 * i as f64;
        (x[0] + x[1] * t) / (x[2] * t + x[3] * t * t + x[4] * t * t * t + 1.0) - maths::exp(t)
    });
    let solution = solved(problem, &[0.5, 0.0, 0.0, 0.0, 0.0, 2.0]);
    close(solution.objective, 0.122_371_25e-3, 1e-11);
}

/// Sum of decaying oscillations, "EVD61".
#[test]
fn decaying_oscillation() {
    let problem = epigraph(6, 51, |i, x| {
        let t = 0.1 * i as f64;
        let y = 0.5 * maths::exp(-t) - maths::exp(-2.0 * t)
            + 0.5 * maths::exp(-3.0 * t)
            + 1.5 * maths::exp(-1.5 * t) * maths::sin(7.0 * t)
            + maths::exp(-2.5 * t) * maths::sin(5.0 * t);
        x[0] * (-x[1] * t).exp() * (x[2] * t + x[3]).cos() + x[4] * (-x[5] * t).exp() - y
    });
    let solution = solved(problem, &[2.0, 2.0, 7.0, 0.0, -2.0, 1.0, 5.0]);
    close(solution.objective, 0.349_049_26e-1, 1e-9);
}

/// Enzyme kinetics of Kowalik and Osborne in the maximum norm.
#[test]
fn kowalik_osborne() {
    const Y: [f64; 11] = [0.1957, 0.1947, 0.1735, 0.16, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246];
    const U: [f64; 11] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625];
    let problem = epigraph(4, 11, |i, x| {
        let u = U[i];
        x[0] * (x[1] * u + u * u) / (x[2] * u + x[3] + u * u) - Y[i]
    });
    let solution = solved(problem, &[0.25, 0.39, 0.415, 0.39, 0.5]);
    close(solution.objective, 0.808_436_84e-2, 1e-10);
}

/// Not a vertex: fewer active functions than parameters, so curvature decides. "CB2" 1.9522245, "CB3" 2.
#[test]
fn charalambous_conn() {
    let upper = |error: fn(usize, &[Dual64]) -> Dual64| Given::new(3, 3, move |v| (v[2], (0..3).map(|i| v[2] - error(i, v)).collect()));
    let cb2 = upper(|i, x| match i {
        0 => x[0].powi(2) + x[1].powi(4),
        1 => (-x[0] + 2.0).powi(2) + (-x[1] + 2.0).powi(2),
        _ => (x[1] - x[0]).exp() * 2.0,
    });
    close(solved(cb2, &[1.0, -0.1, 6.0]).objective, 1.952_224_5, 1e-7);
    let cb3 = upper(|i, x| match i {
        0 => x[0].powi(4) + x[1].powi(2),
        1 => (-x[0] + 2.0).powi(2) + (-x[1] + 2.0).powi(2),
        _ => (x[1] - x[0]).exp() * 2.0,
    });
    close(solved(cb3, &[2.0, 2.0, 20.0]).objective, 2.0, 1e-9);
}

/// Tight tolerance: 1e-12 in a vertex.
#[test]
fn vertex_to_working_precision() {
    let mut problem = epigraph(5, 21, |i, x| {
        let t = -1.0 + 0.1 * i as f64;
        (x[0] + x[1] * t) / (x[2] * t + x[3] * t * t + x[4] * t * t * t + 1.0) - maths::exp(t)
    });
    let solution =
        problem.solve_with(&[0.5, 0.0, 0.0, 0.0, 0.0, 2.0], &Settings { tolerance: 1e-12, feasibility: 1e-12, ..Settings::default() });
    assert_eq!(solution.stop, Stop::Converged);
}

/// The use this was made for: a curve of 100 samples shaped by 14 bounded parameters, with twenty limits beside it. From wherever it
/// starts the search converges, and nearly every programme is solved by the remembered active set.
#[test]
fn curve_of_many_samples() {
    const TERMS: usize = 7;
    let (samples, limits) = (100, 20);
    let weight = |k: usize| (0.618_033_988_749_895 * (k + 1) as f64).fract();
    let functions = move |v: &[Dual64]| {
        let (y, t) = v.split_at(2 * TERMS);
        let error = |i: usize| {
            let s = i as f64 / (samples - 1) as f64;
            let bumps = (0..TERMS).map(|a| {
                let centre = 0.05 + 0.9 * (a as f64 + 0.3 * weight(a)) / TERMS as f64;
                let u = (-y[a] * 0.3 + (s - centre)) / (y[TERMS + a] * 0.5 + 0.15);
                y[a] * y[a] * (1.0 + weight(50 + a)) / (u * u + 1.0) + u.tanh() * (0.3 * (weight(80 + a) - 0.3))
            });
            bumps.fold(Dual64::from(-1.0), |sum, bump| sum + bump * 0.5)
        };
        let limit = |i: usize| {
            let products = (0..2 * TERMS).map(|j| y[j] * y[(j + i) % (2 * TERMS)] * weight(100 + (3 * i + j) % 90));
            products.fold(Dual64::from(0.0), |sum, product| sum + product * (2.0 / TERMS as f64))
        };
        let errors: Vec<Dual64> = (0..samples).map(error).collect();
        (t[0], errors.iter().map(|e| *e - t[0]).chain(errors.iter().map(|e| *e + t[0])).chain((0..limits).map(limit)).collect())
    };
    let infinite = f64::INFINITY;
    let mut problem =
        Given::new(2 * TERMS + 1, 2 * samples + limits, functions).within(&[0.0; 15], &[[1.0; 14].as_slice(), &[10.0]].concat()).rows(
            &[vec![-infinite; samples], vec![0.0; samples], vec![-infinite; limits]].concat(),
            &[vec![0.0; samples], vec![infinite; samples], vec![1.0; limits]].concat(),
        );
    for seed in 0..4 {
        let mut start: Vec<f64> = (0..2 * TERMS).map(|j| weight(1000 + 37 * seed + j)).collect();
        start.push(2.0);
        let solution = problem.solve(&start);
        assert_eq!(solution.stop, Stop::Converged);
        assert!(solution.violation < 1e-8);
        let counters = solution.counters;
        assert!(counters.iterations <= 120 && counters.interior_qps <= 5, "{counters:?}");
    }
}
