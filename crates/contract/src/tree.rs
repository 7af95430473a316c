//! The project file as a tree of values, each with its place. Merging (`extends`, `variants`, `--set`) happens here, before anything
//! is understood, and keeps the places, so that an error points at the text that caused it wherever that text stands.

use std::collections::BTreeMap;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, SourceId, Span};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::data::DataFile;

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
    /// The path of a file, as the keys say that name one; it has been read.
    File(DataFile),
    /// Something that has been reported already: a date, a number that is not finite. Whoever reads it says nothing more.
    Refused,
}

impl Value {
    /// The kind of value, with its article, for messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Text(_) | Self::File(_) => "a text",
            Self::Number(_) => "a bare number",
            Self::Flag(_) => "true or false",
            Self::List(_) => "a list",
            Self::Table(_) => "a table",
            Self::Refused => "a value that cannot be used",
        }
    }

    /// Whether it, or a member of it, has been reported already.
    pub fn is_refused(&self) -> bool {
        match self {
            Self::Refused => true,
            Self::List(items) => items.iter().any(|i| i.value.is_refused()),
            _ => false,
        }
    }
}

impl std::fmt::Display for Value {
    /// As it would be written in a file.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let list = |items: Vec<String>| items.join(", ");
        match self {
            Self::Text(text) | Self::File(DataFile { path: text, .. }) => write!(f, "\"{text}\""),
            Self::Number(number) => number.fmt(f),
            Self::Flag(flag) => flag.fmt(f),
            Self::List(items) => write!(f, "[{}]", list(items.iter().map(|i| i.value.to_string()).collect())),
            Self::Table(table) => {
                let entries = table.entries.iter().map(|e| format!("{} = {}", e.key, e.item.value));
                write!(f, "{{ {} }}", list(entries.collect()))
            }
            Self::Refused => f.write_str("?"),
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

    /// Lays another table over this one: tables merge key by key, lists of named tables merge name by name, others by place, everything else is
    /// replaced. The other wins. A single entry of a list is reached by its place, counted from 1, or by `x` and `y` in a pair:
    /// `bend.2`, `at.x`. Returned is what names a place that its list does not have; the list is left as it was.
    ///
    /// A goal to `minimise` takes the place of one to `maximise`, and the other way round.
    pub fn overlay(&mut self, other: Self) -> Diagnostics {
        if let Some(turned) = other.entries.iter().find_map(|e| opposite(&e.key).filter(|_| matches!(e.item.value, Value::Text(_))))
            && other.get(turned).is_none()
        {
            self.entries.retain(|e| e.key != turned || !matches!(e.item.value, Value::Text(_)));
        }
        // Searched by an index: files of a hundred thousand keys are hostile, but must not take for ever.
        let places: BTreeMap<String, usize> = self.entries.iter().enumerate().map(|(at, e)| (e.key.clone(), at)).collect();
        let mut astray = Diagnostics::default();
        for entry in other.entries {
            match places.get(&entry.key).and_then(|at| self.entries.get_mut(*at)) {
                None => self.entries.push(entry),
                Some(mine) => astray.append(merge(mine, entry)),
            }
        }
        astray
    }
}

/// What a goal excludes.
pub(crate) fn opposite(key: &str) -> Option<&'static str> {
    match key {
        "minimise" => Some("maximise"),
        "maximise" => Some("minimise"),
        _ => None,
    }
}

/// Where each name of a list of named tables stands; the first of two equal ones.
fn places_of(list: &[Item]) -> BTreeMap<String, usize> {
    list.iter().enumerate().rev().filter_map(|(at, item)| Some((name_of(item)?.to_owned(), at))).collect()
}

fn merge(mine: &mut Entry, theirs: Entry) -> Diagnostics {
    let mut astray = Diagnostics::default();
    let replaced = match (&mut mine.item.value, theirs.item.value) {
        (Value::Table(base), Value::Table(over)) => return base.overlay(over),
        (Value::List(base), Value::List(over)) if named(base) && named(&over) => {
            let places = places_of(base);
            for item in over {
                let at = name_of(&item).and_then(|name| places.get(name)).copied();
                match (at, item) {
                    (Some(at), Item { value: Value::Table(table), .. }) => astray.append(overlay_item(&mut base[at], table)),
                    (_, item) => base.push(item),
                }
            }
            return astray;
        }
        // `design.beams.b1.bend = …` in a variant or on the command line: members of a list by name.
        (Value::List(base), Value::Table(over)) if named(base) => {
            let places = places_of(base);
            let mut strangers = Table::default();
            for entry in over.entries {
                match (places.get(&entry.key), entry.item.value) {
                    (Some(at), Value::Table(table)) => astray.append(overlay_item(&mut base[*at], table)),
                    (_, value) => strangers.entries.push(Entry { item: Item { value, ..entry.item }, ..entry }),
                }
            }
            // A name that the list does not have becomes a new member: the reader says what it lacks, at this place.
            base.extend(strangers.entries.into_iter().map(|entry| match entry.item.value {
                Value::Table(mut table) => {
                    let name = Item { span: entry.key_span, value: Value::Text(entry.key) };
                    table.entries.insert(0, Entry { key: "name".to_owned(), key_span: entry.key_span, item: name });
                    Item { span: entry.key_span, value: Value::Table(table) }
                }
                other => Item { span: entry.item.span, value: other },
            }));
            return astray;
        }
        // `load.2.travel = …`: members without names by their place.
        (Value::List(base), Value::Table(over)) if numbered(base) => {
            let mut strangers = Table::default();
            for entry in over.entries {
                let at = entry.key.parse::<usize>().ok().and_then(|n| n.checked_sub(1)).filter(|at| *at < base.len());
                match (at, entry.item.value) {
                    (Some(at), Value::Table(table)) => astray.append(overlay_item(&mut base[at], table)),
                    (_, value) => strangers.entries.push(Entry { item: Item { value, ..entry.item }, ..entry }),
                }
            }
            // What has no place in the list becomes a new member: the reader says what it lacks, at this place.
            if let Some(first) = strangers.entries.first() {
                base.push(Item { span: first.key_span, value: Value::Table(strangers) });
            }
            return astray;
        }
        // `bend.2 = …`, `at.x = …`: entries of a list of values by their place.
        (Value::List(base), Value::Table(over)) if !named(base) => {
            for entry in over.entries {
                match place_in(base, &entry.key).and_then(|at| base.get_mut(at)) {
                    Some(item) => {
                        let mut mine = Entry { item: item.clone(), ..entry.clone() };
                        astray.append(merge(&mut mine, entry));
                        *item = mine.item;
                    }
                    None => astray.push(no_place(&mine.key, base, &entry)),
                }
            }
            return astray;
        }
        (_, other) => other,
    };
    mine.key_span = theirs.key_span;
    mine.item = Item { span: theirs.item.span, value: replaced };
    astray
}

fn overlay_item(item: &mut Item, over: Table) -> Diagnostics {
    match &mut item.value {
        Value::Table(table) => table.overlay(over),
        _ => Diagnostics::default(),
    }
}

/// Where a key points in a list of values: `1` is the first; a pair also has `x` and `y`.
fn place_in(list: &[Item], key: &str) -> Option<usize> {
    match (key, list.len()) {
        ("x", 2) => Some(0),
        ("y", 2) => Some(1),
        _ => key.parse::<usize>().ok()?.checked_sub(1).filter(|at| *at < list.len()),
    }
}

fn no_place(name: &str, list: &[Item], entry: &Entry) -> Diagnostic {
    let places = match list.len() {
        0 => "has no entries".to_owned(),
        1 => "has one entry, `1`".to_owned(),
        2 => "has the entries `1` and `2`, or `x` and `y`".to_owned(),
        n => format!("has the entries `1` to `{n}`"),
    };
    let key: String = entry.key.chars().take(60).collect();
    let name: String = name.chars().take(60).collect();
    Diagnostic::error("E0304", entry.key_span, format!("the list `{name}` has no entry `{key}`"))
        .label("not there")
        .help(format!("`{name}` {places}; give the whole list to make it longer"))
}

fn named(list: &[Item]) -> bool {
    !list.is_empty() && list.iter().all(|item| name_of(item).is_some())
}

fn numbered(list: &[Item]) -> bool {
    !list.is_empty() && list.iter().all(|item| matches!(item.value, Value::Table(_)) && name_of(item).is_none())
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
    if errors.iter().any(|e| e.message().contains("duplicate key"))
        && let Some((start, header)) = repeated_header(text)
    {
        // Everything below the second header would be reported as given twice: one error says it all.
        let span = Span { source, start, end: start + header.len() + 2 };
        diagnostics.push(
            Diagnostic::error("E0106", span, format!("the table `[{header}]` is given twice"))
                .label("second time")
                .help(format!("for a list of tables write double brackets, `[[{header}]]`, with a `name` in each; otherwise join the two")),
        );
        return Table::default();
    }
    report(text, &errors, Span { source, ..Span::default() }, diagnostics);
    let mut converter = Converter { source, offset: 0, diagnostics };
    converter.table(document.into_inner())
}

/// The first table header that stands for the second time, and where.
fn repeated_header(text: &str) -> Option<(usize, &str)> {
    let mut seen: Vec<&str> = Vec::new();
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let indent = line.len() - line.trim_start().len();
        let header = line.trim_start().strip_prefix('[').filter(|h| !h.starts_with('[')).and_then(|h| h.split_once(']'));
        if let Some((header, _)) = header {
            if seen.contains(&header) {
                return Some((at + indent, header));
            }
            // A file of nothing but headers is hostile, and needs no help with its brackets.
            if seen.len() < 200 {
                seen.push(header);
            }
        }
        at += line.len();
    }
    None
}

/// Reports what the parser found wrong with a text that starts at `base`, one syntax error per line: the parser stumbles several
/// times over the same mistake.
fn report(text: &str, errors: &[toml::de::Error], base: Span, diagnostics: &mut Diagnostics) {
    let mut last_line_end = None;
    for error in errors {
        let range = error.span().unwrap_or(0..0);
        let start = range.start.min(text.len());
        let span = Span { source: base.source, start: base.start + start, end: base.start + range.end.max(start + 1) };
        if error.message().contains("duplicate key") {
            diagnostics.push(
                Diagnostic::error("E0106", span, "this key is given twice")
                    .label("second time")
                    .help("keep one of the two, or remove both"),
            );
            continue;
        }
        let line_end = text.as_bytes()[start..].iter().position(|b| *b == b'\n').map_or(text.len(), |at| start + at);
        if last_line_end.replace(line_end) != Some(line_end) {
            let typed = text.get(start..range.end).unwrap_or("").trim();
            let help = if error.message().contains("must be quoted") && typed.len() <= 60 {
                format!("write it in quotes: \"{typed}\"")
            } else {
                "values with units are quoted texts (`thickness = \"1 mm\"`), tables start with `[name]`, comments with `#`".to_owned()
            };
            diagnostics.push(Diagnostic::error("E0105", span, format!("not valid TOML: {}", error.message())).help(help));
        }
    }
}

/// Reads the value given with `--set KEY=VALUE`: TOML if it is TOML, otherwise a text, so that a shell's lost quotes do no harm. A list
/// or a table must be TOML: what is wrong with it is reported.
pub fn parse_value(text: &str, source: SourceId, offset: usize, diagnostics: &mut Diagnostics) -> Item {
    let trimmed = text.trim();
    let start = offset + (text.len() - text.trim_start().len());
    let span = Span { source, start, end: start + trimmed.len() };
    let plain = Item { span, value: Value::Text(trimmed.to_owned()) };
    let nested = trimmed.starts_with(['[', '{']);
    if let Some(at) = too_deep(trimmed) {
        if nested {
            let at = Span { source, start: start + at, end: start + at + 1 };
            diagnostics
                .push(Diagnostic::error("E0107", at, format!("nested deeper than {DEEPEST} levels")).help("look for an unclosed bracket"));
            return Item { span, value: Value::Refused };
        }
        return plain;
    }
    let (value, errors) = DeValue::parse_recoverable(trimmed);
    if !errors.is_empty() {
        if nested {
            report(trimmed, &errors, span, diagnostics);
            return Item { span, value: Value::Refused };
        }
        return plain;
    }
    let mut found = Diagnostics::default();
    let mut item = Converter { source, offset: start, diagnostics: &mut found }.item(value);
    if found.has_errors() && !nested {
        return plain;
    }
    diagnostics.append(found);
    item.span = span;
    item
}

/// Where brackets or dotted keys nest too deep. The parser recurses over both and its result is dropped recursively: a hostile file
/// must be stopped before. Texts, comments and bare words are skipped exactly as the parser's lexer skips them, so that nothing hides.
fn too_deep(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut dots, mut at) = (0_usize, 0_usize, 0_usize);
    while at < bytes.len() {
        let next = match bytes[at] {
            b'#' => until(bytes, at, b"\r\n"),
            quote @ (b'"' | b'\'') => skip_string(bytes, at, quote),
            b'.' | b'=' | b',' | b'[' | b']' | b'{' | b'}' | b' ' | b'\t' | b'\r' | b'\n' => at + 1,
            // A quote inside a bare word does not start a text.
            _ => until(bytes, at, b".=,[]{} \t#\r\n"),
        };
        match bytes[at] {
            b'[' | b'{' => (depth, dots) = (depth + 1, 0),
            b']' | b'}' => (depth, dots) = (depth.saturating_sub(1), 0),
            b'\n' | b'\r' | b',' | b'=' => dots = 0,
            b'.' => dots += 1,
            _ => {}
        }
        if depth > DEEPEST || dots > DEEPEST {
            return Some(at);
        }
        at = next;
    }
    None
}

/// The first of some bytes at or after `from`, else the end.
fn until(bytes: &[u8], from: usize, stops: &[u8]) -> usize {
    bytes[from..].iter().position(|b| stops.contains(b)).map_or(bytes.len(), |at| from + at)
}

/// First byte after the text in quotes that starts at `at`.
fn skip_string(bytes: &[u8], at: usize, quote: u8) -> usize {
    let long = bytes[at..].starts_with(&[quote; 3]);
    let mut i = at + if long { 3 } else { 1 };
    while i < bytes.len() {
        match bytes[i] {
            // Of what is escaped only these two matter here: an escaped line end still ends a short text.
            b'\\' if quote == b'"' => i += if matches!(bytes.get(i + 1), Some(b'\\' | b'"')) { 2 } else { 1 },
            b'\n' if !long => return i,
            b if b == quote && !long => return i + 1,
            // Up to two more quotes belong to the text that ends here.
            _ if long && bytes[i..].starts_with(&[quote; 3]) => {
                return i + 3 + bytes[i + 3..].iter().take(2).take_while(|b| **b == quote).count();
            }
            _ => i += 1,
        }
    }
    bytes.len()
}

struct Converter<'a> {
    source: SourceId,
    /// Where the text that was parsed starts in the source.
    offset: usize,
    diagnostics: &'a mut Diagnostics,
}

impl Converter<'_> {
    fn span(&self, range: std::ops::Range<usize>) -> Span {
        Span { source: self.source, start: self.offset + range.start, end: self.offset + range.end }
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
                Value::Refused
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
        Value::Refused
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
        assert!(base.overlay(over).is_empty());
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
            // Hidden behind texts whose end is easily misjudged.
            format!("a = \"\\\n{}a = 1", "a.".repeat(20_000)),
            format!("a = {{ x = \"\"\"a\"\"\"\", {}a = 1 }}", "a.".repeat(20_000)),
            format!("a = x\" {}", "[".repeat(20_000)),
            format!("# a\r{}a = 1", "a.".repeat(20_000)),
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

    #[test]
    fn a_list_with_single_brackets_is_one_error() {
        let (_, diagnostics) =
            read("[design]\na = 1\n[design.beams]\nname = 'b1'\n[design.beams]\nname = 'b2'\n[design.beams]\nname = 'b3'\n");
        let all = diagnostics.in_file_order();
        assert_eq!((all.len(), all[0].code), (1, "E0106"));
        assert!(all[0].help.as_deref().is_some_and(|h| h.contains("[[design.beams]]")));
    }
}
