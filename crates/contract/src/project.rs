//! Reading a project: the file, what it extends, the chosen variant, the settings of the command line, the files that it names; one
//! tree comes out.

use std::collections::BTreeMap;
use std::fs;
use std::io::{ErrorKind, Read};
use std::path::{Component, Path, PathBuf};

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, SourceId, Sources, Span};
use forcewright_base::text::closest;

use crate::data::{Content, DataFile, names_a_file};
use crate::tree::{self, Entry, Item, Table, Value};

/// Largest file accepted. Real project files have a few kilobytes.
const LARGEST_BYTES: u64 = 1024 * 1024;
/// Longest chain of `extends`.
const LONGEST_CHAIN: usize = 16;
/// Most files of data that a project names.
const MOST_FILES: usize = 64;

/// Why a file could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileError {
    /// There is none.
    NotFound,
    /// It is a directory, a device or a pipe.
    NotAFile,
    /// More bytes than accepted.
    TooLarge(u64),
    /// Not UTF-8; the field is the number of good bytes before the first bad one.
    NotUtf8(usize),
    /// The system's words.
    Unreadable(String),
}

impl FileError {
    /// Whether there is nothing to read at all, as opposed to something that is not understood.
    fn is_missing(&self) -> bool {
        matches!(self, Self::NotFound | Self::NotAFile | Self::Unreadable(_))
    }

    /// Code and message for a file.
    pub(crate) fn refusal(&self, shown: &str) -> (&'static str, String) {
        match self {
            Self::NotFound => ("E0101", format!("`{shown}` does not exist")),
            Self::NotAFile => ("E0104", format!("`{shown}` is not a file")),
            Self::Unreadable(why) => ("E0101", format!("`{shown}` cannot be read: {why}")),
            Self::TooLarge(bytes) => ("E0103", format!("`{shown}` has {bytes} bytes; at most {LARGEST_BYTES} are accepted")),
            Self::NotUtf8(good) => ("E0102", format!("`{shown}` is not UTF-8 text: byte {} is not", good + 1)),
        }
    }
}

/// Where files come from: the disk, or memory in tests and for the gallery.
pub trait Files {
    /// The text of a file.
    ///
    /// # Errors
    /// [`FileError`] says why there is none.
    fn read(&self, path: &Path) -> Result<String, FileError>;
}

/// Files of the machine.
pub struct DiskFiles;

impl Files for DiskFiles {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        let describe = |e: std::io::Error| match e.kind() {
            ErrorKind::NotFound => FileError::NotFound,
            ErrorKind::IsADirectory => FileError::NotAFile,
            _ => FileError::Unreadable(e.to_string()),
        };
        // A pipe or device is refused before it is opened: opening it could wait for ever.
        let metadata = fs::metadata(path).map_err(describe)?;
        if !metadata.is_file() {
            return Err(FileError::NotAFile);
        }
        if metadata.len() > LARGEST_BYTES {
            return Err(FileError::TooLarge(metadata.len()));
        }
        let mut bytes = Vec::new();
        fs::File::open(path).and_then(|f| f.take(LARGEST_BYTES + 1).read_to_end(&mut bytes)).map_err(describe)?;
        let length = bytes.len() as u64;
        if length > LARGEST_BYTES {
            return Err(FileError::TooLarge(length));
        }
        String::from_utf8(bytes).map_err(|e| FileError::NotUtf8(e.utf8_error().valid_up_to()))
    }
}

/// What the caller chose.
#[derive(Clone, Debug, Default)]
pub struct Choices {
    /// A variant of the file.
    pub variant: Option<String>,
    /// Settings `KEY=VALUE`, in order.
    pub set: Vec<String>,
}

/// A project, read and merged, not yet understood.
#[derive(Clone, Debug)]
pub struct Project {
    /// Every text that was read, in order: the file first.
    pub sources: Sources,
    /// The merged tree, without `extends` and `variants`.
    pub tree: Table,
    /// The start of the project file: where what is missing as a whole is reported.
    pub root: Span,
    /// Names of the variants, in the order of the file.
    pub variants: Vec<String>,
    /// What the caller chose.
    pub choices: Choices,
    /// Everything found wrong so far.
    pub diagnostics: Diagnostics,
    /// Whether a file could not be read at all, as opposed to not understood.
    pub file_missing: bool,
}

impl Project {
    /// Reads a project file with everything that belongs to it. Whatever is wrong is in `diagnostics`.
    pub fn load(files: &dyn Files, path: &Path, choices: &Choices) -> Self {
        let mut loader = Loader {
            files,
            sources: Sources::default(),
            diagnostics: Diagnostics::default(),
            chain: Vec::new(),
            folders: Vec::new(),
            data: BTreeMap::new(),
            file_missing: false,
        };
        let mut tree = loader.file(path, None);
        let root_span = Span::default();
        let variants = loader.variants(&mut tree, choices);
        loader.misplaced(&mut tree, "a variant");
        for setting in &choices.set {
            loader.set(&mut tree, setting);
        }
        loader.misplaced(&mut tree, "`--set`");
        loader.mechanism(&tree);
        loader.read_data(&mut tree);
        Self {
            sources: loader.sources,
            tree,
            root: root_span,
            variants,
            choices: choices.clone(),
            diagnostics: loader.diagnostics,
            file_missing: loader.file_missing,
        }
    }

    /// Reads a project from memory: no file is opened, `extends` finds nothing.
    pub fn from_text(name: &str, text: &str, choices: &Choices) -> Self {
        Self::load(&OneText { name, text }, Path::new(name), choices)
    }

    /// The family asked for, with its place.
    pub fn mechanism(&self) -> Option<(&str, Span)> {
        match &self.tree.get("mechanism")?.item {
            Item { value: Value::Text(id), span } => Some((id, *span)),
            _ => None,
        }
    }
}

struct OneText<'a> {
    name: &'a str,
    text: &'a str,
}

impl Files for OneText<'_> {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        if path == Path::new(self.name) { Ok(self.text.to_owned()) } else { Err(FileError::NotFound) }
    }
}

struct Loader<'a> {
    files: &'a dyn Files,
    sources: Sources,
    diagnostics: Diagnostics,
    chain: Vec<PathBuf>,
    /// The folder of each project file read, the first one's first.
    folders: Vec<(SourceId, PathBuf)>,
    /// Files of data by their paths.
    data: BTreeMap<PathBuf, Result<Content, FileError>>,
    file_missing: bool,
}

impl Loader<'_> {
    /// A file and, below it, what it extends. `from` is the place that names it.
    fn file(&mut self, path: &Path, from: Option<Span>) -> Table {
        let shown = path.display().to_string();
        let plain = normalise(path);
        if self.chain.contains(&plain) {
            let span = from.unwrap_or_default();
            self.diagnostics.push(
                Diagnostic::error("E0108", span, format!("`{shown}` extends itself"))
                    .label("leads back here")
                    .help("remove one `extends` of the circle"),
            );
            return Table::default();
        }
        if self.chain.len() >= LONGEST_CHAIN {
            let span = from.unwrap_or_default();
            self.diagnostics.push(
                Diagnostic::error("E0108", span, format!("more than {LONGEST_CHAIN} files extend one another"))
                    .help("join some of the files"),
            );
            return Table::default();
        }
        let text = match self.files.read(path) {
            Ok(text) => text,
            Err(error) => {
                self.unreadable(&shown, &error, from);
                return Table::default();
            }
        };
        let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
        let source = self.sources.add(shown, text.as_str());
        self.folders.push((source, path.parent().unwrap_or(Path::new("")).to_owned()));
        let mut tree = tree::parse(&text, source, &mut self.diagnostics);
        let Some(Entry { item, .. }) = tree.take("extends") else { return tree };
        let Item { value: Value::Text(base), span } = item else {
            self.diagnostics.push(
                Diagnostic::error("E0206", item.span, "`extends` is the path of a file").help("write it as `extends = \"base.toml\"`"),
            );
            return tree;
        };
        self.chain.push(plain);
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut merged = self.file(&folder.join(base), Some(span));
        self.chain.pop();
        self.diagnostics.append(merged.overlay(tree));
        merged
    }

    /// Reads the files that keys name, each beside the project file that names it; one that a setting names, beside the first.
    fn read_data(&mut self, table: &mut Table) {
        for Entry { key, item, .. } in &mut table.entries {
            match &mut item.value {
                Value::Text(path) if names_a_file(key) => {
                    let own = self.folders.iter().find(|(source, _)| *source == item.span.source).or(self.folders.first());
                    let beside = own.map_or_else(PathBuf::new, |(_, folder)| folder.clone()).join(&*path);
                    item.value = Value::File(DataFile { path: std::mem::take(path), content: self.content(&beside) });
                }
                Value::Table(inner) => self.read_data(inner),
                Value::List(items) => items.iter_mut().for_each(|item| {
                    if let Value::Table(inner) = &mut item.value {
                        self.read_data(inner);
                    }
                }),
                _ => {}
            }
        }
    }

    fn content(&mut self, path: &Path) -> Result<Content, FileError> {
        if let Some(known) = self.data.get(path) {
            return known.clone();
        }
        if self.data.len() >= MOST_FILES {
            return Err(FileError::Unreadable(format!("the project names more than {MOST_FILES} files")));
        }
        let content = self.files.read(path).map(|text| {
            let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
            let source = self.sources.add(path.display().to_string(), text);
            Content { source, text: text.into() }
        });
        self.data.insert(path.to_owned(), content.clone());
        content
    }

    fn unreadable(&mut self, shown: &str, error: &FileError, from: Option<Span>) {
        let (code, message) = error.refusal(shown);
        let help = match error {
            FileError::NotFound => "check the path; `forcewright new --list` names examples to start from",
            FileError::NotAFile => "name a project file, such as `design.toml`",
            FileError::Unreadable(_) => "check that it is readable for you",
            FileError::TooLarge(_) => "a project file has a few kilobytes; measured data belongs into CSV files",
            FileError::NotUtf8(_) => "save it as UTF-8",
        };
        self.file_missing |= error.is_missing();
        let diagnostic = match from {
            Some(span) => Diagnostic::error(code, span, message).label("named here"),
            None => Diagnostic::placeless(code, message),
        };
        self.diagnostics.push(diagnostic.help(help));
    }

    fn variants(&mut self, tree: &mut Table, choices: &Choices) -> Vec<String> {
        let all = match tree.take("variants") {
            None => Table::default(),
            Some(Entry { item: Item { value: Value::Table(table), .. }, .. }) => table,
            Some(entry) => {
                self.diagnostics.push(
                    Diagnostic::error("E0206", entry.item.span, "`variants` is a table with a table per variant")
                        .help("write `[variants.thin]` and below it the differences"),
                );
                Table::default()
            }
        };
        let names: Vec<String> = all.entries.iter().map(|e| e.key.clone()).collect();
        for entry in all.entries {
            if choices.variant.as_deref() != Some(entry.key.as_str()) {
                continue;
            }
            self.sources.add("--variant", entry.key.as_str());
            match entry.item.value {
                Value::Table(table) => self.diagnostics.append(tree.overlay(table)),
                _ => self.diagnostics.push(
                    Diagnostic::error("E0206", entry.item.span, "a variant is a table")
                        .help("write the differences as keys, such as `design.thickness = \"0.85 mm\"`"),
                ),
            }
        }
        if let Some(wanted) = choices.variant.as_ref().filter(|w| !names.contains(w)) {
            let source = self.sources.add("--variant", wanted.as_str());
            let span = Span { source, start: 0, end: wanted.len() };
            let help = match closest(wanted, names.iter().map(String::as_str)) {
                Some(near) => format!("did you mean `{near}`?"),
                None if names.is_empty() => "the file has no variants".to_owned(),
                None => format!("the file has {}", names.join(", ")),
            };
            self.diagnostics.push(Diagnostic::error("E0110", span, "no such variant").help(help));
        }
        names
    }

    fn set(&mut self, tree: &mut Table, setting: &str) {
        let source = self.sources.add("--set", setting);
        let whole = Span { source, start: 0, end: setting.len() };
        let refuse = |message: &str| {
            Diagnostic::error("E0111", whole, message)
                .help("write `--set design.thickness=\"0.9 mm\"`, members by name: `design.beams.b1.bend=[1.2, -1.5]`, single numbers by place: `design.nodes.n3.at.x=\"30 mm\"`")
        };
        let Some((key, value)) = setting.split_once('=') else {
            return self.diagnostics.push(refuse("a setting is KEY=VALUE"));
        };
        let parts: Vec<&str> = key.split('.').collect();
        if parts.len() > 16 || parts.iter().any(|p| p.trim().is_empty()) {
            return self.diagnostics.push(refuse("a setting's key is a dotted path"));
        }
        let item = tree::parse_value(value, source, key.len() + 1, &mut self.diagnostics);
        let astray = tree.overlay(nest(&parts, source, item));
        self.diagnostics.append(astray);
    }

    /// The family must be known before anything else is read, so its key is checked here.
    fn mechanism(&mut self, tree: &Table) {
        if let Some(entry) = tree.get("mechanism").filter(|e| !matches!(e.item.value, Value::Text(_) | Value::Refused)) {
            self.diagnostics.push(
                Diagnostic::error("E0206", entry.item.span, format!("expected a text, found {}", entry.item.value.kind()))
                    .label("expected a text")
                    .help("write it as a text in quotes, such as `mechanism = \"compliant\"`"),
            );
        }
    }

    /// What is read before variants and settings are laid over the file cannot be changed by them.
    fn misplaced(&mut self, tree: &mut Table, what: &str) {
        for key in ["extends", "variants"] {
            if let Some(entry) = tree.take(key) {
                self.diagnostics.push(
                    Diagnostic::error("E0301", entry.key_span, format!("{what} cannot change `{key}`"))
                        .label("not known here")
                        .help(format!("`{key}` stands at the top of a project file, which is read before variants and settings")),
                );
            }
        }
    }
}

/// `a.b.c = item` as a tree; every key is placed on its part of the path, without the blanks around it.
fn nest(parts: &[&str], source: SourceId, item: Item) -> Table {
    let mut at = parts.iter().map(|p| p.len() + 1).sum::<usize>();
    let mut item = item;
    for part in parts.iter().rev() {
        at -= part.len() + 1;
        let key = part.trim();
        let start = at + (part.len() - part.trim_start().len());
        let key_span = Span { source, start, end: start + key.len() };
        let entry = Entry { key: key.to_owned(), key_span, item };
        item = Item { span: key_span, value: Value::Table(Table { entries: vec![entry] }) };
    }
    match item.value {
        Value::Table(table) => table,
        _ => Table::default(),
    }
}

/// The path without `.` and, where possible, without `..`, so that two spellings of a file are one.
fn normalise(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if plain.file_name().is_some() => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}
