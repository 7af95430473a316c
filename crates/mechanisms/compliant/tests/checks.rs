//! Requirements: where they flip, what they say, and whether their advice helps.

mod common;
#[path = "common/drawing.rs"]
mod drawing;

use common::{NODES, check, close, near, outcome, solve, understand};
use drawing::{Drawing, guide};
use forcewright_compliant::METRICS;
use forcewright_model::{Check, CheckState, Outcome, Sense};

/// The SI unit in which a number is typed back.
fn si_unit(check: &Check) -> String {
    forcewright_base::units::Unit::si(check.dimension).symbol().to_owned()
}

/// Sets a limit just at, inside and outside a value, and asserts that the state flips there.
#[track_caller]
fn flips(path: &str, pick: &dyn Fn(&Outcome) -> Check, base: &[&str]) {
    let found = pick(&outcome(NODES, base));
    let unit = si_unit(&found);
    let with_limit = |limit: f64| {
        let setting = format!("{path}={limit:e} {unit}");
        pick(&outcome(NODES, &[base, &[setting.trim_end()]].concat()))
    };
    let value = found.value.unwrap_or_else(|| panic!("{path}: {found:?}"));
    let inward = if found.sense == Sense::AtMost { -1.0 } else { 1.0 };
    for (offset, state) in [(0.0, CheckState::Met), (-1e-9, CheckState::Met), (1e-9, CheckState::Missed)] {
        let limit = value + offset * inward * value.abs();
        let check = with_limit(limit);
        assert_eq!(check.limit.map(f64::to_bits), Some(limit.to_bits()), "{path}");
        assert_eq!(check.value.map(f64::to_bits), Some(value.to_bits()), "{path}: the limit must not change the value");
        assert_eq!(check.state, state, "{path} at {offset:e}: {check:?}");
        close(check.margin.expect("assessed"), -offset, 1e-12, path);
        assert_eq!(check.advice.is_some(), state != CheckState::Met, "{path}");
    }
}

#[test]
fn states_flip_where_the_value_crosses_the_limit() {
    let by = |code: &'static str| move |o: &Outcome| check(o, code).clone();
    flips("requirements.force.band", &by("COMP001"), &["requirements.travel=6 mm"]);
    flips("requirements.travel", &by("COMP003"), &[]);
    flips("requirements.stiffness.min", &by("COMP004"), &[]);
    flips("requirements.stiffness.max", &by("COMP005"), &["requirements.stiffness.max=1 N/mm"]);
    let text = NODES.replace("stress = { safety_factor = 1.5 }", "stress = { max = \"50 MPa\" }");
    assert!(text != NODES);
    let stress = |set: &[&str]| check(&outcome(&text, set), "COMP002").clone();
    let value = stress(&[]).value.unwrap();
    assert_eq!(stress(&[&format!("requirements.stress.max={value:e} Pa")]).state, CheckState::Met);
    assert_eq!(stress(&[&format!("requirements.stress.max={:e} Pa", value * (1.0 - 1e-9))]).state, CheckState::Missed);
    // With a safety factor the limit is the yield stress over it.
    let factor = solve(NODES, &[]).get("safety_factor");
    let with = |factor: f64| check(&outcome(NODES, &[&format!("requirements.stress.safety_factor={factor:e}")]), "COMP002").clone();
    assert_eq!((with(factor * (1.0 - 1e-9)).state, with(factor * (1.0 + 1e-9)).state), (CheckState::Met, CheckState::Missed));
    near(with(2.0).limit.unwrap(), 38e6, 1e-15, "limit");
}

#[test]
fn every_metric_can_be_limited_from_both_sides() {
    // Longer, so that the local minimum is inside and the allowed stress is reached.
    let base = ["load.travel=16 mm"];
    let solved = solve(NODES, &base);
    for info in METRICS {
        let path = format!("requirements.limits.{}", info.name);
        let unit = forcewright_base::units::Unit::si(info.dimension).symbol().to_owned();
        let (name, min, max) = (info.name, format!("{path}.min=0 {unit}"), format!("{path}.max=0 {unit}"));
        let Some(value) = solved.measured.get(name) else {
            let found = outcome(NODES, &[&base[..], &[min.trim_end()]].concat());
            let check = found.checks.iter().find(|c| c.name == name).unwrap();
            assert_eq!((check.state, check.code), (CheckState::NotAssessed, "COMP006"), "{name}");
            let section = match name {
                "envelope_margin" => "`requirements.envelope`",
                _ if ["lateral_", "axial_", "tip_"].iter().any(|start| name.starts_with(start)) => "`[scenario.lateral]`",
                _ => "`[scenario.surface]`",
            };
            assert!(check.advice.as_deref().is_some_and(|a| a.contains(section)), "{name}: {:?}", check.advice);
            continue;
        };
        for (setting, sense) in [(min, Sense::AtLeast), (max, Sense::AtMost)] {
            let pick = |o: &Outcome| o.checks.iter().find(|c| c.name == name && c.sense == sense).unwrap().clone();
            let bound = setting.split('=').next().unwrap().to_owned();
            flips(&bound, &pick, &[&base[..], &[setting.trim_end()]].concat());
        }
        assert!(value.is_finite());
    }
}

#[test]
fn a_limit_of_zero_has_a_margin() {
    let set = ["requirements.stiffness.min=0 N/m"];
    let result = outcome(NODES, &set);
    let check = check(&result, "COMP004");
    let initial = solve(NODES, &set).get("stiffness_initial");
    assert_eq!(check.state, CheckState::Missed);
    close(check.margin.unwrap(), check.value.unwrap() / initial, 1e-15, "margin relative to the initial stiffness");
}

/// The number after a phrase.
fn number_after(text: &str, phrase: &str) -> f64 {
    let rest = text.split_once(phrase).unwrap_or_else(|| panic!("no `{phrase}` in: {text}")).1.trim_start();
    let end = rest.find(|c: char| !(c.is_ascii_digit() || "+-.e".contains(c))).unwrap_or(rest.len());
    rest[..end].trim_end_matches('.').parse().unwrap_or_else(|_| panic!("no number after `{phrase}` in: {text}"))
}

fn advice(result: &Outcome, code: &str) -> String {
    let check = check(result, code);
    assert_eq!(check.state, CheckState::Missed, "{check:?}");
    check.advice.clone().expect("a miss has advice")
}

#[test]
fn depth_mends_a_level() {
    for nominal in ["5 N", "8.9 N", "10.2 N", "15 N", "40 N"] {
        for model in ["reissner", "inextensible"] {
            let (nominal, model) = (format!("requirements.force.nominal={nominal}"), format!("model.beam={model}"));
            let set = ["requirements.force.band=3 %", nominal.as_str(), model.as_str()];
            let missed = advice(&outcome(NODES, &set), "COMP001");
            let factor = number_after(&missed, "multiply it by");
            let depth = format!("design.depth={} mm", 10.0 * factor);
            let mended = outcome(NODES, &[&set[..], &[depth.as_str()]].concat());
            let check = check(&mended, "COMP001");
            assert_eq!(check.state, CheckState::Met, "{nominal} {model}: {missed}; then {check:?}");
            // The level of the flattest stroke is then the nominal one, and the deviation what was announced.
            near(100.0 * check.value.unwrap(), number_after(&missed, " with ±"), 6e-3, "announced deviation");
            assert_eq!(common::check(&mended, "COMP003").state, CheckState::Met);
        }
    }
}

#[test]
fn depth_alone_is_not_promised_to_mend_a_steep_curve() {
    let result = outcome(NODES, &["requirements.travel=10 mm", "requirements.force.nominal=5 N"]);
    assert!(advice(&result, "COMP001").contains("not enough"));
    // With a free level depth cannot help at all.
    let free = NODES.replace("nominal = \"9.7 N\", ", "");
    let result = outcome(&free, &["requirements.travel=10 mm"]);
    assert!(!advice(&result, "COMP001").contains("depth"));
    assert!(number_after(&advice(&result, "COMP003"), "the band holds over") < 10.0);
}

#[test]
fn thinner_and_deeper_beams_mend_the_stress() {
    for (set, factor) in [
        (&["load.travel=13.6 mm"][..], "2.1"),
        (&["load.travel=17 mm"], "1.7"),
        (&["load.travel=16 mm", "model.beam=inextensible"], "3"),
        (&["design.thickness=2 mm"], "1.2"),
        (&["design.thickness=1.7 mm", "load.travel=10 mm"], "2.4"),
    ] {
        let factor = format!("requirements.stress.safety_factor={factor}");
        // A short stroke, so that less travel is a way out too.
        let set = [set, &[factor.as_str(), "requirements.travel=1 mm"]].concat();
        let before = outcome(NODES, &set);
        let missed = advice(&before, "COMP002");
        let (thinner, deeper) = (number_after(&missed, "follows the thickness (×"), number_after(&missed, "`design.depth` ×"));
        close(thinner * thinner * thinner * deeper, 1.0, 1e-3, "the bending stiffness stays");
        let design = common::design(NODES, &set);
        let thickness = format!("design.thickness={:e} m", thinner * design.network.beams[0].section.thickness_m);
        let depth = format!("design.depth={} mm", 10.0 * deeper);
        let after = outcome(NODES, &[&set[..], &[&thickness, &depth]].concat());
        assert_eq!(check(&after, "COMP002").state, CheckState::Met, "{set:?}: {missed}: {:?}", check(&after, "COMP002"));
        let force = |o: &Outcome| o.metric("force_at_end").unwrap().value;
        near(force(&after), force(&before), 0.02, "force");
        // The other way out: less travel, as typed in the advice.
        let travel = format!("load.travel={} mm", number_after(&missed, "keep `load.travel` at or below"));
        let shorter = outcome(NODES, &[&set[..], &[travel.as_str()]].concat());
        assert_eq!(check(&shorter, "COMP002").state, CheckState::Met, "{travel}");
        assert!(check(&shorter, "COMP002").margin.unwrap() < 1e-3, "the travel is not cut more than needed");
    }
}

#[test]
fn a_missed_stiffness_tells_the_jump() {
    let result = outcome(NODES, &["requirements.stiffness.min=0 N/m", "load.travel=16 mm"]);
    let missed = advice(&result, "COMP004");
    let (from, to) = (number_after(&missed, "jumps from Δ ="), number_after(&missed, " mm to"));
    let curve = solve(NODES, &["load.travel=16 mm"]);
    near(curve.force(to * 1e-3), curve.force(from * 1e-3), 1e-5, "same force");
    assert!(
        result.warnings.iter().any(|w| w.code == "W0503" && w.message.contains(&format!("{from}")) && w.message.contains(&format!("{to}")))
    );
}

#[test]
fn what_cannot_be_assessed_says_why() {
    let reason = |result: &Outcome, code: &str| {
        let check = check(result, code);
        assert_eq!(check.state, CheckState::NotAssessed, "{check:?}");
        assert!(check.value.is_none() || check.limit.is_none());
        assert!(!result.requirements_met());
        check.advice.clone().unwrap()
    };
    let lines = |without: &str| NODES.lines().filter(|l| !l.starts_with(without)).collect::<Vec<_>>().join("\n");
    let no_yield = lines("use = ").replace("yield_stress = \"76 MPa\"", "poisson_ratio = 0.35");
    assert!(reason(&outcome(&no_yield, &[]), "COMP002").contains("material.yield_stress"));
    let by_stress = no_yield.replace("safety_factor = 1.5", "max = \"60 MPa\"");
    assert_eq!(check(&outcome(&by_stress, &[]), "COMP002").state, CheckState::Met);
    // A stroke without a band could never be assessed: that is an error of the file.
    let (design, diagnostics) = understand(&lines("force = "), &[]);
    let error = diagnostics.in_file_order()[0];
    assert!(design.is_none() && error.code == "E0302" && error.message.contains("band"), "{error:?}");
    // So are a stroke beyond the travel, and a band without a stroke.
    let codes = |text: &str, set: &[&str]| understand(text, set).1.in_file_order().iter().map(|d| d.code).collect::<Vec<_>>();
    assert_eq!(codes(NODES, &["requirements.travel=14 mm"]), ["E0204"]);
    assert_eq!(codes(&lines("travel = \"6 mm\""), &[]), ["E0302"]);
    // Nothing asked, nothing checked.
    let start = NODES.find("[requirements]").unwrap();
    let end = NODES.find("[material]").unwrap();
    let nothing = outcome(&format!("{}{}", &NODES[..start], &NODES[end..]), &[]);
    assert!(nothing.checks.is_empty() && nothing.requirements_met());
}

#[test]
fn a_part_that_yields_is_missed_without_being_asked() {
    let text = NODES.lines().filter(|l| !l.starts_with("stress = ")).collect::<Vec<_>>().join("\n");
    let fine = outcome(&text, &[]);
    let yielding = outcome(&text, &["material.yield_stress=40 MPa"]);
    assert_eq!((check(&fine, "COMP002").state, check(&fine, "COMP002").limit), (CheckState::Met, Some(76e6)));
    assert_eq!(check(&yielding, "COMP002").state, CheckState::Missed);
    assert!(!yielding.requirements_met() && yielding.warnings.iter().any(|w| w.code == "W0504"));
}

#[test]
fn a_miss_on_the_computed_part_is_a_miss_of_the_whole() {
    // The budget of the engine ends this path early; what it has passed before is enough to miss both limits.
    let early = outcome(NODES, &["load.travel=9 m", "requirements.stress.safety_factor=3"]);
    assert_ne!(early.status.kind, forcewright_model::StatusKind::Complete);
    assert_eq!(check(&early, "COMP002").state, CheckState::Missed);
    assert_eq!(check(&early, "COMP001").state, CheckState::NotAssessed);
    assert!(check(&early, "COMP002").title.contains("on the computed part"));
}

#[test]
fn a_limit_that_nothing_meets_is_refused() {
    let errors = |set: &[&str]| {
        understand(NODES, set).1.in_file_order().iter().map(|d| (d.code, d.help.clone().unwrap_or_default())).collect::<Vec<_>>()
    };
    for set in [
        &["requirements.limits.mass.min=2 g", "requirements.limits.mass.max=1 g"][..],
        &["requirements.stiffness.min=1 N/mm", "requirements.stiffness.max=0.5 N/mm"],
    ] {
        let found = errors(set);
        assert!(matches!(&found[..], [("E0204", help)] if help.contains("exchange")), "{found:?}");
    }
    // The least value is 0 unless it is given.
    let without = NODES.replace("stiffness = { min = \"-0.05 N/mm\" }", "stiffness = { max = \"-0.01 N/mm\" }");
    assert!(without != NODES);
    let found = understand(&without, &[]).1;
    let all: Vec<_> = found.in_file_order().iter().map(|d| (d.code, d.help.clone().unwrap_or_default())).collect();
    assert!(matches!(&all[..], [("E0204", help)] if help.contains("`stiffness.min`")), "{all:?}");
    assert!(errors(&["requirements.limits.mass.min=1 g", "requirements.limits.mass.max=1 g"]).is_empty());
}

/// Two leaning columns whose joined heads are pushed down: guided they stand, free they sway.
#[test]
fn a_limit_on_sideways_stiffness_agrees_with_the_warning() {
    let half = |foot: [f64; 2], head: [f64; 2], travel: &str| Drawing {
        nodes: vec![("n1", foot, "support = \"clamped\"".to_owned()), ("n2", head, guide([0.0, 1.0]))],
        beams: vec![("b1", ["n1", "n2"], if head[0] > 0.0 { Vec::new() } else { vec![0.5, -0.2] })],
        load_node: "n2",
        load_direction: [0.0, -1.0],
        travel: travel.to_owned(),
        mirror: Some("x = 0".to_owned()),
        model: "reissner",
    };
    let columns = |travel: &str| half([12.0, 0.0], [0.0, 60.0], travel);
    // A snapping beam to each side of a wide block: one may snap back while the other goes on, and the block turns over.
    let snapping = half([100.0, 0.0], [50.0, 3.0], "4 mm");
    let asked = |drawing: &Drawing, limit: &str| {
        let limits = format!("[requirements.limits]\nlateral_stiffness_min = {{ {limit} }}\n[requirements.stress]");
        let result = outcome(&drawing.text().replace("[requirements.stress]", &limits), &[]);
        (result.warnings.iter().any(|w| w.code == "W0510"), check(&result, "COMP006").clone())
    };
    let (sways, found) = asked(&columns("0.1 mm"), "min = \"0 N/mm\"");
    assert!(!sways && found.state == CheckState::Met && found.value.is_some(), "{found:?}");
    let mut without_value = 0;
    for drawing in [columns("6 mm"), columns("15 mm"), snapping] {
        let travel = &drawing.travel;
        let (sways, found) = asked(&drawing, "min = \"0 N/mm\"");
        assert!(sways && found.state == CheckState::Missed, "{travel}: {found:?}");
        assert!(found.advice.as_ref().is_some_and(|a| a.contains("W0510")) && found.value.is_none_or(|k| k < 0.0), "{found:?}");
        // Where it turns over there is no least stiffness: however low the limit, it is missed.
        let (_, lower) = asked(&drawing, "min = \"-1e6 N/mm\"");
        assert_eq!(lower.state == CheckState::Missed, found.value.is_none(), "{travel}: {lower:?}");
        without_value += usize::from(found.value.is_none());
    }
    assert!(without_value > 0);
}

/// Where a beam is pulled straight the force soars; a curve through stations overshoots there, and no device jumps.
#[test]
fn a_force_that_soars_is_no_jump() {
    let mut overshot = 0;
    for bend in [0.8, 1.2, 1.57, 2.0, 2.4] {
        let drawing = Drawing {
            nodes: vec![("n1", [0.0, 0.0], "support = \"clamped\"".to_owned()), ("n2", [40.0, 0.0], guide([1.0, 0.0]))],
            beams: vec![("b1", ["n1", "n2"], vec![bend])],
            load_node: "n2",
            load_direction: [1.0, 0.0],
            travel: "20 mm".to_owned(),
            mirror: None,
            model: "inextensible",
        };
        let solved = solve(&drawing.text(), &[]);
        let points = &solved.behaviour.path.points;
        assert!(points.windows(2).all(|p| p[0].force < p[1].force && p[1].stiffness > 0.0), "the force grows throughout");
        overshot += usize::from(!solved.behaviour.curve.as_ref().unwrap().turns().is_empty());
        assert!(solved.behaviour.extrema().max.is_none() && solved.behaviour.jump().is_none());
        let result = outcome(&drawing.text(), &[]);
        assert!(result.status.message.contains("pulled straight"), "{:?}", result.status);
        assert!(!result.warnings.iter().any(|w| w.code == "W0503"), "{:?}", result.warnings);
    }
    assert!(overshot > 0, "the curve itself never overshoots");
}
