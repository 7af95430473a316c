//! Straight lines through measured points, and two of them where a law changes at a place that is not known; with intervals.
//!
//! Errors are those of the ordinate, normal and independent; the abscissa is exact. Where it is the other one that was set, exchange them:
//! a line fitted the wrong way is too flat. N. R. Draper & H. Smith, "Applied Regression Analysis", chapters 1 and 3.

use crate::sampling::{Confidence, Estimate, Interval, fisher, student};

/// The line of least squares `y = intercept + slope · x`.
///
/// ```
/// use forcewright_study::regression::Line;
/// use forcewright_study::sampling::Confidence;
///
/// let line = Line::through(&[[0.0, 1.1], [1.0, 2.9], [2.0, 5.0]]).expect("two abscissae");
/// assert!((line.slope - 1.95).abs() < 1e-12);
/// assert!(line.slope_estimate(Confidence::P95).interval.contains(2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Number of points.
    pub count: usize,
    /// Their mean abscissa.
    pub mean_x: f64,
    /// Their mean ordinate.
    pub mean_y: f64,
    /// Sum of the squared distances of the abscissae from their mean.
    pub spread: f64,
    /// Slope.
    pub slope: f64,
    /// Sum of the squared residuals.
    pub squares: f64,
}

impl Line {
    /// The line; absent with fewer than two abscissae that differ, or a number that is not finite.
    pub fn through(points: &[[f64; 2]]) -> Option<Self> {
        let n = points.len() as f64;
        let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / n;
        let (mean_x, mean_y) = (mean(0), mean(1));
        let (mut spread, mut product) = (0.0, 0.0);
        for [x, y] in points {
            spread += (x - mean_x) * (x - mean_x);
            product += (x - mean_x) * (y - mean_y);
        }
        // What rounding leaves of equal abscissae is none.
        let size = points.iter().fold(0.0_f64, |m, p| m.max(p[0].abs()));
        if spread.is_nan() || spread <= n * (4.0 * f64::EPSILON * size) * (4.0 * f64::EPSILON * size) {
            return None;
        }
        let slope = product / spread;
        let squares: f64 = points.iter().map(|[x, y]| y - mean_y - slope * (x - mean_x)).map(|r| r * r).sum();
        squares.is_finite().then_some(Self { count: points.len(), mean_x, mean_y, spread, slope, squares })
    }

    /// Ordinate of the line.
    pub fn at(&self, x: f64) -> f64 {
        self.mean_y + self.slope * (x - self.mean_x)
    }

    /// Ordinate at the abscissa 0.
    pub fn intercept(&self) -> f64 {
        self.at(0.0)
    }

    /// Degrees of freedom of the residuals.
    pub fn degrees(&self) -> f64 {
        self.count as f64 - 2.0
    }

    /// Variance of a point about the line; infinite where two points say nothing of it.
    pub fn variance(&self) -> f64 {
        if self.count > 2 { self.squares / self.degrees() } else { f64::INFINITY }
    }

    /// Variance of the ordinate of the line at `x` over that of a point.
    pub fn weight_at(&self, x: f64) -> f64 {
        1.0 / self.count as f64 + (x - self.mean_x) * (x - self.mean_x) / self.spread
    }

    /// Student's quantile of the line; infinite without a degree of freedom.
    pub fn quantile(&self, confidence: Confidence) -> f64 {
        if self.count > 2 { student(self.degrees(), confidence) } else { f64::INFINITY }
    }

    fn estimate(&self, value: f64, weight: f64, confidence: Confidence) -> Estimate {
        let half = if self.count > 2 { self.quantile(confidence) * (self.variance() * weight).sqrt() } else { f64::INFINITY };
        Estimate { value, interval: Interval { low: value - half, high: value + half } }
    }

    /// The slope with its interval.
    pub fn slope_estimate(&self, confidence: Confidence) -> Estimate {
        self.estimate(self.slope, 1.0 / self.spread, confidence)
    }

    /// The ordinate of the line at `x` with its interval.
    pub fn estimate_at(&self, x: f64, confidence: Confidence) -> Estimate {
        self.estimate(self.at(x), self.weight_at(x), confidence)
    }

    /// Intercept over slope, the distance from the origin back to where the line is zero, with Fieller's interval; without one where the
    /// slope may be zero.
    pub fn intercept_over_slope(&self, confidence: Confidence) -> (f64, Option<Interval>) {
        let v = self.variance();
        let covariance = [v * self.weight_at(0.0), -v * self.mean_x / self.spread, v / self.spread];
        let value = self.intercept() / self.slope;
        (value, fieller(self.intercept(), self.slope, covariance, self.quantile(confidence)))
    }
}

/// Interval of the ratio of two normal estimates with the covariances `[Var n, Cov(n, d), Var d]`, for Student's quantile `t` of their
/// variance; absent where the denominator does not differ from zero, as the ratio then has no interval.
///
/// E. C. Fieller, "Some problems in interval estimation", J. Royal Statistical Society B 16(2), 175–185, 1954: all ρ for which `n − ρ d`
/// does not differ from zero.
pub fn fieller(numerator: f64, denominator: f64, [nn, nd, dd]: [f64; 3], t: f64) -> Option<Interval> {
    let square = t * t;
    let a = denominator * denominator - square * dd;
    let b = numerator * denominator - square * nd;
    let c = numerator * numerator - square * nn;
    // a is NaN where a variance is infinite.
    if a.is_nan() || a <= 0.0 {
        return None;
    }
    let root = (b * b - a * c).max(0.0).sqrt();
    Some(Interval { low: (b - root) / a, high: (b + root) / a })
}

/// Two lines, one behind the other, through points in the order of their abscissae.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoLines {
    /// The lines.
    pub lines: [Line; 2],
    /// Number of points before the second line; those of them beyond the first line's belong to neither.
    pub second_from: usize,
    /// Abscissae between which the law changes, of every partition that the points do not reject.
    pub bracket: [f64; 2],
}

/// What lies between two lines in a search for them.
#[derive(Clone, Copy)]
struct Partition {
    first_to: usize,
    second_from: usize,
    squares: f64,
}

/// Least points of a line, on at least two abscissae.
const LEAST: usize = 3;
/// Chance that points that belong to one of the lines are taken for none of them, or one line for two.
const FALSE_ALARM: f64 = 0.01;

/// What a search for two lines found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Broken {
    /// One line explains the points as well.
    One(Line),
    /// Two lines.
    Two(TwoLines),
}

/// One line or two, by least squares over all partitions: which points belong to which line is found, and points between the lines that
/// belong to neither, at most a quarter of all, are left out if that explains the others significantly better. `points` are in the order of their abscissae; absent if
/// there are too few for a line.
///
/// Two lines are tested against one, and points that are left out against none, by the ratio of the residuals' squares with Fisher's
/// quantile at 1 % over the number of partitions tried (Bonferroni). The bracket holds every partition with
/// `S/S_min ≤ 1 + F(1, ν)/ν` at the confidence; G. A. F. Seber & C. J. Wild, "Nonlinear Regression", section 9.3 has the problem.
pub fn broken_line(points: &[[f64; 2]], confidence: Confidence) -> Option<Broken> {
    let n = points.len();
    let whole = Line::through(points)?;
    if n < 2 * LEAST {
        return (n >= LEAST).then_some(Broken::One(whole));
    }
    let lines = Fits::of(points);
    let most = (n - 2 * LEAST).min(n / 4);
    let tried: usize = (0..=most).map(|out| n - 2 * LEAST - out + 1).sum();
    // Squares that rounding leaves of points without scatter.
    let size = points.iter().fold(0.0_f64, |m, p| m.max(p[1].abs()));
    let floor = n as f64 * (16.0 * f64::EPSILON * size) * (16.0 * f64::EPSILON * size);
    let mut best: Option<(usize, Partition)> = None;
    for out in 0..=most {
        let found = lines.partitions(points, out);
        let Some(least) = found.iter().copied().min_by(|a, b| a.squares.total_cmp(&b.squares)) else { continue };
        let degrees = (n - out) as f64 - 4.0;
        let Some((fewer, before)) = best else {
            best = Some((out, least));
            continue;
        };
        if significant([before.squares, least.squares, floor], [(out - fewer) as f64, degrees], tried) {
            best = Some((out, least));
        }
    }
    // Points of so few abscissae that none separates enough of them.
    let Some((out, least)) = best else { return Some(Broken::One(whole)) };
    // Slopes, ordinates and the place of the change are three more numbers than one line has, those left out one each.
    let all = lines.partitions(points, out);
    let degrees = (n - out) as f64 - 4.0;
    if !significant([whole.squares, least.squares, floor], [3.0 + out as f64, degrees], tried) {
        return Some(Broken::One(whole));
    }
    let limit = least.squares.max(floor) * (1.0 + fisher(1.0, degrees, confidence) / degrees);
    let kept = all.iter().filter(|p| p.squares <= limit);
    let bracket = kept.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| {
        [low.min(points[p.first_to - 1][0]), high.max(points[p.second_from][0])]
    });
    let two = [lines.first[least.first_to]?, lines.second[least.second_from]?];
    Some(Broken::Two(TwoLines { lines: two, second_from: least.second_from, bracket }))
}

/// Whether more parameters explain the points better than chance would, over the number of places tried: squares before and after, and
/// those that rounding leaves.
fn significant([before, after, floor]: [f64; 3], [more, degrees]: [f64; 2], tried: usize) -> bool {
    let after = after.max(floor);
    if degrees < 1.0 || before <= after {
        return false;
    }
    let Some(confidence) = Confidence::new(1.0 - FALSE_ALARM / tried.max(1) as f64) else { return false };
    before - after > fisher(more, degrees, confidence) * more * after / degrees
}

/// The lines through the first points and through the last ones.
struct Fits {
    first: Vec<Option<Line>>,
    second: Vec<Option<Line>>,
}

impl Fits {
    fn of(points: &[[f64; 2]]) -> Self {
        let n = points.len();
        let line = |part: &[[f64; 2]]| if part.len() >= LEAST { Line::through(part) } else { None };
        Self { first: (0..=n).map(|i| line(&points[..i])).collect(), second: (0..=n).map(|i| line(&points[i..])).collect() }
    }

    /// All partitions with so many points left out; points of one abscissa stay together.
    fn partitions(&self, points: &[[f64; 2]], out: usize) -> Vec<Partition> {
        let n = points.len();
        let ends = |i: usize| points[i - 1][0] < points[i][0];
        (LEAST..=n - LEAST - out)
            .filter_map(|first_to| {
                let second_from = first_to + out;
                let squares = self.first[first_to]?.squares + self.second[second_from]?.squares;
                (ends(first_to) && ends(second_from)).then_some(Partition { first_to, second_from, squares })
            })
            .collect()
    }
}

impl TwoLines {
    /// Number of points of the first line.
    pub fn first_to(&self) -> usize {
        self.lines[0].count
    }

    /// How far the second line lies above the first at `x`, with the interval of Welch's difference: each line has a scatter of its own.
    pub fn step_at(&self, x: f64, confidence: Confidence) -> Estimate {
        let [one, two] = &self.lines;
        let value = two.at(x) - one.at(x);
        let half = self.welch(x, confidence) * self.lines.iter().map(|l| l.variance() * l.weight_at(x)).sum::<f64>().sqrt();
        Estimate { value, interval: Interval { low: value - half, high: value + half } }
    }

    /// Where the lines cross, with Fieller's interval; without one where they may be parallel.
    pub fn crossing(&self, confidence: Confidence) -> (f64, Option<Interval>) {
        let [one, two] = &self.lines;
        let (numerator, denominator) = (two.intercept() - one.intercept(), one.slope - two.slope);
        let x = numerator / denominator;
        let sum = |f: &dyn Fn(&Line) -> f64| self.lines.iter().map(|l| l.variance() * f(l)).sum::<f64>();
        let covariance = [sum(&|l| l.weight_at(0.0)), sum(&|l| l.mean_x / l.spread), sum(&|l| 1.0 / l.spread)];
        (x, fieller(numerator, denominator, covariance, self.welch(x, confidence)))
    }

    /// Ordinate where the lines cross, with the interval of the delta method; without one where they may be parallel.
    pub fn crossing_ordinate(&self, confidence: Confidence) -> (f64, Option<Interval>) {
        let [one, two] = &self.lines;
        let (x, range) = self.crossing(confidence);
        let value = one.at(x);
        // y = (a₂ b₁ − a₁ b₂)/(b₁ − b₂): the error of a line counts with the other's slope, at x.
        let gap = one.slope - two.slope;
        let parts = [(one, two.slope / gap), (two, one.slope / gap)].map(|(l, share)| share * share * l.variance() * l.weight_at(x));
        let half = satterthwaite(&parts, &self.lines, confidence) * (parts[0] + parts[1]).sqrt();
        (value, range.map(|_| Interval { low: value - half, high: value + half }))
    }

    /// Student's quantile of the difference of the lines at `x`.
    fn welch(&self, x: f64, confidence: Confidence) -> f64 {
        satterthwaite(&self.lines.map(|l| l.variance() * l.weight_at(x)), &self.lines, confidence)
    }
}

/// Student's quantile of a sum of two variances with degrees of their own: B. L. Welch, "The generalization of 'Student's' problem when
/// several different population variances are involved", Biometrika 34, 28–35, 1947.
fn satterthwaite(parts: &[f64; 2], lines: &[Line; 2], confidence: Confidence) -> f64 {
    let whole = parts[0] + parts[1];
    let degrees = whole * whole / (parts[0] * parts[0] / lines[0].degrees() + parts[1] * parts[1] / lines[1].degrees());
    if degrees.is_finite() && degrees > 0.0 {
        student(degrees, confidence)
    } else {
        student(lines[0].degrees().min(lines[1].degrees()), confidence)
    }
}

#[cfg(test)]
mod tests;
