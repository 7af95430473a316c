//! The beta distribution, from which the binomial and Student's follow.

use forcewright_base::maths::{exp, ln, ln_1p, ln_gamma};
use forcewright_base::roots;

/// Regularised incomplete beta function `I_x(a, b)`, `a, b > 0`: the probability that a beta variable is below `x`.
///
/// NIST Digital Library of Mathematical Functions, continued fraction 8.17.22 by Lentz's method, and the symmetry 8.17.4. The relative
/// error is about `1e-15` times the larger parameter.
pub(super) fn incomplete(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 {
        0.0
    } else if x >= 1.0 {
        1.0
    } else if x > (a + 1.0) / (a + b + 2.0) {
        1.0 - leading(b, a, 1.0 - x, ln(1.0 - x), ln(x)) * fraction(b, a, 1.0 - x)
    } else {
        leading(a, b, x, ln(x), ln_1p(-x)) * fraction(a, b, x)
    }
}

/// `x^a (1 − x)^b / (a B(a, b))`.
fn leading(a: f64, b: f64, x: f64, ln_x: f64, ln_rest: f64) -> f64 {
    debug_assert!((0.0..=1.0).contains(&x), "a probability");
    exp(a * ln_x + b * ln_rest + ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b)) / a
}

/// The continued fraction of DLMF 8.17.22; converges fast for `x < (a + 1) / (a + b + 2)`.
fn fraction(a: f64, b: f64, x: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let away = |v: f64| if v.abs() < TINY { TINY } else { v };
    let (mut c, mut d) = (1.0, 1.0 / away(1.0 - (a + b) * x / (a + 1.0)));
    let mut value = d;
    // About √max(a, b) rounds are needed: enough for samples of 10⁹.
    for k in 1..100_000 {
        let m = f64::from(k);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / away(1.0 + even * d);
        c = away(1.0 + even / c);
        value *= d * c;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / away(1.0 + odd * d);
        c = away(1.0 + odd / c);
        value *= d * c;
        if (d * c - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    value
}

/// The `x` with `I_x(a, b) = p`, for `p` in [0, 1].
pub(super) fn quantile(a: f64, b: f64, p: f64) -> f64 {
    // The ends differ in sign and no value is NaN, so there is a root; it is looked for to the last digit.
    roots::root(|x| incomplete(a, b, x) - p, 0.0, 1.0, 0.0).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use forcewright_base::maths::{asin, powi};

    use super::*;

    /// A power computed through its logarithm has as many roundings of relative error as the logarithm is large.
    #[test]
    fn closed_forms() {
        for x in [1e-6, 0.1, 0.3, 0.5, 0.77, 0.999] {
            let near =
                |got: f64, want: f64| assert!((got - want).abs() < 4.0 * f64::EPSILON * want * (1.0 - ln(want)), "{x}: {got} {want}");
            // The arcsine is well conditioned away from 1 only.
            let arc = asin(f64::min(x, 1.0 - x).sqrt()) / FRAC_PI_2;
            near(incomplete(0.5, 0.5, x), if x > 0.5 { 1.0 - arc } else { arc });
            near(incomplete(7.0, 1.0, x), powi(x, 7));
            near(incomplete(1.0, 2.0, x), x * (2.0 - x));
            near(incomplete(2.0, 3.0, x), x * x * (6.0 - 8.0 * x + 3.0 * x * x));
        }
    }

    /// mpmath with 40 digits.
    #[test]
    fn known_values() {
        for (a, b, x, want) in [
            (7.5, 0.5, 0.7, 0.022_846_613_157_684_537),
            (50.0, 80.0, 0.35, 0.210_081_725_778_506_48),
            (5000.0, 20.0, 0.997, 0.872_352_366_513_166_2),
        ] {
            let got = incomplete(a, b, x);
            assert!((got / want - 1.0).abs() < 1e-15 * (10.0 + a), "{got} {want}");
        }
        assert!(incomplete(2.0, 2.0, -0.1) == 0.0 && (incomplete(2.0, 2.0, 1.1) - 1.0).abs() < f64::EPSILON);
    }

    /// `SciPy` 1.17.1, `scipy.stats.beta.ppf`.
    #[test]
    fn quantiles() {
        for (p, a, b, want) in [
            (0.025, 1.0, 10.0, 0.002_528_578_544_461_785),
            (0.975, 2.0, 9.0, 0.445_016_117_028_195_4),
            (0.975, 6.0, 45.0, 0.218_135_366_434_202_25),
            (0.025, 10.0, 1.0, 0.691_502_892_181_239_2),
        ] {
            assert!((quantile(a, b, p) / want - 1.0).abs() < 1e-13, "{}", quantile(a, b, p));
        }
    }
}
