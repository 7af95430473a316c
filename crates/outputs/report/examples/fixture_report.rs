//! Writes the report of the test fixture, and its figures as files, to the folder given (or the current one).

use std::path::Path;
use std::{env, fs, io};

use forcewright_report::{csv, html, json, svg};

#[path = "../tests/fixture/mod.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the tests, which use all of it")]
#[allow(clippy::unwrap_used, clippy::print_stdout, reason = "the fixture is test code")]
mod fixture;

fn main() -> io::Result<()> {
    let folder = env::args().nth(1).unwrap_or_else(|| ".".to_owned());
    let folder = Path::new(&folder);
    let report = fixture::report();
    fs::write(folder.join("report.html"), html::page(&report))?;
    fs::write(folder.join("curves.csv"), csv::curves(&report.outcome))?;
    let document = json::document(&report.outcome, &report.input_sha256, &report.version);
    fs::write(folder.join("result.json"), format!("{document:#}\n"))?;
    for figure in &report.figures {
        fs::write(folder.join(format!("{}.svg", figure.id)), svg::standalone(figure))?;
    }
    Ok(())
}
