//! Which limit blocks: for each the nearest value at which, all others as they are, something is found.

use std::cell::Cell;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::synthesis::{Relaxation, Watch};

use super::sizing::{Asked, search};

/// A limit that can be loosened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Knob {
    Torque,
    Stiffness,
    LostMotion,
    Safety,
    /// Of the envelope.
    Side(usize),
}

/// How far a limit is loosened at most.
const FARTHEST: f64 = 16.0;
/// Halvings of that, to better than a per cent.
const HALVINGS: u32 = 9;

impl Knob {
    pub(super) const ALL: [Self; 7] =
        [Self::Stiffness, Self::LostMotion, Self::Safety, Self::Torque, Self::Side(0), Self::Side(1), Self::Side(2)];

    /// Path, name, dimension and unit.
    fn named(self) -> (&'static str, &'static str, Dimension, &'static str) {
        match self {
            Self::Torque => ("requirements.torque", "torque", Dimension::Torque, "N*m"),
            Self::Stiffness => ("requirements.stiffness.min", "stiffness", Dimension::RotationalStiffness, "N*m/rad"),
            Self::LostMotion => ("requirements.lost_motion.max", "lost motion", Dimension::Angle, "deg"),
            Self::Safety => ("requirements.safety_factor", "safety factor", Dimension::Ratio, ""),
            Self::Side(0) => ("synthesise.envelope.diameter", "diameter", Dimension::Length, "mm"),
            Self::Side(1) => ("synthesise.envelope.width", "width", Dimension::Length, "mm"),
            Self::Side(_) => ("synthesise.envelope.length", "length", Dimension::Length, "mm"),
        }
    }

    fn of(self, asked: &mut Asked) -> &mut f64 {
        match self {
            Self::Torque => &mut asked.torque_nm,
            Self::Stiffness => &mut asked.stiffness_nm_per_rad,
            Self::LostMotion => &mut asked.lost_motion_rad,
            Self::Safety => &mut asked.safety,
            Self::Side(i) => &mut asked.envelope_m[i.min(2)],
        }
    }

    /// Whether less of it is easier.
    fn at_most(self) -> bool {
        matches!(self, Self::Torque | Self::Stiffness | Self::Safety)
    }
}

/// What is asked, with a limit loosened by a factor above one; `None` where there is no such limit.
pub(super) fn loosened(asked: &Asked, knob: Knob, factor: f64) -> Option<Asked> {
    let mut other = asked.clone();
    let value = knob.of(&mut other);
    if *value == 0.0 || value.is_infinite() || (knob == Knob::Safety && *value <= 1.0) {
        return None;
    }
    *value = if knob.at_most() { *value / factor } else { *value * factor };
    if knob == Knob::Safety {
        *value = value.max(1.0);
    }
    Some(other)
}

/// The least factor by which a limit must be loosened; `None` where it does not help, nothing need be loosened, or it was interrupted.
pub(super) fn factor(asked: &Asked, knob: Knob, watch: Watch<'_>) -> Option<f64> {
    let tried = Cell::new(0);
    let interrupted = Cell::new(false);
    let helps = |factor: f64| {
        let before = f64::from(tried.replace(tried.get() + 1));
        // Searches of one limit, nearly all of the same length.
        let part = |part: f64| watch((before + part) / (2.0 + f64::from(HALVINGS)));
        loosened(asked, knob, factor).is_some_and(|other| {
            let found = search(&other, 1, &part);
            interrupted.set(interrupted.get() || found.interrupted);
            !found.sizes.is_empty()
        })
    };
    if helps(1.0) || !helps(FARTHEST) {
        return None;
    }
    let (mut low, mut high) = (1.0, FARTHEST);
    for _ in 0..HALVINGS {
        let middle: f64 = (low * high).sqrt();
        if interrupted.get() {
            return None;
        }
        if helps(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    (!interrupted.get()).then_some(high)
}

/// A limit loosened by a factor, in words.
pub(super) fn relaxation(asked: &Asked, knob: Knob, factor: f64) -> Option<Relaxation> {
    let (key, name, dimension, symbol) = knob.named();
    let unit = Unit::parse(symbol).unwrap_or_else(|_| Unit::si(dimension));
    let shown = |x: f64| if knob == Knob::Safety { format_number(x, 4) } else { format_si(x, &unit, 4) };
    let mut other = loosened(asked, knob, factor)?;
    let text = shown(*knob.of(&mut other));
    let value = if knob == Knob::Safety { text.clone() } else { format!("\"{text}\"") };
    Some(Relaxation { key, name, value, now: shown(*knob.of(&mut asked.clone())), text, at_most: knob.at_most() })
}
