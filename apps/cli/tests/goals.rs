//! Searches for the least mass and for a measured curve, against closed forms, with data beside the project.
#![allow(clippy::unwrap_used, reason = "helpers of tests: what is not there fails the test")]

mod common;

use common::{assert_near, folder_with, number, run};
use forcewright::base::maths;

/// A strip clamped at one end and kept parallel at the other: with small deflections F = 12EIδ/L³ and σ = 6E(w/2)δ/L².
const STRIP: &str = r#"schema = 1
mechanism = "compliant"
title = "A guided strip"
[requirements]
stress = { safety_factor = 20 }
limits.force_at_end = { min = "5 N" }
[material]
young_modulus = "200 GPa"
yield_stress = "600 MPa"
density = "7850 kg/m^3"
[design]
thickness = "4 mm"
depth = "10 mm"
[design.nodes]
a = { at = ["0 mm", "0 mm"], support = "clamped" }
b = { at = ["100 mm", "0 mm"], support = "parallel" }
[[design.beams]]
name = "strip"
between = ["a", "b"]
straight = true
[load]
node = "b"
direction = [0, 1]
travel = "0.1 mm"
[model]
beam = "inextensible"
[optimise]
objective = { minimise = "mass" }
[optimise.variables]
"design.thickness" = { range = ["0.2 mm", "20 mm"] }
"design.depth" = { range = ["1 mm", "20 mm"] }
"#;

#[test]
fn the_least_mass_is_that_of_the_closed_form() {
    let folder = folder_with(STRIP.as_bytes());
    let found = run(folder.path(), &["optimise", "a.toml", "--out", "out", "--json"]);
    assert_eq!(found.code, Some(0), "{}", found.stderr);
    let study = &found.json()["study"];
    // Stiffness grows with the cube of the thickness: as thick as the stress allows, and as deep as the force needs.
    let margin = number(&study["margin"]);
    assert!(margin < 1e-3, "{margin}");
    let thickness = (1.0 - margin) * 5e-3;
    let depth = (1.0 + margin) * 5.0 * 1e-3 / (200e9 * thickness * thickness * thickness * 1e-4);
    assert_near(number(&study["variables"][0]["after"]), thickness, 1e-5, "thickness");
    assert_near(number(&study["variables"][1]["after"]), depth, 3e-5, "depth");
    let goal = &study["goal"];
    assert_eq!([&goal["name"], &goal["sense"], &goal["unit"]], ["mass", "minimise", "kg"]);
    assert_near(number(&goal["before"]), 7850.0 * 0.1 * 4e-3 * 10e-3, 1e-12, "mass before");
    assert_near(number(&goal["after"]), 7850.0 * 0.1 * thickness * depth, 3e-5, "mass after");
    assert_near(number(&found.json()["metrics"]["mass"]["value"]), number(&goal["after"]), 1e-6, "the metric");
    // m ∝ F/σ²: one per cent less force is one per cent less mass, one per cent more stress two.
    let buys = |key: &str| {
        let all = study["active"].as_array().unwrap();
        number(&all.iter().find(|a| a["key"] == key).unwrap_or_else(|| panic!("{key}: {all:?}"))["one_percent"]) / number(&goal["after"])
    };
    assert_near(buys("requirements.limits.force_at_end"), -0.01, 1e-2, "force");
    assert_near(buys("requirements.stress"), -0.02, 3e-2, "stress");
    // People are shown grams.
    let shown = run(folder.path(), &["optimise", "a.toml", "--out", "out"]).stdout;
    assert!(shown.contains("`mass` as small as possible: 31.4 g before, 7.85 g after"), "{shown}");
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(page.contains("mass") && page.contains("7.85"), "no mass in the report");
}

#[test]
fn a_measured_curve_is_found_from_the_folder_of_the_new_file_too() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::create_dir_all(at.join("projects/data")).unwrap();
    let text = STRIP
        .replace("limits.force_at_end = { min = \"5 N\" }\n", "")
        .replace("{ minimise = \"mass\" }", "{ minimise = \"force_target\", target_file = \"data/wanted.csv\" } # bench")
        .replace("\"design.depth\" = { range = [\"1 mm\", \"20 mm\"] }\n", "");
    std::fs::write(at.join("projects/a.toml"), &text).unwrap();
    // A linear spring of 25 N/mm.
    std::fs::write(at.join("projects/data/wanted.csv"), "# bench\ntravel / mm; force / N\n0; 0\n0.05; 1.25\n0.1; 2.5\n").unwrap();
    let found = run(at, &["optimise", "projects/a.toml", "--out", "results/new", "--json"]);
    assert_eq!(found.code, Some(0), "{}", found.stderr);
    // F = E d w³ δ/L³.
    let wanted = maths::powf(2.5 * 1e-3 / (200e9 * 10e-3 * 1e-4), 1.0 / 3.0);
    assert_near(number(&found.json()["study"]["variables"][0]["after"]), wanted, 1e-4, "thickness");
    let written = std::fs::read_to_string(at.join("results/new/a-optimised.toml")).unwrap();
    assert!(written.contains("target_file = \"../../projects/data/wanted.csv\" } # bench"), "{written}");
    let solved = run(at, &["solve", "results/new/a-optimised.toml", "--json"]);
    assert_eq!([&solved.json()["metrics"], &solved.json()["input_sha256"]], [&found.json()["metrics"], &found.json()["input_sha256"]]);
    // From there the search goes on, and a setting names data beside the first file.
    let again = run(at, &["optimise", "results/new/a-optimised.toml", "--out", "results/newer", "--json"]);
    assert_eq!(again.code, Some(0), "{}", again.stderr);
    assert_near(number(&again.json()["study"]["variables"][0]["after"]), wanted, 1e-4, "thickness again");
    std::fs::write(at.join("projects/half.csv"), "travel / mm, force / N\n0.1, 1.25\n").unwrap();
    let set = ["optimise", "projects/a.toml", "--out", "results/set", "--json", "--set", "optimise.objective.target_file=half.csv"];
    let set = run(at, &set);
    assert_eq!(set.code, Some(0), "{}", set.stderr);
    assert_near(number(&set.json()["study"]["variables"][0]["after"]), wanted * maths::powf(0.5, 1.0 / 3.0), 1e-4, "half the force");
    let written = std::fs::read_to_string(at.join("results/set/a-optimised.toml")).unwrap();
    assert!(written.contains("\"../../projects/half.csv\""), "{written}");
}

#[test]
fn data_that_are_missing_or_broken_are_refused_with_their_place() {
    let text = STRIP.replace("{ minimise = \"mass\" }", "{ minimise = \"force_target\", target_file = \"wanted.csv\" }");
    let folder = folder_with(text.as_bytes());
    let call = ["optimise", "a.toml", "--out", "out"];
    let missing = run(folder.path(), &call);
    assert_eq!(missing.code, Some(4), "{}", missing.stderr);
    assert!(
        missing.stderr.contains("error[E0101]: `wanted.csv` does not exist") && missing.stderr.contains("a.toml:28:56"),
        "{}",
        missing.stderr
    );
    for (csv, code, place) in [
        ("travel / mm, force / N\n0.05, 1\n0.05, 2\n", "E0204", "wanted.csv:3:1"),
        ("travel / mm, force / N\n0.05, 1\n0.2, 2\n", "E0204", "wanted.csv:3:1"),
        ("travel / mm, force / N\n0.05, 1\n0.1, ?\n", "E0202", "wanted.csv:3:6"),
        ("travel; force / N\n0.05; 1\n", "E0208", "wanted.csv:1:1"),
        ("travel / mm\n0.05\n", "E0112", "wanted.csv:1:1"),
    ] {
        std::fs::write(folder.path().join("wanted.csv"), csv).unwrap();
        let refused = run(folder.path(), &call);
        assert_eq!(refused.code, Some(2), "{csv}: {}", refused.stderr);
        assert!(refused.stderr.contains(&format!("error[{code}]")) && refused.stderr.contains(place), "{csv}: {}", refused.stderr);
        assert!(refused.stderr.contains("help"), "{csv}: {}", refused.stderr);
    }
}
