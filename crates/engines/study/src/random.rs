//! Random numbers of searches: one stream, drawn by one thread, the same for a seed on every machine.

use crate::sampling::{mixed, normal};

/// The step of the counter (the golden ratio of 2⁶⁴).
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// `SplitMix64`: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    /// The stream of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        // Neighbouring seeds are far apart.
        Self(mixed(seed ^ 0x5851_F42D_4C95_7F2D))
    }

    fn next(&mut self) -> u64 {
        let word = mixed(self.0);
        self.0 = self.0.wrapping_add(STEP);
        word
    }

    /// Evenly in [0, 1), in steps of 2⁻⁵³.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / 9_007_199_254_740_992.0
    }

    /// Standard normal: the quantile of the middle of one of 2⁵² equal parts, which is a double.
    pub(crate) fn normal(&mut self) -> f64 {
        normal::quantile(((self.next() >> 12) as f64 + 0.5) / 4_503_599_627_370_496.0)
    }

    /// A whole number from 0 up to, and without, `n`; 0 for none.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        // The bias of the upper half of a product of 64 bits is n/2⁶⁴.
        usize::try_from((u128::from(self.next()) * n as u128) >> 64).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means and variances of 10⁵ numbers within five standard deviations of theirs, and every value below six as often as the others.
    #[test]
    fn numbers_are_even() {
        let mut random = Random::new(3);
        let n = 100_000_u32;
        let draws: Vec<f64> = (0..n).map(|_| random.unit()).collect();
        let mean = draws.iter().sum::<f64>() / f64::from(n);
        let square = draws.iter().map(|u| u * u).sum::<f64>() / f64::from(n);
        assert!((mean - 0.5).abs() < 5.0 / (12.0 * f64::from(n)).sqrt());
        // The variance of u² is 1/5 − 1/9.
        assert!((square - 1.0 / 3.0).abs() < 5.0 * (4.0 / 45.0 / f64::from(n)).sqrt());
        let mut counts = [0.0; 6];
        (0..n).for_each(|_| counts[random.below(6)] += 1.0);
        // χ² of five degrees of freedom is below 20.5 in 999 of 1000 cases.
        let mean = f64::from(n) / 6.0;
        assert!(counts.iter().map(|c: &f64| (c - mean) * (c - mean) / mean).sum::<f64>() < 20.5);
        assert_eq!(random.below(0), 0);
    }
}
