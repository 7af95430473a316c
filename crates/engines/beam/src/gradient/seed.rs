//! Derivatives of stresses and positions by the state and the beam.
//!
//! Both are read from the recovered rotation φ = `φ_A` (1 − u) + `φ_B` u + Σ `a_k` `B_k`, whose amplitudes
//! `a_k = L²/(2EI √(2k−1)) Σ_q w_q q_q (P_k − P_{k−2})(u_q)` come from the load q at the quadrature points (see
//! [`crate::element::recover`]). A seed collects derivatives by the amplitudes and carries them back to the state at the end.

use forcewright_base::{maths, quadrature::legendre_values};

use super::field::{BeamRhs, Field, Place, Sensitivity, dot, turned};
use crate::{
    element::root_of,
    state::{Face, PieceState},
};

/// Derivatives of one output by one piece of a beam. Places are along the piece.
pub(super) struct Seed<'f, 'a> {
    field: &'f Field<'a>,
    state: &'f PieceState,
    /// By the recovered amplitudes.
    modes: Vec<f64>,
    pub(super) rhs: BeamRhs,
    pub(super) explicit: Sensitivity,
    legendre: Vec<f64>,
}

impl<'f, 'a> Seed<'f, 'a> {
    pub(super) fn new(field: &'f Field<'a>, state: &'f PieceState, coefficients: usize) -> Self {
        let modes = state.modes_rad.len();
        Self {
            field,
            state,
            modes: vec![0.0; modes],
            rhs: BeamRhs::new(field.at.bubbles.len()),
            explicit: Sensitivity::new(coefficients),
            legendre: vec![0.0; modes + 2],
        }
    }

    /// The output contains `factor` times dφ/du.
    fn add_slope(&mut self, u: f64, factor: f64) {
        legendre_values(2.0 * u - 1.0, &mut self.legendre);
        self.rhs.ends[0] -= factor;
        self.rhs.ends[1] += factor;
        for (k, target) in (2..).zip(&mut self.modes) {
            *target += factor * root_of(k) * self.legendre[k - 1];
        }
    }

    /// The output changes by `factor` times θ(u).
    fn add_angle(&mut self, u: f64, factor: f64) {
        legendre_values(2.0 * u - 1.0, &mut self.legendre);
        self.rhs.ends[0] += factor * (1.0 - u);
        self.rhs.ends[1] += factor * u;
        for (k, target) in (2..).zip(&mut self.modes) {
            *target += factor * (self.legendre[k] - self.legendre[k - 2]) / (2.0 * root_of(k));
        }
        self.explicit.add_angle(&Place::new(self.field.info, u), factor);
    }

    /// `factor` times the stress in Pa on a face; see [`crate::BeamState::stress_pa`].
    pub(super) fn add_stress(&mut self, u: f64, face: Face, factor: f64, force_unit_n: f64) {
        let info = self.field.info;
        let (section, place) = (info.section_at(u), Place::new(info, u));
        let sign = if face == Face::Left { -factor } else { factor };
        let bending = sign * self.state.moment_nm(u) * section.face_stress_per_moment_per_m3();
        self.explicit.bending += bending;
        self.explicit.thickness -= 2.0 * bending;
        self.explicit.depth -= bending;
        // E w/(2 L) φ'.
        self.explicit.add_thickness(&place, bending);
        self.add_slope(u, sign * 0.5 * section.young_pa * section.thickness_m / info.shape.length_m());
        if self.field.constants.axial > 0.0 {
            let per_area = factor / section.area_m2();
            let axial = self.state.axial_force_n(u) * per_area;
            self.explicit.thickness -= axial;
            self.explicit.depth -= axial;
            self.explicit.add_thickness(&place, -axial);
            self.add_angle(u, self.state.shear_force_n(u) * per_area);
            let along = direction(self.state, u);
            for (target, component) in self.rhs.force.iter_mut().zip(along) {
                *target += per_area * force_unit_n * component;
            }
        }
    }

    /// The dimensionless position along `axis` relative to the start of the piece; see [`crate::BeamState::shape_m`].
    pub(super) fn add_position(&mut self, u: f64, axis: [f64; 2]) {
        let (c, force) = (self.field.constants, self.field.at.force);
        let rule = &self.field.basis.rule;
        for (&node, &weight) in rule.nodes().iter().zip(rule.weights()) {
            let (place, w) = (Place::new(self.field.info, node * u), c.length * u * weight);
            let along = direction(self.state, place.v);
            let (t, n) = (dot(axis, along), dot(axis, turned(along)));
            let (axial, across) = (dot(force, along), dot(force, turned(along)));
            let soft = place.soft(&c);
            let (stretch, slide) = (soft[0] * axial, soft[1] * across);
            self.explicit.axial += w * stretch * t;
            self.explicit.shear += w * slide * n;
            self.explicit.add_thickness(&place, -w * (stretch * t + slide * n));
            self.explicit.length += w * ((1.0 + stretch) * t + slide * n);
            let by_angle = (soft[0] - soft[1]) * (across * t + axial * n) + n;
            self.add_angle(place.v, w * by_angle);
            for (target, (x, y)) in self.rhs.force.iter_mut().zip(along.iter().zip(turned(along))) {
                *target += w * (soft[0] * t * x + soft[1] * n * y);
            }
        }
    }

    /// Carries the derivatives by the amplitudes back to the state.
    pub(super) fn close(mut self) -> (BeamRhs, Sensitivity) {
        let Self { field, ref modes, .. } = self;
        if field.varies() {
            // Such amplitudes are the bubbles themselves.
            for (target, by_mode) in self.rhs.bubbles.iter_mut().zip(modes) {
                *target += by_mode;
            }
            return (self.rhs, self.explicit);
        }
        let c = field.constants;
        let recovered: f64 = modes.iter().zip(&self.state.modes_rad).map(|(s, a)| s * a).sum();
        self.explicit.length += recovered;
        self.explicit.bending -= recovered;
        // By Σ w q P_j, from the amplitudes of degree j and j + 2.
        let ratio = 0.5 * c.length / c.bending;
        let points = field.points.len();
        let by_mode = |k: usize| if k < 2 { 0.0 } else { modes.get(k - 2).map_or(0.0, |s| ratio * s / root_of(k)) };
        let by_moment: Vec<f64> = (0..points).map(|j| by_mode(j) - by_mode(j + 2)).collect();
        for ((p, (_, row)), legendre) in field.points.iter().zip(field.basis.rows()).zip(field.basis.legendre.chunks_exact(points)) {
            let by_load = p.weight * legendre.iter().zip(&by_moment).map(|(l, b)| l * b).sum::<f64>();
            self.rhs.add_rotation(row, by_load * p.load_by_angle);
            self.explicit.add_angle(&p.place, by_load * p.load_by_angle);
            for (target, slope) in self.rhs.force.iter_mut().zip(p.load_by_force) {
                *target += by_load * slope;
            }
            let product = by_load * p.axial * p.across;
            self.explicit.axial += c.axial * product;
            self.explicit.shear -= c.shear * product;
        }
        (self.rhs, self.explicit)
    }
}

/// t(θ) at u.
fn direction(state: &PieceState, u: f64) -> [f64; 2] {
    let (sin, cos) = maths::sin_cos(state.angle_rad(u));
    [cos, sin]
}

/// dσ/dv on a face at a place of the piece, Pa, from the equation of equilibrium.
pub(super) fn stress_slope(state: &PieceState, u: f64, face: Face, extensible: bool) -> f64 {
    let info = &state.info;
    let section = info.section_at(u);
    let (length, stiffness) = (info.shape.length_m(), section.bending_stiffness_n_m2());
    let side = if face == Face::Left { -1.0 } else { 1.0 };
    let thinning = info.thickness_m.map_or(0.0, |[a, b]| b - a) / section.thickness_m;
    let softness = if extensible { 1.0 / section.axial_stiffness_n() - 1.0 / section.shear_stiffness_n() } else { 0.0 };
    let (axial, across) = (state.axial_force_n(u), state.shear_force_n(u));
    let (moment, per_moment) = (state.moment_nm(u), section.face_stress_per_moment_per_m3());
    // −M' = L q, and the change of 6/(b w²).
    let bending = -side * (length * (across + softness * axial * across) + 2.0 * moment * thinning) * per_moment;
    if !extensible {
        return bending;
    }
    let turn = info.shape.slope_at(u) + moment * length / stiffness;
    bending + (across * turn - axial * thinning) / section.area_m2()
}

/// d(position)/dv along an axis at a place of the piece, dimensionless; see [`crate::BeamState::shape_m`].
pub(super) fn position_slope(field: &Field, state: &PieceState, u: f64, axis: [f64; 2]) -> f64 {
    let (c, force, along) = (field.constants, field.at.force, direction(state, u));
    let soft = Place::new(field.info, u).soft(&c);
    let (axial, across) = (dot(force, along), dot(force, turned(along)));
    c.length * ((1.0 + soft[0] * axial) * dot(axis, along) + soft[1] * across * dot(axis, turned(along)))
}

/// The place of a largest stress, known to about 1e-6, improved where dσ/dv vanishes inside the piece.
pub(super) fn polished_place(state: &PieceState, u: f64, face: Face, extensible: bool) -> f64 {
    if u <= 0.0 || u >= 1.0 {
        return u;
    }
    let slope = |u: f64| stress_slope(state, u, face, extensible);
    let (mut before, mut here) = (u, if u < 0.5 { u + 1e-4 } else { u - 1e-4 });
    let (mut slope_before, mut slope_here) = (slope(before), slope(here));
    for _ in 0..6 {
        let next = here - slope_here * (here - before) / (slope_here - slope_before);
        // Written so that NaN ends it: no improvement.
        if !((next - u).abs() < 1e-3 && (0.0..=1.0).contains(&next)) {
            return u;
        }
        (before, slope_before) = (here, slope_here);
        (here, slope_here) = (next, slope(next));
        if (here - before).abs() < 1e-13 {
            break;
        }
    }
    here
}
