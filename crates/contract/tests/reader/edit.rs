//! A project file with other values: what is changed is read back, everything else stays as it was typed.

use forcewright_contract::edit::{EditError, with_text_at, with_values, with_variant};

use crate::toy::{Reading, read_files};

const TEXT: &str = r#"# A toy.
schema = 1
mechanism = "toy"

[design] # the plate
thickness = "0.8 mm ± 20 µm"   # typed with care
friction  = 0.3
width     = [["0", "3 mm"], ["25 %", "4 mm"], ["1", "5 mm"]]

[design.nodes]
# from the drawing
b = { at = ["3 mm", "4 mm"], support = "clamped" }
a = { at = ["1 mm",  "2 cm"], through = [["1 mm", "2 mm"], ["3 mm", "4 mm"]] }  # loose

[[design.beams]]
name = "stiff" # first
between = ["a", "b"]
bend = [1.5, -0.25]  # rad

[[design.beams]]
name = "leaf"
between = ["a", "b"]
pin = "1.2 mm h7"

[[load]]
travel = "3 mm"
[[load]]
travel = "5 mm"
"#;

fn read(files: &[(&str, &str)], variant: Option<&str>) -> Reading {
    let reading = read_files(files, variant, &[]);
    assert!(reading.found.is_empty(), "{}", reading.shown);
    reading
}

/// Edits the first file, reads it back and asserts that the changed numbers have their values and all others are the same bits.
#[track_caller]
fn edited(files: &[(&str, &str)], variant: Option<&str>, changes: &[(&str, f64)]) -> String {
    let numbers = read(files, variant).numbers();
    let place = |path: &str| numbers.iter().position(|n| n.path == path).unwrap_or_else(|| panic!("no {path}"));
    let changed: Vec<(usize, f64)> = changes.iter().map(|(path, si)| (place(path), *si)).collect();
    let text = with_values(files[0].1, &numbers, &changed, variant).expect("nothing is in the way");
    let mut others = files.to_vec();
    others[0].1 = &text;
    let after = read(&others, variant).numbers();
    assert_eq!(numbers.len(), after.len(), "{text}");
    for (index, (old, new)) in numbers.iter().zip(&after).enumerate() {
        assert_eq!((&old.path, old.part, &old.tolerance), (&new.path, new.part, &new.tolerance), "{text}");
        match changed.iter().find(|(at, _)| *at == index) {
            Some((_, si)) => assert!((new.si - si).abs() <= 5e-7 * si.abs(), "{}: {} instead of {si}\n{text}", new.path, new.si),
            None => assert_eq!(old.si.to_bits(), new.si.to_bits(), "{}\n{text}", new.path),
        }
    }
    text
}

/// Asserts that a change of the text above replaces these words and nothing else.
#[track_caller]
fn replaces(changes: &[(&str, f64)], words: &[(&str, &str)]) {
    let mut wanted = TEXT.to_owned();
    for (old, new) in words {
        assert_eq!(wanted.matches(old).count(), 1, "{old}");
        wanted = wanted.replace(old, new);
    }
    assert_eq!(edited(&[("a.toml", TEXT)], None, changes), wanted);
}

#[test]
fn nothing_changes_where_nothing_is_changed() {
    replaces(&[], &[]);
}

#[test]
fn comments_order_unit_and_tolerance_stay() {
    replaces(&[("design.thickness", 0.912_345_678e-3)], &[("0.8 mm ± 20 µm", "0.9123457 mm ± 0.02 mm")]);
    replaces(&[("design.beams.leaf.pin", 1.25e-3)], &[("1.2 mm h7", "1.25 mm h7")]);
    replaces(&[("design.friction", 0.25)], &[("= 0.3", "= 0.25")]);
}

#[test]
fn one_coordinate_of_a_point_changes_and_the_other_stays_as_typed() {
    replaces(&[("design.nodes.a.at.x", 1.5e-3)], &[("[\"1 mm\",  \"2 cm\"]", "[\"1.5 mm\",  \"2 cm\"]")]);
    replaces(&[("design.nodes.a.at.y", 0.025)], &[("\"2 cm\"", "\"2.5 cm\"")]);
    replaces(&[("design.nodes.a.through.2.x", 3.5e-3)], &[("[\"3 mm\", \"4 mm\"]] }", "[\"3.5 mm\", \"4 mm\"]] }")]);
}

#[test]
fn members_of_lists_change_alone() {
    replaces(&[("design.beams.stiff.bend.2", -0.3)], &[("-0.25]", "-0.3]")]);
    replaces(&[("design.width.2", 4.5e-3)], &[("[\"25 %\", \"4 mm\"]", "[\"25 %\", \"4.5 mm\"]")]);
    replaces(&[("load.2.travel", 6e-3)], &[("\"5 mm\"\n", "\"6 mm\"\n")]);
    replaces(
        &[("design.beams.stiff.bend.1", 1.0), ("design.beams.stiff.bend.2", 2.0), ("load.1.travel", 4e-3)],
        &[("[1.5, -0.25]", "[1.0, 2.0]"), ("travel = \"3 mm\"", "travel = \"4 mm\"")],
    );
}

#[test]
fn a_default_is_written_where_it_belongs() {
    let text = edited(&[("a.toml", TEXT)], None, &[("design.depth", 12e-3)]);
    assert!(text.replace("depth = \"12 mm\"\n", "") == TEXT, "{text}");
}

#[test]
fn a_ratio_with_a_tolerance_stays_a_text() {
    for (typed, want) in
        [("\"0.3 ± 0.01\"", "\"0.35 ± 0.01\""), ("\"30 % ± 1 %\"", "\"35 % ± 1 %\""), ("\"0.3\"", "0.35"), ("\"30 %\"", "\"35 %\"")]
    {
        let text = TEXT.replace("= 0.3", &format!("= {typed}"));
        assert_eq!(edited(&[("a.toml", &text)], None, &[("design.friction", 0.35)]), TEXT.replace("= 0.3", &format!("= {want}")));
    }
}

const OVER: &str = "extends = \"base.toml\"\n# the same, a little other\n[design]\nthickness = \"0.9 mm\" # thin\n";

#[test]
fn what_stands_in_an_extended_file_is_written_into_this_one() {
    let files = [("a.toml", OVER), ("base.toml", TEXT)];
    let text = edited(&files, None, &[("design.thickness", 1e-3)]);
    assert_eq!(text, OVER.replace("0.9 mm", "1 mm"));
    let text = edited(
        &files,
        None,
        &[
            ("design.friction", 0.2),
            ("design.width.2", 4.5e-3),
            ("design.nodes.a.at.x", 2e-3),
            ("design.nodes.a.through.1.y", 2.5e-3),
            ("design.beams.stiff.bend.2", 0.75),
            ("design.beams.leaf.pin", 1.3e-3),
            ("load.2.travel", 7e-3),
        ],
    );
    assert!(text.starts_with(OVER), "{text}");
}

#[test]
fn a_member_that_the_list_of_this_file_lacks_is_added_by_its_name() {
    let over = "extends = \"base.toml\"\n[[design.beams]]\nname = \"leaf\"\nbend = [0.1, 0.2]\n";
    let text =
        edited(&[("a.toml", over), ("base.toml", TEXT)], None, &[("design.beams.stiff.bend.1", 0.5), ("design.beams.leaf.bend.2", 0.3)]);
    assert!(text.contains("bend = [0.1, 0.3]") && text.contains("name = \"stiff\"\nbend = [0.5, -0.25]"), "{text}");
}

#[test]
fn a_name_that_looks_like_a_place_is_a_name() {
    let base = TEXT.replace("\"leaf\"", "\"1\"");
    let over = "extends = \"base.toml\"\n[[design.beams]]\nname = \"stiff\"\nbend = [0.1, 0.2]\n";
    edited(&[("a.toml", over), ("base.toml", &base)], None, &[("design.beams.1.pin", 2e-3)]);
    edited(&[("a.toml", &base)], None, &[("design.beams.1.pin", 2e-3)]);
}

#[test]
fn a_variant_that_says_otherwise_is_changed_and_others_are_not() {
    let variants = "\n[variants.thin.design]\nthickness = \"0.5 mm\" # thinner\n[variants.thin.design.beams.stiff]\nbend = [1.1, 1.2]\n\
                    [variants.thick.design]\nthickness = \"2 mm\"\n";
    let text = format!("{TEXT}{variants}");
    let after = edited(
        &[("a.toml", &text)],
        Some("thin"),
        &[("design.thickness", 0.6e-3), ("design.beams.stiff.bend.1", 1.3), ("design.friction", 0.1)],
    );
    let new = variants.replace("0.5 mm", "0.6 mm").replace("1.1", "1.3");
    assert!(after.ends_with(&new) && after.contains("friction  = 0.1\n"), "{after}");
}

/// A variant of its own: read with it, the numbers have their new values; read without it, nothing has changed.
#[test]
fn numbers_in_a_variant_leave_the_rest_as_it_is() {
    let over = "extends = \"base.toml\"\n[variants.thin.design]\nthickness = \"0.5 mm\"\n";
    for files in [vec![("a.toml", TEXT)], vec![("a.toml", over), ("base.toml", TEXT)]] {
        let numbers = read(&files, None).numbers();
        let wanted = [
            ("design.thickness", 0.6e-3),
            ("design.friction", 0.1),
            ("design.nodes.a.at.y", 5e-3),
            ("design.width.2", 4.5e-3),
            ("design.beams.stiff.bend.2", 0.5),
            ("design.beams.leaf.pin", 2e-3),
            ("load.2.travel", 7e-3),
        ];
        let place = |path: &str| numbers.iter().position(|n| n.path == path).unwrap_or_else(|| panic!("no {path}"));
        let changed: Vec<(usize, f64)> = wanted.iter().map(|(path, si)| (place(path), *si)).collect();
        let text = with_variant(files[0].1, &numbers, &changed, "found").unwrap();
        assert!(text.starts_with(files[0].1), "{text}");
        let mut others = files.clone();
        others[0].1 = &text;
        let bits = |reading: &mut Reading| reading.numbers().iter().map(|n| n.si.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&mut read(&others, None)), bits(&mut read(&files, None)), "{text}");
        for (index, new) in read(&others, Some("found")).numbers().iter().enumerate() {
            let si = changed.iter().find(|(at, _)| *at == index).map_or(numbers[index].si, |(_, si)| *si);
            assert!((new.si - si).abs() <= 5e-7 * si.abs(), "{}: {} instead of {si}\n{text}", new.path, new.si);
        }
    }
}

#[test]
fn texts_are_written_at_paths_of_keys() {
    let path = ["variants", "a.b", "measurements", "m", "offset", "x"];
    let text = with_text_at("# one\nschema = 1\n", &path, "2 mm").unwrap();
    assert!(text.starts_with("# one\nschema = 1\n") && text.contains("\"a.b\""), "{text}");
    let again = with_text_at(&text, &path, "3 mm").unwrap();
    assert_eq!(again, text.replace("2 mm", "3 mm"));
    assert_eq!(with_text_at(&text, &["schema", "x"], "3 mm"), Err(EditError::InTheWay("schema.x".into())));
}

#[test]
fn a_variant_of_the_extended_file_is_overruled() {
    let base = format!("{TEXT}\n[variants.thin.design]\nthickness = \"0.5 mm\"\n");
    for over in [OVER.to_owned(), format!("{OVER}[variants.thin.design]\ndepth = \"9 mm\"\n")] {
        let files = [("a.toml", over.as_str()), ("base.toml", base.as_str())];
        edited(&files, Some("thin"), &[("design.thickness", 0.6e-3), ("design.nodes.b.at.y", 5e-3)]);
    }
}

#[test]
fn dotted_keys_and_tables_in_braces_and_brackets() {
    let dotted = "schema = 1\nmechanism = \"toy\"\ndesign.thickness = \"1 mm\" # one\ndesign.nodes.a.at = [\"1 mm\", \"2 mm\"]\n";
    let text = edited(&[("a.toml", dotted)], None, &[("design.thickness", 2e-3), ("design.nodes.a.at.y", 3e-3), ("design.depth", 8e-3)]);
    assert!(text.contains("design.thickness = \"2 mm\" # one\n") && text.contains("[\"1 mm\", \"3 mm\"]"), "{text}");
    let braces = "schema = 1\nmechanism = \"toy\"\ndesign = { thickness = \"1 mm\", beams = [{ name = \"b\", between = [\"x\", \"y\"], bend = [1, 2] }] }\n";
    let text = edited(&[("a.toml", braces)], None, &[("design.thickness", 2e-3), ("design.beams.b.bend.2", 3.0), ("design.depth", 8e-3)]);
    assert!(text.contains("bend = [1, 3.0]"), "{text}");
    // One entry of a list of the extended file, by its place.
    let parts = "extends = \"base.toml\"\n[design.nodes.a]\nat.x = \"5 mm\"\n[design.beams.stiff]\nbend.2 = 0.5\n";
    let text = edited(
        &[("a.toml", parts), ("base.toml", TEXT)],
        None,
        &[("design.nodes.a.at.x", 6e-3), ("design.nodes.a.at.y", 7e-3), ("design.beams.stiff.bend.2", 0.25)],
    );
    assert!(text.contains("at.x = \"6 mm\"\n") && text.contains("bend.2 = 0.25\n"), "{text}");
}

#[test]
fn something_in_the_way_is_named() {
    let numbers = read(&[("a.toml", TEXT)], None).numbers();
    let place = |path: &str| numbers.iter().position(|n| n.path == path).unwrap();
    for (text, path) in [
        ("design = 3", "design.thickness"),
        ("[design.thickness]\nx = 1", "design.thickness"),
        ("[design]\nnodes = [1, 2]", "design.nodes.a.at.x"),
        ("[design.width]\n2 = \"1 mm\"", "design.width.2"),
        ("[[load]]\ntravel = \"1 mm\"", "load.2.travel"),
    ] {
        let error = with_values(text, &numbers, &[(place(path), 1e-3)], None).unwrap_err();
        assert_eq!(error, EditError::InTheWay(path.to_owned()), "{text}");
        assert!(error.to_string().contains(path));
    }
    assert!(matches!(with_values("[design", &numbers, &[(0, 1.0)], None), Err(EditError::NotToml(_))));
}
