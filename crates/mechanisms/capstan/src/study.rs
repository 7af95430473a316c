//! The family seen by studies: metrics at any values of the numbers that vary.

use forcewright_contract::measuring::{Asked, Measuring};
use forcewright_contract::metrics::{Limit, Values};
use forcewright_contract::objective::{Goal, Way};
use forcewright_elements::grooves::Groove;

use crate::analysis::{Behaviour, measure};
use crate::design::{Built, Design};
use crate::metrics::CapstanMetrics;

/// Torques of the curve that studies see.
const STATIONS: usize = 41;

/// What a number changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Knob {
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
pub(crate) enum OfCable {
    AxialStiffness,
    BreakingForce,
    Expansion,
    BendingLoss,
    Preload,
    PreloadLoss,
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

/// Cable drives.
pub(crate) struct CableDrives;

impl Measuring for CableDrives {
    type Metrics = CapstanMetrics;
    type Design = Design;
    type Knob = Knob;

    const CURVE: (&'static str, &'static str) = ("stiffness", "N*m/rad");
    const PLURAL: &'static str = "cable drives";
    const OBJECTIVES: &'static [Goal] = &[
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
                    Some((number, key)) => {
                        (number.parse::<usize>().ok().and_then(|n| n.checked_sub(1)).ok_or("there is no such cable")?, key)
                    }
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

    fn set(design: &mut Design, knob: Knob, si: f64) {
        knob.set(si, design.added_m, &mut design.built);
    }

    fn stations(base: &Design) -> Vec<f64> {
        let top_nm = base.requirements.as_ref().map_or(0.0, |r| r.torque_nm);
        (0..STATIONS).map(|i| top_nm * i as f64 / (STATIONS - 1) as f64).collect()
    }

    fn evaluated(design: &Design, stations: &[f64], curve: &mut Vec<f64>) -> Result<Values<CapstanMetrics>, String> {
        let behaviour = Behaviour::of(design).map_err(|e| e.to_string())?;
        if let Some(Err(error)) = &behaviour.required {
            return Err(error.to_string());
        }
        let statics = &behaviour.statics;
        for torque_nm in stations {
            let loaded = statics.under(*torque_nm).map_err(|e| e.to_string())?;
            curve.push(statics.torsional(loaded.tangent_n_per_m, 1));
        }
        Ok(measure(design, &behaviour))
    }

    fn asked(design: &Design, name: &str) -> Vec<Asked> {
        let Some(required) = &design.requirements else { return Vec::new() };
        let at_least = |lower, requirement, key| Asked { lower, upper: f64::INFINITY, requirement, key };
        let asked = match name {
            "stiffness_tangent_output" => required.stiffness_nm_per_rad.map(|k| at_least(k, "stiffness", "requirements.stiffness.min")),
            "lost_motion_output" => required.lost_motion_rad.map(|upper| Asked {
                lower: f64::NEG_INFINITY,
                upper,
                requirement: "lost_motion",
                key: "requirements.lost_motion.max",
            }),
            "gross_slip_torque_output" => Some(at_least(required.torque_nm, "torque", "requirements.torque")),
            "cable_safety_factor" => required.safety_factor.map(|s| at_least(s, "strength", "requirements.safety_factor")),
            _ => None,
        };
        asked.into_iter().collect()
    }

    fn limits(design: &Design) -> &[Limit] {
        design.requirements.as_ref().map_or(&[], |r| &r.limits)
    }
}
