//! Small dense least squares: triangles, bounds, singular values.

/// What a QR factorisation leaves of rows `[A | b]`: `|A x + b|² = |R x + c|²` and what no x changes.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    /// Unknowns.
    pub(super) n: usize,
    /// R, row by row; zero below its diagonal.
    pub(super) r: Vec<f64>,
    /// c.
    pub(super) c: Vec<f64>,
}

impl Triangle {
    /// Of rows of `n` coefficients, one after the other, and a number per row. Householder's reflections; G. H. Golub & C. F. Van Loan,
    /// "Matrix Computations", algorithm 5.2.1.
    pub(super) fn of(n: usize, rows: &[f64], b: &[f64]) -> Self {
        let m = b.len().max(n);
        let mut columns: Vec<Vec<f64>> = (0..=n).map(|_| vec![0.0; m]).collect();
        for (i, b) in b.iter().enumerate() {
            for (column, value) in columns.iter_mut().zip(&rows[i * n..(i + 1) * n]) {
                column[i] = *value;
            }
            columns[n][i] = *b;
        }
        for k in 0..n {
            let norm = columns[k][k..].iter().map(|v| v * v).sum::<f64>().sqrt();
            // A column without anything left reflects nothing.
            if norm.is_nan() || norm <= 0.0 {
                continue;
            }
            let alpha = -norm.copysign(columns[k][k]);
            let mut v = columns[k][k..].to_vec();
            v[0] -= alpha;
            let square: f64 = v.iter().map(|x| x * x).sum();
            for column in &mut columns[k + 1..] {
                let s = 2.0 * v.iter().zip(&column[k..]).map(|(a, b)| a * b).sum::<f64>() / square;
                column[k..].iter_mut().zip(&v).for_each(|(x, v)| *x -= s * v);
            }
            columns[k][k] = alpha;
            columns[k][k + 1..].fill(0.0);
        }
        let r = (0..n).flat_map(|i| columns[..n].iter().map(move |column| column[i])).collect();
        Self { n, r, c: columns[n][..n].to_vec() }
    }

    /// Norms of the columns of A.
    pub(super) fn norms(&self) -> Vec<f64> {
        (0..self.n).map(|j| (0..self.n).map(|i| self.r[i * self.n + j] * self.r[i * self.n + j]).sum::<f64>().sqrt()).collect()
    }

    /// `R x + c`.
    pub(super) fn at(&self, x: &[f64]) -> Vec<f64> {
        self.r.chunks_exact(self.n.max(1)).zip(&self.c).map(|(row, c)| c + row.iter().zip(x).map(|(r, x)| r * x).sum::<f64>()).collect()
    }

    /// By how much x makes `|A x + b|²` smaller than it is at 0, without the difference of large numbers.
    pub(super) fn gain(&self, x: &[f64]) -> f64 {
        let moved = self.at(x).into_iter().zip(&self.c).map(|(at, c)| (at - c, c));
        -moved.map(|(move_by, c)| move_by * (move_by + 2.0 * c)).sum::<f64>()
    }

    /// The x in a box around 0 that makes `|A x + b|² + Σ (damping x)²` smallest: the active-set method of P. B. Stark & R. L. Parker,
    /// "Bounded-variable least-squares", Computational Statistics 10, 129–141, 1995, begun from 0.
    pub(super) fn bounded(&self, damping: &[f64], low: &[f64], high: &[f64]) -> Vec<f64> {
        let n = self.n;
        let mut x = vec![0.0; n];
        // What is at a bound already, and pushed there, is found out by its sign.
        let mut held: Vec<bool> = vec![false; n];
        let gradient = |x: &[f64]| -> Vec<f64> {
            let v = self.at(x);
            (0..n).map(|j| damping[j] * damping[j] * x[j] + (0..n).map(|i| self.r[i * n + j] * v[i]).sum::<f64>()).collect()
        };
        let pushed = |j: usize, x: &[f64], g: f64| (x[j] <= low[j] && g >= 0.0) || (x[j] >= high[j] && g <= 0.0);
        let g = gradient(&x);
        for j in 0..n {
            held[j] = pushed(j, &x, g[j]);
        }
        for _ in 0..4 * n + 4 {
            // The best of the free ones; as far as the first bound on the way there.
            for _ in 0..=n {
                let target = self.free_best(&x, &held, damping);
                let part = |j: usize| {
                    let way = target[j] - x[j];
                    let room = if way > 0.0 { high[j] - x[j] } else { low[j] - x[j] };
                    if way.abs() <= room.abs() { 1.0 } else { room / way }
                };
                let least = (0..n).filter(|j| !held[*j]).map(|j| (part(j), j)).fold((1.0, n), |a, b| if b.0 < a.0 { b } else { a });
                for j in 0..n {
                    if !held[j] {
                        x[j] = (x[j] + least.0 * (target[j] - x[j])).clamp(low[j], high[j]);
                    }
                }
                if least.1 == n {
                    break;
                }
                x[least.1] = if target[least.1] > x[least.1] { high[least.1] } else { low[least.1] };
                held[least.1] = true;
            }
            let g = gradient(&x);
            let astray = (0..n).filter(|j| held[*j] && !pushed(*j, &x, g[*j]));
            let Some(worst) = astray.max_by(|a, b| g[*a].abs().total_cmp(&g[*b].abs())) else { break };
            held[worst] = false;
        }
        x
    }

    /// The best values of those that are not held.
    fn free_best(&self, x: &[f64], held: &[bool], damping: &[f64]) -> Vec<f64> {
        let n = self.n;
        let free: Vec<usize> = (0..n).filter(|j| !held[*j]).collect();
        let fixed: Vec<f64> = (0..n).map(|j| if held[j] { x[j] } else { 0.0 }).collect();
        let mut b = self.at(&fixed);
        let mut rows: Vec<f64> = (0..n).flat_map(|i| free.iter().map(move |j| self.r[i * n + j])).collect();
        for (place, j) in free.iter().enumerate() {
            rows.extend((0..free.len()).map(|k| if k == place { damping[*j] } else { 0.0 }));
            b.push(0.0);
        }
        // Of columns of one length: what is small beside another in its unit is not small.
        let m = free.len();
        let length = |k: usize| rows.iter().skip(k).step_by(m).map(|v| v * v).sum::<f64>().sqrt();
        let lengths: Vec<f64> = (0..m).map(length).map(|l| if l > 0.0 { l } else { 1.0 }).collect();
        rows.iter_mut().enumerate().for_each(|(at, v)| *v /= lengths[at % m]);
        let small = Self::of(m, &rows, &b).solve();
        let mut best = x.to_vec();
        free.iter().zip(small.iter().zip(&lengths)).for_each(|(j, (value, length))| best[*j] = value / length);
        best
    }

    /// The x with `R x + c = 0`; what a vanishing pivot leaves open is 0.
    fn solve(&self) -> Vec<f64> {
        let n = self.n;
        let most = (0..n).map(|i| self.r[i * n + i].abs()).fold(0.0, f64::max);
        let mut x = vec![0.0; n];
        for i in (0..n).rev() {
            let pivot = self.r[i * n + i];
            let known: f64 = (i + 1..n).map(|j| self.r[i * n + j] * x[j]).sum();
            x[i] = if pivot.abs() > f64::EPSILON * most { -(self.c[i] + known) / pivot } else { 0.0 };
        }
        x
    }
}

/// Singular values, largest first, of a square matrix given row by row, and its right singular vectors, one after the other.
#[derive(Clone, Debug)]
pub(crate) struct Singular {
    pub(crate) values: Vec<f64>,
    pub(crate) vectors: Vec<Vec<f64>>,
}

/// Sweeps of rotations: a handful are enough for any matrix of a few columns.
const SWEEPS: usize = 60;

impl Singular {
    /// One-sided Jacobi rotations, which find small values to high relative accuracy; J. Demmel & K. Veselić, "Jacobi's method is more
    /// accurate than QR", SIAM J. Matrix Analysis 13(4), 1204–1245, 1992.
    pub(crate) fn of(n: usize, matrix: &[f64]) -> Self {
        let mut columns: Vec<Vec<f64>> = (0..n).map(|j| (0..n).map(|i| matrix[i * n + j]).collect()).collect();
        let mut vectors: Vec<Vec<f64>> = (0..n).map(|j| (0..n).map(|i| f64::from(u8::from(i == j))).collect()).collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        for _ in 0..SWEEPS {
            let mut turned = false;
            for p in 0..n {
                for q in p + 1..n {
                    let [aa, bb, ab] = [dot(&columns[p], &columns[p]), dot(&columns[q], &columns[q]), dot(&columns[p], &columns[q])];
                    if ab.abs() <= f64::EPSILON * (aa * bb).sqrt() {
                        continue;
                    }
                    turned = true;
                    let zeta = (bb - aa) / (2.0 * ab);
                    let t = 1.0_f64.copysign(zeta) / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
                    let cos = 1.0 / (1.0 + t * t).sqrt();
                    rotate(&mut columns, [p, q], [cos, cos * t]);
                    rotate(&mut vectors, [p, q], [cos, cos * t]);
                }
            }
            if !turned {
                break;
            }
        }
        let mut all: Vec<(f64, Vec<f64>)> = columns.iter().map(|c| dot(c, c).sqrt()).zip(vectors).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (values, vectors) = all.into_iter().unzip();
        Self { values, vectors }
    }
}

fn rotate(columns: &mut [Vec<f64>], [p, q]: [usize; 2], [cos, sin]: [f64; 2]) {
    let (head, tail) = columns.split_at_mut(q);
    for (a, b) in head[p].iter_mut().zip(&mut tail[0]) {
        (*a, *b) = (cos * *a - sin * *b, sin * *a + cos * *b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hilbert's matrix of order 4: its singular values are its eigenvalues, to mpmath's 15 digits.
    #[test]
    fn singular_values_of_a_bad_matrix() {
        let matrix: Vec<f64> = (0..4_u8).flat_map(|i| (0..4_u8).map(move |j| 1.0 / f64::from(i + j + 1))).collect();
        let found = Singular::of(4, &matrix);
        let want = [1.500_214_280_059_243, 0.169_141_220_221_450, 0.006_738_273_605_760_75, 9.670_230_402_258_69e-5];
        for (got, want) in found.values.iter().zip(want) {
            assert!((got / want - 1.0).abs() < 1e-12, "{got} {want}");
        }
    }

    /// Every point of a box is worse than what was found, and without bounds it is the solution of the normal equations.
    #[test]
    fn bounds_are_kept_and_nothing_in_them_is_better() {
        let rows = [1.0, 2.0, 0.5, -1.0, 3.0, 1.0, 0.3, 0.2];
        let b = [-3.0, 2.0, -4.0, 0.1];
        let triangle = Triangle::of(2, &rows, &b);
        let squares = |x: f64, y: f64| (0..4).map(|i| rows[2 * i] * x + rows[2 * i + 1] * y + b[i]).map(|r| r * r).sum::<f64>();
        assert!((triangle.gain(&[0.3, -0.7]) - squares(0.0, 0.0) + squares(0.3, -0.7)).abs() < 1e-12);
        let free = triangle.bounded(&[0.0; 2], &[-1e9; 2], &[1e9; 2]);
        for k in 0..2 {
            let slope: f64 = (0..4).map(|i| rows[2 * i + k] * (rows[2 * i] * free[0] + rows[2 * i + 1] * free[1] + b[i])).sum();
            assert!(slope.abs() < 1e-12, "{slope}");
        }
        for (low, high) in [([-0.5, -0.5], [0.5, 0.5]), ([0.0, -3.0], [0.7, 3.0]), ([-2.0, 0.0], [2.0, 0.0])] {
            let found = triangle.bounded(&[0.0; 2], &low, &high);
            for i in 0..=40 {
                for j in 0..=40 {
                    let at = |k: usize, part: i32| low[k] + (high[k] - low[k]) * f64::from(part) / 40.0;
                    assert!(squares(found[0], found[1]) <= squares(at(0, i), at(1, j)) + 1e-12, "{found:?}");
                }
            }
        }
    }
}
