//! A front for scripts: a table and a document, values in SI with their units named.

use forcewright_base::units::Dimension;
use forcewright_model::{CheckState, StatusKind};
use forcewright_report::csv;
use serde_json::{Value, json};

use super::{Front, FrontPoint, Origin};
use crate::optimise::document::word;
use crate::sweep::{Column, Kind, table};
use crate::{Optimised, VERSION};

/// Version of the document's shape.
const SCHEMA: u32 = 1;

impl FrontPoint {
    /// All requirements together; not assessed where there is no design, or it does not reach the end of its travel.
    pub fn requirements(&self) -> CheckState {
        let Some(after) = &self.found.after else { return CheckState::NotAssessed };
        let missed = after.outcome.checks.iter().any(|c| c.required && c.state == CheckState::Missed);
        match (missed, self.found.met()) {
            (true, _) => CheckState::Missed,
            (false, true) => CheckState::Met,
            (false, false) => CheckState::NotAssessed,
        }
    }

    /// `start 2` or `point 3`, counted from 1.
    pub(super) fn from(&self) -> String {
        match self.origin {
            Origin::Start(start) => format!("start {}", start + 1),
            Origin::Point(point) => format!("point {}", point + 1),
            Origin::Taken(point) => format!("point {} as it is", point + 1),
        }
    }
}

impl Front {
    /// Numbers of the groups of points, from 1: those of a group follow from each other, from one group to the next the design jumps.
    pub fn groups(&self) -> Vec<usize> {
        let jumps = self.points.iter().scan(1, |group, p| {
            *group += usize::from(!p.follows);
            Some(*group)
        });
        jumps.collect()
    }

    fn columns(&self) -> Vec<Column> {
        let states = [CheckState::Met, CheckState::Missed, CheckState::NotAssessed].map(|s| s.word().to_owned());
        let (name, dimension) = self.goal_name();
        let text = |name: &str| Column { name: name.to_owned(), kind: Kind::Text };
        let mut columns = vec![
            Column::number("point", Dimension::Ratio),
            Column::number(self.key.as_str(), self.unit.dimension().unwrap_or(Dimension::Ratio)),
            Column::number(format!("goal {name}"), dimension),
            Column::words("requirements", states),
            text("status"),
            text("stop"),
            text("from"),
            Column::number("group", Dimension::Ratio),
        ];
        columns.extend(self.metrics.iter().map(|m| Column::number(m.name.as_str(), m.dimension)));
        columns
    }

    /// Name and quantity of the goal.
    pub(super) fn goal_name(&self) -> (String, Dimension) {
        let designed = self.points.iter().find(|p| p.found.best.is_some()).or(self.points.first());
        designed.map_or_else(
            || ("goal".to_owned(), Dimension::Ratio),
            |p| {
                let (name, unit, _) = p.found.goal();
                (name, unit.dimension().unwrap_or(Dimension::Ratio))
            },
        )
    }

    /// `front.csv`: a row per point with every metric of its design, SI with units in the header; cells without a value are empty.
    pub fn csv(&self) -> String {
        let mut out = table::line(self.columns().iter().map(Column::header));
        let number = |value: Option<f64>| value.map_or_else(String::new, csv::number);
        for ((at, point), group) in self.points.iter().enumerate().zip(self.groups()) {
            let outcome = point.found.after.as_ref().map(|r| &r.outcome);
            let mut cells = vec![
                (at + 1).to_string(),
                csv::number(point.si),
                number(point.goal()),
                outcome.map_or_else(String::new, |_| point.requirements().word().to_owned()),
                outcome.map_or_else(String::new, |o| o.status.kind.word().to_owned()),
                point.found.best.as_ref().map_or_else(String::new, |b| word(b.stop).to_owned()),
                outcome.map_or_else(String::new, |_| point.from()),
                group.to_string(),
            ];
            let metric = |name: &str| outcome.and_then(|o| o.metric(name)).map(|m| m.value);
            cells.extend(self.metrics.iter().map(|m| number(metric(&m.name))));
            out += &table::line(cells);
        }
        out
    }

    /// The result document. Numbers that do not exist are `null`.
    pub fn document(&self) -> Value {
        let first = self.points.first().map(|p| &p.found.before.outcome);
        let (name, dimension) = self.goal_name();
        let unit = |dimension: Dimension| dimension.si_symbol();
        let turns = self.turns().into_iter().map(|(a, b)| json!([a + 1, b + 1])).collect::<Vec<_>>();
        json!({
            "schema": SCHEMA,
            "forcewright": VERSION,
            "mechanism": first.map(|o| o.mechanism),
            "study": "front",
            "title": first.map(|o| o.title.as_str()),
            "input_sha256": self.input_sha256,
            "status": { "kind": if self.interrupted { StatusKind::Interrupted.word() } else { StatusKind::Complete.word() } },
            "key": self.key,
            "values": self.spec,
            "unit": self.unit.dimension().map_or("1", unit),
            "asked": self.asked,
            "goal": { "name": name, "unit": unit(dimension), "sense": if self.large() { "maximise" } else { "minimise" } },
            "monotone": turns.is_empty(),
            "turns": turns,
            "points": self.points.iter().zip(self.groups()).map(|(p, group)| point_document(p, group)).collect::<Vec<_>>(),
        })
    }
}

fn point_document(point: &FrontPoint, group: usize) -> Value {
    let outcome = point.found.after.as_ref().map(|r| &r.outcome);
    let metrics = outcome.into_iter().flat_map(|o| &o.metrics);
    let metric = |m: &forcewright_model::Metric| (m.name.to_owned(), json!({ "value": m.value + 0.0, "unit": m.dimension.si_symbol() }));
    let misses = |found: &Optimised| {
        let checks = found.after.iter().flat_map(|r| &r.outcome.checks).filter(|c| c.required && c.state != CheckState::Met);
        checks.map(|c| json!({ "name": c.name, "code": c.code, "state": c.state.word(), "margin": c.margin })).collect::<Vec<_>>()
    };
    json!({
        "value": point.si,
        "typed": point.value,
        "file": point.found.text.as_ref().map(|_| point.file.as_str()),
        "goal": point.goal(),
        "requirements": outcome.map(|_| point.requirements().word()),
        "not_met": misses(&point.found),
        "status": outcome.map(|o| o.status.kind.word()),
        "from": outcome.map(|_| point.from()),
        "group": group,
        "starts": point.starts,
        "evaluations": point.evaluations,
        "metrics": metrics.map(metric).collect::<serde_json::Map<_, _>>(),
        "search": point.found.document(),
    })
}
