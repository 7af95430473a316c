//! Curves and figures of a result.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_beam::Point;
use forcewright_model::{
    Axis, Branch, Curve, Figure, FigureContent, HorizontalBand, HorizontalLine, Marker, Plot, Series, Stroke, VerticalSpan,
};

use crate::analysis::{Behaviour, Measured, RANGE_FRACTION};
use crate::design::Design;
use crate::scene::scene;
use crate::stack::Stack;

fn displacement_axis(design: &Design) -> Axis {
    Axis {
        name: "displacement",
        label: "Displacement Δ".to_owned(),
        dimension: Dimension::Length,
        display: design.units.displacement.clone(),
    }
}

fn force_axis(design: &Design) -> Axis {
    Axis { name: "force", label: "Force F".to_owned(), dimension: Dimension::Force, display: design.units.force.clone() }
}

fn stress_axis(design: &Design) -> Axis {
    Axis { name: "stress", label: "Largest stress |σ|".to_owned(), dimension: Dimension::Stress, display: design.units.stress.clone() }
}

/// For each beam +1 if its end is nearer to the moved node than its start, along beams, else −1.
fn senses(design: &Design) -> Vec<f64> {
    let network = &design.network;
    let mut distance = vec![usize::MAX; network.nodes.len()];
    distance[design.load_node] = 0;
    // Each round reaches the nodes one beam further away.
    for round in 0..network.nodes.len() {
        for beam in &network.beams {
            for (from, to) in [(beam.start, beam.end), (beam.end, beam.start)] {
                if distance[from] == round && distance[to] == usize::MAX {
                    distance[to] = round + 1;
                }
            }
        }
    }
    network.beams.iter().map(|b| if distance[b.end] <= distance[b.start] { 1.0 } else { -1.0 }).collect()
}

/// Force that a beam passes on from its end to its start, in the sense of the load, whole layout, N.
fn beam_force_n(behaviour: &Behaviour, direction: [f64; 2], point: usize, beam: usize) -> f64 {
    let [h, v] = behaviour.path.points[point].beams[beam].force_n;
    behaviour.copies * (h * direction[0] + v * direction[1])
}

/// What the force is that of.
fn force_label(design: &Design) -> String {
    match (design.layout.repeats(), design.layout.mirror.is_some()) {
        (true, _) => "F, whole layout",
        (false, true) => "F, both halves",
        (false, false) => "F",
    }
    .to_owned()
}

/// Every curve of a result.
pub(crate) fn curves(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Curve> {
    let points = &behaviour.path.points;
    let x: Vec<f64> = points.iter().map(|p| behaviour.delta_m(p)).collect();
    let one = |name: &'static str, label: &str, dimension: Dimension, display: Unit, y: Vec<f64>| Curve {
        name,
        x: displacement_axis(design),
        y: Axis { name, label: label.to_owned(), dimension, display },
        branches: vec![Branch { name: "loading".to_owned(), x: x.clone(), y }],
    };
    let all = |f: fn(&Behaviour, &Point) -> f64| points.iter().map(|p| f(behaviour, p)).collect::<Vec<_>>();
    let millijoule = Unit::parse("mJ").unwrap_or_else(|_| Unit::si(Dimension::Energy));
    let stress: Vec<f64> = points.iter().map(|p| p.peak_stress().map_or(f64::NAN, |(_, s)| s.stress_pa)).collect();
    let mut curves = vec![
        Curve { y: force_axis(design), ..one("force", "Force F", Dimension::Force, design.units.force.clone(), all(Behaviour::force_n)) },
        one("stiffness", "Stiffness dF/dΔ", Dimension::Stiffness, design.units.stiffness.clone(), all(Behaviour::stiffness_n_per_m)),
        Curve { y: stress_axis(design), ..one("stress", "", Dimension::Stress, design.units.stress.clone(), stress) },
        one("energy", "Elastic energy U", Dimension::Energy, millijoule, all(Behaviour::energy_j)),
    ];
    curves.extend(crate::scenario::curves(design, measured));
    curves.extend(crate::scenario::lateral::curves(design, behaviour));
    curves
}

/// Every figure of a report.
pub(crate) fn figures(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Figure> {
    let mut all = vec![Figure {
        id: "mechanism",
        title: "Mechanism".to_owned(),
        caption: "Outline: as made. Colour: largest stress over both faces at the end of the path, on a scale that ends at the allowed stress or above.".to_owned(),
        content: FigureContent::Scene(scene(design, behaviour, measured)),
    }];
    if behaviour.curve.is_some() {
        all.push(force_figure(design, behaviour, measured));
        all.extend(crate::scenario::figures(design, measured));
        all.extend(crate::scenario::lateral::figures(design, behaviour));
        all.extend(behaviour.stack.as_ref().filter(|s| s.apart_from_m.is_some()).map(|s| layers_figure(design, behaviour, s)));
        all.push(stress_figure(design, behaviour, measured));
        if design.network.beams.len() > 1 {
            all.push(beam_forces_figure(design, behaviour));
        }
    }
    all
}

fn force_figure(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Figure {
    let points = &behaviour.path.points;
    let (length, force) = (&design.units.displacement, &design.units.force);
    let mut bands = Vec::new();
    let mut caption = String::new();
    if let Some((band, nominal)) = design.requirements.as_ref().and_then(|r| r.force) {
        let level = nominal.or(measured.get("flat_force"));
        if let Some(level) = level {
            let percent = format_number(100.0 * band, 3);
            let what = if nominal.is_some() { "required" } else { "free level" };
            bands.push(HorizontalBand {
                from: level * (1.0 - band),
                to: level * (1.0 + band),
                extent: None,
                label: format!("{} ± {percent} % ({what})", format_si(level, force, 4)),
            });
        }
    }
    let mut spans = Vec::new();
    let banded = design.requirements.as_ref().is_some_and(|r| r.force.is_some());
    if let Some(usable) = measured.usable.filter(|_| banded) {
        spans.push(VerticalSpan {
            from: usable.start,
            to: usable.end,
            label: format!("inside the band: {}", format_si(usable.length(), length, 4)),
            hatched: false,
        });
        caption = format!(
            "The force stays inside the band from {} to {}. ",
            format_si(usable.start, length, 4),
            format_si(usable.end, length, 4)
        );
    }
    let mut markers = Vec::new();
    if let (Some(c), Some(end)) = (measured.get("range_start"), measured.get("force_at_end")) {
        let fraction = format_number(100.0 * RANGE_FRACTION, 3);
        let d = points.last().map_or(f64::NAN, |p| behaviour.delta_m(p));
        markers.push(Marker {
            x: c,
            y: RANGE_FRACTION * end,
            label: "c".to_owned(),
            note: format!("c = {}: F last rises through {fraction} % of its end value", format_si(c, length, 4)),
        });
        markers.push(Marker {
            x: d,
            y: end,
            label: "d".to_owned(),
            note: format!("d = {}: end of the travel, F = {}", format_si(d, length, 4), format_si(end, force, 4)),
        });
    }
    if let (Some(x), Some(f)) = (measured.get("force_local_max_at"), measured.get("force_local_max")) {
        let _ = write!(
            caption,
            "Local maximum {} at {}: from there a force-driven device would jump. ",
            format_si(f, force, 4),
            format_si(x, length, 4)
        );
    }
    if !markers.is_empty() {
        caption.push_str("c and d are the limits of the operational range as Lan, Wang & Chen define it.");
    }
    let series = Series {
        label: force_label(design),
        x: points.iter().map(|p| behaviour.delta_m(p)).collect(),
        y: points.iter().map(|p| behaviour.force_n(p)).collect(),
        stroke: Stroke::Main,
    };
    let plot = Plot {
        x: displacement_axis(design),
        y: force_axis(design),
        series: vec![series],
        bands,
        levels: Vec::new(),
        spans,
        markers,
        from_zero: true,
    };
    Figure { id: "force", title: "Force over displacement".to_owned(), caption, content: FigureContent::Plot(plot) }
}

fn stress_figure(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Figure {
    let points = &behaviour.path.points;
    let x: Vec<f64> = points.iter().map(|p| behaviour.delta_m(p)).collect();
    let mut levels = Vec::new();
    if let Some(allowed) = design.common_allowable_pa() {
        levels.push(HorizontalLine {
            at: allowed,
            label: format!("allowed: {}", format_si(allowed, &design.units.stress, 4)),
            stroke: Stroke::Limit,
        });
    }
    for material in &design.materials {
        let Some(yield_pa) = material.yield_pa else { continue };
        let of = material.name.as_ref().filter(|_| design.materials.len() > 1).map_or_else(String::new, |name| format!(" of {name}"));
        levels.push(HorizontalLine {
            at: yield_pa,
            label: format!("yield{of}: {}", format_si(yield_pa, &design.units.stress, 4)),
            stroke: Stroke::Reference,
        });
    }
    // The beams that ever carry the largest stress, at most three; the envelope of all of them is the first line.
    let envelope = Series {
        label: "largest of all beams".to_owned(),
        x: x.clone(),
        y: points.iter().map(|p| p.peak_stress().map_or(f64::NAN, |(_, s)| s.stress_pa)).collect(),
        stroke: Stroke::Main,
    };
    let markers = measured.stress.map(|s| Marker {
        x: s.at_m,
        y: s.peak.stress_pa,
        label: "max".to_owned(),
        note: format!(
            "max = {} in beam {} at u = {}, Δ = {}",
            format_si(s.peak.stress_pa, &design.units.stress, 4),
            design.beam_names.get(s.beam).map_or("?", String::as_str),
            format_number(s.peak.u, 3),
            format_si(s.at_m, &design.units.displacement, 4)
        ),
    });
    let plot = Plot {
        x: displacement_axis(design),
        y: stress_axis(design),
        series: vec![envelope],
        bands: Vec::new(),
        levels,
        spans: Vec::new(),
        markers: markers.into_iter().collect(),
        from_zero: true,
    };
    let caption = match measured.get("travel_at_allowable_stress") {
        Some(x) => format!("The stress reaches what is allowed at Δ = {}.", format_si(x, &design.units.displacement, 4)),
        None => "Largest stress over all beams and both faces.".to_owned(),
    };
    Figure { id: "stress", title: "Stress over displacement".to_owned(), caption, content: FigureContent::Plot(plot) }
}

/// Where layers in series part, and the force that they then have.
fn layers_figure(design: &Design, behaviour: &Behaviour, stack: &Stack) -> Figure {
    let series = |label: &str, x: &[f64], y: &[f64], stroke| Series { label: label.to_owned(), x: x.to_vec(), y: y.to_vec(), stroke };
    let points = &behaviour.path.points;
    let alike: [Vec<f64>; 2] =
        [points.iter().map(|p| behaviour.delta_m(p)).collect(), points.iter().map(|p| behaviour.force_n(p)).collect()];
    let plot = Plot {
        x: displacement_axis(design),
        y: force_axis(design),
        series: vec![
            series("all alike", &alike[0], &alike[1], Stroke::Reference),
            series("forth", &stack.loading[0], &stack.loading[1], Stroke::Main),
            series("back", &stack.unloading[0], &stack.unloading[1], Stroke::Second),
        ],
        bands: Vec::new(),
        levels: Vec::new(),
        spans: Vec::new(),
        markers: Vec::new(),
        from_zero: true,
    };
    let from = stack.apart_from_m.map_or_else(String::new, |x| format_si(x, &design.units.displacement, 4));
    let caption = format!(
        "From Δ = {from} on the layers do not move alike: where its force falls, one runs ahead and the others spring back. Slowly moved forth and back; a layer at the end of its travel stays there, as at a stop."
    );
    Figure { id: "layers", title: "Layers in series".to_owned(), caption, content: FigureContent::Plot(plot) }
}

fn beam_forces_figure(design: &Design, behaviour: &Behaviour) -> Figure {
    let strokes = [Stroke::Main, Stroke::Second, Stroke::Third, Stroke::Reference];
    let x: Vec<f64> = behaviour.path.points.iter().map(|p| behaviour.delta_m(p)).collect();
    let senses = senses(design);
    // More lines than line styles would be unreadable: the beams with the largest forces are shown.
    let mut beams: Vec<(usize, Vec<f64>)> = (0..design.network.beams.len())
        .map(|b| (b, (0..x.len()).map(|p| senses[b] * beam_force_n(behaviour, design.direction, p, b)).collect()))
        .collect();
    let largest = |y: &[f64]| y.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    beams.sort_by(|a, b| largest(&b.1).total_cmp(&largest(&a.1)).then(a.0.cmp(&b.0)));
    beams.truncate(strokes.len());
    beams.sort_by_key(|(b, _)| *b);
    let series = beams
        .into_iter()
        .zip(strokes)
        .map(|((b, y), stroke)| Series {
            label: format!("beam {}", design.beam_names.get(b).map_or("?", String::as_str)),
            x: x.clone(),
            y,
            stroke,
        })
        .collect();
    let y = Axis { label: "Force along the load".to_owned(), ..force_axis(design) };
    let plot = Plot {
        x: displacement_axis(design),
        y,
        series,
        bands: Vec::new(),
        levels: Vec::new(),
        spans: Vec::new(),
        markers: Vec::new(),
        from_zero: true,
    };
    Figure {
        id: "beam-forces",
        title: "Force carried by each beam".to_owned(),
        caption: "What each beam passes on from the load towards the ground, along the load, whole layout. Beams that take turns in rising and falling make the sum constant.".to_owned(),
        content: FigureContent::Plot(plot),
    }
}
