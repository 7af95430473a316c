//! Four designs along their paths, side by side, at one polynomial degree.

use super::net::LaneNet;
use super::numbers::{BeamNumbers, Constants};
use super::schedule::{Schedule, Weights};
use super::stress::{BeamState, Between, Interval, Sampling};
use crate::fast::kernel::{Condensed, Tables, Unknowns, condense};
use crate::fast::lanes::{LANES, Lane, Vectors};
use crate::fast::walk::STRESS_RATIO;
use crate::network::Theory;

/// Largest distance between prediction and solution, rad, as in the general path.
const LARGEST_CORRECTION: f64 = 0.02;
/// Largest change of a rotation in one step by the tangent before it, rad: that its prediction is close is checked besides.
const LARGEST_TURN: f64 = 0.6;

/// What four designs have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Task<'a> {
    pub(super) numbers: &'a [BeamNumbers],
    /// Whether lengths and directions follow from the chords.
    pub(super) spanned: bool,
    pub(super) theory: Theory,
    pub(super) schedule: &'a Schedule,
    pub(super) travel_m: f64,
    pub(super) projection: f64,
    pub(super) accuracy: f64,
}

/// A state of four designs, with derivatives by the part of the travel.
#[derive(Clone, Debug, Default)]
struct State<const M: usize, const E: usize> {
    /// The unknowns of the network, then force and bubbles of all beams.
    values: Vec<Lane>,
    slopes: Vec<Lane>,
    beams: Vec<BeamState<M, E>>,
    force: Lane,
    slope: Lane,
}

/// Curves of four designs.
#[derive(Clone, Debug, Default)]
pub(super) struct Curves {
    pub(super) force_n: Vec<Lane>,
    pub(super) stiffness_n_per_m: Vec<Lane>,
    pub(super) stress_pa: Vec<Lane>,
    /// As whole numbers.
    pub(super) stress_beam: Vec<Lane>,
    pub(super) error_estimate: Lane,
    pub(super) stress_error_estimate: Lane,
    pub(super) instability: [i64; LANES],
    /// Lanes whose curves are as accurate as asked.
    pub(super) accepted: [bool; LANES],
}

/// Walks with `M` bubbles and `Q = M + E` points per beam.
#[derive(Debug)]
pub(super) struct LaneWalker<const M: usize, const Q: usize, const E: usize> {
    vectors: Vectors,
    tables: Tables<M, Q, E>,
    sampling: Sampling<M, E>,
    constants: Constants<Q>,
    condensed: Vec<Condensed<M, Q>>,
    current: Vec<Lane>,
    states: Vec<State<M, E>>,
    interval: Interval,
    /// The worst of all states so far: safety of pivots, largest rotation, first and last correction, turn of a step.
    margin: Lane,
    widest: Lane,
    first: Lane,
    last: Lane,
    turn: Lane,
}

impl<const M: usize, const Q: usize, const E: usize> LaneWalker<M, Q, E> {
    pub(super) fn new() -> Self {
        Self {
            vectors: Vectors::new(),
            tables: Tables::new(),
            sampling: Sampling::new(),
            constants: Constants::default(),
            condensed: Vec::new(),
            current: Vec::new(),
            states: Vec::new(),
            interval: Interval::default(),
            margin: Lane::ZERO,
            widest: Lane::ZERO,
            first: Lane::ZERO,
            last: Lane::ZERO,
            turn: Lane::ZERO,
        }
    }

    /// Curves of four designs, and which of them are accurate. `finer` checks the resolution.
    pub(super) fn run<const N: usize, const R: usize, const D: usize>(
        &mut self,
        task: &Task,
        net: &mut LaneNet,
        finer: &mut LaneWalker<N, R, D>,
        out: &mut Curves,
    ) {
        self.prepare(task, net);
        self.walk(task, net);
        out.instability = net.instability;
        let mut interval = std::mem::take(&mut self.interval);
        self.emit(task, &mut interval, out);
        self.interval = interval;
        let peak = |values: &[Lane]| values.iter().fold(Lane::splat(f64::MIN_POSITIVE), |m, v| m.max(v.abs()));
        let force = self.states.iter().fold(Lane::splat(f64::MIN_POSITIVE), |m, s| m.max(s.force.abs()));
        let stress = peak(&out.stress_pa);
        let interpolation = self.interpolation_error(task.schedule);
        let resolution = self.resolution_error(task, net, finer);
        out.error_estimate = resolution[0].max(interpolation[0]) / force;
        out.stress_error_estimate = resolution[1].max(interpolation[1]) / stress;
        let end = &self.states[self.states.len() - 1];
        for lane in 0..LANES {
            // Written so that NaN fails.
            let accurate = out.error_estimate.0[lane] <= task.accuracy && out.stress_error_estimate.0[lane] <= STRESS_RATIO * task.accuracy;
            let safe = self.constants.closed.0[lane] > 0.0 && self.margin.0[lane] > 1.0 && self.widest.0[lane] <= Lane::MODERATE;
            let near = self.first.0[lane] <= LARGEST_CORRECTION
                && self.last.0[lane] <= accepted(task.accuracy)
                && self.turn.0[lane] <= LARGEST_TURN;
            let finite = end.values.iter().chain(&end.slopes).chain([&end.force, &end.slope]).all(|v| v.0[lane].is_finite());
            out.accepted[lane] = accurate && safe && near && finite;
        }
    }

    fn prepare(&mut self, task: &Task, net: &LaneNet) {
        self.constants.compute(&self.tables, task.numbers, task.spanned, task.theory);
        let beams = task.numbers.len();
        self.condensed.resize_with(beams, Condensed::default);
        self.current.clear();
        self.current.resize(net.unknowns + beams * (M + 2), Lane::ZERO);
        self.states.resize_with(task.schedule.places.len(), State::default);
        (self.margin, self.widest) = (Lane::splat(f64::INFINITY), Lane::ZERO);
        (self.first, self.last, self.turn) = (Lane::ZERO, Lane::ZERO, Lane::ZERO);
    }

    /// The states of the schedule.
    fn walk(&mut self, task: &Task, net: &mut LaneNet) {
        let end = Lane::splat(task.travel_m) / self.constants.length_m;
        self.iterate(net);
        self.keep(task, net, 0);
        for (i, step) in task.schedule.steps.iter().enumerate() {
            self.predict(&step.prediction);
            self.current[net.unknowns - 1] = end * (task.schedule.places[i + 1] / task.projection);
            for iteration in 0..step.iterations {
                self.iterate(net);
                let distance = net.size(&net.change);
                if iteration == 0 {
                    self.first = self.first.max(distance);
                }
                if iteration + 1 == step.iterations {
                    self.last = self.last.max(distance);
                }
            }
            self.keep(task, net, i + 1);
            let slopes = &self.states[i].slopes[..net.unknowns];
            self.turn = self.turn.max(net.size(slopes) * step.length);
        }
    }

    /// Extrapolation from the states before.
    fn predict(&mut self, weights: &Weights) {
        self.current.fill(Lane::ZERO);
        for (i, [value, slope]) in &weights.states {
            let state = &self.states[*i];
            for (x, (own, by)) in self.current.iter_mut().zip(state.values.iter().zip(&state.slopes)) {
                *x += *own * *value + *by * *slope;
            }
        }
    }

    /// Linearises all beams at the current state, solves the network, and corrects the state.
    fn iterate(&mut self, net: &mut LaneNet) {
        self.linearise(net);
        self.vectors.run(
            #[inline(always)]
            || self.correct(net),
        );
    }

    #[inline(always)]
    fn correct(&mut self, net: &LaneNet) {
        let (x, inner) = self.current.split_at_mut(net.unknowns);
        for (x, c) in x.iter_mut().zip(&net.change) {
            *x += *c;
        }
        for (b, (inner, condensed)) in inner.chunks_exact_mut(M + 2).zip(&self.condensed).enumerate() {
            let (ends, apart) = net.ends(b, &net.change);
            let change = condensed.expand(ends, apart, 1.0);
            for (x, c) in inner.iter_mut().zip(change.force.iter().chain(&change.bubbles)) {
                *x += *c;
            }
        }
    }

    fn linearise(&mut self, net: &mut LaneNet) {
        self.vectors.run(
            #[inline(always)]
            || self.linearise_here(net),
        );
    }

    #[inline(always)]
    fn linearise_here(&mut self, net: &mut LaneNet) {
        net.clear();
        let (x, inner) = self.current.split_at(net.unknowns);
        for (b, (inner, condensed)) in inner.chunks_exact(M + 2).zip(&mut self.condensed).enumerate() {
            let (ends, apart) = net.ends(b, x);
            let at = unpack(ends, inner);
            condense(&self.tables, &self.constants.beams[b], &at, apart, Lane::sin_cos_moderate, condensed);
            self.margin = self.margin.min(condensed.margin);
            self.widest = self.widest.max(condensed.widest);
            net.add(b, condensed);
        }
        net.solve();
        self.margin = self.margin.min(net.margin);
    }

    /// Stores the state and its derivative by the part of the travel.
    fn keep(&mut self, task: &Task, net: &LaneNet, index: usize) {
        self.vectors.run(
            #[inline(always)]
            || self.keep_here(task, net, index),
        );
    }

    #[inline(always)]
    fn keep_here(&mut self, task: &Task, net: &LaneNet, index: usize) {
        let scale = Lane::splat(task.travel_m) / (self.constants.length_m * task.projection);
        let state = &mut self.states[index];
        state.force = net.reaction * (1.0 / task.projection);
        state.slope = net.slope * scale * (1.0 / task.projection);
        state.values.clone_from(&self.current);
        state.slopes.clear();
        state.slopes.extend(net.tangent.iter().map(|t| *t * scale));
        state.beams.resize(self.condensed.len(), BeamState::default());
        let (x, inner) = self.current.split_at(net.unknowns);
        for (b, (beam, inner)) in state.beams.iter_mut().zip(inner.chunks_exact(M + 2)).enumerate() {
            let condensed = &self.condensed[b];
            beam.at = unpack(net.ends(b, x).0, inner);
            let (ends, apart) = net.ends(b, &state.slopes);
            beam.by = condensed.expand(ends, apart, 0.0);
            state.slopes.extend(beam.by.force.iter().chain(&beam.by.bubbles));
            (beam.beyond, beam.beyond_by) = condensed.beyond(&self.tables, self.constants.beams[b].bending, &beam.by);
        }
        let turned = &self.constants.turned;
        let angles = |beam: usize, lane: usize, out: &mut Vec<f64>| task.numbers[beam].angle_rad(lane, turned[beam], out);
        self.sampling.survey(&self.constants.stress, &mut state.beams, angles);
    }

    /// Force, slope and stress at the stations.
    fn emit(&self, task: &Task, interval: &mut Interval, out: &mut Curves) {
        self.vectors.run(
            #[inline(always)]
            || self.emit_here(task, interval, out),
        );
    }

    #[inline(always)]
    fn emit_here(&self, task: &Task, interval: &mut Interval, out: &mut Curves) {
        out.force_n.clear();
        out.stiffness_n_per_m.clear();
        out.stress_pa.clear();
        out.stress_beam.clear();
        let constants = &self.constants;
        let angles = |beam: usize, lane: usize, out: &mut Vec<f64>| task.numbers[beam].angle_rad(lane, constants.turned[beam], out);
        let mut here = None;
        for station in &task.schedule.stations {
            let states = station.around.map(|i| &self.states[i].beams[..]);
            if here != Some(station.around) {
                interval.enter(states, (task.schedule.steps[station.around[0]].length, task.accuracy));
                here = Some(station.around);
            }
            out.force_n.push(self.force(&station.force) * constants.force_n);
            out.stiffness_n_per_m.push(self.force(&station.slope) * constants.force_n * (1.0 / task.travel_m));
            let between = Between { states, weights: station.stress };
            let (stress, beam) = between.peak(&self.sampling, interval, &constants.stress, task.accuracy, angles);
            out.stress_pa.push(stress);
            out.stress_beam.push(beam);
        }
    }

    #[inline(always)]
    fn force(&self, weights: &Weights) -> Lane {
        let term = |(i, [value, slope]): &(usize, [f64; 2])| self.states[*i].force * *value + self.states[*i].slope * *slope;
        weights.states.iter().fold(Lane::ZERO, |sum, w| sum + term(w))
    }

    /// Estimated errors of force and stress between the states: each is left out and predicted from those around it.
    fn interpolation_error(&self, schedule: &Schedule) -> [Lane; 2] {
        let mut worst = [Lane::ZERO; 2];
        for (j, [force, stress]) in schedule.left_out.iter().enumerate() {
            let left_out = &self.states[j + 1];
            worst[0] = worst[0].max((self.force(force) - left_out.force).abs() * LEFT_OUT);
            for (b, model) in self.constants.stress.iter().enumerate() {
                for place in 0..3 {
                    let term = |(i, [value, by]): &(usize, [f64; 2])| {
                        let survey = &self.states[*i].beams[b].survey;
                        survey.slope[place] * *value + survey.slope_by[place] * *by
                    };
                    let predicted = stress.states.iter().fold(Lane::ZERO, |sum, w| sum + term(w));
                    let error = (predicted - left_out.beams[b].survey.slope[place]).abs() * model.bending;
                    worst[1] = worst[1].max(error * LEFT_OUT_STRESS);
                }
            }
        }
        worst
    }

    /// Change of force and stress at one state by one iteration with a higher degree. The state is, for each design, the one where the
    /// energy of the modes beyond those solved for grows fastest, as the force is the slope of the energy.
    fn resolution_error<const N: usize, const R: usize, const D: usize>(
        &self,
        task: &Task,
        net: &mut LaneNet,
        finer: &mut LaneWalker<N, R, D>,
    ) -> [Lane; 2] {
        let worst = self.steepest(&task.schedule.places);
        finer.prepare(task, net);
        let from = |place: usize| Lane(std::array::from_fn(|lane| self.states[worst[lane]].values[place].0[lane]));
        let (own, wide) = (M + 2, N + 2);
        for place in 0..net.unknowns {
            finer.current[place] = from(place);
        }
        for b in 0..self.condensed.len() {
            for k in 0..own {
                finer.current[net.unknowns + b * wide + k] = from(net.unknowns + b * own + k);
            }
        }
        finer.linearise(net);
        let force = Lane(std::array::from_fn(|lane| self.states[worst[lane]].force.0[lane]));
        let mut stress = Lane::ZERO;
        for (b, (condensed, model)) in finer.condensed.iter().zip(&self.constants.stress).enumerate() {
            let slopes = finer.slopes_after(net, b, condensed);
            for (place, slope) in slopes.into_iter().enumerate() {
                let before = Lane(std::array::from_fn(|lane| self.states[worst[lane]].beams[b].survey.slope[place].0[lane]));
                stress = stress.max((slope - before).abs() * model.bending);
            }
        }
        let error = (net.reaction * (1.0 / task.projection) - force).abs();
        [error * RESOLUTION, stress * RESOLUTION]
    }

    /// Slopes along a beam after the iteration.
    fn slopes_after(&self, net: &LaneNet, beam: usize, condensed: &Condensed<M, Q>) -> [Lane; 3] {
        let (ends, apart) = net.ends(beam, &net.change);
        let change = condensed.expand(ends, apart, 1.0);
        let (mut beyond, along) = condensed.beyond(&self.tables, self.constants.beams[beam].bending, &change);
        for (b, a) in beyond.iter_mut().zip(along) {
            *b += a;
        }
        let first = net.unknowns + beam * (M + 2);
        let (x, inner) = (&self.current[..net.unknowns], &self.current[first..first + M + 2]);
        let mut at = unpack(net.ends(beam, x).0, inner);
        crate::fast::network::add_scaled(&mut at, &change, 1.0);
        self.sampling.slopes(&at, &beyond)
    }

    /// The state of each design where the energy of the last modes grows fastest.
    fn steepest(&self, places: &[f64]) -> [usize; LANES] {
        let (mut steepest, mut before) = (Lane::splat(-1.0), Lane::ZERO);
        let mut worst = [0; LANES];
        for (i, state) in self.states.iter().enumerate() {
            let energy = |sum: Lane, (beam, own): (&BeamState<M, E>, &crate::fast::kernel::Beams<Q>)| {
                sum + beam.beyond.iter().fold(Lane::ZERO, |sum, a| sum + *a * *a) * own.bending
            };
            let here = state.beams.iter().zip(&self.constants.beams).fold(Lane::ZERO, energy);
            let slope = if i == 0 { Lane::ZERO } else { (here - before).abs() * (1.0 / (places[i] - places[i - 1])) };
            for (lane, worst) in worst.iter_mut().enumerate() {
                if slope.0[lane] > steepest.0[lane] {
                    (*worst, steepest.0[lane]) = (i, slope.0[lane]);
                }
            }
            before = here;
        }
        worst
    }

    /// Room of all buffers.
    pub(super) fn room(&self) -> usize {
        let states: usize = self.states.iter().map(|s| s.values.capacity() + s.slopes.capacity() + s.beams.capacity()).sum();
        states + self.interval.room() + self.states.capacity() + self.condensed.capacity() + self.current.capacity()
    }
}

/// Unknowns of a beam from its end rotations and its part of the state.
#[inline(always)]
fn unpack<const M: usize>(ends: [Lane; 2], inner: &[Lane]) -> Unknowns<M> {
    Unknowns { ends, force: [inner[0], inner[1]], bubbles: std::array::from_fn(|k| inner[2 + k]) }
}

/// Largest start of the last iteration: the tangent is right to that only.
fn accepted(accuracy: f64) -> f64 {
    TANGENT * accuracy
}

/// See [`accepted`].
const TANGENT: f64 = 10.0;
/// Part of the error at a state left out that remains between the states; from the random designs of the tests. Much of it is the
/// error of the tangents, which does not fall with the distance of the states.
const LEFT_OUT: f64 = 1.0;
/// The same for the stress, between two states.
const LEFT_OUT_STRESS: f64 = 0.4;
/// Safety of the difference between two degrees, taken at one state.
const RESOLUTION: f64 = 4.0;
