//! Profiles against closed forms and their own symmetries.

use std::f64::consts::PI;

use forcewright_base::maths;
use forcewright_curves::{Bounds, Motion, Profile, ProfileError, Segment, Spline};
use proptest::prelude::*;

/// Lines, arcs both ways and a spline of three spans; counterclockwise.
fn mixed() -> Profile {
    let spline = Spline {
        control_m: vec![[4.0, 3.0], [3.5, 4.5], [2.0, 2.5], [1.0, 4.0], [0.5, 3.0], [0.0, 3.0]],
        knots: vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.5, 3.0, 3.0, 3.0, 3.0],
    };
    Profile {
        start_m: [0.0, 0.0],
        segments: vec![
            Segment::Line { to_m: [1.0, 0.0] },
            Segment::Arc { to_m: [3.0, 0.0], centre_m: [2.0, 0.0], counterclockwise: false },
            Segment::Line { to_m: [4.0, 0.0] },
            Segment::Arc { to_m: [4.0, 3.0], centre_m: [4.0, 1.5], counterclockwise: true },
            Segment::Spline(spline),
            Segment::Line { to_m: [0.0, 0.0] },
        ],
    }
}

/// A parabola as one cubic: y = x² from 0 to 1.
fn parabola() -> Spline {
    Spline {
        control_m: vec![[0.0, 0.0], [1.0 / 3.0, 0.0], [2.0 / 3.0, 1.0 / 3.0], [1.0, 1.0]],
        knots: vec![0.0, 0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 2.0],
    }
}

#[test]
fn the_area_under_a_parabola_is_a_third() {
    let under = Profile {
        start_m: [1.0, 1.0],
        segments: vec![Segment::Spline(parabola().reversed()), Segment::Line { to_m: [1.0, 0.0] }, Segment::Line { to_m: [1.0, 1.0] }],
    };
    assert!((under.area_m2() - 1.0 / 3.0).abs() < 1e-16);
    // √5/2 + asinh(2)/4
    let arc = 0.5 * 5.0_f64.sqrt() + 0.25 * maths::ln(2.0 + 5.0_f64.sqrt());
    assert!((under.length_m() - (arc + 2.0)).abs() < 1e-14);
    assert_eq!(under.bounds(), Bounds { min_m: [0.0, 0.0], max_m: [1.0, 1.0] });
}

#[test]
fn arcs_have_the_area_of_their_sectors() {
    let segment = |sweep: f64| {
        let (sin, cos) = maths::sin_cos(sweep);
        let to_m = [7.0 + 2.0 * cos, -3.0 + 2.0 * sin];
        let segments = vec![Segment::Arc { to_m, centre_m: [7.0, -3.0], counterclockwise: true }, Segment::Line { to_m: [9.0, -3.0] }];
        Profile { start_m: [9.0, -3.0], segments }
    };
    for sweep in [0.1, 1.0, 3.0, PI, 4.0, 6.0] {
        let expected = 2.0 * (sweep - maths::sin(sweep));
        assert!((segment(sweep).area_m2() - expected).abs() < 1e-14 * (1.0 + expected), "{sweep}");
        let length = 2.0 * sweep + 4.0 * maths::sin(0.5 * sweep);
        assert!((segment(sweep).length_m() - length).abs() < 1e-13);
    }
    let bounds = segment(4.0).bounds();
    assert!((bounds.max_m[1] + 1.0).abs() < 1e-14 && (bounds.min_m[0] - 5.0).abs() < 1e-14);
}

#[test]
fn far_from_the_origin_no_digits_are_lost() {
    let near = mixed();
    let far = near.transformed(&Motion::new(0.0, [1e6, -1e6]));
    assert!((far.area_m2() - near.area_m2()).abs() < 1e-8);
}

#[test]
fn a_reversed_profile_has_the_opposite_area() {
    let profile = mixed();
    let back = profile.reversed();
    assert!((back.area_m2() + profile.area_m2()).abs() < 1e-13);
    assert!((back.length_m() - profile.length_m()).abs() < 1e-12);
    let twice = back.reversed();
    assert_eq!(twice, profile);
}

#[test]
fn a_tessellation_is_within_its_chord_error() {
    let profile = mixed();
    for chord_error in [1e-2, 1e-4, 1e-6] {
        let corners = profile.tessellate(chord_error);
        let polygon = Profile::polygon(&corners);
        let difference = (polygon.area_m2() - profile.area_m2()).abs();
        assert!(difference < chord_error * profile.length_m(), "{difference}");
        assert!(profile.length_m() - polygon.length_m() > 0.0);
    }
    // chords of a circle: as few as the sagitta allows
    let circle = Profile::circle([0.0, 0.0], 1.0);
    let least = (PI / maths::acos(1.0 - 1e-3)).ceil();
    assert!((circle.tessellate(1e-3).len() as f64 - least).abs() <= 1.0);
}

#[test]
fn a_profile_that_is_none_says_why() {
    let good = mixed();
    assert_eq!(good.check(1e-6), Ok(()));
    let changed = |change: &dyn Fn(&mut Profile)| {
        let mut profile = good.clone();
        change(&mut profile);
        profile.check(1e-6).unwrap_err()
    };
    assert_eq!(changed(&|p| p.segments.clear()), ProfileError::Empty);
    assert_eq!(changed(&|p| p.segments[2] = Segment::Line { to_m: [f64::NAN, 0.0] }), ProfileError::Invalid { segment: 2 });
    assert!(matches!(changed(&|p| p.segments[0] = Segment::Line { to_m: [1.1, 0.0] }), ProfileError::Arc { segment: 1, .. }));
    assert!(matches!(changed(&|p| p.segments[5] = Segment::Line { to_m: [0.0, 0.1] }), ProfileError::Open { .. }));
    let other = |change: &dyn Fn(&mut Spline)| {
        changed(&|p| {
            let Segment::Spline(spline) = &mut p.segments[4] else { panic!("a spline") };
            change(spline);
        })
    };
    assert!(matches!(other(&|s| s.control_m[0][0] = 4.1), ProfileError::Gap { segment: 4, .. }));
    assert_eq!(other(&|s| s.knots[5] = 0.5), ProfileError::Invalid { segment: 4 });
    assert_eq!(other(&|s| s.knots.truncate(7)), ProfileError::Invalid { segment: 4 });
    assert_eq!(other(&|s| s.control_m.truncate(3)), ProfileError::Invalid { segment: 4 });
    // An invalid spline counts as a line: no panic.
    let mut line = good.clone();
    let Segment::Spline(spline) = &mut line.segments[4] else { panic!("a spline") };
    spline.knots.clear();
    let empty = Profile { start_m: [0.0; 2], segments: vec![Segment::Spline(Spline { control_m: Vec::new(), knots: Vec::new() })] };
    assert!(empty.reversed().check(1e-6).is_err() && empty.check(1e-6).is_err());
    assert!(line.area_m2() > 0.0 && line.bounds().extent_m() > 3.0 && line.contains([2.0, 2.0]));
}

#[test]
fn crossings_are_found() {
    let bow = Profile::polygon(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
    let Err(ProfileError::Crossing { segments, at_m }) = bow.check(1e-6) else { panic!("it crosses itself") };
    assert_eq!(segments, [0, 2]);
    assert!((at_m[0] - 0.5).abs() < 1e-12 && (at_m[1] - 0.5).abs() < 1e-12);
    // a spike that turns back on itself
    let spike = Profile::polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [2.0, 1.0], [0.0, 1.0]]);
    assert!(matches!(spike.check(1e-6), Err(ProfileError::Crossing { .. })));
    // two lobes that touch in a point
    let touching = Profile::polygon(&[[0.0, 0.0], [1.0, 1.0], [0.0, 2.0], [2.0, 2.0], [1.0, 1.0], [2.0, 0.0]]);
    assert!(matches!(touching.check(1e-6), Err(ProfileError::Crossing { .. })));
    // an arc that dips through a line by 1e-3
    let dip = |depth: f64| Profile {
        start_m: [0.0, 0.0],
        segments: vec![
            Segment::Line { to_m: [4.0, 0.0] },
            Segment::Line { to_m: [4.0, 1.0] },
            Segment::Line { to_m: [3.0, 1.0 - depth] },
            Segment::Arc { to_m: [1.0, 1.0 - depth], centre_m: [2.0, 1.0 - depth], counterclockwise: false },
            Segment::Line { to_m: [0.0, 1.0] },
            Segment::Line { to_m: [0.0, 0.0] },
        ],
    };
    assert!(dip(1e-3).check(1e-5).is_err());
    assert!(dip(-1e-3).check(1e-5).is_ok());
}

#[test]
fn distances_between_profiles_are_those_of_circles() {
    let one = Profile::circle([0.0, 0.0], 1.0);
    for (x, y) in [(4.0, 0.0), (3.0, -2.0), (-1.0, 5.5), (0.5, 0.2)] {
        let two = Profile::circle([x, y], if maths::hypot(x, y) < 1.0 { 0.3 } else { 0.5 });
        let apart = maths::hypot(x, y);
        let expected = if apart < 1.0 { 1.0 - apart - 0.3 } else { apart - 1.5 };
        let nearest = one.distance_to(&two).unwrap();
        assert!((nearest.distance_m - expected).abs() < 1e-12, "{} is not {expected}", nearest.distance_m);
    }
    let crossing = one.distance_to(&Profile::circle([1.2, 0.0], 0.5)).unwrap();
    assert!(crossing.distance_m <= 0.0);
    // from a spline to a line: the vertex of the parabola lies 1 over it
    let curve = Profile {
        start_m: [0.0, 0.0],
        segments: vec![Segment::Spline(parabola()), Segment::Line { to_m: [0.0, 1.0] }, Segment::Line { to_m: [0.0, 0.0] }],
    };
    let slanted = Profile::polygon(&[[0.5, -0.75], [2.5, 1.25], [3.0, -2.0]]);
    // the tangent of slope 1 touches at x = ½, and the line y = x − 5/4 is 1/√2 below it
    let nearest = curve.distance_to(&slanted).unwrap();
    assert!((nearest.distance_m - 0.5_f64.sqrt()).abs() < 1e-10, "{}", nearest.distance_m);
    assert!((nearest.at_m[0][0] - 0.5).abs() < 1e-4);
    assert_eq!(nearest.segments[0], 0);
    assert!(one.distance_to(&Profile { start_m: [0.0; 2], segments: Vec::new() }).is_none());
}

#[test]
fn winding_tells_inside_from_outside() {
    let profile = mixed();
    assert_eq!(profile.winding([2.0, 2.0]), Some(1));
    assert_eq!(profile.reversed().winding([2.0, 2.0]), Some(-1));
    assert_eq!(profile.winding([2.0, 0.5]), Some(0), "in the mouth of the clockwise arc");
    assert_eq!(profile.winding([5.0, 1.5]), Some(1), "in the belly of the other");
    assert_eq!(profile.winding([5.6, 1.5]), Some(0));
    assert_eq!(profile.winding([0.5, 0.0]), None, "on a line");
    assert_eq!(profile.winding([5.5, 1.5]), None, "on an arc");
    assert!(profile.contains([0.5, 0.0]));
}

#[test]
fn a_mirror_image_stays_counterclockwise() {
    let profile = mixed();
    let mirror = Motion::mirror([1.0, 2.0], [1.0, 3.0]);
    let image = profile.transformed(&mirror);
    assert!((image.area_m2() - profile.area_m2()).abs() < 1e-13);
    assert_eq!(image.check(1e-6), Ok(()));
    // points on the line stay, and twice is the identity
    let on_line = mirror.apply([2.0, 5.0]);
    assert!((on_line[0] - 2.0).abs() < 1e-15 && (on_line[1] - 5.0).abs() < 1e-15);
    let twice = mirror.apply(mirror.apply([0.3, -0.7]));
    assert!((twice[0] - 0.3).abs() < 1e-15 && (twice[1] + 0.7).abs() < 1e-15);
}

proptest! {
    #[test]
    fn area_and_length_do_not_move(turn in -PI..PI, x in -5.0..5.0_f64, y in -5.0..5.0_f64, mirrored in any::<bool>()) {
        let profile = mixed();
        let image = profile.transformed(&Motion::new(turn, [x, y]));
        let image = if mirrored { image.transformed(&Motion::mirror([x, 1.0], [y, 1.0])) } else { image };
        prop_assert!((image.area_m2() - profile.area_m2()).abs() < 1e-12);
        prop_assert!((image.length_m() - profile.length_m()).abs() < 1e-12);
    }

    /// The winding number is that of the polygon, away from the boundary.
    #[test]
    fn inside_is_inside_the_tessellation(x in -1.0..6.0_f64, y in -1.0..5.0_f64) {
        let profile = mixed();
        let corners = profile.tessellate(1e-5);
        let mut inside = false;
        for (k, a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            if (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) {
                inside = !inside;
            }
        }
        prop_assert_eq!(profile.winding([x, y]), Some(i32::from(inside)));
    }

    /// A spline of one span is the Bézier curve of its control points, and ends where they end.
    #[test]
    fn splines_of_one_span_are_bernstein_polynomials(points in prop::array::uniform4((-1.0..1.0_f64, -1.0..1.0_f64)), t in 0.0..1.0_f64) {
        let control_m: Vec<[f64; 2]> = points.iter().map(|(x, y)| [*x, *y]).collect();
        let spline = Spline { control_m: control_m.clone(), knots: vec![-1.0, -1.0, -1.0, -1.0, 3.0, 3.0, 3.0, 3.0] };
        let weights = [(1.0 - t) * (1.0 - t) * (1.0 - t), 3.0 * t * (1.0 - t) * (1.0 - t), 3.0 * t * t * (1.0 - t), t * t * t];
        let point = spline.point_m(-1.0 + 4.0 * t);
        for axis in 0..2 {
            let expected: f64 = weights.iter().zip(&control_m).map(|(w, c)| w * c[axis]).sum();
            prop_assert!((point[axis] - expected).abs() < 1e-14);
        }
        prop_assert!(spline.point_m(9.0).iter().zip(control_m[3]).all(|(a, b)| (a - b).abs() <= 0.0));
        prop_assert_eq!(spline.beziers_m().len(), 1);
    }
}

#[test]
fn spline_areas_agree_with_fine_polygons() {
    let profile = mixed();
    let fine = Profile::polygon(&profile.tessellate(1e-9));
    assert!((fine.area_m2() - profile.area_m2()).abs() < 2e-8);
    assert!((fine.length_m() - profile.length_m()).abs() < 1e-7);
}

/// The Cox–de Boor recursion, as it is written in textbooks.
fn textbook(spline: &Spline, t: f64) -> [f64; 2] {
    fn basis(knots: &[f64], i: usize, degree: usize, t: f64) -> f64 {
        if degree == 0 {
            return f64::from(u8::from(knots[i] <= t && t < knots[i + 1]));
        }
        let part = |above: f64, below: f64, of: f64| if below > 0.0 { above / below * of } else { 0.0 };
        part(t - knots[i], knots[i + degree] - knots[i], basis(knots, i, degree - 1, t))
            + part(knots[i + degree + 1] - t, knots[i + degree + 1] - knots[i + 1], basis(knots, i + 1, degree - 1, t))
    }
    let weights = (0..spline.control_m.len()).map(|i| basis(&spline.knots, i, 3, t));
    spline.control_m.iter().zip(weights).fold([0.0; 2], |sum, (p, w)| [sum[0] + w * p[0], sum[1] + w * p[1]])
}

#[test]
fn the_parts_of_a_split_spline_are_the_spline() {
    let spline = Spline {
        control_m: vec![[0.0, 0.0], [1.0, 2.0], [3.0, 2.5], [5.0, -2.0], [8.0, 0.0], [9.0, 1.0]],
        knots: vec![0.0, 0.0, 0.0, 0.0, 0.3, 0.5, 1.0, 1.0, 1.0, 1.0],
    };
    for t in [0.4, 0.3, 0.5, 0.999] {
        let parts = spline.split(t).unwrap();
        assert!(parts.iter().all(Spline::is_valid));
        for (part, s) in [(&parts[0], 0.1), (&parts[0], t - 1e-9), (&parts[1], t), (&parts[1], 0.9995)] {
            let (a, b) = (textbook(part, s), textbook(&spline, s));
            assert!((a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-14, "split at {t}, point {s}");
        }
    }
    assert!([0.0, 1.0, -1.0, f64::NAN].iter().all(|t| spline.split(*t).is_none()));
}

#[test]
fn however_coarse_a_circle_is_a_hexagon() {
    assert_eq!(Profile::circle([1.0, 2.0], 3.0).tessellate(10.0).len(), 6);
}
