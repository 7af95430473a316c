//! `[synthesise]`: what a synthesis may use.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::describe::{Describe, Located, Param, Section, Slot, Visitor, Word};

use crate::spec::{BELTS, Bearings};

/// What a synthesis may use.
#[derive(Debug, Default)]
pub(crate) struct Synthesise {
    pub candidates: Slot<u32>,
    pub ratio: Slot<Quantity>,
    pub travel: Slot<Quantity>,
    pub envelope: Section<Envelope>,
    pub friction: Slot<Quantity>,
    pub belt: Slot<&'static str>,
    pub groove: Slot<&'static str>,
    pub groove_angle: Slot<Quantity>,
    pub pitch_ratio: Slot<Quantity>,
    pub anchor_wrap: Slot<Quantity>,
    pub constructions: Slot<Vec<Located<String>>>,
    pub cable_diameters: Slot<Vec<Quantity>>,
    pub input_diameters: Slot<Vec<Quantity>>,
    pub extra_turns_max: Slot<u32>,
    pub cables_max: Slot<u32>,
    pub preload_loss: Slot<Quantity>,
    pub bending_loss: Slot<Quantity>,
    pub bearings: Section<Bearings>,
}

/// Room for the drums with their cables.
#[derive(Debug, Default)]
pub(crate) struct Envelope {
    pub diameter: Slot<Quantity>,
    pub width: Slot<Quantity>,
    pub length: Slot<Quantity>,
}

/// Sections of grooves that a synthesis cuts.
const GROOVES: &[Word] = &[
    Word { word: "round", doc: "a round seat with the pressure of even wear" },
    Word { word: "v", doc: "two flanks: more friction, and more wear" },
];
/// Most cables, and most turns on the input beyond one.
const MOST: f64 = 16.0;

impl Describe for Synthesise {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.count(&Param::new("candidates", "Project files wanted.").within(1.0, 20.0).default("5"), &mut self.candidates);
        let ratio =
            "Turns of the input for one of the output, r₂/r₁ to the middle of the cable; a whole one has every cable in line. Needed.";
        v.quantity(&Param::new("ratio", ratio).within(1.0, 64.0), &mut self.ratio);
        let angle = |key, doc| Param::new(key, doc).of(Dimension::Angle);
        let travel = "Turn of the output from one end of its travel to the other. Needed.";
        v.quantity(&angle("travel", travel).above(0.0, 630.0), &mut self.travel);
        self.envelope.describe(v, &Param::new("envelope", "Room for the drums with their cables; without a side any."));
        let friction = "Coefficient of friction of the cable on the drums, before the groove. Needed.";
        v.quantity(&Param::new("friction", friction).within(0.001, 2.0), &mut self.friction);
        v.choice(&Param::new("belt", "How the spans run.").default("crossed"), BELTS, &mut self.belt);
        v.choice(&Param::new("groove", "Section of the grooves.").default("round"), GROOVES, &mut self.groove);
        let seat = "Angle of the section: over which a round seat touches, by default 135°, or between the flanks of a v, by default 60°.";
        v.quantity(&angle("groove_angle", seat).above(0.0, std::f64::consts::PI), &mut self.groove_angle);
        let pitch = Param::new("pitch_ratio", "Distance of turns on the input drum over the diameter of the cable.");
        v.quantity(&pitch.within(1.0, 10.0).default("1.25"), &mut self.pitch_ratio);
        let guard = "Wrap that stays on the output drum before each termination: slip ends before it, so that it is above 0, as every load makes the cable slip a little.";
        v.quantity(&angle("anchor_wrap", guard).above(0.0, 630.0).default("270 deg"), &mut self.anchor_wrap);
        let names = "Constructions of the catalogue that may be used; by default all whose stiffness, strength and least drum are known.";
        v.names(&Param::new("constructions", names), 1, 32, &mut self.constructions);
        let length = |key, doc| Param::new(key, doc).of(Dimension::Length);
        let cables =
            length("cable_diameters", "Diameters of cable that there are; by default fourteen from 0.5 mm to 6 mm.").within(1e-5, 0.1);
        v.quantities(&cables, 64, &mut self.cable_diameters);
        let inputs = "Input drums to be tried, to the middle of the cable; by default 6 mm to 200 mm by the series R40.";
        v.quantities(&length("input_diameters", inputs).within(1e-4, 10.0), 256, &mut self.input_diameters);
        let turns = Param::new("extra_turns_max", "Most turns on the input drum beyond the single wrap.");
        v.count(&turns.within(0.0, MOST).default("9"), &mut self.extra_turns_max);
        v.count(&Param::new("cables_max", "Most cables side by side.").within(1.0, MOST).default("6"), &mut self.cables_max);
        let loss = "Part of the preload that bedding in and creep take.";
        v.quantity(&Param::new("preload_loss", loss).within(0.0, 0.99).default("0 %"), &mut self.preload_loss);
        let bent = "Part of its tension that a cable loses in bending round the input drum; without it losses are not assessed.";
        v.quantity(&Param::new("bending_loss", bent).within(0.0, 0.5), &mut self.bending_loss);
        self.bearings.describe(v, &Param::new("bearings", "What the shafts turn in, as `design.bearings` of the files written."));
    }
}

impl Describe for Envelope {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let side = |key, doc| Param::new(key, doc).of(Dimension::Length).above(0.0, 20.0);
        v.quantity(&side("diameter", "Largest diameter of the output drum over its cable."), &mut self.diameter);
        v.quantity(&side("width", "Largest length of the drums along their axes."), &mut self.width);
        v.quantity(&side("length", "Largest length over both drums: centre distance and both radii over the cable."), &mut self.length);
    }
}
