//! Symmetric positive definite matrices with three diagonals below the main one.

/// Half of the band.
const BAND: usize = 3;

/// A symmetric matrix: `rows[i][k]` is the entry in row `i` and column `i − k`; what would lie before the first column is 0.
#[derive(Clone, Debug)]
pub(super) struct Banded {
    pub(super) rows: Vec<[f64; BAND + 1]>,
}

/// `L D Lᵀ` of a [`Banded`] matrix: unit lower triangle in `lower[i][k]`, `k ≥ 1`, and the pivots in `lower[i][0]`.
#[derive(Clone, Debug)]
pub(super) struct Factors {
    lower: Vec<[f64; BAND + 1]>,
}

impl Banded {
    pub(super) fn zero(size: usize) -> Self {
        Self { rows: vec![[0.0; BAND + 1]; size] }
    }

    /// `self + factor · other`.
    pub(super) fn plus(&self, factor: f64, other: &Self) -> Self {
        let sum = |(a, b): (&[f64; BAND + 1], &[f64; BAND + 1])| std::array::from_fn(|k| a[k] + factor * b[k]);
        Self { rows: self.rows.iter().zip(&other.rows).map(sum).collect() }
    }

    /// Golub & Van Loan, "Matrix Computations", section 4.3; absent if a pivot is not positive.
    pub(super) fn factor(&self) -> Option<Factors> {
        let mut lower: Vec<[f64; BAND + 1]> = Vec::with_capacity(self.rows.len());
        for (i, row) in self.rows.iter().enumerate() {
            let mut new = [0.0; BAND + 1];
            // From the far end of the band to the pivot: entry (i, j) takes away what columns before j have in common.
            for k in (0..=BAND.min(i)).rev() {
                let j = i - k;
                let mut value = row[k];
                for (m, done) in new.iter().enumerate().take(BAND.min(i) + 1).skip(k + 1) {
                    let other = if k == 0 { *done } else { lower[j][m - k] };
                    value -= done * other * lower[i - m][0];
                }
                new[k] = if k == 0 { value } else { value / lower[j][0] };
            }
            if !(new[0] > 0.0 && new[0].is_finite()) {
                return None;
            }
            lower.push(new);
        }
        Some(Factors { lower })
    }
}

impl Factors {
    /// Solves in place.
    pub(super) fn solve(&self, rhs: &mut [f64]) {
        for i in 0..rhs.len() {
            for k in 1..=BAND.min(i) {
                rhs[i] -= self.lower[i][k] * rhs[i - k];
            }
        }
        for (x, row) in rhs.iter_mut().zip(&self.lower) {
            *x /= row[0];
        }
        for i in (0..rhs.len()).rev() {
            for k in 1..=BAND.min(i) {
                rhs[i - k] -= self.lower[i][k] * rhs[i];
            }
        }
    }

    /// The entries of the inverse inside the band, from the last row to the first.
    ///
    /// M. F. Hutchinson, F. R. de Hoog, "Smoothing noisy data with spline functions", Numerische Mathematik 47, 99–106, 1985
    /// (`hutchinson-dehoog1985`).
    pub(super) fn band_of_inverse(&self) -> Banded {
        let size = self.lower.len();
        let mut inverse = Banded::zero(size);
        for i in (0..size).rev() {
            let below = BAND.min(size - 1 - i);
            // Z(i+m, i) = −Σₖ Z(i+m, i+k) L(i+k, i), and the diagonal adds 1/D.
            for m in (0..=below).rev() {
                let mut value = if m == 0 { 1.0 / self.lower[i][0] } else { 0.0 };
                for k in 1..=below {
                    let (high, low) = (m.max(k), m.min(k));
                    value -= inverse.rows[i + high][high - low] * self.lower[i + k][k];
                }
                inverse.rows[i + m][m] = value;
            }
        }
        inverse
    }
}

/// Trace of the product of two symmetric matrices of which one is known inside the band only and the other has nothing outside.
pub(super) fn trace_of_product(a: &Banded, b: &Banded) -> f64 {
    let row = |(a, b): (&[f64; BAND + 1], &[f64; BAND + 1])| a[0] * b[0] + 2.0 * (a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
    a.rows.iter().zip(&b.rows).map(row).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use forcewright_base::dense::Lu;

    /// A matrix of five rows against dense elimination: solution and the inverse inside the band.
    #[test]
    fn agrees_with_dense_elimination() {
        let rows = vec![[4.0, 0.0, 0.0, 0.0], [5.0, -1.5, 0.0, 0.0], [6.0, 1.2, 0.7, 0.0], [5.5, -0.4, 0.3, -0.9], [7.0, 2.0, -1.1, 0.6]];
        let size = rows.len();
        let banded = Banded { rows };
        let mut dense = vec![0.0; size * size];
        for i in 0..size {
            for k in 0..=BAND.min(i) {
                dense[i * size + i - k] = banded.rows[i][k];
                dense[(i - k) * size + i] = banded.rows[i][k];
            }
        }
        let mut lu = Lu::new();
        lu.factor(size, size, &dense).unwrap();
        let factors = banded.factor().unwrap();
        let inverse = factors.band_of_inverse();
        for column in 0..size {
            let mut unit: Vec<f64> = (0..size).map(|i| f64::from(u8::from(i == column))).collect();
            let mut ours = unit.clone();
            lu.solve(&mut unit);
            factors.solve(&mut ours);
            for row in 0..size {
                assert!((ours[row] - unit[row]).abs() < 1e-15, "{row} {column}");
                if row >= column && row - column <= BAND {
                    assert!((inverse.rows[row][row - column] - unit[row]).abs() < 1e-15, "{row} {column}");
                }
            }
        }
        // tr(A⁻¹ A) is the number of rows.
        assert!((trace_of_product(&inverse, &banded) - 5.0).abs() < 1e-14);
        let mut indefinite = banded;
        indefinite.rows[2][0] = -1.0;
        assert!(indefinite.factor().is_none());
    }
}
