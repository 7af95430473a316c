//! Curves and figures of a result.

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_model::{Axis, Branch, Curve, Figure, FigureContent, HorizontalBand, Plot, Series, Stroke, VerticalSpan};

use crate::analysis::{Behaviour, Measured, Station, pressure_angle};
use crate::design::Design;
use crate::motion::Moment;
use crate::path::curvature_per_m;
use crate::scene::scene;

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

/// Every figure of a report.
pub(crate) fn figures(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Figure> {
    if behaviour.stations.is_empty() {
        return Vec::new();
    }
    let middle = &behaviour.stations[behaviour.stations.len() / 2];
    let mut all = vec![Figure {
        id: "mechanism",
        title: "Mechanism".to_owned(),
        caption: format!("At a travel of {}, in the middle of the stroke.", format_si(middle.travel_m, &design.units.travel, 4)),
        content: FigureContent::Scene(scene(design, behaviour, middle)),
    }];
    all.push(force_figure(design, behaviour, measured));
    all.extend(motion_figure(design, behaviour, measured));
    all.push(curvature_figure(design, behaviour));
    all.push(contact_figure(design, behaviour));
    all.extend(crate::profile_figures::figure(design, behaviour));
    all
}

fn series(behaviour: &Behaviour, label: &str, stroke: Stroke, value: impl Fn(&Station) -> f64) -> Series {
    let Branch { x, y, .. } = over_travel(behaviour, label, value);
    Series { label: label.to_owned(), x, y, stroke }
}

fn plot(x: Axis, y: Axis, series: Vec<Series>) -> Plot {
    Plot { x, y, series, bands: Vec::new(), levels: Vec::new(), spans: Vec::new(), markers: Vec::new(), from_zero: false }
}

fn force_figure(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Figure {
    let force = &design.units.force;
    let mut all = vec![series(behaviour, "without friction", Stroke::Reference, |s| s.still.force_n)];
    // Without friction both directions are the same line.
    if design.built.arm_m > 0.0 {
        all.push(series(behaviour, "down", Stroke::Second, |s| s.down.force_n));
        all.push(series(behaviour, "up", Stroke::Main, |s| s.up.force_n));
    }
    let mut plot = plot(travel_axis(design), force_axis(design, "force", "Force F"), all);
    if let Some((law, band)) = design.requirements.as_ref().and_then(|r| r.force.as_ref()) {
        let percent = format_number(100.0 * band, 3);
        if law.is_constant() {
            let [level, _] = law.force_n(0.0);
            plot.bands.push(HorizontalBand {
                from: level * (1.0 - band),
                to: level * (1.0 + band),
                extent: Some((behaviour.window_m[0], behaviour.window_m[1])),
                label: format!("{} ± {percent} % (required)", format_si(level, force, 4)),
            });
        } else {
            for (sign, label) in [(1.0 + band, format!("required + {percent} %")), (1.0 - band, format!("required − {percent} %"))] {
                plot.series.push(series(behaviour, &label, Stroke::Limit, |s| sign * law.force_n(s.travel_m)[0]));
            }
        }
    }
    let [from, to] = behaviour.window_m;
    plot.spans.push(VerticalSpan { from, to, label: "window".to_owned() });
    let mut caption = "The force on the slider at rest, moving along its travel and back.".to_owned();
    if let (Some(area), Some(up), Some(down)) = (measured.get("loop_area"), measured.get("force_up_mean"), measured.get("force_down_mean"))
    {
        let joule = Unit::parse("J").unwrap_or_else(|_| Unit::si(Dimension::Energy));
        caption.push_str(&format!(
            " Over the window {} up and {} down in the mean; a cycle loses {}.",
            format_si(up, force, 4),
            format_si(down, force, 4),
            format_si(area, &joule, 3)
        ));
    }
    Figure { id: "force", title: "Force over the travel".to_owned(), caption, content: FigureContent::Plot(plot) }
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
