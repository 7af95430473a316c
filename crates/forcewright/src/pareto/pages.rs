//! A trade-off for people: words, a table and the page.

use forcewright_base::text::{counted, visible};
use forcewright_base::units::{format_number, format_si};
use forcewright_model::{Axis, CheckState, Figure, FigureContent, Statement, StudyColumn, StudyTable};
use forcewright_report::study::{Pick, Picks, Scatter, ScatterPoint, StudyColumn as PageColumn, StudyPage, StudyPart, StudySection, page};
use forcewright_study::pareto::Stop;

use super::{Goal, Pareto, ParetoDesign};

/// Significant digits of the largest value of a goal, and decimals more, at most, that tell neighbours apart.
const DIGITS: i32 = 4;
const MORE: i32 = 2;
/// Margins below this are shown as less than it.
const LEAST_MARGIN: f64 = 1e-5;
/// Most reasons why designs have no values that are shown.
const MOST_REASONS: usize = 8;
/// Identifiers of the pictures: of two goals, or of each pair of three.
const PICTURES: [&str; 3] = ["front", "front-2", "front-3"];
/// Identifiers of the shapes of the best design of each goal.
const SHAPES: [&str; 3] = ["shape-1", "shape-2", "shape-3"];

impl Pareto {
    /// A value of a goal in its unit, with as many decimals as all others of the front: equal texts are equal values, as far as possible.
    pub(super) fn goal_text(&self, goal: &Goal, si: f64) -> String {
        let place = self.goals.iter().position(|g| g.name == goal.name);
        let own = |d: &ParetoDesign| place.and_then(|at| d.goals.get(at)).map(|v| goal.unit.from_si(*v)).filter(|v| v.is_finite());
        let all: Vec<f64> = self.designs.iter().filter_map(own).collect();
        let shown = goal.unit.from_si(si);
        let Some(decimals) = decimals(&all).filter(|_| shown.is_finite()) else { return format_si(si, &goal.unit, 4) };
        let (number, unit) = (format!("{:.decimals$}", shown + 0.0), goal.unit.pretty());
        if unit.is_empty() { number } else { format!("{number} {unit}") }
    }

    /// The design that is best in a goal.
    fn best(&self, goal: usize) -> Option<usize> {
        let value = |d: &ParetoDesign| d.goals.get(goal).map_or(f64::INFINITY, |v| if self.goals[goal].large { -v } else { *v });
        (0..self.designs.len()).reduce(|a, b| if value(&self.designs[b]) < value(&self.designs[a]) { b } else { a })
    }

    /// What was found, in words.
    pub fn verdict(&self) -> Vec<Statement> {
        let say = |title: &str, text: String| Statement { title: title.to_owned(), text };
        let mut all = vec![say("Front", self.in_one_sentence())];
        for (at, goal) in self.goals.iter().enumerate().filter(|_| self.met()) {
            let Some(best) = self.best(at) else { continue };
            let others = self.goals.iter().zip(&self.designs[best].goals).enumerate().filter(|(i, _)| *i != at);
            let others: Vec<String> = others.map(|(_, (g, v))| format!("`{}` {}", g.name, self.goal_text(g, *v))).collect();
            let value = self.goal_text(goal, self.designs[best].goals[at]);
            let most = if goal.large { "Largest" } else { "Smallest" };
            all.push(say(most, format!("`{}` {value} with {}: design {}.", goal.name, others.join(", "), best + 1)));
        }
        all.push(say("Search", self.search_in_words()));
        if self.search.thinned {
            all.push(say(
                "Thinned",
                format!("The front has more designs than the {} that are kept; the rest lies between them.", self.search.front.len()),
            ));
        }
        if self.search.failed > 0 {
            // As a status it stands before a place.
            let whole =
                |reason: &str| if reason.ends_with("beyond") { format!("{reason} a place before the end") } else { reason.to_owned() };
            let reasons = self.search.reasons.iter().take(MOST_REASONS);
            let reasons = reasons.map(|(reason, count)| format!("{count}: {}", visible(&whole(reason))));
            all.push(say(
                "No values",
                format!("{} of the designs have none. {}.", self.search.failed, reasons.collect::<Vec<_>>().join("; ")),
            ));
        }
        if self.interrupted() {
            all.push(say("Interrupted", "What was found before is kept; the front may be better still.".to_owned()));
        }
        all
    }

    fn in_one_sentence(&self) -> String {
        let kept = if self.all_checks { "every check" } else { "every requirement" };
        let goals: Vec<String> = self.goals.iter().map(|g| format!("`{}`", g.name)).collect();
        match (self.met(), self.designs.first()) {
            (true, _) => {
                let (last, others) = goals.split_last().map_or((String::new(), &[][..]), |(last, others)| (last.clone(), others));
                let goals = format!("{} and {last}", others.join(", "));
                match self.designs.len() {
                    1 => format!("One design keeps {kept}, and none found is better in any of {goals}."),
                    count => format!("{count} designs keep {kept}; none found is better than one of them in {goals} at once."),
                }
            }
            (false, Some(nearest)) => {
                let what = nearest
                    .tightest
                    .as_ref()
                    .map_or_else(String::new, |(check, margin)| format!(": it misses {check} by {}", margin_text(-margin)));
                format!("No design keeps {kept}; the nearest is shown{what}.")
            }
            (false, None) => "No design could be computed.".to_owned(),
        }
    }

    fn search_in_words(&self) -> String {
        let end = match self.search.stop {
            Stop::Generations => "after its generations",
            Stop::Evaluations => "after its evaluations",
            Stop::Settled => "as the front did not grow any more",
            Stop::Exhausted => "as no design was left that had not been computed",
            Stop::Interrupted => "as it was told to",
        };
        let s = &self.search;
        format!(
            "{} in {} of {}, {} of them within the limits; it ended {end}. A search of this kind promises no optimum: more generations and another seed show what is left.",
            counted(s.evaluations, "design"),
            counted(s.history.len(), "generation"),
            self.asked.population,
            s.feasible
        )
    }

    fn headings(&self) -> Vec<(String, PageColumn)> {
        let mut columns = vec![("Design".to_owned(), PageColumn::Number), ("File".to_owned(), PageColumn::Code)];
        columns.extend(self.goals.iter().map(|g| (g.name.clone(), PageColumn::Number)));
        columns.extend(
            self.choices.iter().map(|c| (c.key.clone(), if c.dimension.is_some() { PageColumn::Number } else { PageColumn::Text })),
        );
        columns.extend([("Tightest check".to_owned(), PageColumn::Text), ("Margin".to_owned(), PageColumn::Number)]);
        columns
    }

    fn cells(&self, at: usize) -> Vec<String> {
        let design = &self.designs[at];
        let mut cells = vec![(at + 1).to_string()];
        cells.extend(self.goals.iter().zip(&design.goals).map(|(g, v)| self.goal_text(g, *v)));
        cells.extend(design.values.iter().map(|v| visible(v).into_owned()));
        let (check, margin) = design.tightest.clone().unzip();
        let margin = margin.filter(|m| m.is_finite()).map_or_else(|| "–".to_owned(), margin_text);
        cells.extend([check.unwrap_or_else(|| "–".to_owned()), margin]);
        cells
    }

    /// The designs: file, goals, values, the tightest check.
    pub fn table(&self) -> StudyTable {
        let columns = self.headings().into_iter().map(|(title, column)| match column {
            PageColumn::Text => StudyColumn::Text(title),
            PageColumn::Number => StudyColumn::Number(title),
            PageColumn::Code => StudyColumn::Code(title),
        });
        let file = |d: &ParetoDesign| d.file.as_ref().map_or_else(|| "–".to_owned(), |f| f.0.clone());
        let rows = (0..self.designs.len()).map(|at| {
            let mut cells = self.cells(at);
            cells.insert(1, file(&self.designs[at]));
            cells
        });
        StudyTable { caption: "Designs of the front".to_owned(), columns: columns.collect(), rows: rows.collect() }
    }

    /// `report.html`. `input_name` is the file as the user named it, `command` the command that repeats this run.
    pub fn page(&self, input_name: &str, command: &str) -> String {
        let statements = self.verdict();
        let words = statements.iter().skip(1).map(|s| StudyPart::Text(format!("{}: {}", s.title, s.text)));
        let lines = self.lines().map(|lines| StudyPart::Parallel(Box::new(lines)));
        let clouds = self.pictures().into_iter().map(|s| StudyPart::Scatter(Box::new(s)));
        let front: Vec<StudyPart> = clouds.chain(lines).chain(words).collect();
        let row = |at: usize| Pick { id: anchor(at), cells: self.cells(at), file: self.designs[at].file.as_ref().map(|f| f.0.clone()) };
        let files = self.designs.iter().filter(|d| d.file.is_some()).count();
        let caption = format!(
            "The designs, each with the values that make it and the check that is tightest; {files} have a project file, spread over the front"
        );
        let picks = Picks { caption, columns: self.headings(), rows: (0..self.designs.len()).map(row).collect() };
        let goals = self.goals.iter().map(|g| format!("{} `{}`", if g.large { "maximise" } else { "minimise" }, g.name));
        let vary = self.choices.iter().map(|c| vec![c.key.clone(), c.in_words()]);
        let vary = StudyPart::Table {
            caption: "What was varied".to_owned(),
            columns: vec![("Key".to_owned(), PageColumn::Code), ("Values".to_owned(), PageColumn::Text)],
            rows: vary.collect(),
        };
        let before = &self.before;
        page(&StudyPage {
            kind: "Trade-off".to_owned(),
            title: before.outcome.title.clone(),
            facts: vec![
                ("Mechanism".to_owned(), before.family.clone()),
                ("Project file".to_owned(), input_name.to_owned()),
                ("Goals".to_owned(), goals.collect::<Vec<_>>().join(", ")),
            ],
            verdict: (
                if self.met() { CheckState::Met } else { CheckState::Missed },
                statements.first().map_or_else(String::new, |s| s.text.trim_end_matches('.').to_owned()),
            ),
            sections: vec![
                StudySection { id: "front", title: "Front", parts: front },
                StudySection { id: "designs", title: "Designs", parts: vec![StudyPart::Picks(picks), vary] },
                StudySection { id: "shapes", title: "Shapes", parts: self.shapes() },
            ],
            version: before.version.clone(),
            input_name: input_name.to_owned(),
            variant: before.variant.clone(),
            input_sha256: self.input_sha256.clone(),
            command: command.to_owned(),
        })
    }

    /// The front, or its shadow on the plane of each pair of three goals.
    fn pictures(&self) -> Vec<Scatter> {
        let pairs: &[(usize, usize)] = if self.goals.len() == 2 { &[(0, 1)] } else { &[(0, 1), (0, 2), (1, 2)] };
        let pairs = pairs.iter().filter(|_| self.met()).zip(PICTURES);
        pairs.map(|((x, y), id)| self.picture(*x, *y, id)).collect()
    }

    fn picture(&self, x: usize, y: usize, id: &'static str) -> Scatter {
        let axis = |goal: &Goal, name: &'static str| Axis {
            name,
            label: format!("{} ({})", goal.name, if goal.large { "maximise" } else { "minimise" }),
            dimension: goal.dimension,
            display: goal.unit.clone(),
        };
        let point = |(at, design): (usize, &ParetoDesign)| ScatterPoint {
            x: design.goals[x],
            y: design.goals[y],
            label: format!("Design {}", at + 1),
            leads_to: anchor(at),
            outstanding: design.file.is_some(),
        };
        let (one, other) = (&self.goals[x], &self.goals[y]);
        let seen =
            if self.goals.len() > 2 { " A design may seem worse here than another: it is better in a goal that is not shown." } else { "" };
        Scatter {
            id,
            title: format!("{} over {}", other.name, one.name),
            caption: format!("Each point is a design and leads to its row of the table; those with a ring have a project file.{seen}"),
            x: axis(one, "abscissa"),
            y: axis(other, "ordinate"),
            points: self.designs.iter().enumerate().map(point).collect(),
        }
    }

    /// The pictures of the designs that are best in each goal.
    fn shapes(&self) -> Vec<StudyPart> {
        let mut shown: Vec<usize> = Vec::new();
        let mut parts = Vec::new();
        for ((at, goal), id) in self.goals.iter().enumerate().zip(SHAPES) {
            let Some(best) = self.best(at).filter(|best| !shown.contains(best)) else { continue };
            let Some(report) = &self.designs[best].report else { continue };
            let Some((own, scene)) = report.figures.iter().find_map(|f| Some((f, f.content.still()?))) else { continue };
            shown.push(best);
            let most = if goal.large { "largest" } else { "smallest" };
            let title = format!("Design {}, {most} {}: {}", best + 1, goal.name, own.title);
            parts.push(StudyPart::Figure(Box::new(Figure { id, title, content: FigureContent::Scene(scene), ..own.clone() })));
        }
        parts
    }
}

/// Decimals with which the largest of some values has its digits, and neighbours differ if that takes few more.
fn decimals(all: &[f64]) -> Option<usize> {
    let largest = all.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    // Powers of ten need an exponent, not decimals.
    let exponent = (-5..7).find(|e| largest < forcewright_base::maths::powi(10.0, e + 1)).filter(|_| largest > 1e-5)?;
    let least = (DIGITS - 1 - exponent).max(0);
    let mut sorted = all.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * largest);
    let apart = |decimals: i32| {
        let texts = |v: &f64| format!("{v:.0$}", usize::try_from(decimals).unwrap_or(0));
        sorted.windows(2).all(|pair| texts(&pair[0]) != texts(&pair[1]))
    };
    let decimals = (least..=least + MORE).find(|d| apart(*d)).unwrap_or(least + MORE);
    usize::try_from(decimals).ok()
}

/// A margin in per cent: what is kept is never shown as missed, nor the other way.
fn margin_text(margin: f64) -> String {
    if margin.abs() >= LEAST_MARGIN || margin.abs() <= 0.0 {
        return format!("{} %", format_number(100.0 * margin, 3));
    }
    let least = format_number(100.0 * LEAST_MARGIN, 3);
    if margin > 0.0 { format!("less than {least} %") } else { format!("missed by less than {least} %") }
}

/// The identifier of a design's row.
pub(super) fn anchor(at: usize) -> String {
    format!("design-{}", at + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of a column have as many decimals each, and enough of them that neighbours differ; twins do not stretch it.
    #[test]
    fn columns_tell_neighbours_apart() {
        assert_eq!(decimals(&[0.0233, 0.023_47, 0.040_72]), Some(5));
        assert_eq!(decimals(&[2288.0, 2310.2, 4263.9]), Some(0));
        assert_eq!(decimals(&[2288.1, 2288.3]), Some(1));
        assert_eq!(decimals(&[8.622, 8.622 + 1e-12, 10.42]), Some(2));
        assert_eq!(decimals(&[1.000_01, 1.000_011]), Some(5));
        assert_eq!((decimals(&[3e9]), decimals(&[0.0])), (None, None));
    }

    /// A margin too small for its digits is not shown as none, and one that is missed not as kept.
    #[test]
    fn small_margins_keep_their_side() {
        assert_eq!(margin_text(0.1737), "17.4 %");
        assert_eq!(margin_text(0.0), "0 %");
        assert_eq!(margin_text(3e-8), "less than 0.001 %");
        assert_eq!(margin_text(-f64::MIN_POSITIVE), "missed by less than 0.001 %");
    }
}
