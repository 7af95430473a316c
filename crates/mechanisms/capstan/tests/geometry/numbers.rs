//! Lengths, flat drums, and numbers that cannot be.

use std::f64::consts::TAU;

use forcewright_base::maths::{atan2, hypot};
use forcewright_capstan::geometry::{Band, Drive, Drum, GeometryError, Group, Layout, Seat, Setting, Surface, Tensioner, preload_travel_m};

use super::{BELTS, HANDS, close, example};

#[test]
fn cut_length_and_preload() {
    let drive = Drive::new(example()).expect("in range");
    let (tension, stiffness) = (200.0, 50e3);
    let loaded = drive.cable_length_m(0).expect("a cable");
    let cut = drive.cut_length_m(0, [0.020, 0.030], tension, stiffness).expect("good numbers");
    let travel = preload_travel_m(loaded, tension, stiffness).expect("good numbers");
    // What is cut, less what the anchors hold, plus the elongation fills the path.
    close(cut - 0.050 + travel, loaded, 1e-15);
    close(travel, tension / stiffness * (cut - 0.050), 1e-15);
    close(Tensioner::Screw { lead_m: 0.001 }.turn_rad(travel).expect("a lead"), TAU * travel / 0.001, 1e-12);
    close(Tensioner::Spool { radius_m: 0.004 }.turn_rad(travel).expect("a radius"), travel / 0.004, 1e-12);
    assert!(Tensioner::Screw { lead_m: 0.0 }.turn_rad(travel).is_err());
    assert!(preload_travel_m(loaded, tension, 0.0).is_err() && drive.cut_length_m(0, [-1.0, 0.0], tension, stiffness).is_err());
}

#[test]
fn flat_drums_have_no_mismatch_and_the_same_walk() {
    let grooved = Drive::new(example()).expect("in range");
    let flat = Drive::new(Layout { surface: Surface::Flat, ..example() }).expect("in range");
    let fleet = flat.fleet(0).expect("a cable");
    assert_eq!(fleet.deviation_m, [0.0; 2]);
    assert_eq!(flat.walk_m(1.0), grooved.walk_m(1.0));
    let line = flat.centre_line(0, 1.0).expect("on the travel");
    for (piece, along) in line.pieces.iter().flat_map(|piece| [0.0, 0.5, 1.0].map(|at| (piece, piece.tangent(at)))) {
        let across = atan2(along[2], hypot(along[0], along[1]));
        close(across, fleet.fleet_rad[0], 1e-14);
        assert!(piece.length_m() > 0.0);
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let refuse = |layout: Layout| Drive::new(layout).expect_err("refused");
    assert_eq!(
        refuse(Layout { centre_distance_m: 0.060, ..example() }),
        GeometryError::DrumsOverlap { centre_distance_m: 0.060, above_m: 0.010 + 0.050 }
    );
    assert!(matches!(refuse(Layout { pitch_m: f64::NAN, ..example() }), GeometryError::Number { name: "pitch", .. }));
    assert!(matches!(refuse(Layout { travel_rad: -1.0, ..example() }), GeometryError::Number { .. }));
    assert!(matches!(refuse(Layout { second_phase_rad: f64::INFINITY, ..example() }), GeometryError::Number { .. }));
    assert_eq!(refuse(Layout { starts: 0, ..example() }), GeometryError::NoStarts);
    assert_eq!(refuse(Layout { cables: vec![], ..example() }), GeometryError::NoCables);
    let error = refuse(Layout { cables: vec![[0, 4], [7, 12]], ..example() });
    assert!(matches!(error, GeometryError::Lines { cable: 1, nearest: 11, off_lines } if (off_lines + 0.958).abs() < 1e-3), "{error}");
    let drive = Drive::new(example()).expect("in range");
    assert_eq!(drive.fleet(1), Err(GeometryError::NoSuchCable { cable: 1, cables: 1 }));
    assert!(drive.centre_line(0, -1e-9).is_err() && drive.centre_line(0, f64::NAN).is_err() && drive.walk_m(5.0).is_err());
    assert!(matches!(drive.aligned_distances(0.0, 1e9), Err(GeometryError::TooMany { .. })));
    assert!(drive.aligned_distances(0.07, 0.01).expect("finite").is_empty());
    let line = drive.centre_line(0, 0.0).expect("on the travel");
    assert!(line.polyline_m(0.0).is_err() && line.polyline_m(1e-18).is_err());
    let section = Band { from_m: 0.0, to_m: 1.0 };
    assert!(drive.groove_paths(Drum::Input, Group::First, section, 1e-9).is_err());
    assert!(drive.groove_paths(Drum::Input, Group::First, Band { from_m: 1.0, to_m: 0.0 }, 0.1).is_err());
}

#[test]
fn no_input_panics() {
    // Numbers of all sizes and none, drawn by a linear congruence (Knuth, MMIX).
    let mut state = 1_u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state >> 33
    };
    let wild = [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300, 1e-300, 5e-324, 1e9, 1e-9, f64::MAX];
    let mut number = |usual: f64| match draw() % 12 {
        k @ 0..4 => wild[usize::try_from((draw() + k) % 10).expect("a digit")],
        k => usual * (0.2 + k as f64 / 6.0),
    };
    let mut built = 0;
    for i in 0..5_000 {
        let drive = Drive::new(Layout {
            input_radius_m: number(0.010),
            output_radius_m: number(0.050),
            centre_distance_m: number(0.1),
            belt: BELTS[i % 2],
            pitch_m: number(0.002),
            hand: HANDS[i / 2 % 2],
            starts: [0, 1, 5, u32::MAX][i % 4],
            extra_turns: [0, 3, u32::MAX][i % 3],
            second_phase_rad: number(0.1),
            travel_rad: number(3.0),
            guard_rad: [number(3.0), number(3.0)],
            rope_diameter_m: number(0.0015),
            surface: [Surface::Grooved, Surface::Flat][i / 4 % 2],
            setting: [Setting::Shared, Setting::Outgoing][i / 8 % 2],
            cables: vec![[0, 4], [i32::MIN, i32::MAX]],
        });
        let Ok(drive) = drive else { continue };
        built += 1;
        for near in drive.occupancy() {
            assert!(near.distance_m.is_finite() && near.pitches.is_finite(), "{:?} {near:?}", drive.layout());
        }
        let _ = (
            drive.groove_distance_m(),
            drive.aligned_distances(number(0.1), number(0.3)),
            drive.aligning_ratio(i32::MAX),
            drive.clear_cables(2, 0.0),
        );
        let _ = (drive.wall_fleet_limit_rad(Drum::Input, Seat { radius_m: number(0.0008), depth_m: number(0.0005) }), drive.fleet(1));
        if let Ok(line) = drive.centre_line(1, number(1.0)) {
            assert!(line.at(number(0.5)).point_m.iter().all(|x| !x.is_infinite()));
        }
    }
    assert!(built > 150, "{built}");
}
