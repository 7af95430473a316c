//! What a search keeps and what it tells: requirements over goals, more starts never worse than fewer, limits seen and unseen.
#![allow(clippy::unwrap_used, reason = "helpers of tests: what is not there fails the test")]

use std::path::Path;

use forcewright::model::CheckState;
use forcewright::{Choices, DiskFiles, Loaded, Optimised, Refused, SynthesisTask};

fn loaded(text: &str) -> Loaded {
    Loaded::from_text("a.toml", text, &Choices::default()).map_err(|e| e.render(false)).unwrap()
}

fn optimised(text: &str, starts: Option<u32>) -> Result<Optimised, Refused> {
    loaded(text).optimise(&DiskFiles, "a-optimised.toml".as_ref(), (starts, None), &|_| true)
}

fn missed(found: &Optimised) -> Vec<String> {
    let checks = &found.after.as_ref().unwrap().outcome.checks;
    checks.iter().filter(|c| c.required && c.state != CheckState::Met).map(|c| c.title.clone()).collect()
}

fn said(found: &Optimised, title: &str) -> String {
    found.verdict().into_iter().find(|s| s.title == title).map_or_else(String::new, |s| s.text)
}

/// What `synthesise` writes can be optimised as it is, and whatever the objective, the required force stays.
#[test]
fn the_required_force_is_kept_whatever_is_sought() {
    let asked = include_str!("../../../docs/book/gripper-pad.toml");
    let task = SynthesisTask::from_text("pad.toml", asked, &[]).map_err(|e| e.render(false)).unwrap();
    let found = task.run(Path::new("pad.toml"), &|_| true);
    assert!(found.met() && found.designs.len() == 2);
    for design in &found.designs {
        assert!(design.text.contains("maximise = \"band_ratio\""), "{}", design.file);
        let better = optimised(&design.text, None).map_err(|e| e.render(false)).unwrap();
        assert!(better.met(), "{}: {:?}", design.file, missed(&better));
        // The stress at inner faces is a limit of the search; what runs into pads is not, and that is told.
        let unseen: Vec<&str> = better.unseen.iter().map(String::as_str).collect();
        assert_eq!(unseen, ["pads"], "{}", design.file);
        assert!(said(&better, "Not seen by the search").contains("Distance to pads"));
        let warned = better.diagnostics.in_file_order();
        assert!(warned.len() == 1 && warned[0].code == "W0511" && warned[0].message.contains("`pads`"), "{warned:?}");
    }
    // The flattest stretch may have any level; the required stroke keeps its own.
    let text = &found.designs[0].text;
    for objective in
        ["maximise = \"flat_ratio\"", "minimise = \"stress_max\"", "minimise = \"force_deviation\", window = [\"9 mm\", \"13 mm\"]"]
    {
        let better = optimised(&text.replace("maximise = \"band_ratio\"", objective), None).map_err(|e| e.render(false)).unwrap();
        assert!(better.met(), "{objective}: {:?}", missed(&better));
    }
}

/// A two-speed transmission whose best designs lie where its clutch holds by next to nothing.
const FINGER: &str = r#"
schema = 1
mechanism = "lavt"
[requirements]
input_torque = "100 N*mm"
transition_torque = { min = "12 N*mm" }
output_torque = { min = "320 N*mm" }
speed_drop = { max = 5 }
efficiency = { min = "70 %" }
safety_factor = 1.2
[material.spring]
use = "EN 10270-1 SH"
[material.gears]
use = "POM-C"
[design.gears]
sun = 10
planet = 14
planets = 3
module = "0.5 mm"
face_width = "4 mm"
profile_shift = { sun = 0.415078763261, planet = 0.192232760489, ring = 0.799544284239 }
tip_shortening = { sun = 0.0773169580857, planet = 0.0773169580857, ring = 0 }
[design.spring]
wire_diameter = "0.9 mm ± 0.015 mm"
inner_diameter = "14.1 mm ± 0.05 mm"
hub_turns = 5.5
free_turns = 12
bore_turns = 6
[design.hub]
diameter = "15.4 mm h7"
[design.bore]
diameter = "16.8 mm H7"
[design.friction]
hub = "0.15 ± 0.03"
bore = "0.15 ± 0.03"
[optimise]
objective = { maximise = "output_torque_max" }
[optimise.variables]
"design.hub.diameter" = { range = ["15 mm", "15.8 mm"] }
"design.spring.wire_diameter" = { range = ["0.8 mm", "1 mm"] }
"#;

/// Where the bore holds the torque by a hair too little, there is no efficiency: the limit missed by a hair is moved, and all is met again.
/// The runs of more starts begin with those of fewer.
#[test]
fn more_starts_are_never_worse() {
    let mut before: Option<Optimised> = None;
    for starts in [1, 2, 3, 5, 9] {
        let found = optimised(FINGER, Some(starts)).map_err(|e| e.render(false)).unwrap();
        assert_eq!(missed(&found), [""; 0], "{starts} starts");
        if let Some(before) = before {
            let ends = |found: &Optimised| found.search.runs.iter().map(|r| r.x.clone()).collect::<Vec<_>>();
            assert_eq!(ends(&before), ends(&found)[..before.search.runs.len()], "{starts} starts");
        }
        before = Some(found);
    }
    let found = before.unwrap();
    assert!(found.tightened.iter().any(|(name, by, _)| name == "grips_always" && *by > 0.0), "{:?}", found.tightened);
    assert!(said(&found, "Starts").contains("led to designs that keep every limit"));
}

/// A guided strip that can never press as hard as it must.
fn strip(objective: &str, more: &str) -> String {
    format!(
        "schema = 1\nmechanism = \"compliant\"\n[requirements]\nlimits.force_at_end = {{ min = \"50 kN\" }}\n[material]\nuse = \"C75S\"\n\
         young_modulus = \"200 GPa\"\nyield_stress = \"600 MPa\"\n[design]\nthickness = \"5 mm\"\ndepth = \"10 mm\"\n\
         [design.nodes]\na = {{ at = [\"0 mm\", \"0 mm\"], support = \"clamped\" }}\n\
         b = {{ at = [\"100 mm\", \"0 mm\"], support = \"parallel\" }}\n[[design.beams]]\nname = \"strip\"\nbetween = [\"a\", \"b\"]\n\
         straight = true\n[load]\nnode = \"b\"\ndirection = [0, 1]\ntravel = \"0.1 mm\"\n[model]\nbeam = \"inextensible\"\n\
         [optimise]\nobjective = {{ {objective} }}\n{more}\n[optimise.variables]\n\
         \"design.thickness\" = {{ range = [\"1 mm\", \"8 mm\"] }}\n"
    )
}

/// A place misses a limit by as much as the verdict says, and the advice is of the search that was made.
#[test]
fn misses_are_told_relative_to_their_limits() {
    let global = "search = \"global\"\nevaluations = 200";
    let found = optimised(&strip("minimise = \"stress_max\"", global), None).map_err(|e| e.render(false)).unwrap();
    let check = found.after.as_ref().unwrap().outcome.checks.iter().find(|c| c.required && c.state == CheckState::Missed).unwrap();
    // F = E d w³ δ/L³ of the thickest: 102 N of 50 kN.
    let wanted = 1.0 - 200e9 * 0.01 * (0.008 * 0.008 * 0.008) * 1e-4 / 1e-3 / 50e3;
    assert!((-check.margin.unwrap() - wanted).abs() < 1e-3, "{:?} for {wanted}", check.margin);
    let (name, by) = found.place_misses[0].clone().unwrap();
    assert!(name == "force at the end" && (by - wanted).abs() < 1e-2, "{name} by {by} for {wanted}");
    let table = found.place_table().unwrap();
    assert!(table.rows[0][2] == "force at the end by 100 %", "{:?}", table.rows);
    let advice = said(&found, "Requirements");
    assert!(advice.contains("more `evaluations`, or another `seed`") && !advice.contains("more starts"), "{advice}");
    let found = optimised(&strip("minimise = \"stress_max\"", "starts = 2"), None).map_err(|e| e.render(false)).unwrap();
    assert!(said(&found, "Requirements").contains("more starts"));
}

/// Without `[optimise]` the advice is an objective that the family has.
#[test]
fn the_advice_is_of_the_family() {
    let of = |example: &str| {
        let text = forcewright::gallery::find(example).unwrap().text;
        let refused = optimised(text, None).err().unwrap();
        assert_eq!(refused.diagnostics.in_file_order()[0].code, "E0317");
        refused.render(false)
    };
    assert!(of("cantilever").contains("`forcewright new optimise-lan-box` has both"));
    let cam = of("sanchez-2-springs");
    assert!(cam.contains("`objective = { minimise = \"force_deviation\" }` (of cams with a slider)"), "{cam}");
    assert!(!cam.contains("flat_ratio") && !cam.contains("lan-box"), "{cam}");
    // Each one that a family names can be asked for, and stands in its reference.
    for family in forcewright::FAMILIES {
        let (table, all) = (family.parameter_table(), family.objectives());
        assert!(!all.is_empty() && all.iter().all(|o| !o.goals.is_empty()), "{}", family.id());
        for goal in all.iter().flat_map(|o| o.goals) {
            assert!(table.contains(&format!("| `{}` |", goal.name)) && table.contains(goal.doc), "{}: {}", family.id(), goal.name);
        }
    }
}

/// A design may meet its requirements and miss checks that nobody required: each is told.
#[test]
fn a_synthesis_tells_of_checks_that_its_designs_miss() {
    let asked = "schema = 1\nmechanism = \"lavt\"\n[requirements]\ninput_torque = \"100 N*mm\"\ntransition_torque = { min = \"12 N*mm\" }\n\
         output_torque = { min = \"320 N*mm\" }\nspeed_drop = { max = 5 }\nefficiency = { min = \"70 %\" }\nsafety_factor = 1.2\n\
         [material.spring]\nuse = \"EN 10270-1 SH\"\n[synthesise]\nfriction = \"0.15 ± 0.03\"\nmean_radius = { step = \"0.3 mm\" }\n\
         bore_gap = { step = \"0.1 mm\" }\nhub_turns = { step = 1 }\nbore_turns = { step = 1 }\n\
         envelope = { diameter = \"36 mm\", length = \"32 mm\" }\ncandidates = 2\n";
    let task = SynthesisTask::from_text("finger.toml", asked, &[]).map_err(|e| e.render(false)).unwrap();
    let found = task.run(Path::new("finger.toml"), &|_| true);
    assert!(found.met());
    let table = found.table();
    let column = table.columns.iter().position(|c| format!("{c:?}").contains("Checks missed")).unwrap();
    let text = found.verdict().into_iter().find(|s| s.title == "Beyond the requirements").unwrap().text;
    let mut all = 0;
    for (row, design) in table.rows.iter().zip(&found.designs) {
        let missed: Vec<_> = design.report.outcome.checks.iter().filter(|c| c.state == CheckState::Missed).collect();
        let codes: Vec<&str> = missed.iter().map(|c| c.code).collect();
        let wanted = if missed.is_empty() { "–".to_owned() } else { format!("{}: {}", missed.len(), codes.join(", ")) };
        assert_eq!(row[column], wanted, "{}", design.file);
        assert!(missed.iter().all(|c| !c.required && text.contains(c.code)), "{text}");
        all += missed.len();
    }
    assert!(all > 0 && text.contains("LAVT018"), "{text}");
    let document = found.document();
    let told: usize = document["study"]["designs"].as_array().unwrap().iter().map(|d| d["missed"].as_array().unwrap().len()).sum();
    assert_eq!(told, all);
    assert!(found.page("finger.toml", "").contains("Beyond the requirements"));
}
