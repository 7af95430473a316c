//! `[synthesise]`: what a synthesis may use.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::data::DataFile;
use forcewright_contract::describe::{Describe, Param, Slot, Visitor, Word};

/// What a synthesis may use.
#[derive(Debug, Default)]
pub(crate) struct Synthesise {
    pub candidates: Slot<u32>,
    pub room: Slot<[Quantity; 2]>,
    pub rolling_arm: Slot<Quantity>,
    pub springs_file: Slot<DataFile>,
    pub extension_max: Slot<Quantity>,
    pub springs_max: Slot<u32>,
    pub wire_grade: Slot<&'static str>,
    pub roller_diameters: Slot<Vec<Quantity>>,
}

/// Grades of EN 10270-1.
const GRADES: &[Word] = &[
    Word { word: "SM", doc: "cold drawn, medium strength, for static loads" },
    Word { word: "DM", doc: "cold drawn, medium strength, for changing loads" },
    Word { word: "SH", doc: "cold drawn, high strength, for static loads" },
    Word { word: "DH", doc: "cold drawn, high strength, for changing loads" },
];

impl Describe for Synthesise {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.count(&Param::new("candidates", "Project files wanted.").within(1.0, 20.0).default("5"), &mut self.candidates);
        let length = |key, doc| Param::new(key, doc).of(Dimension::Length);
        let room = "Width and height of the room for the mechanism over its whole stroke, rollers included.";
        v.point(&length("room", room).above(0.0, 10.0), &mut self.room);
        v.quantity(
            &length("rolling_arm", "Arm of the rolling resistance of the rollers.").within(0.0, 0.1).default("0.03 mm"),
            &mut self.rolling_arm,
        );
        let file = "Springs that there are, a CSV file: `rate / N/mm, rest length / mm, largest length / mm, mass / g`. Without it any rate can be had.";
        v.file(&Param::new("springs_file", file), &mut self.springs_file);
        v.quantity(
            &Param::new("extension_max", "Without `springs_file`: largest length over rest length of a spring.")
                .within(1.05, 5.0)
                .default("2"),
            &mut self.extension_max,
        );
        v.count(&Param::new("springs_max", "Most springs side by side.").within(1.0, 32.0).default("6"), &mut self.springs_max);
        let grade = "Without `springs_file`: grade of the wire of EN 10270-1 of which the springs are wound.";
        v.choice(&Param::new("wire_grade", grade).default("SH"), GRADES, &mut self.wire_grade);
        v.quantities(
            &length("roller_diameters", "Rollers that there are; by default ball bearings from 10 mm to 32 mm.").within(1e-3, 1.0),
            32,
            &mut self.roller_diameters,
        );
    }
}
