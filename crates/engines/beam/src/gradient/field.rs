//! Derivatives of the Lagrangian of one beam by its constants, contracted with changes of the state.
//!
//! Symbols of [`crate::element`]. Per point, f = F·t(θ) + N²/(2EA) + Q²/(2kGA), so that the beam's Lagrangian is its bending
//! energy less L ∫ (f − F·t(η)) du, plus `F·(u_B − u_A)`. A dot is a derivative along a change (φ̇, Ḟ) of the state:
//!
//! `Ṅ = Q φ̇ + Ḟ·t`, `Q̇ = −N φ̇ + Ḟ·n`, `N̈ = −N φ̇² + 2 φ̇ Ḟ·n`, `Q̈ = −Q φ̇² − 2 φ̇ Ḟ·t`.

use forcewright_base::maths;

use crate::element::{Basis, Constants, Coordinates, RestShape};

/// Derivative of one quantity by what describes one beam. All but the angles are logarithmic: p ∂y/∂p.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sensitivity {
    /// By `c_0 … c_m`.
    pub(super) angles: Vec<f64>,
    /// By the length with the next three held.
    pub(super) length: f64,
    /// By EI/L.
    pub(super) bending: f64,
    /// By 1/EA.
    pub(super) axial: f64,
    /// By 1/kGA.
    pub(super) shear: f64,
    /// By the thickness where it does not act through the stiffnesses.
    pub(super) thickness: f64,
    /// By the depth where it does not act through the stiffnesses.
    pub(super) depth: f64,
}

impl Sensitivity {
    pub(super) fn new(coefficients: usize) -> Self {
        Self { angles: vec![0.0; coefficients], length: 0.0, bending: 0.0, axial: 0.0, shear: 0.0, thickness: 0.0, depth: 0.0 }
    }

    /// Adds to the derivatives by the coefficients what changes in proportion to η(u).
    pub(super) fn add_angle(&mut self, u: f64, factor: f64) {
        let mut power = factor;
        for target in &mut self.angles {
            *target += power;
            power *= u;
        }
    }

    pub(super) fn add(&mut self, other: &Self, factor: f64) {
        for (a, b) in self.angles.iter_mut().zip(&other.angles) {
            *a += factor * b;
        }
        self.length += factor * other.length;
        self.bending += factor * other.bending;
        self.axial += factor * other.axial;
        self.shear += factor * other.shear;
        self.thickness += factor * other.thickness;
        self.depth += factor * other.depth;
    }
}

/// Directions and forces at one quadrature point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Local {
    pub(super) weight: f64,
    pub(super) u: f64,
    /// t(θ); n is its quarter turn.
    pub(super) along: [f64; 2],
    /// t(η).
    pub(super) rest: [f64; 2],
    pub(super) axial: f64,
    pub(super) across: f64,
    /// q and its derivatives by φ, H and V.
    pub(super) load: f64,
    pub(super) load_by_angle: f64,
    pub(super) load_by_force: [f64; 2],
}

/// The quarter turn counter-clockwise.
pub(super) fn turned(v: [f64; 2]) -> [f64; 2] {
    [-v[1], v[0]]
}

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// One beam at one state.
#[derive(Debug)]
pub(super) struct Field<'a> {
    pub(super) basis: &'a Basis,
    pub(super) constants: Constants,
    pub(super) at: Coordinates<'a>,
    pub(super) points: Vec<Local>,
}

impl<'a> Field<'a> {
    pub(super) fn new(basis: &'a Basis, rest: &RestShape, constants: Constants, at: Coordinates<'a>) -> Self {
        let softness = constants.axial - constants.shear;
        let rows = basis.rows().zip(basis.rule.nodes()).enumerate();
        let local = |(i, ((weight, row), u)): (usize, ((f64, &[f64]), &f64))| {
            let (sin, cos) = maths::sin_cos(rest.eta[i] + at.rotation(row));
            let along = [cos, sin];
            let (axial, across) = (dot(at.force, along), dot(at.force, turned(along)));
            Local {
                weight,
                u: *u,
                along,
                rest: [rest.cos[i], rest.sin[i]],
                axial,
                across,
                load: across + softness * axial * across,
                load_by_angle: softness * (across * across - axial * axial) - axial,
                load_by_force: [
                    softness * (cos * across - axial * sin) - sin, //
                    softness * (sin * across + axial * cos) + cos,
                ],
            }
        };
        Self { basis, constants, at, points: rows.map(local).collect() }
    }

    /// Quadrature points with the rotation that a change of the state makes there.
    fn moved<'b>(&'b self, change: &'b Coordinates) -> impl Iterator<Item = (&'b Local, f64)> {
        self.points.iter().zip(self.basis.rows()).map(|(p, (_, row))| (p, change.rotation(row)))
    }

    /// Adds `factor` times the derivative, by the beam, of the Lagrangian's derivative along `change`.
    pub(super) fn add_mixed(&self, change: &Coordinates, factor: f64, sum: &mut Sensitivity) {
        let (c, force) = (&self.constants, change.force);
        let turns = (self.at.ends[1] - self.at.ends[0]) * (change.ends[1] - change.ends[0]);
        let bubbles: f64 = self.at.bubbles.iter().zip(change.bubbles).map(|(a, b)| a * b).sum();
        sum.bending += factor * c.bending * (turns + bubbles);
        for (p, turn) in self.moved(change) {
            let w = -factor * c.length * p.weight;
            let (by_t, by_n) = (dot(force, p.along), dot(force, turned(p.along)));
            sum.axial += w * c.axial * p.axial * (p.across * turn + by_t);
            sum.shear += w * c.shear * p.across * (by_n - p.axial * turn);
            let gap = by_t - dot(force, p.rest) + c.axial * p.axial * by_t + c.shear * p.across * by_n;
            sum.length += w * (p.load * turn + gap);
            let by_angle = p.load_by_angle * turn + dot(p.load_by_force, force) - dot(force, turned(p.rest));
            sum.add_angle(p.u, w * by_angle);
        }
    }

    /// The Lagrangian's second derivative along `change`, differentiated by the beam into `sum` and by the state into `rhs`, which
    /// receives entries for the bubbles, both ends and the force.
    pub(super) fn add_curvature(&self, change: &Coordinates, sum: &mut Sensitivity, rhs: &mut BeamRhs) {
        let (c, force) = (&self.constants, change.force);
        let turn = change.ends[1] - change.ends[0];
        let bubbles: f64 = change.bubbles.iter().map(|a| a * a).sum();
        sum.bending += c.bending * (turn * turn + bubbles);
        for ((p, turn), (_, row)) in self.moved(change).zip(self.basis.rows()) {
            let w = -c.length * p.weight;
            let n = turned(p.along);
            let (by_t, by_n) = (dot(force, p.along), dot(force, n));
            let (axial, across) = (p.across * turn + by_t, by_n - p.axial * turn);
            let (axial_2, across_2) = (turn * (2.0 * by_n - p.axial * turn), -turn * (2.0 * by_t + p.across * turn));
            let stretch = c.axial * (axial * axial + p.axial * axial_2);
            let slide = c.shear * (across * across + p.across * across_2);
            sum.axial += w * stretch;
            sum.shear += w * slide;
            sum.length += w * (axial_2 + stretch + slide);
            let product = p.axial * across_2 + p.across * axial_2 + 2.0 * axial * across;
            let by_angle = across_2 + (c.axial - c.shear) * product;
            sum.add_angle(p.u, w * by_angle);
            rhs.add_rotation(row, w * by_angle);
            let by_along = -turn * turn * (1.0 + c.axial * p.axial) + c.axial * axial_2 - 2.0 * c.shear * across * turn;
            let by_across = 2.0 * c.axial * axial * turn + c.shear * (across_2 - p.across * turn * turn);
            for (target, (t, n)) in rhs.force.iter_mut().zip(p.along.iter().zip(n)) {
                *target += w * (by_along * t + by_across * n);
            }
        }
    }
}

/// Derivatives by the coordinates of one beam.
#[derive(Debug)]
pub(super) struct BeamRhs {
    pub(super) bubbles: Vec<f64>,
    pub(super) ends: [f64; 2],
    pub(super) force: [f64; 2],
}

impl BeamRhs {
    pub(super) fn new(bubbles: usize) -> Self {
        Self { bubbles: vec![0.0; bubbles], ends: [0.0; 2], force: [0.0; 2] }
    }

    /// Adds what changes in proportion to φ at a point, given its row of the trial functions.
    pub(super) fn add_rotation(&mut self, row: &[f64], factor: f64) {
        let (inner, linear) = row.split_at(self.bubbles.len());
        for (target, value) in self.bubbles.iter_mut().zip(inner) {
            *target += factor * value;
        }
        self.ends[0] += factor * linear[0];
        self.ends[1] += factor * linear[1];
    }
}
