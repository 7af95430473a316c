//! The quadratic programme by the interior-point method of Clarabel, on the rows that matter.
//!
//! P. J. Goulart and Y. Chen, "Clarabel: An interior-point solver for conic programs with quadratic objectives", arXiv:2405.12762, 2024.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT};

use super::active::{Guess, Side};
use super::hessian::dot;
use super::qp::{Answer, Outcome, Qp};

/// Rows count as violated beyond this.
const VIOLATED: f64 = 1e-9;

/// One side of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Limit {
    row: usize,
    upper: bool,
}

/// Solves the programme to about 1e-9, or says why not.
pub(super) fn solve(qp: &Qp<'_>, guess: &Guess) -> Result<Answer, Outcome> {
    let mut limits = nearest(qp, guess);
    loop {
        let answer = solve_with(qp, &limits)?;
        let mut missed = violated(qp, &answer.step, &limits);
        if missed.is_empty() {
            return Ok(answer);
        }
        // Neighbours violate together; the worst of them usually speak for all.
        missed.truncate(2 * qp.n + 4);
        limits.extend(missed.into_iter().map(|(limit, _)| limit));
        limits.sort_unstable();
    }
}

/// Rows of the guess, those violated at the beginning of the step, and the nearest of the others.
fn nearest(qp: &Qp<'_>, guess: &Guess) -> Vec<Limit> {
    let mut candidates: Vec<(f64, Limit)> = Vec::new();
    for row in 0..qp.row_lower.len() {
        let (lower, upper) = (qp.row_lower[row], qp.row_upper[row]);
        let length = dot(qp.row(row), qp.row(row)).sqrt().max(f64::MIN_POSITIVE);
        let mut add = |distance: f64, upper: bool| {
            if distance.is_finite() {
                let wanted = guess.rows.get(row).is_some_and(|side| match side {
                    Side::Off => false,
                    Side::Lower | Side::Below => !upper,
                    Side::Upper | Side::Above => upper,
                });
                candidates.push((if wanted { f64::NEG_INFINITY } else { distance / length }, Limit { row, upper }));
            }
        };
        if qp.is_equality(row) {
            add(f64::MIN, true);
        } else {
            add(-lower, false);
            add(upper, true);
        }
    }
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let violated = candidates.partition_point(|(distance, _)| *distance <= 0.0);
    candidates.truncate(violated + qp.n);
    let mut limits: Vec<Limit> = candidates.into_iter().map(|(_, limit)| limit).collect();
    limits.sort_unstable();
    limits
}

/// Limits outside the list that the step violates, the worst first.
fn violated(qp: &Qp<'_>, step: &[f64], limits: &[Limit]) -> Vec<(Limit, f64)> {
    let mut found = Vec::new();
    for row in 0..qp.row_lower.len() {
        let value = dot(qp.row(row), step);
        for (upper, excess) in [(false, qp.row_lower[row] - value), (true, value - qp.row_upper[row])] {
            let limit = Limit { row, upper: upper || qp.is_equality(row) };
            if excess > VIOLATED && limits.binary_search(&limit).is_err() {
                found.push((limit, excess));
            }
        }
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    found
}

/// Compressed columns that are filled row by row.
struct Rows {
    columns: Vec<Vec<(usize, f64)>>,
    rhs: Vec<f64>,
}

impl Rows {
    fn push(&mut self, entries: impl Iterator<Item = (usize, f64)>, rhs: f64) {
        let row = self.rhs.len();
        for (column, value) in entries.filter(|(_, value)| *value != 0.0) {
            self.columns[column].push((row, value));
        }
        self.rhs.push(rhs);
    }

    fn matrix(&self) -> CscMatrix<f64> {
        compressed(self.rhs.len(), &self.columns)
    }
}

fn compressed(rows: usize, columns: &[Vec<(usize, f64)>]) -> CscMatrix<f64> {
    let mut starts = vec![0];
    for column in columns {
        starts.push(starts.last().map_or(0, |s| s + column.len()));
    }
    let entries = || columns.iter().flatten();
    CscMatrix::new(rows, columns.len(), starts, entries().map(|e| e.0).collect(), entries().map(|e| e.1).collect())
}

fn settings() -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        max_iter: 100,
        presolve_enable: false,
        tol_gap_abs: 1e-10,
        tol_gap_rel: 1e-10,
        tol_feas: 1e-10,
        max_threads: 1,
        ..DefaultSettings::default()
    }
}

/// The programme with only some of the limits. In elastic mode each row has one more variable, its excess.
fn solve_with(qp: &Qp<'_>, limits: &[Limit]) -> Result<Answer, Outcome> {
    let n = qp.n;
    let elastic = qp.penalty.is_finite();
    let total = if elastic { n + limits.len() } else { n };
    let equality = |limit: &Limit| qp.is_equality(limit.row);
    // Equalities first: they form their own cone. Elastic ones are two inequalities.
    let firm: Vec<usize> = (0..limits.len()).filter(|&k| !elastic && equality(&limits[k])).collect();
    let mut rows = Rows { columns: vec![Vec::new(); total], rhs: Vec::new() };
    for &k in &firm {
        let row = limits[k].row;
        rows.push(qp.row(row).iter().copied().enumerate(), qp.row_upper[row]);
    }
    // (limit, sign of its row): the multiplier of limit k is −sign·dual.
    let mut owners: Vec<(usize, f64)> = firm.iter().map(|&k| (k, 1.0)).collect();
    for (k, limit) in limits.iter().enumerate().filter(|(_, limit)| elastic || !equality(limit)) {
        let mut push = |sign: f64, rhs: f64| {
            let excess = qp.price(limit.row).is_finite().then_some((n + k, -1.0));
            rows.push(qp.row(limit.row).iter().map(|a| sign * a).enumerate().chain(excess), rhs);
            owners.push((k, sign));
        };
        if limit.upper {
            push(1.0, qp.row_upper[limit.row]);
        }
        if !limit.upper || equality(limit) {
            push(-1.0, -qp.row_lower[limit.row]);
        }
    }
    let mut bounds: Vec<(usize, f64)> = Vec::new();
    for j in 0..n {
        for (sign, rhs) in [(1.0, qp.upper[j]), (-1.0, -qp.lower[j])].into_iter().filter(|(_, rhs)| rhs.is_finite()) {
            rows.push(std::iter::once((j, sign)), rhs);
            bounds.push((j, sign));
        }
    }
    for k in n..total {
        rows.push(std::iter::once((k, -1.0)), 0.0);
    }
    let upper_triangle: Vec<Vec<(usize, f64)>> =
        (0..total).map(|j| if j < n { (0..=j).map(|i| (i, qp.hessian[i * n + j])).collect() } else { Vec::new() }).collect();
    let mut linear = qp.gradient.to_vec();
    linear.resize(total, qp.penalty);
    let cones = [ZeroConeT(firm.len()), NonnegativeConeT(rows.rhs.len() - firm.len())];
    let quadratic = compressed(total, &upper_triangle);
    let mut solver = DefaultSolver::new(&quadratic, &linear, &rows.matrix(), &rows.rhs, &cones, settings()).map_err(|_| Outcome::Failed)?;
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => {}
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => return Err(Outcome::Infeasible),
        _ => return Err(Outcome::Failed),
    }
    let (x, dual) = (&solver.solution.x, &solver.solution.z);
    let mut answer = Answer { step: vec![0.0; n], rows: vec![0.0; qp.row_lower.len()], bounds: vec![0.0; n] };
    for (j, d) in answer.step.iter_mut().enumerate() {
        *d = x[j].clamp(qp.lower[j], qp.upper[j]);
    }
    for ((k, sign), z) in owners.iter().zip(dual) {
        answer.rows[limits[*k].row] -= sign * z;
    }
    for ((j, sign), z) in bounds.iter().zip(&dual[owners.len()..]) {
        answer.bounds[*j] -= sign * z;
    }
    let finite = answer.step.iter().chain(&answer.rows).chain(&answer.bounds).all(|v| v.is_finite());
    if finite { Ok(answer) } else { Err(Outcome::Failed) }
}
