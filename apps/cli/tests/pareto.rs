//! Trade-offs as people and scripts call them: files, exit codes, bad calls.
#![allow(clippy::unwrap_used, reason = "helpers of tests: what is not there fails the test")]

mod common;

use common::{GUIDED, folder_with, listing, run};

/// The guided strip: stress against force.
fn guided(range: &str) -> String {
    format!(
        "{GUIDED}\n[pareto]\nmaximise = [\"force_at_end\"]\nminimise = [\"stress_max\"]\npopulation = 8\ngenerations = 3\n\
         vary = {{ \"design.thickness\" = {{ range = {range} }} }}\n"
    )
}

#[test]
fn every_design_has_its_row_and_files_solve() {
    let folder = folder_with(guided("[\"20 mm\", \"49 mm\"]").as_bytes());
    let found = run(folder.path(), &["pareto", "a.toml", "--out", "out", "--json"]);
    assert_eq!(found.code, Some(0), "{}", found.stderr);
    let document = found.json();
    let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    assert_eq!(read("result.json"), found.stdout);
    assert_eq!([&document["study"], &document["status"]["kind"]], ["pareto", "complete"]);
    let designs = document["designs"].as_array().unwrap();
    // Stress and force both grow with the thickness: every design is a compromise.
    assert_eq!((designs.len(), document["counters"]["evaluations"].as_u64()), (32, Some(32)));
    assert_eq!(listing(&folder.path().join("out")).len(), 24 + 3);
    assert_eq!(read("front.csv").lines().count(), 33);
    let page = read("report.html");
    for (at, design) in designs.iter().enumerate() {
        assert!(page.contains(&format!("href=\"#design-{}\"", at + 1)) && page.contains(&format!("<tr id=\"design-{}\">", at + 1)));
        let Some(file) = design["file"].as_str() else { continue };
        assert!(page.contains(&format!("<a href=\"./{file}\">")) && read(file).contains("# in the plane"));
    }
    let (first, last) = (designs[0]["file"].as_str().unwrap(), designs[31]["file"].as_str().unwrap());
    for (file, design) in [(first, &designs[0]), (last, &designs[31])] {
        let solved = run(folder.path(), &["solve", &format!("out/{file}"), "--json"]);
        assert_eq!(solved.code, Some(0), "{}", solved.stderr);
        assert_eq!(solved.json()["metrics"]["force_at_end"], design["metrics"]["force_at_end"]);
    }
    // Without `--json` the same in words; the seed makes it another search.
    let told = run(folder.path(), &["pareto", "a.toml", "--out", "other", "--seed", "5", "--generations", "1", "--population", "4"]);
    assert_eq!(told.code, Some(0), "{}", told.stderr);
    assert!(told.stdout.contains("8 designs keep every check") && told.stdout.contains("Designs of the front"), "{}", told.stdout);
    told.assert_plain("summary");
}

#[test]
fn exit_codes_tell_how_it_went() {
    let folder = folder_with(guided("[\"60 mm\", \"80 mm\"]").as_bytes());
    let missed = run(folder.path(), &["pareto", "a.toml", "--out", "out"]);
    assert_eq!(missed.code, Some(1), "{}", missed.stderr);
    assert!(missed.stdout.contains("No design keeps every check") && missed.stderr.contains("does not keep every limit"));
    assert_eq!(listing(&folder.path().join("out")), ["a-pareto-001.toml", "front.csv", "report.html", "result.json"]);
    run(folder.path(), &["pareto", "a.toml", "--out", "a.toml"]).assert_refused("a file in the way");
    run(folder.path(), &["pareto", "a.toml"]).assert_refused("no folder");
    run(folder.path(), &["pareto", "none.toml", "--out", "out"]).assert_refused("no file");
    run(folder.path(), &["pareto", "a.toml", "--out", "out", "--population", "2"]).assert_refused("too few");
    std::fs::write(folder.path().join("b.toml"), GUIDED).unwrap();
    let refused = run(folder.path(), &["pareto", "b.toml", "--out", "out", "--json"]);
    refused.assert_refused("no section");
    assert_eq!(refused.json()["diagnostics"][0]["code"], "E0317");
    // A design that cannot be built has no values; if none can, there is nothing to write.
    let nothing = guided("[\"20 mm\", \"49 mm\"]")
        .replace("\"design.thickness\" = { range = [\"20 mm\", \"49 mm\"] }", "\"design.thickness\" = { among = [\"-1 mm\", \"-2 mm\"] }");
    std::fs::write(folder.path().join("c.toml"), nothing).unwrap();
    let none = run(folder.path(), &["pareto", "c.toml", "--out", "nothing"]);
    assert_eq!(none.code, Some(3), "{}\n{}", none.stdout, none.stderr);
    assert!(none.stdout.contains("E0204") && listing(&folder.path().join("nothing")).is_empty(), "{}", none.stdout);
}

/// Ctrl-C ends the search and keeps the front so far.
#[cfg(unix)]
#[test]
fn an_interrupted_search_keeps_its_front() {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};
    let folder = folder_with(guided("[\"20 mm\", \"49 mm\"]").as_bytes());
    let mut child = Command::new(env!("CARGO_BIN_EXE_forcewright"))
        .args(["pareto", "a.toml", "--out", "out", "--population", "1000", "--generations", "10000", "--json"])
        .current_dir(folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    let asked = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(asked.success());
    let started = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        assert!(started.elapsed() < Duration::from_mins(1), "it does not end");
        std::thread::sleep(Duration::from_millis(10));
    };
    assert_eq!(status.code(), Some(130));
    let text = std::fs::read_to_string(folder.path().join("out/result.json")).unwrap();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!([&document["status"]["kind"], &document["stop"]], ["interrupted", "interrupted"]);
    assert!(listing(&folder.path().join("out")).len() > 4);
}
