//! `[measurements.bench]` as it is typed.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::data::DataFile;
use forcewright_contract::describe::{Describe, Param, Reserved, Slot, Visitor};

/// Force on the cable of the input pulley over its turns, for masses on the cable of the output pulley.
#[derive(Debug, Default)]
pub(crate) struct Bench {
    pub file: Slot<DataFile>,
    pub input_pulley: Slot<Quantity>,
    pub output_pulley: Slot<Quantity>,
    pub mass: Slot<String>,
    pub force: Slot<String>,
    pub turn: Slot<String>,
}

const CURVE: &str = "`bench` is the bench with masses; a curve for `forcewright calibrate` has another name: `[measurements.curve]`";
const RESERVED_KEYS: &[Reserved] =
    &[Reserved { key: "x", instead: CURVE, ignored: false }, Reserved { key: "y", instead: CURVE, ignored: false }];

impl Describe for Bench {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.file(&Param::new("file", "Table of masses and forces, and of turns.").required(), &mut self.file);
        let pulley = |key, doc| Param::new(key, doc).of(Dimension::Length).above(0.0, 1.0).required();
        v.quantity(&pulley("input_pulley", "Diameter at the input, to the middle of the cable."), &mut self.input_pulley);
        v.quantity(&pulley("output_pulley", "Diameter at the output, to the middle of the cable."), &mut self.output_pulley);
        v.text(&Param::new("mass", "Header of the column of masses with its unit, `mass / g`.").required(), &mut self.mass);
        v.text(&Param::new("force", "Header of the column of forces with its unit, `F / N`.").required(), &mut self.force);
        let doc = "Header of the column of turns of the input, `turn / turn`: with it means are those of whole turns.";
        v.text(&Param::new("turn", doc), &mut self.turn);
        v.reserved(RESERVED_KEYS);
    }
}
