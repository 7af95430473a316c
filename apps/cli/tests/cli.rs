//! The commands as people and scripts call them: results, exit codes, files, documents.

mod common;

use std::path::Path;
use std::process::{Command, Stdio};

use common::{folder, folder_with, listing, run};

/// A displacement that beams which cannot stretch do not allow.
const BEYOND: [&str; 6] = ["--set", "model.beam=inextensible", "--set", "load.direction=[0, 1]", "--set", "load.travel=60 mm"];

fn solve(extra: &[&str]) -> common::Run {
    let folder = folder();
    let mut arguments = vec!["solve", "a.toml"];
    arguments.extend(extra);
    let run = run(folder.path(), &arguments);
    assert_eq!(listing(folder.path()), ["a.toml"], "without --out nothing is written");
    run
}

#[test]
fn exit_codes_say_how_it_went() {
    let met = solve(&[]);
    assert_eq!(met.code, Some(0), "{}", met.stderr);
    assert!(met.stdout.contains("✓ met") && met.stdout.contains("force_at_end"), "{}", met.stdout);
    let missed = solve(&["--set", "requirements.travel=9 mm"]);
    assert_eq!(missed.code, Some(1), "{}", missed.stderr);
    assert!(missed.stdout.contains("✗ missed") && missed.stdout.contains("COMP003"), "{}", missed.stdout);
    assert_eq!(solve(&["--set", "design.depth=9 N"]).code, Some(2));
    let beyond = solve(&BEYOND);
    assert_eq!(beyond.code, Some(3), "{}", beyond.stdout);
    assert!(beyond.stdout.contains("beyond"), "{}", beyond.stdout);
    let folder = tempfile::tempdir().unwrap();
    let none = run(folder.path(), &["solve", "none.toml"]);
    assert_eq!(none.code, Some(4));
    assert!(none.stderr.contains("error[E0101]: `none.toml` does not exist"), "{}", none.stderr);
}

#[test]
fn one_document_on_standard_output_whatever_happens() {
    for (extra, code, kind) in [
        (&[][..], 0, "complete"),
        (&["--set", "requirements.travel=9 mm"], 1, "complete"),
        (&BEYOND, 3, "no equilibrium beyond"),
        (&["--set", "design.depth=9 N"], 2, "refused"),
        (&["--variant", "none"], 2, "refused"),
        (&["--nonsense"], 2, "refused"),
        (&["--out", "a.toml"], 4, "refused"),
    ] {
        let mut arguments = vec!["--json"];
        arguments.extend(extra);
        let run = solve(&arguments);
        assert_eq!(run.code, Some(code), "{extra:?}: {}", run.stderr);
        let document = run.json();
        let found = document["status"]["kind"].as_str().unwrap_or_default();
        assert_eq!(found.replace('_', " "), kind, "{extra:?}");
        assert_eq!(document["schema"], 1);
        if kind == "refused" {
            let first = &document["diagnostics"][0];
            assert!(first["code"].as_str().is_some_and(|c| c.starts_with('E')), "{document:#}");
            assert!(first["message"].is_string() && first["help"].is_string(), "{document:#}");
            assert!(run.stderr.contains("error[E"), "people are told too: {}", run.stderr);
        } else {
            assert_eq!(document["mechanism"], "compliant");
            assert!(document["metrics"].is_object() && document["checks"].is_array());
        }
    }
    let folder = folder();
    let refused = run(folder.path(), &["solve", "a.toml", "--json", "--set", "design.depth=9 N"]).json();
    let first = &refused["diagnostics"][0];
    assert_eq!([&first["code"], &first["file"]], ["E0201", "--set"]);
    assert_eq!([first["line"].as_u64(), first["column"].as_u64()], [Some(1), Some(14)]);
}

fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    listing(folder).into_iter().map(|name| (name.clone(), std::fs::read(folder.join(name)).expect("a file"))).collect()
}

#[test]
fn results_are_written_whole_and_the_same_every_time() {
    let folder = folder();
    let mut runs = Vec::new();
    for _ in 0..2 {
        let run = run(folder.path(), &["solve", "a.toml", "--out", "out/deep"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let files = contents(&folder.path().join("out/deep"));
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        assert!(["report.html", "result.json", "curves.csv"].iter().all(|n| names.contains(n)), "{names:?}");
        assert!(names.iter().all(|n| !n.starts_with('.')) && files.iter().all(|(_, bytes)| !bytes.is_empty()), "{names:?}");
        assert!(names.iter().all(|n| run.stderr.contains(n)), "{}", run.stderr);
        let result = files.iter().find(|(name, _)| name == "result.json").unwrap();
        assert_eq!(serde_json::from_slice::<serde_json::Value>(&result.1).unwrap()["status"]["kind"], "complete");
        runs.push((files, run.stdout));
    }
    assert!(runs[0] == runs[1], "two runs differ");
    // The document printed is the one written.
    let printed = run(folder.path(), &["solve", "a.toml", "--json"]).stdout;
    assert_eq!(printed.as_bytes(), std::fs::read(folder.path().join("out/deep/result.json")).unwrap());
}

#[test]
fn what_cannot_be_written_leaves_nothing_half_written() {
    let folder = folder();
    // A folder stands where the last of the files should go.
    std::fs::create_dir_all(folder.path().join("out/curves.csv")).unwrap();
    let blocked = run(folder.path(), &["solve", "a.toml", "--out", "out"]);
    assert_eq!(blocked.code, Some(4), "{}", blocked.stderr);
    assert!(blocked.stderr.contains("error[E0120]") && blocked.stderr.contains("help: "), "{}", blocked.stderr);
    assert_eq!(listing(&folder.path().join("out")), ["curves.csv"]);
    for out in ["a.toml", "a.toml/deeper", "/proc/none", "/dev/null"] {
        let run = run(folder.path(), &["solve", "a.toml", "--out", out]);
        assert_eq!(run.code, Some(4), "{out}: {}", run.stderr);
        assert!(run.stderr.contains("error[E0120]"), "{out}: {}", run.stderr);
        assert!(run.stdout.is_empty(), "the folder is tried before the work: {}", run.stdout);
    }
    assert_eq!(std::fs::read_to_string(folder.path().join("a.toml")).unwrap(), common::EXAMPLE);
}

#[test]
fn from_an_empty_folder_to_a_report() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let list = run(at, &["new", "--list"]);
    assert!(list.code == Some(0) && list.stdout.contains("compliant/lan-table3"), "{}", list.stdout);
    assert_eq!(run(at, &["new", "lan-thin"]).code, Some(0));
    // What it extends comes with it.
    assert_eq!(listing(at), ["lan-table3.toml", "lan-thin.toml"]);
    let check = run(at, &["check", "lan-thin.toml", "lan-table3.toml"]);
    assert_eq!(check.code, Some(0), "{}", check.stderr);
    assert!(check.stdout.contains("lan-table3.toml, variant paper: ok"), "{}", check.stdout);
    assert_eq!(run(at, &["solve", "lan-thin.toml", "--out", "out"]).code, Some(0));
    // Nothing is overwritten, unless that is asked for.
    std::fs::write(at.join("lan-thin.toml"), "mine").unwrap();
    let again = run(at, &["new", "lan-thin"]);
    assert!(again.code == Some(4) && again.stderr.contains("error[E0122]"), "{}", again.stderr);
    assert_eq!(std::fs::read_to_string(at.join("lan-thin.toml")).unwrap(), "mine");
    assert_eq!(run(at, &["new", "lan-thin", "--force"]).code, Some(0));
    assert_ne!(std::fs::read_to_string(at.join("lan-thin.toml")).unwrap(), "mine");
    let none = run(at, &["new", "lan-tabel3"]);
    assert!(none.code == Some(2) && none.stderr.contains("error[E0121]") && none.stderr.contains("lan-table3"), "{}", none.stderr);
    assert_eq!(run(at, &["new", "lan-thin", "--dir", "lan-thin.toml"]).code, Some(4));
}

#[test]
fn check_reads_every_variant_of_every_file_and_solves_nothing() {
    let folder = folder();
    let broken = common::EXAMPLE.replace("model.beam = \"inextensible\"", "model.beam = \"inextensibel\"");
    std::fs::write(folder.path().join("b.toml"), broken).unwrap();
    let run_check = |extra: &[&str]| {
        let mut arguments = vec!["check", "a.toml", "b.toml"];
        arguments.extend(extra);
        run(folder.path(), &arguments)
    };
    let check = run_check(&[]);
    assert_eq!(check.code, Some(2), "{}", check.stderr);
    assert_eq!(check.stdout, "a.toml: ok\na.toml, variant paper: ok\nb.toml: ok\n");
    assert!(check.stderr.contains("error[E0303]") && check.stderr.contains("did you mean \"inextensible\"?"), "{}", check.stderr);
    let document = run_check(&["--json"]).json();
    let checked = document["checked"].as_array().unwrap();
    assert_eq!(checked.iter().map(|c| c["ok"].as_bool().unwrap()).collect::<Vec<_>>(), [true, true, true, false]);
    assert_eq!(checked[3]["diagnostics"][0]["code"], "E0303");
    // The worst of several files decides; a missing one does not hide the others.
    let worst = run(folder.path(), &["check", "none.toml", "a.toml"]);
    assert!(worst.code == Some(4) && worst.stdout.contains("a.toml: ok"), "{}", worst.stdout);
    assert_eq!(run(folder.path(), &["check", "a.toml", "--variant", "paper"]).stdout, "a.toml, variant paper: ok\n");
    assert_eq!(run(folder.path(), &["check"]).code, Some(2));
}

/// A file that says what a design must do is checked as that, and other commands say what to do with it. What misses in a file that is not
/// TOML may stand behind the slip, and is not told.
#[test]
fn what_a_file_lacks_is_said_once() {
    let folder = folder();
    let asked = "schema = 1\nmechanism = \"compliant\"\n[requirements]\nforce = { nominal = \"12 N\", band = \"5 %\" }\ntravel = \"8 mm\"\n\
                 stress = { safety_factor = 1.5 }\n[material]\nuse = \"POM-C\"\n[process]\nmethod = \"milling\"\ncutter_diameter = \"1 mm\"\n\
                 [synthesise]\nroom = [\"140 mm\", \"110 mm\"]\nthickness_min = \"0.6 mm\"\ndepth = { max = \"20 mm\" }\n";
    std::fs::write(folder.path().join("b.toml"), asked).unwrap();
    std::fs::write(folder.path().join("c.toml"), asked.replace("140 mm", "140 cats")).unwrap();
    std::fs::write(folder.path().join("d.toml"), asked.replace("\"POM-C\"", "\"POM-C")).unwrap();
    let check = run(folder.path(), &["check", "b.toml"]);
    assert!(check.code == Some(0) && check.stdout.contains("b.toml: ok; it asks for a design"), "{} {}", check.stdout, check.stderr);
    let errors = |arguments: &[&str]| {
        let run = run(folder.path(), arguments);
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        run.stderr.lines().filter(|line| line.starts_with("error")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert!(matches!(&errors(&["solve", "b.toml"])[..], [only] if only.contains("`design` is missing: this file says what")));
    assert!(matches!(&errors(&["check", "c.toml"])[..], [only] if only.starts_with("error[E02") && only.contains("cats")));
    assert!(errors(&["check", "d.toml"]).iter().all(|line| line.starts_with("error[E0105]")));
}

#[test]
fn values_are_shown_in_the_units_typed() {
    let shown = |travel: &str| solve(&["--set", &format!("load.travel={travel}"), "--set", "requirements.force.nominal=0.0097 kN"]).stdout;
    let [millimetres, inches] = [shown("13.6 mm"), shown("0.53543307 in")];
    assert!(millimetres.contains("13.6 mm") && millimetres.contains(" kN"), "{millimetres}");
    assert!(inches.contains("0.5354 in") && !inches.contains("13.6 mm"), "{inches}");
}

#[test]
fn explain_knows_every_code() {
    let folder = tempfile::tempdir().unwrap();
    for e in forcewright::explanations() {
        let run = run(folder.path(), &["explain", &e.code.to_lowercase()]);
        assert_eq!(run.code, Some(0), "{}", e.code);
        assert!(run.stdout.contains(e.code) && run.stdout.contains(e.text), "{}", run.stdout);
    }
    let all = run(folder.path(), &["explain", "--all"]).stdout;
    assert!(forcewright::explanations().all(|e| all.contains(e.text)));
    let none = run(folder.path(), &["explain", "E9999\u{1b}[31m"]);
    assert!(none.code == Some(2) && none.stderr.contains("error[E0123]"), "{}", none.stderr);
    none.assert_plain("an unknown code");
    for code in ["E0120", "E0121", "E0122", "E0123", "E0125"] {
        assert_eq!(run(folder.path(), &["explain", code]).code, Some(0), "{code}");
    }
}

#[test]
fn schema_and_completions() {
    let folder = tempfile::tempdir().unwrap();
    let schema = run(folder.path(), &["schema", "compliant"]).json();
    assert_eq!(schema["properties"]["mechanism"]["const"], "compliant");
    assert!(schema["properties"]["design"]["properties"]["beams"]["items"]["properties"]["bend"].is_object());
    let paths = run(folder.path(), &["schema", "compliant", "--format", "paths"]).stdout;
    let table = run(folder.path(), &["schema", "compliant", "--format", "markdown"]).stdout;
    assert!(paths.lines().count() > 50);
    for path in paths.lines() {
        // Loads are one table or a list of them: the table of parameters shows their keys once.
        let shown = path.replace("load.*", "load");
        assert!(table.contains(&format!("`{shown}`")), "{shown} is not in the table");
        let mut at = &schema;
        for part in path.split('.') {
            if let Some(forms) = at["anyOf"].as_array() {
                at = forms.iter().find(|form| form["items"].is_object() == (part == "*")).unwrap_or(&forms[0]);
            }
            at = match part {
                "*" if at["items"].is_object() => &at["items"],
                "*" => &at["additionalProperties"],
                key => &at["properties"][key],
            };
        }
        assert!(at.is_object(), "{path} is not in the schema");
    }
    assert_eq!(run(folder.path(), &["schema", "clockwork"]).code, Some(2));
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let run = run(folder.path(), &["completions", shell]);
        assert!(run.code == Some(0) && run.stdout.contains("forcewright") && run.stdout.contains("solve"), "{shell}");
    }
    assert_eq!(run(folder.path(), &["completions", "tcl"]).code, Some(2));
}

#[test]
fn calls_that_are_not_understood() {
    let folder = folder();
    for arguments in [
        &["slove", "a.toml"][..],
        &["solve"],
        &["solve", "a.toml", "b.toml"],
        &["solve", "a.toml", "--out"],
        &["check", "--what", "a.toml"],
    ] {
        let run = run(folder.path(), arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}");
        assert!(run.stderr.starts_with("error[E0125]: ") && run.stdout.is_empty(), "{arguments:?}: {}", run.stderr);
    }
    assert!(run(folder.path(), &["slove"]).stderr.contains("'solve'"));
    for arguments in [&["--help"][..], &["--version"], &["solve", "--help"], &[]] {
        let run = run(folder.path(), arguments);
        assert!(run.code == Some(0) && !run.stdout.is_empty() && run.stderr.is_empty(), "{arguments:?}");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_panic() {
    let folder = folder();
    for arguments in [
        &["explain", "--all"][..],
        &["solve", "a.toml"],
        &["solve", "a.toml", "--json"],
        &["schema", "cam"],
        &["schema", "capstan"],
        &["schema", "lavt"],
        &["--help"],
        &["check", "a.toml"],
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_forcewright"))
            .args(arguments)
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn titles_do_not_reach_the_terminal_raw() {
    let folder = folder_with(common::EXAMPLE.replace("title = \"", "title = \"\\u001b]0;x\\u0007\\u001b[31m").as_bytes());
    let run = run(folder.path(), &["solve", "a.toml"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    run.assert_plain("a title with escapes");
    assert!(run.stdout.contains("·]0;x··[31m"), "{}", run.stdout);
}

#[test]
fn one_material_or_a_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let one = run(folder.path(), &["materials", "POM-C"]);
    assert_eq!(one.code, Some(0), "{}", one.stderr);
    assert!(one.stdout.contains("POM-C") && one.stdout.contains("sources: ") && !one.stdout.contains("C75S"), "{}", one.stdout);
    let wrong = run(folder.path(), &["materials", "POMM"]);
    assert_eq!(wrong.code, Some(2));
    assert!(wrong.stderr.contains("did you mean `POM") && wrong.stdout.is_empty(), "{}", wrong.stderr);
    let strange = run(folder.path(), &["materials", "unobtainium"]);
    assert!(strange.stderr.contains("`forcewright materials` lists all"), "{}", strange.stderr);
}

/// One cause, one message: a warning of the file is said once, and a shape that cannot be read is not missing.
#[test]
fn nothing_is_said_twice() {
    let text = common::EXAMPLE.replace("[process]", "[material.spare]\nuse = \"POM-C\"\n[process]");
    let folder = folder_with(text.as_bytes());
    let run_once = run(folder.path(), &["solve", "a.toml"]);
    let all = format!("{}{}", run_once.stdout, run_once.stderr);
    assert_eq!(all.matches("W0509").count(), 1, "{all}");
    assert!(run_once.stdout.contains("W0502"), "{all}");
    for shape in ["through = [[\"20 mm\", \"10 mmm\"]]", "through = [\"20 mm\", \"10 mm\"]", "arc = \"20 mm\""] {
        let folder = folder_with(common::EXAMPLE.replace("bend = [1.3092, -1.5707]", shape).as_bytes());
        let refused = run(folder.path(), &["check", "a.toml"]);
        assert!(refused.code == Some(2) && refused.stderr.matches("error[").count() == 1, "{}", refused.stderr);
    }
}
