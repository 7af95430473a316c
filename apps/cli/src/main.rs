//! The `forcewright` command line: a thin view of the library.

mod args;
mod commands;
mod exit;
mod interrupt;
mod output;
mod progress;
mod table;

use std::process::ExitCode;

fn main() -> ExitCode {
    let matches = match args::command().try_get_matches() {
        Ok(matches) => matches,
        Err(error) => {
            // `--help` and `--version` come here too, with exit code 0.
            if !error.use_stderr() {
                let _ = error.print();
                return ExitCode::from(exit::MET);
            }
            return ExitCode::from(not_understood(&error));
        }
    };
    let code = match matches.subcommand() {
        Some(("new", m)) => commands::new::run(m),
        Some(("check", m)) => commands::check::run(m),
        Some(("solve", m)) => commands::solve::run(m),
        Some(("sweep", m)) => commands::sweep::run(m),
        Some(("synthesise", m)) => commands::synthesise::run(m),
        Some(("optimise", m)) => commands::optimise::run(m),
        Some(("pareto", m)) => commands::pareto::run(m),
        Some(("tolerance", m)) => commands::tolerance::run(m),
        Some(("compare", m)) => commands::compare::run(m),
        Some(("calibrate", m)) => commands::calibrate::run(m),
        Some(("export", m)) => commands::export::run(m),
        Some(("merge", m)) => commands::merge::run(m),
        Some(("reproduce", m)) => commands::reproduce::run(m),
        Some(("explain", m)) => commands::explain::run(m),
        Some(("materials", m)) => commands::materials::run(m),
        Some(("schema", m)) => commands::schema::run(m),
        Some(("completions", m)) => commands::completions::run(m),
        _ => commands::welcome(),
    };
    ExitCode::from(code)
}

/// Reports a call that clap refuses, with a code as every error has.
fn not_understood(error: &clap::Error) -> u8 {
    let text = error.render().to_string();
    let text = text.strip_prefix("error: ").unwrap_or(&text).trim_end();
    if std::env::args_os().any(|a| a == "--json") {
        let message = text.lines().next().unwrap_or_default();
        let diagnostics = serde_json::json!([{ "code": "E0125", "severity": "error", "message": message, "help": "forcewright --help" }]);
        output::print(&output::json_text(&output::refusal(&diagnostics)));
    }
    let shown: Vec<_> = text.lines().map(forcewright::base::text::visible).collect();
    output::narrate(&format!("error[E0125]: {}\n", shown.join("\n")));
    exit::USAGE
}
