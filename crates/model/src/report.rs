//! A design report, as data.

use crate::{Figure, Outcome, Study};

/// A work that was used, as it is cited.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Citation {
    /// Key in the project's bibliography: `lan2010`.
    pub key: &'static str,
    /// The work, in words.
    pub text: &'static str,
    /// What it was used for.
    pub used_for: &'static str,
}

/// One parameter of the design, as typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterRow {
    /// Dotted path: `design.beams.b1.bend`.
    pub path: String,
    /// Value with unit and tolerance, as typed.
    pub value: String,
    /// Where it comes from: `file`, `default`, `catalogue: POM-C, typical`.
    pub origin: String,
    /// What it is.
    pub doc: String,
}

/// A heading with a text: an assumption, a limit of validity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Statement {
    /// Few words.
    pub title: String,
    /// One or two sentences.
    pub text: String,
}

/// Everything that the report page shows.
#[derive(Clone, Debug)]
pub struct Report {
    /// Result of the analysis: title, status, requirements, metrics, curves, sources, warnings.
    pub outcome: Outcome,
    /// Name of the family for people: `Compliant mechanism of flexible beams`.
    pub family: String,
    /// Version of the program.
    pub version: String,
    /// Variant solved, if one was chosen.
    pub variant: Option<String>,
    /// Project file as given by the user.
    pub input_name: String,
    /// SHA-256 of everything read: the file, what it extends, the settings on the command line; hexadecimal.
    pub input_sha256: String,
    /// The one command that makes this report again.
    pub command: String,
    /// The study that the design comes from, if it does.
    pub study: Option<Study>,
    /// Figures, in the order shown.
    pub figures: Vec<Figure>,
    /// Parameters, in the order of the description.
    pub parameters: Vec<ParameterRow>,
    /// Which equations were solved and how.
    pub model: Vec<Statement>,
    /// What is not modelled, and where the numbers stop being valid.
    pub limits: Vec<Statement>,
}
