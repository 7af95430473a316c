//! The project's own tasks: `cargo xtask <command>`.
//!
//! Logic lives here and not in shell scripts, so that people, every platform and the continuous integration run the same thing.
#![allow(clippy::print_stdout, reason = "a program that talks to people")]

mod book;
mod browser;
mod examples;
mod fuzz;
mod generate;
mod layers;
mod lint;
mod metadata;
mod parts;
mod python;
mod source;
mod step;
mod test;
mod tidy;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

const HELP: &str = "\
The project's own tasks.

Usage: cargo xtask <command> [options]

Commands:
  lint                 everything that needs no running: format, clippy, documentation, layers, generated files, tidiness
  layers [--markdown]  dependencies point down only; --markdown prints the table and graph of the crates
  generate [--check]   write what is generated: schema, reference pages, validation table, picture, crate graph
                       --check only compares, and names what is stale
  test [--rust] [--parts] [--examples] [--browser]
                       everything a fresh machine with Rust and Python 3 can run; with options only the Rust tests,
                       only files of parts or only the examples as Python reads them, only their reports in a browser
  validate             read files of parts with a CAD kernel (OpenCASCADE, some hundred megabytes, installed if possible);
                       compare beams with finite elements (CalculiX, if `ccx` is in the path; some minutes)
  fuzz [seconds]       feed noise to the reader of project files (60 s by default); needs cargo-fuzz
  help                 this text

Options:
  --binary FILE        (generate, test) use this forcewright instead of building one
";

/// What every task needs to know.
struct Workspace {
    /// Folder of the workspace's `Cargo.toml`.
    root: PathBuf,
}

impl Workspace {
    fn find() -> Self {
        let here = std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
        Self { root: here.parent().map_or_else(|| here.clone(), Path::to_path_buf) }
    }
}

/// Options after the command; each command says which it takes.
#[derive(Debug, Default, PartialEq, Eq)]
struct Options {
    flags: Vec<String>,
    binary: Option<PathBuf>,
    positional: Vec<String>,
}

impl Options {
    fn parse(args: &[String], allowed_flags: &[&str], takes_binary: bool, max_positional: usize) -> Result<Self, String> {
        let mut options = Self::default();
        let mut rest = args.iter();
        while let Some(arg) = rest.next() {
            if arg == "--binary" && takes_binary {
                options.binary = Some(PathBuf::from(rest.next().ok_or("--binary needs a file")?));
            } else if allowed_flags.contains(&arg.as_str()) {
                options.flags.push(arg.clone());
            } else if arg.starts_with('-') || options.positional.len() == max_positional {
                return Err(format!("unexpected argument `{arg}`"));
            } else {
                options.positional.push(arg.clone());
            }
        }
        Ok(options)
    }

    fn has(&self, flag: &str) -> bool {
        self.flags.iter().any(|given| given == flag)
    }
}

fn run(args: &[String]) -> Result<ExitCode, String> {
    let workspace = Workspace::find();
    let (command, rest) = args.split_first().map_or(("help", [].as_slice()), |(first, rest)| (first.as_str(), rest));
    if command == "help" || args.iter().any(|arg| arg == "--help" || arg == "-h") {
        print!("{HELP}");
        return Ok(ExitCode::SUCCESS);
    }
    match command {
        "lint" => {
            Options::parse(rest, &[], false, 0)?;
            Ok(lint::run(&workspace))
        }
        "layers" => {
            let options = Options::parse(rest, &["--markdown"], false, 0)?;
            layers::run(&workspace, options.has("--markdown"))
        }
        "generate" => {
            let options = Options::parse(rest, &["--check"], true, 0)?;
            Ok(generate::run(&workspace, options.has("--check"), options.binary.as_deref()))
        }
        "test" => {
            let options = Options::parse(rest, &["--rust", "--parts", "--examples", "--browser"], true, 0)?;
            let wanted = |flag: &str| options.flags.is_empty() || options.has(flag);
            let what = test::What {
                rust: wanted("--rust"),
                parts: wanted("--parts"),
                examples: wanted("--examples"),
                browser: wanted("--browser"),
            };
            Ok(test::run(&workspace, what, options.binary.as_deref()))
        }
        "validate" => {
            Options::parse(rest, &[], false, 0)?;
            Ok(parts::validate(&workspace))
        }
        "fuzz" => {
            let options = Options::parse(rest, &[], false, 1)?;
            let seconds = options
                .positional
                .first()
                .map_or(Ok(60), |text| text.parse::<u64>().map_err(|_| format!("`{text}` is no number of seconds")))?;
            fuzz::run(&workspace, seconds)
        }
        other => Err(format!("no command `{other}`; `cargo xtask help` lists them")),
    }
}

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match run(&args) {
        Ok(code) => code,
        Err(message) => {
            println!("error: {message}");
            ExitCode::from(2)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<String> {
        text.split_whitespace().map(str::to_owned).collect()
    }

    #[test]
    fn options_are_sorted_into_their_kinds() {
        let options = Options::parse(&words("--check --binary target/x"), &["--check"], true, 0).unwrap();
        assert!(options.has("--check"));
        assert_eq!(options.binary, Some(PathBuf::from("target/x")));
    }

    #[test]
    fn unknown_options_are_refused() {
        assert!(Options::parse(&words("--chek"), &["--check"], true, 0).is_err());
        assert!(Options::parse(&words("--binary"), &[], true, 0).is_err());
        assert!(Options::parse(&words("--binary x"), &[], false, 0).is_err());
        assert!(Options::parse(&words("10 20"), &[], false, 1).is_err());
        assert!(run(&words("tset")).is_err());
    }
}
