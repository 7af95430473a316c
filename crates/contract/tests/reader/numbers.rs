//! Numbers by their paths.

use forcewright_base::fits::Fit;
use forcewright_base::units::{Dimension, Tolerance};
use forcewright_contract::describe::Range;
use forcewright_contract::numbers::{Number, Part};
use forcewright_contract::studies::Studies;

use crate::toy::read_text;

const TEXT: &str = r#"
schema = 1
mechanism = "toy"
[design]
thickness = "0.8 mm ± 2 %"
friction = 0.3
width = [["0", "3 mm"], ["25 %", "4 mm"], ["1", "5 mm"]]
copies = 2
[design.nodes]
a = { at = ["1 mm", "2 cm"], direction = [0, 1] }
b = { at = ["3 mm", "4 mm"], through = [["1 mm", "2 mm"], ["3 mm", "4 mm"]] }
[[design.beams]]
name = "leaf"
between = ["a", "b"]
bend = [1.5, -0.25]
pin = "1.2 mm h7"
[[load]]
travel = "3 mm"
[[load]]
travel = "5 mm"
"#;

fn numbers() -> Vec<Number> {
    let mut reading = read_text(TEXT);
    assert!(reading.found.is_empty(), "{}", reading.shown);
    reading.numbers()
}

#[test]
fn every_number_has_its_path_and_its_value() {
    let found: Vec<(String, f64, Part)> = numbers().into_iter().map(|n| (n.path, n.si, n.part)).collect();
    let wanted = [
        ("design.thickness", 0.8e-3, Part::Whole),
        // A default is a number like any other.
        ("design.depth", 10e-3, Part::Whole),
        ("design.friction", 0.3, Part::Whole),
        ("design.width.1", 3e-3, Part::AtPlace(0, 0.0)),
        ("design.width.2", 4e-3, Part::AtPlace(1, 0.25)),
        ("design.width.3", 5e-3, Part::AtPlace(2, 1.0)),
        ("design.nodes.a.at.x", 1e-3, Part::Coordinate(0)),
        ("design.nodes.a.at.y", 20e-3, Part::Coordinate(1)),
        ("design.nodes.b.at.x", 3e-3, Part::Coordinate(0)),
        ("design.nodes.b.at.y", 4e-3, Part::Coordinate(1)),
        ("design.nodes.b.through.1.x", 1e-3, Part::OfPoints(0, 0)),
        ("design.nodes.b.through.1.y", 2e-3, Part::OfPoints(0, 1)),
        ("design.nodes.b.through.2.x", 3e-3, Part::OfPoints(1, 0)),
        ("design.nodes.b.through.2.y", 4e-3, Part::OfPoints(1, 1)),
        ("design.beams.leaf.bend.1", 1.5, Part::Entry(0)),
        ("design.beams.leaf.bend.2", -0.25, Part::Entry(1)),
        ("design.beams.leaf.pin", 1.2e-3, Part::Whole),
        ("load.1.travel", 3e-3, Part::Whole),
        ("load.2.travel", 5e-3, Part::Whole),
    ];
    // What studies are told is no number of the design.
    let found: Vec<_> = found.iter().filter(|(path, ..)| !Studies::hold(path)).collect();
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for ((path, si, part), want) in found.into_iter().zip(wanted) {
        assert_eq!((path.as_str(), *part), (want.0, want.2));
        assert!((si - want.1).abs() <= 1e-15 * want.1.abs(), "{path}: {si}");
    }
}

#[test]
fn a_number_knows_its_unit_its_range_its_place_and_its_tolerance() {
    let all = numbers();
    let find = |path: &str| all.iter().find(|n| n.path == path).unwrap();
    let thickness = find("design.thickness");
    assert_eq!((thickness.unit.symbol(), thickness.dimension), ("mm", Dimension::Length));
    let Some(Tolerance::Symmetric(half)) = thickness.tolerance else { panic!("{:?}", thickness.tolerance) };
    assert!((half - 0.016e-3).abs() < 1e-18);
    let Range { min, max, above } = thickness.range;
    assert!(above && min.abs() <= 0.0 && (max - 1.0).abs() <= 0.0);
    assert_eq!(&TEXT[thickness.span.start..thickness.span.end], "\"0.8 mm ± 2 %\"");
    assert_eq!(find("design.nodes.a.at.y").unit.symbol(), "cm");
    assert_eq!(find("design.nodes.a.at.y").tolerance, None);
    assert_eq!(find("design.beams.leaf.pin").tolerance, Some(Tolerance::Fit(Fit::parse("h7").unwrap())));
}

#[test]
fn a_single_stage_and_the_same_everywhere_have_no_place() {
    let mut reading =
        read_text("schema = 1\nmechanism = \"toy\"\n[design]\nthickness = \"1 mm\"\nwidth = \"2 mm\"\n[load]\ntravel = \"3 mm\"\n");
    let paths: Vec<String> = reading.numbers().into_iter().map(|n| n.path).collect();
    for path in ["design.width", "load.travel"] {
        assert!(paths.iter().any(|p| p == path), "{path}: {paths:?}");
    }
}
