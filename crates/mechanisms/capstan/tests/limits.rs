//! What limits a drive, and whether the advice of its checks holds once it is followed.

use forcewright_base::diagnostics::Diagnostics;
use forcewright_base::maths;
use forcewright_capstan::{Behaviour, Capstan, Design, Measured, Spec, measure};
use forcewright_contract::family::Mechanism as _;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;
use forcewright_elements::wrap::{Drive, DriveSpec, Drum, Hold};
use forcewright_model::{Check, Outcome};

const LONGVAL: &str = include_str!("../../../../examples/capstan/longval.toml");

fn understood(text: &str, set: &[&str]) -> Result<Design, Vec<(&'static str, String)>> {
    let choices = Choices { variant: None, set: set.iter().map(|s| (*s).to_owned()).collect() };
    let project = Project::from_text("test.toml", text, &choices);
    let mut diagnostics: Diagnostics = project.diagnostics;
    let mut spec: Spec = read::read(&project.tree, project.root, &mut diagnostics);
    let design = Capstan::resolve(&mut spec, &mut diagnostics);
    let codes = || diagnostics.in_file_order().iter().map(|d| (d.code, d.help.clone().unwrap_or_default())).collect();
    design.filter(|_| !diagnostics.has_errors()).ok_or_else(codes)
}

fn design(set: &[&str]) -> Design {
    understood(LONGVAL, set).expect("a drive")
}

fn refused(text: &str, set: &[&str]) -> Vec<&'static str> {
    understood(text, set).expect_err("refused").into_iter().map(|(code, _)| code).collect()
}

fn solved(design: &Design) -> (Behaviour, Measured) {
    let behaviour = Behaviour::of(design).expect("a drive");
    let measured = measure(design, &behaviour);
    (behaviour, measured)
}

fn outcome(set: &[&str]) -> Outcome {
    Capstan::analyse(&design(set), &mut |_| true).outcome
}

fn check<'a>(outcome: &'a Outcome, name: &str) -> &'a Check {
    outcome.check(name).unwrap_or_else(|| panic!("no {name}"))
}

fn word(outcome: &Outcome, name: &str) -> &'static str {
    check(outcome, name).state.word()
}

fn advice(outcome: &Outcome, name: &str) -> String {
    check(outcome, name).advice.clone().unwrap_or_else(|| panic!("{name} is met"))
}

/// The number that follows some words.
fn after(text: &str, words: &str) -> f64 {
    let rest = text.split(words).nth(1).unwrap_or_else(|| panic!("no \"{words}\" in \"{text}\""));
    rest.split_whitespace().next().and_then(|w| w.trim_end_matches([',', ';', '.']).parse().ok()).unwrap_or_else(|| panic!("{text}"))
}

fn near(ours: f64, exact: f64, relative: f64) {
    assert!((ours - exact).abs() <= relative * exact.abs(), "{ours} instead of {exact}");
}

const FASTENED: &str = "design.input_hold=fastened";

/// At an end of the travel the pin has moved by Rτ/2 towards one span: the engine's drive with these wraps, made by hand.
#[test]
fn a_pin_moves_with_the_input() {
    let design = design(&[FASTENED]);
    let (behaviour, measured) = solved(&design);
    let (built, geometry) = (&design.built, &behaviour.geometry);
    let (wrap, turned) = (geometry.input_wrap_rad(), built.ratio() * built.travel_rad);
    let cos = maths::cos(geometry.helix_angle_rad());
    let drum = |radius_m: f64| Drum { radius_m: radius_m / cos, friction: built.friction * built.groove_factor * cos };
    let spec = |wraps_rad: [f64; 2], output_wraps_rad: [f64; 2]| DriveSpec {
        input: drum(built.radii_m[0]),
        output: drum(built.radii_m[1]),
        hold: Hold::Fixed { wraps_rad },
        output_wraps_rad,
        spans_m: [geometry.free_span_m() / cos; 2],
        axial_stiffness_n: built.cables[0].axial_stiffness_n,
        preload_n: 200.0,
    };
    // Where end 0 has but its guard on the output it has most on the input: what leaves one drum winds up on the other, radius by radius.
    let at_start = spec([0.5 * (wrap + turned), 0.5 * (wrap - turned)], [built.guard_rad, built.guard_rad + built.travel_rad]);
    let cable_m = |s: &DriveSpec| {
        let Hold::Fixed { wraps_rad } = s.hold else { panic!("pinned") };
        wraps_rad[0] * built.radii_m[0] + s.output_wraps_rad[0] * built.radii_m[1]
    };
    let middle = spec([0.5 * wrap; 2], [built.guard_rad + 0.5 * built.travel_rad; 2]);
    near(cable_m(&at_start), cable_m(&middle), 1e-14);
    let torque_nm = design.requirements.as_ref().expect("required").torque_nm;
    let force_n = torque_nm / behaviour.statics.levers_m()[1];
    for (ours, by_hand) in [(&behaviour.end, at_start), (&behaviour.statics, middle)] {
        for sign in [1.0, -1.0] {
            let exact = Drive::new(&by_hand).expect("a drive").at_force(sign * force_n).expect("pinned");
            let loaded = ours.under(sign * torque_nm).expect("pinned");
            for side in 0..2 {
                near(loaded.tensions_n[0][side], exact.tensions_n[side], 1e-12);
            }
            assert_eq!((loaded.at_pin, loaded.at_end), (exact.at_end.iter().any(|e| e[1]), exact.at_end.iter().any(|e| e[0])));
        }
    }
    // 4 turns less 2γ is 0.78 rad more than the input turns: slip reaches the pin at an end of the travel, not in its middle.
    assert!(behaviour.reaches_pin() && !behaviour.at_torque().expect("pinned").at_pin);
    assert!(measured.get("slip_used").expect("taut") > 1.0);
    let outcome = outcome(&[FASTENED]);
    assert_eq!(word(&outcome, "pin_wrap"), "missed");
    assert!(outcome.warnings.iter().any(|w| w.code == "W0702" && w.message.contains("pin")));
    // More turns, as advised, keep it off the pin.
    let turns = after(&advice(&outcome, "pin_wrap"), "about ");
    let more = outcome_of(&LONGVAL.replace("lines = [0, 4]\n", ""), &[FASTENED, &format!("design.extra_turns={}", 3.0 + turns)]);
    assert_eq!(word(&more, "pin_wrap"), "met");
}

fn outcome_of(text: &str, set: &[&str]) -> Outcome {
    Capstan::analyse(&understood(text, set).expect("a drive"), &mut |_| true).outcome
}

/// Nothing else limits a fastened cable: a slack side fails the drive, also if it is slack at an end of the travel only.
#[test]
fn a_fastened_cable_is_limited_by_its_slack_side() {
    let fine = outcome(&[FASTENED, "requirements.torque=5 N*m"]);
    assert!(check(&fine, "slack").required && word(&fine, "slack") == "met");
    assert!(!check(&outcome(&[]), "slack").required);
    let slack = outcome(&[FASTENED, "requirements.torque=60 N*m"]);
    assert_eq!(word(&slack, "slack"), "missed");
    assert!(!slack.requirements_met());
    // A side becomes loose at T_p (L_f + r₁Θ₁ + r₂Θ₂)/AE wherever the drive stands: what one drum lacks the other has.
    let fastened = design(&[FASTENED]);
    let (behaviour, _) = solved(&fastened);
    let (built, geometry) = (&fastened.built, &behaviour.geometry);
    let cos = maths::cos(geometry.helix_angle_rad());
    let wound_m = 0.5 * geometry.input_wrap_rad() * built.radii_m[0] + (built.guard_rad + built.middle_rad()) * built.radii_m[1];
    let loose_rad = 200.0 * (geometry.free_span_m() + wound_m) / cos / built.cables[0].axial_stiffness_n / (built.radii_m[1] * cos);
    for at in [&behaviour.statics, &behaviour.end] {
        for sign in [1.0, -1.0] {
            let slack = |turn_rad: f64| at.turned(sign * turn_rad).expect("pinned").tensions_n[0].into_iter().fold(f64::INFINITY, f64::min);
            assert!(slack(loose_rad * (1.0 - 1e-9)) > 0.0 && slack(loose_rad * (1.0 + 1e-9)) <= 0.0);
        }
    }
    // In the paper's model nothing is held beyond: that fails too.
    let paper = outcome(&[FASTENED, "model.source=paper", "requirements.torque=30 N*m"]);
    assert_eq!(word(&paper, "slack"), "missed");
    assert!(!paper.requirements_met());
}

#[test]
fn a_travel_that_unwinds_the_pin_is_refused() {
    let [(code, help)] = &understood(LONGVAL, &[FASTENED, "design.travel=300 deg"]).expect_err("unwound")[..] else { panic!("one error") };
    assert_eq!(*code, "E0707");
    // The travel that it names is that of the wrap over R, and the turns that it names do.
    near(after(help, "a travel below "), (4.0 * 360.0 - 2.0 * maths::acos(60.0 / 65.0).to_degrees()) / 5.0, 1e-3);
    let turns = after(&help.replace('`', ""), "extra_turns = ");
    let text = LONGVAL.replace("lines = [0, 4]\n", "");
    assert!(understood(&text, &[FASTENED, "design.travel=300 deg", &format!("design.extra_turns={turns}")]).is_ok());
    assert_eq!(refused(&text, &[FASTENED, "design.travel=300 deg", &format!("design.extra_turns={}", turns - 1.0)]), ["E0707"]);
    assert!(understood(LONGVAL, &["design.travel=300 deg"]).is_ok());
    // A study that makes the travel longer is told the same.
    let mut longer = design(&[FASTENED]);
    longer.built.travel_rad = 300.0_f64.to_radians();
    assert!(matches!(Behaviour::of(&longer), Err(forcewright_capstan::NoDrive::Unwound(rad)) if rad > 0.0));
}

/// Strength on the same drums, with what bending takes of a thicker cable.
#[test]
fn a_cable_as_thick_as_advised_is_strong_enough() {
    for factor in [6.0, 9.0] {
        let limit = format!("requirements.safety_factor={factor}");
        let missed = outcome(&[&limit]);
        let text = advice(&missed, "strength");
        let thicker = after(&text, "takes: ");
        let mut design = design(&[&limit]);
        for cable in &mut design.built.cables {
            cable.diameter_m *= thicker;
            cable.breaking_n = cable.breaking_n.map(|n| n * thicker * thicker);
            cable.axial_stiffness_n *= thicker * thicker;
        }
        let (_, measured) = solved(&design);
        let found = measured.get("cable_safety_factor").expect("known");
        assert!(found >= factor && found < 1.01 * factor, "{found} for {factor}: {text}");
        // The square alone is not enough.
        let square = (factor / check(&missed, "strength").value.expect("known")).sqrt();
        assert!(thicker > 1.0005 * square, "{thicker} {square}");
    }
}

#[test]
fn smooth_drums_get_advice_of_their_own() {
    let text = LONGVAL.replace("profile = \"round\", seat_angle = \"150 deg\", ", "profile = \"flat\", ");
    let steep = outcome_of(&text, &["design.groove.pitch=3 mm"]);
    let advice = advice(&steep, "fleet");
    assert!(!advice.contains("groove_phase") && !advice.contains("centre distance"), "{advice}");
    let pitch = after(&advice, "a pitch of at most ");
    assert_eq!(word(&outcome_of(&text, &[&format!("design.groove.pitch={pitch} mm")]), "fleet"), "met");
}

#[test]
fn lands_count_in_the_gap() {
    // 65 mm less 10 and 50 mm and a cable leave 3.5 mm; lands that stand 2.5 mm above the cable on either side are too much.
    let deep = ["design.groove.depth=4 mm", "design.groove.pitch=2 mm"];
    assert_eq!(word(&outcome(&[]), "gap"), "met");
    let missed = outcome(&deep);
    let gap = check(&missed, "gap");
    assert_eq!(gap.state.word(), "missed");
    let least = after(gap.advice.as_ref().expect("missed"), "a centre distance of at least ");
    near(least, 65.0 + 1.5, 1e-3);
    near(gap.value.expect("a gap"), 3.5e-3 - 2.0 * 2.5e-3, 1e-9);
    // Lands that would cut the other drum's grooves are no drive.
    let [(code, help)] = &understood(LONGVAL, &["design.groove.depth=7 mm"]).expect_err("too deep")[..] else { panic!("one error") };
    assert_eq!(*code, "E0702");
    near(after(help, "less than "), 6.5, 1e-3);
}

/// One mistake, one error: a value that was refused is not missing besides.
#[test]
fn one_error_for_each_mistake() {
    for angle in ["0 deg", "360 deg", "2 mm", "much"] {
        assert_eq!(refused(LONGVAL, &[&format!("design.groove.seat_angle={angle}")]).len(), 1, "{angle} by a setting");
        assert_eq!(refused(&LONGVAL.replace("seat_angle = \"150 deg\"", &format!("seat_angle = \"{angle}\"")), &[]).len(), 1, "{angle}");
    }
    let (line, _) = LONGVAL.split_once("groove = {").and_then(|(_, rest)| rest.split_once('}')).expect("a groove");
    let table = format!("\n[design.groove]\n{}\n", line.replace(", ", "\n").replace("150 deg", "360 deg"));
    let text = LONGVAL.replace(&format!("groove = {{{line}}}"), "") + &table;
    assert_eq!(refused(&text, &[]).len(), 1, "{text}");
}

#[test]
fn a_crowd_of_cables_is_refused_at_once() {
    let cable = "\n[[design.cables]]\nuse = \"steel 7x19 1.5 mm\"\npreload = \"100 N\"\n";
    let begun = std::time::Instant::now();
    let text = LONGVAL.to_owned() + &cable.repeat(300);
    assert_eq!(refused(&text, &[]), ["E0708"]);
    assert!(begun.elapsed().as_secs() < 5);
    // As many as are allowed are computed.
    let few = LONGVAL.to_owned() + &cable.repeat(31);
    match understood(&few, &[]) {
        Ok(design) => assert_eq!(design.built.cables.len(), 32),
        Err(errors) => assert!(errors.iter().all(|(code, _)| code.starts_with("E07")), "{errors:?}"),
    }
}

/// Limits that the trade has names for have codes of their own, and advice whose number just meets them.
#[test]
fn named_limits_say_what_meets_them() {
    // Shafts: less preload.
    let limit = "requirements.limits.shaft_load.max=150 N";
    let small = ["requirements.torque=1 N*m", "requirements.stiffness.min=1 N*m/rad", limit];
    let missed = outcome(&small);
    assert_eq!((check(&missed, "shaft_load").code, word(&missed, "shaft_load")), ("CAPS015", "missed"));
    let part = after(&advice(&missed, "shaft_load"), "a preload ");
    let preload = format!("design.cables.1.preload={} N", 200.0 * part);
    let met = outcome(&[&small[..], &[&preload]].concat());
    let margin = check(&met, "shaft_load").margin.expect("a limit");
    assert!((0.0..0.002).contains(&margin), "{margin}");
    // Resonance: a lighter output.
    let heavy = ["inertia.input=1e-5 kg*m^2", "inertia.output=0.05 kg*m^2", "requirements.limits.torsional_frequency.min=60 Hz"];
    let missed = outcome(&heavy);
    assert_eq!((check(&missed, "torsional_frequency").code, word(&missed, "torsional_frequency")), ("CAPS016", "missed"));
    let inertia = after(&advice(&missed, "torsional_frequency"), "the output of at most ");
    let met = outcome(&["inertia.input=1e-5 kg*m^2", &format!("inertia.output={inertia} kg*m^2"), heavy[2]]);
    assert!((0.0..0.002).contains(&check(&met, "torsional_frequency").margin.expect("a limit")));
    // Reflected inertia: a lighter input.
    let both = ["inertia.input=1e-4 kg*m^2", "inertia.output=1e-3 kg*m^2", "requirements.limits.reflected_inertia_output.max=2e-3 kg*m^2"];
    let missed = outcome(&both);
    let name = "reflected_inertia_output";
    assert_eq!((check(&missed, name).code, word(&missed, name)), ("CAPS017", "missed"));
    let inertia = after(&advice(&missed, name), "the input of at most ");
    let met = outcome(&[&format!("inertia.input={inertia} kg*m^2"), both[1], both[2]]);
    assert!((0.0..0.002).contains(&check(&met, name).margin.expect("a limit")));
    // Backdriving: better bearings.
    let name = "backdrive_torque_output";
    let value = solved(&design(&[])).1.get(name).expect("known");
    let rough = ["design.bearings.friction=0.05", &format!("requirements.limits.{name}.max={} N*m", 1.2 * value)];
    let missed = outcome(&rough);
    assert_eq!((check(&missed, name).code, word(&missed, name)), ("CAPS018", "missed"));
    let friction = after(&advice(&missed, name), "a friction of at most ");
    let met = outcome(&[&format!("design.bearings.friction={friction}"), rough[1]]);
    assert!((0.0..0.002).contains(&check(&met, name).margin.expect("a limit")));
    // What is not known is named.
    let text = LONGVAL.split("[inertia]").next().expect("a file").to_owned();
    let missing = outcome_of(&text, &["requirements.limits.reflected_inertia_output.max=2e-3 kg*m^2"]);
    assert_eq!(word(&missing, "reflected_inertia_output"), "not assessed");
    assert!(advice(&missing, "reflected_inertia_output").contains("inertia.input, inertia.output"));
    // Other limits say what moves their metric.
    let other = outcome(&["requirements.limits.free_span.max=10 mm"]);
    assert_eq!(check(&other, "free_span").code, "CAPS004");
    assert!(advice(&other, "free_span").contains("centre distance"));
}

/// The counter counts: required torque, two ends, and every point of curves and loop.
#[test]
fn states_are_counted() {
    let (behaviour, _) = solved(&design(&[]));
    let points: usize = behaviour.cycle.as_ref().expect("a loop").branches.iter().map(Vec::len).sum();
    assert_eq!(behaviour.states, (behaviour.stations.len() + points + 3) as u64);
    // Without a torque there is neither loop nor end to look at.
    let text = LONGVAL.split("[design]").nth(1).expect("a design");
    let free = understood(&format!("schema = 1\nmechanism = \"capstan\"\n[design]{text}"), &[]).expect("a drive");
    let (behaviour, _) = solved(&free);
    assert_eq!(behaviour.states, behaviour.stations.len() as u64);
}
