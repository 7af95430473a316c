//! Names of the metrics: stable, so that requirements, studies and scripts agree.

use forcewright_base::units::Dimension;
use forcewright_contract::metrics::{MetricInfo, Metrics, metric};

/// The metrics of this family.
#[derive(Debug, Default)]
pub(crate) struct CompliantMetrics;

impl Metrics for CompliantMetrics {
    const ALL: &'static [MetricInfo] = METRICS;
}

/// Every metric of the family, in the order of results.
pub const METRICS: &[MetricInfo] = &[
    metric("force_at_end", Dimension::Force, true, "Force F(d) at the full travel, whole layout."),
    metric("range_start", Dimension::Length, true, "Start c of the operational range of Lan, Wang & Chen: F last rises through 0.95·F(d)."),
    metric("range_ratio", Dimension::Ratio, true, "Operational range of Lan, Wang & Chen over the travel, (d − c)/d."),
    metric("flat_start", Dimension::Length, false, "Start of the longest interval with max F/min F ≤ (1 + β)/(1 − β), level free."),
    metric("flat_end", Dimension::Length, false, "End of the longest interval with max F/min F ≤ (1 + β)/(1 − β)."),
    metric("flat_ratio", Dimension::Ratio, true, "Longest interval inside a band whose level is free, over the travel."),
    metric("flat_force", Dimension::Force, true, "Middle of the force over the longest interval inside a band whose level is free."),
    metric("band_start", Dimension::Length, true, "Start of the longest interval inside the band around the nominal force."),
    metric("band_end", Dimension::Length, true, "End of the longest interval inside the band around the nominal force."),
    metric("band_ratio", Dimension::Ratio, true, "Longest interval inside the band around the nominal force, over the travel."),
    metric("force_local_max", Dimension::Force, false, "First local maximum of the force."),
    metric("force_local_max_at", Dimension::Length, false, "Displacement of the first local maximum of the force."),
    metric("force_local_min", Dimension::Force, false, "First local minimum of the force after that maximum."),
    metric("force_local_min_at", Dimension::Length, false, "Displacement of that local minimum."),
    metric("stiffness_initial", Dimension::Stiffness, false, "Slope dF/dΔ at rest."),
    metric("stiffness_min", Dimension::Stiffness, true, "Least slope dF/dΔ over the travel."),
    metric("stress_max", Dimension::Stress, true, "Largest stress over all beams, both faces, the whole travel."),
    metric("safety_factor", Dimension::Ratio, true, "Yield stress over the largest stress."),
    metric("travel_at_allowable_stress", Dimension::Length, false, "Displacement at which the stress first reaches what is allowed."),
    metric("energy_at_end", Dimension::Energy, false, "Elastic energy at the full travel, whole layout."),
    metric("mass", Dimension::Mass, false, "Mass of the beams, whole layout, without blocks."),
    metric("length_ratio_max", Dimension::Ratio, false, "Largest arc length of a beam over its chord."),
    metric(
        "clearance_min",
        Dimension::Length,
        false,
        "Smallest distance between beam surfaces over the travel, outside the joints that they share.",
    ),
    metric(
        "lateral_stiffness_min",
        Dimension::Stiffness,
        false,
        "Least force per sideways motion of the load node, free to turn and without a guide, over the travel; of mirrored layouts.",
    ),
    metric(
        "envelope_margin",
        Dimension::Length,
        false,
        "Smallest distance of the surfaces of the beams and their copies in the plane to the envelope, at rest and over the travel.",
    ),
    metric("contact_force_max", Dimension::Force, true, "Largest contact force along the guide, over the way in contact with the surface."),
    metric(
        "contact_force_min",
        Dimension::Force,
        true,
        "Smallest contact force along the guide, over the way in contact with the surface.",
    ),
    metric("contact_force_mean", Dimension::Force, false, "Mean contact force along the guide, over the way in contact with the surface."),
    metric("contact_force_spread", Dimension::Ratio, true, "(max − min)/(max + min) of the contact force along the guide."),
    metric("transverse_force_max", Dimension::Force, false, "Largest force with which the stage moves the tip along the surface."),
    metric(
        "stress_inner_face",
        Dimension::Stress,
        false,
        "Largest stress with what the curvature of its beam adds at the inner face, by the factor 1 + thickness/(3 radius), the whole travel.",
    ),
    metric(
        "lateral_force_mean",
        Dimension::Force,
        true,
        "Mean force on the tip across the load, over the window of the lateral motion and all its Δ.",
    ),
    metric("lateral_force_max", Dimension::Force, false, "Largest magnitude of the lateral force over that window and all Δ."),
    metric(
        "lateral_force_spread",
        Dimension::Ratio,
        true,
        "(max − min)/|max + min| of the lateral force over that window and all Δ; above 100 % where it changes its sign.",
    ),
    metric(
        "axial_force_mean",
        Dimension::Force,
        false,
        "Mean force on the tip along the load, over the window of the lateral motion and all its Δ.",
    ),
    metric("axial_force_spread", Dimension::Ratio, true, "(max − min)/|max + min| of the axial force over that window and all Δ."),
    metric(
        "axial_force_coupling",
        Dimension::Ratio,
        true,
        "The same over that window at one Δ, where it is largest: what moving sideways changes of the axial force.",
    ),
    metric(
        "tip_stress_max",
        Dimension::Stress,
        true,
        "Largest stress over all beams and both faces, over the window of the lateral motion and all its Δ.",
    ),
    metric("tip_rotation_max", Dimension::Angle, false, "Largest rotation of the tip over the window of the lateral motion and all its Δ."),
];
