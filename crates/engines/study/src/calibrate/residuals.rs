//! What a curve does not explain.

use std::ops::Range;

use forcewright_base::maths;

use super::{Loss, Measured, mad};
use crate::sampling::{fisher_tail, normal};

/// Chance of each of the two tests to call an error of measuring unexplained.
const FALSE_ALARM: f64 = 0.005;
/// The same of each test to call it too regular: what is fitted makes residuals alternate a little, and two curves in one file do so entirely.
const TOO_REGULAR: f64 = 0.0002;
/// Intervals of the smooth curve through residuals, at most, and points in each, at least.
const MOST_INTERVALS: usize = 12;
const LEAST_POINTS: usize = 8;
/// Intervals of so many points and more, if those are not more: the first few tell a bend and a wave.
const FEW: [(usize, usize); 2] = [(6, 2), (12, 3)];
/// Degrees of freedom about the smooth curve, at least.
const LEAST_ABOUT: usize = 3;
/// Degrees of freedom of a scatter below which a lack of fit must be enormous to be found.
const LEAST_DEGREES: f64 = 5.0;
/// Points beyond parameters from which few runs alone are found.
const LEAST_ORDER: usize = 12;
/// Places beyond what the parameters can fit, without which nothing about the shape of a curve shows, however many points there are.
const LEAST_PLACES: usize = 3;
/// Residuals on the rarer side from which their order says something: fewer make few runs in any order.
const LEAST_SIDE: usize = 3;
/// Degrees of freedom of repeats from which they say what the scatter is.
const LEAST_REPEATS: usize = 8;
/// Distance of places that are the same, over the width of all.
const SAME: f64 = 1e-9;
/// Residuals beyond so many robust standard deviations are far off, where chance alone does not reach as far.
const FAR: f64 = 4.0;
/// Chance, about, of a good measurement to have such a point (tested).
const FAR_BY_CHANCE: f64 = 0.01;
/// How much farther it is with few points, times those beyond parameters: a median of few is uncertain itself.
const FAR_OF_FEW: f64 = 8.0;
/// Points beyond parameters from which a point is far off the others.
const LEAST_FOR_FAR: usize = 5;
/// Rounds of weights by which far points are found.
const FAR_ROUNDS: usize = 30;
/// Groups of points between which stretches are looked for, per branch.
const GROUPS: usize = 300;
/// What a column has left, over what it had, that others do not say.
const NEW: f64 = 1e-7;

/// Signs of the residuals in the order of their places: A. Wald & J. Wolfowitz, "On a test whether two samples are from the same
/// population", Annals of Mathematical Statistics 11(2), 147–162, 1940.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Runs {
    /// What was tested.
    pub test: SignTest,
    /// Stretches of one sign.
    pub observed: usize,
    /// As many as chance makes.
    pub expected: f64,
    /// Residuals above and below zero.
    pub sides: [usize; 2],
    /// Probability of so few runs by chance; of the sign test, of so many residuals on one side, on either.
    pub p: f64,
    /// Probability of so many runs by chance: small where signs alternate. 1 of the sign test.
    pub p_many: f64,
}

/// What the signs of residuals were tested for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignTest {
    /// Whether they come in runs, or alternate.
    Runs,
    /// Whether they lie on one side, where too few lie on the other for an order to say anything.
    Side,
}

/// What a lack of fit is held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The scatter of points that were measured again at the same place.
    Repeats,
    /// The scatter about a smooth curve through the residuals.
    Smooth,
}

/// Ratio of what a richer curve explains to its scatter, with Fisher's distribution: N. R. Draper & H. Smith, "Applied Regression Analysis",
/// 3rd ed., Wiley 1998, section 2.1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LackOfFit {
    /// Where the scatter comes from.
    pub against: Against,
    /// The ratio.
    pub ratio: f64,
    /// Degrees of freedom above and below.
    pub degrees: [f64; 2],
    /// Probability of so large a ratio by chance.
    pub p: f64,
    /// Probability of so small a ratio by chance: small where residuals make up for each other more evenly than errors do.
    pub p_small: f64,
}

/// Neighbouring points that lie on one side, farther than anywhere else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// The branch.
    pub branch: usize,
    /// From this place, SI.
    pub from: f64,
    /// To this one.
    pub to: f64,
    /// Mean of measured less computed, SI.
    pub mean: f64,
    /// Points.
    pub points: usize,
}

/// Measured less computed, and what is systematic about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// One per point, SI.
    pub values: Vec<f64>,
    /// Runs of signs.
    pub runs: Runs,
    /// Correlation of neighbours.
    pub autocorrelation: f64,
    /// Lack of fit; `None` with too few points for it.
    pub lack: Option<LackOfFit>,
    /// Size of what is systematic, root of the mean square, SI.
    pub systematic: f64,
    /// Size of the scatter about it, one standard deviation, SI.
    pub scatter: f64,
    /// Whether a test says that something is not explained, and it is larger than the model is wrong by.
    pub unexplained: bool,
    /// Whether that is that residuals alternate: two curves in one file, or rows that ring.
    pub alternates: bool,
    /// Whether the points are enough to tell: if not, nothing unexplained means nothing.
    pub judged: bool,
    /// Different places at which there are points, branch by branch.
    pub places: usize,
    /// Points that lie far off all others, by index, where every point counts the same ([`Loss::Squares`]).
    pub far: Vec<usize>,
    /// Where most of it is, if so.
    pub stretch: Option<Stretch>,
}

impl Residuals {
    pub(super) fn of(
        measured: &Measured<'_>,
        raw: &[f64],
        (jacobian, columns): (&[f64], usize),
        (noise, accuracy): (f64, f64),
        loss: Loss,
    ) -> Self {
        // Far points that a loss plays down are pulled in as far as it does.
        let own: Vec<f64> = raw.iter().map(|r| if noise > 0.0 { r * loss.weight(r / noise) } else { *r }).collect();
        let points = Points::of(measured, &own);
        let mut basis = Basis::default();
        for k in 0..columns {
            basis.push(&points.from.iter().map(|i| jacobian[i * columns + k]).collect::<Vec<f64>>());
        }
        let fitted = basis.count();
        let bare = basis.rest(&points.r);
        let n = points.r.len() as f64;
        let runs = Runs::of(&points.r);
        let lack = points.repeats(&bare, fitted, accuracy).or_else(|| points.smooth(&basis, &bare));
        let lacking = lack.is_some_and(|(l, _)| l.p < FALSE_ALARM);
        let regular = lack.filter(|(l, _)| l.p_small < TOO_REGULAR);
        let bunched = runs.p < FALSE_ALARM;
        let autocorrelation = autocorrelation(&points.r);
        let alternating = !lacking && !bunched && (runs.p_many < TOO_REGULAR || regular.is_some());
        let (systematic, scatter) = match lack {
            // The slow part of what is left is the scatter: the rest alternates about it.
            _ if alternating => {
                let all = squares(&points.r) / n;
                let part = regular.map_or(all * (-autocorrelation).clamp(0.0, 1.0), |(l, within)| (all - within * l.ratio).max(0.0));
                (part.sqrt(), (all - part).max(0.0).sqrt())
            }
            // Found, but not in the shape that the other test looks for: then the means of the runs are its size.
            _ if bunched && !lacking => of_runs(&points.r),
            Some((lack, within)) => {
                // What chance explains is none of it; nor is what parameters that priors or bounds hold take of chance.
                let bent = lack.degrees[0] * (lack.ratio - 1.0).max(0.0) * within;
                let held = (squares(&points.r) - squares(&bare) - fitted as f64 * within).max(0.0);
                (((bent + held) / n).sqrt(), within.sqrt())
            }
            None => (0.0, noise),
        };
        let unexplained = (lacking || bunched || alternating) && systematic > accuracy;
        let places = points.groups().count();
        let enough = lack.is_some_and(|(l, _)| l.degrees[1] >= LEAST_DEGREES) || points.r.len() >= fitted + LEAST_ORDER;
        let judged = unexplained || (enough && places >= fitted + LEAST_PLACES);
        let stretch = if unexplained && !alternating { points.longest(scatter) } else { None };
        let far = if loss == Loss::Squares { points.far(&basis, accuracy) } else { Vec::new() };
        let alternates = unexplained && alternating;
        let lack = lack.map(|(l, _)| l);
        Self {
            values: raw.to_vec(),
            runs,
            autocorrelation,
            lack,
            systematic,
            scatter,
            unexplained,
            alternates,
            judged,
            places,
            far,
            stretch,
        }
    }
}

fn squares(v: &[f64]) -> f64 {
    v.iter().map(|r| r * r).sum()
}

/// Root of the mean square of the means of stretches of one sign, and the scatter about them.
fn of_runs(sorted: &[f64]) -> (f64, f64) {
    let (mut between, mut runs) = (0.0, 0_usize);
    for run in sorted.chunk_by(|a, b| (*a > 0.0) == (*b > 0.0)) {
        let sum: f64 = run.iter().sum();
        between += sum * sum / run.len() as f64;
        runs += 1;
    }
    let within = (squares(sorted) - between).max(0.0);
    ((between / sorted.len().max(1) as f64).sqrt(), (within / sorted.len().saturating_sub(runs).max(1) as f64).sqrt())
}

impl Runs {
    fn of(sorted: &[f64]) -> Self {
        let signs: Vec<bool> = sorted.iter().filter(|r| r.abs() > 0.0).map(|r| *r > 0.0).collect();
        let above = signs.iter().filter(|s| **s).count();
        let sides = [above, signs.len() - above];
        let n = signs.len() as f64;
        let observed = usize::from(!signs.is_empty()) + signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
        let expected = 1.0 + 2.0 * sides[0] as f64 * sides[1] as f64 / n.max(1.0);
        let rarer = sides[0].min(sides[1]);
        let (test, p, p_many) = if rarer < LEAST_SIDE {
            (SignTest::Side, one_sided(signs.len(), rarer), 1.0)
        } else {
            let [p, p_many] = of_so_few_and_so_many(sides, observed);
            (SignTest::Runs, p, p_many)
        };
        Self { test, observed, expected, sides, p, p_many }
    }
}

/// Probability of at most and of at least so many runs, with at least one sign on each side: the distribution of Wald & Wolfowitz itself,
/// since the normal one that it tends to alarms too often where few points lie on one side.
fn of_so_few_and_so_many([a, b]: [usize; 2], observed: usize) -> [f64; 2] {
    let ways = |n: usize, k: usize| {
        let of = |v: usize| maths::ln_gamma(v as f64 + 1.0);
        if k > n { f64::NEG_INFINITY } else { of(n) - of(k) - of(n - k) }
    };
    let all = ways(a + b, a);
    let one = |runs: usize| {
        let k = runs / 2;
        // An even number has as many runs on both sides, an odd one has one more on one of them.
        let part = |x: usize, y: usize| maths::exp(ways(a - 1, x) + ways(b - 1, y) - all);
        if runs.is_multiple_of(2) { 2.0 * part(k - 1, k - 1) } else { part(k, k - 1) + part(k - 1, k) }
    };
    // As many as there are: each sign of the rarer side alone, and one run more of the other.
    let most = 2 * a.min(b) + usize::from(a != b);
    [(2..=observed).map(one).sum::<f64>().min(1.0), (observed..=most).map(one).sum::<f64>().min(1.0)]
}

/// Probability that of `n` signs at most `rarer` are the one or the other: the sign test, two-sided.
fn one_sided(n: usize, rarer: usize) -> f64 {
    let (mut ways, mut sum) = (1.0, 0.0);
    for k in 0..=rarer {
        sum += ways;
        ways *= n.saturating_sub(k) as f64 / (k + 1) as f64;
    }
    (1..n).fold(sum, |p, _| 0.5 * p).min(1.0)
}

fn autocorrelation(sorted: &[f64]) -> f64 {
    let all = squares(sorted);
    if all > 0.0 { sorted.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / all } else { 0.0 }
}

impl LackOfFit {
    fn of(against: Against, explained: f64, left: f64, degrees: [f64; 2]) -> Self {
        let ratio = (explained / degrees[0]) / (left / degrees[1]);
        let p = if left > 0.0 { fisher_tail(ratio, degrees[0], degrees[1]) } else { f64::from(u8::from(explained <= 0.0)) };
        // Its reciprocal has the same distribution with the degrees exchanged; of nothing at all nothing is too small.
        let p_small = if left > 0.0 && explained > 0.0 { fisher_tail(ratio.recip(), degrees[1], degrees[0]) } else { 1.0 };
        Self { against, ratio, degrees, p, p_small }
    }
}

/// Columns that are made orthogonal, one after the other.
#[derive(Clone, Default)]
struct Basis {
    columns: Vec<Vec<f64>>,
}

impl Basis {
    fn count(&self) -> usize {
        self.columns.len()
    }

    /// What no column says. Twice is enough: W. Kahan in B. N. Parlett, "The Symmetric Eigenvalue Problem", SIAM 1998, section 6.9.
    fn rest(&self, vector: &[f64]) -> Vec<f64> {
        let mut rest = vector.to_vec();
        for column in self.columns.iter().chain(&self.columns) {
            let share: f64 = column.iter().zip(&rest).map(|(a, b)| a * b).sum();
            rest.iter_mut().zip(column).for_each(|(r, c)| *r -= share * c);
        }
        rest
    }

    /// Adds what is new about a column.
    fn push(&mut self, column: &[f64]) {
        let before = squares(column).sqrt();
        let mut rest = self.rest(column);
        let after = squares(&rest).sqrt();
        if after > NEW * before {
            for r in &mut rest {
                *r /= after;
            }
            self.columns.push(rest);
        }
    }
}

/// Residuals branch by branch, each in the order of their places.
struct Points {
    /// Where each was among all that was measured.
    from: Vec<usize>,
    x: Vec<f64>,
    r: Vec<f64>,
    /// Of each branch, empty ones too.
    branches: Vec<Range<usize>>,
    /// Distance of places that are the same.
    same: f64,
}

impl Points {
    /// Rows that repeat each other exactly were not measured twice: one of them counts.
    fn of(measured: &Measured<'_>, residuals: &[f64]) -> Self {
        let [same, equal] = [measured.x, measured.raw].map(|all| {
            let [low, high] = all.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
            SAME * (high - low)
        });
        let (mut from, mut branches, mut first) = (Vec::new(), Vec::new(), 0);
        for count in measured.branches {
            let mut own: Vec<usize> = (first..first + count).collect();
            own.sort_by(|a, b| measured.x[*a].total_cmp(&measured.x[*b]));
            first += count;
            let begin = from.len();
            for group in own.chunk_by(|a, b| (measured.x[*a] - measured.x[*b]).abs() <= same) {
                let mut by_value = group.to_vec();
                by_value.sort_by(|a, b| measured.raw[*a].total_cmp(&measured.raw[*b]));
                by_value.dedup_by(|next, kept| measured.raw[*next] - measured.raw[*kept] <= equal);
                // Those that are left, in the order in which they were measured.
                by_value.sort_unstable();
                from.extend(by_value);
            }
            branches.push(begin..from.len());
        }
        let [x, r] = [measured.x, residuals].map(|all| from.iter().map(|i| all[*i]).collect());
        Self { from, x, r, branches, same }
    }

    /// Points of one branch at one place, by index here.
    fn groups(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        self.branches.iter().flat_map(move |own| {
            let mut from = own.start;
            std::iter::from_fn(move || {
                let first = (from < own.end).then_some(from)?;
                from += 1;
                while from < own.end && (self.x[from] - self.x[from - 1]).abs() <= self.same {
                    from += 1;
                }
                Some(first..from)
            })
        })
    }

    /// Of each branch, piecewise straight lines between places with as many points between any two.
    fn hats(&self) -> Vec<Vec<f64>> {
        let mut all = Vec::new();
        for own in &self.branches {
            let count = own.len();
            let few = FEW.iter().rev().find(|(points, _)| count >= *points).map_or(0, |(_, intervals)| *intervals);
            let intervals = (count / LEAST_POINTS).max(few).min(MOST_INTERVALS);
            if intervals < 2 {
                continue;
            }
            let mut knots: Vec<f64> = (0..=intervals).map(|k| self.x[own.start + k * (count - 1) / intervals]).collect();
            knots.dedup_by(|a, b| a <= b);
            for (k, knot) in knots.iter().enumerate() {
                let mut hat = vec![0.0; self.x.len()];
                for (x, value) in self.x[own.clone()].iter().zip(&mut hat[own.clone()]) {
                    let side = if x < knot { k.checked_sub(1) } else { Some(k + 1).filter(|n| *n < knots.len()) };
                    let away = side.map_or(0.0, |s| (x - knot) / (knots[s] - knot));
                    *value = (1.0 - away.abs()).max(0.0);
                }
                all.push(hat);
            }
        }
        all
    }

    /// Lack of fit against a smooth curve, and the square of the scatter about it; none where the curve follows each point.
    fn smooth(&self, basis: &Basis, bare: &[f64]) -> Option<(LackOfFit, f64)> {
        let mut rich = basis.clone();
        self.hats().iter().for_each(|hat| rich.push(hat));
        (rich.count() > basis.count() && self.r.len() >= rich.count() + LEAST_ABOUT).then(|| {
            let left = squares(&rich.rest(&self.r));
            let degrees = [(rich.count() - basis.count()) as f64, (self.r.len() - rich.count()) as f64];
            (LackOfFit::of(Against::Smooth, squares(bare) - left, left, degrees), left / degrees[1])
        })
    }

    /// Lack of fit against points measured again at one place, where there are enough, and the square of their scatter: of the least, what
    /// the model is wrong by, since a coarse display or a conversion makes repeats that next to agree.
    fn repeats(&self, bare: &[f64], fitted: usize, accuracy: f64) -> Option<(LackOfFit, f64)> {
        let (mut groups, mut pure) = (0_usize, 0.0);
        for group in self.groups() {
            let mean = bare[group.clone()].iter().sum::<f64>() / group.len() as f64;
            pure += bare[group].iter().map(|r| r - mean).map(|d| d * d).sum::<f64>();
            groups += 1;
        }
        let again = self.r.len() - groups;
        (again >= LEAST_REPEATS && groups > fitted).then(|| {
            let degrees = [(groups - fitted) as f64, again as f64];
            let left = pure.max(again as f64 * accuracy * accuracy);
            let mut lack = LackOfFit::of(Against::Repeats, squares(bare) - pure, left, degrees);
            if left > pure {
                // A scatter that was not measured is no reason to expect one.
                lack.p_small = 1.0;
            }
            (lack, left / degrees[1])
        })
    }

    /// Points that lie farther off than errors of the others do, once the tangents are laid through the others: Huber's loss by repeated
    /// weights, then residuals over their median.
    fn far(&self, basis: &Basis, accuracy: f64) -> Vec<usize> {
        let n = self.r.len();
        let (mut left, mut roots) = (self.r.clone(), vec![1.0; n]);
        let fitted = basis.count();
        for _ in 0..FAR_ROUNDS {
            let scale = mad(&left, fitted).max(f64::MIN_POSITIVE);
            for (root, r) in roots.iter_mut().zip(&left) {
                *root = Loss::Huber.weight(r / scale).sqrt();
            }
            let mut weighted = Basis::default();
            for column in &basis.columns {
                weighted.push(&column.iter().zip(&roots).map(|(c, w)| c * w).collect::<Vec<_>>());
            }
            let rest = weighted.rest(&self.r.iter().zip(&roots).map(|(r, w)| r * w).collect::<Vec<_>>());
            left = rest.iter().zip(&roots).map(|(r, w)| r / w).collect();
        }
        let scale = mad(&left, fitted);
        if n < fitted + LEAST_FOR_FAR || !scale.is_finite() {
            return Vec::new();
        }
        let by_chance = -normal::quantile(0.5 * FAR_BY_CHANCE / n as f64);
        let most = FAR.max(by_chance) * (1.0 + FAR_OF_FEW / (n - fitted) as f64) * scale;
        (0..n).filter(|i| left[*i].abs() > most.max(accuracy)).map(|i| self.from[i]).collect()
    }

    /// The stretch whose mean lies farthest from 0, over the error of a mean of so many points.
    fn longest(&self, scatter: f64) -> Option<Stretch> {
        let mut best: Option<(f64, Stretch)> = None;
        for (branch, own) in self.branches.iter().enumerate() {
            let places: Vec<usize> = own.clone().collect();
            let groups: Vec<&[usize]> = places.chunks(places.len().div_ceil(GROUPS).max(1)).collect();
            for from in 0..groups.len() {
                let (mut sum, mut n) = (0.0, 0_usize);
                for to in from..groups.len() {
                    sum += groups[to].iter().map(|i| self.r[*i]).sum::<f64>();
                    n += groups[to].len();
                    let far = sum.abs() / (n as f64).sqrt() / scatter.max(f64::MIN_POSITIVE);
                    if best.as_ref().is_none_or(|(most, _)| far > *most) {
                        let [a, b] = [groups[from][0], groups[to][groups[to].len() - 1]].map(|i| self.x[i]);
                        best = Some((far, Stretch { branch, from: a, to: b, mean: sum / n as f64, points: n }));
                    }
                }
            }
        }
        best.map(|(_, stretch)| stretch)
    }
}
