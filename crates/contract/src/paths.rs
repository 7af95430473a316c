//! Visitors that list: the dotted paths of a description, and the rows of a filled one.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_model::ParameterRow;

use crate::data::DataFile;
use crate::describe::{Along, Describe, Form, Located, Members, Origin, Param, Slot, Visitor, Word, member_path};
use crate::tree::Value;

/// Every path that a description knows, members written as `*`: `design.beams.*.bend`.
pub fn keys_of(design: &mut dyn Describe) -> Vec<String> {
    let mut lister = Keys { prefix: String::new(), found: Vec::new() };
    design.describe(&mut lister);
    lister.found
}

/// One row per value given, defaulted or taken from a catalogue, in the order of the description.
pub fn rows_of(design: &mut dyn Describe) -> Vec<ParameterRow> {
    let mut lister = Rows { prefix: String::new(), found: Vec::new() };
    design.describe(&mut lister);
    lister.found
}

struct Keys {
    prefix: String,
    found: Vec<String>,
}

impl Keys {
    fn note(&mut self, param: &Param) {
        self.found.push(format!("{}{}", self.prefix, param.key));
    }

    fn inside(&mut self, part: &str, body: impl FnOnce(&mut Self)) {
        let before = self.prefix.len();
        self.prefix.push_str(part);
        self.prefix.push('.');
        body(self);
        self.prefix.truncate(before);
    }
}

impl Visitor for Keys {
    fn quantity(&mut self, param: &Param, _: &mut Slot<Quantity>) {
        self.note(param);
    }
    fn count(&mut self, param: &Param, _: &mut Slot<u32>) {
        self.note(param);
    }
    fn numbers(&mut self, param: &Param, _: &mut Slot<Vec<f64>>) {
        self.note(param);
    }
    fn quantities(&mut self, param: &Param, _: usize, _: &mut Slot<Vec<Quantity>>) {
        self.note(param);
    }
    fn pairs(&mut self, param: &Param, _: Dimension, _: usize, _: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        self.note(param);
    }
    fn point(&mut self, param: &Param, _: &mut Slot<[Quantity; 2]>) {
        self.note(param);
    }
    fn points(&mut self, param: &Param, _: usize, _: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        self.note(param);
    }
    fn along(&mut self, param: &Param, _: usize, _: &mut Slot<Along>) {
        self.note(param);
    }
    fn deferred(&mut self, param: &Param, _: &mut Slot<Value>) {
        self.note(param);
    }
    fn direction(&mut self, param: &Param, _: &mut Slot<[f64; 2]>) {
        self.note(param);
    }
    fn text(&mut self, param: &Param, _: &mut Slot<String>) {
        self.note(param);
    }
    fn file(&mut self, param: &Param, _: &mut Slot<DataFile>) {
        self.note(param);
    }
    fn flag(&mut self, param: &Param, _: &mut Slot<bool>) {
        self.note(param);
    }
    fn choice(&mut self, param: &Param, _: &'static [Word], _: &mut Slot<&'static str>) {
        self.note(param);
    }
    fn names(&mut self, param: &Param, _: usize, _: usize, _: &mut Slot<Vec<Located<String>>>) {
        self.note(param);
    }
    fn section(&mut self, param: &Param, _: &mut Slot<()>, body: &mut dyn FnMut(&mut dyn Visitor)) {
        self.note(param);
        self.inside(param.key, |lister| body(lister));
    }
    fn members(&mut self, param: &Param, form: Form, members: &mut dyn Members) {
        self.note(param);
        if form == Form::Stages {
            self.inside(param.key, |lister| members.prototype(lister));
        }
        self.inside(&format!("{}.*", param.key), |lister| members.prototype(lister));
    }
    fn tables(&mut self, param: &Param, members: &mut dyn Members) {
        self.note(param);
        self.inside(param.key, |lister| members.prototype(lister));
    }
    fn free(&mut self, param: &Param) {
        self.note(param);
    }
}

struct Rows {
    prefix: String,
    found: Vec<ParameterRow>,
}

impl Rows {
    fn note<T>(&mut self, param: &Param, slot: Option<&Located<T>>, show: impl Fn(&T) -> String) {
        let Some(located) = slot else { return };
        self.found.push(ParameterRow {
            path: format!("{}{}", self.prefix, param.key),
            value: show(&located.value),
            origin: match &located.origin {
                Origin::File => "file".to_owned(),
                Origin::Default => "default".to_owned(),
                Origin::Catalogue(entry) => format!("catalogue: {entry}"),
            },
            doc: param.doc.to_owned(),
        });
    }

    fn inside(&mut self, part: &str, body: impl FnOnce(&mut Self)) {
        let before = self.prefix.len();
        self.prefix.push_str(part);
        self.prefix.push('.');
        body(self);
        self.prefix.truncate(before);
    }
}

fn list<T>(items: &[T], show: impl Fn(&T) -> String) -> String {
    format!("[{}]", items.iter().map(show).collect::<Vec<_>>().join(", "))
}

impl Visitor for Rows {
    fn quantity(&mut self, param: &Param, slot: &mut Slot<Quantity>) {
        self.note(param, slot.as_ref(), ToString::to_string);
    }
    fn count(&mut self, param: &Param, slot: &mut Slot<u32>) {
        self.note(param, slot.as_ref(), ToString::to_string);
    }
    fn numbers(&mut self, param: &Param, slot: &mut Slot<Vec<f64>>) {
        self.note(param, slot.as_ref(), |v| list(v, ToString::to_string));
    }
    fn quantities(&mut self, param: &Param, _: usize, slot: &mut Slot<Vec<Quantity>>) {
        self.note(param, slot.as_ref(), |v| list(v, ToString::to_string));
    }
    fn pairs(&mut self, param: &Param, _: Dimension, _: usize, slot: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        self.note(param, slot.as_ref(), |v| list(v, |p| list(&p.value, ToString::to_string)));
    }
    fn point(&mut self, param: &Param, slot: &mut Slot<[Quantity; 2]>) {
        self.note(param, slot.as_ref(), |v| list(v, ToString::to_string));
    }
    fn points(&mut self, param: &Param, _: usize, slot: &mut Slot<Vec<Located<[Quantity; 2]>>>) {
        self.note(param, slot.as_ref(), |v| list(v, |p| list(&p.value, ToString::to_string)));
    }
    fn along(&mut self, param: &Param, _: usize, slot: &mut Slot<Along>) {
        self.note(param, slot.as_ref(), ToString::to_string);
    }
    fn deferred(&mut self, param: &Param, slot: &mut Slot<Value>) {
        self.note(param, slot.as_ref(), ToString::to_string);
    }
    fn direction(&mut self, param: &Param, slot: &mut Slot<[f64; 2]>) {
        self.note(param, slot.as_ref(), |v| list(v, ToString::to_string));
    }
    fn text(&mut self, param: &Param, slot: &mut Slot<String>) {
        self.note(param, slot.as_ref(), Clone::clone);
    }
    fn file(&mut self, param: &Param, slot: &mut Slot<DataFile>) {
        self.note(param, slot.as_ref(), ToString::to_string);
    }
    fn flag(&mut self, param: &Param, slot: &mut Slot<bool>) {
        self.note(param, slot.as_ref(), ToString::to_string);
    }
    fn choice(&mut self, param: &Param, _: &'static [Word], slot: &mut Slot<&'static str>) {
        self.note(param, slot.as_ref(), |v| (*v).to_owned());
    }
    fn names(&mut self, param: &Param, _: usize, _: usize, slot: &mut Slot<Vec<Located<String>>>) {
        self.note(param, slot.as_ref(), |v| list(v, |n| n.value.clone()));
    }
    fn section(&mut self, param: &Param, _: &mut Slot<()>, body: &mut dyn FnMut(&mut dyn Visitor)) {
        self.inside(param.key, |lister| body(lister));
    }
    fn members(&mut self, param: &Param, _: Form, members: &mut dyn Members) {
        for (index, name) in members.names().into_iter().enumerate() {
            self.inside(&member_path(param.key, &name), |lister| members.describe(index, lister));
        }
    }
    fn tables(&mut self, _: &Param, members: &mut dyn Members) {
        for (index, name) in members.names().into_iter().enumerate() {
            self.inside(&name, |lister| members.describe(index, lister));
        }
    }
}
