//! Clearance and envelope: closed forms, and the travel against a dense scan.

mod common;
#[path = "common/drawing.rs"]
mod drawing;

use common::{NODES, check, close, outcome, solve, understand};
use drawing::Drawing;
use forcewright_beam::{Reflection, clearance};
use forcewright_compliant::Compliant;
use forcewright_contract::family::Mechanism;
use forcewright_model::{CheckState, FigureContent, Item, Role};

#[test]
fn the_least_over_the_travel_is_found() {
    let line = Reflection { point_m: [0.0, 0.0], direction: [0.0, 1.0] };
    for set in [&[][..], &["load.travel=20 mm"], &["design.nodes.n4.at=[\"14 mm\", \"27 mm\"]", "load.travel=17 mm"]] {
        let solved = solve(NODES, set);
        let end = solved.design.load_end;
        let scan = (0..=200).map(|i| {
            let point = solved.behaviour.path.at(end * f64::from(i) / 200.0).unwrap();
            clearance(&solved.design.network, Some(&point), &[line.into()]).unwrap().distance_m
        });
        let least = scan.fold(f64::INFINITY, f64::min);
        let found = solved.get("clearance_min");
        // Between two states of the scan it may be a little less.
        assert!(found <= least + 1e-9 && found > least - 2e-5, "{set:?}: {found}, by scanning {least}");
    }
}

/// Two beams one above the other, 10 mm apart, clamped at the left; the tip of the upper one is pushed down.
fn stacked(travel: &str) -> String {
    let mut drawing = Drawing::straight("", [0.0, -1.0], travel, "reissner");
    drawing.nodes[1].1 = [80.0, 0.0];
    drawing.nodes.push(("n3", [0.0, -10.0], "support = \"clamped\"".to_owned()));
    drawing.nodes.push(("n4", [100.0, -10.0], String::new()));
    drawing.beams.push(("b2", ["n3", "n4"], Vec::new()));
    drawing.text()
}

#[test]
fn a_tip_comes_nearer_to_the_next_beam() {
    // The tip goes straight down by the travel; the thickness of both is 1 mm.
    for (travel, wanted) in [("5 mm", 4e-3), ("9.5 mm", -0.5e-3), ("20 mm", -1e-3)] {
        let solved = solve(&stacked(travel), &[]);
        close(solved.get("clearance_min"), wanted, 1e-8, travel);
        let nearest = solved.measured.nearest.unwrap();
        assert_eq!((nearest.clearance.first.beam, nearest.clearance.second.beam), (0, 1));
    }
    let limit = |set: &str| check(&outcome(&stacked("5 mm"), &[set]), "COMP006").state;
    assert_eq!(limit("requirements.limits.clearance_min.min=3.9 mm"), CheckState::Met);
    assert_eq!(limit("requirements.limits.clearance_min.min=4.1 mm"), CheckState::Missed);
}

#[test]
fn a_beam_alone_has_no_clearance() {
    let text = Drawing::straight("", [0.0, -1.0], "5 mm", "reissner").text();
    let result = outcome(&text, &["requirements.limits.clearance_min.min=1 mm"]);
    let open = check(&result, "COMP006");
    assert!(open.state == CheckState::NotAssessed && open.advice.as_ref().unwrap().contains("face each other"), "{open:?}");
}

/// A cantilever of 100 mm along x with an envelope.
fn boxed(envelope: &str, travel: &str) -> String {
    Drawing::straight("", [0.0, -1.0], travel, "reissner")
        .text()
        .replace("[material]", &format!("[requirements.envelope]\n{envelope}\n[material]"))
}

#[test]
fn distance_to_each_side() {
    let margin = |envelope: &str, travel: &str| solve(&boxed(envelope, travel), &[]).get("envelope_margin");
    close(margin("y = [\"-20 mm\", \"3 mm\"]", "1 mm"), 2.5e-3, 1e-12, "above, at rest, less half the thickness");
    close(margin("x = [\"-7 mm\", \"200 mm\"]", "1 mm"), 6.5e-3, 1e-12, "behind the clamp, where the end is round");
    close(margin("x = [\"0 mm\", \"200 mm\"]\ny = [\"-30 mm\", \"30 mm\"]", "1 mm"), -0.5e-3, 1e-12, "clamped to the wall");
    close(margin("x = [\"-7 mm\", \"99 mm\"]", "1 mm"), -1.5e-3, 1e-9, "too long, at rest: it comes back when pushed");
    // The tip when pushed down.
    let solved = solve(&boxed("y = [\"-12 mm\", \"9 mm\"]", "10 mm"), &[]);
    let tip = &solved.behaviour.path.points.last().unwrap().beams[0];
    close(solved.get("envelope_margin"), 12e-3 - 10e-3 - 0.5e-3, 1e-9, "below, pushed");
    close(tip.shape_m(1.0)[1], -10e-3, 1e-9, "the tip");
}

/// A wall that is a beam, and a wall that is a side of the envelope, at the same place: the same distance, to all sides of an end.
#[test]
fn clearance_and_envelope_follow_one_rule() {
    for (tip, wall, side) in [
        ([40.0, 0.0], [[45.0, -30.0], [45.0, 30.0]], "x = [\"-20 mm\", \"45 mm\"]"),
        ([28.0, 28.0], [[34.0, -30.0], [34.0, 60.0]], "x = [\"-20 mm\", \"34 mm\"]"),
        ([5.0, 30.0], [[-30.0, 33.0], [30.0, 33.0]], "y = [\"-20 mm\", \"33 mm\"]"),
    ] {
        let mut drawing = Drawing::straight("", [1.0, -1.0], "0.01 mm", "reissner");
        drawing.nodes[1].1 = tip;
        let alone = drawing.text().replace("[material]", &format!("[requirements.envelope]\n{side}\n[material]"));
        drawing.nodes.extend([("w1", wall[0], "support = \"clamped\"".to_owned()), ("w2", wall[1], "support = \"clamped\"".to_owned())]);
        drawing.beams.push(("wall", ["w1", "w2"], Vec::new()));
        // The wall has a thickness of its own, the side has none.
        let clearance = solve(&drawing.text(), &[]).get("clearance_min") + 0.5e-3;
        close(solve(&alone, &[]).get("envelope_margin"), clearance, 2e-6, side);
    }
}

#[test]
fn the_check_and_the_picture() {
    let met = outcome(&boxed("y = [\"-12 mm\", \"9 mm\"]", "10 mm"), &[]);
    let check_met = check(&met, "COMP007");
    assert!(check_met.state == CheckState::Met && check_met.title.contains("beam b1"), "{check_met:?}");
    close(check_met.margin.unwrap(), check_met.value.unwrap() / 21e-3, 1e-12, "relative to the height");
    let missed = outcome(&boxed("y = [\"-10 mm\", \"9 mm\"]", "10 mm"), &[]);
    assert_eq!(check(&missed, "COMP007").state, CheckState::Missed);
    assert!(!outcome(NODES, &[]).checks.iter().any(|c| c.code == "COMP007"), "nobody asked");
    let text = boxed("x = [\"-1 mm\", \"200 mm\"]\ny = [\"-12 mm\", \"9 mm\"]", "10 mm");
    let design = common::design(&text, &[]);
    let figures = Compliant::analyse(&design, &mut |_| true).figures;
    let drawn = figures.iter().any(|f| match &f.content {
        FigureContent::Scene(scene) => scene
            .items
            .iter()
            .any(|i| matches!(i, Item::Line { points, role: Role::Envelope, .. } if points.len() == 5 && (points[2][0] - 0.2).abs() + (points[2][1] - 9e-3).abs() < 1e-12)),
        _ => false,
    });
    assert!(drawn, "the envelope is in the picture");
}

#[test]
fn what_is_wrong_with_an_envelope() {
    for (envelope, code) in [
        ("", "E0302"),
        ("x = [\"3 mm\", \"2 mm\"]", "E0204"),
        ("x = [\"3 mm\", \"3 mm\"]", "E0204"),
        ("x = [\"3 mm\"]", "E0311"),
        ("z = [\"3 mm\", \"4 mm\"]", "E0301"),
        ("x = [\"3 N\", \"4 N\"]", "E0201"),
    ] {
        let (design, diagnostics) = understand(&boxed(envelope, "1 mm"), &[]);
        assert!(design.is_none() && diagnostics.in_file_order().iter().any(|d| d.code == code), "{envelope}: {diagnostics:?}");
    }
}

/// Copies in the plane are in the box as well: a leg from x = 0 to 100 mm, mirrored at x = 110 mm (120 mm to 220 mm), in rows above each
/// other, or with one opposite to it around an axis.
#[test]
fn an_envelope_holds_the_copies_in_the_plane() {
    let guided = |layout: &str, envelope: &str| {
        let mut drawing = Drawing::straight("", [0.0, -1.0], "1 mm", "reissner");
        drawing.nodes[1].2 = "support = \"slider\", direction = [0, 1]".to_owned();
        drawing.text().replace("[material]", &format!("[requirements.envelope]\n{envelope}\n[material]")) + layout
    };
    let margin = |layout: &str, envelope: &str| solve(&guided(layout, envelope), &[]).get("envelope_margin");
    let mirrored = "\n[layout]\nmirror = \"x = 110 mm\"\n";
    close(margin(mirrored, "x = [\"-7 mm\", \"230 mm\"]"), 6.5e-3, 1e-12, "the drawn half");
    close(margin(mirrored, "x = [\"-20 mm\", \"223 mm\"]"), 3e-3 - 0.5e-3, 1e-12, "the mirrored half ends at 220 mm");
    close(margin(mirrored, "of = \"drawn\"\nx = [\"-20 mm\", \"103 mm\"]"), 2.5e-3, 1e-9, "the drawn network alone");
    let rows = "\n[layout]\narray = { count = 3, spacing = \"20 mm\", direction = [0, 1] }\n";
    close(margin(rows, "y = [\"-30 mm\", \"44 mm\"]"), 3.5e-3, 1e-12, "the last of three rows");
    let around = |count: u32| format!("\n[layout]\ncircular = {{ count = {count}, radius = \"10 mm\" }}\n");
    close(margin(&around(4), "x = [\"-7 mm\", \"224 mm\"]"), 3.5e-3, 1e-12, "the leg opposite ends at 220 mm");
    close(margin(&around(3), "x = [\"-7 mm\", \"150 mm\"]"), 6.5e-3, 1e-12, "none is opposite");
}

/// A stage that comes down by its travel onto a post: what is left is the gap at rest less the travel, less half of both pads. Pads that
/// nobody has drawn are only spoken of where they are in the way.
#[test]
fn a_block_that_reaches_a_pad_is_seen() {
    let text = include_str!("../../../../examples/compliant/constant-force-pair.toml");
    let pads = |set: &[&str]| outcome(text, set).checks.into_iter().find(|c| c.code == "COMP013");
    for (pad_mm, travel_mm) in [(5.0, 5.5), (5.0, 4.0), (6.4, 5.5), (6.6, 5.5), (5.0, 7.5)] {
        let (pad, travel) = (format!("parts.pad=[\"{pad_mm} mm\", \"5 mm\"]"), format!("load.travel={travel_mm} mm"));
        let found = pads(&[&pad, &travel]).expect("pads are drawn");
        let left_m = 1e-3 * (12.0 - pad_mm - travel_mm);
        close(found.value.unwrap(), left_m, 1e-9, &format!("{pad} {travel}"));
        assert_eq!((found.required, found.state), (true, if left_m > 0.0 { CheckState::Met } else { CheckState::Missed }));
        assert!(found.title.contains("stage") && found.title.contains("post"), "{}", found.title);
    }
    let without = text.replace("[parts]", "[parts]\n#").replace("\npad", "\n#");
    let usual = outcome(&without, &[]).checks.into_iter().find(|c| c.code == "COMP013").expect("12.18 mm high pads meet");
    assert!(!usual.required && usual.state == CheckState::Missed, "{usual:?}");
    assert!(outcome(NODES, &[]).checks.iter().all(|c| c.code != "COMP013"), "nothing is in the way");
}
