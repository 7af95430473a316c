//! Goals of a search: curves from files, mass.

mod common;

use std::path::Path;

use common::{NODES, near};
use forcewright_base::diagnostics::Diagnostics;
use forcewright_base::maths;
use forcewright_compliant::Compliant;
use forcewright_contract::family::{Entry, Family, Understood};
use forcewright_contract::project::{Choices, FileError, Files, Project};
use forcewright_contract::studies::Purpose;
use forcewright_study::evaluator::Evaluation;
use forcewright_study::task::{Goal, Task};

/// Two leaves of the same length, one of them tapered, clamped at one end and moved as one at the other, of two materials.
const LEAVES: &str = r#"
schema = 1
mechanism = "compliant"
[material]
use = "POM-C"
[material.soft]
young_modulus = "1 GPa"
poisson_ratio = 0.4
yield_stress = "30 MPa"
density = "1000 kg/m^3"
[design]
thickness = "2 mm"
depth = "5 mm"
[design.nodes]
a = { at = ["0 mm", "0 mm"], support = "clamped" }
b = { at = ["0 mm", "20 mm"], support = "clamped" }
c = { at = ["40 mm", "10 mm"] }
d = { at = ["80 mm", "0 mm"] }
[[design.beams]]
name = "one"
between = ["a", "c"]
bend = [0.3, -0.2]
[[design.beams]]
name = "two"
between = ["b", "c"]
thickness = [["0", "2 mm"], ["0.25", "1 mm"], ["1", "3 mm"]]
straight = true
material = "soft"
[[design.beams]]
name = "three"
between = ["d", "c"]
thickness = "1.5 mm"
arc = "0.5 rad"
[load]
node = "d"
direction = [0, -1]
travel = "2 mm"
[optimise]
objective = { minimise = "mass" }
[optimise.variables]
"design.thickness" = { within = "0.5 mm" }
"design.depth" = { within = "1 mm" }
"design.nodes.*.at" = { within = "2 mm" }
"design.beams.one.bend" = { within = 0.2 }
"design.beams.two.thickness" = { within = "0.2 mm" }
"design.beams.three.thickness" = { within = "0.2 mm" }
"design.beams.three.arc" = { within = "0.2 rad" }
"#;

struct Memory<'a>(&'a [(&'a str, &'a str)]);

impl Files for Memory<'_> {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        self.0.iter().find(|(name, _)| Path::new(name) == path).map(|(_, text)| (*text).to_owned()).ok_or(FileError::NotFound)
    }
}

/// The first file, understood or refused.
fn understood(files: &[(&str, &str)]) -> (Option<Box<dyn Understood>>, Project) {
    let mut project = Project::load(&Memory(files), Path::new(files[0].0), &Choices::default());
    let found = Entry::<Compliant>::new().understand(&mut project);
    (found, project)
}

/// The search that a text asks for, or what was said: code, place, help.
fn task(text: &str, csv: &str) -> Result<Task, Vec<[String; 3]>> {
    let (found, project) = understood(&[("a.toml", text), ("wanted.csv", csv)]);
    let found = found.unwrap_or_else(|| panic!("{}", project.diagnostics.render(&project.sources, false)));
    let mut said = Diagnostics::default();
    let free = found.studies().optimise.free(found.numbers(), &mut said);
    let task = found.task(&free, Purpose::Search, &mut said);
    let lines = said.in_file_order().into_iter().map(|d| {
        let span = d.span.expect("a place");
        let source = project.sources.get(span.source).expect("a source");
        let (line, column) = project.sources.line_column(span).expect("inside");
        let place = format!("{}:{line}:{column} {}", source.name, &source.text[span.start..span.end]);
        [d.code.to_owned(), place, d.help.clone().unwrap_or_default()]
    });
    task.filter(|_| !said.has_errors()).ok_or_else(|| lines.collect())
}

/// Values and Jacobian at a design.
fn evaluated(task: &Task, x: &[f64]) -> Evaluation {
    let mut out = Evaluation::default();
    task.evaluator.evaluate(x, true, &mut out, &mut task.evaluator.workspace()).expect("a design with values");
    out
}

fn nominal(task: &Task) -> Vec<f64> {
    task.evaluator.variables().iter().map(|v| v.nominal).collect()
}

fn place_of_mass(task: &Task) -> usize {
    task.evaluator.outputs().iter().find(|o| o.name == "mass").expect("a mass").values.start
}

#[test]
fn mass_is_that_of_the_metric_and_of_the_closed_form() {
    let task = task(LEAVES, "").unwrap();
    let at = evaluated(&task, &nominal(&task)).values[place_of_mass(&task)];
    let metric = common::solve(LEAVES, &[]).get("mass");
    assert_eq!(at.to_bits(), metric.to_bits());
    // The straight leaf: mean thickness 0.25·1.5 + 0.75·2 = 1.875 mm; the arc is its angle over twice its half's sine times the chord.
    let length = maths::hypot(40e-3, 10e-3);
    let soft = 1000.0 * 1.875e-3 * 5e-3 * length;
    let arc = 1410.0 * 1.5e-3 * 5e-3 * length * 0.25 / maths::sin(0.25);
    let bent = common::design(LEAVES, &[]).network.beams[0].shape.length_m();
    near(at, soft + arc + 1410.0 * 2e-3 * 5e-3 * bent, 1e-12, "mass");
}

#[test]
fn copies_weigh_too() {
    let one = common::solve(NODES, &[]).get("mass");
    let section = "[optimise]\nobjective = { minimise = \"mass\" }\nvariables = { \"design.depth\" = { within = \"1 mm\" } }\n";
    let task = task(&format!("{NODES}\n{section}"), "").unwrap();
    let found = evaluated(&task, &nominal(&task));
    near(found.values[place_of_mass(&task)], one, 1e-15, "mass of the whole layout");
    let half = common::design(NODES, &[]);
    let drawn: f64 = half.network.beams.iter().map(|b| b.section.area_m2() * b.shape.length_m()).sum();
    near(one, 2.0 * 1410.0 * drawn, 1e-12, "two halves");
}

#[test]
fn derivatives_of_the_mass_are_right_for_every_number() {
    let task = task(LEAVES, "").unwrap();
    let (x, at) = (nominal(&task), place_of_mass(&task));
    let own = evaluated(&task, &x);
    let columns = x.len();
    // All kinds of numbers: 2 + 8 coordinates + 2 + 3 + 1 + 1.
    assert_eq!(columns, 17);
    for (column, variable) in task.evaluator.variables().iter().enumerate() {
        let h = 1e-3 * variable.scale();
        let moved = |times: f64| {
            let mut there = x.clone();
            there[column] += times * h;
            evaluated(&task, &there).values[at]
        };
        let differences = (8.0 * (moved(1.0) - moved(-1.0)) - (moved(2.0) - moved(-2.0))) / (12.0 * h);
        let exact = own.jacobian[at * columns + column];
        let scale = own.values[at] / variable.scale();
        assert!((exact - differences).abs() <= 1e-9 * scale, "{}: {exact} {differences}", variable.path);
        assert!(exact.abs() > 1e-4 * scale, "{} changes nothing", variable.path);
    }
}

#[test]
fn mass_needs_every_density() {
    let [code, place, help] = &task(&LEAVES.replace("density = \"1000 kg/m^3\"\n", ""), "").unwrap_err()[0];
    assert_eq!((code.as_str(), place.as_str()), ("E0302", "a.toml:38:26 \"mass\""));
    assert!(help.contains("density = ") && help.contains("[material.soft]"), "{help}");
    let large = task(&LEAVES.replace("minimise", "maximise"), "").unwrap_err();
    assert_eq!(large[0][0], "E0315");
}

#[test]
fn a_limit_on_the_mass_is_kept_by_the_search_and_checked() {
    let limited = format!("{}\n[requirements.limits]\nmass = {{ max = \"2 g\" }}\n", LEAVES.replace("\"mass\"", "\"stress_max\""));
    let task = task(&limited, "").unwrap();
    let limit = task.limits.iter().find(|l| l.key == "requirements.limits.mass").expect("a limit");
    assert_eq!((limit.values.start, limit.values.len(), limit.unit), (place_of_mass(&task), 1, "kg"));
    assert!((limit.upper - 2e-3).abs() < 1e-18 && limit.lower == f64::NEG_INFINITY);
    let check = |text: &str| {
        let outcome = common::outcome(text, &[]);
        let found = outcome.checks.iter().find(|c| c.name == "mass").expect("a check");
        (format!("{:?}", found.state), found.advice.clone().unwrap_or_default(), found.display.symbol().to_owned())
    };
    assert_eq!(check(&limited), ("Met".to_owned(), String::new(), "g".to_owned()));
    assert_eq!(check(&limited.replace("2 g", "1 g")).0, "Missed");
    // Without a density it is neither, and the search says that it does not see it.
    let unknown = limited.replace("density = \"1000 kg/m^3\"\n", "");
    let (state, advice, _) = check(&unknown);
    assert!(state == "NotAssessed" && advice.contains("density"), "{state} {advice}");
    let (found, _) = understood(&[("a.toml", &unknown)]);
    let found = found.unwrap();
    let mut said = Diagnostics::default();
    let free = found.studies().optimise.free(found.numbers(), &mut said);
    assert!(found.task(&free, Purpose::Search, &mut said).is_some());
    assert!(said.in_file_order().iter().any(|d| d.code == "W0511" && d.message.contains("`mass`")));
}

/// The leaves with a curve to come near to.
fn toward(curve: &str) -> String {
    LEAVES.replace("{ minimise = \"mass\" }", &format!("{{ minimise = \"force_target\", {curve} }}"))
}

#[test]
fn a_curve_from_a_file_is_the_curve_that_is_typed() {
    let typed = task(&toward("target = [[\"0.5 mm\", \"1 N\"], [\"2 mm\", \"3.5 N\"]]"), "").unwrap();
    for csv in ["travel / mm, force / N\n0.5, 1\n2, 3.5\n", "# at rest too\nx / cm; F / mN\n0; 0\n0.05; 1000\n0.2; 3500\n"] {
        let read = task(&toward("target_file = \"wanted.csv\""), csv).unwrap();
        assert_eq!(read.steps, typed.steps);
        let Goal::Squares { targets, .. } = &read.steps[0].goal else { panic!("{:?}", read.steps) };
        assert_eq!(targets, &[1.0, 3.5]);
        let values = |task: &Task| evaluated(task, &nominal(task)).values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(values(&read), values(&typed));
    }
}

#[test]
fn a_curve_that_is_none_is_refused_at_its_line_and_column() {
    let file = "target_file = \"wanted.csv\"";
    for (curve, csv, code, place) in [
        (file, "x / mm, F / N\n1, 2\n1, 3\n", "E0204", "wanted.csv:3:1 1"),
        (file, "x / mm, F / N\n1, 2\n0.5, 3\n", "E0204", "wanted.csv:3:1 0.5"),
        (file, "x / mm, F / N\n1, 2\n2.1, 3\n", "E0204", "wanted.csv:3:1 2.1"),
        (file, "x / mm, F / N\n-1, 2\n", "E0204", "wanted.csv:2:1 -1"),
        (file, "x / mm, F / N\n0, 0\n", "E0204", "wanted.csv:2:1 0"),
        (file, "x / N, F / N\n1, 2\n", "E0201", "wanted.csv:1:1 x / N"),
        (file, "x / mm, F / N\n1, two\n", "E0202", "wanted.csv:2:4 two"),
        (file, "x / mm\n1\n", "E0112", "wanted.csv:1:1 x / mm"),
        ("target = [[\"1 mm\", \"2 N\"]], target_file = \"wanted.csv\"", "", "E0305", "a.toml:39:"),
        ("target = [[\"1 mm\", \"2 N\"], [\"1 mm\", \"3 N\"]]", "", "E0204", "a.toml:39:"),
        ("target = [[\"1 mm\", \"2 N\", \"3 N\"]]", "", "E0204", "a.toml:39:"),
        ("target = [[[\"1 mm\", \"1 mm\"], \"2 N\"]]", "", "E0204", "a.toml:39:"),
        ("target = []", "", "E0204", "a.toml:39:"),
        ("target = 3", "", "E0204", "a.toml:39:"),
        ("", "", "E0302", "a.toml:39:1"),
    ] {
        let said = task(&toward(curve), csv).map(|_| ()).unwrap_err();
        let [found, at, help] = &said[0];
        assert!(found == code && at.starts_with(place) && !help.is_empty(), "{curve} {csv}: {said:?}");
    }
    let (found, project) = understood(&[("a.toml", &toward(file))]);
    assert!(found.is_none() && project.file_missing);
    assert_eq!(project.diagnostics.in_file_order()[0].code, "E0101");
}
