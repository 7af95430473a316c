//! The whole grid, without any bound: what the search must find.

use forcewright_base::diagnostics::Diagnostics;
use forcewright_base::maths;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read::read;

use super::sizing::{Asked, Frame, Prepared, Size, arranged, distances, has_room, keeps_limits, last_between, search};
use super::{SKELETON, asked, ropes};
use crate::spec::Spec;

/// What a text asks for.
fn asked_of(requirements: &str) -> Asked {
    let text = format!("schema = 1\nmechanism = \"capstan\"\n{requirements}\n{}", SKELETON.sections);
    let mut project = Project::from_text("asked.toml", &text, &Choices::default());
    let mut spec: Spec = read(&project.tree, project.root, &mut project.diagnostics);
    let design = crate::design::resolve(&mut spec, &mut project.diagnostics);
    assert!(!project.diagnostics.has_errors(), "{:?}", project.diagnostics);
    let mut diagnostics = Diagnostics::default();
    let ropes = ropes(&spec, &mut diagnostics);
    asked(&spec, &design.expect("resolved"), ropes).expect("asked")
}

/// The smallest of each kind by looking at every combination, the smallest first.
fn brute(asked: &Asked) -> Vec<Size> {
    let mut all: Vec<Size> = Vec::new();
    for rope in 0..asked.ropes.len() {
        for cables in 1..=asked.most_cables {
            let mut best: Option<Size> = None;
            for turns in 0..=asked.most_turns {
                for (apart, per_radius) in distances(asked, turns) {
                    for input_m in &asked.inputs_m {
                        let frame = Frame { rope, cables, turns, apart, input_m: *input_m, distance_m: per_radius * input_m };
                        let found = every_preload(asked, &frame);
                        best = match (best, found) {
                            (Some(b), Some(f)) if f.cost_m3 >= b.cost_m3 => Some(b),
                            (b, f) => f.or(b),
                        };
                    }
                }
            }
            all.extend(best);
        }
    }
    all.sort_by(|a, b| a.cost_m3.total_cmp(&b.cost_m3));
    all
}

fn every_preload(asked: &Asked, frame: &Frame) -> Option<Size> {
    if !has_room(asked, frame) {
        return None;
    }
    let prepared = Prepared::new(asked, frame)?;
    let works = |n: &&f64| prepared.holds(asked, **n) && prepared.lasts(asked, **n);
    let working: Vec<f64> = asked.preloads_n.iter().filter(works).copied().collect();
    if working.is_empty() {
        return None;
    }
    // One cable has no neighbour, and its number of lines no meaning.
    let first = if frame.cables == 1 { last_between(asked, frame) } else { 1 };
    let (between, width_m) = (first..=last_between(asked, frame)).find_map(|q| Some((q, arranged(asked, frame, q)?)))?;
    if width_m > asked.envelope_m[1] {
        return None;
    }
    let (d, r, c) = (frame.distance_m, (1.0 + asked.ratio) * frame.input_m, asked.ropes[frame.rope].diameter_m);
    let cost_m3 = (d + r + c) * (2.0 * asked.ratio * frame.input_m + c) * width_m;
    let size = |preload_n: &f64| Size { frame: *frame, between, preload_n: *preload_n, width_m, cost_m3 };
    working.iter().map(size).find(|s| keeps_limits(asked, s))
}

const GRIDS: [&str; 4] = [
    // Stiffness decides.
    r#"
requirements = { torque = "10 N*m", stiffness = { min = "1500 N*m/rad" }, safety_factor = 3 }
[synthesise]
ratio = 5
travel = "180 deg"
friction = 0.15
constructions = ["7x19 stainless"]
cable_diameters = ["1 mm", "1.5 mm"]
input_diameters = ["20 mm", "27 mm", "36 mm"]
extra_turns_max = 2
cables_max = 3
"#,
    // Lost motion, a narrow envelope, an open belt.
    r#"
requirements = { torque = "4 N*m", lost_motion = { max = "0.05 deg" }, safety_factor = 4 }
[synthesise]
ratio = 3
travel = "90 deg"
friction = 0.2
belt = "open"
anchor_wrap = "400 deg"
envelope = { diameter = "200 mm", width = "80 mm", length = "500 mm" }
constructions = ["7x19 stainless"]
cable_diameters = ["0.8 mm", "1 mm", "1.5 mm"]
input_diameters = ["20 mm", "28 mm", "40 mm", "56 mm"]
extra_turns_max = 2
cables_max = 2
"#,
    // A ratio that is not whole, bedding in.
    r#"
requirements = { torque = "6 N*m", stiffness = { min = "800 N*m/rad" }, safety_factor = 2.5 }
[synthesise]
ratio = 4.03
travel = "120 deg"
friction = 0.12
groove = "v"
preload_loss = "20 %"
constructions = ["7x7 stainless", "7x19 stainless"]
cable_diameters = ["1 mm", "1.2 mm"]
input_diameters = ["22 mm", "30 mm", "36 mm", "50 mm"]
extra_turns_max = 2
cables_max = 2
"#,
    // Limits on metrics of both senses.
    r#"
requirements = { torque = "8 N*m", safety_factor = 3, limits = { shaft_load = { max = "900 N" }, gross_slip_torque_output = { min = "14 N*m" } } }
[synthesise]
ratio = 4
travel = "120 deg"
friction = 0.15
constructions = ["7x19 stainless"]
cable_diameters = ["1 mm", "1.5 mm"]
input_diameters = ["20 mm", "27 mm", "36 mm"]
extra_turns_max = 1
cables_max = 2
"#,
];

#[test]
fn pruned_is_the_whole_grid() {
    for text in GRIDS {
        let asked = asked_of(text);
        let all = brute(&asked);
        for most in [1, 3, 20] {
            let found = search(&asked, most);
            assert!(!found.cut && !found.sizes.is_empty(), "{text}");
            assert_eq!(found.sizes, all[..most.min(all.len())], "{most} of\n{text}");
        }
    }
}

/// What the bisection relies on, on places of the grids: once it holds it holds with more preload, and lasts no longer once it does not.
#[test]
fn more_preload_holds_and_less_lasts() {
    let mut seen = [false; 2];
    for text in GRIDS {
        let asked = asked_of(text);
        for (rope, input_m) in (0..asked.ropes.len()).zip(asked.inputs_m.iter().cycle()) {
            for turns in 0..=asked.most_turns {
                let Some((apart, per_radius)) = distances(&asked, turns).first().copied() else { continue };
                let frame = Frame { rope, cables: 1, turns, apart, input_m: *input_m, distance_m: per_radius * input_m };
                let Some(prepared) = Prepared::new(&asked, &frame) else { continue };
                let holds: Vec<bool> = asked.preloads_n.iter().map(|n| prepared.holds(&asked, *n)).collect();
                assert!(holds.is_sorted(), "{frame:?}");
                let held = |n: &&f64| prepared.state(&asked, **n).is_some();
                let lasts: Vec<bool> = asked.preloads_n.iter().filter(held).map(|n| !prepared.lasts(&asked, *n)).collect();
                assert!(lasts.is_sorted(), "{frame:?}");
                seen[0] |= holds.contains(&true) && holds.contains(&false);
                seen[1] |= lasts.contains(&true) && lasts.contains(&false);
                // A tangent is never above that of the spans.
                for (_, state) in asked.preloads_n.iter().filter_map(|n| prepared.state(&asked, *n)) {
                    let anchored = state.at_end.iter().flatten().any(|end| *end);
                    assert!(anchored || prepared.stiffness(&state) <= prepared.stiffness_bound() * (1.0 + 1e-12));
                }
            }
        }
    }
    assert_eq!(seen, [true; 2]);
}

/// All lengths twice, cables and torque to go with them: the same drive, twice as large.
#[test]
fn twice_as_large_is_twice_as_large() {
    let small = asked_of(GRIDS[0]);
    let mut large = small.clone();
    let scale = 2.0;
    large.inputs_m.iter_mut().for_each(|r| *r *= scale);
    large.preloads_n.iter_mut().for_each(|n| *n *= scale * scale);
    for rope in &mut large.ropes {
        rope.diameter_m *= scale;
        rope.axial_n *= scale * scale;
        rope.breaking_n *= scale * scale;
    }
    // Forces as the square, torques and stiffnesses as the cube.
    large.torque_nm *= maths::powi(scale, 3);
    large.stiffness_nm_per_rad *= maths::powi(scale, 3);
    let (one, other) = (search(&small, 4).sizes, search(&large, 4).sizes);
    assert_eq!(one.len(), other.len());
    for (a, b) in one.iter().zip(&other) {
        assert_eq!((a.frame.rope, a.frame.cables, a.frame.turns, a.between), (b.frame.rope, b.frame.cables, b.frame.turns, b.between));
        for (small, large) in [(a.frame.input_m * scale, b.frame.input_m), (a.preload_n * 4.0, b.preload_n), (a.cost_m3 * 8.0, b.cost_m3)] {
            assert!((large / small - 1.0).abs() < 1e-12, "{large} instead of {small}");
        }
    }
}

#[test]
fn faults_are_named() {
    let text = GRIDS[1].replace("7x19 stainless", "1x19 stainless");
    let text = format!("schema = 1\nmechanism = \"capstan\"\n{text}\n{}", SKELETON.sections);
    let mut project = Project::from_text("asked.toml", &text, &Choices::default());
    let mut spec: Spec = read(&project.tree, project.root, &mut project.diagnostics);
    let mut diagnostics = Diagnostics::default();
    ropes(&spec, &mut diagnostics);
    assert!(diagnostics.in_file_order().iter().any(|d| d.code == "E0721"));
    let design = crate::design::resolve(&mut spec, &mut Diagnostics::default()).expect("resolved");
    spec.synthesise.constructions = None;
    spec.synthesise.ratio = None;
    let mut diagnostics = Diagnostics::default();
    assert!(super::synthesiser(&spec, &design, &mut diagnostics).is_none());
    assert!(diagnostics.in_file_order().iter().any(|d| d.code == "E0720"));
    let mut warm = design.clone();
    warm.built.warmer_k = 5.0;
    let mut diagnostics = Diagnostics::default();
    assert!(super::synthesiser(&spec, &warm, &mut diagnostics).is_none());
    assert!(diagnostics.in_file_order().iter().any(|d| d.code == "E0722"));
}
