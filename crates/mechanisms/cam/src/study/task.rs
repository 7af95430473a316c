//! From `[optimise]` and the requirements to a search: its goal and its limits.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::quadrature::simpson_weight;
use forcewright_contract::describe::Section;
use forcewright_contract::objective::{Goal, Way, goal_of};
use forcewright_contract::studies::Objective;
use forcewright_study::evaluator::Evaluator;
use forcewright_study::task::{self, Band, Limit, Step, Task};

use super::many::STATIONS;
use crate::design::Requirements;
use crate::metrics::METRICS;

/// What the curve of a search is made of: a force over a travel, or a torque over a turn.
pub(crate) struct Words {
    /// Before `_deviation`, `_spread`; also the requirement.
    quantity: &'static str,
    unit: &'static str,
    pub(crate) goals: &'static [Goal],
    /// Advice for an objective that has keys of its own.
    elsewhere: &'static str,
    /// Advice where nothing is required.
    missing: &'static str,
}

/// A cam with a slider.
pub(crate) const FORCE: Words = Words {
    quantity: "force",
    unit: "N",
    goals: &[
        small("force_deviation", "largest distance of the force, up or down, from what is required"),
        small("force_spread", "half width of the band that the force needs, up and down, its level free"),
        small("hysteresis", "mean up − mean down over the mean"),
        small("spring_length_max", "largest length of the springs"),
        small("width", "largest width over the stroke"),
        small("height", "height over the stroke"),
        small("cam_length", "extent of the cam along the travel"),
        small("contact_force_max", "largest force between roller and cam"),
        small("hertz_pressure_max", "largest pressure between roller and cam"),
        small("pressure_angle_max", "largest pressure angle"),
        small("peak_force_ratio", "largest force in the motion over that at rest"),
        small("energy_lost", "work lost over the motion"),
        small("time_to_end", "time that the released slider takes to a stop"),
        small("moving_mass", "mass of what moves"),
    ],
    elsewhere: "remove it; the window is `requirements.window`, the wanted force `requirements.profile`",
    missing: "give `requirements.force`, or minimise `force_spread`",
};

/// A torque cam.
pub(crate) const TORQUE: Words = Words {
    quantity: "torque",
    unit: "N*m",
    goals: &[
        small("torque_deviation", "largest distance of the torque, up or down, from what is required"),
        small("torque_spread", "half width of the band that the torque needs, up and down, its level free"),
        small("hysteresis", "mean up − mean down over the mean"),
        small("spring_length_max", "largest length of the springs"),
        small("width", "largest width over the turn"),
        small("disc_diameter", "diameter of the circle that holds the disc or the ring"),
        small("contact_force_max", "largest force between roller and cam"),
        small("hertz_pressure_max", "largest pressure between roller and cam"),
        small("guide_force_max", "largest force across a guide"),
        small("pressure_angle_max", "largest pressure angle"),
        small("peak_torque_ratio", "largest torque in the motion over that at rest"),
        small("moving_mass", "mass of followers, rollers and springs"),
    ],
    elsewhere: "remove it; the window is `requirements.turn_window`, the wanted torque `requirements.torque_profile`",
    missing: "give `requirements.torque`, or minimise `torque_spread`",
};

const fn small(name: &'static str, doc: &'static str) -> Goal {
    Goal { name, doc, way: Way::Small }
}

/// Builds the task of an evaluator whose first values are the curves up, down and without friction at [`STATIONS`] places, where `wanted` is
/// asked for; what is wrong with the objective is reported.
pub(crate) fn task(
    evaluator: Box<dyn Evaluator>,
    (words, wanted): (&'static Words, &[f64]),
    requirements: Option<&Requirements>,
    objective: &Section<Objective>,
    diagnostics: &mut Diagnostics,
) -> Option<Task> {
    let (name, _) = goal_of(objective, words.goals, diagnostics)?;
    for (span, what) in [(objective.window.as_ref().map(|w| w.span), "window"), (objective.target.as_ref().map(|t| t.span), "target")] {
        if let Some(span) = span {
            let error = Diagnostic::error("E0305", span, format!("the objectives of cams have no `{what}`")).label("not needed");
            diagnostics.push(error.help(words.elsewhere));
            return None;
        }
    }
    let place = objective.minimise.as_ref().map(|m| m.span).unwrap_or_default();
    let posed = Posed { words, wanted, evaluator: evaluator.as_ref() };
    let required = requirements.and_then(|r| r.force.as_ref()).is_some();
    let lacks = if name.ends_with("_deviation") {
        (!required).then(|| (format!("a {} that is required", words.quantity), words.missing))
    } else {
        let follows = name == "hysteresis" || name.ends_with("_spread") || posed.place(name).is_some();
        (!follows).then(|| ("what the design does not give".to_owned(), "analyse it with `solve`, which says why it has no such value"))
    };
    if let Some((what, help)) = lacks {
        diagnostics.push(Diagnostic::error("E0302", place, format!("`{name}` needs {what}")).label("this objective").help(help));
        return None;
    }
    for limit in requirements.iter().flat_map(|r| &r.limits).map(|l| METRICS[l.metric].name) {
        if !evaluator.measures().iter().any(|m| m.name == limit) {
            let message = format!("the search does not see `{limit}`, which the design does not have; it is checked at the end");
            diagnostics.push(Diagnostic::warning("W0610", place, message).label("of this search"));
        }
    }
    let limits = posed.limits(name);
    let (goal, bands) = posed.goal(name);
    let title = format!("`{name}` as small as possible");
    Some(Task { evaluator, title, steps: vec![Step { goal, bands, held: Vec::new() }], limits, sought: sought(name) })
}

/// Requirements with checks of their own.
const REQUIREMENTS: [&str; 7] = ["force", "torque", "hysteresis", "spring_length", "spring_solid", "contact", "contact_motion"];

/// The requirement that a goal itself is about.
fn sought(name: &'static str) -> Vec<&'static str> {
    let typed = match name {
        "force_deviation" => "force",
        "torque_deviation" => "torque",
        "spring_length_max" => "spring_length",
        other => other,
    };
    if typed == name { vec![name] } else { vec![name, typed] }
}

/// A search that is being posed.
struct Posed<'a> {
    words: &'static Words,
    wanted: &'a [f64],
    evaluator: &'a dyn Evaluator,
}

/// What is a large change of a metric, SI.
fn scale_of(name: &str) -> f64 {
    match METRICS.iter().find(|m| m.name == name).map(|m| m.dimension.si_symbol()) {
        Some("m") => 0.1,
        Some("N") => 50.0,
        Some("Pa") => 1e8,
        Some("N/m") => 1e3,
        _ => 1.0,
    }
}

impl Posed<'_> {
    /// Where a metric stands among the values.
    fn place(&self, name: &str) -> Option<usize> {
        self.evaluator.outputs().iter().find(|o| o.name == name && o.values.len() == 1).map(|o| o.values.start)
    }

    fn goal(&self, name: &str) -> (task::Goal, Vec<Band>) {
        let band = |values, level| Band { values, level, half_width: None, checks: Vec::new() };
        let both = |level: Option<f64>| [0, 1].map(|i| band(i * STATIONS..(i + 1) * STATIONS, level)).to_vec();
        let wanted = self.wanted;
        let mean = wanted.iter().sum::<f64>() / wanted.len() as f64;
        match name {
            "force_deviation" | "torque_deviation" if wanted.iter().all(|w| w.to_bits() == wanted[0].to_bits()) => {
                (task::Goal::HalfWidth, both(Some(wanted[0])))
            }
            // Without one level: squares, each relative to what is wanted there.
            "force_deviation" | "torque_deviation" => {
                let targets = wanted.iter().chain(wanted).copied().collect();
                (task::Goal::Squares { values: 0..2 * STATIONS, targets, scale: mean }, Vec::new())
            }
            "force_spread" | "torque_spread" => (task::Goal::HalfWidth, vec![band(0..2 * STATIONS, None)]),
            // (Mean up − mean down) over the level wanted: Simpson's weights.
            "hysteresis" => {
                let one = |i: usize, sign: f64| sign * simpson_weight(i, STATIONS) / mean;
                let up = (0..STATIONS).map(|i| (i, one(i, 1.0)));
                let down = (0..STATIONS).map(|i| (STATIONS + i, one(i, -1.0)));
                (task::Goal::Values(up.chain(down).collect()), Vec::new())
            }
            _ => {
                let at = self.place(name).unwrap_or(0);
                (task::Goal::Values(vec![(at, 1.0 / scale_of(name))]), Vec::new())
            }
        }
    }

    /// Requirements as limits on values: forces or torques at every station, and the metrics that are values.
    fn limits(&self, goal: &str) -> Vec<Limit> {
        let mut all = Vec::new();
        for measure in self.evaluator.measures() {
            if measure.requirement.is_empty() || measure.name == goal {
                continue;
            }
            let key = match measure.requirement.as_str() {
                "force" | "torque" => format!("requirements.{}.band", self.words.quantity),
                "hysteresis" => "requirements.hysteresis".to_owned(),
                "spring_length" => "design.springs.max_length".to_owned(),
                "spring_solid" => "design.springs.min_length".to_owned(),
                "contact" | "contact_motion" => "design.springs".to_owned(),
                name => format!("requirements.limits.{name}"),
            };
            // A check is called after its requirement, or after the metric that is limited by name.
            let typed = REQUIREMENTS.into_iter().filter(|name| *name == measure.requirement);
            let checks: Vec<&'static str> = METRICS.iter().filter(|m| m.name == measure.name).map(|m| m.name).chain(typed).collect();
            let limit = |values: std::ops::Range<usize>, lower: f64, upper: f64, scale: f64, unit| Limit {
                name: measure.requirement.clone(),
                key: key.clone(),
                checks: checks.clone(),
                values,
                lower,
                upper,
                scale,
                unit,
                in_band: false,
            };
            if measure.name.ends_with("_deviation") {
                for (i, level) in self.wanted.iter().enumerate() {
                    for at in [i, STATIONS + i] {
                        let [lower, upper] = [-measure.upper, measure.upper].map(|band| level * (1.0 + band));
                        all.push(limit(at..at + 1, lower, upper, *level, self.words.unit));
                    }
                }
            } else if let Some(at) = self.place(&measure.name) {
                all.push(limit(at..at + 1, measure.lower, measure.upper, scale_of(&measure.name), measure.unit));
            }
        }
        all
    }
}
