//! A torque cam for studies that look at many: torques both ways over the window, and what follows from the whole turn.

use std::sync::Arc;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_contract::studies::Free;
use forcewright_study::evaluator::{Evaluation, Evaluator, Failure, Measure, Output, Variable, Workspace};

use super::analysis::{Behaviour, measure_scalars};
use super::cut::Cut;
use super::design::Design;
use super::motion::prescribed;
use crate::design::si;
use crate::metrics::METRICS;
use crate::spec::Spec;
use crate::springs::SpringLaw;
use crate::study::knobs::set_rate;
use crate::study::many::{PANELS, STATIONS, measures, of_forces};

/// Metrics that follow from the torques over the window, in the order in which those of forces do.
const OF_TORQUES: [&str; 13] = [
    "torque_deviation",
    "torque_mean",
    "torque_up_mean",
    "torque_up_sd",
    "torque_up_max",
    "torque_up_min",
    "torque_down_mean",
    "torque_down_sd",
    "torque_down_max",
    "torque_down_min",
    "loop_area",
    "hysteresis",
    "torque_spread",
];

/// Metrics that are values of their own, after the torques.
const SCALARS: [&str; 14] = [
    "width",
    "path_curvature_radius_min",
    "undercut_turn",
    "pressure_angle_max",
    "spring_length_max",
    "spring_length_min",
    "contact_force_max",
    "contact_force_min",
    "friction_needed_max",
    "guide_force_max",
    "peak_torque_ratio",
    "torque_min_motion",
    "contact_force_min_motion",
    "moving_mass",
];

/// What a number changes of the mechanism as it is built; the disc stays as it was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Knob {
    RollerDiameter,
    RollingArm,
    RollingFriction,
    GuideFriction,
    Rate(usize),
    RateOfAll,
    RestLength,
    Turns,
    Pitch,
    SpringMass,
    FollowerMass,
    DiscInertia,
    RollerMass,
    RollerInertia,
}

/// See the module.
struct Many {
    knobs: Vec<Knob>,
    variables: Vec<Variable>,
    base: Design,
    cut: Arc<Cut>,
    window_rad: [f64; 2],
    wanted: Option<Vec<f64>>,
    outputs: Vec<Output>,
    measures: Vec<Measure>,
    /// Turns of the adjusting screw and its pitch, m.
    screw: [f64; 2],
}

struct Room {
    design: Design,
}

/// The design as studies that look at many see it; what cannot vary is reported.
pub(crate) fn evaluator(spec: &Spec, design: &Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>> {
    let before = diagnostics.errors();
    let mut knobs = Vec::new();
    for free in free {
        match knob(&free.number.path) {
            Ok(knob) => knobs.push(knob),
            Err(why) => diagnostics.push(
                Diagnostic::error("E0313", free.number.span, format!("a study cannot change `{}`", free.number.path))
                    .label(why)
                    .help("take it out of the study's numbers"),
            ),
        }
    }
    let behaviour = Behaviour::of(design).ok().filter(|_| diagnostics.errors() == before)?;
    let variables = free.iter().map(|free| Variable {
        path: free.number.path.clone(),
        unit: free.number.dimension.si_symbol(),
        nominal: free.number.si,
        lower: free.lower,
        upper: free.upper,
    });
    let torque = |name: &str, index: usize| Output { name: name.to_owned(), unit: "N*m", values: index * STATIONS..(index + 1) * STATIONS };
    let mut outputs = vec![torque("torque_up", 0), torque("torque_down", 1), torque("torque", 2)];
    for (index, name) in SCALARS.iter().enumerate() {
        let unit = METRICS.iter().find(|m| m.name == *name).map_or("1", |m| m.dimension.si_symbol());
        outputs.push(Output { name: (*name).to_owned(), unit, values: 3 * STATIONS + index..3 * STATIONS + index + 1 });
    }
    let window_rad = behaviour.window_rad;
    let law = design.requirements.as_ref().and_then(|r| r.force.as_ref()).map(|(law, _)| law);
    let adjust = &spec.design.springs.adjust;
    Some(Box::new(Many {
        knobs,
        variables: variables.collect(),
        cut: behaviour.mechanism.cut,
        window_rad,
        wanted: law.map(|law| turns(window_rad).map(|turn| law.force_n(turn)[0]).collect()),
        outputs,
        measures: measures(
            OF_TORQUES.iter().chain(&SCALARS),
            design.requirements.as_ref(),
            design.built.lengths_m,
            design.motion.is_some(),
        ),
        base: design.clone(),
        screw: [si(&adjust.turns).unwrap_or(0.0), si(&adjust.pitch).unwrap_or(0.0)],
    }))
}

/// Turns at which torques are computed, rad.
fn turns([from, to]: [f64; 2]) -> impl Iterator<Item = f64> {
    (0..STATIONS).map(move |i| from + (to - from) * i as f64 / (STATIONS - 1) as f64)
}

/// What a path means, or why a study cannot change it.
fn knob(path: &str) -> Result<Knob, &'static str> {
    if path.starts_with("design.profile.") || path.starts_with("design.disc.") || path == "design.turn" {
        return Err("the disc is cut once: what it is cut for does not scatter");
    }
    Ok(match path {
        "design.roller_diameter" => Knob::RollerDiameter,
        "design.rolling_arm" => Knob::RollingArm,
        "design.rolling_friction" => Knob::RollingFriction,
        "design.guide_friction" => Knob::GuideFriction,
        "design.springs.rate" => Knob::RateOfAll,
        "design.springs.rest_length" => Knob::RestLength,
        "design.springs.adjust.turns" => Knob::Turns,
        "design.springs.adjust.pitch" => Knob::Pitch,
        "design.springs.mass" => Knob::SpringMass,
        "design.bodies.follower_mass" => Knob::FollowerMass,
        "design.bodies.disc_inertia" => Knob::DiscInertia,
        "design.bodies.roller_mass" => Knob::RollerMass,
        "design.bodies.roller_inertia" => Knob::RollerInertia,
        _ => match path.strip_prefix("design.springs.rates.").and_then(|n| n.parse::<usize>().ok()) {
            Some(place @ 1..) => Knob::Rate(place - 1),
            _ => return Err("it does not change the torque"),
        },
    })
}

impl Many {
    /// Changes a copy of the design.
    fn apply(&self, x: &[f64], design: &mut Design) {
        let built = &mut design.built;
        let [mut turns, mut pitch_m] = self.screw;
        // Rollers first: a coefficient of rolling friction is an arm over their radius.
        if let Some((_, diameter_m)) = self.knobs.iter().zip(x).find(|(knob, _)| matches!(knob, Knob::RollerDiameter)) {
            built.roller_m = 0.5 * diameter_m;
        }
        for (knob, x) in self.knobs.iter().zip(x) {
            match *knob {
                Knob::RollerDiameter => {}
                Knob::RollingArm => built.arm_m = *x,
                Knob::RollingFriction => built.arm_m = x * built.roller_m,
                Knob::GuideFriction => built.guide_friction = *x,
                Knob::Rate(index) => built.springs.get_mut(index).into_iter().for_each(|s| set_rate(s, *x)),
                Knob::RateOfAll => built.springs.iter_mut().for_each(|s| set_rate(s, *x)),
                Knob::RestLength => {
                    for spring in &mut built.springs {
                        if let SpringLaw::Linear { rest_m, .. } = &mut spring.law {
                            *rest_m = *x;
                        }
                    }
                }
                Knob::Turns => turns = *x,
                Knob::Pitch => pitch_m = *x,
                Knob::SpringMass => built.springs.iter_mut().for_each(|s| s.mass_kg = *x),
                Knob::FollowerMass => built.bodies.follower_kg = *x,
                Knob::DiscInertia => built.bodies.disc_kg_m2 = *x,
                Knob::RollerMass => built.bodies.roller_kg = *x,
                Knob::RollerInertia => built.bodies.roller_kg_m2 = *x,
            }
        }
        built.springs.iter_mut().for_each(|s| s.stretch_m = turns * pitch_m);
    }
}

impl Evaluator for Many {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn stations(&self, output: usize) -> Vec<f64> {
        if output < 3 { turns(self.window_rad).collect() } else { Vec::new() }
    }

    fn measures(&self) -> &[Measure] {
        &self.measures
    }

    fn workspace(&self) -> Workspace {
        Workspace::new(Room { design: self.base.clone() })
    }

    fn evaluate(&self, x: &[f64], derivatives: bool, out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        let failure = |reason: &str| Failure { reason: reason.to_owned() };
        let room = workspace.get::<Room>().ok_or_else(|| failure("the room is another evaluator's"))?;
        room.design.clone_from(&self.base);
        self.apply(x, &mut room.design);
        let mut behaviour = Behaviour::sampled(room.design.mechanism(&self.cut), self.window_rad, 2 * PANELS, 2 * PANELS);
        behaviour.motion = room.design.motion.as_ref().and_then(|m| prescribed(&behaviour.mechanism, m).ok());
        if behaviour.stopped.is_some() || room.design.motion.is_some() != behaviour.motion.is_some() {
            return Err(failure("no roller stands on the disc"));
        }
        out.values.clear();
        let window = &behaviour.window;
        out.values.extend(window.iter().map(|s| s.up.torque_nm));
        out.values.extend(window.iter().map(|s| s.down.torque_nm));
        out.values.extend(window.iter().map(|s| s.still.torque_nm));
        let scalars = measure_scalars(&behaviour);
        out.values.extend(SCALARS.iter().map(|name| scalars.get(name).unwrap_or(0.0)));
        out.jacobian.clear();
        if derivatives {
            let steps: Vec<f64> = self.variables.iter().map(|v| 1e-5 * v.nominal.abs().max(1e-3 * v.scale().min(1.0))).collect();
            forcewright_study::differences::jacobian_with_steps(self, x, &steps, out, workspace)?;
        }
        Ok(())
    }

    fn measure(&self, _: &[f64], values: &[f64], out: &mut Vec<f64>, _: &mut Workspace) {
        out.clear();
        if values.len() != 3 * STATIONS + SCALARS.len() {
            out.resize(self.measures.len(), f64::NAN);
            return;
        }
        out.extend(of_forces(values, self.wanted.as_deref(), self.window_rad));
        out.extend(&values[3 * STATIONS..]);
    }
}
