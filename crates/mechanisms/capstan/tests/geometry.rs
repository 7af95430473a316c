//! Geometry of cable drives, measured on paths and grooves that are constructed in space.

#![allow(clippy::float_cmp, reason = "mirror images have the same bits")]

use std::f64::consts::{PI, TAU};

use forcewright_base::maths::{acos, atan2, cos, hypot, sin, tan};
use forcewright_capstan::geometry::{
    Band, Belt, CentreLine, Drive, Drum, GeometryError, Group, Hand, Layout, Piece, Seat, Setting, Surface,
};

#[path = "geometry/numbers.rs"]
mod numbers;
#[path = "geometry/occupancy.rs"]
mod occupancy;

type Vector = [f64; 3];

const BELTS: [Belt; 2] = [Belt::Crossed, Belt::Open];
const HANDS: [Hand; 2] = [Hand::Right, Hand::Left];

/// The theory's example: r 10/50 mm, d 65 mm, p 2 mm, five starts, n = 3.
fn example() -> Layout {
    Layout {
        input_radius_m: 0.010,
        output_radius_m: 0.050,
        centre_distance_m: 0.065,
        belt: Belt::Crossed,
        pitch_m: 0.002,
        hand: Hand::Right,
        starts: 5,
        extra_turns: 3,
        second_phase_rad: 0.0,
        travel_rad: 1.5 * PI,
        guard_rad: [PI, 0.75 * PI],
        rope_diameter_m: 0.0015,
        surface: Surface::Grooved,
        setting: Setting::Shared,
        cables: vec![[0, 4]],
    }
}

/// A layout whose only cable ends on the line next to where it lands.
fn with_lines(layout: &Layout) -> Drive {
    let flat = Drive::new(Layout { surface: Surface::Flat, ..layout.clone() }).expect("flat drums accept any lines");
    let apart = i32::try_from(flat.nearest_lines_apart()).expect("small");
    Drive::new(Layout { cables: vec![[0, apart]], ..layout.clone() }).expect("in range")
}

/// The example at a centre distance where both spans are in line, for a belt and a hand.
fn aligned(belt: Belt, hand: Hand) -> Drive {
    let start = with_lines(&Layout { belt, hand, ..example() });
    let found = start.aligned_distances(0.061, 0.2).expect("finite");
    with_lines(&Layout { centre_distance_m: found[0].centre_distance_m, ..start.layout().clone() })
}

fn example_mismatch() -> f64 {
    Drive::new(example()).expect("in range").mismatch_pitches(0).expect("a cable")
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Angle between two directions, exact for small ones.
fn angle(a: Vector, b: Vector) -> f64 {
    atan2(norm(cross(a, b)), dot(a, b))
}

fn close(got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance, "got {got:e}, want {want:e}, off by {:e}", got - want);
}

fn output_angles(drive: &Drive) -> impl Iterator<Item = f64> {
    let travel = drive.layout().travel_rad;
    (0..=8).map(move |i| travel * f64::from(i) / 8.0)
}

/// Axial distance of a point in space from the nearest groove that is cut in a drum: one of the paths of the tool, turned with the drum.
fn off_groove(drive: &Drive, drum: Drum, group: Group, point: Vector, output_rad: f64) -> f64 {
    let [input, output] = drive.turned_rad(output_rad).expect("on the travel");
    let (axis, turned) = if drum == Drum::Input { (0.0, input) } else { (drive.layout().centre_distance_m, output) };
    let on_drum = atan2(point[1], point[0] - axis) - turned;
    let section = Band { from_m: -0.3, to_m: 0.3 };
    let paths = drive.groove_paths(drum, group, section, 0.5).expect("a good section");
    let mut least = f64::INFINITY;
    for path in &paths {
        let (first, last) = (path.points[0], path.points[path.points.len() - 1]);
        let lead = (last[1] - first[1]) / (last[0] - first[0]) * TAU;
        let z = first[1] + (on_drum - first[0]) / TAU * lead;
        let turns = ((point[2] - z) / lead).round();
        let off = point[2] - z - turns * lead;
        if off.abs() < least.abs() {
            least = off;
        }
    }
    least
}

/// The five pieces with the drum and the group of grooves that they lie in.
fn on_drums(line: &CentreLine) -> [(Piece, Drum, Group); 3] {
    [
        (line.pieces[0], Drum::Output, Group::First),
        (line.pieces[2], Drum::Input, Group::First),
        (line.pieces[4], Drum::Output, Group::Second),
    ]
}

#[test]
fn spans_touch_both_helices_where_they_are_in_line() {
    for (belt, hand) in BELTS.into_iter().flat_map(|belt| HANDS.map(|hand| (belt, hand))) {
        let drive = aligned(belt, hand);
        for output_rad in output_angles(&drive) {
            let line = drive.centre_line(0, output_rad).expect("on the travel");
            for pair in line.pieces.windows(2) {
                assert!(norm(sub(pair[0].point_m(1.0), pair[1].point_m(0.0))) <= 1e-15, "{belt:?} {hand:?}: the pieces part");
                let bend = angle(pair[0].tangent(1.0), pair[1].tangent(0.0));
                assert!(bend <= 1e-13, "{belt:?} {hand:?} at {output_rad}: {bend:e} rad");
            }
        }
    }
}

#[test]
fn the_rope_lies_in_the_grooves_over_the_travel() {
    for (belt, hand) in BELTS.into_iter().flat_map(|belt| HANDS.map(|hand| (belt, hand))) {
        let drives = [
            aligned(belt, hand),
            with_lines(&Layout { belt, hand, ..example() }),
            with_lines(&Layout { belt, hand, second_phase_rad: 0.3, setting: Setting::Outgoing, ..example() }),
            with_lines(&Layout { belt, hand, output_radius_m: 0.0347, starts: 3, extra_turns: 1, ..example() }),
        ];
        for (drive, output_rad) in drives.iter().flat_map(|drive| output_angles(drive).map(move |angle| (drive, angle))) {
            let line = drive.centre_line(0, output_rad).expect("on the travel");
            for (piece, drum, group) in on_drums(&line) {
                for i in 0..=40 {
                    let off = off_groove(drive, drum, group, piece.point_m(f64::from(i) / 40.0), output_rad);
                    assert!(off.abs() <= 1e-14, "{belt:?} {hand:?} {drum:?} {group:?}: {off:e} m off its groove");
                }
            }
        }
    }
}

/// A cable that leaves the first groove and keeps its slope, constructed without the drive's tangent angle: (where it reaches the output
/// again, direction).
fn unguided(drive: &Drive) -> Vector {
    let l = drive.layout();
    let (r1, r2, d) = (l.input_radius_m, l.output_radius_m, l.centre_distance_m);
    let sigma = if l.belt == Belt::Crossed { 1.0 } else { -1.0 };
    // The input's tangent point by bisection: the tangent there is at a distance r2 from the output's axis, on its own side.
    let (mut low, mut high) = (1e-9, PI - 1e-9);
    for _ in 0..200 {
        let phi = 0.5 * (low + high);
        // Signed distance of the output's axis from the tangent at phi, towards the outside of the input.
        let off = d * cos(phi) - r1;
        if off > sigma * r2 { low = phi } else { high = phi }
    }
    let phi = 0.5 * (low + high);
    let out = [d - sigma * r2 * cos(phi), -sigma * r2 * sin(phi)];
    let span = hypot(out[0] - r1 * cos(phi), out[1] - r1 * sin(phi));
    let wrap = TAU * f64::from(l.extra_turns + 1) - 2.0 * phi;
    let horizontal = 2.0 * span + r1 * wrap;
    let up = if l.hand == Hand::Right { 1.0 } else { -1.0 };
    [out[0], -out[1], up * horizontal * l.pitch_m / (TAU * r1)]
}

#[test]
fn a_cable_without_deviations_lands_off_its_groove_by_the_mismatch() {
    for (belt, hand) in BELTS.into_iter().flat_map(|belt| HANDS.map(|hand| (belt, hand))) {
        for d in [0.0605, 0.065, 0.08, 0.1, 0.3] {
            let drive = with_lines(&Layout { belt, hand, centre_distance_m: d, setting: Setting::Outgoing, ..example() });
            let up = if hand == Hand::Right { 1.0 } else { -1.0 };
            let off = up * off_groove(&drive, Drum::Output, Group::Second, unguided(&drive), 0.0) / 0.002;
            let mismatch = drive.mismatch_pitches(0).expect("a cable");
            close(off, mismatch, 1e-11);
            let bend = |at: usize| {
                let line = drive.centre_line(0, 1.0).expect("on the travel");
                angle(line.pieces[at].tangent(1.0), line.pieces[at + 1].tangent(0.0))
            };
            // Set by the outgoing span, the whole mismatch is in the return span, the same at both of its grooves.
            let fleet = drive.fleet(0).expect("a cable");
            assert!(fleet.fleet_rad[0].abs() <= 1e-16 && bend(0) <= 1e-13 && bend(1) <= 1e-13);
            close(fleet.deviation_pitches[1], -mismatch, 1e-14);
            close(bend(2), fleet.fleet_rad[1].abs(), 1e-13);
            close(bend(3), fleet.fleet_rad[1].abs(), 1e-13);
        }
    }
}

#[test]
fn spans_leave_their_grooves_by_the_fleet_angle() {
    for belt in BELTS {
        let drive = with_lines(&Layout { belt, centre_distance_m: 0.075, ..example() });
        let line = drive.centre_line(0, 0.5).expect("on the travel");
        let fleet = drive.fleet(0).expect("a cable");
        close(fleet.fleet_rad[0], fleet.fleet_rad[1], 1e-15);
        close(fleet.fleet_rad[0], drive.shared_fleet_rad(0).expect("a cable"), 1e-15);
        for joint in 0..4 {
            let bend = angle(line.pieces[joint].tangent(1.0), line.pieces[joint + 1].tangent(0.0));
            close(bend, fleet.largest_rad(), 1e-13);
        }
        // Half of the mismatch is taken by moving the input.
        close(drive.input_shift_m(), -0.5 * drive.mismatch_pitches(0).expect("a cable") * 0.002, 1e-17);
        // Measured against the groove under the span: it leaves by x tan(fleet)/cos β at first.
        let (Piece::Span(span), Drum::Output) = (line.pieces[1], Drum::Output) else { panic!("a span") };
        let x = 1e-5;
        let fraction = x / drive.free_span_m();
        let off = off_groove(&drive, Drum::Output, Group::First, Piece::Span(span).point_m(fraction), 0.5);
        let slope = drive.slope();
        let want = x * (tan(drive.helix_angle_rad() + fleet.fleet_rad[0]) - slope);
        close(off, want, 1e-6 * want.abs());
    }
}

/// How far a rope stands in the walls of a round groove along a drum and the first part of a span, m: largest distance of its surface
/// beyond the seat, below the land. The seat's radius is 1.06 of the rope's, the groove 0.375 rope diameters deep.
fn wall_overlap(drive: &Drive, joint: usize) -> f64 {
    let l = drive.layout();
    let line = drive.centre_line(0, 0.4 * l.travel_rad).expect("on the travel");
    // The helix and the span that meet there, walked away from the helix.
    let (helix, span, out) = if joint.is_multiple_of(2) {
        (line.pieces[joint], line.pieces[joint + 1], true)
    } else {
        (line.pieces[joint + 1], line.pieces[joint], false)
    };
    let Piece::Helix(h) = helix else { panic!("a helix") };
    let rope = 0.5 * l.rope_diameter_m;
    let seat = 1.06 * rope;
    let top = h.radius_m - rope + 0.375 * l.rope_diameter_m;
    let middle = h.radius_m + seat - rope;
    let lead = h.rise_m / h.sweep_rad;
    let mut worst = f64::NEG_INFINITY;
    let mut station = |piece: Piece, fraction: f64| {
        let (centre, along) = (piece.point_m(fraction), piece.tangent(fraction));
        let side = [along[1], -along[0], 0.0].map(|x| x / hypot(along[0], along[1]));
        let other = cross(along, side);
        for i in 0..360 {
            let turn = TAU * f64::from(i) / 360.0;
            let point: Vector = std::array::from_fn(|k| centre[k] + rope * (cos(turn) * side[k] + sin(turn) * other[k]));
            let from_axis = hypot(point[0] - h.axis_m, point[1]);
            if from_axis > top {
                continue;
            }
            // Distance from the middle line of the seat by Newton's method on the angle.
            let phi = atan2(point[1], point[0] - h.axis_m);
            let rough = h.start_m + lead * (phi - h.start_rad);
            let z = rough + TAU * lead * ((point[2] - rough) / (TAU * lead)).round();
            let mut u = 0.0;
            for _ in 0..20 {
                let slope = middle * from_axis * sin(u) - lead * (point[2] - z - lead * u);
                u -= slope / (middle * from_axis * cos(u) + lead * lead);
            }
            let half = sin(0.5 * u);
            let across = (from_axis - middle) * (from_axis - middle) + 4.0 * middle * from_axis * half * half;
            worst = worst.max(hypot(across.sqrt(), point[2] - z - lead * u) - seat);
        }
    };
    for i in 0..=200 {
        let fraction = f64::from(i) / 200.0;
        station(helix, if out { 1.0 - 0.1 * fraction } else { 0.1 * fraction });
        station(span, if out { 0.5 * fraction } else { 1.0 - 0.5 * fraction });
    }
    worst
}

#[test]
fn a_rope_in_line_neither_cuts_walls_nor_leaves_its_seat() {
    for (belt, hand) in BELTS.into_iter().flat_map(|belt| HANDS.map(|hand| (belt, hand))) {
        let drive = aligned(belt, hand);
        for joint in 0..4 {
            let overlap = wall_overlap(&drive, joint);
            // It rests on the seat, so the largest is that of the contact: 0.
            assert!(overlap.abs() <= 1e-4 * 0.0015, "{belt:?} {hand:?} joint {joint}: {overlap:e} m");
        }
    }
    // The theory's mismatch is taken by the play of the groove; nearly half a pitch over this short span is not.
    let overlap = |pitches: f64| {
        let layout = Layout { second_phase_rad: -TAU * pitches / 5.0, setting: Setting::Outgoing, ..example() };
        wall_overlap(&with_lines(&layout), 3)
    };
    assert!(overlap(0.0) <= 1e-15 && overlap(0.4) > 3e-5, "{:e} {:e}", overlap(0.0), overlap(0.4));
    // The limit of the play, from both sides.
    let limit =
        Drive::new(example()).expect("in range").wall_fleet_limit_rad(Drum::Output, Seat { radius_m: 0.000_795, depth_m: 0.000_562_5 });
    let limit_pitches = 0.025 * tan(limit.expect("a good seat")) / 0.002 - example_mismatch();
    assert!(overlap(0.97 * limit_pitches) <= 1e-15 && overlap(1.03 * limit_pitches) > 1e-7, "{limit:?} {limit_pitches}");
}

#[test]
fn lengths_are_those_of_the_path() {
    for (belt, setting) in BELTS.into_iter().flat_map(|belt| [Setting::Outgoing, Setting::Shared].map(|setting| (belt, setting))) {
        let drive = with_lines(&Layout { belt, setting, centre_distance_m: 0.08, pitch_m: 0.009, ..example() });
        let want = drive.cable_length_m(0).expect("a cable");
        for output_rad in output_angles(&drive) {
            let line = drive.centre_line(0, output_rad).expect("on the travel");
            close(line.length_m(), want, 1e-14);
            // Sums of chords over n and 2n parts, extrapolated: the error is of the fourth order.
            let chords = |n: u32| -> f64 {
                let sum = |piece: &Piece| -> f64 {
                    let at = |i: u32| piece.point_m(f64::from(i) / f64::from(n));
                    (0..n).map(|i| norm(sub(at(i + 1), at(i)))).sum()
                };
                line.pieces.iter().map(sum).sum()
            };
            close((4.0 * chords(4000) - chords(2000)) / 3.0, want, 2e-11);
        }
    }
}

#[test]
fn places_follow_the_arc_length() {
    let drive = with_lines(&example());
    let line = drive.centre_line(0, 2.0).expect("on the travel");
    let length = line.length_m();
    let step = 1e-6;
    let mut seen = [false; 5];
    for i in 0..500 {
        let s = length * (f64::from(i) + 0.5) / 500.0;
        let here = line.at(s);
        seen[here.piece] = true;
        close(norm(here.tangent), 1.0, 1e-14);
        let ahead = sub(line.at(s + step).point_m, line.at(s - step).point_m).map(|x| x / (2.0 * step));
        assert!(norm(sub(ahead, here.tangent)) < 2e-3, "at {s}");
    }
    assert_eq!(seen, [true; 5]);
    assert_eq!(line.at(-1.0).point_m, line.pieces[0].point_m(0.0));
    assert_eq!(line.at(length + 1.0).point_m, line.pieces[4].point_m(1.0));
    let points = line.polyline_m(1e-5).expect("a good error");
    let mut worst = 0.0_f64;
    for pair in points.windows(2) {
        let middle: Vector = std::array::from_fn(|k| 0.5 * (pair[0][k] + pair[1][k]));
        for (axis, radius) in [(0.0, 0.010), (0.065, 0.050)] {
            let on = |p: Vector| (hypot(p[0] - axis, p[1]) - radius).abs() < 1e-12;
            if on(pair[0]) && on(pair[1]) {
                worst = worst.max(radius - hypot(middle[0] - axis, middle[1]));
            }
        }
    }
    assert!((0.8e-5..=1e-5).contains(&worst), "{worst:e}");
}

#[test]
fn the_numbers_of_the_theory() {
    let drive = Drive::new(example()).expect("in range");
    close(drive.free_span_m(), 0.025, 1e-16);
    close(drive.tangent_angle_rad(), 0.394_791_119_699_761_4, 1e-15);
    close(drive.input_wrap_rad(), 24.343_158_989_318_823, 1e-13);
    close(drive.mismatch_pitches(0).expect("a cable"), 0.042, 5e-4);
    close(drive.fleet(0).expect("a cable").largest_rad().to_degrees(), 0.096, 5e-4);
    close(drive.aligning_ratio(4).expect("near 5"), 5.0453, 5e-5);
    let found = drive.aligned_distances(0.0, 0.2).expect("finite");
    assert_eq!(found[0].lines_apart, 5, "n + 1 + k with k = 1");
    let (residual, k) = drive.law_residual();
    assert_eq!(k, 0.0);
    close(residual, 6.0 * (tan(0.394_791_119_699_761_4) - 0.394_791_119_699_761_4) / PI, 1e-14);
    // 65 − 60 mm between the middles of the ropes, 1.5 mm of rope.
    close(drive.drum_gap_m(), 0.0035, 1e-16);
    close(drive.helix_angle_rad(), atan2(0.002, TAU * 0.010), 1e-17);
    assert_eq!(drive.least_output_wraps_rad(), [PI, 0.75 * PI]);
    close(found[0].centre_distance_m / 0.010, 10.8627, 5e-5);
}

#[test]
fn all_aligned_distances_and_only_these() {
    for (belt, ratio) in BELTS.into_iter().flat_map(|belt| [0.7, 1.0, 2.0, 5.0].map(|ratio| (belt, ratio))) {
        let layout = Layout { belt, output_radius_m: 0.010 * ratio, starts: 1, centre_distance_m: 0.2, ..example() };
        let drive = with_lines(&Layout { starts: if ratio > 1.5 { 5 } else { 1 }, ..layout });
        let found = drive.aligned_distances(0.0, 0.3).expect("finite");
        // The law by its textbook form, on a fine grid: one change of sign for each solution.
        let l = drive.layout();
        let sigma = if belt == Belt::Crossed { 1.0 } else { -1.0 };
        let lines = |d: f64| {
            let gamma = acos((1.0 + sigma * ratio) * 0.010 / d);
            let law = if ratio == 1.0 && belt == Belt::Open { d / 0.010 } else { (1.0 + sigma * ratio) * (tan(gamma) - gamma) };
            (4.0 + law / PI) * f64::from(l.starts) / ratio
        };
        for aligned in &found {
            close(lines(aligned.centre_distance_m), aligned.lines_apart as f64, 1e-10);
        }
        // Where the drums touch there is no span.
        let least = 0.010 * (1.0 + ratio) + 1e-7;
        let count = lines(0.3).floor() - lines(least).ceil() + 1.0;
        assert!((found.len() as f64 - count).abs() < 0.5, "{belt:?} {ratio}: {} of {count}", found.len());
        assert!(found.windows(2).all(|pair| pair[0].centre_distance_m < pair[1].centre_distance_m));
        close((drive.landing_pitches() - (lines(0.2) * ratio / f64::from(l.starts) - 4.0)).abs(), 0.0, 1e-12);
        let slope = (lines(0.2 + 1e-6) - lines(0.2 - 1e-6)) / 2e-6 * ratio / f64::from(l.starts);
        close(drive.landing_pitches_per_m(), slope, 1e-7 * slope);
    }
}

#[test]
fn aligned_distances_with_a_phase() {
    for (belt, second_phase_rad) in BELTS.into_iter().flat_map(|belt| [-0.4, 0.3].map(|phase| (belt, phase))) {
        let start = with_lines(&Layout { belt, second_phase_rad, ..example() });
        let found = start.aligned_distances(0.0, 0.3).expect("finite");
        assert!(found.len() >= 3);
        for at in found {
            let drive = with_lines(&Layout { centre_distance_m: at.centre_distance_m, ..start.layout().clone() });
            assert_eq!(drive.nearest_lines_apart(), at.lines_apart);
            close(drive.mismatch_pitches(0).expect("a cable"), 0.0, 1e-12);
        }
    }
}

#[test]
fn ratio_and_phase_bring_a_cable_into_line() {
    for belt in BELTS {
        for d in [0.08, 0.09, 0.2] {
            let drive = with_lines(&Layout { belt, centre_distance_m: d, ..example() });
            let lines = drive.layout().cables[0];
            let phase = drive.aligning_phase_rad(0).expect("a cable");
            let turned = Drive::new(Layout { second_phase_rad: phase, ..drive.layout().clone() }).expect("in range");
            let ratio = drive.aligning_ratio(lines[1]).expect("there is one");
            let resized = Drive::new(Layout { output_radius_m: 0.010 * ratio, ..drive.layout().clone() }).expect("in range");
            for aligned in [turned, resized] {
                close(aligned.mismatch_pitches(0).expect("a cable"), 0.0, 1e-13);
                let line = aligned.centre_line(0, 1.0).expect("on the travel");
                for pair in line.pieces.windows(2) {
                    assert!(angle(pair[0].tangent(1.0), pair[1].tangent(0.0)) <= 1e-13);
                }
                assert!(off_groove(&aligned, Drum::Output, Group::Second, line.pieces[4].point_m(0.3), 1.0).abs() <= 1e-14);
            }
            assert!((ratio - 5.0).abs() < 0.5, "{d}: {ratio}");
        }
    }
    // Here the output would have to be so large that it overlaps the input.
    let open = with_lines(&Layout { belt: Belt::Open, ..example() });
    assert!(open.mismatch_pitches(0).expect("a cable") > 0.47);
    assert_eq!(open.aligning_ratio(open.layout().cables[0][1]), Err(GeometryError::NoRatio));
}

#[test]
fn a_second_cable_is_not_in_line_at_the_near_integer_ratio() {
    let two = Layout { cables: vec![[0, 4], [4, 8]], ..example() };
    let drive = Drive::new(two.clone()).expect("in range");
    let ratio = drive.aligning_ratio(4).expect("near 5");
    let near = Drive::new(Layout { output_radius_m: 0.010 * ratio, setting: Setting::Outgoing, ..two.clone() }).expect("in range");
    let extra = near.landing_pitches();
    close(near.fleet(0).expect("a cable").largest_rad(), 0.0, 1e-13);
    // Its first line is 4 R/5 = n + 1 + extra pitches on, the input's groove a whole number.
    let second = near.fleet(1).expect("a cable");
    close(second.deviation_pitches[0], -extra, 1e-12);
    close(second.deviation_pitches[1], extra, 1e-12);
    // The compromise halves it for both cables.
    let shared = Drive::new(Layout { output_radius_m: 0.010 * ratio, ..two }).expect("in range");
    for cable in 0..2 {
        for deviation in shared.fleet(cable).expect("a cable").deviation_pitches {
            close(deviation.abs(), 0.5 * extra, 1e-12);
        }
    }
}

#[test]
fn anchors_stay_on_the_drum_and_bands_hold_the_rope() {
    for (belt, hand) in BELTS.into_iter().flat_map(|belt| HANDS.map(|hand| (belt, hand))) {
        let start = with_lines(&Layout { belt, hand, guard_rad: [2.0, 2.5], ..example() });
        let [_, apart] = start.layout().cables[0];
        let drive = Drive::new(Layout { cables: vec![[0, apart], [5, 5 + apart]], ..start.layout().clone() }).expect("in range");
        let mut seen = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for cable in 0..2 {
            let anchors = drive.anchors(cable).expect("a cable");
            let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
            for output_rad in output_angles(&drive) {
                let line = drive.centre_line(cable, output_rad).expect("on the travel");
                let turned = drive.turned_rad(output_rad).expect("on the travel")[1];
                for (anchor, point) in anchors.iter().zip([line.pieces[0].point_m(0.0), line.pieces[4].point_m(1.0)]) {
                    let angle = anchor.angle_rad + turned;
                    let want = [0.065 + 0.050 * cos(angle), 0.050 * sin(angle), anchor.z_m];
                    assert!(norm(sub(want, point)) <= 1e-15, "{belt:?} {hand:?}");
                }
                let [first, second] = drive.output_wraps_rad(output_rad).expect("on the travel");
                close(first + second, 4.5 + 1.5 * PI, 1e-14);
                for (k, at) in [0, 2, 4].into_iter().enumerate() {
                    for z in [line.pieces[at].point_m(0.0)[2], line.pieces[at].point_m(1.0)[2]] {
                        ends[k] = [ends[k][0].min(z), ends[k][1].max(z)];
                        let all = &mut seen[usize::from(k == 1)];
                        *all = [all[0].min(z), all[1].max(z)];
                    }
                }
            }
            let [first, second] = drive.output_bands(cable).expect("a cable");
            for (band, end) in [first, drive.input_band(cable).expect("a cable"), second].into_iter().zip(ends) {
                close(band.from_m, end[0], 1e-15);
                close(band.to_m, end[1], 1e-15);
            }
        }
        for (drum, seen) in [(Drum::Output, seen[0]), (Drum::Input, seen[1])] {
            close(drive.band(drum).from_m, seen[0], 1e-15);
            close(drive.drum_length_m(drum, [0.003, 0.004]).expect("margins"), seen[1] - seen[0] + 0.007, 1e-15);
        }
        let walk = drive.walk_m(1.5 * PI).expect("on the travel");
        close(walk.abs(), 0.002 * 5.0 * 0.75, 1e-16);
        close(drive.travel_walk_m(), walk.abs(), 0.0);
    }
}

#[test]
fn mirrored_scaled_and_reversed_drives() {
    for belt in BELTS {
        let right = with_lines(&Layout { belt, ..example() });
        let left = with_lines(&Layout { belt, hand: Hand::Left, ..example() });
        let l = right.layout();
        let large = Drive::new(Layout {
            input_radius_m: 3.0 * l.input_radius_m,
            output_radius_m: 3.0 * l.output_radius_m,
            centre_distance_m: 3.0 * l.centre_distance_m,
            pitch_m: 3.0 * l.pitch_m,
            rope_diameter_m: 3.0 * l.rope_diameter_m,
            ..l.clone()
        })
        .expect("in range");
        // Turned about the line of centres, end 1 becomes end 0 and the travel runs backwards.
        let back = Drive::new(Layout { guard_rad: [l.guard_rad[1], l.guard_rad[0]], ..l.clone() }).expect("in range");
        let lines = [&right, &left, &large].map(|drive| drive.centre_line(0, 1.0).expect("on the travel"));
        let reversed = back.centre_line(0, l.travel_rad - 1.0).expect("on the travel");
        let length = right.cable_length_m(0).expect("a cable");
        let shift = lines[0].at(0.5 * length).point_m[2] + reversed.at(0.5 * length).point_m[2];
        for i in 0..=50 {
            let s = length * f64::from(i) / 50.0;
            let [x, y, z] = lines[0].at(s).point_m;
            assert_eq!(lines[1].at(s).point_m, [x, y, -z]);
            assert!(norm(sub(lines[2].at(3.0 * s).point_m.map(|x| x / 3.0), [x, y, z])) <= 2e-15);
            let mate = reversed.at(length - s).point_m;
            assert!(norm(sub(mate, [x, -y, shift - z])) <= 2e-14, "{belt:?} {i}: {mate:?} {x} {y} {z}");
        }
        let (a, b) = (right.nearest().expect("turns"), large.nearest().expect("turns"));
        close(b.distance_m, 3.0 * a.distance_m, 1e-15);
        close(b.pitches, a.pitches, 1e-13);
    }
}

#[test]
fn grooves_are_cut_in_the_section_asked_for() {
    let drive = Drive::new(Layout { second_phase_rad: 0.2, ..example() }).expect("in range");
    let section = Band { from_m: -0.004, to_m: 0.011 };
    let step = 0.1;
    for (drum, starts, lead, hand) in [(Drum::Input, 1, 0.002, 1.0), (Drum::Output, 5, 0.010, -1.0)] {
        let paths = drive.groove_paths(drum, Group::First, section, step).expect("a good section");
        assert_eq!(paths.len(), starts);
        for (start, path) in paths.iter().enumerate() {
            assert_eq!(path.start as usize, start);
            let (first, last) = (path.points[0], path.points[path.points.len() - 1]);
            assert_eq!([first[1], last[1]], [section.from_m, section.to_m]);
            close(last[0] - first[0], hand * TAU * 0.015 / lead, 1e-12);
            for pair in path.points.windows(2) {
                assert!((pair[1][0] - pair[0][0]).abs() <= step * (1.0 + 1e-12));
            }
            for &[angle, z] in &path.points {
                close(drive.groove_z_m(drum, Group::First, start as f64, angle), z, 1e-16);
            }
        }
        // The starts divide the turn evenly.
        for pair in paths.windows(2) {
            close((pair[1].points[0][0] - pair[0].points[0][0]) * hand, -TAU / 5.0, 1e-13);
        }
    }
    let second = drive.groove_z_m(Drum::Output, Group::Second, 0.0, 0.7) - drive.groove_z_m(Drum::Output, Group::First, 0.0, 0.7);
    close(second, 0.010 * 0.2 / TAU, 1e-16);
}
