//! One beam at a converged state: stress, its largest value and positions, with their derivatives.
//!
//! Everything is a function of the coordinates of the beam: end rotations, force, recovered modes of the rotation, place of its start,
//! and its constants. A seed holds the derivatives of an output by these; the state holds theirs by the design, a row each. The formulas
//! are those of `gradient/seed.rs`, where the modes are seeds carried back to the unknowns; here the modes have derivatives themselves.

use forcewright_base::{maths, quadrature::legendre_values};

use super::lanes::{LANES, Lane};
use super::mixed::{ANGLES, AXIAL, BENDING, LENGTH, SHEAR, sum_of};
use super::stress::{INVERSES, MODES, ROOTS};
use crate::state::{Face, PeakStress};

/// Places of the coordinates of a beam: rotations of both ends, force, place of the start in m, logarithms of thickness and depth as far
/// as they do not act through the other constants, the modes, and then the constants as in [`super::mixed`].
pub(super) const ENDS: usize = 0;
pub(super) const FORCE: usize = 2;
pub(super) const START: usize = 4;
pub(super) const THICKNESS: usize = 6;
pub(super) const DEPTH: usize = 7;
pub(super) const FIRST_MODE: usize = 8;

/// Samples below this part of the largest are not next to the largest stress.
const CLOSE: f64 = 0.9;
/// The last step to the place of a largest stress, in u; Newton's method leaves about its square.
const LAST_STEP: f64 = 1e-8;
const MOST_ITERATIONS: usize = 60;

/// One beam at one state. Forces are dimensionless.
#[derive(Clone, Debug, Default)]
pub(super) struct BeamAt {
    pub(super) ends: [f64; 2],
    pub(super) force: [f64; 2],
    pub(super) start_m: [f64; 2],
    pub(super) modes: Vec<f64>,
    /// Angle coefficients at rest.
    pub(super) angle: Vec<f64>,
    pub(super) length_m: f64,
    pub(super) thickness_m: f64,
    /// 1/EA and 1/kGA.
    pub(super) soft: [f64; 2],
    /// Stress per slope dφ/du, and per unit of axial force, Pa; the second is 0 if the beam does not stretch.
    pub(super) stress: [f64; 2],
    /// Derivatives of the coordinates, a row per parameter and one by the control.
    pub(super) rows: Vec<f64>,
}

/// Derivatives of an output by the coordinates of a beam, and room to find them.
#[derive(Clone, Debug, Default)]
pub(super) struct Seed {
    pub(super) values: Vec<f64>,
    legendre: Vec<f64>,
    line: Vec<LinePoint>,
    /// The beam and the place that the line was made for.
    line_of: Option<(usize, u64)>,
}

/// Four quadrature points between the start of a beam and a place on it.
#[derive(Clone, Debug)]
struct LinePoint {
    v: Lane,
    weight: Lane,
    cos: Lane,
    sin: Lane,
    modes: [Lane; MODES],
}

/// A quadrature rule on [0, 1], four points at a time, filled up with points without weight.
pub(super) type Rule = Vec<[Lane; 2]>;

pub(super) fn fill_rule(nodes: &[f64], weights: &[f64], out: &mut Rule) {
    out.clear();
    for (four, four_weights) in nodes.chunks(LANES).zip(weights.chunks(LANES)) {
        let mut lanes = [Lane::ZERO; 2];
        lanes[0].0[..four.len()].copy_from_slice(four);
        lanes[1].0[..four.len()].copy_from_slice(four_weights);
        out.push(lanes);
    }
}

/// Chebyshev points, more than modes, so that no extremum of their sum falls between two of them unseen.
pub(super) fn fill_samples(modes: usize, out: &mut Vec<f64>) {
    let intervals = (modes + modes / 2 + 1).next_multiple_of(LANES) - 1;
    if out.len() != intervals + 1 {
        out.clear();
        out.extend((0..=intervals).map(|i| 0.5 - 0.5 * maths::cos(std::f64::consts::PI * i as f64 / intervals as f64)));
    }
}

impl Seed {
    /// Starts anew for a beam.
    pub(super) fn start(&mut self, beam: &BeamAt) {
        self.values.clear();
        self.values.resize(beam.width(), 0.0);
    }

    /// The output changes by `factor` times the angle θ(u).
    fn add_angle(&mut self, beam: &BeamAt, u: f64, factor: f64) {
        self.values[ENDS] += factor * (1.0 - u);
        self.values[ENDS + 1] += factor * u;
        legendre_values(2.0 * u - 1.0, &mut self.legendre);
        for (k, target) in self.values[FIRST_MODE..FIRST_MODE + beam.modes.len()].iter_mut().enumerate() {
            *target += factor * (self.legendre[k + 2] - self.legendre[k]) * 0.5 / ROOTS[k];
        }
        let mut power = factor;
        for target in &mut self.values[beam.constants() + ANGLES..] {
            *target += power;
            power *= u;
        }
    }

    /// `factor` times the stress in Pa on a face at a place; see [`crate::BeamState::stress_pa`].
    pub(super) fn add_stress(&mut self, beam: &BeamAt, u: f64, face: Face, factor: f64) {
        let (modes, constants) = (beam.modes.len(), beam.constants());
        self.legendre.resize(modes + 2, 0.0);
        legendre_values(2.0 * u - 1.0, &mut self.legendre);
        let local = beam.local(u);
        let by_slope = beam.stress[0] * if face == Face::Left { -factor } else { factor };
        // E w/(2L) is EI/L over w² b.
        let bending = by_slope * local.slope[0];
        self.values[constants + BENDING] += bending;
        self.values[THICKNESS] -= 2.0 * bending;
        self.values[DEPTH] -= bending;
        self.values[ENDS] -= by_slope;
        self.values[ENDS + 1] += by_slope;
        for (k, target) in self.values[FIRST_MODE..FIRST_MODE + modes].iter_mut().enumerate() {
            *target += by_slope * ROOTS[k] * self.legendre[k + 1];
        }
        if beam.stress[1] > 0.0 {
            let per_force = factor * beam.stress[1];
            let (sin, cos) = maths::sin_cos(local.angle[0]);
            let [h, v] = beam.force;
            let stress = per_force * (h * cos + v * sin);
            self.values[THICKNESS] -= stress;
            self.values[DEPTH] -= stress;
            self.values[FORCE] += per_force * cos;
            self.values[FORCE + 1] += per_force * sin;
            self.add_angle(beam, u, per_force * (v * cos - h * sin));
        }
    }

    /// Another state follows.
    pub(super) fn forget(&mut self) {
        self.line_of = None;
    }

    /// Quadrature points between the start of a beam, given with its number, and a place.
    pub(super) fn prepare_line(&mut self, (index, beam): (usize, &BeamAt), rule: &Rule, u: f64) {
        // Both coordinates of a place come one after the other.
        let key = Some((index, u.to_bits()));
        if self.line_of == key {
            return;
        }
        self.line_of = key;
        self.line.clear();
        for [node, weight] in rule {
            let v = *node * u;
            let mut modes = [Lane::ZERO; MODES];
            let x = v * 2.0 - Lane::splat(1.0);
            let mut angle = beam.angle.iter().rev().fold(Lane::ZERO, |sum, c| sum * v + *c) + beam.ends[0];
            angle += v * (beam.ends[1] - beam.ends[0]);
            let (mut before, mut here) = (Lane::splat(1.0), x);
            for (k, (shape, amplitude)) in modes.iter_mut().zip(&beam.modes).enumerate() {
                let n = (k + 1) as f64;
                let next = (x * here * (2.0 * n + 1.0) - before * n) * INVERSES[k];
                *shape = (next - before) * (0.5 / ROOTS[k]);
                angle += *shape * *amplitude;
                (before, here) = (here, next);
            }
            let (sin, cos) = angle.sin_cos_reduced();
            self.line.push(LinePoint { v, weight: *weight * (beam.length_m * u), cos, sin, modes });
        }
    }

    /// `factor` times the position along `axis` in m, of the place that [`Seed::prepare_line`] was called for; see
    /// [`crate::BeamState::shape_m`].
    pub(super) fn add_position(&mut self, beam: &BeamAt, axis: [f64; 2]) {
        let (modes, constants) = (beam.modes.len(), beam.constants());
        let ([h, v], [soft_axial, soft_shear]) = (beam.force, beam.soft);
        let (mut ends, mut force, mut by) = ([Lane::ZERO; 2], [Lane::ZERO; 2], [Lane::ZERO; 3]);
        let mut by_mode = [Lane::ZERO; MODES];
        let angles = &mut self.values[constants + ANGLES..];
        for p in &self.line {
            let (t, n) = (p.cos * axis[0] + p.sin * axis[1], p.cos * axis[1] - p.sin * axis[0]);
            let (axial, across) = (p.cos * h + p.sin * v, p.cos * v - p.sin * h);
            let (stretch, slide) = (p.weight * axial * t * soft_axial, p.weight * across * n * soft_shear);
            by[0] += p.weight * t + stretch + slide;
            by[1] += stretch;
            by[2] += slide;
            let by_angle = p.weight * (n + (across * t + axial * n) * (soft_axial - soft_shear));
            ends[0] += by_angle;
            ends[1] += by_angle * p.v;
            for (target, shape) in by_mode[..modes].iter_mut().zip(&p.modes) {
                *target += by_angle * *shape;
            }
            let mut power = by_angle;
            for target in angles.iter_mut() {
                *target += sum_of(power);
                power = power * p.v;
            }
            let (along, sideways) = (p.weight * t * soft_axial, p.weight * n * soft_shear);
            force[0] += along * p.cos - sideways * p.sin;
            force[1] += along * p.sin + sideways * p.cos;
        }
        for (place, value) in [LENGTH, AXIAL, SHEAR].into_iter().zip(by) {
            self.values[constants + place] += sum_of(value);
        }
        let turned = sum_of(ends[1]);
        self.values[ENDS] += sum_of(ends[0]) - turned;
        self.values[ENDS + 1] += turned;
        for i in 0..2 {
            self.values[FORCE + i] += sum_of(force[i]);
            self.values[START + i] += axis[i];
        }
        for (target, value) in self.values[FIRST_MODE..FIRST_MODE + modes].iter_mut().zip(by_mode) {
            *target += sum_of(value);
        }
    }

    /// Position in m and its derivative by u at even places from the start to the end of a beam: three Gauss points between each two.
    pub(super) fn line_m(beam: &BeamAt, places: usize, out: &mut Vec<[[f64; 2]; 2]>) {
        const AWAY: f64 = 0.387_298_334_620_741_7;
        const WEIGHTS: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];
        out.clear();
        let step = 1.0 / places as f64;
        let mut at = beam.start_m;
        for place in 0..places {
            let from = place as f64 * step;
            // The beginning and the three points.
            let tangents = beam.tangents_m(Lane([from, from + (0.5 - AWAY) * step, from + 0.5 * step, from + (0.5 + AWAY) * step]));
            out.push([at, tangents.map(|t| t.0[0])]);
            for (at, tangent) in at.iter_mut().zip(tangents) {
                *at += step * WEIGHTS.iter().zip(&tangent.0[1..]).map(|(w, t)| w * t).sum::<f64>();
            }
        }
        out.push([at, beam.tangents_m(Lane::splat(1.0)).map(|t| t.0[0])]);
    }

    /// Position in m of the place that [`Seed::prepare_line`] was called for.
    pub(super) fn position_m(&self, beam: &BeamAt) -> [f64; 2] {
        let ([h, v], [soft_axial, soft_shear]) = (beam.force, beam.soft);
        let mut sums = [Lane::ZERO; 2];
        for p in &self.line {
            let stretch = (p.cos * h + p.sin * v) * soft_axial + 1.0;
            let slide = (p.cos * v - p.sin * h) * soft_shear;
            sums[0] += p.weight * (stretch * p.cos - slide * p.sin);
            sums[1] += p.weight * (stretch * p.sin + slide * p.cos);
        }
        [beam.start_m[0] + sum_of(sums[0]), beam.start_m[1] + sum_of(sums[1])]
    }
}

/// The angle θ and the slope φ' of the rotation at a place, each with two derivatives by u.
struct Local {
    angle: [f64; 3],
    slope: [f64; 3],
}

impl BeamAt {
    /// Number of coordinates.
    pub(super) fn width(&self) -> usize {
        self.constants() + ANGLES + self.angle.len()
    }

    /// Place of the first constant among the coordinates.
    pub(super) fn constants(&self) -> usize {
        FIRST_MODE + self.modes.len()
    }

    /// Derivatives of an output by the columns from those by the coordinates.
    pub(super) fn add_columns(&self, seed: &Seed, out: &mut [f64]) {
        for (target, row) in out.iter_mut().zip(self.rows.chunks_exact(self.width())) {
            // Four sums side by side.
            let (fours, rest) = row.as_chunks::<LANES>();
            let (seed_fours, seed_rest) = seed.values.as_chunks::<LANES>();
            let product = |(a, b): (&[f64; LANES], &[f64; LANES])| Lane(*a) * Lane(*b);
            let sum = fours.iter().zip(seed_fours).map(product).fold(Lane::ZERO, |sum, product| sum + product);
            *target += sum_of(sum) + rest.iter().zip(seed_rest).map(|(a, b)| a * b).sum::<f64>();
        }
    }

    /// Derivative of the position by u at four places, m.
    fn tangents_m(&self, u: Lane) -> [Lane; 2] {
        let x = u * 2.0 - Lane::splat(1.0);
        let mut angle = self.angle.iter().rev().fold(Lane::ZERO, |sum, c| sum * u + *c) + self.ends[0];
        angle += u * (self.ends[1] - self.ends[0]);
        let (mut before, mut here) = (Lane::splat(1.0), x);
        for (k, amplitude) in self.modes.iter().enumerate() {
            let n = (k + 1) as f64;
            let next = (x * here * (2.0 * n + 1.0) - before * n) * INVERSES[k];
            angle += (next - before) * (0.5 / ROOTS[k] * amplitude);
            (before, here) = (here, next);
        }
        let (sin, cos) = angle.sin_cos_reduced();
        let ([h, v], [soft_axial, soft_shear]) = (self.force, self.soft);
        let stretch = ((cos * h + sin * v) * soft_axial + 1.0) * self.length_m;
        let slide = (cos * v - sin * h) * soft_shear * self.length_m;
        [stretch * cos - slide * sin, stretch * sin + slide * cos]
    }

    fn local(&self, u: f64) -> Local {
        let x = 2.0 * u - 1.0;
        let turn = self.ends[1] - self.ends[0];
        let (mut phi, mut slope) = (self.ends[0] + turn * u, [turn, 0.0, 0.0]);
        // Legendre polynomials of degree n − 1 and n with two derivatives by x.
        let (mut before, mut here) = ([1.0, 0.0, 0.0], [x, 1.0, 0.0]);
        for (k, a) in self.modes.iter().enumerate() {
            let n = (k + 1) as f64;
            let odd = 2.0 * n + 1.0;
            let next = [(odd * x * here[0] - n * before[0]) * INVERSES[k], before[1] + odd * here[0], before[2] + odd * here[1]];
            let scaled = a * ROOTS[k];
            slope = [slope[0] + scaled * here[0], slope[1] + 2.0 * scaled * here[1], slope[2] + 4.0 * scaled * here[2]];
            phi += scaled * (next[0] - before[0]) * (0.5 / odd);
            (before, here) = (here, next);
        }
        let (mut eta, mut eta_1, mut eta_2) = (0.0, 0.0, 0.0);
        for c in self.angle.iter().rev() {
            eta_2 = eta_2 * u + 2.0 * eta_1;
            eta_1 = eta_1 * u + eta;
            eta = eta * u + c;
        }
        Local { angle: [eta + phi, eta_1 + slope[0], eta_2 + slope[1]], slope }
    }

    /// Stress on a face with two derivatives by u, Pa.
    pub(super) fn stress_pa(&self, u: f64, face: Face) -> [f64; 3] {
        let [bending, axial] = self.stresses_pa(u);
        let side = if face == Face::Left { -1.0 } else { 1.0 };
        [0, 1, 2].map(|i| axial[i] + side * bending[i])
    }

    /// Bending stress of the right face and axial stress with two derivatives by u, Pa.
    fn stresses_pa(&self, u: f64) -> [[f64; 3]; 2] {
        let local = self.local(u);
        let bending = local.slope.map(|s| self.stress[0] * s);
        if self.stress[1] <= 0.0 {
            return [bending, [0.0; 3]];
        }
        let (sin, cos) = maths::sin_cos(local.angle[0]);
        let [h, v] = self.force;
        let (axial, across) = (h * cos + v * sin, v * cos - h * sin);
        let [_, turn, bend] = local.angle;
        let axial = [axial, across * turn, across * bend - axial * turn * turn];
        [bending, axial.map(|a| self.stress[1] * a)]
    }

    /// Bending and axial stress at four places, Pa.
    fn four_stresses(&self, u: Lane) -> [Lane; 2] {
        let x = u * 2.0 - Lane::splat(1.0);
        let turn = self.ends[1] - self.ends[0];
        let mut phi = u * turn + self.ends[0];
        let mut slope = Lane::splat(turn);
        let (mut before, mut here) = (Lane::splat(1.0), x);
        for (k, a) in self.modes.iter().enumerate() {
            let n = (k + 1) as f64;
            let next = (x * here * (2.0 * n + 1.0) - before * n) * INVERSES[k];
            slope += here * (a * ROOTS[k]);
            phi += (next - before) * (a * 0.5 / ROOTS[k]);
            (before, here) = (here, next);
        }
        if self.stress[1] > 0.0 {
            let angle = self.angle.iter().rev().fold(Lane::ZERO, |sum, c| sum * u + *c) + phi;
            let (sin, cos) = angle.sin_cos_reduced();
            return [slope * self.stress[0], (cos * self.force[0] + sin * self.force[1]) * self.stress[1]];
        }
        [slope * self.stress[0], Lane::ZERO]
    }

    /// The largest stress of a face.
    pub(super) fn peak_of_face(&self, samples: &[f64], face: Face) -> PeakStress {
        let mut values = [0.0; 2 * MODES];
        let count = samples.len().min(values.len());
        for (four, target) in samples[..count].chunks_exact(LANES).zip(values.chunks_exact_mut(LANES)) {
            let [bending, axial] = self.four_stresses(Lane([four[0], four[1], four[2], four[3]]));
            let stress = if face == Face::Left { axial - bending } else { axial + bending };
            target.copy_from_slice(&stress.abs().0);
        }
        let values = &values[..count];
        let largest = values.iter().fold(0.0_f64, |m, v| m.max(*v));
        let mut best = [0.0_f64; 2];
        for (i, value) in values.iter().enumerate() {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(count - 1));
            if *value < CLOSE * largest || *value < values[before] || *value < values[after] {
                continue;
            }
            let found = self.maximum(samples[i], [samples[before], samples[after]], face);
            if found[1].abs() > best[1].abs() {
                best = found;
            }
        }
        PeakStress { stress_pa: best[1].abs(), u: best[0], face, tension: best[1] > 0.0 }
    }

    /// The largest stress magnitude of both faces, named as [`crate::BeamState::peak_stress`] does.
    pub(super) fn peak(&self, samples: &[f64]) -> PeakStress {
        let mut best = self.peak_of_face(samples, Face::Left);
        if self.stress[1] > 0.0 {
            let right = self.peak_of_face(samples, Face::Right);
            if right.stress_pa > best.stress_pa {
                best = right;
            }
        }
        // Where both are stressed alike, that in tension is named.
        let [[bending, ..], [axial, ..]] = self.stresses_pa(best.u);
        let (left, right) = (axial - bending, axial + bending);
        let face = if left.abs() > right.abs() || (left.abs() >= right.abs() && left > 0.0) { Face::Left } else { Face::Right };
        PeakStress { face, tension: if face == Face::Left { left > 0.0 } else { right > 0.0 }, ..best }
    }

    /// The place of the largest stress magnitude of a face next to a sample, by Newton's method between its neighbours, or an end; and
    /// the stress there.
    fn maximum(&self, start: f64, [mut low, mut high]: [f64; 2], face: Face) -> [f64; 2] {
        let mut at = start;
        for _ in 0..MOST_ITERATIONS {
            let [stress, slope, bend] = self.stress_pa(at, face);
            let (rise, bend) = (slope * 1.0_f64.copysign(stress), bend * 1.0_f64.copysign(stress));
            // At an end the stress falls inwards.
            if (at <= 0.0 && rise <= 0.0) || (at >= 1.0 && rise >= 0.0) {
                return [at, stress];
            }
            if rise > 0.0 {
                low = at;
            } else {
                high = at;
            }
            let newton = at - rise / bend;
            let next = if bend < 0.0 && newton > low && newton < high { newton } else { 0.5 * (low + high) };
            let step = next - at;
            at = next;
            if step.abs() <= LAST_STEP {
                // The parabola is exact for so short a step.
                return [at, stress + 0.5 * slope * step];
            }
        }
        [at, self.stress_pa(at, face)[0]]
    }
}
