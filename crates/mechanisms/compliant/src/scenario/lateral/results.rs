//! What a lateral motion adds to a result: curves, figures, words.

use forcewright_base::units::{Dimension, format_number, format_si};
use forcewright_beam::Status;
use forcewright_model::{
    Axis, Branch, Curve, Figure, FigureContent, HorizontalBand, Plot, Series, Statement, Stroke, VerticalSpan, Warning,
};

use super::{Lateral, LateralMap, Row, Shortfall, TipState};
use crate::analysis::Behaviour;
use crate::design::Design;

/// The displacements Δ of a map, with as many digits as tell them apart.
fn levels(design: &Design, map: &LateralMap) -> Vec<String> {
    let with = |digits| map.axial_m.iter().map(|x| format_si(*x, &design.units.displacement, digits)).collect::<Vec<_>>();
    let differ = |names: &Vec<String>| names.windows(2).all(|pair| pair[0] != pair[1]);
    (4..=15).map(with).find(differ).unwrap_or_else(|| with(17))
}

/// Lines of a figure: one per Δ, as many as there are strokes.
const STROKES: [Stroke; 5] = [Stroke::Main, Stroke::Second, Stroke::Third, Stroke::Fourth, Stroke::Reference];

fn both<'a>(design: &'a Design, behaviour: &'a Behaviour) -> Option<(&'a Lateral, &'a LateralMap)> {
    Some((design.lateral.as_ref()?, behaviour.lateral.as_ref()?))
}

fn length(design: &Design, x_m: f64) -> String {
    format_si(x_m, &design.units.displacement, 4)
}

fn force(design: &Design, f_n: f64) -> String {
    format_si(f_n, &design.units.force, 4)
}

/// `between 3.078 N and 3.395 N, ± 4.9 % of the middle; 3.22 N on average`.
fn between(design: &Design, [low_n, high_n]: [f64; 2], mean_n: f64, spread: Option<f64>) -> String {
    let of_middle = spread.map_or_else(
        || ", as large to one side as to the other".to_owned(),
        |s| format!(", ±{} about the middle of the two; {} on average", percent(s), force(design, mean_n)),
    );
    format!("between {} and {}{of_middle}", force(design, low_n), force(design, high_n))
}

/// What a figure does not draw.
fn left_out(map: &LateralMap) -> String {
    let levels = map.axial_m.len();
    if levels > STROKES.len() { format!(" {} of {levels} Δ are drawn.", STROKES.len()) } else { String::new() }
}

fn percent(ratio: f64) -> String {
    format!("{} %", format_number(100.0 * ratio, 3))
}

fn lateral_axis(design: &Design) -> Axis {
    Axis {
        name: "lateral_displacement",
        label: "Lateral displacement δ".to_owned(),
        dimension: Dimension::Length,
        display: design.units.displacement.clone(),
    }
}

fn force_axis(design: &Design, name: &'static str, label: &str) -> Axis {
    Axis { name, label: label.to_owned(), dimension: Dimension::Force, display: design.units.force.clone() }
}

/// A value over δ at one Δ, where there are states.
fn line(map: &LateralMap, level: usize, value: fn(&TipState) -> f64) -> (Vec<f64>, Vec<f64>) {
    let at = |row: &Row| Some((row.lateral_m, value(row.states.get(level)?.as_ref()?)));
    map.rows.iter().filter_map(at).unzip()
}

/// Forces and stress over the lateral displacement, a branch per Δ.
pub(crate) fn curves(design: &Design, behaviour: &Behaviour) -> Vec<Curve> {
    let Some((_, map)) = both(design, behaviour) else { return Vec::new() };
    let names = levels(design, map);
    let stress = Axis {
        name: "lateral_stress",
        label: "Largest stress |σ|".to_owned(),
        dimension: Dimension::Stress,
        display: design.units.stress.clone(),
    };
    let one = |y: Axis, value: fn(&TipState) -> f64| {
        let branch = |(level, name): (usize, &String)| {
            let (x, y) = line(map, level, value);
            (!x.is_empty()).then(|| Branch { name: format!("Δ = {name}"), x, y })
        };
        Curve { name: y.name, x: lateral_axis(design), y, branches: names.iter().enumerate().filter_map(branch).collect() }
    };
    let all = vec![
        one(force_axis(design, "lateral_force", "Lateral force F_l"), |s| s.lateral_n),
        one(force_axis(design, "axial_force", "Axial force F_a"), |s| s.axial_n),
        one(stress, |s| s.stress_pa),
    ];
    all.into_iter().filter(|c| !c.branches.is_empty()).collect()
}

/// Both forces over the lateral displacement, a line per Δ.
pub(crate) fn figures(design: &Design, behaviour: &Behaviour) -> Vec<Figure> {
    let Some((lateral, map)) = both(design, behaviour).filter(|(_, map)| map.rows.iter().any(|r| r.states.iter().any(Option::is_some)))
    else {
        return Vec::new();
    };
    let summary = map.summary();
    let lateral_caption = summary.map_or_else(
        || map.shortfall().map_or_else(String::new, |row| format!("{}.", ending(design, map, row))),
        |s| {
            let forces = between(design, s.lateral_n, s.lateral_mean_n, s.lateral_spread);
            format!("Force that holds the tip sideways, positive along positive δ: over the window and all Δ {forces}.{}", left_out(map))
        },
    );
    let axial_caption = summary.map_or_else(String::new, |s| {
        let forces = between(design, s.axial_n, s.axial_mean_n, s.axial_spread);
        let coupling = s
            .axial_coupling
            .map_or_else(String::new, |c| format!(" While the tip moves sideways at one Δ, it changes by ±{} at most.", percent(c)));
        format!("Force along the load: over the window and all Δ {forces}.{coupling}{}", left_out(map))
    });
    let band = design.requirements.as_ref().and_then(|r| r.force).and_then(|(band, level)| Some((band, level?)));
    let required = band.map(|(band, level)| HorizontalBand {
        from: level * (1.0 - band),
        to: level * (1.0 + band),
        extent: None,
        label: format!("{} ± {} (required at δ = 0)", force(design, level), percent(band)),
    });
    vec![
        Figure {
            id: "lateral-force",
            title: "Lateral force".to_owned(),
            caption: lateral_caption,
            content: FigureContent::Plot(plot(
                design,
                (lateral, map),
                force_axis(design, "lateral_force", "Lateral force F_l"),
                None,
                |s| s.lateral_n,
            )),
        },
        Figure {
            id: "axial-force",
            title: "Axial force beside the middle".to_owned(),
            caption: axial_caption,
            content: FigureContent::Plot(plot(
                design,
                (lateral, map),
                force_axis(design, "axial_force", "Axial force F_a"),
                required,
                |s| s.axial_n,
            )),
        },
    ]
}

/// At most as many Δ as there are strokes, the first and the last among them.
fn drawn(levels: usize) -> Vec<usize> {
    let most = STROKES.len();
    if levels <= most { (0..levels).collect() } else { (0..most).map(|i| i * (levels - 1) / (most - 1)).collect() }
}

fn plot(
    design: &Design,
    (lateral, map): (&Lateral, &LateralMap),
    y: Axis,
    required: Option<HorizontalBand>,
    value: fn(&TipState) -> f64,
) -> Plot {
    let names = levels(design, map);
    let one = |(level, stroke): (usize, Stroke)| {
        let (x, y) = line(map, level, value);
        (!x.is_empty()).then(|| Series { label: format!("Δ = {}", names[level]), x, y, stroke })
    };
    let forces = || map.rows.iter().flat_map(|row| &row.states).flatten().map(value);
    let (least, most) = (forces().fold(f64::INFINITY, f64::min), forces().fold(f64::NEG_INFINITY, f64::max));
    let far_from_zero = least > 0.5 * most && least > 0.0 || most < 0.5 * least && most < 0.0;
    let [from, to] = lateral.window_m;
    let part = to - from < (lateral.travel_m[1] - lateral.travel_m[0]) * (1.0 - 1e-9);
    let window = VerticalSpan { from, to, label: "window of the metrics".to_owned(), hatched: false };
    Plot {
        x: lateral_axis(design),
        y,
        series: drawn(map.axial_m.len()).into_iter().zip(STROKES).filter_map(one).collect(),
        bands: required.into_iter().collect(),
        levels: Vec::new(),
        spans: part.then_some(window).into_iter().collect(),
        markers: Vec::new(),
        from_zero: !far_from_zero,
    }
}

/// How the tip is moved.
pub(crate) fn model(design: &Design) -> Option<Statement> {
    let lateral = design.lateral.as_ref()?;
    let [from, to] = lateral.travel_m.map(|x| length(design, x));
    let [low, high] = lateral.axial_m.map(|x| length(design, x));
    let rows = LateralMap::places(lateral);
    Some(Statement {
        title: "Lateral motion".to_owned(),
        text: format!(
            "The guide of the tip, along the load, is moved across it by δ from {from} to {to}; δ counts along the load's direction turned by 90° counter-clockwise. At each of {rows} δ the path is solved on which the tip is first moved across the load, free along it, and then pushed along it; states are kept at {} displacements Δ from {low} to {high}, counted from rest. F_a and F_l are the forces that hold the tip there, both those of the whole layout. An elastic mechanism whose states are all stable with both displacements held, and which does not jump between them, has the same forces in whatever order its places are reached; that it does not jump shows in its energy, which the lateral force must add up to. Metrics are over the places of the map, without interpolation.",
            lateral.levels
        ),
    })
}

/// What the map leaves out.
pub(crate) fn limits(design: &Design) -> Option<Statement> {
    design.lateral.as_ref()?;
    Some(Statement {
        title: "Lateral motion".to_owned(),
        text: "No friction, neither in the guide nor between tip and surface: both forces are elastic. What lies between two places of the map is not looked at; `places` and `levels` make it finer. Clearance, envelope and pads are those of the path at δ = 0.".to_owned(),
    })
}

/// Where and why the map ends.
fn ending(design: &Design, map: &LateralMap, row: &Row) -> String {
    let at = length(design, row.lateral_m);
    let far = |reached_m: Option<f64>| match (reached_m, map.axial_m.first()) {
        (Some(x), _) => format!("further than Δ = {}", length(design, x)),
        (None, Some(first)) => format!("as far as Δ = {}", length(design, *first)),
        (None, None) => "along the load".to_owned(),
    };
    match row.shortfall {
        Some(Shortfall::Across(status)) => format!("the unloaded tip cannot be moved to δ = {at}: {}", reason(design, status)),
        Some(Shortfall::Along { reached_m, status }) => {
            format!("at δ = {at} the tip is not pushed {}: {}", far(reached_m), reason(design, status))
        }
        Some(Shortfall::Branches { reached_m }) => {
            format!("at δ = {at} the tip is not pushed {}: the path branches, and a real part leaves the computed shape", far(reached_m))
        }
        Some(Shortfall::Jumps { from_m }) => {
            let from = length(design, from_m);
            format!(
                "between δ = {from} and {at} the mechanism jumps into another shape; which one a real part has depends on how it came there"
            )
        }
        None => format!("the map ends at δ = {at}"),
    }
}

fn reason(design: &Design, status: Status) -> String {
    match status {
        Status::NoEquilibriumBeyond { .. } => "there is no neighbouring equilibrium beyond; the mechanism snaps".to_owned(),
        Status::PulledStraight { beam, .. } => {
            format!("beam `{}` is pulled straight", design.beam_names.get(beam).map_or("?", String::as_str))
        }
        Status::NotResolved { error_estimate, .. } => {
            format!("the forces are accurate to about {error_estimate:.1e} of the largest one only")
        }
        Status::Stopped { .. } => "stopped on request".to_owned(),
        _ => "the solver came no further".to_owned(),
    }
}

/// Said behind the status.
pub(crate) fn status(design: &Design, behaviour: &Behaviour) -> Option<String> {
    let (_, map) = both(design, behaviour)?;
    Some(ending(design, map, map.shortfall()?))
}

/// Things to know about the map.
pub(crate) fn warnings(design: &Design, behaviour: &Behaviour) -> Vec<Warning> {
    let Some((_, map)) = both(design, behaviour) else { return Vec::new() };
    let message = |row| format!("{}; narrow `scenario.lateral`, or change the shape", ending(design, map, row));
    let gap = map.shortfall().map(|row| Warning { code: "W0524", message: message(row) });
    let yields = map.worst_stress(|beam| design.yield_pa(beam)).filter(|(.., part)| *part > 1.0).map(|([axial_m, lateral_m], beam, ..)| {
        let beam = design.beam_names.get(beam).map_or("?", String::as_str);
        let [axial, lateral] = [axial_m, lateral_m].map(|x| length(design, x));
        let what = "exceeds its yield stress with the tip moved sideways";
        Warning { code: "W0504", message: format!("the stress in beam `{beam}` {what}, at Δ = {axial} and δ = {lateral}") }
    });
    gap.into_iter().chain(yields).collect()
}

/// Whether a metric belongs to a lateral motion.
fn is_of_map(metric: &str) -> bool {
    metric.starts_with("lateral_force_") || metric.starts_with("axial_force_") || metric.starts_with("tip_")
}

/// What mends a broken limit on a metric of the map; `None` for other metrics.
pub(crate) fn fix(metric: &str) -> Option<String> {
    is_of_map(metric).then(|| "narrow the window or the range of Δ, change the design, or relax the limit".to_owned())
}

/// Why a metric of the map has no value; `None` for other metrics.
pub(crate) fn missing(design: &Design, behaviour: &Behaviour, metric: &str) -> Option<String> {
    if !is_of_map(metric) {
        return None;
    }
    Some(match both(design, behaviour) {
        Some((_, map)) => map.shortfall().map_or_else(
            || "the force is as large to one side as to the other: its middle is zero; `lateral_force_max` says how large".to_owned(),
            |row| ending(design, map, row),
        ),
        None if design.lateral.is_some() => "there is no map; see the status".to_owned(),
        None => "nothing moves sideways; describe the motion in `[scenario.lateral]`".to_owned(),
    })
}
