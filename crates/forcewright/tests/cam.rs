//! The cam family through the whole program: yield in closed form, searches, designs from requirements, parts.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::Path;

use forcewright::fabricate::{Format, Options};
use forcewright::model::Part;
use forcewright::{Choices, DiskFiles, Loaded, SynthesisTask, ToleranceChoices};

fn text(name: &str) -> &'static str {
    forcewright::gallery::find(name).expect("in the gallery").text
}

fn load(name: &str, text: &str, set: &[&str]) -> Loaded {
    let choices = Choices { set: set.iter().map(|s| (*s).to_owned()).collect(), ..Choices::default() };
    Loaded::from_text(name, text, &choices).unwrap_or_else(|e| panic!("{}", e.render(false)))
}

fn metric(loaded: &Loaded, name: &str) -> f64 {
    loaded.solve("cam.toml", "", &mut |_| true).outcome.metric(name).unwrap_or_else(|| panic!("no {name}")).value
}

/// Hysteresis follows the arm of the rolling resistance: with a normal arm, the part of mechanisms below a limit is the normal
/// distribution's.
#[test]
fn the_yield_of_a_hysteresis_is_that_of_the_arm() {
    let set = [
        "design.springs.rest_length=\"136 mm\"",
        "design.springs.rates=[\"0.683 N/mm\", \"0.682 N/mm\"]",
        "requirements.force.band=\"20 %\"",
    ];
    let loaded = load("sanchez-2-springs", text("sanchez-2-springs"), &set);
    let nominal = metric(&loaded, "hysteresis");
    let found = loaded.tolerance(ToleranceChoices { samples: Some(4096), seed: Some(1), linear: None }, &mut |_| true).unwrap();
    // ±0.008 mm are three standard deviations; the limit is 3 %.
    let z = (0.03 / nominal - 1.0) * 0.032 / (0.008 / 3.0);
    let expected = 1.0 - 0.5 * forcewright::base::maths::erfc(z / 2.0_f64.sqrt());
    let estimate = found.study.all.estimate.value;
    // To first order the loop is linear in the arm; the next order is below 1 % of it.
    assert!((estimate - expected).abs() < 0.006, "{estimate}, expected {expected}");
}

/// The rate that centres the force in its band makes the deviation least: a search finds it.
#[test]
fn a_search_centres_the_force() {
    let study = "\n[optimise]\nobjective = { minimise = \"force_deviation\" }\n[optimise.variables]\n\"design.springs.rate\" = { range = [\"0.6 N/mm\", \"0.8 N/mm\"] }\n";
    let loaded = load("no-undercut", &format!("{}{study}", text("no-undercut")), &["design.springs.rate=\"0.7 N/mm\""]);
    let found = loaded.optimise(&DiskFiles, Path::new("centred.toml"), (None, None), &|_| true).map_err(|e| e.render(false)).unwrap();
    let centred = load("centred", found.text.as_deref().expect("a better design"), &[]);
    let (value, spread) = (metric(&centred, "force_deviation"), metric(&centred, "force_spread"));
    // With the middle of the extremes at the level, the deviation is half the spread.
    assert!((value / spread - 1.0).abs() < 1e-3, "{value} {spread}");
}

/// The goal of a search is told as the metric that it is, in its unit; and a setting whose keys are paths is written into the new file whole.
#[test]
fn a_search_for_the_least_hysteresis_speaks_of_a_ratio() {
    let set = [
        "optimise.objective={ minimise = \"hysteresis\" }",
        "optimise.variables={ \"design.roller_diameter\" = { range = [\"30 mm\", \"34 mm\"] } }",
    ];
    let loaded = load("no-undercut", text("no-undercut"), &set);
    let found = loaded.optimise(&DiskFiles, Path::new("less.toml"), (None, None), &|_| true).map_err(|e| e.render(false)).unwrap();
    let written = found.text.as_deref().expect("a better design");
    assert!(written.contains("\"design.roller_diameter\""), "{written}");
    let value = metric(&load("less", written, &[]), "hysteresis");
    let told = found.wording.value(found.best.as_ref().expect("a run").goal);
    // The search means over its stations, the metric over more of them.
    assert!((told / value - 1.0).abs() < 1e-3, "{told} {value}");
    assert_eq!(found.wording.unit.dimension(), Some(forcewright::base::units::Dimension::Ratio));
}

/// The same of a torque cam; and the smallest disc that a search finds keeps what is required, its rollers at the edge of the undercut.
#[test]
fn searches_of_torque_cams() {
    let study = |objective: &str, variables: &str| {
        format!("\n[optimise]\nobjective = {{ minimise = \"{objective}\" }}\n[optimise.variables]\n{variables}\n")
    };
    let searched = |study: String, set: &[&str]| {
        let loaded = load("torque-cam", &format!("{}{study}", text("torque-cam")), set);
        let found = loaded.optimise(&DiskFiles, Path::new("found.toml"), (None, None), &|_| true).map_err(|e| e.render(false)).unwrap();
        load("found", found.text.as_deref().expect("a better design"), &[])
    };
    let rate = "\"design.springs.rate\" = { range = [\"0.6 N/mm\", \"0.8 N/mm\"] }";
    let centred = searched(study("torque_deviation", rate), &["design.springs.rate=\"0.71 N/mm\""]);
    let (value, spread) = (metric(&centred, "torque_deviation"), metric(&centred, "torque_spread"));
    assert!((value / spread - 1.0).abs() < 1e-3, "{value} {spread}");
    let sizes = "\"design.disc.start_radius\" = { range = [\"28 mm\", \"60 mm\"] }\n\"design.roller_diameter\" = { range = [\"12 mm\", \"26 mm\"] }";
    let before = load("torque-cam", text("torque-cam"), &[]);
    let small = searched(study("disc_diameter", sizes), &[]);
    assert!(metric(&small, "disc_diameter") < 0.99 * metric(&before, "disc_diameter"));
    let report = small.solve("cam.toml", "", &mut |_| true);
    assert!(report.outcome.checks.iter().filter(|c| c.required).all(|c| c.state == forcewright::model::CheckState::Met));
}

#[test]
fn designs_from_requirements_meet_them_and_what_blocks_is_named() {
    let asked = |room: &str| {
        format!(
            "schema = 1\nmechanism = \"cam\"\ntitle = \"Asked for\"\n[requirements]\nforce = {{ nominal = \"80 N\", band = \"3 %\" }}\nstroke = \"150 mm\"\n\
             window = [\"5 mm\", \"150 mm\"]\nhysteresis = \"4 %\"\n[environment]\ngravity = \"0 m/s^2\"\n[synthesise]\nroom = {room}\nrolling_arm = \"0.02 mm\"\ncandidates = 2\n"
        )
    };
    let run = |text: &str| {
        SynthesisTask::from_text("asked.toml", text, &[]).map_err(|e| e.render(false)).unwrap().run(Path::new("asked.toml"), &|_| true)
    };
    let found = run(&asked("[\"260 mm\", \"420 mm\"]"));
    assert!(found.met());
    for design in &found.designs {
        let loaded = load(&design.file, &design.text, &[]);
        let outcome = loaded.solve(&design.file, "", &mut |_| true).outcome;
        assert!(outcome.requirements_met() && outcome.metric("undercut_travel").unwrap().value <= 0.0, "{}", design.text);
        // Without friction the force is the one asked for.
        assert!((outcome.metric("force_mean").unwrap().value - 80.0).abs() < 1e-6);
    }
    let blocked = run(&asked("[\"40 mm\", \"420 mm\"]"));
    assert!(!blocked.met());
    let room = blocked.ways.iter().find(|w| w.relaxation.key == "synthesise.room").expect("the room blocks");
    assert!(room.confirmed, "{:?}", room.relaxation);
}

/// The area of the cam plate, by the trapezoidal rule over the exact profile in a thousand steps, and the distance of a brace's holes.
#[test]
fn parts_have_the_size_of_the_mechanism() {
    let loaded = load("no-undercut", text("no-undercut"), &[]);
    let exported = loaded.export("cam", &[Format::Dxf], &Options::default()).unwrap();
    let plate = |name: &str| exported.set.parts.iter().find(|p| p.name == name).and_then(Part::plate).unwrap();
    let brace = plate("brace");
    assert!((brace.holes[1].centre_m[0] - brace.holes[0].centre_m[0] - 0.2).abs() < 1e-15);
    let roller = plate("roller");
    assert!((roller.outline.area_m2() - std::f64::consts::PI * 0.016 * 0.016).abs() < 1e-15);
    // The plate is as wide at its top as the rollers leave: their centres less their radius along the normal.
    let inspection = exported.set.sheets.iter().find(|s| s.name == "inspection").unwrap();
    let top = inspection.rows.iter().rfind(|r| r[0] == "right").unwrap();
    let [x, y]: [f64; 2] = [top[2].parse().unwrap(), top[3].parse().unwrap()];
    let bounds = plate("cam").outline.bounds();
    assert!((1e3 * bounds.max_m[0] - x).abs() < 1e-3 && (1e3 * bounds.max_m[1] - y).abs() < 1e-3, "{bounds:?} {x} {y}");
    assert!(
        exported.files.iter().any(|(name, _)| name == "cam-inspection.csv")
            && exported.files.iter().any(|(name, _)| name == "cam-springs.csv")
    );
}
