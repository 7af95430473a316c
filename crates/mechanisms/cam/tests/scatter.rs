//! Errors of making and assembly as numbers that scatter: profiles drawn anew for every design, tilt.

use forcewright_base::diagnostics::Diagnostics;
use forcewright_base::maths;
use forcewright_cam::{Cam, Design, ProfileInfluence};
use forcewright_contract::family::{Entry, Family as _, Mechanism as _};
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;
use forcewright_study::tolerance::{Plan, Study, study};

const EXAMPLE: &str = include_str!("../../../../examples/cam/no-undercut.toml");

/// The example whose other numbers do not scatter.
fn with(rest: &str) -> String {
    let plain = EXAMPLE.replace(" ± 0.01 mm", "").replace(" ± 0.005 N/mm", "").replace(" ± 0.2 mm", "");
    assert!(!plain.contains('±'));
    format!("{plain}\n{rest}")
}

fn design(text: &str) -> Design {
    let mut project = Project::from_text("a.toml", text, &Choices::default());
    let mut spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    Cam::resolve(&mut spec, &mut project.diagnostics).and_then(forcewright_cam::Kind::slider).expect("a slider")
}

fn drawn(text: &str, samples: u64, seed: u64) -> Study {
    let mut project = Project::from_text("a.toml", text, &Choices::default());
    let understood = Entry::<Cam>::new().understand(&mut project).unwrap_or_else(|| panic!("{:?}", project.diagnostics.in_file_order()));
    let mut said = Diagnostics::default();
    let tolerance = &understood.studies().tolerance;
    let scattering = tolerance.scattering(understood.numbers(), project.root, &mut said).unwrap_or_else(|| panic!("{said:?}"));
    let evaluator = understood.evaluator(&scattering.free, &mut said).unwrap_or_else(|| panic!("{said:?}"));
    let plan = Plan { sensitivity_points: 0, ..Plan::new(scattering.population, samples, seed, 0.9) };
    study(&*evaluator, &plan, &mut |_| true).expect("a nominal design")
}

/// A seed that scatters draws another profile for every design: the force over its travel scatters as the derivatives of the force by
/// value and slope of the error say, without draws. The same study gives the same bits, another one other draws.
#[test]
fn every_design_has_a_profile_of_its_own() {
    let random = "[errors.random_profile]\ndeviation = \"10 µm\"\ncorrelation_length = \"10.5 mm\"\nseed = \"5000 ± 4999\"\n[tolerance]\ndistribution = \"uniform\"\n";
    let text = with(random);
    let found = drawn(&text, 2048, 1);
    let flawless = design(&with(""));
    let force = found.outputs.iter().position(|o| o.name == "force").expect("an output");
    let travels = &found.stations[force];
    let mechanism = flawless.mechanism(&flawless.cut().expect("a cam"));
    let influence = ProfileInfluence::new(&mechanism, travels).expect("assembles");
    let expected: Vec<f64> = influence.deviations_n(10e-6, 10.5e-3).map(|d| d[0]).collect();
    let first = found.outputs[force].values.start;
    let mut ratios = 0.0;
    for (i, expected) in expected.iter().enumerate() {
        let station = found.fan.station(first + i);
        // 2048 draws know a deviation to 1.6 %: five times that.
        assert!((station.sd / expected - 1.0).abs() < 0.08, "{} m: {} N, expected {expected}", travels[i], station.sd);
        assert!((station.mean - 50.0).abs() < 5.0 * expected / 2048.0_f64.sqrt() + 1e-3 * 50.0, "{}", station.mean);
        ratios += station.sd / expected;
    }
    assert!((ratios / expected.len() as f64 - 1.0).abs() < 0.03, "{ratios}");
    let bits = |study: &Study| (0..study.fan.stations()).map(|i| study.fan.station(i).mean.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&found), bits(&drawn(&text, 2048, 1)));
    assert_ne!(bits(&found), bits(&drawn(&text, 2048, 2)));
}

/// Tilt scatters too. The force up rises evenly with its size, so that the part below the largest force at one standard deviation is
/// that of a normal distribution: erf(1/√2).
#[test]
fn tilt_scatters() {
    let at = |tilt: &str, limit: f64| {
        let limits = format!("undercut_travel = {{ max = \"0 mm\" }}, force_up_max = {{ max = \"{limit} N\" }}");
        let text = with(&format!("[errors]\ntilt = \"{tilt}\"")).replacen("undercut_travel = { max = \"0 mm\" }", &limits, 1);
        text.replacen("force = { nominal = \"50 N\", band = \"2.5 %\" }\n", "", 1)
    };
    let mut project = Project::from_text("a.toml", &at("0.6 deg", 100.0), &Choices::default());
    let understood = Entry::<Cam>::new().understand(&mut project).expect("understood");
    let limit = understood.analyse(&mut |_| true).outcome.metric("force_up_max").expect("a force").value;
    let found = drawn(&at("0 deg ± 1.8 deg", limit), 4096, 3);
    let expected = 1.0 - maths::erfc(0.5_f64.sqrt());
    let estimate = found.all.estimate.value;
    assert!((estimate - expected).abs() < 0.01, "{estimate}, expected {expected}");
}
