#![allow(clippy::unwrap_used, reason = "a test that fails")]

use super::*;
use crate::sampling::normal;

/// Normal numbers from a seed: splitmix64 and Wichura's quantile.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        normal::quantile(((z >> 11) as f64 + 0.5) / (1_u64 << 53) as f64)
    }
}

/// By hand: means 2 and 4, Sxx = 10, Sxy = 9.2, Syy = 8.72; b = 0.92; t₀.₉₇₅(3) = 3.1824.
#[test]
fn a_line_by_hand() {
    let points = [[0.0, 2.2], [1.0, 3.2], [2.0, 3.6], [3.0, 5.2], [4.0, 5.8]];
    let line = Line::through(&points).unwrap();
    assert!((line.slope - 0.92).abs() < 1e-12 && (line.intercept() - 2.16).abs() < 1e-12);
    // Residuals 0.04, 0.12, −0.40, 0.28, −0.04.
    assert!((line.squares - 0.256).abs() < 1e-12 && line.count == 5);
    let half = 3.182_446_305 * (0.256_f64 / 3.0 / 10.0).sqrt();
    let slope = line.slope_estimate(Confidence::P95);
    assert!((slope.interval.high - 0.92 - half).abs() < 1e-9 && (slope.interval.low - 0.92 + half).abs() < 1e-9);
    // At a distance of 2 from the mean: weight 1/5 + 4/10.
    let at = line.estimate_at(4.0, Confidence::P95);
    assert!((at.interval.high - 5.84 - 3.182_446_305 * (0.256_f64 / 3.0 * 0.6).sqrt()).abs() < 1e-9);
    // Turned and shifted: the line goes with its points.
    let moved: Vec<[f64; 2]> = points.iter().map(|[x, y]| [x + 100.0, 3.0 * y - 1.0]).collect();
    let moved = Line::through(&moved).unwrap();
    assert!((moved.slope - 2.76).abs() < 1e-12 && (moved.at(100.0) - 5.48).abs() < 1e-12 && (moved.squares - 9.0 * 0.256).abs() < 1e-11);
}

#[test]
fn no_line() {
    assert!(Line::through(&[]).is_none() && Line::through(&[[1.0, 2.0]]).is_none());
    assert!(Line::through(&[[0.1, 2.0], [0.1, 3.0], [0.1, 4.0]]).is_none());
    assert!(Line::through(&[[0.0, 2.0], [f64::NAN, 3.0]]).is_none() && Line::through(&[[0.0, 2.0], [1.0, f64::INFINITY]]).is_none());
    // Through two points: a line without an interval.
    let two = Line::through(&[[0.0, 2.0], [1.0, 3.0]]).unwrap();
    assert!(two.slope_estimate(Confidence::P95).interval.contains(1e300) && two.intercept_over_slope(Confidence::P95).1.is_none());
    assert!(broken_line(&[[0.0, 2.0], [1.0, 3.0]], Confidence::P95).is_none());
}

/// E. C. Fieller's set is where `(n − ρ d)² = t² Var`, and without a covariance about the ratio of a sure denominator it is Student's.
#[test]
fn ratios() {
    let found = fieller(3.0, 2.0, [0.01, 0.002, 0.04], 2.0).unwrap();
    for rho in [found.low, found.high] {
        let off: f64 = 3.0 - rho * 2.0;
        assert!((off * off - 4.0 * (0.01 - 2.0 * rho * 0.002 + rho * rho * 0.04)).abs() < 1e-12);
    }
    assert!(found.contains(1.5));
    let sure = fieller(3.0, 2.0, [0.01, 0.0, 0.0], 2.0).unwrap();
    assert!((sure.low - 1.4).abs() < 1e-12 && (sure.high - 1.6).abs() < 1e-12);
    assert!(fieller(3.0, 0.3, [0.01, 0.0, 0.04], 2.0).is_none(), "a denominator that may be zero");
}

/// Two lines that meet at x = 5.5 or step there by `step`, with scatters of their own.
fn two_lines(noise: &mut Noise, step: f64, scatter: [f64; 2]) -> Vec<[f64; 2]> {
    let line = |x: f64| if x < 5.5 { 1.0 + 2.0 * x } else { 1.0 + 11.0 + step + 0.5 * (x - 5.5) };
    (0..14).map(|i| f64::from(i) * 0.85).map(|x| [x, line(x) + scatter[usize::from(x > 5.5)] * noise.next()]).collect()
}

fn found(points: &[[f64; 2]]) -> TwoLines {
    match broken_line(points, Confidence::P95) {
        Some(Broken::Two(two)) => two,
        other => panic!("{other:?}"),
    }
}

/// Intervals contain the truth as often as they say, with the partition found and not given.
#[test]
fn coverage() {
    const RUNS: usize = 4000;
    for (step, scatter, seed) in [(0.0, [0.1, 0.1], 1), (0.0, [0.1, 0.2], 2), (1.5, [0.1, 0.15], 3)] {
        let mut noise = Noise(seed);
        let mut hits = [0_usize; 7];
        for _ in 0..RUNS {
            let two = found(&two_lines(&mut noise, step, scatter));
            let confidence = Confidence::P95;
            let inside = |(_, interval): (f64, Option<Interval>), truth: f64| interval.is_some_and(|i| i.contains(truth));
            let x = 5.5 + step / 1.5;
            let truths = [
                two.lines[0].slope_estimate(confidence).interval.contains(2.0),
                two.lines[1].slope_estimate(confidence).interval.contains(0.5),
                inside(two.lines[0].intercept_over_slope(confidence), 0.5),
                inside(two.lines[1].intercept_over_slope(confidence), 2.0 * (1.0 + 11.0 + step - 2.75)),
                inside(two.crossing(confidence), x),
                inside(two.crossing_ordinate(confidence), 1.0 + 2.0 * x),
                two.step_at(5.5, confidence).interval.contains(step),
            ];
            for (hit, is) in hits.iter_mut().zip(truths) {
                *hit += usize::from(is);
            }
        }
        let shares = hits.map(|h| h as f64 / RUNS as f64);
        assert!(shares.iter().all(|s| (0.93..=0.97).contains(s)), "step {step}: {shares:?}");
    }
}

/// The bracket holds the place of the change; one line is hardly ever taken for two; points between the lines are left out, all and only they.
#[test]
fn partitions() {
    const RUNS: usize = 1000;
    let mut noise = Noise(7);
    let (mut right, mut alarms, mut bracketed, mut left) = (0, 0, 0, 0);
    for _ in 0..RUNS {
        let one: Vec<[f64; 2]> = (0..14).map(|i| [f64::from(i), f64::from(i) + 0.1 * noise.next()]).collect();
        alarms += usize::from(matches!(broken_line(&one, Confidence::P95), Some(Broken::Two(_))));
        let met = found(&two_lines(&mut noise, 0.0, [0.1, 0.1]));
        bracketed += usize::from(met.bracket[0] <= 5.5 && 5.5 <= met.bracket[1]);
        left += usize::from(met.second_from != met.first_to());
        // The points at 5.1 and 5.95, between lines that are 1.5 apart.
        let mut points = two_lines(&mut noise, 3.0, [0.1, 0.1]);
        points[6][1] += 1.5;
        points[7][1] -= 1.2;
        let two = found(&points);
        right += usize::from(two.first_to() == 6 && two.second_from == 8);
    }
    // Those two may look like a steeper first line: 2 to 3 % do.
    assert!(
        right > RUNS * 95 / 100 && bracketed >= RUNS * 95 / 100 && alarms < RUNS / 50 && left < RUNS / 50,
        "{right} {alarms} {bracketed} {left}"
    );
}

#[test]
fn without_scatter_and_with_repeated_abscissae() {
    let points: Vec<[f64; 2]> = (0..12).map(|i| f64::from(i / 2)).map(|x| [x, if x < 3.0 { x } else { 3.0 + 0.2 * (x - 3.0) }]).collect();
    let two = found(&points);
    assert!(two.first_to().is_multiple_of(2) && two.second_from == two.first_to());
    let (x, interval) = two.crossing(Confidence::P95);
    assert!((x - 3.0).abs() < 1e-12 && interval.unwrap().high - x < 1e-9);
    assert!(matches!(broken_line(&points[..6], Confidence::P95), Some(Broken::One(_))));
    assert!(matches!(broken_line(&points[6..], Confidence::P95), Some(Broken::One(line)) if (line.slope - 0.2).abs() < 1e-12));
}
