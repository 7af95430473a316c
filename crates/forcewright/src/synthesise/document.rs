//! What a synthesis found, as JSON: values in SI with their units named.

use forcewright_report::json;
use serde_json::{Value, json};

use super::{Designed, Synthesised, Way};
use crate::VERSION;

/// Version of the document's shape.
const SCHEMA: u32 = 1;

impl Synthesised {
    /// `result.json`. Numbers that are not finite become `null`.
    pub fn document(&self) -> Value {
        json!({
            "schema": SCHEMA,
            "forcewright": VERSION,
            "title": self.title,
            "input_sha256": self.input_sha256,
            "study": {
                "kind": "synthesise",
                "met": self.met(),
                "interrupted": self.interrupted,
                "analysed": self.analysed,
                "designs": self.designs.iter().map(design).collect::<Vec<_>>(),
                "would_do": self.ways.iter().map(way).collect::<Vec<_>>(),
                "rejected": self.rejected.iter().map(|(shape, why)| json!({ "shape": shape, "why": why })).collect::<Vec<_>>(),
            },
        })
    }
}

fn design(found: &Designed) -> Value {
    let sizes: serde_json::Map<String, Value> =
        found.proposal.sizes.iter().map(|(name, text)| (name.to_lowercase(), json!(text))).collect();
    json!({
        "file": found.file, "shape": found.proposal.topology, "title": found.proposal.title, "met": found.met(),
        "room": { "value": found.proposal.cost, "unit": "m^3" }, "parts": found.proposal.parts, "margin": found.margin(),
        "missed": found.missed().map(|c| json!({ "code": c.code, "name": c.name, "title": c.title, "required": c.required })).collect::<Vec<_>>(),
        "searched": found.searched, "sizes": sizes,
        "result": json::document(&found.report.outcome, &found.report.input_sha256, &found.report.version),
    })
}

fn way(way: &Way) -> Value {
    let relaxation = &way.relaxation;
    json!({
        "key": relaxation.key, "value": relaxation.value, "text": relaxation.text, "now": relaxation.now, "confirmed": way.confirmed,
    })
}
