//! Every code of the project file, met with the real family: none is explained in vain, none is emitted without an explanation.

mod common;

use std::collections::BTreeSet;

use common::EXAMPLE;
use forcewright::{Choices, Loaded};

/// A change of the example (from, to) and the code that it brings.
const EDITS: &[(&str, &str, &str)] = &[
    ("E0101", "schema = 1", "schema = 1\nextends = \"none.toml\""),
    ("E0105", "depth = \"10 mm\"", "depth = \"10 mm"),
    ("E0106", "depth = \"10 mm\"", "depth = \"10 mm\"\ndepth = \"10 mm\""),
    ("E0107", "1.3092", "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["),
    ("E0108", "schema = 1", "schema = 1\nextends = \"a.toml\""),
    ("E0201", "\"10 mm\"", "\"10 N\""),
    ("E0202", "\"10 mm\"", "\"ten mm\""),
    ("E0203", "\"10 mm\"", "\"10 mmm\""),
    ("E0204", "\"10 mm\"", "\"-10 mm\""),
    ("E0205", "\"10 mm\"", "nan"),
    ("E0206", "\"10 mm\"", "true"),
    ("E0207", "± 0.02 mm", "± 0.02 N"),
    ("E0208", "\"10 mm\"", "10"),
    ("E0320", "\"10 mm\"", "\"10 mm h7\""),
    ("E0301", "depth = ", "depht = "),
    ("E0302", "depth = \"10 mm\"", ""),
    ("E0302", "bend = [1.3092, -1.5707]", ""),
    ("E0302", "use = \"POM-C\"", ""),
    ("E0302", "stress = { safety_factor = 1.5 }", "stress = {}"),
    ("E0303", "\"clamped\"", "\"clampt\""),
    ("E0304", "[\"n1\", \"n3\"]", "[\"n1\", \"n33\"]"),
    ("E0304", "bend = [1.3092, -1.5707]", "bend = [1.3092, -1.5707]\nhinged = \"n2\""),
    ("E0305", "bend = [1.3092, -1.5707]", "bend = [1.3092, -1.5707]\nstraight = true"),
    ("E0305", "{ safety_factor = 1.5 }", "{ safety_factor = 1.5, max = \"50 MPa\" }"),
    ("E0302", "travel = \"13.6 mm\"", ""),
    ("E0302", "direction = [0, -1]", ""),
    ("E0305", "travel = \"13.6 mm\"", "travel = \"13.6 mm\"\nforce = \"1 N\""),
    ("E0305", "travel = \"13.6 mm\"", "rotation = \"1 deg\""),
    ("E0306", "travel = \"13.6 mm\"", "moment = \"1 N*mm\""),
    ("E0307", "name = \"b2\"", "name = \"b1\""),
    ("E0308", "\"POM-C\"", "\"POM-X\""),
    ("E0309", "\"compliant\"", "\"complaint\""),
    ("E0311", "[\"n1\", \"n3\"]", "[\"n1\"]"),
    ("W0101", "[layout]", "[environment]\nx = 1\n[layout]"),
    ("E0501", "n3 = { at = [\"30.5 mm\", \"18.77 mm\"] }", "n3 = {}"),
    ("E0502", "[\"n1\", \"n3\"]", "[\"n3\", \"n3\"]"),
    ("E0502", "bend = [1.3092, -1.5707]", "angle = [1.0, 1.3, -1.5]\nlength = \"34 mm\""),
    ("E0503", "[\"34.5 mm\", \"0 mm\"]", "[\"30.5 mm\", \"18.77 mm\"]"),
    ("E0504", ", direction = [0, 1]", ""),
    ("E0505", ", support = \"slider\", direction = [0, 1]", ""),
    ("E0506", "direction = [0, 1]", "direction = [1, 0]"),
    ("E0507", "\"x = 0\"", "\"z = 0\""),
    ("E0508", "[0, -1]", "[0.1, -1]"),
    ("E0511", "[\"2.5 mm\", \"40 mm\"], support = \"slider\", direction = [0, 1] }", "[\"0 mm\", \"40 mm\"] }"),
    ("W0509", "[process]", "[material.spare]\nuse = \"POM-C\"\n[process]"),
    ("E0512", "[variants.paper]", "[model]\njoints = \"overlap\"\n[variants.paper]"),
    ("E0513", "[load]", "[[load]]\nnode = \"n5\"\ndirection = [0, -1]\ntravel = \"1 mm\"\n[[load]]"),
    ("E0514", "[design.nodes]", "[design.bodies]\nblock = { nodes = [\"n3\", \"n3\"] }\n[design.nodes]"),
    ("E0515", "[design.nodes]", "[design.bodies]\nblock = { nodes = [\"n1\", \"n2\"] }\n[design.nodes]"),
    ("E0510", "[design.nodes]", "[design.nodes]\nn9 = { at = [\"0 mm\", \"0 mm\"] }"),
];

/// Codes that no edit of a text can bring here, and where they are met instead.
const ELSEWHERE: &[(&str, &str)] = &[
    ("E0102", "bytes that are no text: tests of hostile files"),
    ("E0103", "a file too large: tests of hostile files"),
    ("E0104", "not a file: tests of hostile files"),
    ("E0110", "below, by a variant"),
    ("E0111", "below, by a setting"),
    ("E0126", "calls of compare: its tests"),
    ("E0130", "calls of sweep: tests of the library"),
    ("E0131", "calls of sweep: tests of the library"),
    ("E0132", "files of sweep: tests of the library"),
    ("E0133", "calls of sweep: tests of the library"),
    ("E0134", "calls of merge: tests of the library"),
    ("E0135", "files of sweep: tests of the library"),
    ("E0112", "tables of data beside the project: tests of goals"),
    ("E0209", "no parameter of the family is a diameter: tests of the reader"),
    ("E0312", "what studies ask: tests of their sections"),
    ("E0313", "what studies ask: tests of the family"),
    ("E0314", "what studies ask: tests of the family"),
    ("E0315", "what studies ask: tests of the family"),
    ("E0316", "what studies ask: tests of the family"),
    ("E0317", "what studies ask: tests of the library"),
    ("E0318", "what studies ask: tests of the library"),
    ("E0319", "the section of a study: tests of tolerance"),
    ("E0321", "the section of a study: tests of tolerance"),
    ("E0322", "the section of a study: tests of tolerance"),
    ("E0323", "the section of a study: tests of tolerance"),
    ("E0324", "a study without a beginning: tests of tolerance"),
    ("E0901", "a calibration: tests of calibrate"),
    ("E0902", "a calibration: tests of calibrate"),
    ("E0903", "a calibration: tests of calibrate"),
    ("E0904", "a calibration: tests of calibrate"),
    ("E0905", "a calibration: tests of calibrate"),
    ("E0906", "a calibration: tests of calibrate"),
    ("E0907", "a calibration: tests of calibrate"),
    ("E0908", "a calibration: tests of calibrate"),
    ("E0910", "a calibration: tests of calibrate"),
    ("E0911", "a calibration: tests of calibrate"),
    ("E0912", "a calibration: tests of calibrate"),
    ("W0908", "a calibration: tests of calibrate"),
    ("W0909", "a calibration: tests of calibrate"),
    ("W0910", "a calibration: tests of calibrate"),
    ("W0911", "a calibration: tests of calibrate"),
    ("W0901", "a calibration: tests of calibrate"),
    ("W0902", "a calibration: tests of calibrate"),
    ("W0903", "a calibration: tests of calibrate"),
    ("W0904", "a calibration: tests of calibrate"),
    ("W0905", "a calibration: tests of calibrate"),
    ("W0906", "a calibration: tests of calibrate"),
    ("W0907", "a calibration: tests of calibrate"),
    ("E0920", "the section of a study: tests of the library"),
    ("E0921", "the section of a study: tests of the library"),
    ("E0922", "the section of a study: tests of the library"),
    ("E0923", "the section of a study: tests of the library"),
    ("E0530", "what a synthesis needs: tests of the library"),
    ("E0531", "what a synthesis needs: tests of the library"),
    ("E0532", "what a synthesis needs: tests of the library"),
    ("E0533", "what a synthesis needs: every family has one"),
    ("W0530", "a warning of a synthesis: tests of the library"),
    ("E0516", "what copies need: tests of layouts"),
    ("E0517", "what copies need: tests of layouts"),
    ("E0518", "a design that is no part: tests of export"),
    ("E0519", "a fillet and its cutter: tests of export"),
    ("E0326", "a part that cannot be written: none is known"),
    ("E0327", "turned parts for finite elements: tests of export"),
    ("E0520", "a surface: tests of scenarios"),
    ("E0521", "a surface: tests of scenarios"),
    ("W0515", "a warning of the analysis: tests of layouts"),
    ("W0514", "a warning of the analysis: tests of layouts"),
    ("W0520", "a warning of the analysis: tests of scenarios"),
    ("W0521", "a warning of the analysis: tests of scenarios"),
    ("W0522", "a warning of the analysis: tests of scenarios"),
    ("W0523", "a warning of the analysis: tests of scenarios"),
    ("W0524", "a warning of the analysis: tests of lateral motions"),
    ("W0512", "a warning of the tolerance study"),
    ("W0513", "a warning of the tolerance study: tests of tolerance"),
    ("E0509", "what the engine refuses beyond the rules of the file: none is known that a file can reach"),
    ("W0501", "a warning of the analysis"),
    ("W0502", "a warning of the analysis"),
    ("W0503", "a warning of the analysis"),
    ("W0504", "a warning of the analysis"),
    ("W0505", "a warning of the analysis"),
    ("W0506", "a warning of the analysis"),
    ("W0508", "a warning of the analysis"),
    ("W0510", "a warning of the analysis"),
    ("W0511", "a warning of studies: tests of the family"),
    ("E0602", "a cam cut for friction that locks: none is known that a file reaches"),
    ("E0605", "a motion beyond the stroke: what motions need"),
    ("E0608", "a curve of a spring"),
    ("E0609", "a cam that cannot be drawn: none is known"),
    ("E0610", "what motions need"),
    ("E0611", "what motions need"),
    ("E0616", "a study: tests of the family"),
    ("E0630", "what a synthesis needs"),
    ("E0631", "what a synthesis needs"),
    ("E0632", "measured points: tests of the family"),
    ("E0720", "what a synthesis needs: tests of the family"),
    ("E0721", "what a synthesis needs: tests of the family"),
    ("E0722", "what a synthesis needs: tests of the family"),
    ("E0723", "what a synthesis needs: tests of the family"),
    ("W0601", "a warning of the analysis"),
    ("W0602", "a warning of the analysis"),
    ("W0603", "a warning of the analysis"),
    ("W0604", "a warning of the analysis"),
    ("W0605", "a warning of the analysis"),
    ("W0606", "a warning of the analysis"),
    ("W0608", "a warning of the analysis"),
    ("W0609", "a warning of the analysis"),
    ("W0610", "a warning of searches: tests of the family"),
    ("E0705", "cables of different preload: tests of the family"),
    ("E0708", "too many cables: tests of the family"),
    ("W0701", "a warning of the analysis"),
    ("W0702", "a warning of the analysis"),
    ("W0703", "a warning of the analysis"),
    ("W0704", "a warning of the analysis"),
    ("W0705", "a warning of the analysis"),
    ("W0706", "a warning of the analysis"),
    ("E0730", "a drum that cannot be turned: tests of the family"),
    ("E0731", "grooves on one stretch of a drum: tests of the family"),
    ("W0801", "the paper's model: a warning of the analysis"),
    ("W0802", "an analysis that depends on friction: a warning of the analysis"),
    ("W0803", "friction without a range: a warning of the analysis"),
    ("W0811", "a closing hand: tests of the family"),
    ("W0812", "a closing hand: tests of the family"),
    ("W0813", "a closing hand: tests of the family"),
    ("W0814", "a closing hand: tests of the family"),
    ("E0840", "what a synthesis needs: tests of the family"),
    ("E0841", "what a synthesis needs: tests of the family"),
    ("E0842", "what a synthesis needs: tests of the family"),
    ("E0843", "what a synthesis needs: tests of the family"),
    ("E0844", "what a synthesis needs: tests of the family"),
    ("E0845", "what a synthesis needs: tests of the family"),
    ("E0830", "a measured bench: tests of the family"),
    ("E0831", "a measured bench: tests of the family"),
    ("W0830", "a warning of the analysis"),
    ("E0820", "a gear that cannot be drawn: tests of the family"),
];

/// Edits of the cam example and the code that each must bring.
const CAM_EDITS: &[(&str, &str, &str)] = &[
    ("E0601", "stroke = \"230 mm\"\nrolling_arm", "stroke = \"2 m\"\nrolling_arm"),
    ("E0603", "for_start_length = \"143 mm\"", "for_start_length = \"120 mm\""),
    ("E0604", "for_force = \"50 N\"", "for_profile = [[\"10 mm\", \"40 N\"], [\"200 mm\", \"50 N\"]]"),
    ("E0606", "window = [\"5 mm\", \"230 mm\"]", "window = [\"5 mm\", \"500 mm\"]"),
    ("E0607", "roller_diameter = \"32 mm ± 0.01 mm\"", "roller_diameter = \"150 mm\""),
];

/// Edits of the torque cam and the code that each must bring.
const TORQUE_EDITS: &[(&str, &str, &str)] = &[
    ("E0613", "turn = \"120 deg\"\nrolling", "turn = \"120 deg\"\nbrace_length = \"200 mm\"\nrolling"),
    (
        "E0614",
        "roller_diameter = \"20 mm\"\ncam_thickness = \"10 mm\"\nturn = \"120 deg\"",
        "roller_diameter = \"33 mm\"\ncam_thickness = \"10 mm\"\nturn = \"170 deg\"",
    ),
    ("E0615", "shaft_diameter = \"12 mm\"", "shaft_diameter = \"60 mm\""),
];

/// Edits of the cable drive and the code that each must bring.
const CAPSTAN_EDITS: &[(&str, &str, &str)] = &[
    ("E0701", "centre_distance = \"65 mm\"", "centre_distance = \"59 mm\""),
    ("E0702", "seat_angle = \"150 deg\", ", ""),
    ("E0703", "steel 7x19 1.5 mm", "rope of hair 1.5 mm"),
    ("E0704", "lines = [0, 4]", "lines = [0, 5]"),
    ("E0706", "[inertia]", "[environment]\ntemperature_change = \"20 K\"\n[inertia]"),
    ("E0707", "travel = \"270 deg\"", "travel = \"300 deg\"\ninput_hold = \"fastened\""),
];

/// Edits of the two-speed transmission and the code that each must bring.
const LAVT_EDITS: &[(&str, &str, &str)] = &[
    ("E0801", "ring = 48", "ring = 60"),
    ("E0802", "planets = 3", "planets = 7"),
    ("E0803", "diameter = \"17.6 mm h7\"", "diameter = \"16 mm h7\""),
    ("E0804", "diameter = \"19.4 mm H7\"", "diameter = \"18 mm H7\""),
    ("E0805", "wire_diameter = \"1 mm ± 0.01 mm\"", "wire_diameter = \"6 mm\""),
    ("E0806", "EN 10270-1 SH", "hair of a horse"),
    ("E0807", "lever = \"130 mm\"", ""),
    ("E0808", "bore_turns = 3", "bore_turns = 9"),
];

/// The two-speed transmission.
const LAVT: &str = include_str!("../../../examples/lavt/butin-2.toml");

/// The cable drive.
const CAPSTAN: &str = include_str!("../../../examples/capstan/longval.toml");

/// The torque cam.
const TORQUE_CAM: &str = include_str!("../../../examples/cam/torque-cam.toml");

/// The cam example.
const CAM: &str = include_str!("../../../examples/cam/no-undercut.toml");

fn codes_of(text: &str, choices: &Choices) -> Vec<&'static str> {
    match Loaded::from_text("a.toml", text, choices) {
        Ok(loaded) => loaded.project.diagnostics.warnings().iter().map(|d| d.code).collect(),
        Err(refused) => {
            let shown = refused.render(false);
            for diagnostic in refused.diagnostics.in_file_order() {
                assert!(diagnostic.span.is_some(), "{} has no place:\n{shown}", diagnostic.code);
                assert!(diagnostic.help.as_ref().is_some_and(|h| !h.is_empty()), "{} has no help:\n{shown}", diagnostic.code);
            }
            refused.diagnostics.in_file_order().iter().map(|d| d.code).collect()
        }
    }
}

#[test]
fn every_code_is_met_and_every_code_met_is_explained() {
    let mut met = BTreeSet::new();
    let mut wrong = Vec::new();
    for (code, from, to) in EDITS {
        assert!(EXAMPLE.contains(from), "{from} is not in the example");
        let text = EXAMPLE.replacen(from, to, 1);
        // E0505: nothing may hold the network.
        let text = if *code == "E0505" { text.replace(", support = \"clamped\"", "") } else { text };
        // E0512: beams as thick as they are long.
        let text = if *code == "E0512" { text.replace("thickness = \"1 mm ± 0.02 mm\"", "thickness = \"16 mm\"") } else { text };
        let found = codes_of(&text, &Choices::default());
        if !found.contains(code) {
            wrong.push(format!("{code}: {to} brings {found:?}"));
        }
        met.extend(found);
    }
    let cams = CAM_EDITS.iter().map(|edit| (CAM, edit)).chain(TORQUE_EDITS.iter().map(|edit| (TORQUE_CAM, edit)));
    let drives = CAPSTAN_EDITS.iter().map(|edit| (CAPSTAN, edit)).chain(LAVT_EDITS.iter().map(|edit| (LAVT, edit)));
    for (example, (code, from, to)) in cams.chain(drives) {
        assert!(example.contains(from), "{from} is not in the example");
        let found = codes_of(&example.replacen(from, to, 1), &Choices::default());
        if !found.contains(code) {
            wrong.push(format!("{code}: {to} brings {found:?}"));
        }
        met.extend(found);
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    let none = Choices { variant: Some("none".to_owned()), set: vec!["none".to_owned()] };
    assert_eq!(codes_of(EXAMPLE, &none), ["E0110", "E0111"]);
    let known: BTreeSet<&str> = forcewright::explanations().map(|e| e.code).collect();
    for code in &met {
        assert!(known.contains(code), "{code} is not explained");
    }
    for code in known.iter().filter(|c| c.starts_with('E') || c.starts_with('W')) {
        let elsewhere = ELSEWHERE.iter().any(|(c, _)| c == code);
        assert!(met.contains(code) != elsewhere, "{code} is never met, or is met although it is listed as an exception");
    }
}

#[test]
fn explanations_are_complete_and_unique() {
    let codes: Vec<&str> = forcewright::explanations().map(|e| e.code).collect();
    let unique: BTreeSet<&str> = codes.iter().copied().collect();
    assert_eq!(codes.len(), unique.len());
    assert!(forcewright::explanations().all(|e| !e.title.is_empty() && e.text.len() > 20));
}
