//! The linear system of a quintic smoothing spline, in its third derivative.
//!
//! The third derivative is a combination of the quadratic B-splines `N_j` on the knots `t_j … t_{j+3}`, `f‴ = Σ γ_j N_j`. With
//! `∫ N_j f‴ dt = 2 (t_{j+3} − t_j) [t_j, …, t_{j+3}] f` (Peano), the minimum of `Σ w (y − f)² + λ ∫ f‴² dt` has
//! `(R + λ Qᵀ W⁻¹ Q) γ = Qᵀ y` and `f = y − λ W⁻¹ Q γ`: the method of `reinsch1967` one degree higher.

use super::banded::{Banded, Factors, trace_of_product};

/// Values at the knots with weights, over knots that ascend by 1 on average.
pub(super) struct System<const K: usize> {
    pub(super) knots: Vec<f64>,
    pub(super) values: Vec<[f64; K]>,
    weights: Vec<f64>,
    /// Row `j` of `Qᵀ`: its four entries, in the columns `j … j + 3`.
    differences: Vec<[f64; 4]>,
    /// `R`, the products of the B-splines.
    gram: Banded,
    /// `Qᵀ W⁻¹ Q`.
    spread: Banded,
}

/// The spline for one amount of smoothing.
pub(super) struct Solved<const K: usize> {
    /// Coefficients of the third derivative.
    pub(super) gamma: Vec<[f64; K]>,
    /// Values at the knots.
    pub(super) fitted: Vec<[f64; K]>,
    /// `Σ w (y − f)²` of all coordinates.
    pub(super) residual: f64,
    factors: Factors,
    lambda: f64,
}

impl<const K: usize> System<K> {
    /// Needs at least four knots, ascending, and positive weights.
    pub(super) fn new(knots: Vec<f64>, values: Vec<[f64; K]>, weights: Vec<f64>) -> Self {
        let differences: Vec<[f64; 4]> = knots.windows(4).map(difference).collect();
        let gram = gram(&knots);
        let mut spread = Banded::zero(differences.len());
        for (i, row) in spread.rows.iter_mut().enumerate() {
            for (k, entry) in row.iter_mut().enumerate().take(i + 1) {
                // Columns i … i + 3 − k are in both rows.
                *entry = (0..4 - k).map(|c| differences[i][c] * differences[i - k][c + k] / weights[i + c]).sum();
            }
        }
        Self { knots, values, weights, differences, gram, spread }
    }

    /// Absent if the matrix is not positive definite to working precision.
    pub(super) fn solve(&self, lambda: f64) -> Option<Solved<K>> {
        let factors = self.gram.plus(lambda, &self.spread).factor()?;
        let mut gamma = vec![[0.0; K]; self.differences.len()];
        let mut fitted = self.values.clone();
        let mut residual = 0.0;
        for coordinate in 0..K {
            let applied = |(j, row): (usize, &[f64; 4])| (0..4).map(|c| row[c] * self.values[j + c][coordinate]).sum();
            let mut solution: Vec<f64> = self.differences.iter().enumerate().map(applied).collect();
            factors.solve(&mut solution);
            let mut pulled = vec![0.0; self.knots.len()];
            for (j, (row, g)) in self.differences.iter().zip(&solution).enumerate() {
                gamma[j][coordinate] = *g;
                for c in 0..4 {
                    pulled[j + c] += row[c] * g;
                }
            }
            for (i, pull) in pulled.iter().enumerate() {
                let away = lambda * pull / self.weights[i];
                fitted[i][coordinate] -= away;
                residual += self.weights[i] * away * away;
            }
        }
        residual.is_finite().then_some(Solved { gamma, fitted, residual, factors, lambda })
    }

    /// `tr(I − A)`, where `A` takes values to fitted values: the degrees of freedom that are left to the noise of one coordinate.
    pub(super) fn freedom_left(&self, solved: &Solved<K>) -> f64 {
        solved.lambda * trace_of_product(&solved.factors.band_of_inverse(), &self.spread)
    }

    pub(super) fn mean_weight(&self) -> f64 {
        self.weights.iter().sum::<f64>() / self.weights.len() as f64
    }
}

/// Weights of `∫ N f‴ dt` on four values of `f`.
fn difference(t: &[f64]) -> [f64; 4] {
    std::array::from_fn(|k| {
        let product: f64 = (0..4).filter(|l| *l != k).map(|l| t[k] - t[l]).product();
        2.0 * (t[3] - t[0]) / product
    })
}

/// The quadratic B-spline on four knots, on its first, second or third piece.
fn hat(t: &[f64], piece: usize, at: f64) -> f64 {
    match piece {
        0 => (at - t[0]) * (at - t[0]) / ((t[2] - t[0]) * (t[1] - t[0])),
        1 => ((at - t[0]) * (t[2] - at) / (t[2] - t[0]) + (t[3] - at) * (at - t[1]) / (t[3] - t[1])) / (t[2] - t[1]),
        _ => (t[3] - at) * (t[3] - at) / ((t[3] - t[1]) * (t[3] - t[2])),
    }
}

/// The B-splines that live on a span, with the piece of each that lies there.
fn living(span: usize, count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..3).filter(move |piece| span >= *piece && span - piece < count).map(move |piece| (span - piece, piece))
}

/// `∫ N_i N_j dt`; three Gauss points are exact for the products of degree four.
fn gram(knots: &[f64]) -> Banded {
    let count = knots.len() - 3;
    let offset = (0.6_f64).sqrt();
    let mut gram = Banded::zero(count);
    for span in 0..knots.len() - 1 {
        let (half, middle) = (0.5 * (knots[span + 1] - knots[span]), 0.5 * (knots[span + 1] + knots[span]));
        for (node, weight) in [(-offset, 5.0 / 9.0), (0.0, 8.0 / 9.0), (offset, 5.0 / 9.0)] {
            let at = middle + half * node;
            for (i, piece_i) in living(span, count) {
                for (j, piece_j) in living(span, count).filter(|(j, _)| *j <= i) {
                    gram.rows[i][i - j] += half * weight * hat(&knots[i..i + 4], piece_i, at) * hat(&knots[j..j + 4], piece_j, at);
                }
            }
        }
    }
    gram
}

/// The third derivative on a span as a quadratic of the distance from its left end: value, slope, half of the second derivative.
pub(super) fn third_on_span<const K: usize>(knots: &[f64], gamma: &[[f64; K]], span: usize) -> [[f64; K]; 3] {
    let (left, width) = (knots[span], knots[span + 1] - knots[span]);
    let at = |fraction: f64| {
        let mut sum = [0.0; K];
        for (j, piece) in living(span, gamma.len()) {
            let value = hat(&knots[j..j + 4], piece, left + fraction * width);
            for (s, g) in sum.iter_mut().zip(&gamma[j]) {
                *s += value * g;
            }
        }
        sum
    };
    let (start, middle, end) = (at(0.0), at(0.5), at(1.0));
    let slope = std::array::from_fn(|c| (4.0 * middle[c] - 3.0 * start[c] - end[c]) / width);
    let half_second = std::array::from_fn(|c| 2.0 * (start[c] - 2.0 * middle[c] + end[c]) / (width * width));
    [start, slope, half_second]
}
