//! `forcewright optimise`: searches for a better design and writes it as a project file, with a report of the search.

use std::fmt::Write as _;
use std::io::{IsTerminal, stderr};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use clap::ArgMatches;
use forcewright::base::text::visible;
use forcewright::base::units::format_number;
use forcewright::model::{StudyColumn, StudyTable};
use forcewright::report::{html, json};
use forcewright::study::optimise::Progress;
use forcewright::{DiskFiles, FrontProgress, Loaded, Optimised, Wording};
use indicatif::ProgressBar;

use super::{choices, refuse, solve};
use crate::table::{Align, columns};
use crate::{exit, interrupt, output};

/// How often a terminal, and a file of narration, is told where the search stands.
const ON_A_TERMINAL: Duration = Duration::from_millis(100);
const IN_A_FILE: Duration = Duration::from_secs(5);
/// A violation that needs no word, relative to the scale of its limit.
const KEPT: f64 = 1e-4;

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    if let Some(front) = matches.get_one::<String>("front") {
        return super::front::run(matches, front);
    }
    let (Some(file), Some(folder)) = (matches.get_one::<PathBuf>("file"), matches.get_one::<PathBuf>("out")) else { return exit::USAGE };
    let as_json = matches.get_flag("json");
    let stop = interrupt::flag();
    let loaded = match Loaded::from_file(&DiskFiles, file, &choices(matches)) {
        Ok(loaded) => loaded,
        Err(refused) => return refuse(&refused, as_json),
    };
    let (task, said) = match loaded.task() {
        Ok(task) => task,
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
    let how = if starts > 0 { format!("starts: {starts}") } else { "the whole range".to_owned() };
    output::narrate(&format!("searching: {}; variables: {variables}, {how}\n", task.title));
    let target = folder.join(new_name(file));
    let watch = Watch::new(&stop, starts, task.steps.len(), loaded.wording(&task, None));
    let found = loaded.optimise(&DiskFiles, &target, options, &|progress| watch.see(progress));
    watch.done();
    match found {
        Ok(found) => finish(&found, &loaded, &target, &repeat_command(matches, file, folder), as_json),
        Err(refused) => refuse(&refused, as_json),
    }
}

/// Prints what was found and writes it; the exit code for it.
fn finish(found: &Optimised, loaded: &Loaded, target: &Path, command: &str, as_json: bool) -> u8 {
    let (folder, name) = (target.parent().unwrap_or(Path::new(".")), target.file_name().unwrap_or_default().to_string_lossy().into_owned());
    let report = found.report(command);
    let mut document = json::document(&report.outcome, &report.input_sha256, &report.version);
    document["study"] = found.document();
    document["study"]["file"] = found.text.as_ref().map(|_| name.as_str()).into();
    let document = output::json_text(&document);
    if as_json {
        output::print(&document);
    } else {
        let text = summary(found) + "\n" + &solve::summary(&report, loaded.project.diagnostics.warnings().len());
        solve::show(&text);
    }
    if let Some(text) = &found.text {
        let files = [(name, text.clone()), ("report.html".to_owned(), html::page(&report)), ("result.json".to_owned(), document)];
        if let Err(failed) = output::write_all(folder, &files) {
            // The document, if one was asked for, is printed already.
            return output::write_failed(&failed, false);
        }
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        let state = if found.met() { "" } else { "; the new design does not meet all requirements" };
        output::narrate(&visible(&format!("wrote {} in {}{state}", names.join(", "), folder.display())));
        output::narrate("\n");
    }
    match found.after.as_ref() {
        _ if found.search.interrupted => exit::INTERRUPTED,
        Some(after) => solve::exit_code(&after.outcome),
        None => exit::NOT_CONVERGED,
    }
}

/// The new file's name: `a.toml` becomes `a-optimised.toml`.
fn new_name(file: &Path) -> String {
    format!("{}-optimised.toml", file.file_stem().unwrap_or_default().to_string_lossy())
}

/// The commands that make this result again, and that look at it.
pub(super) fn repeat_command(matches: &ArgMatches, file: &Path, folder: &Path) -> String {
    let mut command = solve::repeat_command("optimise", file, Some(folder), &choices(matches));
    if let Some(front) = matches.get_one::<String>("front") {
        let _ = write!(command, " --front {}", solve::quote(front));
    }
    for option in ["starts", "seed"] {
        if let Some(value) = matches.get_one::<u32>(option) {
            let _ = write!(command, " --{option} {value}");
        }
    }
    command
}

/// What the search found, for a terminal.
fn summary(found: &Optimised) -> String {
    let mut out = String::new();
    for statement in found.verdict() {
        let _ = writeln!(out, "{}: {}", statement.title, statement.text);
    }
    for table in [Some(found.variable_table()), found.active_table(), found.place_table(), found.basin_table()].into_iter().flatten() {
        let _ = write!(out, "\n{}\n", text_table(&table));
    }
    out
}

pub(super) fn text_table(table: &StudyTable) -> String {
    let (mut heads, mut align) = (Vec::new(), Vec::new());
    for column in &table.columns {
        let (StudyColumn::Text(title) | StudyColumn::Number(title) | StudyColumn::Code(title)) = column;
        heads.push(title.clone());
        align.push(if matches!(column, StudyColumn::Number(_)) { Align::Right } else { Align::Left });
    }
    let rows: Vec<Vec<String>> = [heads].into_iter().chain(table.rows.iter().cloned()).collect();
    format!("{}\n{}", table.caption, columns(&rows, &align).trim_end())
}

/// Tells where the search stands, and stops it.
pub(super) struct Watch<'a> {
    stop: &'a AtomicBool,
    starts: usize,
    steps: usize,
    wording: Wording,
    terminal: bool,
    state: Mutex<State>,
}

struct State {
    told: Instant,
    bar: Option<ProgressBar>,
    /// Goal and violation of the best design of a last step.
    best: Option<[f64; 2]>,
    /// Point and pass of a front that they are of.
    of: (usize, usize),
}

impl<'a> Watch<'a> {
    pub(super) fn new(stop: &'a AtomicBool, starts: u32, steps: usize, wording: Wording) -> Self {
        let state = State { told: Instant::now(), bar: None, best: None, of: (0, 0) };
        Self { stop, starts: starts as usize, steps, wording, terminal: stderr().is_terminal(), state: Mutex::new(state) }
    }

    /// Sees an iteration; whether to go on.
    fn see(&self, progress: &Progress) -> bool {
        self.see_search(progress, (0, 0), self.starts, &|line| line)
    }

    /// Sees an iteration of a point of a front, which has these values; whether to go on.
    pub(super) fn see_point(&self, progress: &FrontProgress, values: &[String]) -> bool {
        let again = if progress.pass == 0 { "" } else { ", again" };
        let named = |line: String| {
            let value = values.get(progress.point).map_or("", String::as_str);
            visible(&format!("point {} of {} ({value}){again}, {line}", progress.point + 1, values.len())).into_owned()
        };
        self.see_search(&progress.search, (progress.point, progress.pass), progress.starts, &named)
    }

    fn see_search(&self, progress: &Progress, of: (usize, usize), starts: usize, named: &dyn Fn(String) -> String) -> bool {
        // A thread that panicked holds no state that matters.
        let mut state = self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if state.of != of {
            (state.of, state.best) = (of, None);
        }
        if progress.step + 1 == self.steps && state.best.is_none_or(|best| better([progress.goal, progress.violation], best)) {
            state.best = Some([progress.goal, progress.violation]);
        }
        if state.told.elapsed() >= if self.terminal { ON_A_TERMINAL } else { IN_A_FILE } {
            state.told = Instant::now();
            let text = named(self.line(progress, starts, state.best));
            if self.terminal {
                let bar = state.bar.get_or_insert_with(ProgressBar::new_spinner);
                bar.set_message(text);
                bar.tick();
            } else {
                output::narrate(&format!("{text}\n"));
            }
        }
        !self.stop.load(Ordering::Relaxed)
    }

    fn line(&self, progress: &Progress, starts: usize, best: Option<[f64; 2]>) -> String {
        let step = if self.steps > 1 { format!(", step {} of {}", progress.step + 1, self.steps) } else { String::new() };
        let best = match best {
            None => "on the way to a first design".to_owned(),
            Some([goal, violation]) if violation > KEPT => {
                format!("{} so far, a limit missed by {} %", self.wording.show(goal), format_number(100.0 * violation, 2))
            }
            Some([goal, _]) => format!("{} so far, all limits kept", self.wording.show(goal)),
        };
        if let Some(global) = progress.global {
            let (run, generation) = (global.run + 1, progress.iteration + 1);
            return format!("whole range, run {run}, generation {generation}, {} designs: {best}", global.evaluations);
        }
        // Of a search of the whole range nobody knows before how many places it leads to.
        let of = if starts > 0 { format!(" of {starts}") } else { String::new() };
        format!("start {}{of}{step}, iteration {}: {best}", progress.start + 1, progress.iteration)
    }

    /// Takes the line away.
    pub(super) fn done(self) {
        if let Some(bar) = self.state.into_inner().ok().and_then(|state| state.bar) {
            bar.finish_and_clear();
        }
    }
}

/// Whether a design is better than another, both as goal and violation: one that keeps the limits first.
fn better(new: [f64; 2], old: [f64; 2]) -> bool {
    match (new[1] <= KEPT, old[1] <= KEPT) {
        (true, true) => new[0] < old[0],
        (kept, other) if kept != other => kept,
        _ => new[1] < old[1],
    }
}
