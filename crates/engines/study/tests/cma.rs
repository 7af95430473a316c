//! The search of a whole range on problems whose optima are known, and what it must not depend on.
#![allow(clippy::unwrap_used, reason = "helpers of tests: what is not there fails the test")]

use std::cell::RefCell;
use std::f64::consts::PI;

use forcewright_base::maths::{cos, powf, powi, sin};
use forcewright_study::cma::{self, Assessment, CmaError, Found, Problem, Progress, Settings, Stop};

type Values<'a> = dyn Fn(&[f64]) -> Option<(f64, Vec<f64>)> + Sync + 'a;

/// A problem given by its functions.
struct Given<'a> {
    lower: Vec<f64>,
    upper: Vec<f64>,
    values: &'a Values<'a>,
}

impl Problem for Given<'_> {
    fn lower(&self) -> &[f64] {
        &self.lower
    }
    fn upper(&self) -> &[f64] {
        &self.upper
    }
    fn assess(&self, x: &[f64]) -> Option<Assessment> {
        assert!(x.iter().zip(self.lower.iter().zip(&self.upper)).all(|(x, (l, u))| (l..=u).contains(&x)), "{x:?} beyond its range");
        let (goal, misses) = (self.values)(x)?;
        Some(Assessment { goal, misses })
    }
}

fn cube<'a>(n: usize, width: f64, values: &'a Values<'a>) -> Given<'a> {
    Given { lower: vec![-width; n], upper: vec![width; n], values }
}

fn minimise(problem: &Given, start: &[f64], settings: &Settings, watch: &dyn Fn(&Progress) -> bool) -> Found {
    cma::minimise(problem, start, settings, watch).unwrap()
}

fn ellipsoid(x: &[f64]) -> f64 {
    let last = x.len() as f64 - 1.0;
    x.iter().enumerate().map(|(i, x)| powf(1e6, i as f64 / last) * x * x).sum()
}

fn rosenbrock(x: &[f64]) -> f64 {
    x.windows(2).map(|w| 100.0 * (w[1] - w[0] * w[0]) * (w[1] - w[0] * w[0]) + (1.0 - w[0]) * (1.0 - w[0])).sum()
}

/// Points computed until the goal is below a value; the search ends there.
fn effort(problem: &Given, start: &[f64], seed: u64, below: f64) -> u64 {
    let settings = Settings { seed, restarts: 0, ..Settings::default() };
    let found = minimise(problem, start, &settings, &|p| p.best.is_none_or(|b| b.goal > below));
    assert!(found.interrupted && found.runs[0].stop == Stop::Interrupted, "{:?}", found.runs);
    found.evaluations
}

/// The middle of three or five numbers.
fn middle(mut all: Vec<u64>) -> u64 {
    all.sort_unstable();
    all[all.len() / 2]
}

/// Smooth functions of ten variables with their minimum at a known point, from afar and without restarts.
#[test]
fn smooth_minima_are_found_to_working_precision() {
    let sphere = |x: &[f64]| Some((x.iter().map(|x| (x - 0.7) * (x - 0.7)).sum::<f64>(), vec![]));
    let found = minimise(&cube(10, 5.0, &sphere), &[3.0; 10], &Settings { restarts: 0, ..Settings::default() }, &|_| true);
    let best = found.best.as_ref().unwrap();
    println!("sphere: {:e} after {} points, {:?}", best.goal, found.evaluations, found.runs[0].stop);
    assert!(best.goal < 1e-18 && best.x.iter().all(|x| (x - 0.7).abs() < 1e-9) && found.evaluations < 6000);
    let ellipsoid = |x: &[f64]| Some((ellipsoid(x), vec![]));
    let found = minimise(&cube(10, 5.0, &ellipsoid), &[3.0; 10], &Settings { restarts: 0, ..Settings::default() }, &|_| true);
    println!("ellipsoid: {:e} after {} points", found.best.as_ref().unwrap().goal, found.evaluations);
    assert!(found.best.unwrap().goal < 1e-15 && found.evaluations < 10_000);
    let valley = |x: &[f64]| Some((rosenbrock(x), vec![]));
    let found = minimise(&cube(10, 5.0, &valley), &[-1.0; 10], &Settings { restarts: 3, ..Settings::default() }, &|_| true);
    println!("Rosenbrock: {:e}, {} points, {} runs", found.best.as_ref().unwrap().goal, found.evaluations, found.runs.len());
    assert!(found.best.unwrap().x.iter().all(|x| (x - 1.0).abs() < 1e-8));
}

/// L. A. Rastrigin's function of five variables has 11⁵ minima in its range; larger populations find the least.
#[test]
fn restarts_find_the_least_of_many_minima() {
    let eggs = |x: &[f64]| Some((x.iter().map(|x| x * x - 10.0 * cos(2.0 * PI * x) + 10.0).sum::<f64>(), vec![]));
    for seed in 1..=3 {
        let found = minimise(&cube(5, 5.12, &eggs), &[-3.0; 5], &Settings { seed, restarts: 5, ..Settings::default() }, &|_| true);
        let best = found.best.as_ref().unwrap();
        println!("Rastrigin, seed {seed}: {:e}, {} points, {} runs", best.goal, found.evaluations, found.runs.len());
        assert!(best.goal < 1e-9, "seed {seed}: {}", best.goal);
        assert!(found.runs[0].best.as_ref().unwrap().goal > 0.9, "without restarts it is another one");
        assert!(found.runs.iter().any(|r| r.population == 8 << 2), "populations grow");
    }
}

/// Problems of J. J. Liang and others, "Problem definitions and evaluation criteria for the CEC 2006 special session on constrained real-parameter
/// optimization", 2006, with the optima printed there: g06, a sliver between two circles whose end is the optimum; g08, rough; g09, seven
/// variables and two of four limits at work. And problem 43 of W. Hock, K. Schittkowski, 1981 (Rosen and Suzuki), whose optimum is −44.
#[test]
fn optima_on_limits_are_found() {
    let sliver = |x: &[f64]| {
        let limits = [100.0 - powi(x[0] - 5.0, 2) - powi(x[1] - 5.0, 2), powi(x[0] - 6.0, 2) + powi(x[1] - 5.0, 2) - 82.81];
        Some((powi(x[0] - 10.0, 3) + powi(x[1] - 20.0, 3), limits.to_vec()))
    };
    let rough = |x: &[f64]| {
        let goal = -powi(sin(2.0 * PI * x[0]), 3) * sin(2.0 * PI * x[1]) / (powi(x[0], 3) * (x[0] + x[1]));
        Some((goal, vec![x[0] * x[0] - x[1] + 1.0, 1.0 - x[0] + powi(x[1] - 4.0, 2)])).filter(|_| x[0] > 0.0)
    };
    let seven = |x: &[f64]| {
        let goal = powi(x[0] - 10.0, 2)
            + 5.0 * powi(x[1] - 12.0, 2)
            + powi(x[2], 4)
            + 3.0 * powi(x[3] - 11.0, 2)
            + 10.0 * powi(x[4], 6)
            + 7.0 * powi(x[5], 2)
            + powi(x[6], 4)
            - 4.0 * x[5] * x[6]
            - 10.0 * x[5]
            - 8.0 * x[6];
        let limits = [
            2.0 * powi(x[0], 2) + 3.0 * powi(x[1], 4) + x[2] + 4.0 * powi(x[3], 2) + 5.0 * x[4] - 127.0,
            7.0 * x[0] + 3.0 * x[1] + 10.0 * powi(x[2], 2) + x[3] - x[4] - 282.0,
            23.0 * x[0] + powi(x[1], 2) + 6.0 * powi(x[5], 2) - 8.0 * x[6] - 196.0,
            4.0 * powi(x[0], 2) + powi(x[1], 2) - 3.0 * x[0] * x[1] + 2.0 * powi(x[2], 2) + 5.0 * x[5] - 11.0 * x[6],
        ];
        Some((goal, limits.to_vec()))
    };
    let suzuki = |x: &[f64]| {
        let q = |a: f64, b: f64, c: f64, d: f64| a * x[0] * x[0] + b * x[1] * x[1] + c * x[2] * x[2] + d * x[3] * x[3];
        let limits = [
            q(1.0, 1.0, 1.0, 1.0) + x[0] - x[1] + x[2] - x[3] - 8.0,
            q(1.0, 2.0, 1.0, 2.0) - x[0] - x[3] - 10.0,
            q(2.0, 1.0, 1.0, 0.0) + 2.0 * x[0] - x[1] - x[3] - 5.0,
        ];
        Some((q(1.0, 1.0, 2.0, 1.0) - 5.0 * x[0] - 5.0 * x[1] - 21.0 * x[2] + 7.0 * x[3], limits.to_vec()))
    };
    let all: [(&str, Given, Vec<f64>, f64, f64); 4] = [
        ("g06", Given { lower: vec![13.0, 0.0], upper: vec![100.0; 2], values: &sliver }, vec![50.0; 2], -6_961.813_875_580_15, 1e-6),
        ("g08", Given { lower: vec![0.0; 2], upper: vec![10.0; 2], values: &rough }, vec![5.0; 2], -0.095_825_041_418_035_9, 1e-15),
        ("g09", cube(7, 10.0, &seven), vec![0.0; 7], 680.630_057_374_402, 1e-8),
        ("HS43", cube(4, 10.0, &suzuki), vec![0.0; 4], -44.0, 1e-9),
    ];
    for (name, problem, start, optimum, tolerance) in &all {
        for seed in 1..=3 {
            let found = minimise(problem, start, &Settings { seed, restarts: 1, ..Settings::default() }, &|_| true);
            let best = found.best.as_ref().unwrap();
            let off = best.goal - optimum;
            println!("{name}, seed {seed}: {off:e} off, {} points, {} runs", found.evaluations, found.runs.len());
            assert!(off.abs() < *tolerance && best.violation <= 0.0 && best.excess <= 0.0, "{name}, seed {seed}: {off:e}");
            assert!(found.evaluations < 30_000);
        }
    }
}

/// An optimum at the ends of ranges is met to the last digit, and one that lies outside of them at its nearest point.
#[test]
fn ends_of_ranges_are_met() {
    let slope = |x: &[f64]| Some((x[0] - 2.0 * x[1] + (x[2] - 9.0) * (x[2] - 9.0) + (x[3] - 0.25) * (x[3] - 0.25), vec![]));
    let problem = Given { lower: vec![-1.0, 3.0, 2.0, -1.0], upper: vec![1.0, 4.0, 5.0, 1.0], values: &slope };
    let found = minimise(&problem, &[0.0, 3.5, 3.0, 0.0], &Settings { restarts: 0, ..Settings::default() }, &|_| true);
    let x = found.best.unwrap().x;
    assert!((x[0] + 1.0).abs() < 1e-9 && (x[1] - 4.0).abs() < 1e-9 && (x[2] - 5.0).abs() < 1e-9 && (x[3] - 0.25).abs() < 1e-5, "{x:?}");
    // What has no range but one value stays; without ends, and with one, it is searched all the same.
    let bowl = |x: &[f64]| Some(((x[0] - 40.0) * (x[0] - 40.0) + (x[1] + 3.0) * (x[1] + 3.0) + (x[2] - 1.0) * (x[2] - 1.0), vec![]));
    let problem = Given { lower: vec![f64::NEG_INFINITY, 2.0, -2.0], upper: vec![f64::INFINITY, 2.0, f64::INFINITY], values: &bowl };
    let found = minimise(&problem, &[1.0, 2.0, 7.0], &Settings { restarts: 0, ..Settings::default() }, &|_| true);
    let x = found.best.unwrap().x;
    assert!((x[0] - 40.0).abs() < 1e-6 && x[1].to_bits() == 2.0_f64.to_bits() && (x[2] - 1.0).abs() < 1e-6, "{x:?}");
}

/// A turned ellipsoid, whose axes are a million times steeper one than the other, costs as many points as one along the coordinates.
#[test]
fn turning_the_coordinates_costs_nothing() {
    let straight = |x: &[f64]| Some((ellipsoid(x), vec![]));
    // A reflection at a plane across (1, 2, …, 10).
    let turned = |x: &[f64]| {
        let part = 2.0 * x.iter().enumerate().map(|(i, x)| (i + 1) as f64 * x).sum::<f64>() / 385.0;
        let y: Vec<f64> = x.iter().enumerate().map(|(i, x)| x - part * (i + 1) as f64).collect();
        Some((ellipsoid(&y), vec![]))
    };
    let of = |values: &Values| middle((1..=5).map(|seed| effort(&cube(10, 10.0, values), &[1.0; 10], seed, 1e-9)).collect());
    let (one, other) = (of(&straight), of(&turned));
    println!("{one} points along the coordinates, {other} turned");
    assert!((other as f64 / one as f64 - 1.0).abs() < 0.2, "{one} {other}");
}

/// Only the order of goals counts: the cube of a goal, with limits or without, leads along the same path to the last bit.
#[test]
fn only_the_order_of_goals_counts() {
    let path = |cubed: bool, limit: bool| {
        let values = move |x: &[f64]| {
            let goal = rosenbrock(x) - 3.0;
            Some((if cubed { goal * goal * goal } else { goal }, if limit { vec![x[0] + x[1] - 1.5] } else { vec![] }))
        };
        let steps = RefCell::new(Vec::new());
        let settings = Settings { evaluations: 1800, restarts: 0, goal_tolerance: 0.0, ..Settings::default() };
        minimise(&cube(6, 5.0, &values), &[-1.0; 6], &settings, &|p| {
            steps.borrow_mut().extend(p.mean.iter().map(|m| m.to_bits()));
            true
        });
        steps.into_inner()
    };
    for limit in [false, true] {
        let plain = path(false, limit);
        assert!(plain.len() > 6 * 150 && plain == path(true, limit), "limit: {limit}");
    }
    assert_ne!(path(false, false), path(false, true), "the limit is felt");
}

fn bits(found: &Found) -> Vec<u64> {
    let points = found.runs.iter().filter_map(|r| r.best.as_ref());
    points.flat_map(|p| p.x.iter().chain([&p.goal]).map(|v| v.to_bits())).chain([found.evaluations]).collect()
}

#[test]
fn any_number_of_threads_finds_the_same_bits() {
    let eggs = |x: &[f64]| {
        let goal = x.iter().map(|x| x * x - 10.0 * cos(2.0 * PI * x) + 10.0).sum::<f64>();
        Some((goal, vec![0.3 - x[0]])).filter(|_| x[1] < 2.0)
    };
    let with = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let settings = Settings { seed, evaluations: 5000, ..Settings::default() };
        pool.install(|| bits(&minimise(&cube(4, 5.0, &eggs), &[1.0; 4], &settings, &|_| true)))
    };
    assert_eq!(with(1, 7), with(3, 7));
    assert_ne!(with(1, 7), with(1, 8));
}

/// Half of the range has no values, or values that are no numbers, and the start lies there; the optimum lies at the edge of that half.
#[test]
fn points_without_values_are_worse_than_all_others() {
    for nothing in [None, Some(f64::NAN), Some(f64::INFINITY), Some(f64::NEG_INFINITY)] {
        let values = move |x: &[f64]| {
            if x[0] < 0.5 {
                return nothing.map(|goal| (goal, vec![]));
            }
            Some((x.iter().map(|x| x * x).sum::<f64>(), vec![]))
        };
        let found = minimise(&cube(4, 5.0, &values), &[-2.0; 4], &Settings { restarts: 0, ..Settings::default() }, &|_| true);
        let best = found.best.as_ref().unwrap();
        assert!((best.goal - 0.25).abs() < 1e-9 && best.x[0] >= 0.5, "{best:?}");
        assert!(found.failed > 0 && found.failed < found.evaluations);
    }
    // A limit that is no number is none that is kept.
    let values = |x: &[f64]| Some((x[0], vec![if x[0] < 0.0 { f64::NAN } else { -1.0 }]));
    let found = minimise(&cube(1, 1.0, &values), &[0.5], &Settings { restarts: 0, ..Settings::default() }, &|_| true);
    assert!(found.best.as_ref().is_some_and(|b| (0.0..1e-9).contains(&b.x[0])), "{found:?}");
    let none = |_: &[f64]| None;
    let found = minimise(&cube(2, 1.0, &none), &[0.0; 2], &Settings { restarts: 2, ..Settings::default() }, &|_| true);
    assert!(found.best.is_none() && found.failed == found.evaluations && found.runs.iter().all(|r| r.stop == Stop::Nothing));
}

/// A search that is told to stop keeps the best so far; one with few points computes no more than those.
#[test]
fn it_ends_when_told_to() {
    let sphere = |x: &[f64]| Some((x.iter().map(|x| x * x).sum::<f64>(), vec![]));
    let found = minimise(&cube(5, 5.0, &sphere), &[3.0; 5], &Settings::default(), &|p| p.generation < 20);
    assert!(found.interrupted && found.runs.len() == 1 && found.runs[0].generations == 21);
    let best = found.best.unwrap().goal;
    assert!(best < 45.0 && found.runs[0].best.as_ref().is_some_and(|b| b.goal.to_bits() == best.to_bits()));
    for evaluations in [1, 10, 333, 4000] {
        let found = minimise(&cube(5, 5.0, &sphere), &[3.0; 5], &Settings { evaluations, ..Settings::default() }, &|_| true);
        assert!(found.evaluations <= evaluations && found.best.is_some() && !found.interrupted, "{evaluations}: {}", found.evaluations);
    }
    let patient = |patience| {
        minimise(&cube(2, 5.0, &sphere), &[3.0; 2], &Settings { patience, restarts: 50, least_gain: 2.0, ..Settings::default() }, &|_| true)
    };
    assert_eq!(patient(4).runs.len(), 5, "nothing is better by twice itself");
}

/// What makes no sense is refused by its kind, and a range of one point or without an end is none of that.
#[test]
fn what_makes_no_sense_is_an_error() {
    let sphere = |x: &[f64]| Some((x.iter().map(|x| x * x).sum::<f64>(), vec![]));
    let with = |lower: &[f64], upper: &[f64], start: &[f64], settings: Settings| {
        let problem = Given { lower: lower.to_vec(), upper: upper.to_vec(), values: &sphere };
        cma::minimise(&problem, start, &Settings { evaluations: 50, ..settings }, &|_| true).err()
    };
    let usual = Settings::default;
    let (nan, most) = (f64::NAN, f64::INFINITY);
    assert_eq!(with(&[2.0, -1.0], &[1.0, 1.0], &[0.0; 2], usual()), Some(CmaError::Range { variable: 0, lower: 2.0, upper: 1.0 }));
    for (lower, upper) in [(nan, 1.0), (0.0, nan), (most, most), (-most, -most)] {
        let refused = with(&[0.0, lower], &[1.0, upper], &[0.5; 2], usual());
        assert!(matches!(refused, Some(CmaError::Range { variable: 1, .. })), "{lower} {upper}: {refused:?}");
    }
    assert_eq!(with(&[0.0; 3], &[1.0; 3], &[0.5; 2], usual()), Some(CmaError::Shape { lower: 3, upper: 3, start: 2 }));
    assert_eq!(with(&[0.0; 2], &[1.0; 3], &[0.5; 2], usual()), Some(CmaError::Shape { lower: 2, upper: 3, start: 2 }));
    assert!(matches!(with(&[0.0], &[1.0], &[nan], usual()), Some(CmaError::Start { variable: 0, .. })));
    let points = 1 << 63;
    assert_eq!(with(&[0.0], &[1.0], &[0.5], Settings { population: points, ..usual() }), Some(CmaError::Population { points }));
    for step in [0.0, -1.0, most, nan] {
        assert!(matches!(with(&[0.0], &[1.0], &[0.5], Settings { step, ..usual() }), Some(CmaError::Step { .. })), "{step}");
    }
    assert_eq!(with(&[1.0, -most, 0.0], &[1.0, most, most], &[4.0, 1.0, 2.0], usual()), None);
    assert_eq!(with(&[], &[], &[], usual()), None);
}

/// Where all goals are equal there is nothing to find: that is what the test of goals says, in any number of dimensions.
#[test]
fn a_constant_goal_ends_by_its_goal() {
    let level = |_: &[f64]| Some((7.5, vec![]));
    for n in [1, 2, 5, 12] {
        let found = minimise(&cube(n, 5.0, &level), &vec![1.0; n], &Settings { restarts: 0, ..Settings::default() }, &|_| true);
        assert_eq!(found.runs[0].stop, Stop::Goal, "{n}: {:?}", found.runs[0]);
    }
    // A slope without an end is another thing.
    let slope = |x: &[f64]| Some((x[0] + x[1], vec![]));
    let endless = Given { lower: vec![f64::NEG_INFINITY; 2], upper: vec![f64::INFINITY; 2], values: &slope };
    let found = minimise(&endless, &[1.0; 2], &Settings { restarts: 0, ..Settings::default() }, &|_| true);
    assert_eq!(found.runs[0].stop, Stop::Divergence);
}
