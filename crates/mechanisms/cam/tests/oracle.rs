//! The mechanics against converged values of an independent implementation (`reference/cam/converged.json`: a multibody model in nine
//! coordinates and a reduced Lagrangian in Python) and against closed forms.

use std::sync::Arc;

use forcewright_base::maths::{hypot, sin_cos};
use forcewright_cam::{
    Bank, Bodies, Cut, CutSide, Drive, Flaws, ForceLaw, Law, Mechanism, Motion, NormalError, Purpose, Sense, SidePath, Spring, SpringLaw,
    SpringMass,
};
use serde_json::Value;

const X0: f64 = 0.068;
const L: f64 = 0.2;
const A: f64 = 0.009_058;

fn reference() -> Value {
    serde_json::from_str(include_str!("../../../../reference/cam/converged.json")).expect("valid JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

fn spring(rate: f64, rest: f64) -> Spring {
    Spring { law: SpringLaw::Linear { rate_n_per_m: rate, rest_m: rest }, stretch_m: 0.0, mass_kg: 0.0 }
}

fn bank(rate: f64, rest: f64) -> Bank {
    Bank::new(vec![spring(rate, rest)], true)
}

/// The paper's design, or one like it.
fn purpose(law: ForceLaw, rate: f64) -> Purpose {
    Purpose {
        law,
        springs: bank(rate, 2.0 * X0),
        start_length_m: 2.0 * X0,
        sides: [CutSide { brace_m: L, share: 0.5 }; 2],
        friction: 0.0,
        stroke_m: 0.25,
    }
}

fn paper_cut(friction: f64) -> Arc<Cut> {
    Arc::new(Cut::new(Purpose { friction, ..purpose(ForceLaw::constant(4.0 * 1365.0 * A), 1365.0) }).expect("the paper's cam"))
}

/// Masses of the paper, those of the springs with the rollers.
const BODIES: Bodies =
    Bodies { slider_kg: 0.068, brace_kg: 0.077, brace_kg_m2: 2.57e-4, roller_kg: 0.38, roller_kg_m2: 4.61e-6, springs: SpringMass::Bar };

#[expect(clippy::needless_pass_by_value, reason = "the calls read better")]
fn mechanism(cut: &Arc<Cut>, springs: Bank, friction: f64, flaws: [Flaws; 2]) -> Mechanism {
    Mechanism {
        paths: [0, 1].map(|side| SidePath::new(Arc::clone(cut), side, 0.016, &flaws[side])),
        brace_m: [L; 2],
        roller_m: 0.016,
        arm_m: 0.016 * friction,
        springs,
        bodies: BODIES,
        gravity_m_per_s2: 0.0,
        rise_m: cut.rise_m(),
    }
}

fn plain(cut: &Arc<Cut>, rate: f64, friction: f64) -> Mechanism {
    mechanism(cut, bank(rate, 2.0 * X0), friction, [Flaws::default(), Flaws::default()])
}

fn rest_force(m: &Mechanism, s: f64, sense: Sense) -> f64 {
    m.instant(&Drive::rest(s), sense).expect("assembles").force_n
}

fn close(value: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((value - expected).abs() <= tolerance, "{what}: {value}, expected {expected}");
}

/// Path, derivatives, curvature, cam and spring at eleven travels.
#[test]
fn the_paths_of_the_paper() {
    let cut = paper_cut(0.0);
    for row in reference()["synthesis_table"].as_array().expect("rows") {
        let s = number(&row["s"]);
        // √(4As)/… : the deformation of the springs at this travel in closed form.
        let lambda = 2.0 * (2.0 * A * s).sqrt();
        let p = cut.at(0, lambda);
        close(p.s.value(), s, 1e-15, "travel");
        close(p.x.value(), number(&row["x"]), 1e-15, "x");
        close(p.y.value(), number(&row["y"]), 1e-15, "y");
        let slope = p.y.derivative(1) / p.x.derivative(1);
        close(slope, number(&row["dydx"]), 1e-13, "dy/dx");
        let place = SidePath::new(Arc::clone(&cut), 0, 0.016, &Flaws::default()).designed(lambda);
        let curvature = forcewright_cam::curvature_per_m(&place, 1.0);
        close(curvature / number(&row["kappa_per_m"]), 1.0, 1e-12, "curvature");
        let [_, normal] = forcewright_cam::frame(&place, 1.0);
        close(place.at[0] - 0.016 * normal[0], number(&row["cam_x"]), 1e-15, "cam x");
        close(place.at[1] - 0.016 * normal[1], number(&row["cam_y"]), 1e-15, "cam y");
    }
}

#[test]
fn the_paper_s_cam_is_undercut() {
    let cut = paper_cut(0.0);
    let reference = &reference()["synthesis"];
    let corner = *SidePath::new(Arc::clone(&cut), 0, 0.016, &Flaws::default()).corner().expect("undercut");
    close(corner.travel_m, number(&reference["undercut"]["s_cusp"]), 1e-14, "travel of the cusp");
    for (value, expected) in corner.at.iter().zip(numbers(&reference["undercut"]["cam_cusp"])) {
        close(*value, expected, 1e-14, "corner");
    }
    // Theory note: the travel lost with other rollers.
    for (radius, lost_mm) in [(0.012, 0.078), (0.020, 1.055)] {
        let corner = *SidePath::new(Arc::clone(&cut), 0, radius, &Flaws::default()).corner().expect("undercut");
        close(1e3 * corner.travel_m, lost_mm, 5e-4, "travel lost");
    }
    assert!(SidePath::new(Arc::clone(&cut), 0, 0.0103, &Flaws::default()).corner().is_none(), "ϱ = 10.328 mm");
    // Below, the path is a circle about the corner that continues it smoothly.
    let path = SidePath::new(Arc::clone(&cut), 0, 0.016, &Flaws::default());
    let (below, above) = (path.at(corner.lambda_m - 1e-9), path.at(corner.lambda_m + 1e-9));
    for i in 0..2 {
        close(below.at[i], above.at[i], 1e-8, "position");
        close(below.slope[i], above.slope[i], 1e-5, "direction");
    }
    let pose = mechanism(&cut, bank(1365.0, 0.136), 0.0, [Flaws::default(), Flaws::default()]).pose([0.0, 0.0]).expect("on the corner");
    let at = pose.places[0].at;
    let distance = hypot(at[0] - corner.at[0], at[1] - corner.at[1]);
    close(distance, 0.016, 1e-15, "roller on its corner");
}

#[test]
fn forces_with_friction_both_ways() {
    let table = &reference()["force_profiles_mu0.002"];
    let m = plain(&paper_cut(0.0), 1365.0, 0.002);
    let (up, down) = (numbers(&table["up"]), numbers(&table["down"]));
    for (i, s) in numbers(&table["s"]).into_iter().enumerate() {
        close(rest_force(&m, s, Sense::Up), up[i], 1e-11, "up");
        close(rest_force(&m, s, Sense::Down), down[i], 1e-11, "down");
        close(rest_force(&m, s, Sense::Frictionless), 4.0 * 1365.0 * A, 1e-12, "without friction");
    }
}

#[test]
fn friction_compensated_on_the_way_up() {
    let cut = paper_cut(0.002);
    let m = plain(&cut, 1365.0, 0.002);
    for row in reference()["friction_compensated_mu0.002"].as_array().expect("rows") {
        let s = number(&row["s"]);
        let pose = m.pose([s, 0.0]).expect("assembles");
        close(pose.places[0].at[0], number(&row["x"]), 2e-13, "x");
        close(pose.places[0].at[1], number(&row["y"]), 2e-13, "y");
        close(rest_force(&m, s, Sense::Up), number(&row["F_up"]), 1e-10, "up");
        close(rest_force(&m, s, Sense::Down), number(&row["F_down"]), 1e-10, "down");
        close(rest_force(&m, s, Sense::Frictionless), number(&row["F_mu0"]), 1e-10, "without friction");
    }
    // On the way down: exact there.
    let m = plain(&paper_cut(-0.002), 1365.0, 0.002);
    for s in [0.01, 0.1, 0.2] {
        close(rest_force(&m, s, Sense::Down), 4.0 * 1365.0 * A, 1e-9, "down");
    }
}

#[test]
fn a_wrong_rest_length() {
    let table = &reference()["rest_length_+0.5mm"];
    let m = mechanism(&paper_cut(0.0), bank(1365.0, 0.1365), 0.0, [Flaws::default(), Flaws::default()]);
    let expected = numbers(&table["F"]);
    for (i, s) in numbers(&table["s"]).into_iter().enumerate() {
        close(rest_force(&m, s, Sense::Frictionless), expected[i], 1e-11, "force");
    }
}

/// The motion of Fig. 14: 0.1 m from s2 = 220 mm in 0.125 s, gravity on.
#[test]
fn forces_in_a_motion() {
    let series = &reference()["multibody"]["force_series_T0.125_2springs_gravity"];
    let cut = paper_cut(0.0);
    let m = Mechanism { gravity_m_per_s2: 9.81, ..plain(&cut, 1380.0, 0.0) };
    let motion = Motion {
        law: Law::Cycloidal,
        start_m: 0.22 - cut.rise_m(),
        rise_m: 0.1,
        duration_s: 0.125,
        pause_s: 0.0,
        returns: false,
        reference_s: None,
    };
    let (force, normal, tangential) = (numbers(&series["F"]), numbers(&series["N"]), numbers(&series["Tt"]));
    for (i, t) in numbers(&series["t"]).into_iter().enumerate() {
        let [s, v, a] = motion.at(t / 0.125);
        let drive = Drive { at: [s, 0.0], velocity: [v, 0.0], acceleration: [a, 0.0] };
        let instant = m.instant(&drive, Sense::Frictionless).expect("assembles");
        close(instant.force_n, force[i], 1e-8, "force");
        close(instant.sides[0].normal_n, normal[i], 1e-8, "normal force");
        close(-instant.sides[0].tangential_n, tangential[i], 1e-9, "tangential force");
    }
}

/// Tilt (Fig. 15) and turned profiles (Fig. 16).
#[test]
fn errors_of_assembly_and_making() {
    let reference = reference();
    let cut = paper_cut(0.0);
    let turned = |right: f64, left: f64| {
        let flaws = |deg: f64| Flaws { turn_rad: deg.to_radians(), ..Flaws::default() };
        mechanism(&cut, bank(1380.0, 0.136), 0.0, [flaws(right), flaws(left)])
    };
    for (key, deg) in [("y0=0|g0.0|2deg", 2.0), ("y0=0|g0.0|5deg", 5.0)] {
        let m = turned(deg, -deg);
        for (i, force) in numbers(&reference["fig15"][key]["F"]).into_iter().enumerate() {
            let s = 0.212 + 0.01 * i as f64 - cut.rise_m();
            close(rest_force(&m, s, Sense::Frictionless), force, 1e-9, key);
            // The same whichever way it is tilted.
            close(rest_force(&turned(-deg, deg), s, Sense::Frictionless), force, 1e-9, key);
        }
    }
    for (key, deg) in [("y0=0|g0.0|-0.4deg", -0.4), ("y0=0|g0.0|0.4deg", 0.4)] {
        let m = turned(deg, deg);
        for (i, force) in numbers(&reference["fig16"][key]["F"]).into_iter().enumerate() {
            close(rest_force(&m, 0.22 + 0.01 * i as f64 - cut.rise_m(), Sense::Frictionless), force, 1e-9, key);
        }
    }
}

/// One side carries 60 % of a rising force, friction is compensated: the force is the law itself in that direction, although the springs
/// slant, and each side carries its part.
#[test]
fn compensated_on_unequal_sides() {
    let law = ForceLaw::through(&[[0.0, 40.0], [0.2, 60.0]]).expect("a law");
    for (friction, sense) in [(0.004, Sense::Up), (-0.004, Sense::Down)] {
        let sides = [CutSide { brace_m: L, share: 0.6 }, CutSide { brace_m: L, share: 0.4 }];
        let purpose = Purpose { law: law.clone(), springs: bank(1380.0, 0.136), start_length_m: 0.144, sides, friction, stroke_m: 0.2 };
        let cut = Arc::new(Cut::new(purpose).expect("a cam"));
        let m = mechanism(&cut, bank(1380.0, 0.136), 0.004, [Flaws::default(), Flaws::default()]);
        for s in [0.01, 0.05, 0.11, 0.19] {
            let pose = m.pose([s, 0.0]).expect("assembles");
            assert!((pose.places[0].at[1] - pose.places[1].at[1]).abs() > 1e-4, "the springs slant");
            let instant = m.forces(&pose, &Drive::rest(s), sense);
            close(instant.force_n, law.force_n(s)[0], 1e-9, "force");
            let part = instant.sides[0].brace_n * (pose.joints[0][1] - pose.places[0].at[1]) / L;
            close(part, 0.6 * law.force_n(s)[0], 1e-9, "of the right side");
        }
    }
}

/// A general law with unequal sides, a preloaded nonlinear spring and compression springs: the force without friction is the law itself,
/// and the work is the springs' energy.
#[test]
fn any_law_with_any_springs_on_unequal_sides() {
    let law = ForceLaw::through(&[[0.0, 40.0], [0.05, 60.0], [0.12, 35.0]]).expect("a law");
    let table = vec![[0.10, 5.0], [0.16, 40.0], [0.24, 160.0], [0.4, 500.0]];
    let springs = Bank::new(vec![Spring { law: SpringLaw::Table(table), stretch_m: 0.0, mass_kg: 0.0 }], true);
    let thrust = Bank::new(vec![spring(900.0, 0.30)], false);
    for (springs, start) in [(springs, 0.15), (thrust, 0.29)] {
        for share in [0.5, 0.35] {
            let sides = [CutSide { brace_m: 0.25, share }, CutSide { brace_m: 0.21, share: 1.0 - share }];
            let purpose =
                Purpose { law: law.clone(), springs: springs.clone(), start_length_m: start, sides, friction: 0.0, stroke_m: 0.12 };
            let cut = Arc::new(Cut::new(purpose).expect("a cam"));
            let mut m = mechanism(&cut, springs.clone(), 0.0, [Flaws::default(), Flaws::default()]);
            m.brace_m = [0.25, 0.21];
            m.rise_m = cut.rise_m();
            m.paths = [0, 1].map(|side| SidePath::new(Arc::clone(&cut), side, 1e-4, &Flaws::default()));
            for s in [0.004, 0.03, 0.047, 0.08, 0.119] {
                let instant = m.instant(&Drive::rest(s), Sense::Frictionless).expect("assembles");
                close(instant.force_n, law.force_n(s)[0], 1e-9, "force");
                let h = 1e-5;
                let energy = |s: f64| {
                    let length = m.instant(&Drive::rest(s), Sense::Frictionless).expect("assembles").spring_m;
                    springs.energy_j(start, length)
                };
                close((energy(s + h) - energy(s - h)) / (2.0 * h) / instant.force_n, 1.0, 1e-6, "dE/ds");
            }
        }
    }
}

/// A wave on the profile: force from the energy, and Lagrange's equation with its mass.
#[derive(Debug)]
struct Wave;

impl NormalError for Wave {
    fn at(&self, arc_m: f64) -> [f64; 3] {
        let (k, a) = (400.0, 2e-5);
        let (sin, cos) = sin_cos(k * arc_m);
        [a * sin, a * k * cos, -a * k * k * sin]
    }
}

#[test]
fn profile_errors_follow_from_energy_and_lagrange_s_equation() {
    let cut = paper_cut(0.0);
    let wavy = Flaws { error: Some(Arc::new(Wave)), ..Flaws::default() };
    let m = mechanism(&cut, bank(1380.0, 0.136), 0.0, [wavy, Flaws { swell_m: 1e-4, ..Flaws::default() }]);
    let pose = |s: f64| m.pose([s, 0.0]).expect("assembles");
    for s in [0.02, 0.07, 0.15] {
        let h = 2e-6;
        let energy =
            |s: f64| bank(1380.0, 0.136).energy_j(0.136, m.instant(&Drive::rest(s), Sense::Frictionless).expect("assembles").spring_m);
        let slope = (energy(s + h) - energy(s - h)) / (2.0 * h);
        close(rest_force(&m, s, Sense::Frictionless) / slope, 1.0, 2e-7, "dE/ds");
        // F = V′ + M s̈ + M′ ṡ²/2: the part with the speed is that of the acceleration's mass, differentiated.
        let mass = |s: f64| {
            let at = |a: f64| {
                m.instant(&Drive { at: [s, 0.0], acceleration: [a, 0.0], ..Drive::default() }, Sense::Frictionless)
                    .expect("assembles")
                    .force_n
            };
            at(1.0) - at(0.0)
        };
        let v = 0.7;
        let moving = m.instant(&Drive { at: [s, 0.0], velocity: [v, 0.0], ..Drive::default() }, Sense::Frictionless).expect("assembles");
        let growth = (mass(s + 1e-5) - mass(s - 1e-5)) / 2e-5;
        close((moving.force_n - rest_force(&m, s, Sense::Frictionless)) / (0.5 * growth * v * v), 1.0, 1e-4, "M′ṡ²/2");
        // Kinetic energy by the velocities themselves.
        let (a, b) = (pose(s - 1e-6), pose(s + 1e-6));
        let mut kinetic = 0.5 * BODIES.slider_kg;
        for side in 0..2 {
            let d = |p: [f64; 2], q: [f64; 2]| [(q[0] - p[0]) / 2e-6, (q[1] - p[1]) / 2e-6];
            let roller = d(a.places[side].at, b.places[side].at);
            let joint = d(a.joints[side], b.joints[side]);
            let middle = [f64::midpoint(roller[0], joint[0]), f64::midpoint(roller[1], joint[1])];
            let spin = hypot(roller[0] - joint[0], roller[1] - joint[1]) / L;
            let size = |v: [f64; 2]| v[0] * v[0] + v[1] * v[1];
            kinetic += 0.5 * (BODIES.roller_kg + BODIES.roller_kg_m2 / (0.016 * 0.016)) * size(roller);
            kinetic += 0.5 * (BODIES.brace_kg * size(middle) + BODIES.brace_kg_m2 * spin * spin);
        }
        close(mass(s) / (2.0 * kinetic), 1.0, 1e-7, "mass");
    }
}

/// Twice the springs, twice the force; all lengths doubled at the same rate, twice the force; mirrored errors, the mirrored forces.
#[test]
fn scaling_and_symmetry() {
    let cut = paper_cut(0.0);
    let flaws = || [Flaws { turn_rad: 0.004, ..Flaws::default() }, Flaws { shift_m: [1e-4, 2e-4], ..Flaws::default() }];
    let one = mechanism(&cut, bank(1365.0, 0.136), 0.002, flaws());
    let two = mechanism(&cut, bank(2730.0, 0.136), 0.002, flaws());
    let [a, b] = flaws();
    let mirrored = mechanism(&cut, bank(1365.0, 0.136), 0.002, [b, a]);
    for s in [0.03, 0.1, 0.2] {
        close(rest_force(&two, s, Sense::Up), 2.0 * rest_force(&one, s, Sense::Up), 1e-11, "rate");
        let [here, there] = [&one, &mirrored].map(|m| m.instant(&Drive::rest(s), Sense::Up).expect("assembles"));
        close(here.force_n, there.force_n, 1e-12, "mirrored");
        close(here.guide_n, -there.guide_n, 1e-12, "mirrored");
        close(here.sides[0].normal_n, there.sides[1].normal_n, 1e-12, "mirrored");
    }
}
