//! Intervals of the profile likelihood: how far a parameter goes before the others cannot make up for it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use forcewright_base::roots;
use rayon::prelude::*;

use super::search::Problem;
use super::{Known, Limits, Progress, Settled, Watch, Weighting};
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
/// Weights of the points stay as they are. And whether all were looked for: `watch` may have stopped them.
pub(super) fn intervals(
    weighting: &Weighting<'_>,
    settled: &Settled,
    known: &Known,
    t: f64,
    watch: Watch<'_>,
) -> (Vec<Option<Interval>>, bool) {
    let asked = Asked::new(watch, 2 * weighting.parameters.len());
    let one = |parameter: usize| {
        let lower = end(weighting, settled, known, (parameter, -1.0), t, &asked)?;
        let upper = end(weighting, settled, known, (parameter, 1.0), t, &asked)?;
        Some(Interval { low: lower, high: upper })
    };
    let found = (0..weighting.parameters.len()).into_par_iter().map(one).collect();
    (found, !asked.stopped())
}

/// Whether to go on, asked by several threads.
struct Asked<'a> {
    watch: Mutex<(Watch<'a>, usize)>,
    of: usize,
    stopped: AtomicBool,
}

impl<'a> Asked<'a> {
    fn new(watch: Watch<'a>, of: usize) -> Self {
        Self { watch: Mutex::new((watch, 0)), of, stopped: AtomicBool::new(false) }
    }

    fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Tells of so many ends more, and asks whether to go on. Once stopped, nobody is asked again.
    fn go_on(&self, more: usize) -> bool {
        if self.stopped() {
            return false;
        }
        let mut watch = self.watch.lock().unwrap_or_else(PoisonError::into_inner);
        watch.1 += more;
        let progress = Progress::Intervals { found: watch.1, of: self.of };
        let on = (watch.0)(progress);
        if !on {
            self.stopped.store(true, Ordering::Relaxed);
        }
        on
    }
}

/// The end on one side; the bound if that comes first, infinite if nothing ever speaks against more. `None` if it was stopped.
fn end(weighting: &Weighting<'_>, settled: &Settled, known: &Known, which: (usize, f64), t: f64, asked: &Asked<'_>) -> Option<f64> {
    let found = looked_for(weighting, settled, known, which, t, asked);
    // What was found after a stop is made of searches that did not end.
    found.filter(|_| asked.go_on(1))
}

fn looked_for(
    weighting: &Weighting<'_>,
    settled: &Settled,
    known: &Known,
    (parameter, side): (usize, f64),
    t: f64,
    asked: &Asked<'_>,
) -> Option<f64> {
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
        match problem.search(&start, &mut room, &mut |_, _| asked.go_on(0)) {
            // Of no use any more: the search for the end comes to its own at once.
            Ok(_) if asked.stopped() => threshold,
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
