//! Curves and figures of a result.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_model::{Axis, Branch, Curve, Figure, FigureContent, HorizontalLine, Series, Stroke, VerticalSpan};

use super::analysis::{Behaviour, Station, pressure_angle};
use super::design::Design;
use super::motion::Moment;
use super::scene::{comb, film};
use crate::analysis::Measured;
use crate::figures::{plot, require_law, room_for, within};
use crate::path::curvature_per_m;

fn turn_axis(design: &Design) -> Axis {
    Axis { name: "turn", label: "Turn θ".to_owned(), dimension: Dimension::Angle, display: design.units.travel.clone() }
}

fn torque_axis(design: &Design) -> Axis {
    Axis { name: "torque", label: "Torque T".to_owned(), dimension: Dimension::Torque, display: design.units.torque.clone() }
}

fn force_axis(design: &Design, name: &'static str, label: &str) -> Axis {
    Axis { name, label: label.to_owned(), dimension: Dimension::Force, display: design.units.force.clone() }
}

fn line(stations: &[Station], label: &str, stroke: Stroke, value: impl Fn(&Station) -> f64) -> Series {
    Series { label: label.to_owned(), x: stations.iter().map(Station::turn_rad).collect(), y: stations.iter().map(value).collect(), stroke }
}

/// Every curve of a result.
pub(crate) fn curves(design: &Design, behaviour: &Behaviour) -> Vec<Curve> {
    if behaviour.stations.is_empty() {
        return Vec::new();
    }
    let one = |name: &str, value: &dyn Fn(&Station) -> f64| {
        let Series { x, y, .. } = line(&behaviour.stations, name, Stroke::Main, value);
        Branch { name: name.to_owned(), x, y }
    };
    let lengths = Axis {
        name: "spring_length",
        label: "Length of the springs".to_owned(),
        dimension: Dimension::Length,
        display: design.units.length.clone(),
    };
    let angle = Axis {
        name: "pressure_angle",
        label: "Pressure angle".to_owned(),
        dimension: Dimension::Angle,
        display: design.units.angle.clone(),
    };
    let curve = |name, y, branches| Curve { name, x: turn_axis(design), y, branches };
    let mut all = vec![
        curve(
            "torque",
            torque_axis(design),
            vec![one("up", &|s| s.up.torque_nm), one("down", &|s| s.down.torque_nm), one("without_friction", &|s| s.still.torque_nm)],
        ),
        curve("spring_length", lengths, vec![one("without_friction", &|s| s.still.spring_m)]),
        curve(
            "contact_force",
            force_axis(design, "contact_force", "Normal force N"),
            vec![one("up", &|s| s.up.normal_n), one("down", &|s| s.down.normal_n)],
        ),
        curve(
            "guide_force",
            force_axis(design, "guide_force", "Guide force"),
            vec![one("up", &|s| s.up.guide_n), one("down", &|s| s.down.guide_n)],
        ),
        curve("pressure_angle", angle, vec![one("without_friction", &|s| pressure_angle(&behaviour.mechanism, s))]),
    ];
    all.extend(motion_curves(design, behaviour));
    all
}

fn over_time(motion: &[Moment], name: &str, value: impl Fn(&Moment) -> f64) -> Branch {
    Branch { name: name.to_owned(), x: motion.iter().map(|m| m.time_s).collect(), y: motion.iter().map(value).collect() }
}

fn time_axis(design: &Design) -> Axis {
    Axis { name: "time", label: "Time t".to_owned(), dimension: Dimension::Time, display: design.units.time.clone() }
}

fn motion_curves(design: &Design, behaviour: &Behaviour) -> Vec<Curve> {
    let Some(motion) = &behaviour.motion else { return Vec::new() };
    let curve = |name, y, branches| Curve { name, x: time_axis(design), y, branches };
    let both = vec![over_time(motion, "moving", |m| m.moving.torque_nm), over_time(motion, "at_rest", |m| m.resting.torque_nm)];
    vec![
        curve("motion_torque", torque_axis(design), both),
        curve("motion_turn", turn_axis(design), vec![over_time(motion, "moving", |m| m.turn_rad)]),
        curve(
            "motion_contact_force",
            force_axis(design, "contact_force", "Normal force N"),
            vec![over_time(motion, "moving", |m| m.moving.normal_n)],
        ),
    ]
}

fn motion_figure(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Option<Figure> {
    let motion = behaviour.motion.as_ref()?;
    let line = |label: &str, stroke: Stroke, value: fn(&Moment) -> f64| {
        let Branch { x, y, .. } = over_time(motion, label, value);
        Series { label: label.to_owned(), x, y, stroke }
    };
    let all = vec![
        line("at rest at the same place", Stroke::Reference, |m| m.resting.torque_nm),
        line("in the motion", Stroke::Main, |m| m.moving.torque_nm),
    ];
    let mut plot = plot(time_axis(design), torque_axis(design), all);
    plot.from_zero = true;
    let peak = measured
        .get("peak_torque_ratio")
        .map_or_else(String::new, |p| format!(" At most {} % above the torque at rest at the same place.", format_number(100.0 * p, 4)));
    Some(Figure {
        id: "motion",
        title: "Torque in the motion".to_owned(),
        caption: format!("What turns the shaft while it moves.{peak}"),
        content: FigureContent::Plot(plot),
    })
}

/// Every figure of a report.
pub(crate) fn figures(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Figure> {
    if behaviour.stations.is_empty() || behaviour.window.is_empty() {
        return Vec::new();
    }
    let mechanism = film(design, behaviour, turn_axis(design)).map(|film| Figure {
        id: "mechanism",
        title: "Mechanism over its turn".to_owned(),
        caption: if design.built.extension {
            "Choose a turn below the picture. The guides of the rollers stand still, the disc turns."
        } else {
            "Choose a turn below the picture. The guides of the rollers stand still, the ring turns; the line across it is only of the drawing."
        }
        .to_owned(),
        content: FigureContent::Film(film),
    });
    let profile = Figure {
        id: "profile",
        title: "Outline of the cam and curvature of the path".to_owned(),
        caption: "Lines across the path as it was meant, as long as it is curved there: where they pass the dashed line, the path is curved more sharply than the roller and the cam is undercut; lines towards the cam belong to a hollow path. Lines beyond r/ϱ = 2 are cut off. What lies between the lobes is used by no roller.".to_owned(),
        content: FigureContent::Scene(comb(design, behaviour)),
    };
    let rest =
        [torque_figure(design, behaviour, measured), profile, curvature_figure(design, behaviour), contact_figure(design, behaviour)];
    mechanism.into_iter().chain(rest).chain(motion_figure(design, behaviour, measured)).collect()
}

fn torque_figure(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Figure {
    let required = design.requirements.as_ref().and_then(|r| r.force.as_ref());
    let mut seen: Vec<f64> = behaviour.window.iter().flat_map(|s| [s.up.torque_nm, s.down.torque_nm, s.still.torque_nm]).collect();
    if let Some((law, band)) = required {
        let levels = behaviour.window.iter().map(|s| law.force_n(s.turn_rad())[0]);
        seen.extend(levels.flat_map(|t| [t * (1.0 - band), t * (1.0 + band)]));
    }
    let shown = room_for(&seen);
    let one = |label: &str, stroke: Stroke, value: fn(&Station) -> f64| {
        within(line(&behaviour.stations, label, stroke, value), behaviour.window_rad, shown)
    };
    let mut all = vec![one("without friction", Stroke::Reference, |s| s.still.torque_nm)];
    // Without friction both directions are the same line.
    if behaviour.mechanism.arm_m > 0.0 || behaviour.mechanism.guide_friction > 0.0 {
        let there = line(&behaviour.window, "lost in a cycle", Stroke::Area, |s| s.up.torque_nm);
        let back = line(&behaviour.window, "", Stroke::Area, |s| s.down.torque_nm);
        let joined = |a: Vec<f64>, b: Vec<f64>| a.into_iter().chain(b.into_iter().rev()).collect();
        all.insert(0, Series { x: joined(there.x, back.x), y: joined(there.y, back.y), label: there.label, stroke: Stroke::Area });
        all.push(one("down", Stroke::Second, |s| s.down.torque_nm));
        all.push(one("up", Stroke::Main, |s| s.up.torque_nm));
    } else {
        all[0].stroke = Stroke::Main;
    }
    let mut plot = plot(turn_axis(design), torque_axis(design), all);
    if let Some((law, band)) = required {
        let turns: Vec<f64> = behaviour.window.iter().map(Station::turn_rad).collect();
        require_law((law, *band), &turns, behaviour.window_rad, &design.units.torque, &mut plot);
    }
    let [from, to] = behaviour.window_rad;
    plot.spans.push(VerticalSpan { from, to, label: "window".to_owned(), hatched: false });
    let mut caption = "The torque on the shaft at rest, turned against the springs and back.".to_owned();
    if let (Some(area), Some(up), Some(down)) =
        (measured.get("loop_area"), measured.get("torque_up_mean"), measured.get("torque_down_mean"))
    {
        let joule = Unit::parse("J").unwrap_or_else(|_| Unit::si(Dimension::Energy));
        let torque = |nm: f64| format_si(nm, &design.units.torque, 4);
        let lost = format_si(area, &joule, 3);
        let _ = write!(caption, " Over the window {} up and {} down in the mean; a cycle loses {lost}.", torque(up), torque(down));
    }
    Figure { id: "torque", title: "Torque over the turn".to_owned(), caption, content: FigureContent::Plot(plot) }
}

fn curvature_figure(design: &Design, behaviour: &Behaviour) -> Figure {
    let cut = &behaviour.mechanism.cut;
    let [from, to] = cut.range_m();
    let points = (0..=240).map(|i| {
        let u = f64::from(i) / 240.0;
        let lambda = from + (to - from) * u * u;
        (cut.at(lambda)[0].value(), design.cut_roller_m * curvature_per_m(&cut.place(lambda), cut.sense()))
    });
    let (x, y) = points.filter(|(_, ratio)| ratio.is_finite()).unzip();
    let ratio = Axis {
        name: "roller_over_curvature_radius",
        label: "Roller radius over the path's radius of curvature, r/ϱ".to_owned(),
        dimension: Dimension::Ratio,
        display: Unit::si(Dimension::Ratio),
    };
    let mut plot = plot(turn_axis(design), ratio, vec![Series { label: "r/ϱ".to_owned(), x, y, stroke: Stroke::Main }]);
    plot.from_zero = true;
    plot.levels.push(HorizontalLine { at: 1.0, label: "undercut above".to_owned(), stroke: Stroke::Limit });
    Figure {
        id: "curvature",
        title: "Curvature of the path".to_owned(),
        caption: "Above one, the roller is larger than the path allows: the cam is undercut there. Below zero the path is hollow."
            .to_owned(),
        content: FigureContent::Plot(plot),
    }
}

fn contact_figure(design: &Design, behaviour: &Behaviour) -> Figure {
    let all = vec![
        line(&behaviour.stations, "roller on cam, up", Stroke::Main, |s| s.up.normal_n),
        line(&behaviour.stations, "across a guide, up", Stroke::Second, |s| s.up.guide_n),
        line(&behaviour.stations, "springs", Stroke::Third, |s| s.up.spring_n.abs()),
    ];
    let mut plot = plot(turn_axis(design), force_axis(design, "force", "Force"), all);
    plot.from_zero = true;
    Figure {
        id: "contact",
        title: "Forces in the mechanism".to_owned(),
        caption: "Normal force between a roller and the cam, force across the guide of a follower, force of all springs.".to_owned(),
        content: FigureContent::Plot(plot),
    }
}
