//! A material for each beam: stress against its own limit, mass by its own density, sources of all.

mod common;

use common::{check, close, design, near, outcome, solve, understand};
use forcewright_model::CheckState;

/// Two cantilevers between clamps and one moved node: `soft` of the common material, `hard` of the named one.
const TWO: &str = r#"schema = 1
mechanism = "compliant"
[requirements]
stress = { safety_factor = 1.5 }
[material]
young_modulus = "2 GPa"
poisson_ratio = 0.35
yield_stress = "76 MPa"
density = "1400 kg/m^3"
[material.steel]
young_modulus = "206 GPa"
poisson_ratio = 0.3
yield_stress = "1000 MPa"
density = "7850 kg/m^3"
[design]
depth = "10 mm"
[design.nodes]
left = { at = ["-60 mm", "0 mm"], support = "clamped" }
right = { at = ["40 mm", "0 mm"], support = "clamped" }
middle = { at = ["0 mm", "0 mm"] }
[[design.beams]]
name = "hard"
between = ["right", "middle"]
straight = true
thickness = "0.2 mm"
material = "steel"
[[design.beams]]
name = "soft"
between = ["left", "middle"]
straight = true
thickness = "1 mm"
hinged = ["middle"]
[load]
node = "middle"
direction = [0, -1]
travel = "0.1 mm"
"#;

#[test]
fn small_deflections_in_closed_form() {
    let solved = solve(TWO, &["load.travel=1 um"]);
    // Cantilevers with a hinged tip side by side, k = 3EI/L³ each; the tip of `hard` is free to turn, since nothing else turns with it.
    let stiffness = |e: f64, w: f64, l: f64| 3.0 * e * w * w * w * 10e-3 / 12.0 / (l * l * l);
    let wanted = stiffness(206e9, 0.2e-3, 40e-3) + stiffness(2e9, 1e-3, 60e-3);
    near(solved.get("stiffness_initial"), wanted, 1e-3, "stiffness");
    // σ = 3 E w δ/(2 L²) at the clamp.
    let stress = |e: f64, w: f64, l: f64| 1.5 * e * w * 1e-6 / (l * l);
    let (hard, soft) = (stress(206e9, 0.2e-3, 40e-3), stress(2e9, 1e-3, 60e-3));
    near(solved.get("stress_max"), hard, 1e-3, "largest stress, in the steel");
    assert!(hard / 1000e6 > soft / 76e6);
    near(solved.get("safety_factor"), 1000e6 / hard, 1e-3, "safety factor");
    near(solved.get("mass"), 7850.0 * 0.2e-3 * 10e-3 * 40e-3 + 1400.0 * 1e-3 * 10e-3 * 60e-3, 1e-12, "mass");
}

#[test]
fn each_beam_is_held_against_its_own_limit() {
    // Steel that yields late: the polymer is nearest to its limit although it carries less stress.
    let strong = ["material.steel.yield_stress=20 GPa", "load.travel=10 mm"];
    let solved = solve(TWO, &strong);
    let result = outcome(TWO, &strong);
    let stress = check(&result, "COMP002");
    let soft = solved.design.beam_names.iter().position(|n| n == "soft").unwrap();
    let loaded = solved.measured.loaded.unwrap();
    assert_eq!(loaded.beam, soft);
    assert!(stress.title.contains("beam soft") && stress.basis.contains("`material`"), "{stress:?}");
    assert!(loaded.peak.stress_pa < solved.get("stress_max"));
    near(stress.limit.unwrap(), 76e6 / 1.5, 1e-15, "limit");
    near(stress.value.unwrap(), loaded.peak.stress_pa, 1e-15, "value");
    near(solved.get("safety_factor"), 76e6 / loaded.peak.stress_pa, 1e-15, "safety factor");
    // With the common yield stress the steel is first.
    let weak = outcome(TWO, &["load.travel=10 mm"]);
    let other = check(&weak, "COMP002");
    assert!(other.title.contains("beam hard") && other.basis.contains("`material.steel`"), "{other:?}");
    near(other.limit.unwrap(), 1000e6 / 1.5, 1e-15, "limit of the steel");
    // One stress for all is compared with the largest of all.
    let text = TWO.replace("safety_factor = 1.5", "max = \"10 MPa\"");
    let common = outcome(&text, &strong);
    assert!(check(&common, "COMP002").title.contains("beam hard"));
}

#[test]
fn the_first_beam_at_its_limit_ends_the_travel() {
    let long = "load.travel=12 mm";
    let at = |set: &[&str]| solve(TWO, &[&[long], set].concat()).get("travel_at_allowable_stress");
    let both = at(&["material.steel.yield_stress=400 MPa", "material.yield_stress=5 MPa"]);
    let steel = at(&["material.steel.yield_stress=400 MPa", "material.yield_stress=500 MPa"]);
    let soft = at(&["material.steel.yield_stress=90 GPa", "material.yield_stress=5 MPa"]);
    close(both, steel.min(soft), 1e-12, "the first of both");
    assert!((steel - soft).abs() > 1e-4, "{steel} {soft}: a test that cannot tell");
    let solved = solve(TWO, &[long, "material.steel.yield_stress=400 MPa", "material.yield_stress=5 MPa"]);
    let state = solved.behaviour.path.at(both).unwrap();
    let ratio = |beam: usize| state.beams[beam].peak_stress().stress_pa / solved.design.allowable_pa(beam).unwrap();
    close(ratio(0).max(ratio(1)), 1.0, 1e-9, "there one beam carries what it may");
}

#[test]
fn an_unknown_yield_stress_leaves_the_check_open() {
    let unknown = TWO.replace("yield_stress = \"1000 MPa\"\n", "");
    let result = outcome(&unknown, &[]);
    let stress = check(&result, "COMP002");
    assert_eq!(stress.state, CheckState::NotAssessed);
    assert!(stress.advice.as_ref().unwrap().contains("`material.steel.yield_stress`"), "{stress:?}");
    assert!(!result.metrics.iter().any(|m| m.name == "safety_factor" || m.name == "travel_at_allowable_stress"));
    // But a known one that is exceeded is a miss.
    let missed = outcome(&unknown, &["material.yield_stress=0.01 MPa"]);
    assert_eq!(check(&missed, "COMP002").state, CheckState::Missed);
    let unknown = unknown.replace("density = \"7850 kg/m^3\"\n", "");
    assert!(!outcome(&unknown, &[]).metrics.iter().any(|m| m.name == "mass"));
}

#[test]
fn the_catalogue_serves_every_material() {
    let text = TWO.replace(
        "young_modulus = \"206 GPa\"\npoisson_ratio = 0.3\nyield_stress = \"1000 MPa\"\ndensity = \"7850 kg/m^3\"\n",
        "use = \"C75S\"\n",
    );
    let (design, result) = (design(&text, &[]), outcome(&text, &[]));
    assert!(design.materials[0].name.is_none() && design.materials[1].name.as_deref() == Some("steel"));
    assert!(design.materials[1].yield_pa.is_some() && !design.materials[1].sources.is_empty());
    assert!(design.materials[1].sources.iter().all(|s| result.sources.iter().any(|r| r.key == *s)));
    // All beams of named materials: the common one may be empty.
    let all = TWO.replace("hinged = [\"middle\"]", "hinged = [\"middle\"]\nmaterial = \"steel\"");
    let start = all.find("young_modulus").unwrap();
    let all = format!("{}{}", &all[..start], &all[all.find("[material.steel]").unwrap()..]);
    assert_eq!(common::design(&all, &[]).materials.len(), 1);
    let same = solve(&all, &["material.steel.young_modulus=103 GPa"]);
    near(same.get("force_at_end") / solve(&all, &[]).get("force_at_end"), 0.5, 1e-6, "half the modulus, half the force");
}

#[track_caller]
fn found(text: &str, code: &str, words: &str) {
    let (_, diagnostics) = understand(text, &[]);
    let all = diagnostics.in_file_order();
    let one = all.iter().find(|d| d.code == code).unwrap_or_else(|| panic!("no {code}: {all:?}"));
    assert!(one.message.contains(words) || one.help.as_ref().is_some_and(|h| h.contains(words)), "{one:?}");
}

#[test]
fn names_and_keys_are_checked() {
    found(&TWO.replace("material = \"steel\"", "material = \"steal\""), "E0304", "did you mean \"steel\"?");
    found(&TWO.replace("[material.steel]", "[material.steal]"), "E0304", "did you mean \"steal\"?");
    found(&TWO.replace("material = \"steel\"\n", ""), "W0509", "no beam is of the material `steel`");
    found(&TWO.replace("young_modulus = \"206 GPa\"", "young_modulu = \"206 GPa\""), "E0301", "did you mean `young_modulus`?");
    found(&TWO.replace("young_modulus = \"2 GPa\"\n", ""), "E0302", "`young_modulus` is missing");
    found(&TWO.replace("poisson_ratio = 0.3\n", ""), "E0302", "`poisson_ratio` is missing");
    found(&TWO.replace("[material]\n", "[material]\nsteal = 3\n"), "E0301", "unknown key `steal`");
    assert!(understand(TWO, &[]).1.in_file_order().is_empty());
}
