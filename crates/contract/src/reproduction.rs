//! A paper's numbers beside ours: what all families share. The printed ones are data, ours are computed in the run.

use forcewright_base::diagnostics::{Diagnostics, Span};

use crate::family::Progress;
use crate::tree::{self, Table, Value};

/// A paper whose numbers a family computes.
#[derive(Clone, Copy)]
pub struct Reproduction {
    /// Key in the bibliography: `lan2010`.
    pub key: &'static str,
    /// The paper, in words.
    pub title: &'static str,
    /// Computes every row anew.
    pub run: fn(Progress<'_>) -> Vec<ReproductionRow>,
}

/// What a printed number is, and so what agreement with it says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// It follows from the paper's theory and data: agreement shows that ours is the same mechanics.
    Computed,
    /// It was measured on a bench: agreement within what a bench may differ shows only that nothing large is missing.
    Measured,
    /// Something that ours is computed from was chosen to meet it: agreement shows that it can be met.
    Fitted,
    /// It is an error in print, which `why` shows: ours is another number.
    Misprint,
}

/// Words of the data for [`Evidence`]; without one it is computed.
const EVIDENCE: [(&str, Evidence); 3] = [("measured", Evidence::Measured), ("fitted", Evidence::Fitted), ("misprint", Evidence::Misprint)];

/// One number of a paper.
#[derive(Clone, Debug)]
pub struct ReproductionRow {
    /// The quantity.
    pub quantity: String,
    /// Table, figure or equation of the paper.
    pub place: String,
    /// As printed; empty where the paper prints none.
    pub paper: Option<f64>,
    /// As computed in this run.
    pub ours: f64,
    /// Unit of both.
    pub unit: String,
    /// Largest difference that the printed digits, or the stated reason, explain: absolute, in the unit. A printed number without it
    /// departs for a reason that is not known.
    pub explained: Option<f64>,
    /// What the printed number is.
    pub evidence: Evidence,
    /// Why they differ, or why the paper's number is not reached.
    pub why: String,
}

/// What a row shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    /// A computed number is reproduced within what its digits or a stated reason explain.
    Reproduced,
    /// A measured number lies within what the bench may differ.
    Compatible,
    /// A fitted number is met.
    Met,
    /// An error in print.
    Misprint,
    /// A printed number departs for no known reason, as the data say.
    Departs,
    /// The difference is larger than what the data explain: something has changed.
    Fails,
    /// The paper prints no number.
    NotPrinted,
}

impl ReproductionRow {
    /// What it shows.
    pub fn finding(&self) -> Finding {
        let Some(paper) = self.paper else { return Finding::NotPrinted };
        let Some(explained) = self.explained else { return Finding::Departs };
        // Written so that a value that is not a number fails.
        if (self.ours - paper).abs() <= explained {
            match self.evidence {
                Evidence::Computed => Finding::Reproduced,
                Evidence::Measured => Finding::Compatible,
                Evidence::Fitted => Finding::Met,
                Evidence::Misprint => Finding::Misprint,
            }
        } else {
            Finding::Fails
        }
    }
}

/// The rows of a table `[[row]]` with `id`, `quantity`, `where`, `paper`, `unit`, `explained`, `kind` and `why`; `ours` computes the value
/// of an `id`. Ends early where `progress` says so.
pub fn rows(data: &str, progress: Progress<'_>, mut ours: impl FnMut(&str) -> f64) -> Vec<ReproductionRow> {
    let mut diagnostics = Diagnostics::default();
    let table = tree::parse(data, Span::default().source, &mut diagnostics);
    let Some(Value::List(rows)) = table.get("row").map(|e| &e.item.value) else { return Vec::new() };
    let count = rows.len() as f64;
    let mut all = Vec::with_capacity(rows.len());
    for (index, item) in rows.iter().enumerate() {
        let Value::Table(table) = &item.value else { continue };
        if !progress(index as f64 / count) {
            break;
        }
        let kind = text(table, "kind");
        all.push(ReproductionRow {
            quantity: text(table, "quantity"),
            place: text(table, "where"),
            paper: number(table, "paper"),
            ours: ours(&text(table, "id")),
            unit: text(table, "unit"),
            explained: number(table, "explained"),
            evidence: EVIDENCE.iter().find(|(word, _)| *word == kind).map_or(Evidence::Computed, |(_, evidence)| *evidence),
            why: text(table, "why"),
        });
    }
    all
}

fn text(table: &Table, key: &str) -> String {
    match table.get(key).map(|e| &e.item.value) {
        Some(Value::Text(text)) => text.clone(),
        _ => String::new(),
    }
}

fn number(table: &Table, key: &str) -> Option<f64> {
    match table.get(key).map(|e| &e.item.value) {
        Some(Value::Number(number)) => Some(*number),
        _ => None,
    }
}
