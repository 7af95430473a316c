//! Walls, gaps and sections against closed forms.

mod common;

use std::f64::consts::{FRAC_PI_2, PI};

use common::{lan_beams, lan_half, node, pad, star, straight};
use forcewright_base::maths;
use forcewright_curves::fit::Oriented;
use forcewright_curves::outline::{Joint, Network};
use forcewright_curves::walls::{narrowest_gap, thickness_along, thinnest_wall, unreachable};
use forcewright_curves::{Motion, Profile};

#[test]
fn the_wall_of_a_plate_is_its_shorter_side() {
    let plate = Profile::polygon(&[[0.0, 0.0], [7.0, 0.0], [7.0, 2.0], [0.0, 2.0]]);
    for turn in [0.0, 0.3, 2.0] {
        let moved = plate.transformed(&Motion::new(turn, [3.0, -1.0]));
        let wall = thinnest_wall(std::slice::from_ref(&moved)).unwrap();
        assert!((wall.width_m - 2.0).abs() < 1e-12);
        assert!(narrowest_gap(&[moved]).is_none());
    }
}

#[test]
fn a_ring_is_thinnest_where_its_hole_is_nearest() {
    let ring = [Profile::circle([0.0, 0.0], 5.0), Profile::circle([1.5, 0.0], 2.0).reversed()];
    let wall = thinnest_wall(&ring).unwrap();
    assert!((wall.width_m - 1.5).abs() < 1e-9, "{}", wall.width_m);
    assert_ne!(wall.places[0].profile, wall.places[1].profile);
    // the hole itself is the only gap
    let gap = narrowest_gap(&ring).unwrap();
    assert!((gap.width_m - 4.0).abs() < 1e-9, "{}", gap.width_m);
}

#[test]
fn the_wall_of_a_strip_is_its_width() {
    let outline = lan_half(0.5e-3).outline(1e-9).unwrap();
    let wall = thinnest_wall(&outline.profiles()).unwrap();
    assert!((wall.width_m - 1e-3).abs() < 5e-9, "{}", wall.width_m);
    // between its hooks the narrowest place is a fillet in a sharp corner, twice its radius wide
    let gap = narrowest_gap(&outline.profiles()).unwrap();
    assert!((gap.width_m - 1e-3).abs() < 1e-8, "{}", gap.width_m);
}

/// A wedge is thinnest where the circle between its sides still touches its end: of half width h at the end and slope s, r = (h + s·r)·cos.
/// A corner of 90°, of which every circle is cut by the end, is no wall.
#[test]
fn a_wedge_is_thinnest_before_its_end() {
    let wedge = Profile::polygon(&[[0.0, -0.3], [60.0, -0.15], [60.0, 0.15], [0.0, 0.3]]);
    let slope = 0.15 / 60.0;
    let cos = 1.0 / maths::hypot(1.0, slope);
    let radius = 0.15 * cos / (1.0 - slope * cos);
    let found = thinnest_wall(&[wedge]).expect("a wall").width_m;
    assert!((found / (2.0 * radius) - 1.0).abs() < 2e-4, "{found} {}", 2.0 * radius);
}

#[test]
fn a_slot_between_strips_is_the_gap() {
    let (half, pitch) = (0.3, 1.5);
    let network = Network {
        nodes: vec![node([0.0, 8.0], 0.0), node([pitch, 8.0], 0.0)],
        blocks: vec![pad([-3.0, -2.0], [4.0, 0.0], 0.2)],
        strips: vec![
            straight([0.0, 0.0], [0.0, 8.0], half, [Joint::Block(0), Joint::Node(0)]),
            straight([pitch, 0.0], [pitch, 8.0], half, [Joint::Block(0), Joint::Node(1)]),
        ],
    };
    let profiles = network.outline(1e-6).unwrap().profiles();
    let gap = narrowest_gap(&profiles).unwrap();
    assert!((gap.width_m - (pitch - 2.0 * half)).abs() < 1e-12);
    let wall = thinnest_wall(&profiles).unwrap();
    assert!((wall.width_m - 2.0 * half).abs() < 1e-12);
}

/// Two posts that point at each other with sharp corners.
#[test]
fn corners_that_face_each_other_leave_a_gap() {
    let diamond = |x: f64| Profile::polygon(&[[x - 1.0, 0.0], [x, -1.0], [x + 1.0, 0.0], [x, 1.0]]);
    let gap = narrowest_gap(&[diamond(0.0), diamond(2.25)]).unwrap();
    assert!((gap.width_m - 0.25).abs() < 1e-6, "{}", gap.width_m);
}

#[test]
fn a_cutter_reaches_what_its_radius_allows() {
    let profiles = star(&[0.0, FRAC_PI_2, PI], 6.0, 0.3, 0.5).outline(1e-6).unwrap().profiles();
    assert!(unreachable(&profiles, 0.5).is_empty());
    let missed = unreachable(&profiles, 0.6);
    assert_eq!(missed.len(), 2, "both fillets");
    assert!(missed.iter().all(|one| (one.radius_m - 0.5).abs() < 1e-9));
    // sharp re-entrant corners are reached by none
    let sharp = star(&[0.0, FRAC_PI_2, PI], 6.0, 0.3, 0.0).outline(1e-6).unwrap().profiles();
    let corners = unreachable(&sharp, 0.1).iter().filter(|one| one.radius_m == 0.0).count();
    assert_eq!(corners, 2);
    // a slot narrower than the cutter
    let slot = [
        Profile::polygon(&[[0.0, 0.0], [9.0, 0.0], [9.0, 3.0], [0.0, 3.0]]),
        Profile::polygon(&[[10.0, 0.0], [19.0, 0.0], [19.0, 3.0], [10.0, 3.0]]),
    ];
    assert!(unreachable(&slot, 0.49).is_empty());
    assert_eq!(unreachable(&slot, 0.51).len(), 2);
}

#[test]
fn the_thickness_of_the_beams_is_measured_back() {
    let tolerance = 1e-8;
    let profiles = lan_half(0.5e-3).outline(tolerance).unwrap().profiles();
    let places: Vec<f64> = (0..=30).map(|k| 0.2 + 0.02 * f64::from(k)).collect();
    for beam in lan_beams() {
        let axis = |u: f64| {
            let place = beam.at(u);
            Oriented { point_m: place.point_m, tangent: place.tangent }
        };
        for section in thickness_along(&profiles, &axis, &places) {
            let section = section.unwrap();
            assert!((section.thickness_m() - 1e-3).abs() < 2.0 * tolerance, "{section:?}");
            assert!((section.sides_m[0] - 0.5e-3).abs() < 1.1 * tolerance, "{section:?}");
        }
    }
    let outside = |u: f64| Oriented { point_m: [0.1 + u, 0.0], tangent: [1.0, 0.0] };
    assert!(thickness_along(&profiles, &outside, &[0.0, 1.0]).iter().all(Option::is_none));
}

/// A taper is as thick as it was made, and thinnest at its thin end.
#[test]
fn a_taper_is_measured_place_by_place() {
    let mut strip = straight([0.0, 0.0], [10.0, 0.0], 1.0, [Joint::Node(0), Joint::Node(1)]);
    strip.half_width = forcewright_curves::outline::HalfWidth::Linear(vec![[0.0, 1.0], [0.5, 0.4], [1.0, 0.8]]);
    let network = Network { nodes: vec![node([0.0, 0.0], 0.0), node([10.0, 0.0], 0.0)], blocks: Vec::new(), strips: vec![strip] };
    let profiles = network.outline(1e-6).unwrap().profiles();
    let axis = |u: f64| Oriented { point_m: [10.0 * u, 0.0], tangent: [1.0, 0.0] };
    for (u, expected) in [(0.25, 1.4), (0.5, 0.8), (0.75, 1.2)] {
        let section = thickness_along(&profiles, &axis, &[u])[0].unwrap();
        assert!((section.thickness_m() - expected).abs() < 1e-12, "{u}");
    }
    let wall = thinnest_wall(&profiles).unwrap();
    // the waist is a corner on either side; the circle between them
    assert!((wall.width_m - 0.8).abs() < 1e-6, "{}", wall.width_m);
    assert!(maths::hypot(wall.at_m[0][0] - 5.0, 0.0) < 1e-3);
}
