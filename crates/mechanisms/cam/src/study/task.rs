//! From `[optimise]` and the requirements to a search: its goal and its limits.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::quadrature::simpson_weight;
use forcewright_contract::describe::Section;
use forcewright_contract::objective::{Goal, Way, goal_of};
use forcewright_contract::studies::Objective;
use forcewright_study::evaluator::Evaluator;
use forcewright_study::task::{self, Band, Limit, Step, Task};

use super::knobs::Knobs;
use super::many::{Many, SCALARS, STATIONS};
use crate::design::Design;
use crate::metrics::METRICS;

/// What can be optimised, with what it means, and whether it can be made large.
const OBJECTIVES: &[Goal] = &[
    small("force_deviation", "largest distance of the force, up or down, from what is required"),
    small("force_spread", "half width of the band that the force needs, up and down, its level free"),
    small("hysteresis", "mean up − mean down over the mean"),
    small("spring_length_max", "largest length of the springs"),
    small("width", "largest width over the stroke"),
    small("height", "height over the stroke"),
    small("cam_length", "extent of the cam along the travel"),
    small("contact_force_max", "largest force between roller and cam"),
    small("pressure_angle_max", "largest pressure angle"),
    small("peak_force_ratio", "largest force in the motion over that at rest"),
    small("moving_mass", "mass of what moves"),
];

const fn small(name: &'static str, doc: &'static str) -> Goal {
    Goal { name, doc, way: Way::Small }
}

/// Builds the task; what is wrong with the objective is reported.
pub(super) fn task(design: &Design, knobs: Knobs, objective: &Section<Objective>, diagnostics: &mut Diagnostics) -> Option<Task> {
    let (name, _) = goal_of(objective, OBJECTIVES, diagnostics)?;
    for (span, what) in [(objective.window.as_ref().map(|w| w.span), "window"), (objective.target.as_ref().map(|t| t.span), "target")] {
        if let Some(span) = span {
            let error = Diagnostic::error("E0305", span, format!("the objectives of cams have no `{what}`")).label("not needed");
            diagnostics.push(error.help("remove it; the window is `requirements.window`, the wanted force `requirements.profile`"));
            return None;
        }
    }
    let place = objective.minimise.as_ref().map(|m| m.span).unwrap_or_default();
    let band = design.requirements.as_ref().and_then(|r| r.force.as_ref());
    if name == "force_deviation" && band.is_none() {
        diagnostics.push(
            Diagnostic::error("E0302", place, "`force_deviation` needs a force that is required")
                .label("this objective")
                .help("give `requirements.force`, or minimise `force_spread`"),
        );
        return None;
    }
    let many = Many::new(design, knobs);
    let limits = limits(&many, name);
    let (goal, bands) = goal(&many, name);
    let title = format!("`{name}` as small as possible");
    Some(Task { evaluator: Box::new(many), title, steps: vec![Step { goal, bands, held: Vec::new() }], limits })
}

/// The value of a metric among all.
fn scalar(name: &str) -> Option<usize> {
    SCALARS.iter().position(|s| *s == name).map(|i| 3 * STATIONS + i)
}

fn goal(many: &Many, name: &str) -> (task::Goal, Vec<Band>) {
    let both = |level: Option<f64>| [0, 1].map(|i| Band { values: i * STATIONS..(i + 1) * STATIONS, level, half_width: None }).to_vec();
    let wanted = many.wanted_n();
    match name {
        "force_deviation" if wanted.iter().all(|w| w.to_bits() == wanted[0].to_bits()) => (task::Goal::HalfWidth, both(Some(wanted[0]))),
        // Without one level: squares, each relative to what is wanted there.
        "force_deviation" => {
            let scale = wanted.iter().sum::<f64>() / wanted.len() as f64;
            let targets = wanted.iter().chain(&wanted).copied().collect();
            (task::Goal::Squares { values: 0..2 * STATIONS, targets, scale }, Vec::new())
        }
        "force_spread" => {
            let values = 0..2 * STATIONS;
            (task::Goal::HalfWidth, vec![Band { values, level: None, half_width: None }])
        }
        // (Mean up − mean down) over the level wanted: Simpson's weights.
        "hysteresis" => {
            let level = wanted.iter().sum::<f64>() / wanted.len() as f64;
            let one = |i: usize, sign: f64| sign * simpson_weight(i, STATIONS) / level;
            let up = (0..STATIONS).map(|i| (i, one(i, 1.0)));
            let down = (0..STATIONS).map(|i| (STATIONS + i, one(i, -1.0)));
            (task::Goal::Values(up.chain(down).collect()), Vec::new())
        }
        _ => {
            let at = scalar(name).unwrap_or(0);
            (task::Goal::Values(vec![(at, 1.0 / scale_of(name))]), Vec::new())
        }
    }
}

/// What is a large change of a metric, SI.
fn scale_of(name: &str) -> f64 {
    match METRICS.iter().find(|m| m.name == name).map(|m| m.dimension.si_symbol()) {
        Some("m") => 0.1,
        Some("N") => 50.0,
        _ => 1.0,
    }
}

/// Requirements as limits on values: forces at every station, and the metrics that are values.
fn limits(many: &Many, goal: &str) -> Vec<Limit> {
    let mut all = Vec::new();
    let wanted = many.wanted_n();
    for measure in many.measures() {
        if measure.requirement.is_empty() || measure.name == goal {
            continue;
        }
        let key = match measure.requirement.as_str() {
            "force" => "requirements.force.band".to_owned(),
            "hysteresis" => "requirements.hysteresis".to_owned(),
            "spring_length" => "design.springs.max_length".to_owned(),
            "spring_solid" => "design.springs.min_length".to_owned(),
            "contact" | "contact_motion" => "design.springs".to_owned(),
            name => format!("requirements.limits.{name}"),
        };
        let checks = METRICS.iter().find(|m| m.name == measure.name).map(|m| m.name);
        let limit = |values: std::ops::Range<usize>, lower: f64, upper: f64, scale: f64, unit| Limit {
            name: measure.requirement.clone(),
            key: key.clone(),
            checks: checks.into_iter().collect(),
            values,
            lower,
            upper,
            scale,
            unit,
            in_band: false,
        };
        if measure.name == "force_deviation" {
            for (i, level) in wanted.iter().enumerate() {
                for at in [i, STATIONS + i] {
                    all.push(limit(at..at + 1, level * (1.0 - measure.upper), level * (1.0 + measure.upper), *level, "N"));
                }
            }
        } else if let Some(at) = scalar(&measure.name) {
            all.push(limit(at..at + 1, measure.lower, measure.upper, scale_of(&measure.name), measure.unit));
        }
    }
    all
}
