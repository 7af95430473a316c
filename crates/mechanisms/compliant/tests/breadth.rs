//! Rigid joints, tapers, parallel guides, load stages, jumps and sideways motion, from the project file to the result: closed forms,
//! the paper's prototype, and networks put together by hand for the engine.

mod common;
#[path = "common/drawing.rs"]
mod drawing;

use common::{NODES, SHAPES, close, near, outcome, solve, understand};
use drawing::{Drawing, guide};
use forcewright_base::maths;
use forcewright_beam::{Beam, Drive, Network, Node, Shape, Stage, Status, Support, trace};
use forcewright_compliant::{Compliant, Snap};
use forcewright_contract::family::Mechanism;
use forcewright_model::{FigureContent, Item, Role, StatusKind};

const GUIDED: &str = "support = \"slider\", direction = [0, 1]";

fn codes(text: &str, set: &[&str]) -> Vec<&'static str> {
    understand(text, set).1.in_file_order().iter().map(|d| d.code).collect()
}

/// Lines of the deformed network, its copy left out, that have colours, and that have none.
fn deformed(text: &str, set: &[&str]) -> [Vec<(Vec<[f64; 2]>, f64)>; 2] {
    let figures = Compliant::analyse(&common::design(text, set), &mut |_| true).figures;
    let Some(FigureContent::Scene(scene)) = figures.into_iter().next().map(|f| f.content) else { panic!("no picture") };
    let mut found = [Vec::new(), Vec::new()];
    for item in scene.items {
        if let Item::Line { points, width_m, role: Role::Deformed | Role::Rigid, values } = item {
            found[usize::from(values.is_none())].push((points, width_m));
        }
    }
    found
}

#[test]
fn rigid_joints_stiffen_the_prototype() {
    let prototype = ["design.thickness=0.85 mm", "load.travel=14.5 mm"];
    let overlap = ["design.thickness=0.85 mm", "load.travel=14.5 mm", "model.joints=overlap"];
    let (point, block) = (solve(SHAPES, &prototype), solve(SHAPES, &overlap));
    near(point.get("force_at_end"), 5.99, 2e-3, "points");
    let more = block.get("force_at_end") - point.get("force_at_end");
    assert!(more > 0.15 && more < 0.25, "{more}");
    // Rigid parts are drawn without colours, and begin and end where coloured ones do.
    let [coloured, plain] = deformed(SHAPES, &overlap);
    assert_eq!((coloured.len(), deformed(SHAPES, &prototype)[1].len()), (4, 0));
    assert!(plain.len() >= 4, "{}", plain.len());
    for (points, _) in &plain {
        let meets = |p: &[f64; 2]| coloured.iter().flat_map(|c| &c.0).any(|q| maths::hypot(p[0] - q[0], p[1] - q[1]) < 1e-12);
        assert!(points.iter().any(meets));
    }
    assert_eq!(codes(SHAPES, &["design.thickness=16 mm", "model.joints=overlap"]), ["E0512"]);
    assert!(codes(SHAPES, &["design.thickness=16 mm"]).is_empty());
    // What is said to be left is what is left.
    let messages: Vec<String> = (40..160)
        .flat_map(|quarter| {
            let thickness = format!("design.thickness={} mm", 0.25 * f64::from(quarter));
            let (_, found) = understand(SHAPES, &[&thickness, "model.joints=overlap"]);
            found.in_file_order().iter().filter(|d| d.code == "E0512").map(|d| d.message.clone()).collect::<Vec<_>>()
        })
        .collect();
    let mut some_left = 0;
    for message in &messages {
        let numbers: Vec<f64> = message.split(" mm").filter_map(|part| part.rsplit(' ').next()?.parse().ok()).collect();
        let left = numbers[1] - numbers[0];
        match numbers.get(2) {
            Some(said) => {
                close(*said, left, 1.1e-3, message);
                some_left += 1;
            }
            None => assert!(left <= 1.1e-3 && message.ends_with("nothing is left to bend"), "{message}"),
        }
    }
    assert!(some_left > 0 && some_left < messages.len(), "{messages:?}");
}

/// A cantilever along x whose thickness falls from the clamp to the tip.
fn cantilever(rest: &str, load: &str) -> String {
    let drawing = Drawing::straight("", [0.0, 1.0], "1 um", "inextensible");
    let text = drawing.text().replace("straight = true", &format!("straight = true\n{rest}"));
    let (before, after) = (text.find("[load]").expect("a load"), text.find("[model]").expect("a model"));
    format!("{}{load}\n{}", &text[..before], &text[after..])
}

#[test]
fn a_taper_bends_weighs_and_looks_as_it_should() {
    let load = "[load]\nnode = \"n2\"\ndirection = [0, 1]\nforce = \"10 uN\"";
    let text = cantilever("thickness = [[\"0\", \"1.5 mm\"], [\"1\", \"0.6 mm\"]]", load);
    let solved = solve(&text, &[]);
    let (l, thin, thick, e, b) = (0.1, 0.6e-3, 1.5e-3, 2e9, 1e-2);
    let s = (thick - thin) / l;
    // ∫ x²/(a + s x)³ dx, x from the tip.
    let primitive = |w: f64| (maths::ln(w) + 2.0 * thin / w - thin * thin / (2.0 * w * w)) / (s * s * s);
    let want = 1e-5 * 12.0 / (e * b) * (primitive(thick) - primitive(thin));
    near(solved.behaviour.path.points.last().unwrap().displacement, want, 1e-8, "tip");
    near(solved.get("mass"), 1400.0 * b * l * 0.5 * (thin + thick), 1e-12, "mass");
    // The largest stress is where w = 2a.
    near(solved.get("stress_max"), 1e-5 * (thin / s) * 6.0 / (b * 4.0 * thin * thin), 1e-7, "stress");
    let widths: Vec<f64> = deformed(&text, &[])[0].iter().map(|l| l.1).collect();
    assert!(widths.len() > 20 && widths.windows(2).all(|w| w[1] < w[0]));
    assert!(widths[0] < thick && widths[0] > 0.95 * thick && widths[widths.len() - 1] > thin && widths[widths.len() - 1] < 1.05 * thin);
    // The same everywhere, said twice, is nothing new.
    let plain = solve(&cantilever("thickness = \"0.8 mm\"", load), &[]);
    let places = solve(&cantilever("thickness = [[\"0\", \"0.8 mm\"], [\"0.3\", \"0.8 mm\"], [\"1\", \"0.8 mm\"]]", load), &[]);
    for metric in ["force_at_end", "stress_max", "mass", "energy_at_end"] {
        near(places.get(metric), plain.get(metric), 1e-8, metric);
    }
    let too_steep = cantilever("thickness = [[\"0\", \"0.005 mm\"], [\"1\", \"0.6 mm\"]]", load);
    assert_eq!(codes(&too_steep, &[]), ["E0509"]);
}

/// Slenderness and curvature are those of the place: the arc is thick where it is straight.
#[test]
fn warnings_see_the_local_thickness() {
    let arc = |thickness: &str| {
        let text = cantilever(thickness, "[load]\nnode = \"n2\"\ndirection = [0, 1]\ntravel = \"1 mm\"");
        let text = text.replace("straight = true", "bend = [0.0, 3.0]");
        let warnings: Vec<&str> = outcome(&text, &[]).warnings.iter().map(|w| w.code).collect();
        warnings.contains(&"W0502")
    };
    // The curvature grows from nothing at u = 0 to 2·3/L at u = 1.
    assert!(arc("thickness = [[\"0\", \"1 mm\"], [\"1\", \"4 mm\"]]"));
    assert!(!arc("thickness = [[\"0\", \"4 mm\"], [\"1\", \"1 mm\"]]"));
    assert!(!arc("thickness = \"1 mm\""));
}

/// Departure COMP-4.
#[test]
fn a_block_that_moves_sideways_gives_another_force() {
    let sideways = solve(&SHAPES.replace(GUIDED, "support = \"parallel\""), &[]);
    near(sideways.get("force_at_end"), 9.87, 5e-4, "n5 free in x");
    let node = sideways.behaviour.path.points.last().unwrap().nodes[4];
    close(node.rotation_rad, 0.0, 0.0, "rotation");
    assert!(node.displacement_m[0].abs() > 1e-5);
    let given = SHAPES.replace(GUIDED, "support = \"parallel\", direction = [0, 1]");
    assert_eq!(codes(&given, &[]), ["E0504"]);
}

#[test]
fn a_moment_first_and_a_travel_after_it() {
    let stages = "[[load]]\nnode = \"n2\"\nmoment = \"-1 N*um\"\n[[load]]\nnode = \"n2\"\ndirection = [0, 1]\ntravel = \"1 um\"";
    let text = cantilever("", stages);
    let solved = solve(&text, &[]);
    let (ei, l) = (2e9 * 1e-2 * 1e-9 / 12.0, 0.1);
    // The tip stays where the moment has left it; from there on a force moves it, and turns it.
    near(solved.get("force_at_end"), 3.0 * ei / (l * l * l) * 1e-6, 1e-6, "force");
    let before = &solved.behaviour.path.before[0];
    near(before.nodes[1].displacement_m[1], -1e-6 * l * l / (2.0 * ei), 1e-6, "after the moment");
    let end = solved.behaviour.path.points.last().unwrap();
    near(end.nodes[1].displacement_m[1], before.nodes[1].displacement_m[1] + 1e-6, 1e-9, "after the travel");
    let model = Compliant::analyse(&solved.design, &mut |_| true).model;
    let said = model.iter().find(|s| s.title == "Loads").map(|s| s.text.clone()).unwrap_or_default();
    assert!(said.starts_with("After 1 load stage") && said.contains("moment"), "{said}");
}

#[test]
fn stages_of_halves_are_those_of_the_engine() {
    let stages = "[[load]]\nnode = \"n4\"\ndirection = [1, 2]\nforce = \"0.6 N\"\n[[load]]\nnode = \"n3\"\nrotation = \"2 deg\"\n[[load]]\n\
        node = \"n5\"\ndirection = [0, -1]\ntravel = \"9 mm\"\n[model]";
    let text = Drawing::table3().text();
    let staged = format!("{}{}", &text[..text.find("[load]").unwrap()], stages) + &text[text.find("[model]").unwrap() + 7..];
    let solved = solve(&staged, &[]);
    let root = maths::hypot(1.0, 2.0);
    let network = Network {
        before: vec![
            Stage { drive: Drive::Force { node: 3, direction: [1.0 / root, 2.0 / root] }, to: 0.3 },
            Stage { drive: Drive::Rotation { node: 2 }, to: 2.0_f64.to_radians() },
        ],
        ..common::design(&text, &[]).network
    };
    let path = trace(&network, &[9e-3], &solved.design.settings(), &mut |_| true).unwrap();
    near(solved.get("force_at_end"), 2.0 * path.points[0].force, 1e-9, "force after two stages");
    let direct = solve(&text, &["load.travel=9 mm"]).get("force_at_end");
    assert!((solved.get("force_at_end") / direct - 1.0).abs() > 1e-2, "the stages matter");
    // 12 N is more than the block ever resists.
    let too_much = "[[load]]\nnode = \"n5\"\ndirection = [0, -1]\nforce = \"12 N\"\n[[load]]\nnode = \"n4\"\ndirection = [0, -1]\n\
        travel = \"1 mm\"\n[model]";
    let refused = format!("{}{}", &text[..text.find("[load]").unwrap()], too_much) + &text[text.find("[model]").unwrap() + 7..];
    let status = outcome(&refused, &[]).status;
    assert_eq!(status.kind, StatusKind::NoEquilibriumBeyond);
    assert!(status.message.starts_with("load 1 of 2, on node `n5`") && status.message.contains("beyond 81."), "{}", status.message);
}

#[test]
fn a_force_is_the_other_way_round() {
    let driven = |force: &str| NODES.replace("travel = \"13.6 mm\"", &format!("force = \"{force}\"")).replace("[requirements.", "[x.");
    let travel = solve(NODES, &[]);
    let text = driven("9 N");
    let force = solve(&text, &[]);
    let end = force.behaviour.path.points.last().unwrap();
    near(2.0 * end.force, 9.0, 1e-12, "the whole layout carries the force");
    near(travel.force(end.displacement), 9.0, 1e-7, "at the displacement of the other path");
    for (metric, x) in [("energy_at_end", end.displacement), ("stress_max", end.displacement)] {
        let same = solve(NODES, &[&format!("load.travel={x:e} m")]);
        near(force.get(metric), same.get(metric), 1e-6, metric);
    }
    // Stations are even in the force.
    let points = &force.behaviour.path.points;
    near(points[1].force - points[0].force, points[points.len() - 1].force / (points.len() - 1) as f64, 1e-9, "stations");
    let beyond = outcome(&driven("12 N"), &[]);
    assert_eq!(beyond.status.kind, StatusKind::NoEquilibriumBeyond);
    assert!(beyond.status.message.contains("beyond F = 9.7") && beyond.status.message.contains(" N:"), "{}", beyond.status.message);
    assert!(beyond.status.advice.unwrap().contains("`load.force`"));
}

#[test]
fn loads_that_make_no_sense_have_a_place_and_a_way_out() {
    let load = |text: &str| {
        let base = Drawing::table3().text();
        format!("{}{text}\n{}", &base[..base.find("[load]").unwrap()], &base[base.find("[model]").unwrap()..])
    };
    let last = "[[load]]\nnode = \"n5\"\ndirection = [0, -1]\ntravel = \"5 mm\"";
    for (first, code) in [
        ("[[load]]\nnode = \"n4\"\ndirection = [1, 0]", "E0302"),
        ("[[load]]\nnode = \"n4\"\nforce = \"1 N\"", "E0302"),
        ("[[load]]\nnode = \"n4\"\nforce = \"1 N\"\nmoment = \"1 N*mm\"", "E0305"),
        ("[[load]]\nnode = \"n4\"\ndirection = [1, 0]\nmoment = \"1 N*mm\"", "E0305"),
        ("[[load]]\nnode = \"n9\"\nmoment = \"1 N*mm\"", "E0304"),
        ("[[load]]\nnode = \"n1\"\nmoment = \"1 N*mm\"", "E0506"),
        ("[[load]]\nnode = \"n1\"\ndirection = [1, 0]\nforce = \"1 N\"", "E0506"),
        ("[[load]]\nnode = \"n5\"\nmoment = \"1 N*mm\"", "E0506"),
        ("[[load]]\nnode = \"n5\"\ndirection = [0, 1]\ntravel = \"1 mm\"", "E0513"),
        ("[[load]]\nnode = \"n4\"\ndirection = [0, 1]\ntravel = \"-1 mm\"", "E0204"),
    ] {
        let (design, diagnostics) = understand(&load(&format!("{first}\n{last}")), &[]);
        assert!(design.is_none());
        let found = diagnostics.in_file_order();
        assert_eq!(found.iter().map(|d| d.code).collect::<Vec<_>>(), [code], "{first}");
        assert!(found.iter().all(|d| d.span.is_some() && d.help.as_ref().is_some_and(|h| !h.is_empty())), "{first}");
    }
    assert_eq!(codes(&load("[load]\nnode = \"n5\"\nmoment = \"1 N*mm\""), &[]), ["E0306"]);
    let many = "[[load]]\nnode = \"n4\"\nmoment = \"1 N*mm\"\n".repeat(17);
    assert_eq!(codes(&load(&format!("{many}{last}")), &[]), ["E0311"]);
    // On the mirror line: along it only, and no turning.
    let on_line = load(&format!("[[load]]\nnode = \"n4\"\ndirection = [1, 1]\nforce = \"1 N\"\n{last}")).replace("x = 0", "x = 12.44 mm");
    assert!(codes(&on_line, &[]).contains(&"E0508"));
    let turned = load(&format!("[[load]]\nnode = \"n4\"\nmoment = \"1 N*mm\"\n{last}")).replace("x = 0", "x = 12.44 mm");
    assert!(codes(&turned, &[]).contains(&"E0508"));
}

/// An inclined beam that snaps, driven through a soft one.
#[test]
fn a_jump_is_named_with_what_it_does() {
    let drawing = Drawing {
        nodes: vec![
            ("n1", [50.0, 0.0], "support = \"clamped\"".to_owned()),
            ("n2", [0.0, 3.0], guide([0.0, 1.0])),
            ("n3", [0.0, 43.0], guide([0.0, 1.0])),
        ],
        beams: vec![("arch", ["n1", "n2"], Vec::new()), ("soft", ["n2", "n3"], vec![3.0])],
        load_node: "n3",
        load_direction: [0.0, -1.0],
        travel: "10 mm".to_owned(),
        mirror: None,
        model: "reissner",
    };
    let text = drawing.text().replace("name = \"soft\"", "name = \"soft\"\nthickness = \"0.8 mm\"");
    let solved = solve(&text, &[]);
    let Status::NoEquilibriumBeyond { control } = solved.behaviour.path.status else { panic!("{:?}", solved.behaviour.path.status) };
    let Some(Snap::Lands(jump)) = solved.behaviour.snap else { panic!("{:?}", solved.behaviour.snap) };
    near(jump.control, control, 1e-4, "where it jumps");
    let last = solved.behaviour.path.points.last().unwrap();
    assert!(control - last.control < 10e-3 / 128.0 && jump.force_before < last.force, "{jump:?}");
    assert!(jump.force_after < 0.9 * jump.force_before && jump.released_j > 0.0, "{jump:?}");
    let message = outcome(&text, &[]).status.message;
    assert!(message.contains("jumps there") && message.contains("mJ free"), "{message}");
    // A device that has buckled before never comes to the limit point.
    let buckled = solve(&text, &["design.nodes.n2.at=[\"0 mm\", \"3.5 mm\"]", "design.nodes.n3.at=[\"0 mm\", \"43.5 mm\"]"]);
    assert!(buckled.behaviour.unstable_from_m.is_some() && !buckled.behaviour.whole && buckled.behaviour.snap.is_none());
    // A path that reaches its end has no jump to tell.
    assert!(solve(&text, &["load.travel=3 mm"]).behaviour.snap.is_none());
}

/// Both halves with the block between them as one network, the block free to move and to turn.
fn whole(half: &Network) -> Network {
    let [offset, height] = half.nodes[4].position_m;
    let image = |n: &Node| Node { position_m: [-n.position_m[0], n.position_m[1]], ..*n };
    let mut nodes = half.nodes.clone();
    nodes[4] = Node { position_m: [0.0, height], support: Support::Free };
    nodes.extend(half.nodes[..4].iter().map(image));
    let mut beams = half.beams.clone();
    beams[3].arms_m[1] = [offset, 0.0];
    for beam in beams.clone() {
        let other = |i: usize| if i == 4 { 4 } else { i + 5 };
        let mut angle: Vec<f64> = beam.shape.angle_rad().iter().map(|c| -c).collect();
        angle[0] += std::f64::consts::PI;
        let shape = Shape::new(angle, beam.shape.length_m()).expect("a mirrored shape");
        let arms_m = beam.arms_m.map(|a| [-a[0], a[1]]);
        beams.push(Beam { start: other(beam.start), end: other(beam.end), shape, arms_m, ..beam });
    }
    Network { nodes, beams, ..half.clone() }
}

#[test]
fn sideways_stiffness_of_the_paper_is_that_of_both_halves_as_one_network() {
    for set in [vec![], vec!["design.nodes.n5.at=[\"9 mm\", \"40 mm\"]"]] {
        let solved = solve(NODES, &set);
        let network = whole(&solved.design.network);
        let stations: Vec<f64> = solved.behaviour.path.points.iter().map(|p| p.control).collect();
        let path = trace(&network, &stations, &solved.design.settings(), &mut |_| true).unwrap();
        let mut least = f64::INFINITY;
        for point in path.points.iter().step_by(4) {
            let k = path.output_stiffness(point).unwrap();
            least = least.min(k[0][0] - k[0][2] * k[0][2] / k[2][2]);
        }
        near(2.0 * solved.behaviour.path.points[100].force, path.points[100].force, 1e-6, "the same mechanism");
        near(solved.get("lateral_stiffness_min"), least, 1e-5, "sideways stiffness");
    }
}

/// Two leaning columns with their heads joined: guided they stand, free they sway, where the whole network becomes unstable.
#[test]
fn swaying_begins_where_the_whole_becomes_unstable() {
    let half = Drawing {
        nodes: vec![("n1", [12.0, 0.0], "support = \"clamped\"".to_owned()), ("n2", [0.0, 60.0], guide([0.0, 1.0]))],
        beams: vec![("b1", ["n1", "n2"], vec![0.5, -0.2])],
        load_node: "n2",
        load_direction: [0.0, -1.0],
        travel: "6 mm".to_owned(),
        mirror: Some("x = 0".to_owned()),
        model: "reissner",
    };
    let mut free = Drawing { mirror: None, ..half.clone() };
    free.nodes[1].2 = String::new();
    free.nodes.push(("n3", [-12.0, 0.0], "support = \"clamped\"".to_owned()));
    free.beams.push(("b2", ["n3", "n2"], vec![-0.5, 0.2]));
    let (half, free) = (solve(&half.text(), &[]), solve(&free.text(), &[]));
    let sway = half.behaviour.sway.unwrap();
    near(sway.from_m.unwrap(), free.behaviour.unstable_from_m.unwrap(), 1e-2, "where it sways");
    assert!(sway.least_n_per_m.is_none_or(|k| k < 0.0));
    let warned = Compliant::analyse(&half.design, &mut |_| true).outcome.warnings;
    assert!(warned.iter().any(|w| w.code == "W0510"), "{warned:?}");
}

/// A straight column under more than Euler's load π² EI/(4 L²), then pushed sideways: the first load is named, with the part of it that
/// the column bears.
#[test]
fn a_load_that_buckles_is_named() {
    let column = |force: &str| {
        format!(
            "schema = 1\nmechanism = \"compliant\"\ntitle = \"Column\"\n[material]\nyoung_modulus = \"200 GPa\"\n\
             [design]\nthickness = \"1 mm\"\ndepth = \"10 mm\"\n[design.nodes]\n\
             a = {{ at = [\"0 mm\", \"0 mm\"], support = \"clamped\" }}\nb = {{ at = [\"100 mm\", \"0 mm\"] }}\n\
             [[design.beams]]\nname = \"r\"\nbetween = [\"a\", \"b\"]\nstraight = true\n[model]\nbeam = \"inextensible\"\n\
             [[load]]\nnode = \"b\"\ndirection = [-1, 0]\nforce = \"{force}\"\n\
             [[load]]\nnode = \"b\"\ndirection = [0, -1]\ntravel = \"5 mm\"\n"
        )
    };
    let euler_n = std::f64::consts::PI * std::f64::consts::PI * 200e9 * 1e-9 * 0.01 / 12.0 / (4.0 * 0.01);
    let buckled = outcome(&column("60 N"), &[]);
    assert_eq!(buckled.status.kind, StatusKind::UnstableBeyond);
    let part = format!("passes a branch at {:.1} % of it", 100.0 * euler_n / 60.0);
    assert!(
        buckled.status.message.starts_with("load 1 of 2, on node `b`") && buckled.status.message.contains(&part),
        "{:?}",
        buckled.status
    );
    assert_eq!(outcome(&column("40 N"), &[]).status.kind, StatusKind::Complete);
}
