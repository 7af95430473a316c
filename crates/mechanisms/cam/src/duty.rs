//! A cam mechanism in the measures of all families.

use forcewright_model::{Action, Duty, Stated};

use crate::analysis::{Behaviour, Measured, Station};
use crate::design::Design;

/// A variation below this is rounding of a force that the cam makes exact.
const ROUNDING: f64 = 1e-9;

/// Numbers that force over travel and torque over turn have alike.
pub(crate) struct Given {
    pub(crate) action: Action,
    /// Name of what it gives in metrics: `force`.
    pub(crate) name: &'static str,
    /// Over which means are taken, from and to, m or rad.
    pub(crate) window: [f64; 2],
    /// Travel and force without friction there.
    pub(crate) curve: Vec<[f64; 2]>,
    /// Arm of the rolling resistance, m.
    pub(crate) arm_m: f64,
    pub(crate) box_m: Vec<f64>,
    pub(crate) box_basis: &'static str,
}

/// What the slider gives.
pub(crate) fn duty(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Duty {
    let sides = measured.get("width").zip(measured.get("height")).map(|(width, height)| vec![width, height]);
    let given = Given {
        action: Action::Force,
        name: "force",
        window: behaviour.window_m,
        curve: behaviour.window.iter().map(|s: &Station| [s.travel_m, s.still.force_n]).collect(),
        arm_m: design.built.arm_m,
        box_basis: match sides {
            Some(_) => "rollers, braces and slider's joint over the stroke; how deep it is with its springs is not known",
            None => "the mechanism does not get through its stroke",
        },
        box_m: sides.unwrap_or_default(),
    };
    given.duty(measured)
}

impl Given {
    pub(crate) fn duty(self, measured: &Measured) -> Duty {
        const STOPPED: &str = "the mechanism does not get through its window";
        let get = |what: &str| measured.get(&format!("{}_{what}", self.name));
        let mean = get("mean");
        let values = || self.curve.iter().map(|p| p[1]);
        let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        let variation = mean.filter(|_| high + low > 0.0).map(|_| (high - low) / (high + low));
        let exact = variation.is_some_and(|v| v < ROUNDING);
        let variation = if exact { Some(0.0) } else { variation };
        let slope = |pair: &[[f64; 2]]| ((pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])).abs();
        let steepest =
            mean.map(|_| if exact { 0.0 } else { self.curve.windows(2).filter(|p| p[1][0] > p[0][0]).map(slope).fold(0.0, f64::max) });
        let loss = mean.zip(get("up_mean")).filter(|_| self.arm_m > 0.0).map(|(mean, up)| 1.0 - mean / up);
        let rolls = if self.arm_m > 0.0 { STOPPED } else { "no rolling resistance is given" };
        let area = |pair: &[[f64; 2]]| 0.5 * (pair[1][0] - pair[0][0]) * (pair[0][1] + pair[1][1]);
        let work = mean.map(|_| self.curve.windows(2).map(area).sum());
        let name = self.name;
        Duty {
            action: self.action,
            strength: Stated::new(mean, &format!("mean of the {name} without friction over the window"), STOPPED),
            range: Stated::new(mean.map(|_| self.window[1] - self.window[0]), "the window", STOPPED),
            work: Stated::new(work, &format!("integral of the {name} without friction over the window"), STOPPED),
            variation: Stated::new(variation, &format!("of the {name} without friction over the window"), STOPPED),
            stiffness: Stated::new(steepest, &format!("steepest slope of the {name} without friction over the window"), STOPPED),
            loss: Stated::new(loss, "rolling resistance alone, against the springs: 1 − mean/mean up", rolls),
            box_m: self.box_m,
            box_basis: self.box_basis.to_owned(),
        }
    }
}
