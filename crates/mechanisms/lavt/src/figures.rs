//! Curves and figures of a result.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_model::{Axis, Branch, Curve, Figure, FigureContent, HorizontalLine, Marker, Plot, Series, Stroke, VerticalSpan};

use crate::analysis::Behaviour;
use crate::design::{Design, Source};
use crate::metrics::Measured;
use crate::scene;
use crate::statics::{State, Statics, clutch};

/// Points of a characteristic.
const POINTS: usize = 401;
/// Coefficients of friction of the figure of the margins.
const FRICTIONS: usize = 121;
const MOST_FRICTION: f64 = 0.4;
/// How far beyond the required torque the characteristic is drawn.
const BEYOND: f64 = 1.15;

pub(crate) fn axis(name: &'static str, label: &str, dimension: Dimension, display: &Unit) -> Axis {
    Axis { name, label: label.to_owned(), dimension, display: display.clone() }
}

pub(crate) fn input_axis(design: &Design) -> Axis {
    axis("input_torque", "Torque at the input τ_in", Dimension::Torque, &design.units.torque)
}

pub(crate) fn output_axis(design: &Design) -> Axis {
    axis("output_torque", "Torque at the output τ_out", Dimension::Torque, &design.units.torque)
}

fn percent() -> Unit {
    Unit::parse("%").unwrap_or_else(|_| Unit::si(Dimension::Ratio))
}

fn efficiency_axis() -> Axis {
    axis("efficiency", "Efficiency η", Dimension::Ratio, &percent())
}

fn number() -> Unit {
    Unit::si(Dimension::Ratio)
}

/// Largest input torque that is drawn, N·m.
fn top_nm(design: &Design, statics: &Statics) -> f64 {
    design.requirements.as_ref().map_or(6.0 * statics.transition_input_nm(), |r| BEYOND * r.input_nm)
}

/// Input torques of the characteristic, N·m: even steps, and where it bends.
fn inputs_nm(design: &Design, statics: &Statics) -> Vec<f64> {
    let top_nm = top_nm(design, statics);
    let carried_nm = statics.transition_output_nm();
    let bends = [statics.transition_input_nm(), statics.plateau_end_nm(carried_nm), statics.held_input_nm()];
    let mut all: Vec<f64> = (0..POINTS).map(|i| top_nm * i as f64 / (POINTS - 1) as f64).collect();
    all.extend(bends.into_iter().filter(|x| *x < top_nm));
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

fn characteristic(design: &Design, statics: &Statics, name: &str) -> Branch {
    let x = inputs_nm(design, statics);
    let y = x.iter().map(|input_nm| statics.output(*input_nm).1).collect();
    Branch { name: name.to_owned(), x, y }
}

/// From a high output torque down: mode II until the bore lets go.
fn way_back(design: &Design, statics: &Statics) -> Option<Branch> {
    let down_nm = statics.downshift_nm()?;
    let input_nm = statics.plateau_end_nm(down_nm);
    let shifted_nm = statics.plateau_end_nm(statics.transition_output_nm());
    if input_nm >= shifted_nm || shifted_nm > top_nm(design, statics) {
        return None;
    }
    Some(Branch { name: "back".to_owned(), x: vec![shifted_nm, input_nm], y: vec![statics.transition_output_nm(), down_nm] })
}

fn efficiencies(design: &Design, statics: &Statics) -> Vec<Branch> {
    let mut modes: [(Vec<f64>, Vec<f64>); 2] = Default::default();
    for input_nm in inputs_nm(design, statics) {
        let (state, output_nm) = statics.output(input_nm);
        let mode = match state {
            State::ModeI => 0,
            State::ModeII => 1,
            _ => continue,
        };
        if let Some(efficiency) = statics.efficiency(input_nm) {
            modes[mode].0.push(output_nm);
            modes[mode].1.push(efficiency);
        }
    }
    let names = ["mode_1", "mode_2"];
    let branches = names.iter().zip(modes).filter(|(_, (x, _))| !x.is_empty());
    branches.map(|(name, (x, y))| Branch { name: (*name).to_owned(), x, y }).collect()
}

/// The same transmission in the other model; `None` where it makes no spring.
fn other_model(design: &Design, behaviour: &Behaviour) -> Option<(Statics, &'static str)> {
    let (source, label) = match design.source {
        Source::Corrected => (Source::Paper, "the paper's model"),
        Source::Paper => (Source::Corrected, "corrected model"),
    };
    let clutch = clutch(&design.built, source).ok()?;
    Some((Statics::new(&design.built, &clutch, design.built.friction, behaviour.train.mesh_loss()).ok()?, label))
}

/// Every curve of a result.
pub(crate) fn curves(design: &Design, behaviour: &Behaviour) -> Vec<Curve> {
    let statics = &behaviour.statics;
    let mut branches = vec![characteristic(design, statics, "rising")];
    branches.extend(way_back(design, statics));
    let mut all = vec![
        Curve { name: "characteristic", x: input_axis(design), y: output_axis(design), branches },
        Curve { name: "efficiency", x: output_axis(design), y: efficiency_axis(), branches: efficiencies(design, statics) },
    ];
    // Where nothing turns there is no efficiency.
    all.retain(|curve| !curve.branches.is_empty());
    all
}

fn series(branch: Branch, label: &str, stroke: Stroke) -> Series {
    Series { label: label.to_owned(), x: branch.x, y: branch.y, stroke }
}

pub(crate) fn plot(x: Axis, y: Axis, series: Vec<Series>) -> Plot {
    Plot { x, y, series, bands: Vec::new(), levels: Vec::new(), spans: Vec::new(), markers: Vec::new(), from_zero: true }
}

fn figure(id: &'static str, title: &str, caption: String, content: FigureContent) -> Figure {
    Figure { id, title: title.to_owned(), caption, content }
}

/// Every figure of a report.
pub(crate) fn figures(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Figure> {
    let mut all = Vec::new();
    if let Some(film) = scene::gears(design, behaviour) {
        let caption = "Seen along the axis, over the turn of the input. The teeth are those that are made.";
        all.push(figure("mechanism", "Gears in both modes", caption.to_owned(), FigureContent::Film(film)));
    }
    all.push(characteristic_figure(design, behaviour, measured));
    all.push(efficiency_figure(design, behaviour));
    all.push(modes_figure(design, behaviour));
    all.extend(margins_figure(design, behaviour));
    let caption = "The turns off the hub open with the torque; those on the hub do not. To scale.";
    all.push(figure("spring", "Spring between hub and bore", caption.to_owned(), FigureContent::Film(scene::spring(design, behaviour))));
    let section = scene::section(design, behaviour);
    all.push(figure("section", "Section along the axis", section.description.clone(), FigureContent::Scene(section)));
    all
}

fn characteristic_figure(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Figure {
    let statics = &behaviour.statics;
    let mut lines = Vec::new();
    if let Some((other, label)) = other_model(design, behaviour) {
        lines.push(series(characteristic(design, &other, "other"), label, Stroke::Reference));
    }
    if design.friction_scatters() {
        let ends = [("least friction", Stroke::Third), ("largest friction", Stroke::Fourth)];
        for (statics, (label, stroke)) in behaviour.slippery.iter().zip(ends) {
            lines.push(series(characteristic(design, statics, "range"), label, stroke));
        }
    }
    if let Some(back) = way_back(design, statics) {
        lines.push(series(back, "on the way back", Stroke::Second));
    }
    lines.push(series(characteristic(design, statics, "rising"), "as the input rises", Stroke::Main));
    let mut plot = plot(input_axis(design), output_axis(design), lines);
    let torque = |nm: f64| format_si(nm, &design.units.torque, 4);
    let (from_nm, output_nm) = (statics.transition_input_nm(), statics.transition_output_nm());
    let mut caption = format!("Mode I up to {} at the input.", torque(from_nm));
    if statics.grip_nm.is_some() {
        let to_nm = statics.plateau_end_nm(output_nm);
        if to_nm > from_nm {
            plot.spans.push(VerticalSpan { from: from_nm, to: to_nm, label: "blocked".to_owned(), hatched: true });
            let _ = write!(caption, " Blocked up to {}: the spring holds on hub and bore.", torque(to_nm));
        }
        if let Some(down_nm) = statics.downshift_nm() {
            let _ = write!(caption, " Back to mode I when the output falls below {}.", torque(down_nm));
        }
        let held_nm = statics.held_input_nm();
        if held_nm < top_nm(design, statics) {
            let _ = write!(caption, " The bore slips beyond {} at the input.", torque(held_nm));
        }
    } else {
        let _ = write!(caption, " There the spring slips on the hub and never reaches the bore: a torque limiter, not a transmission.");
    }
    if let Some(required) = &design.requirements {
        if let Some(wanted) = required.output_nm {
            plot.levels.push(HorizontalLine { at: wanted, label: format!("required {}", torque(wanted)), stroke: Stroke::Limit });
        }
        if let Some(found) = measured.get("output_torque_max") {
            let note = format!("{} with {} at the input", torque(found), torque(required.input_nm));
            plot.markers.push(Marker { x: required.input_nm, y: found, label: "τ_max".to_owned(), note });
        }
    }
    figure("characteristic", "Torque at the output over torque at the input", caption, FigureContent::Plot(plot))
}

fn efficiency_figure(design: &Design, behaviour: &Behaviour) -> Figure {
    let lines = efficiencies(design, &behaviour.statics);
    let labels = ["mode I", "mode II"];
    let strokes = [Stroke::Second, Stroke::Main];
    let lines = lines.into_iter().map(|b| {
        let mode = usize::from(b.name == "mode_2");
        series(b, labels[mode], strokes[mode])
    });
    let mut plot = plot(output_axis(design), efficiency_axis(), lines.collect());
    if let Some(least) = design.requirements.as_ref().and_then(|r| r.efficiency) {
        plot.levels.push(HorizontalLine {
            at: least,
            label: format!("required {} %", format_number(100.0 * least, 3)),
            stroke: Stroke::Limit,
        });
    }
    let caption =
        "Between the modes nothing turns, and there is no efficiency. In mode II the slip on the hub costs the same torque at any load.";
    figure("efficiency", "Efficiency over torque at the output", caption.to_owned(), FigureContent::Plot(plot))
}

/// Coefficients of friction, the same on hub and bore, from 0 on, and the torques with them.
fn over_friction(design: &Design, behaviour: &Behaviour) -> Vec<(f64, Statics)> {
    let mus = (0..FRICTIONS).map(|i| MOST_FRICTION * i as f64 / (FRICTIONS - 1) as f64);
    let loss = behaviour.train.mesh_loss();
    mus.filter_map(|mu| Some((mu, Statics::new(&design.built, &behaviour.clutch, [mu; 2], loss).ok()?))).collect()
}

/// Mode diagram: which mode, over friction and torque at the input, the output loaded as at the shift.
fn modes_figure(design: &Design, behaviour: &Behaviour) -> Figure {
    let top_nm = top_nm(design, &behaviour.statics);
    let all = over_friction(design, behaviour);
    let line = |label: &str, stroke: Stroke, y: &dyn Fn(&Statics) -> Option<f64>| {
        let (x, y) = all.iter().skip(1).filter_map(|(mu, s)| Some((*mu, y(s)?))).filter(|(_, nm)| *nm <= top_nm).unzip();
        Series { label: label.to_owned(), x, y, stroke }
    };
    let lines = vec![
        line("above: slips on the hub before it shifts", Stroke::Limit, &|s| s.grip_nm.is_none().then(|| s.transition_input_nm())),
        line("above: blocked", Stroke::Second, &|s| s.grip_nm.map(|_| s.transition_input_nm())),
        line("above: mode II", Stroke::Main, &|s| s.grip_nm.map(|_| s.plateau_end_nm(s.transition_output_nm()))),
        line("above: slips in the bore", Stroke::Third, &|s| s.grip_nm.map(|_| s.held_input_nm())),
    ];
    let x = axis("friction", "Friction μ of hub and bore", Dimension::Ratio, &number());
    let mut plot = plot(x, input_axis(design), lines.into_iter().filter(|l| !l.x.is_empty()).collect());
    if let Some(required) = &design.requirements {
        let label = format!("there is {}", format_si(required.input_nm, &design.units.torque, 4));
        plot.levels.push(HorizontalLine { at: required.input_nm, label, stroke: Stroke::Reference });
    }
    let [[low, _], [high, _]] = design.frictions();
    if low < high {
        plot.spans.push(VerticalSpan { from: low, to: high, label: "range of friction".to_owned(), hatched: false });
    }
    let caption = "Below the lowest line mode I. Between blocked and mode II the output is loaded as at the shift; with more load mode II begins later.";
    figure("modes", "Modes over friction and torque", caption.to_owned(), FigureContent::Plot(plot))
}

/// What friction does: where the clutch shifts, and what it holds.
fn margins_figure(design: &Design, behaviour: &Behaviour) -> Option<Figure> {
    let required = design.requirements.as_ref()?;
    let k = behaviour.statics.leverage();
    let all = over_friction(design, behaviour);
    let line = |label: &str, stroke: Stroke, y: &dyn Fn(&Statics) -> Option<f64>| {
        // What is far beyond the torque needed would press everything else to the axis.
        let most_nm = 4.0 * k * required.input_nm;
        let (x, y) = all.iter().filter_map(|(mu, s)| Some((*mu, y(s)?))).filter(|(_, nm)| *nm <= most_nm).unzip();
        Series { label: label.to_owned(), x, y, stroke }
    };
    let x = axis("friction", "Friction μ of hub and bore", Dimension::Ratio, &number());
    let y = axis("clutch_torque", "Torque on the spring", Dimension::Torque, &design.units.torque);
    let mut plot = plot(
        x,
        y,
        vec![
            line("hub slips, τ_b", Stroke::Second, &|s| Some(s.hub_nm)),
            line("opening direction held", Stroke::Third, &|s| Some(s.lock_nm)),
            line("bore holds", Stroke::Main, &|s| s.grip_nm),
        ],
    );
    let torque = |nm: f64| format_si(nm, &design.units.torque, 4);
    plot.levels.push(HorizontalLine {
        at: behaviour.statics.transition_nm,
        label: "reaches the bore, τ_t".to_owned(),
        stroke: Stroke::Reference,
    });
    plot.levels.push(HorizontalLine {
        at: k * required.input_nm,
        label: format!("needed {}", torque(k * required.input_nm)),
        stroke: Stroke::Limit,
    });
    let [[low, _], [high, _]] = design.frictions();
    if low < high {
        plot.spans.push(VerticalSpan { from: low, to: high, label: "range of friction".to_owned(), hatched: false });
    }
    let mut caption =
        "What the spring holds, over a friction that is the same on hub and bore; lines end at four times the torque needed.".to_owned();
    match behaviour.clutch.least_friction_to_reach() {
        Some(mu) => {
            let _ = write!(caption, " From {} on it reaches the bore;", format_number(mu, 4));
            match behaviour.clutch.least_friction_to_grip(k * required.input_nm) {
                Ok(Some(mu)) => {
                    let _ = write!(caption, " from {} on the bore holds the input torque.", format_number(mu, 4));
                }
                _ => caption.push_str(" no friction holds the input torque there."),
            }
        }
        None => caption.push_str(" It never reaches the bore: the hub is not tighter than the bore is wide."),
    }
    Some(figure("margins", "Friction and what it holds", caption, FigureContent::Plot(plot)))
}
