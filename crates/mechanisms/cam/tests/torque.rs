//! Torque cams against closed forms, energy, quadrature, geometry, scaling, and the general multibody engine.

use std::sync::Arc;

use forcewright_base::diagnostics::Diagnostics;
use forcewright_base::maths;
use forcewright_base::quadrature::GaussLegendre;
use forcewright_cam::torque::{Behaviour, Bodies, Cut, CutError, Mechanism, Purpose as CutFor};
use forcewright_cam::{Bank, Cam, ForceLaw, Sense, Spring, SpringLaw, SpringMass, curvature_per_m, frame};
use forcewright_contract::family::{Analysis, Entry, Family as _};
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::studies::Free;
use forcewright_model::{FigureContent, Item, Look, Part, Role};
use forcewright_multibody::{Body, Contact, Follows, Force, GROUND, Grid, Kinematics, Law, Model, Motion, Path, PathPoint, Side, Stop};
use forcewright_study::evaluator::Evaluation;

const EXAMPLE: &str = include_str!("../../../../examples/cam/torque-cam.toml");
/// Sizes of the example.
const SIZES: &str = "roller_diameter = \"20 mm\"\ncam_thickness = \"10 mm\"\nturn = \"120 deg\"\n";
const START: f64 = 0.04;
const TURN: f64 = 2.0;
const RATE: f64 = 1400.0;
const ROLLER: f64 = 0.008;
const TORQUE: f64 = 2.0;
const STILL: Bodies = Bodies { disc_kg_m2: 0.0, follower_kg: 0.0, roller_kg: 0.0, roller_kg_m2: 0.0, springs: SpringMass::Bar };
const HEAVY: Bodies = Bodies { disc_kg_m2: 3e-4, follower_kg: 0.11, roller_kg: 0.07, roller_kg_m2: 2.3e-6, springs: SpringMass::Bar };

fn bank(rate: f64, rest: f64, mass: f64, extension: bool) -> Bank {
    let law = SpringLaw::Linear { rate_n_per_m: rate, rest_m: rest };
    Bank::new(vec![Spring { law, stretch_m: 0.0, mass_kg: mass }], extension)
}

/// A cam for extension springs whose rest length is given.
fn purpose(law: ForceLaw, rest: f64) -> CutFor {
    CutFor { law, springs: bank(RATE, rest, 0.0, true), start_radius_m: START, friction: 0.0, guide_friction: 0.0, turn_rad: TURN }
}

fn constant(rest: f64) -> CutFor {
    purpose(ForceLaw::constant(TORQUE), rest)
}

fn rising() -> ForceLaw {
    ForceLaw::through(&[[0.0, 1.0], [0.8, 1.4], [1.4, 4.0], [TURN, 3.0]]).expect("rising turns, torques above zero")
}

/// Rollers for which it was cut, with friction of rollers and guides.
fn mechanism(purpose: CutFor, [friction, guide]: [f64; 2], bodies: Bodies) -> Mechanism {
    let springs = purpose.springs.clone();
    let cut = Arc::new(Cut::new(purpose).expect("a cam"));
    Mechanism {
        corner: Mechanism::corner_of(&cut, ROLLER),
        cut,
        cut_roller_m: ROLLER,
        roller_m: ROLLER,
        arm_m: friction * ROLLER,
        guide_friction: guide,
        springs,
        bodies,
    }
}

fn torque(mechanism: &Mechanism, turn: f64, sense: Sense) -> f64 {
    mechanism.at_rest(&mechanism.pose(turn).expect("stands"), sense).torque_nm
}

fn turned([x, y]: [f64; 2], by: f64) -> [f64; 2] {
    let (sin, cos) = maths::sin_cos(by);
    [cos * x - sin * y, sin * x + cos * y]
}

/// Springs at rest at the start: ½k(2ρ − 2ρ₀)² = Tθ.
#[test]
fn a_constant_torque_has_a_closed_form() {
    let cam = mechanism(constant(2.0 * START), [0.0; 2], STILL);
    for turn in [0.02, 0.3, 1.0, 1.7, TURN] {
        let expected = START + (0.5 * TORQUE * turn / RATE).sqrt();
        let pose = cam.pose(turn).expect("stands");
        if cam.corner.is_none_or(|c| turn > c.turn_rad) {
            assert!((pose.radius_m[0] - expected).abs() < 1e-14, "{turn}: {} {expected}", pose.radius_m[0]);
            assert!((torque(&cam, turn, Sense::Frictionless) - TORQUE).abs() < 1e-11);
        }
    }
    // The path starts straight outwards: ϱ = T/(4 ρ₀ k).
    let place = cam.cut.place(0.0);
    assert!((curvature_per_m(&place, cam.cut.sense()) - 4.0 * START * RATE / TORQUE).abs() < 1e-9);
}

/// κ at the start from the polar form of the path, with preload; rollers that are smaller are not undercut, larger ones are.
#[test]
fn undercut_begins_at_the_curvature_of_the_start() {
    let cam = Cut::new(constant(0.06)).expect("a cam");
    let (force, rate) = (RATE * 0.02, RATE);
    // dθ/dρ = 2P/T, d²θ/dρ² = 4k/T.
    let (first, second) = (2.0 * force / TORQUE, 4.0 * rate / TORQUE);
    let one = START * first;
    let curvature = (2.0 * first + START * second + START * START * first * first * first) / maths::powf(1.0 + one * one, 1.5);
    assert!((curvature_per_m(&cam.place(0.0), cam.sense()) * 1.0 - curvature).abs() < 1e-9 * curvature);
    assert!(Mechanism::corner_of(&cam, 0.999 / curvature).is_none());
    let corner = Mechanism::corner_of(&cam, 1.01 / curvature).expect("undercut");
    assert!(corner.turn_rad > 0.0 && corner.turn_rad < 0.1 * TURN, "{corner:?}");
    // On the corner the roller is no longer where it was meant to be; beyond it is.
    let small = 1.2 / curvature;
    let cam = Arc::new(cam);
    let corner = Mechanism::corner_of(&cam, small).expect("undercut");
    let cam = Mechanism {
        corner: Some(corner),
        cut: Arc::clone(&cam),
        cut_roller_m: small,
        roller_m: small,
        arm_m: 0.0,
        guide_friction: 0.0,
        springs: cam.purpose().springs.clone(),
        bodies: STILL,
    };
    assert!((torque(&cam, 1.01 * corner.turn_rad, Sense::Frictionless) - TORQUE).abs() < 1e-9);
    let pose = cam.pose(0.5 * corner.turn_rad).expect("stands");
    let distance = maths::hypot(pose.place.at[0] - corner.at[0], pose.place.at[1] - corner.at[1]);
    assert!((distance - small).abs() < 1e-14, "the roller turns about the corner");
    assert!((torque(&cam, 0.5 * corner.turn_rad, Sense::Frictionless) - TORQUE).abs() > 1e-3);
}

/// Any torque: the radius where the energy of the springs is the work, by Gauss quadrature piece by piece; and dV/dθ by differences.
#[test]
fn any_torque_is_the_slope_of_the_energy() {
    let law = rising();
    let cam = mechanism(purpose(law.clone(), 0.06), [0.0; 2], STILL);
    let gauss = GaussLegendre::new(6);
    for turn in [0.1, 0.5, 0.79, 0.9, 1.3, 1.5, 1.99] {
        let mut work = 0.0;
        let ends = [0.0, 0.8, 1.4, TURN];
        for pair in ends.windows(2) {
            let (a, b) = (pair[0], pair[1].min(turn));
            if b > a {
                work += gauss.integrate(|u| law.force_n(a + (b - a) * u)[0]) * (b - a);
            }
        }
        let pose = cam.pose(turn).expect("stands");
        let stored = 0.5 * RATE * ((2.0 * pose.radius_m[0] - 0.06) * (2.0 * pose.radius_m[0] - 0.06) - 0.02 * 0.02);
        assert!((stored - work).abs() < 1e-12, "{turn}: {stored} {work}");
        let wanted = law.force_n(turn)[0];
        assert!((torque(&cam, turn, Sense::Frictionless) - wanted).abs() < 1e-10 * wanted);
        let energy = |t: f64| cam.springs.energy_j(0.08, 2.0 * cam.pose(t).expect("stands").radius_m[0]);
        let by_differences = (energy(turn + 1e-5) - energy(turn - 1e-5)) / 2e-5;
        assert!((by_differences - wanted).abs() < 1e-7, "{turn}: {by_differences} {wanted}");
    }
}

/// What is drawn: by the path's points turned as the disc turns, without the pose's own derivatives.
#[test]
fn the_radius_has_its_derivatives() {
    let cam = mechanism(purpose(rising(), 0.06), [0.0; 2], STILL);
    for turn in [0.2, 1.0, 1.7] {
        let h = 1e-4;
        let [a, b, c] = [-h, 0.0, h].map(|d| cam.pose(turn + d).expect("stands").radius_m);
        assert!((turned(cam.cut.place(cam.cut.expected_m(turn)).at, turn)[1]).abs() < 1e-15);
        assert!(((c[0] - a[0]) / (2.0 * h) - b[1]).abs() < 1e-8 && ((c[1] - a[1]) / (2.0 * h) - b[2]).abs() < 1e-6, "{turn}: {b:?}");
    }
}

/// The work lost in a cycle is that of rolling along the disc and of the guides.
#[test]
fn a_cycle_loses_what_friction_takes() {
    for (friction, guide) in [(0.01, 0.0), (0.0, 0.05), (0.01, 0.05)] {
        let cam = mechanism(constant(0.06), [friction, guide], STILL);
        let gauss = GaussLegendre::new(12);
        let over =
            |f: &dyn Fn(f64) -> f64| (0..8).map(|i| gauss.integrate(|u| f((f64::from(i) + u) / 8.0 * TURN)) / 8.0 * TURN).sum::<f64>();
        let lost = over(&|t| torque(&cam, t, Sense::Up) - torque(&cam, t, Sense::Down));
        let taken = over(&|t| {
            let pose = cam.pose(t).expect("stands");
            let [radius, slope, _] = pose.radius_m;
            let length = maths::hypot(radius, slope);
            let both = [Sense::Up, Sense::Down].map(|s| cam.at_rest(&pose, s));
            both.iter().map(|i| 2.0 * (friction * i.normal_n * length + guide * i.guide_n.abs() * slope.abs())).sum()
        });
        assert!(lost > 1e-3 && (lost - taken).abs() < 1e-10, "{friction} {guide}: {lost} {taken}");
    }
}

/// Equilibrium of roller and follower by hand, and of the disc.
#[test]
fn friction_by_hand() {
    let (mu, guide) = (0.013, 0.08);
    let cam = mechanism(constant(0.06), [mu, guide], STILL);
    for turn in [0.1, 0.9, 1.8] {
        let [radius, slope, _] = cam.pose(turn).expect("stands").radius_m;
        let (tan, force) = (slope / radius, RATE * (2.0 * radius - 0.06));
        let by = |mu: f64, guide: f64| 2.0 * force * radius * (tan + mu) / (1.0 - mu * tan - guide * (tan + mu));
        assert!((torque(&cam, turn, Sense::Up) - by(mu, guide)).abs() < 1e-12);
        assert!((torque(&cam, turn, Sense::Down) - by(-mu, -guide)).abs() < 1e-12);
        assert!((torque(&cam, turn, Sense::Frictionless) - TORQUE).abs() < 1e-11);
    }
}

/// A cam cut for friction one way is exact that way, from where it starts, for any torque.
#[test]
fn compensated_friction_leaves_the_torque_exact() {
    for (sign, sense) in [(1.0, Sense::Up), (-1.0, Sense::Down)] {
        for (mu, guide) in [(0.02, 0.0), (0.01, 0.06)] {
            for law in [ForceLaw::constant(TORQUE), rising()] {
                let cut = CutFor { friction: sign * mu, guide_friction: sign * guide, ..purpose(law.clone(), 0.05) };
                let cam = mechanism(cut, [mu, guide], STILL);
                assert!(cam.corner.is_none());
                for turn in [0.01, 0.4, 0.81, 1.39, 1.9] {
                    let (is, wanted) = (torque(&cam, turn, sense), law.force_n(turn)[0]);
                    assert!((is - wanted).abs() < 1e-9 * wanted, "{sense:?} {mu} {guide} {turn}: {is} {wanted}");
                }
            }
        }
    }
}

/// Both rollers are pushed by opposite forces: nothing is left on the shaft but a couple, which is the torque.
#[test]
fn the_shaft_carries_a_torque_and_no_force() {
    let cam = mechanism(purpose(rising(), 0.06), [0.01, 0.05], STILL);
    for turn in [0.3, 1.1, 1.9] {
        let pose = cam.pose(turn).expect("stands");
        let i = cam.at_rest(&pose, Sense::Up);
        let [along, normal] = frame(&pose.place, cam.cut.sense());
        let (mut sum, mut couple) = ([0.0; 2], 0.0);
        for half in [0.0, std::f64::consts::PI] {
            // On the disc, where this roller touches it; rolling resistance as a couple N d.
            let turn_of = |v: [f64; 2]| turned(v, turn + half);
            let (t, n, p) = (turn_of(along), turn_of(normal), turn_of(pose.place.at));
            let at = [p[0] - ROLLER * n[0], p[1] - ROLLER * n[1]];
            let f = [0, 1].map(|k| -(i.normal_n * n[k] + i.tangential_n * t[k]));
            sum = [sum[0] + f[0], sum[1] + f[1]];
            couple += at[0] * f[1] - at[1] * f[0] - cam.arm_m * i.normal_n;
        }
        assert!(sum[0].abs() < 1e-12 && sum[1].abs() < 1e-12, "{sum:?}");
        assert!((couple + i.torque_nm).abs() < 1e-12, "{couple} {}", i.torque_nm);
        assert!((i.guide_n - 0.5 * i.torque_nm / pose.radius_m[0]).abs() < 1e-11);
    }
}

/// Twice as large with the same rates: four times the torque from the same angles.
#[test]
fn torque_follows_the_square_of_the_size() {
    let small = mechanism(purpose(rising(), 0.06), [0.01, 0.02], STILL);
    let law = ForceLaw::through(&[[0.0, 4.0], [0.8, 5.6], [1.4, 16.0], [TURN, 12.0]]).expect("a law");
    let springs = bank(RATE, 0.12, 0.0, true);
    let cut = Arc::new(
        Cut::new(CutFor { law, springs: springs.clone(), start_radius_m: 2.0 * START, ..purpose(rising(), 0.06) }).expect("a cam"),
    );
    let large = Mechanism { cut, cut_roller_m: 2.0 * ROLLER, roller_m: 2.0 * ROLLER, arm_m: 2.0 * small.arm_m, springs, ..small.clone() };
    for turn in [0.2, 1.0, 1.9] {
        let [a, b] = [&small, &large].map(|m| m.pose(turn).expect("stands").radius_m[0]);
        assert!((b - 2.0 * a).abs() < 1e-14);
        for sense in [Sense::Up, Sense::Down] {
            assert!((torque(&large, turn, sense) - 4.0 * torque(&small, turn, sense)).abs() < 1e-11);
        }
    }
}

/// A ring outside the rollers, with compression springs: the same law.
#[test]
fn compression_springs_push_rollers_onto_a_ring() {
    let springs = bank(RATE, 0.13, 0.0, false);
    let cut = |friction: f64| CutFor { springs: springs.clone(), start_radius_m: 0.06, friction, ..constant(0.06) };
    let cam = mechanism(cut(0.0), [0.01, 0.0], STILL);
    for turn in [0.2, 1.0, 1.9] {
        let pose = cam.pose(turn).expect("stands");
        let thrust = 0.13 - 2.0 * pose.radius_m[0];
        assert!((0.5 * RATE * (thrust * thrust - 0.01 * 0.01) - TORQUE * turn).abs() < 1e-12);
        assert!((torque(&cam, turn, Sense::Frictionless) - TORQUE).abs() < 1e-11);
        let [up, down] = [Sense::Up, Sense::Down].map(|s| cam.at_rest(&pose, s));
        assert!(up.torque_nm > TORQUE && down.torque_nm < TORQUE && up.normal_n > 0.0 && down.normal_n > 0.0);
    }
    let exact = mechanism(cut(0.01), [0.01, 0.0], STILL);
    assert!((torque(&exact, 1.2, Sense::Up) - TORQUE).abs() < 1e-9);
    // So soft that the rollers would meet.
    let soft = CutFor { springs: bank(100.0, 0.13, 0.0, false), ..cut(0.0) };
    assert!(matches!(Cut::new(soft), Err(CutError::Meets { turn_rad }) if turn_rad > 0.0 && turn_rad < TURN));
}

/// Lagrange's equation of the disc with everything that moves: T = V′ + M α + ½ M′ ω², M by hand, M′ by differences.
#[test]
fn a_motion_is_lagrange_s() {
    for extension in [true, false] {
        let springs = if extension { bank(RATE, 0.06, 0.05, true) } else { bank(RATE, 0.13, 0.05, false) };
        let start_radius_m = if extension { START } else { 0.06 };
        let cam = mechanism(CutFor { springs, start_radius_m, ..constant(0.06) }, [0.0; 2], HEAVY);
        let mass = |turn: f64| {
            let [radius, slope, _] = cam.pose(turn).expect("stands").radius_m;
            let spin = 1.0 - cam.springs.sense() * maths::hypot(radius, slope) / ROLLER;
            let b = &HEAVY;
            b.disc_kg_m2 + (2.0 * (b.follower_kg + b.roller_kg) + 0.05 / 3.0) * slope * slope + 2.0 * b.roller_kg_m2 * spin * spin
        };
        for (turn, speed, acceleration) in [(0.3, 5.0, 0.0), (1.0, 0.0, 80.0), (1.6, -8.0, 40.0)] {
            let pose = cam.pose(turn).expect("stands");
            let is = cam.forces(&pose, [speed, acceleration], Sense::Frictionless).torque_nm;
            let change = (mass(turn + 1e-5) - mass(turn - 1e-5)) / 2e-5;
            let wanted = TORQUE + mass(turn) * acceleration + 0.5 * change * speed * speed;
            assert!((is - wanted).abs() < 1e-7, "{extension} {turn}: {is} {wanted}");
        }
    }
}

/// The general engine, which knows no torque cams: a disc on a pin, two rollers on slots, rolling on paths that are written anew by ρ.
#[test]
fn the_general_engine_agrees_in_motion() {
    let cam = mechanism(constant(0.06), [0.0; 2], HEAVY);
    // θ = k((2ρ − L)² − (2ρ₀ − L)²)/(2T), and the path (ρ cos θ, −ρ sin θ) on the disc.
    let path = |mirror: f64| {
        move |rho: f64| {
            let x = 2.0 * rho - 0.06;
            let turn = RATE * (x * x - 0.02 * 0.02) / (2.0 * TORQUE);
            let (d1, d2) = (2.0 * RATE * x / TORQUE, 4.0 * RATE / TORQUE);
            let (s, c) = maths::sin_cos(turn);
            let place = |a: f64, b: f64| [mirror * a, -mirror * b];
            PathPoint {
                point_m: place(rho * c, rho * s),
                first: place(c - rho * s * d1, s + rho * c * d1),
                second: place(-2.0 * s * d1 - rho * (c * d1 * d1 + s * d2), 2.0 * c * d1 + rho * (c * d2 - s * d1 * d1)),
                third: [0.0; 2],
            }
        }
    };
    let (from, rise, duration) = (0.3, 1.2, 0.12);
    let start = cam.pose(from).expect("stands").radius_m[0];
    let mut model = Model::new();
    let disc = model.body("disc", Body::new(1.0, HEAVY.disc_kg_m2).placed(0.0, 0.0, from));
    model.revolute("shaft", disc.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    let mut rollers = Vec::new();
    let mut contacts = Vec::new();
    for (name, mirror) in [("right", 1.0), ("left", -1.0)] {
        let roller = Body::new(HEAVY.roller_kg + HEAVY.follower_kg, HEAVY.roller_kg_m2).placed(mirror * start, 0.0, 0.0);
        let roller = model.body(format!("{name} roller"), roller);
        model.slot(format!("{name} guide"), roller.at(0.0, 0.0), GROUND.at(0.0, 0.0), 0.0);
        contacts.push(model.contact(
            format!("{name} cam"),
            Contact {
                roller: roller.at(0.0, 0.0),
                radius_m: ROLLER,
                cam: disc,
                path: Path::curve(path(mirror)),
                follows: Follows::Centre,
                // The path is passed clockwise: outside of it is its left.
                side: Side::Left,
                rolling: true,
                start,
            },
        ));
        rollers.push(roller);
    }
    let law = Law::linear(RATE, 0.06);
    model.force("springs", Force::Spring { a: rollers[0].at(0.0, 0.0), b: rollers[1].at(0.0, 0.0), law });
    let driver = model.drive_angle("turn", disc, GROUND, Motion::Cycloid { start: from, stroke: rise, duration_s: duration });
    let system = model.build().expect("sound");
    let run = system.inverse(system.guess(), Grid { start_s: 0.0, end_s: duration, steps: 24 }, Kinematics::Algebraic);
    assert_eq!(run.stop, Stop::Reached, "{}", run.stop);
    let lift = forcewright_cam::Motion {
        law: forcewright_cam::Law::Cycloidal,
        start_m: from,
        rise_m: rise,
        duration_s: duration,
        pause_s: 0.0,
        returns: false,
        reference_s: None,
    };
    for instant in run.history.iter() {
        let [turn, speed, acceleration] = lift.at(instant.time_s / duration);
        let ours = cam.forces(&cam.pose(turn).expect("stands"), [speed, acceleration], Sense::Frictionless);
        let theirs = system.driver_force(&instant, driver).expect("a driver");
        assert!((ours.torque_nm - theirs).abs() < 1e-9, "{}: {} {theirs}", instant.time_s, ours.torque_nm);
        for contact in &contacts {
            let contact = system.contact_force(&instant, *contact).expect("a contact");
            assert!((contact.normal_n - ours.normal_n).abs() < 1e-8, "{} {}", contact.normal_n, ours.normal_n);
            assert!((contact.traction_n.abs() - ours.tangential_n.abs()).abs() < 1e-8, "{} {}", contact.traction_n, ours.tangential_n);
        }
    }
}

fn analysed(text: &str) -> Analysis {
    let mut project = Project::from_text("test.toml", text, &Choices::default());
    let understood = Entry::<Cam>::new().understand(&mut project);
    let said: Vec<String> = project.diagnostics.in_file_order().iter().map(|d| format!("{}: {}", d.code, d.message)).collect();
    understood.unwrap_or_else(|| panic!("refused: {said:?}")).analyse(&mut |_| true)
}

fn refused(from: &str, to: &str) -> Vec<&'static str> {
    assert!(EXAMPLE.contains(from), "{from} is not in the example");
    let mut project = Project::from_text("test.toml", &EXAMPLE.replacen(from, to, 1), &Choices::default());
    let understood = Entry::<Cam>::new().understand(&mut project);
    let all = project.diagnostics.in_file_order();
    assert!(all.iter().all(|d| d.help.as_ref().is_some_and(|h| !h.is_empty())), "an error without a way out");
    let codes: Vec<&'static str> = all.iter().map(|d| d.code).collect();
    assert!(understood.is_none() && !codes.is_empty(), "{to} is not refused");
    codes
}

/// Distance of a point from a closed polygon.
fn distance(polygon: &[[f64; 2]], p: [f64; 2]) -> f64 {
    let ends = polygon.iter().skip(1).chain(polygon.first());
    let one = |(a, b): (&[f64; 2], &[f64; 2])| {
        let d = [b[0] - a[0], b[1] - a[1]];
        let t = ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
        let t = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 };
        maths::hypot(p[0] - a[0] - t * d[0], p[1] - a[1] - t * d[1])
    };
    polygon.iter().zip(ends).map(one).fold(f64::INFINITY, f64::min)
}

/// A ring: the example with compression springs.
fn ring() -> String {
    let changes = [
        ("[design]\n", "[design]\narrangement = \"compression\"\n"),
        ("start_radius = \"40 mm\" ", "start_radius = \"65 mm\" "),
        ("shaft_diameter = \"12 mm\"", ""),
        ("for_rest_length = \"60 mm\"", "for_rest_length = \"150 mm\""),
        ("rest_length = \"60 mm\"\nmax_length = \"150 mm\"", "rest_length = \"150 mm\"\nmin_length = \"40 mm\""),
        (", hub_wall = { min = \"5 mm\" }", ""),
    ];
    changes.iter().fold(EXAMPLE.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    })
}

#[test]
fn the_example_meets_what_it_asks_for() {
    let analysis = analysed(EXAMPLE);
    let outcome = &analysis.outcome;
    assert!(outcome.requirements_met() && outcome.warnings.is_empty(), "{:?} {:?}", outcome.checks, outcome.warnings);
    let metric = |name: &str| outcome.metric(name).map(|m| m.value);
    assert!((metric("torque_mean").expect("a mean") - 2.0).abs() < 1e-9);
    assert!(metric("force_mean").is_none() && metric("height").is_none(), "what does not apply is absent");
    let turn = 120f64.to_radians();
    assert!((metric("energy").expect("work") - 2.0 * turn).abs() < 1e-9);
    // By hand from the closed form.
    let end = 0.5 * (0.06 + (0.02 * 0.02 + 2.0 * 2.0 * turn / 1400.0_f64).sqrt());
    assert!((metric("spring_length_max").expect("a length") - 2.0 * end).abs() < 1e-12);
    // The motion ends at rest; at its fastest 2·100°/0.25 s.
    assert!((metric("turn_speed_max").expect("a speed") - 2.0 * 100f64.to_radians() / 0.25).abs() < 1e-9);
    let motion = outcome.curve("motion_torque").expect("a motion");
    let [moving, resting] = [0, 1].map(|i| &motion.branches[i].y);
    assert!((moving[0] - resting[0]).abs() < 1e-12 && (moving[400] - resting[400]).abs() < 1e-9);
    // What the motion puts in is what friction takes beyond the springs: the kinetic energy is back to zero.
    let turn = &outcome.curve("motion_turn").expect("a motion").branches[0].y;
    let work = |torque: &[f64]| torque.windows(2).zip(turn.windows(2)).map(|(t, s)| 0.5 * (t[0] + t[1]) * (s[1] - s[0])).sum::<f64>();
    assert!((work(moving) - work(resting)).abs() < 2e-3 * work(resting), "{} {}", work(moving), work(resting));
    assert!((metric("width").expect("a width") - 2.0 * (end + 0.01)).abs() < 1e-12);
}

#[test]
fn rollers_touch_the_drawn_cam_in_every_frame() {
    let undercut = EXAMPLE.replacen("for_rest_length = \"60 mm\"", "for_rest_length = \"80 mm\"", 1);
    let mounted = undercut.replacen("rest_length = \"60 mm\"\nmax", "rest_length = \"80 mm\"\nmax", 1);
    for text in [EXAMPLE.to_owned(), mounted, ring()] {
        let analysis = analysed(&text);
        let film = analysis.figures.iter().find_map(|f| match &f.content {
            FigureContent::Film(film) => Some(film.clone()),
            _ => None,
        });
        let film = film.expect("it moves");
        assert_eq!(film.frames.len(), 25);
        for frame in &film.frames {
            let cam = frame.items.iter().find_map(|i| match i {
                Item::Body { corners, role: Role::Named(Look::Plate, "cam") } => Some(corners),
                _ => None,
            });
            let rollers: Vec<([f64; 2], f64)> = frame
                .items
                .iter()
                .filter_map(|i| match i {
                    Item::Disc { centre, radius_m, role: Role::Named(Look::Moving, "rollers") } => Some((*centre, *radius_m)),
                    _ => None,
                })
                .collect();
            assert_eq!(rollers.len(), 2);
            for (centre, radius) in rollers {
                let gap = distance(cam.expect("a cam"), centre) - radius;
                assert!(gap.abs() < 1e-5, "θ = {}: a gap of {gap}", frame.at);
            }
        }
    }
}

/// The parts are sound curves: the disc with its hole, and the ring.
#[test]
fn the_disc_can_be_made() {
    let long = EXAMPLE.replacen("turn = \"120 deg\"\nrolling", "turn = \"170 deg\"\nrolling", 1);
    let short = [
        ("turn = \"120 deg\"\nrolling", "turn = \"40 deg\"\nrolling"),
        ("\"2 deg\", \"120 deg\"", "\"2 deg\", \"40 deg\""),
        ("\"100 deg\"", "\"20 deg\""),
    ]
    .iter()
    .fold(EXAMPLE.to_owned(), |text, (from, to)| text.replacen(from, to, 1));
    for (text, name) in [(EXAMPLE.to_owned(), "disc"), (long, "disc"), (short, "disc"), (ring(), "ring")] {
        let mut project = Project::from_text("test.toml", &text, &Choices::default());
        let understood = Entry::<Cam>::new().understand(&mut project).expect("understood");
        let set = understood.parts().expect("parts");
        let disc = set.parts.iter().find(|p| p.name == name).and_then(Part::plate).expect("a disc");
        disc.outline.check(1e-9).expect("a sound outline");
        assert!(disc.outline.area_m2() > 0.0, "counterclockwise");
        for hole in &disc.cutouts {
            hole.check(1e-9).expect("a sound cutout");
            assert!(hole.area_m2() < 0.0, "clockwise");
        }
        assert!(disc.area_m2() > 1e-3, "{name}: {}", disc.area_m2());
        assert!(set.checks.iter().all(|c| c.code == "CAM011"));
    }
}

#[test]
fn what_cannot_be_is_refused() {
    assert_eq!(refused("rolling_friction = 0.002", "brace_length = \"200 mm\"\nrolling_friction = 0.002"), ["E0613"]);
    assert_eq!(refused("rise_turn = \"100 deg\"", "rise_turn = \"115 deg\""), ["E0605"]);
    assert_eq!(refused("rise_turn = \"100 deg\"", "rise = \"10 mm\"\nrise_turn = \"100 deg\""), ["E0613"]);
    assert_eq!(refused("rise_turn = \"100 deg\"", ""), ["E0302"]);
    assert_eq!(refused("law = \"cycloidal\"", "law = \"release\""), ["E0613"]);
    assert_eq!(refused("[design]\n", "[errors]\ntilt = \"1 deg\"\n[design]\n"), ["E0613"]);
    assert_eq!(refused("turn = \"120 deg\"\nrolling", "rolling"), ["E0302"]);
    assert_eq!(refused("for_torque = \"2 N*m\"", ""), ["E0302"]);
    assert_eq!(refused("for_torque = \"2 N*m\"", "for_torque_profile = [[\"0 deg\", \"1 N*m\"], [\"50 deg\", \"0 N*m\"]]"), ["E0204"]);
    assert_eq!(refused("for_torque = \"2 N*m\"", "for_torque_profile = [[\"5 deg\", \"1 N*m\"], [\"50 deg\", \"2 N*m\"]]"), ["E0604"]);
    assert_eq!(refused("for_rest_length = \"60 mm\"", "for_rest_length = \"90 mm\""), ["E0603"]);
    assert_eq!(refused("turn_window = [\"2 deg\", \"120 deg\"]", "turn_window = [\"2 deg\", \"130 deg\"]"), ["E0606"]);
    assert_eq!(refused(SIZES, "roller_diameter = \"33 mm\"\ncam_thickness = \"10 mm\"\nturn = \"170 deg\"\n"), ["E0614"]);
    assert_eq!(refused("shaft_diameter = \"12 mm\"", "shaft_diameter = \"60 mm\""), ["E0615"]);
    // A cam with a slider has no torque.
    let slider = include_str!("../../../../examples/cam/no-undercut.toml");
    let mut project = Project::from_text("a.toml", &slider.replacen("[design]\n", "[design]\nturn = \"1 rad\"\n", 1), &Choices::default());
    assert!(Entry::<Cam>::new().understand(&mut project).is_none());
    assert_eq!(project.diagnostics.in_file_order().iter().map(|d| d.code).collect::<Vec<_>>(), ["E0613"]);
}

/// The largest turn that a refusal names can be had, and one more degree cannot.
#[test]
fn the_largest_turn_is_as_large_as_it_says() {
    let with = |turn: f64| {
        let sizes = format!("roller_diameter = \"33 mm\"\ncam_thickness = \"10 mm\"\nturn = \"{turn} deg\"\n");
        let text = EXAMPLE.replacen("turn = \"120 deg\"\nturn_window = [\"2 deg\", \"120 deg\"]\n", "", 1).replacen(SIZES, &sizes, 1);
        let mut project = Project::from_text("a.toml", &text, &Choices::default());
        Entry::<Cam>::new().understand(&mut project).map(|_| ()).ok_or_else(|| {
            project.diagnostics.in_file_order().iter().find(|d| d.code == "E0614").and_then(|d| d.help.clone()).unwrap_or_default()
        })
    };
    let help = with(171.0).expect_err("no room");
    let named = help.split("turn of ").nth(1).and_then(|t| t.split(' ').next()).and_then(|t| t.parse::<f64>().ok());
    let largest = named.unwrap_or_else(|| panic!("{help}"));
    assert!(largest > 120.0 && with(largest - 0.5).is_ok() && with(largest + 0.5).is_err(), "{largest}");
}

/// Spread, deviation and loop of friction by hand: means over the window of a behaviour that is sampled anew.
#[test]
fn the_loop_is_the_difference_of_the_means() {
    let cam = mechanism(constant(0.06), [0.01, 0.0], STILL);
    let behaviour = Behaviour::sampled(cam.clone(), [0.2, 1.8], 40, 80);
    let up: Vec<f64> = behaviour.window.iter().map(|s| s.up.torque_nm).collect();
    assert_eq!(up.len(), 81);
    assert!(behaviour.window.iter().all(|s| (torque(&cam, s.turn_rad(), Sense::Up) - s.up.torque_nm).abs() < 1e-12));
    // First order: ±2 μ P ρ (1 + tan² φ).
    let s = &behaviour.window[40];
    let [radius, slope, _] = s.pose.radius_m;
    let tan = slope / radius;
    let expected = 0.01 * 2.0 * s.still.spring_n * radius * (1.0 + tan * tan);
    assert!((0.5 * (s.up.torque_nm - s.down.torque_nm) - expected).abs() < 1e-3 * expected);
}

/// Studies see the analysis: the same metrics at the design itself, and the springs' scatter as the closed form has it.
#[test]
fn studies_see_the_analysis() {
    let mut project = Project::from_text("a.toml", EXAMPLE, &Choices::default());
    let understood = Entry::<Cam>::new().understand(&mut project).expect("understood");
    let free = |path: &str| {
        let number = understood.numbers().iter().find(|n| n.path == path).expect("a number").clone();
        Free { lower: 0.9 * number.si, upper: 1.1 * number.si, number }
    };
    let all = [free("design.springs.rate"), free("design.rolling_friction")];
    let mut said = Diagnostics::default();
    let evaluator = understood.evaluator(&all, &mut said).expect("can vary");
    let at = |rate: f64| {
        let (mut out, mut measured, mut room) = (Evaluation::default(), Vec::new(), evaluator.workspace());
        let x = [rate, 0.002];
        evaluator.evaluate(&x, false, &mut out, &mut room).expect("a value");
        evaluator.measure(&x, &out.values, &mut measured, &mut room);
        let names = evaluator.measures().iter().map(|m| m.name.clone());
        names.zip(measured).collect::<std::collections::BTreeMap<String, f64>>()
    };
    let (nominal, stiffer) = (at(700.0), at(721.0));
    let outcome = understood.analyse(&mut |_| true).outcome;
    for name in ["torque_up_mean", "torque_deviation", "hysteresis", "spring_length_max", "peak_torque_ratio", "guide_force_max"] {
        let solved = outcome.metric(name).expect("a metric").value;
        assert!((nominal[name] - solved).abs() < 1e-5 * solved.abs(), "{name}: {} {solved}", nominal[name]);
    }
    // The path stays: the torque follows the rate.
    assert!((stiffer["torque_mean"] / nominal["torque_mean"] - 1.03).abs() < 1e-9);
    assert!(said.in_file_order().is_empty());
}

/// A project without its requirements and motion, which have turns of their own, for another torque and turn.
fn with_torque(project: &str, torque_nm: f64, turn_deg: f64) -> String {
    let (head, rest) = project.split_once("[requirements]").expect("a table");
    let (_, rest) = rest.split_once("[material]").expect("a table");
    let (rest, _) = rest.split_once("[motion]").expect("a table");
    assert!(rest.contains("turn = \"120 deg\"") && rest.contains("for_torque = \"2 N*m\""));
    let rest = rest.replacen("turn = \"120 deg\"", &format!("turn = \"{turn_deg} deg\""), 1);
    format!("{head}[material]{}", rest.replacen("for_torque = \"2 N*m\"", &format!("for_torque = \"{torque_nm} N*m\""), 1))
}

/// The analysis, or the help of what refuses it.
fn tried(text: &str) -> Result<Analysis, String> {
    let mut project = Project::from_text("a.toml", text, &Choices::default());
    let understood = Entry::<Cam>::new().understand(&mut project);
    let understood = understood.ok_or_else(|| {
        let all = project.diagnostics.in_file_order();
        all.iter().map(|d| format!("{} {}", d.code, d.help.as_deref().unwrap_or_default())).collect::<Vec<_>>().join("\n")
    })?;
    for part in understood.parts().expect("parts").parts {
        let plate = part.plate().expect("a plate");
        plate.outline.check(1e-9).expect("a sound outline");
        plate.cutouts.iter().for_each(|c| c.check(1e-9).expect("a sound cutout"));
    }
    Ok(understood.analyse(&mut |_| true))
}

/// By how much the drawn cam keeps clear of both rollers over all frames, m: its corners, and the chords between them.
fn clearance_m(analysis: &Analysis) -> [f64; 2] {
    let film = analysis.figures.iter().find_map(|f| match &f.content {
        FigureContent::Film(film) => Some(film),
        _ => None,
    });
    let mut least = [f64::INFINITY; 2];
    for frame in &film.expect("it moves").frames {
        let cam = frame.items.iter().find_map(|i| match i {
            Item::Body { corners, role: Role::Named(Look::Plate, "cam") } => Some(corners),
            _ => None,
        });
        let cam = cam.expect("a cam");
        for item in &frame.items {
            let Item::Disc { centre, radius_m, role: Role::Named(Look::Moving, "rollers") } = item else { continue };
            let corners = cam.iter().map(|p| maths::hypot(p[0] - centre[0], p[1] - centre[1])).fold(f64::INFINITY, f64::min);
            least = [least[0].min(corners - radius_m), least[1].min(distance(cam, *centre) - radius_m)];
        }
    }
    least
}

/// The turn that a refusal names, degrees.
fn named_turn(help: &str) -> f64 {
    let word = help.split("turn of ").nth(1).and_then(|t| t.split(' ').next()).and_then(|t| t.parse::<f64>().ok());
    word.unwrap_or_else(|| panic!("no turn: {help}"))
}

/// Rises of 2 to 40 mm over short and long turns: no roller meets the outline, or a turn is named for which that is so. Only long turns
/// leave too little room. The corners of what is drawn lie on the outline; a chord between two where it is hollow comes nearer by its sagitta,
/// in a ring over 170°, where 240 chords in squared steps are up to 0.03 rad long, 0.08 m 0.03²/8 = 9 µm.
#[test]
fn outlines_close_for_any_rise() {
    let clear = |analysis: &Analysis, what: &str| {
        let [corners, chords] = clearance_m(analysis);
        assert!(corners > -1e-9 && chords > -9e-6, "{what}: {corners} {chords}");
    };
    let mut refusals = 0;
    for (project, rises) in
        [(EXAMPLE.to_owned(), &[2.0, 3.0, 4.0, 6.0, 10.0, 15.0, 20.0, 30.0, 40.0][..]), (ring(), &[2.0, 4.0, 6.0, 10.0, 20.0])]
    {
        for rise_mm in rises {
            // Both have springs that are deformed by 20 mm at the start.
            let deformed = 0.02 + 0.002 * rise_mm;
            for turn in [40.0, 60.0, 80.0, 100.0, 120.0, 140.0, 160.0, 170.0] {
                let torque = 0.5 * 1400.0 * (deformed * deformed - 0.02 * 0.02) / f64::to_radians(turn);
                let what = format!("{rise_mm} mm over {turn}°, {}", project.contains("compression"));
                match tried(&with_torque(&project, torque, turn)) {
                    Ok(analysis) => clear(&analysis, &what),
                    Err(help) => {
                        assert!(help.contains("E0614") && turn > 150.0, "{what}: {help}");
                        let other = tried(&with_torque(&project, torque, named_turn(&help)));
                        clear(&other.unwrap_or_else(|e| panic!("{what}: {help} {e}")), &what);
                        refusals += 1;
                    }
                }
            }
        }
    }
    assert!(refusals > 5, "{refusals}");
}

/// A torque at which some turns between others that fit were refused: the long one that does not fit names one that does.
#[test]
fn turns_fit_up_to_the_one_that_is_named() {
    for turn in [40.0, 60.0, 100.0, 120.0, 150.0] {
        assert!(tried(&with_torque(EXAMPLE, 0.5, turn)).is_ok(), "{turn}");
    }
    let help = tried(&with_torque(EXAMPLE, 0.5, 170.0)).expect_err("no room");
    assert!(named_turn(&help) > 150.0, "{help}");
    // Rollers that leave room on both sides of a turn: both are named.
    let large = |turn: f64| with_torque(EXAMPLE, 0.5, turn).replacen("\"20 mm\"", "\"30 mm\"", 1);
    let with = |turn: f64| large(turn).replacen("0.5 N*m", &format!("{} N*m", 0.0588 / turn.to_radians()), 1);
    let help = tried(&with(105.0)).expect_err("no room");
    assert!(help.contains("longer turn of"), "{help}");
}

/// Every change that the help of E0614 names closes the outline.
#[test]
fn what_is_said_to_close_the_outline_does() {
    let text = with_torque(EXAMPLE, 0.065, 170.0);
    let help = tried(&text).expect_err("no room");
    let value =
        |after: &str| help.split(after).nth(1).and_then(|t| t.split([';', ',']).next()).map(|t| t.trim_end_matches(['"', ')']).to_owned());
    let rollers = value("rollers of ").unwrap_or_else(|| panic!("{help}"));
    assert!(tried(&text.replacen("roller_diameter = \"20 mm\"", &format!("roller_diameter = \"{rollers}\""), 1)).is_ok(), "{help}");
    let radius = value("`start_radius` of ").unwrap_or_else(|| panic!("{help}"));
    assert!(tried(&text.replacen("start_radius = \"40 mm\"", &format!("start_radius = \"{radius}\""), 1)).is_ok(), "{help}");
}

/// What CAM004 advises keeps the limit, and nothing is advised that does not.
#[test]
fn the_advice_about_the_hysteresis_keeps_its_limit() {
    let with = |rolling: &str, guide: f64, compensated: bool| {
        let friction = format!("{rolling}\nguide_friction = {guide}");
        let text = EXAMPLE.replacen("rolling_friction = 0.002", &friction, 1);
        let cut_for = "for_friction = 0.002\nfor_guide_friction = 0.2\nfor_torque = ";
        analysed(&text.replacen("for_torque = ", if compensated { cut_for } else { "for_torque = " }, 1))
    };
    let check = |analysis: &Analysis| analysis.outcome.checks.iter().find(|c| c.code == "CAM004").expect("a check").clone();
    let advice = |rolling: &str, guide: f64, compensated: bool| check(&with(rolling, guide, compensated)).advice.expect("missed");
    let number =
        |text: &str, after: &str| text.split(after).nth(1).and_then(|t| t.split([' ', ',']).next()).and_then(|t| t.parse::<f64>().ok());
    for compensated in [false, true] {
        // The guides alone are too much: no arm is named, and the guide friction that is named works.
        let text = advice("rolling_friction = 0.002", 0.2, compensated);
        let share = number(&text, "guides alone take ").unwrap_or_else(|| panic!("{text}"));
        assert!(share > 3.0 && !text.contains("arm"), "{text}");
        if !compensated {
            let alone = check(&with("rolling_friction = 0.0", 0.2, false)).value.expect("a value");
            assert!((share - 100.0 * alone).abs() < 5e-3 * share, "{share} {alone}");
        }
        let guide = number(&text, "`guide_friction` of ").unwrap_or_else(|| panic!("{text}"));
        assert!(check(&with("rolling_friction = 0.002", guide, compensated)).advice.is_none(), "{text}");
        assert!(check(&with("rolling_friction = 0.002", 1.03 * guide, compensated)).advice.is_some(), "{text}");
        // Rolling is none of it.
        let text = advice("rolling_friction = 0.0", 0.2, compensated);
        assert!(text.contains("all of it is friction of the guides") && !text.contains("arm"), "{text}");
    }
    // Rolling is too much: the arm works, beside a little friction of the guides.
    for guide in [0.0, 0.02] {
        let text = advice("rolling_friction = 0.02", guide, false);
        let arm = number(&text, "an arm of the rolling resistance of ").unwrap_or_else(|| panic!("{text}"));
        for (part, kept) in [(1.0, true), (1.03, false)] {
            let arm = format!("rolling_arm = \"{} mm\"", part * arm);
            assert_eq!(check(&with(&arm, guide, false)).advice.is_none(), kept, "{text}");
        }
    }
    // Either alone is too much.
    let text = advice("rolling_friction = 0.02", 0.2, false);
    let [arm, guide] = ["resistance of ", "`guide_friction` of "].map(|after| number(&text, after).unwrap_or_else(|| panic!("{text}")));
    assert!(check(&with(&format!("rolling_arm = \"{arm} mm\""), guide, false)).advice.is_none(), "{text}");
}

/// Springs that are slack at the start are named as such, and rollers that meet are told apart.
#[test]
fn springs_and_rollers_that_do_not_suit_are_told() {
    let help = |text: &str| tried(text).expect_err("refused");
    let slack = help(&EXAMPLE.replacen("for_rest_length = \"60 mm\"", "for_rest_length = \"90 mm\"", 1));
    assert!(slack.contains("tense at the start") && slack.contains("at least") && !slack.contains("0 deg"), "{slack}");
    let slack = help(&ring().replacen("for_rest_length = \"150 mm\"", "for_rest_length = \"110 mm\"", 1));
    assert!(slack.contains("tense at the start") && slack.contains("at most"), "{slack}");
    for torque in [20.0, 7.3] {
        let meet = help(&with_torque(&ring(), torque, 120.0));
        assert!(meet.contains("E0607") && meet.matches("shorter turn").count() <= 1, "{meet}");
    }
}
