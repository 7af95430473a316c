//! A comparison for scripts: values in SI with their units named.

use serde_json::{Map, Value, json};

use super::{Comparison, MEASURES};
use crate::VERSION;

/// Version of the document's shape.
const SCHEMA: u32 = 1;

impl Comparison {
    /// The result document. Numbers that do not exist are `null`, with the reason beside them.
    pub fn document(&self) -> Value {
        let mechanisms = self.mechanisms.iter().map(|m| {
            let measure = |(name, _, of): &super::Measure| {
                let stated = m.duty.as_ref().map_or_else(
                    || json!({ "value": null, "basis": m.status.message }),
                    |duty| {
                        let cell = of(m, duty);
                        let stated = &cell.stated;
                        json!({ "value": stated.value, "unit": cell.unit(name), "basis": stated.basis, "at_least": stated.at_least })
                    },
                );
                ((*name).to_owned(), stated)
            };
            let measures: Map<String, Value> = MEASURES.iter().map(measure).collect();
            json!({
                "file": m.input_name,
                "input_sha256": m.input_sha256,
                "mechanism": m.mechanism,
                "title": m.title,
                "status": { "kind": m.status.kind.word(), "message": m.status.message },
                "requirements": m.requirements.word(),
                "not_met": m.not_met.iter().map(|(code, title)| json!({ "code": code, "title": title })).collect::<Vec<_>>(),
                "measures": measures,
                "box": m.duty.as_ref().map(|d| json!({ "value": d.sorted_box_m(), "unit": "m", "basis": d.box_basis })),
            })
        });
        json!({
            "schema": SCHEMA,
            "forcewright": VERSION,
            "study": "compare",
            "lever": self.lever_m.map(|m| json!({ "value": m, "unit": "m" })),
            "status": { "kind": if self.interrupted { "interrupted" } else { "complete" } },
            "mechanisms": mechanisms.collect::<Vec<_>>(),
        })
    }
}
