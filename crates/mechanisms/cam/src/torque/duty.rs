//! A torque cam in the measures of all families.

use forcewright_model::{Action, Duty};

use super::analysis::{Behaviour, Station};
use super::design::Design;
use crate::analysis::Measured;
use crate::duty::Given;

/// What the disc gives.
pub(crate) fn duty(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Duty {
    let sides = measured.get("width").zip(measured.get("disc_diameter")).map(|(width, disc)| vec![width.max(disc), disc]);
    let given = Given {
        action: Action::Torque,
        name: "torque",
        window: behaviour.window_rad,
        curve: behaviour.window.iter().map(|s: &Station| [s.turn_rad(), s.still.torque_nm]).collect(),
        arm_m: design.built.arm_m,
        box_basis: match sides {
            Some(_) => "disc and rollers over the turn; how deep it is with its springs is not known",
            None => "the disc does not get through its turn",
        },
        box_m: sides.unwrap_or_default(),
    };
    given.duty(measured)
}
