//! From what was typed to a design: references checked, catalogue values in place, SI numbers.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::units::{Dimension, Quantity, Unit};
use forcewright_beam::{Beam, Joint, Joints, Network, Node, Point, Section, Settings, Shape, Theory, ThroughError};
use forcewright_contract::describe::{Along, Located, Member, Origin, Slot};
use forcewright_contract::metrics::{Limit, check_order};

use crate::bodies::{self, Body, DrawnNode, Grouping, find_node};
use crate::endurance::{FatigueLimit, HoldLimit};
use crate::layout::{self, Layout, Mirror, parse_mirror};
use crate::loads::{self, Control, Loads};
use crate::material::{Material, check_complete, fill_materials, typed_material};
use crate::parts::Making;
use crate::rules::{check_held, check_joints, check_mirror, check_network};
use crate::scenario;
use crate::spec::{self, Spec};

/// A design, ready to be solved. SI units.
#[derive(Clone, Debug)]
pub struct Design {
    /// The project's title.
    pub title: String,
    /// Nodes, beams, supports and the drive of the drawn network; members in the order of their names.
    pub network: Network,
    /// Names of the nodes, in the order of the network; of a body the node at whose place it lies.
    pub node_names: Vec<String>,
    /// The nodes as drawn, in the order of their names: without bodies those of the network.
    pub drawn: Vec<DrawnNode>,
    /// The rigid bodies, in the order of their names.
    pub bodies: Vec<Body>,
    /// Names of the beams, in the order of the network.
    pub beam_names: Vec<String>,
    /// Copies of the drawn network.
    pub layout: Layout,
    /// The node of the last load.
    pub load_node: usize,
    /// The drawn nodes of all loads, in order.
    pub loaded: Vec<usize>,
    /// Unit vector of the displacement.
    pub direction: [f64; 2],
    /// What grows along the path: the displacement or the force.
    pub control: Control,
    /// Its largest value on the drawn network: the displacement, m, or the force, N.
    pub load_end: f64,
    /// Where that value stands in the project.
    pub load_key: String,
    /// What the beams are made of.
    pub materials: Vec<Material>,
    /// Index of the material of each beam, in the order of the network.
    pub beam_materials: Vec<usize>,
    /// Beam model.
    pub theory: Theory,
    /// How beams of finite thickness meet.
    pub joints: Joints,
    /// Error allowed, relative to the largest force.
    pub accuracy: f64,
    /// How it is made.
    pub making: Making,
    /// The surface that its tip is drawn along.
    pub surface: Option<scenario::Surface>,
    /// The motion of its tip across the load.
    pub lateral: Option<scenario::Lateral>,
    /// What it must do; `None` if the project asks for nothing.
    pub requirements: Option<Requirements>,
    /// Units in which people are shown results.
    pub units: DisplayUnits,
}

impl Design {
    /// How many copies of the drawn network share the force.
    pub fn copies(&self) -> f64 {
        self.layout.copies()
    }

    /// How many layers share the displacement.
    pub fn layers(&self) -> f64 {
        self.layout.layers()
    }

    /// Where a beam starts at rest, m.
    pub fn start_m(&self, beam: &Beam) -> [f64; 2] {
        self.attached_m(beam.start, beam.arms_m[0])
    }

    /// Where a beam ends at rest, m.
    pub fn end_m(&self, beam: &Beam) -> [f64; 2] {
        self.attached_m(beam.end, beam.arms_m[1])
    }

    /// Where a drawn node is in a state, m.
    pub fn moved_m(&self, drawn: &DrawnNode, point: &Point) -> [f64; 2] {
        let (Some(node), Some(state)) = (self.network.nodes.get(drawn.node), point.nodes.get(drawn.node)) else { return drawn.position_m };
        let (at, moved) = (node.position_m, state.displacement_m);
        let [x, y] = [drawn.position_m[0] - at[0], drawn.position_m[1] - at[1]];
        let (sin, cos) = forcewright_base::maths::sin_cos(state.rotation_rad);
        [at[0] + moved[0] + cos * x - sin * y, at[1] + moved[1] + sin * x + cos * y]
    }

    fn attached_m(&self, node: usize, arm_m: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.network.nodes.get(node).map_or([0.0; 2], |n| n.position_m);
        [x + arm_m[0], y + arm_m[1]]
    }

    /// How its path is computed.
    pub fn settings(&self) -> Settings {
        Settings { theory: self.theory, accuracy: self.accuracy, joints: self.joints, ..Settings::default() }
    }
}

/// What the mechanism must do, SI.
#[derive(Clone, Debug)]
pub struct Requirements {
    /// Half width of the force band, and the level if it is not free.
    pub force: Option<(f64, Option<f64>)>,
    /// Shortest usable stroke, m.
    pub travel_m: Option<f64>,
    /// What the stress is held against.
    pub stress: Option<StressLimit>,
    /// How often it goes through its travel, and with which safety.
    pub fatigue: Option<FatigueLimit>,
    /// How long it is held, and what must be left of its force.
    pub hold: Option<HoldLimit>,
    /// Least slope, N/m.
    pub stiffness_min: f64,
    /// Largest slope, N/m.
    pub stiffness_max: Option<f64>,
    /// The box asked for, that the layout or the drawn network stays in with its thickness.
    pub asked_envelope: Option<Envelope>,
    /// The box that the drawn network stays in: where it does, its copies are in the box asked for.
    pub envelope: Option<Envelope>,
    /// Limits on metrics.
    pub limits: Vec<Limit>,
}

/// A box along the axes of coordinates; a side may be infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Envelope {
    /// Least x and y, m.
    pub low_m: [f64; 2],
    /// Largest x and y, m.
    pub high_m: [f64; 2],
}

/// What the stress is held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StressLimit {
    /// The yield stress itself: what holds when nothing is asked for.
    Yield,
    /// Yield stress over this factor.
    SafetyFactor(f64),
    /// A stress, Pa.
    Stress(f64),
}

impl Design {
    /// The material of a beam.
    pub fn material_of(&self, beam: usize) -> Option<&Material> {
        self.materials.get(*self.beam_materials.get(beam)?)
    }

    /// Yield stress of a beam, Pa, if known.
    pub fn yield_pa(&self, beam: usize) -> Option<f64> {
        self.material_of(beam)?.yield_pa
    }

    /// The largest stress allowed in a beam, Pa, if one is asked for and the yield stress is known where it is needed.
    pub fn allowable_pa(&self, beam: usize) -> Option<f64> {
        match self.requirements.as_ref()?.stress? {
            StressLimit::Yield => self.yield_pa(beam),
            StressLimit::Stress(stress_pa) => Some(stress_pa),
            StressLimit::SafetyFactor(factor) => Some(self.yield_pa(beam)? / factor),
        }
    }

    /// The largest stress allowed, Pa, where it is the same in all beams.
    pub fn common_allowable_pa(&self) -> Option<f64> {
        let mut all = (0..self.network.beams.len()).map(|beam| self.allowable_pa(beam));
        let first = all.next()??;
        all.all(|other| other.is_some_and(|o| o.to_bits() == first.to_bits())).then_some(first)
    }
}

/// Units in which people are shown results: those that they typed.
#[derive(Clone, Debug)]
pub struct DisplayUnits {
    /// Displacements.
    pub displacement: Unit,
    /// Lengths of the drawing.
    pub length: Unit,
    /// Forces.
    pub force: Unit,
    /// Stresses.
    pub stress: Unit,
    /// Slopes of the force.
    pub stiffness: Unit,
}

fn unit_or(slot: Option<&Quantity>, symbol: &str, dimension: Dimension) -> Unit {
    slot.map(|q| q.unit.clone()).or_else(|| Unit::parse(symbol).ok()).unwrap_or_else(|| Unit::si(dimension))
}

fn quantity(slot: Option<&Located<Quantity>>) -> Option<&Quantity> {
    slot.map(|l| &l.value)
}

pub(crate) fn si(slot: Option<&Located<Quantity>>) -> Option<f64> {
    quantity(slot).map(|q| q.si)
}

/// Reads a design from what was typed. Everything wrong goes into `diagnostics`.
pub(crate) fn resolve(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<Design> {
    let place = spec.design.present.as_ref().map(|p| p.span).unwrap_or_default();
    // Members in the order of their names: the result does not depend on the order of the file.
    spec.design.nodes.sort_by(|a, b| a.name.value.cmp(&b.name.value));
    spec.design.beams.sort_by(|a, b| a.name.value.cmp(&b.name.value));
    let used = fill_materials(spec, diagnostics);
    let mut requirements = requirements_of(spec, used.materials.iter().all(|m| m.yield_pa.is_some()), diagnostics);
    let mut builder = Builder { spec, diagnostics, place };
    let built = builder.network()?;
    let mirror = builder.mirror(&built);
    if diagnostics.has_errors() {
        return None;
    }
    let Built { network, loads, grouping, drawn, bodies, loaded } = built;
    check_network(&network, &grouping, spec, place, diagnostics);
    check_held(&network, spec, diagnostics);
    let joints = joints_of(spec);
    check_joints(&network, joints, spec, place, diagnostics);
    if let Some(mirror) = mirror {
        check_mirror(&network, &drawn, mirror, spec, diagnostics);
    }
    let layout = layout::resolve(spec, mirror, &network, &loads, diagnostics);
    if let Some(requirements) = requirements.as_mut().filter(|_| spec.requirements.envelope.of.as_ref().is_none_or(|o| o.value == "layout"))
    {
        requirements.envelope = requirements.envelope.map(|asked| layout.for_drawn(asked));
    }
    let surface = scenario::resolve(spec, &network, &loads, diagnostics);
    let lateral = scenario::lateral::resolve(spec, &network, &loads, &layout, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    let units = display_units(spec);
    Some(Design {
        title: spec.header.title.as_ref().map_or_else(|| "Compliant mechanism".to_owned(), |t| t.value.clone()),
        load_node: network.drive.node(),
        loaded,
        network,
        node_names: grouping.reference.iter().filter_map(|d| drawn.get(*d)).map(|n| n.name.clone()).collect(),
        drawn,
        bodies,
        beam_names: spec.design.beams.iter().map(|b| b.name.value.clone()).collect(),
        layout,
        direction: loads.direction,
        control: loads.control,
        load_end: loads.end,
        load_key: loads.key,
        materials: used.materials,
        beam_materials: used.of_beams,
        theory: theory_of(spec),
        joints,
        accuracy: si(spec.model.accuracy.as_ref())?,
        making: making_of(spec, diagnostics),
        surface,
        lateral,
        requirements,
        units,
    })
}

fn theory_of(spec: &Spec) -> Theory {
    match spec.model.beam.as_ref().map(|b| b.value) {
        Some("inextensible") => Theory::Inextensible,
        _ => Theory::Reissner,
    }
}

/// How it is made. A fillet that its cutter does not reach is reported.
fn making_of(spec: &Spec, diagnostics: &mut Diagnostics) -> Making {
    let (process, parts) = (&spec.process, &spec.parts);
    if let (Some(fillet), Some(cutter)) = (&parts.fillet, &process.cutter_diameter)
        && fillet.value.si < 0.5 * cutter.value.si * (1.0 - 1e-9)
    {
        diagnostics.push(
            Diagnostic::error("E0519", fillet.span, "the fillet is smaller than the cutter")
                .label("this radius")
                .related(cutter.span, "twice the smallest inner radius")
                .help("leave `fillet` out to take the radius of the cutter"),
        );
    }
    Making {
        cutter_m: si(process.cutter_diameter.as_ref()),
        wall_min_m: si(process.wall_min.as_ref()),
        gap_min_m: si(process.gap_min.as_ref()),
        fillet_m: si(parts.fillet.as_ref()),
        pad_m: parts.pad.as_ref().map(|p| [p.value[0].si, p.value[1].si]),
        hole_m: si(parts.hole.as_ref()),
    }
}

fn joints_of(spec: &Spec) -> Joints {
    match spec.model.joints.as_ref().map(|j| j.value) {
        Some("overlap") => Joints::Overlap,
        _ => Joints::Point,
    }
}

fn display_units(spec: &Spec) -> DisplayUnits {
    let displacement = unit_or(quantity(loads::last_travel(spec)), "mm", Dimension::Length);
    let force = quantity(spec.requirements.force.nominal.as_ref()).or(quantity(loads::last_force(spec)));
    let force = unit_or(force, "N", Dimension::Force);
    let typed = spec.requirements.stiffness.min.as_ref().filter(|s| s.origin == Origin::File).map(|s| &s.value);
    let slope = format!("{}/{}", force.symbol(), displacement.symbol());
    let first_node = spec.design.nodes.iter().find_map(|n| n.value.at.as_ref()).map(|at| &at.value[0]);
    let all = [&spec.material.common].into_iter().chain(spec.material.named.iter().map(|m| &m.value));
    let mut yields = all.filter_map(|m| m.yield_stress.as_ref());
    let stress = spec.requirements.stress.max.as_ref().or(yields.find(|y| y.origin == Origin::File));
    DisplayUnits {
        stiffness: unit_or(typed, &slope, Dimension::Stiffness),
        length: unit_or(first_node, "mm", Dimension::Length),
        stress: unit_or(stress.map(|s| &s.value), "MPa", Dimension::Stress),
        displacement,
        force,
    }
}

fn requirements_of(spec: &Spec, yield_is_known: bool, diagnostics: &mut Diagnostics) -> Option<Requirements> {
    let requirements = &spec.requirements;
    requirements.present.as_ref()?;
    let stress = match (&requirements.stress.safety_factor, &requirements.stress.max) {
        (Some(factor), Some(max)) => {
            diagnostics.push(
                Diagnostic::error("E0305", max.span, "`safety_factor` and `max` exclude each other")
                    .label("the second of two")
                    .related(factor.span, "the first")
                    .help("keep one"),
            );
            None
        }
        (Some(factor), None) => Some(StressLimit::SafetyFactor(factor.value.si)),
        (None, Some(max)) => Some(StressLimit::Stress(max.value.si)),
        // A part that yields does not do what its curve says, asked for or not.
        (None, None) => yield_is_known.then_some(StressLimit::Yield),
    };
    // A value that was given but not understood has been reported: the table does not say nothing.
    let sound = !diagnostics.has_errors();
    if let (Some(section), None, None) = (&requirements.stress.present, &requirements.stress.safety_factor, &requirements.stress.max)
        && sound
    {
        diagnostics.push(
            Diagnostic::error("E0302", section.span, "`stress` says nothing")
                .label("from this table")
                .help("give `safety_factor = 1.5` or `max = \"50 MPa\"`"),
        );
    }
    check_stroke(spec, sound, diagnostics);
    let limits = requirements.limits.resolve(diagnostics);
    check_order("stiffness.", requirements.stiffness.min.as_ref(), requirements.stiffness.max.as_ref(), diagnostics);
    let envelope = envelope_of(requirements, sound, diagnostics);
    Some(Requirements {
        asked_envelope: envelope,
        envelope,
        force: si(requirements.force.band.as_ref()).map(|band| (band, si(requirements.force.nominal.as_ref()))),
        travel_m: si(requirements.travel.as_ref()),
        stress,
        fatigue: FatigueLimit::asked(&requirements.fatigue),
        hold: HoldLimit::asked(&requirements.hold),
        stiffness_min: si(requirements.stiffness.min.as_ref())?,
        stiffness_max: si(requirements.stiffness.max.as_ref()),
        limits,
    })
}

/// The box; a side that is not given is infinitely far away.
fn envelope_of(requirements: &spec::Requirements, sound: bool, diagnostics: &mut Diagnostics) -> Option<Envelope> {
    let section = requirements.envelope.present.as_ref()?;
    let (x, y) = (&requirements.envelope.x, &requirements.envelope.y);
    if sound && x.is_none() && y.is_none() {
        diagnostics.push(
            Diagnostic::error("E0302", section.span, "`envelope` says nothing")
                .label("from this table")
                .help("give `x = [\"0 mm\", \"40 mm\"]`, or `y`, or both"),
        );
    }
    for side in [x, y].into_iter().flatten().filter(|s| s.value[0].si >= s.value[1].si) {
        diagnostics.push(
            Diagnostic::error("E0204", side.span, format!("from {} to {} there is no room", side.value[0], side.value[1]))
                .label("not in ascending order")
                .help("write the smaller value first"),
        );
    }
    let range = |side: &Slot<[Quantity; 2]>| side.as_ref().map_or([f64::NEG_INFINITY, f64::INFINITY], |s| [s.value[0].si, s.value[1].si]);
    let ([left, right], [bottom, top]) = (range(x), range(y));
    Some(Envelope { low_m: [left, bottom], high_m: [right, top] })
}

/// A force band holds over a stroke, and the stroke lies inside the travel.
fn check_stroke(spec: &Spec, sound: bool, diagnostics: &mut Diagnostics) {
    let requirements = &spec.requirements;
    match (&requirements.force.present, &requirements.travel) {
        (Some(force), None) if sound => diagnostics.push(
            Diagnostic::error("E0302", force.span, "`force` needs `travel`: the stroke over which the band must hold")
                .label("over which stroke?")
                .help("add, for example, `travel = \"6 mm\"` to `[requirements]`"),
        ),
        (None, Some(travel)) => diagnostics.push(
            Diagnostic::error("E0302", travel.span, "`travel` needs a force band")
                .label("a stroke inside which band?")
                .help("add `force = { band = \"5 %\" }`, with `nominal = \"…\"` where the level matters"),
        ),
        _ => {}
    }
    if let (Some(stroke), Some(travel)) = (&requirements.travel, loads::last_travel(spec))
        && stroke.value.si > travel.value.si
    {
        diagnostics.push(
            Diagnostic::error(
                "E0204",
                stroke.span,
                format!("the stroke of {} is longer than the travel of {}", stroke.value, travel.value),
            )
            .label("longer than the travel")
            .related(travel.span, "the travel")
            .help("ask for a shorter stroke, or lengthen the travel of the load"),
        );
    }
}

/// What the builder has made of the drawing.
struct Built {
    network: Network,
    loads: Loads,
    grouping: Grouping,
    drawn: Vec<DrawnNode>,
    bodies: Vec<Body>,
    loaded: Vec<usize>,
}

struct Builder<'a> {
    spec: &'a Spec,
    diagnostics: &'a mut Diagnostics,
    place: Span,
}

/// A beam whose references are known but whose end nodes may not have positions yet.
struct Drawn<'a> {
    member: &'a Member<spec::Beam>,
    start: usize,
    end: usize,
    form: ShapeForm,
}

enum ShapeForm {
    /// Coefficients c1…cm; c0 and the length follow from the nodes.
    Bend(Vec<f64>),
    /// Points of the axis.
    Through(Vec<Located<[f64; 2]>>),
    /// The whole shape; the nodes follow from it.
    Whole(Shape),
}

impl Builder<'_> {
    fn error(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// The index of the drawn node that a name refers to.
    fn node(&mut self, name: &str, span: Span) -> Option<usize> {
        find_node(self.spec, name, span, self.diagnostics)
    }

    /// The network with its loads; `None` after errors.
    fn network(&mut self) -> Option<Built> {
        let spec = self.spec;
        self.check_materials();
        let loaded: Vec<Option<usize>> =
            spec.load.iter().map(|load| load.value.node.as_ref().and_then(|n| self.node(&n.value, n.span))).collect();
        let (grouping, supports) = bodies::resolve(spec, &loaded, self.diagnostics);
        let drawn: Vec<Option<Drawn<'_>>> = spec.design.beams.iter().map(|b| self.drawn(b, &grouping)).collect();
        let moved: Vec<Option<usize>> = loaded.iter().map(|node| node.map(|n| grouping.owner[n])).collect();
        let loads = loads::resolve(spec, &moved, self.place, self.diagnostics);
        let drawn: Vec<Drawn<'_>> = drawn.into_iter().collect::<Option<_>>()?;
        let positions = self.positions(&drawn)?;
        let beams: Vec<Option<Beam>> = drawn.iter().map(|d| self.beam(d, &positions, &grouping)).collect();
        let beams = beams.into_iter().collect::<Option<Vec<_>>>()?;
        let nodes = grouping
            .reference
            .iter()
            .zip(supports)
            .map(|(drawn, support)| Some(Node { position_m: positions[*drawn], support: support? }))
            .collect::<Option<Vec<_>>>()?;
        let loads = loads?;
        let network = Network { before: loads.before.clone(), ..Network::new(nodes, beams, loads.drive) };
        let loaded = loaded.into_iter().collect::<Option<Vec<_>>>()?;
        Some(Built { loaded, drawn: grouping.drawn(spec, &positions), bodies: grouping.bodies(spec), network, loads, grouping })
    }

    fn drawn<'b>(&mut self, member: &'b Member<spec::Beam>, grouping: &Grouping) -> Option<Drawn<'b>> {
        let beam = &member.value;
        let form = self.form(member);
        let ends = beam.between.as_ref()?;
        let [start, end] = &ends.value[..] else { return None };
        let (from, to) = (self.node(&start.value, start.span), self.node(&end.value, end.span));
        let (start, end) = (from?, to?);
        if start == end {
            self.error(
                Diagnostic::error("E0502", ends.span, format!("beam `{}` starts and ends at the same node", member.name.value))
                    .label("the same twice")
                    .help("name two different nodes"),
            );
            return None;
        }
        if let Some(body) = grouping.body_of_both(start, end).and_then(|b| self.spec.design.bodies.get(b)) {
            let message = format!("beam `{}` joins body `{}` with itself", member.name.value, body.name.value);
            self.error(
                Diagnostic::error("E0502", ends.span, message)
                    .label("cannot bend")
                    .related(body.name.span, "joins both nodes")
                    .help("remove the beam, or take one of its nodes out of the body"),
            );
            return None;
        }
        for hinge in beam.hinged.iter().flat_map(|h| &h.value) {
            let node = self.node(&hinge.value, hinge.span)?;
            if node != start && node != end {
                self.error(
                    Diagnostic::error("E0304", hinge.span, format!("beam `{}` does not end at `{}`", member.name.value, hinge.value))
                        .help("name one of its two nodes"),
                );
            }
        }
        Some(Drawn { member, start, end, form: form? })
    }

    fn form(&mut self, member: &Member<spec::Beam>) -> Option<ShapeForm> {
        let beam = &member.value;
        let given: Vec<(Span, &str)> = [
            beam.bend.as_ref().map(|l| (l.span, "bend")),
            beam.straight.as_ref().filter(|s| s.value).map(|l| (l.span, "straight")),
            beam.arc.as_ref().map(|l| (l.span, "arc")),
            beam.through.as_ref().map(|l| (l.span, "through")),
            beam.angle.as_ref().map(|l| (l.span, "angle")),
        ]
        .into_iter()
        .flatten()
        .collect();
        let name = &member.name;
        match given[..] {
            // A shape that was given but not understood has been reported.
            [] if self.diagnostics.in_file_order().iter().any(|d| d.code.starts_with("E02") || d.code == "E0311") => None,
            [] => {
                self.error(
                    Diagnostic::error("E0302", name.span, format!("beam `{}` has no shape", name.value))
                        .label("this beam")
                        .help("give `bend = [c1, …]`, `straight = true`, `arc = \"30 deg\"`, `through = [[x, y], …]`, or `angle = [c0, …]` with `length`"),
                );
                None
            }
            [_] => {
                if let (Some(length), None) = (&beam.length, &beam.angle) {
                    self.error(
                        Diagnostic::error("E0305", length.span, "`length` is given, but follows from the nodes and the shape")
                            .label("follows by itself")
                            .help("remove it, or give the whole shape by `angle` with `length`"),
                    );
                }
                if let Some(bend) = &beam.bend {
                    return Some(ShapeForm::Bend(bend.value.clone()));
                }
                if let Some(arc) = &beam.arc {
                    return Some(ShapeForm::Bend(vec![arc.value.si]));
                }
                if let Some(points) = &beam.through {
                    let si = |p: &Located<[Quantity; 2]>| Located::new([p.value[0].si, p.value[1].si], p.span);
                    return Some(ShapeForm::Through(points.value.iter().map(si).collect()));
                }
                let Some(angle) = &beam.angle else { return Some(ShapeForm::Bend(Vec::new())) };
                let Some(length) = &beam.length else {
                    self.error(
                        Diagnostic::error("E0302", angle.span, "`angle` needs `length`")
                            .label("angle without length")
                            .help("add the arc length, such as `length = \"34 mm\"`"),
                    );
                    return None;
                };
                Shape::new(angle.value.clone(), length.value.si)
                    .map_err(|e| {
                        self.error(
                            Diagnostic::error("E0503", angle.span, e.to_string()).label("impossible shape").help("change the coefficients"),
                        );
                    })
                    .ok()
                    .map(ShapeForm::Whole)
            }
            [(first, one), (second, other), ..] => {
                self.error(
                    Diagnostic::error("E0305", second, format!("`{one}` and `{other}` exclude each other"))
                        .label("the second shape")
                        .related(first, "the first")
                        .help("keep one"),
                );
                None
            }
        }
    }

    /// Every material that a beam is of is complete.
    fn check_materials(&mut self) {
        let spec = self.spec;
        let shear = theory_of(spec) == Theory::Reissner;
        let of_beams = || spec.design.beams.iter().map(|b| b.value.material.as_ref());
        if let Some(table) = &spec.material.present
            && (of_beams().any(|b| b.is_none()) || spec.design.beams.is_empty())
        {
            check_complete(&spec.material.common, table.span, shear, self.diagnostics);
        }
        for member in &spec.material.named {
            if of_beams().flatten().any(|b| b.value == member.name.value) {
                check_complete(&member.value, member.name.span, shear, self.diagnostics);
            }
        }
    }

    /// Positions of all nodes: as typed, or following from beams given as a whole.
    fn positions(&mut self, drawn: &[Drawn<'_>]) -> Option<Vec<[f64; 2]>> {
        let nodes = &self.spec.design.nodes;
        let mut at: Vec<Option<[f64; 2]>> = nodes.iter().map(|n| n.value.at.as_ref().map(|at| [at.value[0].si, at.value[1].si])).collect();
        // Each round places at least one node, or nothing more follows.
        for _ in 0..nodes.len() {
            for beam in drawn {
                let ShapeForm::Whole(shape) = &beam.form else { continue };
                let [x, y] = shape.chord_m();
                match (at[beam.start], at[beam.end]) {
                    (Some(from), None) => at[beam.end] = Some([from[0] + x, from[1] + y]),
                    (None, Some(to)) => at[beam.start] = Some([to[0] - x, to[1] - y]),
                    _ => {}
                }
            }
        }
        for (node, _) in nodes.iter().zip(&at).filter(|(_, at)| at.is_none()) {
            // A point that could not be read has been reported already.
            if !self.diagnostics.has_errors() {
                self.error(
                    Diagnostic::error("E0501", node.name.span, format!("the position of node `{}` is unknown", node.name.value))
                        .label("where?")
                        .help("give `at = [\"x\", \"y\"]`, or join it by a beam with `angle` and `length` to a node that has one"),
                );
            }
        }
        at.into_iter().collect()
    }

    fn beam(&mut self, drawn: &Drawn<'_>, at: &[[f64; 2]], grouping: &Grouping) -> Option<Beam> {
        let (member, beam) = (drawn.member, &drawn.member.value);
        let name = &member.name.value;
        let (from, to) = (at[drawn.start], at[drawn.end]);
        let chord = [to[0] - from[0], to[1] - from[1]];
        let shape = match &drawn.form {
            ShapeForm::Whole(shape) => shape.clone(),
            ShapeForm::Through(points) => self.through(name, from, chord, points)?,
            ShapeForm::Bend(bend) => match Shape::from_chord(chord, bend) {
                Ok(shape) => shape,
                Err(error) => {
                    let span = beam.bend.as_ref().map_or(member.name.span, |b| b.span);
                    self.error(
                        Diagnostic::error("E0503", span, format!("beam `{name}`: {error}"))
                            .label("this shape")
                            .help("move its nodes apart, or change its bend"),
                    );
                    return None;
                }
            },
        };
        let own = beam.thickness.as_ref().map(|t| &t.value);
        let thickness_m = own.and_then(Along::first).map(|q| q.si).or(si(self.spec.design.thickness.as_ref()));
        let profile = match own {
            Some(Along::Places(places)) => places.iter().map(|(u, thickness)| [*u, thickness.si]).collect(),
            _ => Vec::new(),
        };
        if thickness_m.is_none() && !self.diagnostics.has_errors() {
            self.error(
                Diagnostic::error("E0302", member.name.span, format!("beam `{name}` has no thickness"))
                    .label("this beam")
                    .help("give `design.thickness = \"1 mm\"` for all beams, or `thickness` for this one"),
            );
        }
        let hinged = |node: usize| {
            beam.hinged.iter().flat_map(|h| &h.value).any(|h| self.spec.design.nodes.get(node).is_some_and(|n| n.name.value == h.value))
        };
        let joint = |node: usize| if hinged(node) { Joint::Hinged } else { Joint::Rigid };
        let (start_joint, end_joint) = (joint(drawn.start), joint(drawn.end));
        let material = typed_material(self.spec, beam)?;
        let section = Section {
            young_pa: si(material.young_modulus.as_ref())?,
            thickness_m: thickness_m?,
            depth_m: si(self.spec.design.depth.as_ref())?,
            poisson: si(material.poisson_ratio.as_ref()),
        };
        let [start, end] = [drawn.start, drawn.end].map(|d| grouping.owner[d]);
        let arms_m = [(drawn.start, from), (drawn.end, to)].map(|(d, end)| {
            let node = at[grouping.reference[grouping.owner[d]]];
            [end[0] - node[0], end[1] - node[1]]
        });
        Some(Beam { start_joint, end_joint, profile, arms_m, ..Beam::new(start, end, shape, section) })
    }

    /// The shape through points; a fault is reported at the point.
    fn through(&mut self, name: &str, from: [f64; 2], chord: [f64; 2], points: &[Located<[f64; 2]>]) -> Option<Shape> {
        let relative: Vec<[f64; 2]> = points.iter().map(|p| [p.value[0] - from[0], p.value[1] - from[1]]).collect();
        let error = match Shape::through(chord, &relative) {
            Ok(shape) => return Some(shape),
            Err(error) => error,
        };
        let beams = &self.spec.design.beams;
        let all = beams.iter().find(|b| b.name.value == name).and_then(|b| b.value.through.as_ref()).map_or(self.place, |t| t.span);
        let at = |point: usize| points.get(point).map_or(all, |p| p.span);
        let (span, help) = match error {
            ThroughError::OnTheOneBefore { point } if point == points.len() => {
                (all, "leave out the last point: the node follows by itself")
            }
            ThroughError::OnTheOneBefore { point: 0 } => (at(0), "leave it out: the beam starts at its node by itself"),
            ThroughError::OnTheOneBefore { point } => (at(point), "leave out one of the two"),
            ThroughError::TurnsBack { point } => (at(point), "list the points in their order along the beam"),
            ThroughError::Loops { point } => (at(point), "add a point on the piece before it, or move it"),
            _ => (all, "take fewer points, or move them onto a smoother curve"),
        };
        self.error(Diagnostic::error("E0503", span, format!("beam `{name}`: {error}")).label("this shape").help(help));
        None
    }

    /// `x = 0` or `y = 2 mm`; the load must move along the line.
    fn mirror(&mut self, built: &Built) -> Option<Mirror> {
        let text = self.spec.layout.mirror.as_ref()?;
        let Some(mirror) = parse_mirror(&text.value) else {
            self.error(
                Diagnostic::error("E0507", text.span, "this is not a mirror line")
                    .label("expected a line")
                    .help("write `mirror = \"x = 0\"` or `mirror = \"y = 2 mm\"`"),
            );
            return None;
        };
        // A body lies on the line with any of its nodes.
        let on_line = |node: usize| built.drawn.iter().any(|d| d.node == node && mirror.holds(&built.network, d.position_m));
        loads::check_mirror(self.spec, &built.loads, (mirror, text.span), on_line, self.diagnostics);
        Some(mirror)
    }
}

/// Unit vector; the reader has made sure that it has a length.
pub(crate) fn unit([x, y]: [f64; 2]) -> [f64; 2] {
    let length = forcewright_base::maths::hypot(x, y);
    [x / length, y / length]
}
