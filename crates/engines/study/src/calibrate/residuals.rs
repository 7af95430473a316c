//! What a curve does not explain.

use super::{Loss, Measured};
use crate::sampling::{fisher_tail, normal};

/// Chance of each of the two tests to call an error of measuring unexplained.
const FALSE_ALARM: f64 = 0.005;
/// Intervals of the smooth curve through residuals, at most, and points in each, at least.
const MOST_INTERVALS: usize = 12;
const LEAST_POINTS: usize = 8;
/// Degrees of freedom of repeats from which they say what the scatter is.
const LEAST_REPEATS: usize = 8;
/// Distance of places that are the same, over the width of all.
const SAME: f64 = 1e-9;
/// Groups of points between which stretches are looked for, per branch.
const GROUPS: usize = 300;
/// What a column has left, over what it had, that others do not say.
const NEW: f64 = 1e-7;

/// Signs of the residuals in the order of their places: A. Wald & J. Wolfowitz, "On a test whether two samples are from the same
/// population", Annals of Mathematical Statistics 11(2), 147–162, 1940.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Runs {
    /// Stretches of one sign.
    pub observed: usize,
    /// As many as chance makes.
    pub expected: f64,
    /// Probability of so few by chance.
    pub p: f64,
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
        let order = order(measured);
        let sorted: Vec<f64> = order.iter().map(|i| own[*i]).collect();
        let runs = Runs::of(&sorted);
        let mut basis = Basis::default();
        for k in 0..columns {
            basis.push(&jacobian.chunks_exact(columns).map(|row| row[k]).collect::<Vec<f64>>());
        }
        let fitted = basis.count();
        let bare = basis.rest(&own);
        for hat in hats(measured, &order) {
            basis.push(&hat);
        }
        let (all, rest) = (basis.count(), basis.rest(&own));
        let n = own.len() as f64;
        let squares = |v: &[f64]| v.iter().map(|r| r * r).sum::<f64>();
        let (more, left) = ((all - fitted) as f64, n - all as f64);
        let scatter = if left >= 1.0 { (squares(&rest) / left).sqrt() } else { noise };
        let smooth = (more >= 1.0 && left >= 3.0)
            .then(|| LackOfFit::of(Against::Smooth, squares(&bare) - squares(&rest), squares(&rest), [more, left]));
        let lack = repeats(measured, &bare, &order, fitted).or(smooth);
        // What a smooth curve takes of pure scatter is none of it; parameters have taken what of it they can.
        let systematic = ((squares(&own) - squares(&rest)) / n - all as f64 * scatter * scatter / n).max(0.0).sqrt();
        let found = lack.is_some_and(|l| l.p < FALSE_ALARM) || runs.p < FALSE_ALARM;
        let unexplained = found && systematic > accuracy;
        let stretch = if unexplained { longest(measured, &own, &order, scatter) } else { None };
        Self { values: raw.to_vec(), runs, autocorrelation: autocorrelation(&sorted), lack, systematic, scatter, unexplained, stretch }
    }
}

/// Points branch by branch, each in the order of their places.
fn order(measured: &Measured<'_>) -> Vec<usize> {
    let mut all: Vec<usize> = (0..measured.x.len()).collect();
    let mut first = 0;
    for count in measured.branches {
        all[first..first + count].sort_by(|a, b| measured.x[*a].total_cmp(&measured.x[*b]));
        first += count;
    }
    all
}

impl Runs {
    fn of(sorted: &[f64]) -> Self {
        let signs: Vec<bool> = sorted.iter().filter(|r| r.abs() > 0.0).map(|r| *r > 0.0).collect();
        let n = signs.len() as f64;
        let above = signs.iter().filter(|s| **s).count() as f64;
        let observed = usize::from(!signs.is_empty()) + signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
        let product = 2.0 * above * (n - above);
        let expected = 1.0 + product / n.max(1.0);
        let variance = product * (product - n) / (n * n * (n - 1.0)).max(1.0);
        let p = if variance > 0.0 { normal::cdf((observed as f64 + 0.5 - expected) / variance.sqrt()) } else { 1.0 };
        Self { observed, expected, p }
    }
}

fn autocorrelation(sorted: &[f64]) -> f64 {
    let all: f64 = sorted.iter().map(|r| r * r).sum();
    if all > 0.0 { sorted.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / all } else { 0.0 }
}

impl LackOfFit {
    fn of(against: Against, explained: f64, left: f64, degrees: [f64; 2]) -> Self {
        let ratio = (explained / degrees[0]) / (left / degrees[1]);
        let p = if left > 0.0 { fisher_tail(ratio, degrees[0], degrees[1]) } else { f64::from(u8::from(explained <= 0.0)) };
        Self { against, ratio, degrees, p }
    }
}

/// Columns that are made orthogonal, one after the other.
#[derive(Default)]
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
        let size = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let before = size(column);
        let mut rest = self.rest(column);
        let after = size(&rest);
        if after > NEW * before {
            for r in &mut rest {
                *r /= after;
            }
            self.columns.push(rest);
        }
    }
}

/// Of each branch, piecewise straight lines between places with as many points between any two.
fn hats(measured: &Measured<'_>, order: &[usize]) -> Vec<Vec<f64>> {
    let mut all = Vec::new();
    let mut first = 0;
    for count in measured.branches {
        let own = &order[first..first + count];
        first += count;
        let intervals = (count / LEAST_POINTS).min(MOST_INTERVALS);
        if intervals < 2 {
            continue;
        }
        let mut knots: Vec<f64> = (0..=intervals).map(|k| measured.x[own[k * (count - 1) / intervals]]).collect();
        knots.dedup_by(|a, b| a <= b);
        for (k, knot) in knots.iter().enumerate() {
            let mut hat = vec![0.0; measured.x.len()];
            for point in own {
                let x = measured.x[*point];
                let side = if x < *knot { k.checked_sub(1) } else { Some(k + 1).filter(|n| *n < knots.len()) };
                let away = side.map_or(0.0, |s| (x - knot) / (knots[s] - knot));
                hat[*point] = (1.0 - away.abs()).max(0.0);
            }
            all.push(hat);
        }
    }
    all
}

/// Lack of fit against points measured again at one place, where there are enough.
fn repeats(measured: &Measured<'_>, residuals: &[f64], order: &[usize], fitted: usize) -> Option<LackOfFit> {
    let [low, high] = measured.x.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
    let same = SAME * (high - low);
    let (mut first, mut groups, mut pure) = (0, 0_usize, 0.0);
    for count in measured.branches {
        for group in order[first..first + count].chunk_by(|a, b| (measured.x[*a] - measured.x[*b]).abs() <= same) {
            let mean = group.iter().map(|i| residuals[*i]).sum::<f64>() / group.len() as f64;
            pure += group.iter().map(|i| residuals[*i] - mean).map(|d| d * d).sum::<f64>();
            groups += 1;
        }
        first += count;
    }
    let again = residuals.len() - groups;
    let all: f64 = residuals.iter().map(|r| r * r).sum();
    (again >= LEAST_REPEATS && groups > fitted)
        .then(|| LackOfFit::of(Against::Repeats, all - pure, pure, [(groups - fitted) as f64, again as f64]))
}

/// The stretch whose mean lies farthest from 0, over the error of a mean of so many points.
fn longest(measured: &Measured<'_>, own: &[f64], order: &[usize], scatter: f64) -> Option<Stretch> {
    let mut best: Option<(f64, Stretch)> = None;
    let mut first = 0;
    for (branch, count) in measured.branches.iter().enumerate() {
        let points = &order[first..first + count];
        first += count;
        let size = count.div_ceil(GROUPS).max(1);
        let groups: Vec<&[usize]> = points.chunks(size).collect();
        for from in 0..groups.len() {
            let (mut sum, mut n) = (0.0, 0_usize);
            for to in from..groups.len() {
                sum += groups[to].iter().map(|i| own[*i]).sum::<f64>();
                n += groups[to].len();
                let far = sum.abs() / (n as f64).sqrt() / scatter.max(f64::MIN_POSITIVE);
                if best.as_ref().is_none_or(|(most, _)| far > *most) {
                    let [a, b] = [groups[from][0], groups[to][groups[to].len() - 1]].map(|i| measured.x[i]);
                    best = Some((far, Stretch { branch, from: a, to: b, mean: sum / n as f64, points: n }));
                }
            }
        }
    }
    best.map(|(_, stretch)| stretch)
}
