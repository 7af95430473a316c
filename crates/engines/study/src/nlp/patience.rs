//! When going on is no longer worth what it costs.

use std::collections::VecDeque;

/// Iterations over which a gain is looked at.
const GAINING: usize = 10;
/// Programmes in a row whose prediction is too little.
const PREDICTING: usize = 3;
/// Iterations over which the violation must fall …
const REPAIRING: usize = 6;
/// … to this part of what it was.
const REPAIRED: f64 = 0.9;

/// What the last iterations brought.
#[derive(Debug, Default)]
pub(super) struct Patience {
    /// The best objective after each of the last iterations with a point that satisfies the constraints, the oldest first.
    objectives: VecDeque<f64>,
    /// Predictions in a row that were too little.
    meagre: usize,
    /// The least sum of violations after each of the last iterations without such a point.
    violations: VecDeque<f64>,
}

impl Patience {
    /// Whether the last iterations have gained less than `least`, or the last programmes predicted less.
    pub(super) fn settled(&mut self, best: f64, predicted: f64, least: f64) -> bool {
        self.meagre = if predicted < least { self.meagre + 1 } else { 0 };
        let before = pushed(&mut self.objectives, best, GAINING);
        self.meagre >= PREDICTING || before.is_some_and(|before| before - best < least)
    }

    /// Whether the last iterations have hardly lowered the sum of violations.
    pub(super) fn hopeless(&mut self, sum: f64) -> bool {
        let least = self.violations.back().map_or(sum, |least| sum.min(*least));
        pushed(&mut self.violations, least, REPAIRING).is_some_and(|before| least > REPAIRED * before)
    }
}

/// Adds a value to the last ones; what it was so many values before.
fn pushed(recent: &mut VecDeque<f64>, value: f64, count: usize) -> Option<f64> {
    recent.push_back(value);
    if recent.len() > count { recent.pop_front() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of calls until a rule says that it is enough.
    fn calls(mut enough: impl FnMut(i32) -> bool) -> Option<i32> {
        (0..100).find(|&k| enough(k)).map(|k| k + 1)
    }

    /// Objectives that fall by 1 at each iteration gain 10 over ten of them.
    #[test]
    fn gains_are_summed_over_ten_iterations() {
        let after = |least: f64| {
            let mut patience = Patience::default();
            calls(|k| patience.settled(-f64::from(k), f64::INFINITY, least))
        };
        assert_eq!(after(10.0), None);
        assert_eq!(after(10.5), Some(11));
    }

    #[test]
    fn meagre_predictions_count_in_a_row() {
        let after = |predicted: fn(i32) -> f64| {
            let mut patience = Patience::default();
            calls(|k| patience.settled(-f64::from(k), predicted(k), 1.0))
        };
        assert_eq!(after(|_| 0.5), Some(3));
        assert_eq!(after(|k| if k % 3 == 2 { 2.0 } else { 0.5 }), None);
    }

    /// 0.98⁶ = 0.886 < 0.9 < 0.915 = 0.985⁶. A violation that rises between does no harm.
    #[test]
    fn a_violation_must_fall_by_a_tenth_in_six_iterations() {
        let after = |ratio: f64| {
            let mut patience = Patience::default();
            calls(|k| patience.hopeless(forcewright_base::maths::powi(ratio, k) * if k % 2 == 1 { 5.0 } else { 1.0 }))
        };
        assert_eq!(after(0.98), None);
        assert_eq!(after(0.985), Some(7));
    }
}
