//! What studies see of torque cams: what the disc is cut for apart from what is built, limits, and searches.

use forcewright_base::diagnostics::Diagnostics;
use forcewright_cam::Cam;
use forcewright_contract::family::{Analysis, Entry, Family as _, Understood};
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::studies::{Free, Purpose};
use forcewright_study::evaluator::{Evaluation, Evaluator};

const EXAMPLE: &str = include_str!("../../../../examples/cam/torque-cam.toml");

fn understood(text: &str) -> Box<dyn Understood> {
    let mut project = Project::from_text("a.toml", text, &Choices::default());
    let found = Entry::<Cam>::new().understand(&mut project);
    found.unwrap_or_else(|| panic!("{:?}", project.diagnostics.in_file_order()))
}

fn analysed(text: &str) -> Analysis {
    understood(text).analyse(&mut |_| true)
}

/// The example with other friction.
fn with(built: &str, cut_for: &str) -> String {
    let text = EXAMPLE.replacen("rolling_friction = 0.002", built, 1).replacen("for_torque = ", &format!("{cut_for}\nfor_torque = "), 1);
    assert!(text.contains(built) && text.contains(cut_for));
    text
}

fn free(understood: &dyn Understood, path: &str, [lower, upper]: [f64; 2]) -> Free {
    let number = understood.numbers().iter().find(|n| n.path == path).unwrap_or_else(|| panic!("no `{path}`")).clone();
    Free { number, lower, upper }
}

fn metric(analysis: &Analysis, name: &str) -> f64 {
    analysis.outcome.metric(name).unwrap_or_else(|| panic!("no {name}")).value
}

/// The disc is cut for `for_guide_friction` and nothing else: torque up is then exact for guides as rough as that, and the disc stays
/// the same whatever the guides are.
#[test]
fn the_friction_that_is_built_is_not_what_the_disc_is_cut_for() {
    let wanted = metric(&analysed(&with("rolling_friction = 0", "")), "torque_mean");
    let exact = analysed(&with("rolling_friction = 0\nguide_friction = 0.05", "for_guide_friction = 0.05"));
    for name in ["torque_up_mean", "torque_up_max", "torque_up_min"] {
        assert!((metric(&exact, name) - wanted).abs() < 1e-9 * wanted, "{name}: {} {wanted}", metric(&exact, name));
    }
    let down = with("rolling_friction = 0\nguide_friction = 0.05", "compensate = \"down\"\nfor_guide_friction = 0.05");
    assert!((metric(&analysed(&down), "torque_down_mean") - wanted).abs() < 1e-9 * wanted);
    // What is built changes nothing of the disc.
    for built in ["", "guide_friction = 0.05", "guide_friction = 0.1"] {
        let other = analysed(&with(&format!("rolling_friction = 0\n{built}"), "for_guide_friction = 0.05"));
        for name in ["torque_mean", "disc_diameter", "path_curvature_radius_min", "spring_length_max"] {
            assert_eq!(metric(&other, name).to_bits(), metric(&exact, name).to_bits(), "{built} {name}");
        }
    }
    // Nor does friction of the guides that nobody compensated, beside that of the rollers.
    let rolling = |built: &str| metric(&analysed(&with(built, "for_friction = 0.002")), "disc_diameter").to_bits();
    assert_eq!(rolling("rolling_friction = 0.002"), rolling("rolling_friction = 0.002\nguide_friction = 0.1"));
}

/// A disc that friction locks is not told to turn further.
#[test]
fn advice_where_friction_locks() {
    let advice = |text: &str| {
        let checks = analysed(text).outcome.checks;
        checks.iter().find(|c| c.code == "CAM015").and_then(|c| c.advice.clone()).unwrap_or_else(|| panic!("CAM015 is kept"))
    };
    let start = advice(&with("rolling_friction = 0.5\nguide_friction = 0.5", ""));
    assert!(start.contains("friction locks the first"), "{start}");
    // A torque that rises faster than the force of the springs: the pressure angle grows.
    let rising = "for_torque_profile = [[\"0 deg\", \"0.5 N*m\"], [\"20 deg\", \"12 N*m\"], [\"120 deg\", \"12 N*m\"]]";
    let locked = advice(&with("rolling_friction = 0.5\nguide_friction = 0.5", "").replacen("for_torque = \"2 N*m\"", rising, 1));
    assert!(locked.contains("friction locks the disc") && !locked.contains("raise"), "{locked}");
    let short = advice(&EXAMPLE.replacen("turn = \"120 deg\"", "turn = \"130 deg\"", 1));
    assert!(short.contains("raise `design.turn`"), "{short}");
}

fn search(understood: &dyn Understood, free: &[Free], said: &mut Diagnostics) -> forcewright_study::task::Task {
    understood.task(free, Purpose::Search, said).unwrap_or_else(|| panic!("{:?}", said.in_file_order()))
}

fn values(evaluator: &dyn Evaluator, x: &[f64]) -> Result<Vec<f64>, String> {
    let mut out = Evaluation::default();
    evaluator.evaluate(x, false, &mut out, &mut evaluator.workspace()).map_err(|f| f.reason)?;
    Ok(out.values)
}

/// A value of a search is that of the analysis of the file with the same numbers: the disc is cut anew.
#[test]
fn a_search_cuts_the_disc_anew() {
    let objective = "\n[optimise]\nobjective = { minimise = \"disc_diameter\" }\n[optimise.variables]\n\"design.disc.start_radius\" = { range = [\"30 mm\", \"60 mm\"] }\n";
    let text = format!("{EXAMPLE}{objective}");
    let paths = ["design.disc.start_radius", "design.roller_diameter", "design.guide_friction"];
    let text = text.replacen("rolling_friction = 0.002", "rolling_friction = 0.002\nguide_friction = 0.01", 1);
    let understood = understood(&text);
    let all: Vec<Free> = paths.iter().zip([[0.03, 0.06], [0.01, 0.03], [0.0, 0.1]]).map(|(p, r)| free(&*understood, p, r)).collect();
    let mut said = Diagnostics::default();
    let task = search(&*understood, &all, &mut said);
    let x = [0.042, 0.018, 0.03];
    let found = values(&*task.evaluator, &x).expect("values");
    let changed = text
        .replacen("start_radius = \"40 mm\"", "start_radius = \"42 mm\"", 1)
        .replacen("roller_diameter = \"20 mm\"", "roller_diameter = \"18 mm\"", 1)
        .replacen("guide_friction = 0.01", "guide_friction = 0.03", 1);
    let solved = analysed(&changed);
    let mut seen = 0;
    for output in task.evaluator.outputs().iter().filter(|o| o.values.len() == 1) {
        let own = found[output.values.start];
        let other = metric(&solved, &output.name);
        assert!((own - other).abs() <= 2e-4 * other.abs(), "{}: {own} {other}", output.name);
        seen += 1;
    }
    assert!(seen > 15, "{seen}");
    // A synthesis is refused with a reason.
    assert!(understood.synthesiser(&mut said).is_none());
    assert_eq!(said.in_file_order().iter().map(|d| d.code).collect::<Vec<_>>(), ["E0616"]);
    // A start radius at which the rollers would meet is no design.
    let narrow = [0.0305, 0.064, 0.01];
    assert!(values(&*task.evaluator, &narrow).is_err());
}

/// What a limit says whose metric has no value: that friction locks, or that there is no motion, as it is. A search that cannot see it warns.
#[test]
fn a_value_that_is_missing_says_why() {
    let why = |text: &str| {
        let checks = analysed(text).outcome.checks;
        checks.iter().find(|c| c.name == "peak_torque_ratio").and_then(|c| c.advice.clone()).unwrap_or_else(|| panic!("it has a value"))
    };
    let rising = "for_torque_profile = [[\"0 deg\", \"0.5 N*m\"], [\"20 deg\", \"12 N*m\"], [\"120 deg\", \"12 N*m\"]]";
    let locked = why(&with("rolling_friction = 0.5\nguide_friction = 0.5", "").replacen("for_torque = \"2 N*m\"", rising, 1));
    assert!(locked.contains("friction locks the disc") && !locked.contains("motion"), "{locked}");
    let (still, _) = EXAMPLE.split_once("[motion]").expect("a table");
    assert!(why(still).contains("there is no motion"));
    let objective = "[optimise]\nobjective = { minimise = \"width\" }\n[optimise.variables]\n\"design.springs.rate\" = { range = [\"600 N/m\", \"800 N/m\"] }\n";
    let understood = understood(&format!("{still}{objective}"));
    let mut said = Diagnostics::default();
    let task = search(&*understood, &[free(&*understood, "design.springs.rate", [600.0, 800.0])], &mut said);
    assert_eq!(said.in_file_order().iter().map(|d| d.code).collect::<Vec<_>>(), ["W0610"]);
    assert!(task.limits.iter().all(|l| l.name != "peak_torque_ratio"));
}

/// What a requirement limits, a study sees: also metrics of the curves in a search, and what only the motion has.
#[test]
fn limits_on_any_metric_are_seen() {
    let limits = "torque_up_max = { max = \"9 N*m\" }, turn_speed_max = { max = \"50 rad/s\" }, hertz_pressure_max = { max = \"2 GPa\" }";
    let objective = "\n[optimise]\nobjective = { minimise = \"width\" }\n[optimise.variables]\n\"design.springs.rate\" = { range = [\"600 N/m\", \"800 N/m\"] }\n";
    let text = format!("{}{objective}", EXAMPLE.replacen("undercut_turn = ", &format!("{limits}, undercut_turn = "), 1));
    let understood = understood(&text);
    let all = [free(&*understood, "design.springs.rate", [600.0, 800.0])];
    let mut said = Diagnostics::default();
    let task = search(&*understood, &all, &mut said);
    let evaluator = understood.evaluator(&all, &mut said).expect("an evaluator");
    for name in ["torque_up_max", "turn_speed_max", "hertz_pressure_max", "hysteresis"] {
        let limit = task.limits.iter().find(|l| l.name == name);
        let measure = evaluator.measures().iter().find(|m| m.name == name).unwrap_or_else(|| panic!("{name}"));
        assert!(measure.requirement == name && measure.upper.is_finite(), "{measure:?}");
        let limit = limit.unwrap_or_else(|| panic!("{name} is not limited"));
        assert_eq!(task.evaluator.outputs().iter().find(|o| o.values == limit.values).map(|o| o.name.as_str()), Some(name));
    }
    assert!(said.in_file_order().is_empty(), "{:?}", said.in_file_order());
}

/// What the order sheet says of a turn of the screw is what the analysis says of it.
#[test]
fn a_turn_of_the_screw_on_the_order_sheet() {
    let with = |turns: f64| {
        let adjust = format!("count = 2\nadjust = {{ turns = {turns}, pitch = \"0.5 mm\" }}");
        EXAMPLE.replacen("count = 2", &adjust, 1).replacen("[\"2 deg\", \"120 deg\"]", "[\"59.99 deg\", \"60.01 deg\"]", 1)
    };
    let set = understood(&with(0.0)).parts().expect("parts");
    let sheet = set.sheets.iter().find(|s| s.name == "springs").expect("a sheet");
    let said: f64 = sheet.rows[1][7].parse().expect("a number");
    let [more, less] = [0.1, -0.1].map(|turns| metric(&analysed(&with(turns)), "torque_mean"));
    // Both springs are stretched at once.
    let found = (more - less) / 0.2 / 2.0;
    assert!((said / found - 1.0).abs() < 1e-4, "{said} N·m, {found} N·m");
    assert_eq!((sheet.rows.len(), sheet.rows[0][3].as_str()), (2, "80"));
}
