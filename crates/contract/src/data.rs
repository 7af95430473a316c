//! Tables of measured data beside a project: which keys name them, and how their text is read.
//!
//! A table is a CSV file: lines that begin with `#` are comments, the first other line names the columns with their units, `travel / mm,
//! force / N`, and numbers with a decimal point follow. Columns are separated by commas, or by semicolons where the header has one. They
//! stand in a fixed order ([`rows`]), or are found by names that the project gives ([`named_rows`]).

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, SourceId, Span};
use forcewright_base::units::{Dimension, Quantity, QuantityError, Unit};

use crate::describe::Located;
use crate::project::FileError;

/// Whether a key names a file: `file`, or a key that ends in `_file`. No other key does, so that files are found before anything is
/// understood, and by who writes a project into another folder.
pub fn names_a_file(key: &str) -> bool {
    key == "file" || key.ends_with("_file")
}

/// A file that a key names.
#[derive(Clone, Debug)]
pub struct DataFile {
    /// As typed.
    pub path: String,
    /// What stands in it.
    pub content: Result<Content, FileError>,
}

/// The text of a file.
#[derive(Clone, Debug)]
pub struct Content {
    /// Its number among the sources of the project.
    pub source: SourceId,
    /// The text, without a byte order mark.
    pub text: Arc<str>,
}

impl fmt::Display for DataFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.path)
    }
}

/// What a column must hold.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// What it is, for messages.
    pub name: &'static str,
    /// Its quantity.
    pub dimension: Dimension,
}

/// A value of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The value, SI.
    pub si: f64,
    /// Where it stands.
    pub span: Span,
}

/// Columns separated by `separator`, each without the blanks and the quotes around it.
fn cells(line: &str, base: Span, separator: char) -> Vec<(Span, &str)> {
    let mut at = base.start;
    let parts = line.split(separator).map(|part| {
        let start = at + (part.len() - part.trim_start().len());
        at += part.len() + separator.len_utf8();
        let text = part.trim();
        let bare = text.strip_prefix('"').and_then(|t| t.strip_suffix('"')).unwrap_or(text);
        (Span { start, end: start + text.len(), ..base }, bare.trim())
    });
    parts.collect()
}

/// As many errors of one code are told of one file; how many more there are is said with the next.
const MOST_ALIKE: usize = 5;

/// Reports errors of a file, of each code the first few.
pub(crate) fn report_few(errors: Vec<Diagnostic>, diagnostics: &mut Diagnostics) {
    let mut counts: BTreeMap<&'static str, usize> = BTreeMap::new();
    for error in &errors {
        *counts.entry(error.code).or_default() += 1;
    }
    let mut told: BTreeMap<&'static str, usize> = BTreeMap::new();
    for error in errors {
        let before = told.entry(error.code).or_default();
        let more = counts.get(error.code).map_or(0, |all| all - MOST_ALIKE.min(*all));
        *before += 1;
        // One more takes no more room than to say so.
        if *before <= MOST_ALIKE || more == 1 {
            diagnostics.push(error);
        } else if *before == MOST_ALIKE + 1 {
            let span = error.span.unwrap_or_default();
            diagnostics
                .push(Diagnostic::error(error.code, span, format!("… and {more} more like these")).label("the next").help_opt(error.help));
        }
    }
}

/// What is wrong with the rows of a file.
#[derive(Default)]
struct Wrong {
    errors: Vec<Diagnostic>,
    /// Numbers with decimal commas where points are expected.
    commas: Vec<Diagnostic>,
}

impl Wrong {
    fn number(&mut self, error: &QuantityError, text: &str, span: Span) {
        let list = if matches!(error, QuantityError::DecimalComma(_)) { &mut self.commas } else { &mut self.errors };
        list.push(number_error(error, text, span));
    }

    fn row(&mut self, place: Span, [found, expected]: [usize; 2], (separator, numbers): (char, &str)) {
        let (values, are) = (if found == 1 { "value" } else { "values" }, if expected == 1 { "is" } else { "are" });
        let help = format!("separate the columns by `{separator}`, as in the header, and write decimal {numbers}");
        self.errors.push(broken(place, format!("{found} {values}, {expected} {are} expected"), "this row", help));
    }

    /// Reports all of it; a file that is written with decimal commas, once, at its header.
    fn report(mut self, header: Span, decimal_is_a_key: bool, diagnostics: &mut Diagnostics) {
        if let [first, second, ..] = &self.commas[..] {
            let (code, help) = if decimal_is_a_key {
                ("E0912", "write `decimal = \"comma\"` beside `file`")
            } else {
                ("E0202", "write decimal points: 12.5, not 12,5")
            };
            let message = format!("{} numbers of this file have decimal commas", self.commas.len());
            let mut error = Diagnostic::error(code, header, message).label("below this header").help(help);
            for place in [first, second].into_iter().filter_map(|d| d.span) {
                error = error.related(place, "such a number");
            }
            self.errors.push(error);
        } else {
            self.errors.append(&mut self.commas);
        }
        report_few(self.errors, diagnostics);
    }
}

fn broken(span: Span, message: impl Into<String>, label: &str, help: impl Into<String>) -> Diagnostic {
    Diagnostic::error("E0112", span, message).label(label).help(help)
}

/// The lines that are neither empty nor comments, with their places.
fn lines(content: &Content) -> impl Iterator<Item = (Span, &str)> {
    let whole = Span { source: content.source, ..Span::default() };
    let mut at = 0;
    let all = content.text.split_inclusive('\n').map(move |line| {
        let start = at;
        at += line.len();
        let text = line.trim_end_matches(['\n', '\r']);
        (Span { start, end: start + text.len(), ..whole }, text)
    });
    all.filter(|(_, text)| !text.trim().is_empty() && !text.trim_start().starts_with('#'))
}

/// Reads the columns that are wanted, in their order, and no others: a row per line, at most `most`. What is wrong is reported at its
/// line and column; `None` after an error.
pub fn rows<const N: usize>(file: &DataFile, columns: &[Column; N], most: usize, diagnostics: &mut Diagnostics) -> Option<Vec<[Cell; N]>> {
    let content = file.content.as_ref().ok()?;
    let mut lines = lines(content);
    let Some((place, header)) = lines.next() else {
        let whole = Span { source: content.source, ..Span::default() };
        diagnostics.push(broken(whole, format!("`{file}` is empty"), "no header", format!("begin with {}", example(columns))));
        return None;
    };
    let separator = if header.contains(';') { ';' } else { ',' };
    let units = units((place, header), separator, columns, diagnostics)?;
    let before = diagnostics.errors();
    let (mut found, mut wrong) = (Vec::new(), Wrong::default());
    let top = place;
    for (place, line) in lines {
        if found.len() == most {
            diagnostics.push(broken(place, format!("more than {most} rows"), "one too many", "leave out rows: every second, every tenth"));
            return None;
        }
        let values = cells(line, place, separator);
        if values.len() != N {
            wrong.row(place, [values.len(), N], (separator, "points"));
            continue;
        }
        let mut row = [Cell { si: 0.0, span: place }; N];
        for ((cell, unit), (span, text)) in row.iter_mut().zip(&units).zip(values) {
            match Quantity::parse_in(text, unit) {
                Ok(quantity) => *cell = Cell { si: quantity.si, span },
                Err(error) => wrong.number(&error, text, span),
            }
        }
        found.push(row);
    }
    wrong.report(top, false, diagnostics);
    if found.is_empty() && diagnostics.errors() == before {
        diagnostics.push(broken(place, format!("`{file}` has no rows"), "nothing below this header", "write numbers below it"));
    }
    (diagnostics.errors() == before).then_some(found)
}

/// A column that is found by its name.
#[derive(Clone, Copy, Debug)]
pub struct Named<'a> {
    /// Its header with its unit, as a key of the project names it: `mass / g`. Blanks count for nothing.
    pub header: &'a Located<String>,
    /// The key, for messages.
    pub key: &'static str,
    /// Its quantity.
    pub dimension: Dimension,
}

/// Reads columns by the names of their headers, wherever they stand, and leaves the others alone: a row per line, at most `most`, with the
/// values in the order of `columns`. What is wrong is reported at its line and column; `None` after an error.
pub fn named_rows<const N: usize>(
    file: &DataFile,
    columns: &[Named<'_>; N],
    most: usize,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<[Cell; N]>> {
    named_rows_with(file, columns, most, None, diagnostics)
}

/// How numbers of a table are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decimal {
    /// `12.5`
    Point,
    /// `12,5`, with columns separated by semicolons.
    Comma,
}

impl Decimal {
    fn parse(self, text: &str, unit: &Unit) -> Result<Quantity, QuantityError> {
        match self {
            Self::Point => Quantity::parse_in(text, unit),
            // A point would be one between thousands, which a reader may take for the other.
            Self::Comma if text.contains('.') => Err(QuantityError::NotANumber),
            Self::Comma => Quantity::parse_in(&text.replace(',', "."), unit),
        }
    }
}

/// How a table of a measured curve is written.
#[derive(Clone, Copy, Debug)]
pub struct Written<'a> {
    /// How its numbers are, as the key `decimal` says.
    pub decimal: Decimal,
    /// What curve may be measured, for messages: `force over travel`.
    pub curve: &'a str,
}

/// [`named_rows`] of a measured curve, whose numbers may have decimal commas.
pub fn named_rows_with<const N: usize>(
    file: &DataFile,
    columns: &[Named<'_>; N],
    most: usize,
    written: Option<Written<'_>>,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<[Cell; N]>> {
    let decimal = written.map_or(Decimal::Point, |w| w.decimal);
    let content = file.content.as_ref().ok()?;
    let mut lines = lines(content);
    let Some((place, header)) = lines.next() else {
        let whole = Span { source: content.source, ..Span::default() };
        let wanted = columns.iter().map(|c| c.header.value.as_str()).collect::<Vec<_>>().join(", ");
        diagnostics.push(broken(whole, format!("`{file}` is empty"), "no header", format!("begin with a header `{wanted}`")));
        return None;
    };
    let separator = if header.contains(';') { ';' } else { ',' };
    if decimal == Decimal::Comma && separator == ',' {
        let help = "separate the columns by `;`, in the header too, or write decimal points without `decimal = \"comma\"`";
        diagnostics.push(broken(place, "decimal commas between columns that commas separate", "this header", help));
        return None;
    }
    let names = cells(header, place, separator);
    let before = diagnostics.errors();
    let found: Vec<(usize, Unit)> = columns.iter().filter_map(|c| find(c, &names, (place, written), diagnostics)).collect();
    if diagnostics.errors() > before {
        return None;
    }
    let (mut all, mut wrong) = (Vec::new(), Wrong::default());
    let top = place;
    for (place, line) in lines {
        if all.len() == most {
            diagnostics.push(broken(place, format!("more than {most} rows"), "one too many", "leave out rows: every second, every tenth"));
            return None;
        }
        let values = cells(line, place, separator);
        if values.len() != names.len() {
            let numbers = if decimal == Decimal::Comma { "commas" } else { "points" };
            wrong.row(place, [values.len(), names.len()], (separator, numbers));
            continue;
        }
        let mut row = [Cell { si: 0.0, span: place }; N];
        for (cell, (index, unit)) in row.iter_mut().zip(&found) {
            let (span, text) = values[*index];
            match decimal.parse(text, unit) {
                Ok(quantity) => *cell = Cell { si: quantity.si, span },
                Err(error) => wrong.number(&error, text, span),
            }
        }
        all.push(row);
    }
    wrong.report(top, written.is_some(), diagnostics);
    if all.is_empty() && diagnostics.errors() == before {
        diagnostics.push(broken(place, format!("`{file}` has no rows"), "nothing below this header", "write numbers below it"));
    }
    (diagnostics.errors() == before).then_some(all)
}

/// The place of a column in the header, and its unit.
fn find(
    column: &Named<'_>,
    names: &[(Span, &str)],
    (place, written): (Span, Option<Written<'_>>),
    diagnostics: &mut Diagnostics,
) -> Option<(usize, Unit)> {
    let plain = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    let Named { header, key, dimension } = *column;
    let wanted = plain(&header.value);
    let mut all = names.iter().enumerate().filter(|(_, (_, name))| plain(name) == wanted);
    let Some((index, (_, name))) = all.next() else {
        let others: Vec<String> = names.iter().map(|(_, name)| format!("`{name}`")).collect();
        let message = format!("the file has no column `{}`", header.value);
        let help = format!("its header names {}: write one of them as `{key} = \"…\"`", others.join(", "));
        diagnostics.push(broken(header.span, message, "this column", help).related(place, "the header"));
        return None;
    };
    if let Some((_, (span, _))) = all.next() {
        let message = format!("two columns are named `{}`", header.value);
        diagnostics.push(broken(*span, message, "named before", "give them names of their own"));
        return None;
    }
    let curve = written.map_or_else(String::new, |w| format!("this design is compared by its {}: ", w.curve));
    let help = format!("{curve}write `{key} = \"{} / {}\"`, and the same in the header of the file", key, unit_of(dimension));
    let (code, message) = match name.split_once('/').map(|(_, unit)| Unit::parse(unit.trim())) {
        None if dimension == Dimension::Ratio => return Some((index, Unit::si(dimension))),
        None => ("E0208", format!("the column `{name}` has no unit")),
        Some(Err(error)) => ("E0203", error.to_string()),
        Some(Ok(unit)) if !unit.is(dimension) => ("E0201", format!("`{}` is no unit of {}", unit.symbol(), dimension.name())),
        Some(Ok(unit)) => return Some((index, unit)),
    };
    diagnostics.push(Diagnostic::error(code, header.span, message).label(format!("expected {}", dimension.name())).help(help));
    None
}

/// A unit of a quantity.
fn unit_of(dimension: Dimension) -> &'static str {
    dimension.example().split_once(' ').map_or("1", |(_, unit)| unit)
}

/// A header with what is wanted.
fn example<const N: usize>(columns: &[Column; N]) -> String {
    let one = |c: &Column| {
        let unit = c.dimension.example().split_once(' ').map_or("", |(_, unit)| unit);
        if unit.is_empty() { c.name.to_owned() } else { format!("{} / {unit}", c.name) }
    };
    format!("a header `{}`", columns.iter().map(one).collect::<Vec<_>>().join(", "))
}

/// The units of the header.
fn units<const N: usize>(
    (place, header): (Span, &str),
    separator: char,
    columns: &[Column; N],
    diagnostics: &mut Diagnostics,
) -> Option<Vec<Unit>> {
    let names = cells(header, place, separator);
    let help = format!("write {}", example(columns));
    if names.iter().any(|(_, name)| name.starts_with(|c: char| c.is_ascii_digit())) {
        diagnostics.push(broken(place, "the header is missing", "numbers without names", help));
        return None;
    }
    if names.len() != N {
        let message = format!("the header names {} {}, {N} are expected", names.len(), if names.len() == 1 { "column" } else { "columns" });
        diagnostics.push(broken(place, message, "this header", format!("{help}, columns separated by `,` or `;`")));
        return None;
    }
    let mut units = Vec::with_capacity(N);
    for ((span, name), column) in names.into_iter().zip(columns) {
        let wanted = column.dimension;
        let (code, message) = match name.split_once('/').map(|(_, unit)| Unit::parse(unit.trim())) {
            None if wanted == Dimension::Ratio => {
                units.push(Unit::si(wanted));
                continue;
            }
            None => ("E0208", format!("the column of the {} has no unit", column.name)),
            Some(Err(error)) => ("E0203", error.to_string()),
            Some(Ok(unit)) if !unit.is(wanted) => {
                let kind = unit.dimension().map_or_else(String::new, |d| format!(" the unit of {},", d.name()));
                ("E0201", format!("`{unit}` is{kind} no unit of {}", wanted.name(), unit = unit.symbol()))
            }
            Some(Ok(unit)) => {
                units.push(unit);
                continue;
            }
        };
        diagnostics.push(Diagnostic::error(code, span, message).label(format!("expected {}", wanted.name())).help(help.clone()));
    }
    (units.len() == N).then_some(units)
}

fn number_error(error: &QuantityError, text: &str, span: Span) -> Diagnostic {
    let shown: String = text.chars().take(60).collect();
    let (code, message, help) = match error {
        QuantityError::DecimalComma(point) => ("E0202", "decimal comma in a number".to_owned(), format!("write {point}")),
        QuantityError::NotFinite => {
            ("E0205", format!("`{shown}` is not a finite number"), "leave the row out where nothing was measured".to_owned())
        }
        _ if text.is_empty() => ("E0202", "a value is missing".to_owned(), "leave the row out where nothing was measured".to_owned()),
        _ => ("E0202", format!("`{shown}` is not a number"), "write a bare number: the unit stands in the header".to_owned()),
    };
    Diagnostic::error(code, span, message).label("this value").help(help)
}
