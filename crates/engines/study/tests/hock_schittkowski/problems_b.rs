//! Problems 36 to 66: three to seven variables.

use std::f64::consts::{FRAC_PI_2, SQRT_2};

use forcewright_base::maths;
use num_dual::DualNum;

use super::case::{AT_LEAST_ZERO, Case, Number, ZERO, constant, cube, fourth, product, square, sum_of_squares, variables};
use super::problems_a::rosenbrock;

const INFINITY: f64 = f64::INFINITY;

/// The problems of this file.
pub(crate) fn cases() -> Vec<Case> {
    let cases = [
        hs36 as fn() -> Case,
        hs37,
        hs38,
        hs39,
        hs40,
        hs41,
        hs42,
        hs43,
        hs44,
        hs45,
        hs46,
        hs47,
        hs48,
        hs49,
        hs50,
        hs51,
        hs52,
        hs53,
        hs54,
        hs55,
        hs56,
        hs57,
        hs58,
        hs59,
        hs60,
        hs61,
        hs62,
        hs63,
        hs64,
        hs65,
        hs66,
    ];
    cases.iter().map(|case| case()).collect()
}

fn hs36() -> Case {
    Case::new(36, &[10.0; 3], |x| (-product(x), vec![-x[0] - x[1] * 2.0 - x[2] * 2.0 + 72.0]))
        .lower(&[0.0; 3])
        .upper(&[20.0, 11.0, 42.0])
        .subject_to(&[AT_LEAST_ZERO])
        .solution(-3300.0, &[20.0, 11.0, 15.0])
}

fn hs37() -> Case {
    Case::new(37, &[10.0; 3], |x| {
        let sum = x[0] + x[1] * 2.0 + x[2] * 2.0;
        (-product(x), vec![-sum + 72.0, sum])
    })
    .lower(&[0.0; 3])
    .upper(&[42.0; 3])
    .subject_to(&[AT_LEAST_ZERO; 2])
    .solution(-3456.0, &[24.0, 12.0, 12.0])
}

fn hs38() -> Case {
    Case::new(38, &[-3.0, -1.0, -3.0, -1.0], |x| {
        let [x1, x2, x3, x4] = variables(x);
        let valleys = square(x2 - square(x1)) * 100.0 + square(x4 - square(x3)) * 90.0;
        let slopes = square(constant(1.0) - x1) + square(constant(1.0) - x3);
        let (d2, d4) = (x2 - 1.0, x4 - 1.0);
        (valleys + slopes + (square(d2) + square(d4)) * 10.1 + d2 * d4 * 19.8, vec![])
    })
    .lower(&[-10.0; 4])
    .upper(&[10.0; 4])
    .solution(0.0, &[1.0; 4])
}

fn hs39() -> Case {
    Case::new(39, &[2.0; 4], |x| {
        let [x1, x2, x3, x4] = variables(x);
        (-x1, vec![x2 - cube(x1) - square(x3), square(x1) - x2 - square(x4)])
    })
    .subject_to(&[ZERO; 2])
    .solution(-1.0, &[1.0, 1.0, 0.0, 0.0])
}

fn hs40() -> Case {
    let power_of_two = |exponent: f64| maths::powf(2.0, exponent);
    Case::new(40, &[0.8; 4], |x| {
        let [x1, x2, x3, x4] = variables(x);
        (-product(x), vec![cube(x1) + square(x2) - 1.0, square(x1) * x4 - x3, square(x4) - x2])
    })
    .subject_to(&[ZERO; 3])
    .solution(-0.25, &[power_of_two(-1.0 / 3.0), power_of_two(-0.5), power_of_two(-11.0 / 12.0), power_of_two(-0.25)])
}

fn hs41() -> Case {
    Case::new(41, &[2.0; 4], |x| {
        let [x1, x2, x3, x4] = variables(x);
        (-(x1 * x2 * x3) + 2.0, vec![x1 + x2 * 2.0 + x3 * 2.0 - x4])
    })
    .lower(&[0.0; 4])
    .upper(&[1.0, 1.0, 1.0, 2.0])
    .subject_to(&[ZERO])
    .solution(52.0 / 27.0, &[2.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 2.0])
}

fn hs42() -> Case {
    Case::new(42, &[1.0; 4], |x| {
        let [x1, x2, x3, x4] = variables(x);
        (sum_of_squares(&[x1 - 1.0, x2 - 2.0, x3 - 3.0, x4 - 4.0]), vec![x1 - 2.0, square(x3) + square(x4) - 2.0])
    })
    .subject_to(&[ZERO; 2])
    .solution(28.0 - 10.0 * SQRT_2, &[2.0, 2.0, 0.6 * SQRT_2, 0.8 * SQRT_2])
}

/// Rosen and Suzuki's problem.
fn hs43() -> Case {
    Case::new(43, &[0.0; 4], |x| {
        let [x1, x2, x3, x4] = variables(x);
        let (s1, s2, s3, s4) = (square(x1), square(x2), square(x3), square(x4));
        let objective = s1 + s2 + s3 * 2.0 + s4 - x1 * 5.0 - x2 * 5.0 - x3 * 21.0 + x4 * 7.0;
        let c1 = -s1 - s2 - s3 - s4 - x1 + x2 - x3 + x4 + 8.0;
        let c2 = -s1 - s2 * 2.0 - s3 - s4 * 2.0 + x1 + x4 + 10.0;
        let c3 = -s1 * 2.0 - s2 - s3 - x1 * 2.0 + x2 + x4 + 5.0;
        (objective, vec![c1, c2, c3])
    })
    .subject_to(&[AT_LEAST_ZERO; 3])
    .solution(-44.0, &[0.0, 1.0, 2.0, -1.0])
}

fn hs44() -> Case {
    Case::new(44, &[0.0; 4], |x| {
        let [x1, x2, x3, x4] = variables(x);
        let objective = x1 - x2 - x3 - x1 * x3 + x1 * x4 + x2 * x3 - x2 * x4;
        let of_12 = [-x1 - x2 * 2.0 + 8.0, -x1 * 4.0 - x2 + 12.0, -x1 * 3.0 - x2 * 4.0 + 12.0];
        let of_34 = [-x3 * 2.0 - x4 + 8.0, -x3 - x4 * 2.0 + 8.0, -x3 - x4 + 5.0];
        (objective, [of_12, of_34].concat())
    })
    .lower(&[0.0; 4])
    .subject_to(&[AT_LEAST_ZERO; 6])
    .solution(-15.0, &[0.0, 3.0, 0.0, 4.0])
}

fn hs45() -> Case {
    Case::new(45, &[2.0; 5], |x| (-(product(x) / 120.0) + 2.0, vec![]))
        .lower(&[0.0; 5])
        .upper(&[1.0, 2.0, 3.0, 4.0, 5.0])
        .solution(1.0, &[1.0, 2.0, 3.0, 4.0, 5.0])
}

/// Objective of problems 46 and 49; problem 77 adds a term to it.
fn mixed_powers(x: &[Number]) -> Number {
    square(x[0] - x[1]) + square(x[2] - 1.0) + fourth(x[3] - 1.0) + square(cube(x[4] - 1.0))
}

fn hs46() -> Case {
    Case::new(46, &[SQRT_2 / 2.0, 1.75, 0.5, 2.0, 2.0], |x| {
        let [x1, x2, x3, x4, x5] = variables(x);
        (mixed_powers(x), vec![square(x1) * x4 + (x4 - x5).sin() - 1.0, x2 + fourth(x3) * square(x4) - 2.0])
    })
    .subject_to(&[ZERO; 2])
    .solution(0.0, &[1.0; 5])
}

/// Schittkowski's own program has the square of x₂ − x₃; several collections print its cube, with which (1, …, 1) is no minimiser.
fn hs47() -> Case {
    Case::new(47, &[2.0, SQRT_2, -1.0, 2.0 - SQRT_2, 0.5], |x| {
        let [x1, x2, x3, x4, x5] = variables(x);
        let objective = square(x1 - x2) + square(x2 - x3) + fourth(x3 - x4) + fourth(x4 - x5);
        (objective, vec![x1 + square(x2) + cube(x3) - 3.0, x2 - square(x3) + x4 - 1.0, x1 * x5 - 1.0])
    })
    .subject_to(&[ZERO; 3])
    .solution(0.0, &[1.0; 5])
}

fn hs48() -> Case {
    Case::new(48, &[3.0, 5.0, -3.0, 2.0, -2.0], |x| {
        let [x1, x2, x3, x4, x5] = variables(x);
        let objective = square(x1 - 1.0) + square(x2 - x3) + square(x4 - x5);
        (objective, vec![x1 + x2 + x3 + x4 + x5 - 5.0, x3 - (x4 + x5) * 2.0 + 3.0])
    })
    .subject_to(&[ZERO; 2])
    .solution(0.0, &[1.0; 5])
}

fn hs49() -> Case {
    Case::new(49, &[10.0, 7.0, 2.0, -3.0, 0.8], |x| {
        let [x1, x2, x3, x4, x5] = variables(x);
        (mixed_powers(x), vec![x1 + x2 + x3 + x4 * 4.0 - 7.0, x3 + x5 * 5.0 - 6.0])
    })
    .subject_to(&[ZERO; 2])
    .solution(0.0, &[1.0; 5])
}

/// Schittkowski's program has the fourth power of x₄ − x₅; the square is what the collections print. The minimiser is the same.
fn hs50() -> Case {
    Case::new(50, &[35.0, -31.0, 11.0, 5.0, -5.0], |x| {
        let [x1, x2, x3, x4, x5] = variables(x);
        let objective = square(x1 - x2) + square(x2 - x3) + fourth(x3 - x4) + square(x4 - x5);
        let chain = |a: Number, b: Number, c: Number| a + b * 2.0 + c * 3.0 - 6.0;
        (objective, vec![chain(x1, x2, x3), chain(x2, x3, x4), chain(x3, x4, x5)])
    })
    .subject_to(&[ZERO; 3])
    .solution(0.0, &[1.0; 5])
}

/// Common to problems 51 to 53: the terms without x₁ of the objective, and the constraints short of the constant of the first.
fn chained_squares(x: &[Number]) -> (Number, [Number; 3]) {
    let [x1, x2, x3, x4, x5] = variables(x);
    let objective = square(x2 + x3 - 2.0) + square(x4 - 1.0) + square(x5 - 1.0);
    (objective, [x1 + x2 * 3.0, x3 + x4 - x5 * 2.0, x2 - x5])
}

fn hs51() -> Case {
    Case::new(51, &[2.5, 0.5, 2.0, -1.0, 0.5], |x| {
        let (rest, [c1, c2, c3]) = chained_squares(x);
        (square(x[0] - x[1]) + rest, vec![c1 - 4.0, c2, c3])
    })
    .subject_to(&[ZERO; 3])
    .solution(0.0, &[1.0; 5])
}

fn hs52() -> Case {
    let minimiser = [-33.0, 11.0, 180.0, -158.0, 11.0].map(|x| x / 349.0);
    Case::new(52, &[2.0; 5], |x| {
        let (rest, constraints) = chained_squares(x);
        (square(x[0] * 4.0 - x[1]) + rest, constraints.to_vec())
    })
    .subject_to(&[ZERO; 3])
    .solution(1859.0 / 349.0, &minimiser)
}

fn hs53() -> Case {
    let minimiser = [-33.0, 11.0, 27.0, -5.0, 11.0].map(|x| x / 43.0);
    Case::new(53, &[2.0; 5], |x| {
        let (rest, constraints) = chained_squares(x);
        (square(x[0] - x[1]) + rest, constraints.to_vec())
    })
    .lower(&[-10.0; 5])
    .upper(&[10.0; 5])
    .subject_to(&[ZERO; 3])
    .solution(176.0 / 43.0, &minimiser)
}

fn hs54() -> Case {
    Case::new(54, &[6e3, 1.5, 4e6, 2.0, 3e-3, 5e7], |x| {
        let [x1, x2, x3, x4, x5, x6] = variables(x);
        let (d1, d2) = (x1 - 1e4, x2 - 1.0);
        let joint = (square(d1) / 6.4e7 + d1 * d2 / 2e4 + square(d2)) / 0.96;
        let others = square(x3 - 2e6) / 4.9e13 + square(x4 - 10.0) / 2.5e3 + square(x5 - 1e-3) / 2.5e-3 + square(x6 - 1e8) / 2.5e17;
        (-(-(joint + others) / 2.0).exp(), vec![x1 + x2 * 4e3 - 1.76e4])
    })
    .lower(&[0.0, -10.0, 0.0, 0.0, -1.0, 0.0])
    .upper(&[2e4, 10.0, 1e7, 20.0, 1.0, 2e8])
    .subject_to(&[ZERO])
    .solution(-maths::exp(-27.0 / 280.0), &[91_600.0 / 7.0, 79.0 / 70.0, 2e6, 10.0, 1e-3, 1e8])
}

fn hs55() -> Case {
    Case::new(55, &[1.0, 2.0, 0.0, 0.0, 0.0, 2.0], |x| {
        let [x1, x2, x3, x4, x5, x6] = variables(x);
        let sums =
            vec![x1 + x2 * 2.0 + x5 * 5.0 - 6.0, x1 + x2 + x3 - 3.0, x4 + x5 + x6 - 2.0, x1 + x4 - 1.0, x2 + x5 - 2.0, x3 + x6 - 2.0];
        (x1 + x2 * 2.0 + x5 * 4.0 + (x1 * x4).exp(), sums)
    })
    .lower(&[0.0; 6])
    .upper(&[1.0, INFINITY, INFINITY, 1.0, INFINITY, INFINITY])
    .subject_to(&[ZERO; 6])
    .solution(19.0 / 3.0, &[0.0, 4.0 / 3.0, 5.0 / 3.0, 1.0, 2.0 / 3.0, 1.0 / 3.0])
}

/// Problem 37 with its bounds written as sines.
fn hs56() -> Case {
    let a = arcsine_of_root(1.0 / 4.2);
    let b = arcsine_of_root(5.0 / 7.2);
    let x5 = arcsine_of_root(2.0 / 7.0);
    Case::new(56, &[1.0, 1.0, 1.0, a, a, a, b], |x| {
        let [x1, x2, x3, x4, x5, x6, x7] = variables(x);
        let part = |x: Number, angle: Number| x - square(angle.sin()) * 4.2;
        let sum = x1 + x2 * 2.0 + x3 * 2.0 - square(x7.sin()) * 7.2;
        (-(x1 * x2 * x3), vec![part(x1, x4), part(x2, x5), part(x3, x6), sum])
    })
    .subject_to(&[ZERO; 4])
    .solution(-3.456, &[2.4, 1.2, 1.2, arcsine_of_root(4.0 / 7.0), x5, x5, FRAC_PI_2])
}

/// The angle whose sine squared is given.
fn arcsine_of_root(share: f64) -> f64 {
    maths::asin(share.sqrt())
}

/// Observations of problem 57: (a, b), with a the weeks and b the fraction of available chlorine.
const CHLORINE: [(f64, f64); 44] = [
    (8.0, 0.49),
    (8.0, 0.49),
    (10.0, 0.48),
    (10.0, 0.47),
    (10.0, 0.48),
    (10.0, 0.47),
    (12.0, 0.46),
    (12.0, 0.46),
    (12.0, 0.45),
    (12.0, 0.43),
    (14.0, 0.45),
    (14.0, 0.43),
    (14.0, 0.43),
    (16.0, 0.44),
    (16.0, 0.43),
    (16.0, 0.43),
    (18.0, 0.46),
    (18.0, 0.45),
    (20.0, 0.42),
    (20.0, 0.42),
    (20.0, 0.43),
    (22.0, 0.41),
    (22.0, 0.41),
    (22.0, 0.40),
    (24.0, 0.42),
    (24.0, 0.40),
    (24.0, 0.40),
    (26.0, 0.41),
    (26.0, 0.40),
    (26.0, 0.41),
    (28.0, 0.41),
    (28.0, 0.40),
    (30.0, 0.40),
    (30.0, 0.40),
    (30.0, 0.38),
    (32.0, 0.41),
    (32.0, 0.40),
    (34.0, 0.40),
    (36.0, 0.41),
    (36.0, 0.38),
    (38.0, 0.40),
    (38.0, 0.40),
    (40.0, 0.39),
    (42.0, 0.39),
];

fn hs57() -> Case {
    Case::new(57, &[0.42, 5.0], |x| {
        let [x1, x2] = variables(x);
        let residual = |&(a, b): &(f64, f64)| -x1 + b - (-x1 + 0.49) * (-x2 * (a - 8.0)).exp();
        let objective = CHLORINE.iter().map(|observation| square(residual(observation))).sum();
        (objective, vec![x2 * 0.49 - x1 * x2 - 0.09])
    })
    .lower(&[0.4, -4.0])
    .subject_to(&[AT_LEAST_ZERO])
    .solution(0.028_459_669_72, &[0.419_952_674_511, 1.284_845_629_3])
}

fn hs58() -> Case {
    Case::new(58, &[-2.0, 1.0], |x| {
        let (s1, s2) = (square(x[0]), square(x[1]));
        (rosenbrock(x), vec![s2 - x[0], s1 - x[1], s1 + s2 - 1.0])
    })
    .lower(&[-2.0, -INFINITY])
    .upper(&[0.5, INFINITY])
    .subject_to(&[AT_LEAST_ZERO; 3])
    .solution(3.190_333_549_57, &[-0.786_150_483_331, 0.618_034_533_851])
}

/// With 3.405e-4 for the coefficient of x₁ x₂², as some collections print it, the published minimiser is none. Refined from
/// the printed −7.80422632408.
fn hs59() -> Case {
    Case::new(59, &[90.0, 10.0], |x| {
        let [x1, x2] = variables(x);
        let (p2, p3, p4) = (square(x1), cube(x1), fourth(x1));
        let (q2, q3, q4) = (square(x2), cube(x2), fourth(x2));
        let of_x1 = x1 * 3.8112 - p2 * 0.126_94 + p3 * 0.002_056_7 - p4 * 1.0345e-5 - 75.196;
        let of_x2 = x2 * 6.8306 - q2 * 0.256_45 + q3 * 0.003_460_4 - q4 * 1.3514e-5 + constant(28.106) / (x2 + 1.0);
        let low = x1 * x2 * -0.030_234 + p2 * x2 * 1.281_34e-3 - p3 * x2 * 3.5256e-5 + p4 * x2 * 2.266e-7;
        let high = p2 * q2 * 5.2375e-6 + p3 * q2 * 6.3e-8 - p3 * q3 * 7e-10 - x1 * q2 * 3.4054e-4 + x1 * q3 * 1.6638e-6;
        let objective = of_x1 + of_x2 + low + high + (x1 * x2 * 0.0005).exp() * 2.8673;
        (objective, vec![x1 * x2 - 700.0, x2 - p2 / 125.0, square(x2 - 50.0) - (x1 - 55.0) * 5.0])
    })
    .lower(&[0.0; 2])
    .upper(&[75.0, 65.0])
    .subject_to(&[AT_LEAST_ZERO; 3])
    .solution(-7.804_235_953_697_65, &[13.550_088_830_086_6, 51.660_177_934_984_4])
}

fn hs60() -> Case {
    Case::new(60, &[2.0; 3], |x| {
        let [x1, x2, x3] = variables(x);
        let objective = square(x1 - 1.0) + square(x1 - x2) + fourth(x2 - x3);
        (objective, vec![x1 * (square(x2) + 1.0) + fourth(x3) - 4.0 - 3.0 * SQRT_2])
    })
    .lower(&[-10.0; 3])
    .upper(&[10.0; 3])
    .subject_to(&[ZERO])
    .solution(0.032_568_200_251_3, &[1.104_859_024_23, 1.196_674_194_13, 1.535_262_257_39])
}

fn hs61() -> Case {
    Case::new(61, &[0.0; 3], |x| {
        let [x1, x2, x3] = variables(x);
        let (s2, s3) = (square(x2), square(x3));
        let objective = square(x1) * 4.0 + s2 * 2.0 + s3 * 2.0 - x1 * 33.0 + x2 * 16.0 - x3 * 24.0;
        (objective, vec![x1 * 3.0 - s2 * 2.0 - 7.0, x1 * 4.0 - s3 - 11.0])
    })
    .subject_to(&[ZERO; 2])
    .solution(-143.646_142_201, &[5.326_770_157_44, -2.118_998_639_98, 3.210_464_239_06])
}

fn hs62() -> Case {
    Case::new(62, &[0.7, 0.2, 0.1], |x| {
        let [x1, x2, x3] = variables(x);
        let last = x3 + 0.03;
        let yield_1 = ((x1 + x2 + last) / (x1 * 0.09 + x2 + last)).ln() * 255.0;
        let yield_2 = ((x2 + last) / (x2 * 0.07 + last)).ln() * 280.0;
        let yield_3 = (last / (x3 * 0.13 + 0.03)).ln() * 290.0;
        ((yield_1 + yield_2 + yield_3) * -32.174, vec![x1 + x2 + x3 - 1.0])
    })
    .lower(&[0.0; 3])
    .upper(&[1.0; 3])
    .subject_to(&[ZERO])
    .solution(-26_272.514_487_3, &[0.617_813_298_21, 0.328_202_155_786, 0.053_984_546_011_9])
}

fn hs63() -> Case {
    Case::new(63, &[2.0; 3], |x| {
        let [x1, x2, x3] = variables(x);
        let objective = -square(x1) - square(x2) * 2.0 - square(x3) - x1 * x2 - x1 * x3 + 1000.0;
        (objective, vec![x1 * 8.0 + x2 * 14.0 + x3 * 7.0 - 56.0, sum_of_squares(x) - 25.0])
    })
    .lower(&[0.0; 3])
    .subject_to(&[ZERO; 2])
    .solution(961.715_172_127, &[3.512_118_414_92, 0.216_988_174_172, 3.552_174_034_59])
}

fn hs64() -> Case {
    Case::new(64, &[1.0; 3], |x| {
        let [x1, x2, x3] = variables(x);
        let (r1, r2, r3) = (x1.recip(), x2.recip(), x3.recip());
        let objective = x1 * 5.0 + r1 * 5e4 + x2 * 20.0 + r2 * 7.2e4 + x3 * 10.0 + r3 * 1.44e5;
        (objective, vec![-r1 * 4.0 - r2 * 32.0 - r3 * 120.0 + 1.0])
    })
    .lower(&[1e-5; 3])
    .subject_to(&[AT_LEAST_ZERO])
    .solution(6_299.842_428_21, &[108.734_717_597, 85.126_139_425_7, 204.324_707_858])
}

fn hs65() -> Case {
    Case::new(65, &[-5.0, 5.0, 0.0], |x| {
        let [x1, x2, x3] = variables(x);
        (square(x1 - x2) + square(x1 + x2 - 10.0) / 9.0 + square(x3 - 5.0), vec![-sum_of_squares(x) + 48.0])
    })
    .lower(&[-4.5, -4.5, -5.0])
    .upper(&[4.5, 4.5, 5.0])
    .subject_to(&[AT_LEAST_ZERO])
    .solution(0.953_528_856_757, &[3.650_461_821_58, 3.650_461_689_4, 4.620_417_507_54])
}

fn hs66() -> Case {
    Case::new(66, &[0.0, 1.05, 2.9], |x| (x[2] * 0.2 - x[0] * 0.8, vec![x[1] - x[0].exp(), x[2] - x[1].exp()]))
        .lower(&[0.0; 3])
        .upper(&[100.0, 100.0, 10.0])
        .subject_to(&[AT_LEAST_ZERO; 2])
        .solution(0.518_163_274_159, &[0.184_126_487_951, 1.202_167_873_21, 3.327_322_322_58])
}
