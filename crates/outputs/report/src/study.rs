//! The page of a study: sections of tables, figures and text in the style of the design report.

use std::fmt::Write as _;

use forcewright_base::units::Unit;
use forcewright_model::{Axis, CheckState, Figure};

use crate::escape::{each, escape, path, prose};
use crate::html::{Provenance, figure, head, provenance, section};
use crate::svg;
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
    /// Points to choose from.
    Scatter(Box<Scatter>),
    /// Lines to choose from.
    Parallel(Box<Parallel>),
    /// Rows that points lead to.
    Picks(Picks),
}

/// Points to choose from: each leads to its row in [`Picks`].
#[derive(Clone, Debug)]
pub struct Scatter {
    /// Stable identifier.
    pub id: &'static str,
    /// What it shows.
    pub title: String,
    /// How it is read.
    pub caption: String,
    /// Abscissa.
    pub x: Axis,
    /// Ordinate.
    pub y: Axis,
    /// The points.
    pub points: Vec<ScatterPoint>,
}

/// A point to choose.
#[derive(Clone, Debug)]
pub struct ScatterPoint {
    /// Abscissa, SI.
    pub x: f64,
    /// Ordinate, SI.
    pub y: f64,
    /// What it is called: `Design 3`.
    pub label: String,
    /// Identifier of its row.
    pub leads_to: String,
    /// Whether it has a ring.
    pub outstanding: bool,
}

/// Designs as lines over parallel axes, each of which may lead to its row in [`Picks`].
#[derive(Clone, Debug)]
pub struct Parallel {
    /// Stable identifier.
    pub id: &'static str,
    /// What it shows.
    pub title: String,
    /// How it is read.
    pub caption: String,
    /// The axes, from left to right.
    pub axes: Vec<ParallelAxis>,
    /// The lines.
    pub lines: Vec<ParallelLine>,
    /// What lines of each rank are, in their order.
    pub names: [String; 3],
}

/// One axis of several.
#[derive(Clone, Debug)]
pub struct ParallelAxis {
    /// What it is; a path may be broken at its dots.
    pub name: String,
    /// What is wanted of it: `maximise`; empty for what is varied.
    pub sense: String,
    /// What its values are.
    pub scale: ParallelScale,
}

/// Values of an axis.
#[derive(Clone, Debug)]
pub enum ParallelScale {
    /// Numbers, shown in a unit.
    Number(Unit),
    /// One of some words; values are their places.
    Words(Vec<String>),
}

/// A line over parallel axes.
#[derive(Clone, Debug)]
pub struct ParallelLine {
    /// A value per axis, SI or the place of a word; a line is interrupted where there is none.
    pub values: Vec<Option<f64>>,
    /// What it is.
    pub label: String,
    /// Identifier of its row, if it has one.
    pub leads_to: Option<String>,
    /// How it is drawn.
    pub rank: ParallelRank,
}

/// How much a line stands out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParallelRank {
    /// Thin and grey.
    Others,
    /// In the colour of results.
    Picked,
    /// Thick and dashed, with points: what everything is compared with.
    Present,
}

/// A table whose rows can be led to.
#[derive(Clone, Debug)]
pub struct Picks {
    /// What it shows.
    pub caption: String,
    /// Headings, and what stands below them; the second one heads the files.
    pub columns: Vec<(String, StudyColumn)>,
    /// The rows.
    pub rows: Vec<Pick>,
}

/// A row that can be led to.
#[derive(Clone, Debug)]
pub struct Pick {
    /// Its identifier.
    pub id: String,
    /// Its cells but the second.
    pub cells: Vec<String>,
    /// A file beside the page, for the second cell.
    pub file: Option<String>,
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
        StudyPart::Scatter(own) if own.points.is_empty() => String::new(),
        StudyPart::Scatter(own) => {
            *figures += 1;
            chosen_from(*figures, own.id, &svg::scatter::draw(own, svg::PlotSize::default()), [&own.title, &own.caption])
        }
        StudyPart::Parallel(own) if own.axes.is_empty() || own.lines.is_empty() => String::new(),
        StudyPart::Parallel(own) => {
            *figures += 1;
            chosen_from(*figures, own.id, &svg::parallel::draw(own, svg::PlotSize::default()), [&own.title, &own.caption])
        }
        StudyPart::Picks(own) if own.rows.is_empty() => String::new(),
        StudyPart::Picks(own) => picks(own),
    }
}

/// A picture of links.
fn chosen_from(number: usize, id: &str, drawing: &svg::Drawing, [title, caption]: [&str; 2]) -> String {
    format!(
        "<figure id=\"figure-{}\" class=\"plot\">\n{}<figcaption><strong>Figure {number}. {}.</strong> {}</figcaption>\n</figure>\n",
        escape(id),
        drawing.svg,
        escape(title.trim_end_matches('.')),
        prose(caption)
    )
}

/// Rows with identifiers, so that the style can mark the one that is led to.
fn picks(picks: &Picks) -> String {
    let mut body = String::new();
    let heading = |i: usize| picks.columns.get(i).map_or("", |c| c.0.as_str());
    for pick in &picks.rows {
        let _ = write!(body, "<tr id=\"{}\">", escape(&pick.id));
        for (i, cell) in pick.cells.iter().enumerate() {
            // The file stands between the first cell and the others.
            let at = if i == 0 { 0 } else { i + 1 };
            let (class, shown) = match picks.columns.get(at).map(|c| c.1) {
                Some(StudyColumn::Number) => (" class=\"number\"", escape(cell)),
                Some(StudyColumn::Code) => (" class=\"code\"", path(cell)),
                Some(StudyColumn::Text) | None => ("", prose(cell)),
            };
            let _ = match i {
                0 => write!(body, "<th scope=\"row\"{class}>{shown}</th>{}", file_cell(pick, heading(1))),
                _ => write!(body, "<td{class} data-label=\"{}\">{shown}</td>", escape(heading(at))),
            };
        }
        body.push_str("</tr>\n");
    }
    let columns: Vec<(&str, Column)> = picks
        .columns
        .iter()
        .map(|(title, column)| {
            let kind = match column {
                StudyColumn::Text => Column::Text,
                StudyColumn::Number => Column::Number,
                StudyColumn::Code => Column::Code,
            };
            (title.as_str(), kind)
        })
        .collect();
    let mut table = Table::new("study picks", &picks.caption, &columns);
    table.rows(picks.rows.len(), &body);
    table.finish()
}

fn file_cell(pick: &Pick, heading: &str) -> String {
    let file = pick.file.as_deref().map_or_else(|| "–".to_owned(), |f| format!("<a href=\"{}\">{}</a>", url(f), path(f)));
    format!("<td class=\"code\" data-label=\"{}\">{file}</td>", escape(heading))
}

/// The name of a file beside the page as a relative address.
fn url(file: &str) -> String {
    let mut out = String::from("./");
    for byte in file.bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~".contains(&byte) {
            out.push(char::from(byte));
        } else {
            let _ = write!(out, "%{byte:02X}");
        }
    }
    out
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

    /// Lines over axes lead to rows; every axis has its name and its unit, words are words, the design of the file is none of the links.
    #[test]
    fn lines_lead_to_their_rows() {
        use forcewright_base::units::Unit;
        let number = |name: &str, unit: &str| ParallelAxis {
            name: name.to_owned(),
            sense: "minimise".to_owned(),
            scale: ParallelScale::Number(Unit::parse(unit).unwrap()),
        };
        let words = ParallelScale::Words(vec!["thin <1>".to_owned(), "thick".to_owned()]);
        let cable = ParallelAxis { name: "design.cables.1.use".to_owned(), sense: String::new(), scale: words };
        let line = |i: u32, rank| ParallelLine {
            values: vec![Some(f64::from(i % 2)), (i != 2).then(|| 1e-3 * f64::from(i)), Some(10.0 + f64::from(i))],
            label: format!("Design {i}"),
            leads_to: (rank != ParallelRank::Present).then(|| format!("design-{i}")),
            rank,
        };
        let own = Parallel {
            id: "lines",
            title: "Lines".to_owned(),
            caption: "Caption.".to_owned(),
            axes: vec![cable, number("design.input_diameter", "mm"), number("force", "N")],
            lines: vec![line(1, ParallelRank::Others), line(2, ParallelRank::Picked), line(3, ParallelRank::Present)],
            names: ["others".to_owned(), "picked".to_owned(), "of the file".to_owned()],
        };
        let mut figures = 0;
        let html = content(&StudyPart::Parallel(Box::new(own.clone())), &mut figures);
        assert!(figures == 1 && html.matches("<a class=\"pick\"").count() == 2 && html.contains("href=\"#design-2\""), "{html}");
        for shown in ["thin &lt;1&gt;", "mm, minimise", "N, minimise", "of the file", "input_", "3 lines over 3 axes", "2.5", "12.5"] {
            assert!(html.contains(shown), "{shown}: {html}");
        }
        // Texts lie inside the drawing and not upon each other.
        let drawing = svg::parallel::draw(&own, svg::PlotSize::default());
        for (i, a) in drawing.texts.iter().enumerate() {
            assert!(a.rect.x0 >= 0.0 && a.rect.x1 <= drawing.width && a.rect.y1 <= drawing.height, "{}", a.text);
            for b in &drawing.texts[i + 1..] {
                assert!(!a.rect.overlaps(&b.rect), "{} {}", a.text, b.text);
            }
        }
        let nothing = Parallel { lines: Vec::new(), ..own };
        assert!(content(&StudyPart::Parallel(Box::new(nothing)), &mut figures).is_empty());
    }

    /// Points lead to rows, and rows to files, by addresses that nothing typed can break out of; the style marks the row.
    #[test]
    fn points_lead_to_their_rows() {
        use forcewright_base::units::{Dimension, Unit};
        let axis = |name: &'static str| Axis {
            name,
            label: format!("goal <{name}>"),
            dimension: Dimension::Ratio,
            display: Unit::si(Dimension::Ratio),
        };
        let point = |i: u32| ScatterPoint {
            x: f64::from(i),
            y: 1.0 / f64::from(i),
            label: format!("Design {i}"),
            leads_to: format!("design-{i}"),
            outstanding: i == 2,
        };
        let scatter = Scatter {
            id: "front",
            title: "A front".to_owned(),
            caption: "Caption.".to_owned(),
            x: axis("a"),
            y: axis("b"),
            points: (1..=3).map(point).collect(),
        };
        let mut figures = 0;
        let html = content(&StudyPart::Scatter(Box::new(scatter)), &mut figures);
        assert_eq!(html.matches("<a class=\"pick\" href=\"#design-").count(), 3);
        assert!(html.contains("role=\"group\"") && !html.contains("role=\"img\""));
        assert!(html.contains("<title>A front</title>") && html.contains("<desc>Caption. 3 points"));
        assert!(html.contains("aria-label=\"Design 2: goal &lt;a&gt; 2, goal &lt;b&gt; 0.5\""), "{html}");
        assert!(figures == 1 && html.contains("Figure 1. A front."));
        let columns = vec![("No".to_owned(), StudyColumn::Number), ("File".to_owned(), StudyColumn::Code)];
        let row = |file: Option<&str>| Pick { id: "design-1".to_owned(), cells: vec!["1".to_owned()], file: file.map(str::to_owned) };
        let rows = vec![row(Some("a b\"<x>.toml")), row(None)];
        let html = content(&StudyPart::Picks(Picks { caption: "Rows".to_owned(), columns, rows }), &mut figures);
        assert!(html.contains("<tr id=\"design-1\"><th scope=\"row\" class=\"number\">1</th>"));
        assert!(
            html.contains("<a href=\"./a%20b%22%3Cx%3E.toml\">a b&quot;&lt;x&gt;.<wbr />toml</a>") && html.contains(">–</td>"),
            "{html}"
        );
        assert!(include_str!("report.css").contains("tr:target"));
    }
}
