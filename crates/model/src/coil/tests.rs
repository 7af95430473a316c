//! Coils against closed forms, sums over short chords, and scans of all pairs of places.

use std::f64::consts::{FRAC_PI_2, TAU};

use forcewright_base::maths;

use super::space::{cross, distance, dot, norm};
use super::*;

fn coil(turns: f64, pitch_m: f64) -> Coil {
    Coil {
        wire_m: 1e-3,
        radius_m: 5.5e-3,
        windings: vec![Winding::even(turns, pitch_m)],
        is_right_handed: true,
        start_rad: 0.0,
        ends: [CoilEnd::Cut, CoilEnd::Cut],
    }
}

/// Of many kinds, each sound.
fn coils() -> Vec<Coil> {
    let bent = |bend_m, length_m| (bend_m, length_m);
    let (bend_m, length_m) = bent(1.5e-3, 3e-3);
    let axial = CoilEnd::Axial { bend_m, length_m };
    let closed = vec![
        Winding::even(1.0, 1.02e-3),
        Winding { turns: 0.75, pitch_m: [1.02e-3, 3e-3] },
        Winding::even(4.3, 3e-3),
        Winding { turns: 0.75, pitch_m: [3e-3, 1.02e-3] },
        Winding::even(1.0, 1.02e-3),
    ];
    vec![
        coil(10.0, 1.1e-3),
        Coil { ends: [CoilEnd::Cut, axial], start_rad: 1.0, ..coil(7.3, 1.1e-3) },
        Coil { ends: [axial, CoilEnd::Tangential { length_m: 8e-3 }], is_right_handed: false, start_rad: -2.0, ..coil(3.25, 1.2e-3) },
        Coil {
            ends: [CoilEnd::Outward { bend_m: 2e-3, length_m: 9e-3 }, CoilEnd::Inward { bend_m: 0.8e-3, length_m: 2e-3 }],
            ..coil(2.6, 4e-3)
        },
        Coil { windings: closed, ..coil(1.0, 1.0) },
        Coil { ends: [CoilEnd::Tangential { length_m: 0.02 }; 2], ..coil(0.4, 0.0) },
        coil(0.8, 0.06),
    ]
}

/// Places of the wire, so many to each piece.
fn places(coil: &Coil, each: u32) -> Vec<WireStation> {
    let line = coil.line();
    let of_piece = |piece: &WirePiece| (0..=each).map(|k| piece.at(f64::from(k) / f64::from(each))).collect::<Vec<_>>();
    line.pieces().iter().flat_map(of_piece).collect()
}

#[test]
fn all_kinds_are_sound() {
    for (k, coil) in coils().iter().enumerate() {
        assert_eq!(coil.check(), Ok(()), "{k}");
    }
}

#[test]
fn lengths_are_those_of_helices_and_of_short_chords() {
    let simple = coil(10.0, 1.1e-3);
    assert!((simple.wire_length_m() / (10.0 * maths::hypot(TAU * 5.5e-3, 1.1e-3)) - 1.0).abs() < 1e-15);
    assert!((simple.volume_m3() / (0.25e-6 * PI * simple.wire_length_m()) - 1.0).abs() < 1e-15);
    assert!((simple.surface_m2() / (1e-3 * PI * simple.wire_length_m() + 0.5e-6 * PI) - 1.0).abs() < 1e-14);
    // The lead angle is left to bend: a right angle less that.
    let lead_rad = maths::atan2(1.1e-3, TAU * 5.5e-3);
    let [below, above] = coils()[1].ends_m();
    assert!(below.abs() < 1e-18 && (above / (1.5e-3 * (FRAC_PI_2 - lead_rad) + 3e-3) - 1.0).abs() < 1e-14);
    for coil in coils() {
        // Chords fall short by a part that falls with the square of their number.
        let sum = |each| places(&coil, each).windows(2).map(|pair| distance(pair[0].point_m, pair[1].point_m)).sum::<f64>();
        let (coarse, fine) = (sum(4000), sum(8000));
        let length_m = fine + (fine - coarse) / 3.0;
        assert!((coil.wire_length_m() / length_m - 1.0).abs() < 1e-10, "{}", coil.wire_length_m() / length_m - 1.0);
    }
    // Across the change from the rule to the closed form.
    for change in [0.0, 1e-6, 3.4e-3, 3.5e-3, 0.05] {
        let coil = Coil { windings: vec![Winding { turns: 2.0, pitch_m: [2e-3, 2e-3 + change] }], ..coil(1.0, 1.0) };
        let rule = forcewright_base::quadrature::GaussLegendre::new(60);
        let exact = 2.0 * rule.integrate(|x| maths::hypot(TAU * 5.5e-3, 2e-3 + change * x));
        assert!((coil.wire_length_m() / exact - 1.0).abs() < 1e-14, "{change}");
    }
}

#[test]
fn wires_have_no_kink_and_no_twist() {
    for coil in coils() {
        let line = coil.line();
        for pair in line.pieces().windows(2) {
            let (end, begin) = (pair[0].at(1.0), pair[1].at(0.0));
            for (a, b) in [
                (end.point_m.map(|m| m / coil.radius_m), begin.point_m.map(|m| m / coil.radius_m)),
                (end.tangent, begin.tangent),
                (end.normal, begin.normal),
            ] {
                assert!(distance(a, b) < 1e-12, "{a:?} {b:?}");
            }
        }
        for station in places(&coil, 7) {
            let WireStation { tangent, normal, binormal, .. } = station;
            assert!((norm(tangent) - 1.0).abs() < 1e-12 && (norm(normal) - 1.0).abs() < 1e-12 && dot(tangent, normal).abs() < 1e-12);
            assert!(distance(cross(normal, binormal), tangent) < 1e-12);
        }
        // The tangent is that of the curve.
        for piece in line.pieces() {
            let step = 1e-6;
            let (below, above, here) = (piece.at(0.37 - step), piece.at(0.37 + step), piece.at(0.37));
            let chord = [0, 1, 2].map(|k| above.point_m[k] - below.point_m[k]);
            assert!(norm(cross(chord, here.tangent)) < 1e-9 * norm(chord) && dot(chord, here.tangent) > 0.0);
        }
    }
}

#[test]
fn legs_point_where_they_should() {
    let all = coils();
    let last = |coil: &Coil| coil.line().pieces().last().unwrap().at(1.0);
    let first = |coil: &Coil| coil.line().pieces()[0].at(0.0);
    // Along the axis, upwards; passed upwards from the lower end too.
    assert!(distance(last(&all[1]).tangent, [0.0, 0.0, 1.0]) < 1e-12);
    assert!(distance(first(&all[2]).tangent, [0.0, 0.0, 1.0]) < 1e-12 && first(&all[2]).point_m[2] < -4e-3);
    // A leg outwards keeps the distance of its bend's radius from the axis, and goes away from it.
    let out = first(&all[3]);
    let aside = (out.point_m[0] * out.tangent[1] - out.point_m[1] * out.tangent[0]).abs();
    let radius_m = maths::hypot(out.point_m[0], out.point_m[1]);
    let lead = maths::atan2(4e-3, TAU * 5.5e-3);
    assert!((aside - 2e-3 * maths::cos(lead)).abs() < 1e-12, "{aside}");
    assert!(radius_m > 5.5e-3 + 9e-3, "{radius_m}");
    let inside = last(&all[3]);
    assert!(maths::hypot(inside.point_m[0], inside.point_m[1]) < 5.5e-3 - 2e-3);
    // Hand: seen from above, a right-handed coil rises counterclockwise.
    let ahead = |coil: &Coil| coil.line().pieces().iter().find(|p| p.kind() == WireKind::Wound).unwrap().at(0.01);
    let turn = |coil: &Coil| {
        let s = ahead(coil);
        s.point_m[0] * s.tangent[1] - s.point_m[1] * s.tangent[0]
    };
    assert!(turn(&all[0]) > 0.0 && turn(&all[2]) < 0.0);
}

#[test]
fn extents_are_those_of_points_on_the_surface() {
    let simple = coil(10.0, 1.1e-3);
    let lead = maths::atan2(1.1e-3, TAU * 5.5e-3);
    // Over the corners of both cut ends.
    assert!((simple.length_m() - (11e-3 + 1e-3 * maths::cos(lead))).abs() < 1e-15);
    for coil in coils() {
        let mut scanned = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for station in places(&coil, 3000) {
            for k in 0..90 {
                let (sin, cos) = maths::sin_cos(TAU * f64::from(k) / 90.0);
                let point = station.around_m(0.5 * coil.wire_m, [cos, sin]);
                for axis in 0..3 {
                    scanned[0][axis] = scanned[0][axis].min(point[axis]);
                    scanned[1][axis] = scanned[1][axis].max(point[axis]);
                }
            }
        }
        let extent = coil.extent_m();
        for axis in 0..3 {
            let beyond = [scanned[0][axis] - extent[0][axis], extent[1][axis] - scanned[1][axis]];
            // Never inside of what was found, and hardly outside: a ninetieth of a turn hides a part of 6e-4 of the wire's radius.
            assert!(beyond.iter().all(|b| *b > -1e-13 && *b < 1e-6), "{axis} {beyond:?}");
        }
    }
}

/// The least distance of places more than `apart_m` of wire from each other, of all pairs of many.
fn scanned_m(coil: &Coil, apart_m: f64) -> f64 {
    let line = coil.line();
    let mut all = Vec::new();
    let mut from = 0.0;
    for piece in line.pieces() {
        let count = (piece.length_m() / (0.02 * coil.wire_m)).ceil();
        let mut k = 0.0;
        while k <= count {
            all.push((from + piece.length_m() * k / count, piece.at(k / count).point_m));
            k += 1.0;
        }
        from += piece.length_m();
    }
    let mut least = f64::INFINITY;
    for (i, one) in all.iter().enumerate() {
        for other in &all[i..] {
            if other.0 - one.0 >= apart_m && (one.1[2] - other.1[2]).abs() < least {
                least = least.min(distance(one.1, other.1));
            }
        }
    }
    least
}

#[test]
fn the_wire_is_found_where_it_is_nearest_to_itself() {
    for (k, each) in coils().into_iter().enumerate() {
        // Shorter coils, for all pairs are tried.
        let mut coil = each;
        for winding in &mut coil.windings {
            winding.turns = winding.turns.min(2.3);
        }
        let bends = coil.ends.iter().filter_map(CoilEnd::bend_m);
        let windings = coil.windings.iter().map(|winding| coil.least_curvature_radius_m(winding));
        let apart_m = PI * bends.chain(windings).fold(f64::INFINITY, f64::min);
        let (found, scanned) = (clearance::nearest(&coil), scanned_m(&coil, apart_m));
        if scanned < 1.5 * coil.wire_m {
            // Places are a fiftieth of a wire apart, at distances of about one: (1/50)²/8 of it.
            assert!(found.distance_m <= scanned && found.distance_m > scanned - 2e-4 * coil.wire_m, "{k}: {} {scanned}", found.distance_m);
        } else {
            // Just where comparing begins, which no scan hits.
            assert!(found.distance_m >= scanned - 0.03 * coil.wire_m, "{k}: {} {scanned}", found.distance_m);
        }
    }
}

#[test]
fn turns_keep_the_distance_of_the_closed_form() {
    // Least of 4R² sin²(Δ/2) + (qΔ)² near a turn: to fourth order in the lead it is p cos(lead).
    let each = coil(3.0, 1.02e-3);
    let lead = maths::atan2(1.02e-3, TAU * 5.5e-3);
    let found = clearance::nearest(&each).distance_m;
    assert!((found / (1.02e-3 * maths::cos(lead)) - 1.0).abs() < 2.0 * maths::powi(lead, 4), "{found}");
    // A pitch of the wire makes turns touch, for they are a little nearer than that.
    let touching = coil(3.0, 1e-3);
    assert!(matches!(touching.check(), Err(CoilError::Touches { distance_m, .. }) if distance_m < 1e-3));
    assert!(touching.check().unwrap_err().to_string().contains("touches itself"));
}

#[test]
fn what_cannot_be_wound_is_refused() {
    let after = |change: &dyn Fn(&mut Coil)| {
        let mut coil = coil(4.0, 1.5e-3);
        change(&mut coil);
        coil.check().unwrap_err()
    };
    for wire_m in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e4] {
        assert!(matches!(after(&|c| c.wire_m = wire_m), CoilError::Wire { .. }));
    }
    for radius_m in [0.5e-3, 0.0, f64::NAN, 1e5] {
        assert!(matches!(after(&|c| c.radius_m = radius_m), CoilError::Radius { .. }));
    }
    assert_eq!(after(&|c| c.windings.clear()), CoilError::Empty);
    for turns in [0.0, f64::NAN, 1001.0, -3.0] {
        assert!(matches!(after(&|c| c.windings[0].turns = turns), CoilError::Turns { winding: 0, .. }));
    }
    for pitch_m in [-1e-3, f64::NAN, f64::INFINITY] {
        assert!(matches!(after(&|c| c.windings[0].pitch_m[1] = pitch_m), CoilError::Pitch { winding: 0, .. }));
    }
    assert!(matches!(after(&|c| c.windings.push(Winding::even(1.0, 2e-3))), CoilError::Kink { winding: 1, .. }));
    assert!(matches!(after(&|c| c.start_rad = f64::NAN), CoilError::Start { .. }));
    assert!(matches!(after(&|c| c.ends[1] = CoilEnd::Tangential { length_m: 0.0 }), CoilError::Leg { end: 1, .. }));
    let bend = |bend_m| CoilEnd::Outward { bend_m, length_m: 1e-3 };
    for bend_m in [0.5e-3, 0.0, f64::NAN] {
        assert!(matches!(after(&|c| c.ends[0] = bend(bend_m)), CoilError::Bend { end: 0, .. }));
    }
    // The pitch rises by a metre in a hundredth of a turn.
    assert!(matches!(after(&|c| c.windings = vec![Winding { turns: 0.01, pitch_m: [0.0, 1.0] }]), CoilError::Tight { winding: 0, .. }));
    // A leg inwards, through the turns opposite.
    let through = CoilEnd::Inward { bend_m: 1e-3, length_m: 12e-3 };
    assert!(matches!(after(&|c| *c = Coil { ends: [CoilEnd::Cut, through], ..coil(4.0, 1.1e-3) }), CoilError::Touches { .. }));
    // The same legs in both ends of half a turn cross each other.
    let leg = CoilEnd::Inward { bend_m: 1e-3, length_m: 5e-3 };
    assert!(matches!(after(&|c| *c = Coil { ends: [leg; 2], ..coil(0.5, 1.1e-3) }), CoilError::Touches { .. }));
}
