//! The shapes that a synthesis starts from, each solved once at the size of its file.
//!
//! Of an inextensible shape of size L, F·L²/EI and σ·L/(E·w) depend on Δ/L alone (Lan, Wang & Chen 2010, eq. (6)): one curve per shape is
//! enough for all sizes, thicknesses and materials.

use std::sync::OnceLock;

use forcewright_base::diagnostics::Diagnostics;
use forcewright_beam::{Point, Section, clearance};
use forcewright_contract::numbers::{Number, numbers_of};
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;

use crate::analysis::Behaviour;
use crate::design::{self, Design};
use crate::force_curve::{ForceCurve, Interval};
use crate::spec::Spec;

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
];
const COUNT: usize = 13;

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
    /// Largest bending strain per thickness up to there, 1/m.
    pub strain_per_m: f64,
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
        stopped(&behaviour, &looks, &section, part * reach_m)
    };
    Some(Solved {
        topology,
        title: design.title.clone(),
        made: topology.text.split_inclusive('\n').take_while(|l| l.starts_with('#')).collect(),
        numbers: numbers_of(&mut spec),
        bending_stiffness_n_m2: section.bending_stiffness_n_m2(),
        shortest_m: design.network.beams.iter().map(|b| b.shape.length_m()).fold(f64::INFINITY, f64::min),
        beams: design.network.beams.len(),
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
}

impl Look {
    fn at(design: &Design, behaviour: &Behaviour, point: &Point) -> Self {
        let distance = clearance(&design.network, Some(point), &design.layout.neighbours());
        let thickness_m = design.network.beams.iter().map(|b| b.section.thickness_m).fold(0.0, f64::max);
        let gap_m = distance.map_or(f64::INFINITY, |c| c.distance_m + thickness_m);
        let mut look = Self { at_m: behaviour.delta_m(point), low_m: [f64::INFINITY; 2], high_m: [f64::NEG_INFINITY; 2], gap_m };
        for beam in &point.beams {
            for drawn in (0..=PLACES).map(|i| beam.shape_m(f64::from(i) / f64::from(PLACES))) {
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
fn stopped(behaviour: &Behaviour, looks: &[Look], section: &Section, travel_m: f64) -> Option<Stop> {
    let reached = travel_m * (1.0 + 1e-9);
    let points = &behaviour.path.points;
    let points = &points[..points.partition_point(|p| behaviour.delta_m(p) <= reached)];
    let pick = |f: &dyn Fn(&Point) -> f64| points.iter().map(f).collect::<Vec<f64>>();
    let stiffness = pick(&|p| behaviour.stiffness_n_per_m(p));
    let curve = (points.len() >= 2)
        .then(|| ForceCurve::new(pick(&|p| behaviour.delta_m(p)), pick(&|p| behaviour.force_n(p)), stiffness.clone()))?;
    let stress = points.iter().filter_map(Point::peak_stress).map(|(_, peak)| peak.stress_pa).fold(0.0, f64::max);
    // The look behind the travel counts too: what lies between two is not passed over.
    let count = looks.partition_point(|l| l.at_m < travel_m) + 1;
    let seen = &looks[..count.min(looks.len())];
    Some(Stop {
        travel_m: curve.end(),
        strain_per_m: stress / (section.young_pa * section.thickness_m),
        stiffness_n_per_m: curve.least_slope(),
        stiffness_max_n_per_m: stiffness.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        low_m: [0, 1].map(|axis| seen.iter().map(|l| l.low_m[axis]).fold(f64::INFINITY, f64::min)),
        high_m: [0, 1].map(|axis| seen.iter().map(|l| l.high_m[axis]).fold(f64::NEG_INFINITY, f64::max)),
        gap_m: seen.iter().map(|l| l.gap_m).fold(f64::INFINITY, f64::min),
        curve,
    })
}

impl Stop {
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
