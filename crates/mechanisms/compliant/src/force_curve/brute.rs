//! The measures of a curve by candidates and search, one at a time, as slow as that is: what [`ForceCurve`](super::ForceCurve) must find.

use forcewright_base::roots;

use super::{Interval, SLACK, Turn};

pub(super) struct Brute {
    pub(super) x: Vec<f64>,
    pub(super) f: Vec<f64>,
    pub(super) k: Vec<f64>,
}

impl Brute {
    /// A curve through stations of ascending displacement (at least two), with forces and slopes.
    pub(super) fn new(displacement_m: Vec<f64>, force_n: Vec<f64>, stiffness_n_per_m: Vec<f64>) -> Self {
        Self { x: displacement_m, f: force_n, k: stiffness_n_per_m }
    }

    /// The first displacement, m.
    pub(super) fn start(&self) -> f64 {
        self.x.first().copied().unwrap_or(0.0)
    }

    /// The last displacement, m.
    pub(super) fn end(&self) -> f64 {
        self.x.last().copied().unwrap_or(0.0)
    }

    fn segment(&self, x: f64) -> usize {
        self.x.partition_point(|s| *s <= x).clamp(1, self.x.len() - 1) - 1
    }

    /// Cubic of a segment in its local coordinate t in [0, 1]: coefficients from t⁰ to t³.
    fn cubic(&self, i: usize) -> [f64; 4] {
        let h = self.x[i + 1] - self.x[i];
        let (f0, f1, m0, m1) = (self.f[i], self.f[i + 1], h * self.k[i], h * self.k[i + 1]);
        [f0, m0, 3.0 * (f1 - f0) - 2.0 * m0 - m1, 2.0 * (f0 - f1) + m0 + m1]
    }

    /// Force at a displacement, N.
    pub(super) fn force(&self, x: f64) -> f64 {
        let i = self.segment(x);
        let t = (x - self.x[i]) / (self.x[i + 1] - self.x[i]);
        let [a, b, c, d] = self.cubic(i);
        a + t * (b + t * (c + t * d))
    }

    /// Slope at a displacement, N/m.
    pub(super) fn slope(&self, x: f64) -> f64 {
        let i = self.segment(x);
        let h = self.x[i + 1] - self.x[i];
        let t = (x - self.x[i]) / h;
        let [_, b, c, d] = self.cubic(i);
        (b + t * (2.0 * c + t * 3.0 * d)) / h
    }

    /// Least slope, N/m: at a station, or where a segment's parabola of slopes has its vertex.
    pub(super) fn least_slope(&self) -> f64 {
        let stations = self.k.iter().copied().fold(f64::INFINITY, f64::min);
        let inside = (0..self.x.len() - 1).filter_map(|i| {
            let [_, _, c, d] = self.cubic(i);
            let t = -c / (3.0 * d);
            (d > 0.0 && t > 0.0 && t < 1.0).then(|| self.slope(self.x[i] + t * (self.x[i + 1] - self.x[i])))
        });
        inside.fold(stations, f64::min)
    }

    /// Estimated error of the interpolation, N: the change at every second station when it is left out, over 2⁴, the order of the
    /// interpolant.
    pub(super) fn error_n(&self) -> f64 {
        let n = self.x.len();
        let mut worst = 0.0_f64;
        for i in (1..n.saturating_sub(1)).step_by(2) {
            let pick = |v: &[f64]| vec![v[i - 1], v[i + 1]];
            let coarse = Self::new(pick(&self.x), pick(&self.f), pick(&self.k));
            worst = worst.max((coarse.force(self.x[i]) - self.f[i]).abs() / 16.0);
        }
        worst
    }

    /// Displacements with zero slope inside the curve, ascending.
    fn critical(&self) -> Vec<f64> {
        let mut found = Vec::new();
        for i in 0..self.x.len() - 1 {
            let [_, b, c, d] = self.cubic(i);
            for t in quadratic_roots(3.0 * d, 2.0 * c, b) {
                if (0.0..1.0).contains(&t) {
                    found.push(self.x[i] + t * (self.x[i + 1] - self.x[i]));
                }
            }
        }
        found.sort_by(f64::total_cmp);
        found.dedup_by(|a, b| (*a - *b).abs() <= 1e-12 * self.end());
        found.retain(|x| *x > 0.0 && *x < self.end());
        found
    }

    /// Ends and extrema: between two neighbours the curve is monotone.
    fn knots(&self) -> Vec<f64> {
        let mut knots = vec![self.x[0]];
        knots.extend(self.critical());
        knots.push(self.end());
        knots
    }

    /// Displacements at which the curve passes a level, ascending.
    pub(super) fn crossings(&self, level: f64) -> Vec<f64> {
        let knots = self.knots();
        let mut found: Vec<f64> = Vec::new();
        for pair in knots.windows(2) {
            let (a, b) = (self.force(pair[0]) - level, self.force(pair[1]) - level);
            if a == 0.0 {
                found.push(pair[0]);
            } else if a * b < 0.0
                && let Ok(x) = roots::root(|x| self.force(x) - level, pair[0], pair[1], 1e-15 * self.end())
            {
                found.push(x);
            }
        }
        if let Some(last) = knots.last().filter(|x| self.force(**x) - level == 0.0) {
            found.push(*last);
        }
        found.dedup();
        found
    }

    /// Every local maximum and minimum inside, ascending.
    pub(super) fn turns(&self) -> Vec<Turn> {
        let knots = self.knots();
        let turn = |w: &[f64]| {
            let (l, m, r) = (self.force(w[0]), self.force(w[1]), self.force(w[2]));
            let is_max = m > l && m > r;
            (is_max || (m < l && m < r)).then_some(Turn { at: w[1], is_max })
        };
        knots.windows(3).filter_map(turn).collect()
    }

    /// The paper's c: the last displacement before the end at which the force rises through `fraction` of its end value.
    pub(super) fn range_start(&self, fraction: f64) -> Option<f64> {
        let level = fraction * self.force(self.end());
        let crossings = self.crossings(level);
        let step = 1e-9 * self.end();
        crossings.into_iter().rev().find(|x| *x < self.end() - step && self.force(x + step) > self.force((x - step).max(0.0)))
    }

    /// Longest interval on which lo ≤ F ≤ hi.
    pub(super) fn longest_within(&self, lo: f64, hi: f64) -> Option<Interval> {
        let mut cuts = vec![self.x[0], self.end()];
        cuts.extend(self.crossings(lo));
        cuts.extend(self.crossings(hi));
        cuts.extend(self.critical());
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        let (slack_lo, slack_hi) = (lo - SLACK * lo.abs(), hi + SLACK * hi.abs());
        let inside = |x: f64| (slack_lo..=slack_hi).contains(&self.force(x));
        let mut best: Option<Interval> = None;
        let mut open: Option<Interval> = None;
        for pair in cuts.windows(2) {
            // Between cuts the curve is monotone and passes neither level, so its middle tells.
            if inside(f64::midpoint(pair[0], pair[1])) {
                open = Some(Interval { start: open.map_or(pair[0], |o| o.start), end: pair[1] });
                if open.is_some_and(|o| best.is_none_or(|b| o.length() > b.length())) {
                    best = open;
                }
            } else {
                open = None;
            }
        }
        best
    }

    /// Largest and smallest force on an interval.
    fn extent_with(&self, critical: &[f64], interval: Interval) -> (f64, f64) {
        let ends = [interval.start, interval.end];
        let inner = critical.iter().copied().filter(|x| (interval.start..=interval.end).contains(x));
        let values = ends.into_iter().chain(inner).map(|x| self.force(x));
        values.fold((f64::NEG_INFINITY, f64::INFINITY), |(hi, lo), f| (hi.max(f), lo.min(f)))
    }

    /// Longest interval of positive force with max F/min F ≤ (1 + β)/(1 − β), the level free.
    pub(super) fn longest_flat(&self, band: f64) -> Option<Interval> {
        let ratio = (1.0 + band) / (1.0 - band);
        let knots = self.knots();
        // The interval's start is pushed by a peak ahead, a trough ahead, or an end: those levels give the candidates exactly.
        let mut starts: Vec<f64> = knots.clone();
        for knot in &knots {
            let level = self.force(*knot);
            starts.extend(self.crossings(level / ratio));
            starts.extend(self.crossings(level * ratio));
        }
        starts.extend(&self.x);
        starts.retain(|x| self.force(*x) > 0.0 && *x < self.end());
        starts.sort_by(f64::total_cmp);
        starts.dedup();
        let reach = |start: f64| Interval { start, end: self.flat_end(start, ratio, &knots) };
        let best = starts
            .iter()
            .enumerate()
            .map(|(i, s)| (i, reach(*s)))
            .max_by(|a, b| a.1.length().total_cmp(&b.1.length()).then(b.0.cmp(&a.0)))?;
        // Where no level pushes it, the optimum is smooth: refine between the neighbouring candidates.
        let left = starts[best.0.saturating_sub(1)];
        let right = starts[(best.0 + 1).min(starts.len() - 1)];
        let refined = roots::minimise(|s| -reach(s).length(), left, right, 1e-12 * self.end()).x;
        let refined = reach(refined);
        Some(if refined.length() > best.1.length() { refined } else { best.1 })
    }

    /// The farthest displacement that keeps max F/min F over [start, end] within the ratio.
    fn flat_end(&self, start: f64, ratio: f64, knots: &[f64]) -> f64 {
        let first = self.force(start);
        let (mut hi, mut lo) = (first, first);
        let mut from = start;
        for &to in knots.iter().filter(|k| **k > start) {
            let f = self.force(to);
            let keeps = |f: f64| hi.max(f) <= ratio * lo.min(f) * (1.0 + SLACK);
            if !keeps(f) {
                // Monotone from here to the knot: the level that breaks the ratio is passed once.
                let level = if f > hi { ratio * lo } else { hi / ratio };
                return roots::root(|x| self.force(x) - level, from, to, 1e-15 * self.end()).unwrap_or(from);
            }
            (hi, lo, from) = (hi.max(f), lo.min(f), to);
        }
        self.end()
    }

    /// The window of a given length that deviates least: from a level, or (level free) from the middle of its own extent; and that
    /// deviation, relative.
    pub(super) fn best_window(&self, length: f64, nominal: Option<f64>) -> Option<(Interval, f64)> {
        if length > self.end() - self.start() {
            return None;
        }
        let critical = self.critical();
        let deviation = |start: f64| {
            let (hi, lo) = self.extent_with(&critical, Interval { start, end: start + length });
            match nominal {
                Some(level) => (hi / level - 1.0).abs().max((lo / level - 1.0).abs()),
                // Half width β of the narrowest band with a free level: (max − min)/(max + min).
                None if hi + lo > 0.0 => (hi - lo) / (hi + lo),
                None => f64::INFINITY,
            }
        };
        let last = self.end() - length;
        let mut starts: Vec<f64> = self.x.iter().copied().filter(|x| *x < last).collect();
        starts.push(last);
        let best = (0..starts.len()).min_by(|a, b| deviation(starts[*a]).total_cmp(&deviation(starts[*b])))?;
        let (left, right) = (starts[best.saturating_sub(1)], starts[(best + 1).min(starts.len() - 1)]);
        let refined = roots::minimise(deviation, left, right, 1e-10 * self.end()).x;
        let start = if deviation(refined) < deviation(starts[best]) { refined } else { starts[best] };
        Some((Interval { start, end: start + length }, deviation(start)))
    }
}

/// Real roots of a t² + b t + c.
fn quadratic_roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return Vec::new();
    }
    // The stable form: no difference of nearly equal numbers.
    let q = -0.5 * (b + b.signum() * discriminant.sqrt());
    [q / a, c / q].into_iter().filter(|t| t.is_finite()).collect()
}
