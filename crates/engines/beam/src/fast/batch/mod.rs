//! Many designs of one topology: four at a time, side by side.

mod net;
mod numbers;
mod schedule;
mod stress;
mod walk;

use std::fmt;

use forcewright_base::maths;

use self::net::LaneNet;
use self::numbers::BeamNumbers;
use self::schedule::Schedule;
use self::walk::{Curves, LaneWalker, Task};
use super::curve::{CurveSolver, Response};
use super::lanes::LANES;
use super::walk::TRAVEL_WEIGHT;
use crate::counters::Counters;
use crate::error::{NetworkError, Status};
use crate::model::Model;
use crate::network::{Drive, Joints, Network, Settings};
use crate::path::check_stations;
use crate::section::Section;
use crate::shape::{Shape, ShapeError};

/// The numbers of a design that a study changes; all else is its template's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variant {
    /// Position of each node at rest, m.
    pub position_m: Vec<[f64; 2]>,
    /// Bend coefficients `c_1`, `c_2`, … of each beam, rad. Its length and direction follow from its nodes, as by [`Shape::from_chord`].
    pub bend_rad: Vec<Vec<f64>>,
    /// Cross-section and material of each beam.
    pub section: Vec<Section>,
}

impl Variant {
    /// The numbers of a network.
    pub fn of(network: &Network) -> Self {
        let mut own = Self::default();
        own.copy(network);
        own
    }

    /// As [`Variant::of`], in the same buffers.
    fn copy(&mut self, network: &Network) {
        self.position_m.clear();
        self.position_m.extend(network.nodes.iter().map(|n| n.position_m));
        self.bend_rad.resize_with(network.beams.len(), Vec::new);
        for (bends, beam) in self.bend_rad.iter_mut().zip(&network.beams) {
            bends.clear();
            bends.extend_from_slice(&beam.shape.angle_rad()[1..]);
        }
        self.section.clear();
        self.section.extend(network.beams.iter().map(|b| b.section));
    }

    /// The template with these numbers; where there are too few of a kind, the others stay, and those too many are ignored.
    ///
    /// # Errors
    /// [`DesignError::Shape`] if a beam cannot span its nodes, [`DesignError::Network`] if the template makes no sense.
    pub fn network(&self, template: &Network) -> Result<Network, DesignError> {
        template.check_parts(false)?;
        let mut network = template.clone();
        for (node, position_m) in network.nodes.iter_mut().zip(&self.position_m) {
            node.position_m = *position_m;
        }
        let ends = |b: usize| [network.beams[b].start, network.beams[b].end].map(|n| network.nodes[n].position_m);
        let shapes: Result<Vec<Shape>, DesignError> = (0..network.beams.len().min(self.bend_rad.len()))
            .map(|beam| {
                let [from, to] = ends(beam);
                let chord_m = [to[0] - from[0], to[1] - from[1]];
                Shape::from_chord(chord_m, &self.bend_rad[beam]).map_err(|fault| DesignError::Shape { beam, fault })
            })
            .collect();
        for ((beam, shape), section) in network.beams.iter_mut().zip(shapes?).zip(&self.section) {
            (beam.shape, beam.section) = (shape, *section);
        }
        Ok(network)
    }
}

/// Why a design has no curve.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignError {
    /// A beam cannot span its nodes.
    Shape {
        /// The beam.
        beam: usize,
        /// Why not.
        fault: ShapeError,
    },
    /// The network makes no sense.
    Network(NetworkError),
}

impl fmt::Display for DesignError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape { beam, fault } => write!(f, "beam {beam}: {fault}"),
            Self::Network(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for DesignError {}

impl From<NetworkError> for DesignError {
    fn from(error: NetworkError) -> Self {
        Self::Network(error)
    }
}

/// Solves the curves of many designs of one topology, several at a time. A curve depends on nothing but its own design: it is the same
/// bits alone or in any company, in any order.
#[derive(Debug)]
pub struct BatchSolver {
    walker: LaneWalker<5, 8, 3>,
    finer: LaneWalker<7, 10, 3>,
    single: CurveSolver,
    numbers: Vec<BeamNumbers>,
    waiting: [Variant; LANES],
    curves: Curves,
    response: Response,
}

impl Default for BatchSolver {
    fn default() -> Self {
        Self::new()
    }
}

/// What all designs of a batch have in common.
struct Common<'a> {
    template: &'a Network,
    stations_m: &'a [f64],
    settings: &'a Settings,
    net: LaneNet,
    schedule: Schedule,
    projection: f64,
}

impl<'a> Common<'a> {
    /// `None` where designs must be solved one by one.
    fn new(template: &'a Network, stations_m: &'a [f64], settings: &'a Settings) -> Option<Self> {
        let driven = matches!(template.drive, Drive::Displacement { .. }) && settings.joints == Joints::Point;
        let moving = stations_m.last().is_some_and(|s| *s > 0.0);
        if !(driven && moving && settings.accuracy >= FINEST && settings.accuracy < 1.0) || template.check_parts(false).is_err() {
            return None;
        }
        let model = Model::new(template, settings.theory);
        if !model.plain {
            return None;
        }
        let net = LaneNet::new(&model, TRAVEL_WEIGHT);
        let schedule = Schedule::new(stations_m, intervals(settings.accuracy));
        Some(Self { template, stations_m, settings, net, schedule, projection: model.projection })
    }

    /// Whether a network differs from the template in nothing but numbers that may differ, and these make sense.
    fn fits(&self, network: &Network) -> bool {
        let (a, b) = (network, self.template);
        let sizes = a.nodes.len() == b.nodes.len() && a.beams.len() == b.beams.len() && a.before.is_empty() && a.drive == b.drive;
        sizes
            && a.nodes.iter().zip(&b.nodes).all(|(a, b)| a.support == b.support)
            && a.beams.iter().zip(&b.beams).all(|(a, b)| {
                let ends = [a.start, a.end] == [b.start, b.end] && a.arms_m == b.arms_m && a.profile.is_empty();
                ends && a.start_joint == b.start_joint && a.end_joint == b.end_joint && a.section.fault().is_none()
            })
    }
}

/// The finest accuracy for which designs are solved side by side.
const FINEST: f64 = 3e-5;

/// Steps to the end.
fn intervals(accuracy: f64) -> usize {
    // Interpolation with slopes is of eighth order, but the tangents are not better than the predictions.
    let wanted = 8.0 * maths::powf(1e-4 / accuracy, 0.2);
    (FEWEST_INTERVALS..MOST_INTERVALS).find(|n| *n as f64 >= wanted - 1e-9).unwrap_or(MOST_INTERVALS)
}

/// Fewest steps to the end: the predictions of fewer are too far off for most designs.
const FEWEST_INTERVALS: usize = 7;
/// Most steps to the end: enough for [`FINEST`].
const MOST_INTERVALS: usize = 11;

impl BatchSolver {
    /// Empty buffers and the tables of all resolutions.
    pub fn new() -> Self {
        Self {
            walker: LaneWalker::new(),
            finer: LaneWalker::new(),
            single: CurveSolver::new(),
            numbers: Vec::new(),
            waiting: Default::default(),
            curves: Curves::default(),
            response: Response::default(),
        }
    }

    /// The curves of networks at ascending stations ≥ 0, m, in their order. `sink` is given the index of each and its curve.
    ///
    /// Neighbours that differ only in the positions of nodes, shapes and sections are solved side by side. Those that are not safe there,
    /// and all where the accuracy asked for is below 3e-5, are solved as by [`CurveSolver::solve`], with the same result.
    pub fn solve(
        &mut self,
        networks: &[Network],
        stations_m: &[f64],
        settings: &Settings,
        mut sink: impl FnMut(usize, Result<&Response, DesignError>),
    ) {
        let sound = check_stations(stations_m).is_ok();
        let mut common: Option<Common> = None;
        let mut first = 0;
        while let Some(network) = networks.get(first) {
            if sound && !common.as_ref().is_some_and(|c| c.fits(network)) {
                common = Common::new(network, stations_m, settings).filter(|c| c.fits(network)).or(common);
            }
            let four = &networks[first..networks.len().min(first + LANES)];
            let together = common.as_mut().map_or(0, |c| {
                let count = four.iter().take_while(|n| c.fits(n)).count();
                if count > 0 {
                    self.load(c.template.beams.len(), &four[..count]);
                    self.run(c, false);
                }
                count
            });
            for (lane, network) in four.iter().enumerate().take(together.max(1)) {
                if lane < together && self.curves.accepted[lane] {
                    self.take(lane);
                    sink(first + lane, Ok(&self.response));
                } else {
                    sink(first + lane, self.single.solve(network, stations_m, settings).map_err(DesignError::from));
                }
            }
            first += together.max(1);
        }
    }

    /// The curves of `count` variants of a network, which `set` is asked for one after the other: it is given the index of a design and
    /// the numbers of the template, which it changes. All else as [`BatchSolver::solve`]. No [`Network`] is set up for designs that
    /// are solved side by side.
    pub fn solve_variants(
        &mut self,
        template: &Network,
        count: usize,
        mut set: impl FnMut(usize, &mut Variant),
        stations_m: &[f64],
        settings: &Settings,
        mut sink: impl FnMut(usize, Result<&Response, DesignError>),
    ) {
        let stations = check_stations(stations_m);
        let mut common = if stations.is_ok() { Common::new(template, stations_m, settings) } else { None };
        let mut first = 0;
        while first < count {
            let lanes = (count - first).min(LANES);
            let mut fits = [false; LANES];
            for (lane, (variant, fits)) in self.waiting.iter_mut().zip(&mut fits).enumerate().take(lanes) {
                variant.copy(template);
                set(first + lane, variant);
                *fits = variant.fits(template);
            }
            if let Some(common) = &mut common
                && fits.contains(&true)
            {
                self.load_variants(template, fits);
                self.run(common, true);
            } else {
                fits = [false; LANES];
            }
            for (lane, fits) in fits.into_iter().enumerate().take(lanes) {
                if fits && self.curves.accepted[lane] {
                    self.take(lane);
                    sink(first + lane, Ok(&self.response));
                    continue;
                }
                let network = self.waiting[lane].network(template);
                let solved = network.and_then(|n| self.single.solve(&n, stations_m, settings).map_err(DesignError::from));
                sink(first + lane, solved);
            }
            first += lanes;
        }
    }

    /// Fills the lanes with designs that fit; those left over with the first.
    fn load(&mut self, beams: usize, networks: &[Network]) {
        self.numbers.resize_with(beams, BeamNumbers::default);
        for (b, numbers) in self.numbers.iter_mut().enumerate() {
            numbers.clear();
            for lane in 0..LANES {
                let network = networks.get(lane).unwrap_or(&networks[0]);
                let beam = &network.beams[b];
                let [from, to] = [beam.start, beam.end].map(|n| network.nodes[n].position_m);
                let angles = beam.shape.angle_rad().iter().copied();
                numbers.set(lane, [to[0] - from[0], to[1] - from[1]], beam.shape.length_m(), angles, &beam.section);
            }
        }
    }

    /// The same for variants; lanes with one that does not fit get another.
    fn load_variants(&mut self, template: &Network, fits: [bool; LANES]) {
        self.numbers.resize_with(template.beams.len(), BeamNumbers::default);
        let spare = fits.iter().position(|f| *f).unwrap_or(0);
        for (b, (numbers, beam)) in self.numbers.iter_mut().zip(&template.beams).enumerate() {
            numbers.clear();
            for (lane, fits) in fits.iter().enumerate() {
                let variant = &self.waiting[if *fits { lane } else { spare }];
                let [from, to] = [beam.start, beam.end].map(|n| variant.position_m[n]);
                let angles = std::iter::once(0.0).chain(variant.bend_rad[b].iter().copied());
                numbers.set(lane, [to[0] - from[0], to[1] - from[1]], 0.0, angles, &variant.section[b]);
            }
        }
    }

    fn run(&mut self, common: &mut Common, spanned: bool) {
        let task = Task {
            numbers: &self.numbers,
            spanned,
            theory: common.settings.theory,
            schedule: &common.schedule,
            travel_m: common.stations_m.last().copied().unwrap_or(0.0),
            projection: common.projection,
            accuracy: common.settings.accuracy,
        };
        self.walker.run(&task, &mut common.net, &mut self.finer, &mut self.curves);
        let iterations = common.schedule.steps.iter().map(|s| s.iterations as u64).sum::<u64>() + 1;
        self.response.counters = Counters {
            newton_iterations: iterations,
            residual_evaluations: iterations + 1,
            factorisations: iterations + 1,
            steps: common.schedule.steps.len() as u64,
            rejected_steps: 0,
        };
    }

    /// Copies the curve of a lane.
    fn take(&mut self, lane: usize) {
        let (curves, out) = (&self.curves, &mut self.response);
        out.clear();
        out.force_n.extend(curves.force_n.iter().map(|v| v.0[lane]));
        out.stiffness_n_per_m.extend(curves.stiffness_n_per_m.iter().map(|v| v.0[lane]));
        out.stress_pa.extend(curves.stress_pa.iter().map(|v| v.0[lane]));
        out.stress_beam.extend(curves.stress_beam.iter().map(|b| whole(b.0[lane])));
        (out.error_estimate, out.stress_error_estimate) = (curves.error_estimate.0[lane], curves.stress_error_estimate.0[lane]);
        (out.status, out.general, out.instability) = (Status::Complete, false, Some(curves.instability[lane]));
    }

    /// Numbers that the buffers have room for: constant once the largest network has been solved.
    pub fn room(&self) -> usize {
        let response = &self.response;
        let out = response.force_n.capacity() + response.stress_pa.capacity() + self.curves.force_n.capacity();
        self.walker.room() + self.finer.room() + self.single.room() + self.numbers.capacity() + out
    }
}

/// The whole number that a lane carries.
fn whole(value: f64) -> usize {
    (0..Network::LARGEST).find(|n| *n as f64 >= value).unwrap_or(0)
}

impl Variant {
    /// Whether all sizes are those of the template, and the sections make sense.
    fn fits(&self, template: &Network) -> bool {
        let sizes = self.position_m.len() == template.nodes.len()
            && self.bend_rad.len() == template.beams.len()
            && self.section.len() == template.beams.len();
        sizes && self.section.iter().all(|s| s.fault().is_none())
    }
}
