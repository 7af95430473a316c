//! The page of a study: sections of tables, figures and text in the style of the design report.

use forcewright_model::{CheckState, Figure};

use crate::escape::{each, escape, path, prose};
use crate::html::{Provenance, figure, head, provenance, section};
use crate::table::{Column, Table};

/// A page. All texts are plain: whatever stands in them is shown, not obeyed.
#[derive(Clone, Debug)]
pub struct StudyPage {
    /// What kind of page: `Tolerance study`.
    pub kind: String,
    /// The project's title.
    pub title: String,
    /// Few facts below it: name and text.
    pub facts: Vec<(String, String)>,
    /// The result in one sentence.
    pub verdict: (CheckState, String),
    /// The sections.
    pub sections: Vec<StudySection>,
    /// Version of the program.
    pub version: String,
    /// Project file as given by the user.
    pub input_name: String,
    /// Variant used, if one was chosen.
    pub variant: Option<String>,
    /// SHA-256 of everything read, hexadecimal.
    pub input_sha256: String,
    /// The command that makes this page again.
    pub command: String,
}

/// A section of a page; one without content is left out.
#[derive(Clone, Debug)]
pub struct StudySection {
    /// Stable identifier: `yield`.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// Its content.
    pub parts: Vec<StudyPart>,
}

/// What a section shows.
#[derive(Clone, Debug)]
pub enum StudyPart {
    /// A paragraph.
    Text(String),
    /// Things to know, each with its code where it has one.
    Warnings(Vec<(String, String)>),
    /// A table.
    Table {
        /// What it shows.
        caption: String,
        /// Headings, and what stands below them.
        columns: Vec<(String, StudyColumn)>,
        /// Rows of as many cells.
        rows: Vec<Vec<String>>,
    },
    /// A figure.
    Figure(Box<Figure>),
}

/// How a column is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StudyColumn {
    /// Words.
    Text,
    /// Numbers.
    Number,
    /// Paths and names that scripts use.
    Code,
}

/// The page as one self-contained HTML file.
pub fn page(page: &StudyPage) -> String {
    let mut figures = 0;
    let sections: String = page
        .sections
        .iter()
        .map(|s| {
            let content: String = s.parts.iter().map(|part| content(part, &mut figures)).collect();
            section(s.id, &escape(s.title), &content)
        })
        .collect();
    let from = Provenance {
        version: &page.version,
        input_name: &page.input_name,
        variant: page.variant.as_deref(),
        input_sha256: &page.input_sha256,
        command: &page.command,
    };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n{}</head>\n<body>\n{}<main>\n{sections}{}</main>\n</body>\n</html>\n",
        head(&page.title, &page.version),
        header(page),
        provenance(&from)
    )
}

fn header(page: &StudyPage) -> String {
    let mut facts = page.facts.clone();
    facts.push(("Forcewright".to_owned(), page.version.clone()));
    let facts = each(&facts, |(name, value)| format!("<div><dt>{}</dt><dd>{}</dd></div>", escape(name), prose(value)));
    let (class, mark) = match page.verdict.0 {
        CheckState::Met => ("met", "✓"),
        CheckState::Missed => ("missed", "✗"),
        CheckState::NotAssessed => ("open", "?"),
    };
    format!(
        "<header>\n<p class=\"kind\">{}</p>\n<h1>{}</h1>\n<dl class=\"facts\">{facts}</dl>\n\
         <p class=\"verdict {class}\"><span class=\"mark\" aria-hidden=\"true\">{mark}</span> <strong>{}</strong></p>\n</header>\n",
        escape(&page.kind),
        escape(&page.title),
        prose(&page.verdict.1)
    )
}

fn content(part: &StudyPart, figures: &mut usize) -> String {
    match part {
        StudyPart::Text(text) => format!("<p>{}</p>\n", prose(text)),
        StudyPart::Warnings(all) if all.is_empty() => String::new(),
        StudyPart::Warnings(all) => {
            let item = |(code, text): &(String, String)| {
                let code = if code.is_empty() { String::new() } else { format!("<code>{}</code> ", escape(code)) };
                format!("<li>{code}{}</li>\n", prose(text))
            };
            format!("<ul class=\"warnings\">\n{}</ul>\n", each(all, item))
        }
        StudyPart::Table { rows, .. } if rows.is_empty() => String::new(),
        StudyPart::Table { caption, columns, rows } => {
            let kind = |column: StudyColumn| match column {
                StudyColumn::Text => Column::Text,
                StudyColumn::Number => Column::Number,
                StudyColumn::Code => Column::Code,
            };
            let headings: Vec<(&str, Column)> = columns.iter().map(|(title, column)| (title.as_str(), kind(*column))).collect();
            let mut table = Table::new("study", caption, &headings);
            for row in rows {
                let cells = row.iter().zip(columns).map(|(cell, (_, column))| match column {
                    StudyColumn::Text => prose(cell),
                    StudyColumn::Number => escape(cell),
                    StudyColumn::Code => path(cell),
                });
                table.row(&cells.collect::<Vec<_>>());
            }
            table.finish()
        }
        StudyPart::Figure(own) => {
            *figures += 1;
            figure(*figures, own)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is typed by somebody is shown, not obeyed; empty sections are left out.
    #[test]
    fn texts_are_escaped_and_empty_sections_left_out() {
        let bad = "<script>alert(1)</script>".to_owned();
        let table = StudyPart::Table {
            caption: bad.clone(),
            columns: vec![(bad.clone(), StudyColumn::Text), (bad.clone(), StudyColumn::Code)],
            rows: vec![vec![bad.clone(), bad.clone()]],
        };
        let warnings = StudyPart::Warnings(vec![(bad.clone(), bad.clone())]);
        let parts = vec![StudyPart::Text(bad.clone()), warnings, table];
        let html = page(&StudyPage {
            kind: bad.clone(),
            title: bad.clone(),
            facts: vec![(bad.clone(), bad.clone())],
            verdict: (CheckState::Missed, bad.clone()),
            sections: vec![
                StudySection { id: "full", title: "Full", parts },
                StudySection { id: "empty", title: "Empty", parts: vec![StudyPart::Warnings(Vec::new())] },
            ],
            version: bad.clone(),
            input_name: bad.clone(),
            variant: Some(bad.clone()),
            input_sha256: bad.clone(),
            command: bad,
        });
        assert!(
            !html.contains("<script") && html.contains("&lt;script&gt;") && html.contains("id=\"full\"") && !html.contains("id=\"empty\"")
        );
    }
}
