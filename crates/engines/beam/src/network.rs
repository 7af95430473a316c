//! The description of a network: nodes, beams, supports and the drive.

use forcewright_base::maths;

use crate::{error::NetworkError, section::Section, shape::Shape};

/// Planar beams that meet at nodes, and what moves them. All quantities in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    /// Where beams meet and where the ground holds them.
    pub nodes: Vec<Node>,
    /// The beams.
    pub beams: Vec<Beam>,
    /// What was done before the path begins, in order. Every stage is held at its end: a displacement or rotation stays where it is, a
    /// force or moment stays as large as it is.
    pub before: Vec<Stage>,
    /// The one control of the path.
    pub drive: Drive,
}

/// A load stage that is over when the path begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage {
    /// What is prescribed.
    pub drive: Drive,
    /// How far, of either sign: m or rad from where the stage before left the node, or N or N·m.
    pub to: f64,
}

/// A place where beams end: a point, or with [`Beam::arms_m`] a rigid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Position at rest, m.
    pub position_m: [f64; 2],
    /// How the ground holds it.
    pub support: Support,
}

/// How the ground holds a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Support {
    /// Not at all.
    Free,
    /// Position and rotation are held.
    Clamped,
    /// The position is held, the rotation is free.
    Pinned,
    /// The rotation is held, the position is free: a stage on parallel guides for both directions.
    Parallel,
    /// It moves along a straight guide.
    Slider {
        /// Direction of the guide; any length but zero.
        direction: [f64; 2],
        /// Whether it may turn.
        rotation: Rotation,
    },
}

impl Support {
    /// Whether the node keeps its angle.
    pub fn holds_rotation(&self) -> bool {
        matches!(self, Self::Clamped | Self::Parallel | Self::Slider { rotation: Rotation::Fixed, .. })
    }
}

/// Whether a slider may turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rotation {
    /// It keeps its angle.
    Fixed,
    /// It turns freely.
    Free,
}

/// One beam.
#[derive(Debug, Clone, PartialEq)]
pub struct Beam {
    /// Index of the node where u = 0.
    pub start: usize,
    /// Index of the node where u = 1.
    pub end: usize,
    /// Shape at rest; its chord must lead from the start node to the end node, arms included.
    pub shape: Shape,
    /// Cross-section and material.
    pub section: Section,
    /// How it is joined to its start node.
    pub start_joint: Joint,
    /// How it is joined to its end node.
    pub end_joint: Joint,
    /// From the start node to the start of the beam and from the end node to its end, at rest, m: arms that turn with the node, which
    /// is then a rigid body. Zero by default.
    pub arms_m: [[f64; 2]; 2],
    /// Thickness in the plane at places along the beam, (u, m), linear between them, in place of [`Section::thickness_m`]; the first
    /// at u = 0, the last at u = 1. Empty for a constant thickness.
    pub profile: Vec<[f64; 2]>,
}

impl Beam {
    /// A beam of constant section, joined rigidly at both ends without arms.
    pub fn new(start: usize, end: usize, shape: Shape, section: Section) -> Self {
        Self { start, end, shape, section, start_joint: Joint::Rigid, end_joint: Joint::Rigid, arms_m: [[0.0; 2]; 2], profile: Vec::new() }
    }

    /// Thickness in the plane at u in [0, 1], m.
    pub fn thickness_at(&self, u: f64) -> f64 {
        let after = self.profile.partition_point(|p| p[0] <= u);
        match (self.profile.get(after.wrapping_sub(1)), self.profile.get(after)) {
            (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (u - a[0]) / (b[0] - a[0]),
            (Some(only), None) | (None, Some(only)) => only[1],
            (None, None) => self.section.thickness_m,
        }
    }

    /// The section at u in [0, 1].
    pub fn section_at(&self, u: f64) -> Section {
        Section { thickness_m: self.thickness_at(u), ..self.section }
    }
}

/// How a beam is joined to a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Joint {
    /// The end turns with the node.
    Rigid,
    /// The end turns freely.
    Hinged,
}

/// What is prescribed, in proportion to one control that grows from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// The displacement of a node along a direction; the control is in m, the reaction in N.
    ///
    /// On a slider whose guide s is not parallel to the direction d, the node moves by Δ/(s·d) along the guide.
    Displacement {
        /// The node.
        node: usize,
        /// Direction; any length but zero.
        direction: [f64; 2],
    },
    /// The rotation of a node, counter-clockwise; the control is in rad, the reaction in N·m.
    Rotation {
        /// The node.
        node: usize,
    },
    /// A force of constant direction on a node; the control is in N, its displacement is measured along the direction.
    Force {
        /// The node.
        node: usize,
        /// Direction; any length but zero.
        direction: [f64; 2],
    },
    /// A moment on a node, counter-clockwise; the control is in N·m.
    Moment {
        /// The node.
        node: usize,
    },
}

impl Drive {
    /// The driven node.
    pub fn node(&self) -> usize {
        match *self {
            Self::Displacement { node, .. } | Self::Rotation { node } | Self::Force { node, .. } | Self::Moment { node } => node,
        }
    }

    /// Whether the control is a displacement or rotation (and not a force or moment).
    pub fn is_kinematic(&self) -> bool {
        matches!(self, Self::Displacement { .. } | Self::Rotation { .. })
    }
}

/// Which deformations a beam has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Theory {
    /// Bending only: the elastica of Lan, Wang & Chen 2010. Stress is bending stress, their eq. (5).
    Inextensible,
    /// Bending, stretching and shear without limits on rotation: E. Reissner, "On one-dimensional finite-strain beam theory: the
    /// plane problem", ZAMP 23 (1972). Stress includes the axial force.
    #[default]
    Reissner,
}

/// Options of [`crate::trace`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Which deformations are modelled. Default [`Theory::Reissner`].
    pub theory: Theory,
    /// Largest difference between two resolutions, relative to the largest force and to the largest stress of the path, in (0, 1).
    /// An estimate that in practice bounds the error, not a proof. Default 1e-8.
    pub accuracy: f64,
    /// Budget of Newton iterations for the whole call, so that every call ends. Default 50 000.
    pub iteration_limit: u64,
    /// What happens at a limit point of the control. Default [`Follow::StopAtLimit`].
    pub follow: Follow,
    /// How beams of finite thickness meet. Default [`Joints::Point`].
    pub joints: Joints,
}

/// How beams of finite thickness meet at a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Joints {
    /// In a point: every beam bends over its whole length.
    #[default]
    Point,
    /// In a block: each beam is rigid as far as it lies inside another one, up to the corner of their inner faces. Only where beams
    /// are joined rigidly at the same place: to the same node, with equal [`Beam::arms_m`].
    Overlap,
}

/// What happens where the control cannot grow any further along the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Follow {
    /// The path ends there.
    #[default]
    StopAtLimit,
    /// The path is followed by its arc length through all limit points until the control reaches the last station, or until
    /// rotations and displacements have changed by more than any mechanism needs. The result is in [`crate::Path::whole`];
    /// [`crate::Path::points`] and [`crate::Path::status`] are the same as without. Costs a few times as much.
    ToEnd,
}

impl Default for Settings {
    fn default() -> Self {
        Self { theory: Theory::default(), accuracy: 1e-8, iteration_limit: 50_000, follow: Follow::default(), joints: Joints::default() }
    }
}

/// Whether there is no arm.
pub(crate) fn is_zero(v: [f64; 2]) -> bool {
    v.iter().all(|x| *x == 0.0)
}

/// Unit vector along `v`.
pub(crate) fn unit(v: [f64; 2]) -> Option<[f64; 2]> {
    // Two steps, so that neither huge nor tiny vectors lose their direction.
    let size = v[0].abs().max(v[1].abs());
    if !(size > 0.0 && size.is_finite() && v[0].is_finite() && v[1].is_finite()) {
        return None;
    }
    let (x, y) = (v[0] / size, v[1] / size);
    let length = maths::hypot(x, y);
    Some([x / length, y / length])
}

impl Network {
    /// Largest number of nodes, and of beams.
    pub const LARGEST: usize = 64;
    /// Largest ratio of thicknesses within one beam.
    pub const LARGEST_TAPER: f64 = 100.0;
    /// Largest number of load stages before the drive.
    pub const MOST_STAGES: usize = 16;
    /// Largest number of places at which the thickness of a beam is given.
    pub const MOST_PLACES: usize = 32;
    /// Largest number of pieces that beams are cut into where their thickness has a kink, all beams together.
    pub const MOST_PIECES: usize = 128;
    /// Largest distance between the end of a shape and its node, relative to the length of the beam.
    pub const LARGEST_GAP: f64 = 1e-6;

    /// A network with one load.
    pub fn new(nodes: Vec<Node>, beams: Vec<Beam>, drive: Drive) -> Self {
        Self { nodes, beams, before: Vec::new(), drive }
    }

    /// All loads in order, the drive last.
    pub(crate) fn drives(&self) -> impl DoubleEndedIterator<Item = &Drive> {
        self.before.iter().map(|s| &s.drive).chain(std::iter::once(&self.drive))
    }

    /// Checks everything that can be checked without solving.
    ///
    /// # Errors
    /// [`NetworkError`] names the first fault found.
    pub fn check(&self) -> Result<(), NetworkError> {
        self.check_parts(true)
    }

    /// As [`Network::check`]; `chords` whether shapes are checked to reach from node to node, which costs more than all else.
    pub(crate) fn check_parts(&self, chords: bool) -> Result<(), NetworkError> {
        if self.beams.is_empty() {
            return Err(NetworkError::NoBeams);
        }
        let count = self.beams.len().max(self.nodes.len());
        if count > Self::LARGEST {
            return Err(NetworkError::TooLarge { count });
        }
        for (node, n) in self.nodes.iter().enumerate() {
            if !(n.position_m[0].is_finite() && n.position_m[1].is_finite()) {
                return Err(NetworkError::Position { node });
            }
            if let Support::Slider { direction, .. } = n.support
                && unit(direction).is_none()
            {
                return Err(NetworkError::Direction { node });
            }
        }
        for beam in 0..self.beams.len() {
            self.check_beam(beam, chords)?;
        }
        for node in 0..self.nodes.len() {
            if !self.beams.iter().any(|b| b.start == node || b.end == node) {
                return Err(NetworkError::LooseNode { node });
            }
        }
        let count = self.beams.iter().map(|b| b.profile.len().max(2) - 1).sum();
        if count > Self::MOST_PIECES {
            return Err(NetworkError::TooManyPieces { count });
        }
        self.check_drives()?;
        self.check_rigid_motion()
    }

    fn check_beam(&self, beam: usize, chords: bool) -> Result<(), NetworkError> {
        let b = &self.beams[beam];
        for node in [b.start, b.end] {
            if node >= self.nodes.len() {
                return Err(NetworkError::NodeOutOfRange { beam, node });
            }
        }
        if b.start == b.end {
            return Err(NetworkError::BeamOnOneNode { beam });
        }
        self.check_profile(beam)?;
        if !b.arms_m.iter().flatten().all(|v| v.is_finite()) {
            return Err(NetworkError::Arm { beam });
        }
        if !chords {
            return Ok(());
        }
        let attached = |node: usize, arm: [f64; 2]| [0, 1].map(|i| self.nodes[node].position_m[i] + arm[i]);
        let (chord, from, to) = (b.shape.chord_m(), attached(b.start, b.arms_m[0]), attached(b.end, b.arms_m[1]));
        let gap_m = maths::hypot(to[0] - from[0] - chord[0], to[1] - from[1] - chord[1]);
        // Positions far from the origin carry their own rounding.
        let rounding = 8.0 * f64::EPSILON * from.iter().chain(&to).fold(0.0_f64, |m, v| m.max(v.abs()));
        if gap_m <= Self::LARGEST_GAP * b.shape.length_m() + rounding {
            return Ok(());
        }
        Err(NetworkError::DoesNotClose { beam, gap_m })
    }

    /// Sections at all places where the thickness is given, and their order.
    fn check_profile(&self, beam: usize) -> Result<(), NetworkError> {
        let b = &self.beams[beam];
        let wrong = |what, value| Err(NetworkError::Section { beam, what, value });
        if !b.profile.is_empty() {
            let ascending = b.profile.windows(2).all(|p| p[0][0] < p[1][0]);
            let at = |place: Option<&[f64; 2]>, u: f64| place.is_some_and(|p| (p[0] - u).abs() <= 0.0);
            let whole = at(b.profile.first(), 0.0) && at(b.profile.last(), 1.0);
            if !ascending || !whole || b.profile.len() > Self::MOST_PLACES {
                return Err(NetworkError::Profile { beam });
            }
        }
        let thicknesses = b.profile.iter().map(|p| p[1]).chain(b.profile.is_empty().then_some(b.section.thickness_m));
        for thickness_m in thicknesses {
            if let Some((what, value)) = (Section { thickness_m, ..b.section }).fault() {
                return wrong(what, value);
            }
        }
        // The general path resolves such tapers; beyond, bending is all at the thin end.
        let range = b.profile.iter().fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], p| [low.min(p[1]), high.max(p[1])]);
        if !b.profile.is_empty() && range[1] > Self::LARGEST_TAPER * range[0] {
            return wrong("largest thickness over smallest", range[1] / range[0]);
        }
        Ok(())
    }

    /// Whether anything turns with the node: a beam end, or a hinge on an arm.
    pub(crate) fn turns_beams(&self, node: usize) -> bool {
        let turns = |at: usize, joint: Joint, arm: [f64; 2]| at == node && (joint == Joint::Rigid || !is_zero(arm));
        self.beams.iter().any(|b| turns(b.start, b.start_joint, b.arms_m[0]) || turns(b.end, b.end_joint, b.arms_m[1]))
    }

    fn check_drives(&self) -> Result<(), NetworkError> {
        if self.before.len() > Self::MOST_STAGES {
            return Err(NetworkError::TooManyStages { count: self.before.len() });
        }
        for (stage, s) in self.before.iter().enumerate() {
            if !s.to.is_finite() {
                return Err(NetworkError::StageEnd { stage });
            }
        }
        for (stage, drive) in self.drives().enumerate() {
            self.check_drive(drive)?;
            let clash = |earlier: &Drive| match (earlier, drive) {
                (Drive::Rotation { node: a }, Drive::Rotation { node: b }) => a == b,
                (Drive::Displacement { node: a, direction: d }, Drive::Displacement { node: b, direction: e }) => {
                    let across = unit(*d).zip(unit(*e)).is_some_and(|(d, e)| (d[0] * e[0] + d[1] * e[1]).abs() < 1e-12);
                    a == b && !(across && matches!(self.nodes[*a].support, Support::Free | Support::Parallel))
                }
                _ => false,
            };
            if self.drives().take(stage).any(clash) {
                return Err(NetworkError::DrivenTwice { node: drive.node(), stage });
            }
            if self.is_held_before(drive, stage) {
                return Err(NetworkError::DriveBlocked { node: drive.node() });
            }
        }
        Ok(())
    }

    /// Whether a force or moment acts only on motions that earlier loads hold.
    fn is_held_before(&self, drive: &Drive, stage: usize) -> bool {
        let earlier = || self.drives().take(stage).filter(|d| d.node() == drive.node());
        match *drive {
            Drive::Moment { .. } => earlier().any(|d| matches!(d, Drive::Rotation { .. })),
            Drive::Force { node, direction } => {
                let held: Vec<[f64; 2]> =
                    earlier().filter_map(|d| if let Drive::Displacement { direction, .. } = d { unit(*direction) } else { None }).collect();
                let one_way = matches!(self.nodes[node].support, Support::Slider { .. });
                let along = |h: &[f64; 2]| unit(direction).is_some_and(|d| (h[0] * d[1] - h[1] * d[0]).abs() < 1e-12);
                held.len() > 1 || (one_way && !held.is_empty()) || held.iter().any(along)
            }
            _ => false,
        }
    }

    fn check_drive(&self, drive: &Drive) -> Result<(), NetworkError> {
        let node = drive.node();
        let Some(driven) = self.nodes.get(node) else {
            return Err(NetworkError::DriveOutOfRange { node });
        };
        let allowed = match *drive {
            Drive::Displacement { direction, .. } | Drive::Force { direction, .. } => {
                let Some(d) = unit(direction) else {
                    return Err(NetworkError::Direction { node });
                };
                match driven.support {
                    Support::Free | Support::Parallel => true,
                    Support::Clamped | Support::Pinned => false,
                    Support::Slider { direction, .. } => {
                        // Below this the node would move 10⁸ times as far as the drive.
                        unit(direction).is_some_and(|s| (s[0] * d[0] + s[1] * d[1]).abs() > 1e-8)
                    }
                }
            }
            Drive::Rotation { .. } | Drive::Moment { .. } => !driven.support.holds_rotation() && self.turns_beams(node),
        };
        if allowed { Ok(()) } else { Err(NetworkError::DriveBlocked { node }) }
    }

    /// Each connected part, taken as one rigid body, must be held by its supports and a kinematic drive.
    fn check_rigid_motion(&self) -> Result<(), NetworkError> {
        let mut part: Vec<usize> = (0..self.nodes.len()).collect();
        for _ in 0..self.nodes.len() {
            for b in &self.beams {
                let lowest = part[b.start].min(part[b.end]);
                (part[b.start], part[b.end]) = (lowest, lowest);
            }
        }
        for name in 0..self.nodes.len() {
            if part[name] == name && self.rigid_freedoms(&part, name) > 0 {
                return Err(NetworkError::Mechanism { node: name });
            }
        }
        Ok(())
    }

    /// Degrees of freedom left to one part as a rigid body: 3 less the rank of its constraints on (x, y, rotation).
    fn rigid_freedoms(&self, part: &[usize], name: usize) -> usize {
        let origin = self.nodes[name].position_m;
        let lengths = self.beams.iter().filter(|b| part[b.start] == name).map(|b| b.shape.length_m());
        let size = lengths.fold(0.0, f64::max);
        let mut rows: Vec<[f64; 3]> = Vec::new();
        for (node, n) in self.nodes.iter().enumerate().filter(|(node, _)| part[*node] == name) {
            let (x, y) = ((n.position_m[0] - origin[0]) / size, (n.position_m[1] - origin[1]) / size);
            let along = |d: [f64; 2]| [d[0], d[1], x * d[1] - y * d[0]];
            match n.support {
                Support::Free => {}
                Support::Parallel => rows.push([0.0, 0.0, 1.0]),
                Support::Clamped => return 0,
                Support::Pinned => rows.extend([along([1.0, 0.0]), along([0.0, 1.0])]),
                Support::Slider { direction, rotation } => {
                    let s = unit(direction).unwrap_or([1.0, 0.0]);
                    rows.push(along([-s[1], s[0]]));
                    if rotation == Rotation::Fixed {
                        rows.push([0.0, 0.0, 1.0]);
                    }
                }
            }
            // The first load alone holds what the stages after it do not hold yet.
            match self.drives().next() {
                Some(&Drive::Displacement { node: driven, direction }) if driven == node => {
                    rows.push(along(unit(direction).unwrap_or([1.0, 0.0])));
                }
                Some(&Drive::Rotation { node: driven }) if driven == node => rows.push([0.0, 0.0, 1.0]),
                _ => {}
            }
        }
        3 - rank(&mut rows)
    }
}

/// Rank of a list of rows, by elimination with full row pivoting.
fn rank(rows: &mut [[f64; 3]]) -> usize {
    let mut rank = 0;
    for column in 0..3 {
        let best = (rank..rows.len()).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()));
        let Some(best) = best.filter(|&b| rows[b][column].abs() > 1e-9) else {
            continue;
        };
        rows.swap(rank, best);
        let pivot = rows[rank];
        for row in &mut rows[rank + 1..] {
            let factor = row[column] / pivot[column];
            for k in 0..3 {
                row[k] -= factor * pivot[k];
            }
        }
        rank += 1;
    }
    rank
}
