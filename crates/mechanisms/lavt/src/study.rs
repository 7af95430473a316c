//! The family seen by studies.

use forcewright_contract::measuring::{Asked, Measuring};
use forcewright_contract::metrics::Values;
use forcewright_contract::objective::{Goal, Way};

use crate::analysis::{Behaviour, measure};
use crate::design::Design;
use crate::metrics::LavtMetrics;

/// Input torques of the curve that studies see.
const STATIONS: usize = 81;
/// Friction that no pair of surfaces has: where no friction is enough.
const NO_FRICTION: f64 = 10.0;

/// Two-speed transmissions.
pub(crate) struct Transmissions;

/// What a number changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Knob {
    WireDiameter,
    InnerDiameter,
    HubTurns,
    FreeTurns,
    BoreTurns,
    HubDiameter,
    BoreDiameter,
    HubFriction,
    BoreFriction,
    YoungModulus,
    TensileStrength,
    Module,
    /// Of sun, planet, ring.
    Shift(usize),
    Shortening(usize),
    FaceWidth,
    Backlash,
    FlankFriction,
    /// Of mode I, mode II.
    Proportional(usize),
    Constant(usize),
    Reduction,
    ObjectStiffness,
}

impl Measuring for Transmissions {
    type Metrics = LavtMetrics;
    type Design = Design;
    type Knob = Knob;

    const CURVE: (&'static str, &'static str) = ("output_torque", "N*m");
    const PLURAL: &'static str = "two-speed transmissions";
    const OBJECTIVES: &'static [Goal] = &[
        Goal { name: "output_torque_max", doc: "torque at the output with the required input torque", way: Way::Large },
        Goal { name: "efficiency_max", doc: "efficiency with the required input torque", way: Way::Large },
        Goal { name: "envelope_volume", doc: "volume of gears and clutch", way: Way::Small },
        Goal { name: "shift_margin_low", doc: "least torque of slip over that of the transition, over the tolerances", way: Way::Large },
        Goal { name: "input_torque_held_low", doc: "least input torque that is held, over the tolerances", way: Way::Large },
        Goal { name: "friction_min_bore", doc: "least friction that holds the required torque", way: Way::Small },
        Goal { name: "spring_stress_max", doc: "largest stress of the wire", way: Way::Small },
        Goal { name: "dead_turns_input", doc: "turns of the input before the shift", way: Way::Small },
        Goal { name: "plateau_width_input", doc: "blocked interval", way: Way::Small },
    ];

    fn knob(path: &str) -> Result<Knob, &'static str> {
        Ok(match path {
            "design.spring.wire_diameter" => Knob::WireDiameter,
            "design.spring.inner_diameter" => Knob::InnerDiameter,
            "design.spring.hub_turns" => Knob::HubTurns,
            "design.spring.free_turns" => Knob::FreeTurns,
            "design.spring.bore_turns" => Knob::BoreTurns,
            "design.hub.diameter" => Knob::HubDiameter,
            "design.bore.diameter" => Knob::BoreDiameter,
            "design.friction.hub" => Knob::HubFriction,
            "design.friction.bore" => Knob::BoreFriction,
            "material.spring.young_modulus" => Knob::YoungModulus,
            "material.spring.tensile_strength" => Knob::TensileStrength,
            "design.gears.module" => Knob::Module,
            "design.gears.profile_shift.sun" => Knob::Shift(0),
            "design.gears.profile_shift.planet" => Knob::Shift(1),
            "design.gears.profile_shift.ring" => Knob::Shift(2),
            "design.gears.tip_shortening.sun" => Knob::Shortening(0),
            "design.gears.tip_shortening.planet" => Knob::Shortening(1),
            "design.gears.tip_shortening.ring" => Knob::Shortening(2),
            "design.gears.face_width" => Knob::FaceWidth,
            "design.gears.backlash" => Knob::Backlash,
            "design.gears.friction" => Knob::FlankFriction,
            "losses.mode_1.proportional" => Knob::Proportional(0),
            "losses.mode_2.proportional" => Knob::Proportional(1),
            "losses.mode_1.constant" => Knob::Constant(0),
            "losses.mode_2.constant" => Knob::Constant(1),
            "hand.reduction" => Knob::Reduction,
            "hand.object_stiffness" => Knob::ObjectStiffness,
            _ => return Err("it does not change what the transmission does"),
        })
    }

    fn set(design: &mut Design, knob: Knob, si: f64) {
        let built = &mut design.built;
        match knob {
            Knob::WireDiameter => built.spring.wire_m = si,
            Knob::InnerDiameter => built.spring.inner_m = si,
            Knob::HubTurns => built.spring.hub_turns = si,
            Knob::FreeTurns => built.spring.free_turns = si,
            Knob::BoreTurns => built.spring.bore_turns = si,
            Knob::HubDiameter => built.hub_m = si,
            Knob::BoreDiameter => built.bore_m = si,
            Knob::HubFriction => built.friction[0] = si,
            Knob::BoreFriction => built.friction[1] = si,
            Knob::YoungModulus => built.spring.young_pa = si,
            Knob::TensileStrength => design.wire.tensile_pa = Some(si),
            Knob::Module => built.gears.module_m = si,
            Knob::Shift(i) => built.gears.shift[i] = si,
            Knob::Shortening(i) => built.gears.shortening[i] = si,
            Knob::FaceWidth => built.gears.face_m = si,
            Knob::Backlash => built.gears.backlash_m = si,
            Knob::FlankFriction => built.gears.friction = Some(si),
            Knob::Proportional(mode) => built.losses[mode].proportional = Some(si),
            Knob::Constant(mode) => built.losses[mode].constant_nm = si,
            Knob::Reduction | Knob::ObjectStiffness => {
                if let Some(hand) = &mut design.hand {
                    match knob {
                        Knob::Reduction => hand.reduction = si,
                        _ => hand.object_n_per_m = Some(si),
                    }
                }
            }
        }
    }

    fn stations(base: &Design) -> Vec<f64> {
        let top_nm = base.requirements.as_ref().map_or(0.0, |r| r.input_nm);
        (0..STATIONS).map(|i| top_nm * i as f64 / (STATIONS - 1) as f64).collect()
    }

    fn evaluated(design: &Design, stations: &[f64], curve: &mut Vec<f64>) -> Result<Values<LavtMetrics>, String> {
        let behaviour = Behaviour::of(design).map_err(|e| e.to_string())?;
        curve.extend(stations.iter().map(|input_nm| behaviour.statics.output(*input_nm).1));
        Ok(measure(design, &behaviour))
    }

    fn instead(name: &str) -> Option<f64> {
        match name {
            "efficiency_max" | "bore_grip_torque" | "bore_grip_torque_low" => Some(0.0),
            "friction_min_hub" | "friction_min_bore" => Some(NO_FRICTION),
            _ => None,
        }
    }

    fn asked(design: &Design, name: &str) -> Vec<Asked> {
        let Some(required) = &design.requirements else { return Vec::new() };
        let (free, most) = (f64::NEG_INFINITY, f64::INFINITY);
        let at_least = |lower, requirement, key| Asked { lower, upper: most, requirement, key };
        let at_most = |upper, requirement, key| Asked { lower: free, upper, requirement, key };
        let [from, to] = required.transition_nm;
        let all = match name {
            "transition_torque_output" => vec![
                from.map(|nm| at_least(nm, "transition_torque", "requirements.transition_torque.min")),
                to.map(|nm| at_most(nm, "transition_torque", "requirements.transition_torque.max")),
            ],
            "output_torque_max" => vec![required.output_nm.map(|nm| at_least(nm, "output_torque", "requirements.output_torque.min"))],
            "speed_drop" => vec![required.speed_drop.map(|r| at_most(r, "speed_drop", "requirements.speed_drop.max"))],
            "efficiency_max" => vec![required.efficiency.map(|e| at_least(e, "efficiency", "requirements.efficiency.min"))],
            "shift_margin" => vec![Some(at_least(1.0, "shifts", "requirements.limits.shift_margin"))],
            "shift_margin_low" => vec![Some(at_least(1.0, "shifts_always", "requirements.limits.shift_margin_low"))],
            "input_torque_held" => vec![Some(at_least(required.input_nm, "grips", "requirements.input_torque"))],
            "input_torque_held_low" => vec![Some(at_least(required.input_nm, "grips_always", "requirements.input_torque"))],
            "spring_safety_factor" => vec![required.safety_factor.map(|s| at_least(s, "wire", "requirements.safety_factor"))],
            _ => Vec::new(),
        };
        all.into_iter().flatten().collect()
    }

    fn limited(design: &Design, name: &str) -> Vec<[Option<f64>; 2]> {
        let limits = design.requirements.iter().flat_map(|r| &r.limits);
        limits.filter(|l| l.name::<LavtMetrics>() == name).map(|l| [l.min, l.max]).collect()
    }
}
