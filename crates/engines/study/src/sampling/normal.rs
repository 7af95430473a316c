//! The standard normal distribution.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use forcewright_base::maths::{erfc, exp, ln};

/// Density `φ(x) = exp(−x²/2) / √(2π)`.
pub fn density(x: f64) -> f64 {
    exp(-0.5 * x * x) / (2.0 * PI).sqrt()
}

/// Probability `Φ(x)` of a value below `x`; in the lower tail with a relative error of about `x²` roundings.
///
/// ```
/// assert!((forcewright_study::sampling::normal::cdf(-3.0) - 1.349_898_031_630_094_5e-3).abs() < 1e-17);
/// ```
pub fn cdf(x: f64) -> f64 {
    0.5 * erfc(-x * FRAC_1_SQRT_2)
}

/// Probability of a value between two bounds, 0 if they are the wrong way round; no digits are lost in either tail.
pub fn between(low: f64, high: f64) -> f64 {
    if low >= high {
        0.0
    } else if low > 0.0 {
        cdf(-low) - cdf(-high)
    } else {
        cdf(high) - cdf(low)
    }
}

/// The value below which lies the probability `p`: `Φ⁻¹(p)`; −∞ at 0, ∞ at 1, not a number outside [0, 1].
///
/// M. J. Wichura, "Algorithm AS 241: the percentage points of the normal distribution", Applied Statistics 37(3), 477–484, 1988:
/// the routine PPND16, three quotients of polynomials with a relative error of about 1e-16.
///
/// ```
/// assert!((forcewright_study::sampling::normal::quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-15);
/// ```
pub fn quantile(p: f64) -> f64 {
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.180_625 - q * q;
        return q * polynomial(&CENTRE_OVER, r) / polynomial(&CENTRE_UNDER, r);
    }
    let tail = if q < 0.0 { p } else { 1.0 - p };
    if tail <= 0.0 || tail.is_nan() {
        return if tail == 0.0 { f64::INFINITY.copysign(q) } else { f64::NAN };
    }
    let r = (-ln(tail)).sqrt();
    let size = if r <= 5.0 {
        polynomial(&SHOULDER_OVER, r - 1.6) / polynomial(&SHOULDER_UNDER, r - 1.6)
    } else {
        polynomial(&TAIL_OVER, r - 5.0) / polynomial(&TAIL_UNDER, r - 5.0)
    };
    size.copysign(q)
}

/// Lowest power first.
fn polynomial(coefficients: &[f64; 8], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// Wichura's a₀ … a₇: |p − ½| ≤ 0.425.
const CENTRE_OVER: [f64; 8] = [
    3.387_132_872_796_366_5,
    1.331_416_678_917_843_8e2,
    1.971_590_950_306_551_3e3,
    1.373_169_376_550_946e4,
    4.592_195_393_154_987e4,
    6.726_577_092_700_87e4,
    3.343_057_558_358_813e4,
    2.509_080_928_730_122_7e3,
];

/// 1, b₁ … b₇.
const CENTRE_UNDER: [f64; 8] = [
    1.0,
    4.231_333_070_160_091e1,
    6.871_870_074_920_579e2,
    5.394_196_021_424_751e3,
    2.121_379_430_158_659_7e4,
    3.930_789_580_009_271e4,
    2.872_908_573_572_194_3e4,
    5.226_495_278_852_545e3,
];

/// c₀ … c₇: a tail of at least exp(−25).
const SHOULDER_OVER: [f64; 8] = [
    1.423_437_110_749_683_5,
    4.630_337_846_156_546,
    5.769_497_221_460_691,
    3.647_848_324_763_204_5,
    1.270_458_252_452_368_4,
    2.417_807_251_774_506e-1,
    2.272_384_498_926_918_4e-2,
    7.745_450_142_783_414e-4,
];

/// 1, d₁ … d₇.
const SHOULDER_UNDER: [f64; 8] = [
    1.0,
    2.053_191_626_637_759,
    1.676_384_830_183_803_8,
    6.897_673_349_851e-1,
    1.481_039_764_274_800_8e-1,
    1.519_866_656_361_645_7e-2,
    5.475_938_084_995_345e-4,
    1.050_750_071_644_416_9e-9,
];

/// e₀ … e₇: beyond.
const TAIL_OVER: [f64; 8] = [
    6.657_904_643_501_103,
    5.463_784_911_164_114,
    1.784_826_539_917_291_3,
    2.965_605_718_285_048_7e-1,
    2.653_218_952_657_612_4e-2,
    1.242_660_947_388_078_4e-3,
    2.711_555_568_743_487_6e-5,
    2.010_334_399_292_288_1e-7,
];

/// 1, f₁ … f₇.
const TAIL_UNDER: [f64; 8] = [
    1.0,
    5.998_322_065_558_88e-1,
    1.369_298_809_227_358e-1,
    1.487_536_129_085_061_5e-2,
    7.868_691_311_456_133e-4,
    1.846_318_317_510_054_8e-5,
    1.421_511_758_316_446e-7,
    2.044_263_103_389_939_8e-15,
];

#[cfg(test)]
mod tests {
    use super::*;

    /// mpmath with 40 digits: the root of `Φ(x) = p` for the number `p` as stored.
    #[test]
    fn quantiles_to_the_last_digits() {
        for (p, want) in [
            (1e-300, -37.047_096_299_361_2),
            (1e-20, -9.262_340_089_798_408),
            (1e-10, -6.361_340_902_404_056),
            (1e-6, -4.753_424_308_822_899),
            (0.001_35, -2.999_976_992_703_393),
            (0.025, -1.959_963_984_540_054_2),
            (0.075, -1.439_531_470_938_456),
            (0.25, -0.674_489_750_196_081_7),
            (0.4, -0.253_347_103_135_799_7),
            (0.7, 0.524_400_512_708_040_7),
            (0.93, 1.475_791_028_179_171),
            (0.975, 1.959_963_984_540_053_9),
            (0.9999, 3.719_016_485_455_708_4),
        ] {
            let got = quantile(p);
            assert!((got / want - 1.0).abs() < 5e-16, "{p}: {got} {want}");
        }
        assert!(quantile(0.5).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn probabilities_to_the_last_digits() {
        for (x, want) in [
            (-20.0, 2.753_624_118_606_233_7e-89),
            (-8.0, 6.220_960_574_271_784e-16),
            (-3.0, 1.349_898_031_630_094_5e-3),
            (-1.0, 0.158_655_253_931_457_05),
            (0.5, 0.691_462_461_274_013_1),
            (5.0, 0.999_999_713_348_428_1),
        ] {
            let got = cdf(x);
            assert!((got / want - 1.0).abs() < 1e-16 * (3.0 + x * x), "{x}: {got} {want}");
        }
        assert!((between(7.0, 8.0) / between(-8.0, -7.0) - 1.0).abs() < 1e-15);
        assert!((between(f64::NEG_INFINITY, f64::INFINITY) - 1.0).abs() < f64::EPSILON && between(1.0, 1.0) == 0.0);
        assert!(density(1.0) - 0.241_970_724_519_143_37 < 1e-16);
    }

    /// `Φ` through `erfc` and `Φ⁻¹` through Wichura's quotients know nothing of each other.
    #[test]
    fn each_inverts_the_other() {
        for i in 1..4000 {
            let x = f64::from(i) * 0.009_37 - 37.0;
            if x < 5.0 {
                // An error of one rounding of p moves x by p ε / φ(x).
                let p = cdf(x);
                let slack = 4.0 * f64::EPSILON * (1.0 + x.abs() + p / density(x));
                assert!((quantile(p) - x).abs() < slack, "{x}");
            }
        }
    }

    #[test]
    fn ends_and_nonsense() {
        assert_eq!((quantile(0.0), quantile(1.0)), (f64::NEG_INFINITY, f64::INFINITY));
        assert!([-0.1, 1.1, f64::NAN].iter().all(|p| quantile(*p).is_nan()));
        assert!(quantile(f64::MIN_POSITIVE) < -37.5 && quantile(1.0 - f64::EPSILON) > 8.0);
    }
}
