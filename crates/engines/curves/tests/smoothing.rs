//! Smoothing splines: against an independent computation, closed forms, and what they are for, the force of a measured cam.

#[path = "common/cam.rs"]
mod cam;

use cam::{A_M, BRACE_M, Flank, ROLLER_M, START_M};
use forcewright_base::maths::{cos, hypot, sin};
use forcewright_curves::plane::{CurvePoint, PlaneCurve};
use forcewright_curves::registration::{Cloud, Options, register};
use forcewright_curves::smoothing::{self, Amount, SmoothingError, SmoothingSpline};
use proptest::collection::vec;
use proptest::prelude::*;

const REFERENCE: &str = include_str!("../../../../reference/smoothing-spline.csv");

const AMOUNTS: [Amount; 4] =
    [Amount::Residual { deviation: 0.1 }, Amount::Risk { deviation: 0.1 }, Amount::CrossValidated, Amount::Cutoff { wavelength: 5.0 }];

fn one(parameters: &[f64], values: &[f64], amount: Amount) -> SmoothingSpline<1> {
    let values: Vec<[f64; 1]> = values.iter().map(|y| [*y]).collect();
    smoothing::spline(parameters, &values, None, amount).expect("four places")
}

/// Numbers with mean 0 and variance 1, about normal: sums of twelve of a linear congruential generator (Knuth's MMIX).
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }
}

/// All derivatives, residual and degrees of freedom against the dense computation in 40 digits.
#[test]
fn agrees_with_the_dense_computation() {
    let number = |text: &str| text.parse::<f64>().expect("a number");
    let rows: Vec<Vec<&str>> = REFERENCE.lines().filter(|line| !line.starts_with('#')).map(|line| line.split(',').collect()).collect();
    let data: Vec<&Vec<&str>> = rows.iter().filter(|row| row[0] == "data").collect();
    let parameters: Vec<f64> = data.iter().map(|row| number(row[1])).collect();
    let values: Vec<[f64; 1]> = data.iter().map(|row| [number(row[2])]).collect();
    let weights: Vec<f64> = data.iter().map(|row| number(row[3])).collect();
    let mut cases = 0;
    for case in rows.iter().filter(|row| row[0] == "case") {
        let amount = Amount::Cutoff { wavelength: number(case[2]) };
        let smooth = smoothing::spline(&parameters, &values, Some(&weights), amount).unwrap();
        let done = smooth.smoothness();
        let sum = done.residual * done.residual * weights.iter().sum::<f64>();
        assert!((sum / number(case[3]) - 1.0).abs() < 1e-11, "{} {sum}", case[1]);
        assert!((done.freedom / number(case[4]) - 1.0).abs() < 1e-11, "{} {}", case[1], done.freedom);
        assert!((done.cutoff / number(case[2]) - 1.0).abs() < 1e-14 && !done.limited);
        for at in rows.iter().filter(|row| row[0] == "at" && row[1] == case[1]) {
            let ours = smooth.derivatives(number(at[2]));
            // The condition of the stiff case is about 64 λ / 0.13 = 5e5, for λ = 1e3.
            for (order, tolerance) in [1e-12, 1e-11, 1e-11, 1e-11].into_iter().enumerate() {
                assert!((ours[order][0] - number(at[3 + order])).abs() < tolerance, "{at:?} {order}: {}", ours[order][0]);
            }
        }
        cases += 1;
    }
    assert_eq!(cases, 3);
}

/// Parabolas cost nothing: they come back whatever the amount, inside and beyond the ends.
#[test]
fn parabolas_come_back() {
    let parameters: Vec<f64> = (0..40).map(|k| f64::from(k) + 0.3 * sin(f64::from(k * k))).collect();
    let parabola = |t: f64| [2.0 - 0.5 * t + 0.03 * t * t, -0.5 + 0.06 * t, 0.06, 0.0];
    let values: Vec<f64> = parameters.iter().map(|t| parabola(*t)[0]).collect();
    for amount in AMOUNTS {
        let smooth = one(&parameters, &values, amount);
        for t in [-7.0, 0.0, 0.1, 13.77, 39.0, 55.0] {
            for (ours, exact) in smooth.derivatives(t).iter().zip(parabola(t)) {
                assert!((ours[0] - exact).abs() < 1e-11, "{amount:?} {t}: {} {exact}", ours[0]);
            }
        }
    }
}

/// Four values at spacing 1: one B-spline, ∫N² = 11/20, third difference d, so f = y − λ (−1, 3, −3, 1) d / (11/20 + 20 λ).
#[test]
fn four_values_have_a_closed_form() {
    let (parameters, values) = ([0.0, 1.0, 2.0, 3.0], [0.3, -1.0, 2.0, 0.7]);
    let third = -values[0] + 3.0 * values[1] - 3.0 * values[2] + values[3];
    for lambda in [1e-3_f64, 0.1, 7.0] {
        let wavelength = std::f64::consts::TAU * forcewright_base::maths::powf(lambda, 1.0 / 6.0);
        let smooth = one(&parameters, &values, Amount::Cutoff { wavelength });
        let gamma = third / (0.55 + 20.0 * lambda);
        for ((t, y), difference) in parameters.iter().zip(values).zip([-1.0, 3.0, -3.0, 1.0]) {
            assert!((smooth.value(*t)[0] - (y - lambda * difference * gamma)).abs() < 1e-13);
        }
        // In the middle the B-spline is 3/4.
        assert!((smooth.derivatives(1.5)[3][0] - 0.75 * gamma).abs() < 1e-13);
        assert!((smooth.smoothness().freedom - (4.0 - 20.0 * lambda / (0.55 + 20.0 * lambda))).abs() < 1e-13);
    }
}

/// A ripple far from the ends keeps 1 / (1 + (cutoff / wavelength)⁶) of its height.
#[test]
fn ripples_keep_what_the_cutoff_says() {
    // The last case is near the upper border of what is computed, where rounding in the matrix would show.
    for (wavelength, cutoff, count) in [(0.8, 0.8, 800), (0.8, 1.0, 800), (1.6, 0.8, 800), (3.9, 3.9, 6000)] {
        let parameters: Vec<f64> = (0..=count).map(|k| 0.01 * f64::from(k)).collect();
        let middle = 0.005 * f64::from(count);
        let wave = |t: f64| cos(std::f64::consts::TAU * (t - middle) / wavelength);
        let values: Vec<f64> = parameters.iter().map(|t| wave(*t)).collect();
        let ratio = cutoff / wavelength;
        let kept = 1.0 / (1.0 + ratio * ratio * ratio * ratio * ratio * ratio);
        let found = one(&parameters, &values, Amount::Cutoff { wavelength: cutoff }).value(middle)[0];
        assert!((found / kept - 1.0).abs() < 2e-3, "{wavelength} {cutoff}: {found} {kept}");
    }
}

/// On noise of a known size: the residual is as asked, and all ways to choose come near to the least possible distance from the truth.
#[test]
fn the_amount_is_near_the_best() {
    let truth = |t: f64| sin(t) + 0.3 * cos(2.3 * t);
    let parameters: Vec<f64> = (0..300).map(|k| 0.04 * f64::from(k)).collect();
    let (mut ratios, mut noise_found) = ([0.0; 3], 0.0);
    let seeds = 12;
    for seed in 0..seeds {
        let mut random = noise(seed);
        let values: Vec<f64> = parameters.iter().map(|t| truth(*t) + 0.1 * random()).collect();
        let distance = |smooth: &SmoothingSpline<1>| {
            (parameters.iter().map(|t| (smooth.value(*t)[0] - truth(*t)) * (smooth.value(*t)[0] - truth(*t))).sum::<f64>() / 300.0).sqrt()
        };
        let cutoffs = (4..40).map(|k| 0.1 * f64::from(k));
        let best = cutoffs.map(|wavelength| distance(&one(&parameters, &values, Amount::Cutoff { wavelength }))).fold(f64::MAX, f64::min);
        for (ratio, amount) in ratios.iter_mut().zip(AMOUNTS) {
            let smooth = one(&parameters, &values, amount);
            *ratio += distance(&smooth) / best / seeds as f64;
            let done = smooth.smoothness();
            assert!(!done.limited && done.freedom > 3.0 && done.freedom < 60.0);
            if matches!(amount, Amount::Residual { .. }) {
                assert!((done.residual / 0.1 - 1.0).abs() < 1e-8, "{}", done.residual);
            }
            if amount == Amount::CrossValidated {
                noise_found += done.noise / seeds as f64;
            }
        }
    }
    let [residual, risk, cross] = ratios;
    assert!(residual < 1.6 && risk < 1.2 && cross < 1.2, "{ratios:?}");
    // Mean of 12 estimates with about 280 degrees of freedom each: standard deviation 0.1 / √(2 · 280 · 12) = 0.0012.
    assert!((noise_found - 0.1).abs() < 0.0036, "{noise_found}");
}

/// The derivatives are those of the value, and continuous over the knots up to the third.
#[test]
fn derivatives_belong_together() {
    let mut random = noise(5);
    let parameters: Vec<f64> = (0..60).map(|k| f64::from(k) + 0.4 * sin(f64::from(3 * k))).collect();
    let values: Vec<f64> = parameters.iter().map(|t| sin(0.2 * t) + 0.05 * random()).collect();
    let smooth = one(&parameters, &values, Amount::CrossValidated);
    for t in parameters.windows(2).map(|pair| 0.3 * pair[0] + 0.7 * pair[1]) {
        let step = 1e-4;
        let (before, after, here) = (smooth.derivatives(t - step), smooth.derivatives(t + step), smooth.derivatives(t));
        for order in 0..3 {
            let slope = (after[order][0] - before[order][0]) / (2.0 * step);
            assert!((slope - here[order + 1][0]).abs() < 1e-8, "{t} {order}");
        }
    }
    for t in &parameters[1..59] {
        let (before, after) = (smooth.derivatives(t - 1e-12), smooth.derivatives(t + 1e-12));
        for order in 0..4 {
            assert!((before[order][0] - after[order][0]).abs() < 1e-11, "{t} {order}");
        }
    }
}

/// The unit of the parameter, the unit of the values and a straight line added change nothing else.
#[test]
fn units_do_not_matter() {
    let mut random = noise(9);
    let parameters: Vec<f64> = (0..80).map(f64::from).collect();
    let values: Vec<f64> = parameters.iter().map(|t| sin(0.15 * t) + 0.1 * random()).collect();
    let scaled: Vec<f64> = parameters.iter().map(|t| 7.0 + 1e-3 * t).collect();
    let other: Vec<f64> = values.iter().zip(&parameters).map(|(y, t)| 1e3 * (y + 0.5 - 0.2 * t)).collect();
    let (a, b) = (one(&parameters, &values, Amount::CrossValidated), one(&scaled, &other, Amount::CrossValidated));
    for t in [0.0, 13.3, 44.9, 79.0] {
        let [value, slope, second, third] = a.derivatives(t).map(|d| d[0]);
        let expected = [1e3 * (value + 0.5 - 0.2 * t), 1e6 * (slope - 0.2), 1e9 * second, 1e12 * third];
        for ((ours, exact), size) in b.derivatives(7.0 + 1e-3 * t).iter().zip(expected).zip([1e3, 1e6, 1e9, 1e12]) {
            assert!((ours[0] - exact).abs() < 1e-6 * size, "{t} {} {exact}", ours[0]);
        }
    }
}

#[test]
fn faults_are_named_and_places_joined() {
    let smooth = |points: &[[f64; 2]], amount| smoothing::curve(points, None, amount);
    let three = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]];
    assert_eq!(smooth(&three, Amount::CrossValidated).unwrap_err(), SmoothingError::TooFew { places: 3 });
    assert_eq!(smooth(&[], Amount::CrossValidated).unwrap_err(), SmoothingError::TooFew { places: 0 });
    assert_eq!(smooth(&[[1.0, 1.0]; 9], Amount::CrossValidated).unwrap_err(), SmoothingError::TooFew { places: 1 });
    let nan = [[0.0, 0.0], [1.0, f64::NAN], [2.0, 1.0], [3.0, 0.0]];
    assert_eq!(smooth(&nan, Amount::CrossValidated).unwrap_err(), SmoothingError::Value { index: 1 });
    let four = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [3.0, 0.0]];
    for value in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(smooth(&four, Amount::Residual { deviation: value }).unwrap_err(), SmoothingError::Amount { value });
    }
    assert!(smooth(&four, Amount::Risk { deviation: f64::NAN }).is_err());
    let weighted = |weights: &[f64]| smoothing::curve(&four, Some(weights), Amount::CrossValidated).unwrap_err();
    assert_eq!(weighted(&[1.0; 3]), SmoothingError::Lengths { parameters: 4, others: 3 });
    assert_eq!(weighted(&[1.0, 1.0, 0.0, 1.0]), SmoothingError::Value { index: 2 });
    let order = smoothing::spline(&[0.0, 2.0, 1.0, 3.0], &four, None, Amount::CrossValidated).unwrap_err();
    assert_eq!(order, SmoothingError::Order { index: 2 });
    // A point measured twice counts twice.
    let amount = Amount::Cutoff { wavelength: 6.0 };
    let points = [[0.0, 0.0], [1.0, 0.2], [2.0, 1.0], [3.1, 0.0], [4.0, 0.3]];
    let twice = [points[0], points[1], points[2], points[2], points[3], points[4]];
    let (joined, weighted) =
        (smooth(&twice, amount).unwrap(), smoothing::curve(&points, Some(&[1.0, 1.0, 2.0, 1.0, 1.0]), amount).unwrap());
    assert_eq!(joined, weighted);
    assert_eq!(joined.smoothness().places, 5);
    // Values nearly at the same place do no harm.
    let close: Vec<f64> = (0..50).flat_map(|k| [f64::from(k), f64::from(k) + 1e-7]).collect();
    let values: Vec<f64> = close.iter().map(|t| sin(0.2 * t)).collect();
    assert!((one(&close, &values, amount).derivatives(25.5)[1][0] - 0.2 * cos(5.1)).abs() < 1e-4);
    // What is out of reach is said.
    assert!(one(&close, &values, Amount::Residual { deviation: 1e-12 }).smoothness().limited);
    assert!(one(&close, &values, Amount::Residual { deviation: 1e3 }).smoothness().limited);
}

/// Largest errors of the quasi-static force and of the force in a motion of 100 mm in 0.125 s that follow from a flank, both over the
/// quasi-static force of the design.
///
/// F = dV/ds + M s̈ + M′ ṡ²/2 with the mass reduced to the slider (`docs/theory` of the cam family), data of the paper's two-spring design.
fn force_errors(measured: &impl PlaneCurve) -> [f64; 2] {
    let [first, last] = Flank.range();
    let (mut still, mut moving) = (0.0_f64, 0.0_f64);
    let [from, to] = measured.range();
    for k in 0..=4000 {
        let force = cam_forces(&measured.at(from + (to - from) * f64::from(k) / 4000.0));
        let Some([x, static_n, dynamic_n]) = force else { continue };
        if x < first || x > last {
            continue;
        }
        let Some([_, design_n, design_dynamic_n]) = cam_forces(&Flank.at(x)) else { continue };
        still = still.max((static_n / design_n - 1.0).abs());
        moving = moving.max(((dynamic_n - design_dynamic_n) / design_n).abs());
    }
    [still, moving]
}

/// Abscissa of the roller's centre, quasi-static force and force in motion; absent outside the motion.
fn cam_forces(place: &CurvePoint) -> Option<[f64; 3]> {
    const DURATION_S: f64 = 0.125;
    const TRAVEL_M: f64 = 0.1;
    const START_OF_TRAVEL_M: f64 = 0.0319;
    let (slider, brace, roller, brace_inertia, roller_inertia) = (0.068, 0.077, 0.38, 2.57e-4, 4.61e-6);
    let normal = place.left_normal();
    let [x, y] = [place.point_m[0] - ROLLER_M * normal[0], place.point_m[1] - ROLLER_M * normal[1]];
    let height = (BRACE_M * BRACE_M - x * x).sqrt();
    let travel = y + height - (BRACE_M * BRACE_M - START_M * START_M).sqrt();
    let part = (travel - START_OF_TRAVEL_M) / TRAVEL_M;
    if !(0.0..=1.0).contains(&part) {
        return None;
    }
    // path of the centre as y(x): slope and second derivative from the parallel curve
    let slope = place.first_m[1] / place.first_m[0];
    let curvature = place.curvature_per_m();
    let second = curvature / (1.0 + ROLLER_M * curvature) * (1.0 + slope * slope) * (1.0 + slope * slope).sqrt();
    let (lean, lean_slope) = (x / height, BRACE_M * BRACE_M / (height * height * height));
    let x1 = 1.0 / (slope - lean);
    let x2 = -x1 * x1 * x1 * (second - lean_slope);
    let (y1, y2) = (1.0 + lean * x1, lean_slope * x1 * x1 + lean * x2);
    let rolling = roller + roller_inertia / (ROLLER_M * ROLLER_M);
    let turning = brace_inertia / (BRACE_M * BRACE_M);
    let mass = slider
        + 2.0 * rolling * (x1 * x1 + y1 * y1)
        + 2.0 * (brace * (x1 * x1 + (1.0 + y1) * (1.0 + y1)) / 4.0 + turning * (x1 * x1 + (y1 - 1.0) * (y1 - 1.0)));
    let mass_slope =
        4.0 * rolling * (x1 * x2 + y1 * y2) + 4.0 * (brace * (x1 * x2 + (1.0 + y1) * y2) / 4.0 + turning * (x1 * x2 + (y1 - 1.0) * y2));
    let static_n = 4.0 * 1365.0 * (x - START_M) * x1;
    // cycloidal motion: time of the travel by bisection
    let turn = std::f64::consts::TAU;
    let time = forcewright_base::roots::root(|u| u - sin(turn * u) / turn - part, 0.0, 1.0, 1e-15).ok()?;
    let speed = TRAVEL_M / DURATION_S * (1.0 - cos(turn * time));
    let acceleration = TRAVEL_M / (DURATION_S * DURATION_S) * turn * sin(turn * time);
    Some([x, static_n, static_n + mass * acceleration + 0.5 * mass_slope * speed * speed])
}

/// A flank from a travel of 5 mm on, every 0.5 mm, rounded to 1 µm.
fn measured_flank() -> Vec<[f64; 2]> {
    let mut x = START_M + (2.0 * A_M * 0.005).sqrt();
    let mut points = Vec::new();
    while x < Flank.range()[1] {
        let place = Flank.at(x);
        points.push(place.point_m.map(|metres| (metres * 1e6).round() * 1e-6));
        x += 5e-4 / hypot(place.first_m[0], place.first_m[1]);
    }
    points
}

/// Standard deviation of what rounding to 1 µm takes away: 1/√12 of it.
const ROUNDING_M: f64 = 2.886_751_345_948_129e-7;

/// A spline through the points is useless for the force in motion; smoothing by what the rounding is worth gives both forces.
#[test]
fn a_measured_cam_gives_its_force() {
    let points = measured_flank();
    let through = smoothing::curve(&points, None, Amount::Cutoff { wavelength: 1e-6 }).unwrap();
    assert!(through.smoothness().residual < 1e-11 && through.smoothness().limited);
    let [still, moving] = force_errors(&through);
    assert!(still > 0.01 && moving > 0.5, "{still} {moving}");
    for amount in [Amount::Residual { deviation: ROUNDING_M }, Amount::Risk { deviation: ROUNDING_M }, Amount::CrossValidated] {
        let smooth = smoothing::curve(&points, None, amount).unwrap();
        let [still, moving] = force_errors(&smooth);
        assert!(still < 2e-3 && moving < 0.05, "{amount:?}: {still} {moving}");
    }
}

/// The design with a normal error added to it, by the parameter of the design.
struct Deviating(SmoothingSpline<1>);

impl PlaneCurve for Deviating {
    fn range(&self) -> [f64; 2] {
        self.0.range()
    }

    fn at(&self, x: f64) -> CurvePoint {
        let design = Flank.at(x);
        let [[e], [e1], [e2], _] = self.0.derivatives(x);
        // Frenet: n′ = −κ c′. With p = c + e n: p′ = (1 − κe) c′ + e′ n, p″ = (1 − κe) c″ − (κ′e + 2κe′) c′ + e″ n.
        let (normal, curvature) = (design.left_normal(), design.curvature_per_m());
        let step = 1e-7;
        let slope = (Flank.at(x + step).curvature_per_m() - Flank.at(x - step).curvature_per_m()) / (2.0 * step);
        let along = 1.0 - curvature * e;
        let along_slope = -slope * e - 2.0 * curvature * e1;
        let each = |value: &dyn Fn(usize) -> f64| [value(0), value(1)];
        CurvePoint {
            point_m: each(&|k| design.point_m[k] + e * normal[k]),
            first_m: each(&|k| along * design.first_m[k] + e1 * normal[k]),
            second_m: each(&|k| along * design.second_m[k] + along_slope * design.first_m[k] + e2 * normal[k]),
        }
    }
}

/// Better: smooth what the measurement deviates from the design, which is known, and leave the design its own derivatives.
#[test]
fn smoothing_the_deviation_is_better_still() {
    let points = measured_flank();
    let still_standing = Options { iterations: 0, ..Options::default() };
    let found = register(&[Cloud { curve: &Flank, points_m: &points }], &still_standing).unwrap();
    let placed: Vec<_> = found.points[0].iter().filter(|placed| !placed.beyond_end).collect();
    let parameters: Vec<f64> = placed.iter().map(|placed| placed.parameter).collect();
    let errors: Vec<[f64; 1]> = placed.iter().map(|placed| [placed.error_m]).collect();
    let smooth = smoothing::spline(&parameters, &errors, None, Amount::CrossValidated).unwrap();
    let [still, moving] = force_errors(&Deviating(smooth));
    assert!(still < 2e-4 && moving < 5e-3, "{still} {moving}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Whatever is measured, there is an answer or an error, and an answer has numbers.
    #[test]
    fn nothing_measured_panics(points in vec((prop_oneof![-1.0..1.0_f64, Just(0.25), any::<f64>()], -1.0..1.0_f64), 0..30), which in 0..4_usize) {
        let points: Vec<[f64; 2]> = points.into_iter().map(|(x, y)| [x, y]).collect();
        if let Ok(smooth) = smoothing::curve(&points, None, AMOUNTS[which]) {
            let [first, last] = smooth.range();
            prop_assert!(first < last && smooth.smoothness().freedom > 2.0);
        }
    }
}
