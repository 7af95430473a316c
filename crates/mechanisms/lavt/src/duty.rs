//! A two-speed transmission in the measures of all families.

use forcewright_model::{Action, Duty, Stated};

use crate::metrics::Measured;

/// What it passes on to its output.
pub(crate) fn duty(measured: &Measured) -> Duty {
    let get = |name: &str| measured.get(name);
    let sides = get("outer_diameter").zip(get("length")).map(|(across, length)| [across, across, length]);
    Duty {
        action: Action::Torque,
        strength: Stated::new(
            get("output_torque_max"),
            "at the output, with the torque asked for at the input",
            "no torque is asked for at the input",
        ),
        range: Stated::none("it turns without end"),
        work: Stated::none("none of its own: it passes on what its input gives"),
        variation: Stated::none("it passes on what its input gives, in two modes"),
        stiffness: Stated::none("it is not modelled"),
        loss: Stated::new(
            get("efficiency_max").map(|efficiency| 1.0 - efficiency),
            "from input to output with the torque asked for at the input",
            "no torque is asked for at the input",
        ),
        box_m: sides.map_or_else(Vec::new, Vec::from),
        box_basis: "the box around the cylinder of metrics `outer_diameter` and `length`: a quarter more than the cylinder".to_owned(),
    }
}
