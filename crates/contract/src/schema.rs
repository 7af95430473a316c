//! Visitors that document: the JSON schema of a project file, and the table of its parameters.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Quantity, Unit, format_si};
use serde_json::{Map, Value, json};

use crate::data::DataFile;
use crate::describe::{Along, Describe, Form, Located, Members, Param, Reserved, Slot, Visitor, Word};
use crate::tree;

/// JSON schema (draft 2020-12) of a description.
pub fn json_schema(id: &str, title: &str, design: &mut dyn Describe) -> Value {
    let mut schema = object(|v| design.describe(v));
    let mut head = Map::new();
    head.insert("$schema".into(), json!("https://json-schema.org/draft/2020-12/schema"));
    head.insert("title".into(), json!(title));
    head.append(&mut schema);
    if let Some(Value::Object(properties)) = head.get_mut("properties") {
        properties.insert("mechanism".into(), json!({ "const": id, "description": "Family of the mechanism." }));
    }
    // What a file lacks may stand in the file that it extends.
    head.remove("required");
    Value::Object(head)
}

/// Markdown table of every parameter: path, quantity, range, default, meaning.
pub fn markdown(design: &mut dyn Describe) -> String {
    let mut lister = Listing { prefix: String::new(), text: String::new() };
    lister.text.push_str("| key | takes | range | default | meaning |\n| --- | --- | --- | --- | --- |\n");
    design.describe(&mut lister);
    lister.text
}

fn object(body: impl FnOnce(&mut dyn Visitor)) -> Map<String, Value> {
    let mut schema = Schema { properties: Map::new(), required: Vec::new(), others: None };
    body(&mut schema);
    let mut out = Map::new();
    out.insert("type".into(), json!("object"));
    out.insert("additionalProperties".into(), schema.others.unwrap_or(json!(false)));
    if !schema.required.is_empty() {
        out.insert("required".into(), json!(schema.required));
    }
    out.insert("properties".into(), Value::Object(schema.properties));
    out
}

struct Schema {
    properties: Map<String, Value>,
    required: Vec<&'static str>,
    /// What keys that are not listed hold.
    others: Option<Value>,
}

impl Schema {
    fn add(&mut self, param: &Param, mut schema: Value) {
        if let Value::Object(map) = &mut schema {
            map.insert("description".into(), json!(param.doc));
            if let Some(default) = param.default {
                map.insert("default".into(), default.parse::<f64>().map_or_else(|_| json!(default), |n| json!(n)));
            }
        }
        self.properties.insert(param.key.into(), schema);
        if param.required {
            self.required.push(param.key);
        }
    }
}

/// A diameter with a fit.
const FITTED: &str = "17.6 mm h7";
/// A number, then anything: units are checked by the program, which can say what is wrong with them.
const NUMBER_THEN_UNIT: &str = r"^\s*[-+−]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*\S";
const NUMBER_MAYBE_UNIT: &str = r"^\s*[-+−]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?";

fn quantity_schema(param: &Param) -> Value {
    if param.dimension == Dimension::Ratio {
        return json!({ "anyOf": [number_schema(param), { "type": "string", "pattern": NUMBER_MAYBE_UNIT }] });
    }
    let mut examples = vec![param.dimension.example()];
    examples.extend(param.diameter.then_some(FITTED));
    json!({ "type": "string", "pattern": NUMBER_THEN_UNIT, "examples": examples })
}

fn number_schema(param: &Param) -> Value {
    let mut schema = Map::new();
    schema.insert("type".into(), json!("number"));
    if param.range.min.is_finite() {
        schema.insert(if param.range.above { "exclusiveMinimum" } else { "minimum" }.into(), json!(param.range.min));
    }
    if param.range.max.is_finite() {
        schema.insert("maximum".into(), json!(param.range.max));
    }
    Value::Object(schema)
}

impl Visitor for Schema {
    fn quantity(&mut self, param: &Param, _: &mut Slot<Quantity>) {
        self.add(param, quantity_schema(param));
    }
    fn count(&mut self, param: &Param, _: &mut Slot<u32>) {
        let mut schema = number_schema(param);
        schema["type"] = json!("integer");
        self.add(param, schema);
    }
    fn numbers(&mut self, param: &Param, _: &mut Slot<Vec<f64>>) {
        self.add(param, json!({ "type": "array", "items": number_schema(param) }));
    }
    fn quantities(&mut self, param: &Param, most: usize, _: &mut Slot<Vec<Quantity>>) {
        self.add(param, json!({ "type": "array", "items": quantity_schema(param), "minItems": 1, "maxItems": most }));
    }
    fn pairs(&mut self, param: &Param, first: Dimension, most: usize, _: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        let items = [quantity_schema(&Param { dimension: first, ..*param }), quantity_schema(param)];
        let pair = json!({ "type": "array", "prefixItems": items, "minItems": 2, "maxItems": 2 });
        self.add(param, json!({ "type": "array", "items": pair, "minItems": 1, "maxItems": most }));
    }
    fn point(&mut self, param: &Param, _: &mut Slot<[Quantity; 2]>) {
        self.add(param, json!({ "type": "array", "items": quantity_schema(param), "minItems": 2, "maxItems": 2 }));
    }
    fn points(&mut self, param: &Param, most: usize, _: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        let point = json!({ "type": "array", "items": quantity_schema(param), "minItems": 2, "maxItems": 2 });
        self.add(param, json!({ "type": "array", "items": point, "maxItems": most }));
    }
    fn along(&mut self, param: &Param, most: usize, _: &mut Slot<Along>) {
        let pair = json!({ "type": "array", "prefixItems": [{ "type": ["string", "number"] }, quantity_schema(param)], "minItems": 2, "maxItems": 2 });
        let places = json!({ "type": "array", "items": pair, "minItems": 2, "maxItems": most });
        self.add(param, json!({ "anyOf": [quantity_schema(param), places] }));
    }
    fn deferred(&mut self, param: &Param, _: &mut Slot<tree::Value>) {
        let one = json!({ "type": ["number", "string"] });
        self.add(param, json!({ "anyOf": [one, { "type": "array", "items": one }] }));
    }
    fn direction(&mut self, param: &Param, _: &mut Slot<[f64; 2]>) {
        self.add(param, json!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 }));
    }
    fn text(&mut self, param: &Param, _: &mut Slot<String>) {
        self.add(param, json!({ "type": "string" }));
    }
    fn file(&mut self, param: &Param, _: &mut Slot<DataFile>) {
        self.add(param, json!({ "type": "string", "examples": ["data.csv"] }));
    }
    fn flag(&mut self, param: &Param, _: &mut Slot<bool>) {
        self.add(param, json!({ "type": "boolean" }));
    }
    fn choice(&mut self, param: &Param, words: &'static [Word], _: &mut Slot<&'static str>) {
        self.add(param, json!({ "enum": words.iter().map(|w| w.word).collect::<Vec<_>>() }));
    }
    fn names(&mut self, param: &Param, least: usize, most: usize, _: &mut Slot<Vec<Located<String>>>) {
        let list = json!({ "type": "array", "items": { "type": "string" }, "minItems": least, "maxItems": most });
        self.add(param, if least <= 1 { json!({ "anyOf": [list, { "type": "string" }] }) } else { list });
    }
    fn section(&mut self, param: &Param, _: &mut Slot<()>, body: &mut dyn FnMut(&mut dyn Visitor)) {
        self.add(param, Value::Object(object(body)));
    }
    fn members(&mut self, param: &Param, form: Form, members: &mut dyn Members) {
        let mut member = object(|v| members.prototype(v));
        let schema = match form {
            Form::Table => json!({ "type": "object", "additionalProperties": member }),
            Form::Stages => json!({ "anyOf": [member, { "type": "array", "items": member, "minItems": 1 }] }),
            Form::List => {
                if let Some(Value::Object(properties)) = member.get_mut("properties") {
                    properties
                        .insert("name".into(), json!({ "type": "string", "description": "Name, by which paths and reports call it." }));
                }
                // In variants, members of a list are written by name.
                json!({ "type": "array", "items": member })
            }
        };
        self.add(param, schema);
    }
    fn tables(&mut self, param: &Param, members: &mut dyn Members) {
        let mut member = object(|v| members.prototype(v));
        member.insert("description".into(), json!(param.doc));
        self.others = Some(Value::Object(member));
    }
    fn free(&mut self, param: &Param) {
        self.add(param, json!({ "type": "object" }));
    }
    fn reserved(&mut self, keys: &'static [Reserved]) {
        for reserved in keys.iter().filter(|r| r.ignored) {
            self.properties.insert(reserved.key.into(), json!({ "description": reserved.instead }));
        }
    }
}

struct Listing {
    prefix: String,
    text: String,
}

impl Listing {
    fn row(&mut self, param: &Param, takes: &str) {
        let range = range_text(param);
        let default =
            param.default.map_or_else(|| if param.required { "required".to_owned() } else { String::new() }, |d| format!("`{d}`"));
        let doc = param.doc.replace('|', "\\|");
        let _ = writeln!(self.text, "| `{}{}` | {takes} | {range} | {default} | {doc} |", self.prefix, param.key);
    }

    fn inside(&mut self, part: &str, body: impl FnOnce(&mut Self)) {
        let before = self.prefix.len();
        self.prefix.push_str(part);
        self.prefix.push('.');
        body(self);
        self.prefix.truncate(before);
    }
}

fn range_text(param: &Param) -> String {
    let unit = Unit::si(param.dimension);
    let show = |value: f64| format_si(value, &unit, 6);
    let sign = if param.range.above { '>' } else { '≥' };
    match (param.range.min.is_finite(), param.range.max.is_finite()) {
        (true, true) => format!("{sign} {}, ≤ {}", show(param.range.min), show(param.range.max)),
        (true, false) => format!("{sign} {}", show(param.range.min)),
        (false, true) => format!("≤ {}", show(param.range.max)),
        (false, false) => String::new(),
    }
}

impl Visitor for Listing {
    fn quantity(&mut self, param: &Param, _: &mut Slot<Quantity>) {
        let fit = if param.diameter { format!(", or with a fit of ISO 286, `\"{FITTED}\"`") } else { String::new() };
        let takes = format!("{}, `\"{}\"`{fit}", param.dimension.name(), param.dimension.example());
        self.row(param, &takes);
    }
    fn count(&mut self, param: &Param, _: &mut Slot<u32>) {
        self.row(param, "a whole number");
    }
    fn numbers(&mut self, param: &Param, _: &mut Slot<Vec<f64>>) {
        self.row(param, "a list of numbers");
    }
    fn quantities(&mut self, param: &Param, most: usize, _: &mut Slot<Vec<Quantity>>) {
        let takes = format!("1 to {most} of {}, `[\"{}\"]`", param.dimension.name(), param.dimension.example());
        self.row(param, &takes);
    }
    fn pairs(&mut self, param: &Param, first: Dimension, most: usize, _: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        let (name, with) = (first.name(), param.dimension.name());
        let takes = format!("at most {most} pairs of {name} and {with}, `[[\"{}\", \"{}\"]]`", first.example(), param.dimension.example());
        self.row(param, &takes);
    }
    fn point(&mut self, param: &Param, _: &mut Slot<[Quantity; 2]>) {
        let takes = format!("two of {}, `[\"{1}\", \"{1}\"]`", param.dimension.name(), param.dimension.example());
        self.row(param, &takes);
    }
    fn points(&mut self, param: &Param, most: usize, _: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        let takes = format!("at most {most} points of {}, `[[\"{1}\", \"{1}\"]]`", param.dimension.name(), param.dimension.example());
        self.row(param, &takes);
    }
    fn along(&mut self, param: &Param, most: usize, _: &mut Slot<Along>) {
        let (name, example) = (param.dimension.name(), param.dimension.example());
        let takes =
            format!("{name}, `\"{example}\"`; or at 2 to {most} places from 0 to 1, `[[\"0\", \"{example}\"], [\"1\", \"{example}\"]]`");
        self.row(param, &takes);
    }
    fn deferred(&mut self, param: &Param, _: &mut Slot<tree::Value>) {
        self.row(param, "in the unit of what it is for");
    }
    fn direction(&mut self, param: &Param, _: &mut Slot<[f64; 2]>) {
        self.row(param, "a direction, `[0, -1]`");
    }
    fn text(&mut self, param: &Param, _: &mut Slot<String>) {
        self.row(param, "a text");
    }
    fn file(&mut self, param: &Param, _: &mut Slot<DataFile>) {
        self.row(param, "the path of a file, from the folder of this one");
    }
    fn flag(&mut self, param: &Param, _: &mut Slot<bool>) {
        self.row(param, "`true` or `false`");
    }
    fn choice(&mut self, param: &Param, words: &'static [Word], _: &mut Slot<&'static str>) {
        let takes = words.iter().map(|w| format!("`\"{}\"` ({})", w.word, w.doc)).collect::<Vec<_>>().join("; ");
        self.row(param, &takes);
    }
    fn names(&mut self, param: &Param, _: usize, _: usize, _: &mut Slot<Vec<Located<String>>>) {
        self.row(param, "names");
    }
    fn section(&mut self, param: &Param, _: &mut Slot<()>, body: &mut dyn FnMut(&mut dyn Visitor)) {
        self.row(param, "a table");
        self.inside(param.key, |lister| body(lister));
    }
    fn members(&mut self, param: &Param, form: Form, members: &mut dyn Members) {
        let takes = match form {
            Form::Table => "a table with a key per member",
            Form::List => "a list of tables, each with a `name`",
            Form::Stages => "a table, or a list of tables carried out in order (`[[…]]`, paths then count from 1)",
        };
        self.row(param, takes);
        let part = if form == Form::Stages { param.key.to_owned() } else { format!("{}.*", param.key) };
        self.inside(&part, |lister| members.prototype(lister));
    }
    fn tables(&mut self, param: &Param, members: &mut dyn Members) {
        self.row(param, "tables with names of your own");
        self.inside(param.key, |lister| members.prototype(lister));
    }
    fn free(&mut self, param: &Param) {
        self.row(param, "tables of differences");
    }
}
