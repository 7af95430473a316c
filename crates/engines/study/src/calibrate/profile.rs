//! Intervals of the profile likelihood: how far a parameter goes before the others cannot make up for it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use forcewright_base::roots;
use rayon::prelude::*;

use super::search::{Problem, Stop};
use super::{Known, Limits, Progress, Settled, Watch, Weighting};
use crate::sampling::Interval;

/// Times that the first step is doubled in search of the other side of the threshold.
const DOUBLINGS: usize = 14;
/// Accuracy of an end, over the standard error.
const CLOSE: f64 = 1e-3;
/// Part of the threshold by which squares are really less than those of the optimum: rounding and kinks of the model make less.
const LESS: f64 = 0.1;
/// Steps that all searches for one end try together, each a curve or two; and where tangents know nothing, so that most have no end.
const MOST_STEPS: usize = 1000;
const MOST_STEPS_UNKNOWN: usize = 200;

/// What was looked for.
pub(super) struct Profiles {
    /// Of each parameter; `None` where it was stopped, or where the squares are less somewhere than at what was taken for the optimum.
    pub(super) intervals: Vec<Option<Interval>>,
    /// Whether all were looked for: `watch` may have stopped them.
    pub(super) whole: bool,
    /// Where the squares are least, if less than at what was taken for the optimum.
    pub(super) better: Option<Vec<f64>>,
}

/// An interval per parameter: the values at which the squares, all others fitted anew, exceed their least by no more than
/// `t²` times the noise squared. D. M. Bates & D. G. Watts, "Nonlinear Regression Analysis and Its Applications", Wiley 1988, section 6.1.
/// Weights of the points stay as they are. What [`MOST_STEPS`] do not find is left open: an interval is rather too wide.
pub(super) fn intervals(weighting: &Weighting<'_>, settled: &Settled, known: &Known, t: f64, watch: Watch<'_>) -> Profiles {
    let asked = Asked::new(watch, 2 * weighting.parameters.len());
    let roots: Vec<f64> = settled.weights.iter().map(|w| w.sqrt()).collect();
    let priors = weighting.priors(settled.noise);
    let about = About { weighting, settled, known, t, asked: &asked, roots: &roots, priors: &priors };
    let one = |parameter: usize| match about.end(parameter, -1.0) {
        End::At(low) => match about.end(parameter, 1.0) {
            End::At(high) => (Some(Interval { low, high }), None),
            End::Stopped => (None, None),
            End::Better(squares, x) => (None, Some((squares, x))),
        },
        End::Stopped => (None, None),
        End::Better(squares, x) => (None, Some((squares, x))),
    };
    let found: Vec<(Option<Interval>, Better)> = (0..weighting.parameters.len()).into_par_iter().map(one).collect();
    let (intervals, better): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    let better = better.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, x)| x);
    Profiles { intervals, whole: !asked.stopped(), better }
}

/// Squares that are less than those of the optimum, and where.
type Better = Option<(f64, Vec<f64>)>;

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

/// What became of the search for an end.
enum End {
    /// There; the bound if that comes first, infinite if nothing ever speaks against more or none was found.
    At(f64),
    /// Told to stop.
    Stopped,
    /// Squares that are less than those of the optimum, and where.
    Better(f64, Vec<f64>),
}

/// The optimum about which ends are looked for.
struct About<'a, 'b> {
    weighting: &'a Weighting<'b>,
    settled: &'a Settled,
    known: &'a Known,
    t: f64,
    asked: &'a Asked<'b>,
    roots: &'a [f64],
    priors: &'a [Option<[f64; 2]>],
}

impl About<'_, '_> {
    /// The end on one side.
    fn end(&self, parameter: usize, side: f64) -> End {
        let open = self.known.errors[parameter].is_infinite();
        let mut profile = Profile {
            about: self,
            parameter,
            threshold: self.threshold(parameter),
            last: self.settled.found.place.x.clone(),
            left: if open { MOST_STEPS_UNKNOWN } else { MOST_STEPS },
            better: None,
        };
        let found = profile.looked_for(side);
        if let Some((squares, x)) = profile.better {
            return End::Better(squares, x);
        }
        // What was found after a stop is made of searches that did not end.
        if self.asked.go_on(1) { End::At(found) } else { End::Stopped }
    }

    /// By how much the squares may exceed their least. With robust weights the noise is not that of the weighted squares: where all is
    /// linear, the interval is Student's.
    fn threshold(&self, parameter: usize) -> f64 {
        let (known, plain) = (self.known, self.t * self.t * self.known.noise * self.known.noise);
        known.free.iter().position(|i| *i == parameter).map_or(plain, |k| {
            let m = known.free.len();
            let ratio = known.unit[k * m + k] / known.weighted[k * m + k];
            plain * if ratio.is_finite() { ratio } else { 1.0 }
        })
    }
}

/// The squares over one parameter, all others fitted anew.
struct Profile<'a, 'b, 'c> {
    about: &'a About<'b, 'c>,
    parameter: usize,
    threshold: f64,
    /// Where the last search ended: the next begins there.
    last: Vec<f64>,
    /// Steps that are left.
    left: usize,
    better: Better,
}

impl Profile<'_, '_, '_> {
    /// Whether nothing more is to be looked for.
    fn done(&self) -> bool {
        self.left == 0 || self.better.is_some() || self.about.asked.stopped()
    }

    /// The squares with the parameter at a value, less their least and the threshold; `None` if that is not known.
    fn excess(&mut self, value: f64) -> Option<f64> {
        if self.done() {
            return None;
        }
        let About { weighting, asked, settled, .. } = self.about;
        let mut limits = weighting.limits.to_vec();
        limits[self.parameter] = Limits { lower: value, upper: value };
        self.last[self.parameter] = value;
        let (model, measured, sizes) = (weighting.model, weighting.measured.y, weighting.sizes);
        let (roots, priors) = (self.about.roots, self.about.priors);
        let problem = Problem { model, measured, roots, priors, limits: &limits, sizes, rounds: MOST_STEPS };
        let left = &mut self.left;
        let found = problem.search(&self.last, &mut weighting.model.room(), &mut |_, _| {
            *left = left.saturating_sub(1);
            *left > 0 && asked.go_on(0)
        });
        let Ok(found) = found else {
            // Where there is no curve, it cannot be.
            return Some(self.threshold.max(f64::MIN_POSITIVE));
        };
        let (place, best) = (found.place, settled.found.place.squares);
        self.last.clone_from(&place.x);
        if place.squares < best - LESS * self.threshold && !asked.stopped() {
            self.better = Some((place.squares, place.x));
            return None;
        }
        let excess = place.squares - best - self.threshold;
        // Squares that are less than the threshold need no end of the search.
        (found.stop != Stop::Interrupted || excess <= 0.0).then_some(excess)
    }

    fn looked_for(&mut self, side: f64) -> f64 {
        let own = &self.about.weighting.parameters[self.parameter];
        let best = self.about.settled.found.place.x[self.parameter];
        let (scale, bound) = (own.scale, if side < 0.0 { own.limits.lower } else { own.limits.upper });
        let error = self.about.known.errors[self.parameter];
        let mut step = if error.is_finite() && error > 0.0 { self.about.t * error } else { scale * 1e-2 };
        let tolerance = CLOSE * step;
        let (mut inside, mut outside) = (best, best + side * step);
        for _ in 0..DOUBLINGS {
            let beyond = if side < 0.0 { outside <= bound } else { outside >= bound };
            if beyond {
                outside = bound;
            }
            match self.excess(outside) {
                Some(excess) if excess > 0.0 => return self.between(inside, outside, excess, tolerance),
                Some(_) if !beyond => {}
                _ => return bound,
            }
            inside = outside;
            step *= 2.0;
            outside = best + side * step;
        }
        // No end was found within anything that makes sense: the bound, if there is one, or none.
        bound
    }

    /// The end between two values; if it is not found, the outer one of those that it is known to lie between.
    fn between(&mut self, inside: f64, outside: f64, first: f64, tolerance: f64) -> f64 {
        let (mut outer, best) = (outside, self.about.settled.found.place.x[self.parameter]);
        let threshold = self.threshold;
        let found = roots::root(
            |value| {
                if value.to_bits() == best.to_bits() {
                    return -threshold;
                }
                if value.to_bits() == outside.to_bits() {
                    return first;
                }
                match self.excess(value) {
                    Some(excess) => {
                        if excess > 0.0 && (value - best).abs() < (outer - best).abs() {
                            outer = value;
                        }
                        excess
                    }
                    // Of no use any more: the search for the end comes to its own at once.
                    None => 0.0,
                }
            },
            inside,
            outside,
            tolerance,
        );
        if self.done() { outer } else { found.unwrap_or(outer) }
    }
}
