//! Forces do not depend on how a mechanism is described: where it stands, how it is turned, the order of its bodies, the origin of a
//! body's frame, the carrier of a path.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::FRAC_PI_2;

use forcewright_base::maths::{hypot, sin_cos};
use forcewright_multibody::{
    Body, BodyId, Contact, Follows, Force, GROUND, Grid, Inverse, JointId, Kinematics, Law, Model, Motion, Path, Settings, Side, Stop,
    System,
};
use proptest::prelude::*;

/// How the same mechanism is described.
#[derive(Debug, Clone)]
struct Description {
    shift: [f64; 2],
    turn: f64,
    order: [usize; 4],
    /// Frames of bodies, from where they would be.
    origin: [f64; 2],
    /// The path on a body that a driver holds, instead of the ground.
    carried: bool,
}

/// A slider-crank of which the slider carries a roller arm on a circular track, with a spring, dampers and gravity.
fn mechanism(lengths: [f64; 3], description: &Description) -> (System, JointId, [JointId; 2], JointId) {
    let [a, b, rate] = lengths;
    let Description { shift, turn, order, origin, carried } = description.clone();
    let (s, c) = sin_cos(turn);
    let place = |x: f64, y: f64| [shift[0] + c * x - s * y, shift[1] + s * x + c * y];
    let ground = |x: f64, y: f64| GROUND.at(place(x, y)[0], place(x, y)[1]);
    let mut model = Model::new();
    model.gravity_m_per_s2 = [9.81 * s, -9.81 * c];
    // Crank at 0.7 rad, slider on y = 0; all exact but the slider's place.
    let (s7, c7) = sin_cos(0.7);
    let fall = -forcewright_base::maths::asin(a * s7 / b);
    let far = a * c7 + b * (1.0 - (a * s7 / b) * (a * s7 / b)).sqrt();
    let poses = [[0.0, 0.0, 0.7], [a * c7, a * s7, fall], [far, 0.0, 0.0], [far + 0.2, 0.41, 1.0]];
    let bodies = [(0.3, 2e-3, [0.4 * a, 0.01]), (0.2, 1e-3, [0.5 * b, 0.0]), (0.5, 1e-3, [0.01, 0.02]), (0.4, 5e-4, [0.0, 0.0])];
    let mut ids = [GROUND; 4];
    for k in order {
        let ((mass, inertia, centre), [x, y, angle]) = (bodies[k], poses[k]);
        // Moving the frame's origin by `origin` in the body's frame.
        let (sb, cb) = sin_cos(angle);
        let at = place(x + cb * origin[0] - sb * origin[1], y + sb * origin[0] + cb * origin[1]);
        let body = Body::new(mass, inertia).centre(centre[0] - origin[0], centre[1] - origin[1]).placed(at[0], at[1], angle + turn);
        ids[k] = model.body(format!("body {k}"), body);
    }
    let on = |body: BodyId, x: f64, y: f64| body.at(x - origin[0], y - origin[1]);
    let [crank, rod, slider, roller] = ids;
    model.revolute("o", on(crank, 0.0, 0.0), ground(0.0, 0.0));
    let pin = model.revolute("a", on(rod, 0.0, 0.0), on(crank, a, 0.0));
    model.revolute("b", on(slider, 0.0, 0.0), on(rod, b, 0.0));
    model.prismatic("guide", on(slider, 0.0, 0.0), ground(0.0, 0.0), turn, turn);
    model.slot("arm", on(roller, 0.0, 0.0), on(slider, 0.2, 0.0), FRAC_PI_2);
    let base = place(far, 0.0);
    let (cam, centre) = if carried {
        let cam = model.body("carrier", Body::new(3.0, 0.2).placed(base[0], base[1], turn));
        model.revolute("carrier pin", cam.at(0.0, 0.0), ground(far, 0.0));
        model.drive_angle("carrier angle", cam, GROUND, Motion::Constant(turn));
        (cam, [0.2, 0.0])
    } else {
        (GROUND, place(far + 0.2, 0.0))
    };
    let start = FRAC_PI_2 + if carried { 0.0 } else { turn };
    let contact = Contact {
        roller: on(roller, 0.0, 0.0),
        radius_m: 0.05,
        cam,
        path: Path::Circle { centre_m: centre, radius_m: 0.35 },
        follows: Follows::Surface,
        // The circle runs counter-clockwise; outside is to the right.
        side: Side::Right,
        rolling: true,
        start,
    };
    let contact = model.contact("track", contact);
    model.force("spring", Force::Spring { a: on(rod, 0.3 * b, 0.02), b: ground(0.1, -0.3), law: Law::linear(rate, 0.2) });
    model.force("damper", Force::Damper { a: on(roller, 0.0, 0.0), b: on(crank, a, 0.0), damping_n_s_per_m: 4.0 });
    let motion = Motion::Harmonic { mean: 0.7 + turn, amplitude: 0.3, rate_rad_per_s: 9.0, phase_rad: 0.0 };
    let motor = model.drive_angle("motor", crank, GROUND, motion);
    (model.build().unwrap(), motor, [pin, contact], contact)
}

/// Motor torque, size of the pin's force, normal force and traction at all instants.
fn forces(lengths: [f64; 3], description: &Description) -> Vec<[f64; 4]> {
    let (system, motor, [pin, _], contact) = mechanism(lengths, description);
    let grid = Grid { start_s: 0.0, end_s: 0.6, steps: 30 };
    let run: Inverse = system.inverse(system.guess(), grid, Kinematics::Algebraic);
    assert_eq!(run.stop, Stop::Reached, "{} {description:?}", run.stop);
    run.history
        .iter()
        .map(|instant| {
            let pin = system.reaction(&instant, pin).unwrap().force_n;
            let contact = system.contact_force(&instant, contact).unwrap();
            [system.driver_force(&instant, motor).unwrap(), hypot(pin[0], pin[1]), contact.normal_n, contact.traction_n]
        })
        .collect()
}

const PLAIN: Description = Description { shift: [0.0; 2], turn: 0.0, order: [0, 1, 2, 3], origin: [0.0; 2], carried: false };

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn forces_do_not_depend_on_the_description(
        shift in [-2.0..2.0, -2.0..2.0],
        turn in -3.0..3.0,
        order in Just([0, 1, 2, 3]).prop_shuffle(),
        origin in [-0.2..0.2, -0.2..0.2],
        carried: bool,
        a in 0.06..0.12,
        b in 0.3..0.4,
        rate in 10.0..500.0,
    ) {
        let lengths = [a, b, rate];
        let plain = forces(lengths, &PLAIN);
        let other = forces(lengths, &Description { shift, turn, order, origin, carried });
        let size = plain.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
        for (p, o) in plain.iter().zip(&other) {
            for (p, o) in p.iter().zip(o) {
                prop_assert!((p - o).abs() < 1e-10 * size, "{p} {o}");
            }
        }
    }
}

/// The same inputs give the same bits.
#[test]
fn results_are_a_function_of_the_inputs() {
    let bits = || {
        let (system, ..) = mechanism([0.1, 0.35, 100.0], &PLAIN);
        let run = system.simulate(system.guess(), &[], &Settings::until(0.5));
        run.history.iter().flat_map(|i| i.q.iter().chain(i.multipliers).map(|v| v.to_bits()).collect::<Vec<_>>()).collect::<Vec<_>>()
    };
    let first = bits();
    let threads: Vec<_> = (0..2).map(|_| std::thread::spawn(bits)).collect();
    assert!(threads.into_iter().all(|thread| thread.join().unwrap() == first));
}
