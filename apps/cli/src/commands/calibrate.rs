//! `forcewright calibrate`: numbers of a design from a measured curve.

use std::fmt::Write as _;
use std::io::{IsTerminal, stderr};
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use clap::ArgMatches;
use forcewright::base::text::visible;
use forcewright::base::units::format_number;
use forcewright::study::calibrate::{Progress, Stop};
use forcewright::{Calibrated, DiskFiles, Loaded, NoCalibration};

use super::solve::{quote, repeat_command};
use super::{choices, refuse};
use crate::table::{Align, columns};
use crate::{exit, interrupt, output};

/// The new file.
const NAME: &str = "calibrated.toml";
/// How often a file of narration is told where the search stands.
const OFTEN: Duration = Duration::from_secs(5);

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let Some(file) = matches.get_one::<PathBuf>("file") else { return exit::USAGE };
    let (as_json, out) = (matches.get_flag("json"), matches.get_one::<PathBuf>("out"));
    let loaded = match Loaded::from_file(&DiskFiles, file, &choices(matches)) {
        Ok(loaded) => loaded,
        Err(refused) => return refuse(&refused, as_json),
    };
    // Whether the results can be written is found out before the work, not after.
    if let Some(folder) = out
        && let Err(failed) = output::prepare(folder)
    {
        return output::write_failed(&failed, as_json);
    }
    let stop = interrupt::flag();
    let mut told = Told::new();
    let target = out.map(|folder| folder.join(NAME));
    let found = loaded.calibrate(&DiskFiles, target.as_deref(), &mut |progress| {
        told.see(progress);
        !stop.load(Ordering::Relaxed)
    });
    told.done();
    let found = match found {
        Ok(found) => found,
        Err(NoCalibration::Refused(refused)) => return refuse(&refused, as_json),
        Err(NoCalibration::NoStart(refused)) => {
            refuse(&refused, as_json);
            return exit::NOT_CONVERGED;
        }
    };
    output::narrate(&found.diagnostics.render(&found.sources, output::colour_on_stderr()));
    let document = output::json_text(&found.document());
    output::tell(as_json, &document, || summary(&found));
    if let Some(folder) = out {
        let command = repeat_command("calibrate", file, Some(folder), &choices(matches));
        let page = found.page(&file.display().to_string(), &command);
        let mut files = vec![("report.html".to_owned(), page), ("result.json".to_owned(), document)];
        files.extend(found.text.clone().map(|text| (NAME.to_owned(), text)));
        if let Err(code) = output::deliver(folder, &files) {
            return code;
        }
        let solve = format!("forcewright solve {} --variant {}", quote(&folder.join(NAME).display().to_string()), quote(&found.variant));
        output::narrate(&format!("{}\n", visible(&format!("the design with the estimates: {solve}"))));
    }
    match &found.fit.stop {
        Stop::Interrupted => exit::INTERRUPTED,
        Stop::Converged if found.sound() => exit::MET,
        Stop::Converged => exit::MISSED,
        Stop::Stalled | Stop::RoundLimit | Stop::NoStart(_) => exit::NOT_CONVERGED,
    }
}

/// Tells where the search stands.
struct Told {
    last: Instant,
    said: String,
    bar: Option<indicatif::ProgressBar>,
}

impl Told {
    fn new() -> Self {
        let bar = stderr().is_terminal().then(indicatif::ProgressBar::new_spinner);
        Self { last: Instant::now(), said: String::new(), bar }
    }

    fn see(&mut self, progress: Progress) {
        let line = || match progress {
            Progress::Search { rounds, squares } => {
                format!("fitting: round {rounds}, root of the squares {}", format_number(squares.sqrt(), 4))
            }
            Progress::Intervals { found, of } => format!("intervals: {found} of {of} ends"),
        };
        if let Some(bar) = &self.bar {
            bar.set_message(line());
            bar.tick();
        } else if self.last.elapsed() >= OFTEN {
            self.last = Instant::now();
            let line = line();
            // A long round says the same again.
            if line != self.said {
                output::narrate(&format!("{line}\n"));
                self.said = line;
            }
        }
    }

    fn done(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}

/// What is printed.
fn summary(found: &Calibrated) -> String {
    let left = if found.points.left_out > 0 { format!(", {} left out", found.points.left_out) } else { String::new() };
    let mut out = format!("{}\n{}: {} points{left}\n\n", found.before.outcome.title, found.measurement, found.points.x.len());
    let share = format!("{} %", format_number(100.0 * found.confidence.level(), 3));
    let mut rows = vec![["parameter", "before", "estimate", &share, "likelihood", ""].map(str::to_owned).to_vec()];
    rows.extend(found.rows().into_iter().map(Vec::from));
    out.push_str(&columns(&rows, &[Align::Left, Align::Right, Align::Right, Align::Right, Align::Right, Align::Left]));
    let _ = writeln!(out, "\n{}", found.residual_verdict());
    if let Some(far) = found.hardly_counting() {
        let _ = writeln!(out, "{far}");
    }
    let _ = writeln!(out, "{}", found.verdict());
    out
}
