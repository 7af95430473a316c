//! The small system of a network whose beams are condensed to their end motions.

use super::kernel::{Condensed, Unknowns};
use super::lanes::{LANES, Lane};
use crate::model::Model;

/// How an unknown of the network moves a beam.
#[derive(Clone, Copy, Debug)]
enum Motion {
    /// It turns the end 0 or 1.
    Turn(usize),
    /// It moves B away from A along this vector.
    Spread([f64; 2]),
}

/// The unknowns that move one beam.
#[derive(Clone, Debug, Default)]
struct Incidence {
    motions: Vec<(usize, Motion)>,
}

/// A network without beam forces among its unknowns. The driven unknown is the last.
#[derive(Debug)]
pub(crate) struct Net {
    pub(crate) unknowns: usize,
    incidences: Vec<Incidence>,
    /// Weight of each unknown in distances: 1 for rotations, more for displacements.
    pub(crate) weights: Vec<f64>,
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
}

/// The system has no safe pivot.
#[derive(Debug)]
pub(crate) struct NoPivot;

impl Net {
    pub(crate) fn new(model: &Model, travel_weight: f64) -> Self {
        // What supports hold is left out.
        let mut place = vec![Some(0_usize); model.solved + 1];
        for beam in &model.beams {
            place[beam.force] = None;
            place[beam.force + 1] = None;
        }
        let mut unknowns = 0;
        for p in place.iter_mut().flatten() {
            *p = unknowns;
            unknowns += 1;
        }
        let mut weights = vec![1.0; unknowns];
        let at = |i: usize| place.get(i).copied().flatten().unwrap_or(0);
        let moves = |i: &usize| *i <= model.solved;
        for (i, _) in model.nodes.iter().flat_map(|n| &n.translations).filter(|(i, _)| moves(i)) {
            weights[at(*i)] = travel_weight;
        }
        let incidences = model
            .beams
            .iter()
            .map(|beam| {
                let turns = beam.ends.iter().enumerate().filter_map(|(end, i)| Some(((*i)?, Motion::Turn(end))));
                let spreads = beam.nodes.iter().zip([-1.0, 1.0]).flat_map(|(node, sign)| {
                    model.nodes[*node].translations.iter().map(move |(i, d)| (*i, Motion::Spread([sign * d[0], sign * d[1]])))
                });
                Incidence { motions: turns.chain(spreads).filter(|(i, _)| moves(i)).map(|(i, m)| (at(i), m)).collect() }
            })
            .collect();
        Self {
            unknowns,
            incidences,
            weights,
            matrix: vec![0.0; unknowns * unknowns],
            residual: vec![0.0; unknowns],
            rhs: vec![[0.0; 2]; unknowns],
            change: vec![0.0; unknowns],
            tangent: vec![0.0; unknowns],
            instability: 0,
            reaction: 0.0,
            slope: 0.0,
        }
    }

    /// End rotations and relative displacement of the four beams of a group.
    pub(crate) fn ends(&self, group: usize, x: &[f64]) -> ([Lane; 2], [Lane; 2]) {
        let (mut ends, mut apart) = ([Lane::ZERO; 2], [Lane::ZERO; 2]);
        for (lane, incidence) in self.incidences.iter().skip(group * LANES).take(LANES).enumerate() {
            for (i, motion) in &incidence.motions {
                match motion {
                    Motion::Turn(end) => ends[*end].0[lane] += x[*i],
                    Motion::Spread([a, b]) => {
                        apart[0].0[lane] += a * x[*i];
                        apart[1].0[lane] += b * x[*i];
                    }
                }
            }
        }
        (ends, apart)
    }

    pub(crate) fn clear(&mut self) {
        self.matrix.fill(0.0);
        self.residual.fill(0.0);
        self.instability = 0;
    }

    /// Adds the beams of a group.
    pub(crate) fn add<const M: usize>(&mut self, group: usize, beams: &Condensed<M>) {
        let n = self.unknowns;
        for (lane, incidence) in self.incidences.iter().skip(group * LANES).take(LANES).enumerate() {
            self.instability += i64::from(beams.negative[lane]) - 2;
            let get = |block: &[[Lane; 2]; 2], i: usize, j: usize| block[i][j].0[lane];
            for (at, (column, motion)) in incidence.motions.iter().enumerate() {
                // Moments at the ends and pull that this motion answers with.
                let (moments, pulls, gradient) = match motion {
                    Motion::Turn(end) => (
                        [get(&beams.rotation, 0, *end), get(&beams.rotation, 1, *end)],
                        [get(&beams.mixed, 0, *end), get(&beams.mixed, 1, *end)],
                        beams.moment[*end].0[lane],
                    ),
                    Motion::Spread([a, b]) => (
                        [0, 1].map(|end| get(&beams.mixed, 0, end) * a + get(&beams.mixed, 1, end) * b),
                        [0, 1].map(|axis| get(&beams.translation, axis, 0) * a + get(&beams.translation, axis, 1) * b),
                        beams.pull[0].0[lane] * a + beams.pull[1].0[lane] * b,
                    ),
                };
                self.residual[*column] += gradient;
                for (row, motion) in &incidence.motions[at..] {
                    let value = match motion {
                        Motion::Turn(end) => moments[*end],
                        Motion::Spread([a, b]) => pulls[0] * a + pulls[1] * b,
                    };
                    // The lower triangle. No unknown moves a beam in two ways.
                    let (low, high) = if row < column { (row, column) } else { (column, row) };
                    self.matrix[high * n + low] += value;
                }
            }
        }
    }

    /// Factors the system and finds the Newton step, the tangent by the driven unknown, reaction and slope.
    ///
    /// # Errors
    /// [`NoPivot`] where elimination without pivoting is not safe.
    pub(crate) fn solve(&mut self) -> Result<(), NoPivot> {
        let n = self.unknowns;
        let free = n - 1;
        let last = free * n;
        for row in 0..free {
            self.rhs[row] = [-self.residual[row], -self.matrix[last + row]];
        }
        // The driven row is kept for the reaction; elimination touches only the free block.
        for row in 0..free {
            let (done, rest) = self.matrix.split_at_mut(row * n);
            let current = &mut rest[..=row];
            let scale = current[row].abs();
            let mut rhs = self.rhs[row];
            let mut pivot = current[row];
            for k in 0..row {
                let above = &done[k * n..k * n + k];
                let sum: f64 = current[..k].iter().zip(above).map(|(a, b)| a * b).sum();
                current[k] -= sum;
            }
            for k in 0..row {
                // done[k][k] holds 1/D.
                let factor = current[k] * done[k * n + k];
                pivot -= current[k] * factor;
                current[k] = factor;
                rhs[0] -= factor * self.rhs[k][0];
                rhs[1] -= factor * self.rhs[k][1];
            }
            // Written so that NaN fails.
            if !(pivot.abs() > 1e-9 * scale && pivot.is_finite()) {
                return Err(NoPivot);
            }
            self.instability += i64::from(pivot < 0.0);
            current[row] = 1.0 / pivot;
            self.rhs[row] = rhs;
        }
        for row in 0..free {
            let inverse = self.matrix[row * n + row];
            self.rhs[row][0] *= inverse;
            self.rhs[row][1] *= inverse;
        }
        for row in (0..free).rev() {
            let value = self.rhs[row];
            for k in 0..row {
                let factor = self.matrix[row * n + k];
                self.rhs[k][0] -= factor * value[0];
                self.rhs[k][1] -= factor * value[1];
            }
        }
        (self.reaction, self.slope) = (self.residual[free], self.matrix[last + free]);
        for row in 0..free {
            let [change, tangent] = self.rhs[row];
            self.reaction += self.matrix[last + row] * change;
            self.slope += self.matrix[last + row] * tangent;
            self.change[row] = change;
            self.tangent[row] = tangent;
        }
        self.change[free] = 0.0;
        self.tangent[free] = 1.0;
        Ok(())
    }
}

/// Adds `factor` times a change to the unknowns of four beams.
pub(crate) fn add_scaled<const M: usize>(target: &mut Unknowns<M>, change: &Unknowns<M>, factor: f64) {
    for i in 0..2 {
        target.force[i] += change.force[i] * factor;
    }
    for (t, c) in target.bubbles.iter_mut().zip(&change.bubbles) {
        *t += *c * factor;
    }
}
