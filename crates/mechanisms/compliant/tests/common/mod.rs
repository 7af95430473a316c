//! From a project text to a behaviour, for the tests of this family.

#![allow(dead_code, reason = "each test uses its share")]

use forcewright_base::diagnostics::Diagnostics;
use forcewright_compliant::{Behaviour, Compliant, Design, Measured, Spec, measure};
use forcewright_contract::family::Mechanism;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;
use forcewright_model::{Check, Outcome};

/// Table 3 of the paper by its nodes.
pub(crate) const NODES: &str = include_str!("../../../../../examples/compliant/lan-table3.toml");
/// Table 3 of the paper by its shapes.
pub(crate) const SHAPES: &str = include_str!("../../../../../reference/lan2010-shapes.toml");

/// A text with settings, understood or refused.
pub(crate) fn understand(text: &str, set: &[&str]) -> (Option<Design>, Diagnostics) {
    understand_variant(text, None, set)
}

/// The same with a variant.
pub(crate) fn understand_variant(text: &str, variant: Option<&str>, set: &[&str]) -> (Option<Design>, Diagnostics) {
    let choices = Choices { variant: variant.map(str::to_owned), set: set.iter().map(|s| (*s).to_owned()).collect() };
    let mut project = Project::from_text("test.toml", text, &choices);
    let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    let design = Compliant::resolve(&mut spec, &mut project.diagnostics);
    (design.filter(|_| !project.diagnostics.has_errors()), project.diagnostics)
}

/// A design that must be understood.
pub(crate) fn design(text: &str, set: &[&str]) -> Design {
    let (design, diagnostics) = understand(text, set);
    let all: Vec<String> = diagnostics.in_file_order().iter().map(|d| format!("{}: {}", d.code, d.message)).collect();
    design.unwrap_or_else(|| panic!("{set:?}: {all:?}"))
}

/// A design with what it does.
pub(crate) struct Solved {
    pub(crate) design: Design,
    pub(crate) behaviour: Behaviour,
    pub(crate) measured: Measured,
}

pub(crate) fn solve(text: &str, set: &[&str]) -> Solved {
    let design = design(text, set);
    let behaviour = Behaviour::of(&design, &mut |_| true).expect("a network that was checked");
    let measured = measure(&design, &behaviour);
    Solved { design, behaviour, measured }
}

impl Solved {
    /// A metric that must exist.
    pub(crate) fn get(&self, name: &str) -> f64 {
        self.measured.get(name).unwrap_or_else(|| panic!("no {name}: {:?}", self.behaviour.path.status))
    }

    /// Force of the whole layout as metrics see it: interpolated between stations.
    pub(crate) fn force(&self, displacement_m: f64) -> f64 {
        self.behaviour.curve.as_ref().expect("a curve").force(displacement_m)
    }
}

/// The result as everybody else sees it.
pub(crate) fn outcome(text: &str, set: &[&str]) -> Outcome {
    Compliant::analyse(&design(text, set), &mut |_| true).outcome
}

/// The first check with this code.
pub(crate) fn check<'a>(outcome: &'a Outcome, code: &str) -> &'a Check {
    outcome.checks.iter().find(|c| c.code == code).unwrap_or_else(|| panic!("no {code} in {:?}", outcome.checks))
}

/// Asserts a value to a relative tolerance.
#[track_caller]
pub(crate) fn near(value: f64, want: f64, relative: f64, what: &str) {
    let error = (value / want - 1.0).abs();
    assert!(error <= relative, "{what}: {value}, wanted {want}: {error:.2e} off, {relative:.0e} allowed");
}

/// Asserts a value to an absolute tolerance.
#[track_caller]
pub(crate) fn close(value: f64, want: f64, absolute: f64, what: &str) {
    let error = (value - want).abs();
    assert!(error <= absolute, "{what}: {value}, wanted {want}: {error:.2e} off, {absolute:.0e} allowed");
}

/// Numbers in (0, 1) from a seed: `SplitMix64`, Steele, Lea & Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        ((z >> 11) as f64 + 0.5) / 9_007_199_254_740_992.0
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}
