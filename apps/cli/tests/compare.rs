//! `forcewright compare` as its users meet it.

#![allow(clippy::unwrap_used, reason = "a test that cannot run its program fails")]

mod common;

use common::{EXAMPLE, run};

/// A sheet of two files, printed and written; the lever is asked for where forces stand beside torques.
#[test]
fn two_families_in_one_sheet() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.toml"), EXAMPLE).unwrap();
    assert_eq!(run(folder.path(), &["new", "longval"]).code, Some(0));
    let mixed = run(folder.path(), &["compare", "a.toml", "longval.toml"]);
    assert!(mixed.stdout.contains("Work of its own over the range") && mixed.stdout.contains("`--lever`"), "{}", mixed.stdout);
    let seen = run(folder.path(), &["compare", "a.toml", "longval.toml", "--lever", "40 mm", "--out", "out", "--json"]);
    let document = seen.json();
    assert_eq!(document["mechanisms"][1]["measures"]["strength"]["unit"], "N");
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(page.contains("Side by side") && page.contains("--lever &#39;40 mm&#39;"), "the command repeats the run");
    let states: Vec<_> = document["mechanisms"].as_array().unwrap().iter().map(|m| m["requirements"].clone()).collect();
    assert_eq!(seen.code, Some(u8::from(states.iter().any(|s| s != "met")).into()), "{states:?}");
}

/// One file is nothing to compare with, a lever is a length, and a broken file is refused with its place; nothing is written.
#[test]
fn calls_that_make_no_sense() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.toml"), EXAMPLE).unwrap();
    std::fs::write(folder.path().join("b.toml"), EXAMPLE.replace("1 mm", "1 kg")).unwrap();
    for (arguments, code) in [
        (&["compare", "a.toml"][..], "E0125"),
        (&["compare", "a.toml", "a.toml", "--lever", "-4 mm"], "E0126"),
        (&["compare", "a.toml", "a.toml", "--lever", "4 N"], "E0126"),
        (&["compare", "a.toml", "b.toml", "--out", "out"], "E0201"),
    ] {
        let refused = run(folder.path(), arguments);
        assert_eq!(refused.code, Some(2), "{}", refused.stderr);
        assert!(refused.stderr.contains(code), "{}", refused.stderr);
    }
    assert!(!folder.path().join("out").exists());
}
