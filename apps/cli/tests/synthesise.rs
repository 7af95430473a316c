//! `forcewright synthesise` as a program: what it writes, what it says, its exit codes.

mod common;

use std::fs;

use common::run;

const ASKED: &str = r#"
schema = 1
mechanism = "compliant"
title = "Polishing head"
[requirements]
force = { nominal = "10 N", band = "5 %" }
travel = "6 mm"
stress = { safety_factor = 1.5 }
[material]
use = "POM-C"
[synthesise]
room = ["120 mm", "80 mm"]
thickness_min = "0.6 mm"
candidates = 2
"#;

#[test]
fn what_it_writes_is_met_by_solve() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("head.toml"), ASKED).unwrap();
    let made = run(folder.path(), &["synthesise", "head.toml", "--out", "out"]);
    assert_eq!(made.code, Some(0), "{}{}", made.stdout, made.stderr);
    assert!(made.stdout.contains("meet every requirement") || made.stdout.contains("meets every requirement"), "{}", made.stdout);
    made.assert_plain("synthesise");
    let names: Vec<String> =
        fs::read_dir(folder.path().join("out")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    assert!(names.iter().any(|n| n == "report.html") && names.iter().any(|n| n == "result.json"), "{names:?}");
    let designs: Vec<&String> = names.iter().filter(|n| n.starts_with("head-")).collect();
    assert!(!designs.is_empty() && designs.len() <= 2, "{names:?}");
    for name in designs {
        let solved = run(folder.path(), &["solve", &format!("out/{name}")]);
        assert_eq!(solved.code, Some(0), "{name}: {}", solved.stdout);
    }
}

#[test]
fn what_blocks_is_said_with_exit_code_1() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("head.toml"), ASKED).unwrap();
    let call = ["synthesise", "head.toml", "--out", "out", "--json", "--set", "synthesise.room=[\"40 mm\", \"30 mm\"]"];
    let made = run(folder.path(), &call);
    assert_eq!(made.code, Some(1), "{}", made.stderr);
    let document = made.json();
    assert_eq!(document["study"]["met"], false);
    let keys: Vec<&str> = document["study"]["would_do"].as_array().unwrap().iter().filter_map(|w| w["key"].as_str()).collect();
    assert!(keys.contains(&"synthesise.room"), "{keys:?}");
}

#[test]
fn wrong_inputs_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("head.toml"), ASKED).unwrap();
    for (call, code) in [
        (vec!["synthesise", "head.toml"], 2),
        (vec!["synthesise", "none.toml", "--out", "out"], 4),
        (vec!["synthesise", "head.toml", "--out", "out", "--set", "synthesise.thickness_min=\"0.6 N\""], 2),
        (vec!["synthesise", "head.toml", "--out", "out", "--variant", "thin"], 2),
        (vec!["synthesise", "head.toml", "--out", "head.toml/below"], 4),
    ] {
        let made = run(folder.path(), &call);
        made.assert_refused(&call.join(" "));
        assert_eq!(made.code, Some(code), "{call:?}: {}", made.stderr);
    }
}
