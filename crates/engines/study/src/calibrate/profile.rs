//! Intervals of the profile likelihood: how far a parameter goes before the others cannot make up for it.

use forcewright_base::roots;
use rayon::prelude::*;

use super::search::Problem;
use super::{Known, Limits, Settled, Weighting};
use crate::sampling::Interval;

/// Times that the first step is doubled in search of the other side of the threshold.
const DOUBLINGS: usize = 14;
/// Rounds of the search of all others, which begins where the last one ended.
const MOST_ROUNDS: usize = 60;
/// Accuracy of an end, over the standard error.
const CLOSE: f64 = 1e-3;
/// A standard error beyond which a parameter is not known at all, over its scale.
const UNKNOWN: f64 = 1e6;

/// An interval per parameter: the values at which the squares, all others fitted anew, exceed their least by no more than
/// `t²` times the noise squared. D. M. Bates & D. G. Watts, "Nonlinear Regression Analysis and Its Applications", Wiley 1988, section 6.1.
/// Weights of the points stay as they are.
pub(super) fn intervals(weighting: &Weighting<'_>, settled: &Settled, known: &Known, t: f64) -> Vec<Option<Interval>> {
    let one = |parameter: usize| {
        let lower = end(weighting, settled, known, (parameter, -1.0), t);
        let upper = end(weighting, settled, known, (parameter, 1.0), t);
        lower.zip(upper).map(|(low, high)| Interval { low, high })
    };
    (0..weighting.parameters.len()).into_par_iter().map(one).collect()
}

/// The end on one side; the bound if that comes first, infinite if nothing ever speaks against more.
fn end(weighting: &Weighting<'_>, settled: &Settled, known: &Known, (parameter, side): (usize, f64), t: f64) -> Option<f64> {
    let place = &settled.found.place;
    let (best, own) = (place.x[parameter], weighting.parameters[parameter].clone());
    let bound = if side < 0.0 { own.limits.lower } else { own.limits.upper };
    // With robust weights the noise is not that of the weighted squares: where all is linear, the interval is Student's.
    let threshold = known.free.iter().position(|i| *i == parameter).map_or(t * t * known.noise * known.noise, |k| {
        let m = known.free.len();
        let ratio = known.unit[k * m + k] / known.weighted[k * m + k];
        t * t * known.noise * known.noise * if ratio.is_finite() { ratio } else { 1.0 }
    });
    let roots: Vec<f64> = settled.weights.iter().map(|w| w.sqrt()).collect();
    let priors = weighting.priors(settled.noise);
    let mut room = weighting.model.room();
    let mut last = place.x.clone();
    let mut excess = |value: f64| -> f64 {
        let mut limits = weighting.limits.to_vec();
        limits[parameter] = Limits { lower: value, upper: value };
        let mut start = last.clone();
        start[parameter] = value;
        let (model, measured, sizes) = (weighting.model, weighting.measured.y, weighting.sizes);
        let problem = Problem { model, measured, roots: &roots, priors: &priors, limits: &limits, sizes, rounds: MOST_ROUNDS };
        match problem.search(&start, &mut room, &mut |_, _| true) {
            Ok(found) => {
                last.clone_from(&found.place.x);
                found.place.squares - place.squares - threshold
            }
            // Where there is no curve, it cannot be.
            Err(_) => threshold.max(f64::MIN_POSITIVE),
        }
    };
    let error = known.errors[parameter];
    let mut step = if error.is_finite() && error > 0.0 { t * error } else { own.scale * 1e-2 };
    let tolerance = CLOSE * step;
    let (mut inside, mut outside) = (best, best + side * step);
    for _ in 0..DOUBLINGS {
        let beyond = if side < 0.0 { outside <= bound } else { outside >= bound };
        if beyond {
            outside = bound;
        }
        if excess(outside) > 0.0 {
            return roots::root(|v| if v.to_bits() == best.to_bits() { -threshold } else { excess(v) }, inside, outside, tolerance).ok();
        }
        if beyond {
            return Some(bound);
        }
        if (outside - best).abs() > UNKNOWN * own.scale {
            break;
        }
        inside = outside;
        step *= 2.0;
        outside = best + side * step;
    }
    // No end was found within anything that makes sense: the bound, if there is one, or none.
    Some(bound)
}
