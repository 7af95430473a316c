//! The design problem of Lan, Wang & Chen 2010 (Table 1) as a search: in the paper's box, at its stress, from straight beams.
//!
//! The bars are those that a search with exact gradients is known to reach from such a start (docs/theory/compliant.md); what is reached
//! is judged by the full analysis of the file that the search writes, not by the search itself.

use std::path::Path;

use forcewright::{Choices, DiskFiles, Loaded, Optimised};

fn search(settings: &[&str]) -> Optimised {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/compliant/optimise-lan-box.toml");
    let choices = Choices { variant: None, set: settings.iter().map(|s| (*s).to_owned()).collect() };
    let loaded = Loaded::from_file(&DiskFiles, &path, &choices).map_err(|e| e.render(false)).expect("the example is understood");
    loaded.optimise(&DiskFiles, &path, (None, None), &|_| true).map_err(|e| e.render(false)).expect("the search can be posed")
}

/// What the full analysis says of the result.
fn reached(found: &Optimised, name: &str) -> f64 {
    found.after.as_ref().and_then(|r| r.outcome.metric(name)).expect("the result was analysed").value
}

#[test]
fn a_flat_force_over_two_thirds_of_the_travel() {
    let found = search(&[]);
    assert!(!found.before.outcome.requirements_met(), "straight beams break under the travel");
    assert!(found.after.as_ref().unwrap().outcome.requirements_met());
    let (flat, stress, allowed) = (reached(&found, "flat_ratio"), reached(&found, "stress_max"), 76e6 / 1.58);
    println!("flat_ratio {flat:.4}, stress {:.3} MPa", 1e-6 * stress);
    assert!(flat >= 0.685 && stress <= allowed && stress > 0.98 * allowed);
    // The search and the analysis speak of the same window.
    let best = found.best.as_ref().unwrap();
    assert!((flat + best.goal).abs() < 1e-3, "{flat} {}", best.goal);
    // What holds it back are the stress, the box and the end of the travel; the stress pays for flatness.
    let names: Vec<&str> = best.active.iter().map(|a| a.name.as_str()).collect();
    assert!(names.contains(&"stress") && names.contains(&"window_end"), "{names:?}");
}

/// What the search finds with a short beam that passes through a long one next to their joint is no design.
#[test]
fn straight_beams_alone_lead_to_a_design_that_meets_everything() {
    let found = search(&["optimise.starts=1"]);
    println!("flat_ratio {:.4}", reached(&found, "flat_ratio"));
    assert!(found.after.as_ref().unwrap().outcome.requirements_met() && reached(&found, "flat_ratio") >= 0.68);
}

#[test]
fn a_wider_band_lasts_longer() {
    let found = search(&["requirements.force.band=5 %"]);
    println!("flat_ratio {:.4}", reached(&found, "flat_ratio"));
    assert!(found.after.as_ref().unwrap().outcome.requirements_met() && reached(&found, "flat_ratio") >= 0.77);
}

#[test]
fn stretching_and_shear_cost_little() {
    let found = search(&["model.beam=reissner"]);
    println!("flat_ratio {:.4}", reached(&found, "flat_ratio"));
    assert!(found.after.as_ref().unwrap().outcome.requirements_met() && reached(&found, "flat_ratio") >= 0.675);
}

#[test]
fn the_search_is_the_same_every_time() {
    let (one, other) = (search(&[]), search(&[]));
    assert_eq!(one.text, other.text);
    assert_eq!(one.best.unwrap().x, other.best.unwrap().x);
}
