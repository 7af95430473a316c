#![allow(clippy::unwrap_used, reason = "a test that fails")]

use forcewright_base::maths::{powi, sin};

use super::*;
use crate::evaluator::{Output, Workspace};
use crate::sampling::{Correlation, Distribution, normal};

/// Values that are any function of the variables; the measures are the values.
struct Toy<F> {
    variables: Vec<Variable>,
    outputs: Vec<Output>,
    measures: Vec<Measure>,
    values: F,
}

impl<F: Fn(&[f64]) -> Result<Vec<f64>, String> + Send + Sync> Toy<F> {
    /// Variables that are nominally 0, and a measure per limit.
    fn new(variables: usize, limits: &[(f64, f64)], values: F) -> Self {
        let variable =
            |i| Variable { path: format!("design.x{i}"), unit: "1", nominal: 0.0, lower: f64::NEG_INFINITY, upper: f64::INFINITY };
        let measure = |(lower, upper): &(f64, f64)| Measure {
            name: "y".to_owned(),
            requirement: "y".to_owned(),
            unit: "1",
            lower: *lower,
            upper: *upper,
        };
        Self {
            variables: (0..variables).map(variable).collect(),
            outputs: vec![Output { name: "y".to_owned(), unit: "1", values: 0..limits.len() }],
            measures: limits.iter().map(measure).collect(),
            values,
        }
    }
}

impl<F: Fn(&[f64]) -> Result<Vec<f64>, String> + Send + Sync> Evaluator for Toy<F> {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn measures(&self) -> &[Measure] {
        &self.measures
    }

    fn workspace(&self) -> Workspace {
        Workspace::new(())
    }

    fn evaluate(&self, x: &[f64], _: bool, out: &mut Evaluation, _: &mut Workspace) -> Result<(), Failure> {
        out.values = (self.values)(x).map_err(|reason| Failure { reason })?;
        Ok(())
    }

    fn measure(&self, _: &[f64], values: &[f64], out: &mut Vec<f64>, _: &mut Workspace) {
        out.clear();
        out.extend_from_slice(values);
    }
}

fn normals(count: usize) -> Vec<Distribution> {
    vec![Distribution::normal(0.0, 1.0).unwrap(); count]
}

fn plan(population: Population, samples: u64) -> Plan {
    Plan { linear_samples: samples, sensitivity_points: 0, ..Plan::new(population, samples, 7, 0.9) }
}

fn run(evaluator: &dyn Evaluator, plan: &Plan) -> Study {
    study(evaluator, plan, &mut |_| true).unwrap()
}

/// x₀ + x₁ of standard normals with correlation ρ is normal with variance 2 (1 + ρ).
#[test]
fn a_sum_of_normals_keeps_its_band_as_often_as_phi_says() {
    let toy = Toy::new(2, &[(-2.0, 2.0)], |x: &[f64]| Ok(vec![x[0] + x[1]]));
    for rho in [-0.5, 0.0, 0.8] {
        let population = Population::independent(normals(2)).correlate(&[0, 1], Correlation::common(2, rho).unwrap()).unwrap();
        let found = run(&toy, &plan(population, 8192));
        let sd = (2.0_f64 * (1.0 + rho)).sqrt();
        let truth = normal::between(-2.0 / sd, 2.0 / sd);
        let linear = found.linear.as_ref().unwrap();
        for sampled in [&found.all, &found.kept[0].found, &linear.all, &linear.kept[0].found] {
            assert!(sampled.estimate.interval.contains(truth), "{rho}: {truth} {:?}", sampled.estimate);
            assert!((sampled.estimate.value - truth).abs() < 4e-3, "{rho}: {truth} {}", sampled.estimate.value);
        }
        assert!(!found.linear_is_off() && found.target_met() == (found.all.estimate.value >= 0.9));
        // The fan and the distribution of the measure are those of the same normal.
        for fan in [&found.fan, &found.spread] {
            assert!((fan.quantile(0, 0.95) / sd - 1.644_853_6).abs() < 0.02 && (fan.station(0).sd / sd - 1.0).abs() < 0.01);
        }
    }
}

/// y = 2 a + b within ±3 with 90 %: of σ² = 4 s² + 1 there may be (3/1.6449)². The factor of a is known, and b cannot mend it alone.
#[test]
fn needed_tolerances_of_a_linear_measure() {
    let toy = Toy::new(3, &[(-3.0, 3.0)], |x: &[f64]| Ok(vec![2.0 * x[0] + x[1]]));
    let found = run(&toy, &plan(Population::independent(normals(3)), 1024));
    let needed = &found.linear.as_ref().unwrap().needed;
    let most = powi(3.0 / 1.644_853_6, 2);
    let truth = (0.25 * (most - 1.0)).sqrt();
    let scale = needed[0].scale.unwrap();
    // A sample of 1024 has its 90 % where the truth has 89 to 91.
    assert!((scale / truth - 1.0).abs() < 0.05, "{scale} {truth}");
    assert_eq!((needed[1].scale, needed[2].scale), (None, None), "neither b nor what has no effect helps");
    // With wide limits there is room for everything.
    let wide = Toy::new(1, &[(-100.0, 100.0)], |x: &[f64]| Ok(vec![x[0]]));
    let found = run(&wide, &plan(Population::independent(normals(1)), 64));
    assert_eq!(found.linear.unwrap().needed[0].scale, Some(MOST_SCALE));
}

/// Each bar of a linear measure is its coefficient times the ends; the longest comes first.
#[test]
fn tornado_of_a_linear_measure() {
    let toy = Toy::new(3, &[(-9.0, 9.0)], |x: &[f64]| Ok(vec![1.0 + x[0] - 4.0 * x[2]]));
    let found = run(&toy, &plan(Population::independent(normals(3)), 64));
    let order: Vec<usize> = found.tornado.iter().map(|t| t.variable).collect();
    assert_eq!(order, [2, 0, 1]);
    assert_eq!((found.tornado[0].ends, found.tornado[0].values[0]), ([-3.0, 3.0], [Some(13.0), Some(-11.0)]));
    assert!((found.tornado[1].reach(0, Some(1.0)) - 6.0).abs() < 1e-12 && found.tornado[2].reach(0, Some(1.0)) == 0.0);
    assert!(found.tornado[0].reach(0, None).is_infinite());
}

/// T. Ishigami, T. Homma 1990: sin x₀ + a sin² x₁ + b x₂⁴ sin x₀ over [−π, π]³, whose indices have closed forms.
#[test]
fn ishigami_through_the_driver() {
    use std::f64::consts::PI;
    let (a, b) = (7.0, 0.1);
    let toy =
        Toy::new(3, &[(-100.0, 100.0)], move |x: &[f64]| Ok(vec![sin(x[0]) + a * powi(sin(x[1]), 2) + b * powi(x[2], 4) * sin(x[0])]));
    let population = Population::independent(vec![Distribution::uniform(-PI, PI).unwrap(); 3]);
    let found = run(&toy, &Plan { sensitivity_points: 256, ..plan(population, 64) });
    let alone = 0.5 * powi(1.0 + b * powi(PI, 4) / 5.0, 2);
    let (second, joint) = (a * a / 8.0, b * b * powi(PI, 8) * (1.0 / 18.0 - 1.0 / 50.0));
    let variance = alone + second + joint;
    let indices = &found.shares[0].indices;
    for (i, (first, total)) in [(alone, alone + joint), (second, second), (0.0, joint)].into_iter().enumerate() {
        assert!((indices.first[i].value - first / variance).abs() < 0.02, "{i} {:?}", indices.first[i]);
        assert!((indices.total[i].value - total / variance).abs() < 0.02, "{i} {:?}", indices.total[i]);
    }
    assert_eq!((found.shares[0].measure, found.factors.len()), (0, 3));
}

/// A half of all designs has no values: they are missed, and told apart by their words, not by their numbers.
#[test]
fn designs_without_values_are_missed_with_their_reason() {
    let toy = Toy::new(
        1,
        &[(-100.0, 100.0)],
        |x: &[f64]| {
            if x[0] > 0.0 { Err(format!("no equilibrium beyond {} mm", x[0])) } else { Ok(vec![x[0]]) }
        },
    );
    let found = run(&toy, &plan(Population::independent(normals(1)), 1024));
    assert_eq!((found.all.good, found.failures.len(), found.failures[0].count), (512, 1, 512));
    assert!(found.failures[0].text.starts_with("no equilibrium beyond"));
    assert_eq!((found.spread.curves(), found.kept[0].found.good), (512, 512));
    // A neighbour of the nominal design has no values: there is no Jacobian.
    assert!(found.linear.is_none() && !found.linear_is_off());
}

/// y = x² within 1: its slope at 0 is 0, and the linearised yield 1, far from Φ(1) − Φ(−1).
#[test]
fn a_linearisation_that_is_off_is_named() {
    let toy = Toy::new(1, &[(-1.0, 1.0)], |x: &[f64]| Ok(vec![x[0] * x[0]]));
    let found = run(&toy, &plan(Population::independent(normals(1)), 1024));
    assert!((found.all.estimate.value - 0.6827).abs() < 5e-3 && found.linear.as_ref().unwrap().all.good == 1024 && found.linear_is_off());
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let toy = Toy::new(3, &[(-2.0, 2.0), (-1.0, f64::INFINITY)], |x: &[f64]| {
        if x[2] > 2.0 { Err("broken".to_owned()) } else { Ok(vec![x[0] + sin(x[1]), x[1] * x[2]]) }
    });
    let population = Population::independent(normals(3)).correlate(&[0, 2], Correlation::common(2, 0.5).unwrap()).unwrap();
    let plan = Plan { sensitivity_points: 8, ..plan(population, 1008) };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        format!("{:?}", pool.install(|| run(&toy, &plan)))
    };
    let one = with(1);
    assert!(one == with(3) && one == with(8));
    assert!(one != format!("{:?}", run(&toy, &Plan { seed: 8, ..plan.clone() })));
}

/// Chunks come in order, however long each takes, and no more are begun than may wait.
#[test]
fn chunks_come_in_order() {
    let (begun, mut seen) = (std::sync::atomic::AtomicU64::new(0), Vec::new());
    let chunk = |first: u64| {
        begun.fetch_add(1, std::sync::atomic::Ordering::SeqCst);
        std::thread::sleep(std::time::Duration::from_micros(first * 7919 % 500));
        first
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let mut add = |first: u64| {
        assert!(begun.load(std::sync::atomic::Ordering::SeqCst) <= seen.len() as u64 + 3 * 4);
        seen.push(first);
    };
    assert!(pool.install(|| run::in_order(64 * 99 + 1, &mut |_| true, &chunk, &mut add)));
    assert!(seen == (0..100).map(|i| 64 * i).collect::<Vec<u64>>());
}

/// A panic of a thread is that of the study, which must not wait for its chunk for ever.
#[test]
#[should_panic(expected = "chunk 320")]
fn a_panic_is_passed_on() {
    let chunk = |first: u64| assert!(first != 320, "chunk {first}");
    run::in_order(64 * 100, &mut |_| true, &chunk, &mut |()| {});
}

/// A study that is stopped keeps what was drawn, and says so.
#[test]
fn a_study_can_be_stopped() {
    let toy = Toy::new(1, &[(-1.0, 1.0)], |x: &[f64]| Ok(vec![x[0]]));
    let plan = plan(Population::independent(normals(1)), 1 << 20);
    let mut seen = Vec::new();
    let found = study(&toy, &plan, &mut |fraction| {
        seen.push(fraction);
        seen.len() < 3
    })
    .unwrap();
    assert!(found.interrupted && found.all.samples > 0 && found.all.samples < 1 << 20 && found.all.samples.is_multiple_of(16));
    assert!(found.tornado.is_empty() && found.linear.is_none());
    assert!(seen.len() == 3 && seen.windows(2).all(|w| w[0] < w[1]) && seen[2] < 1.0);
    let refused = study(&toy, &plan, &mut |_| false).unwrap();
    assert!(refused.interrupted && refused.all.samples == 0);
}

#[test]
fn what_cannot_be_studied_is_refused() {
    let toy = Toy::new(2, &[(-1.0, 1.0)], |x: &[f64]| Ok(vec![x[0]]));
    let one = plan(Population::independent(normals(1)), 64);
    let shape = study(&toy, &one, &mut |_| true).unwrap_err();
    assert_eq!(shape, ToleranceError::Shape { variables: 2, distributions: 1 });
    let broken = Toy::new(1, &[(-1.0, 1.0)], |_: &[f64]| Err("no curve".to_owned()));
    let nominal = study(&broken, &one, &mut |_| true).unwrap_err();
    assert!(nominal.to_string().contains("no curve"));
    let many = Toy::new(200, &[(-1.0, 1.0)], |x: &[f64]| Ok(vec![x[0]]));
    let error = study(&many, &Plan { sensitivity_points: 1, ..plan(Population::independent(normals(200)), 64) }, &mut |_| true);
    assert!(matches!(error, Err(ToleranceError::Sensitivity(_))), "{error:?}");
}
