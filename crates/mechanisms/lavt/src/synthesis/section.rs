//! `[synthesise]`: what a synthesis may use.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::describe::{Describe, Param, Section, Slot, Visitor};

/// What a synthesis may use.
#[derive(Debug, Default)]
pub(crate) struct Synthesise {
    pub candidates: Slot<u32>,
    pub friction: Slot<Quantity>,
    pub bore_friction: Slot<Quantity>,
    pub wire_diameters: Slot<Vec<Quantity>>,
    pub mean_radius: Section<Lengths>,
    pub bore_gap: Section<Lengths>,
    pub gap_differences: Slot<Vec<Quantity>>,
    pub hub_turns: Section<Numbers>,
    pub bore_turns: Section<Numbers>,
    pub free_turns: Slot<Quantity>,
    pub sun: Section<Counts>,
    pub planet: Section<Counts>,
    pub planets: Section<Counts>,
    pub modules: Slot<Vec<Quantity>>,
    pub face_ratio: Slot<Quantity>,
    pub backlash: Slot<Quantity>,
    pub flank_friction: Slot<Quantity>,
    pub tolerances: Section<Tolerances>,
    pub stress_max: Slot<Quantity>,
    pub envelope: Section<Envelope>,
}

/// Lengths from, to, and the step between them.
#[derive(Debug, Default)]
pub(crate) struct Lengths {
    pub min: Slot<Quantity>,
    pub max: Slot<Quantity>,
    pub step: Slot<Quantity>,
}

/// Numbers from, to, and the step between them.
#[derive(Debug, Default)]
pub(crate) struct Numbers {
    pub min: Slot<Quantity>,
    pub max: Slot<Quantity>,
    pub step: Slot<Quantity>,
}

/// Whole numbers from and to.
#[derive(Debug, Default)]
pub(crate) struct Counts {
    pub min: Slot<u32>,
    pub max: Slot<u32>,
}

/// How far made parts lie from the drawing.
#[derive(Debug, Default)]
pub(crate) struct Tolerances {
    pub wire: Slot<Quantity>,
    pub spring: Slot<Quantity>,
    pub hub: Slot<String>,
    pub bore: Slot<String>,
}

/// Room for gears, clutch and chassis.
#[derive(Debug, Default)]
pub(crate) struct Envelope {
    pub diameter: Slot<Quantity>,
    pub length: Slot<Quantity>,
}

/// Most values of a list.
const MOST: usize = 200;

fn length(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).of(Dimension::Length)
}

impl Describe for Synthesise {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.count(&Param::new("candidates", "Project files wanted.").within(1.0, 20.0).default("5"), &mut self.candidates);
        let friction = |key, doc| Param::new(key, doc).within(0.001, 2.0);
        let doc = "Friction of the spring with its range, `\"0.12 ± 0.03\"`: designs keep to everything at both ends of it. Needed.";
        v.quantity(&friction("friction", doc), &mut self.friction);
        v.quantity(&friction("bore_friction", "The same in the bore, where it differs from that on the hub."), &mut self.bore_friction);
        self.spring(v);
        self.gears(v);
        let doc = "How far made parts may lie from the drawing: designs keep to everything at all corners.";
        self.tolerances.describe(v, &Param::new("tolerances", doc));
        let doc = "Largest bending stress of the wire; the 0.7 of its tensile strength hold besides.";
        v.quantity(&Param::new("stress_max", doc).of(Dimension::Stress).above(0.0, 1e13), &mut self.stress_max);
        self.envelope.describe(v, &Param::new("envelope", "Room for gears, clutch and chassis; without a side any."));
    }
}

impl Synthesise {
    fn spring(&mut self, v: &mut dyn Visitor) {
        let doc = "Wires that there are; by default those of EN 10270-1 that makers stock from 0.6 mm to 1.4 mm.";
        v.quantities(&length("wire_diameters", doc).within(5e-5, 0.02), MOST, &mut self.wire_diameters);
        let radius = Param::new("mean_radius", "Mean radii of the free coil r_n; by default 6 mm to 12 mm in steps of 0.1 mm.");
        self.mean_radius.describe(v, &radius);
        let gap = "Radial gaps δ_b from the free coil to the bore; by default 0.2 mm to 1 mm in steps of 0.05 mm.";
        self.bore_gap.describe(v, &Param::new("bore_gap", gap));
        let doc = "By how much the hub is tighter than the bore is wide, δ_a − δ_b on the radius; by default 0, 0.02, 0.05, 0.1, 0.15 and 0.2 mm.";
        v.quantities(&length("gap_differences", doc).within(0.0, 0.01), MOST, &mut self.gap_differences);
        self.hub_turns.describe(v, &Param::new("hub_turns", "Turns on the hub N_A; by default 1 to 6 in steps of 0.5."));
        self.bore_turns.describe(v, &Param::new("bore_turns", "Turns in the bore N_B; by default 1 to 6 in steps of 0.5."));
        let free = Param::new(
            "free_turns",
            "Turns between those on the hub and those in the bore; `free_turns` of the files counts those in the bore too.",
        )
        .above(0.0, 100.0)
        .default("6");
        v.quantity(&free, &mut self.free_turns);
    }

    fn gears(&mut self, v: &mut dyn Visitor) {
        self.sun.describe(v, &Param::new("sun", "Teeth of the sun; by default 10 to 24."));
        self.planet.describe(v, &Param::new("planet", "Teeth of a planet; by default 10 to 60."));
        self.planets.describe(v, &Param::new("planets", "Number of planets; by default 3 and 4."));
        v.quantities(&length("modules", "Modules that there are; by default 0.5 mm.").within(5e-5, 0.05), MOST, &mut self.modules);
        let face = Param::new("face_ratio", "Width of the gears over their module.").within(1.0, 100.0).default("8");
        v.quantity(&face, &mut self.face_ratio);
        let doc = "Circumferential backlash of each mesh, as `design.gears.backlash` of the files written.";
        v.quantity(&length("backlash", doc).within(0.0, 0.01).default("0 mm"), &mut self.backlash);
        let doc = "Friction between flanks, as `design.gears.friction` of the files written; by default they lose nothing.";
        v.quantity(&Param::new("flank_friction", doc).within(0.0, 1.0), &mut self.flank_friction);
    }
}

impl Describe for Lengths {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&length("min", "Smallest value.").above(0.0, 1.0), &mut self.min);
        v.quantity(&length("max", "Largest value.").above(0.0, 1.0), &mut self.max);
        v.quantity(&length("step", "Distance of neighbours.").above(0.0, 1.0), &mut self.step);
    }
}

impl Describe for Numbers {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&Param::new("min", "Smallest value.").above(0.0, 100.0), &mut self.min);
        v.quantity(&Param::new("max", "Largest value.").above(0.0, 100.0), &mut self.max);
        v.quantity(&Param::new("step", "Distance of neighbours.").above(0.0, 100.0), &mut self.step);
    }
}

impl Describe for Counts {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.count(&Param::new("min", "Smallest number.").within(1.0, 500.0), &mut self.min);
        v.count(&Param::new("max", "Largest number.").within(1.0, 500.0), &mut self.max);
    }
}

impl Describe for Tolerances {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let half = |key, doc| length(key, doc).within(0.0, 0.01);
        v.quantity(&half("wire", "± of the wire; by default that of EN 10270-1."), &mut self.wire);
        let doc = "± of the inner diameter of the free spring; by default 0.05 mm. A coil as it comes off the machine has several times as much: sort it, or grind it.";
        v.quantity(&half("spring", doc), &mut self.spring);
        v.text(&Param::new("hub", "Of the hub: an ISO fit, or ± as `\"0.01 mm\"`.").default("h7"), &mut self.hub);
        v.text(&Param::new("bore", "Of the bore: an ISO fit, or ± as `\"0.01 mm\"`.").default("H7"), &mut self.bore);
    }
}

impl Describe for Envelope {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let side = |key, doc| length(key, doc).above(0.0, 20.0);
        v.quantity(&side("diameter", "Largest outer diameter, as the metric `outer_diameter`."), &mut self.diameter);
        v.quantity(&side("length", "Largest length along the axis, as the metric `length`."), &mut self.length);
    }
}
