//! `forcewright reproduce`: a paper's numbers beside ours.

use std::fmt::Write as _;

use clap::ArgMatches;
use forcewright::base::units::format_number;
use forcewright::contract::family::{Reproduction, ReproductionRow};
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
        all_agree &= !rows.is_empty() && rows.iter().all(|r| r.agrees() != Some(false));
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

fn cells(row: &ReproductionRow) -> [String; 4] {
    let paper = row.paper.map_or_else(|| "–".to_owned(), |p| format_number(p, 6));
    let difference = row.paper.map_or_else(|| "–".to_owned(), |p| format_number(row.ours - p, 2));
    let mark = match row.agrees() {
        Some(true) => "✓",
        Some(false) => "✗",
        None if row.paper.is_some() => "⚠",
        None => "·",
    };
    [paper, format_number(row.ours, 6), difference, mark.to_owned()]
}

fn text(reproduction: &Reproduction, rows: &[ReproductionRow]) -> String {
    let mut table = vec![["", "quantity", "unit", "paper", "ours", "difference", "where"].map(str::to_owned).to_vec()];
    for row in rows {
        let [paper, ours, difference, mark] = cells(row);
        table.push(vec![mark, row.quantity.clone(), row.unit.clone(), paper, ours, difference, row.place.clone()]);
    }
    let mut out = format!("{}\n\n", reproduction.title);
    out.push_str(&columns(&table, &[Align::Left, Align::Left, Align::Left, Align::Right, Align::Right, Align::Right, Align::Left]));
    out.push_str("\nWhy they differ:\n");
    for row in rows.iter().filter(|r| !r.why.is_empty()) {
        let _ = writeln!(out, "- {}: {}", row.quantity, row.why);
    }
    let agree = rows.iter().filter(|r| r.agrees() == Some(true)).count();
    let printed = rows.iter().filter(|r| r.paper.is_some()).count();
    let _ = writeln!(
        out,
        "\n{agree} of {printed} printed numbers reproduced within what is explained; ⚠ departs, see why; · has no printed number"
    );
    out
}

fn markdown(rows: &[ReproductionRow]) -> String {
    let mut out =
        String::from("| quantity | source | paper | computed | difference | | why |\n| --- | --- | ---: | ---: | ---: | --- | --- |\n");
    for row in rows {
        let [paper, ours, difference, mark] = cells(row);
        let status = match mark.as_str() {
            "✓" => "✅",
            "✗" => "❌",
            "⚠" => "⚠",
            _ => "🧪",
        };
        let unit = &row.unit;
        let _ = writeln!(
            out,
            "| {} / {unit} | {} | {paper} | {ours} | {difference} | {status} | {} |",
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
        .map(|r| json!({ "quantity": r.quantity, "where": r.place, "unit": r.unit, "paper": r.paper, "ours": r.ours, "explained": r.explained, "agrees": r.agrees(), "why": r.why }))
        .collect();
    json!({ "key": reproduction.key, "title": reproduction.title, "rows": rows })
}
