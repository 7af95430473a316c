//! The parts that are made against the metrics of their room and the section that shows them: measured on the parts, not taken from formulae.

mod common;

use forcewright_base::maths::hypot;
use forcewright_contract::family::Mechanism as _;
use forcewright_lavt::{Behaviour, Design, Lavt, measure};
use forcewright_model::{Body, FigureContent, Item, Part, PartSet, Role, Scene, Section};

use common::design;

const EXAMPLES: [&str; 3] = [
    include_str!("../../../../examples/lavt/butin-2.toml"),
    include_str!("../../../../examples/lavt/butin-3.toml"),
    include_str!("../../../../examples/lavt/prosthetic-hand.toml"),
];

/// Changes under which everything must still fit: a chassis narrower than the ring and wider than usual, other plates, a coil that hangs free,
/// no turns between hub and bore, many of them, a bore wider than the ring.
const CHANGES: [&[&str]; 7] = [
    &[],
    &["parts.chassis_diameter=27 mm"],
    &["parts.chassis_diameter=50 mm"],
    &["parts.plate_thickness=3.5 mm", "parts.ring_wall=2.2 mm"],
    &["design.spring.unsupported_turns=1.5"],
    &["design.spring.free_turns=9.3", "design.spring.bore_turns=2.4", "design.gears.face_width=7 mm"],
    &["design.hub.diameter=40.7 mm", "design.bore.diameter=42.4 mm", "design.spring.inner_diameter=39.4 mm"],
];

/// Every example with every change.
fn all() -> impl Iterator<Item = (String, Design)> {
    let each = |(text, change): (&&str, &&[&str])| (format!("{change:?}"), design(text, change));
    EXAMPLES.iter().flat_map(|text| CHANGES.iter().map(move |change| (text, change))).map(each).collect::<Vec<_>>().into_iter()
}

fn named<'a>(set: &'a PartSet, name: &str) -> &'a Part {
    set.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no part `{name}`"))
}

fn depth_m(set: &PartSet, name: &str) -> f64 {
    match &named(set, name).body {
        Body::Plate(plate) => plate.depth_m,
        Body::Turned(turned) => turned.sections.iter().map(|s| if let Section::Plain { length_m, .. } = s { *length_m } else { 0.0 }).sum(),
        Body::Coil(_) => panic!("a coil has no depth"),
    }
}

/// Largest distance of a part from its axis, m.
fn reach_m(part: &Part) -> f64 {
    match &part.body {
        Body::Plate(plate) => plate.outline.tessellate(1e-9).iter().map(|[x, y]| hypot(*x, *y)).fold(0.0, f64::max),
        Body::Turned(turned) => {
            turned.sections.iter().map(|s| if let Section::Plain { radius_m, .. } = s { *radius_m } else { 0.0 }).fold(0.0, f64::max)
        }
        Body::Coil(coil) => {
            let pieces = coil.line();
            let points = pieces.pieces().iter().flat_map(|p| (0..=50).map(|i| p.at(f64::from(i) / 50.0).point_m));
            points.map(|[x, y, _]| hypot(x, y)).fold(0.0, f64::max) + 0.5 * coil.wire_m
        }
    }
}

/// Holes of a plate by their purpose: distance from the axis and diameter, m.
fn holes(set: &PartSet, name: &str, purpose: &str) -> Vec<[f64; 2]> {
    let plate = named(set, name).plate().unwrap_or_else(|| panic!("`{name}` is no plate"));
    let wanted = plate.holes.iter().filter(|h| h.purpose.contains(purpose));
    wanted.map(|h| [hypot(h.centre_m[0], h.centre_m[1]), h.diameter_m]).collect()
}

fn section(design: &Design) -> Scene {
    let figures = Lavt::analyse(design, &mut |_| true).figures;
    let found = figures.into_iter().find(|f| f.id == "section").expect("a section");
    let FigureContent::Scene(scene) = found.content else { panic!("no scene") };
    scene
}

/// Box of everything in the section but what goes on outside: from, to along the axis, and the largest radius.
fn drawn_m(scene: &Scene) -> [f64; 3] {
    let shafts = ["sun and planet", "shaft of the output", "axis"];
    let mut found = [f64::INFINITY, f64::NEG_INFINITY, 0.0_f64];
    for item in &scene.items {
        let (Item::Body { role, .. } | Item::Disc { role, .. } | Item::Line { role, .. }) = item else { continue };
        let Role::Named(_, word) = role else { panic!("without a name") };
        let points = match item {
            _ if shafts.contains(word) => continue,
            Item::Body { corners, .. } => corners.clone(),
            Item::Disc { centre: [x, y], radius_m: r, .. } => vec![[x - r, y - r], [x + r, y + r]],
            _ => continue,
        };
        for [x, y] in points {
            found = [found[0].min(x), found[1].max(x), found[2].max(y)];
        }
    }
    found
}

fn near(ours: f64, theirs: f64, what: &str) {
    assert!((ours - theirs).abs() < 2e-6, "{what}: {ours} {theirs}");
}

#[test]
fn metrics_parts_and_section_have_one_room() {
    for (what, design) in all() {
        let behaviour = Behaviour::of(&design).expect("a transmission");
        let measured = measure(&design, &behaviour);
        let get = |name: &str| measured.get(name).unwrap_or_else(|| panic!("no {name}"));
        let set = Lavt::parts(&design).unwrap_or_else(|no| panic!("{what}: {}", no.message));
        near(2.0 * set.parts.iter().map(reach_m).fold(0.0, f64::max), get("outer_diameter"), &what);
        // The stack: the hub ends where the chassis begins, its coil a little before it; the leg ends at the side of the seat that is
        // away from the coil.
        let coil = named(&set, "spring").coil().expect("a coil");
        let top_m = coil.line().pieces().last().expect("a leg").at(1.0).point_m[2];
        let wound_m = design.built.spring.hub_turns * coil.windings[0].pitch_m[0];
        let collar_m = depth_m(&set, "hub") - wound_m - 0.5 * coil.wire_m;
        assert!(collar_m > 0.0, "{what}: the coil hangs over its hub");
        let spring_m = top_m - depth_m(&set, "ring-seat") + 0.5 * coil.wire_m + collar_m;
        let plates_m: f64 =
            ["carrier-input", "ring", "carrier-output", "ring-seat", "chassis"].iter().map(|name| depth_m(&set, name)).sum();
        near(plates_m + spring_m, get("length"), &what);
        near(depth_m(&set, "pin"), ["carrier-input", "planet", "carrier-output"].iter().map(|name| depth_m(&set, name)).sum(), &what);
        let [from_m, to_m, reach_m] = drawn_m(&section(&design));
        near(to_m - from_m, get("length"), &what);
        near(2.0 * reach_m, get("outer_diameter"), &what);
        let volume = 0.25 * std::f64::consts::PI * get("outer_diameter") * get("outer_diameter") * get("length");
        assert!((get("envelope_volume") / volume - 1.0).abs() < 1e-12);
    }
}

#[test]
fn what_is_screwed_together_has_the_same_holes() {
    for (what, design) in all() {
        let set = Lavt::parts(&design).unwrap_or_else(|no| panic!("{what}: {}", no.message));
        let planets = usize::try_from(design.built.gears.planets).expect("few");
        for (one, other, purpose, count) in [
            ("chassis", "friction-ring", "bolt", 4),
            ("ring", "ring-seat", "screw", 4),
            ("carrier-input", "carrier-output", "pin", planets),
        ] {
            let (a, b) = (holes(&set, one, purpose), holes(&set, other, purpose));
            assert!(a.len() == count && a == b, "{what}: {one} {a:?} {other} {b:?}");
        }
        // Bolts stand in the wall of the friction ring, and pins in the planets.
        let [circle_m, bolt_m] = holes(&set, "friction-ring", "bolt")[0];
        let [_, bore_m] = holes(&set, "friction-ring", "surface B")[0];
        assert!(bore_m.to_bits() == design.built.bore_m.to_bits());
        let room_m = [circle_m - 0.5 * (bolt_m + bore_m), reach_m(named(&set, "friction-ring")) - circle_m - 0.5 * bolt_m];
        assert!(room_m.iter().all(|room| *room > 0.1 * bolt_m), "{what}: {room_m:?}");
        assert!(holes(&set, "planet", "pin")[0][1].to_bits() == (2.0 * reach_m(named(&set, "pin"))).to_bits());
        // The end of the spring goes through its hole, and shaft and hub through the one in the middle.
        let coil = named(&set, "spring").coil().expect("a coil");
        let [leg_m, hole_m] = holes(&set, "ring-seat", "end of the spring")[0];
        let end = coil.line().pieces().last().expect("a leg").at(1.0).point_m;
        assert!((hypot(end[0], end[1]) - leg_m).abs() < 1e-9 && hole_m > coil.wire_m);
        assert!(holes(&set, "ring-seat", "shaft")[0][1] > holes(&set, "carrier-output", "shaft")[0][1]);
        assert!(holes(&set, "carrier-input", "sun")[0][1] > 2.0 * reach_m(named(&set, "sun")));
        // The hub's coil is wider than the bore: the friction ring ends before it, where the free turns begin to wind onto the hub.
        let turns = design.built.spring.unsupported_turns + design.built.spring.free_turns;
        let between_m = turns * coil.windings[0].pitch_m[0] + 1.5 * coil.wire_m;
        assert!(depth_m(&set, "friction-ring") <= between_m + 1e-12, "{what}");
    }
}

/// A chassis that leaves no wall for the bolts is refused, and says what would do.
#[test]
fn a_chassis_without_room_is_refused() {
    let design = design(EXAMPLES[0], &["parts.chassis_diameter=20 mm"]);
    let refused = Lavt::parts(&design).expect_err("no room");
    assert!(refused.code == "E0820" && refused.message.contains("friction ring"), "{}", refused.message);
    assert!(refused.help.contains("chassis_diameter"));
}
