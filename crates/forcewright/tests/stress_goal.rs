//! Stress as a goal and as a limit, of a strip whose law is known: at a given displacement its stress is proportional to its thickness.

use std::path::Path;

use forcewright::{Choices, DiskFiles, Loaded, Optimised};

fn search(text: &str) -> Optimised {
    let loaded = Loaded::from_text("strip.toml", text, &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    loaded.optimise(&DiskFiles, Path::new("strip.toml"), (None, None), &|_| true).map_err(|e| e.render(false)).expect("posed")
}

fn strip(direction: &str, limits: &str, objective: &str) -> String {
    let text = forcewright::gallery::find("cantilever").expect("in the gallery").text;
    let text = text.replace("stiffness =", "# stiffness =").replace("direction = [0, -1]", &format!("direction = {direction}"));
    let text = text.replace("stress = { safety_factor = 2 }", limits);
    format!(
        "{text}\n[model]\nbeam = \"inextensible\"\n[optimise]\nobjective = {objective}\n\
         variables = {{ \"design.thickness\" = {{ range = [\"0.2 mm\", \"3 mm\"] }} }}\n"
    )
}

/// Whichever face is pulled, the thinnest strip has the least stress.
#[test]
fn the_largest_stress_is_of_either_sign() {
    for direction in ["[0, -1]", "[0, 1]"] {
        for objective in ["{ minimise = \"stress_max\" }", "{ maximise = \"safety_factor\" }"] {
            let found = search(&strip(direction, "", objective));
            let best = found.best.expect("a design");
            assert!((best.x[0] - 0.2e-3).abs() < 1e-9, "{direction} {objective}: {} m", best.x[0]);
        }
    }
}

/// A limit on the metric is kept as the requirement is.
#[test]
fn a_limit_by_the_name_of_the_metric_is_kept_too() {
    let objective = "{ maximise = \"force_at_end\" }";
    let thickness = |limits: &str| {
        let found = search(&strip("[0, -1]", limits, objective));
        assert!(found.after.as_ref().is_some_and(|r| r.outcome.requirements_met()), "{limits}");
        found.best.expect("a design").x[0]
    };
    let [by_name, by_factor] = ["limits.stress_max = { max = \"300 MPa\" }", "limits.safety_factor = { min = 2 }"].map(thickness);
    let by_requirement = [thickness("stress = { max = \"300 MPa\" }"), thickness("stress = { safety_factor = 2 }")];
    assert!((by_name / by_requirement[0] - 1.0).abs() < 1e-4 && (by_factor / by_requirement[1] - 1.0).abs() < 1e-4);
}
