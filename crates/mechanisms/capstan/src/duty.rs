//! A cable drive in the measures of all families.

use forcewright_model::{Action, Duty, Stated};

use crate::analysis::Measured;
use crate::design::Design;

/// What it passes on to its output.
pub(crate) fn duty(design: &Design, measured: &Measured) -> Duty {
    let get = |name: &str| measured.get(name);
    let asked = design.requirements.as_ref().map(|r| r.torque_nm);
    let (strength, basis) = match asked {
        Some(torque_nm) => (Some(torque_nm), "torque asked for at the output"),
        None => (get("gross_slip_torque_output"), "torque at the output at which the cables slip"),
    };
    let width = get("input_drum_length").into_iter().chain(get("output_drum_length")).reduce(f64::max);
    let larger_m = design.built.radii_m[0].max(design.built.radii_m[1]);
    let across = get("length_over_drums")
        .map(|m| 2.0 * larger_m + (m - design.built.distance_m - design.built.radii_m[0] - design.built.radii_m[1]));
    let sides = get("length_over_drums").zip(across).zip(width).map(|((length, across), width)| [length, across, width]);
    Duty {
        action: Action::Torque,
        strength: Stated::new(strength, basis, "no torque is asked for, and the cables never slip"),
        range: Stated::new(Some(design.built.travel_rad), "travel of the output", ""),
        work: Stated::none("none of its own: it passes on what its input gives"),
        variation: Stated::none("it passes on what its input gives"),
        stiffness: Stated::new(
            get("stiffness_tangent_output"),
            "at the output under the torque asked for, input held",
            "no torque is asked for, or it is not held",
        ),
        loss: Stated::new(
            get("efficiency_forward").map(|efficiency| 1.0 - efficiency),
            "from input to output under the torque asked for",
            "bearings or cables are given without their losses",
        ),
        box_m: sides.map_or_else(Vec::new, Vec::from),
        box_basis: if sides.is_some() { "both drums with their cables, without bearings and frame" } else { "the drums have no length" }
            .to_owned(),
    }
}
