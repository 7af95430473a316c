//! Outlines of strips and blocks against closed forms.

mod common;

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, TAU};

use common::{Intrinsic, circular, fillet_area, lan_beams, lan_half, node, pad, star, straight};
use forcewright_base::{maths, roots};
use forcewright_curves::fit::Oriented;
use forcewright_curves::outline::{Block, Cap, HalfWidth, Joint, Network, Node, Outline, OutlineError, Side, Strip, Tag};
use forcewright_curves::walls::thickness_along;
use forcewright_curves::{Motion, Segment};
use proptest::prelude::*;

const TOLERANCE_M: f64 = 1e-7;

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value} is not {expected}");
}

/// Number of windows by Euler's formula: edges − vertices + connected parts.
fn windows(outline: &Outline) -> usize {
    outline.regions.iter().map(|region| region.windows.len()).sum()
}

#[track_caller]
fn sound(outline: &Outline) {
    for boundary in outline.boundaries() {
        assert_eq!(boundary.profile.segments.len(), boundary.tags.len());
        boundary.profile.check(1e-9).expect("a simple boundary");
        smooth(&boundary.profile, &boundary.tags);
    }
}

/// Fillets are tangent to what they touch.
#[track_caller]
fn smooth(profile: &forcewright_curves::Profile, tags: &[Tag]) {
    let ends = end_tangents(profile);
    for k in 0..tags.len() {
        let next = (k + 1) % tags.len();
        let fillet = [tags[k], tags[next]].iter().any(|tag| matches!(tag, Tag::Fillet { .. }));
        let ([_, out], [into, _]) = (ends[k], ends[next]);
        let sine = out[0] * into[1] - out[1] * into[0];
        assert!(!fillet || sine.abs() < 1e-6, "{:?} meets {:?} at an angle of {sine} rad", tags[k], tags[next]);
    }
}

fn end_tangents(profile: &forcewright_curves::Profile) -> Vec<[[f64; 2]; 2]> {
    let unit = |a: [f64; 2], b: [f64; 2]| {
        let length = maths::hypot(b[0] - a[0], b[1] - a[1]);
        [(b[0] - a[0]) / length, (b[1] - a[1]) / length]
    };
    let mut from = profile.start_m;
    let mut tangents = Vec::new();
    for segment in &profile.segments {
        let to = segment.end_m();
        tangents.push(match segment {
            Segment::Line { .. } => [unit(from, to); 2],
            Segment::Arc { centre_m, counterclockwise, .. } => {
                let sign = if *counterclockwise { 1.0 } else { -1.0 };
                let turned = |p: [f64; 2]| {
                    let [x, y] = unit(*centre_m, p);
                    [-sign * y, sign * x]
                };
                [turned(from), turned(to)]
            }
            Segment::Spline(spline) => {
                let c = &spline.control_m;
                [unit(c[0], c[1]), unit(c[c.len() - 2], c[c.len() - 1])]
            }
        });
        from = to;
    }
    tangents
}

/// Area of straight strips from one node with square ends, sector by sector.
fn star_area(directions: &[f64], length: f64, half: f64, fillet: f64) -> f64 {
    let sector = |k: usize| {
        let opening = (directions[(k + 1) % directions.len()] - directions[k]).rem_euclid(TAU);
        let opening = if opening == 0.0 { TAU } else { opening };
        if opening < PI {
            half * (2.0 * length - half / maths::tan(0.5 * opening)) + fillet_area(fillet, opening)
        } else {
            2.0 * half * length + 0.5 * half * half * (opening - PI)
        }
    };
    (0..directions.len()).map(sector).sum()
}

#[test]
fn a_straight_strip_is_a_rectangle() {
    let outline = star(&[0.3, 0.3 + PI], 5.0, 0.25, 0.1).outline(1e-6).unwrap();
    sound(&outline);
    close(outline.area_m2(), 10.0 * 0.5, 1e-14);
    let outer = &outline.regions[0].outer;
    assert!(outer.profile.segments.iter().all(|segment| matches!(segment, Segment::Line { .. })));
    assert_eq!(outer.tags.len(), 6);
    assert!(outline.fit_error_m <= 0.0);
}

#[test]
fn junctions_have_the_area_of_their_sectors() {
    let l = [0.0, FRAC_PI_2];
    let t = [0.0, FRAC_PI_2, PI];
    let y = [0.2, 0.2 + TAU / 3.0, 0.2 + 2.0 * TAU / 3.0];
    let acute = [0.0, 0.4, FRAC_PI_3, 2.9];
    let cross = [0.0, FRAC_PI_2, PI, 1.5 * PI];
    for directions in [&l[..], &t, &y, &acute, &cross] {
        for fillet in [0.0, 0.05, 0.3] {
            let outline = star(directions, 6.0, 0.2, fillet).outline(1e-6).unwrap();
            sound(&outline);
            close(outline.area_m2(), star_area(directions, 6.0, 0.2, fillet), 1e-12);
            assert_eq!((outline.regions.len(), windows(&outline)), (1, 0));
        }
    }
}

#[test]
fn a_strip_between_pads_has_four_fillets() {
    let (fillet, width, length) = (0.7, 1.0, 20.0);
    let network = Network {
        nodes: Vec::new(),
        blocks: vec![pad([-8.0, -5.0], [0.0, 5.0], fillet), pad([length, -4.0], [length + 6.0, 4.0], fillet)],
        strips: vec![straight([0.0, 0.0], [length, 0.0], 0.5 * width, [Joint::Block(0), Joint::Block(1)])],
    };
    let outline = network.outline(1e-6).unwrap();
    sound(&outline);
    close(outline.area_m2(), 80.0 + 48.0 + width * length + 4.0 * (1.0 - 0.25 * PI) * fillet * fillet, 1e-13);
    let fillets = outline.boundaries().flat_map(|boundary| &boundary.tags).filter(|tag| matches!(tag, Tag::Fillet { .. })).count();
    assert_eq!(fillets, 4);
}

/// The axis may end inside the block: only what is outside counts. Corners in clockwise order, rounded.
#[test]
fn a_strip_may_end_inside_a_block_with_rounded_corners() {
    let (fillet, rounding) = (0.5, 1.0);
    let corners_m = vec![[-6.0, -3.0], [-6.0, 3.0], [0.0, 3.0], [0.0, -3.0]];
    let network = Network {
        nodes: vec![Node { point_m: [10.0, 0.0], fillet_m: 0.0, cap: Cap::Round }],
        blocks: vec![Block { corners_m, corner_radius_m: rounding, fillet_m: fillet }],
        strips: vec![straight([-3.0, 0.0], [10.0, 0.0], 0.5, [Joint::Block(0), Joint::Node(0)])],
    };
    let outline = network.outline(1e-6).unwrap();
    sound(&outline);
    let expected = 36.0 - (4.0 - PI) * rounding * rounding + 10.0 + 0.5 * PI * 0.25 + 2.0 * (1.0 - 0.25 * PI) * fillet * fillet;
    close(outline.area_m2(), expected, 1e-13);
    let edges: Vec<usize> =
        outline.regions[0].outer.tags.iter().filter_map(|tag| if let Tag::Edge { edge, .. } = tag { Some(*edge) } else { None }).collect();
    // edge 2 joins the corners on the right; it is cut in two by the strip
    assert_eq!(edges.iter().filter(|edge| **edge == 2).count(), 2);
    assert_eq!(edges.len(), 5);
}

#[test]
fn a_slanted_strip_meets_the_edge_at_both_its_angles() {
    let (half, fillet, slant): (f64, f64, f64) = (0.5, 0.8, 0.45);
    let (sin, cos) = maths::sin_cos(slant);
    let length = 12.0;
    let network = Network {
        nodes: vec![node([length * cos, length * sin], 0.0)],
        blocks: vec![pad([-10.0, -4.0], [10.0, 0.0], fillet)],
        strips: vec![straight([0.0, 0.0], [length * cos, length * sin], half, [Joint::Block(0), Joint::Node(0)])],
    };
    let outline = network.outline(1e-6).unwrap();
    sound(&outline);
    let expected = 80.0 + 2.0 * half * length + fillet_area(fillet, slant) + fillet_area(fillet, PI - slant);
    close(outline.area_m2(), expected, 1e-12);
}

#[test]
fn circular_strips_have_arcs() {
    let (radius, half, sweep) = (10.0, 0.5, 2.2);
    let network = Network {
        nodes: vec![node([radius, 0.0], 0.0), node([radius * maths::cos(sweep), radius * maths::sin(sweep)], 0.0)],
        blocks: Vec::new(),
        strips: vec![circular([0.0, 0.0], radius, 0.0, sweep, half, [Joint::Node(0), Joint::Node(1)])],
    };
    let outline = network.outline(1e-6).unwrap();
    sound(&outline);
    close(outline.area_m2(), 2.0 * half * radius * sweep, 1e-13);
    let arcs = |segment: &Segment| matches!(segment, Segment::Arc { .. });
    assert_eq!(outline.regions[0].outer.profile.segments.iter().filter(|segment| arcs(segment)).count(), 2);
    assert_eq!(outline.regions[0].outer.tags.len(), 4);
}

#[test]
fn a_ring_has_a_window() {
    let whole = |sweep: f64| Network {
        nodes: vec![node([3.0, 0.0], 0.1)],
        blocks: Vec::new(),
        strips: vec![circular([0.0, 0.0], 3.0, 0.0, sweep, 0.5, [Joint::Node(0), Joint::Node(0)])],
    };
    for sweep in [TAU, -TAU] {
        let outline = whole(sweep).outline(1e-6).unwrap();
        sound(&outline);
        close(outline.area_m2(), TAU * 3.0, 1e-12);
        assert_eq!((outline.regions.len(), windows(&outline)), (1, 1));
        assert!(outline.regions[0].windows[0].profile.area_m2() < 0.0);
    }
}

#[test]
fn windows_are_those_of_eulers_formula() {
    // a square with one diagonal, a post with nothing round it, and a lone block
    let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [20.0, 0.0], [20.0, 5.0]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [4, 5]];
    let network = Network {
        nodes: corners.iter().map(|corner| node(*corner, 0.3)).collect(),
        blocks: vec![pad([2.0, 6.0], [4.0, 8.0], 0.0)],
        strips: edges.iter().map(|[a, b]| straight(corners[*a], corners[*b], 0.4, [Joint::Node(*a), Joint::Node(*b)])).collect(),
    };
    let outline = network.outline(1e-6).unwrap();
    sound(&outline);
    assert_eq!(outline.regions.len(), 3);
    assert_eq!(windows(&outline), edges.len() + 2 - corners.len());
    assert_eq!(outline.regions[0].windows.len(), 2);
    close(outline.regions[1].outer.profile.area_m2(), 0.8 * 5.0, 1e-13);
    close(outline.regions[2].outer.profile.area_m2(), 4.0, 1e-13);
}

#[test]
fn a_step_in_width_is_a_face_with_a_fillet() {
    let step = |fillet: f64, thick_first: bool| {
        let halves = if thick_first { [1.0, 0.6] } else { [0.6, 1.0] };
        Network {
            nodes: vec![node([-5.0, 0.0], 0.0), node([0.0, 0.0], fillet), node([5.0, 0.0], 0.0)],
            blocks: Vec::new(),
            strips: vec![
                straight([-5.0, 0.0], [0.0, 0.0], halves[0], [Joint::Node(0), Joint::Node(1)]),
                straight([0.0, 0.0], [5.0, 0.0], halves[1], [Joint::Node(1), Joint::Node(2)]),
            ],
        }
    };
    for thick_first in [true, false] {
        // lower than the step: a quarter circle at its foot
        let low = step(0.25, thick_first).outline(1e-6).unwrap();
        sound(&low);
        close(low.area_m2(), 16.0 + 2.0 * (1.0 - 0.25 * PI) * 0.0625, 1e-12);
        // higher: the circle touches the thin side and passes through the edge
        let (r, d): (f64, f64) = (1.5, 0.4);
        let high = step(r, thick_first).outline(1e-6).unwrap();
        close(high.area_m2(), 16.0 + 2.0 * under_low_step(r, d), 1e-12);
        let sharp = step(0.0, thick_first).outline(1e-6).unwrap();
        close(sharp.area_m2(), 16.0, 1e-13);
    }
}

/// Area under a fillet that touches the lower side of a step and passes through its edge.
fn under_low_step(r: f64, d: f64) -> f64 {
    let reach = (2.0 * r * d - d * d).sqrt();
    r * reach - 0.5 * (reach * (r - d) + r * r * maths::asin(reach / r))
}

#[test]
fn unequal_strips_turn_round_the_thicker_one() {
    // a right angle: outside, a quarter of a circle with the thin radius touches both sides
    let (thick, thin, r): (f64, f64, f64) = (1.0, 0.9, 0.2);
    for thick_first in [true, false] {
        let halves = if thick_first { [thick, thin] } else { [thin, thick] };
        let network = Network {
            nodes: vec![node([6.0, 0.0], 0.0), node([0.0, 0.0], r), node([0.0, 6.0], 0.0)],
            blocks: Vec::new(),
            strips: vec![
                straight([6.0, 0.0], [0.0, 0.0], halves[0], [Joint::Node(0), Joint::Node(1)]),
                straight([0.0, 0.0], [0.0, 6.0], halves[1], [Joint::Node(1), Joint::Node(2)]),
            ],
        };
        let outline = network.outline(1e-6).unwrap();
        outline.regions[0].outer.profile.check(1e-9).unwrap();
        let inner = thick * 6.0 + thin * 6.0 - thick * thin + fillet_area(r, FRAC_PI_2);
        let outer = thick * 6.0 + thin * 6.0 + 0.25 * PI * thin * thin + thin * (thick - thin);
        close(outline.area_m2(), inner + outer, 1e-12);
    }
}

#[test]
fn strips_of_different_width_meet_where_their_sides_do() {
    let (wide, narrow, length, r) = (0.5, 0.2, 6.0, 0.3);
    let ends = [[-length, 0.0], [length, 0.0], [0.0, length]];
    let mut nodes = vec![node([0.0, 0.0], r)];
    nodes.extend(ends.iter().map(|end| node(*end, 0.0)));
    let halves = [wide, wide, narrow];
    let strips = (0..3).map(|k| straight([0.0, 0.0], ends[k], halves[k], [Joint::Node(0), Joint::Node(k + 1)])).collect();
    let outline = Network { nodes, blocks: Vec::new(), strips }.outline(1e-6).unwrap();
    sound(&outline);
    let expected = 4.0 * wide * length + 2.0 * narrow * (length - wide) + 2.0 * fillet_area(r, FRAC_PI_2);
    close(outline.area_m2(), expected, 1e-12);
}

/// The largest angle by which a boundary turns left between segments, rad.
fn sharpest(boundary: &forcewright_curves::outline::Boundary) -> f64 {
    let ends = end_tangents(&boundary.profile);
    let turn = |k: usize| {
        let ([_, out], [into, _]) = (ends[k], ends[(k + 1) % ends.len()]);
        maths::atan2(out[0] * into[1] - out[1] * into[0], out[0] * into[0] + out[1] * into[1])
    };
    (0..ends.len()).map(turn).fold(0.0, f64::max)
}

/// From well inside to well outside a straight angle: always one simple region, whose area changes gradually.
#[test]
fn unequal_strips_meet_at_any_angle() {
    let (thick, thin, length) = (0.5, 0.35, 6.0);
    for fillet in [0.05, 0.4] {
        for thick_first in [true, false] {
            let halves = if thick_first { [thick, thin] } else { [thin, thick] };
            for step in 0..=60 {
                let turn = PI + (f64::from(step) - 30.0) * 0.05;
                let ends = [[length, 0.0], [length * maths::cos(turn), length * maths::sin(turn)]];
                let nodes = vec![node([0.0, 0.0], fillet), node(ends[0], 0.0), node(ends[1], 0.0)];
                let strips = (0..2).map(|k| straight([0.0, 0.0], ends[k], halves[k], [Joint::Node(0), Joint::Node(k + 1)])).collect();
                let outline = Network { nodes, blocks: Vec::new(), strips }.outline(1e-6).unwrap();
                outline.regions[0].outer.profile.check(1e-9).unwrap();
                let sharp = sharpest(&outline.regions[0].outer);
                assert!(sharp < 1.7, "{turn}: a beak of {sharp} rad");
                let plain = 2.0 * (thick + thin) * length;
                assert!((outline.area_m2() - plain).abs() < 0.5 * thick * thick, "{turn}: {}", outline.area_m2() - plain);
            }
        }
    }
}

#[test]
fn a_curved_taper_has_its_width_across_its_axis() {
    let axis = lan_beams()[2].clone();
    let mut strip = axis.strip(1.0, [Joint::Node(0), Joint::Node(1)]);
    strip.half_width = HalfWidth::Linear(vec![[0.0, 0.6e-3], [1.0, 0.3e-3]]);
    let nodes = vec![node(axis.point(0.0), 0.0), node(axis.point(1.0), 0.0)];
    let outline = Network { nodes, blocks: Vec::new(), strips: vec![strip] }.outline(1e-9).unwrap();
    let along = |u: f64| {
        let place = axis.at(u);
        Oriented { point_m: place.point_m, tangent: place.tangent }
    };
    for section in thickness_along(&outline.profiles(), &along, &[0.05, 0.3, 0.5, 0.77, 0.95]).into_iter().map(Option::unwrap) {
        let half = 0.6e-3 - 0.3e-3 * section.u;
        assert!(section.sides_m.iter().all(|side| (side - half).abs() < 1.1e-9), "{section:?}");
    }
    assert_eq!(outline.regions[0].outer.tags.len(), 4);
}

#[test]
fn a_fillet_needs_its_length_of_edge() {
    let network = |fillet: f64| Network {
        nodes: vec![node([3.2, 6.0], 0.0)],
        blocks: vec![pad([-4.0, -2.0], [4.0, 0.0], fillet)],
        strips: vec![straight([3.2, 0.0], [3.2, 6.0], 0.5, [Joint::Block(0), Joint::Node(0)])],
    };
    sound(&network(0.29).outline(1e-6).unwrap());
    let error = network(0.5).outline(1e-6).unwrap_err();
    let OutlineError::Fillet { joint: Joint::Block(0), largest_m, .. } = error else { panic!("{error}") };
    close(largest_m, 0.3, 1e-6);
}

#[test]
fn a_straight_taper_has_straight_sides() {
    let mut strip = straight([0.0, 0.0], [8.0, 0.0], 1.0, [Joint::Node(0), Joint::Node(1)]);
    strip.half_width = HalfWidth::Linear(vec![[0.0, 1.0], [0.25, 0.5], [1.0, 0.8]]);
    let network = Network { nodes: vec![node([0.0, 0.0], 0.0), node([8.0, 0.0], 0.0)], blocks: Vec::new(), strips: vec![strip] };
    let outline = network.outline(1e-6).unwrap();
    sound(&outline);
    close(outline.area_m2(), 2.0 * (0.75 * 2.0 + 0.65 * 6.0), 1e-13);
    assert_eq!(outline.regions[0].outer.tags.len(), 6);
}

/// Between two arms of a rigid body that leave one point, the fillet lies before the border.
#[test]
fn strips_from_one_point_of_an_edge_meet_before_it() {
    let far = |angle: f64| [10.0 * maths::cos(angle), 10.0 * maths::sin(angle)];
    let (a, b) = (FRAC_PI_2 - 0.3, FRAC_PI_2 + 0.3);
    let network = Network {
        nodes: vec![node(far(a), 0.0), node(far(b), 0.0)],
        blocks: vec![pad([-5.0, -2.0], [5.0, 0.0], 0.2)],
        strips: vec![
            straight([0.0, 0.0], far(a), 0.4, [Joint::Block(0), Joint::Node(0)]),
            straight([0.0, 0.0], far(b), 0.4, [Joint::Block(0), Joint::Node(1)]),
        ],
    };
    let outline = network.outline(1e-6).unwrap();
    sound(&outline);
    let slant = fillet_area(0.2, a);
    // each strip from the edge on, less their overlap above the edge: half the kite of the crossing sides, cut by the edge
    let overlap = overlap_above(0.4, 0.3);
    close(outline.area_m2(), 20.0 + 2.0 * 8.0 - overlap + fillet_area(0.2, 0.6) + 2.0 * slant, 1e-12);
}

/// Overlap above the edge of two strips of a half width that leave a point of it at ± an angle from its normal.
fn overlap_above(half: f64, lean: f64) -> f64 {
    // Both strips hold |x| ≤ half/cos − y tan (the nearer one of the two sides), which is a triangle over the edge.
    let (base, slope) = (half / maths::cos(lean), maths::tan(lean));
    base * base / slope
}

#[test]
fn several_strips_on_one_edge_share_it() {
    let strips = [-2.0, 0.0, 2.0].iter().zip(0..).map(|(x, k)| straight([*x, 0.0], [*x, 6.0], 0.25, [Joint::Block(0), Joint::Node(k)]));
    let network = |fillet: f64| Network {
        nodes: [-2.0, 0.0, 2.0].iter().map(|x| node([*x, 6.0], 0.0)).collect(),
        blocks: vec![pad([-4.0, -2.0], [4.0, 0.0], fillet)],
        strips: strips.clone().collect(),
    };
    let outline = network(0.75).outline(1e-6).unwrap();
    sound(&outline);
    close(outline.area_m2(), 16.0 + 9.0 + 6.0 * (1.0 - 0.25 * PI) * 0.5625, 1e-12);
    // two fillets share 1.5 between neighbours
    let error = network(0.8).outline(1e-6).unwrap_err();
    let OutlineError::Fillet { joint, radius_m, largest_m, .. } = error else { panic!("{error}") };
    assert_eq!((joint, radius_m), (Joint::Block(0), 0.8));
    close(largest_m, 0.75, 1e-6);
}

#[test]
fn a_fillet_that_does_not_fit_names_the_largest() {
    // It touches the sides (h + r)/tan(θ/2) from the node.
    let (opening, half, length) = (0.2, 0.3, 10.0);
    let error = star(&[0.0, opening], length, half, 1.0).outline(1e-6).unwrap_err();
    let OutlineError::Fillet { joint, largest_m, strips, .. } = error else { panic!("{error}") };
    assert_eq!((joint, strips), (Joint::Node(0), [0, 1]));
    close(largest_m, length * maths::tan(0.5 * opening) - half, 1e-6);
    // The fillets of a triangle run into each other along its sides.
    let corners = [[0.0, 0.0], [4.0, 0.0], [2.0, 12.0_f64.sqrt()]];
    let triangle = |fillet: f64| Network {
        nodes: corners.iter().map(|corner| node(*corner, fillet)).collect(),
        blocks: Vec::new(),
        strips: (0..3).map(|k| straight(corners[k], corners[(k + 1) % 3], 0.2, [Joint::Node(k), Joint::Node((k + 1) % 3)])).collect(),
    };
    // the circle inscribed in the window has radius 2/√3 − 0.2
    assert!(triangle(0.95).outline(1e-6).is_ok());
    assert!(matches!(triangle(0.96).outline(1e-6), Err(OutlineError::Fillet { .. })));
}

#[test]
fn nonsense_is_refused() {
    let good = || star(&[0.0, 2.0], 5.0, 0.2, 0.1);
    let error = |change: &dyn Fn(&mut Network)| {
        let mut network = good();
        change(&mut network);
        network.outline(1e-6).unwrap_err()
    };
    assert_eq!(
        error(&|n| {
            n.strips.clear();
            n.nodes.clear();
        }),
        OutlineError::Empty
    );
    assert!(matches!(error(&|n| n.strips[0].ends[1] = Joint::Node(9)), OutlineError::NoJoint { strip: 0, .. }));
    assert!(matches!(error(&|n| n.strips[0].ends[1] = Joint::Block(0)), OutlineError::NoJoint { strip: 0, .. }));
    assert!(matches!(error(&|n| n.nodes[1].point_m[0] += 1e-3), OutlineError::NotAtNode { strip: 0, node: 1, .. }));
    assert!(matches!(error(&|n| n.nodes[1].point_m[0] = f64::NAN), OutlineError::Number { .. }));
    assert!(matches!(error(&|n| n.nodes[0].fillet_m = -1.0), OutlineError::Number { .. }));
    assert!(matches!(error(&|n| n.nodes.push(node([9.0, 9.0], 0.1))), OutlineError::LooseNode { node: 3 }));
    assert!(matches!(error(&|n| n.strips[1].length_m = f64::INFINITY), OutlineError::Strip { strip: 1, .. }));
    assert!(matches!(error(&|n| n.strips[1].half_width = HalfWidth::Constant(0.0)), OutlineError::Strip { strip: 1, .. }));
    assert!(matches!(error(&|n| n.strips[1].half_width = HalfWidth::Linear(Vec::new())), OutlineError::Strip { strip: 1, .. }));
    assert!(matches!(error(&|n| n.strips[1].half_width = HalfWidth::Linear(vec![[0.0, 1.0]])), OutlineError::Strip { strip: 1, .. }));
    let bow = vec![[8.0, 0.0], [9.0, 1.0], [9.0, 0.0], [8.0, 1.0]];
    let block = |corners_m: Vec<[f64; 2]>, corner_radius_m| Block { corners_m, corner_radius_m, fillet_m: 0.0 };
    assert_eq!(error(&|n| n.blocks.push(block(bow.clone(), 0.0))), OutlineError::Block { block: 0 });
    let square = vec![[8.0, 0.0], [9.0, 0.0], [9.0, 1.0], [8.0, 1.0]];
    assert_eq!(error(&|n| n.blocks.push(block(square.clone(), 0.51))), OutlineError::Block { block: 0 });
    assert!(matches!(good().outline(0.0), Err(OutlineError::Fit(_))));
    let tight = Network {
        nodes: vec![node([1.0, 0.0], 0.0), node([-1.0, 0.0], 0.0)],
        blocks: Vec::new(),
        strips: vec![circular([0.0, 0.0], 1.0, 0.0, PI, 1.1, [Joint::Node(0), Joint::Node(1)])],
    };
    assert!(matches!(tight.outline(1e-6), Err(OutlineError::TightBend { strip: 0, .. })));
    let apart = Network {
        nodes: vec![node([5.0, 0.0], 0.0)],
        blocks: vec![pad([-3.0, -1.0], [-1.0, 1.0], 0.1)],
        strips: vec![straight([0.0, 0.0], [5.0, 0.0], 0.2, [Joint::Block(0), Joint::Node(0)])],
    };
    assert_eq!(apart.outline(1e-6).unwrap_err(), OutlineError::NoMeeting { strip: 0, block: 0 });
}

#[test]
fn overlaps_are_found() {
    let crossing = Network {
        nodes: [[0.0, 0.0], [10.0, 10.0], [0.0, 10.0], [10.0, 0.0]].iter().map(|point| node(*point, 0.0)).collect(),
        blocks: Vec::new(),
        strips: vec![
            straight([0.0, 0.0], [10.0, 10.0], 0.2, [Joint::Node(0), Joint::Node(1)]),
            straight([0.0, 10.0], [10.0, 0.0], 0.2, [Joint::Node(2), Joint::Node(3)]),
        ],
    };
    let error = crossing.outline(1e-6).unwrap_err();
    let OutlineError::Overlap { tags, at_m } = error else { panic!("{error}") };
    assert!(matches!(tags, [Tag::Side { strip: 0, .. }, Tag::Side { strip: 1, .. }]));
    assert!((at_m[0] - 5.0).abs() < 0.5 && (at_m[1] - 5.0).abs() < 0.5);
    // a block wholly in another one
    let nested =
        Network { nodes: Vec::new(), blocks: vec![pad([0.0, 0.0], [4.0, 4.0], 0.0), pad([1.0, 1.0], [2.0, 2.0], 0.0)], strips: Vec::new() };
    assert!(matches!(nested.outline(1e-6), Err(OutlineError::Overlap { .. })));
}

/// Distance of a point from an axis, by a search of its own.
fn distance_from(axis: &Intrinsic, point: [f64; 2]) -> f64 {
    let far = |u: f64| {
        let p = axis.point(u);
        maths::hypot(p[0] - point[0], p[1] - point[1])
    };
    let nearest = (0..=40).map(|k| f64::from(k) / 40.0).min_by(|a, b| far(*a).total_cmp(&far(*b))).expect("41 places");
    roots::minimise(far, (nearest - 0.025).max(0.0), (nearest + 0.025).min(1.0), 1e-10).value.min(far(0.0)).min(far(1.0))
}

/// Largest deviation of the sides of a strip from half its width, and the number of segments and spans per side.
fn deviation(outline: &Outline, strip: usize, axis: &Intrinsic, half_m: f64) -> (f64, Vec<usize>) {
    let mut worst: f64 = 0.0;
    let mut spans = Vec::new();
    for boundary in outline.boundaries() {
        for (segment, tag) in boundary.profile.segments.iter().zip(&boundary.tags) {
            let (Tag::Side { strip: of, .. }, Segment::Spline(spline)) = (tag, segment) else { continue };
            if *of != strip {
                continue;
            }
            spans.push(spline.control_m.len() - 3);
            for k in 0..=200 {
                let point = spline.point_m(f64::from(k) / 200.0);
                worst = worst.max((distance_from(axis, point) - half_m).abs());
            }
        }
    }
    (worst, spans)
}

#[test]
fn sides_of_the_paper_are_at_half_the_width() {
    let outline = lan_half(0.5e-3).outline(TOLERANCE_M).unwrap();
    sound(&outline);
    assert_eq!((outline.regions.len(), windows(&outline)), (1, 0));
    assert!(outline.fit_error_m <= TOLERANCE_M && outline.fit_error_m > 0.0);
    for (strip, axis) in lan_beams().iter().enumerate() {
        let (worst, spans) = deviation(&outline, strip, axis, 0.5e-3);
        assert!(worst <= 1.02 * TOLERANCE_M, "strip {strip}: {worst}");
        assert_eq!(spans.len(), 2, "one spline per side");
        assert!(spans.iter().all(|spans| *spans <= 12), "strip {strip}: {spans:?}");
    }
    let sides = outline.boundaries().flat_map(|boundary| &boundary.tags).filter(|tag| matches!(tag, Tag::Side { .. })).count();
    // one of them goes on straight to the pad that it meets at a slant
    assert_eq!(sides, 9);
    // Beams of constant width have the area width times length, whatever their shape; what the joints add is small.
    let beams: f64 = lan_beams().iter().map(|beam| beam.length_m * 1e-3).sum();
    let rest = outline.area_m2() - beams - 3.0 * 80e-6;
    assert!(rest.abs() < 2e-6, "{rest}");
}

#[test]
fn sides_of_an_euler_spiral_are_at_half_the_width() {
    let spiral = Intrinsic { start_m: [0.0, 0.0], angle_rad: vec![0.0, 0.0, 2.5], length_m: 0.05 };
    let network = Network {
        nodes: vec![node([0.0, 0.0], 0.0), node(spiral.point(1.0), 0.0)],
        blocks: Vec::new(),
        strips: vec![spiral.strip(1e-3, [Joint::Node(0), Joint::Node(1)])],
    };
    let mut before = usize::MAX;
    for tolerance_m in [1e-9, 1e-8, 1e-6] {
        let outline = network.outline(tolerance_m).unwrap();
        let (worst, spans) = deviation(&outline, 0, &spiral, 1e-3);
        assert!(worst <= 1.02 * tolerance_m, "{worst}");
        assert!(spans[0] < before);
        before = spans[0];
        assert!((outline.area_m2() - 2e-3 * 0.05).abs() < 0.1 * tolerance_m);
    }
}

/// The whole mechanism: both halves, mirrored, on common pads.
#[test]
fn both_halves_on_common_pads_enclose_windows() {
    let half = lan_half(0.5e-3);
    let beams = lan_beams();
    let mirrored = |beam: &Intrinsic| Intrinsic {
        start_m: [-beam.start_m[0], beam.start_m[1]],
        angle_rad: beam.angle_rad.iter().enumerate().map(|(k, c)| if k == 0 { PI - c } else { -c }).collect(),
        length_m: beam.length_m,
    };
    let base = pad([-45e-3, -8e-3], [45e-3, 0.0], 0.5e-3);
    let top = pad([-5e-3, 40e-3], [5e-3, 48e-3], 0.5e-3);
    let mut nodes = half.nodes.clone();
    nodes.extend(half.nodes.iter().map(|one| Node { point_m: [-one.point_m[0], one.point_m[1]], ..*one }));
    let ends = |first: usize| {
        [
            [Joint::Block(0), Joint::Node(first)],
            [Joint::Block(0), Joint::Node(first)],
            [Joint::Node(first), Joint::Node(first + 1)],
            [Joint::Node(first + 1), Joint::Block(1)],
        ]
    };
    let mut strips: Vec<Strip> = beams.iter().zip(ends(0)).map(|(beam, ends)| beam.strip(0.5e-3, ends)).collect();
    strips.extend(beams.iter().zip(ends(2)).map(|(beam, ends)| mirrored(beam).strip(0.5e-3, ends)));
    let whole = Network { nodes, blocks: vec![base, top], strips }.outline(TOLERANCE_M).unwrap();
    sound(&whole);
    // eight strips, four nodes and two blocks
    assert_eq!((whole.regions.len(), windows(&whole)), (1, 8 - 6 + 1));
    // its own mirror image
    let mirror = Motion::mirror([0.0, 0.0], [0.0, 1.0]);
    let image: f64 = whole.profiles().iter().map(|profile| profile.transformed(&mirror).area_m2()).sum();
    close(image, whole.area_m2(), 1e-13);
    let mut areas: Vec<f64> = whole.regions[0].windows.iter().map(|window| window.profile.area_m2()).collect();
    areas.sort_by(f64::total_cmp);
    assert!(areas.windows(2).any(|pair| (pair[0] - pair[1]).abs() < 1e-10), "{areas:?}");
}

/// The outline does not depend on where the part lies, which way round it is, or how large it is.
#[test]
fn moved_mirrored_and_scaled_networks_have_the_same_outline() {
    let place = |beam: &Intrinsic, turn: f64, mirrored: bool, scale: f64| {
        let sign = if mirrored { -1.0 } else { 1.0 };
        let (sin, cos) = maths::sin_cos(turn);
        let [x, y] = [beam.start_m[0] * scale, sign * beam.start_m[1] * scale];
        let angle_rad = beam.angle_rad.iter().enumerate().map(|(k, c)| if k == 0 { sign * c + turn } else { sign * c }).collect();
        Intrinsic { start_m: [cos * x - sin * y + 0.3, sin * x + cos * y - 0.2], angle_rad, length_m: scale * beam.length_m }
    };
    let star = |turn: f64, mirrored: bool, scale: f64| {
        let beams: Vec<Intrinsic> = [
            lan_beams()[2].clone(),
            Intrinsic { angle_rad: vec![1.0, -1.5, 0.4], ..lan_beams()[2].clone() },
            Intrinsic { angle_rad: vec![3.6, 0.5], ..lan_beams()[2].clone() },
        ]
        .iter()
        .map(|beam| place(beam, turn, mirrored, scale))
        .collect();
        let mut nodes = vec![node(beams[0].start_m, 0.4e-3 * scale)];
        nodes.extend(beams.iter().map(|beam| node(beam.point(1.0), 0.0)));
        let strips = beams.iter().enumerate().map(|(k, beam)| beam.strip(0.5e-3 * scale, [Joint::Node(0), Joint::Node(k + 1)])).collect();
        Network { nodes, blocks: Vec::new(), strips }.outline(TOLERANCE_M * scale).unwrap()
    };
    let reference = star(0.0, false, 1.0);
    sound(&reference);
    for (turn, mirrored, scale) in [(1.1, false, 1.0), (-2.5, true, 1.0), (0.4, false, 1000.0), (0.0, true, 1e-3)] {
        let other = star(turn, mirrored, scale);
        close(other.area_m2(), reference.area_m2() * scale * scale, 1e-8);
        let count = |outline: &Outline| outline.boundaries().map(|boundary| boundary.tags.len()).sum::<usize>();
        assert_eq!(count(&other), count(&reference));
        let length = |outline: &Outline| outline.boundaries().map(|boundary| boundary.profile.length_m()).sum::<f64>();
        close(length(&other), length(&reference) * scale, 1e-6);
    }
}

#[test]
fn almost_collinear_strips_are_joined_smoothly() {
    for bend in [0.0, 1e-13, 1e-9, 1e-6, 1e-3, -1e-13, -1e-9, -1e-6, -1e-3] {
        let directions = [0.7, 0.7 + PI + bend];
        let outline = star(&directions, 5.0, 0.25, 0.5).outline(1e-6).unwrap();
        outline.regions[0].outer.profile.check(1e-9).unwrap();
        close(outline.area_m2(), star_area(&directions, 5.0, 0.25, 0.5), 1e-10);
    }
}

#[test]
fn sides_are_named_by_the_direction_of_the_axis() {
    let outline = star(&[0.0], 5.0, 0.5, 0.0).outline(1e-6).unwrap();
    let outer = &outline.regions[0].outer;
    let right = outer.tags.iter().position(|tag| *tag == Tag::Side { strip: 0, side: Side::Right }).unwrap();
    let [x, y] = outer.profile.segments[right].end_m();
    close(x, 5.0, 1e-15);
    close(y, -0.5, 1e-15);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Any star of straight strips that are not too near each other has the area of its sectors.
    #[test]
    fn stars_have_the_area_of_their_sectors(
        first in -3.0..3.0_f64,
        openings in prop::collection::vec(0.3..2.8_f64, 1..5),
        fillet in 0.0..0.5_f64,
    ) {
        let mut directions = vec![first];
        for opening in openings {
            directions.push(directions[directions.len() - 1] + opening);
        }
        prop_assume!(directions[directions.len() - 1] - first < TAU - 0.3);
        let outline = star(&directions, 8.0, 0.2, fillet).outline(1e-6).unwrap();
        let expected = star_area(&directions, 8.0, 0.2, fillet);
        prop_assert!((outline.area_m2() - expected).abs() < 1e-10 * expected);
        prop_assert!(outline.regions[0].outer.profile.check(1e-9).is_ok());
    }

    /// Nothing panics, whatever the numbers.
    #[test]
    fn random_networks_give_outlines_or_errors(
        points in prop::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64), 3..6),
        half in 0.01..1.5_f64,
        fillet in 0.0..1.0_f64,
        ends in prop::collection::vec((0..6_usize, 0..6_usize), 1..6),
    ) {
        let count = points.len();
        let points: Vec<[f64; 2]> = points.into_iter().map(|(x, y)| [x, y]).collect();
        let strips: Vec<Strip> = ends
            .iter()
            .map(|(a, b)| [a % count, b % count])
            .filter(|[a, b]| a != b)
            .map(|[a, b]| straight(points[a], points[b], half, [Joint::Node(a), if b == 0 { Joint::Block(0) } else { Joint::Node(b) }]))
            .collect();
        let corner = points[0];
        let blocks = vec![pad([corner[0] - 1.0, corner[1] - 1.0], [corner[0] + 1.0, corner[1] + 1.0], fillet)];
        let nodes = points.iter().map(|point| node(*point, fillet)).collect();
        if let Ok(outline) = (Network { nodes, blocks, strips }).outline(1e-5) {
            prop_assert!(outline.area_m2() > 0.0);
        }
    }
}
