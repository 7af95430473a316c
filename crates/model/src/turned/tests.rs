use std::f64::consts::{FRAC_PI_2, PI, TAU};

use forcewright_base::maths;

use super::*;
use forcewright_curves::Segment;

fn close(value: f64, exact: f64, relative: f64) {
    assert!((value / exact - 1.0).abs() < relative, "{value:e} for {exact:e}");
}

fn grooved(length_m: f64, lead_m: f64, starts: u32, groove: Groove) -> Section {
    Section::Grooved(Grooved { length_m, lead_m, starts, phase_rad: 0.0, groove })
}

fn body(sections: Vec<Section>) -> Turned {
    Turned { bore_diameter_m: 0.0, sections, drillings: Vec::new() }
}

/// Pappus and Guldin: what a groove takes is its area times the way of its centroid, 2πρ, once for every spacing.
fn after_pappus(radius_m: f64, spacing_m: f64, area_m2: f64, centroid_m: f64) -> f64 {
    PI * radius_m * radius_m - TAU * centroid_m * area_m2 / spacing_m
}

#[test]
fn areas_are_those_of_pappus() {
    let (radius, spacing, seat, depth) = (0.025, 2.6e-3, 1.05e-3, 0.8e-3);
    // A segment of a circle: ½R²(φ − sin φ), its centroid 4R sin³(φ/2)/(3(φ − sin φ)) from the middle.
    let angle = 2.0 * maths::acos((seat - depth) / seat);
    let area = 0.5 * seat * seat * (angle - maths::sin(angle));
    let below = 4.0 * seat * maths::powi(maths::sin(0.5 * angle), 3) / (3.0 * (angle - maths::sin(angle)));
    let round = grooved(0.04, 5.0 * spacing, 5, Groove::round(radius, spacing, seat, depth).unwrap());
    let middle = radius - depth + seat;
    close(round.area_m2(), after_pappus(radius, spacing, area, middle - below), 1e-14);

    // A triangle, its centroid a third of the depth below the lands.
    let (opening, depth) = (0.7, 1e-3);
    let area = depth * depth * maths::tan(0.5 * opening);
    let vee = grooved(0.02, -spacing, 1, Groove::vee(radius, spacing, opening, 0.0, depth).unwrap());
    close(vee.area_m2(), after_pappus(radius, spacing, area, radius - depth / 3.0), 1e-14);

    // Half a circle with straight walls above it: a rectangle and ½πR², its centroid 4R/(3π) below the middle.
    let (seat, depth) = (0.5e-3, 0.8e-3);
    let (wide, half) = (2.0 * seat * (depth - seat), FRAC_PI_2 * seat * seat);
    let moment = wide * (radius - 0.5 * (depth - seat)) + half * (radius - depth + seat - 4.0 * seat / (3.0 * PI));
    let deep = grooved(0.02, spacing, 1, Groove::round(radius, spacing, seat, depth).unwrap());
    close(deep.area_m2(), after_pappus(radius, spacing, wide + half, moment / (wide + half)), 1e-14);
}

#[test]
fn an_undercut_takes_its_slot() {
    let (radius, spacing, seat, depth, width, slot) = (0.015, 3e-3, 1.1e-3, 0.9e-3, 0.6e-3, 0.5e-3);
    let area = |groove: Groove| grooved(0.02, spacing, 1, groove).area_m2();
    let round = area(Groove::round(radius, spacing, seat, depth).unwrap());
    let undercut = area(Groove::undercut(radius, spacing, [seat, depth], [width, slot]).unwrap());
    // The slot is a rectangle without the segment of the seat in it.
    let bottom = radius - depth;
    let angle = 2.0 * maths::asin(0.5 * width / seat);
    let segment = 0.5 * seat * seat * (angle - maths::sin(angle));
    let below = 4.0 * seat * maths::powi(maths::sin(0.5 * angle), 3) / (3.0 * (angle - maths::sin(angle)));
    let edge = seat - seat * maths::cos(0.5 * angle);
    let moment = width * (edge + slot) * (bottom + 0.5 * (edge - slot)) - segment * (bottom + seat - below);
    close(round - undercut, TAU * moment / spacing, 1e-10);
}

/// Around a vee with a round bottom the flanks touch the arc, and lie on the flanks of the sharp vee that is deeper.
#[test]
fn arcs_at_the_bottom_of_a_vee_touch_its_flanks() {
    let (radius, spacing, opening, bottom, depth) = (0.012, 2.5e-3, 0.7, 0.2e-3, 1e-3);
    let groove = Groove::vee(radius, spacing, opening, bottom, depth).unwrap();
    let [Segment::Line { to_m: low }, Segment::Arc { centre_m, .. }, ..] = groove.segments.as_slice() else { panic!("{groove:?}") };
    let flank = [low[0] - groove.start_m[0], low[1] - groove.start_m[1]];
    let spoke = [low[0] - centre_m[0], low[1] - centre_m[1]];
    assert!((flank[0] * spoke[0] + flank[1] * spoke[1]).abs() < 1e-18);
    close(maths::atan2(flank[0], -flank[1]), 0.5 * opening, 1e-12);
    close(maths::hypot(spoke[0], spoke[1]), bottom, 1e-12);
    close(groove.radii_m()[0], radius - depth, 1e-14);
    assert_eq!(Groove::vee(radius, spacing, opening, 0.0, depth).unwrap().segments.len(), 3);
}

/// Over whole spacings every half plane sees the same, and its area turned about the axis is the volume (Pappus).
#[test]
fn half_sections_turned_about_the_axis_make_the_volume() {
    let round = Groove::round(0.018, 3e-3, 1.05e-3, 0.8e-3).unwrap();
    let undercut = Groove::undercut(0.015, 3e-3, [1.1e-3, 0.9e-3], [0.6e-3, 0.5e-3]).unwrap();
    for lead_m in [6e-3, -6e-3] {
        let sections = vec![
            grooved(0.012, lead_m, 2, round.clone()),
            Section::Plain { length_m: 0.002, radius_m: 0.0165 },
            grooved(0.009, lead_m / 2.0, 1, undercut.clone()),
        ];
        let turned = Turned { bore_diameter_m: 0.01, ..body(sections) };
        for angle_rad in [0.0, 0.4, 2.0, -1.0, 3.9, 100.0] {
            let half = turned.half_section(angle_rad).unwrap();
            half.check(1e-9).unwrap();
            assert!(half.area_m2() > 0.0, "counterclockwise");
            // ∬ρ dA of a polygon, by its sides: −∮½ρ² dz.
            let corners = half.tessellate(1e-9);
            let next = corners.iter().cycle().skip(1);
            let side = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]) * (a[1] * a[1] + a[1] * b[1] + b[1] * b[1]) / 6.0;
            let moment: f64 = corners.iter().zip(next).map(side).sum();
            close(TAU * moment, turned.volume_m3(), 2e-6);
        }
    }
}

/// Groove k is at its angle at the lower end of its section, and a lead higher after a turn.
#[test]
fn grooves_are_where_they_are_said_to_be() {
    let groove = Groove::round(0.025, 2.6e-3, 1.05e-3, 0.8e-3).unwrap();
    for lead_m in [13e-3, -13e-3] {
        let section = Grooved { length_m: 0.04, lead_m, starts: 5, phase_rad: 0.3, groove: groove.clone() };
        let turned = body(vec![Section::Plain { length_m: 0.003, radius_m: 0.03 }, Section::Grooved(section)]);
        for k in 0..5 {
            for z in [0.0, 0.004, 0.0177] {
                let angle_rad = 0.3 + TAU * (z / lead_m + f64::from(k) / 5.0);
                let half = turned.half_section(angle_rad).unwrap();
                // The bottom of the groove and no more: inside just below, outside just above.
                let at = |radius_m: f64| half.contains([0.003 + z + 1e-7, radius_m]);
                assert!(at(0.0242 - 2e-8) && !at(0.0242 + 2e-8), "groove {k} at {z} m");
            }
        }
    }
}

#[test]
fn volumes_and_masses_are_the_sum_of_sections() {
    let turned = Turned {
        bore_diameter_m: 0.01,
        sections: vec![Section::Plain { length_m: 0.01, radius_m: 0.02 }, Section::Plain { length_m: 0.03, radius_m: 0.012 }],
        drillings: Vec::new(),
    };
    turned.check().unwrap();
    close(turned.volume_m3(), PI * (4e-4 * 0.01 + 1.44e-4 * 0.03 - 2.5e-5 * 0.04), 1e-14);
    assert_eq!((turned.largest_radius_m().to_bits(), turned.steps_m().len()), (0.02_f64.to_bits(), 3));
}

#[test]
fn what_cannot_be_turned_is_refused() {
    let plain = |length_m: f64, radius_m: f64| Section::Plain { length_m, radius_m };
    let groove = || Groove::round(0.02, 3e-3, 1.05e-3, 0.8e-3).unwrap();
    let error = |sections: Vec<Section>| body(sections).check().unwrap_err();
    assert_eq!(error(Vec::new()), TurnedError::Empty);
    for wrong in [0.0, -0.01, f64::NAN, f64::INFINITY, 1e3, 1e-9] {
        assert!(matches!(error(vec![plain(wrong, 0.01)]), TurnedError::Length { section: 0, .. }));
        assert!(matches!(error(vec![plain(0.1, wrong)]), TurnedError::Radius { section: 0, .. }));
    }
    for lead_m in [0.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(error(vec![grooved(0.1, lead_m, 1, groove())]), TurnedError::Lead { section: 0, .. }));
    }
    assert!(matches!(error(vec![grooved(0.1, 3e-3, 0, groove())]), TurnedError::Starts { starts: 0, .. }));
    assert!(matches!(error(vec![grooved(0.1, 3.0, 1001, groove())]), TurnedError::Starts { .. }));
    assert!(matches!(error(vec![grooved(0.1, 1e-9, 1, groove())]), TurnedError::Spacing { .. }));
    assert!(matches!(error(vec![grooved(100.0, 3e-3, 1, groove())]), TurnedError::Spacing { .. }));
    // The spacing of the grooves is not that of the profile.
    assert!(matches!(error(vec![grooved(0.1, 6e-3, 1, groove())]), TurnedError::Groove { error: GrooveError::Open { .. }, .. }));
    // From 19.2 to 20 mm.
    let beside = |radius_m: f64| body(vec![plain(0.01, radius_m), grooved(0.1, -3e-3, 1, groove())]).check();
    assert!(beside(0.0191).is_ok() && beside(0.0201).is_ok());
    for radius_m in [0.0192, 0.0195, 0.02, 0.020_000_5] {
        assert!(matches!(beside(radius_m), Err(TurnedError::Step { section: 0, .. })), "{radius_m}");
    }
    let bore = |bore_diameter_m: f64| Turned { bore_diameter_m, ..body(vec![grooved(0.1, 3e-3, 1, groove())]) }.check();
    assert!(bore(0.0383).is_ok());
    for wrong in [0.0384, 0.039, 1.0, -0.01, f64::NAN] {
        assert!(matches!(bore(wrong), Err(TurnedError::Bore { section: 0, .. })), "{wrong}");
    }
    let drilled = |z_m: f64, diameter_m: f64| {
        let drilling = Drilling { z_m, angle_rad: 0.0, diameter_m, depth_m: 0.001, purpose: String::new() };
        Turned { drillings: vec![drilling], ..body(vec![plain(0.1, 0.01)]) }.check()
    };
    assert!(drilled(0.05, 0.001).is_ok());
    assert_eq!(drilled(0.11, 0.001), Err(TurnedError::Drilling { drilling: 0 }));
    assert_eq!(drilled(0.05, f64::NAN), Err(TurnedError::Drilling { drilling: 0 }));
}

#[test]
fn profiles_that_no_tool_can_cut_are_refused() {
    let line = |z: f64, r: f64| Segment::Line { to_m: [z, r] };
    let arc = |to_m: [f64; 2], centre_m: [f64; 2], counterclockwise: bool| Segment::Arc { to_m, centre_m, counterclockwise };
    let check = |segments: Vec<Segment>| Groove { start_m: [0.0, 0.01], segments }.check(3e-3).unwrap_err();
    assert_eq!(check(vec![line(3e-3, 0.01)]), GrooveError::TooFew);
    // It crosses itself: back along the axis.
    let crossing = vec![line(2e-3, 0.009), line(1e-3, 0.009), line(2e-3, 0.01), line(3e-3, 0.01)];
    assert_eq!(check(crossing), GrooveError::Backwards { segment: 1 });
    assert_eq!(check(vec![line(0.0, 0.009), line(0.0, 0.01), line(3e-3, 0.01)]), GrooveError::Backwards { segment: 1 });
    // An arc wider below its ends than between them.
    let ball = arc([1e-3, 0.01], [0.5e-3, 0.0095], true);
    assert_eq!(check(vec![ball, line(3e-3, 0.01)]), GrooveError::Backwards { segment: 0 });
    let off = check(vec![arc([1e-3, 0.01], [0.6e-3, 0.011], true), line(3e-3, 0.01)]);
    assert!(matches!(off, GrooveError::NotCircular { segment: 0, .. }), "{off}");
    assert_eq!(check(vec![line(1e-3, f64::NAN), line(3e-3, 0.01)]), GrooveError::Invalid { segment: 0 });
    assert_eq!(check(vec![line(0.0, 0.01), line(3e-3, 0.01)]), GrooveError::NoLength { segment: 0 });
    assert!(matches!(check(vec![line(1e-3, 0.009), line(3e-3, 0.009)]), GrooveError::Open { .. }));
    assert!(matches!(Groove::round(0.02, 2e-3, 1.05e-3, 0.8e-3), Err(GrooveError::NoLand { .. })));
    assert!(matches!(Groove::round(0.02, 3e-3, 1e-3, 0.03), Err(GrooveError::Measure { name: "the depth", .. })));
    assert!(Groove::round(f64::NAN, 3e-3, 1e-3, 1e-3).is_err() && Groove::round(0.02, 3e-3, f64::NAN, 1e-3).is_err());
    assert!(Groove::vee(0.02, 3e-3, PI, 0.0, 1e-3).is_err() && Groove::vee(0.02, 3e-3, 0.5, 5e-3, 1e-3).is_err());
    assert!(Groove::undercut(0.02, 3e-3, [1e-3, 1e-3], [2.1e-3, 1e-3]).is_err());
    assert!(Groove::undercut(0.02, 3e-3, [1e-3, 1e-3], [0.5e-3, 0.019]).is_err());
}

#[test]
fn polar_moments_are_those_of_closed_forms() {
    let (radius, spacing, length) = (0.025, 2.6e-3, 0.04);
    let tube = |out: f64, bore: f64| 0.5 * PI * (maths::powi(out, 4) - maths::powi(bore, 4)) * length;
    let plain = Turned { bore_diameter_m: 0.01, ..body(vec![Section::Plain { length_m: length, radius_m: radius }]) };
    close(plain.polar_moment_m5(), tube(radius, 0.005), 1e-14);

    // A triangle that narrows from the lands to its tip: ∫ 2πr³ w(r) dr, w = width (r − tip)/depth.
    let (opening, depth) = (0.7, 1e-3);
    let (width, tip) = (2.0 * depth * maths::tan(0.5 * opening), radius - depth);
    let taken = |r: f64| maths::powi(r, 5) / 5.0 - tip * maths::powi(r, 4) / 4.0;
    let missing = TAU * width / depth * (taken(radius) - taken(tip)) * length / spacing;
    let vee = body(vec![grooved(length, spacing, 1, Groove::vee(radius, spacing, opening, 0.0, depth).unwrap())]);
    close(vee.polar_moment_m5(), tube(radius, 0.0) - missing, 1e-12);

    // Round, by Simpson's rule over the angle of its arc.
    let (seat, depth) = (1.05e-3, 0.8e-3);
    let (middle, half) = (radius - depth + seat, maths::acos((seat - depth) / seat));
    let slice = |angle: f64| {
        let cos = maths::cos(angle);
        maths::powi(middle - seat * cos, 4) * seat * cos
    };
    let steps = 2000_u32;
    let step = 2.0 * half / f64::from(steps);
    let weight = |i: u32| {
        if i == 0 || i == steps {
            1.0
        } else if i % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    let arc: f64 = (0..=steps).map(|i| weight(i) * slice(-half + step * f64::from(i))).sum::<f64>() * step / 3.0;
    let land = spacing - 2.0 * seat * maths::sin(half);
    let round = body(vec![grooved(length, -5.0 * spacing, 5, Groove::round(radius, spacing, seat, depth).unwrap())]);
    close(round.polar_moment_m5(), 0.5 * PI * (arc + land * maths::powi(radius, 4)) / spacing * length, 1e-12);
}
