//! `forcewright pareto`: designs of which none is better in every goal, with project files to choose from.

use std::fmt::Write as _;
use std::io::{IsTerminal, stderr};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use clap::ArgMatches;
use forcewright::base::text::{counted, visible};
use forcewright::{DiskFiles, Loaded, Pareto, ParetoProgress};
use indicatif::ProgressBar;

use super::optimise::text_table;
use super::{choices, refuse, solve};
use crate::{exit, interrupt, output};

/// How often a terminal, and a file of narration, is told where the search stands.
const ON_A_TERMINAL: Duration = Duration::from_millis(100);
const IN_A_FILE: Duration = Duration::from_secs(5);

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let (Some(file), Some(folder)) = (matches.get_one::<PathBuf>("file"), matches.get_one::<PathBuf>("out")) else { return exit::USAGE };
    let as_json = matches.get_flag("json");
    let stop = interrupt::flag();
    let loaded = match Loaded::from_file(&DiskFiles, file, &choices(matches)) {
        Ok(loaded) => loaded,
        Err(refused) => return refuse(&refused, as_json),
    };
    let number = |name: &str| matches.get_one::<u32>(name).copied();
    let task = match loaded.pareto_task(&DiskFiles, (number("population"), number("generations"), number("seed"))) {
        Ok(task) => task,
        Err(refused) => return refuse(&refused, as_json),
    };
    output::narrate(&loaded.project.diagnostics.render(&loaded.project.sources, output::colour_on_stderr()));
    // Whether the results can be written is found out before the work, not after.
    if let Err(failed) = output::prepare(folder) {
        return output::write_failed(&failed, as_json);
    }
    let (population, generations) = task.size();
    let goals: Vec<String> =
        task.goals().iter().map(|g| format!("{} `{}`", if g.large { "maximise" } else { "minimise" }, g.name)).collect();
    output::narrate(&format!(
        "searching: {}; variables: {}, at most {} designs\n",
        goals.join(", "),
        task.choices().len(),
        population * (generations + 1)
    ));
    let watch = Watch::new(generations);
    let found = task.search(&DiskFiles, folder, &stop, &|progress| watch.see(progress));
    watch.done();
    match found {
        Ok(found) => finish(&found, matches, file, folder),
        Err(refused) => refuse(&refused, as_json),
    }
}

/// Prints what was found and writes it; the exit code for it.
fn finish(found: &Pareto, matches: &ArgMatches, file: &Path, folder: &Path) -> u8 {
    let document = output::json_text(&found.document());
    if matches.get_flag("json") {
        output::print(&document);
    } else {
        let words: Vec<String> = found.verdict().iter().map(|s| format!("{}: {}", s.title, s.text)).collect();
        solve::show(&format!("{}\n\n{}\n", words.join("\n"), text_table(&found.table())));
    }
    if !found.designs.is_empty() {
        let page = found.page(&file.display().to_string(), &repeat_command(matches, file, folder));
        let mut files: Vec<(String, String)> = found.designs.iter().filter_map(|d| d.file.clone()).collect();
        let written = files.len();
        files.extend(
            [("front.csv", found.csv()), ("report.html", page), ("result.json", document)].map(|(name, text)| (name.to_owned(), text)),
        );
        if let Err(failed) = output::write_all(folder, &files) {
            // The document, if one was asked for, is printed already.
            return output::write_failed(&failed, false);
        }
        let state = if found.met() { "" } else { "; the design does not keep every limit" };
        let text =
            format!("wrote {}, front.csv, report.html, result.json in {}{state}", counted(written, "project file"), folder.display());
        output::narrate(&format!("{}\n", visible(&text)));
    }
    match (found.interrupted(), found.designs.is_empty(), found.met()) {
        (true, ..) => exit::INTERRUPTED,
        (_, true, _) => exit::NOT_CONVERGED,
        (.., true) => exit::MET,
        (.., false) => exit::MISSED,
    }
}

/// The command that makes this result again.
fn repeat_command(matches: &ArgMatches, file: &Path, folder: &Path) -> String {
    let mut command = solve::repeat_command("pareto", file, Some(folder), &choices(matches));
    for option in ["population", "generations", "seed"] {
        if let Some(value) = matches.get_one::<u32>(option) {
            let _ = write!(command, " --{option} {value}");
        }
    }
    command
}

/// Tells where the search stands.
struct Watch {
    generations: usize,
    terminal: bool,
    state: Mutex<(Instant, Option<ProgressBar>)>,
}

impl Watch {
    fn new(generations: usize) -> Self {
        Self { generations, terminal: stderr().is_terminal(), state: Mutex::new((Instant::now(), None)) }
    }

    fn see(&self, progress: &ParetoProgress) {
        // A thread that panicked holds no state that matters.
        let mut state = self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let (told, bar) = &mut *state;
        if told.elapsed() < if self.terminal { ON_A_TERMINAL } else { IN_A_FILE } {
            return;
        }
        *told = Instant::now();
        let text = format!(
            "generation {} of {}, {} designs computed, {} on the front so far",
            progress.generation, self.generations, progress.evaluations, progress.front
        );
        if self.terminal {
            let bar = bar.get_or_insert_with(ProgressBar::new_spinner);
            bar.set_message(text);
            bar.tick();
        } else {
            output::narrate(&format!("{text}\n"));
        }
    }

    /// Takes the line away.
    fn done(self) {
        if let Some(bar) = self.state.into_inner().ok().and_then(|state| state.1) {
            bar.finish_and_clear();
        }
    }
}
