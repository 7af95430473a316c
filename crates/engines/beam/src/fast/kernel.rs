//! The linearised equations of four beams at once, condensed to their end motions.
//!
//! Same formulation and symbols as `element.rs`; see there. Here the beam forces are eliminated too, which needs each beam to be
//! flexible along both axes: a straight inextensible beam at rest is not, and is softened a little in the tangent, never in the
//! residual.

#![allow(clippy::needless_range_loop, reason = "formulas of small matrices are read by their indices")]

use forcewright_base::quadrature::{GaussLegendre, legendre_values};

use super::lanes::{LANES, Lane};
use crate::element::root_of;

/// Pivots below this fraction of the bending stiffness are left to the general path, which pivots: elimination loses as many digits.
const SMALL_PIVOT: f64 = 1e-5;
/// A beam whose flexibility has a determinant below this part of its squared trace counts as straight.
const SMALL_FLEXIBILITY: f64 = 1e-9;
/// What is added to the flexibility of a straight beam, as part of its trace: what its tangent is wrong by.
const SOFTENING: f64 = 1e-8;

/// Trial functions with `M` bubbles (degree `M + 1`) at `Q` quadrature points. `E = Q − M` is the number of modes beyond those solved
/// for that one sweep through the moment equation adds: stress is a derivative and needs them.
#[derive(Debug)]
pub(crate) struct Tables<const M: usize, const Q: usize, const E: usize> {
    pub(crate) u: [f64; Q],
    pub(crate) weight: [f64; Q],
    pub(super) place: [Lane; Q],
    /// 2u − 1. This and the following are even or odd about the middle, as the points are: only the first half is read.
    across: [Lane; Q],
    pub(super) bubble: [[Lane; Q]; M],
    /// Legendre polynomials of degree M … Q − 1. That of degree Q is 0 at the points; later ones are beyond the interpolation.
    legendre: [[Lane; Q]; E],
    /// Half of 1/√(2k − 1) of the modes beyond.
    half_root: [f64; E],
}

impl<const M: usize, const Q: usize, const E: usize> Tables<M, Q, E> {
    pub(crate) fn new() -> Self {
        const { assert!(M + E == Q) };
        let rule = GaussLegendre::new(Q);
        let zero = Lane::ZERO;
        let mut tables = Self {
            u: [0.0; Q],
            weight: [0.0; Q],
            place: [zero; Q],
            across: [zero; Q],
            bubble: [[zero; Q]; M],
            legendre: [[zero; Q]; E],
            half_root: std::array::from_fn(|k| 0.5 / root_of(M + 2 + k)),
        };
        let mut p = vec![0.0; Q + 2];
        for (q, (u, w)) in rule.nodes().iter().zip(rule.weights()).enumerate() {
            (tables.u[q], tables.weight[q]) = (*u, *w);
            tables.place[q] = Lane::splat(*u);
            tables.across[q] = Lane::splat(2.0 * u - 1.0);
            legendre_values(2.0 * u - 1.0, &mut p);
            for k in 0..M {
                tables.bubble[k][q] = Lane::splat((p[k + 2] - p[k]) / (2.0 * root_of(k + 2)));
            }
            for (j, row) in tables.legendre.iter_mut().enumerate() {
                row[q] = Lane::splat(p[M + j]);
            }
        }
        tables
    }

    /// Rotation of the sections at the quadrature points.
    #[inline]
    pub(super) fn rotation(&self, at: &Unknowns<M>, q: usize) -> Lane {
        let mut phi = at.ends[0] + (at.ends[1] - at.ends[0]) * self.place[q];
        for k in 0..M {
            phi += at.bubbles[k] * self.bubble[k][q];
        }
        phi
    }

    /// Rotations at all points: the even and the odd part of each pair at once.
    #[inline(always)]
    fn rotations(&self, at: &Unknowns<M>) -> [Lane; Q] {
        let (mean, turn) = ((at.ends[0] + at.ends[1]) * 0.5, (at.ends[1] - at.ends[0]) * 0.5);
        let mut out = [Lane::ZERO; Q];
        for q in 0..Q.div_ceil(2) {
            let (mut even, mut odd) = (mean, turn * self.across[q]);
            for k in 0..M {
                let part = at.bubbles[k] * self.bubble[k][q];
                if is_even(k) {
                    even += part;
                } else {
                    odd += part;
                }
            }
            out[Q - 1 - q] = even - odd;
            out[q] = if 2 * q + 1 == Q { even } else { even + odd };
        }
        out
    }

    /// As `recover` of the general path, for the modes beyond those solved for. `load` carries the weights and −L.
    #[inline(always)]
    pub(super) fn beyond(&self, bending: Lane, load: &[Lane; Q]) -> [Lane; E] {
        let parts = Halves::new(load);
        let mut moments = [Lane::ZERO; E];
        for (j, row) in self.legendre.iter().enumerate() {
            moments[j] = parts.sum(is_even(M + j), row);
        }
        let scale = Lane::splat(1.0) / bending;
        for k in 0..E {
            let difference = if k + 2 < E { moments[k] - moments[k + 2] } else { moments[k] };
            moments[k] = difference * scale * self.half_root[k];
        }
        moments
    }
}

/// Whether bubble `k`, or the Legendre polynomial of degree `k`, is even about the middle.
#[inline]
const fn is_even(k: usize) -> bool {
    k.is_multiple_of(2)
}

/// Numbers at the points as sums and differences of those on both sides of the middle, so that sums with even or odd functions take
/// half the products.
struct Halves<const Q: usize> {
    even: [Lane; Q],
    odd: [Lane; Q],
}

impl<const Q: usize> Halves<Q> {
    #[inline(always)]
    fn new(points: &[Lane; Q]) -> Self {
        let mut halves = Self { even: [Lane::ZERO; Q], odd: [Lane::ZERO; Q] };
        for q in 0..Q / 2 {
            halves.even[q] = points[q] + points[Q - 1 - q];
            halves.odd[q] = points[q] - points[Q - 1 - q];
        }
        if !is_even(Q) {
            halves.even[Q / 2] = points[Q / 2];
        }
        halves
    }

    /// The sum over all points of the product with an even or an odd function.
    #[inline(always)]
    fn sum(&self, even: bool, row: &[Lane; Q]) -> Lane {
        if even { dot::<Q>(&self.even, row, Q.div_ceil(2)) } else { dot::<Q>(&self.odd, row, Q / 2) }
    }

    #[inline(always)]
    fn total(&self) -> Lane {
        total::<Q>(&self.even, Q.div_ceil(2))
    }
}

/// The sum over the load where there is one of its own, else what it is made of.
#[inline(always)]
fn loaded<const Q: usize>(load: Option<&Halves<Q>>, (even, row): (bool, &[Lane; Q]), made: Lane) -> Lane {
    load.map_or(made, |load| load.sum(even, row))
}

#[inline(always)]
fn dot<const Q: usize>(a: &[Lane; Q], b: &[Lane; Q], count: usize) -> Lane {
    let mut sum = a[0] * b[0];
    for q in 1..count {
        sum += a[q] * b[q];
    }
    sum
}

#[inline(always)]
fn total<const Q: usize>(a: &[Lane; Q], count: usize) -> Lane {
    let mut sum = a[0];
    for q in 1..count {
        sum += a[q];
    }
    sum
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
    /// Weights of the points, with −L.
    pub(crate) weight: [Lane; Q],
    /// Direction at rest.
    pub(crate) cos: [Lane; Q],
    pub(crate) sin: [Lane; Q],
}

impl<const Q: usize> Default for Beams<Q> {
    fn default() -> Self {
        let (zero, one) = (Lane::ZERO, Lane::splat(1.0));
        Self { length: one, bending: one, axial: zero, shear: zero, soft: false, weight: [zero; Q], cos: [zero; Q], sin: [zero; Q] }
    }
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

/// Places in [`Condensed::flat`]: second derivatives by (`φ_A`, `φ_B`, x, y), where (x, y) is the position of B relative to A.
pub(crate) const SECOND: [[usize; 4]; 4] = [[0, 1, 3, 4], [1, 2, 5, 6], [3, 5, 7, 8], [4, 6, 8, 9]];
/// Places of the first derivatives by the same.
pub(crate) const FIRST: [usize; 4] = [10, 11, 12, 13];

/// The condensed equations of four beams, and what is needed to find the inner unknowns again.
#[derive(Clone, Debug)]
pub(crate) struct Condensed<const M: usize, const Q: usize> {
    /// Second and first derivatives; see [`SECOND`] and [`FIRST`]. A power of two, so that masked indices need no check.
    pub(crate) flat: [Lane; 16],
    /// L·D·Lᵀ of the bubbles: rows of L below the diagonal, 1/D on it.
    pub(super) inner: [[Lane; M]; M],
    /// D⁻¹L⁻¹ of the bubbles' derivatives by (`φ_A`, `φ_B`, H, V) and of their own residual.
    pub(super) scaled: [[Lane; 5]; M],
    /// Force's answer: −C⁻¹, C⁻¹·K by rotation, and its own change.
    pub(super) flexibility: [[Lane; 2]; 2],
    pub(super) by_rotation: [[Lane; 2]; 2],
    /// C⁻¹ r: what closes the gap.
    closing: [Lane; 2],
    /// The integrands at the state that was linearised.
    pub(crate) points: Points<Q>,
    /// Negative pivots of the bubbles and of the flexibility, per lane.
    pub(crate) negative: [u32; LANES],
    /// The smallest ratio of a pivot to the least that is safe without pivoting. Not necessarily NaN where the state is.
    pub(crate) margin: Lane,
    /// What was added to the flexibility of beams that are straight and inextensible; 0 for others.
    softened: Lane,
    /// Largest rotation at the points.
    pub(crate) widest: Lane,
}

/// Why four beams cannot be condensed here.
#[derive(Debug)]
pub(crate) struct NeedsPivoting;

/// Evaluates and condenses four beams. `apart` is the relative displacement `u_B − u_A`.
///
/// # Errors
/// [`NeedsPivoting`] near a buckling load of a beam with held ends, and, if the tangent must be `exact`, for beams that are straight and
/// inextensible.
#[inline]
pub(crate) fn linearise<const M: usize, const Q: usize, const E: usize>(
    tables: &Tables<M, Q, E>,
    beams: &Beams<Q>,
    at: &Unknowns<M>,
    (apart, exact): ([Lane; 2], bool),
    out: &mut Condensed<M, Q>,
) -> Result<(), NeedsPivoting> {
    condense(tables, beams, at, apart, Lane::sin_cos, out);
    let usable = out.margin.all_above(Lane::splat(1.0)) && !(exact && out.softened != Lane::ZERO);
    if usable { Ok(()) } else { Err(NeedsPivoting) }
}

/// The same with the verdict per lane, in [`Condensed::margin`]. No lane depends on the others, if none does in `sin_cos`.
#[inline(always)]
pub(crate) fn condense<const M: usize, const Q: usize, const E: usize>(
    tables: &Tables<M, Q, E>,
    beams: &Beams<Q>,
    at: &Unknowns<M>,
    apart: [Lane; 2],
    sin_cos: impl Fn(Lane) -> (Lane, Lane),
    out: &mut Condensed<M, Q>,
) {
    out.widest = evaluate(tables, beams, at, sin_cos, &mut out.points);
    out.negative = [0; LANES];
    let mut outer = [[Lane::ZERO; 5]; M];
    let (mut second, mut first) = integrate(tables, beams, at, &out.points, &mut out.inner, &mut outer);
    let smallest = eliminate(&mut out.inner, &mut outer, &mut out.scaled, &mut out.negative);
    out.margin = smallest / (beams.bending * SMALL_PIVOT);
    for (left, right) in outer.iter().zip(&out.scaled) {
        for i in 0..4 {
            for j in 0..=i {
                second[i][j] -= left[i] * right[j];
            }
            first[i] -= left[i] * right[4];
        }
    }
    first[2] += apart[0];
    first[3] += apart[1];
    release(&second, &first, at, out);
}

/// Integrands at the quadrature points, with the weights and −L, and the sums over them that need no trial function.
#[derive(Clone, Debug)]
pub(crate) struct Points<const Q: usize> {
    /// Moment load, its slope by the rotation, and its derivatives by H and V.
    load: [Lane; Q],
    slope: [Lane; Q],
    by_h: [Lane; Q],
    by_v: [Lane; Q],
    gap: [Lane; 2],
    compliance: [Lane; 3],
}

/// Fills in the points; the largest rotation at them.
#[inline(always)]
fn evaluate<const M: usize, const Q: usize, const E: usize>(
    tables: &Tables<M, Q, E>,
    beams: &Beams<Q>,
    at: &Unknowns<M>,
    sin_cos: impl Fn(Lane) -> (Lane, Lane),
    out: &mut Points<Q>,
) -> Lane {
    let [h, v] = at.force;
    let softness = beams.axial - beams.shear;
    let (mut gap, mut compliance) = ([Lane::ZERO; 2], [Lane::ZERO; 3]);
    let rotations = tables.rotations(at);
    let mut widest = Lane::ZERO;
    for q in 0..Q {
        widest = widest.max(rotations[q].abs());
        let (sin_phi, cos_phi) = sin_cos(rotations[q]);
        let (rest_cos, rest_sin) = (beams.cos[q], beams.sin[q]);
        let cos = rest_cos * cos_phi - rest_sin * sin_phi;
        let sin = rest_sin * cos_phi + rest_cos * sin_phi;
        let w = beams.weight[q];
        gap[0] += w * (cos - rest_cos);
        gap[1] += w * (sin - rest_sin);
        if beams.soft {
            let (axial, across) = (h * cos + v * sin, v * cos - h * sin);
            let q_load = across + softness * axial * across;
            let q_slope = softness * (across * across - axial * axial) - axial;
            let q_h = softness * (cos * across - axial * sin) - sin;
            let q_v = softness * (sin * across + axial * cos) + cos;
            let (stretch, slide) = (beams.axial * axial, beams.shear * across);
            gap[0] += w * (stretch * cos - slide * sin);
            gap[1] += w * (stretch * sin + slide * cos);
            compliance[0] += w * (beams.axial * cos * cos + beams.shear * sin * sin);
            compliance[1] += w * (softness * sin * cos);
            compliance[2] += w * (beams.axial * sin * sin + beams.shear * cos * cos);
            (out.load[q], out.slope[q], out.by_h[q], out.by_v[q]) = (w * q_load, w * q_slope, w * q_h, w * q_v);
        } else {
            let (by_h, by_v) = (-(w * sin), w * cos);
            (out.load[q], out.slope[q], out.by_h[q], out.by_v[q]) = (h * by_h + v * by_v, v * by_h - h * by_v, by_h, by_v);
        }
    }
    (out.gap, out.compliance) = (gap, compliance);
    widest
}

/// Second derivatives: bubbles by bubbles, lower triangle, in `inner`; by `φ_A`, `φ_B`, H, V and their residual in `outer`. Returns the
/// second derivatives by (`φ_A`, `φ_B`, H, V), lower triangle, and the first, with the bubbles held.
#[inline(always)]
fn integrate<const M: usize, const Q: usize, const E: usize>(
    tables: &Tables<M, Q, E>,
    beams: &Beams<Q>,
    at: &Unknowns<M>,
    points: &Points<Q>,
    inner: &mut [[Lane; M]; M],
    outer: &mut [[Lane; 5]; M],
) -> ([[Lane; 4]; 4], [Lane; 4]) {
    let ([h, v], half, b, zero) = (at.force, Q / 2, beams.bending, Lane::ZERO);
    let slope = Halves::new(&points.slope);
    let (by_h, by_v) = (Halves::new(&points.by_h), Halves::new(&points.by_v));
    // Where nothing stretches, the load is a combination of the other two, and so are its sums.
    let load = if beams.soft { Some(Halves::new(&points.load)) } else { None };
    let (mut even, mut odd) = ([zero; Q], [zero; Q]);
    for k in 0..M {
        let (own, is_even) = (&tables.bubble[k], is_even(k));
        for q in 0..half {
            even[q] = slope.even[q] * own[q];
            odd[q] = slope.odd[q] * own[q];
        }
        if 2 * half < Q {
            even[half] = slope.even[half] * own[half];
        }
        // The bubble's own parity decides which products survive.
        let (all, lean) = if is_even {
            (total::<Q>(&even, Q.div_ceil(2)), dot::<Q>(&odd, &tables.across, half))
        } else {
            (total::<Q>(&odd, half), dot::<Q>(&even, &tables.across, half))
        };
        let (h_sum, v_sum) = (by_h.sum(is_even, own), by_v.sum(is_even, own));
        outer[k] = [
            (all - lean) * 0.5,
            (all + lean) * 0.5,
            h_sum,
            v_sum,
            loaded(load.as_ref(), (is_even, own), h * h_sum + v * v_sum) + b * at.bubbles[k],
        ];
        for j in 0..=k {
            let other = &tables.bubble[j];
            inner[k][j] = if (k + j).is_multiple_of(2) { dot::<Q>(&even, other, Q.div_ceil(2)) } else { dot::<Q>(&odd, other, half) };
        }
        inner[k][k] += b;
    }
    // Sums with 1, 2u − 1 and its square.
    let (mut s, x) = ([slope.total(), slope.sum(false, &tables.across), zero], &tables.across);
    for q in 0..half {
        s[2] += slope.even[q] * x[q] * x[q];
    }
    let (h0, h1, v0, v1) = (by_h.total(), by_h.sum(false, x), by_v.total(), by_v.sum(false, x));
    let l0 = if let Some(load) = &load { load.total() } else { h * h0 + v * v0 };
    let l1 = loaded(load.as_ref(), (false, x), h * h1 + v * v1);
    let moment = b * (at.ends[1] - at.ends[0]);
    let mut second = [[zero; 4]; 4];
    second[0][0] = (s[0] - s[1] * 2.0 + s[2]) * 0.25 + b;
    second[1][0] = (s[0] - s[2]) * 0.25 - b;
    second[1][1] = (s[0] + s[1] * 2.0 + s[2]) * 0.25 + b;
    second[2] = [(h0 - h1) * 0.5, (h0 + h1) * 0.5, points.compliance[0], zero];
    second[3] = [(v0 - v1) * 0.5, (v0 + v1) * 0.5, points.compliance[1], points.compliance[2]];
    (second, [(l0 - l1) * 0.5 - moment, (l0 + l1) * 0.5 + moment, points.gap[0], points.gap[1]])
}

/// L·D·Lᵀ of the bubbles in place, and the first half of the solution for five right-hand sides: `outer` becomes L⁻¹ of itself, `scaled`
/// D⁻¹ of that. Counts negative pivots; returns the size of the smallest pivot.
#[inline(always)]
fn eliminate<const M: usize>(
    inner: &mut [[Lane; M]; M],
    outer: &mut [[Lane; 5]; M],
    scaled: &mut [[Lane; 5]; M],
    negative: &mut [u32; LANES],
) -> Lane {
    let mut smallest = Lane::splat(f64::INFINITY);
    for row in 0..M {
        for k in 0..row {
            let mut sum = inner[row][k];
            for j in 0..k {
                sum -= inner[row][j] * inner[k][j];
            }
            inner[row][k] = sum;
        }
        let mut pivot = inner[row][row];
        let mut right = outer[row];
        for k in 0..row {
            let factor = inner[row][k] * inner[k][k];
            pivot -= inner[row][k] * factor;
            inner[row][k] = factor;
            for c in 0..5 {
                right[c] -= factor * outer[k][c];
            }
        }
        smallest = smallest.min(pivot.abs());
        for (count, p) in negative.iter_mut().zip(pivot.0) {
            *count += u32::from(p < 0.0);
        }
        let inverse = Lane::splat(1.0) / pivot;
        inner[row][row] = inverse;
        outer[row] = right;
        for c in 0..5 {
            scaled[row][c] = right[c] * inverse;
        }
    }
    smallest
}

/// Eliminates the force: the flexibility block C is negative definite for a stable beam.
#[inline(always)]
fn release<const M: usize, const Q: usize>(s: &[[Lane; 4]; 4], g: &[Lane; 4], at: &Unknowns<M>, out: &mut Condensed<M, Q>) {
    let (c00, c01, c11) = (s[2][2], s[3][2], s[3][3]);
    let trace = c00 + c11;
    let straight = trace * trace * SMALL_FLEXIBILITY - (c00 * c11 - c01 * c01).abs();
    let softening = Lane::where_above(straight, Lane::ZERO, trace * SOFTENING, Lane::ZERO);
    out.softened = softening.abs();
    let (c00, c11) = (c00 + softening, c11 + softening);
    let determinant = c00 * c11 - c01 * c01;
    // Written so that NaN fails.
    out.margin = Lane::where_above(determinant.abs(), Lane::ZERO, out.margin, Lane::ZERO);
    for (lane, count) in out.negative.iter_mut().enumerate() {
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
    let across = -(c01 * inverse);
    let f = [[c11 * inverse, across], [across, c00 * inverse]];
    let (h, v) = ([s[2][0], s[2][1]], [s[3][0], s[3][1]]);
    let (mut by, mut closing) = ([[Lane::ZERO; 2]; 2], [Lane::ZERO; 2]);
    for i in 0..2 {
        for j in 0..2 {
            by[i][j] = f[i][0] * h[j] + f[i][1] * v[j];
        }
        closing[i] = f[i][0] * g[2] + f[i][1] * g[3];
    }
    let turned = |i: usize, j: usize| s[i][j] - h[i] * by[0][j] - v[i] * by[1][j];
    let moment = |i: usize| g[i] - h[i] * closing[0] - v[i] * closing[1];
    // By the position of B: d(force)/du = −C⁻¹, and by rotations −C⁻¹ K.
    out.flat = [
        turned(0, 0),
        turned(1, 0),
        turned(1, 1),
        -by[0][0],
        -by[1][0],
        -by[0][1],
        -by[1][1],
        -f[0][0],
        -f[0][1],
        -f[1][1],
        moment(0),
        moment(1),
        at.force[0] - closing[0],
        at.force[1] - closing[1],
        Lane::ZERO,
        Lane::ZERO,
    ];
    (out.flexibility, out.by_rotation, out.closing) = (f, by, closing);
}

impl<const M: usize, const Q: usize> Default for Condensed<M, Q> {
    fn default() -> Self {
        let (zero, two, four, points) = (Lane::ZERO, [Lane::ZERO; 2], [[Lane::ZERO; 2]; 2], [Lane::ZERO; Q]);
        Self {
            flat: [zero; 16],
            inner: [[zero; M]; M],
            scaled: [[zero; 5]; M],
            flexibility: four,
            by_rotation: four,
            closing: two,
            points: Points { load: points, slope: points, by_h: points, by_v: points, gap: two, compliance: [zero; 3] },
            negative: [0; LANES],
            margin: zero,
            softened: zero,
            widest: zero,
        }
    }
}

impl<const M: usize, const Q: usize> Condensed<M, Q> {
    /// The change of the inner unknowns that goes with a change of the ends. `residual` is 1 for a Newton step, 0 for a tangent.
    #[inline(always)]
    pub(crate) fn expand(&self, ends: [Lane; 2], apart: [Lane; 2], residual: f64) -> Unknowns<M> {
        let (mut force, mut bubbles) = ([Lane::ZERO; 2], [Lane::ZERO; M]);
        for i in 0..2 {
            force[i] = -(self.closing[i] * residual
                + self.flexibility[i][0] * apart[0]
                + self.flexibility[i][1] * apart[1]
                + self.by_rotation[i][0] * ends[0]
                + self.by_rotation[i][1] * ends[1]);
        }
        for k in 0..M {
            let s = &self.scaled[k];
            bubbles[k] = -(s[0] * ends[0] + s[1] * ends[1] + s[2] * force[0] + s[3] * force[1] + s[4] * residual);
        }
        for row in (1..M).rev() {
            let value = bubbles[row];
            for k in 0..row {
                bubbles[k] -= self.inner[row][k] * value;
            }
        }
        Unknowns { ends, force, bubbles }
    }

    /// The modes beyond those solved for at the state that was linearised, and their change along a change of that state.
    #[inline(always)]
    pub(crate) fn beyond<const E: usize>(&self, tables: &Tables<M, Q, E>, bending: Lane, change: &Unknowns<M>) -> ([Lane; E], [Lane; E]) {
        let p = &self.points;
        let (mut along, rotations) = ([Lane::ZERO; Q], tables.rotations(change));
        for q in 0..Q {
            along[q] = p.slope[q] * rotations[q] + p.by_h[q] * change.force[0] + p.by_v[q] * change.force[1];
        }
        (tables.beyond(bending, &p.load), tables.beyond(bending, &along))
    }
}

/// Derivatives of the Lagrangian of four beams by their constants at a state, and their change along a change of the state: see
/// `gradient/field.rs`. All but those by the angle coefficients are logarithmic. Each has the value first, then the change.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contraction {
    /// By the length with the next three held.
    pub(crate) length: [Lane; 2],
    /// By EI/L.
    pub(crate) bending: [Lane; 2],
    /// By 1/EA.
    pub(crate) axial: [Lane; 2],
    /// By 1/kGA.
    pub(crate) shear: [Lane; 2],
    /// By `c_0`, `c_1`, …
    pub(crate) angles: Vec<[Lane; 2]>,
}

impl Contraction {
    /// `coefficients` is the largest number of angle coefficients of the four beams.
    pub(crate) fn contract<const M: usize, const Q: usize, const E: usize>(
        &mut self,
        tables: &Tables<M, Q, E>,
        beams: &Beams<Q>,
        (at, change): (&Unknowns<M>, &Unknowns<M>),
        coefficients: usize,
    ) {
        let two = [Lane::ZERO; 2];
        (self.length, self.axial, self.shear) = (two, two, two);
        self.angles.clear();
        self.angles.resize(coefficients, two);
        let (turn, d_turn) = (at.ends[1] - at.ends[0], change.ends[1] - change.ends[0]);
        let mut bending = [turn * turn, turn * d_turn];
        for (a, d) in at.bubbles.iter().zip(&change.bubbles) {
            bending[0] += *a * *a;
            bending[1] += *a * *d;
        }
        self.bending = [beams.bending * bending[0] * 0.5, beams.bending * bending[1]];
        let ([h, v], [dh, dv]) = (at.force, change.force);
        let softness = beams.axial - beams.shear;
        for q in 0..Q {
            let (sin_phi, cos_phi) = tables.rotation(at, q).sin_cos();
            let turn = tables.rotation(change, q);
            let (rest_cos, rest_sin) = (beams.cos[q], beams.sin[q]);
            let cos = rest_cos * cos_phi - rest_sin * sin_phi;
            let sin = rest_sin * cos_phi + rest_cos * sin_phi;
            let w = beams.weight[q];
            let (axial, across) = (h * cos + v * sin, v * cos - h * sin);
            let (by_t, by_n) = (dh * cos + dv * sin, dv * cos - dh * sin);
            let mut length = [axial - (h * rest_cos + v * rest_sin), by_t - (dh * rest_cos + dv * rest_sin) + across * turn];
            let mut angle = [across - (v * rest_cos - h * rest_sin), by_n - axial * turn - (dv * rest_cos - dh * rest_sin)];
            if beams.soft {
                let (d_axial, d_across) = (across * turn + by_t, by_n - axial * turn);
                let (n, s) = (beams.axial * axial, beams.shear * across);
                let (stretch, slide) = ([n * axial * 0.5, n * d_axial], [s * across * 0.5, s * d_across]);
                let product = [axial * across, d_axial * across + axial * d_across];
                for i in 0..2 {
                    self.axial[i] += w * stretch[i];
                    self.shear[i] += w * slide[i];
                    length[i] += stretch[i] + slide[i];
                    angle[i] += softness * product[i];
                }
            }
            let mut power = [w * angle[0], w * angle[1]];
            for sum in &mut self.angles {
                for i in 0..2 {
                    sum[i] += power[i];
                    power[i] = power[i] * tables.place[q];
                }
            }
            for i in 0..2 {
                self.length[i] += w * length[i];
            }
        }
    }
}
