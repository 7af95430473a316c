//! Curves and figures of a result.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_elements::grooves::Groove;
use forcewright_model::{Axis, Branch, Curve, Figure, FigureContent, HorizontalLine, Marker, Plot, Series, Stroke};

use crate::analysis::{Behaviour, Measured};
use crate::design::Design;
use crate::scene;
use crate::statics::Loaded;
use crate::tension::Along;

/// Centre distances of the plot of the alignment.
const DISTANCES: usize = 120;

fn axis(name: &'static str, label: &str, dimension: Dimension, display: &Unit) -> Axis {
    Axis { name, label: label.to_owned(), dimension, display: display.clone() }
}

fn torque_axis(design: &Design) -> Axis {
    axis("torque", "Torque at the output τ", Dimension::Torque, &design.units.torque)
}

fn turn_axis(design: &Design) -> Axis {
    axis("turn", "Turn of the output φ, input held", Dimension::Angle, &design.units.small_angle)
}

fn stiffness_axis(design: &Design) -> Axis {
    axis("stiffness", "Stiffness at the output", Dimension::RotationalStiffness, &design.units.stiffness)
}

fn tension_axis(design: &Design) -> Axis {
    axis("tension", "Tension T", Dimension::Force, &design.units.force)
}

fn slip_axis(design: &Design) -> Axis {
    axis("slip_angle", "Slip angle θ", Dimension::Angle, &design.units.angle)
}

fn over_torque(behaviour: &Behaviour, name: &str, value: impl Fn(&Loaded) -> f64) -> Branch {
    let kept = behaviour.stations.iter().map(|s| (s.torque_nm, value(s))).filter(|(_, y)| y.is_finite());
    let (x, y) = kept.unzip();
    Branch { name: name.to_owned(), x, y }
}

fn taut_n(loaded: &Loaded) -> f64 {
    loaded.tensions_n.iter().map(|t| t[0]).fold(f64::NEG_INFINITY, f64::max)
}

fn slack_n(loaded: &Loaded) -> f64 {
    loaded.tensions_n.iter().map(|t| t[1]).fold(f64::INFINITY, f64::min)
}

/// Slip angle on a drum (0 output, 1 input) of a side, the largest of all cables, rad.
fn slip_rad(side: usize, drum: usize) -> impl Fn(&Loaded) -> f64 {
    move |loaded| loaded.slip_rad.iter().map(|s| s[side][drum]).fold(0.0, f64::max)
}

/// Names and legends of the slip angles: name, side, drum, text.
const SLIPS: [(&str, usize, usize, &str); 4] = [
    ("taut_output", 0, 0, "taut side, output θ₁"),
    ("taut_input", 0, 1, "taut side, input θ₂"),
    ("slack_input", 1, 1, "slack side, input θ₃"),
    ("slack_output", 1, 0, "slack side, output θ₄"),
];

/// Every curve of a result.
pub(crate) fn curves(design: &Design, behaviour: &Behaviour) -> Vec<Curve> {
    let statics = &behaviour.statics;
    let curve = |name, y, branches| Curve { name, x: torque_axis(design), y, branches };
    let mut all = vec![
        curve("turn", turn_axis(design), vec![over_torque(behaviour, "from_rest", |s| s.turn_rad)]),
        curve(
            "stiffness",
            stiffness_axis(design),
            vec![
                over_torque(behaviour, "tangent", |s| statics.torsional(s.tangent_n_per_m, 1)),
                over_torque(behaviour, "secant", |s| statics.torsional(s.secant_n_per_m, 1)),
            ],
        ),
        curve("tension", tension_axis(design), vec![over_torque(behaviour, "taut", taut_n), over_torque(behaviour, "slack", slack_n)]),
        curve(
            "slip_angle",
            slip_axis(design),
            SLIPS.iter().map(|(name, side, drum, _)| over_torque(behaviour, name, slip_rad(*side, *drum))).collect(),
        ),
    ];
    if let Some(cycle) = &behaviour.cycle {
        let branches = ["from_rest", "back", "forth"].iter().zip(&cycle.branches).map(|(name, points)| Branch {
            name: (*name).to_owned(),
            x: points.iter().map(|p| p[0]).collect(),
            y: points.iter().map(|p| p[1]).collect(),
        });
        all.push(Curve { name: "loop", x: turn_axis(design), y: torque_axis(design), branches: branches.collect() });
    }
    all
}

fn series(branch: Branch, label: &str, stroke: Stroke) -> Series {
    Series { label: label.to_owned(), x: branch.x, y: branch.y, stroke }
}

fn plot(x: Axis, y: Axis, series: Vec<Series>) -> Plot {
    Plot { x, y, series, bands: Vec::new(), levels: Vec::new(), spans: Vec::new(), markers: Vec::new(), from_zero: true }
}

fn figure(id: &'static str, title: &str, caption: String, content: FigureContent) -> Figure {
    Figure { id, title: title.to_owned(), caption, content }
}

/// Every figure of a report.
pub(crate) fn figures(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Figure> {
    let mut all = Vec::new();
    if let Some(film) = scene::drive(design, behaviour, torque_axis(design)) {
        let caption = "Seen along the axes, under the torque chosen below. The colour of the cable is its tension; the spirals outside the drums are the zones in which it slips, a turn further out for each turn on the drum.";
        all.push(figure("mechanism", "Drive under load", caption.to_owned(), FigureContent::Film(film)));
    }
    all.push(stiffness_figure(design, behaviour, measured));
    all.extend(loop_figure(design, behaviour, measured));
    all.extend(tension_figure(design, behaviour));
    all.push(slip_figure(design, behaviour));
    if let Some(film) = scene::drums(design, behaviour) {
        let caption = "The cables on their drums in space, at the turn of the output chosen below. Thin lines are behind a drum.";
        all.push(figure("drums", "Drums and cables over the travel", caption.to_owned(), FigureContent::Film(film)));
    }
    all.extend(alignment_figure(design, behaviour));
    all
}

fn stiffness_figure(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Figure {
    let statics = &behaviour.statics;
    let tangent = over_torque(behaviour, "tangent", |s| statics.torsional(s.tangent_n_per_m, 1));
    let secant = over_torque(behaviour, "secant", |s| statics.torsional(s.secant_n_per_m, 1));
    let mut plot = plot(
        torque_axis(design),
        stiffness_axis(design),
        vec![series(secant, "secant τ/φ", Stroke::Second), series(tangent, "tangent dτ/dφ", Stroke::Main)],
    );
    let shown = |nm: f64| format_si(nm, &design.units.stiffness, 4);
    let requirements = design.requirements.as_ref();
    if let Some(least) = requirements.and_then(|r| r.stiffness_nm_per_rad) {
        plot.levels.push(HorizontalLine { at: least, label: format!("required {}", shown(least)), stroke: Stroke::Limit });
    }
    let mut caption = format!("At rest {}, that of the spans: no friction makes it larger.", shown(statics.initial_nm_per_rad()));
    if let (Some(torque), Some(found)) = (requirements.map(|r| r.torque_nm), measured.get("stiffness_tangent_output")) {
        let note = format!("{} under {}", shown(found), format_si(torque, &design.units.torque, 4));
        let _ = write!(caption, " {note}.");
        plot.markers.push(Marker { x: torque, y: found, label: "K".to_owned(), note });
    }
    if let Some(slips) = statics.gross_slip_nm() {
        let _ = write!(caption, " The cables slip over the whole input drum at {}.", format_si(slips, &design.units.torque, 4));
    }
    figure("stiffness", "Stiffness over the torque", caption, FigureContent::Plot(plot))
}

fn loop_figure(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Option<Figure> {
    let cycle = behaviour.cycle.as_ref()?;
    let [fresh, back, forth] = &cycle.branches;
    let line = |points: &[[f64; 2]], label: &str, stroke| Series {
        label: label.to_owned(),
        x: points.iter().map(|p| p[0]).collect(),
        y: points.iter().map(|p| p[1]).collect(),
        stroke,
    };
    let area: Vec<[f64; 2]> = back.iter().chain(forth).copied().collect();
    let lines = vec![
        line(&area, "lost in a cycle", Stroke::Area),
        line(fresh, "from rest", Stroke::Reference),
        line(back, "torque falls", Stroke::Second),
        line(forth, "torque rises", Stroke::Main),
    ];
    let mut plot = plot(turn_axis(design), torque_axis(design), lines);
    plot.from_zero = false;
    let joule = Unit::parse("mJ").unwrap_or_else(|_| Unit::si(Dimension::Energy));
    let lost = measured.get("lost_motion_output").map_or_else(String::new, |rad| format_si(rad, &design.units.small_angle, 3));
    let caption = format!(
        "The closed loop between the required torque one way and the other: {lost} of lost motion at zero torque, {} a cycle.",
        format_si(cycle.lost_j, &joule, 3)
    );
    Some(figure("loop", "Torque and turn, there and back", caption, FigureContent::Plot(plot)))
}

fn tension_figure(design: &Design, behaviour: &Behaviour) -> Option<Figure> {
    let loaded = behaviour.at_torque().or_else(|| behaviour.stations.last())?;
    let along = Along::of(design, behaviour, loaded, 0)?;
    let points = along.points(240);
    let tension = Series {
        label: "tension".to_owned(),
        x: points.iter().map(|p| p.at_m).collect(),
        y: points.iter().map(|p| p.tension_n).collect(),
        stroke: Stroke::Main,
    };
    let length = axis("length", "Along the cable, from its taut end", Dimension::Length, &design.units.length);
    let mut plot = plot(length, tension_axis(design), vec![tension]);
    let preload_n = design.built.cables.first()?.preload_left_n(&design.built);
    let text = format!("preload {}", format_si(preload_n, &design.units.force, 4));
    plot.levels.push(HorizontalLine { at: preload_n, label: text, stroke: Stroke::Reference });
    plot.spans.extend(along.spans().into_iter().map(|(from, to, label)| forcewright_model::VerticalSpan {
        from,
        to,
        label,
        hatched: false,
    }));
    let torque = format_si(loaded.torque_nm, &design.units.torque, 4);
    let which = if design.built.cables.len() > 1 { "the first cable" } else { "the cable" };
    let caption =
        format!("Tension along {which} under {torque}, in the middle of the travel: where it is level on a drum, the cable sticks.");
    Some(figure("tension", "Tension along the cable", caption, FigureContent::Plot(plot)))
}

fn slip_figure(design: &Design, behaviour: &Behaviour) -> Figure {
    let strokes = [Stroke::Main, Stroke::Second, Stroke::Third, Stroke::Reference];
    let lines = SLIPS.iter().zip(strokes);
    let all = lines.map(|((name, side, drum, text), stroke)| series(over_torque(behaviour, name, slip_rad(*side, *drum)), text, stroke));
    let mut plot = plot(torque_axis(design), slip_axis(design), all.collect());
    let wraps = behaviour.geometry.least_output_wraps_rad();
    let guard = wraps.into_iter().fold(f64::INFINITY, f64::min);
    let unit = &design.units.angle;
    let label = format!("shortest wrap on the output {}", format_si(guard, unit, 4));
    plot.levels.push(HorizontalLine { at: guard, label, stroke: Stroke::Limit });
    let caption = format!(
        "How far slip reaches from the spans; of several cables the farthest. The wrap on the input drum is {}: where both of its zones meet, the cable slips as a whole.",
        format_si(behaviour.geometry.input_wrap_rad(), unit, 4)
    );
    figure("slip", "Slip angles", caption, FigureContent::Plot(plot))
}

/// How far the return span lands from its groove, over the centre distance.
fn alignment_figure(design: &Design, behaviour: &Behaviour) -> Option<Figure> {
    let built = &design.built;
    if built.seat.groove == Groove::Flat {
        return None;
    }
    let least_m = built.radii_m[0] + built.radii_m[1];
    let [from_m, to_m] = [least_m + 0.02 * (built.distance_m - least_m), least_m + 2.0 * (built.distance_m - least_m)];
    let at = |distance_m: f64| {
        let mut other = built.clone();
        other.distance_m = distance_m;
        // Another centre distance may ask for another line; the mismatch is counted from these all the same.
        let drive =
            crate::geometry::Drive::new(crate::geometry::Layout { surface: crate::geometry::Surface::Flat, ..other.layout() }).ok()?;
        let ours = behaviour.geometry.landing_pitches();
        Some(behaviour.geometry.mismatch_pitches(0).ok()? + drive.landing_pitches() - ours)
    };
    let points: Vec<[f64; 2]> = (0..=DISTANCES)
        .filter_map(|i| {
            let distance_m = from_m + (to_m - from_m) * i as f64 / DISTANCES as f64;
            Some([distance_m, at(distance_m)?])
        })
        .collect();
    let mismatch = axis("mismatch", "Mismatch in pitches", Dimension::Ratio, &Unit::si(Dimension::Ratio));
    let line = Series {
        label: "from its groove to where the return span lands".to_owned(),
        x: points.iter().map(|p| p[0]).collect(),
        y: points.iter().map(|p| p[1]).collect(),
        stroke: Stroke::Main,
    };
    let mut plot = plot(axis("distance", "Centre distance d", Dimension::Length, &design.units.length), mismatch, vec![line]);
    plot.levels.push(HorizontalLine { at: 0.0, label: "in line".to_owned(), stroke: Stroke::Reference });
    let here = behaviour.geometry.mismatch_pitches(0).ok()?;
    let length = |m: f64| format_si(m, &design.units.length, 5);
    let note = format!("d = {}: {} pitches", length(built.distance_m), format_number(here, 3));
    plot.markers.push(Marker { x: built.distance_m, y: here, label: "d".to_owned(), note });
    let exact = behaviour.geometry.aligned_distances(from_m, to_m).unwrap_or_default();
    let exact: Vec<String> = exact.iter().take(6).map(|a| length(a.centre_distance_m)).collect();
    let mut caption = "The cable comes back to the output n + 1 + (1 + R) inv γ/π pitches from where it left.".to_owned();
    if exact.is_empty() {
        caption += " No centre distance shown brings it exactly onto a groove.";
    } else {
        let _ = write!(caption, " It is exactly in line with a groove at {}.", exact.join(", "));
    }
    if let Ok(phase) = behaviour.geometry.aligning_phase_rad(0) {
        let _ = write!(
            caption,
            " At the centre distance given a second group of grooves turned by {} is in line.",
            format_si(phase, &design.units.angle, 4)
        );
    }
    Some(figure("alignment", "Alignment of the grooves", caption, FigureContent::Plot(plot)))
}
