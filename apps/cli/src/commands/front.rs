//! `forcewright optimise --front`: the best goal over the values of a key, with a project file per point.

use std::path::{Path, PathBuf};

use clap::ArgMatches;
use forcewright::base::text::{counted, visible};
use forcewright::model::{CheckState, StatusKind};
use forcewright::sweep::Axis;
use forcewright::{DiskFiles, Front, Loaded};

use super::optimise::{Watch, repeat_command, text_table};
use super::{choices, refuse, solve, sweep};
use crate::{exit, interrupt, output};

pub(crate) fn run(matches: &ArgMatches, front: &str) -> u8 {
    let (Some(file), Some(folder)) = (matches.get_one::<PathBuf>("file"), matches.get_one::<PathBuf>("out")) else { return exit::USAGE };
    let as_json = matches.get_flag("json");
    let stop = interrupt::flag();
    let axis = match Axis::parse_for("--front", front) {
        Ok(axis) => axis,
        Err(error) => return sweep::failed(&error, as_json),
    };
    let loaded = match Loaded::from_file(&DiskFiles, file, &choices(matches)) {
        Ok(loaded) => loaded,
        Err(refused) => return refuse(&refused, as_json),
    };
    let asked = loaded.task().and_then(|(task, said)| Ok((task, said, loaded.front_task(&DiskFiles, &axis)?)));
    let (task, said, points) = match asked {
        Ok(asked) => asked,
        Err(refused) => return refuse(&refused, as_json),
    };
    for diagnostics in [&loaded.project.diagnostics, &said] {
        output::narrate(&diagnostics.render(&loaded.project.sources, output::colour_on_stderr()));
    }
    // Whether the results can be written is found out before the work, not after.
    if let Err(failed) = output::prepare(folder) {
        return output::write_failed(&failed, as_json);
    }
    let options = (matches.get_one::<u32>("starts").copied(), matches.get_one::<u32>("seed").copied());
    let starts = options.0.unwrap_or(loaded.starts());
    let variables = task.evaluator.variables().len();
    let how = if starts > 0 { format!("starts of each: {starts}") } else { "the whole range for each".to_owned() };
    let text = format!("searching: {}; points: {}, variables: {variables}, {how}", task.title, points.len());
    output::narrate(&format!("{}\n", visible(&text)));
    let watch = Watch::new(&stop, starts, task.steps.len(), loaded.wording(&task, None));
    let values = points.values();
    let found = points.search(&DiskFiles, folder, options, &|progress| watch.see_point(progress, &values));
    watch.done();
    match found {
        Ok(found) => finish(&found, matches, file, folder),
        Err(refused) => refuse(&refused, as_json),
    }
}

/// Prints what was found and writes it; the exit code for it.
fn finish(found: &Front, matches: &ArgMatches, file: &Path, folder: &Path) -> u8 {
    let document = output::json_text(&found.document());
    if matches.get_flag("json") {
        output::print(&document);
    } else {
        solve::show(&summary(found));
    }
    let page = found.page(&file.display().to_string(), &repeat_command(matches, file, folder));
    let mut files: Vec<(String, String)> = found.points.iter().filter_map(|p| Some((p.file.clone(), p.found.text.clone()?))).collect();
    let written = files.len();
    if written > 0 {
        files.extend(
            [("front.csv", found.csv()), ("report.html", page), ("result.json", document)].map(|(name, text)| (name.to_owned(), text)),
        );
        if let Err(failed) = output::write_all(folder, &files) {
            // The document, if one was asked for, is printed already.
            return output::write_failed(&failed, false);
        }
        let text = format!("wrote {}, front.csv, report.html, result.json in {}", counted(written, "project file"), folder.display());
        output::narrate(&format!("{}\n", visible(&text)));
    }
    let complete = |p: &forcewright::FrontPoint| p.found.after.as_ref().is_some_and(|r| r.outcome.status.kind == StatusKind::Complete);
    if found.interrupted {
        exit::INTERRUPTED
    } else if !found.points.iter().any(complete) {
        exit::NOT_CONVERGED
    } else if found.points.iter().all(|p| p.requirements() == CheckState::Met) {
        exit::MET
    } else {
        exit::MISSED
    }
}

/// What is printed.
fn summary(found: &Front) -> String {
    let words: Vec<String> = found.verdict().iter().map(|s| format!("{}: {}", s.title, s.text)).collect();
    format!("{}\n\n{}", words.join("\n"), text_table(&found.table()))
}
