//! Seeded sets of requirements for cams: each gives designs that the full analysis confirms, or the limit that blocks.

mod seeded;

use std::fmt::Write as _;

use forcewright::base::maths;
use forcewright::{DiskFiles, SynthesisTask};
use seeded::{Sequence, assert_stands, found};

/// 5 to 300 N over 20 to 300 mm, constant or with a slope, in rooms from tight to ample.
fn sets(count: usize) -> Vec<String> {
    let mut next = Sequence(173);
    (0..count)
        .map(|i| {
            let (force, stroke) = (next.between(5.0, 300.0), next.between(20.0, 300.0));
            let (band, hysteresis) = (next.between(2.5, 8.0), next.between(3.0, 8.0));
            let width = next.between(120.0, 400.0);
            let height = 1.3 * stroke + next.between(120.0, 300.0);
            let window = [0.1 * stroke, stroke];
            let mut text = String::from("schema = 1\nmechanism = \"cam\"\ntitle = \"Asked for\"\n[requirements]\n");
            if i % 3 == 2 {
                let end = force * next.between(0.6, 1.7);
                let _ = writeln!(text, "profile = [[\"0 mm\", \"{force:.3} N\"], [\"{stroke:.3} mm\", \"{end:.3} N\"]]");
                let _ = writeln!(text, "force = {{ band = \"{band:.3} %\" }}");
            } else {
                let _ = writeln!(text, "force = {{ nominal = \"{force:.3} N\", band = \"{band:.3} %\" }}");
            }
            let _ = writeln!(text, "stroke = \"{stroke:.3} mm\"\nwindow = [\"{:.3} mm\", \"{:.3} mm\"]", window[0], window[1]);
            let _ = writeln!(text, "hysteresis = \"{hysteresis:.3} %\"\n[environment]\ngravity = \"0 m/s^2\"");
            let _ =
                writeln!(text, "[synthesise]\nroom = [\"{width:.3} mm\", \"{height:.3} mm\"]\nrolling_arm = \"0.02 mm\"\ncandidates = 2");
            text
        })
        .collect()
}

/// Rate of a helical spring of steel wire, G d⁴/(8 D³ n), with G of EN 10270-1.
fn rate_n_per_m([wire_m, mean_m, coils]: [f64; 3]) -> f64 {
    81.5e9 * maths::powi(wire_m, 4) / (8.0 * maths::powi(mean_m, 3) * coils)
}

/// Sets that are met; of the others the limit that blocks is named, with a value that was tried.
fn solved(sets: &[String]) -> usize {
    let mut met = 0;
    for text in sets {
        let found = found(text);
        if !found.met() {
            assert!(found.ways.iter().any(|w| w.confirmed), "nothing is said about what blocks:\n{text}");
            continue;
        }
        met += 1;
        let best = &found.designs[0];
        assert_stands(best);
        // Its springs can be wound: their rate is the one that is mounted.
        let state = &best.proposal.state;
        let wound = rate_n_per_m([state[5], state[6], state[7]]);
        assert!((wound / state[1] - 1.0).abs() < 1e-9, "{wound} instead of {}", state[1]);
    }
    met
}

#[test]
fn six_sets_of_requirements() {
    assert!(solved(&sets(6)) >= 5);
}

#[test]
#[ignore = "takes a minute in a release build"]
fn forty_sets_of_requirements() {
    assert!(solved(&sets(40)) >= 36);
}

/// The files of a synthesis with springs of a catalogue use only those.
#[test]
fn springs_of_a_file_are_those_that_are_mounted() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(
        folder.path().join("springs.csv"),
        "rate / N/mm,rest length / mm,largest length / mm,mass / g\n0.69,136,280,90\n1.2,100,220,70\n",
    )
    .expect("written");
    let text = "schema = 1\nmechanism = \"cam\"\ntitle = \"Asked for\"\n[requirements]\nforce = { nominal = \"50 N\", band = \"5 %\" }\n\
                stroke = \"200 mm\"\nwindow = [\"20 mm\", \"200 mm\"]\n[environment]\ngravity = \"0 m/s^2\"\n[synthesise]\nsprings_file = \"springs.csv\"\n";
    let path = folder.path().join("asked.toml");
    std::fs::write(&path, text).expect("written");
    let task = SynthesisTask::from_file(&DiskFiles, &path, &[]).map_err(|e| e.render(false)).expect("understood");
    let found = task.run(&path, &|_| true);
    assert!(found.met() && !found.designs.is_empty());
    for design in &found.designs {
        let [rate, rest] = [design.proposal.state[1], design.proposal.state[2]];
        let listed = [[690.0, 0.136], [1200.0, 0.1]].iter().any(|s| (s[0] / rate - 1.0).abs() < 1e-12 && (s[1] / rest - 1.0).abs() < 1e-12);
        assert!(listed, "{rate} {rest}");
    }
}
