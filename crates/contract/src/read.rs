//! The reader: a visitor that fills slots from the tree of a project file and reports everything that is wrong with it.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, MOST_SHOWN, Span};
use forcewright_base::general::{General, GeneralError};
use forcewright_base::text::closest;
use forcewright_base::units::{Dimension, Quantity, QuantityError, Tolerance, Unit, format_number, format_si};

use crate::data::DataFile;
use crate::describe::{Along, Describe, Form, Located, Members, Origin, Param, Range, Reserved, Slot, Visitor, Word};
use crate::paths;
use crate::project::FileError;
use crate::tree::{Entry, Item, Table, Value};

/// Most members of a collection, and most numbers of a list: far above any mechanism, far below what exhausts a machine.
const MOST_MEMBERS: usize = 500;
const MOST_NUMBERS: usize = 32;

/// Fills a description from a tree. `root` is the place reported for what is missing from the file as a whole.
pub fn read<T: Describe + Default>(table: &Table, root: Span, diagnostics: &mut Diagnostics) -> T {
    let mut target = T::default();
    let mut unknown = Vec::new();
    let mut reader = Reader {
        table,
        place: root,
        known: Vec::new(),
        missing: Vec::new(),
        members: Vec::new(),
        reserved: Vec::new(),
        hint: None,
        absent: false,
        diagnostics,
        unknown: &mut unknown,
    };
    target.describe(&mut reader);
    reader.finish();
    if !unknown.is_empty() {
        report_unknown::<T>(unknown, diagnostics);
    }
    target
}

/// A key that no description knows, with the keys that its table knows.
struct Unknown {
    key: String,
    span: Span,
    siblings: Vec<&'static str>,
}

/// Suggests the nearest key of the same table, else a table that has such a key.
fn report_unknown<T: Describe + Default>(mut unknown: Vec<Unknown>, diagnostics: &mut Diagnostics) {
    let all = paths::keys_of(&mut T::default());
    unknown.sort_by_key(|u| u.span);
    for (index, Unknown { key, span, siblings }) in unknown.into_iter().enumerate() {
        // What nobody will be shown needs no suggestion.
        let near = if index < MOST_SHOWN { closest(&key, siblings.iter().copied()) } else { None };
        let help = if let Some(near) = near {
            format!("did you mean `{near}`?")
        } else if let Some(path) = all.iter().find(|p| p.rsplit('.').next() == Some(key.as_str())) {
            format!("this key belongs elsewhere: `{path}`")
        } else {
            format!("known here: {}", siblings.join(", "))
        };
        diagnostics.push(Diagnostic::error("E0301", span, format!("unknown key `{}`", shorten(&key))).label("not known here").help(help));
    }
}

fn shorten(text: &str) -> String {
    if text.chars().count() <= 60 { text.to_owned() } else { format!("{}…", text.chars().take(60).collect::<String>()) }
}

struct Reader<'a> {
    table: &'a Table,
    place: Span,
    known: Vec<&'static str>,
    /// Keys of this table that are names of members.
    members: Vec<String>,
    missing: Vec<Missing>,
    reserved: Vec<&'static Reserved>,
    /// Said where something is missing from this table.
    hint: Option<String>,
    /// Whether the table is not there: only its defaults are filled in.
    absent: bool,
    diagnostics: &'a mut Diagnostics,
    unknown: &'a mut Vec<Unknown>,
}

/// A required key that is not there.
struct Missing {
    key: &'static str,
    help: String,
}

impl<'a> Reader<'a> {
    fn push(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Marks a key as known, and returns its entry; notes it where it is required and missing.
    fn entry(&mut self, param: &Param) -> Option<&'a Entry> {
        self.known.push(param.key);
        let entry = self.table.get(param.key);
        if entry.is_none() && param.required {
            let example = if param.dimension == Dimension::Ratio {
                String::new()
            } else {
                format!(", such as `{} = \"{}\"`", param.key, param.dimension.example())
            };
            self.missing.push(Missing { key: param.key, help: format!("add it{example}: {}", lower_first(param.doc)) });
        }
        entry
    }

    /// The default as an item, for the parsers of values.
    fn default_item(&self, param: &Param) -> Option<Item> {
        let text = param.default?;
        let value = text.parse::<f64>().map_or_else(|_| Value::Text(text.to_owned()), Value::Number);
        Some(Item { span: self.place, value })
    }

    fn fill<T>(&mut self, param: &Param, slot: &mut Slot<T>, parse: impl Fn(&Item) -> Result<T, Box<Diagnostic>>) {
        let (item, origin) = match self.entry(param) {
            Some(entry) => (entry.item.clone(), Origin::File),
            None => match self.default_item(param) {
                Some(item) => (item, Origin::Default),
                None => return,
            },
        };
        if item.value.is_refused() {
            return;
        }
        match parse(&item) {
            Ok(value) => *slot = Some(Located { value, span: item.span, origin }),
            Err(diagnostic) => self.push(*diagnostic),
        }
    }

    fn enter<'b>(&'b mut self, table: &'b Table, place: Span) -> Reader<'b> {
        Reader {
            table,
            place,
            known: Vec::new(),
            missing: Vec::new(),
            members: Vec::new(),
            reserved: Vec::new(),
            hint: None,
            absent: false,
            diagnostics: self.diagnostics,
            unknown: self.unknown,
        }
    }

    /// Reports what is missing.
    fn report_missing(&mut self) {
        let strangers = || self.table.entries.iter().filter(|e| !self.known.contains(&e.key.as_str())).take(MOST_SHOWN);
        for Missing { key, help } in &self.missing {
            // A misspelt key is reported once, as unknown; calling it missing too would say the same twice.
            if strangers().any(|e| closest(&e.key, self.known.iter().copied()) == Some(key)) {
                continue;
            }
            let help = self.hint.as_ref().unwrap_or(help).as_str();
            self.diagnostics
                .push(Diagnostic::error("E0302", self.place, format!("`{key}` is missing")).label("from this table").help(help));
        }
    }

    /// Reports what is missing, and what nobody asked for.
    fn finish(mut self) {
        self.report_missing();
        for entry in &self.table.entries {
            if self.known.contains(&entry.key.as_str()) || self.members.contains(&entry.key) {
                continue;
            }
            match self.reserved.iter().find(|r| r.key == entry.key) {
                Some(reserved) if reserved.ignored => self.diagnostics.push(
                    Diagnostic::warning("W0101", entry.key_span, format!("`{}` is not used by this version", reserved.key))
                        .label("ignored")
                        .help(reserved.instead),
                ),
                Some(reserved) => self.diagnostics.push(
                    Diagnostic::error(
                        "E0306",
                        entry.key_span,
                        format!("`{}` is part of the language but not of this version", reserved.key),
                    )
                    .label("not available yet")
                    .help(reserved.instead),
                ),
                None => {
                    let siblings = self.known.iter().copied().chain(self.reserved.iter().map(|r| r.key)).collect();
                    self.unknown.push(Unknown { key: entry.key.clone(), span: entry.key_span, siblings });
                }
            }
        }
    }
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    match (chars.next(), chars.clone().next()) {
        // Symbols and acronyms keep their capitals.
        (Some(first), Some(second)) if second.is_lowercase() => first.to_lowercase().chain(chars).collect(),
        _ => text.to_owned(),
    }
}

fn wrong_type(item: &Item, wanted: &str, example: &str) -> Box<Diagnostic> {
    Box::new(
        Diagnostic::error("E0206", item.span, format!("expected {wanted}, found {}", item.value.kind()))
            .label(format!("expected {wanted}"))
            .help(format!("write it as {example}")),
    )
}

fn quantity_of(param: &Param, item: &Item) -> Result<Quantity, Box<Diagnostic>> {
    let dimension = param.dimension;
    let quantity = match &item.value {
        Value::Text(text) => Quantity::parse(text, dimension).map_err(|e| Box::new(quantity_error(&e, text, item.span, param)))?,
        Value::Number(value) if dimension == Dimension::Ratio => Quantity::from_si(*value, dimension),
        Value::Number(value) => {
            return Err(Box::new(
                Diagnostic::error("E0208", item.span, format!("`{}` needs a unit", param.key))
                    .label(format!("expected {}", dimension.name()))
                    .help(format!(
                        "write it with its unit and in quotes: \"{value} {}\" ({})",
                        default_unit(dimension),
                        dimension.accepted()
                    )),
            ));
        }
        _ => return Err(wrong_type(item, dimension.name(), &format!("a text such as \"{}\"", dimension.example()))),
    };
    check_range(param, quantity.si, &quantity.unit, item.span)?;
    if let Some(deviations) = quantity.deviations_si() {
        if matches!(quantity.tolerance, Some(Tolerance::Fit(_))) && !param.diameter {
            let half = format_si(0.5 * (deviations[1] - deviations[0]), &quantity.unit, 4);
            let plain = Quantity { tolerance: None, ..quantity };
            return Err(Box::new(no_diameter(param, item.span, &format!("\"{plain} ± {half}\""))));
        }
        if !deviations.iter().all(|deviation| param.range.holds(quantity.si + deviation)) {
            return Err(Box::new(
                Diagnostic::error("E0207", item.span, format!("within its tolerance, `{}` leaves the values that it may have", param.key))
                    .label("too wide")
                    .help(if param.diameter { "write a smaller half width, or a finer grade" } else { "write a smaller half width" }),
            ));
        }
    }
    Ok(quantity)
}

/// The unit an engineer would most likely have meant.
fn default_unit(dimension: Dimension) -> &'static str {
    dimension.example().split_once(' ').map_or("", |(_, unit)| unit)
}

/// A fit where none has a meaning; `instead` is what could be written.
fn no_diameter(param: &Param, span: Span, instead: &str) -> Diagnostic {
    Diagnostic::error("E0320", span, format!("`{}` has a fit, but is not the diameter of a shaft or hole", param.key))
        .label("this fit")
        .help(format!("a fit needs a diameter; write a half width, such as {instead}"))
}

fn quantity_error(error: &QuantityError, text: &str, span: Span, param: &Param) -> Diagnostic {
    let dimension = param.dimension;
    let example = format!("write {} such as \"{}\" ({})", dimension.name(), dimension.example(), dimension.accepted());
    let at = |code, message: String, label: String| Diagnostic::error(code, span, message).label(label);
    let shown = shorten(text);
    match error {
        QuantityError::NotANumber => {
            at("E0202", format!("`{shown}` does not start with a number"), format!("expected {}", dimension.name())).help(example)
        }
        QuantityError::NotFinite => {
            at("E0205", format!("`{shown}` is not a finite number"), "not a number that can be computed with".to_owned()).help(example)
        }
        QuantityError::DecimalComma(point) => {
            at("E0202", "decimal comma in a number".to_owned(), "a comma".to_owned()).help(format!("write \"{}\"", shorten(point)))
        }
        QuantityError::NoUnit => {
            // The unit belongs to the number, before the name of a tolerance.
            let (number, rest) = General::split(shown.trim()).map_or((shown.trim(), ""), |(before, _)| shown.trim().split_at(before.len()));
            let (number, blank) = (number.trim_end(), if rest.is_empty() { "" } else { " " });
            at("E0208", format!("`{shown}` has no unit"), format!("expected {}", dimension.name())).help(format!(
                "write \"{number} {}{blank}{rest}\" ({})",
                default_unit(dimension),
                dimension.accepted()
            ))
        }
        QuantityError::Unit(unit) => at("E0203", unit.to_string(), format!("expected {}", dimension.name())).help(example),
        QuantityError::WrongDimension(unit, found) => at(
            "E0201",
            found.map_or_else(
                || format!("`{unit}` is no unit of {}", dimension.name()),
                |f| format!("`{unit}` is the unit of {}, not of {}", f.name(), dimension.name()),
            ),
            format!("expected {}", dimension.name()),
        )
        .help(example),
        QuantityError::Tolerance(part) => at("E0207", format!("`{}` is not a tolerance", shorten(part)), "after the ±".to_owned())
            .help(format!("write a positive half width: \"{} ± 0.02 {}\", or \"± 2 %\"", dimension.example(), default_unit(dimension))),
        QuantityError::Fit(..) if !param.diameter => no_diameter(param, span, "\"10 mm ± 0.02 mm\""),
        QuantityError::Fit(word, why) => {
            at("E0209", format!("`{}` is no fit of this diameter: {why}", shorten(word)), "this fit".to_owned())
                .help("write a fit such as `h7` for a shaft, `H7` for a hole, or a half width, \"± 0.02 mm\"")
        }
        QuantityError::General(word, why) => {
            let what = if *why == GeneralError::Quantity { "of a length" } else { "of this length" };
            let help = match why {
                GeneralError::Class(_) => "write `ISO 2768-m` behind the length, or a half width, \"± 0.2 mm\"".to_owned(),
                _ => format!("write a half width, \"{} ± 2 %\"", dimension.example()),
            };
            at("E0209", format!("`{}` is no general tolerance {what}: {why}", shorten(word)), "this tolerance".to_owned()).help(help)
        }
    }
}

fn check_range(param: &Param, si: f64, unit: &Unit, span: Span) -> Result<(), Box<Diagnostic>> {
    let range = param.range;
    if range.holds(si) {
        return Ok(());
    }
    let show = |value: f64| format_si(value, unit, 6);
    let least = if range.above { format!("above {}", show(range.min)) } else { format!("at least {}", show(range.min)) };
    let rule = match (range.min.is_finite(), range.max.is_finite()) {
        (true, true) if range.min.to_bits() == range.max.to_bits() => show(range.min),
        (true, true) => format!("{least} and at most {}", show(range.max)),
        (true, false) => least,
        (false, _) => format!("at most {}", show(range.max)),
    };
    Err(Box::new(
        Diagnostic::error("E0204", span, format!("`{}` is {}, but must be {rule}", param.key, show(si))).label("out of range").help(
            if param.dimension == Dimension::Ratio && range.max <= 1.0 && range.holds(si / 100.0) {
                format!("did you mean \"{} %\"? (a bare number is a ratio)", format_number(si, 6))
            } else {
                format!("{}: must be {rule}", param.doc.trim_end_matches('.'))
            },
        ),
    ))
}

fn bare_number(param: &Param, item: &Item) -> Result<f64, Box<Diagnostic>> {
    match item.value {
        Value::Number(value) => check_range(param, value, &Unit::si(Dimension::Ratio), item.span).map(|()| value),
        _ => Err(wrong_type(item, "a bare number", "a number without quotes and unit, such as 1.25")),
    }
}

/// Values that were kept until their quantity was known, SI: one, or a list of them. `None` after an error, which is reported.
pub fn deferred_quantities(slot: &Located<Value>, dimension: Dimension, diagnostics: &mut Diagnostics) -> Option<Vec<f64>> {
    let param = Param::new("value", "").of(dimension);
    let own = Item { span: slot.span, value: slot.value.clone() };
    let items = if let Value::List(items) = &slot.value { items.as_slice() } else { std::slice::from_ref(&own) };
    let mut found = Vec::new();
    for item in items {
        match quantity_of(&param, item) {
            Ok(quantity) => found.push(quantity.si),
            Err(diagnostic) => {
                diagnostics.push(*diagnostic);
                return None;
            }
        }
    }
    Some(found)
}

/// A single value that was kept until its quantity was known, with its tolerance. `None` after an error, which is reported.
pub fn deferred_quantity(slot: &Located<Value>, dimension: Dimension, diagnostics: &mut Diagnostics) -> Option<Quantity> {
    let param = Param::new("value", "").of(dimension);
    quantity_of(&param, &Item { span: slot.span, value: slot.value.clone() }).map_err(|diagnostic| diagnostics.push(*diagnostic)).ok()
}

/// A file of data that is not there, or no text.
fn unreadable(error: &FileError, file: &DataFile, span: Span) -> Diagnostic {
    let (code, message) = error.refusal(&shorten(&file.path));
    let help = match error {
        FileError::TooLarge(_) => "leave out rows: a curve needs a few hundred at most",
        FileError::NotUtf8(_) => "save it as UTF-8",
        _ => "paths start at the folder of the file that names them; with `--set`, at that of the project file",
    };
    Diagnostic::error(code, span, message).label("named here").help(help)
}

fn list_of<'i>(item: &'i Item, wanted: &str, example: &str) -> Result<&'i [Item], Box<Diagnostic>> {
    match &item.value {
        Value::List(items) => Ok(items),
        _ => Err(wrong_type(item, wanted, example)),
    }
}

fn wrong_length(item: &Item, wanted: &str, found: usize) -> Box<Diagnostic> {
    Box::new(
        Diagnostic::error("E0311", item.span, format!("expected {wanted}, found {found}"))
            .label("wrong number of entries")
            .help(format!("give {wanted}")),
    )
}

fn point_of(param: &Param, item: &Item) -> Result<[Quantity; 2], Box<Diagnostic>> {
    let example = format!("two texts in brackets, such as [\"{0}\", \"{0}\"]", param.dimension.example());
    match list_of(item, "a point [x, y]", &example)? {
        [x, y] => Ok([quantity_of(param, x)?, quantity_of(param, y)?]),
        items => Err(wrong_length(item, "two coordinates", items.len())),
    }
}

/// Pairs of place and value along something, from 0 to 1.
fn places_of(param: &Param, items: &[Item]) -> Result<Vec<(f64, Quantity)>, Box<Diagnostic>> {
    let example = format!("pairs such as [\"0.5\", \"{}\"]", param.dimension.example());
    let place = Param::new("place", "Place along it.").within(0.0, 1.0);
    let mut places: Vec<(f64, Quantity)> = Vec::with_capacity(items.len());
    for (index, item) in items.iter().enumerate() {
        let [at, value] = list_of(item, "a pair of place and value", &example)? else {
            return Err(wrong_length(item, "a place and a value", list_of(item, "a pair", &example)?.len()));
        };
        let u = quantity_of(&place, at)?.si;
        let rule = match (index, places.last()) {
            (0, _) if u > 0.0 => Some("the first place must be 0"),
            (_, Some((before, _))) if u <= *before => Some("places must ascend"),
            _ if index + 1 == items.len() && u < 1.0 => Some("the last place must be 1"),
            _ => None,
        };
        if let Some(rule) = rule {
            let help = "give the value from one end to the other: [[\"0\", …], [\"0.5\", …], [\"1\", …]]";
            return Err(Box::new(Diagnostic::error("E0204", at.span, rule).label("this place").help(help)));
        }
        places.push((u, quantity_of(param, value)?));
    }
    Ok(places)
}

impl Visitor for Reader<'_> {
    fn quantity(&mut self, param: &Param, slot: &mut Slot<Quantity>) {
        self.fill(param, slot, |item| quantity_of(param, item));
    }

    fn count(&mut self, param: &Param, slot: &mut Slot<u32>) {
        self.fill(param, slot, |item| {
            let value = bare_number(param, item)?;
            if value.fract().abs() > 0.0 || !(0.0..=1e9).contains(&value) {
                return Err(wrong_type(item, "a whole number", "a whole number without unit, such as 2"));
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and in range, checked above")]
            let count = value as u32;
            Ok(count)
        });
    }

    fn numbers(&mut self, param: &Param, slot: &mut Slot<Vec<f64>>) {
        self.fill(param, slot, |item| {
            let items = list_of(item, "a list of numbers", "numbers in brackets, such as [1.3, -1.6]")?;
            if items.len() > MOST_NUMBERS {
                return Err(wrong_length(item, &format!("at most {MOST_NUMBERS} numbers"), items.len()));
            }
            items.iter().map(|i| bare_number(param, i)).collect()
        });
    }

    fn quantities(&mut self, param: &Param, most: usize, slot: &mut Slot<Vec<Quantity>>) {
        self.fill(param, slot, |item| {
            let example = format!("quantities in brackets, such as [\"{}\"]", param.dimension.example());
            match list_of(item, "a list of quantities", &example)? {
                items if (1..=most).contains(&items.len()) => items.iter().map(|i| quantity_of(param, i)).collect(),
                items => Err(wrong_length(item, &format!("1 to {most} quantities"), items.len())),
            }
        });
    }

    fn pairs(&mut self, param: &Param, first: Dimension, most: usize, slot: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        let key = Param { dimension: first, range: Range::ANY, ..*param };
        self.fill(param, slot, |item| {
            let example = format!("pairs in brackets, such as [[\"{}\", \"{}\"]]", first.example(), param.dimension.example());
            let items = list_of(item, "a list of pairs", &example)?;
            if !(1..=most).contains(&items.len()) {
                return Err(wrong_length(item, &format!("1 to {most} pairs"), items.len()));
            }
            let pair = |item: &Item| match list_of(item, "a pair", &example)? {
                [x, y] => Ok(Located::new([quantity_of(&key, x)?, quantity_of(param, y)?], item.span)),
                other => Err(wrong_length(item, "two quantities", other.len())),
            };
            items.iter().map(pair).collect()
        });
    }

    fn point(&mut self, param: &Param, slot: &mut Slot<[Quantity; 2]>) {
        self.fill(param, slot, |item| point_of(param, item));
    }

    fn points(&mut self, param: &Param, most: usize, slot: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        self.fill(param, slot, |item| {
            let example = format!("points in brackets, such as [[\"{0}\", \"{0}\"]]", param.dimension.example());
            let items = list_of(item, "a list of points [x, y]", &example)?;
            if items.len() > most {
                return Err(wrong_length(item, &format!("at most {most} points"), items.len()));
            }
            items.iter().map(|i| Ok(Located::new(point_of(param, i)?, i.span))).collect()
        });
    }

    fn along(&mut self, param: &Param, most: usize, slot: &mut Slot<Along>) {
        self.fill(param, slot, |item| match &item.value {
            Value::List(items) if (2..=most).contains(&items.len()) => places_of(param, items).map(Along::Places),
            Value::List(items) => Err(wrong_length(item, &format!("2 to {most} pairs of place and value"), items.len())),
            _ => quantity_of(param, item).map(Along::Constant),
        });
    }

    fn deferred(&mut self, param: &Param, slot: &mut Slot<Value>) {
        self.fill(param, slot, |item| Ok(item.value.clone()));
    }

    fn direction(&mut self, param: &Param, slot: &mut Slot<[f64; 2]>) {
        self.fill(param, slot, |item| match list_of(item, "a direction [x, y]", "two numbers in brackets, such as [0, -1]")? {
            [x, y] => {
                let direction = [bare_number(param, x)?, bare_number(param, y)?];
                let size = direction[0].abs().max(direction[1].abs());
                if !(1e-6..=1e6).contains(&size) {
                    return Err(Box::new(
                        Diagnostic::error("E0204", item.span, "a direction needs a length")
                            .label("out of range")
                            .help("write a vector such as [0, -1]; its length does not matter"),
                    ));
                }
                Ok(direction)
            }
            items => Err(wrong_length(item, "two components", items.len())),
        });
    }

    fn text(&mut self, param: &Param, slot: &mut Slot<String>) {
        self.fill(param, slot, |item| match &item.value {
            Value::Text(text) => Ok(text.clone()),
            _ => Err(wrong_type(item, "a text", "a text in quotes")),
        });
    }

    fn file(&mut self, param: &Param, slot: &mut Slot<DataFile>) {
        self.fill(param, slot, |item| match &item.value {
            Value::File(file) => file.content.as_ref().map(|_| file.clone()).map_err(|e| Box::new(unreadable(e, file, item.span))),
            _ => Err(wrong_type(item, "the path of a file", "a text in quotes, such as \"data.csv\"")),
        });
    }

    fn flag(&mut self, param: &Param, slot: &mut Slot<bool>) {
        self.fill(param, slot, |item| match &item.value {
            Value::Flag(flag) => Ok(*flag),
            Value::Text(text) if text == "true" || text == "false" => Ok(text == "true"),
            _ => Err(wrong_type(item, "true or false", "true or false, without quotes")),
        });
    }

    fn choice(&mut self, param: &Param, words: &'static [Word], slot: &mut Slot<&'static str>) {
        self.fill(param, slot, |item| {
            let all = || words.iter().map(|w| format!("\"{}\"", w.word)).collect::<Vec<_>>().join(", ");
            let Value::Text(text) = &item.value else {
                return Err(wrong_type(item, &format!("one of {}", all()), "a text in quotes"));
            };
            words.iter().find(|w| w.word == text).map(|w| w.word).ok_or_else(|| {
                let near = closest(text, words.iter().map(|w| w.word));
                Box::new(
                    Diagnostic::error("E0303", item.span, format!("`{}` is no value of `{}`", shorten(text), param.key))
                        .label("not known")
                        .help(near.map_or_else(|| format!("one of {}", all()), |n| format!("did you mean \"{n}\"? ({})", all()))),
                )
            })
        });
    }

    fn names(&mut self, param: &Param, least: usize, most: usize, slot: &mut Slot<Vec<Located<String>>>) {
        self.fill(param, slot, |item| {
            let single;
            let items = match &item.value {
                Value::Text(_) if least <= 1 => {
                    single = [item.clone()];
                    &single[..]
                }
                _ => list_of(item, "a list of names", "names in brackets, such as [\"n1\", \"n3\"]")?,
            };
            if items.len() < least || items.len() > most {
                let wanted = if least == most { format!("{least} names") } else { format!("{least} to {most} names") };
                return Err(wrong_length(item, &wanted, items.len()));
            }
            items
                .iter()
                .map(|i| match &i.value {
                    Value::Text(text) => Ok(Located::new(text.clone(), i.span)),
                    _ => Err(wrong_type(i, "a name", "a text in quotes")),
                })
                .collect()
        });
    }

    fn section(&mut self, param: &Param, present: &mut Slot<()>, body: &mut dyn FnMut(&mut dyn Visitor)) {
        let entry = self.entry(param);
        match entry.map(|e| &e.item.value) {
            // The defaults of an optional table hold without it; nothing is missing from it, so it is not finished.
            None if !param.required && !self.absent => {
                let empty = Table::default();
                let mut inner = Reader { absent: true, ..self.enter(&empty, self.place) };
                body(&mut inner);
            }
            None | Some(Value::Refused) => {}
            Some(Value::Table(table)) => {
                let place = entry.map_or(self.place, |e| e.key_span);
                *present = Some(Located::new((), place));
                let mut inner = self.enter(table, place);
                body(&mut inner);
                inner.finish();
            }
            Some(_) => {
                if let Some(entry) = entry {
                    let wrong = wrong_type(&entry.item, "a table", &format!("a section `[{0}]`, or `{0} = {{ … }}`", param.key));
                    self.push(*wrong);
                }
            }
        }
    }

    fn members(&mut self, param: &Param, form: Form, members: &mut dyn Members) {
        let Some(entry) = self.entry(param) else { return };
        let count = match &entry.item.value {
            Value::Table(_) if form == Form::Stages => 1,
            Value::Table(table) => table.entries.len(),
            Value::List(items) => items.len(),
            _ => 0,
        };
        if count > MOST_MEMBERS {
            return self.push(
                Diagnostic::error("E0311", entry.key_span, format!("{count} members, at most {MOST_MEMBERS} are accepted"))
                    .label("too many")
                    .help("split the mechanism, or use a layout for copies"),
            );
        }
        let found: Vec<(Located<String>, Table, Span)> = match (&entry.item.value, form) {
            (Value::Refused, _) => return,
            (Value::Table(table), Form::Table) => self.table_members(table, param),
            (Value::List(items), Form::List | Form::Stages) => self.list_members(items),
            (Value::Table(table), Form::Stages) => {
                vec![(Located::new(String::new(), entry.key_span), table.clone(), entry.key_span)]
            }
            (_, Form::Table) => {
                return self.push(*wrong_type(
                    &entry.item,
                    "a table with a key per member",
                    &format!("`[… {}]` with `name = {{ … }}`", param.key),
                ));
            }
            (_, Form::Stages) => {
                let how = format!("`[{0}]`, or `[[{0}]]` one after the other", param.key);
                return self.push(*wrong_type(&entry.item, "a table or a list of tables", &how));
            }
            (_, Form::List) => {
                return self.push(*wrong_type(&entry.item, "a list of tables", &format!("`[[… {}]]` with a `name` each", param.key)));
            }
        };
        let names: Vec<String> = found.iter().map(|(name, ..)| name.value.clone()).collect();
        for (index, (name, table, place)) in found.into_iter().enumerate() {
            // A member that a path has called into being: most likely the path is misspelt.
            let others = names.iter().map(String::as_str).filter(|other| *other != name.value);
            let hint = if form == Form::List && name.span == place && name.origin == Origin::File {
                Some(match closest(&name.value, others.clone()) {
                    Some(near) => format!("`{}` is a new member; did you mean `{near}`?", shorten(&name.value)),
                    None => format!("`{}` is a new member; there are {}", shorten(&name.value), others.collect::<Vec<_>>().join(", ")),
                })
            } else {
                None
            };
            members.add(name);
            let mut inner = self.enter(&table, place);
            inner.hint = hint;
            members.describe(index, &mut inner);
            if form == Form::List {
                inner.known.push("name");
            }
            inner.finish();
        }
    }

    fn tables(&mut self, _: &Param, members: &mut dyn Members) {
        let stranger = |e: &&Entry| !self.known.contains(&e.key.as_str()) && !self.reserved.iter().any(|r| r.key == e.key);
        let is_table = |e: &&Entry| matches!(e.item.value, Value::Table(_));
        let found: Vec<&Entry> = self.table.entries.iter().filter(stranger).filter(is_table).take(MOST_MEMBERS).collect();
        for (index, entry) in found.into_iter().enumerate() {
            let Value::Table(table) = &entry.item.value else { continue };
            self.members.push(entry.key.clone());
            members.add(Located::new(entry.key.clone(), entry.key_span));
            let mut inner = self.enter(table, entry.key_span);
            members.describe(index, &mut inner);
            inner.finish();
        }
    }

    fn free(&mut self, param: &Param) {
        self.known.push(param.key);
    }

    fn reserved(&mut self, keys: &'static [Reserved]) {
        self.reserved.extend(keys);
    }
}

impl Reader<'_> {
    fn table_members(&mut self, table: &Table, param: &Param) -> Vec<(Located<String>, Table, Span)> {
        let mut found = Vec::new();
        for entry in &table.entries {
            match &entry.item.value {
                Value::Table(inner) => found.push((Located::new(entry.key.clone(), entry.key_span), inner.clone(), entry.key_span)),
                Value::Refused => {}
                _ => self.push(*wrong_type(&entry.item, "a table", &format!("`{} = {{ … }}` in `{}`", shorten(&entry.key), param.key))),
            }
        }
        found
    }

    fn list_members(&mut self, items: &[Item]) -> Vec<(Located<String>, Table, Span)> {
        let mut found: Vec<(Located<String>, Table, Span)> = Vec::new();
        for (index, item) in items.iter().enumerate() {
            let Value::Table(table) = &item.value else {
                if !item.value.is_refused() {
                    self.push(*wrong_type(item, "a table", "`[[…]]` with its keys below"));
                }
                continue;
            };
            let mut table = table.clone();
            let name = match table.take("name") {
                None => Located { value: format!("{}", index + 1), span: item.span, origin: Origin::Default },
                Some(Entry { item: Item { value: Value::Text(name), span }, .. }) => Located::new(name, span),
                Some(entry) => {
                    if !entry.item.value.is_refused() {
                        self.push(*wrong_type(&entry.item, "a name", "a text in quotes"));
                    }
                    continue;
                }
            };
            if let Some((first, ..)) = found.iter().find(|(other, ..)| other.value == name.value) {
                self.diagnostics.push(
                    Diagnostic::error("E0307", name.span, format!("the name `{}` is given twice", shorten(&name.value)))
                        .label("second time")
                        .related(first.span, "first time")
                        .help("give each member its own name"),
                );
                continue;
            }
            found.push((name, table, item.span));
        }
        found
    }
}
