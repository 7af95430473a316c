//! A torque cam for studies that look at many: torques both ways over the window, and what follows from the whole turn.

use std::sync::Arc;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_contract::studies::{Free, Purpose};
use forcewright_study::differences::{self, Steps};
use forcewright_study::evaluator::{Evaluation, Evaluator, Failure, Measure, Output, Variable, Workspace};
use forcewright_study::task::Task;

use super::analysis::{Behaviour, measure_scalars, outline};
use super::cut::Cut;
use super::design::{Design, Misfit, misfit};
use super::motion::prescribed;
use crate::analysis::Measured;
use crate::design::profile::compensated;
use crate::design::si;
use crate::law::ForceLaw;
use crate::spec::Spec;
use crate::springs::{Bank, Spring, SpringLaw};
use crate::study::knobs::set_rate;
use crate::study::many::{PANELS, STATIONS, STEP, held, limited, measures, of_forces, outputs_of, scalars};
use crate::study::task as search;

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

/// Metrics of the outline, which stays where the disc does.
const OF_OUTLINE: [&str; 2] = ["disc_diameter", "hub_wall"];

/// What a number changes. In a search the disc is cut anew for the design that is tried; the scatter of making leaves it as it was cut.
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
    StartRadius,
    ForTorque,
    ForRate,
    ForRestLength,
    ForFriction,
    ForGuideFriction,
}

/// Numbers that stand together in the file and apart in the design.
#[derive(Clone, Copy, Debug)]
struct FromFile {
    turns: f64,
    pitch_m: f64,
    for_rate: f64,
    for_rest_m: f64,
    /// Sign of the friction that is compensated.
    way: f64,
    /// Rolling friction of rollers of any size. Without it the arm stays when the rollers change: scatter of making keeps it, and so does a
    /// search where the file gives the arm.
    rolling: Option<f64>,
}

/// See the module.
struct Many {
    knobs: Vec<Knob>,
    variables: Vec<Variable>,
    base: Design,
    /// The disc and what is measured of its outline, where they are the same for all.
    fixed: Option<(Arc<Cut>, Measured)>,
    window_rad: [f64; 2],
    wanted: Option<Vec<f64>>,
    /// Metrics that are values of their own, after the torques.
    scalars: Vec<&'static str>,
    /// Metrics of the torques that a search limits, by their places in [`OF_TORQUES`]: values after those.
    held: Vec<usize>,
    outputs: Vec<Output>,
    measures: Vec<Measure>,
    file: FromFile,
    steps: Steps,
}

struct Room {
    design: Design,
}

/// The design as studies that look at many see it; what cannot vary is reported.
pub(crate) fn evaluator(spec: &Spec, design: &Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>> {
    Some(Box::new(Many::new(spec, design, (free, Purpose::Scatter), diagnostics)?))
}

/// The search that `[optimise]` asks for.
pub(crate) fn task(spec: &Spec, design: &Design, free: &[Free], purpose: Purpose, diagnostics: &mut Diagnostics) -> Option<Task> {
    let many = Many::new(spec, design, (free, purpose), diagnostics)?;
    let wanted: Vec<f64> =
        many.wanted.clone().unwrap_or_else(|| turns(many.window_rad).map(|t| design.purpose.law.force_n(t)[0]).collect());
    let asked = (&search::TORQUE, wanted.as_slice());
    search::task(Box::new(many), asked, design.requirements.as_ref(), &spec.studies.optimise.objective, diagnostics)
}

/// Turns at which torques are computed, rad.
fn turns([from, to]: [f64; 2]) -> impl Iterator<Item = f64> {
    (0..STATIONS).map(move |i| from + (to - from) * i as f64 / (STATIONS - 1) as f64)
}

/// What a path means, or why a study cannot change it.
fn knob(path: &str, cuts: bool) -> Result<Knob, &'static str> {
    if !cuts && (path.starts_with("design.profile.") || path.starts_with("design.disc.") || path == "design.turn") {
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
        "design.disc.start_radius" => Knob::StartRadius,
        "design.profile.for_torque" => Knob::ForTorque,
        "design.profile.for_rate" => Knob::ForRate,
        "design.profile.for_rest_length" => Knob::ForRestLength,
        "design.profile.for_friction" => Knob::ForFriction,
        "design.profile.for_guide_friction" => Knob::ForGuideFriction,
        _ => match path.strip_prefix("design.springs.rates.").and_then(|n| n.parse::<usize>().ok()) {
            Some(place @ 1..) => Knob::Rate(place - 1),
            _ => return Err("it does not change the torque"),
        },
    })
}

impl FromFile {
    fn of(spec: &Spec, search: bool) -> Self {
        let or0 = |slot| si(slot).unwrap_or(0.0);
        let (adjust, profile) = (&spec.design.springs.adjust, &spec.design.profile);
        Self {
            turns: or0(&adjust.turns),
            pitch_m: or0(&adjust.pitch),
            for_rate: or0(&profile.for_rate),
            for_rest_m: or0(&profile.for_rest_length),
            way: compensated(spec, 1.0),
            rolling: si(&spec.design.rolling_friction).filter(|_| search),
        }
    }
}

impl Many {
    fn new(spec: &Spec, design: &Design, (free, purpose): (&[Free], Purpose), diagnostics: &mut Diagnostics) -> Option<Self> {
        let search = purpose == Purpose::Search;
        let before = diagnostics.errors();
        let mut knobs = Vec::new();
        for free in free {
            match knob(&free.number.path, search) {
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
        let mut measured = measure_scalars(design, &behaviour);
        outline(design, &behaviour, &mut measured);
        let limited = limited(design.requirements.as_ref());
        let (scalars, held) = (scalars(&measured, &OF_TORQUES, &limited, search), held(&OF_TORQUES, &limited, search));
        let torque = |name: &str, i: usize| Output { name: name.to_owned(), unit: "N*m", values: i * STATIONS..(i + 1) * STATIONS };
        let mut outputs = vec![torque("torque_up", 0), torque("torque_down", 1), torque("torque", 2)];
        outputs.extend(outputs_of(scalars.iter().copied().chain(held.iter().map(|i| OF_TORQUES[*i]))));
        let window_rad = behaviour.window_rad;
        let law = design.requirements.as_ref().and_then(|r| r.force.as_ref()).map(|(law, _)| law);
        let names = OF_TORQUES.iter().chain(&scalars);
        Some(Self {
            knobs,
            variables: variables.collect(),
            measures: measures(names, design.requirements.as_ref(), design.built.lengths_m, design.motion.is_some()),
            fixed: (!search).then_some((behaviour.mechanism.cut, measured)),
            window_rad,
            wanted: law.map(|law| turns(window_rad).map(|turn| law.force_n(turn)[0]).collect()),
            scalars,
            held,
            outputs,
            base: design.clone(),
            file: FromFile::of(spec, search),
            steps: Steps::new(STEP),
        })
    }

    /// Changes a copy of the design.
    fn apply(&self, x: &[f64], design: &mut Design) {
        let (built, purpose) = (&mut design.built, &mut design.purpose);
        let mut file = self.file;
        for (knob, x) in self.knobs.iter().zip(x) {
            match *knob {
                Knob::RollerDiameter => {
                    built.roller_m = 0.5 * x;
                    if self.fixed.is_none() {
                        design.cut_roller_m = 0.5 * x;
                    }
                }
                Knob::RollingArm => built.arm_m = *x,
                Knob::RollingFriction => file.rolling = Some(*x),
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
                Knob::Turns => file.turns = *x,
                Knob::Pitch => file.pitch_m = *x,
                Knob::SpringMass => built.springs.iter_mut().for_each(|s| s.mass_kg = *x),
                Knob::FollowerMass => built.bodies.follower_kg = *x,
                Knob::DiscInertia => built.bodies.disc_kg_m2 = *x,
                Knob::RollerMass => built.bodies.roller_kg = *x,
                Knob::RollerInertia => built.bodies.roller_kg_m2 = *x,
                Knob::StartRadius => purpose.start_radius_m = *x,
                Knob::ForTorque => purpose.law = ForceLaw::constant(*x),
                Knob::ForRate => file.for_rate = *x,
                Knob::ForRestLength => file.for_rest_m = *x,
                Knob::ForFriction => purpose.friction = file.way * x,
                Knob::ForGuideFriction => purpose.guide_friction = file.way * x,
            }
        }
        built.springs.iter_mut().for_each(|s| s.stretch_m = file.turns * file.pitch_m);
        if let Some(friction) = file.rolling {
            built.arm_m = friction * built.roller_m;
        }
        if self.knobs.iter().any(|k| matches!(k, Knob::ForRate | Knob::ForRestLength)) {
            let law = SpringLaw::Linear { rate_n_per_m: file.for_rate, rest_m: file.for_rest_m };
            purpose.springs = Bank::new(vec![Spring { law, stretch_m: 0.0, mass_kg: 0.0 }], built.extension);
        }
    }

    /// The disc of a design that is tried: cut anew in a search, where its rollers, outline and shaft must find room.
    fn disc(&self, design: &Design) -> Result<Arc<Cut>, String> {
        if let Some((cut, _)) = &self.fixed {
            return Ok(Arc::clone(cut));
        }
        let cut = Cut::new(design.purpose.clone()).map(Arc::new).map_err(|e| format!("the disc cannot be cut: {e:?}"))?;
        match misfit(design, &cut) {
            None => Ok(cut),
            Some(Misfit::Meet) => Err("the rollers run into each other".to_owned()),
            Some(Misfit::Open) => Err("the outline does not find back to the other lobe".to_owned()),
            Some(Misfit::Shaft { .. }) => Err("the hole for the shaft cuts through the outline".to_owned()),
        }
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
        let failure = |reason: String| Failure { reason };
        let room = workspace.get::<Room>().ok_or_else(|| failure("the room is another evaluator's".to_owned()))?;
        room.design.clone_from(&self.base);
        self.apply(x, &mut room.design);
        let cut = self.disc(&room.design).map_err(failure)?;
        let mut behaviour = Behaviour::sampled(room.design.mechanism(&cut), self.window_rad, 2 * PANELS, 2 * PANELS);
        behaviour.motion = room.design.motion.as_ref().and_then(|m| prescribed(&behaviour.mechanism, m).ok());
        if behaviour.stopped.is_some() || room.design.motion.is_some() != behaviour.motion.is_some() {
            return Err(failure("no roller stands on the disc, or friction locks it".to_owned()));
        }
        out.values.clear();
        let window = &behaviour.window;
        out.values.extend(window.iter().map(|s| s.up.torque_nm));
        out.values.extend(window.iter().map(|s| s.down.torque_nm));
        out.values.extend(window.iter().map(|s| s.still.torque_nm));
        let mut measured = measure_scalars(&room.design, &behaviour);
        match &self.fixed {
            Some((_, fixed)) => OF_OUTLINE.iter().for_each(|name| measured.set(name, fixed.get(name))),
            None => outline(&room.design, &behaviour, &mut measured),
        }
        out.values.extend(self.scalars.iter().map(|name| measured.get(name).unwrap_or(f64::NAN)));
        let of_torques = of_forces(&out.values, None, self.window_rad);
        out.values.extend(self.held.iter().map(|i| of_torques[*i]));
        out.jacobian.clear();
        if derivatives { self.differentiate(x, &vec![true; out.values.len()], out, workspace) } else { Ok(()) }
    }

    fn differentiate(&self, x: &[f64], rows: &[bool], out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        self.steps.jacobian(self, x, out, workspace)?;
        differences::keep(rows, self.variables.len(), &mut out.jacobian);
        Ok(())
    }

    fn measure(&self, _: &[f64], values: &[f64], out: &mut Vec<f64>, _: &mut Workspace) {
        out.clear();
        if values.len() != 3 * STATIONS + self.scalars.len() + self.held.len() {
            out.resize(self.measures.len(), f64::NAN);
            return;
        }
        out.extend(of_forces(values, self.wanted.as_deref(), self.window_rad));
        out.extend(&values[3 * STATIONS..3 * STATIONS + self.scalars.len()]);
    }
}
