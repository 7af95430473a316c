//! From drawn nodes to nodes of the network: those that a rigid body joins are one of them, the others one each.
//!
//! The node of a body lies at one of the drawn nodes, its *reference*. A body that keeps its angle only shifts, so any of its nodes does
//! as well as any other. A body that can turn has one place that is held or loaded, and the reference is that place: a support or a load
//! elsewhere on it would act along another path.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::text::closest;
use forcewright_beam::{Rotation, Support};
use forcewright_contract::describe::{Located, Member};

use crate::design::unit;
use crate::spec::{self, Held, Spec};

/// A node as it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnNode {
    /// Its name.
    pub name: String,
    /// Position at rest, m.
    pub position_m: [f64; 2],
    /// Index of the node of the network that it is, or moves with.
    pub node: usize,
}

/// A rigid body that joins drawn nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Index of its node in the network.
    pub node: usize,
    /// Indices of its drawn nodes, ascending.
    pub members: Vec<usize>,
}

/// Which drawn nodes are one node of the network.
#[derive(Debug)]
pub(crate) struct Grouping {
    /// Per drawn node: its node of the network.
    pub owner: Vec<usize>,
    /// Per node of the network: the drawn node at which it lies.
    pub reference: Vec<usize>,
    /// Per node of the network: the index of its body.
    pub body: Vec<Option<usize>>,
}

impl Grouping {
    /// Every drawn node by itself.
    pub(crate) fn apart(count: usize) -> Self {
        Self { owner: (0..count).collect(), reference: (0..count).collect(), body: vec![None; count] }
    }

    /// Groups by the body of each drawn node; references are the first of each.
    fn of(bodies: &[Option<usize>]) -> Self {
        let mut grouping = Self { owner: Vec::new(), reference: Vec::new(), body: Vec::new() };
        for (drawn, body) in bodies.iter().enumerate() {
            let known = body.and_then(|b| grouping.body.iter().position(|other| *other == Some(b)));
            grouping.owner.push(known.unwrap_or(grouping.reference.len()));
            if known.is_none() {
                grouping.reference.push(drawn);
                grouping.body.push(*body);
            }
        }
        grouping
    }

    /// The drawn nodes of a node of the network, ascending.
    pub(crate) fn members(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        self.owner.iter().enumerate().filter(move |(_, owner)| **owner == node).map(|(drawn, _)| drawn)
    }

    /// The body that two drawn nodes are in, if it is one.
    pub(crate) fn body_of_both(&self, a: usize, b: usize) -> Option<usize> {
        (self.owner[a] == self.owner[b]).then(|| self.body[self.owner[a]]).flatten()
    }

    /// The nodes as drawn, for pictures and words.
    pub(crate) fn drawn(&self, spec: &Spec, positions: &[[f64; 2]]) -> Vec<DrawnNode> {
        let all = spec.design.nodes.iter().zip(positions).zip(&self.owner);
        all.map(|((n, at), node)| DrawnNode { name: n.name.value.clone(), position_m: *at, node: *node }).collect()
    }

    /// The bodies, for pictures and words.
    pub(crate) fn bodies(&self, spec: &Spec) -> Vec<Body> {
        let of = |index: usize| self.body.iter().position(|b| *b == Some(index));
        let all = spec.design.bodies.iter().enumerate();
        all.filter_map(|(index, b)| {
            let node = of(index)?;
            Some(Body { name: b.name.value.clone(), node, members: self.members(node).collect() })
        })
        .collect()
    }
}

/// The index of the drawn node that a name refers to; reports one that there is not.
pub(crate) fn find_node(spec: &Spec, name: &str, span: Span, diagnostics: &mut Diagnostics) -> Option<usize> {
    let nodes = &spec.design.nodes;
    let found = nodes.iter().position(|n| n.name.value == name);
    if found.is_none() {
        let names = || nodes.iter().map(|n| n.name.value.as_str());
        let help = match spec.design.bodies.iter().find(|b| b.name.value == name) {
            Some(body) => {
                let members = body.value.nodes.iter().flat_map(|n| &n.value).map(|n| n.value.as_str());
                format!("`{name}` is a body: name one of its nodes, {}", members.collect::<Vec<_>>().join(", "))
            }
            None => closest(name, names()).map_or_else(
                || format!("the design has {}", names().collect::<Vec<_>>().join(", ")),
                |near| format!("did you mean `{near}`?"),
            ),
        };
        diagnostics
            .push(Diagnostic::error("E0304", span, format!("there is no node `{name}`")).label("not defined in `design.nodes`").help(help));
    }
    found
}

/// Groups the drawn nodes and reads their supports, per node of the network; `loaded` are the drawn nodes of the loads, in order. A
/// support is `None` after an error.
pub(crate) fn resolve(spec: &Spec, loaded: &[Option<usize>], diagnostics: &mut Diagnostics) -> (Grouping, Vec<Option<Support>>) {
    let own: Vec<Option<Support>> = spec.design.nodes.iter().map(|n| support(&n.name, &n.value.held, diagnostics)).collect();
    let Some(bodies) = body_of_nodes(spec, diagnostics) else { return (Grouping::apart(own.len()), own) };
    let mut grouping = Grouping::of(&bodies);
    let mut supports = Vec::with_capacity(grouping.reference.len());
    for node in 0..grouping.reference.len() {
        let Some(member) = grouping.body[node].and_then(|b| spec.design.bodies.get(b)) else {
            supports.push(own[grouping.reference[node]]);
            continue;
        };
        let members: Vec<usize> = grouping.members(node).collect();
        let body = Joined { spec, member, members };
        let (support, held_at) = body.support(&own, diagnostics);
        supports.push(support);
        if let Some(support) = support {
            grouping.reference[node] = body.reference(support, held_at, loaded, diagnostics);
        }
    }
    (grouping, supports)
}

/// The body of every drawn node; `None` after errors.
fn body_of_nodes(spec: &Spec, diagnostics: &mut Diagnostics) -> Option<Vec<Option<usize>>> {
    let mut first: Vec<Option<(usize, Span)>> = vec![None; spec.design.nodes.len()];
    let mut sound = true;
    for (index, body) in spec.design.bodies.iter().enumerate() {
        for name in body.value.nodes.iter().flat_map(|n| &n.value) {
            let Some(node) = find_node(spec, &name.value, name.span, diagnostics) else {
                sound = false;
                continue;
            };
            let Some((other, before)) = first[node] else {
                first[node] = Some((index, name.span));
                continue;
            };
            sound = false;
            let (message, help) = if other == index {
                (format!("body `{}` names node `{}` twice", body.name.value, name.value), "name it once")
            } else {
                let names = [other, index].map(|b| spec.design.bodies.get(b).map_or("?", |b| b.name.value.as_str()));
                let message = format!("node `{}` is in two bodies, `{}` and `{}`", name.value, names[0], names[1]);
                (message, "leave it in one; bodies that share a node are one body")
            };
            let error = Diagnostic::error("E0514", name.span, message).label("once more").related(before, "named here first");
            diagnostics.push(error.help(help));
        }
        // A list that could not be read has been reported.
        sound &= body.value.nodes.is_some();
    }
    sound.then(|| first.into_iter().map(|body| body.map(|(index, _)| index)).collect())
}

/// A body with its drawn nodes.
struct Joined<'a> {
    spec: &'a Spec,
    member: &'a Member<spec::Body>,
    members: Vec<usize>,
}

impl Joined<'_> {
    fn name(&self) -> &str {
        &self.member.name.value
    }

    fn node_name(&self, drawn: usize) -> &str {
        self.spec.design.nodes.get(drawn).map_or("?", |n| n.name.value.as_str())
    }

    /// How the ground holds the body, and at which of its nodes.
    fn support(&self, own: &[Option<Support>], diagnostics: &mut Diagnostics) -> (Option<Support>, Option<usize>) {
        let given = |drawn: &usize| self.spec.design.nodes.get(*drawn).and_then(|n| n.value.held.support.as_ref());
        let whole = support(&self.member.name, &self.member.value.held, diagnostics);
        let held: Vec<(usize, Span)> = self.members.iter().filter_map(|d| Some((*d, given(d)?.span))).collect();
        let common = self.member.value.held.support.as_ref();
        let places: Vec<Span> = common.map(|s| s.span).into_iter().chain(held.iter().map(|(_, span)| *span)).collect();
        if let [first, second, ..] = places[..] {
            diagnostics.push(
                Diagnostic::error("E0515", second, format!("body `{}` is held twice", self.name()))
                    .label("the second support")
                    .related(first, "the first")
                    .help("keep one; `clamped` holds all of it, `slider` and `parallel` let it shift without turning"),
            );
            return (None, None);
        }
        match (held.first(), common, whole) {
            (Some((drawn, _)), ..) => (own[*drawn], Some(*drawn)),
            (None, Some(place), Some(support)) if !support.holds_rotation() => {
                diagnostics.push(
                    Diagnostic::error("E0515", place.span, format!("body `{}` can turn, but about which of its nodes?", self.name()))
                        .label("at which node?")
                        .help(format!("write the support at that node, such as `{}`, instead of here", self.node_name(self.members[0]))),
                );
                (None, None)
            }
            (None, _, whole) => (whole, None),
        }
    }

    /// The drawn node at which the body has its node.
    fn reference(&self, support: Support, held_at: Option<usize>, loaded: &[Option<usize>], diagnostics: &mut Diagnostics) -> usize {
        let first = self.members[0];
        let loads =
            || self.spec.load.iter().zip(loaded).filter_map(|(load, node)| Some((load, node.filter(|n| self.members.contains(n))?)));
        if support.holds_rotation() {
            return loads().next_back().map(|(_, node)| node).or(held_at).unwrap_or(first);
        }
        let place = |l: &Member<spec::Load>| l.value.node.as_ref().map_or(l.name.span, |n| n.span);
        // Moments and rotations are those of the body wherever they are written.
        let pushes = || loads().filter(|(load, _)| load.value.travel.is_some() || load.value.force.is_some());
        let pushed = pushes().next();
        let reference = held_at.or(pushed.map(|(_, node)| node)).unwrap_or(first);
        if let Some((load, other)) = pushes().find(|(_, node)| *node != reference) {
            let name = self.node_name(reference);
            let before = match (held_at, pushed) {
                (Some(_), _) | (None, None) => (self.spec.design.nodes.get(reference).map(|n| n.name.span), "held here"),
                (None, Some((first, _))) => (Some(place(first)), "loaded here"),
            };
            let message =
                format!("body `{}` can turn, and node `{}` of it then moves otherwise than `{name}`", self.name(), self.node_name(other));
            let error = Diagnostic::error("E0515", place(load), message).label("loaded here");
            let error = match before {
                (Some(span), label) => error.related(span, label),
                _ => error,
            };
            diagnostics.push(error.help(format!(
                "load `{name}` instead, or let the body keep its angle: `support = \"slider\"` with a direction, or \"parallel\""
            )));
        }
        reference
    }
}

/// How the ground holds a node or a body by itself; `None` after errors.
fn support(name: &Located<String>, held: &Held, diagnostics: &mut Diagnostics) -> Option<Support> {
    let stray = |what: &str, span: Span| {
        Diagnostic::error("E0504", span, format!("`{what}` is for sliders")).help("add `support = \"slider\"`, or remove it")
    };
    let kind = held.support.as_ref().map(|s| s.value);
    if kind != Some("slider") {
        if let Some(direction) = &held.direction {
            diagnostics.push(stray("direction", direction.span));
        }
        if let Some(rotation) = &held.rotation {
            diagnostics.push(stray("rotation", rotation.span));
        }
    }
    match kind {
        Some("clamped") => Some(Support::Clamped),
        Some("pinned") => Some(Support::Pinned),
        Some("parallel") => Some(Support::Parallel),
        Some(_) => {
            let Some(direction) = &held.direction else {
                let span = held.support.as_ref().map_or(name.span, |s| s.span);
                diagnostics.push(
                    Diagnostic::error("E0504", span, "a slider needs a `direction`")
                        .label("in which direction?")
                        .help("add, for example, `direction = [0, 1]`"),
                );
                return None;
            };
            let rotation = if held.rotation.as_ref().is_some_and(|r| r.value == "free") { Rotation::Free } else { Rotation::Fixed };
            Some(Support::Slider { direction: unit(direction.value), rotation })
        }
        None => Some(Support::Free),
    }
}
