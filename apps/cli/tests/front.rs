//! Fronts as people and scripts call them: files, threads, bad calls.
#![allow(clippy::unwrap_used, reason = "helpers of tests: what is not there fails the test")]

mod common;

use std::process::Command;

use common::{GUIDED, folder_with, listing, run};

/// The guided strip, whose limits are kept with next to no reserve.
fn guided() -> String {
    format!("{GUIDED}{MARGIN}\n")
}

const MARGIN: &str = "margin = \"0.01 %\"";

const FILES: [&str; 6] = ["a-front-01.toml", "a-front-02.toml", "a-front-03.toml", "front.csv", "report.html", "result.json"];

#[test]
fn every_point_has_its_file_and_solves() {
    let folder = folder_with(guided().as_bytes());
    let found =
        run(folder.path(), &["optimise", "a.toml", "--front", "requirements.stress.safety_factor=4..8:3", "--out", "out", "--json"]);
    assert_eq!(found.code, Some(0), "{}", found.stderr);
    assert_eq!(listing(&folder.path().join("out")), FILES);
    let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    assert_eq!(read("result.json"), found.stdout);
    let document = found.json();
    assert_eq!([&document["study"], &document["goal"]["sense"]], ["front", "maximise"]);
    assert_eq!(document["monotone"], true);
    for (name, point) in FILES.iter().zip(document["points"].as_array().unwrap()) {
        assert_eq!([&point["file"], &point["requirements"]], [*name, "met"]);
        let text = read(name);
        assert!(
            text.contains(&format!("{} }}       # keep", point["typed"].as_str().unwrap())) && text.contains("# in the plane"),
            "{text}"
        );
        let solved = run(folder.path(), &["solve", &format!("out/{name}"), "--json"]);
        assert_eq!(solved.code, Some(0), "{}", solved.stderr);
        assert_eq!(solved.json()["metrics"]["force_at_end"], point["metrics"]["force_at_end"]);
    }
    let page = read("report.html");
    for words in ["Trade-off front", "What limits the points", "Monotone", "id=\"figure-front\"", "id=\"figure-shape-last\"", "--front"] {
        assert!(page.contains(words), "{words}");
    }
    assert_eq!(read("front.csv").lines().count(), 4);
}

#[test]
fn threads_do_not_change_a_byte() {
    let folder = folder_with(guided().as_bytes());
    let with = |threads: &str| {
        let ended = Command::new(env!("CARGO_BIN_EXE_forcewright"))
            .args(["optimise", "a.toml", "--out", "out", "--starts", "4", "--front", "requirements.stress.safety_factor=8,6,4"])
            .env("RAYON_NUM_THREADS", threads)
            .current_dir(folder.path())
            .output()
            .unwrap();
        (ended.status.code(), ended.stdout, FILES.map(|name| std::fs::read(folder.path().join("out").join(name)).unwrap()))
    };
    let (one, two) = (with("1"), with("3"));
    assert!(one.0 == Some(0) && one == two);
}

/// The scatter of making and the reserve of limits work at every point.
#[test]
fn limits_are_kept_against_scatter_at_every_point() {
    let text = guided().replace("\"0.5 mm\"", "\"0.5 mm ± 0.05 mm\"").replace(MARGIN, "robust = \"worst_case\"");
    let folder = folder_with(text.as_bytes());
    let found = run(folder.path(), &["optimise", "a.toml", "--front", "requirements.stress.safety_factor=4,8", "--out", "out", "--json"]);
    assert_eq!(found.code, Some(0), "{}", found.stderr);
    for point in found.json()["points"].as_array().unwrap() {
        assert_eq!(point["search"]["robust"]["settled"], true, "{point}");
    }
}

#[test]
fn bad_calls_are_refused_and_leave_nothing() {
    let folder = folder_with(guided().as_bytes());
    for (front, code, words) in [
        ("requirements.stress.safety_factr=1..2:3", "E0301", "did you mean"),
        ("requirements.stress.safety_factor=sobol(1..2)", "E0130", "a front needs numbers"),
        ("requirements.stress.safety_factor=low,high", "E0130", "a front needs numbers"),
        ("requirements.stress.safety_factor=1..2", "E0130", "`--front requirements"),
        ("requirements.stress.safety_factor", "E0130", "it has no `=`"),
        ("requirements.stress.safety_factor=1mm,2mm", "E0201", ""),
        ("material.use=1,2", "E02", ""),
        ("requirements.stress.safety_factor=1..2:100000000", "E0130", "at most 1000 points"),
        ("design.thickness=1mm,2mm", "E0130", "the search changes it"),
    ] {
        let refused = run(folder.path(), &["optimise", "a.toml", "--front", front, "--out", "out", "--json"]);
        assert_eq!(refused.code, Some(2), "{front}: {}", refused.stderr);
        refused.assert_refused(front);
        assert!(refused.stderr.contains(&format!("error[{code}")) && refused.stderr.contains(words), "{front}: {}", refused.stderr);
        let said = refused.json()["diagnostics"].as_array().cloned().unwrap_or_default();
        assert!(said.iter().any(|d| d["code"].as_str().is_some_and(|c| c.starts_with(code))), "{front}: {}", refused.stdout);
        assert_eq!(listing(folder.path()), ["a.toml"], "{front}");
    }
    let none = folder_with(common::EXAMPLE.as_bytes());
    let refused = run(none.path(), &["optimise", "a.toml", "--front", "requirements.stress.safety_factor=1,2", "--out", "out"]);
    assert!(refused.code == Some(2) && refused.stderr.contains("error[E0317]: there is no `[optimise]`"), "{}", refused.stderr);
    let blocked = run(folder.path(), &["optimise", "a.toml", "--front", "requirements.stress.safety_factor=1,2", "--out", "a.toml/deeper"]);
    assert!(blocked.code == Some(4) && blocked.stderr.contains("error[E0120]"), "{}", blocked.stderr);
}
