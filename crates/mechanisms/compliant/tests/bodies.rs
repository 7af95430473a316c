//! Rigid bodies that join drawn nodes: closed forms, stiff beams in their place, and what they cannot be.

mod common;

use common::{close, design, near, outcome, solve, understand};
use forcewright_base::maths;
use forcewright_compliant::Compliant;
use forcewright_contract::family::Mechanism;
use forcewright_model::{FigureContent, Item, Role};

const LENGTH_M: f64 = 40e-3;
const APART_M: f64 = 12e-3;
const EI: f64 = 2e9 * 10e-3 * 0.8e-3 * 0.8e-3 * 0.8e-3 / 12.0;
const EA: f64 = 2e9 * 10e-3 * 0.8e-3;
const NU: f64 = 0.3;

/// Two parallel beams from the ground to a block with a lever, which nothing else ends at.
fn frame(body: &str, load: &str) -> String {
    format!(
        r#"
schema = 1
mechanism = "compliant"
[material]
young_modulus = "2 GPa"
poisson_ratio = {NU}
yield_stress = "60 MPa"
[design]
thickness = "0.8 mm"
depth = "10 mm"
[design.nodes]
a = {{ at = ["0 mm", "0 mm"], support = "clamped" }}
b = {{ at = ["0 mm", "12 mm"], support = "clamped" }}
p = {{ at = ["40 mm", "0 mm"] }}
q = {{ at = ["40 mm", "12 mm"] }}
middle = {{ at = ["40 mm", "6 mm"] }}
lever = {{ at = ["55 mm", "6 mm"] }}
[design.bodies]
{body}
[[design.beams]]
name = "low"
between = ["a", "p"]
straight = true
[[design.beams]]
name = "high"
between = ["b", "q"]
straight = true
[load]
{load}
"#
    )
}

fn all_of(rest: &str) -> String {
    format!("block = {{ nodes = [\"p\", \"q\", \"middle\", \"lever\"]{rest} }}")
}

fn push(node: &str, travel: &str) -> String {
    format!("node = \"{node}\"\ndirection = [0, 1]\ntravel = \"{travel}\"")
}

/// Stiffness of a clamped straight beam at its end against (across, rotation), with shear (S. P. Timoshenko's beam; Φ = 12EI/(κGA·L²)).
fn tip_stiffness() -> [f64; 3] {
    let shear = 5.0 / 6.0 * EA / (2.0 * (1.0 + NU));
    let phi = 12.0 * EI / (shear * LENGTH_M * LENGTH_M);
    let k = EI / (LENGTH_M * (1.0 + phi));
    [12.0 * k / (LENGTH_M * LENGTH_M), -6.0 * k / LENGTH_M, (4.0 + phi) * k]
}

#[test]
fn a_parallel_guide_is_as_stiff_as_two_guided_beams() {
    let [across, ..] = tip_stiffness();
    let held = solve(&frame(&all_of(", support = \"parallel\""), &push("p", "5 mm")), &[]);
    near(held.get("stiffness_initial"), 2.0 * across, 1e-8, "2·12EI/L³ with shear");
    // Shear is a small correction here.
    near(held.get("stiffness_initial"), 24.0 * EI / (LENGTH_M * LENGTH_M * LENGTH_M), 2e-3, "2·12EI/L³");
    // On a slider along the load both beams are drawn out: twice one guided beam, however far.
    let slider = solve(&frame(&all_of(", support = \"slider\", direction = [0, 1]"), &push("q", "5 mm")), &[]);
    let one = frame("block = { nodes = [\"p\", \"lever\"], support = \"slider\", direction = [0, 1] }", &push("p", "5 mm"));
    let one = one.replace("q = {", "#").replace("middle = {", "#").replace("b = {", "#");
    let (head, tail) = one.split_once("[[design.beams]]\nname = \"high\"").unwrap();
    let one = solve(&format!("{head}{}", &tail[tail.find("[load]").unwrap()..]), &[]);
    for part in [0.1, 0.5, 1.0] {
        near(slider.force(part * 5e-3), 2.0 * one.force(part * 5e-3), 1e-8, "twice one beam");
    }
    near(slider.get("stress_max"), one.get("stress_max"), 1e-7, "stress");
    // Free to come nearer to the ground, beams of equal length keep the block parallel: much softer at the end, and equal by symmetry.
    assert!(held.force(5e-3) < 0.5 * slider.force(5e-3));
}

#[test]
fn a_block_that_turns_bends_as_the_closed_form_says() {
    let [k, mixed, turn] = tip_stiffness();
    // Of the block at its middle: across, and rotation with the beams drawn out on one side and pressed on the other.
    let (kyy, kyt) = (2.0 * k, 2.0 * mixed);
    let ktt = 2.0 * turn + 2.0 * EA / LENGTH_M * 0.25 * APART_M * APART_M;
    let determinant = kyy * ktt - kyt * kyt;
    for (node, arm_m) in [("middle", 0.0), ("p", 0.0), ("lever", 15e-3)] {
        let solved = solve(&frame(&all_of(""), &push(node, "0.02 mm")), &[]);
        let compliance = (ktt - 2.0 * arm_m * kyt + arm_m * arm_m * kyy) / determinant;
        near(solved.get("stiffness_initial"), 1.0 / compliance, 1e-8, node);
    }
    let free = solve(&frame(&all_of(""), &push("lever", "5 mm")), &[]);
    // The deformed drawing is rigid, and the loaded node has moved as far as the load says.
    let point = free.behaviour.path.points.last().unwrap();
    let moved: Vec<[f64; 2]> = free.design.drawn.iter().map(|d| free.design.moved_m(d, point)).collect();
    let at = |name: &str| moved[free.design.drawn.iter().position(|d| d.name == name).unwrap()];
    let distance = |a: [f64; 2], b: [f64; 2]| ((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])).sqrt();
    close(distance(at("p"), at("q")), APART_M, 1e-14, "a side of the block");
    close(at("lever")[1] - 6e-3, 5e-3, 1e-14, "the loaded node");
    // The beams end where the block has its nodes.
    for (beam, name) in [(1, "p"), (0, "q")] {
        close(distance(point.beams[beam].shape_m(1.0), at(name)), 0.0, 1e-10, name);
    }
    // A moment turns it about its middle: θ = M/(K_θθ − K_yθ²/K_yy), as a stage before a motion of nothing.
    let text =
        frame(&all_of(""), "").replace("[load]", "[[load]]\nnode = \"q\"\nmoment = \"0.1 N*mm\"\n[[load]]") + &push("middle", "0.02 mm");
    let turned = solve(&text, &[]);
    near(turned.behaviour.path.points[0].nodes[turned.design.load_node].rotation_rad, 1e-4 / (ktt - kyt * kyt / kyy), 1e-6, "rotation");
}

/// The example: beams under a lengthwise load P sway with K = P/(L·(tan(kL/2)/(kL/2) − 1)) each, k² = P/EI (`timoshenko-gere1961`,
/// section 1.11).
#[test]
fn a_preload_softens_a_guide_as_the_closed_form_says() {
    let text = include_str!("../../../../examples/compliant/preloaded-guide.toml");
    let young = design(text, &[]).network.beams[0].section.young_pa;
    let (ei, length) = (young * 10e-3 * 0.4e-3 * 0.4e-3 * 0.4e-3 / 12.0, 40e-3);
    for force in [30.0, 90.0, 120.0] {
        let (p, k) = (0.5 * force, maths::powf(0.5 * force / ei, 0.5));
        let half = 0.5 * k * length;
        let want = 2.0 * p / (length * (maths::tan(half) / half - 1.0));
        let solved = solve(text, &[&format!("load.1.force={force} N")]);
        near(solved.get("stiffness_initial"), want, 6e-3, "softened by a preload");
    }
    // The held load is in the picture.
    let analysis = Compliant::analyse(&design(text, &[]), &mut |_| true);
    let FigureContent::Scene(scene) = &analysis.figures[0].content else { panic!("a picture first") };
    let held: Vec<_> =
        scene.items.iter().filter_map(|i| if let Item::Arrow { from, to, label } = i { Some((from, to, label)) } else { None }).collect();
    let [_, (from, to, label)] = held[..] else { panic!("{held:?}") };
    assert!(label == "held: 90 N" && from[1] < to[1] && (from[0] - to[0]).abs() < 1e-12, "{from:?} {to:?} {label}");
}

/// The body, and stiff beams instead.
#[test]
fn a_body_is_the_limit_of_stiff_beams() {
    let text = |body: bool, pinned: bool, young: &str| {
        let body_text = if body { "block = { nodes = [\"p\", \"q\", \"t\"] }" } else { "" };
        let stiff = |a: &str, b: &str| {
            format!(
                "[[design.beams]]\nname = \"{a}{b}\"\nbetween = [\"{a}\", \"{b}\"]\nstraight = true\nmaterial = \"stiff\"\nthickness = \"4 mm\"\n"
            )
        };
        let beams = if body { String::new() } else { [stiff("p", "q"), stiff("q", "t"), stiff("t", "p")].concat() };
        let stiff_material =
            if body { String::new() } else { format!("[material.stiff]\nyoung_modulus = \"{young}\"\npoisson_ratio = 0.3\n") };
        let pin = if pinned { ", support = \"pinned\"" } else { "" };
        format!(
            r#"
schema = 1
mechanism = "compliant"
[material]
young_modulus = "2 GPa"
poisson_ratio = 0.3
{stiff_material}
[design]
thickness = "0.8 mm"
depth = "10 mm"
nodes.a = {{ at = ["0 mm", "0 mm"], support = "clamped" }}
nodes.p = {{ at = ["30 mm", "10 mm"] }}
nodes.q = {{ at = ["40 mm", "10 mm"]{pin} }}
nodes.t = {{ at = ["36 mm", "18 mm"] }}
nodes.out = {{ at = ["70 mm", "25 mm"], support = "slider", direction = [1, 1], rotation = "free" }}
[design.bodies]
{body_text}
[[design.beams]]
name = "in"
between = ["a", "p"]
bend = [0.8]
[[design.beams]]
name = "out"
between = ["t", "out"]
bend = [-0.6]
hinged = ["t"]
{beams}
[load]
node = "out"
direction = [1, 1]
travel = "-4 mm"
"#
        )
        .replace("direction = [1, 1]\ntravel = \"-4 mm\"", "direction = [-1, -1]\ntravel = \"3 mm\"")
    };
    for pinned in [false, true] {
        let rigid = solve(&text(true, pinned, ""), &[]);
        assert!(rigid.behaviour.whole, "{:?}", rigid.behaviour.path.status);
        let gaps: Vec<f64> = ["2000 GPa", "9000 GPa"]
            .map(|young| solve(&text(false, pinned, young), &[]).get("force_at_end") / rigid.get("force_at_end") - 1.0)
            .to_vec();
        assert!(gaps[0].abs() < 1e-2, "pinned {pinned}: {gaps:?}");
        near(gaps[0] / gaps[1], 4.5, 2e-2, "the difference falls with the softness");
    }
}

/// Bits do not depend on the order of tables and names, nor results on the node that is loaded where the body keeps its angle.
#[test]
fn order_and_reference_do_not_matter() {
    let bits = |text: &str| -> Vec<u64> {
        let outcome = outcome(text, &[]);
        outcome.metrics.iter().map(|m| m.value.to_bits()).chain(outcome.curves[0].branches[0].y.iter().map(|f| f.to_bits())).collect()
    };
    let text = frame(&all_of(""), &push("lever", "3 mm"));
    let other = text
        .replace("[\"p\", \"q\", \"middle\", \"lever\"]", "[\"lever\", \"q\", \"p\", \"middle\"]")
        .replace("name = \"low\"", "name = \"zlow\"")
        .replace("name = \"zlow\"", "name = \"low\"");
    let (head, rest) = other.split_once("[design.nodes]\n").unwrap();
    let (nodes, rest) = rest.split_once("[design.bodies]\n").unwrap();
    let turned: Vec<&str> = nodes.lines().rev().collect();
    let other = format!(
        "{head}[design.bodies]\n{}\n{}",
        rest.split_once('\n').unwrap().0,
        &format!("[design.nodes]\n{}\n{}", turned.join("\n"), rest.split_once('\n').unwrap().1)
    );
    assert!(other != text && bits(&other) == bits(&text));
    let slider = |node: &str| solve(&frame(&all_of(", support = \"slider\", direction = [0.3, 1]"), &push(node, "3 mm")), &[]);
    let (first, second) = (slider("p"), slider("lever"));
    assert_eq!([&first, &second].map(|s| s.design.node_names[2].as_str()), ["p", "lever"], "another reference");
    for name in ["force_at_end", "stress_max", "stiffness_min", "energy_at_end"] {
        near(first.get(name), second.get(name), 1e-7, name);
    }
    // The support at a node of the body is the support of the body.
    let at_node = frame(&all_of(""), &push("p", "3 mm"))
        .replace("q = { at = [\"40 mm\", \"12 mm\"] }", "q = { at = [\"40 mm\", \"12 mm\"], support = \"slider\", direction = [0.3, 1] }");
    near(solve(&at_node, &[]).get("force_at_end"), first.get("force_at_end"), 1e-9, "support at a node");
}

/// Beams that leave one body side by side are as near there as they were made; ends on the ground likewise stay what they were.
#[test]
fn ends_on_one_body_are_no_clearance() {
    // Straight beams that spread from the block by the same angle to both sides: nowhere nearer than at the block.
    let text = frame(&all_of(""), &push("lever", "0.5 mm"))
        .replace("a = { at = [\"0 mm\", \"0 mm\"]", "a = { at = [\"0 mm\", \"-20 mm\"]")
        .replace("b = { at = [\"0 mm\", \"12 mm\"]", "b = { at = [\"0 mm\", \"32 mm\"]");
    let spread = solve(&text, &[]);
    assert!(spread.measured.nearest.is_none(), "{:?}", spread.measured.nearest);
    // Loose ends at the same places are.
    let apart = text.replace("[\"p\", \"q\", \"middle\", \"lever\"]", "[\"q\", \"middle\", \"lever\"]");
    near(solve(&apart, &[]).get("clearance_min"), APART_M - 0.8e-3, 2e-2, "ends that are not joined");
    // Bent towards each other they come nearer between the ends, and that is found: at rest the arcs' heights in closed form.
    let bent = frame(&all_of(""), &push("lever", "0.01 mm"));
    let (low, high) = bent.split_once("name = \"high\"").unwrap();
    let bent = format!(
        "{}name = \"high\"{}",
        low.replace("straight = true", "arc = \"-20 deg\""),
        high.replace("straight = true", "arc = \"20 deg\"")
    );
    let sagitta = |angle: f64| 0.5 * LENGTH_M * maths::tan(0.25 * angle);
    let found = solve(&bent, &[]).measured.nearest.expect("arcs that face each other");
    near(found.clearance.distance_m, APART_M - 2.0 * sagitta(20_f64.to_radians()) - 0.8e-3, 2e-3, "between the arcs");
    // Neither does a crossing come of it.
    assert!(!outcome(&text, &[]).warnings.iter().any(|w| w.code == "W0508"));
}

/// Zones belong to the place where beams meet, not to the node of the body.
#[test]
fn overlap_joints_on_a_body() {
    let text = |load: &str| {
        frame(&all_of(", support = \"slider\", direction = [0, 1]"), &push(load, "3 mm"))
            .replace("b = { at = [\"0 mm\", \"12 mm\"]", "b = { at = [\"20 mm\", \"-30 mm\"]")
            .replace("between = [\"b\", \"q\"]", "between = [\"b\", \"p\"]")
            + "[model]\njoints = \"overlap\"\n"
    };
    let (at, away) = (solve(&text("p"), &[]), solve(&text("lever"), &[]));
    // Half a thickness over the tangent of half the angle between the two beams: 0.4 mm/tan(α/2), cos α = (40·20 + 0·30)/(40·√1300).
    let alpha = maths::acos(20.0 / 1300_f64.sqrt());
    let zone = 0.4e-3 / maths::tan(0.5 * alpha);
    for solved in [&at, &away] {
        let [_, to] = solved.behaviour.path.points[0].beams[1].flexible();
        near((1.0 - to) * LENGTH_M, zone, 1e-9, "the zone of the straight beam");
    }
    near(at.get("force_at_end"), away.get("force_at_end"), 1e-7, "force");
}

#[test]
fn bodies_are_drawn_and_named() {
    let text = frame(&all_of(""), &push("lever", "5 mm"));
    let analysis = Compliant::analyse(&design(&text, &[]), &mut |_| true);
    let FigureContent::Scene(scene) = &analysis.figures[0].content else { panic!("a picture first") };
    let bodies: Vec<_> =
        scene.items.iter().filter_map(|i| if let Item::Body { corners, role } = i { Some((corners, role)) } else { None }).collect();
    assert_eq!(bodies.iter().map(|b| *b.1).collect::<Vec<_>>(), [Role::Undeformed, Role::Deformed]);
    // Every drawn node lies inside its outline, in either state: to the left of all its sides.
    let design = design(&text, &[]);
    let inside = |corners: &[[f64; 2]], p: [f64; 2]| {
        (0..corners.len()).all(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0.0
        })
    };
    for name in ["p", "q", "middle", "lever"] {
        let node = design.drawn.iter().find(|d| d.name == name).unwrap();
        assert!(inside(bodies[0].0, node.position_m), "{name} in {:?}", bodies[0].0);
    }
    assert!(scene.items.iter().filter(|i| matches!(i, Item::Label { .. })).count() == 6);
    assert!(scene.description.contains("6 nodes, a rigid body"));
    assert!(
        analysis.model.iter().any(|s| s.text.contains("are one rigid body, `block`") && s.text.contains("node lever is moved"))
            || analysis.model.iter().any(|s| s.text.contains("node lever is moved by 5 mm"))
    );
}

#[test]
fn impossible_bodies_are_refused() {
    let codes = |text: &str| -> Vec<&'static str> {
        let (design, diagnostics) = understand(text, &[]);
        assert!(design.is_none());
        diagnostics.in_file_order().iter().map(|d| d.code).collect()
    };
    let good = push("lever", "1 mm");
    let with = |body: &str| codes(&frame(body, &good));
    assert_eq!(with("block = { nodes = [\"p\"] }"), ["E0311"]);
    assert_eq!(with("block = { nodes = [\"p\", \"r\"] }\nrest = { nodes = [\"q\", \"middle\", \"lever\"] }"), ["E0304"]);
    assert_eq!(with("block = { nodes = [\"p\", \"q\", \"p\", \"middle\", \"lever\"] }"), ["E0514"]);
    assert_eq!(with("block = { nodes = [\"p\", \"q\", \"middle\"] }\nrest = { nodes = [\"q\", \"lever\"] }"), ["E0514"]);
    assert_eq!(with("block = { nodes = [\"p\", \"q\"] }\nrest = { nodes = [\"middle\", \"lever\"] }"), ["E0510"]);
    assert_eq!(with(&all_of(", support = \"pinned\"")), ["E0515"]);
    assert_eq!(with(&all_of(", support = \"slider\", direction = [0, 1], rotation = \"free\"")), ["E0515"]);
    assert_eq!(with(&all_of(", support = \"slider\"")), ["E0504"]);
    assert_eq!(with("block = { }"), ["E0302"]);
    // Held at two places, loaded where it is not held, loaded at two places.
    let pinned = |text: &str, node: &str| text.replace(&format!("{node} = {{ at"), &format!("{node} = {{ support = \"pinned\", at"));
    let text = frame(&all_of(""), &good);
    assert_eq!(codes(&pinned(&pinned(&text, "p"), "q")), ["E0515"]);
    assert_eq!(codes(&pinned(&frame(&all_of(", support = \"parallel\""), &good), "q")), ["E0515"]);
    assert_eq!(codes(&pinned(&text, "q")), ["E0515"]);
    let twice = text.replace("[load]\n", "[[load]]\nnode = \"p\"\ndirection = [0, 1]\nforce = \"1 N\"\n[[load]]\n");
    assert_eq!(codes(&twice), ["E0515"]);
    assert!(understand(&twice.replace("node = \"p\"", "node = \"lever\""), &[]).0.is_some());
    // Names of bodies are no nodes, and no beam joins a body with itself.
    assert_eq!(codes(&text.replace("node = \"lever\"", "node = \"block\"")), ["E0304"]);
    assert_eq!(codes(&text.replace("between = [\"b\", \"q\"]", "between = [\"p\", \"q\"]")), ["E0502"]);
    // On the mirror line with three of its nodes: one cause, one error.
    assert_eq!(codes(&format!("{text}[layout]\nmirror = \"x = 40 mm\"\n")), ["E0511"]);
    let guided = frame(&all_of(", support = \"slider\", direction = [0, 1]"), &good);
    assert!(understand(&format!("{guided}[layout]\nmirror = \"x = 40 mm\"\n"), &[]).0.is_some());
}
