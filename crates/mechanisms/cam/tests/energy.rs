//! Work and energy: cycles with friction, any force law, the slider let go.

use std::sync::Arc;

use forcewright_base::maths;
use forcewright_cam::{
    Bank, Bodies, Cut, CutSide, Drive, End, Flaws, ForceLaw, Law, Mechanism, Moment, Motion, Purpose, Release, Released, Sense, SidePath,
    Spring, SpringLaw, SpringMass, prescribed, release,
};

const X0: f64 = 0.068;
const BODIES: Bodies =
    Bodies { slider_kg: 0.068, brace_kg: 0.077, brace_kg_m2: 2.57e-4, roller_kg: 0.2, roller_kg_m2: 4.61e-6, springs: SpringMass::Bar };
/// The slider alone has mass.
const LIGHT: Bodies =
    Bodies { slider_kg: 0.5, brace_kg: 0.0, brace_kg_m2: 0.0, roller_kg: 0.0, roller_kg_m2: 0.0, springs: SpringMass::Bar };

fn mechanism(law: ForceLaw, bodies: Bodies, spring_kg: f64, friction: f64, radius: f64) -> Mechanism {
    let spring = Spring { law: SpringLaw::Linear { rate_n_per_m: 1380.0, rest_m: 2.0 * X0 }, stretch_m: 0.0, mass_kg: spring_kg };
    let springs = Bank::new(vec![spring], true);
    let sides = [CutSide { brace_m: 0.2, share: 0.5 }; 2];
    let purpose = Purpose { law, springs: springs.clone(), start_length_m: 2.0 * X0, sides, friction: 0.0, stroke_m: 0.24 };
    let cut = Arc::new(Cut::new(purpose).expect("a cam"));
    Mechanism {
        paths: [0, 1].map(|side| SidePath::new(Arc::clone(&cut), side, radius, &Flaws::default())),
        brace_m: [0.2; 2],
        roller_m: radius,
        arm_m: friction * radius,
        springs,
        bodies,
        gravity_m_per_s2: 9.81,
        rise_m: cut.rise_m(),
    }
}

fn rest_force(m: &Mechanism, s: f64, sense: Sense) -> f64 {
    m.instant(&Drive::rest(s), sense).expect("assembles").force_n
}

/// Simpson's rule, halved where two halves differ from the whole (J. N. Lyness, J. ACM 16 (1969)).
fn adaptive(f: &dyn Fn(f64) -> f64, [a, b]: [f64; 2], tolerance: f64) -> f64 {
    fn part(f: &dyn Fn(f64) -> f64, [a, b]: [f64; 2], [fa, fm, fb]: [f64; 3], whole: f64, tolerance: f64, depth: u32) -> f64 {
        let m = 0.5 * (a + b);
        let [fl, fr] = [f(0.5 * (a + m)), f(0.5 * (m + b))];
        let [left, right] = [(m - a) / 6.0 * (fa + 4.0 * fl + fm), (b - m) / 6.0 * (fm + 4.0 * fr + fb)];
        let miss = left + right - whole;
        if depth == 0 || miss.abs() < 15.0 * tolerance {
            return left + right + miss / 15.0;
        }
        part(f, [a, m], [fa, fl, fm], left, 0.5 * tolerance, depth - 1) + part(f, [m, b], [fm, fr, fb], right, 0.5 * tolerance, depth - 1)
    }
    let [fa, fm, fb] = [f(a), f(0.5 * (a + b)), f(b)];
    part(f, [a, b], [fa, fm, fb], (b - a) / 6.0 * (fa + 4.0 * fm + fb), tolerance, 40)
}

fn close(value: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((value - expected).abs() <= tolerance, "{what}: {value}, expected {expected}");
}

/// Energy of springs and weight at a travel, J, by the places of the parts.
fn stored_j(m: &Mechanism, s: f64) -> f64 {
    let pose = m.pose([s, 0.0]).expect("assembles");
    let [right, left] = [pose.places[0].at, pose.places[1].at];
    let length = maths::hypot(right[0] + left[0], right[1] - left[1]);
    let joint = pose.joints[0][1];
    let b = &m.bodies;
    let rollers = (b.roller_kg + 0.5 * m.springs.mass_kg()) * (right[1] + left[1]);
    let braces = b.brace_kg * (0.5 * (right[1] + joint) + 0.5 * (left[1] + joint));
    m.springs.energy_j(2.0 * X0, length) + m.gravity_m_per_s2 * (b.slider_kg * joint + rollers + braces)
}

fn rising() -> ForceLaw {
    ForceLaw::through(&[[0.0, 40.0], [0.08, 55.0], [0.24, 70.0]]).expect("a law")
}

#[test]
fn the_work_of_a_general_law_by_quadrature() {
    let m = mechanism(rising(), LIGHT, 0.0, 0.002, 0.004);
    let weightless = Mechanism { gravity_m_per_s2: 0.0, ..m };
    for span in [[0.01, 0.08], [0.08, 0.24]] {
        let work = adaptive(&|s| rest_force(&weightless, s, Sense::Frictionless), span, 1e-13);
        let law = rising();
        close(work, law.work_j(span[1]) - law.work_j(span[0]), 1e-11, "W = ∫F ds");
        close(work, stored_j(&weightless, span[1]) - stored_j(&weightless, span[0]), 1e-11, "W = ΔE");
    }
}

/// Up and down: what was put in and not given back is the loop, and it is the work of μN along both paths.
#[test]
fn a_cycle_loses_the_loop() {
    let m = mechanism(rising(), BODIES, 0.09, 0.004, 0.004);
    let span = [0.01, 0.08];
    let [up, down] = [Sense::Up, Sense::Down].map(|sense| adaptive(&|s| rest_force(&m, s, sense), span, 1e-13));
    let rise = stored_j(&m, span[1]) - stored_j(&m, span[0]);
    // Power of the resistance at unit speed: μN times the speed of the roller's centre, on both sides.
    let resistance = |s: f64, sense: Sense| {
        let h = 1e-6;
        let instant = m.instant(&Drive::rest(s), sense).expect("assembles");
        let [a, b] = [s - h, s + h].map(|s| m.pose([s, 0.0]).expect("assembles").places[0].at);
        let speed = maths::hypot(b[0] - a[0], b[1] - a[1]) / (2.0 * h);
        m.friction() * (instant.sides[0].normal_n + instant.sides[1].normal_n) * speed
    };
    let [lost_up, lost_down] = [Sense::Up, Sense::Down].map(|sense| adaptive(&|s| resistance(s, sense), span, 1e-10));
    close(up, rise + lost_up, 1e-8, "up");
    close(down, rise - lost_down, 1e-8, "down");
    close(up - down, lost_up + lost_down, 1e-8, "loop");
    assert!(up - down > 0.02, "the loop is open");
}

fn asked(start_m: f64, duration_s: f64) -> Release {
    Release {
        pull_n: 0.0,
        weight_kg: 0.0,
        weight_m_per_s2: 9.81,
        damping_n_s_per_m: 0.0,
        sideways_m: None,
        start_m,
        duration_s,
        stops_m: [1e-6, 0.24],
    }
}

/// Kinetic energy by the mass that the slider feels without friction, J.
fn kinetic_j(m: &Mechanism, s: f64, v: f64) -> f64 {
    let force = |a: f64| {
        m.instant(&Drive { at: [s, 0.0], acceleration: [a, 0.0], ..Drive::default() }, Sense::Frictionless).expect("assembles").force_n
    };
    0.5 * (force(1.0) - force(0.0)) * v * v
}

/// Everything that came in and where it is at the end: relative to what moved.
fn miss(m: &Mechanism, asked: &Release, run: &Released) -> f64 {
    let last = run.moments.last().expect("moments");
    let way = last.travel_m - asked.start_m;
    let put_in = asked.pull_n * way + asked.weight_kg * asked.weight_m_per_s2 * (run.weight[0] - asked.start_m);
    let kinetic = kinetic_j(m, last.travel_m, last.speed_m_per_s) + 0.5 * asked.weight_kg * run.weight[1] * run.weight[1];
    let stored = stored_j(m, last.travel_m) - stored_j(m, asked.start_m);
    let lost = run.friction_j + run.damping_j + run.catches_j;
    (put_in - kinetic - stored - lost).abs() / put_in.abs().max(stored.abs())
}

/// With the slider alone heavy: s̈ = (W − F)/(m2 + m), g with the hanging mass.
#[test]
fn a_constant_force_and_a_weight_accelerate_evenly() {
    let m = Mechanism { gravity_m_per_s2: 0.0, ..mechanism(ForceLaw::constant(50.0), LIGHT, 0.0, 0.0, 0.004) };
    let weight = Release { weight_kg: 6.0, ..asked(0.02, 1.0) };
    let run = release(&m, &weight);
    let a: f64 = (6.0 * 9.81 - 50.0) / 6.5;
    assert_eq!(run.end, End::Stop { far: true });
    close(run.time_s, (2.0 * 0.22 / a).sqrt(), 1e-10, "time to the stop");
    for moment in &run.moments {
        close(moment.travel_m, 0.02 + 0.5 * a * moment.time_s * moment.time_s, 1e-9, "travel");
        close(moment.cable_n.expect("a cable"), 6.0 * (9.81 - a), 1e-7, "tension");
    }
    close(run.slack_s, 0.0, 0.0, "slack");
    // A pull has no inertia; without one the springs throw the slider back.
    let pulled = release(&m, &Release { pull_n: 60.0, ..asked(0.02, 1.0) });
    close(pulled.time_s, (2.0 * 0.22 / 20.0_f64).sqrt(), 1e-10, "pulled");
    let back = release(&m, &asked(0.2, 1.0));
    assert_eq!(back.end, End::Stop { far: false });
    close(back.time_s, (2.0 * (0.2 - 1e-6) / 100.0_f64).sqrt(), 1e-9, "thrown back");
    // Damping: the speed tends to (P − F)/c with the time constant m/c.
    let damped = release(&m, &Release { pull_n: 60.0, damping_n_s_per_m: 20.0, ..asked(0.02, 0.2) });
    let last = damped.moments.last().expect("moments");
    close(last.speed_m_per_s, 0.5 * (1.0 - maths::exp(-0.2 / 0.025)), 1e-9, "damped");
}

/// A weight on springs that get stiffer swings, with friction each time less, until friction holds it.
#[test]
fn a_swing_comes_to_rest_and_its_energy_is_accounted_for() {
    let m = mechanism(rising(), BODIES, 0.09, 0.01, 0.016);
    let weight = Release { weight_kg: 6.5, ..asked(0.03, 30.0) };
    let run = release(&m, &weight);
    assert_eq!(run.end, End::Rest, "after {} s", run.time_s);
    let last = run.moments.last().expect("moments");
    let hanging = 6.5 * 9.81;
    let held = [Sense::Down, Sense::Up].map(|sense| rest_force(&m, last.travel_m, sense));
    assert!(held[0] <= hanging && hanging <= held[1], "{held:?} hold {hanging}");
    close(last.moving.force_n, hanging, 1e-12, "what the slider bears");
    assert!(run.friction_j > 0.1 && miss(&m, &weight, &run) < 1e-8, "{:e}", miss(&m, &weight, &run));
    // The same halfway, in the middle of a swing, and with damping.
    for damping in [0.0, 5.0] {
        let watched = Release { duration_s: 0.31, damping_n_s_per_m: damping, ..weight };
        let run = release(&m, &watched);
        assert_eq!(run.end, End::Time);
        assert!(miss(&m, &watched, &run) < 1e-8, "{:e}", miss(&m, &watched, &run));
    }
}

/// A pull that is quicker than gravity: the weight falls freely, the slider runs ahead, swings back on the rising force and meets it.
/// Up to there both ways are closed forms; momentum says how they go on.
#[test]
fn a_cable_goes_slack_and_taut_again() {
    let law = ForceLaw::through(&[[0.0, 30.0], [0.02, 30.0], [0.2, 160.0], [0.24, 160.0]]).expect("a law");
    let m = Mechanism { gravity_m_per_s2: 0.0, ..mechanism(law, LIGHT, 0.0, 0.0, 0.003) };
    let thrown = Release { pull_n: 60.0, weight_kg: 2.0, ..asked(0.005, 2.0) };
    let run = release(&m, &thrown);
    let early = &run.moments[2];
    assert_eq!(early.cable_n, Some(0.0), "slack at once: 60 m/s² against 9.81");
    close(early.travel_m, 0.005 + 0.5 * 60.0 * early.time_s * early.time_s, 1e-10, "the slider on its own");
    assert!(run.slack_s > 0.05 && run.catches_j > 1e-3, "{} s, {} J", run.slack_s, run.catches_j);
    assert!(run.moments.iter().all(|i| i.cable_n.is_some_and(|t| t >= 0.0)), "a cable does not push");
    assert!(run.moments.iter().any(|i| i.cable_n.is_some_and(|t| t > 1.0)), "it becomes taut");
    assert!(miss(&m, &thrown, &run) < 1e-8, "{:e}, {:?}", miss(&m, &thrown, &run), run.end);
    // 60 m/s² over the first 15 mm, then a swing about where the force is the pull.
    let first = (2.0_f64 * 0.015 / 60.0).sqrt();
    let rate = (160.0 - 30.0) / 0.18;
    let (turns, rest) = ((rate / 0.5_f64).sqrt(), 30.0 / rate);
    let slider = |t: f64| {
        let (sin, cos) = maths::sin_cos(turns * (t - first));
        let speed = 60.0 * first;
        [0.02 + rest * (1.0 - cos) + speed / turns * sin, rest * turns * sin + speed * cos]
    };
    let weight = |t: f64| [0.005 + 0.5 * 9.81 * t * t, 9.81 * t];
    let (mut before, mut after) = (first, first);
    while slider(after)[0] > weight(after)[0] {
        (before, after) = (after, after + 1e-3);
    }
    for _ in 0..60 {
        let middle = f64::midpoint(before, after);
        (before, after) = if slider(middle)[0] > weight(middle)[0] { (middle, after) } else { (before, middle) };
    }
    let both = (0.5 * slider(after)[1] + 2.0 * weight(after)[1]) / 2.5;
    let caught = release(&m, &Release { duration_s: after + 1e-9, ..thrown });
    let last = caught.moments.last().expect("moments");
    close(caught.slack_s, after, 2e-9, "time of the catch");
    close(last.travel_m, slider(after)[0], 1e-8, "place of the catch");
    close(last.speed_m_per_s, both, 1e-6, "one speed");
}

/// Up, a pause, down: at the end all is as it was, so that the hand gave what friction took.
#[test]
fn a_repetition_gives_what_friction_takes() {
    let m = mechanism(rising(), BODIES, 0.09, 0.004, 0.004);
    let repetition =
        Motion { law: Law::Polynomial, start_m: 0.01, rise_m: 0.07, duration_s: 0.3, pause_s: 0.2, returns: true, reference_s: None };
    let moments = prescribed(&m, &repetition, None).expect("moves");
    assert!((moments.last().expect("moments").time_s - 0.8).abs() < 1e-15);
    // Simpson's rule by pairs of equal steps: strokes and pause have an even number.
    let integral = |value: &dyn Fn(&Moment) -> f64| -> f64 {
        let mut phases: Vec<Vec<&Moment>> = vec![Vec::new()];
        for moment in &moments {
            if phases.last().and_then(|p| p.last()).is_some_and(|before| before.time_s.to_bits() == moment.time_s.to_bits()) {
                phases.push(Vec::new());
            }
            phases.last_mut().expect("a phase").push(moment);
        }
        assert_eq!(phases.len(), 3);
        let simpson = |p: &Vec<&Moment>| {
            let h = (p[p.len() - 1].time_s - p[0].time_s) / (p.len() - 1) as f64;
            let weight = |i: usize| {
                if i == 0 || i == p.len() - 1 {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                }
            };
            p.iter().enumerate().map(|(i, m)| weight(i) * value(m)).sum::<f64>() * h / 3.0
        };
        phases.iter().map(simpson).sum()
    };
    let given = integral(&|i| i.moving.force_n * i.speed_m_per_s);
    let lost = integral(&|i| i.lost_w);
    close(given, lost, 1e-8, "over the repetition");
    assert!(lost > 0.02 && moments.iter().all(|i| i.lost_w >= -1e-12), "friction only takes");
    // On the way up alone, springs and weights keep the rest.
    let up = &moments[..=400];
    let top = up.last().expect("moments");
    close(top.travel_m, 0.08, 1e-15, "top");
    let h = 0.3 / 400.0;
    let weight = |i: usize| {
        if i == 0 || i == 400 {
            1.0
        } else if i % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    let sum = |value: &dyn Fn(&Moment) -> f64| up.iter().enumerate().map(|(i, m)| weight(i) * value(m)).sum::<f64>() * h / 3.0;
    close(sum(&|i| i.moving.force_n * i.speed_m_per_s - i.lost_w), stored_j(&m, 0.08) - stored_j(&m, 0.01), 1e-8, "up");
}

/// A weight on a free slider whose cam stands askew: energy is accounted for along the travel and sideways, with friction, damping, and
/// where the cable becomes taut.
#[test]
fn a_free_slider_loses_what_is_accounted_for() {
    let upright =
        mechanism(ForceLaw::through(&[[0.0, 30.0], [0.02, 30.0], [0.2, 160.0], [0.24, 160.0]]).expect("a law"), BODIES, 0.09, 0.003, 0.003);
    let tilt = |side: usize| Flaws { turn_rad: if side == 0 { 0.004 } else { -0.004 }, ..Flaws::default() };
    let m = Mechanism { paths: [0, 1].map(|side| upright.paths[side].with(&tilt(side))), gravity_m_per_s2: 0.0, ..upright };
    let force = |drive: Drive| m.instant(&drive, Sense::Frictionless).expect("assembles");
    let stored = |s: f64, x: f64| {
        let pose = m.pose([s, x]).expect("assembles");
        m.springs.energy_j(2.0 * X0, m.forces(&pose, &Drive { at: [s, x], ..Drive::default() }, Sense::Frictionless).spring_m)
    };
    let mut caught = 0.0_f64;
    for (pull_n, weight_kg, damping_n_s_per_m, duration_s) in [(0.0, 6.5, 0.0, 0.2), (0.0, 6.5, 4.0, 0.2), (90.0, 2.0, 0.0, 1.0)] {
        let asked = Release { weight_kg, pull_n, damping_n_s_per_m, sideways_m: Some(0.0), ..asked(0.005, duration_s) };
        let run = release(&m, &asked);
        let last = run.moments.last().expect("moments");
        assert!(run.moments.iter().any(|i| i.sideways_m.abs() > 1e-4), "it goes sideways");
        let at = [last.travel_m, run.sideways[0]];
        let by = |a: [f64; 2]| force(Drive { at, acceleration: a, ..Drive::default() });
        let [still, along, across] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(by);
        let [m11, m12] = [along, across].map(|i| i.force_n - still.force_n);
        let [m21, m22] = [along, across].map(|i| i.guide_n - still.guide_n);
        assert!((m12 - m21).abs() < 1e-9 * m11, "a mass is symmetric: {m12} {m21}");
        let (v, u) = (last.speed_m_per_s, run.sideways[1]);
        let kinetic = 0.5 * (m11 * v * v + 2.0 * m12 * v * u + m22 * u * u) + 0.5 * weight_kg * run.weight[1] * run.weight[1];
        let put_in = pull_n * (last.travel_m - asked.start_m) + weight_kg * 9.81 * (run.weight[0] - asked.start_m);
        let lost = run.friction_j + run.damping_j + run.catches_j;
        let missing = put_in - kinetic - lost - (stored(at[0], at[1]) - stored(asked.start_m, 0.0));
        assert!(missing.abs() < 1e-8 * put_in.abs(), "{missing} J of {put_in} J, {:?}", run.end);
        assert!(run.friction_j > 0.0 && (run.damping_j > 0.0) == (damping_n_s_per_m > 0.0));
        caught = caught.max(run.catches_j);
    }
    assert!(caught > 1e-3, "the cable became taut");
}
