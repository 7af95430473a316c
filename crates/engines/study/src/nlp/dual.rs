//! The quadratic programme by a dual active-set method, from its minimum without constraints.
//!
//! D. Goldfarb and A. Idnani, "A numerically stable dual method for solving strictly convex quadratic programs", Mathematical
//! Programming 27 (1983), 1–33. One violated limit at a time is brought to its bound, along the way on which those that hold already keep
//! holding; a multiplier that would become wrong lets its limit go. Where exceeding a row has a price `γ`, its multiplier ends there: a row
//! that reaches it is exceeded from then on, and one that is exceeded no longer is brought back the same way, its multiplier falling. Both
//! ends of a multiplier are thus alike, and the dual objective rises with every step.

use super::active::{Guess, Side};
use super::hessian::dot;
use super::qp::{Answer, Outcome, Qp};

/// A normal whose part beyond the span of those that hold is below this part of it counts as dependent on them.
const DEPENDENT: f64 = 1e-10;
/// What of a violation may be rounding of the proof that nothing satisfies the limits.
const DOUBT: f64 = 1e-3;
/// A pivot of the matrix is at least this part of its diagonal.
const LEAST_PIVOT: f64 = 1e-13;
/// Most steps for each variable; more than that is cycling.
const MOST_STEPS: usize = 20;

/// A limit that holds at its bound: a row, or after those the bound of a variable.
#[derive(Debug, Clone, Copy)]
struct Held {
    limit: usize,
    side: Side,
}

/// The limit that is on its way to its bound.
#[derive(Debug, Clone, Copy)]
struct Entering {
    limit: usize,
    /// Where it will hold.
    side: Side,
    /// Whether its multiplier rises or falls.
    sign: f64,
    bound: f64,
}

/// What ends a step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    /// The limit has come to its bound.
    Full,
    /// The multiplier of the limit held in this place has come to an end of its range.
    Lost(usize),
    /// The multiplier of the limit itself has.
    Priced,
    Never,
}

/// The state of a solution, in buffers that are used again.
#[derive(Debug, Default)]
pub(super) struct Dual {
    n: usize,
    rows: usize,
    /// Columns of `L⁻ᵀQ`, one after the other: `H = LLᵀ`; the first span what is held.
    basis: Vec<f64>,
    /// Columns of the triangle `R`, `n` apart: `L⁻¹N = Q·R` with the normals held as `N`.
    triangle: Vec<f64>,
    held: Vec<Held>,
    sides: Vec<Side>,
    step: Vec<f64>,
    /// Of rows, then of bounds.
    multipliers: Vec<f64>,
    /// Rows that some step within the bounds violates, each with the reciprocal of its length.
    within_reach: Vec<(usize, f64)>,
    normal: Vec<f64>,
    parts: Vec<f64>,
    rates: Vec<f64>,
    way: Vec<f64>,
}

impl Dual {
    /// Solves the programme, to about working precision; `None` where that takes too long or the matrix is not positive definite.
    pub(super) fn solve(&mut self, qp: &Qp<'_>) -> Option<Outcome> {
        self.begin(qp)?;
        let mut left = MOST_STEPS * (qp.n + 1);
        while let Some(entering) = self.worst(qp) {
            loop {
                left = left.checked_sub(1)?;
                match self.advance(qp, entering) {
                    End::Full | End::Priced => break,
                    End::Lost(_) => {}
                    End::Never => return self.contradiction(qp, entering).then_some(Outcome::Infeasible),
                }
            }
        }
        let finite = self.step.iter().chain(&self.multipliers).all(|v| v.is_finite());
        finite.then_some(Outcome::Solved)
    }

    /// The active set that was found, and the solution.
    pub(super) fn read(&self, guess: &mut Guess, answer: &mut Answer) {
        let (rows, bounds) = self.sides.split_at(self.rows);
        guess.rows.clear();
        guess.rows.extend_from_slice(rows);
        guess.bounds.clear();
        guess.bounds.extend_from_slice(bounds);
        answer.step.clone_from(&self.step);
        let (rows, bounds) = self.multipliers.split_at(self.rows);
        answer.rows.clear();
        answer.rows.extend_from_slice(rows);
        answer.bounds.clear();
        answer.bounds.extend_from_slice(bounds);
    }

    /// The minimum without constraints.
    fn begin(&mut self, qp: &Qp<'_>) -> Option<()> {
        let n = qp.n;
        (self.n, self.rows) = (n, qp.row_lower.len());
        self.held.clear();
        self.sides.clear();
        self.sides.resize(self.rows + n, Side::Off);
        self.multipliers.clear();
        self.multipliers.resize(self.rows + n, 0.0);
        self.triangle.clear();
        self.triangle.resize(n * n, 0.0);
        self.inverse_factor(qp)?;
        self.step.clear();
        self.step.resize(n, 0.0);
        for column in self.basis.chunks_exact(n.max(1)) {
            let part = -dot(column, qp.gradient);
            add_scaled(&mut self.step, column, part);
        }
        self.within_reach.clear();
        for i in 0..self.rows {
            let (mut low, mut high, mut square) = (0.0, 0.0, 0.0);
            for ((a, l), u) in qp.row(i).iter().zip(qp.lower).zip(qp.upper) {
                if *a != 0.0 {
                    let (at_lower, at_upper) = (a * l, a * u);
                    low += at_lower.min(at_upper);
                    high += at_lower.max(at_upper);
                    square += a * a;
                }
            }
            // Written so that what is not a number is within reach. A row of zeros is violated or not, whatever the step.
            if !(low >= qp.row_lower[i] && high <= qp.row_upper[i]) {
                self.within_reach.push((i, 1.0 / f64::max(square, f64::MIN_POSITIVE).sqrt()));
            }
        }
        Some(())
    }

    /// `L⁻ᵀ` of the matrix, by columns.
    fn inverse_factor(&mut self, qp: &Qp<'_>) -> Option<()> {
        let n = self.n;
        let lower = &mut self.triangle;
        for i in 0..n {
            for j in 0..=i {
                let rest = qp.hessian[i * n + j] - dot(&lower[i * n..i * n + j], &lower[j * n..j * n + j]);
                if i == j {
                    // What rounding has taken of a matrix that is positive definite.
                    let rest = rest.max(LEAST_PIVOT * qp.hessian[i * n + i]);
                    // Written so that NaN fails.
                    if !(rest > 0.0 && rest.is_finite()) {
                        return None;
                    }
                    lower[i * n + i] = rest.sqrt();
                } else {
                    lower[i * n + j] = rest / lower[j * n + j];
                }
            }
        }
        // Column k of L⁻ᵀ is row k of L⁻¹: the unit vectors, one forward substitution each.
        self.basis.clear();
        self.basis.resize(n * n, 0.0);
        for column in 0..n {
            for i in column..n {
                let known: f64 = (column..i).map(|k| lower[i * n + k] * self.basis[k * n + column]).sum();
                let unit = if i == column { 1.0 } else { 0.0 };
                self.basis[i * n + column] = (unit - known) / lower[i * n + i];
            }
        }
        lower.fill(0.0);
        Some(())
    }

    /// The limit that is violated most, or exceeded at its price without need, relative to the length of its normal.
    fn worst(&self, qp: &Qp<'_>) -> Option<Entering> {
        let (mut worst, mut found) = (0.0, None);
        let mut consider = |excess: f64, scale: f64, entering: Entering| {
            if excess > 1e-12 * (1.0 + entering.bound.abs()) && excess * scale > worst {
                (worst, found) = (excess * scale, Some(entering));
            }
        };
        let mut both = |limit: usize, value: f64, (lower, upper): (f64, f64), scale: f64| match self.sides[limit] {
            Side::Off => {
                consider(lower - value, scale, Entering { limit, side: Side::Lower, sign: 1.0, bound: lower });
                consider(value - upper, scale, Entering { limit, side: Side::Upper, sign: -1.0, bound: upper });
            }
            Side::Below => consider(value - lower, scale, Entering { limit, side: Side::Lower, sign: -1.0, bound: lower }),
            Side::Above => consider(upper - value, scale, Entering { limit, side: Side::Upper, sign: 1.0, bound: upper }),
            Side::Lower | Side::Upper => {}
        };
        for (j, d) in self.step.iter().enumerate() {
            both(self.rows + j, *d, (qp.lower[j], qp.upper[j]), 1.0);
        }
        for &(i, scale) in &self.within_reach {
            both(i, dot(qp.row(i), &self.step), (qp.row_lower[i], qp.row_upper[i]), scale);
        }
        found
    }

    /// The range of the multiplier of a limit held on a side.
    fn range(&self, qp: &Qp<'_>, limit: usize, side: Side) -> [f64; 2] {
        let (price, equality) = if limit < self.rows {
            (qp.price(limit), qp.is_equality(limit))
        } else {
            let j = limit - self.rows;
            (f64::INFINITY, qp.upper[j] <= qp.lower[j])
        };
        match side {
            _ if equality => [-price, price],
            Side::Lower | Side::Below => [0.0, price],
            _ => [-price, 0.0],
        }
    }

    /// What a limit does whose multiplier has come to the end of its range.
    fn beyond(multiplier: f64) -> Side {
        if multiplier > 0.0 {
            Side::Below
        } else if multiplier < 0.0 {
            Side::Above
        } else {
            Side::Off
        }
    }

    /// One step of a limit towards its bound.
    fn advance(&mut self, qp: &Qp<'_>, entering: Entering) -> End {
        let (n, count) = (self.n, self.held.len());
        let Entering { limit, side, sign, bound } = entering;
        self.normal.clear();
        if limit < self.rows {
            self.normal.extend(qp.row(limit).iter().map(|a| sign * a));
        } else {
            self.normal.resize(n, 0.0);
            self.normal[limit - self.rows] = sign;
        }
        self.parts.clear();
        self.parts.extend(self.basis.chunks_exact(n).map(|column| dot(column, &self.normal)));
        self.way.clear();
        self.way.resize(n, 0.0);
        for (column, part) in self.basis.chunks_exact(n).zip(&self.parts).skip(count) {
            add_scaled(&mut self.way, column, *part);
        }
        let square = dot(&self.parts[count..], &self.parts[count..]);
        let moves = square > DEPENDENT * DEPENDENT * dot(&self.parts, &self.parts);
        self.rates_of_held();
        let missing = sign * bound - dot(&self.normal, &self.step);
        let (mut length, mut end) = if moves { (missing.max(0.0) / square, End::Full) } else { (f64::INFINITY, End::Never) };
        let [least, most] = self.range(qp, limit, side);
        let own = if sign > 0.0 { most - self.multipliers[limit] } else { self.multipliers[limit] - least };
        if own < length {
            (length, end) = (own, End::Priced);
        }
        for (place, (held, rate)) in self.held.iter().zip(&self.rates).enumerate() {
            let [least, most] = self.range(qp, held.limit, held.side);
            let y = self.multipliers[held.limit];
            let room = if *rate > 0.0 { (y - least) / rate } else { (y - most) / rate };
            if room < length {
                (length, end) = (room.max(0.0), End::Lost(place));
            }
        }
        if end == End::Never {
            return end;
        }
        if moves {
            add_scaled(&mut self.step, &self.way, length);
        }
        for (held, rate) in self.held.iter().zip(&self.rates) {
            self.multipliers[held.limit] -= length * rate;
        }
        self.multipliers[limit] += sign * length;
        match end {
            End::Full => self.hold(entering),
            End::Priced => self.settle(limit, if sign > 0.0 { most } else { least }),
            End::Lost(place) => {
                let Held { limit, side } = self.held[place];
                let [least, most] = self.range(qp, limit, side);
                self.settle(limit, if self.rates[place] > 0.0 { least } else { most });
                self.release(place);
            }
            End::Never => {}
        }
        end
    }

    /// Puts a multiplier to the end of its range, exactly.
    fn settle(&mut self, limit: usize, multiplier: f64) {
        self.multipliers[limit] = multiplier;
        self.sides[limit] = Self::beyond(multiplier);
    }

    /// By how much the multipliers of what is held fall per unit of the one that rises: `R⁻¹` times the parts of its normal.
    fn rates_of_held(&mut self) {
        let (n, count) = (self.n, self.held.len());
        self.rates.clear();
        self.rates.extend_from_slice(&self.parts[..count]);
        for k in (0..count).rev() {
            let column = &self.triangle[k * n..=k * n + k];
            let rate = self.rates[k] / column[k];
            self.rates[k] = rate;
            add_scaled(&mut self.rates[..k], &column[..k], -rate);
        }
    }

    /// Takes a limit among those held, its normal having the parts that were found.
    fn hold(&mut self, entering: Entering) {
        let (n, count) = (self.n, self.held.len());
        for k in (count + 1..n).rev() {
            let (c, s, length) = rotation(self.parts[k - 1], self.parts[k]);
            self.parts[k - 1] = length;
            rotate(&mut self.basis[(k - 1) * n..(k + 1) * n], (c, s));
        }
        // The triangle is of the normals themselves.
        for (entry, part) in self.triangle[count * n..].iter_mut().zip(&self.parts[..=count]) {
            *entry = entering.sign * part;
        }
        self.held.push(Held { limit: entering.limit, side: entering.side });
        self.sides[entering.limit] = entering.side;
    }

    /// Lets go of what is held in a place.
    fn release(&mut self, place: usize) {
        let n = self.n;
        self.held.remove(place);
        for k in place..self.held.len() {
            self.triangle.copy_within((k + 1) * n..(k + 2) * n, k * n);
            let (c, s, _) = rotation(self.triangle[k * n + k], self.triangle[k * n + k + 1]);
            // This column now, the later ones where they still are.
            for column in (k..=k).chain(k + 2..=self.held.len()) {
                let pair = &mut self.triangle[column * n + k..column * n + k + 2];
                (pair[0], pair[1]) = (c * pair[0] + s * pair[1], c * pair[1] - s * pair[0]);
            }
            rotate(&mut self.basis[k * n..(k + 2) * n], (c, s));
        }
    }

    /// Whether what is held proves that a limit cannot be satisfied: its normal is theirs with factors of the signs that make every step
    /// that keeps them worse.
    fn contradiction(&mut self, qp: &Qp<'_>, entering: Entering) -> bool {
        let missing = entering.sign * entering.bound - dot(&self.normal, &self.step);
        let mut rest = self.normal.clone();
        for (held, rate) in self.held.iter().zip(&self.rates) {
            if held.limit < self.rows {
                add_scaled(&mut rest, qp.row(held.limit), -rate);
            } else {
                rest[held.limit - self.rows] -= rate;
            }
        }
        // What the rest can bring within the bounds.
        let ends = qp.lower.iter().zip(qp.upper).zip(&self.step);
        let reach = rest.iter().zip(ends).map(|(r, ((l, u), d))| if *r == 0.0 { 0.0 } else { (r * (l - d)).max(r * (u - d)) });
        reach.sum::<f64>() <= DOUBT * missing
    }
}

fn add_scaled(into: &mut [f64], of: &[f64], factor: f64) {
    into.iter_mut().zip(of).for_each(|(a, b)| *a += factor * b);
}

/// Cosine and sine of the rotation that takes (a, b) to (length, 0).
fn rotation(a: f64, b: f64) -> (f64, f64, f64) {
    if b == 0.0 {
        return (1.0, 0.0, a);
    }
    let length = forcewright_base::maths::hypot(a, b);
    (a / length, b / length, length)
}

/// Rotates two columns that lie one after the other.
fn rotate(columns: &mut [f64], (c, s): (f64, f64)) {
    let (one, other) = columns.split_at_mut(columns.len() / 2);
    for (a, b) in one.iter_mut().zip(other) {
        (*a, *b) = (c * *a + s * *b, c * *b - s * *a);
    }
}
