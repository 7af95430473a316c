//! What an optimisation found, in words, tables and figures.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_model::{
    Axis, Check, CheckState, Figure, FigureContent, Item, Look, Plot, Report, Role, Scene, Series, Statement, StatusKind, Stroke, Study,
    StudyColumn, StudyTable,
};
use forcewright_study::nlp::Stop;
use forcewright_study::optimise::{AT_ITS_END, Active, Hold, Run};
use forcewright_study::sampling::Yield;

use super::{Optimised, Robust, Robustness, Rounded, wording};

/// Basins named in a table.
const MOST_BASINS: usize = 12;
/// Runs below which their goals are read from a table rather than from a histogram.
const FEW_RUNS: usize = 8;
/// A violation that needs no word, relative to the scale of its limit.
const KEPT: f64 = 1e-4;

/// What the scatter of making does before and after.
fn robustness_in_words(found: &Robustness) -> String {
    let against = match found.against {
        Robust::Percentile(part) => format!("so far inside that {} % of the designs made keep each", format_number(100.0 * part, 4)),
        Robust::WorstCase => "so far inside that all tolerances at their worst ends keep each".to_owned(),
    };
    let percent = |v: f64| format_number(100.0 * v, 3);
    let part = |drawn: &Option<Yield>| match drawn {
        Some(y) => {
            format!("{} % ({} to {} %)", percent(y.estimate.value), percent(y.estimate.interval.low), percent(y.estimate.interval.high))
        }
        None => "none can be drawn".to_owned(),
    };
    let [before, after] = &found.yields;
    let rest = if found.settled {
        ""
    } else {
        " The limits had not come to rest, or the scatter could not be looked at: not all of this is kept."
    };
    format!(
        "Every limit was moved {against}, by the linearised scatter of {} numbers, looked at {} times. All requirements that a tolerance study sees are met by {} of the designs drawn, by {} of those drawn around the design of the file.{rest}",
        found.scattering,
        found.rounds,
        part(after),
        part(before),
    )
}

impl Optimised {
    /// The report of the design found, with the search before it; of the design of the file where none was found.
    pub fn report(&self, command: &str) -> Report {
        let mut report = self.after.as_ref().unwrap_or(&self.before).clone();
        command.clone_into(&mut report.command);
        report.study = Some(self.study());
        report
    }

    /// Whether the design found meets every requirement over its whole travel.
    pub fn met(&self) -> bool {
        self.after.as_ref().is_some_and(|r| r.outcome.status.kind == StatusKind::Complete && r.outcome.requirements_met())
    }

    /// The search as pages of a report.
    pub fn study(&self) -> Study {
        let mut tables = vec![self.variable_table()];
        tables.extend(self.active_table());
        tables.extend(self.place_table());
        tables.extend(self.basin_table());
        let mut figures = self.figures_of_both();
        figures.extend(self.convergence());
        figures.extend(self.histogram());
        Study { title: "Search for a better design".to_owned(), verdict: self.verdict(), tables, figures }
    }

    /// What was found, in words.
    pub fn verdict(&self) -> Vec<Statement> {
        let say = |title: &str, text: String| Statement { title: title.to_owned(), text };
        let mut all = vec![say("Goal", self.goal_in_words())];
        let Some(best) = &self.best else {
            let status = &self.before.outcome.status;
            let text = format!(
                "No start has a curve over the whole travel, so nothing was searched. The design of the file: {}, {}",
                status.kind.word(),
                status.message
            );
            all.push(say("Search", text));
            return all;
        };
        all.push(say("Requirements", self.requirements_in_words(best)));
        all.extend(self.unseen_in_words().map(|text| say("Not seen by the search", text)));
        all.push(say("What limits it", self.limits_in_words(best)));
        all.push(say("How it ended", self.end_in_words(best)));
        all.extend(self.search.explored.as_ref().map(|found| say("Search", self.explored_in_words(found))));
        if self.search.runs.len() > 1 {
            all.push(say("Starts", self.starts_in_words()));
        }
        all.extend(self.margin_in_words().map(|text| say("Margin", text)));
        all.extend(self.rounded.as_ref().map(|r| say("Sizes", self.sizes_in_words(r))));
        all.extend(self.robustness.as_ref().map(|r| say("Scatter of making", robustness_in_words(r))));
        all
    }

    /// What rounding to sizes did, and what it cost.
    fn sizes_in_words(&self, rounded: &Rounded) -> String {
        let list = rounded.numbers.iter().map(|(path, before, after)| {
            let unit = self.variables.iter().zip(&self.units).find(|(v, _)| v.path == *path).map(|(_, unit)| unit.clone());
            let unit = unit.unwrap_or_else(|| Unit::si(Dimension::Ratio));
            format!("`{path}` from {} to {}", format_si(*before, &unit, 5), format_si(*after, &unit, 5))
        });
        let [before, after] = rounded.goal.map(|goal| self.wording.show(goal));
        let kept = match (rounded.met, rounded.tried) {
            (0, _) => "none of them meets every requirement: the one that misses least is written".to_owned(),
            (met, tried) if met == tried => "all of them meet every requirement".to_owned(),
            (1, _) => "one of them meets every requirement".to_owned(),
            (met, _) => format!("{met} of them meet every requirement"),
        };
        format!(
            "Rounded {}. {} combinations of sizes were tried, the rest searched for again each time; {kept}. Without sizes the goal is {before}, with them {after}.",
            list.collect::<Vec<_>>().join(", "),
            rounded.tried
        )
    }

    fn margin_in_words(&self) -> Option<String> {
        let mut text = String::new();
        if self.reserve.margin > 0.0 {
            let _ = write!(text, "Kept {} % inside every limit, as asked. ", format_number(100.0 * self.reserve.margin, 2));
        }
        if !self.tightened.is_empty() {
            let list = self.tightened.iter().map(|(name, by, unit)| {
                let unit = wording::display(unit, self.after.as_ref().map(|r| &r.outcome));
                format!("{name} by {}", format_si(*by, &unit, 2))
            });
            let list = list.collect::<Vec<_>>().join(", ");
            let _ = write!(
                text,
                "Kept further inside where the full analysis, which looks between the stations of the search, found a limit missed: {list}."
            );
        }
        (!text.is_empty()).then(|| text.trim_end().to_owned())
    }

    /// The goal before and after, SI, of the full analysis where that knows it, with its unit and name.
    pub fn goal(&self) -> (String, Unit, [Option<f64>; 2]) {
        let wording = &self.wording;
        let of = |report: &Report| report.outcome.metric(&wording.objective).map(|m| (m.value, m.display.clone()));
        match (of(&self.before), self.after.as_ref().and_then(of)) {
            (before, Some((after, unit))) => (wording.objective.clone(), unit, [before.map(|b| b.0), Some(after)]),
            (Some((before, unit)), None) => (wording.objective.clone(), unit, [Some(before), None]),
            (None, None) => {
                let after = self.best.as_ref().map(|b| wording.value(b.goal));
                (wording.name.clone(), wording.unit.clone(), [self.goal_before.map(|g| wording.value(g)), after])
            }
        }
    }

    fn goal_in_words(&self) -> String {
        let (name, unit, values) = self.goal();
        let [before, after] = values.map(|v| v.map_or_else(|| "–".to_owned(), |v| format_si(v, &unit, 4)));
        let named = if name == self.wording.objective { String::new() } else { format!(" ({name})") };
        format!("{}{named}: {before} before, {after} after.", self.title)
    }

    pub(crate) fn requirements_in_words(&self, best: &Run) -> String {
        let Some(after) = &self.after else { return String::new() };
        let asked: Vec<_> = after.outcome.checks.iter().filter(|c| c.required).collect();
        let mut missed: Vec<_> = asked.iter().filter(|c| c.state == CheckState::Missed).collect();
        missed.sort_by(|a, b| a.margin.unwrap_or(0.0).total_cmp(&b.margin.unwrap_or(0.0)));
        let open = asked.iter().filter(|c| c.state == CheckState::NotAssessed).count();
        let status = &after.outcome.status;
        let mut text = match (asked.len(), missed.len(), open) {
            (0, ..) => "None are asked for.".to_owned(),
            (1, 0, 0) => "The one asked for is met by the full analysis.".to_owned(),
            (all, 0, 0) => format!("All {all} are met by the full analysis."),
            (all, ..) => {
                let list = missed.iter().map(|c| {
                    let by = c.margin.map_or_else(String::new, |m| format!(" by {} %", format_number(-100.0 * m, 2)));
                    let unseen = if self.unseen.contains(&c.name) { ", which the search does not see" } else { "" };
                    format!("{}{by}{unseen}", c.title)
                });
                let mut list: Vec<String> = list.collect();
                if open > 0 {
                    list.push(format!("{open} not assessed"));
                }
                format!("{} of {all} are missed by the full analysis: {}.", missed.len() + open, list.join("; "))
            }
        };
        if !best.feasible(KEPT) {
            let more = self.more_search();
            let nearest = format!(
                "No design was found that keeps every limit of the search: those missed contradict the others within the ranges. This is the one \
                 that misses least; relax what is missed, widen a range, or try {more}. "
            );
            text.insert_str(0, &nearest);
        }
        if status.kind != StatusKind::Complete {
            let _ = write!(text, " Analysis: {}, {}", status.kind.word(), status.message);
        }
        text
    }

    /// What may find more, of what the search can be given.
    fn more_search(&self) -> &'static str {
        if self.search.explored.is_some() { "more `evaluations`, or another `seed`" } else { "more starts" }
    }

    /// The requirements that were not limits of the search; without those that are met and that the search did not change.
    fn unseen_checks(&self) -> Vec<&Check> {
        let report = self.after.as_ref().unwrap_or(&self.before);
        let bits = |check: &Check| check.value.map(f64::to_bits);
        let changed = |check: &Check| {
            let before = self.before.outcome.checks.iter().find(|c| c.name == check.name);
            check.state != CheckState::Met || before.is_none_or(|b| bits(b) != bits(check))
        };
        let own = report.outcome.checks.iter().filter(|c| c.required && self.unseen.contains(&c.name));
        own.filter(|c| changed(c)).collect()
    }

    fn unseen_in_words(&self) -> Option<String> {
        let titles: Vec<&str> = self.unseen_checks().into_iter().map(|c| c.title.as_str()).collect();
        (!titles.is_empty())
            .then(|| format!("{}. Only the full analysis of the designs found tells whether they are met.", titles.join("; ")))
    }

    pub(crate) fn limits_in_words(&self, best: &Run) -> String {
        let active = both_sides(best);
        if !best.feasible(KEPT) {
            let names: Vec<&str> = active.iter().map(|a| a.name.as_str()).collect();
            return if names.is_empty() { "Not known.".to_owned() } else { format!("In the way of each other: {}.", names.join(", ")) };
        }
        if active.is_empty() && best.kkt_residual.is_infinite() {
            return "Not known: there are no derivatives at the design found.".to_owned();
        }
        if active.is_empty() {
            return "Nothing: the best lies inside all limits and ranges.".to_owned();
        }
        let named = |a: &Active| if a.hold == Hold::Limit { a.name.clone() } else { format!("`{}`", a.name) };
        let mut text = String::new();
        for (hold, title) in [(Hold::Limit, "Limits"), (Hold::Range, "Ends of ranges"), (Hold::Size, "Held at their sizes")] {
            let names: Vec<String> = active.iter().filter(|a| a.hold == hold).map(named).collect();
            if !names.is_empty() {
                let _ = write!(text, "{title}: {}. ", names.join(", "));
            }
        }
        if let Some(strongest) = active.iter().find(|a| a.hold != Hold::Size) {
            let _ = write!(text, "Strongest: {}; 1 % more of it leads to {}.", named(strongest), self.relaxed(best, strongest));
        }
        text.trim_end().to_owned()
    }

    /// The goal with a limit relaxed by one per cent, to first order.
    fn relaxed(&self, best: &Run, active: &Active) -> String {
        let unit = &self.wording.unit;
        let (now, then) = (self.wording.value(best.goal), self.wording.value(best.goal - active.gain));
        let change = format_si(then - now, unit, 2);
        let sign = if then > now { "+" } else { "" };
        format!("{} ({sign}{change})", self.wording.show(best.goal - active.gain))
    }

    fn end_in_words(&self, best: &Run) -> String {
        let evaluations = self.search.evaluations();
        let interrupted = if self.search.interrupted && best.stop != Stop::Interrupted { " Then it was interrupted." } else { "" };
        format!(
            "{}{interrupted} Distance from the conditions of an optimum {}, in {} iterations; {evaluations} designs were computed in all.",
            ending(best.stop),
            format_number(best.kkt_residual, 2),
            best.iterations
        )
    }

    fn starts_in_words(&self) -> String {
        let runs = self.search.runs.len();
        let kept: usize = self.search.basins.iter().map(|b| b.members.len()).sum();
        let rejected = self.search.runs.iter().filter(|r| r.stop == Stop::StartRejected).count();
        let limits = if self.unseen_checks().is_empty() { "every limit" } else { "every limit that the search sees" };
        let mut text = format!("{kept} of {runs} starts led to designs that keep {limits}");
        if let Some(first) = self.search.basins.first() {
            let (count, best) = (self.search.basins.len(), first.members.len());
            let designs = if count == 1 { "1 design".to_owned() } else { format!("{count} different designs") };
            let _ = write!(text, ": {designs}, the best of them reached {best} time{}", if best == 1 { "" } else { "s" });
        }
        if rejected > 0 {
            let _ = write!(text, "; {rejected} could not be computed at their start");
        }
        text + "."
    }

    /// The numbers that varied: rows of path, before, after, range, end.
    pub fn variable_table(&self) -> StudyTable {
        let columns = vec![
            StudyColumn::Code("Variable".to_owned()),
            StudyColumn::Number("Before".to_owned()),
            StudyColumn::Number("After".to_owned()),
            StudyColumn::Number("Range".to_owned()),
            StudyColumn::Text("At its end".to_owned()),
        ];
        let rows = self.variables.iter().zip(&self.units).enumerate().map(|(i, (v, unit))| {
            let after = self.best.as_ref().and_then(|b| b.x.get(i)).copied();
            let end = after.and_then(|x| end_of_range(v, x)).unwrap_or("");
            let range = format!("{} … {}", format_number(unit.from_si(v.lower), 4), format_si(v.upper, unit, 4));
            let after = after.map_or_else(|| "–".to_owned(), |x| format_si(x, unit, 5));
            vec![v.path.clone(), format_si(v.nominal, unit, 5), after, range, end.to_owned()]
        });
        StudyTable { caption: "What varied".to_owned(), columns, rows: rows.collect() }
    }

    /// What holds the best back, with what relaxing it would bring. `None` if nothing does, or it keeps no limits.
    pub fn active_table(&self) -> Option<StudyTable> {
        let best = self.best.as_ref().filter(|b| b.feasible(KEPT) && !b.active.is_empty())?;
        let columns = vec![
            StudyColumn::Text("Limit".to_owned()),
            StudyColumn::Number("At".to_owned()),
            StudyColumn::Number("Places".to_owned()),
            StudyColumn::Number("1 % more of it leads to".to_owned()),
            StudyColumn::Code("Key".to_owned()),
        ];
        let row = |a: &Active| {
            let own = self.variables.iter().zip(&self.units).find(|(v, _)| v.path == a.key).map(|(_, unit)| unit.clone());
            let unit = own.unwrap_or_else(|| wording::display(a.unit, Some(&self.before.outcome)));
            let (name, at) = match a.hold {
                Hold::Limit => (a.name.as_str(), a.bound.abs()),
                Hold::Range => ("end of its range", a.bound),
                Hold::Size => ("held at its size", a.bound),
            };
            vec![name.to_owned(), format_si(at, &unit, 4), a.places.to_string(), self.relaxed(best, a), a.key.clone()]
        };
        let rows = both_sides(best).iter().map(row).collect();
        Some(StudyTable { caption: "What limits the design, the strongest first; a range by 1 % of its width".to_owned(), columns, rows })
    }

    /// Where the starts led. `None` for a single one.
    pub fn basin_table(&self) -> Option<StudyTable> {
        if self.search.runs.len() < 2 || self.search.basins.is_empty() {
            return None;
        }
        let columns = vec![
            StudyColumn::Text("Design".to_owned()),
            StudyColumn::Number("Goal".to_owned()),
            StudyColumn::Number("Starts that led there".to_owned()),
            StudyColumn::Number("First start".to_owned()),
            StudyColumn::Text("How the best of them ended".to_owned()),
        ];
        let rows = self.search.basins.iter().take(MOST_BASINS).enumerate().filter_map(|(i, basin)| {
            let run = self.search.runs.get(basin.best)?;
            let first = basin.members.iter().min().map_or(0, |m| m + 1);
            Some(vec![
                (i + 1).to_string(),
                self.wording.show(run.goal),
                basin.members.len().to_string(),
                first.to_string(),
                ending(run.stop).to_owned(),
            ])
        });
        let rows: Vec<_> = rows.collect();
        let more = if self.search.basins.len() > rows.len() {
            format!(", the best {MOST_BASINS} of {}", self.search.basins.len())
        } else {
            String::new()
        };
        Some(StudyTable { caption: format!("Different designs found{more}"), columns, rows })
    }

    /// Shapes and curves before and after, from the figures of both analyses.
    fn figures_of_both(&self) -> Vec<Figure> {
        let Some(after) = &self.after else { return Vec::new() };
        let pair = |wanted: fn(&FigureContent) -> bool| {
            let new = after.figures.iter().find(|f| wanted(&f.content))?;
            Some((self.before.figures.iter().find(|f| f.id == new.id)?, new))
        };
        let mut figures = Vec::new();
        if let Some((old, new)) = pair(|c| c.still().is_some())
            && let (Some(old), Some(new)) = (old.content.still(), new.content.still())
        {
            figures.push(shapes(&old, &new));
        }
        if let Some((old, new)) = pair(|c| matches!(c, FigureContent::Plot(_)))
            && let (FigureContent::Plot(old), FigureContent::Plot(plot)) = (&old.content, &new.content)
        {
            figures.push(Figure {
                id: "study-curve",
                title: format!("{}, before and after", new.title),
                caption: "Dashed: the design of the file. Bands and marks belong to the design found.".to_owned(),
                content: FigureContent::Plot(curves(old, plot)),
            });
        }
        figures
    }

    /// Goal and violation of the best run, iteration by iteration.
    fn convergence(&self) -> Vec<Figure> {
        let Some(best) = self.best.as_ref().filter(|b| b.history.len() > 1) else { return Vec::new() };
        let x: Vec<f64> = (0..best.history.len()).map(|i| i as f64).collect();
        let iterations = || axis("iteration", "Iteration", Dimension::Ratio, Unit::si(Dimension::Ratio));
        let line = |label: &str, y: Vec<f64>| Series { label: label.to_owned(), x: x.clone(), y, stroke: Stroke::Main };
        let values = best.history.iter().map(|h| self.wording.value(h[0])).collect();
        let label = self.wording.name.clone();
        let y = Axis { name: "goal", label: label.clone(), ..self.goal_axis() };
        let mut figures = vec![Figure {
            id: "study-goal",
            title: "Goal over the iterations".to_owned(),
            caption: "The best design so far, of the last step of the best run, with its repetitions further inside the limits. Where limits are still missed, the goal may get worse.".to_owned(),
            content: FigureContent::Plot(plain(iterations(), y, vec![line(&label, values)])),
        }];
        if best.history.iter().any(|h| h[1] > KEPT) {
            let percent = Unit::parse("%").unwrap_or_else(|_| Unit::si(Dimension::Ratio));
            let y = axis("violation", "Largest miss of a limit", Dimension::Ratio, percent);
            let mut plot = plain(iterations(), y, vec![line("largest miss", best.history.iter().map(|h| h[1]).collect())]);
            plot.from_zero = true;
            figures.push(Figure {
                id: "study-violation",
                title: "Violation over the iterations".to_owned(),
                caption: "Relative to the scale of the limit: its own size, or what is a large change of it.".to_owned(),
                content: FigureContent::Plot(plot),
            });
        }
        figures
    }

    fn goal_axis(&self) -> Axis {
        let unit = self.wording.unit.clone();
        axis("goal", &self.wording.name, unit.dimension().unwrap_or(Dimension::Ratio), unit)
    }

    /// How often which goal was reached, of many starts.
    fn histogram(&self) -> Option<Figure> {
        let goals: Vec<f64> =
            self.search.basins.iter().flat_map(|b| &b.members).map(|m| self.wording.value(self.search.runs[*m].goal)).collect();
        if goals.len() < FEW_RUNS {
            return None;
        }
        let (low, high) = goals.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), g| (l.min(*g), h.max(*g)));
        let bins = goals.len().isqrt().clamp(5, 30);
        let width = (high - low) / bins as f64;
        if width <= 0.0 || !width.is_finite() {
            return None;
        }
        let (mut x, mut y) = (vec![low], vec![0.0]);
        for bin in 0..bins {
            let edge = |i: usize| if i == bins { high } else { low + width * i as f64 };
            let inside = |g: &&f64| **g >= edge(bin) && (**g < edge(bin + 1) || bin + 1 == bins);
            let count = goals.iter().filter(inside).count() as f64;
            x.extend([edge(bin), edge(bin + 1)]);
            y.extend([count, count]);
        }
        x.push(high);
        y.push(0.0);
        let series = vec![Series { label: "starts".to_owned(), x, y, stroke: Stroke::Main }];
        let count = axis("starts", "Starts", Dimension::Ratio, Unit::si(Dimension::Ratio));
        let mut plot = plain(self.goal_axis(), count, series);
        plot.from_zero = true;
        Some(Figure {
            id: "study-goals",
            title: "What the starts reached".to_owned(),
            caption: format!("{} starts whose designs keep every limit, by the goal that they reached.", goals.len()),
            content: FigureContent::Plot(plot),
        })
    }
}

/// What holds a run back; a limit on both sides of zero, as that on stress, once.
pub(super) fn both_sides(run: &Run) -> Vec<Active> {
    let mut all: Vec<Active> = Vec::new();
    for active in &run.active {
        match all.iter_mut().find(|a| a.key == active.key && a.bound.abs().to_bits() == active.bound.abs().to_bits()) {
            Some(known) => {
                known.gain += active.gain;
                known.places += active.places;
            }
            None => all.push(active.clone()),
        }
    }
    all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    all
}

/// A way to end, for people.
pub(super) fn ending(stop: Stop) -> &'static str {
    match stop {
        Stop::Converged => "An optimum near its start: the conditions of an optimum hold to the tolerance.",
        Stop::Settled => "Near an optimum: the last ten iterations gained next to nothing.",
        Stop::Stalled => "No step improves it any more, though the conditions of an optimum are not met to the tolerance.",
        Stop::StalledInfeasible => "No step comes nearer to the limits that are missed; another start may.",
        Stop::Infeasible => "Nothing near it keeps the limits: they contradict each other.",
        Stop::IterationLimit => "Stopped at the most iterations; it could be better still.",
        Stop::Interrupted => "Interrupted; the best so far is kept.",
        Stop::StartRejected => "The design at the start cannot be computed.",
        Stop::Unbounded => "It gets better without end: a limit or a range is missing.",
        Stop::Malformed => "The problem is not well posed: a range is empty.",
    }
}

/// Which end of its range a variable is at.
pub(super) fn end_of_range(variable: &forcewright_study::evaluator::Variable, x: f64) -> Option<&'static str> {
    let near = AT_ITS_END * variable.scale();
    if x - variable.lower <= near {
        Some("lower")
    } else if variable.upper - x <= near {
        Some("upper")
    } else {
        None
    }
}

fn axis(name: &'static str, label: &str, dimension: Dimension, display: Unit) -> Axis {
    Axis { name, label: label.to_owned(), dimension, display }
}

fn plain(x: Axis, y: Axis, series: Vec<Series>) -> Plot {
    Plot { x, y, series, bands: Vec::new(), levels: Vec::new(), spans: Vec::new(), markers: Vec::new(), from_zero: false }
}

/// Both designs as made: the old one as an outline, the new one with its supports.
fn shapes(old: &Scene, new: &Scene) -> Figure {
    let made = |item: &Item, before: bool| match item {
        Item::Line { points, width_m, role: role @ (Role::Undeformed | Role::UndeformedCopy), .. } => {
            let role = match (before, role) {
                (true, role) => *role,
                (false, Role::Undeformed) => Role::Deformed,
                (false, _) => Role::DeformedCopy,
            };
            Some(Item::Line { points: points.clone(), width_m: *width_m, role, values: None })
        }
        Item::Body { corners, role: role @ (Role::Undeformed | Role::UndeformedCopy) } => {
            let role = if before {
                *role
            } else if *role == Role::Undeformed {
                Role::Deformed
            } else {
                Role::DeformedCopy
            };
            Some(Item::Body { corners: corners.clone(), role })
        }
        // What stays is drawn as it is, of the old design its outline only.
        Item::Body { corners, role: Role::Named(Look::Plate, _) } if before => {
            Some(Item::Body { corners: corners.clone(), role: Role::Undeformed })
        }
        Item::Body { role: Role::Named(Look::Plate, _), .. } => Some(item.clone()),
        Item::Line { role: Role::Envelope | Role::Construction, .. } | Item::Support { .. } if !before => Some(item.clone()),
        _ => None,
    };
    let mut items: Vec<Item> = old.items.iter().filter_map(|i| made(i, true)).collect();
    items.extend(new.items.iter().filter_map(|i| made(i, false)));
    Figure {
        id: "study-shapes",
        title: "Shapes as made, before and after".to_owned(),
        caption: "Outline: the design of the file. Filled: the design found. Both without load.".to_owned(),
        content: FigureContent::Scene(Scene {
            items,
            scale: None,
            words: ["before", "after"],
            display: new.display.clone(),
            description: "The design of the file as an outline and the design found, both as made.".to_owned(),
        }),
    }
}

/// The plot of the design found, with the lines of the other behind it.
fn curves(old: &Plot, new: &Plot) -> Plot {
    let mut plot = new.clone();
    for series in &mut plot.series {
        series.label = format!("{}, after", series.label);
    }
    let before = old.series.iter().filter(|s| s.stroke == Stroke::Main);
    let before = before.map(|s| Series { label: format!("{}, before", s.label), stroke: Stroke::Reference, ..s.clone() });
    plot.series = before.chain(plot.series).collect();
    plot
}
