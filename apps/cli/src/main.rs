//! The `forcewright` command line: a thin view of the library.

mod args;
mod commands;
mod exit;
mod output;
mod progress;
mod table;

use std::process::ExitCode;

fn main() -> ExitCode {
    let matches = match args::command().try_get_matches() {
        Ok(matches) => matches,
        Err(error) => {
            // `--help` and `--version` come here too, with exit code 0.
            let code = if error.use_stderr() { exit::USAGE } else { exit::MET };
            let _ = error.print();
            return ExitCode::from(code);
        }
    };
    let code = match matches.subcommand() {
        Some(("new", m)) => commands::new::run(m),
        Some(("check", m)) => commands::check::run(m),
        Some(("solve", m)) => commands::solve::run(m),
        Some(("reproduce", m)) => commands::reproduce::run(m),
        Some(("explain", m)) => commands::explain::run(m),
        Some(("schema", m)) => commands::schema::run(m),
        Some(("completions", m)) => commands::completions::run(m),
        _ => commands::welcome(),
    };
    ExitCode::from(code)
}
