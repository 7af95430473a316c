//! `forcewright explain`: the long story behind a code.

use std::fmt::Write as _;

use clap::ArgMatches;
use forcewright::base::text::closest;

use crate::{exit, output};

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    if matches.get_flag("all") {
        let mut out = String::from("# Codes of checks, errors and warnings\n");
        for e in forcewright::explanations().chain(output::CODES) {
            let _ = write!(out, "\n## {}: {}\n\n{}\n", e.code, e.title, e.text);
        }
        output::print(&out);
        return exit::MET;
    }
    let Some(code) = matches.get_one::<String>("code") else { return exit::USAGE };
    let wanted = code.trim().to_uppercase();
    if let Some(e) = forcewright::explanations().chain(output::CODES).find(|e| e.code == wanted) {
        output::print(&format!("{}: {}\n\n{}\n", e.code, e.title, e.text));
        return exit::MET;
    }
    let near = closest(&wanted, forcewright::explanations().chain(output::CODES).map(|e| e.code));
    let help = near.map_or_else(
        || "`forcewright explain --all` prints every code".to_owned(),
        |n| format!("did you mean {n}? `forcewright explain --all` prints every code"),
    );
    output::complain("E0123", &format!("there is no code `{}`", code.chars().take(40).collect::<String>()), &help, false);
    exit::USAGE
}
