//! Rules that a drawn network keeps, each fault reported at the place of its cause.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_beam::{Joints, Network, NetworkError, Rotation, Support};

use crate::bodies::{DrawnNode, Grouping};
use crate::layout::Mirror;
use crate::spec::Spec;

/// What the engine finds wrong with the network, at the place of its cause.
pub(crate) fn check_network(network: &Network, grouping: &Grouping, spec: &Spec, place: Span, diagnostics: &mut Diagnostics) {
    // All loose nodes at once: the engine would name them one by one.
    let mut loose = false;
    for node in 0..network.nodes.len() {
        if !network.beams.iter().any(|b| b.start == node || b.end == node) {
            loose = true;
            // A body needs beams, not each of its nodes: one that none ends at may be loaded.
            let body = grouping.body[node].and_then(|b| spec.design.bodies.get(b)).map(|b| &b.name);
            let drawn = || spec.design.nodes.get(grouping.reference[node]).map(|n| &n.name);
            let (what, name) = body.map_or_else(|| ("node", drawn()), |b| ("body", Some(b)));
            let (name, span) = name.map_or(("?", place), |n| (n.value.as_str(), n.span));
            diagnostics.push(Diagnostic::error("E0510", span, format!("no beam ends at {what} `{name}`")).help("remove it, or join it"));
        }
    }
    if loose {
        return;
    }
    let Err(error) = network.check() else { return };
    let beam_span = |beam: usize| spec.design.beams.get(beam).map_or(place, |b| b.name.span);
    let drawn = |node: usize| grouping.reference.get(node).and_then(|d| spec.design.nodes.get(*d));
    let node_span = |node: usize| drawn(node).map_or(place, |n| n.name.span);
    let node_name = |node: usize| drawn(node).map_or("?", |n| n.name.value.as_str());
    let beam_name = |beam: usize| spec.design.beams.get(beam).map_or("?", |b| b.name.value.as_str());
    let diagnostic = match error {
        NetworkError::DoesNotClose { beam, gap_m } => Diagnostic::error(
            "E0502",
            beam_span(beam),
            format!("the shape of beam `{}` misses its node by {:.3e} m", beam_name(beam), gap_m),
        )
        .help("leave out `at` of one of its nodes, so that it follows from the shape, or give `bend` instead of `angle` and `length`"),
        NetworkError::Mechanism { node } => {
            Diagnostic::error("E0505", node_span(node), format!("the part of the network with node `{}` can move freely", node_name(node)))
                .label("this part")
                .help("clamp or pin a node of it, or join it to the rest")
        }
        NetworkError::DriveBlocked { node } => {
            let (span, turns) = blocked_load(network, spec).unwrap_or((place, false));
            let how = if turns { "cannot turn" } else { "cannot move in the direction of the load" };
            Diagnostic::error("E0506", span, format!("node `{}` {how}", node_name(node)))
                .label("held by its support or an earlier load")
                .help("choose a direction that its support allows, or another node")
        }
        NetworkError::DrivenTwice { node, stage } => moved_twice(network, spec, (node, node_name(node)), stage, place),
        NetworkError::TooManyStages { count } => too_many_loads(spec, count, place),
        NetworkError::TooLarge { count } => {
            let list = if spec.design.beams.len() > Network::LARGEST {
                spec.design.beams.last().map(|b| b.name.span)
            } else {
                spec.design.nodes.last().map(|n| n.name.span)
            };
            Diagnostic::error("E0311", list.unwrap_or(place), format!("{count} nodes or beams, at most {} are accepted", Network::LARGEST))
                .label("too many")
                .help("use `layout.mirror` for a symmetric mechanism, or split it")
        }
        NetworkError::TooManyPieces { count } => {
            let varies = spec.design.beams.iter().rev().find(|b| b.value.thickness.is_some());
            let span = varies.map_or(place, |b| b.name.span);
            let message = format!("thicknesses that vary cut the beams into {count} pieces, at most {} are accepted", Network::MOST_PIECES);
            Diagnostic::error("E0311", span, message).label("too many places").help("give the thickness at fewer places")
        }
        NetworkError::Section { beam, what, value } => Diagnostic::error(
            "E0509",
            beam_span(beam),
            format!("{what} of beam `{}` is {value:.3e} in SI units, out of range", beam_name(beam)),
        )
        .label("this beam")
        .help("check thickness, depth and material; the parameter table gives the ranges"),
        other => {
            let span = other_place(&other, &beam_span, &node_span).unwrap_or(place);
            Diagnostic::error("E0509", span, other.to_string()).help("see the parameter table for the accepted range")
        }
    };
    diagnostics.push(diagnostic);
}

/// Two loads that move one node the same way.
fn moved_twice(network: &Network, spec: &Spec, (node, name): (usize, &str), stage: usize, place: Span) -> Diagnostic {
    let of = |index: usize| spec.load.get(index).map_or(place, |l| l.value.node.as_ref().map_or(l.name.span, |n| n.span));
    let first = network.before.iter().position(|s| s.drive.is_kinematic() && s.drive.node() == node).unwrap_or(0);
    Diagnostic::error("E0513", of(stage), format!("a load before has moved node `{name}` this way already, and holds it"))
        .label("moved twice")
        .related(of(first), "moved and held here")
        .help("let one of the two be a force or a moment, or move the node at right angles; to start further on, lengthen one travel")
}

fn too_many_loads(spec: &Spec, count: usize, place: Span) -> Diagnostic {
    let span = spec.load.get(Network::MOST_STAGES).map_or(place, |l| l.name.span);
    let message = format!("{count} loads before the last one, at most {} are accepted", Network::MOST_STAGES);
    Diagnostic::error("E0311", span, message).label("too many").help("join some of them")
}

/// The place of the first load that its node does not allow, and whether it is one that turns.
fn blocked_load(network: &Network, spec: &Spec) -> Option<(Span, bool)> {
    let drives = network.before.iter().map(|s| s.drive).chain([network.drive]);
    let blocked = |drive| {
        let alone = Network { before: Vec::new(), drive, ..network.clone() };
        matches!(alone.check(), Err(NetworkError::DriveBlocked { .. }))
    };
    // Else an earlier load holds what a later one would move.
    let (_, load) = drives
        .zip(&spec.load)
        .find(|(drive, _)| blocked(*drive))
        .or_else(|| Some((network.drive, spec.load.iter().rev().find(|l| l.value.force.is_some() || l.value.moment.is_some())?)))?;
    let turns = load.value.moment.is_some() || load.value.rotation.is_some();
    Some((load.value.node.as_ref().map_or(load.name.span, |n| n.span), turns))
}

/// Joints leave every beam something to bend.
pub(crate) fn check_joints(network: &Network, joints: Joints, spec: &Spec, place: Span, diagnostics: &mut Diagnostics) {
    let Err(NetworkError::AllRigid { beam, rigid_m }) = network.check_joints(joints) else { return };
    let (span, name) = spec.design.beams.get(beam).map_or((place, "?"), |b| (b.name.span, b.name.value.as_str()));
    let length_m = network.beams.get(beam).map_or(f64::NAN, |b| b.shape.length_m());
    let left_m = length_m - rigid_m;
    let left = if left_m > 0.0 {
        format!("only {:.3} mm is left to bend, less than a twentieth", 1e3 * left_m)
    } else {
        "nothing is left to bend".to_owned()
    };
    diagnostics.push(
        Diagnostic::error(
            "E0512",
            span,
            format!("beam `{name}` lies inside its joints over {:.3} mm of its {:.3} mm: {left}", 1e3 * rigid_m, 1e3 * length_m),
        )
        .label("this beam")
        .help("lengthen or thin it, spread the beams that meet there, or let beams meet in points: `model.joints = \"point\"`"),
    );
}

/// On the mirror line, symmetry holds a node's rotation and its motion across; the network must say so, or one half alone would move
/// otherwise than the two together. A beam on the line would be counted twice.
pub(crate) fn check_mirror(network: &Network, nodes: &[DrawnNode], mirror: Mirror, spec: &Spec, diagnostics: &mut Diagnostics) {
    let off = |point: [f64; 2]| !mirror.holds(network, point);
    let mut reported = Vec::new();
    for (node, drawn) in nodes.iter().zip(&spec.design.nodes) {
        let guided = match network.nodes[node.node].support {
            Support::Clamped => true,
            Support::Slider { direction, rotation: Rotation::Fixed } => match mirror {
                Mirror::X(_) => direction[0].abs() < 1e-9,
                Mirror::Y(_) => direction[1].abs() < 1e-9,
            },
            _ => false,
        };
        // Of a body, one of its nodes on the line says it for all.
        if !off(node.position_m) && !guided && !reported.contains(&node.node) {
            reported.push(node.node);
            let along = if matches!(mirror, Mirror::X(_)) { "[0, 1]" } else { "[1, 0]" };
            diagnostics.push(
                Diagnostic::error(
                    "E0511",
                    drawn.name.span,
                    format!("node `{}` lies on the mirror line, but could leave it or turn", drawn.name.value),
                )
                .label("on the mirror line")
                .help(format!("write what symmetry does: `support = \"slider\", direction = {along}`, or clamp it")),
            );
        }
    }
    for (beam, drawn) in network.beams.iter().zip(&spec.design.beams) {
        let start = [0, 1].map(|i| network.nodes[beam.start].position_m[i] + beam.arms_m[0][i]);
        let on_line = (0..=4).all(|i| {
            let [x, y] = beam.shape.point_m(f64::from(i) / 4.0);
            !off([start[0] + x, start[1] + y])
        });
        if on_line {
            diagnostics.push(
                Diagnostic::error(
                    "E0511",
                    drawn.name.span,
                    format!("beam `{}` lies on the mirror line and would be counted twice", drawn.name.value),
                )
                .label("on the mirror line")
                .help("draw the whole mechanism without `layout.mirror`"),
            );
        }
    }
}

/// Something besides the moved node must hold the mechanism, or it follows the load as a whole.
pub(crate) fn check_held(network: &Network, spec: &Spec, diagnostics: &mut Diagnostics) {
    let driven = network.drive.node();
    let held = network.nodes.iter().enumerate().any(|(i, n)| i != driven && n.support != Support::Free);
    if !held && let Some(node) = spec.load.last().and_then(|l| l.value.node.as_ref()) {
        diagnostics.push(
            Diagnostic::error("E0505", node.span, "nothing but the moved node holds the mechanism")
                .label("it would follow this node as a whole")
                .help("clamp or pin another node: `support = \"clamped\"`"),
        );
    }
}

fn other_place(error: &NetworkError, beam_span: &dyn Fn(usize) -> Span, node_span: &dyn Fn(usize) -> Span) -> Option<Span> {
    match *error {
        NetworkError::Shape { beam, .. } | NetworkError::BeamOnOneNode { beam } => Some(beam_span(beam)),
        NetworkError::Position { node } | NetworkError::Direction { node } => Some(node_span(node)),
        _ => None,
    }
}
