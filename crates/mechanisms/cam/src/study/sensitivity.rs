//! What each tolerance of the file does by itself: the analysis with one number at either end of its `±`, on the cam as it was cut.

use forcewright_base::diagnostics::Diagnostics;
use forcewright_base::units::format_si;
use forcewright_contract::numbers::{Number, numbers_of};
use forcewright_contract::studies::{Free, Purpose};

use super::knobs::{Knobs, SEED};
use crate::analysis::{Behaviour, Measured, measure};
use crate::cut::SIDES;
use crate::design::Design;
use crate::path::SidePath;
use crate::spec::Spec;

/// Intervals of the stroke and of the window; two of the latter per panel of Simpson's rule.
const INTERVALS: usize = 80;
/// Parts of the file whose `±` is scatter of making.
const ROOTS: [&str; 3] = ["design.", "material.", "errors."];

/// The numbers of a file with a `±` that change the force.
#[derive(Clone, Debug)]
pub(crate) struct Scatter {
    knobs: Knobs,
    /// Each with its words: `springs.rest_length ± 0.3 mm`.
    labels: Vec<String>,
    /// Lower and upper end, SI.
    ends: Vec<[f64; 2]>,
}

/// What one of them does.
#[derive(Clone, Debug)]
pub(crate) struct Effect {
    /// The number with its tolerance.
    pub label: String,
    /// Change of the mean of the forces up and down at the lower and the upper end, N.
    pub mean_n: [f64; 2],
    /// Change of the largest relative deviation of the force.
    pub deviation: [f64; 2],
}

impl Scatter {
    /// `None` if nothing in the file has a `±` that changes the force.
    pub(crate) fn of(spec: &mut Spec) -> Option<Self> {
        let numbers = numbers_of(spec);
        let known = |number: &Number| {
            let [lower, upper] = number.tolerance?.deviations_si(number.si)?;
            // Which profile is drawn has no ends.
            let rooted = ROOTS.iter().any(|root| number.path.starts_with(root)) && number.path != SEED;
            let free = Free { number: number.clone(), lower: number.range.min, upper: number.range.max };
            // A number that a study cannot change is no cause here; a study that names it says why.
            let usable = Knobs::new(spec, std::slice::from_ref(&free), Purpose::Scatter, &mut Diagnostics::default()).is_some();
            (rooted && usable && upper > lower).then_some((free, [lower, upper]))
        };
        let (free, deviations): (Vec<Free>, Vec<[f64; 2]>) = numbers.iter().filter_map(known).unzip();
        if free.is_empty() {
            return None;
        }
        let knobs = Knobs::new(spec, &free, Purpose::Scatter, &mut Diagnostics::default())?;
        let labels = free.iter().zip(&deviations).map(|(f, d)| label(&f.number, *d)).collect();
        let ends = free.iter().zip(&deviations).map(|(f, d)| d.map(|d| f.number.si + d)).collect();
        Some(Self { knobs, labels, ends })
    }

    /// Effects in the order of the file; a value is not a number where the mechanism does not reach the end of its stroke.
    pub(crate) fn effects(&self, design: &Design, behaviour: &Behaviour) -> Vec<Effect> {
        let nominal: Vec<f64> = self.knobs.variables.iter().map(|v| v.nominal).collect();
        let paths = &behaviour.mechanism.paths;
        let at = |x: &[f64]| {
            let mut changed = design.clone();
            self.knobs.apply(x, &mut changed);
            forces(&changed, paths, behaviour.window_m)
        };
        let [mean, deviation] = at(&nominal);
        let one = |(i, label): (usize, &String)| {
            let ends = self.ends[i].map(|end| {
                let mut x = nominal.clone();
                x[i] = end;
                at(&x)
            });
            Effect { label: label.clone(), mean_n: ends.map(|e| e[0] - mean), deviation: ends.map(|e| e[1] - deviation) }
        };
        self.labels.iter().enumerate().map(one).collect()
    }
}

/// Mean of the forces up and down, N, and their largest relative deviation from what is required; without a requirement half the width of
/// the band that they need.
fn forces(design: &Design, paths: &[SidePath; SIDES], window_m: [f64; 2]) -> [f64; 2] {
    let behaviour = Behaviour::sampled(design, paths, window_m, INTERVALS, INTERVALS);
    let measured: Measured = measure(design, &behaviour);
    let get = |name: &str| measured.get(name).unwrap_or(f64::NAN);
    let deviation = measured.get("force_deviation").unwrap_or_else(|| get("force_spread"));
    [f64::midpoint(get("force_up_mean"), get("force_down_mean")), deviation]
}

fn label(number: &Number, [lower, upper]: [f64; 2]) -> String {
    let path = number.path.strip_prefix("design.").unwrap_or(&number.path);
    let shown = |si: f64| format_si(si, &number.unit, 3);
    if lower.to_bits() == (-upper).to_bits() {
        format!("{path} ± {}", shown(upper))
    } else {
        format!("{path} {} to {}", shown(lower), shown(upper))
    }
}
