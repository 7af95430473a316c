//! One beam: its energy, the derivatives of its Lagrangian, and the condensation of its inner modes.
//!
//! All quantities are dimensionless here: lengths in units of `L0`, bending stiffness in units of `EI0`, forces in `EI0/L0²`.
//!
//! | symbol | here | meaning |
//! | --- | --- | --- |
//! | η, φ, θ = η + φ | `eta`, `phi`, `theta` | angle at rest, rotation, deformed angle |
//! | t, n | (cos θ, sin θ), (−sin θ, cos θ) | directions along and across the beam |
//! | F = (H, V) | `force` | force of the part beyond a section on the part before it; constant along the beam |
//! | N = F·t, Q = F·n | `axial`, `across` | axial force (tension positive) and shear force |
//! | q | `load` | −dM/du / L = Q + (1/EA − 1/kGA) N Q |
//!
//! Lagrangian of a beam from A to B, stationary at equilibrium, with the rest shape subtracted by the same quadrature so that rest
//! is an exact equilibrium:
//!
//! `∫ EI/(2L) φ'² du + F·(u_B − u_A − L ∫ (t(θ) − t(η)) du) − L ∫ [N²/(2EA) + Q²/(2kGA)] du`
//!
//! φ is a polynomial: linear between the end rotations plus integrated Legendre polynomials ("bubbles", zero at both ends)
//! `B_k = (P_k − P_{k−2})/(2 √(2k−1))`, whose slopes `√(2k−1) P_{k−1}` are orthonormal on [0, 1].

use std::sync::Arc;

use forcewright_base::{
    dense::{Lu, Singular},
    inertia::inertia,
    maths,
    quadrature::{GaussLegendre, legendre_values},
};

use crate::state::PieceInfo;

/// Tables of the trial functions for one polynomial degree.
#[derive(Debug)]
pub(crate) struct Basis {
    /// Number of bubbles, degree − 1.
    pub(crate) bubbles: usize,
    /// The quadrature rule.
    pub(crate) rule: Arc<GaussLegendre>,
    /// Row per point: the bubbles, then 1 − u, then u.
    values: Vec<f64>,
    /// Row per point: Legendre polynomials of degree 0 … points − 1.
    pub(crate) legendre: Vec<f64>,
}

impl Basis {
    pub(crate) fn new(degree: usize) -> Self {
        // Closure is not polynomial in φ: the extra points keep its error at the level of the modes left out.
        let points = degree + 4 + degree / 4;
        let (bubbles, rule) = (degree - 1, Arc::new(GaussLegendre::new(points)));
        let mut values = Vec::with_capacity(points * (bubbles + 2));
        let mut table = vec![0.0; points * points];
        let mut p = vec![0.0; degree + 1];
        for (&u, row) in rule.nodes().iter().zip(table.chunks_exact_mut(points)) {
            legendre_values(2.0 * u - 1.0, &mut p);
            values.extend((2..=degree).map(|k| (p[k] - p[k - 2]) / (2.0 * root_of(k))));
            values.extend([1.0 - u, u]);
            legendre_values(2.0 * u - 1.0, row);
        }
        Self { bubbles, rule, values, legendre: table }
    }

    pub(crate) fn points(&self) -> usize {
        self.rule.nodes().len()
    }

    /// φ' at a point; `slopes` receives those of the bubbles, 1 − u and u.
    pub(crate) fn slope(&self, point: usize, at: &Coordinates, slopes: &mut [f64]) -> f64 {
        let legendre = &self.legendre[point * self.points()..];
        let mut sum = at.ends[1] - at.ends[0];
        for (k, target) in slopes[..self.bubbles].iter_mut().enumerate() {
            *target = root_of(k + 2) * legendre[k + 1];
            sum += at.bubbles[k] * *target;
        }
        slopes[self.bubbles] = -1.0;
        slopes[self.bubbles + 1] = 1.0;
        sum
    }

    /// Per point: its weight, and the bubbles, 1 − u and u there.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (f64, &[f64])> {
        self.rule.weights().iter().copied().zip(self.values.chunks_exact(self.bubbles + 2))
    }
}

/// √(2k − 1), the norm of the slope of bubble k.
pub(crate) fn root_of(k: usize) -> f64 {
    ((2 * k - 1) as f64).sqrt()
}

/// Constants of one beam, dimensionless.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Constants {
    /// Length.
    pub(crate) length: f64,
    /// EI/L.
    pub(crate) bending: f64,
    /// 1/EA; 0 if inextensible.
    pub(crate) axial: f64,
    /// 1/kGA; 0 if rigid in shear.
    pub(crate) shear: f64,
}

/// The rest shape at the quadrature points.
#[derive(Debug)]
pub(crate) struct RestShape {
    pub(crate) eta: Vec<f64>,
    pub(crate) cos: Vec<f64>,
    pub(crate) sin: Vec<f64>,
    /// Thickness relative to that of the constants; empty if it is constant.
    pub(crate) thickness: Vec<f64>,
}

impl RestShape {
    pub(crate) fn new(basis: &Basis, info: &PieceInfo) -> Self {
        let nodes = basis.rule.nodes();
        let eta: Vec<f64> = nodes.iter().map(|&u| info.shape.angle_at(u)).collect();
        // Through the same addition as in the loaded state, so that no rotation gives the same bits.
        let turned: Vec<(f64, f64)> = eta.iter().map(|a| maths::sin_cos(a + 0.0)).collect();
        let relative = |[a, b]: [f64; 2]| nodes.iter().map(|u| (a + (b - a) * u) / info.section.thickness_m).collect();
        Self {
            cos: turned.iter().map(|t| t.1).collect(),
            sin: turned.iter().map(|t| t.0).collect(),
            eta,
            thickness: info.thickness_m.map(relative).unwrap_or_default(),
        }
    }

    /// Bending stiffness at a point relative to the constants, and 1/EA and 1/kGA at it.
    pub(crate) fn local(&self, point: usize, c: &Constants) -> (f64, f64, f64) {
        match self.thickness.get(point) {
            Some(t) => (t * t * t, c.axial / t, c.shear / t),
            None => (1.0, c.axial, c.shear),
        }
    }
}

/// End rotations, force and bubbles of one beam.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coordinates<'a> {
    pub(crate) ends: [f64; 2],
    pub(crate) force: [f64; 2],
    pub(crate) bubbles: &'a [f64],
}

impl Coordinates<'_> {
    /// φ at a point, from its row of the trial functions.
    pub(crate) fn rotation(&self, row: &[f64]) -> f64 {
        let (inner, linear) = row.split_at(self.bubbles.len());
        let sum: f64 = inner.iter().zip(self.bubbles).map(|(b, a)| b * a).sum();
        sum + (linear[0] * self.ends[0] + linear[1] * self.ends[1])
    }
}

/// Pivots of the bubbles below this fraction of the bending stiffness call for pivoting: they cost as many digits.
const SMALL_PIVOT: f64 = 1e-2;

/// Buffers for the linearised equations of one beam.
#[derive(Debug)]
pub(crate) struct Element {
    /// Second derivatives by (bubbles, end rotations), symmetric, row-major.
    hessian: Vec<f64>,
    /// First derivatives by (bubbles, end rotations).
    residual: Vec<f64>,
    /// Mixed derivatives by (bubbles, end rotations) and (H, V).
    coupling: Vec<f64>,
    lu: Lu,
    /// Whether the bubbles needed pivoting, so that [`Element::symmetric`] holds nothing.
    pivoted: bool,
    /// Factors of the bubbles' part, `bubbles × bubbles`.
    symmetric: Vec<f64>,
    /// Condensation: bubbles' answer to unit (`φ_A`, `φ_B`, H, V) and to their own residual, five columns.
    answer: Vec<f64>,
    /// Condensed second derivatives by (`φ_A`, `φ_B`, H, V).
    pub(crate) matrix: [[f64; 4]; 4],
    /// Condensed first derivatives by (`φ_A`, `φ_B`, H, V); the last two are the gap without the node displacements.
    pub(crate) gradient: [f64; 4],
}

impl Element {
    pub(crate) fn new(bubbles: usize) -> Self {
        let n = bubbles + 2;
        Self {
            hessian: vec![0.0; n * n],
            residual: vec![0.0; n],
            coupling: vec![0.0; n * 2],
            lu: Lu::new(),
            pivoted: false,
            symmetric: vec![0.0; bubbles * bubbles],
            answer: vec![0.0; bubbles * 5],
            matrix: [[0.0; 4]; 4],
            gradient: [0.0; 4],
        }
    }

    /// Evaluates the beam at `at` and condenses its bubbles.
    ///
    /// # Errors
    /// [`Singular`] if the bubbles alone are at a buckling load to working precision.
    pub(crate) fn linearise(&mut self, basis: &Basis, rest: &RestShape, c: &Constants, at: Coordinates) -> Result<(), Singular> {
        self.integrate(basis, rest, c, at);
        if rest.thickness.is_empty() {
            self.add_bending(c, at);
        } else {
            self.add_varying_bending(basis, rest, c, at);
        }
        self.complete(basis.bubbles);
        self.condense(basis.bubbles, c)
    }

    /// The part under the integral sign, without the bending energy.
    fn integrate(&mut self, basis: &Basis, rest: &RestShape, c: &Constants, at: Coordinates) {
        let n = basis.bubbles + 2;
        self.hessian.fill(0.0);
        self.residual.fill(0.0);
        self.coupling.fill(0.0);
        let [h, v] = at.force;
        let (mut gap, mut compliance) = ([0.0; 2], [0.0; 3]);
        for (point, (weight, row)) in basis.rows().enumerate() {
            let (_, soft_axial, soft_shear) = rest.local(point, c);
            let softness = soft_axial - soft_shear;
            let (sin, cos) = maths::sin_cos(rest.eta[point] + at.rotation(row));
            let (axial, across) = (h * cos + v * sin, v * cos - h * sin);
            let load = across + softness * axial * across;
            let load_slope = softness * (across * across - axial * axial) - axial;
            let by_h = softness * (cos * across - axial * sin) - sin;
            let by_v = softness * (sin * across + axial * cos) + cos;
            let w = weight * c.length;
            for (i, &b) in row.iter().enumerate() {
                self.residual[i] -= w * load * b;
                self.coupling[2 * i] -= w * by_h * b;
                self.coupling[2 * i + 1] -= w * by_v * b;
                let factor = -w * load_slope * b;
                // The lower triangle.
                for (target, other) in self.hessian[i * n..=i * n + i].iter_mut().zip(row) {
                    *target += factor * other;
                }
            }
            gap[0] -= w * (cos - rest.cos[point] + soft_axial * axial * cos - soft_shear * across * sin);
            gap[1] -= w * (sin - rest.sin[point] + soft_axial * axial * sin + soft_shear * across * cos);
            compliance[0] -= w * (soft_axial * cos * cos + soft_shear * sin * sin);
            compliance[1] -= w * softness * sin * cos;
            compliance[2] -= w * (soft_axial * sin * sin + soft_shear * cos * cos);
        }
        self.gradient = [0.0, 0.0, gap[0], gap[1]];
        self.matrix = [[0.0; 4]; 4];
        self.matrix[2][2] = compliance[0];
        self.matrix[2][3] = compliance[1];
        self.matrix[3][2] = compliance[1];
        self.matrix[3][3] = compliance[2];
    }

    fn add_bending(&mut self, c: &Constants, at: Coordinates) {
        let bubbles = at.bubbles.len();
        let n = bubbles + 2;
        for (k, a) in at.bubbles.iter().enumerate() {
            self.hessian[k * n + k] += c.bending;
            self.residual[k] += c.bending * a;
        }
        let (a, b) = (bubbles, bubbles + 1);
        self.hessian[a * n + a] += c.bending;
        self.hessian[b * n + a] -= c.bending;
        self.hessian[b * n + b] += c.bending;
        let moment = c.bending * (at.ends[1] - at.ends[0]);
        self.residual[a] -= moment;
        self.residual[b] += moment;
    }

    /// With a thickness that varies the slopes of the trial functions are no longer orthogonal under the stiffness.
    fn add_varying_bending(&mut self, basis: &Basis, rest: &RestShape, c: &Constants, at: Coordinates) {
        let n = basis.bubbles + 2;
        let mut slopes = vec![0.0; n];
        for (point, weight) in basis.rule.weights().iter().enumerate() {
            let slope = basis.slope(point, &at, &mut slopes);
            let stiffness = c.bending * rest.local(point, c).0 * weight;
            for i in 0..n {
                self.residual[i] += stiffness * slope * slopes[i];
                for j in 0..=i {
                    self.hessian[i * n + j] += stiffness * slopes[i] * slopes[j];
                }
            }
        }
    }

    /// The upper triangle from the lower one.
    fn complete(&mut self, bubbles: usize) {
        let n = bubbles + 2;
        for row in 0..n {
            for column in row + 1..n {
                self.hessian[row * n + column] = self.hessian[column * n + row];
            }
        }
    }

    fn condense(&mut self, bubbles: usize, c: &Constants) -> Result<(), Singular> {
        let n = bubbles + 2;
        for (row, answer) in self.answer.chunks_exact_mut(5).enumerate() {
            answer[..2].copy_from_slice(&self.hessian[row * n + bubbles..(row + 1) * n]);
            answer[2..4].copy_from_slice(&self.coupling[2 * row..2 * row + 2]);
            answer[4] = self.residual[row];
        }
        self.pivoted = !self.factor_symmetric(bubbles, c.bending);
        if self.pivoted {
            self.lu.factor(bubbles, n, &self.hessian)?;
            self.lu.solve_columns(&mut self.answer, 5);
        } else {
            self.solve_symmetric(bubbles);
        }
        for end in 0..2 {
            let row = bubbles + end;
            self.gradient[end] = self.residual[row];
            for other in 0..2 {
                self.matrix[end][other] = self.hessian[row * n + bubbles + other];
                self.matrix[end][2 + other] = self.coupling[2 * row + other];
                self.matrix[2 + other][end] = self.coupling[2 * row + other];
            }
        }
        for (k, answer) in self.answer.chunks_exact(5).enumerate() {
            let left = [self.hessian[k * n + bubbles], self.hessian[k * n + bubbles + 1], self.coupling[2 * k], self.coupling[2 * k + 1]];
            for (i, value) in left.iter().enumerate() {
                for (target, factor) in self.matrix[i].iter_mut().zip(answer) {
                    *target -= value * factor;
                }
                self.gradient[i] -= value * answer[4];
            }
        }
        Ok(())
    }

    /// Factors the bubbles as L·D·Lᵀ without pivoting, rows of L below the diagonal and 1/D on it. Half the work of LU, and safe
    /// as long as no pivot is small against the bending stiffness: `false` leaves it to LU.
    fn factor_symmetric(&mut self, bubbles: usize, bending: f64) -> bool {
        let n = bubbles + 2;
        for row in 0..bubbles {
            let (done, rest) = self.symmetric.split_at_mut(row * bubbles);
            let current = &mut rest[..=row];
            current.copy_from_slice(&self.hessian[row * n..=row * n + row]);
            // current[k] becomes L·D first, then L.
            for k in 0..row {
                let above = &done[k * bubbles..k * bubbles + k];
                let sum: f64 = current[..k].iter().zip(above).map(|(a, b)| a * b).sum();
                current[k] -= sum;
            }
            let mut pivot = current[row];
            for k in 0..row {
                let scaled = current[k] * done[k * bubbles + k];
                pivot -= current[k] * scaled;
                current[k] = scaled;
            }
            // Written so that NaN fails.
            if !(pivot.abs() > SMALL_PIVOT * bending && pivot.is_finite()) {
                return false;
            }
            current[row] = 1.0 / pivot;
        }
        true
    }

    fn solve_symmetric(&mut self, bubbles: usize) {
        for row in 1..bubbles {
            let (done, rest) = self.answer.split_at_mut(row * 5);
            for (factor, x) in self.symmetric[row * bubbles..row * bubbles + row].iter().zip(done.chunks_exact(5)) {
                for j in 0..5 {
                    rest[j] -= factor * x[j];
                }
            }
        }
        for (row, x) in self.answer.chunks_exact_mut(5).enumerate() {
            let inverse = self.symmetric[row * bubbles + row];
            for x in x {
                *x *= inverse;
            }
        }
        for row in (1..bubbles).rev() {
            let (head, rest) = self.answer.split_at_mut(row * 5);
            for (factor, x) in self.symmetric[row * bubbles..row * bubbles + row].iter().zip(head.chunks_exact_mut(5)) {
                for j in 0..5 {
                    x[j] -= factor * rest[j];
                }
            }
        }
    }

    /// Number of negative eigenvalues of the bubbles' second derivatives.
    pub(crate) fn negative_bubbles(&self) -> usize {
        let bubbles = self.residual.len() - 2;
        if self.pivoted {
            inertia(bubbles, bubbles + 2, &self.hessian).negative
        } else {
            (0..bubbles).filter(|k| self.symmetric[k * bubbles + k] < 0.0).count()
        }
    }

    /// Factors by which (`φ_A`, `φ_B`, H, V) and the residual enter −Σ `row_k` `change_k` over the bubbles.
    pub(crate) fn project(&self, row: &[f64]) -> [f64; 5] {
        let mut sum = [0.0; 5];
        for (weight, answer) in row.iter().zip(self.answer.chunks_exact(5)) {
            for (target, value) in sum.iter_mut().zip(answer) {
                *target += weight * value;
            }
        }
        sum
    }

    /// Replaces a right-hand side of the bubbles by their answer to it with ends and force held.
    pub(crate) fn solve_inner(&mut self, rhs: &mut [f64]) {
        if self.pivoted {
            self.lu.solve(rhs);
            return;
        }
        let bubbles = rhs.len();
        for row in 1..bubbles {
            let (done, rest) = rhs.split_at_mut(row);
            let factors = &self.symmetric[row * bubbles..row * bubbles + row];
            rest[0] -= factors.iter().zip(done.iter()).map(|(f, x)| f * x).sum::<f64>();
        }
        for (row, x) in rhs.iter_mut().enumerate() {
            *x *= self.symmetric[row * bubbles + row];
        }
        for row in (1..bubbles).rev() {
            let (head, rest) = rhs.split_at_mut(row);
            for (x, factor) in head.iter_mut().zip(&self.symmetric[row * bubbles..row * bubbles + row]) {
                *x -= factor * rest[0];
            }
        }
    }

    /// Change of the bubbles that goes with a change of (`φ_A`, `φ_B`, H, V); `residual` is 1 for a Newton step, 0 for a tangent.
    pub(crate) fn expand(&self, change: [f64; 4], residual: f64, bubbles: &mut [f64]) {
        for (target, answer) in bubbles.iter_mut().zip(self.answer.chunks_exact(5)) {
            let sum: f64 = answer.iter().zip(&change).map(|(a, c)| a * c).sum();
            *target = -(sum + residual * answer[4]);
        }
    }
}

/// Strain energy, and modes with one more sweep through the equilibrium equation.
///
/// The moment follows from its own differential equation −M' = L q with q interpolated at the quadrature points, instead of from
/// φ': this returns the bubbles solved for, adds those of degree `P + 1 … points + 1`, and makes the end moments those that
/// balance the nodes. `modes` receives as many entries as there are points. With a thickness that varies φ' is not the moment but for a
/// factor, and the bubbles are returned as they are, filled up with zeros.
pub(crate) fn recover(basis: &Basis, rest: &RestShape, c: &Constants, at: Coordinates, modes: &mut Vec<f64>) -> f64 {
    let points = basis.points();
    let mut coefficients = vec![0.0; points + 2];
    let mut slopes = vec![0.0; basis.bubbles + 2];
    let (mut soft_energy, mut varying) = (0.0, 0.0);
    for (point, ((weight, row), p)) in basis.rows().zip(basis.legendre.chunks_exact(points)).enumerate() {
        let (stiffness, soft_axial, soft_shear) = rest.local(point, c);
        let (sin, cos) = maths::sin_cos(rest.eta[point] + at.rotation(row));
        let (axial, across) = (at.force[0] * cos + at.force[1] * sin, at.force[1] * cos - at.force[0] * sin);
        let load = weight * (across + (soft_axial - soft_shear) * axial * across);
        // The last two stay zero: they are beyond the interpolation.
        for (target, value) in coefficients.iter_mut().zip(p) {
            *target += load * value;
        }
        soft_energy += weight * (soft_axial * axial * axial + soft_shear * across * across);
        if !rest.thickness.is_empty() {
            let slope = basis.slope(point, &at, &mut slopes);
            varying += weight * stiffness * slope * slope;
        }
    }
    modes.clear();
    let turn = at.ends[1] - at.ends[0];
    let bending = if rest.thickness.is_empty() {
        let ratio = 0.5 * c.length / c.bending;
        // Σ w q P_j is q_j/(2j+1), which is just what the recurrence ∫P_j = (P_{j+1} − P_{j−1})/(2(2j+1)) needs.
        modes.extend((2..points + 2).map(|k| ratio * (coefficients[k] - coefficients[k - 2]) / root_of(k)));
        turn * turn + at.bubbles.iter().map(|a| a * a).sum::<f64>()
    } else {
        modes.extend_from_slice(at.bubbles);
        modes.resize(points, 0.0);
        varying
    };
    0.5 * (c.bending * bending + c.length * soft_energy)
}
