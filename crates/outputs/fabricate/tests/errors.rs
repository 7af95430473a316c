//! Parts that cannot be made are refused, with what is wrong and where.

use forcewright_curves::{Profile, Segment};
use forcewright_fabricate::{Boundary, Error, Format, Options, Place, Problem, write};
use forcewright_model::{Hole, Part, Plate};

#[allow(dead_code, unreachable_pub, missing_docs, reason = "shared with an example and other tests, which use all of it")]
mod common;

use common::{arc, circle, line, rounded, spline};

/// 40 mm by 30 mm with a cutout and a hole.
fn sound() -> Part {
    let mut part = common::part("sound", 0.003, rounded(0.04, 0.03, 0.002));
    let plate = common::plate_mut(&mut part);
    plate.cutouts = vec![circle([0.01, 0.01], 0.004, false)];
    plate.holes = vec![Hole { centre_m: [0.03, 0.02], diameter_m: 0.004, purpose: String::new() }];
    part
}

/// The error of a sound part after one change; the same for every format.
#[allow(clippy::unwrap_used, reason = "test code")]
fn after(change: impl Fn(&mut Plate)) -> Error {
    let mut part = sound();
    change(common::plate_mut(&mut part));
    let errors: Vec<Error> = Format::ALL.iter().map(|&format| write(&part, format, &Options::default()).unwrap_err()).collect();
    assert!(errors.iter().all(|error| error.to_string() == errors[0].to_string()), "{errors:?}");
    errors[0].clone()
}

const OUTLINE: Place = Place::Boundary(Boundary::Outline);
const CUTOUT: Place = Place::Boundary(Boundary::Cutout(0));
const HOLE: Place = Place::Boundary(Boundary::Hole(0));

#[test]
fn a_sound_part_is_written() {
    for format in Format::ALL {
        write(&sound(), format, &Options::default()).unwrap();
    }
}

#[test]
fn open_and_reversed_profiles_are_refused() {
    let error = after(|part| part.outline.segments[7] = line(0.002, 0.0001));
    assert_eq!(error.place, OUTLINE);
    assert!(matches!(error.problem, Problem::NotClosed { gap_m } if (gap_m - 1e-4).abs() < 1e-12), "{error}");
    let error = after(|part| part.cutouts[0] = circle([0.01, 0.01], 0.004, true));
    assert_eq!(error, Error { place: CUTOUT, problem: Problem::Direction });
    assert_eq!(error.to_string(), "cutout 1: runs the wrong way: the outline must be counterclockwise, cutouts clockwise");
    let error = after(|part| part.outline = circle([0.02, 0.015], 0.02, false));
    assert_eq!(error, Error { place: OUTLINE, problem: Problem::Direction });
}

#[test]
fn profiles_that_enclose_nothing_are_refused() {
    let start_m = [0.01, 0.01];
    let cutout = |segments: Vec<Segment>| after(|part| part.cutouts[0] = Profile { start_m, segments: segments.clone() });
    assert_eq!(cutout(vec![]), Error { place: CUTOUT, problem: Problem::TooFewSegments });
    assert_eq!(cutout(vec![line(0.02, 0.01), line(0.01, 0.01)]), Error { place: CUTOUT, problem: Problem::NoArea });
    let nowhere = Error { place: Place::Segment(Boundary::Cutout(0), 1), problem: Problem::NoLength };
    assert_eq!(cutout(vec![line(0.02, 0.01), line(0.02, 0.01), line(0.01, 0.01)]), nowhere);
    assert_eq!(cutout(vec![line(0.02, 0.01), arc([0.02, 0.01], [0.03, 0.01], true), line(0.01, 0.01)]), nowhere);
    let point = Segment::Spline(spline(vec![start_m; 6], &[]));
    assert_eq!(cutout(vec![point]), Error { place: Place::Segment(Boundary::Cutout(0), 0), problem: Problem::NoLength });
}

#[test]
fn numbers_that_are_none_are_refused() {
    for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let segment = |index| Place::Segment(Boundary::Outline, index);
        let not_finite = |place| Error { place, problem: Problem::NotFinite };
        assert_eq!(after(|part| part.outline.start_m[1] = wrong), not_finite(OUTLINE));
        assert_eq!(after(|part| part.outline.segments[2] = line(wrong, 0.01)), not_finite(segment(2)));
        assert_eq!(after(|part| part.outline.segments[1] = arc([0.04, 0.002], [0.038, wrong], true)), not_finite(segment(1)));
        assert_eq!(after(|part| part.holes[0].centre_m[0] = wrong), not_finite(HOLE));
        let mut curve = spline(vec![[0.002, 0.0], [0.01, 0.001], [0.02, -0.001], [0.038, 0.0]], &[]);
        curve.control_m[1][0] = wrong;
        assert_eq!(after(|part| part.outline.segments[0] = Segment::Spline(curve.clone())), not_finite(segment(0)));
        let error = after(|part| part.depth_m = wrong);
        assert!(error.place == Place::Part && matches!(error.problem, Problem::Depth { .. }), "{error}");
        let error = after(|part| part.holes[0].diameter_m = wrong);
        assert!(error.place == HOLE && matches!(error.problem, Problem::Diameter { .. }), "{error}");
    }
    assert_eq!(after(|part| part.outline.start_m[1] = 2e3), Error { place: OUTLINE, problem: Problem::TooFar });
    for depth_m in [0.0, -0.003, 1e-9] {
        assert_eq!(after(|part| part.depth_m = depth_m), Error { place: Place::Part, problem: Problem::Depth { depth_m } });
    }
}

#[test]
fn arcs_and_splines_that_are_none_are_refused() {
    let first = Place::Segment(Boundary::Outline, 1);
    let error = after(|part| part.outline.segments[1] = arc([0.04, 0.002], [0.0381, 0.002], true));
    assert_eq!(error.place, first);
    assert!(matches!(error.problem, Problem::NotCircular { .. }), "{error}");
    let good = spline(vec![[0.038, 0.0], [0.039, 0.0], [0.04, 0.0005], [0.04, 0.001], [0.04, 0.002]], &[]);
    let with = |change: &dyn Fn(&mut forcewright_curves::Spline)| {
        let mut curve = good.clone();
        change(&mut curve);
        after(|part| part.outline.segments[1] = Segment::Spline(curve.clone()))
    };
    let knots = Error { place: first, problem: Problem::SplineKnots };
    assert_eq!(with(&|curve| curve.knots[4] = -2.0), knots);
    assert_eq!(with(&|curve| curve.knots[3] = -0.5), knots);
    assert_eq!(with(&|curve| curve.knots[4] = 3.0), knots);
    assert_eq!(with(&|curve| curve.knots.fill(1.0)), knots);
    assert_eq!(with(&|curve| curve.knots[8] = 1e308), knots);
    let counts = Problem::SplineCounts { control: 5, knots: 8 };
    assert_eq!(with(&|curve| curve.knots.truncate(8)), Error { place: first, problem: counts });
    assert!(matches!(with(&|curve| curve.control_m.clear()).problem, Problem::SplineCounts { control: 0, .. }));
    let error = with(&|curve| curve.control_m[0][1] = -0.0001);
    assert!(error.place == first && matches!(error.problem, Problem::Apart { .. }), "{error}");
}

#[test]
fn boundaries_that_meet_or_lie_elsewhere_are_refused() {
    let meets = |place, other| Error { place, problem: Problem::Meets(other) };
    let hole = |x: f64, y: f64| after(|part| part.holes[0].centre_m = [x, y]);
    let crossing = hole(0.04, 0.015);
    assert_eq!(crossing, meets(HOLE, Boundary::Outline));
    let crossing = hole(0.013, 0.012);
    assert_eq!(crossing, meets(HOLE, Boundary::Cutout(0)));
    // A corner on a side: the hole touches the right edge from inside.
    let touching = hole(0.038, 0.015);
    assert_eq!(touching, meets(HOLE, Boundary::Outline));
    assert_eq!(hole(0.05, 0.015), Error { place: HOLE, problem: Problem::Misplaced });
    assert_eq!(hole(0.01, 0.01), Error { place: HOLE, problem: Problem::Misplaced });
    let error = after(|part| {
        part.outline.segments[4] = line(0.03, -0.01);
        part.outline.segments.insert(5, line(0.002, 0.03));
    });
    assert_eq!(error, Error { place: OUTLINE, problem: Problem::MeetsItself });
    let equal = after(|part| part.cutouts.push(part.cutouts[0].clone()));
    assert_eq!(equal, meets(Place::Boundary(Boundary::Cutout(1)), Boundary::Cutout(0)));
}

#[test]
fn options_out_of_range_are_refused() {
    for value in [0.0, -1e-6, 1.0, f64::NAN, f64::INFINITY, 1e-12] {
        // Elements may be as long as a metre.
        let element_m = if value.total_cmp(&1.0).is_eq() { 1.1 } else { value };
        for options in [
            Options { arc_error_m: value, ..Options::default() },
            Options { facet_error_m: value, ..Options::default() },
            Options { element_m: Some(element_m), ..Options::default() },
        ] {
            let error = write(&sound(), Format::Dxf, &options).unwrap_err();
            assert!(error.place == Place::Options && matches!(error.problem, Problem::Option { .. }), "{error}");
        }
    }
}
