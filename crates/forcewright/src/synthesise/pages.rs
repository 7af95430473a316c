//! A synthesis for people: words, a table, the page.

use forcewright_base::units::format_number;
use forcewright_model::{CheckState, Figure, FigureContent, Report, Series, Statement, Stroke, StudyColumn, StudyTable};
use forcewright_report::study::{StudyColumn as PageColumn, StudyPage, StudyPart, StudySection, page};

use super::{Designed, Synthesised, Way};
use crate::VERSION;

/// Designs whose curves are drawn over each other.
const STROKES: [Stroke; 3] = [Stroke::Main, Stroke::Second, Stroke::Third];
/// Figures need names of their own.
const SHAPES: [&str; 5] = ["shape-1", "shape-2", "shape-3", "shape-4", "shape-5"];

impl Synthesised {
    /// What was found, in words.
    pub fn verdict(&self) -> Vec<Statement> {
        let say = |title: &str, text: String| Statement { title: title.to_owned(), text };
        let mut all = vec![say("Synthesis", self.in_one_sentence())];
        all.extend(self.beyond_in_words().map(|text| say("Beyond the requirements", text)));
        let (confirmed, guessed): (Vec<&Way>, Vec<&Way>) = self.ways.iter().partition(|w| w.confirmed);
        if !confirmed.is_empty() {
            let list: Vec<String> = confirmed.iter().map(|w| in_words(w)).collect();
            all.push(say("Any one of these would do", format!("{}. Each was tried: a design meets everything then.", list.join("; "))));
        }
        if !guessed.is_empty() {
            let list: Vec<String> = guessed.iter().map(|w| in_words(w)).collect();
            all.push(say("By the closed form alone", format!("{}. No design analysed in full has confirmed it.", list.join("; "))));
        }
        if !self.met() && self.ways.is_empty() && !self.interrupted {
            let text =
                "no single limit, loosened alone, is enough: loosen two or more of the requirements and of the room, or allow more in `[synthesise]`"
                    .to_owned();
            all.push(say("What blocks", text));
        }
        let effort = self.effort.as_ref().map_or_else(String::new, |effort| format!(" {effort}"));
        all.push(say("Work", format!("{} designs were analysed in full.{effort}", self.analysed)));
        if self.interrupted {
            all.push(say("Interrupted", "What was found until then is kept.".to_owned()));
        }
        all
    }

    fn in_one_sentence(&self) -> String {
        match (self.designs.as_slice(), self.met()) {
            ([first, ..], true) => format!(
                "{} designs meet every requirement; the one that takes the least room is {} ({}).",
                self.designs.len(),
                first.proposal.title,
                first.file
            )
            .replace("1 designs meet", "1 design meets"),
            ([nearest, ..], false) => {
                let missed = nearest.report.outcome.checks.iter().filter(|c| c.required && c.state != CheckState::Met);
                let missed: Vec<&str> = missed.map(|c| c.title.as_str()).collect();
                format!("No design meets every requirement. The nearest, {}, misses: {}.", nearest.file, missed.join("; "))
            }
            ([], _) => "No design meets every requirement.".to_owned(),
        }
    }

    /// The checks that no requirement asks for, and that designs miss.
    fn beyond_in_words(&self) -> Option<String> {
        let of = |(i, design): (usize, &Designed)| {
            let missed = design.missed().filter(|c| !c.required);
            let titles: Vec<String> = missed.map(|c| format!("{} ({})", short(&c.title), c.code)).collect();
            let checks = if titles.len() == 1 { "check" } else { "checks" };
            (!titles.is_empty())
                .then(|| format!("design {} misses {} {checks} of its full analysis: {}", i + 1, titles.len(), titles.join(", ")))
        };
        let all: Vec<String> = self.designs.iter().enumerate().filter_map(of).collect();
        let mut text = all.join("; ");
        if let Some(first) = text.get(..1).map(str::to_uppercase) {
            text.replace_range(..1, &first);
        }
        (!all.is_empty()).then(|| format!("{text}. `solve` of their files says what each means and what helps."))
    }

    /// The designs: shape, sizes, key results.
    pub fn table(&self) -> StudyTable {
        let text = |title: &str| StudyColumn::Text(title.to_owned());
        let number = |title: &str| StudyColumn::Number(title.to_owned());
        let names: Vec<&'static str> = self.designs.first().map_or_else(Vec::new, |d| d.proposal.sizes.iter().map(|s| s.0).collect());
        let mut columns = vec![number("Design"), text("Shape")];
        columns.extend(names.iter().map(|name| number(name)));
        columns.extend([
            number("Room taken"),
            number("Least margin"),
            text("Requirements"),
            text("Checks missed"),
            text("Warnings"),
            StudyColumn::Code("File".to_owned()),
        ]);
        let row = |(i, d): (usize, &Designed)| {
            let mut row = vec![(i + 1).to_string(), d.proposal.title.clone()];
            row.extend(d.proposal.sizes.iter().map(|s| s.1.clone()));
            row.push(format!("{} cm³", format_number(1e6 * d.proposal.cost, 3)));
            row.push(d.margin().map_or_else(|| "–".to_owned(), |m| format!("{} %", format_number(100.0 * m, 2))));
            let searched = if d.searched { ", after a search" } else { "" };
            row.push(format!("{}{searched}", if d.met() { "met" } else { "missed" }));
            let missed: Vec<&str> = d.missed().map(|c| c.code).collect();
            row.push(if missed.is_empty() { "–".to_owned() } else { format!("{}: {}", missed.len(), missed.join(", ")) });
            row.push(if codes(d).is_empty() { "–".to_owned() } else { codes(d).join(", ") });
            row.push(d.file.clone());
            row
        };
        StudyTable {
            caption: "Designs, the best first. Room: of all parts and their copies over the travel".to_owned(),
            columns,
            rows: self.designs.iter().enumerate().map(row).collect(),
        }
    }

    /// `report.html`. `input_name` is the file as the user named it, `command` the command that repeats this run.
    pub fn page(&self, input_name: &str, command: &str) -> String {
        let statements = self.verdict();
        let words = statements.iter().skip(1).map(|s| StudyPart::Text(format!("{}: {}", s.title, s.text)));
        let mut designs = vec![part(self.table())];
        designs.extend(words);
        let figures = self.curves().into_iter().chain(self.shapes()).map(|f| StudyPart::Figure(Box::new(f)));
        let rejected = self.rejected.iter().map(|(shape, why)| vec![shape.clone(), why.clone()]);
        let rejected = StudyTable {
            caption: "Shapes that were sized but are not fit to be made".to_owned(),
            columns: vec![StudyColumn::Text("Shape".to_owned()), StudyColumn::Text("Why".to_owned())],
            rows: rejected.collect(),
        };
        let mut sections = vec![
            StudySection { id: "designs", title: "Designs", parts: designs },
            StudySection { id: "shapes", title: "Curves and shapes", parts: figures.collect() },
        ];
        if !self.tables.is_empty() {
            let parts = self.tables.iter().cloned().map(part).collect();
            sections.push(StudySection { id: "alternatives", title: "Alternatives", parts });
        }
        if !self.rejected.is_empty() {
            sections.push(StudySection { id: "rejected", title: "Not fit", parts: vec![part(rejected)] });
        }
        page(&StudyPage {
            kind: "Synthesis".to_owned(),
            title: self.title.clone(),
            facts: vec![("Mechanism".to_owned(), self.family.clone()), ("Project file".to_owned(), input_name.to_owned())],
            verdict: (
                if self.met() { CheckState::Met } else { CheckState::Missed },
                statements.first().map_or_else(String::new, |s| s.text.trim_end_matches('.').to_owned()),
            ),
            sections,
            version: VERSION.to_owned(),
            input_name: input_name.to_owned(),
            variant: None,
            input_sha256: self.input_sha256.clone(),
            command: command.to_owned(),
        })
    }

    fn shapes(&self) -> Vec<Figure> {
        let shape = |(id, (i, design)): (&'static str, (usize, &Designed))| {
            let (own, scene) = design.report.figures.iter().find_map(|f| Some((f, f.content.still()?)))?;
            Some(Figure {
                id,
                title: format!("Design {}, {}: {}", i + 1, design.proposal.title, own.title),
                content: FigureContent::Scene(scene),
                ..own.clone()
            })
        };
        SHAPES.into_iter().zip(self.designs.iter().enumerate()).filter_map(shape).collect()
    }

    /// The main curve of the first designs.
    fn curves(&self) -> Option<Figure> {
        let plot_of = |report: &Report| {
            report.figures.iter().find_map(|f| match &f.content {
                FigureContent::Plot(plot) => Some((f.title.clone(), plot.clone())),
                _ => None,
            })
        };
        let (title, mut plot) = plot_of(&self.designs.first()?.report)?;
        let lines = self.designs.iter().zip(STROKES).enumerate().flat_map(|(i, (design, stroke))| {
            let own = plot_of(&design.report).map_or_else(Vec::new, |(_, plot)| plot.series);
            let label = format!("design {}", i + 1);
            own.into_iter().filter(|s| s.stroke == Stroke::Main).map(move |s| Series { label: label.clone(), stroke, ..s })
        });
        plot.series = lines.collect();
        (plot.spans, plot.markers) = (Vec::new(), Vec::new());
        Some(Figure {
            id: "curves",
            title: format!("{title} of the first designs"),
            caption: "The band is that of the requirements where a level is given.".to_owned(),
            content: FigureContent::Plot(plot),
        })
    }
}

/// The title of a check without the place that it found.
fn short(title: &str) -> &str {
    title.split(" (").next().unwrap_or(title)
}

/// The codes of what a design's analysis warns of, each once.
fn codes(design: &Designed) -> Vec<&'static str> {
    let mut all: Vec<&'static str> = design.report.outcome.warnings.iter().map(|w| w.code).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// `safety factor 1.2 (now 1.5)`.
fn in_words(way: &Way) -> String {
    let relaxation = &way.relaxation;
    let side = if relaxation.at_most { "at most" } else { "at least" };
    let now = if relaxation.now.is_empty() { String::new() } else { format!(", asked {}", relaxation.now) };
    format!("{} {side} {} (`{}`{now})", relaxation.name, relaxation.text, relaxation.key)
}

fn part(table: StudyTable) -> StudyPart {
    let columns = table.columns.into_iter().map(|c| match c {
        StudyColumn::Text(title) => (title, PageColumn::Text),
        StudyColumn::Number(title) => (title, PageColumn::Number),
        StudyColumn::Code(title) => (title, PageColumn::Code),
    });
    StudyPart::Table { caption: table.caption, columns: columns.collect(), rows: table.rows }
}
