//! Bounds, priors, far points, what cannot be told apart, and what no parameter explains.

use forcewright_study::calibrate::{Against, Bound, CalibrateError, Limits, Loss, Measured, Plan, Prior, Progress, Stop, fit};
use num_dual::{Dual64, DualNum};

use super::common::{Formula, Noise, fitted, free};

fn places(n: usize) -> Vec<f64> {
    (0..n).map(|i| 3.0 * i as f64 / (n - 1) as f64).collect()
}

/// H. H. Rosenbrock's valley as residuals 10 (x₂ − x₁²) and 1 − x₁, with three points more that say nothing; from the usual start and with
/// a bound across the valley, where the optimum is (½, ¼).
#[test]
fn a_curved_valley_with_and_without_a_bound() {
    let model = Formula {
        x: vec![0.0, 1.0, 2.0, 3.0, 4.0],
        of: |x: f64, p: &[Dual64]| {
            if x < 0.5 {
                (p[1] - p[0] * p[0]) * 10.0
            } else if x < 1.5 {
                -p[0] + 1.0
            } else {
                Dual64::from(0.0)
            }
        },
    };
    let y = [0.0; 5];
    let found = fitted(&model, &[free(-1.2), free(1.0)], &model.x, &y, &Plan { profiles: false, ..Plan::default() });
    assert!(found.parameters.iter().all(|p| (p.estimate.value - 1.0).abs() < 1e-9) && found.stop == Stop::Converged, "{found:?}");
    let mut bounded = [free(-1.2), free(1.0)];
    bounded[0].limits = Limits { lower: -2.0, upper: 0.5 };
    let found = fitted(&model, &bounded, &model.x, &y, &Plan::default());
    assert_eq!(found.parameters[0].at, Some(Bound::Upper));
    assert!((found.parameters[0].estimate.value - 0.5).abs() < 1e-12 && (found.parameters[1].estimate.value - 0.25).abs() < 1e-9);
    // The interval of what a bound holds ends there, and begins where the likelihood says.
    let interval = found.parameters[0].estimate.interval;
    assert!((interval.high - 0.5).abs() < 1e-12 && interval.low < 0.5 && interval.low >= -2.0);
}

/// A mean with a normal prior: the weights of both are those of the conjugate formula at the noise found.
#[test]
fn a_prior_counts_by_its_width() {
    let mut noise = Noise(5);
    let y: Vec<f64> = (0..20).map(|_| 4.0 + 0.5 * noise.normal()).collect();
    let model = Formula { x: places(20), of: |_: f64, p: &[Dual64]| p[0] };
    let mut mean = free(1.0);
    mean.prior = Some(Prior { mean: 3.0, sd: 0.2 });
    let found = fitted(&model, &[mean.clone()], &model.x, &y, &Plan::default());
    let s2 = found.noise * found.noise;
    let (own, held) = (20.0 / s2, 1.0 / 0.04);
    let want = (own * y.iter().sum::<f64>() / 20.0 + held * 3.0) / (own + held);
    assert!((found.parameters[0].estimate.value - want).abs() < 1e-6, "{} {want}", found.parameters[0].estimate.value);
    assert!((found.parameters[0].error - forcewright_base::maths::powf(own + held, -0.5)).abs() < 1e-7);
    assert!((found.degrees - (20.0 - own / (own + held))).abs() < 1e-5);
    // Without points that speak for another value, the prior is the answer, and it is said.
    let silent = Formula { x: places(20), of: |x: f64, p: &[Dual64]| p[0] * 1e-9 + x };
    let y: Vec<f64> = silent.x.iter().map(|x| x + 0.1 * noise.normal()).collect();
    let found = fitted(&silent, &[mean], &silent.x, &y, &Plan::default());
    assert!((found.parameters[0].estimate.value - 3.0).abs() < 1e-6 && (found.parameters[0].error - 0.2).abs() < 1e-6);
    assert_eq!(found.identified.on_priors, [0]);
}

/// One point in ten lies far away: squares are led astray, the robust losses are not.
#[test]
fn far_points_lead_only_squares_astray() {
    let x = places(80);
    let model = Formula { x: x.clone(), of: |x: f64, p: &[Dual64]| p[0] + p[1] * x };
    let mut noise = Noise(11);
    let y: Vec<f64> =
        x.iter().enumerate().map(|(i, x)| 1.0 + 2.0 * x + 0.1 * noise.normal() + if i % 10 == 3 { 5.0 } else { 0.0 }).collect();
    let off = |loss: Loss| {
        let found = fitted(&model, &[free(1.0), free(1.0)], &x, &y, &Plan { loss, ..Plan::default() });
        (found.parameters[0].estimate.value - 1.0, found.noise, found.parameters[0].estimate.interval.contains(1.0))
    };
    assert!(off(Loss::Squares).0.abs() > 0.3 && off(Loss::Squares).1 > 1.0);
    for loss in [Loss::Huber, Loss::SoftL1] {
        assert!(off(loss).0.abs() < 0.1, "{loss:?} {:?}", off(loss));
    }
    let (away, scatter, contains) = off(Loss::Tukey);
    assert!(away.abs() < 0.05 && (scatter / 0.1 - 1.0).abs() < 0.25 && contains, "{away} {scatter}");
}

/// A product is determined, its factors are not: the warning names both, with changes that cancel. A prior on one settles it.
#[test]
fn a_product_does_not_tell_its_factors() {
    let x = places(50);
    let model = Formula { x: x.clone(), of: |x: f64, p: &[Dual64]| p[0] * p[1] * x + p[2] };
    let mut noise = Noise(3);
    let y: Vec<f64> = x.iter().map(|x| 6.0 * x + 1.0 + 0.05 * noise.normal()).collect();
    let mut all = [free(2.0), free(3.2), free(1.0)];
    let found = fitted(&model, &all, &x, &y, &Plan::default());
    let [loose] = &found.identified.loose[..] else { panic!("{:?}", found.identified) };
    let [(0, a), (1, b)] = loose.changes[..] else { panic!("{loose:?}") };
    let [p, q] = [0, 1].map(|i| found.parameters[i].estimate.value);
    assert!((a / p + b / q).abs() < 1e-6 * (a / p).abs() && loose.deviation.is_infinite());
    assert!(found.parameters[..2].iter().all(|p| p.error.is_infinite() && p.estimate.interval.high.is_infinite()));
    assert!(found.parameters[2].error < 0.05 && (p * q - 6.0).abs() < 0.05 && found.curve_error.iter().all(|e| *e < 0.05 && *e > 0.0));
    // The likelihood says the same without tangents.
    assert!(found.parameters[0].profile.is_some_and(|i| i.high.is_infinite()));
    all[0].prior = Some(Prior { mean: 2.0, sd: 0.01 });
    let settled = fitted(&model, &all, &x, &y, &Plan::default());
    assert!((settled.parameters[0].estimate.value - 2.0).abs() < 1e-3 && settled.parameters[1].error < 0.05);
    // The measurement alone still does not tell, and that is said.
    assert!(settled.identified.loose.len() == 1 && settled.identified.on_priors == [0]);
}

/// A bump that the model does not have: it is found, with its place and about its size, whatever the parameters do.
#[test]
fn what_no_parameter_explains_is_named_with_its_place() {
    let x = places(120);
    let model = Formula { x: x.clone(), of: |x: f64, p: &[Dual64]| p[0] + p[1] * x };
    let bump = |x: f64| if (1.8..2.1).contains(&x) { 0.6 } else { 0.0 };
    let mut noise = Noise(8);
    let y: Vec<f64> = x.iter().map(|x| 1.0 + 2.0 * x + bump(*x) + 0.1 * noise.normal()).collect();
    let found = fitted(&model, &[free(1.0), free(1.0)], &x, &y, &Plan::default());
    let stretch = found.residuals.stretch.unwrap();
    assert!(found.residuals.unexplained && found.residuals.lack.unwrap().against == Against::Smooth);
    assert!((stretch.from - 1.8).abs() < 0.1 && (stretch.to - 2.1).abs() < 0.1 && (stretch.mean - 0.6).abs() < 0.15, "{stretch:?}");
    assert!((found.residuals.scatter / 0.1 - 1.0).abs() < 0.3 && found.residuals.autocorrelation > 0.3);
    // Nothing is called unexplained that is smaller than the model is wrong by.
    let coarse = fitted(&model, &[free(1.0), free(1.0)], &x, &y, &Plan { accuracy: 0.1, ..Plan::default() });
    assert!(!coarse.residuals.unexplained);
}

/// Points measured again say what the scatter is: a curve through a bent line shows its lack of fit against them.
#[test]
fn repeats_are_believed() {
    let x: Vec<f64> = (0..60).map(|i| f64::from(i / 5)).collect();
    let model = Formula { x: x.clone(), of: |x: f64, p: &[Dual64]| p[0] + p[1] * x };
    let mut noise = Noise(4);
    let mut measured = |bend: f64| -> Vec<f64> { x.iter().map(|x| 1.0 + x + bend * x * x + 0.2 * noise.normal()).collect() };
    let (straight, bent) = (measured(0.0), measured(0.03));
    let [good, bad] = [straight, bent].map(|y| fitted(&model, &[free(1.0), free(1.0)], &x, &y, &Plan::default()).residuals);
    let (good_lack, bad_lack) = (good.lack.unwrap(), bad.lack.unwrap());
    assert!(bad_lack.against == Against::Repeats && (bad_lack.degrees[0] - 10.0).abs() < 1e-9 && (bad_lack.degrees[1] - 48.0).abs() < 1e-9);
    assert!(bad.unexplained && bad_lack.p < 1e-4 && !good.unexplained && good_lack.p > 0.005);
}

/// Told to stop while it looks for intervals, it keeps estimates and Student's intervals; told to stop at once, the start.
#[test]
fn a_stop_keeps_what_is_there() {
    let x = places(40);
    let model = Formula { x: x.clone(), of: |x: f64, p: &[Dual64]| p[0] * (-p[1] * x).exp() };
    let mut noise = Noise(17);
    let y: Vec<f64> = x.iter().map(|x| 5.0 * forcewright_base::maths::exp(-0.8 * x) + 0.1 * noise.normal()).collect();
    let run = |on: &mut (dyn FnMut(Progress) -> bool + Send)| {
        let measured = Measured { x: &x, y: &y, raw: &y, branches: &[40] };
        fit(&model, &[free(4.0), free(1.0)], measured, &Plan::default(), on).expect("a fit")
    };
    let mut ends = Vec::new();
    let whole = run(&mut |p| {
        if let Progress::Intervals { found, of } = p {
            ends.push((found, of));
        }
        true
    });
    assert!(whole.stop == Stop::Converged && whole.parameters.iter().all(|p| p.profile.is_some()));
    assert!(ends.windows(2).all(|w| w[0].0 <= w[1].0) && ends.last() == Some(&(4, 4)), "{ends:?}");
    let part = run(&mut |p| matches!(p, Progress::Search { .. }));
    assert!(part.stop == Stop::Interrupted && part.parameters.iter().all(|p| p.profile.is_none()));
    assert!(part.parameters.iter().zip(&whole.parameters).all(|(a, b)| a.estimate == b.estimate && a.error.to_bits() == b.error.to_bits()));
    let none = run(&mut |_| false);
    assert!(none.stop == Stop::Interrupted && (none.parameters[0].estimate.value - 4.0).abs() < 1e-12);
}

#[test]
fn nonsense_is_refused() {
    let model = Formula { x: places(5), of: |x: f64, p: &[Dual64]| p[0] * x };
    let run = |parameters: &[_], y: &[f64]| {
        let measured = Measured { x: &model.x, y, raw: y, branches: &[5] };
        fit(&model, parameters, measured, &Plan::default(), &mut |_| true).map(|_| ())
    };
    let good = [1.0, 2.0, 3.0, 4.0, 5.0];
    assert_eq!(run(&[], &good), Err(CalibrateError::NoParameter));
    assert!(matches!(run(&[free(1.0)], &good[..4]), Err(CalibrateError::Shape { .. })));
    assert!(matches!(run(&[free(1.0), free(1.0), free(1.0), free(1.0)], &good), Err(CalibrateError::TooFew { .. })));
    assert!(matches!(run(&[free(f64::NAN)], &good), Err(CalibrateError::Parameter { .. })));
    assert_eq!(run(&[free(1.0)], &[1.0, 2.0, f64::NAN, 4.0, 5.0]), Err(CalibrateError::NotFinite));
    assert!(run(&[free(1.0)], &good).is_ok());
}
