//! How all parameters scatter together.

use std::fmt;

use forcewright_base::quadrature::GaussLegendre;

use super::{Correlation, Distribution, normal};

/// Why parameters cannot be grouped like this.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PopulationError {
    /// A group and its correlations are of different size.
    Size {
        /// Members named.
        members: usize,
        /// Members that the correlations are for.
        correlations: usize,
    },
    /// There is no such parameter.
    NoSuchParameter {
        /// Its index.
        parameter: usize,
    },
    /// A parameter was grouped twice.
    GroupedTwice {
        /// Its index.
        parameter: usize,
    },
}

impl fmt::Display for PopulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { members, correlations } => {
                write!(f, "{members} parameters are grouped, but the correlations are for {correlations}")
            }
            Self::NoSuchParameter { parameter } => write!(f, "there is no parameter {parameter}"),
            Self::GroupedTwice { parameter } => {
                write!(f, "parameter {parameter} is grouped twice; put all that is correlated into one group")
            }
        }
    }
}

impl std::error::Error for PopulationError {}

#[derive(Debug, Clone)]
struct Group {
    members: Vec<usize>,
    correlation: Correlation,
}

/// The joint distribution of all parameters: one distribution each, and groups of correlated ones, joined by Gaussian copulas.
///
/// ```
/// use forcewright_study::sampling::{Correlation, Distribution, Population, Sobol};
///
/// // Two plates cut from one sheet: 90 % of the variance of the thickness is common.
/// let thickness = Distribution::normal(1.0, 0.02)?;
/// let plates = Population::independent(vec![thickness; 2]).correlate(&[0, 1], Correlation::common(2, 0.9)?)?;
/// let sobol = Sobol::scrambled(plates.len(), 1)?;
/// let (mut unit, mut sum) = ([0.0; 2], 0.0);
/// for i in 0..4096 {
///     sobol.point(i, &mut unit);
///     let mut t = unit;
///     plates.draw(&mut t);
///     sum += (t[0] + t[1] - 2.0) * (t[0] + t[1] - 2.0);
/// }
/// // The variance of the sum is 2 σ² (1 + ρ).
/// assert!((sum / 4096.0 / (2.0 * 0.02 * 0.02 * 1.9) - 1.0).abs() < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Population {
    marginals: Vec<Distribution>,
    groups: Vec<Group>,
}

impl Population {
    /// Every parameter by itself.
    pub fn independent(marginals: Vec<Distribution>) -> Self {
        Self { marginals, groups: Vec::new() }
    }

    /// Correlates the normal scores of some parameters. A parameter can be in one group only.
    ///
    /// # Errors
    /// [`PopulationError`].
    pub fn correlate(mut self, members: &[usize], correlation: Correlation) -> Result<Self, PopulationError> {
        if members.len() != correlation.size() {
            return Err(PopulationError::Size { members: members.len(), correlations: correlation.size() });
        }
        for (i, &parameter) in members.iter().enumerate() {
            if parameter >= self.len() {
                return Err(PopulationError::NoSuchParameter { parameter });
            }
            if members[..i].contains(&parameter) || self.groups.iter().any(|g| g.members.contains(&parameter)) {
                return Err(PopulationError::GroupedTwice { parameter });
            }
        }
        self.groups.push(Group { members: members.to_vec(), correlation });
        Ok(self)
    }

    /// Number of parameters.
    pub fn len(&self) -> usize {
        self.marginals.len()
    }

    /// Whether there is no parameter.
    pub fn is_empty(&self) -> bool {
        self.marginals.is_empty()
    }

    /// The distribution of each parameter by itself.
    pub fn marginals(&self) -> &[Distribution] {
        &self.marginals
    }

    /// The parameters in sets that are independent of each other, in the order of their first members: each correlated group, and
    /// every other parameter by itself.
    pub fn factors(&self) -> Vec<Vec<usize>> {
        let group_of = |parameter: usize| self.groups.iter().find(|g| g.members.contains(&parameter));
        let mut factors = Vec::new();
        for parameter in 0..self.len() {
            match group_of(parameter) {
                None => factors.push(vec![parameter]),
                Some(group) if group.members.iter().min() == Some(&parameter) => {
                    let mut members = group.members.clone();
                    members.sort_unstable();
                    factors.push(members);
                }
                Some(_) => {}
            }
        }
        factors
    }

    /// Replaces a point of the open unit cube, a coordinate for each parameter, by the parameters at that point.
    ///
    /// With evenly spread points the parameters are spread as they should be. Coordinates that are missing or beyond the number of
    /// parameters are ignored; a group of which a coordinate is missing is left uncorrelated.
    pub fn draw(&self, point: &mut [f64]) {
        let (mut grouped, given) = (vec![false; self.len()], point.len());
        for group in self.groups.iter().filter(|g| g.members.iter().all(|m| *m < given)) {
            let scores: Vec<f64> = group.members.iter().map(|m| normal::quantile(point[*m])).collect();
            for (i, &member) in group.members.iter().enumerate() {
                let score = group.correlation.row(i)[..=i].iter().zip(&scores).map(|(l, e)| l * e).sum();
                point[member] = self.marginals[member].at_score(score);
                grouped[member] = true;
            }
        }
        for ((value, marginal), grouped) in point.iter_mut().zip(&self.marginals).zip(grouped) {
            if !grouped {
                *value = marginal.quantile(*value);
            }
        }
    }

    /// Covariances of the parameters, row-major, each in the product of their units.
    ///
    /// In groups, of the parameters themselves, not of their scores: by Mehler's expansion `Σ ρᵏ a_k b_k` in the coefficients of both
    /// quantile functions by normalised Hermite polynomials (H. O. Lancaster, Biometrika 44, 289–292, 1957).
    pub fn covariance(&self) -> Vec<f64> {
        let n = self.len();
        let mut matrix = vec![0.0; n * n];
        for (i, marginal) in self.marginals.iter().enumerate() {
            matrix[i * n + i] = marginal.sd() * marginal.sd();
        }
        for group in &self.groups {
            let series: Vec<Vec<f64>> = group.members.iter().map(|m| hermite_series(&self.marginals[*m])).collect();
            for (i, &row) in group.members.iter().enumerate() {
                for (j, &column) in group.members[..i].iter().enumerate() {
                    let rho = group.correlation.between(i, j);
                    let terms = series[i].iter().zip(&series[j]).rev();
                    let covariance = terms.fold(0.0, |sum, (a, b)| (sum + a * b) * rho);
                    matrix[row * n + column] = covariance;
                    matrix[column * n + row] = covariance;
                }
            }
        }
        matrix
    }
}

/// Coefficients `a₁, a₂, …` of the parameter as a function of its normal score, by normalised Hermite polynomials. What is left out
/// goes into the last coefficient, so that their squares add up to the variance.
fn hermite_series(marginal: &Distribution) -> Vec<f64> {
    const TERMS: usize = 40;
    let variance = marginal.sd() * marginal.sd();
    if marginal.is_normal() {
        return vec![marginal.sd()];
    }
    let rule = GaussLegendre::new(16);
    let mut sums = vec![0.0; TERMS];
    // Panels of an eighth, up to scores beyond which no f64 probability differs from 1.
    for panel in -68..68 {
        for (node, weight) in rule.nodes().iter().zip(rule.weights()) {
            let z = (f64::from(panel) + node) / 8.0;
            let scaled = weight / 8.0 * normal::density(z) * (marginal.at_score(z) - marginal.mean());
            let (mut before, mut hermite) = (1.0, z);
            for (k, sum) in sums.iter_mut().enumerate() {
                *sum += scaled * hermite;
                // √(k+1) h_{k+1} = z h_k − √k h_{k−1}, with k counted from 1 here.
                let k = k as f64 + 1.0;
                (before, hermite) = (hermite, (z * hermite - k.sqrt() * before) / (k + 1.0).sqrt());
            }
        }
    }
    let found: f64 = sums.iter().map(|a| a * a).sum();
    sums.push((variance - found).max(0.0).sqrt());
    sums
}

#[cfg(test)]
mod tests {
    use forcewright_base::maths::asin;

    use super::*;
    use crate::sampling::Sobol;

    fn drawn(population: &Population, n: usize) -> Vec<f64> {
        let mut points = vec![0.0; n * population.len()];
        Sobol::scrambled(population.len(), 3).unwrap().fill(0, &mut points);
        points.chunks_exact_mut(population.len()).for_each(|row| population.draw(row));
        points
    }

    fn sample_covariance(points: &[f64], n: usize, i: usize, j: usize) -> f64 {
        let count = (points.len() / n) as f64;
        let mean = |k: usize| points.iter().skip(k).step_by(n).sum::<f64>() / count;
        let (a, b) = (mean(i), mean(j));
        points.chunks_exact(n).map(|row| (row[i] - a) * (row[j] - b)).sum::<f64>() / count
    }

    /// Unequal distributions in a group, and others between them that stay alone.
    fn mixed() -> Population {
        let marginals = vec![
            Distribution::normal(5.0, 2.0).unwrap(),
            Distribution::uniform(0.0, 1.0).unwrap(),
            Distribution::normal(1.0, 0.1).unwrap(),
            Distribution::triangular(-1.0, 0.0, 3.0).unwrap(),
            Distribution::truncated_normal(0.0, 1.0, -0.5, 2.0).unwrap(),
        ];
        let correlation = Correlation::new(3, &[1.0, 0.7, -0.4, 0.7, 1.0, 0.2, -0.4, 0.2, 1.0]).unwrap();
        Population::independent(marginals).correlate(&[3, 0, 4], correlation).unwrap()
    }

    #[test]
    fn sampled_moments_are_those_said() {
        let population = mixed();
        let n = population.len();
        let points = drawn(&population, 1 << 16);
        let covariance = population.covariance();
        for (i, a) in population.marginals().iter().enumerate() {
            let mean = points.iter().skip(i).step_by(n).sum::<f64>() / 65_536.0;
            assert!((mean - a.mean()).abs() < 1e-4 * a.sd());
            for (j, b) in population.marginals().iter().enumerate() {
                let off = (sample_covariance(&points, n, i, j) - covariance[i * n + j]) / (a.sd() * b.sd());
                assert!(off.abs() < 6e-4, "{i} {j}: {off}");
            }
        }
        assert_eq!(population.factors(), [vec![0, 3, 4], vec![1], vec![2]]);
    }

    /// Of two uniform parameters the correlation is `6/π asin(ρ/2)`; of normal ones it is ρ; of a normal and a uniform one
    /// `ρ √(3/π)`.
    #[test]
    fn covariances_in_closed_form() {
        let uniform = Distribution::uniform(0.0, 12.0_f64.sqrt()).unwrap();
        let normal = Distribution::normal(0.0, 1.0).unwrap();
        let between = |a, b, rho| {
            Population::independent(vec![a, b]).correlate(&[0, 1], Correlation::common(2, rho).unwrap()).unwrap().covariance()[1]
        };
        let pi = std::f64::consts::PI;
        for rho in [-1.0, -0.9, 0.0, 0.3, 0.9, 1.0] {
            assert!((between(uniform, uniform, rho) - 6.0 / pi * asin(0.5 * rho)).abs() < 1e-12, "{rho}");
            assert!((between(normal, normal, rho) - rho).abs() < 1e-15);
            assert!((between(normal, uniform, rho) - rho * (3.0 / pi).sqrt()).abs() < 1e-13);
        }
        // Fully tied and alike: the variance itself.
        let triangular = Distribution::triangular(0.0, 0.0, 1.0).unwrap();
        assert!((between(triangular, triangular, 1.0) - 1.0 / 18.0).abs() < 1e-15);
    }

    /// Correlation must change the yield: `P(|X + Y| ≤ c) = 2Φ(c / √(2 + 2ρ)) − 1`.
    #[test]
    fn correlation_changes_the_yield_of_a_sum() {
        let normal = Distribution::normal(0.0, 1.0).unwrap();
        let c = 1.5;
        for rho in [-0.9, 0.0, 0.9] {
            let pair = Population::independent(vec![normal; 2]).correlate(&[0, 1], Correlation::common(2, rho).unwrap()).unwrap();
            let inside = drawn(&pair, 1 << 16).chunks_exact(2).filter(|row| (row[0] + row[1]).abs() <= c).count();
            let closed = 1.0 - 2.0 * normal::cdf(-c / (2.0_f64 + 2.0 * rho).sqrt());
            assert!((inside as f64 / 65_536.0 - closed).abs() < 2e-4, "{rho}: {inside} {closed}");
        }
    }

    #[test]
    fn impossible_groups_are_named() {
        use PopulationError::{GroupedTwice, NoSuchParameter, Size};
        let population = || Population::independent(vec![Distribution::uniform(0.0, 1.0).unwrap(); 3]);
        let pair = || Correlation::common(2, 0.5).unwrap();
        let error = |members: &[usize]| population().correlate(members, pair()).unwrap_err();
        assert_eq!(error(&[0]), Size { members: 1, correlations: 2 });
        assert_eq!(error(&[0, 3]), NoSuchParameter { parameter: 3 });
        assert_eq!(error(&[1, 1]), GroupedTwice { parameter: 1 });
        let grouped = population().correlate(&[0, 1], pair()).unwrap();
        assert_eq!(grouped.correlate(&[1, 2], pair()).unwrap_err(), GroupedTwice { parameter: 1 });
        // Points of the wrong length: no panic.
        let grouped = population().correlate(&[0, 2], pair()).unwrap();
        grouped.draw(&mut [0.5]);
        grouped.draw(&mut [0.5; 7]);
        assert!(!grouped.is_empty() && Population::independent(Vec::new()).is_empty());
    }
}
