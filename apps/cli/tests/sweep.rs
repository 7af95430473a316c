//! Sweeps as people and scripts call them: killed, interrupted, divided, piped.
#![allow(clippy::unwrap_used, reason = "helpers of tests: what is not there fails the test")]

mod common;

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use common::{folder, folder_with, listing, run};

/// Solved in a moment.
const CANTILEVER: &str = include_str!("../../../examples/compliant/cantilever.toml");

fn sweep(folder: &Path, extra: &[&str]) -> common::Run {
    let mut arguments = vec!["sweep", "a.toml"];
    arguments.extend(extra);
    run(folder, &arguments)
}

fn spawn(folder: &Path, arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_forcewright"))
        .args(["sweep", "a.toml"])
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Waits until the part has so many lines, or the program has ended; gives the lines.
fn wait_for_lines(child: &mut Child, part: &Path, lines: usize) -> usize {
    let started = Instant::now();
    loop {
        let found = String::from_utf8_lossy(&std::fs::read(part).unwrap_or_default()).matches('\n').count();
        if found >= lines || child.try_wait().unwrap().is_some() {
            return found;
        }
        assert!(started.elapsed() < Duration::from_secs(20), "nothing is written");
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn killed_again_and_again_it_ends_with_the_same_files() {
    let call = ["--vary", "load.travel=1mm..5mm:60", "--metrics", "force_at_end,stress_max", "--out", "t.csv", "--format", "csv,npy"];
    let whole = folder_with(CANTILEVER.as_bytes());
    let uninterrupted = sweep(whole.path(), &call);
    assert_eq!(uninterrupted.code, Some(0), "{}", uninterrupted.stderr);
    assert_eq!(listing(whole.path()), ["a.toml", "t.csv", "t.json", "t.npy"]);
    let killed = folder_with(CANTILEVER.as_bytes());
    let part = killed.path().join("t.part");
    let (mut lines, mut kills) = (0, 0);
    loop {
        let mut child = spawn(killed.path(), &call);
        // Some die before the first row, some after several.
        lines = wait_for_lines(&mut child, &part, lines + 1 + 5 * (kills % 3));
        child.kill().unwrap();
        if child.wait().unwrap().success() {
            break;
        }
        kills += 1;
        if kills % 4 == 0 {
            // In the middle of a line, wherever that is.
            let bytes = std::fs::read(&part).unwrap_or_default();
            std::fs::write(&part, &bytes[..bytes.len() - bytes.len().min(20)]).unwrap();
        }
        assert!(kills < 200, "it does not go on");
    }
    assert!(kills >= 3, "killed {kills} times");
    assert_eq!(listing(killed.path()), ["a.toml", "t.csv", "t.json", "t.npy"]);
    for name in ["t.csv", "t.json", "t.npy"] {
        assert!(std::fs::read(whole.path().join(name)).unwrap() == std::fs::read(killed.path().join(name)).unwrap(), "{name}");
    }
    // The same rows on standard output, on one thread.
    let printed = sweep(whole.path(), &["--threads", "1", "--vary", call[1], "--metrics", call[3]]);
    assert_eq!(printed.stdout.as_bytes(), std::fs::read(whole.path().join("t.csv")).unwrap());
    // Once more: nothing is left to do.
    let again = sweep(whole.path(), &call);
    assert!(again.code == Some(0) && again.stderr.contains("complete already") && again.stdout == uninterrupted.stdout, "{}", again.stderr);
}

#[cfg(unix)]
#[test]
fn interrupted_it_keeps_its_rows_and_says_so() {
    let folder = folder();
    let mut child = spawn(folder.path(), &["--vary", "design.thickness=0.8mm..1.2mm:5000", "--out", "t.csv"]);
    let part = folder.path().join("t.part");
    wait_for_lines(&mut child, &part, 4);
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(130));
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert!(said.contains("interrupted: ") && said.contains("of 5000 rows are kept in t.part"), "{said}");
    let text = std::fs::read_to_string(&part).unwrap();
    let kept = text.lines().count() - 2;
    assert!(kept >= 2 && text.ends_with("\r\n") && said.contains(&format!("interrupted: {kept} of 5000")), "{said}");
    assert_eq!(listing(folder.path()), ["a.toml", "t.part"]);
}

#[test]
fn parts_of_several_machines_are_joined() {
    let call = ["--vary", "load.travel=1mm..5mm:7", "--vary", "model.beam=reissner,inextensible"];
    let folder = folder_with(CANTILEVER.as_bytes());
    let at = folder.path();
    let with = |extra: &[&str]| sweep(at, &[&call[..], extra].concat());
    for shard in ["1/3", "2/3", "3/3"] {
        let part = with(&["--out", "t.csv", "--shard", shard, "--threads", "2"]);
        assert!(part.code == Some(0) && part.stderr.contains("forcewright merge"), "{}", part.stderr);
    }
    let too_few = run(at, &["merge", "t.csv", "t.1-of-3.part", "t.3-of-3.part"]);
    assert!(too_few.code == Some(2) && too_few.stderr.contains("error[E0134]"), "{}", too_few.stderr);
    let merged = run(at, &["merge", "t.csv", "t.3-of-3.part", "t.1-of-3.part", "t.2-of-3.part", "--format", "csv,npy"]);
    assert_eq!(merged.code, Some(0), "{}", merged.stderr);
    let whole = with(&["--out", "whole", "--format", "npy,csv", "--threads", "1"]);
    assert_eq!(whole.stdout, merged.stdout);
    for ending in ["csv", "npy", "json"] {
        let read = |name: &str| std::fs::read(at.join(name)).unwrap();
        assert!(read(&format!("t.{ending}")) == read(&format!("whole/sweep.{ending}")), "{ending}");
    }
    // The name of the output says what is wanted.
    let array = with(&["--out", "array.npy"]);
    assert!(array.code == Some(0) && !at.join("array.csv").exists(), "{}", array.stderr);
    assert!(std::fs::read(at.join("array.npy")).unwrap() == std::fs::read(at.join("t.npy")).unwrap());
    let missing = run(at, &["merge", "t.csv", "none.part"]);
    assert!(missing.code == Some(4) && missing.stderr.contains("error[E0101]: `none.part` cannot be read"), "{}", missing.stderr);
}

#[test]
fn exit_codes_say_how_it_went() {
    let folder = folder();
    let with = |extra: &[&str]| sweep(folder.path(), &[extra, &["--metrics", "force_at_end"]].concat());
    for (vary, code) in [
        ("design.thickness=1mm,2mm", 0),
        ("design.thickness=1.5mm,2mm", 1),
        ("design.thickness=0.8N,2mm", 2),
        ("design.thickness=1mm..2mm:0", 2),
        ("load.travel=70mm,80mm", 3),
    ] {
        let run = with(&[
            "--vary",
            vary,
            "--set",
            "model.beam=inextensible",
            "--set",
            if code == 3 { "load.direction=[0, 1]" } else { "title=t" },
        ]);
        assert_eq!(run.code, Some(code), "{vary}: {}{}", run.stderr, run.stdout);
        if code == 2 {
            run.assert_refused(vary);
        }
    }
    for out in ["a.toml/deeper", "/proc/none"] {
        let run = with(&["--vary", "design.thickness=1mm,2mm", "--out", out]);
        assert!(run.code == Some(4) && run.stderr.contains("error[E0120]"), "{out}: {}", run.stderr);
    }
    assert_eq!(listing(folder.path()), ["a.toml"]);
    assert_eq!(sweep(folder.path(), &[]).code, Some(2), "nothing is varied");
    assert_eq!(run(folder.path(), &["sweep", "none.toml", "--vary", "design.depth=1mm,2mm"]).code, Some(4));
}

#[test]
fn one_document_on_standard_output() {
    let folder = folder();
    let call = ["--vary", "design.thickness=1mm,-1mm", "--metrics", "stress_max,force_at_end", "--json"];
    let document = sweep(folder.path(), &call).json();
    assert_eq!(document["status"]["kind"], "complete");
    assert_eq!([&document["designs"], &document["counts"]["met"], &document["counts"]["status"]["refused"]], [2, 1, 1]);
    let rows = document["rows"].as_array().unwrap();
    assert_eq!([&rows[0]["status"], &rows[1]["status"]], ["complete", "refused"]);
    assert_eq!(rows[0]["design.thickness"], 0.001);
    let solved = run(folder.path(), &["solve", "a.toml", "--json"]).json();
    assert_eq!(rows[0]["force_at_end"], solved["metrics"]["force_at_end"]["value"]);
    let names: Vec<&str> = document["columns"].as_array().unwrap().iter().filter_map(|c| c["name"].as_str()).collect();
    let metrics = names.iter().position(|n| *n == "stress_max").unwrap();
    assert_eq!(names[metrics + 1], "force_at_end", "in the order asked for");
    // With files, the rows are there and not here.
    let filed = sweep(folder.path(), &[&call[..], &["--out", "t.csv"]].concat()).json();
    assert!(filed["rows"].is_null() && filed["fingerprint"] == document["fingerprint"], "{filed}");
    for bad in ["design.thickness=1mm..1mm:3", "design.thicknes=1mm,2mm"] {
        let refused = sweep(folder.path(), &["--vary", bad, "--json"]);
        assert_eq!(refused.code, Some(2));
        assert_eq!(refused.json()["status"]["kind"], "refused");
        refused.assert_refused(bad);
    }
    let misspelt = sweep(folder.path(), &["--vary", "design.thickness=1mm,2mm", "--metrics", "force_at_edn", "--out", "u.csv"]);
    assert!(misspelt.code == Some(2) && misspelt.stderr.contains("did you mean `force_at_end`?"), "{}", misspelt.stderr);
    assert_eq!(listing(folder.path()), ["a.toml", "t.csv", "t.json"]);
    let other = sweep(folder.path(), &["--vary", "design.thickness=1mm,2mm", "--out", "t.csv"]);
    assert!(other.code == Some(2) && other.stderr.contains("error[E0132]") && other.stderr.contains("--force"), "{}", other.stderr);
}
