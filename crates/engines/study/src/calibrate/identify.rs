//! What a measurement can tell of parameters: how strongly each combination of them moves the curve.

use super::linear::Singular;
use super::{Known, Parameter, Settled, scaled};

/// Deviation of a combination of parameters, in their scales, from which it counts as not determined.
const LOOSE: f64 = 0.5;
/// Singular values below this part of the largest are the error of derivatives.
const RANK: f64 = 1e-7;
/// Share of a parameter in a combination, over the largest, from which it is named.
const NAMED: f64 = 0.1;
/// Correlation from which two parameters are hardly told apart.
const TIED: f64 = 0.98;
/// Part of a prior's standard deviation that is left, from which an estimate rests on the prior.
const ON_PRIOR: f64 = 0.9;

/// A combination of parameters that hardly moves the curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Loose {
    /// Its standard deviation from the measurement alone: how many times the changes below it may be off; infinite if it moves nothing.
    pub deviation: f64,
    /// The parameters that change together, by index, each with its change in SI; the largest is as large as its scale.
    pub changes: Vec<(usize, f64)>,
}

/// What the measurement alone, without priors, can tell.
#[derive(Clone, Debug, PartialEq)]
pub struct Identified {
    /// Singular values of the Jacobian, columns times their scales, over the scatter of a point; largest first.
    pub strengths: Vec<f64>,
    /// Combinations that it does not determine, least determined first.
    pub loose: Vec<Loose>,
    /// Pairs that it hardly tells apart, though each combination is determined: indices and correlation.
    pub tied: Vec<(usize, usize, f64)>,
    /// Parameters whose estimates rest on their priors.
    pub on_priors: Vec<usize>,
}

impl Identified {
    pub(super) fn of(jacobian: &[f64], settled: &Settled, parameters: &[Parameter], known: &Known) -> Self {
        let free = &known.free;
        let scales: Vec<f64> = free.iter().map(|i| parameters[*i].scale).collect();
        let triangle = scaled(jacobian, (parameters.len(), free), &scales, Some(&settled.weights));
        let singular = Singular::of(free.len(), &triangle.r);
        let most = singular.values.first().copied().unwrap_or(0.0);
        let noise = known.noise;
        let deviation = |value: f64| if value <= RANK * most || value <= 0.0 { f64::INFINITY } else { noise / value };
        let loose = singular.values.iter().zip(&singular.vectors).rev().filter(|(value, _)| deviation(**value) > LOOSE);
        let loose: Vec<Loose> = loose
            .map(|(value, vector)| {
                let largest = vector.iter().copied().fold(0.0, |m: f64, v| if v.abs() > m.abs() { v } else { m });
                let named = vector.iter().enumerate().filter(|(_, v)| v.abs() > NAMED * largest.abs());
                let changes = named.map(|(k, v)| (free[k], v / largest * scales[k])).collect();
                Loose { deviation: deviation(*value) * largest.abs(), changes }
            })
            .collect();
        let held = |i: &usize| parameters[*i].prior.is_some_and(|p| known.errors[*i] > ON_PRIOR * p.sd);
        let on_priors = free.iter().copied().filter(held).collect();
        let strengths = singular.values.iter().map(|v| v / noise).collect();
        let tied = if loose.is_empty() { tied(&singular, free) } else { Vec::new() };
        Self { strengths, loose, tied, on_priors }
    }
}

/// Pairs whose errors from the measurement alone go together.
fn tied(singular: &Singular, free: &[usize]) -> Vec<(usize, usize, f64)> {
    let covariance = |a: usize, b: usize| singular.values.iter().zip(&singular.vectors).map(|(s, v)| v[a] * v[b] / (s * s)).sum::<f64>();
    let pairs = (0..free.len()).flat_map(|a| (a + 1..free.len()).map(move |b| (a, b)));
    let all = pairs.map(|(a, b)| (free[a], free[b], covariance(a, b) / (covariance(a, a) * covariance(b, b)).sqrt()));
    all.filter(|(_, _, r)| r.abs() > TIED).collect()
}
