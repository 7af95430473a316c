//! Fronts against closed forms, and the design problem of Lan, Wang & Chen 2010 over its allowed stress.

use std::path::Path;
use std::sync::Mutex;

use forcewright::model::CheckState;
use forcewright::sweep::Axis;
use forcewright::{Choices, DiskFiles, Front, Loaded, Origin};

/// A strip clamped at one end and kept parallel at the other: with small deflections F = 12EIδ/L³ and σ = 6E(w/2)δ/L².
const GUIDED: &str = r#"
schema = 1
mechanism = "compliant"
title = "A guided strip"
requirements.stress = { safety_factor = 2 }
material = { use = "C75S", young_modulus = "200 GPa", yield_stress = "600 MPa" }
model.beam = "inextensible"
load = { node = "b", direction = [0, 1], travel = "0.1 mm" }
[design]
thickness = "0.5 mm"
depth = "10 mm"
nodes = { a = { at = ["0 mm", "0 mm"], support = "clamped" }, b = { at = ["100 mm", "0 mm"], support = "parallel" } }
beams = [{ name = "strip", between = ["a", "b"], straight = true }]
[optimise]
objective = { maximise = "force_at_end" }
variables = { "design.thickness" = { range = ["0.2 mm", "80 mm"] } }
margin = "0.01 %"
"#;

fn front_of(text: &str, spec: &str) -> Front {
    let loaded = Loaded::from_text("strip.toml", text, &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    let axis = Axis::parse(spec).expect("an axis");
    loaded.front(&DiskFiles, &axis, Path::new(""), (None, None), &|_| true).map_err(|e| e.render(false)).expect("a front")
}

/// `σ = 3Ewδ/L² = σ_y/S` at the best, so `w = σ_y·L²/(3·S·E·δ)` and `F = E·d·w³·δ/L³`: the force falls with the cube of S.
#[test]
fn the_force_falls_with_the_cube_of_the_safety_factor() {
    let front = front_of(GUIDED, "requirements.stress.safety_factor=1.5..6:4");
    let (e, l, d, travel) = (200e9, 0.1, 0.01, 1e-4);
    assert_eq!(front.points.iter().map(|p| p.value.as_str()).collect::<Vec<_>>(), ["1.5", "3", "4.5", "6"]);
    for point in &front.points {
        let width = (1.0 - 1e-4) * 600e6 * l * l / (3.0 * point.si * e * travel);
        let force = e * d * width * width * width * travel / (l * l * l);
        let found = point.goal().unwrap();
        assert!((found / force - 1.0).abs() < 1e-4, "{}: {found} {force}", point.value);
        assert_eq!(point.requirements(), CheckState::Met);
        assert!(point.found.text.as_ref().unwrap().contains(&format!("safety_factor = {}", point.value)));
    }
    // One design that follows its limit, and so the line of the figure is one.
    assert_eq!(front.groups(), [1; 4]);
    assert!(front.turns().is_empty() && !front.interrupted);
    let table = front.csv();
    let lines: Vec<&str> = table.split("\r\n").collect();
    assert!(lines[0].starts_with("point,requirements.stress.safety_factor,goal force_at_end / N,requirements,status,stop,from,group,"));
    assert!(lines[0].contains(",stress_max / Pa"), "{}", lines[0]);
    assert!(lines.len() == 6 && lines[2].starts_with("2,3,7") && lines[2].contains(",met,complete,converged,"), "{}", lines[2]);
}

/// A travel is no limit that only loosens: past the travel at which the range of the thickness ends, the force rises and falls with it.
#[test]
fn a_front_that_turns_is_called_so() {
    // F ∝ w³δ with w at its range's end while 3Ewδ/L² < σ, and ∝ δ⁻² beyond: the best travel is in the middle.
    let text = GUIDED.replace("\"80 mm\"", "\"20 mm\"");
    let front = front_of(&text, "load.travel=0.1mm,0.25mm,0.4mm");
    let goals: Vec<f64> = front.points.iter().filter_map(forcewright::FrontPoint::goal).collect();
    assert!(goals[1] > 1.5 * goals[0] && goals[1] > 1.5 * goals[2], "{goals:?}");
    assert_eq!(front.turns().len(), 1);
    assert!(front.verdict()[1].text.starts_with("Not monotone: from 0."), "{}", front.verdict()[1].text);
}

#[test]
fn interrupted_it_keeps_the_points_so_far() {
    let loaded = Loaded::from_text("strip.toml", GUIDED, &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    let axis = Axis::parse("requirements.stress.safety_factor=6,3,2").unwrap();
    let seen = Mutex::new(Vec::new());
    let watch = |progress: &forcewright::FrontProgress| {
        seen.lock().unwrap().push(progress.point);
        progress.point < 1
    };
    let front = loaded.front(&DiskFiles, &axis, Path::new(""), (None, None), &watch).map_err(|e| e.render(false)).expect("understood");
    assert!(front.interrupted && front.points.len() == 2 && front.asked == 3);
    assert_eq!(front.points[0].requirements(), CheckState::Met);
    assert_eq!(seen.into_inner().unwrap().last(), Some(&1));
    assert!(front.verdict().iter().any(|s| s.text.starts_with("2 of 3 points were searched for")));
}

/// From the tightest stress to the loosest, and the other way round: with either, no point is worse than one of a tighter limit.
#[test]
fn the_box_gets_better_with_the_stress_allowed() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/compliant/optimise-lan-box.toml");
    let loaded = Loaded::from_file(&DiskFiles, &path, &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    let axis = Axis::parse("requirements.stress.safety_factor=0.8,1.1,1.58").unwrap();
    let folder = path.parent().unwrap();
    let front = loaded.front(&DiskFiles, &axis, folder, (Some(1), None), &|_| true).map_err(|e| e.render(false)).expect("understood");
    let goals: Vec<f64> = front.points.iter().filter_map(forcewright::FrontPoint::goal).collect();
    assert!(front.turns().is_empty() && goals.len() == 3 && goals[0] > goals[1] && goals[1] > goals[2], "{goals:?}");
    assert!(goals[2] > 0.6, "{goals:?}");
    for point in &front.points {
        let text = point.found.text.as_ref().unwrap();
        let alone = Loaded::from_text(&point.file, text, &Choices::default()).map_err(|e| e.render(false)).expect("understood");
        let met = alone.solve(&point.file, "", &mut |_| true).outcome.requirements_met();
        assert_eq!(met, point.requirements() == CheckState::Met, "{}", point.value);
        assert!(matches!(point.origin, Origin::Start(0) | Origin::Point(_) | Origin::Taken(_)));
    }
}
