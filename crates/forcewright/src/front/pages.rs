//! A front for people: words, tables, figures and the page.

use forcewright_base::units::{Dimension, Unit, format_si};
use forcewright_model::{
    Axis, CheckState, Figure, FigureContent, Marker, Plot, Report, Series, Statement, Stroke, StudyColumn, StudyTable, VerticalSpan,
};
use forcewright_report::study::{StudyColumn as PageColumn, StudyPage, StudyPart, StudySection, page};

use super::{Front, FrontPoint, Origin};

/// A change of the goal, relative to it, below which a front is level.
const LEVEL: f64 = 1e-4;
/// Names of limits in a table.
const MOST_NAMES: usize = 3;
/// The points whose shapes and curves are shown.
const SHAPES: [&str; 3] = ["shape-first", "shape-middle", "shape-last"];
const STROKES: [Stroke; 3] = [Stroke::Main, Stroke::Second, Stroke::Third];

impl Front {
    /// Whether the goal is made large.
    pub(super) fn large(&self) -> bool {
        self.points.first().is_some_and(|p| p.found.wording.large)
    }

    /// Points that keep all requirements and have a goal, SI, by the value of the key.
    fn kept(&self) -> Vec<(usize, f64)> {
        let goals = self.points.iter().enumerate().filter(|(_, p)| p.requirements() == CheckState::Met);
        let mut kept: Vec<(usize, f64)> = goals.filter_map(|(i, p)| Some((i, p.goal()?))).collect();
        kept.sort_by(|a, b| self.points[a.0].si.total_cmp(&self.points[b.0].si));
        kept
    }

    /// Neighbours, by the value of the key, between which the goal goes the other way than from end to end.
    pub fn turns(&self) -> Vec<(usize, usize)> {
        let kept = self.kept();
        let (Some(first), Some(last)) = (kept.first(), kept.last()) else { return Vec::new() };
        let way = (last.1 - first.1).signum();
        let against = |w: &&[(usize, f64)]| way * (w[1].1 - w[0].1) < -LEVEL * w[0].1.abs();
        kept.windows(2).filter(against).map(|w| (w[0].0, w[1].0)).collect()
    }

    fn unit(&self) -> Unit {
        let designed = self.points.iter().find(|p| p.found.after.is_some()).or(self.points.first());
        designed.map_or_else(|| Unit::si(Dimension::Ratio), |p| p.found.goal().1)
    }

    fn goal_text(&self, point: &FrontPoint) -> String {
        point.goal().map_or_else(|| "–".to_owned(), |g| format_si(g, &self.unit(), 4))
    }

    /// What was found, in words.
    pub fn verdict(&self) -> Vec<Statement> {
        let say = |title: &str, text: String| Statement { title: title.to_owned(), text };
        let mut all = vec![say("Front", self.in_one_sentence()), say("Course", self.course())];
        let jumps: Vec<String> = (1..self.points.len()).filter(|i| !self.points[*i].follows).map(|i| self.between(i - 1, i)).collect();
        if !jumps.is_empty() {
            let text = format!("From {} the design jumps to another one: no search leads from one to the other.", jumps.join(", from "));
            all.push(say("Designs", text));
        }
        let starts: usize = self.points.iter().map(|p| p.starts).sum();
        let evaluations: u64 = self.points.iter().map(|p| p.evaluations).sum();
        let others = self.points.iter().filter(|p| !matches!(p.origin, Origin::Start(_))).count();
        all.push(say(
            "Search",
            format!(
                "{starts} starts in all; {others} of {} designs come from those of other points. {evaluations} designs were computed.",
                self.points.len()
            ),
        ));
        if self.interrupted {
            let text = format!(
                "{} of {} points were searched for before it was interrupted; they may be better still.",
                self.points.len(),
                self.asked
            );
            all.push(say("Interrupted", text));
        }
        all
    }

    fn between(&self, a: usize, b: usize) -> String {
        format!("{} to {}", self.points[a].value, self.points[b].value)
    }

    fn in_one_sentence(&self) -> String {
        let kept = self.kept();
        let met = match (kept.len(), self.points.len()) {
            (0, all) => format!("None of {all} points meets every requirement"),
            (met, all) if met == all => format!("All {all} points meet every requirement"),
            (met, all) => format!("{met} of {all} points meet every requirement"),
        };
        let (Some(first), Some(last)) = (kept.first(), kept.last()) else { return format!("{met}.") };
        let at = |i: usize| format!("{} at {}", self.goal_text(&self.points[i]), self.points[i].value);
        let range = if first.0 == last.0 { at(first.0) } else { format!("{}, {}", at(first.0), at(last.0)) };
        format!("{met}; `{}` over `{}`: {range}.", self.goal_name().0, self.key)
    }

    /// Whether the goal goes one way.
    fn course(&self) -> String {
        let turns = self.turns();
        if turns.is_empty() {
            return match self.kept().len() {
                0 | 1 => "Too few points meet every requirement to tell.".to_owned(),
                _ => "Monotone: over the points that meet every requirement the goal goes one way.".to_owned(),
            };
        }
        let list = turns.iter().map(|(a, b)| {
            let [one, other] = [*a, *b].map(|i| self.goal_text(&self.points[i]));
            format!("from {} the goal goes from {one} to {other}", self.between(*a, *b))
        });
        format!(
            "Not monotone: {}, against the course of the whole. Either the key does not only loosen a limit, or the better design was not found: try more starts, or with `search = \"global\"` more `evaluations`.",
            list.collect::<Vec<_>>().join("; ")
        )
    }

    /// The points: value, goal, requirements, what limits them, where they come from.
    pub fn table(&self) -> StudyTable {
        let columns = vec![
            StudyColumn::Number("Point".to_owned()),
            StudyColumn::Number(self.key.clone()),
            StudyColumn::Number(self.goal_name().0),
            StudyColumn::Text("Requirements".to_owned()),
            StudyColumn::Text("Limited by".to_owned()),
            StudyColumn::Text("Found from".to_owned()),
            StudyColumn::Number("Design".to_owned()),
        ];
        let rows = self.points.iter().zip(self.groups()).enumerate().map(|(i, (point, group))| {
            let jump = if point.follows { "" } else { " (jump)" };
            vec![
                (i + 1).to_string(),
                point.value.clone(),
                self.goal_text(point),
                requirements(point),
                limited_by(point),
                point.from(),
                format!("{group}{jump}"),
            ]
        });
        StudyTable { caption: "Points of the front".to_owned(), columns, rows: rows.collect() }
    }

    /// `report.html`. `input_name` is the file as the user named it, `command` the command that repeats this run.
    pub fn page(&self, input_name: &str, command: &str) -> String {
        let Some(any) = self.points.first().map(|p| &p.found.before) else { return String::new() };
        let statements = self.verdict();
        let words = statements.iter().skip(1).map(|s| StudyPart::Text(format!("{}: {}", s.title, s.text)));
        let mut front: Vec<StudyPart> = self.picture().into_iter().map(|f| StudyPart::Figure(Box::new(f))).collect();
        front.extend(words);
        front.push(part(self.table()));
        let limits = self.points.iter().filter_map(|p| {
            let best = p.found.best.as_ref()?;
            Some(vec![p.value.clone(), p.found.limits_in_words(best), p.found.requirements_in_words(best), p.file.clone()])
        });
        let limits = StudyTable {
            caption: "What holds each point back, and its project file".to_owned(),
            columns: vec![
                StudyColumn::Number(self.key.clone()),
                StudyColumn::Text("What limits it".to_owned()),
                StudyColumn::Text("Requirements".to_owned()),
                StudyColumn::Code("File".to_owned()),
            ],
            rows: limits.collect(),
        };
        let sections = vec![
            StudySection { id: "front", title: "Front", parts: front },
            StudySection { id: "limits", title: "What limits the points", parts: vec![part(limits)] },
            StudySection {
                id: "shapes",
                title: "Curves and shapes",
                parts: self.curves().into_iter().chain(self.shapes()).map(|f| StudyPart::Figure(Box::new(f))).collect(),
            },
        ];
        let met = self.points.len() == self.asked && self.points.iter().all(|p| p.requirements() == CheckState::Met);
        let goal = self.points.first().map_or("", |p| p.found.title.as_str());
        page(&StudyPage {
            kind: "Trade-off front".to_owned(),
            title: any.outcome.title.clone(),
            facts: vec![
                ("Mechanism".to_owned(), any.family.clone()),
                ("Project file".to_owned(), input_name.to_owned()),
                ("Goal".to_owned(), goal.to_owned()),
                ("Values".to_owned(), format!("{} = {}", self.key, self.spec)),
            ],
            verdict: (
                if met { CheckState::Met } else { CheckState::Missed },
                statements.first().map_or_else(String::new, |s| s.text.trim_end_matches('.').to_owned()),
            ),
            sections,
            version: any.version.clone(),
            input_name: input_name.to_owned(),
            variant: any.variant.clone(),
            input_sha256: self.input_sha256.clone(),
            command: command.to_owned(),
        })
    }

    /// The goal over the values of the key. Points that miss a requirement lie off the line and have a cross; where the design jumps, the
    /// line is interrupted.
    fn picture(&self) -> Option<Figure> {
        let mut order: Vec<(usize, f64)> = self.points.iter().enumerate().filter_map(|(i, p)| Some((i, p.goal()?))).collect();
        order.sort_by(|a, b| self.points[a.0].si.total_cmp(&self.points[b.0].si));
        if order.is_empty() {
            return None;
        }
        let groups = self.groups();
        let (mut x, mut y, mut last) = (Vec::new(), Vec::new(), None);
        for (i, goal) in self.kept() {
            if last.is_some_and(|last| last != groups[i]) {
                x.push(f64::NAN);
                y.push(f64::NAN);
            }
            last = Some(groups[i]);
            x.push(self.points[i].si);
            y.push(goal);
        }
        let markers = order.iter().map(|(i, goal)| {
            let point = &self.points[*i];
            let met = point.requirements() == CheckState::Met;
            let label = if met { (i + 1).to_string() } else { format!("✗{}", i + 1) };
            let note = if met { String::new() } else { format!("{label}: at {} {}", point.value, requirements(point)) };
            Marker { x: point.si, y: *goal, label, note }
        });
        let unit = self.unit();
        let axis = |name: &'static str, label: &str, unit: Unit| Axis {
            name,
            label: label.to_owned(),
            dimension: unit.dimension().unwrap_or(Dimension::Ratio),
            display: unit,
        };
        let (name, _) = self.goal_name();
        let plot = Plot {
            x: axis("value", &self.key, self.unit.clone()),
            y: axis("goal", &name, unit),
            series: vec![Series { label: "best that meets every requirement".to_owned(), x, y, stroke: Stroke::Main }],
            bands: Vec::new(),
            levels: Vec::new(),
            spans: self.spans(&order, &groups),
            markers: markers.collect(),
            from_zero: false,
        };
        Some(Figure {
            id: "front",
            title: format!("Best {name} over {}", self.key),
            caption: "Numbers are those of the points. A cross marks a point that misses a requirement; the line is interrupted where the \
                      design jumps to another one."
                .to_owned(),
            content: FigureContent::Plot(plot),
        })
    }

    /// Where which design is the best, if there are several; from the middles between points.
    fn spans(&self, order: &[(usize, f64)], groups: &[usize]) -> Vec<VerticalSpan> {
        let mut spans: Vec<(usize, VerticalSpan)> = Vec::new();
        for (at, (i, _)) in order.iter().enumerate() {
            let si = self.points[*i].si;
            let half = |other: Option<&(usize, f64)>| other.map_or(si, |(o, _)| f64::midpoint(si, self.points[*o].si));
            let (from, to) = (half(at.checked_sub(1).and_then(|b| order.get(b))), half(order.get(at + 1)));
            match spans.last_mut().filter(|(group, _)| *group == groups[*i]) {
                Some((_, span)) => span.to = to,
                None => spans.push((groups[*i], VerticalSpan { from, to, label: format!("design {}", groups[*i]), hatched: false })),
            }
        }
        if spans.len() < 2 { Vec::new() } else { spans.into_iter().map(|s| s.1).collect() }
    }

    /// The first, the middle and the last point that have a design, with its report.
    fn shown(&self) -> Vec<(usize, &Report)> {
        let designed: Vec<(usize, &Report)> =
            self.points.iter().enumerate().filter_map(|(i, p)| Some((i, p.found.after.as_ref()?))).collect();
        let mut places = vec![0, designed.len() / 2, designed.len().saturating_sub(1)];
        places.dedup();
        places.into_iter().filter_map(|at| designed.get(at).copied()).collect()
    }

    fn shapes(&self) -> Vec<Figure> {
        let shape = |(id, (i, report)): (&'static str, (usize, &Report))| {
            let (own, scene) = report.figures.iter().find_map(|f| Some((f, f.content.still()?)))?;
            let title = format!("Point {}, {} = {}: {}", i + 1, self.key, self.points[i].value, own.title);
            Some(Figure { id, title, content: FigureContent::Scene(scene), ..own.clone() })
        };
        SHAPES.into_iter().zip(self.shown()).filter_map(shape).collect()
    }

    /// The main curve of the same points.
    fn curves(&self) -> Option<Figure> {
        let shown = self.shown();
        let plot_of = |report: &Report| {
            report.figures.iter().find_map(|f| match &f.content {
                FigureContent::Plot(plot) => Some((f.title.clone(), plot.clone())),
                _ => None,
            })
        };
        let (title, mut plot) = plot_of(shown.first()?.1)?;
        let lines = shown.iter().zip(STROKES).flat_map(|((i, report), stroke)| {
            let own = plot_of(report).map_or_else(Vec::new, |(_, plot)| plot.series);
            let label = format!("point {}, {}", i + 1, self.points[*i].value);
            let main = own.into_iter().filter(|s| s.stroke == Stroke::Main);
            main.map(move |s| Series { label: label.clone(), stroke, ..s })
        });
        plot.series = lines.collect();
        (plot.bands, plot.levels, plot.spans, plot.markers) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Some(Figure {
            id: "front-curves",
            title: format!("{title} of the first, the middle and the last point"),
            caption: format!("Each at its value of {}.", self.key),
            content: FigureContent::Plot(plot),
        })
    }
}

fn part(table: StudyTable) -> StudyPart {
    let columns = table.columns.into_iter().map(|c| match c {
        StudyColumn::Text(title) => (title, PageColumn::Text),
        StudyColumn::Number(title) => (title, PageColumn::Number),
        StudyColumn::Code(title) => (title, PageColumn::Code),
    });
    StudyPart::Table { caption: table.caption, columns: columns.collect(), rows: table.rows }
}

/// `met`, or what is not.
fn requirements(point: &FrontPoint) -> String {
    let Some(after) = &point.found.after else { return "no design".to_owned() };
    let with = |state| after.outcome.checks.iter().filter(move |c| c.required && c.state == state).map(|c| c.title.as_str());
    match point.requirements() {
        CheckState::Met => "met".to_owned(),
        CheckState::Missed => format!("missed: {}", with(CheckState::Missed).collect::<Vec<_>>().join(", ")),
        CheckState::NotAssessed => format!("not assessed: {}", after.outcome.status.kind.word()),
    }
}

/// The strongest of what holds a point back.
fn limited_by(point: &FrontPoint) -> String {
    let Some(best) = &point.found.best else { return "–".to_owned() };
    let mut names: Vec<&str> = Vec::new();
    for active in &best.active {
        if !names.contains(&active.name.as_str()) {
            names.push(&active.name);
        }
    }
    let more = names.len().saturating_sub(MOST_NAMES);
    names.truncate(MOST_NAMES);
    match (names.is_empty(), more) {
        (true, _) => "nothing".to_owned(),
        (false, 0) => names.join(", "),
        (false, more) => format!("{} and {more} more", names.join(", ")),
    }
}
