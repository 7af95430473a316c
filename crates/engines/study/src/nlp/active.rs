//! Active sets: from a guess to a solution whose optimality conditions were all checked.

use forcewright_base::dense::Lu;

use super::hessian::dot;
use super::qp::{Answer, Qp};

/// What a row or a bound does at the solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Side {
    /// Nothing.
    #[default]
    Off,
    /// Holds at its lower bound.
    Lower,
    /// Holds at its upper bound.
    Upper,
    /// Exceeded downwards, at the full price.
    Below,
    /// Exceeded upwards, at the full price.
    Above,
}

/// A guess of the active set.
#[derive(Debug, Clone, Default)]
pub(super) struct Guess {
    pub(super) rows: Vec<Side>,
    pub(super) bounds: Vec<Side>,
}

impl Guess {
    /// Gives the guess the size of the programme and takes out what contradicts it.
    pub(super) fn fit(&mut self, qp: &Qp<'_>) {
        // A fresh guess takes all equalities; a remembered one has left out those that depend on others.
        let fresh = self.rows.len() != qp.row_lower.len();
        self.rows.resize(qp.row_lower.len(), Side::Off);
        self.bounds.resize(qp.n, Side::Off);
        let hard = qp.penalty.is_infinite();
        for (side, (l, u)) in self.rows.iter_mut().zip(qp.row_lower.iter().zip(qp.row_upper)) {
            *side = match *side {
                Side::Below if hard => Side::Lower,
                Side::Above if hard => Side::Upper,
                kept => kept,
            };
            if fresh && u - l <= 0.0 && *side == Side::Off {
                *side = Side::Lower;
            }
            let impossible = match *side {
                Side::Lower | Side::Below => l.is_infinite(),
                Side::Upper | Side::Above => u.is_infinite(),
                Side::Off => false,
            };
            if impossible {
                *side = Side::Off;
            }
        }
        for (side, (l, u)) in self.bounds.iter_mut().zip(qp.lower.iter().zip(qp.upper)) {
            if *side == Side::Lower && l.is_infinite() || *side == Side::Upper && u.is_infinite() {
                *side = Side::Off;
            }
        }
    }

    /// Reads the active set from an approximate solution: bounds first, then rows by falling multiplier, each only if it does not depend
    /// on those before it.
    pub(super) fn read(&mut self, qp: &Qp<'_>, found: &Answer) {
        for j in 0..qp.n {
            let (mu, d) = (found.bounds[j], found.step[j]);
            self.bounds[j] = if mu > 0.0 && d - qp.lower[j] < mu {
                Side::Lower
            } else if mu < 0.0 && qp.upper[j] - d < -mu {
                Side::Upper
            } else {
                Side::Off
            };
        }
        self.rows.fill(Side::Off);
        let mut order: Vec<usize> = (0..found.rows.len()).filter(|&i| found.rows[i] != 0.0).collect();
        order.sort_by(|&a, &b| found.rows[b].abs().total_cmp(&found.rows[a].abs()).then(a.cmp(&b)));
        let free: Vec<usize> = (0..qp.n).filter(|&j| self.bounds[j] == Side::Off).collect();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for i in order {
            let (y, value) = (found.rows[i], dot(qp.row(i), &found.step));
            let excess = if y > 0.0 { qp.row_lower[i] - value } else { value - qp.row_upper[i] };
            let lower = y > 0.0;
            if y.abs() >= qp.price(i) * (1.0 - 1e-6) && excess > 1e-7 {
                self.rows[i] = if lower { Side::Below } else { Side::Above };
                continue;
            }
            let active = qp.is_equality(i) || -excess < y.abs();
            if active
                && basis.len() < free.len()
                && let Some(direction) = independent_part(qp.row(i), &free, &basis)
            {
                basis.push(direction);
                self.rows[i] = if lower { Side::Lower } else { Side::Upper };
            }
        }
    }
}

/// The normalised part of a row that the basis does not span; `None` if next to nothing is left.
fn independent_part(row: &[f64], free: &[usize], basis: &[Vec<f64>]) -> Option<Vec<f64>> {
    let mut rest: Vec<f64> = free.iter().map(|&j| row[j]).collect();
    let whole = dot(&rest, &rest).sqrt();
    // Twice is enough: orthogonal to working precision after the second pass.
    for _ in 0..2 {
        for direction in basis {
            let part = dot(&rest, direction);
            rest.iter_mut().zip(direction).for_each(|(r, b)| *r -= part * b);
        }
    }
    let left = dot(&rest, &rest).sqrt();
    (left > 1e-9 * whole && left > 0.0).then(|| rest.into_iter().map(|r| r / left).collect())
}

/// What to change in an active set.
#[derive(Debug, Clone, Copy)]
enum Change {
    Row(usize, Side),
    Bound(usize, Side),
}

/// The linear system of an active set, in reused buffers.
#[derive(Debug, Default)]
pub(super) struct Equations {
    lu: Lu,
    matrix: Vec<f64>,
    rhs: Vec<f64>,
    unknowns: Vec<f64>,
    free: Vec<usize>,
    active: Vec<usize>,
}

impl Equations {
    /// Mends the guess until all optimality conditions hold; false if that takes more than some changes or the equations become singular.
    ///
    /// One change at a time, the worst first: wrong multipliers are let go before violated rows are taken in.
    pub(super) fn mend(&mut self, qp: &Qp<'_>, guess: &mut Guess, answer: &mut Answer, most: usize) -> bool {
        for _ in 0..=most {
            if !self.solve(qp, guess, answer) {
                return false;
            }
            match wrong_multiplier(qp, guess, answer).or_else(|| worst_violation(qp, guess, answer)) {
                None => return true,
                Some(Change::Row(i, side)) => guess.rows[i] = side,
                Some(Change::Bound(j, side)) => guess.bounds[j] = side,
            }
        }
        false
    }

    /// Solves `[H −Aᵀ; A 0]·(d, y) = (−g, b)` on the free variables and active rows; false if singular.
    fn solve(&mut self, qp: &Qp<'_>, guess: &Guess, answer: &mut Answer) -> bool {
        self.free.clear();
        self.free.extend((0..qp.n).filter(|&j| guess.bounds[j] == Side::Off));
        self.active.clear();
        self.active.extend((0..guess.rows.len()).filter(|&i| matches!(guess.rows[i], Side::Lower | Side::Upper)));
        if self.active.len() > self.free.len() {
            return false;
        }
        answer.step.clear();
        answer.step.extend(guess.bounds.iter().enumerate().map(|(j, side)| match side {
            Side::Lower => qp.lower[j],
            Side::Upper => qp.upper[j],
            _ => 0.0,
        }));
        answer.rows.clear();
        answer.rows.extend(guess.rows.iter().map(|side| match side {
            Side::Below => qp.penalty,
            Side::Above => -qp.penalty,
            _ => 0.0,
        }));
        self.assemble(qp, guess, answer);
        let size = self.rhs.len();
        if self.lu.factor(size, size, &self.matrix).is_err() {
            return false;
        }
        self.unknowns.clone_from(&self.rhs);
        self.lu.solve(&mut self.unknowns);
        // One step of iterative refinement.
        for (row, r) in self.matrix.chunks_exact(size.max(1)).zip(&mut self.rhs) {
            *r -= dot(row, &self.unknowns);
        }
        self.lu.solve(&mut self.rhs);
        self.unknowns.iter_mut().zip(&self.rhs).for_each(|(x, c)| *x += c);
        for (&j, d) in self.free.iter().zip(&self.unknowns) {
            answer.step[j] = *d;
        }
        for (&i, y) in self.active.iter().zip(&self.unknowns[self.free.len()..]) {
            answer.rows[i] = *y;
        }
        price_bounds(qp, guess, answer);
        answer.step.iter().chain(&answer.rows).all(|v| v.is_finite())
    }

    fn assemble(&mut self, qp: &Qp<'_>, guess: &Guess, answer: &Answer) {
        let (n, nf) = (qp.n, self.free.len());
        let size = nf + self.active.len();
        self.matrix.clear();
        self.matrix.resize(size * size, 0.0);
        self.rhs.clear();
        for (a, &j) in self.free.iter().enumerate() {
            let row = &qp.hessian[j * n..(j + 1) * n];
            for (b, &k) in self.free.iter().enumerate() {
                self.matrix[a * size + b] = row[k];
            }
            // Free entries of the step are still zero: only the bounds contribute.
            self.rhs.push(-qp.gradient[j] - dot(row, &answer.step));
        }
        for (i, y) in answer.rows.iter().enumerate().filter(|(_, y)| **y != 0.0) {
            for (a, &j) in self.free.iter().enumerate() {
                self.rhs[a] += y * qp.row(i)[j];
            }
        }
        for (b, &i) in self.active.iter().enumerate() {
            let row = qp.row(i);
            for (a, &j) in self.free.iter().enumerate() {
                self.matrix[a * size + nf + b] = -row[j];
                self.matrix[(nf + b) * size + a] = row[j];
            }
            let bound = if guess.rows[i] == Side::Lower { qp.row_lower[i] } else { qp.row_upper[i] };
            self.rhs.push(bound - dot(row, &answer.step));
        }
    }
}

/// Multipliers of the bounds from the gradient of the Lagrangian; 0 where the variable is free.
fn price_bounds(qp: &Qp<'_>, guess: &Guess, answer: &mut Answer) {
    answer.bounds.clear();
    answer.bounds.resize(qp.n, 0.0);
    for j in (0..qp.n).filter(|&j| guess.bounds[j] != Side::Off) {
        let forces: f64 = answer.rows.iter().enumerate().filter(|(_, y)| **y != 0.0).map(|(i, y)| y * qp.row(i)[j]).sum();
        answer.bounds[j] = qp.gradient[j] + dot(&qp.hessian[j * qp.n..(j + 1) * qp.n], &answer.step) - forces;
    }
}

fn slack_of_comparison(bound: f64) -> f64 {
    1e-12 * (1.0 + bound.abs())
}

/// The multiplier of the worst wrong sign or size, with the change that lets it go.
fn wrong_multiplier(qp: &Qp<'_>, guess: &Guess, answer: &Answer) -> Option<Change> {
    let largest = answer.rows.iter().chain(&answer.bounds).fold(1.0_f64, |m, y| m.max(y.abs()));
    let (mut worst, mut change) = (1e-13 * largest, None);
    let mut consider = |badness: f64, what: Change| {
        if badness > worst {
            (worst, change) = (badness, Some(what));
        }
    };
    for (i, side) in guess.rows.iter().enumerate().filter(|(_, side)| **side != Side::Off) {
        let (y, equality) = (answer.rows[i], qp.is_equality(i));
        match side {
            Side::Lower | Side::Upper => {
                let force = if *side == Side::Lower { y } else { -y };
                if !equality {
                    consider(-force, Change::Row(i, Side::Off));
                }
                consider(y.abs() - qp.price(i), Change::Row(i, if y > 0.0 { Side::Below } else { Side::Above }));
            }
            _ => {
                let value = dot(qp.row(i), &answer.step);
                let below = *side == Side::Below;
                let inside = if below { value - qp.row_lower[i] } else { qp.row_upper[i] - value };
                let back = if below { Side::Lower } else { Side::Upper };
                // In the same currency as the multipliers: what is paid for nothing.
                consider(inside * qp.penalty, Change::Row(i, back));
            }
        }
    }
    for (j, side) in guess.bounds.iter().enumerate() {
        let mu = answer.bounds[j];
        match side {
            Side::Lower => consider(-mu, Change::Bound(j, Side::Off)),
            Side::Upper => consider(mu, Change::Bound(j, Side::Off)),
            _ => {}
        }
    }
    change
}

/// The row or bound that the step violates most, with the side to put it on.
fn worst_violation(qp: &Qp<'_>, guess: &Guess, answer: &Answer) -> Option<Change> {
    let (mut worst, mut change) = (0.0, None);
    let mut consider = |excess: f64, bound: f64, what: Change| {
        if excess > slack_of_comparison(bound) && excess > worst {
            (worst, change) = (excess, Some(what));
        }
    };
    for i in (0..guess.rows.len()).filter(|&i| guess.rows[i] == Side::Off) {
        let value = dot(qp.row(i), &answer.step);
        consider(qp.row_lower[i] - value, qp.row_lower[i], Change::Row(i, Side::Lower));
        consider(value - qp.row_upper[i], qp.row_upper[i], Change::Row(i, Side::Upper));
    }
    for j in (0..qp.n).filter(|&j| guess.bounds[j] == Side::Off) {
        let d = answer.step[j];
        consider(qp.lower[j] - d, qp.lower[j], Change::Bound(j, Side::Lower));
        consider(d - qp.upper[j], qp.upper[j], Change::Bound(j, Side::Upper));
    }
    change
}
