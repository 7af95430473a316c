//! The family seen by studies.

use forcewright_contract::measuring::{Asked, Measuring};
use forcewright_contract::metrics::{Limit, Values};
use forcewright_contract::objective::{Goal, Way};
use forcewright_contract::studies::Free;

use crate::analysis::{Behaviour, measure};
use crate::checks::wanted_force_n;
use crate::design::{Design, Hand, Motor, Scatter, Source};
use crate::metrics::LavtMetrics;

/// Input torques of the curve that studies see: evenly, …
const STATIONS: usize = 81;
/// … and about the shift of the design of the file, from this part of the torque at which it begins to this multiple of that at which it ends.
const ABOUT_THE_SHIFT: [f64; 2] = [0.6, 1.5];
const STATIONS_ABOUT: usize = 120;
/// Nearer ones, over the largest, are one.
const SAME: f64 = 1e-6;
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
    Hand(OfHand),
    Motor(OfMotor),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OfHand {
    Reduction,
    Efficiency,
    ObjectStiffness,
    ObjectWidth,
    GloveStiffness,
    GloveFriction,
    Inertia,
    Force,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OfMotor {
    Reduction,
    Efficiency,
    Resistance,
    TorqueConstant,
    Inertia,
    NoLoadCurrent,
    CurrentLimit,
}

impl OfHand {
    fn set(self, si: f64, hand: &mut Hand) {
        match self {
            Self::Reduction => hand.reduction = si,
            Self::Efficiency => hand.efficiency = si,
            Self::ObjectStiffness => hand.object_n_per_m = Some(si),
            Self::ObjectWidth => hand.object_width_m = si,
            Self::GloveStiffness => hand.glove_n_per_m = si,
            Self::GloveFriction => hand.glove_friction_n = si,
            Self::Inertia => hand.inertia_kg_m2 = Some(si),
            Self::Force => hand.force_n = Some(si),
        }
    }
}

impl OfMotor {
    fn set(self, si: f64, motor: &mut Motor) {
        match self {
            Self::Reduction => motor.reduction = si,
            Self::Efficiency => motor.efficiency = si,
            Self::Resistance => motor.resistance_ohm = si,
            Self::TorqueConstant => motor.constant_nm_per_a = si,
            Self::Inertia => motor.inertia_kg_m2 = Some(si),
            Self::NoLoadCurrent => motor.no_load_a = si,
            Self::CurrentLimit => motor.limit_a = si,
        }
    }
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
        Goal { name: "output_torque_max_low", doc: "the same at the worst of friction and tolerances", way: Way::Large },
        Goal { name: "envelope_volume", doc: "volume of gears, clutch and chassis", way: Way::Small },
        Goal { name: "outer_diameter", doc: "outer diameter of the whole", way: Way::Small },
        Goal { name: "length", doc: "its length along the axis", way: Way::Small },
        Goal { name: "shift_margin_low", doc: "least torque of slip over that of the transition, over the tolerances", way: Way::Large },
        Goal { name: "input_torque_held_low", doc: "least input torque that is held, over the tolerances", way: Way::Large },
        Goal { name: "friction_min_bore", doc: "least friction that holds the required torque", way: Way::Small },
        Goal { name: "spring_stress_max", doc: "largest stress of the wire", way: Way::Small },
        Goal { name: "dead_turns_input", doc: "turns of the input before the shift", way: Way::Small },
        Goal { name: "plateau_width_input", doc: "blocked interval", way: Way::Small },
        Goal { name: "stall_power", doc: "power of the stalled motor at the required output torque", way: Way::Small },
        Goal { name: "closing_time", doc: "time from rest to the touch of the object", way: Way::Small },
        Goal { name: "grasp_time", doc: "time from rest to 95 % of the force", way: Way::Small },
        Goal { name: "grasp_force", doc: "force on the object in the end", way: Way::Large },
        Goal { name: "peak_current", doc: "largest current of the motor", way: Way::Small },
        Goal { name: "energy_per_grasp", doc: "electric energy of a grasp", way: Way::Small },
        Goal { name: "grasps_per_charge", doc: "grasps with a charge of the battery", way: Way::Large },
        Goal { name: "holding_power", doc: "power that keeps the grasp", way: Way::Small },
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
            "hand.reduction" => Knob::Hand(OfHand::Reduction),
            "hand.efficiency" => Knob::Hand(OfHand::Efficiency),
            "hand.object_stiffness" => Knob::Hand(OfHand::ObjectStiffness),
            "hand.object_width" => Knob::Hand(OfHand::ObjectWidth),
            "hand.glove_stiffness" => Knob::Hand(OfHand::GloveStiffness),
            "hand.glove_friction" => Knob::Hand(OfHand::GloveFriction),
            "hand.inertia" => Knob::Hand(OfHand::Inertia),
            "hand.force" => Knob::Hand(OfHand::Force),
            "motor.reduction" => Knob::Motor(OfMotor::Reduction),
            "motor.efficiency" => Knob::Motor(OfMotor::Efficiency),
            "motor.resistance" => Knob::Motor(OfMotor::Resistance),
            "motor.torque_constant" => Knob::Motor(OfMotor::TorqueConstant),
            "motor.inertia" => Knob::Motor(OfMotor::Inertia),
            "motor.no_load_current" => Knob::Motor(OfMotor::NoLoadCurrent),
            "motor.current_limit" => Knob::Motor(OfMotor::CurrentLimit),
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
            Knob::Hand(of) => design.hand.iter_mut().for_each(|hand| of.set(si, hand)),
            Knob::Motor(of) => design.motor.iter_mut().for_each(|motor| of.set(si, motor)),
        }
    }

    fn stations(base: &Design) -> Vec<f64> {
        let top_nm = base.requirements.as_ref().map_or(0.0, |r| r.input_nm);
        let even = |[from, to]: [f64; 2], n: usize| (0..n).map(move |i| from + (to - from) * i as f64 / (n - 1) as f64);
        let mut all: Vec<f64> = even([0.0, top_nm], STATIONS).collect();
        if let Ok(Behaviour { statics, .. }) = Behaviour::of(base) {
            let shift_nm = [statics.transition_input_nm(), statics.plateau_end_nm(statics.transition_output_nm())];
            let about = [0, 1].map(|i| (ABOUT_THE_SHIFT[i] * shift_nm[i]).min(top_nm));
            all.extend(even(about, STATIONS_ABOUT));
        }
        all.sort_by(f64::total_cmp);
        all.dedup_by(|next, kept| *next - *kept <= SAME * top_nm);
        all
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
        let late = |name| from.map(|nm| at_least(nm, name, "requirements.transition_torque.min"));
        let early = |name| to.map(|nm| at_most(nm, name, "requirements.transition_torque.max"));
        let output = |name| required.output_nm.map(|nm| at_least(nm, name, "requirements.output_torque.min"));
        let efficiency = |name| required.efficiency.map(|e| at_least(e, name, "requirements.efficiency.min"));
        let held = |name| Some(at_least(required.input_nm, name, "requirements.input_torque"));
        // What the checks ask for over friction and tolerances: not of the paper's model, which knows neither, nor where all is drawn.
        let always = design.source == Source::Corrected && design.scatters();
        let all = match name {
            "transition_torque_output" => vec![late("transition_torque_min"), early("transition_torque_max")],
            "transition_torque_output_low" if always => vec![late("transition_torque_min_always")],
            "transition_torque_output_high" if always => vec![early("transition_torque_max_always")],
            "output_torque_max" => vec![output("output_torque")],
            "output_torque_max_low" if always => vec![output("output_torque_always")],
            "speed_drop" => vec![required.speed_drop.map(|r| at_most(r, "speed_drop", "requirements.speed_drop.max"))],
            "efficiency_max" => vec![efficiency("efficiency")],
            "efficiency_max_low" if always => vec![efficiency("efficiency_always")],
            "shift_margin" => vec![Some(at_least(1.0, "shifts", "requirements.limits.shift_margin"))],
            "shift_margin_low" if always => vec![Some(at_least(1.0, "shifts_always", "requirements.limits.shift_margin_low"))],
            "input_torque_held" => vec![held("grips")],
            "input_torque_held_low" if always => vec![held("grips_always")],
            "spring_safety_factor" => vec![required.safety_factor.map(|s| at_least(s, "wire", "requirements.safety_factor"))],
            "motor_speed_max" => {
                vec![design.motor.as_ref().and_then(|m| m.max_rad_per_s).map(|most| at_most(most, "motor_speed", "motor.max_speed"))]
            }
            "grasp_force" => vec![wanted_force_n(design).map(|n| at_least(n, "grasp", "hand.force"))],
            _ => Vec::new(),
        };
        all.into_iter().flatten().collect()
    }

    fn limits(design: &Design) -> &[Limit] {
        design.requirements.as_ref().map_or(&[], |r| &r.limits)
    }
}

/// A design whose numbers a study draws: what is drawn scatters no more about what it is.
pub(crate) fn drawn(design: &Design, free: &[Free]) -> Design {
    let mut drawn = design.clone();
    let Scatter { wire_m, inner_m, hub_m, bore_m, hub_friction, bore_friction } = &mut drawn.scatter;
    for free in free {
        let of = match Transmissions::knob(&free.number.path) {
            Ok(Knob::WireDiameter) => &mut *wire_m,
            Ok(Knob::InnerDiameter) => &mut *inner_m,
            Ok(Knob::HubDiameter) => &mut *hub_m,
            Ok(Knob::BoreDiameter) => &mut *bore_m,
            Ok(Knob::HubFriction) => &mut *hub_friction,
            Ok(Knob::BoreFriction) => &mut *bore_friction,
            _ => continue,
        };
        *of = [0.0; 2];
    }
    drawn
}
