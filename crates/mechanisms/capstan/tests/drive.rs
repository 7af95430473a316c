//! The family against closed forms, work, symmetry and scaling laws.

use forcewright_base::diagnostics::Diagnostics;
use forcewright_capstan::geometry::Belt;
use forcewright_capstan::{Behaviour, Built, Capstan, Design, Losses, Measured, Source, Spec, Statics, measure, shaft_load_n};
use forcewright_contract::family::Mechanism as _;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;
use forcewright_contract::studies::{Free, Purpose};
use forcewright_study::evaluator::Evaluation;

const LONGVAL: &str = include_str!("../../../../examples/capstan/longval.toml");
const HANDLE: &str = include_str!("../../../../examples/capstan/haptic-handle.toml");
const LEG: &str = include_str!("../../../../examples/capstan/quadruped-leg.toml");
const STAGE: &str = include_str!("../../../../examples/capstan/pointing-stage.toml");

fn understood(text: &str, set: &[&str]) -> (Spec, Result<Design, Vec<&'static str>>) {
    let choices = Choices { variant: None, set: set.iter().map(|s| (*s).to_owned()).collect() };
    let project = Project::from_text("test.toml", text, &choices);
    let mut diagnostics: Diagnostics = project.diagnostics;
    let mut spec: Spec = read::read(&project.tree, project.root, &mut diagnostics);
    let design = Capstan::resolve(&mut spec, &mut diagnostics);
    let codes = || diagnostics.in_file_order().iter().map(|d| d.code).collect();
    (spec, design.filter(|_| !diagnostics.has_errors()).ok_or_else(codes))
}

fn design(text: &str, set: &[&str]) -> Design {
    understood(text, set).1.expect("a drive")
}

fn solved(design: &Design) -> (Behaviour, Measured) {
    let behaviour = Behaviour::of(design).expect("a drive");
    let measured = measure(design, &behaviour);
    (behaviour, measured)
}

fn near(ours: f64, exact: f64, relative: f64) {
    assert!((ours - exact).abs() <= relative * exact.abs(), "{ours} instead of {exact}");
}

fn get(measured: &Measured, name: &str) -> f64 {
    measured.get(name).unwrap_or_else(|| panic!("no {name}"))
}

#[test]
fn the_gallery_meets_its_requirements() {
    for text in [LONGVAL, HANDLE, LEG, STAGE] {
        let analysis = Capstan::analyse(&design(text, &[]), &mut |_| true);
        let missed: Vec<_> = analysis.outcome.checks.iter().filter(|c| c.required && c.advice.is_some()).collect();
        assert!(analysis.outcome.requirements_met(), "{}: {missed:#?}", analysis.outcome.title);
    }
}

#[test]
fn turning_works_as_much_as_the_cable_takes() {
    // ∫τ dφ over a loop is the work that friction takes, counted zone by zone in the engine.
    for text in [LONGVAL, HANDLE, LEG, STAGE] {
        let (behaviour, _) = solved(&design(text, &[]));
        let cycle = behaviour.cycle.expect("a loop");
        let area = |points: &[[f64; 2]]| points.windows(2).map(|p| 0.5 * (p[0][1] + p[1][1]) * (p[1][0] - p[0][0])).sum::<f64>();
        let [_, back, forth] = &cycle.branches;
        // Trapezoids on 200 intervals; the branches have a steep end.
        near(area(back) + area(forth), cycle.lost_j, 2e-3);
        near(back[0][0], forth[forth.len() - 1][0], 1e-12);
        near(back[0][1], forth[forth.len() - 1][1], 1e-9);
    }
}

#[test]
fn small_torques_have_closed_forms() {
    // Lost motion (r₁ + r₂)q²/(2μ AE T_p) and energy (4/3)(r₁ + r₂)q³/(μ AE T_p), q = F/2, with the lengths of the helix.
    let design = design(LONGVAL, &["requirements.torque=0.2 N*m"]);
    let (behaviour, measured) = solved(&design);
    let built = &design.built;
    let cos = forcewright_base::maths::cos(behaviour.geometry.helix_angle_rad());
    let mu = built.friction * built.groove_factor * cos;
    let sum = (built.radii_m[0] + built.radii_m[1]) / cos;
    let lever = built.radii_m[1] * cos;
    let (q, ae, preload) = (0.5 * 0.2 / lever, built.cables[0].axial_stiffness_n, built.cables[0].preload_n);
    near(get(&measured, "lost_motion_output"), sum * q * q / (2.0 * mu * ae * preload) / lever, 1e-3);
    near(get(&measured, "loss_per_cycle"), 4.0 / 3.0 * sum * q * q * q / (mu * ae * preload), 1e-3);
}

#[test]
fn tangents_are_derivatives() {
    let (behaviour, _) = solved(&design(LEG, &[]));
    let statics = &behaviour.statics;
    for torque in [0.5, 5.0, 20.0, 60.0] {
        let at = |t: f64| statics.under(t).expect("held").turn_rad;
        let step = 1e-4 * torque;
        let ours = statics.torsional(statics.under(torque).expect("held").tangent_n_per_m, 1);
        near(2.0 * step / (at(torque + step) - at(torque - step)), ours, 1e-5);
    }
}

#[test]
fn the_helix_keeps_work() {
    // A small turn φ works as much at the output as the cable stores in its spans: ½τφ = ½F²/K.
    let design = design(LONGVAL, &["design.groove.pitch=20 mm", "requirements.torque=1e-5 N*m"]);
    let (behaviour, _) = solved(&design);
    let loaded = behaviour.at_torque().expect("held");
    let span = behaviour.geometry.free_span_m() / forcewright_base::maths::cos(behaviour.geometry.helix_angle_rad());
    let stored = 0.5 * loaded.force_n * loaded.force_n * span / (2.0 * design.built.cables[0].axial_stiffness_n);
    near(0.5 * loaded.torque_nm * loaded.turn_rad, stored, 1e-4);
}

#[test]
fn cables_in_parallel() {
    let one = design(LONGVAL, &[]);
    let mut two = one.clone();
    two.built.cables = vec![one.built.cables[0].clone(); 2];
    two.built.cables[1].lines = [6, 10];
    // Two at half the preload each: twice the stiffness; two at the same: twice at rest, much more under the same torque.
    for cable in &mut two.built.cables {
        cable.preload_n *= 0.5;
    }
    let half = solved(&two).1;
    let single = solved(&one).1;
    near(get(&half, "stiffness_tangent_output"), 2.0 * get(&single, "stiffness_tangent_output"), 1e-10);
    near(get(&half, "gross_slip_torque_output"), get(&single, "gross_slip_torque_output"), 1e-10);
    for cable in &mut two.built.cables {
        cable.preload_n *= 2.0;
    }
    let full = solved(&two).1;
    near(get(&full, "stiffness_initial_output"), 2.0 * get(&single, "stiffness_initial_output"), 1e-12);
    near(get(&full, "gross_slip_torque_output"), 2.0 * get(&single, "gross_slip_torque_output"), 1e-10);
    let gain = get(&full, "stiffness_tangent_output") / get(&single, "stiffness_tangent_output");
    assert!((2.5..4.0).contains(&gain), "{gain}");
    // The theory's example: × 3.33 at 5 N·m and × 3.57 at 10 N·m on smooth drums with 50 kN.
    for (torque, gain) in [(5.0, 3.33), (10.0, 3.57)] {
        let (one, two) = ([one.clone(), two.clone()])
            .map(|mut d| {
                d.built.groove_factor = 1.0;
                d.built.helix_correction = false;
                d.built.cables.iter_mut().for_each(|c| (c.axial_stiffness_n, c.preload_n) = (50e3, 200.0));
                d.requirements.as_mut().expect("required").torque_nm = torque;
                get(&solved(&d).1, "stiffness_tangent_output")
            })
            .into();
        near(two / one, gain, 2e-3);
    }
}

#[test]
fn temperature_and_bedding_in_change_the_preload() {
    let (design, (_, measured)) = {
        let design = design(STAGE, &[]);
        let solved = solved(&design);
        (design, solved)
    };
    // ΔT_p = AE (α − α_c) ΔT.
    let expected = 350.0 + design.built.cables[0].axial_stiffness_n * (23e-6 - 16e-6) * -30.0;
    near(get(&measured, "preload_left"), expected, 1e-12);
    let leg = self::design(LEG, &[]);
    near(get(&solved(&leg).1, "preload_left"), 300.0 * 0.85, 1e-12);
}

#[test]
fn losses_have_closed_forms() {
    // Nothing lost: nothing needed to turn it, efficiency 1.
    let free = ["design.bearings.friction=0", "design.cables.1.bending_loss=0 %"];
    let (_, measured) = solved(&design(LONGVAL, &free));
    assert!(get(&measured, "backdrive_torque_output").abs() <= 0.0);
    near(get(&measured, "efficiency_forward"), 1.0, 1e-12);
    near(get(&measured, "efficiency_backward"), 1.0, 1e-12);
    // Bearings alone, at rest: μ_b (D₁/2 R + D₂/2) 2T_p sin γ to first order; drags add R times that of the input.
    let design =
        design(LONGVAL, &["design.cables.1.bending_loss=0 %", "design.bearings.input_drag=2 N*mm", "design.bearings.output_drag=5 N*mm"]);
    let (behaviour, measured) = solved(&design);
    let load = shaft_load_n(&[[200.0, 200.0]], behaviour.span());
    near(load, 400.0 * behaviour.span()[0], 1e-14);
    let first = 0.0015 * load * (0.004 * 5.0 + 0.0075) + 5.0 * 0.002 + 0.005;
    near(get(&measured, "backdrive_torque_output"), first, 1e-3);
    // Power is lost, never won: forward and backward both below 1.
    for name in ["efficiency_forward", "efficiency_backward"] {
        assert!((0.9..1.0).contains(&get(&measured, name)), "{name}");
    }
    // Bending: c T on the input drum, c T r₁/r₂ on the output: R r₁ c T + r₁ c T.
    let bent = self::design(LONGVAL, &["design.bearings.friction=0", "design.cables.1.bending_loss=0.1 %"]);
    let (behaviour, measured) = solved(&bent);
    let cos = forcewright_base::maths::cos(behaviour.geometry.helix_angle_rad());
    near(get(&measured, "backdrive_torque_output"), 1e-3 * 200.0 * 0.01 * cos * (5.0 + 1.0), 1e-3);
}

#[test]
fn what_is_not_known_is_not_assessed() {
    let text = LONGVAL.replace("bending_loss = \"0.5 %\"", "");
    let analysis = Capstan::analyse(&design(&text, &[]), &mut |_| true);
    assert!(analysis.outcome.metric("backdrive_torque_output").is_none());
    let check = analysis.outcome.check("backdrive_torque_output").expect("required");
    assert_eq!(check.state.word(), "not assessed");
    assert!(check.advice.as_ref().is_some_and(|a| a.contains("bending_loss")), "{check:?}");
    assert!(analysis.outcome.warnings.iter().any(|w| w.code == "W0703"));
}

/// A drive k times as large in all lengths, with forces k² times as large.
fn scaled(design: &Design, k: f64) -> Design {
    let mut large = design.clone();
    let Built { radii_m, distance_m, pitch_m, cables, bearings, seat, .. } = &mut large.built;
    *radii_m = radii_m.map(|r| r * k);
    *distance_m *= k;
    *pitch_m *= k;
    for cable in cables {
        cable.diameter_m *= k;
        cable.axial_stiffness_n *= k * k;
        cable.preload_n *= k * k;
        cable.breaking_n = cable.breaking_n.map(|n| n * k * k);
    }
    bearings.bores_m.iter_mut().flatten().for_each(|d| *d *= k);
    seat.radius_m = seat.radius_m.map(|r| r * k);
    large.making.margin_m *= k;
    large.making.anchor_m *= k;
    if let Some(requirements) = &mut large.requirements {
        requirements.torque_nm *= k * k * k;
    }
    large
}

#[test]
fn size_scales_everything() {
    let k: f64 = 2.0;
    let small = design(LONGVAL, &[]);
    let (a, b) = (solved(&small).1, solved(&scaled(&small, k)).1);
    for (name, power) in [
        ("stiffness_tangent_output", 3),
        ("stiffness_initial_output", 3),
        ("gross_slip_torque_output", 3),
        ("lost_motion_output", 0),
        ("loss_per_cycle", 3),
        ("taut_tension", 2),
        ("shaft_load", 2),
        ("backdrive_torque_output", 3),
        ("efficiency_forward", 0),
        ("free_span", 1),
        ("input_wrap", 0),
        ("fleet_angle", 0),
        ("alignment_mismatch", 0),
        ("occupancy_clearance", 0),
        ("output_drum_length", 1),
        ("cable_length", 1),
        ("bending_ratio", 0),
        ("cable_safety_factor", 0),
    ] {
        near(get(&b, name), get(&a, name) * forcewright_base::maths::powf(k, f64::from(power)), 1e-9);
    }
}

#[test]
fn hands_and_directions_are_alike() {
    for text in [LONGVAL, LEG] {
        let (right, left) = (solved(&design(text, &[])).1, solved(&design(text, &["design.hand=left"])).1);
        for info in forcewright_capstan::METRICS {
            match (right.get(info.name), left.get(info.name)) {
                (Some(a), Some(b)) => near(b, a, 1e-9),
                (a, b) => assert_eq!(a, b, "{}", info.name),
            }
        }
        let statics = solved(&design(text, &[])).0.statics;
        let (one, other) = (statics.under(3.0).expect("held"), statics.under(-3.0).expect("held"));
        assert_eq!(one.turn_rad.to_bits(), (-other.turn_rad).to_bits());
    }
}

#[test]
fn a_fastened_cable_does_not_slip_as_a_whole() {
    let (behaviour, measured) = solved(&design(LONGVAL, &["design.input_hold=fastened"]));
    assert!(measured.get("gross_slip_torque_output").is_none());
    // Before slip reaches the pin nothing differs.
    near(get(&measured, "stiffness_tangent_output"), get(&solved(&design(LONGVAL, &[])).1, "stiffness_tangent_output"), 1e-9);
    // Far beyond, the taut side carries alone.
    let far = behaviour.statics.under(200.0).expect("pinned");
    assert!(far.tensions_n[0][1].abs() <= 0.0);
    near(far.tensions_n[0][0], far.force_n, 1e-12);
}

#[test]
fn a_torque_that_is_not_held_is_said() {
    let analysis = Capstan::analyse(&design(LONGVAL, &["requirements.torque=40 N*m"]), &mut |_| true);
    assert_eq!(analysis.outcome.status.kind.word(), "no equilibrium beyond");
    let check = analysis.outcome.check("torque").expect("the capacity");
    assert_eq!(check.state.word(), "missed");
    // So many times the preload holds it: capacity is in proportion to it.
    let advised = 1.0001 * 200.0 * 40.0 / check.value.expect("a capacity");
    let more = design(LONGVAL, &["requirements.torque=40 N*m", &format!("design.cables.1.preload={advised} N")]);
    assert_eq!(Capstan::analyse(&more, &mut |_| true).outcome.check("torque").expect("it").state.word(), "met");
    assert_eq!(analysis.outcome.check("stiffness").expect("required").state.word(), "not assessed");
}

#[test]
fn advice_is_right() {
    let analysis = Capstan::analyse(&design(LONGVAL, &["requirements.stiffness.min=4000 N*m/rad"]), &mut |_| true);
    let advice = analysis.outcome.check("stiffness").and_then(|c| c.advice.clone()).expect("missed");
    let factor: f64 = advice.split_whitespace().nth(2).and_then(|w| w.parse().ok()).expect("a factor");
    let more = design(LONGVAL, &["requirements.stiffness.min=4000 N*m/rad", &format!("design.cables.1.preload={} N", 200.0 * factor)]);
    let (_, measured) = solved(&more);
    let found = get(&measured, "stiffness_tangent_output");
    assert!((4000.0..4040.0).contains(&found), "{found}: {advice}");
    // Beyond the spans nothing helps.
    let analysis = Capstan::analyse(&design(LONGVAL, &["requirements.stiffness.min=30000 N*m/rad"]), &mut |_| true);
    let advice = analysis.outcome.check("stiffness").and_then(|c| c.advice.clone()).expect("missed");
    assert!(advice.contains("free spans alone"), "{advice}");
}

#[test]
fn the_papers_model_stands_beside() {
    let paper = design(LONGVAL, &["model.source=paper"]);
    assert_eq!(paper.source, Source::Paper);
    let (behaviour, measured) = solved(&paper);
    let loaded = behaviour.at_torque().expect("held");
    // Half of the force on each side.
    near(loaded.tensions_n[0][0] - 200.0, 200.0 - loaded.tensions_n[0][1], 1e-12);
    assert!(get(&measured, "stiffness_tangent_output") < get(&solved(&design(LONGVAL, &[])).1, "stiffness_tangent_output"));
    assert!(measured.get("lost_motion_output").is_none());
    // The slack side cannot carry less than nothing.
    let far = design(LONGVAL, &["model.source=paper", "requirements.torque=21 N*m"]);
    assert!(solved(&far).0.at_torque().is_none());
}

#[test]
fn an_open_belt_is_a_drive_too() {
    // γ beyond a right angle: another landing, other lines.
    let text = LONGVAL.replace("lines = [0, 4]\n", "");
    let open = design(&text, &["design.belt=open"]);
    assert_eq!(open.built.belt, Belt::Open);
    assert_eq!(open.built.cables[0].lines, [0, 8]);
    let (behaviour, _) = solved(&open);
    near(behaviour.geometry.free_span_m(), (0.065_f64 * 0.065 - 0.04 * 0.04).sqrt(), 1e-12);
    assert_eq!(understood(LONGVAL, &["design.belt=open"]).1.expect_err("lands elsewhere"), ["E0704"]);
}

#[test]
fn faults_have_their_codes() {
    let set = |text: &str, set: &[&str]| understood(text, set).1.expect_err("refused");
    assert_eq!(set(LONGVAL, &["design.centre_distance=59 mm"]), ["E0701"]);
    assert_eq!(set(LONGVAL, &["design.groove.angle=40 deg"]), ["E0702"]);
    assert_eq!(set(&LONGVAL.replace("seat_angle = \"150 deg\", ", ""), &[]), ["E0702"]);
    assert_eq!(set(LONGVAL, &["design.cables.1.use=rope of hair 2 mm"]), ["E0703"]);
    assert_eq!(set(&LONGVAL.replace("7x19 1.5 mm", "7x19"), &[]), ["E0703", "E0703"]);
    assert_eq!(set(&LEG.replacen("diameter = \"2 mm\"", "diameter = \"2.2 mm\"", 1), &[]), ["E0703"]);
    assert_eq!(set(&LONGVAL.replace("lines = [0, 4]", "lines = [0, 5]"), &[]), ["E0704"]);
    assert_eq!(set(&LONGVAL.replace("lines = [0, 4]", "lines = [0, 4, 8]"), &[]), ["E0704"]);
    assert_eq!(set(&LEG.replacen("preload = \"300 N\"", "preload = \"200 N\"", 1), &["model.source=paper"]), ["E0705"]);
    assert_eq!(set(LONGVAL, &["environment.temperature_change=20 K"]), ["E0706"]);
    assert_eq!(set(STAGE, &["environment.temperature_change=-300 K", "design.expansion=1e-4 1/K"]), ["E0706"]);
}

#[test]
fn studies_see_what_solve_sees() {
    let (spec, design) = understood(LONGVAL, &[]);
    let design = design.expect("a drive");
    let mut spec = spec;
    let numbers = forcewright_contract::numbers::numbers_of(&mut spec);
    let free: Vec<Free> = ["design.friction", "design.cables.1.preload", "design.centre_distance", "design.groove.seat_angle"]
        .iter()
        .map(|path| {
            let number = numbers.iter().find(|n| n.path == *path).unwrap_or_else(|| panic!("{path}")).clone();
            let si = number.si;
            Free { number, lower: 0.9 * si, upper: 1.1 * si }
        })
        .collect();
    let mut diagnostics = Diagnostics::default();
    let evaluator = Capstan::evaluator(&spec, &design, &free, &mut diagnostics).expect("an evaluator");
    let mut room = evaluator.workspace();
    let mut out = Evaluation::default();
    let moved = |factor: f64| free.iter().map(|f| f.number.si * factor).collect::<Vec<_>>();
    // At the file's values, the metrics of `solve` to the bit.
    evaluator.evaluate(&moved(1.0), true, &mut out, &mut room).expect("a drive");
    let measured = solved(&design).1;
    for (measure, output) in evaluator.measures().iter().zip(&evaluator.outputs()[1..]) {
        assert_eq!(out.values[output.values.start].to_bits(), get(&measured, &measure.name).to_bits(), "{}", measure.name);
    }
    // Elsewhere, those of a file with these values.
    let at = moved(1.02);
    evaluator.evaluate(&at, false, &mut out, &mut room).expect("a drive");
    let set = [
        format!("design.friction={}", at[0]),
        format!("design.cables.1.preload={} N", at[1]),
        format!("design.centre_distance={} m", at[2]),
        format!("design.groove.seat_angle={} rad", at[3]),
    ];
    let (_, measured) = solved(&self::design(LONGVAL, &set.each_ref().map(String::as_str)));
    for (measure, output) in evaluator.measures().iter().zip(&evaluator.outputs()[1..]) {
        near(out.values[output.values.start], get(&measured, &measure.name), 1e-12);
    }
    // A search for the least preload is known; one with a window is not.
    assert!(Capstan::task(&spec, &design, &free, Purpose::Search, &mut diagnostics).is_none());
}

#[test]
fn losses_of_a_loaded_drive_balance() {
    // Input work less output work is what bearings and bending take, at the tensions of that state.
    let design = design(LONGVAL, &[]);
    let geometry = design.built.geometry().expect("a drive");
    let statics = Statics::new(&design.built, &design.built.place(&geometry, design.built.middle_rad()), design.source).expect("a drive");
    let losses = Losses::of(&design.built, &geometry, &statics).expect("all known");
    let forward = losses.forward(10.0).expect("held");
    let backward = losses.backward(10.0).expect("held");
    let lost = forward.input_nm * 5.0 - 10.0;
    assert!(lost > 0.0 && 10.0 - backward.input_nm * 5.0 > 0.0);
    // The same, written out: M₁ R + M₂ + r₁ c ΣT/2 (R + 1).
    let force = (10.0 + lost) / statics.levers_m()[1];
    let tensions = statics.under(force * statics.levers_m()[1]).expect("held").tensions_n;
    let (sin, cos) = forcewright_base::maths::sin_cos(geometry.tangent_angle_rad());
    let load = shaft_load_n(&tensions, [sin, cos]);
    let bent = 0.005 * 0.5 * (tensions[0][0] + tensions[0][1]) * statics.levers_m()[0];
    near(lost, 0.0015 * load * (0.004 * 5.0 + 0.0075) + bent * 6.0, 1e-2);
}

#[test]
fn ends_of_the_travel_count() {
    // With a short wrap before one termination the cable slips earlier than in the middle.
    let (behaviour, measured) = solved(&design(LONGVAL, &[]));
    assert!(get(&measured, "gross_slip_torque_output") < behaviour.statics.gross_slip_nm().expect("held by friction"));
    // Without a guard slip reaches the termination, and that is missed.
    let bare = Capstan::analyse(&design(LONGVAL, &["design.output_anchor_wrap=0 deg"]), &mut |_| true);
    assert_eq!(bare.outcome.check("termination").expect("always judged").state.word(), "missed");
    assert!(bare.outcome.warnings.iter().any(|w| w.code == "W0702"));
    assert!(bare.outcome.metric("taut_tension").expect("held").value > get(&measured, "taut_tension"));
}
