//! Equilibrium states: what happened to the nodes and inside the beams.

use std::sync::Arc;

use forcewright_base::{
    maths,
    quadrature::{GaussLegendre, legendre_values},
    roots,
};

use crate::{element::root_of, network::Theory, section::Section, shape::Shape};

/// One equilibrium on a path.
#[derive(Debug, Clone)]
pub struct Point {
    /// Value of the control: m, rad, N or N·m after the drive.
    pub control: f64,
    /// Displacement of the driven node along the drive, m, or its rotation, rad.
    pub displacement: f64,
    /// Force of the drive on its node along itself, N, or moment, N·m, so positive where the network pushes back: the derivative by the
    /// displacement of the energy less the work of the dead loads of earlier stages, which are not part of it.
    pub force: f64,
    /// Its derivative by the displacement, N/m or N·m/rad, from the tangent of the equations (no differences); relative accuracy
    /// about 1e-8. Very large at a limit point of the displacement.
    pub stiffness: f64,
    /// Number of independent motions, small and compatible with supports and drive, along which the equilibrium is unstable; 0 if
    /// it is stable. The control is held meanwhile: the displacement under a kinematic drive, so that its motion does not count,
    /// or a dead load, which moves freely.
    ///
    /// Counted as negative eigenvalues of the symmetric tangent of all equations less the number of its multipliers, two per beam.
    pub instability: usize,
    /// On which stretch of the path: the number of limit points of the control passed before.
    pub branch: usize,
    /// Strain energy, J.
    pub energy_j: f64,
    /// The nodes, in the order of the network.
    pub nodes: Vec<NodeState>,
    /// The beams, in the order of the network.
    pub beams: Vec<BeamState>,
    /// All unknowns and bubbles.
    pub(crate) state: Vec<f64>,
    /// The number of the load that it was found under.
    pub(crate) stage: usize,
}

impl Point {
    /// The beam with the largest stress, and that stress; `None` never happens for a point of a path.
    pub fn peak_stress(&self) -> Option<(usize, PeakStress)> {
        let peaks = self.beams.iter().map(BeamState::peak_stress).enumerate();
        // The first of equals, for the same answer everywhere.
        peaks.reduce(|best, next| if next.1.stress_pa > best.1.stress_pa { next } else { best })
    }
}

/// Motion of a node from rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeState {
    /// Displacement, m.
    pub displacement_m: [f64; 2],
    /// Rotation of the beams joined rigidly to it, rad, counter-clockwise, not reduced to one turn; 0 if every joint is a hinge.
    pub rotation_rad: f64,
    /// Force that the outside exerts on the node, N: its support, the drive, loads of earlier stages. 0 on a free node.
    pub force_n: [f64; 2],
    /// Moment that the outside exerts on the node, N·m.
    pub moment_nm: f64,
}

/// A face of a beam, seen along the direction from its start to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// To the left.
    Left,
    /// To the right.
    Right,
}

/// The largest stress of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeakStress {
    /// Its magnitude, Pa.
    pub stress_pa: f64,
    /// Where along the beam, in [0, 1].
    pub u: f64,
    /// On which face; under pure bending both are equal and the one in tension is named.
    pub face: Face,
    /// Whether it is a tension.
    pub tension: bool,
}

/// Accuracy of the place of the largest stress; its value is wrong by the square of this.
const PEAK_TOLERANCE: f64 = 2e-6;
/// How far from an end of a beam, as part of the way to the next sample, tells whether the stress rises.
const INWARDS: f64 = 0.01;

/// The line of a beam at rest.
#[derive(Debug)]
pub(crate) struct BeamLine {
    pub(crate) shape: Shape,
    /// Where it starts, m.
    pub(crate) start_m: [f64; 2],
    /// What lies before and beyond is rigid.
    pub(crate) flexible: [f64; 2],
    /// Places where the thickness is given, if it varies.
    pub(crate) profile: Vec<[f64; 2]>,
}

/// What does not change along a path, of one piece of a beam.
#[derive(Debug)]
pub(crate) struct PieceInfo {
    pub(crate) shape: Shape,
    /// The section, at the mean thickness.
    pub(crate) section: Section,
    /// Thickness at both ends if it varies.
    pub(crate) thickness_m: Option<[f64; 2]>,
    pub(crate) theory: Theory,
    pub(crate) start_m: [f64; 2],
    /// Which part of the beam it is.
    pub(crate) range: [f64; 2],
}

impl PieceInfo {
    /// The section at v in [0, 1] along the piece.
    pub(crate) fn section_at(&self, v: f64) -> Section {
        match self.thickness_m {
            Some([a, b]) => Section { thickness_m: a + (b - a) * v, ..self.section },
            None => self.section,
        }
    }

    /// Stress of the piece bent uniformly by 1 rad, Pa.
    pub(crate) fn stress_unit_pa(&self) -> f64 {
        self.section.bending_stiffness_n_m2() / self.shape.length_m() * self.section.face_stress_per_moment_per_m3()
    }

    /// Place along the piece of a place along the beam, and back.
    pub(crate) fn inner(&self, u: f64) -> f64 {
        let [from, to] = self.range;
        ((u - from) / (to - from)).clamp(0.0, 1.0)
    }

    pub(crate) fn outer(&self, v: f64) -> f64 {
        let [from, to] = self.range;
        from + (to - from) * v
    }
}

/// Constants of the sums over modes.
#[derive(Debug)]
struct Series {
    rule: Arc<GaussLegendre>,
    /// Per mode k: (k − 1)/k of the recurrence, √(2k − 1), and half its inverse.
    terms: Vec<[f64; 3]>,
}

/// Places at which every beam is searched for its largest stress, with the trial functions there.
#[derive(Debug)]
pub(crate) struct Sampling {
    u: Vec<f64>,
    /// Row per place: slopes of the modes.
    slopes: Vec<f64>,
    /// Row per place: values of the modes.
    values: Vec<f64>,
    modes: usize,
    series: Arc<Series>,
}

impl Sampling {
    pub(crate) fn new(modes: usize, rule: Arc<GaussLegendre>) -> Self {
        let u = chebyshev(modes);
        let mut p = vec![0.0; modes + 2];
        let (mut slopes, mut values) = (Vec::new(), Vec::new());
        for &u in &u {
            legendre_values(2.0 * u - 1.0, &mut p);
            slopes.extend((2..modes + 2).map(|k| root_of(k) * p[k - 1]));
            values.extend((2..modes + 2).map(|k| (p[k] - p[k - 2]) / (2.0 * root_of(k))));
        }
        let terms = (2..modes + 2).map(|k| [(k - 1) as f64 / k as f64, root_of(k), 0.5 / root_of(k)]).collect();
        Self { u, slopes, values, modes, series: Arc::new(Series { rule, terms }) }
    }
}

/// One beam in equilibrium. Places u in [0, 1] run along the whole beam at rest.
#[derive(Debug, Clone)]
pub struct BeamState {
    /// Force (H, V) of the part beyond a section on the part before it, N: constant along the beam. Its component along the beam is
    /// positive in tension; the beam pulls its start node by (H, V) and its end node by (−H, −V).
    pub force_n: [f64; 2],
    /// Bending moment at u = 0, N·m; positive where it adds curvature to the left. Where the start of the beam is rigid: at the end of
    /// that part.
    pub start_moment_nm: f64,
    /// Bending moment at u = 1, N·m, likewise.
    pub end_moment_nm: f64,
    /// Rotation of the section at u = 0, rad.
    pub start_rotation_rad: f64,
    /// Rotation of the section at u = 1, rad.
    pub end_rotation_rad: f64,
    pieces: Vec<PieceState>,
    line: Arc<BeamLine>,
    peak: PeakStress,
}

impl BeamState {
    /// `pieces` in the order of the beam, at least one.
    pub(crate) fn new(pieces: Vec<PieceState>, line: Arc<BeamLine>) -> Self {
        let none = PeakStress { stress_pa: -1.0, u: 0.0, face: Face::Left, tension: false };
        let mut peak = none;
        for piece in &pieces {
            if piece.peak.stress_pa > peak.stress_pa {
                peak = PeakStress { u: piece.info.outer(piece.peak.u), ..piece.peak };
            }
        }
        let (first, last) = (pieces.first(), pieces.last());
        Self {
            force_n: first.map_or([0.0; 2], |p| p.force_n),
            start_moment_nm: first.map_or(0.0, |p| p.moment_nm(0.0)),
            end_moment_nm: last.map_or(0.0, |p| p.moment_nm(1.0)),
            start_rotation_rad: first.map_or(0.0, |p| p.ends[0]),
            end_rotation_rad: last.map_or(0.0, |p| p.ends[1]),
            pieces,
            line,
            peak,
        }
    }

    /// Whether this is the beam of that line, and not one of another path.
    pub(crate) fn lies_on(&self, line: &Arc<BeamLine>) -> bool {
        Arc::ptr_eq(&self.line, line)
    }

    pub(crate) fn pieces(&self) -> &[PieceState] {
        &self.pieces
    }

    /// The piece at a place, its number, and the place along it. At a cut: the piece before it.
    pub(crate) fn piece_at(&self, u: f64) -> (usize, &PieceState, f64) {
        let index = self.pieces.partition_point(|p| p.info.range[1] < u).min(self.pieces.len() - 1);
        let piece = &self.pieces[index];
        (index, piece, piece.info.inner(u))
    }

    /// The part of the beam that bends, in u; what lies outside is rigid.
    pub fn flexible(&self) -> [f64; 2] {
        self.line.flexible
    }

    /// Thickness in the plane at u in [0, 1], m; in a rigid part that where it ends.
    pub fn thickness_m(&self, u: f64) -> f64 {
        let (_, piece, v) = self.piece_at(u);
        piece.info.section_at(v).thickness_m
    }

    /// Rotation of the section at u in [0, 1] from rest, rad.
    pub fn rotation_rad(&self, u: f64) -> f64 {
        let (_, piece, v) = self.piece_at(u);
        piece.rotation_and_slope(v).0
    }

    /// Deformed angle θ(u) = η(u) + φ(u), rad.
    pub fn angle_rad(&self, u: f64) -> f64 {
        self.line.shape.angle_at(u.clamp(0.0, 1.0)) + self.rotation_rad(u)
    }

    /// Bending moment M(u) = EI/L dφ/du, N·m; positive where it adds curvature to the left. In a rigid part that where it ends.
    ///
    /// Departure COMP-1 from Lan, Wang & Chen 2010: their eq. (4) lacks the 1/L that their eq. (5) has.
    pub fn moment_nm(&self, u: f64) -> f64 {
        let (_, piece, v) = self.piece_at(u);
        piece.moment_nm(v)
    }

    /// Axial force N(u), N; positive in tension.
    pub fn axial_force_n(&self, u: f64) -> f64 {
        let (sin, cos) = maths::sin_cos(self.angle_rad(u));
        self.force_n[0] * cos + self.force_n[1] * sin
    }

    /// Shear force Q(u), N; the component of the force to the left of the beam.
    pub fn shear_force_n(&self, u: f64) -> f64 {
        let (sin, cos) = maths::sin_cos(self.angle_rad(u));
        self.force_n[1] * cos - self.force_n[0] * sin
    }

    /// Deformed position of the axis at u in [0, 1], m, in the frame of the network.
    pub fn shape_m(&self, u: f64) -> [f64; 2] {
        let u = if u.is_nan() { 0.0 } else { u.clamp(0.0, 1.0) };
        let [from, to] = self.line.flexible;
        let (_, piece, v) = self.piece_at(u);
        let at = piece.shape_m(v);
        if u >= from && u <= to {
            return at;
        }
        // A rigid part turns with the section where it ends.
        let edge = if u < from { from } else { to };
        let (here, there) = (self.line.shape.point_m(u), self.line.shape.point_m(edge));
        let (sin, cos) = maths::sin_cos(self.rotation_rad(edge));
        let [x, y] = [here[0] - there[0], here[1] - there[1]];
        [at[0] + cos * x - sin * y, at[1] + sin * x + cos * y]
    }

    /// From one place of the axis in [0, 1] to another next to it, m: the difference of [`BeamState::shape_m`] at a tenth of the cost. Over a
    /// fortieth of a beam the rule of three points is exact to rounding.
    pub fn step_m(&self, from: f64, to: f64) -> [f64; 2] {
        let [low, high] = self.line.flexible;
        let ((index, piece, start), (other, _, end)) = (self.piece_at(from), self.piece_at(to));
        if index == other && from.min(to) >= low && from.max(to) <= high {
            return piece.step_m([start, end]);
        }
        let [a, b] = [from, to].map(|u| self.shape_m(u));
        [b[0] - a[0], b[1] - a[1]]
    }

    /// Stress along the beam on the left and right face at u, Pa, tension positive: N/A ∓ M w/(2 I). In a rigid part that where it ends.
    ///
    /// Lan, Wang & Chen 2010, eq. (5), which has the bending term only: so has [`Theory::Inextensible`]. The shift of the neutral
    /// axis in strongly curved beams is neglected.
    pub fn stress_pa(&self, u: f64) -> [f64; 2] {
        let (_, piece, v) = self.piece_at(u);
        piece.stress_pa(v)
    }

    /// The largest stress magnitude over both faces and the whole length, ends included.
    pub fn peak_stress(&self) -> PeakStress {
        self.peak
    }

    /// The largest stress magnitude of one face over the whole length, ends included.
    pub fn peak_stress_of_face(&self, face: Face) -> PeakStress {
        let mut best = PeakStress { stress_pa: -1.0, u: 0.0, face, tension: false };
        for piece in &self.pieces {
            let own = piece.peak_of_face(face);
            if own.stress_pa > best.stress_pa {
                best = PeakStress { u: piece.info.outer(own.u), ..own };
            }
        }
        best
    }
}

/// One piece of a beam in equilibrium; places v in [0, 1] run along the piece.
#[derive(Debug, Clone)]
pub(crate) struct PieceState {
    pub(crate) force_n: [f64; 2],
    /// Rotations of its ends, rad.
    pub(crate) ends: [f64; 2],
    /// Amplitudes `a_2`, `a_3`, … of the rotation φ = `φ_A` (1 − v) + `φ_B` v + Σ `a_k` (`P_k` − `P_{k−2}`)/(2 √(2k−1)) with Legendre
    /// polynomials of 2v − 1, rad.
    pub(crate) modes_rad: Vec<f64>,
    start_displacement_m: [f64; 2],
    peak: PeakStress,
    pub(crate) info: Arc<PieceInfo>,
    series: Arc<Series>,
}

/// Raw results for [`PieceState::new`].
pub(crate) struct Solved {
    pub(crate) force_n: [f64; 2],
    pub(crate) ends: [f64; 2],
    pub(crate) modes: Vec<f64>,
    pub(crate) start_displacement_m: [f64; 2],
}

impl PieceState {
    pub(crate) fn new(solved: Solved, info: &Arc<PieceInfo>, sampling: &Sampling) -> Self {
        let mut state = Self {
            force_n: solved.force_n,
            ends: solved.ends,
            modes_rad: solved.modes,
            start_displacement_m: solved.start_displacement_m,
            peak: PeakStress { stress_pa: 0.0, u: 0.0, face: Face::Left, tension: false },
            info: Arc::clone(info),
            series: Arc::clone(&sampling.series),
        };
        state.peak = state.find_peak(sampling);
        state
    }

    /// Rotation φ(v) and its slope dφ/dv, rad.
    pub(crate) fn rotation_and_slope(&self, u: f64) -> (f64, f64) {
        let x = 2.0 * u - 1.0;
        let turn = self.ends[1] - self.ends[0];
        let (mut value, mut slope) = (self.ends[0] + turn * u, turn);
        let (mut before, mut here) = (1.0, x);
        for (a, [ratio, root, half]) in self.modes_rad.iter().zip(&self.series.terms) {
            let next = x * here + ratio * (x * here - before);
            value += a * half * (next - before);
            slope += a * root * here;
            (before, here) = (here, next);
        }
        (value, slope)
    }

    /// EI/L at a place of the given section, N·m.
    fn bending_stiffness_nm(&self, section: &Section) -> f64 {
        section.bending_stiffness_n_m2() / self.info.shape.length_m()
    }

    pub(crate) fn angle_rad(&self, u: f64) -> f64 {
        self.info.shape.angle_at(u) + self.rotation_and_slope(u).0
    }

    pub(crate) fn moment_nm(&self, u: f64) -> f64 {
        self.bending_stiffness_nm(&self.info.section_at(u)) * self.rotation_and_slope(u).1
    }

    pub(crate) fn axial_force_n(&self, u: f64) -> f64 {
        let (sin, cos) = maths::sin_cos(self.angle_rad(u));
        self.force_n[0] * cos + self.force_n[1] * sin
    }

    pub(crate) fn shear_force_n(&self, u: f64) -> f64 {
        let (sin, cos) = maths::sin_cos(self.angle_rad(u));
        self.force_n[1] * cos - self.force_n[0] * sin
    }

    /// Deformed position of the axis, m.
    fn shape_m(&self, u: f64) -> [f64; 2] {
        let start = [0, 1].map(|i| self.info.start_m[i] + self.start_displacement_m[i]);
        self.added(start, [0.0, u], self.series.rule.nodes().iter().copied().zip(self.series.rule.weights().iter().copied()))
    }

    /// From one place to another, m, where they are next to each other.
    fn step_m(&self, range: [f64; 2]) -> [f64; 2] {
        // Gauss–Legendre rule of three points.
        const RULE: [(f64, f64); 3] = [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
        self.added([0.0; 2], range, RULE.into_iter())
    }

    /// A point and the integral of the slope of the axis over a range of u, by a rule on [0, 1].
    fn added(&self, mut point: [f64; 2], [from, to]: [f64; 2], rule: impl Iterator<Item = (f64, f64)>) -> [f64; 2] {
        let length = self.info.shape.length_m() * (to - from);
        for (node, weight) in rule {
            let u = from + node * (to - from);
            let (sin, cos) = maths::sin_cos(self.angle_rad(u));
            let section = self.info.section_at(u);
            let (axial, shear) = match self.info.theory {
                Theory::Inextensible => (0.0, 0.0),
                Theory::Reissner => (1.0 / section.axial_stiffness_n(), 1.0 / section.shear_stiffness_n()),
            };
            let stretch = 1.0 + axial * (self.force_n[0] * cos + self.force_n[1] * sin);
            let slide = shear * (self.force_n[1] * cos - self.force_n[0] * sin);
            point[0] += length * weight * (stretch * cos - slide * sin);
            point[1] += length * weight * (stretch * sin + slide * cos);
        }
        point
    }

    /// Stress on the left and right face, Pa.
    fn stress_pa(&self, u: f64) -> [f64; 2] {
        let (rotation, slope) = self.rotation_and_slope(u);
        self.face_stress(u, rotation, slope)
    }

    fn face_stress(&self, u: f64, rotation: f64, slope: f64) -> [f64; 2] {
        let section = self.info.section_at(u);
        let bending = self.bending_stiffness_nm(&section) * slope * section.face_stress_per_moment_per_m3();
        let axial = match self.info.theory {
            Theory::Inextensible => 0.0,
            Theory::Reissner => {
                let (sin, cos) = maths::sin_cos(self.info.shape.angle_at(u) + rotation);
                (self.force_n[0] * cos + self.force_n[1] * sin) / section.area_m2()
            }
        };
        [axial - bending, axial + bending]
    }

    fn find_peak(&self, sampling: &Sampling) -> PeakStress {
        let count = sampling.u.len();
        let turn = self.ends[1] - self.ends[0];
        let mut samples: [Vec<f64>; 2] = [Vec::with_capacity(count), Vec::with_capacity(count)];
        let dot = |row: &[f64]| -> f64 { row.iter().zip(&self.modes_rad).map(|(r, a)| r * a).sum() };
        let rows = sampling.slopes.chunks_exact(sampling.modes).zip(sampling.values.chunks_exact(sampling.modes));
        for (&u, (slopes, values)) in sampling.u.iter().zip(rows) {
            let bending_only = self.info.theory == Theory::Inextensible;
            let rotation = if bending_only { 0.0 } else { self.ends[0] + turn * u + dot(values) };
            let stress = self.face_stress(u, rotation, turn + dot(slopes));
            samples[0].push(stress[0].abs());
            samples[1].push(stress[1].abs());
        }
        let largest = samples.iter().flatten().fold(0.0_f64, |m, v| m.max(*v));
        let mut best = (0.0, 0.0);
        let faces = if self.info.theory == Theory::Inextensible { 1 } else { 2 };
        for (face, values) in samples.iter().enumerate().take(faces) {
            self.refine_peak(&sampling.u, (face, values), largest, &mut best);
        }
        let [left, right] = self.stress_pa(best.1);
        let face = if left.abs() > right.abs() || (left.abs() >= right.abs() && left > 0.0) { Face::Left } else { Face::Right };
        let tension = if face == Face::Left { left > 0.0 } else { right > 0.0 };
        PeakStress { stress_pa: best.0, u: best.1, face, tension }
    }

    /// Replaces the best stress and its place where a face exceeds it, given its samples at ascending places.
    fn refine_peak(&self, places: &[f64], (face, values): (usize, &[f64]), largest: f64, best: &mut (f64, f64)) {
        let count = places.len();
        for i in 0..count {
            if values[i] < 0.9 * largest {
                continue;
            }
            if values[i] > best.0 {
                *best = (values[i], places[i]);
            }
            let (before, after) = (i.saturating_sub(1), (i + 1).min(count - 1));
            if values[i] < values[before] || values[i] < values[after] {
                continue;
            }
            let stress = |u: f64| self.stress_pa(u)[face].abs();
            if before == i || after == i {
                // An end: the extremum is next to it only if the stress rises inwards.
                let inwards = places[i] + INWARDS * (places[before] + places[after] - 2.0 * places[i]);
                if stress(inwards) <= values[i] {
                    continue;
                }
            }
            let refined = roots::minimise(|u| -stress(u), places[before], places[after], PEAK_TOLERANCE);
            if -refined.value > best.0 {
                *best = (-refined.value, refined.x);
            }
        }
    }

    fn peak_of_face(&self, face: Face) -> PeakStress {
        let side = usize::from(face == Face::Right);
        let places = chebyshev(self.modes_rad.len());
        let values: Vec<f64> = places.iter().map(|u| self.stress_pa(*u)[side].abs()).collect();
        let mut best = (0.0, 0.0);
        self.refine_peak(&places, (side, &values), values.iter().fold(0.0, |m, v| m.max(*v)), &mut best);
        PeakStress { stress_pa: best.0, u: best.1, face, tension: self.stress_pa(best.1)[side] > 0.0 }
    }
}

/// Chebyshev points, more than modes, so that no extremum of their sum falls between two of them unseen.
fn chebyshev(modes: usize) -> Vec<f64> {
    let intervals = modes + modes / 2;
    (0..=intervals).map(|i| 0.5 - 0.5 * maths::cos(std::f64::consts::PI * i as f64 / intervals as f64)).collect()
}
