//! Problems 68 to 100: four to seven variables.

use std::f64::consts::{PI, SQRT_2};

use forcewright_base::maths;
use num_dual::DualNum;

use super::case::{AT_LEAST_ZERO, Case, Number, ZERO, constant, cube, dot, fourth, product, square, sum_of_squares, variables};

const INFINITY: f64 = f64::INFINITY;

/// The problems of this file.
pub(crate) fn cases() -> Vec<Case> {
    let cases = [
        hs68 as fn() -> Case,
        hs69,
        hs70,
        hs71,
        hs72,
        hs73,
        hs74,
        hs75,
        hs76,
        hs77,
        hs78,
        hs79,
        hs80,
        hs81,
        hs83,
        hs84,
        hs86,
        hs93,
        hs95,
        hs96,
        hs97,
        hs98,
        hs99,
        hs100,
    ];
    cases.iter().map(|case| case()).collect()
}

/// Distribution function of the standard normal law: 1/2 + φ(t)·(t + t³/3 + t⁵/(3·5) + …).
fn normal_probability(t: Number) -> Number {
    let density = maths::exp(-0.5 * t.re * t.re) / (2.0 * PI).sqrt();
    let (mut term, mut sum, mut odd) = (t.re, t.re, 3.0);
    while term.abs() > 1e-18 * sum.abs() {
        term *= t.re * t.re / odd;
        sum += term;
        odd += 2.0;
    }
    Number::new(0.5 + density * sum, density * t.eps)
}

/// Cost of a control chart (Collani), for the cost constants a, b and the sample size n.
fn control_chart(x: &[Number], a: f64, b: f64, n: f64) -> (Number, Vec<Number>) {
    let [x1, x2, x3, x4] = variables(x);
    let growth = x1.exp() - 1.0;
    let cost = (-(growth * b - x3) / (growth + x4) * x4 + a * n) / x1;
    let shift = n.sqrt();
    let power = x4 - normal_probability(-x2 + shift) - normal_probability(-x2 - shift);
    (cost, vec![x3 - normal_probability(-x2) * 2.0, power])
}

fn hs68() -> Case {
    Case::new(68, &[1.0; 4], |x| control_chart(x, 1e-4, 1.0, 24.0))
        .lower(&[1e-4, 0.0, 0.0, 0.0])
        .upper(&[100.0, 100.0, 2.0, 2.0])
        .subject_to(&[ZERO; 2])
        .solution(-0.920_425_020_704, &[0.067_858_745_231_2, 3.646_171_741_65, 2.661_751_896_94e-4, 0.894_862_212_037])
}

fn hs69() -> Case {
    Case::new(69, &[1.0; 4], |x| control_chart(x, 0.1, 1000.0, 4.0))
        .lower(&[1e-4, 0.0, 0.0, 0.0])
        .upper(&[100.0, 100.0, 2.0, 2.0])
        .subject_to(&[ZERO; 2])
        .solution(-956.712_887_064, &[0.029_371_418_083, 1.190_253_434_88, 0.233_946_796_758, 0.791_667_815_694])
}

/// Observations of problem 70: time and measured concentration.
const CONCENTRATIONS: [(f64, f64); 19] = [
    (0.1, 0.001_89),
    (1.0, 0.1038),
    (2.0, 0.268),
    (3.0, 0.506),
    (4.0, 0.577),
    (5.0, 0.604),
    (6.0, 0.725),
    (7.0, 0.898),
    (8.0, 0.947),
    (9.0, 0.845),
    (10.0, 0.702),
    (11.0, 0.528),
    (12.0, 0.385),
    (13.0, 0.257),
    (14.0, 0.159),
    (15.0, 0.0869),
    (16.0, 0.0453),
    (17.0, 0.015_09),
    (18.0, 0.001_89),
];

/// A gamma density of the given shape with Stirling's first correction, about the scaled time `time * rate`.
#[allow(clippy::approx_constant, reason = "the book prints 6.2832")]
fn gamma_peak(shape: Number, rate: Number, time: f64) -> Number {
    let scaled = time / 7.658;
    let stirling = (shape * 12.0) / (shape * 12.0 + 1.0) * (shape / 6.2832).sqrt();
    stirling * ((shape * rate.ln()) + (shape - 1.0) * maths::ln(scaled) + shape * (-rate * scaled + 1.0)).exp()
}

fn hs70() -> Case {
    Case::new(70, &[2.0, 4.0, 0.04, 2.0], |x| {
        let [x1, x2, x3, x4] = variables(x);
        let rest = -x3 + 1.0;
        let b = x3 + rest * x4;
        let residual = |&(time, measured): &(f64, f64)| x3 * gamma_peak(x2, b, time) + rest * gamma_peak(x1, b / x4, time) - measured;
        (CONCENTRATIONS.iter().map(|observation| square(residual(observation))).sum(), vec![b])
    })
    .lower(&[1e-5; 4])
    .upper(&[100.0, 100.0, 1.0, 100.0])
    .subject_to(&[AT_LEAST_ZERO])
    .solution(0.007_498_463_561_43, &[12.276_953_755_7, 4.631_787_968_86, 0.312_862_470_961, 2.029_290_315_7])
}

fn hs71() -> Case {
    Case::new(71, &[1.0, 5.0, 5.0, 1.0], |x| {
        let [x1, x2, x3, x4] = variables(x);
        (x1 * x4 * (x1 + x2 + x3) + x3, vec![product(x) - 25.0, sum_of_squares(x) - 40.0])
    })
    .lower(&[1.0; 4])
    .upper(&[5.0; 4])
    .subject_to(&[AT_LEAST_ZERO, ZERO])
    .solution(17.014_017_289_5, &[1.0, 4.742_999_375_45, 3.821_150_326_17, 1.379_408_245_85])
}

fn hs72() -> Case {
    Case::new(72, &[1.0; 4], |x| {
        let reciprocals: Vec<Number> = x.iter().map(DualNum::recip).collect();
        let first = -dot(&[4.0, 2.25, 1.0, 0.25], &reciprocals) + 0.0401;
        let second = -dot(&[0.16, 0.36, 0.64, 0.64], &reciprocals) + 0.010_085;
        (dot(&[1.0; 4], x) + 1.0, vec![first, second])
    })
    .lower(&[0.001; 4])
    .upper(&[4e5, 3e5, 2e5, 1e5])
    .subject_to(&[AT_LEAST_ZERO; 2])
    .solution(727.679_376_021, &[193.407_050_141, 179.547_504_555, 185.018_587_841, 168.706_233_485])
}

/// Cattle feed of least cost.
fn hs73() -> Case {
    Case::new(73, &[1.0; 4], |x| {
        let spread = x.iter().zip([0.28, 0.19, 20.5, 0.62]).map(|(&x, variance)| square(x) * variance).sum::<Number>().sqrt();
        let fat = dot(&[2.3, 5.6, 11.1, 1.3], x) - 5.0;
        let protein = dot(&[12.0, 11.9, 41.8, 52.1], x) - 21.0 - spread * 1.645;
        (dot(&[24.55, 26.75, 39.0, 40.5], x), vec![fat, protein, dot(&[1.0; 4], x) - 1.0])
    })
    .lower(&[0.0; 4])
    .subject_to(&[AT_LEAST_ZERO, AT_LEAST_ZERO, ZERO])
    .solution(29.894_378_157_3, &[0.635_521_568_605, 0.0, 0.312_701_880_754, 0.051_776_550_601_1])
}

/// Generation of electric power at three nodes; the bound a limits the phase angles.
fn three_nodes(x: &[Number], a: f64) -> (Number, Vec<Number>) {
    let [x1, x2, x3, x4] = variables(x);
    let flow = |angle: Number| (angle - 0.25).sin() * 1000.0;
    let constraints = vec![
        x4 - x3 + a,
        x3 - x4 + a,
        flow(-x3) + flow(-x4) + 894.8 - x1,
        flow(x3) + flow(x3 - x4) + 894.8 - x2,
        flow(x4) + flow(x4 - x3) + 1294.8,
    ];
    (x1 * 3.0 + cube(x1) * 1e-6 + x2 * 2.0 + cube(x2) * (2e-6 / 3.0), constraints)
}

fn hs74() -> Case {
    Case::new(74, &[0.0; 4], |x| three_nodes(x, 0.55))
        .lower(&[0.0, 0.0, -0.55, -0.55])
        .upper(&[1200.0, 1200.0, 0.55, 0.55])
        .subject_to(&[AT_LEAST_ZERO, AT_LEAST_ZERO, ZERO, ZERO, ZERO])
        .solution(5_126.498_109_34, &[679.945_319_802, 1_026.067_132_56, 0.118_876_364_49, -0.396_233_553_18])
}

fn hs75() -> Case {
    Case::new(75, &[0.0; 4], |x| three_nodes(x, 0.48))
        .lower(&[0.0, 0.0, -0.48, -0.48])
        .upper(&[1200.0, 1200.0, 0.48, 0.48])
        .subject_to(&[AT_LEAST_ZERO, AT_LEAST_ZERO, ZERO, ZERO, ZERO])
        .solution(5_174.412_886_86, &[776.159_220_293, 925.194_939_196, 0.051_108_793_680_4, -0.428_891_137_432])
}

fn hs76() -> Case {
    Case::new(76, &[0.5; 4], |x| {
        let [x1, x2, x3, x4] = variables(x);
        let quadratic = square(x1) + square(x2) * 0.5 + square(x3) + square(x4) * 0.5 - x1 * x3 + x3 * x4;
        let c1 = -x1 - x2 * 2.0 - x3 - x4 + 5.0;
        let c2 = -x1 * 3.0 - x2 - x3 * 2.0 + x4 + 4.0;
        (quadratic - x1 - x2 * 3.0 + x3 - x4, vec![c1, c2, x2 + x3 * 4.0 - 1.5])
    })
    .lower(&[0.0; 4])
    .subject_to(&[AT_LEAST_ZERO; 3])
    .solution(-103.0 / 22.0, &[3.0 / 11.0, 23.0 / 11.0, 0.0, 6.0 / 11.0])
}

fn hs77() -> Case {
    Case::new(77, &[2.0; 5], |x| {
        let [x1, x2, x3, x4, x5] = variables(x);
        let low = square(x1 - 1.0) + square(x1 - x2) + square(x3 - 1.0);
        let objective = low + fourth(x4 - 1.0) + square(cube(x5 - 1.0));
        let c1 = square(x1) * x4 + (x4 - x5).sin() - 2.0 * SQRT_2;
        (objective, vec![c1, x2 + fourth(x3) * square(x4) - 8.0 - SQRT_2])
    })
    .subject_to(&[ZERO; 2])
    .solution(0.241_505_128_786, &[1.166_172_197_26, 1.182_111_388_13, 1.380_257_040_44, 1.506_036_279_61, 0.610_920_257_517])
}

/// Constraints of problems 78, 80 and 81.
fn sphere_and_cubes(x: &[Number]) -> Vec<Number> {
    vec![sum_of_squares(x) - 10.0, x[1] * x[2] - x[3] * x[4] * 5.0, cube(x[0]) + cube(x[1]) + 1.0]
}

fn hs78() -> Case {
    Case::new(78, &[-2.0, 1.5, 2.0, -1.0, -1.0], |x| (product(x), sphere_and_cubes(x)))
        .subject_to(&[ZERO; 3])
        .solution(-2.919_700_409_11, &[-1.717_142_342_3, 1.595_708_268_05, 1.827_248_034_88, -0.763_642_946_6, -0.763_643_482_853])
}

fn hs79() -> Case {
    Case::new(79, &[2.0; 5], |x| {
        let [x1, x2, x3, x4, x5] = variables(x);
        let objective = square(x1 - 1.0) + square(x1 - x2) + square(x2 - x3) + fourth(x3 - x4) + fourth(x4 - x5);
        let c1 = x1 + square(x2) + cube(x3) - 2.0 - 3.0 * SQRT_2;
        (objective, vec![c1, x2 - square(x3) + x4 + 2.0 - 2.0 * SQRT_2, x1 * x5 - 2.0])
    })
    .subject_to(&[ZERO; 3])
    .solution(0.078_776_820_853_8, &[1.191_127_456_26, 1.362_603_164_92, 1.472_817_931_5, 1.635_016_618_94, 1.679_081_436_19])
}

fn hs80() -> Case {
    Case::new(80, &[-2.0, 2.0, 2.0, -1.0, -1.0], |x| (product(x).exp(), sphere_and_cubes(x)))
        .lower(&[-2.3, -2.3, -3.2, -3.2, -3.2])
        .upper(&[2.3, 2.3, 3.2, 3.2, 3.2])
        .subject_to(&[ZERO; 3])
        .solution(0.053_949_847_762_4, &[-1.717_142_944_17, 1.595_708_965_03, 1.827_246_916_54, -0.763_641_279_311, -0.763_645_016_315])
}

fn hs81() -> Case {
    Case::new(81, &[-2.0, 2.0, 2.0, -1.0, -1.0], |x| {
        let constraints = sphere_and_cubes(x);
        (product(x).exp() - square(constraints[2]) * 0.5, constraints)
    })
    .lower(&[-2.3, -2.3, -3.2, -3.2, -3.2])
    .upper(&[2.3, 2.3, 3.2, 3.2, 3.2])
    .subject_to(&[ZERO; 3])
    .solution(0.053_949_847_774_9, &[-1.717_142_400_91, 1.595_708_335_92, 1.827_247_925_92, -0.763_647_440_817, -0.763_638_975_604])
}

/// Colville's third problem.
fn hs83() -> Case {
    Case::new(83, &[78.0, 33.0, 27.0, 27.0, 27.0], |x| {
        let [x1, x2, x3, x4, x5] = variables(x);
        let objective = square(x3) * 5.357_854_7 + x1 * x5 * 0.835_689_1 + x1 * 37.293_239 - 40_792.141;
        let c1 = x2 * x5 * 0.005_685_8 + x1 * x4 * 0.000_626_2 - x3 * x5 * 0.002_205_3 + 85.334_407;
        let c2 = x2 * x5 * 0.007_131_7 + x1 * x2 * 0.002_995_5 + square(x3) * 0.002_181_3 - 9.487_51;
        let c3 = x3 * x5 * 0.004_702_6 + x1 * x3 * 0.001_254_7 + x3 * x4 * 0.001_908_5 - 10.699_039;
        (objective, vec![c1, c2, c3])
    })
    .lower(&[78.0, 33.0, 27.0, 27.0, 27.0])
    .upper(&[102.0, 45.0, 45.0, 45.0, 45.0])
    .subject_to(&[(0.0, 92.0), (0.0, 20.0), (0.0, 5.0)])
    .solution(-30_665.538_671_7, &[78.0, 33.0, 29.995_256_025_3, 45.0, 36.775_812_908_1])
}

fn hs84() -> Case {
    Case::new(84, &[2.52, 2.0, 37.5, 9.25, 6.8], |x| {
        let times_x1 = |constant: f64, coefficients: [f64; 4]| x[0] * (dot(&coefficients, &x[1..]) + constant);
        let profit = times_x1(-8_720_288.849, [150_512.525_3, -156.695_032_5, 476_470.322_2, 729_482.827_1]) - 24_345.0;
        let c1 = times_x1(-145_421.402, [2931.1506, -40.427_932, 5106.192, 15_711.36]);
        let c2 = times_x1(-155_011.108_4, [4_360.533_52, 12.949_234_4, 10_236.884, 13_176.786]);
        let c3 = times_x1(-326_669.510_4, [7_390.684_12, -27.898_697_6, 16_643.076, 30_988.146]);
        (-profit, vec![c1, c2, c3])
    })
    .lower(&[0.0, 1.2, 20.0, 9.0, 6.5])
    .upper(&[1000.0, 2.4, 60.0, 9.3, 7.0])
    .subject_to(&[(0.0, 294_000.0), (0.0, 294_000.0), (0.0, 277_200.0)])
    .solution(-5_280_335.133_06, &[4.537_430_974_66, 2.4, 60.0, 9.3, 7.0])
}

/// Rows of linear constraints of Colville's first problem; problem 117 is its dual.
pub(crate) const COLVILLE_ROWS: [[f64; 5]; 10] = [
    [-16.0, 2.0, 0.0, 1.0, 0.0],
    [0.0, -2.0, 0.0, 0.4, 2.0],
    [-3.5, 0.0, 2.0, 0.0, 0.0],
    [0.0, -2.0, 0.0, -4.0, -1.0],
    [0.0, -9.0, -2.0, 1.0, -2.8],
    [2.0, 0.0, -4.0, 0.0, 0.0],
    [-1.0, -1.0, -1.0, -1.0, -1.0],
    [-1.0, -2.0, -3.0, -2.0, -1.0],
    [1.0, 2.0, 3.0, 4.0, 5.0],
    [1.0, 1.0, 1.0, 1.0, 1.0],
];

/// Right-hand sides of [`COLVILLE_ROWS`].
pub(crate) const COLVILLE_RIGHT: [f64; 10] = [-40.0, -2.0, -0.25, -4.0, -4.0, -1.0, -40.0, -60.0, 5.0, 1.0];

/// Quadratic coefficients of Colville's first problem.
pub(crate) const COLVILLE_QUADRATIC: [[f64; 5]; 5] = [
    [30.0, -20.0, -10.0, 32.0, -10.0],
    [-20.0, 39.0, -6.0, -31.0, 32.0],
    [-10.0, -6.0, 10.0, -6.0, -10.0],
    [32.0, -31.0, -6.0, 39.0, -20.0],
    [-10.0, 32.0, -10.0, -20.0, 30.0],
];

/// Cubic coefficients of Colville's first problem.
pub(crate) const COLVILLE_CUBIC: [f64; 5] = [4.0, 8.0, 10.0, 6.0, 2.0];

/// Linear coefficients of Colville's first problem.
pub(crate) const COLVILLE_LINEAR: [f64; 5] = [-15.0, -27.0, -36.0, -18.0, -12.0];

/// The quadratic form of [`COLVILLE_QUADRATIC`].
pub(crate) fn colville_form(x: &[Number]) -> Number {
    COLVILLE_QUADRATIC.iter().zip(x).map(|(row, &x_row)| dot(row, x) * x_row).sum()
}

fn hs86() -> Case {
    Case::new(86, &[0.0, 0.0, 0.0, 0.0, 1.0], |x| {
        let cubes: Vec<Number> = x.iter().map(|&x| cube(x)).collect();
        let objective = dot(&COLVILLE_LINEAR, x) + colville_form(x) + dot(&COLVILLE_CUBIC, &cubes);
        (objective, COLVILLE_ROWS.iter().zip(COLVILLE_RIGHT).map(|(row, right)| dot(row, x) - right).collect())
    })
    .lower(&[0.0; 5])
    .subject_to(&[AT_LEAST_ZERO; 10])
    .solution(-32.348_678_971_6, &[0.299_999_999_948, 0.333_467_606_492, 0.400_000_000_107, 0.428_310_104_74, 0.223_964_873_676])
}

/// Design of a transformer.
fn hs93() -> Case {
    Case::new(93, &[5.54, 4.4, 12.02, 11.82, 0.702, 0.852], |x| {
        let [x1, x2, x3, x4, x5, x6] = variables(x);
        let inner = x1 * x4 * (x1 + x2 + x3);
        let outer = x2 * x3 * (x1 + x2 * 1.57 + x4);
        let (inner_loss, outer_loss) = (inner * square(x5), outer * square(x6));
        let objective = inner * 0.0204 + outer * 0.0187 + inner_loss * 0.0607 + outer_loss * 0.0437;
        (objective, vec![product(x) * 0.001 - 2.07, -inner_loss * 0.000_62 - outer_loss * 0.000_58 + 1.0])
    })
    .lower(&[0.0; 6])
    .subject_to(&[AT_LEAST_ZERO; 2])
    .solution(
        135.075_961_229,
        &[5.332_666_398_84, 4.656_744_390_73, 10.432_990_112_3, 12.082_308_589_3, 0.752_607_369_745, 0.878_650_836_85],
    )
}

/// Problems 95 to 98 differ in the right-hand sides only.
fn blending(x: &[Number]) -> (Number, Vec<Number>) {
    let [x1, _, x3, x4, x5, x6] = variables(x);
    let c1 = dot(&[17.1, 38.2, 204.2, 212.3, 623.4, 1495.5], x)
        - x1 * x3 * 169.0
        - x3 * x5 * 3580.0
        - x4 * x5 * 3810.0
        - x4 * x6 * 18_500.0
        - x5 * x6 * 24_300.0;
    let c2 =
        dot(&[17.9, 36.8, 113.9, 169.7, 337.8, 1385.2], x) - x1 * x3 * 139.0 - x4 * x5 * 2450.0 - x4 * x6 * 16_600.0 - x5 * x6 * 17_200.0;
    let c3 = dot(&[0.0, -273.0, 0.0, -70.0, -819.0, 0.0], x) + x4 * x5 * 26_000.0;
    let c4 = dot(&[159.9, -311.0, 0.0, 587.0, 391.0, 2198.0], x) - x1 * x6 * 14_000.0;
    (dot(&[4.3, 31.8, 63.3, 15.8, 68.5, 4.7], x), vec![c1, c2, c3, c4])
}

fn blending_case(number: u32, right: [f64; 4]) -> Case {
    Case::new(number, &[0.0; 6], blending)
        .lower(&[0.0; 6])
        .upper(&[0.31, 0.046, 0.068, 0.042, 0.028, 0.0134])
        .subject_to(&right.map(|right| (right, INFINITY)))
}

fn hs95() -> Case {
    blending_case(95, [4.97, -1.88, -29.08, -78.02]).solution(0.015_619_514_428_2, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.003_323_303_282_54])
}

fn hs96() -> Case {
    blending_case(96, [4.97, -1.88, -69.08, -118.02]).solution(0.015_619_513_438_4, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.003_323_303_286_12])
}

fn hs97() -> Case {
    blending_case(97, [32.97, 25.12, -29.08, -78.02]).solution(3.135_809_123_11, &[0.268_564_912_352, 0.0, 0.0, 0.0, 0.028, 0.0134])
}

fn hs98() -> Case {
    blending_case(98, [32.97, 25.12, -124.08, -173.02]).solution(3.135_809_122_99, &[0.268_564_912_323, 0.0, 0.0, 0.0, 0.028, 0.0134])
}

/// Stages of problem 99: duration, thrust acceleration.
const STAGES: [(f64, f64); 7] = [(25.0, 50.0), (25.0, 50.0), (50.0, 75.0), (50.0, 75.0), (50.0, 75.0), (90.0, 100.0), (90.0, 100.0)];

/// Range of a rocket steered by the angles x: velocity and height at the end are given.
fn hs99() -> Case {
    Case::new(99, &[0.5; 7], |x| {
        let (mut range, mut height, mut speed) = (constant(0.0), constant(0.0), constant(0.0));
        for (&angle, (duration, thrust)) in x.iter().zip(STAGES) {
            let gain = angle.sin() * thrust - 32.0;
            range += angle.cos() * (thrust * duration);
            height += gain * (0.5 * duration * duration) + speed * duration;
            speed += gain * duration;
        }
        (-square(range), vec![height - 1e5, speed - 1e3])
    })
    .lower(&[0.0; 7])
    .upper(&[1.58; 7])
    .subject_to(&[ZERO; 2])
    .solution(
        -831_079_891.516,
        &[
            0.542_460_319_142,
            0.529_015_870_015,
            0.508_450_583_169,
            0.480_269_265_187,
            0.451_235_157_238,
            0.409_187_805_755,
            0.352_784_693_565,
        ],
    )
}

fn hs100() -> Case {
    Case::new(100, &[1.0, 2.0, 0.0, 4.0, 0.0, 1.0, 1.0], |x| {
        let [x1, x2, x3, x4, x5, x6, x7] = variables(x);
        let shifted = square(x1 - 10.0) + square(x2 - 12.0) * 5.0 + square(x4 - 11.0) * 3.0;
        let powers = fourth(x3) + square(cube(x5)) * 10.0 + square(x6) * 7.0 + fourth(x7);
        let c1 = -square(x1) * 2.0 - fourth(x2) * 3.0 - x3 - square(x4) * 4.0 - x5 * 5.0 + 127.0;
        let c2 = -x1 * 7.0 - x2 * 3.0 - square(x3) * 10.0 - x4 + x5 + 282.0;
        let c3 = -x1 * 23.0 - square(x2) - square(x6) * 6.0 + x7 * 8.0 + 196.0;
        let c4 = -square(x1) * 4.0 - square(x2) + x1 * x2 * 3.0 - square(x3) * 2.0 - x6 * 5.0 + x7 * 11.0;
        (shifted + powers - x6 * x7 * 4.0 - x6 * 10.0 - x7 * 8.0, vec![c1, c2, c3, c4])
    })
    .subject_to(&[AT_LEAST_ZERO; 4])
    .solution(
        680.630_057_275,
        &[2.330_499_374_31, 1.951_372_373_15, -0.477_541_392_625, 4.365_726_234_62, -0.624_486_970_475, 1.038_131_018_81, 1.594_226_711_37],
    )
}
