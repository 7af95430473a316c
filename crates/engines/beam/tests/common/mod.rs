//! Networks that several tests share.
#![allow(dead_code, reason = "each test file uses a part")]
#![allow(clippy::approx_constant, reason = "the paper prints 1.5707")]

pub(crate) mod generator;
pub(crate) mod shooting;

use forcewright_base::{maths, quadrature::GaussLegendre};
use forcewright_beam::{
    Beam, Drive, Joint, Network, Node, Parameter, Path, Rotation, Section, Settings, Shape, ShapeError, Support, Theory, trace,
};

/// Material and section of Table 2: `E = 2 GPa`, w = 1 mm, t = 10 mm. Poisson's ratio of polyoxymethylene is not in the paper.
pub(crate) const POM: Section = Section { young_pa: 2e9, thickness_m: 1e-3, depth_m: 1e-2, poisson: Some(0.35) };

/// Table 3 of Lan, Wang & Chen 2010, rad. The last coefficient is printed +1.148; only −1.148 closes.
pub(crate) const TABLE3_SHAPES: [[f64; 3]; 4] =
    [[0.4592, 1.3092, -1.5707], [1.6382, -0.7560, 1.5707], [-4.081, 0.3013, 1.5707], [2.394, 0.226, -1.148]];
/// Lengths, cm.
pub(crate) const TABLE3_LENGTHS: [f64; 4] = [3.404, 1.987, 2.199, 1.959];
/// Nodes `n_1` … `n_5`, cm.
pub(crate) const TABLE3_NODES: [[f64; 2]; 5] = [[0.25, 0.0], [3.45, 0.0], [3.05, 1.877], [1.244, 2.40], [0.25, 4.0]];

pub(crate) fn exact(theory: Theory) -> Settings {
    Settings { theory, accuracy: 1e-9, ..Settings::default() }
}

pub(crate) fn elastica() -> Settings {
    exact(Theory::Inextensible)
}

pub(crate) fn solve(network: &Network, stations: &[f64], settings: &Settings) -> Path {
    let path = trace(network, stations, settings, &mut |_| true).expect("a sound network");
    assert!(path.status.is_complete(), "{} after {} points", path.status, path.points.len());
    assert_eq!(path.points.len(), stations.len());
    path
}

// The only places where these are written out.

pub(crate) fn joined(start: usize, end: usize, shape: Shape, section: Section, [start_joint, end_joint]: [Joint; 2]) -> Beam {
    Beam { start_joint, end_joint, ..Beam::new(start, end, shape, section) }
}

pub(crate) fn network(nodes: Vec<Node>, beams: Vec<Beam>, drive: Drive) -> Network {
    Network::new(nodes, beams, drive)
}

pub(crate) fn elastic(young_pa: f64, thickness_m: f64, depth_m: f64, poisson: Option<f64>) -> Section {
    Section { young_pa, thickness_m, depth_m, poisson }
}

pub(crate) fn rigid(start: usize, end: usize, shape: Shape, section: Section) -> Beam {
    joined(start, end, shape, section, [Joint::Rigid, Joint::Rigid])
}

pub(crate) fn unit(v: [f64; 2]) -> [f64; 2] {
    let length = maths::hypot(v[0], v[1]);
    [v[0] / length, v[1] / length]
}

/// ∫ f over [a, b], accurate to rounding for smooth integrands.
pub(crate) fn integral(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let rule = GaussLegendre::new(20);
    let width = (b - a) / 60.0;
    (0..60).map(|i| width * rule.integrate(|u| f(a + (f64::from(i) + u) * width))).sum()
}

pub(crate) fn node(position_m: [f64; 2], support: Support) -> Node {
    Node { position_m, support }
}

pub(crate) const VERTICAL_GUIDE: Support = Support::Slider { direction: [0.0, 1.0], rotation: Rotation::Fixed };

/// The half mechanism of Fig. 3 with given beams: `n_1` and `n_2` clamped, `n_5` on a vertical guide and pushed down.
pub(crate) fn half_mechanism(nodes_m: [[f64; 2]; 5], shapes: [Shape; 4], section: Section) -> Network {
    let [a, b, c, d] = shapes;
    let supports = [Support::Clamped, Support::Clamped, Support::Free, Support::Free, VERTICAL_GUIDE];
    network(
        nodes_m.iter().zip(supports).map(|(p, s)| node(*p, s)).collect(),
        vec![rigid(0, 2, a, section), rigid(1, 2, b, section), rigid(2, 3, c, section), rigid(3, 4, d, section)],
        Drive::Displacement { node: 4, direction: [0.0, -1.0] },
    )
}

/// Table 3 with the printed shapes and lengths; the nodes follow from `n_1`.
pub(crate) fn table3_by_shapes(section: Section) -> Network {
    let shapes: Vec<Shape> =
        TABLE3_SHAPES.iter().zip(TABLE3_LENGTHS).map(|(c, l)| Shape::new(c.to_vec(), l * 1e-2).expect("a shape")).collect();
    let chord = |i: usize| shapes[i].chord_m();
    let n1 = [0.25e-2, 0.0];
    let n3 = add(n1, chord(0), 1.0);
    let n2 = add(n3, chord(1), -1.0);
    let n4 = add(n3, chord(2), 1.0);
    let n5 = add(n4, chord(3), 1.0);
    half_mechanism([n1, n2, n3, n4, n5], shapes.try_into().expect("four"), section)
}

/// Table 3 with the printed nodes and bends; `c_0` and lengths follow.
pub(crate) fn table3_by_nodes(section: Section) -> Network {
    let n = TABLE3_NODES.map(|p| p.map(|x| x * 1e-2));
    let ends = [(0, 2), (1, 2), (2, 3), (3, 4)];
    let shape = |i: usize| Shape::from_chord(add(n[ends[i].1], n[ends[i].0], -1.0), &TABLE3_SHAPES[i][1..]).expect("a shape");
    half_mechanism(n, [shape(0), shape(1), shape(2), shape(3)], section)
}

pub(crate) fn add(a: [f64; 2], b: [f64; 2], factor: f64) -> [f64; 2] {
    [a[0] + factor * b[0], a[1] + factor * b[1]]
}

/// A straight beam from a clamp at the origin along a direction, with its other end as given.
pub(crate) fn cantilever(length_m: f64, angle_rad: f64, section: Section, support: Support, drive: Drive) -> Network {
    let shape = Shape::new(vec![angle_rad], length_m).expect("a shape");
    let nodes = vec![node([0.0, 0.0], Support::Clamped), node(shape.chord_m(), support)];
    network(nodes, vec![rigid(0, 1, shape, section)], drive)
}

#[track_caller]
pub(crate) fn near(got: f64, want: f64, tolerance: f64, what: &str) {
    assert!((got - want).abs() <= tolerance * want.abs().max(f64::MIN_POSITIVE), "{what}: got {got:.15e}, want {want:.15e}");
}

#[track_caller]
pub(crate) fn close(got: f64, want: f64, absolute: f64, what: &str) {
    assert!((got - want).abs() <= absolute, "{what}: got {got:.15e}, want {want:.15e}");
}

/// Steele, Lea & Flood, "Fast splittable pseudorandom number generators", 2014.
pub(crate) struct SplitMix(pub(crate) u64);

impl SplitMix {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [−range, range].
    pub(crate) fn around(&mut self, range: f64) -> f64 {
        range * (2.0 * (self.next() >> 11) as f64 / (1_u64 << 53) as f64 - 1.0)
    }
}

pub(crate) const ENDS: [(usize, usize); 4] = [(0, 2), (1, 2), (2, 3), (3, 4)];

/// Nodes moved by up to 3 mm, bends by up to 1.5 rad.
pub(crate) fn random_network(random: &mut SplitMix, nodes_mm: f64, bend: f64) -> Result<Network, ShapeError> {
    bent_at_random(random, nodes_mm, |random, i, k| TABLE3_SHAPES[i][k] + random.around(bend))
}

/// The half mechanism with its nodes moved at random by up to some millimetres, and bends `k` of beams `i` as given.
pub(crate) fn bent_at_random(
    random: &mut SplitMix,
    nodes_mm: f64,
    bend: impl Fn(&mut SplitMix, usize, usize) -> f64,
) -> Result<Network, ShapeError> {
    let nodes = TABLE3_NODES.map(|p| p.map(|x| x * 1e-2 + random.around(nodes_mm * 1e-3)));
    let mut shapes = Vec::new();
    for i in 0..TABLE3_SHAPES.len() {
        let bends = [1, 2].map(|k| bend(random, i, k));
        shapes.push(Shape::from_chord(add(nodes[ENDS[i].1], nodes[ENDS[i].0], -1.0), &bends)?);
    }
    Ok(half_mechanism(nodes, shapes.try_into().expect("four"), POM))
}

/// What an optimiser of the half mechanism moves: two nodes, both bends of four beams, and the thickness of all.
pub(crate) fn parameters() -> Vec<Parameter> {
    let mut all = vec![Parameter::NodeX(2), Parameter::NodeY(2), Parameter::NodeX(3), Parameter::NodeY(3)];
    all.extend((0..4).flat_map(|beam| [1, 2].map(|k| Parameter::Bend { beam, k })));
    all.push(Parameter::AllThickness);
    all
}

/// All kinds of parameters.
pub(crate) fn more_parameters() -> Vec<Parameter> {
    let mut all = parameters();
    all.extend([Parameter::NodeX(0), Parameter::NodeY(1), Parameter::NodeX(4), Parameter::NodeY(4)]);
    all.extend([Parameter::Thickness(1), Parameter::Depth(2), Parameter::Young(3), Parameter::Poisson(0)]);
    all.extend([Parameter::AllDepth, Parameter::AllYoung, Parameter::AllPoisson]);
    all
}

/// A change of a parameter that matters about as much as others: 1 cm, 1 rad, the whole of a property.
pub(crate) fn scale(parameter: Parameter) -> f64 {
    match parameter {
        Parameter::NodeX(_) | Parameter::NodeY(_) => 1e-2,
        Parameter::Thickness(_) | Parameter::AllThickness => POM.thickness_m,
        Parameter::Depth(_) | Parameter::AllDepth => POM.depth_m,
        Parameter::Young(_) | Parameter::AllYoung => POM.young_pa,
        _ => 1.0,
    }
}
