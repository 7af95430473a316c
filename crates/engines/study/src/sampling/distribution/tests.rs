use super::*;

fn examples() -> Vec<Distribution> {
    vec![
        Distribution::normal(2.0, 0.5).unwrap(),
        Distribution::truncated_normal(2.0, 0.5, 1.5, 4.0).unwrap(),
        Distribution::truncated_normal(0.0, 1.0, 4.0, 9.0).unwrap(),
        Distribution::truncated_normal(0.0, 1.0, -9.0, -4.0).unwrap(),
        Distribution::truncated_normal(0.0, 1.0, 1.0, 1.01).unwrap(),
        Distribution::uniform(-1.0, 3.0).unwrap(),
        Distribution::triangular(0.0, 1.0, 4.0).unwrap(),
        Distribution::triangular(0.0, 0.0, 1.0).unwrap(),
        Distribution::triangular(0.0, 1.0, 1.0).unwrap(),
    ]
}

#[test]
fn quantile_and_probability_are_inverse() {
    for distribution in examples() {
        let mut last = f64::NEG_INFINITY;
        for i in 1..400 {
            let p = f64::from(i) / 400.0;
            let x = distribution.quantile(p);
            assert!((distribution.cdf(x) - p).abs() < 1e-12, "{distribution:?} {p}");
            assert!(x > last, "{distribution:?} {p}");
            last = x;
        }
    }
}

/// `∫₀¹ Q(p) dp` and `∫₀¹ (Q(p) − mean)² dp`, integrated over normal scores, where all these quantiles are smooth but for one kink.
#[test]
fn moments_are_those_of_the_quantiles() {
    let rule = GaussLegendre::new(20);
    for d in examples() {
        let integral = |f: &dyn Fn(f64) -> f64| -> f64 {
            let panel = |k: i32| {
                rule.integrate(|u| {
                    let z = 0.25 * (f64::from(k) + u);
                    0.25 * f(d.at_score(z)) * normal::density(z)
                })
            };
            (-36..36).map(panel).sum()
        };
        let mean = integral(&|x| x);
        let variance = integral(&|x| (x - mean) * (x - mean));
        assert!((mean - d.mean()).abs() < 2e-7 * d.sd(), "{d:?} {mean}");
        assert!((variance.sqrt() / d.sd() - 1.0).abs() < 2e-7, "{d:?} {}", variance.sqrt());
    }
}

/// The half-normal distribution has the mean √(2/π) and the variance 1 − 2/π; far out, a tail is exponential.
#[test]
fn truncated_moments_in_closed_form() {
    let half = Distribution::truncated_normal(0.0, 1.0, 0.0, 60.0).unwrap();
    let two_over_pi = std::f64::consts::FRAC_2_PI;
    assert!((half.mean() - two_over_pi.sqrt()).abs() < 1e-15 && (half.sd() - (1.0 - two_over_pi).sqrt()).abs() < 1e-15);
    let tail = Distribution::truncated_normal(0.0, 1.0, 30.0, 60.0).unwrap();
    assert!((tail.mean() - 30.0 - 1.0 / 30.0).abs() < 1e-4);
    // A narrow slice is uniform up to the slope of its density, and both branches agree at their border.
    let slice = Distribution::truncated_normal(0.0, 1.0, 1.0, 1.0 + 1e-6).unwrap();
    assert!((slice.sd() / (1e-6 / 12.0_f64.sqrt()) - 1.0).abs() < 1e-9);
    let (below, above) = (truncated_moments(1.0, 1.5 - 1e-9), truncated_moments(1.0, 1.5 + 1e-9));
    assert!((below.0 - above.0).abs() < 2e-9 && (below.1 - above.1).abs() < 2e-9);
}

#[test]
fn tolerances_become_zones() {
    let sd = |form| Distribution::from_tolerance(10.0, 0.3, form).unwrap().sd();
    assert!((sd(Form::Normal) - 0.1).abs() < 1e-15);
    assert!((sd(Form::Uniform) - 0.3 / 3.0_f64.sqrt()).abs() < 1e-15);
    assert!((sd(Form::Triangular) - 0.3 / 6.0_f64.sqrt()).abs() < 1e-15);
    // 1 − 6 φ(3) / (2Φ(3) − 1) of the variance is left.
    let left = 1.0 - 6.0 * normal::density(3.0) / normal::between(-3.0, 3.0);
    assert!((sd(Form::TruncatedNormal) - 0.1 * left.sqrt()).abs() < 1e-15);
    for form in [Form::Normal, Form::TruncatedNormal, Form::Uniform, Form::Triangular] {
        let fit = Distribution::from_deviations(17.6, -0.018, 0.0, form).unwrap();
        assert!((fit.mean() - 17.591).abs() < 1e-14 && (fit.quantile(0.5) - 17.591).abs() < 1e-14);
        assert!((fit.half_width() - 0.009).abs() < 1e-14);
        if form != Form::Normal {
            assert!((fit.quantile(0.0) - 17.582).abs() < 1e-14 && (fit.quantile(1.0) - 17.6).abs() < 1e-14);
        }
        // Both deviations on one side of the nominal value.
        assert!((Distribution::from_deviations(5.0, 0.01, 0.03, form).unwrap().mean() - 5.02).abs() < 1e-15);
        let constant = Distribution::from_tolerance(1.0, 0.0, form).unwrap();
        assert!(constant.sd() == 0.0 && [0.0, 0.3, 1.0].iter().all(|p| (constant.quantile(*p) - 1.0).abs() < 1e-15));
        assert!(constant.cdf(0.9) == 0.0 && (constant.cdf(1.0) - 1.0).abs() < f64::EPSILON);
    }
}

#[test]
fn what_is_no_distribution_is_refused_with_the_reason() {
    use DistributionError::{Empty, Negative, NotFinite, Order};
    assert_eq!(Distribution::normal(f64::NAN, 1.0), Err(NotFinite));
    assert_eq!(Distribution::normal(0.0, -1.0), Err(Negative { width: -1.0 }));
    assert_eq!(Distribution::from_tolerance(0.0, -1.0, Form::Uniform), Err(Negative { width: -1.0 }));
    assert_eq!(Distribution::from_tolerance(0.0, f64::NAN, Form::Uniform), Err(NotFinite));
    assert_eq!(Distribution::uniform(2.0, 1.0), Err(Order { low: 2.0, high: 1.0 }));
    assert_eq!(Distribution::triangular(0.0, 3.0, 2.0), Err(Order { low: 0.0, high: 2.0 }));
    assert_eq!(Distribution::truncated_normal(0.0, 1.0, 50.0, 51.0), Err(Empty { low: 50.0, high: 51.0 }));
    assert_eq!(Distribution::truncated_normal(0.0, 0.0, 1.0, 2.0), Err(Empty { low: 1.0, high: 2.0 }));
    assert!(Order { low: 2.0, high: 1.0 }.to_string().contains("out of order"));
    assert!([-0.1, 1.1, f64::NAN].iter().all(|p| examples().iter().all(|d| d.quantile(*p).is_nan())));
}
