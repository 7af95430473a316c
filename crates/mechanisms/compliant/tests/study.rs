//! The family seen by studies: what a number changes, derivatives, refusals. Changed numbers are compared with a project file that says
//! the same, derivatives with differences.

mod common;

use common::NODES;
use forcewright_base::diagnostics::Diagnostics;
use forcewright_compliant::Compliant;
use forcewright_contract::family::{Entry, Family, Understood};
use forcewright_contract::numbers::{Number, matches};
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::studies::{Free, Purpose};
use forcewright_study::evaluator::{Evaluation, Evaluator};

/// The start of a search in the paper's box, with everything that a task can limit, and a node on a line.
const BOX: &str = include_str!("../../../../examples/compliant/optimise-lan-box.toml");
/// A cantilever whose thickness is given at two places.
const TAPERED: &str = include_str!("../../../../examples/compliant/tapered-spring.toml");
/// Two parallel leaves between the ground and a rigid block.
const GUIDE: &str = include_str!("../../../../examples/compliant/parallel-guide.toml");

fn understood(text: &str, set: &[String]) -> Box<dyn Understood> {
    let choices = Choices { variant: None, set: set.to_vec() };
    let mut project = Project::from_text("test.toml", text, &choices);
    let found = Entry::<Compliant>::new().understand(&mut project);
    found.unwrap_or_else(|| panic!("{set:?}: {}", project.diagnostics.render(&project.sources, false)))
}

/// Freedoms: patterns with half widths, SI.
fn free(numbers: &[Number], patterns: &[(&str, f64)]) -> Vec<Free> {
    let width = |n: &Number| patterns.iter().find(|(p, _)| matches(p, &n.path)).map(|p| p.1);
    let all = numbers.iter().filter_map(|n| {
        let width = width(n)?;
        Some(Free { number: n.clone(), lower: n.si - width, upper: n.si + width })
    });
    let all: Vec<Free> = all.collect();
    assert!(patterns.iter().all(|(p, _)| all.iter().any(|f| matches(p, &f.number.path))), "{patterns:?}");
    all
}

fn evaluator(text: &str, patterns: &[(&str, f64)]) -> Box<dyn Evaluator> {
    let project = understood(text, &[]);
    let mut said = Diagnostics::default();
    let made = project.evaluator(&free(project.numbers(), patterns), &mut said);
    made.unwrap_or_else(|| panic!("{:?}", codes(&said)))
}

fn codes(diagnostics: &Diagnostics) -> Vec<(&'static str, String)> {
    diagnostics.in_file_order().into_iter().map(|d| (d.code, d.message.clone())).collect()
}

fn values(evaluator: &dyn Evaluator, x: &[f64]) -> Vec<f64> {
    let mut out = Evaluation::default();
    evaluator.evaluate(x, false, &mut out, &mut evaluator.workspace()).expect("a design with values");
    out.values
}

fn nominal(evaluator: &dyn Evaluator) -> Vec<f64> {
    evaluator.variables().iter().map(|v| v.nominal).collect()
}

/// Numbers from −1 to 1 that look random: `SplitMix64`.
struct Seeded(u64);

impl Seeded {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A design around the nominal one, inside a part of its freedom, and away from its ends.
    fn near(&mut self, evaluator: &dyn Evaluator, part: f64) -> Vec<f64> {
        let of = |low: f64, high: f64, at: f64, r: f64| {
            let at = at.clamp(0.95 * low + 0.05 * high, 0.05 * low + 0.95 * high);
            if r < 0.0 { at + r * part * (at - low) } else { at + r * part * (high - at) }
        };
        evaluator.variables().iter().map(|v| of(v.lower, v.upper, v.nominal, self.next())).collect()
    }
}

/// Compares the Jacobian with differences of fourth order, each output relative to the most that a whole freedom changes any of its values.
#[track_caller]
fn derivatives_are_right(evaluator: &dyn Evaluator, x: &[f64], step: f64, allowed: impl Fn(&str) -> f64) {
    let (variables, mut workspace) = (evaluator.variables(), evaluator.workspace());
    let mut own = Evaluation::default();
    evaluator.evaluate(x, true, &mut own, &mut workspace).expect("a design with values");
    let (rows, columns) = (own.values.len(), variables.len());
    assert_eq!(own.jacobian.len(), rows * columns);
    let mut differences = vec![0.0; rows * columns];
    for (column, variable) in variables.iter().enumerate() {
        let h = step * variable.scale();
        for (times, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
            let mut moved = x.to_vec();
            moved[column] += times * h;
            let mut there = Evaluation::default();
            evaluator.evaluate(&moved, false, &mut there, &mut workspace).expect("a design with values");
            for (row, value) in there.values.iter().enumerate() {
                differences[row * columns + column] += weight * value / (12.0 * h);
            }
        }
    }
    for output in evaluator.outputs() {
        let scaled = |all: &[f64], row: usize, column: usize| all[row * columns + column] * variables[column].scale();
        let places = || output.values.clone().flat_map(|row| (0..columns).map(move |column| (row, column)));
        let largest = places().map(|(r, c)| scaled(&differences, r, c).abs()).fold(0.0, f64::max);
        let wrong =
            |&(r, c): &(usize, usize)| (scaled(&own.jacobian, r, c) - scaled(&differences, r, c)).abs() / largest.max(f64::MIN_POSITIVE);
        let worst = places().max_by(|a, b| wrong(a).total_cmp(&wrong(b))).expect("a value");
        assert!(
            wrong(&worst) <= allowed(&output.name),
            "{} [{}] = {:e} by {}: {:.3e} of the largest off ({:e}, differences {:e})",
            output.name,
            worst.0 - output.values.start,
            own.values[worst.0],
            variables[worst.1].path,
            wrong(&worst),
            scaled(&own.jacobian, worst.0, worst.1),
            scaled(&differences, worst.0, worst.1),
        );
    }
}

const FREEDOMS: &[(&str, f64)] = &[
    ("design.thickness", 0.05e-3),
    ("design.depth", 0.5e-3),
    ("design.nodes.n3.at", 1e-3),
    ("design.nodes.n4.at", 1e-3),
    ("design.beams.*.bend", 0.1),
    ("material.young_modulus", 1e8),
    ("material.poisson_ratio", 0.05),
];

#[test]
fn derivatives_of_the_curve_are_right() {
    let evaluator = evaluator(NODES, FREEDOMS);
    let mut seeded = Seeded(1);
    for _ in 0..5 {
        let x = seeded.near(evaluator.as_ref(), 0.6);
        // The largest stress jumps from place to place: its derivative does too.
        derivatives_are_right(evaluator.as_ref(), &x, 0.04, |name| match name {
            "force" => 1e-3,
            "stiffness" => 5e-2,
            _ => 0.5,
        });
    }
}

#[test]
fn derivatives_of_the_search_are_right() {
    let project = understood(BOX, &["requirements.limits.mass.max=1 kg".to_owned(), "model.accuracy=1e-6".to_owned()]);
    let mut said = Diagnostics::default();
    let chosen = project.studies().optimise.free(project.numbers(), &mut said);
    let task = project.task(&chosen, Purpose::Search, &mut said).unwrap();
    assert!(said.is_empty(), "{:?}", codes(&said));
    let evaluator = task.evaluator.as_ref();
    let names: Vec<&str> = evaluator.outputs().iter().map(|o| o.name.as_str()).collect();
    let (before, places) = names.split_at(7);
    assert_eq!(before, ["window force", "window length", "stiffness", "stress", "envelope margin", "length ratio", "mass"]);
    assert_eq!(places, ["clearance", "clearance of the mirrored half"]);
    let (mut seeded, mut compared, mut crossed) = (Seeded(2), 0, 0);
    while compared < 6 || crossed < 2 {
        let x = seeded.near(evaluator, 0.3);
        let mut out = Evaluation::default();
        if evaluator.evaluate(&x, false, &mut out, &mut evaluator.workspace()).is_err() {
            continue;
        }
        // Where the axes of two beams cross, the way to where they do not is differentiated.
        let clearance = evaluator.outputs()[7].values.clone();
        crossed += usize::from(out.values[clearance].iter().any(|gap| *gap < -1e-3));
        derivatives_are_right(evaluator, &x, 1e-4, |name| if name == "stiffness" { 5e-2 } else { 1e-3 });
        compared += 1;
    }
}

/// The evaluator at a changed number against the project whose file says so.
#[track_caller]
fn says_the_same(text: &str, path: &str, factor: f64) {
    let project = understood(text, &[]);
    let number = project.numbers().iter().find(|n| n.path == path).unwrap_or_else(|| panic!("no {path}"));
    let si = if number.si.abs() > 0.0 { number.si * factor } else { factor - 1.0 };
    let before = evaluator(text, &[(path, 0.5 * number.si.abs() + 0.5)]);
    let found = values(before.as_ref(), &[si]);
    let unit = number.unit.symbol();
    let written = if unit == "1" || unit.is_empty() { format!("{si:e}") } else { format!("{:e} {unit}", number.unit.from_si(si)) };
    // One value of a pair of place and value.
    let key = if path.contains(".thickness.") { format!("{path}.2") } else { path.to_owned() };
    let changed = understood(text, &[format!("{key}={written}")]);
    let mut said = Diagnostics::default();
    let other = changed.evaluator(&[], &mut said).expect("an evaluator");
    let wanted = values(other.as_ref(), &[]);
    let size = wanted[..41].iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    for (a, b) in found[..41].iter().zip(&wanted) {
        assert!((a - b).abs() <= 2e-5 * size, "{path}: {a} instead of {b}");
    }
    // The change is felt, so that the comparison says something.
    let unchanged = values(before.as_ref(), &nominal(before.as_ref()));
    assert!(unchanged[..41].iter().zip(&wanted).any(|(a, b)| (a - b).abs() > 1e-3 * size), "{path} changes nothing");
}

#[test]
fn a_changed_number_is_that_of_a_file_that_says_so() {
    for path in [
        "design.thickness",
        "design.depth",
        "design.nodes.n2.at.x",
        "design.nodes.n3.at.x",
        "design.nodes.n3.at.y",
        "design.nodes.n4.at.y",
        "design.beams.b1.bend.1",
        "design.beams.b3.bend.2",
        "material.young_modulus",
    ] {
        says_the_same(NODES, path, 1.03);
    }
}

#[test]
fn tapered_places_and_arcs() {
    for path in ["design.beams.leaf.thickness.1", "design.beams.leaf.thickness.2", "material.young_modulus"] {
        says_the_same(TAPERED, path, 1.1);
    }
    let arc = TAPERED.replace("straight = true", "arc = \"0.4 rad\"");
    says_the_same(&arc, "design.beams.leaf.arc", 1.2);
}

#[test]
fn beams_with_their_own_thickness_do_not_follow() {
    let text = NODES.replace("name = \"b2\"\n", "name = \"b2\"\nthickness = \"0.9 mm\"\n");
    says_the_same(&text, "design.thickness", 1.05);
    says_the_same(&text, "design.beams.b2.thickness", 1.05);
    // Where every beam has its own, none is left.
    let mut all = NODES.to_owned();
    for beam in ["b1", "b2", "b3", "b4"] {
        all = all.replace(&format!("name = \"{beam}\"\n"), &format!("name = \"{beam}\"\nthickness = \"1 mm\"\n"));
    }
    refused(&all, "design.thickness", &[("E0313", "design.thickness")]);
}

#[test]
fn each_material_moves_its_own_beams() {
    let text = NODES.replace("name = \"b2\"\n", "name = \"b2\"\nmaterial = \"soft\"\n");
    let (head, tail) = text.split_once("[process]").unwrap_or_else(|| text.split_once("[design]").unwrap());
    let section = if text.contains("[process]") { "[process]" } else { "[design]" };
    let text = format!("{head}[material.soft]\nyoung_modulus = \"1 GPa\"\npoisson_ratio = 0.3\nyield_stress = \"40 MPa\"\n{section}{tail}");
    says_the_same(&text, "material.young_modulus", 1.05);
    says_the_same(&text, "material.soft.young_modulus", 1.05);
}

#[test]
fn overlapping_joints_follow_what_changes() {
    let text = format!("{NODES}\n[model]\njoints = \"overlap\"\n");
    let text = if NODES.contains("[model]") { NODES.replace("[model]\n", "[model]\njoints = \"overlap\"\n") } else { text };
    for path in ["design.thickness", "design.nodes.n3.at.x", "design.beams.b1.bend.1"] {
        says_the_same(&text, path, 1.05);
    }
}

#[test]
fn force_is_proportional_to_depth_and_to_youngs_modulus() {
    for (path, factor) in [("design.depth", 1.7), ("material.young_modulus", 0.6)] {
        let evaluator = evaluator(NODES, &[(path, 1e10)]);
        let x = nominal(evaluator.as_ref());
        let (one, other) = (values(evaluator.as_ref(), &x), values(evaluator.as_ref(), &[factor * x[0]]));
        let size = one[..82].iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        for (a, b) in one[..82].iter().zip(&other) {
            assert!((factor * a - b).abs() <= 1e-9 * size, "{path}: {a} {b}");
        }
        // Stress does not know the depth.
        let stress = if path == "design.depth" { 1.0 } else { factor };
        for (a, b) in one[82..].iter().zip(&other[82..]) {
            assert!((stress * a - b).abs() <= 1e-9 * a.abs(), "{path}: {a} {b}");
        }
    }
}

#[test]
fn a_node_on_a_line_moves_with_both_coordinates() {
    // A line at an angle; the node in its middle.
    let text = BOX.replace(
        "line = [[\"34.5 mm\", \"0 mm\"], [\"34.5 mm\", \"40 mm\"]]",
        "line = [[\"33.5 mm\", \"-2 mm\"], [\"35.5 mm\", \"2 mm\"]]",
    );
    let project = understood(&text, &[]);
    let mut said = Diagnostics::default();
    let chosen = free(project.numbers(), &[("design.nodes.n2.at", 40e-3), ("design.thickness", 0.1e-3)]);
    let task = project.task(&chosen, Purpose::Search, &mut said).unwrap();
    let evaluator = task.evaluator.as_ref();
    let line = evaluator.variables().iter().position(|v| v.path == "design.nodes.n2.at").unwrap();
    let variable = &evaluator.variables()[line];
    assert!((variable.nominal - 0.5).abs() < 1e-12 && variable.lower.abs() < 1e-12 && (variable.upper - 1.0).abs() < 1e-12, "{variable:?}");
    let mut x = nominal(evaluator);
    x[line] = 0.75;
    let numbers = evaluator.numbers(&x);
    let at = |path: &str| numbers.iter().find(|n| n.0 == path).unwrap().1;
    assert!((at("design.nodes.n2.at.x") - 35e-3).abs() < 1e-12 && (at("design.nodes.n2.at.y") - 1e-3).abs() < 1e-12, "{numbers:?}");
    assert!(numbers.iter().all(|n| n.0.contains('.') && project.numbers().iter().any(|known| known.path == n.0)), "{numbers:?}");
    // The design of a file that says so.
    let set = |axis: &str, value: &str| format!("design.nodes.n2.at.{axis}={value}");
    let other = understood(&text, &[set("x", "35 mm"), set("y", "1 mm")]);
    let there = other.task(&free(other.numbers(), &[("design.thickness", 0.1e-3)]), Purpose::Search, &mut said).unwrap();
    let found = values(evaluator, &x);
    let wanted = values(there.evaluator.as_ref(), &nominal(there.evaluator.as_ref()));
    let size = wanted.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    // Walls are looked at by places that move; what is asked of forces and stress is the same.
    let force = evaluator.outputs().iter().find(|o| o.name == "window force").unwrap().values.clone();
    for (a, b) in found[force.clone()].iter().zip(&wanted[force]) {
        assert!((a - b).abs() <= 1e-5 * size.min(100.0), "{a} {b}");
    }
    // The ranges of both coordinates hold: 0.5 mm in y are an eighth of the line.
    let narrow = free(project.numbers(), &[("design.nodes.n2.at.y", 0.5e-3)]);
    let task = project.task(&narrow, Purpose::Search, &mut said).unwrap();
    let variable = task.evaluator.variables().iter().find(|v| v.path == "design.nodes.n2.at").unwrap();
    assert!((variable.lower - 0.375).abs() < 1e-9 && (variable.upper - 0.625).abs() < 1e-9, "{variable:?}");
}

/// Asserts that studies of a number are refused, with codes and words of the messages.
#[track_caller]
fn refused(text: &str, pattern: &str, wanted: &[(&str, &str)]) {
    let project = understood(text, &[]);
    let chosen = free(project.numbers(), &[(pattern, 1e-4)]);
    let objective = project.studies().optimise.present.is_some();
    for task in [false, true] {
        let mut said = Diagnostics::default();
        let made = if task {
            project.task(&chosen, Purpose::Search, &mut said).is_some()
        } else {
            project.evaluator(&chosen, &mut said).is_some()
        };
        assert!(!made, "{pattern} is accepted");
        let found = codes(&said);
        let errors: Vec<_> = found.iter().filter(|(code, _)| code.starts_with('E')).collect();
        assert_eq!(errors.len(), wanted.len(), "{objective}: {found:?}");
        for ((code, message), want) in errors.into_iter().zip(wanted) {
            assert!(*code == want.0 && message.contains(want.1), "{found:?}");
        }
        assert!(said.in_file_order().iter().all(|d| d.help.is_some() || d.code.starts_with('W')));
    }
}

#[test]
fn what_cannot_vary_is_refused_with_its_reason() {
    let guide = understood(GUIDE, &[]);
    let paths: Vec<&str> = guide.numbers().iter().map(|n| n.path.as_str()).collect();
    // Which nodes the block has, from the file itself.
    let block = GUIDE.split_once("[design.bodies]").unwrap().1;
    let member = block.split('"').nth(1).unwrap();
    let path = format!("design.nodes.{member}.at.x");
    assert!(paths.contains(&path.as_str()), "{paths:?}");
    refused(GUIDE, &path, &[("E0313", &path)]);

    let line = "line = [[\"34.5 mm\", \"1 mm\"], [\"34.5 mm\", \"40 mm\"]]";
    let beside = BOX.replace("line = [[\"34.5 mm\", \"0 mm\"], [\"34.5 mm\", \"40 mm\"]]", line);
    // A search keeps to the line; the scatter of making does not.
    let off_line = |text: &str| {
        let project = understood(text, &[]);
        let mut said = Diagnostics::default();
        let chosen = project.studies().optimise.free(project.numbers(), &mut said);
        assert!(project.task(&chosen, Purpose::Search, &mut said).is_none());
        assert!(codes(&said).iter().any(|(code, message)| *code == "E0314" && message.contains("`n2`")), "{:?}", codes(&said));
    };
    off_line(&beside);
    let point = BOX
        .replace("line = [[\"34.5 mm\", \"0 mm\"], [\"34.5 mm\", \"40 mm\"]]", "line = [[\"34.5 mm\", \"0 mm\"], [\"34.5 mm\", \"0 mm\"]]");
    off_line(&point);

    let through = TAPERED.replace("straight = true", "through = [[\"30 mm\", \"3 mm\"]]");
    refused(&through, "design.nodes.tip.at.x", &[("E0313", "design.nodes.tip.at.x")]);
    refused(TAPERED, "load.travel", &[("E0313", "load.travel")]);

    let force = TAPERED.replace("travel = \"6 mm\"", "force = \"1 N\"");
    refused(&force, "design.depth", &[("E0316", "prescribes a displacement")]);
    let staged = TAPERED.replace("[load]\nnode", "[[load]]\nnode = \"tip\"\ndirection = [1, 0]\nforce = \"1 N\"\n[[load]]\nnode");
    refused(&staged, "design.depth", &[("E0316", "prescribes a displacement")]);
}

#[test]
fn objectives_that_are_none_are_refused() {
    for (objective, code) in [
        ("{ maximise = \"flat_rato\" }", "E0315"),
        ("{ minimise = \"flat_ratio\" }", "E0315"),
        ("{ maximise = \"stress_max\" }", "E0315"),
        ("{ minimise = \"stress_max\", maximise = \"flat_ratio\" }", "E0305"),
        ("{ window = [\"1 mm\", \"2 mm\"] }", "E0302"),
        ("{ minimise = \"force_ratio\" }", "E0302"),
        ("{ minimise = \"force_target\" }", "E0302"),
        ("{ minimise = \"force_target\", target = [[\"2 mm\", \"5 mm\"]] }", "E0201"),
        ("{ minimise = \"force_target\", target = [[\"20 mm\", \"5 N\"]] }", "E0204"),
        ("{ minimise = \"force_deviation\", window = [\"9 mm\", \"2 mm\"] }", "E0204"),
        ("{ minimise = \"force_deviation\", window = [\"9 mm\", \"20 mm\"] }", "E0204"),
        ("{ minimise = \"stress_max\", window = [\"2 mm\", \"9 mm\"] }", "E0305"),
    ] {
        let project = understood(&BOX.replace("{ maximise = \"flat_ratio\" }", objective), &[]);
        let mut said = Diagnostics::default();
        let chosen = project.studies().optimise.free(project.numbers(), &mut said);
        assert!(project.task(&chosen, Purpose::Search, &mut said).is_none(), "{objective}");
        assert!(codes(&said).iter().any(|(found, _)| *found == code), "{objective}: {:?}", codes(&said));
    }
}

#[test]
fn what_a_study_does_not_look_at_is_said() {
    let project = understood(BOX, &[]);
    let mut said = Diagnostics::default();
    project.evaluator(&free(project.numbers(), &[("design.thickness", 1e-5)]), &mut said).unwrap();
    let found = codes(&said);
    assert!(found.iter().all(|(code, _)| *code == "W0511"), "{found:?}");
    for name in ["envelope", "length_ratio_max", "clearance_min"] {
        assert!(found.iter().any(|(_, message)| message.contains(name)), "{name}: {found:?}");
    }
}

#[test]
fn a_design_is_a_pure_function_of_its_numbers() {
    let project = understood(BOX, &[]);
    let mut said = Diagnostics::default();
    let chosen = project.studies().optimise.free(project.numbers(), &mut said);
    let task = project.task(&chosen, Purpose::Search, &mut said).unwrap();
    let curve = evaluator(NODES, FREEDOMS);
    for (evaluator, derivatives) in [(task.evaluator.as_ref(), true), (curve.as_ref(), false)] {
        let mut seeded = Seeded(3);
        let designs: Vec<Vec<f64>> = (0..6).map(|_| seeded.near(evaluator, 0.3)).collect();
        let one = |x: &[f64], workspace: &mut _| {
            let mut out = Evaluation::default();
            evaluator.evaluate(x, derivatives, &mut out, workspace).map(|()| {
                let bits = |all: &[f64]| all.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
                (bits(&out.values), bits(&out.jacobian))
            })
        };
        let fresh: Vec<_> = designs.iter().map(|x| one(x, &mut evaluator.workspace())).collect();
        let mut workspace = evaluator.workspace();
        let backwards: Vec<_> = designs.iter().rev().map(|x| one(x, &mut workspace)).collect();
        let again: Vec<_> = designs.iter().map(|x| one(x, &mut workspace)).collect();
        assert!(fresh.iter().filter(|f| f.is_ok()).count() >= 3);
        assert!(fresh.iter().eq(backwards.iter().rev()) && fresh == again);
        // The values do not depend on whether derivatives are wanted.
        if let (Ok((bits, _)), true) = (&fresh[0], derivatives) {
            assert!(values(evaluator, &designs[0]).iter().map(|v| v.to_bits()).eq(bits.iter().copied()));
        }
    }
}

/// The mirrored half is as far away as twice the way to the line: from b1 and b4 that of their nodes at 2.5 mm, from b3 that of n4, from b2
/// that of n3; less the thickness of 1 mm.
#[test]
fn a_search_sees_the_mirrored_half() {
    let project = understood(BOX, &[]);
    let mut said = Diagnostics::default();
    let free = free(project.numbers(), &[("design.nodes.n4.at.*", 1e-3)]);
    let task = project.task(&free, Purpose::Search, &mut said).expect("a task");
    let all = values(task.evaluator.as_ref(), &nominal(task.evaluator.as_ref()));
    let mirrored = task.evaluator.outputs().iter().find(|o| o.name == "clearance of the mirrored half").expect("an output");
    for (found, wanted_mm) in all[mirrored.values.clone()].iter().zip([4.0, 59.0, 23.0, 4.0]) {
        assert!((found - 1e-3 * wanted_mm).abs() < 1e-9, "{found} m for {wanted_mm} mm");
    }
    let limit = task.limits.iter().find(|l| l.values == mirrored.values).expect("a limit");
    assert!(limit.checks == ["clearance_min"] && (limit.lower - 0.2e-3).abs() < 1e-12);
}
