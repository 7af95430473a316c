//! Random form errors along a curve.
//!
//! A Gaussian process with mean 0 and the covariance `σ² exp(−τ² / 2ℓ²)` of two places at the distance `τ`: deviations of standard deviation
//! `σ` that keep together over the correlation length `ℓ`, as cutting and milling leave them; with slopes of the standard deviation `σ / ℓ`
//! and second derivatives of `√3 σ / ℓ²` (`rasmussen-williams2006`, section 4.2.1). A force that follows from slopes therefore depends on
//! `ℓ` as much as on `σ`.
//!
//! A draw is a sum of waves `σ/√M Σ aₖ cos ωₖt + bₖ sin ωₖt`, with frequencies drawn from the spectrum of the covariance (a normal
//! distribution of deviation `1/ℓ`) and normal amplitudes: smooth, with exact derivatives, and with the covariance exactly as stated over
//! all draws (`rahimi-recht2007`, with spread frequencies). Within one draw it repeats nothing over some hundred correlation lengths.
//!
//! ```
//! use forcewright_curves::waviness::Waviness;
//!
//! let error = Waviness::new(23e-6, 10.5e-3, 7).expect("above 0");
//! let [value_m, slope, second_per_m] = error.derivatives(0.05);
//! assert!(value_m.abs() < 4.0 * 23e-6 && slope.abs() < 4.0 * 23e-6 / 10.5e-3 && second_per_m.is_finite());
//! ```

use std::f64::consts::TAU;

use forcewright_base::maths::{ln, sin_cos};

/// Pairs of waves.
const PAIRS: u32 = 32;
/// Waves.
const WAVES: usize = 2 * PAIRS as usize;
/// Steps of a table after which all waves are computed afresh: rounding does not add up.
const AFRESH: usize = 128;

/// One random error: a smooth function of the place along a curve. The same seed gives the same bits on every machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Waviness {
    waves: Vec<Wave>,
}

/// Wave number in 1/m, amplitudes in m.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wave {
    wavenumber: f64,
    cos_part: f64,
    sin_part: f64,
}

impl Waviness {
    /// A draw with a standard deviation (m, at least 0) and a correlation length (m, above 0). Absent if they are not such numbers.
    pub fn new(deviation_m: f64, correlation_length_m: f64, seed: u64) -> Option<Self> {
        if !(deviation_m >= 0.0 && deviation_m.is_finite() && correlation_length_m > 0.0 && correlation_length_m.is_finite()) {
            return None;
        }
        let mut random = Random { state: seed };
        let amplitude = deviation_m / f64::from(2 * PAIRS).sqrt();
        let mut waves = Vec::new();
        for pair in 0..PAIRS {
            // Two frequencies by the polar method of Box and Muller. Their radii are spread, one in each of equal shares of the probability:
            // then the slopes of every draw have nearly the variance of all of them.
            let share = (f64::from(pair) + random.uniform()) / f64::from(PAIRS);
            let radius_per_m = (-2.0 * ln(share)).sqrt() / correlation_length_m;
            let (sin, cos) = sin_cos(TAU * random.uniform());
            for wavenumber in [radius_per_m * cos, radius_per_m * sin] {
                let [cos_part, sin_part] = random.normals().map(|normal| amplitude * normal);
                waves.push(Wave { wavenumber, cos_part, sin_part });
            }
        }
        Some(Self { waves })
    }

    /// Error (m), its slope, and its second derivative (1/m) at a place along the curve, m.
    pub fn derivatives(&self, place_m: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for Wave { wavenumber, cos_part, sin_part } in &self.waves {
            let (sin, cos) = sin_cos(wavenumber * place_m);
            let (value, turned) = (cos_part * cos + sin_part * sin, sin_part * cos - cos_part * sin);
            sum[0] += value;
            sum[1] += wavenumber * turned;
            sum[2] -= wavenumber * wavenumber * value;
        }
        sum
    }

    /// The error tabulated from one place along the curve to another, m, at steps of at most this length, m. With a sixteenth of the
    /// correlation length its value is exact to about 1e-13 of its deviation, its slope to 1e-11 of its own, its second derivative to 1e-9; with a
    /// half to 1e-5, 1e-4 and 1e-3.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of steps, at least one")]
    pub fn table(&self, [from_m, to_m]: [f64; 2], step_m: f64) -> WavinessTable {
        let intervals = ((to_m - from_m) / step_m).ceil().max(1.0) as usize;
        let step_m = (to_m - from_m) / intervals as f64;
        let mut nodes = Vec::with_capacity(intervals + 1);
        let mut bundle = Bundle::of(&self.waves, step_m);
        for i in 0..=intervals {
            if i % AFRESH == 0 {
                bundle.put(&self.waves, from_m + i as f64 * step_m);
            }
            nodes.push(bundle.next(step_m));
        }
        WavinessTable { from_m, step_m, nodes }
    }

    /// Error at a place along the curve, m.
    pub fn value_m(&self, place_m: f64) -> f64 {
        self.derivatives(place_m)[0]
    }
}

/// All waves at one place, ready to be turned on by a step: no sine or cosine is computed on the way. In rows of equal length, so that
/// the processor takes several waves at once.
struct Bundle {
    /// Value of each wave and its derivative over the phase, m.
    value: [f64; WAVES],
    turned: [f64; WAVES],
    /// Cosine and sine of the phase of a step.
    cos: [f64; WAVES],
    sin: [f64; WAVES],
    wavenumber: [f64; WAVES],
}

impl Bundle {
    fn of(waves: &[Wave], step_m: f64) -> Self {
        let mut new = Self { value: [0.0; WAVES], turned: [0.0; WAVES], cos: [1.0; WAVES], sin: [0.0; WAVES], wavenumber: [0.0; WAVES] };
        for (i, wave) in waves.iter().enumerate() {
            (new.sin[i], new.cos[i]) = sin_cos(wave.wavenumber * step_m);
            new.wavenumber[i] = wave.wavenumber;
        }
        new
    }

    /// Puts all waves at a place.
    fn put(&mut self, waves: &[Wave], place_m: f64) {
        for (i, wave) in waves.iter().enumerate() {
            let (sin, cos) = sin_cos(wave.wavenumber * place_m);
            self.value[i] = wave.cos_part * cos + wave.sin_part * sin;
            self.turned[i] = wave.sin_part * cos - wave.cos_part * sin;
        }
    }

    /// Value and derivatives up to the third, the step being the unit of length; then all waves are turned on by a step.
    #[expect(clippy::needless_range_loop, reason = "four lanes side by side, for the processor")]
    fn next(&mut self, step_m: f64) -> [f64; 4] {
        const LANES: usize = 4;
        let mut sums = [[0.0; LANES]; 4];
        for at in (0..WAVES).step_by(LANES) {
            for lane in 0..LANES {
                let i = at + lane;
                let (value, turned, k) = (self.value[i], self.turned[i], self.wavenumber[i]);
                let (first, second) = (k * turned, k * k);
                sums[0][lane] += value;
                sums[1][lane] += first;
                sums[2][lane] -= second * value;
                sums[3][lane] -= second * first;
                self.value[i] = value * self.cos[i] + turned * self.sin[i];
                self.turned[i] = turned * self.cos[i] - value * self.sin[i];
            }
        }
        let mut unit = 1.0;
        sums.map(|sum| {
            let total = (sum[0] + sum[1] + (sum[2] + sum[3])) * unit;
            unit *= step_m;
            total
        })
    }
}

/// An error at even places along a curve, with a polynomial of seventh degree between them: the one that has the values and three
/// derivatives at both ends.
#[derive(Clone, Debug, PartialEq)]
pub struct WavinessTable {
    from_m: f64,
    step_m: f64,
    /// Value and three derivatives, the step being the unit of length.
    nodes: Vec<[f64; 4]>,
}

impl WavinessTable {
    /// Error (m), its slope, and its second derivative (1/m) at a place along the curve, m; absent outside the table.
    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it was compared with both ends")]
    pub fn derivatives(&self, place_m: f64) -> Option<[f64; 3]> {
        let over = (place_m - self.from_m) / self.step_m;
        let last = self.nodes.len() - 1;
        if !(over >= 0.0 && over <= last as f64) {
            return None;
        }
        let i = (over as usize).min(last - 1);
        let t = over - i as f64;
        let ([f, f1, f2, f3], [g, g1, g2, g3]) = (self.nodes[i], self.nodes[i + 1]);
        // Taylor's polynomial of the start, and what it misses at the end.
        let (c2, c3) = (0.5 * f2, f3 / 6.0);
        let a = g - (f + f1 + c2 + c3);
        let b = g1 - (f1 + f2 + 0.5 * f3);
        let c = g2 - (f2 + f3);
        let d = g3 - f3;
        let c4 = 35.0 * a - 15.0 * b + 2.5 * c - d / 6.0;
        let c5 = -84.0 * a + 39.0 * b - 7.0 * c + 0.5 * d;
        let c6 = 70.0 * a - 34.0 * b + 6.5 * c - 0.5 * d;
        let c7 = -20.0 * a + 10.0 * b - 2.0 * c + d / 6.0;
        let value = f + t * (f1 + t * (c2 + t * (c3 + t * (c4 + t * (c5 + t * (c6 + t * c7))))));
        let slope = f1 + t * (f2 + t * (0.5 * f3 + t * (4.0 * c4 + t * (5.0 * c5 + t * (6.0 * c6 + t * 7.0 * c7)))));
        let second = f2 + t * (f3 + t * (12.0 * c4 + t * (20.0 * c5 + t * (30.0 * c6 + t * 42.0 * c7))));
        Some([value, slope / self.step_m, second / (self.step_m * self.step_m)])
    }
}

/// `SplitMix64` (`steele2014`), with the constants of D. Stafford's variant 13.
struct Random {
    state: u64,
}

impl Random {
    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let x = self.state;
        let x = (x ^ x >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ x >> 31
    }

    /// In (0, 1].
    fn uniform(&mut self) -> f64 {
        ((self.next() >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }

    /// Two independent standard normal numbers (`box-muller1958`).
    fn normals(&mut self) -> [f64; 2] {
        let radius = (-2.0 * ln(self.uniform())).sqrt();
        let (sin, cos) = sin_cos(TAU * self.uniform());
        [radius * cos, radius * sin]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use forcewright_base::maths::exp;

    const SIGMA: f64 = 0.023e-3;
    const LENGTH: f64 = 10.5e-3;
    const DRAWS: u64 = 20_000;

    /// Mean over draws of a product of two normal numbers with the variances `a`, `b` and the covariance `c`: its standard deviation is
    /// √((ab + c²)/n). The bound is four of them.
    fn agrees(mean: f64, covariance: f64, variances: [f64; 2]) {
        let deviation = ((variances[0] * variances[1] + covariance * covariance) / DRAWS as f64).sqrt();
        assert!((mean - covariance).abs() < 4.0 * deviation, "{mean:e} instead of {covariance:e} ± {deviation:e}");
    }

    /// Covariances of values, slopes and second derivatives over many draws, at distances from 0 to 3 correlation lengths.
    #[test]
    fn covariances_are_those_of_the_process() {
        let lags = [0.0, 0.3, 1.0, 1.7, 3.0];
        let mut sums = [[0.0; 5]; 5];
        for seed in 0..DRAWS {
            let draw = Waviness::new(SIGMA, LENGTH, seed).unwrap();
            // Far from 0, where all waves begin in step with their amplitudes.
            let [value, slope, second] = draw.derivatives(0.2);
            for (sum, lag) in sums.iter_mut().zip(lags) {
                let [other, other_slope, other_second] = draw.derivatives(0.2 + lag * LENGTH);
                let products = [value * other, slope * other_slope, value * other_slope, second * other_second, value];
                for (s, p) in sum.iter_mut().zip(products) {
                    *s += p / DRAWS as f64;
                }
            }
        }
        let (v, s, c) = (SIGMA * SIGMA, SIGMA * SIGMA / (LENGTH * LENGTH), 3.0 * SIGMA * SIGMA / (LENGTH * LENGTH * LENGTH * LENGTH));
        for (sum, x) in sums.iter().zip(lags) {
            // Derivatives of exp(−x²/2): Hermite polynomials.
            let bell = exp(-0.5 * x * x);
            agrees(sum[0], v * bell, [v, v]);
            agrees(sum[1], s * (1.0 - x * x) * bell, [s, s]);
            agrees(sum[2], -v / LENGTH * x * bell, [v, s]);
            agrees(sum[3], c / 3.0 * (x * x * x * x - 6.0 * x * x + 3.0) * bell, [c, c]);
        }
        assert!(sums[0][4].abs() < 4.0 * SIGMA / (DRAWS as f64).sqrt());
    }

    /// The variance to 1.5 %, from eight places of each draw, 30 correlation lengths apart. Squares at two of them have the covariance 1/64
    /// that all amplitudes together give them, and each the variance 2.
    #[test]
    fn the_variance_is_the_one_asked_for() {
        let squares = |seed: u64| {
            let draw = Waviness::new(1.0, 1.0, seed).unwrap();
            (1..=8).map(|k| draw.value_m(30.0 * f64::from(k))).map(|x| x * x).sum::<f64>() / 8.0
        };
        let variance = (0..DRAWS).map(squares).sum::<f64>() / DRAWS as f64;
        let deviation = ((2.0 / 8.0 + 1.0 / 64.0) / DRAWS as f64).sqrt();
        assert!((variance - 1.0).abs() < 4.0 * deviation, "{variance} {deviation}");
    }

    /// A normal distribution, not only its variance: the fourth moment is three squares of the second. Its estimate from n draws has the
    /// variance (105 − 9)/n.
    #[test]
    fn values_are_normal() {
        let fourth: f64 = (0..DRAWS).map(|seed| Waviness::new(1.0, LENGTH, seed).unwrap().value_m(0.1)).map(|x| x * x * x * x).sum();
        assert!((fourth / DRAWS as f64 - 3.0).abs() < 4.0 * (96.0 / DRAWS as f64).sqrt(), "{}", fourth / DRAWS as f64);
    }

    /// Along one draw of 400 correlation lengths the variance is that of the process: with the area √π ℓ under the squared correlation
    /// the mean of squares has a standard deviation of √(2 √π ℓ / T) = 9.4 %.
    #[test]
    fn one_long_draw_has_the_variance_of_all() {
        let (mut value, mut slope, count) = (0.0, 0.0, 4000);
        let draw = Waviness::new(SIGMA, LENGTH, 3).unwrap();
        for k in 0..count {
            let [e, e1, _] = draw.derivatives(0.1 * LENGTH * f64::from(k));
            value += e * e / f64::from(count) / (SIGMA * SIGMA);
            slope += e1 * e1 / f64::from(count) * (LENGTH * LENGTH) / (SIGMA * SIGMA);
        }
        // And the amplitudes of 64 waves: √(1/64) = 12.5 % more.
        assert!((value - 1.0).abs() < 0.5 && (slope - 1.0).abs() < 0.6, "{value} {slope}");
    }

    #[test]
    fn derivatives_belong_together() {
        let draw = Waviness::new(1.0, 1.0, 11).unwrap();
        for k in 0..50 {
            let (at, step) = (0.37 * f64::from(k), 1e-5);
            let (before, here, after) = (draw.derivatives(at - step), draw.derivatives(at), draw.derivatives(at + step));
            for order in 0..2 {
                let slope = (after[order] - before[order]) / (2.0 * step);
                assert!((slope - here[order + 1]).abs() < 1e-8, "{at} {order}");
            }
        }
    }

    /// A table at a sixteenth and at half of the correlation length against the waves themselves, to what its description says.
    #[test]
    fn a_table_agrees_with_its_waves() {
        for seed in 0..20 {
            let draw = Waviness::new(SIGMA, LENGTH, seed).unwrap();
            for (parts, bounds) in [(16.0, [2e-13, 2e-11, 2e-9]), (2.0, [2e-5, 2e-4, 2e-3])] {
                let table = draw.table([0.01, 0.3], LENGTH / parts);
                for k in 0..=1000 {
                    let place = 0.01 + 0.29 * f64::from(k) / 1000.0;
                    let (exact, found) = (draw.derivatives(place), table.derivatives(place).expect("inside"));
                    let unit = [SIGMA, SIGMA / LENGTH, SIGMA / (LENGTH * LENGTH)];
                    for order in 0..3 {
                        let off = (found[order] - exact[order]).abs() / unit[order];
                        assert!(off < bounds[order], "{seed} {place} {order}: {off:e}");
                    }
                }
                assert_eq!((table.derivatives(0.0099), table.derivatives(0.3001), table.derivatives(f64::NAN)), (None, None, None));
            }
        }
    }

    #[test]
    fn seeds_differ_and_bad_numbers_are_refused() {
        let value = |seed| Waviness::new(1.0, 1.0, seed).unwrap().value_m(0.5);
        assert_eq!(value(4).to_bits(), value(4).to_bits());
        assert!((value(4) - value(5)).abs() > 1e-3);
        assert!(Waviness::new(0.0, 1.0, 1).unwrap().value_m(0.3).abs() < f64::MIN_POSITIVE);
        for (deviation, length) in [(-1.0, 1.0), (1.0, 0.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
            assert_eq!(Waviness::new(deviation, length, 0), None);
        }
    }
}
