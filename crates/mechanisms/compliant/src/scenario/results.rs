//! What a surface adds to a result: curves, figures, words.

use std::fmt::Write as _;

use forcewright_base::maths::atan2;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_model::{Axis, Branch, Citation, Curve, Figure, FigureContent, HorizontalBand, Plot, Series, Statement, Stroke, Warning};

use super::Surface;
use super::run::{Contact, Pass, Stop, SurfaceRun, Why};
use crate::analysis::{Behaviour, Measured};
use crate::design::Design;

/// Places at which the surface is drawn.
const DRAWN: usize = 400;
/// Stretches of constant height whose band is drawn.
const SHOWN: usize = 3;

fn both<'a>(design: &'a Design, measured: &'a Measured) -> Option<(&'a Surface, &'a SurfaceRun)> {
    Some((design.surface.as_ref()?, measured.surface.as_ref()?))
}

fn length(design: &Design, x_m: f64) -> String {
    format_si(x_m, &design.units.displacement, 4)
}

fn degrees(slope: f64) -> String {
    let unit = Unit::parse("deg").unwrap_or_else(|_| Unit::si(Dimension::Angle));
    format_si(atan2(slope, 1.0), &unit, 3)
}

fn position_axis(design: &Design) -> Axis {
    Axis {
        name: "position",
        label: "Transverse position x".to_owned(),
        dimension: Dimension::Length,
        display: design.units.displacement.clone(),
    }
}

fn axis(design: &Design, name: &'static str, label: &str) -> Axis {
    Axis { name, label: label.to_owned(), dimension: Dimension::Force, display: design.units.force.clone() }
}

/// The passes with their names.
fn passes(run: &SurfaceRun) -> impl Iterator<Item = (&'static str, &Pass)> {
    ["forth", "back"].into_iter().zip(run.passes()).filter(|(_, pass)| !pass.states.is_empty())
}

fn column(pass: &Pass, value: fn(&Contact) -> f64) -> Vec<f64> {
    pass.states.iter().map(value).collect()
}

/// Forces over the position along the surface.
pub(crate) fn curves(design: &Design, measured: &Measured) -> Vec<Curve> {
    let Some((_, run)) = both(design, measured).filter(|(_, run)| passes(run).next().is_some()) else { return Vec::new() };
    let one = |name: &'static str, label: &str, value: fn(&Contact) -> f64| Curve {
        name,
        x: position_axis(design),
        y: axis(design, name, label),
        branches: passes(run)
            .map(|(way, pass)| Branch { name: way.to_owned(), x: column(pass, |c| c.position_m), y: column(pass, value) })
            .collect(),
    };
    vec![
        one("contact", "Contact force along the guide", |c| c.axial_n),
        one("contact_normal", "Contact force along the normal N", |c| c.normal_n),
        one("transverse", "Transverse force of the stage T", |c| c.transverse_n),
    ]
}

/// Forces along the surface, and the surface below them.
pub(crate) fn figures(design: &Design, measured: &Measured) -> Vec<Figure> {
    let Some((surface, run)) = both(design, measured) else { return Vec::new() };
    let force = passes(run).next().is_some().then(|| force_figure(design, surface, run));
    force.into_iter().chain([profile_figure(design, surface)]).collect()
}

fn force_figure(design: &Design, surface: &Surface, run: &SurfaceRun) -> Figure {
    let show = |f: f64| format_si(f, &design.units.force, 4);
    let mut bands = Vec::new();
    if let Some((band, Some(level))) = design.requirements.as_ref().and_then(|r| r.force) {
        let label = format!("{} ± {} % (required)", show(level), format_number(100.0 * band, 3));
        bands.push(HorizontalBand { from: level * (1.0 - band), to: level * (1.0 + band), extent: None, label });
    }
    for flat in run.flats.iter().take(SHOWN) {
        let ([from, to], [start, end]) = (flat.axial_n, flat.extent_m);
        let label = format!(
            "constant height {} to {}: friction leaves {} to {} open",
            length(design, start),
            length(design, end),
            show(from),
            show(to)
        );
        bands.push(HorizontalBand { from, to, extent: Some((start, end)), label });
    }
    let series = |label: &str, pass: &Pass, value: fn(&Contact) -> f64, stroke| Series {
        label: label.to_owned(),
        x: column(pass, |c| c.position_m),
        y: column(pass, value),
        stroke,
    };
    let mut all = vec![series("F(Δ), what the mechanism gives", &run.forth, |c| c.elastic_n, Stroke::Reference)];
    all.extend(passes(run).zip([Stroke::Main, Stroke::Second]).map(|((way, pass), stroke)| series(way, pass, |c| c.axial_n, stroke)));
    let mut caption = match (run.axial_n(), run.mean_n()) {
        (Some([least, largest]), Some(mean)) => {
            format!("The contact force along the guide goes from {} to {}, {} on average. ", show(least), show(largest), show(mean))
        }
        _ => run.stop.map_or_else(String::new, |stop| format!("{}. ", ending(design, surface, stop))),
    };
    let millijoule = Unit::parse("mJ").unwrap_or_else(|_| Unit::si(Dimension::Energy));
    let work = format_si(run.work_j(), &millijoule, 3);
    if run.back.is_some() && run.stop.is_none() && surface.guide_drag() + surface.tip_friction > 0.0 {
        let _ = write!(caption, "There and back the stage does {work} of work, all of it against friction.");
    }
    let plot = Plot {
        x: position_axis(design),
        y: axis(design, "contact", "Contact force along the guide"),
        series: all,
        bands,
        levels: Vec::new(),
        spans: Vec::new(),
        markers: Vec::new(),
        from_zero: run.axial_n().is_none_or(|[least, most]| least < 0.5 * most),
    };
    Figure { id: "contact", title: "Contact force along the surface".to_owned(), caption, content: FigureContent::Plot(plot) }
}

fn profile_figure(design: &Design, surface: &Surface) -> Figure {
    let path = &surface.path;
    let [first, last] = path.profile().extent_m();
    let mut x: Vec<f64> = (0..=DRAWN).map(|i| first + (last - first) * i as f64 / DRAWN as f64).collect();
    x.extend(path.profile().positions_m());
    x.sort_by(f64::total_cmp);
    let line = |label: &str, y: Vec<f64>, stroke| Series { label: label.to_owned(), x: x.clone(), y, stroke };
    let mut series = vec![line("surface", x.iter().map(|x| path.profile().height_m(*x)).collect(), Stroke::Main)];
    let mut caption = format!("Where the height is zero, the mechanism is at Δ = {}.", length(design, surface.preload_m));
    if path.radius_m() > 0.0 {
        series.push(line("lowest point of the tip", x.iter().map(|x| path.at(*x).height_m).collect(), Stroke::Second));
        let _ = write!(
            caption,
            " The tip has a radius of {}: its lowest point follows another way than the surface.",
            length(design, path.radius_m())
        );
    }
    let plot = Plot {
        x: position_axis(design),
        y: Axis { name: "height", label: "Height z".to_owned(), ..position_axis(design) },
        series,
        bands: Vec::new(),
        levels: Vec::new(),
        spans: Vec::new(),
        markers: Vec::new(),
        from_zero: true,
    };
    Figure { id: "surface", title: "Surface".to_owned(), caption, content: FigureContent::Plot(plot) }
}

/// How the tip is drawn along the surface.
pub(crate) fn model(design: &Design) -> Option<Statement> {
    let surface = design.surface.as_ref()?;
    let bearings = if surface.guide_load > 1.0 {
        format!(", whose normal forces add up to {} times the transverse force", format_number(surface.guide_load, 3))
    } else {
        ", which carry the transverse force without a couple".to_owned()
    };
    Some(Statement {
        title: "Surface".to_owned(),
        text: format!(
            "A stage carries the mechanism sideways{}. Its block, guided along the load by linear bearings{bearings}, ends in a {} tip that rests on the surface; Δ = {} where the height is zero. In every position the tip is in balance under the force F(Δ), the contact force with its friction (coefficient {}) and the friction of the bearings ({}), both against the motion. At a constant height the friction of the bearings stays what it was before, and is none at the start and after a turn.",
            if surface.there_and_back { ", there and back" } else { "" },
            if surface.path.radius_m() > 0.0 {
                format!("round (radius {})", length(design, surface.path.radius_m()))
            } else {
                "sharp".to_owned()
            },
            length(design, surface.preload_m),
            format_number(surface.tip_friction, 3),
            format_number(surface.guide_friction, 3),
        ),
    })
}

/// What the model of the surface leaves out.
pub(crate) fn limits(design: &Design) -> Option<Statement> {
    design.surface.as_ref()?;
    Some(Statement {
        title: "Surface".to_owned(),
        text: "No inertia: the stage is slow, and the tip never flies. Surface, tip, block and stage are rigid; friction is Coulomb's, the same at rest and in motion. The overhang of the tip is taken as constant, and the friction of the bearings as acting on their axis. The surface begins and ends with its profile.".to_owned(),
    })
}

/// The work that the scenario is from.
pub(crate) fn sources(design: &Design) -> Option<Citation> {
    design.surface.as_ref()?;
    Some(Citation {
        key: "fritsch-butland1984",
        text: "F. N. Fritsch, J. Butland: A Method for Constructing Local Monotone Piecewise Cubic Interpolants. SIAM Journal on Scientific and Statistical Computing 5 (1984) 300–304.",
        used_for: "heights of the surface between its points",
    })
    .filter(|_| design.surface.as_ref().is_some_and(|s| s.path.profile().is_smooth()))
}

/// Where and why the stage goes no further.
fn ending(design: &Design, surface: &Surface, stop: Stop) -> String {
    let at = length(design, stop.position_m);
    match stop.why {
        Why::Locks => format!(
            "at x = {at} the tip locks: the surface rises by {}, and with this friction no transverse force moves the tip up more than {}",
            degrees(stop.slope),
            degrees(surface.locking_slope().max(0.0))
        ),
        Why::Beyond => {
            let delta = surface.preload_m + surface.path.at(stop.position_m).height_m;
            format!("at x = {at} the surface asks for more than Δ = {}, up to where the force is known", length(design, delta))
        }
        Why::LetsGo => format!("at x = {at} the mechanism no longer pushes: the tip would leave the surface by itself"),
    }
}

/// Said behind the status.
pub(crate) fn status(design: &Design, measured: &Measured) -> Option<String> {
    let (surface, run) = both(design, measured)?;
    run.stop.map(|stop| ending(design, surface, stop))
}

/// Things to know about the way along the surface.
pub(crate) fn warnings(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Warning> {
    let Some((surface, run)) = both(design, measured) else { return Vec::new() };
    let mut all = Vec::new();
    if let Some(stop) = run.stop {
        let (code, advice) = match stop.why {
            Why::Locks => ("W0520", "; lower the friction, shorten the overhang, round the tip, or make the surface less steep".to_owned()),
            Why::Beyond if behaviour.whole && behaviour.stack.as_ref().is_none_or(|s| s.apart_from_m.is_none()) => {
                ("W0522", format!("; lengthen `{}`, or lower `preload`", design.load_key))
            }
            Why::Beyond => ("W0522", "; lower `preload`, or see the status of the path".to_owned()),
            Why::LetsGo => ("W0523", "; lower `preload`, or change the shape so that its force stays positive".to_owned()),
        };
        all.push(Warning { code, message: format!("{}{advice}", ending(design, surface, stop)) });
    }
    if let Some(at) = run.lifts_at_m() {
        let message = format!(
            "from x = {} on the tip does not touch: the surface lies lower than the mechanism at rest; a larger `preload` keeps it in contact",
            length(design, at)
        );
        all.push(Warning { code: "W0521", message });
    }
    all
}

/// Whether a metric belongs to a scenario.
fn is_of_scenario(metric: &str) -> bool {
    metric.starts_with("contact_") || metric == "transverse_force_max"
}

/// What mends a broken limit on a metric of a scenario; `None` for other metrics.
pub(crate) fn fix(design: &Design, measured: &Measured, metric: &str, broken: bool) -> Option<String> {
    let other = "move the range by `preload`, lower the friction, change the design, or relax the limit";
    let locks = missing(design, measured, metric).filter(|_| broken);
    is_of_scenario(metric).then(|| locks.unwrap_or_else(|| other.to_owned()))
}

/// Why a metric of a scenario has no value; `None` for other metrics.
pub(crate) fn missing(design: &Design, measured: &Measured, metric: &str) -> Option<String> {
    if !is_of_scenario(metric) {
        return None;
    }
    let Some((surface, run)) = both(design, measured) else {
        return Some(
            if design.surface.is_some() {
                "there is no force over the displacement; see the status"
            } else {
                "nothing is touched; describe the surface in `[scenario.surface]`"
            }
            .to_owned(),
        );
    };
    Some(
        run.stop
            .map_or_else(|| "the tip never touches the surface; give a larger `preload`".to_owned(), |stop| ending(design, surface, stop)),
    )
}

/// Whether a force grows without limit: where the tip locks.
pub(crate) fn never_ends(measured: &Measured, metric: &str) -> bool {
    let locks = measured.surface.as_ref().and_then(|run| run.stop).is_some_and(|stop| stop.why == Why::Locks);
    locks && matches!(metric, "contact_force_max" | "contact_force_spread" | "transverse_force_max")
}
