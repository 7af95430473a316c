//! Accelerations and multipliers of a mechanism that moves by itself: `M a + Dᵀ λ = Q`, `D a = γ`.
//!
//! Bodies with mass are eliminated, which leaves `[−D M⁻¹ Dᵀ, D_z; D_zᵀ, 0] [λ; a_z] = [γ − D M⁻¹ Q; Q_z]` with the coordinates z that
//! have no mass (path parameters). Haug 1989, chapter 6; the elimination is that of a saddle-point system.

use forcewright_base::dense::{Lu, Singular};

use crate::rows::Rows;

#[derive(Debug, Clone, Default)]
pub(crate) struct Kkt {
    lu: Lu,
    inverse_mass: Vec<f64>,
    massless: Vec<usize>,
    matrix: Vec<f64>,
    /// `D M⁻¹`, row by row.
    weighted: Vec<f64>,
    /// `D`, column by column.
    columns: Vec<f64>,
    right: Vec<f64>,
}

impl Kkt {
    /// For the diagonal mass matrix of the bodies and so many coordinates.
    pub(crate) fn new(mass: &[f64], coordinates: usize) -> Self {
        let mass = |k: usize| mass.get(k).copied().unwrap_or(0.0);
        Self {
            inverse_mass: (0..coordinates).map(|k| if mass(k) > 0.0 { 1.0 / mass(k) } else { 0.0 }).collect(),
            massless: (0..coordinates).filter(|k| mass(*k) <= 0.0).collect(),
            ..Self::default()
        }
    }

    /// Factors for given rows. The column of a singular matrix is that of a row, or beyond them of a massless coordinate.
    pub(crate) fn factor(&mut self, rows: &Rows) -> Result<(), Singular> {
        let (m, n, z) = (rows.len(), rows.columns, self.massless.len());
        let size = m + z;
        self.matrix.clear();
        self.matrix.resize(size * size, 0.0);
        self.weighted.clear();
        for row in rows.jacobian.chunks_exact(n.max(1)) {
            self.weighted.extend(row.iter().zip(&self.inverse_mass).map(|(d, w)| d * w));
        }
        self.columns.clear();
        for column in 0..n {
            self.columns.extend((0..m).map(|row| rows.jacobian[row * n + column]));
        }
        for i in 0..m {
            // Most entries of a row are 0: columns where it has one are added as a whole.
            for (k, weight) in self.weighted[i * n..(i + 1) * n].iter().enumerate() {
                if *weight != 0.0 {
                    let column = &self.columns[k * m..(k + 1) * m];
                    for (target, entry) in self.matrix[i * size..i * size + m].iter_mut().zip(column) {
                        *target -= weight * entry;
                    }
                }
            }
            for (k, &coordinate) in self.massless.iter().enumerate() {
                let entry = rows.row(i)[coordinate];
                self.matrix[i * size + m + k] = entry;
                self.matrix[(m + k) * size + i] = entry;
            }
        }
        self.lu.factor(size, size, &self.matrix)
    }

    /// Replaces forces `Q` by accelerations and right-hand sides of the rows by multipliers.
    pub(crate) fn solve(&mut self, rows: &Rows, forces: &mut [f64], gamma: &mut [f64]) {
        let (m, n) = (rows.len(), rows.columns);
        self.right.clear();
        for (i, gamma) in gamma.iter().enumerate() {
            let weighted = &self.weighted[i * n..(i + 1) * n];
            self.right.push(gamma - weighted.iter().zip(&*forces).map(|(d, q)| d * q).sum::<f64>());
        }
        self.right.extend(self.massless.iter().map(|&k| forces[k]));
        self.lu.solve(&mut self.right);
        gamma.copy_from_slice(&self.right[..m]);
        for (force, w) in forces.iter_mut().zip(&self.inverse_mass) {
            *force *= w;
        }
        for (i, multiplier) in gamma.iter().enumerate() {
            for (a, d) in forces.iter_mut().zip(&self.weighted[i * n..(i + 1) * n]) {
                *a -= d * multiplier;
            }
        }
        for (k, &coordinate) in self.massless.iter().enumerate() {
            forces[coordinate] = self.right[m + k];
        }
    }

    /// The massless coordinate by number.
    pub(crate) fn massless(&self, index: usize) -> Option<usize> {
        self.massless.get(index).copied()
    }
}
