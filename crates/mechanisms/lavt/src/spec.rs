//! The project file of a two-speed transmission as it is typed: every parameter is described here, once.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::describe::{Describe, Located, Param, Section, Slot, Visitor, Word};
use forcewright_contract::header::Header;
use forcewright_contract::metrics::Limits;
use forcewright_contract::studies::Studies;

use crate::bench::section::Bench;
use crate::metrics::LavtMetrics;
use crate::synthesis::Synthesise;

/// Everything that a project file can say.
#[derive(Debug, Default)]
pub struct Spec {
    /// Schema, family, title.
    pub(crate) header: Header,
    /// `[requirements]`
    pub(crate) requirements: Section<Requirements>,
    /// `[material]`
    pub(crate) material: Section<Materials>,
    /// `[design]`
    pub(crate) design: Section<Design>,
    /// `[losses]`
    pub(crate) losses: Section<Losses>,
    /// `[hand]`
    pub(crate) hand: Section<Hand>,
    /// `[motor]`
    pub(crate) motor: Section<Motor>,
    /// `[parts]`
    pub(crate) parts: Section<Parts>,
    /// `[model]`
    pub(crate) model: Section<Model>,
    /// `[synthesise]`
    pub(crate) synthesise: Section<Synthesise>,
    /// `[optimise]`, `[tolerance]`, the other tables of `[measurements]`, and `[calibrate]`
    pub(crate) studies: Studies,
    /// `[measurements.bench]`
    pub(crate) bench: Section<Bench>,
}

/// What the transmission must do.
#[derive(Debug, Default)]
pub(crate) struct Requirements {
    pub input_torque: Slot<Quantity>,
    pub transition_torque: Section<TorqueRange>,
    pub output_torque: Section<Least>,
    pub speed_drop: Section<Most>,
    pub efficiency: Section<LeastRatio>,
    pub safety_factor: Slot<Quantity>,
    pub limits: Section<Limits<LavtMetrics>>,
}

/// A torque from and to.
#[derive(Debug, Default)]
pub(crate) struct TorqueRange {
    pub min: Slot<Quantity>,
    pub max: Slot<Quantity>,
}

/// A least torque.
#[derive(Debug, Default)]
pub(crate) struct Least {
    pub min: Slot<Quantity>,
}

/// A largest ratio.
#[derive(Debug, Default)]
pub(crate) struct Most {
    pub max: Slot<Quantity>,
}

/// A least ratio.
#[derive(Debug, Default)]
pub(crate) struct LeastRatio {
    pub min: Slot<Quantity>,
}

/// What it is made of.
#[derive(Debug, Default)]
pub(crate) struct Materials {
    pub spring: Section<Wire>,
    pub gears: Section<Solid>,
}

/// Spring wire.
#[derive(Debug, Default)]
pub(crate) struct Wire {
    pub catalogue: Slot<String>,
    pub young_modulus: Slot<Quantity>,
    pub tensile_strength: Slot<Quantity>,
    pub density: Slot<Quantity>,
}

/// Material of the gears.
#[derive(Debug, Default)]
pub(crate) struct Solid {
    pub catalogue: Slot<String>,
    pub young_modulus: Slot<Quantity>,
    pub poisson_ratio: Slot<Quantity>,
    pub bending_strength: Slot<Quantity>,
    pub flank_strength: Slot<Quantity>,
    pub density: Slot<Quantity>,
}

/// The transmission.
#[derive(Debug, Default)]
pub(crate) struct Design {
    pub gears: Section<Gears>,
    pub spring: Section<Spring>,
    pub hub: Section<Surface>,
    pub bore: Section<Surface>,
    pub friction: Section<Friction>,
}

/// The planetary gears.
#[derive(Debug, Default)]
pub(crate) struct Gears {
    pub sun: Slot<u32>,
    pub planet: Slot<u32>,
    pub ring: Slot<u32>,
    pub planets: Slot<u32>,
    pub module: Slot<Quantity>,
    pub profile_shift: Section<Shifts>,
    pub rack: Slot<&'static str>,
    pub pressure_angle: Slot<Quantity>,
    pub tip_shortening: Section<Shifts>,
    pub face_width: Slot<Quantity>,
    pub backlash: Slot<Quantity>,
    pub friction: Slot<Quantity>,
    pub load_sharing: Slot<Quantity>,
}

/// A number for each gear.
#[derive(Debug, Default)]
pub(crate) struct Shifts {
    pub sun: Slot<Quantity>,
    pub planet: Slot<Quantity>,
    pub ring: Slot<Quantity>,
}

/// The spring.
#[derive(Debug, Default)]
pub(crate) struct Spring {
    pub wire_diameter: Slot<Quantity>,
    pub inner_diameter: Slot<Quantity>,
    pub hub_turns: Slot<Quantity>,
    pub free_turns: Slot<Quantity>,
    pub bore_turns: Slot<Quantity>,
    pub unsupported_turns: Slot<Quantity>,
    pub hand: Slot<&'static str>,
}

/// A surface on which the spring lies.
#[derive(Debug, Default)]
pub(crate) struct Surface {
    pub diameter: Slot<Quantity>,
}

/// Coefficients of friction.
#[derive(Debug, Default)]
pub(crate) struct Friction {
    pub hub: Slot<Quantity>,
    pub bore: Slot<Quantity>,
}

/// Losses besides the slip on the hub.
#[derive(Debug, Default)]
pub(crate) struct Losses {
    pub mode_1: Section<Loss>,
    pub mode_2: Section<Loss>,
}

/// A part of the torque, and a torque.
#[derive(Debug, Default)]
pub(crate) struct Loss {
    pub proportional: Slot<Quantity>,
    pub constant: Slot<Quantity>,
}

/// What the output drives.
#[derive(Debug, Default)]
pub(crate) struct Hand {
    pub lever: Slot<Quantity>,
    pub lever_table: Slot<Vec<Located<[Quantity; 2]>>>,
    pub reduction: Slot<Quantity>,
    pub efficiency: Slot<Quantity>,
    pub non_backdrivable: Slot<bool>,
    pub opening: Slot<Quantity>,
    pub object_width: Slot<Quantity>,
    pub object_stiffness: Slot<Quantity>,
    pub glove_stiffness: Slot<Quantity>,
    pub glove_friction: Slot<Quantity>,
    pub inertia: Slot<Quantity>,
    pub force: Slot<Quantity>,
    pub speed: Slot<Quantity>,
}

/// The motor and what feeds it.
#[derive(Debug, Default)]
pub(crate) struct Motor {
    pub resistance: Slot<Quantity>,
    pub torque_constant: Slot<Quantity>,
    pub inertia: Slot<Quantity>,
    pub no_load_current: Slot<Quantity>,
    pub reduction: Slot<Quantity>,
    pub efficiency: Slot<Quantity>,
    pub supply: Slot<Quantity>,
    pub supply_profile: Slot<Vec<Located<[Quantity; 2]>>>,
    pub ramp: Slot<Quantity>,
    pub current_limit: Slot<Quantity>,
    pub max_speed: Slot<Quantity>,
    pub battery: Section<Battery>,
}

/// The battery.
#[derive(Debug, Default)]
pub(crate) struct Battery {
    pub voltage: Slot<Quantity>,
    pub charge: Slot<Quantity>,
}

/// The parts that are made.
#[derive(Debug, Default)]
pub(crate) struct Parts {
    pub ring_wall: Slot<Quantity>,
    pub sun_bore: Slot<Quantity>,
    pub planet_bore: Slot<Quantity>,
    pub hub_bore: Slot<Quantity>,
    pub plate_thickness: Slot<Quantity>,
    pub chassis_diameter: Slot<Quantity>,
    pub density: Slot<Quantity>,
}

/// Which equations are solved.
#[derive(Debug, Default)]
pub(crate) struct Model {
    pub source: Slot<&'static str>,
}

/// Hands of the spring.
pub(crate) const HANDS: &[Word] = &[Word { word: "right", doc: "as a common screw" }, Word { word: "left", doc: "the mirror image" }];
/// Models of the clutch.
pub(crate) const SOURCES: &[Word] = &[
    Word { word: "corrected", doc: "exact opening, finite turns, and the bore presses only on what exceeds the transition torque" },
    Word { word: "paper", doc: "equations (12), (13), (25), (28) and (29) of Butin et al." },
];
/// Basic racks.
pub(crate) const RACKS: &[Word] = &[
    Word { word: "A", doc: "ISO 53 A: dedendum 1.25, root radius 0.38 modules" },
    Word { word: "B", doc: "ISO 53 B: dedendum 1.25, root radius 0.30 modules" },
    Word { word: "C", doc: "ISO 53 C: dedendum 1.25, root radius 0.25 modules" },
    Word { word: "D", doc: "ISO 53 D: dedendum 1.4, root radius 0.39 modules" },
];

const MOST_TURNS: f64 = 100.0;
const MOST_TEETH: f64 = 500.0;
const MOST_POINTS: usize = 100;

fn length(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).of(Dimension::Length)
}

fn torque(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).of(Dimension::Torque)
}

fn part(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).within(0.0, 0.99)
}

impl Describe for Spec {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.header.describe(v);
        self.requirements.describe(v, &Param::new("requirements", "What the transmission must do. Tested, never changed by a study."));
        self.material.describe(v, &Param::new("material", "What spring and gears are made of.").required());
        self.design.describe(v, &Param::new("design", "The transmission.").required());
        let doc = "Losses besides the slip of the spring, at the output: measured on a bench, or estimated.";
        self.losses.describe(v, &Param::new("losses", doc));
        self.hand.describe(v, &Param::new("hand", "What the output drives: a finger with its reduction, glove and object."));
        self.motor.describe(v, &Param::new("motor", "The motor at the input, and what feeds it."));
        self.parts.describe(v, &Param::new("parts", "The parts that are made. Without influence on the torques."));
        self.model.describe(v, &Param::new("model", "Which equations are solved."));
        self.synthesise.describe(v, &Param::new("synthesise", "What `forcewright synthesise` may use, and how large it may be."));
        let doc = "A bench as in section 4.2 of the paper: masses hang on the output pulley, a force turns the input pulley slowly. \
                   `forcewright solve` shows it beside what is computed, with losses, shift and friction; `calibrate` does not read it.";
        self.studies.describe_with(v, &mut |v| self.bench.describe(v, &Param::new("bench", doc)));
    }
}

impl Describe for Requirements {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let doc = "Torque that is there at the input; the largest torque and the efficiency are taken with it.";
        v.quantity(&torque("input_torque", doc).above(0.0, 1e4).required(), &mut self.input_torque);
        self.transition_torque.describe(v, &Param::new("transition_torque", "Torque at the output at which the transmission shifts."));
        self.output_torque.describe(v, &Param::new("output_torque", "Torque at the output that the input torque must give."));
        self.speed_drop.describe(v, &Param::new("speed_drop", "Speed in mode I over speed in mode II."));
        self.efficiency.describe(v, &Param::new("efficiency", "Power at the output over power at the input, with that torque."));
        let doc = "Least permissible over largest stress of the wire.";
        v.quantity(&Param::new("safety_factor", doc).within(0.1, 100.0), &mut self.safety_factor);
        self.limits.describe(v, &Param::new("limits", "Limits on any metric, by its name."));
    }
}

impl Describe for TorqueRange {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&torque("min", "Smallest value.").above(0.0, 1e4), &mut self.min);
        v.quantity(&torque("max", "Largest value.").above(0.0, 1e4), &mut self.max);
    }
}

impl Describe for Least {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&torque("min", "Smallest value.").above(0.0, 1e4).required(), &mut self.min);
    }
}

impl Describe for Most {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&Param::new("max", "Largest value.").above(1.0, 1e3).required(), &mut self.max);
    }
}

impl Describe for LeastRatio {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&Param::new("min", "Smallest value.").within(0.0, 1.0).required(), &mut self.min);
    }
}

impl Describe for Materials {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.spring.describe(v, &Param::new("spring", "Wire of the spring.").required());
        self.gears.describe(v, &Param::new("gears", "Material of the gears: for the stress of their teeth."));
    }
}

impl Describe for Wire {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let doc = "Grade of the wire catalogue, `\"EN 10270-1 SH\"`; the keys below override its values.";
        v.text(&Param::new("use", doc), &mut self.catalogue);
        let stress = |key, doc| Param::new(key, doc).of(Dimension::Stress).above(0.0, 1e13);
        v.quantity(&stress("young_modulus", "Young's modulus."), &mut self.young_modulus);
        v.quantity(&stress("tensile_strength", "Least tensile strength of this wire."), &mut self.tensile_strength);
        v.quantity(&Param::new("density", "Density.").of(Dimension::Density).above(0.0, 3e4), &mut self.density);
    }
}

impl Describe for Solid {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.text(&Param::new("use", "Entry of the material catalogue; the keys below override its values."), &mut self.catalogue);
        let stress = |key, doc| Param::new(key, doc).of(Dimension::Stress).above(0.0, 1e13);
        v.quantity(&stress("young_modulus", "Young's modulus."), &mut self.young_modulus);
        v.quantity(&Param::new("poisson_ratio", "Poisson's ratio.").within(0.0, 0.499), &mut self.poisson_ratio);
        v.quantity(&stress("bending_strength", "Permissible bending stress at the root of a tooth."), &mut self.bending_strength);
        v.quantity(&stress("flank_strength", "Permissible Hertz pressure between flanks."), &mut self.flank_strength);
        v.quantity(&Param::new("density", "Density.").of(Dimension::Density).above(0.0, 3e4), &mut self.density);
    }
}

impl Describe for Design {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.gears.describe(
            v,
            &Param::new("gears", "The planetary gears: sun at the input, carrier at the output, ring at the spring.").required(),
        );
        let doc =
            "The spring: one end on the hub of the carrier, the other fastened to the ring, its last turns inside the bore of the chassis.";
        self.spring.describe(v, &Param::new("spring", doc).required());
        self.hub.describe(v, &Param::new("hub", "Surface A, on the carrier, on which the spring sits with interference.").required());
        self.bore.describe(v, &Param::new("bore", "Surface B, of the chassis, that the opened spring reaches.").required());
        self.friction.describe(v, &Param::new("friction", "Friction of the spring; a range with `±`, as nobody knows it well.").required());
    }
}

impl Describe for Gears {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let teeth = |key, doc| Param::new(key, doc).within(6.0, MOST_TEETH);
        v.count(&teeth("sun", "Teeth of the sun, the input.").required(), &mut self.sun);
        v.count(&teeth("planet", "Teeth of a planet.").required(), &mut self.planet);
        v.count(&teeth("ring", "Teeth of the ring; by default sun + 2 planet."), &mut self.ring);
        v.count(&Param::new("planets", "Number of planets, equally spaced.").within(1.0, 12.0).default("3"), &mut self.planets);
        v.quantity(&length("module", "Module.").within(5e-5, 0.05).required(), &mut self.module);
        let shift = "Profile shift coefficients, positive outwards, also of the ring; by default none.";
        self.profile_shift.describe(v, &Param::new("profile_shift", shift));
        v.choice(&Param::new("rack", "Basic rack.").default("A"), RACKS, &mut self.rack);
        let angle = Param::new("pressure_angle", "Pressure angle of the rack.").of(Dimension::Angle).within(0.17, 0.62).default("20 deg");
        v.quantity(&angle, &mut self.pressure_angle);
        let shorter = "By how much teeth are shorter at their tips than the rack has them, in modules; by default nothing.";
        self.tip_shortening.describe(v, &Param::new("tip_shortening", shorter));
        v.quantity(&length("face_width", "Width of the gears; by default 8 modules.").above(0.0, 1.0), &mut self.face_width);
        let doc = "Circumferential backlash of each mesh; half of it is taken from each tooth.";
        v.quantity(&length("backlash", doc).within(0.0, 0.01).default("0 mm"), &mut self.backlash);
        let doc = "Friction between flanks, for the efficiency of the meshes; by default they lose nothing.";
        v.quantity(&Param::new("friction", doc).within(0.0, 1.0), &mut self.friction);
        let doc = "Load of the most loaded planet over the mean.";
        v.quantity(&Param::new("load_sharing", doc).within(1.0, 12.0).default("1"), &mut self.load_sharing);
    }
}

impl Describe for Shifts {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let one = |key, doc| Param::new(key, doc).within(-4.0, 4.0).default("0");
        v.quantity(&one("sun", "Of the sun."), &mut self.sun);
        v.quantity(&one("planet", "Of the planets."), &mut self.planet);
        v.quantity(&one("ring", "Of the ring."), &mut self.ring);
    }
}

impl Describe for Spring {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&length("wire_diameter", "Diameter of the wire.").within(5e-5, 0.02).required(), &mut self.wire_diameter);
        v.quantity(&length("inner_diameter", "Inner diameter, free.").within(5e-4, 1.0).required(), &mut self.inner_diameter);
        let turns = |key, doc| Param::new(key, doc).above(0.0, MOST_TURNS).required();
        v.quantity(&turns("hub_turns", "Turns on the hub, N_A."), &mut self.hub_turns);
        v.quantity(
            &turns("free_turns", "Turns off the hub, which open before the bore is reached: those in the bore and those before it, N_f."),
            &mut self.free_turns,
        );
        v.quantity(&turns("bore_turns", "Turns of these in the bore, N_B."), &mut self.bore_turns);
        let doc = "Turns between the bore and the end at the ring that nothing supports: they carry the whole torque of the clutch.";
        v.quantity(&Param::new("unsupported_turns", doc).within(0.0, MOST_TURNS).default("0"), &mut self.unsupported_turns);
        v.choice(&Param::new("hand", "Hand of the spring.").default("right"), HANDS, &mut self.hand);
    }
}

impl Describe for Surface {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&Param::new("diameter", "Diameter.").diameter().within(1e-3, 0.5).required(), &mut self.diameter);
    }
}

impl Describe for Friction {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let friction = |key, doc| Param::new(key, doc).within(0.001, 2.0).required();
        v.quantity(&friction("hub", "On the hub."), &mut self.hub);
        v.quantity(&friction("bore", "In the bore."), &mut self.bore);
    }
}

impl Describe for Losses {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.mode_1.describe(v, &Param::new("mode_1", "In mode I: τ_out = (1 − proportional) τ_in − constant."));
        let doc = "In mode II: τ_out = (1 − proportional) τ_in/R − constant − torque of slip on the hub; without `proportional` that of the meshes.";
        self.mode_2.describe(v, &Param::new("mode_2", doc));
    }
}

impl Describe for Loss {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&part("proportional", "Part of the torque that is lost."), &mut self.proportional);
        let doc = "Torque that is lost at any load, at the output; by default none.";
        v.quantity(&torque("constant", doc).within(0.0, 1e3), &mut self.constant);
    }
}

impl Describe for Hand {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let doc = "Way of the finger over turn of its joint, equivalent lever l_eq: force times lever is the torque of the joint.";
        v.quantity(&length("lever", doc).above(0.0, 10.0), &mut self.lever);
        let doc =
            "The same over the opening that is left, instead of one value: `[[\"100 mm\", \"130 mm\"], …]`, straight between its points.";
        v.pairs(&length("lever_table", doc).above(0.0, 10.0), Dimension::Length, MOST_POINTS, &mut self.lever_table);
        let doc = "Turns of the output for one of the finger's joint.";
        v.quantity(&Param::new("reduction", doc).within(1e-3, 1e5).required(), &mut self.reduction);
        v.quantity(&Param::new("efficiency", "Of that reduction.").within(0.01, 1.0).default("1"), &mut self.efficiency);
        let doc = "Whether that reduction holds the finger without torque, so that a grasp needs no current to be kept.";
        v.flag(&Param::new("non_backdrivable", doc), &mut self.non_backdrivable);
        v.quantity(&length("opening", "Way of the finger from open to closed.").above(0.0, 10.0), &mut self.opening);
        let doc = "Width of the object: it is touched when so much of the opening is left.";
        v.quantity(&length("object_width", doc).within(0.0, 10.0).default("0 mm"), &mut self.object_width);
        let stiffness = |key, doc| Param::new(key, doc).of(Dimension::Stiffness);
        v.quantity(&stiffness("object_stiffness", "Stiffness of the object.").above(0.0, 1e9), &mut self.object_stiffness);
        let doc = "Stiffness of the glove, at the finger; by default none.";
        v.quantity(&stiffness("glove_stiffness", doc).within(0.0, 1e6), &mut self.glove_stiffness);
        let force = |key, doc| Param::new(key, doc).of(Dimension::Force);
        v.quantity(
            &force("glove_friction", "Friction of glove and joints, at the finger; by default none.").within(0.0, 1e4),
            &mut self.glove_friction,
        );
        let doc = "Moment of inertia of the finger about its joint.";
        v.quantity(&Param::new("inertia", doc).of(Dimension::Inertia).above(0.0, 1e3), &mut self.inertia);
        v.quantity(
            &force(
                "force",
                "Force at the finger that is wanted: for the energy of a grasp; by default that of the required output torque.",
            )
            .above(0.0, 1e6),
            &mut self.force,
        );
        let speed = Param::new("speed", "Speed of the finger that is wanted: for the performance index.").of(Dimension::Speed);
        v.quantity(&speed.above(0.0, 1e3), &mut self.speed);
    }
}

impl Describe for Motor {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(
            &Param::new("resistance", "Of the winding, R.").of(Dimension::Resistance).above(0.0, 1e6).required(),
            &mut self.resistance,
        );
        let doc = "Torque over current, and voltage over angular speed, K.";
        v.quantity(&Param::new("torque_constant", doc).of(Dimension::TorqueConstant).above(0.0, 1e3).required(), &mut self.torque_constant);
        v.quantity(&Param::new("inertia", "Moment of inertia of the rotor.").of(Dimension::Inertia).above(0.0, 1e3), &mut self.inertia);
        let current = |key, doc| Param::new(key, doc).of(Dimension::Current);
        v.quantity(
            &current("no_load_current", "Current that the motor's own friction takes; by default none.").within(0.0, 1e3),
            &mut self.no_load_current,
        );
        let doc = "Turns of the motor for one of the transmission's input.";
        v.quantity(&Param::new("reduction", doc).within(1e-3, 1e5).default("1"), &mut self.reduction);
        v.quantity(&Param::new("efficiency", "Of that reduction.").within(0.01, 1.0).default("1"), &mut self.efficiency);
        let voltage = |key, doc| Param::new(key, doc).of(Dimension::Voltage).above(0.0, 1e4);
        v.quantity(&voltage("supply", "Voltage.").required(), &mut self.supply);
        let profile = "Voltage over time instead of one value, `[[\"0 s\", \"0 V\"], …]`, straight between its points.";
        v.pairs(
            &Param::new("supply_profile", profile).of(Dimension::Voltage).within(0.0, 1e4),
            Dimension::Time,
            MOST_POINTS,
            &mut self.supply_profile,
        );
        let time = Param::new("ramp", "Time in which the voltage rises to its value.").of(Dimension::Time);
        v.quantity(&time.within(0.0, 100.0).default("0 s"), &mut self.ramp);
        v.quantity(
            &current("current_limit", "Largest current of the electronics; by default none.").above(0.0, 1e4),
            &mut self.current_limit,
        );
        let doc = "Largest speed that the motor endures: that of the closing is held against it.";
        v.quantity(&Param::new("max_speed", doc).of(Dimension::AngularSpeed).above(0.0, 1e6), &mut self.max_speed);
        self.battery.describe(v, &Param::new("battery", "The battery: for the number of grasps."));
    }
}

impl Describe for Battery {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&Param::new("voltage", "Mean voltage.").of(Dimension::Voltage).above(0.0, 1e4).required(), &mut self.voltage);
        v.quantity(&Param::new("charge", "Charge.").of(Dimension::Charge).above(0.0, 1e9).required(), &mut self.charge);
    }
}

impl Describe for Parts {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let size = |key, doc| length(key, doc).above(0.0, 1.0);
        v.quantity(&size("ring_wall", "Ring outside the roots of its teeth; by default 3 modules."), &mut self.ring_wall);
        v.quantity(&size("sun_bore", "Hole through the sun; by default a third of its root diameter."), &mut self.sun_bore);
        v.quantity(
            &size("planet_bore", "Hole through the planets, for their pins; by default a third of their root diameter."),
            &mut self.planet_bore,
        );
        v.quantity(&size("hub_bore", "Hole through the hub, for the shaft of the output; by default half of its diameter, or less where the pins of the planets stand in its way."), &mut self.hub_bore);
        v.quantity(
            &size("plate_thickness", "Thickness of the plates of carrier and chassis and of the spring's seat; by default 4 modules."),
            &mut self.plate_thickness,
        );
        v.quantity(
            &size(
                "chassis_diameter",
                "Outer diameter of chassis and friction ring; by default that of ring or bore, whichever is larger, and twice `ring_wall`.",
            ),
            &mut self.chassis_diameter,
        );
        v.quantity(&Param::new("density", "Density of the turned parts.").of(Dimension::Density).above(0.0, 3e4), &mut self.density);
    }
}

impl Describe for Model {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.choice(&Param::new("source", "Model of the clutch.").default("corrected"), SOURCES, &mut self.source);
    }
}
