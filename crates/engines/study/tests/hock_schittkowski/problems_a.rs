//! Problems 1 to 35: two and three variables.

use std::f64::consts::{PI, SQRT_2};

use forcewright_base::maths;
use num_dual::DualNum;

use super::case::{AT_LEAST_ZERO, Case, Number, ZERO, constant, cube, fourth, product, square, sum_of_squares, variables};

const INFINITY: f64 = f64::INFINITY;

/// The problems of this file.
pub(crate) fn cases() -> Vec<Case> {
    let cases = [
        hs1 as fn() -> Case,
        hs2,
        hs3,
        hs4,
        hs5,
        hs6,
        hs7,
        hs8,
        hs9,
        hs10,
        hs11,
        hs12,
        hs13,
        hs14,
        hs15,
        hs16,
        hs17,
        hs18,
        hs19,
        hs20,
        hs21,
        hs22,
        hs23,
        hs24,
        hs25,
        hs26,
        hs27,
        hs28,
        hs29,
        hs30,
        hs31,
        hs32,
        hs33,
        hs34,
        hs35,
    ];
    cases.iter().map(|case| case()).collect()
}

/// Rosenbrock's valley, the objective of problems 1, 2, 15 to 17, 20 and 58.
pub(crate) fn rosenbrock(x: &[Number]) -> Number {
    square(x[1] - square(x[0])) * 100.0 + square(constant(1.0) - x[0])
}

fn hs1() -> Case {
    Case::new(1, &[-2.0, 1.0], |x| (rosenbrock(x), vec![])).lower(&[-INFINITY, -1.5]).solution(0.0, &[1.0, 1.0])
}

/// With x₂ = 1.5 held by its bound, x₁ is the largest root of 400 x³ − 598 x − 2 = 0.
fn hs2() -> Case {
    let a = (598.0_f64 / 1200.0).sqrt();
    let x1 = 2.0 * a * maths::cos(maths::acos(2.5e-3 / (a * a * a)) / 3.0);
    let optimum = 100.0 * (1.5 - x1 * x1) * (1.5 - x1 * x1) + (1.0 - x1) * (1.0 - x1);
    Case::new(2, &[-2.0, 1.0], |x| (rosenbrock(x), vec![])).lower(&[-INFINITY, 1.5]).solution(optimum, &[x1, 1.5])
}

fn hs3() -> Case {
    Case::new(3, &[10.0, 1.0], |x| (x[1] + square(x[1] - x[0]) * 1e-5, vec![])).lower(&[-INFINITY, 0.0]).solution(0.0, &[0.0, 0.0])
}

fn hs4() -> Case {
    Case::new(4, &[1.125, 0.125], |x| (cube(x[0] + 1.0) / 3.0 + x[1], vec![])).lower(&[1.0, 0.0]).solution(8.0 / 3.0, &[1.0, 0.0])
}

fn hs5() -> Case {
    Case::new(5, &[0.0, 0.0], |x| {
        let [x1, x2] = variables(x);
        ((x1 + x2).sin() + square(x1 - x2) - x1 * 1.5 + x2 * 2.5 + 1.0, vec![])
    })
    .lower(&[-1.5, -3.0])
    .upper(&[4.0, 3.0])
    .solution(-3.0_f64.sqrt() / 2.0 - PI / 3.0, &[0.5 - PI / 3.0, -0.5 - PI / 3.0])
}

fn hs6() -> Case {
    Case::new(6, &[-1.2, 1.0], |x| (square(constant(1.0) - x[0]), vec![(x[1] - square(x[0])) * 10.0]))
        .subject_to(&[ZERO])
        .solution(0.0, &[1.0, 1.0])
}

fn hs7() -> Case {
    Case::new(7, &[2.0, 2.0], |x| {
        let [x1, x2] = variables(x);
        let growth = square(x1) + 1.0;
        (growth.ln() - x2, vec![square(growth) + square(x2) - 4.0])
    })
    .subject_to(&[ZERO])
    .solution(-3.0_f64.sqrt(), &[0.0, 3.0_f64.sqrt()])
}

/// A constant objective: only the intersection of a circle and a hyperbola is sought.
fn hs8() -> Case {
    let x1 = (12.5 + 301.0_f64.sqrt() / 2.0).sqrt();
    Case::new(8, &[2.0, 1.0], |x| (constant(-1.0), vec![sum_of_squares(x) - 25.0, x[0] * x[1] - 9.0]))
        .subject_to(&[ZERO; 2])
        .solution(-1.0, &[x1, 9.0 / x1])
}

fn hs9() -> Case {
    Case::new(9, &[0.0, 0.0], |x| {
        let [x1, x2] = variables(x);
        ((x1 * (PI / 12.0)).sin() * (x2 * (PI / 16.0)).cos(), vec![x1 * 4.0 - x2 * 3.0])
    })
    .subject_to(&[ZERO])
    .solution(-0.5, &[-3.0, -4.0])
}

fn hs10() -> Case {
    Case::new(10, &[-10.0, 10.0], |x| {
        let [x1, x2] = variables(x);
        (x1 - x2, vec![square(x1) * -3.0 + x1 * x2 * 2.0 - square(x2) + 1.0])
    })
    .subject_to(&[AT_LEAST_ZERO])
    .solution(-1.0, &[0.0, 1.0])
}

/// The foot of the perpendicular from (5, 0) on the parabola: the real root of 2 x³ + x − 5 = 0.
fn hs11() -> Case {
    let half = (25.0_f64 / 16.0 + 1.0 / 216.0).sqrt();
    let x1 = maths::cbrt(half + 1.25) - maths::cbrt(half - 1.25);
    Case::new(11, &[4.9, 0.1], |x| (square(x[0] - 5.0) + square(x[1]) - 25.0, vec![x[1] - square(x[0])]))
        .subject_to(&[AT_LEAST_ZERO])
        .solution((x1 - 5.0) * (x1 - 5.0) + x1 * x1 * x1 * x1 - 25.0, &[x1, x1 * x1])
}

fn hs12() -> Case {
    Case::new(12, &[0.0, 0.0], |x| {
        let [x1, x2] = variables(x);
        let objective = square(x1) * 0.5 + square(x2) - x1 * x2 - x1 * 7.0 - x2 * 7.0;
        (objective, vec![-(square(x1) * 4.0) - square(x2) + 25.0])
    })
    .subject_to(&[AT_LEAST_ZERO])
    .solution(-30.0, &[2.0, 3.0])
}

/// Kuhn and Tucker's cusp: no constraint qualification holds at the minimiser.
fn hs13() -> Case {
    Case::new(13, &[-2.0, -2.0], |x| (square(x[0] - 2.0) + square(x[1]), vec![cube(constant(1.0) - x[0]) - x[1]]))
        .lower(&[0.0, 0.0])
        .subject_to(&[AT_LEAST_ZERO])
        .solution(1.0, &[1.0, 0.0])
}

fn hs14() -> Case {
    let root = 7.0_f64.sqrt();
    Case::new(14, &[2.0, 2.0], |x| {
        let [x1, x2] = variables(x);
        (square(x1 - 2.0) + square(x2 - 1.0), vec![-(square(x1) / 4.0) - square(x2) + 1.0, x1 - x2 * 2.0 + 1.0])
    })
    .subject_to(&[AT_LEAST_ZERO, ZERO])
    .solution(9.0 - 23.0 * root / 8.0, &[(root - 1.0) / 2.0, (root + 1.0) / 4.0])
}

fn hs15() -> Case {
    Case::new(15, &[-2.0, 1.0], |x| (rosenbrock(x), vec![x[0] * x[1] - 1.0, x[0] + square(x[1])]))
        .upper(&[0.5, INFINITY])
        .subject_to(&[AT_LEAST_ZERO; 2])
        .solution(306.5, &[0.5, 2.0])
}

fn hs16() -> Case {
    Case::new(16, &[-2.0, 1.0], |x| (rosenbrock(x), vec![x[0] + square(x[1]), square(x[0]) + x[1]]))
        .lower(&[-2.0, -INFINITY])
        .upper(&[0.5, 1.0])
        .subject_to(&[AT_LEAST_ZERO; 2])
        .solution(0.25, &[0.5, 0.25])
}

fn hs17() -> Case {
    Case::new(17, &[-2.0, 1.0], |x| (rosenbrock(x), vec![square(x[1]) - x[0], square(x[0]) - x[1]]))
        .lower(&[-0.5, -INFINITY])
        .upper(&[0.5, 1.0])
        .subject_to(&[AT_LEAST_ZERO; 2])
        .solution(1.0, &[0.0, 0.0])
}

fn hs18() -> Case {
    Case::new(18, &[2.0, 2.0], |x| {
        let [x1, x2] = variables(x);
        (square(x1) * 0.01 + square(x2), vec![x1 * x2 - 25.0, sum_of_squares(x) - 25.0])
    })
    .lower(&[2.0, 0.0])
    .upper(&[50.0, 50.0])
    .subject_to(&[AT_LEAST_ZERO; 2])
    .solution(5.0, &[250.0_f64.sqrt(), 2.5_f64.sqrt()])
}

fn hs19() -> Case {
    let x2 = 5.0 - 17.280_975_f64.sqrt();
    let optimum = 4.095 * 4.095 * 4.095 + (x2 - 20.0) * (x2 - 20.0) * (x2 - 20.0);
    Case::new(19, &[20.1, 5.84], |x| {
        let [x1, x2] = variables(x);
        let inside = -square(x1 - 6.0) - square(x2 - 5.0) + 82.81;
        (cube(x1 - 10.0) + cube(x2 - 20.0), vec![square(x1 - 5.0) + square(x2 - 5.0) - 100.0, inside])
    })
    .lower(&[13.0, 0.0])
    .upper(&[100.0, 100.0])
    .subject_to(&[AT_LEAST_ZERO; 2])
    .solution(optimum, &[14.095, x2])
}

fn hs20() -> Case {
    let root = 3.0_f64.sqrt();
    Case::new(20, &[-2.0, 1.0], |x| (rosenbrock(x), vec![x[0] + square(x[1]), square(x[0]) + x[1], sum_of_squares(x) - 1.0]))
        .lower(&[-0.5, -INFINITY])
        .upper(&[0.5, INFINITY])
        .subject_to(&[AT_LEAST_ZERO; 3])
        .solution(81.5 - 25.0 * root, &[0.5, root / 2.0])
}

fn hs21() -> Case {
    Case::new(21, &[-1.0, -1.0], |x| (square(x[0]) * 0.01 + square(x[1]) - 100.0, vec![x[0] * 10.0 - x[1] - 10.0]))
        .lower(&[2.0, -50.0])
        .upper(&[50.0, 50.0])
        .subject_to(&[AT_LEAST_ZERO])
        .solution(-99.96, &[2.0, 0.0])
}

fn hs22() -> Case {
    Case::new(22, &[2.0, 2.0], |x| {
        let [x1, x2] = variables(x);
        (square(x1 - 2.0) + square(x2 - 1.0), vec![-x1 - x2 + 2.0, x2 - square(x1)])
    })
    .subject_to(&[AT_LEAST_ZERO; 2])
    .solution(1.0, &[1.0, 1.0])
}

fn hs23() -> Case {
    Case::new(23, &[3.0, 1.0], |x| {
        let [x1, x2] = variables(x);
        let (s1, s2) = (square(x1), square(x2));
        (s1 + s2, vec![x1 + x2 - 1.0, s1 + s2 - 1.0, s1 * 9.0 + s2 - 9.0, s1 - x2, s2 - x1])
    })
    .lower(&[-50.0; 2])
    .upper(&[50.0; 2])
    .subject_to(&[AT_LEAST_ZERO; 5])
    .solution(2.0, &[1.0, 1.0])
}

fn hs24() -> Case {
    Case::new(24, &[1.0, 0.5], |x| {
        let [x1, x2] = variables(x);
        let root = 3.0_f64.sqrt();
        let sum = x1 + x2 * root;
        ((square(x1 - 3.0) - 9.0) * cube(x2) / (27.0 * root), vec![x1 / root - x2, sum, -sum + 6.0])
    })
    .lower(&[0.0; 2])
    .subject_to(&[AT_LEAST_ZERO; 3])
    .solution(-1.0, &[3.0, 3.0_f64.sqrt()])
}

fn hs25() -> Case {
    Case::new(25, &[100.0, 12.5, 3.0], |x| {
        let [x1, x2, x3] = variables(x);
        let residual = |i: u32| {
            let share = 0.01 * f64::from(i);
            let u = 25.0 + maths::powf(-50.0 * maths::ln(share), 2.0 / 3.0);
            let power = ((-x2 + u).ln() * x3).exp();
            (-power / x1).exp() - share
        };
        ((1..=99).map(|i| square(residual(i))).sum(), vec![])
    })
    .lower(&[0.1, 0.0, 0.0])
    .upper(&[100.0, 25.6, 5.0])
    .solution(0.0, &[50.0, 25.0, 1.5])
}

fn hs26() -> Case {
    Case::new(26, &[-2.6, 2.0, 2.0], |x| {
        let [x1, x2, x3] = variables(x);
        (square(x1 - x2) + fourth(x2 - x3), vec![(square(x2) + 1.0) * x1 + fourth(x3) - 3.0])
    })
    .subject_to(&[ZERO])
    .solution(0.0, &[1.0, 1.0, 1.0])
}

fn hs27() -> Case {
    Case::new(27, &[2.0, 2.0, 2.0], |x| {
        let [x1, x2, x3] = variables(x);
        (square(x1 - 1.0) * 0.01 + square(x2 - square(x1)), vec![x1 + square(x3) + 1.0])
    })
    .subject_to(&[ZERO])
    .solution(0.04, &[-1.0, 1.0, 0.0])
}

fn hs28() -> Case {
    Case::new(28, &[-4.0, 1.0, 1.0], |x| {
        let [x1, x2, x3] = variables(x);
        (square(x1 + x2) + square(x2 + x3), vec![x1 + x2 * 2.0 + x3 * 3.0 - 1.0])
    })
    .subject_to(&[ZERO])
    .solution(0.0, &[0.5, -0.5, 0.5])
}

fn hs29() -> Case {
    Case::new(29, &[1.0; 3], |x| {
        let [x1, x2, x3] = variables(x);
        (-product(x), vec![-square(x1) - square(x2) * 2.0 - square(x3) * 4.0 + 48.0])
    })
    .subject_to(&[AT_LEAST_ZERO])
    .solution(-16.0 * SQRT_2, &[4.0, 2.0 * SQRT_2, 2.0])
}

fn hs30() -> Case {
    Case::new(30, &[1.0; 3], |x| (sum_of_squares(x), vec![sum_of_squares(&x[..2]) - 1.0]))
        .lower(&[1.0, -10.0, -10.0])
        .upper(&[10.0; 3])
        .subject_to(&[AT_LEAST_ZERO])
        .solution(1.0, &[1.0, 0.0, 0.0])
}

fn hs31() -> Case {
    let root = 3.0_f64.sqrt();
    Case::new(31, &[1.0; 3], |x| {
        let [x1, x2, x3] = variables(x);
        (square(x1) * 9.0 + square(x2) + square(x3) * 9.0, vec![x1 * x2 - 1.0])
    })
    .lower(&[-10.0, 1.0, -10.0])
    .upper(&[10.0, 10.0, 1.0])
    .subject_to(&[AT_LEAST_ZERO])
    .solution(6.0, &[1.0 / root, root, 0.0])
}

fn hs32() -> Case {
    Case::new(32, &[0.1, 0.7, 0.2], |x| {
        let [x1, x2, x3] = variables(x);
        let objective = square(x1 + x2 * 3.0 + x3) + square(x1 - x2) * 4.0;
        (objective, vec![x2 * 6.0 + x3 * 4.0 - cube(x1) - 3.0, -x1 - x2 - x3 + 1.0])
    })
    .lower(&[0.0; 3])
    .subject_to(&[AT_LEAST_ZERO, ZERO])
    .solution(1.0, &[0.0, 0.0, 1.0])
}

fn hs33() -> Case {
    Case::new(33, &[0.0, 0.0, 3.0], |x| {
        let [x1, x2, x3] = variables(x);
        let objective = (x1 - 1.0) * (x1 - 2.0) * (x1 - 3.0) + x3;
        (objective, vec![square(x3) - square(x2) - square(x1), sum_of_squares(x) - 4.0])
    })
    .lower(&[0.0; 3])
    .upper(&[INFINITY, INFINITY, 5.0])
    .subject_to(&[AT_LEAST_ZERO; 2])
    .solution(SQRT_2 - 6.0, &[0.0, SQRT_2, SQRT_2])
}

fn hs34() -> Case {
    let x2 = maths::ln(10.0);
    Case::new(34, &[0.0, 1.05, 2.9], |x| (-x[0], vec![x[1] - x[0].exp(), x[2] - x[1].exp()]))
        .lower(&[0.0; 3])
        .upper(&[100.0, 100.0, 10.0])
        .subject_to(&[AT_LEAST_ZERO; 2])
        .solution(-maths::ln(x2), &[maths::ln(x2), x2, 10.0])
}

fn hs35() -> Case {
    Case::new(35, &[0.5; 3], |x| {
        let [x1, x2, x3] = variables(x);
        let linear = -x1 * 8.0 - x2 * 6.0 - x3 * 4.0 + 9.0;
        let quadratic = square(x1) * 2.0 + square(x2) * 2.0 + square(x3) + x1 * x2 * 2.0 + x1 * x3 * 2.0;
        (linear + quadratic, vec![-x1 - x2 - x3 * 2.0 + 3.0])
    })
    .lower(&[0.0; 3])
    .subject_to(&[AT_LEAST_ZERO])
    .solution(1.0 / 9.0, &[4.0 / 3.0, 7.0 / 9.0, 4.0 / 9.0])
}
