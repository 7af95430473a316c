//! Arm angles of a five-bar robot whose tip is led along a circle, and the force that leads it against weight and inertia.
#![allow(clippy::print_stdout, reason = "its output is its purpose")]
use std::f64::consts::FRAC_PI_2;

use forcewright_multibody::{Body, BodyId, GROUND, Grid, Kinematics, Model, ModelError, Motion};

fn main() -> Result<(), ModelError> {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -9.81];
    let mut bar = |name: &str, length: f64, x: f64, y: f64, angle: f64| model.body(name, Body::rod(0.1, length).placed(x, y, angle));
    let upper: [BodyId; 2] = [bar("left arm", 0.09, 0.0, 0.0, 2.2), bar("right arm", 0.09, 0.1, 0.0, 0.9)];
    let lower = [bar("left rod", 0.13, -0.05, 0.07, 0.6), bar("right rod", 0.13, 0.15, 0.07, 2.5)];
    for (k, x) in [0.0, 0.1].into_iter().enumerate() {
        model.revolute("shoulder", upper[k].at(0.0, 0.0), GROUND.at(x, 0.0));
        model.revolute("elbow", lower[k].at(0.0, 0.0), upper[k].at(0.09, 0.0));
    }
    model.revolute("tip", lower[1].at(0.13, 0.0), lower[0].at(0.13, 0.0));
    let motion = |mean, phase_rad| Motion::Harmonic { mean, amplitude: 0.02, rate_rad_per_s: 5.0, phase_rad };
    let x = model.drive_along("x", lower[0].at(0.13, 0.0), GROUND.at(0.0, 0.0), 0.0, motion(0.05, FRAC_PI_2));
    let y = model.drive_along("y", lower[0].at(0.13, 0.0), GROUND.at(0.0, 0.0), FRAC_PI_2, motion(0.15, 0.0));
    let system = model.build()?;
    let run = system.inverse(system.guess(), Grid { start_s: 0.0, end_s: 1.2566, steps: 12 }, Kinematics::Algebraic);
    for instant in run.history.iter() {
        let angles = upper.map(|arm| system.pose(instant.q, arm).angle_rad.to_degrees());
        let forces = [x, y].map(|driver| system.driver_force(&instant, driver).unwrap_or(f64::NAN));
        println!("{:6.3} s  arms {angles:8.3?}°  force at the tip {forces:7.4?} N", instant.time_s);
    }
    Ok(())
}
