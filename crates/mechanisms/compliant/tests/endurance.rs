//! Fatigue and creep as checks: closed forms for what a fibre goes through, catalogue data by hand, and what is not assessed.

mod common;

use common::{check, near, outcome, solve};
use forcewright_base::maths;
use forcewright_model::{Check, CheckState};

const STRIP: &str = r#"
schema = 1
mechanism = "compliant"
[requirements]
fatigue = { cycles = 1e6, safety_factor = 1.3 }
hold = { time = "1000 h", force_left = "40 %" }
[material]
use = "POM-H"
[design]
thickness = "1 mm"
depth = "10 mm"
[design.nodes]
clamp = { at = ["0 mm", "0 mm"], support = "clamped" }
tip = { at = ["60 mm", "0 mm"] }
[[design.beams]]
name = "strip"
between = ["clamp", "tip"]
straight = true
[load]
node = "tip"
direction = [0, -1]
travel = "5 mm"
"#;

fn of(code: &str, text: &str, set: &[&str]) -> Check {
    check(&outcome(text, set), code).clone()
}

#[test]
fn a_strip_bent_one_way_pulsates() {
    // Root of a cantilever: 0 to σ = 3·E·w·δ/(2·L²) on one face, 0 to −σ on the other, which has no mean that counts.
    let found = of("COMP009", STRIP, &[]);
    let bent = 1.5 * 3.1e9 * 1e-3 * 5e-3 / (60e-3 * 60e-3);
    let safety = |stress: f64| 1.0 / (0.5 * stress / 31e6 + 0.5 * stress / 70e6);
    near(found.value.unwrap(), safety(bent), 0.01, "small deflections");
    near(found.value.unwrap(), safety(solve(STRIP, &[]).get("stress_max")), 1e-6, "at the largest stress");
    assert_eq!(found.state, CheckState::Met);
    assert!(
        found.title.contains("beam strip, u = 0, left face") && found.basis.contains("31 MPa at 1e6 cycles"),
        "{} {}",
        found.title,
        found.basis
    );
    // The limit decides, on either side of the value.
    for (factor, state) in [(0.999, CheckState::Met), (1.001, CheckState::Missed)] {
        let limit = format!("requirements.fatigue.safety_factor={}", factor * found.value.unwrap());
        assert_eq!(of("COMP009", STRIP, &[&limit]).state, state);
    }
}

/// A stiff bar on hinges, guided at its end.
fn bar() -> String {
    STRIP
        .replace("\"1 mm\"", "\"5 mm\"")
        .replace("\"POM-H\"", "\"7075\"")
        .replace("tip = { at = [\"60 mm\", \"0 mm\"] }", "tip = { at = [\"60 mm\", \"4 mm\"], support = \"slider\", direction = [0, 1] }")
        .replace("straight = true", "straight = true\nhinged = [\"clamp\", \"tip\"]")
}

/// A bar on hinges that snaps through: the stress is −σ in the middle of the way and beyond it a tension, both from the length of
/// the bar. What counts is the range between the two, not the stress at the end.
#[test]
fn a_fibre_is_judged_by_its_extremes_on_the_way() {
    let text = bar();
    let found = of("COMP009", &text, &["load.travel=9 mm"]);
    let stress = |y: f64| 71e9 * (maths::hypot(60e-3, y) / maths::hypot(60e-3, 4e-3) - 1.0);
    let (low, high) = (stress(0.0), stress(-5e-3));
    assert!(low < -1e8 && high > 5e7);
    let mean = 0.5 * (low + high);
    assert!(mean < 0.0, "in compression: it does not count");
    near(found.value.unwrap(), 2.0 * 159e6 / (high - low), 1e-4, "range over the amplitude endured");
    // Further out the mean is a tension.
    let far = of("COMP009", &text, &["load.travel=12 mm"]);
    let high = stress(-8e-3);
    near(far.value.unwrap(), 1.0 / (0.5 * (high - low) / 159e6 + 0.5 * (high + low) / 572e6), 1e-4, "with the mean");
}

#[test]
fn fatigue_is_not_assessed_without_data() {
    let own = "material.fatigue={ amplitude = \"20 MPa\", cycles = 1e7 }";
    let strength = "material.tensile_strength=60 MPa";
    for (set, word) in [
        (&["material.use=POM-C"][..], "no stress is known that it endures"),
        (&["requirements.fatigue.cycles=1.1e6"], "1.1e6 cycles are asked for"),
        (&["material.use=POM-C", own], "tensile strength"),
        (&["material.fatigue={ amplitude = \"40 MPa\", cycles = 1e7, ratio = 0.5 }"], "stress ratio"),
    ] {
        let found = of("COMP009", STRIP, set);
        assert_eq!((found.state, found.value), (CheckState::NotAssessed, None), "{set:?}");
        assert!(found.advice.as_ref().unwrap().contains(word), "{set:?}: {:?}", found.advice);
    }
    let found = of("COMP009", STRIP, &["material.use=POM-C", own, strength, "requirements.fatigue.cycles=1e7"]);
    let stress = solve(STRIP, &["material.use=POM-C"]).get("stress_max");
    near(found.value.unwrap(), 1.0 / (0.5 * stress / 20e6 + 0.5 * stress / 60e6), 1e-6, "own data");
    // Up to the limit load it holds, but the rest of the way is not known.
    let early = of("COMP009", &bar().replace("travel = \"5 mm\"", "force = \"1 kN\""), &[]);
    assert_eq!((early.state, early.value), (CheckState::NotAssessed, None));
    assert!(early.advice.as_ref().unwrap().contains("the path ends"), "{:?}", early.advice);
    // A miss is a miss although another beam is not known.
    let two = STRIP
        .replace("[design]\n", "[material.soft]\nuse = \"PP\"\n[design]\n")
        .replace("[load]", "[[design.beams]]\nname = \"end\"\nbetween = [\"tip\", \"far\"]\nstraight = true\nmaterial = \"soft\"\n[load]")
        .replace("tip = {", "far = { at = [\"70 mm\", \"0 mm\"] }\ntip = {");
    assert_eq!(of("COMP009", &two, &["load.travel=30 mm"]).state, CheckState::Missed);
    assert_eq!(of("COMP009", &two, &["load.travel=2 mm"]).state, CheckState::NotAssessed);
}

#[test]
fn what_is_left_of_a_force_is_that_of_the_creep_modulus() {
    let pom = |set: &[&str]| of("COMP010", STRIP, &[&["material.use=POM-C"], set].concat());
    // The data sheet: E 2.85 GPa, 2.5 GPa after 1 h, 1.3 GPa after 1000 h.
    for (time, left) in [("1 h", 2.5 / 2.85), ("60 min", 2.5 / 2.85), ("1000 h", 1.3 / 2.85), ("1.3176156917368247 d", 1.9 / 2.85)] {
        let found = pom(&[&format!("requirements.hold.time={time}")]);
        near(found.value.unwrap(), left, 1e-12, time);
        assert_eq!(found.state, CheckState::Met);
    }
    assert_eq!(pom(&["requirements.hold.force_left=50 %"]).state, CheckState::Missed);
    let found = of("COMP010", STRIP, &["material.use=C75S", "requirements.hold={ time = \"3650 d\", force_left = 1 }"]);
    assert_eq!((found.state, found.value), (CheckState::Met, Some(1.0)));
    assert!(found.basis.contains("steel does not creep"), "{}", found.basis);
}

#[test]
fn creep_is_not_assessed_without_data() {
    let bare = STRIP.replace("use = \"POM-H\"", "young_modulus = \"2 GPa\"\npoisson_ratio = 0.35");
    for (text, set, word) in [
        (STRIP, &[][..], "no creep modulus of POM-H"),
        (STRIP, &["material.use=POM-C", "requirements.hold.time=42 d"], "42 d lies outside"),
        (&bare, &[], "not of the catalogue"),
        (&STRIP.replace("travel = \"5 mm\"", "force = \"1 N\""), &["material.use=POM-C"], "no displacement is held"),
    ] {
        let found = of("COMP010", text, set);
        assert_eq!((found.state, found.value), (CheckState::NotAssessed, None), "{set:?}");
        assert!(found.advice.as_ref().unwrap().contains(word), "{set:?}: {:?}", found.advice);
    }
}
