//! What tests of syntheses with seeded sets of requirements share.

#![allow(dead_code, reason = "each test file uses a part of it")]

use std::path::Path;

use forcewright::base::maths;
use forcewright::{Choices, Designed, Loaded, SynthesisTask, Synthesised};

/// `SplitMix64` of Steele, Lea & Flood 2014: the same sets on every machine.
pub(crate) struct Sequence(pub(crate) u64);

impl Sequence {
    /// Between two values, spread evenly over their ratio.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let unit = f64::from(u32::try_from((z ^ (z >> 31)) >> 32).expect("32 bits")) / 4_294_967_296.0;
        low * maths::powf(high / low, unit)
    }
}

pub(crate) fn task(text: &str) -> SynthesisTask {
    SynthesisTask::from_text("asked.toml", text, &[]).map_err(|e| e.render(false)).expect("understood")
}

pub(crate) fn found(text: &str) -> Synthesised {
    task(text).run(Path::new("asked.toml"), &|_| true)
}

/// The file of a design, read and analysed as any project, meets everything.
pub(crate) fn assert_stands(design: &Designed) {
    let loaded = Loaded::from_text(&design.file, &design.text, &Choices::default()).map_err(|e| e.render(false)).expect("a project");
    let outcome = loaded.solve(&design.file, "", &mut |_| true).outcome;
    assert!(outcome.requirements_met(), "{}", design.text);
}

/// One thread and four find the same files with the same work; they are handed back.
pub(crate) fn the_same_with_one_thread_and_four(text: &str) -> Vec<String> {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let found = pool.install(|| found(text));
        (found.designs.iter().map(|d| d.text.clone()).collect::<Vec<_>>(), found.analysed, found.effort)
    };
    let one = with(1);
    assert_eq!(one, with(4));
    one.0
}
