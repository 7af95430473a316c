//! Names of the metrics: stable, so that requirements, studies and scripts agree.

use forcewright_base::units::Dimension;
use forcewright_contract::metrics::{MetricInfo, Metrics, metric};

/// The metrics of this family.
#[derive(Debug, Default)]
pub struct CamMetrics;

impl Metrics for CamMetrics {
    const ALL: &'static [MetricInfo] = METRICS;
}

/// Every metric of the family, in the order of results.
pub const METRICS: &[MetricInfo] = &[
    metric("force_mean", Dimension::Force, true, "Mean of the force without friction over the window."),
    metric("force_up_mean", Dimension::Force, true, "Mean of the force over the window, slider moving along its travel."),
    metric("force_up_sd", Dimension::Force, false, "Standard deviation of that force over the window."),
    metric("force_up_max", Dimension::Force, false, "Largest force over the window, slider moving along its travel."),
    metric("force_up_min", Dimension::Force, false, "Smallest force over the window, slider moving along its travel."),
    metric("force_down_mean", Dimension::Force, true, "Mean of the force over the window, slider moving back."),
    metric("force_down_sd", Dimension::Force, false, "Standard deviation of that force over the window."),
    metric("force_down_max", Dimension::Force, false, "Largest force over the window, slider moving back."),
    metric("force_down_min", Dimension::Force, false, "Smallest force over the window, slider moving back."),
    metric(
        "force_deviation",
        Dimension::Ratio,
        true,
        "Largest distance of the force, up or down, from what is required, relative to it, over the window.",
    ),
    metric(
        "force_spread",
        Dimension::Ratio,
        false,
        "Half width of the band that the force needs over the window, up and down, its level free: (max − min)/(max + min).",
    ),
    metric("loop_area", Dimension::Energy, true, "Work lost to friction in one cycle over the window."),
    metric("hysteresis", Dimension::Ratio, true, "(mean up − mean down)/mean of the force, or torque, over the window."),
    metric(
        "energy",
        Dimension::Energy,
        false,
        "Work of the force without friction over the whole stroke, or of the torque over the whole turn.",
    ),
    metric("weight", Dimension::Force, false, "Part of the mean force that is weight of the moving parts, over the window."),
    metric("path_curvature_radius_min", Dimension::Length, false, "Smallest radius of curvature of the path of the rollers' centres."),
    metric("undercut_travel", Dimension::Length, true, "Travel at the start that is lost because the cam is undercut there."),
    metric(
        "pressure_angle_max",
        Dimension::Angle,
        false,
        "Largest angle between the pull of a brace and the path of its roller, or of a torque cam between the guide of a roller and the normal of the cam, over the window; at 90° nothing moves it.",
    ),
    metric("spring_length_max", Dimension::Length, true, "Largest length of the springs over the stroke."),
    metric("spring_length_min", Dimension::Length, false, "Smallest length of the springs over the stroke."),
    metric("spring_force_max", Dimension::Force, false, "Largest force of all springs together over the stroke."),
    metric("contact_force_max", Dimension::Force, false, "Largest force between a roller and the cam over the stroke."),
    metric(
        "contact_force_min",
        Dimension::Force,
        true,
        "Smallest force between a roller and the cam over the stroke; below zero it lifts off.",
    ),
    metric("brace_tension_max", Dimension::Force, false, "Largest tension of a brace over the stroke."),
    metric("brace_tension_min", Dimension::Force, false, "Smallest tension of a brace over the stroke; below zero a cable goes slack."),
    metric("hertz_pressure_max", Dimension::Stress, true, "Largest pressure between roller and cam over the window (Hertz, line contact)."),
    metric(
        "friction_needed_max",
        Dimension::Ratio,
        false,
        "Largest tangential over normal force between roller and cam, at rest and in the motion: rolling needs so much friction.",
    ),
    metric(
        "guide_force_max",
        Dimension::Force,
        false,
        "Largest force across its direction that the guide carries: of the slider, or of a follower of a torque cam.",
    ),
    metric(
        "lateral_stiffness_min",
        Dimension::Stiffness,
        false,
        "Smallest restoring force per sideways motion of a slider without a guide, over the window; below zero it turns away.",
    ),
    metric(
        "moving_mass",
        Dimension::Mass,
        false,
        "Mass of slider, braces, rollers and springs; of a torque cam of followers, rollers and springs.",
    ),
    metric("width", Dimension::Length, true, "Largest width over the stroke, rollers included."),
    metric(
        "height",
        Dimension::Length,
        true,
        "From the lowest roller to the highest one or the slider's joint, over the stroke, a roller's radius more at the top.",
    ),
    metric("cam_length", Dimension::Length, false, "Extent of the cam along the travel, without its base."),
    metric(
        "profile_error_rms",
        Dimension::Length,
        false,
        "Root mean square of the deviation of the profile along its normal, both sides, over the window.",
    ),
    metric("profile_error_max", Dimension::Length, false, "Largest deviation of the profile along its normal, over the window."),
    metric(
        "contact_life",
        Dimension::Ratio,
        false,
        "Load cycles that the surfaces of cam and rollers endure at the largest pressure, 1e4 to 1e10.",
    ),
    metric(
        "peak_force_ratio",
        Dimension::Ratio,
        true,
        "Largest force in the motion over the quasi-static one at the same place, minus one.",
    ),
    metric(
        "peak_force_ratio_to",
        Dimension::Ratio,
        false,
        "The same over the force of the motion that takes the reference duration, at the same part of the duration.",
    ),
    metric("force_max_motion", Dimension::Force, false, "Largest force in the motion."),
    metric(
        "force_min_motion",
        Dimension::Force,
        true,
        "Smallest force in the motion; below zero a cable that pulls the slider goes slack.",
    ),
    metric(
        "contact_force_min_motion",
        Dimension::Force,
        true,
        "Smallest force between a roller and the cam in the motion; below zero it lifts off.",
    ),
    metric("speed_max", Dimension::Speed, true, "Largest speed of the slider in the motion."),
    metric("speed_end", Dimension::Speed, false, "Speed with which the released slider runs against a stop."),
    metric("time_to_end", Dimension::Time, true, "Time that the released slider takes to a stop."),
    metric("slack_time", Dimension::Time, false, "How long the cable of the hanging mass is slack after the release."),
    metric("work_in", Dimension::Energy, false, "Work of what pulls the slider over the motion, where it moves the way it is pulled."),
    metric("energy_lost", Dimension::Energy, true, "Work lost over the motion: rolling, damping, and a cable that becomes taut."),
    metric("torque_mean", Dimension::Torque, true, "Torque cam: mean of the torque without friction over the window."),
    metric("torque_up_mean", Dimension::Torque, true, "Torque cam: mean of the torque over the window, disc turned against the springs."),
    metric("torque_up_sd", Dimension::Torque, false, "Torque cam: standard deviation of that torque over the window."),
    metric("torque_up_max", Dimension::Torque, false, "Torque cam: largest torque over the window, disc turned against the springs."),
    metric("torque_up_min", Dimension::Torque, false, "Torque cam: smallest torque over the window, disc turned against the springs."),
    metric("torque_down_mean", Dimension::Torque, true, "Torque cam: mean of the torque over the window, disc turned back by the springs."),
    metric("torque_down_sd", Dimension::Torque, false, "Torque cam: standard deviation of that torque over the window."),
    metric("torque_down_max", Dimension::Torque, false, "Torque cam: largest torque over the window, disc turned back by the springs."),
    metric("torque_down_min", Dimension::Torque, false, "Torque cam: smallest torque over the window, disc turned back by the springs."),
    metric(
        "torque_deviation",
        Dimension::Ratio,
        true,
        "Torque cam: largest distance of the torque, up or down, from what is required, relative to it, over the window.",
    ),
    metric(
        "torque_spread",
        Dimension::Ratio,
        false,
        "Torque cam: half width of the band that the torque needs over the window, up and down, its level free: (max − min)/(max + min).",
    ),
    metric("undercut_turn", Dimension::Angle, true, "Torque cam: turn at the start that is lost because the cam is undercut there."),
    metric(
        "disc_diameter",
        Dimension::Length,
        false,
        "Torque cam: diameter of the circle about the shaft that holds the disc or the ring.",
    ),
    metric("hub_wall", Dimension::Length, false, "Torque cam: least material between the hole for the shaft and the outline of the disc."),
    metric("torque_max_motion", Dimension::Torque, false, "Torque cam: largest torque in the motion."),
    metric("torque_min_motion", Dimension::Torque, true, "Torque cam: smallest torque in the motion."),
    metric(
        "peak_torque_ratio",
        Dimension::Ratio,
        true,
        "Torque cam: largest torque in the motion over the one at rest at the same place, minus one.",
    ),
    metric("turn_speed_max", Dimension::AngularSpeed, false, "Torque cam: largest speed of the disc in the motion."),
];
