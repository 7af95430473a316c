//! The largest stress of a network in a given state.
//!
//! Bending stress is a polynomial along each beam. The states of the walk are surveyed at Chebyshev points, all beams at once: that tells
//! between which points a maximum can be. Between the states, the stress at the ends is interpolated for all beams; a beam's whole
//! state only where a maximum inside it may be the largest.

#![allow(clippy::needless_range_loop, reason = "sums over modes are read by their indices")]

use forcewright_base::maths;

use super::hermite::Hermite;
use super::kernel::Unknowns;
use super::lanes::{LANES, Lane};
use super::walk::Node;
use crate::element::root_of;
use crate::model::Model;

/// The maximum inside a beam is looked for at a station if those of the states around it are, interpolated, at least this part of the largest stress.
const CLOSE: f64 = 0.9;
/// Beams below this part of the largest stress are not looked at closely.
const FAR: f64 = 0.5;
/// Newton iterations for the place of a maximum.
const MOST_ITERATIONS: usize = 6;

/// A Newton step to a maximum, as part of the beam, after which one more is enough.
const NEARLY_THERE: f64 = 0.05;

/// Slopes of the modes at Chebyshev points, and what else does not depend on the network.
#[derive(Debug)]
pub(crate) struct Sampling<const M: usize, const E: usize> {
    slope: Vec<Row<M, E>>,
    /// Where those points are, and the places half way in angle between them.
    place: Vec<f64>,
    /// Second derivatives at both ends.
    bend: [Row<M, E>; 2],
    samples: Vec<Lane>,
}

/// Factors of all modes.
type Row<const M: usize, const E: usize> = ([Lane; M], [Lane; E]);

/// Four beams at one state: their unknowns, the modes beyond those solved for, and the derivative of both by the control.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group<const M: usize, const E: usize> {
    pub(crate) at: Unknowns<M>,
    pub(crate) by: Unknowns<M>,
    pub(crate) beyond: [Lane; E],
    pub(crate) beyond_by: [Lane; E],
    pub(crate) survey: Survey,
}

impl<const M: usize, const E: usize> Default for Group<M, E> {
    fn default() -> Self {
        let (at, beyond) = (Unknowns::default(), [Lane::ZERO; E]);
        Self { at, by: at, beyond, beyond_by: beyond, survey: Survey::default() }
    }
}

/// What is known about the stress of four beams at one state.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Survey {
    /// dφ/du at the start, in the middle and at the end, and its derivative by the control.
    pub(crate) slope: [Lane; 3],
    pub(crate) slope_by: [Lane; 3],
    /// What maxima inside cannot exceed by much, Pa.
    inside: Lane,
    /// Samples with a maximum next to them, as bits.
    places: [u64; LANES],
}

/// What turns slopes and forces of four beams into stress.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StressModel {
    /// Pa per rad of slope.
    pub(crate) bending: Lane,
    /// Pa per unit of force.
    pub(crate) axial: Lane,
    /// Direction at rest at both ends, and its slope by u.
    cos: [Lane; 2],
    sin: [Lane; 2],
    pub(crate) turn: [Lane; 2],
    pub(crate) soft: bool,
}

impl StressModel {
    /// One beam of four designs with these factors. Without an axial one the angle, of which `direction` is added to that of the
    /// coefficients as cosine and sine, does not matter.
    pub(crate) fn in_lanes(bending: Lane, axial: Lane, angle_rad: &[Lane], direction: [Lane; 2]) -> Self {
        let mut own = Self { bending, axial, soft: !angle_rad.is_empty(), ..Self::default() };
        if own.soft {
            let start = angle_rad[0];
            let end = angle_rad.iter().rev().fold(Lane::ZERO, |sum, c| sum + *c);
            own.turn[0] = angle_rad.get(1).copied().unwrap_or_default();
            own.turn[1] = angle_rad.iter().enumerate().skip(1).fold(Lane::ZERO, |sum, (k, c)| sum + *c * k as f64);
            for (i, angle) in [start, end].into_iter().enumerate() {
                let (sin, cos) = angle.sin_cos_turned();
                (own.cos[i], own.sin[i]) = (direction[0] * cos - direction[1] * sin, direction[1] * cos + direction[0] * sin);
            }
        }
        own
    }

    /// Force along the beam at an end, and its derivative, given rotation and force with theirs.
    #[inline]
    pub(crate) fn axial_force(&self, end: usize, (phi, d_phi): (Lane, Lane), ([h, v], [dh, dv]): ([Lane; 2], [Lane; 2])) -> (Lane, Lane) {
        let (sin_phi, cos_phi) = phi.sin_cos_moderate();
        let cos = self.cos[end] * cos_phi - self.sin[end] * sin_phi;
        let sin = self.sin[end] * cos_phi + self.cos[end] * sin_phi;
        (h * cos + v * sin, dh * cos + dv * sin + (v * cos - h * sin) * d_phi)
    }

    /// For all groups of beams.
    pub(crate) fn prepare(model: &Model, out: &mut Vec<Self>) {
        out.clear();
        for group in model.beams.chunks(LANES) {
            let mut own = Self::default();
            let mut angle = [Lane::ZERO; 2];
            for (lane, beam) in group.iter().enumerate() {
                let section = &beam.info.section;
                let shape = &beam.info.shape;
                own.bending.0[lane] = 0.5 * section.young_pa * section.thickness_m / shape.length_m();
                if beam.constants.axial > 0.0 {
                    own.axial.0[lane] = model.force_n / section.area_m2();
                    own.soft = true;
                    for (end, u) in [0.0, 1.0].into_iter().enumerate() {
                        angle[end].0[lane] = shape.angle_at(u);
                        own.turn[end].0[lane] = shape.slope_at(u);
                    }
                }
            }
            if own.soft {
                for end in 0..2 {
                    (own.sin[end], own.cos[end]) = angle[end].sin_cos_reduced();
                }
            }
            out.push(own);
        }
    }

    /// Largest stress at both ends, from the slope there, the end rotations and the force.
    #[inline]
    fn ends(&self, slope: [Lane; 2], ends: [Lane; 2], [h, v]: [Lane; 2]) -> Lane {
        let mut stress = [slope[0].abs() * self.bending, slope[1].abs() * self.bending];
        if self.soft {
            for end in 0..2 {
                let (sin, cos) = ends[end].sin_cos();
                let (rest_cos, rest_sin) = (self.cos[end], self.sin[end]);
                let along = h * (rest_cos * cos - rest_sin * sin) + v * (rest_sin * cos + rest_cos * sin);
                stress[end] += along.abs() * self.axial;
            }
        }
        stress[0].max(stress[1])
    }
}

/// A maximum of the stress inside a beam, with derivatives along a change of the beam.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Maximum {
    pub(crate) stress: f64,
    pub(crate) by: f64,
    pub(crate) place: f64,
    /// From bending alone.
    pub(crate) place_by: f64,
    /// The part of the second derivative of the stress that is due to the motion of its place.
    pub(crate) drift: f64,
}

/// One beam between two states.
pub(crate) struct OneBeam<'a, const M: usize, const E: usize> {
    pub(crate) ends: [f64; 2],
    pub(crate) force: [f64; 2],
    pub(crate) bubbles: [f64; M],
    pub(crate) beyond: [f64; E],
    /// Pa per rad of slope, Pa per unit of force.
    pub(crate) factors: [f64; 2],
    /// Coefficients of the angle at rest; not used where the second factor is 0.
    pub(crate) angle_rad: &'a [f64],
}

impl<'a, const M: usize, const E: usize> OneBeam<'a, M, E> {
    /// Beam `lane` of a group.
    fn new(nodes: &[Node<M, E>], hermite: &Hermite, (group, lane): (usize, usize), factors: [f64; 2], angle_rad: &'a [f64]) -> Self {
        let mut beam = Self { ends: [0.0; 2], force: [0.0; 2], bubbles: [0.0; M], beyond: [0.0; E], factors, angle_rad };
        for (i, [a, b]) in hermite.weights() {
            let from = &nodes[i].groups[group];
            for i in 0..2 {
                beam.ends[i] += a * from.at.ends[i].0[lane] + b * from.by.ends[i].0[lane];
                beam.force[i] += a * from.at.force[i].0[lane] + b * from.by.force[i].0[lane];
            }
            for k in 0..M {
                beam.bubbles[k] += a * from.at.bubbles[k].0[lane] + b * from.by.bubbles[k].0[lane];
            }
            for k in 0..E {
                beam.beyond[k] += a * from.beyond[k].0[lane] + b * from.beyond_by[k].0[lane];
            }
        }
        beam
    }

    /// Rotation at a place, and its slope with two derivatives by 2u − 1.
    #[inline]
    fn field(&self, u: f64) -> [f64; 4] {
        let x = 2.0 * u - 1.0;
        let turn = self.ends[1] - self.ends[0];
        let (mut phi, mut slope, mut first, mut second) = (self.ends[0] + turn * u, turn, 0.0, 0.0);
        // Legendre polynomials of degree n − 1 and n with two derivatives by x.
        let (mut before, mut here) = ([1.0, 0.0, 0.0], [x, 1.0, 0.0]);
        for k in 0..M + E {
            let (n, root) = ((k + 1) as f64, ROOTS[k]);
            let odd = 2.0 * n + 1.0;
            let next = [(odd * x * here[0] - n * before[0]) * INVERSES[k], before[1] + odd * here[0], before[2] + odd * here[1]];
            let amplitude = if k < M { self.bubbles[k] } else { self.beyond[k - M] };
            let scaled = amplitude * root;
            slope += scaled * here[0];
            first += scaled * here[1];
            second += scaled * here[2];
            phi += scaled * (next[0] - before[0]) * HALVES[k];
            (before, here) = (here, next);
        }
        [phi, slope, first, second]
    }

    /// Largest stress of both faces at a place, its slope and, from bending alone, its second derivative.
    pub(crate) fn stress(&self, u: f64) -> [f64; 3] {
        let [stress, slope, bend, _] = self.stress_with_side(u);
        [stress, slope, bend]
    }

    /// The same with the slope of the rotation, the sign of which tells the face.
    pub(crate) fn stress_with_side(&self, u: f64) -> [f64; 4] {
        let [phi, slope, first, second] = self.field(u);
        let sign = self.factors[0].copysign(slope);
        let mut out = [sign * slope, 2.0 * sign * first, 4.0 * sign * second, slope];
        if self.factors[1] > 0.0 {
            let (along, across) = self.internal_force(u, phi);
            let factor = self.factors[1].copysign(along);
            out[0] += factor * along;
            out[1] += factor * across * (slope_at(self.angle_rad, u) + slope);
        }
        out
    }

    /// Force along and across the beam at a place with that rotation.
    fn internal_force(&self, u: f64, phi: f64) -> (f64, f64) {
        let (sin, cos) = maths::sin_cos(angle_at(self.angle_rad, u) + phi);
        (self.force[0] * cos + self.force[1] * sin, self.force[1] * cos - self.force[0] * sin)
    }

    /// Place and height of the maximum next to a place between two others, good to start from, with the slope of the rotation there.
    pub(crate) fn summit(&self, start: f64, between: (f64, f64)) -> (f64, f64, f64) {
        let (mut at, mut last) = (start, (start, 0.0, 0.0));
        for _ in 0..MOST_ITERATIONS {
            let [stress, slope, bend, side] = self.stress_with_side(at);
            let next = uphill(at, [slope, bend], between);
            last = (next, stress + 0.5 * slope * (next - at), side);
            if bend < 0.0 && (next - at).abs() < NEARLY_THERE {
                break;
            }
            at = next;
        }
        last
    }

    /// The maximum very near a place, and how it changes along a change of the beam.
    pub(crate) fn maximum_by(&self, by: &Self, u: f64) -> Maximum {
        let ([phi, slope, first, second], [d_phi, d_slope, d_first, _]) = (self.field(u), by.field(u));
        let sign = self.factors[0].copysign(slope);
        let (mut stress, mut change, mut rise) = (sign * slope, sign * d_slope, 2.0 * sign * first);
        if self.factors[1] > 0.0 {
            let (along, across) = self.internal_force(u, phi);
            let (d_along, _) = by.internal_force(u, phi);
            let factor = self.factors[1].copysign(along);
            stress += factor * along;
            rise += factor * across * (slope_at(self.angle_rad, u) + slope);
            change += factor * (d_along + across * d_phi);
        }
        let (bend, twist) = (4.0 * sign * second, 2.0 * sign * d_first);
        let step = if bend < 0.0 { (u - rise / bend).clamp(0.0, 1.0) - u } else { 0.0 };
        // A flat maximum moves at no finite rate.
        let place_by = -twist / bend;
        Maximum { stress: stress + 0.5 * rise * step, by: change + twist * step, place: u + step, place_by, drift: twist * place_by }
    }

    /// The maximum next to a place, by Newton's method between two others; or less, if that is below `floor`.
    pub(crate) fn maximum(&self, start: f64, (low, high): (f64, f64), tolerance: f64, floor: f64) -> f64 {
        let (mut at, mut best) = (start, 0.0_f64);
        for _ in 0..MOST_ITERATIONS {
            let [stress, slope, bend] = self.stress(at);
            best = best.max(stress);
            let next = uphill(at, [slope, bend], (low, high));
            let gain = 0.5 * slope * (next - at);
            // The parabola's gain is wrong by a small part of itself.
            if bend < 0.0 && (gain.abs() <= tolerance * best || stress + 4.0 * gain.abs() < floor) {
                return best.max(stress + gain);
            }
            at = next;
        }
        best
    }
}

/// A Newton step to a maximum between two places; where the curve is not that of a maximum, towards the higher side.
fn uphill(at: f64, [slope, bend]: [f64; 2], (low, high): (f64, f64)) -> f64 {
    let newton = if bend < 0.0 { at - slope / bend } else { at + (0.2 * (high - low)).copysign(slope) };
    newton.clamp(low, high)
}

fn angle_at(angle_rad: &[f64], u: f64) -> f64 {
    angle_rad.iter().rev().fold(0.0, |sum, c| sum * u + c)
}

fn slope_at(angle_rad: &[f64], u: f64) -> f64 {
    angle_rad.iter().enumerate().skip(1).rev().fold(0.0, |sum, (k, c)| sum * u + k as f64 * c)
}

/// Most modes of any resolution.
pub(super) const MODES: usize = 24;
/// √(2k − 1) and 1/k of degree k = 2, 3, …
pub(super) const ROOTS: [f64; MODES] = tables().0;
pub(super) const INVERSES: [f64; MODES] = tables().1;
/// Half of 1/(2k − 1).
const HALVES: [f64; MODES] = tables().2;

/// Newton's method for the roots: there is no square root at compile time.
const fn tables() -> ([f64; MODES], [f64; MODES], [f64; MODES]) {
    let (mut roots, mut inverses, mut halves) = ([0.0; MODES], [0.0; MODES], [0.0; MODES]);
    let mut k = 0;
    while k < MODES {
        let degree = (k + 2) as f64;
        let square = 2.0 * degree - 1.0;
        let mut root = degree;
        let mut i = 0;
        while i < 12 {
            root = 0.5 * (root + square / root);
            i += 1;
        }
        roots[k] = root;
        inverses[k] = 1.0 / degree;
        halves[k] = 0.5 / square;
        k += 1;
    }
    (roots, inverses, halves)
}

impl<const M: usize, const E: usize> Sampling<M, E> {
    pub(crate) fn new() -> Self {
        const { assert!(M + E <= MODES) };
        // Even, so that one is in the middle.
        let intervals = 2 * (M + E).div_ceil(2) + 2;
        let place = |i: usize| 0.5 - 0.5 * maths::cos(std::f64::consts::PI * i as f64 / intervals as f64);
        let row = |factor: &dyn Fn(usize) -> f64| {
            (std::array::from_fn(|k| Lane::splat(factor(k + 2))), std::array::from_fn(|k| Lane::splat(factor(M + k + 2))))
        };
        let slope = |i: usize| {
            let mut p = [0.0; MODES + 2];
            forcewright_base::quadrature::legendre_values(2.0 * place(i) - 1.0, &mut p);
            row(&|k| root_of(k) * p[k - 1])
        };
        // P_n' is n (n + 1)/2 at 1, with alternating sign at −1.
        let bend = |end: f64| row(&|k| root_of(k) * (k * (k - 1)) as f64 * if k % 2 == 0 { 1.0 } else { end });
        let halves = (0..=2 * intervals).map(|i| 0.5 - 0.5 * maths::cos(std::f64::consts::PI * i as f64 / (2 * intervals) as f64));
        Self { slope: (0..=intervals).map(slope).collect(), place: halves.collect(), bend: [bend(-1.0), bend(1.0)], samples: Vec::new() }
    }

    /// Fills in what is known about stress at a state.
    pub(crate) fn survey(&mut self, stress: &StressModel, group: &mut Group<M, E>) {
        let turn = group.at.ends[1] - group.at.ends[0];
        self.samples.clear();
        for row in &self.slope {
            self.samples.push(turn + dot(row, &group.at.bubbles, &group.beyond));
        }
        let last = self.samples.len() - 1;
        let survey = &mut group.survey;
        survey.slope = [self.samples[0], self.samples[last / 2], self.samples[last]];
        survey.slope_by = Self::slopes(&self.slope, &group.by, &group.beyond_by);
        let force = group.at.force[0].abs() + group.at.force[1].abs();
        // Whether the stress may rise from the ends inwards; the axial part by a bound.
        let mut rises = [Lane::ZERO; 2];
        for end in 0..2 {
            let slope = survey.slope[2 * end];
            let bend = dot(&self.bend[end], &group.at.bubbles, &group.beyond) * stress.bending;
            let axial = stress.axial * force * (stress.turn[end].abs() + slope.abs());
            let inwards = if end == 0 { bend } else { -bend };
            for lane in 0..LANES {
                rises[end].0[lane] = inwards.0[lane] * 1.0_f64.copysign(slope.0[lane]) + axial.0[lane];
            }
        }
        for sample in &mut self.samples {
            *sample = sample.abs();
        }
        let highest = self.samples.iter().fold(Lane::ZERO, |m, s| m.max(*s)) * stress.bending + stress.axial * force;
        let largest = highest.0.iter().fold(0.0_f64, |m, v| m.max(*v));
        for lane in 0..LANES {
            (survey.places[lane], survey.inside.0[lane]) = (0, highest.0[lane]);
            if highest.0[lane] < FAR * largest {
                continue;
            }
            let (mut inside, mut bits) = (0.0_f64, 0_u64);
            let at = |i: usize| self.samples[i].0[lane];
            let (mut left, mut here) = (at(1), at(0));
            for i in 0..=last {
                let right = at(if i == last { last - 1 } else { i + 1 });
                if here >= left && here >= right {
                    let end = usize::from(i == last);
                    if (i > 0 && i < last) || rises[end].0[lane] > 0.0 {
                        inside = inside.max(if i > 0 && i < last { vertex(left, here, right) } else { 1.05 * here });
                        bits |= 1 << i;
                    }
                }
                (left, here) = (here, right);
            }
            survey.places[lane] = bits;
            // Where there is none, one may begin at an end on the way to the next state.
            let bound = inside * stress.bending.0[lane] + stress.axial.0[lane] * force.0[lane];
            survey.inside.0[lane] = bound.max(highest.0[lane]);
        }
    }

    /// dφ/du at the start, in the middle and at the end.
    pub(crate) fn probe(&self, at: &Unknowns<M>, beyond: &[Lane; E]) -> [Lane; 3] {
        Self::slopes(&self.slope, at, beyond)
    }

    fn slopes(rows: &[Row<M, E>], at: &Unknowns<M>, beyond: &[Lane; E]) -> [Lane; 3] {
        let (turn, last) = (at.ends[1] - at.ends[0], rows.len() - 1);
        let at = |i: usize| turn + dot(&rows[i], &at.bubbles, beyond);
        [at(0), at(last / 2), at(last)]
    }

    /// The beam with the largest stress between states, and that stress, Pa. `hermite` interpolates between the states, of which those
    /// next to the place are `around`, and the place is this part of the way `between` them.
    pub(crate) fn peak(
        &self,
        model: &Model,
        stress: &[StressModel],
        nodes: &[Node<M, E>],
        (around, between): ([usize; 2], f64),
        hermite: &Hermite,
        tolerance: f64,
    ) -> (usize, f64) {
        let mut best = (0, 0.0);
        for (g, own) in stress.iter().enumerate() {
            let (mut slope, mut ends, mut force) = ([Lane::ZERO; 2], [Lane::ZERO; 2], [Lane::ZERO; 2]);
            for (i, [a, b]) in hermite.weights() {
                let from = &nodes[i].groups[g];
                for end in 0..2 {
                    slope[end] += from.survey.slope[2 * end] * a + from.survey.slope_by[2 * end] * b;
                }
                if own.soft {
                    for i in 0..2 {
                        ends[i] += from.at.ends[i] * a + from.by.ends[i] * b;
                        force[i] += from.at.force[i] * a + from.by.force[i] * b;
                    }
                }
            }
            let stress = own.ends(slope, ends, force).0;
            for lane in 0..LANES {
                if stress[lane] > best.1 {
                    best = (g * LANES + lane, stress[lane]);
                }
            }
        }
        for (beam, b) in model.beams.iter().enumerate() {
            let (g, lane) = (beam / LANES, beam % LANES);
            let (left, right) = (&nodes[around[0]].groups[g].survey, &nodes[around[1]].groups[g].survey);
            let bound = left.inside.0[lane] + between * (right.inside.0[lane] - left.inside.0[lane]);
            if bound < CLOSE * best.1 {
                continue;
            }
            let places = left.places[lane] | right.places[lane];
            if places == 0 {
                continue;
            }
            let factors = [stress[g].bending.0[lane], stress[g].axial.0[lane]];
            let one = OneBeam::new(nodes, hermite, (g, lane), factors, b.info.shape.angle_rad());
            let value = self.inside(places, &one, tolerance, best.1);
            if value > best.1 {
                best = (beam, value);
            }
        }
        best
    }

    /// The largest stress next to the samples of a beam.
    fn inside(&self, places: u64, beam: &OneBeam<M, E>, tolerance: f64, floor: f64) -> f64 {
        let last = 2 * (self.slope.len() - 1);
        let (mut rest, mut best) = (places, 0.0_f64);
        while rest != 0 {
            let first = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let mut start = 2 * first;
            if rest & (2 << first) != 0 {
                // Between two samples that were largest before and after.
                start += 1;
                rest &= rest - 1;
            } else if start == 0 {
                start = 1;
            } else if start == last {
                start -= 1;
            }
            let (low, high) = (self.place[start.saturating_sub(4)], self.place[(start + 4).min(last)]);
            best = best.max(beam.maximum(self.place[start], (low, high), tolerance, floor.max(best)));
        }
        best
    }
}

/// Sum over all modes.
#[inline]
fn dot<const M: usize, const E: usize>(row: &Row<M, E>, bubbles: &[Lane; M], beyond: &[Lane; E]) -> Lane {
    let mut sum = Lane::ZERO;
    for k in 0..M {
        sum += bubbles[k] * row.0[k];
    }
    for k in 0..E {
        sum += beyond[k] * row.1[k];
    }
    sum
}

/// Height of the parabola through three equally spaced values around the largest of them.
fn vertex(left: f64, middle: f64, right: f64) -> f64 {
    let bend = left - 2.0 * middle + right;
    if bend < 0.0 { middle - 0.125 * (left - right) * (left - right) / bend } else { middle }
}
