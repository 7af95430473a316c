//! How often intervals contain the truth.

use forcewright_study::calibrate::{Loss, Plan};
use forcewright_study::sampling::{Confidence, student};
use num_dual::{Dual64, DualNum};

use super::common::{Formula, Noise, fitted, free};

const REPETITIONS: usize = 2000;

/// A straight line: estimate, error and interval are those of the textbook, to rounding.
#[test]
fn a_line_is_students() {
    let x: Vec<f64> = (0..9).map(|i| 0.3 * f64::from(i) - 0.7).collect();
    let mut noise = Noise(1);
    let y: Vec<f64> = x.iter().map(|x| 2.0 - 3.0 * x + 0.4 * noise.normal()).collect();
    let model = Formula { x: x.clone(), of: |x: f64, p: &[Dual64]| p[0] + p[1] * x };
    let found = fitted(&model, &[free(1.0), free(1.0)], &x, &y, &Plan::default());
    let n = 9.0;
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let sxx: f64 = x.iter().map(|v| forcewright_base::maths::powi(v - mx, 2)).sum();
    let slope = x.iter().zip(&y).map(|(a, b)| (a - mx) * (b - my)).sum::<f64>() / sxx;
    let rss: f64 = x.iter().zip(&y).map(|(a, b)| forcewright_base::maths::powi(b - my - slope * (a - mx), 2)).sum();
    let s = (rss / 7.0).sqrt();
    let t = student(7.0, Confidence::P95);
    let want = [(my - slope * mx, s * (1.0 / n + mx * mx / sxx).sqrt()), (slope, s / sxx.sqrt())];
    for (got, (value, error)) in found.parameters.iter().zip(want) {
        assert!((got.estimate.value - value).abs() < 1e-9 * error && (got.error - error).abs() < 1e-12);
        assert!((got.estimate.interval.high - value - t * error).abs() < 1e-9 * error);
        // Where all is linear, the likelihood says the same.
        let profile = got.profile.unwrap();
        assert!((profile.low - value + t * error).abs() < 2e-3 * error && (profile.high - value - t * error).abs() < 2e-3 * error);
    }
    assert!((found.correlations[1] + mx / (sxx / n + mx * mx).sqrt()).abs() < 1e-12);
    assert!((found.degrees - 7.0).abs() < 1e-12 && (found.noise - s).abs() < 1e-12);
    for (x, e) in x.iter().zip(&found.curve_error) {
        assert!((e - s * (1.0 / n + forcewright_base::maths::powi(x - mx, 2) / sxx).sqrt()).abs() < 1e-12);
    }
}

/// Part of repetitions in which intervals of Student and of the profile contain the truth, per parameter; and part in which something
/// is called unexplained.
fn coverage<F>(x: &[f64], truth: &[f64], of: F, sigma: f64, loss: Loss, profiles: bool) -> (Vec<[f64; 2]>, f64)
where
    F: Fn(f64, &[Dual64]) -> Dual64 + Sync + Copy,
{
    let model = Formula { x: x.to_vec(), of };
    let exact: Vec<f64> = x.iter().map(|x| of(*x, &truth.iter().map(|v| Dual64::from(*v)).collect::<Vec<_>>()).re).collect();
    let parameters: Vec<_> = truth.iter().map(|v| free(1.1 * v)).collect();
    let mut hits = vec![[0_u32; 2]; truth.len()];
    let mut alarms = 0_u32;
    let mut noise = Noise(20_240_917);
    for _ in 0..REPETITIONS {
        let y: Vec<f64> = exact.iter().map(|v| v + sigma * noise.normal()).collect();
        let found = fitted(&model, &parameters, x, &y, &Plan { loss, profiles, accuracy: 0.0, ..Plan::default() });
        for ((hit, got), truth) in hits.iter_mut().zip(&found.parameters).zip(truth) {
            hit[0] += u32::from(got.estimate.interval.contains(*truth));
            hit[1] += u32::from(got.profile.is_some_and(|p| p.contains(*truth)));
        }
        alarms += u32::from(found.residuals.unexplained);
    }
    let part = |count: u32| f64::from(count) / REPETITIONS as f64;
    (hits.into_iter().map(|h| h.map(part)).collect(), part(alarms))
}

fn right(part: f64) -> bool {
    (0.935..=0.965).contains(&part)
}

#[test]
fn lines_contain_the_truth_as_often_as_they_say() {
    let x: Vec<f64> = (0..12).map(f64::from).collect();
    let (hits, _) = coverage(&x, &[1.0, 2.0], |x, p| p[0] + p[1] * x, 0.5, Loss::Squares, false);
    assert!(hits.iter().all(|h| right(h[0])), "{hits:?}");
}

#[test]
fn exponentials_and_saturation_contain_the_truth_as_often_as_they_say() {
    let x: Vec<f64> = (0..40).map(|i| 0.1 * f64::from(i)).collect();
    let decay = |x: f64, p: &[Dual64]| p[0] * (-p[1] * x).exp();
    let (hits, alarms) = coverage(&x, &[5.0, 0.8], decay, 0.2, Loss::Squares, true);
    println!("exponential {hits:?}, alarms {alarms}");
    assert!(hits.iter().flatten().all(|h| right(*h)) && alarms < 0.02, "{hits:?} {alarms}");
    // L. Michaelis & M. L. Menten: v = V s/(K + s).
    let s: Vec<f64> = (1..=30).map(|i| 0.1 * f64::from(i)).collect();
    let (hits, alarms) = coverage(&s, &[2.0, 0.5], |s, p| p[0] * s / (p[1] + s), 0.05, Loss::Squares, true);
    println!("saturation {hits:?}, alarms {alarms}");
    assert!(hits.iter().flatten().all(|h| right(*h)) && alarms < 0.02, "{hits:?} {alarms}");
}

/// With errors that are normal, robust losses lose little and say so; intervals keep what they say.
#[test]
fn robust_intervals_of_good_measurements() {
    let x: Vec<f64> = (0..60).map(|i| 0.05 * f64::from(i)).collect();
    for loss in [Loss::Huber, Loss::SoftL1, Loss::Tukey] {
        let (hits, alarms) = coverage(&x, &[3.0, 0.7], |x, p| p[0] * (-p[1] * x).exp(), 0.2, loss, false);
        println!("{loss:?} {hits:?}, alarms {alarms}");
        assert!(hits.iter().all(|h| (0.93..=0.965).contains(&h[0])) && alarms < 0.02, "{loss:?} {hits:?} {alarms}");
    }
}
