//! Distances between the surfaces of beams: closed forms, and random networks against a search that knows no derivatives.

mod common;

use std::f64::consts::{FRAC_PI_2, PI};

use common::{POM, SplitMix, close, node, random_network, rigid, solve, table3_by_nodes};
use forcewright_base::maths;
use forcewright_beam::{Clearance, Drive, Image, Network, Point, Reflection, Section, Settings, Shape, Support, Theory, clearance, trace};

/// Beams between clamps, each from a start with its angle coefficients and length; 1 mm thick.
fn loose(beams: &[([f64; 2], &[f64], f64)]) -> Network {
    let mut network = Network::new(Vec::new(), Vec::new(), Drive::Rotation { node: 0 });
    for (start, angle, length) in beams {
        let shape = Shape::new(angle.to_vec(), *length).expect("a shape");
        let [x, y] = shape.chord_m();
        let first = network.nodes.len();
        network.nodes.extend([node(*start, Support::Clamped), node([start[0] + x, start[1] + y], Support::Clamped)]);
        network.beams.push(rigid(first, first + 1, shape, POM));
    }
    network
}

fn at_rest(beams: &[([f64; 2], &[f64], f64)]) -> Option<Clearance> {
    clearance(&loose(beams), None, &[])
}

#[track_caller]
fn is(found: Option<Clearance>, axes_m: f64, what: &str) -> Clearance {
    let found = found.unwrap_or_else(|| panic!("{what}: nothing found"));
    close(found.distance_m, axes_m - 1e-3, 1e-13, what);
    found
}

#[test]
fn straight_beams() {
    // Parallel, side by side and shifted past each other.
    is(at_rest(&[([0.0, 0.0], &[0.0], 0.1), ([0.0, 0.02], &[0.0], 0.1)]), 0.02, "parallel");
    is(at_rest(&[([0.0, 0.0], &[0.0], 0.1), ([0.13, 0.04], &[0.0], 0.1)]), 0.05, "ends");
    is(at_rest(&[([0.0, 0.0], &[0.0], 0.1), ([0.031, 0.004], &[FRAC_PI_2], 0.1)]), 0.004, "an end over the inside");
    is(
        at_rest(&[([0.0, 0.0], &[0.3], 0.1), ([0.05, 0.05], &[0.3 + PI], 0.1)]),
        0.05 * maths::cos(0.3) - 0.05 * maths::sin(0.3),
        "antiparallel",
    );
    let crossing = is(at_rest(&[([0.0, 0.0], &[0.0], 0.1), ([0.037, -0.02], &[1.2], 0.1)]), 0.0, "crossing");
    close(crossing.first.u, (0.037 + 0.02 / maths::tan(1.2)) / 0.1, 1e-9, "place of the crossing");
    assert!((crossing.first.beam, crossing.second.beam, crossing.image) == (0, 1, None));
}

#[test]
fn arcs() {
    let arc = |radius: f64, turn: f64| Shape::new(vec![0.0, turn], radius * turn).expect("an arc");
    // Concentric: centre (0, 0.05).
    let (inner, outer) = (arc(0.03, 2.0), arc(0.05, 2.0));
    let found = at_rest(&[([0.0, 0.02], inner.angle_rad(), inner.length_m()), ([0.0, 0.0], outer.angle_rad(), outer.length_m())]);
    is(found, 0.02, "concentric");
    // A line beside an arc: height of the arc's top below the line.
    let found = at_rest(&[([0.0, 0.0], &[1.0, -2.0], 0.05), ([-0.02, 0.02], &[0.0], 0.1)]);
    let radius = 0.025;
    is(found, 0.02 - radius * (1.0 - maths::cos(1.0)), "an arc under a line");
}

#[test]
fn a_beam_and_itself() {
    // A hook of 300°: its ends are a chord of 60° apart.
    let turn = 5.0 * PI / 3.0;
    let found = is(at_rest(&[([0.0, 0.0], &[0.0, turn], 0.03 * turn)]), 0.03, "a hook");
    assert_eq!((found.first.u, found.second.u), (0.0, 1.0));
    assert!(at_rest(&[([0.0, 0.0], &[0.0, 1.0], 0.03)]).is_none(), "an open arc");
    assert!(at_rest(&[([0.0, 0.0], &[0.7], 0.03)]).is_none(), "a straight beam");
    // More than a turn of a spiral that opens: it passes its own start.
    is(at_rest(&[([0.0, 0.0], &[0.0, 0.0, 3.0 * PI * 2.0, -2.0 * PI * 2.0], 0.1)]), 0.0, "a loop crosses itself");
}

#[test]
fn beams_that_share_a_joint() {
    let joined = |second: &[f64], chain: &[f64]| {
        let section = Section { thickness_m: 1e-3, ..POM };
        let mut network = Network::new(vec![node([0.0, 0.0], Support::Clamped)], Vec::new(), Drive::Rotation { node: 1 });
        let mut at = [0.0, 0.0];
        for (angle, from) in [(&[0.0][..], 0), (second, 0), (chain, 2)] {
            let shape = Shape::new(angle.to_vec(), 0.05).expect("a shape");
            at = if from == 0 { [0.0, 0.0] } else { at };
            at = common::add(at, shape.chord_m(), 1.0);
            network.nodes.push(node(at, Support::Free));
            network.beams.push(rigid(from, network.nodes.len() - 1, shape, section));
        }
        clearance(&network, None, &[])
    };
    // Straight apart, however narrow the angle; the chain goes on straight.
    for angle in [1e-3, 0.05, 0.4, 2.0] {
        assert!(joined(&[angle], &[angle]).is_none(), "{angle} rad");
        assert!(joined(&[angle, 0.2], &[angle + 0.2]).is_none(), "{angle} rad and bent away");
        // Tangent at the joint.
        assert!(joined(&[0.0, angle], &[angle]).is_none(), "tangent, bent by {angle} rad");
    }
    // The chain comes back over the first beam: its end is above the inside.
    let found = joined(&[1.0], &[-1.2]).expect("a distance");
    let [x, y] = [0, 1].map(|k| 0.05 * if k == 0 { maths::cos(1.0) + maths::cos(1.2) } else { maths::sin(1.0) - maths::sin(1.2) });
    assert!(y < 0.0 && x < 0.05, "it crosses");
    close(found.distance_m, -1e-3, 1e-13, "crossing");
    let found = joined(&[1.0], &[-0.9]).expect("a distance");
    close(found.distance_m, 0.05 * (maths::sin(1.9) - maths::sin(0.9)) - 1e-3, 1e-13, "the tip under the chain");
}

#[test]
fn a_chain_is_not_near_itself() {
    // Four short pieces of a circle with one centre: none is near another.
    let turn = 0.5;
    let mut network = Network::new(vec![node([0.0, 0.0], Support::Clamped)], Vec::new(), Drive::Rotation { node: 1 });
    for i in 0..4 {
        let shape = Shape::new(vec![turn * f64::from(i), turn], 0.004).expect("an arc");
        let at = common::add(network.nodes.last().expect("a node").position_m, shape.chord_m(), 1.0);
        network.nodes.push(node(at, Support::Free));
        network.beams.push(rigid(network.nodes.len() - 2, network.nodes.len() - 1, shape, POM));
    }
    assert!(clearance(&network, None, &[]).is_none());
}

/// A copy, shifted or mirrored and shifted, counts as if it were drawn. Its pairs are not symmetric: an inclined beam comes near to the
/// one above it with its other end.
#[test]
fn shifted_copies() {
    let beams: [([f64; 2], &[f64], f64); 2] = [([0.0, 0.0], &[0.5, 0.3], 0.05), ([0.0, 0.02], &[0.4, -0.6, 0.2], 0.04)];
    let mirrored: [([f64; 2], &[f64], f64); 2] = [([0.14, 0.0], &[PI - 0.5, -0.3], 0.05), ([0.14, 0.02], &[PI - 0.4, 0.6, -0.2], 0.04)];
    let line = Reflection { point_m: [0.07, 0.0], direction: [0.0, 1.0] };
    for [x, y] in [[0.0, 0.05], [0.01, -0.06], [0.09, 0.002]] {
        for (copies, reflection) in [(&beams, None), (&mirrored, Some(line))] {
            let copies: Vec<_> = copies.iter().map(|(at, shape, length)| ([at[0] + x, at[1] + y], *shape, *length)).collect();
            let wanted = at_rest(&[&beams[..], &copies[..]].concat()).expect("a distance");
            let found = clearance(&loose(&beams), None, &[Image { reflection, shift_m: [x, y] }]).expect("a distance");
            close(found.distance_m, wanted.distance_m, 1e-13, "shifted");
        }
    }
}

#[test]
fn mirror_images() {
    let line = |x: f64| Image::from(Reflection { point_m: [x, 7.0], direction: [0.0, -3.0] });
    let network = loose(&[([0.01, 0.0], &[FRAC_PI_2 + 0.6, -1.2], 0.05)]);
    let lean = network.beams[0].shape.point_m(0.5)[0];
    let found = is(clearance(&network, None, &[line(-0.002)]), 2.0 * (0.012 + lean), "bulges towards the line");
    assert!(found.image == Some(0) && found.first.beam == found.second.beam);
    close(found.first.point_m[0] + found.second.point_m[0], -0.004, 1e-13, "images");
    // The same, turned by 0.4 rad about the origin.
    let turned = loose(&[([0.01 * maths::cos(0.4), 0.01 * maths::sin(0.4)], &[FRAC_PI_2 + 1.0, -1.2], 0.05)]);
    let [x, y] = [-0.002 * maths::cos(0.4), -0.002 * maths::sin(0.4)];
    let oblique = Reflection { point_m: [x, y], direction: [-maths::sin(0.4), maths::cos(0.4)] };
    is(clearance(&turned, None, &[oblique.into()]), 2.0 * (0.012 + lean), "oblique");
    // A beam that starts on the line meets its image in a joint there.
    let network = loose(&[([0.0, 0.0], &[0.3], 0.05)]);
    assert!(clearance(&network, None, &[line(0.0)]).is_none());
    is(clearance(&loose(&[([0.01, 0.0], &[PI], 0.05)]), None, &[line(0.0)]), 0.0, "through the line");
}

#[test]
fn thickness_of_both_beams_counts() {
    let mut network = loose(&[([0.0, 0.0], &[0.0], 0.1), ([0.0, 0.02], &[0.0], 0.1)]);
    network.beams[1].section.thickness_m = 5e-3;
    close(clearance(&network, None, &[]).expect("a distance").distance_m, 0.02 - 3e-3, 1e-15, "1 mm and 5 mm");
}

/// The rule of three points over a fortieth of a beam, against that over the whole of it.
#[test]
fn steps_along_an_axis_are_differences_of_its_places() {
    let network = table3_by_nodes(POM);
    for theory in [Theory::Inextensible, Theory::Reissner] {
        let settings = Settings { theory, ..Settings::default() };
        let path = trace(&network, &[0.0136], &settings, &mut |_| true).expect("a path");
        for beam in &path.points[path.points.len() - 1].beams {
            for i in 0..40 {
                let [from, to] = [i, i + 1].map(|i| f64::from(i) / 40.0);
                let ([a, b], step) = ([from, to].map(|u| beam.shape_m(u)), beam.step_m(from, to));
                (0..2).for_each(|k| close(step[k], b[k] - a[k], 1e-14, "a step"));
                close(beam.step_m(to, from)[0], -step[0], 1e-16, "the way back");
            }
        }
    }
}

/// Distance of two axes at two places, by the engine's positions.
fn between(point: &Point, pair: (usize, usize), [u, v]: [f64; 2]) -> f64 {
    let (p, q) = (point.beams[pair.0].shape_m(u), point.beams[pair.1].shape_m(v));
    maths::hypot(p[0] - q[0], p[1] - q[1])
}

/// Walks downhill by trial steps only; `None` if it has not arrived after many.
fn walk(point: &Point, pair: (usize, usize), mut at: [f64; 2]) -> Option<[f64; 2]> {
    let (mut step, mut trials) = (0.04, 0);
    let mut value = between(point, pair, at);
    while step > 1e-7 {
        let before = value;
        for (a, b) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)] {
            let next = [at[0] + step * a, at[1] + step * b].map(|u| u.clamp(0.0, 1.0));
            let reached = between(point, pair, next);
            if reached < value {
                (at, value) = (next, reached);
            }
        }
        if value >= before {
            step *= 0.5;
        }
        trials += 1;
        if trials > 400 {
            return None;
        }
    }
    Some(at)
}

/// Smallest distance of surfaces over all beams by walking from a coarse grid, leaving out joints and ends from which a beam leads nearer.
fn by_walking(network: &Network, point: &Point) -> f64 {
    let mut least = f64::INFINITY;
    let ends = |beam: usize| [network.beams[beam].start, network.beams[beam].end];
    let count = network.beams.len();
    for pair in (0..count).flat_map(|i| (i..count).map(move |j| (i, j))) {
        for (i, j) in (0..=6).flat_map(|i| (0..=6).map(move |j| (i, j))) {
            if pair.0 == pair.1 && i >= j {
                continue;
            }
            let Some([u, v]) = walk(point, pair, [f64::from(i) / 6.0, f64::from(j) / 6.0]) else { continue };
            let node = |beam: usize, u: f64| {
                if u < 1e-4 {
                    Some(ends(beam)[0])
                } else if u > 1.0 - 1e-4 {
                    Some(ends(beam)[1])
                } else {
                    None
                }
            };
            let (a, b) = (node(pair.0, u), node(pair.1, v));
            if (pair.0 == pair.1 && (u - v).abs() < 1e-3) || (a.is_some() && a == b) {
                continue;
            }
            let axes_m = between(point, pair, [u, v]);
            // From an end, a little way along every beam there.
            let nearer = |node: usize, other: (usize, f64)| {
                (0..count).any(|k| {
                    (0..2).any(|end| {
                        let a_way = if end == 0 { 1e-3 } else { 1.0 - 1e-3 };
                        ends(k)[end] == node && between(point, (k, other.0), [a_way, other.1]) < axes_m - 1e-12
                    })
                })
            };
            if !a.is_some_and(|n| nearer(n, (pair.1, v))) && !b.is_some_and(|n| nearer(n, (pair.0, u))) {
                least = least.min(axes_m - 1e-3);
            }
        }
    }
    least
}

#[test]
fn random_networks_against_walking() {
    let mut random = SplitMix(20_260_822);
    let mut compared = 0;
    for trial in 0..6 {
        let Ok(network) = random_network(&mut random, 3.0, 1.5) else { continue };
        let settings = common::elastica();
        let Ok(path) = trace(&network, &[0.0, 8e-3], &settings, &mut |_| true) else { continue };
        for point in &path.points {
            let wanted = by_walking(&network, point);
            let found = clearance(&network, Some(point), &[]).map_or(f64::INFINITY, |c| c.distance_m);
            if wanted.is_infinite() || found.is_infinite() {
                assert_eq!(wanted.is_infinite(), found.is_infinite(), "{trial}: {found} by the engine, {wanted} by walking");
                continue;
            }
            // A crossing is found by walking to its last step only.
            close(found, wanted, if wanted < 0.0 { 1e-8 } else { 1e-10 }, &format!("network {trial} at {} m", point.displacement));
            compared += 1;
        }
    }
    assert!(compared >= 8, "only {compared} states");
}

#[test]
fn the_paper_mechanism_at_rest_and_pushed() {
    let network = table3_by_nodes(POM);
    let path = solve(&network, &[0.0, 6.8e-3, 13.6e-3], &common::elastica());
    let line = Reflection { point_m: [0.0, 0.0], direction: [0.0, 1.0] };
    let rest = clearance(&network, None, &[line.into()]).expect("a distance");
    let same = clearance(&network, Some(&path.points[0]), &[line.into()]).expect("a distance");
    close(same.distance_m, rest.distance_m, 1e-12, "rest by its shapes and by its state");
    for point in &path.points[1..] {
        let alone = clearance(&network, Some(point), &[]).expect("a distance").distance_m;
        let both = clearance(&network, Some(point), &[line.into()]).expect("a distance").distance_m;
        assert!(both <= alone, "{both} {alone}");
        close(alone, by_walking(&network, point), 1e-10, "drawn half");
    }
}

/// Ends on the arms of one body are not at one place: each may be near something, and near the other.
#[test]
fn ends_of_a_rigid_body() {
    let beam = |start: usize, end: usize, from: [f64; 2], to: [f64; 2]| {
        rigid(start, end, Shape::from_chord([to[0] - from[0], to[1] - from[1]], &[]).expect("straight"), POM)
    };
    let nodes = vec![
        node([-0.05, 0.0], Support::Clamped),
        node([0.0, 0.0], Support::Free),
        node([0.08, 0.04], Support::Clamped),
        node([-0.004, -0.03], Support::Clamped),
        node([-0.004, 0.03], Support::Clamped),
    ];
    let mut left = beam(0, 1, [-0.05, 0.0], [-0.01, 0.0]);
    left.arms_m[1] = [-0.01, 0.0];
    let mut right = beam(1, 2, [0.03, 0.04], [0.08, 0.04]);
    right.arms_m[0] = [0.03, 0.04];
    let foreign = beam(3, 4, [-0.004, -0.03], [-0.004, 0.03]);
    let drive = Drive::Displacement { node: 1, direction: [0.0, 1.0] };
    is(clearance(&Network::new(nodes.clone(), vec![left, right.clone(), foreign], drive), None, &[]), 0.006, "a foreign beam");
    let mut near = beam(0, 1, [-0.05, 0.0], [-0.01, 0.0]);
    near.arms_m[1] = [-0.01, 0.0];
    let mut other = beam(1, 2, [-0.006, 0.003], [0.08, 0.04]);
    other.arms_m[0] = [-0.006, 0.003];
    // Two ends on one body stay as they were made; the same ends on two nodes may meet.
    let body = Network::new(nodes.clone(), vec![near.clone(), other.clone()], drive);
    assert!(clearance(&body, None, &[]).is_none());
    let mut apart = nodes;
    apart.push(node([0.0, 0.0], Support::Free));
    other.start = 5;
    is(clearance(&Network::new(apart, vec![near, other], drive), None, &[]), 0.005, "two ends on two nodes");
    // What is not a network has no clearance.
    let mut wrong = loose(&[([0.0, 0.0], &[0.0], 0.1), ([0.0, 0.02], &[0.0], 0.1)]);
    let line = Reflection { point_m: [0.0; 2], direction: [0.0; 2] };
    assert!(clearance(&wrong, None, &[line.into()]).is_none());
    wrong.beams[0].start = 99;
    assert!(clearance(&wrong, None, &[]).is_none());
}
