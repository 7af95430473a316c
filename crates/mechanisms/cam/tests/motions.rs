//! The gallery's motions, from the project file to the metrics.

use forcewright_base::diagnostics::{Diagnostics, Span};
use forcewright_cam::{Cam, Spec};
use forcewright_contract::family::Mechanism as _;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;
use forcewright_model::{CheckState, Outcome, StatusKind};

const PRESS: &str = include_str!("../../../../examples/cam/bench-press.toml");
const RELEASE: &str = include_str!("../../../../examples/cam/weight-release.toml");

/// The outcome of a project, or the codes of what was said.
fn solve(text: &str, set: &[&str]) -> Result<Outcome, Vec<String>> {
    let choices = Choices { variant: None, set: set.iter().map(|s| (*s).to_owned()).collect() };
    let project = Project::from_text("test.toml", text, &choices);
    let mut diagnostics: Diagnostics = project.diagnostics;
    let mut spec: Spec = read::read(&project.tree, Span::default(), &mut diagnostics);
    let design = Cam::resolve(&mut spec, &mut diagnostics);
    let said: Vec<String> = diagnostics.in_file_order().iter().map(|d| format!("{}: {}", d.code, d.message)).collect();
    design.filter(|_| said.is_empty()).map(|d| Cam::analyse(&d, &mut |_| true).outcome).ok_or(said)
}

fn metric(outcome: &Outcome, name: &str) -> f64 {
    outcome.metrics.iter().find(|m| m.name == name).unwrap_or_else(|| panic!("no {name}")).value
}

#[test]
fn a_repetition_of_a_bench_press() {
    let press = solve(PRESS, &[]).expect("sound");
    assert_eq!(press.status.kind, StatusKind::Complete);
    assert!(press.checks.iter().all(|c| c.state == CheckState::Met), "the example meets what it asks for");
    // 15/8 of the mean speed is the fastest of this law.
    assert!((metric(&press, "speed_max") - 1.875 * 0.43 / 0.9).abs() < 1e-12);
    let (given, lost) = (metric(&press, "work_in"), metric(&press, "energy_lost"));
    // The hand lifts with about 650 N over 0.43 m and loses a few percent.
    assert!((260.0..300.0).contains(&given) && (0.01..0.04).contains(&(lost / given)), "{given} J, {lost} J");
    assert!(press.curves.iter().any(|c| c.name == "motion_speed"));
}

#[test]
fn a_weight_let_go_and_one_that_friction_holds() {
    let run = solve(RELEASE, &[]).expect("sound");
    assert_eq!(run.status.kind, StatusKind::Complete, "{}", run.status.message);
    let (time, speed) = (metric(&run, "time_to_end"), metric(&run, "speed_end"));
    // 0.2 m nearly evenly accelerated.
    assert!((time * speed / 0.4 - 1.0).abs() < 0.2 && speed > 0.2, "{time} s, {speed} m/s");
    assert!(metric(&run, "slack_time").abs() < 1e-15);
    assert!(run.curves.iter().any(|c| c.name == "motion_cable"));
    let held = solve(RELEASE, &["motion.hanging_mass=5.05 kg"]).expect("sound");
    assert!(held.status.message.contains("held by friction"), "{}", held.status.message);
    assert!(metric(&held, "energy_lost").abs() < 1e-15 && held.metrics.iter().all(|m| m.name != "time_to_end"));
}

/// Without a flaw nothing pushes a free slider sideways, and it moves as on its guide; tilted, it goes sideways.
#[test]
fn a_free_slider_is_let_go() {
    let [guided, free] = ["rigid", "free"].map(|guide| solve(RELEASE, &[&format!("motion.guide={guide}")]).expect("sound"));
    for name in ["time_to_end", "speed_end", "energy_lost", "work_in"] {
        assert!((metric(&guided, name) / metric(&free, name) - 1.0).abs() < 1e-9, "{name}");
    }
    let tilted = solve(RELEASE, &["motion.guide=free", "errors.tilt=\"0.1 deg\""]).expect("sound");
    assert_eq!(tilted.status.kind, StatusKind::Complete, "{}", tilted.status.message);
    let curve = tilted.curves.iter().find(|c| c.name == "motion_sideways").expect("a curve");
    assert!(curve.branches.iter().flat_map(|b| &b.y).any(|x| x.abs() > 1e-4));
}

#[test]
fn keys_of_another_law_are_refused() {
    let code = |text: &str, set: &[&str]| solve(text, set).expect_err("refused").first().map(|s| s[..5].to_owned());
    assert_eq!(code(PRESS, &["motion.pull=5 N"]).as_deref(), Some("E0610"));
    assert_eq!(code(RELEASE, &["motion.rise=5 mm"]).as_deref(), Some("E0610"));
    assert_eq!(code(RELEASE, &["motion.start=300 mm"]).as_deref(), Some("E0605"));
    let massless = RELEASE
        .lines()
        .filter(|l| !["mass", "slider_mass", "brace_mass", "roller_mass", "hanging_mass"].iter().any(|k| l.starts_with(&format!("{k} ="))));
    assert_eq!(code(&massless.collect::<Vec<_>>().join("\n"), &["motion.pull=60 N"]).as_deref(), Some("E0611"));
}

/// With so much rolling resistance that it alone turns the force of the cam round, no force moves the slider: eq. (6) has a negative
/// denominator there, and once a force was computed all the same. Near the start the mechanism locks first.
#[test]
fn friction_that_locks_is_no_force() {
    let outcome = solve(
        include_str!("../../../../examples/cam/sanchez-2-springs.toml"),
        &["design.rolling_arm=8 mm", "requirements.window=[\"40 mm\", \"210 mm\"]"],
    )
    .expect("a design");
    let warned = outcome.warnings.iter().any(|w| w.code == "W0609") || outcome.status.message.contains("locks");
    assert!(warned, "{:?} {:?}", outcome.status, outcome.warnings);
    let up = outcome.curves.iter().find(|c| c.name == "force").and_then(|c| c.branches.iter().find(|b| b.name == "up")).expect("a force");
    // Where it moves, resistance takes from what pulls it: never less than without friction.
    let still = outcome
        .curves
        .iter()
        .find(|c| c.name == "force")
        .and_then(|c| c.branches.iter().find(|b| b.name == "without_friction"))
        .expect("a force");
    assert!(up.y.iter().zip(&still.y).all(|(up, still)| up >= still));
}
