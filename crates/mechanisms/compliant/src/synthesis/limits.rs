//! Which limit blocks: each one loosened alone, as little as lets something be sized.

use forcewright_base::maths;
use forcewright_base::units::{Unit, format_number, format_si};
use forcewright_contract::synthesis::Relaxation;

use super::Synthesis;
use super::section::{MOST_LAYERS, MOST_PLATES, MOST_ROWS};
use super::sizing::{Asked, Windows, sizes};
use crate::design::StressLimit;

/// A limit that can be loosened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Knob {
    /// A shorter stroke.
    Travel,
    /// More room, both sides alike.
    Room,
    /// A smaller safety factor, or a larger stress.
    Stress,
    /// A wider band.
    Band,
    /// A lower level.
    LessForce,
    /// A higher level.
    MoreForce,
    /// Thicker plates.
    DepthMax,
    /// Thinner plates.
    DepthMin,
    /// More plates.
    Plates,
    /// More rows.
    Rows,
    /// More layers in series.
    Layers,
    /// Thinner beams.
    Thickness,
    /// A least stiffness below zero.
    Slope,
}

/// The most that a limit is loosened, as a factor.
const MOST: f64 = 30.0;
/// Widest band.
const WIDEST: f64 = 0.25;
/// Factor of the first steps, and to what part of itself the nearest value is found.
const STEP: f64 = 1.25;
const NEAR: f64 = 2e-3;
/// What is left in hand, for the corrections of the full analysis and for rounding.
const IN_HAND: f64 = 0.01;
/// Digits of a value for people.
const DIGITS: i32 = 3;

impl Knob {
    /// All, in the order in which they are told.
    pub(super) const ALL: [Self; 13] = [
        Self::Travel,
        Self::Room,
        Self::Stress,
        Self::Band,
        Self::LessForce,
        Self::MoreForce,
        Self::DepthMax,
        Self::DepthMin,
        Self::Plates,
        Self::Rows,
        Self::Layers,
        Self::Thickness,
        Self::Slope,
    ];
}

impl Synthesis {
    /// What is asked for with one limit loosened by a factor above 1; `None` where it cannot be.
    fn loosened(&self, knob: Knob, factor: f64) -> Option<Asked> {
        let asked = self.asked;
        Some(match knob {
            Knob::Travel => Asked { stroke_m: asked.stroke_m / factor, ..asked },
            Knob::Room if asked.room_m[0].is_finite() => Asked { room_m: asked.room_m.map(|side| side * factor), ..asked },
            Knob::Stress => {
                // Never beyond yield, and not where no more is asked for than that.
                let most = match self.stress? {
                    StressLimit::Yield => return None,
                    StressLimit::SafetyFactor(_) => self.yield_pa?,
                    StressLimit::Stress(_) => self.yield_pa.unwrap_or(f64::INFINITY),
                };
                let (strain, stress_pa) = (asked.strain * factor, asked.stress_pa.map(|s| s * factor));
                (strain * asked.young_pa <= most * (1.0 + NEAR)).then_some(Asked { strain, stress_pa, ..asked })?
            }
            Knob::Band => (asked.band * factor <= WIDEST).then_some(Asked { band: asked.band * factor, ..asked })?,
            Knob::LessForce => Asked { nominal_n: Some(asked.nominal_n? / factor), ..asked },
            Knob::MoreForce => Asked { nominal_n: Some(asked.nominal_n? * factor), ..asked },
            Knob::DepthMax => Asked { depth_max_m: asked.depth_max_m * factor, ..asked },
            Knob::DepthMin => Asked { depth_min_m: Some(asked.depth_min_m? / factor), ..asked },
            Knob::Plates => Asked { plates: more(asked.plates, factor, MOST_PLATES)?, ..asked },
            Knob::Rows => Asked { rows: more(asked.rows, factor, MOST_ROWS)?, ..asked },
            Knob::Layers => Asked { layers: more(asked.layers, factor, MOST_LAYERS)?, ..asked },
            Knob::Thickness => Asked { thickness_min_m: asked.thickness_min_m / factor, ..asked },
            Knob::Slope => {
                // In parts of level over stroke: a force that falls by the band over the stroke.
                let slope = asked.nominal_n? * asked.band / asked.stroke_m;
                let [least, most] = asked.stiffness_n_per_m;
                Asked { stiffness_n_per_m: [least.min(0.0) - slope * (factor - 1.0), most], ..asked }
            }
            Knob::Room => return None,
        })
    }

    fn feasible(&self, knob: Knob, factor: f64) -> Option<Asked> {
        let asked = self.loosened(knob, factor)?;
        let own = (knob == Knob::Band).then(|| Windows::of(asked.band));
        (!sizes(&asked, own.as_ref().unwrap_or(&self.windows)).is_empty()).then_some(asked)
    }

    /// The nearest value of a limit at which something can be sized, and what is asked for then. `slack` loosens it further.
    pub(super) fn relaxed(&self, knob: Knob, slack: f64) -> Option<(Relaxation, Asked)> {
        let (mut blocked, mut free) = (1.0, None);
        let mut factor = STEP;
        while factor <= MOST && free.is_none() {
            if self.feasible(knob, factor).is_some() {
                free = Some(factor);
            } else {
                (blocked, factor) = (factor, factor * STEP);
            }
        }
        // The last step may have gone past the end of the range: the end itself counts.
        let mut free = free.or_else(|| self.end(knob).filter(|end| *end > blocked && self.feasible(knob, *end).is_some()))?;
        while free / blocked > 1.0 + NEAR {
            let middle = maths::powf(free * blocked, 0.5);
            if self.feasible(knob, middle).is_some() { free = middle } else { blocked = middle }
        }
        let wanted = free * (1.0 + IN_HAND + slack);
        let factor = if self.loosened(knob, wanted).is_some() { wanted } else { self.end(knob)?.max(free) };
        let asked = self.loosened(knob, factor)?;
        Some((self.told(knob, &asked), asked))
    }

    /// The factor at the end of a limit's range, where it has one.
    fn end(&self, knob: Knob) -> Option<f64> {
        match knob {
            Knob::Stress => Some(self.yield_pa? / self.allowed_pa),
            Knob::Band => Some(WIDEST / self.asked.band),
            Knob::Plates => Some(f64::from(MOST_PLATES) / f64::from(self.asked.plates)),
            Knob::Rows => Some(f64::from(MOST_ROWS) / f64::from(self.asked.rows)),
            Knob::Layers => Some(f64::from(MOST_LAYERS) / f64::from(self.asked.layers)),
            _ => None,
        }
        .filter(|end| *end > 1.0)
    }

    /// A loosened limit in words and as it stands in a file.
    fn told(&self, knob: Knob, asked: &Asked) -> Relaxation {
        let (down, up) = (f64::floor as fn(f64) -> f64, f64::ceil as fn(f64) -> f64);
        let quantity = |key, name, si: f64, now: Option<f64>, unit: &Unit, how: fn(f64) -> f64| {
            let text = format_si(unit.to_si(rounded(unit.from_si(si), how)), unit, 6);
            let now = now.map_or_else(String::new, |now| format_si(now, unit, 4));
            Relaxation { key, name, value: format!("\"{text}\""), text, now, at_most: how(0.5) < 0.5 }
        };
        let (length, force) = (&self.length, &self.force);
        let percent = Unit::parse("%").unwrap_or_else(|_| length.clone());
        match knob {
            Knob::Travel => quantity("requirements.travel", "stroke", asked.stroke_m, Some(self.asked.stroke_m), length, down),
            Knob::Room => {
                let sides = asked.room_m.map(|side| format_si(length.to_si(rounded(length.from_si(side), up)), length, 6));
                let now = self.asked.room_m.map(|side| format_si(side, length, 4)).join(" × ");
                let value = format!("[\"{}\", \"{}\"]", sides[0], sides[1]);
                Relaxation { key: "synthesise.room", name: "room", value, text: sides.join(" × "), now, at_most: false }
            }
            Knob::Stress => {
                if let (Some(StressLimit::SafetyFactor(now)), Some(yield_pa)) = (self.stress, self.yield_pa) {
                    let factor = rounded(yield_pa / (asked.strain * asked.young_pa), down).max(1.0);
                    let (key, text, now) = ("requirements.stress.safety_factor", format_number(factor, 6), format_number(now, 4));
                    return Relaxation { key, name: "safety factor", value: text.clone(), text, now, at_most: true };
                }
                let mpa = Unit::parse("MPa").unwrap_or_else(|_| length.clone());
                quantity("requirements.stress.max", "stress", asked.strain * asked.young_pa, Some(self.allowed_pa), &mpa, up)
            }
            Knob::Band => quantity("requirements.force.band", "band", asked.band, Some(self.asked.band), &percent, up),
            Knob::LessForce | Knob::MoreForce => {
                let how = if knob == Knob::LessForce { down } else { up };
                quantity("requirements.force.nominal", "force", asked.nominal_n.unwrap_or(0.0), self.asked.nominal_n, force, how)
            }
            Knob::DepthMax => {
                quantity("synthesise.depth.max", "largest depth", asked.depth_max_m, Some(self.asked.depth_max_m), length, up)
            }
            Knob::DepthMin => {
                let [min, now] = [asked.depth_min_m, self.asked.depth_min_m];
                quantity("synthesise.depth.min", "smallest depth", min.unwrap_or(0.0), now, length, down)
            }
            Knob::Plates => count("synthesise.plates", "plates", asked.plates, self.asked.plates),
            Knob::Rows => count("synthesise.rows", "rows", asked.rows, self.asked.rows),
            Knob::Layers => count("synthesise.series", "layers in series", asked.layers, self.asked.layers),
            Knob::Thickness => {
                let now = Some(self.asked.thickness_min_m);
                quantity("synthesise.thickness_min", "thinnest beam", asked.thickness_min_m, now, length, down)
            }
            Knob::Slope => {
                let unit = Unit::parse(&format!("{}/{}", force.symbol(), length.symbol())).unwrap_or_else(|_| force.clone());
                let [least, now] = [asked.stiffness_n_per_m[0], self.asked.stiffness_n_per_m[0]];
                Relaxation { at_most: true, ..quantity("requirements.stiffness.min", "least stiffness", least, Some(now), &unit, down) }
            }
        }
    }
}

/// A larger number of copies, if that many are allowed.
fn more(count: u32, factor: f64, most: u32) -> Option<u32> {
    let wanted = (f64::from(count) * factor).ceil();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most `most`")]
    (wanted <= f64::from(most)).then_some(wanted as u32)
}

/// A number of copies in words and as it stands in a file.
fn count(key: &'static str, name: &'static str, wanted: u32, now: u32) -> Relaxation {
    let text = wanted.to_string();
    Relaxation { key, name, value: text.clone(), text, now: now.to_string(), at_most: false }
}

/// To [`DIGITS`] digits.
fn rounded(value: f64, how: fn(f64) -> f64) -> f64 {
    let place = maths::log10(value.abs()).floor();
    if !place.is_finite() {
        return value;
    }
    #[allow(clippy::cast_possible_truncation, reason = "the decimal exponent of a double")]
    let shift = DIGITS - 1 - place as i32;
    let ten = |n: i32| maths::powi(10.0, n);
    if shift >= 0 { how(value * ten(shift)) / ten(shift) } else { how(value / ten(-shift)) * ten(-shift) }
}
