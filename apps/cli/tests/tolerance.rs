//! `forcewright tolerance` as its users meet it.

#![allow(clippy::unwrap_used, reason = "a test that cannot run its program fails")]

mod common;

use common::{EXAMPLE, Run, run};

/// Runs a study of the example after an edit of its text.
fn study(folder: &tempfile::TempDir, text: &str, arguments: &[&str]) -> Run {
    std::fs::write(folder.path().join("a.toml"), text).unwrap();
    let mut all = vec!["tolerance", "a.toml"];
    all.extend(arguments);
    run(folder.path(), &all)
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

/// Both files are written and say the same as what is printed; the same call gives the same bytes; the exit code follows the target.
#[test]
fn a_study_ends_with_its_files_and_its_verdict() {
    let folder = folder();
    let first = study(&folder, EXAMPLE, &["--samples", "64", "--json", "--out", "out", "--set", "tolerance.target=0.5"]);
    assert_eq!(first.code, Some(0), "{}", first.stderr);
    let document = first.json();
    let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    assert_eq!(serde_json::from_str::<serde_json::Value>(&read("result.json")).unwrap(), document);
    assert_eq!(document["samples"], 64);
    assert_eq!(document["parameters"][0]["path"], "design.thickness");
    // ± is three standard deviations.
    assert!((document["parameters"][0]["sd"].as_f64().unwrap() - 0.02e-3 / 3.0).abs() < 1e-12);
    let page = read("report.html");
    for words in
        ["Tolerance study", "force_deviation", "design.thickness", "Sobol indices", "id=\"figure-force\"", "id=\"figure-tornado-1\""]
    {
        assert!(page.contains(words), "{words}");
    }
    let again = study(&folder, EXAMPLE, &["--samples", "64", "--json", "--set", "tolerance.target=0.5"]);
    assert_eq!(again.json()["measures"], document["measures"]);
    let missed = study(&folder, EXAMPLE, &["--samples", "64", "--set", "tolerance.target=0.999"]);
    assert_eq!(missed.code, Some(1), "{}", missed.stderr);
    assert!(missed.stdout.contains("misses the target of 99.9 %") && missed.stdout.contains("design.thickness"), "{}", missed.stdout);
}

/// Every refusal has its code, its place, and a way out.
#[test]
fn what_cannot_be_studied_is_refused_with_its_code() {
    let folder = folder();
    let plain = EXAMPLE.replace("1 mm ± 0.02 mm", "1 mm");
    let with = |section: &str| format!("{EXAMPLE}\n[tolerance]\n{section}\n");
    let plain_with = |section: &str| format!("{plain}\n[tolerance]\n{section}\n");
    let depth = "parameters = { \"design.depth\" = { half_width = \"0.1 mm\" } }";
    let cases = [
        ("E0319", plain.clone()),
        ("E0321", with("parameters = { \"design.depth\" = {} }")),
        ("E0321", with("parameters = { \"design.depth\" = { half_width = \"-1 mm\" } }")),
        ("E0201", with("parameters = { \"design.depth\" = { half_width = \"1 N\" } }")),
        ("E0312", with("parameters = { \"design.deep\" = { half_width = \"1 mm\" } }")),
        ("E0312", with("parameters = { \"requirements.travel\" = { half_width = \"1 mm\" } }")),
        ("E0322", with("groups = { sheet = { members = [\"design.thickness\", \"design.depth\"], correlation = 0.5 } }")),
        ("E0322", with("groups = { sheet = { members = [\"design.thickness\"], correlation = 0.5 } }")),
        (
            "E0322",
            with(&format!(
                "{depth}\n[tolerance.groups]\na = {{ members = [\"design.thickness\", \"design.depth\"], correlation = 0.5 }}\n\
                 b = {{ members = [\"design.thickness\", \"design.depth\"], correlation = 0.5 }}"
            )),
        ),
        ("E0316", plain_with(depth).replace("travel = \"13.6 mm\"", "force = \"5 N\"")),
    ];
    for (code, text) in cases {
        let refused = study(&folder, &text, &["--samples", "64"]);
        assert_eq!(refused.code, Some(2), "{code}: {}", refused.stderr);
        refused.assert_refused(code);
        assert!(refused.stderr.contains(&format!("error[{code}]")) && refused.stderr.contains("help"), "{code}: {}", refused.stderr);
    }
    let missing = run(folder.path(), &["tolerance", "none.toml"]);
    assert_eq!(missing.code, Some(4));
    let few = study(&folder, EXAMPLE, &["--samples", "3"]);
    assert_eq!(few.code, Some(2));
}

/// A nominal design that does not reach its end is another matter than a file with an error; a design without requirements is warned of.
#[test]
fn a_study_without_a_beginning_and_one_without_requirements() {
    let folder = folder();
    let far = study(&folder, EXAMPLE, &["--samples", "64", "--set", "load.travel=\"200 mm\"", "--variant", "paper", "--json"]);
    assert_eq!(far.code, Some(3), "{}", far.stderr);
    assert_eq!(far.json()["diagnostics"][0]["code"], "E0324");
    let begin = EXAMPLE.find("[requirements]").unwrap();
    let end = EXAMPLE.find("[material]").unwrap();
    let free = study(&folder, &EXAMPLE.replace(&EXAMPLE[begin..end], ""), &["--samples", "64"]);
    assert_eq!(free.code, Some(0), "{}", free.stderr);
    assert!(free.stderr.contains("W0513"), "{}", free.stderr);
}
