//! `forcewright compare`: mechanisms of any family in one sheet.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use clap::ArgMatches;
use forcewright::base::units::{Dimension, Quantity};
use forcewright::model::CheckState;
use forcewright::{Choices, Comparison, DiskFiles, Loaded, compare};

use super::refuse;
use super::solve::quote;
use crate::progress::Progress;
use crate::table::{Align, columns};
use crate::{exit, interrupt, output};

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let files: Vec<&PathBuf> = matches.get_many("file").map(Iterator::collect).unwrap_or_default();
    let (as_json, out) = (matches.get_flag("json"), matches.get_one::<PathBuf>("out"));
    let lever_m = match matches.get_one::<String>("lever").map(|text| lever_m(text)).transpose() {
        Ok(lever_m) => lever_m,
        Err(why) => {
            output::complain("E0126", &why, "a length above zero with its unit, such as --lever \"40 mm\"", as_json);
            return exit::USAGE;
        }
    };
    let mut projects = Vec::with_capacity(files.len());
    for file in &files {
        match Loaded::from_file(&DiskFiles, file, &Choices::default()) {
            Ok(loaded) => projects.push((file.display().to_string(), loaded)),
            Err(refused) => return refuse(&refused, as_json),
        }
    }
    if let Some(folder) = out
        && let Err(failed) = output::prepare(folder)
    {
        return output::write_failed(&failed, as_json);
    }
    let stop = interrupt::flag();
    let mut bar = Progress::new("analysing");
    let found = compare(&projects, lever_m, &mut |fraction| {
        bar.show(fraction);
        !stop.load(Ordering::Relaxed)
    });
    bar.done();
    let document = output::json_text(&found.document());
    output::tell(as_json, &document, || summary(&found));
    if let Some(folder) = out {
        let files = [("report.html".to_owned(), found.page(&repeat_command(matches, &files))), ("result.json".to_owned(), document)];
        if let Err(code) = output::deliver(folder, &files) {
            return code;
        }
    }
    match (found.interrupted, found.complete(), found.requirements()) {
        (true, ..) => exit::INTERRUPTED,
        (_, false, _) => exit::NOT_CONVERGED,
        (_, _, CheckState::Met) => exit::MET,
        _ => exit::MISSED,
    }
}

/// Arms that somebody could make, m.
const LEVERS_M: std::ops::RangeInclusive<f64> = 1e-6..=1e3;

fn lever_m(text: &str) -> Result<f64, String> {
    let length = Quantity::parse(text, Dimension::Length).ok().map(|q| q.si).filter(|m| (LEVERS_M).contains(m));
    length.ok_or_else(|| format!("`--lever {text}` is not a length from 1 µm to 1 km"))
}

/// The command that makes this result again.
fn repeat_command(matches: &ArgMatches, files: &[&PathBuf]) -> String {
    let mut command = "forcewright compare".to_owned();
    for file in files {
        let _ = write!(command, " {}", quote(&file.display().to_string()));
    }
    if let Some(lever) = matches.get_one::<String>("lever") {
        let _ = write!(command, " --lever {}", quote(lever));
    }
    if let Some(out) = matches.get_one::<PathBuf>("out") {
        let _ = write!(command, " --out {}", quote(&out.display().to_string()));
    }
    command
}

/// What is printed.
fn summary(found: &Comparison) -> String {
    let mut out = String::new();
    for (at, mechanism) in found.mechanisms.iter().enumerate() {
        let _ = writeln!(out, "{}  {} ({}, {})", at + 1, mechanism.title, mechanism.mechanism, mechanism.input_name);
    }
    out.push('\n');
    let heads = (1..=found.mechanisms.len()).map(|n| n.to_string());
    let mut rows = vec![std::iter::once("measure".to_owned()).chain(heads).collect::<Vec<_>>()];
    rows.extend(found.rows().into_iter().map(|row| [vec![row.title.to_owned()], row.texts].concat()));
    rows.push([vec!["Requirements".to_owned()], found.mechanisms.iter().map(|m| m.requirements.word().to_owned()).collect()].concat());
    let align: Vec<Align> = std::iter::once(Align::Left).chain(found.mechanisms.iter().map(|_| Align::Right)).collect();
    out.push_str(&columns(&rows, &align));
    out.push('\n');
    for caution in found.cautions() {
        let _ = writeln!(out, "{caution}");
    }
    let _ = writeln!(out, "{}", found.verdict());
    out
}
