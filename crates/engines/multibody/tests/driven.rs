//! Mechanisms driven in all freedoms against closed forms: slider-crank, four-bar, five-bar, gears.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::{FRAC_PI_2, TAU};

use forcewright_base::maths::{acos, atan2, cos, hypot, sin, sin_cos};
use forcewright_multibody::{Body, BodyId, Force, GROUND, Grid, Instant, JointId, Kinematics, Law, Load, Model, Motion, Stop, System};

const CRANK_M: f64 = 0.05;
const ROD_M: f64 = 0.15;
const MASSES_KG: [f64; 3] = [0.2, 0.3, 0.5];
const GRAVITY: f64 = 9.81;
const SPEED: f64 = 100.0;

struct SliderCrank {
    system: System,
    motor: JointId,
    guide: JointId,
    slider: BodyId,
}

/// The slider runs along x; its cylinder presses with a force that depends on its place.
fn slider_crank() -> SliderCrank {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -GRAVITY];
    let crank = model.body("crank", Body::rod(MASSES_KG[0], CRANK_M).placed(0.0, 0.0, 0.5));
    let rod = model.body("rod", Body::rod(MASSES_KG[1], ROD_M).placed(0.044, 0.024, -0.16));
    let slider = model.body("slider", Body::new(MASSES_KG[2], 1e-4).placed(0.19, 0.0, 0.0));
    model.revolute("main pin", crank.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    model.revolute("crank pin", rod.at(0.0, 0.0), crank.at(CRANK_M, 0.0));
    model.revolute("wrist pin", slider.at(0.0, 0.0), rod.at(ROD_M, 0.0));
    let guide = model.prismatic("guide", slider.at(0.0, 0.0), GROUND.at(0.0, 0.0), 0.0, 0.0);
    let motor = model.drive_angle("motor", crank, GROUND, Motion::Polynomial { start: 0.5, rate: SPEED, acceleration: 40.0 });
    model.force("gas", Force::Spring { a: slider.at(0.0, 0.0), b: GROUND.at(0.4, 0.0), law: Law::linear(300.0, 0.4) });
    SliderCrank { system: model.build().unwrap(), motor, guide, slider }
}

/// Slider place and its first two derivatives by the crank angle, and those of the rod's angle.
fn crank_geometry(theta: f64) -> ([f64; 3], [f64; 3]) {
    let (s, c) = sin_cos(theta);
    let n = CRANK_M / ROD_M;
    // sin φ = −n sin θ
    let root = (1.0 - n * n * s * s).sqrt();
    let phi1 = -n * c / root;
    let phi2 = n * s * (1.0 - n * n) / (root * root * root);
    let angle = atan2(-n * s, root);
    let (sp, cp) = sin_cos(angle);
    let x = CRANK_M * c + ROD_M * cp;
    let x1 = -CRANK_M * s - ROD_M * sp * phi1;
    let x2 = -CRANK_M * c - ROD_M * (cp * phi1 * phi1 + sp * phi2);
    ([x, x1, x2], [angle, phi1, phi2])
}

/// Torque of the crank by virtual power: Σ (m a − F)·∂v/∂θ̇ + I α ∂ω/∂θ̇.
fn crank_torque(theta: f64, rate: f64, acceleration: f64) -> f64 {
    let ([x, x1, x2], [phi, phi1, phi2]) = crank_geometry(theta);
    let second = |first: f64, second: f64| first * acceleration + second * rate * rate;
    let (s, c) = sin_cos(theta);
    let (sp, cp) = sin_cos(phi);
    let half = 0.5 * ROD_M;
    // Middle of the rod: derivatives by θ.
    let g1 = [-CRANK_M * s - half * sp * phi1, CRANK_M * c + half * cp * phi1];
    let g2 = [-CRANK_M * c - half * (cp * phi1 * phi1 + sp * phi2), -CRANK_M * s + half * (-sp * phi1 * phi1 + cp * phi2)];
    let [m1, m2, m3] = MASSES_KG;
    let crank = m1 * CRANK_M * CRANK_M / 3.0 * acceleration + m1 * GRAVITY * 0.5 * CRANK_M * c;
    let rod = m2 * (g1[0] * second(g1[0], g2[0]) + g1[1] * (second(g1[1], g2[1]) + GRAVITY))
        + m2 * ROD_M * ROD_M / 12.0 * phi1 * second(phi1, phi2);
    // The spring's length is 0.4 − x: its tension draws the slider towards +x.
    let gas = 300.0 * ((0.4 - x) - 0.4);
    crank + rod + x1 * (m3 * second(x1, x2) - gas)
}

#[test]
fn slider_crank_kinematics_and_torque_in_closed_form() {
    let SliderCrank { system, motor, guide, slider } = slider_crank();
    let grid = Grid { start_s: 0.0, end_s: TAU / SPEED, steps: 90 };
    let run = system.inverse(system.guess(), grid, Kinematics::Algebraic);
    assert_eq!(run.stop, Stop::Reached);
    assert!(run.redundant.is_empty() && run.worst_miss < 1e-12 && run.history.len() == 91);
    let column = system.first_coordinate(slider).unwrap();
    for instant in run.history.iter() {
        let t = instant.time_s;
        let (theta, rate) = (0.5 + SPEED * t + 20.0 * t * t, SPEED + 40.0 * t);
        let ([x, x1, x2], _) = crank_geometry(theta);
        assert!((instant.q[column] - x).abs() < 1e-13);
        assert!((instant.velocity[column] - x1 * rate).abs() < 1e-11);
        assert!((instant.acceleration[column] - (x1 * 40.0 + x2 * rate * rate)).abs() < 1e-8);
        let torque = system.driver_force(&instant, motor).unwrap();
        let want = crank_torque(theta, rate, 40.0);
        assert!((torque - want).abs() < 1e-10, "{t}: {torque} {want}");
        // The guide carries no force along the slide, and the slider's own balance gives the rest.
        assert!(system.reaction(&instant, guide).unwrap().force_n[0].abs() < 1e-12);
    }
}

#[test]
fn integrated_kinematics_converge_with_order_four_to_the_algebraic_ones() {
    let SliderCrank { system, motor, .. } = slider_crank();
    let torque = |kinematics, steps| -> Vec<f64> {
        let grid = Grid { start_s: 0.0, end_s: TAU / SPEED, steps };
        let run = system.inverse(system.guess(), grid, kinematics);
        assert_eq!(run.stop, Stop::Reached);
        run.history.iter().step_by(steps / 50).map(|instant| system.driver_force(&instant, motor).unwrap()).collect()
    };
    let exact = torque(Kinematics::Algebraic, 50);
    let miss = |steps| {
        let integrated = torque(Kinematics::Baumgarte { rate_per_s: 160.0 }, steps);
        integrated.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (miss(100), miss(200));
    assert!(coarse < 1e-3 && coarse / fine > 13.0 && coarse / fine < 19.0, "{coarse:e} {fine:e}");
}

/// Over many turns the constraints drift without stabilisation and less with it; a β that is large for the step harms.
#[test]
fn baumgarte_stabilisation_holds_the_drift() {
    let SliderCrank { system, .. } = slider_crank();
    let miss = |turns: u32, rate_per_s| {
        let grid = Grid { start_s: 0.0, end_s: f64::from(turns) * TAU / SPEED, steps: 40 * turns as usize };
        system.inverse(system.guess(), grid, Kinematics::Baumgarte { rate_per_s }).worst_miss
    };
    let (free, held) = (miss(80, 0.0), miss(80, 50.0));
    assert!(free > 5.0 * held, "{free:e} {held:e}");
    let (short, harmed) = (miss(1, 10.0), miss(1, 200.0));
    assert!(harmed > 20.0 * short, "{short:e} {harmed:e}");
}

/// Freudenstein's equation for the rocker of a four-bar: K1 cos ψ − K2 cos θ + K3 = cos(θ − ψ); F. Freudenstein 1955.
fn rocker(theta: f64, [a, b, c, d]: [f64; 4]) -> f64 {
    let (s, co) = sin_cos(theta);
    let (k1, k2, k3) = (d / a, d / c, (a * a - b * b + c * c + d * d) / (2.0 * a * c));
    // A sin ψ + B cos ψ = C, the open branch.
    let (p, q, r) = (s, co - k1, k3 - k2 * co);
    let size = hypot(p, q);
    atan2(p, q) - acos((r / size).clamp(-1.0, 1.0))
}

#[test]
fn four_bar_positions_and_static_torque() {
    let [a, b, c, d] = [0.04, 0.12, 0.09, 0.11];
    let links = [a, b, c, d];
    let (rate, rest, eye, anchor) = (800.0, 0.05, 0.03, [0.16, 0.02]);
    let mut model = Model::new();
    let start = 1.0;
    let psi = rocker(start, links);
    let pin = [a * cos(start), a * sin(start)];
    let far = [d + c * cos(psi), c * sin(psi)];
    let crank = model.body("crank", Body::new(0.0, 0.0).placed(0.0, 0.0, start));
    let coupler = model.body("coupler", Body::new(0.0, 0.0).placed(pin[0], pin[1], atan2(far[1] - pin[1], far[0] - pin[0])));
    let lever = model.body("rocker", Body::new(0.0, 0.0).placed(d, 0.0, psi));
    model.revolute("o2", crank.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    model.revolute("a", coupler.at(0.0, 0.0), crank.at(a, 0.0));
    model.revolute("b", lever.at(c, 0.0), coupler.at(b, 0.0));
    model.revolute("o4", lever.at(0.0, 0.0), GROUND.at(d, 0.0));
    let motor = model.drive_angle("motor", crank, GROUND, Motion::Polynomial { start, rate: 1.0, acceleration: 0.0 });
    let spring = Force::Spring { a: lever.at(eye, 0.01), b: GROUND.at(anchor[0], anchor[1]), law: Law::linear(rate, rest) };
    model.force("spring", spring);
    let system = model.build().unwrap();
    let run = system.inverse(system.guess(), Grid { start_s: 0.0, end_s: TAU, steps: 72 }, Kinematics::Algebraic);
    assert_eq!(run.stop, Stop::Reached);
    let energy = |theta: f64| {
        let psi = rocker(theta, links);
        let end = [d + eye * cos(psi) - 0.01 * sin(psi), eye * sin(psi) + 0.01 * cos(psi)];
        let stretch = hypot(end[0] - anchor[0], end[1] - anchor[1]) - rest;
        0.5 * rate * stretch * stretch
    };
    for instant in run.history.iter() {
        let theta = start + instant.time_s;
        let turn = system.pose(instant.q, lever).angle_rad - rocker(theta, links);
        assert!((turn - TAU * (turn / TAU).round()).abs() < 1e-12, "{theta}: {turn}");
        // Virtual work: without masses the torque is the slope of the energy; difference of order 4.
        let h = 1e-3;
        let slope = (8.0 * (energy(theta + h) - energy(theta - h)) - energy(theta + 2.0 * h) + energy(theta - 2.0 * h)) / (12.0 * h);
        let torque = system.driver_force(&instant, motor).unwrap();
        assert!((torque - slope).abs() < 1e-9, "{theta}: {torque} {slope}");
    }
}

/// Angle of the first link of a leg from `base` with lengths `a`, `b` that reaches a point; `side` ±1 is the elbow's.
fn leg(base: [f64; 2], point: [f64; 2], [a, b]: [f64; 2], side: f64) -> f64 {
    let (dx, dy) = (point[0] - base[0], point[1] - base[1]);
    let reach = hypot(dx, dy);
    atan2(dy, dx) + side * acos((a * a + reach * reach - b * b) / (2.0 * a * reach))
}

/// The tip of a five-bar follows a circle; the crank angles are those of the closed inverse kinematics, and the torques against a force at
/// the tip its virtual power.
#[test]
fn five_bar_inverse_kinematics() {
    let (base, links) = (0.1, [0.09, 0.13]);
    let circle = |t: f64| [0.05 + 0.02 * cos(t), 0.15 + 0.02 * sin(t)];
    let mut model = Model::new();
    let mut bar = |name: &str, x: f64, y: f64, angle: f64| model.body(name, Body::new(0.0, 0.0).placed(x, y, angle));
    let (left, right) = (bar("left", 0.0, 0.0, 2.2), bar("right", base, 0.0, 0.9));
    let (left_rod, right_rod) = (bar("left rod", -0.05, 0.07, 0.6), bar("right rod", 0.15, 0.07, 2.5));
    model.revolute("o1", left.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    model.revolute("o2", right.at(0.0, 0.0), GROUND.at(base, 0.0));
    model.revolute("a1", left_rod.at(0.0, 0.0), left.at(links[0], 0.0));
    model.revolute("a2", right_rod.at(0.0, 0.0), right.at(links[0], 0.0));
    let tip = left_rod.at(links[1], 0.0);
    model.revolute("tip", right_rod.at(links[1], 0.0), tip);
    let x = Motion::Harmonic { mean: 0.05, amplitude: 0.02, rate_rad_per_s: 1.0, phase_rad: FRAC_PI_2 };
    let y = Motion::Harmonic { mean: 0.15, amplitude: 0.02, rate_rad_per_s: 1.0, phase_rad: 0.0 };
    let push_x = model.drive_along("x", tip, GROUND.at(0.0, 0.0), 0.0, x);
    let push_y = model.drive_along("y", tip, GROUND.at(0.0, 0.0), FRAC_PI_2, y);
    let law = Law::linear(0.7, 0.3);
    model.force("spring", Force::TorsionSpring { a: left, b: GROUND, law: law.clone() });
    let system = model.build().unwrap();
    let run = system.inverse(system.guess(), Grid { start_s: 0.0, end_s: TAU, steps: 60 }, Kinematics::Algebraic);
    assert_eq!(run.stop, Stop::Reached);
    for instant in run.history.iter() {
        let point = circle(instant.time_s);
        let want = [leg([0.0, 0.0], point, links, 1.0), leg([base, 0.0], point, links, -1.0)];
        let got = [left, right].map(|body| system.pose(instant.q, body).angle_rad);
        assert!((0..2).all(|k| (got[k] - want[k]).abs() < 1e-12), "{got:?} {want:?}");
        // Force at the tip: the torque of the spring over the lever of the left leg.
        let slope = |dx: f64, dy: f64| {
            let h = 1e-4;
            let at = |s: f64| leg([0.0, 0.0], [point[0] + s * h * dx, point[1] + s * h * dy], links, 1.0);
            (8.0 * (at(1.0) - at(-1.0)) - at(2.0) + at(-2.0)) / (12.0 * h)
        };
        let torque = law.at(want[0])[0];
        for (driver, slope) in [(push_x, slope(1.0, 0.0)), (push_y, slope(0.0, 1.0))] {
            let force = system.driver_force(&instant, driver).unwrap();
            assert!((force - torque * slope).abs() < 1e-8, "{force} {}", torque * slope);
        }
    }
}

/// Two gears of inertia I1, I2 and ratio −2: the driver of the first feels I1 + 4 I2. A belt keeps its offset.
#[test]
fn gears_carry_inertia_by_the_square_of_the_ratio() {
    let mut model = Model::new();
    let first = model.body("first", Body::new(1.0, 0.02));
    let second = model.body("second", Body::new(1.0, 0.03).placed(0.3, 0.0, 0.1));
    model.revolute("o1", first.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    model.revolute("o2", second.at(0.0, 0.0), GROUND.at(0.3, 0.0));
    model.gear("mesh", second, first, -2.0, 0.1);
    let motor = model.drive_angle("motor", first, GROUND, Motion::Polynomial { start: 0.0, rate: 0.0, acceleration: 5.0 });
    let system = model.build().unwrap();
    let run = system.inverse(system.guess(), Grid { start_s: 0.0, end_s: 1.0, steps: 4 }, Kinematics::Algebraic);
    let last = run.history.last().unwrap();
    assert!((system.driver_force(&last, motor).unwrap() - 5.0 * (0.02 + 4.0 * 0.03)).abs() < 1e-14);
    assert!((system.pose(last.q, second).angle_rad - (0.1 - 2.0 * 2.5)).abs() < 1e-14);
}

/// A bar hung from two rods without mass: each carries half of weight and load, as tension.
#[test]
fn rods_carry_tension() {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -GRAVITY];
    let bar = model.body("bar", Body::new(2.0, 0.1).placed(0.0, -1.0, 0.0));
    let rods = [-0.5, 0.5].map(|x| model.rod("rod", bar.at(x, 0.0), GROUND.at(x, 0.0), 1.0));
    model.drive_along("side", bar.at(0.0, 0.0), GROUND.at(0.0, 0.0), 0.0, Motion::Constant(0.0));
    model.force("load", Force::Push { at: bar.at(0.25, 0.0), load: Load::Fixed([0.0, -8.0]) });
    let system = model.build().unwrap();
    let run = system.inverse(system.guess(), Grid { start_s: 0.0, end_s: 1.0, steps: 1 }, Kinematics::Algebraic);
    let last: Instant<'_> = run.history.last().unwrap();
    let tension = rods.map(|rod| last.multipliers[system.joint_rows(rod).unwrap().start]);
    assert!((tension[0] - (GRAVITY + 2.0)).abs() < 1e-13 && (tension[1] - (GRAVITY + 6.0)).abs() < 1e-13, "{tension:?}");
    let pull = system.reaction(&last, rods[1]).unwrap();
    assert!((pull.force_n[1] - (GRAVITY + 6.0)).abs() < 1e-13 && pull.torque_nm.abs() < 1e-13);
}
