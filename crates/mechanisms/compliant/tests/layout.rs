//! Copies of the drawn network: against the same mechanism drawn in full, closed forms, and what copies cannot be.

mod common;

use common::{Solved, close, design, near, outcome, solve, understand};
use forcewright_base::maths;
use forcewright_beam::Status;
use forcewright_compliant::Compliant;
use forcewright_contract::family::Mechanism;
use forcewright_model::{FigureContent, Item, Role, SupportKind};

/// A bent leg from a clamp to a block that moves down; its force has a maximum after which it falls.
const LEG: &str = r#"
schema = 1
mechanism = "compliant"
[material]
young_modulus = "2 GPa"
yield_stress = "76 MPa"
poisson_ratio = 0.35
density = "1400 kg/m^3"
[design]
thickness = "1 mm"
depth = "10 mm"
[design.nodes]
foot = { at = ["30 mm", "0 mm"], support = "clamped" }
block = { at = ["0 mm", "20 mm"], support = "slider", direction = [0, 1] }
[[design.beams]]
name = "leg"
between = ["foot", "block"]
bend = [0.4, -0.2]
[layout]
[load]
node = "block"
direction = [0, -1]
travel = "6 mm"
"#;

/// The leg with a layout and a travel.
fn laid_out(layout: &str, travel: &str) -> String {
    LEG.replace("[layout]", &format!("[layout]\n{layout}")).replace("\"6 mm\"", &format!("\"{travel}\""))
}

/// Two legs drawn one above the other: their blocks joined, or the upper foot standing on the lower block.
fn drawn(bodies: &str, upper_foot: &str, load: &str, travel: &str) -> String {
    LEG.replace("support = \"slider\", direction = [0, 1] }", "}")
        .replace("[[design.beams]]", &format!("foot2 = {{ at = [\"30 mm\", \"50 mm\"]{upper_foot} }}\nblock2 = {{ at = [\"0 mm\", \"70 mm\"] }}\n[design.bodies]\n{bodies}\n[[design.beams]]"))
        .replace("[layout]", "[[design.beams]]\nname = \"upper\"\nbetween = [\"foot2\", \"block2\"]\nbend = [0.4, -0.2]")
        .replace("node = \"block\"", &format!("node = \"{load}\""))
        .replace("\"6 mm\"", &format!("\"{travel}\""))
}

fn same(found: &Solved, wanted: &Solved, metric: &str, factor: f64, tolerance: f64) {
    near(found.get(metric), factor * wanted.get(metric), tolerance, metric);
}

#[test]
fn copies_on_one_block_add_their_forces() {
    let one = solve(LEG, &[]);
    let layouts = [
        ("array = { count = 3, spacing = \"40 mm\" }", 3.0),
        ("plates = 4", 4.0),
        ("circular = { count = 5, radius = \"20 mm\" }", 5.0),
        ("plates = 2\ncircular = { count = 3, radius = \"20 mm\" }", 6.0),
        ("mirror = \"x = -5 mm\"\narray = { count = 2, spacing = \"40 mm\" }\nplates = 2", 8.0),
    ];
    for (layout, copies) in layouts {
        let all = solve(&laid_out(layout, "6 mm"), &[]);
        for metric in ["force_at_end", "energy_at_end", "mass", "stiffness_initial", "stiffness_min"] {
            same(&all, &one, metric, copies, 1e-12);
        }
        for metric in ["stress_max", "flat_ratio", "range_start"] {
            same(&all, &one, metric, 1.0, 1e-9);
        }
    }
}

/// Rows by `array` and the same rows drawn, whose blocks are one rigid body.
#[test]
fn rows_are_what_they_are_when_drawn() {
    let rows = solve(&laid_out("array = { count = 2, spacing = \"50 mm\", direction = [0, 1] }", "6 mm"), &[]);
    let body = "shuttle = { nodes = [\"block\", \"block2\"], support = \"slider\", direction = [0, 1] }";
    let drawn = solve(&drawn(body, ", support = \"clamped\"", "block", "6 mm"), &[]);
    for metric in ["force_at_end", "energy_at_end", "mass", "stress_max", "stiffness_min", "clearance_min"] {
        same(&rows, &drawn, metric, 1.0, 1e-8);
    }
}

/// Layers by `series` and the same layers drawn, the upper foot on the lower block.
#[test]
fn layers_are_what_they_are_when_drawn() {
    let travel = "8 mm";
    let layers = solve(&laid_out("series = 2", travel), &[]);
    let bodies = "lower = { nodes = [\"block\", \"foot2\"], support = \"slider\", direction = [0, 1] }\nupper = { nodes = [\"block2\"], support = \"slider\", direction = [0, 1] }";
    let bodies = bodies.replace("[\"block2\"]", "[\"block2\", \"top\"]");
    let text = drawn(&bodies, "", "block2", travel).replace("[design.bodies]", "top = { at = [\"0 mm\", \"75 mm\"] }\n[design.bodies]");
    let drawn = solve(&text, &[]);
    for metric in ["force_at_end", "energy_at_end", "mass", "stress_max", "stiffness_initial"] {
        same(&layers, &drawn, metric, 1.0, 1e-8);
    }
    near(layers.force(3e-3), drawn.force(3e-3), 1e-8, "force inside");
    let alone = solve(&laid_out("", "4 mm"), &[]);
    same(&layers, &alone, "stiffness_initial", 0.5, 1e-12);
    same(&layers, &alone, "force_at_end", 1.0, 1e-12);
}

/// The engine knows nothing of layers: drawn, they are a network whose states become unstable where the force of a layer is largest. So
/// does the stack, which knows only the curve of one.
#[test]
fn layers_part_where_the_drawn_network_branches() {
    let travel = "24 mm";
    let one = solve(&laid_out("", "12 mm"), &[]);
    let peak = one.get("force_local_max_at");
    assert!(peak > 1e-3 && peak < 11e-3, "the leg has a maximum inside: {peak}");
    let layers = solve(&laid_out("series = 2", travel), &[]);
    let parted = layers.behaviour.stack.as_ref().and_then(|s| s.apart_from_m).expect("they part");
    assert!((parted / (2.0 * peak) - 1.0).abs() < 0.03, "{parted} {peak}");
    let bodies = "lower = { nodes = [\"block\", \"foot2\"], support = \"slider\", direction = [0, 1] }\nupper = { nodes = [\"block2\", \"top\"], support = \"slider\", direction = [0, 1] }";
    let text = drawn(bodies, "", "block2", travel).replace("[design.bodies]", "top = { at = [\"0 mm\", \"75 mm\"] }\n[design.bodies]");
    let drawn = solve(&text, &[]);
    let from = drawn.behaviour.unstable_from_m.expect("it branches");
    near(from, 2.0 * peak, 1e-4, "where the drawn layers branch");
    let codes: Vec<&str> = outcome(&laid_out("series = 2", travel), &[]).warnings.iter().map(|w| w.code).collect();
    assert!(codes.contains(&"W0514"), "{codes:?}");
}

#[test]
fn layers_are_required_to_move_alike() {
    let asked = |travel: &str| {
        laid_out("series = 3", travel).replace("[material]", "[requirements]\nstiffness = { min = \"-100 N/mm\" }\n[material]")
    };
    let missed = outcome(&asked("36 mm"), &[]);
    let check = missed.checks.iter().find(|c| c.code == "COMP008").expect("checked");
    assert!(check.value.is_some_and(|v| v < 36e-3) && check.margin.is_some_and(|m| m < 0.0));
    let met = outcome(&asked("3 mm"), &[]);
    assert!(met.checks.iter().any(|c| c.code == "COMP008" && c.margin.is_some_and(|m| m >= 0.0)));
    assert!(!outcome(&laid_out("plates = 3", "6 mm"), &[]).checks.iter().any(|c| c.code == "COMP008"));
}

/// Two planes at an angle of 2π/n: their inner edges, at the inner radius and half the depth, are 2(r sin(π/n) − (t/2) cos(π/n)) apart.
#[test]
fn planes_around_an_axis_meet_inside() {
    // The axis 4 mm beside the block; the leg's inner end is 0.5 mm nearer by half its thickness, and bulges no further.
    let solved = solve(&laid_out("circular = { count = 4, radius = \"14 mm\" }", "1 mm"), &[]);
    let circle = solved.design.layout.circle.expect("a circle");
    assert_eq!((circle.axis_m, circle.outward), ([-14e-3, 20e-3], [1.0, 0.0]));
    let half = std::f64::consts::FRAC_PI_4;
    let inner = solved.behaviour.path.points.iter().flat_map(|p| (0..=2000).map(|i| p.beams[0].shape_m(f64::from(i) / 2000.0)[0]));
    let inner_m = inner.fold(f64::INFINITY, f64::min) + 14e-3 - 0.5e-3;
    let gap = 2.0 * (inner_m * maths::sin(half) - 5e-3 * maths::cos(half));
    close(solved.get("clearance_min"), gap, 1e-8, "gap");
    // Too near to the axis they overlap.
    let tight = laid_out("circular = { count = 8, radius = \"8 mm\" }", "1 mm");
    assert!(solve(&tight, &[]).get("clearance_min") < 0.0);
    let warned = |text: &str| outcome(text, &[]).warnings.iter().any(|w| w.code == "W0515");
    assert!(warned(&tight) && warned(&laid_out("array = { count = 2, spacing = \"0.5 mm\" }", "1 mm")));
    assert!(!warned(&laid_out("array = { count = 2, spacing = \"40 mm\" }", "1 mm")));
}

#[test]
fn copies_that_cannot_be_are_refused() {
    let codes = |text: &str| {
        let (found, diagnostics) = understand(text, &[]);
        assert!(found.is_none());
        diagnostics.in_file_order().iter().map(|d| d.code).collect::<Vec<_>>()
    };
    let free = |layout: &str| laid_out(layout, "6 mm").replace(", support = \"slider\", direction = [0, 1]", "");
    for layout in ["plates = 2", "series = 2", "array = { count = 2, spacing = \"40 mm\" }", "circular = { count = 3, radius = \"5 mm\" }"]
    {
        assert_eq!(codes(&free(layout)), ["E0516"], "{layout}");
        assert!(design(&laid_out(layout, "6 mm"), &[]).copies() * design(&laid_out(layout, "6 mm"), &[]).layers() > 1.0);
    }
    let circular = "circular = { count = 3, radius = \"5 mm\" }";
    assert_eq!(codes(&laid_out(&format!("{circular}\nmirror = \"x = -5 mm\""), "6 mm")), ["E0517"]);
    assert_eq!(codes(&laid_out(&format!("{circular}\narray = {{ count = 2, spacing = \"40 mm\" }}"), "6 mm")), ["E0517"]);
    assert_eq!(codes(&laid_out("array = { count = 1, spacing = \"40 mm\" }", "6 mm")), ["E0204"]);
    assert_eq!(codes(&laid_out("plates = 0", "6 mm")), ["E0204"]);
}

#[test]
fn what_is_written_once_is_the_same_as_nothing() {
    let plain = solve(LEG, &[]);
    let once = solve(&laid_out("plates = 1\nseries = 1", "6 mm"), &[]);
    assert_eq!(plain.get("force_at_end").to_bits(), once.get("force_at_end").to_bits());
    assert!(matches!(plain.behaviour.path.status, Status::Complete));
}

/// What the picture does not look at is drawn beside it: every plane, seen along the load, at equal angles. The block's slider is where it
/// has come to.
#[test]
fn planes_are_seen_along_the_load() {
    let items = |layout: &str| {
        let design = design(&laid_out(layout, "6 mm"), &[]);
        let figures = Compliant::analyse(&design, &mut |_| true).figures;
        let scene = figures.into_iter().find_map(|f| if let FigureContent::Scene(scene) = f.content { Some(scene) } else { None });
        scene.expect("a picture").items
    };
    let planes = |layout: &str| {
        let middle = |corners: &[[f64; 2]]| [0, 1].map(|k| corners.iter().map(|p| p[k]).sum::<f64>() / corners.len() as f64);
        let of = |item: &Item| match item {
            Item::Body { corners, role: Role::Plane | Role::PlaneCopy } => Some(middle(corners)),
            _ => None,
        };
        items(layout).iter().filter_map(of).collect::<Vec<_>>()
    };
    assert!(planes("").is_empty() && planes("array = { count = 2, spacing = \"40 mm\" }").is_empty());
    assert_eq!(planes("plates = 3").len(), 3);
    assert_eq!(planes("plates = 2\ncircular = { count = 4, radius = \"5 mm\" }").len(), 8);
    let five = planes("circular = { count = 5, radius = \"5 mm\" }");
    assert_eq!(five.len(), 5);
    let centre = [0, 1].map(|k| five.iter().map(|p| p[k]).sum::<f64>() / 5.0);
    let away = |p: &[f64; 2]| maths::hypot(p[0] - centre[0], p[1] - centre[1]);
    assert!(five.iter().all(|p| (away(p) / away(&five[0]) - 1.0).abs() < 1e-9) && away(&five[0]) > 1e-3);
    let block = items("").iter().find_map(|i| match i {
        Item::Support { at, kind: SupportKind::Slider { .. }, .. } => Some(*at),
        _ => None,
    });
    let at = block.expect("a slider");
    assert!(at[0].abs() < 1e-12 && (at[1] - 14e-3).abs() < 1e-9, "{at:?}");
}
