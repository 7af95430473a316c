//! Rows of a matrix in order: which depend on those before them, and an orthonormal basis of the rest.

/// An orthonormal basis of the rows given so far, and each row in that basis.
///
/// Gram–Schmidt, twice for every row: G. H. Golub & C. F. Van Loan, "Matrix Computations", section 5.2; B. N. Parlett, "The Symmetric
/// Eigenvalue Problem", section 6.9 ("twice is enough"). A row is independent if more than `tolerance` of its length is outside the
/// rows before it.
///
/// ```
/// let mut basis = forcewright_base::orthogonal::RowBasis::new(2, 1e-10);
/// assert!(basis.push(&[3.0, 0.0]));
/// assert!(basis.push(&[1.0, 2.0]));
/// assert!(!basis.push(&[0.0, 1.0]));
/// assert_eq!((basis.rank(), basis.independent()), (2, &[0, 1][..]));
/// ```
#[derive(Debug, Clone)]
pub struct RowBasis {
    columns: usize,
    tolerance: f64,
    /// Unit vectors, one after the other.
    directions: Vec<f64>,
    /// Rows in the basis, `columns` places each.
    coefficients: Vec<f64>,
    independent: Vec<usize>,
    rest: Vec<f64>,
}

impl RowBasis {
    /// No rows yet.
    pub fn new(columns: usize, tolerance: f64) -> Self {
        Self { columns, tolerance, directions: Vec::new(), coefficients: Vec::new(), independent: Vec::new(), rest: Vec::new() }
    }

    /// Adds a row; whether it is independent of those before it. A row that is zero or not finite is not.
    ///
    /// # Panics
    /// If the row has not as many values as there are columns.
    pub fn push(&mut self, row: &[f64]) -> bool {
        let n = self.columns;
        assert_eq!(row.len(), n, "row of the wrong length");
        let index = self.rows();
        let first = self.coefficients.len();
        self.coefficients.resize(first + n, 0.0);
        self.rest.clear();
        self.rest.extend_from_slice(row);
        let size = norm(row);
        if size == 0.0 || !size.is_finite() {
            return false;
        }
        for _ in 0..2 {
            for (k, direction) in self.directions.chunks_exact(n).enumerate() {
                let part: f64 = direction.iter().zip(&self.rest).map(|(a, b)| a * b).sum();
                self.coefficients[first + k] += part;
                for (rest, entry) in self.rest.iter_mut().zip(direction) {
                    *rest -= part * entry;
                }
            }
        }
        let outside = norm(&self.rest);
        let rank = self.rank();
        if rank == n || outside <= self.tolerance * size {
            return false;
        }
        self.coefficients[first + rank] = outside;
        self.directions.extend(self.rest.iter().map(|entry| entry / outside));
        self.independent.push(index);
        true
    }

    /// Number of rows given.
    pub fn rows(&self) -> usize {
        self.coefficients.len().checked_div(self.columns).unwrap_or(0)
    }

    /// Number of independent rows.
    pub fn rank(&self) -> usize {
        self.independent.len()
    }

    /// The independent rows, rising.
    pub fn independent(&self) -> &[usize] {
        &self.independent
    }

    /// Coefficients of a row in the basis; those beyond the rank are 0.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn coefficients(&self, row: usize) -> &[f64] {
        &self.coefficients[row * self.columns..][..self.rank()]
    }

    /// The vector with given coefficients in the basis.
    ///
    /// # Panics
    /// If there are more coefficients than the rank.
    pub fn combine(&self, coefficients: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.columns];
        for (k, coefficient) in coefficients.iter().enumerate() {
            for (target, entry) in sum.iter_mut().zip(&self.directions[k * self.columns..(k + 1) * self.columns]) {
                *target += coefficient * entry;
            }
        }
        sum
    }

    /// How free a column is: squared length, in [0, 1], of the part of its unit vector outside all rows.
    ///
    /// # Panics
    /// If there is no such column.
    pub fn freedom(&self, column: usize) -> f64 {
        assert!(column < self.columns, "no such column");
        let inside: f64 = self.directions.iter().skip(column).step_by(self.columns).map(|entry| entry * entry).sum();
        (1.0 - inside).max(0.0)
    }
}

fn norm(row: &[f64]) -> f64 {
    row.iter().map(|entry| entry * entry).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dependent_rows_are_named_in_order_and_rows_rebuilt() {
        let rows = [[1.0, 2.0, 0.0, -1.0], [0.5, 0.0, 3.0, 1.0], [2.5, 4.0, 3.0, -1.0], [0.0; 4], [0.0, 0.0, 0.0, 1e-3]];
        let mut basis = RowBasis::new(4, 1e-12);
        let found: Vec<bool> = rows.iter().map(|row| basis.push(row)).collect();
        assert_eq!(found, [true, true, false, false, true]);
        for (k, row) in rows.iter().enumerate() {
            let again = basis.combine(basis.coefficients(k));
            assert!(again.iter().zip(row).all(|(a, b)| (a - b).abs() < 1e-14), "{again:?}");
        }
        // One direction is left: what is outside the rows has rank 1, so the freedoms add up to 1.
        assert!(((0..4).map(|k| basis.freedom(k)).sum::<f64>() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn nearly_dependent_rows_keep_an_orthonormal_basis() {
        let mut basis = RowBasis::new(3, 1e-10);
        assert!(basis.push(&[1.0, 1.0, 1.0]) && basis.push(&[1.0, 1.0, 1.0 + 1e-8]) && basis.push(&[1.0, 1.0 + 1e-8, 1.0]));
        let q = [basis.combine(&[1.0]), basis.combine(&[0.0, 1.0]), basis.combine(&[0.0, 0.0, 1.0])];
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        assert!(product(&q[0], &q[1]).abs() < 1e-15 && product(&q[0], &q[2]).abs() < 1e-15 && product(&q[1], &q[2]).abs() < 1e-15);
        assert!(!basis.push(&[0.3, 0.2, 0.1]) && basis.rank() == 3 && basis.rows() == 4);
        assert!(!RowBasis::new(2, 1e-10).push(&[f64::NAN, 0.0]));
    }
}
