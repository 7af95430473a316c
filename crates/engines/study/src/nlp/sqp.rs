//! The iteration.

use super::hessian::Hessian;
use super::kkt;
use super::merit::{Found, LineSearch, Merit};
use super::model::{Model, NoStart, Point};
use super::outcome::{Counters, KktResidual, Progress, Settings, Solution, Stop};
use super::patience::Patience;
use super::problem::Problem;
use super::qp::{Answer, Outcome, QpSolver};
use super::subproblem::Subproblem;
use super::walls::Walls;

/// Largest step of a variable at the beginning, in its scale, unless all is linear in it: no linearisation is believed beyond. It grows
/// with success and shrinks with failure.
const FIRST_REACH: f64 = 1.0;
/// A reach below this is next to nothing.
const LEAST_REACH: f64 = 1e-9;
/// A prediction within less than this reach says nothing about the rest of the way.
const FAIR_REACH: f64 = 0.1;
/// Multipliers beyond this (scaled) count as contradiction of the linearised constraints.
const PRICE_LIMIT: f64 = 1e8;
/// Part of the attainable decrease of the linearised violation that an elastic step must bring.
const STEERING: f64 = 0.1;
/// A violation that cannot be lowered by more than this part, to first order, is stationary.
const STATIONARY: f64 = 1e-6;
/// How far a stationary point of the violation is left to see whether it is a minimum (scaled).
const SHAKE: f64 = 1e-3;
/// Steps in a row whose predicted gain drowns in rounding, before the search counts as stalled.
const DROWNED_LIMIT: usize = 10;
/// Steps in a row that regions of rejection cut to next to nothing, before the search counts as stalled.
const BLOCKED_LIMIT: usize = 20;
/// A step shorter than this (scaled) is next to nothing.
const TINY_STEP: f64 = 1e-7;
/// An objective this far below the start (scaled) counts as without bound.
const BOTTOMLESS: f64 = 1e12;
/// A violation below so many times what is allowed is not hopeless.
const NEARLY: f64 = 100.0;
/// Objectives (scaled) below this count as this where a gain is compared with them.
const SMALL_OBJECTIVE: f64 = 1e-3;

/// A point with all that is reported about it.
#[derive(Debug, Clone)]
struct Record {
    z: Vec<f64>,
    x: Vec<f64>,
    objective: f64,
    constraints: Vec<f64>,
    multipliers: Vec<f64>,
    bounds: Vec<f64>,
    residual: KktResidual,
}

impl Record {
    /// Feasible before infeasible; among feasible ones less objective, among others less violation.
    fn beats(&self, other: &Self, feasibility: f64) -> bool {
        match (self.residual.feasibility <= feasibility, other.residual.feasibility <= feasibility) {
            (true, true) => self.objective < other.objective,
            (false, false) => self.residual.feasibility < other.residual.feasibility,
            (mine, _) => mine,
        }
    }
}

struct Search<'a, 'p> {
    model: Model<'p>,
    settings: &'a Settings,
    point: Point,
    hessian: Hessian,
    solver: QpSolver,
    /// Of programmes without the objective.
    least: QpSolver,
    merit: Merit,
    reach: f64,
    /// Price of violation while in elastic mode.
    price: Option<f64>,
    drowned: usize,
    walls: Walls,
    /// Steps in a row that ended at a wall and were next to nothing.
    blocked: usize,
    shaken: bool,
    /// Whether the reach has once become next to nothing.
    jammed: bool,
    best: Option<Record>,
    first_objective: f64,
    patience: Patience,
}

/// Minimises; see the module for the method. Never panics on what the problem answers.
pub fn minimise(problem: &mut dyn Problem, start: &[f64], settings: &Settings, watch: &mut dyn FnMut(&Progress<'_>) -> bool) -> Solution {
    let constraints = problem.constraint_lower().len();
    let variables = problem.lower().len();
    match Model::new(problem, start, settings) {
        Ok((model, point)) => Search {
            hessian: Hessian::identity(model.variables()),
            merit: Merit::new(constraints),
            solver: QpSolver::default(),
            least: QpSolver::default(),
            reach: FIRST_REACH,
            price: None,
            drowned: 0,
            walls: Walls::default(),
            blocked: 0,
            shaken: false,
            jammed: false,
            best: None,
            first_objective: point.objective,
            patience: Patience::default(),
            model,
            settings,
            point,
        }
        .run(watch),
        Err(reason) => Solution {
            x: start.to_vec(),
            objective: f64::NAN,
            constraints: vec![f64::NAN; constraints],
            multipliers: vec![0.0; constraints],
            bound_multipliers: vec![0.0; variables],
            kkt_residual: KktResidual::UNKNOWN,
            violation: f64::NAN,
            stop: match reason {
                NoStart::Malformed => Stop::Malformed,
                NoStart::Rejected => Stop::StartRejected,
            },
            counters: match reason {
                NoStart::Malformed => Counters::default(),
                NoStart::Rejected => Counters { gradient_evaluations: 1, rejections: 1, ..Counters::default() },
            },
        },
    }
}

impl Search<'_, '_> {
    fn run(mut self, watch: &mut dyn FnMut(&Progress<'_>) -> bool) -> Solution {
        let mut iteration = 0;
        loop {
            let linear = Subproblem::new(&self.model, &self.point, &self.walls, self.reach);
            let answer = match self.direction(&linear) {
                Some(mut answer) => {
                    answer.rows.truncate(linear.constraints());
                    answer
                }
                None if !self.hessian.is_fresh() => {
                    self.reset();
                    continue;
                }
                None => Answer {
                    step: vec![0.0; self.model.variables()],
                    rows: vec![0.0; linear.constraints()],
                    bounds: vec![0.0; self.model.variables()],
                },
            };
            let gain = self.predicted_gain(&linear, &answer);
            let record = self.record(&answer);
            let residual = record.residual;
            self.remember(&record);
            self.model.counters.iterations = iteration;
            if !self.report(iteration, &record, watch) {
                return self.finish(record, true, Stop::Interrupted);
            }
            let feasible = residual.feasibility <= self.settings.feasibility;
            let nothing = self.settings.tolerance * self.point.objective.abs().max(SMALL_OBJECTIVE);
            if feasible && residual.optimality() <= self.settings.tolerance && gain <= nothing {
                return self.finish(record, false, Stop::Converged);
            }
            if let Some(stop) = self.not_worth_it(&linear, &answer, (feasible, gain)) {
                return self.finish(record, true, stop);
            }
            if iteration >= self.settings.iteration_limit {
                return self.finish(record, true, Stop::IterationLimit);
            }
            if !feasible
                && self.price.is_some()
                && let Some((least, drop)) = self.stationary_violation(&linear, &answer)
            {
                if self.shake() {
                    iteration += 1;
                    continue;
                }
                let residual = KktResidual { stationarity: drop, complementarity: 0.0, feasibility: residual.feasibility };
                let record = Record { multipliers: least.rows, bounds: least.bounds, residual, ..record };
                return self.finish(record, false, Stop::Infeasible);
            }
            if feasible && self.point.objective < self.first_objective.min(0.0) - BOTTOMLESS {
                return self.finish(record, false, Stop::Unbounded);
            }
            if !self.advance(&linear, &answer, gain) {
                return self.finish(record, true, Stop::Stalled);
            }
            iteration += 1;
        }
    }

    /// Lets the penalties follow the multipliers; by how much the merit function falls over the whole step, to first order.
    fn predicted_gain(&mut self, linear: &Subproblem, answer: &Answer) -> f64 {
        match self.price {
            Some(price) => self.merit.penalties.fill(price),
            None => self.merit.follow(&answer.rows),
        }
        let qp = linear.qp(&self.point, self.hessian.matrix(), &self.point.gradient, f64::INFINITY);
        -self.merit.slope(&qp, &answer.step)
    }

    /// Whether going on is not worth the evaluations, by [`Settings::least_gain`]; then what that is called. A gain counts where the constraints
    /// hold.
    fn not_worth_it(&mut self, linear: &Subproblem, answer: &Answer, (feasible, gain): (bool, f64)) -> Option<Stop> {
        let best = self.best.as_ref()?;
        if best.residual.feasibility > NEARLY * self.settings.feasibility {
            let sum = linear.excess(&vec![0.0; self.model.variables()]);
            return (self.settings.least_gain > 0.0 && self.patience.hopeless(sum)).then_some(Stop::Stalled);
        }
        if !feasible {
            return None;
        }
        let fair = self.reach >= FAIR_REACH || self.model.length(&answer.step) < 0.99 * self.reach;
        let predicted = if fair { gain } else { f64::INFINITY };
        let least = self.settings.least_gain * best.objective.abs();
        (least > 0.0 && self.patience.settled(best.objective, predicted, least)).then_some(Stop::Settled)
    }

    /// The step and the multipliers of this iteration; `None` if the quadratic programme could not be solved.
    fn direction(&mut self, linear: &Subproblem) -> Option<Answer> {
        let size = |y: &[f64]| y.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
        if self.price.is_none() {
            match self.solve(linear, f64::INFINITY) {
                Outcome::Solved if size(&self.solver.answer.rows) <= PRICE_LIMIT => return Some(self.solver.answer.clone()),
                Outcome::Solved | Outcome::Infeasible => {}
                Outcome::Failed => return None,
            }
            self.price = Some((10.0 * size(&self.merit.penalties)).clamp(10.0, PRICE_LIMIT));
        }
        self.model.counters.restorations += 1;
        let now = linear.excess(&vec![0.0; self.model.variables()]);
        let mut attainable = None;
        loop {
            let price = self.price.unwrap_or(PRICE_LIMIT);
            if self.solve(linear, price) != Outcome::Solved {
                return None;
            }
            let answer = self.solver.answer.clone();
            let then = linear.excess(&answer.step);
            if then <= 0.1 * self.settings.feasibility {
                // Nothing is exceeded: the firm programme has the same solution, and the next iteration tries it again.
                self.price = None;
                return Some(answer);
            }
            if price >= PRICE_LIMIT {
                return Some(answer);
            }
            // What is attainable is at most all of it: often enough to know.
            if now - then >= STEERING * now {
                return Some(answer);
            }
            let least = if let Some(least) = attainable { least } else { linear.excess(&self.least_violation(linear)?.step) };
            attainable = Some(least);
            if now - then >= STEERING * (now - least) {
                return Some(answer);
            }
            self.price = Some((10.0 * price).min(PRICE_LIMIT));
        }
    }

    fn solve(&mut self, linear: &Subproblem, penalty: f64) -> Outcome {
        let qp = linear.qp(&self.point, self.hessian.matrix(), &self.point.gradient, penalty);
        self.solver.solve(&qp, &mut self.model.counters)
    }

    /// The step to the least sum of violations of the linearised constraints.
    fn least_violation(&mut self, linear: &Subproblem) -> Option<Answer> {
        let n = self.model.variables();
        let mut hessian = vec![0.0; n * n];
        (0..n).for_each(|j| hessian[j * n + j] = 1e-9);
        let zero = vec![0.0; n];
        let qp = linear.qp(&self.point, &hessian, &zero, 1.0);
        let solved = self.least.solve(&qp, &mut self.model.counters) == Outcome::Solved;
        solved.then(|| self.least.answer.clone())
    }

    /// Whether the sum of violations cannot be lowered to first order within one unit of the scaled variables; then the solution of that
    /// programme and the part by which it lowers the sum.
    fn stationary_violation(&mut self, linear: &Subproblem, answer: &Answer) -> Option<(Answer, f64)> {
        let now = linear.excess(&vec![0.0; self.model.variables()]);
        if now - linear.excess(&answer.step) > 1e-4 * now {
            return None;
        }
        // Walls are none of the problem's limits.
        let near = Subproblem::new(&self.model, &self.point, &Walls::default(), 1.0);
        let mut least = self.least_violation(&near)?;
        least.rows.truncate(linear.constraints());
        let drop = ((now - near.excess(&least.step)) / now).max(0.0);
        (drop <= STATIONARY).then_some((least, drop))
    }

    /// Once per search: leaves a point where the violation is stationary, which may be a saddle or a maximum (a distance that
    /// must be at least so large, begun at zero). True if the point was moved.
    fn shake(&mut self) -> bool {
        if std::mem::replace(&mut self.shaken, true) {
            return false;
        }
        let mut moved = Point { z: self.point.z.clone(), ..Point::default() };
        for (j, z) in moved.z.iter_mut().enumerate() {
            // Different amounts, so that no symmetry survives; inwards where a bound is near.
            let amount = SHAKE * (1.0 + 0.5 * ((j % 7) as f64) / 7.0);
            let up = self.model.upper[j] - *z >= *z - self.model.lower[j];
            *z = if up { (*z + amount).min(self.model.upper[j]) } else { (*z - amount).max(self.model.lower[j]) };
        }
        let possible = self.model.evaluate(&mut moved).is_ok() && self.model.evaluate_with_gradients(&mut moved).is_ok();
        if possible {
            self.point = moved;
            self.price = None;
            self.merit.forget();
            self.patience = Patience::default();
            self.reset();
        }
        possible
    }

    /// Moves to a better point and learns from it, or shortens the reach; false if there is nothing left to try.
    fn advance(&mut self, linear: &Subproblem, answer: &Answer, gain: f64) -> bool {
        let qp = linear.qp(&self.point, self.hessian.matrix(), &self.point.gradient, self.price.unwrap_or(f64::INFINITY));
        let length = self.model.length(&answer.step);
        self.drowned = if gain > 1e-15 * self.point.objective.abs().max(1e-3) { 0 } else { self.drowned + 1 };
        if self.walls.stand() {
            // Near a region of rejection a detour may lead into a corner: only a fall is believed.
            self.merit.forget();
        }
        let search = LineSearch { merit: &self.merit, qp: &qp, point: &self.point, step: &answer.step };
        let drowned = self.drowned > DROWNED_LIMIT;
        let found = if drowned { Found::nothing(None) } else { search.run(&mut self.model, &mut self.solver) };
        self.walls.age();
        if let Some(rejected) = found.rejected {
            self.walls.raise(&self.point.z, &answer.step, rejected);
        }
        let moved = found.part * length;
        let tiny = found.rejected.is_some() && moved < TINY_STEP;
        self.blocked = if tiny { self.blocked + 1 } else { 0 };
        let Some(next) = found.next else {
            let again = if tiny { self.forget() } else { self.shorten(moved, drowned) };
            return again && self.blocked <= BLOCKED_LIMIT;
        };
        if self.blocked > BLOCKED_LIMIT {
            return false;
        }
        if found.part < 0.1 {
            self.reach = (4.0 * moved).max(1e-4);
        } else if length >= 0.99 * self.reach {
            self.reach *= 4.0;
        }
        self.learn(&next, answer);
        self.merit.remember(&self.model, &self.point);
        self.point = *next;
        true
    }

    /// Shortens the reach after a step that failed. Where it becomes next to nothing, the curvature is forgotten, for it may be what
    /// misleads: once per search, and wherever walls stand in the way. False if there is nothing left to try.
    fn shorten(&mut self, reach: f64, drowned: bool) -> bool {
        self.merit.remember(&self.model, &self.point);
        if reach > LEAST_REACH {
            self.reach = reach;
            return true;
        }
        let again = !self.hessian.is_fresh() && !drowned && (self.walls.stand() || !std::mem::replace(&mut self.jammed, true));
        self.forget() && again
    }

    /// Forgets the curvature and how far it could be believed. True.
    fn forget(&mut self) -> bool {
        self.reach = FIRST_REACH;
        self.reset();
        true
    }

    /// Learns the curvature between the present point and the next.
    fn learn(&mut self, next: &Point, answer: &Answer) {
        let step: Vec<f64> = next.z.iter().zip(&self.point.z).map(|(a, b)| a - b).collect();
        let (mut before, mut after) = (Vec::new(), Vec::new());
        kkt::lagrangian_gradient(&self.point, &answer.rows, &mut before);
        kkt::lagrangian_gradient(next, &answer.rows, &mut after);
        let change: Vec<f64> = after.iter().zip(&before).map(|(a, b)| a - b).collect();
        if step.iter().any(|s| s.abs() > 1e-13) && !self.hessian.update(&step, &change) {
            self.model.counters.resets += 1;
        }
    }

    fn reset(&mut self) {
        self.hessian.reset();
        self.model.counters.resets += 1;
    }

    fn record(&mut self, answer: &Answer) -> Record {
        let mut bounds = Vec::new();
        let residual = kkt::residual(&self.model, &self.point, &answer.rows, &answer.bounds, &mut bounds);
        Record {
            z: self.point.z.clone(),
            x: self.model.x_of(&self.point.z),
            objective: self.point.objective,
            constraints: self.point.constraints.clone(),
            multipliers: answer.rows.clone(),
            bounds,
            residual,
        }
    }

    fn remember(&mut self, record: &Record) {
        if self.best.as_ref().is_none_or(|best| record.beats(best, self.settings.feasibility)) {
            self.best = Some(record.clone());
        }
    }

    fn report(&self, iteration: usize, record: &Record, watch: &mut dyn FnMut(&Progress<'_>) -> bool) -> bool {
        let best = self.best.as_ref().unwrap_or(record);
        watch(&Progress {
            iteration,
            objective: self.model.objective_of(record.objective),
            violation: record.residual.feasibility,
            kkt_residual: record.residual.optimality(),
            best: &best.x,
            best_objective: self.model.objective_of(best.objective),
            best_violation: best.residual.feasibility,
        })
    }

    /// The solution from the last record, or from the best one.
    fn finish(mut self, last: Record, best: bool, stop: Stop) -> Solution {
        let record = self.best.take().filter(|_| best).unwrap_or(last);
        let stop = match stop {
            Stop::Stalled if record.residual.feasibility > self.settings.feasibility => Stop::StalledInfeasible,
            other => other,
        };
        let of_objective = stop != Stop::Infeasible;
        let multipliers = self.model.multipliers_of(&record.multipliers, of_objective);
        let (constraints, violation) = self.model.constraints_of(&record.constraints);
        Solution {
            bound_multipliers: self.model.bound_multipliers_of(&record.z, &multipliers, &record.bounds, of_objective),
            x: record.x,
            objective: self.model.objective_of(record.objective),
            constraints,
            multipliers,
            kkt_residual: record.residual,
            violation,
            stop,
            counters: self.model.counters,
        }
    }
}
