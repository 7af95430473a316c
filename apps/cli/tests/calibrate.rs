//! `forcewright calibrate`: what it prints, what it writes, how it ends.
#![allow(clippy::unwrap_used, reason = "a test that cannot run its program fails")]

mod common;

use std::fmt::Write as _;

use common::{GUIDED, Noise, folder_with, listing, number, run};

/// A strip with F = 12 E I δ/L³ over 0.1 mm: 0.25 N/mm at `200 GPa`; its measurement at `190 GPa`, with even errors of 0.1 mN.
fn files(parameters: &str) -> (String, String) {
    let study = format!(
        "\n[measurements.bench] # by hand\nfile = \"bench.csv\"\nx = \"travel / mm\"\ny = \"force / N\"\n[calibrate]\nparameters = {{ {parameters} }}\n"
    );
    let stiffness = 12.0 * 190e9 * (10e-3 * 0.125e-9 / 12.0) / 1e-3 * 1e-3;
    let mut noise = Noise(7);
    let mut csv = "travel / mm,force / N\n".to_owned();
    for i in 0..60_u32 {
        let x = 0.1 * f64::from(i) / 59.0;
        let error = 1e-4 * (noise.below(2001) as f64 / 1000.0 - 1.0);
        let _ = writeln!(csv, "{x:.7},{:.9}", stiffness * x + error);
    }
    let base = GUIDED.split("[optimise]").next().unwrap();
    (format!("{base}{study}"), csv)
}

#[test]
fn parameters_are_printed_and_written() {
    let (project, csv) = files("\"material.young_modulus\" = { range = [\"100 GPa\", \"300 GPa\"] }, \"bench.offset.y\" = {}");
    let folder = folder_with(project.as_bytes());
    std::fs::write(folder.path().join("bench.csv"), csv).unwrap();
    let found = run(folder.path(), &["calibrate", "a.toml", "--out", "out"]);
    assert_eq!(found.code, Some(0), "{}\n{}", found.stdout, found.stderr);
    assert!(found.stdout.contains("material.young_modulus") && found.stdout.contains("Nothing systematic"), "{}", found.stdout);
    assert_eq!(listing(&folder.path().join("out")), ["calibrated.toml", "report.html", "result.json"]);
    let text = std::fs::read_to_string(folder.path().join("out/calibrated.toml")).unwrap();
    assert!(text.contains("# by hand") && text.contains("# keep") && text.contains("file = \"../bench.csv\""), "{text}");
    let json = run(folder.path(), &["calibrate", "a.toml", "--json"]).json();
    let young = &json["parameters"][0];
    assert!(number(&young["interval"]["low"]) < 190e9 && 190e9 < number(&young["interval"]["high"]), "{young}");
    assert!((number(&young["value"]) / 190e9 - 1.0).abs() < 0.02, "{young}");
    // The new file is a project with a variant: calibrated again, that stays.
    assert!(text.contains("young_modulus = \"200 GPa\"") && text.contains("[variants.calibrated"), "{text}");
    assert_eq!(run(folder.path(), &["check", "out/calibrated.toml"]).code, Some(0));
    assert!(found.stderr.contains("--variant calibrated"), "{}", found.stderr);
    let again = run(folder.path(), &["calibrate", "out/calibrated.toml", "--variant", "calibrated", "--json"]).json();
    assert!((number(&again["parameters"][0]["value"]) / number(&young["value"]) - 1.0).abs() < 1e-5);
}

#[test]
fn what_is_not_determined_ends_with_one_and_what_is_wrong_with_two() {
    let (project, csv) = files("\"material.young_modulus\" = {}, \"design.depth\" = {}");
    let folder = folder_with(project.as_bytes());
    std::fs::write(folder.path().join("bench.csv"), &csv).unwrap();
    let found = run(folder.path(), &["calibrate", "a.toml"]);
    assert!(found.code == Some(1) && found.stderr.contains("W0902"), "{}\n{}", found.stdout, found.stderr);
    assert_eq!(listing(folder.path()), ["a.toml", "bench.csv"]);
    // A strip of 100 mm that is to go 150 mm has no curve to begin with; the section that asks for one is named.
    let found = run(folder.path(), &["calibrate", "a.toml", "--set", "load.travel=150 mm", "--set", "model.beam=inextensible"]);
    assert_eq!(found.code, Some(3), "{}", found.stderr);
    assert!(
        found.stderr.contains("error[E0907]") && found.stderr.contains("a.toml:") && found.stderr.contains("[calibrate]"),
        "{}",
        found.stderr
    );
    let found = run(folder.path(), &["calibrate", "a.toml", "--set", "measurements.bench.x=way / mm"]);
    assert!(found.code == Some(2) && found.stderr.contains("error[E0112]"), "{}", found.stderr);
    std::fs::remove_file(folder.path().join("bench.csv")).unwrap();
    assert_eq!(run(folder.path(), &["calibrate", "a.toml"]).code, Some(4));
}
