//! `forcewright solve`: analyses a project, prints its requirements and key numbers, writes the report.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::ArgMatches;
use forcewright::base::text::visible;
use forcewright::base::units::{format_number, format_si};
use forcewright::model::{Check, CheckState, Outcome, Report, Sense, StatusKind};
use forcewright::report::{csv, html, json, svg};
use forcewright::{DiskFiles, Loaded};

use super::{choices, refuse};
use crate::progress::Progress;
use crate::table::{Align, columns};
use crate::{exit, output};

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let Some(file) = matches.get_one::<PathBuf>("file") else { return exit::USAGE };
    let as_json = matches.get_flag("json");
    let out = matches.get_one::<PathBuf>("out");
    let choices = choices(matches);
    let loaded = match Loaded::from_file(&DiskFiles, file, &choices) {
        Ok(loaded) => loaded,
        Err(refused) => {
            let code = refuse(&refused, as_json);
            if let Some(folder) = out.filter(|f| f.join("report.html").exists()) {
                output::narrate(&visible(&format!("note: {} still holds the results of an earlier run", folder.display())));
                output::narrate("\n");
            }
            return code;
        }
    };
    output::narrate(&loaded.project.diagnostics.render(&loaded.project.sources, output::colour_on_stderr()));
    // Whether the results can be written is found out before the work, not after.
    if let Some(folder) = out
        && let Err(failed) = output::prepare(folder)
    {
        return output::write_failed(&failed, as_json);
    }
    let mut bar = Progress::new("solving");
    let mut report =
        loaded.solve(&file.display().to_string(), &repeat_command("solve", file, out.map(PathBuf::as_path), &choices), &mut |fraction| {
            bar.show(fraction);
            true
        });
    bar.done();
    if out.is_some() {
        report.figures.extend(loaded.part_figure());
    }
    let document = output::json_text(&json::document(&report.outcome, &report.input_sha256, &report.version));
    if as_json {
        output::print(&document);
    } else {
        show(&summary(&report, loaded.project.diagnostics.warnings().len()));
    }
    if let Some(folder) = out {
        let mut files = vec![
            ("report.html".to_owned(), html::page(&report)),
            ("result.json".to_owned(), document),
            ("curves.csv".to_owned(), csv::curves(&report.outcome)),
        ];
        files.extend(report.figures.iter().map(|f| (format!("{}.svg", f.id), svg::standalone(f))));
        if let Err(failed) = output::write_all(folder, &files) {
            // The document, if one was asked for, is printed already.
            return output::write_failed(&failed, false);
        }
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        output::narrate(&visible(&format!("wrote {} in {}", names.join(", "), folder.display())));
        output::narrate("\n");
    }
    exit_code(&report.outcome)
}

/// Prints lines for people.
pub(super) fn show(text: &str) {
    // Titles and names are typed by somebody: shown, not obeyed.
    let shown: Vec<_> = text.lines().map(|line| visible(line).into_owned()).collect();
    output::print(&coloured(shown.join("\n") + "\n", output::colour_on_stdout()));
}

/// The exit code of a result.
pub(super) fn exit_code(outcome: &Outcome) -> u8 {
    match outcome.status.kind {
        StatusKind::Interrupted => exit::INTERRUPTED,
        StatusKind::Complete if outcome.requirements_met() => exit::MET,
        StatusKind::Complete => exit::MISSED,
        StatusKind::NoEquilibriumBeyond | StatusKind::UnstableBeyond | StatusKind::NotConverged | StatusKind::ReducedAccuracy => {
            exit::NOT_CONVERGED
        }
    }
}

/// The command that makes this result again.
pub(super) fn repeat_command(command: &str, file: &Path, out: Option<&Path>, choices: &forcewright::Choices) -> String {
    let mut command = format!("forcewright {command} {}", quote(&file.display().to_string()));
    if let Some(variant) = &choices.variant {
        let _ = write!(command, " --variant {}", quote(variant));
    }
    for setting in &choices.set {
        let _ = write!(command, " --set {}", quote(setting));
    }
    if let Some(out) = out {
        let _ = write!(command, " --out {}", quote(&out.display().to_string()));
    }
    command
}

/// Quotes a word for a POSIX shell where it needs it.
pub(super) fn quote(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

/// What is printed; the last warnings of a report are those of the file, and so many of them have been shown with their places.
pub(super) fn summary(report: &Report, shown: usize) -> String {
    let outcome = &report.outcome;
    let mut out = format!("{}\n", outcome.title);
    if let Some(variant) = &report.variant {
        let _ = writeln!(out, "variant {variant}");
    }
    out.push('\n');
    let (required, further): (Vec<&Check>, Vec<&Check>) = outcome.checks.iter().partition(|c| c.required);
    if required.is_empty() {
        out.push_str("no requirements given\n");
    } else {
        out.push_str(&check_table("requirement", required.iter().copied()));
    }
    if !further.is_empty() {
        out.push('\n');
        out.push_str(&check_table("further check", further.iter().copied()));
    }
    let advice: Vec<&Check> = outcome.checks.iter().filter(|c| c.advice.is_some()).collect();
    if !advice.is_empty() {
        out.push('\n');
        for check in advice {
            let _ = writeln!(out, "{} {}: {}", check.code, check.name, check.advice.as_deref().unwrap_or_default());
        }
    }
    out.push('\n');
    let rows: Vec<Vec<String>> = outcome
        .metrics
        .iter()
        .filter(|m| m.key)
        .map(|m| vec![m.name.to_owned(), format_si(m.value, &m.display, 5), m.doc.to_owned()])
        .collect();
    out.push_str(&columns(&rows, &[Align::Left, Align::Right, Align::Left]));
    let warnings = outcome.warnings.get(..outcome.warnings.len().saturating_sub(shown)).unwrap_or_default();
    if !warnings.is_empty() {
        out.push('\n');
        for warning in warnings {
            let _ = writeln!(out, "warning[{}]: {}", warning.code, warning.message);
        }
    }
    out.push('\n');
    let accuracy =
        outcome.error_estimate.map_or_else(String::new, |e| format!("; estimated error {} of the largest force", format_number(e, 2)));
    let _ = writeln!(out, "{}: {}{accuracy}", outcome.status.kind.word(), outcome.status.message);
    if let Some(advice) = &outcome.status.advice {
        let _ = writeln!(out, "  help: {advice}");
    }
    for (what, checks) in [("requirements", &required), ("further checks", &further)] {
        let count = |state| checks.iter().filter(|c| c.state == state).count();
        let [met, missed, unknown] = [CheckState::Met, CheckState::Missed, CheckState::NotAssessed].map(count);
        if !checks.is_empty() {
            let _ = writeln!(out, "{what}: {met} met, {missed} missed, {unknown} not assessed");
        }
    }
    out
}

/// A relative margin as a signed percentage; beyond ten times the limit only the sign matters.
fn margin(margin: f64) -> String {
    match margin {
        m if m > 10.0 => "> +1000 %".to_owned(),
        m if m < -10.0 => "< -1000 %".to_owned(),
        m => format!("{:+.1} %", 100.0 * m),
    }
}

/// Checks as a table.
pub(super) fn check_table<'a>(what: &str, checks: impl IntoIterator<Item = &'a Check>) -> String {
    let mut rows = vec![["", what, "found", "limit", "margin", "code"].map(str::to_owned).to_vec()];
    for check in checks {
        let mark = match check.state {
            CheckState::Met => "✓ met",
            CheckState::Missed => "✗ missed",
            CheckState::NotAssessed => "? not assessed",
        };
        let sign = if check.sense == Sense::AtMost { "≤" } else { "≥" };
        let show = |value: f64| format_si(value, &check.display, 4);
        rows.push(vec![
            mark.to_owned(),
            check.title.clone(),
            check.value.map_or_else(|| "–".to_owned(), show),
            check.limit.map_or_else(|| "–".to_owned(), |l| format!("{sign} {}", show(l))),
            check.margin.map_or_else(|| "–".to_owned(), margin),
            check.code.to_owned(),
        ]);
    }
    columns(&rows, &[Align::Left, Align::Left, Align::Right, Align::Right, Align::Right, Align::Left])
}

/// The marks of the requirements in their colours.
fn coloured(text: String, colour: bool) -> String {
    if !colour {
        return text;
    }
    text.replace("✓ met", "\u{1b}[32m✓ met\u{1b}[0m")
        .replace("✗ missed", "\u{1b}[31m✗ missed\u{1b}[0m")
        .replace("? not assessed", "\u{1b}[33m? not assessed\u{1b}[0m")
}
