//! The small system of a network whose beams are condensed to their end motions.

use super::kernel::{Condensed, FIRST, SECOND, Unknowns};
use super::lanes::{LANES, Lane};
use crate::model::Model;

/// Adds `factor` times one number of a group of beams to an entry of the network.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    pub(crate) target: usize,
    /// Place among the numbers of the group, and lane.
    pub(crate) source: usize,
    pub(crate) lane: usize,
    pub(crate) factor: f64,
}

/// How one group of beams enters the network: its second and first derivatives, and the motions of its ends.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plan {
    pub(crate) matrix: Vec<Entry>,
    pub(crate) residual: Vec<Entry>,
    /// From an unknown to a motion (`φ_A`, `φ_B`, x, y): the other way.
    pub(crate) motion: Vec<Entry>,
    beams: usize,
}

/// A network without beam forces among its unknowns. The driven unknown is the last.
#[derive(Debug, Default)]
pub(crate) struct Net {
    pub(crate) unknowns: usize,
    pub(crate) plans: Vec<Plan>,
    /// Weight of each unknown in distances: 1 for rotations, more for displacements.
    pub(crate) weights: Vec<f64>,
    /// Rows, the lower triangle.
    matrix: Vec<f64>,
    residual: Vec<f64>,
    /// Two right-hand sides: Newton step and tangent.
    rhs: Vec<[f64; 2]>,
    pub(crate) change: Vec<f64>,
    pub(crate) tangent: Vec<f64>,
    /// Negative eigenvalues less multipliers at the last factorisation: 0 for a stable state under prescribed displacement.
    pub(crate) instability: i64,
    /// Driving force right to second order, and its slope, dimensionless per driven unknown.
    pub(crate) reaction: f64,
    pub(crate) slope: f64,
    /// Place of each unknown of the model; reused.
    place: Vec<Option<usize>>,
    motions: Vec<(usize, [f64; 4])>,
}

/// The system has no safe pivot.
#[derive(Debug)]
pub(crate) struct NoPivot;

impl Net {
    /// Numbers the unknowns of a network.
    pub(crate) fn prepare(&mut self, model: &Model, travel_weight: f64) {
        self.place.clear();
        // Those that are solved for, and the driven one; what supports hold is left out.
        self.place.resize(model.solved + 1, Some(0));
        for beam in &model.beams {
            self.place[beam.force] = None;
            self.place[beam.force + 1] = None;
        }
        self.unknowns = 0;
        for p in self.place.iter_mut().flatten() {
            *p = self.unknowns;
            self.unknowns += 1;
        }
        let n = self.unknowns;
        self.weights.clear();
        self.weights.resize(n, 1.0);
        for (i, _) in model.nodes.iter().flat_map(|n| &n.translations) {
            if let Some(at) = self.place.get(*i).copied().flatten() {
                self.weights[at] = travel_weight;
            }
        }
        self.plans.resize_with(model.beams.len().div_ceil(LANES), Plan::default);
        for (group, four) in model.beams.chunks(LANES).enumerate() {
            let plan = &mut self.plans[group];
            plan.matrix.clear();
            plan.residual.clear();
            plan.motion.clear();
            plan.beams = four.len();
            for (lane, beam) in four.iter().enumerate() {
                let at = |i: usize| self.place.get(i).copied().flatten();
                self.motions.clear();
                for (i, turn) in beam.ends.iter().zip([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]]) {
                    self.motions.extend(i.and_then(at).map(|i| (i, turn)));
                }
                for (node, sign) in beam.nodes.iter().zip([-1.0, 1.0]) {
                    let spread = |(i, d): &(usize, [f64; 2])| Some((at(*i)?, [0.0, 0.0, sign * d[0], sign * d[1]]));
                    self.motions.extend(model.nodes[*node].translations.iter().filter_map(spread));
                }
                plan.add(n, lane, &self.motions);
            }
        }
        self.matrix.resize(n * n, 0.0);
        self.residual.resize(n, 0.0);
        self.rhs.resize(n, [0.0; 2]);
        self.change.resize(n, 0.0);
        self.tangent.resize(n, 0.0);
    }

    /// End rotations and relative displacement of the four beams of a group.
    #[inline]
    pub(crate) fn ends(&self, group: usize, x: &[f64]) -> ([Lane; 2], [Lane; 2]) {
        let mut motion = [Lane::ZERO; 4];
        for e in &self.plans[group].motion {
            motion[e.source & 3].0[e.lane & (LANES - 1)] += e.factor * x[e.target];
        }
        let [a, b, x, y] = motion;
        ([a, b], [x, y])
    }

    /// Motion of a node with the given translations, in units of length.
    pub(crate) fn displacement(&self, translations: &[(usize, [f64; 2])], x: &[f64]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (i, direction) in translations {
            let moved = self.rotation(Some(*i), x);
            sum = [sum[0] + direction[0] * moved, sum[1] + direction[1] * moved];
        }
        sum
    }

    /// Value of an unknown of the model, which may not exist or be held by a support.
    pub(crate) fn rotation(&self, unknown: Option<usize>, x: &[f64]) -> f64 {
        unknown.and_then(|i| self.place.get(i).copied().flatten()).map_or(0.0, |i| x[i])
    }

    /// Adds first derivatives of the four beams of a group by (`φ_A`, `φ_B`, x, y) to a column of `rhs`, a row per unknown.
    pub(crate) fn scatter(&self, group: usize, first: &[Lane; 4], rhs: &mut [f64], (column, columns): (usize, usize)) {
        for e in &self.plans[group].residual {
            rhs[e.target * columns + column] += e.factor * first[(e.source - FIRST[0]) & 3].0[e.lane & 3];
        }
    }

    /// The matrix of the unknowns that are solved for, the driven one left out, as the beams added it: both triangles.
    pub(crate) fn free_matrix(&self, out: &mut Vec<f64>) {
        let (n, free) = (self.unknowns, self.unknowns - 1);
        out.clear();
        out.extend((0..free).flat_map(|row| (0..free).map(move |column| self.matrix[row.max(column) * n + row.min(column)])));
    }

    pub(crate) fn clear(&mut self) {
        self.matrix.fill(0.0);
        self.residual.fill(0.0);
        self.instability = 0;
    }

    /// Adds the beams of a group.
    pub(crate) fn add<const M: usize, const Q: usize>(&mut self, group: usize, beams: &Condensed<M, Q>) {
        let plan = &self.plans[group];
        for e in &plan.matrix {
            self.matrix[e.target] += e.factor * beams.flat[e.source & 15].0[e.lane & (LANES - 1)];
        }
        for e in &plan.residual {
            self.residual[e.target] += e.factor * beams.flat[e.source & 15].0[e.lane & (LANES - 1)];
        }
        self.instability += beams.negative.iter().take(plan.beams).map(|n| i64::from(*n) - 2).sum::<i64>();
    }

    /// Factors the system and finds the Newton step, the tangent by the driven unknown, reaction and slope.
    ///
    /// # Errors
    /// [`NoPivot`] where elimination without pivoting is not safe.
    pub(crate) fn solve(&mut self) -> Result<(), NoPivot> {
        let n = self.unknowns;
        let free = n - 1;
        let last = free * n;
        // The driven row is kept for the reaction; elimination touches only the free block.
        for row in 0..free {
            self.rhs[row] = [-self.residual[row], -self.matrix[last + row]];
        }
        match free {
            3 => self.eliminate_small::<3>()?,
            4 => self.eliminate_small::<4>()?,
            5 => self.eliminate_small::<5>()?,
            6 => self.eliminate_small::<6>()?,
            7 => self.eliminate_small::<7>()?,
            8 => self.eliminate_small::<8>()?,
            9 => self.eliminate_small::<9>()?,
            _ => self.instability += eliminate(&mut self.matrix, n, &mut self.rhs[..free])?,
        }
        let row = &self.matrix[last..last + n];
        (self.reaction, self.slope) = (self.residual[free], row[free]);
        for ((a, rhs), (change, tangent)) in row.iter().zip(&self.rhs[..free]).zip(self.change.iter_mut().zip(&mut self.tangent)) {
            [*change, *tangent] = *rhs;
            self.reaction += a * rhs[0];
            self.slope += a * rhs[1];
        }
        (self.change[free], self.tangent[free]) = (0.0, 1.0);
        Ok(())
    }

    /// As [`eliminate`], with a size that the compiler knows.
    #[allow(clippy::needless_range_loop, reason = "elimination is read by its indices")]
    fn eliminate_small<const N: usize>(&mut self) -> Result<(), NoPivot> {
        let n = N + 1;
        let (mut matrix, mut rhs) = ([[0.0; N]; N], [[0.0; 2]; N]);
        for row in 0..N {
            for k in 0..=row {
                matrix[row][k] = self.matrix[row * n + k];
                matrix[k][row] = matrix[row][k];
            }
            rhs[row] = self.rhs[row];
        }
        for k in 0..N {
            let (upper, own) = (matrix[k], rhs[k]);
            let pivot = upper[k];
            if !safe(pivot, self.matrix[k * n + k].abs()) {
                return Err(NoPivot);
            }
            self.instability += i64::from(pivot < 0.0);
            let inverse = 1.0 / pivot;
            matrix[k][k] = inverse;
            // Whole rows: what is left of the diagonal is not read again.
            for row in k + 1..N {
                let factor = matrix[row][k] * inverse;
                for j in 0..N {
                    matrix[row][j] -= factor * upper[j];
                }
                rhs[row][0] -= factor * own[0];
                rhs[row][1] -= factor * own[1];
            }
        }
        for row in (0..N).rev() {
            let mut value = rhs[row];
            for k in row + 1..N {
                value[0] -= matrix[row][k] * rhs[k][0];
                value[1] -= matrix[row][k] * rhs[k][1];
            }
            rhs[row] = [value[0] * matrix[row][row], value[1] * matrix[row][row]];
        }
        self.rhs[..N].copy_from_slice(&rhs);
        Ok(())
    }
}

impl Plan {
    /// Adds a beam with the unknowns that move it, each with its motion (`φ_A`, `φ_B`, x, y). No unknown moves a beam in two ways.
    fn add(&mut self, n: usize, lane: usize, motions: &[(usize, [f64; 4])]) {
        for (at, (column, motion)) in motions.iter().enumerate() {
            for (i, own) in motion.iter().enumerate() {
                if *own == 0.0 {
                    continue;
                }
                self.residual.push(Entry { target: *column, source: FIRST[i], lane, factor: *own });
                self.motion.push(Entry { target: *column, source: i, lane, factor: *own });
                for (row, other) in &motions[at..] {
                    let target = (*row).max(*column) * n + (*row).min(*column);
                    for (j, value) in other.iter().enumerate() {
                        if *value != 0.0 {
                            self.matrix.push(Entry { target, source: SECOND[i][j], lane, factor: own * value });
                        }
                    }
                }
            }
        }
    }
}

/// Least size of a pivot, relative to what it started from.
pub(crate) const SMALL_PIVOT: f64 = 1e-9;

/// Whether a pivot is safe to divide by, given what it started from. Written so that NaN is not.
fn safe(pivot: f64, scale: f64) -> bool {
    pivot.abs() > SMALL_PIVOT * scale && pivot.is_finite()
}

/// Solves for the right-hand sides with the leading block of a symmetric matrix of `n` columns, of which the lower triangle is read.
/// Returns the number of negative pivots.
fn eliminate(matrix: &mut [f64], n: usize, rhs: &mut [[f64; 2]]) -> Result<i64, NoPivot> {
    let free = rhs.len();
    let mut negative = 0;
    for row in 0..free {
        let (done, rest) = matrix.split_at_mut(row * n);
        let current = &mut rest[..=row];
        let scale = current[row].abs();
        for k in 0..row {
            let above = &done[k * n..k * n + k];
            let sum: f64 = current[..k].iter().zip(above).map(|(a, b)| a * b).sum();
            current[k] -= sum;
        }
        let (mut pivot, mut value) = (current[row], rhs[row]);
        for k in 0..row {
            // done[k][k] holds 1/D.
            let factor = current[k] * done[k * n + k];
            pivot -= current[k] * factor;
            current[k] = factor;
            value[0] -= factor * rhs[k][0];
            value[1] -= factor * rhs[k][1];
        }
        if !safe(pivot, scale) {
            return Err(NoPivot);
        }
        negative += i64::from(pivot < 0.0);
        current[row] = 1.0 / pivot;
        rhs[row] = value;
    }
    for (row, value) in rhs.iter_mut().enumerate() {
        *value = value.map(|v| v * matrix[row * n + row]);
    }
    for row in (0..free).rev() {
        let value = rhs[row];
        for k in 0..row {
            let factor = matrix[row * n + k];
            rhs[k][0] -= factor * value[0];
            rhs[k][1] -= factor * value[1];
        }
    }
    Ok(negative)
}

/// Adds `factor` times a change to the unknowns of four beams.
#[inline]
pub(crate) fn add_scaled<const M: usize>(target: &mut Unknowns<M>, change: &Unknowns<M>, factor: f64) {
    for i in 0..2 {
        target.force[i] += change.force[i] * factor;
        target.ends[i] += change.ends[i] * factor;
    }
    for (t, c) in target.bubbles.iter_mut().zip(&change.bubbles) {
        *t += *c * factor;
    }
}
