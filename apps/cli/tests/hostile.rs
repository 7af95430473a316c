//! Hostile files and calls, through the real program: an error with a code and exit code 2 or 4, never a panic, a hang or a half-written
//! result.

mod common;

use std::fmt::Write as _;
use std::path::Path;

use common::{EXAMPLE, Run, folder, folder_with, listing, run};

/// Checks and solves `a.toml`, and asserts that both refuse it and leave nothing behind.
fn assert_file_refused(folder: &Path, what: &str) -> Run {
    let before = listing(folder);
    run(folder, &["check", "a.toml", "--json"]).assert_refused(what);
    let solved = run(folder, &["solve", "a.toml", "--out", "out"]);
    solved.assert_refused(what);
    assert_eq!(listing(folder), before, "{what}: something is left behind");
    solved
}

fn edited(from: &str, to: &str) -> String {
    assert!(EXAMPLE.contains(from), "{from} is not in the example");
    EXAMPLE.replacen(from, to, 1)
}

#[test]
fn texts() {
    let deep = 20_000;
    let cases: Vec<(&str, Vec<u8>)> = vec![
        ("empty", Vec::new()),
        ("only comments", b"# a\n# b\n".to_vec()),
        ("only a byte order mark", b"\xef\xbb\xbf".to_vec()),
        ("lone carriage returns", EXAMPLE.replace('\n', "\r").into_bytes()),
        ("zeros", vec![0; 1000]),
        ("a zero in a text", edited("title = \"", "title = \"\0").into_bytes()),
        ("not UTF-8", [EXAMPLE.as_bytes(), b"# \xff\xfe"].concat()),
        ("UTF-16", EXAMPLE.encode_utf16().flat_map(u16::to_le_bytes).collect()),
        ("one line of a megabyte", format!("title = \"{}", "x".repeat(1_000_000)).into_bytes()),
        ("more than a megabyte", format!("{EXAMPLE}# {}", "x".repeat(1_100_000)).into_bytes()),
        ("lists in lists", format!("a = {}", "[".repeat(deep)).into_bytes()),
        ("closed lists in lists", format!("a = {}{}", "[".repeat(deep), "]".repeat(deep)).into_bytes()),
        ("tables in tables", format!("a = {}", "{b=".repeat(deep)).into_bytes()),
        ("a dotted key", format!("{}a = 1", "a.".repeat(deep)).into_bytes()),
        ("a dotted header", format!("[{}a]", "a.".repeat(deep)).into_bytes()),
        ("many open quotes", "\"\"\"'''".repeat(deep).into_bytes()),
        ("many signs", "=\n".repeat(400_000).into_bytes()),
        ("many keys", ((0..80_000).fold(String::new(), |text, i| text + &format!("a{i} = 1\n")) + EXAMPLE).into_bytes()),
        ("a duplicate key", edited("depth = \"10 mm\"", "depth = \"10 mm\"\ndepth = \"11 mm\"").into_bytes()),
        ("a duplicate table", format!("{EXAMPLE}\n[load]\nnode = \"n5\"\n").into_bytes()),
        ("a file that extends itself", edited("schema = 1", "schema = 1\nextends = \"a.toml\"").into_bytes()),
        ("a file that extends its folder", edited("schema = 1", "schema = 1\nextends = \".\"").into_bytes()),
        ("a file that extends a device", edited("schema = 1", "schema = 1\nextends = \"/dev/zero\"").into_bytes()),
        ("a confusable key", edited("depth = ", "d\u{435}pth = ").into_bytes()),
        ("a confusable quoted key", edited("depth = ", "\"d\u{435}pth\" = ").into_bytes()),
        ("a key of escapes", edited("depth = ", "\"\\u001b[31m\\u009b\\u202edepth\" = ").into_bytes()),
        ("raw escapes", edited("title = \"", "title = \"\u{1b}]0;x\u{7}").into_bytes()),
        ("a name of escapes", edited("between = [\"n1\"", "between = [\"\\u001b[2Jn1\"").into_bytes()),
        ("nothing but a family", b"schema = 1\nmechanism = \"compliant\"\n".to_vec()),
        ("a family of escapes", b"schema = 1\nmechanism = \"\\u001b[31m\"\n".to_vec()),
        ("another family", edited("\"compliant\"", "\"cam\"").into_bytes()),
        ("no schema", edited("schema = 1", "").into_bytes()),
        ("a huge schema", edited("schema = 1", "schema = 9223372036854775807").into_bytes()),
    ];
    for (what, bytes) in &cases {
        assert_file_refused(folder_with(bytes).path(), what);
    }
    for harmless in [EXAMPLE.replace('\n', "\r\n"), format!("\u{feff}{EXAMPLE}"), format!("\u{feff}\u{feff}{EXAMPLE}")] {
        let folder = folder_with(harmless.as_bytes());
        assert_eq!(run(folder.path(), &["check", "a.toml"]).code, Some(0));
    }
}

#[test]
fn values() {
    let many = |n: usize, line: &dyn Fn(usize) -> String| (0..n).map(line).collect::<Vec<_>>().concat();
    let nodes = many(10_000, &|i| format!("m{i} = {{ at = [\"{i} mm\", \"1 mm\"] }}\n"));
    let beams = many(600, &|i| format!("[[design.beams]]\nname = \"c{i}\"\nbetween = [\"n1\", \"n3\"]\nbend = [1]\n"));
    let cases: Vec<(&str, String)> = vec![
        ("10 000 nodes", edited("[design.nodes]\n", &format!("[design.nodes]\n{nodes}"))),
        ("600 beams", edited("[layout]", &format!("{beams}[layout]"))),
        ("33 coefficients", edited("bend = [1.3092, -1.5707]", &format!("bend = [{}]", ["0.1"; 33].join(", ")))),
        ("100 000 coefficients", edited("bend = [1.3092, -1.5707]", &format!("bend = [{}]", vec!["1"; 100_000].join(",")))),
        ("a coefficient of a million", edited("1.3092", "1e6")),
        ("a large whole number", edited("1.3092", "9000000000000000000")),
        ("a hexadecimal number", edited("1.3092", "0xFFFFFFFFFFFFFFFF")),
        ("nan", edited("1.3092", "nan")),
        ("infinity", edited("1.3092", "-inf")),
        ("1e400", edited("1.3092", "1e400")),
        ("nan with a unit", edited("\"10 mm\"", "\"nan mm\"")),
        ("1e400 with a unit", edited("\"10 mm\"", "\"1e400 mm\"")),
        ("digits without end", edited("\"10 mm\"", &format!("\"{} mm\"", "9".repeat(100_000)))),
        ("a unit without end", edited("\"10 mm\"", &format!("\"1 {}mm\"", "m*".repeat(100_000)))),
        ("a travel of nothing", edited("\"13.6 mm\"", "\"0 mm\"")),
        ("a travel backwards", edited("\"13.6 mm\"", "\"-1 mm\"")),
        ("no beams", edited("[[design.beams]]", "[[design.beans]]")),
        ("a name twice", edited("name = \"b2\"", "name = \"b1\"")),
        ("a beam on one node", edited("[\"n1\", \"n3\"]", "[\"n3\", \"n3\"]")),
        ("an unknown node", edited("[\"n1\", \"n3\"]", "[\"n1\", \"n33\"]")),
        ("nodes at one place", edited("[\"34.5 mm\", \"0 mm\"]", "[\"30.5 mm\", \"18.77 mm\"]")),
        ("a loose node", edited("[design.nodes]\n", "[design.nodes]\nn9 = { at = [\"1 mm\", \"1 mm\"] }\n")),
        ("a load that cannot move", edited("direction = [0, -1]", "direction = [1, 0]")),
        ("a direction of nothing", edited("direction = [0, -1]", "direction = [0, 0]")),
        ("a diagonal mirror", edited("\"x = 0\"", "\"x = y\"")),
        ("an unknown material", edited("\"POM-C\"", "\"unobtainium\"")),
        ("two shapes", edited("bend = [1.3092, -1.5707]", "bend = [1.3092, -1.5707]\nstraight = true")),
    ];
    for (what, text) in &cases {
        assert_file_refused(folder_with(text.as_bytes()).path(), what);
    }
    for section in ["[requirements]", "[material]", "[design]", "[design.nodes]", "[load]"] {
        // Without its header, a section's keys belong to the one above.
        assert_file_refused(folder_with(edited(section, "").as_bytes()).path(), section);
    }
}

#[cfg(unix)]
#[test]
fn things_that_are_no_files() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    use std::process::Command;

    type Make = fn(&Path);
    let cases: [(&str, Make, i32); 7] = [
        ("a folder", |p| std::fs::create_dir(p).unwrap(), 4),
        ("a broken link", |p| symlink("none", p).unwrap(), 4),
        ("a link to itself", |p| symlink(p, p).unwrap(), 4),
        ("a device without end", |p| symlink("/dev/zero", p).unwrap(), 4),
        ("a pipe that nobody writes to", |p| assert!(Command::new("mkfifo").arg(p).status().unwrap().success()), 4),
        ("a file of 100 MB", |p| std::fs::File::create(p).unwrap().set_len(100_000_000).unwrap(), 2),
        ("a file that never existed", |_| {}, 4),
    ];
    for (what, make, code) in cases {
        let folder = tempfile::tempdir().unwrap();
        make(&folder.path().join("a.toml"));
        assert_eq!(assert_file_refused(folder.path(), what).code, Some(code), "{what}");
        // The same, extended by a file.
        std::fs::write(folder.path().join("b.toml"), "extends = \"a.toml\"\nschema = 1\n").unwrap();
        let run = run(folder.path(), &["solve", "b.toml"]);
        run.assert_refused(what);
        assert!(run.code == Some(code) && run.stderr.contains("b.toml:1:11"), "{what}: {}", run.stderr);
    }
    let folder = folder();
    let file = folder.path().join("a.toml");
    std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o000)).unwrap();
    // The superuser reads everything; there is nothing to test then.
    if std::fs::read(&file).is_err() {
        assert_eq!(assert_file_refused(folder.path(), "no permission").code, Some(4));
    }
}

#[test]
fn calls() {
    let folder = folder();
    let long = format!("{}a=1", "a.".repeat(20_000));
    let nested = format!("title={}", "[".repeat(20_000));
    for set in [
        "",
        "=",
        "=1",
        "design",
        "design.",
        ".depth=1 mm",
        "design..depth=1 mm",
        "design.depth",
        "design.depth=",
        "design.depth=\n1 mm\u{1b}[31m",
        "design.dep\u{1b}[31mth=1 mm",
        "design.depth=nan",
        "design.depth=1e400",
        "design.depth=[",
        "design.depth={a=",
        "design=1",
        "design.beams=1",
        "design.beams=[]",
        "design.beams.b1=1",
        "design.beams.b9.bend=[1]",
        "design.nodes.n1=[]",
        "schema=2",
        "mechanism=1",
        "extends=b.toml",
        "variants.x=1",
        "\u{0430}=1",
        "load.travel=9 N",
        long.as_str(),
        nested.as_str(),
    ] {
        let run = run(folder.path(), &["solve", "a.toml", "--out", "out", "--set", set]);
        run.assert_refused(set);
        assert!(run.code == Some(2) && !folder.path().join("out").exists(), "{set}");
    }
    for variant in ["", "none", "pape", "\u{1b}[31m", "paper\n"] {
        let run = run(folder.path(), &["solve", "a.toml", "--variant", variant]);
        run.assert_refused(variant);
        assert!(run.code == Some(2) && run.stderr.contains("error[E0110]"), "{variant}: {}", run.stderr);
    }
    for arguments in [&["slove"][..], &["\u{1b}[31m"], &["solve", "--\u{1b}[31m"], &["solve", "a\u{1b}[31m.toml"], &["new", "\u{1b}[31m"]] {
        run(folder.path(), arguments).assert_refused(&format!("{arguments:?}"));
    }
    let settings = vec!["--set=design.depth=11 mm"; 3000];
    let many: Vec<&str> = ["check", "a.toml"].into_iter().chain(settings).collect();
    assert_eq!(run(folder.path(), &many).code, Some(0));
}

/// Every value of the example, in order: where it stands.
fn value_places(text: &str) -> Vec<(usize, usize)> {
    let mut places = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let plain = line.split('#').next().unwrap_or(line);
        if let Some(at) = plain.find(" = ") {
            places.push((start + at + 3, start + plain.trim_end().len()));
        }
        // Inside of tables and lists, every text and number on its own.
        let mut from = 0;
        while let Some(at) = plain[from..].find('"') {
            let open = from + at;
            let Some(close) = plain[open + 1..].find('"') else { break };
            places.push((start + open, start + open + close + 2));
            from = open + close + 2;
        }
        start += line.len();
    }
    places
}

#[test]
fn every_value_replaced_by_every_wrong_kind() {
    let kinds = [
        "1",
        "-0.5",
        "true",
        "[]",
        "[1, \"a\"]",
        "[[1]]",
        "{}",
        "{ a = 1 }",
        "1979-05-27T07:32:00Z",
        "\"\"",
        "\"ä\"",
        "\"5 K\"",
        "nan",
        "9223372036854775807",
    ];
    let mut refused = 0;
    for (start, end) in value_places(EXAMPLE) {
        for kind in kinds {
            let text = format!("{}{kind}{}", &EXAMPLE[..start], &EXAMPLE[end..]);
            match forcewright::Loaded::from_text("a.toml", &text, &forcewright::Choices::default()) {
                Ok(_) => {}
                Err(error) => {
                    refused += 1;
                    let shown = error.render(false);
                    for diagnostic in error.diagnostics.in_file_order() {
                        assert!(diagnostic.span.is_some() && diagnostic.help.is_some(), "{kind} at {start}: {shown}");
                    }
                    assert!(shown.contains("error[E") && shown.contains("--> a.toml:"), "{kind} at {start}: {shown}");
                }
            }
        }
    }
    assert!(refused > 500, "only {refused} refused");
}

#[test]
fn hostile_but_valid_designs_end_in_time() {
    let folder = folder();
    let mut slow = String::new();
    for set in [
        &["design.beams.b1.bend=[50]"][..],
        &["design.beams.b1.bend=[50, -50, 50]"],
        &["design.thickness=100 mm"],
        &["design.thickness=1 m"],
        &["design.thickness=1 µm"],
        &["load.travel=60 mm"],
        &["load.travel=1e-7 m", "requirements.travel=1e-8 m"],
        &["model.beam=inextensible", "design.beams.b1.bend=[0]", "design.beams.b3.bend=[0]"],
        &["model.beam=inextensible", "load.direction=[0, 1]", "load.travel=60 mm"],
        &["material.young_modulus=1e3 Pa"],
        &["material.young_modulus=1e13 Pa"],
        &["design.nodes.n3.at=[\"9 m\", \"9 m\"]"],
        &["design.depth=10 m"],
        &["model.accuracy=1e-12"],
        &["model.accuracy=0.01"],
    ] {
        let mut arguments = vec!["solve", "a.toml", "--out", "out"];
        arguments.extend(set.iter().flat_map(|s| ["--set", s]));
        let run = run(folder.path(), &arguments);
        assert!(matches!(run.code, Some(0 | 1 | 3)), "{set:?}: {:?}\n{}", run.code, run.stderr);
        run.assert_plain("a hostile design");
        assert!(folder.path().join("out/report.html").exists());
        let _ = writeln!(slow, "{:5.2} s, exit {:?}: {set:?}", run.took.as_secs_f64(), run.code);
    }
    println!("{slow}");
}

#[test]
fn values_at_the_edge_of_the_numbers_are_refused_or_solved() {
    let folder = folder();
    for set in [
        "design.thickness=1e-300 m",
        "design.depth=1e-300 m",
        "material.young_modulus=1e-300 Pa",
        "material.poisson_ratio=0.5",
        "requirements.force.nominal=1e-300 N",
    ] {
        let run = run(folder.path(), &["solve", "a.toml", "--set", set]);
        assert!(matches!(run.code, Some(0..=3)), "{set}: {:?}\n{}", run.code, run.stderr);
        if run.code == Some(2) {
            run.assert_refused(set);
        }
    }
}
