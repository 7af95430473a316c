//! The study as a page for people.

use forcewright_base::units::{Unit, format_number, format_si};
use forcewright_model::CheckState;
use forcewright_report::study::{StudyColumn, StudyPage, StudyPart, StudySection, page};
use forcewright_study::sampling::{Estimate, Yield};
use forcewright_study::tolerance::MOST_SCALE;

use super::Toleranced;

/// Tornados of a page.
const TORNADOS: usize = 4;

impl Toleranced {
    /// `report.html`. `input_name` is the file as the user named it, `command` the command that repeats this run.
    pub fn page(&self, input_name: &str, command: &str) -> String {
        let sections = vec![
            StudySection { id: "yield", title: "Yield", parts: vec![self.yield_table(), self.failures()] },
            StudySection { id: "warnings", title: "Warnings", parts: vec![self.warnings()] },
            StudySection { id: "curves", title: "Curves of all designs", parts: self.fans() },
            StudySection { id: "measures", title: "Distribution of the results", parts: vec![self.measure_table()] },
            StudySection { id: "parameters", title: "What scatters, and what it may", parts: vec![self.parameter_table(), needed_note()] },
            StudySection { id: "causes", title: "What matters", parts: self.causes() },
        ];
        page(&StudyPage {
            kind: "Tolerance study".to_owned(),
            title: self.nominal.outcome.title.clone(),
            facts: vec![
                ("Mechanism".to_owned(), self.nominal.family.clone()),
                ("Project file".to_owned(), input_name.to_owned()),
                ("Designs drawn".to_owned(), format!("{}, seed {}", self.study.all.samples, self.seed)),
            ],
            verdict: (if self.study.target_met() { CheckState::Met } else { CheckState::Missed }, self.verdict()),
            sections,
            version: self.nominal.version.clone(),
            input_name: input_name.to_owned(),
            variant: self.nominal.variant.clone(),
            input_sha256: self.nominal.input_sha256.clone(),
            command: command.to_owned(),
        })
    }

    /// The result in one sentence.
    pub fn verdict(&self) -> String {
        let study = &self.study;
        let sign = if study.target_met() { "reaches" } else { "misses" };
        let stopped = if study.interrupted { " (interrupted)" } else { "" };
        format!("The yield of {} {sign} the target of {}{stopped}", with_interval(&study.all), percent(study.target))
    }

    /// Name and text of each requirement's yield, the whole first: what it is, its limit, the nominal value, the sampled and the
    /// linearised yield.
    pub fn yields(&self) -> Vec<[String; 5]> {
        let study = &self.study;
        let linear = |found: Option<&Yield>| found.map_or_else(|| "–".to_owned(), |y| percent(y.estimate.value));
        let whole = linear(study.linear.as_ref().map(|l| &l.all));
        let mut rows = vec![["all requirements".to_owned(), String::new(), String::new(), with_interval(&study.all), whole]];
        for (place, kept) in study.kept.iter().enumerate() {
            let Some(measure) = study.measures.get(kept.measure) else { continue };
            let unit = self.unit_of(kept.measure);
            let limit = match (measure.lower.is_finite(), measure.upper.is_finite()) {
                (true, true) => format!("{} to {}", format_si(measure.lower, &unit, 4), format_si(measure.upper, &unit, 4)),
                (true, false) => format!("≥ {}", format_si(measure.lower, &unit, 4)),
                _ => format!("≤ {}", format_si(measure.upper, &unit, 4)),
            };
            let nominal = study.nominal_measures.get(kept.measure).copied().flatten();
            let linear = linear(study.linear.as_ref().and_then(|l| l.kept.get(place)).map(|k| &k.found));
            rows.push([measure.name.clone(), limit, optional(nominal, &unit), with_interval(&kept.found), linear]);
        }
        rows
    }

    fn yield_table(&self) -> StudyPart {
        table(
            "Part of the designs that keep to each requirement, with its 95 % interval, and what the Jacobian says",
            &[
                ("Requirement", StudyColumn::Code),
                ("Limit", StudyColumn::Number),
                ("Nominal", StudyColumn::Number),
                ("Yield", StudyColumn::Number),
                ("Linearised", StudyColumn::Number),
            ],
            self.yields().into_iter().map(Vec::from).collect(),
        )
    }

    fn failures(&self) -> StudyPart {
        let rows = self.study.failures.iter().map(|f| vec![f.text.clone(), f.count.to_string()]).collect();
        table("Designs without a curve, which count as missed", &[("Reason", StudyColumn::Text), ("Designs", StudyColumn::Number)], rows)
    }

    fn warnings(&self) -> StudyPart {
        StudyPart::Warnings(self.diagnostics.warnings().iter().map(|w| (w.code.to_owned(), w.message.clone())).collect())
    }

    fn fans(&self) -> Vec<StudyPart> {
        (0..self.study.outputs.len()).filter_map(|i| self.fan(i)).map(|f| StudyPart::Figure(Box::new(f))).collect()
    }

    fn measure_table(&self) -> StudyPart {
        let study = &self.study;
        let rows = study.measures.iter().enumerate().map(|(i, measure)| {
            let unit = self.unit_of(i);
            let at = |p: f64| optional(Some(study.spread.quantile(i, p)), &unit);
            let nominal = study.nominal_measures.get(i).copied().flatten();
            let sd = optional(Some(study.spread.station(i).sd), &unit);
            let missing = study.spread.station(i).missing.to_string();
            vec![measure.name.clone(), optional(nominal, &unit), at(0.01), at(0.05), at(0.5), at(0.95), at(0.99), sd, missing]
        });
        let numbers = ["Nominal", "1 %", "5 %", "Median", "95 %", "99 %", "Standard deviation", "Without value"];
        let mut columns = vec![("Result", StudyColumn::Code)];
        columns.extend(numbers.map(|title| (title, StudyColumn::Number)));
        table("Quantiles of every result over the designs that have a curve", &columns, rows.collect())
    }

    /// Path, tolerance, factor and tolerance that would be needed, of each parameter.
    pub fn needed(&self) -> Vec<[String; 4]> {
        let study = &self.study;
        let each = study.variables.iter().zip(self.population.marginals()).zip(&self.units).enumerate();
        each.map(|(i, ((variable, marginal), unit))| {
            let half = marginal.half_width();
            let found = study.linear.as_ref().and_then(|l| l.needed.iter().find(|n| n.variable == i));
            let [factor, width] = match found.map(|n| n.scale) {
                None => ["–", "–"].map(str::to_owned),
                Some(None) => ["none".to_owned(), "not even 0".to_owned()],
                Some(Some(scale)) => {
                    let sign = if scale >= MOST_SCALE { "≥ " } else { "" };
                    let grade = self.typed.get(i).copied().flatten().and_then(|t| t.coarsest(variable.nominal, 2.0 * scale * half));
                    let grade = grade.map_or_else(String::new, |t| format!(",{}", t.suffix(unit, 3)));
                    [format!("{sign}{}", format_number(scale, 3)), format!("{sign}±{}{grade}", format_si(scale * half, unit, 3))]
                }
            };
            [variable.path.clone(), format!("±{}", format_si(half, unit, 3)), factor, width]
        })
        .collect()
    }

    fn parameter_table(&self) -> StudyPart {
        let study = &self.study;
        let rows = self.needed().into_iter().zip(&study.variables).zip(&self.units).zip(self.population.marginals());
        let rows = rows.map(|(((needed, variable), unit), marginal)| {
            let [path, half, factor, width] = needed;
            vec![
                path,
                format_si(variable.nominal, unit, 5),
                format_si(marginal.mean(), unit, 5),
                half,
                format_si(marginal.sd(), unit, 3),
                factor,
                width,
            ]
        });
        table(
            "Numbers that scatter, and the half width that each would need for the target yield, all others as they are",
            &[
                ("Path", StudyColumn::Code),
                ("Nominal", StudyColumn::Number),
                ("Middle", StudyColumn::Number),
                ("Half width", StudyColumn::Number),
                ("Standard deviation", StudyColumn::Number),
                ("Factor", StudyColumn::Number),
                ("Needed", StudyColumn::Number),
            ],
            rows.collect(),
        )
    }

    fn causes(&self) -> Vec<StudyPart> {
        let study = &self.study;
        let figures = (0..study.limiting.len().min(TORNADOS)).filter_map(|i| self.tornado_figure(i));
        let mut parts: Vec<StudyPart> = figures.map(|f| StudyPart::Figure(Box::new(f))).collect();
        let name = |measure: usize| study.measures.get(measure).map_or("", |m| &m.name);
        let titles: Vec<String> =
            study.shares.iter().flat_map(|s| ["first", "total"].map(|which| format!("{}, {which}", name(s.measure)))).collect();
        let mut columns = vec![("Parameters", StudyColumn::Code)];
        columns.extend(titles.iter().map(|t| (t.as_str(), StudyColumn::Number)));
        let rows = study.factors.iter().enumerate().map(|(factor, members)| {
            let paths: Vec<&str> = members.iter().filter_map(|i| study.variables.get(*i)).map(|v| v.path.as_str()).collect();
            let shares = study.shares.iter().flat_map(|s| [&s.indices.first, &s.indices.total]);
            let cells = shares.map(|all| all.get(factor).map_or_else(|| "–".to_owned(), share));
            std::iter::once(paths.join(" ")).chain(cells).collect()
        });
        if !study.shares.is_empty() {
            parts.push(table("Sobol indices: the share of the variance of each limiting result that goes with a parameter alone (first) and with its interactions (total)", &columns, rows.collect()));
        }
        parts
    }
}

fn table(caption: &str, columns: &[(&str, StudyColumn)], rows: Vec<Vec<String>>) -> StudyPart {
    let columns = columns.iter().map(|(title, column)| ((*title).to_owned(), *column)).collect();
    StudyPart::Table { caption: caption.to_owned(), columns, rows }
}

fn needed_note() -> StudyPart {
    StudyPart::Text(format!(
        "Needed half widths rest on the linearised curves; factors beyond {} are not looked at.",
        format_number(MOST_SCALE, 2)
    ))
}

fn percent(part: f64) -> String {
    if part.is_finite() { format!("{:.1} %", 100.0 * part) } else { "–".to_owned() }
}

/// A yield with its interval.
fn with_interval(found: &Yield) -> String {
    let interval = found.estimate.interval;
    format!("{} ({:.1} to {:.1})", percent(found.estimate.value), 100.0 * interval.low, 100.0 * interval.high)
}

fn share(found: &Estimate) -> String {
    let half = 0.5 * (found.interval.high - found.interval.low);
    if found.value.is_finite() { format!("{:.2} ± {:.2}", found.value + 0.0, half) } else { "–".to_owned() }
}

fn optional(value: Option<f64>, unit: &Unit) -> String {
    value.filter(|v| v.is_finite()).map_or_else(|| "–".to_owned(), |v| format_si(v, unit, 4))
}
