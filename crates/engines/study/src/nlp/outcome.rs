//! Settings of an optimisation, what is seen on the way, and how it ended.

/// What is asked of a solution. All tolerances refer to the scaled problem, see [`Settings::tolerance`].
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Bound on stationarity and complementarity, scaled: variables by their range (or [`Settings::scales`]), the objective by the
    /// largest entry of its scaled gradient, each constraint likewise; and on the gain that is still predicted, relative to the
    /// objective. Default 1e-8.
    pub tolerance: f64,
    /// Bound on the largest violation of a constraint, scaled. A violation of 1e-8 is a distance from the limit of 1e-8 of the range
    /// of the variable that moves the constraint most. Default 1e-8.
    pub feasibility: f64,
    /// Most iterations. Default 500.
    pub iteration_limit: usize,
    /// Least gain that is worth going on for, relative to the objective: the search ends as [`Stop::Settled`] when ten iterations at
    /// points that satisfy the constraints have gained less, or when at three of them in a row less is predicted. It is also given up,
    /// as [`Stop::StalledInfeasible`], when no point was near to satisfying the constraints and ten iterations have not lowered the
    /// sum of the violations by a tenth. Default 0: it goes on.
    pub least_gain: f64,
    /// A typical change of each variable, in its own unit. Empty (the default): the distance between its bounds; of a variable without
    /// two finite bounds its magnitude at the start, or 1 if that is zero. Entries that are not positive and finite mean the same.
    pub scales: Vec<f64>,
    /// A typical change of each constraint, in its own unit. Empty (the default): the largest entry of its scaled gradient at the start,
    /// or a tenth of its distance from its limit there if that is more. Give it where a gradient may vanish at the start: rounding
    /// would be taken for its size.
    pub constraint_scales: Vec<f64>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            feasibility: 1e-8,
            iteration_limit: 500,
            least_gain: 0.0,
            scales: Vec::new(),
            constraint_scales: Vec::new(),
        }
    }
}

/// The state at the beginning of an iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress<'a> {
    /// Number of the iteration, from 0.
    pub iteration: usize,
    /// Objective at the present point, in its own unit.
    pub objective: f64,
    /// Largest violation of a constraint at the present point, scaled as [`Settings::feasibility`].
    pub violation: f64,
    /// The larger of stationarity and complementarity at the present point, scaled as [`Settings::tolerance`].
    pub kkt_residual: f64,
    /// The best point so far: the feasible one of least objective, or the one of least violation while none is feasible.
    pub best: &'a [f64],
    /// Objective at the best point.
    pub best_objective: f64,
    /// Violation at the best point, scaled as [`Settings::feasibility`].
    pub best_violation: f64,
}

/// How far a point is from the conditions of Karush, Kuhn and Tucker, scaled as [`Settings::tolerance`] says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KktResidual {
    /// Largest entry of `∇f − Jᵀλ − μ`.
    pub stationarity: f64,
    /// Largest product of a multiplier and the distance of its constraint or bound from the limit.
    pub complementarity: f64,
    /// Largest violation of a constraint.
    pub feasibility: f64,
}

impl KktResidual {
    pub(super) const UNKNOWN: Self = Self { stationarity: f64::INFINITY, complementarity: f64::INFINITY, feasibility: f64::INFINITY };

    /// The larger of stationarity and complementarity.
    pub fn optimality(&self) -> f64 {
        self.stationarity.max(self.complementarity)
    }
}

/// Where and how the search ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The point: the last one if [`Stop::Converged`], [`Stop::Infeasible`] or [`Stop::Unbounded`], otherwise the best seen.
    pub x: Vec<f64>,
    /// Objective there; NaN if nothing could be evaluated.
    pub objective: f64,
    /// Constraint functions there.
    pub constraints: Vec<f64>,
    /// `λ = df*/db`: the rate at which the optimum changes when the active bound of the constraint is raised, in units of the objective
    /// per unit of the constraint. Positive at a lower bound, negative at an upper one, either at an equality, 0 where inactive. So
    /// raising an upper limit by `δ` changes the optimum by `λ·δ ≤ 0`, and lowering a lower limit by `δ` changes it by `−λ·δ ≤ 0`, to
    /// first order. The Lagrangian is `f − λᵀc − μᵀx`.
    ///
    /// After [`Stop::Infeasible`] the "objective" of these rates is the sum of the scaled violations instead.
    pub multipliers: Vec<f64>,
    /// `μ = df*/db` for the bounds of the variables, with the same sign rule; of a fixed variable the rate when both its bounds move.
    pub bound_multipliers: Vec<f64>,
    /// Distance from the optimality conditions. After [`Stop::Infeasible`] stationarity is the part by which the sum of violations could
    /// be lowered to first order.
    pub kkt_residual: KktResidual,
    /// Largest violation of a constraint in the constraint's own unit.
    pub violation: f64,
    /// Why the search ended.
    pub stop: Stop,
    /// Work done.
    pub counters: Counters,
}

/// Why the search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// The optimality conditions hold to the tolerances: a local optimum.
    Converged,
    /// The constraints hold, and the last iterations gained, or promised, less than [`Settings::least_gain`]: near a local optimum, whose
    /// conditions are not met to the tolerances.
    Settled,
    /// The constraints hold but no step improves the objective any more although the optimality conditions are not met: noise in the
    /// values, wrong derivatives, a kink, or a solution without multipliers.
    Stalled,
    /// No step improves, or too little as [`Settings::least_gain`] says, and the constraints do not hold, nor is the point proved to be
    /// one of least violation. Same causes as [`Stop::Stalled`]; try another start.
    StalledInfeasible,
    /// The sum of the scaled violations is stationary and not zero, and the search came back after it was moved away: near this point
    /// nothing satisfies the constraints. Those that are violated are the ones to relax; the others hold.
    Infeasible,
    /// The limit of iterations was reached.
    IterationLimit,
    /// The watcher asked to stop.
    Interrupted,
    /// The start could not be evaluated.
    StartRejected,
    /// Steps of ever greater length keep lowering the objective while the constraints hold.
    Unbounded,
    /// Lengths disagree, a lower bound lies above its upper bound, or a bound or the start is not a number. Nothing was evaluated.
    Malformed,
}

/// Work done by one search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Calls for values only, rejected ones included.
    pub evaluations: usize,
    /// Calls for values with derivatives.
    pub gradient_evaluations: usize,
    /// Calls that were rejected.
    pub rejections: usize,
    /// Quadratic programmes solved, corrections included.
    pub qps: usize,
    /// Those of them for which both methods of active sets failed and the interior-point method was called.
    pub interior_qps: usize,
    /// Iterations.
    pub iterations: usize,
    /// Iterations in which the linearised constraints contradicted each other and their violation was minimised instead.
    pub restorations: usize,
    /// Times the approximation of the Hessian was thrown away.
    pub resets: usize,
}
