//! The states of one design along its path, at one polynomial degree.

use super::curve::Response;
use super::gradient::ForceGradient;
use super::hermite::Hermite;
use super::kernel::{Beams, Condensed, Tables, Unknowns, linearise};
use super::lanes::{LANES, Lane};
use super::network::{Net, add_scaled};
use super::stress::{Group, Sampling, StressModel};
use crate::counters::Counters;
use crate::model::Model;
use crate::network::Network;

/// Largest distance between prediction and solution, rad, as in the general path.
const LARGEST_CORRECTION: f64 = 0.02;
/// A displacement counts this many times as much as a rotation.
pub(super) const TRAVEL_WEIGHT: f64 = 6.0;
/// Largest change of a rotation in one step, rad.
const LARGEST_TURN: f64 = 0.4;
const MOST_ITERATIONS: usize = 6;
/// Intervals longer than this many times the half of a neighbour are halved with it.
const GRADE: f64 = 2.5;
/// Times that states are added where the interpolation asks for them.
const MOST_ROUNDS: usize = 6;
/// How close iterations come to states that are added, relative to the others.
const CLOSER: f64 = 0.03;
/// Part of the error allowed once states have been added.
const SHARP: f64 = 0.5;
/// Part of that from which a state is refined if others are.
const NEARLY_ROUGH: f64 = 0.25;
/// An error of the polynomial degree beyond so many times what is allowed is not one of the states that were looked at.
const UNRESOLVED: f64 = 2.0;
const MOST_STEPS: usize = 400;
/// Largest start of the last iteration per accuracy of the force, as the tangent is right to that only.
const TANGENT: f64 = 2.0;
/// Below this accuracy values between states come from states without tangents.
pub(super) const TIGHT: f64 = 3e-7;

/// Why a walk ended without a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum GiveUp {
    /// A higher polynomial degree may do.
    Unresolved,
    /// The general path must decide.
    Unsafe,
}

/// What a curve is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Task<'a> {
    pub(super) network: &'a Network,
    pub(super) model: &'a Model,
    pub(super) stations_m: &'a [f64],
    pub(super) accuracy: f64,
}

/// Intervals on both sides of the rough states, and those that would be much longer than their neighbours, by their first states.
fn halved(controls: &[f64], rough: &[usize]) -> Vec<usize> {
    let lengths: Vec<f64> = controls.windows(2).map(|w| w[1] - w[0]).collect();
    let mut marked = vec![false; lengths.len()];
    rough.iter().flat_map(|j| [j - 1, *j]).for_each(|i| marked[i] = true);
    loop {
        let beside = |i: usize| [i.checked_sub(1), Some(i + 1)].into_iter().flatten().filter(|n| marked.get(*n) == Some(&true));
        let long = |i: &usize| !marked[*i] && beside(*i).any(|n| lengths[*i] > GRADE * 0.5 * lengths[n]);
        let Some(next) = (0..lengths.len()).find(long) else { break };
        marked[next] = true;
    }
    (0..lengths.len()).filter(|i| marked[*i]).collect()
}

impl Task<'_> {
    /// The last station, dimensionless.
    fn end(&self) -> f64 {
        self.stations_m.last().map_or(0.0, |s| s / self.model.length_m)
    }

    /// Whether tangents, which one iteration leaves less accurate than states, are not used between the states: then states are closer
    /// together, but one iteration does for each.
    pub(super) fn tight(&self) -> bool {
        self.accuracy < TIGHT
    }

    /// Largest start of the last iteration, which squares the distance.
    fn accepted(&self) -> f64 {
        if self.tight() { 0.2 * self.accuracy.sqrt() } else { TANGENT * self.accuracy }
    }

    /// States used to interpolate the force.
    pub(super) fn states(&self) -> usize {
        if self.tight() { 10 } else { 4 }
    }

    /// States used to interpolate the stress.
    fn stress_states(&self) -> usize {
        if self.accuracy < 2e-4 { self.states() } else { 2 }
    }
}

/// A state of the network, with derivatives by the control.
#[derive(Clone, Debug, Default)]
pub(crate) struct Node<const M: usize, const E: usize> {
    pub(super) x: Vec<f64>,
    dx: Vec<f64>,
    pub(super) groups: Vec<Group<M, E>>,
    force: f64,
    slope: f64,
}

/// Walks along a path with `M` bubbles and `Q = M + E` points per beam.
#[derive(Debug)]
pub(super) struct Walker<const M: usize, const Q: usize, const E: usize> {
    pub(super) tables: Tables<M, Q, E>,
    sampling: Sampling<M, E>,
    pub(super) net: Net,
    /// Whether no beam may be softened.
    exact: bool,
    pub(super) beams: Vec<Beams<Q>>,
    stress: Vec<StressModel>,
    pub(super) condensed: Vec<Condensed<M, Q>>,
    /// The first `controls.len()` are states of this walk.
    pub(super) nodes: Vec<Node<M, E>>,
    pub(super) controls: Vec<f64>,
    /// States around which the interpolation is not good enough.
    rough: Vec<usize>,
    pub(super) hermite: Hermite,
    stress_hermite: Hermite,
    pub(super) x: Vec<f64>,
    pub(super) inner: Vec<Unknowns<M>>,
    angle: Vec<Lane>,
}

impl<const M: usize, const Q: usize, const E: usize> Walker<M, Q, E> {
    pub(super) fn new() -> Self {
        Self {
            tables: Tables::new(),
            sampling: Sampling::new(),
            net: Net::default(),
            exact: false,
            rough: Vec::new(),
            beams: Vec::new(),
            stress: Vec::new(),
            condensed: Vec::new(),
            nodes: Vec::new(),
            controls: Vec::new(),
            hermite: Hermite::default(),
            stress_hermite: Hermite::default(),
            x: Vec::new(),
            inner: Vec::new(),
            angle: Vec::new(),
        }
    }

    /// Curve and stress into `out`, and the gradient of the force where it is asked for. `finer` checks the resolution.
    pub(super) fn run<const N: usize, const R: usize, const D: usize>(
        &mut self,
        task: &Task,
        counters: &mut Counters,
        out: &mut Response,
        mut finer: Option<&mut Walker<N, R, D>>,
        gradient: Option<&mut ForceGradient>,
    ) -> Result<(), GiveUp> {
        if !self.prepare(task) {
            return Err(GiveUp::Unresolved);
        }
        // As many states as the interpolation asks for on curves like the paper's; more between those where that is not enough.
        let intervals = if task.tight() { 17.0 } else { 6.5 };
        let reference = if task.tight() { 1e-8 } else { 1e-3 };
        let spacing = task.end() / (intervals * forcewright_base::maths::powf(reference / task.accuracy, 0.09));
        self.walk(task, spacing, counters)?;
        let instability = self.net.instability;
        let (mut interpolation, mut largest) = ([f64::INFINITY; 2], [f64::MIN_POSITIVE; 2]);
        for round in 0..=MOST_ROUNDS {
            self.emit(task, out);
            let peak = |values: &[f64]| values.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
            let force = self.nodes[..self.controls.len()].iter().fold(f64::MIN_POSITIVE, |m, n| m.max(n.force.abs()));
            largest = [force, peak(&out.stress_pa)];
            // Curves with sharp turns deceive the estimate a little.
            let part = if round == 0 { 1.0 } else { SHARP };
            let allowed = [part * task.accuracy * largest[0], part * STRESS_RATIO * task.accuracy * largest[1]];
            interpolation = self.interpolation_error(task, allowed);
            if self.rough.is_empty() || round == MOST_ROUNDS {
                break;
            }
            // States that a higher degree will not keep are not worth others between them.
            if let (0, Some(finer)) = (round, finer.as_deref_mut()) {
                let resolution = self.resolution_error(task, counters, finer)?;
                let far = |i: usize, ratio: f64| resolution[i] > UNRESOLVED * ratio * task.accuracy * largest[i];
                if far(0, 1.0) || far(1, STRESS_RATIO) {
                    return Err(GiveUp::Unresolved);
                }
            }
            if !self.refine(task, counters)? {
                break;
            }
        }
        let resolution = match finer {
            Some(finer) => self.resolution_error(task, counters, finer)?,
            None => self.tail().map(|t| t * largest[0]),
        };
        let [force, stress] = [0, 1].map(|i| resolution[i].max(interpolation[i]) / largest[i]);
        // Written so that NaN fails.
        if !(force <= task.accuracy && stress <= STRESS_RATIO * task.accuracy) {
            let resolved = resolution[0] <= task.accuracy * largest[0] && resolution[1] <= STRESS_RATIO * task.accuracy * largest[1];
            return Err(if resolved { GiveUp::Unsafe } else { GiveUp::Unresolved });
        }
        (out.error_estimate, out.stress_error_estimate, out.instability) = (force, stress, Some(instability));
        if let Some(gradient) = gradient {
            gradient.prepare(task, &self.tables, &self.beams);
            self.contract(task, counters, gradient)?;
            gradient.emit(task, &self.controls, &mut self.hermite, &mut out.force_gradient);
        }
        Ok(())
    }

    /// Constants of the network. Whether every beam surely reaches from node to node.
    fn prepare(&mut self, task: &Task) -> bool {
        self.net.prepare(task.model, TRAVEL_WEIGHT);
        StressModel::prepare(task.model, &mut self.stress);
        self.prepare_beams(task)
    }

    /// Constants of all beams at the points of the rule, four to a group; the last group is filled up with quarter circles that nothing
    /// moves. Whether every beam surely reaches from node to node.
    fn prepare_beams(&mut self, task: &Task) -> bool {
        self.exact = task.tight();
        let model = task.model;
        let groups = model.beams.len().div_ceil(LANES);
        self.beams.resize_with(groups, Beams::default);
        self.condensed.resize_with(groups, Condensed::default);
        let mut closed = true;
        for (four, beams) in model.beams.chunks(LANES).zip(&mut self.beams) {
            let coefficients = four.iter().map(|b| b.info.shape.angle_rad().len()).max().unwrap_or(0).max(2);
            self.angle.clear();
            self.angle.resize(coefficients, Lane::ZERO);
            *beams = Beams::default();
            self.angle[1] = Lane::splat(std::f64::consts::FRAC_PI_2);
            for (lane, beam) in four.iter().enumerate() {
                let c = &beam.constants;
                beams.length.0[lane] = c.length;
                beams.bending.0[lane] = c.bending;
                beams.axial.0[lane] = c.axial;
                beams.shear.0[lane] = c.shear;
                beams.soft |= c.axial > 0.0 || c.shear > 0.0;
                self.angle[1].0[lane] = 0.0;
                for (target, value) in self.angle.iter_mut().zip(beam.info.shape.angle_rad()) {
                    target.0[lane] = *value;
                }
            }
            let mut chord = [Lane::ZERO; 2];
            for q in 0..Q {
                let u = self.tables.u[q];
                let angle = self.angle.iter().rev().fold(Lane::ZERO, |sum, c| sum * u + *c);
                (beams.sin[q], beams.cos[q]) = angle.sin_cos_reduced();
                beams.weight[q] = -(beams.length * self.tables.weight[q]);
                chord[0] -= beams.weight[q] * beams.cos[q];
                chord[1] -= beams.weight[q] * beams.sin[q];
            }
            for (lane, beam) in four.iter().enumerate() {
                let [from, to] = beam.nodes.map(|n| task.network.nodes[n].position_m);
                for axis in 0..2 {
                    let gap = to[axis] - from[axis] - chord[axis].0[lane] * model.length_m;
                    closed &= gap.abs() <= 0.5 * Network::LARGEST_GAP * beam.info.shape.length_m();
                }
            }
        }
        closed
    }

    /// Steps from rest to the end.
    fn walk(&mut self, task: &Task, spacing: f64, counters: &mut Counters) -> Result<(), GiveUp> {
        let (projection, end) = (task.model.projection, task.end());
        self.controls.clear();
        self.x.clear();
        self.x.resize(self.net.unknowns, 0.0);
        self.inner.clear();
        self.inner.resize(self.beams.len(), Unknowns::default());
        // The prediction is wanted this close.
        let accepted = task.accepted();
        let wanted = if task.tight() { 0.4 * accepted } else { (0.5 * accepted.sqrt()).min(0.4 * LARGEST_CORRECTION) };
        let predicting = if task.tight() { 2 } else { 3 };
        self.iterate(counters)?;
        self.keep(0.0, projection);
        let mut step = (LARGEST_TURN / self.size(&self.net.tangent, projection)).min(end) / 4.0;
        let mut here = 0.0;
        while here < end {
            if self.controls.len() > MOST_STEPS {
                return Err(GiveUp::Unsafe);
            }
            let left = end - here;
            // Closer together near the ends, where interpolation has neighbours on one side only, and at the beginning predictions.
            let crowding = if task.tight() {
                (here.min(left) / (0.2 * end)).clamp(0.16, 1.0).sqrt()
            } else {
                (0.6 + 1.6 * here / end).min(1.2).min(0.6 + 1.2 * left / end)
            };
            let limit = (LARGEST_TURN / self.size(&self.net.tangent, projection)).min(spacing * crowding);
            let length = step.min(limit);
            let target = if left <= 1.15 * length {
                end
            } else if left < 2.0 * length {
                here + 0.55 * left
            } else {
                here + length
            };
            if let Some(distance) = self.advance(target, projection, (accepted, predicting), counters)? {
                counters.steps += 1;
                // The prediction is at least of fourth order.
                let ratio = wanted / distance.max(1e-300);
                step = (target - here).max(1e-12) * (0.9 * ratio.sqrt().sqrt()).clamp(0.4, 2.5);
                here = target;
            } else {
                counters.rejected_steps += 1;
                step = 0.4 * (target - here);
                if step < 1e-4 * end {
                    return Err(GiveUp::Unsafe);
                }
            }
        }
        Ok(())
    }

    /// One step; the distance of the prediction, or `None` if it must be shorter.
    fn advance(
        &mut self,
        target: f64,
        projection: f64,
        (accepted, predicting): (f64, usize),
        counters: &mut Counters,
    ) -> Result<Option<f64>, GiveUp> {
        self.predict(target, projection, predicting);
        let distance = self.correct(accepted, counters)?;
        if distance.is_some() {
            self.keep(target, projection);
        }
        Ok(distance)
    }

    /// Brings the states into the order of their controls; buffers stay where they are.
    fn sort(&mut self) {
        // Those added are few and at the end: insertion.
        for last in 1..self.controls.len() {
            let mut at = last;
            while at > 0 && self.controls[at] < self.controls[at - 1] {
                self.controls.swap(at, at - 1);
                self.nodes.swap(at, at - 1);
                at -= 1;
            }
        }
    }

    /// Newton iterations from a prediction; the distance of it from the state, or `None` if it was too far away.
    fn correct(&mut self, accepted: f64, counters: &mut Counters) -> Result<Option<f64>, GiveUp> {
        let mut first = None;
        for _ in 0..MOST_ITERATIONS {
            self.iterate(counters)?;
            let distance = self.size(&self.net.change, 1.0);
            let start = *first.get_or_insert(distance);
            if start > LARGEST_CORRECTION || start.is_nan() {
                return Ok(None);
            }
            if distance <= accepted {
                return Ok(Some(start));
            }
        }
        Ok(None)
    }

    /// Adds a state half way to each neighbour of the rough ones. Whether there was room for them.
    fn refine(&mut self, task: &Task, counters: &mut Counters) -> Result<bool, GiveUp> {
        let (count, projection) = (self.controls.len(), task.model.projection);
        let old = self.controls.clone();
        let halves = halved(&old, &self.rough);
        if count + halves.len() > MOST_STEPS {
            return Ok(false);
        }
        for before in halves {
            let target = 0.5 * (old[before] + old[before + 1]);
            self.hermite.reset(task.tight());
            self.hermite.around(&old, before, task.states());
            self.interpolate(target, projection);
            // Slopes of states close together must fit each other.
            if self.correct(CLOSER * task.accepted(), counters)?.is_none() {
                return Err(GiveUp::Unsafe);
            }
            counters.steps += 1;
            self.keep(target, projection);
        }
        self.sort();
        Ok(true)
    }

    /// Hermite extrapolation from the last states.
    fn predict(&mut self, target: f64, projection: f64, states: usize) {
        self.hermite.reset(false);
        self.hermite.last(&self.controls, states);
        self.interpolate(target, projection);
    }

    /// The unknowns at a control from the states that the interpolation uses.
    pub(super) fn interpolate(&mut self, target: f64, projection: f64) {
        self.hermite.place(target);
        self.x.fill(0.0);
        self.inner.fill(Unknowns::default());
        for (i, [value, slope]) in self.hermite.weights() {
            let node = &self.nodes[i];
            for (x, (own, by)) in self.x.iter_mut().zip(node.x.iter().zip(&node.dx)) {
                *x += value * own + slope * by;
            }
            for (inner, group) in self.inner.iter_mut().zip(&node.groups) {
                add_scaled(inner, &group.at, value);
                add_scaled(inner, &group.by, slope);
            }
        }
        if let Some(driven) = self.x.last_mut() {
            *driven = target / projection;
        }
    }

    /// One Newton iteration from the current state, which it corrects.
    pub(super) fn iterate(&mut self, counters: &mut Counters) -> Result<(), GiveUp> {
        counters.newton_iterations += 1;
        self.linearise(counters)?;
        for (x, c) in self.x.iter_mut().zip(&self.net.change) {
            *x += c;
        }
        for (g, (inner, condensed)) in self.inner.iter_mut().zip(&self.condensed).enumerate() {
            let (ends, apart) = self.net.ends(g, &self.net.change);
            add_scaled(inner, &condensed.expand(ends, apart, 1.0), 1.0);
        }
        Ok(())
    }

    /// Linearises all beams at the current state and solves the network.
    fn linearise(&mut self, counters: &mut Counters) -> Result<(), GiveUp> {
        counters.residual_evaluations += 1;
        counters.factorisations += 1;
        self.net.clear();
        for (g, beams) in self.beams.iter().enumerate() {
            let (ends, apart) = self.net.ends(g, &self.x);
            self.inner[g].ends = ends;
            linearise(&self.tables, beams, &self.inner[g], (apart, self.exact), &mut self.condensed[g]).map_err(|_| GiveUp::Unsafe)?;
            self.net.add(g, &self.condensed[g]);
        }
        self.net.solve().map_err(|_| GiveUp::Unsafe)
    }

    /// Stores the state and its derivative by the control.
    fn keep(&mut self, control: f64, projection: f64) {
        let index = self.controls.len();
        if self.nodes.len() == index {
            self.nodes.push(Node::default());
        }
        self.controls.push(control);
        let node = &mut self.nodes[index];
        node.force = self.net.reaction / projection;
        node.slope = self.net.slope / (projection * projection);
        node.x.clone_from(&self.x);
        node.dx.clear();
        node.dx.extend(self.net.tangent.iter().map(|t| t / projection));
        node.groups.resize(self.beams.len(), Group::default());
        for (g, group) in node.groups.iter_mut().enumerate() {
            group.at = self.inner[g];
            let (ends, apart) = self.net.ends(g, &node.dx);
            let condensed = &self.condensed[g];
            group.by = condensed.expand(ends, apart, 0.0);
            (group.beyond, group.beyond_by) = condensed.beyond(&self.tables, self.beams[g].bending, &group.by);
            self.sampling.survey(&self.stress[g], group);
        }
    }

    /// Weighted size of a change of the network's unknowns.
    pub(super) fn size(&self, change: &[f64], divisor: f64) -> f64 {
        let sizes = change.iter().zip(&self.net.weights).map(|(c, w)| (c * w).abs());
        // Keeps NaN.
        sizes.fold(0.0, |m: f64, s| if s > m || s.is_nan() { s } else { m }) / divisor.abs()
    }

    /// Force, slope and stress at the stations.
    fn emit(&mut self, task: &Task, out: &mut Response) {
        out.clear();
        let model = task.model;
        let (states, stress_states) = (task.states(), task.stress_states());
        self.hermite.reset(task.tight());
        self.stress_hermite.reset(task.tight());
        let mut interval = 0;
        for station in task.stations_m {
            let at = station / model.length_m;
            while interval + 2 < self.controls.len() && self.controls[interval + 1] < at {
                interval += 1;
            }
            self.hermite.around(&self.controls, interval, states);
            self.hermite.place(at);
            let (mut force, mut slope) = (0.0, 0.0);
            for ((i, [value, by]), [d_value, d_by]) in self.hermite.weights().zip(self.hermite.slope) {
                let node = &self.nodes[i];
                force += value * node.force + by * node.slope;
                slope += d_value * node.force + d_by * node.slope;
            }
            out.force_n.push(force * model.force_n);
            out.stiffness_n_per_m.push(slope * model.force_n / model.length_m);
            let hermite = if stress_states == states {
                &self.hermite
            } else {
                self.stress_hermite.around(&self.controls, interval, stress_states);
                self.stress_hermite.place(at);
                &self.stress_hermite
            };
            let around = [interval, (interval + 1).min(self.controls.len() - 1)];
            let [from, to] = around.map(|i| self.controls[i]);
            let between = if to > from { (at - from) / (to - from) } else { 0.0 };
            let (beam, peak) = self.sampling.peak(model, &self.stress, &self.nodes, (around, between), hermite, task.accuracy);
            out.stress_pa.push(peak);
            out.stress_beam.push(beam);
        }
    }

    /// Estimated errors of force and stress between the states: each state is left out and predicted from those around it, which is a
    /// much harder task. In Pa the second, the first dimensionless. If one of them is
    /// not `allowed` somewhere, the states there are rough.
    fn interpolation_error(&mut self, task: &Task, allowed: [f64; 2]) -> [f64; 2] {
        let count = self.controls.len();
        self.rough.clear();
        if count < 4 {
            self.rough.extend(1..count.saturating_sub(1));
            return if task.end() > 0.0 { [f64::INFINITY; 2] } else { [0.0; 2] };
        }
        let (mut worst, mut roughest) = ([0.0_f64; 2], Vec::with_capacity(count));
        let left_out = if task.tight() { LEFT_OUT_TIGHT } else { LEFT_OUT };
        let (states, stress_states) = (task.states(), task.stress_states());
        self.hermite.reset(task.tight());
        self.stress_hermite.reset(task.tight());
        for j in 1..count - 1 {
            let node = &self.nodes[j];
            self.hermite.without(&self.controls, j, states);
            self.hermite.place(self.controls[j]);
            let mut force = -node.force;
            for (i, [value, by]) in self.hermite.weights() {
                force += value * self.nodes[i].force + by * self.nodes[i].slope;
            }
            let mut here = [left_out * force.abs(), 0.0];
            let hermite = if states == stress_states {
                &self.hermite
            } else {
                self.stress_hermite.without(&self.controls, j, stress_states);
                self.stress_hermite.place(self.controls[j]);
                &self.stress_hermite
            };
            for (g, stress) in self.stress.iter().enumerate() {
                for place in 0..3 {
                    let mut slope = -node.groups[g].survey.slope[place];
                    for (i, [value, by]) in hermite.weights() {
                        let from = &self.nodes[i].groups[g].survey;
                        slope += from.slope[place] * value + from.slope_by[place] * by;
                    }
                    here[1] = here[1].max(left_out * largest_lane((slope * stress.bending).abs()));
                }
            }
            roughest.push((here[0] / allowed[0]).max(here[1] / allowed[1]));
            worst = [worst[0].max(here[0]), worst[1].max(here[1])];
        }
        // Once there is work to do, what is nearly too rough is done with it. What is not a number is rough.
        let above = |part: f64| (1..count - 1).zip(&roughest).filter(move |(_, r)| **r > part || r.is_nan()).map(|(j, _)| j);
        if above(1.0).next().is_some() {
            self.rough.extend(above(NEARLY_ROUGH));
        }
        worst
    }

    /// Change of force and stress at one state by one iteration with a higher degree: the error of this one. The state is the one
    /// where the energy of the modes beyond those solved for grows fastest, as the force is the slope of the energy.
    fn resolution_error<const N: usize, const R: usize, const D: usize>(
        &mut self,
        task: &Task,
        counters: &mut Counters,
        finer: &mut Walker<N, R, D>,
    ) -> Result<[f64; 2], GiveUp> {
        let energy = |node: &Node<M, E>| {
            let group = |(beams, group): (&Beams<Q>, &Group<M, E>)| {
                let squares = group.beyond.iter().fold(Lane::ZERO, |sum, a| sum + *a * *a);
                (squares * beams.bending).0.iter().sum::<f64>()
            };
            self.beams.iter().zip(&node.groups).map(group).sum::<f64>()
        };
        let (mut worst, mut steepest, mut before) = (0, -1.0, 0.0);
        for (i, node) in self.nodes[..self.controls.len()].iter().enumerate() {
            let here = energy(node);
            let slope = if i == 0 { 0.0 } else { (here - before).abs() / (self.controls[i] - self.controls[i - 1]) };
            if slope > steepest {
                (worst, steepest) = (i, slope);
            }
            before = here;
        }
        // The network is the same at every degree.
        std::mem::swap(&mut self.net, &mut finer.net);
        finer.prepare_beams(task);
        let node = &self.nodes[worst];
        let (force, slopes) = finer.probe(node, counters)?;
        let mut stress = 0.0_f64;
        for ((group, finer), factor) in node.groups.iter().zip(slopes).zip(&self.stress) {
            for (a, b) in group.survey.slope.iter().zip(finer) {
                stress = stress.max(largest_lane(((*a - b) * factor.bending).abs()));
            }
        }
        std::mem::swap(&mut self.net, &mut finer.net);
        let safety = if task.tight() { RESOLUTION_TIGHT } else { RESOLUTION };
        Ok([safety * (force / task.model.projection - node.force).abs(), safety * stress])
    }

    /// Reaction and slopes along the beams after one iteration from a state of lower degree.
    fn probe<const K: usize, const D: usize>(
        &mut self,
        node: &Node<K, D>,
        counters: &mut Counters,
    ) -> Result<(f64, impl Iterator<Item = [Lane; 3]>), GiveUp> {
        self.x.clone_from(&node.x);
        self.inner.clear();
        for group in &node.groups {
            let mut wide = Unknowns { ends: group.at.ends, force: group.at.force, ..Unknowns::default() };
            wide.bubbles[..K].copy_from_slice(&group.at.bubbles);
            self.inner.push(wide);
        }
        self.linearise(counters)?;
        let slopes = self.condensed.iter().enumerate().map(|(g, condensed)| {
            let (ends, apart) = self.net.ends(g, &self.net.change);
            let change = condensed.expand(ends, apart, 1.0);
            let (mut beyond, along) = condensed.beyond(&self.tables, self.beams[g].bending, &change);
            for (b, a) in beyond.iter_mut().zip(along) {
                *b += a;
            }
            let mut at = self.inner[g];
            add_scaled(&mut at, &change, 1.0);
            self.sampling.probe(&at, &beyond)
        });
        Ok((self.net.reaction, slopes))
    }

    /// For the highest degree, which has no finer one: the square of the last amplitudes relative to the largest, and themselves.
    fn tail(&self) -> [f64; 2] {
        let groups = &self.nodes[self.controls.len() - 1].groups;
        let largest = |range: std::ops::Range<usize>| {
            let bubbles = groups.iter().flat_map(|g| &g.at.bubbles[range.clone()]);
            largest_lane(bubbles.fold(Lane::ZERO, |m, b| m.max(b.abs())))
        };
        let ratio = largest(M - 2..M) / largest(0..M).max(f64::MIN_POSITIVE);
        [ratio * ratio, 0.0]
    }

    /// Contracts all states with their tangents. Where one iteration sufficed, the tangents are made as accurate as the states by one more.
    fn contract(&mut self, task: &Task, counters: &mut Counters, gradient: &mut ForceGradient) -> Result<(), GiveUp> {
        gradient.start(self.controls.len());
        for i in 0..self.controls.len() {
            if task.tight() {
                self.x.clone_from(&self.nodes[i].x);
                for (inner, group) in self.inner.iter_mut().zip(&self.nodes[i].groups) {
                    *inner = group.at;
                }
                self.iterate(counters)?;
                for tangent in &mut self.net.tangent {
                    *tangent /= task.model.projection;
                }
            }
            for (g, (beams, group)) in self.beams.iter().zip(&self.nodes[i].groups).enumerate() {
                if task.tight() {
                    let (ends, apart) = self.net.ends(g, &self.net.tangent);
                    let by = self.condensed[g].expand(ends, apart, 0.0);
                    gradient.add(i, g, &self.tables, beams, (&self.inner[g], &by));
                } else {
                    gradient.add(i, g, &self.tables, beams, (&group.at, &group.by));
                }
            }
        }
        Ok(())
    }

    /// Room of all buffers.
    pub(super) fn room(&self) -> usize {
        self.nodes.capacity() + self.controls.capacity() + self.condensed.capacity() + self.beams.capacity() + self.inner.capacity()
    }
}

/// A stress may be wrong by this much more than a force: it is a derivative of the shape, the force one of the energy.
pub(super) const STRESS_RATIO: f64 = 10.0;
/// Part of the error at a state left out that remains between the states; from the random designs of the tests.
const LEFT_OUT: f64 = 0.4;
/// The same of the longer interpolation for tight accuracies, which falls faster between the states.
const LEFT_OUT_TIGHT: f64 = 0.25;
/// Safety of the difference between two degrees, taken at one state.
const RESOLUTION: f64 = 4.0;
/// The same at the high degrees of tight accuracies, where a difference tells more.
const RESOLUTION_TIGHT: f64 = 2.5;

fn largest_lane(lane: Lane) -> f64 {
    lane.0.into_iter().fold(0.0, |m: f64, v| if v > m || v.is_nan() { v } else { m })
}
