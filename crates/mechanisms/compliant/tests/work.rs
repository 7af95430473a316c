//! Work done for Table 3: counts, not clocks, so that a slower algorithm fails here on any machine.
//!
//! The counts are exact. When a change of the solver moves them on purpose, run
//! `cargo test -p forcewright-compliant --test work`, look at both columns of the failure, and put the new counts here together with
//! the change that explains them. More work for the same accuracy needs a reason.

mod common;

use common::{SHAPES, outcome};

/// Stations, polynomial degree, Newton iterations, residual evaluations, factorisations, steps, rejected steps of one solve.
fn work(model: &str, accuracy: &str) -> [u64; 7] {
    let result = outcome(SHAPES, &[&format!("model.beam={model}"), &format!("model.accuracy={accuracy}")]);
    let names: Vec<&str> = result.counters.iter().map(|c| c.name).collect();
    let order = ["stations", "polynomial_degree", "newton_iterations", "residual_evaluations", "factorisations", "steps", "rejected_steps"];
    assert_eq!(names, order);
    std::array::from_fn(|i| result.counters[i].count)
}

#[test]
fn inextensible_at_1e8() {
    assert_eq!(work("inextensible", "1e-8"), [129, 16, 188, 190, 190, 151, 0]);
}

#[test]
fn reissner_at_1e8() {
    assert_eq!(work("reissner", "1e-8"), [129, 16, 185, 187, 187, 151, 0]);
}

#[test]
fn less_accuracy_is_less_work() {
    // Two polynomial degrees less at 1e-5; the number of stations decides the iterations.
    assert_eq!(work("reissner", "1e-5"), [129, 12, 185, 187, 187, 151, 0]);
    assert!(work("inextensible", "1e-3")[1] < work("inextensible", "1e-5")[1]);
}
