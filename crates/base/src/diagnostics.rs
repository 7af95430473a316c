//! Errors and warnings that point at their place: a code, the text concerned, what was expected, and a way out.

use std::fmt::Write as _;
use std::sync::Arc;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use crate::text::visible;

/// Index of a [`Source`] in its [`Sources`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct SourceId(u32);

/// A piece of text: which source, and the bytes `start..end` of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Span {
    /// The text it lies in.
    pub source: SourceId,
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

/// A text that was read: a file, or a command-line argument.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path as given, or the option's name.
    pub name: String,
    /// Its content.
    pub text: Arc<str>,
}

/// All texts that went into one project, in the order they were read.
#[derive(Clone, Debug, Default)]
pub struct Sources(Vec<Source>);

impl Sources {
    /// Adds a text and returns its number.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<str>>) -> SourceId {
        self.0.push(Source { name: name.into(), text: text.into() });
        SourceId(u32::try_from(self.0.len() - 1).unwrap_or(u32::MAX))
    }

    /// A text by its number.
    pub fn get(&self, id: SourceId) -> Option<&Source> {
        self.0.get(usize::try_from(id.0).ok()?)
    }

    /// All texts.
    pub fn iter(&self) -> impl Iterator<Item = &Source> {
        self.0.iter()
    }

    /// Line and column of a span's start, both counted from 1, columns in characters.
    pub fn line_column(&self, span: Span) -> Option<(usize, usize)> {
        let text = self.get(span.source)?.text.get(..span.start)?;
        let line_start = text.rfind('\n').map_or(0, |at| at + 1);
        Some((text.matches('\n').count() + 1, text[line_start..].chars().count() + 1))
    }
}

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The file cannot be used.
    Error,
    /// It can be used; something should be known.
    Warning,
}

/// The long story behind a code, for `explain` and the documentation.
#[derive(Clone, Copy, Debug)]
pub struct Explanation {
    /// The code: `E` and four digits, or a family's letters and three digits for a check.
    pub code: &'static str,
    /// One line.
    pub title: &'static str,
    /// What it means, why it matters, what to do; an example.
    pub text: &'static str,
}

/// One error or warning.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// Stable code; `explain` knows it.
    pub code: &'static str,
    /// Error or warning.
    pub severity: Severity,
    /// What is wrong, in one sentence.
    pub message: String,
    /// Where; `None` for a problem of the whole.
    pub span: Option<Span>,
    /// Said at the underlined text.
    pub label: String,
    /// The way out.
    pub help: Option<String>,
    /// Other places that matter, with what is said there.
    pub related: Vec<(Span, String)>,
    /// Whether a word means nothing: no change elsewhere makes it right.
    pub unknown_word: bool,
}

impl Diagnostic {
    /// An error at a place.
    pub fn error(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        let (message, label) = (message.into(), String::new());
        Self { code, severity: Severity::Error, message, span: Some(span), label, help: None, related: Vec::new(), unknown_word: false }
    }

    /// A warning at a place.
    pub fn warning(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, span, message) }
    }

    /// An error without a place in a text.
    pub fn placeless(code: &'static str, message: impl Into<String>) -> Self {
        Self { span: None, ..Self::error(code, Span::default(), message) }
    }

    /// Marks a word that means nothing: a slip, whatever else the file says.
    pub fn unknown_word(mut self) -> Self {
        self.unknown_word = true;
        self
    }

    /// Adds what is said at the underlined text.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Adds the way out.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds the way out, if there is one.
    pub fn help_opt(mut self, help: Option<String>) -> Self {
        self.help = help.or(self.help);
        self
    }

    /// Adds another place.
    pub fn related(mut self, span: Span, text: impl Into<String>) -> Self {
        self.related.push((span, text.into()));
        self
    }
}

/// Errors and warnings of one reading, collected and shown together.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
}

impl Diagnostics {
    /// Adds one.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.list.push(diagnostic);
    }

    /// Adds all of another.
    pub fn append(&mut self, mut other: Self) {
        self.list.append(&mut other.list);
    }

    /// Whether any of them is an error.
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|d| d.severity == Severity::Error)
    }

    /// Whether there is none at all.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// All, in the order of their places: first file first, top to bottom; those without a place come first.
    pub fn in_file_order(&self) -> Vec<&Diagnostic> {
        let mut all: Vec<_> = self.list.iter().collect();
        all.sort_by_key(|d| d.span);
        all
    }

    /// How many errors there are.
    pub fn errors(&self) -> usize {
        self.list.iter().filter(|d| d.severity == Severity::Error).count()
    }

    /// Only the warnings, in file order.
    pub fn warnings(&self) -> Vec<&Diagnostic> {
        self.in_file_order().into_iter().filter(|d| d.severity == Severity::Warning).collect()
    }

    /// Text for a terminal: every diagnostic with its lines of source, underlined; the first [`MOST_SHOWN`] of them.
    pub fn render(&self, sources: &Sources, colour: bool) -> String {
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        let mut out = String::new();
        for diagnostic in self.in_file_order().into_iter().take(MOST_SHOWN) {
            let _ = writeln!(out, "{}\n", render_one(diagnostic, sources, &renderer));
        }
        let rest = self.list.len().saturating_sub(MOST_SHOWN);
        if rest > 0 {
            let _ = writeln!(out, "… and {rest} more\n");
        }
        out
    }
}

/// Most diagnostics shown at once: a broken file may have a hundred thousand, and nobody reads more than this.
pub const MOST_SHOWN: usize = 100;

/// Longest source line shown whole; a longer one is cut around the place.
const LONGEST_LINE: usize = 200;

fn render_one(diagnostic: &Diagnostic, sources: &Sources, renderer: &Renderer) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    // Whatever was typed may contain characters that move the cursor or recolour the terminal.
    let message = visible(&diagnostic.message);
    let mut group = Group::with_title(level.primary_title(message).id(diagnostic.code));
    let excerpts: Vec<_> = diagnostic
        .span
        .map(|span| (span, diagnostic.label.as_str(), AnnotationKind::Primary))
        .into_iter()
        .chain(diagnostic.related.iter().map(|(span, text)| (*span, text.as_str(), AnnotationKind::Context)))
        .filter_map(|(span, label, kind)| Some((Excerpt::of(span, sources)?, label, kind)))
        .collect();
    for (excerpt, label, kind) in &excerpts {
        let annotation = kind.span(excerpt.start..excerpt.end);
        let annotation = if label.is_empty() { annotation } else { annotation.label(visible(label)) };
        let snippet = Snippet::source(excerpt.line.as_str()).line_start(excerpt.number).annotation(annotation);
        group = if excerpt.cut {
            // The column within the piece shown is not that of the line.
            group.element(Origin::path(visible(excerpt.name)).line(excerpt.number).char_column(excerpt.column)).element(snippet)
        } else {
            group.element(snippet.path(visible(excerpt.name)))
        };
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(visible(help)));
    }
    renderer.render(&[group])
}

/// The one line of source around a span: hostile files have lines of megabytes, and no message needs more than one.
struct Excerpt<'a> {
    name: &'a str,
    number: usize,
    /// Of the whole line, in characters, from 1.
    column: usize,
    /// Whether only a piece of the line is shown.
    cut: bool,
    line: String,
    start: usize,
    end: usize,
}

impl<'a> Excerpt<'a> {
    fn of(span: Span, sources: &'a Sources) -> Option<Self> {
        let source = sources.get(span.source)?;
        let text = source.text.as_ref();
        let start = floor_boundary(text, span.start);
        let end = floor_boundary(text, span.end).max(start);
        let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |at| start + at);
        // The other half of a line end.
        let line_end = if text[start..line_end].ends_with('\r') { line_end - 1 } else { line_end };
        let (from, to) = if line_end - line_start <= LONGEST_LINE {
            (line_start, line_end)
        } else {
            let from = floor_boundary(text, start.saturating_sub(LONGEST_LINE / 4)).max(line_start);
            (from, floor_boundary(text, (from + LONGEST_LINE).min(line_end)))
        };
        let keep = |at: usize| visible(&text[from..at.clamp(from, to)]).len();
        Some(Self {
            name: &source.name,
            number: text[..start].matches('\n').count() + 1,
            column: text[line_start..start].chars().count() + 1,
            cut: from > line_start,
            start: keep(start),
            end: keep(end),
            line: visible(&text[from..to]).into_owned(),
        })
    }
}

fn floor_boundary(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(text: &str, start: usize, end: usize) -> (Sources, Diagnostics) {
        let mut sources = Sources::default();
        let source = sources.add("a.toml", text);
        let mut all = Diagnostics::default();
        all.push(Diagnostic::error("E0201", Span { source, start, end }, "wrong").label("here").help("do that"));
        (sources, all)
    }

    #[test]
    fn points_at_line_and_column() {
        let (sources, all) = one("a = 1\nmaß = \"x\"\n", 13, 16);
        let shown = all.render(&sources, false);
        assert!(shown.contains("error[E0201]: wrong"), "{shown}");
        assert!(shown.contains("a.toml:2:7"), "{shown}");
        assert!(shown.contains("^^^ here"), "{shown}");
        assert!(shown.contains("help: do that"), "{shown}");
        assert_eq!(sources.line_column(Span { start: 13, end: 16, ..Span::default() }), Some((2, 7)));
    }

    #[test]
    fn hostile_places_are_shown_without_panic() {
        let long = format!("x = \"{}\"", "ä".repeat(100_000));
        for (text, start, end) in
            [("", 0, 0), ("abc", 99, 200), ("a\u{7}b\r\n", 1, 4), ("a\nb\n", 0, 4), ("ß", 1, 1), (long.as_str(), 50_000, 50_400)]
        {
            let (sources, all) = one(text, start, end);
            let shown = all.render(&sources, false);
            assert!(shown.contains("E0201") && shown.len() < 3000, "{shown}");
        }
    }

    #[test]
    fn the_place_is_that_of_the_file_even_where_the_line_is_cut_or_ends_in_two_characters() {
        let long = format!("a = 1\n{} = 2\n", "ä".repeat(5000));
        let (sources, all) = one(&long, 6 + 2 * 3000, 6 + 2 * 3001);
        let shown = all.render(&sources, false);
        assert!(shown.contains("--> a.toml:2:3001"), "{shown}");
        let (sources, all) = one("a = 1\r\nb = 2\r\n", 7, 8);
        let shown = all.render(&sources, false);
        assert!(shown.contains("a.toml:2:1") && shown.contains("| b = 2\n") && shown.contains("| ^ here"), "{shown}");
    }

    #[test]
    fn nothing_typed_reaches_the_terminal_raw() {
        let evil = "\u{1b}[31m\u{9b}31m\u{7}\r\u{202e}";
        let mut sources = Sources::default();
        let source = sources.add(evil, evil);
        let span = Span { source, start: 0, end: evil.len() };
        let mut all = Diagnostics::default();
        all.push(Diagnostic::error("E0201", span, evil).label(evil).help(evil).related(span, evil));
        let shown = all.render(&sources, false);
        assert!(shown.chars().all(|c| c == '\n' || !(c.is_control() || c == '\u{202e}')), "{shown:?}");
    }

    #[test]
    fn a_hundred_thousand_errors_are_counted_not_shown() {
        let text = "=\n".repeat(100_000);
        let mut sources = Sources::default();
        let source = sources.add("a.toml", text.as_str());
        let mut all = Diagnostics::default();
        for line in 0..100_000 {
            all.push(Diagnostic::error("E0105", Span { source, start: 2 * line, end: 2 * line + 1 }, "no"));
        }
        let shown = all.render(&sources, false);
        assert_eq!(shown.matches("error[").count(), MOST_SHOWN);
        assert!(shown.ends_with("… and 99900 more\n\n"), "{}", &shown[shown.len() - 60..]);
    }

    #[test]
    fn order_is_that_of_the_file() {
        let mut all = Diagnostics::default();
        for start in [9, 3, 7] {
            all.push(Diagnostic::error("E0201", Span { start, end: start, ..Span::default() }, start.to_string()));
        }
        all.push(Diagnostic::placeless("E0101", "whole"));
        let order: Vec<_> = all.in_file_order().iter().map(|d| d.message.clone()).collect();
        assert_eq!(order, ["whole", "3", "7", "9"]);
    }
}
