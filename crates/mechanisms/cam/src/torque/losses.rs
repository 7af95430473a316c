//! What takes the work of a cycle, rollers or guides, and what would keep its limit: every advice was computed.

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_model::{Check, CheckState};

use super::analysis::Behaviour;
use super::design::Design;
use crate::analysis::moments;
use crate::mechanism::Sense;

/// Steps towards the largest friction that keeps the limit; the hysteresis is nearly straight in it.
const STEPS: usize = 8;
/// What is named is a little less than what was found: no more than three digits are shown.
const ROUNDING: f64 = 0.995;

/// Gives CAM004, where it is missed, the advice that fits a torque cam.
pub(super) fn advise(design: &Design, behaviour: &Behaviour, checks: &mut [Check]) {
    for check in checks.iter_mut().filter(|c| c.code == "CAM004" && c.state == CheckState::Missed) {
        check.advice = check.limit.map(|limit| Losses { design, behaviour, limit }.advice()).or(check.advice.take());
    }
}

struct Losses<'a> {
    design: &'a Design,
    behaviour: &'a Behaviour,
    limit: f64,
}

impl Losses<'_> {
    /// Difference of the means over the mean, with parts of the rolling friction and of that of the guides.
    fn hysteresis(&self, [rolling, guide]: [f64; 2]) -> f64 {
        let mut mechanism = self.behaviour.mechanism.clone();
        mechanism.arm_m = self.design.built.arm_m * rolling;
        mechanism.guide_friction = self.design.built.guide_friction * guide;
        let mean = |sense| moments(&self.behaviour.window, |s| mechanism.at_rest(&s.pose, sense).torque_nm)[0];
        (mean(Sense::Up) - mean(Sense::Down)) / mean(Sense::Frictionless)
    }

    /// The largest part, below one, of what `parts` scales that keeps the limit; `None` where none above a hundredth does.
    fn largest(&self, parts: impl Fn(f64) -> [f64; 2]) -> Option<f64> {
        let least = self.hysteresis(parts(0.0));
        let (mut part, mut found) = (1.0, self.hysteresis(parts(1.0)));
        for _ in 0..STEPS {
            part *= (self.limit - least) / (found - least);
            if !(0.01..=1.0).contains(&part) {
                return None;
            }
            found = self.hysteresis(parts(ROUNDING * part));
            if found <= self.limit {
                return Some(ROUNDING * part);
            }
        }
        None
    }

    fn advice(&self) -> String {
        let built = &self.design.built;
        let guides = self.hysteresis([0.0, 1.0]);
        let mm = Unit::parse("mm").unwrap_or_else(|_| Unit::si(Dimension::Length));
        let arm = |part: f64| format!("an arm of the rolling resistance of {}", format_si(part * built.arm_m, &mm, 3));
        let guide = |part: f64| format!("a `guide_friction` of {}", format_number(part * built.guide_friction, 3));
        let share = match (built.arm_m > 0.0, built.guide_friction > 0.0) {
            (_, false) => "all of it is rolling friction".to_owned(),
            (false, true) => "all of it is friction of the guides".to_owned(),
            (true, true) => format!("the guides alone take {} %", format_number(100.0 * guides, 3)),
        };
        let mut ways = Vec::new();
        if built.arm_m > 0.0
            && let Some(part) = self.largest(|p| [p, 1.0])
        {
            ways.push(arm(part));
            ways.extend(self.rollers(part));
        }
        if built.guide_friction > 0.0
            && let Some(part) = self.largest(|p| [1.0, p])
        {
            ways.push(guide(part));
        }
        if ways.is_empty()
            && let Some(part) = self.largest(|p| [p, p])
        {
            ways.push(format!("only less of both does, such as {} with {}", arm(part), guide(part)));
        }
        match ways.as_slice() {
            [] => format!("{share}; even a hundredth of the friction is too much"),
            [one] if one.starts_with("only") => format!("{share}: {one}"),
            _ => format!("{share}: {} keeps the limit", ways.join(", or ")),
        }
    }

    /// Larger rollers with the same arm, where they leave the cam whole and its outline closed.
    fn rollers(&self, part: f64) -> Option<String> {
        let mut other = self.design.clone();
        for radius_m in [&mut other.cut_roller_m, &mut other.built.roller_m] {
            *radius_m /= part;
        }
        let whole = super::Mechanism::corner_of(&self.behaviour.mechanism.cut, other.cut_roller_m).is_none();
        let fits = whole && super::room::closes(&other);
        fits.then(|| format!("rollers of {} with the same arm", format_si(2.0 * other.cut_roller_m, &self.design.units.length, 4)))
    }
}
