//! The fast curve against the general path.

mod common;

use common::{POM, SplitMix, random_network, table3_by_shapes};
use forcewright_beam::{CurveSolver, Path, Point, Response, Settings, Theory, trace};

#[test]
fn curve_of_table3() {
    let network = table3_by_shapes(POM);
    let stations: Vec<f64> = (0..=33).map(|i| 13.6e-3 * f64::from(i) / 33.0).collect();
    let mut solver = CurveSolver::new();
    for theory in [Theory::Inextensible, Theory::Reissner] {
        let exact = trace(&network, &stations, &Settings { theory, accuracy: 1e-10, ..Settings::default() }, &mut |_| true).unwrap();
        for accuracy in [1e-3, 1e-5, 1e-8] {
            let response = solver.solve(&network, &stations, &Settings { theory, accuracy, ..Settings::default() }).unwrap();
            let (error, stress) = errors(response, &exact);
            println!(
                "{theory:?} {accuracy:e}: force error {error:.2e}, estimate {:.2e}, stress {stress:.2e}, general {}, {:?}",
                response.error_estimate, response.general, response.counters
            );
            assert!(!response.general);
            assert!(error <= accuracy);
        }
    }
}

/// Errors of force and stress relative to the largest of the path.
fn errors(response: &Response, exact: &Path) -> (f64, f64) {
    let peak = |p: &Point| p.peak_stress().map_or(0.0, |s| s.1.stress_pa);
    let largest = |f: &dyn Fn(&Point) -> f64| exact.points.iter().fold(0.0_f64, |m, p| m.max(f(p).abs()));
    let worst = |ours: &[f64], f: &dyn Fn(&Point) -> f64| {
        ours.iter().zip(&exact.points).fold(0.0_f64, |m, (a, p)| m.max((a - f(p)).abs())) / largest(f)
    };
    (worst(&response.force_n, &|p| p.force), worst(&response.stress_pa, &peak))
}

#[test]
fn random_designs_agree_with_the_general_path() {
    let stations: Vec<f64> = (1..=34).map(|i| 17e-3 * f64::from(i) / 34.0).collect();
    let mut solver = CurveSolver::new();
    for accuracy in [1e-3, 1e-5, 1e-8] {
        let mut random = SplitMix(77);
        let (mut general, mut over, mut worst, mut worst_stress, mut all) = (0, 0, 0.0_f64, 0.0_f64, 0);
        let mut ratios = Vec::new();
        for index in 0..150 {
            let network = random_network(&mut random, 3.0, 1.5).expect("mild shapes span their chords");
            let theory = if index % 2 == 0 { Theory::Inextensible } else { Theory::Reissner };
            let settings = Settings { theory, accuracy, ..Settings::default() };
            let exact = trace(&network, &stations, &Settings { accuracy: 1e-9, ..settings }, &mut |_| true).unwrap();
            let response = solver.solve(&network, &stations, &settings).unwrap();
            if !exact.status.is_complete() {
                assert!(response.general, "{index}: a path that ends early is the general path's");
                continue;
            }
            all += 1;
            general += usize::from(response.general);
            let (force, stress) = errors(response, &exact);
            over += usize::from(force > accuracy);
            (worst, worst_stress) = (worst.max(force / accuracy), worst_stress.max(stress / accuracy));
            if !response.general {
                ratios.push(force / response.error_estimate);
                assert_eq!(response.instability, Some(0), "{index}");
            }
        }
        // The accuracy rests on an estimate: it may be exceeded now and then, not by much, and not often.
        assert!(all >= 140 && over <= 3 && worst < 2.0, "{accuracy:e}: {over} of {all}, worst {worst}");
        assert!(general <= 3, "{accuracy:e}: {general} of {all} by the general path");
        ratios.sort_by(f64::total_cmp);
        println!(
            "{accuracy:e}: {all} designs, {general} by the general path, {over} over the accuracy, worst force {worst:.2}, stress {worst_stress:.1} of it; error over estimate: median {:.2}, largest {:.2}",
            ratios[ratios.len() / 2],
            ratios[ratios.len() - 1]
        );
    }
}

#[test]
#[ignore = "a clock"]
fn time_of_curves() {
    let network = table3_by_shapes(POM);
    let stations: Vec<f64> = (1..=34).map(|i| 13.6e-3 * f64::from(i) / 34.0).collect();
    let mut solver = CurveSolver::new();
    for theory in [Theory::Inextensible, Theory::Reissner] {
        for accuracy in accuracies() {
            let settings = Settings { theory, accuracy, ..Settings::default() };
            let mut best = f64::INFINITY;
            for _ in 0..rounds() {
                let start = std::time::Instant::now();
                for _ in 0..200 {
                    std::hint::black_box(solver.solve(&network, &stations, &settings).unwrap());
                }
                best = best.min(start.elapsed().as_secs_f64() / 200.0);
            }
            println!("{theory:?} {accuracy:e}: {:.1} µs", 1e6 * best);
        }
    }
}

fn rounds() -> usize {
    std::env::var("ROUNDS").ok().and_then(|r| r.parse().ok()).unwrap_or(7)
}

fn accuracies() -> Vec<f64> {
    std::env::var("ACCURACY").ok().and_then(|a| a.parse().ok()).map_or_else(|| vec![1e-3, 1e-4, 1e-5, 1e-8], |a| vec![a])
}
