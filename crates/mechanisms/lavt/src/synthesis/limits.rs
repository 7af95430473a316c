//! Which limit blocks: for each the nearest value at which, all others as they are, there is a design.
//!
//! With one limit left out, the best that the others leave of it is that value: one pass over the grid for each.

use forcewright_base::maths::{log10, powf};
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::synthesis::Relaxation;

use super::asked::Asked;
use super::gears::{Book, Class, Sound, classes, wall_m};
use forcewright_contract::synthesis::Watch;

use super::search::{Column, long_m, running, walk};
use super::springs::Factors;
use crate::sizes::outer_m;

/// A limit that can be loosened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Knob {
    Transition,
    TransitionMost,
    Output,
    SpeedDrop,
    Efficiency,
    Safety,
    Stress,
    Diameter,
    Length,
    /// The least friction.
    Friction,
}

/// What a value is kept inside by before it is rounded: more than the search keeps limits by.
const INSIDE: f64 = 1e-6;
/// Digits of a value.
const DIGITS: i32 = 4;

impl Knob {
    pub(super) const ALL: [Self; 10] = [
        Self::Transition,
        Self::TransitionMost,
        Self::Output,
        Self::SpeedDrop,
        Self::Efficiency,
        Self::Safety,
        Self::Stress,
        Self::Diameter,
        Self::Length,
        Self::Friction,
    ];

    /// Path, name, dimension and unit.
    pub(super) fn named(self) -> (&'static str, &'static str, Dimension, &'static str) {
        use Dimension as D;
        match self {
            Self::Transition => ("requirements.transition_torque.min", "least transition torque", D::Torque, "N*mm"),
            Self::TransitionMost => ("requirements.transition_torque.max", "largest transition torque", D::Torque, "N*mm"),
            Self::Output => ("requirements.output_torque.min", "output torque", D::Torque, "N*mm"),
            Self::SpeedDrop => ("requirements.speed_drop.max", "speed drop", D::Ratio, ""),
            Self::Efficiency => ("requirements.efficiency.min", "efficiency", D::Ratio, "%"),
            Self::Safety => ("requirements.safety_factor", "safety factor", D::Ratio, ""),
            Self::Stress => ("synthesise.stress_max", "stress of the wire", D::Stress, "MPa"),
            Self::Diameter => ("synthesise.envelope.diameter", "diameter", D::Length, "mm"),
            Self::Length => ("synthesise.envelope.length", "length", D::Length, "mm"),
            Self::Friction => ("synthesise.friction", "friction", D::Ratio, ""),
        }
    }

    /// Where the limit is in what is asked; `None` where there is none, or none that may be loosened.
    pub(super) fn now(self, asked: &Asked) -> Option<f64> {
        let value = match self {
            Self::Transition => asked.transition_nm[0],
            Self::TransitionMost => asked.transition_nm[1],
            Self::Output => asked.output_nm,
            Self::SpeedDrop => asked.speed_drop,
            Self::Efficiency => asked.efficiency,
            Self::Safety => asked.safety - 1.0,
            Self::Stress => asked.stress_pa,
            Self::Diameter => asked.envelope_m[0],
            Self::Length => asked.envelope_m[1],
            // One range for hub and bore.
            Self::Friction if asked.friction.map(f64::to_bits)[0] != asked.friction.map(f64::to_bits)[1] => 0.0,
            Self::Friction => asked.friction_half[0],
        };
        (value > 0.0 && value.is_finite()).then(|| match self {
            Self::Safety => asked.safety,
            Self::Friction => asked.frictions()[0][0],
            _ => value,
        })
    }

    /// Whether more of it asks more: the value is then the most that there is.
    fn at_most(self) -> bool {
        matches!(self, Self::Transition | Self::Output | Self::Efficiency | Self::Safety)
    }

    /// What is asked with another value of the limit.
    pub(super) fn with(self, asked: &Asked, value: f64) -> Asked {
        let mut other = asked.clone();
        match self {
            Self::Transition => other.transition_nm[0] = value,
            Self::TransitionMost => other.transition_nm[1] = value,
            Self::Output => other.output_nm = value,
            Self::SpeedDrop => other.speed_drop = value,
            Self::Efficiency => other.efficiency = value,
            Self::Safety => other.safety = value.max(1.0),
            Self::Stress => other.stress_pa = value,
            Self::Diameter => other.envelope_m[0] = value,
            Self::Length => other.envelope_m[1] = value,
            Self::Friction => {
                let most = asked.frictions()[2][0];
                other.friction = [0.5 * (value.min(most) + most); 2];
                other.friction_half = [0.5 * (most - value).max(0.0); 2];
            }
        }
        other
    }

    /// What is asked without the limit.
    fn freed(self, asked: &Asked) -> Asked {
        let value = match self {
            Self::Transition | Self::Output | Self::Efficiency => 0.0,
            Self::Safety => 1.0,
            Self::Friction => asked.frictions()[2][0],
            _ => f64::INFINITY,
        };
        self.with(asked, value)
    }

    /// The best that a column leaves of the limit.
    fn best(self, asked: &Asked, class: &Class, sets: &[Sound], column: &Column<'_>, factors: &Factors) -> f64 {
        let seat = column.seat;
        let output_nm = || class.driven_nm - seat.most_hub_nm * factors.slip[2][column.hub];
        match self {
            Self::Transition => class.mode_1_nm(seat.transitions_nm[0]),
            Self::TransitionMost => class.mode_1_nm(seat.transitions_nm[1]),
            Self::Output => output_nm(),
            Self::SpeedDrop => 1.0 / class.ratio,
            Self::Efficiency => class.ratio * output_nm() / asked.input_nm,
            Self::Safety => seat.safety,
            Self::Stress => seat.stress_pa,
            Self::Diameter => {
                let outer =
                    |sound: &Sound| outer_m(sound.ring_root_m, seat.bore_m, wall_m(asked, class.module), asked.template.making.chassis_m);
                sets.iter().map(outer).fold(f64::INFINITY, f64::min)
            }
            Self::Length => long_m(asked, class, seat, [column.hub, column.bore[0]]),
            Self::Friction => {
                let [hub, bore] = [factors.exponents[0][column.hub], factors.exponents[1][column.bore[1] - 1]];
                asked.frictions()[0][0] * seat.friction_left(class.needed_nm, hub, bore)
            }
        }
    }
}

/// The nearest value of a limit with which there is a design, all others as they are; `None` where there is none, or the search is ended.
pub(super) fn nearest(asked: &Asked, knob: Knob, book: &Book, watch: Watch<'_>) -> Option<f64> {
    knob.now(asked)?;
    let free = knob.freed(asked);
    let (classes, _) = classes(&free, book, &|| watch(0.0));
    let factors = Factors::new(&free);
    let mut sets: Vec<Option<Vec<Sound>>> = vec![None; classes.len()];
    let worst = if knob.at_most() { f64::NEG_INFINITY } else { f64::INFINITY };
    let mut best = worst;
    let (_, whole) = walk(&free, &classes, watch, |column| {
        let class = &classes[column.class];
        let running = sets[column.class].get_or_insert_with(|| running(&free, book, class).0);
        if !running.is_empty() {
            let value = knob.best(&free, class, running, column, &factors);
            best = if knob.at_most() { best.max(value) } else { best.min(value) };
        }
        true
    });
    (whole && best.is_finite() && best > 0.0).then_some(best)
}

/// A value loosened by a part, rounded away from the limit.
pub(super) fn loosened(knob: Knob, nearest: f64, slack: f64) -> f64 {
    let value = if knob.at_most() { nearest * (1.0 - INSIDE) / (1.0 + slack) } else { nearest * (1.0 + INSIDE) * (1.0 + slack) };
    let place = powf(10.0, log10(value).floor() + 1.0 - f64::from(DIGITS));
    let steps = value / place;
    (if knob.at_most() { steps.floor() } else { steps.ceil() }) * place
}

/// A loosened limit in words.
pub(super) fn relaxation(asked: &Asked, knob: Knob, value: f64) -> Option<Relaxation> {
    let (key, name, dimension, symbol) = knob.named();
    let unit = Unit::parse(symbol).unwrap_or_else(|_| Unit::si(dimension));
    let range = |asked: &Asked| format!("{} ± {}", format_number(asked.friction[0], 6), format_number(asked.friction_half[0], 6));
    let shown = |x: f64, asked: &Asked| match knob {
        Knob::Friction => range(asked),
        Knob::SpeedDrop | Knob::Safety => format_number(x, 6),
        _ => format_si(x, &unit, 6),
    };
    let other = knob.with(asked, value);
    if knob == Knob::Friction && other.friction_half[0] <= 0.0 {
        return None;
    }
    let text = shown(value, &other);
    let bare = matches!(knob, Knob::SpeedDrop | Knob::Safety);
    let quoted = if bare { text.clone() } else { format!("\"{text}\"") };
    Some(Relaxation { key, name, value: quoted, now: shown(knob.now(asked)?, asked), text, at_most: knob.at_most() })
}
