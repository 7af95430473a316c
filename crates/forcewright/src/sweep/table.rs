//! Rows and columns of the table.

use forcewright_base::text::visible;
use forcewright_base::units::{Dimension, Unit};
use forcewright_model::{Check, CheckState, Outcome, Sense, StatusKind};
use forcewright_report::csv;
use serde_json::{Value, json};

use super::Sweep;
use super::axis::MetricColumn;
use super::plan::Plan;

/// The word of a design that cannot be analysed at all.
pub const REFUSED: &str = "refused";
/// Words of the column `status`.
const STATUS: [StatusKind; 6] = [
    StatusKind::Complete,
    StatusKind::NoEquilibriumBeyond,
    StatusKind::UnstableBeyond,
    StatusKind::NotConverged,
    StatusKind::ReducedAccuracy,
    StatusKind::Interrupted,
];
/// Words of `requirements` and of the checks: as numbers, 1 is met and 0 missed.
const STATES: [CheckState; 3] = [CheckState::Missed, CheckState::Met, CheckState::NotAssessed];

/// What the cells of a column are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Numbers, in the SI unit of a quantity; an empty cell where there is none.
    Number(String),
    /// One of some words.
    Words(Vec<String>),
    /// Text for people.
    Text,
}

/// A column of the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name, without unit.
    pub name: String,
    /// What its cells are.
    pub kind: Kind,
}

impl Column {
    pub(crate) fn number(name: impl Into<String>, dimension: Dimension) -> Self {
        Self { name: name.into(), kind: Kind::Number(Unit::si(dimension).pretty()) }
    }

    pub(crate) fn words(name: impl Into<String>, words: impl IntoIterator<Item = String>) -> Self {
        Self { name: name.into(), kind: Kind::Words(words.into_iter().collect()) }
    }

    /// `force_at_end / N`.
    pub fn header(&self) -> String {
        match &self.kind {
            Kind::Number(unit) if !unit.is_empty() => format!("{} / {unit}", self.name),
            _ => self.name.clone(),
        }
    }

    /// A cell as a number: that of a number, the place (from 0) of a word; `None` for a text.
    pub fn value(&self, cell: &str) -> Option<f64> {
        match &self.kind {
            Kind::Number(_) => Some(cell.parse().unwrap_or(f64::NAN)),
            Kind::Words(words) => Some(words.iter().position(|w| w == cell).map_or(f64::NAN, |at| at as f64)),
            Kind::Text => None,
        }
    }

    pub(super) fn json(&self) -> Value {
        match &self.kind {
            Kind::Number(unit) => json!({ "name": self.name, "unit": if unit.is_empty() { "1" } else { unit } }),
            Kind::Words(words) => json!({ "name": self.name, "words": words }),
            Kind::Text => json!({ "name": self.name, "text": true }),
        }
    }

    pub(super) fn from_json(value: &Value) -> Option<Self> {
        let name = value["name"].as_str()?.to_owned();
        let kind = match (value["unit"].as_str(), value["words"].as_array()) {
            (Some("1"), _) => Kind::Number(String::new()),
            (Some(unit), _) => Kind::Number(unit.to_owned()),
            (None, Some(words)) => Kind::Words(words.iter().filter_map(|w| w.as_str().map(str::to_owned)).collect()),
            (None, None) => Kind::Text,
        };
        Some(Self { name, kind })
    }
}

/// A requirement that has a column.
#[derive(Clone, Debug)]
pub(super) struct CheckColumn {
    name: String,
    code: &'static str,
    sense: Sense,
}

impl CheckColumn {
    fn is(&self, check: &Check) -> bool {
        check.code == self.code && check.name == self.name && check.sense == self.sense
    }
}

/// The requirements of a design, one column each.
pub(super) fn check_columns(outcome: &Outcome) -> Vec<CheckColumn> {
    let mut columns: Vec<CheckColumn> = Vec::new();
    for check in outcome.checks.iter().filter(|c| c.required) {
        if !columns.iter().any(|c| c.is(check)) {
            columns.push(CheckColumn { name: check.name.clone(), code: check.code, sense: check.sense });
        }
    }
    columns
}

/// The columns of a sweep.
pub(super) fn columns(plan: &Plan, checks: &[CheckColumn], metrics: &[MetricColumn]) -> Vec<Column> {
    let states = || STATES.iter().map(|s| s.word().to_owned());
    let mut columns = vec![Column::number("design", Dimension::Ratio)];
    columns.extend(plan.axes().iter().map(|axis| match (axis.words(), axis.dimension()) {
        (Some(words), _) => Column::words(axis.key.as_str(), words.to_vec()),
        (None, dimension) => Column::number(axis.key.as_str(), dimension.unwrap_or(Dimension::Ratio)),
    }));
    columns.push(Column::words("status", STATUS.iter().map(|s| s.word().to_owned()).chain([REFUSED.to_owned()])));
    columns.push(Column::words("requirements", states()));
    columns.extend(checks.iter().map(|check| {
        let alone = checks.iter().filter(|c| c.name == check.name).count() == 1;
        let side = if check.sense == Sense::AtLeast { "at least" } else { "at most" };
        Column::words(if alone { format!("check {}", check.name) } else { format!("check {} {side}", check.name) }, states())
    }));
    columns.extend(metrics.iter().map(|m| Column::number(m.name.as_str(), m.dimension)));
    columns.push(Column::number("error_estimate", Dimension::Ratio));
    columns.push(Column { name: "warnings".to_owned(), kind: Kind::Text });
    columns.push(Column { name: "message".to_owned(), kind: Kind::Text });
    columns
}

/// What a design came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Number of the design, from 1.
    pub design: u64,
    /// Its values as they would be typed, one per axis.
    pub values: Vec<String>,
    /// How the analysis ended; `None` if the design was refused.
    pub status: Option<StatusKind>,
    /// All requirements together; `None` if there are none, or no analysis.
    pub requirements: Option<CheckState>,
    /// Each requirement that has a column.
    pub checks: Vec<Option<CheckState>>,
    /// Each metric that has a column, SI.
    pub metrics: Vec<Option<f64>>,
    /// Estimated error of the forces relative to the largest one.
    pub error_estimate: Option<f64>,
    /// Codes of the warnings, each once.
    pub warnings: Vec<&'static str>,
    /// How it ended in words, or why it was refused.
    pub message: String,
}

impl Row {
    pub(super) fn analysed(design: u64, values: Vec<String>, outcome: &Outcome, checks: &[CheckColumn], metrics: &[MetricColumn]) -> Self {
        let required: Vec<&Check> = outcome.checks.iter().filter(|c| c.required).collect();
        let worst = |found: &mut dyn Iterator<Item = CheckState>| {
            found.max_by_key(|state| match state {
                CheckState::Met => 0,
                CheckState::NotAssessed => 1,
                CheckState::Missed => 2,
            })
        };
        let mut warnings: Vec<&'static str> = Vec::new();
        for warning in &outcome.warnings {
            if !warnings.contains(&warning.code) {
                warnings.push(warning.code);
            }
        }
        Self {
            design: design + 1,
            values,
            status: Some(outcome.status.kind),
            requirements: worst(&mut required.iter().map(|c| c.state)),
            checks: checks.iter().map(|column| worst(&mut required.iter().filter(|c| column.is(c)).map(|c| c.state))).collect(),
            metrics: metrics.iter().map(|m| outcome.metric(&m.name).map(|found| found.value).filter(|v| v.is_finite())).collect(),
            error_estimate: outcome.error_estimate,
            warnings,
            message: outcome.status.message.clone(),
        }
    }

    pub(super) fn refused(design: u64, values: Vec<String>, checks: usize, metrics: usize, message: String) -> Self {
        Self {
            design: design + 1,
            values,
            status: None,
            requirements: None,
            checks: vec![None; checks],
            metrics: vec![None; metrics],
            error_estimate: None,
            warnings: Vec::new(),
            message,
        }
    }

    /// The word of the column `status`.
    pub fn status_word(&self) -> &'static str {
        self.status.map_or(REFUSED, StatusKind::word)
    }

    /// The row's cells, one per column; numbers in SI, as the shortest decimals that give the same doubles again.
    pub(super) fn cells(&self, plan: &Plan) -> Vec<String> {
        let number = |value: Option<f64>| value.map_or_else(String::new, csv::number);
        let word = |state: Option<CheckState>| state.map_or_else(String::new, |s| s.word().to_owned());
        let mut cells = lead(plan, self.design, &self.values);
        cells.push(self.status_word().to_owned());
        cells.push(word(self.requirements));
        cells.extend(self.checks.iter().map(|s| word(*s)));
        cells.extend(self.metrics.iter().map(|v| number(*v)));
        cells.push(number(self.error_estimate));
        cells.push(self.warnings.join(" "));
        // One line per row: that is how a row that was cut short is found.
        cells.push(visible(&self.message.replace(['\n', '\r'], " ")).into_owned());
        cells
    }
}

/// The first cells of a row: what is known of a design before it is analysed.
pub(super) fn lead(plan: &Plan, design: u64, values: &[String]) -> Vec<String> {
    let mut cells = vec![design.to_string()];
    cells.extend(plan.axes().iter().zip(values).map(|(axis, value)| match axis.words() {
        Some(_) => value.clone(),
        None => axis.si(value).map_or_else(String::new, csv::number),
    }));
    cells
}

/// A line of CSV with its end.
pub(crate) fn line(cells: impl IntoIterator<Item = String>) -> String {
    let mut out = String::new();
    csv::row(cells, &mut out);
    out
}

/// The cells of one line of CSV; `None` if it is cut short.
pub(super) fn split(line: &[u8]) -> Option<Vec<String>> {
    let text = std::str::from_utf8(line).ok()?.strip_suffix("\r\n")?;
    let mut cells = vec![String::new()];
    let mut quoted = false;
    let mut letters = text.chars().peekable();
    while let Some(c) = letters.next() {
        let cell = cells.last_mut()?;
        match c {
            '"' if quoted && letters.peek() == Some(&'"') => cell.extend(letters.next()),
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            c => cell.push(c),
        }
    }
    (!quoted).then_some(cells)
}

/// How many designs came to what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tally {
    /// Rows counted.
    pub designs: u64,
    /// Words of `status` with how often each was found, in the order of the words.
    pub status: Vec<(String, u64)>,
    /// Rows that meet all requirements.
    pub met: u64,
    /// Rows that miss one.
    pub missed: u64,
    /// Rows of which one could not be assessed, and none is missed.
    pub not_assessed: u64,
}

impl Default for Tally {
    fn default() -> Self {
        Self::new()
    }
}

impl Tally {
    /// No rows.
    pub fn new() -> Self {
        let words = STATUS.iter().map(|s| s.word()).chain([REFUSED]);
        Self { designs: 0, status: words.map(|w| (w.to_owned(), 0)).collect(), met: 0, missed: 0, not_assessed: 0 }
    }

    /// Counts a row.
    pub fn add(&mut self, sweep: &Sweep, row: &Row) {
        self.count(sweep.columns(), &row.cells(sweep.plan()));
    }

    pub(super) fn count(&mut self, columns: &[Column], cells: &[String]) {
        let cell = |name: &str| columns.iter().position(|c| c.name == name).and_then(|at| cells.get(at)).map_or("", String::as_str);
        self.designs += 1;
        let status = cell("status");
        if let Some((_, count)) = self.status.iter_mut().find(|(word, _)| word == status) {
            *count += 1;
        }
        match STATES.iter().find(|s| s.word() == cell("requirements")) {
            Some(CheckState::Met) => self.met += 1,
            Some(CheckState::Missed) => self.missed += 1,
            Some(CheckState::NotAssessed) => self.not_assessed += 1,
            None => {}
        }
    }

    /// The counts as a JSON object.
    pub fn json(&self) -> Value {
        let status: serde_json::Map<String, Value> = self.status.iter().map(|(word, count)| (word.clone(), (*count).into())).collect();
        json!({ "status": status, "met": self.met, "missed": self.missed, "not_assessed": self.not_assessed })
    }

    /// How many rows have a word of `status`.
    pub fn with_status(&self, word: &str) -> u64 {
        self.status.iter().find(|(w, _)| w == word).map_or(0, |(_, count)| *count)
    }
}
