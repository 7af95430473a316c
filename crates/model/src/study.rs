//! What a study found, as data: the pages of a report before those of the design itself.

use crate::{Figure, Statement};

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StudyColumn {
    /// Words.
    Text(String),
    /// Numbers, with their units.
    Number(String),
    /// Names that scripts use.
    Code(String),
}

/// A table of a study.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StudyTable {
    /// What it shows.
    pub caption: String,
    /// Headed columns.
    pub columns: Vec<StudyColumn>,
    /// Rows of cells, as many as columns.
    pub rows: Vec<Vec<String>>,
}

/// A study of which the report's design is the result, or the subject.
#[derive(Clone, Debug)]
pub struct Study {
    /// Heading.
    pub title: String,
    /// What was found, in words.
    pub verdict: Vec<Statement>,
    /// Tables, in the order shown.
    pub tables: Vec<StudyTable>,
    /// Figures, in the order shown.
    pub figures: Vec<Figure>,
}
