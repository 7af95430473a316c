//! From a network to numbered unknowns, in units that make all quantities of order one.
//!
//! Beams are cut into pieces where their thickness has a kink, so that everything is smooth along a piece, and lose the parts that
//! are rigid; a cut is a node of its own. Unknowns are numbered in this order: those that are always solved for; the driven ones,
//! that of the last load first; those that supports hold. Each load stage solves for a leading part of them.

use std::ops::Range;
use std::sync::Arc;

use forcewright_base::maths;

use crate::{
    element::Constants,
    network::{Beam, Drive, Joint, Network, Support, Theory, is_zero, unit},
    overlap::Zones,
    state::{BeamLine, PieceInfo},
};

/// Where the motion of a node is found among the unknowns.
#[derive(Debug, Clone, Default)]
pub(crate) struct NodeFreedom {
    /// Two unknowns with their directions, which are perpendicular unit vectors.
    pub(crate) translations: Vec<(usize, [f64; 2])>,
    /// Unknown of the rotation; `None` without anything that turns with the node.
    pub(crate) rotation: Option<usize>,
}

/// A piece of a beam with the places of its unknowns.
#[derive(Debug, Clone)]
pub(crate) struct BeamModel {
    pub(crate) constants: Constants,
    pub(crate) nodes: [usize; 2],
    /// From its nodes to its ends at rest, turning with the nodes.
    pub(crate) arms: [[f64; 2]; 2],
    /// Unknowns of the end rotations.
    pub(crate) ends: [Option<usize>; 2],
    /// Unknown of H; that of V follows.
    pub(crate) force: usize,
    pub(crate) info: Arc<PieceInfo>,
}

impl BeamModel {
    /// Unknowns of (`φ_A`, `φ_B`, H, V).
    pub(crate) fn places(&self) -> [Option<usize>; 4] {
        [self.ends[0], self.ends[1], Some(self.force), Some(self.force + 1)]
    }
}

/// A dimensionless network with numbered unknowns under one of its loads.
#[derive(Debug, Clone)]
pub(crate) struct Model {
    /// Unit of length, m: the longest beam.
    pub(crate) length_m: f64,
    /// Unit of force, N: the largest bending stiffness divided by the square of the unit of length.
    pub(crate) force_n: f64,
    /// The nodes of the network, then the cuts.
    pub(crate) nodes: Vec<NodeFreedom>,
    /// How many of them are the network's.
    pub(crate) drawn_nodes: usize,
    /// All pieces of all beams.
    pub(crate) beams: Vec<BeamModel>,
    /// Per beam of the network: its pieces, and its whole line at rest.
    pub(crate) spans: Vec<(Range<usize>, Arc<BeamLine>)>,
    /// Number of unknowns, without bubbles.
    pub(crate) unknowns: usize,
    /// How many of them, from the first, this load solves for. Under a kinematic drive the driven unknown is the next.
    pub(crate) solved: usize,
    /// Driven displacement per driven unknown: the cosine between the drive and the guide, with the sign of the stage.
    pub(crate) projection: f64,
    /// Whether a displacement or rotation is prescribed.
    pub(crate) kinematic: bool,
    /// Generalised forces per unit of the control; empty under a kinematic drive.
    pub(crate) pull: Vec<(usize, f64)>,
    /// Generalised forces that earlier loads left behind.
    pub(crate) dead: Vec<(usize, f64)>,
    /// The load before this one.
    pub(crate) before: Option<Arc<Model>>,
    /// Where this load ends if another one follows, in the unit of its drive.
    pub(crate) end: f64,
    /// The node that the drive acts on.
    pub(crate) driven_node: usize,
    /// The number of this load.
    pub(crate) stage: usize,
    /// Whether every beam is one piece without arms and there is one load.
    pub(crate) plain: bool,
    /// Whether the drive turns.
    turning: bool,
}

impl Model {
    /// `network` must have passed [`Network::check`]; joints are points.
    pub(crate) fn new(network: &Network, theory: Theory) -> Self {
        Self::with_zones(network, theory, &Zones::none(network))
    }

    /// The same with parts of the beams rigid.
    pub(crate) fn with_zones(network: &Network, theory: Theory, zones: &Zones) -> Self {
        let (base, loads) = Builder::new(network, theory, zones).build();
        let ends = network.before.iter().map(|s| s.to.abs()).chain([0.0]);
        let mut before: Option<Self> = None;
        let mut dead: Vec<(usize, f64)> = Vec::new();
        for (stage, ((load, drive), end)) in loads.into_iter().zip(network.drives()).zip(ends).enumerate() {
            let mut model = Self { stage, end, dead: dead.clone(), driven_node: drive.node(), ..base.clone() };
            model.kinematic = drive.is_kinematic();
            model.turning = matches!(drive, Drive::Rotation { .. } | Drive::Moment { .. });
            (model.solved, model.projection, model.pull) = (load.solved, load.projection, load.pull);
            let control = end / model.control_unit();
            dead.extend(model.pull.iter().map(|(i, factor)| (*i, factor * control)));
            model.before = before.map(Arc::new);
            before = Some(model);
        }
        before.unwrap_or(base)
    }

    /// Unit of the control, SI.
    pub(crate) fn control_unit(&self) -> f64 {
        if self.kinematic { self.displacement_unit() } else { self.reaction_unit() }
    }

    /// Unit of the driven displacement or rotation, SI.
    pub(crate) fn displacement_unit(&self) -> f64 {
        if self.turning { 1.0 } else { self.length_m }
    }

    /// Unit of the conjugate force or moment, SI.
    pub(crate) fn reaction_unit(&self) -> f64 {
        if self.turning { self.force_n * self.length_m } else { self.force_n }
    }

    /// Place of the driven unknown of a kinematic drive.
    pub(crate) fn driven(&self) -> usize {
        self.solved
    }

    /// Displacement along the drive in a state or of a change, dimensionless.
    pub(crate) fn along_drive(&self, x: &[f64]) -> f64 {
        if self.kinematic { self.projection * x[self.driven()] } else { self.pull.iter().map(|(i, factor)| factor * x[*i]).sum() }
    }

    /// Displacement of a node in units of length.
    pub(crate) fn displacement(&self, node: usize, x: &[f64]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (i, direction) in &self.nodes[node].translations {
            sum[0] += direction[0] * x[*i];
            sum[1] += direction[1] * x[*i];
        }
        sum
    }

    /// Displacement of an end of a piece in units of length.
    pub(crate) fn end_displacement(&self, piece: usize, end: usize, x: &[f64]) -> [f64; 2] {
        let beam = &self.beams[piece];
        let (node, arm) = (beam.nodes[end], beam.arms[end]);
        let [x0, y0] = self.displacement(node, x);
        let [dx, dy] = swing(arm, Self::rotation(self.nodes[node].rotation, x));
        [x0 + dx, y0 + dy]
    }

    /// Rotation of an unknown that may not exist.
    pub(crate) fn rotation(unknown: Option<usize>, x: &[f64]) -> f64 {
        unknown.map_or(0.0, |i| x[i])
    }
}

/// (R(φ) − 1) a: how the end of an arm moves.
pub(crate) fn swing([x, y]: [f64; 2], rotation: f64) -> [f64; 2] {
    let (sin, cos) = maths::sin_cos(rotation);
    // 1 − cos φ without cancellation.
    let half = maths::sin(0.5 * rotation);
    let lost = 2.0 * half * half;
    debug_assert!((1.0 - cos - lost).abs() < 1e-9 || rotation.is_nan());
    [-lost * x - sin * y, sin * x - lost * y]
}

/// Who decides on an unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Holder {
    /// Nobody: it is solved for.
    Equilibrium,
    /// The load of that number.
    Load(usize),
    /// A support.
    Ground,
}

/// One load in terms of the unknowns.
struct Load {
    solved: usize,
    projection: f64,
    pull: Vec<(usize, f64)>,
}

struct Builder<'a> {
    network: &'a Network,
    theory: Theory,
    zones: &'a Zones,
    length_m: f64,
    stiffness_n_m2: f64,
    holders: Vec<Holder>,
}

impl<'a> Builder<'a> {
    fn new(network: &'a Network, theory: Theory, zones: &'a Zones) -> Self {
        let length_m = network.beams.iter().map(|b| b.shape.length_m()).fold(0.0, f64::max);
        let reference = |b: &Beam| reference_section(b, [0.0, 1.0]).bending_stiffness_n_m2();
        let stiffness_n_m2 = network.beams.iter().map(reference).fold(0.0, f64::max);
        Self { network, theory, zones, length_m, stiffness_n_m2, holders: Vec::new() }
    }

    fn unknown(&mut self, holder: Holder) -> usize {
        self.holders.push(holder);
        self.holders.len() - 1
    }

    /// Everything but the load, and the loads.
    fn build(mut self) -> (Model, Vec<Load>) {
        let network = self.network;
        let mut nodes: Vec<NodeFreedom> = (0..network.nodes.len()).map(|node| self.node(node)).collect();
        let mut model = Model {
            length_m: self.length_m,
            force_n: self.stiffness_n_m2 / (self.length_m * self.length_m),
            drawn_nodes: nodes.len(),
            nodes: Vec::new(),
            beams: Vec::new(),
            spans: Vec::new(),
            unknowns: 0,
            solved: 0,
            projection: 1.0,
            kinematic: true,
            pull: Vec::new(),
            dead: Vec::new(),
            before: None,
            end: 0.0,
            driven_node: 0,
            stage: 0,
            plain: network.before.is_empty(),
            turning: false,
        };
        for index in 0..network.beams.len() {
            self.beam(index, &mut nodes, &mut model);
        }
        model.nodes = nodes;
        model.unknowns = self.holders.len();
        self.renumber(&mut model);
        let loads = (0..=network.before.len()).map(|stage| self.load(stage, &model)).collect();
        (model, loads)
    }

    /// Translations of a node along its guide, or along its prescribed displacement.
    fn node(&mut self, index: usize) -> NodeFreedom {
        let network = self.network;
        let support = network.nodes[index].support;
        let prescribed: Vec<(usize, [f64; 2])> = network
            .drives()
            .enumerate()
            .filter_map(|(stage, drive)| match drive {
                Drive::Displacement { node, direction } if *node == index => Some((stage, unit(*direction)?)),
                _ => None,
            })
            .collect();
        let first = prescribed.first().map(|p| Holder::Load(p.0));
        let second = prescribed.get(1).map(|p| Holder::Load(p.0));
        let free = Holder::Equilibrium;
        let (along, holders) = match support {
            Support::Free | Support::Parallel => {
                (prescribed.first().map_or([1.0, 0.0], |p| p.1), [first.unwrap_or(free), second.unwrap_or(free)])
            }
            Support::Slider { direction, .. } => (unit(direction).unwrap_or([1.0, 0.0]), [first.unwrap_or(free), Holder::Ground]),
            Support::Clamped | Support::Pinned => ([1.0, 0.0], [Holder::Ground; 2]),
        };
        let across = prescribed.get(1).map_or([-along[1], along[0]], |p| p.1);
        let translations = holders.into_iter().zip([along, across]).map(|(h, d)| (self.unknown(h), d)).collect();
        let rotation = network.turns_beams(index).then(|| {
            let turned = network.drives().position(|d| matches!(d, Drive::Rotation { node } if *node == index));
            let holder = if support.holds_rotation() { Holder::Ground } else { turned.map_or(free, Holder::Load) };
            self.unknown(holder)
        });
        NodeFreedom { translations, rotation }
    }

    /// The pieces of a beam and the nodes between them.
    fn beam(&mut self, index: usize, nodes: &mut Vec<NodeFreedom>, model: &mut Model) {
        let beam = &self.network.beams[index];
        let [from, to] = self.zones.flexible[index];
        let mut cuts: Vec<f64> = beam.profile.iter().map(|p| p[0]).filter(|u| *u > from && *u < to).collect();
        cuts.insert(0, from);
        cuts.push(to);
        let first = model.beams.len();
        let origin = self.network.nodes[beam.start].position_m;
        let at_rest = [0, 1].map(|i| origin[i] + beam.arms_m[0][i]);
        let line = Arc::new(BeamLine { shape: beam.shape.clone(), start_m: at_rest, flexible: [from, to], profile: beam.profile.clone() });
        let pieces = cuts.len() - 1;
        for (piece, cut) in cuts.windows(2).enumerate() {
            let range = [cut[0], cut[1]];
            let mut arms = [[0.0; 2]; 2];
            let (mut ends, mut at) = ([None; 2], [0; 2]);
            for end in 0..2 {
                let outer = if end == 0 { piece == 0 } else { piece + 1 == pieces };
                if !outer {
                    // The cut before this piece has been made with the piece before.
                    if end == 1 {
                        let translations = [[1.0, 0.0], [0.0, 1.0]].map(|d| (self.unknown(Holder::Equilibrium), d)).to_vec();
                        nodes.push(NodeFreedom { translations, rotation: Some(self.unknown(Holder::Equilibrium)) });
                    }
                    at[end] = nodes.len() - 1;
                    ends[end] = nodes[at[end]].rotation;
                    continue;
                }
                let (node, joint) = if end == 0 { (beam.start, beam.start_joint) } else { (beam.end, beam.end_joint) };
                let rigid = rigid_part(beam, end, range[end]);
                arms[end] = [0, 1].map(|i| (beam.arms_m[end][i] + rigid[i]) / self.length_m);
                at[end] = node;
                ends[end] = match joint {
                    Joint::Rigid => nodes[node].rotation,
                    Joint::Hinged => Some(self.unknown(Holder::Equilibrium)),
                };
            }
            let force = self.unknown(Holder::Equilibrium);
            self.unknown(Holder::Equilibrium);
            model.plain &= pieces == 1 && arms.into_iter().all(is_zero) && is_whole(range) && beam.profile.is_empty();
            let info = Arc::new(self.piece_info(beam, range, &line));
            model.beams.push(BeamModel { constants: self.constants(&info), nodes: at, arms, ends, force, info });
        }
        model.spans.push((first..model.beams.len(), line));
    }

    fn piece_info(&self, beam: &Beam, range: [f64; 2], line: &BeamLine) -> PieceInfo {
        // Not by an integral of length 0: networks are set up by the thousand.
        let start = if range[0] > 0.0 { beam.shape.point_m(range[0]) } else { [0.0; 2] };
        let start_m = [0, 1].map(|i| line.start_m[i] + start[i]);
        let varies = !beam.profile.is_empty();
        PieceInfo {
            shape: beam.shape.part(range),
            section: reference_section(beam, range),
            thickness_m: varies.then(|| range.map(|u| beam.thickness_at(u))),
            theory: self.theory,
            start_m,
            range,
        }
    }

    fn constants(&self, info: &PieceInfo) -> Constants {
        let force_n = self.stiffness_n_m2 / (self.length_m * self.length_m);
        let length = info.shape.length_m() / self.length_m;
        let soft = |stiffness_n: f64| if self.theory == Theory::Reissner { force_n / stiffness_n } else { 0.0 };
        Constants {
            length,
            bending: info.section.bending_stiffness_n_m2() / self.stiffness_n_m2 / length,
            axial: soft(info.section.axial_stiffness_n()),
            shear: soft(info.section.shear_stiffness_n()),
        }
    }

    /// Puts the unknowns in the order that the loads need.
    fn renumber(&mut self, model: &mut Model) {
        let rank = |holder: Holder| match holder {
            Holder::Equilibrium => 0,
            // The last load first.
            Holder::Load(stage) => 1 + self.network.before.len() - stage,
            Holder::Ground => 2 + self.network.before.len(),
        };
        let mut order: Vec<usize> = (0..self.holders.len()).collect();
        // Stable: otherwise in the order of their making.
        order.sort_by_key(|i| rank(self.holders[*i]));
        let mut place = vec![0; order.len()];
        for (new, old) in order.iter().enumerate() {
            place[*old] = new;
        }
        for node in &mut model.nodes {
            node.translations.iter_mut().for_each(|(i, _)| *i = place[*i]);
            node.rotation.iter_mut().for_each(|i| *i = place[*i]);
        }
        for beam in &mut model.beams {
            beam.ends.iter_mut().flatten().for_each(|i| *i = place[*i]);
            // Made one after the other, both solved for: still neighbours.
            beam.force = place[beam.force];
        }
        self.holders = order.iter().map(|old| self.holders[*old]).collect();
    }

    fn load(&self, stage: usize, model: &Model) -> Load {
        let solves = |holder: &Holder| match holder {
            Holder::Equilibrium => true,
            Holder::Load(of) => *of > stage,
            Holder::Ground => false,
        };
        let solved = self.holders.iter().take_while(|h| solves(h)).count();
        let sign = self.network.before.get(stage).map_or(1.0, |s| if s.to < 0.0 { -1.0 } else { 1.0 });
        let (mut projection, mut pull) = (sign, Vec::new());
        let drive = self.network.drives().nth(stage).unwrap_or(&self.network.drive);
        let freedom = &model.nodes[drive.node()];
        match *drive {
            Drive::Displacement { direction, .. } => {
                let along = unit(direction).unwrap_or([1.0, 0.0]);
                let driven = freedom.translations.iter().find(|(i, _)| *i == solved);
                projection *= driven.map_or(1.0, |(_, d)| d[0] * along[0] + d[1] * along[1]);
            }
            Drive::Rotation { .. } => {}
            Drive::Force { direction, .. } => {
                let along = unit(direction).unwrap_or([1.0, 0.0]);
                let parts = freedom.translations.iter().map(|(i, d)| (*i, sign * (d[0] * along[0] + d[1] * along[1])));
                // What the ground takes up does no work.
                pull.extend(parts.filter(|(i, _)| self.holders[*i] != Holder::Ground));
            }
            Drive::Moment { .. } => pull.extend(freedom.rotation.map(|i| (i, sign))),
        }
        Load { solved, projection, pull }
    }
}

fn is_whole([from, to]: [f64; 2]) -> bool {
    from <= 0.0 && to >= 1.0
}

/// From an end of the beam to the flexible part, m.
fn rigid_part(beam: &Beam, end: usize, u: f64) -> [f64; 2] {
    let end_u = end as f64;
    if (u - end_u).abs() <= 0.0 {
        return [0.0; 2];
    }
    let (from, to) = (beam.shape.point_m(end_u), beam.shape.point_m(u));
    [to[0] - from[0], to[1] - from[1]]
}

/// The section at the mean thickness of a part of a beam.
fn reference_section(beam: &Beam, [from, to]: [f64; 2]) -> crate::section::Section {
    if beam.profile.is_empty() {
        return beam.section;
    }
    crate::section::Section { thickness_m: 0.5 * (beam.thickness_at(from) + beam.thickness_at(to)), ..beam.section }
}
