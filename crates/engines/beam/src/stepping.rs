//! One path at one resolution: predictor, corrector and step control.

use forcewright_base::maths;

use crate::{
    assembly::{Resolution, System},
    counters::Counters,
    element::recover,
    error::Status,
    model::{BeamModel, Model},
    state::{BeamState, NodeState, PieceState, Point, Sampling, Solved},
};

/// Largest change of a rotation in one step, rad.
pub(crate) const LARGEST_TURN: f64 = 0.15;
/// A displacement counts this many times as much as a rotation, so that no node moves more than 1/40 of the longest beam in a step.
/// With steps of that size no path of 60 random designs left its branch.
const TRAVEL_WEIGHT: f64 = 40.0 * LARGEST_TURN;
/// Largest distance between prediction and solution, rad: more may mean another branch.
pub(crate) const LARGEST_CORRECTION: f64 = 0.02;
/// Largest part of the change in one step that the tangents at its ends leave unexplained.
pub(crate) const LARGEST_DEFECT: f64 = 0.1;
/// Newton's method ends when a correction is below this, rad. State and reaction are then right to its square, the tangent to itself.
pub(crate) const CONVERGED: f64 = 1e-8;
/// Corrections that stop shrinking below this are rounding.
pub(crate) const ROUNDING: f64 = 1e-7;
pub(crate) const MOST_ITERATIONS: u32 = 10;
/// Steps are not cut below this fraction of the first one, or of the way behind if that is shorter.
pub(crate) const SMALLEST_STEP: f64 = 1e-8;
/// A force of that many EI/L² along an inextensible beam has pulled it straight: the bends that are left are at its ends, within 1 % of
/// its length.
const STRAIGHT: f64 = 1e4;
/// A step in which the number of unstable motions changes without a limit point is repeated with a shorter one, down to this part of the
/// longest step that the tangent allows: what looks like the crossing of a branch may be a bend of the path next to one.
pub(crate) const CLOSEST_LOOK: f64 = 1.0 / 128.0;
/// The state moves this many times faster than ever before: the signature of a limit point at the smallest step.
const RUNAWAY: f64 = 100.0;

/// A state with its derivative by the control, dimensionless.
#[derive(Debug, Clone)]
pub(crate) struct Knot {
    pub(crate) control: f64,
    pub(crate) state: Vec<f64>,
    pub(crate) tangent: Vec<f64>,
    /// Number of unstable motions.
    pub(crate) instability: usize,
}

/// A path at one resolution.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) points: Vec<Point>,
    pub(crate) knots: Vec<Knot>,
    pub(crate) status: Status,
}

/// Cubic Hermite interpolation, or extrapolation, of the state.
pub(crate) fn interpolate(a: &Knot, b: &Knot, control: f64) -> Vec<f64> {
    let mut out = vec![0.0; b.state.len()];
    hermite(a, b, control, &mut out);
    out
}

fn hermite(a: &Knot, b: &Knot, control: f64, out: &mut [f64]) {
    let h = b.control - a.control;
    let s = (control - b.control) / h;
    // Written from the end b, so that it returns b exactly at s = 0.
    let from_a = s * s * (3.0 + 2.0 * s);
    let (slope_a, slope_b) = (h * s * s * (1.0 + s), h * s * (1.0 + s) * (1.0 + s));
    for (i, target) in out.iter_mut().enumerate() {
        let back = a.state[i] - b.state[i];
        *target = b.state[i] + from_a * back + slope_a * a.tangent[i] + slope_b * b.tangent[i];
    }
}

/// Why a correction failed.
pub(crate) enum Failure {
    Diverged,
    OutOfBudget,
}

/// How a step ended that was not accepted for good.
pub(crate) enum Interrupted {
    Rejected,
    OutOfBudget,
    Stopped,
}

/// Walks along one path.
pub(crate) struct Stepper<'a> {
    pub(crate) system: System<'a>,
    sampling: Sampling,
    /// Weight of each entry of a state in distances: rotations 1, displacements [`TRAVEL_WEIGHT`], forces 0.
    pub(crate) weights: Vec<f64>,
    pub(crate) budget: u64,
    pub(crate) counters: &'a mut Counters,
    pub(crate) progress: &'a mut dyn FnMut(f64) -> bool,
    pub(crate) state: Vec<f64>,
    pub(crate) predicted: Vec<f64>,
    /// Forces of what is not solved for, from the driven unknown on.
    pub(crate) holding: Vec<f64>,
}

impl<'a> Stepper<'a> {
    pub(crate) fn new(
        model: &'a Model,
        resolution: &'a Resolution,
        budget: u64,
        counters: &'a mut Counters,
        progress: &'a mut dyn FnMut(f64) -> bool,
    ) -> Self {
        let length = resolution.initial.len();
        let mut weights = vec![1.0; length];
        for (place, _) in model.nodes.iter().flat_map(|n| &n.translations) {
            weights[*place] = TRAVEL_WEIGHT;
        }
        for beam in &model.beams {
            weights[beam.force] = 0.0;
            weights[beam.force + 1] = 0.0;
        }
        Self {
            system: System::new(model, resolution),
            sampling: Sampling::new(resolution.basis.points(), resolution.basis.rule.clone()),
            weights,
            budget,
            counters,
            progress,
            state: resolution.initial.clone(),
            predicted: vec![0.0; length],
            holding: vec![0.0; model.unknowns - model.solved],
        }
    }

    /// Puts a state where the control of a kinematic drive wants it.
    pub(crate) fn drive_to(&mut self, control: f64) {
        let model = self.system.model;
        if model.kinematic {
            let driven = model.driven();
            self.predicted[driven] = self.system.resolution.initial[driven] + control / model.projection;
        }
    }

    /// Dimensionless force of a kinematic drive at the state that was just solved for.
    pub(crate) fn reaction(&self) -> f64 {
        self.holding.first().map_or(0.0, |h| h / self.system.model.projection)
    }

    /// Displacement along the drive from where it began, dimensionless.
    pub(crate) fn driven_displacement(&self, x: &[f64]) -> f64 {
        self.system.model.along_drive(x) - self.system.model.along_drive(&self.system.resolution.initial)
    }

    /// Remembers what holds the unknowns that are not solved for: exact to second order in the last correction.
    pub(crate) fn remember_holding(&mut self) {
        let first = self.system.model.solved;
        for (i, target) in self.holding.iter_mut().enumerate() {
            *target = self.system.holding(first + i);
        }
    }

    /// Walks from rest through all stations.
    pub(crate) fn run(mut self, stations: &[f64]) -> Run {
        let mut run = Run { points: Vec::with_capacity(stations.len()), knots: Vec::new(), status: Status::Complete };
        if let Some(status) = self.start(&mut run) {
            run.status = status;
            return run;
        }
        let unit = self.system.model.control_unit();
        let goal = stations.last().copied().unwrap_or(0.0) / unit;
        let first = self.step_limit(&run.knots[0]);
        let mut step = first;
        for &station in stations {
            let end = station / unit;
            while run.knots[run.knots.len() - 1].control < end {
                let here = run.knots[run.knots.len() - 1].control;
                let target = self.next_control(&run, step, end);
                let interrupted = match self.advance(&mut run.knots, target, goal) {
                    Ok(distance) => {
                        step = next_step(step, target - here, distance);
                        continue;
                    }
                    Err(interrupted) => interrupted,
                };
                let control = here * unit;
                match interrupted {
                    Interrupted::Rejected => {
                        self.counters.rejected_steps += 1;
                        step = 0.5 * (target - here);
                        let smallest = SMALLEST_STEP * first.min(here.max(1e-3 * first));
                        if step >= smallest && here + 0.25 * step > here {
                            continue;
                        }
                        run.status = self.why_stuck(&run.knots, control);
                    }
                    Interrupted::OutOfBudget => run.status = Status::IterationLimit { control, limit: self.budget },
                    Interrupted::Stopped => run.status = Status::Stopped { control },
                }
                return run;
            }
            let knot = &run.knots[run.knots.len() - 1];
            let point = self.point(&knot.state, &knot.tangent, station);
            run.points.push(point);
        }
        run
    }

    /// The state of rest; a status if the equations are singular there.
    fn start(&mut self, run: &mut Run) -> Option<Status> {
        self.counters.residual_evaluations += 1;
        self.counters.factorisations += 1;
        if let Err(singular) = self.system.linearise(&self.state, 0.0) {
            let null = self.system.null_vector(singular);
            return Some(self.name_singularity(&null));
        }
        self.system.newton_step();
        self.remember_holding();
        self.system.tangent();
        self.keep(&mut run.knots, 0.0);
        None
    }

    /// Which motion or force the equations leave open.
    fn name_singularity(&self, null: &[f64]) -> Status {
        let model = self.system.model;
        let size = |i: usize| null.get(i).map_or(0.0, |v| v.abs());
        let largest_beam = largest(model.beams.iter().map(|b| size(b.force).max(size(b.force + 1))));
        // A cut belongs to its beam.
        let drawn = |n: usize| if n < model.drawn_nodes { n } else { drawn_neighbour(model, n) };
        let node_motion = |n: usize| {
            let held = &model.nodes[n];
            let own = held.translations.iter().map(|t| t.0).chain(held.rotation).map(size).fold(0.0, f64::max);
            let ends = model.beams.iter().flat_map(|b| [(b.nodes[0], b.ends[0]), (b.nodes[1], b.ends[1])]);
            ends.filter(|e| e.0 == n).filter_map(|e| e.1).map(size).fold(own, f64::max)
        };
        let largest_node = largest((0..model.nodes.len()).map(node_motion));
        if largest_node.1 > 1e-6 * largest_beam.1 {
            Status::Mechanism { node: drawn(largest_node.0) }
        } else {
            let beam = model.spans.iter().position(|(pieces, _)| pieces.contains(&largest_beam.0));
            Status::OverConstrained { beam: beam.unwrap_or(0) }
        }
    }

    /// Largest step for which the tangent promises a small change.
    fn step_limit(&self, knot: &Knot) -> f64 {
        LARGEST_TURN / self.size(&knot.tangent).max(f64::MIN_POSITIVE)
    }

    /// Where the next step goes: never past the station, and no sliver before it.
    fn next_control(&self, run: &Run, step: f64, end: f64) -> f64 {
        let here = &run.knots[run.knots.len() - 1];
        let step = step.min(self.step_limit(here));
        let left = end - here.control;
        if left <= 1.000_001 * step {
            end
        } else if left < 2.0 * step {
            here.control + 0.5 * left
        } else {
            here.control + step
        }
    }

    /// One step to a control. Returns the distance from the prediction.
    fn advance(&mut self, knots: &mut Vec<Knot>, target: f64, goal: f64) -> Result<f64, Interrupted> {
        self.predict(knots, target);
        self.state.copy_from_slice(&self.predicted);
        match self.correct(target) {
            Ok(()) => {}
            Err(Failure::Diverged) => return Err(Interrupted::Rejected),
            Err(Failure::OutOfBudget) => return Err(Interrupted::OutOfBudget),
        }
        let distance = self.distance_from_prediction();
        if distance > LARGEST_CORRECTION {
            return Err(Interrupted::Rejected);
        }
        self.system.tangent();
        if !self.is_smooth(&knots[knots.len() - 1], target) {
            return Err(Interrupted::Rejected);
        }
        let here = &knots[knots.len() - 1];
        if self.instability() != here.instability && target - here.control > CLOSEST_LOOK * self.step_limit(here) {
            return Err(Interrupted::Rejected);
        }
        self.counters.steps += 1;
        self.keep(knots, target);
        if (self.progress)((target / goal).clamp(0.0, 1.0)) { Ok(distance) } else { Err(Interrupted::Stopped) }
    }

    /// Hermite extrapolation through two states with tangents; along the tangent if they are too close together.
    fn predict(&mut self, knots: &[Knot], target: f64) {
        let here = &knots[knots.len() - 1];
        let ahead = target - here.control;
        // Extrapolation over more than three intervals amplifies errors; an older state gives a longer one.
        let older = knots.iter().rev().skip(1).take(6).find(|k| ahead <= 3.0 * (here.control - k.control));
        if let Some(older) = older {
            hermite(older, here, target, &mut self.predicted);
        } else {
            for (p, (x, t)) in self.predicted.iter_mut().zip(here.state.iter().zip(&here.tangent)) {
                *p = x + ahead * t;
            }
        }
        self.drive_to(target);
    }

    /// Newton's method from [`Stepper::state`]. On success the system is linearised at a state that differs by less than
    /// [`CONVERGED`], and its last correction is applied.
    pub(crate) fn correct(&mut self, control: f64) -> Result<(), Failure> {
        let mut last = f64::INFINITY;
        for iteration in 0..MOST_ITERATIONS {
            if self.counters.newton_iterations >= self.budget {
                return Err(Failure::OutOfBudget);
            }
            self.counters.newton_iterations += 1;
            self.counters.residual_evaluations += 1;
            self.counters.factorisations += 1;
            if self.system.linearise(&self.state, control).is_err() {
                return Err(Failure::Diverged);
            }
            self.system.newton_step();
            let size = self.correction_size();
            // Written so that NaN fails.
            if !(size < 0.5 && size < 2.0 * last) {
                return Err(Failure::Diverged);
            }
            for (x, c) in self.state.iter_mut().zip(&self.system.change) {
                *x += c;
            }
            if size <= CONVERGED || (iteration >= 2 && size <= ROUNDING && size > 0.25 * last) {
                self.remember_holding();
                return Ok(());
            }
            last = size;
        }
        Err(Failure::Diverged)
    }

    /// Weighted size of motions.
    pub(crate) fn size(&self, v: &[f64]) -> f64 {
        v.iter().zip(&self.weights).fold(0.0, |m, (v, w)| larger(m, (v * w).abs()))
    }

    /// Size of the Newton step: motions, and forces relative to the largest.
    pub(crate) fn correction_size(&self) -> f64 {
        let change = &self.system.change;
        let (mut force, mut force_change) = (1.0_f64, 0.0_f64);
        for beam in &self.system.model.beams {
            for place in [beam.force, beam.force + 1] {
                force = force.max(self.state[place].abs());
                force_change = larger(force_change, change[place].abs());
            }
        }
        // Large forces may change by much where a beam is nearly straight, which is harmless.
        larger(self.size(change), 1e-2 * force_change / force)
    }

    pub(crate) fn distance_from_prediction(&self) -> f64 {
        let pairs = self.state.iter().zip(&self.predicted).zip(&self.weights);
        pairs.fold(0.0, |m, ((x, p), w)| larger(m, ((x - p) * w).abs()))
    }

    /// Whether the tangents at both ends of a step explain the change between them, by the trapezoidal rule. A jump to another
    /// branch may land close to the prediction, but not with a tangent that fits.
    fn is_smooth(&self, from: &Knot, control: f64) -> bool {
        let half = 0.5 * (control - from.control);
        let (mut change, mut defect) = (0.0, 0.0);
        for (i, w) in self.weights.iter().enumerate() {
            let moved = self.state[i] - from.state[i];
            change = larger(change, (w * moved).abs());
            defect = larger(defect, (w * (moved - half * (from.tangent[i] + self.system.change[i]))).abs());
        }
        defect <= LARGEST_DEFECT * change + CONVERGED
    }

    /// Stores the converged state and the tangent in [`System::change`].
    fn keep(&mut self, knots: &mut Vec<Knot>, control: f64) {
        let instability = self.instability();
        knots.push(Knot { control, state: self.state.clone(), tangent: self.system.change.clone(), instability });
    }

    fn why_stuck(&self, knots: &[Knot], control: f64) -> Status {
        let slowest = knots.iter().map(|k| self.size(&k.tangent)).fold(f64::INFINITY, f64::min);
        let now = knots.last().map_or(0.0, |k| self.size(&k.tangent));
        if let Some(beam) = knots.last().and_then(|k| self.pulled_straight(&k.state)) {
            return Status::PulledStraight { control, beam };
        }
        if now > RUNAWAY * slowest { Status::NoEquilibriumBeyond { control } } else { Status::StepTooSmall { control } }
    }

    /// An inextensible beam that has nothing left to give.
    pub(crate) fn pulled_straight(&self, state: &[f64]) -> Option<usize> {
        let model = self.system.model;
        let straight = |b: &BeamModel| {
            let along = maths::hypot(state[b.force], state[b.force + 1]);
            b.constants.axial <= 0.0 && along * b.constants.length > STRAIGHT * b.constants.bending
        };
        let piece = model.beams.iter().position(straight)?;
        model.spans.iter().position(|(pieces, _)| pieces.contains(&piece))
    }

    /// The equilibrium at a control next to a guess, or nothing.
    pub(crate) fn solve_near(&mut self, guess: Vec<f64>, target: f64, control: f64) -> Option<Point> {
        self.predicted = guess;
        self.drive_to(target);
        self.state.copy_from_slice(&self.predicted);
        self.correct(target).ok()?;
        if self.distance_from_prediction() > LARGEST_CORRECTION {
            return None;
        }
        self.system.tangent();
        let (state, tangent) = (self.state.clone(), self.system.change.clone());
        Some(self.point(&state, &tangent, control))
    }

    /// Results in SI units for the state that was just linearised.
    pub(crate) fn point(&self, x: &[f64], tangent: &[f64], control: f64) -> Point {
        let (model, resolution) = (self.system.model, self.system.resolution);
        let (length, force) = (model.length_m, model.force_n);
        let mut energy = 0.0;
        let mut pieces = Vec::with_capacity(model.beams.len());
        for (index, beam) in model.beams.iter().enumerate() {
            let at = resolution.coordinates(model, index, x);
            let mut modes = Vec::new();
            energy += recover(&resolution.basis, &resolution.rest[index], &beam.constants, at, &mut modes);
            let solved = Solved {
                force_n: at.force.map(|f| force * f),
                ends: at.ends,
                modes,
                start_displacement_m: model.end_displacement(index, 0, x).map(|u| length * u),
            };
            pieces.push(PieceState::new(solved, &beam.info, &self.sampling));
        }
        let mut pieces = pieces.into_iter();
        let beams = model.spans.iter().map(|(span, line)| BeamState::new(pieces.by_ref().take(span.len()).collect(), line.clone()));
        let (displacement, reaction) = if model.kinematic {
            (control, self.reaction() * model.reaction_unit())
        } else {
            (self.driven_displacement(x) * model.displacement_unit(), control)
        };
        Point {
            control,
            displacement,
            force: reaction,
            stiffness: self.system.stiffness(tangent) * model.reaction_unit() / model.displacement_unit(),
            instability: self.instability(),
            branch: 0,
            energy_j: energy * force * length,
            beams: beams.collect(),
            nodes: self.node_states(x, control / model.control_unit()),
            state: x.to_vec(),
            stage: model.stage,
        }
    }

    /// Motions of the nodes of the network, and what acts on them from outside.
    fn node_states(&self, x: &[f64], control: f64) -> Vec<NodeState> {
        let model = self.system.model;
        let mut outside = vec![0.0; model.unknowns];
        outside[model.solved..].copy_from_slice(&self.holding);
        for (place, force) in &model.dead {
            outside[*place] += force;
        }
        for (place, factor) in &model.pull {
            outside[*place] += control * factor;
        }
        let state = |(index, node): (usize, &crate::model::NodeFreedom)| NodeState {
            displacement_m: model.displacement(index, x).map(|u| model.length_m * u),
            rotation_rad: Model::rotation(node.rotation, x),
            force_n: model.displacement(index, &outside).map(|f| model.force_n * f),
            moment_nm: node.rotation.map_or(0.0, |i| model.force_n * model.length_m * outside[i]),
        };
        model.nodes.iter().take(model.drawn_nodes).enumerate().map(state).collect()
    }
}

/// A node of the network next to a cut.
fn drawn_neighbour(model: &Model, cut: usize) -> usize {
    let span = model.spans.iter().find(|(pieces, _)| model.beams[pieces.clone()].iter().any(|b| b.nodes.contains(&cut)));
    span.and_then(|(pieces, _)| model.beams.get(pieces.start)).map_or(0, |b| b.nodes[0])
}

/// Length of the next step after one of length `taken` whose prediction was wrong by `distance`.
pub(crate) fn next_step(step: f64, taken: f64, distance: f64) -> f64 {
    if distance > 0.5 * LARGEST_CORRECTION {
        0.7 * taken
    } else if distance < 0.1 * LARGEST_CORRECTION {
        step.max(taken) * 2.0
    } else {
        step.max(taken)
    }
}

/// Place and value of the largest, the first of equals.
fn largest(values: impl Iterator<Item = f64>) -> (usize, f64) {
    values.enumerate().fold((0, 0.0), |best, next| if next.1 > best.1 { next } else { best })
}

/// Maximum that keeps NaN.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
