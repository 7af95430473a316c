//! How searches end: where derivatives fail, where nothing ends, where another optimum is better, and where there is a kink.

use std::sync::atomic::{AtomicUsize, Ordering};

use forcewright_study::calibrate::{Bound, Limits, Measured, Model, Plan, Progress, Stop, fit};
use forcewright_study::evaluator::{Evaluation, Failure, Workspace};
use num_dual::Dual64;

use super::common::{Formula, Noise, fitted, free};

/// Counts what it is asked.
struct Counted<M> {
    model: M,
    asked: AtomicUsize,
}

impl<M: Model> Counted<M> {
    fn new(model: M) -> Self {
        Self { model, asked: AtomicUsize::new(0) }
    }

    fn asked(&self) -> usize {
        self.asked.load(Ordering::Relaxed)
    }
}

impl<M: Model> Model for Counted<M> {
    fn predict(&self, x: &[f64], derivatives: bool, room: &mut Workspace, out: &mut Evaluation) -> Result<(), Failure> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        self.model.predict(x, derivatives, room, out)
    }
}

/// `p x`, without derivatives beyond 1.5.
struct Blind(Vec<f64>);

impl Model for Blind {
    fn predict(&self, p: &[f64], derivatives: bool, _: &mut Workspace, out: &mut Evaluation) -> Result<(), Failure> {
        if derivatives && p[0] > 1.5 {
            return Err(Failure { reason: "no derivative".to_owned() });
        }
        out.values = self.0.iter().map(|x| p[0] * x).collect();
        out.jacobian = if derivatives { self.0.clone() } else { Vec::new() };
        Ok(())
    }
}

/// The optimum, 2, lies where there are no derivatives: the search comes as near as it can and says that this is no end; between tries it
/// asks whether to go on, and stops when told.
#[test]
fn derivatives_that_fail_end_the_search() {
    let model = Counted::new(Blind((1..=12).map(f64::from).collect()));
    let x = &model.model.0;
    let y: Vec<f64> = x.iter().map(|x| 2.0 * x + 0.01 * (x * 7.0 % 2.0 - 1.0)).collect();
    let measured = Measured { x, y: &y, raw: &y, branches: &[12] };
    let mut asked = Vec::new();
    let whole = &mut |p| {
        if let Progress::Search { rounds, .. } = p {
            asked.push(rounds);
        }
        true
    };
    let found = fit(&model, &[free(1.0)], measured, &Plan::default(), whole).expect("a fit");
    let only = &found.parameters[0];
    println!("{} after {} rounds, {} evaluations", only.estimate.value, found.rounds, model.asked());
    assert!(found.stop == Stop::Stalled && (1.4..=1.5).contains(&only.estimate.value), "{found:?}");
    assert!(only.error.is_infinite() && only.estimate.interval.low.is_infinite() && only.profile.is_none());
    assert!(model.asked() < 2000 && asked.len() < 1000, "{} {}", model.asked(), asked.len());
    // Told to stop at the second try of a round, it asks nothing more of the model but the curve of the start, which is there already.
    let again = asked.windows(2).position(|w| w[0] == w[1]).expect("tries are asked about") + 1;
    let (mut calls, mut at_stop) = (0, 0);
    let counted = &model.asked;
    let stop = &mut |_| {
        calls += 1;
        at_stop = counted.load(Ordering::Relaxed);
        calls <= again
    };
    let part = fit(&model, &[free(1.0)], measured, &Plan::default(), stop).expect("a fit");
    assert!(part.stop == Stop::Interrupted && calls == again + 1 && model.asked() == at_stop, "{calls} {again}");
}

/// Steps that the search for an end may take where tangents know nothing; each is a curve, and once more with derivatives if it is good.
const STEPS: usize = 200;

/// Of a product only the product is known: intervals of the factors have no end, which is found out in few evaluations; the other
/// parameter has its own, as tight as without. Where the one factor has bounds, the other has an interval.
#[test]
fn a_product_costs_little_and_its_bounds_count() {
    let x: Vec<f64> = (0..50).map(|i| 3.0 * f64::from(i) / 49.0).collect();
    let mut noise = Noise(3);
    let y: Vec<f64> = x.iter().map(|x| 6.0 * x + 1.0 + 0.05 * noise.normal()).collect();
    let of = |x: f64, p: &[Dual64]| p[0] * p[1] * x + p[2];
    let model = Counted::new(Formula { x: x.clone(), of });
    let found = fitted(&model, &[free(2.0), free(3.2), free(1.0)], &x, &y, &Plan::default());
    let most = 2 * 4 * STEPS + 200;
    println!("{} evaluations, at most {most}", model.asked());
    assert!(
        found.stop == Stop::Converged && model.asked() < most && (found.degrees - 48.0).abs() < 1e-12,
        "{} {}",
        model.asked(),
        found.degrees
    );
    for factor in &found.parameters[..2] {
        let profile = factor.profile.expect("an interval");
        assert!(factor.error.is_infinite() && factor.estimate.interval.high.is_infinite() && profile.high.is_infinite(), "{profile:?}");
    }
    let line =
        fitted(&Formula { x: x.clone(), of: |x: f64, p: &[Dual64]| p[0] * x + p[1] }, &[free(6.0), free(1.0)], &x, &y, &Plan::default());
    let (zero, alone) = (&found.parameters[2], &line.parameters[1]);
    let ends = |p: &forcewright_study::calibrate::Estimated| p.profile.map(|i| [i.low, i.high]).expect("an interval");
    assert!(ends(zero).iter().zip(ends(alone)).all(|(a, b)| (a - b).abs() < 2e-3 * alone.error), "{zero:?} {alone:?}");
    // Down to a bound at zero, where the other factor is infinite, searches are long: they are given up, and the bound is the end, or near.
    let model = Counted::new(Formula { x: x.clone(), of });
    let mut positive = [free(2.0), free(3.2), free(1.0)];
    positive[0].limits = Limits { lower: 0.0, upper: f64::INFINITY };
    let open = fitted(&model, &positive, &x, &y, &Plan::default());
    println!("{} evaluations down to zero, {:?}", model.asked(), open.parameters[0].profile);
    assert!(model.asked() < 1300 && open.parameters[0].profile.is_some_and(|p| p.low < 0.02 && p.high.is_infinite()));
    // a b = 6 with 1 ≤ b ≤ 2: 3 ≤ a ≤ 6.
    let mut bounded = [free(2.0), free(1.5), free(1.0)];
    bounded[0].limits = Limits { lower: 0.0, upper: 100.0 };
    bounded[1].limits = Limits { lower: 1.0, upper: 2.0 };
    let found = fitted(&Formula { x: x.clone(), of }, &bounded, &x, &y, &Plan::default());
    let [low, high] = ends(&found.parameters[0]);
    println!("a {low} to {high} {:?}", found.parameters[1].at);
    assert!((2.95..3.0).contains(&low) && (6.0..6.1).contains(&high), "{low} {high}");
}

/// Two optima: a profile that leads from the worse to the better makes the fit begin again from there. The squares are
/// ¼ (p² − 1)² + 0.09 (p − 1)² and those of points that say nothing: minima at 1 and −½ − √0.07 = −0.765.
#[test]
fn a_better_optimum_that_a_profile_finds_is_taken() {
    let of = |x: f64, p: &[Dual64]| {
        if x < 0.5 {
            (p[0] * p[0] - 1.0) * 0.5
        } else if x < 1.5 {
            (p[0] - 1.0) * 0.3
        } else {
            Dual64::from(0.0)
        }
    };
    let x: Vec<f64> = (0..6).map(f64::from).collect();
    let y = [0.0, 0.0, 0.02, -0.02, 0.02, -0.02];
    let model = Formula { x: x.clone(), of };
    let local = fitted(&model, &[free(-1.2)], &x, &y, &Plan { profiles: false, ..Plan::default() });
    assert!((local.parameters[0].estimate.value + 0.5 + 0.07_f64.sqrt()).abs() < 1e-6 && local.stop == Stop::Converged);
    let found = fitted(&model, &[free(-1.2)], &x, &y, &Plan::default());
    let only = &found.parameters[0];
    assert!((only.estimate.value - 1.0).abs() < 1e-6 && found.stop == Stop::Converged && found.rounds > local.rounds, "{found:?}");
    let direct = fitted(&model, &[free(1.2)], &x, &y, &Plan::default());
    let (a, b) = (only.profile.expect("an interval"), direct.parameters[0].profile.expect("an interval"));
    assert!((a.low - b.low).abs() < 1e-3 * only.error && (a.high - b.high).abs() < 1e-3 * only.error && only.error < 0.1, "{a:?} {b:?}");
}

/// The least squares lie at a kink, where both tangents promise less: no end, and nothing is said of the parameter.
#[test]
fn a_kink_has_no_interval() {
    let x: Vec<f64> = (0..20).map(f64::from).collect();
    let mut noise = Noise(2);
    let y: Vec<f64> = x.iter().map(|_| 0.5 + 0.02 * noise.normal()).collect();
    let of = |_: f64, p: &[Dual64]| if p[0].re < 0.3 { -p[0] * 2.0 + 1.6 } else { p[0] * 2.0 + 0.4 };
    let found = fitted(&Formula { x: x.clone(), of }, &[free(1.0)], &x, &y, &Plan::default());
    let only = &found.parameters[0];
    assert!(found.stop == Stop::Stalled && (only.estimate.value - 0.3).abs() < 1e-6, "{found:?}");
    let interval = only.estimate.interval;
    assert!(interval.low.is_infinite() && interval.high.is_infinite() && only.error.is_infinite() && only.profile.is_none());
    // With bounds they are all that is known.
    let mut bounded = free(1.0);
    bounded.limits = Limits { lower: -1.0, upper: 4.0 };
    let found = fitted(&Formula { x: x.clone(), of }, &[bounded.clone()], &x, &y, &Plan::default());
    let interval = found.parameters[0].estimate.interval;
    assert!(found.stop == Stop::Stalled && (interval.low + 1.0).abs() < 1e-12 && (interval.high - 4.0).abs() < 1e-12);
    // A bound before the kink is an end.
    bounded.limits.lower = 0.5;
    let found = fitted(&Formula { x: x.clone(), of }, &[bounded], &x, &y, &Plan::default());
    assert!(found.stop == Stop::Converged && found.parameters[0].at == Some(Bound::Lower), "{found:?}");
}
