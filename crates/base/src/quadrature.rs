//! Gauss–Legendre quadrature on [0, 1] and Legendre polynomials.

use std::f64::consts::PI;

use crate::maths;

/// Legendre polynomials `P_0 … P_n` at `x` in [−1, 1], written to `values[0..=n]` with `n = values.len() − 1`.
///
/// Three-term recurrence `(k+1) P_{k+1} = (2k+1) x P_k − k P_{k−1}` (Abramowitz & Stegun 8.5.3).
pub fn legendre_values(x: f64, values: &mut [f64]) {
    let (mut before, mut here) = (0.0, 1.0);
    for (k, value) in values.iter_mut().enumerate() {
        *value = here;
        let k = k as f64;
        (before, here) = (here, ((2.0 * k + 1.0) * x * here - k * before) / (k + 1.0));
    }
}

/// The Legendre polynomial `P_n` and its derivative at `x` in [−1, 1].
///
/// The derivative uses `P'_{k+1} = P'_{k−1} + (2k+1) P_k`, which stays exact at the ends of the interval.
pub fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut here) = (0.0, 1.0);
    let (mut slope_before, mut slope) = (0.0, 0.0);
    for k in 0..n {
        let k = k as f64;
        let next = ((2.0 * k + 1.0) * x * here - k * before) / (k + 1.0);
        let slope_next = slope_before + (2.0 * k + 1.0) * here;
        (before, here) = (here, next);
        (slope_before, slope) = (slope, slope_next);
    }
    (here, slope)
}

/// A Gauss–Legendre rule on [0, 1]: exact for polynomials up to degree `2n − 1`.
///
/// Computing it costs `n²` operations: make it once and keep it.
///
/// ```
/// let rule = forcewright_base::quadrature::GaussLegendre::new(3);
/// assert!((rule.integrate(|u| u * u * u * u * u) - 1.0 / 6.0).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct GaussLegendre {
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

impl GaussLegendre {
    /// The rule with `n` points, by Newton's method on `P_n` from the asymptotic zeros `cos(π (i − ¼)/(n + ½))`
    /// (Abramowitz & Stegun 22.16.6); accurate to rounding for any `n`.
    pub fn new(n: usize) -> Self {
        let (mut nodes, mut weights) = (vec![0.0; n], vec![0.0; n]);
        for i in 0..n.div_ceil(2) {
            let mut x = maths::cos(PI * (i as f64 + 0.75) / (n as f64 + 0.5));
            for _ in 0..10 {
                let (value, slope) = legendre(n, x);
                let change = value / slope;
                x -= change;
                if change.abs() < 1e-16 {
                    break;
                }
            }
            if 2 * i + 1 == n {
                x = 0.0;
            }
            let (_, slope) = legendre(n, x);
            // 2/((1−x²) P'²) on [−1, 1]; half of it on [0, 1].
            let weight = 1.0 / ((1.0 - x * x) * slope * slope);
            nodes[i] = 0.5 * (1.0 - x);
            nodes[n - 1 - i] = 0.5 * (1.0 + x);
            weights[i] = weight;
            weights[n - 1 - i] = weight;
        }
        Self { nodes, weights }
    }

    /// The points, ascending in (0, 1).
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// The weights, positive, with sum 1.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The integral of `f` over [0, 1].
    pub fn integrate(&self, mut f: impl FnMut(f64) -> f64) -> f64 {
        self.nodes.iter().zip(&self.weights).map(|(&u, &w)| w * f(u)).sum()
    }
}

/// Weight of a value among `count` values at even distances in their mean by Simpson's rule; `count` is odd and at least 3.
pub fn simpson_weight(place: usize, count: usize) -> f64 {
    let weight = if place == 0 || place + 1 == count {
        1.0
    } else if place % 2 == 1 {
        4.0
    } else {
        2.0
    };
    weight / (3.0 * (count - 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_points_in_closed_form() {
        let rule = GaussLegendre::new(3);
        let offset = 0.5 * 0.6_f64.sqrt();
        for (got, want) in rule.nodes().iter().zip([0.5 - offset, 0.5, 0.5 + offset]) {
            assert!((got - want).abs() < 1e-16);
        }
        for (got, want) in rule.weights().iter().zip([5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0]) {
            assert!((got - want).abs() < 1e-15);
        }
    }

    #[test]
    fn exact_to_degree_2n_minus_1_and_not_beyond() {
        for n in [1, 2, 5, 8, 13, 24, 48, 64, 200] {
            let rule = GaussLegendre::new(n);
            for degree in [0, 1, n, 2 * n - 1] {
                let got = rule.integrate(|u| maths::powi(u, i32::try_from(degree).unwrap()));
                let want = 1.0 / (degree + 1) as f64;
                assert!((got - want).abs() < 4e-15, "n {n} degree {degree}: {got} {want}");
            }
            assert!((rule.weights().iter().sum::<f64>() - 1.0).abs() < 1e-14);
        }
        assert!((GaussLegendre::new(2).integrate(|u| u * u * u * u) - 0.2).abs() > 1e-3);
    }

    #[test]
    fn simpson_s_rule_is_exact_for_cubics() {
        for count in [3, 5, 21] {
            let mean =
                |f: &dyn Fn(f64) -> f64| -> f64 { (0..count).map(|i| simpson_weight(i, count) * f(i as f64 / (count - 1) as f64)).sum() };
            assert!((mean(&|u| 1.0 + u * u * u) - 1.25).abs() < 1e-15);
            assert!((mean(&|u| u * u * u * u) - 0.2).abs() > 1e-8);
        }
    }

    #[test]
    fn smooth_integrand() {
        let got = GaussLegendre::new(20).integrate(|u| maths::exp(3.0 * u));
        assert!((got - (maths::exp(3.0) - 1.0) / 3.0).abs() < 1e-14);
    }

    #[test]
    fn empty_rule_integrates_to_zero() {
        assert!(GaussLegendre::new(0).integrate(|_| 1.0).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn polynomials_and_slopes_in_closed_form() {
        let x = 0.3;
        let p4 = (35.0 * x * x * x * x - 30.0 * x * x + 3.0) / 8.0;
        let d4 = (140.0 * x * x * x - 60.0 * x) / 8.0;
        let (value, slope) = legendre(4, x);
        assert!((value - p4).abs() < 1e-15 && (slope - d4).abs() < 1e-14);
        let (value, slope) = legendre(7, 1.0);
        assert!((value - 1.0).abs() < 1e-15 && (slope - 28.0).abs() < 1e-13);
        let mut values = [0.0; 6];
        legendre_values(x, &mut values);
        for (n, value) in values.iter().enumerate() {
            assert!((value - legendre(n, x).0).abs() < 1e-15);
        }
    }
}
