//! Files of data: found beside the file that names them, read as tables with places, found again from another folder.

use forcewright_base::diagnostics::{Diagnostics, Span};
use forcewright_base::units::Dimension;
use forcewright_contract::data::{Column, Named, named_rows, rows};
use forcewright_contract::describe::Located;
use forcewright_contract::edit::{with_base_from, with_settings};
use forcewright_contract::schema;

use crate::toy::{Reading, Toy, read_files};

const NAMED: &str = "schema = 1\nmechanism = \"toy\"\n[design]\nthickness = \"1 mm\"\nmeasured_file = \"wanted.csv\" # bench\n";
const COLUMNS: [Column; 2] =
    [Column { name: "travel", dimension: Dimension::Length }, Column { name: "force", dimension: Dimension::Force }];

/// The rows of the file that a reading names, SI, or what was found wrong: `E0202 wanted.csv:3:5 x`.
fn table(reading: &Reading) -> Result<Vec<[f64; 2]>, Vec<String>> {
    let file = &reading.toy.design.measured_file.as_ref().expect("a file").value;
    let mut said = Diagnostics::default();
    let found = rows(file, &COLUMNS, 5, &mut said);
    let lines = said.in_file_order().into_iter().map(|d| {
        let span = d.span.expect("a place");
        let source = reading.sources.get(span.source).expect("a source");
        let (line, column) = reading.sources.line_column(span).expect("a place inside the text");
        assert!(d.help.as_ref().is_some_and(|h| !h.is_empty()) && !d.label.is_empty(), "{d:?}");
        format!("{} {}:{line}:{column} {}", d.code, source.name, &source.text[span.start..span.end]).trim_end().to_owned()
    });
    let lines: Vec<String> = lines.collect();
    assert_eq!(found.is_none(), !lines.is_empty(), "{lines:?}");
    found.map(|rows| rows.iter().map(|row| row.map(|cell| cell.si)).collect()).ok_or(lines)
}

fn csv(text: &str) -> Result<Vec<[f64; 2]>, Vec<String>> {
    let mut reading = read_files(&[("a.toml", NAMED), ("wanted.csv", text)], None, &[]);
    assert!(reading.found.is_empty(), "{}", reading.shown);
    assert_eq!(reading.row("design.measured_file"), "wanted.csv");
    table(&reading)
}

#[test]
fn a_table_in_every_spelling() {
    let wanted = Ok(vec![[2e-3, 5.0], [4e-3, 7.5]]);
    for text in [
        "travel / mm, force / N\n2, 5\n4, 7.5\n",
        "travel/mm;force/N\n2;5\n4;7.5",
        "# bench, 3 May\n\n  # second run\nx / cm , F / kN\r\n0.2,5e-3\r\n\r\n# a gap\r\n 0.4 ,7.5e-3\r\n",
        "\u{feff}\"travel / mm\",\"force / N\"\n\"2\",\"5\"\n\"4\",\"7.5\"\n",
        "travel / mm, force / kg*m/s^2\n2, 5\n+4.0, 0.75e1\n",
    ] {
        assert_eq!(csv(text), wanted, "{text}");
    }
    // A decimal unit is joined to the digits, as in a project file.
    let bits = |text: &str| csv(text).unwrap()[0][0].to_bits();
    assert_eq!(bits("x / mm, F / N\n18.77, 1\n"), bits("x / cm, F / N\n1.877, 1\n"));
}

#[test]
fn every_mistake_has_its_line_and_its_column() {
    for (text, wanted) in [
        ("", &["E0112 wanted.csv:1:1"][..]),
        ("# nothing\n", &["E0112 wanted.csv:1:1"]),
        ("1, 2\n3, 4\n", &["E0112 wanted.csv:1:1 1, 2"]),
        ("travel / mm\n1\n", &["E0112 wanted.csv:1:1 travel / mm"]),
        ("travel / mm, force / N, note\n1, 2, 3\n", &["E0112 wanted.csv:1:1 travel / mm, force / N, note"]),
        ("travel / mm, force / N\n", &["E0112 wanted.csv:1:1 travel / mm, force / N"]),
        ("travel, force / N\n1, 2\n", &["E0208 wanted.csv:1:1 travel"]),
        ("travel [mm], force / N\n1, 2\n", &["E0208 wanted.csv:1:1 travel [mm]"]),
        ("travel / mmm, force / N\n1, 2\n", &["E0203 wanted.csv:1:1 travel / mmm"]),
        ("# both\nforce / N, travel / mm\n1, 2\n", &["E0201 wanted.csv:2:1 force / N", "E0201 wanted.csv:2:12 travel / mm"]),
        ("travel / mm, force / N\n1, 2\n3, x\n5\n", &["E0202 wanted.csv:3:4 x", "E0112 wanted.csv:4:1 5"]),
        ("travel / mm; force / N\n1,5; 2\n", &["E0202 wanted.csv:2:1 1,5"]),
        ("travel / mm, force / N\n1,5, 2\n", &["E0112 wanted.csv:2:1 1,5, 2"]),
        ("travel / mm, force / N\n1 mm, 2 N\n", &["E0202 wanted.csv:2:1 1 mm", "E0202 wanted.csv:2:7 2 N"]),
        (
            "travel / mm, force / N\n1, \n2, nan\n3, 1e999\n",
            &["E0202 wanted.csv:2:4", "E0205 wanted.csv:3:4 nan", "E0205 wanted.csv:4:4 1e999"],
        ),
        ("x / mm, F / N\n1,1\n2,1\n3,1\n4,1\n5,1\n6,1\n", &["E0112 wanted.csv:7:1 6,1"]),
    ] {
        assert_eq!(csv(text), Err(wanted.iter().map(|w| (*w).to_owned()).collect()), "{text}");
    }
}

/// The columns `travel / mm` and `F / N` by their names, SI, or what was found wrong with its place: of the CSV, or `-` of the key.
fn by_name(text: &str, names: [&str; 2]) -> Result<Vec<[f64; 2]>, Vec<String>> {
    let reading = read_files(&[("a.toml", NAMED), ("wanted.csv", text)], None, &[]);
    let file = &reading.toy.design.measured_file.as_ref().expect("a file").value;
    let headers = names.map(|name| Located::new(name.to_owned(), Span::default()));
    let columns = [("travel", Dimension::Length, &headers[0]), ("force", Dimension::Force, &headers[1])]
        .map(|(key, dimension, header)| Named { header, key, dimension });
    let mut said = Diagnostics::default();
    let found = named_rows(file, &columns, 3, &mut said);
    let lines = said.in_file_order().into_iter().map(|d| {
        let span = d.span.expect("a place");
        assert!(d.help.as_ref().is_some_and(|h| !h.is_empty()) && !d.label.is_empty(), "{d:?}");
        let place = reading.sources.line_column(span).filter(|_| span != Span::default());
        place.map_or(format!("{} -", d.code), |(line, column)| format!("{} {line}:{column}", d.code))
    });
    let lines: Vec<String> = lines.collect();
    assert_eq!(found.is_none(), !lines.is_empty(), "{lines:?}");
    found.map(|rows| rows.iter().map(|row| row.map(|cell| cell.si)).collect()).ok_or(lines)
}

#[test]
fn columns_by_their_names() {
    let names = ["travel / mm", "F/N"];
    let wanted = Ok(vec![[2e-3, 5.0], [4e-3, 7.5]]);
    for text in ["travel / mm, F / N\n2, 5\n4, 7.5\n", "# bench\ntime / s; \"F / N\"; note; travel/mm\n0; 5; first; 2\n1; 7.5; ; 4\n"] {
        assert_eq!(by_name(text, names), wanted, "{text}");
    }
    assert_eq!(by_name("F / N, travel / mm, a, F / kN\n5, 2, x, 1\n", ["travel / mm", "F / kN"]), Ok(vec![[2e-3, 1000.0]]));
    for (text, names, wanted) in [
        ("", names, &["E0112 1:1"][..]),
        ("travel / mm, force / N\n1, 2\n", names, &["E0112 -"]),
        ("a, b\n1, 2\n", names, &["E0112 -", "E0112 -"]),
        ("travel / mm, F / N, F / N\n1, 2, 3\n", names, &["E0112 1:21"]),
        ("travel / mm, F / N\n", names, &["E0112 1:1"]),
        ("travel, F / N\n1, 2\n", ["travel", "F / N"], &["E0208 -"]),
        ("travel / mmm, F / N\n1, 2\n", ["travel / mmm", "F / N"], &["E0203 -"]),
        ("travel / N, F / N\n1, 2\n", ["travel / N", "F / N"], &["E0201 -"]),
        ("travel / mm, F / N\n1, 2\n3\n", names, &["E0112 3:1"]),
        ("travel / mm, note, F / N\n1, x, 2\n3, x, y\n", names, &["E0202 3:7"]),
        ("travel / mm, F / N\n1,1\n2,1\n3,1\n4,1\n", names, &["E0112 5:1"]),
    ] {
        assert_eq!(by_name(text, names), Err(wanted.iter().map(|w| (*w).to_owned()).collect()), "{text}");
    }
}

#[test]
fn a_file_that_cannot_be_read_is_refused_where_it_is_named() {
    for (path, code) in [
        ("none.csv", "E0101"),
        ("broken-utf8.csv", "E0102"),
        ("broken-large.csv", "E0103"),
        ("broken-folder.csv", "E0104"),
        ("broken-rights.csv", "E0101"),
    ] {
        let text = NAMED.replace("wanted.csv", path);
        let reading = read_files(&[("a.toml", &text)], None, &[]);
        assert_eq!(reading.found, [format!("{code} a.toml:5:17 \"{path}\"")]);
    }
    let reading = read_files(&[("a.toml", &NAMED.replace("\"wanted.csv\"", "3"))], None, &[]);
    assert_eq!(reading.found, ["E0206 a.toml:5:17 3"]);
    // A key that nobody asks for is unknown, not missing on the disk.
    let reading = read_files(&[("a.toml", &NAMED.replace("measured_file", "measure_file"))], None, &[]);
    assert_eq!(reading.found, ["E0301 a.toml:5:1 measure_file"]);
    // A hostile number of files ends early.
    let many = (0..100).map(|i| format!("a{i}_file = \"{i}.csv\"")).collect::<Vec<_>>().join("\n");
    let last = NAMED.replace("[design]\n", &format!("[environment]\n{many}\n[design]\n"));
    let reading = read_files(&[("a.toml", &last), ("wanted.csv", "")], None, &[]);
    assert!(reading.found.iter().any(|f| f.starts_with("E0101")) && reading.shown.contains("more than 64 files"), "{}", reading.shown);
}

#[test]
fn files_lie_beside_the_file_that_names_them() {
    let first = |reading: Reading| table(&reading).unwrap()[0][1];
    let data = |force: u8| format!("x / mm, F / N\n1, {force}\n");
    let (here, there) = (data(1), data(2));
    let all = [("wanted.csv", here.as_str()), ("bases/wanted.csv", there.as_str())];
    let base = NAMED;
    let child = "extends = \"bases/base.toml\"\n";
    let mut files = vec![("a.toml", child), ("bases/base.toml", base)];
    files.extend(all);
    assert!((first(read_files(&files, None, &[])) - 2.0).abs() < 1e-12);
    // What this file says itself lies beside it, and so does what a setting names.
    let own = format!("{child}[design]\nmeasured_file = \"wanted.csv\"\n[variants.other]\ndesign.measured_file = \"bases/wanted.csv\"\n");
    files[0].1 = &own;
    assert!((first(read_files(&files, None, &[])) - 1.0).abs() < 1e-12);
    assert!((first(read_files(&files, Some("other"), &[])) - 2.0).abs() < 1e-12);
    files[0].1 = child;
    assert!((first(read_files(&files, None, &["design.measured_file=wanted.csv"])) - 1.0).abs() < 1e-12);
    files[0].0 = "sub/a.toml";
    let moved = child.replace("bases", "../bases");
    files[0].1 = &moved;
    files.push(("sub/../bases/base.toml", base));
    files.push(("sub/wanted.csv", &here));
    assert!((first(read_files(&files, None, &["design.measured_file=wanted.csv"])) - 1.0).abs() < 1e-12);
}

#[test]
fn a_file_written_elsewhere_names_its_data_from_there() {
    let text = format!(
        "extends = \"base.toml\" # over\n{NAMED}bench = {{ file = \"../bench.csv\" }}\nlist = [{{ file = \"l.csv\" }}]\n\
         [[load]]\nprofile_file = \"p.csv\"\n[variants.v]\ndesign.measured_file = \"v.csv\" # other\n[variants.w.design]\nmeasured_file = \"/abs/w.csv\"\n"
    );
    let led = with_base_from(&text, "../old").unwrap();
    let mut wanted = text.clone();
    for path in ["base.toml", "wanted.csv", "../bench.csv", "l.csv", "p.csv", "v.csv"] {
        wanted = wanted.replace(&format!("\"{path}\""), &format!("\"../old/{path}\""));
    }
    assert_eq!(led, wanted);
    // A setting becomes a value of the file first.
    let set = with_settings(NAMED, &["design.measured_file=other.csv".to_owned()], None).unwrap();
    assert_eq!(with_base_from(&set, "..").unwrap(), NAMED.replace("wanted.csv", "../other.csv"));
}

#[test]
fn schema_and_table_say_that_it_is_a_path() {
    let schema = schema::json_schema("toy", "Toy", &mut Toy::default());
    assert_eq!(schema["properties"]["design"]["properties"]["measured_file"]["type"], "string");
    assert!(schema::markdown(&mut Toy::default()).contains("| `design.measured_file` | the path of a file"));
}
