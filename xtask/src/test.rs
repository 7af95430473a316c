//! Everything that a fresh machine with Rust and Python 3 can run.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::Workspace;
use crate::book;
use crate::browser;
use crate::examples::{self, Example};
use crate::generate::{built, forcewright};
use crate::metadata::{self, cargo};
use crate::parts;
use crate::python::TOOLS;
use crate::step::{Finished, Outcome, Steps, captured, output_of, visible};

/// Which tests to run.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::struct_excessive_bools, reason = "one for each option of the command")]
pub(crate) struct What {
    /// `cargo test`.
    pub(crate) rust: bool,
    /// Examples and what other tools read of their results.
    pub(crate) examples: bool,
    /// Files of parts and what other tools read of them.
    pub(crate) parts: bool,
    /// The report in a browser.
    pub(crate) browser: bool,
}

/// An example that was solved, and where its results are.
#[derive(Debug)]
pub(crate) struct Solved {
    /// The example.
    pub(crate) example: Example,
    /// Folder with `report.html`, `curves.csv`, `result.json`.
    pub(crate) folder: PathBuf,
}

/// Places for what the tests write.
struct Bench<'a> {
    workspace: &'a Workspace,
    folder: PathBuf,
    binary: PathBuf,
}

/// The command `test`.
pub(crate) fn run(workspace: &Workspace, what: What, binary: Option<&Path>) -> ExitCode {
    let mut steps = Steps::default();
    if what.rust {
        steps.run("cargo test", || visible(cargo(workspace).args(["test", "--workspace"])));
    }
    if what.parts {
        parts::run(workspace, &mut steps);
    }
    if what.examples || what.browser {
        run_program(workspace, what, binary, &mut steps);
    }
    let code = steps.summary("test");
    println!("\n{}", steps.closing_line());
    code
}

fn run_program(workspace: &Workspace, what: What, binary: Option<&Path>, steps: &mut Steps) {
    let binary = built(workspace, binary, steps);
    let found = metadata::read(workspace).and_then(|metadata| Ok((metadata.target, examples::all(&workspace.root)?)));
    let (binary, (target, examples)) = match (binary, found) {
        (Some(binary), Ok(found)) => (binary, found),
        (None, _) => {
            steps.run("examples", || Outcome::NotRun("forcewright was not built".into()));
            return;
        }
        (_, Err(error)) => {
            steps.run("examples", || Outcome::Failed(error));
            return;
        }
    };
    if examples.is_empty() {
        steps.run("examples", || Outcome::Failed("no project file under examples/".into()));
    }
    let bench = Bench { workspace, folder: target.join("xtask"), binary };
    let solved: Vec<Solved> = examples.into_iter().filter_map(|example| bench.run_example(example, what.examples, steps)).collect();
    if what.examples {
        bench.check_with_python(&solved, steps);
        book::run(workspace, &bench.folder, &bench.binary, steps);
    }
    if what.browser {
        browser::run(workspace, &bench.folder, &solved, steps);
    }
}

impl Bench<'_> {
    /// Checks and solves one example. The results are given when there are any to look at.
    fn run_example(&self, example: Example, with_check: bool, steps: &mut Steps) -> Option<Solved> {
        if with_check {
            steps.run(&format!("check {}", example.path), || {
                let mut command = forcewright(self.workspace, &self.binary, &["check", &example.path]);
                ending(captured(&mut command, Duration::from_mins(1)), example.exit_of_check())
            });
        }
        let folder = self.folder.join("examples").join(example.slug());
        let passed = steps.run(&format!("solve {}", example.path), || {
            if let Err(error) = emptied(&folder) {
                return Outcome::Failed(error);
            }
            let mut command = forcewright(self.workspace, &self.binary, &["solve", &example.path, "--out"]);
            ending(captured(command.arg(&folder), Duration::from_mins(10)), example.exit)
        });
        (passed && matches!(example.exit, 0 | 1 | 3)).then_some(Solved { example, folder })
    }

    /// Reads schema, examples and results with tools that know nothing of this project.
    fn check_with_python(&self, solved: &[Solved], steps: &mut Steps) {
        let (python, reason) = TOOLS.python(self.workspace, &self.folder, steps);
        let schemas = match self.schemas(solved) {
            Ok(schemas) => schemas,
            Err(error) => {
                steps.run("python: schemas", || Outcome::Failed(error));
                return;
            }
        };
        let of = |solved: &Solved| json!({ "file": solved.example.path, "results": solved.folder });
        let job = json!({ "schemas": schemas, "examples": solved.iter().map(of).collect::<Vec<_>>(), "without_jsonschema": reason });
        let mut command = Command::new(python);
        command.current_dir(&self.workspace.root).arg("xtask/python/examples.py");
        run_script(&mut command, &self.folder.join("examples.json"), &job, "python", Duration::from_mins(10), steps);
    }

    /// Schema files of all families that the examples show.
    fn schemas(&self, solved: &[Solved]) -> Result<Value, String> {
        let folder = self.folder.join("schema");
        emptied(&folder)?;
        let mut families = BTreeSet::new();
        for Solved { folder, .. } in solved {
            // What is wrong with a result is for the checks to tell.
            let text = std::fs::read_to_string(folder.join("result.json")).unwrap_or_default();
            let result: Value = serde_json::from_str(&text).unwrap_or_default();
            families.extend(result["mechanism"].as_str().map(str::to_owned));
        }
        let mut files = serde_json::Map::new();
        for family in families {
            let text = output_of(&mut forcewright(self.workspace, &self.binary, &["schema", &family]), Duration::from_mins(1))?;
            let path = folder.join(format!("{family}.schema.json"));
            std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
            files.insert(family, json!(path));
        }
        Ok(Value::Object(files))
    }
}

/// Whether a command ended with the exit code expected.
pub(crate) fn ending(finished: Result<Finished, String>, expected: i32) -> Outcome {
    match finished {
        Ok(finished) if finished.code == Some(expected) => Outcome::Passed,
        Ok(finished) => {
            let code = finished.code.map_or_else(|| "a signal".to_owned(), |code| code.to_string());
            Outcome::Failed(format!("exit code {code}, expected {expected}\n{}", finished.tail()))
        }
        Err(error) => Outcome::Failed(error),
    }
}

/// Makes the folder, empty.
pub(crate) fn emptied(folder: &Path) -> Result<(), String> {
    let cannot = |error: std::io::Error| format!("{}: {error}", folder.display());
    if folder.exists() {
        std::fs::remove_dir_all(folder).map_err(cannot)?;
    }
    std::fs::create_dir_all(folder).map_err(cannot)
}

/// Runs a script that reads its job from a file and prints a line `passed|failed|not run <tab> name <tab> seconds <tab> reason` per check.
pub(crate) fn run_script(command: &mut Command, job_file: &Path, job: &Value, group: &str, limit: Duration, steps: &mut Steps) {
    println!("== {group}: checks in {}", command.get_args().next().unwrap_or_default().to_string_lossy());
    if let Err(error) = std::fs::write(job_file, format!("{job:#}\n")) {
        steps.record(group, Outcome::Failed(format!("{}: {error}", job_file.display())), Duration::ZERO);
        return;
    }
    let start = Instant::now();
    match captured(command.arg(job_file), limit) {
        Err(error) => {
            // What cannot even be started is missing; what does not end is broken.
            let outcome = if start.elapsed() < limit { Outcome::NotRun(error) } else { Outcome::Failed(error) };
            steps.record(group, outcome, start.elapsed());
        }
        Ok(finished) => {
            let mut any = false;
            for line in finished.stdout.lines() {
                match checked(line) {
                    Some((name, outcome, duration)) => {
                        any = true;
                        steps.record(&format!("{group}: {name}"), outcome, duration);
                    }
                    None => println!("   {line}"),
                }
            }
            if finished.code != Some(0) || !any {
                let problem = format!(
                    "the script ended with {:?} after {} checks\n{}",
                    finished.code,
                    if any { "some" } else { "no" },
                    finished.tail()
                );
                steps.record(&format!("{group}: script"), Outcome::Failed(problem), start.elapsed());
            }
        }
    }
}

/// A line of a script, understood.
fn checked(line: &str) -> Option<(&str, Outcome, Duration)> {
    let mut fields = line.splitn(4, '\t');
    let (word, name, seconds) = (fields.next()?, fields.next()?, fields.next()?.parse().ok()?);
    let mut reason = || fields.next().unwrap_or("no reason given").replace(" | ", "\n");
    let outcome = match word {
        "passed" => Outcome::Passed,
        "failed" => Outcome::Failed(reason()),
        "not run" => Outcome::NotRun(reason()),
        _ => return None,
    };
    Some((name, outcome, Duration::try_from_secs_f64(seconds).ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_scripts_become_steps() {
        assert_eq!(checked("passed\tshape\t0.5\t"), Some(("shape", Outcome::Passed, Duration::from_millis(500))));
        assert_eq!(checked("failed\tshape\t0\ta | b"), Some(("shape", Outcome::Failed("a\nb".into()), Duration::ZERO)));
        assert_eq!(checked("not run\tshape\t0\tno pip"), Some(("shape", Outcome::NotRun("no pip".into()), Duration::ZERO)));
        assert_eq!(checked("anything else"), None);
        assert_eq!(checked("passed\tshape\tsoon\t"), None);
    }

    #[cfg(unix)]
    #[test]
    fn a_script_that_checks_nothing_or_breaks_off_has_failed() {
        let job = std::env::temp_dir().join(format!("xtask-job-{}.json", std::process::id()));
        let counts = |script: &str| {
            let mut steps = Steps::default();
            let mut command = Command::new("sh");
            run_script(command.args(["-c", script]), &job, &json!({}), "s", Duration::from_secs(20), &mut steps);
            steps.counts()
        };
        assert_eq!(counts("printf 'passed\\ta\\t0\\t\\n'"), (1, 0, 0));
        assert_eq!(counts("true"), (0, 1, 0));
        assert_eq!(counts("printf 'passed\\ta\\t0\\t\\n'; exit 1"), (1, 1, 0));
        std::fs::remove_file(job).unwrap();
    }
}
