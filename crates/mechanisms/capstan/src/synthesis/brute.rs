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
            let found = search(&asked, most, &|_| true);
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
    let (one, other) = (search(&small, 4, &|_| true).sizes, search(&large, 4, &|_| true).sizes);
    assert_eq!(one.len(), other.len());
    for (a, b) in one.iter().zip(&other) {
        assert_eq!((a.frame.rope, a.frame.cables, a.frame.turns, a.between), (b.frame.rope, b.frame.cables, b.frame.turns, b.between));
        for (small, large) in [(a.frame.input_m * scale, b.frame.input_m), (a.preload_n * 4.0, b.preload_n), (a.cost_m3 * 8.0, b.cost_m3)] {
            assert!((large / small - 1.0).abs() < 1e-12, "{large} instead of {small}");
        }
    }
}

/// What was found until an interruption is kept, and what is told of the way grows from 0 to 1.
#[test]
fn a_search_can_be_interrupted() {
    let asked = asked_of(GRIDS[0]);
    let seen = std::sync::Mutex::new(Vec::new());
    let whole = search(&asked, 20, &|part| {
        seen.lock().expect("one thread").push(part);
        true
    });
    let seen = seen.into_inner().expect("one thread");
    assert!(!whole.interrupted && seen.is_sorted() && seen.iter().all(|p| (0.0..=1.0).contains(p)) && seen.len() > 50, "{seen:?}");
    let mut kept = Vec::new();
    for most in [0, seen.len() / 2, seen.len() - 1] {
        let left = std::sync::atomic::AtomicUsize::new(most);
        let found = search(&asked, 20, &|_| {
            left.fetch_update(std::sync::atomic::Ordering::Relaxed, std::sync::atomic::Ordering::Relaxed, |n| n.checked_sub(1)).is_ok()
        });
        assert!(found.interrupted);
        assert!(found.sizes.iter().filter(|s| whole.sizes.contains(s)).count() + 1 >= found.sizes.len());
        kept.push(found.sizes.len());
    }
    assert!(kept.is_sorted() && kept[0] == 0 && kept[1] > 0, "{kept:?}");
    assert_eq!(super::limits::factor(&asked, super::Knob::Stiffness, &|_| false), None);
}

/// A limit that no design can have a value of is refused at once, with what is missing; with that it is searched.
#[test]
fn limits_without_a_value_are_refused() {
    let codes = |limit: &str, more: &str| {
        let text = GRIDS[3].replace("shaft_load = { max = \"900 N\" }", limit);
        let text = format!("schema = 1\nmechanism = \"capstan\"\n{text}\n{more}\n{}", SKELETON.sections);
        let mut project = Project::from_text("asked.toml", &text, &Choices::default());
        let mut spec: Spec = read(&project.tree, project.root, &mut project.diagnostics);
        let design = crate::design::resolve(&mut spec, &mut project.diagnostics).expect("resolved");
        let mut diagnostics = Diagnostics::default();
        let there = super::synthesiser(&spec, &design, &mut diagnostics).is_some();
        let said: Vec<(&str, String)> = diagnostics.in_file_order().iter().map(|d| (d.code, d.help.clone().unwrap_or_default())).collect();
        assert_eq!(there, said.is_empty(), "{said:?}");
        said
    };
    let backdrive = "backdrive_torque_output = { max = \"1 N*m\" }";
    let [(code, help)] = &codes(backdrive, "")[..] else { panic!("one error") };
    assert_eq!(*code, "E0723");
    for key in ["friction", "input_bore", "output_bore"] {
        assert!(help.contains(&format!("synthesise.bearings.{key}")), "{help}");
    }
    assert!(help.contains("synthesise.bending_loss"), "{help}");
    let known = "bending_loss = \"0.5 %\"\nbearings = { friction = 0.0015, input_bore = \"8 mm\", output_bore = \"15 mm\" }";
    assert!(codes(backdrive, known).is_empty());
    let inertia = "reflected_inertia_output = { max = \"1 kg*m^2\" }";
    assert!(matches!(&codes(inertia, "")[..], [("E0723", help)] if help.contains("inertia.input, inertia.output")));
    assert!(codes(inertia, "[inertia]\ninput = \"1e-5 kg*m^2\"\noutput = \"1e-3 kg*m^2\"").is_empty());
    let frequency = "torsional_frequency = { min = \"1 Hz\" }";
    assert!(matches!(&codes(frequency, "")[..], [("E0723", help)] if help.contains("inertia.output") && !help.contains("inertia.input")));
    // The catalogue knows the wires of steel cables: this one has a value, in the search as in the files.
    assert!(codes("wire_bending_stress = { max = \"900 MPa\" }", "").is_empty());
    let asked = asked_of(&GRIDS[3].replace("shaft_load = { max = \"900 N\" }", "wire_bending_stress = { max = \"900 MPa\" }"));
    assert!(!search(&asked, 1, &|_| true).sizes.is_empty());
}

/// The whole envelope stands in the files as limits that an analysis tests.
#[test]
fn envelopes_are_limits_of_the_files() {
    let asked = asked_of(GRIDS[1]);
    let found = search(&asked, 1, &|_| true);
    let proposals = super::written(&asked, &found.sizes);
    let settings = &proposals[0].settings;
    for (name, side) in [
        ("output_drum_diameter", "200 mm"),
        ("input_drum_length", "80 mm"),
        ("output_drum_length", "80 mm"),
        ("length_over_drums", "500 mm"),
    ] {
        assert!(settings.contains(&format!("requirements.limits.{name}.max=\"{side}\"")), "{settings:?}");
    }
    // The metrics are what the search bounds.
    let design = asked.design(&found.sizes[0]);
    let measured = crate::measure(&design, &crate::Behaviour::of(&design).expect("a drive"));
    let [length_m, diameter_m] = super::sizing::length_and_diameter(&asked, &found.sizes[0].frame);
    for (name, by_search) in [("length_over_drums", length_m), ("output_drum_diameter", diameter_m)] {
        assert!((measured.get(name).expect("a metric") - by_search).abs() < 1e-12, "{name}");
    }
}

/// On a grid that is looked at in full, the set is what every drive with its least and largest preload leaves when the dominated go.
#[test]
fn the_front_is_that_of_the_whole_grid() {
    for (text, backwards) in [(GRIDS[0], false), (GRIDS[0], true), (GRIDS[2], false), (GRIDS[2], true)] {
        let mut asked = asked_of(text);
        if backwards {
            // The large drums first, so that the small ones drive them out.
            asked.inputs_m.reverse();
            asked.ropes.reverse();
        }
        let front = super::front::front(&asked, &[], &|_| true);
        assert!(!front.cut && front.members.len() > 3, "{}", front.members.len());
        let mut all = Vec::new();
        for rope in 0..asked.ropes.len() {
            for cables in 1..=asked.most_cables {
                for turns in 0..=asked.most_turns {
                    for (apart, per_radius) in distances(&asked, turns).into_iter().take(3) {
                        for input_m in &asked.inputs_m {
                            let frame = Frame { rope, cables, turns, apart, input_m: *input_m, distance_m: per_radius * input_m };
                            if !has_room(&asked, &frame) {
                                continue;
                            }
                            let prepared = Prepared::new(&asked, &frame).expect("known");
                            let works = |n: &&f64| prepared.holds(&asked, **n) && prepared.lasts(&asked, **n);
                            let working: Vec<f64> = asked.preloads_n.iter().filter(works).copied().collect();
                            let last = last_between(&asked, &frame);
                            let place = (if cables == 1 { last } else { 1 }..=last).find_map(|q| Some((q, arranged(&asked, &frame, q)?)));
                            let (Some((between, width_m)), [first, .., last]) =
                                (place, &[&working[..1.min(working.len())], &working[..]].concat()[..])
                            else {
                                continue;
                            };
                            for preload_n in [*first, *last] {
                                let size = Size { frame, between, preload_n, width_m, cost_m3: 0.0 };
                                all.push(super::merits(&asked, &size).expect("held"));
                            }
                        }
                    }
                }
            }
        }
        let kept: Vec<_> = all.iter().filter(|m| !all.iter().any(|other| other.dominates(m))).collect();
        for (_, m) in &front.members {
            assert!(kept.contains(&m), "{m:?}");
        }
        for k in kept {
            assert!(front.members.iter().any(|(_, m)| m.covers(k)), "{k:?}");
        }
        // The table has the ends of the set.
        let table = super::front::table(&asked, &front);
        assert!(table.rows.len() >= 3.min(front.members.len()) && table.rows.iter().all(|r| r.len() == table.columns.len()));
    }
}

#[test]
fn no_wrap_before_the_anchors_is_refused() {
    let text = GRIDS[1].replace("400 deg", "0 deg");
    let text = format!("schema = 1\nmechanism = \"capstan\"\n{text}\n{}", SKELETON.sections);
    let mut project = Project::from_text("asked.toml", &text, &Choices::default());
    let _: Spec = read(&project.tree, project.root, &mut project.diagnostics);
    let said: Vec<String> = project.diagnostics.in_file_order().iter().map(|d| format!("{} {:?}", d.code, d.help)).collect();
    assert!(matches!(&said[..], [one] if one.starts_with("E0204") && one.contains("slip")), "{said:?}");
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
