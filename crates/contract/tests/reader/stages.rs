//! Members in order, and quantities that vary along something.

use crate::toy::{Reading, read_files};

fn text(rest: &str) -> String {
    format!("schema = 1\nmechanism = \"toy\"\n[design]\nthickness = \"1 mm\"\n{rest}")
}

fn rows(rest: &str, set: &[&str]) -> Vec<String> {
    let mut reading: Reading = read_files(&[("a.toml", &text(rest))], None, set);
    assert!(reading.found.is_empty(), "{}", reading.shown);
    reading.rows().into_iter().filter(|r| r.starts_with("load") || r.starts_with("design.width")).collect()
}

fn errors(rest: &str, set: &[&str]) -> String {
    let reading = read_files(&[("a.toml", &text(rest))], None, set);
    assert!(!reading.found.is_empty());
    reading.shown
}

#[test]
fn one_table_or_a_list_of_them() {
    assert_eq!(rows("[load]\ntravel = \"3 mm\"\n", &[]), ["load.travel = 3 mm"]);
    assert_eq!(rows("[load]\ntravel = \"3 mm\"\n", &["load.travel=4 mm"]), ["load.travel = 4 mm"]);
    let two = "[[load]]\ntravel = \"3 mm\"\n[[load]]\ntravel = \"5 mm\"\n";
    assert_eq!(rows(two, &[]), ["load.1.travel = 3 mm", "load.2.travel = 5 mm"]);
    assert_eq!(rows(two, &["load.2.travel=6 mm"]), ["load.1.travel = 3 mm", "load.2.travel = 6 mm"]);
    // A place that the list does not have.
    assert!(errors(two, &["load.3.travel=6 mm"]).contains("E030"), "{}", errors(two, &["load.3.travel=6 mm"]));
    assert!(errors(two, &["load.travel=6 N"]).contains("E0201"));
    assert!(errors("load = 3\n", &[]).contains("E0301"));
    assert!(errors("[[load]]\n", &[]).contains("E0302"));
}

#[test]
fn the_same_everywhere_or_at_places() {
    assert_eq!(rows("width = \"3 mm\"\n", &[]), ["design.width = 3 mm"]);
    let places = "width = [[\"0\", \"1 mm\"], [\"40 %\", \"2 mm\"], [1, \"1.5 mm\"]]\n";
    assert_eq!(rows(places, &[]), ["design.width = [[0, 1 mm], [0.4, 2 mm], [1, 1.5 mm]]"]);
    for (wrong, code) in [
        ("[[\"0\", \"1 mm\"]]", "E0311"),
        ("[[\"0\", \"1 mm\"], [\"0.5\", \"2 mm\"]]", "E0204"),
        ("[[\"0.1\", \"1 mm\"], [\"1\", \"2 mm\"]]", "E0204"),
        ("[[\"0\", \"1 mm\"], [\"0.6\", \"2 mm\"], [\"0.4\", \"2 mm\"], [\"1\", \"2 mm\"]]", "E0311"),
        ("[[\"0\", \"1 mm\"], [\"0\", \"2 mm\"], [\"1\", \"2 mm\"]]", "E0204"),
        ("[[\"0\", \"1 mm\"], [\"1\", \"2 N\"]]", "E0201"),
        ("[[\"0\", \"1 mm\"], [\"1\"]]", "E0311"),
        ("[[\"0\", \"1 mm\"], \"1\"]", "E0206"),
        ("true", "E0206"),
    ] {
        let shown = errors(&format!("width = {wrong}\n"), &[]);
        assert!(shown.contains(code), "{wrong}: {shown}");
    }
}
