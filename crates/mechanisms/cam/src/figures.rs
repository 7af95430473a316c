//! Curves and figures of a result.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_model::{Axis, BarRow, Bars, Branch, Curve, Figure, FigureContent, HorizontalBand, Plot, Series, Stroke, VerticalSpan};

use crate::analysis::{Behaviour, Measured, Station, pressure_angle};
use crate::design::Design;
use crate::law::ForceLaw;
use crate::motion::Moment;
use crate::path::curvature_per_m;
use crate::scene::{comb, film};

fn travel_axis(design: &Design) -> Axis {
    Axis { name: "travel", label: "Travel s".to_owned(), dimension: Dimension::Length, display: design.units.travel.clone() }
}

fn force_axis(design: &Design, name: &'static str, label: &str) -> Axis {
    Axis { name, label: label.to_owned(), dimension: Dimension::Force, display: design.units.force.clone() }
}

fn time_axis(design: &Design) -> Axis {
    Axis { name: "time", label: "Time t".to_owned(), dimension: Dimension::Time, display: design.units.time.clone() }
}

fn lengths(design: &Design, name: &'static str, label: &str) -> Axis {
    Axis { name, label: label.to_owned(), dimension: Dimension::Length, display: design.units.length.clone() }
}

fn over_travel(behaviour: &Behaviour, name: &str, value: impl Fn(&Station) -> f64) -> Branch {
    Branch {
        name: name.to_owned(),
        x: behaviour.stations.iter().map(|s| s.travel_m).collect(),
        y: behaviour.stations.iter().map(value).collect(),
    }
}

/// Every curve of a result.
pub(crate) fn curves(design: &Design, behaviour: &Behaviour) -> Vec<Curve> {
    if behaviour.stations.is_empty() {
        return Vec::new();
    }
    let one = |name: &str, value: &dyn Fn(&Station) -> f64| over_travel(behaviour, name, value);
    let angle = Axis {
        name: "pressure_angle",
        label: "Pressure angle".to_owned(),
        dimension: Dimension::Angle,
        display: design.units.angle.clone(),
    };
    let mut all = vec![
        Curve {
            name: "force",
            x: travel_axis(design),
            y: force_axis(design, "force", "Force F"),
            branches: vec![one("up", &|s| s.up.force_n), one("down", &|s| s.down.force_n), one("without_friction", &|s| s.still.force_n)],
        },
        Curve {
            name: "spring_length",
            x: travel_axis(design),
            y: lengths(design, "spring_length", "Length of the springs"),
            branches: vec![one("without_friction", &|s| s.still.spring_m)],
        },
        Curve {
            name: "contact_force",
            x: travel_axis(design),
            y: force_axis(design, "contact_force", "Normal force N"),
            branches: vec![
                one("right_up", &|s| s.up.sides[0].normal_n),
                one("left_up", &|s| s.up.sides[1].normal_n),
                one("right_down", &|s| s.down.sides[0].normal_n),
                one("left_down", &|s| s.down.sides[1].normal_n),
            ],
        },
        Curve {
            name: "guide_force",
            x: travel_axis(design),
            y: force_axis(design, "guide_force", "Guide force"),
            branches: vec![one("up", &|s| s.up.guide_n), one("down", &|s| s.down.guide_n)],
        },
        Curve {
            name: "pressure_angle",
            x: travel_axis(design),
            y: angle,
            branches: vec![one("without_friction", &|s| pressure_angle(behaviour, s))],
        },
    ];
    if design.free_guide {
        all.push(Curve {
            name: "sideways",
            x: travel_axis(design),
            y: lengths(design, "sideways", "Way of the slider sideways"),
            branches: vec![one("up", &|s| s.sideways_m[1]), one("down", &|s| s.sideways_m[2])],
        });
    }
    all.extend(motion_curves(design, behaviour));
    all.extend(crate::profile_figures::curve(design, behaviour));
    all
}

fn motion_curves(design: &Design, behaviour: &Behaviour) -> Vec<Curve> {
    let Some(motion) = &behaviour.motion else { return Vec::new() };
    let time: Vec<f64> = motion.iter().map(|m| m.time_s).collect();
    let branch = |name: &str, value: &dyn Fn(&Moment) -> f64| Branch {
        name: name.to_owned(),
        x: time.clone(),
        y: motion.iter().map(value).collect(),
    };
    vec![
        Curve {
            name: "motion_force",
            x: time_axis(design),
            y: force_axis(design, "force", "Force F"),
            branches: vec![branch("moving", &|m| m.moving.force_n), branch("at_rest", &|m| m.resting.force_n)],
        },
        Curve { name: "motion_travel", x: time_axis(design), y: travel_axis(design), branches: vec![branch("moving", &|m| m.travel_m)] },
        Curve {
            name: "motion_contact_force",
            x: time_axis(design),
            y: force_axis(design, "contact_force", "Normal force N"),
            branches: vec![branch("right", &|m| m.moving.sides[0].normal_n), branch("left", &|m| m.moving.sides[1].normal_n)],
        },
    ]
}

/// Rows of a bar chart.
const BARS: usize = 12;

/// Every figure of a report.
pub(crate) fn figures(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Figure> {
    if behaviour.stations.is_empty() {
        return Vec::new();
    }
    let mut all: Vec<Figure> = mechanism_figure(design, behaviour).into_iter().collect();
    all.push(force_figure(design, behaviour, measured));
    all.extend(sensitivity_figure(design, behaviour, measured));
    all.extend(motion_figure(design, behaviour, measured));
    all.push(profile_figure(design, behaviour));
    all.push(curvature_figure(design, behaviour));
    all.push(contact_figure(design, behaviour));
    all.extend(crate::profile_figures::figure(design, behaviour));
    all
}

fn mechanism_figure(design: &Design, behaviour: &Behaviour) -> Option<Figure> {
    let film = film(design, behaviour, travel_axis(design))?;
    Some(Figure {
        id: "mechanism",
        title: "Mechanism over its travel".to_owned(),
        caption: "Choose a travel below the picture. The arrow is as long as the force without friction is large.".to_owned(),
        content: FigureContent::Film(film),
    })
}

fn profile_figure(design: &Design, behaviour: &Behaviour) -> Figure {
    Figure {
        id: "profile",
        title: "Profile of the cam and curvature of the path".to_owned(),
        caption: "Lines across the path as it was meant, as long as it is curved there: where they pass the dashed line, the path is curved more sharply than the roller and the cam is undercut. The lower part of the right side, where it is curved most; lines beyond r/ϱ = 2 are cut off.".to_owned(),
        content: FigureContent::Scene(comb(design, behaviour)),
    }
}

fn series(behaviour: &Behaviour, label: &str, stroke: Stroke, value: impl Fn(&Station) -> f64) -> Series {
    let Branch { x, y, .. } = over_travel(behaviour, label, value);
    Series { label: label.to_owned(), x, y, stroke }
}

pub(crate) fn plot(x: Axis, y: Axis, series: Vec<Series>) -> Plot {
    Plot { x, y, series, bands: Vec::new(), levels: Vec::new(), spans: Vec::new(), markers: Vec::new(), from_zero: false }
}

/// Part of the height of a picture above and below what has to be seen in it.
const MARGIN: f64 = 0.15;

/// The forces that a picture shows, N: those over the window, the band that is required, and some room.
fn shown_n(design: &Design, behaviour: &Behaviour) -> [f64; 2] {
    let mut all: Vec<f64> = behaviour.window.iter().flat_map(|s| [s.up.force_n, s.down.force_n, s.still.force_n]).collect();
    if let Some((law, band)) = design.requirements.as_ref().and_then(|r| r.force.as_ref()) {
        all.extend(behaviour.window.iter().map(|s| law.force_n(s.travel_m)[0]).flat_map(|f| [f * (1.0 - band), f * (1.0 + band)]));
    }
    room_for(&all)
}

/// What has to be seen, and some room.
pub(crate) fn room_for(all: &[f64]) -> [f64; 2] {
    let finite = all.iter().filter(|f| f.is_finite());
    let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], f| [a.min(*f), b.max(*f)]);
    if low > high {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    // A force that hardly varies still shows some of its size.
    let room = (MARGIN * (high - low)).max(0.01 * high.abs().max(low.abs()));
    [low - room, high + room]
}

/// A line from the window outwards, as far as it stays within the picture: at the start of an undercut cam the force falls far below.
pub(crate) fn within(line: Series, window_m: [f64; 2], [low, high]: [f64; 2]) -> Series {
    let points: Vec<[f64; 2]> = line.x.iter().zip(&line.y).map(|(x, y)| [*x, *y]).collect();
    let first = points.partition_point(|p| p[0] < window_m[0]).min(points.len());
    let last = points.partition_point(|p| p[0] <= window_m[1]).max(first);
    let inside = |p: &[f64; 2]| (low..=high).contains(&p[1]);
    // Where the line leaves, between a point inside and its neighbour outside.
    let edge = |a: &[f64; 2], b: &[f64; 2]| {
        let y = b[1].clamp(low, high);
        [a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]), y]
    };
    let leaves = |outwards: &mut dyn Iterator<Item = &[f64; 2]>, from: Option<&[f64; 2]>| {
        let (mut kept, mut before) = (Vec::new(), from.copied());
        for p in outwards {
            if !inside(p) {
                kept.extend(before.map(|b| edge(&b, p)).filter(|p| p.iter().all(|v| v.is_finite())));
                break;
            }
            kept.push(*p);
            before = Some(*p);
        }
        kept
    };
    let mut all = leaves(&mut points[..first].iter().rev(), points.get(first));
    all.reverse();
    all.extend(&points[first..last]);
    all.extend(leaves(&mut points[last..].iter(), last.checked_sub(1).and_then(|i| points.get(i))));
    Series { x: all.iter().map(|p| p[0]).collect(), y: all.iter().map(|p| p[1]).collect(), ..line }
}

/// The loop over the window: up one way, down the other.
fn friction_loop(behaviour: &Behaviour) -> Series {
    let there = behaviour.window.iter().map(|s| [s.travel_m, s.up.force_n]);
    let back = behaviour.window.iter().rev().map(|s| [s.travel_m, s.down.force_n]);
    let (x, y) = there.chain(back).map(|[x, y]| (x, y)).unzip();
    Series { label: "lost in a cycle".to_owned(), x, y, stroke: Stroke::Area }
}

fn force_figure(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Figure {
    let force = &design.units.force;
    let shown = shown_n(design, behaviour);
    let line = |label: &str, stroke: Stroke, value: fn(&Station) -> f64| {
        within(series(behaviour, label, stroke, value), behaviour.window_m, shown)
    };
    let mut all = vec![line("without friction", Stroke::Reference, |s| s.still.force_n)];
    // Without friction both directions are the same line.
    if design.built.arm_m > 0.0 {
        all.insert(0, friction_loop(behaviour));
        all.push(line("down", Stroke::Second, |s| s.down.force_n));
        all.push(line("up", Stroke::Main, |s| s.up.force_n));
    } else {
        all[0].stroke = Stroke::Main;
    }
    let mut plot = plot(travel_axis(design), force_axis(design, "force", "Force F"), all);
    require(design, behaviour, &mut plot);
    let [from, to] = behaviour.window_m;
    plot.spans.push(VerticalSpan { from, to, label: "window".to_owned(), hatched: false });
    let mut caption = "The force on the slider at rest, moving along its travel and back.".to_owned();
    if let (Some(area), Some(up), Some(down)) = (measured.get("loop_area"), measured.get("force_up_mean"), measured.get("force_down_mean"))
    {
        let joule = Unit::parse("J").unwrap_or_else(|_| Unit::si(Dimension::Energy));
        let _ = write!(
            caption,
            " Over the window {} up and {} down in the mean; a cycle loses {}.",
            format_si(up, force, 4),
            format_si(down, force, 4),
            format_si(area, &joule, 3)
        );
    }
    let outside = behaviour.stations.iter().map(|s| s.still.force_n).filter(|f| !(shown[0]..=shown[1]).contains(f));
    let [least, most] = outside.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], f| [a.min(f), b.max(f)]);
    if least < shown[0] {
        let _ = write!(caption, " Outside the window it falls to {}, below the picture.", format_si(least, force, 3));
    }
    if most > shown[1] {
        let _ = write!(caption, " Outside the window it rises to {}, above the picture.", format_si(most, force, 3));
    }
    Figure { id: "force", title: "Force over the travel".to_owned(), caption, content: FigureContent::Plot(plot) }
}

/// The force that is required, as a band or, where it is not the same everywhere, as its edges.
fn require(design: &Design, behaviour: &Behaviour, plot: &mut Plot) {
    let Some((law, band)) = design.requirements.as_ref().and_then(|r| r.force.as_ref()) else { return };
    let travels: Vec<f64> = behaviour.window.iter().map(|s| s.travel_m).collect();
    require_law((law, *band), &travels, behaviour.window_m, &design.units.force, plot);
}

/// The same of any law, at places of a window.
pub(crate) fn require_law((law, band): (&ForceLaw, f64), places: &[f64], window: [f64; 2], unit: &Unit, plot: &mut Plot) {
    let percent = format_number(100.0 * band, 3);
    if law.is_constant() {
        let [level, _] = law.force_n(0.0);
        plot.bands.push(HorizontalBand {
            from: level * (1.0 - band),
            to: level * (1.0 + band),
            extent: Some((window[0], window[1])),
            label: format!("{} ± {percent} % (required)", format_si(level, unit, 4)),
        });
        return;
    }
    for (sign, label) in [(1.0 + band, format!("required + {percent} %")), (1.0 - band, format!("required − {percent} %"))] {
        let points = places.iter().map(|s| (*s, sign * law.force_n(*s)[0]));
        let (x, y) = points.unzip();
        plot.series.push(Series { label, x, y, stroke: Stroke::Limit });
    }
}

/// What each `±` of the file does to the force, the largest first.
fn sensitivity_figure(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Option<Figure> {
    let effects = design.scatter.as_ref()?.effects(design, behaviour);
    let mean = f64::midpoint(measured.get("force_up_mean")?, measured.get("force_down_mean")?);
    let all = effects.len();
    let mut rows: Vec<BarRow> =
        effects.into_iter().map(|e| BarRow { label: e.label, ends: vec![e.mean_n.map(|n| n / mean), e.deviation] }).collect();
    rows.retain(|row| row.ends.iter().flatten().all(|v| v.is_finite()));
    let reach = |row: &BarRow| row.ends.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    rows.sort_by(|a, b| reach(b).total_cmp(&reach(a)));
    rows.truncate(BARS);
    if rows.is_empty() {
        return None;
    }
    let left = all - rows.len();
    let required = design.requirements.as_ref().is_some_and(|r| r.force.is_some());
    let deviation =
        if required { "largest deviation of the force from what is required" } else { "half width of the band that the force needs" };
    let percent = Unit::parse("%").unwrap_or_else(|_| Unit::si(Dimension::Ratio));
    let axis = Axis { name: "change", label: "Change".to_owned(), dimension: Dimension::Ratio, display: percent };
    let mut caption =
        "One number at the lower end of its tolerance (outlined) and at the upper end (filled), all others as they are, on the same cam."
            .to_owned();
    if left > 0 {
        let _ = write!(caption, " {left} more {}.", if left == 1 { "is left out" } else { "are left out" });
    }
    Some(Figure {
        id: "sensitivity",
        title: "What each tolerance does to the force".to_owned(),
        caption,
        content: FigureContent::Bars(Bars {
            axis,
            series: vec![("mean force, up and down, of itself".to_owned(), Stroke::Main), (deviation.to_owned(), Stroke::Second)],
            rows,
        }),
    })
}

fn motion_figure(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Option<Figure> {
    let motion = behaviour.motion.as_ref()?;
    let line = |label: &str, stroke: Stroke, value: fn(&Moment) -> f64| Series {
        label: label.to_owned(),
        x: motion.iter().map(|m| m.time_s).collect(),
        y: motion.iter().map(value).collect(),
        stroke,
    };
    let all = vec![
        line("at rest at the same place", Stroke::Reference, |m| m.resting.force_n),
        line("in the motion", Stroke::Main, |m| m.moving.force_n),
    ];
    let mut plot = plot(time_axis(design), force_axis(design, "force", "Force F"), all);
    plot.from_zero = true;
    let peak = measured
        .get("peak_force_ratio")
        .map_or_else(String::new, |p| format!(" At most {} % above the force at rest at the same place.", format_number(100.0 * p, 4)));
    Some(Figure {
        id: "motion",
        title: "Force in the motion".to_owned(),
        caption: format!("What pulls the slider while it moves.{peak}"),
        content: FigureContent::Plot(plot),
    })
}

fn curvature_figure(design: &Design, behaviour: &Behaviour) -> Figure {
    let path = &behaviour.mechanism.paths[0];
    let sense = behaviour.mechanism.springs.sense();
    let [from, to] = behaviour.cut.range_m();
    let points: Vec<[f64; 2]> = (0..=240)
        .map(|i| {
            let u = f64::from(i) / 240.0;
            let lambda = from + (to - from) * u * u;
            let ratio = design.cut_roller_m * curvature_per_m(&path.designed(lambda), sense);
            [behaviour.cut.at(0, lambda).s.value(), ratio]
        })
        .collect();
    let ratio = Axis {
        name: "roller_over_curvature_radius",
        label: "Roller radius over the path's radius of curvature, r/ϱ".to_owned(),
        dimension: Dimension::Ratio,
        display: Unit::si(Dimension::Ratio),
    };
    let line = Series {
        label: "r/ϱ".to_owned(),
        x: points.iter().map(|p| p[0]).collect(),
        y: points.iter().map(|p| p[1]).collect(),
        stroke: Stroke::Main,
    };
    let mut plot = plot(travel_axis(design), ratio, vec![line]);
    plot.from_zero = true;
    plot.levels.push(forcewright_model::HorizontalLine { at: 1.0, label: "undercut above".to_owned(), stroke: Stroke::Limit });
    Figure {
        id: "curvature",
        title: "Curvature of the path".to_owned(),
        caption: "Above one, the roller is larger than the path allows: the cam is undercut there.".to_owned(),
        content: FigureContent::Plot(plot),
    }
}

fn contact_figure(design: &Design, behaviour: &Behaviour) -> Figure {
    let all = vec![
        series(behaviour, "roller on cam, up", Stroke::Main, |s| s.up.sides[0].normal_n.max(s.up.sides[1].normal_n)),
        series(behaviour, "brace, up", Stroke::Second, |s| s.up.sides[0].brace_n.max(s.up.sides[1].brace_n)),
        series(behaviour, "springs", Stroke::Third, |s| s.up.spring_n.abs()),
    ];
    let mut plot = plot(travel_axis(design), force_axis(design, "force", "Force"), all);
    plot.from_zero = true;
    Figure {
        id: "contact",
        title: "Forces in the mechanism".to_owned(),
        caption: "Normal force between roller and cam and tension of the brace, of the side that has more; force of all springs."
            .to_owned(),
        content: FigureContent::Plot(plot),
    }
}
