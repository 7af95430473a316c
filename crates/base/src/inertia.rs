//! Inertia of small symmetric matrices: how many eigenvalues are negative, zero and positive.

/// Numbers of eigenvalues by sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Inertia {
    /// Below zero.
    pub negative: usize,
    /// Zero to working precision.
    pub zero: usize,
    /// Above zero.
    pub positive: usize,
}

/// Inertia of the leading `n × n` block of a symmetric row-major matrix whose rows are `stride` apart.
///
/// By Sylvester's law it is that of D in P A Pᵀ = L D Lᵀ, with the complete pivoting of J. R. Bunch & B. N. Parlett, "Direct methods
/// for solving symmetric indefinite systems of linear equations", SIAM J. Numer. Anal. 8 (1971): blocks of order 2 have one
/// eigenvalue of each sign. What remains below `4·n·ε` of the largest entry counts as zero, and so does everything from the first
/// value on that is not a number.
///
/// # Panics
/// If the slice is shorter than `n` rows of the stride, or the stride is less than `n`.
///
/// ```
/// use forcewright_base::inertia::{Inertia, inertia};
/// assert_eq!(inertia(2, 2, &[0.0, 1.0, 1.0, 0.0]), Inertia { negative: 1, zero: 0, positive: 1 });
/// ```
pub fn inertia(n: usize, stride: usize, matrix: &[f64]) -> Inertia {
    assert!(stride >= n && (n == 0 || matrix.len() >= (n - 1) * stride + n), "matrix slice too short");
    let mut a: Vec<f64> = Vec::with_capacity(n * n);
    for row in 0..n {
        a.extend_from_slice(&matrix[row * stride..row * stride + n]);
    }
    let limit = 4.0 * n as f64 * f64::EPSILON * a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut found = Inertia::default();
    let mut k = 0;
    while k < n {
        let (diagonal, off) = largest(&a, n, k);
        let size = diagonal.0 + off.0;
        if !size.is_finite() || diagonal.0.max(off.0) <= limit {
            found.zero += n - k;
            break;
        }
        if diagonal.0 >= ALPHA * off.0 {
            swap(&mut a, n, k, diagonal.1);
            if a[k * n + k] < 0.0 {
                found.negative += 1;
            } else {
                found.positive += 1;
            }
            eliminate_one(&mut a, n, k);
            k += 1;
        } else {
            let (row, column) = off.1;
            swap(&mut a, n, k, column);
            swap(&mut a, n, k + 1, row);
            found.negative += 1;
            found.positive += 1;
            eliminate_two(&mut a, n, k);
            k += 2;
        }
    }
    found
}

/// (1 + √17)/8: growth of entries is least with it.
const ALPHA: f64 = 0.640_388_203_202_207_6;

/// The largest entry on the diagonal and its place, and the largest below it with row and column, from `k` on.
fn largest(a: &[f64], n: usize, k: usize) -> ((f64, usize), (f64, (usize, usize))) {
    let (mut diagonal, mut off) = ((0.0, k), (0.0, (k, k)));
    for row in k..n {
        for column in k..row {
            let size = a[row * n + column].abs();
            if size > off.0 || size.is_nan() {
                off = (size, (row, column));
            }
        }
        let size = a[row * n + row].abs();
        if size > diagonal.0 || size.is_nan() {
            diagonal = (size, row);
        }
    }
    (diagonal, off)
}

/// Exchanges two rows and the same two columns.
fn swap(a: &mut [f64], n: usize, i: usize, j: usize) {
    if i == j {
        return;
    }
    for k in 0..n {
        a.swap(i * n + k, j * n + k);
    }
    for k in 0..n {
        a.swap(k * n + i, k * n + j);
    }
}

fn eliminate_one(a: &mut [f64], n: usize, k: usize) {
    let inverse = 1.0 / a[k * n + k];
    for row in k + 1..n {
        let factor = a[row * n + k] * inverse;
        for column in k + 1..n {
            a[row * n + column] -= factor * a[k * n + column];
        }
    }
}

fn eliminate_two(a: &mut [f64], n: usize, k: usize) {
    let (p, q, r) = (a[k * n + k], a[(k + 1) * n + k], a[(k + 1) * n + k + 1]);
    // Divided by q, which is the largest, against overflow.
    let det = (p / q) * (r / q) - 1.0;
    for row in k + 2..n {
        let (x, y) = (a[row * n + k] / q, a[row * n + k + 1] / q);
        let (first, second) = ((x * (r / q) - y) / det, (y * (p / q) - x) / det);
        for column in k + 2..n {
            a[row * n + column] -= first * a[k * n + column] + second * a[(k + 1) * n + column];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The chain 2, −1 of order n less a shift has the eigenvalues 2 − 2 cos(kπ/(n+1)) − shift.
    #[test]
    fn counts_the_eigenvalues_of_a_chain_below_a_shift() {
        let n = 9;
        for shift in [-0.1, 0.05, 0.2, 1.0, 1.99, 2.01, 3.3, 4.5] {
            let entry = |i: usize, j: usize| match i.abs_diff(j) {
                0 => 2.0 - shift,
                1 => -1.0,
                _ => 0.0,
            };
            let a: Vec<f64> = (0..n * n).map(|i| entry(i / n, i % n)).collect();
            let eigenvalue = |k: usize| 2.0 - 2.0 * crate::maths::cos(std::f64::consts::PI * k as f64 / (n + 1) as f64);
            let below = (1..=n).filter(|&k| eigenvalue(k) < shift).count();
            assert_eq!(inertia(n, n, &a), Inertia { negative: below, zero: 0, positive: n - below }, "{shift}");
        }
    }

    #[test]
    fn congruence_keeps_the_inertia_of_a_saddle_point() {
        // A = Mᵀ D M with a full M and a stride; D has zeros on the diagonal.
        let d = [[0.0, 3.0, 0.0, 0.0], [3.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1e-6, 0.0], [0.0, 0.0, 0.0, 0.0]];
        let m = [[1.0, 2.0, -1.0, 0.5], [0.0, 1.0, 3.0, 1.0], [2.0, 0.0, 1.0, -1.0], [1.0, 1.0, 1.0, 1.0]];
        let mut a = vec![f64::NAN; 4 * 5];
        for i in 0..4 {
            for j in 0..4 {
                a[i * 5 + j] = (0..16).map(|k| m[k / 4][i] * d[k / 4][k % 4] * m[k % 4][j]).sum();
            }
        }
        assert_eq!(inertia(4, 5, &a), Inertia { negative: 2, zero: 1, positive: 1 });
        assert_eq!(inertia(0, 0, &[]), Inertia::default());
        assert_eq!(inertia(1, 1, &[f64::NAN]).zero, 1);
    }
}
