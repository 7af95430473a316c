//! The cam in motion: the force that the slider of the prototype with two springs needs over the cycloidal rise of Sánchez-Salinas et al.
//! 2022, without friction. By symmetry half of the mechanism tells all: slider, brace and roller, nine coordinates.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use forcewright::cam::{Cam, Design, Drive, Kind, Mechanism, Pose, Sense, Spec};
use forcewright::contract::family::Mechanism as _;
use forcewright::contract::project::Project;
use forcewright::contract::read;
use forcewright::{Choices, gallery};
use forcewright_multibody::{
    Body, Contact, Follows, Force, GROUND, Grid, Kinematics, Load, Model, Motion, Path, PathPoint, Side, Stop, System,
};
use serde_json::{Value, json};

/// Instants of the motion: ends of equal steps.
const INSTANTS: u32 = 100;
/// The first of them are not compared: implicit integrators settle there.
const SETTLING: usize = 5;

/// The mechanism and its motion.
pub(crate) struct Case {
    mechanism: Mechanism,
    design: Design,
    motion: forcewright::cam::Motion,
    system: System,
}

impl Case {
    pub(crate) fn new() -> Self {
        let text = gallery::find("cam/sanchez-2-springs").expect("in the gallery").text;
        let choices = Choices { variant: Some("paper".to_owned()), set: Vec::new() };
        let mut project = Project::from_text("sanchez-2-springs.toml", text, &choices);
        let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
        let design = Cam::resolve(&mut spec, &mut project.diagnostics).and_then(Kind::slider).expect("the example is understood");
        let mechanism = design.mechanism(&design.cut().expect("a cam"));
        let motion = design.motion.expect("a motion");
        let system = half(&design, &mechanism, &motion);
        Self { mechanism, design, motion, system }
    }

    /// What another tool needs to know, SI. The springs pull each roller with `rate·(2x − rest)`; its path is
    /// `y = bend·(x − start_x)² + √(brace² − start_x²) − √(brace² − x²)`, the slider's joint begins at `start_height`.
    pub(crate) fn problem(&self) -> Value {
        let (m, b) = (&self.mechanism, &self.mechanism.bodies);
        let pose = m.pose([self.motion.start_m, 0.0]).expect("assembles");
        let springs_kg = m.springs.mass_kg();
        json!({
            "brace_m": m.brace_m[0], "roller_m": m.roller_m, "start_x_m": start_x(&self.design), "bend_per_m": bend(&self.design),
            "roller_at_m": pose.places[0].at, "start_height_m": pose.joints[0][1],
            "rate_n_per_m": m.springs.tension_n(0.0)[1], "rest_m": m.springs.rest_m(),
            "slider_kg": b.slider_kg, "brace_kg": b.brace_kg, "brace_kg_m2": b.brace_kg_m2,
            "roller_kg": b.roller_kg + 0.5 * springs_kg, "roller_kg_m2": b.roller_kg_m2,
            "rise_m": self.motion.rise_m, "duration_s": self.motion.duration_s, "instants": INSTANTS, "settling": SETTLING,
        })
    }

    /// Forces by the reduced model, N.
    pub(crate) fn reduced(&self) -> Vec<f64> {
        let mut near: Option<Pose> = None;
        let force = |i: u32| {
            let [s, v, a] = self.motion.at(f64::from(i) / f64::from(INSTANTS));
            let pose = near.insert(self.mechanism.pose_near([s, 0.0], near.as_ref()).expect("assembles"));
            let drive = Drive { at: [s, 0.0], velocity: [v, 0.0], acceleration: [a, 0.0] };
            self.mechanism.forces(pose, &drive, Sense::Frictionless).force_n
        };
        (1..=INSTANTS).map(force).skip(SETTLING).collect()
    }

    /// Forces by the general multibody engine, N: twice those of the half.
    pub(crate) fn multibody(&self) -> Vec<f64> {
        let grid = Grid { start_s: 0.0, end_s: self.motion.duration_s, steps: INSTANTS as usize };
        let run = self.system.inverse(self.system.guess(), grid, Kinematics::Algebraic);
        assert_eq!(run.stop, Stop::Reached, "the motion is possible");
        run.history.iter().skip(1 + SETTLING).map(|instant| -2.0 * instant.multipliers[DRIVE_ROW]).collect()
    }
}

/// The driver's row: after two each of guide, pin and axle, and three of the contact.
const DRIVE_ROW: usize = 9;

/// Where a roller is while the springs have no force in the cam as it was cut, m.
fn start_x(design: &Design) -> f64 {
    0.5 * design.purpose.start_length_m
}

/// From F s = K λ²/2 and λ = 2 (x − x0).
fn bend(design: &Design) -> f64 {
    2.0 * design.purpose.springs.tension_n(0.0)[1] / design.purpose.law.force_n(0.0)[0]
}

fn half(design: &Design, mechanism: &Mechanism, motion: &forcewright::cam::Motion) -> System {
    let (b, length) = (mechanism.bodies, mechanism.brace_m[0]);
    let pose = mechanism.pose([motion.start_m, 0.0]).expect("assembles");
    let ([x, y], height) = (pose.places[0].at, pose.joints[0][1]);
    let mut model = Model::new();
    model.gravity_m_per_s2 = [0.0, -mechanism.gravity_m_per_s2];
    let slider = model.body("slider", Body::new(0.5 * b.slider_kg, 1e-3).placed(0.0, height, 0.0));
    let mut rod = Body::rod(b.brace_kg, length).placed(0.0, height, forcewright::base::maths::atan2(y - height, x));
    rod.inertia_kg_m2 = b.brace_kg_m2;
    let brace = model.body("brace", rod);
    let roller_kg = b.roller_kg + 0.5 * mechanism.springs.mass_kg();
    let roller = model.body("roller", Body::new(roller_kg, b.roller_kg_m2).placed(x, y, 0.0));
    model.prismatic("guide", slider.at(0.0, 0.0), GROUND.at(0.0, 0.0), FRAC_PI_2, 0.0);
    model.revolute("pin", brace.at(0.0, 0.0), slider.at(0.0, 0.0));
    model.revolute("axle", roller.at(0.0, 0.0), brace.at(length, 0.0));
    let centre = roller.at(0.0, 0.0);
    let (x0, k) = (start_x(design), bend(design));
    let path = Path::curve(move |x: f64| {
        let c = (length * length - x * x).sqrt();
        PathPoint {
            point_m: [x, k * (x - x0) * (x - x0) + (length * length - x0 * x0).sqrt() - c],
            first: [1.0, 2.0 * k * (x - x0) + x / c],
            second: [0.0, 2.0 * k + length * length / (c * c * c)],
            third: [0.0, 3.0 * length * length * x / (c * c * c * c * c)],
        }
    });
    let radius_m = mechanism.roller_m;
    model.contact(
        "cam",
        Contact { roller: centre, radius_m, cam: GROUND, path, follows: Follows::Centre, side: Side::Right, rolling: true, start: x },
    );
    let springs = mechanism.springs.clone();
    let pull = Load::Function(Arc::new(move |s| [-springs.tension_n(2.0 * s.position_m(centre)[0])[0], 0.0]));
    model.force("springs", Force::Push { at: centre, load: pull });
    let rise = Motion::Cycloid { start: height, stroke: motion.rise_m, duration_s: motion.duration_s };
    model.drive_along("pull", slider.at(0.0, 0.0), GROUND.at(0.0, 0.0), FRAC_PI_2, rise);
    model.build().expect("a mechanism")
}
