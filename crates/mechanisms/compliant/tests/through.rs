//! Beams by points: the same mechanism as by bends, and what is refused.

mod common;

use common::{NODES, Random, design, near, solve, understand};

/// The text of Table 3 with another shape line for one beam.
fn with(beam: &str, shape: &str) -> String {
    let start = NODES.find(&format!("name = \"{beam}\"")).expect("the beam");
    let line = start + NODES[start..].find("bend = ").expect("its bend");
    let end = line + NODES[line..].find('\n').expect("its end");
    format!("{}{shape}{}", &NODES[..line], &NODES[end..])
}

/// Points of a beam of Table 3 at two places, as they are typed.
fn points(beam: usize, places: [f64; 2]) -> String {
    let design = design(NODES, &[]);
    let drawn = &design.network.beams[beam];
    let [x, y] = design.network.nodes[drawn.start].position_m;
    let point = |u: f64| {
        let p = drawn.shape.point_m(u);
        format!("[\"{:?} mm\", \"{:?} mm\"]", 1e3 * (x + p[0]), 1e3 * (y + p[1]))
    };
    format!("through = [{}, {}]", point(places[0]), point(places[1]))
}

#[test]
fn two_points_of_each_beam_give_the_mechanism_back() {
    let (mut random, wanted) = (Random(11), solve(NODES, &[]));
    for (beam, name) in ["b1", "b2", "b3", "b4"].into_iter().enumerate() {
        let first = random.between(0.2, 0.45);
        let text = with(name, &points(beam, [first, random.between(first + 0.2, 0.85)]));
        let found = solve(&text, &[]);
        near(found.get("force_at_end"), wanted.get("force_at_end"), 1e-9, name);
        near(found.get("stress_max"), wanted.get("stress_max"), 1e-9, name);
        near(found.design.network.beams[beam].shape.length_m(), wanted.design.network.beams[beam].shape.length_m(), 1e-11, name);
    }
}

#[test]
fn one_point_is_an_arc() {
    // Above the middle of the chord by a tenth of its length: tan(turn/4) = 0.2.
    let text = NODES.replace("at = [\"30.5 mm\", \"18.77 mm\"]", "at = [\"32.5 mm\", \"0 mm\"]");
    let arc = |shape: &str| {
        let at = text.find("bend = [1.3092, -1.5707]").unwrap();
        let text = format!("{}{shape}{}", &text[..at], &text[at + "bend = [1.3092, -1.5707]".len()..]);
        design(&text, &[]).network.beams[0].shape.clone()
    };
    let (by_point, by_angle) =
        (arc("through = [[\"17.5 mm\", \"3 mm\"]]"), arc(&format!("arc = \"{:?} rad\"", -4.0 * forcewright_base::maths::atan2(0.2, 1.0))));
    near(by_point.length_m(), by_angle.length_m(), 1e-14, "length");
    near(by_point.angle_rad()[1], by_angle.angle_rad()[1], 1e-13, "turn");
    assert_eq!(by_point.angle_rad().len(), 2);
    // None is a straight beam.
    assert_eq!(arc("through = []"), arc("straight = true"));
}

#[test]
fn a_setting_moves_a_point() {
    let text = with("b3", &points(2, [0.3, 0.7]));
    let moved = "design.beams.b3.through=[[\"25 mm\", \"23 mm\"], [\"18 mm\", \"22 mm\"]]";
    let (first, second) = (design(&text, &[]), design(&text, &[moved]));
    assert_ne!(first.network.beams[2].shape, second.network.beams[2].shape);
}

/// Code, text at the place, and part of the message or help of what is found.
#[track_caller]
fn refused(shape: &str, code: &str, place: &str, words: &str) {
    let text = with("b1", shape);
    let (design, diagnostics) = understand(&text, &[]);
    let found: Vec<_> = diagnostics.in_file_order().into_iter().filter(|d| d.code == code).collect();
    assert!(design.is_none() && found.len() == 1, "{shape}: {found:?}");
    let span = found[0].span.expect("a place");
    let help = found[0].help.clone().unwrap_or_default();
    assert_eq!(&text[span.start..span.end], place, "{shape}: {found:?}");
    assert!(found[0].message.contains(words) || help.contains(words), "{shape}: {found:?}");
}

#[test]
fn what_is_wrong_is_named_at_its_point() {
    let point = "[\"15 mm\", \"12 mm\"]";
    refused(&format!("through = [{point}, {point}]"), "E0503", point, "one of the two");
    refused("through = [[\"2.5 mm\", \"0 mm\"]]", "E0503", "[\"2.5 mm\", \"0 mm\"]", "starts at its node");
    let all = "[[\"30.5 mm\", \"18.77 mm\"]]";
    refused(&format!("through = {all}"), "E0503", all, "last point");
    let far = "[\"25 mm\", \"15 mm\"]";
    refused(&format!("through = [{far}, [\"8 mm\", \"4 mm\"]]"), "E0503", far, "in their order");
    refused(&format!("through = [{}]", [point; 9].join(", ")), "E0311", &format!("[{}]", [point; 9].join(", ")), "at most 8");
    refused("through = [[\"15 mm\"]]", "E0311", "[\"15 mm\"]", "two coordinates");
    refused("through = [[\"15 mm\", \"12 N\"]]", "E0201", "\"12 N\"", "length");
    refused("through = \"15 mm\"", "E0206", "\"15 mm\"", "points in brackets");
    refused(&format!("through = [{point}]\nstraight = true"), "E0305", &format!("[{point}]"), "exclude each other");
    refused(&format!("through = [{point}]\nlength = \"30 mm\""), "E0305", "\"30 mm\"", "follows from the nodes");
}
