//! `forcewright tolerance`: the yield of a design whose numbers scatter, and what it depends on.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use clap::ArgMatches;
use forcewright::study::tolerance::ToleranceError;
use forcewright::{DiskFiles, Loaded, NoTolerance, ToleranceChoices, Toleranced};

use super::solve::quote;
use super::{choices, refuse};
use crate::progress::Progress;
use crate::table::{Align, columns};
use crate::{exit, interrupt, output};

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
    let number = |name: &str| matches.get_one::<u32>(name).copied();
    let asked = ToleranceChoices { samples: number("samples"), seed: number("seed"), linear: number("linear") };
    let stop = interrupt::flag();
    let mut bar = Progress::new("drawing designs");
    let found = loaded.tolerance(asked, &mut |fraction| {
        bar.show(fraction);
        !stop.load(Ordering::Relaxed)
    });
    bar.done();
    let found = match found {
        Ok(found) => found,
        Err(NoTolerance::Refused(refused)) => return refuse(&refused, as_json),
        Err(NoTolerance::Study(error)) => return no_study(&error, as_json),
    };
    output::narrate(&found.diagnostics.render(&found.sources, output::colour_on_stderr()));
    let document = output::json_text(&found.document());
    output::tell(as_json, &document, || summary(&found));
    if let Some(folder) = out {
        let page = found.page(&file.display().to_string(), &repeat_command(matches, file));
        let files = [("report.html".to_owned(), page), ("result.json".to_owned(), document)];
        if let Err(code) = output::deliver(folder, &files) {
            return code;
        }
    }
    if found.study.interrupted {
        exit::INTERRUPTED
    } else if found.study.target_met() {
        exit::MET
    } else {
        exit::MISSED
    }
}

/// Says why no design was drawn; the exit code for it.
fn no_study(error: &ToleranceError, json: bool) -> u8 {
    output::complain("E0324", &error.to_string(), "`forcewright solve` says how far the nominal design comes", json);
    exit::NOT_CONVERGED
}

/// The command that makes this result again.
fn repeat_command(matches: &ArgMatches, file: &std::path::Path) -> String {
    let mut command = format!("forcewright tolerance {}", quote(&file.display().to_string()));
    let choices = choices(matches);
    if let Some(variant) = &choices.variant {
        let _ = write!(command, " --variant {}", quote(variant));
    }
    for setting in &choices.set {
        let _ = write!(command, " --set {}", quote(setting));
    }
    for name in ["samples", "seed", "linear"] {
        if let Some(number) = matches.get_one::<u32>(name) {
            let _ = write!(command, " --{name} {number}");
        }
    }
    if let Some(out) = matches.get_one::<PathBuf>("out") {
        let _ = write!(command, " --out {}", quote(&out.display().to_string()));
    }
    command
}

/// What is printed.
fn summary(found: &Toleranced) -> String {
    let mut out = format!("{}\n{} designs, seed {}\n\n", found.nominal.outcome.title, found.study.all.samples, found.seed);
    let mut rows = vec![["requirement", "limit", "nominal", "yield (95 %)", "linearised"].map(str::to_owned).to_vec()];
    rows.extend(found.yields().into_iter().map(Vec::from));
    out.push_str(&columns(&rows, &[Align::Left, Align::Right, Align::Right, Align::Right, Align::Right]));
    for failure in &found.study.failures {
        let _ = writeln!(out, "{} designs without a curve: {}", failure.count, failure.text);
    }
    out.push('\n');
    let mut rows = vec![["scatters", "half width", "factor", "needed for the target"].map(str::to_owned).to_vec()];
    rows.extend(found.needed().into_iter().map(Vec::from));
    out.push_str(&columns(&rows, &[Align::Left, Align::Right, Align::Right, Align::Right]));
    let _ = writeln!(out, "\n{}", found.verdict());
    out
}
