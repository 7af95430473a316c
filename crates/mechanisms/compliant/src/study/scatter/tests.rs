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

/// The force is proportional to the depth. With nothing but the depth scattering, the force at the end keeps a band around its nominal
/// value exactly as often as the normal distribution of the depth says, sampled as well as linearised.
#[test]
fn yield_of_a_depth_that_scatters_has_a_closed_form() {
    let (depth, sd) = (10e-3, 0.2e-3);
    let nominal = 9.746;
    let (low, high) = (0.98 * nominal, 1.01 * nominal);
    let limits = format!("requirements.limits.force_at_end={{ min = \"{low} N\", max = \"{high} N\" }}");
    let evaluator = evaluator(&[&limits], &["design.depth"]);
    let (mut out, mut workspace) = (Evaluation::default(), evaluator.workspace());
    evaluator.evaluate(&[depth], false, &mut out, &mut workspace).unwrap();
    let force_n = out.values[STATIONS - 1];
    let truth = normal::between((low / force_n - 1.0) * depth / sd, (high / force_n - 1.0) * depth / sd);
    let population = Population::independent(vec![Distribution::normal(depth, sd).unwrap()]);
    let plan = Plan { linear_samples: 4096, sensitivity_points: 0, ..Plan::new(population, 4096, 6, 0.9) };
    let found = study(&*evaluator, &plan, &mut |_| true).unwrap();
    let end = found.measures.iter().position(|m| m.name == "force_at_end").unwrap();
    let linear = found.linear.as_ref().unwrap();
    for kept in [&found.kept, &linear.kept] {
        let found = &kept.iter().find(|k| k.measure == end).unwrap().found;
        assert!((found.estimate.value - truth).abs() < 4e-3 && found.estimate.interval.contains(truth), "{truth} {found:?}");
    }
    assert!(found.failures.is_empty() && !found.linear_is_off());
    // The standard deviation of every force is that of the depth.
    let station = found.fan.station(STATIONS - 1);
    assert!((station.sd / station.mean / (sd / depth) - 1.0).abs() < 1e-2);
    // Three standard deviations of the depth are six per cent of the force.
    let bar = &found.tornado[0];
    let place = found.limiting.iter().position(|m| *m == end).unwrap();
    assert!((bar.reach(place, Some(force_n)) / force_n - 0.12).abs() < 1e-4);
}
