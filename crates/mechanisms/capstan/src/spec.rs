//! The project file of a cable drive as it is typed: every parameter is described here, once.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::describe::{Describe, Form, Located, Member, Param, Section, Slot, Visitor, Word};
use forcewright_contract::header::Header;
use forcewright_contract::metrics::Limits;
use forcewright_contract::studies::Studies;

use crate::metrics::CapstanMetrics;
use crate::synthesis::Synthesise;

/// Everything that a project file can say.
#[derive(Debug, Default)]
pub struct Spec {
    /// Schema, family, title.
    pub(crate) header: Header,
    /// `[requirements]`
    pub(crate) requirements: Section<Requirements>,
    /// `[environment]`
    pub(crate) environment: Section<Environment>,
    /// `[design]`
    pub(crate) design: Section<Design>,
    /// `[inertia]`
    pub(crate) inertia: Section<Inertia>,
    /// `[parts]`
    pub(crate) parts: Section<Parts>,
    /// `[model]`
    pub(crate) model: Section<Model>,
    /// `[synthesise]`
    pub(crate) synthesise: Section<Synthesise>,
    /// `[optimise]` and `[tolerance]`
    pub(crate) studies: Studies,
}

/// What the drive must do.
#[derive(Debug, Default)]
pub(crate) struct Requirements {
    pub torque: Slot<Quantity>,
    pub stiffness: Section<StiffnessRequirement>,
    pub lost_motion: Section<LostMotionRequirement>,
    pub safety_factor: Slot<Quantity>,
    pub limits: Section<Limits<CapstanMetrics>>,
}

/// How stiff the output is.
#[derive(Debug, Default)]
pub(crate) struct StiffnessRequirement {
    pub min: Slot<Quantity>,
}

/// What is lost at zero torque.
#[derive(Debug, Default)]
pub(crate) struct LostMotionRequirement {
    pub max: Slot<Quantity>,
}

/// Where it works.
#[derive(Debug, Default)]
pub(crate) struct Environment {
    pub temperature_change: Slot<Quantity>,
}

/// The drive.
#[derive(Debug, Default)]
pub(crate) struct Design {
    pub input_diameter: Slot<Quantity>,
    pub output_diameter: Slot<Quantity>,
    pub centre_distance: Slot<Quantity>,
    pub belt: Slot<&'static str>,
    pub extra_turns: Slot<u32>,
    pub travel: Slot<Quantity>,
    pub hand: Slot<&'static str>,
    pub groove: Section<Groove>,
    pub starts: Slot<u32>,
    pub groove_phase: Slot<Quantity>,
    pub input_setting: Slot<&'static str>,
    pub output_anchor_wrap: Slot<Quantity>,
    pub diameters: Slot<&'static str>,
    pub friction: Slot<Quantity>,
    pub input_hold: Slot<&'static str>,
    pub expansion: Slot<Quantity>,
    pub cables: Vec<Member<Cable>>,
    pub bearings: Section<Bearings>,
}

/// Section of the grooves.
#[derive(Debug, Default)]
pub(crate) struct Groove {
    pub profile: Slot<&'static str>,
    pub pitch: Slot<Quantity>,
    pub seat_angle: Slot<Quantity>,
    pub pressure: Slot<&'static str>,
    pub pressure_table: Slot<Vec<Located<[Quantity; 2]>>>,
    pub angle: Slot<Quantity>,
    pub undercut: Slot<Quantity>,
    pub radius: Slot<Quantity>,
    pub depth: Slot<Quantity>,
}

/// A cable.
#[derive(Debug, Default)]
pub(crate) struct Cable {
    pub catalogue: Slot<String>,
    pub diameter: Slot<Quantity>,
    pub axial_stiffness: Slot<Quantity>,
    pub breaking_force: Slot<Quantity>,
    pub mass: Slot<Quantity>,
    pub min_bend_ratio: Slot<Quantity>,
    pub wire_diameter: Slot<Quantity>,
    pub wire_modulus: Slot<Quantity>,
    pub expansion: Slot<Quantity>,
    pub bending_loss: Slot<Quantity>,
    pub lines: Slot<Vec<f64>>,
    pub preload: Slot<Quantity>,
    pub preload_loss: Slot<Quantity>,
}

/// What the shafts turn in.
#[derive(Debug, Default)]
pub(crate) struct Bearings {
    pub friction: Slot<Quantity>,
    pub input_bore: Slot<Quantity>,
    pub output_bore: Slot<Quantity>,
    pub input_drag: Slot<Quantity>,
    pub output_drag: Slot<Quantity>,
}

/// Moments of inertia.
#[derive(Debug, Default)]
pub(crate) struct Inertia {
    pub input: Slot<Quantity>,
    pub output: Slot<Quantity>,
}

/// How the drums are made.
#[derive(Debug, Default)]
pub(crate) struct Parts {
    pub margin: Slot<Quantity>,
    pub anchor_length: Slot<Quantity>,
    pub input_bore: Slot<Quantity>,
    pub output_bore: Slot<Quantity>,
    pub anchor_hole: Slot<Quantity>,
    pub least_wall: Slot<Quantity>,
    pub print_clearance: Slot<Quantity>,
    pub density: Slot<Quantity>,
}

/// Which equations are solved.
#[derive(Debug, Default)]
pub(crate) struct Model {
    pub source: Slot<&'static str>,
    pub helix_correction: Slot<bool>,
}

/// How the spans run.
pub(crate) const BELTS: &[Word] = &[
    Word { word: "crossed", doc: "between the drums: they turn in opposite directions" },
    Word { word: "open", doc: "outside the drums: they turn in the same direction" },
];
/// Hand of the helix on the input drum.
pub(crate) const HANDS: &[Word] = &[
    Word { word: "right", doc: "as a common screw; the output of a crossed drive is left-handed" },
    Word { word: "left", doc: "the mirror image" },
];
/// Sections of grooves.
pub(crate) const PROFILES: &[Word] = &[
    Word { word: "flat", doc: "a smooth drum" },
    Word { word: "round", doc: "a round seat that touches the cable over `seat_angle`" },
    Word { word: "v", doc: "two flanks with `angle` between them" },
    Word { word: "undercut", doc: "a round seat whose bottom is cut out over `undercut`" },
];
/// Pressure over a round seat.
pub(crate) const PRESSURES: &[Word] = &[
    Word { word: "cosine", doc: "as the cosine of the angle from the bottom: what even wear gives" },
    Word { word: "uniform", doc: "the same everywhere: the largest friction" },
    Word { word: "table", doc: "as `pressure_table` says" },
];
/// What diameters are measured to.
pub(crate) const DIAMETERS: &[Word] = &[
    Word { word: "drum", doc: "to the surface that carries the cable, the bottom of a groove: the cable's own diameter is added" },
    Word { word: "rope centre", doc: "to the middle of the cable" },
];
/// How the cable is held on the input drum.
pub(crate) const HOLDS: &[Word] = &[
    Word { word: "friction", doc: "by its wrap alone: it slips as a whole beyond what friction holds" },
    Word { word: "fastened", doc: "pinned to the drum in the middle of its wrap" },
];
/// Settings of the input drum.
pub(crate) const SETTINGS: &[Word] = &[
    Word { word: "outgoing", doc: "the outgoing span is in line with its grooves, the return span takes the whole mismatch" },
    Word { word: "shared", doc: "so that the largest deviation of all spans is as small as it can be" },
];
/// Models of the statics.
pub(crate) const SOURCES: &[Word] = &[
    Word { word: "corrected", doc: "both sides of a cable share one displacement" },
    Word { word: "paper", doc: "both sides change their tension by the same amount, as Longval & Gosselin have it" },
];

const LARGEST_M: f64 = 10.0;
const SMALLEST_M: f64 = 1e-4;
/// More turns than anybody winds.
const MOST_TURNS: f64 = 100.0;
const MOST_STARTS: f64 = 64.0;
/// Of the output, rad: a hundred turns.
const LARGEST_TRAVEL_RAD: f64 = 630.0;
const MOST_POINTS: usize = 100;

impl Describe for Spec {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.header.describe(v);
        self.requirements.describe(v, &Param::new("requirements", "What the drive must do. Tested, never changed by a study."));
        self.environment.describe(v, &Param::new("environment", "Where it works."));
        self.design.describe(v, &Param::new("design", "The drive.").required());
        self.inertia.describe(v, &Param::new("inertia", "What turns with each drum, the drum itself included: for the resonance."));
        self.parts.describe(v, &Param::new("parts", "The drums that are made. Without influence on the forces."));
        self.model.describe(v, &Param::new("model", "Which equations are solved."));
        let doc = "What `forcewright synthesise` may use: ratio, travel, envelope, friction, cables, drums.";
        self.synthesise.describe(v, &Param::new("synthesise", doc));
        self.studies.describe(v);
    }
}

fn length(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).of(Dimension::Length)
}

fn angle(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).of(Dimension::Angle)
}

fn torque(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).of(Dimension::Torque)
}

fn force(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).of(Dimension::Force).above(0.0, 1e7)
}

impl Describe for Requirements {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let doc = "Torque at the output, both ways, at which stiffness and tensions are taken.";
        v.quantity(&torque("torque", doc).above(0.0, 1e6).required(), &mut self.torque);
        self.stiffness.describe(v, &Param::new("stiffness", "Tangent stiffness at the output at that torque, input held."));
        self.lost_motion.describe(
            v,
            &Param::new("lost_motion", "Turn of the output between the two rests at zero torque, after the torque one way and the other."),
        );
        let doc = "Least breaking force over the largest tension.";
        v.quantity(&Param::new("safety_factor", doc).within(1.0, 100.0), &mut self.safety_factor);
        self.limits.describe(v, &Param::new("limits", "Limits on any metric, by its name."));
    }
}

impl Describe for StiffnessRequirement {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let doc = "Smallest stiffness.";
        v.quantity(&Param::new("min", doc).of(Dimension::RotationalStiffness).above(0.0, 1e12).required(), &mut self.min);
    }
}

impl Describe for LostMotionRequirement {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&angle("max", "Largest full width.").above(0.0, 1.0).required(), &mut self.max);
    }
}

impl Describe for Environment {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let doc =
            "How much warmer it is than when the preload was set; drums and frame expand with `design.expansion`, cables with their own.";
        let change = Param::new("temperature_change", doc).of(Dimension::TemperatureDifference).within(-300.0, 300.0).default("0 K");
        v.quantity(&change, &mut self.temperature_change);
    }
}

impl Describe for Design {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let drum = |key, doc| Param::new(key, doc).diameter().within(SMALLEST_M, LARGEST_M).required();
        v.quantity(&drum("input_diameter", "Diameter of the input drum, 2r₁."), &mut self.input_diameter);
        v.quantity(&drum("output_diameter", "Diameter of the output drum, 2r₂."), &mut self.output_diameter);
        let doc = "Distance d of the two axes.";
        v.quantity(&length("centre_distance", doc).within(SMALLEST_M, LARGEST_M).required(), &mut self.centre_distance);
        v.choice(&Param::new("belt", "How the spans run.").default("crossed"), BELTS, &mut self.belt);
        let doc = "Whole turns n on the input drum beyond the single wrap: its wrap is 2π(n + 1) − 2γ where the belt is crossed.";
        v.count(&Param::new("extra_turns", doc).within(0.0, MOST_TURNS).required(), &mut self.extra_turns);
        let doc = "Turn of the output from one end of its travel to the other.";
        v.quantity(&angle("travel", doc).above(0.0, LARGEST_TRAVEL_RAD).required(), &mut self.travel);
        v.choice(&Param::new("hand", "Hand of the helix on the input drum.").default("right"), HANDS, &mut self.hand);
        self.groove.describe(v, &Param::new("groove", "Section of the grooves, on both drums.").required());
        let doc = "Number S of helices on the output drum; by default the whole number next to the ratio of the radii.";
        v.count(&Param::new("starts", doc).within(1.0, MOST_STARTS), &mut self.starts);
        let doc =
            "By how much the second group of output grooves is turned against the first, in the sense that a shift by one groove is 2π/S.";
        v.quantity(&angle("groove_phase", doc).within(-7.0, 7.0).default("0 deg"), &mut self.groove_phase);
        let setting = Param::new("input_setting", "How the input drum is set along its axis.").default("shared");
        v.choice(&setting, SETTINGS, &mut self.input_setting);
        let doc = "Wrap that stays on the output drum before each termination at the end of the travel.";
        let guard = angle("output_anchor_wrap", doc).within(0.0, LARGEST_TRAVEL_RAD).default("180 deg");
        v.quantity(&guard, &mut self.output_anchor_wrap);
        v.choice(&Param::new("diameters", "What the diameters are measured to.").default("drum"), DIAMETERS, &mut self.diameters);
        let doc = "Coefficient of friction μ of the cable on the drums, before the groove.";
        v.quantity(&Param::new("friction", doc).within(0.001, 2.0).required(), &mut self.friction);
        v.choice(&Param::new("input_hold", "How the cable is held on the input drum.").default("friction"), HOLDS, &mut self.input_hold);
        let expansion = Param::new("expansion", "Thermal expansion of drums and frame.").of(Dimension::ThermalExpansion);
        v.quantity(&expansion.within(-1e-4, 1e-3), &mut self.expansion);
        v.members(&Param::new("cables", "The cables, `[[design.cables]]`.").required(), Form::Stages, &mut self.cables);
        self.bearings.describe(v, &Param::new("bearings", "What the shafts turn in: for backdriving and efficiency."));
    }
}

impl Describe for Groove {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.choice(&Param::new("profile", "Section.").required(), PROFILES, &mut self.profile);
        let doc = "Distance p of neighbouring turns on the input drum, along its axis.";
        v.quantity(&length("pitch", doc).within(SMALLEST_M, 1.0).required(), &mut self.pitch);
        let part = |key, doc| angle(key, doc).above(0.0, std::f64::consts::PI);
        v.quantity(&part("seat_angle", "Round: angle over which the seat touches the cable, both halves together."), &mut self.seat_angle);
        v.choice(&Param::new("pressure", "Round: pressure over the seat.").default("cosine"), PRESSURES, &mut self.pressure);
        let table = Param::new(
            "pressure_table",
            "Pressure over the angle from the bottom, `[[\"0 deg\", 1], [\"60 deg\", 0.5]]`; its size does not matter.",
        );
        v.pairs(&table.within(0.0, 1e12), Dimension::Angle, MOST_POINTS, &mut self.pressure_table);
        v.quantity(&part("angle", "V: angle between the flanks."), &mut self.angle);
        v.quantity(&part("undercut", "Undercut: angle over which the bottom of the seat is cut out."), &mut self.undercut);
        v.quantity(
            &length("radius", "Round: radius of the seat; by default 0.53 of the cable's diameter.").above(0.0, 1.0),
            &mut self.radius,
        );
        v.quantity(&length("depth", "Depth of the groove; by default what its seat needs.").above(0.0, 1.0), &mut self.depth);
    }
}

impl Describe for Cable {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let doc = "Construction of the catalogue, with a diameter: `\"steel 7x19 1.5 mm\"`; the keys below override its values.";
        v.text(&Param::new("use", doc), &mut self.catalogue);
        v.quantity(&Param::new("diameter", "Nominal diameter.").of(Dimension::Length).within(1e-5, 0.1), &mut self.diameter);
        v.quantity(&force("axial_stiffness", "Force over strain, AE."), &mut self.axial_stiffness);
        v.quantity(&force("breaking_force", "Breaking force of the straight cable."), &mut self.breaking_force);
        v.quantity(&Param::new("mass", "Mass per length.").of(Dimension::LineDensity).above(0.0, 100.0), &mut self.mass);
        let doc = "Least ratio of the drum's diameter, to the middle of the cable, to that of the cable.";
        v.quantity(&Param::new("min_bend_ratio", doc).above(0.0, 1e3), &mut self.min_bend_ratio);
        v.quantity(&length("wire_diameter", "Diameter of its outer wires.").above(0.0, 0.1), &mut self.wire_diameter);
        v.quantity(
            &Param::new("wire_modulus", "Young's modulus of the wires.").of(Dimension::Stress).above(0.0, 1e13),
            &mut self.wire_modulus,
        );
        let expansion = Param::new("expansion", "Thermal expansion along the cable.").of(Dimension::ThermalExpansion);
        v.quantity(&expansion.within(-1e-4, 1e-3), &mut self.expansion);
        let doc = "Part of its tension that the cable loses where it is bent round the input drum and straightened again; on the output drum less by the ratio of the radii.";
        v.quantity(&Param::new("bending_loss", doc).within(0.0, 0.5), &mut self.bending_loss);
        let doc = "Groove lines of its two ends, from 0; by default as near to the other cables as they keep clear.";
        v.numbers(&Param::new("lines", doc).within(0.0, 1e4), &mut self.lines);
        v.quantity(&force("preload", "Tension at rest when it is assembled.").required(), &mut self.preload);
        let doc = "Part of the preload that bedding in and creep take.";
        v.quantity(&Param::new("preload_loss", doc).within(0.0, 0.99).default("0 %"), &mut self.preload_loss);
    }
}

impl Describe for Bearings {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let doc = "Friction μ_b of the bearings: each shaft needs the torque μ_b F D/2 under its load F, D the bore.";
        v.quantity(&Param::new("friction", doc).within(0.0, 0.5), &mut self.friction);
        let bore = |key, doc| length(key, doc).above(0.0, 1.0);
        v.quantity(&bore("input_bore", "Bore D of the input's bearings."), &mut self.input_bore);
        v.quantity(&bore("output_bore", "Bore D of the output's bearings."), &mut self.output_bore);
        let drag = |key, doc| torque(key, doc).within(0.0, 1e3);
        v.quantity(&drag("input_drag", "Torque of the input shaft without load, seals and motor; by default none."), &mut self.input_drag);
        v.quantity(&drag("output_drag", "Torque of the output shaft without load; by default none."), &mut self.output_drag);
    }
}

impl Describe for Inertia {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let inertia = |key, doc| Param::new(key, doc).of(Dimension::Inertia).above(0.0, 1e4);
        v.quantity(&inertia("input", "About the input shaft: motor, drum."), &mut self.input);
        v.quantity(&inertia("output", "About the output shaft: drum, link."), &mut self.output);
    }
}

impl Describe for Parts {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let size = |key, doc| length(key, doc).above(0.0, 1.0);
        v.quantity(&size("margin", "Drum beyond the outermost groove line; by default a pitch."), &mut self.margin);
        v.quantity(&size("anchor_length", "Cable beyond each termination; by default 20 of its diameters."), &mut self.anchor_length);
        v.quantity(&size("input_bore", "Diameter of the hole through the input drum; without it it is solid."), &mut self.input_bore);
        v.quantity(&size("output_bore", "Diameter of the hole through the output drum; without it it is solid."), &mut self.output_bore);
        let doc = "Diameter of the holes in which the cables are anchored; by default 1.2 times that of the cable.";
        v.quantity(&size("anchor_hole", doc), &mut self.anchor_hole);
        let doc = "Least wall that the process leaves: of the lands between grooves. The default is our choice for turned metal; printers need about two widths of their nozzle.";
        v.quantity(&size("least_wall", doc).default("0.2 mm"), &mut self.least_wall);
        let doc = "By how much the grooves of printed drums are cut wider on all sides.";
        v.quantity(&length("print_clearance", doc).within(0.0, 5e-3), &mut self.print_clearance);
        v.quantity(&Param::new("density", "Density of the drums.").of(Dimension::Density).above(0.0, 3e4), &mut self.density);
    }
}

impl Describe for Model {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.choice(&Param::new("source", "Model of the statics.").default("corrected"), SOURCES, &mut self.source);
        let doc = "Whether friction, length and lever are those of the helix: μ cos β, r/cos β, r cos β.";
        v.flag(&Param::new("helix_correction", doc), &mut self.helix_correction);
    }
}
