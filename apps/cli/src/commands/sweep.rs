//! `forcewright sweep`: a table of results over many designs.

use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use clap::ArgMatches;
use clap::parser::ValueSource;
use forcewright::DiskFiles;
use forcewright::base::text::visible;
use forcewright::sweep::{Axis, Formats, Outputs, Plan, Sampling, Shard, Started, Sweep, SweepError, Tally};
use serde_json::{Value, json};

use super::{choices, refuse};
use crate::progress::Progress;
use crate::{exit, interrupt, output};

/// What was asked for.
struct Call {
    json: bool,
    threads: usize,
    shard: Shard,
    outputs: Option<Outputs>,
}

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let json = matches.get_flag("json");
    let stop = interrupt::flag();
    let prepared = call(matches, json).and_then(|call| Ok((sweep(matches, &stop)?, call)));
    let ended = prepared.and_then(|(sweep, call)| match &call.outputs {
        Some(outputs) => to_files(&sweep, &call, outputs, &stop),
        None => to_standard_output(&sweep, &call, &stop),
    });
    ended.unwrap_or_else(|error| failed(&error, json))
}

fn call(matches: &ArgMatches, json: bool) -> Result<Call, SweepError> {
    let shard = matches.get_one::<String>("shard").map_or(Ok(Shard::WHOLE), |text| Shard::parse(text))?;
    let outputs = matches.get_one::<PathBuf>("out").map(|out| Outputs::new(out, formats(matches), matches.get_flag("force")));
    let threads = matches.get_one::<u16>("threads").map_or(0, |n| usize::from(*n));
    Ok(Call { json, threads, shard, outputs })
}

/// The formats asked for; without any, that of the name of the output.
pub(super) fn formats(matches: &ArgMatches) -> Formats {
    let array = matches.get_one::<PathBuf>("out").and_then(|out| out.extension()).is_some_and(|e| e == "npy");
    if array && matches.value_source("format") == Some(ValueSource::DefaultValue) {
        return Formats { csv: false, npy: true };
    }
    let asked = |name: &str| matches.get_many::<String>("format").into_iter().flatten().any(|f| f == name);
    Formats { csv: asked("csv"), npy: asked("npy") }
}

fn sweep(matches: &ArgMatches, stop: &AtomicBool) -> Result<Sweep, SweepError> {
    let texts = |name: &str| matches.get_many::<String>(name).into_iter().flatten();
    let axes = texts("vary").map(|text| Axis::parse(text)).collect::<Result<Vec<_>, _>>()?;
    let sampling =
        Sampling { points: matches.get_one::<u64>("points").copied(), seed: matches.get_one::<u64>("seed").copied().unwrap_or_default() };
    let plan = Plan::new(axes, sampling, matches.get_flag("yes"))?;
    let metrics: Vec<String> = texts("metrics").cloned().collect();
    let file = matches.get_one::<PathBuf>("file").cloned().unwrap_or_default();
    Sweep::new(&DiskFiles, &file, &choices(matches), plan, &metrics, stop)
}

/// Says how much there is to do.
fn announce(sweep: &Sweep, call: &Call, done: u64) {
    let range = call.shard.range(sweep.len());
    let left = range.end - range.start - done;
    let threads = match call.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        threads => threads,
    };
    let rounds = left.div_ceil(threads as u64);
    let time = duration(sweep.trial().mul_f64(rounds as f64).min(Duration::from_secs(u64::from(u32::MAX))));
    let designs = if left == 1 { "design" } else { "designs" };
    let found = if done > 0 { format!("{done} rows found, ") } else { String::new() };
    let several = if threads == 1 { "1 thread".to_owned() } else { format!("{threads} threads") };
    output::narrate(&format!("{found}{left} {designs} to compute on {several}, about {time}\n"));
}

fn duration(time: Duration) -> String {
    match time.as_secs_f64() {
        s if s < 1.0 => "a second".to_owned(),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} h", s / 3600.0),
        s => format!("{:.0} days", s / 86_400.0),
    }
}

fn to_files(sweep: &Sweep, call: &Call, outputs: &Outputs, stop: &AtomicBool) -> Result<u8, SweepError> {
    let mut part = match outputs.start(sweep, call.shard)? {
        Started::Complete(tally) => {
            output::narrate("this table is complete already\n");
            return Ok(report(sweep, call, &tally, "complete"));
        }
        Started::Open(part) => part,
    };
    announce(sweep, call, part.tally().designs);
    let range = part.next()..call.shard.range(sweep.len()).end;
    let mut bar = Progress::counted("sweeping", range.end - range.start);
    let path = part.path().to_owned();
    let result = sweep.run(range.clone(), call.threads, stop, &mut |row| {
        part.append(sweep, &row)?;
        bar.count(row.design - range.start);
        Ok(())
    });
    bar.done();
    result.map_err(|error| SweepError::File { path: path.clone(), error })?;
    if part.next() < range.end {
        let tally = part.tally().clone();
        let count = call.shard.range(sweep.len());
        let message = format!(
            "interrupted: {} of {} rows are kept in {}; the same command goes on",
            tally.designs,
            count.end - count.start,
            path.display()
        );
        output::narrate(&format!("{}\n", visible(&message)));
        report(sweep, call, &tally, "interrupted");
        return Ok(exit::INTERRUPTED);
    }
    let tally = part.finish(sweep, outputs, call.shard)?;
    let code = report(sweep, call, &tally, "complete");
    if call.shard == Shard::WHOLE {
        wrote(outputs);
    } else {
        output::narrate(&format!("{}\n", visible(&format!("wrote {}; `forcewright merge` joins the parts", path.display()))));
    }
    Ok(code)
}

/// Prints what came out, and gives the exit code for it.
fn report(sweep: &Sweep, call: &Call, tally: &Tally, status: &str) -> u8 {
    if call.json {
        output::print(&output::json_text(&document(sweep, tally, status)));
    } else {
        output::print(&summary(tally));
    }
    exit_code(tally)
}

fn document(sweep: &Sweep, tally: &Tally, status: &str) -> Value {
    let mut document = sweep.document().clone();
    document["status"] = json!({ "kind": status });
    document["counts"] = tally.json();
    document
}

/// Without `--out` the table goes to standard output, row by row, or into the one document.
fn to_standard_output(sweep: &Sweep, call: &Call, stop: &AtomicBool) -> Result<u8, SweepError> {
    announce(sweep, call, 0);
    let range = call.shard.range(sweep.len());
    let mut bar = Progress::counted("sweeping", range.end - range.start);
    let mut tally = Tally::new();
    let mut rows = Vec::new();
    let mut out = io::stdout().lock();
    let mut written = if call.json { Ok(()) } else { out.write_all(sweep.header().as_bytes()) };
    if written.is_ok() {
        let ran = sweep.run(range.clone(), call.threads, stop, &mut |row| {
            tally.add(sweep, &row);
            if call.json {
                rows.push(sweep.json(&row));
            } else {
                out.write_all(sweep.line(&row).as_bytes())?;
            }
            bar.count(row.design - range.start);
            Ok(())
        });
        written = ran.map(|_| ());
    }
    let _ = out.flush();
    drop(out);
    bar.done();
    match written {
        // `… | head`: the reader's choice.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(exit::MET),
        written => written.map_err(|error| SweepError::File { path: PathBuf::from("standard output"), error })?,
    }
    let whole = tally.designs == range.end - range.start;
    if call.json {
        let mut document = document(sweep, &tally, if whole { "complete" } else { "interrupted" });
        document["rows"] = rows.into();
        output::print(&output::json_text(&document));
    } else {
        output::narrate(&summary(&tally));
    }
    Ok(if whole { exit_code(&tally) } else { exit::INTERRUPTED })
}

/// Names the files that were written.
pub(super) fn wrote(outputs: &Outputs) {
    let names: Vec<String> = outputs.files().iter().map(|f| f.display().to_string()).collect();
    output::narrate(&format!("{}\n", visible(&format!("wrote {}", names.join(", ")))));
}

/// What the designs came to, for people.
pub(super) fn summary(tally: &Tally) -> String {
    let mut out = format!("{} design{}", tally.designs, if tally.designs == 1 { "" } else { "s" });
    for (index, (word, count)) in tally.status.iter().filter(|(_, count)| *count > 0).enumerate() {
        let _ = write!(out, "{} {count} {word}", if index == 0 { ":" } else { "," });
    }
    out.push('\n');
    if tally.met + tally.missed + tally.not_assessed > 0 {
        let _ = writeln!(out, "all requirements: {} met, {} missed, {} not assessed", tally.met, tally.missed, tally.not_assessed);
    }
    out
}

/// The exit code of a whole table.
pub(super) fn exit_code(tally: &Tally) -> u8 {
    let asked = tally.met + tally.missed + tally.not_assessed > 0;
    if tally.with_status("complete") == 0 {
        exit::NOT_CONVERGED
    } else if tally.met > 0 || !asked {
        exit::MET
    } else {
        exit::MISSED
    }
}

/// Reports why there is no table; the exit code for it.
pub(super) fn failed(error: &SweepError, json: bool) -> u8 {
    match error {
        SweepError::Project(refused) => refuse(refused, json),
        SweepError::Call(call) => {
            output::complain(call.code, &call.message, call.help.as_deref().unwrap_or("forcewright sweep --help"), json);
            exit::USAGE
        }
        SweepError::Unreadable { path, error } => {
            let message = format!("`{}` cannot be read: {error}", path.display());
            output::complain("E0101", &message, "check the path, and that it is readable for you", json);
            exit::IO
        }
        SweepError::File { path, error } => output::file_failed(path, error, json),
    }
}
