//! Studies of what the motor does, and of what scatters.

use forcewright_base::diagnostics::Diagnostics;
use forcewright_contract::family::{Entry, Family as _, Understood};
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::studies::{Free, Purpose};
use forcewright_lavt::Lavt;
use forcewright_study::evaluator::{Evaluation, Evaluator};

const HAND: &str = include_str!("../../../../examples/lavt/prosthetic-hand.toml");

const SEARCH: &str = r#"
[optimise]
objective = { minimise = "grasp_time" }
[optimise.variables]
"motor.reduction" = { range = [10, 40] }
"#;

fn understood(text: &str) -> Box<dyn Understood> {
    let mut project = Project::from_text("hand.toml", text, &Choices::default());
    let understood = Entry::<Lavt>::new().understand(&mut project);
    understood.unwrap_or_else(|| panic!("{:?}", project.diagnostics.in_file_order()))
}

fn free(understood: &dyn Understood, paths: &[&str]) -> Vec<Free> {
    let one = |path: &&str| {
        let number = understood.numbers().iter().find(|n| n.path == *path).unwrap_or_else(|| panic!("no `{path}`")).clone();
        Free { lower: 0.5 * number.si, upper: 2.0 * number.si, number }
    };
    paths.iter().map(one).collect()
}

struct Seen {
    evaluator: Box<dyn Evaluator>,
    x: Vec<f64>,
}

impl Seen {
    fn new(text: &str, paths: &[&str]) -> Self {
        let understood = understood(text);
        let mut said = Diagnostics::default();
        let evaluator = understood.evaluator(&free(&*understood, paths), &mut said);
        let evaluator = evaluator.unwrap_or_else(|| panic!("{:?}", said.in_file_order()));
        let x = evaluator.variables().iter().map(|v| v.nominal).collect();
        Self { evaluator, x }
    }

    fn at(&self, x: &[f64], derivatives: bool) -> Evaluation {
        let mut out = Evaluation::default();
        let mut room = self.evaluator.workspace();
        self.evaluator.evaluate(x, derivatives, &mut out, &mut room).unwrap_or_else(|failure| panic!("{}", failure.reason));
        out
    }

    fn place(&self, name: &str) -> usize {
        let outputs = self.evaluator.outputs();
        outputs.iter().find(|o| o.name == name).unwrap_or_else(|| panic!("no `{name}`")).values.start
    }
}

/// The constant of the motor and its reduction act as their product, the inertia with the square of the reduction, so that
/// N ∂/∂N = K ∂/∂K + 2 J ∂/∂J for everything that the hand does.
#[test]
fn derivatives_by_the_reduction_of_the_motor_obey_its_scaling() {
    let seen = Seen::new(HAND, &["motor.reduction", "motor.torque_constant", "motor.inertia"]);
    let found = seen.at(&seen.x, true);
    for name in ["closing_time", "grasp_time", "peak_current", "energy_per_grasp", "grasps_per_charge"] {
        let place = seen.place(name);
        let rows = &found.jacobian[3 * place..3 * place + 3];
        let [n, k, j] = [0, 1, 2].map(|i| seen.x[i] * rows[i] / found.values[place]);
        // Friction of the motor is a current, and its torque scales as the others.
        assert!((n - k - 2.0 * j).abs() < 2e-3 * n.abs().max(0.1), "{name}: {n} {k} {j}");
        assert!(n.abs() > 1e-3, "{name} does not depend on the reduction");
    }
}

/// Differences over a step of 10⁻⁶ are those over wide ones: the simulation is smooth enough for a search.
#[test]
fn derivatives_of_the_closing_are_no_noise() {
    let seen = Seen::new(HAND, &["motor.reduction"]);
    let found = seen.at(&seen.x, true);
    let wide = |h: f64| {
        let [up, down] = [1.0 + h, 1.0 - h].map(|part| seen.at(&[seen.x[0] * part], false));
        move |place: usize| (up.values[place] - down.values[place]) / (2.0 * h)
    };
    let (coarse, fine) = (wide(2e-3), wide(1e-3));
    for name in ["closing_time", "grasp_time", "peak_current", "energy_per_grasp", "grasps_per_charge", "stall_power", "motor_speed_max"] {
        let place = seen.place(name);
        let ours = found.jacobian[place] * seen.x[0];
        // Richardson: what is left of wide differences without their curvature.
        let theirs = (4.0 * fine(place) - coarse(place)) / 3.0;
        assert!((ours - theirs).abs() < 1e-2 * theirs.abs().max(0.1 * found.values[place].abs()), "{name}: {ours} {theirs}");
    }
}

/// A search over the reduction of the motor with an objective of the closing, under the limits of the file.
#[test]
fn a_search_may_choose_the_reduction_of_the_motor() {
    let understood = understood(&format!("{HAND}{SEARCH}"));
    let mut said = Diagnostics::default();
    let free = understood.studies().optimise.free(understood.numbers(), &mut said);
    assert_eq!(free.iter().map(|f| f.number.path.as_str()).collect::<Vec<_>>(), ["motor.reduction"]);
    let task = understood.task(&free, Purpose::Search, &mut said).unwrap_or_else(|| panic!("{:?}", said.in_file_order()));
    assert!(said.in_file_order().is_empty() && task.title.contains("grasp_time"), "{}", task.title);
    let limits: Vec<_> = task.limits.iter().map(|l| l.name.as_str()).collect();
    assert!(["closing_time", "peak_current", "output_torque_always", "grasp"].iter().all(|name| limits.contains(name)), "{limits:?}");
}

/// A study that draws hub and spring sees each draw as it is, not the worst corner about it.
#[test]
fn what_is_drawn_scatters_no_more() {
    let paths = ["design.spring.wire_diameter", "design.spring.inner_diameter", "design.hub.diameter", "design.bore.diameter"];
    let all = [&paths[..], &["design.friction.hub", "design.friction.bore"]].concat();
    let seen = Seen::new(HAND, &all);
    let found = seen.at(&seen.x, false).values;
    for [low, drawn] in [
        ["shift_margin_low", "shift_margin"],
        ["input_torque_held_low", "input_torque_held"],
        ["output_torque_max_low", "output_torque_max"],
        ["efficiency_max_low", "efficiency_max"],
        ["transition_torque_output_low", "transition_torque_output"],
        ["transition_torque_output_high", "transition_torque_output"],
    ] {
        assert_eq!(found[seen.place(low)].to_bits(), found[seen.place(drawn)].to_bits(), "{low}");
        // So it is asked of the draw alone.
        let measure = |name: &str| seen.evaluator.measures().iter().find(|m| m.name == name).unwrap_or_else(|| panic!("no {name}")).clone();
        assert!(measure(low).requirement.is_empty() && (drawn == "transition_torque_output" || !measure(drawn).requirement.is_empty()));
    }
    // What is not drawn does: the friction is then at its worst.
    let seen = Seen::new(HAND, &paths);
    let found = seen.at(&seen.x, false).values;
    assert!(found[seen.place("shift_margin_low")] < 0.99 * found[seen.place("shift_margin")]);
}

/// Every path of motor and hand that has a knob changes the closing.
#[test]
fn every_knob_of_the_motor_turns_something() {
    let understood = understood(&HAND.replace("efficiency = 0.85", "efficiency = 0.85\nmax_speed = \"12000 rpm\""));
    for number in understood.numbers().iter().filter(|n| n.path.starts_with("motor.")) {
        let mut said = Diagnostics::default();
        let free = [Free { number: number.clone(), lower: 0.9 * number.si, upper: 1.1 * number.si }];
        let Some(evaluator) = understood.evaluator(&free, &mut said) else {
            assert!(["supply", "ramp", "max_speed", "voltage", "charge"].iter().any(|key| number.path.ends_with(key)), "{}", number.path);
            continue;
        };
        let at = |x: f64| {
            let mut out = Evaluation::default();
            evaluator.evaluate(&[x], false, &mut out, &mut evaluator.workspace()).expect("closes");
            out.values
        };
        assert_ne!(at(number.si), at(0.93 * number.si), "{}", number.path);
    }
}
