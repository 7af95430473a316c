//! What cannot be computed is said, with the part that is to blame; nothing panics.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use forcewright_base::maths::hypot;
use proptest::prelude::*;

use forcewright_multibody::{
    AssemblyError, Body, Contact, Crossing, Follows, Force, GROUND, Grid, JointId, Kinematics, Law, Load, Method, Model, ModelError,
    Motion, Outputs, Path, PathPoint, Settings, Side, Stop, System,
};

const GRID: Grid = Grid { start_s: 0.0, end_s: 1.0, steps: 10 };

/// A parallelogram with a third lever in the middle: one of its rows follows from the others.
fn parallelogram(middle_m: f64) -> (System, JointId) {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -9.81];
    let bar = model.body("bar", Body::new(1.0, 0.1).placed(0.0, 0.3, 0.02));
    for (name, x, length) in [("left", 0.0, 0.3), ("right", 0.8, 0.3), ("middle", 0.4, middle_m)] {
        let lever = model.body(name, Body::new(0.0, 0.0).placed(x, 0.0, FRAC_PI_2));
        model.revolute(format!("{name} foot"), lever.at(0.0, 0.0), GROUND.at(x, 0.0));
        model.revolute(format!("{name} head"), lever.at(length, 0.0), bar.at(x, 0.0));
    }
    let motion = Motion::Polynomial { start: 0.0, rate: 0.1, acceleration: 0.0 };
    let driver = model.drive_along("push", bar.at(0.0, 0.0), GROUND.at(0.0, 0.0), 0.0, motion);
    (model.build().unwrap(), driver)
}

#[test]
fn redundant_rows_are_named_and_the_driver_still_has_its_force() {
    let (system, driver) = parallelogram(0.3);
    let assembled = system.assemble(0.5, system.guess(), &[]).unwrap();
    // 12 coordinates, 13 rows, of which 12 are independent.
    assert_eq!((assembled.redundant, assembled.freedom), (vec!["middle head: y".to_owned()], 0));
    for (kinematics, tolerance) in [(Kinematics::Algebraic, 1e-12), (Kinematics::Baumgarte { rate_per_s: 10.0 }, 1e-5)] {
        let run = system.inverse(system.guess(), Grid { start_s: 0.5, ..GRID }, kinematics);
        assert_eq!((run.stop, run.redundant.len()), (Stop::Reached, 1));
        for instant in run.history.iter().skip(1) {
            // The bar translates on a circle, x = 0.1 t, y² = 0.3² − x²: virtual power F ẋ = m (g + ÿ) ẏ, and ẏ/ẋ = −x/y.
            let (x, y) = (0.1 * instant.time_s, (0.09 - 0.01 * instant.time_s * instant.time_s).sqrt());
            let rise = -0.01 / y - x * x * 0.01 / (y * y * y);
            let want = -(9.81 + rise) * x / y;
            let force = system.driver_force(&instant, driver).unwrap();
            assert!((force - want).abs() < tolerance, "{force} {want}");
        }
    }
}

#[test]
fn lengths_that_do_not_fit_are_named() {
    let (system, _) = parallelogram(0.2);
    let Err(AssemblyError::Unsatisfied { row, by, .. }) = system.assemble(0.5, system.guess(), &[]) else { panic!("it closed") };
    assert!(row.contains("head") || row.contains("foot"), "{row}");
    assert!(by.abs() > 1e-3);
}

/// A four-bar: ground 0.1, crank, coupler, rocker 0.1.
fn four_bar(crank_m: f64, angle: f64, motion: Motion) -> System {
    let mut model = Model::new();
    let crank = model.body("crank", Body::new(0.1, 1e-4).placed(0.0, 0.0, angle));
    let coupler = model.body("coupler", Body::new(0.1, 1e-4).placed(0.05, 0.05, 0.3));
    let rocker = model.body("rocker", Body::new(0.1, 1e-4).placed(0.1, 0.0, 1.2));
    model.revolute("o2", crank.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    model.revolute("a", coupler.at(0.0, 0.0), crank.at(crank_m, 0.0));
    model.revolute("b", rocker.at(0.1, 0.0), coupler.at(0.1, 0.0));
    model.revolute("o4", rocker.at(0.0, 0.0), GROUND.at(0.1, 0.0));
    model.drive_angle("motor", crank, GROUND, motion);
    model.build().unwrap()
}

#[test]
fn links_that_are_too_short_come_as_near_as_they_can() {
    // Crank at 180°: its pin is 0.22 from the rocker's foot, coupler and rocker reach 0.2. Held: the crank's angle.
    let system = four_bar(0.12, PI, Motion::Constant(PI));
    let error = system.assemble(0.0, system.guess(), &[]).unwrap_err();
    let AssemblyError::Unsatisfied { by, singular, nearest, .. } = &error else { panic!("{error}") };
    assert!(*singular && by.abs() < 0.02 && nearest.len() == 9, "{error}");
    assert!(error.to_string().contains("stretched"), "{error}");
}

#[test]
fn the_branch_nearest_to_the_guess_is_taken() {
    let motion = || Motion::Constant(1.0);
    let mut heights = Vec::new();
    for sign in [1.0, -1.0] {
        let system = four_bar(0.03, 1.0, motion());
        let mut guess = system.guess().to_vec();
        // Coupler and rocker above or below the line of their outer pins.
        guess[5] = 0.5 * sign;
        guess[8] = 1.5 * sign;
        let q = system.assemble(0.0, &guess, &[]).unwrap().q;
        heights.push(q[7] + 0.1 * forcewright_base::maths::sin(q[8]));
    }
    assert!(heights[0] > 0.05 && heights[1] < -0.05, "{heights:?}");
}

#[test]
fn a_dead_centre_is_singular() {
    // A slider-crank driven by its slider through the stretched position.
    let mut model = Model::new();
    let crank = model.body("crank", Body::new(0.1, 1e-4).placed(0.0, 0.0, 0.5));
    let rod = model.body("rod", Body::new(0.1, 1e-4).placed(0.088, 0.048, -0.2));
    model.revolute("o", crank.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    model.revolute("a", rod.at(0.0, 0.0), crank.at(0.1, 0.0));
    model.slot("b", rod.at(0.3, 0.0), GROUND.at(0.0, 0.0), 0.0);
    let motion = Motion::Polynomial { start: 0.38, rate: 0.05, acceleration: 0.0 };
    model.drive_along("slider", rod.at(0.3, 0.0), GROUND.at(0.0, 0.0), 0.0, motion);
    let system = model.build().unwrap();
    for kinematics in [Kinematics::Algebraic, Kinematics::Baumgarte { rate_per_s: 10.0 }] {
        let run = system.inverse(system.guess(), Grid { steps: 1000, ..GRID }, kinematics);
        // It is stretched at 0.4 s.
        let reached = run.history.last().unwrap().time_s;
        assert!(run.stop != Stop::Reached || matches!(kinematics, Kinematics::Baumgarte { .. }), "{kinematics:?}");
        assert!(run.stop == Stop::Reached || (0.38..0.42).contains(&reached), "{reached}");
        assert!(run.stop != Stop::Reached || run.worst_miss > 1e-2, "{kinematics:?} {}", run.worst_miss);
    }
}

#[test]
fn missing_drivers_and_blades_are_named() {
    let mut model = Model::new();
    let bar = model.body("bar", Body::rod(1.0, 1.0));
    model.revolute("pivot", bar.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    let mut skated = model.clone();
    let run = model.build().unwrap().inverse(&[0.5, 0.0, 0.0], GRID, Kinematics::Algebraic);
    let Stop::NotDriven { freedom: 1, coordinate } = &run.stop else { panic!("{}", run.stop) };
    assert!(coordinate.starts_with("bar: "), "{coordinate}");
    skated.skate("blade", bar.at(1.0, 0.0), FRAC_PI_2);
    let run = skated.build().unwrap().inverse(&[0.5, 0.0, 0.0], GRID, Kinematics::Algebraic);
    assert_eq!(run.stop, Stop::NotIntegrable { row: "blade: sideways".to_owned() });
}

#[test]
fn what_nothing_holds_and_has_no_mass_is_named() {
    let mut model = Model::new();
    model.body("ghost", Body::new(0.0, 0.0));
    let system = model.build().unwrap();
    let run = system.simulate(system.guess(), &[], &Settings::until(1.0));
    assert_eq!(run.stop, Stop::Singular { part: "ghost: x".to_owned() });
    assert!(run.history.is_empty());
}

#[test]
fn forces_that_are_not_numbers_end_the_motion() {
    let mut model = Model::new();
    let ball = model.body("ball", Body::new(1.0, 1.0));
    let load = Load::Function(Arc::new(|s| [if s.time_s < 0.5 { 1.0 } else { f64::NAN }, 0.0]));
    model.force("jet", Force::Push { at: ball.at(0.0, 0.0), load });
    let system = model.build().unwrap();
    let run = system.simulate(system.guess(), &[], &Settings::until(1.0));
    assert_eq!(run.stop, Stop::NotFinite);
    assert!(run.reached_s > 0.49 && run.reached_s < 0.5 && !run.history.is_empty(), "{}", run.reached_s);
}

#[test]
fn steps_are_limited_and_settings_checked() {
    let mut model = Model::new();
    let ball = model.body("ball", Body::new(1.0, 1.0).placed(1.0, 0.0, 0.0));
    model.force("spring", Force::Spring { a: ball.at(0.0, 0.0), b: GROUND.at(0.0, 0.0), law: Law::linear(1e4, 0.5) });
    let system = model.build().unwrap();
    let run = system.simulate(system.guess(), &[], &Settings { max_steps: 20, ..Settings::until(10.0) });
    assert!(run.stop == Stop::TooManySteps && run.steps <= 20 && run.reached_s > 0.0);
    let bad = [
        Settings::until(-1.0),
        Settings::until(f64::NAN),
        Settings::until(1.0).accuracy(0.0),
        Settings { method: Method::Fixed { steps: 0, project: true }, ..Settings::until(1.0) },
        Settings { outputs: Outputs::At(vec![0.5, 0.2]), ..Settings::until(1.0) },
    ];
    for settings in bad {
        assert_eq!(system.simulate(system.guess(), &[], &settings).stop, Stop::Settings);
    }
    assert_eq!(system.simulate(system.guess(), &[1.0], &Settings::until(1.0)).stop, Stop::Settings);
    assert_eq!(system.simulate(&[1.0], &[], &Settings::until(1.0)).stop, Stop::NotAssembled(AssemblyError::WrongSize));
    let nan = system.simulate(&[f64::NAN, 0.0, 0.0], &[], &Settings::until(1.0));
    assert!(nan.stop != Stop::Reached);
    // An event that is not a number is no event.
    let run = system.simulate(system.guess(), &[], &Settings::until(0.01).event(Crossing::Any, true, |_| f64::NAN));
    assert_eq!((run.stop, run.hits.len()), (Stop::Reached, 0));
}

#[test]
fn models_are_checked() {
    let body = Body::new(1.0, 0.1);
    let stranger = {
        let mut other = Model::new();
        other.body("one", body);
        other.body("two", body)
    };
    let mut base = Model::new();
    let a = base.body("a", body);
    let check = |add: &dyn Fn(&mut Model)| {
        let mut model = base.clone();
        add(&mut model);
        model.build().unwrap_err()
    };
    let unknown = |part: &str| ModelError::Unknown { part: part.to_owned() };
    assert_eq!(
        check(&|m| {
            m.revolute("pin", a.at(0.0, 0.0), stranger.at(0.0, 0.0));
        }),
        unknown("pin")
    );
    let no_contact = base.clone().revolute("pin", a.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    assert_eq!(
        check(&|m| {
            m.drive_parameter("drive", no_contact, Motion::Constant(0.0));
        }),
        unknown("drive")
    );
    assert_eq!(
        check(&|m| {
            m.rod("rod", a.at(0.0, 0.0), a.at(1.0, 0.0), 1.0);
        }),
        ModelError::SameBody { part: "rod".to_owned() }
    );
    let range = |result: ModelError| matches!(result, ModelError::OutOfRange { .. });
    assert!(range(check(&|m| {
        m.rod("rod", a.at(0.0, 0.0), GROUND.at(1.0, 0.0), 0.0);
    })));
    assert!(range(check(&|m| {
        m.body("b", Body::new(-1.0, 0.0));
    })));
    let finite = |result: ModelError| matches!(result, ModelError::NotFinite { .. });
    assert!(finite(check(&|m| {
        m.body("b", Body::new(1.0, 0.0).placed(f64::NAN, 0.0, 0.0));
    })));
    assert!(finite(check(&|m| m.gravity_m_per_s2 = [f64::INFINITY, 0.0])));
    assert!(finite(check(&|m| {
        m.drive_angle("d", a, GROUND, Motion::Constant(f64::NAN));
    })));
    let path = Path::curve(|_: f64| PathPoint::default());
    let contact = Contact {
        roller: a.at(0.0, 0.0),
        radius_m: 0.1,
        cam: GROUND,
        path,
        follows: Follows::Surface,
        side: Side::Left,
        rolling: true,
        start: 0.0,
    };
    assert!(finite(check(&|m| {
        m.contact("cam", contact.clone());
    })));
}

/// Held coordinates stay, the rest closes; velocities at the start are brought onto the constraints.
#[test]
fn held_coordinates_and_start_velocities() {
    let mut model = Model::new();
    let a = model.body("a", Body::rod(1.0, 1.0).placed(0.0, 0.0, 0.3));
    let b = model.body("b", Body::rod(1.0, 1.0).placed(1.1, 0.2, -0.2));
    model.revolute("o", a.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    model.revolute("p", b.at(0.0, 0.0), a.at(1.0, 0.0));
    let system = model.build().unwrap();
    let assembled = system.assemble(0.0, system.guess(), &[2]).unwrap();
    assert!((assembled.q[2] - 0.3).abs() < 1e-15 && assembled.freedom == 2 && assembled.redundant.is_empty());
    let run = system.simulate(&assembled.q, &[0.0, 1.0, 0.0, 0.0, 0.0, 2.0], &Settings::until(0.1));
    let start = run.history.get(0).unwrap();
    let pin = system.look(&start, |s| (s.velocity_m_per_s(a.at(1.0, 0.0)), s.velocity_m_per_s(b.at(0.0, 0.0)))).unwrap();
    assert!(hypot(pin.0[0] - pin.1[0], pin.0[1] - pin.1[1]) < 1e-13 && hypot(pin.0[0], pin.0[1]) > 0.1);
}

/// Values as they come from mistakes.
fn odd() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -2.0..2.0,
        1 => Just(0.0),
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(1e300), Just(-1e160), Just(1e-300)],
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Any description either is refused or gives a result that says how it ended.
    #[test]
    fn nothing_panics(
        kinds in prop::collection::vec((0..10_u8, 0..4_usize, 0..4_usize), 0..7),
        values in prop::collection::vec(odd(), 12),
        guess in prop::collection::vec(odd(), 12),
        velocity in prop::collection::vec(odd(), 12),
    ) {
        let mut next = values.iter().cycle().copied();
        let mut value = || next.next().unwrap_or(0.0);
        let mut model = Model::new();
        model.gravity_m_per_s2 = [0.0, -9.81];
        let mut bodies = vec![GROUND];
        for name in ["a", "b", "c"] {
            bodies.push(model.body(name, Body::new(value().abs(), value().abs()).centre(value(), 0.1).placed(value(), 0.2, value())));
        }
        for (kind, i, k) in kinds {
            let (a, b) = (bodies[i].at(value(), value()), bodies[k].at(value(), value()));
            let motion = Motion::Harmonic { mean: value(), amplitude: value(), rate_rad_per_s: 3.0, phase_rad: 0.1 };
            let path = Path::Circle { centre_m: [value(), value()], radius_m: value() };
            let (follows, side) = (Follows::Surface, Side::Left);
            let contact =
                Contact { roller: a, radius_m: value().abs(), cam: bodies[k], path, follows, side, rolling: kind == 7, start: value() };
            match kind {
                0 => { model.revolute("revolute", a, b); }
                1 => { model.prismatic("prismatic", a, b, value(), value()); }
                2 => { model.rod("rod", a, b, value()); }
                3 => { model.drive_along("along", a, b, value(), motion); }
                4 => { model.drive_angle("angle", bodies[i], bodies[k], motion); }
                5 => { model.skate("skate", a, value()); }
                6 | 7 => { model.contact("contact", contact); }
                8 => model.force("spring", Force::Spring { a, b, law: Law::linear(value(), value()) }),
                _ => model.force("push", Force::Push { at: a, load: Load::Fixed([value(), value()]) }),
            }
        }
        if let Ok(system) = model.build() {
            let n = system.coordinates().min(12);
            let _ = system.assemble(0.0, &guess[..n], &[]);
            for start in [&guess[..n], system.guess()] {
                for kinematics in [Kinematics::Algebraic, Kinematics::Baumgarte { rate_per_s: 5.0 }] {
                    let run = system.inverse(start, GRID, kinematics);
                    prop_assert!(run.stop != Stop::Reached || run.history.len() == 11);
                    prop_assert!(run.history.iter().all(|i| i.multipliers.iter().all(|l| l.is_finite())));
                }
                let speed: Vec<f64> = velocity[..n].to_vec();
                let settings = Settings { max_steps: 300, ..Settings::until(0.5) }.event(Crossing::Any, false, |s| s.time_s - 0.2);
                let run = system.simulate(start, &speed, &settings);
                prop_assert!(run.stop != Stop::Reached || run.hits.len() == 1);
                prop_assert!(run.history.iter().all(|i| i.q.iter().chain(i.multipliers).all(|l| l.is_finite())));
            }
        }
    }
}
