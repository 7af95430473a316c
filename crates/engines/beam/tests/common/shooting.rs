//! A second formulation of the same equilibria: multiple shooting through a whole network.
//!
//! Nothing is shared with the engine but the description of the network. Each beam is integrated from its start by the equations of
//! E. Reissner (ZAMP 23, 1972), as initial values, with the extrapolated midpoint rule of W. B. Gragg (SIAM J. Numer. Anal. 2, 1965); the
//! motions of the nodes, the unknown start values, and the states at breaks inside long beams are found by Newton's method on joint
//! equilibrium and closure. The engine is a Ritz method with multipliers: polynomials, no integration along a beam.

use forcewright_base::{dense::Lu, maths};
use forcewright_beam::{Beam, Drive, Joint, Network, Point, Support, Theory};

use super::unit;

/// Rotation, moment, x and y, each followed by its derivatives by start rotation, start moment, H and V.
type Flow = [[f64; 5]; 4];

/// Most growth of a disturbance within one segment, as the logarithm: `√(F L²/EI)`.
const GROWTH: f64 = 5.0;
/// Phase that one extrapolated step covers, rad.
const PHASE: f64 = 0.5;
/// Beams pulled straight need too many segments.
const MOST_UNKNOWNS: usize = 800;
const STAGES: [u32; 6] = [2, 4, 6, 8, 10, 12];

/// One equilibrium by shooting, SI.
#[derive(Debug, Clone)]
pub(crate) struct Shot {
    /// Along the drive.
    pub(crate) displacement: f64,
    /// Along the drive.
    pub(crate) force: f64,
    /// Per beam: force of the part beyond a section on the part before it.
    pub(crate) beam_force_n: Vec<[f64; 2]>,
    /// Per beam: bending moment at its start.
    pub(crate) start_moment_nm: Vec<f64>,
    /// Size of the last correction, dimensionless.
    pub(crate) last_correction: f64,
    /// Corrections made.
    pub(crate) iterations: u32,
}

/// Dimensionless constants of a beam and the places of its unknowns.
struct Part<'a> {
    beam: &'a Beam,
    length: f64,
    bending: f64,
    axial: f64,
    shear: f64,
    /// First unknown: rotation, moment, H, V; then four for each break.
    first: usize,
    segments: usize,
    steps: usize,
}

/// How a node moves: a fixed part (of a prescribed drive), unknowns with directions, and its rotation.
#[derive(Default)]
struct Motion {
    prescribed: [f64; 2],
    translations: Vec<(usize, [f64; 2])>,
    rotation: Option<usize>,
    prescribed_rotation: f64,
}

pub(crate) struct Shooting<'a> {
    network: &'a Network,
    length_m: f64,
    force_n: f64,
    parts: Vec<Part<'a>>,
    motions: Vec<Motion>,
    unknowns: usize,
    /// Load of a force or moment drive, dimensionless.
    load: f64,
}

/// The first whole number above, at most a million.
fn counted(value: f64) -> usize {
    (1..1_000_000).find(|n| *n as f64 > value).unwrap_or(1_000_000)
}

fn turns(network: &Network, node: usize) -> bool {
    let rigid = |j: Joint| j == Joint::Rigid;
    network.beams.iter().any(|b| (b.start == node && rigid(b.start_joint)) || (b.end == node && rigid(b.end_joint)))
}

impl<'a> Shooting<'a> {
    /// The equations at the control of a point; `point` sets how finely beams are divided.
    pub(crate) fn new(network: &'a Network, theory: Theory, point: &Point) -> Self {
        let length_m = network.beams.iter().map(|b| b.shape.length_m()).fold(0.0, f64::max);
        let stiffness = network.beams.iter().map(|b| b.section.bending_stiffness_n_m2()).fold(0.0, f64::max);
        let force_n = stiffness / (length_m * length_m);
        let mut system = Self { network, length_m, force_n, parts: Vec::new(), motions: Vec::new(), unknowns: 0, load: 0.0 };
        system.number_nodes(point.control);
        for (beam, state) in network.beams.iter().zip(&point.beams) {
            let soft = |s: f64| if theory == Theory::Reissner { force_n / s } else { 0.0 };
            let (length, bending) = (beam.shape.length_m() / length_m, beam.section.bending_stiffness_n_m2() / stiffness);
            let force = maths::hypot(state.force_n[0], state.force_n[1]) / force_n;
            let growth = length * (force / bending).sqrt();
            let bends = beam.shape.angle_rad().iter().enumerate().map(|(k, c)| k as f64 * c.abs()).sum::<f64>();
            let segments = counted(growth.min(1e6) / GROWTH);
            let steps = counted((growth + bends) / (PHASE * segments as f64));
            let (axial, shear) = (soft(beam.section.axial_stiffness_n()), soft(beam.section.shear_stiffness_n()));
            system.parts.push(Part { beam, length, bending, axial, shear, first: system.unknowns, segments, steps });
            system.unknowns += 4 * segments;
        }
        system
    }

    fn number_nodes(&mut self, control: f64) {
        let drive = self.network.drive;
        let turning = matches!(drive, Drive::Rotation { .. } | Drive::Moment { .. });
        let scale = match (drive.is_kinematic(), turning) {
            (true, true) => 1.0,
            (true, false) => self.length_m,
            (false, true) => self.force_n * self.length_m,
            (false, false) => self.force_n,
        };
        let control = control / scale;
        self.load = if drive.is_kinematic() { 0.0 } else { control };
        for (index, node) in self.network.nodes.iter().enumerate() {
            let driven = drive.is_kinematic() && drive.node() == index;
            let direction = match drive {
                Drive::Displacement { direction, .. } if driven => Some(unit(direction)),
                _ => None,
            };
            let mut motion = Motion::default();
            let mut free = |along: [f64; 2], count: &mut usize| {
                motion.translations.push((*count, along));
                *count += 1;
            };
            match (node.support, direction) {
                (Support::Free | Support::Parallel, None) => {
                    free([1.0, 0.0], &mut self.unknowns);
                    free([0.0, 1.0], &mut self.unknowns);
                }
                (Support::Free | Support::Parallel, Some(d)) => {
                    free([-d[1], d[0]], &mut self.unknowns);
                    motion.prescribed = d.map(|d| control * d);
                }
                (Support::Slider { direction, .. }, None) => free(unit(direction), &mut self.unknowns),
                (Support::Slider { direction, .. }, Some(d)) => {
                    let s = unit(direction);
                    motion.prescribed = s.map(|along| control * along / (s[0] * d[0] + s[1] * d[1]));
                }
                (Support::Clamped | Support::Pinned, _) => {}
            }
            if turns(self.network, index) && !node.support.holds_rotation() {
                if driven && turning {
                    motion.prescribed_rotation = control;
                } else {
                    motion.rotation = Some(self.unknowns);
                    self.unknowns += 1;
                }
            }
            self.motions.push(motion);
        }
    }

    /// The unknowns as a point of a path has them.
    fn guess(&self, point: &Point) -> Vec<f64> {
        let mut x = vec![0.0; self.unknowns];
        for (motion, state) in self.motions.iter().zip(&point.nodes) {
            for (place, along) in &motion.translations {
                x[*place] = (state.displacement_m[0] * along[0] + state.displacement_m[1] * along[1]) / self.length_m;
            }
            if let Some(place) = motion.rotation {
                x[place] = state.rotation_rad;
            }
        }
        let moment = self.force_n * self.length_m;
        for (part, state) in self.parts.iter().zip(&point.beams) {
            let start = [state.start_rotation_rad, state.start_moment_nm / moment];
            x[part.first..part.first + 2].copy_from_slice(&start);
            x[part.first + 2] = state.force_n[0] / self.force_n;
            x[part.first + 3] = state.force_n[1] / self.force_n;
            for k in 1..part.segments {
                let u = k as f64 / part.segments as f64;
                let place = state.shape_m(u).map(|p| p / self.length_m);
                let inside = [state.rotation_rad(u), state.moment_nm(u) / moment, place[0], place[1]];
                x[part.first + 4 * k..part.first + 4 * k + 4].copy_from_slice(&inside);
            }
        }
        x
    }

    /// Newton's method from a point that is made wrong by about a millionth.
    pub(crate) fn solve(&self, point: &Point) -> Option<Shot> {
        if self.unknowns > MOST_UNKNOWNS {
            return None;
        }
        let mut x = self.guess(point);
        for (i, v) in x.iter_mut().enumerate() {
            *v += 1e-6 * v.abs().max(1e-2) * if i % 2 == 0 { 1.0 } else { -1.0 };
        }
        let mut lu = Lu::new();
        let (mut residual, mut matrix) = (vec![0.0; self.unknowns], vec![0.0; self.unknowns * self.unknowns]);
        let mut last = f64::INFINITY;
        for iterations in 1..=14 {
            self.assemble(&x, &mut residual, &mut matrix);
            lu.factor(self.unknowns, self.unknowns, &matrix).ok()?;
            lu.solve(&mut residual);
            let mut size = 0.0_f64;
            for (v, r) in x.iter_mut().zip(&residual) {
                size = size.max(r.abs() / (1.0 + v.abs()));
                *v -= r;
            }
            // Forces along nearly straight beams are far off at first.
            if size.is_nan() || size > 1e4 {
                return None;
            }
            // Quadratic until rounding, which stays.
            if size < 1e-13 || (size < 1e-9 && size > 0.1 * last) {
                return Some(self.shot(&x, size, iterations));
            }
            last = size;
        }
        None
    }

    fn node_state(&self, node: usize, x: &[f64]) -> ([f64; 2], f64) {
        let motion = &self.motions[node];
        let mut moved = motion.prescribed;
        for (place, along) in &motion.translations {
            moved[0] += x[*place] * along[0];
            moved[1] += x[*place] * along[1];
        }
        (moved, motion.rotation.map_or(motion.prescribed_rotation, |r| x[r]))
    }

    /// Residual and Jacobian. Equations of nodes first, in the order of their unknowns; then those of the beams.
    fn assemble(&self, x: &[f64], residual: &mut [f64], matrix: &mut [f64]) {
        residual.fill(0.0);
        matrix.fill(0.0);
        let n = self.unknowns;
        self.add_load(residual);
        for part in &self.parts {
            let ends = [part.beam.start, part.beam.end];
            let rest = ends.map(|i| self.network.nodes[i].position_m.map(|p| p / self.length_m));
            let motion = ends.map(|i| self.node_state(i, x));
            let start = [x[part.first], x[part.first + 1], rest[0][0] + motion[0].0[0], rest[0][1] + motion[0].0[1]];
            let force = [x[part.first + 2], x[part.first + 3]];
            let mut state = start;
            for k in 0..part.segments {
                let flow = part.integrate(k, state, force);
                let row = part.first + 4 * k;
                let last = k + 1 == part.segments;
                let target = if last {
                    [motion[1].1, 0.0, rest[1][0] + motion[1].0[0], rest[1][1] + motion[1].0[1]]
                } else {
                    [0, 1, 2, 3].map(|i| x[row + 4 + i])
                };
                for i in 0..4 {
                    // The last row of a beam's rotation and moment is one of the two, and makes room for the condition at the start.
                    if last && i == usize::from(part.beam.end_joint == Joint::Rigid) {
                        continue;
                    }
                    let equation = row + i;
                    residual[equation] = flow[i][0] - target[i];
                    let entries = &mut matrix[equation * n..(equation + 1) * n];
                    entries[row] += flow[i][1];
                    entries[row + 1] += flow[i][2];
                    entries[part.first + 2] += flow[i][3];
                    entries[part.first + 3] += flow[i][4];
                    if i >= 2 {
                        self.add_place(entries, if k == 0 { Ok(part.beam.start) } else { Err(row + i) }, i - 2, 1.0);
                    }
                    if !last {
                        entries[row + 4 + i] -= 1.0;
                    } else if i >= 2 {
                        self.add_place(entries, Ok(part.beam.end), i - 2, -1.0);
                    } else if i == 0
                        && let Some(r) = self.motions[part.beam.end].rotation
                    {
                        entries[r] -= 1.0;
                    }
                }
                if last {
                    self.start_condition(part, x, motion[0].1, residual, matrix);
                    self.pull_nodes(part, x, &flow, residual, matrix);
                } else {
                    state = target;
                }
            }
        }
    }

    /// The derivative of a coordinate by the unknowns behind it: the motion of a node, or the unknown itself.
    fn add_place(&self, entries: &mut [f64], from: Result<usize, usize>, axis: usize, sign: f64) {
        match from {
            Ok(node) => {
                for (place, along) in &self.motions[node].translations {
                    entries[*place] += sign * along[axis];
                }
            }
            Err(unknown) => entries[unknown] += sign,
        }
    }

    /// In the row left free: the start turns with its node, or carries no moment.
    fn start_condition(&self, part: &Part, x: &[f64], rotation: f64, residual: &mut [f64], matrix: &mut [f64]) {
        let equation = part.first + 4 * (part.segments - 1) + usize::from(part.beam.end_joint == Joint::Rigid);
        let entries = &mut matrix[equation * self.unknowns..(equation + 1) * self.unknowns];
        if part.beam.start_joint == Joint::Hinged {
            residual[equation] = x[part.first + 1];
            entries[part.first + 1] = 1.0;
        } else {
            residual[equation] = x[part.first] - rotation;
            entries[part.first] = 1.0;
            if let Some(r) = self.motions[part.beam.start].rotation {
                entries[r] -= 1.0;
            }
        }
    }

    /// Forces and moments of a beam on its nodes.
    fn pull_nodes(&self, part: &Part, x: &[f64], flow: &Flow, residual: &mut [f64], matrix: &mut [f64]) {
        let n = self.unknowns;
        let force = [x[part.first + 2], x[part.first + 3]];
        let last = part.first + 4 * (part.segments - 1);
        for (node, sign) in [(part.beam.start, 1.0), (part.beam.end, -1.0)] {
            for (equation, along) in &self.motions[node].translations {
                residual[*equation] += sign * (along[0] * force[0] + along[1] * force[1]);
                matrix[equation * n + part.first + 2] += sign * along[0];
                matrix[equation * n + part.first + 3] += sign * along[1];
            }
        }
        if part.beam.start_joint == Joint::Rigid
            && let Some(equation) = self.motions[part.beam.start].rotation
        {
            residual[equation] += x[part.first + 1];
            matrix[equation * n + part.first + 1] += 1.0;
        }
        if part.beam.end_joint == Joint::Rigid
            && let Some(equation) = self.motions[part.beam.end].rotation
        {
            residual[equation] -= flow[1][0];
            let places = [last, last + 1, part.first + 2, part.first + 3];
            for (place, slope) in places.iter().zip(&flow[1][1..]) {
                matrix[equation * n + place] -= slope;
            }
        }
    }

    fn add_load(&self, residual: &mut [f64]) {
        let node = self.network.drive.node();
        match self.network.drive {
            Drive::Force { direction, .. } => {
                let d = unit(direction);
                for (equation, along) in &self.motions[node].translations {
                    residual[*equation] += self.load * (along[0] * d[0] + along[1] * d[1]);
                }
            }
            Drive::Moment { .. } => {
                if let Some(equation) = self.motions[node].rotation {
                    residual[equation] += self.load;
                }
            }
            _ => {}
        }
    }

    /// Results in SI.
    fn shot(&self, x: &[f64], last_correction: f64, iterations: u32) -> Shot {
        let node = self.network.drive.node();
        let (moved, rotation) = self.node_state(node, x);
        // What the beams leave for the drive.
        let (mut missing, mut torque) = ([0.0; 2], 0.0);
        for part in &self.parts {
            let force = [x[part.first + 2], x[part.first + 3]];
            for (end, sign) in [(part.beam.start, -1.0), (part.beam.end, 1.0)] {
                if end == node {
                    missing = [0, 1].map(|i| missing[i] + sign * force[i]);
                }
            }
            if part.beam.start == node && part.beam.start_joint == Joint::Rigid {
                torque -= x[part.first + 1];
            }
            if part.beam.end == node && part.beam.end_joint == Joint::Rigid {
                torque += part.end_moment(x);
            }
        }
        let (length, force) = (self.length_m, self.force_n);
        let (displacement, reaction) = match self.network.drive {
            Drive::Displacement { direction, .. } | Drive::Force { direction, .. } => {
                let d = unit(direction);
                let s = if let Support::Slider { direction, .. } = self.network.nodes[node].support { unit(direction) } else { d };
                let along = (missing[0] * s[0] + missing[1] * s[1]) / (s[0] * d[0] + s[1] * d[1]);
                (length * (moved[0] * d[0] + moved[1] * d[1]), force * along)
            }
            Drive::Rotation { .. } | Drive::Moment { .. } => (rotation, force * length * torque),
        };
        Shot {
            displacement,
            force: reaction,
            beam_force_n: self.parts.iter().map(|p| [force * x[p.first + 2], force * x[p.first + 3]]).collect(),
            start_moment_nm: self.parts.iter().map(|p| force * length * x[p.first + 1]).collect(),
            last_correction,
            iterations,
        }
    }
}

impl Part<'_> {
    fn end_moment(&self, x: &[f64]) -> f64 {
        let force = [x[self.first + 2], x[self.first + 3]];
        let k = self.segments - 1;
        let state = if k == 0 {
            // Where the beam is does not matter to its moment.
            [x[self.first], x[self.first + 1], 0.0, 0.0]
        } else {
            [0, 1, 2, 3].map(|i| x[self.first + 4 * k + i])
        };
        self.integrate(k, state, force)[1][0]
    }

    /// Slopes of a state and of its derivatives.
    fn slope(&self, u: f64, y: &Flow, force: [f64; 2]) -> Flow {
        let [h, v] = force;
        // Constants are those of the section that the beam names; a profile replaces its thickness.
        let t = self.beam.thickness_at(u) / self.beam.section.thickness_m;
        let (bending, soft_axial, soft_shear) = (self.bending * t * t * t, self.axial / t, self.shear / t);
        let (sin, cos) = maths::sin_cos(self.beam.shape.angle_at(u) + y[0][0]);
        let (axial, across) = (h * cos + v * sin, v * cos - h * sin);
        let x = (1.0 + soft_axial * axial) * cos - soft_shear * across * sin;
        let z = (1.0 + soft_axial * axial) * sin + soft_shear * across * cos;
        let mut out = [[0.0; 5]; 4];
        for k in 0..5 {
            let turn = y[0][k];
            let (dh, dv) = (f64::from(u8::from(k == 3)), f64::from(u8::from(k == 4)));
            out[0][k] = self.length * y[1][k] / bending;
            if k == 0 {
                out[1][0] = -self.length * (x * v - z * h);
                (out[2][0], out[3][0]) = (self.length * x, self.length * z);
                continue;
            }
            let d_axial = dh * cos + dv * sin + across * turn;
            let d_across = dv * cos - dh * sin - axial * turn;
            let dx = soft_axial * cos * d_axial - soft_shear * sin * d_across - z * turn;
            let dz = soft_axial * sin * d_axial + soft_shear * cos * d_across + x * turn;
            out[1][k] = -self.length * (dx * v + x * dv - dz * h - z * dh);
            (out[2][k], out[3][k]) = (self.length * dx, self.length * dz);
        }
        out
    }

    /// From the start of a segment to its end.
    fn integrate(&self, segment: usize, start: [f64; 4], force: [f64; 2]) -> Flow {
        let mut y: Flow = [[0.0; 5]; 4];
        for i in 0..4 {
            y[i][0] = start[i];
        }
        (y[0][1], y[1][2]) = (1.0, 1.0);
        let width = 1.0 / (self.segments as f64 * self.steps as f64);
        for step in 0..self.steps {
            let u = (segment as f64 * self.steps as f64 + step as f64) * width;
            y = self.extrapolated_step(u, width, y, force);
        }
        y
    }

    /// One step by midpoint rules with 2 to 12 parts and extrapolation to none (order 12).
    fn extrapolated_step(&self, u: f64, width: f64, y: Flow, force: [f64; 2]) -> Flow {
        let after = |y: &Flow, slope: &Flow, h: f64| {
            let mut out = *y;
            for (o, s) in out.iter_mut().flatten().zip(slope.iter().flatten()) {
                *o += h * s;
            }
            out
        };
        let first = self.slope(u, &y, force);
        let mut previous: Vec<Flow> = Vec::new();
        for (row, parts) in STAGES.iter().enumerate() {
            let h = width / f64::from(*parts);
            let (mut before, mut here) = (y, after(&y, &first, h));
            for i in 1..*parts {
                let next = after(&before, &self.slope(u + f64::from(i) * h, &here, force), 2.0 * h);
                (before, here) = (here, next);
            }
            // Aitken and Neville in h².
            let mut current = vec![here];
            for column in 1..=row {
                let ratio = f64::from(*parts) / f64::from(STAGES[row - column]);
                let mut value = current[column - 1];
                for (v, c) in value.iter_mut().flatten().zip(previous[column - 1].iter().flatten()) {
                    *v += (*v - c) / (ratio * ratio - 1.0);
                }
                current.push(value);
            }
            previous = current;
        }
        previous[STAGES.len() - 1]
    }
}
