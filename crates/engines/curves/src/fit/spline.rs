//! One cubic B-spline through points of a curve, twice continuously differentiable.
//!
//! The spline interpolates at places whose parameter is the length from the start, with the tangents of the curve at both ends (complete
//! cubic spline; C. de Boor, "A Practical Guide to Splines", chapter IV). By length the curve has speed 1, so the end slopes are the unit
//! tangents, and the error falls with the fourth power of the spacing (chapter V). The error is measured between the places, and the
//! places are spread anew until the measured error is within the tolerance: as densely as the fourth root of the error per span demands.

use super::{FitError, Oriented, check, length_of, nearest_on};
use crate::spline::Spline;
use crate::vector::{Vector, add, along, distance, scale, sub};

/// Chords per span by which its length is measured.
const LENGTHS: usize = 8;
/// Places per span at which the error is measured.
const PROBES: usize = 9;
const MOST_SPANS: usize = 2000;
const ROUNDS: usize = 16;
/// Part of the tolerance that new places aim at.
const AIM: f64 = 0.6;
/// Least ratio of the densities of neighbouring spans.
const GRADUAL: f64 = 0.75;

/// A spline and its measured distance from the curve.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedSpline {
    /// The spline, with knots from 0 to 1.
    pub spline: Spline,
    /// The largest distance from the curve that was found, m, at nine places per span.
    pub error_m: f64,
}

/// One clamped cubic B-spline, twice continuously differentiable, within a distance of a curve. It begins and ends on the curve, and in
/// its directions.
///
/// # Errors
/// [`FitError`].
pub fn spline(curve: &dyn Fn(f64) -> Oriented, tolerance_m: f64) -> Result<FittedSpline, FitError> {
    check(curve, tolerance_m)?;
    let mut places = first_places(curve);
    let mut error_m = f64::INFINITY;
    for _ in 0..ROUNDS {
        let spans = Spans::through(curve, &places);
        let errors = spans.errors(curve);
        if let Some(span) = errors.iter().position(|error| !error.is_finite()) {
            return Err(FitError::NotFinite { parameter: places[span] });
        }
        error_m = errors.iter().copied().fold(0.0, f64::max);
        if error_m <= tolerance_m {
            return Ok(FittedSpline { spline: spans.spline(), error_m });
        }
        places = spread(&places, &errors, tolerance_m);
        if places.len() > MOST_SPANS {
            break;
        }
    }
    Err(FitError::TooFine { pieces: places.len() - 1, error_m })
}

/// So many equal steps that the curve turns by about 45° in each.
fn first_places(curve: &dyn Fn(f64) -> Oriented) -> Vec<f64> {
    let samples: Vec<Oriented> = (0..=64).map(|k| curve(f64::from(k) / 64.0)).collect();
    let turn: f64 = samples.windows(2).map(|pair| crate::vector::angle(pair[0].tangent, pair[1].tangent).abs()).sum();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 64·π")]
    let count = (turn / 0.8).ceil().max(1.0) as usize;
    (0..=count).map(|k| k as f64 / count as f64).collect()
}

/// Places with the density that the errors of the spans ask for, changing gradually: errors are those of even spacing.
fn spread(places: &[f64], errors: &[f64], tolerance_m: f64) -> Vec<f64> {
    let mut wanted: Vec<f64> = errors.iter().map(|error| (error / (AIM * tolerance_m)).sqrt().sqrt().clamp(0.35, 8.0)).collect();
    for k in 1..wanted.len() {
        wanted[k] = wanted[k].max(GRADUAL * wanted[k - 1]);
    }
    for k in (1..wanted.len()).rev() {
        wanted[k - 1] = wanted[k - 1].max(GRADUAL * wanted[k]);
    }
    let total: f64 = wanted.iter().sum();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most eight per span")]
    let count = (total.ceil() as usize).max(errors.len() + errors.len() / 16 + 1);
    let mut spread = vec![0.0];
    let (mut span, mut before) = (0, 0.0);
    for k in 1..count {
        let target = total * k as f64 / count as f64;
        while span + 1 < wanted.len() && before + wanted[span] < target {
            before += wanted[span];
            span += 1;
        }
        let part = ((target - before) / wanted[span]).min(1.0);
        spread.push(places[span] + part * (places[span + 1] - places[span]));
    }
    spread.push(1.0);
    spread
}

/// An interpolating spline as points and slopes at its knots.
struct Spans {
    /// Parameters of the curve at the knots.
    places: Vec<f64>,
    /// Lengths from the start, m.
    knots: Vec<f64>,
    points: Vec<Vector>,
    /// By the length.
    slopes: Vec<Vector>,
}

impl Spans {
    fn through(curve: &dyn Fn(f64) -> Oriented, places: &[f64]) -> Self {
        let mut knots = vec![0.0];
        let mut points = vec![curve(places[0]).point_m];
        let mut last = curve(places[0]);
        for span in places.windows(2) {
            let mut length = 0.0;
            for k in 1..=LENGTHS {
                let next = curve(span[0] + (span[1] - span[0]) * k as f64 / LENGTHS as f64);
                length += length_of(&last, &next);
                last = next;
            }
            knots.push(knots[knots.len() - 1] + length);
            points.push(last.point_m);
        }
        let ends = [curve(places[0]).tangent, last.tangent];
        let slopes = slopes(&knots, &points, ends);
        Self { places: places.to_vec(), knots, points, slopes }
    }

    /// Largest distance from the curve in each span, m.
    fn errors(&self, curve: &dyn Fn(f64) -> Oriented) -> Vec<f64> {
        (0..self.knots.len() - 1)
            .map(|span| {
                let (start, end) = (self.places[span], self.places[span + 1]);
                let speed = (self.knots[span + 1] - self.knots[span]) / (end - start);
                let at = |k: usize| k as f64 / (PROBES + 1) as f64;
                (1..=PROBES)
                    .map(|k| nearest_on(curve, self.point(span, at(k)), start + (end - start) * at(k), speed).1)
                    .fold(0.0, |most, error| if error.is_nan() { f64::NAN } else { f64::max(most, error) })
            })
            .collect()
    }

    fn point(&self, span: usize, t: f64) -> Vector {
        let [constant, first, second, third] = self.powers(span);
        let x = t * (self.knots[span + 1] - self.knots[span]);
        along(constant, along(first, along(second, third, x), x), x)
    }

    /// Coefficients of the cubic by the powers of the length from the start of the span.
    fn powers(&self, span: usize) -> [Vector; 4] {
        let h = self.knots[span + 1] - self.knots[span];
        let (from, to) = (self.slopes[span], self.slopes[span + 1]);
        let chord = scale(sub(self.points[span + 1], self.points[span]), 1.0 / h);
        let second = scale(sub(scale(chord, 3.0), along(to, from, 2.0)), 1.0 / h);
        let third = scale(sub(add(from, to), scale(chord, 2.0)), 1.0 / (h * h));
        [self.points[span], from, second, third]
    }

    /// Control points are polar forms of the cubics at three knots in a row, any cubic that the control point acts on giving the same.
    fn spline(&self) -> Spline {
        let count = self.knots.len();
        let (end, total) = (count - 1, self.knots[count - 1]);
        let padded = |k: usize| self.knots[k.saturating_sub(3).min(end)];
        let mut control_m: Vec<Vector> = (0..count + 2)
            .map(|j| {
                let span = j.saturating_sub(1).min(end - 1);
                let [x, y, z] = [padded(j + 1), padded(j + 2), padded(j + 3)].map(|knot| knot - self.knots[span]);
                let [constant, first, second, third] = self.powers(span);
                let linear = along(constant, first, (x + y + z) / 3.0);
                along(along(linear, second, (x * y + y * z + z * x) / 3.0), third, x * y * z)
            })
            .collect();
        // The ends are those of the curve to the last bit.
        control_m[0] = self.points[0];
        control_m[count + 1] = self.points[end];
        Spline { control_m, knots: (0..count + 6).map(|k| padded(k) / total).collect() }
    }
}

/// Slopes of the complete cubic spline: continuity of the second derivative, a tridiagonal system that is diagonally dominant.
fn slopes(knots: &[f64], points: &[Vector], ends: [Vector; 2]) -> Vec<Vector> {
    let last = knots.len() - 1;
    let step = |k: usize| knots[k + 1] - knots[k];
    let chord = |k: usize| scale(sub(points[k + 1], points[k]), 1.0 / step(k));
    let mut slopes = vec![[0.0; 2]; knots.len()];
    (slopes[0], slopes[last]) = (ends[0], ends[1]);
    // Row k: h_k m_{k−1} + 2 (h_{k−1} + h_k) m_k + h_{k−1} m_{k+1} = 3 (h_k d_{k−1} + h_{k−1} d_k)
    let mut above = vec![0.0; knots.len()];
    for k in 1..last {
        let (before, after) = (step(k - 1), step(k));
        let pivot = 2.0 * (before + after) - after * above[k - 1];
        above[k] = before / pivot;
        let rhs = scale(add(scale(chord(k - 1), after), scale(chord(k), before)), 3.0);
        slopes[k] = scale(along(rhs, slopes[k - 1], -after), 1.0 / pivot);
    }
    for k in (1..last).rev() {
        slopes[k] = along(slopes[k], slopes[k + 1], -above[k]);
    }
    debug_assert!(distance(slopes[0], ends[0]) <= 0.0);
    slopes
}
