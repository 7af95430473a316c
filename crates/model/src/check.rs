//! Checks: a requirement or a rule, the value found, the limit, the margin, and what would mend it.

use forcewright_base::units::{Dimension, Unit};

/// The three ends of a check. Missing data is never silently assumed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckState {
    /// The value keeps the limit.
    Met,
    /// It does not.
    Missed,
    /// Something needed to tell is missing; the check's `reason` says what.
    NotAssessed,
}

impl CheckState {
    /// The word in result documents: `met`, `missed`, `not assessed`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Met => "met",
            Self::Missed => "missed",
            Self::NotAssessed => "not assessed",
        }
    }
}

/// On which side of the limit the value must lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// The value must not exceed the limit.
    AtMost,
    /// The value must not fall below the limit.
    AtLeast,
}

/// One check.
#[derive(Clone, Debug)]
pub struct Check {
    /// Stable code such as `COMP002`; `explain` knows it.
    pub code: &'static str,
    /// Stable name for scripts: `stress`, or the limited metric.
    pub name: String,
    /// For people: `Largest stress over the travel`.
    pub title: String,
    /// Whether the project file asks for it (it decides the exit code), or the family adds it by itself.
    pub required: bool,
    /// How it ended.
    pub state: CheckState,
    /// The value found, SI.
    pub value: Option<f64>,
    /// The limit, SI.
    pub limit: Option<f64>,
    /// Which side is good.
    pub sense: Sense,
    /// Quantity of value and limit.
    pub dimension: Dimension,
    /// The unit in which people are shown both.
    pub display: Unit,
    /// Relative distance to the limit, positive when met: (limit − value)/|limit| for [`Sense::AtMost`], the negative for
    /// [`Sense::AtLeast`]; (value − limit) over a scale named in `basis` where the limit is zero.
    pub margin: Option<f64>,
    /// The rule in words, with equation or source.
    pub basis: String,
    /// What would mend a miss, with numbers where they are known; or why it was not assessed.
    pub advice: Option<String>,
}

impl Check {
    /// Relative margin of a value to its limit, positive when met. `scale` replaces the limit's size where the limit is zero.
    pub fn margin_of(value: f64, limit: f64, sense: Sense, scale: f64) -> f64 {
        let size = if limit.abs() > 0.0 { limit.abs() } else { scale };
        let distance = match sense {
            Sense::AtMost => limit - value,
            Sense::AtLeast => value - limit,
        };
        distance / size
    }
}
