//! The result document, `result.json`: SI values with their units named.

use forcewright_base::units::Dimension;
use forcewright_model::{Axis, Branch, Check, Curve, Outcome, Sense, Status};
use serde_json::{Map, Value, json};

/// Version of the document's shape.
const SCHEMA: u32 = 1;

/// The result document of an outcome. Numbers that are not finite become `null`, since JSON has none.
pub fn document(outcome: &Outcome, input_sha256: &str, version: &str) -> Value {
    let metrics: Map<String, Value> = outcome.metrics.iter().map(|m| (m.name.to_owned(), quantity(m.value, m.dimension))).collect();
    let counters: Map<String, Value> = outcome.counters.iter().map(|c| (c.name.to_owned(), Value::from(c.count))).collect();
    json!({
        "schema": SCHEMA,
        "forcewright": version,
        "mechanism": outcome.mechanism,
        "title": outcome.title,
        "input_sha256": input_sha256,
        "status": status(&outcome.status, outcome.error_estimate),
        "metrics": metrics,
        "checks": outcome.checks.iter().map(check).collect::<Vec<_>>(),
        "curves": outcome.curves.iter().map(curve).collect::<Vec<_>>(),
        "counters": counters,
        "sources": outcome.sources.iter().map(|s| s.key).collect::<Vec<_>>(),
        "warnings": outcome.warnings.iter().map(|w| json!({ "code": w.code, "message": w.message })).collect::<Vec<_>>(),
    })
}

/// A number; a zero has no sign.
fn number(value: f64) -> Value {
    (value + 0.0).into()
}

fn numbers(values: &[f64]) -> Value {
    values.iter().map(|v| number(*v)).collect()
}

fn quantity(value: f64, dimension: Dimension) -> Value {
    json!({ "value": number(value), "unit": dimension.si_symbol() })
}

fn status(status: &Status, error_estimate: Option<f64>) -> Value {
    let mut out = Map::new();
    out.insert("kind".to_owned(), status.kind.word().into());
    out.insert("message".to_owned(), status.message.clone().into());
    if let Some(advice) = &status.advice {
        out.insert("advice".to_owned(), advice.clone().into());
    }
    if let Some(error) = error_estimate {
        out.insert("error_estimate".to_owned(), number(error));
    }
    Value::Object(out)
}

/// A check as results hold it.
pub fn check(check: &Check) -> Value {
    let sense = match check.sense {
        Sense::AtMost => "at most",
        Sense::AtLeast => "at least",
    };
    let mut out = json!({
        "code": check.code,
        "name": check.name,
        "state": check.state.word(),
        "value": check.value.map(number),
        "limit": check.limit.map(number),
        "unit": check.dimension.si_symbol(),
        "margin": check.margin.map(number),
        "required": check.required,
        "sense": sense,
        "title": check.title,
        "basis": check.basis,
    });
    if let (Some(object), Some(advice)) = (out.as_object_mut(), &check.advice) {
        object.insert("advice".to_owned(), advice.clone().into());
    }
    out
}

fn curve(curve: &Curve) -> Value {
    json!({
        "name": curve.name,
        "x": axis(&curve.x),
        "y": axis(&curve.y),
        "branches": curve.branches.iter().map(branch).collect::<Vec<_>>(),
    })
}

fn axis(axis: &Axis) -> Value {
    json!({ "name": axis.name, "unit": axis.dimension.si_symbol() })
}

fn branch(branch: &Branch) -> Value {
    json!({ "name": branch.name, "x": numbers(&branch.x), "y": numbers(&branch.y) })
}
