//! The linearised equations of four beams at once, condensed to their end motions.
//!
//! Same formulation and symbols as `element.rs`; see there. Here the beam forces are eliminated too, which needs each beam to be
//! flexible along both axes: a straight inextensible beam at rest is not, and is left to the general path.

#![allow(clippy::needless_range_loop, reason = "formulas of small matrices are read by their indices")]

use forcewright_base::quadrature::{GaussLegendre, legendre_values};

use super::lanes::{LANES, Lane};
use crate::element::root_of;

/// Pivots below this fraction of the bending stiffness are left to the general path, which pivots.
const SMALL_PIVOT: f64 = 1e-2;
/// Smallest determinant of a beam's flexibility relative to the product of its diagonal.
const SMALL_FLEXIBILITY: f64 = 1e-9;
/// Smallest flexibility relative to L³/EI.
const STIFF: f64 = 1e-12;

/// Trial functions with `M` bubbles (degree `M + 1`) at `Q` quadrature points.
#[derive(Debug)]
pub(crate) struct Tables<const M: usize, const Q: usize> {
    pub(crate) u: [f64; Q],
    pub(crate) weight: [f64; Q],
    bubble: [[f64; Q]; M],
    /// Legendre polynomials of degree M … M + EXTRA + 1, for the modes beyond those solved for.
    legendre: [[f64; Q]; EXTRA + 2],
}

/// Modes beyond those solved for, which one sweep through the moment equation adds: stress is a derivative and needs them.
pub(crate) const EXTRA: usize = 3;

impl<const M: usize, const Q: usize> Tables<M, Q> {
    pub(crate) fn new() -> Self {
        let rule = GaussLegendre::new(Q);
        let mut tables = Self { u: [0.0; Q], weight: [0.0; Q], bubble: [[0.0; Q]; M], legendre: [[0.0; Q]; EXTRA + 2] };
        let mut p = vec![0.0; M + EXTRA + 2];
        for (q, (u, w)) in rule.nodes().iter().zip(rule.weights()).enumerate() {
            (tables.u[q], tables.weight[q]) = (*u, *w);
            legendre_values(2.0 * u - 1.0, &mut p);
            for k in 0..M {
                tables.bubble[k][q] = (p[k + 2] - p[k]) / (2.0 * root_of(k + 2));
            }
            for (j, row) in tables.legendre.iter_mut().enumerate() {
                row[q] = p[M + j];
            }
        }
        tables
    }
}

/// Constants of four beams, dimensionless.
#[derive(Clone, Debug)]
pub(crate) struct Beams<const Q: usize> {
    pub(crate) length: Lane,
    /// EI/L.
    pub(crate) bending: Lane,
    /// 1/EA.
    pub(crate) axial: Lane,
    /// 1/kGA.
    pub(crate) shear: Lane,
    /// Whether any of the four stretches or shears.
    pub(crate) soft: bool,
    /// Direction at rest.
    pub(crate) cos: [Lane; Q],
    pub(crate) sin: [Lane; Q],
}

/// Unknowns of four beams.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unknowns<const M: usize> {
    pub(crate) ends: [Lane; 2],
    pub(crate) force: [Lane; 2],
    pub(crate) bubbles: [Lane; M],
}

impl<const M: usize> Default for Unknowns<M> {
    fn default() -> Self {
        Self { ends: [Lane::ZERO; 2], force: [Lane::ZERO; 2], bubbles: [Lane::ZERO; M] }
    }
}

/// The condensed equations of four beams, and what is needed to find the inner unknowns again.
#[derive(Clone, Debug)]
pub(crate) struct Condensed<const M: usize> {
    /// Second derivatives by (`φ_A`, `φ_B`, `u_A`, `v_A`, `u_B`, `v_B`); of the translations only those of B are stored, A has the
    /// opposite sign.
    pub(crate) rotation: [[Lane; 2]; 2],
    pub(crate) mixed: [[Lane; 2]; 2],
    pub(crate) translation: [[Lane; 2]; 2],
    /// First derivatives by (`φ_A`, `φ_B`) and by the position of B.
    pub(crate) moment: [Lane; 2],
    pub(crate) pull: [Lane; 2],
    /// Bubbles' answer to unit (`φ_A`, `φ_B`, H, V) and to their own residual.
    answer: [[Lane; 5]; M],
    /// Force's answer: −C⁻¹, C⁻¹·K by rotation, and its own change.
    flexibility: [[Lane; 2]; 2],
    by_rotation: [[Lane; 2]; 2],
    /// C⁻¹ r: what closes the gap.
    closing: [Lane; 2],
    /// Amplitudes of the modes `M + 2` … from −M' = L q at the state that was linearised.
    pub(crate) extra: [Lane; EXTRA],
    /// Negative pivots of the bubbles and of the flexibility, per lane.
    pub(crate) negative: [u32; LANES],
}

/// Sums over the quadrature points.
struct Integrals<const M: usize> {
    inner: [[Lane; M]; M],
    /// Bubbles by `φ_A`, `φ_B`, H, V and their residual.
    outer: [[Lane; 5]; M],
    ends: [[Lane; 2]; 2],
    ends_force: [[Lane; 2]; 2],
    ends_residual: [Lane; 2],
    gap: [Lane; 2],
    compliance: [Lane; 3],
    extra: [Lane; EXTRA],
}

/// Why four beams cannot be condensed here.
#[derive(Debug)]
pub(crate) struct NeedsPivoting;

/// Evaluates and condenses four beams. `apart` is the relative displacement `u_B − u_A`.
///
/// # Errors
/// [`NeedsPivoting`] near a buckling load of a beam with held ends, and for beams that are straight and inextensible.
pub(crate) fn linearise<const M: usize, const Q: usize>(
    tables: &Tables<M, Q>,
    beams: &Beams<Q>,
    at: &Unknowns<M>,
    apart: [Lane; 2],
    out: &mut Condensed<M>,
) -> Result<(), NeedsPivoting> {
    let mut integrals = integrate(tables, beams, at);
    condense(&mut integrals, beams, at, apart, out)
}

/// Integrands at the quadrature points, with the weights and −L, and the sums over them that need no trial function.
struct AtPoints<const Q: usize> {
    /// Moment load, its slope by the rotation, and its derivatives by H and V.
    load: [Lane; Q],
    slope: [Lane; Q],
    by_h: [Lane; Q],
    by_v: [Lane; Q],
    gap: [Lane; 2],
    compliance: [Lane; 3],
}

#[inline]
fn at_points<const M: usize, const Q: usize>(tables: &Tables<M, Q>, beams: &Beams<Q>, at: &Unknowns<M>) -> AtPoints<Q> {
    let [h, v] = at.force;
    let turn = at.ends[1] - at.ends[0];
    let softness = beams.axial - beams.shear;
    let zero = Lane::ZERO;
    let (mut load, mut slope, mut by_h, mut by_v) = ([zero; Q], [zero; Q], [zero; Q], [zero; Q]);
    let (mut gap, mut compliance) = ([zero; 2], [zero; 3]);
    for q in 0..Q {
        let mut phi = at.ends[0] + turn * tables.u[q];
        for k in 0..M {
            phi += at.bubbles[k] * tables.bubble[k][q];
        }
        let (sin_phi, cos_phi) = phi.sin_cos();
        let (rest_cos, rest_sin) = (beams.cos[q], beams.sin[q]);
        let cos = rest_cos * cos_phi - rest_sin * sin_phi;
        let sin = rest_sin * cos_phi + rest_cos * sin_phi;
        let w = -(beams.length * tables.weight[q]);
        let (axial, across) = (h * cos + v * sin, v * cos - h * sin);
        let (mut q_load, mut q_slope, mut q_h, mut q_v) = (across, -axial, -sin, cos);
        gap[0] += w * (cos - rest_cos);
        gap[1] += w * (sin - rest_sin);
        if beams.soft {
            q_load += softness * axial * across;
            q_slope += softness * (across * across - axial * axial);
            q_h += softness * (cos * across - axial * sin);
            q_v += softness * (sin * across + axial * cos);
            let (stretch, slide) = (beams.axial * axial, beams.shear * across);
            gap[0] += w * (stretch * cos - slide * sin);
            gap[1] += w * (stretch * sin + slide * cos);
            compliance[0] += w * (beams.axial * cos * cos + beams.shear * sin * sin);
            compliance[1] += w * (softness * sin * cos);
            compliance[2] += w * (beams.axial * sin * sin + beams.shear * cos * cos);
        }
        load[q] = w * q_load;
        slope[q] = w * q_slope;
        by_h[q] = w * q_h;
        by_v[q] = w * q_v;
    }
    AtPoints { load, slope, by_h, by_v, gap, compliance }
}

#[inline]
fn integrate<const M: usize, const Q: usize>(tables: &Tables<M, Q>, beams: &Beams<Q>, at: &Unknowns<M>) -> Integrals<M> {
    let AtPoints { load, slope, by_h, by_v, gap, compliance } = at_points(tables, beams, at);
    let zero = Lane::ZERO;
    let turn = at.ends[1] - at.ends[0];
    let mut sums = Integrals {
        inner: [[zero; M]; M],
        outer: [[zero; 5]; M],
        ends: [[zero; 2]; 2],
        ends_force: [[zero; 2]; 2],
        ends_residual: [zero; 2],
        gap,
        compliance,
        extra: extra_modes(tables, beams, &load),
    };
    for k in 0..M {
        let b = &tables.bubble[k];
        let mut weighted = [zero; Q];
        let mut outer = [zero; 5];
        for q in 0..Q {
            let s = slope[q] * b[q];
            weighted[q] = s;
            outer[1] += s * tables.u[q];
            outer[0] += s;
            outer[2] += by_h[q] * b[q];
            outer[3] += by_v[q] * b[q];
            outer[4] += load[q] * b[q];
        }
        outer[0] -= outer[1];
        outer[4] += beams.bending * at.bubbles[k];
        sums.outer[k] = outer;
        for j in 0..=k {
            let other = &tables.bubble[j];
            let mut sum = zero;
            for q in 0..Q {
                sum += weighted[q] * other[q];
            }
            sums.inner[k][j] = sum;
        }
        sums.inner[k][k] += beams.bending;
    }
    for q in 0..Q {
        let (a, b) = (1.0 - tables.u[q], tables.u[q]);
        sums.ends[0][0] += slope[q] * (a * a);
        sums.ends[1][0] += slope[q] * (a * b);
        sums.ends[1][1] += slope[q] * (b * b);
        for (end, shape) in [a, b].into_iter().enumerate() {
            sums.ends_force[end][0] += by_h[q] * shape;
            sums.ends_force[end][1] += by_v[q] * shape;
            sums.ends_residual[end] += load[q] * shape;
        }
    }
    let moment = beams.bending * turn;
    sums.ends[0][0] += beams.bending;
    sums.ends[1][0] -= beams.bending;
    sums.ends[1][1] += beams.bending;
    sums.ends_residual[0] -= moment;
    sums.ends_residual[1] += moment;
    sums
}

/// As `recover` of the general path, for the first modes beyond those solved for. `load` carries the weights and −L.
fn extra_modes<const M: usize, const Q: usize>(tables: &Tables<M, Q>, beams: &Beams<Q>, load: &[Lane; Q]) -> [Lane; EXTRA] {
    let mut moments = [Lane::ZERO; EXTRA + 2];
    for (sum, row) in moments.iter_mut().zip(&tables.legendre) {
        for q in 0..Q {
            *sum += load[q] * row[q];
        }
    }
    let mut out = [Lane::ZERO; EXTRA];
    for (k, mode) in out.iter_mut().enumerate() {
        *mode = (moments[k] - moments[k + 2]) / beams.bending * (0.5 / root_of(M + 2 + k));
    }
    out
}

/// L·D·Lᵀ of the bubbles in place: rows of L below the diagonal, 1/D on it. Counts negative pivots.
fn factor<const M: usize>(inner: &mut [[Lane; M]; M], bending: Lane, negative: &mut [u32; LANES]) -> Result<(), NeedsPivoting> {
    for row in 0..M {
        for k in 0..row {
            let mut sum = inner[row][k];
            for j in 0..k {
                sum -= inner[row][j] * inner[k][j];
            }
            inner[row][k] = sum;
        }
        let mut pivot = inner[row][row];
        for k in 0..row {
            let scaled = inner[row][k] * inner[k][k];
            pivot -= inner[row][k] * scaled;
            inner[row][k] = scaled;
        }
        if !pivot.abs().all_above(bending * SMALL_PIVOT) {
            return Err(NeedsPivoting);
        }
        for (count, p) in negative.iter_mut().zip(pivot.0) {
            *count += u32::from(p < 0.0);
        }
        inner[row][row] = Lane::splat(1.0) / pivot;
    }
    Ok(())
}

fn solve<const M: usize>(inner: &[[Lane; M]; M], x: &mut [[Lane; 5]; M]) {
    for row in 1..M {
        for k in 0..row {
            for c in 0..5 {
                x[row][c] -= inner[row][k] * x[k][c];
            }
        }
    }
    for row in 0..M {
        for c in 0..5 {
            x[row][c] = x[row][c] * inner[row][row];
        }
    }
    for row in (1..M).rev() {
        for k in 0..row {
            for c in 0..5 {
                x[k][c] -= inner[row][k] * x[row][c];
            }
        }
    }
}

/// The Schur complement by (`φ_A`, `φ_B`, H, V), lower triangle, and the gradient.
#[inline]
fn schur<const M: usize>(sums: &Integrals<M>, answer: &[[Lane; 5]; M]) -> ([[Lane; 4]; 4], [Lane; 4]) {
    let mut s = [[Lane::ZERO; 4]; 4];
    let mut g = [sums.ends_residual[0], sums.ends_residual[1], sums.gap[0], sums.gap[1]];
    s[0][0] = sums.ends[0][0];
    s[1][0] = sums.ends[1][0];
    s[1][1] = sums.ends[1][1];
    for end in 0..2 {
        s[2][end] = sums.ends_force[end][0];
        s[3][end] = sums.ends_force[end][1];
    }
    s[2][2] = sums.compliance[0];
    s[3][2] = sums.compliance[1];
    s[3][3] = sums.compliance[2];
    for k in 0..M {
        for i in 0..4 {
            let left = sums.outer[k][i];
            for j in 0..=i {
                s[i][j] -= left * answer[k][j];
            }
            g[i] -= left * answer[k][4];
        }
    }
    (s, g)
}

fn condense<const M: usize, const Q: usize>(
    sums: &mut Integrals<M>,
    beams: &Beams<Q>,
    at: &Unknowns<M>,
    apart: [Lane; 2],
    out: &mut Condensed<M>,
) -> Result<(), NeedsPivoting> {
    let mut negative = [0; LANES];
    factor(&mut sums.inner, beams.bending, &mut negative)?;
    out.answer = sums.outer;
    solve(&sums.inner, &mut out.answer);
    let (s, g) = schur(sums, &out.answer);
    // Eliminate the force: the flexibility block C is negative definite for a stable beam.
    let (c00, c01, c11) = (s[2][2], s[3][2], s[3][3]);
    let determinant = c00 * c11 - c01 * c01;
    let size = beams.length * beams.length / beams.bending;
    let regular = determinant.abs().all_above((c00 * c11).abs() * SMALL_FLEXIBILITY)
        && c00.abs().all_above(size * STIFF)
        && c11.abs().all_above(size * STIFF);
    if !regular {
        return Err(NeedsPivoting);
    }
    for (lane, count) in negative.iter_mut().enumerate() {
        // Inertia of a symmetric 2 × 2 block.
        *count += if determinant.0[lane] < 0.0 {
            1
        } else if c00.0[lane] < 0.0 {
            2
        } else {
            0
        };
    }
    let inverse = Lane::splat(1.0) / determinant;
    let flexibility = [[c11 * inverse, -(c01 * inverse)], [-(c01 * inverse), c00 * inverse]];
    let coupling = [[s[2][0], s[2][1]], [s[3][0], s[3][1]]];
    let by_rotation = &mut out.by_rotation;
    let mut closing = [Lane::ZERO; 2];
    let gap = [g[2] + apart[0], g[3] + apart[1]];
    for i in 0..2 {
        for j in 0..2 {
            by_rotation[i][j] = flexibility[i][0] * coupling[0][j] + flexibility[i][1] * coupling[1][j];
        }
        closing[i] = flexibility[i][0] * gap[0] + flexibility[i][1] * gap[1];
    }
    let mut rotation = [[s[0][0], s[1][0]], [s[1][0], s[1][1]]];
    let mut moment = [g[0], g[1]];
    for i in 0..2 {
        for j in 0..2 {
            rotation[i][j] -= coupling[0][i] * by_rotation[0][j] + coupling[1][i] * by_rotation[1][j];
        }
        moment[i] -= coupling[0][i] * closing[0] + coupling[1][i] * closing[1];
    }
    // By the position of B: d(force)/du = −C⁻¹, and by rotations −C⁻¹ K.
    out.translation = [[-flexibility[0][0], -flexibility[0][1]], [-flexibility[1][0], -flexibility[1][1]]];
    out.mixed = [[-by_rotation[0][0], -by_rotation[0][1]], [-by_rotation[1][0], -by_rotation[1][1]]];
    out.pull = [at.force[0] - closing[0], at.force[1] - closing[1]];
    out.rotation = rotation;
    out.moment = moment;
    out.flexibility = flexibility;
    out.closing = closing;
    out.extra = sums.extra;
    out.negative = negative;
    Ok(())
}

impl<const M: usize> Default for Condensed<M> {
    fn default() -> Self {
        let (two, four) = ([Lane::ZERO; 2], [[Lane::ZERO; 2]; 2]);
        Self {
            rotation: four,
            mixed: four,
            translation: four,
            moment: two,
            pull: two,
            answer: [[Lane::ZERO; 5]; M],
            flexibility: four,
            by_rotation: four,
            closing: two,
            extra: [Lane::ZERO; EXTRA],
            negative: [0; LANES],
        }
    }
}

impl<const M: usize> Condensed<M> {
    /// The change of the inner unknowns that goes with a change of the ends. `residual` is 1 for a Newton step, 0 for a tangent.
    pub(crate) fn expand(&self, ends: [Lane; 2], apart: [Lane; 2], residual: f64) -> Unknowns<M> {
        let mut change = Unknowns { ends, ..Unknowns::default() };
        for i in 0..2 {
            let f = self.closing[i] * residual
                + self.flexibility[i][0] * apart[0]
                + self.flexibility[i][1] * apart[1]
                + self.by_rotation[i][0] * ends[0]
                + self.by_rotation[i][1] * ends[1];
            change.force[i] = -f;
        }
        for (target, answer) in change.bubbles.iter_mut().zip(&self.answer) {
            let sum = answer[0] * ends[0]
                + answer[1] * ends[1]
                + answer[2] * change.force[0]
                + answer[3] * change.force[1]
                + answer[4] * residual;
            *target = -sum;
        }
        change
    }
}
