//! The force over the displacement as a smooth curve, and what people measure on it.
//!
//! Between stations the curve is the cubic Hermite interpolant of the exact forces and tangent stiffnesses; [`ForceCurve::error_n`]
//! estimates what that costs.

mod monotone;
mod windows;

use monotone::{Cubic, Knot};

/// Force over displacement with slopes, SI.
#[derive(Clone, Debug, Default)]
pub struct ForceCurve {
    x: Vec<f64>,
    f: Vec<f64>,
    k: Vec<f64>,
    /// One between two stations.
    cubics: Vec<Cubic>,
    /// Stations and extrema, ascending: between two neighbours the curve is monotone.
    knots: Vec<Knot>,
    /// The knots inside at which the slope is zero.
    flat: Vec<usize>,
}

/// An interval of the displacement, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Its start.
    pub start: f64,
    /// Its end.
    pub end: f64,
}

impl Interval {
    /// Its length.
    pub fn length(&self) -> f64 {
        self.end - self.start
    }
}

/// Local extrema of a curve, each as displacement and force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extrema {
    /// First local maximum.
    pub max: Option<(f64, f64)>,
    /// First local minimum after it.
    pub min: Option<(f64, f64)>,
}

/// A place at which the curve turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Displacement, m.
    pub at: f64,
    /// Whether the force has a maximum there, not a minimum.
    pub is_max: bool,
}

/// Ratios are compared with this slack, so that an interval that touches a peak exactly is not lost to rounding.
const SLACK: f64 = 1e-12;

impl ForceCurve {
    /// A curve through stations of ascending displacement (at least two), with forces and slopes.
    pub fn new(displacement_m: Vec<f64>, force_n: Vec<f64>, stiffness_n_per_m: Vec<f64>) -> Self {
        let mut curve = Self { x: displacement_m, f: force_n, k: stiffness_n_per_m, ..Self::default() };
        curve.split();
        curve
    }

    /// Another curve, in the room of this one.
    pub(crate) fn set(&mut self, displacement_m: &[f64], force_n: &[f64], stiffness_n_per_m: &[f64]) {
        for (own, new) in [(&mut self.x, displacement_m), (&mut self.f, force_n), (&mut self.k, stiffness_n_per_m)] {
            own.clear();
            own.extend_from_slice(new);
        }
        self.split();
    }

    /// The first displacement, m.
    pub fn start(&self) -> f64 {
        self.x.first().copied().unwrap_or(0.0)
    }

    /// The last displacement, m.
    pub fn end(&self) -> f64 {
        self.x.last().copied().unwrap_or(0.0)
    }

    fn cubic(&self, x: f64) -> &Cubic {
        &self.cubics[self.x.partition_point(|s| *s <= x).clamp(1, self.x.len() - 1) - 1]
    }

    /// Force at a displacement, N.
    pub fn force(&self, x: f64) -> f64 {
        self.cubic(x).force(x)
    }

    /// Slope at a displacement, N/m.
    pub fn slope(&self, x: f64) -> f64 {
        self.cubic(x).slope(x)
    }

    /// Least slope, N/m: at a station, or where a segment's parabola of slopes has its vertex.
    pub fn least_slope(&self) -> f64 {
        let stations = self.k.iter().copied().fold(f64::INFINITY, f64::min);
        self.cubics.iter().filter_map(Cubic::least_slope_inside).fold(stations, f64::min)
    }

    /// Estimated error of the interpolation, N: the change at every second station when it is left out, over 2⁴, the order of the
    /// interpolant.
    pub fn error_n(&self) -> f64 {
        let n = self.x.len();
        let mut worst = 0.0_f64;
        for i in (1..n.saturating_sub(1)).step_by(2) {
            let (l, r) = (i - 1, i + 1);
            let coarse = Cubic::new([self.x[l], self.x[r]], [self.f[l], self.f[r]], [self.k[l], self.k[r]]);
            worst = worst.max((coarse.force(self.x[i]) - self.f[i]).abs() / 16.0);
        }
        worst
    }

    /// Displacements at which the curve passes a level, ascending.
    pub fn crossings(&self, level: f64) -> Vec<f64> {
        let mut found: Vec<f64> = Vec::new();
        self.each_crossing(level, |x| found.push(x));
        found.dedup();
        found
    }

    /// Every local maximum and minimum inside, ascending.
    pub fn turns(&self) -> Vec<Turn> {
        self.turning().collect()
    }

    /// The same, one after the other.
    pub(crate) fn turning(&self) -> impl Iterator<Item = Turn> + '_ {
        let value = |i: usize| self.knots[i].force_n;
        (0..self.flat.len()).filter_map(move |i| {
            let own = self.flat[i];
            let left = if i == 0 { 0 } else { self.flat[i - 1] };
            let right = self.flat.get(i + 1).copied().unwrap_or(self.knots.len() - 1);
            let (l, m, r) = (value(left), value(own), value(right));
            let is_max = m > l && m > r;
            (is_max || (m < l && m < r)).then_some(Turn { at: self.knots[own].at, is_max })
        })
    }

    /// The paper's c: the last displacement before the end at which the force rises through `fraction` of its end value.
    pub fn range_start(&self, fraction: f64) -> Option<f64> {
        let level = fraction * self.force(self.end());
        let step = 1e-9 * self.end();
        let mut last = None;
        self.each_crossing(level, |x| {
            if x < self.end() - step && self.force(x + step) > self.force((x - step).max(0.0)) {
                last = Some(x);
            }
        });
        last
    }

    /// Largest and smallest force on an interval.
    pub fn extent(&self, interval: Interval) -> (f64, f64) {
        let ends = [interval.start, interval.end].map(|x| self.force(x));
        let inner = self.flat.iter().map(|i| self.knots[*i]).filter(|k| (interval.start..=interval.end).contains(&k.at));
        let values = ends.into_iter().chain(inner.map(|k| k.force_n));
        values.fold((f64::NEG_INFINITY, f64::INFINITY), |(hi, lo), f| (hi.max(f), lo.min(f)))
    }
}

#[cfg(test)]
mod brute;
#[cfg(test)]
mod tests;
