//! The work that users of compliant mechanisms wait for: `cargo bench -p forcewright-benchmarks`.

use divan::{Bencher, black_box};
use forcewright::compliant::{Behaviour, Compliant, Design, Spec, measure};
use forcewright::contract::family::Mechanism;
use forcewright::contract::project::Project;
use forcewright::contract::read;
use forcewright::{Choices, Loaded, ToleranceChoices, gallery};
use forcewright_beam::{
    Axis, BatchSolver, CurveSolver, Derivatives, Network, Output, Parameter, Settings, Shape, Support, Theory, Variant, trace,
};

fn main() {
    divan::main();
}

fn text() -> &'static str {
    gallery::find("compliant/lan-table3").expect("in the gallery").text
}

fn design() -> Design {
    let mut project = Project::from_text("lan-table3.toml", text(), &Choices::default());
    let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    Compliant::resolve(&mut spec, &mut project.diagnostics).expect("the example is understood")
}

/// Relative errors asked for: screening, optimisation, reports.
const ACCURACIES: [f64; 3] = [1e-3, 1e-5, 1e-8];

/// Force, stiffness and stress of the four beams of Table 3 from rest to 13.6 mm, from a cold start.
fn path(bencher: Bencher<'_, '_>, stations: u32, theory: Theory, accuracy: f64) {
    let design = design();
    let last = stations - 1;
    let stations: Vec<f64> = (0..stations).map(|i| 13.6e-3 * f64::from(i) / f64::from(last)).collect();
    let settings = Settings { theory, accuracy, ..Settings::default() };
    bencher.bench_local(|| {
        let path = trace(black_box(&design.network), &stations, &settings, &mut |_| true).expect("a network");
        path.points.iter().filter_map(forcewright_beam::Point::peak_stress).map(|(_, peak)| peak.stress_pa).fold(0.0, f64::max)
    });
}

#[divan::bench(args = ACCURACIES, sample_count = 50)]
fn inextensible_34_stations(bencher: Bencher<'_, '_>, accuracy: f64) {
    path(bencher, 34, Theory::Inextensible, accuracy);
}

#[divan::bench(args = ACCURACIES, sample_count = 50)]
fn inextensible_137_stations(bencher: Bencher<'_, '_>, accuracy: f64) {
    path(bencher, 137, Theory::Inextensible, accuracy);
}

#[divan::bench(args = ACCURACIES, sample_count = 50)]
fn reissner_34_stations(bencher: Bencher<'_, '_>, accuracy: f64) {
    path(bencher, 34, Theory::Reissner, accuracy);
}

#[divan::bench(args = ACCURACIES, sample_count = 50)]
fn reissner_137_stations(bencher: Bencher<'_, '_>, accuracy: f64) {
    path(bencher, 137, Theory::Reissner, accuracy);
}

/// The same 34 displacements by the fast curve solver: force, stiffness, largest stress.
fn curve(bencher: Bencher<'_, '_>, theory: Theory, accuracy: f64) {
    let design = design();
    let stations: Vec<f64> = (0..34).map(|i| 13.6e-3 * f64::from(i) / 33.0).collect();
    let settings = Settings { theory, accuracy, ..Settings::default() };
    let mut solver = CurveSolver::new();
    bencher.bench_local(|| solver.solve(black_box(&design.network), &stations, &settings).map(|r| r.force_n[33]));
}

#[divan::bench(args = ACCURACIES, sample_count = 200)]
fn fast_inextensible_34_stations(bencher: Bencher<'_, '_>, accuracy: f64) {
    curve(bencher, Theory::Inextensible, accuracy);
}

#[divan::bench(args = ACCURACIES, sample_count = 200)]
fn fast_reissner_34_stations(bencher: Bencher<'_, '_>, accuracy: f64) {
    curve(bencher, Theory::Reissner, accuracy);
}

/// The same curve at 1e-3 with the gradient of the force by 13 parameters: two nodes, both bends of four beams, the thickness.
#[divan::bench(args = [Theory::Inextensible, Theory::Reissner], sample_count = 200)]
fn fast_gradient_34x13(bencher: Bencher<'_, '_>, theory: Theory) {
    let design = design();
    let stations: Vec<f64> = (0..34).map(|i| 13.6e-3 * f64::from(i) / 33.0).collect();
    let settings = Settings { theory, accuracy: 1e-3, ..Settings::default() };
    let parameters = parameters();
    let mut solver = CurveSolver::new();
    bencher.bench_local(|| {
        solver.solve_with_gradient(black_box(&design.network), &stations, &settings, &parameters).map(|r| r.force_gradient.len())
    });
}

/// What a design moves: two nodes, the thickness, both bends of four beams.
fn parameters() -> Vec<Parameter> {
    let mut parameters = vec![Parameter::NodeX(2), Parameter::NodeY(2), Parameter::NodeX(3), Parameter::NodeY(3), Parameter::AllThickness];
    parameters.extend((0..4).flat_map(|beam| [1, 2].map(|k| Parameter::Bend { beam, k })));
    parameters
}

/// What an optimiser asks of a design, at 1e-5: the force at 34 stations, and at three displacements force, stiffness, the largest stress
/// of four beams and the places of their middles, all with their derivatives by 13 parameters.
#[divan::bench(args = [Theory::Inextensible, Theory::Reissner], sample_count = 200)]
fn fast_states_3x13(bencher: Bencher<'_, '_>, theory: Theory) {
    let design = design();
    let stations: Vec<f64> = (0..34).map(|i| 13.6e-3 * f64::from(i) / 33.0).collect();
    let settings = Settings { theory, accuracy: 1e-5, ..Settings::default() };
    let mut outputs = vec![Output::Force, Output::Stiffness];
    outputs.extend((0..4).map(|beam| Output::PeakStress { beam: Some(beam) }));
    outputs.extend((0..4).flat_map(|beam| [Axis::X, Axis::Y].map(|axis| Output::Position { beam, u: 0.5, axis })));
    let (parameters, mut solver, mut derivatives) = (parameters(), CurveSolver::new(), Derivatives::default());
    bencher.bench_local(|| {
        let network = black_box(&design.network);
        let states = solver.solve_with_states(network, &stations, &settings, &parameters, &[4e-3, 8e-3, 13e-3]);
        let mut states = states.expect("a network");
        for state in 0..states.count() {
            states.derivatives(state, &outputs, &mut derivatives).expect("they exist");
        }
        derivatives.by_parameter[0]
    });
}

/// A hundred different designs at 1e-4, one after another: inner nodes within 2 mm and bends within 0.5 rad of the example's.
#[divan::bench(sample_count = 30)]
fn batch_1e4(bencher: Bencher<'_, '_>) {
    let design = design();
    let stations: Vec<f64> = (0..34).map(|i| 13.6e-3 * f64::from(i) / 33.0).collect();
    let settings = Settings { theory: Theory::Inextensible, accuracy: 1e-4, ..Settings::default() };
    let networks: Vec<Network> = (0..100).map(|index| variant(&design.network, index)).collect();
    let mut solver = CurveSolver::new();
    bencher.counter(divan::counter::ItemsCount::new(networks.len())).bench_local(|| {
        let force = |n: &Network| solver.solve(black_box(n), &stations, &settings).map_or(0.0, |r| r.force_n[33] + r.stress_pa[33]);
        networks.iter().map(force).sum::<f64>()
    });
}

/// The same hundred designs side by side, from networks that are there.
#[divan::bench(sample_count = 30)]
fn batch_1e4_side_by_side(bencher: Bencher<'_, '_>) {
    let design = design();
    let stations: Vec<f64> = (0..34).map(|i| 13.6e-3 * f64::from(i) / 33.0).collect();
    let settings = Settings { theory: Theory::Inextensible, accuracy: 1e-4, ..Settings::default() };
    let networks: Vec<Network> = (0..100).map(|index| variant(&design.network, index)).collect();
    let mut solver = BatchSolver::new();
    bencher.counter(divan::counter::ItemsCount::new(networks.len())).bench_local(|| {
        let mut sum = 0.0;
        solver.solve(black_box(&networks), &stations, &settings, |_, r| sum += r.map_or(0.0, |r| r.force_n[33] + r.stress_pa[33]));
        sum
    });
}

/// The same from their numbers: nodes and bends in, force, stiffness and stress at 34 stations out.
#[divan::bench(sample_count = 30)]
fn batch_1e4_from_numbers(bencher: Bencher<'_, '_>) {
    let design = design();
    let stations: Vec<f64> = (0..34).map(|i| 13.6e-3 * f64::from(i) / 33.0).collect();
    let settings = Settings { theory: Theory::Inextensible, accuracy: 1e-4, ..Settings::default() };
    let variants: Vec<Variant> = (0..100).map(|index| Variant::of(&variant(&design.network, index))).collect();
    let mut solver = BatchSolver::new();
    bencher.counter(divan::counter::ItemsCount::new(variants.len())).bench_local(|| {
        let mut sum = 0.0;
        let set = |index: usize, numbers: &mut Variant| numbers.clone_from(&black_box(&variants)[index]);
        let sink = |_: usize, r: Result<&forcewright_beam::Response, _>| sum += r.map_or(0.0, |r| r.force_n[33] + r.stress_pa[33]);
        solver.solve_variants(&design.network, variants.len(), set, &stations, &settings, sink);
        sum
    });
}

/// A whole tolerance study of 4096 designs of Table 3 at 1e-4 whose nodes, bends and thickness scatter: draws, curves, stress, measures,
/// counts and causes; the column of items is designs per second. What a study costs whatever its size is in it.
#[divan::bench(sample_count = 5)]
fn tolerance_4096(bencher: Bencher<'_, '_>) {
    const SCATTER: &str = r#"
[tolerance.parameters]
"design.nodes.*.at" = { half_width = "0.05 mm" }
"design.beams.*.bend" = { half_width = 0.01 }
"#;
    let set = vec!["model.beam=inextensible".to_owned(), "model.accuracy=1e-4".to_owned()];
    let project = Loaded::from_text("lan-table3.toml", &format!("{}{SCATTER}", text()), &Choices { variant: None, set });
    let project = project.unwrap_or_else(|refused| panic!("{}", refused.render(false)));
    let choices = ToleranceChoices { samples: Some(4096), ..ToleranceChoices::default() };
    bencher.counter(divan::counter::ItemsCount::new(4096_usize)).bench_local(|| {
        let found = project.tolerance(choices, &mut |_| true).unwrap_or_else(|error| panic!("{error}"));
        found.study.all.estimate.value
    });
}

/// A network with its free nodes and bends moved by amounts spread evenly over their ranges (additive recurrence with the golden ratio).
fn variant(network: &Network, index: u32) -> Network {
    let mut new = network.clone();
    let mut count = f64::from(index) * 17.0;
    let mut amount = |range: f64| {
        count += 1.0;
        range * (2.0 * (0.618_033_988_749_895 * count).fract() - 1.0)
    };
    for node in new.nodes.iter_mut().filter(|n| n.support == Support::Free) {
        node.position_m = node.position_m.map(|x| x + amount(2e-3));
    }
    for beam in &mut new.beams {
        let ([x, y], [from_x, from_y]) = (new.nodes[beam.end].position_m, new.nodes[beam.start].position_m);
        let bends: Vec<f64> = beam.shape.angle_rad()[1..].iter().map(|c| c + amount(0.5)).collect();
        beam.shape = Shape::from_chord([x - from_x, y - from_y], &bends).expect("mild bends span their chords");
    }
    new
}

/// Path at the stations of a report, with the refinement of the interpolation.
#[divan::bench(sample_count = 50)]
fn behaviour(bencher: Bencher<'_, '_>) {
    let design = design();
    bencher.bench_local(|| Behaviour::of(black_box(&design), &mut |_| true).expect("a network"));
}

/// The metrics of a behaviour: intervals, extrema, the largest stress between stations.
#[divan::bench(sample_count = 50)]
fn metrics(bencher: Bencher<'_, '_>) {
    let design = design();
    let behaviour = Behaviour::of(&design, &mut |_| true).expect("a network");
    bencher.bench_local(|| measure(&design, black_box(&behaviour)));
}

/// The page of a result that is there.
#[divan::bench(sample_count = 50)]
fn page(bencher: Bencher<'_, '_>) {
    let loaded = Loaded::from_text("lan-table3.toml", text(), &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    let report = loaded.solve("lan-table3.toml", "", &mut |_| true);
    bencher.bench_local(|| forcewright::report::html::page(black_box(&report)));
}

/// From the text of a project file to a design.
#[divan::bench]
fn read_and_resolve() -> Design {
    black_box(design())
}

/// Everything that `forcewright solve` does but writing files: reading, solving, checking, the page.
#[divan::bench(sample_count = 30)]
fn solve_with_report() -> String {
    let loaded =
        Loaded::from_text("lan-table3.toml", black_box(text()), &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    let report = loaded.solve("lan-table3.toml", "", &mut |_| true);
    forcewright::report::html::page(&report)
}

/// Searches in the paper's box, the first from straight beams, the others spread over the ranges: one, and 64 on all processors.
#[divan::bench(args = [1, 64], sample_count = 3, sample_size = 1)]
fn search_starts(bencher: Bencher<'_, '_>, starts: usize) {
    let text = gallery::find("optimise-lan-box").expect("in the gallery").text;
    let loaded = Loaded::from_text("box.toml", text, &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    let (task, _) = loaded.task().map_err(|e| e.render(false)).expect("a task");
    let settings = forcewright::study::optimise::Settings { starts, seed: 3, ..Default::default() };
    bencher.bench_local(|| forcewright::study::optimise::search(&task, black_box(&settings), &|_| true));
}
