//! A trade-off for scripts: a table and a document, values in SI with their units named.

use forcewright_base::units::Dimension;
use forcewright_model::StatusKind;
use forcewright_report::csv;
use forcewright_study::pareto::Stop;
use serde_json::{Map, Value, json};

use super::{Choice, Pareto, ParetoDesign};
use crate::VERSION;
use crate::sweep::{Column, Kind, table};

/// Version of the document's shape.
const SCHEMA: u32 = 1;

impl Pareto {
    /// All designs: number, values, goals, the tightest check, the file, then every other metric.
    pub fn csv(&self) -> String {
        let text = |name: &str| Column { name: name.to_owned(), kind: Kind::Text };
        let mut columns = vec![Column::number("design", Dimension::Ratio)];
        columns.extend(self.choices.iter().map(|choice| match choice.dimension {
            Some(dimension) => Column::number(choice.key.as_str(), dimension),
            None => text(&choice.key),
        }));
        columns.extend(self.goals.iter().map(|g| Column::number(format!("goal {}", g.name), g.dimension)));
        columns.extend([text("limits"), text("tightest check"), Column::number("margin", Dimension::Ratio), text("file")]);
        let others: Vec<usize> = (0..self.metrics.len()).filter(|i| !self.goals.iter().any(|g| g.name == self.metrics[*i].name)).collect();
        columns.extend(others.iter().map(|i| Column::number(self.metrics[*i].name.as_str(), self.metrics[*i].dimension)));
        let mut out = table::line(columns.iter().map(Column::header));
        let number = |value: Option<f64>| value.map_or_else(String::new, csv::number);
        for (at, design) in self.designs.iter().enumerate() {
            let mut cells = vec![(at + 1).to_string()];
            cells.extend(self.choices.iter().zip(&design.values).map(|(choice, value)| match choice.dimension {
                Some(_) => number(choice.si(value)),
                None => value.clone(),
            }));
            cells.extend(design.goals.iter().map(|v| number(Some(*v))));
            let (check, margin) = design.tightest.clone().unzip();
            cells.extend([
                if design.met { "kept" } else { "missed" }.to_owned(),
                check.unwrap_or_default(),
                number(margin.filter(|m| m.is_finite())),
                design.file.as_ref().map_or_else(String::new, |f| f.0.clone()),
            ]);
            cells.extend(others.iter().map(|i| number(design.metrics.get(*i).copied().flatten())));
            out += &table::line(cells);
        }
        out
    }

    /// The result document. Numbers that do not exist are `null`.
    pub fn document(&self) -> Value {
        let outcome = &self.before.outcome;
        let goal = |g: &super::Goal| json!({ "name": g.name, "sense": if g.large { "maximise" } else { "minimise" }, "unit": g.dimension.si_symbol() });
        json!({
            "schema": SCHEMA,
            "forcewright": VERSION,
            "mechanism": outcome.mechanism,
            "study": "pareto",
            "title": outcome.title,
            "input_sha256": self.input_sha256,
            "status": { "kind": if self.interrupted() { StatusKind::Interrupted.word() } else { StatusKind::Complete.word() } },
            "goals": self.goals.iter().map(goal).collect::<Vec<_>>(),
            "vary": self.choices.iter().map(vary).collect::<Vec<_>>(),
            "checks": if self.all_checks { "all" } else { "required" },
            "met": self.met(),
            "stop": stop(self.search.stop),
            "thinned": self.search.thinned,
            "designs": self.designs.iter().enumerate().map(|(at, d)| self.design(at, d)).collect::<Vec<_>>(),
            "failures": self.search.reasons.iter().map(|(reason, count)| json!({ "reason": reason, "designs": count })).collect::<Vec<_>>(),
            "counters": {
                "population": self.asked.population,
                "generations": self.search.history.len().saturating_sub(1),
                "seed": self.asked.seed,
                "evaluations": self.search.evaluations,
                "feasible": self.search.feasible,
                "failed": self.search.failed,
            },
        })
    }

    fn design(&self, at: usize, design: &ParetoDesign) -> Value {
        let values = self.choices.iter().zip(&design.values);
        let values = values.map(|(choice, value)| (choice.key.clone(), json!({ "typed": value, "value": choice.si(value) })));
        let metrics = self
            .metrics
            .iter()
            .zip(&design.metrics)
            .filter_map(|(m, v)| Some((m.name.clone(), json!({ "value": (*v)? + 0.0, "unit": m.dimension.si_symbol() }))));
        let tightest = design.tightest.as_ref().map(|(check, margin)| json!({ "check": check, "margin": margin }));
        json!({
            "design": at + 1,
            "file": design.file.as_ref().map(|f| f.0.as_str()),
            "values": values.collect::<Map<_, _>>(),
            "goals": design.goals.iter().map(|v| v + 0.0).collect::<Vec<_>>(),
            "met": design.met,
            "tightest": tightest,
            "metrics": metrics.collect::<Map<_, _>>(),
        })
    }
}

fn vary(choice: &Choice) -> Value {
    json!({ "key": choice.key, "unit": choice.dimension.map(Dimension::si_symbol), "values": choice.in_words() })
}

/// A way to end, for scripts.
fn stop(stop: Stop) -> &'static str {
    match stop {
        Stop::Generations => "generations",
        Stop::Evaluations => "evaluations",
        Stop::Settled => "settled",
        Stop::Exhausted => "exhausted",
        Stop::Interrupted => "interrupted",
    }
}
