//! The bench in figures and curves.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_model::{Branch, Curve, Figure, FigureContent, Marker, Series, Stroke};

use super::{Bench, CONFIDENCE, Lines, Part, Run};
use crate::analysis::Behaviour;
use crate::design::Design;
use crate::figures::{axis, input_axis, output_axis, plot};
use crate::statics::Statics;

/// Points of a band and of the theory.
const POINTS: usize = 121;
/// How far beyond the measured torques lines are drawn.
const BEYOND: f64 = 1.05;
/// Names of the branches of both modes.
const MODES: [&str; 2] = ["mode_1", "mode_2"];

/// The runs of a part, as a branch of input torque and output torque.
fn branch(bench: &Bench, name: &str, is: impl Fn(Part) -> bool) -> Option<Branch> {
    let runs = bench.runs.iter().enumerate().filter(|(i, _)| is(bench.part(*i))).map(|(_, r)| (r.input_nm, r.output_nm));
    let (x, y): (Vec<f64>, Vec<f64>) = runs.unzip();
    (!x.is_empty()).then(|| Branch { name: name.to_owned(), x, y })
}

/// From and to which output torque the line of a mode is drawn, N·m.
fn extent(bench: &Bench, mode: usize) -> Option<[f64; 2]> {
    let loads = bench.runs.iter().enumerate().filter(|(i, _)| bench.part(*i) == Part::Mode(mode)).map(|(_, r)| r.output_nm);
    let [low, high] = loads.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
    if low > high {
        return None;
    }
    match &bench.lines {
        Lines::Both(two) if mode == 0 => Some([low, two.bracket[1].max(high)]),
        Lines::Both(two) => Some([two.bracket[0].min(low), high]),
        _ => Some([low, high]),
    }
}

/// Stations of a line, N·m at the output.
fn stations([low, high]: [f64; 2]) -> impl DoubleEndedIterator<Item = f64> + Clone {
    (0..POINTS).map(move |i| low + (high - low) * i as f64 / (POINTS - 1) as f64)
}

/// The fitted line of a mode.
fn fitted(bench: &Bench, mode: usize) -> Option<Branch> {
    let line = bench.modes[mode]?.line;
    let ends = extent(bench, mode)?;
    Some(Branch { name: MODES[mode].to_owned(), x: ends.map(|y| line.at(y)).to_vec(), y: ends.to_vec() })
}

/// Its band: there and back around the region.
fn band(bench: &Bench, mode: usize) -> Option<Series> {
    let line = bench.modes[mode]?.line;
    let ends = extent(bench, mode)?;
    let at = |y: f64| line.estimate_at(y, CONFIDENCE).interval;
    let there = stations(ends).map(|y| (at(y).low, y));
    let back = stations(ends).rev().map(|y| (at(y).high, y));
    let (x, y): (Vec<f64>, Vec<f64>) = there.chain(back).unzip();
    let label = format!("mode {}, 95 %", ["I", "II"][mode]);
    x.iter().all(|v| v.is_finite()).then_some(Series { label, x, y, stroke: Stroke::Area })
}

/// Curves of a result: measured, fitted, and what varies once per turn.
pub(crate) fn curves(design: &Design) -> Vec<Curve> {
    let Some(bench) = &design.bench else { return Vec::new() };
    let mut measured: Vec<Branch> = (0..2).filter_map(|mode| branch(bench, MODES[mode], |p| p == Part::Mode(mode))).collect();
    measured.extend(branch(bench, "plateau", |p| p == Part::Plateau));
    // A single point is no curve; the figure has it.
    measured.retain(|b| b.x.len() >= 2);
    measured.extend(branch(bench, "neither", |p| p == Part::Neither));
    let mut all = vec![Curve { name: "bench", x: input_axis(design), y: output_axis(design), branches: measured }];
    let fits: Vec<Branch> = (0..2).filter_map(|mode| fitted(bench, mode)).collect();
    if !fits.is_empty() {
        all.push(Curve { name: "bench_fit", x: input_axis(design), y: output_axis(design), branches: fits });
    }
    let waves = bench.runs.iter().filter_map(|r| Some((r.output_nm, r.wave?)));
    let degrees = Unit::parse("deg").unwrap_or_else(|_| Unit::si(Dimension::Angle));
    let (x, waves): (Vec<f64>, Vec<_>) = waves.unzip();
    if !x.is_empty() {
        let of = |y: Vec<f64>| vec![Branch { name: "measured".to_owned(), x: x.clone(), y }];
        let amplitude = axis("amplitude", "Amplitude once per turn", Dimension::Torque, &design.units.torque);
        let phase = axis("phase", "Turn of its largest value", Dimension::Angle, &degrees);
        let (amplitudes, phases) = waves.iter().map(|w| (w.amplitude_nm, w.phase_rad)).unzip();
        all.push(Curve { name: "bench_wave", x: output_axis(design), y: amplitude, branches: of(amplitudes) });
        all.push(Curve { name: "bench_wave_phase", x: output_axis(design), y: phase, branches: of(phases) });
    }
    all
}

/// A run in the table below the figure.
fn note(design: &Design, bench: &Bench, index: usize) -> String {
    let Run { input_nm, output_nm, turns, repeat_nm, wave, .. } = &bench.runs[index];
    let torque = |nm: f64| format_si(nm, &design.units.torque, 3);
    let mut note = format!("{}: {} from {}", grams(&bench.runs[index]), torque(*output_nm), torque(*input_nm));
    if let Some(repeat) = repeat_nm {
        let _ = write!(note, " ± {}", torque(repeat.interval.high - repeat.value));
    }
    if let (Some(turns), Some(wave)) = (turns, wave) {
        let degrees = format_number(wave.phase_rad.to_degrees(), 3);
        let plural = if *turns == 1 { "" } else { "s" };
        let _ = write!(note, "; {turns} turn{plural}, wave {} at {degrees}°", torque(wave.amplitude_nm));
    }
    note.push_str(match bench.part(index) {
        Part::Mode(0) => "; mode I",
        Part::Mode(_) => "; mode II",
        Part::Plateau => "; on the plateau, left out",
        Part::Neither => "; on neither line, left out",
    });
    note
}

/// A mass in grams.
pub(super) fn grams(run: &Run) -> String {
    format!("{} g", format_number(1e3 * run.mass_kg, 4))
}

/// Measured points, fits with their bands, theory beside.
pub(crate) fn figure(design: &Design, behaviour: &Behaviour) -> Option<Figure> {
    let bench = design.bench.as_deref()?;
    let mut lines: Vec<Series> = (0..2).filter_map(|mode| band(bench, mode)).collect();
    let top_nm = BEYOND * bench.runs.iter().map(|r| r.input_nm).fold(0.0, f64::max);
    lines.push(theory(&behaviour.statics, top_nm));
    for (mode, (label, stroke)) in [("mode I, fit", Stroke::Second), ("mode II, fit", Stroke::Main)].into_iter().enumerate() {
        if let Some(Branch { x, y, .. }) = fitted(bench, mode) {
            lines.push(Series { label: label.to_owned(), x, y, stroke });
        }
    }
    let mut plot = plot(input_axis(design), output_axis(design), lines);
    for (index, run) in bench.runs.iter().enumerate() {
        plot.markers.push(Marker { x: run.input_nm, y: run.output_nm, label: grams(run), note: note(design, bench, index) });
    }
    let caption = "Each point is a mass, its input torque the mean over whole turns with what the scatter from turn to turn says of it; the wave is \
                   what varies once per turn, and where it is largest. Lines are fitted to input over output torque. Dashed: the theory with the \
                   friction and the losses of the project.";
    let plain = "Each point is a mass, its input torque the mean of all its rows. Lines are fitted to input over output torque. Dashed: the theory \
                 with the friction and the losses of the project.";
    Some(Figure {
        id: "bench",
        title: "Bench: torque at the output over torque at the input".to_owned(),
        caption: (if bench.over_turns() { caption } else { plain }).to_owned(),
        content: FigureContent::Plot(plot),
    })
}

fn theory(statics: &Statics, top_nm: f64) -> Series {
    let bends = [statics.transition_input_nm(), statics.plateau_end_nm(statics.transition_output_nm())];
    let mut x: Vec<f64> = stations([0.0, top_nm]).chain(bends.into_iter().filter(|b| *b < top_nm)).collect();
    x.sort_by(f64::total_cmp);
    let y = x.iter().map(|nm| statics.output(*nm).1).collect();
    Series { label: "theory".to_owned(), x, y, stroke: Stroke::Reference }
}
