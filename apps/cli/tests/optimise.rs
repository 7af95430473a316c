//! Searches as people and scripts call them: closed forms, the file that comes out, interruption, errors.
#![allow(clippy::unwrap_used, reason = "helpers of tests: what is not there fails the test")]

mod common;

use std::io::Read as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use common::{GUIDED, assert_near, folder_with, listing, number, run};
use forcewright::base::maths;

/// Young's modulus, length, depth and deflection of it, SI.
const E_L_D_TRAVEL: [f64; 4] = [200e9, 0.1, 0.01, 1e-4];

fn optimise(folder: &Path, extra: &[&str]) -> common::Run {
    run(folder, &[&["optimise", "a.toml", "--out", "out"], extra].concat())
}

fn cube(x: f64) -> f64 {
    x * x * x
}

#[test]
fn the_stress_limit_gives_the_thickness_of_the_closed_form() {
    let folder = folder_with(GUIDED.as_bytes());
    let found = optimise(folder.path(), &["--json"]);
    assert_eq!(found.code, Some(0), "{}", found.stderr);
    let document = found.json();
    let study = &document["study"];
    let [e, l, d, travel] = E_L_D_TRAVEL;
    let margin = number(&study["margin"]);
    assert!(margin < 1e-3, "{margin}");
    let thickness = (1.0 - margin) * 300e6 * l * l / (3.0 * e * travel);
    let force = e * d * cube(thickness) * travel / cube(l);
    assert_near(number(&study["variables"][0]["after"]), thickness, 1e-5, "thickness");
    assert_near(number(&study["goal"]["after"]), force, 3e-5, "force");
    assert_near(number(&study["goal"]["before"]), e * d * cube(0.0005) * travel / cube(l), 1e-4, "force before");
    // F ∝ w³ ∝ σ³: one per cent more stress is three per cent more force.
    assert_near(number(&study["active"][0]["one_percent"]), 0.03 * force, 1e-3, "what one per cent buys");
    assert_eq!([&study["active"][0]["key"], &study["stop"]], ["requirements.stress", "converged"]);
    assert_eq!(listing(&folder.path().join("out")), ["a-optimised.toml", "report.html", "result.json"]);
    let written = std::fs::read_to_string(folder.path().join("out/result.json")).unwrap();
    assert_eq!(written, found.stdout);
    // The new file is the old one but for the number, and gives the same result by itself.
    let text = std::fs::read_to_string(folder.path().join("out/a-optimised.toml")).unwrap();
    let changed: Vec<_> = GUIDED.lines().zip(text.lines()).filter(|(old, new)| old != new).collect();
    assert_eq!((changed.len(), GUIDED.lines().count()), (1, text.lines().count()));
    assert!(changed[0].1.starts_with("thickness = \"49.99") || changed[0].1.starts_with("thickness = \"50"), "{}", changed[0].1);
    assert!(changed[0].1.ends_with(" mm\"   # in the plane"), "{}", changed[0].1);
    let solved = run(folder.path(), &["solve", "out/a-optimised.toml", "--json"]);
    assert_eq!(solved.code, Some(0), "{}", solved.stderr);
    assert_eq!([&solved.json()["metrics"], &solved.json()["input_sha256"]], [&document["metrics"], &document["input_sha256"]]);
}

#[test]
fn the_force_asked_for_gives_the_thickness_of_the_closed_form() {
    let least = GUIDED
        .replace("{ maximise = \"force_at_end\" }", "{ minimise = \"stress_max\" }")
        .replace("stress = { safety_factor = 2 }       # keep", "limits.force_at_end = { min = \"2 N\" }");
    let folder = folder_with(least.as_bytes());
    let found = optimise(folder.path(), &[]);
    assert_eq!(found.code, Some(0), "{}{}", found.stderr, found.stdout);
    for words in ["All 3 are met by the full analysis", "Limits: force at the end", "requirements.limits.force_at_end", "stress_max"] {
        assert!(found.stdout.contains(words), "{words}: {}", found.stdout);
    }
    let [e, l, d, travel] = E_L_D_TRAVEL;
    let document: serde_json::Value = serde_json::from_slice(&std::fs::read(folder.path().join("out/result.json")).unwrap()).unwrap();
    let margin = number(&document["study"]["margin"]);
    assert!(margin < 1e-3, "{margin}");
    let thickness = maths::powf((1.0 + margin) * 2.0 * cube(l) / (e * d * travel), 1.0 / 3.0);
    assert_near(number(&document["study"]["variables"][0]["after"]), thickness, 1e-5, "thickness");
    assert_near(number(&document["study"]["goal"]["after"]), 3.0 * e * thickness * travel / (l * l), 3e-5, "stress");
    // σ ∝ w ∝ ∛F: one per cent less force is a third of a per cent less stress.
    let buys = number(&document["study"]["active"][0]["one_percent"]) / number(&document["study"]["goal"]["after"]);
    assert_near(buys, -0.01 / 3.0, 2e-3, "what one per cent buys");
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    for words in ["Search for a better design", "before and after", "force at the end", "What varied"] {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn the_end_of_a_range_limits_it_too() {
    let folder = folder_with(GUIDED.replace("\"80 mm\"", "\"2 mm\"").as_bytes());
    let document = optimise(folder.path(), &["--json"]).json();
    let variable = &document["study"]["variables"][0];
    assert_eq!([&variable["at"], &document["study"]["active"][0]["key"]], ["upper", "design.thickness"]);
    assert!((number(&variable["after"]) - 0.002).abs() < 1e-12, "{variable}");
}

#[test]
fn limits_that_contradict_each_other_are_named_and_the_best_effort_is_written() {
    let both = GUIDED.replace("[material]", "limits.force_at_end = { min = \"30 kN\" }\n\n[material]");
    let folder = folder_with(both.as_bytes());
    let found = optimise(folder.path(), &[]);
    assert_eq!(found.code, Some(1), "{}{}", found.stderr, found.stdout);
    assert!(
        found.stdout.contains("No design was found that keeps every limit") && found.stderr.contains("does not meet all"),
        "{}",
        found.stdout
    );
    assert!(listing(&folder.path().join("out")).contains(&"a-optimised.toml".to_owned()));
    assert_eq!(run(folder.path(), &["solve", "out/a-optimised.toml"]).code, Some(1));
}

#[test]
fn threads_do_not_change_a_byte() {
    let folder = folder_with(GUIDED.as_bytes());
    let with = |threads: &str| {
        let ended = Command::new(env!("CARGO_BIN_EXE_forcewright"))
            .args(["optimise", "a.toml", "--out", "out", "--starts", "6", "--seed", "7"])
            .env("RAYON_NUM_THREADS", threads)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let files = ["a-optimised.toml", "report.html", "result.json"];
        (ended.status.code(), ended.stdout, files.map(|name| std::fs::read(folder.path().join("out").join(name)).unwrap()))
    };
    let (one, two) = (with("1"), with("2"));
    assert!(one.0 == Some(0) && one == two);
    assert!(String::from_utf8_lossy(&one.1).contains("6 of 6 starts led to designs that keep every limit: 1 design"));
}

#[test]
fn the_new_file_stands_elsewhere_with_what_was_set() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::create_dir_all(at.join("projects/bases")).unwrap();
    std::fs::write(at.join("projects/bases/base.toml"), GUIDED).unwrap();
    let child = "extends = \"bases/base.toml\" # from there\ntitle = \"child\"\n[variants.long]\nload.travel = \"0.2 mm\"\n";
    std::fs::write(at.join("projects/child.toml"), child).unwrap();
    let call =
        ["optimise", "projects/child.toml", "--out", "results/new", "--variant", "long", "--set", "requirements.stress={safety_factor=4}"];
    let found = run(at, &[&call[..], &["--set", "design.thickness=1mm", "--json"]].concat());
    assert_eq!(found.code, Some(0), "{}", found.stderr);
    let variable = &found.json()["study"]["variables"][0];
    assert_eq!(variable["before"], 0.001);
    // A quarter of the thickness without both: twice the travel, half the stress.
    let margin = number(&found.json()["study"]["margin"]);
    assert!(margin < 1e-3, "{margin}");
    assert_near(number(&variable["after"]), 0.0125 * (1.0 - margin), 1e-5, "thickness");
    let text = std::fs::read_to_string(at.join("results/new/child-optimised.toml")).unwrap();
    assert!(text.starts_with("extends = \"../../projects/bases/base.toml\" # from there\n"), "{text}");
    let solved = run(at, &["solve", "results/new/child-optimised.toml", "--variant", "long", "--json"]);
    assert_eq!(solved.json()["metrics"], found.json()["metrics"]);
}

#[cfg(unix)]
#[test]
fn interrupted_it_keeps_the_best_so_far() {
    let folder = folder_with(include_bytes!("../../../examples/compliant/optimise-lan-box.toml"));
    let mut child = Command::new(env!("CARGO_BIN_EXE_forcewright"))
        .args(["optimise", "a.toml", "--out", "out", "--starts", "100000"])
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = Vec::new();
    let mut stream = child.stderr.take().unwrap();
    while !String::from_utf8_lossy(&said).contains("starts: 100000\n") {
        let mut byte = [0];
        assert_eq!(stream.read(&mut byte).unwrap(), 1, "{}", String::from_utf8_lossy(&said));
        said.push(byte[0]);
    }
    std::thread::sleep(Duration::from_millis(700));
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    stream.read_to_end(&mut said).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{}", String::from_utf8_lossy(&said));
    assert_eq!(listing(&folder.path().join("out")), ["a-optimised.toml", "report.html", "result.json"]);
    let document: serde_json::Value = serde_json::from_slice(&std::fs::read(folder.path().join("out/result.json")).unwrap()).unwrap();
    assert_eq!(document["study"]["interrupted"], true);
    assert_eq!(run(folder.path(), &["check", "out/a-optimised.toml"]).code, Some(0));
}

#[test]
fn what_cannot_be_searched_is_refused_with_its_place() {
    for (from, to, code, help) in [
        ("[optimise]\n", "[optimisse]\n", "E0301", "did you mean"),
        ("force_at_end\" }", "force_at_edn\" }", "E0315", "did you mean `force_at_end`?"),
        ("\"design.thickness\" =", "\"design.thicknes\" =", "E0312", "did you mean `design.thickness`?"),
        ("\"0.2 mm\", \"80 mm\"", "\"1 mm\", \"80 mm\"", "E0204", "the search starts at the value in the file"),
        ("\"0.2 mm\", \"80 mm\"", "\"3 mm\", \"1 mm\"", "E0204", "range = [\"low\", \"high\"]"),
        ("{ range = [\"0.2 mm\", \"80 mm\"] }", "{}", "E0302", "give either `range"),
        ("maximise = \"force_at_end\"", "maximise = \"stress_max\"", "E0315", "`minimise = \"stress_max\"`"),
        ("\"0.2 mm\", \"80 mm\"", "\"0.2 N\", \"80 mm\"", "E0201", ""),
    ] {
        assert!(GUIDED.contains(from), "{from}");
        let folder = folder_with(GUIDED.replace(from, to).as_bytes());
        let refused = optimise(folder.path(), &["--json"]);
        assert_eq!(refused.code, Some(2), "{to}: {}", refused.stderr);
        refused.assert_refused(to);
        assert!(refused.stderr.contains(&format!("error[{code}]")) && refused.stderr.contains(help), "{to}: {}", refused.stderr);
        assert!(refused.json()["diagnostics"][0]["line"].as_u64().is_some_and(|line| line > 5), "{to}: {}", refused.stdout);
        assert_eq!(listing(folder.path()), ["a.toml"], "{to}");
    }
    let none = folder_with(common::EXAMPLE.as_bytes());
    let refused = optimise(none.path(), &[]);
    assert!(refused.code == Some(2) && refused.stderr.contains("error[E0317]: there is no `[optimise]`"), "{}", refused.stderr);
    let without = run(none.path(), &["optimise", "a.toml"]);
    assert!(without.code == Some(2) && without.stderr.contains("--out <DIR>"), "{}", without.stderr);
    let missing = run(none.path(), &["optimise", "none.toml", "--out", "out"]);
    assert_eq!(missing.code, Some(4), "{}", missing.stderr);
    let folder = folder_with(GUIDED.as_bytes());
    let blocked = run(folder.path(), &["optimise", "a.toml", "--out", "a.toml/deeper"]);
    assert!(blocked.code == Some(4) && blocked.stderr.contains("error[E0120]"), "{}", blocked.stderr);
}
