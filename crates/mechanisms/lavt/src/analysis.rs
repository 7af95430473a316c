//! What a transmission does, and the metrics that follow.

use std::fmt;

use forcewright_elements::wrap_spring::{WrapSpring, WrapSpringError};

use crate::bench;
use crate::closing::{self, Ending, Grasp};
use crate::design::{Built, Design, Hand, Motor, Scatter};
use crate::gears::{self, Train};
use crate::metrics::Measured;
use crate::statics::{Statics, clutch};

/// Part of its tensile strength that a wire endures in bending at rest: EN 13906-3.
pub(crate) const PERMISSIBLE: f64 = 0.7;

/// A difference of gaps below this is rounding, m.
const ROUNDING_M: f64 = 1e-13;

/// Why nothing could be computed.
#[derive(Clone, Debug, PartialEq)]
pub enum NoTransmission {
    /// Of the spring.
    Spring(WrapSpringError),
    /// Of the gears.
    Gears(String),
}

impl fmt::Display for NoTransmission {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Spring(error) => write!(f, "the spring cannot be computed: {error}"),
            Self::Gears(why) => write!(f, "the gears cannot be computed: {why}"),
        }
    }
}

impl std::error::Error for NoTransmission {}

/// What a transmission does.
#[derive(Clone, Debug)]
pub struct Behaviour {
    /// The spring between hub and bore.
    pub clutch: WrapSpring,
    /// Torques as designed.
    pub statics: Statics,
    /// Torques at the corner of the tolerances that grips worst, with the least friction.
    pub worst: Statics,
    /// Torques as designed with the least and the largest friction.
    pub slippery: [Statics; 2],
    /// What requirements see over the range of friction and the corners of the tolerances.
    pub over: Over,
    /// The gears.
    pub train: Train,
    /// The hand that closes; `None` where motor, hand, an inertia or the opening are not given.
    pub grasp: Option<Grasp>,
}

/// Corners of the tolerances of wire, spring, hub and bore.
fn corners(design: &Design) -> impl Iterator<Item = Built> + '_ {
    corners_of(&design.built, &design.scatter)
}

/// The same of a transmission and what of it scatters.
pub(crate) fn corners_of(designed: &Built, scatter: &Scatter) -> impl Iterator<Item = Built> {
    (0..16_usize).map(move |i| {
        let end = |bit: usize, deviations: [f64; 2]| deviations[(i >> bit) & 1];
        let mut built = *designed;
        built.spring.wire_m += end(0, scatter.wire_m);
        built.spring.inner_m += end(1, scatter.inner_m);
        built.hub_m += end(2, scatter.hub_m);
        built.bore_m += end(3, scatter.bore_m);
        built
    })
}

impl Behaviour {
    /// Analyses a design.
    ///
    /// # Errors
    /// [`NoTransmission`] where its numbers make none.
    pub fn of(design: &Design) -> Result<Self, NoTransmission> {
        let built = &design.built;
        let train = Train::of(design).map_err(NoTransmission::Gears)?;
        let loss = train.mesh_loss();
        let clutch = clutch(built, design.source).map_err(NoTransmission::Spring)?;
        let with = |friction| Statics::new(built, &clutch, friction, loss).map_err(NoTransmission::Spring);
        let statics = with(built.friction)?;
        let [least, largest] = design.frictions();
        let slippery = [with(least)?, with(largest)?];
        let (worst, over) = at_corners(design, loss, &statics).map_err(NoTransmission::Spring)?;
        let grasp = closing::grasp(design, &statics, &clutch);
        Ok(Self { clutch, statics, worst, slippery, over, train, grasp })
    }
}

/// Ends of what requirements see over the range of friction and the corners of the tolerances of wire, spring, hub and bore.
///
/// The ends of the friction are enough: the transition rises with it, and the output torque rises as long as the clutch slips and falls
/// from there on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Over {
    /// Least and largest torque at the output at which mode I ends, N·m.
    pub transition_output_nm: [f64; 2],
    /// Least torque at the output with the required torque at the input, N·m; `None` where none is required.
    pub output_nm: Option<f64>,
    /// Least efficiency with it; 0 where at one of them it is blocked, or the clutch slips.
    pub efficiency: Option<f64>,
}

impl Over {
    fn of(statics: &Statics, input_nm: Option<f64>) -> Self {
        Self {
            transition_output_nm: [statics.transition_output_nm(); 2],
            output_nm: input_nm.map(|nm| statics.output(nm).1),
            efficiency: input_nm.map(|nm| statics.efficiency(nm).unwrap_or(0.0)),
        }
    }

    fn and(self, other: Self) -> Self {
        let least = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| a.min(b));
        let ([low, high], [other_low, other_high]) = (self.transition_output_nm, other.transition_output_nm);
        Self {
            transition_output_nm: [low.min(other_low), high.max(other_high)],
            output_nm: least(self.output_nm, other.output_nm),
            efficiency: least(self.efficiency, other.efficiency),
        }
    }
}

/// The corner that holds the least torque at the input, with the least friction, and what requirements see at all of them. A corner in
/// which the spring is loose on the hub, or in the bore from the beginning, holds nothing.
fn at_corners(design: &Design, loss: f64, nominal: &Statics) -> Result<(Statics, Over), WrapSpringError> {
    let [least, largest] = design.frictions();
    let input_nm = design.requirements.as_ref().map(|r| r.input_nm);
    let nothing = Statics { hub_nm: 0.0, grip_nm: None, lock_nm: 0.0, ..*nominal };
    // Where the bore is not reached, the ratio of the torques says how far it is from it.
    let rank = |s: &Statics| (s.grip_nm.is_some(), if s.grip_nm.is_some() { s.held_input_nm() } else { s.hub_nm / s.transition_nm });
    let mut found: Option<(Statics, Over)> = None;
    // Where nothing scatters all corners are the drawing.
    for built in corners(design).take(if design.scatters() { usize::MAX } else { 1 }) {
        let spring = clutch(&built, design.source).ok().filter(|_| built.gaps_m().iter().all(|gap_m| *gap_m > 0.0));
        let [weak, strong] = match &spring {
            Some(spring) => [Statics::new(&built, spring, least, loss)?, Statics::new(&built, spring, largest, loss)?],
            None => [nothing; 2],
        };
        let over = Over::of(&weak, input_nm).and(Over::of(&strong, input_nm));
        found = Some(match found {
            None => (weak, over),
            Some((worst, all)) => {
                let ((one, x), (other, y)) = (rank(&weak), rank(&worst));
                let is_worse = one.cmp(&other).then(x.total_cmp(&y)).is_lt();
                (if is_worse { weak } else { worst }, all.and(over))
            }
        });
    }
    Ok(found.unwrap_or_else(|| (*nominal, Over::of(nominal, input_nm))))
}

/// Every metric that the behaviour has.
pub fn measure(design: &Design, behaviour: &Behaviour) -> Measured {
    let mut m = Measured::none();
    measure_characteristic(&mut m, design, behaviour);
    measure_clutch(&mut m, design, behaviour);
    measure_spring(&mut m, design, behaviour);
    gears::measure(&mut m, design, &behaviour.train);
    measure_hand(&mut m, design, behaviour);
    bench::measure(&mut m, design);
    measure_closing(&mut m, design, behaviour);
    m
}

fn measure_characteristic(m: &mut Measured, design: &Design, behaviour: &Behaviour) {
    let statics = &behaviour.statics;
    m.set("ratio", statics.ratio);
    m.set("speed_drop", 1.0 / statics.ratio);
    let (input_nm, output_nm) = (statics.transition_input_nm(), statics.transition_output_nm());
    let shifts = statics.grip_nm.is_some();
    m.set("transition_torque_input", input_nm);
    m.set("transition_torque_output", output_nm);
    let Over { transition_output_nm: [low_nm, high_nm], .. } = behaviour.over;
    m.set("transition_torque_output_low", low_nm);
    m.set("transition_torque_output_high", high_nm);
    let end_nm = statics.plateau_end_nm(output_nm).max(input_nm);
    m.set("plateau_end_input", shifts.then_some(end_nm));
    m.set("plateau_width_input", shifts.then_some(end_nm - input_nm));
    m.set("downshift_torque_output", statics.downshift_nm());
    m.set("shift_hysteresis_output", statics.downshift_nm().map(|down_nm| output_nm - down_nm));
    m.set("efficiency_mode_1", statics.efficiency(input_nm));
    let Some(required) = &design.requirements else { return };
    let most_nm = statics.output(required.input_nm).1;
    m.set("output_torque_max", most_nm);
    m.set("output_torque_max_low", behaviour.over.output_nm);
    m.set("efficiency_max", statics.efficiency(required.input_nm));
    m.set("efficiency_max_low", behaviour.over.efficiency);
    m.set("force_gain", most_nm / required.input_nm);
    m.set("energy_gain", most_nm * most_nm / (required.input_nm * required.input_nm));
}

fn measure_clutch(m: &mut Measured, design: &Design, behaviour: &Behaviour) {
    let Behaviour { clutch, statics, worst, slippery, .. } = behaviour;
    m.set("spring_transition_torque", statics.transition_nm);
    m.set("hub_torque", statics.hub_nm);
    m.set("hub_torque_low", slippery[0].hub_nm);
    m.set("hub_torque_high", slippery[1].hub_nm);
    m.set("bore_grip_torque", statics.grip_nm);
    m.set("bore_grip_torque_low", worst.grip_nm);
    m.set("shift_margin", statics.hub_nm / statics.transition_nm);
    m.set("shift_margin_low", worst.hub_nm / worst.transition_nm);
    m.set("input_torque_held", statics.held_input_nm());
    m.set("input_torque_held_low", worst.held_input_nm());
    m.set("input_torque_opening", statics.opening_input_nm());
    m.set("friction_min_hub", clutch.least_friction_to_reach());
    let [hub_m, bore_m] = design.built.gaps_m();
    m.set("hub_interference", hub_m);
    m.set("bore_gap", bore_m);
    // Equal gaps are typed as diameters: what rounding leaves of their difference is none.
    let difference_m = hub_m - bore_m;
    m.set("gap_difference", if difference_m.abs() > ROUNDING_M { difference_m } else { 0.0 });
    let differences = corners(design).map(|b| b.gaps_m()).map(|[a, b]| a - b);
    m.set("gap_difference_low", differences.fold(f64::INFINITY, f64::min));
    let Some(required) = &design.requirements else { return };
    let most_nm = statics.leverage() * required.input_nm;
    m.set("clutch_torque_max", most_nm);
    m.set("friction_min_bore", clutch.least_friction_to_grip(most_nm).ok().flatten());
}

fn measure_spring(m: &mut Measured, design: &Design, behaviour: &Behaviour) {
    let clutch = &behaviour.clutch;
    let stresses = clutch.stresses();
    m.set("spring_stress_hub", stresses.hub_pa);
    m.set("spring_stress_bore", stresses.bore_pa);
    let mut largest_pa = stresses.hub_pa.max(stresses.bore_pa);
    if let Some(required) = &design.requirements {
        let torque_nm = (behaviour.statics.leverage() * required.input_nm).min(behaviour.statics.grip_nm.unwrap_or(f64::INFINITY));
        let alone_pa = clutch.unsupported_pa(torque_nm).ok();
        m.set("spring_stress_unsupported", alone_pa);
        if design.built.spring.unsupported_turns > 0.0 {
            largest_pa = largest_pa.max(alone_pa.unwrap_or(0.0));
        }
    }
    m.set("spring_stress_max", largest_pa);
    m.set("spring_safety_factor", design.wire.tensile_pa.map(|strength_pa| PERMISSIBLE * strength_pa / largest_pa));
    let dead = clutch.dead_turns();
    m.set("dead_turns_spring", dead);
    m.set("dead_turns_input", dead * behaviour.statics.leverage());
    m.set("wear_work_per_turn", clutch.slip_work_per_turn_j(design.built.friction[0]).ok());
}

/// Force at the finger by a torque at the output, N, with the lever of the closed hand around the object.
pub(crate) fn finger_force_n(hand: &Hand, output_nm: f64) -> f64 {
    output_nm * hand.reduction * hand.efficiency / hand.lever.at_m(hand.object_width_m)
}

/// Current of the stalled motor that gives a torque at the input of the transmission, A.
pub(crate) fn stall_current_a(motor: &Motor, input_nm: f64) -> f64 {
    input_nm / (motor.reduction * motor.efficiency * motor.constant_nm_per_a) + motor.no_load_a
}

/// Section 2 of the paper: performance index, squeeze work, energy loss index.
fn measure_hand(m: &mut Measured, design: &Design, behaviour: &Behaviour) {
    let Some(required) = &design.requirements else { return };
    let statics = &behaviour.statics;
    let wanted_nm = required.output_nm.unwrap_or_else(|| statics.output(required.input_nm).1);
    let most_nm = statics.output(required.input_nm).1;
    let hand = design.hand.as_ref();
    m.set("finger_force", hand.map(|h| finger_force_n(h, most_nm)));
    let force_n = hand.map(|h| h.force_n.unwrap_or_else(|| finger_force_n(h, wanted_nm)));
    let index_w = hand.and_then(|h| h.speed_m_per_s).zip(force_n).map(|(v, f)| v * f);
    m.set("performance_index", index_w);
    let stiffness = hand.and_then(|h| h.object_n_per_m);
    m.set("squeeze_work", stiffness.zip(force_n).map(|(k, f)| 0.5 * f * f / k));
    let Some(motor) = &design.motor else { return };
    let needed_nm = statics.plateau_end_nm(wanted_nm);
    let held = statics.grip_nm.is_some() && needed_nm <= statics.held_input_nm();
    let current_a = stall_current_a(motor, needed_nm);
    let power_w = held.then_some(motor.resistance_ohm * current_a * current_a);
    m.set("stall_power", power_w);
    m.set("energy_loss_index", power_w.zip(index_w).map(|(p, i)| p / i));
}

/// The hand that closes.
fn measure_closing(m: &mut Measured, design: &Design, behaviour: &Behaviour) {
    let (Some(motor), Some(hand), Some(grasp)) = (&design.motor, &design.hand, &behaviour.grasp) else { return };
    m.set("closing_time", grasp.touch_s);
    if !grasp.is_finished() {
        return;
    }
    m.set("peak_current", grasp.peak_a());
    m.set("motor_speed_max", motor.reduction * grasp.peak_input_rad_per_s());
    let Some(force_n) = grasp.force_n() else { return };
    m.set("grasp_force", force_n);
    m.set("grasp_time", grasp.grasp_s());
    let Some(energy_j) = grasp.energy_j() else { return };
    m.set("energy_per_grasp", energy_j);
    m.set("grasps_per_charge", motor.battery.filter(|_| energy_j > 0.0).map(|b| b.energy_j() / energy_j));
    // A motor that was switched off at the force must hold it again; one that stands holds it already.
    let held_a = match grasp.ending {
        _ if hand.non_backdrivable => Some(0.0),
        Ending::Stalled => grasp.last().map(|l| l.current_a),
        _ => {
            let needed_nm = behaviour.statics.plateau_end_nm(force_n / finger_force_n(hand, 1.0));
            Some(stall_current_a(motor, needed_nm))
        }
    };
    m.set("holding_power", held_a.map(|a| motor.resistance_ohm * a * a));
}
