//! Seeded sets of requirements for cable drives: each gives designs that the full analysis confirms, or the limit that blocks.

use std::path::Path;

use std::sync::Mutex;
use std::time::{Duration, Instant};

use forcewright::base::maths;
use forcewright::{Choices, Loaded, Stage, SynthesisTask, Synthesised};

/// `SplitMix64` of Steele, Lea & Flood 2014: the same sets on every machine.
struct Sequence(u64);

impl Sequence {
    /// Between two values, spread evenly over their ratio.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let unit = f64::from(u32::try_from((z ^ (z >> 31)) >> 32).expect("32 bits")) / 4_294_967_296.0;
        low * maths::powf(high / low, unit)
    }
}

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

fn found(text: &str) -> Synthesised {
    let task = SynthesisTask::from_text("asked.toml", text, &[]).map_err(|e| e.render(false)).expect("understood");
    task.run(Path::new("asked.toml"), &|_| true)
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
            let loaded =
                Loaded::from_text(&design.file, &design.text, &Choices::default()).map_err(|e| e.render(false)).expect("a project");
            let outcome = loaded.solve(&design.file, "", &mut |_| true).outcome;
            assert!(outcome.requirements_met(), "{}", design.text);
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
        let found = task_of(&text).run(Path::new("asked.toml"), &|progress| {
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

fn task_of(text: &str) -> SynthesisTask {
    SynthesisTask::from_text("asked.toml", text, &[]).map_err(|e| e.render(false)).expect("understood")
}

#[test]
fn one_thread_and_four_find_the_same() {
    let text = &sets(1)[0];
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let found = pool.install(|| found(text));
        (found.designs.iter().map(|d| d.text.clone()).collect::<Vec<_>>(), found.analysed, found.effort)
    };
    assert_eq!(with(1), with(4));
}
