//! What stands before and behind the transmission: motor, battery, finger, object.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::units::Quantity;
use forcewright_contract::describe::{Located, Slot};

use super::{place_of, si};
use crate::spec::Spec;

/// What the output drives, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Hand {
    /// Way of the finger over turn of its joint.
    pub lever: Lever,
    /// Turns of the output for one of the joint.
    pub reduction: f64,
    /// Of that reduction.
    pub efficiency: f64,
    /// Whether it holds the finger without torque.
    pub non_backdrivable: bool,
    /// Way of the finger from open to closed, m.
    pub opening_m: Option<f64>,
    /// Opening left when the object is touched, m.
    pub object_width_m: f64,
    /// Of the object, N/m.
    pub object_n_per_m: Option<f64>,
    /// Of the glove, N/m.
    pub glove_n_per_m: f64,
    /// Of glove and joints, N.
    pub glove_friction_n: f64,
    /// Of the finger about its joint, kg·m².
    pub inertia_kg_m2: Option<f64>,
    /// Force that is wanted, N.
    pub force_n: Option<f64>,
    /// Speed that is wanted, m/s.
    pub speed_m_per_s: Option<f64>,
}

/// Equivalent lever over the opening that is left.
#[derive(Clone, Debug, PartialEq)]
pub enum Lever {
    /// The same everywhere, m.
    Constant(f64),
    /// Opening (ascending) and lever, m; straight between the points, constant beyond them.
    Table(Vec<[f64; 2]>),
}

impl Lever {
    /// Lever with this opening left, m.
    pub fn at_m(&self, opening_m: f64) -> f64 {
        match self {
            Self::Constant(lever_m) => *lever_m,
            Self::Table(points) => interpolated(points, opening_m),
        }
    }
}

/// A value between the points of a table with ascending first column; that of its ends beyond them.
pub(crate) fn interpolated(points: &[[f64; 2]], x: f64) -> f64 {
    let after = points.partition_point(|p| p[0] <= x);
    match (after.checked_sub(1).and_then(|i| points.get(i)), points.get(after)) {
        (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]),
        (Some(only), None) | (None, Some(only)) => only[1],
        (None, None) => 0.0,
    }
}

/// The motor and what feeds it, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Motor {
    /// Of the winding, Ω.
    pub resistance_ohm: f64,
    /// K, N·m/A.
    pub constant_nm_per_a: f64,
    /// Of the rotor, kg·m².
    pub inertia_kg_m2: Option<f64>,
    /// Current of its own friction, A.
    pub no_load_a: f64,
    /// Turns of the motor for one of the transmission's input.
    pub reduction: f64,
    /// Of that reduction.
    pub efficiency: f64,
    /// Voltage over time (s, V); the last value stays.
    pub supply: Vec<[f64; 2]>,
    /// Largest current, A; may be infinite.
    pub limit_a: f64,
    /// Largest speed, rad/s.
    pub max_rad_per_s: Option<f64>,
    /// The battery.
    pub battery: Option<Battery>,
}

/// A battery, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Battery {
    /// Mean voltage, V.
    pub voltage_v: f64,
    /// Charge, A·s.
    pub charge_as: f64,
}

impl Battery {
    /// Energy, J.
    pub fn energy_j(&self) -> f64 {
        self.voltage_v * self.charge_as
    }
}

impl Motor {
    /// Voltage at a time (s), V.
    pub fn supply_v(&self, time_s: f64) -> f64 {
        interpolated(&self.supply, time_s)
    }

    /// Rate of the voltage right after a time (s), V/s.
    pub fn supply_slope(&self, time_s: f64) -> f64 {
        let after = self.supply.partition_point(|p| p[0] <= time_s);
        match (after.checked_sub(1).and_then(|i| self.supply.get(i)), self.supply.get(after)) {
            (Some(a), Some(b)) => (b[1] - a[1]) / (b[0] - a[0]),
            _ => 0.0,
        }
    }

    /// Voltage in the end, V.
    pub fn final_v(&self) -> f64 {
        self.supply.last().map_or(0.0, |p| p[1])
    }
}

type Pairs = Slot<Vec<Located<[Quantity; 2]>>>;

/// E0807: the points of a table, whose first column ascends.
fn points(slot: &Pairs, what: &str, diagnostics: &mut Diagnostics) -> Option<Vec<[f64; 2]>> {
    let typed = slot.as_ref()?;
    let points: Vec<[f64; 2]> = typed.value.iter().map(|p| [p.value[0].si, p.value[1].si]).collect();
    for (pair, typed) in points.windows(2).zip(typed.value.iter().skip(1)) {
        if pair[1][0] <= pair[0][0] {
            let error =
                Diagnostic::error("E0807", typed.span, format!("{what} must rise from point to point")).label("not above the one before");
            diagnostics.push(error.help("sort the points, and remove doubles"));
            return None;
        }
    }
    Some(points)
}

pub(super) fn hand_of(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Hand> {
    let place = spec.hand.present.as_ref()?.span;
    let typed = &spec.hand;
    let table = points(&typed.lever_table, "the opening", diagnostics);
    if typed.lever_table.is_some() && table.is_none() {
        return None;
    }
    let lever = match (table, si(&typed.lever)) {
        (Some(points), None) => Lever::Table(points),
        (None, Some(lever_m)) => Lever::Constant(lever_m),
        (one, _) => {
            let message = if one.is_some() { "both `lever` and `lever_table` are given" } else { "the lever of the finger is not known" };
            let error = Diagnostic::error("E0807", place, message).label("of this hand");
            diagnostics.push(error.help("give `lever = \"130 mm\"`, or `lever_table`, but not both"));
            return None;
        }
    };
    if let (Some(opening_m), Some(width)) = (si(&typed.opening), &typed.object_width)
        && width.value.si >= opening_m
    {
        let error = Diagnostic::error("E0807", width.span, "the object does not go into the open hand").label("this width");
        diagnostics.push(error.help(format!(
            "the opening is {}: choose a smaller object, or open wider",
            typed.opening.as_ref().map_or_else(String::new, |o| o.value.to_string())
        )));
        return None;
    }
    Some(Hand {
        lever,
        reduction: si(&typed.reduction)?,
        efficiency: si(&typed.efficiency).unwrap_or(1.0),
        non_backdrivable: typed.non_backdrivable.as_ref().is_some_and(|f| f.value),
        opening_m: si(&typed.opening),
        object_width_m: si(&typed.object_width).unwrap_or(0.0),
        object_n_per_m: si(&typed.object_stiffness),
        glove_n_per_m: si(&typed.glove_stiffness).unwrap_or(0.0),
        glove_friction_n: si(&typed.glove_friction).unwrap_or(0.0),
        inertia_kg_m2: si(&typed.inertia),
        force_n: si(&typed.force),
        speed_m_per_s: si(&typed.speed),
    })
}

pub(super) fn motor_of(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Motor> {
    spec.motor.present.as_ref()?;
    let typed = &spec.motor;
    let supply_v = si(&typed.supply)?;
    let ramp_s = si(&typed.ramp).unwrap_or(0.0);
    let profile = points(&typed.supply_profile, "the time", diagnostics);
    let supply = profile.unwrap_or_else(|| if ramp_s > 0.0 { vec![[0.0, 0.0], [ramp_s, supply_v]] } else { vec![[0.0, supply_v]] });
    if let Some([_, last_v]) = supply.last().filter(|[_, volts]| *volts <= 0.0) {
        let at = typed.supply_profile.as_ref().map_or_else(|| place_of(&spec.motor), |l| l.span);
        let error = Diagnostic::error("E0807", at, format!("the voltage ends at {last_v} V")).label("this profile");
        diagnostics.push(error.help("let it end above zero: the grasp is held with it"));
    }
    Some(Motor {
        resistance_ohm: si(&typed.resistance)?,
        constant_nm_per_a: si(&typed.torque_constant)?,
        inertia_kg_m2: si(&typed.inertia),
        no_load_a: si(&typed.no_load_current).unwrap_or(0.0),
        reduction: si(&typed.reduction).unwrap_or(1.0),
        efficiency: si(&typed.efficiency).unwrap_or(1.0),
        supply,
        limit_a: si(&typed.current_limit).unwrap_or(f64::INFINITY),
        max_rad_per_s: si(&typed.max_speed),
        battery: typed
            .battery
            .present
            .as_ref()
            .and_then(|_| Some(Battery { voltage_v: si(&typed.battery.voltage)?, charge_as: si(&typed.battery.charge)? })),
    })
}
