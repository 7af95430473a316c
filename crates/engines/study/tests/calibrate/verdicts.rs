//! How often something is called unexplained: in good measurements, in bent ones, and from how many points on.

use forcewright_base::maths::powi;
use forcewright_study::calibrate::{Against, CalibrateError, Fit, Limits, Loss, Measured, Plan, SignTest, fit};
use num_dual::{Dual64, DualNum};

use super::common::{Formula, Noise, fitted, free};

const REPETITIONS: u64 = 2000;
/// Chance of a false alarm that is claimed of both tests together.
const CLAIMED: f64 = 0.01;

fn plan(accuracy: f64) -> Plan {
    Plan { profiles: false, accuracy, loss: Loss::Squares, ..Plan::default() }
}

fn places(n: u32) -> Vec<f64> {
    (0..n).map(|i| f64::from(i) / f64::from(n - 1)).collect()
}

/// Alarms among good measurements, and how many of them were judged.
fn alarms<F>(x: &[f64], truth: &[f64], of: F, sigma: f64, rows: impl Fn(&[f64]) -> Vec<f64>) -> (f64, bool)
where
    F: Fn(f64, &[Dual64]) -> Dual64 + Sync + Copy,
{
    let at = rows(x);
    let model = Formula { x: at.clone(), of };
    let start: Vec<_> = truth.iter().map(|v| free(*v)).collect();
    let dual: Vec<Dual64> = truth.iter().map(|v| Dual64::from(*v)).collect();
    let (mut count, mut judged) = (0.0, true);
    let mut noise = Noise(77);
    for _ in 0..REPETITIONS {
        let y: Vec<f64> = x.iter().map(|x| of(*x, &dual).re + sigma * noise.normal()).collect();
        let residuals = fitted(&model, &start, &at, &rows(&y), &plan(0.0)).residuals;
        count += f64::from(u8::from(residuals.unexplained));
        judged &= residuals.judged;
    }
    (count, judged)
}

fn line(x: f64, p: &[Dual64]) -> Dual64 {
    p[0] + p[1] * x
}

/// Most alarms that chance makes of those that are claimed, three standard deviations away.
fn most() -> f64 {
    let mean = CLAIMED * REPETITIONS as f64;
    mean + 3.0 * (mean * (1.0 - CLAIMED)).sqrt()
}

/// Of normal errors the ratio of a line has Fisher's distribution, however few points: about half of what is claimed alarms. Six points are
/// too few to judge, the others are not.
#[test]
fn good_measurements_are_seldom_called_unexplained() {
    let decay = |x: f64, p: &[Dual64]| p[0] * (-p[1] * x).exp();
    for n in [6, 10, 20, 60] {
        let (straight, judged) = alarms(&places(n), &[1.0, 2.0], line, 0.1, <[f64]>::to_vec);
        let (bent, _) = alarms(&places(n), &[5.0, 1.5], decay, 0.1, <[f64]>::to_vec);
        println!("{n} points: {straight} of a line, {bent} of an exponential");
        assert!((1.0..=most()).contains(&straight) && bent <= most(), "{n}: {straight} {bent}, at most {}", most());
        assert_eq!(judged, n > 6, "{n}");
    }
}

/// Through the origin nothing holds the mean of the residuals at zero: the sign test is at its own.
#[test]
fn good_measurements_of_a_bound_parameter_are_seldom_called_unexplained() {
    for n in [10, 20, 60] {
        let (count, _) = alarms(&places(n), &[2.0], |x, p| p[0] * x, 0.1, <[f64]>::to_vec);
        println!("{n} points: {count} through the origin");
        assert!(count <= most(), "{n}: {count}");
    }
}

/// Part of the repetitions in which a bend whose middle is so many standard deviations from its chord is found, fitted with a line.
fn found(n: u32, sagitta: f64) -> f64 {
    let (x, mut noise) = (places(n), Noise(5));
    let model = Formula { x: x.clone(), of: line };
    let count = (0..500)
        .filter(|_| {
            let y: Vec<f64> = x.iter().map(|x| 1.0 + 2.0 * x + 4.0 * sagitta * x * (1.0 - x) + noise.normal()).collect();
            fitted(&model, &[free(1.0), free(2.0)], &x, &y, &plan(0.0)).residuals.unexplained
        })
        .count();
    count as f64 / 500.0
}

/// What is not found at 10 points is found at 20; what is five standard deviations of a point large, nearly always.
#[test]
fn bends_are_found() {
    let parts = [10, 20, 60].map(|n| [3.0, 5.0, 8.0].map(|sagitta| found(n, sagitta)));
    println!("{parts:?}");
    let [few, some, many] = parts;
    assert!(few[1] > 0.5 && few[2] > 0.95, "{few:?}");
    assert!(some[1] > 0.9 && some[2] > 0.999, "{some:?}");
    assert!(many[0] > 0.9 && many[1] > 0.999, "{many:?}");
}

/// A mean that can not move from zero, so that the signs of the residuals are those of what was measured.
fn held(y: &[f64]) -> Fit {
    let x = places(u32::try_from(y.len()).expect("few points"));
    let mut mean = free(0.0);
    mean.limits = Limits { lower: -1e-12, upper: 1e-12 };
    fitted(&Formula { x: x.clone(), of: |_: f64, p: &[Dual64]| p[0] }, &[mean], &x, y, &plan(1e-4))
}

/// All points lie on one side of a curve that a bound holds: the sign test, 2·2⁻ⁿ, and the size is the distance.
#[test]
fn what_lies_on_one_side_is_not_explained() {
    let mut noise = Noise(9);
    let y: Vec<f64> = (0..20).map(|_| 0.5 + 0.05 * noise.normal()).collect();
    let all = held(&y).residuals;
    assert!(all.unexplained && all.judged && (all.runs.p / (2.0 * powi(0.5, 20)) - 1.0).abs() < 1e-12, "{:?}", all.runs);
    assert!(all.runs.test == SignTest::Side && all.runs.sides == [20, 0], "{:?}", all.runs);
    let mean = y.iter().sum::<f64>() / 20.0;
    assert!((all.systematic - mean).abs() < 1e-9 && (all.scatter / 0.05 - 1.0).abs() < 0.4, "{} {}", all.systematic, all.scatter);
    let stretch = all.stretch.expect("a stretch");
    assert!(stretch.points == 20 && (stretch.mean - mean).abs() < 1e-9, "{stretch:?}");
    // One of ten on the other side: (1 + 10)·2/2¹⁰, no alarm.
    let signs: Vec<f64> = (0..10).map(|i| if i == 4 { -0.5 } else { 0.5 + 0.01 * f64::from(i % 3) }).collect();
    let one = held(&signs).residuals;
    assert!((one.runs.p - 22.0 / 1024.0).abs() < 1e-15, "{:?}", one.runs);
}

/// Probabilities of runs against all arrangements of 4 and 7 signs, counted.
#[test]
fn runs_have_the_probabilities_of_all_arrangements() {
    let mut counts = [0.0; 12];
    let runs = |bits: u32| 1 + (1..11).filter(|i| (bits >> i) & 1 != (bits >> (i - 1)) & 1).count();
    let arrangements: Vec<u32> = (0..1 << 11).filter(|bits: &u32| bits.count_ones() == 4).collect();
    for bits in &arrangements {
        counts[runs(*bits)] += 1.0;
    }
    for bits in arrangements.iter().step_by(7) {
        let y: Vec<f64> = (0..11).map(|i| if (bits >> i) & 1 == 1 { 1.0 } else { -1.0 }).collect();
        let got = held(&y).residuals.runs;
        let want = counts[..=runs(*bits)].iter().sum::<f64>() / arrangements.len() as f64;
        assert!(got.observed == runs(*bits) && (got.p - want).abs() < 1e-12, "{got:?} {want}");
        let want = counts[runs(*bits)..].iter().sum::<f64>() / arrangements.len() as f64;
        assert!(got.test == SignTest::Runs && got.sides == [4, 7] && (got.p_many - want).abs() < 1e-12, "{got:?} {want}");
        assert!((got.expected - (1.0 + 2.0 * 28.0 / 11.0)).abs() < 1e-12);
    }
}

/// Rows that are there three times are no repeats: the tests are those of one of each, and alarm as seldom.
#[test]
fn copied_rows_are_one_measurement() {
    let thrice = |v: &[f64]| -> Vec<f64> { v.iter().flat_map(|v| [*v, v * (1.0 + 1e-15), *v]).collect() };
    let x = places(24);
    let mut noise = Noise(31);
    let y: Vec<f64> = x.iter().map(|x| 1.0 + 2.0 * x + 0.5 * x * x + 0.05 * noise.normal()).collect();
    let of = |x: &[f64], y: &[f64]| fitted(&Formula { x: x.to_vec(), of: line }, &[free(1.0), free(2.0)], x, y, &plan(1e-4)).residuals;
    let (single, copied) = (of(&x, &y), of(&thrice(&x), &thrice(&y)));
    let (one, three) = (single.lack.expect("enough points"), copied.lack.expect("enough points"));
    assert!(three.against == Against::Smooth && (three.p / one.p - 1.0).abs() < 1e-6, "{one:?} {three:?}");
    assert_eq!((single.runs, single.judged), (copied.runs, copied.judged));
    let (count, _) = alarms(&places(20), &[1.0, 2.0], line, 0.1, thrice);
    println!("{count} of copied rows");
    assert!(count <= most(), "{count}");
}

/// Repeats that agree better than the model is right: its accuracy is their scatter. Means ±1.2 accuracies from the line, twelve places twice.
#[test]
fn repeats_that_agree_too_well_scatter_by_the_accuracy() {
    let x: Vec<f64> = (0..24).map(|i| f64::from(i / 2)).collect();
    let y: Vec<f64> = (0..24)
        .map(|i: i32| {
            let place = i / 2;
            let side = if (place % 4 == 0) || (place % 4 == 3) { 1.2e-3 } else { -1.2e-3 };
            10.0 + side + if i % 2 == 0 { 1e-6 } else { -1e-6 }
        })
        .collect();
    let residuals = fitted(&Formula { x: x.clone(), of: line }, &[free(10.0), free(1e-3)], &x, &y, &plan(1e-4)).residuals;
    let lack = residuals.lack.expect("repeats");
    // Ten degrees of freedom of twelve means and a line; the accuracy is 10⁻⁴ of 10.0012.
    let explained: f64 = residuals.values.chunks_exact(2).map(|pair| 0.5 * (pair[0] + pair[1]) * (pair[0] + pair[1])).sum();
    let want = explained / 10.0 / powi(1e-4 * (10.0012 + 1e-6), 2);
    assert!(lack.against == Against::Repeats && (lack.ratio / want - 1.0).abs() < 1e-9, "{lack:?} {want}");
    assert!(lack.p > 0.005 && !residuals.unexplained, "{residuals:?}");
}

/// Branches of five points have no smooth curve through their residuals: from how many on the order alone is a judgement.
#[test]
fn short_branches_are_judged_by_their_order() {
    let mut noise = Noise(13);
    for (branches, judged) in [(2, false), (4, true)] {
        let x: Vec<f64> = (0..5 * branches).map(|i| f64::from(i % 5)).collect();
        let model = Formula { x: x.clone(), of: line };
        let y: Vec<f64> = x.iter().map(|x| 1.0 + 2.0 * x + 0.1 * noise.normal()).collect();
        let counts = vec![5; usize::try_from(branches).expect("few")];
        let measured = Measured { x: &x, y: &y, raw: &y, branches: &counts };
        let found = fit(&model, &[free(1.0), free(2.0)], measured, &plan(0.0), &mut |_| true).expect("a fit").residuals;
        assert!(found.lack.is_none() && found.judged == judged && !found.unexplained, "{found:?}");
    }
}

/// Thirteen points at one place or at two, or as many as parameters can fit, show no shape: there is nothing to judge. Drift is found there
/// all the same.
#[test]
fn few_places_are_not_judged() {
    let slope = |x: f64, p: &[Dual64]| p[0] * x;
    let at = |places: usize, drift: f64| {
        let x: Vec<f64> = (0..39).map(|i| 5.0 + (i % places) as f64).collect();
        let mut noise = Noise(3);
        let y: Vec<f64> = x.iter().enumerate().map(|(i, x)| 2.0 * x + drift * i as f64 + 0.1 * noise.normal()).collect();
        fitted(&Formula { x: x.clone(), of: slope }, &[free(1.0)], &x, &y, &plan(1e-4)).residuals
    };
    for (places, judged) in [(1, false), (2, false), (3, false), (4, true), (13, true)] {
        let found = at(places, 0.0);
        assert!(found.places == places && found.judged == judged && !found.unexplained, "{places}: {found:?}");
    }
    let drifting = at(1, 0.05);
    assert!(drifting.unexplained && drifting.judged && !drifting.alternates, "{drifting:?}");
}

/// Two curves row by row alternate about the one that is fitted: told, with half their distance, though few runs and a large ratio are far
/// away. So are two curves that were each measured twice at every place, whose signs do not alternate but whose means lie too well.
#[test]
fn two_curves_in_one_file_alternate() {
    let mut noise = Noise(17);
    let x = places(44);
    let model = |x: &[f64]| Formula { x: x.to_vec(), of: line };
    let y: Vec<f64> =
        x.iter().enumerate().map(|(i, x)| 1.0 + 2.0 * x + if i % 2 == 0 { 0.3 } else { -0.3 } + 0.05 * noise.normal()).collect();
    let found = fitted(&model(&x), &[free(1.0), free(2.0)], &x, &y, &plan(1e-4)).residuals;
    assert!(found.unexplained && found.alternates && found.stretch.is_none(), "{found:?}");
    assert!(found.runs.observed > 40 && found.runs.p > 0.999 && found.runs.p_many < 1e-6, "{:?}", found.runs);
    assert!((found.systematic / 0.3 - 1.0).abs() < 0.1 && (0.01..0.15).contains(&found.scatter), "{} {}", found.systematic, found.scatter);
    let x: Vec<f64> = (0..60).map(|i| f64::from(i / 4)).collect();
    let y: Vec<f64> =
        x.iter().enumerate().map(|(i, x)| 1.0 + 2.0 * x + if i % 4 < 2 { 0.3 } else { -0.3 } + 0.02 * noise.normal()).collect();
    let found = fitted(&model(&x), &[free(1.0), free(2.0)], &x, &y, &plan(1e-4)).residuals;
    let lack = found.lack.expect("repeats");
    assert!(lack.against == Against::Repeats && lack.p > 0.99 && lack.p_small < 0.0002 && found.runs.p_many > 0.01, "{found:?}");
    assert!(found.unexplained && found.alternates && (found.systematic / 0.3 - 1.0).abs() < 0.2, "{found:?}");
}

/// Good measurements seldom have a point that is called far off, and one that is ten scatters off is found, nearly always alone, also at
/// the end of a line, which it draws to itself.
#[test]
fn far_points_are_found_and_good_ones_are_not() {
    let far = |n: u32, at: usize, by: f64| -> Vec<Vec<usize>> {
        let (x, mut noise) = (places(n), Noise(23));
        let model = Formula { x: x.clone(), of: line };
        let one = |_| {
            let mut y: Vec<f64> = x.iter().map(|x| 1.0 + 2.0 * x + noise.normal()).collect();
            y[at] += by;
            fitted(&model, &[free(1.0), free(2.0)], &x, &y, &plan(1e-6)).residuals.far
        };
        (0..1000).map(one).collect()
    };
    for (n, least) in [(8, 0.2), (12, 0.6), (20, 0.9), (60, 0.97), (300, 0.97)] {
        let good = far(n, 0, 0.0).iter().filter(|f| !f.is_empty()).count();
        let [end, middle] = [0, n as usize / 2].map(|at| far(n, at, 10.0).iter().filter(|f| **f == [at]).count() as f64 / 1000.0);
        println!("{n} points: {good} of 1000 good ones, {end} and {middle} found alone");
        assert!(good <= 20 && middle > least, "{n}: {good} {end} {middle}");
    }
    // A loss that plays far points down has weights for them.
    let x = places(20);
    let y: Vec<f64> =
        x.iter().enumerate().map(|(i, x)| 2.0 * x + if i == 7 { 5.0 } else { 0.01 * f64::from(u8::from(i % 3 == 0)) }).collect();
    let of =
        |loss| fitted(&Formula { x: x.clone(), of: line }, &[free(1.0), free(2.0)], &x, &y, &Plan { loss, ..plan(1e-6) }).residuals.far;
    assert!(of(Loss::Squares) == [7] && of(Loss::Tukey).is_empty());
}

/// A row that is there four times is one: nothing is known of its scatter.
#[test]
fn one_row_many_times_is_no_measurement() {
    let (x, y) = ([1.0; 4], [2.0; 4]);
    let measured = Measured { x: &x, y: &y, raw: &y, branches: &[4] };
    let model = Formula { x: x.to_vec(), of: |x: f64, p: &[Dual64]| p[0] * x };
    let found = fit(&model, &[free(1.0)], measured, &plan(1e-4), &mut |_| true);
    assert!(matches!(found, Err(CalibrateError::TooFew { points: 1, parameters: 1 })), "{found:?}");
}
