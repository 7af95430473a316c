//! From the path of a number to what it changes in the network, and to what the engine differentiates by.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::units::Quantity;
use forcewright_beam::{Beam, Network, Parameter, Shape, Variant};
use forcewright_contract::describe::Located;
use forcewright_contract::studies::{Free, Purpose};
use forcewright_study::evaluator::Variable;

use crate::design::Design;
use crate::spec::{self, Spec};

/// What a number changes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Knob {
    NodeX(usize),
    NodeY(usize),
    /// A node on a straight line, from the one end to the other as the number goes from 0 to 1.
    NodeOn {
        node: usize,
        from: [f64; 2],
        to: [f64; 2],
    },
    Bend {
        beam: usize,
        k: usize,
    },
    /// Thickness of some beams.
    Thickness(Vec<usize>),
    ThicknessAt {
        beam: usize,
        place: usize,
    },
    Depth,
    Young(Vec<usize>),
    Poisson(Vec<usize>),
}

/// The numbers of a study, understood.
#[derive(Clone, Debug)]
pub(crate) struct Knobs {
    pub(crate) each: Vec<Knob>,
    pub(crate) variables: Vec<Variable>,
    /// What the engine differentiates by.
    pub(crate) parameters: Vec<Parameter>,
    /// Per knob: the parameters that change with it, and by how much.
    columns: Vec<Vec<(usize, f64)>>,
    /// Beams whose shape follows from nodes and bends that change.
    reshaped: Vec<usize>,
}

impl Knobs {
    /// Understands the numbers; what this family cannot change is reported. A node that stays on a line has one number for both
    /// coordinates in a search.
    pub(crate) fn new(spec: &Spec, design: &Design, free: &[Free], purpose: Purpose, diagnostics: &mut Diagnostics) -> Option<Self> {
        let on_lines = purpose == Purpose::Search;
        let (mut knobs, mut variables) = (Vec::new(), Vec::new());
        let before = diagnostics.errors();
        let all = free;
        for free in all {
            match knob(spec, design, &free.number.path).and_then(|knob| allowed(spec, design, knob)) {
                Ok(Knob::NodeX(node) | Knob::NodeY(node)) if on_lines && line_of(spec, design, node).is_some() => {
                    // One number for both coordinates, where the first of them is met.
                    let known = |k: &Knob| matches!(k, Knob::NodeOn { node: other, .. } if *other == node);
                    if !knobs.iter().any(known)
                        && let Some((knob, variable)) = on_line(spec, design, (node, all), diagnostics)
                    {
                        knobs.push(knob);
                        variables.push(variable);
                    }
                }
                Ok(knob) => {
                    knobs.push(knob);
                    variables.push(variable(free));
                }
                Err(why) => diagnostics.push(
                    Diagnostic::error("E0313", free.number.span, format!("a study cannot change `{}`", free.number.path))
                        .label(why)
                        .help("take it out of the study's numbers, or describe the design so that it can move"),
                ),
            }
        }
        if diagnostics.errors() > before {
            return None;
        }
        let (mut parameters, mut columns) = (Vec::new(), Vec::new());
        for knob in &knobs {
            let own = knob.parameters(design.network.beams.len());
            columns.push(own.iter().enumerate().map(|(i, (_, factor))| (parameters.len() + i, *factor)).collect());
            parameters.extend(own.into_iter().map(|(parameter, _)| parameter));
        }
        let reshapes = |beam: usize| {
            let own = &design.network.beams[beam];
            knobs.iter().any(|knob| match knob {
                Knob::NodeX(node) | Knob::NodeY(node) | Knob::NodeOn { node, .. } => *node == own.start || *node == own.end,
                Knob::Bend { beam: other, .. } => *other == beam,
                _ => false,
            })
        };
        let reshaped = (0..design.network.beams.len()).filter(|beam| reshapes(*beam)).collect();
        Some(Self { each: knobs, variables, parameters, columns, reshaped })
    }

    /// Changes a copy of the design's network. `None` if a beam no longer spans its nodes.
    pub(crate) fn apply(&self, base: &Network, x: &[f64], network: &mut Network) -> Option<()> {
        let mut bends: Vec<(usize, Vec<f64>)> =
            self.reshaped.iter().map(|beam| (*beam, base.beams[*beam].shape.angle_rad().get(1..).unwrap_or(&[]).to_vec())).collect();
        for (knob, x) in self.each.iter().zip(x) {
            match knob {
                Knob::NodeX(node) => network.nodes[*node].position_m[0] = *x,
                Knob::NodeY(node) => network.nodes[*node].position_m[1] = *x,
                Knob::NodeOn { node, from, to } => network.nodes[*node].position_m = between(*from, *to, *x),
                Knob::Bend { beam, k } => {
                    let own = bends.iter_mut().find(|(other, _)| other == beam);
                    *own.and_then(|(_, bend)| bend.get_mut(k - 1))? = *x;
                }
                Knob::Thickness(beams) => beams.iter().for_each(|beam| network.beams[*beam].section.thickness_m = *x),
                Knob::ThicknessAt { beam, place } => network.beams[*beam].profile.get_mut(*place)?[1] = *x,
                Knob::Depth => network.beams.iter_mut().for_each(|beam| beam.section.depth_m = *x),
                Knob::Young(beams) => beams.iter().for_each(|beam| network.beams[*beam].section.young_pa = *x),
                Knob::Poisson(beams) => beams.iter().for_each(|beam| network.beams[*beam].section.poisson = Some(*x)),
            }
        }
        for (beam, bend) in bends {
            let (start, end) = (network.beams[beam].start, network.beams[beam].end);
            let (from, to) = (network.nodes[start].position_m, network.nodes[end].position_m);
            network.beams[beam].shape = Shape::from_chord([to[0] - from[0], to[1] - from[1]], &bend).ok()?;
        }
        Some(())
    }

    /// Changes the numbers of a variant of the design's network, whose thickness is the same along each beam. What it has no place for
    /// is left out.
    pub(crate) fn vary(&self, x: &[f64], variant: &mut Variant) {
        let Variant { position_m, bend_rad, section } = variant;
        for (knob, x) in self.each.iter().zip(x) {
            match knob {
                Knob::NodeX(node) => position_m[*node][0] = *x,
                Knob::NodeY(node) => position_m[*node][1] = *x,
                Knob::NodeOn { node, from, to } => position_m[*node] = between(*from, *to, *x),
                Knob::Bend { beam, k } => {
                    if let Some(bend) = bend_rad[*beam].get_mut(k - 1) {
                        *bend = *x;
                    }
                }
                Knob::Thickness(beams) => beams.iter().for_each(|beam| section[*beam].thickness_m = *x),
                Knob::ThicknessAt { .. } => {}
                Knob::Depth => section.iter_mut().for_each(|section| section.depth_m = *x),
                Knob::Young(beams) => beams.iter().for_each(|beam| section[*beam].young_pa = *x),
                Knob::Poisson(beams) => beams.iter().for_each(|beam| section[*beam].poisson = Some(*x)),
            }
        }
    }

    /// The numbers of the project file, each with its path.
    pub(crate) fn numbers(&self, x: &[f64]) -> Vec<(String, f64)> {
        let mut all = Vec::new();
        for ((knob, variable), x) in self.each.iter().zip(&self.variables).zip(x) {
            match knob {
                Knob::NodeOn { from, to, .. } => {
                    let at = between(*from, *to, *x);
                    all.extend([("x", at[0]), ("y", at[1])].map(|(axis, value)| (format!("{}.{axis}", variable.path), value)));
                }
                _ => all.push((variable.path.clone(), *x)),
            }
        }
        all
    }

    /// Adds a factor times derivatives by the engine's parameters to derivatives by the numbers; nothing to a row without columns.
    pub(crate) fn add_row(&self, by_parameters: &[f64], factor: f64, row: &mut [f64]) {
        for (columns, out) in self.columns.iter().zip(row) {
            *out += factor * columns.iter().map(|(c, weight)| weight * by_parameters[*c]).sum::<f64>();
        }
    }

    /// Adds the derivatives of minus half the thickness of a beam at a place.
    pub(super) fn add_half_thickness(&self, beam: usize, own: &Beam, u: f64, row: &mut [f64]) {
        for (knob, out) in self.each.iter().zip(row) {
            *out -= match knob {
                Knob::Thickness(beams) if beams.contains(&beam) => 0.5,
                Knob::ThicknessAt { beam: other, place } if *other == beam => 0.5 * share(&own.profile, *place, u),
                _ => 0.0,
            };
        }
    }
}

/// How much the thickness at `u` follows that at one of the places where it is given: it is linear between them.
fn share(profile: &[[f64; 2]], place: usize, u: f64) -> f64 {
    let Some([here, _]) = profile.get(place) else { return 0.0 };
    let beside = if u < *here { place.checked_sub(1) } else { Some(place + 1) };
    let Some([there, _]) = beside.and_then(|i| profile.get(i)) else { return f64::from(u8::from((u - here).abs() <= 0.0)) };
    (1.0 - (u - here) / (there - here)).max(0.0)
}

/// A place on the way from one point to another.
fn between(from: [f64; 2], to: [f64; 2], part: f64) -> [f64; 2] {
    [0, 1].map(|i| from[i] + part * (to[i] - from[i]))
}

fn variable(free: &Free) -> Variable {
    Variable {
        path: free.number.path.clone(),
        unit: free.number.dimension.si_symbol(),
        nominal: free.number.si,
        lower: free.lower,
        upper: free.upper,
    }
}

/// Points as they are typed.
type Points = Located<Vec<Located<[Quantity; 2]>>>;

/// The line that a node of the network stays on, with its name, if it does.
fn line_of<'a>(spec: &'a Spec, design: &Design, node: usize) -> Option<(&'a str, &'a Points)> {
    let drawn = design.drawn.iter().position(|d| d.node == node)?;
    let member = spec.design.nodes.get(drawn)?;
    Some((&member.name.value, member.value.on.line.as_ref()?))
}

/// The freedom of a node that stays on a line.
fn on_line(spec: &Spec, design: &Design, (node, all): (usize, &[Free]), diagnostics: &mut Diagnostics) -> Option<(Knob, Variable)> {
    let (name, line) = line_of(spec, design, node)?;
    let mut fault = |why: String| {
        diagnostics.push(
            Diagnostic::error("E0314", line.span, why)
                .label("this line")
                .help("give its two ends, `line = [[\"x\", \"y\"], [\"x\", \"y\"]]`, with the node between"),
        );
        None
    };
    let [from, to] = &line.value[..] else { return fault("a line has two ends".to_owned()) };
    let [from, to] = [from, to].map(|p| [p.value[0].si, p.value[1].si]);
    let (along, at) = ([to[0] - from[0], to[1] - from[1]], design.network.nodes[node].position_m);
    let square = along[0] * along[0] + along[1] * along[1];
    let part = ((at[0] - from[0]) * along[0] + (at[1] - from[1]) * along[1]) / square;
    let foot = between(from, to, part);
    let off = forcewright_base::maths::hypot(at[0] - foot[0], at[1] - foot[1]);
    // Written so that a line without length fails too.
    if !(off <= 1e-6 * square.sqrt() && (0.0..=1.0).contains(&part)) {
        return fault(format!("node `{name}` does not lie on its line"));
    }
    let path = format!("design.nodes.{name}.at");
    // The ranges of its coordinates hold too.
    let (mut lower, mut upper) = (0.0_f64, 1.0_f64);
    for (axis, name) in ["x", "y"].iter().enumerate() {
        let free = all.iter().find(|f| f.number.path.strip_prefix(&path).and_then(|rest| rest.strip_prefix('.')) == Some(name));
        if let Some(free) = free.filter(|_| along[axis].abs() > 1e-9 * square.sqrt()) {
            let ends = [free.lower, free.upper].map(|bound| (bound - from[axis]) / along[axis]);
            (lower, upper) = (lower.max(ends[0].min(ends[1])), upper.min(ends[0].max(ends[1])));
        }
    }
    let variable = Variable { path, unit: "1", nominal: part, lower: lower.min(part), upper: upper.max(part) };
    Some((Knob::NodeOn { node, from, to }, variable))
}

impl Knob {
    /// What the engine differentiates by, and by how much it changes.
    fn parameters(&self, beams: usize) -> Vec<(Parameter, f64)> {
        let each = |some: &[usize], all: Parameter, one: fn(usize) -> Parameter| {
            if some.len() == beams { vec![(all, 1.0)] } else { some.iter().map(|b| (one(*b), 1.0)).collect() }
        };
        match self {
            Self::NodeX(node) => vec![(Parameter::NodeX(*node), 1.0)],
            Self::NodeY(node) => vec![(Parameter::NodeY(*node), 1.0)],
            Self::NodeOn { node, from, to } => {
                vec![(Parameter::NodeX(*node), to[0] - from[0]), (Parameter::NodeY(*node), to[1] - from[1])]
            }
            Self::Bend { beam, k } => vec![(Parameter::Bend { beam: *beam, k: *k }, 1.0)],
            Self::Thickness(some) => each(some, Parameter::AllThickness, Parameter::Thickness),
            Self::ThicknessAt { beam, place } => vec![(Parameter::ThicknessAt { beam: *beam, place: *place }, 1.0)],
            Self::Depth => vec![(Parameter::AllDepth, 1.0)],
            Self::Young(some) => each(some, Parameter::AllYoung, Parameter::Young),
            Self::Poisson(some) => each(some, Parameter::AllPoisson, Parameter::Poisson),
        }
    }
}

/// The knob of a path, or why there is none.
fn knob(spec: &Spec, design: &Design, path: &str) -> Result<Knob, &'static str> {
    let parts: Vec<&str> = path.split('.').collect();
    let node = |name: &str| design.drawn.iter().find(|d| d.name == name).map(|d| d.node);
    let beam = |name: &str| design.beam_names.iter().position(|n| n == name);
    let of_material = |name: Option<&str>| {
        let is_of = |b: &spec::Beam| b.material.as_ref().map(|m| m.value.as_str()) == name;
        (0..spec.design.beams.len()).filter(|i| is_of(&spec.design.beams[*i].value)).collect::<Vec<_>>()
    };
    let unknown = "its effect is not known to studies of this family";
    match parts[..] {
        ["design", "thickness"] => {
            let follows = |i: &usize| spec.design.beams[*i].value.thickness.is_none();
            Ok(Knob::Thickness((0..spec.design.beams.len()).filter(follows).collect()))
        }
        ["design", "depth"] => Ok(Knob::Depth),
        ["design", "nodes", name, "at", axis] => {
            let node = node(name).ok_or(unknown)?;
            if design.bodies.iter().any(|b| b.node == node) {
                return Err("it is part of a rigid body, which moves as one");
            }
            Ok(if axis == "x" { Knob::NodeX(node) } else { Knob::NodeY(node) })
        }
        ["design", "beams", name, "bend", k] => {
            Ok(Knob::Bend { beam: beam(name).ok_or(unknown)?, k: k.parse().ok().filter(|k| *k > 0).ok_or(unknown)? })
        }
        ["design", "beams", name, "arc"] => Ok(Knob::Bend { beam: beam(name).ok_or(unknown)?, k: 1 }),
        ["design", "beams", name, "thickness"] => Ok(Knob::Thickness(vec![beam(name).ok_or(unknown)?])),
        ["design", "beams", name, "thickness", place] => {
            let place: usize = place.parse().ok().filter(|p| *p > 0).ok_or(unknown)?;
            Ok(Knob::ThicknessAt { beam: beam(name).ok_or(unknown)?, place: place - 1 })
        }
        ["material", "young_modulus"] => Ok(Knob::Young(of_material(None))),
        ["material", name, "young_modulus"] => Ok(Knob::Young(of_material(Some(name)))),
        ["material", "poisson_ratio"] => Ok(Knob::Poisson(of_material(None))),
        ["material", name, "poisson_ratio"] => Ok(Knob::Poisson(of_material(Some(name)))),
        _ => Err(unknown),
    }
}

/// Beams that are given as a whole, or through points, do not follow a node that moves.
fn allowed(spec: &Spec, design: &Design, knob: Knob) -> Result<Knob, &'static str> {
    let stiff = |beam: usize| {
        let own = &spec.design.beams[beam].value;
        own.angle.is_some() || own.through.is_some()
    };
    let at_node = |node: usize| {
        (0..design.network.beams.len()).any(|b| (design.network.beams[b].start == node || design.network.beams[b].end == node) && stiff(b))
    };
    match &knob {
        Knob::NodeX(node) | Knob::NodeY(node) if at_node(*node) => {
            Err("a beam at this node is given by `angle` or `through`; give it by `bend`")
        }
        Knob::Thickness(beams) if beams.is_empty() => Err("no beam follows it"),
        Knob::Young(beams) | Knob::Poisson(beams) if beams.is_empty() => Err("no beam is made of it"),
        _ => Ok(knob),
    }
}
