//! Assembly: coordinates that satisfy all position rows, near a guess; redundant rows and freedoms.

use forcewright_base::dense::Lu;
use forcewright_base::orthogonal::RowBasis;

use crate::error::AssemblyError;
use crate::frames::Frames;
use crate::model::System;
use crate::rows::Rows;

/// Share of a row, in scaled coordinates, that must be outside the rows before it for it to be independent.
const INDEPENDENT: f64 = 1e-9;
/// Largest change of a scaled coordinate in one iteration: half a radian, half the mechanism.
const LARGEST_STEP: f64 = 0.5;
const ITERATIONS: usize = 200;

/// A mechanism put together.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembled {
    /// Coordinates.
    pub q: Vec<f64>,
    /// Rows that follow from the rows before them, in this position: their multipliers are not unique and given as 0.
    pub redundant: Vec<String>,
    /// Number of velocities that remain free.
    pub freedom: usize,
    /// Iterations used.
    pub iterations: usize,
}

impl System {
    /// Puts the mechanism together at a time, on the branch nearest to the guess, with some coordinates held at the guess (indices,
    /// see [`System::first_coordinate`] and [`System::parameter_coordinate`]).
    ///
    /// Newton's method with the shortest step in scaled coordinates (lengths over the mechanism's size, rad), halted where it stops
    /// improving; damped as Levenberg and Marquardt do where a full step does not help. Redundant rows are allowed.
    ///
    /// # Errors
    /// [`AssemblyError`] names the row that is missed most.
    pub fn assemble(&self, time_s: f64, guess: &[f64], hold: &[usize]) -> Result<Assembled, AssemblyError> {
        let n = self.coordinates();
        if guess.len() != n || hold.iter().any(|k| *k >= n) {
            return Err(AssemblyError::WrongSize);
        }
        let mut search = Search { system: self, time_s, hold, frames: self.new_frames(), rows: Rows::default(), q: guess.to_vec() };
        let iterations = search.run()?;
        let basis = search.full_basis();
        let redundant = (0..self.rows).filter(|row| !basis.independent().contains(row)).map(|row| self.row_name(row)).collect();
        Ok(Assembled { q: search.q, redundant, freedom: n - basis.rank(), iterations })
    }

    /// Basis of all rows, velocity rows included, in scaled coordinates; evaluated rows must be those of all constraints.
    pub(crate) fn scaled_basis(&self, rows: &Rows) -> RowBasis {
        let mut basis = RowBasis::new(self.coordinates(), INDEPENDENT);
        for row in 0..rows.len() {
            basis.push(&scaled(rows.row(row), &self.coordinate_scale, self.row_scale[row]));
        }
        basis
    }

    /// The row that is missed most and by how much of its scale.
    pub(crate) fn worst_row(&self, value: &[f64], kept: &[usize]) -> (usize, f64) {
        let mut worst = (0, 0.0_f64);
        for (value, &row) in value.iter().zip(kept) {
            let size = (value / self.row_scale[row]).abs();
            if size.is_nan() {
                return (row, size);
            }
            if size > worst.1 {
                worst = (row, size);
            }
        }
        worst
    }

    /// What rounding leaves of a row, relative to its scale: far from the origin lengths have fewer digits.
    pub(crate) fn closing_limit(&self, q: &[f64]) -> f64 {
        let far = q[..self.mass.len()].iter().fold(0.0_f64, |m, v| m.max(v.abs())) / self.length_m.min(1.0);
        1e-11 + 64.0 * f64::EPSILON * far
    }
}

fn scaled(row: &[f64], columns: &[f64], scale: f64) -> Vec<f64> {
    row.iter().zip(columns).map(|(entry, column)| entry * column / scale).collect()
}

struct Search<'a> {
    system: &'a System,
    time_s: f64,
    hold: &'a [usize],
    frames: Frames,
    rows: Rows,
    q: Vec<f64>,
}

impl Search<'_> {
    fn evaluate(&mut self, q: &[f64]) -> f64 {
        let system = self.system;
        self.frames.set_positions(q);
        self.rows.evaluate(&system.constraints, system.coordinates(), system.rows, &self.frames, self.time_s);
        self.rows.value.iter().zip(&system.row_scale).map(|(c, scale)| (c / scale) * (c / scale)).sum::<f64>().sqrt()
    }

    fn run(&mut self) -> Result<usize, AssemblyError> {
        let mut q = std::mem::take(&mut self.q);
        let mut miss = self.evaluate(&q);
        let (mut damping, mut iterations) = (0.0, 0);
        let mut singular = false;
        while miss > 0.0 && iterations < ITERATIONS {
            let (basis, right) = self.basis();
            singular = basis.rank() < right.len();
            let mut better = None;
            // From the plain step to one so short that it must help unless this is the nearest point.
            for _ in 0..24 {
                let trial = self.moved(&q, &step(&basis, &right, damping));
                let reached = self.evaluate(&trial);
                if reached < miss {
                    better = Some((trial, reached));
                    break;
                }
                if miss <= self.system.closing_limit(&q) {
                    break;
                }
                damping = (10.0 * damping).max(1e-10);
            }
            let Some((trial, reached)) = better else { break };
            // At rounding, or where damped steps hardly help, nothing more is to be had.
            let closed = reached <= self.system.closing_limit(&trial);
            let stalled = if closed { reached > 0.5 * miss } else { reached > 0.999_999 * miss && damping > 0.0 };
            (q, miss) = (trial, reached);
            damping = if damping < 1e-9 { 0.0 } else { 0.03 * damping };
            iterations += 1;
            self.evaluate(&q);
            if stalled {
                break;
            }
        }
        self.evaluate(&q);
        self.q = q;
        self.verdict(singular).map(|()| iterations)
    }

    /// Orthonormal basis of the position rows and the right-hand side, scaled.
    fn basis(&self) -> (RowBasis, Vec<f64>) {
        let system = self.system;
        let mut basis = RowBasis::new(system.coordinates(), INDEPENDENT);
        let mut right = Vec::new();
        for &k in self.hold {
            let mut row = vec![0.0; system.coordinates()];
            row[k] = 1.0;
            basis.push(&row);
            right.push(0.0);
        }
        for row in 0..system.rows {
            if !system.velocity_rows[row] {
                basis.push(&scaled(self.rows.row(row), &system.coordinate_scale, system.row_scale[row]));
                right.push(-self.rows.value[row] / system.row_scale[row]);
            }
        }
        (basis, right)
    }

    fn moved(&self, q: &[f64], step: &[f64]) -> Vec<f64> {
        let largest = step.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        let share = if largest > LARGEST_STEP { LARGEST_STEP / largest } else { 1.0 };
        q.iter().zip(step).zip(&self.system.coordinate_scale).map(|((q, s), scale)| q + share * s * scale).collect()
    }

    fn full_basis(&self) -> RowBasis {
        self.system.scaled_basis(&self.rows)
    }

    fn verdict(&self, singular: bool) -> Result<(), AssemblyError> {
        let system = self.system;
        let all: Vec<usize> = (0..system.rows).collect();
        let (row, size) = system.worst_row(&self.rows.value, &all);
        if !size.is_finite() || self.q.iter().any(|q| !q.is_finite()) {
            return Err(AssemblyError::NotFinite { row: system.row_name(row) });
        }
        if size <= system.closing_limit(&self.q) {
            return Ok(());
        }
        let by = self.rows.value[row];
        let singular = singular || self.near_singular();
        Err(AssemblyError::Unsatisfied { row: system.row_name(row), by, singular, nearest: self.q.clone() })
    }

    /// Whether rows nearly depend on each other where the search came to rest.
    fn near_singular(&self) -> bool {
        let (basis, right) = self.basis();
        (0..right.len()).any(|row| {
            let coefficients = basis.coefficients(row);
            let size = coefficients.iter().map(|c| c * c).sum::<f64>().sqrt();
            basis.independent().iter().position(|k| *k == row).is_none_or(|k| coefficients[k] < 1e-3 * size)
        })
    }
}

/// Shortest step that satisfies the rows best: `min |C y − b|² + damping |y|²` over the coefficients y of the basis.
fn step(basis: &RowBasis, right: &[f64], damping: f64) -> Vec<f64> {
    let rank = basis.rank();
    let mut y = vec![0.0; rank];
    if damping == 0.0 && rank == right.len() {
        // The coefficients of independent rows are a lower triangle.
        for row in 0..rank {
            let coefficients = basis.coefficients(row);
            let known: f64 = coefficients[..row].iter().zip(&y).map(|(c, y)| c * y).sum();
            y[row] = (right[row] - known) / coefficients[row];
        }
        return basis.combine(&y);
    }
    let mut normal = vec![0.0; rank * rank];
    for (row, b) in right.iter().enumerate() {
        let c = basis.coefficients(row);
        for i in 0..rank {
            y[i] += c[i] * b;
            for j in 0..rank {
                normal[i * rank + j] += c[i] * c[j];
            }
        }
    }
    for i in 0..rank {
        normal[i * rank + i] += damping;
    }
    let mut lu = Lu::new();
    match lu.factor(rank, rank, &normal) {
        Ok(()) => lu.solve(&mut y),
        Err(_) => y.fill(0.0),
    }
    basis.combine(&y)
}
