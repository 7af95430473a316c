#![allow(clippy::unwrap_used, reason = "a test that fails")]

use forcewright_base::diagnostics::Diagnostics;
use forcewright_contract::family::Mechanism;
use forcewright_contract::numbers::numbers_of;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;
use forcewright_study::sampling::{Distribution, Population, Sobol, normal};
use forcewright_study::tolerance::{Plan, study};

use super::*;
use crate::{Compliant, Spec};
use forcewright_contract::studies::Free;

const EXAMPLE: &str = include_str!("../../../../../../examples/compliant/lan-table3.toml");

/// The example with settings, for a study of some of its numbers.
fn evaluator(set: &[&str], paths: &[&str]) -> Box<dyn Evaluator> {
    let choices = Choices { variant: None, set: set.iter().map(|s| (*s).to_owned()).collect() };
    let mut project = Project::from_text("test.toml", EXAMPLE, &choices);
    let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    let design = Compliant::resolve(&mut spec, &mut project.diagnostics).unwrap();
    let numbers = numbers_of(&mut spec);
    let free: Vec<Free> = paths
        .iter()
        .map(|path| {
            let number = numbers.iter().find(|n| n.path == *path).unwrap().clone();
            Free { lower: number.range.min, upper: number.range.max, number }
        })
        .collect();
    Compliant::evaluator(&spec, &design, &free, &mut Diagnostics::default()).unwrap()
}

const PATHS: [&str; 6] = [
    "material.young_modulus",
    "design.thickness",
    "design.depth",
    "design.nodes.n3.at.x",
    "design.nodes.n4.at.y",
    "design.beams.b1.bend.2",
];

/// Designs spread around the nominal one; the last cannot be built.
fn spread(evaluator: &dyn Evaluator, count: u64) -> Vec<f64> {
    let n = evaluator.variables().len();
    let sobol = Sobol::scrambled(n, 3).unwrap();
    let mut all = Vec::new();
    let mut point = vec![0.0; n];
    for i in 0..count {
        sobol.point(i, &mut point);
        all.extend(point.iter().zip(evaluator.variables()).map(|(u, v)| v.nominal * (1.0 + 0.04 * (u - 0.5))));
    }
    all
}

fn together(evaluator: &dyn Evaluator, designs: &[f64]) -> Vec<Result<Vec<f64>, String>> {
    let mut all = Vec::new();
    evaluator.evaluate_all(designs, &mut evaluator.workspace(), &mut |index, found| {
        assert_eq!(index, all.len());
        all.push(found.map(|e| e.values.clone()).map_err(|f| f.reason.clone()));
    });
    all
}

/// Side by side or one after the other: the same curves up to the accuracy of both, and in any company the same bits.
#[test]
fn many_designs_at_once_are_the_same_designs() {
    for beam in ["inextensible", "reissner"] {
        let set = format!("model.beam={beam}");
        let evaluator = evaluator(&[&set], &PATHS);
        let mut designs = spread(&*evaluator, 11);
        // Of no thickness: it fails by itself, and nothing beside it does.
        designs[6 * 4 + 1] = -1e-3;
        let all = together(&*evaluator, &designs);
        assert_eq!(all.len(), 11);
        let mut workspace = evaluator.workspace();
        let mut own = Evaluation::default();
        for (index, (found, x)) in all.iter().zip(designs.chunks_exact(6)).enumerate() {
            let alone = evaluator.evaluate(x, false, &mut own, &mut workspace);
            assert_eq!((found.is_ok(), alone.is_ok()), (index != 4, index != 4), "{index}: {found:?} {alone:?}");
            let Ok(found) = found else { continue };
            for (output, tolerance) in [(0, 4e-5), (1, 1e-3), (2, 4e-4)] {
                let range = output * STATIONS..(output + 1) * STATIONS;
                let (a, b) = (&found[range.clone()], &own.values[range]);
                let largest = b.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
                let off = a.iter().zip(b).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / largest;
                assert!(off < tolerance, "{beam} design {index} output {output}: {off}");
            }
        }
        for size in [1, 2, 3, 7] {
            let chunked: Vec<_> = designs.chunks(6 * size).flat_map(|chunk| together(&*evaluator, chunk)).collect();
            assert!(chunked == all, "{beam} in chunks of {size}");
        }
    }
}

/// The accuracy that a file gives holds for every design, alone and side by side; the default of a single design does not.
#[test]
fn designs_are_as_accurate_as_the_file_asks() {
    let curves = |set: &[&str]| {
        let evaluator = evaluator(&[&["model.beam=inextensible"], set].concat(), &["design.thickness"]);
        let mut alone = Evaluation::default();
        evaluator.evaluate(&[1.01e-3], false, &mut alone, &mut evaluator.workspace()).unwrap();
        [together(&*evaluator, &[1.01e-3]).remove(0).unwrap(), alone.values]
    };
    let [exact, _] = curves(&["model.accuracy=1e-9"]);
    let error = |values: &[f64]| {
        let largest = exact[..STATIONS].iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        exact[..STATIONS].iter().zip(values).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / largest
    };
    for accuracy in [1e-3, 1e-4, 1e-6] {
        let [together, alone] = curves(&[&format!("model.accuracy={accuracy}")]);
        assert!(error(&together) < accuracy && error(&alone) < accuracy, "{accuracy}: {:e} {:e}", error(&together), error(&alone));
        // Not more is done than was asked for.
        assert!(error(&together) > 1e-3 * accuracy, "{accuracy}: {:e}", error(&together));
    }
    assert_eq!(curves(&[]), [curves(&["model.accuracy=3e-5"])[0].clone(), curves(&["model.accuracy=1e-5"])[1].clone()]);
}

/// A limit on the force at the end where only the depth scatters, and what must come out.
struct ByDepth {
    evaluator: Box<dyn Evaluator>,
    force_n: f64,
    /// Probabilities of a depth below those that make the least and the largest force.
    levels: [f64; 2],
}

const DEPTH_M: f64 = 10e-3;
const SD_M: f64 = 0.2e-3;

impl ByDepth {
    /// The force is proportional to the depth: it keeps a band around its nominal value exactly as often as the normal distribution of
    /// the depth says.
    fn new() -> Self {
        let nominal = 9.746;
        let (low, high) = (0.98 * nominal, 1.01 * nominal);
        let limits = format!("requirements.limits.force_at_end={{ min = \"{low} N\", max = \"{high} N\" }}");
        let evaluator = evaluator(&[&limits], &["design.depth"]);
        let (mut out, mut workspace) = (Evaluation::default(), evaluator.workspace());
        evaluator.evaluate(&[DEPTH_M], false, &mut out, &mut workspace).unwrap();
        let force_n = out.values[STATIONS - 1];
        let levels = [low, high].map(|limit| normal::cdf((limit / force_n - 1.0) * DEPTH_M / SD_M));
        Self { evaluator, force_n, levels }
    }

    fn truth(&self) -> f64 {
        self.levels[1] - self.levels[0]
    }

    fn study(&self, samples: u64, seed: u64, target: f64) -> forcewright_study::tolerance::Study {
        let population = Population::independent(vec![Distribution::normal(DEPTH_M, SD_M).unwrap()]);
        let plan = Plan { linear_samples: samples, sensitivity_points: 0, ..Plan::new(population, samples, seed, target) };
        study(&*self.evaluator, &plan, &mut |_| true).unwrap()
    }

    /// Standard deviation of the sampled yield. Each of the 16 replicates has one point in each of its equal cells, anywhere in it:
    /// only the two cells with a limit inside add to the scatter, by a coin each.
    fn sd(&self, samples: u64) -> f64 {
        let cells = samples as f64 / 16.0;
        let coin = |level: &f64| (level * cells).fract() * (1.0 - (level * cells).fract());
        (self.levels.iter().map(coin).sum::<f64>() / 16.0).sqrt() / cells
    }

    fn end(study: &forcewright_study::tolerance::Study) -> usize {
        study.measures.iter().position(|m| m.name == "force_at_end").unwrap()
    }
}

/// Force wrong by as much as designs may be moves the yield by this much at most: both limits, by the largest density.
const BY_ACCURACY: f64 = 2.0 * 0.4 * (TOGETHER + ACCURACY) * DEPTH_M / SD_M;

/// Over many seeds the sampled yield is right on average, scatters as its closed form says, and its interval holds as often as promised.
#[test]
fn yield_of_a_depth_that_scatters_is_unbiased_over_seeds() {
    let case = ByDepth::new();
    let (samples, seeds) = (1024, 32_u32);
    let (truth, sd) = (case.truth(), case.sd(samples));
    let (mut sum, mut squares, mut covered) = (0.0, 0.0, 0);
    for seed in 0..seeds {
        // Needed tolerances are found at once where so little is asked for.
        let found = case.study(samples, u64::from(seed) + 100, 0.01);
        let estimate = found.kept.iter().find(|k| k.measure == ByDepth::end(&found)).unwrap().found.estimate;
        let error = estimate.value - truth;
        assert!(error.abs() < 5.0 * sd + BY_ACCURACY, "seed {seed}: {error:e}, {sd:e}");
        (sum, squares) = (sum + error, squares + error * error);
        covered += u32::from(estimate.interval.contains(truth));
    }
    let n = f64::from(seeds);
    println!("mean error {:e}, scatter {:e} of {sd:e}, {covered} of {seeds} covered", sum / n, (squares / n).sqrt());
    // Four standard errors of the mean; three of the scatter, whose own is 1/√2n.
    assert!((sum / n).abs() < 4.0 * sd / n.sqrt() + BY_ACCURACY, "{:e}", sum / n);
    assert!(((squares / n).sqrt() / sd - 1.0).abs() < 3.0 / (2.0 * n).sqrt() + 0.1, "{:e} {sd:e}", (squares / n).sqrt());
    // Of 32 intervals of 95 %, fewer than 27 hold with a probability of 0.6 %.
    assert!(covered >= 27, "{covered}");
}

/// The sampled yield, the linearised one, and all that is told beside them, where only the depth scatters.
#[test]
fn yield_of_a_depth_that_scatters_has_a_closed_form() {
    let case = ByDepth::new();
    let (truth, force_n) = (case.truth(), case.force_n);
    let found = case.study(4096, 6, 0.9);
    let end = ByDepth::end(&found);
    let linear = found.linear.as_ref().unwrap();
    for kept in [&found.kept, &linear.kept] {
        let found = &kept.iter().find(|k| k.measure == end).unwrap().found;
        assert!((found.estimate.value - truth).abs() < 4.0 * case.sd(4096) + BY_ACCURACY, "{truth} {found:?}");
        assert!(found.estimate.interval.contains(truth), "{truth} {found:?}");
    }
    assert!(found.failures.is_empty() && !found.linear_is_off());
    // The standard deviation of every force is that of the depth.
    let station = found.fan.station(STATIONS - 1);
    assert!((station.sd / station.mean / (SD_M / DEPTH_M) - 1.0).abs() < 1e-2);
    // Three standard deviations of the depth are six per cent of the force.
    let bar = &found.tornado[0];
    let place = found.limiting.iter().position(|m| *m == end).unwrap();
    assert!((bar.reach(place, Some(force_n)) / force_n - 0.12).abs() < 1e-4);
}
