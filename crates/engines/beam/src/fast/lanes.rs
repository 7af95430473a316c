//! Four beams, or four designs, side by side: arithmetic on four doubles at once, written so that the compiler turns it into vector instructions.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use fearless_simd::Level;
use forcewright_base::maths;

/// Beams per lane group.
pub(crate) const LANES: usize = 4;

/// The vector instructions of this processor, asked for once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vectors(
    #[cfg_attr(
        not(any(target_arch = "x86", target_arch = "x86_64")),
        allow(dead_code, reason = "elsewhere those of the target are all that there are")
    )]
    Level,
);

impl Vectors {
    pub(crate) fn new() -> Self {
        Self(Level::new())
    }

    /// Does work in lanes with four numbers per instruction where the processor can (AVX2), else with what every one can. Functions that
    /// `work` calls without being inlined into it go on with the latter. Each operation is rounded by itself, never two as one, so that
    /// the result is the same bits.
    #[inline(always)]
    pub(crate) fn run<R>(self, work: impl FnOnce() -> R) -> R {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        if let Some(four) = self.0.as_avx2() {
            return fearless_simd::Simd::vectorize(four, work);
        }
        work()
    }
}

/// One number of each of four beams, or of one beam of four designs. Aligned, so that arithmetic can take it from memory without a load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
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
        let a = self.0;
        Self([a[0].abs(), a[1].abs(), a[2].abs(), a[3].abs()])
    }

    /// Elementwise larger one; a NaN in `other` is kept.
    #[inline]
    pub(crate) fn max(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        let pick = |a: f64, b: f64| if a > b { a } else { b };
        Self([pick(a[0], b[0]), pick(a[1], b[1]), pick(a[2], b[2]), pick(a[3], b[3])])
    }

    /// Elementwise smaller one; a NaN in `other` is kept.
    #[inline]
    pub(crate) fn min(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        let pick = |a: f64, b: f64| if a < b { a } else { b };
        Self([pick(a[0], b[0]), pick(a[1], b[1]), pick(a[2], b[2]), pick(a[3], b[3])])
    }

    /// `value` in the lanes in which `a` exceeds `b`, `other` elsewhere.
    #[inline]
    pub(crate) fn where_above(a: Self, b: Self, value: Self, other: Self) -> Self {
        Self(std::array::from_fn(|i| if a.0[i] > b.0[i] { value.0[i] } else { other.0[i] }))
    }

    #[inline]
    pub(crate) fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    /// Whether every lane exceeds a limit; NaN does not.
    #[inline]
    pub(crate) fn all_above(self, limit: Self) -> bool {
        let (a, b) = (self.0, limit.0);
        a[0] > b[0] && a[1] > b[1] && a[2] > b[2] && a[3] > b[3]
    }

    /// Sine and cosine, wrong by at most 1e-15. Half the angle by its Taylor series, which is exact to a double up to 1.25 rad, doubled;
    /// larger angles go to the scalar functions.
    #[inline]
    pub(crate) fn sin_cos(self) -> (Self, Self) {
        const LARGEST: f64 = 2.5;
        let [a, b, c, d] = self.abs().0;
        // Written so that NaN goes there too.
        if !(a <= LARGEST && b <= LARGEST && c <= LARGEST && d <= LARGEST) {
            let pairs = self.0.map(maths::sin_cos);
            return (Self(pairs.map(|p| p.0)), Self(pairs.map(|p| p.1)));
        }
        // Two terms fewer are as exact up to 0.6 rad.
        if a <= SMALL && b <= SMALL && c <= SMALL && d <= SMALL { series::<7>(self) } else { series::<9>(self) }
    }

    /// Sine and cosine by a series of fixed length, so that no lane depends on the others: wrong by at most 1e-9 up to
    /// [`Lane::MODERATE`] rad.
    #[inline(always)]
    pub(crate) fn sin_cos_moderate(self) -> (Self, Self) {
        series::<6>(self)
    }

    /// See [`Lane::sin_cos_moderate`].
    pub(crate) const MODERATE: f64 = 2.4;

    /// Sine and cosine of angles of any size, wrong by at most 1e-15 up to 50 rad. Takes away the nearest multiple of π, which changes
    /// no more than both signs.
    pub(crate) fn sin_cos_reduced(self) -> (Self, Self) {
        // Written so that NaN goes there too.
        if !self.0.iter().all(|x| x.abs() <= 50.0) {
            let pairs = self.0.map(maths::sin_cos);
            return (Self(pairs.map(|p| p.0)), Self(pairs.map(|p| p.1)));
        }
        self.sin_cos_turned()
    }

    /// The same for angles known to be that small; no lane depends on the others.
    #[inline]
    pub(crate) fn sin_cos_turned(self) -> (Self, Self) {
        let turns = nearest(self * std::f64::consts::FRAC_1_PI);
        let rest = self - turns * PI_HIGH - turns * PI_LOW;
        let odd = turns - nearest(turns * 0.5) * 2.0;
        let sign = Self::splat(1.0) - odd.abs() * 2.0;
        let (sin, cos) = series::<9>(rest);
        (sin * sign, cos * sign)
    }
}

/// Below this the short series do.
const SMALL: f64 = 1.2;
/// The first 33 bits of π, so that products with small integers are exact, and the rest.
const PI_HIGH: f64 = 2.0 * 1.570_796_326_734_125_6;
const PI_LOW: f64 = 2.0 * 6.077_100_506_506_192e-11;

/// The nearest integer of numbers below 2⁵¹: adding 1.5·2⁵² leaves no room for a fraction.
#[inline]
fn nearest(x: Lane) -> Lane {
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    (x + SHIFT) - Lane::splat(SHIFT)
}

/// Sine and cosine by the series of half the angle with the terms up to `LAST`.
#[inline(always)]
fn series<const LAST: usize>(x: Lane) -> (Lane, Lane) {
    let half = x * 0.5;
    let z = half * half;
    let mut sin = Lane::splat(SIN[LAST]);
    for c in SIN[..LAST].iter().rev() {
        sin = sin * z + *c;
    }
    sin = sin * half;
    let mut cos = Lane::splat(COS[LAST]);
    for c in COS[..LAST].iter().rev() {
        cos = cos * z + *c;
    }
    (sin * cos * 2.0, Lane::splat(1.0) - sin * sin * 2.0)
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

    #[test]
    fn the_series_of_fixed_length_is_as_exact_as_it_says() {
        let mut worst = 0.0_f64;
        for i in 0..=2400 {
            let x = 1e-3 * f64::from(i);
            let angles = [x, -x, 0.5 * x, Lane::MODERATE];
            let (sin, cos) = Lane(angles).sin_cos_moderate();
            for (lane, x) in angles.into_iter().enumerate() {
                worst = worst.max((sin.0[lane] - maths::sin(x)).abs()).max((cos.0[lane] - maths::cos(x)).abs());
            }
        }
        assert!(worst < 1e-9, "{worst:e}");
    }

    #[test]
    fn multiples_of_half_a_turn_are_taken_away() {
        let mut worst = 0.0_f64;
        for i in -6000..6000 {
            let x = f64::from(i) * 1e-2;
            let angles = [x, 0.5 * x, -x, 0.1 * x + 1.5];
            let (sin, cos) = Lane(angles).sin_cos_reduced();
            for (lane, x) in angles.into_iter().enumerate() {
                worst = worst.max((sin.0[lane] - maths::sin(x)).abs()).max((cos.0[lane] - maths::cos(x)).abs());
            }
        }
        assert!(worst < 1e-15, "{worst:e}");
    }
}
