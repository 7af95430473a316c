//! From a project file to a report.

use std::fmt::Write as _;
use std::path::Path;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Severity, Sources, Span};
use forcewright_base::text::closest;
use forcewright_contract::family::{Family, Progress, Understood};
use forcewright_contract::project::{Choices, Files, Project};
use forcewright_contract::tree::Value;
use forcewright_model::{Report, Warning};
use sha2::{Digest, Sha256};

use crate::{FAMILIES, VERSION};

/// A project that can be solved.
pub struct Loaded {
    /// The family that understood it.
    pub family: &'static dyn Family,
    /// What was read, with warnings.
    pub project: Project,
    /// SHA-256 of everything read; for a file that stands alone, that of the file.
    pub input_sha256: String,
    pub(crate) understood: Box<dyn Understood>,
}

/// A project that cannot be used, and why.
#[derive(Clone, Debug)]
pub struct Refused {
    /// Everything found wrong.
    pub diagnostics: Diagnostics,
    /// The texts that it points into.
    pub sources: Sources,
    /// Whether a file could not be read at all, as opposed to not understood.
    pub file_missing: bool,
}

impl Refused {
    /// Text for a terminal, with lines of source.
    pub fn render(&self, colour: bool) -> String {
        self.diagnostics.render(&self.sources, colour)
    }

    /// With the last settings, so many, shown as values of another option than `--set`.
    pub(crate) fn typed_as(mut self, option: &str, settings: usize) -> Self {
        let first = self.sources.iter().count().saturating_sub(settings);
        let mut sources = Sources::default();
        for (at, source) in self.sources.iter().enumerate() {
            sources.add(if at < first { source.name.as_str() } else { option }, source.text.as_ref());
        }
        self.sources = sources;
        self
    }

    /// How many errors there are.
    pub fn errors(&self) -> usize {
        self.diagnostics.in_file_order().iter().filter(|d| d.severity == Severity::Error).count()
    }
}

impl Loaded {
    /// Reads and understands a project file.
    ///
    /// # Errors
    /// [`Refused`] with everything that is wrong, in file order.
    pub fn from_file(files: &dyn Files, path: &Path, choices: &Choices) -> Result<Self, Refused> {
        Self::from_project(Project::load(files, path, choices))
    }

    /// The same for a text in memory, which cannot extend other files.
    ///
    /// # Errors
    /// [`Refused`] with everything that is wrong, in file order.
    pub fn from_text(name: &str, text: &str, choices: &Choices) -> Result<Self, Refused> {
        Self::from_project(Project::from_text(name, text, choices))
    }

    fn from_project(mut project: Project) -> Result<Self, Refused> {
        let family = family_of(&mut project);
        // While there is only one family, a file that does not name it well is read as its file, so that other errors are found too.
        let reader = family.or(if let [only] = FAMILIES { Some(*only) } else { None });
        let understood = reader.filter(|_| !project.tree.entries.is_empty()).and_then(|f| f.understand(&mut project));
        match (family, understood) {
            (Some(family), Some(understood)) if !project.diagnostics.has_errors() => {
                Ok(Self { family, input_sha256: hash(&project.sources), project, understood })
            }
            _ => {
                if !project.diagnostics.has_errors() {
                    project
                        .diagnostics
                        .push(Diagnostic::placeless("E0509", "the project was not understood").help("please report this with the file"));
                }
                let diagnostics = not_toml(&project).or_else(|| without_design(&project)).unwrap_or(project.diagnostics);
                Err(Refused { diagnostics, sources: project.sources, file_missing: project.file_missing })
            }
        }
    }

    /// Where a key stands, or the last table on the way to it; the beginning of the file without any.
    pub(crate) fn place_of(&self, path: &[&str]) -> Span {
        let (mut table, mut place) = (&self.project.tree, self.project.root);
        for key in path {
            let Some(entry) = table.get(key) else { break };
            place = entry.key_span;
            match &entry.item.value {
                Value::Table(inner) => table = inner,
                _ => break,
            }
        }
        place
    }

    /// The project as refused for what was found later.
    pub(crate) fn refused(&self, diagnostics: Diagnostics) -> Refused {
        // A file of data that is not there is as one that `extends` names.
        let file_missing = diagnostics.in_file_order().iter().any(|d| d.code == "E0101" || d.code == "E0104");
        Refused { diagnostics, sources: self.project.sources.clone(), file_missing }
    }

    /// Analyses the project. `input_name` is the file as the user named it, `command` the command that repeats this run.
    pub fn solve(&self, input_name: &str, command: &str, progress: Progress<'_>) -> Report {
        let mut analysis = self.understood.analyse(progress);
        let sources = &self.project.sources;
        for warning in self.project.diagnostics.warnings() {
            let place = warning.span.and_then(|s| Some((sources.get(s.source)?, sources.line_column(s)?)));
            let place = place.map_or_else(String::new, |(source, (line, _))| format!("{}:{line}: ", source.name));
            analysis.outcome.warnings.push(Warning { code: warning.code, message: format!("{place}{}", warning.message) });
        }
        Report {
            outcome: analysis.outcome,
            family: self.family.title().to_owned(),
            version: VERSION.to_owned(),
            variant: self.project.choices.variant.clone(),
            input_name: input_name.to_owned(),
            input_sha256: self.input_sha256.clone(),
            command: command.to_owned(),
            study: None,
            figures: analysis.figures,
            parameters: self.understood.parameters(),
            model: analysis.model,
            limits: analysis.limits,
        }
    }
}

/// What is wrong with a file that is not TOML: what misses there may stand behind the slip.
fn not_toml(project: &Project) -> Option<Diagnostics> {
    let all = project.diagnostics.in_file_order();
    all.iter().any(|d| d.code == "E0105").then(|| others(&all, "E0302"))
}

/// All but those of a code.
fn others(all: &[&Diagnostic], code: &str) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    all.iter().filter(|d| d.code != code).for_each(|d| diagnostics.push((*d).clone()));
    diagnostics
}

/// Where a file without a design asks for one.
pub(crate) fn asks_for_design(project: &Project) -> Option<Span> {
    project.tree.get("synthesise").filter(|_| project.tree.get("design").is_none()).map(|entry| entry.key_span)
}

/// What is wrong with a file that says what a design must do, and has none: what misses there is what a synthesis writes.
fn without_design(project: &Project) -> Option<Diagnostics> {
    let asked = asks_for_design(project)?;
    let mut diagnostics = others(&project.diagnostics.in_file_order(), "E0302");
    if diagnostics.has_errors() {
        return Some(diagnostics);
    }
    diagnostics.push(
        Diagnostic::error("E0302", asked, "`design` is missing: this file says what a design must do")
            .label("asks for one")
            .help("`forcewright synthesise` makes project files that have one, `forcewright check` tells whether it can"),
    );
    Some(diagnostics)
}

/// The family that the project names; reports a missing or unknown one.
fn family_of(project: &mut Project) -> Option<&'static dyn Family> {
    let ids = || FAMILIES.iter().map(|f| f.id());
    let all = ids().map(|id| format!("\"{id}\"")).collect::<Vec<_>>().join(", ");
    let Some((id, span)) = project.mechanism().map(|(id, span)| (id.to_owned(), span)) else {
        // A file that could not be read, or not parsed, has been reported already.
        if !project.diagnostics.has_errors() {
            let message = "`mechanism` is missing";
            project.diagnostics.push(
                Diagnostic::error("E0302", project.root, message)
                    .label("from this file")
                    .help(format!("add `mechanism = …`, one of {all}")),
            );
        }
        return None;
    };
    let family = crate::family(&id);
    if family.is_none() {
        let help = closest(&id, ids()).map_or_else(|| format!("one of {all}"), |near| format!("did you mean \"{near}\"? ({all})"));
        project.diagnostics.push(Diagnostic::error("E0309", span, "no such mechanism").label("not known").help(help));
    }
    family
}

/// SHA-256 of everything read, in hexadecimal.
pub(crate) fn hash(sources: &Sources) -> String {
    let mut hasher = Sha256::new();
    for (index, source) in sources.iter().enumerate() {
        if index > 0 {
            // Contents, not paths: the same project has the same hash wherever it lies. A file that stands alone has that of its bytes.
            hasher.update([0]);
        }
        hasher.update(source.text.as_bytes());
    }
    hex(&hasher.finalize())
}

/// Bytes in hexadecimal.
pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
