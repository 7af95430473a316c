//! The cam-and-spring mechanism of Sánchez-Salinas et al. 2022, section 4, as five general bodies, against its reduced Lagrangian:
//! F = dV/ds + M(s) s̈ + M′(s) ṡ²/2 with one coordinate, the slider's travel s.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::FRAC_PI_2;

use forcewright_multibody::{
    Body, Contact, Follows, Force, GROUND, Grid, JointId, Kinematics, Law, Model, Motion, Path, PathPoint, Settings, Side, Stop, System,
};

// Table 1 and section 4 of the paper, SI. The rate is that of two springs.
const A: f64 = 0.009_058;
const BRACE: f64 = 0.2;
const X0: f64 = 0.068;
const RADIUS: f64 = 0.016;
const RATE: f64 = 1380.0;
const M2: f64 = 0.068;
const M3: f64 = 0.077;
const M4: f64 = 0.38;
const I3: f64 = 2.57e-4;
const I4: f64 = 4.61e-6;
const GRAVITY: f64 = 9.81;
const START: f64 = 0.22;
const STROKE: f64 = 0.1;
const DURATION: f64 = 0.125;

/// Height of the brace's pin over the roller.
fn rise(x: f64) -> f64 {
    (BRACE * BRACE - x * x).sqrt()
}

/// Path of the right roller's centre for a constant force without friction: Δ² = 2 A s, y = s + √(l² − x0²) − √(l² − x²), by x.
fn path(x: f64, side: f64) -> PathPoint {
    let (delta, c) = (x - X0, rise(x));
    let l2 = BRACE * BRACE;
    let y = [delta * delta / (2.0 * A) + rise(X0) - c, delta / A + x / c, 1.0 / A + l2 / (c * c * c), 3.0 * l2 * x / (c * c * c * c * c)];
    PathPoint { point_m: [side * x, y[0]], first: [side, y[1]], second: [0.0, y[2]], third: [0.0, y[3]] }
}

struct Mechanism {
    system: System,
    /// None where the slider is free.
    driver: Option<JointId>,
    contacts: [JointId; 2],
}

fn mechanism(motion: Option<&Motion>) -> Mechanism {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -GRAVITY];
    let slider = model.body("slider", Body::new(M2, 1e-3).placed(0.0, START, 0.0));
    model.prismatic("guide", slider.at(0.0, 0.0), GROUND.at(0.0, 0.0), FRAC_PI_2, 0.0);
    let mut rollers = Vec::new();
    let mut contacts = Vec::new();
    for (side, name) in [(1.0, "right"), (-1.0, "left")] {
        let (x, y) = (0.092, START - rise(0.092));
        let angle = if side > 0.0 { -1.092 } else { -2.05 };
        let mut brace = Body::rod(M3, BRACE).placed(0.0, START, angle);
        brace.inertia_kg_m2 = I3;
        let brace = model.body(format!("{name} brace"), brace);
        let roller = model.body(format!("{name} roller"), Body::new(M4, I4).placed(side * x, y, 0.0));
        model.revolute(format!("{name} pin"), brace.at(0.0, 0.0), slider.at(0.0, 0.0));
        model.revolute(format!("{name} axle"), roller.at(0.0, 0.0), brace.at(BRACE, 0.0));
        contacts.push(model.contact(
            format!("{name} cam"),
            Contact {
                roller: roller.at(0.0, 0.0),
                radius_m: RADIUS,
                cam: GROUND,
                path: Path::curve(move |x: f64| path(x, side)),
                follows: Follows::Centre,
                side: if side > 0.0 { Side::Right } else { Side::Left },
                rolling: true,
                start: x,
            },
        ));
        rollers.push(roller);
    }
    let spring = Force::Spring { a: rollers[0].at(0.0, 0.0), b: rollers[1].at(0.0, 0.0), law: Law::linear(RATE, 2.0 * X0) };
    model.force("springs", spring);
    let driver = motion.map(|motion| model.drive_along("pull", slider.at(0.0, 0.0), GROUND.at(0.0, 0.0), FRAC_PI_2, motion.clone()));
    Mechanism { system: model.build().unwrap(), driver, contacts: [contacts[0], contacts[1]] }
}

/// Eq. (17).
fn pull() -> Motion {
    Motion::Cycloid { start: START, stroke: STROKE, duration_s: DURATION }
}

/// The mechanism with one coordinate.
struct Reduced {
    force: f64,
    mass: f64,
    energy: f64,
    x: f64,
}

fn reduced([s2, rate, acceleration]: [f64; 3]) -> Reduced {
    let travel = s2 - rise(X0);
    let delta = (2.0 * A * travel).sqrt();
    let x = X0 + delta;
    let (x1, x2) = (A / delta, -A * A / (delta * delta * delta));
    let tan = x / rise(x);
    let tan1 = x1 * BRACE * BRACE / (rise(x) * rise(x) * rise(x));
    let (y1, y2) = (1.0 + tan * x1, tan1 * x1 + tan * x2);
    let l2 = BRACE * BRACE;
    let roller = M4 + I4 / (RADIUS * RADIUS);
    let mass = M2
        + 2.0 * roller * (x1 * x1 + y1 * y1)
        + 2.0 * (M3 * (x1 * x1 + (1.0 + y1) * (1.0 + y1)) / 4.0 + I3 * (x1 * x1 + (y1 - 1.0) * (y1 - 1.0)) / l2);
    let half_slope =
        2.0 * roller * (x1 * x2 + y1 * y2) + 2.0 * (M3 * (x1 * x2 + (1.0 + y1) * y2) / 4.0 + I3 * (x1 * x2 + (y1 - 1.0) * y2) / l2);
    let y = s2 - rise(x);
    let weight = GRAVITY * (M2 + 2.0 * M4 * y1 + M3 * (1.0 + y1));
    let force = 4.0 * RATE * A + weight + mass * acceleration + half_slope * rate * rate;
    let energy = 4.0 * RATE * A * travel + GRAVITY * (M2 * s2 + 2.0 * M4 * y + M3 * (s2 + y));
    Reduced { force, mass, energy, x }
}

fn worst(steps: usize, kinematics: Kinematics) -> f64 {
    let Mechanism { system, driver, .. } = mechanism(Some(&pull()));
    let run = system.inverse(system.guess(), Grid { start_s: 0.0, end_s: DURATION, steps }, kinematics);
    assert_eq!(run.stop, Stop::Reached, "{}", run.stop);
    run.history
        .iter()
        .map(|i| (system.driver_force(&i, driver.unwrap()).unwrap() - reduced(pull().at(i.time_s)).force).abs())
        .fold(0.0, f64::max)
}

#[test]
fn force_agrees_with_the_reduced_lagrangian() {
    let algebraic = worst(200, Kinematics::Algebraic);
    assert!(algebraic < 1e-12, "{algebraic:e}");
    let baumgarte = Kinematics::Baumgarte { rate_per_s: 10.0 / DURATION };
    let errors = [100, 200, 400].map(|steps| worst(steps, baumgarte));
    assert!(errors[0] < 1.5e-6 && errors[1] < errors[0] / 14.0 && errors[2] < errors[1] / 14.0, "{errors:?}");
    // A stabilisation that is stiff for the step harms.
    assert!(worst(100, Kinematics::Baumgarte { rate_per_s: 1000.0 }) > 10.0 * errors[0]);
}

/// Values of an independent program (nine coordinates as in the paper) at t = 0.03 s.
#[test]
fn forces_of_slider_and_contact_as_computed_elsewhere() {
    let Mechanism { system, driver, contacts } = mechanism(Some(&pull()));
    let run = system.inverse(system.guess(), Grid { start_s: 0.0, end_s: DURATION, steps: 25 }, Kinematics::Algebraic);
    let instant = run.history.get(6).unwrap();
    assert!((system.driver_force(&instant, driver.unwrap()).unwrap() - 118.153_858_920_596_53).abs() < 1e-9);
    for contact in contacts {
        let force = system.contact_force(&instant, contact).unwrap();
        assert!((force.normal_n - 113.269_885_547_815_32).abs() < 1e-8, "{force:?}");
        assert!((force.traction_n.abs() - 0.862_102_303_959_668_4).abs() < 1e-9, "{force:?}");
        let x = system.parameter(instant.q, contact).unwrap();
        assert!((x - reduced(pull().at(instant.time_s)).x).abs() < 1e-14);
    }
}

/// Let go from rest, the slider falls back as the reduced energy says: M(s) ṡ²/2 + V(s) = V(start).
#[test]
fn released_mechanism_keeps_the_reduced_energy() {
    let Mechanism { system, .. } = mechanism(None);
    let assembled = system.assemble(0.0, system.guess(), &[1]).unwrap();
    assert_eq!(assembled.freedom, 1);
    let run = system.simulate(&assembled.q, &[], &Settings::until(0.03).accuracy(1e-12));
    assert_eq!(run.stop, Stop::Reached);
    assert!(run.audit.worst_drift_j < 1e-10, "{:e}", run.audit.worst_drift_j);
    let start = reduced([START, 0.0, 0.0]);
    for instant in run.history.iter() {
        let here = reduced([instant.q[1], instant.velocity[1], 0.0]);
        let kinetic = 0.5 * here.mass * instant.velocity[1] * instant.velocity[1];
        assert!((kinetic + here.energy - start.energy).abs() < 1e-10, "{}", instant.time_s);
    }
    assert!(run.history.last().unwrap().q[1] < START - 0.008);
}
