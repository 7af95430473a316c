//! A four-bar with a spring on its rocker, let go: it swings until its damper has used up the energy.
#![allow(clippy::print_stdout, reason = "its output is its purpose")]
use forcewright_multibody::{Body, Force, GROUND, Law, Model, ModelError, Settings};

fn main() -> Result<(), ModelError> {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -9.81];
    let crank = model.body("crank", Body::rod(0.1, 0.04).placed(0.0, 0.0, 1.0));
    let coupler = model.body("coupler", Body::rod(0.3, 0.12).placed(0.02, 0.03, 0.4));
    let rocker = model.body("rocker", Body::rod(0.2, 0.09).placed(0.11, 0.0, 1.2));
    model.revolute("o2", crank.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    model.revolute("a", coupler.at(0.0, 0.0), crank.at(0.04, 0.0));
    model.revolute("b", rocker.at(0.09, 0.0), coupler.at(0.12, 0.0));
    model.revolute("o4", rocker.at(0.0, 0.0), GROUND.at(0.11, 0.0));
    model.force("spring", Force::Spring { a: rocker.at(0.05, 0.0), b: GROUND.at(0.2, 0.02), law: Law::linear(800.0, 0.05) });
    model.force("damper", Force::TorsionDamper { a: rocker, b: GROUND, damping_nm_s_per_rad: 0.005 });
    let system = model.build()?;
    let run = system.simulate(system.guess(), &[], &Settings::until(2.0));
    for (instant, energy) in run.history.iter().zip(&run.energies).step_by(20) {
        let angle = system.pose(instant.q, rocker).angle_rad.to_degrees();
        println!("{:6.2} s  rocker {angle:8.3}°  kinetic {:.5} J  heat {:.5} J", instant.time_s, energy.kinetic_j, energy.dissipated_j);
    }
    println!("{}, {} steps, energy closes to {:.1e} J", run.stop, run.steps, run.audit.worst_drift_j);
    Ok(())
}
