//! Bounded nonlinear least squares: Levenberg and Marquardt with an active set.

use super::linear::Triangle;
use super::{Limits, Model};
use crate::evaluator::{Evaluation, Failure, Workspace};

/// Rounds of a search.
pub(super) const MOST_ROUNDS: usize = 2000;
/// Damping of the first step, over the squares of the columns.
const FIRST_DAMPING: f64 = 1e-3;
/// Least and largest damping: below, it is lost in rounding; above, no step is left.
const LEAST_DAMPING: f64 = 1e-22;
const MOST_DAMPING: f64 = 1e12;
/// Part of the squares that a whole step of Gauss and Newton would still take: its root is the largest cosine between the residuals and
/// the tangents, and parameters are then wrong by that part of their standard errors, about.
const AT_REST: f64 = 1e-19;
/// Where no step finds less, which is as near as rounding of the model or kinks of its curve let come: the distance from the optimum of the
/// tangents, in standard errors, root mean square over the parameters. D. M. Bates & D. G. Watts, "Nonlinear Regression Analysis and Its
/// Applications", Wiley 1988, section 2.2.3, call it the relative offset.
const NEARLY_AT_REST: f64 = 0.2;
/// Longest step of a parameter, over its own size or what is a large change of it: a longer one may end where the curve has forgotten it.
const LONGEST: f64 = 1.0;
/// Residuals that are the rounding of what was measured.
const EXACT: f64 = 4.0 * f64::EPSILON;

/// How a search ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stop {
    /// No step within the bounds makes the squares smaller, and the tangents promise next to nothing.
    Converged,
    /// Steps find nothing smaller though the tangents promise it, or a profile does though steps did not: the model is not smooth, or its
    /// derivatives are wrong or missing.
    Stalled,
    /// More rounds than are useful.
    RoundLimit,
    /// It was told to stop.
    Interrupted,
    /// The model has no values where the search begins.
    NoStart(Failure),
}

/// What is asked of a search.
pub(super) struct Problem<'a> {
    pub(super) model: &'a dyn Model,
    pub(super) measured: &'a [f64],
    /// Root of the weight of each point.
    pub(super) roots: &'a [f64],
    /// What a parameter is held near to, with the weight of the root: `(p − first) · second` is a residual.
    pub(super) priors: &'a [Option<[f64; 2]>],
    pub(super) limits: &'a [Limits],
    /// What is a large change of each parameter.
    pub(super) sizes: &'a [f64],
    /// Rounds after which it ends.
    pub(super) rounds: usize,
}

/// A place of the search, with what the model does there.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub(super) x: Vec<f64>,
    /// Model and, row by row, its derivatives, unweighted.
    pub(super) out: Evaluation,
    /// Weighted squares with those of the priors.
    pub(super) squares: f64,
}

/// Result of a search.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub(super) place: Place,
    pub(super) stop: Stop,
    pub(super) rounds: usize,
}

impl Problem<'_> {
    fn evaluate(&self, x: &[f64], derivatives: bool, room: &mut Workspace) -> Result<Place, Failure> {
        let mut out = Evaluation::default();
        self.model.predict(x, derivatives, room, &mut out)?;
        if out.values.len() != self.measured.len() || out.values.iter().chain(&out.jacobian).any(|v| !v.is_finite()) {
            return Err(Failure { reason: "the model has no finite values there".to_owned() });
        }
        let squares = self.residuals(&out, x).iter().map(|r| r * r).sum();
        Ok(Place { x: x.to_vec(), out, squares })
    }

    /// Weighted residuals, model less measured, and those of the priors.
    fn residuals(&self, out: &Evaluation, x: &[f64]) -> Vec<f64> {
        let points = out.values.iter().zip(self.measured).zip(self.roots).map(|((v, m), w)| w * (v - m));
        let held = self.priors.iter().zip(x).filter_map(|(prior, x)| prior.map(|[at, root]| (x - at) * root));
        points.chain(held).collect()
    }

    /// The tangent problem at a place.
    fn tangent(&self, place: &Place) -> Triangle {
        let n = place.x.len();
        let mut rows = Vec::with_capacity(place.out.jacobian.len() + n * n);
        for (row, root) in place.out.jacobian.chunks_exact(n.max(1)).zip(self.roots) {
            rows.extend(row.iter().map(|d| d * root));
        }
        for (j, prior) in self.priors.iter().enumerate() {
            if let Some([_, root]) = prior {
                rows.extend((0..n).map(|k| if j == k { *root } else { 0.0 }));
            }
        }
        Triangle::of(n, &rows, &self.residuals(&place.out, &place.x))
    }

    /// Squares of what was measured, weighted: what rounding is compared with.
    fn size(&self) -> f64 {
        self.measured.iter().zip(self.roots).map(|(m, w)| w * m * w * m).sum()
    }

    /// Goes from `x` to a place where the squares are smallest. `watch` is told rounds and squares and says whether to go on.
    pub(super) fn search(&self, x: &[f64], room: &mut Workspace, watch: &mut dyn FnMut(usize, f64) -> bool) -> Result<Found, Failure> {
        let start: Vec<f64> = x.iter().zip(self.limits).map(|(x, l)| x.clamp(l.lower, l.upper)).collect();
        let mut place = self.evaluate(&start, true, room)?;
        let mut sizes = vec![0.0_f64; start.len()];
        let (mut damping, mut harder) = (FIRST_DAMPING, 2.0);
        for rounds in 0..self.rounds {
            if !watch(rounds, place.squares) {
                return Ok(Found { place, stop: Stop::Interrupted, rounds });
            }
            let tangent = self.tangent(&place);
            sizes.iter_mut().zip(tangent.norms()).for_each(|(size, norm)| *size = size.max(norm));
            let scales: Vec<f64> = sizes.iter().map(|s| if *s > 0.0 { *s } else { 1.0 }).collect();
            let far: Vec<f64> = place.x.iter().zip(self.sizes).map(|(x, size)| LONGEST * x.abs().max(*size)).collect();
            let low: Vec<f64> = (0..far.len()).map(|i| (self.limits[i].lower - place.x[i]).max(-far[i])).collect();
            let high: Vec<f64> = (0..far.len()).map(|i| (self.limits[i].upper - place.x[i]).min(far[i])).collect();
            let step = |damping: f64| {
                let each: Vec<f64> = scales.iter().map(|s| damping.sqrt() * s).collect();
                tangent.bounded(&each, &low, &high)
            };
            // Of the whole step, however long: a valley that ends far away is no end.
            let bound = |of: fn(&Limits) -> f64| -> Vec<f64> { self.limits.iter().zip(&place.x).map(|(l, x)| of(l) - x).collect() };
            let each: Vec<f64> = scales.iter().map(|s| LEAST_DAMPING.sqrt() * s).collect();
            let whole = tangent.bounded(&each, &bound(|l| l.lower), &bound(|l| l.upper));
            let left = tangent.gain(&whole) / place.squares.max(f64::MIN_POSITIVE);
            if left <= AT_REST || place.squares <= EXACT * EXACT * self.size() {
                return Ok(Found { place, stop: Stop::Converged, rounds });
            }
            let mut first = true;
            loop {
                // A try may cost as much as a round. From its least to its most, damping grows in 15 of them.
                if !first && !watch(rounds, place.squares) {
                    return Ok(Found { place, stop: Stop::Interrupted, rounds });
                }
                first = false;
                let change = step(damping);
                let next: Vec<f64> =
                    place.x.iter().zip(&change).zip(self.limits).map(|((x, d), l)| (x + d).clamp(l.lower, l.upper)).collect();
                let promised = tangent.gain(&change);
                let tried = self.evaluate(&next, false, room).ok().filter(|t| t.squares < place.squares);
                if let Some(better) = tried.filter(|_| promised > 0.0) {
                    // Derivatives fail only where the values' neighbours do: then the search stays outside, and the try has failed.
                    if let Ok(whole) = self.evaluate(&better.x, true, room) {
                        let kept = (place.squares - better.squares) / promised;
                        // H. B. Nielsen, "Damping parameter in Marquardt's method", IMM-REP-1999-05, DTU 1999, eq. (2.5).
                        let cube = 2.0 * kept - 1.0;
                        damping = (damping * (1.0 - cube * cube * cube).max(1.0 / 3.0)).max(LEAST_DAMPING);
                        harder = 2.0;
                        place = whole;
                        break;
                    }
                }
                damping *= harder;
                harder *= 2.0;
                if damping > MOST_DAMPING {
                    let parameters = place.x.len() as f64;
                    let free = (self.measured.len() as f64 - parameters).max(1.0);
                    let near = left * free / parameters <= NEARLY_AT_REST * NEARLY_AT_REST;
                    let stop = if near { Stop::Converged } else { Stop::Stalled };
                    return Ok(Found { place, stop, rounds });
                }
            }
        }
        Ok(Found { place, stop: Stop::RoundLimit, rounds: self.rounds })
    }
}
