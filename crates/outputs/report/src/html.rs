//! The report page: one HTML file without scripts and without requests, for screens, paper and archives.
//!
//! Elements are closed as XML asks, so that the page can be read by XML tools too.

use std::fmt::Write as _;

use forcewright_base::units::{Unit, format_number, format_si};
use forcewright_model::{
    Check, CheckState, Figure, FigureContent, Film, Metric, Plot, Report, Sense, Series, Statement, StatusKind, Stroke, Study, StudyColumn,
};

use crate::escape::{each, escape, path, prose};
use crate::svg;
use crate::table::{Column, Table};
use crate::words::{over_unit, with_minus};

/// The page's style; colours come from [`svg::declarations`].
const STYLE: &str = include_str!("report.css");
/// Significant digits of numbers for people.
const DIGITS: usize = 4;
/// Rows of a figure's data table.
const DATA_ROWS: usize = 25;
/// Nothing may be loaded; styles and pictures stand in the page.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'";

/// The report as one self-contained HTML page.
pub fn page(report: &Report) -> String {
    let sections: String = [
        report.study.as_ref().map_or_else(String::new, study),
        requirements(report),
        own_checks(report),
        warnings(report),
        figures(report),
        metrics(report),
        parameters(report),
        statements("model", "Model and assumptions", &report.model),
        statements("limits", "Limits of validity", &report.limits),
        sources(report),
        work(report),
        provenance(&Provenance::of(report)),
    ]
    .concat();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n{}</head>\n<body>\n{}<main>\n{sections}</main>\n</body>\n</html>\n",
        head(&title(report), &report.version),
        header(report)
    )
}

/// The head of a page.
pub(crate) fn head(title: &str, version: &str) -> String {
    let (light, dark) = (svg::declarations(false), svg::declarations(true));
    // No icon either: browsers would ask the server for one.
    format!(
        "<meta charset=\"utf-8\" />\n<meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\" />\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n<meta name=\"color-scheme\" content=\"light dark\" />\n\
         <meta name=\"generator\" content=\"Forcewright {}\" />\n<title>{}</title>\n<link rel=\"icon\" href=\"data:,\" />\n<style>\n\
         :root{{{light}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}\n{STYLE}</style>\n",
        escape(version),
        escape(title)
    )
}

fn title(report: &Report) -> String {
    match report.outcome.title.trim() {
        "" => report.family.clone(),
        title => title.to_owned(),
    }
}

fn header(report: &Report) -> String {
    let mut facts = vec![("Mechanism", escape(&report.family))];
    if let Some(variant) = &report.variant {
        facts.push(("Variant", escape(variant)));
    }
    facts.push(("Project file", format!("<code>{}</code>", path(&report.input_name))));
    facts.push(("Forcewright", escape(&report.version)));
    let facts = each(facts, |(name, value)| format!("<div><dt>{name}</dt><dd>{value}</dd></div>"));
    format!(
        "<header>\n<p class=\"kind\">Design report</p>\n<h1>{}</h1>\n<dl class=\"facts\">{facts}</dl>\n{}{}</header>\n",
        escape(&title(report)),
        verdict(report),
        status(report)
    )
}

/// How many checks of a kind ended in a way.
fn count(report: &Report, required: bool, state: CheckState) -> usize {
    report.outcome.checks.iter().filter(|c| c.required == required && c.state == state).count()
}

fn verdict(report: &Report) -> String {
    let all = report.outcome.checks.iter().filter(|c| c.required).count();
    let (missed, open) = (count(report, true, CheckState::Missed), count(report, true, CheckState::NotAssessed));
    let (class, mark, text) = match (all, missed, open) {
        (0, ..) => ("open", "–", "No requirements to meet".to_owned()),
        (_, 0, 0) if report.outcome.requirements_met() => {
            ("met", "✓", if all == 1 { "The requirement is met".to_owned() } else { format!("All {all} requirements met") })
        }
        (_, 0, _) => ("open", "?", format!("{open} of {all} requirements not assessed, {} met", all - open)),
        (_, _, 0) => ("missed", "✗", format!("{missed} of {all} requirements missed")),
        _ => ("missed", "✗", format!("{missed} of {all} requirements missed, {open} not assessed")),
    };
    // Rules that nobody asked for decide nothing, but are counted where they are missed.
    let own = report.outcome.checks.len() - all;
    let further = match count(report, false, CheckState::Missed) {
        0 => String::new(),
        missed => format!("; {missed} of {own} further checks missed"),
    };
    format!(
        "<p class=\"verdict {class}\"><span class=\"mark\" aria-hidden=\"true\">{mark}</span> <span><strong>{text}</strong>{further}</span></p>\n"
    )
}

fn status(report: &Report) -> String {
    let status = &report.outcome.status;
    if status.kind == StatusKind::Complete {
        return String::new();
    }
    let advice = status.advice.as_ref().map_or_else(String::new, |a| format!("<br /><span class=\"advice\">→ {}</span>", prose(a)));
    format!(
        "<p class=\"verdict open\" id=\"status\"><span class=\"mark\" aria-hidden=\"true\">!</span> <span><strong>Analysis: {}.</strong> {}{advice}</span></p>\n",
        status.kind.word(),
        prose(&status.message)
    )
}

/// A section with its heading; nothing if there is nothing in it.
pub(crate) fn section(id: &str, title: &str, content: &str) -> String {
    if content.is_empty() {
        return String::new();
    }
    format!("<section id=\"{id}\" aria-labelledby=\"{id}-title\">\n<h2 id=\"{id}-title\">{title}</h2>\n{content}</section>\n")
}

fn state(state: CheckState) -> String {
    let (class, mark) = match state {
        CheckState::Met => ("met", "✓"),
        CheckState::Missed => ("missed", "✗"),
        CheckState::NotAssessed => ("open", "?"),
    };
    format!("<span class=\"state {class}\"><span aria-hidden=\"true\">{mark}</span> {}</span>", state.word())
}

/// A quantity for people, markup.
fn value(si: f64, unit: &Unit) -> String {
    let shown = unit.from_si(si);
    if shown.is_finite() { escape(&with_minus(&format_si(si, unit, DIGITS))) } else { without_number(shown) }
}

/// What stands in place of a number that is none: a dash where it does not exist.
fn without_number(si: f64) -> String {
    if si.is_nan() {
        "–"
    } else if si > 0.0 {
        "∞"
    } else {
        "−∞"
    }
    .to_owned()
}

fn optional(si: Option<f64>, unit: &Unit) -> String {
    si.map_or_else(|| "–".to_owned(), |si| value(si, unit))
}

/// A relative margin as a signed percentage with one decimal; beyond a thousand per cent only that it is beyond.
fn margin(margin: Option<f64>) -> String {
    match margin {
        Some(m) if m > 10.0 => "&gt; +1000 %".to_owned(),
        Some(m) if m < -10.0 => "&lt; −1000 %".to_owned(),
        Some(m) if !m.is_nan() => with_minus(&format!("{:+.1} %", 100.0 * m + 0.0)),
        _ => "–".to_owned(),
    }
}

fn limit(check: &Check) -> String {
    let sign = match check.sense {
        Sense::AtMost => "≤",
        Sense::AtLeast => "≥",
    };
    check.limit.map_or_else(|| "–".to_owned(), |l| format!("{sign} {}", value(l, &check.display)))
}

fn check_table(caption: &str, checks: &[&Check]) -> String {
    if checks.is_empty() {
        return String::new();
    }
    let columns = [
        ("What", Column::Text),
        ("State", Column::Text),
        ("Found", Column::Number),
        ("Limit", Column::Number),
        ("Margin", Column::Number),
        ("Code", Column::Code),
    ];
    let mut table = Table::new("checks", caption, &columns);
    for check in checks {
        let mut what = prose(&check.title);
        if !check.basis.is_empty() {
            let _ = write!(what, "<span class=\"note\">{}</span>", prose(&check.basis));
        }
        if let Some(advice) = &check.advice {
            let _ = write!(what, "<span class=\"advice\">→ {}</span>", prose(advice));
        }
        table.row(&[
            what,
            state(check.state),
            optional(check.value, &check.display),
            limit(check),
            margin(check.margin),
            escape(check.code),
        ]);
    }
    table.finish()
}

fn requirements(report: &Report) -> String {
    let checks: Vec<&Check> = report.outcome.checks.iter().filter(|c| c.required).collect();
    let table = check_table("What the project file asks for, what was found, and the distance to the limit", &checks);
    let content = if table.is_empty() { "<p>The project file asks for nothing.</p>\n".to_owned() } else { table };
    section("requirements", "Requirements", &content)
}

fn own_checks(report: &Report) -> String {
    let checks: Vec<&Check> = report.outcome.checks.iter().filter(|c| !c.required).collect();
    section("checks", "Further checks", &check_table("Rules of this kind of mechanism that apply without being asked for", &checks))
}

fn warnings(report: &Report) -> String {
    let items = each(&report.outcome.warnings, |w| format!("<li><code>{}</code> {}</li>\n", escape(w.code), prose(&w.message)));
    if items.is_empty() {
        return String::new();
    }
    section("warnings", "Warnings", &format!("<ul class=\"warnings\">\n{items}</ul>\n"))
}

/// What the study found that the design comes from.
fn study(study: &Study) -> String {
    let signed = |s: &Statement| Statement { title: s.title.clone(), text: with_minus(&s.text) };
    let mut content = statement_list(&study.verdict.iter().map(signed).collect::<Vec<_>>());
    for own in &study.tables {
        let columns: Vec<(&str, Column)> = own
            .columns
            .iter()
            .map(|column| match column {
                StudyColumn::Text(title) => (title.as_str(), Column::Text),
                StudyColumn::Number(title) => (title.as_str(), Column::Number),
                StudyColumn::Code(title) => (title.as_str(), Column::Code),
            })
            .collect();
        let mut table = Table::new("study", &own.caption, &columns);
        for row in &own.rows {
            let cell = |(text, column): (&String, &(&str, Column))| match column.1 {
                Column::Code => path(text),
                Column::Number => escape(&with_minus(text)),
                Column::Text => prose(&with_minus(text)),
            };
            table.row(&row.iter().zip(&columns).map(cell).collect::<Vec<_>>());
        }
        content.push_str(&table.finish());
    }
    content.extend(study.figures.iter().enumerate().map(|(i, f)| figure(i + 1, f)));
    section("study", &escape(&study.title), &content)
}

fn figures(report: &Report) -> String {
    // Numbered on from those of the study.
    let before = report.study.as_ref().map_or(0, |s| s.figures.len());
    let all: String = report.figures.iter().enumerate().map(|(i, f)| figure(before + i + 1, f)).collect();
    section("figures", "Figures", &all)
}

/// A figure with its words and its values.
pub(crate) fn figure(number: usize, figure: &Figure) -> String {
    let (class, data) = match &figure.content {
        FigureContent::Plot(plot) => ("plot", data_table(number, plot)),
        FigureContent::Bars(_) => ("plot", String::new()),
        FigureContent::Scene(_) | FigureContent::Film(_) | FigureContent::Part(_) => ("scene", String::new()),
    };
    let picture = match &figure.content {
        FigureContent::Film(film) => film_with_buttons(figure, film),
        _ => svg::figure(figure),
    };
    format!(
        "<figure id=\"figure-{}\" class=\"{class}\">\n{}<figcaption><strong>Figure {number}. {}.</strong> {}</figcaption>\n{data}</figure>\n",
        escape(figure.id),
        picture,
        escape(figure.title.trim_end_matches('.')),
        prose(&figure.caption)
    )
}

/// A film with a button for each frame, which arrow keys move between, and a strip of labels, which the pointer moves along. No script:
/// the style of the drawing shows the frame whose button is pressed.
fn film_with_buttons(figure: &Figure, film: &Film) -> String {
    let Some(chosen) = svg::film::chosen(film) else { return svg::figure(figure) };
    let id = format!("film-{}", escape(figure.id));
    let (mut buttons, mut labels) = (String::new(), String::new());
    for (i, frame) in film.frames.iter().enumerate() {
        let class = svg::film::class(i);
        let checked = if i == chosen { " checked=\"checked\"" } else { "" };
        // What is read aloud begins with what is seen.
        let short = svg::film::short_place(film, frame.at);
        let place = format!("{short} {}", film.axis.display.pretty()).trim_end().to_owned();
        let said = if frame.note.is_empty() { place } else { format!("{place}: {}", frame.note) };
        let _ = writeln!(
            buttons,
            "<input type=\"radio\" name=\"{id}\" id=\"{id}-{i}\" class=\"{class}\" aria-label=\"{}\"{checked} />",
            escape(&said)
        );
        let _ = write!(labels, "<label for=\"{id}-{i}\" class=\"f {class}\" title=\"{}\">{}</label>", escape(&said), escape(&short));
    }
    let legend = escape(&over_unit(&film.axis.label, &film.axis.display));
    format!(
        "<fieldset class=\"film\" id=\"{id}\">\n<legend>{legend}</legend>\n{buttons}{}<div class=\"strip\">{labels}</div>\n</fieldset>\n",
        svg::film_for_page(figure, film, &id)
    )
}

/// Some points of every line of a plot, behind a fold.
fn data_table(number: usize, plot: &Plot) -> String {
    let lines: Vec<&Series> = plot.series.iter().filter(|s| s.stroke != Stroke::Area && !s.x.is_empty() && !s.y.is_empty()).collect();
    if lines.is_empty() {
        return String::new();
    }
    let (x, y) = (over_unit(&plot.x.label, &plot.x.display), over_unit(&plot.y.label, &plot.y.display));
    let columns = [("Line", Column::Text), (x.as_str(), Column::Number), (y.as_str(), Column::Number)];
    let mut table = Table::new("data", &format!("Points of figure {number}"), &columns);
    let rows = (DATA_ROWS / lines.len()).max(2);
    for line in lines.iter().take(DATA_ROWS / 2) {
        let count = line.x.len().min(line.y.len());
        let shown = rows.min(count);
        for i in 0..shown {
            let at = if shown > 1 { i * (count - 1) / (shown - 1) } else { 0 };
            let cell = |values: &[f64], unit: &Unit| values.get(at).map_or_else(String::new, |v| number_in(*v, unit));
            table.row(&[escape(&line.label), cell(&line.x, &plot.x.display), cell(&line.y, &plot.y.display)]);
        }
    }
    format!("<details><summary>Values of figure {number}</summary>\n{}</details>\n", table.finish())
}

/// A number without its unit, for tables that name it above.
fn number_in(si: f64, unit: &Unit) -> String {
    let shown = unit.from_si(si);
    if shown.is_finite() { with_minus(&format_number(shown, DIGITS)) } else { without_number(shown) }
}

fn metric_table(caption: &str, metrics: &[&Metric]) -> String {
    if metrics.is_empty() {
        return String::new();
    }
    let columns = [("Meaning", Column::Text), ("Value", Column::Number), ("Name", Column::Code)];
    let mut table = Table::new("metrics", caption, &columns);
    for m in metrics {
        table.row(&[prose(m.doc), value(m.value, &m.display), path(m.name)]);
    }
    table.finish()
}

fn metrics(report: &Report) -> String {
    let (key, other): (Vec<&Metric>, Vec<&Metric>) = report.outcome.metrics.iter().partition(|m| m.key);
    let content = metric_table("Key results", &key) + &metric_table(if key.is_empty() { "All results" } else { "Further results" }, &other);
    section("metrics", "Results", &content)
}

fn parameters(report: &Report) -> String {
    if report.parameters.is_empty() {
        return String::new();
    }
    let columns = [("Path", Column::Code), ("Value", Column::Number), ("Origin", Column::Text), ("Meaning", Column::Text)];
    let mut table = Table::new("parameters", "The design as typed, with tolerances, and where each value comes from", &columns);
    for p in &report.parameters {
        table.row(&[path(&p.path), escape(&with_minus(&p.value)), prose(&p.origin), prose(&p.doc)]);
    }
    section("parameters", "Parameters", &table.finish())
}

fn statements(id: &str, title: &str, statements: &[Statement]) -> String {
    section(id, title, &statement_list(statements))
}

fn statement_list(statements: &[Statement]) -> String {
    let items = each(statements, |s| format!("<div><dt>{}</dt><dd>{}</dd></div>\n", prose(&s.title), prose(&s.text)));
    if items.is_empty() { items } else { format!("<dl class=\"statements\">\n{items}</dl>\n") }
}

fn sources(report: &Report) -> String {
    if report.outcome.sources.is_empty() {
        return String::new();
    }
    let mut table = Table::new(
        "sources",
        "Works whose equations or data were used; cite them with the result",
        &[("Key", Column::Code), ("Work", Column::Text), ("Used for", Column::Text)],
    );
    for s in &report.outcome.sources {
        table.row(&[escape(s.key), prose(s.text), prose(s.used_for)]);
    }
    section("sources", "Sources", &table.finish())
}

fn work(report: &Report) -> String {
    let outcome = &report.outcome;
    let mut content = format!("<p>Analysis: <strong>{}</strong>. {}</p>\n", outcome.status.kind.word(), prose(&outcome.status.message));
    if let Some(error) = outcome.error_estimate {
        let _ = writeln!(content, "<p>Estimated error of the forces: {} of the largest force.</p>", with_minus(&format_number(error, 2)));
    }
    if !outcome.counters.is_empty() {
        let mut table =
            Table::new("counters", "Work done; the same on every machine", &[("Counter", Column::Code), ("Count", Column::Number)]);
        for c in &outcome.counters {
            table.row(&[path(c.name), c.count.to_string()]);
        }
        content.push_str(&table.finish());
    }
    section("accuracy", "Accuracy and work", &content)
}

/// What repeats a result.
pub(crate) struct Provenance<'a> {
    pub(crate) version: &'a str,
    pub(crate) input_name: &'a str,
    pub(crate) variant: Option<&'a str>,
    pub(crate) input_sha256: &'a str,
    pub(crate) command: &'a str,
}

impl<'a> Provenance<'a> {
    fn of(report: &'a Report) -> Self {
        Self {
            version: &report.version,
            input_name: &report.input_name,
            variant: report.variant.as_deref(),
            input_sha256: &report.input_sha256,
            command: &report.command,
        }
    }
}

pub(crate) fn provenance(from: &Provenance<'_>) -> String {
    let variant = from.variant.map_or_else(String::new, |v| format!(", variant <code>{}</code>", escape(v)));
    let content = format!(
        "<dl class=\"statements\">\n<div><dt>Program</dt><dd>Forcewright {}</dd></div>\n\
         <div><dt>Read</dt><dd><code>{}</code>{variant}</dd></div>\n\
         <div><dt>SHA-256 of all read</dt><dd><code class=\"hash\">{}</code></dd></div>\n</dl>\n\
         <p>The same numbers again, on any machine:</p>\n<pre><code>{}</code></pre>\n",
        escape(from.version),
        path(from.input_name),
        escape(from.input_sha256),
        escape(from.command)
    );
    section("provenance", "How to reproduce", &content)
}
