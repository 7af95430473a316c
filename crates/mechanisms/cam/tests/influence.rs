//! Forces with small errors of the profiles as straight lines: against the full computation, closed forms and statistics.

use std::sync::Arc;

use forcewright_cam::{
    Bank, Bodies, Cut, CutSide, Drive, Flaws, ForceLaw, Mechanism, ProfileInfluence, Purpose, RandomProfile, RestForces, SENSES, Sense,
    SidePath, Spring, SpringLaw, SpringMass, frame,
};

const ROLLER_M: f64 = 0.016;
const STROKE_M: f64 = 0.2;

fn bank(extension: bool, rest_m: f64) -> Bank {
    let law = SpringLaw::Linear { rate_n_per_m: 1380.0, rest_m };
    Bank::new(vec![Spring { law, stretch_m: 0.0, mass_kg: 0.18 }], extension)
}

/// A cam for a force law, its springs being this much shorter than at the start.
fn cut(law: ForceLaw, extension: bool, preload_m: f64, friction: f64) -> Arc<Cut> {
    let (start_length_m, sign) = if extension { (0.136, 1.0) } else { (0.36, -1.0) };
    let purpose = Purpose {
        law,
        springs: bank(extension, start_length_m - sign * preload_m),
        start_length_m,
        sides: [CutSide { brace_m: 0.22, share: 0.55 }, CutSide { brace_m: 0.22, share: 0.45 }],
        friction,
        stroke_m: STROKE_M,
    };
    Arc::new(Cut::new(purpose).expect("a cam"))
}

fn mechanism(cut: &Arc<Cut>, gravity: f64) -> Mechanism {
    Mechanism {
        paths: SidePath::both(cut, ROLLER_M),
        brace_m: cut.purpose().sides.map(|side| side.brace_m),
        roller_m: ROLLER_M,
        arm_m: 0.004 * ROLLER_M,
        springs: cut.purpose().springs.clone(),
        bodies: Bodies {
            slider_kg: 0.068,
            brace_kg: 0.077,
            brace_kg_m2: 2.57e-4,
            roller_kg: 0.2,
            roller_kg_m2: 4.6e-6,
            springs: SpringMass::Bar,
        },
        gravity_m_per_s2: gravity,
        rise_m: cut.rise_m(),
    }
}

/// The paper's design without masses and friction.
fn paper() -> Mechanism {
    let side = CutSide { brace_m: 0.2, share: 0.5 };
    let purpose = Purpose {
        law: ForceLaw::constant(50.0),
        springs: bank(true, 0.136),
        start_length_m: 0.136,
        sides: [side; 2],
        friction: 0.0,
        stroke_m: 0.24,
    };
    Mechanism { arm_m: 0.0, ..mechanism(&Arc::new(Cut::new(purpose).expect("a cam")), 0.0) }
}

fn travels(from: f64, to: f64, count: u32) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * f64::from(i) / f64::from(count - 1)).collect()
}

/// Forces of the mechanism with a random error of its profiles, in full.
fn full(m: &Mechanism, random: &RandomProfile, travels_m: &[f64]) -> Vec<RestForces> {
    let flawed = |side: usize| m.paths[side].with(&Flaws { error: random.along(side, m.paths[side].length_m()), ..Flaws::default() });
    let mut out = Vec::new();
    Mechanism { paths: [0, 1].map(flawed), ..m.clone() }.rest_forces(travels_m, &mut out).expect("assembles");
    out
}

/// Largest difference of all forces, N.
fn difference(a: &[RestForces], b: &[RestForces]) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// What the lines leave out is of second order: half the error leaves a quarter. Any law, preload, both kinds of springs, unequal sides,
/// weights, friction both ways, a compensated cam, and the corner of an undercut.
#[test]
fn what_is_left_out_is_of_second_order() {
    let rising = ForceLaw::through(&[[0.0, 40.0], [0.1, 60.0], [STROKE_M, 55.0]]).expect("a law");
    let beyond = travels(0.02, 0.19, 60);
    let cases = [
        ("constant", mechanism(&cut(ForceLaw::constant(50.0), true, 0.0, 0.0), 9.81), beyond.clone()),
        ("preloaded, rising", mechanism(&cut(rising.clone(), true, 0.02, 0.0), 9.81), beyond.clone()),
        ("compression", mechanism(&cut(rising, false, 0.01, 0.0), 9.81), beyond.clone()),
        ("compensated", mechanism(&cut(ForceLaw::constant(50.0), true, 0.01, 0.004), 0.0), beyond),
        ("on the corner", mechanism(&cut(ForceLaw::constant(50.0), true, 0.0, 0.0), 9.81), travels(1e-4, 3e-4, 20)),
    ];
    for (name, m, travels_m) in cases {
        if name == "on the corner" {
            assert!(m.paths.iter().all(|p| p.corner().expect("undercut").travel_m > 3.1e-4), "{:?}", m.paths[0].corner());
        }
        let influence = ProfileInfluence::new(&m, &travels_m).expect("assembles");
        let mut nominal = Vec::new();
        m.rest_forces(&travels_m, &mut nominal).expect("assembles");
        let left_out = |deviation_m: f64| {
            let random = RandomProfile { deviation_m, correlation_m: 10.5e-3, seed: 5 };
            let (exact, mut lines) = (full(&m, &random, &travels_m), Vec::new());
            influence.random_n(&random, &mut lines);
            (difference(&exact, &lines), difference(&exact, &nominal))
        };
        let [(one, effect), (half, _), (quarter, _)] = [8e-6, 4e-6, 2e-6].map(left_out);
        assert!(one < 0.05 * effect && effect > 0.05, "{name}: {one:e} of {effect:e}");
        for ratio in [one / half, half / quarter] {
            assert!((ratio - 4.0).abs() < 0.4, "{name}: {ratio}, {one:e}");
        }
    }
}

/// With constant force and springs without preload the lines are eq. (9): `b = F |p′|/(n_x + n_y tan α)`, `a = d/ds (P/(n_x + n_y tan α))`.
#[test]
fn the_closed_form_of_the_paper_s_design() {
    let m = paper();
    let lever = |s: f64| {
        let pose = m.pose([s, 0.0]).expect("assembles");
        let place = pose.places[0];
        let [_, normal] = frame(&place, 1.0);
        let slope = place.at[0] / (0.04 - place.at[0] * place.at[0]).sqrt();
        let spring_n = m.forces(&pose, &Drive::rest(s), Sense::Frictionless).spring_n;
        let speed = (place.slope[0] * place.slope[0] + place.slope[1] * place.slope[1]).sqrt();
        let lean = normal[0] + normal[1] * slope;
        (spring_n / lean, 50.0 * speed / lean)
    };
    let travels_m = travels(0.01, 0.23, 23);
    let influence = ProfileInfluence::new(&m, &travels_m).expect("assembles");
    for station in &influence.stations {
        let (s, h) = (station.travel_m, 1e-5);
        let (a, b) = ((lever(s + h).0 - lever(s - h).0) / (2.0 * h), lever(s).1);
        for side in &station.sides {
            assert!((side.by_slope_n[0] / b - 1.0).abs() < 1e-12, "{s}: {} {b}", side.by_slope_n[0]);
            assert!((side.by_error_n_per_m[0] / a - 1.0).abs() < 1e-6, "{s}: {} {a}", side.by_error_n_per_m[0]);
        }
    }
}

/// Draws scatter as their standard deviations say; and those are the 0.8 % of the theory note.
#[test]
fn draws_have_their_standard_deviation() {
    const DRAWS: u64 = 4000;
    let m = paper();
    // The stroke of the paper's Fig. 13: 100 mm from s2 = 206.5 mm.
    let start = 0.2065 - m.rise_m;
    let influence = ProfileInfluence::new(&m, &travels(start, start + 0.1, 26)).expect("assembles");
    let deviations: Vec<RestForces> = influence.deviations_n(23e-6, 10.5e-3).collect();
    let (mut squares, mut out) = (vec![0.0; deviations.len()], Vec::new());
    for seed in 0..DRAWS {
        influence.random_n(&RandomProfile { deviation_m: 23e-6, correlation_m: 10.5e-3, seed }, &mut out);
        for (sum, force) in squares.iter_mut().zip(&out) {
            *sum += (force[0] - 50.0) * (force[0] - 50.0) / DRAWS as f64;
        }
    }
    for (square, deviation) in squares.iter().zip(&deviations) {
        // A variance of n normal draws scatters by √(2/n) = 2.2 %.
        assert!((square / (deviation[0] * deviation[0]) - 1.0).abs() < 4.0 * (2.0 / DRAWS as f64).sqrt(), "{square} {deviation:?}");
    }
    let mean = deviations.iter().map(|d| d[0] * d[0]).sum::<f64>() / deviations.len() as f64;
    assert!((mean.sqrt() / 50.0 - 0.008).abs() < 0.0005, "{}", mean.sqrt() / 50.0);
}

/// An error tabulated along the path is the same error.
#[test]
fn a_tabulated_error_gives_the_same_force() {
    let m = paper();
    let random = RandomProfile { deviation_m: 23e-6, correlation_m: 10.5e-3, seed: 9 };
    let travels_m = travels(0.002, 0.238, 237);
    let flawed = |side: usize| m.paths[side].with(&Flaws { error: random.of(side), ..Flaws::default() });
    let mut waves = Vec::new();
    Mechanism { paths: [0, 1].map(flawed), ..m.clone() }.rest_forces(&travels_m, &mut waves).expect("assembles");
    assert!(difference(&waves, &full(&m, &random, &travels_m)) < 1e-12 * 50.0);
}

/// Times a path is evaluated per position: once where the design says where to look, at most three times with errors.
#[test]
fn positions_take_few_evaluations() {
    let (m, mut out) = (paper(), Vec::new());
    let count = |m: &Mechanism, travels_m: &[f64], out: &mut Vec<RestForces>| m.rest_forces(travels_m, out).expect("assembles");
    let thousand = travels(0.001, 0.24, 1000);
    assert_eq!(count(&m, &thousand, &mut out), 1000, "one side tells both, and it is where it was meant to be");
    let tilted = |side: usize| m.paths[side].with(&Flaws { turn_rad: [0.01, -0.012][side], shift_m: [1e-4, 2e-4], ..Flaws::default() });
    let turned = Mechanism { paths: [0, 1].map(tilted), ..m.clone() };
    assert!(count(&turned, &thousand, &mut out) <= 2 * 2030, "{}", count(&turned, &thousand, &mut out));
    let random = RandomProfile { deviation_m: 23e-6, correlation_m: 10.5e-3, seed: 2 };
    let wavy = |side: usize| m.paths[side].with(&Flaws { error: random.along(side, m.paths[side].length_m()), ..Flaws::default() });
    let wavy = Mechanism { paths: [0, 1].map(wavy), ..m.clone() };
    let sparse = travels(0.02, 0.22, 200);
    assert!(count(&wavy, &sparse, &mut out) <= 2 * 430, "{}", count(&wavy, &sparse, &mut out));
}

/// The short equations at rest are those of the motion without motion, also where a cam would have to pull.
#[test]
fn forces_at_rest_are_those_of_no_motion() {
    let rising = ForceLaw::through(&[[0.0, 40.0], [0.1, 60.0], [STROKE_M, 55.0]]).expect("a law");
    let pushed = Mechanism { springs: bank(true, 0.6), ..mechanism(&cut(ForceLaw::constant(50.0), true, 0.01, 0.0), 0.0) };
    let cases = [paper(), mechanism(&cut(rising.clone(), true, 0.02, 0.0), 9.81), mechanism(&cut(rising, false, 0.01, 0.0), 9.81), pushed];
    let travels_m = travels(0.01, 0.19, 50);
    let (mut out, mut pulling) = (Vec::new(), 0);
    for m in &cases {
        m.rest_forces(&travels_m, &mut out).expect("assembles");
        for (s, short) in travels_m.iter().zip(&out) {
            for (sense, short_n) in SENSES.into_iter().zip(short) {
                let long = m.instant(&Drive::rest(*s), sense).expect("assembles");
                pulling += usize::from(long.sides.iter().any(|side| side.normal_n < 0.0));
                assert!((short_n - long.force_n).abs() < 1e-12 * long.force_n.abs().max(50.0), "{s} {sense:?}: {short_n} {}", long.force_n);
            }
        }
    }
    assert!(pulling > 20, "{pulling}");
}
