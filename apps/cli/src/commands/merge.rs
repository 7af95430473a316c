//! `forcewright merge`: joins the parts of a sweep.

use std::path::PathBuf;

use clap::ArgMatches;
use forcewright::sweep::{self, Outputs};

use super::sweep::{exit_code, failed, formats, summary, wrote};
use crate::{exit, output};

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let Some(out) = matches.get_one::<PathBuf>("out") else { return exit::USAGE };
    let parts: Vec<PathBuf> = matches.get_many::<PathBuf>("part").into_iter().flatten().cloned().collect();
    let as_json = matches.get_flag("json");
    let outputs = Outputs::new(out, formats(matches), matches.get_flag("force"));
    match sweep::merge(&outputs, &parts) {
        Err(error) => failed(&error, as_json),
        Ok(merged) => {
            let text = if as_json { output::json_text(&merged.document) } else { summary(&merged.tally) };
            output::print(&text);
            wrote(&outputs);
            exit_code(&merged.tally)
        }
    }
}
