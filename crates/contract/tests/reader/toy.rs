//! A small family for the tests of the reader: every kind of parameter once, files in memory, diagnostics as lines of text.

use std::collections::BTreeMap;
use std::path::Path;

use forcewright_base::diagnostics::{Diagnostics, Severity, Sources};
use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::data::DataFile;
use forcewright_contract::describe::{Along, Describe, Form, Located, Member, Param, Reserved, Section, Slot, Visitor, Word};
use forcewright_contract::header::Header;
use forcewright_contract::numbers::{Number, numbers_of};
use forcewright_contract::project::{Choices, FileError, Files, Project};
use forcewright_contract::studies::Studies;
use forcewright_contract::{paths, read};

/// The whole file.
#[derive(Default)]
pub(crate) struct Toy {
    header: Header,
    pub(crate) design: Section<Design>,
    pub(crate) load: Vec<Member<Load>>,
    pub(crate) studies: Studies,
}

/// A member written as the only table, or in a list one after the other.
#[derive(Default)]
pub(crate) struct Load {
    travel: Slot<Quantity>,
}

/// `[design]`
#[derive(Default)]
pub(crate) struct Design {
    pub(crate) thickness: Slot<Quantity>,
    pub(crate) depth: Slot<Quantity>,
    friction: Slot<Quantity>,
    force: Slot<Quantity>,
    copies: Slot<u32>,
    width: Slot<Along>,
    pub(crate) measured_file: Slot<DataFile>,
    nodes: Vec<Member<Node>>,
    beams: Vec<Member<Beam>>,
}

/// A member written as a key of a table.
#[derive(Default)]
pub(crate) struct Node {
    at: Slot<[Quantity; 2]>,
    support: Slot<&'static str>,
    direction: Slot<[f64; 2]>,
    through: Slot<Vec<Located<[Quantity; 2]>>>,
}

/// A member written in a list.
#[derive(Default)]
pub(crate) struct Beam {
    between: Slot<Vec<Located<String>>>,
    bend: Slot<Vec<f64>>,
    straight: Slot<bool>,
    thickness: Slot<Quantity>,
    pin: Slot<Quantity>,
}

const SUPPORTS: &[Word] = &[Word { word: "clamped", doc: "held" }, Word { word: "pinned", doc: "turns" }];
const RESERVED: &[Reserved] = &[
    Reserved { key: "environment", instead: "a study reads it", ignored: true },
    Reserved { key: "errors", instead: "change the parameter", ignored: false },
];

impl Describe for Toy {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.header.describe(v);
        self.design.describe(v, &Param::new("design", "The design.").required());
        v.members(&Param::new("load", "Loads."), Form::Stages, &mut self.load);
        self.studies.describe(v);
        v.reserved(RESERVED);
    }
}

impl Describe for Design {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let length = |key, doc| Param::new(key, doc).of(Dimension::Length).above(0.0, 1.0);
        v.quantity(&length("thickness", "Thickness w.").required(), &mut self.thickness);
        v.quantity(&length("depth", "Depth t.").default("10 mm"), &mut self.depth);
        v.quantity(&Param::new("friction", "Coefficient of friction.").within(0.0, 1.0), &mut self.friction);
        v.quantity(&Param::new("force", "A force.").of(Dimension::Force), &mut self.force);
        v.count(&Param::new("copies", "Copies.").within(1.0, 8.0), &mut self.copies);
        v.along(&length("width", "Width."), 3, &mut self.width);
        v.file(&Param::new("measured_file", "What was measured."), &mut self.measured_file);
        v.members(&Param::new("nodes", "Nodes."), Form::Table, &mut self.nodes);
        v.members(&Param::new("beams", "Beams."), Form::List, &mut self.beams);
    }
}

impl Describe for Load {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&Param::new("travel", "How far.").of(Dimension::Length).above(0.0, 1.0).required(), &mut self.travel);
    }
}

impl Describe for Node {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.point(&Param::new("at", "Position.").of(Dimension::Length).within(-10.0, 10.0), &mut self.at);
        v.choice(&Param::new("support", "Support."), SUPPORTS, &mut self.support);
        v.direction(&Param::new("direction", "Direction."), &mut self.direction);
        v.points(&Param::new("through", "Points.").of(Dimension::Length).within(-10.0, 10.0), 4, &mut self.through);
    }
}

impl Describe for Beam {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.names(&Param::new("between", "Its two nodes.").required(), 2, 2, &mut self.between);
        v.numbers(&Param::new("bend", "Coefficients.").within(-50.0, 50.0), &mut self.bend);
        v.flag(&Param::new("straight", "Straight."), &mut self.straight);
        v.quantity(&Param::new("thickness", "Its own thickness.").of(Dimension::Length).above(0.0, 1.0), &mut self.thickness);
        v.quantity(&Param::new("pin", "Diameter of its pin.").diameter().above(0.0, 1.0), &mut self.pin);
    }
}

/// Files in memory; a name that contains `broken` answers with an error.
pub(crate) struct Memory(BTreeMap<String, String>);

impl Files for Memory {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        let name = path.to_string_lossy();
        match name.as_ref() {
            "broken-utf8.toml" | "broken-utf8.csv" => Err(FileError::NotUtf8(7)),
            "broken-large.toml" | "broken-large.csv" => Err(FileError::TooLarge(100_000_000)),
            "broken-folder.toml" | "broken-folder.csv" => Err(FileError::NotAFile),
            "broken-rights.toml" | "broken-rights.csv" => Err(FileError::Unreadable("permission denied".to_owned())),
            _ => self.0.get(name.as_ref()).cloned().ok_or(FileError::NotFound),
        }
    }
}

/// What reading gave.
pub(crate) struct Reading {
    /// The toy, filled.
    pub(crate) toy: Toy,
    /// One line per diagnostic, in the order shown: `E0301 a.toml:1:1 key`.
    pub(crate) found: Vec<String>,
    /// Help of each.
    pub(crate) help: Vec<String>,
    /// The texts that were read.
    pub(crate) sources: Sources,
    /// Everything as a terminal shows it.
    pub(crate) shown: String,
}

impl Reading {
    /// The rows of the parameter table, `path = value`.
    pub(crate) fn rows(&mut self) -> Vec<String> {
        let rows = paths::rows_of(&mut self.toy).into_iter();
        rows.filter(|r| !self.toy.studies.lack(&r.path)).map(|r| format!("{} = {}", r.path, r.value)).collect()
    }

    /// The numbers that a study can change.
    pub(crate) fn numbers(&mut self) -> Vec<Number> {
        numbers_of(&mut self.toy)
    }

    /// One row.
    pub(crate) fn row(&mut self, path: &str) -> String {
        let start = format!("{path} = ");
        self.rows().iter().find_map(|r| r.strip_prefix(&start).map(str::to_owned)).unwrap_or_else(|| "–".to_owned())
    }
}

/// Reads `a.toml` out of some files.
pub(crate) fn read_files(files: &[(&str, &str)], variant: Option<&str>, set: &[&str]) -> Reading {
    let memory = Memory(files.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect());
    let choices = Choices { variant: variant.map(str::to_owned), set: set.iter().map(|s| (*s).to_owned()).collect() };
    let mut project = Project::load(&memory, Path::new(files.first().map_or("a.toml", |f| f.0)), &choices);
    // As the library does it: a file that names no family has no reader.
    let toy = match project.mechanism() {
        Some(_) => read::read(&project.tree, project.root, &mut project.diagnostics),
        None => Toy::default(),
    };
    let (found, help) = lines(&project);
    Reading { toy, found, help, shown: project.diagnostics.render(&project.sources, false), sources: project.sources }
}

/// Only what is shown of it.
pub(crate) fn show(files: &[(&str, &str)]) -> String {
    let memory = Memory(files.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect());
    let mut project = Project::load(&memory, Path::new("a.toml"), &Choices::default());
    let _: Toy = read::read(&project.tree, project.root, &mut project.diagnostics);
    project.diagnostics.render(&project.sources, false)
}

/// Reads one text.
pub(crate) fn read_text(text: &str) -> Reading {
    read_files(&[("a.toml", text)], None, &[])
}

fn lines(project: &Project) -> (Vec<String>, Vec<String>) {
    let all: &Diagnostics = &project.diagnostics;
    let mut found = Vec::new();
    let mut helps = Vec::new();
    for diagnostic in all.in_file_order() {
        let place = diagnostic.span.map_or_else(String::new, |span| {
            let source = project.sources.get(span.source).expect("a source");
            let (line, column) = project.sources.line_column(span).expect("a place inside the text");
            let text = source.text.get(span.start..span.end.min(source.text.len())).unwrap_or("");
            format!(" {}:{line}:{column} {}", source.name, text.lines().next().unwrap_or(""))
        });
        found.push(format!("{}{place}", diagnostic.code).trim_end().to_owned());
        let help = diagnostic.help.clone().unwrap_or_default();
        assert!(!help.is_empty() && !diagnostic.message.is_empty(), "{}: no help", diagnostic.code);
        assert_eq!(diagnostic.severity == Severity::Warning, diagnostic.code.starts_with('W'));
        helps.push(help);
    }
    (found, helps)
}
