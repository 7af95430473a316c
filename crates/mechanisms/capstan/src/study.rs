//! The family seen by studies: metrics at any values of the numbers that vary.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_contract::objective::{Goal, Way, goal_of};
use forcewright_contract::studies::Free;
use forcewright_elements::grooves::Groove;
use forcewright_study::evaluator::{Evaluation, Evaluator, Failure, Measure, Output, Variable, Workspace};
use forcewright_study::task::{self, Limit, Step, Task};

use crate::analysis::{Behaviour, Measured, measure};
use crate::design::{Built, Design};
use crate::metrics::{CapstanMetrics, METRICS};
use crate::spec::Spec;

/// Torques of the curve that studies see.
const STATIONS: usize = 41;
/// Step of a difference, over the value.
const STEP: f64 = 1e-6;

/// What can be optimised.
const OBJECTIVES: &[Goal] = &[
    Goal { name: "stiffness_tangent_output", doc: "stiffness at the output under the required torque", way: Way::Large },
    Goal { name: "lost_motion_output", doc: "lost motion at zero torque", way: Way::Small },
    Goal { name: "backdrive_torque_output", doc: "torque that turns the output with the input free", way: Way::Small },
    Goal { name: "efficiency_forward", doc: "efficiency from input to output", way: Way::Large },
    Goal { name: "shaft_load", doc: "largest load of a shaft", way: Way::Small },
    Goal { name: "input_drum_length", doc: "length of the input drum", way: Way::Small },
    Goal { name: "output_drum_length", doc: "length of the output drum", way: Way::Small },
    Goal { name: "fleet_angle", doc: "fleet angle of the return span", way: Way::Small },
    Goal { name: "cable_safety_factor", doc: "breaking force over the largest tension", way: Way::Large },
];

/// What a number changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Knob {
    InputDiameter,
    OutputDiameter,
    CentreDistance,
    Travel,
    Pitch,
    SeatAngle,
    VeeAngle,
    Undercut,
    SeatRadius,
    Depth,
    GroovePhase,
    AnchorWrap,
    Friction,
    Expansion,
    Warmer,
    BearingFriction,
    Bore(usize),
    Drag(usize),
    Inertia(usize),
    /// Of a cable, by its index.
    Cable(usize, OfCable),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OfCable {
    AxialStiffness,
    BreakingForce,
    Expansion,
    BendingLoss,
    Preload,
    PreloadLoss,
}

/// What a path means, or why a study cannot change it.
fn knob(path: &str) -> Result<Knob, &'static str> {
    Ok(match path {
        "design.input_diameter" => Knob::InputDiameter,
        "design.output_diameter" => Knob::OutputDiameter,
        "design.centre_distance" => Knob::CentreDistance,
        "design.travel" => Knob::Travel,
        "design.groove.pitch" => Knob::Pitch,
        "design.groove.seat_angle" => Knob::SeatAngle,
        "design.groove.angle" => Knob::VeeAngle,
        "design.groove.undercut" => Knob::Undercut,
        "design.groove.radius" => Knob::SeatRadius,
        "design.groove.depth" => Knob::Depth,
        "design.groove_phase" => Knob::GroovePhase,
        "design.output_anchor_wrap" => Knob::AnchorWrap,
        "design.friction" => Knob::Friction,
        "design.expansion" => Knob::Expansion,
        "environment.temperature_change" => Knob::Warmer,
        "design.bearings.friction" => Knob::BearingFriction,
        "design.bearings.input_bore" => Knob::Bore(0),
        "design.bearings.output_bore" => Knob::Bore(1),
        "design.bearings.input_drag" => Knob::Drag(0),
        "design.bearings.output_drag" => Knob::Drag(1),
        "inertia.input" => Knob::Inertia(0),
        "inertia.output" => Knob::Inertia(1),
        _ => {
            let Some(rest) = path.strip_prefix("design.cables.") else { return Err("it does not change what the drive does") };
            let (index, key) = match rest.split_once('.') {
                Some((number, key)) => (number.parse::<usize>().ok().and_then(|n| n.checked_sub(1)).ok_or("there is no such cable")?, key),
                None => (0, rest),
            };
            let of = match key {
                "axial_stiffness" => OfCable::AxialStiffness,
                "breaking_force" => OfCable::BreakingForce,
                "expansion" => OfCable::Expansion,
                "bending_loss" => OfCable::BendingLoss,
                "preload" => OfCable::Preload,
                "preload_loss" => OfCable::PreloadLoss,
                "diameter" => return Err("grooves are cut for one diameter of cable"),
                _ => return Err("it does not change what the drive does"),
            };
            Knob::Cable(index, of)
        }
    })
}

impl Knob {
    /// Sets the number; `added_m` is what diameters of drums lack to the middle of the cable.
    fn set(self, x: f64, added_m: f64, built: &mut Built) {
        match self {
            Self::InputDiameter => built.radii_m[0] = 0.5 * (x + added_m),
            Self::OutputDiameter => built.radii_m[1] = 0.5 * (x + added_m),
            Self::CentreDistance => built.distance_m = x,
            Self::Travel => built.travel_rad = x,
            Self::Pitch => built.pitch_m = x,
            Self::SeatAngle => match &mut built.seat.groove {
                Groove::Round { half_angle_rad, .. } => *half_angle_rad = 0.5 * x,
                Groove::Undercut { opening_rad, .. } => *opening_rad = std::f64::consts::PI - x,
                _ => {}
            },
            Self::VeeAngle => {
                if let Groove::Vee { half_angle_rad } = &mut built.seat.groove {
                    *half_angle_rad = 0.5 * x;
                }
            }
            Self::Undercut => {
                if let Groove::Undercut { undercut_rad, .. } = &mut built.seat.groove {
                    *undercut_rad = x;
                }
            }
            Self::SeatRadius => built.seat.radius_m = Some(x),
            Self::Depth => built.seat.depth_m = Some(x),
            Self::GroovePhase => built.phase_rad = x,
            Self::AnchorWrap => built.guard_rad = x,
            Self::Friction => built.friction = x,
            Self::Expansion => built.expansion_per_k = Some(x),
            Self::Warmer => built.warmer_k = x,
            Self::BearingFriction => built.bearings.friction = Some(x),
            Self::Bore(shaft) => built.bearings.bores_m[shaft] = Some(x),
            Self::Drag(shaft) => built.bearings.drags_nm[shaft] = x,
            Self::Inertia(shaft) => built.inertia_kg_m2[shaft] = Some(x),
            Self::Cable(index, of) => {
                let Some(cable) = built.cables.get_mut(index) else { return };
                match of {
                    OfCable::AxialStiffness => cable.axial_stiffness_n = x,
                    OfCable::BreakingForce => cable.breaking_n = Some(x),
                    OfCable::Expansion => cable.expansion_per_k = Some(x),
                    OfCable::BendingLoss => cable.bending_loss = Some(x),
                    OfCable::Preload => cable.preload_n = x,
                    OfCable::PreloadLoss => cable.preload_loss = x,
                }
            }
        }
        built.groove_factor = built.seat.friction_factor();
    }
}

/// See the module.
struct Many {
    knobs: Vec<Knob>,
    variables: Vec<Variable>,
    base: Design,
    added_m: f64,
    /// Metrics that the design has, by their index.
    metrics: Vec<usize>,
    outputs: Vec<Output>,
    measures: Vec<Measure>,
}

impl Many {
    fn new(spec: &Spec, design: &Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Self> {
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
        let nominal = measure(design, &behaviour);
        let metrics: Vec<usize> = (0..METRICS.len()).filter(|i| nominal.value(*i).is_some()).collect();
        let mut outputs = vec![Output { name: "stiffness".to_owned(), unit: "N*m/rad", values: 0..STATIONS }];
        outputs.extend(metrics.iter().enumerate().map(|(place, index)| Output {
            name: METRICS[*index].name.to_owned(),
            unit: METRICS[*index].dimension.si_symbol(),
            values: STATIONS + place..STATIONS + place + 1,
        }));
        let variables = free.iter().map(|free| Variable {
            path: free.number.path.clone(),
            unit: free.number.dimension.si_symbol(),
            nominal: free.number.si,
            lower: free.lower,
            upper: free.upper,
        });
        let drums = spec.design.diameters.as_ref().is_none_or(|d| d.value == "drum");
        Some(Self {
            knobs,
            variables: variables.collect(),
            base: design.clone(),
            added_m: if drums { design.built.cable_m() } else { 0.0 },
            measures: metrics.iter().map(|index| measure_of(design, *index)).collect(),
            metrics,
            outputs,
        })
    }

    fn at(&self, x: &[f64]) -> Design {
        let mut design = self.base.clone();
        for (knob, x) in self.knobs.iter().zip(x) {
            knob.set(*x, self.added_m, &mut design.built);
        }
        design
    }

    /// Torques of the curve, N·m.
    fn torques_nm(&self) -> impl Iterator<Item = f64> {
        let top = self.base.requirements.as_ref().map_or(0.0, |r| r.torque_nm);
        (0..STATIONS).map(move |i| top * i as f64 / (STATIONS - 1) as f64)
    }

    fn place(&self, name: &str) -> Option<usize> {
        self.metrics.iter().position(|i| METRICS[*i].name == name).map(|place| STATIONS + place)
    }
}

/// A metric with what the requirements ask of it.
fn measure_of(design: &Design, index: usize) -> Measure {
    let info = &METRICS[index];
    let (mut lower, mut upper, mut requirement) = (f64::NEG_INFINITY, f64::INFINITY, "");
    if let Some(requirements) = &design.requirements {
        let asked = match info.name {
            "stiffness_tangent_output" => requirements.stiffness_nm_per_rad.map(|k| (k, upper, "stiffness")),
            "lost_motion_output" => requirements.lost_motion_rad.map(|rad| (lower, rad, "lost_motion")),
            "gross_slip_torque_output" => Some((requirements.torque_nm, upper, "torque")),
            "cable_safety_factor" => requirements.safety_factor.map(|s| (s, upper, "strength")),
            _ => None,
        };
        if let Some(asked) = asked {
            (lower, upper, requirement) = asked;
        }
        for limit in requirements.limits.iter().filter(|l| l.name::<CapstanMetrics>() == info.name) {
            lower = lower.max(limit.min.unwrap_or(lower));
            upper = upper.min(limit.max.unwrap_or(upper));
            requirement = info.name;
        }
    }
    Measure { name: info.name.to_owned(), requirement: requirement.to_owned(), unit: info.dimension.si_symbol(), lower, upper }
}

impl Evaluator for Many {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn stations(&self, output: usize) -> Vec<f64> {
        if output == 0 { self.torques_nm().collect() } else { Vec::new() }
    }

    fn measures(&self) -> &[Measure] {
        &self.measures
    }

    fn workspace(&self) -> Workspace {
        Workspace::new(())
    }

    fn evaluate(&self, x: &[f64], derivatives: bool, out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        let design = self.at(x);
        let behaviour = Behaviour::of(&design).map_err(|e| Failure { reason: e.to_string() })?;
        if let Some(Err(error)) = &behaviour.required {
            return Err(Failure { reason: error.to_string() });
        }
        let measured: Measured = measure(&design, &behaviour);
        out.values.clear();
        let statics = &behaviour.statics;
        for torque_nm in self.torques_nm() {
            let loaded = statics.under(torque_nm).map_err(|e| Failure { reason: e.to_string() })?;
            out.values.push(statics.torsional(loaded.tangent_n_per_m, 1));
        }
        for index in &self.metrics {
            let value = measured.value(*index);
            out.values.push(value.ok_or_else(|| Failure { reason: format!("{} has no value", METRICS[*index].name) })?);
        }
        out.jacobian.clear();
        if derivatives {
            let steps: Vec<f64> = self.variables.iter().map(|v| STEP * v.nominal.abs().max(1e-3 * v.scale().min(1.0))).collect();
            forcewright_study::differences::jacobian_with_steps(self, x, &steps, out, workspace)?;
        }
        Ok(())
    }

    fn measure(&self, _: &[f64], values: &[f64], out: &mut Vec<f64>, _: &mut Workspace) {
        out.clear();
        match values.get(STATIONS..) {
            Some(metrics) if metrics.len() == self.metrics.len() => out.extend(metrics),
            _ => out.resize(self.measures.len(), f64::NAN),
        }
    }
}

/// The drive as studies that look at many see it; what cannot vary is reported.
pub(crate) fn evaluator(spec: &Spec, design: &Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Box<dyn Evaluator>> {
    Some(Box::new(Many::new(spec, design, free, diagnostics)?))
}

/// The search that `[optimise]` asks for.
pub(crate) fn task(spec: &Spec, design: &Design, free: &[Free], diagnostics: &mut Diagnostics) -> Option<Task> {
    let objective = &spec.studies.optimise.objective;
    let (name, large) = goal_of(objective, OBJECTIVES, diagnostics)?;
    for (span, what) in [(objective.window.as_ref().map(|w| w.span), "window"), (objective.target.as_ref().map(|t| t.span), "target")] {
        if let Some(span) = span {
            let error = Diagnostic::error("E0305", span, format!("the objectives of cable drives have no `{what}`")).label("not needed");
            diagnostics.push(error.help("remove it"));
            return None;
        }
    }
    let many = Many::new(spec, design, free, diagnostics)?;
    let Some(place) = many.place(name) else {
        let at = objective.minimise.as_ref().or(objective.maximise.as_ref()).map(|m| m.span).unwrap_or_default();
        let error = Diagnostic::error("E0302", at, format!("`{name}` has no value for this design")).label("this objective");
        diagnostics.push(error.help("`solve` says what is missing for it"));
        return None;
    };
    let nominal = measure(design, &Behaviour::of(design).ok()?);
    let scale = |name: &str| nominal.get(name).map_or(1.0, f64::abs).max(1e-9);
    let limits = many.measures.iter().filter(|m| !m.requirement.is_empty() && m.name != name).filter_map(|m| {
        let at = many.place(&m.name)?;
        let key = match m.requirement.as_str() {
            "stiffness" => "requirements.stiffness.min".to_owned(),
            "lost_motion" => "requirements.lost_motion.max".to_owned(),
            "torque" => "requirements.torque".to_owned(),
            "strength" => "requirements.safety_factor".to_owned(),
            name => format!("requirements.limits.{name}"),
        };
        let checks = METRICS.iter().filter(|i| i.name == m.name).map(|i| i.name).collect();
        let (values, unit, scale) = (at..at + 1, m.unit, scale(&m.name));
        Some(Limit { name: m.requirement.clone(), key, checks, values, lower: m.lower, upper: m.upper, scale, unit, in_band: false })
    });
    let limits = limits.collect();
    let sign = if large { -1.0 } else { 1.0 };
    let goal = task::Goal::Values(vec![(place, sign / scale(name))]);
    let title = format!("`{name}` as {} as possible", if large { "large" } else { "small" });
    Some(Task { evaluator: Box::new(many), title, steps: vec![Step { goal, bands: Vec::new(), held: Vec::new() }], limits })
}
