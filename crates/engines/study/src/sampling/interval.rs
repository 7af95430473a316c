//! What is known of a number that was estimated from a sample.

use super::{beta, normal};

/// How often intervals of this kind contain the truth: a probability inside (0, 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Confidence(f64);

impl Confidence {
    /// 95 %.
    pub const P95: Self = Self(0.95);

    /// `None` outside (0, 1).
    pub fn new(level: f64) -> Option<Self> {
        (0.0 < level && level < 1.0).then_some(Self(level))
    }

    /// The probability.
    pub fn level(self) -> f64 {
        self.0
    }

    /// Probability left on each side of a two-sided interval.
    fn side(self) -> f64 {
        0.5 * (1.0 - self.0)
    }
}

/// A closed interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Whether the interval contains a value.
    pub fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }
}

/// An estimate with its confidence interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The estimate, in the unit of the samples.
    pub value: f64,
    /// Its interval.
    pub interval: Interval,
}

impl Estimate {
    /// The mean of independent, identically distributed values with Student's interval `x̄ ± t √(s²/R)`. With a single value, the
    /// interval is everything; with none, the value is not a number.
    ///
    /// P. L'Ecuyer, M. K. Nakayama, A. B. Owen, B. Tuffin, "Confidence intervals for randomized quasi-Monte Carlo estimators",
    /// Winter Simulation Conference 2023, found this plain interval over replicates the most reliable one.
    ///
    /// ```
    /// use forcewright_study::sampling::{Confidence, Estimate};
    ///
    /// // t₀.₉₇₅ with two degrees of freedom is 4.3027; s/√3 is 0.57735.
    /// let estimate = Estimate::of_mean(&[1.0, 2.0, 3.0], Confidence::P95);
    /// assert!((estimate.interval.high - 2.0 - 4.302_652_73 * 0.577_350_27).abs() < 1e-8);
    /// ```
    pub fn of_mean(values: &[f64], confidence: Confidence) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        let half = if values.len() > 1 { student(n - 1.0, confidence) * (squares / (n - 1.0) / n).sqrt() } else { f64::INFINITY };
        Self { value: mean, interval: Interval { low: mean - half, high: mean + half } }
    }
}

/// Student's quantile: `|T| ≤ t` has the probability of the confidence, for `degrees` of freedom above 0.
///
/// `P(|T| > t) = I_x(ν/2, ½)` with `x = ν / (ν + t²)` (Abramowitz & Stegun, section 26.7).
pub fn student(degrees: f64, confidence: Confidence) -> f64 {
    let x = beta::quantile(0.5 * degrees, 0.5, 1.0 - confidence.0);
    (degrees * (1.0 - x) / x).sqrt()
}

/// Fisher's quantile: `F ≤ f` has the probability of the confidence, for degrees of freedom of numerator and denominator above 0.
///
/// `P(F > f) = I_y(ν₂/2, ν₁/2)` with `y = ν₂ / (ν₂ + ν₁ f)` (Abramowitz & Stegun, section 26.6).
pub fn fisher(numerator: f64, denominator: f64, confidence: Confidence) -> f64 {
    let y = beta::quantile(0.5 * denominator, 0.5 * numerator, 1.0 - confidence.0);
    denominator * (1.0 - y) / (numerator * y)
}

/// Probability that Fisher's ratio exceeds `ratio`, for degrees of freedom of numerator and denominator above 0; 1 below 0.
///
/// `P(F > f) = I_y(ν₂/2, ν₁/2)` with `y = ν₂ / (ν₂ + ν₁ f)` (Abramowitz & Stegun, section 26.6).
pub fn fisher_tail(ratio: f64, numerator: f64, denominator: f64) -> f64 {
    beta::incomplete(0.5 * denominator, 0.5 * numerator, denominator / (denominator + numerator * ratio.max(0.0)))
}

/// Interval of the probability behind `hits` of `trials` that is never too confident: C. J. Clopper and E. S. Pearson, Biometrika
/// 26(4), 404–413, 1934, as quantiles of the beta distribution (L. D. Brown, T. T. Cai, A. `DasGupta`, "Interval estimation for a
/// binomial proportion", Statistical Science 16(2), 101–133, 2001, section 4.2.1). No trial: [0, 1].
///
/// If none of `n` failed, the interval of 95 % reaches down to `0.025^(1/n)`, about `1 − 3.7/n`. The rule of three, `1 − 3/n`, is the
/// one-sided bound, which this interval gives at a confidence of 90 %.
///
/// ```
/// use forcewright_study::sampling::{Confidence, clopper_pearson};
///
/// let none_failed = clopper_pearson(1000, 1000, Confidence::P95);
/// assert!((none_failed.low - (1.0 - 3.68 / 1000.0)).abs() < 1e-5 && none_failed.high == 1.0);
/// ```
pub fn clopper_pearson(hits: u64, trials: u64, confidence: Confidence) -> Interval {
    if trials == 0 {
        return Interval { low: 0.0, high: 1.0 };
    }
    if hits > trials / 2 {
        // Counted from the other side, where the digits are.
        let misses = clopper_pearson(trials - hits.min(trials), trials, confidence);
        return Interval { low: 1.0 - misses.high, high: 1.0 - misses.low };
    }
    let (n, k) = (trials as f64, hits as f64);
    let low = if hits == 0 { 0.0 } else { beta::quantile(k, n - k + 1.0, confidence.side()) };
    Interval { low, high: beta::quantile(k + 1.0, n - k, 1.0 - confidence.side()) }
}

/// Interval of the probability behind `hits` of `trials` that is right on average and shorter than [`clopper_pearson`]: E. B. Wilson,
/// "Probable inference, the law of succession, and statistical inference", JASA 22, 209–212, 1927; Brown, Cai & `DasGupta` 2001, eq. (4).
pub fn wilson(hits: u64, trials: u64, confidence: Confidence) -> Interval {
    if trials == 0 {
        return Interval { low: 0.0, high: 1.0 };
    }
    let (n, k) = (trials as f64, hits.min(trials) as f64);
    let z = -normal::quantile(confidence.side());
    let middle = (k + 0.5 * z * z) / (n + z * z);
    let half = z / (n + z * z) * (k * (n - k) / n + 0.25 * z * z).sqrt();
    Interval { low: (middle - half).max(0.0), high: (middle + half).min(1.0) }
}

#[cfg(test)]
mod tests {
    use forcewright_base::maths::{exp, ln, ln_gamma};

    use super::*;

    /// `SciPy` 1.17.1, `scipy.stats.t.ppf`; one and two degrees of freedom have closed forms.
    #[test]
    fn student_quantiles() {
        let p99 = Confidence::new(0.99).unwrap();
        for (degrees, want_95, want_99) in [
            (1.0, 12.706_204_736_174_694, 63.656_741_162_871_526),
            (2.0, 4.302_652_729_749_462, 9.924_843_200_918_287),
            (7.0, 2.364_624_251_592_784, 3.499_483_297_350_492_4),
            (15.0, 2.131_449_545_559_776, 2.946_712_883_475_238),
            (100.0, 1.983_971_518_523_551_8, 2.625_890_521_438_017_3),
        ] {
            assert!((student(degrees, Confidence::P95) / want_95 - 1.0).abs() < 1e-12, "{degrees}");
            assert!((student(degrees, p99) / want_99 - 1.0).abs() < 1e-11, "{degrees}");
        }
    }

    /// Tables of Abramowitz & Stegun, 26.9 (upper 5 % and 1 %); with one degree above, the square of Student's; with two below, a closed form.
    #[test]
    fn fisher_quantiles() {
        let p99 = Confidence::new(0.99).unwrap();
        for (above, below, want_95, want_99) in [(3.0, 10.0, 3.71, 6.55), (5.0, 20.0, 2.71, 4.10), (10.0, 4.0, 5.96, 14.55)] {
            assert!((fisher(above, below, Confidence::P95) - want_95).abs() < 0.005, "{above} {below}");
            assert!((fisher(above, below, p99) - want_99).abs() < 0.005, "{above} {below}");
        }
        for degrees in [1.0, 3.0, 12.0, 100.0] {
            let t = student(degrees, p99);
            assert!((fisher(1.0, degrees, p99) / (t * t) - 1.0).abs() < 1e-12, "{degrees}");
            // With two degrees above: P(F > f) = (1 + 2f/ν)^(−ν/2).
            let f = fisher(2.0, degrees, p99);
            assert!((exp(-0.5 * degrees * ln(1.0 + 2.0 * f / degrees)) / 0.01 - 1.0).abs() < 1e-11, "{degrees}");
        }
    }

    /// Tables of Abramowitz & Stegun, 26.9; with two degrees above a closed form, `(1 + 2f/ν)^(−ν/2)`; with one, Student's.
    #[test]
    fn fisher_tails() {
        for (above, below, at_5, at_1) in [(3.0, 10.0, 3.71, 6.55), (5.0, 20.0, 2.71, 4.10), (10.0, 4.0, 5.96, 14.55)] {
            assert!((fisher_tail(at_5, above, below) - 0.05).abs() < 2e-4, "{above} {below}");
            assert!((fisher_tail(at_1, above, below) - 0.01).abs() < 1e-4, "{above} {below}");
        }
        for degrees in [1.0, 3.0, 12.0, 100.0] {
            let t = student(degrees, Confidence::P95);
            assert!((fisher_tail(t * t, 1.0, degrees) / 0.05 - 1.0).abs() < 1e-11, "{degrees}");
            assert!((fisher_tail(3.0, 2.0, degrees) / exp(-0.5 * degrees * ln(1.0 + 6.0 / degrees)) - 1.0).abs() < 1e-12, "{degrees}");
        }
        assert!((fisher_tail(-1.0, 2.0, 3.0) - 1.0).abs() < f64::EPSILON);
    }

    /// `SciPy` 1.17.1, `beta.ppf`; the Wilson interval is the pair of roots of `(p̂ − p)² = z² p (1 − p) / n`.
    #[test]
    fn binomial_intervals() {
        let near = |got: Interval, low: f64, high: f64| {
            assert!((got.low - low).abs() < 1e-12 && (got.high - high).abs() < 1e-12, "{got:?} {low} {high}");
        };
        near(clopper_pearson(1, 10, Confidence::P95), 0.002_528_578_544_461_785, 0.445_016_117_028_195_4);
        near(clopper_pearson(5, 50, Confidence::P95), 0.033_275_093_589_022_47, 0.218_135_366_434_202_25);
        near(clopper_pearson(999_990, 1_000_000, Confidence::P95), 0.999_981_609_721_108_7, 0.999_995_204_601_222_5);
        for (k, n) in [(0, 5), (1, 10), (57, 60), (60, 60)] {
            let wilson = wilson(k, n, Confidence::P95);
            let z = 1.959_963_984_540_054;
            for p in [wilson.low, wilson.high] {
                let off = k as f64 / n as f64 - p;
                assert!((off * off - z * z * p * (1.0 - p) / n as f64).abs() < 1e-15, "{k} of {n}");
            }
        }
        near(clopper_pearson(0, 100, Confidence::P95), 0.0, 1.0 - exp(ln(0.025) / 100.0));
        near(clopper_pearson(100, 100, Confidence::new(0.9).unwrap()), exp(ln(0.05) / 100.0), 1.0);
        assert_eq!(clopper_pearson(0, 0, Confidence::P95), wilson(0, 0, Confidence::P95));
    }

    /// Summed over the binomial distribution itself, no sampling: Clopper–Pearson covers at least its confidence everywhere.
    #[test]
    fn clopper_pearson_is_never_too_confident() {
        let (n, mut wilson_least) = (60_u64, 1.0_f64);
        let ln_choose = |k: u64| ln_gamma(n as f64 + 1.0) - ln_gamma(k as f64 + 1.0) - ln_gamma((n - k) as f64 + 1.0);
        let of_all = |interval: fn(u64, u64, Confidence) -> Interval| (0..=n).map(|k| interval(k, n, Confidence::P95)).collect::<Vec<_>>();
        let (exact, short) = (of_all(clopper_pearson), of_all(wilson));
        for i in 1..200 {
            let p = f64::from(i) / 200.0;
            let covered = |intervals: &[Interval]| -> f64 {
                let chance = |k: u64| exp(ln_choose(k) + k as f64 * ln(p) + (n - k) as f64 * ln(1.0 - p));
                (0..=n).zip(intervals).filter(|(_, interval)| interval.contains(p)).map(|(k, _)| chance(k)).sum()
            };
            assert!(covered(&exact) >= 0.95, "{p}: {}", covered(&exact));
            wilson_least = wilson_least.min(covered(&short));
        }
        assert!((0.83..0.95).contains(&wilson_least), "{wilson_least}");
    }

    #[test]
    fn means_of_few_values() {
        let one = Estimate::of_mean(&[2.0], Confidence::P95);
        assert!(one.interval.contains(-1e300) && one.interval.contains(1e300));
        assert!(Estimate::of_mean(&[], Confidence::P95).value.is_nan());
        assert!([0.0, 1.0, f64::NAN].iter().all(|level| Confidence::new(*level).is_none()));
        assert!((Confidence::P95.level() - 0.95).abs() < f64::EPSILON);
    }
}
