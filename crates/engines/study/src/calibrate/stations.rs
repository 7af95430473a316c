//! A curve between its stations.
//!
//! It is a cubic of each interval with the slopes of the polynomial through the five nearest stations: once continuously differentiable, and
//! linear in the values, so that their Jacobian goes the same way. Where the slope jumps within an interval, polynomials do not reach across
//! it, and the lines from both its ends go on until they meet.

use std::borrow::Cow;

use super::curve::CurveError;
use crate::evaluator::Evaluator;

/// Most stations through which a slope is taken.
const STENCIL: usize = 5;
/// A slope jumps where it changes by so many times what it changes on either side, …
const JUMP: f64 = 10.0;
/// … and by more than this part of all that it changes along the curve.
const LEAST_JUMP: f64 = 1e-3;
/// Lines that meet so little beyond an interval, over its length, meet at its end.
const AT_THE_END: f64 = 1e-6;

/// Values by their places among all values of the evaluator, with their weights.
pub(super) type Weights = Vec<(usize, f64)>;

/// Where values of an output stand, in ascending order.
pub(super) struct Stations {
    at: Vec<f64>,
    /// Place of each value among all values.
    index: Vec<usize>,
    /// Slope at each station: weights of values.
    slopes: Vec<Weights>,
}

impl Stations {
    pub(super) fn of(evaluator: &dyn Evaluator, output: usize) -> Result<Self, CurveError> {
        let no_curve = CurveError::NoCurve { output };
        let range = evaluator.outputs().get(output).ok_or(no_curve.clone())?.values.clone();
        let mut at = if output < evaluator.outputs().len() { evaluator.stations(output) } else { Vec::new() };
        let mut index: Vec<usize> = range.collect();
        if at.len() != index.len() || at.len() < 2 {
            return Err(no_curve);
        }
        if at[0] > at[1] {
            at.reverse();
            index.reverse();
        }
        if !at.windows(2).all(|pair| pair[0] < pair[1]) {
            return Err(CurveError::Order { output });
        }
        let mut stations = Self { at, index, slopes: Vec::new() };
        let last = stations.at.len() - 1;
        stations.slopes = (0..=last).map(|i| stations.slope(i, [0, last])).collect();
        Ok(stations)
    }

    /// Places of the curve's values among all values.
    pub(super) fn values(&self) -> &[usize] {
        &self.index
    }

    /// The curve through values, of which those at [`Self::values`] are its own.
    pub(super) fn shape<'a>(&'a self, values: &'a [f64]) -> Shape<'a> {
        Shape { stations: self, values, corners: self.corners(values) }
    }

    /// Weights of the slope at a station, of the polynomial through it and its neighbours from one station to another.
    fn slope(&self, i: usize, [from, to]: [usize; 2]) -> Weights {
        let size = STENCIL.min(to - from + 1);
        let first = i.saturating_sub(size / 2).clamp(from, to + 1 - size);
        let weights = derivative(&self.at[first..first + size], i - first);
        weights.into_iter().enumerate().map(|(k, w)| (self.index[first + k], w)).collect()
    }

    /// Intervals, by the station at their left ends, within which the slope jumps.
    fn corners(&self, values: &[f64]) -> Vec<usize> {
        let value = |i: usize| values[self.index[i]];
        let chords: Vec<f64> = (1..self.at.len()).map(|i| (value(i) - value(i - 1)) / (self.at[i] - self.at[i - 1])).collect();
        let [low, high] = chords.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], s| [a.min(*s), b.max(*s)]);
        let change = |i: usize, j: usize| Some((chords.get(j)? - chords.get(i)?).abs());
        let jump = |k: usize| change(k.checked_sub(1)?, k + 1);
        let is_corner = |k: usize| {
            let (jump, left, right) = (jump(k)?, change(k.checked_sub(2)?, k - 1)?, change(k + 1, k + 2)?);
            (jump > JUMP * left.max(right) && jump > LEAST_JUMP * (high - low)).then_some(jump)
        };
        // Next to an end of an interval a jump shows in the next one too, and less.
        let first_largest = |k: usize| {
            let own = is_corner(k)?;
            let before = k.checked_sub(1).and_then(is_corner).is_none_or(|other| other < own);
            (before && is_corner(k + 1).is_none_or(|other| other <= own)).then_some(k)
        };
        (0..chords.len()).filter_map(first_largest).collect()
    }
}

/// A curve through values.
pub(super) struct Shape<'a> {
    stations: &'a Stations,
    values: &'a [f64],
    /// Intervals within which the slope jumps, ascending.
    corners: Vec<usize>,
}

impl Shape<'_> {
    fn of(&self, weights: &[(usize, f64)]) -> f64 {
        weights.iter().map(|(i, w)| w * self.values[*i]).sum()
    }

    /// The value at a place.
    pub(super) fn value(&self, x: f64) -> f64 {
        self.of(&self.weights(x).0)
    }

    /// Slopes at all stations.
    pub(super) fn slopes(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.stations.at.len()).map(|i| self.of(&self.slope(i)))
    }

    /// Weights of the slope at a station, of values on its side of all jumps.
    fn slope(&self, i: usize) -> Cow<'_, [(usize, f64)]> {
        let last = self.stations.at.len() - 1;
        let next = self.corners.partition_point(|corner| *corner < i);
        let from = next.checked_sub(1).map_or(0, |before| self.corners[before] + 1);
        let to = self.corners.get(next).copied().unwrap_or(last);
        if from + STENCIL / 2 <= i && i + STENCIL / 2 <= to || self.corners.is_empty() {
            return Cow::Borrowed(&self.stations.slopes[i]);
        }
        Cow::Owned(self.stations.slope(i, [from, to]))
    }

    /// What value and slope at a place are of the values; beyond the ends, straight on.
    pub(super) fn weights(&self, x: f64) -> (Weights, Weights) {
        let Stations { at, index, .. } = self.stations;
        let last = at.len() - 1;
        let end = if x <= at[0] { Some(0) } else { (x >= at[last]).then_some(last) };
        if let Some(end) = end {
            return self.straight(end, x);
        }
        let right = at.partition_point(|a| *a <= x).clamp(1, last);
        let left = right - 1;
        let h = at[right] - at[left];
        if let Some(corner) = self.corner(left) {
            return self.straight(if x < corner { left } else { right }, x);
        }
        let u = (x - at[left]) / h;
        let (mut value, mut slope) = (Vec::new(), Vec::new());
        let mut add = |index: usize, v: f64, s: f64| {
            value.push((index, v));
            slope.push((index, s));
        };
        // Hermite's cubics and their derivatives.
        let (step, bend) = (u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) / h);
        add(index[left], 1.0 - step, -bend);
        add(index[right], step, bend);
        for (side, v, s) in
            [(left, h * u * (1.0 - u) * (1.0 - u), (1.0 - u) * (1.0 - 3.0 * u)), (right, -h * u * u * (1.0 - u), u * (3.0 * u - 2.0))]
        {
            self.slope(side).iter().for_each(|(i, w)| add(*i, v * w, s * w));
        }
        (value, slope)
    }

    /// The line through a station with its slope.
    fn straight(&self, station: usize, x: f64) -> (Weights, Weights) {
        let slope = self.slope(station).into_owned();
        let mut value: Weights = slope.iter().map(|(i, w)| (*i, w * (x - self.stations.at[station]))).collect();
        value.push((self.stations.index[station], 1.0));
        (value, slope)
    }

    /// Where in an interval the lines from its ends meet, if the slope jumps within it.
    fn corner(&self, left: usize) -> Option<f64> {
        self.corners.binary_search(&left).ok()?;
        let end = |i: usize| (self.stations.at[i], self.values[self.stations.index[i]], self.of(&self.slope(i)));
        let ((x0, y0, s0), (x1, y1, s1)) = (end(left), end(left + 1));
        let along = (y1 - y0 - s1 * (x1 - x0)) / (s0 - s1) / (x1 - x0);
        (-AT_THE_END..=1.0 + AT_THE_END).contains(&along).then_some(x0 + along * (x1 - x0))
    }
}

/// Weights of the derivative, at one of its places, of the polynomial through values at all of them.
fn derivative(at: &[f64], place: usize) -> Vec<f64> {
    let n = at.len();
    let others = |j: usize, without: usize| (0..n).filter(move |k| *k != j && *k != without);
    (0..n)
        .map(|j| {
            if j == place {
                return (0..n).filter(|k| *k != j).map(|k| 1.0 / (at[j] - at[k])).sum();
            }
            let over: f64 = others(j, place).map(|k| at[place] - at[k]).product();
            over / (0..n).filter(|k| *k != j).map(|k| at[j] - at[k]).product::<f64>()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use forcewright_base::maths::sin;

    use super::*;

    fn even(n: usize) -> Stations {
        let mut stations =
            Stations { at: (0..n).map(|i| i as f64 / (n - 1) as f64).collect(), index: (0..n).collect(), slopes: Vec::new() };
        stations.slopes = (0..n).map(|i| stations.slope(i, [0, n - 1])).collect();
        stations
    }

    /// Largest error of the curve through values of a function.
    fn error(n: usize, f: impl Fn(f64) -> f64) -> f64 {
        let stations = even(n);
        let values: Vec<f64> = stations.at.iter().map(|x| f(*x)).collect();
        let shape = stations.shape(&values);
        (0..=1000).map(|i| f64::from(i) / 1000.0).map(|x| (shape.value(x) - f(x)).abs()).fold(0.0, f64::max)
    }

    /// Up, level, up more steeply: what a transmission gives that shifts. Exact wherever its corners lie, also on and next to stations.
    #[test]
    fn broken_lines_are_met_exactly() {
        for shift in [0.0, 1e-9, 1e-4, 0.003, 0.0125, 0.02, 0.0249, 0.025] {
            let (from, to) = (0.3 + shift, 0.45 + shift);
            let line = |x: f64| x.min(from) + 3.0 * (x - to).max(0.0);
            assert!(error(41, line) < 1e-8, "{shift}: {}", error(41, line));
        }
    }

    /// Between bends a corner costs the square of the distance of the stations, and only next to it.
    #[test]
    fn a_corner_between_bends() {
        let bent = |x: f64| sin(3.0 * x) + 2.0 * (x - 0.617).abs();
        let (coarse, fine) = (error(41, bent), error(161, bent));
        assert!(coarse < 2e-3 && fine < 1.5e-4, "{coarse} {fine}");
    }

    /// What bends, however sharply, but is resolved has no corner: the weights are those of the polynomials.
    #[test]
    fn bends_are_no_corners() {
        for f in [
            |x: f64| sin(20.0 * x),
            |x: f64| 1.0 / (1.0 + 400.0 * (x - 0.5) * (x - 0.5)),
            |x: f64| (x - 0.4) * (x - 0.4) * (x - 0.4),
            |_| 2.0,
            |x| x,
        ] {
            let stations = even(81);
            let values: Vec<f64> = stations.at.iter().map(|x| f(*x)).collect();
            assert_eq!(stations.corners(&values), Vec::<usize>::new());
        }
    }

    /// Weights give the value, and their slope is that of the values along the curve.
    #[test]
    fn weights_are_those_of_the_value() {
        let stations = even(41);
        let values: Vec<f64> = stations.at.iter().map(|x| x * x + 3.0 * (x - 0.611).max(0.0)).collect();
        let shape = stations.shape(&values);
        assert_eq!(shape.corners.len(), 1);
        let h = 1e-6;
        for x in [0.0, 0.3, 0.6001, 0.6105, 0.612, 0.6249, 0.7, 1.2] {
            let (_, slope) = shape.weights(x);
            let by_difference = (shape.value(x + h) - shape.value(x - h)) / (2.0 * h);
            assert!((shape.of(&slope) - by_difference).abs() < 1e-6, "{x}: {} {by_difference}", shape.of(&slope));
        }
    }
}
