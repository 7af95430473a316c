//! Optima rounded to what can be had, against closed forms.
#![allow(clippy::unwrap_used, reason = "helpers of tests: what is not there fails the test")]

use forcewright::{Choices, DiskFiles, Loaded, Optimised};

/// A guided strip: with small deflections F = E d w³ δ/L³ and σ = 3 E w δ/L². At 100 mm the limit, half the yield stress, is reached by 50 mm.
fn strip(variables: &str, more: &str) -> String {
    format!(
        "schema = 1\nmechanism = \"compliant\"\n[requirements]\nstress = {{ safety_factor = 2 }}\n[material]\nuse = \"C75S\"\n\
         young_modulus = \"200 GPa\"\nyield_stress = \"600 MPa\"\n[design]\nthickness = \"45 mm\"   # in the plane\ndepth = \"10 mm\"\n\
         [design.nodes]\na = {{ at = [\"0 mm\", \"0 mm\"], support = \"clamped\" }}\n\
         b = {{ at = [\"100 mm\", \"0 mm\"], support = \"parallel\" }}\n[[design.beams]]\nname = \"strip\"\nbetween = [\"a\", \"b\"]\n\
         straight = true\n[load]\nnode = \"b\"\ndirection = [0, 1]\ntravel = \"0.1 mm\"\n[model]\nbeam = \"inextensible\"\n\
         [optimise]\nobjective = {{ maximise = \"force_at_end\" }}\n{more}\n[optimise.variables]\n{variables}\n"
    )
}

fn optimised(text: &str) -> Result<Optimised, (&'static str, String)> {
    let loaded = Loaded::from_text("a.toml", text, &Choices::default()).map_err(|e| e.render(false)).unwrap();
    loaded.optimise(&DiskFiles, "a-optimised.toml".as_ref(), (None, None), &|_| true).map_err(|refused| {
        let all = refused.diagnostics.in_file_order();
        (all[0].code, all[0].message.clone())
    })
}

/// F = E d w³ δ/L³.
fn force(thickness: f64, length: f64) -> f64 {
    200e9 * 0.01 * thickness * thickness * thickness * 1e-4 / (length * length * length)
}

fn goal(found: &Optimised) -> f64 {
    found.goal().2[1].unwrap()
}

/// The optimum is 50 mm; of the steps around it, 49.2 mm meets the limit and 56.2 mm does not.
#[test]
fn a_step_below_the_limit_is_taken() {
    let found = optimised(&strip("\"design.thickness\" = { range = [\"0.2 mm\", \"80 mm\"], step = \"7 mm\" }", "")).unwrap();
    let rounded = found.rounded.as_ref().unwrap();
    assert!(found.met() && (rounded.tried, rounded.met) == (2, 1), "{rounded:?}");
    let text = found.text.as_ref().unwrap();
    assert!(text.contains("thickness = \"49.2 mm\"   # in the plane"), "{text}");
    let (path, before, after) = &rounded.numbers[0];
    assert!(path == "design.thickness" && (before - 0.05).abs() < 1e-5 && (after - 0.0492).abs() < 1e-12);
    // The strip stiffens by about (δ/L)², 10⁻⁶.
    assert!((goal(&found) / force(0.0492, 0.1) - 1.0).abs() < 3e-6, "{}", goal(&found));
    // What rounding costs: the cube of what is left of the thickness.
    let cost = rounded.goal[1] / rounded.goal[0];
    assert!((cost / (0.984 * 0.984 * 0.984) - 1.0).abs() < 1e-3, "{cost}");
    assert!(found.verdict().iter().any(|s| s.title == "Sizes" && s.text.contains("one of them meets every requirement")));
    assert_eq!(found.document()["rounded"]["tried"], 2);
}

/// With the length free as well, the optimum has it at its largest, 120 mm, and 72 mm of thickness. Of the sizes around that, 75 mm breaks at any
/// length; with 60 mm the length is searched for again: L = √(3 E w δ/σ) = 109.54 mm.
#[test]
fn the_rest_is_searched_for_again() {
    let variables = "\"design.thickness\" = { among = [\"75 mm\", \"40 mm\", \"60 mm\"] }\n\"design.nodes.b.at.x\" = { range = [\"80 mm\", \"120 mm\"] }";
    let found = optimised(&strip(variables, "")).unwrap();
    let rounded = found.rounded.as_ref().unwrap();
    assert!(found.met() && (rounded.tried, rounded.met) == (2, 1), "{rounded:?}");
    assert!((rounded.numbers[0].1 - 0.072).abs() < 1e-4, "{rounded:?}");
    let length = (3.0 * 200e9 * 0.06 * 1e-4 / 300e6_f64).sqrt();
    let best = found.best.as_ref().unwrap();
    let place = |path: &str| found.variables.iter().position(|v| v.path == path).unwrap();
    assert!((best.x[place("design.thickness")] - 0.06).abs() < 1e-12);
    assert!((best.x[place("design.nodes.b.at.x")] / length - 1.0).abs() < 1e-3, "{}", best.x[place("design.nodes.b.at.x")]);
    assert!((goal(&found) / force(0.06, length) - 1.0).abs() < 3e-3, "{}", goal(&found));
    assert!(found.text.as_ref().unwrap().contains("thickness = \"60 mm\""));
}

/// An optimum that is a size already stays what it is; without sizes nothing is said of them.
#[test]
fn what_is_a_size_stays() {
    let found = optimised(
        &strip("\"design.thickness\" = { range = [\"10 mm\", \"40 mm\"], step = \"5 mm\" }", "")
            .replace("thickness = \"45 mm\"", "thickness = \"30 mm\""),
    )
    .unwrap();
    let rounded = found.rounded.as_ref().unwrap();
    assert!(found.met() && (rounded.tried, rounded.met) == (1, 1) && (rounded.numbers[0].2 - 0.04).abs() < 1e-12, "{rounded:?}");
    assert!((rounded.goal[1] / rounded.goal[0] - 1.0).abs() < 1e-6);
    let plain = optimised(&strip("\"design.thickness\" = { range = [\"0.2 mm\", \"80 mm\"] }", "")).unwrap();
    assert!(plain.rounded.is_none() && !plain.verdict().iter().any(|s| s.title == "Sizes"));
}

/// Where no size meets the limit the one that misses least is written, and said to.
#[test]
fn where_no_size_fits_the_nearest_is_given() {
    let found = optimised(
        &strip("\"design.thickness\" = { among = [\"55 mm\", \"70 mm\"] }", "").replace("thickness = \"45 mm\"", "thickness = \"60 mm\""),
    )
    .unwrap();
    let rounded = found.rounded.as_ref().unwrap();
    assert!(!found.met() && rounded.met == 0, "{rounded:?}");
    assert!(found.text.as_ref().unwrap().contains("thickness = \"55 mm\""));
}

/// More numbers than are tried at once are fixed one after the other: five thicknesses of beams in a row would be 2⁵ combinations.
#[test]
fn many_are_fixed_one_after_the_other() {
    let mut text = strip("\"design.beams.*.thickness\" = { range = [\"20 mm\", \"80 mm\"], step = \"7 mm\" }", "");
    let nodes: Vec<String> = (1..5).map(|i| format!("m{i} = {{ at = [\"{} mm\", \"0 mm\"] }}\n", 20 * i)).collect();
    let names = ["a", "m1", "m2", "m3", "m4", "b"];
    let beam = |(i, w): (usize, &[&str])| {
        format!("[[design.beams]]\nname = \"s{i}\"\nbetween = [\"{}\", \"{}\"]\nstraight = true\nthickness = \"45 mm\"\n", w[0], w[1])
    };
    let beams: Vec<String> = names.windows(2).enumerate().map(beam).collect();
    let (nodes, beams) = (nodes.concat(), beams.concat());
    text = text.replace("[[design.beams]]\nname = \"strip\"\nbetween = [\"a\", \"b\"]\nstraight = true\n", &format!("{nodes}{beams}"));
    let found = optimised(&text).unwrap();
    let rounded = found.rounded.as_ref().unwrap();
    assert!(found.met() && rounded.numbers.len() == 5, "{rounded:?}");
    for (_, _, size) in &rounded.numbers {
        let steps = (size - 0.02) / 0.007;
        assert!((steps - steps.round()).abs() < 1e-9, "{rounded:?}");
    }
    // One number by itself, then the other four at once: 2 + 2⁴; fewer if a number is at a size already.
    assert!(rounded.tried <= 18, "{rounded:?}");
    println!("{rounded:?}");
}

#[test]
fn what_cannot_be_rounded_is_refused() {
    let of = |variables: &str, more: &str| optimised(&strip(variables, more)).err().unwrap();
    let step = of("\"design.thickness\" = { range = [\"20 mm\", \"80 mm\"], step = \"-1 mm\" }", "");
    assert!(step.0 == "E0204" && step.1.contains("a step is one positive value"), "{step:?}");
    let long = of("\"design.thickness\" = { range = [\"20 mm\", \"80 mm\"], step = \"61 mm\" }", "");
    assert!(long.0 == "E0204", "{long:?}");
    let within = of("\"design.thickness\" = { within = \"5 mm\", step = \"1 mm\" }", "");
    assert!(within.0 == "E0204" && within.1.contains("belongs to a `range`"), "{within:?}");
    let one = of("\"design.thickness\" = { among = [\"45 mm\"] }", "");
    assert!(one.0 == "E0204" && one.1.contains("nothing to choose from"), "{one:?}");
    let both = of("\"design.thickness\" = { range = [\"20 mm\", \"80 mm\"], among = [\"45 mm\", \"50 mm\"] }", "");
    assert!(both.0 == "E0302", "{both:?}");
    let text = strip("\"design.thickness\" = { range = [\"20 mm\", \"80 mm\"], step = \"1 mm\" }", "robust = \"worst_case\"")
        .replace("\"45 mm\"", "\"45 mm ± 0.1 mm\"");
    let robust = optimised(&text).err().unwrap();
    assert!(robust.0 == "E0922" && robust.1.contains("in spite of scatter"), "{robust:?}");
}

/// The motor is chosen for the design: its reduction comes in sizes as well.
#[test]
fn a_reduction_that_can_be_bought() {
    let hand = include_str!("../../../examples/lavt/prosthetic-hand.toml");
    let search = "[optimise]\nobjective = { minimise = \"grasp_time\" }\n[optimise.variables]\n";
    let found = optimised(&format!("{hand}\n{search}\"motor.reduction\" = {{ range = [10, 40], step = 5 }}\n")).unwrap();
    let rounded = found.rounded.as_ref().unwrap();
    let (path, before, after) = &rounded.numbers[0];
    let steps = (after - 10.0) / 5.0;
    assert!(path == "motor.reduction" && (steps - steps.round()).abs() < 1e-9 && (after - before).abs() < 5.0, "{rounded:?}");
}
