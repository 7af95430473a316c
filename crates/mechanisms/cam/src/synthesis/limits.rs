//! Which limit blocks: for each the nearest value at which, all others as they are, something is found.

use forcewright_base::units::{Unit, format_number, format_si};
use forcewright_contract::synthesis::Relaxation;

use super::picked;
use super::sizing::Asked;

/// A limit that can be loosened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Knob {
    Hysteresis,
    Band,
    Stroke,
    Room,
}

/// How far a limit is loosened at most.
const FARTHEST: f64 = 8.0;
/// Halvings of that, to better than a per cent.
const HALVINGS: usize = 9;

impl Knob {
    pub(super) const ALL: [Self; 4] = [Self::Hysteresis, Self::Band, Self::Stroke, Self::Room];
}

/// What is asked, with a limit loosened by a factor above one; `None` where there is no such limit.
fn loosened(asked: &Asked, knob: Knob, factor: f64) -> Option<Asked> {
    let mut other = asked.clone();
    match knob {
        Knob::Hysteresis => other.hysteresis = Some(asked.hysteresis? * factor),
        Knob::Band => other.band = (asked.band * factor).min(0.9),
        Knob::Stroke => {
            other.stroke_m = asked.stroke_m / factor;
            other.window_m = asked.window_m.map(|w| w.map(|s| s / factor));
        }
        Knob::Room => {
            if asked.room_m.iter().all(|side| side.is_infinite()) {
                return None;
            }
            other.room_m = asked.room_m.map(|side| side * factor);
        }
    }
    Some(other)
}

/// The least loosening that helps, a little more by `slack`, and what is asked then.
pub(super) fn relaxed(asked: &Asked, knob: Knob, slack: f64, length: &Unit) -> Option<(Relaxation, Asked)> {
    let helps = |factor: f64| loosened(asked, knob, factor).is_some_and(|other| !picked(&other, 1).is_empty());
    // Where sizes are found without loosening, this limit does not block: what misses is seen by the analysis only.
    if helps(1.0) || !helps(FARTHEST) {
        return None;
    }
    let (mut low, mut high) = (1.0, FARTHEST);
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        if helps(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    let factor = high * (1.0 + slack);
    let other = loosened(asked, knob, factor)?;
    let percent = |x: f64| format!("{} %", format_number(100.0 * x, 3));
    let shown = |x: f64| format_si(x, length, 4);
    let quoted = |text: &str| format!("\"{text}\"");
    let room = |r: [f64; 2]| format!("{} × {}", shown(r[0]), shown(r[1]));
    let (key, name, value, text, now, at_most) = match knob {
        Knob::Hysteresis => {
            let new = percent(other.hysteresis?);
            ("requirements.hysteresis", "hysteresis", quoted(&new), new, percent(asked.hysteresis?), false)
        }
        Knob::Band => {
            ("requirements.force.band", "force band", quoted(&percent(other.band)), percent(other.band), percent(asked.band), false)
        }
        Knob::Stroke => {
            let new = shown(other.stroke_m);
            ("requirements.stroke", "stroke", quoted(&new), new, shown(asked.stroke_m), true)
        }
        Knob::Room => {
            let sides = other.room_m.map(|s| quoted(&shown(s)));
            ("synthesise.room", "room", format!("[{}, {}]", sides[0], sides[1]), room(other.room_m), room(asked.room_m), false)
        }
    };
    Some((Relaxation { key, name, value, text, now, at_most }, other))
}
