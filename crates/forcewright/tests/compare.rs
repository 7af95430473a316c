//! Mechanisms of different families in one sheet.

use forcewright::model::{Action, CheckState};
use forcewright::{Choices, Comparison, Loaded, compare, gallery};

fn loaded(name: &str) -> (String, Loaded) {
    let file = format!("{name}.toml");
    let text = gallery::find(name).expect("in the gallery").text;
    let loaded = Loaded::from_text(&file, text, &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    (file, loaded)
}

fn sheet(names: &[&str], lever_m: Option<f64>) -> Comparison {
    let projects: Vec<_> = names.iter().map(|name| loaded(name)).collect();
    compare(&projects, lever_m, &mut |_| true)
}

fn text<'a>(rows: &'a [forcewright::MeasureRow], name: &str, at: usize) -> &'a str {
    &rows.iter().find(|r| r.name == name).expect("a row").texts[at]
}

/// Every family fills the sheet with what its own analysis says.
#[test]
fn the_sheet_says_what_the_analyses_say() {
    let names = ["compliant/lan-table3", "cam/sanchez-2-springs", "capstan/longval", "lavt/prosthetic-hand"];
    let found = sheet(&names, None);
    let metric = |at: usize, name: &str| {
        let (file, project) = loaded(names[at]);
        project.solve(&file, "", &mut |_| true).outcome.metric(name).expect("measured").value
    };
    let duty = |at: usize| found.mechanisms[at].duty.as_ref().expect("analysed");
    let near = |value: Option<f64>, wanted: f64| value.is_some_and(|v| (v / wanted - 1.0).abs() < 1e-12);
    // The band of Table 3 around 9.7 N.
    assert!(near(duty(0).range.value, metric(0, "band_end") - metric(0, "band_start")));
    let strength = duty(0).strength.value.expect("in the band");
    assert!((9.7 * 0.95..=9.7 * 1.05).contains(&strength));
    // Half of the band that the stretch fills: its ends are at the band's edges or at the extrema between.
    let spread = duty(0).variation.value.expect("in the band");
    assert!(spread > 0.0 && spread <= 0.05 / 0.95);
    // The paper's cam: a constant force, exactly, of which rolling takes a part.
    assert!(near(duty(1).strength.value, metric(1, "force_mean")) && duty(1).variation.value == Some(0.0));
    assert!(near(duty(1).loss.value, 1.0 - metric(1, "force_mean") / metric(1, "force_up_mean")));
    assert!(near(duty(2).stiffness.value, metric(2, "stiffness_tangent_output")) && duty(2).action == Action::Torque);
    assert!(near(duty(3).strength.value, metric(3, "output_torque_max")));
    assert!(duty(3).range.value.is_none() && duty(3).range.basis.contains("without end"));
    assert!(found.mixed() && found.cautions()[0].contains("--lever"));
    assert_eq!(found.requirements(), CheckState::Met);
}

/// A strip of 60 × 10 × 0.5 mm whose end goes down by 5 mm needs a box of 60.5 × 5.5 × 10 mm, half a thickness on every side; Table 3
/// that of its drawing.
#[test]
fn the_box_is_that_of_the_beams() {
    let sides = |name: &str| sheet(&[name], None).mechanisms[0].duty.as_ref().map(|d| d.box_m.clone()).expect("analysed");
    for (found, wanted) in sides("compliant/cantilever").into_iter().zip([60.5e-3, 5.5e-3, 10e-3]) {
        assert!((found - wanted).abs() < 1e-8, "{found} {wanted}");
    }
    let drawn = sides("compliant/lan-table3");
    assert!((drawn[0] - 71.1e-3).abs() < 0.2e-3 && (drawn[1] - 41.0e-3).abs() < 0.2e-3, "{drawn:?}");
}

/// Through a lever a torque cam is a constant-force mechanism: its force is τ/l, its travel θ l, the work the same; the curve too.
#[test]
fn a_lever_makes_one_kind_of_both() {
    let plain = sheet(&["cam/torque-cam", "cam/sanchez-2-springs"], None);
    let seen = sheet(&["cam/sanchez-2-springs", "cam/torque-cam"], Some(0.04));
    let (torque, force) = (plain.mechanisms[0].duty.as_ref().expect("analysed"), seen.mechanisms[1].duty.as_ref().expect("analysed"));
    assert_eq!((torque.action, force.action), (Action::Torque, Action::Force));
    let (t, f) = (torque.strength.value.expect("known"), force.strength.value.expect("known"));
    assert!((f * 0.04 / t - 1.0).abs() < 1e-14 && force.work == torque.work);
    // A constant torque: its work is torque × turn.
    assert!((torque.work.value.expect("known") / (t * torque.range.value.expect("known")) - 1.0).abs() < 1e-9);
    assert_eq!(force.box_m, torque.box_m);
    assert!(!seen.mixed());
    let mean = |found: &Comparison, at: usize| {
        let branch = &found.mechanisms[at].curve.as_ref().expect("a curve").branches[0];
        let area: f64 = branch.x.windows(2).zip(branch.y.windows(2)).map(|(x, y)| 0.5 * (x[1] - x[0]) * (y[0] + y[1])).sum();
        area
    };
    assert!((mean(&seen, 1) / mean(&plain, 0) - 1.0).abs() < 1e-12);
}

/// Pieces and mass are those of the parts: a layout around an axis has a plate per leg, two layers two plates and twice the mass of one, a
/// cam two rollers, braces and axles.
#[test]
fn pieces_are_counted() {
    let mut projects: Vec<_> = ["compliant/lan-circular", "compliant/lan-table3", "cam/sanchez-2-springs"].map(loaded).into();
    let layers = Choices { set: vec!["layout.series=2".to_owned()], ..Choices::default() };
    let text_of = gallery::find("compliant/lan-table3").expect("in the gallery").text;
    let two = Loaded::from_text("two.toml", text_of, &layers).map_err(|e| e.render(false)).expect("understood");
    projects.insert(2, ("two.toml".to_owned(), two));
    let found = compare(&projects, None, &mut |_| true);
    let rows = found.rows();
    assert_eq!([0, 1, 2, 3].map(|at| text(&rows, "pieces", at)), ["3", "1", "2", "7"]);
    // Rollers, braces and axles have no density in that file.
    assert!(text(&rows, "mass", 3).starts_with("≥ "), "{}", text(&rows, "mass", 3));
    let masses = [1, 2].map(|at| found.mechanisms[at].mass.value.expect("a density is known"));
    assert!((masses[1] / masses[0] - 2.0).abs() < 1e-12, "{masses:?}");
    assert!(found.mechanisms[0].duty.as_ref().expect("analysed").box_m.is_empty(), "legs around an axis have no box along the axes");
}

/// The document gives every number with its unit and what it is, the page names them all.
#[test]
fn page_and_document_agree() {
    let found = sheet(&["cam/sanchez-2-springs", "capstan/longval"], Some(0.1));
    let document = found.document();
    let first = &document["mechanisms"][0]["measures"];
    assert_eq!(first["strength"]["unit"], "N");
    assert_eq!(document["mechanisms"][1]["measures"]["strength"]["unit"], "N");
    assert!((document["lever"]["value"].as_f64().expect("a number") - 0.1).abs() < 1e-15);
    let page = found.page("forcewright compare a b");
    for row in found.rows() {
        assert!(page.contains(row.title), "{}", row.title);
        assert!(row.bases.iter().all(|basis| !basis.is_empty()), "{}: {:?}", row.name, row.bases);
    }
}
