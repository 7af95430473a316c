//! Beams that pass through each other, through themselves or through the mirrored half.

mod common;
#[path = "common/drawing.rs"]
mod drawing;

use common::{NODES, Solved, solve};
use drawing::{Drawing, guide};
use forcewright_beam::Point;
use forcewright_compliant::{Crossing, first_crossing};

fn found(solved: &Solved) -> Option<Crossing> {
    first_crossing(&solved.design, &solved.behaviour.path)
}

fn clamped() -> String {
    "support = \"clamped\"".to_owned()
}

/// Straight beams between nodes in mm; the first node of each beam is clamped, the second node of the first beam is moved.
fn straight(beams: &[[(&'static str, [f64; 2]); 2]], direction: [f64; 2], travel: &str) -> Solved {
    let mut nodes: Vec<drawing::Node> = Vec::new();
    for [from, to] in beams {
        for ((name, at), support) in [(from, clamped()), (to, String::new())] {
            if !nodes.iter().any(|n| n.0 == *name) {
                nodes.push((*name, *at, support));
            }
        }
    }
    let names = ["b1", "b2", "b3"];
    let beams: Vec<drawing::Beam> = beams.iter().zip(names).map(|([from, to], name)| (name, [from.0, to.0], Vec::new())).collect();
    let load_node = beams[0].1[1];
    let travel = travel.to_owned();
    solve(&Drawing { nodes, beams, load_node, load_direction: direction, travel, mirror: None, model: "reissner" }.text(), &[])
}

/// Whether what a crossing names is crossed in a state: densely sampled and by another method. Left out are twentieths of two beams
/// at ends that are at the same place, and neighbours on the same beam.
fn is_crossed(point: &Point, crossing: &Crossing) -> bool {
    const CHORDS: usize = 600;
    let axis = |beam: usize| (0..=CHORDS).map(|i| point.beams[beam].shape_m(i as f64 / CHORDS as f64)).collect::<Vec<_>>();
    let one = axis(crossing.first);
    let Some(second) = crossing.second else { return one.iter().any(|p| p[0] < 0.0) };
    let other = axis(second);
    let near = |i: usize, end: usize| i.abs_diff(end) <= CHORDS / 20;
    let same = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).abs() + (p[1] - q[1]).abs() < 1e-7;
    let ends = [[0, 0], [0, CHORDS], [CHORDS, 0], [CHORDS, CHORDS]];
    let joints: Vec<[usize; 2]> = ends.into_iter().filter(|[a, b]| same(one[*a], other[*b])).collect();
    let counts = |i: usize, j: usize| {
        if crossing.first == second { i.abs_diff(j) > 40 } else { !joints.iter().any(|[a, b]| near(i, *a) && near(j, *b)) }
    };
    (0..CHORDS).any(|i| {
        (0..CHORDS).filter(|j| counts(i, *j)).any(|j| {
            // p + s u = q + t v by Cramer's rule.
            let (p, q) = (one[i], other[j]);
            let (u, v) = ([one[i + 1][0] - p[0], one[i + 1][1] - p[1]], [other[j + 1][0] - q[0], other[j + 1][1] - q[1]]);
            let (determinant, w) = (u[0] * v[1] - u[1] * v[0], [q[0] - p[0], q[1] - p[1]]);
            let s = (w[0] * v[1] - w[1] * v[0]) / determinant;
            let t = (w[0] * u[1] - w[1] * u[0]) / determinant;
            (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)
        })
    })
}

#[test]
fn table_3_is_clear() {
    let solved = solve(NODES, &[]);
    assert!(solved.behaviour.whole);
    assert_eq!(found(&solved), None);
}

#[test]
fn table_3_pushed_too_far_is_not() {
    let solved = solve(NODES, &["load.travel=40 mm"]);
    let path = &solved.behaviour.path;
    let crossing = found(&solved).expect("a crossing");
    let at = crossing.displacement_m;
    assert!(at > 13.6e-3 && at < path.reach(), "{crossing:?}");
    assert!(is_crossed(&path.at(at).unwrap(), &crossing), "{crossing:?} is not one");
    // Node n4, between b3 and b4, is pushed through b1. Clear two hundredths of a spacing before, and earlier, for every pair and the mirror line.
    let before = at - 0.02 * path.reach() / 24.0;
    for fraction in [1.0, 0.99, 0.9, 0.6, 0.3, 0.0] {
        let point = path.at(fraction * before).unwrap();
        for first in 0..4 {
            for second in (first..4).map(Some).chain([None]) {
                let other = Crossing { displacement_m: 0.0, first, second };
                assert!(!is_crossed(&point, &other), "{other:?} at {} before {crossing:?}", fraction * before);
            }
        }
    }
}

#[test]
fn beams_drawn_across_the_mirror_line_are_found_at_rest() {
    let solved = solve(NODES, &["layout.mirror=x = 3 mm"]);
    // n1 and n5 are at x = 2.5 mm; b1 is the first beam at one of them.
    assert_eq!(found(&solved), Some(Crossing { displacement_m: 0.0, first: 0, second: None }));
    // The whole network may be on the left.
    assert_eq!(found(&solve(NODES, &["layout.mirror=x = 60 mm"])), None);
}

#[test]
fn nodes_may_lie_on_the_mirror_line() {
    let with_mirror = |line: &str, at: [f64; 2]| {
        let mut drawing = Drawing::straight("", [0.0, -1.0], "1 mm", "reissner");
        drawing.mirror = Some(line.to_owned());
        drawing.nodes[1].1 = at;
        found(&solve(&drawing.text(), &[]))
    };
    let crossed = Some(Crossing { displacement_m: 0.0, first: 0, second: None });
    for (line, at, wanted) in [
        ("x = 0", [100.0, 0.0], None),
        ("x = 0", [-100.0, 0.0], None),
        ("x = 0.01 mm", [100.0, 0.0], crossed),
        ("x = -0.01 mm", [-100.0, 0.0], crossed),
    ] {
        assert_eq!(with_mirror(line, at), wanted, "{line}");
    }
}

#[test]
fn a_beam_that_bows_through_the_mirror_line_is_found() {
    let bowed = |bend: f64| {
        let mut drawing = Drawing::straight(&guide([0.0, 1.0]), [0.0, -1.0], "5 mm", "reissner");
        (drawing.nodes[0].1, drawing.nodes[1].1) = ([5.0, 0.0], [5.0, 100.0]);
        drawing.beams[0].2 = vec![bend];
        drawing.mirror = Some("x = 0".to_owned());
        solve(&drawing.text(), &[])
    };
    let solved = bowed(-0.1);
    let crossing = found(&solved).expect("a crossing");
    assert_eq!((crossing.first, crossing.second), (0, None));
    let crossed = |at: f64| is_crossed(&solved.behaviour.path.at(at).unwrap(), &crossing);
    assert!(crossing.displacement_m > 0.0 && crossed(crossing.displacement_m), "{crossing:?}");
    assert!(!crossed(crossing.displacement_m - 0.02 * 5e-3 / 20.0), "{crossing:?}");
    assert_eq!(found(&bowed(0.1)), None, "bows away from it");
}

#[test]
fn beams_drawn_crossed_are_found_at_rest() {
    let wanted = Some(Crossing { displacement_m: 0.0, first: 0, second: Some(1) });
    // In the middle of both, where both are sampled, and elsewhere.
    for end in [[100.0, 0.0], [100.0, 13.7], [73.1, 20.9]] {
        let beams = [[("n1", [0.0, 0.0]), ("n2", [100.0, 100.0])], [("n3", [0.0, 100.0]), ("n4", end)]];
        assert_eq!(found(&straight(&beams, [0.0, 1.0], "0.1 mm")), wanted, "{end:?}");
    }
    // One ends short of the other.
    let (whole, short) = ([("n1", [0.0, 0.0]), ("n2", [100.0, 100.0])], [("n3", [3.0, 100.0]), ("n4", [51.4, 51.6])]);
    for beams in [[whole, short], [short, whole]] {
        assert_eq!(found(&straight(&beams, [0.0, -1.0], "0.01 mm")), None);
    }
}

#[test]
fn the_tip_of_a_cantilever_meets_the_next_beam_at_their_distance() {
    // The lower beam carries nothing and stays where it is.
    let beams = [[("n1", [0.0, 0.0]), ("n2", [80.0, 0.0])], [("n3", [0.0, -10.0]), ("n4", [100.0, -10.0])]];
    let solved = straight(&beams, [0.0, -1.0], "25 mm");
    let crossing = found(&solved).expect("a crossing");
    assert_eq!((crossing.first, crossing.second), (0, Some(1)));
    let late = crossing.displacement_m - 10e-3;
    assert!((-1e-9..=0.01 * 25e-3 / 20.0).contains(&late), "{late} m late");
    assert_eq!(found(&straight(&beams, [0.0, -1.0], "9.9 mm")), None);
}

#[test]
fn beams_that_share_a_node_may_meet_there() {
    for height in [0.001, 0.1, 1.0, 10.0] {
        let beams = [[("n1", [0.0, 0.0]), ("n2", [100.0, 0.0])], [("n1", [0.0, 0.0]), ("n3", [70.0, height])]];
        assert_eq!(found(&straight(&beams, [0.0, -1.0], "1 mm")), None, "{height} mm");
    }
    // But not elsewhere: the first is pushed through the second.
    let beams = [[("n1", [0.0, 0.0]), ("n2", [60.0, 0.0])], [("n1", [0.0, 0.0]), ("n3", [100.0, 10.0])]];
    let crossing = found(&straight(&beams, [0.0, 1.0], "20 mm")).expect("a crossing");
    // The tip passes the second beam at a height of about 6 mm; it moves inwards a little.
    assert!((5.8e-3..6.1e-3).contains(&crossing.displacement_m), "{crossing:?}");
}

#[test]
fn a_looped_beam_crosses_itself() {
    let looped = |turn: f64| {
        // Level at both ends; the turn is made in between.
        let mut drawing = Drawing::straight("", [0.0, -1.0], "0.1 mm", "reissner");
        drawing.beams[0].2 = vec![0.0, 3.0 * turn, -2.0 * turn];
        found(&solve(&drawing.text(), &[]))
    };
    assert_eq!(looped(std::f64::consts::TAU), Some(Crossing { displacement_m: 0.0, first: 0, second: Some(0) }));
    assert_eq!(looped(1.5), None);
}
