//! Derivatives of stresses and positions by the state and the beam.
//!
//! Both are read from the recovered rotation φ = `φ_A` (1 − u) + `φ_B` u + Σ `a_k` `B_k`, whose amplitudes
//! `a_k = L²/(2EI √(2k−1)) Σ_q w_q q_q (P_k − P_{k−2})(u_q)` come from the load q at the quadrature points (see
//! [`crate::element::recover`]). A seed collects derivatives by the amplitudes and carries them back to the state at the end.

use forcewright_base::{maths, quadrature::legendre_values};

use super::field::{BeamRhs, Field, Sensitivity, dot, turned};
use crate::{
    element::root_of,
    state::{BeamState, Face},
};

/// Derivatives of one output by one beam.
pub(super) struct Seed<'f, 'a> {
    field: &'f Field<'a>,
    state: &'f BeamState,
    /// By the recovered amplitudes.
    modes: Vec<f64>,
    pub(super) rhs: BeamRhs,
    pub(super) explicit: Sensitivity,
    legendre: Vec<f64>,
}

impl<'f, 'a> Seed<'f, 'a> {
    pub(super) fn new(field: &'f Field<'a>, state: &'f BeamState, coefficients: usize) -> Self {
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
        self.explicit.add_angle(u, factor);
    }

    /// `factor` times the stress in Pa on a face; see [`BeamState::stress_pa`].
    pub(super) fn add_stress(&mut self, u: f64, face: Face, factor: f64, force_unit_n: f64) {
        let info = self.state.info();
        let sign = if face == Face::Left { -factor } else { factor };
        let bending = sign * self.state.moment_nm(u) * info.section().face_stress_per_moment_per_m3();
        self.explicit.bending += bending;
        self.explicit.thickness -= 2.0 * bending;
        self.explicit.depth -= bending;
        self.add_slope(u, sign * info.stress_unit_pa());
        if self.field.constants.axial > 0.0 {
            let per_area = factor / info.section().area_m2();
            let axial = self.state.axial_force_n(u) * per_area;
            self.explicit.thickness -= axial;
            self.explicit.depth -= axial;
            self.add_angle(u, self.state.shear_force_n(u) * per_area);
            let along = direction(self.state, u);
            for (target, component) in self.rhs.force.iter_mut().zip(along) {
                *target += per_area * force_unit_n * component;
            }
        }
    }

    /// The dimensionless position along `axis` relative to the start of the beam; see [`BeamState::shape_m`].
    pub(super) fn add_position(&mut self, u: f64, axis: [f64; 2]) {
        let (c, force) = (self.field.constants, self.field.at.force);
        let rule = &self.field.basis.rule;
        for (&node, &weight) in rule.nodes().iter().zip(rule.weights()) {
            let (place, w) = (node * u, c.length * u * weight);
            let along = direction(self.state, place);
            let (t, n) = (dot(axis, along), dot(axis, turned(along)));
            let (axial, across) = (dot(force, along), dot(force, turned(along)));
            let (stretch, slide) = (c.axial * axial, c.shear * across);
            self.explicit.axial += w * stretch * t;
            self.explicit.shear += w * slide * n;
            self.explicit.length += w * ((1.0 + stretch) * t + slide * n);
            let by_angle = (c.axial - c.shear) * (across * t + axial * n) + n;
            self.add_angle(place, w * by_angle);
            for (target, (x, y)) in self.rhs.force.iter_mut().zip(along.iter().zip(turned(along))) {
                *target += w * (c.axial * t * x + c.shear * n * y);
            }
        }
    }

    /// Carries the derivatives by the amplitudes back to the state.
    pub(super) fn close(mut self) -> (BeamRhs, Sensitivity) {
        let Self { field, ref modes, .. } = self;
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
            self.explicit.add_angle(p.u, by_load * p.load_by_angle);
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
fn direction(state: &BeamState, u: f64) -> [f64; 2] {
    let (sin, cos) = maths::sin_cos(state.angle_rad(u));
    [cos, sin]
}

/// The place of a largest stress, known to about 1e-6, improved where dσ/du vanishes inside the beam.
pub(super) fn polished_place(state: &BeamState, u: f64, face: Face, extensible: bool) -> f64 {
    let info = state.info();
    let (section, length) = (info.section(), info.shape.length_m());
    let stiffness = section.bending_stiffness_n_m2();
    let softness = if extensible { 1.0 / section.axial_stiffness_n() - 1.0 / section.shear_stiffness_n() } else { 0.0 };
    let side = if face == Face::Left { -1.0 } else { 1.0 };
    let slope = |u: f64| {
        let (axial, across) = (state.axial_force_n(u), state.shear_force_n(u));
        let bending = -side * length * (across + softness * axial * across) * section.face_stress_per_moment_per_m3();
        let turn = info.shape.slope_at(u) + state.moment_nm(u) * length / stiffness;
        if extensible { bending + across * turn / section.area_m2() } else { bending }
    };
    if u <= 0.0 || u >= 1.0 {
        return u;
    }
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
