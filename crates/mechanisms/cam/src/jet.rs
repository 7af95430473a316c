//! Numbers with their derivatives: the head of a Taylor series in one variable.
//!
//! The path of a roller is a short formula of which three derivatives are needed: position, direction, curvature and the rate of
//! change of the curvature. Sums, products, quotients and roots of such series give them exactly (A. Griewank, A. Walther,
//! "Evaluating Derivatives", 2nd ed., SIAM 2008, chapter 13).

use std::ops::{Add, Div, Mul, Neg, Sub};

use forcewright_base::maths;

/// A value with its first three derivatives divided by their factorials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet(pub(crate) [f64; 4]);

impl Jet {
    /// A number that does not vary.
    #[inline]
    pub fn constant(value: f64) -> Self {
        Self([value, 0.0, 0.0, 0.0])
    }

    /// The variable itself.
    #[inline]
    pub fn variable(value: f64) -> Self {
        Self([value, 1.0, 0.0, 0.0])
    }

    /// The value.
    #[inline]
    pub fn value(&self) -> f64 {
        self.0[0]
    }

    /// The derivative of order 0 to 3.
    #[inline]
    pub fn derivative(&self, order: usize) -> f64 {
        const FACTORIAL: [f64; 4] = [1.0, 1.0, 2.0, 6.0];
        self.0[order] * FACTORIAL[order]
    }

    /// Its square root; not a number below zero, without finite derivatives at zero.
    #[inline]
    pub fn sqrt(self) -> Self {
        let Self(a) = self;
        let r = a[0].sqrt();
        let half = 0.5 / r;
        let r1 = a[1] * half;
        let r2 = (a[2] - r1 * r1) * half;
        Self([r, r1, r2, (a[3] - 2.0 * r1 * r2) * half])
    }

    /// Sine and cosine of an angle in rad.
    pub fn sin_cos(self) -> [Self; 2] {
        let Self(a) = self;
        let (s, c) = maths::sin_cos(a[0]);
        let (mut sine, mut cosine) = ([s, 0.0, 0.0, 0.0], [c, 0.0, 0.0, 0.0]);
        // n sₙ = Σ k aₖ cₙ₋ₖ and n cₙ = −Σ k aₖ sₙ₋ₖ, from s′ = a′c and c′ = −a′s.
        for n in 1..4 {
            let sum = |other: &[f64; 4]| (1..=n).map(|k| k as f64 * a[k] * other[n - k]).sum::<f64>() / n as f64;
            let (up, down) = (sum(&cosine), sum(&sine));
            (sine[n], cosine[n]) = (up, -down);
        }
        [Self(sine), Self(cosine)]
    }
}

impl Add for Jet {
    type Output = Self;

    #[inline]
    fn add(self, Self(b): Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + b[i]))
    }
}

impl Sub for Jet {
    type Output = Self;

    #[inline]
    fn sub(self, Self(b): Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - b[i]))
    }
}

impl Neg for Jet {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl Mul for Jet {
    type Output = Self;

    #[inline]
    fn mul(self, Self(b): Self) -> Self {
        let a = self.0;
        Self([
            a[0] * b[0],
            a[0] * b[1] + a[1] * b[0],
            a[0] * b[2] + a[1] * b[1] + a[2] * b[0],
            a[0] * b[3] + a[1] * b[2] + a[2] * b[1] + a[3] * b[0],
        ])
    }
}

impl Mul<f64> for Jet {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}

impl Div for Jet {
    type Output = Self;

    #[inline]
    fn div(self, Self(b): Self) -> Self {
        let (a, over) = (self.0, 1.0 / b[0]);
        let q0 = a[0] * over;
        let q1 = (a[1] - q0 * b[1]) * over;
        let q2 = (a[2] - q0 * b[2] - q1 * b[1]) * over;
        Self([q0, q1, q2, (a[3] - q0 * b[3] - q1 * b[2] - q2 * b[1]) * over])
    }
}

impl Add<f64> for Jet {
    type Output = Self;

    #[inline]
    fn add(mut self, shift: f64) -> Self {
        self.0[0] += shift;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// sin²+cos² = 1 in every order, and the derivatives of sin(x²) by hand.
    #[test]
    fn derivatives_of_sine_and_cosine() {
        let x = Jet::variable(0.6);
        let [s, c] = (x * x).sin_cos();
        let one = s * s + c * c;
        assert!((one.0[0] - 1.0).abs() < 1e-15 && one.0[1..].iter().all(|e| e.abs() < 1e-15), "{one:?}");
        let (sin, cos) = maths::sin_cos(0.36);
        let by_hand = [sin, 1.2 * cos, 2.0 * cos - 1.44 * sin, -7.2 * sin - 1.728 * cos];
        for (order, expected) in by_hand.into_iter().enumerate() {
            assert!((s.derivative(order) - expected).abs() < 1e-14, "{order}");
        }
    }

    /// Derivatives of √(1 + x²)/(2 + x) at x = 0.7 against those of the formula differentiated by hand.
    #[test]
    fn derivatives_of_a_quotient_with_a_root() {
        let x = Jet::variable(0.7);
        let root = (x * x + 1.0).sqrt();
        let r = 1.49_f64.sqrt();
        for (order, expected) in [r, 0.7 / r, 1.0 / (r * r * r), -3.0 * 0.7 / (r * r * r * r * r)].into_iter().enumerate() {
            assert!((root.derivative(order) - expected).abs() < 1e-15, "{order}");
        }
        let quotient = root / (x + 2.0);
        let back = quotient * (x + 2.0) - root;
        assert!(back.0.iter().all(|c| c.abs() < 1e-15));
    }
}
