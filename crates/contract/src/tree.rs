//! The project file as a tree of values, each with its place. Merging (`extends`, `variants`, `--set`) happens here, before anything
//! is understood, and keeps the places, so that an error points at the text that caused it wherever that text stands.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, SourceId, Span};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Deepest nesting accepted; real files need five.
const DEEPEST: usize = 32;

/// A value with its place.
#[derive(Clone, Debug)]
pub struct Item {
    /// Where it stands.
    pub span: Span,
    /// What it is.
    pub value: Value,
}

/// A value of the project file.
#[derive(Clone, Debug)]
pub enum Value {
    /// A string.
    Text(String),
    /// An integer or a float, as a double.
    Number(f64),
    /// `true` or `false`.
    Flag(bool),
    /// An array, or an array of tables.
    List(Vec<Item>),
    /// A table.
    Table(Table),
}

impl Value {
    /// The kind of value, with its article, for messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Text(_) => "a text",
            Self::Number(_) => "a bare number",
            Self::Flag(_) => "true or false",
            Self::List(_) => "a list",
            Self::Table(_) => "a table",
        }
    }
}

/// One key of a table.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Where the key stands.
    pub key_span: Span,
    /// Its value.
    pub item: Item,
}

/// A table, in the order of the file.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Its keys.
    pub entries: Vec<Entry>,
}

impl Table {
    /// The entry of a key.
    pub fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|e| e.key == key)
    }

    /// Takes an entry out.
    pub fn take(&mut self, key: &str) -> Option<Entry> {
        let at = self.entries.iter().position(|e| e.key == key)?;
        Some(self.entries.remove(at))
    }

    /// Lays another table over this one: tables merge key by key, lists of named tables merge name by name, everything else is
    /// replaced. The other wins.
    pub fn overlay(&mut self, other: Self) {
        for entry in other.entries {
            match self.entries.iter_mut().find(|e| e.key == entry.key) {
                None => self.entries.push(entry),
                Some(mine) => merge(mine, entry),
            }
        }
    }
}

fn merge(mine: &mut Entry, theirs: Entry) {
    let replaced = match (&mut mine.item.value, theirs.item.value) {
        (Value::Table(base), Value::Table(over)) => return base.overlay(over),
        (Value::List(base), Value::List(over)) if named(base) && named(&over) => {
            for item in over {
                let at = base.iter().position(|b| name_of(b).is_some() && name_of(b) == name_of(&item));
                match (at, item) {
                    (Some(at), Item { value: Value::Table(table), .. }) => overlay_item(&mut base[at], table),
                    (_, item) => base.push(item),
                }
            }
            return;
        }
        // `design.beams.b1.bend = …` in a variant or on the command line: members of a list by name.
        (Value::List(base), Value::Table(over)) if named(base) => {
            let mut strangers = Table::default();
            for entry in over.entries {
                match (base.iter().position(|b| name_of(b) == Some(entry.key.as_str())), entry.item.value) {
                    (Some(at), Value::Table(table)) => overlay_item(&mut base[at], table),
                    (_, value) => strangers.entries.push(Entry { item: Item { value, ..entry.item }, ..entry }),
                }
            }
            // A name that the list does not have becomes a member without `name`: the reader says what is missing, at this place.
            base.extend(strangers.entries.into_iter().map(|entry| Item {
                span: entry.key_span,
                value: match entry.item.value {
                    Value::Table(mut table) => {
                        let name = Item { span: entry.key_span, value: Value::Text(entry.key) };
                        table.entries.insert(0, Entry { key: "name".to_owned(), key_span: entry.key_span, item: name });
                        Value::Table(table)
                    }
                    other => other,
                },
            }));
            return;
        }
        (_, other) => other,
    };
    mine.key_span = theirs.key_span;
    mine.item = Item { span: theirs.item.span, value: replaced };
}

fn overlay_item(item: &mut Item, over: Table) {
    if let Value::Table(table) = &mut item.value {
        table.overlay(over);
    }
}

fn named(list: &[Item]) -> bool {
    !list.is_empty() && list.iter().all(|item| name_of(item).is_some())
}

fn name_of(item: &Item) -> Option<&str> {
    let Value::Table(table) = &item.value else { return None };
    match &table.get("name")?.item.value {
        Value::Text(name) => Some(name),
        _ => None,
    }
}

/// Reads a text. What cannot be read is reported; the rest of the tree is still returned, so that further errors are found too.
pub fn parse(text: &str, source: SourceId, diagnostics: &mut Diagnostics) -> Table {
    let whole = |at: usize| Span { source, start: at, end: at + 1 };
    if let Some(at) = too_deep(text) {
        diagnostics.push(
            Diagnostic::error("E0107", whole(at), format!("nested deeper than {DEEPEST} levels"))
                .help("a project file needs at most five levels; look for an unclosed bracket"),
        );
        return Table::default();
    }
    let (document, errors) = DeTable::parse_recoverable(text);
    for error in errors {
        let range = error.span().unwrap_or(0..0);
        let span = Span { source, start: range.start, end: range.end.max(range.start + 1) };
        diagnostics.push(syntax_error(error.message(), span));
    }
    let mut converter = Converter { source, diagnostics };
    converter.table(document.into_inner())
}

fn syntax_error(message: &str, span: Span) -> Diagnostic {
    if message.contains("duplicate key") {
        return Diagnostic::error("E0106", span, "this key is given twice").label("second time").help("keep one of the two");
    }
    Diagnostic::error("E0105", span, format!("not valid TOML: {message}"))
        .help("values with units are quoted texts (`thickness = \"1 mm\"`), tables start with `[name]`, comments with `#`")
}

/// Reads the value given with `--set KEY=VALUE`: TOML if it is TOML, otherwise a text, so that a shell's lost quotes do no harm.
pub fn parse_value(text: &str, source: SourceId, offset: usize) -> Item {
    let plain = Item { span: Span { source, start: offset, end: offset + text.len() }, value: Value::Text(text.trim().to_owned()) };
    if too_deep(text).is_some() {
        return plain;
    }
    let (value, errors) = DeValue::parse_recoverable(text);
    if !errors.is_empty() {
        return plain;
    }
    let mut diagnostics = Diagnostics::default();
    let mut item = Converter { source, diagnostics: &mut diagnostics }.item(value);
    if diagnostics.has_errors() {
        return plain;
    }
    shift(&mut item, offset);
    item
}

fn shift(item: &mut Item, offset: usize) {
    item.span.start += offset;
    item.span.end += offset;
    match &mut item.value {
        Value::List(items) => items.iter_mut().for_each(|i| shift(i, offset)),
        Value::Table(table) => {
            for entry in &mut table.entries {
                entry.key_span.start += offset;
                entry.key_span.end += offset;
                shift(&mut entry.item, offset);
            }
        }
        _ => {}
    }
}

/// Where brackets or dotted keys nest too deep. The parser recurses over dotted keys and its result is dropped recursively: a hostile
/// file must be stopped before.
fn too_deep(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut dots, mut at) = (0_usize, 0_usize, 0_usize);
    while at < bytes.len() {
        match bytes[at] {
            b'#' => {
                at += bytes[at..].iter().position(|b| *b == b'\n').unwrap_or(bytes.len() - at);
                dots = 0;
                continue;
            }
            quote @ (b'"' | b'\'') => {
                at = skip_string(bytes, at, quote);
                continue;
            }
            b'[' | b'{' => (depth, dots) = (depth + 1, 0),
            b']' | b'}' => (depth, dots) = (depth.saturating_sub(1), 0),
            b'\n' | b',' | b'=' => dots = 0,
            b'.' => dots += 1,
            _ => {}
        }
        if depth > DEEPEST || dots > DEEPEST {
            return Some(at);
        }
        at += 1;
    }
    None
}

/// First byte after the string that starts at `at`.
fn skip_string(bytes: &[u8], at: usize, quote: u8) -> usize {
    let long = bytes[at..].starts_with(&[quote; 3]);
    let width = if long { 3 } else { 1 };
    let mut i = at + width;
    while i < bytes.len() {
        match bytes[i] {
            b'\\' if quote == b'"' => i += 2,
            b'\n' if !long => return i,
            b if b == quote && (!long || bytes[i..].starts_with(&[quote; 3])) => return i + width,
            _ => i += 1,
        }
    }
    bytes.len()
}

struct Converter<'a> {
    source: SourceId,
    diagnostics: &'a mut Diagnostics,
}

impl Converter<'_> {
    fn span(&self, range: std::ops::Range<usize>) -> Span {
        Span { source: self.source, start: range.start, end: range.end }
    }

    fn table(&mut self, table: DeTable<'_>) -> Table {
        let mut entries: Vec<Entry> = table
            .into_iter()
            .map(|(key, value)| Entry { key_span: self.span(key.span()), key: key.into_inner().into_owned(), item: self.item(value) })
            .collect();
        // The parser sorts by name; people and messages follow the file.
        entries.sort_by_key(|e| e.key_span.start);
        Table { entries }
    }

    fn item(&mut self, value: Spanned<DeValue<'_>>) -> Item {
        let span = self.span(value.span());
        let value = match value.into_inner() {
            DeValue::String(text) => Value::Text(text.into_owned()),
            DeValue::Boolean(flag) => Value::Flag(flag),
            DeValue::Integer(digits) => {
                let value = i64::from_str_radix(digits.as_str(), digits.radix()).map(|i| i as f64);
                self.number(value.unwrap_or(f64::INFINITY), span)
            }
            DeValue::Float(digits) => self.number(digits.as_str().parse().unwrap_or(f64::NAN), span),
            DeValue::Datetime(_) => {
                self.diagnostics.push(
                    Diagnostic::error("E0206", span, "a date has no place in a project file")
                        .help("write it as a quoted text, or as a comment"),
                );
                Value::Flag(false)
            }
            DeValue::Array(items) => Value::List(items.into_iter().map(|i| self.item(i)).collect()),
            DeValue::Table(table) => Value::Table(self.table(table)),
        };
        Item { span, value }
    }

    fn number(&mut self, value: f64, span: Span) -> Value {
        if value.is_finite() {
            return Value::Number(value);
        }
        self.diagnostics.push(
            Diagnostic::error("E0205", span, "this number is not finite")
                .label("not a number that can be computed with")
                .help("write a finite number"),
        );
        // One error is enough: what reads the tree sees a harmless number.
        Value::Number(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use forcewright_base::diagnostics::Sources;

    fn read(text: &str) -> (Table, Diagnostics) {
        let mut diagnostics = Diagnostics::default();
        let source = Sources::default().add("t", text);
        (parse(text, source, &mut diagnostics), diagnostics)
    }

    fn text_at<'a>(table: &'a Table, path: &[&str]) -> Option<&'a str> {
        let (last, front) = path.split_last()?;
        let mut table = table;
        for key in front {
            let Value::Table(next) = &table.get(key)?.item.value else { return None };
            table = next;
        }
        match &table.get(last)?.item.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    #[test]
    fn child_wins_and_names_merge() {
        let (mut base, _) = read("[a]\nx = '1'\ny = '2'\n[[b]]\nname = 'p'\nv = '1'\n[[b]]\nname = 'q'\nv = '2'");
        let (over, _) = read("a.y = '3'\nb.q.v = '4'\n");
        base.overlay(over);
        assert_eq!(text_at(&base, &["a", "x"]), Some("1"));
        assert_eq!(text_at(&base, &["a", "y"]), Some("3"));
        let Value::List(list) = &base.get("b").unwrap().item.value else { panic!("a list") };
        let Value::Table(q) = &list[1].value else { panic!("a table") };
        assert_eq!((list.len(), text_at(q, &["v"])), (2, Some("4")));
    }

    #[test]
    fn deep_nesting_is_an_error_not_a_crash() {
        let deep = [
            format!("a = {}", "[".repeat(20_000)),
            format!("a = {}", "{b=".repeat(20_000)),
            format!("{}a = 1", "a.".repeat(20_000)),
            format!("[{}a]", "a . ".repeat(20_000)),
            format!("{}a = 1", "\"a\".".repeat(20_000)),
        ];
        for text in deep {
            assert!(read(&text).1.has_errors());
        }
        let points = format!("a = [{}]", "0.5, ".repeat(20_000));
        assert!(read(&points).1.is_empty());
        assert!(read("a = '[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[' # [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[").1.is_empty());
    }

    #[test]
    fn all_syntax_errors_and_the_rest_of_the_file() {
        let (table, diagnostics) = read("a = \nb = 'ok'\nc = = 2\nb = 'again'\n");
        assert!(diagnostics.in_file_order().len() >= 3);
        assert_eq!(text_at(&table, &["b"]), Some("ok"));
    }
}
