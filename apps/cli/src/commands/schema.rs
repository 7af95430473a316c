//! `forcewright schema`: the language of project files, for editors and people.

use clap::ArgMatches;

use crate::{exit, output};

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let id = matches.get_one::<String>("mechanism").map(String::as_str);
    let family = match (id, forcewright::FAMILIES) {
        (Some(id), _) => forcewright::family(id),
        (None, [only]) => Some(*only),
        (None, _) => None,
    };
    let Some(family) = family else {
        output::complain("E0124", "there are several families", "name one, such as `forcewright schema compliant`", false);
        return exit::USAGE;
    };
    match matches.get_one::<String>("format").map(String::as_str) {
        Some("markdown") => output::print(&family.parameter_table()),
        Some("paths") => output::print(&format!("{}\n", family.parameter_paths().join("\n"))),
        _ => output::print(&format!("{:#}\n", family.json_schema())),
    }
    exit::MET
}
