//! What studies are asked for, and which numbers they may change.

use forcewright_base::diagnostics::Diagnostics;
use forcewright_contract::studies::Free;

use crate::toy::read_text;

const DESIGN: &str = r#"
schema = 1
mechanism = "toy"
[design]
thickness = "1 mm"
friction = 0.3
[design.nodes]
n1 = { at = ["1 mm", "2 mm"] }
n2 = { at = ["3 mm", "4 mm"] }
[[design.beams]]
name = "b1"
between = ["n1", "n2"]
bend = [1.5, -0.25]
[load]
travel = "3 mm"
[optimise]
objective = { minimise = "mass" }
[optimise.variables]
"#;

/// What may change, as `path: lower..upper`, and what was said about it: code, the text at its place, its help.
fn free(variables: &str) -> (Vec<Free>, Vec<(String, String, String)>) {
    let text = format!("{DESIGN}{variables}");
    let mut reading = read_text(&text);
    assert!(reading.found.is_empty(), "{}", reading.shown);
    let numbers = reading.numbers();
    let mut diagnostics = Diagnostics::default();
    let free = reading.toy.studies.optimise.free(&numbers, &mut diagnostics);
    let said = diagnostics.in_file_order().into_iter().map(|d| {
        let span = d.span.expect("a place");
        (d.code.to_owned(), text[span.start..span.end].to_owned(), d.help.clone().expect("a way out"))
    });
    (free, said.collect())
}

/// The freedoms of variables that are in order, in mm.
fn millimetres(variables: &str) -> Vec<(String, f64, f64)> {
    let (free, said) = free(variables);
    assert!(said.is_empty(), "{said:?}");
    free.into_iter().map(|f| (f.number.path, (f.lower * 1e6).round() / 1e3, (f.upper * 1e6).round() / 1e3)).collect()
}

#[test]
fn a_pattern_frees_every_number_that_it_means_in_the_order_of_the_design() {
    let all = millimetres("\"design.nodes.*.at\" = { within = \"1 mm\" }\n\"design.thickness\" = { range = [\"0.5 mm\", \"1.5 mm\"] }\n");
    let wanted = [
        ("design.thickness", 0.5, 1.5),
        ("design.nodes.n1.at.x", 0.0, 2.0),
        ("design.nodes.n1.at.y", 1.0, 3.0),
        ("design.nodes.n2.at.x", 2.0, 4.0),
        ("design.nodes.n2.at.y", 3.0, 5.0),
    ];
    assert_eq!(all, wanted.map(|(p, l, u)| (p.to_owned(), l, u)));
}

#[test]
fn the_later_pattern_wins() {
    let all = millimetres("\"design.nodes\" = { within = \"1 mm\" }\n\"design.nodes.n*.at.y\" = { within = \"0.5 mm\" }\n");
    assert_eq!(all.len(), 4);
    assert_eq!(all[1], ("design.nodes.n1.at.y".to_owned(), 1.5, 2.5));
    assert_eq!(all[2], ("design.nodes.n2.at.x".to_owned(), 2.0, 4.0));
}

#[test]
fn bare_numbers_have_bare_ranges() {
    let (free, said) = free("\"design.beams.*.bend\" = { range = [-3, 3] }\n\"design.friction\" = { within = \"10 %\" }\n");
    assert!(said.is_empty(), "{said:?}");
    let found: Vec<_> = free.iter().map(|f| (f.number.path.as_str(), f.lower, f.upper)).collect();
    assert_eq!(found[0].0, "design.friction");
    assert!((found[0].1 - 0.2).abs() < 1e-15 && (found[0].2 - 0.4).abs() < 1e-15, "{found:?}");
    assert_eq!(found[1..], [("design.beams.b1.bend.1", -3.0, 3.0), ("design.beams.b1.bend.2", -3.0, 3.0)]);
}

#[test]
fn a_freedom_stays_within_what_the_parameter_can_mean() {
    let (free, said) = free("\"design.thickness\" = { within = \"5 mm\" }\n\"design.friction\" = { range = [-1, 5] }\n");
    assert!(said.is_empty(), "{said:?}");
    // Zero itself is excluded.
    assert!(free[0].lower > 0.0 && free[0].lower < 1e-5 && free[0].upper > 5.9e-3, "{free:?}");
    assert!(free[1].lower.abs() <= 0.0 && (free[1].upper - 1.0).abs() <= 0.0, "{free:?}");
}

/// Sizes around values, in mm.
fn around(variables: &str, values: &[f64]) -> Vec<Vec<f64>> {
    let mut reading = read_text(&format!("{DESIGN}{variables}"));
    assert!(reading.found.is_empty(), "{}", reading.shown);
    let numbers = reading.numbers();
    let mut diagnostics = Diagnostics::default();
    let sized = reading.toy.studies.optimise.sized(&numbers, &mut diagnostics);
    assert!(sized.len() == 1 && sized[0].path == "design.thickness" && !diagnostics.has_errors());
    let millimetres = |si: &f64| (si * 1e9).round() / 1e6;
    values.iter().map(|v| sized[0].around(v * 1e-3).iter().map(millimetres).collect()).collect()
}

#[test]
fn sizes_lie_around_a_value_and_end_where_the_range_does() {
    // 0.55, 0.75, …, 1.35: the last step would end beyond 1.5.
    let steps =
        "\"design.friction\" = { range = [0.1, 0.5] }\n\"design.thickness\" = { range = [\"0.55 mm\", \"1.5 mm\"], step = \"0.2 mm\" }\n";
    let found = around(steps, &[0.5, 0.55, 0.6, 0.749_999_99, 0.95, 1.36, 1.5, 9.0]);
    let wanted: [&[f64]; 8] = [&[0.55], &[0.55], &[0.55, 0.75], &[0.75], &[0.95], &[1.35], &[1.35], &[1.35]];
    assert_eq!(found, wanted);
    let list = "\"design.thickness\" = { among = [\"1.2 mm\", \"0.5 mm\", \"0.8 mm\"] }\n";
    assert_eq!(millimetres(list), [("design.thickness".to_owned(), 0.5, 1.2)]);
    let found = around(list, &[0.1, 0.5, 0.6, 0.8, 1.0, 1.2, 2.0]);
    let wanted: [&[f64]; 7] = [&[0.5], &[0.5], &[0.5, 0.8], &[0.8], &[0.8, 1.2], &[1.2], &[1.2]];
    assert_eq!(found, wanted);
}

#[test]
fn what_is_wrong_is_said_at_its_place() {
    for (variables, code, place, help) in [
        ("\"design.thicknes\" = { within = \"1 mm\" }", "E0312", "\"design.thicknes\"", "did you mean `design.thickness`?"),
        ("\"design.beams.zz.bend\" = { within = 1 }", "E0312", "\"design.beams.zz.bend\"", "`design"),
        ("\"load.travel\" = { within = \"1 mm\" }", "E0312", "\"load.travel\"", "only numbers below `design` take part"),
        ("\"load\" = { within = \"1 mm\" }", "E0312", "\"load\"", "only numbers below `design`"),
        ("\"design.thickness\" = {}", "E0302", "\"design.thickness\"", "either `range"),
        ("\"design.thickness\" = { range = [\"1 mm\", \"2 mm\"], within = \"1 mm\" }", "E0302", "\"design.thickness\"", "either `range"),
        ("\"design.thickness\" = { range = [\"2 mm\", \"0.5 mm\"] }", "E0204", "[\"2 mm\", \"0.5 mm\"]", "low"),
        ("\"design.thickness\" = { range = [\"0.5 mm\"] }", "E0204", "[\"0.5 mm\"]", "low"),
        ("\"design.thickness\" = { range = [\"2 mm\", \"3 mm\"] }", "E0204", "[\"2 mm\", \"3 mm\"]", "starts at the value in the file"),
        ("\"design.thickness\" = { within = \"-1 mm\" }", "E0204", "\"-1 mm\"", "within = "),
        ("\"design.thickness\" = { within = [\"1 mm\", \"2 mm\"] }", "E0204", "[\"1 mm\", \"2 mm\"]", "within = "),
        ("\"design.thickness\" = { within = \"1 N\" }", "E0201", "\"1 N\"", "mm"),
        ("\"design.thickness\" = { within = 1 }", "E0208", "1", "unit"),
        ("\"design.thickness\" = { range = [0.5, 1.5] }", "E0208", "0.5", "unit"),
    ] {
        let (free, said) = free(variables);
        assert!(free.is_empty(), "{variables}: {free:?}");
        let [(found, at, way_out)] = &said[..] else { panic!("{variables}: {said:?}") };
        assert_eq!((found.as_str(), at.as_str()), (code, place), "{variables}");
        assert!(way_out.contains(help), "{variables}: {way_out}");
    }
}

#[test]
fn the_sections_are_read_like_any_other() {
    let mut reading = read_text(
        "schema = 1\nmechanism = \"toy\"\n[design]\nthickness = \"1 mm\"\n[tolerance]\nsamples = 128\ntarget = \"90 %\"\n\
         [tolerance.parameters]\n\"design.thickness\" = { half_width = \"10 µm\", distribution = \"uniform\" }\n\
         [tolerance.groups]\nplate = { members = [\"design.thickness\", \"design.depth\"], correlation = 1 }\n",
    );
    assert!(reading.found.is_empty(), "{}", reading.shown);
    for (path, value) in [
        ("tolerance.samples", "128"),
        ("tolerance.seed", "1"),
        ("tolerance.target", "90 %"),
        ("tolerance.distribution", "normal"),
        ("tolerance.groups.plate.correlation", "1"),
    ] {
        assert_eq!(reading.row(path), value, "{path}");
    }
    assert_eq!(reading.toy.studies.tolerance.parameters[0].name.value, "design.thickness");
    for (wrong, code) in [
        ("[tolerance]\nsamples = 10\n", "E0204"),
        ("[tolerance]\ndistribution = \"gauss\"\n", "E0303"),
        ("[tolerance]\ntarget = 1\n", "E0204"),
        ("[tolerance.groups]\ng = { members = [\"a\"], correlation = 2 }\n", "E0204"),
        ("[tolerance.groups]\ng = { members = [\"a\"] }\n", "E0302"),
        ("[optimise]\n[optimise.variables]\n\"design.thickness\" = { within = \"1 mm\" }\n", "E0302"),
        ("[optimise]\nobjective = { minimise = \"x\" }\n", "E0302"),
        ("[optimise]\nobjective = { minimise = \"x\" }\nvariables = {}\nstarts = 0\n", "E0204"),
    ] {
        let reading = read_text(&format!("schema = 1\nmechanism = \"toy\"\n[design]\nthickness = \"1 mm\"\n{wrong}"));
        assert!(reading.found.iter().any(|f| f.starts_with(code)), "{wrong}: {:?}", reading.found);
    }
}
