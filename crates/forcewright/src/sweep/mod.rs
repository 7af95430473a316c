//! A table of results over many designs: every combination of some values, or a sample, each analysed as `solve` does it.
//!
//! A design of a sweep is the project with some settings more; its row is exactly what [`Loaded::solve`](crate::Loaded::solve) gives
//! for those settings. A design that the family refuses, or whose analysis does not reach its end, is a row with its status and the
//! reason. Rows come in the order of the grid, the first key slowest, and are the same bits for any number of threads.
//!
//! ```
//! use std::path::Path;
//! use std::sync::atomic::AtomicBool;
//!
//! use forcewright::sweep::{Axis, Plan, Sampling, Sweep};
//! use forcewright::{Choices, DiskFiles};
//!
//! # let folder = std::env::temp_dir().join(format!("forcewright-doc-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder).expect("a folder");
//! # let file = folder.join("lan-table3.toml");
//! # std::fs::write(&file, forcewright::gallery::find("lan-table3").expect("in the gallery").text).expect("a file");
//! let plan = Plan::new(vec![Axis::parse("design.depth=5mm..10mm:2")?], Sampling::default(), false)?;
//! let stop = AtomicBool::new(false);
//! let sweep = Sweep::new(&DiskFiles, &file, &Choices::default(), plan, &["force_at_end".to_owned()], &stop)?;
//! let mut forces = Vec::new();
//! sweep.run(0..sweep.len(), 2, &stop, &mut |row| {
//!     forces.extend(row.metrics[0]);
//!     Ok(())
//! })?;
//! // Every force is proportional to the depth out of the plane.
//! assert!((forces[1] / forces[0] - 2.0).abs() < 1e-12);
//! # std::fs::remove_dir_all(&folder).expect("its folder");
//! # Ok::<(), forcewright::sweep::SweepError>(())
//! ```

pub(crate) mod axis;
mod files;
mod npy;
mod plan;
mod run;
pub(crate) mod table;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use forcewright_base::diagnostics::{Diagnostic, Explanation, Severity, Sources};
use forcewright_contract::project::{Choices, FileError, Files, Project};
use forcewright_model::StatusKind;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

pub use axis::Axis;
pub use files::{Formats, Merged, Outputs, PartFile, Started, merge};
pub use plan::{MOST_DESIGNS, Plan, Sampling, Shard};
pub use table::{Column, Kind, REFUSED, Row, Tally};

use axis::MetricColumn;
use table::CheckColumn;

use crate::{Loaded, Refused, VERSION};

/// Version of the shape of tables and their documents.
const SCHEMA: u32 = 1;
/// Designs that are tried, spread over the plan, to find one that can be analysed.
const TRIED: u64 = 256;

/// Why there is no table.
#[derive(Debug)]
pub enum SweepError {
    /// The project cannot be used with any of the values, or a value is no value of its key.
    Project(Box<Refused>),
    /// The call is not understood, or its files belong to another one.
    Call(Box<Diagnostic>),
    /// A part to be joined cannot be read.
    Unreadable {
        /// Which.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The table cannot be written.
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
}

impl fmt::Display for SweepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Project(refused) => f.write_str(&refused.render(false)),
            Self::Call(call) => write!(f, "{}: {}", call.code, call.message),
            Self::Unreadable { path, error } | Self::File { path, error } => write!(f, "{}: {error}", path.display()),
        }
    }
}

impl std::error::Error for SweepError {}

/// An error of what is handed each row.
impl From<io::Error> for SweepError {
    fn from(error: io::Error) -> Self {
        Self::File { path: PathBuf::new(), error }
    }
}

fn refused_call(code: &'static str, message: impl Into<String>, help: impl Into<String>) -> SweepError {
    SweepError::Call(Box::new(Diagnostic::placeless(code, message).help(help)))
}

/// A project and what is varied of it, ready to be computed.
pub struct Sweep {
    files: Snapshot,
    path: PathBuf,
    choices: Choices,
    plan: Plan,
    checks: Vec<CheckColumn>,
    metrics: Vec<MetricColumn>,
    columns: Vec<Column>,
    document: Value,
    trial: Duration,
}

impl Sweep {
    /// Reads a project, and tries the values that are varied: a misspelt key, word or unit is an error here. Values that the project
    /// cannot have (out of range, a design that does not close) are not: they become rows. One design is analysed, to know its
    /// requirements and how long it takes. Of `metrics`, those named become columns; all of them if none is named.
    ///
    /// # Errors
    /// What is wrong with the project, the values or the metrics.
    pub fn new(
        files: &dyn Files,
        path: &Path,
        choices: &Choices,
        plan: Plan,
        metrics: &[String],
        stop: &AtomicBool,
    ) -> Result<Self, SweepError> {
        let (base, files) = Snapshot::of(files, |files| Project::load(files, path, choices));
        let mut sweep = Self {
            files,
            path: path.to_owned(),
            choices: choices.clone(),
            plan,
            checks: Vec::new(),
            metrics: Vec::new(),
            columns: Vec::new(),
            document: Value::Null,
            trial: Duration::ZERO,
        };
        sweep.find_mistakes()?;
        let loaded = sweep.first_understood()?;
        sweep.metrics = axis::chosen_metrics(loaded.family, metrics)?;
        let started = Instant::now();
        let report = loaded.solve("", "", &mut |_| !stop.load(Ordering::Relaxed));
        sweep.trial = started.elapsed();
        sweep.checks = table::check_columns(&report.outcome);
        sweep.columns = table::columns(&sweep.plan, &sweep.checks, &sweep.metrics);
        sweep.document = sweep.describe(report.outcome.mechanism, &report.outcome.title, &base.sources);
        Ok(sweep)
    }

    /// How many designs there are.
    pub fn len(&self) -> u64 {
        self.plan.len()
    }

    /// Whether there is none; never.
    pub fn is_empty(&self) -> bool {
        self.plan.is_empty()
    }

    /// The designs.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The columns of the table.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The line of CSV that names the columns.
    pub fn header(&self) -> String {
        table::line(self.columns.iter().map(Column::header))
    }

    /// A row as a line of CSV.
    pub fn line(&self, row: &Row) -> String {
        table::line(row.cells(&self.plan))
    }

    /// A row as an object, with its empty cells left out: numbers as numbers, everything else as texts.
    pub fn json(&self, row: &Row) -> Value {
        let cells = self.columns.iter().zip(row.cells(&self.plan)).filter(|(_, cell)| !cell.is_empty());
        let value = |column: &Column, cell: String| match column.kind {
            _ if column.name == "design" => Value::from(row.design),
            Kind::Number(_) => cell.parse::<f64>().map_or(Value::Null, Value::from),
            Kind::Words(_) | Kind::Text => Value::from(cell),
        };
        Value::Object(cells.map(|(column, cell)| (column.name.clone(), value(column, cell))).collect())
    }

    /// What the table is: project, designs, columns with units, and the fingerprint of everything that decides its bytes.
    pub fn document(&self) -> &Value {
        &self.document
    }

    /// How long the analysis of one design took.
    pub fn trial(&self) -> Duration {
        self.trial
    }

    /// One design by its number from 0; `None` if it was stopped.
    pub fn row(&self, design: u64, stop: &dyn Fn() -> bool) -> Option<Row> {
        let values = self.plan.values(design);
        match self.load(&self.plan.settings(design)) {
            Ok(loaded) => {
                let report = loaded.solve("", "", &mut |_| !stop());
                let stopped = report.outcome.status.kind == StatusKind::Interrupted;
                (!stopped).then(|| Row::analysed(design, values, &report.outcome, &self.checks, &self.metrics))
            }
            Err(refused) => {
                let first = refused.diagnostics.in_file_order().into_iter().find(|d| d.severity == Severity::Error);
                let reason = first.map_or_else(String::new, |d| format!("{}: {}", d.code, d.message));
                Some(Row::refused(design, values, self.checks.len(), self.metrics.len(), reason))
            }
        }
    }

    fn load(&self, settings: &[String]) -> Result<Loaded, Refused> {
        let mut choices = self.choices.clone();
        choices.set.extend_from_slice(settings);
        // The last settings were typed as values of `--vary`.
        Loaded::from_file(&self.files, &self.path, &choices).map_err(|refused| refused.typed_as("--vary", settings.len()))
    }

    /// Whether a value is no value of its key, or its key no key.
    fn find_mistakes(&self) -> Result<(), SweepError> {
        let first = self.plan.settings(0);
        for (at, axis) in self.plan.axes().iter().enumerate() {
            for value in axis.telling() {
                let mut settings = first.clone();
                settings[at] = format!("{}={value}", axis.key);
                let Err(refused) = self.load(&settings) else { continue };
                let typed = |d: &Diagnostic| {
                    let source = d.span.and_then(|s| refused.sources.get(s.source));
                    source.is_some_and(|s| s.name == "--vary")
                };
                // Codes of reading; a number out of range is a number.
                let reading = |d: &Diagnostic| d.severity == Severity::Error && d.code < "E0400" && d.code != "E0204";
                if refused.diagnostics.in_file_order().iter().any(|d| reading(d) && typed(d)) {
                    return Err(SweepError::Project(Box::new(refused)));
                }
            }
        }
        Ok(())
    }

    /// A design that can be analysed; if none is found, why the first cannot.
    fn first_understood(&self) -> Result<Loaded, SweepError> {
        let total = self.plan.len();
        let tried = total.min(TRIED);
        let mut why = None;
        for at in 0..tried {
            let design = u64::try_from(u128::from(at) * u128::from(total) / u128::from(tried)).unwrap_or(0);
            match self.load(&self.plan.settings(design)) {
                Ok(loaded) => return Ok(loaded),
                Err(refused) => why = why.or(Some(refused)),
            }
        }
        match why {
            Some(refused) => Err(SweepError::Project(Box::new(refused))),
            None => Err(refused_call("E0130", "the sweep has no designs", "vary something")),
        }
    }

    fn describe(&self, mechanism: &str, title: &str, sources: &Sources) -> Value {
        let mut place = 0;
        let columns: Vec<Value> = self
            .columns
            .iter()
            .map(|column| {
                let mut json = column.json();
                // Texts have no place in an array of numbers.
                if column.kind != Kind::Text {
                    json["npy"] = place.into();
                    place += 1;
                }
                json
            })
            .collect();
        let vary: Vec<Value> = self.plan.axes().iter().map(|a| json!({ "key": a.key, "values": a.spec })).collect();
        let sampling = self.plan.sampling();
        json!({
            "schema": SCHEMA,
            "forcewright": VERSION,
            "mechanism": mechanism,
            "title": title,
            "variant": self.choices.variant,
            "set": self.choices.set,
            "input_sha256": crate::load::hash(sources),
            "fingerprint": self.fingerprint(sources),
            "designs": self.len(),
            "vary": vary,
            "points": sampling.points,
            "seed": sampling.seed,
            "columns": columns,
        })
    }

    /// Hash of everything that decides the bytes of the table.
    fn fingerprint(&self, sources: &Sources) -> String {
        let sampling = self.plan.sampling();
        let mut parts = vec![format!("table {SCHEMA}"), VERSION.to_owned(), format!("{sampling:?}"), self.header()];
        parts.extend(sources.iter().map(|s| s.text.to_string()));
        parts.push(format!("{:?}", self.choices));
        parts.extend(self.plan.axes().iter().flat_map(|a| [a.key.clone(), a.spec.clone()]));
        let mut hasher = Sha256::new();
        for part in parts {
            // With its length, so that no two lists of parts are the same text.
            hasher.update((part.len() as u64).to_le_bytes());
            hasher.update(part.as_bytes());
        }
        crate::load::hex(&hasher.finalize())
    }
}

/// Files as they were at the beginning: editing them meanwhile does not mix two projects in one table, or in one search.
pub(crate) struct Snapshot(BTreeMap<PathBuf, Result<String, FileError>>);

impl Snapshot {
    /// What some work reads.
    pub(crate) fn of<T>(files: &dyn Files, work: impl FnOnce(&dyn Files) -> T) -> (T, Self) {
        let recorder = Recorder { files, read: RefCell::default() };
        let done = work(&recorder);
        (done, Self(recorder.read.into_inner()))
    }
}

impl Files for Snapshot {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        self.0.get(path).cloned().unwrap_or(Err(FileError::NotFound))
    }
}

struct Recorder<'a> {
    files: &'a dyn Files,
    read: RefCell<BTreeMap<PathBuf, Result<String, FileError>>>,
}

impl Files for Recorder<'_> {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        let text = self.files.read(path);
        self.read.borrow_mut().insert(path.to_owned(), text.clone());
        text
    }
}

const fn code(code: &'static str, title: &'static str, text: &'static str) -> Explanation {
    Explanation { code, title, text }
}

/// Codes of sweeps.
pub const CODES: &[Explanation] = &[
    code(
        "E0130",
        "what is varied is not understood",
        "`--vary KEY=SPEC` names a key as `--set` does, and its values: a range with both ends and their number, or a list.\n\n    --vary design.thickness=0.8mm..1.2mm:9\n    --vary design.thickness=0.8mm,1mm,1.2mm\n    --vary model.beam=reissner,inextensible\n\nSeveral `--vary` make the full grid, the first slowest. `forcewright optimise --front KEY=SPEC` takes one key that is a number, with a range or a list.",
    ),
    code(
        "E0131",
        "too many designs",
        "More than ten million designs are most often a slip. `--yes` confirms them; `--shard i/n` computes one of n parts, `forcewright merge` joins them.",
    ),
    code(
        "E0132",
        "a file of another sweep",
        "A sweep goes on where it was interrupted, from the file `OUT.part`. The one found was written with other values, another project text, or another version, or there are results that this sweep did not write. Give another `--out`, or overwrite them with `--force`.",
    ),
    code("E0133", "unknown metric", "`--metrics` names columns of the table: metrics of the family, as in `requirements.limits`."),
    code(
        "E0134",
        "parts do not make a whole",
        "`forcewright merge` joins the parts of one sweep that were computed with `--shard 1/n` to `--shard n/n`: all of them, each complete. The command that made an incomplete part completes it.",
    ),
    code("E0135", "a sweep is being written", "Another process writes the same file. Wait for it, stop it, or give another `--out`."),
];
