//! Seeded sets of requirements for cable drives: each gives designs that the full analysis confirms, or the limit that blocks.

mod seeded;

use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use forcewright::Stage;
use seeded::{Sequence, assert_stands, found, task, the_same_with_one_thread_and_four};

/// 2 to 40 N·m, ratios of 3 to 10, in rooms from tight to ample.
fn sets(count: usize) -> Vec<String> {
    let mut next = Sequence(411);
    let set = |_| {
        let (torque, ratio) = (next.between(2.0, 40.0), next.between(3.0, 10.0).round());
        let (stiffness, lost) = (torque * next.between(40.0, 200.0), next.between(0.02, 0.2));
        let (diameter, width) = (next.between(80.0, 400.0), next.between(30.0, 150.0));
        let (safety, friction, travel) = (next.between(2.0, 6.0), next.between(0.1, 0.25), next.between(60.0, 300.0));
        format!(
            r#"schema = 1
mechanism = "capstan"
title = "Asked for"
[requirements]
torque = "{torque:.3} N*m"
stiffness = {{ min = "{stiffness:.1} N*m/rad" }}
lost_motion = {{ max = "{lost:.4} deg" }}
safety_factor = {safety:.2}
[synthesise]
ratio = {ratio}
travel = "{travel:.1} deg"
friction = {friction:.3}
envelope = {{ diameter = "{diameter:.1} mm", width = "{width:.1} mm" }}
candidates = 2
"#
        )
    };
    (0..count).map(set).collect()
}

#[test]
fn each_set_is_met_or_its_limit_named() {
    let sets = sets(6);
    let mut met = 0;
    for text in &sets {
        let found = found(text);
        assert!(found.effort.is_some());
        if !found.met() {
            assert!(found.ways.iter().any(|w| w.confirmed), "nothing is said about what blocks:\n{text}");
            continue;
        }
        met += 1;
        assert!(found.rejected.is_empty(), "{:?}\n{text}", found.rejected);
        assert!(!found.tables.is_empty());
        for design in &found.designs {
            // The room is asked for in the file.
            for name in ["output_drum_diameter", "output_drum_length", "input_drum_length"] {
                assert!(design.report.outcome.check(name).is_some_and(|c| c.required), "{name}");
            }
            assert_stands(design);
        }
    }
    assert!(met >= 2 && met < sets.len(), "{met} of {} are met: the sets should have both", sets.len());
}

/// A search that takes long ends soon after it is told to, keeps what it found, and tells where it stands all the while.
#[test]
fn an_interrupted_synthesis_ends_at_once() {
    // Limits on metrics are tested by full analyses, and this one is hardly met.
    let text = sets(1)[0].replace("[synthesise]", "limits = { shaft_load = { max = \"4000 N\" } }\n[synthesise]");
    for stop_at in [0.0, 0.1] {
        let (seen, stopped) = (Mutex::new(Vec::new()), Mutex::new(None::<Instant>));
        let found = task(&text).run(Path::new("asked.toml"), &|progress| {
            let part = progress.done as f64 / progress.of as f64;
            seen.lock().expect("sound").push((progress.stage, part));
            let go_on = progress.stage == Stage::Sizing && part <= stop_at;
            let mut stopped = stopped.lock().expect("sound");
            if !go_on && stopped.is_none() {
                *stopped = Some(Instant::now());
            }
            go_on
        });
        let stopped = stopped.into_inner().expect("sound").expect("stopped");
        assert!(found.interrupted);
        // Without optimisation a full analysis of what was found takes a while; a search takes minutes.
        assert!(stopped.elapsed() < Duration::from_secs(5), "{:?}", stopped.elapsed());
        let seen = seen.into_inner().expect("sound");
        assert!(seen.iter().any(|(stage, _)| *stage == Stage::Sizing));
    }
}

#[test]
fn one_thread_and_four_find_the_same() {
    the_same_with_one_thread_and_four(&sets(1)[0]);
}
