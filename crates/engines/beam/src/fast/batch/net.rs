//! The small systems of four designs of one topology, side by side.

use crate::fast::kernel::Condensed;
use crate::fast::lanes::{LANES, Lane};
use crate::fast::network::{Net, SMALL_PIVOT};
use crate::model::Model;

/// Adds `factor` times one number of a beam to an entry of the network.
#[derive(Clone, Copy, Debug)]
struct Entry {
    target: usize,
    source: usize,
    factor: f64,
}

/// How one beam enters the network; see the plan of [`Net`].
#[derive(Clone, Debug, Default)]
struct Plan {
    matrix: Vec<Entry>,
    residual: Vec<Entry>,
    motion: Vec<Entry>,
}

/// As [`Net`], for four designs. The driven unknown is the last.
#[derive(Clone, Debug, Default)]
pub(super) struct LaneNet {
    pub(super) unknowns: usize,
    plans: Vec<Plan>,
    /// Weight of each unknown in distances.
    weights: Vec<f64>,
    /// Rows, the lower triangle.
    matrix: Vec<Lane>,
    residual: Vec<Lane>,
    /// Newton step and tangent by the driven unknown.
    pub(super) change: Vec<Lane>,
    pub(super) tangent: Vec<Lane>,
    /// Driving force right to second order, and its slope, dimensionless per driven unknown.
    pub(super) reaction: Lane,
    pub(super) slope: Lane,
    /// Negative eigenvalues less multipliers at the last factorisation.
    pub(super) instability: [i64; LANES],
    /// The smallest ratio of a pivot to the least that is safe.
    pub(super) margin: Lane,
}

impl LaneNet {
    pub(super) fn new(model: &Model, travel_weight: f64) -> Self {
        let mut net = Net::default();
        net.prepare(model, travel_weight);
        let n = net.unknowns;
        let plan = |beam: usize| {
            let group = &net.plans[beam / LANES];
            let own = |entries: &[crate::fast::network::Entry]| {
                let own = entries.iter().filter(|e| e.lane == beam % LANES);
                own.map(|e| Entry { target: e.target, source: e.source, factor: e.factor }).collect()
            };
            Plan { matrix: own(&group.matrix), residual: own(&group.residual), motion: own(&group.motion) }
        };
        let plans = (0..model.beams.len()).map(plan).collect();
        let zeros = |count: usize| vec![Lane::ZERO; count];
        Self {
            unknowns: n,
            plans,
            weights: net.weights,
            matrix: zeros(n * n),
            residual: zeros(n),
            change: zeros(n),
            tangent: zeros(n),
            ..Self::default()
        }
    }

    /// End rotations and relative displacement of a beam.
    #[inline(always)]
    pub(super) fn ends(&self, beam: usize, x: &[Lane]) -> ([Lane; 2], [Lane; 2]) {
        let mut motion = [Lane::ZERO; 4];
        for e in &self.plans[beam].motion {
            motion[e.source & 3] += x[e.target] * e.factor;
        }
        let [a, b, x, y] = motion;
        ([a, b], [x, y])
    }

    pub(super) fn clear(&mut self) {
        self.matrix.fill(Lane::ZERO);
        self.residual.fill(Lane::ZERO);
        self.instability = [0; LANES];
    }

    /// Adds a beam.
    #[inline(always)]
    pub(super) fn add<const M: usize, const Q: usize>(&mut self, beam: usize, condensed: &Condensed<M, Q>) {
        let plan = &self.plans[beam];
        for e in &plan.matrix {
            self.matrix[e.target] += condensed.flat[e.source & 15] * e.factor;
        }
        for e in &plan.residual {
            self.residual[e.target] += condensed.flat[e.source & 15] * e.factor;
        }
        for (sum, negative) in self.instability.iter_mut().zip(condensed.negative) {
            *sum += i64::from(negative) - 2;
        }
    }

    /// L·D·Lᵀ of the free block in place, without pivoting; Newton step, tangent, reaction and slope.
    #[inline(always)]
    pub(super) fn solve(&mut self) {
        let n = self.unknowns;
        let free = n - 1;
        let (block, driven) = self.matrix.split_at_mut(free * n);
        self.margin = Lane::splat(f64::INFINITY);
        for row in 0..free {
            let (done, rest) = block.split_at_mut(row * n);
            let current = &mut rest[..=row];
            let scale = current[row].abs() * SMALL_PIVOT;
            let (mut pivot, mut step, mut along) = (current[row], -self.residual[row], -driven[row]);
            for k in 0..row {
                let above = &done[k * n..k * n + k];
                let sum = current[..k].iter().zip(above).fold(current[k], |sum, (a, b)| sum - *a * *b);
                current[k] = sum;
            }
            for k in 0..row {
                let factor = current[k] * done[k * n + k];
                pivot -= current[k] * factor;
                current[k] = factor;
                step -= factor * self.change[k];
                along -= factor * self.tangent[k];
            }
            self.margin = self.margin.min(pivot.abs() / scale);
            for (count, p) in self.instability.iter_mut().zip(pivot.0) {
                *count += i64::from(p < 0.0);
            }
            current[row] = Lane::splat(1.0) / pivot;
            (self.change[row], self.tangent[row]) = (step, along);
        }
        for row in 0..free {
            let inverse = block[row * n + row];
            self.change[row] = self.change[row] * inverse;
            self.tangent[row] = self.tangent[row] * inverse;
        }
        for row in (0..free).rev() {
            let (step, along) = (self.change[row], self.tangent[row]);
            for k in 0..row {
                let factor = block[row * n + k];
                self.change[k] -= factor * step;
                self.tangent[k] -= factor * along;
            }
        }
        (self.reaction, self.slope) = (self.residual[free], driven[free]);
        for (a, (step, along)) in driven.iter().zip(self.change.iter().zip(&self.tangent)).take(free) {
            self.reaction += *a * *step;
            self.slope += *a * *along;
        }
        (self.change[free], self.tangent[free]) = (Lane::ZERO, Lane::splat(1.0));
    }

    /// Weighted size of a change.
    #[inline(always)]
    pub(super) fn size(&self, change: &[Lane]) -> Lane {
        change.iter().zip(&self.weights).fold(Lane::ZERO, |m, (c, w)| m.max(c.abs() * *w))
    }
}
