//! A curve cut where it turns: between two knots it is monotone, and passes a level at most once.

use super::ForceCurve;

/// The cubic between two stations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cubic {
    at: f64,
    width: f64,
    /// Coefficients from t⁰ to t³ of the part t in [0, 1] of the width.
    by_part: [f64; 4],
}

/// A station or an extremum.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    /// Displacement, m.
    pub(super) at: f64,
    /// Force there, N.
    pub(super) force_n: f64,
    /// Index of the cubic that begins or goes on here.
    pub(super) cubic: usize,
}

impl Cubic {
    /// From the values and slopes at both ends.
    pub(super) fn new(x: [f64; 2], f: [f64; 2], k: [f64; 2]) -> Self {
        let width = x[1] - x[0];
        let [m0, m1] = k.map(|k| width * k);
        let by_part = [f[0], m0, 3.0 * (f[1] - f[0]) - 2.0 * m0 - m1, 2.0 * (f[0] - f[1]) + m0 + m1];
        Self { at: x[0], width, by_part }
    }

    #[inline]
    fn value(&self, t: f64) -> f64 {
        let [a, b, c, d] = self.by_part;
        a + t * (b + t * (c + t * d))
    }

    #[inline]
    fn rate(&self, t: f64) -> f64 {
        let [_, b, c, d] = self.by_part;
        b + t * (2.0 * c + t * 3.0 * d)
    }

    #[inline]
    fn part(&self, x: f64) -> f64 {
        (x - self.at) / self.width
    }

    /// Force at a displacement, N.
    #[inline]
    pub(super) fn force(&self, x: f64) -> f64 {
        self.value(self.part(x))
    }

    /// Slope at a displacement, N/m.
    #[inline]
    pub(super) fn slope(&self, x: f64) -> f64 {
        self.rate(self.part(x)) / self.width
    }

    /// The least slope, N/m, where the slope has its vertex inside.
    pub(super) fn least_slope_inside(&self) -> Option<f64> {
        let [_, _, c, d] = self.by_part;
        // The vertex t = −c/3d without a division where there is none.
        let inside = d > 0.0 && c < 0.0 && -c < 3.0 * d;
        inside.then(|| self.rate(-c / (3.0 * d)) / self.width)
    }

    /// Where the slope is zero, from 0 up to but not 1, ascending; not a number where it is not.
    #[inline]
    fn turns(&self) -> [f64; 2] {
        let [_, b, c, d] = self.by_part;
        // The slope lies in the hull of its Bézier coefficients.
        let hull = [b, b + c, b + 2.0 * c + 3.0 * d];
        if hull.iter().all(|s| *s > 0.0) || hull.iter().all(|s| *s < 0.0) {
            return [f64::NAN; 2];
        }
        let found = quadratic_roots(3.0 * d, 2.0 * c, b).map(|t| if (0.0..1.0).contains(&t) { t } else { f64::NAN });
        if found[0] > found[1] { [found[1], found[0]] } else { found }
    }

    /// Where between two parts the curve, monotone there with these values at the two, passes a level; the nearer end where it does not.
    fn passes(&self, parts: [f64; 2], values: [f64; 2], level: f64) -> f64 {
        let rising = values[1] > values[0];
        let (low, high) = if rising { (values[0], values[1]) } else { (values[1], values[0]) };
        if level <= low {
            return if rising { parts[0] } else { parts[1] };
        } else if level >= high {
            return if rising { parts[1] } else { parts[0] };
        }
        // Newton's method from the chord, kept in the bracket by bisection.
        let [mut left, mut right] = parts;
        let mut t = left + (right - left) * ((level - values[0]) / (values[1] - values[0]));
        for _ in 0..MOST_STEPS {
            let off = self.value(t) - level;
            let newton = t - off / self.rate(t);
            if off == 0.0 || (newton - t).abs() <= f64::EPSILON || right - left <= f64::EPSILON {
                break;
            }
            if (off < 0.0) == rising {
                left = t;
            } else {
                right = t;
            }
            t = if newton > left && newton < right { newton } else { f64::midpoint(left, right) };
        }
        t
    }
}

/// Steps to the place of a level: a double root takes one per bit.
const MOST_STEPS: usize = 100;

/// Real roots of a t² + b t + c; not a number or infinite where there is none.
fn quadratic_roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let discriminant = b * b - 4.0 * a * c;
    // The stable form: no difference of nearly equal numbers. Of a negative discriminant it is no number.
    let q = -0.5 * (b + b.signum() * discriminant.sqrt());
    [q / a, c / q]
}

impl ForceCurve {
    /// Cuts the curve into cubics and monotone stretches.
    pub(super) fn split(&mut self) {
        let Self { x, f, k, cubics, knots, flat } = self;
        cubics.clear();
        knots.clear();
        flat.clear();
        let end = x.last().copied().unwrap_or(0.0);
        for i in 0..x.len().saturating_sub(1) {
            let cubic = Cubic::new([x[i], x[i + 1]], [f[i], f[i + 1]], [k[i], k[i + 1]]);
            cubics.push(cubic);
            knots.push(Knot { at: x[i], force_n: f[i], cubic: i });
            for t in cubic.turns() {
                let at = x[i] + t * cubic.width;
                // Not the same once more, where it was found on the other side of a station.
                let known = flat.last().is_some_and(|last: &usize| at - knots[*last].at <= 1e-12 * end);
                if at.is_nan() || at <= 0.0 || at >= end || known {
                    continue;
                }
                if at > x[i] {
                    knots.push(Knot { at, force_n: cubic.value(t), cubic: i });
                }
                flat.push(knots.len() - 1);
            }
        }
        if let (Some(at), Some(force_n)) = (x.last(), f.last()) {
            knots.push(Knot { at: *at, force_n: *force_n, cubic: cubics.len().saturating_sub(1) });
        }
    }

    /// Number of monotone stretches.
    pub(super) fn stretches(&self) -> usize {
        self.knots.len().saturating_sub(1)
    }

    /// The displacement in a stretch at which the curve passes a level, m; its nearer end where it does not.
    pub(super) fn place(&self, stretch: usize, level: f64) -> f64 {
        let (left, right) = (&self.knots[stretch], &self.knots[stretch + 1]);
        let cubic = &self.cubics[left.cubic];
        let parts = [cubic.part(left.at), cubic.part(right.at)];
        let t = cubic.passes(parts, [left.force_n, right.force_n], level);
        (cubic.at + t * cubic.width).max(left.at).min(right.at)
    }

    /// The cubic of a stretch.
    #[inline]
    pub(super) fn of_stretch(&self, stretch: usize) -> &Cubic {
        &self.cubics[self.knots[stretch].cubic]
    }

    /// Largest and smallest force at the knots from one to another; nothing, as infinities, where the second is before the first.
    #[inline]
    pub(super) fn extremes(&self, first: usize, last: usize) -> (f64, f64) {
        if last < first {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        let ends = [self.knots[first].force_n, self.knots[last].force_n];
        // Between the ends the curve is largest and smallest where it turns, which it seldom does.
        let inner = self.flat.iter().filter(|i| (first..last).contains(i)).map(|i| self.knots[*i].force_n);
        inner.fold((ends[0].max(ends[1]), ends[0].min(ends[1])), |(hi, lo), f| (hi.max(f), lo.min(f)))
    }

    /// Every displacement at which the curve passes a level, ascending.
    pub(super) fn each_crossing(&self, level: f64, mut visit: impl FnMut(f64)) {
        let mut before = f64::NAN;
        for (i, knot) in self.knots.iter().enumerate() {
            let here = knot.force_n - level;
            if before * here < 0.0 {
                visit(self.place(i - 1, level));
            } else if here == 0.0 {
                visit(knot.at);
            }
            before = here;
        }
    }
}
