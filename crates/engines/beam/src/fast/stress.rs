//! The largest stress of a network in a given state.

#![allow(clippy::needless_range_loop, reason = "sums over modes are read by their indices")]

use forcewright_base::maths;

use super::kernel::{EXTRA, Unknowns};
use super::lanes::{LANES, Lane};
use super::network::add_scaled;
use crate::element::root_of;
use crate::model::Model;

/// Beams whose coarse maximum is at least this part of the largest are looked at closely.
const CLOSE: f64 = 0.98;

/// Slopes of the bubbles at Chebyshev points, where stress is looked for first.
#[derive(Debug)]
pub(crate) struct Sampling<const M: usize> {
    slope: Vec<([f64; M], [f64; EXTRA])>,
}

/// What stress is computed from: the state of four beams with the modes beyond those solved for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slopes<const M: usize> {
    base: Unknowns<M>,
    extra: [Lane; EXTRA],
}

impl<const M: usize> Default for Slopes<M> {
    fn default() -> Self {
        Self { base: Unknowns::default(), extra: [Lane::ZERO; EXTRA] }
    }
}

impl<const M: usize> Slopes<M> {
    /// Adds a state with a weight.
    #[inline]
    pub(crate) fn add_scaled(&mut self, state: &Unknowns<M>, extra: &[Lane; EXTRA], weight: f64) {
        add_scaled(&mut self.base, state, weight);
        self.base.ends[0] += state.ends[0] * weight;
        self.base.ends[1] += state.ends[1] * weight;
        for (sum, value) in self.extra.iter_mut().zip(extra) {
            *sum += *value * weight;
        }
    }
}

/// Buffers of [`Sampling::peak`].
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    bending: Vec<Lane>,
    /// Beam, sample, and what the stress there cannot exceed by much.
    places: Vec<(usize, usize, f64)>,
}

/// What turns slopes and forces into stress, for the beams of one network.
#[derive(Debug, Default)]
pub(crate) struct StressModel {
    /// Per group: Pa per rad of slope, Pa per unit of force.
    factors: Vec<[Lane; 2]>,
}

impl<const M: usize> Sampling<M> {
    pub(crate) fn new() -> Self {
        let intervals = 2 * M + 4;
        let place = |i: usize| 0.5 - 0.5 * maths::cos(std::f64::consts::PI * i as f64 / intervals as f64);
        Self { slope: (0..=intervals).map(|i| modes::<M>(place(i)).0).collect() }
    }

    /// Prepares a network.
    pub(crate) fn model(model: &Model) -> StressModel {
        let mut out = StressModel::default();
        for group in model.beams.chunks(LANES) {
            let mut factors = [Lane::ZERO; 2];
            for (lane, beam) in group.iter().enumerate() {
                let section = &beam.info.section;
                factors[0].0[lane] = 0.5 * section.young_pa * section.thickness_m / beam.info.shape.length_m();
                if beam.constants.axial > 0.0 {
                    factors[1].0[lane] = model.force_n / section.area_m2();
                }
            }
            out.factors.push(factors);
        }
        out
    }

    /// The beam with the largest stress, and that stress, Pa.
    ///
    /// Bending is looked at everywhere, axial stress where bending is largest: it changes little along a beam.
    pub(crate) fn peak(&self, model: &Model, stress: &StressModel, groups: &[Slopes<M>], scratch: &mut Scratch) -> (usize, f64) {
        scratch.places.clear();
        let mut largest = 0.0_f64;
        for (group, state) in groups.iter().enumerate() {
            self.bending(state, stress.factors[group][0], &mut scratch.bending);
            let axial = (state.base.force[0].abs() + state.base.force[1].abs()) * stress.factors[group][1];
            for lane in 0..LANES.min(model.beams.len() - group * LANES) {
                let at = |sample: usize| scratch.bending[sample].0[lane];
                let last = scratch.bending.len() - 1;
                for sample in 0..=last {
                    let (left, here, right) = (at(sample.saturating_sub(1)), at(sample), at((sample + 1).min(last)));
                    if here >= left && here >= right {
                        let estimate = vertex(left, here, right);
                        largest = largest.max(estimate);
                        scratch.places.push((group * LANES + lane, sample, estimate + axial.0[lane]));
                    }
                }
            }
        }
        let mut best = (0, -1.0);
        for (beam, sample, bound) in &scratch.places {
            // What cannot exceed the largest is not looked at closely.
            if *bound >= CLOSE * largest {
                let value = self.polish(model, stress, *beam, *sample, &groups[beam / LANES]);
                if value > best.1 {
                    best = (*beam, value);
                }
            }
        }
        best
    }

    /// Bending stress of four beams at all samples.
    fn bending(&self, state: &Slopes<M>, factor: Lane, out: &mut Vec<Lane>) {
        let turn = state.base.ends[1] - state.base.ends[0];
        out.clear();
        for (slopes, extra) in &self.slope {
            let mut slope = turn;
            for k in 0..M {
                slope += state.base.bubbles[k] * slopes[k];
            }
            for k in 0..EXTRA {
                slope += state.extra[k] * extra[k];
            }
            out.push(slope.abs() * factor);
        }
    }

    /// The maximum between the neighbours of a sample, by two parabolas in the angle whose cosine spaces the samples.
    fn polish(&self, model: &Model, stress: &StressModel, beam: usize, sample: usize, state: &Slopes<M>) -> f64 {
        let (group, lane) = (beam / LANES, beam % LANES);
        let spacing = std::f64::consts::PI / (self.slope.len() - 1) as f64;
        let factors = stress.factors[group].map(|f| f.0[lane]);
        let shape = &model.beams[beam].info.shape;
        let value = |angle: f64| {
            let u = 0.5 - 0.5 * maths::cos(angle);
            let ((slopes, extra), values) = modes::<M>(u);
            let [a, b] = state.base.ends.map(|e| e.0[lane]);
            let (mut slope, mut phi) = (b - a, a + (b - a) * u);
            for k in 0..M {
                slope += state.base.bubbles[k].0[lane] * slopes[k];
                phi += state.base.bubbles[k].0[lane] * values[k];
            }
            for k in 0..EXTRA {
                slope += state.extra[k].0[lane] * extra[k];
            }
            let mut sum = slope.abs() * factors[0];
            if factors[1] > 0.0 {
                let (sin, cos) = maths::sin_cos(shape.angle_at(u) + phi);
                sum += (state.base.force[0].0[lane] * cos + state.base.force[1].0[lane] * sin).abs() * factors[1];
            }
            sum
        };
        let (mut at, mut reach) = (sample as f64 * spacing, 0.5 * spacing);
        if sample == 0 || sample + 1 == self.slope.len() {
            // An end is a maximum unless the stress rises from it; then the maximum is next to it.
            let inward = if sample == 0 { 0.1 * spacing } else { -0.1 * spacing };
            let end = value(at);
            if value(at + inward) <= end {
                return end;
            }
        }
        let mut best = 0.0_f64;
        for _ in 0..2 {
            let [left, middle, right] = [value(at - reach), value(at), value(at + reach)];
            let bend = left - 2.0 * middle + right;
            best = best.max(middle);
            if bend >= 0.0 {
                return best;
            }
            at += (0.5 * (left - right) / bend * reach).clamp(-reach, reach);
            reach *= 0.1;
        }
        best.max(value(at))
    }
}

/// Height of the parabola through three equally spaced values around the largest of them.
fn vertex(left: f64, middle: f64, right: f64) -> f64 {
    let bend = left - 2.0 * middle + right;
    if bend < 0.0 { middle - 0.125 * (left - right) * (left - right) / bend } else { middle }
}

/// Slopes of all modes and values of the bubbles at a place.
fn modes<const M: usize>(u: f64) -> (([f64; M], [f64; EXTRA]), [f64; M]) {
    let x = 2.0 * u - 1.0;
    let (mut slope, mut extra, mut value) = ([0.0; M], [0.0; EXTRA], [0.0; M]);
    let (mut before, mut here) = (1.0, x);
    for k in 2..M + EXTRA + 2 {
        let n = k as f64;
        let next = ((2.0 * n - 1.0) * x * here - (n - 1.0) * before) / n;
        if k < M + 2 {
            slope[k - 2] = root_of(k) * here;
            value[k - 2] = (next - before) / (2.0 * root_of(k));
        } else {
            extra[k - 2 - M] = root_of(k) * here;
        }
        (before, here) = (here, next);
    }
    ((slope, extra), value)
}
