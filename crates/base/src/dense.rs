//! Small dense linear systems: LU factors with scaled partial pivoting, in buffers that are reused.
//!
//! Meant for a few to about a hundred unknowns. Matrices are row-major slices.

use std::fmt;

/// The matrix has no inverse to working precision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Singular {
    /// The first column that depends on the columns before it.
    pub column: usize,
}

impl fmt::Display for Singular {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "matrix is singular: column {} depends on the columns before it", self.column)
    }
}

impl std::error::Error for Singular {}

/// LU factors of a square matrix, `P·A = L·U`, with row-scaled partial pivoting.
///
/// Golub & Van Loan, "Matrix Computations", algorithm 3.4.1; the pivot is the largest entry relative to the largest entry of its
/// original row, so that rows in different units are compared fairly.
///
/// ```
/// let mut lu = forcewright_base::dense::Lu::new();
/// lu.factor(2, 2, &[0.0, 2.0, 1.0, 1.0]).expect("regular");
/// let mut x = [4.0, 3.0];
/// lu.solve(&mut x);
/// assert_eq!(x, [1.0, 2.0]);
/// ```
#[derive(Debug, Clone, Default)]
pub struct Lu {
    n: usize,
    factors: Vec<f64>,
    order: Vec<usize>,
    row_scale: Vec<f64>,
    scratch: Vec<f64>,
    smallest_pivot: f64,
}

impl Lu {
    /// Empty buffers; they grow at the first factorisation and are kept.
    pub fn new() -> Self {
        Self::default()
    }

    /// Factors the leading `n × n` block of a row-major matrix whose rows are `stride` apart.
    ///
    /// # Errors
    /// [`Singular`] if a pivot is below `4·n·ε` of its row, or not a number. The factors found so far remain for
    /// [`Lu::null_vector`].
    ///
    /// # Panics
    /// If the slice is shorter than `n` rows of the stride, or the stride is less than `n`.
    pub fn factor(&mut self, n: usize, stride: usize, matrix: &[f64]) -> Result<(), Singular> {
        assert!(stride >= n && (n == 0 || matrix.len() >= (n - 1) * stride + n), "matrix slice too short");
        self.n = n;
        self.factors.clear();
        self.order.clear();
        self.order.extend(0..n);
        self.row_scale.clear();
        self.scratch.resize(n, 0.0);
        for row in 0..n {
            let source = &matrix[row * stride..row * stride + n];
            self.factors.extend_from_slice(source);
            self.row_scale.push(source.iter().fold(0.0_f64, |m, v| m.max(v.abs())));
        }
        self.smallest_pivot = f64::INFINITY;
        let limit = 4.0 * n as f64 * f64::EPSILON;
        for column in 0..n {
            let relative = self.bring_up_pivot(column);
            self.smallest_pivot = self.smallest_pivot.min(relative);
            // Written so that NaN fails as well.
            if !(relative > limit && relative.is_finite()) {
                self.smallest_pivot = 0.0;
                return Err(Singular { column });
            }
            self.eliminate_below(column);
        }
        Ok(())
    }

    /// Swaps the best pivot of a column into place and returns its size relative to its row.
    fn bring_up_pivot(&mut self, column: usize) -> f64 {
        let n = self.n;
        let (mut best, mut best_row) = (0.0, column);
        for row in column..n {
            let size = self.factors[row * n + column].abs();
            let relative = if size > 0.0 { size / self.row_scale[row] } else { size };
            if relative.is_nan() {
                return f64::NAN;
            }
            if relative > best {
                (best, best_row) = (relative, row);
            }
        }
        if best_row != column {
            let (upper, lower) = self.factors.split_at_mut(best_row * n);
            upper[column * n..column * n + n].swap_with_slice(&mut lower[..n]);
            self.order.swap(column, best_row);
            self.row_scale.swap(column, best_row);
        }
        best
    }

    fn eliminate_below(&mut self, column: usize) {
        let n = self.n;
        let (upper, lower) = self.factors.split_at_mut((column + 1) * n);
        let pivot_row = &upper[column * n..];
        let inverse = 1.0 / pivot_row[column];
        for row in lower.chunks_exact_mut(n) {
            let factor = row[column] * inverse;
            row[column] = factor;
            if factor != 0.0 {
                for (target, value) in row[column + 1..].iter_mut().zip(&pivot_row[column + 1..n]) {
                    *target -= factor * value;
                }
            }
        }
    }

    /// Number of unknowns of the last factorisation.
    pub fn size(&self) -> usize {
        self.n
    }

    /// The smallest pivot relative to its row, in [0, 1]; 0 after [`Singular`]. Cheap, and only a rough measure of the condition.
    pub fn smallest_pivot(&self) -> f64 {
        self.smallest_pivot
    }

    /// Replaces the right-hand side by the solution.
    ///
    /// # Panics
    /// If the length is not [`Lu::size`].
    pub fn solve(&mut self, rhs: &mut [f64]) {
        let n = self.n;
        assert_eq!(rhs.len(), n, "right-hand side of the wrong length");
        self.scratch.resize(n, 0.0);
        // The operations of `solve_columns` in the same order, with the sum of a row kept at hand.
        for (row, &source) in self.order.iter().enumerate() {
            let (done, rest) = self.scratch.split_at_mut(row);
            let factors = &self.factors[row * n..row * n + row];
            rest[0] = factors.iter().zip(&*done).fold(rhs[source], |sum, (factor, value)| sum - factor * value);
        }
        for row in (0..n).rev() {
            let (head, done) = self.scratch.split_at_mut(row + 1);
            let factors = &self.factors[row * n + row..(row + 1) * n];
            let sum = factors[1..].iter().zip(&*done).fold(head[row], |sum, (factor, value)| sum - factor * value);
            head[row] = sum * (1.0 / factors[0]);
        }
        rhs.copy_from_slice(&self.scratch[..n]);
    }

    /// Replaces `columns` right-hand sides, stored row by row (`size × columns`), by their solutions.
    ///
    /// # Panics
    /// If the length is not [`Lu::size`] times `columns`.
    pub fn solve_columns(&mut self, rhs: &mut [f64], columns: usize) {
        let (n, m) = (self.n, columns);
        assert_eq!(rhs.len(), n * m, "right-hand side of the wrong length");
        self.scratch.resize(n * m, 0.0);
        for (row, &source) in self.order.iter().enumerate() {
            self.scratch[row * m..(row + 1) * m].copy_from_slice(&rhs[source * m..(source + 1) * m]);
        }
        let x = &mut self.scratch[..];
        for row in 1..n {
            let (done, rest) = x.split_at_mut(row * m);
            for (k, factor) in self.factors[row * n..row * n + row].iter().enumerate() {
                for (target, value) in rest[..m].iter_mut().zip(&done[k * m..(k + 1) * m]) {
                    *target -= factor * value;
                }
            }
        }
        for row in (0..n).rev() {
            let (head, done) = x.split_at_mut((row + 1) * m);
            let target_row = &mut head[row * m..];
            for (k, factor) in self.factors[row * n + row + 1..(row + 1) * n].iter().enumerate() {
                for (target, value) in target_row.iter_mut().zip(&done[k * m..(k + 1) * m]) {
                    *target -= factor * value;
                }
            }
            let inverse = 1.0 / self.factors[row * n + row];
            for target in target_row {
                *target *= inverse;
            }
        }
        rhs.copy_from_slice(x);
    }

    /// Replaces the right-hand side by the solution of the transposed system, `Aᵀ·x = b`.
    ///
    /// # Panics
    /// If the length is not [`Lu::size`].
    pub fn solve_transposed(&mut self, rhs: &mut [f64]) {
        let n = self.n;
        assert_eq!(rhs.len(), n, "right-hand side of the wrong length");
        // Aᵀ = Uᵀ Lᵀ P: rows of the factors are columns of their transposes.
        for row in 0..n {
            let (head, rest) = rhs.split_at_mut(row + 1);
            let factors = &self.factors[row * n..(row + 1) * n];
            head[row] /= factors[row];
            for (target, factor) in rest.iter_mut().zip(&factors[row + 1..]) {
                *target -= factor * head[row];
            }
        }
        for row in (1..n).rev() {
            let (head, rest) = rhs.split_at_mut(row);
            for (target, factor) in head.iter_mut().zip(&self.factors[row * n..row * n + row]) {
                *target -= factor * rest[0];
            }
        }
        self.scratch.resize(n, 0.0);
        for (value, &place) in rhs.iter().zip(&self.order) {
            self.scratch[place] = *value;
        }
        rhs.copy_from_slice(&self.scratch[..n]);
    }

    /// After [`Singular`] at `column`: a vector that the matrix maps to (nearly) zero, with 1 in that column and 0 after it.
    ///
    /// # Panics
    /// If `column` is not below [`Lu::size`].
    pub fn null_vector(&self, column: usize) -> Vec<f64> {
        assert!(column < self.n, "no such column");
        let n = self.n;
        let mut z = vec![0.0; n];
        z[column] = 1.0;
        for row in (0..column).rev() {
            let sum: f64 = (row + 1..=column).map(|k| self.factors[row * n + k] * z[k]).sum();
            z[row] = -sum / self.factors[row * n + row];
        }
        z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Hilbert matrix has integer inverses in closed form; of order 4 the first column is (16, −120, 240, −140).
    #[test]
    fn inverts_the_hilbert_matrix() {
        let hilbert: Vec<f64> = (0..16).map(|i| 1.0 / f64::from(i / 4 + i % 4 + 1)).collect();
        let mut lu = Lu::new();
        lu.factor(4, 4, &hilbert).unwrap();
        let mut x = [1.0, 0.0, 0.0, 0.0];
        lu.solve(&mut x);
        for (got, want) in x.iter().zip([16.0, -120.0, 240.0, -140.0]) {
            assert!((got - want).abs() < 1e-9, "{got} {want}");
        }
    }

    #[test]
    fn solves_several_columns_with_a_stride_and_zero_diagonal() {
        // Leading 2 × 2 block of a 2 × 3 array: [[0, 3], [2, 1]].
        let mut lu = Lu::new();
        lu.factor(2, 3, &[0.0, 3.0, 99.0, 2.0, 1.0]).unwrap();
        let mut rhs = [3.0, 6.0, 5.0, 4.0];
        lu.solve_columns(&mut rhs, 2);
        assert!(rhs.iter().zip([2.0, 1.0, 1.0, 2.0]).all(|(a, b)| (a - b).abs() < 1e-15), "{rhs:?}");
        assert_eq!(lu.size(), 2);
    }

    #[test]
    fn one_column_has_the_bits_of_several() {
        let n = 9;
        let a: Vec<f64> = (0..n * n).map(|k| crate::maths::sin(1.3 * k as f64 + 0.1 * (k * k % 7) as f64)).collect();
        let b: Vec<f64> = (0..n).map(|k| crate::maths::cos(2.1 * k as f64)).collect();
        let mut lu = Lu::new();
        lu.factor(n, n, &a).unwrap();
        let (mut one, mut several) = (b.clone(), b);
        lu.solve(&mut one);
        lu.solve_columns(&mut several, 1);
        assert_eq!(one, several);
    }

    #[test]
    fn solves_the_transposed_system() {
        let a = [0.0, 3.0, 1.0, 2.0, 1.0, -1.0, 4.0, 0.5, 6.0];
        let want = [1.0, -2.0, 0.25];
        let mut rhs: Vec<f64> = (0..3).map(|column| (0..3).map(|row| a[3 * row + column] * want[row]).sum()).collect();
        let mut lu = Lu::new();
        lu.factor(3, 3, &a).unwrap();
        lu.solve_transposed(&mut rhs);
        assert!(rhs.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-15), "{rhs:?}");
    }

    #[test]
    fn row_scaling_makes_units_irrelevant() {
        let mut lu = Lu::new();
        lu.factor(2, 2, &[1e-20, 2e-20, 1.0, 1.0]).unwrap();
        assert!(lu.smallest_pivot() > 0.4);
        let mut x = [5e-20, 3.0];
        lu.solve(&mut x);
        assert!((x[0] - 1.0).abs() < 1e-14 && (x[1] - 2.0).abs() < 1e-14);
    }

    #[test]
    fn singular_matrices_are_named_with_their_null_vector() {
        let a = [1.0, 2.0, 3.0, 2.0, 4.0, 1.0, 3.0, 6.0, 2.0];
        let mut lu = Lu::new();
        assert_eq!(lu.factor(3, 3, &a), Err(Singular { column: 1 }));
        assert_eq!(lu.null_vector(1), vec![-2.0, 1.0, 0.0]);
        assert_eq!(lu.factor(1, 1, &[f64::NAN]), Err(Singular { column: 0 }));
        assert_eq!(lu.factor(1, 1, &[f64::INFINITY]), Err(Singular { column: 0 }));
        assert_eq!(lu.factor(0, 0, &[]), Ok(()));
    }
}
