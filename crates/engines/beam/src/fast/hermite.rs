//! Interpolation by values and slopes, or by values alone, at a few of many ascending places.

/// Most places used.
pub(crate) const MOST: usize = 10;

/// The places used, and the weights of their values and slopes in the interpolated value and in its slope.
#[derive(Debug, Default)]
pub(crate) struct Hermite {
    /// Whether slopes have no weight.
    values_only: bool,
    /// Index of the first place used.
    pub(crate) first: usize,
    /// Number of places used.
    pub(crate) count: usize,
    /// The index that is left out, if below `first + count`; later ones move up.
    left_out: usize,
    place: [f64; MOST],
    /// `1/Π (x_j − x_m)`, and `Σ 1/(x_j − x_m)`.
    scale: [f64; MOST],
    sum: [f64; MOST],
    /// Weight of (value, slope) in the value, and in the slope.
    pub(crate) value: [[f64; 2]; MOST],
    pub(crate) slope: [[f64; 2]; MOST],
}

impl Hermite {
    /// Forgets the places.
    pub(crate) fn reset(&mut self, values_only: bool) {
        self.values_only = values_only;
        self.count = 0;
        self.left_out = usize::MAX;
    }

    /// Uses `count` places around the interval that follows place `interval`.
    pub(crate) fn around(&mut self, places: &[f64], interval: usize, count: usize) {
        let count = count.min(places.len()).min(MOST);
        let first = (interval + 1).saturating_sub(count / 2).min(places.len() - count);
        if first != self.first || count != self.count || self.left_out != usize::MAX {
            self.set(first, usize::MAX, places[first..].iter().copied().take(count));
        }
    }

    /// Uses up to `count` places around one of them, which is left out.
    pub(crate) fn without(&mut self, places: &[f64], out: usize, count: usize) {
        let count = count.min(places.len() - 1).min(MOST);
        let first = out.saturating_sub(count / 2).min(places.len() - 1 - count);
        let kept = places.iter().enumerate().skip(first).filter(|(i, _)| *i != out).map(|(_, p)| *p);
        self.set(first, out, kept.take(count));
    }

    /// Uses the last `count` places.
    pub(crate) fn last(&mut self, places: &[f64], count: usize) {
        let count = count.min(places.len()).min(MOST);
        let first = places.len() - count;
        self.set(first, usize::MAX, places[first..].iter().copied());
    }

    fn set(&mut self, first: usize, left_out: usize, places: impl Iterator<Item = f64>) {
        (self.first, self.left_out, self.count) = (first, left_out, 0);
        for p in places {
            self.place[self.count] = p;
            self.count += 1;
        }
        let used = &self.place[..self.count];
        for (j, here) in used.iter().enumerate() {
            let (mut product, mut sum) = (1.0, 0.0);
            for (m, there) in used.iter().enumerate() {
                if m != j {
                    let inverse = 1.0 / (here - there);
                    product *= inverse;
                    sum += inverse;
                }
            }
            (self.scale[j], self.sum[j]) = (product, sum);
        }
    }

    /// Indices of the places used.
    pub(crate) fn indices(&self) -> impl Iterator<Item = usize> {
        let out = self.left_out;
        (self.first..self.first + self.count).map(move |i| if i >= out { i + 1 } else { i })
    }

    /// Indices of the places used with the weights of their values and slopes.
    pub(crate) fn weights(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        self.indices().zip(self.value)
    }

    /// Computes the weights at a place.
    pub(crate) fn place(&mut self, at: f64) {
        let count = self.count;
        // Products of (at − x_m) after each place, with their slopes.
        let mut after = [(1.0, 0.0); MOST];
        for j in (1..count).rev() {
            let (product, slope) = after[j];
            let step = at - self.place[j];
            after[j - 1] = (product * step, slope * step + product);
        }
        let (mut before, mut before_slope) = (1.0, 0.0);
        for (j, (product, slope)) in after.into_iter().enumerate().take(count) {
            let step = at - self.place[j];
            let base = before * product * self.scale[j];
            let d_base = (before_slope * product + before * slope) * self.scale[j];
            before_slope = before_slope * step + before;
            before *= step;
            if self.values_only {
                (self.value[j], self.slope[j]) = ([base, 0.0], [d_base, 0.0]);
                continue;
            }
            // ℓ² (1 − 2 ℓ'(x_j) (x − x_j)) and ℓ² (x − x_j).
            let (square, d_square) = (base * base, 2.0 * base * d_base);
            let ramp = 1.0 - 2.0 * self.sum[j] * step;
            self.value[j] = [square * ramp, square * step];
            self.slope[j] = [d_square * ramp - 2.0 * self.sum[j] * square, d_square * step + square];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_and_their_slopes_are_exact() {
        let places: Vec<f64> = (0..7).map(|i| 0.02 * f64::from(i * i) + 0.2 * f64::from(i)).collect();
        let f = |x: f64| 1.0 + x * (2.0 - x * (0.3 - x * (0.2 + x * x * (0.7 - 0.3 * x * x))));
        let g = |x: f64| 2.0 - x * (0.6 - x * (0.6 + x * x * (3.5 - 2.1 * x * x)));
        let mut hermite = Hermite::default();
        hermite.reset(false);
        let check = |hermite: &mut Hermite, at: f64| {
            hermite.place(at);
            let sum = |w: &[[f64; 2]]| hermite.indices().zip(w).map(|(i, w)| f(places[i]) * w[0] + g(places[i]) * w[1]).sum::<f64>();
            assert!((sum(&hermite.value) - f(at)).abs() < 1e-11, "{at}");
            assert!((sum(&hermite.slope) - g(at)).abs() < 1e-10, "{at}");
        };
        for (interval, at) in [(0, 0.0), (0, 0.13), (2, 0.5), (3, 0.95), (5, 1.92)] {
            hermite.around(&places, interval, 4);
            assert!(hermite.indices().any(|i| i == interval) && hermite.indices().any(|i| i == interval + 1));
            check(&mut hermite, at);
        }
        for out in 1..6 {
            hermite.without(&places, out, 4);
            assert!(hermite.indices().all(|i| i != out && i < places.len()));
            check(&mut hermite, places[out]);
        }
        hermite.reset(true);
        hermite.around(&places, 2, 7);
        assert!(hermite.count == 7 && hermite.first == 0);
        hermite.place(places[3]);
        assert!(hermite.weights().all(|(i, [value, slope])| (value - f64::from(u8::from(i == 3))).abs() < 1e-12 && slope == 0.0));
        hermite.reset(false);
        hermite.last(&places, 4);
        assert!(hermite.indices().eq(3..7));
        check(&mut hermite, 2.1);
    }
}
