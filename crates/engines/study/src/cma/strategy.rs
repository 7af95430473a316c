//! One distribution: drawn from, and moved by the order of what was drawn.
//!
//! Symbols are those of N. Hansen, "The CMA evolution strategy: a tutorial", arXiv:1604.00772 (`hansen2016`), whose figure 6 and table 1 this
//! is; equations are cited by their numbers there.

use forcewright_base::maths::{exp, ln, powi};

use crate::calibrate::Singular;
use crate::random::Random;

/// Growth of the step size where the best are equal, `hansen2016`, appendix B.4.
const FLAT: f64 = 0.2;

/// Weights and rates: table 1 of `hansen2016`.
#[derive(Clone, Debug)]
struct Rates {
    /// One per point, the best first; those of the worse half are negative.
    weights: Vec<f64>,
    mu: usize,
    mu_eff: f64,
    c_sigma: f64,
    d_sigma: f64,
    c_c: f64,
    c_1: f64,
    c_mu: f64,
    /// Expected length of a standard normal vector.
    length: f64,
}

impl Rates {
    fn new(n: f64, population: usize) -> Self {
        let raw: Vec<f64> = (1..=population).map(|i| ln(f64::midpoint(population as f64, 1.0)) - ln(i as f64)).collect();
        let mu = population / 2;
        let effective = |w: &[f64]| {
            let (sum, squares) = w.iter().fold((0.0, 0.0), |(s, q), w| (s + w, q + w * w));
            if squares > 0.0 { sum * sum / squares } else { 0.0 }
        };
        let (mu_eff, mu_eff_minus) = (effective(&raw[..mu]), effective(&raw[mu..]));
        let c_c = (4.0 + mu_eff / n) / (n + 4.0 + 2.0 * mu_eff / n);
        let c_sigma = (mu_eff + 2.0) / (n + mu_eff + 5.0);
        let d_sigma = 1.0 + 2.0 * (((mu_eff - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma;
        let c_1 = 2.0 / ((n + 1.3) * (n + 1.3) + mu_eff);
        let c_mu = (1.0 - c_1).min(2.0 * (0.25 + mu_eff + 1.0 / mu_eff - 2.0) / ((n + 2.0) * (n + 2.0) + mu_eff));
        // Eqs. (50) to (53): the negative weights neither outweigh the positive ones nor make the matrix indefinite.
        let most_negative = (1.0 + c_1 / c_mu).min(1.0 + 2.0 * mu_eff_minus / (mu_eff + 2.0)).min((1.0 - c_1 - c_mu) / (n * c_mu));
        let positive: f64 = raw.iter().filter(|w| **w >= 0.0).sum();
        let negative: f64 = raw.iter().filter(|w| **w < 0.0).map(|w| -w).sum();
        let scaled = |w: &f64| if *w >= 0.0 { w / positive } else { most_negative * w / negative };
        let length = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        Self { weights: raw.iter().map(scaled).collect(), mu, mu_eff, c_sigma, d_sigma, c_c, c_1, c_mu, length }
    }
}

/// A point drawn: in the coordinates of the axes, and as a step from the mean, over the step size.
#[derive(Clone, Debug)]
pub(super) struct Draw {
    z: Vec<f64>,
    y: Vec<f64>,
}

/// Why a distribution cannot go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Worn {
    /// Steps along an axis or a coordinate are lost in the rounding of the mean.
    NoEffect,
    /// The longest axis is 10⁷ times the shortest.
    Condition,
    /// It is no distribution any more.
    Broken,
}

/// Largest condition number of the covariances, `hansen2016`, appendix B.3.
const CONDITION: f64 = 1e14;

/// The normal distribution `m + σ N(0, C)`.
#[derive(Clone, Debug)]
pub(super) struct Strategy {
    rates: Rates,
    pub(super) mean: Vec<f64>,
    pub(super) sigma: f64,
    covariance: Vec<f64>,
    /// Eigenvectors of C, and the roots of its eigenvalues.
    axes: Vec<Vec<f64>>,
    lengths: Vec<f64>,
    path_sigma: Vec<f64>,
    path_c: Vec<f64>,
    generation: usize,
    /// Generations since the axes were computed.
    age: usize,
}

impl Strategy {
    pub(super) fn new(mean: Vec<f64>, sigma: f64, population: usize) -> Self {
        let n = mean.len();
        let unit = |i: usize| (0..n).map(|j| f64::from(u8::from(i == j))).collect::<Vec<f64>>();
        Self {
            rates: Rates::new(n as f64, population),
            mean,
            sigma,
            covariance: (0..n).flat_map(unit).collect(),
            axes: (0..n).map(unit).collect(),
            lengths: vec![1.0; n],
            path_sigma: vec![0.0; n],
            path_c: vec![0.0; n],
            generation: 0,
            age: 0,
        }
    }

    /// Points of a generation, drawn one after the other.
    pub(super) fn draws(&self, random: &mut Random) -> Vec<Draw> {
        let one = |_| {
            let z: Vec<f64> = self.mean.iter().map(|_| random.normal()).collect();
            Draw { y: self.turned(|k| self.lengths[k] * z[k]), z }
        };
        self.rates.weights.iter().map(one).collect()
    }

    /// A vector of these coordinates along the axes.
    fn turned(&self, along: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut sum = vec![0.0; self.mean.len()];
        for (k, axis) in self.axes.iter().enumerate() {
            let part = along(k);
            sum.iter_mut().zip(axis).for_each(|(s, a)| *s += part * a);
        }
        sum
    }

    /// The place of a draw.
    pub(super) fn place(&self, draw: &Draw) -> Vec<f64> {
        self.mean.iter().zip(&draw.y).map(|(m, y)| m + self.sigma * y).collect()
    }

    /// The largest standard deviation along any axis.
    pub(super) fn longest(&self) -> f64 {
        self.sigma * self.lengths.iter().copied().fold(0.0, f64::max)
    }

    /// The largest standard deviation of any coordinate, or step that its path keeps.
    pub(super) fn widest(&self) -> f64 {
        let n = self.mean.len();
        (0..n).fold(0.0_f64, |m, i| m.max(self.covariance[i * n + i].sqrt()).max(self.path_c[i].abs())) * self.sigma
    }

    /// Moves the distribution by all draws of a generation, the best first.
    pub(super) fn learn(&mut self, order: &[&Draw]) {
        let Rates { mu, mu_eff, c_sigma, d_sigma, c_c, length, .. } = self.rates;
        self.generation += 1;
        let weighted = |of: &dyn Fn(&Draw, usize) -> f64, i: usize| {
            self.rates.weights.iter().zip(order).take(mu).map(|(w, draw)| w * of(draw, i)).sum::<f64>()
        };
        let n = self.mean.len();
        let step: Vec<f64> = (0..n).map(|i| weighted(&|d, i| d.y[i], i)).collect();
        let white: Vec<f64> = (0..n).map(|i| weighted(&|d, i| d.z[i], i)).collect();
        let white = self.turned(|k| white[k]);
        for (m, s) in self.mean.iter_mut().zip(&step) {
            *m += self.sigma * s;
        }
        // Eqs. (43) and (44): the step size follows the length of its path.
        let grow = (c_sigma * (2.0 - c_sigma) * mu_eff).sqrt();
        for (p, w) in self.path_sigma.iter_mut().zip(&white) {
            *p = (1.0 - c_sigma) * *p + grow * w;
        }
        let travelled = self.path_sigma.iter().map(|p| p * p).sum::<f64>().sqrt();
        let so_far = 1.0 - powi(1.0 - c_sigma, i32::try_from(2 * self.generation).unwrap_or(i32::MAX));
        let steady = travelled / so_far.sqrt() < (1.4 + 2.0 / (n as f64 + 1.0)) * length;
        // Eq. (45).
        let grow = if steady { (c_c * (2.0 - c_c) * mu_eff).sqrt() } else { 0.0 };
        for (p, s) in self.path_c.iter_mut().zip(&step) {
            *p = (1.0 - c_c) * *p + grow * s;
        }
        self.adapt(order, steady);
        self.sigma *= exp((c_sigma / d_sigma * (travelled / length - 1.0)).min(1.0));
        self.age += 1;
        // Axes cost more than a generation of the rest: appendix B.2.
        let seldom = 1.0 / ((self.rates.c_1 + self.rates.c_mu) * n as f64 * 10.0);
        if self.age as f64 >= seldom {
            self.decompose();
        }
    }

    /// Eqs. (46) and (47): the covariances by the path and by all draws, the worse of which take away.
    fn adapt(&mut self, order: &[&Draw], steady: bool) {
        let Rates { c_c, c_1, c_mu, .. } = self.rates;
        let n = self.mean.len();
        let lost = if steady { 0.0 } else { c_c * (2.0 - c_c) };
        let sum: f64 = self.rates.weights.iter().sum();
        let keep = 1.0 + c_1 * lost - c_1 - c_mu * sum;
        let of = |(w, draw): (&f64, &&Draw)| {
            let square = draw.z.iter().map(|z| z * z).sum::<f64>();
            if *w >= 0.0 { *w } else { w * n as f64 / square.max(f64::MIN_POSITIVE) }
        };
        let weights: Vec<f64> = self.rates.weights.iter().zip(order).map(of).collect();
        for i in 0..n {
            for j in 0..=i {
                let by_all: f64 = weights.iter().zip(order).map(|(w, d)| w * d.y[i] * d.y[j]).sum();
                let new = keep * self.covariance[i * n + j] + c_1 * self.path_c[i] * self.path_c[j] + c_mu * by_all;
                self.covariance[i * n + j] = new;
                self.covariance[j * n + i] = new;
            }
        }
    }

    fn decompose(&mut self) {
        self.age = 0;
        // Singular values of a matrix that is positive definite are its eigenvalues.
        let Singular { values, vectors } = Singular::of(self.mean.len(), &self.covariance);
        self.lengths = values.iter().map(|v| v.sqrt()).collect();
        self.axes = vectors;
    }

    /// Makes steps longer where the best of a generation are equal.
    pub(super) fn widen(&mut self) {
        self.sigma *= exp(FLAT + self.rates.c_sigma / self.rates.d_sigma);
    }

    /// Whether it has come to an end by itself.
    pub(super) fn worn(&self) -> Option<Worn> {
        let (most, least) = self.lengths.iter().fold((0.0_f64, f64::INFINITY), |(m, l), d| (m.max(*d), l.min(*d)));
        let sound = self.sigma.is_finite() && self.sigma > 0.0 && most.is_finite() && self.mean.iter().all(|m| m.is_finite());
        if !sound || self.covariance.iter().any(|c| !c.is_finite()) {
            return Some(Worn::Broken);
        }
        if least <= 0.0 || most * most > CONDITION * least * least {
            return Some(Worn::Condition);
        }
        let n = self.mean.len();
        let axis = self.generation % n.max(1);
        let same = |m: f64, by: f64| (m + by).to_bits() == m.to_bits();
        let along = self.mean.iter().zip(&self.axes[axis]).all(|(m, a)| same(*m, 0.1 * self.sigma * self.lengths[axis] * a));
        let across = (0..n).any(|i| same(self.mean[i], 0.2 * self.sigma * self.covariance[i * n + i].sqrt()));
        (along || across).then_some(Worn::NoEffect)
    }
}

/// Points of a generation, without a wish: `hansen2016`, eq. (48).
pub(super) fn usual_population(n: usize) -> usize {
    let extra = (1_usize..64).take_while(|k| ln(n.max(1) as f64) * 3.0 >= *k as f64).last().unwrap_or(0);
    4 + extra
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the program `pycma` prints of itself at its start: `(3_w,6)-aCMA-ES (mu_w=2.0,w_1=63%) in dimension 2` and
    /// `(5_w,10)-aCMA-ES (mu_w=3.2,w_1=45%) in dimension 10`.
    #[test]
    fn weights_are_those_of_the_usual_populations() {
        for (n, population, mu, mu_eff, first) in [(2, 6, 3, 2.0, 0.63), (10, 10, 5, 3.2, 0.45)] {
            assert_eq!(usual_population(n), population);
            let rates = Rates::new(n as f64, population);
            assert_eq!(rates.mu, mu);
            assert!((rates.mu_eff - mu_eff).abs() < 0.05 && (rates.weights[0] - first).abs() < 0.015, "{rates:?}");
            let positive: f64 = rates.weights.iter().filter(|w| **w > 0.0).sum();
            assert!((positive - 1.0).abs() < 1e-14 && rates.weights.is_sorted_by(|a, b| a > b));
            assert!(rates.weights.iter().sum::<f64>() < positive, "the worse half takes away");
        }
        assert_eq!([1, 3, 5, 20, 60].map(usual_population), [4, 7, 8, 12, 16]);
    }

    /// Where the order says nothing, the middle of the distribution wanders about and its size stays within what chance does.
    #[test]
    fn no_order_leads_nowhere() {
        let (n, mut random) = (5, Random::new(11));
        let mut strategy = Strategy::new(vec![0.0; n], 1.0, 8);
        for _ in 0..400 {
            let draws = strategy.draws(&mut random);
            strategy.learn(&draws.iter().collect::<Vec<_>>());
        }
        assert!(strategy.worn().is_none() && (0.02..50.0).contains(&strategy.widest()), "{}", strategy.widest());
    }

    /// Draws have the covariances that they are asked for: of 4·10⁵, each within five standard deviations.
    #[test]
    fn draws_have_their_covariances() {
        let mut random = Random::new(2);
        let mut strategy = Strategy::new(vec![1.0, -2.0], 0.5, 1000);
        strategy.covariance = vec![4.0, 1.2, 1.2, 1.0];
        strategy.decompose();
        let places: Vec<Vec<f64>> = (0..400).flat_map(|_| strategy.draws(&mut random)).map(|d| strategy.place(&d)).collect();
        let count = places.len() as f64;
        let mean = |of: &dyn Fn(&[f64]) -> f64| places.iter().map(|p| of(p)).sum::<f64>() / count;
        let [a, b] = [0, 1].map(|i| mean(&|p| p[i]));
        assert!((a - 1.0).abs() < 5.0 / count.sqrt() && (b + 2.0).abs() < 2.5 / count.sqrt());
        let (aa, ab, bb) = (mean(&|p| (p[0] - a) * (p[0] - a)), mean(&|p| (p[0] - a) * (p[1] - b)), mean(&|p| (p[1] - b) * (p[1] - b)));
        // The variance of such a mean is C_ii C_jj + C_ij².
        for (got, wanted, spread) in [(aa, 1.0, 2.0_f64), (ab, 0.3, 0.34), (bb, 0.25, 0.125)] {
            assert!((got - wanted).abs() < 5.0 * (spread / count).sqrt(), "{got} for {wanted}");
        }
    }
}
