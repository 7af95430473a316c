//! Torque of a slider-crank at constant speed.
#![allow(clippy::print_stdout, reason = "its output is its purpose")]
use forcewright_multibody::{Body, GROUND, Grid, Kinematics, Model, ModelError, Motion};

fn main() -> Result<(), ModelError> {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -9.81];
    let crank = model.body("crank", Body::rod(0.2, 0.05).placed(0.0, 0.0, 0.5));
    let rod = model.body("rod", Body::rod(0.3, 0.15).placed(0.044, 0.024, -0.16));
    let slider = model.body("slider", Body::new(0.5, 0.0).placed(0.19, 0.0, 0.0));
    model.revolute("main pin", crank.at(0.0, 0.0), GROUND.at(0.0, 0.0));
    model.revolute("crank pin", rod.at(0.0, 0.0), crank.at(0.05, 0.0));
    model.revolute("wrist pin", slider.at(0.0, 0.0), rod.at(0.15, 0.0));
    model.prismatic("guide", slider.at(0.0, 0.0), GROUND.at(0.0, 0.0), 0.0, 0.0);
    let motor = model.drive_angle("motor", crank, GROUND, Motion::Polynomial { start: 0.0, rate: 100.0, acceleration: 0.0 });
    let system = model.build()?;
    let run = system.inverse(system.guess(), Grid { start_s: 0.0, end_s: 0.0628, steps: 12 }, Kinematics::Algebraic);
    for instant in run.history.iter() {
        let (slider, torque_nm) = (system.pose(instant.q, slider), system.driver_force(&instant, motor).unwrap_or(f64::NAN));
        println!("{:8.4} s  slider {:8.3} mm  torque {torque_nm:8.4} N·m", instant.time_s, 1e3 * slider.x_m);
    }
    println!("{}", run.stop);
    Ok(())
}
