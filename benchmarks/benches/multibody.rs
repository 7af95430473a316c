//! Motions of a general planar mechanism: one half of a symmetric cam mechanism with slider, brace and roller (nine coordinates of
//! bodies and the parameter of the contact).

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use divan::{Bencher, black_box};
use forcewright_multibody::{
    Body, Contact, Follows, Force, GROUND, Grid, Kinematics, Load, Method, Model, Motion, Outputs, Path, PathPoint, Settings, Side, Stop,
    System,
};

fn main() {
    divan::main();
}

const BRACE_M: f64 = 0.2;
const START_M: f64 = 0.22;
const DURATION_S: f64 = 0.125;

/// Centre of the roller by its abscissa: y = (x − 0.068)²/0.018116 − √(l² − x²) + √(l² − 0.068²).
fn path(x: f64) -> PathPoint {
    let (delta, c) = (x - 0.068, (BRACE_M * BRACE_M - x * x).sqrt());
    let start = (BRACE_M * BRACE_M - 0.068 * 0.068_f64).sqrt();
    PathPoint {
        point_m: [x, delta * delta / 0.018_116 + start - c],
        first: [1.0, delta / 0.009_058 + x / c],
        second: [0.0, 1.0 / 0.009_058 + BRACE_M * BRACE_M / (c * c * c)],
        third: [0.0, 3.0 * BRACE_M * BRACE_M * x / (c * c * c * c * c)],
    }
}

fn half_mechanism(driven: bool) -> System {
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -9.81];
    let slider = model.body("slider", Body::new(0.034, 1e-3).placed(0.0, START_M, 0.0));
    let brace = model.body("brace", Body::rod(0.077, BRACE_M).placed(0.0, START_M, -1.09));
    let roller = model.body("roller", Body::new(0.38, 4.61e-6).placed(0.092, 0.042, 0.0));
    model.prismatic("guide", slider.at(0.0, 0.0), GROUND.at(0.0, 0.0), FRAC_PI_2, 0.0);
    model.revolute("pin", brace.at(0.0, 0.0), slider.at(0.0, 0.0));
    model.revolute("axle", roller.at(0.0, 0.0), brace.at(BRACE_M, 0.0));
    let centre = roller.at(0.0, 0.0);
    let path = Path::curve(path);
    let contact = Contact {
        roller: centre,
        radius_m: 0.016,
        cam: GROUND,
        path,
        follows: Follows::Centre,
        side: Side::Right,
        rolling: true,
        start: 0.092,
    };
    model.contact("cam", contact);
    let pull = Load::Function(Arc::new(move |s| [-2760.0 * (s.position_m(centre)[0] - 0.068), 0.0]));
    model.force("springs", Force::Push { at: centre, load: pull });
    if driven {
        let motion = Motion::Cycloid { start: START_M, stroke: 0.1, duration_s: DURATION_S };
        model.drive_along("pull", slider.at(0.0, 0.0), GROUND.at(0.0, 0.0), FRAC_PI_2, motion);
    } else {
        model.force("hand", Force::Push { at: slider.at(0.0, 0.0), load: Load::Fixed([0.0, 35.0]) });
    }
    model.build().expect("a mechanism")
}

/// The inverse procedure of Sánchez-Salinas et al. 2022 with 1000 steps: positions, velocities, accelerations, multipliers.
#[divan::bench(args = ["baumgarte", "algebraic"])]
fn inverse_1000_steps(bencher: Bencher<'_, '_>, kinematics: &str) {
    let system = half_mechanism(true);
    let kinematics = match kinematics {
        "baumgarte" => Kinematics::Baumgarte { rate_per_s: 10.0 / DURATION_S },
        _ => Kinematics::Algebraic,
    };
    let grid = Grid { start_s: 0.0, end_s: DURATION_S, steps: 1000 };
    bencher.bench_local(|| {
        let run = black_box(&system).inverse(system.guess(), grid, kinematics);
        assert_eq!(run.stop, Stop::Reached);
        run.history.last().map(|instant| instant.multipliers[9])
    });
}

/// The same mechanism under a force from the hand: 1000 classical steps with projection, and adaptive steps to 1e-9 for the same time.
#[divan::bench(args = ["classical", "adaptive"])]
fn forward(bencher: Bencher<'_, '_>, method: &str) {
    let system = half_mechanism(false);
    let method = match method {
        "classical" => Method::Fixed { steps: 1000, project: true },
        _ => Method::Adaptive { accuracy: 1e-9, longest_step_s: f64::INFINITY },
    };
    let settings = Settings { method, outputs: Outputs::Grid(100), ..Settings::until(DURATION_S) };
    bencher.bench_local(|| {
        let run = black_box(&system).simulate(system.guess(), &[], &settings);
        assert_eq!(run.stop, Stop::Reached);
        (run.steps, run.history.last().map(|instant| instant.q[1]))
    });
}
