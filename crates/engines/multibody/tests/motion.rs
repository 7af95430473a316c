//! Motions against closed forms: pendulums, rolling, oscillators, a skate; conservation and orders.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::{FRAC_PI_2, LN_2, PI, TAU};

use forcewright_base::maths::{cos, exp, hypot, ln, sin, sin_cos};
use forcewright_base::quadrature::GaussLegendre;
use forcewright_multibody::{
    Body, BodyId, Contact, Crossing, Follows, Force, GROUND, JointId, Law, Load, Method, Model, Motion, Outputs, Path, PathPoint, Settings,
    Side, Stop, System, Torque,
};

const G: f64 = 9.81;

/// Arithmetic-geometric mean: a pendulum's period is 2π/ω0 over agm(1, cos(amplitude/2)).
fn agm(mut a: f64, mut b: f64) -> f64 {
    for _ in 0..40 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    a
}

fn pendulum_period(rate: f64, amplitude: f64) -> f64 {
    TAU / (rate * agm(1.0, cos(0.5 * amplitude)))
}

#[test]
fn pendulum_period_is_the_elliptic_integral() {
    for amplitude in [0.1, 1.0, 2.5] {
        let length = 0.7;
        let mut model = Model::new();
        model.gravity_m_per_s2 = [0.0, -G];
        let bob = model.body("bob", Body::new(1.3, 0.0).centre(length, 0.0).placed(0.0, 0.0, amplitude - FRAC_PI_2));
        model.revolute("pivot", bob.at(0.0, 0.0), GROUND.at(0.0, 0.0));
        let system = model.build().unwrap();
        let settings = Settings::until(8.0).accuracy(1e-12).event(Crossing::Falling, false, move |s| s.pose(bob).angle_rad + FRAC_PI_2);
        let run = system.simulate(system.guess(), &[], &settings);
        assert_eq!(run.stop, Stop::Reached);
        let period = run.hits[1].time_s - run.hits[0].time_s;
        let want = pendulum_period((G / length).sqrt(), amplitude);
        assert!((period / want - 1.0).abs() < 1e-9, "{amplitude}: {:e}", period / want - 1.0);
        assert!((run.hits[0].time_s - 0.25 * want).abs() < 1e-9);
    }
}

/// A rod released from the horizontal: the pivot carries 5/2 of the weight's share along the rod and 1/4 of that across.
#[test]
fn pivot_force_of_a_falling_rod() {
    let (mass, length) = (2.0, 1.5);
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -G];
    let rod = model.body("rod", Body::rod(mass, length));
    let pivot = model.revolute("pivot", rod.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    let system = model.build().unwrap();
    let run = system.simulate(system.guess(), &[], &Settings::until(0.8).accuracy(1e-11));
    for instant in run.history.iter() {
        let angle = system.pose(instant.q, rod).angle_rad;
        let (s, c) = sin_cos(angle);
        let force = system.reaction(&instant, pivot).unwrap().force_n;
        // Along the rod outwards and across it.
        let (along, across) = (force[0] * c + force[1] * s, -force[0] * s + force[1] * c);
        assert!((along - 2.5 * mass * G * s).abs() < 1e-8 && (across - 0.25 * mass * G * c).abs() < 1e-8, "{angle}");
    }
    assert!(run.audit.worst_drift_j < 1e-9);
}

/// A disc on a path of the ground, started at a parameter.
fn disc(path: Path, follows: Follows, side: Side, start: f64, [mass, inertia, radius]: [f64; 3]) -> (System, BodyId, JointId) {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -G];
    let point = path.at(start);
    let disc = model.body("disc", Body::new(mass, inertia).placed(point.point_m[0], point.point_m[1] + radius, 0.0));
    let roller = disc.at(0.0, 0.0);
    let contact = model.contact("contact", Contact { roller, radius_m: radius, cam: GROUND, path, follows, side, rolling: true, start });
    (model.build().unwrap(), disc, contact)
}

#[test]
fn disc_on_an_incline() {
    let (angle, [m, i, r]) = (0.3, [1.2, 0.004, 0.1]);
    let path = Path::Line { point_m: [0.2, 0.5], direction_rad: -angle };
    let (system, disc, contact) = disc(path, Follows::Surface, Side::Left, 0.0, [m, i, r]);
    let run = system.simulate(system.guess(), &[], &Settings::until(2.0));
    assert_eq!(run.stop, Stop::Reached);
    let a = G * sin(angle) / (1.0 + i / (m * r * r));
    let start = run.history.get(0).unwrap();
    let (u0, turned0) = (start.q[3], start.q[2]);
    for instant in run.history.iter() {
        let t = instant.time_s;
        assert!((system.parameter(instant.q, contact).unwrap() - u0 - 0.5 * a * t * t).abs() < 1e-11);
        assert!((system.pose(instant.q, disc).angle_rad - turned0 + 0.5 * a * t * t / r).abs() < 1e-10);
        let force = system.contact_force(&instant, contact).unwrap();
        assert!((force.normal_n - m * G * cos(angle)).abs() < 1e-10 && (force.traction_n + i * a / (r * r)).abs() < 1e-10, "{force:?}");
    }
}

/// A disc in a bowl is a pendulum of length (R − r)(1 + I/mr²).
#[test]
fn disc_in_a_bowl() {
    let ([m, i, r], bowl) = ([1.2, 0.004, 0.1], 0.8);
    let rate = (G / ((bowl - r) * (1.0 + i / (m * r * r)))).sqrt();
    for amplitude in [1e-4, 1.3] {
        let path = Path::Circle { centre_m: [0.1, -0.3], radius_m: bowl };
        let start = amplitude - FRAC_PI_2;
        let (system, _, contact) = disc(path, Follows::Surface, Side::Left, start, [m, i, r]);
        // Holding the parameter puts the disc where the contact is to be.
        let q = system.assemble(0.0, system.guess(), &[system.parameter_coordinate(contact).unwrap()]).unwrap().q;
        assert!((q[0] - 0.1 - (bowl - r) * sin(amplitude)).abs() < 1e-13);
        let settings = Settings::until(6.0)
            .accuracy(1e-12)
            .event(Crossing::Falling, false, move |s| s.parameter(contact).map_or(f64::NAN, |[u, _]| u + FRAC_PI_2));
        let run = system.simulate(&q, &[], &settings);
        let period = run.hits[1].time_s - run.hits[0].time_s;
        let want = pendulum_period(rate, amplitude);
        assert!((period / want - 1.0).abs() < 1e-9, "{amplitude}: {:e}", period / want - 1.0);
        // At the bottom the energy integral gives speed and normal force.
        let bottom = run.history.get(run.hits[0].state).unwrap();
        let speed2 = 2.0 * G * (bowl - r) * (1.0 - cos(amplitude)) / (1.0 + i / (m * r * r));
        let normal = m * (G + speed2 / (bowl - r));
        assert!((system.contact_force(&bottom, contact).unwrap().normal_n - normal).abs() < 1e-8);
        assert!((hypot(bottom.velocity[0], bottom.velocity[1]) - speed2.sqrt()).abs() < 1e-9);
    }
}

const WAVE: [f64; 2] = [0.05, 4.0];

/// y = h cos k u over x = u.
fn wave(u: f64) -> PathPoint {
    let [h, k] = WAVE;
    let (s, c) = sin_cos(k * u);
    PathPoint { point_m: [u, h * c], first: [1.0, -h * k * s], second: [0.0, -h * k * k * c], third: [0.0, h * k * k * k * s] }
}

/// Rolling over a wave against one coordinate: (m + I/r²) ṡ²/2 + m g y = E, time as the integral of ds/ṡ. Centre and surface.
#[test]
fn disc_on_a_wave_against_its_reduced_lagrangian() {
    let [m, i, r] = [1.2, 0.004, 0.1];
    for (follows, offset) in [(Follows::Centre, 0.0), (Follows::Surface, r)] {
        let centre = |u: f64| {
            let p = wave(u);
            let v = hypot(p.first[0], p.first[1]);
            let curvature = (p.first[0] * p.second[1] - p.first[1] * p.second[0]) / (v * v * v);
            (p.point_m[1] + offset * p.first[0] / v, v * (1.0 - offset * curvature))
        };
        let (system, _, contact) = disc(Path::curve(wave), follows, Side::Left, 0.0, [m, i, r]);
        let mut q = system.guess().to_vec();
        q[1] = centre(0.0).0;
        let speed = 0.4;
        let velocity = [speed, 0.0, -speed / r, speed / centre(0.0).1];
        let far = 2.0 * PI / WAVE[1];
        let settings = Settings::until(20.0)
            .accuracy(1e-12)
            .event(Crossing::Rising, true, move |s| s.parameter(contact).map_or(0.0, |[u, _]| u - far));
        let run = system.simulate(&q, &velocity, &settings);
        assert_eq!(run.stop, Stop::Event { index: 0 });
        let mass = m + i / (r * r);
        let energy = 0.5 * mass * speed * speed + m * G * centre(0.0).0;
        let rate = |u: f64| (2.0 * (energy - m * G * centre(u).0) / mass).sqrt() / centre(u).1;
        let rule = GaussLegendre::new(80);
        let time = far * rule.integrate(|s| 1.0 / rate(s * far));
        assert!((run.reached_s - time).abs() < 1e-9, "{follows:?}: {} {time}", run.reached_s);
        for instant in run.history.iter() {
            assert!((instant.velocity[3] - rate(instant.q[3])).abs() < 1e-8, "{follows:?}");
        }
    }
}

/// Two masses on a spring: relative motion with √(k/μ), the common centre at constant speed.
#[test]
fn two_masses_on_a_spring() {
    let ([m1, m2], rate, rest) = ([0.7, 1.9], 50.0, 0.3);
    let mut model = Model::new();
    let a = model.body("a", Body::new(m1, 1.0).placed(0.0, 0.0, 0.0));
    let b = model.body("b", Body::new(m2, 1.0).placed(0.4, 0.0, 0.0));
    model.force("spring", Force::Spring { a: a.at(0.0, 0.0), b: b.at(0.0, 0.0), law: Law::linear(rate, rest) });
    let system = model.build().unwrap();
    let mut velocity = vec![0.0; 6];
    (velocity[0], velocity[1], velocity[3], velocity[4]) = (0.2, 0.5, 0.2, 0.5);
    let run = system.simulate(system.guess(), &velocity, &Settings::until(3.0).accuracy(1e-12));
    let omega = (rate * (m1 + m2) / (m1 * m2)).sqrt();
    for instant in run.history.iter() {
        let t = instant.time_s;
        assert!((instant.q[3] - instant.q[0] - rest - 0.1 * cos(omega * t)).abs() < 1e-9);
        let centre = (m1 * instant.q[0] + m2 * instant.q[3]) / (m1 + m2);
        assert!((centre - (m2 * 0.4 / (m1 + m2) + 0.2 * t)).abs() < 1e-12 && (instant.q[1] - 0.5 * t).abs() < 1e-12);
    }
}

/// Chaplygin's sleigh, centre of mass a ahead of the blade: v = V tanh κt, ω = V √(m/J) sech κt, J = I + m a², κ = m a V/J.
/// S. A. Chaplygin 1911; no position row can express it.
#[test]
fn sleigh_with_a_blade() {
    let (m, i, a, v_end) = (1.4, 0.05, 0.2, 1.1);
    let j = i + m * a * a;
    let kappa = m * a * v_end / j;
    let mut model = Model::new();
    let sleigh = model.body("sleigh", Body::new(m, i).centre(a, 0.0));
    model.skate("blade", sleigh.at(0.0, 0.0), FRAC_PI_2);
    let system = model.build().unwrap();
    let start = -1.5;
    let omega = v_end * (m / j).sqrt() / (0.5 * (exp(kappa * start) + exp(-kappa * start)));
    let tanh = |x: f64| 1.0 - 2.0 / (exp(2.0 * x) + 1.0);
    let velocity = [v_end * tanh(kappa * start), a * omega, omega];
    let run = system.simulate(system.guess(), &velocity, &Settings::until(3.0).accuracy(1e-12));
    assert_eq!(run.stop, Stop::Reached);
    for instant in run.history.iter() {
        let t = start + instant.time_s;
        let (s, c) = sin_cos(instant.q[2]);
        let forward = c * instant.velocity[0] + s * instant.velocity[1];
        assert!((forward - v_end * tanh(kappa * t)).abs() < 1e-10, "{t}: {forward}");
    }
    assert!(run.audit.worst_drift_j < 1e-10);
}

/// A chain of two rods in space without gravity: momentum and angular momentum about the origin stay.
#[test]
fn free_chain_keeps_momentum_and_energy() {
    let mut model = Model::new();
    let a = model.body("a", Body::rod(1.0, 0.5).placed(0.1, 0.2, 0.3));
    let b = model.body("b", Body::rod(2.0, 0.8).placed(0.1 + 0.5 * cos(0.3), 0.2 + 0.5 * sin(0.3), 1.4));
    model.revolute("hinge", b.at(0.0, 0.0), a.at(0.5, 0.0));
    model.force("spring", Force::TorsionSpring { a, b, law: Law::linear(0.4, 0.0) });
    let system = model.build().unwrap();
    let velocity = [0.3, -0.2, 4.0, 0.1, 0.5, -3.0];
    let run = system.simulate(system.guess(), &velocity, &Settings::until(5.0).accuracy(1e-11));
    let momentum = |k: usize| {
        let i = run.history.get(k).unwrap();
        let mut sum = [0.0; 3];
        for (c, m, inertia) in [(0, 1.0, 0.25 / 12.0), (3, 2.0, 2.0 * 0.64 / 12.0)] {
            let (q, v) = (&i.q[c..], &i.velocity[c..]);
            sum[0] += m * v[0];
            sum[1] += m * v[1];
            sum[2] += m * (q[0] * v[1] - q[1] * v[0]) + inertia * v[2];
        }
        sum
    };
    let (start, end) = (momentum(0), momentum(run.history.len() - 1));
    assert!((0..3).all(|k| (start[k] - end[k]).abs() < 1e-9), "{start:?} {end:?}");
    assert!(run.audit.worst_drift_j < 1e-9, "{:e}", run.audit.worst_drift_j);
}

fn double_pendulum() -> System {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -G];
    let a = model.body("a", Body::rod(1.0, 0.5).placed(0.0, 0.0, 0.4));
    let b = model.body("b", Body::rod(0.6, 0.4).placed(0.5 * cos(0.4), 0.5 * sin(0.4), -0.3));
    model.revolute("shoulder", a.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    model.revolute("elbow", b.at(0.0, 0.0), a.at(0.5, 0.0));
    model.build().unwrap()
}

#[test]
fn classical_method_has_order_four() {
    let system = double_pendulum();
    let end = |method| {
        let settings = Settings { method, outputs: Outputs::At(vec![1.0]), ..Settings::until(1.0) };
        let run = system.simulate(system.guess(), &[], &settings);
        assert_eq!(run.stop, Stop::Reached);
        run.history.last().unwrap().q.to_vec()
    };
    let exact = end(Method::Adaptive { accuracy: 1e-13, longest_step_s: f64::INFINITY });
    let miss = |project, steps| {
        let q = end(Method::Fixed { steps, project });
        q.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let order = |project| ln(miss(project, 200) / miss(project, 400)) / LN_2;
    assert!((order(false) - 4.0).abs() < 0.25, "{} {:e}", order(false), miss(false, 400));
    // Projection takes away the part of the error that leaves the constraints, and lowers no order.
    assert!(order(true) > 3.9 && miss(true, 400) < miss(false, 400), "{} {:e}", order(true), miss(true, 400));
}

#[test]
fn adaptive_error_follows_the_accuracy_asked_for() {
    let system = double_pendulum();
    let end = |accuracy| {
        let run = system.simulate(system.guess(), &[], &Settings::until(2.0).accuracy(accuracy));
        (run.history.last().unwrap().q.to_vec(), run.steps, run.audit.worst_drift_j)
    };
    let exact = end(1e-13).0;
    for accuracy in [1e-5, 1e-7, 1e-9, 1e-11] {
        let (q, steps, drift) = end(accuracy);
        let miss = q.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Errors of steps add up, and the pendulum doubles them a few times.
        assert!(miss < 200.0 * accuracy && drift < 200.0 * accuracy, "{accuracy:e}: {miss:e} {drift:e} in {steps}");
    }
}

/// Every kind of work at once: the audit closes, and the damper's heat is that of the closed form where there is one.
#[test]
fn energy_audit_closes_with_dampers_drivers_and_loads() {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -G];
    let cart = model.body("cart", Body::new(2.0, 0.1));
    let rod = model.body("rod", Body::rod(0.5, 0.6).placed(0.0, 0.0, -1.0));
    model.prismatic("rail", cart.at(0.0, 0.0), GROUND.at(0.0, 0.0), 0.0, 0.0);
    model.revolute("pin", rod.at(0.0, 0.0), cart.at(0.0, 0.0));
    let shake = Motion::Harmonic { mean: 0.0, amplitude: 0.1, rate_rad_per_s: 5.0, phase_rad: 0.0 };
    model.drive_along("shaker", cart.at(0.0, 0.0), GROUND.at(0.0, 0.0), 0.0, shake);
    model.force("damper", Force::TorsionDamper { a: rod, b: cart, damping_nm_s_per_rad: 0.02 });
    model.force("dashpot", Force::Damper { a: rod.at(0.6, 0.0), b: GROUND.at(0.3, 0.4), damping_n_s_per_m: 0.3 });
    model.force("spring", Force::Spring { a: rod.at(0.6, 0.0), b: GROUND.at(0.3, 0.4), law: Law::linear(5.0, 0.2) });
    model.force("jet", Force::Push { at: rod.at(0.6, 0.0), load: Load::Following([0.0, 0.4]) });
    let gust = Load::Function(std::sync::Arc::new(|s| [0.3 * sin(2.0 * s.time_s), 0.0]));
    model.force("gust", Force::Push { at: rod.at(0.3, 0.0), load: gust });
    model.force("motor", Force::Torque { on: rod, from: cart, torque: Torque::Fixed(0.1) });
    let system = model.build().unwrap();
    let run = system.simulate(system.guess(), &[], &Settings::until(4.0).accuracy(1e-10));
    assert_eq!(run.stop, Stop::Reached);
    let end = run.audit.end;
    assert!(end.dissipated_j > 0.1 && end.driver_work_j.abs() > 0.02 && end.applied_work_j.abs() > 0.05, "{end:?}");
    assert!(run.audit.worst_drift_j < 1e-7, "{:e}", run.audit.worst_drift_j);
}

/// m ẍ + c ẋ = 0: the heat is the kinetic energy lost, ½ m v² (1 − exp(−2ct/m)).
#[test]
fn damper_brakes_exponentially() {
    let mut model = Model::new();
    let cart = model.body("cart", Body::new(2.0, 0.1).placed(1.0, 0.0, 0.0));
    model.prismatic("rail", cart.at(0.0, 0.0), GROUND.at(0.0, 0.0), 0.0, 0.0);
    model.force("damper", Force::Damper { a: cart.at(0.0, 0.0), b: GROUND.at(0.0, 0.0), damping_n_s_per_m: 1.5 });
    let system = model.build().unwrap();
    let run = system.simulate(system.guess(), &[0.8, 0.0, 0.0], &Settings::until(1.0).accuracy(1e-12));
    let want = 0.64 * (1.0 - exp(-1.5));
    assert!((run.audit.end.dissipated_j - want).abs() < 1e-10);
}

#[test]
fn events_have_direction_and_may_end_the_motion() {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -G];
    let ball = model.body("ball", Body::new(0.3, 0.1).placed(0.0, 2.0, 0.0));
    let system = model.build().unwrap();
    let height = move |s: &forcewright_multibody::Snapshot<'_>| s.position_m(ball.at(0.0, 0.0))[1];
    let settings = Settings::until(5.0)
        .event(Crossing::Rising, false, move |s| height(s) - 2.5)
        .event(Crossing::Falling, false, move |s| height(s) - 2.5)
        .event(Crossing::Any, true, height);
    let run = system.simulate(system.guess(), &[0.0, 4.0, 0.0], &settings);
    assert_eq!(run.stop, Stop::Event { index: 2 });
    let at = |h: f64, sign: f64| (4.0 + sign * (16.0 - 2.0 * G * (h - 2.0)).sqrt()) / G;
    let want = [(0, at(2.5, -1.0)), (1, at(2.5, 1.0)), (2, at(0.0, 1.0))];
    assert_eq!(run.hits.len(), 3);
    for (hit, (event, time)) in run.hits.iter().zip(want) {
        assert!(hit.event == event && (hit.time_s - time).abs() < 1e-12, "{hit:?} {time}");
        assert!((run.history.get(hit.state).unwrap().time_s - time).abs() < 1e-12);
    }
    assert!((run.reached_s - want[2].1).abs() < 1e-12 && run.history.last().unwrap().q[1].abs() < 1e-11);
}

/// A lever without mass, pushed at its middle, moves a ball at its end: the ball feels half the force. Forward dynamics carries loads on
/// massless bodies to those with mass.
#[test]
fn lever_without_mass_carries_its_load() {
    let (mass, length) = (0.6, 0.5);
    let mut model = Model::new();
    let lever = model.body("lever", Body::new(0.0, 0.0));
    let ball = model.body("ball", Body::new(mass, 0.01).placed(length, 0.0, 0.0));
    let pivot = model.revolute("pivot", lever.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    model.revolute("end", ball.at(0.0, 0.0), lever.at(length, 0.0));
    model.force("push", Force::Push { at: lever.at(0.5 * length, 0.0), load: Load::Following([0.0, 3.0]) });
    let system = model.build().unwrap();
    let run = system.simulate(system.guess(), &[], &Settings::until(0.5).accuracy(1e-11));
    assert_eq!(run.stop, Stop::Reached);
    for instant in run.history.iter() {
        // Angular acceleration F/(2 m L), constant; the pivot carries the other half and the centripetal force.
        let (rate, t) = (3.0 / (2.0 * mass * length), instant.time_s);
        assert!((system.pose(instant.q, lever).angle_rad - 0.5 * rate * t * t).abs() < 1e-9);
        let force = system.reaction(&instant, pivot).unwrap().force_n;
        let want = hypot(1.5, mass * length * (rate * t) * (rate * t));
        assert!((hypot(force[0], force[1]) - want).abs() < 1e-8, "{t}: {force:?} {want}");
    }
}
