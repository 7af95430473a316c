//! The command line's grammar.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, Command, ValueHint};

const EXIT_CODES: &str = "Exit codes: 0 requirements met, 1 a requirement missed or not assessed, 2 error in the file or the call, 3 travel or accuracy not reached, 4 input/output, 130 interrupted.";

/// The whole command.
pub(crate) fn command() -> Command {
    Command::new("forcewright")
        .version(forcewright::VERSION)
        .about("Passive force-shaping mechanisms of robots: a force curve in, a mechanism out.")
        .after_help(EXIT_CODES)
        .disable_help_subcommand(true)
        .subcommand(new())
        .subcommand(check())
        .subcommand(solve())
        .subcommand(reproduce())
        .subcommand(explain())
        .subcommand(materials())
        .subcommand(schema())
        .subcommand(completions())
}

fn file() -> Arg {
    Arg::new("file").value_name("FILE").required(true).value_hint(ValueHint::FilePath).value_parser(clap::value_parser!(std::path::PathBuf))
}

fn choices(command: Command) -> Command {
    command.arg(Arg::new("variant").long("variant").value_name("NAME").help("Use a variant of the file")).arg(
        Arg::new("set")
            .long("set")
            .value_name("KEY=VALUE")
            .action(ArgAction::Append)
            .help("Replace one value for this run, such as design.thickness=\"0.9 mm\" (may be repeated)"),
    )
}

fn json() -> Arg {
    Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print one JSON document to standard output")
}

fn new() -> Command {
    Command::new("new")
        .about("Write a project file from the gallery")
        .arg(Arg::new("example").value_name("EXAMPLE").required_unless_present("list").help("Name of an example, such as lan-table3"))
        .arg(Arg::new("list").long("list").action(ArgAction::SetTrue).help("List the examples"))
        .arg(
            Arg::new("dir")
                .long("dir")
                .value_name("DIR")
                .default_value(".")
                .value_hint(ValueHint::DirPath)
                .value_parser(clap::value_parser!(std::path::PathBuf))
                .help("Where to write it"),
        )
        .arg(Arg::new("force").long("force").action(ArgAction::SetTrue).help("Overwrite existing files"))
}

fn check() -> Command {
    let command = Command::new("check")
        .about("Read project files and check units, names and rules; nothing is solved")
        .arg(file().num_args(1..).help("Project files; every variant is checked too"))
        .arg(json());
    choices(command).after_help(EXIT_CODES)
}

fn solve() -> Command {
    let command = Command::new("solve")
        .about("Analyse a project and check its requirements")
        .arg(file().help("Project file"))
        .arg(
            Arg::new("out")
                .long("out")
                .value_name("DIR")
                .value_hint(ValueHint::DirPath)
                .value_parser(clap::value_parser!(std::path::PathBuf))
                .help("Write report.html, result.json, curves.csv and the figures into this folder"),
        )
        .arg(json());
    choices(command).after_help(EXIT_CODES)
}

fn reproduce() -> Command {
    let papers: Vec<&'static str> = forcewright::reproductions().map(|r| r.key).collect();
    Command::new("reproduce")
        .about("Compute a paper's numbers and print them beside the paper's, with the difference and its reason")
        .arg(
            Arg::new("paper").value_name("PAPER").value_parser(PossibleValuesParser::new(papers)).help("Key of the paper; without it, all"),
        )
        .arg(Arg::new("format").long("format").value_parser(["text", "markdown", "json"]).default_value("text").help("How to print it"))
}

fn explain() -> Command {
    Command::new("explain")
        .about("Explain the code of a check, an error or a warning")
        .arg(Arg::new("code").value_name("CODE").required_unless_present("all").help("Such as COMP002 or E0201"))
        .arg(Arg::new("all").long("all").action(ArgAction::SetTrue).help("Print every code, as Markdown"))
}

fn materials() -> Command {
    Command::new("materials")
        .about("List the catalogue of materials, with the kind and source of each value")
        .arg(Arg::new("format").long("format").value_parser(["text", "markdown"]).default_value("text").help("How to print it"))
}

fn schema() -> Command {
    let ids: Vec<&'static str> = forcewright::FAMILIES.iter().map(|f| f.id()).collect();
    Command::new("schema")
        .about("Print the schema of project files, for editors and as documentation")
        .arg(
            Arg::new("mechanism")
                .value_name("MECHANISM")
                .value_parser(PossibleValuesParser::new(ids))
                .help("Family; may be left out while there is only one"),
        )
        .arg(
            Arg::new("format")
                .long("format")
                .value_parser(["json", "markdown", "paths"])
                .default_value("json")
                .help("JSON schema, table of parameters, or list of paths"),
        )
}

fn completions() -> Command {
    Command::new("completions")
        .about("Print completions for a shell")
        .arg(Arg::new("shell").value_name("SHELL").required(true).value_parser(clap::value_parser!(clap_complete::Shell)))
}

#[cfg(test)]
mod tests {
    #[test]
    fn grammar_is_sound() {
        super::command().debug_assert();
    }
}
