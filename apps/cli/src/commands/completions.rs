//! `forcewright completions`: completions for a shell.

use clap::ArgMatches;
use clap_complete::{Shell, generate};

use crate::{args, exit, output};

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let Some(shell) = matches.get_one::<Shell>("shell") else { return exit::USAGE };
    let mut script = Vec::new();
    generate(*shell, &mut args::command(), "forcewright", &mut script);
    output::print(&String::from_utf8_lossy(&script));
    exit::MET
}
