//! The quadratic programme of an iteration, and how it is solved.
//!
//! `min ½dᵀHd + gᵀd + γ·Σ excess` subject to `l ≤ A·d ≤ u` (rows) and `lower ≤ d ≤ upper`. With `γ = ∞` rows must hold; otherwise each
//! may be exceeded at the price `γ` per unit (elastic mode, an ℓ₁ penalty).
//!
//! `H` is positive definite, so any point that satisfies the optimality conditions *is* the solution. That licenses a cheap first try:
//! start from the active set of the last programme, mend it a few times, and accept it only when every condition was checked. Near
//! a solution the active set no longer changes and one small linear system per iteration is all. Where the guess fails, a dual
//! active-set method begins anew. Where that cycles, or cannot tell whether anything satisfies the rows, the interior-point method
//! decides, on the rows near their bounds first and then on those that its answer violates, until none is. Either answer is then taken
//! to working precision by the same linear system.

use super::active::{Equations, Guess, Side};
use super::dual::Dual;
use super::interior;
use super::outcome::Counters;

/// Changes of the last active set that cost less than a new beginning.
const FEW: usize = 5;

/// Data of a quadratic programme; matrices are row-major.
#[derive(Debug, Clone, Copy)]
pub(super) struct Qp<'a> {
    pub(super) n: usize,
    /// Positive definite.
    pub(super) hessian: &'a [f64],
    pub(super) gradient: &'a [f64],
    pub(super) rows: &'a [f64],
    pub(super) row_lower: &'a [f64],
    pub(super) row_upper: &'a [f64],
    pub(super) lower: &'a [f64],
    pub(super) upper: &'a [f64],
    /// `γ`.
    pub(super) penalty: f64,
    /// Rows from this one on must hold whatever `γ` is.
    pub(super) firm_from: usize,
}

impl Qp<'_> {
    pub(super) fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * self.n..(i + 1) * self.n]
    }

    /// Whether the bounds of a row leave one value only.
    pub(super) fn is_equality(&self, i: usize) -> bool {
        self.row_upper[i] - self.row_lower[i] <= 0.0
    }

    /// What exceeding a row costs per unit.
    pub(super) fn price(&self, i: usize) -> f64 {
        if i < self.firm_from { self.penalty } else { f64::INFINITY }
    }
}

/// Solution of a quadratic programme. Multipliers are rates of its optimum with the bounds: positive at lower ones.
#[derive(Debug, Clone, Default)]
pub(super) struct Answer {
    pub(super) step: Vec<f64>,
    pub(super) rows: Vec<f64>,
    pub(super) bounds: Vec<f64>,
}

/// How solving went.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outcome {
    Solved,
    /// The rows contradict each other or the bounds (only without a penalty).
    Infeasible,
    /// The interior-point method broke down too.
    Failed,
}

/// A solver that remembers the last active set.
#[derive(Debug, Default)]
pub(super) struct QpSolver {
    equations: Equations,
    guess: Guess,
    dual: Dual,
    reachable: Reachable,
    pub(super) answer: Answer,
}

/// The rows that a step within the bounds can break, or that a guess holds: of a few hundred most are out of reach.
#[derive(Debug, Default)]
struct Reachable {
    /// Their places among all.
    kept: Vec<usize>,
    rows: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// The guess of the active set of all rows.
    sides: Vec<Side>,
}

impl Reachable {
    fn fill(&mut self, qp: &Qp<'_>, sides: &[Side]) {
        self.kept.clear();
        self.rows.clear();
        for (i, side) in sides.iter().enumerate() {
            let (mut low, mut high) = (0.0, 0.0);
            for ((a, l), u) in qp.row(i).iter().zip(qp.lower).zip(qp.upper) {
                if *a != 0.0 {
                    let (at_lower, at_upper) = (a * l, a * u);
                    low += f64::min(at_lower, at_upper);
                    high += f64::max(at_lower, at_upper);
                }
            }
            // Written so that what is not a number is within reach. A row of zeros is violated or not, whatever the step.
            if *side != Side::Off || qp.is_equality(i) || !(low >= qp.row_lower[i] && high <= qp.row_upper[i]) {
                self.kept.push(i);
                self.rows.extend_from_slice(qp.row(i));
            }
        }
        let of = |all: &[f64], own: &mut Vec<f64>| {
            own.clear();
            own.extend(self.kept.iter().map(|i| all[*i]));
        };
        of(qp.row_lower, &mut self.lower);
        of(qp.row_upper, &mut self.upper);
    }

    /// The programme of these rows.
    fn qp<'a>(&'a self, of: &Qp<'a>) -> Qp<'a> {
        let firm_from = self.kept.partition_point(|i| *i < of.firm_from);
        Qp { rows: &self.rows, row_lower: &self.lower, row_upper: &self.upper, firm_from, ..*of }
    }
}

impl QpSolver {
    /// Solves into [`QpSolver::answer`].
    pub(super) fn solve(&mut self, qp: &Qp<'_>, counters: &mut Counters) -> Outcome {
        counters.qps += 1;
        if qp.n == 0 {
            return self.without_variables(qp);
        }
        self.guess.fit(qp);
        let mut reachable = std::mem::take(&mut self.reachable);
        reachable.sides.clone_from(&self.guess.rows);
        reachable.fill(qp, &self.guess.rows);
        self.guess.rows.clear();
        self.guess.rows.extend(reachable.kept.iter().map(|i| reachable.sides[*i]));
        let outcome = self.solve_reachable(&reachable.qp(qp), counters);
        if !self.guess.rows.is_empty() || reachable.kept.is_empty() {
            // Back among all rows; a guess that was given up stays so.
            reachable.sides.fill(Side::Off);
            reachable.kept.iter().zip(&self.guess.rows).for_each(|(i, side)| reachable.sides[*i] = *side);
            self.guess.rows.clone_from(&reachable.sides);
        }
        if outcome == Outcome::Solved {
            let mut rows = vec![0.0; qp.row_lower.len()];
            reachable.kept.iter().zip(&self.answer.rows).for_each(|(i, y)| rows[*i] = *y);
            self.answer.rows = rows;
        }
        self.reachable = reachable;
        outcome
    }

    fn solve_reachable(&mut self, qp: &Qp<'_>, counters: &mut Counters) -> Outcome {
        if self.equations.mend(qp, &mut self.guess, &mut self.answer, FEW) {
            return Outcome::Solved;
        }
        let mut found = Answer::default();
        match self.dual.solve(qp) {
            Some(Outcome::Solved) => self.dual.read(&mut self.guess, &mut found),
            Some(outcome) => {
                self.guess = Guess::default();
                return outcome;
            }
            None => {
                counters.interior_qps += 1;
                found = match interior::solve(qp, &self.guess) {
                    Ok(found) => found,
                    Err(outcome) => {
                        self.guess = Guess::default();
                        return outcome;
                    }
                };
                self.guess.read(qp, &found);
            }
        }
        let mut polished = self.guess.clone();
        if self.equations.mend(qp, &mut polished, &mut self.answer, 10 + 3 * qp.n) {
            self.guess = polished;
        } else {
            self.answer = found;
        }
        Outcome::Solved
    }

    /// Nothing to choose: only the prices of what is violated.
    fn without_variables(&mut self, qp: &Qp<'_>) -> Outcome {
        let price = |(l, u): (&f64, &f64)| f64::from(u8::from(*l > 0.0)) - f64::from(u8::from(*u < 0.0));
        let sides: Vec<f64> = qp.row_lower.iter().zip(qp.row_upper).map(price).collect();
        if qp.penalty.is_infinite() && sides.iter().any(|s| *s != 0.0) {
            return Outcome::Infeasible;
        }
        let rows = sides.iter().map(|s| if *s == 0.0 { 0.0 } else { s * qp.penalty }).collect();
        self.answer = Answer { rows, ..Answer::default() };
        Outcome::Solved
    }
}
