//! A torque cam in the measures of all families.

use forcewright_model::{Action, Duty};

use super::analysis::{Behaviour, Station};
use super::design::Design;
use crate::analysis::Measured;
use crate::duty::Given;

/// What the disc gives.
pub(crate) fn duty(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Duty {
    // The axles are twice as long as the disc is thick.
    let depth = design.built.thickness_m.map(|m| 2.0 * m);
    let sides = measured.get("width").zip(measured.get("disc_diameter")).zip(depth);
    let box_m = sides.map(|((width, disc), depth)| [width.max(disc), disc, depth]);
    let given = Given {
        action: Action::Torque,
        name: "torque",
        window: behaviour.window_rad,
        curve: behaviour.window.iter().map(|s: &Station| [s.turn_rad(), s.still.torque_nm]).collect(),
        box_m,
        box_basis: if box_m.is_some() {
            "disc and rollers over the turn, as deep as the axles; springs stand beyond it where they are wider"
        } else {
            "the thickness of the disc is not known: `design.cam_thickness`"
        },
    };
    given.duty(measured)
}
