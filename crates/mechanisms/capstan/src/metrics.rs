//! Names of the metrics: stable, so that requirements, studies and scripts agree.

use forcewright_base::units::Dimension as D;
use forcewright_contract::metrics::{MetricInfo, Metrics, metric};

/// The metrics of this family.
#[derive(Debug, Default)]
pub struct CapstanMetrics;

impl Metrics for CapstanMetrics {
    const ALL: &'static [MetricInfo] = METRICS;
}

/// Every metric of the family, in the order of results.
pub const METRICS: &[MetricInfo] = &[
    metric(
        "stiffness_tangent_output",
        D::RotationalStiffness,
        true,
        "Tangent stiffness dτ/dφ at the output under the required torque, input held.",
    ),
    metric(
        "stiffness_secant_output",
        D::RotationalStiffness,
        true,
        "Required torque over the turn of the output that it causes, input held.",
    ),
    metric("stiffness_initial_output", D::RotationalStiffness, true, "Stiffness at the output at rest, input held: that of the spans."),
    metric(
        "stiffness_tangent_input",
        D::RotationalStiffness,
        false,
        "Tangent stiffness at the input under the required torque, output held.",
    ),
    metric(
        "stiffness_secant_input",
        D::RotationalStiffness,
        false,
        "Secant stiffness at the input under the required torque, output held.",
    ),
    metric("stiffness_initial_input", D::RotationalStiffness, false, "Stiffness at the input at rest, output held."),
    metric("wind_up_output", D::Angle, false, "Turn of the output under the required torque, input held."),
    metric(
        "lost_motion_output",
        D::Angle,
        true,
        "Turn of the output between its rests at zero torque, after the required torque one way and the other.",
    ),
    metric(
        "loss_per_cycle",
        D::Energy,
        false,
        "Work lost to friction on the drums in one cycle between the required torque one way and the other.",
    ),
    metric(
        "gross_slip_torque_output",
        D::Torque,
        true,
        "Torque at the output at which the cables slip over the whole input drum, the least over the travel.",
    ),
    metric("taut_tension", D::Force, true, "Largest tension of a cable under the required torque over the travel."),
    metric("slack_tension", D::Force, true, "Smallest tension of a cable under the required torque over the travel."),
    metric("preload_left", D::Force, false, "Smallest preload of a cable after bedding in and at the temperature given."),
    metric("slip_angle_taut", D::Angle, false, "Largest slip angle on a drum on the taut side, under the required torque."),
    metric("slip_angle_slack", D::Angle, true, "Largest slip angle on a drum on the slack side, under the required torque."),
    metric(
        "slip_used",
        D::Ratio,
        false,
        "Part of the wrap of the input drum on which the cable slips under the required torque; of fastened cables of the wrap up to the pin over the travel, above 1 where slip needs more than there is.",
    ),
    metric("backdrive_torque_output", D::Torque, true, "Torque at the output that turns the drive with the input free."),
    metric("efficiency_forward", D::Ratio, true, "Efficiency from input to output with the required torque at the output."),
    metric("efficiency_backward", D::Ratio, false, "Efficiency from output to input with the required torque at the output."),
    metric("torque_input", D::Torque, false, "Torque at the input that gives the required torque at the output, with all losses."),
    metric("ratio", D::Ratio, true, "Turns of the input over turns of the output, r₂/r₁ to the middle of the cable."),
    metric("friction_effective", D::Ratio, false, "Friction of the cable on the drums, with the effect of the groove."),
    metric("free_span", D::Length, false, "Length of each free span, square to the axes."),
    metric("input_wrap", D::Angle, false, "Wrap of each cable on the input drum."),
    metric("output_wrap_min", D::Angle, false, "Smallest wrap before a termination on the output drum over the travel."),
    metric("helix_angle", D::Angle, false, "Angle of the helices."),
    metric("alignment_mismatch", D::Ratio, true, "Axial distance between the return span and its groove on the output drum, in pitches."),
    metric("fleet_angle", D::Angle, true, "Largest angle between a span and its grooves, that follows from the mismatch."),
    metric(
        "occupancy_clearance",
        D::Ratio,
        true,
        "Smallest free distance of turns on a drum over the travel, in pitches, 1 being the neighbouring groove.",
    ),
    metric("rope_clearance", D::Length, false, "Smallest gap between the surfaces of neighbouring turns on a drum over the travel."),
    metric("input_drum_length", D::Length, false, "Length of the input drum."),
    metric("output_drum_length", D::Length, false, "Length of the output drum."),
    metric(
        "output_drum_diameter",
        D::Length,
        false,
        "Diameter of the output drum over its cable, or over its lands where these stand higher.",
    ),
    metric("length_over_drums", D::Length, false, "Length over both drums with their cables: centre distance and both radii."),
    metric("cable_length", D::Length, false, "Length of the longest cable, with what its anchors take, without tension."),
    metric("preload_travel", D::Length, false, "How far a tensioner pulls the end of a cable to set the preload."),
    metric("bending_ratio", D::Ratio, true, "Smallest ratio of a drum's diameter, to the middle of the cable, to that of the cable."),
    metric("wire_bending_stress", D::Stress, false, "Bending stress of the outer wires on the smaller drum: an upper bound."),
    metric(
        "cable_safety_factor",
        D::Ratio,
        true,
        "Breaking force over the largest tension; of steel cables less what bending over the smaller drum takes (Carl Stahl Sava).",
    ),
    metric("shaft_load", D::Force, true, "Largest load of a shaft by the cables, at rest or under the required torque."),
    metric(
        "reflected_inertia_output",
        D::Inertia,
        false,
        "Moment of inertia felt at the output: its own and that of the input times the square of the ratio.",
    ),
    metric("torsional_frequency", D::Frequency, false, "Frequency of the output against the held input under the required torque."),
    metric("torsional_frequency_free", D::Frequency, false, "Frequency of output against input, both free, under the required torque."),
];
