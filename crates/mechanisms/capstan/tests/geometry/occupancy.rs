//! How near ropes come to each other.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths::{cbrt, cos, hypot, sin, tan};
use forcewright_capstan::geometry::{Arc, Belt, Drive, Drum, Hand, Helix, Layout, Piece, Place};

use super::{Vector, close, dot, example, norm, sub, with_lines};

#[test]
fn neighbouring_cables_meet_where_crossed_spans_pass() {
    let spans = |parts: [(usize, Arc); 2], layout: Layout| {
        let drive = Drive::new(layout).expect("in range");
        let near = drive.occupancy().into_iter().find(|near| near.parts == parts).expect("two spans");
        assert_eq!(near.place, Place::Between);
        near
    };
    let passing = |apart: i32, second_phase_rad: f64| {
        let cables = vec![[0, 4], [apart, apart + 4]];
        spans([(0, Arc::Return), (1, Arc::Outgoing)], Layout { cables, second_phase_rad, travel_rad: 1.0, ..example() })
    };
    let drive = Drive::new(example()).expect("in range");
    let gamma = drive.tangent_angle_rad();
    let inv = (tan(gamma) - gamma) / PI;
    // Both lie in planes along the axes at π/2 − γ to the line of centres, climb alike and run against each other across.
    let square = |rise: f64| rise / hypot(1.0, drive.slope() / cos(gamma));
    let phase = drive.aligning_phase_rad(0).expect("a cable");
    // On lines n + 1 apart the return span passes the next cable's outgoing one at inv γ/π of a pitch, and at 0 if the spans share that mismatch.
    close(passing(4, phase).distance_m, square(0.002 * inv), 1e-16);
    close(passing(4, 0.0).distance_m, 0.0, 1e-15);
    assert!(passing(4, phase).clearance_m < -0.99 * 0.0015);
    // One free line between them parts them.
    close(passing(5, phase).distance_m, square(0.002 * (1.0 - inv)), 1e-16);
    // A cable's own spans pass at n + 1 + inv γ/π, if no deviation is shared.
    let own = spans([(0, Arc::Outgoing), (0, Arc::Return)], Layout { second_phase_rad: phase, ..example() });
    close(own.distance_m, square(0.002 * (4.0 + inv)), 1e-16);
}

/// Distance of a point from a segment.
fn to_segment(p: Vector, a: Vector, b: Vector) -> f64 {
    let (along, from) = (sub(b, a), sub(p, a));
    let t = (dot(from, along) / dot(along, along)).clamp(0.0, 1.0);
    norm(sub(from, along.map(|x| x * t)))
}

/// Least distance of two pieces by brute force; of one piece with itself, of places more than half a turn apart.
fn brute_force(a: Piece, b: Piece, itself: bool) -> f64 {
    let points = |piece: Piece| -> Vec<Vector> {
        let count = match piece {
            Piece::Helix(h) => (h.sweep_rad.abs() * 30.0).ceil().max(2.0),
            Piece::Span(_) => 200.0,
        };
        let mut i = 0.0;
        let mut all = Vec::new();
        while i <= count {
            all.push(piece.point_m(i / count));
            i += 1.0;
        }
        all
    };
    let (first, second) = (points(a), points(b));
    // Half a turn at 30 stations per rad.
    let apart = 94;
    let mut least = f64::INFINITY;
    for (i, &p) in first.iter().enumerate() {
        for (k, pair) in second.windows(2).enumerate() {
            if !itself || k > i + apart {
                least = least.min(to_segment(p, pair[0], pair[1]));
            }
        }
    }
    least
}

fn piece_of(drive: &Drive, (cable, arc): (usize, Arc), output_rad: f64) -> Piece {
    let at = [Arc::First, Arc::Outgoing, Arc::Input, Arc::Return, Arc::Second].iter().position(|&a| a == arc).expect("listed");
    drive.centre_line(cable, output_rad).expect("on the travel").pieces[at]
}

#[test]
fn occupancy_is_that_of_brute_force() {
    let layouts = [
        Layout { cables: vec![[0, 4], [4, 8]], ..example() },
        Layout { cables: vec![[0, 4], [5, 9], [11, 15]], travel_rad: 11.0, ..example() },
        // n + 1 divides R: the second cable's end 0 runs onto the first one's after a turn.
        Layout { cables: vec![[0, 4], [4, 8]], output_radius_m: 0.040, starts: 4, travel_rad: 9.0, hand: Hand::Left, ..example() },
        Layout { cables: vec![[0, 1], [3, 4]], extra_turns: 0, travel_rad: 7.0, pitch_m: 0.015, ..example() },
        Layout { cables: vec![[0, 9], [2, 11]], belt: Belt::Open, travel_rad: 8.0, centre_distance_m: 0.07, ..example() },
    ];
    for layout in layouts {
        let drive = Drive::new(layout.clone()).expect("in range");
        let mut on_drums = 0;
        for near in drive.occupancy() {
            let [a, b] = near.parts;
            let steps = 12;
            let angles = (0..=steps).map(|i| layout.travel_rad * f64::from(i) / f64::from(steps));
            let at = |angle: f64| brute_force(piece_of(&drive, a, angle), piece_of(&drive, b, angle), a == b);
            let least = angles.map(at).fold(f64::INFINITY, f64::min);
            let step = 1.0 / 30.0;
            // A chord is inside the drum by a sagitta, and the nearest points need not be stations.
            let tolerance = 0.01 * near.distance_m + 0.050 * step * step;
            assert!((least - near.distance_m).abs() <= tolerance, "{near:?}: {least:e} by brute force");
            for angle in near.output_rad {
                close(at(angle), near.distance_m, tolerance);
            }
            close(near.clearance_m, near.distance_m - 0.0015, 1e-17);
            let place = piece_of(&drive, a, near.output_rad[0]);
            let beside = piece_of(&drive, b, near.output_rad[0]);
            on_drums += usize::from(near.place != Place::Between);
            let off = |piece: Piece| (0..=8000).map(move |i| norm(sub(piece.point_m(f64::from(i) / 8000.0), near.point_m)));
            let on = off(place).fold(f64::INFINITY, f64::min);
            // The next turn of the same part is more than half a turn from the place itself.
            let home = off(place).position(|x| x == on).expect("the least");
            let half_turn = match place {
                Piece::Helix(h) if a == b => 8000.0 * PI / h.sweep_rad.abs(),
                _ => -1.0,
            };
            let other = off(beside).enumerate().filter(|&(i, _)| (i as f64 - home as f64).abs() > half_turn).map(|(_, x)| x);
            let off = other.fold(f64::INFINITY, f64::min);
            assert!(on < 5e-4 && (off - near.distance_m).abs() < 5e-4, "{near:?}: {on:e} {off:e}");
        }
        assert!(on_drums >= 4);
    }
}

#[test]
fn occupancy_in_closed_form() {
    // One cable: its turns on the input are one pitch apart, nothing is nearer.
    let one = Drive::new(example()).expect("in range");
    let near = one.nearest().expect("turns");
    assert_eq!((near.place, near.parts), (Place::On(Drum::Input), [(0, Arc::Input); 2]));
    close(near.pitches, 1.0, 1e-12);
    close(near.distance_m, 0.002 * cos(one.helix_angle_rad()), 1e-8);
    // R = 4, n + 1 = 4: end 0 of the second cable reaches that of the first after one turn, which the guard wrap is part of.
    let layout = Layout { cables: vec![[0, 4], [4, 8]], output_radius_m: 0.040, starts: 4, travel_rad: 2.0 * PI, ..example() };
    let conflict = |layout: Layout| {
        let drive = Drive::new(layout).expect("in range");
        drive.occupancy().into_iter().find(|near| near.parts == [(0, Arc::First), (1, Arc::First)]).expect("two ends")
    };
    let near = conflict(layout.clone());
    close(near.distance_m, 0.0, 1e-12);
    close(near.output_rad[0], TAU - PI, 1e-9);
    close(near.output_rad[1], TAU, 0.0);
    // With less than a turn in all they stay apart; the tail of one is then next to the head of the other.
    let short = conflict(Layout { travel_rad: PI - 0.2, ..layout });
    close(short.distance_m, 2.0 * 0.040 * sin(0.1), 2e-5);
    close(short.pitches, short.distance_m / 0.002, 1e-12);
    // An own phase puts the second group's grooves beside the first group's.
    let two = Layout { cables: vec![[0, 4], [4, 8]], ..example() };
    let phase = Drive::new(two.clone()).expect("in range").aligning_phase_rad(0).expect("a cable");
    let shared = Drive::new(two.clone()).expect("in range").groove_distance_m().expect("grooves");
    close(shared, 0.002 * cos(one.helix_angle_rad()), 1e-8);
    let apart = Drive::new(Layout { second_phase_rad: phase, ..two }).expect("in range").groove_distance_m().expect("grooves");
    close(apart, one.landing_pitches() * 0.002 * cos(one.helix_angle_rad()), 1e-8);
}

#[test]
fn steep_turns_are_nearest_off_the_axis() {
    let steep = Layout { pitch_m: 0.02, extra_turns: 2, cables: vec![[0, 3]], ..example() };
    let drive = Drive::new(steep).expect("in range");
    let turns = drive.occupancy().into_iter().find(|near| near.parts == [(0, Arc::Input); 2]).expect("turns");
    // The least distance of the point at angle 0 from the turn above, on a fine grid; its error is of the second order.
    let distance = |t: f64| hypot(2.0 * 0.010 * sin(0.5 * t), 0.02 * (1.0 + t / TAU));
    let least = (-15_000..0).map(|i| distance(f64::from(i) * 1e-4)).fold(f64::INFINITY, f64::min);
    close(turns.distance_m, least, 1e-11);
    close(turns.pitches, 1.0, 1e-12);
    assert!(least < 0.02 * cos(drive.helix_angle_rad()) * 0.999);
    // Still steeper, a turn is nearer to its own beginning than to the next turn.
    let leaving = Drive::new(Layout { pitch_m: 0.04, ..drive.layout().clone() }).expect("in range");
    assert!(!leaving.occupancy().iter().any(|near| near.parts == [(0, Arc::Input); 2]));
}

#[test]
fn spans_keep_away_from_the_turns_on_the_drums() {
    let mut worst = 0.0_f64;
    for layout in [
        example(),
        Layout { cables: vec![[0, 4], [6, 10], [12, 16]], ..example() },
        with_lines(&Layout { belt: Belt::Open, ..example() }).layout().clone(),
        with_lines(&Layout { pitch_m: 0.012, extra_turns: 1, centre_distance_m: 0.062, ..example() }).layout().clone(),
    ] {
        let drive = Drive::new(layout.clone()).expect("in range");
        let turns =
            drive.occupancy().iter().filter(|near| near.place != Place::Between).map(|near| near.distance_m).fold(f64::INFINITY, f64::min);
        for (a, b) in (0..layout.cables.len()).flat_map(|a| (0..layout.cables.len()).map(move |b| (a, b))) {
            for (span, arc) in [1, 3].into_iter().flat_map(|span| [0, 2, 4].map(|arc| (span, arc))) {
                let [first, second] = [(a, span), (b, arc)]
                    .map(|(cable, at)| drive.centre_line(cable, 0.5 * layout.travel_rad).expect("on the travel").pieces[at]);
                let Piece::Helix(h) = second else { panic!("on a drum") };
                // A span and the turn that it continues are parted by half a turn.
                let fraction = (PI / h.sweep_rad.abs()).min(1.0);
                let cut = |from: f64, sweep: f64| {
                    Piece::Helix(Helix {
                        start_rad: h.start_rad + from * h.sweep_rad,
                        sweep_rad: sweep * h.sweep_rad,
                        start_m: h.start_m + from * h.rise_m,
                        rise_m: sweep * h.rise_m,
                        ..h
                    })
                };
                let other = if a != b || span.abs_diff(arc) != 1 {
                    second
                } else if arc > span {
                    cut(fraction, 1.0 - fraction)
                } else {
                    cut(0.0, 1.0 - fraction)
                };
                let least = brute_force(first, other, false);
                // A span that leans towards the next turn nears it while it still lies low: by at most this (see `occupancy`).
                let lean = drive.fleet(a).expect("a cable").largest_rad();
                let nearing = 0.75 * lean * cbrt(2.0 * turns * lean * h.radius_m * h.radius_m);
                assert!(least >= turns * (1.0 - 1e-6) - nearing, "{a} {b} {span} {arc}: {least:e} {turns:e} {nearing:e}");
                worst = worst.max((turns - least) / nearing);
            }
        }
    }
    // The bound is met, not just kept.
    assert!((0.9..=1.01).contains(&worst), "{worst}");
}

#[test]
fn cables_are_put_on_lines_that_keep_clear() {
    // R = 5, n = 3: n + 1 apart, spans meet; five apart, an end 0 meets the next one after a turn; six apart all is clear.
    let drive = Drive::new(example()).expect("in range");
    assert_eq!(drive.clear_cables(3, 0.0002).expect("there are"), [[0, 4], [6, 10], [12, 16]]);
    // With less than a turn on the output the fifth line is free.
    let short = Drive::new(Layout { travel_rad: 2.0, guard_rad: [1.0; 2], ..example() }).expect("in range");
    assert_eq!(short.clear_cables(2, 0.0002).expect("there are"), [[0, 4], [5, 9]]);
    assert_eq!(short.clear_cables(2, 0.1), None);
    assert_eq!(short.clear_cables(0, 0.0), None);
}
