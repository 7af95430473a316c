//! From a value and its limit to a check: what all families share.

use forcewright_base::units::{Dimension, Unit};
use forcewright_model::{Check, CheckState, Sense};

use crate::metrics::{Limit, Metrics, Values};

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
    /// What is asked of a metric: value, quantity and meaning are its own, the limit and what would mend a miss are still open. `missing`
    /// is why a design may lack it; a metric that the family does not have is not assessed, and said so.
    pub fn of_metric<M: Metrics>(
        code: &'static str,
        [name, title]: [&str; 2],
        metric: &str,
        measured: &Values<M>,
        display: impl FnOnce(usize) -> Unit,
        missing: String,
    ) -> Self {
        let index = M::ALL.iter().position(|m| m.name == metric);
        let info = index.map(|i| &M::ALL[i]);
        let dimension = info.map_or(Dimension::Ratio, |m| m.dimension);
        Self {
            code,
            name: name.to_owned(),
            title: title.to_owned(),
            required: true,
            value: index.and_then(|i| measured.value(i)),
            limit: None,
            sense: Sense::AtMost,
            dimension,
            display: index.map_or_else(|| Unit::si(dimension), display),
            scale: None,
            basis: info.map_or_else(String::new, |m| m.doc.to_owned()),
            fix: String::new(),
            missing: if info.is_some() { missing } else { format!("there is no metric `{metric}`") },
            partial: false,
            broken: false,
        }
    }

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

/// Checks of limits on metrics, lower bounds before upper ones. `base` makes the comparison of a metric from the name and a title.
pub fn limited<M: Metrics>(limits: &[Limit], fix: &str, base: impl Fn(&'static str, &str) -> Comparison) -> Vec<Check> {
    let mut all = Vec::new();
    for limit in limits {
        let name = limit.name::<M>();
        for (bound, sense, suffix) in [(limit.min, Sense::AtLeast, "at least"), (limit.max, Sense::AtMost, "at most")] {
            if bound.is_some() {
                let base = base(name, &format!("{name} ({suffix})"));
                all.push(Comparison { limit: bound, sense, fix: fix.to_owned(), ..base }.judge());
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::{MetricInfo, metric};

    #[derive(Debug, Default)]
    struct Two;

    impl Metrics for Two {
        const ALL: &'static [MetricInfo] =
            &[metric("length", Dimension::Length, true, "How long."), metric("part", Dimension::Ratio, true, "How much.")];
    }

    fn of(metric: &str) -> Comparison {
        let mut measured = Values::<Two>::none();
        measured.set("length", 0.25);
        Comparison::of_metric("X001", [metric, "Title"], metric, &measured, |i| Unit::si(Two::ALL[i].dimension), "not measured".to_owned())
    }

    #[test]
    fn a_metric_is_judged_as_itself_and_an_unknown_one_is_not() {
        let check = Comparison { limit: Some(0.2), fix: "cut".to_owned(), ..of("length") }.judge();
        assert_eq!((check.state, check.dimension, check.advice.as_deref()), (CheckState::Missed, Dimension::Length, Some("cut")));
        let check = Comparison { limit: Some(0.2), ..of("lenght") }.judge();
        assert_eq!((check.state, check.value), (CheckState::NotAssessed, None));
        assert_eq!(check.advice.as_deref(), Some("there is no metric `lenght`"));
    }

    #[test]
    fn both_bounds_of_a_limit_are_checks() {
        let limit = Limit { metric: 0, min: Some(0.1), max: Some(0.2), unit: Unit::si(Dimension::Length) };
        let found = limited::<Two>(&[limit], "cut", |name, title| Comparison { title: title.to_owned(), ..of(name) });
        let told: Vec<_> = found.iter().map(|c| (c.title.as_str(), c.sense, c.state)).collect();
        let expected = [("length (at least)", Sense::AtLeast, CheckState::Met), ("length (at most)", Sense::AtMost, CheckState::Missed)];
        assert_eq!(told, expected);
    }
}
