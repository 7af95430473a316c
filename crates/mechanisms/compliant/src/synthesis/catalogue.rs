//! The shapes that a synthesis starts from, each solved once at the size of its file.
//!
//! Of an inextensible shape of size L, F·L²/EI and σ·L/(E·w) depend on Δ/L alone (Lan, Wang & Chen 2010, eq. (6)): one curve per shape is
//! enough for all sizes, thicknesses and materials. Where beams stretch as they bend, that holds at one thickness over size: such a shape is
//! solved by Reissner's theory, and all its lengths grow together.

use std::sync::OnceLock;

use forcewright_base::diagnostics::Diagnostics;
use forcewright_base::maths;
use forcewright_beam::{BeamState, Point, Theory, clearance};
use forcewright_contract::numbers::{Number, numbers_of};
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;

use crate::analysis::{Behaviour, curvature_ratio};
use crate::design::{self, Design, si};
use crate::force_curve::{ForceCurve, Interval};
use crate::spec::Spec;
use crate::synthesis::room::Pad;

/// A shape of the catalogue.
pub(crate) struct Topology {
    /// Name, fit for a file.
    pub name: &'static str,
    /// A whole project file; the comment at its head says where the shape comes from.
    pub text: &'static str,
}

macro_rules! topologies {
    ($($name:literal),* $(,)?) => {
        [$(Topology { name: $name, text: include_str!(concat!("../topologies/", $name, ".toml")) }),*]
    };
}

/// Every shape.
pub(crate) static TOPOLOGIES: [Topology; COUNT] = topologies![
    "one-beam-a",
    "one-beam-b",
    "one-beam-c",
    "chain-lan",
    "four-beam-lan",
    "four-beam-rising-a",
    "four-beam-rising-b",
    "four-beam-rising-c",
    "four-beam-bent-a",
    "four-beam-bent-b",
    "four-beam-bent-c",
    "four-beam-flat-a",
    "four-beam-flat-b",
    "inclined-and-folded",
];
const COUNT: usize = 14;

/// Travels at which a shape may be stopped, as parts of the travel of its file: the first, and how many.
const FIRST_STOP: f64 = 0.3;
const STOPS: usize = 24;
/// Steps of the path at whose ends the distance between beams and the room are looked at.
const STATES: usize = 48;
/// Places along a beam at which the room that it takes is looked at.
const PLACES: u32 = 24;

/// A shape stopped at a travel, at the size of its file.
#[derive(Clone, Debug)]
pub(crate) struct Stop {
    /// The travel d, m.
    pub travel_m: f64,
    /// Force over displacement up to there, N.
    pub curve: ForceCurve,
    /// Of the beams up to there: the largest strain, and thickness over radius at its place, both per thickness over size, 1/m. Pairs of
    /// which no other has both larger.
    strains_per_m: Vec<[f64; 2]>,
    /// Least stiffness up to there, N/m.
    pub stiffness_n_per_m: f64,
    /// Largest, N/m.
    pub stiffness_max_n_per_m: f64,
    /// The box that the axes of all copies in the plane take up to there: least and largest x and y, m.
    pub low_m: [f64; 2],
    /// The other corner.
    pub high_m: [f64; 2],
    /// Least distance of the axes of two beams up to there, m; infinite where none face each other.
    pub gap_m: f64,
    /// Ends of beams where pads and blocks are made, of the drawn half.
    pub pads: Vec<Pad>,
    /// How near to the mirror line beams come beyond the block, against the load and along it, m; infinite where none are.
    pub inside_m: [f64; 2],
}

/// A shape, solved.
pub(crate) struct Solved {
    /// The file.
    pub topology: &'static Topology,
    /// The shape's title.
    pub title: String,
    /// The comment at the head of the file.
    pub made: String,
    /// Every number of the file.
    pub numbers: Vec<Number>,
    /// E·I of a beam of the file, N·m².
    pub bending_stiffness_n_m2: f64,
    /// Length of the shortest beam, m.
    pub shortest_m: f64,
    /// How many beams are drawn.
    pub beams: usize,
    /// Thickness of the thickest beam over that of the design.
    pub thickest: f64,
    /// Thickness over size, where the shape has a curve of its own at every such ratio, m.
    pub slimness_m: Option<f64>,
    /// Distance of the load node from the mirror line, m.
    pub block_m: f64,
    /// From the shortest travel to the longest.
    pub stops: Vec<Stop>,
}

/// A shape by its place in [`TOPOLOGIES`], solved when it is first asked for; `None` if its file is not in order.
pub(crate) fn solved(index: usize) -> Option<&'static Solved> {
    static ALL: [OnceLock<Option<Solved>>; COUNT] = [const { OnceLock::new() }; COUNT];
    ALL.get(index)?.get_or_init(|| solve(TOPOLOGIES.get(index)?)).as_ref()
}

/// Every shape.
pub(crate) fn all() -> impl Iterator<Item = &'static Solved> {
    (0..COUNT).filter_map(solved)
}

fn solve(topology: &'static Topology) -> Option<Solved> {
    let project = Project::from_text(topology.name, topology.text, &Choices::default());
    let mut diagnostics = Diagnostics::default();
    let mut spec: Spec = read::read(&project.tree, project.root, &mut diagnostics);
    let design = design::resolve(&mut spec, &mut diagnostics)?;
    let behaviour = Behaviour::of(&design, &mut |_| true).ok()?;
    let behaviour = behaviour.trusted(&design);
    let section = design.network.beams.first()?.section;
    let reach_m = behaviour.path.points.last().map(|p| behaviour.delta_m(p))?;
    let last = behaviour.path.points.len().saturating_sub(1);
    let looks: Vec<Look> =
        (0..=STATES).filter_map(|i| behaviour.path.points.get(i * last / STATES)).map(|p| Look::at(&design, &behaviour, p)).collect();
    let stop = |i: usize| {
        let part = FIRST_STOP + (1.0 - FIRST_STOP) * i as f64 / (STOPS - 1) as f64;
        stopped(&design, &behaviour, &looks, part * reach_m)
    };
    let thickness_m = design.network.beams.iter().map(|b| b.section.thickness_m).fold(0.0, f64::max);
    let given_m = si(spec.design.thickness.as_ref()).unwrap_or(section.thickness_m);
    Some(Solved {
        topology,
        title: design.title.clone(),
        made: topology.text.split_inclusive('\n').take_while(|l| l.starts_with('#')).collect(),
        numbers: numbers_of(&mut spec),
        bending_stiffness_n_m2: section.young_pa * section.depth_m * maths::powi(given_m, 3) / 12.0,
        shortest_m: design.network.beams.iter().map(|b| b.shape.length_m()).fold(f64::INFINITY, f64::min),
        beams: design.network.beams.len(),
        thickest: thickness_m / given_m,
        slimness_m: (design.theory == Theory::Reissner).then_some(given_m),
        block_m: design.network.nodes.get(design.load_node)?.position_m[0].abs(),
        stops: (0..STOPS).filter_map(stop).collect(),
    })
}

/// What is seen of a state.
#[allow(clippy::struct_field_names, reason = "a unit is part of a name")]
struct Look {
    at_m: f64,
    low_m: [f64; 2],
    high_m: [f64; 2],
    gap_m: f64,
    pads: Vec<Pad>,
    inside_m: [f64; 2],
}

impl Look {
    fn at(design: &Design, behaviour: &Behaviour, point: &Point) -> Self {
        let distance = clearance(&design.network, Some(point), &design.layout.neighbours());
        let thickness_m = design.network.beams.iter().map(|b| b.section.thickness_m).fold(0.0, f64::max);
        let gap_m = distance.map_or(f64::INFINITY, |c| c.distance_m + thickness_m);
        let given_m = design.network.beams.first().map_or(thickness_m, |b| b.section.thickness_m);
        let block = design.network.nodes[design.load_node].position_m[1] + point.nodes[design.load_node].displacement_m[1];
        let mut look = Self {
            at_m: behaviour.delta_m(point),
            low_m: [f64::INFINITY; 2],
            high_m: [f64::NEG_INFINITY; 2],
            gap_m,
            pads: Pad::of(design, point, given_m),
            inside_m: [f64::INFINITY; 2],
        };
        for beam in &point.beams {
            for drawn in (0..=PLACES).map(|i| beam.shape_m(f64::from(i) / f64::from(PLACES))) {
                let way = usize::from(drawn[1] < block);
                look.inside_m[way] = look.inside_m[way].min(drawn[0].abs());
                for image in design.layout.images() {
                    let at = image.of(drawn);
                    look.low_m = [0, 1].map(|axis| look.low_m[axis].min(at[axis]));
                    look.high_m = [0, 1].map(|axis| look.high_m[axis].max(at[axis]));
                }
            }
        }
        look
    }
}

/// The shape stopped at the station next to a travel.
fn stopped(design: &Design, behaviour: &Behaviour, looks: &[Look], travel_m: f64) -> Option<Stop> {
    let reached = travel_m * (1.0 + 1e-9);
    let points = &behaviour.path.points;
    let points = &points[..points.partition_point(|p| behaviour.delta_m(p) <= reached)];
    let pick = |f: &dyn Fn(&Point) -> f64| points.iter().map(f).collect::<Vec<f64>>();
    let stiffness = pick(&|p| behaviour.stiffness_n_per_m(p));
    let curve = (points.len() >= 2)
        .then(|| ForceCurve::new(pick(&|p| behaviour.delta_m(p)), pick(&|p| behaviour.force_n(p)), stiffness.clone()))?;
    // The look behind the travel counts too: what lies between two is not passed over.
    let count = looks.partition_point(|l| l.at_m < travel_m) + 1;
    let seen = &looks[..count.min(looks.len())];
    let first = seen.first()?.pads.clone();
    let pads = seen.iter().fold(first, |all, look| all.iter().zip(&look.pads).map(|(a, b)| a.and(b)).collect());
    Some(Stop {
        travel_m: curve.end(),
        strains_per_m: strains(design, points),
        pads,
        inside_m: [0, 1].map(|way| seen.iter().map(|l| l.inside_m[way]).fold(f64::INFINITY, f64::min)),
        stiffness_n_per_m: curve.least_slope(),
        stiffness_max_n_per_m: stiffness.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        low_m: [0, 1].map(|axis| seen.iter().map(|l| l.low_m[axis]).fold(f64::INFINITY, f64::min)),
        high_m: [0, 1].map(|axis| seen.iter().map(|l| l.high_m[axis]).fold(f64::NEG_INFINITY, f64::max)),
        gap_m: seen.iter().map(|l| l.gap_m).fold(f64::INFINITY, f64::min),
        curve,
    })
}

/// Strain and thickness over radius where the stress of a beam is largest, per thickness of the design: those that no other exceeds in both.
fn strains(design: &Design, points: &[Point]) -> Vec<[f64; 2]> {
    let beams = &design.network.beams;
    let given_m = beams.first().map_or(1.0, |b| b.section.thickness_m);
    let of = |(index, state): (usize, &BeamState)| {
        let (beam, peak) = (beams.get(index)?, state.peak_stress());
        Some([peak.stress_pa / beam.section.young_pa, curvature_ratio(beam, peak.u)].map(|ratio| ratio / given_m))
    };
    let mut all: Vec<[f64; 2]> = points.iter().flat_map(|p| p.beams.iter().enumerate().filter_map(of)).collect();
    all.sort_by(|a, b| b[0].total_cmp(&a[0]).then(b[1].total_cmp(&a[1])));
    let mut most_curved = f64::NEG_INFINITY;
    all.retain(|[_, curved]| {
        let kept = *curved > most_curved;
        most_curved = most_curved.max(*curved);
        kept
    });
    all
}

impl Stop {
    /// The largest thickness over size, 1, at which the strain at the inner face is no more than allowed.
    pub(super) fn thickest(&self, strain: f64) -> f64 {
        // x·e·(1 + x·k/3) = ε, in the form without cancellation.
        let of = |&[e, k]: &[f64; 2]| 2.0 * strain / (e * (1.0 + (1.0 + 4.0 * k * strain / (3.0 * e)).sqrt()));
        self.strains_per_m.iter().map(of).fold(f64::INFINITY, f64::min)
    }

    /// The strain at the inner face at a thickness over size.
    #[cfg(test)]
    pub(super) fn strain(&self, slenderness: f64) -> f64 {
        self.strains_per_m.iter().map(|[e, k]| slenderness * e * (1.0 + slenderness * k / 3.0)).fold(0.0, f64::max)
    }

    /// Width and height that the axes take, m.
    pub(super) fn room_m(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.high_m[axis] - self.low_m[axis])
    }

    /// The longest window inside a band whose level is free, and that level, N.
    pub(super) fn window(&self, band: f64) -> Option<(Interval, f64)> {
        let window = self.curve.longest_flat(band)?;
        let (high, low) = self.curve.extent(window);
        Some((window, f64::midpoint(high, low)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Mirror;

    /// What the room of a shape takes for granted: a mirror line x = 0, a load down the y axis, a block beside the line.
    #[test]
    fn every_shape_is_solved_and_drawn_alike() {
        assert_eq!(all().count(), COUNT);
        for (topology, shape) in TOPOLOGIES.iter().zip(all()) {
            let project = Project::from_text(topology.name, topology.text, &Choices::default());
            let mut diagnostics = Diagnostics::default();
            let mut spec: Spec = read::read(&project.tree, project.root, &mut diagnostics);
            let design = design::resolve(&mut spec, &mut diagnostics).expect("in order");
            assert_eq!((design.layout.mirror, design.direction), (Some(Mirror::X(0.0)), [0.0, -1.0]), "{}", topology.name);
            assert!(shape.block_m > 0.0 && shape.stops.len() == STOPS, "{}", topology.name);
            assert!(shape.stops.iter().all(|s| s.pads.iter().any(|p| p.loaded) && s.pads.iter().any(|p| !p.loaded)));
        }
    }
}
