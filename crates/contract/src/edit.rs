//! A project file with other values in it: comments, order and everything else stay.

mod settings;

pub use settings::{with_base_from, with_settings, with_text_at};

use forcewright_base::diagnostics::SourceId;

use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, TableLike, Value};

use crate::numbers::{Number, Part};

/// Digits written: far finer than anything is made, and short enough to read.
const DIGITS: usize = 7;
/// Digits of a tolerance, which is not changed.
const TOLERANCE_DIGITS: usize = 12;

/// Why a file cannot be changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EditError {
    /// The text is not TOML.
    NotToml(String),
    /// There is something else where a value should go; the field is the path.
    InTheWay(String),
}

impl std::fmt::Display for EditError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotToml(why) => write!(f, "the file is not valid TOML: {why}"),
            Self::InTheWay(path) => write!(f, "`{path}` cannot be written: something else is in its place"),
        }
    }
}

impl std::error::Error for EditError {}

/// The text of the project's first file with the numbers at their new values, SI, each written in its own unit and with its tolerance. A
/// number that stands in a file that this one extends is written into this one, which is laid over it. A `variant` that says otherwise is
/// changed as well.
///
/// # Errors
/// [`EditError`] names what is in the way.
pub fn with_values(text: &str, numbers: &[Number], changed: &[(usize, f64)], variant: Option<&str>) -> Result<String, EditError> {
    let mut document: DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| EditError::NotToml(e.message().to_owned()))?;
    for (index, si) in changed {
        let Some(number) = numbers.get(*index) else { continue };
        let change = Change { numbers, changed, number, si: *si };
        change.set(document.as_table_mut(), &change.key_path(), true)?;
        let Some(variant) = variant else { continue };
        // The extended file may have this variant too, and it would win.
        let create = number.span.source != SourceId::default();
        let path: Vec<&str> = ["variants", variant].into_iter().chain(change.key_path()).collect();
        change.set(document.as_table_mut(), &path, create)?;
    }
    Ok(document.to_string())
}

/// The text with a variant in which the numbers are at their new values, SI: a new one, or one that it has. The rest stays as it is.
///
/// # Errors
/// [`EditError`] names what is in the way.
pub fn with_variant(text: &str, numbers: &[Number], changed: &[(usize, f64)], variant: &str) -> Result<String, EditError> {
    let mut document: DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| EditError::NotToml(e.message().to_owned()))?;
    for (index, si) in changed {
        let Some(number) = numbers.get(*index) else { continue };
        let change = Change { numbers, changed, number, si: *si };
        let path: Vec<&str> = ["variants", variant].into_iter().chain(change.key_path()).collect();
        change.set(document.as_table_mut(), &path, true)?;
    }
    Ok(document.to_string())
}

/// The text without some of its sections, and the names of those that it had.
///
/// # Errors
/// [`EditError`] if the text is not TOML.
pub fn without_tables(text: &str, roots: &[&'static str]) -> Result<(String, Vec<&'static str>), EditError> {
    let mut document: DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| EditError::NotToml(e.message().to_owned()))?;
    let gone: Vec<&'static str> = roots.iter().filter(|root| document.remove(root).is_some()).copied().collect();
    Ok((document.to_string(), gone))
}

/// A number as it is written in a file.
fn written(number: &Number, si: f64) -> Value {
    let plain = rounded(number.unit.from_si(si));
    let symbol = number.unit.symbol();
    let symbol = if symbol == "1" { "" } else { symbol };
    if matches!(number.part, Part::Entry(_)) || symbol.is_empty() && number.tolerance.is_none() {
        return Value::from(plain);
    }
    let text = if symbol.is_empty() { plain.to_string() } else { format!("{plain} {symbol}") };
    let suffix = number.tolerance.map_or_else(String::new, |tolerance| tolerance.suffix(&number.unit, TOLERANCE_DIGITS));
    Value::from(text + &suffix)
}

fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

/// One number on its way into a file.
struct Change<'a> {
    numbers: &'a [Number],
    changed: &'a [(usize, f64)],
    number: &'a Number,
    si: f64,
}

/// The path of a number's key, without what leads inside its value.
fn key_path(number: &Number) -> &str {
    (0..number.part.depth()).fold(&number.path, |path, _| path.rsplit_once('.').map_or(path, |(key, _)| key))
}

impl<'a> Change<'a> {
    fn key_path(&self) -> Vec<&'a str> {
        key_path(self.number).split('.').collect()
    }

    fn in_the_way(&self) -> EditError {
        EditError::InTheWay(self.number.path.clone())
    }

    /// Sets the value at a path below a table; where `create` is not set, only if it is there.
    fn set(&self, table: &mut dyn TableLike, path: &[&str], create: bool) -> Result<(), EditError> {
        let [key, rest @ ..] = path else { return Err(self.in_the_way()) };
        if !table.contains_key(key) {
            if !create {
                return Ok(());
            }
            if rest.is_empty() {
                table.insert(key, Item::Value(self.value()));
                return Ok(());
            }
            let mut new = Table::new();
            new.set_implicit(true);
            table.insert(key, Item::Table(new));
        }
        let Some(item) = table.get_mut(key) else { return Err(self.in_the_way()) };
        if rest.is_empty() {
            return self.replace(item).ok_or_else(|| self.in_the_way());
        }
        if let Some(list) = item.as_array_of_tables_mut() {
            let [name, inner @ ..] = rest else { return Err(self.in_the_way()) };
            return match member(list, name, create) {
                Some(table) => self.set(table, inner, create),
                None if create => Err(self.in_the_way()),
                None => Ok(()),
            };
        }
        if let Some(list) = item.as_array_mut() {
            let [name, inner @ ..] = rest else { return Err(self.in_the_way()) };
            return match inline_member(list, name) {
                Some(table) => self.set(table, inner, create),
                None if create => Err(self.in_the_way()),
                None => Ok(()),
            };
        }
        let inner = item.as_table_like_mut().ok_or_else(|| self.in_the_way())?;
        self.set(inner, rest, create)
    }

    /// The whole value of the key: the number, or the list that it is part of.
    fn value(&self) -> Value {
        let key = key_path(self.number);
        let together: Vec<&Number> = self.numbers.iter().filter(|n| n.part.depth() > 0 && key_path(n) == key).collect();
        match self.number.part {
            Part::Whole => written(self.number, self.si),
            Part::Entry(_) | Part::Item(_) | Part::Coordinate(_) => together.iter().map(|n| self.now(n)).collect::<Array>().into(),
            Part::OfPoints(..) => {
                let point = |pair: &[&Number]| Value::from(pair.iter().map(|n| self.now(n)).collect::<Array>());
                together.chunks(2).map(point).collect::<Array>().into()
            }
            Part::AtPlace(..) => {
                let pair = |n: &&Number| {
                    let Part::AtPlace(_, u) = n.part else { return None };
                    Some(Value::from([Value::from(u.to_string()), self.now(n)].into_iter().collect::<Array>()))
                };
                together.iter().filter_map(pair).collect::<Array>().into()
            }
        }
    }

    /// The value that another number has by now, as it is written.
    fn now(&self, other: &Number) -> Value {
        let new = self.changed.iter().find(|(i, _)| self.numbers.get(*i).is_some_and(|n| n.path == other.path));
        written(other, new.map_or(other.si, |(_, si)| *si))
    }

    /// Replaces a value, or what is the number's in a list, and keeps the white space and the comments around it.
    fn replace(&self, item: &mut Item) -> Option<()> {
        let all = self.value();
        if item.is_value() {
            let old = item.as_value_mut()?;
            let same = old.as_array().zip(all.as_array()).is_some_and(|(old, new)| old.len() == new.len());
            match self.inside(old).filter(|_| same) {
                Some(own) => put(own, written(self.number, self.si)),
                None => put(item.as_value_mut()?, all),
            }
            return Some(());
        }
        // `at.x = …`, `bend.2 = …` over a list of the extended file.
        let table = item.as_table_like_mut()?;
        let part = match self.number.part {
            Part::Entry(_) | Part::Item(_) | Part::Coordinate(_) => self.number.path.rsplit('.').next()?,
            _ => return None,
        };
        match table.get_mut(part) {
            Some(own) => put(own.as_value_mut()?, written(self.number, self.si)),
            None => drop(table.insert(part, Item::Value(written(self.number, self.si)))),
        }
        Some(())
    }

    /// Where the number stands inside a list.
    fn inside<'v>(&self, list: &'v mut Value) -> Option<&'v mut Value> {
        let (first, second) = match self.number.part {
            Part::Whole => return None,
            Part::Entry(index) | Part::Item(index) | Part::Coordinate(index) => (index, None),
            Part::OfPoints(index, axis) => (index, Some(axis)),
            Part::AtPlace(index, _) => (index, Some(1)),
        };
        let outer = list.as_array_mut()?.get_mut(first)?;
        match second {
            None => Some(outer),
            Some(second) => outer.as_array_mut()?.get_mut(second),
        }
    }
}

fn put(old: &mut Value, mut new: Value) {
    *new.decor_mut() = old.decor().clone();
    *old = new;
}

/// The index that a name is, where members have none of their own.
fn place(name: &str, length: usize) -> Option<usize> {
    name.parse::<usize>().ok()?.checked_sub(1).filter(|i| *i < length)
}

/// A member of a list of tables by its name, or by its place where members have none.
fn member<'a>(list: &'a mut ArrayOfTables, name: &str, create: bool) -> Option<&'a mut Table> {
    let named = |table: &Table| table.get("name").and_then(Item::as_str).map(str::to_owned);
    let unnamed = list.iter().all(|table| named(table).is_none());
    let found = list.iter().position(|table| named(table).as_deref() == Some(name)).or_else(|| place(name, list.len()).filter(|_| unnamed));
    if let Some(place) = found {
        return list.get_mut(place);
    }
    if !create || unnamed {
        return None;
    }
    let mut table = Table::new();
    table.insert("name", toml_edit::value(name));
    list.push(table);
    list.get_mut(list.len() - 1)
}

/// The same in a list that is written in brackets.
fn inline_member<'a>(list: &'a mut Array, name: &str) -> Option<&'a mut dyn TableLike> {
    let named = |value: &Value| value.as_inline_table()?.get("name")?.as_str().map(str::to_owned);
    let unnamed = list.iter().all(|value| named(value).is_none());
    let found =
        list.iter().position(|value| named(value).as_deref() == Some(name)).or_else(|| place(name, list.len()).filter(|_| unnamed))?;
    Some(list.get_mut(found)?.as_inline_table_mut()?)
}
