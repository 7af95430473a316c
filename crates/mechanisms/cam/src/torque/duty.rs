//! A torque cam in the measures of all families.

use forcewright_model::{Action, Duty};

use super::analysis::{Behaviour, Station};
use super::design::Design;
use crate::analysis::Measured;
use crate::duty::Given;

/// What the disc gives.
pub(crate) fn duty(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Duty {
    // The axles are twice as long as the disc is thick.
    let depth_m = 2.0 * design.drawn_thickness_m();
    let box_m = measured.get("width").zip(measured.get("disc_diameter")).map(|(width, disc)| [width.max(disc), disc, depth_m]);
    let given = Given {
        action: Action::Torque,
        name: "torque",
        window: behaviour.window_rad,
        curve: behaviour.window.iter().map(|s: &Station| [s.turn_rad(), s.still.torque_nm]).collect(),
        box_m,
        box_basis: if box_m.is_some() {
            "disc and rollers over the turn, as deep as the axles are drawn; springs stand beyond it where they are wider"
        } else {
            "the disc does not get through its turn"
        },
    };
    given.duty(measured)
}
