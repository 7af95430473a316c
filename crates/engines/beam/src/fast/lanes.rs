//! Four beams side by side: arithmetic on four doubles at once, written so that the compiler turns it into vector instructions.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use forcewright_base::maths;

/// Beams per lane group.
pub(crate) const LANES: usize = 4;

/// One number of each of four beams.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Lane(pub(crate) [f64; LANES]);

macro_rules! elementwise {
    ($($trait:ident $method:ident $op:tt),*) => {$(
        impl $trait for Lane {
            type Output = Self;

            #[inline]
            fn $method(self, other: Self) -> Self {
                let (a, b) = (self.0, other.0);
                Self([a[0] $op b[0], a[1] $op b[1], a[2] $op b[2], a[3] $op b[3]])
            }
        }

        impl $trait<f64> for Lane {
            type Output = Self;

            #[inline]
            fn $method(self, b: f64) -> Self {
                let a = self.0;
                Self([a[0] $op b, a[1] $op b, a[2] $op b, a[3] $op b])
            }
        }
    )*};
}

elementwise!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Neg for Lane {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        let a = self.0;
        Self([-a[0], -a[1], -a[2], -a[3]])
    }
}

impl AddAssign for Lane {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lane {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Lane {
    pub(crate) const ZERO: Self = Self([0.0; LANES]);

    #[inline]
    pub(crate) fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline]
    pub(crate) fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }

    /// Elementwise larger one; a NaN in `other` is kept.
    #[inline]
    pub(crate) fn max(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        let pick = |a: f64, b: f64| if a > b { a } else { b };
        Self([pick(a[0], b[0]), pick(a[1], b[1]), pick(a[2], b[2]), pick(a[3], b[3])])
    }

    /// Whether every lane exceeds a limit; NaN does not.
    #[inline]
    pub(crate) fn all_above(self, limit: Self) -> bool {
        self.0.iter().zip(limit.0).all(|(a, b)| *a > b)
    }

    /// Sine and cosine, wrong by at most 1e-15. Half the angle by its Taylor series, which is exact to a double up to 1.25 rad, doubled;
    /// larger angles go to the scalar functions.
    #[inline]
    pub(crate) fn sin_cos(self) -> (Self, Self) {
        const LARGEST: f64 = 2.5;
        let [a, b, c, d] = self.0.map(f64::abs);
        // Written so that NaN goes there too.
        if !(a <= LARGEST && b <= LARGEST && c <= LARGEST && d <= LARGEST) {
            let pairs = self.0.map(maths::sin_cos);
            return (Self(pairs.map(|p| p.0)), Self(pairs.map(|p| p.1)));
        }
        let half = self * 0.5;
        let z = half * half;
        let mut sin = Self::splat(SIN[9]);
        for c in SIN[..9].iter().rev() {
            sin = sin * z + *c;
        }
        sin = sin * half;
        let mut cos = Self::splat(COS[9]);
        for c in COS[..9].iter().rev() {
            cos = cos * z + *c;
        }
        (sin * cos * 2.0, Self::splat(1.0) - sin * sin * 2.0)
    }
}

/// (−1)ᵏ/(2k + 1)!
const SIN: [f64; 10] = [
    1.0,
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
    -1.0 / 121_645_100_408_832_000.0,
];
/// (−1)ᵏ/(2k)!
const COS: [f64; 10] = [
    1.0,
    -1.0 / 2.0,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
    -1.0 / 6_402_373_705_728_000.0,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_and_cosines_are_those_of_the_library() {
        let mut worst = 0.0_f64;
        for i in -4000..4000 {
            let x = f64::from(i) * 1e-3;
            let angles = [x, 0.5 * x, -x, 0.1 * x];
            let (sin, cos) = Lane(angles).sin_cos();
            for (lane, x) in angles.into_iter().enumerate() {
                worst = worst.max((sin.0[lane] - maths::sin(x)).abs()).max((cos.0[lane] - maths::cos(x)).abs());
            }
        }
        // Doubling doubles the rounding of the half angle.
        assert!(worst < 1e-15, "{worst:e}");
    }
}
