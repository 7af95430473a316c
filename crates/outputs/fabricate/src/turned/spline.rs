//! Helices and what they sweep as splines of degree 5.
//!
//! Points of a plane are complex numbers. A point of the profile runs along `w·c(z)` with `c(z) = exp(i·winding·z)`; a segment of the
//! profile at z = 0 is a curve `w(u)`. With splines for `c` and `w`, the products of their control points are those of the surface, and
//! heights are those of a straight line: edges lie on the surface to rounding. The distance from the true surface is at most
//! |w|·|error of c| + |error of w|.

use std::f64::consts::TAU;

use forcewright_base::dense::Lu;
use forcewright_base::maths;

use crate::shape::Point;

pub(crate) const DEGREE: usize = 5;
/// Largest distance between a true surface and what stands for it, from each of the two causes, mm.
const ERROR: f64 = 5e-8;
/// Most spans of a segment of a profile.
const MOST_SPANS: usize = 400;

/// Product of two complex numbers.
pub(super) fn product(a: Point, b: Point) -> Point {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// The means of the knots of each control point over `spans` spans between the knots 0, 1, 2, …: where a straight line has them.
pub(super) fn places(spans: usize) -> Vec<f64> {
    let knot = |k: usize| k.saturating_sub(DEGREE).min(spans) as f64;
    (0..spans + DEGREE).map(|m| (1..=DEGREE).map(|k| knot(m + k)).sum::<f64>() / DEGREE as f64).collect()
}

/// Spans of a spline that follows `exp(iφ)` over an angle closely enough at a radius, mm.
///
/// With n spans in a turn, the spline that is right at its knots differs by less than 2.1·((n − 1)⁻⁶ + (n + 1)⁻⁶): of the Fourier series of
/// its deviation only the two nearest aliases count (see the test).
pub(super) fn spans_of_turn(angle: f64, radius: f64) -> usize {
    let is_close = |n: f64| 2.1 * (maths::powi(n - 1.0, -6) + maths::powi(n + 1.0, -6)) * radius <= ERROR;
    let mut per_turn = 6.0;
    while !is_close(per_turn) {
        per_turn += 1.0;
    }
    count(per_turn * angle.abs() / TAU)
}

/// At least one.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive number")]
pub(super) fn count(spans: f64) -> usize {
    spans.ceil().max(1.0) as usize
}

/// Control points of a spline through `exp(iφ)` for φ from 0 to `angle` over equal spans, right at each knot.
///
/// On equally spaced knots, `exp(iωj)` as control points give `exp(iωx)` times the real number that is taken out here at the knots
/// (Schoenberg's exponential Euler splines, Cardinal Spline Interpolation, 1973); ends are made by blossoming.
pub(super) fn turn(angle: f64, spans: usize) -> Vec<Point> {
    let step = angle / spans as f64;
    let scale = (66.0 + 52.0 * maths::cos(step) + 2.0 * maths::cos(2.0 * step)) / 120.0;
    let (last, degree) = (spans as f64, DEGREE as f64);
    let inner = |place: f64| {
        let (sin, cos) = maths::sin_cos(step * place);
        [cos / scale, sin / scale]
    };
    let control = |m: usize| {
        let m = m as f64;
        if m >= degree - 1.0 && m <= last {
            return inner(m - 2.0);
        }
        let knots = [0.0, 1.0, 2.0, 3.0, 4.0].map(|k: f64| (m - 4.0 + k).clamp(0.0, last));
        blossom(inner, if m < degree - 1.0 { 0.0 } else { last - 1.0 }, knots)
    };
    (0..spans + DEGREE).map(control).collect()
}

/// The blossom of the piece between the knots `low` and `low + 1`, of the spline with these control points, by de Boor's scheme.
fn blossom(control: impl Fn(f64) -> Point, low: f64, knots: [f64; DEGREE]) -> Point {
    let mut points: Vec<Point> = (0..=DEGREE).map(|k| control(low - 2.0 + k as f64)).collect();
    for (level, knot) in knots.into_iter().enumerate() {
        let left = DEGREE - level;
        for k in 0..left {
            let begin = low - left as f64 + 1.0 + k as f64;
            let share = (knot - begin) / left as f64;
            points[k] = [0, 1].map(|x| (1.0 - share) * points[k][x] + share * points[k + 1][x]);
        }
    }
    points[0]
}

/// Control points over equal spans of a spline that follows a smooth curve over [0, 1], with its ends.
pub(super) fn fitted(curve: impl Fn(f64) -> Point) -> Vec<Point> {
    fitted_within(curve, 2, |spline, truth| maths::hypot(spline[0] - truth[0], spline[1] - truth[1]))
}

/// The same for curves of any dimension; `error` gives the distance, mm, that a point of the spline and the true one stand for.
pub(crate) fn fitted_within<const N: usize>(
    curve: impl Fn(f64) -> [f64; N],
    first: usize,
    error: impl Fn(&[f64; N], &[f64; N]) -> f64,
) -> Vec<[f64; N]> {
    let mut spans = first.max(1);
    loop {
        let control = interpolated(&curve, spans);
        let errors = (0..spans * 4).map(|k| {
            let x = (k as f64 + 0.5) / 4.0;
            error(&value(&control, x), &curve(x / spans as f64))
        });
        if errors.fold(0.0, f64::max) <= ERROR || spans >= MOST_SPANS {
            return control;
        }
        spans += 1 + spans / 4;
    }
}

/// The spline through a curve at the places of its control points, which is unique after Schoenberg and Whitney.
fn interpolated<const N: usize>(curve: &impl Fn(f64) -> [f64; N], spans: usize) -> Vec<[f64; N]> {
    let places = places(spans);
    let size = places.len();
    let mut matrix = vec![0.0; size * size];
    let mut points: Vec<f64> = Vec::with_capacity(N * size);
    for (row, &x) in places.iter().enumerate() {
        let (first, weights) = weights(x, spans);
        matrix[row * size + first..=row * size + first + DEGREE].copy_from_slice(&weights);
        points.extend(curve(x / spans as f64));
    }
    let mut lu = Lu::new();
    // Never singular; were it, the values themselves are a spline that is near, and the test of the error would say so.
    if lu.factor(size, size, &matrix).is_ok() {
        lu.solve_columns(&mut points, N);
    }
    points.chunks_exact(N).map(|point| std::array::from_fn(|k| point[k])).collect()
}

/// A point of a spline over [0, spans].
fn value<const N: usize>(control: &[[f64; N]], x: f64) -> [f64; N] {
    let (first, weights) = weights(x, control.len() - DEGREE);
    let sum = |axis: usize| weights.iter().zip(&control[first..]).map(|(weight, point)| weight * point[axis]).sum();
    std::array::from_fn(sum)
}

/// The basis functions that are not zero at `x`, from the first of them on (Cox and de Boor).
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "x lies between 0 and the number of spans")]
fn weights(x: f64, spans: usize) -> (usize, [f64; DEGREE + 1]) {
    let span = (x as usize).min(spans - 1);
    let knot = |k: usize| k.saturating_sub(DEGREE).min(spans) as f64;
    let here = span + DEGREE;
    let mut weights = [0.0; DEGREE + 1];
    weights[0] = 1.0;
    for degree in 1..=DEGREE {
        let mut carried = 0.0;
        for (k, weight) in weights.iter_mut().enumerate().take(degree) {
            let (right, left) = (knot(here + k + 1) - x, x - knot(here + k + 1 - degree));
            let part = *weight / (right + left);
            *weight = carried + right * part;
            carried = left * part;
        }
        weights[degree] = carried;
    }
    (span, weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The greatest distance of a spline from the circle at the same parameter, at 50 places of each span.
    fn error_of_turn(angle: f64, spans: usize) -> f64 {
        let control = turn(angle, spans);
        let at = |k: usize| {
            let x = k as f64 / 50.0;
            let ([u, v], (sin, cos)) = (value(&control, x), maths::sin_cos(angle * x / spans as f64));
            maths::hypot(u - cos, v - sin)
        };
        (0..=50 * spans).map(at).fold(0.0, f64::max)
    }

    #[test]
    fn turns_are_followed_as_closely_as_the_aliases_say() {
        for (angle, radius) in [(0.3, 10.0), (-2.0, 0.5), (TAU, 10.0), (-40.0, 50.0), (7.0, 400.0), (1e-3, 1.0), (20.0, 1e5)] {
            let spans = spans_of_turn(angle, radius);
            let error = radius * error_of_turn(angle, spans);
            assert!(error < ERROR + 1e-15 * radius, "{angle} {radius}: {error} with {spans} spans");
            // Not closer than need be, unless so few spans are less than a turn.
            assert!(error > 0.3 * ERROR || angle.abs() < 1.0 || radius < 1.0, "{angle} {radius}: {error} with {spans} spans");
        }
        // The sixth order.
        let ratio = error_of_turn(TAU, 24) / error_of_turn(TAU, 48);
        assert!((ratio / 64.0 - 1.0).abs() < 0.05, "{ratio}");
    }

    #[test]
    fn straight_lines_have_their_control_points_at_the_places() {
        for spans in [1, 2, 3, 7] {
            let line: Vec<Point> = places(spans).into_iter().map(|x| [x, -2.0 * x]).collect();
            for k in 0..=30 {
                let x = f64::from(k) / 30.0 * spans as f64;
                let [u, v] = value(&line, x);
                assert!((u - x).abs() < 1e-14 * spans as f64 && (v + 2.0 * x).abs() < 1e-14 * spans as f64, "{spans} {x}: {u} {v}");
            }
        }
    }

    #[test]
    fn smooth_curves_are_followed() {
        let curve = |u: f64| product([20.0 + 3.0 * maths::cos(3.0 * u), 0.0], [maths::cos(5.0 * u * u), maths::sin(5.0 * u * u)]);
        let control = fitted(curve);
        let spans = control.len() - DEGREE;
        for k in 0..=1000 {
            let u = f64::from(k) / 1000.0;
            let ([a, b], [c, d]) = (value(&control, u * spans as f64), curve(u));
            assert!(maths::hypot(a - c, b - d) < 1.5 * ERROR, "{u}");
        }
    }
}
