//! Merging: what a file extends, its variants, and the settings of the command line.

use forcewright_contract::describe::Slot;
use forcewright_contract::edit::with_settings;

use crate::toy::{Reading, read_files, read_text};

const BASE: &str = r#"schema = 1
mechanism = "toy"
title = "base"
[design]
thickness = "1 mm ± 0.02 mm"
depth = "12 mm"
[design.nodes]
n1 = { at = ["1 mm", "2 mm"], support = "clamped" }
[[design.beams]]
name = "b1"
between = ["n1", "n2"]
bend = [1.0, 2.0]
[[design.beams]]
name = "b2"
between = ["n2", "n3"]
straight = true
[variants.thin]
design.thickness = "0.85 mm"
design.beams.b1.bend = [3.0]
[variants.many]
[[variants.many.design.beams]]
name = "b2"
thickness = "2 mm"
[[variants.many.design.beams]]
name = "b3"
between = ["n1", "n3"]
"#;

fn with(child: &str, variant: Option<&str>, set: &[&str]) -> Reading {
    let child = format!("extends = \"base.toml\"\n{child}");
    let mut reading = read_files(&[("a.toml", &child), ("base.toml", BASE)], variant, set);
    assert!(reading.found.is_empty(), "{}", reading.shown);
    let _ = reading.rows();
    reading
}

#[test]
fn the_child_wins_key_by_key() {
    let mut reading = with("title = \"child\"\n[design]\ndepth = \"3 cm\"\nnodes.n1.support = \"pinned\"\n", None, &[]);
    assert_eq!(
        reading.rows(),
        [
            "schema = 1",
            "mechanism = toy",
            "title = child",
            "design.thickness = 1 mm ± 0.02 mm",
            "design.depth = 3 cm",
            "design.nodes.n1.at = [1 mm, 2 mm]",
            "design.nodes.n1.support = pinned",
            "design.beams.b1.between = [n1, n2]",
            "design.beams.b1.bend = [1, 2]",
            "design.beams.b2.between = [n2, n3]",
            "design.beams.b2.straight = true",
        ]
    );
}

/// A goal turns round, in a file that extends another and on the command line, in what is read and in what is written; lists of goals stay
/// beside each other.
#[test]
fn a_goal_takes_the_place_of_its_opposite() {
    let study = "[optimise]\nobjective = { maximise = \"flat_ratio\" }\n[optimise.variables]\n\"design.thickness\" = { range = [\"0.5 mm\", \"2 mm\"] }\n";
    let base = format!("{BASE}{study}");
    let goals = |child: &str, set: &[&str]| {
        let child = format!("extends = \"base.toml\"\n{child}");
        let reading = read_files(&[("a.toml", &child), ("base.toml", &base)], None, set);
        assert!(reading.found.is_empty(), "{}", reading.shown);
        let objective = &reading.toy.studies.optimise.objective;
        let text = |slot: &Slot<String>| slot.as_ref().map(|s| s.value.clone());
        [text(&objective.minimise), text(&objective.maximise)]
    };
    let turned = [Some("mass".to_owned()), None];
    assert_eq!(goals("[optimise]\nobjective = { minimise = \"mass\" }\n", &[]), turned);
    assert_eq!(goals("", &["optimise.objective={minimise=\"mass\"}"]), turned);
    assert_eq!(goals("", &["optimise.objective.minimise=mass"]), turned);
    let written = with_settings(study, &["optimise.objective={minimise=\"mass\"}".to_owned()], None).unwrap();
    assert!(written.contains("minimise = \"mass\"") && !written.contains("maximise"), "{written}");
    let pareto = "[pareto]\nminimise = [\"mass\"]\n";
    let both = with_settings(pareto, &["pareto.maximise=[\"flat_ratio\"]".to_owned()], None).unwrap();
    assert!(both.contains("minimise = [\"mass\"]") && both.contains("maximise"), "{both}");
}

#[test]
fn lists_of_named_members_merge_by_name_and_other_lists_are_replaced() {
    let mut reading =
        with("[[design.beams]]\nname = \"b2\"\nstraight = false\n[[design.beams]]\nname = \"b9\"\nbetween = [\"x\", \"y\"]\n", None, &[]);
    assert_eq!(reading.row("design.beams.b2.straight"), "false");
    assert_eq!(reading.row("design.beams.b2.between"), "[n2, n3]");
    assert_eq!(reading.row("design.beams.b9.between"), "[x, y]");
    let mut reading = with("[[design.beams]]\nname = \"b1\"\nbend = [5]\n", None, &[]);
    assert_eq!(reading.row("design.beams.b1.bend"), "[5]");
}

#[test]
fn variants_are_laid_over_with_paths_into_members() {
    let mut thin = with("", Some("thin"), &[]);
    assert_eq!([thin.row("design.thickness"), thin.row("design.beams.b1.bend")], ["0.85 mm", "[3]"]);
    assert_eq!(thin.row("design.beams.b1.between"), "[n1, n2]");
    let mut many = with("", Some("many"), &[]);
    assert_eq!([many.row("design.beams.b2.thickness"), many.row("design.beams.b3.between")], ["2 mm", "[n1, n3]"]);
    // A variant of the child extends the base's of the same name.
    let mut both = with("[variants.thin]\ndesign.depth = \"5 mm\"\n", Some("thin"), &[]);
    assert_eq!([both.row("design.thickness"), both.row("design.depth")], ["0.85 mm", "5 mm"]);
}

#[test]
fn settings_replace_values_of_every_kind() {
    for (setting, path, value) in [
        ("design.thickness=\"0.9 mm\"", "design.thickness", "0.9 mm"),
        ("design.thickness=0.9 mm", "design.thickness", "0.9 mm"),
        ("design.thickness = 0.9 mm ± 1 % ", "design.thickness", "0.9 mm ± 0.009 mm"),
        (" design . thickness = '0.9 mm'", "design.thickness", "0.9 mm"),
        ("design.beams.b1.bend=[1.2,-1.5]", "design.beams.b1.bend", "[1.2, -1.5]"),
        ("design.beams.b1={ bend = [7] }", "design.beams.b1.bend", "[7]"),
        ("design.nodes.n1.at=[\"3 mm\", \"4 mm\"]", "design.nodes.n1.at", "[3 mm, 4 mm]"),
        ("design.nodes.n1={ support = \"pinned\" }", "design.nodes.n1.support", "pinned"),
        ("design.nodes.n1.support=pinned", "design.nodes.n1.support", "pinned"),
        ("design.friction=0.25", "design.friction", "0.25"),
        ("design.friction=25 %", "design.friction", "25 %"),
        ("design.copies=3", "design.copies", "3"),
        ("design.beams.b2.straight=false", "design.beams.b2.straight", "false"),
        ("title=a = b", "title", "a = b"),
        ("design.beams.b7={ between = [\"n1\", \"n4\"] }", "design.beams.b7.between", "[n1, n4]"),
    ] {
        let mut reading = with("", None, &[setting]);
        assert_eq!(reading.row(path), value, "{setting}");
    }
    // Settings come after the variant, and the last one wins.
    let mut reading = with("", Some("thin"), &["design.thickness=2 mm", "design.thickness=3 mm"]);
    assert_eq!(reading.row("design.thickness"), "3 mm");
}

#[test]
fn single_entries_of_lists_are_reached_by_their_place() {
    let width = "design.width=[[\"0\", \"1 mm\"], [\"1\", \"2 mm\"]]";
    for (settings, path, value) in [
        (&["design.beams.b1.bend.2=7"][..], "design.beams.b1.bend", "[1, 7]"),
        (&["design.beams.b1.bend.1=-3.5", "design.beams.b1.bend.2=4"], "design.beams.b1.bend", "[-3.5, 4]"),
        (&["design.nodes.n1.at.x=9 mm"], "design.nodes.n1.at", "[9 mm, 2 mm]"),
        (&["design.nodes.n1.at.y = \"3 cm\""], "design.nodes.n1.at", "[1 mm, 3 cm]"),
        (&["design.nodes.n1.at.2=0 mm"], "design.nodes.n1.at", "[1 mm, 0 mm]"),
        (&["design.nodes.n1.at={ y = \"4 mm\" }"], "design.nodes.n1.at", "[1 mm, 4 mm]"),
        (&["design.beams.b1.between.2=n9"], "design.beams.b1.between", "[n1, n9]"),
        // Places of places, and places of a list that a setting has just given.
        (&[width, "design.width.2.2=3 mm"], "design.width", "[[0, 1 mm], [1, 3 mm]]"),
        (&["design.beams.b1.bend=[5, 6, 7]", "design.beams.b1.bend.3=8"], "design.beams.b1.bend", "[5, 6, 8]"),
    ] {
        let mut reading = with("", None, settings);
        assert_eq!(reading.row(path), value, "{settings:?}");
    }
    // The same in a child file and in a variant.
    let mut child = with("[design]\nnodes.n1.at.x = \"8 mm\"\n[variants.v]\ndesign.beams.b1.bend.1 = 9\n", Some("v"), &[]);
    assert_eq!([child.row("design.nodes.n1.at"), child.row("design.beams.b1.bend")], ["[8 mm, 2 mm]", "[9, 2]"]);
}

#[test]
fn places_that_a_list_does_not_have_are_named() {
    for (setting, found, help) in [
        (
            "design.beams.b1.bend.3=7",
            "E0304 --set:1:22 3",
            "`bend` has the entries `1` and `2`, or `x` and `y`; give the whole list to make it longer",
        ),
        (
            "design.beams.b1.bend.0=7",
            "E0304 --set:1:22 0",
            "`bend` has the entries `1` and `2`, or `x` and `y`; give the whole list to make it longer",
        ),
        (
            "design.nodes.n1.at.z=7 mm",
            "E0304 --set:1:20 z",
            "`at` has the entries `1` and `2`, or `x` and `y`; give the whole list to make it longer",
        ),
        // Of another kind than its neighbours: the entry itself is at fault.
        ("design.nodes.n1.at.x=7 N", "E0201 --set:1:22 7 N", "write a length such as \"16 mm\" (µm, mm, cm, m, in)"),
    ] {
        let reading = read_files(&[("a.toml", BASE)], None, &[setting]);
        assert_eq!(reading.found, [found], "{setting}\n{}", reading.shown);
        assert_eq!(reading.help, [help], "{setting}");
    }
    let three = read_files(&[("a.toml", BASE)], None, &["design.beams.b1.bend=[1, 2, 3]", "design.beams.b1.bend.x=7"]);
    assert_eq!(three.help, ["`bend` has the entries `1` to `3`; give the whole list to make it longer"]);
}

#[test]
fn mistakes_point_into_the_text_they_stand_in() {
    let variant = BASE.replace("design.thickness = \"0.85 mm\"", "design.thicknes = \"0.85 N\"\ndesign.depth = \"0.85 N\"");
    for (files, variant, set, expected) in [
        (vec![("a.toml", variant.as_str())], Some("thin"), vec![], vec!["E0301 a.toml:18:8 thicknes", "E0201 a.toml:19:16 \"0.85 N\""]),
        (vec![("a.toml", variant.as_str())], None, vec![], vec![]),
        (vec![("a.toml", BASE)], None, vec!["design.thickness=1 N"], vec!["E0201 --set:1:18 1 N"]),
        (vec![("a.toml", BASE)], None, vec!["design.thicknes=1 mm"], vec!["E0301 --set:1:8 thicknes"]),
        (vec![("a.toml", BASE)], None, vec!["dezign.thickness=1 mm"], vec!["E0301 --set:1:1 dezign"]),
        (vec![("a.toml", BASE)], None, vec!["design.beams.b1.bend=[1, \"x\"]"], vec!["E0206 --set:1:26 \"x\""]),
        (vec![("a.toml", BASE)], None, vec!["design.beams.b1.bent=[1]"], vec!["E0301 --set:1:17 bent"]),
        (vec![("a.toml", BASE)], None, vec!["design.beams.b11.bend=[1]"], vec!["E0302 --set:1:14 b11"]),
        (vec![("a.toml", BASE)], None, vec!["design.beams.b1=5"], vec!["E0206 --set:1:17 5"]),
        (vec![("a.toml", BASE)], None, vec!["design.beams.b1.bend=[1, 2"], vec!["E0105 --set:1:27"]),
        (vec![("a.toml", BASE)], None, vec!["design.beams.b1.bend=[1e400]"], vec!["E0205 --set:1:23 1e400"]),
        (vec![("a.toml", BASE)], None, vec!["design.thickness"], vec!["E0111 --set:1:1 design.thickness"]),
        (vec![("a.toml", BASE)], None, vec![""], vec!["E0111 --set:1:1"]),
        (vec![("a.toml", BASE)], None, vec!["=1"], vec!["E0111 --set:1:1 =1"]),
        (vec![("a.toml", BASE)], None, vec!["design..depth=1 mm"], vec!["E0111 --set:1:1 design..depth=1 mm"]),
        (vec![("a.toml", BASE)], None, vec!["extends=b.toml"], vec!["E0301 --set:1:1 extends"]),
        (vec![("a.toml", BASE)], None, vec!["variants.x.y=1"], vec!["E0301 --set:1:1 variants"]),
        (vec![("a.toml", BASE)], Some("thi"), vec![], vec!["E0110 --variant:1:1 thi"]),
        (vec![("a.toml", BASE)], Some(""), vec![], vec!["E0110 --variant:1:1"]),
    ] {
        let reading = read_files(&files, variant, &set);
        assert_eq!(reading.found, expected, "{variant:?} {set:?}\n{}", reading.shown);
    }
    let suggested = |set: &str| read_files(&[("a.toml", BASE)], None, &[set]).help.join("; ");
    assert_eq!(suggested("design.thicknes=1 mm"), "did you mean `thickness`?");
    assert_eq!(suggested("design.beams.b11.bend=[1]"), "`b11` is a new member; did you mean `b1`?");
    assert_eq!(read_files(&[("a.toml", BASE)], Some("thi"), &[]).help, ["did you mean `thin`?"]);
    assert_eq!(read_files(&[("a.toml", BASE)], Some("xyz"), &[]).help, ["the file has thin, many"]);
}

#[test]
fn a_variant_cannot_extend() {
    let text = BASE.replace("[variants.thin]\n", "[variants.thin]\nextends = \"b.toml\"\n");
    let reading = read_files(&[("a.toml", &text)], Some("thin"), &[]);
    assert_eq!(reading.found, ["E0301 a.toml:18:1 extends"], "{}", reading.shown);
}

#[test]
fn chains_of_files_end() {
    let head = "schema = 1\nmechanism = \"toy\"\n[design]\nthickness = \"1 mm\"\n";
    // A circle of one, of two, with another spelling of the path.
    assert_eq!(read_files(&[("a.toml", "extends = \"a.toml\"\n")], None, &[]).found, ["E0108 a.toml:1:11 \"a.toml\""]);
    let two = [("a.toml", "extends = \"b.toml\"\n"), ("b.toml", "extends = \"./x/../a.toml\"\n")];
    assert_eq!(read_files(&[two[0], two[1], ("./x/../a.toml", "")], None, &[]).found, ["E0108 b.toml:1:11 \"./x/../a.toml\""]);
    // A long chain.
    let texts: Vec<(String, String)> = (0..40).map(|i| (format!("f{i}.toml"), format!("extends = \"f{}.toml\"\n", i + 1))).collect();
    let files: Vec<(&str, &str)> = texts.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
    let found = read_files(&files, None, &[]).found;
    assert!(found[0].starts_with("E0108 f15.toml:1:11"), "{found:?}");
    // Sixteen files are no circle.
    let fine: Vec<(String, String)> = (0..16)
        .map(|i| (format!("f{i}.toml"), if i == 15 { head.to_owned() } else { format!("extends = \"f{}.toml\"\n", i + 1) }))
        .collect();
    let files: Vec<(&str, &str)> = fine.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
    assert!(read_files(&files, None, &[]).found.is_empty());
    // Paths are relative to the file that names them.
    let nested = [("a.toml", "extends = \"sub/b.toml\"\n"), ("sub/b.toml", "extends = \"c.toml\"\n"), ("sub/c.toml", head)];
    assert!(read_files(&nested, None, &[]).found.is_empty());
    assert_eq!(read_text(&format!("extends = 3\n{head}")).found, ["E0206 a.toml:1:11 3"]);
    for (name, code) in
        [("none", "E0101"), ("broken-utf8", "E0102"), ("broken-large", "E0103"), ("broken-folder", "E0104"), ("broken-rights", "E0101")]
    {
        let found = read_text(&format!("extends = \"{name}.toml\"\n{head}")).found;
        assert_eq!(found, [format!("{code} a.toml:1:11 \"{name}.toml\"")]);
    }
}
