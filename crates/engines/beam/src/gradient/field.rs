//! Derivatives of the Lagrangian of one piece of a beam by its constants, contracted with changes of the state.
//!
//! Symbols of [`crate::element`]. Per point, f = F·t(θ) + N²/(2EA) + Q²/(2kGA), so that the beam's Lagrangian is its bending
//! energy less L ∫ (f − F·t(η)) du, plus `F·(u_B − u_A)`. A dot is a derivative along a change (φ̇, Ḟ) of the state:
//!
//! `Ṅ = Q φ̇ + Ḟ·t`, `Q̇ = −N φ̇ + Ḟ·n`, `N̈ = −N φ̇² + 2 φ̇ Ḟ·n`, `Q̈ = −Q φ̇² − 2 φ̇ Ḟ·t`.

use forcewright_base::maths;

use crate::{
    element::{Basis, Constants, Coordinates, RestShape},
    state::PieceInfo,
};

/// Derivative of one quantity by what describes one piece of a beam. `length` to `depth` are logarithmic: p ∂y/∂p.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sensitivity {
    /// By `c_0 … c_m` of the beam.
    pub(super) angles: Vec<f64>,
    /// By the length with the next three held.
    pub(super) length: f64,
    /// By the length of the whole beam, where that of the piece does not come in.
    pub(super) beam_length: f64,
    /// By EI/L.
    pub(super) bending: f64,
    /// By 1/EA.
    pub(super) axial: f64,
    /// By 1/kGA.
    pub(super) shear: f64,
    /// By the thickness where it does not act through the stiffnesses; unused where it varies.
    pub(super) thickness: f64,
    /// By the depth where it does not act through the stiffnesses.
    pub(super) depth: f64,
    /// By the thickness at both ends, relative to that of the constants, if it varies: all there is of it.
    pub(super) profile: [f64; 2],
    /// By the places on the beam where the piece begins and ends, as far as they change its angles.
    pub(super) range: [f64; 2],
    /// By its arms.
    pub(super) arms: [[f64; 2]; 2],
}

/// A place on a piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// Along the piece.
    pub(super) v: f64,
    /// Along the beam.
    pub(super) u: f64,
    /// dη/du of the beam.
    pub(super) slope: f64,
    /// Thickness relative to that of the constants, if it varies.
    pub(super) thickness: Option<f64>,
}

impl Place {
    pub(super) fn new(info: &PieceInfo, v: f64) -> Self {
        let [from, to] = info.range;
        let thickness = info.thickness_m.map(|[a, b]| (a + (b - a) * v) / info.section.thickness_m);
        Self { v, u: info.outer(v), slope: info.shape.slope_at(v) / (to - from), thickness }
    }

    /// Local 1/EA and 1/kGA.
    pub(super) fn soft(&self, c: &Constants) -> [f64; 2] {
        let t = self.thickness.unwrap_or(1.0);
        [c.axial / t, c.shear / t]
    }
}

impl Sensitivity {
    pub(super) fn new(coefficients: usize) -> Self {
        let none = [0.0; 2];
        Self {
            angles: vec![0.0; coefficients],
            length: 0.0,
            beam_length: 0.0,
            bending: 0.0,
            axial: 0.0,
            shear: 0.0,
            thickness: 0.0,
            depth: 0.0,
            profile: none,
            range: none,
            arms: [none; 2],
        }
    }

    /// What changes in proportion to η at a place.
    pub(super) fn add_angle(&mut self, at: &Place, factor: f64) {
        let mut power = factor;
        for target in &mut self.angles {
            *target += power;
            power *= at.u;
        }
        self.range[0] += factor * at.slope * (1.0 - at.v);
        self.range[1] += factor * at.slope * at.v;
    }

    /// What changes by `factor` with the logarithm of the thickness at a place, if it varies.
    pub(super) fn add_thickness(&mut self, at: &Place, factor: f64) {
        if let Some(t) = at.thickness {
            self.profile[0] += factor * (1.0 - at.v) / t;
            self.profile[1] += factor * at.v / t;
        }
    }

    /// A place fixed on the beam slides along the piece when its ends move.
    pub(super) fn add_sliding(&mut self, [from, to]: &[f64; 2], u: f64, slope: f64) {
        if u > *from && u < *to {
            let v = (u - from) / (to - from);
            self.range[0] -= slope * (1.0 - v) / (to - from);
            self.range[1] -= slope * v / (to - from);
        }
    }

    pub(super) fn add(&mut self, other: &Self, factor: f64) {
        for (a, b) in self.angles.iter_mut().zip(&other.angles) {
            *a += factor * b;
        }
        self.length += factor * other.length;
        self.beam_length += factor * other.beam_length;
        self.bending += factor * other.bending;
        self.axial += factor * other.axial;
        self.shear += factor * other.shear;
        self.thickness += factor * other.thickness;
        self.depth += factor * other.depth;
        for i in 0..2 {
            self.profile[i] += factor * other.profile[i];
            self.range[i] += factor * other.range[i];
            for axis in 0..2 {
                self.arms[i][axis] += factor * other.arms[i][axis];
            }
        }
    }
}

/// Directions and forces at one quadrature point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Local {
    pub(super) weight: f64,
    pub(super) place: Place,
    /// Bending stiffness relative to the constants; 1/EA; 1/kGA.
    pub(super) stiffness: f64,
    pub(super) soft: [f64; 2],
    /// dφ/dv; only where the thickness varies.
    pub(super) bend: f64,
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

/// One piece at one state.
#[derive(Debug)]
pub(super) struct Field<'a> {
    pub(super) basis: &'a Basis,
    pub(super) info: &'a PieceInfo,
    pub(super) constants: Constants,
    pub(super) at: Coordinates<'a>,
    pub(super) points: Vec<Local>,
}

impl<'a> Field<'a> {
    pub(super) fn new(basis: &'a Basis, rest: &RestShape, constants: Constants, info: &'a PieceInfo, at: Coordinates<'a>) -> Self {
        let mut slopes = vec![0.0; basis.bubbles + 2];
        let rows = basis.rows().zip(basis.rule.nodes()).enumerate();
        let local = |(i, ((weight, row), v)): (usize, ((f64, &[f64]), &f64))| {
            let (stiffness, soft_axial, soft_shear) = rest.local(i, &constants);
            let softness = soft_axial - soft_shear;
            let (sin, cos) = maths::sin_cos(rest.eta[i] + at.rotation(row));
            let along = [cos, sin];
            let (axial, across) = (dot(at.force, along), dot(at.force, turned(along)));
            Local {
                weight,
                place: Place::new(info, *v),
                stiffness,
                soft: [soft_axial, soft_shear],
                bend: if rest.thickness.is_empty() { 0.0 } else { basis.slope(i, &at, &mut slopes) },
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
        Self { basis, info, constants, at, points: rows.map(local).collect() }
    }

    /// Whether the thickness varies.
    pub(super) fn varies(&self) -> bool {
        self.info.thickness_m.is_some()
    }

    /// Adds `factor` Σ w β φ' φ̇' EI/L by the stiffness: the derivative of the bending energy's along `change`, or with `bend` in place
    /// of φ' another product of slopes.
    fn add_varying_bending(&self, change: &Coordinates, factor: f64, sum: &mut Sensitivity, bend: impl Fn(&Local, f64) -> f64) {
        let mut slopes = vec![0.0; self.basis.bubbles + 2];
        for (i, p) in self.points.iter().enumerate() {
            let slope = self.basis.slope(i, change, &mut slopes);
            let local = factor * self.constants.bending * p.weight * p.stiffness * bend(p, slope) * slope;
            sum.bending += local;
            sum.add_thickness(&p.place, 3.0 * local);
        }
    }

    /// Quadrature points with the rotation that a change of the state makes there.
    fn moved<'b>(&'b self, change: &'b Coordinates) -> impl Iterator<Item = (&'b Local, f64)> {
        self.points.iter().zip(self.basis.rows()).map(|(p, (_, row))| (p, change.rotation(row)))
    }

    /// Adds `factor` times the derivative, by the piece, of the Lagrangian's derivative along `change`.
    pub(super) fn add_mixed(&self, change: &Coordinates, factor: f64, sum: &mut Sensitivity) {
        let (c, force) = (&self.constants, change.force);
        if self.varies() {
            self.add_varying_bending(change, factor, sum, |p, _| p.bend);
        } else {
            let turns = (self.at.ends[1] - self.at.ends[0]) * (change.ends[1] - change.ends[0]);
            let bubbles: f64 = self.at.bubbles.iter().zip(change.bubbles).map(|(a, b)| a * b).sum();
            sum.bending += factor * c.bending * (turns + bubbles);
        }
        for (p, turn) in self.moved(change) {
            let w = -factor * c.length * p.weight;
            let (by_t, by_n) = (dot(force, p.along), dot(force, turned(p.along)));
            let stretch = w * p.soft[0] * p.axial * (p.across * turn + by_t);
            let slide = w * p.soft[1] * p.across * (by_n - p.axial * turn);
            sum.axial += stretch;
            sum.shear += slide;
            sum.add_thickness(&p.place, -(stretch + slide));
            let gap = by_t - dot(force, p.rest) + p.soft[0] * p.axial * by_t + p.soft[1] * p.across * by_n;
            sum.length += w * (p.load * turn + gap);
            let by_angle = p.load_by_angle * turn + dot(p.load_by_force, force) - dot(force, turned(p.rest));
            sum.add_angle(&p.place, w * by_angle);
        }
    }

    /// The Lagrangian's second derivative along `change`, differentiated by the piece into `sum` and by the state into `rhs`, which
    /// receives entries for the bubbles, both ends and the force.
    pub(super) fn add_curvature(&self, change: &Coordinates, sum: &mut Sensitivity, rhs: &mut BeamRhs) {
        let (c, force) = (&self.constants, change.force);
        if self.varies() {
            self.add_varying_bending(change, 1.0, sum, |_, slope| slope);
        } else {
            let turn = change.ends[1] - change.ends[0];
            let bubbles: f64 = change.bubbles.iter().map(|a| a * a).sum();
            sum.bending += c.bending * (turn * turn + bubbles);
        }
        for ((p, turn), (_, row)) in self.moved(change).zip(self.basis.rows()) {
            let w = -c.length * p.weight;
            let n = turned(p.along);
            let (by_t, by_n) = (dot(force, p.along), dot(force, n));
            let (axial, across) = (p.across * turn + by_t, by_n - p.axial * turn);
            let (axial_2, across_2) = (turn * (2.0 * by_n - p.axial * turn), -turn * (2.0 * by_t + p.across * turn));
            let stretch = p.soft[0] * (axial * axial + p.axial * axial_2);
            let slide = p.soft[1] * (across * across + p.across * across_2);
            sum.axial += w * stretch;
            sum.shear += w * slide;
            sum.add_thickness(&p.place, -w * (stretch + slide));
            sum.length += w * (axial_2 + stretch + slide);
            let product = p.axial * across_2 + p.across * axial_2 + 2.0 * axial * across;
            let by_angle = across_2 + (p.soft[0] - p.soft[1]) * product;
            sum.add_angle(&p.place, w * by_angle);
            rhs.add_rotation(row, w * by_angle);
            let by_along = -turn * turn * (1.0 + p.soft[0] * p.axial) + p.soft[0] * axial_2 - 2.0 * p.soft[1] * across * turn;
            let by_across = 2.0 * p.soft[0] * axial * turn + p.soft[1] * (across_2 - p.across * turn * turn);
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
