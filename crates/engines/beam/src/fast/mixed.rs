//! How four beams answer to changes of their constants.
//!
//! The equilibrium ∂ℒ/∂x = 0 moves with a constant p of a beam by `H dx/dp = −∂²ℒ/∂x∂p`. The right-hand side is formed here for each
//! constant of four beams at once and condensed to their ends like a residual; what a parameter of the design changes is a sum of
//! constants of some beams. The notation is that of `gradient/field.rs`.

#![allow(clippy::needless_range_loop, reason = "formulas of small matrices are read by their indices")]

use super::kernel::{Beams, Condensed, Tables, Unknowns};
use super::lanes::Lane;

/// Places of the constants of a beam: the logarithms of its length (with the next three held), EI/L, 1/EA and 1/kGA, then `c_0`, `c_1`, …
pub(super) const LENGTH: usize = 0;
pub(super) const BENDING: usize = 1;
pub(super) const AXIAL: usize = 2;
pub(super) const SHEAR: usize = 3;
pub(super) const ANGLES: usize = 4;

/// Directions and forces of four beams at the quadrature points of a state. Loads and their derivatives carry the weights and −L.
#[derive(Clone, Debug)]
pub(super) struct Field<const Q: usize> {
    /// Direction of the deformed beam.
    cos: [Lane; Q],
    sin: [Lane; Q],
    /// Axial and shear force.
    axial: [Lane; Q],
    across: [Lane; Q],
    /// Moment load, and its derivatives by the rotation, H and V.
    pub(super) load: [Lane; Q],
    slope: [Lane; Q],
    by_h: [Lane; Q],
    by_v: [Lane; Q],
}

/// The second derivative of the Lagrangian along a change of the state, differentiated by the state and by the constants.
#[derive(Clone, Debug)]
pub(super) struct Curvature<const M: usize> {
    by_state: Unknowns<M>,
    by_constants: Vec<Lane>,
}

/// How four beams answer to a residual with their ends held.
#[derive(Clone, Copy, Debug)]
pub(super) struct Answer<const M: usize> {
    /// D⁻¹L⁻¹ of the bubbles' part, as in [`Condensed`].
    scaled: [Lane; M],
    /// C⁻¹ of the gap.
    closing: [Lane; 2],
    /// What remains of the residual at the ends: by (`φ_A`, `φ_B`, x, y).
    pub(super) first: [Lane; 4],
}

impl<const Q: usize> Field<Q> {
    pub(super) fn new<const M: usize, const E: usize>(tables: &Tables<M, Q, E>, beams: &Beams<Q>, at: &Unknowns<M>) -> Self {
        let zero = [Lane::ZERO; Q];
        let mut out = Self { cos: zero, sin: zero, axial: zero, across: zero, load: zero, slope: zero, by_h: zero, by_v: zero };
        let ([h, v], softness) = (at.force, beams.axial - beams.shear);
        for q in 0..Q {
            let (sin_phi, cos_phi) = tables.rotation(at, q).sin_cos();
            let (rest_cos, rest_sin, w) = (beams.cos[q], beams.sin[q], beams.weight[q]);
            let cos = rest_cos * cos_phi - rest_sin * sin_phi;
            let sin = rest_sin * cos_phi + rest_cos * sin_phi;
            let (axial, across) = (h * cos + v * sin, v * cos - h * sin);
            (out.cos[q], out.sin[q], out.axial[q], out.across[q]) = (cos, sin, axial, across);
            out.load[q] = w * (across + softness * axial * across);
            out.slope[q] = w * (softness * (across * across - axial * axial) - axial);
            out.by_h[q] = w * (softness * (cos * across - axial * sin) - sin);
            out.by_v[q] = w * (softness * (sin * across + axial * cos) + cos);
        }
        out
    }

    /// ∂²ℒ/∂x∂p for all constants p of the four beams, which have up to `coefficients` angle coefficients.
    pub(super) fn mixed<const M: usize, const E: usize>(
        &self,
        tables: &Tables<M, Q, E>,
        beams: &Beams<Q>,
        at: &Unknowns<M>,
        (coefficients, out): (usize, &mut Vec<Unknowns<M>>),
    ) {
        out.clear();
        let mut length = integrate(tables, &self.load);
        let (mut axial, mut shear) = (Unknowns::default(), Unknowns::default());
        let mut across_angle = [[Lane::ZERO; Q]; 2];
        for q in 0..Q {
            let w = beams.weight[q];
            length.force[0] += w * (self.cos[q] - beams.cos[q]);
            length.force[1] += w * (self.sin[q] - beams.sin[q]);
            across_angle[0][q] = self.by_h[q] + w * beams.sin[q];
            across_angle[1][q] = self.by_v[q] - w * beams.cos[q];
        }
        if beams.soft {
            let (mut stretch, mut slide) = ([Lane::ZERO; Q], [Lane::ZERO; Q]);
            for q in 0..Q {
                let (n, s) = (beams.weight[q] * beams.axial * self.axial[q], beams.weight[q] * beams.shear * self.across[q]);
                (stretch[q], slide[q]) = (n * self.across[q], -(s * self.axial[q]));
                axial.force = [axial.force[0] + n * self.cos[q], axial.force[1] + n * self.sin[q]];
                shear.force = [shear.force[0] - s * self.sin[q], shear.force[1] + s * self.cos[q]];
            }
            let forces = [axial.force, shear.force];
            (axial, shear) = (integrate(tables, &stretch), integrate(tables, &slide));
            [axial.force, shear.force] = forces;
            for i in 0..2 {
                length.force[i] += axial.force[i] + shear.force[i];
            }
        }
        let moment = beams.bending * (at.ends[1] - at.ends[0]);
        let bending = Unknowns { ends: [-moment, moment], force: [Lane::ZERO; 2], bubbles: at.bubbles.map(|a| beams.bending * a) };
        out.extend([length, bending, axial, shear]);
        let mut slope = self.slope;
        for _ in 0..coefficients {
            let mut angle = integrate(tables, &slope);
            for q in 0..Q {
                for i in 0..2 {
                    angle.force[i] += across_angle[i][q];
                    across_angle[i][q] = across_angle[i][q] * tables.place[q];
                }
                slope[q] = slope[q] * tables.place[q];
            }
            out.push(angle);
        }
    }

    /// The change of the moment load along a change of the state and of the constants.
    pub(super) fn load_change<const M: usize, const E: usize>(
        &self,
        tables: &Tables<M, Q, E>,
        beams: &Beams<Q>,
        change: &Unknowns<M>,
        constants: &[Lane],
    ) -> [Lane; Q] {
        let mut out = [Lane::ZERO; Q];
        let soft = beams.axial * constants[AXIAL] - beams.shear * constants[SHEAR];
        for q in 0..Q {
            let angle = constants[ANGLES..].iter().rev().fold(Lane::ZERO, |sum, c| sum * tables.place[q] + *c);
            let turn = tables.rotation(change, q) + angle;
            out[q] = self.slope[q] * turn + self.by_h[q] * change.force[0] + self.by_v[q] * change.force[1];
            out[q] += self.load[q] * constants[LENGTH];
            if beams.soft {
                out[q] += beams.weight[q] * self.axial[q] * self.across[q] * soft;
            }
        }
        out
    }

    /// Derivatives of the Lagrangian's second derivative along `change`; see `Field::add_curvature` of the general path.
    pub(super) fn curvature<const M: usize, const E: usize>(
        &self,
        tables: &Tables<M, Q, E>,
        beams: &Beams<Q>,
        change: &Unknowns<M>,
        coefficients: usize,
    ) -> Curvature<M> {
        let mut by_constants = vec![Lane::ZERO; ANGLES + coefficients];
        let end_turn = change.ends[1] - change.ends[0];
        let squares = change.bubbles.iter().fold(end_turn * end_turn, |sum, a| sum + *a * *a);
        by_constants[BENDING] = beams.bending * squares;
        let ([dh, dv], softness) = (change.force, beams.axial - beams.shear);
        let (mut loads, mut force) = ([Lane::ZERO; Q], [Lane::ZERO; 2]);
        for q in 0..Q {
            let (cos, sin, w) = (self.cos[q], self.sin[q], beams.weight[q]);
            let (axial, across, turn) = (self.axial[q], self.across[q], tables.rotation(change, q));
            let (by_t, by_n) = (dh * cos + dv * sin, dv * cos - dh * sin);
            // First and second derivatives of the axial and the shear force along the change.
            let (axial_1, across_1) = (across * turn + by_t, by_n - axial * turn);
            let (axial_2, across_2) = (turn * (by_n * 2.0 - axial * turn), -(turn * (by_t * 2.0 + across * turn)));
            let stretch = beams.axial * (axial_1 * axial_1 + axial * axial_2);
            let slide = beams.shear * (across_1 * across_1 + across * across_2);
            by_constants[AXIAL] += w * stretch;
            by_constants[SHEAR] += w * slide;
            by_constants[LENGTH] += w * (axial_2 + stretch + slide);
            let product = axial * across_2 + across * axial_2 + axial_1 * across_1 * 2.0;
            loads[q] = w * (across_2 + softness * product);
            let mut power = loads[q];
            for sum in &mut by_constants[ANGLES..] {
                *sum += power;
                power = power * tables.place[q];
            }
            let square = turn * turn;
            let along = beams.axial * axial_2 - square * (beams.axial * axial + 1.0) - beams.shear * across_1 * turn * 2.0;
            let sideways = beams.axial * axial_1 * turn * 2.0 + beams.shear * (across_2 - across * square);
            force[0] += w * (along * cos - sideways * sin);
            force[1] += w * (along * sin + sideways * cos);
        }
        let mut by_state = integrate(tables, &loads);
        by_state.force = force;
        Curvature { by_state, by_constants }
    }
}

impl<const M: usize> Curvature<M> {
    /// The change along a change of the state and of the constants.
    pub(super) fn along(&self, change: &Unknowns<M>, constants: &[Lane]) -> f64 {
        let by_constants = self.by_constants.iter().zip(constants).fold(Lane::ZERO, |sum, (a, b)| sum + *a * *b);
        sum_of(by_constants + dot(&self.by_state, change))
    }
}

/// Sums over the points of a load with the trial functions; nothing for the force.
#[inline]
fn integrate<const M: usize, const Q: usize, const E: usize>(tables: &Tables<M, Q, E>, load: &[Lane; Q]) -> Unknowns<M> {
    let mut out = Unknowns::default();
    let (mut all, mut end) = (Lane::ZERO, Lane::ZERO);
    for q in 0..Q {
        all += load[q];
        end += load[q] * tables.place[q];
    }
    out.ends = [all - end, end];
    for k in 0..M {
        for q in 0..Q {
            out.bubbles[k] += load[q] * tables.bubble[k][q];
        }
    }
    out
}

/// Products of derivatives by the unknowns with a change of these.
#[inline]
pub(super) fn dot<const M: usize>(by: &Unknowns<M>, change: &Unknowns<M>) -> Lane {
    let mut sum = Lane::ZERO;
    for i in 0..2 {
        sum += by.ends[i] * change.ends[i] + by.force[i] * change.force[i];
    }
    for k in 0..M {
        sum += by.bubbles[k] * change.bubbles[k];
    }
    sum
}

#[inline]
pub(super) fn sum_of(lane: Lane) -> f64 {
    let [a, b, c, d] = lane.0;
    (a + b) + (c + d)
}

impl<const M: usize> Answer<M> {
    pub(super) const NONE: Self = Self { scaled: [Lane::ZERO; M], closing: [Lane::ZERO; 2], first: [Lane::ZERO; 4] };

    /// Adds the answer to a constant times the change of that constant.
    #[inline]
    pub(super) fn add(&mut self, other: &Self, factor: Lane) {
        for k in 0..M {
            self.scaled[k] += other.scaled[k] * factor;
        }
        for i in 0..2 {
            self.closing[i] += other.closing[i] * factor;
        }
        for i in 0..4 {
            self.first[i] += other.first[i] * factor;
        }
    }
}

impl<const M: usize, const Q: usize> Condensed<M, Q> {
    /// Condenses a residual to the ends: what [`super::kernel::linearise`] does with that of the equilibrium.
    pub(super) fn answer(&self, residual: &Unknowns<M>) -> Answer<M> {
        let (mut lower, mut scaled) = (residual.bubbles, [Lane::ZERO; M]);
        let mut first = [residual.ends[0], residual.ends[1], residual.force[0], residual.force[1]];
        for row in 0..M {
            for k in 0..row {
                let above = lower[k];
                lower[row] -= self.inner[row][k] * above;
            }
            scaled[row] = lower[row] * self.inner[row][row];
            for i in 0..4 {
                first[i] -= self.scaled[row][i] * lower[row];
            }
        }
        let (f, by) = (&self.flexibility, &self.by_rotation);
        let closing = [0, 1].map(|i| f[i][0] * first[2] + f[i][1] * first[3]);
        let moment = |i: usize| first[i] - by[0][i] * first[2] - by[1][i] * first[3];
        Answer { scaled, closing, first: [moment(0), moment(1), -closing[0], -closing[1]] }
    }

    /// The change of the inner unknowns that goes with a residual, given the motion of the ends; see [`Condensed::expand`].
    pub(super) fn expand_answer(&self, answer: &Answer<M>, ends: [Lane; 2], apart: [Lane; 2]) -> Unknowns<M> {
        let (f, by) = (&self.flexibility, &self.by_rotation);
        let along = |i: usize| answer.closing[i] + f[i][0] * apart[0] + f[i][1] * apart[1] + by[i][0] * ends[0] + by[i][1] * ends[1];
        let force = [-along(0), -along(1)];
        let mut bubbles = [Lane::ZERO; M];
        for k in 0..M {
            let s = &self.scaled[k];
            bubbles[k] = -(s[0] * ends[0] + s[1] * ends[1] + s[2] * force[0] + s[3] * force[1] + answer.scaled[k]);
        }
        for row in (1..M).rev() {
            let value = bubbles[row];
            for k in 0..row {
                bubbles[k] -= self.inner[row][k] * value;
            }
        }
        Unknowns { ends, force, bubbles }
    }
}
