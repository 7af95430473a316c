//! Polynomial interpolation through a few of many ascending places: weights of the values, and of their slope.

/// The places used, and their weights at a point.
#[derive(Debug)]
pub(crate) struct Stencil {
    /// Index of the first place used.
    pub(crate) first: usize,
    wanted: usize,
    /// `1/Π (x_j − x_m)`.
    scale: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Stencil {
    /// Uses `wanted` places, or all where there are fewer.
    pub(crate) fn new(wanted: usize) -> Self {
        Self { first: 0, wanted, scale: Vec::new(), values: Vec::new(), slopes: Vec::new() }
    }

    /// Weights of the values.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Weights of the slope.
    pub(crate) fn slopes(&self) -> &[f64] {
        &self.slopes
    }

    /// Chooses the places around `at` and computes the weights.
    pub(crate) fn place(&mut self, places: &[f64], at: f64) {
        let count = self.wanted.min(places.len());
        let after = places.partition_point(|p| *p <= at);
        let first = after.saturating_sub(count.div_ceil(2)).min(places.len() - count);
        if first != self.first || self.scale.len() != count {
            self.first = first;
            self.rescale(&places[first..first + count]);
        }
        let used = &places[first..first + count];
        self.values.clear();
        self.slopes.clear();
        // Products of (at − x_m) before and after each place, with their derivatives.
        let (mut before, mut before_slope) = (1.0, 0.0);
        for (place, scale) in used.iter().zip(&self.scale) {
            self.values.push(before * scale);
            self.slopes.push(before_slope * scale);
            let step = at - place;
            before_slope = before_slope * step + before;
            before *= step;
        }
        let (mut after, mut after_slope) = (1.0, 0.0);
        for j in (0..count).rev() {
            self.slopes[j] = self.slopes[j] * after + self.values[j] * after_slope;
            self.values[j] *= after;
            let step = at - used[j];
            after_slope = after_slope * step + after;
            after *= step;
        }
    }

    fn rescale(&mut self, used: &[f64]) {
        self.scale.clear();
        for (j, here) in used.iter().enumerate() {
            let product: f64 = used.iter().enumerate().filter(|(m, _)| *m != j).map(|(_, there)| here - there).product();
            self.scale.push(1.0 / product);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_and_their_slopes_are_exact() {
        let places: Vec<f64> = (0..12).map(|i| 0.1 * f64::from(i * i) + f64::from(i)).collect();
        let (f, g) = (|x: f64| 1.0 + x * (2.0 - x * (0.3 - 0.01 * x)), |x: f64| 2.0 - x * (0.6 - 0.03 * x));
        let mut stencil = Stencil::new(5);
        for at in [0.0, 0.4, 3.0, 7.7, 12.3, 22.0, 23.1] {
            stencil.place(&places, at);
            let sum = |w: &[f64]| places[stencil.first..].iter().zip(w).map(|(p, w)| f(*p) * w).sum::<f64>();
            assert!((sum(stencil.values()) - f(at)).abs() < 1e-11, "{at}");
            assert!((sum(stencil.slopes()) - g(at)).abs() < 1e-10, "{at}");
        }
    }
}
