//! Correlations of a group of parameters.

use std::fmt;

use super::Sobol;

/// Why a matrix is no correlation matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CorrelationError {
    /// Not `size × size` entries.
    Shape {
        /// Rows asked for.
        size: usize,
        /// Entries given.
        entries: usize,
    },
    /// More members than a sample can have dimensions.
    TooMany {
        /// Members asked for.
        size: usize,
    },
    /// An entry of the diagonal is not 1, or one beside it not within [−1, 1].
    Range {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// Two entries that must be equal are not.
    Asymmetric {
        /// Row of one of them, column of the other.
        row: usize,
        /// Column of one of them, row of the other.
        column: usize,
    },
    /// Each correlation is possible, but not all of them together: what the members before leave of the variance of this one is
    /// negative.
    Contradiction {
        /// The first member that cannot be as correlated with the members before it as is said.
        member: usize,
        /// What would be left of its variance, 1.
        left: f64,
    },
}

impl fmt::Display for CorrelationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape { size, entries } => write!(f, "{size} members need {} correlations, but there are {entries}", size * size),
            Self::TooMany { size } => write!(f, "{size} members are too many; a sample has at most {}", Sobol::MAX_DIMENSIONS),
            Self::Range { row, column, value } if row == column => {
                write!(f, "member {row} correlates with itself by 1, not {value}")
            }
            Self::Range { row, column, value } => write!(f, "the correlation of {row} and {column}, {value}, is not within −1 and 1"),
            Self::Asymmetric { row, column } => {
                write!(f, "the correlations of {row} with {column} and of {column} with {row} differ")
            }
            Self::Contradiction { member, left } => write!(
                f,
                "the matrix is not positive definite: member {member} cannot be so correlated with those before it, which leave it \
                 the variance {left:.3} of 1; correlations of opposite sign or nearer to 0 are possible"
            ),
        }
    }
}

impl std::error::Error for CorrelationError {}

/// Correlations between the normal scores of the members of a group: a Gaussian copula.
///
/// Between normal parameters they are the ordinary correlations. For others, the rank correlation (Spearman) is `6/π asin(ρ/2)`
/// (K. Pearson 1907; W. H. Kruskal, "Ordinal measures of association", JASA 53, 814–861, 1958), little below ρ.
///
/// ```
/// use forcewright_study::sampling::{Correlation, CorrelationError};
///
/// // Two that both follow a third cannot oppose each other.
/// let error = Correlation::new(3, &[1.0, 0.9, 0.9, 0.9, 1.0, -0.9, 0.9, -0.9, 1.0]).unwrap_err();
/// assert!(matches!(error, CorrelationError::Contradiction { member: 2, .. }));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Correlation {
    size: usize,
    /// Lower triangular factor, row-major: `R = L Lᵀ`.
    factor: Vec<f64>,
}

impl Correlation {
    /// From a row-major matrix. Perfect correlations are allowed (the matrix may be semidefinite).
    ///
    /// # Errors
    /// [`CorrelationError`].
    pub fn new(size: usize, matrix: &[f64]) -> Result<Self, CorrelationError> {
        if size.checked_mul(size) != Some(matrix.len()) {
            return Err(CorrelationError::Shape { size, entries: matrix.len() });
        }
        for row in 0..size {
            for column in 0..=row {
                let value = matrix[row * size + column];
                let fits = if row == column { (value - 1.0).abs() <= ROUNDING } else { value.abs() <= 1.0 };
                if !fits {
                    return Err(CorrelationError::Range { row, column, value });
                }
                // Written so that NaN fails as well.
                let same = (value - matrix[column * size + row]).abs() <= ROUNDING;
                if !same {
                    return Err(CorrelationError::Asymmetric { row, column });
                }
            }
        }
        cholesky(size, matrix).map(|factor| Self { size, factor })
    }

    /// Every two of the members are equally correlated: they share a common cause (a furnace, a plate, a tool) that has the part `rho`
    /// in the variance of each. Below 0, `rho` can reach `−1/(size − 1)` only.
    ///
    /// # Errors
    /// [`CorrelationError`].
    pub fn common(size: usize, rho: f64) -> Result<Self, CorrelationError> {
        if size > Sobol::MAX_DIMENSIONS {
            return Err(CorrelationError::TooMany { size });
        }
        let entry = |i: usize| if i / size == i % size { 1.0 } else { rho };
        Self::new(size, &(0..size * size).map(entry).collect::<Vec<f64>>())
    }

    /// Number of members.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The correlation of two members; not a number if there is no such member.
    pub fn between(&self, a: usize, b: usize) -> f64 {
        if a.max(b) >= self.size {
            return f64::NAN;
        }
        self.row(a).iter().zip(self.row(b)).map(|(x, y)| x * y).sum()
    }

    /// What independent scores contribute to a correlated one: `z_i = Σ_j L_ij e_j`.
    pub(super) fn row(&self, member: usize) -> &[f64] {
        &self.factor[member * self.size..(member + 1) * self.size]
    }
}

/// Rounding errors that entries and pivots are forgiven.
const ROUNDING: f64 = 1e-12;

/// Golub & Van Loan, "Matrix Computations", section 4.2, by rows; a pivot of zero is let pass if its column is zero, too.
fn cholesky(size: usize, matrix: &[f64]) -> Result<Vec<f64>, CorrelationError> {
    let mut factor = vec![0.0; size * size];
    for row in 0..size {
        let mut left = 1.0;
        for column in 0..row {
            let dot: f64 = (0..column).map(|k| factor[row * size + k] * factor[column * size + k]).sum();
            let rest = matrix[row * size + column] - dot;
            let pivot = factor[column * size + column];
            if pivot > 0.0 {
                factor[row * size + column] = rest / pivot;
            } else if rest.abs() > ROUNDING.sqrt() {
                // The member of that column is tied to the ones before it, which do not bring about this correlation.
                return Err(CorrelationError::Contradiction { member: row, left: -rest.abs() });
            }
            left -= factor[row * size + column] * factor[row * size + column];
        }
        if left < -ROUNDING {
            return Err(CorrelationError::Contradiction { member: row, left });
        }
        factor[row * size + row] = if left > ROUNDING { left.sqrt() } else { 0.0 };
    }
    Ok(factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_reproduces_the_matrix() {
        let matrix = [1.0, 0.5, -0.3, 0.5, 1.0, 0.2, -0.3, 0.2, 1.0];
        let correlation = Correlation::new(3, &matrix).unwrap();
        for (i, entry) in matrix.iter().enumerate() {
            assert!((correlation.between(i / 3, i % 3) - entry).abs() < 1e-15);
        }
        // Closed form for two: (ρ, √(1 − ρ²)).
        assert_eq!(Correlation::common(2, 0.6).unwrap().row(1), [0.6, 0.8]);
    }

    /// The matrix of equal correlations has the eigenvalues `1 − ρ` and `1 + (n − 1) ρ`.
    #[test]
    fn equal_correlations_reach_exactly_their_bound() {
        for n in 2..9 {
            let bound = -1.0 / (n as f64 - 1.0);
            assert!(Correlation::common(n, bound).is_ok() && Correlation::common(n, 1.0).is_ok(), "{n}");
            let beyond = Correlation::common(n, bound - 1e-6);
            let expected = if n == 2 { "not within" } else { "not positive definite" };
            assert!(beyond.unwrap_err().to_string().contains(expected), "{n}");
        }
        let tied = Correlation::common(4, 1.0).unwrap();
        assert!((0..16).all(|i| (tied.between(i / 4, i % 4) - 1.0).abs() < 1e-15));
    }

    #[test]
    fn what_is_no_correlation_matrix_is_named() {
        use CorrelationError::{Asymmetric, Contradiction, Range, Shape};
        assert_eq!(Correlation::new(2, &[1.0; 3]), Err(Shape { size: 2, entries: 3 }));
        assert_eq!(Correlation::new(2, &[1.0, 0.1, 0.1, 2.0]), Err(Range { row: 1, column: 1, value: 2.0 }));
        assert_eq!(Correlation::new(2, &[1.0, 0.1, 0.2, 1.0]), Err(Asymmetric { row: 1, column: 0 }));
        assert_eq!(Correlation::common(2, 1.1), Err(Range { row: 1, column: 0, value: 1.1 }));
        assert!(Correlation::common(2, f64::NAN).is_err() && Correlation::new(2, &[1.0, f64::NAN, 0.0, 1.0]).is_err());
        // 1 − 0.81 − (−1.71)²/0.19: what is left of the third.
        let matrix = [1.0, 0.9, 0.9, 0.9, 1.0, -0.9, 0.9, -0.9, 1.0];
        let Err(Contradiction { member: 2, left }) = Correlation::new(3, &matrix) else { panic!("a contradiction") };
        assert!((left - (1.0 - 0.81 - 1.71 * 1.71 / 0.19)).abs() < 1e-12);
        // Tied to the first, the second cannot differ from it towards the third.
        assert!(matches!(Correlation::new(3, &[1.0, 1.0, 0.5, 1.0, 1.0, 0.4, 0.5, 0.4, 1.0]), Err(Contradiction { member: 2, .. })));
        assert!(Correlation::new(0, &[]).is_ok_and(|none| none.between(0, 0).is_nan()));
        assert_eq!(Correlation::common(usize::MAX, 0.5), Err(CorrelationError::TooMany { size: usize::MAX }));
    }
}
