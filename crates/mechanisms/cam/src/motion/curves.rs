//! Curves and the figure of how the slider moves.

use forcewright_base::units::{Dimension, Unit, format_si};
use forcewright_model::{Axis, Branch, Curve, Figure, FigureContent, Plot, Series, Stroke};

use crate::analysis::Behaviour;
use crate::design::Design;
use crate::motion::Moment;

fn axis(name: &'static str, label: &str, dimension: Dimension, display: &Unit) -> Axis {
    Axis { name, label: label.to_owned(), dimension, display: display.clone() }
}

fn time(design: &Design) -> Axis {
    axis("time", "Time t", Dimension::Time, &design.units.time)
}

/// Speed, and what only some motions have.
pub(crate) fn curves(design: &Design, behaviour: &Behaviour) -> Vec<Curve> {
    let Some(motion) = &behaviour.motion else { return Vec::new() };
    let branch = |name: &str, value: &dyn Fn(&Moment) -> f64| Branch {
        name: name.to_owned(),
        x: motion.iter().map(|m| m.time_s).collect(),
        y: motion.iter().map(value).collect(),
    };
    let units = &design.units;
    let speed = axis("speed", "Speed of the slider", Dimension::Speed, &Unit::si(Dimension::Speed));
    let mut all = vec![Curve { name: "motion_speed", x: time(design), y: speed, branches: vec![branch("moving", &|m| m.speed_m_per_s)] }];
    if motion.iter().all(|m| m.cable_n.is_some()) {
        let y = axis("cable_tension", "Tension of the cable", Dimension::Force, &units.force);
        all.push(Curve { name: "motion_cable", x: time(design), y, branches: vec![branch("moving", &|m| m.cable_n.unwrap_or(0.0))] });
    }
    if design.free_guide {
        let y = axis("sideways", "Way of the slider sideways", Dimension::Length, &units.length);
        all.push(Curve { name: "motion_sideways", x: time(design), y, branches: vec![branch("moving", &|m| m.sideways_m)] });
    }
    all
}

/// Travel over time.
pub(crate) fn figure(design: &Design, behaviour: &Behaviour) -> Option<Figure> {
    let motion = behaviour.motion.as_ref()?;
    let travel = Series {
        label: "travel".to_owned(),
        x: motion.iter().map(|m| m.time_s).collect(),
        y: motion.iter().map(|m| m.travel_m).collect(),
        stroke: Stroke::Main,
    };
    let plot = Plot {
        x: time(design),
        y: axis("travel", "Travel s", Dimension::Length, &design.units.travel),
        series: vec![travel],
        bands: Vec::new(),
        levels: Vec::new(),
        spans: Vec::new(),
        markers: Vec::new(),
        from_zero: true,
    };
    let fastest = motion.iter().map(|m| m.speed_m_per_s.abs()).fold(0.0, f64::max);
    let speed = format_si(fastest, &Unit::si(Dimension::Speed), 3);
    Some(Figure {
        id: "motion_travel",
        title: "Travel in the motion".to_owned(),
        caption: format!("The slider over time, at most {speed} fast."),
        content: FigureContent::Plot(plot),
    })
}
