//! From a value and its limit to a check: what all families share.

use forcewright_base::units::{Dimension, Unit};
use forcewright_model::{Check, CheckState, Sense};

/// What a check compares, before its state is known.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Stable code.
    pub code: &'static str,
    /// Stable name for scripts.
    pub name: String,
    /// For people.
    pub title: String,
    /// Whether the project asks for it.
    pub required: bool,
    /// SI.
    pub value: Option<f64>,
    /// SI.
    pub limit: Option<f64>,
    /// Which side is good.
    pub sense: Sense,
    /// Quantity of both.
    pub dimension: Dimension,
    /// The unit in which people are shown both.
    pub display: Unit,
    /// Takes the place of the limit's size in the margin where the limit is zero; without it there is no margin then.
    pub scale: Option<f64>,
    /// The rule in words, with equation or source.
    pub basis: String,
    /// What would mend a miss.
    pub fix: String,
    /// Why it could not be assessed, where it could not.
    pub missing: String,
    /// Whether the value is that of a path that ends early: it can show a miss, but not that the limit is met.
    pub partial: bool,
    /// Whether the limit is broken although there is no value: what it is about falls without limit.
    pub broken: bool,
}

impl Comparison {
    /// The check.
    pub fn judge(self) -> Check {
        let (state, margin) = match (self.value, self.limit) {
            (Some(value), Some(limit)) => {
                let distance = Check::margin_of(value, limit, self.sense, self.scale.unwrap_or(1.0));
                let margin = (limit.abs() > 0.0 || self.scale.is_some()).then_some(distance);
                // Written so that a value that is not a number misses.
                let state = match distance >= 0.0 {
                    true if self.partial => CheckState::NotAssessed,
                    true => CheckState::Met,
                    false => CheckState::Missed,
                };
                (state, margin)
            }
            _ if self.broken => (CheckState::Missed, None),
            _ => (CheckState::NotAssessed, None),
        };
        // Nothing is said about a limit that the rest of the path may still break.
        let value = self.value.filter(|_| state != CheckState::NotAssessed);
        let margin = margin.filter(|_| state != CheckState::NotAssessed);
        let advice = match state {
            CheckState::Met => None,
            CheckState::Missed => Some(self.fix),
            CheckState::NotAssessed => Some(self.missing),
        };
        Check {
            code: self.code,
            name: self.name,
            title: self.title,
            required: self.required,
            state,
            value,
            limit: self.limit,
            sense: self.sense,
            dimension: self.dimension,
            display: self.display,
            margin,
            basis: self.basis,
            advice,
        }
    }
}
