//! Registration of measured points, against an independent computation and against laws that any fit must keep.

#[path = "common/cam.rs"]
mod cam;

use std::f64::consts::PI;

use cam::Flank;
use forcewright_base::maths;
use forcewright_curves::plane::{CurvePoint, Mirrored, PlaneCurve};
use forcewright_curves::registration::{Cloud, Options, Registration, RegistrationError, Weights, register};
use proptest::collection::vec;
use proptest::prelude::*;

const POINTS: &str = include_str!("../../../../reference/cam/registration-points.csv");
const FOUND: &str = include_str!("../../../../reference/cam/registration.csv");

/// Rows of numbers below the comments and the line with the names.
fn rows(text: &str) -> impl Iterator<Item = Vec<&str>> {
    text.lines().filter(|line| !line.starts_with('#')).skip(1).map(|line| line.split(',').collect())
}

/// Side, place (m) and whether it was made an outlier.
fn measured() -> Vec<(f64, [f64; 2], bool)> {
    let number = |text: &str| text.parse::<f64>().expect("a number");
    rows(POINTS).map(|row| (number(row[0]), [1e-3 * number(row[1]), 1e-3 * number(row[2])], row[3] == "1")).collect()
}

fn side(of: f64, keep: impl Fn(bool) -> bool) -> Vec<[f64; 2]> {
    measured().into_iter().filter(|(side, _, outlier)| (side - of).abs() < 0.5 && keep(*outlier)).map(|(_, point, _)| point).collect()
}

fn fit(right: &[[f64; 2]], left: &[[f64; 2]], weights: Weights) -> Registration {
    let clouds = [Cloud { curve: &Flank, points_m: right }, Cloud { curve: &Mirrored(Flank), points_m: left }];
    register(&clouds, &Options { weights, ..Options::default() }).expect("flanks have a shape")
}

/// Angle, shifts, scale, both errors and the standard deviations, in degrees and millimetres as in the reference.
fn numbers(found: &Registration) -> [f64; 9] {
    let degrees = 180.0 / PI;
    [
        found.angle_rad * degrees,
        found.shift_m[0] * 1e3,
        found.shift_m[1] * 1e3,
        found.scale_m * 1e3,
        found.weighted_rms_m * 1e3,
        found.rms_m * 1e3,
        found.angle_deviation_rad * degrees,
        found.shift_deviation_m[0] * 1e3,
        found.shift_deviation_m[1] * 1e3,
    ]
}

fn reference(case: &str) -> Vec<f64> {
    let row = rows(FOUND).find(|row| row[0] == case).expect("in the file");
    row[1..].iter().map(|x| x.parse().expect("a number")).collect()
}

/// Against the independent computation: 1e-9 of each number, as it has at least ten digits.
#[test]
fn agrees_with_the_independent_computation() {
    let all = |_| true;
    let (right, left) = (side(1.0, all), side(-1.0, all));
    let cases = [
        ("noisy_none", fit(&right, &left, Weights::Equal)),
        ("noisy_huber", fit(&right, &left, Weights::Huber)),
        ("noisy_tukey", fit(&right, &left, Weights::Tukey)),
        ("noisy_clean_only_plain", fit(&side(1.0, |outlier| !outlier), &side(-1.0, |outlier| !outlier), Weights::Equal)),
        ("one_side_tukey", fit(&right, &[], Weights::Tukey)),
    ];
    for (case, found) in &cases {
        assert!(found.converged, "{case}");
        for (ours, theirs) in numbers(found).into_iter().zip(reference(case)) {
            assert!((ours / theirs - 1.0).abs() < 1e-9, "{case}: {ours} {theirs}");
        }
    }
    let tukey = &cases[2].1;
    // The truth lies within three standard deviations, and what was made an outlier is found.
    assert!((numbers(tukey)[0] - 0.7).abs() < 3.0 * numbers(tukey)[6]);
    assert!((numbers(tukey)[1] - 1.3).abs() < 3.0 * numbers(tukey)[7] && (numbers(tukey)[2] + 0.8).abs() < 3.0 * numbers(tukey)[8]);
    let made: Vec<(usize, usize)> = [&1.0, &-1.0]
        .into_iter()
        .enumerate()
        .flat_map(|(cloud, of)| {
            let flags = measured().into_iter().filter(move |(side, ..)| (side - of).abs() < 0.5);
            flags.enumerate().filter(|(_, (.., outlier))| *outlier).map(move |(index, _)| (cloud, index)).collect::<Vec<_>>()
        })
        .collect();
    let found: Vec<(usize, usize)> = tukey.outliers().collect();
    let missed = made.iter().filter(|point| !found.contains(point)).count();
    let wrong = found.iter().filter(|point| !made.contains(point)).count();
    assert!(missed <= 1 && wrong == 0, "{missed} missed, {wrong} wrong of {}", made.len());
}

/// Points of the design itself, moved: the motion comes back to rounding, also from a far start.
#[test]
fn points_of_the_design_are_brought_home() {
    let (angle, shift) = (0.7 * PI / 180.0, [1.3e-3, -0.8e-3]);
    let (sin, cos) = maths::sin_cos(angle);
    let [first, last] = Flank.range();
    let away = |mirror: f64| -> Vec<[f64; 2]> {
        let places = (1..200).map(|k| Flank.at(first + (last - first) * f64::from(k) / 200.0).point_m);
        let moved = |[x, y]: [f64; 2]| {
            let [dx, dy] = [mirror * x - shift[0], y - shift[1]];
            [cos * dx + sin * dy, -sin * dx + cos * dy]
        };
        places.map(moved).collect()
    };
    let (right, left) = (away(1.0), away(-1.0));
    for weights in [Weights::Equal, Weights::Huber, Weights::Tukey] {
        for (start_angle_rad, start_shift_m) in [(0.0, [0.0; 2]), (0.05, [-4e-3, 5e-3])] {
            let clouds = [Cloud { curve: &Flank, points_m: &right }, Cloud { curve: &Mirrored(Flank), points_m: &left }];
            let found = register(&clouds, &Options { weights, start_angle_rad, start_shift_m, ..Options::default() }).unwrap();
            assert!((found.angle_rad - angle).abs() < 2e-15, "{weights:?} {:e}", found.angle_rad - angle);
            assert!((found.shift_m[0] - shift[0]).abs() < 5e-16 && (found.shift_m[1] - shift[1]).abs() < 5e-16, "{weights:?}");
            assert!(found.rms_m < 1e-15 && found.outliers().count() == 0);
            let home = found.motion().apply(right[10]);
            assert!(maths::hypot(home[0] - Flank.at(first + (last - first) * 11.0 / 200.0).point_m[0], 0.0) < 1e-15);
        }
    }
}

/// The parameter of the foot is that of the place from which the point was moved along the normal, and the distance has its sign.
#[test]
fn feet_and_signs_are_those_of_the_construction() {
    let [first, last] = Flank.range();
    let heights: Vec<f64> = (1..120).map(|k| 1e-5 * f64::from((k * 7) % 11 - 5)).collect();
    let places: Vec<f64> = (1..120).map(|k| first + (last - first) * f64::from(k) / 120.0).collect();
    let points: Vec<[f64; 2]> = places
        .iter()
        .zip(&heights)
        .map(|(x, height)| {
            let place = Flank.at(*x);
            let normal = place.left_normal();
            [place.point_m[0] + height * normal[0], place.point_m[1] + height * normal[1]]
        })
        .collect();
    let still = Options { iterations: 0, ..Options::default() };
    let found = register(&[Cloud { curve: &Flank, points_m: &points }], &still).unwrap();
    assert!(!found.converged && found.iterations == 0);
    for (placed, (x, height)) in found.points[0].iter().zip(places.iter().zip(&heights)) {
        assert!((placed.parameter - x).abs() < 1e-15 / (x - first) && (placed.error_m - height).abs() < 1e-16, "{placed:?} {x}");
    }
}

/// A circle of radius r about the origin, by its angle.
struct Arc(f64);

impl PlaneCurve for Arc {
    fn range(&self) -> [f64; 2] {
        [0.0, 2.0]
    }

    fn at(&self, u: f64) -> CurvePoint {
        let (sin, cos) = maths::sin_cos(u);
        let r = self.0;
        CurvePoint { point_m: [r * cos, r * sin], first_m: [-r * sin, r * cos], second_m: [-r * cos, -r * sin] }
    }
}

#[test]
fn faults_are_named() {
    let points: Vec<[f64; 2]> = (1..40).map(|k| Arc(0.1).at(0.05 * f64::from(k)).point_m).collect();
    let on_arc = |points_m: &[[f64; 2]]| register(&[Cloud { curve: &Arc(0.1), points_m }], &Options::default()).unwrap_err();
    assert_eq!(on_arc(&points), RegistrationError::Free);
    assert_eq!(on_arc(&points[..2]), RegistrationError::TooFew { points: 2 });
    assert_eq!(on_arc(&[[f64::NAN; 2]]), RegistrationError::NotFinite { cloud: 0 });
    assert_eq!(register(&[], &Options::default()).unwrap_err(), RegistrationError::TooFew { points: 0 });
    assert_eq!(on_arc(&[[0.1, 0.02]; 5]), RegistrationError::Free);
    // A cusp at the end has no normal: what lies beyond it counts nothing.
    let still = Options { iterations: 0, ..Options::default() };
    let mut beside: Vec<[f64; 2]> = (2..8).map(|k| Flank.at(0.01 * f64::from(k) + 0.055).point_m).collect();
    beside.push([0.0600, 0.0120]);
    let ends = register(&[Cloud { curve: &Flank, points_m: &beside }], &still).unwrap();
    assert_eq!(ends.points[0].iter().filter(|placed| placed.beyond_end).count(), 1);
    assert!(ends.points[0][6].beyond_end && ends.points[0][6].weight.abs() < f64::MIN_POSITIVE);
    // Points beyond the end say nothing: here all of them.
    assert_eq!(on_arc(&[[0.1, -0.02], [0.101, -0.03], [0.1, -0.01]]), RegistrationError::TooFew { points: 0 });
}

/// Doubling all lengths doubles all lengths and keeps angles; turning the measured cloud turns the answer.
#[test]
fn scales_and_turns_with_the_cloud() {
    struct Doubled;
    impl PlaneCurve for Doubled {
        fn range(&self) -> [f64; 2] {
            Flank.range()
        }
        fn at(&self, u: f64) -> CurvePoint {
            let place = Flank.at(u);
            CurvePoint {
                point_m: place.point_m.map(|x| 2.0 * x),
                first_m: place.first_m.map(|x| 2.0 * x),
                second_m: place.second_m.map(|x| 2.0 * x),
            }
        }
    }
    let right = side(1.0, |_| true);
    let double: Vec<[f64; 2]> = right.iter().map(|point| point.map(|x| 2.0 * x)).collect();
    let one = fit(&right, &[], Weights::Tukey);
    let two = register(&[Cloud { curve: &Doubled, points_m: &double }], &Options::default()).unwrap();
    assert!((two.angle_rad - one.angle_rad).abs() < 1e-14);
    assert!((two.shift_m[0] - 2.0 * one.shift_m[0]).abs() < 1e-14 && (two.scale_m / one.scale_m - 2.0).abs() < 1e-10);
    let turned: Vec<[f64; 2]> = right
        .iter()
        .map(|[x, y]| {
            let (sin, cos) = maths::sin_cos(0.01);
            [cos * x - sin * y, sin * x + cos * y]
        })
        .collect();
    let again = fit(&turned, &[], Weights::Tukey);
    assert!((again.angle_rad + 0.01 - one.angle_rad).abs() < 1e-13, "{:e}", again.angle_rad + 0.01 - one.angle_rad);
    assert!((again.angle_deviation_rad / one.angle_deviation_rad - 1.0).abs() < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// Whatever is measured, there is an answer or an error.
    #[test]
    fn nothing_measured_panics(points in vec(prop_oneof![(-0.3..0.3_f64, -0.3..0.3_f64), (any::<f64>(), any::<f64>())], 0..12), tukey: bool) {
        let points: Vec<[f64; 2]> = points.into_iter().map(|(x, y)| [x, y]).collect();
        let weights = if tukey { Weights::Tukey } else { Weights::Huber };
        let options = Options { weights, iterations: 20, ..Options::default() };
        if let Ok(found) = register(&[Cloud { curve: &Flank, points_m: &points }], &options) {
            prop_assert_eq!(found.points[0].len(), points.len());
        }
    }
}
