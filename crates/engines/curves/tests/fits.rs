//! Fits of smooth curves: errors measured by a search of the test's own, orders of convergence, smoothness.

mod common;

use std::f64::consts::TAU;

use common::{Intrinsic, lan_beams};
use forcewright_base::{maths, roots};
use forcewright_curves::fit::{FitError, Oriented, arcs, spline};
use forcewright_curves::{Profile, Segment, Spline};

fn oriented(axis: &Intrinsic) -> impl Fn(f64) -> Oriented + use<> {
    let axis = axis.clone();
    move |u| {
        let place = axis.at(u);
        Oriented { point_m: place.point_m, tangent: place.tangent }
    }
}

/// An ellipse, whose parameter is not its length.
fn ellipse(u: f64) -> Oriented {
    let (sin, cos) = maths::sin_cos(TAU * u);
    let speed = maths::hypot(3.0 * sin, cos);
    Oriented { point_m: [3.0 * cos, sin], tangent: [-3.0 * sin / speed, cos / speed] }
}

/// Largest distance of points from a curve.
fn farthest(points: &[[f64; 2]], curve: &dyn Fn(f64) -> Oriented) -> f64 {
    let from = |point: &[f64; 2]| {
        let far = |u: f64| {
            let p = curve(u).point_m;
            maths::hypot(p[0] - point[0], p[1] - point[1])
        };
        let nearest = (0..=60).map(|k| f64::from(k) / 60.0).min_by(|a, b| far(*a).total_cmp(&far(*b))).expect("61 places");
        let (low, high) = ((nearest - 1.0 / 60.0).max(0.0), (nearest + 1.0 / 60.0).min(1.0));
        roots::minimise(far, low, high, 1e-10).value.min(far(low)).min(far(high))
    };
    points.iter().map(from).fold(0.0, f64::max)
}

fn points_of(spline: &Spline) -> Vec<[f64; 2]> {
    (0..=300).map(|k| spline.point_m(f64::from(k) / 300.0)).collect()
}

/// Points of arcs and lines in a row.
fn points_of_arcs(start_m: [f64; 2], segments: &[Segment]) -> Vec<[f64; 2]> {
    let end_m = segments.last().expect("not empty").end_m();
    let mut points = Profile { start_m, segments: segments.to_vec() }.tessellate(1e-10);
    points.push(end_m);
    let keep = points.len() / 400 + 1;
    points.into_iter().step_by(keep).collect()
}

#[test]
fn splines_are_as_near_as_they_say() {
    let beams = lan_beams();
    for tolerance in [1e-5, 1e-7, 1e-9] {
        for beam in &beams {
            let curve = oriented(beam);
            let fitted = spline(&curve, tolerance).unwrap();
            assert!(fitted.error_m <= tolerance);
            let measured = farthest(&points_of(&fitted.spline), &curve);
            assert!(measured <= 1.05 * fitted.error_m + 1e-15, "{measured} against {}", fitted.error_m);
            assert!(measured >= 0.7 * fitted.error_m, "{measured} against {}", fitted.error_m);
            assert!(fitted.error_m > 0.02 * tolerance, "no more spans than needed: {}", fitted.error_m);
        }
    }
}

/// An error of fourth order: a hundredth of it takes √10 times the spans.
#[test]
fn the_number_of_spans_grows_with_the_fourth_root() {
    let curve = oriented(&lan_beams()[0]);
    let spans = |tolerance: f64| spline(&curve, tolerance).unwrap().spline.control_m.len() as f64 - 3.0;
    let growth = spans(1e-12) / spans(1e-10);
    assert!((growth - 10.0_f64.sqrt()).abs() < 0.4, "{growth}");
}

#[test]
fn splines_begin_and_end_on_the_curve_in_its_direction() {
    let beam = &lan_beams()[1];
    let fitted = spline(&oriented(beam), 1e-7).unwrap().spline;
    assert!(fitted.is_valid());
    let (start, end) = (beam.at(0.0), beam.at(1.0));
    let c = &fitted.control_m;
    assert_eq!((c[0], c[c.len() - 1]), (start.point_m, end.point_m));
    let sine = |a: [f64; 2], b: [f64; 2], t: [f64; 2]| {
        let d = [b[0] - a[0], b[1] - a[1]];
        (d[0] * t[1] - d[1] * t[0]) / maths::hypot(d[0], d[1])
    };
    assert!(sine(c[0], c[1], start.tangent).abs() < 1e-11);
    assert!(sine(c[c.len() - 2], c[c.len() - 1], end.tangent).abs() < 1e-11);
}

/// Second derivatives agree where spans meet: knots are simple, and the curve is that of its control points.
#[test]
fn splines_have_simple_knots_and_continuous_curvature() {
    let fitted = spline(&ellipse, 1e-6).unwrap();
    assert!(farthest(&points_of(&fitted.spline), &ellipse) <= 1.05e-6);
    let knots = &fitted.spline.knots;
    assert!(knots[3..knots.len() - 3].windows(2).all(|pair| pair[0] < pair[1]));
    let step = 1e-4;
    for knot in &knots[4..knots.len() - 4] {
        let at = |offset: f64| fitted.spline.point_m(knot + offset);
        let second = |side: f64| {
            let [a, b, c] = [at(0.0), at(side * step), at(2.0 * side * step)];
            [(a[0] - 2.0 * b[0] + c[0]) / (step * step), (a[1] - 2.0 * b[1] + c[1]) / (step * step)]
        };
        let (before, after) = (second(-1.0), second(1.0));
        let scale = maths::hypot(before[0], before[1]);
        assert!(maths::hypot(before[0] - after[0], before[1] - after[1]) < 0.02 * scale, "{before:?} {after:?}");
    }
}

#[test]
fn places_are_denser_where_the_curve_bends_more() {
    let fitted = spline(&ellipse, 1e-6).unwrap().spline;
    let spans: Vec<f64> = fitted.knots[3..fitted.knots.len() - 3].windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (shortest, longest) = spans.iter().fold((f64::MAX, 0.0_f64), |(low, high), span| (low.min(*span), high.max(*span)));
    assert!(longest > 2.0 * shortest, "{spans:?}");
}

#[test]
fn arcs_are_as_near_as_they_say_and_join_smoothly() {
    for (curve, size) in [(Box::new(oriented(&lan_beams()[0])) as Box<dyn Fn(f64) -> Oriented>, 1e-2), (Box::new(ellipse), 1.0)] {
        for tolerance in [1e-3 * size, 1e-5 * size] {
            let fitted = arcs(&curve, tolerance).unwrap();
            assert!(fitted.error_m <= tolerance);
            let start = curve(0.0);
            let measured = farthest(&points_of_arcs(start.point_m, &fitted.segments), &curve);
            assert!(measured <= 1.1 * tolerance, "{measured}");
            let mut from = start.point_m;
            let mut direction = start.tangent;
            for segment in &fitted.segments {
                let Segment::Arc { to_m, centre_m, counterclockwise } = segment else { panic!("arcs only") };
                let sign = if *counterclockwise { 1.0 } else { -1.0 };
                let tangent = |p: [f64; 2]| {
                    let r = [p[0] - centre_m[0], p[1] - centre_m[1]];
                    let radius = maths::hypot(r[0], r[1]);
                    [-sign * r[1] / radius, sign * r[0] / radius]
                };
                let into = tangent(from);
                assert!((into[0] * direction[1] - into[1] * direction[0]).abs() < 1e-9);
                assert!(into[0] * direction[0] + into[1] * direction[1] > 0.0);
                (from, direction) = (*to_m, tangent(*to_m));
            }
            let end = curve(1.0).point_m;
            assert!(maths::hypot(from[0] - end[0], from[1] - end[1]) <= 0.0);
        }
    }
}

/// Biarcs are of third order.
#[test]
fn the_number_of_arcs_grows_with_the_third_root() {
    let curve = oriented(&lan_beams()[0]);
    let count = |tolerance: f64| arcs(&curve, tolerance).unwrap().segments.len() as f64;
    let growth = count(1e-8) / count(1e-5);
    assert!((growth - 10.0).abs() < 2.0, "{growth}");
}

#[test]
fn a_circle_is_one_pair_of_arcs_and_a_line_a_line() {
    let circle = |u: f64| {
        let (sin, cos) = maths::sin_cos(2.0 * u);
        Oriented { point_m: [cos, sin], tangent: [-sin, cos] }
    };
    assert_eq!(arcs(&circle, 1e-9).unwrap().segments.len(), 2);
    let line = |u: f64| Oriented { point_m: [3.0 * u, 4.0 * u], tangent: [0.6, 0.8] };
    let fitted = arcs(&line, 1e-9).unwrap();
    assert!(fitted.segments.iter().all(|segment| matches!(segment, Segment::Line { .. })));
}

#[test]
fn a_spline_becomes_arcs() {
    let curve = oriented(&lan_beams()[0]);
    let fitted = spline(&curve, 1e-8).unwrap().spline;
    let arcs = fitted.to_arcs(1e-6).unwrap();
    let points = points_of_arcs(fitted.control_m[0], &arcs.segments);
    assert!(farthest(&points, &curve) < 1.1e-6);
    assert!(Spline { control_m: vec![[0.0; 2]; 4], knots: Vec::new() }.to_arcs(1e-6).is_err());
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    assert!(matches!(spline(&ellipse, 0.0), Err(FitError::Tolerance { .. })));
    assert!(matches!(arcs(&ellipse, f64::NAN), Err(FitError::Tolerance { .. })));
    let hole = |u: f64| Oriented { point_m: [1.0 / (u - 0.5), 0.0], tangent: [1.0, 0.0] };
    assert!(matches!(spline(&hole, 1e-6), Err(FitError::NotFinite { parameter: 0.5 })));
    let late = |u: f64| if (0.7001..0.7009).contains(&u) { Oriented { point_m: [f64::NAN; 2], tangent: [1.0, 0.0] } } else { ellipse(u) };
    assert!(matches!(spline(&late, 1e-12), Err(FitError::NotFinite { .. })));
    // below rounding
    assert!(matches!(spline(&ellipse, 1e-19), Err(FitError::TooFine { .. })));
}
