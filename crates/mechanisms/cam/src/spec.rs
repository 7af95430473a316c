//! The project file of a cam mechanism as it is typed: every parameter is described here, once.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_contract::data::DataFile;
use forcewright_contract::describe::{Describe, Located, Param, Section, Slot, Visitor, Word};
use forcewright_contract::header::Header;
use forcewright_contract::metrics::Limits;
use forcewright_contract::studies::Studies;

use crate::metrics::CamMetrics;
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
    /// `[environment]`
    pub(crate) environment: Section<Environment>,
    /// `[design]`
    pub(crate) design: Section<Design>,
    /// `[parts]`
    pub(crate) parts: Section<Parts>,
    /// `[errors]`
    pub(crate) errors: Section<Errors>,
    /// `[motion]`
    pub(crate) motion: Section<Motion>,
    /// `[model]`
    pub(crate) model: Section<Model>,
    /// `[synthesise]`
    pub(crate) synthesise: Section<Synthesise>,
    /// `[optimise]` and `[tolerance]`
    pub(crate) studies: Studies,
}

/// What the mechanism must do.
#[derive(Debug, Default)]
pub(crate) struct Requirements {
    pub force: Section<ForceRequirement>,
    pub profile: Slot<Vec<Located<[Quantity; 2]>>>,
    pub profile_file: Slot<DataFile>,
    pub stroke: Slot<Quantity>,
    pub window: Slot<[Quantity; 2]>,
    pub torque: Section<TorqueRequirement>,
    pub torque_profile: Slot<Vec<Located<[Quantity; 2]>>>,
    pub torque_profile_file: Slot<DataFile>,
    pub turn: Slot<Quantity>,
    pub turn_window: Slot<[Quantity; 2]>,
    pub hysteresis: Slot<Quantity>,
    pub limits: Section<Limits<CamMetrics>>,
}

/// A force level and how far from it the force may be.
#[derive(Debug, Default)]
pub(crate) struct ForceRequirement {
    pub nominal: Slot<Quantity>,
    pub band: Slot<Quantity>,
}

/// A torque level and how far from it the torque may be.
#[derive(Debug, Default)]
pub(crate) struct TorqueRequirement {
    pub nominal: Slot<Quantity>,
    pub band: Slot<Quantity>,
}

/// Of cam and rollers: for the pressure between them.
#[derive(Debug, Default)]
pub(crate) struct Materials {
    pub cam: Section<Material>,
    pub roller: Section<Material>,
}

/// A material.
#[derive(Debug, Default)]
pub(crate) struct Material {
    pub catalogue: Slot<String>,
    pub young_modulus: Slot<Quantity>,
    pub poisson_ratio: Slot<Quantity>,
    pub yield_stress: Slot<Quantity>,
    pub density: Slot<Quantity>,
    pub brinell: Slot<Quantity>,
}

/// Where it works.
#[derive(Debug, Default)]
pub(crate) struct Environment {
    pub gravity: Slot<Quantity>,
}

/// The mechanism.
#[derive(Debug, Default)]
pub(crate) struct Design {
    pub arrangement: Slot<&'static str>,
    pub brace_length: Slot<Quantity>,
    pub roller_diameter: Slot<Quantity>,
    pub cam_thickness: Slot<Quantity>,
    pub stroke: Slot<Quantity>,
    pub turn: Slot<Quantity>,
    pub disc: Section<Disc>,
    pub rolling_arm: Slot<Quantity>,
    pub rolling_friction: Slot<Quantity>,
    pub friction: Slot<Quantity>,
    pub guide_friction: Slot<Quantity>,
    pub profile: Section<Profile>,
    pub springs: Section<Springs>,
    pub bodies: Section<Bodies>,
}

/// The disc of a torque cam.
#[derive(Debug, Default)]
pub(crate) struct Disc {
    pub start_radius: Slot<Quantity>,
    pub shaft_diameter: Slot<Quantity>,
}

/// What the cam is cut for.
#[derive(Debug, Default)]
#[expect(clippy::struct_field_names, reason = "they are the keys of the project file")]
pub(crate) struct Profile {
    pub for_force: Slot<Quantity>,
    pub for_profile: Slot<Vec<Located<[Quantity; 2]>>>,
    pub for_profile_file: Slot<DataFile>,
    pub for_torque: Slot<Quantity>,
    pub for_torque_profile: Slot<Vec<Located<[Quantity; 2]>>>,
    pub for_torque_profile_file: Slot<DataFile>,
    pub for_rate: Slot<Quantity>,
    pub for_curve: Slot<Vec<Located<[Quantity; 2]>>>,
    pub for_rest_length: Slot<Quantity>,
    pub for_start_length: Slot<Quantity>,
    pub for_friction: Slot<Quantity>,
    pub for_guide_friction: Slot<Quantity>,
    pub compensate: Slot<&'static str>,
    pub share_right: Slot<Quantity>,
}

/// The springs as mounted.
#[derive(Debug, Default)]
pub(crate) struct Springs {
    pub rates: Slot<Vec<Quantity>>,
    pub rate: Slot<Quantity>,
    pub count: Slot<u32>,
    pub curve: Slot<Vec<Located<[Quantity; 2]>>>,
    pub rest_length: Slot<Quantity>,
    pub max_length: Slot<Quantity>,
    pub min_length: Slot<Quantity>,
    pub mass: Slot<Quantity>,
    pub adjust: Section<Adjust>,
}

/// The screw that stretches the springs.
#[derive(Debug, Default)]
pub(crate) struct Adjust {
    pub turns: Slot<Quantity>,
    pub pitch: Slot<Quantity>,
}

/// Masses.
#[derive(Debug, Default)]
pub(crate) struct Bodies {
    pub slider_mass: Slot<Quantity>,
    pub brace_mass: Slot<Quantity>,
    pub brace_inertia: Slot<Quantity>,
    pub roller_mass: Slot<Quantity>,
    pub roller_inertia: Slot<Quantity>,
    pub follower_mass: Slot<Quantity>,
    pub disc_inertia: Slot<Quantity>,
}

/// How the parts are made.
#[derive(Debug, Default)]
pub(crate) struct Parts {
    pub chord_error: Slot<Quantity>,
    pub base: Slot<Quantity>,
    pub wall: Slot<Quantity>,
    pub pin_diameter: Slot<Quantity>,
    pub brace_width: Slot<Quantity>,
    pub brace_thickness: Slot<Quantity>,
    pub hole: Slot<Quantity>,
}

/// Errors of making and assembly.
#[derive(Debug, Default)]
pub(crate) struct Errors {
    pub tilt: Slot<Quantity>,
    pub profile_rotation: Slot<Quantity>,
    pub profile_rotation_right: Slot<Quantity>,
    pub profile_rotation_left: Slot<Quantity>,
    pub profile_offset: Slot<Quantity>,
    pub profile_offset_right: Slot<Quantity>,
    pub profile_offset_left: Slot<Quantity>,
    pub profile_height: Slot<Quantity>,
    pub measured_profile: Section<MeasuredProfile>,
    pub random_profile: Section<RandomProfile>,
}

/// Points measured on a cam.
#[derive(Debug, Default)]
pub(crate) struct MeasuredProfile {
    pub file: Slot<DataFile>,
    pub side: Slot<&'static str>,
    pub noise: Slot<Quantity>,
}

/// A random error of the profile.
#[derive(Debug, Default)]
pub(crate) struct RandomProfile {
    pub deviation: Slot<Quantity>,
    pub correlation_length: Slot<Quantity>,
    pub seed: Slot<Quantity>,
}

/// What happens to it.
#[derive(Debug, Default)]
pub(crate) struct Motion {
    pub law: Slot<&'static str>,
    pub start: Slot<Quantity>,
    pub rise: Slot<Quantity>,
    pub start_turn: Slot<Quantity>,
    pub rise_turn: Slot<Quantity>,
    pub duration: Slot<Quantity>,
    pub reference_duration: Slot<Quantity>,
    pub pause: Slot<Quantity>,
    pub back: Slot<bool>,
    pub pull: Slot<Quantity>,
    pub hanging_mass: Slot<Quantity>,
    pub hanging_gravity: Slot<Quantity>,
    pub damping: Slot<Quantity>,
    pub guide: Slot<&'static str>,
}

/// Which equations are solved.
#[derive(Debug, Default)]
pub(crate) struct Model {
    pub spring_mass: Slot<&'static str>,
}

/// How the springs act.
pub(crate) const ARRANGEMENTS: &[Word] = &[
    Word { word: "tension", doc: "extension springs pull the rollers onto a cam between them" },
    Word { word: "compression", doc: "compression springs push the rollers onto cams outside them" },
];
/// In which direction the force is exact.
pub(crate) const COMPENSATIONS: &[Word] =
    &[Word { word: "up", doc: "while the slider moves along its travel" }, Word { word: "down", doc: "while it moves back" }];
/// Motions.
pub(crate) const LAWS: &[Word] = &[
    Word { word: "cycloidal", doc: "s = start + rise (t/T − sin(2πt/T)/2π): no acceleration at the ends" },
    Word { word: "polynomial", doc: "s = start + rise (10u³ − 15u⁴ + 6u⁵), u = t/T: no acceleration at the ends" },
    Word { word: "uniform", doc: "at constant speed" },
    Word { word: "release", doc: "let go at rest at `start`: it moves as `pull`, `hanging_mass`, springs and masses make it move" },
];
/// How the slider is guided.
pub(crate) const GUIDES: &[Word] =
    &[Word { word: "rigid", doc: "on a straight line" }, Word { word: "free", doc: "pulled along the travel, free to move sideways" }];
/// Sides that were measured.
pub(crate) const SIDES: &[Word] = &[
    Word { word: "both", doc: "both in one file, told apart by the sign of x" },
    Word { word: "right", doc: "the right one; the left one is as designed" },
    Word { word: "left", doc: "the left one; the right one is as designed" },
    Word { word: "mirrored", doc: "the right one; the left one is taken as its mirror image" },
];
/// How the springs' mass moves.
pub(crate) const SPRING_MASSES: &[Word] = &[
    Word { word: "bar", doc: "as a bar between the axles: half of it along the travel, a sixth outwards with each roller" },
    Word { word: "halves", doc: "half of it sits on each roller" },
];

const LARGEST_M: f64 = 10.0;
/// Of a torque cam: two lobes share a whole turn.
pub(crate) const LARGEST_TURN_RAD: f64 = 3.0;
pub(crate) const SMALLEST_TURN_RAD: f64 = 0.01;
const SMALLEST_M: f64 = 1e-4;
/// Of a curve.
const MOST_POINTS: usize = 500;
/// In parallel.
const MOST_SPRINGS: usize = 32;

impl Describe for Spec {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.header.describe(v);
        self.requirements.describe(v, &Param::new("requirements", "What the mechanism must do. Tested, never changed by a study."));
        self.material.describe(v, &Param::new("material", "What cam and rollers are made of: for the pressure between them."));
        self.environment.describe(v, &Param::new("environment", "Where it works."));
        self.design.describe(v, &Param::new("design", "The mechanism.").required());
        self.parts.describe(v, &Param::new("parts", "The plates that are cut. Without influence on the force."));
        self.errors.describe(v, &Param::new("errors", "Errors of making and assembly."));
        self.motion.describe(v, &Param::new("motion", "What happens to it: how the slider is guided and moved."));
        self.model.describe(v, &Param::new("model", "Which equations are solved."));
        self.synthesise.describe(v, &Param::new("synthesise", "What `forcewright synthesise` may use: room, springs, rollers."));
        self.studies.describe(v);
    }
}

fn length(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).of(Dimension::Length)
}

fn angle(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).of(Dimension::Angle)
}

fn torque_curve(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).of(Dimension::Torque).above(0.0, 1e6)
}

fn force_curve(key: &'static str, doc: &'static str) -> Param {
    Param::new(key, doc).of(Dimension::Force).above(0.0, 1e6)
}

impl Describe for Requirements {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.force.describe(v, &Param::new("force", "Level and band of the force, up and down."));
        let profile = force_curve("profile", "Force over the travel of the slider, instead of one level: straight between its points.");
        v.pairs(&profile, Dimension::Length, MOST_POINTS, &mut self.profile);
        let doc = "The same from a CSV file: travel and force, with units in the header, `travel / mm, force / N`.";
        v.file(&Param::new("profile_file", doc), &mut self.profile_file);
        v.quantity(&length("stroke", "Travel that is needed.").above(0.0, LARGEST_M), &mut self.stroke);
        let window = "Travel of the slider where means, bands and loops are taken, from and to; by default the stroke without undercut.";
        v.point(&length("window", window).within(0.0, LARGEST_M), &mut self.window);
        self.torque.describe(v, &Param::new("torque", "Torque cam: level and band of the torque, both ways."));
        let doc = "Torque cam: torque over the turn of the disc, instead of one level: straight between its points.";
        v.pairs(&torque_curve("torque_profile", doc), Dimension::Angle, MOST_POINTS, &mut self.torque_profile);
        let doc = "The same from a CSV file: turn and torque, with units in the header, `turn / deg, torque / N*m`.";
        v.file(&Param::new("torque_profile_file", doc), &mut self.torque_profile_file);
        v.quantity(&angle("turn", "Torque cam: turn that is needed.").above(0.0, LARGEST_TURN_RAD), &mut self.turn);
        let doc = "Torque cam: turn of the disc where means, bands and loops are taken, from and to; by default the turn without undercut.";
        v.point(&angle("turn_window", doc).within(0.0, LARGEST_TURN_RAD), &mut self.turn_window);
        v.quantity(
            &Param::new("hysteresis", "Largest (mean up − mean down)/mean of the force or torque over the window.").above(0.0, 10.0),
            &mut self.hysteresis,
        );
        self.limits.describe(v, &Param::new("limits", "Limits on any metric, by its name."));
    }
}

impl Describe for ForceRequirement {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(
            &Param::new("nominal", "Force level; with `profile` it is not given.").of(Dimension::Force).above(0.0, 1e6),
            &mut self.nominal,
        );
        v.quantity(&Param::new("band", "Half width β of the band, relative to the level.").above(0.0, 0.9).required(), &mut self.band);
    }
}

impl Describe for TorqueRequirement {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let nominal = torque_curve("nominal", "Torque level; with `torque_profile` it is not given.");
        v.quantity(&nominal, &mut self.nominal);
        v.quantity(&Param::new("band", "Half width β of the band, relative to the level.").above(0.0, 0.9).required(), &mut self.band);
    }
}

impl Describe for Materials {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.cam.describe(v, &Param::new("cam", "Of the cam."));
        self.roller.describe(v, &Param::new("roller", "Of the rollers."));
    }
}

impl Describe for Material {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.text(&Param::new("use", "Entry of the material catalogue; the keys below override its values."), &mut self.catalogue);
        v.quantity(&Param::new("young_modulus", "Young's modulus E.").of(Dimension::Stress).within(1e3, 1e13), &mut self.young_modulus);
        v.quantity(&Param::new("poisson_ratio", "Poisson's ratio ν.").within(0.0, 0.5), &mut self.poisson_ratio);
        v.quantity(&Param::new("yield_stress", "Yield stress σ_y.").of(Dimension::Stress).above(0.0, 1e11), &mut self.yield_stress);
        v.quantity(&Param::new("density", "Density.").of(Dimension::Density).above(0.0, 3e4), &mut self.density);
        v.quantity(
            &Param::new("brinell", "Brinell hardness of a steel, a bare number: for the life of its surface.").above(0.0, 1000.0),
            &mut self.brinell,
        );
    }
}

impl Describe for Environment {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(
            &Param::new("gravity", "Acceleration of gravity against the travel; 0 where it lies flat or the load cell is tared.")
                .of(Dimension::Acceleration)
                .within(-100.0, 100.0)
                .default("9.81 m/s^2"),
            &mut self.gravity,
        );
    }
}

impl Describe for Design {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.choice(&Param::new("arrangement", "How the springs act.").default("tension"), ARRANGEMENTS, &mut self.arrangement);
        let brace = |key, doc| length(key, doc).within(SMALLEST_M, LARGEST_M);
        let doc = "Length l of the braces, joint to axle; needed without `disc`.";
        v.quantity(&brace("brace_length", doc), &mut self.brace_length);
        v.quantity(
            &Param::new("roller_diameter", "Diameter of the rollers, 2r.").diameter().within(SMALLEST_M, 1.0).required(),
            &mut self.roller_diameter,
        );
        v.quantity(
            &length("cam_thickness", "Thickness of the cam plate, on which the rollers bear.").within(SMALLEST_M, 1.0),
            &mut self.cam_thickness,
        );
        let doc = "Travel s of the slider for which the cam is cut; needed without `disc`.";
        v.quantity(&length("stroke", doc).within(SMALLEST_M, LARGEST_M), &mut self.stroke);
        let doc = "Torque cam: turn θ of the disc for which it is cut; what is left of half a turn leads back to the start of a lobe.";
        v.quantity(&angle("turn", doc).within(SMALLEST_TURN_RAD, LARGEST_TURN_RAD), &mut self.turn);
        let doc = "With this table it is a torque cam: a disc on a shaft with two equal lobes between two rollers on radial guides.";
        self.disc.describe(v, &Param::new("disc", doc));
        v.quantity(
            &length("rolling_arm", "Arm of the rolling resistance: friction μ is arm over roller radius.").within(0.0, 0.1),
            &mut self.rolling_arm,
        );
        v.quantity(&Param::new("rolling_friction", "Rolling friction μ, instead of its arm.").within(0.0, 0.5), &mut self.rolling_friction);
        v.quantity(
            &Param::new("friction", "Friction that is there between roller and cam, so that the rollers roll.").within(0.0, 2.0),
            &mut self.friction,
        );
        let doc = "Torque cam: Coulomb friction between a follower and its guide, on the force across it.";
        v.quantity(&Param::new("guide_friction", doc).within(0.0, 0.5), &mut self.guide_friction);
        self.profile.describe(
            v,
            &Param::new(
                "profile",
                "What the cam was cut for: taken once, never changed by tolerances, errors or the springs mounted today.",
            )
            .required(),
        );
        self.springs.describe(v, &Param::new("springs", "The springs mounted in parallel between the roller axles.").required());
        self.bodies.describe(v, &Param::new("bodies", "Masses and moments of inertia: for the motion and the weight."));
    }
}

impl Describe for Disc {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let doc = "Distance of the rollers' centres from the shaft's middle at the start: half the length of the springs there.";
        v.quantity(&length("start_radius", doc).within(SMALLEST_M, LARGEST_M).required(), &mut self.start_radius);
        let doc = "Diameter of the hole for the shaft; without it there is none.";
        v.quantity(&length("shaft_diameter", doc).within(SMALLEST_M, 1.0), &mut self.shaft_diameter);
    }
}

impl Describe for Profile {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&force_curve("for_force", "The constant force."), &mut self.for_force);
        let curve =
            force_curve("for_profile", "Any force over the travel, above zero, straight between its points: `[[\"0 mm\", \"40 N\"], …]`.");
        v.pairs(&curve, Dimension::Length, MOST_POINTS, &mut self.for_profile);
        let doc = "The same from a CSV file: travel and force, with units in the header, `travel / mm, force / N`.";
        v.file(&Param::new("for_profile_file", doc), &mut self.for_profile_file);
        v.quantity(&torque_curve("for_torque", "Torque cam: the constant torque."), &mut self.for_torque);
        let doc = "Torque cam: any torque over the turn, above zero, straight between its points: `[[\"0 deg\", \"1 N*m\"], …]`.";
        v.pairs(&torque_curve("for_torque_profile", doc), Dimension::Angle, MOST_POINTS, &mut self.for_torque_profile);
        let doc = "The same from a CSV file: turn and torque, with units in the header, `turn / deg, torque / N*m`.";
        v.file(&Param::new("for_torque_profile_file", doc), &mut self.for_torque_profile_file);
        let rate = Param::new("for_rate", "Rate of all springs together.").of(Dimension::Stiffness).above(0.0, 1e9);
        v.quantity(&rate, &mut self.for_rate);
        let curve = Param::new("for_curve", "Force of all springs together over their length, instead of rate and rest length.");
        v.pairs(&curve.of(Dimension::Force).within(0.0, 1e6), Dimension::Length, MOST_POINTS, &mut self.for_curve);
        let spring = |key, doc| length(key, doc).within(SMALLEST_M, LARGEST_M);
        v.quantity(&spring("for_rest_length", "Length of the springs without force, between the axles."), &mut self.for_rest_length);
        let start = "Their length where the path starts, 2·x0; by default the rest length. Apart from it, they are preloaded.";
        v.quantity(&spring("for_start_length", start), &mut self.for_start_length);
        v.quantity(
            &Param::new("for_friction", "Rolling friction μ that is compensated.").within(0.0, 0.2).default("0"),
            &mut self.for_friction,
        );
        let guide = Param::new("for_guide_friction", "Torque cam: friction of the guides that is compensated.");
        v.quantity(&guide.within(0.0, 0.5).default("0"), &mut self.for_guide_friction);
        v.choice(
            &Param::new("compensate", "In which direction the force or torque is exact.").default("up"),
            COMPENSATIONS,
            &mut self.compensate,
        );
        v.quantity(
            &Param::new("share_right", "Part of the force that the right side carries.").within(0.05, 0.95).default("0.5"),
            &mut self.share_right,
        );
    }
}

impl Describe for Springs {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let rate = |key, doc| Param::new(key, doc).of(Dimension::Stiffness).above(0.0, 1e9);
        v.quantities(&rate("rates", "Rate of each spring."), MOST_SPRINGS, &mut self.rates);
        v.quantity(&rate("rate", "Rate of each of `count` equal springs."), &mut self.rate);
        v.count(&Param::new("count", "Number of equal springs.").within(1.0, MOST_SPRINGS as f64).default("1"), &mut self.count);
        let curve = Param::new("curve", "Force of each of `count` springs over its length, instead of rate and rest length.");
        v.pairs(&curve.of(Dimension::Force).within(0.0, 1e6), Dimension::Length, MOST_POINTS, &mut self.curve);
        let spring = |key, doc| length(key, doc).within(SMALLEST_M, LARGEST_M);
        v.quantity(&spring("rest_length", "Length without force, between the axles."), &mut self.rest_length);
        v.quantity(&spring("max_length", "Length beyond which a spring is over-extended."), &mut self.max_length);
        v.quantity(&spring("min_length", "Length below which a compression spring is solid."), &mut self.min_length);
        v.quantity(&Param::new("mass", "Mass of each spring.").of(Dimension::Mass).within(0.0, 1e3).default("0 g"), &mut self.mass);
        self.adjust.describe(v, &Param::new("adjust", "The screw that stretches the springs."));
    }
}

impl Describe for Adjust {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&Param::new("turns", "Turns of the screw: above zero they stretch.").within(-1e3, 1e3).default("0"), &mut self.turns);
        v.quantity(&length("pitch", "Pitch of the screw.").above(0.0, 0.1).required(), &mut self.pitch);
    }
}

impl Describe for Bodies {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let mass = |key, doc| Param::new(key, doc).of(Dimension::Mass).within(0.0, 1e4).default("0 g");
        let inertia = |key, doc| Param::new(key, doc).of(Dimension::Inertia).within(0.0, 1e3).default("0 kg*m^2");
        v.quantity(&mass("slider_mass", "Slider, with what is fixed to it."), &mut self.slider_mass);
        v.quantity(&mass("brace_mass", "Each brace."), &mut self.brace_mass);
        v.quantity(&inertia("brace_inertia", "Each brace about its middle."), &mut self.brace_inertia);
        v.quantity(&mass("roller_mass", "Each roller with its axle, without springs."), &mut self.roller_mass);
        v.quantity(&inertia("roller_inertia", "What rolls of each roller, about its axis."), &mut self.roller_inertia);
        v.quantity(&mass("follower_mass", "Torque cam: what moves on its guide with each roller."), &mut self.follower_mass);
        v.quantity(&inertia("disc_inertia", "Torque cam: disc, shaft and what turns with them."), &mut self.disc_inertia);
    }
}

impl Describe for Parts {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let size = |key, doc| length(key, doc).above(0.0, 1.0);
        let error = "Largest distance between the arcs that the cam is drawn with and its exact profile.";
        v.quantity(&length("chord_error", error).within(1e-8, 1e-3).default("0.05 µm"), &mut self.chord_error);
        v.quantity(&size("base", "Height of the cam plate below the start of its profile; by default a roller diameter."), &mut self.base);
        v.quantity(&size("wall", "With compression springs: material behind the profile; by default a roller diameter."), &mut self.wall);
        v.quantity(
            &size("pin_diameter", "Diameter of the axles and of the holes for them; by default a quarter of that of the rollers."),
            &mut self.pin_diameter,
        );
        v.quantity(&size("brace_width", "Width of the braces; by default 2.5 axles."), &mut self.brace_width);
        v.quantity(&size("brace_thickness", "Thickness of the braces; by default half an axle."), &mut self.brace_thickness);
        v.quantity(
            &size("hole", "Diameter of two mounting holes on the axis of the cam plate; without it there are none."),
            &mut self.hole,
        );
    }
}

impl Describe for Errors {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let angle = |key, doc| Param::new(key, doc).of(Dimension::Angle).within(-0.5, 0.5).default("0 deg");
        let shift = |key, doc| length(key, doc).within(-0.05, 0.05).default("0 mm");
        v.quantity(&angle("tilt", "Angle between the travel of the slider and the axis of the cam."), &mut self.tilt);
        let rotation = "Both profiles turned about the origin of the path, towards the axis: the cam narrows upwards.";
        v.quantity(&angle("profile_rotation", rotation), &mut self.profile_rotation);
        v.quantity(
            &angle("profile_rotation_right", "The right profile turned alone, added to the above."),
            &mut self.profile_rotation_right,
        );
        v.quantity(&angle("profile_rotation_left", "The left profile turned alone, added to the above."), &mut self.profile_rotation_left);
        v.quantity(&shift("profile_offset", "Both profiles shifted outwards."), &mut self.profile_offset);
        v.quantity(
            &shift("profile_offset_right", "The right profile shifted outwards, added to the above."),
            &mut self.profile_offset_right,
        );
        v.quantity(&shift("profile_offset_left", "The left profile shifted outwards, added to the above."), &mut self.profile_offset_left);
        v.quantity(&shift("profile_height", "Both profiles shifted along the travel."), &mut self.profile_height);
        self.measured_profile.describe(
            v,
            &Param::new("measured_profile", "Points measured on the cam that was made: they take the place of the designed profile."),
        );
        self.random_profile.describe(v, &Param::new("random_profile", "A random error of the profile, as a process leaves it."));
    }
}

impl Describe for MeasuredProfile {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let file =
            "Points on the surface, a CSV file: `x / mm, y / mm`, in coordinates near those of the drawing; their rigid motion is found.";
        v.file(&Param::new("file", file).required(), &mut self.file);
        v.choice(&Param::new("side", "What was measured.").default("both"), SIDES, &mut self.side);
        let noise = "Standard deviation of the measurement along the normal; by default it is estimated.";
        v.quantity(&length("noise", noise).within(1e-9, 1e-2), &mut self.noise);
    }
}

impl Describe for RandomProfile {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let deviation = length("deviation", "Standard deviation along the normal.").within(0.0, 1e-2);
        v.quantity(&deviation.required(), &mut self.deviation);
        let correlation = length("correlation_length", "Length along the profile over which deviations keep together.");
        v.quantity(&correlation.within(1e-4, 1.0).required(), &mut self.correlation_length);
        let seed = "Which draw, rounded to a whole number; 1 without it. Where it scatters, a tolerance study draws a profile for every design: `seed = \"5000 ± 4999\"`.";
        v.quantity(&Param::new("seed", seed).within(0.0, 1e9), &mut self.seed);
    }
}

impl Describe for Motion {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.choice(&Param::new("law", "How the slider moves over time."), LAWS, &mut self.law);
        v.quantity(&length("start", "Its travel s at the beginning.").within(0.0, LARGEST_M), &mut self.start);
        v.quantity(
            &length("rise", "How far it moves, but for `release`; below zero it moves back.").within(-LARGEST_M, LARGEST_M),
            &mut self.rise,
        );
        let doc = "Torque cam: turn θ of the disc at the beginning.";
        v.quantity(&angle("start_turn", doc).within(0.0, LARGEST_TURN_RAD), &mut self.start_turn);
        let doc = "Torque cam: how far the disc turns; below zero it turns back.";
        v.quantity(&angle("rise_turn", doc).within(-LARGEST_TURN_RAD, LARGEST_TURN_RAD), &mut self.rise_turn);
        let time = |key, doc| Param::new(key, doc).of(Dimension::Time).within(1e-4, 1e5);
        v.quantity(&time("duration", "How long that takes, T; after a release, how long it is watched."), &mut self.duration);
        v.quantity(&time("reference_duration", "A slower motion to compare with."), &mut self.reference_duration);
        v.quantity(&time("pause", "How long the slider rests after the stroke.").within(0.0, 1e5), &mut self.pause);
        v.flag(&Param::new("return", "Whether it then moves back to `start` in the same time: a repetition."), &mut self.back);
        let pull = Param::new("pull", "Released: constant pull along the travel.").of(Dimension::Force).within(-1e6, 1e6);
        v.quantity(&pull, &mut self.pull);
        let mass = "Released: mass on a cable that pulls along the travel; the cable goes slack where it would have to push.";
        v.quantity(&Param::new("hanging_mass", mass).of(Dimension::Mass).above(0.0, 1e4), &mut self.hanging_mass);
        let gravity = Param::new("hanging_gravity", "Gravity of the hanging mass, whichever way the mechanism lies.");
        v.quantity(&gravity.of(Dimension::Acceleration).above(0.0, 100.0).default("9.81 m/s^2"), &mut self.hanging_gravity);
        let damping = Param::new("damping", "Released: viscous damping of the slider, force over speed.");
        v.quantity(&damping.of(Dimension::Damping).within(0.0, 1e6), &mut self.damping);
        v.choice(&Param::new("guide", "How the slider is guided, also at rest.").default("rigid"), GUIDES, &mut self.guide);
    }
}

impl Describe for Model {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.choice(
            &Param::new("spring_mass", "How the springs' mass moves with the rollers.").default("bar"),
            SPRING_MASSES,
            &mut self.spring_mass,
        );
    }
}
