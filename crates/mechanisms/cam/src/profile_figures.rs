//! What a report shows of a profile that was measured, or is drawn at random.

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_model::{Axis, Branch, Curve, Figure, FigureContent, Plot, Series, Statement, Stroke, Warning};

use crate::analysis::Behaviour;
use crate::cut::SIDES;
use crate::design::Design;

/// Places along the profile.
const PLACES: u32 = 400;
const NAMES: [&str; SIDES] = ["right", "left"];

fn micrometre() -> Unit {
    Unit::parse("µm").unwrap_or_else(|_| Unit::si(Dimension::Length))
}

/// Travel and deviation along the profile of a side, SI; `None` where it has none.
fn deviation(behaviour: &Behaviour, side: usize) -> Option<[Vec<f64>; 2]> {
    let path = &behaviour.mechanism.paths[side];
    let [from, to] = behaviour.cut.range_m();
    let start = path.corner().map_or(from, |c| c.lambda_m);
    let mut all = [Vec::new(), Vec::new()];
    for i in 0..=PLACES {
        let lambda = start + (to - start) * f64::from(i) / f64::from(PLACES);
        all[0].push(behaviour.cut.at(side, lambda).s.value());
        all[1].push(path.error_m(lambda)?);
    }
    Some(all)
}

fn axes(design: &Design) -> [Axis; 2] {
    [
        Axis { name: "travel", label: "Travel s".to_owned(), dimension: Dimension::Length, display: design.units.travel.clone() },
        Axis { name: "profile_error", label: "Deviation of the profile".to_owned(), dimension: Dimension::Length, display: micrometre() },
    ]
}

/// Deviation of each side over the travel.
pub(crate) fn curve(design: &Design, behaviour: &Behaviour) -> Option<Curve> {
    let branches: Vec<Branch> = (0..SIDES)
        .filter_map(|side| {
            let [x, y] = deviation(behaviour, side)?;
            Some(Branch { name: NAMES[side].to_owned(), x, y })
        })
        .collect();
    let [x, y] = axes(design);
    (!branches.is_empty()).then_some(Curve { name: "profile_error", x, y, branches })
}

/// The same as a figure, with the points that were measured.
pub(crate) fn figure(design: &Design, behaviour: &Behaviour) -> Option<Figure> {
    let mut series = Vec::new();
    if let Some(measured) = &design.built.measured {
        for (side, points) in measured.points.iter().enumerate().filter(|(_, p)| !p.is_empty()) {
            series.push(Series {
                label: format!("measured, {}", NAMES[side]),
                x: points.iter().map(|p| p[0]).collect(),
                y: points.iter().map(|p| p[1]).collect(),
                stroke: Stroke::Reference,
            });
        }
    }
    for (side, stroke) in [Stroke::Main, Stroke::Second].into_iter().enumerate() {
        if let Some([x, y]) = deviation(behaviour, side) {
            series.push(Series { label: NAMES[side].to_owned(), x, y, stroke });
        }
    }
    let [x, y] = axes(design);
    let plot = Plot { x, y, series, bands: Vec::new(), levels: Vec::new(), spans: Vec::new(), markers: Vec::new(), from_zero: false };
    let shown = !plot.series.is_empty();
    shown.then(|| Figure {
        id: "profile_error",
        title: "Deviation of the profile".to_owned(),
        caption: "Along the normal, outwards, from the profile that was meant; dashed what was measured. The force follows its slope."
            .to_owned(),
        content: FigureContent::Plot(plot),
    })
}

/// How measured points were brought to the design.
pub(crate) fn statement(design: &Design) -> Option<Statement> {
    let fit = &design.built.measured.as_ref()?.registration;
    let (unit, mm) = (micrometre(), &design.units.length);
    let count: usize = fit.points.iter().map(Vec::len).sum();
    let degrees = |rad: f64| format_number(rad.to_degrees(), 4);
    Some(Statement {
        title: "Measured profile".to_owned(),
        text: format!(
            "{count} points, both sides as one rigid body, were turned by {}° (± {}°) and shifted by {} and {} (± {} and {}) onto the design, with Tukey's weights; {} are outliers. The rest deviates by {} (weighted root mean square). What is left along the normal is smoothed by a spline of fifth degree and laid on the exact path.",
            degrees(fit.angle_rad),
            degrees(fit.angle_deviation_rad),
            format_si(fit.shift_m[0], mm, 4),
            format_si(fit.shift_m[1], mm, 4),
            format_si(fit.shift_deviation_m[0], &unit, 2),
            format_si(fit.shift_deviation_m[1], &unit, 2),
            fit.outliers().count(),
            format_si(fit.weighted_rms_m, &unit, 3)
        ),
    })
}

/// A window that reaches beyond what was measured.
pub(crate) fn uncovered(design: &Design, behaviour: &Behaviour) -> Option<Warning> {
    let measured = design.built.measured.as_ref()?;
    let [from, to] = behaviour.window_m;
    let reach = measured.points.iter().filter(|points| !points.is_empty()).map(|points| [points[0][0], points[points.len() - 1][0]]);
    let [first, last] = reach.fold([0.0, f64::INFINITY], |[a, b]: [f64; 2], [c, d]| [a.max(c), b.min(d)]);
    let shown = |s: f64| format_si(s, &design.units.travel, 4);
    // A millimetre is no more than the distance of points.
    (from < first - 1e-3 || to > last + 1e-3).then(|| Warning {
        code: "W0606",
        message: format!(
            "the profile was measured from a travel of {} to {}, the window goes from {} to {}: outside, the deviation of the last point is kept",
            shown(first),
            shown(last),
            shown(from),
            shown(to)
        ),
    })
}

/// Outliers, and a fit that did not come to rest.
pub(crate) fn warning(design: &Design) -> Option<Warning> {
    let fit = &design.built.measured.as_ref()?.registration;
    let (outliers, count) = (fit.outliers().count(), fit.points.iter().map(Vec::len).sum::<usize>());
    let unrest = if fit.converged { "" } else { "; the motion that brings them to the design did not come to rest" };
    (outliers > 0 || !fit.converged).then(|| Warning {
        code: "W0605",
        message: format!("{outliers} of {count} measured points do not belong to the profile and were left out{unrest}"),
    })
}
