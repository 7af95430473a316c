use super::*;
use crate::sampling::{Distribution, Estimate, Form};

const OPEN: Interval = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };

fn within(low: f64, high: f64) -> Interval {
    Interval { low, high }
}

/// Two parameters of standard deviations 1 and 2 with the correlation ρ; outputs: sum, difference and the first alone.
fn pair(rho: f64) -> LinearModel {
    let covariance = [1.0, 2.0 * rho, 2.0 * rho, 4.0];
    LinearModel::new(vec![5.0, 0.0, -1.0], vec![1.0, 1.0, 1.0, -1.0, 1.0, 0.0], &covariance).unwrap()
}

/// Twice a 95 % interval is missed once in a thousand times (Student, 15 degrees of freedom); and it must be narrow.
fn assert_covers(found: Estimate, truth: f64) {
    let half = 0.5 * (found.interval.high - found.interval.low);
    assert!((found.value - truth).abs() < 2.0 * half && half < 2e-3, "{found:?} {truth}");
}

#[test]
fn variances_and_shares_in_closed_form() {
    for rho in [-1.0, -0.9, 0.0, 0.5, 1.0] {
        let model = pair(rho);
        assert!((model.sd(0) - (5.0_f64 + 4.0 * rho).sqrt()).abs() < 1e-14);
        assert!((model.sd(1) - (5.0_f64 - 4.0 * rho).sqrt()).abs() < 1e-14 && (model.sd(2) - 1.0).abs() < 1e-15);
        let bars = model.contributions(1);
        assert_eq!((bars[0].parameter, bars[1].parameter), (1, 0));
        assert!((bars[0].half_range + 6.0).abs() < 1e-14 && (bars[1].half_range - 3.0).abs() < 1e-14);
        assert!((bars[0].share - (4.0 - 2.0 * rho) / (5.0 - 4.0 * rho)).abs() < 1e-14);
        assert!((bars[0].share + bars[1].share - 1.0).abs() < 1e-14);
    }
}

/// Correlated truth must change the yield: `P(|X + Y| ≤ c) = 2Φ(c/√(5 + 4ρ)) − 1`, exactly and by samples.
#[test]
fn yields_follow_the_correlation() {
    let c = 2.5;
    let mut last = f64::INFINITY;
    for rho in [-0.9, 0.0, 0.9] {
        let model = pair(rho);
        let closed = normal::between(-c / (5.0_f64 + 4.0 * rho).sqrt(), c / (5.0_f64 + 4.0 * rho).sqrt());
        assert!((model.yield_of(0, within(5.0 - c, 5.0 + c)).unwrap() - closed).abs() < 1e-15);
        assert!(closed < last - 0.1);
        last = closed;
        let sampled = model.joint_yield(&[within(5.0 - c, 5.0 + c), OPEN, OPEN], JointPlan::default()).unwrap();
        assert_covers(sampled.estimate, closed);
    }
}

/// Independent outputs: the yields multiply. And the orthant of two correlated ones: `¼ + asin(ρ)/2π` (Sheppard 1899).
#[test]
fn joint_yields_in_closed_form() {
    let model =
        LinearModel::new(vec![0.0; 3], vec![2.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 3.0], &[1.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 1.0]);
    let model = model.unwrap();
    let limits = [within(-3.0, 2.0), within(-1.0, 9.0), within(f64::NEG_INFINITY, 2.0)];
    let product: f64 = limits.iter().enumerate().map(|(i, l)| model.yield_of(i, *l).unwrap()).product();
    let found = model.joint_yield(&limits, JointPlan::default()).unwrap().estimate;
    assert_covers(found, product);

    let rho = 0.6;
    let model = LinearModel::new(vec![0.0; 2], vec![1.0, 0.0, 0.0, 1.0], &[1.0, rho, rho, 1.0]).unwrap();
    let orthant = 0.25 + forcewright_base::maths::asin(rho) / std::f64::consts::TAU;
    let positive = within(0.0, f64::INFINITY);
    let found = model.joint_yield(&[positive; 2], JointPlan::default()).unwrap().estimate;
    assert_covers(found, orthant);
}

/// The nominal value of an h7 shaft is an end of its zone: the mean moves by half of it.
#[test]
fn zones_beside_the_nominal_value_move_the_mean() {
    let shaft = Distribution::from_deviations(17.6, -0.018, 0.0, Form::Uniform).unwrap();
    let bore = Distribution::from_deviations(17.6, 0.0, 0.027, Form::Uniform).unwrap();
    let population = Population::independent(vec![bore, shaft]);
    let play = LinearModel::about(&[17.6, 17.6], &[0.0], vec![1.0, -1.0], &population).unwrap();
    assert!((play.means()[0] - 0.0225).abs() < 1e-14);
    let bars = play.contributions(0);
    assert!((bars[0].half_range - 0.0135).abs() < 1e-15 && (bars[1].half_range + 0.009).abs() < 1e-15);
    assert!((play.sd(0) - ((0.018_f64 * 0.018 + 0.027 * 0.027) / 12.0).sqrt()).abs() < 1e-15);
}

#[test]
fn scaled_tolerances_reach_the_target() {
    let limits = within(1.0, 10.0);
    for (rho, target) in [(0.0, 0.9), (0.5, 0.97), (-0.9, 0.999), (0.0, 0.95)] {
        for parameter in [0, 1] {
            let model = pair(rho);
            let Some(factor) = model.scale_for_yield(parameter, 0, limits, target).unwrap() else {
                // Not even without this parameter.
                let alone = if parameter == 0 { 2.0 } else { 1.0 };
                assert!(normal_within(5.0, alone, limits) < target);
                continue;
            };
            // Build the scaled model and ask it.
            let yield_at = |factor: f64| {
                let sd = if parameter == 0 { [factor, 2.0] } else { [1.0, 2.0 * factor] };
                let shared = rho * sd[0] * sd[1];
                let scaled = LinearModel::new(vec![5.0], vec![1.0; 2], &[sd[0] * sd[0], shared, shared, sd[1] * sd[1]]).unwrap();
                scaled.yield_of(0, limits).unwrap()
            };
            assert!((yield_at(factor) - target).abs() < 1e-12, "{rho} {target} {parameter}");
            assert!(yield_at(factor * 1.01) < target);
            // The sampled way, with the other outputs free, finds the same.
            let plan = JointPlan { points_per_replicate: 2048, ..JointPlan::default() };
            let sampled = model.scale_for_joint_yield(parameter, &[limits, OPEN, OPEN], target, plan).unwrap().unwrap();
            assert!((yield_at(sampled) - target).abs() < 1e-3, "{sampled} {factor}");
        }
    }
}

#[test]
fn what_no_tolerance_can_mend_has_no_factor() {
    let model = pair(0.0);
    let plan = JointPlan::default();
    // The other parameter alone is too much: 2Φ(1) − 1 = 0.683 at most.
    assert_eq!(model.scale_for_yield(0, 0, within(3.0, 7.0), 0.7), Ok(None));
    assert_eq!(model.scale_for_joint_yield(0, &[within(3.0, 7.0), OPEN, OPEN], 0.7, plan), Ok(None));
    // The mean is outside.
    assert_eq!(model.scale_for_yield(0, 0, within(6.0, 9.0), 0.6), Ok(None));
    // The second parameter has no part in the third output.
    assert_eq!(model.scale_for_yield(1, 2, within(-9.0, 7.0), 0.99), Ok(Some(f64::INFINITY)));
    assert_eq!(model.scale_for_joint_yield(1, &[OPEN, OPEN, within(-9.0, 7.0)], 0.99, plan), Ok(Some(f64::INFINITY)));
    // One-sided: σ = 3/Φ⁻¹(0.95), by the closed form.
    let z = normal::quantile(0.95);
    let factor = model.scale_for_yield(0, 2, within(f64::NEG_INFINITY, 2.0), 0.95).unwrap().unwrap();
    assert!((factor - 3.0 / z).abs() < 1e-14);
}

#[test]
fn wrong_arguments_are_named() {
    use LinearError::{Covariance, NoSuchIndex, NotFinite, Shape, Target};
    let model = |jacobian: &[f64], covariance: &[f64]| LinearModel::new(vec![0.0], jacobian.to_vec(), covariance).map(|_| ());
    assert_eq!(model(&[1.0], &[1.0, 0.0]), Err(Shape { wanted: 1, given: 2 }));
    assert_eq!(model(&[1.0, 2.0], &[1.0]), Err(Shape { wanted: 1, given: 2 }));
    assert_eq!(model(&[f64::NAN], &[1.0]), Err(NotFinite));
    assert_eq!(model(&[1.0], &[-1.0]), Err(NotFinite));
    assert!(matches!(model(&[1.0, 1.0], &[1.0, 2.0, 2.0, 1.0]), Err(Covariance(_))));
    assert!(matches!(model(&[1.0, 1.0], &[0.0, 1.0, 1.0, 1.0]), Err(Covariance(_))));
    assert_eq!(pair(0.0).yield_of(3, OPEN), Err(NoSuchIndex { index: 3 }));
    assert_eq!(pair(0.0).scale_for_yield(2, 0, OPEN, 0.9), Err(NoSuchIndex { index: 2 }));
    assert_eq!(pair(0.0).scale_for_yield(0, 0, OPEN, 0.5), Err(Target { target: 0.5 }));
    assert_eq!(pair(0.0).joint_yield(&[OPEN], JointPlan::default()), Err(Shape { wanted: 3, given: 1 }));
    let constant = LinearModel::new(vec![1.0], vec![2.0], &[0.0]).unwrap();
    assert!(constant.contributions(0)[0].share == 0.0 && constant.yield_of(0, within(0.0, 1.0)) == Ok(1.0));
    assert!(pair(0.0).contributions(9).is_empty() && pair(0.0).sd(usize::MAX) == 0.0);
}
