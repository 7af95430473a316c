//! A comparison as a page for people.

use forcewright_base::units::Dimension;
use forcewright_model::{Axis, Figure, FigureContent, Plot, Series, Stroke};
use forcewright_report::study::{StudyColumn, StudyPage, StudyPart, StudySection, page};

use super::{Comparison, action_of, axes, unit};
use crate::VERSION;

/// Strokes that a reader can tell from each other; so many curves are drawn.
const STROKES: [Stroke; 4] = [Stroke::Main, Stroke::Second, Stroke::Third, Stroke::Fourth];

impl Comparison {
    /// `report.html`. `command` repeats this run.
    pub fn page(&self, command: &str) -> String {
        let names: Vec<String> = self.mechanisms.iter().map(|m| m.input_name.clone()).collect();
        let title = self.short().join(" · ");
        let mut summary = vec![self.sheet()];
        summary.extend(self.cautions().into_iter().map(StudyPart::Text));
        let sections = vec![
            StudySection { id: "sheet", title: "Side by side", parts: summary },
            StudySection {
                id: "curves",
                title: "Over the travel",
                parts: self.figure().map(|f| StudyPart::Figure(Box::new(f))).into_iter().collect(),
            },
            StudySection { id: "bases", title: "What each number is", parts: self.bases() },
            StudySection { id: "requirements", title: "What is asked for", parts: vec![self.asked()] },
        ];
        let hashes = self.mechanisms.iter().map(|m| m.input_sha256.as_str()).collect::<Vec<_>>().join(" ");
        page(&StudyPage {
            kind: "Comparison".to_owned(),
            title,
            facts: vec![("Project files".to_owned(), names.join(", "))],
            verdict: (self.requirements(), self.verdict()),
            sections: sections.into_iter().filter(|s| !s.parts.is_empty()).collect(),
            version: VERSION.to_owned(),
            input_name: names.join(", "),
            variant: None,
            input_sha256: hashes,
            command: command.to_owned(),
        })
    }

    /// Short names of the mechanisms: their files without folder and ending, numbered where two are equal.
    fn short(&self) -> Vec<String> {
        let stem =
            |name: &str| std::path::Path::new(name).file_stem().map_or_else(|| name.to_owned(), |s| s.to_string_lossy().into_owned());
        let stems: Vec<String> = self.mechanisms.iter().map(|m| stem(&m.input_name)).collect();
        let twice = |s: &String| stems.iter().filter(|other| *other == s).count() > 1;
        stems.iter().enumerate().map(|(i, s)| if twice(s) { format!("{s} ({})", i + 1) } else { s.clone() }).collect()
    }

    fn sheet(&self) -> StudyPart {
        let mut columns = vec![("Measure".to_owned(), StudyColumn::Text)];
        columns.extend(self.short().into_iter().map(|name| (name, StudyColumn::Number)));
        let mut rows = vec![[vec!["Family".to_owned()], self.mechanisms.iter().map(|m| m.mechanism.to_owned()).collect()].concat()];
        rows.extend(self.rows().into_iter().map(|row| [vec![row.title.to_owned()], row.texts].concat()));
        rows.push([vec!["Requirements".to_owned()], self.mechanisms.iter().map(|m| m.requirements.word().to_owned()).collect()].concat());
        StudyPart::Table {
            caption: "The same measures of every mechanism; a dash where there is none, or it is not known".to_owned(),
            columns,
            rows,
        }
    }

    fn bases(&self) -> Vec<StudyPart> {
        let columns =
            || [("Measure", StudyColumn::Text), ("Value", StudyColumn::Number), ("What it is, or why there is none", StudyColumn::Text)];
        let rows = self.rows();
        let one = |(at, name): (usize, String)| StudyPart::Table {
            caption: format!("{name}: {}", self.mechanisms[at].title),
            columns: columns().map(|(title, kind)| (title.to_owned(), kind)).into(),
            rows: rows.iter().map(|row| vec![row.title.to_owned(), row.texts[at].clone(), row.bases[at].clone()]).collect(),
        };
        self.short().into_iter().enumerate().map(one).collect()
    }

    fn asked(&self) -> StudyPart {
        let rows = self.short().into_iter().zip(&self.mechanisms).flat_map(|(name, m)| {
            if m.not_met.is_empty() {
                return vec![vec![name, m.requirements.word().to_owned(), m.status.message.clone(), String::new()]];
            }
            let row = |(code, title): &(&'static str, String)| {
                vec![name.clone(), m.requirements.word().to_owned(), title.clone(), (*code).to_owned()]
            };
            m.not_met.iter().map(row).collect()
        });
        let columns = [
            ("Mechanism", StudyColumn::Text),
            ("Requirements", StudyColumn::Text),
            ("Not met", StudyColumn::Text),
            ("Code", StudyColumn::Code),
        ];
        StudyPart::Table {
            caption: "Each mechanism against the requirements of its own file".to_owned(),
            columns: columns.map(|(title, kind)| (title.to_owned(), kind)).into(),
            rows: rows.collect(),
        }
    }

    /// What they give over their travel, those that give it over one, in one plot: of the kind of the first.
    fn figure(&self) -> Option<Figure> {
        let mut curves = self.short().into_iter().zip(&self.mechanisms).filter_map(|(name, m)| Some((name, m.curve.as_ref()?)));
        let first = curves.clone().next()?.1;
        let action = action_of(first)?;
        let series = curves.by_ref().filter(|(_, c)| action_of(c) == Some(action)).zip(STROKES).filter_map(|((name, curve), stroke)| {
            let branch = curve.branches.first()?;
            // Counted from where it begins.
            let from = branch.x.first().copied()?;
            let label = if curve.branches.len() > 1 { format!("{name}, {}", branch.name) } else { name };
            Some(Series { label, x: branch.x.iter().map(|x| x - from).collect(), y: branch.y.clone(), stroke })
        });
        let series: Vec<Series> = series.collect();
        let all = self.mechanisms.iter().filter(|m| m.curve.as_ref().and_then(action_of) == Some(action)).count();
        let left = if all > series.len() { format!(" The first {} of {all} curves.", series.len()) } else { String::new() };
        let [along, across] = axes(action);
        let axis = |name: &'static str, label: &str, dimension: Dimension| Axis {
            name,
            label: label.to_owned(),
            dimension,
            display: unit(dimension),
        };
        let (x, y) = if along == Dimension::Length { ("Travel", "Force") } else { ("Turn", "Torque") };
        (series.len() > 1).then(|| Figure {
            id: "curves",
            title: format!("{y} over {}", x.to_lowercase()),
            caption: format!("Each over its whole travel from its beginning, with friction where it is known (up); the sheet is without friction and over the stretch that counts.{left}"),
            content: FigureContent::Plot(Plot {
                x: axis("travel", x, along),
                y: axis("strength", y, across),
                series,
                bands: Vec::new(),
                levels: Vec::new(),
                spans: Vec::new(),
                markers: Vec::new(),
                from_zero: true,
            }),
        })
    }
}
