//! Names of the metrics: stable, so that requirements, studies and scripts agree.

use forcewright_base::units::Dimension as D;
use forcewright_contract::metrics::{MetricInfo, Metrics, Values, metric};

/// The metrics of this family.
#[derive(Debug, Default)]
pub struct LavtMetrics;

impl Metrics for LavtMetrics {
    const ALL: &'static [MetricInfo] = METRICS;
}

/// Values of the metrics of a design.
pub type Measured = Values<LavtMetrics>;

/// Every metric of the family, in the order of results.
pub const METRICS: &[MetricInfo] = &[
    // Characteristic.
    metric("ratio", D::Ratio, true, "Speed of the output over that of the input in mode II, R = Z_sun/(Z_sun + Z_ring)."),
    metric("speed_drop", D::Ratio, false, "Speed in mode I over that in mode II, 1/R."),
    metric(
        "transition_torque_input",
        D::Torque,
        true,
        "Torque at the input at which mode I ends: the spring reaches the bore, or slips on the hub before it.",
    ),
    metric("transition_torque_output", D::Torque, true, "Torque at the output at which mode I ends."),
    metric(
        "transition_torque_output_low",
        D::Torque,
        false,
        "Least torque at the output at which mode I ends, over the range of friction and the tolerances.",
    ),
    metric("transition_torque_output_high", D::Torque, false, "The largest of them."),
    metric(
        "plateau_end_input",
        D::Torque,
        true,
        "Torque at the input at which the hub slips and mode II begins, the output loaded as at the transition.",
    ),
    metric(
        "plateau_width_input",
        D::Torque,
        false,
        "Interval of input torque in which nothing turns, the output loaded as at the transition.",
    ),
    metric(
        "downshift_torque_output",
        D::Torque,
        true,
        "Torque at the output below which mode II gives way to mode I again; below 0 it takes less torque at the input.",
    ),
    metric("shift_hysteresis_output", D::Torque, false, "Output torque of the shift up less that of the shift down."),
    metric("output_torque_max", D::Torque, true, "Torque at the output with the required torque at the input."),
    metric(
        "output_torque_max_low",
        D::Torque,
        false,
        "Least torque at the output with the required torque at the input, over the range of friction and the tolerances.",
    ),
    metric("efficiency_max", D::Ratio, true, "Power at the output over power at the input with the required torque at the input."),
    metric(
        "efficiency_max_low",
        D::Ratio,
        false,
        "Least efficiency with the required torque at the input, over the range of friction and the tolerances; 0 where it slips or is blocked.",
    ),
    metric("efficiency_mode_1", D::Ratio, false, "Power at the output over power at the input in mode I, just before the transition."),
    metric("force_gain", D::Ratio, false, "Torque at the output over that of the same input without the transmission."),
    // Clutch.
    metric("spring_transition_torque", D::Torque, true, "Torque on the spring at which it reaches the bore, τ_t."),
    metric("hub_torque", D::Torque, true, "Torque on the spring at which it slips on the hub in the opening sense, τ_b."),
    metric("hub_torque_low", D::Torque, false, "Torque on the spring at which it slips on the hub, at the least friction."),
    metric("hub_torque_high", D::Torque, false, "Torque on the spring at which it slips on the hub, at the largest friction."),
    metric("bore_grip_torque", D::Torque, true, "Largest torque on the spring that the bore holds, τ_t included."),
    metric(
        "bore_grip_torque_low",
        D::Torque,
        false,
        "Largest torque on the spring that the bore holds, at the least friction and the worst gaps of the tolerances.",
    ),
    metric("clutch_torque_max", D::Torque, false, "Torque on the spring with the required torque at the input."),
    metric(
        "shift_margin",
        D::Ratio,
        false,
        "Torque at which the hub slips over that at which the bore is reached: below 1 the spring slips before it shifts.",
    ),
    metric(
        "shift_margin_low",
        D::Ratio,
        true,
        "Torque at which the hub slips over that at which the bore is reached, at the least friction and the worst gaps.",
    ),
    metric(
        "input_torque_held",
        D::Torque,
        true,
        "Largest torque at the input that is held: by the bore in mode II, or by the hub where the spring slips first.",
    ),
    metric(
        "input_torque_held_low",
        D::Torque,
        false,
        "Largest torque at the input that is held, at the least friction and the worst gaps of the tolerances.",
    ),
    metric(
        "input_torque_opening",
        D::Torque,
        false,
        "Largest torque at the input in the opening direction: the spring tightens on the hub and stays in mode I.",
    ),
    metric("friction_min_hub", D::Ratio, true, "Least friction on the hub with which the spring reaches the bore before it slips."),
    metric(
        "friction_min_bore",
        D::Ratio,
        true,
        "Least friction, on hub and bore alike, with which the bore holds the required torque at the input.",
    ),
    metric("hub_interference", D::Length, false, "Radial interference of spring and hub, δa."),
    metric("bore_gap", D::Length, false, "Radial opening of the spring to the bore, δb."),
    metric("gap_difference", D::Length, true, "δa − δb: what grips the bore."),
    metric("gap_difference_low", D::Length, false, "δa − δb at the worst ends of the tolerances."),
    metric("spring_stress_hub", D::Stress, false, "Bending stress of the wire on the hub."),
    metric("spring_stress_bore", D::Stress, false, "Bending stress of the wire opened to the bore."),
    metric(
        "spring_stress_unsupported",
        D::Stress,
        false,
        "Bending stress of a coil between ring and bore that nothing supports, with the required torque at the input.",
    ),
    metric("spring_stress_max", D::Stress, true, "Largest bending stress of the wire."),
    metric(
        "spring_safety_factor",
        D::Ratio,
        true,
        "Permissible bending stress of the wire (0.7 of its tensile strength, EN 13906-3) over the largest.",
    ),
    metric("dead_turns_spring", D::Ratio, false, "Turns by which the free coils wind up before the bore is reached."),
    metric("dead_turns_input", D::Ratio, true, "Turns of the input before the bore is reached, with the output held."),
    metric("wear_work_per_turn", D::Energy, false, "Work of slip on the hub in a turn of the output in mode II."),
    // Gears.
    metric("planet_gap", D::Length, true, "Gap between the tip circles of neighbouring planets."),
    metric("contact_ratio_sun", D::Ratio, false, "Contact ratio of sun and planet."),
    metric("contact_ratio_ring", D::Ratio, false, "Contact ratio of planet and ring."),
    metric("undercut_margin", D::Ratio, true, "Least profile shift over that which avoids undercut, of sun and planets, in modules."),
    metric("interference_margin", D::Length, true, "Least room before teeth of planet and ring or sun interfere or are pointed."),
    metric("backlash_min", D::Length, false, "Least backlash of both meshes along their pitch circles; below 0 the teeth do not go in."),
    metric("mesh_efficiency", D::Ratio, false, "Efficiency of the gears in mode II, without the clutch."),
    metric("tooth_bending_stress", D::Stress, false, "Largest bending stress at a tooth root with the required torque at the input."),
    metric("flank_pressure", D::Stress, false, "Largest Hertz pressure between flanks with the required torque at the input."),
    // Size.
    metric("outer_diameter", D::Length, true, "Outer diameter of the whole: that of ring, friction ring and chassis which is largest."),
    metric(
        "length",
        D::Length,
        true,
        "Length along the axis, from the carrier's plate at the input to the chassis' plate at the output, without axial play and shafts.",
    ),
    metric("envelope_volume", D::Volume, true, "Volume of the cylinder of this diameter and length."),
    // Measured on a bench; `_low` and `_high` are the ends of intervals of 95 %.
    metric("bench_loss_mode_1", D::Ratio, false, "Bench: part of the torque that mode I loses, λ of τ_out = (1 − λ) τ_in − c."),
    metric("bench_loss_mode_1_low", D::Ratio, false, "Lower end of its interval."),
    metric("bench_loss_mode_1_high", D::Ratio, false, "Upper end of its interval."),
    metric("bench_constant_mode_1", D::Torque, false, "Bench: torque that mode I loses at any load, at the output, c."),
    metric("bench_constant_mode_1_low", D::Torque, false, "Lower end of its interval."),
    metric("bench_constant_mode_1_high", D::Torque, false, "Upper end of its interval."),
    metric("bench_loss_mode_2", D::Ratio, false, "Bench: part of the torque that mode II loses, λ of τ_out = (1 − λ) τ_in/R − c."),
    metric("bench_loss_mode_2_low", D::Ratio, false, "Lower end of its interval."),
    metric("bench_loss_mode_2_high", D::Ratio, false, "Upper end of its interval."),
    metric(
        "bench_constant_mode_2",
        D::Torque,
        false,
        "Bench: torque that mode II loses at any load, at the output, slip on the hub included.",
    ),
    metric("bench_constant_mode_2_low", D::Torque, false, "Lower end of its interval."),
    metric("bench_constant_mode_2_high", D::Torque, false, "Upper end of its interval."),
    metric(
        "bench_crossing_output",
        D::Torque,
        false,
        "Bench: output torque at which the lines of both modes cross, that of the shift without a plateau.",
    ),
    metric("bench_crossing_output_low", D::Torque, false, "Lower end of its interval."),
    metric("bench_crossing_output_high", D::Torque, false, "Upper end of its interval."),
    metric("bench_transition_output_low", D::Torque, false, "Bench: largest output torque still in mode I, by the masses that hung."),
    metric("bench_transition_output_high", D::Torque, false, "Bench: least output torque in mode II, by the masses that hung."),
    metric("bench_plateau_low", D::Torque, false, "Bench: least width of the plateau, in input torque."),
    metric("bench_plateau_high", D::Torque, false, "Bench: largest width of the plateau, in input torque."),
    metric(
        "bench_friction_hub",
        D::Ratio,
        false,
        "Bench: friction on the hub at which the corrected model slips at the torque that was measured.",
    ),
    metric("bench_friction_hub_low", D::Ratio, false, "Lower end of its interval."),
    metric(
        "bench_friction_hub_high",
        D::Ratio,
        false,
        "Upper end of its interval; absent where the interval reaches the moment of the interference.",
    ),
    // Energy and hand.
    metric("finger_force", D::Force, true, "Force at the finger with the required torque at the input."),
    metric("performance_index", D::Power, false, "Largest speed at the finger times largest force, P_I."),
    metric("squeeze_work", D::Energy, false, "Work to squeeze the object up to the largest force, F²/2K."),
    metric("energy_loss_index", D::Ratio, false, "Power of the stalled motor at the largest force over the performance index."),
    metric("energy_gain", D::Ratio, false, "Energy loss index without the transmission, at the same speed and force, over that with it."),
    metric("stall_power", D::Power, true, "Electric power of the stalled motor at the required output torque."),
    metric("closing_time", D::Time, true, "From rest to the first touch of the object."),
    metric("grasp_time", D::Time, true, "From rest to 95 % of the force that is reached in the end."),
    metric("grasp_force", D::Force, false, "Force on the object in the end."),
    metric("energy_per_grasp", D::Energy, true, "Electric energy from rest to the wanted force, or to 95 % of that of a stall."),
    metric("grasps_per_charge", D::Ratio, true, "Energy of the battery over that of a grasp."),
    metric("peak_current", D::Current, true, "Largest current of the motor on the way."),
    metric("motor_speed_max", D::AngularSpeed, false, "Largest speed of the motor as the hand closes."),
    metric("holding_power", D::Power, false, "Electric power that keeps the grasp; none where the finger's reduction holds it alone."),
];
