//! The same questions for every family. A family's `tests/conformance.rs` is one line:
//!
//! ```ignore
//! #[test]
//! fn conformance() {
//!     forcewright_contract::conformance::suite::<MyFamily>(include_str!("…/examples/my-family/example.toml"));
//! }
//! ```
//!
//! The example must stand alone (no `extends`), be understood without errors, and be analysed to the end.

mod studies;

use std::fmt::Debug;
use std::time::{Duration, Instant};

use forcewright_base::diagnostics::{Diagnostics, Severity};
use forcewright_base::units::{Dimension, Quantity, Unit};
use forcewright_model::{CheckState, Figure, Outcome, ParameterRow, StatusKind};
use serde_json::Value as Json;

use crate::codes;
use crate::data::{DataFile, names_a_file};
use crate::describe::{Along, Describe, Form, Located, Members, Param, Range, Reserved, Slot, Visitor, Word, member_path};
use crate::family::{Entry, Family, Mechanism};
use crate::numbers::{self, Part};
use crate::project::{Choices, Project};
use crate::tree::{Item, Table, Value};
use crate::{paths, read};

/// Longest time for one analysis at the edge of a range, in a build without optimisation. Far above what any takes: a guard against
/// work without bound.
const LONGEST: Duration = Duration::from_mins(2);
/// A key that no family has.
const NO_KEY: &str = "zz_no_such_key";

/// Asks every question about a family and one of its examples.
///
/// # Panics
/// With the question and the answer, where an answer is wrong.
pub fn suite<M: Mechanism>(example: &str) {
    description::<M>();
    schema::<M>();
    explanations::<M>();
    let analysed = solved::<M>(example);
    result::<M>(&analysed.outcome);
    finite("the example", &analysed.outcome);
    finite("the example's figures", &analysed.figures);
    pure_function::<M>(example);
    progress::<M>(example);
    units::<M>(example);
    parameters::<M>(example);
    unknown_keys::<M>(example);
    reproductions::<M>();
    edges::<M>(example);
    studies::suite::<M>(example);
}

/// What came of a project.
struct Answer {
    /// `None` if it was refused.
    analysed: Option<Analysed>,
    rows: Vec<ParameterRow>,
    diagnostics: Diagnostics,
}

struct Analysed {
    outcome: Outcome,
    figures: Vec<Figure>,
}

fn project(text: &str, set: &[String]) -> Project {
    Project::from_text("example.toml", text, &Choices { variant: None, set: set.to_vec() })
}

fn answer<M: Mechanism>(mut project: Project) -> Answer {
    let mut spec: M::Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    let design = M::resolve(&mut spec, &mut project.diagnostics).filter(|_| !project.diagnostics.has_errors());
    let analysed = design.map(|design| {
        let analysis = M::analyse(&design, &mut |_| true);
        Analysed { outcome: analysis.outcome, figures: analysis.figures }
    });
    Answer { analysed, rows: paths::rows_of(&mut spec), diagnostics: project.diagnostics }
}

fn messages(diagnostics: &Diagnostics) -> Vec<String> {
    diagnostics.in_file_order().iter().map(|d| format!("{}: {}", d.code, d.message)).collect()
}

/// The example's analysis, which must reach the end.
fn solved<M: Mechanism>(example: &str) -> Analysed {
    let answer = answer::<M>(project(example, &[]));
    let said = messages(&answer.diagnostics);
    assert!(said.is_empty(), "the example is not understood without remarks: {said:?}");
    let Some(analysed) = answer.analysed else { panic!("the example was refused without a reason") };
    assert_eq!(analysed.outcome.status.kind, StatusKind::Complete, "the example is not analysed to the end");
    analysed
}

/// Asserts that no number in a value's printed form is not finite.
#[track_caller]
fn finite(what: &str, value: &impl Debug) {
    let printed = format!("{value:?}");
    let words = printed.split(|c: char| !c.is_alphanumeric());
    assert!(!words.into_iter().any(|word| word == "NaN" || word == "inf"), "{what} has a number that is not finite: {printed}");
}

// ---------------------------------------------------------------------------------------------------------------- the description

/// Keys are unique, documented, with sane ranges and defaults that the reader accepts; the description is the same every time.
fn description<M: Mechanism>() {
    let paths_once = paths::keys_of(&mut M::Spec::default());
    assert_eq!(paths_once, paths::keys_of(&mut M::Spec::default()), "the description changes from one time to the next");
    for (index, path) in paths_once.iter().enumerate() {
        assert!(!paths_once[..index].contains(path), "`{path}` is described twice");
    }
    for needed in ["schema", "mechanism", "title"] {
        assert!(paths_once.iter().any(|p| p == needed), "`{needed}` is not described");
    }
    M::Spec::default().describe(&mut Words);
}

/// Looks at what is said about each parameter.
struct Words;

fn sane(param: &Param) {
    let Param { key, doc, range, default, required, diameter, .. } = *param;
    assert!(!key.is_empty() && key.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_'), "`{key}` is no plain key");
    assert!(doc.ends_with('.') && doc.len() > 4, "`{key}` needs a sentence: `{doc}`");
    assert!(range.min <= range.max && !(range.above && range.min >= range.max), "the range of `{key}` is empty");
    assert!(!(required && default.is_some()), "`{key}` is required and has a default");
    assert!(!names_a_file(key), "`{key}` looks like the path of a file");
    assert!(!diameter || param.dimension == Dimension::Length, "`{key}` is a diameter and no length");
}

fn no_default(param: &Param) {
    sane(param);
    assert!(param.default.is_none(), "a default of `{}` has no meaning here", param.key);
}

impl Visitor for Words {
    fn quantity(&mut self, param: &Param, _: &mut Slot<Quantity>) {
        sane(param);
        let Some(text) = param.default else { return };
        let si = match text.parse::<f64>() {
            Ok(number) if param.dimension == Dimension::Ratio => number,
            _ => Quantity::parse(text, param.dimension).unwrap_or_else(|e| panic!("default `{text}` of `{}`: {e:?}", param.key)).si,
        };
        assert!(param.range.holds(si), "the default of `{}` is out of its range", param.key);
    }
    fn count(&mut self, param: &Param, _: &mut Slot<u32>) {
        sane(param);
        let default = param.default.map(|text| text.parse::<u32>().unwrap_or_else(|e| panic!("default of `{}`: {e}", param.key)));
        assert!(default.is_none_or(|d| param.range.holds(f64::from(d))), "the default of `{}` is out of its range", param.key);
    }
    fn numbers(&mut self, param: &Param, _: &mut Slot<Vec<f64>>) {
        no_default(param);
    }
    fn point(&mut self, param: &Param, _: &mut Slot<[Quantity; 2]>) {
        no_default(param);
    }
    fn points(&mut self, param: &Param, most: usize, _: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        no_default(param);
        assert!(most > 0, "`{}` can hold no points", param.key);
    }
    fn along(&mut self, param: &Param, most: usize, _: &mut Slot<Along>) {
        assert!(most >= 2, "`{}` cannot vary", param.key);
    }
    fn deferred(&mut self, param: &Param, _: &mut Slot<Value>) {
        no_default(param);
    }
    fn direction(&mut self, param: &Param, _: &mut Slot<[f64; 2]>) {
        no_default(param);
    }
    fn text(&mut self, param: &Param, _: &mut Slot<String>) {
        sane(param);
    }
    fn file(&mut self, param: &Param, _: &mut Slot<DataFile>) {
        assert!(!param.doc.is_empty() && names_a_file(param.key), "`{}` is a file: its key ends in `_file`", param.key);
    }
    fn flag(&mut self, param: &Param, _: &mut Slot<bool>) {
        sane(param);
        assert!(param.default.is_none_or(|d| d == "true" || d == "false"), "the default of `{}` is no flag", param.key);
    }
    fn choice(&mut self, param: &Param, words: &'static [Word], _: &mut Slot<&'static str>) {
        sane(param);
        assert!(words.iter().all(|w| !w.word.is_empty() && !w.doc.is_empty()), "a word of `{}` says nothing", param.key);
        assert!(param.default.is_none_or(|d| words.iter().any(|w| w.word == d)), "the default of `{}` is none of its words", param.key);
    }
    fn names(&mut self, param: &Param, least: usize, most: usize, _: &mut Slot<Vec<Located<String>>>) {
        no_default(param);
        assert!(least <= most && most > 0, "`{}` can hold no names", param.key);
    }
    fn section(&mut self, param: &Param, _: &mut Slot<()>, body: &mut dyn FnMut(&mut dyn Visitor)) {
        no_default(param);
        body(self);
    }
    fn members(&mut self, param: &Param, _: Form, members: &mut dyn Members) {
        no_default(param);
        members.prototype(self);
    }
    fn tables(&mut self, param: &Param, members: &mut dyn Members) {
        assert!(param.key == "*" && param.doc.len() > 4 && param.default.is_none() && !param.required, "{param:?}");
        members.prototype(self);
    }
    fn free(&mut self, param: &Param) {
        no_default(param);
    }
    fn reserved(&mut self, keys: &'static [Reserved]) {
        assert!(keys.iter().all(|r| !r.key.is_empty() && !r.instead.is_empty()), "a reserved key does not say what to do instead");
    }
}

/// The JSON schema knows every path, each with its sentence.
fn schema<M: Mechanism>() {
    let schema = Entry::<M>::new().json_schema();
    let markdown = Entry::<M>::new().parameter_table();
    assert_eq!(schema["properties"]["mechanism"]["const"], Json::from(M::ID), "the schema is that of another family");
    for path in paths::keys_of(&mut M::Spec::default()) {
        // One load or a list of them: either form of it.
        let inside = |at: &'_ Json, part: &str| match part {
            "*" if at["items"].is_object() => at["items"].clone(),
            "*" => at["additionalProperties"].clone(),
            key => at["properties"][key].clone(),
        };
        let place = path.split('.').fold(schema.clone(), |at, part| match at["anyOf"].as_array() {
            Some(forms) => forms.iter().map(|form| inside(form, part)).find(Json::is_object).unwrap_or(Json::Null),
            None => inside(&at, part),
        });
        assert!(place.is_object(), "the schema has no `{path}`");
        // Members have no sentence of their own.
        let described = place["description"].as_str().is_some_and(|text| text.len() > 4);
        assert!(described || path.ends_with('*'), "the schema says nothing about `{path}`");
        // The table shows the keys of stages once.
        let node = |path: &str| path.split('.').fold(schema.clone(), |at, key| at["properties"][key].clone());
        let once = path.split_once(".*").filter(|(stages, _)| node(stages)["anyOf"].is_array());
        let shown = once.map_or_else(|| path.clone(), |(stages, key)| format!("{stages}{key}"));
        assert!(markdown.contains(&format!("| `{shown}` |")), "the table of parameters has no `{shown}`");
    }
}

/// Codes are unique and explained.
fn explanations<M: Mechanism>() {
    let all: Vec<_> = codes::CODES.iter().chain(M::explanations()).collect();
    for (index, explanation) in all.iter().enumerate() {
        let code = explanation.code;
        assert!(!all[..index].iter().any(|e| e.code == code), "{code} is explained twice");
        assert!(!explanation.title.is_empty() && explanation.text.len() > 20, "{code} is not explained");
        assert!(explanation.text.ends_with(['.', '`', ')', ']']), "{code} ends in the middle of a sentence");
    }
}

/// Asserts that a code has its long story.
#[track_caller]
fn explained<M: Mechanism>(code: &str) {
    let known = codes::CODES.iter().chain(M::explanations()).any(|e| e.code == code);
    assert!(known, "{code} is emitted and has no explanation");
}

// --------------------------------------------------------------------------------------------------------------------- the result

/// Everything that must hold for any result, whatever the design.
fn result<M: Mechanism>(outcome: &Outcome) {
    assert_eq!(outcome.mechanism, M::ID);
    assert!(!outcome.sources.is_empty(), "a result without sources");
    for source in &outcome.sources {
        assert!(!source.key.is_empty() && !source.text.is_empty() && !source.used_for.is_empty(), "{source:?}");
    }
    assert!(!outcome.status.message.is_empty());
    let limits: Vec<String> = paths::keys_of(&mut M::Spec::default());
    let can_be_limited = limits.iter().any(|p| p == "requirements.limits");
    for (index, metric) in outcome.metrics.iter().enumerate() {
        let name = metric.name;
        assert!(!outcome.metrics[..index].iter().any(|m| m.name == name), "metric `{name}` is given twice");
        assert!(!metric.doc.is_empty() && metric.display.is(metric.dimension), "metric `{name}`: {metric:?}");
        let path = format!("requirements.limits.{name}");
        assert!(!can_be_limited || limits.contains(&path), "metric `{name}` is not in the documented list: it cannot be limited");
    }
    for check in &outcome.checks {
        explained::<M>(check.code);
        assert!(!check.title.is_empty() && !check.basis.is_empty() && check.display.is(check.dimension), "{check:?}");
        let met = check.state == CheckState::Met;
        assert_eq!(check.value.is_some() && check.limit.is_some(), check.state != CheckState::NotAssessed, "{check:?}");
        // Where the limit is zero there may be no margin.
        assert!(check.margin.is_none_or(|m| (m >= 0.0) == met), "the margin's sign: {check:?}");
        let measurable = check.state != CheckState::NotAssessed && check.limit.is_some_and(|l| l.abs() > 0.0);
        assert!(check.margin.is_some() || !measurable, "{check:?}");
        assert_eq!(check.advice.is_some(), !met, "advice where something is wrong, and only there: {check:?}");
    }
    for warning in &outcome.warnings {
        explained::<M>(warning.code);
        assert!(!warning.message.is_empty());
    }
    for curve in &outcome.curves {
        assert!(!curve.branches.is_empty() && curve.x.display.is(curve.x.dimension) && curve.y.display.is(curve.y.dimension));
        for branch in &curve.branches {
            assert!(branch.x.len() == branch.y.len() && !branch.name.is_empty(), "curve `{}`", curve.name);
        }
    }
}

/// The same input gives the same output, to the last bit and letter, on any number of threads.
fn pure_function<M: Mechanism>(example: &str) {
    let digest = || {
        let analysed = solved::<M>(example);
        format!("{:?}{:?}", analysed.outcome, analysed.figures)
    };
    let want = digest();
    for threads in [1, 2, 4] {
        let found: Vec<String> = std::thread::scope(|scope| {
            let running: Vec<_> = (0..threads).map(|_| scope.spawn(digest)).collect();
            running.into_iter().map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
        });
        assert!(found.iter().all(|f| *f == want), "another result on {threads} threads");
    }
}

/// Progress grows from 0 to 1, and stopping is a result.
fn progress<M: Mechanism>(example: &str) {
    let run = |stop_after: usize| {
        let mut project = project(example, &[]);
        let mut spec: M::Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
        let Some(design) = M::resolve(&mut spec, &mut project.diagnostics) else { panic!("the example was refused") };
        let mut fractions = Vec::new();
        let analysis = M::analyse(&design, &mut |fraction| {
            fractions.push(fraction);
            fractions.len() < stop_after
        });
        (analysis.outcome, fractions)
    };
    let (_, fractions) = run(usize::MAX);
    assert!(fractions.iter().all(|f| (0.0..=1.0).contains(f)), "progress leaves [0, 1]: {fractions:?}");
    assert!(fractions.windows(2).all(|pair| pair[0] <= pair[1]), "progress goes back: {fractions:?}");
    if fractions.len() > 2 {
        let (outcome, asked) = run(2);
        assert_eq!(outcome.status.kind, StatusKind::Interrupted, "stopped after {} of {} steps", asked.len(), fractions.len());
        finite("a stopped analysis", &outcome);
        result::<M>(&outcome);
    }
}

// ------------------------------------------------------------------------------------------------------------------- the project file

/// Units that differ by a power of ten: the number in the first is that in the second times ten to the power.
const DECIMAL_UNITS: [(&str, &str, i32); 17] = [
    ("mm", "m", -3),
    ("cm", "mm", 1),
    ("m", "mm", 3),
    ("µm", "mm", -3),
    ("N", "mN", 3),
    ("mN", "N", -3),
    ("kN", "N", 3),
    ("N/mm", "N/m", 3),
    ("N/m", "N/mm", -3),
    ("N*mm", "N*m", -3),
    ("N*m", "N*mm", 3),
    ("GPa", "MPa", 3),
    ("MPa", "GPa", -3),
    ("g", "kg", -3),
    ("kg", "g", 3),
    ("s", "ms", 3),
    ("%", "1", -2),
];

/// The same quantity in another unit, if it is written in one of [`DECIMAL_UNITS`].
fn in_other_unit(text: &str) -> Option<String> {
    let part = |part: &str| {
        let (digits, unit) = part.trim().split_once(char::is_whitespace)?;
        let number = !digits.contains(['e', 'E']) && digits.parse::<f64>().is_ok();
        let (_, other, power) = DECIMAL_UNITS.iter().find(|(typed, ..)| number && *typed == unit.trim())?;
        Some(if *other == "1" { format!("{digits}e{power}") } else { format!("{digits}e{power} {other}") })
    };
    match text.split_once('±') {
        None => part(text),
        // A percentage after the sign is a share of the value, whatever its unit.
        Some((value, half)) if half.trim().ends_with('%') => Some(format!("{} ± {}", part(value)?, half.trim())),
        Some((value, half)) => Some(format!("{} ± {}", part(value)?, part(half)?)),
    }
}

fn rewrite_units(item: &mut Item) -> usize {
    match &mut item.value {
        Value::Text(text) => in_other_unit(text).map_or(0, |other| {
            *text = other;
            1
        }),
        Value::List(items) => items.iter_mut().map(rewrite_units).sum(),
        Value::Table(table) => table.entries.iter_mut().map(|e| rewrite_units(&mut e.item)).sum(),
        _ => 0,
    }
}

/// Every number of a result, to the last bit.
fn numbers_of(outcome: &Outcome) -> Vec<(String, u64)> {
    let mut all: Vec<(String, u64)> = outcome.metrics.iter().map(|m| (m.name.to_owned(), m.value.to_bits())).collect();
    for check in &outcome.checks {
        all.extend([check.value, check.limit, check.margin].into_iter().flatten().map(|v| (check.name.clone(), v.to_bits())));
    }
    for curve in &outcome.curves {
        for branch in &curve.branches {
            all.extend(branch.x.iter().chain(&branch.y).map(|v| (curve.name.to_owned(), v.to_bits())));
        }
    }
    all
}

/// The example typed in other decimal units gives the same bits.
fn units<M: Mechanism>(example: &str) {
    let mut other = project(example, &[]);
    let changed: usize = other.tree.entries.iter_mut().map(|e| rewrite_units(&mut e.item)).sum();
    assert!(changed >= 3, "the example has only {changed} values with decimal units: nothing is tested");
    let answer = answer::<M>(other);
    let Some(analysed) = answer.analysed else { panic!("in other units the example is refused: {:?}", messages(&answer.diagnostics)) };
    let (want, found) = (numbers_of(&solved::<M>(example).outcome), numbers_of(&analysed.outcome));
    assert_eq!(want.len(), found.len(), "in other units there are other results");
    for (want, found) in want.iter().zip(&found) {
        assert_eq!(want, found, "`{}` depends on the units typed", want.0);
    }
}

/// Dotted paths of every value typed; members of lists by name, or by their place.
fn typed(table: &Table, prefix: &str, found: &mut Vec<(String, Value)>) {
    for entry in &table.entries {
        let path = format!("{prefix}{}", entry.key);
        match &entry.item.value {
            Value::Table(inner) => typed(inner, &format!("{path}."), found),
            Value::List(items) if items.iter().any(|i| matches!(i.value, Value::Table(_))) => {
                for (index, item) in items.iter().enumerate() {
                    let Value::Table(inner) = &item.value else { continue };
                    let mut inner = inner.clone();
                    let name = match inner.take("name").map(|e| e.item.value) {
                        Some(Value::Text(name)) => name,
                        // Stages have their place, counted from 1.
                        _ => (index + 1).to_string(),
                    };
                    typed(&inner, &format!("{path}.{name}."), found);
                }
            }
            value => found.push((path, value.clone())),
        }
    }
}

/// The parameter table of the report shows every value typed, as it was typed.
fn parameters<M: Mechanism>(example: &str) {
    let project = project(example, &[]);
    let mut values = Vec::new();
    typed(&project.tree, "", &mut values);
    let rows = answer::<M>(project).rows;
    assert!(rows.iter().all(|r| !r.doc.is_empty() && !r.origin.is_empty()), "a row that says nothing: {rows:?}");
    for (index, row) in rows.iter().enumerate() {
        assert!(!rows[..index].iter().any(|r| r.path == row.path), "`{}` is listed twice", row.path);
    }
    for (path, value) in values {
        let Some(row) = rows.iter().find(|r| r.path == path) else { panic!("`{path}` was typed and is not among the parameters") };
        assert_eq!(row.origin, "file", "`{path}`");
        match value {
            Value::Number(number) => {
                let shown = row.value.trim_end_matches('%').trim().parse::<f64>().unwrap_or(f64::NAN);
                assert!((shown - number).abs() <= 1e-11 * number.abs(), "`{path}`: typed {number}, shown {}", row.value);
            }
            Value::Text(text) => {
                // Units may be printed more beautifully than they were typed; the number is the same.
                let number =
                    |t: &str| t.split(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c))).next().and_then(|n| n.parse::<f64>().ok());
                let same = number(&text).zip(number(&row.value)).is_some_and(|(a, b)| (a - b).abs() <= 1e-11 * a.abs());
                assert!(same || row.value == text, "`{path}`: typed {text}, shown {}", row.value);
            }
            _ => assert!(!row.value.is_empty(), "`{path}`"),
        }
    }
}

/// A key that does not exist is an error with a way out, in every table.
fn unknown_keys<M: Mechanism>(example: &str) {
    let mut tables = Tables::default();
    filled::<M>(example).describe(&mut tables);
    let mut places = tables.paths;
    places.push(String::new());
    assert!(places.len() >= 4, "{places:?}");
    for place in places {
        let answer = answer::<M>(project(example, &[format!("{place}{NO_KEY}=1")]));
        let found = answer.diagnostics.in_file_order().into_iter().find(|d| d.code == "E0301" && d.message.contains(NO_KEY));
        let Some(found) = found else { panic!("`{place}{NO_KEY}` is accepted: {:?}", messages(&answer.diagnostics)) };
        assert!(found.severity == Severity::Error && found.help.is_some() && answer.analysed.is_none(), "{found:?}");
    }
}

/// The papers' numbers agree, and each difference has its reason.
fn reproductions<M: Mechanism>() {
    for reproduction in M::reproductions() {
        assert!(!reproduction.key.is_empty() && !reproduction.title.is_empty());
        let rows = (reproduction.run)(&mut |_| true);
        assert!(!rows.is_empty(), "{} reproduces nothing", reproduction.key);
        for row in rows {
            assert!(
                row.ours.is_finite() && !row.why.is_empty() && row.finding() != crate::reproduction::Finding::Fails,
                "{}: {row:?}",
                reproduction.key
            );
        }
    }
}

// -------------------------------------------------------------------------------------------------------------- the edges of the ranges

/// A number of the example that can be set.
struct Number {
    path: String,
    dimension: Dimension,
    range: Range,
    value: f64,
    shape: Shape,
}

enum Shape {
    Quantity,
    Count,
    /// One of a list of bare numbers.
    List(Vec<f64>, usize),
    /// One coordinate of a point.
    Point(Vec<f64>, usize),
    /// One coordinate of one of several points, all coordinates one after the other.
    Points(Vec<f64>, usize),
}

impl Number {
    /// The setting that gives it another value, SI.
    fn setting(&self, si: f64) -> String {
        let unit = Unit::si(self.dimension);
        let quantity = |si: f64| if self.dimension == Dimension::Ratio { format!("{si:e}") } else { format!("{si:e} {}", unit.symbol()) };
        let list = |texts: Vec<String>| format!("[{}]", texts.join(", "));
        let coordinates = |all: &[f64], at: usize| {
            list(all.iter().enumerate().map(|(i, v)| format!("{:?}", quantity(if i == at { si } else { *v }))).collect())
        };
        let value = match &self.shape {
            Shape::Quantity => quantity(si),
            Shape::Count => format!("{}", si.round()),
            Shape::List(all, at) => list(all.iter().enumerate().map(|(i, v)| format!("{:e}", if i == *at { si } else { *v })).collect()),
            Shape::Point(all, at) => coordinates(all, *at),
            Shape::Points(all, at) => {
                let inside = |i: usize| at.checked_sub(2 * i).filter(|k| *k < 2).unwrap_or(2);
                list(all.chunks(2).enumerate().map(|(i, point)| coordinates(point, inside(i))).collect())
            }
        };
        format!("{}={value}", self.path)
    }

    /// Values at and within the edges of the range, around the present one.
    fn inside(&self) -> Vec<f64> {
        let Range { min, max, above } = self.range;
        let lowest = if above { min + 1e-9 * (self.value - min).abs().max(f64::MIN_POSITIVE) } else { min };
        [0.5 * self.value, 2.0 * self.value, lowest, max].into_iter().filter(|v| v.is_finite()).collect()
    }

    /// Values just beyond the edges.
    fn outside(&self) -> Vec<f64> {
        let Range { min, max, above } = self.range;
        let beyond =
            |edge: f64, sign: f64| edge + sign * (1e-3 * edge.abs()).max(if matches!(self.shape, Shape::Count) { 1.0 } else { 1e-3 });
        [if above { min } else { beyond(min, -1.0) }, beyond(max, 1.0)].into_iter().filter(|v| v.is_finite()).collect()
    }
}

/// Collects the counts of a filled description, and the paths of its tables.
#[derive(Default)]
struct Tables {
    prefix: String,
    counts: Vec<Number>,
    paths: Vec<String>,
}

impl Tables {
    fn inside(&mut self, part: &str, body: impl FnOnce(&mut Self)) {
        let before = self.prefix.len();
        self.prefix.push_str(part);
        self.prefix.push('.');
        self.paths.push(self.prefix.clone());
        body(self);
        self.prefix.truncate(before);
    }
}

impl Visitor for Tables {
    fn count(&mut self, param: &Param, slot: &mut Slot<u32>) {
        let Some(located) = slot else { return };
        let (path, value) = (format!("{}{}", self.prefix, param.key), f64::from(located.value));
        self.counts.push(Number { path, dimension: param.dimension, range: param.range, value, shape: Shape::Count });
    }
    fn section(&mut self, param: &Param, _: &mut Slot<()>, body: &mut dyn FnMut(&mut dyn Visitor)) {
        self.inside(param.key, |collector| body(collector));
    }
    fn members(&mut self, param: &Param, _: Form, members: &mut dyn Members) {
        for (index, name) in members.names().into_iter().enumerate() {
            self.inside(&member_path(param.key, &name), |collector| members.describe(index, collector));
        }
    }
    fn tables(&mut self, _: &Param, members: &mut dyn Members) {
        for (index, name) in members.names().into_iter().enumerate() {
            self.inside(&name, |collector| members.describe(index, collector));
        }
    }
}

/// The example, filled in.
fn filled<M: Mechanism>(example: &str) -> M::Spec {
    let mut project = project(example, &[]);
    let mut spec: M::Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    assert!(M::resolve(&mut spec, &mut project.diagnostics).is_some(), "the example was refused");
    spec
}

/// Every number of the example that stands alone or in a list, a point or points, and every count.
fn numbers<M: Mechanism>(example: &str) -> Vec<Number> {
    let mut spec = filled::<M>(example);
    let found = numbers::numbers_of(&mut spec);
    let key = |number: &numbers::Number| number.path.rsplitn(number.part.depth() + 1, '.').last().unwrap_or_default().to_owned();
    let values = |path: &str| found.iter().filter(|n| key(n) == path).map(|n| n.si).collect::<Vec<f64>>();
    let settable = |number: &numbers::Number| {
        let path = key(number);
        let shape = match number.part {
            Part::Whole => Shape::Quantity,
            Part::Entry(at) => Shape::List(values(&path), at),
            Part::Item(at) | Part::Coordinate(at) => Shape::Point(values(&path), at),
            Part::OfPoints(index, at) => Shape::Points(values(&path), 2 * index + at),
            Part::AtPlace(..) => return None,
        };
        Some(Number { path, dimension: number.dimension, range: number.range, value: number.si, shape })
    };
    let mut all: Vec<Number> = found.iter().filter_map(settable).collect();
    let mut tables = Tables::default();
    spec.describe(&mut tables);
    all.append(&mut tables.counts);
    all
}

/// Every number of the example at the ends of its range, halved and doubled: refused with a reason, or analysed in bounded time to
/// finite numbers. Beyond the ends it is refused as out of range.
fn edges<M: Mechanism>(example: &str) {
    let numbers = numbers::<M>(example);
    assert!(numbers.len() >= 5, "the example has only {} numbers", numbers.len());
    let mut settings = Vec::new();
    for number in &numbers {
        settings.extend(number.inside().into_iter().map(|v| number.setting(v)));
        for beyond in number.outside() {
            let setting = number.setting(beyond);
            let answer = answer::<M>(project(example, std::slice::from_ref(&setting)));
            let refused = answer.diagnostics.in_file_order().iter().any(|d| d.code == "E0204" || d.code == "E0206");
            assert!(
                refused && answer.analysed.is_none(),
                "`{setting}` is beyond the range and is not refused: {:?}",
                messages(&answer.diagnostics)
            );
        }
    }
    let next = std::sync::atomic::AtomicUsize::new(0);
    let work = || {
        while let Some(setting) = settings.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
            edge::<M>(example, setting);
        }
    };
    std::thread::scope(|scope| {
        let running: Vec<_> = (0..2).map(|_| scope.spawn(work)).collect();
        for thread in running {
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    });
}

fn edge<M: Mechanism>(example: &str, setting: &String) {
    let start = Instant::now();
    let answer = answer::<M>(project(example, std::slice::from_ref(setting)));
    assert!(start.elapsed() < LONGEST, "`{setting}` took {:?}", start.elapsed());
    for diagnostic in answer.diagnostics.in_file_order() {
        explained::<M>(diagnostic.code);
        assert!(diagnostic.help.is_some() || diagnostic.severity == Severity::Warning, "`{setting}`: {diagnostic:?} has no way out");
    }
    match answer.analysed {
        None => assert!(answer.diagnostics.has_errors(), "`{setting}` is refused without a reason"),
        Some(analysed) => {
            finite(setting, &analysed.outcome);
            finite(setting, &analysed.figures);
            result::<M>(&analysed.outcome);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_rewritten_without_changing_them() {
        for (text, dimension) in [("13.6 mm", Dimension::Length), ("-0.05 N/mm", Dimension::Stiffness), ("5 %", Dimension::Ratio)] {
            let other = in_other_unit(text).unwrap();
            assert_ne!(other, text);
            let (a, b) = (Quantity::parse(text, dimension).unwrap(), Quantity::parse(&other, dimension).unwrap());
            assert_eq!(a.si.to_bits(), b.si.to_bits(), "{text} {other}");
        }
        assert_eq!(in_other_unit("1 mm ± 0.02 mm").unwrap(), "1e-3 m ± 0.02e-3 m");
        assert_eq!(in_other_unit("1 mm ± 2 %").unwrap(), "1e-3 m ± 2 %");
        for plain in ["POM-C", "x = 0", "milling", "1e3 mm", "3 in"] {
            assert_eq!(in_other_unit(plain), None);
        }
    }

    #[test]
    #[should_panic(expected = "not finite")]
    fn a_hidden_nan_is_found() {
        finite("it", &vec![Some(1.0), Some(f64::NAN)]);
    }
}
