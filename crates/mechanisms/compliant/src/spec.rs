//! The project file of a compliant mechanism as it is typed: every parameter is described here, once.

use forcewright_base::units::{Dimension, Quantity};
use forcewright_beam::{Network, Shape};
use forcewright_contract::describe::{Along, Describe, Form, Located, Member, Param, Reserved, Section, Slot, Visitor, Word};
use forcewright_contract::header::Header;
use forcewright_contract::metrics::Limits;
use forcewright_contract::studies::Studies;

use crate::metrics::CompliantMetrics;
use crate::scenario::Scenario;
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
    /// `[process]`
    pub(crate) process: Section<Process>,
    /// `[design]`
    pub(crate) design: Section<Design>,
    /// `[layout]`
    pub(crate) layout: Section<Layout>,
    /// `[parts]`
    pub(crate) parts: Section<Parts>,
    /// `[load]`, or `[[load]]` in order
    pub(crate) load: Vec<Member<Load>>,
    /// `[scenario]`
    pub(crate) scenario: Section<Scenario>,
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
    pub travel: Slot<Quantity>,
    pub stress: Section<StressRequirement>,
    pub fatigue: Section<FatigueRequirement>,
    pub hold: Section<HoldRequirement>,
    pub stiffness: Section<StiffnessRequirement>,
    pub envelope: Section<Envelope>,
    pub limits: Section<Limits<CompliantMetrics>>,
}

/// The box that the layout, or the drawn network alone, stays in.
#[derive(Debug, Default)]
pub(crate) struct Envelope {
    pub x: Slot<[Quantity; 2]>,
    pub y: Slot<[Quantity; 2]>,
    pub of: Slot<&'static str>,
}

/// A force level and how far from it the force may be.
#[derive(Debug, Default)]
pub(crate) struct ForceRequirement {
    pub nominal: Slot<Quantity>,
    pub band: Slot<Quantity>,
}

/// How much stress is allowed.
#[derive(Debug, Default)]
pub(crate) struct StressRequirement {
    pub safety_factor: Slot<Quantity>,
    pub max: Slot<Quantity>,
}

/// How often it goes through its travel.
#[derive(Debug, Default)]
pub(crate) struct FatigueRequirement {
    pub cycles: Slot<Quantity>,
    pub safety_factor: Slot<Quantity>,
}

/// How long it is held, and how much of its force must be left then.
#[derive(Debug, Default)]
pub(crate) struct HoldRequirement {
    pub time: Slot<Quantity>,
    pub force_left: Slot<Quantity>,
}

/// Which slopes of the force are allowed.
#[derive(Debug, Default)]
pub(crate) struct StiffnessRequirement {
    pub min: Slot<Quantity>,
    pub max: Slot<Quantity>,
}

/// What the beams are made of: the material of all that name none, and those that are named.
#[derive(Debug, Default)]
pub(crate) struct Materials {
    pub common: Material,
    pub named: Vec<Member<Material>>,
}

/// A material.
#[derive(Clone, Debug, Default)]
pub(crate) struct Material {
    pub catalogue: Slot<String>,
    pub young_modulus: Slot<Quantity>,
    pub poisson_ratio: Slot<Quantity>,
    pub yield_stress: Slot<Quantity>,
    pub tensile_strength: Slot<Quantity>,
    pub density: Slot<Quantity>,
    pub fatigue: Section<FatigueStrength>,
}

/// What a material endures.
#[derive(Clone, Debug, Default)]
pub(crate) struct FatigueStrength {
    pub amplitude: Slot<Quantity>,
    pub cycles: Slot<Quantity>,
    pub ratio: Slot<Quantity>,
}

/// How it is made.
#[derive(Debug, Default)]
pub(crate) struct Process {
    pub method: Slot<&'static str>,
    pub cutter_diameter: Slot<Quantity>,
    pub wall_min: Slot<Quantity>,
    pub gap_min: Slot<Quantity>,
}

/// The plate that is cut.
#[derive(Debug, Default)]
pub(crate) struct Parts {
    pub fillet: Slot<Quantity>,
    pub pad: Slot<[Quantity; 2]>,
    pub hole: Slot<Quantity>,
}

/// The flexure network.
#[derive(Debug, Default)]
pub(crate) struct Design {
    pub thickness: Slot<Quantity>,
    pub depth: Slot<Quantity>,
    pub nodes: Vec<Member<Node>>,
    pub bodies: Vec<Member<Body>>,
    pub beams: Vec<Member<Beam>>,
}

/// A node.
#[derive(Clone, Debug, Default)]
pub(crate) struct Node {
    pub at: Slot<[Quantity; 2]>,
    pub held: Held,
    pub on: Section<On>,
}

/// Where an optimiser may move a node.
#[derive(Clone, Debug, Default)]
pub(crate) struct On {
    pub line: Slot<Vec<Located<[Quantity; 2]>>>,
}

/// A rigid body that joins nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Body {
    pub nodes: Slot<Vec<Located<String>>>,
    pub held: Held,
}

/// How the ground holds a node or a body.
#[derive(Clone, Debug, Default)]
pub(crate) struct Held {
    pub support: Slot<&'static str>,
    pub direction: Slot<[f64; 2]>,
    pub rotation: Slot<&'static str>,
}

/// A beam.
#[derive(Clone, Debug, Default)]
pub(crate) struct Beam {
    pub between: Slot<Vec<Located<String>>>,
    pub bend: Slot<Vec<f64>>,
    pub straight: Slot<bool>,
    pub arc: Slot<Quantity>,
    pub through: Slot<Vec<Located<[Quantity; 2]>>>,
    pub angle: Slot<Vec<f64>>,
    pub length: Slot<Quantity>,
    pub thickness: Slot<Along>,
    pub material: Slot<String>,
    pub hinged: Slot<Vec<Located<String>>>,
}

/// Copies of the drawn network.
#[derive(Debug, Default)]
pub(crate) struct Layout {
    pub mirror: Slot<String>,
    pub array: Section<Array>,
    pub circular: Section<Circular>,
    pub plates: Slot<u32>,
    pub series: Slot<u32>,
}

/// Rows of copies in the plane.
#[derive(Debug, Default)]
pub(crate) struct Array {
    pub count: Slot<u32>,
    pub spacing: Slot<Quantity>,
    pub direction: Slot<[f64; 2]>,
}

/// Copies around an axis along the load.
#[derive(Debug, Default)]
pub(crate) struct Circular {
    pub count: Slot<u32>,
    pub radius: Slot<Quantity>,
}

/// What happens to it.
#[derive(Debug, Default)]
pub(crate) struct Load {
    pub node: Slot<String>,
    pub direction: Slot<[f64; 2]>,
    pub travel: Slot<Quantity>,
    pub force: Slot<Quantity>,
    pub moment: Slot<Quantity>,
    pub rotation: Slot<Quantity>,
}

/// Which equations are solved, and how well.
#[derive(Debug, Default)]
pub(crate) struct Model {
    pub beam: Slot<&'static str>,
    pub joints: Slot<&'static str>,
    pub accuracy: Slot<Quantity>,
}

/// Supports of a node.
pub(crate) const SUPPORTS: &[Word] = &[
    Word { word: "clamped", doc: "position and rotation fixed" },
    Word { word: "pinned", doc: "position fixed, free to rotate" },
    Word { word: "slider", doc: "moves along `direction`" },
    Word { word: "parallel", doc: "moves in any direction, keeps its angle" },
];
/// Rotation of a slider.
pub(crate) const ROTATIONS: &[Word] = &[Word { word: "fixed", doc: "keeps its angle" }, Word { word: "free", doc: "turns freely" }];
/// Beam models.
pub(crate) const BEAM_MODELS: &[Word] = &[
    Word { word: "reissner", doc: "geometrically exact: bending, stretching and shear" },
    Word { word: "inextensible", doc: "bending only, as in the paper" },
];
/// What stays in an envelope.
pub(crate) const ENVELOPED: &[Word] = &[
    Word { word: "layout", doc: "the drawn network with its copies in the plane: mirrored half, rows, the leg opposite around an axis" },
    Word { word: "drawn", doc: "the drawn network alone" },
];
/// Models of joints.
pub(crate) const JOINT_MODELS: &[Word] = &[
    Word { word: "point", doc: "beams meet at points" },
    Word { word: "overlap", doc: "rigid zones where beams of finite thickness meet" },
];
/// Ways of making it.
pub(crate) const METHODS: &[Word] = &[
    Word { word: "milling", doc: "milled from sheet" },
    Word { word: "laser", doc: "laser cut" },
    Word { word: "waterjet", doc: "waterjet cut" },
    Word { word: "wire-edm", doc: "wire eroded" },
    Word { word: "printing", doc: "printed in layers" },
    Word { word: "moulding", doc: "injection moulded" },
];

const LARGEST_M: f64 = 10.0;
/// A hundredth of a micrometre: below it no beam is made and no travel is meant.
const SMALLEST_M: f64 = 1e-8;
/// Of one body.
const MOST_NODES: usize = 64;
/// A nanonewton.
const SMALLEST_N: f64 = 1e-9;

const RESERVED_SECTIONS: &[Reserved] = &[
    Reserved {
        key: "environment",
        instead: "compliant mechanisms are solved without gravity, at the temperature of the material data",
        ignored: true,
    },
    Reserved { key: "errors", instead: "errors of making are not available yet; change the parameter itself", ignored: false },
];
/// Of copies in one direction.
const MOST_COPIES: f64 = 100.0;

impl Describe for Spec {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.header.describe(v);
        self.requirements.describe(v, &Param::new("requirements", "What the mechanism must do. Tested, never changed by a study."));
        self.material.describe(v, &Param::new("material", "What the beams are made of.").required());
        self.process.describe(v, &Param::new("process", "How it is made: for the part, not for the force."));
        self.design.describe(v, &Param::new("design", "The flexure network.").required());
        self.layout.describe(v, &Param::new("layout", "Copies of the drawn network; force, travel, energy, mass and pictures follow."));
        self.parts.describe(v, &Param::new("parts", "The plate that is cut: pads, holes, fillets. Without influence on the force."));
        v.members(
            &Param::new(
                "load",
                "What happens to it: one load, or several in order. The last one is the path; the others are held at their ends.",
            )
            .required(),
            Form::Stages,
            &mut self.load,
        );
        self.scenario.describe(v, &Param::new("scenario", "What a robot does with it."));
        self.model.describe(v, &Param::new("model", "Which equations are solved, and how well."));
        self.synthesise.describe(v, &Param::new("synthesise", "What `forcewright synthesise` may use: room, depth, plates."));
        self.studies.describe(v);
        v.reserved(RESERVED_SECTIONS);
    }
}

impl Describe for Requirements {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.force.describe(v, &Param::new("force", "Level and band of the force."));
        v.quantity(
            &Param::new("travel", "Usable stroke: shortest displacement over which the force must stay inside the band.")
                .of(Dimension::Length)
                .above(0.0, LARGEST_M),
            &mut self.travel,
        );
        self.stress.describe(v, &Param::new("stress", "Stress allowed over the whole travel."));
        self.fatigue.describe(v, &Param::new("fatigue", "How often it goes from rest through the whole travel and back."));
        self.hold
            .describe(v, &Param::new("hold", "How long a displacement is held, at room temperature, and how much force is left then."));
        self.stiffness
            .describe(v, &Param::new("stiffness", "Slope dF/dΔ over the whole travel; without this section, no negative stiffness."));
        self.envelope.describe(
            v,
            &Param::new("envelope", "Box in which the beams of the layout stay with their thickness, at rest and over the whole travel."),
        );
        self.limits.describe(v, &Param::new("limits", "Limits on any metric, by its name."));
    }
}

impl Describe for ForceRequirement {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(
            &Param::new("nominal", "Force level; without it the level is free.").of(Dimension::Force).above(0.0, 1e6),
            &mut self.nominal,
        );
        v.quantity(&Param::new("band", "Half width β of the band, relative to the level.").above(0.0, 0.9).required(), &mut self.band);
    }
}

impl Describe for StressRequirement {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&Param::new("safety_factor", "Yield stress over the largest stress.").within(0.1, 100.0), &mut self.safety_factor);
        v.quantity(&Param::new("max", "Largest stress, instead of a safety factor.").of(Dimension::Stress).above(0.0, 1e12), &mut self.max);
    }
}

impl Describe for FatigueRequirement {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&Param::new("cycles", "Times there and back.").within(1.0, 1e12).required(), &mut self.cycles);
        let factor = Param::new("safety_factor", "What is endured over what is there, by Goodman's line.");
        v.quantity(&factor.within(0.1, 100.0).default("1"), &mut self.safety_factor);
    }
}

impl Describe for HoldRequirement {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.quantity(&Param::new("time", "How long.").of(Dimension::Time).above(0.0, 1e10).required(), &mut self.time);
        let left = Param::new("force_left", "Least force after that time, relative to that at its beginning.");
        v.quantity(&left.above(0.0, 1.0).required(), &mut self.force_left);
    }
}

impl Describe for StiffnessRequirement {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let slope = |key, doc| Param::new(key, doc).of(Dimension::Stiffness).within(-1e12, 1e12);
        v.quantity(&slope("min", "Least slope; negative stiffness makes a force-driven device jump.").default("0 N/m"), &mut self.min);
        v.quantity(&slope("max", "Largest slope."), &mut self.max);
    }
}

impl Describe for Envelope {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let side = |key, doc| Param::new(key, doc).of(Dimension::Length).within(-LARGEST_M, LARGEST_M);
        v.point(&side("x", "From left to right, two values of x; without it any x."), &mut self.x);
        v.point(&side("y", "From bottom to top, two values of y; without it any y."), &mut self.y);
        v.choice(&Param::new("of", "What stays in it.").default("layout"), ENVELOPED, &mut self.of);
    }
}

impl Describe for Materials {
    fn describe(&mut self, v: &mut dyn Visitor) {
        self.common.describe(v);
        v.tables(
            &Param::new("*", "A material that beams name by `material`; the keys beside it are those of the other beams."),
            &mut self.named,
        );
    }
}

impl Describe for Material {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.text(&Param::new("use", "Entry of the material catalogue; the keys below override its values."), &mut self.catalogue);
        v.quantity(&Param::new("young_modulus", "Young's modulus E.").of(Dimension::Stress).within(1e3, 1e13), &mut self.young_modulus);
        v.quantity(
            &Param::new("poisson_ratio", "Poisson's ratio ν; only the shear of the Reissner model uses it.").within(0.0, 0.5),
            &mut self.poisson_ratio,
        );
        v.quantity(&Param::new("yield_stress", "Yield stress σ_y.").of(Dimension::Stress).above(0.0, 1e11), &mut self.yield_stress);
        let strength = Param::new("tensile_strength", "Largest stress of the tensile test; only the check of fatigue uses it.");
        v.quantity(&strength.of(Dimension::Stress).above(0.0, 1e11), &mut self.tensile_strength);
        v.quantity(&Param::new("density", "Density.").of(Dimension::Density).above(0.0, 3e4), &mut self.density);
        self.fatigue.describe(v, &Param::new("fatigue", "A stress that it endures, instead of that of the catalogue."));
    }
}

impl Describe for FatigueStrength {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let amplitude = Param::new("amplitude", "Amplitude of the stress, half its range.");
        v.quantity(&amplitude.of(Dimension::Stress).above(0.0, 1e11).required(), &mut self.amplitude);
        v.quantity(&Param::new("cycles", "Cycles endured.").within(1.0, 1e12).required(), &mut self.cycles);
        let ratio = Param::new("ratio", "Lowest over highest stress of a cycle: 0 is pulsating, -1 fully reversed, as without this key.");
        v.quantity(&ratio.within(-1.0, 0.95), &mut self.ratio);
    }
}

impl Describe for Process {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.choice(&Param::new("method", "How it is made."), METHODS, &mut self.method);
        v.quantity(
            &Param::new("cutter_diameter", "Diameter of the cutter: twice the smallest inner radius.")
                .of(Dimension::Length)
                .above(0.0, 0.1),
            &mut self.cutter_diameter,
        );
        let least = |key, doc| Param::new(key, doc).of(Dimension::Length).above(0.0, 0.1);
        v.quantity(&least("wall_min", "Thinnest wall that the process leaves standing."), &mut self.wall_min);
        v.quantity(&least("gap_min", "Narrowest gap that it cuts; by default the diameter of the cutter."), &mut self.gap_min);
    }
}

impl Describe for Parts {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let length = |key, doc| Param::new(key, doc).of(Dimension::Length);
        v.quantity(
            &length("fillet", "Radius in inner corners; by default that of the cutter, or else half the thinnest thickness.")
                .above(0.0, 0.1),
            &mut self.fillet,
        );
        v.point(
            &length(
                "pad",
                "Size of the pads where the ground or a guide holds a node: along the edge that its beams leave, and away from them. By default six thicknesses, and twice the hole.",
            )
            .above(0.0, 1.0),
            &mut self.pad,
        );
        v.quantity(&length("hole", "Diameter of a hole in every pad and block; without it there is none.").above(0.0, 0.5), &mut self.hole);
    }
}

impl Describe for Design {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let thickness = |doc| Param::new("thickness", doc).of(Dimension::Length).within(SMALLEST_M, 1.0);
        v.quantity(&thickness("In-plane thickness w of all beams that do not give their own."), &mut self.thickness);
        v.quantity(
            &Param::new("depth", "Out-of-plane depth t of all beams.").of(Dimension::Length).within(SMALLEST_M, LARGEST_M).required(),
            &mut self.depth,
        );
        v.members(&Param::new("nodes", "Where beams meet and where the ground holds them.").required(), Form::Table, &mut self.nodes);
        v.members(
            &Param::new("bodies", "Rigid bodies: several nodes that move and turn as one, joined by something stiff."),
            Form::Table,
            &mut self.bodies,
        );
        v.members(&Param::new("beams", "Flexible beams.").required(), Form::List, &mut self.beams);
    }
}

impl Describe for Node {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let coordinate = Param::new("at", "Position [x, y]; may be left out where beams given by `angle` and `length` lead there.");
        v.point(&coordinate.of(Dimension::Length).within(-LARGEST_M, LARGEST_M), &mut self.at);
        self.held.describe(v, "How the ground holds it; without it the node is free.");
        self.on.describe(v, &Param::new("on", "Where an optimiser may move it; without it anywhere in its range."));
    }
}

impl Describe for Body {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.names(&Param::new("nodes", "The nodes that it joins, at least two.").required(), 2, MOST_NODES, &mut self.nodes);
        self.held.describe(
            v,
            "How the ground holds all of it, if that keeps its angle; what lets it turn (pinned, a slider that turns) stands at one of its nodes.",
        );
    }
}

impl Held {
    fn describe(&mut self, v: &mut dyn Visitor, support: &'static str) {
        v.choice(&Param::new("support", support), SUPPORTS, &mut self.support);
        v.direction(&Param::new("direction", "Direction in which a slider moves."), &mut self.direction);
        v.choice(&Param::new("rotation", "Whether a slider may turn; fixed by default."), ROTATIONS, &mut self.rotation);
    }
}

impl Describe for On {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let line = Param::new("line", "The two ends of a straight line that it stays on, `[[x, y], [x, y]]`.");
        v.points(&line.of(Dimension::Length).within(-LARGEST_M, LARGEST_M).required(), 2, &mut self.line);
    }
}

impl Describe for Beam {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.names(&Param::new("between", "The two nodes it joins, from u = 0 to u = 1.").required(), 2, 2, &mut self.between);
        v.numbers(
            &Param::new(
                "bend",
                "Coefficients c1…cm of the intrinsic angle η(u) = c0 + c1·u + … in rad; c0 and the length follow from the nodes.",
            )
            .within(-50.0, 50.0),
            &mut self.bend,
        );
        v.flag(&Param::new("straight", "A straight beam."), &mut self.straight);
        v.quantity(
            &Param::new("arc", "A circular arc that turns by this angle, counter-clockwise positive.")
                .of(Dimension::Angle)
                .within(-6.2, 6.2),
            &mut self.arc,
        );
        v.points(
            &Param::new(
                "through",
                "Points [x, y] of its axis in order, without the nodes: the smooth shape with as many bend coefficients.",
            )
            .of(Dimension::Length)
            .within(-LARGEST_M, LARGEST_M),
            Shape::MOST_POINTS,
            &mut self.through,
        );
        v.numbers(
            &Param::new("angle", "Coefficients c0…cm of the intrinsic angle in rad, with `length`; the nodes then follow.")
                .within(-50.0, 50.0),
            &mut self.angle,
        );
        v.quantity(
            &Param::new("length", "Arc length, with `angle`.").of(Dimension::Length).within(SMALLEST_M, LARGEST_M),
            &mut self.length,
        );
        let own =
            Param::new("thickness", "Its own in-plane thickness w, the same all along or at places u from 0 to 1, linear between them.");
        v.along(&own.of(Dimension::Length).within(SMALLEST_M, 1.0), Network::MOST_PLACES, &mut self.thickness);
        v.text(&Param::new("material", "Its own material, by its name in `[material]`."), &mut self.material);
        v.names(&Param::new("hinged", "Ends, by their nodes, that turn freely."), 0, 2, &mut self.hinged);
    }
}

impl Describe for Layout {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.text(&Param::new("mirror", "Mirror line, `x = 0` or `y = 2 mm`: the mechanism has a mirrored second half."), &mut self.mirror);
        self.array.describe(v, &Param::new("array", "Rows of copies in the plane, all on one block: forces add."));
        self.circular.describe(
            v,
            &Param::new("circular", "Copies in planes around an axis along the load, all on one block: forces add. Not with `mirror`."),
        );
        let count = |key, doc| Param::new(key, doc).within(1.0, MOST_COPIES).default("1");
        v.count(&count("plates", "Equal plates behind each other on one block: forces add."), &mut self.plates);
        v.count(
            &count("series", "Layers in series, each carried by the one before: displacements add at the same force."),
            &mut self.series,
        );
    }
}

impl Describe for Array {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.count(&Param::new("count", "Rows, the drawn one included.").within(2.0, MOST_COPIES).required(), &mut self.count);
        let spacing = Param::new("spacing", "From each row to the next.").of(Dimension::Length).within(SMALLEST_M, LARGEST_M);
        v.quantity(&spacing.required(), &mut self.spacing);
        v.direction(&Param::new("direction", "Direction from each row to the next; along the load by default."), &mut self.direction);
    }
}

impl Describe for Circular {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.count(
            &Param::new("count", "Copies around the axis, the drawn one included.").within(2.0, MOST_COPIES).required(),
            &mut self.count,
        );
        let radius = Param::new("radius", "Distance of the load node from the axis, which lies on its side away from the network.");
        v.quantity(&radius.of(Dimension::Length).within(0.0, LARGEST_M).required(), &mut self.radius);
    }
}

impl Describe for Load {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.text(&Param::new("node", "The node that is moved or loaded.").required(), &mut self.node);
        v.direction(
            &Param::new("direction", "Direction of the displacement Δ and of the force F on the mechanism; with `travel` and `force`."),
            &mut self.direction,
        );
        v.quantity(
            &Param::new("travel", "Largest displacement d of the whole layout, from where the load before left the node: of two layers in series each takes half.")
                .of(Dimension::Length)
                .within(SMALLEST_M, LARGEST_M),
            &mut self.travel,
        );
        v.quantity(
            &Param::new("force", "Largest force, of constant direction, on the whole layout: of two copies each takes half.")
                .of(Dimension::Force)
                .within(SMALLEST_N, 1e9),
            &mut self.force,
        );
        v.quantity(
            &Param::new("moment", "Moment, counter-clockwise, before the last load; of two halves each takes half, the other way round.")
                .of(Dimension::Torque)
                .within(-1e9, 1e9),
            &mut self.moment,
        );
        v.quantity(
            &Param::new("rotation", "Rotation, counter-clockwise, before the last load; the mirrored half turns the other way.")
                .of(Dimension::Angle)
                .within(-50.0, 50.0),
            &mut self.rotation,
        );
    }
}

impl Describe for Model {
    fn describe(&mut self, v: &mut dyn Visitor) {
        v.choice(&Param::new("beam", "Deformations of a beam.").default("reissner"), BEAM_MODELS, &mut self.beam);
        v.choice(&Param::new("joints", "How beams meet.").default("point"), JOINT_MODELS, &mut self.joints);
        v.quantity(
            &Param::new("accuracy", "Error allowed, relative to the largest force on the path. Given in a file, it holds for every design of a tolerance study too; without it, those are computed to 3e-5.").within(1e-12, 1e-2).default("1e-8"),
            &mut self.accuracy,
        );
    }
}
