//! The same mechanism written in many ways gives the same bits.

mod common;
#[path = "common/drawing.rs"]
mod drawing;

use std::path::Path;

use common::{NODES, design, understand, understand_variant};
use drawing::Drawing;
use forcewright_base::diagnostics::Diagnostics;
use forcewright_compliant::{Compliant, Design, Spec};
use forcewright_contract::family::Mechanism;
use forcewright_contract::project::{Choices, FileError, Files, Project};
use forcewright_contract::read;

/// Everything computed, to the last bit: metrics, curves, values of checks.
fn bits(design: &Design) -> Vec<(String, u64)> {
    let outcome = Compliant::analyse(design, &mut |_| true).outcome;
    assert!(outcome.metric("force_at_end").is_some(), "{:?}", outcome.status);
    let mut all: Vec<(String, u64)> = outcome.metrics.iter().map(|m| (m.name.to_owned(), m.value.to_bits())).collect();
    for curve in &outcome.curves {
        for branch in &curve.branches {
            all.extend(branch.x.iter().chain(&branch.y).map(|v| (curve.name.to_owned(), v.to_bits())));
        }
    }
    for check in &outcome.checks {
        all.extend([check.value, check.limit, check.margin].into_iter().flatten().map(|v| (check.name.clone(), v.to_bits())));
    }
    all
}

#[track_caller]
fn same(a: &Design, b: &Design, what: &str) {
    let (a, b) = (bits(a), bits(b));
    assert_eq!(a.len(), b.len(), "{what}");
    for (a, b) in a.iter().zip(&b) {
        assert_eq!(a, b, "{what}: {} {}", f64::from_bits(a.1), f64::from_bits(b.1));
    }
}

/// The text with replacements that must all be found.
fn replaced(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

#[test]
fn order_of_nodes_and_beams() {
    let a = design(&Drawing::table3().text(), &[]);
    for turn in 1..5 {
        let mut drawing = Drawing::table3();
        drawing.nodes.rotate_left(turn);
        drawing.beams.rotate_left(turn % 4);
        drawing.nodes.swap(0, 2);
        drawing.beams.swap(1, 3);
        assert!(drawing.text() != Drawing::table3().text());
        same(&design(&drawing.text(), &[]), &a, "order");
    }
}

#[test]
fn decimal_units() {
    let a = design(NODES, &[]);
    for (changes, what) in [
        (&[("\"2.5 mm\"", "\"0.25 cm\""), ("\"18.77 mm\"", "\"1.877 cm\""), ("\"12.44 mm\"", "\"12440 µm\"")][..], "nodes"),
        (&[("\"34.5 mm\"", "\"0.0345 m\""), ("\"40 mm\"", "\"4e1 mm\""), ("\"24 mm\"", "\"+24.0mm\"")], "nodes"),
        (&[("1 mm ± 0.02 mm", "0.1 cm ± 0.2 mm"), ("\"10 mm\" ", "\"1 cm\" ")], "section"),
        (&[("\"13.6 mm\"", "\"1.36 cm\""), ("\"6 mm\"", "\"0.6 cm\""), ("-0.05 N/mm", "-50 N/m")], "travel"),
        (&[("\"2 GPa\"", "\"2000 MPa\""), ("\"76 MPa\"", "\"0.076 GPa\"")], "stresses"),
        (&[("\"2 GPa\"", "\"2000 N/mm^2\""), ("\"76 MPa\"", "\"76 N/mm^2\"")], "stresses"),
        (&[("\"2 GPa\"", "\"2 kN/mm^2\""), ("\"76 MPa\"", "\"7600 N/cm^2\"")], "stresses"),
        (&[("\"9.7 N\"", "\"0.0097 kN\""), ("\"5 %\"", "0.05")], "force"),
        (&[("direction = [0, -1]", "direction = [0, -40.0]"), ("direction = [0, 1]", "direction = [0, 0.1]")], "directions"),
    ] {
        same(&design(&replaced(NODES, changes), &[]), &a, what);
    }
}

#[test]
fn inches_are_exact() {
    // 1 in = 25.4 mm by definition.
    let inches = replaced(NODES, &[("\"2.5 mm\"", "\"0.5 in\""), ("\"13.6 mm\"", "\"0.5 in\""), ("\"6 mm\"", "\"0.25 in\"")]);
    let metric = replaced(NODES, &[("\"2.5 mm\"", "\"12.7 mm\""), ("\"13.6 mm\"", "\"12.7 mm\""), ("\"6 mm\"", "\"6.35 mm\"")]);
    let (a, b) = (design(&inches, &[]), design(&metric, &[]));
    // Typed in inches, a length is a product: it may differ from the decimal by one unit of the last place.
    let near = |a: f64, b: f64| (a / b - 1.0).abs() <= f64::EPSILON;
    assert!(near(a.load_end, b.load_end) && near(a.network.nodes[0].position_m[0], b.network.nodes[0].position_m[0]));
    let (a, b) = (bits(&a), bits(&b));
    for (a, b) in a.iter().zip(&b).filter(|(a, _)| a.0 == "force_at_end" || a.0 == "force") {
        let (a, b) = (f64::from_bits(a.1), f64::from_bits(b.1));
        assert!((a - b).abs() <= 1e-12 * 10.0, "{a} {b}");
    }
}

#[test]
fn variant_set_and_merged_text() {
    let merged = design(&replaced(NODES, &[("\"1 mm ± 0.02 mm\"", "\"0.85 mm\""), ("\"13.6 mm\"", "\"15 mm\"")]), &[]);
    let set = design(NODES, &["design.thickness=0.85 mm", "load.travel=15 mm"]);
    same(&set, &merged, "--set");
    let with_variant = format!("{NODES}\n[variants.slim]\ndesign.thickness = \"0.85 mm\"\nload.travel = \"15 mm\"\n");
    let (variant, diagnostics) = understand_variant(&with_variant, Some("slim"), &[]);
    assert!(diagnostics.is_empty());
    same(&variant.unwrap(), &merged, "--variant");
    // The command line wins over the variant, and the later setting over the earlier.
    let (both, _) = understand_variant(&with_variant, Some("slim"), &["load.travel=1 mm", "load.travel=13.6 mm"]);
    same(&both.unwrap(), &design(NODES, &["design.thickness=0.85 mm"]), "both");
    // A variant that is not chosen changes nothing.
    same(&design(&with_variant, &[]), &design(NODES, &[]), "not chosen");
    // Members of lists by name.
    let bend = design(NODES, &["design.beams.b4.bend=[0.3, -1.2]", "design.nodes.n3.at=[\"30 mm\", \"19 mm\"]"]);
    let typed = replaced(NODES, &[("[0.226, -1.148]", "[0.3, -1.2]"), ("[\"30.5 mm\", \"18.77 mm\"]", "[\"30 mm\", \"19 mm\"]")]);
    same(&bend, &design(&typed, &[]), "members by name");
}

struct Memory(Vec<(&'static str, String)>);

impl Files for Memory {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        self.0.iter().find(|(name, _)| Path::new(name) == path).map(|(_, text)| text.clone()).ok_or(FileError::NotFound)
    }
}

#[test]
fn a_file_that_extends_another() {
    let child = "extends = \"base.toml\"\n[design]\nthickness = \"0.85 mm\"\n[[design.beams]]\nname = \"b4\"\nbend = [0.3, -1.2]\n";
    let files = Memory(vec![("base.toml", NODES.to_owned()), ("child.toml", child.to_owned())]);
    let mut project = Project::load(&files, Path::new("child.toml"), &Choices::default());
    let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    let extended = Compliant::resolve(&mut spec, &mut project.diagnostics).unwrap();
    assert!(!project.diagnostics.has_errors());
    let typed = replaced(NODES, &[("\"1 mm ± 0.02 mm\"", "\"0.85 mm\""), ("[0.226, -1.148]", "[0.3, -1.2]")]);
    same(&extended, &design(&typed, &[]), "extends");
}

#[test]
fn what_is_only_recorded_changes_no_number() {
    let a = design(NODES, &[]);
    // Tolerances, title, process, material words: none is part of the force analysis.
    same(&design(NODES, &["design.thickness=1 mm ± 0.5 mm"]), &a, "tolerance");
    same(&design(NODES, &["process.method=printing", "process.cutter_diameter=3 mm", "title=another"]), &a, "process");
}

#[test]
fn requirements_do_not_change_the_curve() {
    let curve = |set: &[&str]| {
        let outcome = Compliant::analyse(&design(NODES, set), &mut |_| true).outcome;
        outcome.curve("force").unwrap().branches[0].y.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(curve(&[]), curve(&["requirements.force.nominal=5 N", "requirements.travel=1 mm", "requirements.stress.safety_factor=9"]));
}

#[test]
fn written_defaults_are_the_defaults() {
    let a = design(NODES, &[]);
    same(&design(NODES, &["model.beam=reissner", "model.joints=point", "model.accuracy=1e-8"]), &a, "defaults");
    same(&design(NODES, &["design.nodes.n5.rotation=fixed", "design.beams.b1.straight=false"]), &a, "defaults");
    // The thickness of a beam is that of the design unless it has its own.
    let own: Vec<String> = (1..5).map(|i| format!("design.beams.b{i}.thickness=1 mm")).collect();
    let own: Vec<&str> = own.iter().map(String::as_str).chain(["design.thickness=3 mm"]).collect();
    same(&design(NODES, &own), &a, "own thickness");
}

#[test]
fn a_catalogue_entry_is_what_it_says() {
    let without: Vec<&str> = NODES.lines().filter(|l| !l.starts_with("use = ")).collect();
    let text = without.join("\n");
    let (missing, diagnostics) = understand(&text, &[]);
    assert!(missing.is_none(), "the shear stiffness needs Poisson's ratio");
    assert!(diagnostics.in_file_order().iter().any(|d| d.code == "E0302" && d.message.contains("poisson_ratio")));
    let found = forcewright_elements::materials::find("POM-C").unwrap();
    let nu = found.poisson_ratio.as_ref().unwrap().value;
    let density = found.density_kg_per_m3.as_ref().unwrap().value;
    let typed = design(&text, &[&format!("material.poisson_ratio={nu:?}"), &format!("material.density={density:?} kg/m^3")]);
    same(&typed, &design(NODES, &[]), "catalogue");
    let mut diagnostics = Diagnostics::default();
    diagnostics.append(understand(NODES, &[]).1);
    assert!(diagnostics.is_empty());
}
