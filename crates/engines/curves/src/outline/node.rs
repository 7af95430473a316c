//! The corner between two neighbouring strips at a node.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use forcewright_base::{maths, roots};

use super::contact::{Arm, touch};
use super::walk::Walk;
use super::{Cap, Joint, Node, Tag};
use crate::fit::Oriented;
use crate::piece::Piece;
use crate::vector::{Vector, along, angle, distance, left, right, scale, sub, unit};

/// Strips in line to within this angle, rad, need no fillet.
const NEARLY_STRAIGHT_RAD: f64 = 1e-6;
/// How far the sides of strips of unequal widths may go on straight beyond their ends, in half widths of the thick one.
const BEYOND_HALF_WIDTHS: f64 = 3.0;

/// How a boundary goes from one strip to the next.
#[derive(Clone, Debug)]
pub(super) struct Turn {
    /// Where it leaves the side of the strip that comes in, and where it enters that of the one that goes out.
    pub(super) at: [f64; 2],
    /// What is between.
    pub(super) path: Vec<(Piece, Tag)>,
}

/// The corner at a node between the walk that comes in and the next one counterclockwise. `None` if the fillet does not fit. Sides that
/// end within `join_m` of each other are joined directly.
pub(super) fn turn(index: usize, node: &Node, [a, b]: [&Walk; 2], radius_m: f64, [exact_m, join_m]: [f64; 2]) -> Option<Turn> {
    let (from, to) = (a.side(1.0).point_m, b.side(0.0).point_m);
    let round = Tag::Round { node: index };
    if a.index == b.index && a.reversed != b.reversed {
        let (piece, tag) = match node.cap {
            Cap::Round => (Piece::arc(from, to, node.point_m, true), Tag::Cap { node: index }),
            Cap::Square => (Piece::Line { from, to }, Tag::Cap { node: index }),
        };
        return Some(Turn { at: [1.0, 0.0], path: vec![(piece, tag)] });
    }
    if distance(from, to) <= join_m {
        return Some(Turn { at: [1.0, 0.0], path: Vec::new() });
    }
    let open_rad = opening(a, b);
    let joint = Joint::Node(index);
    let (half_a, half_b) = (a.half_m(1.0), b.half_m(0.0));
    let equal = (half_a - half_b).abs() <= exact_m;
    if equal && open_rad < PI && PI - open_rad < NEARLY_STRAIGHT_RAD {
        // Where straight sides cross; any fillet there would be shorter than this angle times its radius.
        let cut_m = half_a * maths::tan(0.5 * (PI - open_rad));
        return Some(Turn { at: [1.0 - cut_m / a.strip.length_m, cut_m / b.strip.length_m], path: Vec::new() });
    }
    if open_rad < PI
        && let Some(turn) = fillet([a, b], 0.0, radius_m, joint, exact_m)
    {
        return Some(turn);
    }
    if !equal {
        // Turned so far that the end of the thick strip lies behind the side of the thin one.
        let covered = open_rad > PI && half_a.max(half_b) * maths::cos(open_rad - PI) < half_a.min(half_b);
        let rounded = if covered { rounding(index, [a, b], exact_m) } else { None };
        return rounded.or_else(|| (open_rad > FRAC_PI_2).then(|| step(index, node, [a, b], covered, radius_m, exact_m)).flatten());
    }
    (open_rad >= PI).then(|| Turn { at: [1.0, 0.0], path: vec![(Piece::arc(from, to, node.point_m, true), round)] })
}

/// The angle of the empty sector from one strip counterclockwise to the next, rad, in (0, 2π].
fn opening(a: &Walk, b: &Walk) -> f64 {
    let turn = angle(scale(a.axis(1.0).tangent, -1.0), b.axis(0.0).tangent);
    if turn > 0.0 { turn } else { turn + TAU }
}

/// The arc that touches the sides of two strips; the sides may be longer than the strips by `beyond_m` at the joint.
pub(super) fn fillet([a, b]: [&Walk; 2], beyond_m: f64, radius_m: f64, joint: Joint, exact_m: f64) -> Option<Turn> {
    let rims: [&dyn Fn(f64) -> Oriented; 2] = [&|x| a.side(1.0 - x), &|x| b.side(x)];
    let lengths = [a.strip.length_m, b.strip.length_m];
    let [arm_a, arm_b] =
        [0, 1].map(|k: usize| Arm { rim: rims[k], range: [-beyond_m.max(exact_m) / lengths[k], 1.0], speed_m: lengths[k] });
    let contact = touch([&arm_a, &arm_b], radius_m, exact_m)?;
    let at = [1.0 - contact.at[0], contact.at[1]];
    let (from, to) = (a.side(at[0]).point_m, b.side(at[1]).point_m);
    let path = if radius_m > 0.0 { vec![(Piece::arc(from, to, contact.centre_m, false), Tag::Fillet { joint })] } else { Vec::new() };
    Some(Turn { at, path })
}

/// The outer side of strips of unequal widths: an arc with half the width of the thin one that touches both sides. For equal widths it
/// would be the arc round the node.
fn rounding(index: usize, [a, b]: [&Walk; 2], exact_m: f64) -> Option<Turn> {
    let [thin_m, thick_m] = [a.half_m(1.0).min(b.half_m(0.0)), a.half_m(1.0).max(b.half_m(0.0))];
    let rims: [&dyn Fn(f64) -> Oriented; 2] = [&|x| a.side(1.0 - x), &|x| b.side(x)];
    let lengths = [a.strip.length_m, b.strip.length_m];
    let beyond = BEYOND_HALF_WIDTHS * thick_m;
    let [arm_a, arm_b] = [0, 1].map(|k: usize| Arm { rim: rims[k], range: [-beyond / lengths[k], 1.0], speed_m: lengths[k] });
    // A circle beside a boundary at a negative distance is within the material.
    let contact = touch([&arm_a, &arm_b], -thin_m, exact_m)?;
    let at = [1.0 - contact.at[0], contact.at[1]];
    let arc = Piece::arc(a.side(at[0]).point_m, b.side(at[1]).point_m, contact.centre_m, true);
    Some(Turn { at, path: vec![(arc, Tag::Round { node: index })] })
}

/// From a thick strip to a thin one that leaves it by more than a right angle: straight down the end of the thick strip to the side of
/// the thin one, which goes on straight until there, with a fillet at the foot. A step lower than the fillet has no face: the fillet
/// begins at the edge. Where the end of the thick strip is `covered` by the thin one, it comes after an arc round the node with the thick
/// radius.
fn step(index: usize, node: &Node, [a, b]: [&Walk; 2], covered: bool, radius_m: f64, exact_m: f64) -> Option<Turn> {
    let thick_first = a.half_m(1.0) > b.half_m(0.0);
    let thick = if thick_first { a.side(1.0) } else { b.side(0.0) };
    let thin = if thick_first { b } else { a };
    let rim = |x: f64| thin.side(if thick_first { x } else { 1.0 - x });
    let length_m = thin.strip.length_m;
    // The face: from the node outward, and the direction that it looks in.
    let (foot, height_m) = (node.point_m, distance(thick.point_m, node.point_m));
    let beyond_m = if covered { exact_m } else { BEYOND_HALF_WIDTHS * height_m };
    let arm = Arm { rim: &rim, range: [-beyond_m / length_m, 1.0], speed_m: length_m };
    let (outward, ahead) = if covered {
        let axis = thin.axis(if thick_first { 0.0 } else { 1.0 }).tangent;
        (right(axis), if thick_first { axis } else { scale(axis, -1.0) })
    } else {
        (unit(sub(thick.point_m, foot)), if thick_first { thick.tangent } else { scale(thick.tangent, -1.0) })
    };
    let edge = along(foot, outward, height_m);
    let fillet = |from: Vector, x: f64| {
        let arc = Piece::arc(from, rim(x).point_m, arm.beside(x, radius_m), !thick_first);
        (arc, Tag::Fillet { joint: Joint::Node(index) })
    };
    let face = |s: f64| Oriented { point_m: along(edge, outward, -s), tangent: left(ahead) };
    let face_arm = Arm { rim: &face, range: [-exact_m, height_m], speed_m: 1.0 };
    let onto_face = touch([&face_arm, &arm], radius_m, exact_m).map(|contact| {
        let foot = face(contact.at[0].max(0.0)).point_m;
        let line = (Piece::Line { from: edge, to: foot }, Tag::Step { node: index });
        (contact.at[1], vec![line, fillet(foot, contact.at[1])])
    });
    let (x, down) = onto_face.or_else(|| first_at_distance(&arm, radius_m, edge, radius_m).map(|x| (x, vec![fillet(edge, x)])))?;
    let mut path = vec![(Piece::arc(thick.point_m, edge, node.point_m, thick_first), Tag::Round { node: index })];
    path.extend(down);
    path.retain(|(piece, _)| distance(piece.from(), piece.to()) > exact_m);
    if !thick_first {
        path = path.into_iter().rev().map(|(piece, tag)| (piece.reversed(), tag)).collect();
    }
    Some(Turn { at: if thick_first { [1.0, x] } else { [1.0 - x, 0.0] }, path })
}

/// The first place of an arm where the circle beside it is that far from a point, growing.
fn first_at_distance(arm: &Arm, radius_m: f64, point: Vector, far_m: f64) -> Option<f64> {
    let excess = |x: f64| distance(arm.beside(x, radius_m), point) - far_m;
    let places = arm.places();
    let pair = places.windows(2).find(|pair| excess(pair[0]) <= 0.0 && excess(pair[1]) > 0.0)?;
    roots::root(excess, pair[0], pair[1], 1e-15).ok()
}
