//! The reader of project files: every code at its exact place, all of a file at once, in file order, with a way out.

use crate::toy::{read_files, read_text, show};
use std::fmt::Write as _;

use forcewright_contract::codes::CODES;

const HEAD: &str = "schema = 1\nmechanism = \"toy\"\n";

/// Text after the head (which has two lines), and what is found in it.
const CASES: &[(&str, &[&str])] = &[
    // Syntax. What is missing as a whole is reported at the start of the file.
    ("[design\nthickness = \"1 mm\"", &["E0302 a.toml:1:1", "E0105 a.toml:3:8", "E0301 a.toml:4:1 thickness"]),
    ("[design]\nthickness = 1 mm", &["E0105 a.toml:4:13 1 mm"]),
    ("[design]\nthickness = \"1 mm\"\nthickness = \"2 mm\"", &["E0106 a.toml:5:1 thickness"]),
    ("[design]\nthickness = \"1 mm\"\n[design]\ndepth = \"1 mm\"", &["E0106 a.toml:5:1 [design]"]),
    ("[design]\nthickness = [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[", &["E0107 a.toml:4:45 ["]),
    // Values.
    ("[design]\nthickness = \"1 N\"", &["E0201 a.toml:4:13 \"1 N\""]),
    ("[design]\nthickness = \"thin\"", &["E0202 a.toml:4:13 \"thin\""]),
    ("[design]\nthickness = \"1,5 mm\"", &["E0202 a.toml:4:13 \"1,5 mm\""]),
    ("[design]\nthickness = \"\"", &["E0202 a.toml:4:13 \"\""]),
    ("[design]\nthickness = \"1 mmm\"", &["E0203 a.toml:4:13 \"1 mmm\""]),
    ("[design]\nthickness = \"-1 mm\"", &["E0204 a.toml:4:13 \"-1 mm\""]),
    ("[design]\nthickness = \"1e-400 mm\"", &["E0204 a.toml:4:13 \"1e-400 mm\""]),
    ("[design]\nthickness = \"2 m\"", &["E0204 a.toml:4:13 \"2 m\""]),
    ("[design]\nthickness = \"1 mm\"\ncopies = 9", &["E0204 a.toml:5:10 9"]),
    ("[design]\nthickness = \"nan mm\"", &["E0205 a.toml:4:13 \"nan mm\""]),
    ("[design]\nthickness = \"1e400 mm\"", &["E0205 a.toml:4:13 \"1e400 mm\""]),
    ("[design]\nthickness = nan", &["E0205 a.toml:4:13 nan"]),
    ("[design]\nthickness = 1e400", &["E0205 a.toml:4:13 1e400"]),
    ("[design]\nthickness = \"1 mm\"\nfriction = -inf", &["E0205 a.toml:5:12 -inf"]),
    ("[design]\nthickness = \"1 mm\"\ncopies = 0xFFFFFFFFFFFFFFFFFFFF", &["E0205 a.toml:5:10 0xFFFFFFFFFFFFFFFFFFFF"]),
    ("[design]\nthickness = true", &["E0206 a.toml:4:13 true"]),
    ("[design]\nthickness = [\"1 mm\"]", &["E0206 a.toml:4:13 [\"1 mm\"]"]),
    ("[design]\nthickness = 1979-05-27", &["E0206 a.toml:4:13 1979-05-27"]),
    ("[design]\nthickness = \"1 mm\"\ncopies = 2.5", &["E0206 a.toml:5:10 2.5"]),
    ("design = 3", &["E0206 a.toml:3:10 3"]),
    ("[[design]]\nthickness = \"1 mm\"", &["E0206 a.toml:3:1 [[design]]"]),
    ("variants = 1\n[design]\nthickness = \"1 mm\"", &["E0206 a.toml:3:12 1"]),
    ("[design]\nthickness = \"1 mm ± -1 mm\"", &["E0207 a.toml:4:13 \"1 mm ± -1 mm\""]),
    ("[design]\nthickness = \"1 mm h7\"", &["E0320 a.toml:4:13 \"1 mm h7\""]),
    ("[design]\nthickness = \"1 mm\"\n[[design.beams]]\nbetween = [\"p\", \"q\"]\npin = \"1 mm t6\"", &["E0209 a.toml:7:7 \"1 mm t6\""]),
    ("[design]\nthickness = \"1\"", &["E0208 a.toml:4:13 \"1\""]),
    ("[design]\nthickness = 1.5", &["E0208 a.toml:4:13 1.5"]),
    // Keys and names.
    ("[design]\nthickness = \"1 mm\"\nmaß = 1", &["E0301 a.toml:5:1 maß", "E0105 a.toml:5:3 ß"]),
    ("[design]\nthickness = \"1 mm\"\n[dezign]\na = 1", &["E0301 a.toml:5:2 dezign"]),
    ("[design]\ndepth = \"1 mm\"", &["E0302 a.toml:3:2 design"]),
    ("", &["E0302 a.toml:1:1"]),
    ("[design]\nthickness = \"1 mm\"\n[design.nodes]\nn1 = { support = \"clampd\" }", &["E0303 a.toml:6:18 \"clampd\""]),
    ("[errors]\n[design]\nthickness = \"1 mm\"", &["E0306 a.toml:3:2 errors"]),
    (
        "[design]\nthickness = \"1 mm\"\n[[design.beams]]\nname = \"a\"\nbetween = [\"p\", \"q\"]\n[[design.beams]]\nname = \"a\"\nbetween = [\"p\", \"q\"]",
        &["E0307 a.toml:9:8 \"a\""],
    ),
    ("[design]\nthickness = \"1 mm\"\n[design.nodes]\nn1 = { at = [\"1 mm\"] }", &["E0311 a.toml:6:13 [\"1 mm\"]"]),
    ("[environment]\nx = 1\n[design]\nthickness = \"1 mm\"", &["W0101 a.toml:3:2 environment"]),
    // Members of lists.
    ("[design]\nthickness = \"1 mm\"\nbeams = [1]", &["E0206 a.toml:5:10 1"]),
    ("[design]\nthickness = \"1 mm\"\nbeams = 1", &["E0206 a.toml:5:9 1"]),
    ("[design]\nthickness = \"1 mm\"\nnodes = [1]", &["E0206 a.toml:5:9 [1]"]),
    ("[design]\nthickness = \"1 mm\"\nnodes = { n1 = 1 }", &["E0206 a.toml:5:16 1"]),
    ("[design]\nthickness = \"1 mm\"\n[[design.beams]]\nname = 3", &["E0206 a.toml:6:8 3"]),
    ("[design]\nthickness = \"1 mm\"\nnodes.n1.at = [nan, \"1 mm\"]", &["E0205 a.toml:5:16 nan"]),
    ("[design]\nthickness = \"1 mm\"\nnodes.n1.direction = [0, 0]", &["E0204 a.toml:5:22 [0, 0]"]),
    ("[design]\nthickness = \"1 mm\"\nnodes.n1.direction = [0, 0, 1]", &["E0311 a.toml:5:22 [0, 0, 1]"]),
    ("[design]\nthickness = \"1 mm\"\nnodes.n1.direction = [\"0\", 1]", &["E0206 a.toml:5:23 \"0\""]),
];

#[test]
fn every_mistake_has_its_code_and_its_exact_place() {
    let mut wrong = String::new();
    for (text, expected) in CASES {
        let reading = read_text(&format!("{HEAD}{text}"));
        if reading.found != *expected {
            let _ = writeln!(wrong, "in\n{text}\nexpected {expected:?}\nfound    {:?}\n", reading.found);
            continue;
        }
        for line in expected.iter().filter_map(|l| l.split(' ').nth(1)) {
            assert!(reading.shown.contains(&format!("--> {line}\n")), "{line} is not shown:\n{}", reading.shown);
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn every_code_of_the_reader_is_met_and_every_code_met_is_explained() {
    let mut met: Vec<String> = Vec::new();
    let mut note = |found: Vec<String>| met.extend(found.into_iter().filter_map(|l| l.split(' ').next().map(str::to_owned)));
    for (text, _) in CASES {
        note(read_text(&format!("{HEAD}{text}")).found);
    }
    for name in ["none.toml", "broken-utf8.toml", "broken-large.toml", "broken-folder.toml", "broken-rights.toml"] {
        note(read_files(&[("a.toml", &format!("extends = \"{name}\"\n{HEAD}"))], None, &[]).found);
    }
    note(read_files(&[("a.toml", "extends = \"a.toml\"")], None, &[]).found);
    note(read_files(&[("a.toml", HEAD)], Some("none"), &["x"]).found);
    // References, exclusions, catalogues, families, tables of data and studies are not the reader's: the tests of the command line, of
    // data and of studies meet their codes.
    let elsewhere = ["E0112", "E0304", "E0305", "E0308", "E0309", "E0312", "E0313", "E0315", "E0317", "E0318", "E0920", "E0921"];
    for code in CODES.iter().map(|c| c.code).filter(|c| !elsewhere.contains(c)) {
        assert!(met.iter().any(|m| m == code), "{code} is never met");
    }
    for code in &met {
        assert!(CODES.iter().any(|c| c.code == code), "{code} is not explained");
    }
}

#[test]
fn all_mistakes_of_a_file_at_once_in_file_order() {
    let base = "[design]\ndepth = \"1 kg\"\nkolour = 3\n[design.nodes]\nn1 = { at = [\"1 mm\", 2] }\n";
    let child = "schema = 2\nmechanism = \"toy\"\nextends = \"base.toml\"\n[design]\nthikness = \"1 mm\"\ncopies = \"two\"\n[[design.beams]]\nname = \"b1\"\nbetween = \"n1\"\nbend = [1.0, \"2\", 99]\n";
    let reading = read_files(&[("a.toml", child), ("base.toml", base)], None, &["design.friction=7", "design.force=5 mm"]);
    assert_eq!(
        reading.found,
        [
            "E0204 a.toml:1:10 2",
            "E0301 a.toml:5:1 thikness",
            "E0206 a.toml:6:10 \"two\"",
            "E0206 a.toml:9:11 \"n1\"",
            "E0206 a.toml:10:14 \"2\"",
            "E0201 base.toml:2:9 \"1 kg\"",
            "E0301 base.toml:3:1 kolour",
            "E0208 base.toml:5:22 2",
            "E0204 --set:1:17 7",
            "E0201 --set:1:14 5 mm",
        ],
        "{}",
        reading.shown
    );
    let mut at = 0;
    for line in &reading.found {
        let place = line.split(' ').nth(1).unwrap();
        at +=
            reading.shown[at..].find(&format!("--> {place}")).unwrap_or_else(|| panic!("{place} is not shown in order\n{}", reading.shown));
    }
}

#[test]
fn help_names_the_way_out() {
    for (text, help) in [
        ("[design]\nthikness = \"1 mm\"", "did you mean `thickness`?"),
        ("thickness = \"1 mm\"\n[design]\nthickness = \"1 mm\"", "this key belongs elsewhere: `design.thickness`"),
        ("optimize = 1\n[design]\nthickness = \"1 mm\"", "did you mean `optimise`?"),
        ("[design]\nthickness = \"1 mm\"\n[[design.beams]]\nnmae = \"b\"\nbetween = [\"a\", \"b\"]", "did you mean `name`?"),
        ("[design]\nthickness = \"1,5 mm\"", "write \"1.5 mm\""),
        ("[design]\nthickness = 1.5", "\"1.5 mm\""),
        ("[design]\nthickness = \"2 m\"", "must be above 0 m and at most 1 m"),
        ("[design]\nthickness = \"2000 mm\"", "must be above 0 mm and at most 1000 mm"),
        ("[design]\nthickness = \"1 N\"", "such as \"16 mm\" (µm, mm, cm, m, in)"),
        ("[design]\nthickness = \"1 mm\"\nnodes.n1.support = \"pined\"", "did you mean \"pinned\"? (\"clamped\", \"pinned\")"),
        ("[design]\n", "add it, such as `thickness = \"16 mm\"`: thickness w."),
    ] {
        let reading = read_text(&format!("{HEAD}{text}"));
        assert!(reading.help.iter().any(|h| h.contains(help)), "{help} is not in {:?}", reading.help);
    }
    let units = read_text(&format!("{HEAD}[design]\nthickness = \"1 mm\"\nforce = \"2 Mpa\""));
    assert!(units.shown.contains("did you mean `MPa`?"), "{}", units.shown);
}

#[test]
fn a_misspelt_key_is_not_also_missing_but_a_similar_known_key_hides_nothing() {
    assert_eq!(read_text(&format!("{HEAD}[design]\nthicknes = \"1 mm\"")).found, ["E0301 a.toml:4:1 thicknes"]);
    // `depths` is near `depth`, which is not missing; `thickness` is.
    assert_eq!(read_text(&format!("{HEAD}[design]\ndepths = \"1 mm\"")).found, ["E0302 a.toml:3:2 design", "E0301 a.toml:4:1 depths"]);
}

#[test]
fn thousands_of_mistakes_and_members_are_refused_in_no_time() {
    let keys = (0..60_000).fold(String::new(), |text, i| text + &format!("a{i} = 1\n"));
    let beams = "[[design.beams]]\n".repeat(50_000);
    let signs = "=\n".repeat(200_000);
    let started = std::time::Instant::now();
    for text in [keys.as_str(), beams.as_str(), signs.as_str()] {
        let shown = show(&[("a.toml", &format!("extends = \"b.toml\"\n{HEAD}{text}")), ("b.toml", text)]);
        assert!(shown.contains("error[E0") && shown.len() < 200_000);
    }
    assert!(started.elapsed().as_secs() < 15, "took {:?}", started.elapsed());
}

#[test]
fn collections_have_a_largest_size() {
    let design = format!("{HEAD}[design]\nthickness = \"1 mm\"\n");
    let beams = |n: usize| format!("{design}{}", "[[design.beams]]\nbetween = [\"a\", \"b\"]\n".repeat(n));
    let nodes = |n: usize| (0..n).fold(format!("{design}[design.nodes]\n"), |text, i| text + &format!("n{i} = {{}}\n"));
    for text in [beams(500), nodes(500)] {
        assert_eq!(read_text(&text).found, Vec::<String>::new());
    }
    assert_eq!(read_text(&beams(501)).found, ["E0311 a.toml:5:10 beams"]);
    assert_eq!(read_text(&nodes(501)).found, ["E0311 a.toml:5:9 nodes"]);
    let numbers = |n: usize| format!("{design}[[design.beams]]\nbetween = [\"a\", \"b\"]\nbend = [{}]\n", vec!["1"; n].join(", "));
    assert_eq!(read_text(&numbers(32)).found, Vec::<String>::new());
    assert!(read_text(&numbers(33)).found[0].starts_with("E0311 a.toml:7:8 [1, "));
}

#[test]
fn line_ends_and_byte_order_marks_change_no_place() {
    let text = format!("{HEAD}[design]\nthickness = \"1 N\"\n");
    let expected = ["E0201 a.toml:4:13 \"1 N\""];
    assert_eq!(read_text(&text).found, expected);
    assert_eq!(read_text(&text.replace('\n', "\r\n")).found, expected);
    assert_eq!(read_text(&format!("\u{feff}{text}")).found, expected);
    assert_eq!(read_text(&text.replace("[design]", "# äöü €\u{1f600}\n[design]")).found, ["E0201 a.toml:5:13 \"1 N\""]);
    // Columns count characters, not bytes.
    assert_eq!(read_text(&format!("{HEAD}design = {{ \"ü\" = 1, thickness = \"1 N\" }}")).found[1], "E0201 a.toml:3:33 \"1 N\"");
}
