//! `forcewright reproduce`: a paper's numbers beside ours.

use std::fmt::Write as _;

use clap::ArgMatches;
use forcewright::base::units::format_number;
use forcewright::contract::reproduction::{Finding, Reproduction, ReproductionRow};
use serde_json::json;

use crate::progress::Progress;
use crate::table::{Align, columns};
use crate::{exit, output};

pub(crate) fn run(matches: &ArgMatches) -> u8 {
    let wanted = matches.get_one::<String>("paper");
    let format = matches.get_one::<String>("format").map_or("text", String::as_str);
    let mut all_agree = true;
    let mut documents = Vec::new();
    for reproduction in forcewright::reproductions().filter(|r| wanted.is_none_or(|w| w == r.key)) {
        let mut bar = Progress::new("reproducing");
        let rows = (reproduction.run)(&mut |fraction| {
            bar.show(fraction);
            true
        });
        bar.done();
        all_agree &= !rows.is_empty() && rows.iter().all(|r| r.finding() != Finding::Fails);
        match format {
            "markdown" => output::print(&markdown(&rows)),
            "json" => documents.push(document(reproduction, &rows)),
            _ => output::print(&text(reproduction, &rows)),
        }
    }
    if format == "json" {
        let document = json!({ "schema": 1, "forcewright": forcewright::VERSION, "papers": documents });
        output::print(&output::json_text(&document));
    }
    if all_agree { exit::MET } else { exit::MISSED }
}

/// Mark, the same in Markdown, and meaning of a finding.
fn sign(finding: Finding) -> [&'static str; 3] {
    match finding {
        Finding::Reproduced => ["✓", "✅", "reproduced within its digits or the stated reason"],
        Finding::Compatible => ["≈", "≈", "measured on a bench; ours lies within what that bench may differ"],
        Finding::Met => ["=", "=", "met by a quantity that was chosen for it"],
        Finding::Misprint => ["!", "❗", "error in print, see why"],
        Finding::Departs => ["⚠", "⚠", "departs, see why"],
        Finding::Fails => ["✗", "❌", "differs by more than is explained"],
        Finding::NotPrinted => ["·", "🧪", "has no printed number"],
    }
}

/// Findings in the order in which they are counted.
const FINDINGS: [Finding; 7] =
    [Finding::Reproduced, Finding::Compatible, Finding::Met, Finding::Misprint, Finding::Departs, Finding::Fails, Finding::NotPrinted];

/// How many rows there are of each finding that occurs: mark, count, meaning.
fn counts(rows: &[ReproductionRow]) -> Vec<(Finding, usize)> {
    FINDINGS.map(|f| (f, rows.iter().filter(|r| r.finding() == f).count())).into_iter().filter(|(_, count)| *count > 0).collect()
}

/// Printed, ours, difference.
fn cells(row: &ReproductionRow) -> [String; 3] {
    let paper = row.paper.map_or_else(|| "–".to_owned(), |p| format_number(p, 6));
    let difference = row.paper.map_or_else(|| "–".to_owned(), |p| format_number(row.ours - p, 2));
    [paper, format_number(row.ours, 6), difference]
}

fn text(reproduction: &Reproduction, rows: &[ReproductionRow]) -> String {
    let mut table = vec![["", "quantity", "unit", "paper", "ours", "difference", "where"].map(str::to_owned).to_vec()];
    for row in rows {
        let [paper, ours, difference] = cells(row);
        let [mark, ..] = sign(row.finding());
        table.push(vec![mark.to_owned(), row.quantity.clone(), row.unit.clone(), paper, ours, difference, row.place.clone()]);
    }
    let mut out = format!("{}\n\n", reproduction.title);
    out.push_str(&columns(&table, &[Align::Left, Align::Left, Align::Left, Align::Right, Align::Right, Align::Right, Align::Left]));
    out.push_str("\nWhy they differ:\n");
    for row in rows.iter().filter(|r| !r.why.is_empty()) {
        let _ = writeln!(out, "- {}: {}", row.quantity, row.why);
    }
    out.push('\n');
    for (finding, count) in counts(rows) {
        let [mark, _, meaning] = sign(finding);
        let _ = writeln!(out, "{mark} {count:>3}  {meaning}");
    }
    out
}

fn markdown(rows: &[ReproductionRow]) -> String {
    let mut out = String::new();
    for (finding, count) in counts(rows) {
        let [_, mark, meaning] = sign(finding);
        let _ = writeln!(out, "- {mark} {count} × {meaning}");
    }
    out.push_str("\n| quantity | source | paper | computed | difference | | why |\n| --- | --- | ---: | ---: | ---: | --- | --- |\n");
    for row in rows {
        let [paper, ours, difference] = cells(row);
        let [_, mark, _] = sign(row.finding());
        let unit = &row.unit;
        let _ = writeln!(
            out,
            "| {} / {unit} | {} | {paper} | {ours} | {difference} | {mark} | {} |",
            row.quantity,
            row.place,
            row.why.replace('|', "\\|")
        );
    }
    out
}

fn document(reproduction: &Reproduction, rows: &[ReproductionRow]) -> serde_json::Value {
    let rows: Vec<_> = rows
        .iter()
        .map(|r| json!({ "quantity": r.quantity, "where": r.place, "unit": r.unit, "paper": r.paper, "ours": r.ours, "explained": r.explained, "finding": word(r.finding()), "why": r.why }))
        .collect();
    json!({ "key": reproduction.key, "title": reproduction.title, "rows": rows })
}

/// Stable word for scripts.
fn word(finding: Finding) -> &'static str {
    match finding {
        Finding::Reproduced => "reproduced",
        Finding::Compatible => "compatible",
        Finding::Met => "fitted",
        Finding::Misprint => "misprint",
        Finding::Departs => "departs",
        Finding::Fails => "fails",
        Finding::NotPrinted => "not printed",
    }
}
