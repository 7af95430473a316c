//! `forcewright synthesise`: from requirements to project files of designs that meet them, with a page that compares them.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::ArgMatches;
use forcewright::base::text::visible;
use forcewright::{Choices, DiskFiles, Stage, SynthesisProgress, SynthesisTask, Synthesised};

use super::optimise::text_table;
use super::{refuse, solve};
use crate::progress::Progress;
use crate::{exit, interrupt, output};

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let (Some(file), Some(folder)) = (matches.get_one::<PathBuf>("file"), matches.get_one::<PathBuf>("out")) else { return exit::USAGE };
    let as_json = matches.get_flag("json");
    let stop = interrupt::flag();
    let task = match SynthesisTask::from_file(&DiskFiles, file, &set_of(matches).set) {
        Ok(task) => task,
        Err(refused) => return refuse(&refused, as_json),
    };
    let (said, sources) = task.diagnostics();
    output::narrate(&said.render(sources, output::colour_on_stderr()));
    // Whether the results can be written is found out before the work, not after.
    if let Err(failed) = output::prepare(folder) {
        return output::write_failed(&failed, as_json);
    }
    let watch = Watch { stop: &stop, state: Mutex::new(None) };
    let found = task.run(&folder.join(file.file_name().unwrap_or_default()), &|progress| watch.see(progress));
    watch.done();
    finish(&found, matches, file, folder)
}

/// The settings of the call; variants are of designs.
fn set_of(matches: &ArgMatches) -> Choices {
    Choices { variant: None, set: matches.get_many::<String>("set").map(|v| v.cloned().collect()).unwrap_or_default() }
}

/// Prints what was found and writes it; the exit code for it.
fn finish(found: &Synthesised, matches: &ArgMatches, file: &Path, folder: &Path) -> u8 {
    let document = output::json_text(&found.document());
    if matches.get_flag("json") {
        output::print(&document);
    } else {
        solve::show(&summary(found));
    }
    let command = solve::repeat_command("synthesise", file, Some(folder), &set_of(matches));
    let mut files: Vec<(String, String)> = found.designs.iter().map(|d| (d.file.clone(), d.text.clone())).collect();
    files.push(("report.html".to_owned(), found.page(&file.display().to_string(), &command)));
    files.push(("result.json".to_owned(), document));
    if let Err(failed) = output::write_all(folder, &files) {
        // The document, if one was asked for, is printed already.
        return output::write_failed(&failed, false);
    }
    let old = earlier(file, folder, &files);
    if !old.is_empty() {
        let list = old.join(", ");
        output::narrate(&format!("{}\n", visible(&format!("note: {list} in {} are of an earlier synthesis", folder.display()))));
    }
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    output::narrate(&format!("{}\n", visible(&format!("wrote {} in {}", names.join(", "), folder.display()))));
    match (found.interrupted, found.met()) {
        (true, _) => exit::INTERRUPTED,
        (false, true) => exit::MET,
        (false, false) => exit::MISSED,
    }
}

/// Project files of an earlier synthesis of the same file, `FILE-2-SHAPE.toml`, that this one has not written: they are left as they are,
/// since somebody may have gone on from them.
fn earlier(file: &Path, folder: &Path, written: &[(String, String)]) -> Vec<String> {
    let stem = format!("{}-", file.file_stem().unwrap_or_default().to_string_lossy());
    let ours = |name: &String| {
        let rest = name.strip_prefix(&stem).and_then(|rest| rest.strip_suffix(".toml"));
        let number =
            rest.and_then(|rest| rest.split_once('-')).is_some_and(|(n, _)| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()));
        number && !written.iter().any(|(own, _)| own == name)
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let mut names: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).filter(ours).collect();
    names.sort_unstable();
    names
}

/// What is printed.
fn summary(found: &Synthesised) -> String {
    let words: Vec<String> = found.verdict().iter().map(|s| format!("{}: {}", s.title, s.text)).collect();
    let table = if found.designs.is_empty() { String::new() } else { format!("\n{}\n", text_table(&found.table())) };
    format!("{}\n{table}", words.join("\n"))
}

/// Tells where the work stands, and stops it.
struct Watch<'a> {
    stop: &'a AtomicBool,
    state: Mutex<Option<(Stage, Progress)>>,
}

impl Watch<'_> {
    fn see(&self, progress: &SynthesisProgress) -> bool {
        // A thread that panicked holds no state that matters.
        let mut state = self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if state.as_ref().is_none_or(|(stage, _)| *stage != progress.stage) {
            let what = match progress.stage {
                Stage::Sizing => "looking through what there is",
                Stage::Analysing => "analysing designs",
                Stage::Searching => "searching on from the nearest",
                Stage::Loosening => "loosening one limit at a time",
                Stage::Comparing => "comparing with alternatives",
            };
            if let Some((_, bar)) = state.take() {
                bar.done();
            }
            *state = Some((progress.stage, Progress::new(what)));
        }
        if let Some((_, bar)) = state.as_mut() {
            bar.show(progress.done as f64 / progress.of.max(1) as f64);
        }
        !self.stop.load(Ordering::Relaxed)
    }

    /// Takes the bar away.
    fn done(self) {
        if let Some((_, bar)) = self.state.into_inner().ok().flatten() {
            bar.done();
        }
    }
}
