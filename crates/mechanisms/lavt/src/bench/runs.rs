//! From forces over turns to a torque for each run: mean over whole turns, and what varies once per turn.

use std::f64::consts::{PI, TAU};

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::maths::{atan2, hypot, sin_cos};
use forcewright_base::units::{Dimension, format_number};
use forcewright_contract::data::{Cell, DataFile, Named, named_rows};
use forcewright_study::sampling::{Confidence, Estimate};

use super::section;
use crate::design::si;

/// Rows of a file.
const MOST_ROWS: usize = 200_000;
/// Largest step between two samples of a run, rad.
const LARGEST_STEP_RAD: f64 = 0.5 * PI;
/// What rounding may lack of a whole turn.
const ROUNDING: f64 = 1e-6;
/// Standard gravity, m/s².
const GRAVITY_M_PER_S2: f64 = 9.806_65;

/// What varies once per turn of the input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Half of the range from least to most, N·m.
    pub amplitude_nm: f64,
    /// Turn of the input at which it is largest, from the origin of the file's turns, rad; 0 to 2π.
    pub phase_rad: f64,
}

/// A mass that was lifted slowly.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The mass, kg.
    pub mass_kg: f64,
    /// Its torque at the output, N·m.
    pub output_nm: f64,
    /// Mean torque at the input, N·m.
    pub input_nm: f64,
    /// Whole turns of the mean; `None` without a column of turns.
    pub turns: Option<u32>,
    /// What the scatter from turn to turn says of the mean, N·m; `None` with fewer than two turns.
    pub repeat_nm: Option<Estimate>,
    /// What varies once per turn; `None` without a column of turns.
    pub wave: Option<Wave>,
}

/// A sample: turn of the input (rad) and force (N).
type Sample = [f64; 2];

/// Reads the runs of a bench, in the order of their masses. What is wrong goes into `diagnostics`; `None` after an error.
pub(super) fn read(bench: &section::Bench, diagnostics: &mut Diagnostics) -> Option<Vec<Run>> {
    let file = bench.file.as_ref()?;
    let arms_m = [&bench.input_pulley, &bench.output_pulley].map(|slot| si(slot).map(|d| 0.5 * d));
    let [Some(input_m), Some(output_m)] = arms_m else { return None };
    let before = diagnostics.errors();
    let mut runs = Vec::new();
    for group in groups(&table(bench, &file.value, diagnostics)?) {
        let mass_kg = group[0].mass.si;
        let samples: Vec<Sample> = group.iter().filter_map(|r| Some([r.turn?.si, r.force_n])).collect();
        let load_nm = mass_kg * GRAVITY_M_PER_S2 * output_m;
        if samples.len() < group.len() {
            let mean_n = group.iter().map(|r| r.force_n).sum::<f64>() / group.len() as f64;
            runs.push(Run { mass_kg, output_nm: load_nm, input_nm: mean_n * input_m, turns: None, repeat_nm: None, wave: None });
        } else if let Some(turns) = whole_turns(group, diagnostics) {
            runs.push(over_turns(&samples, turns, input_m, mass_kg, load_nm));
        }
    }
    runs.sort_by(|a, b| a.output_nm.total_cmp(&b.output_nm));
    (diagnostics.errors() == before).then_some(runs)
}

/// A row of the file.
struct Row {
    turn: Option<Cell>,
    mass: Cell,
    force_n: f64,
}

fn table(bench: &section::Bench, file: &DataFile, diagnostics: &mut Diagnostics) -> Option<Vec<Row>> {
    let named = |slot: &'static str, header, dimension| Named { header, key: slot, dimension };
    let mass = named("mass", bench.mass.as_ref()?, Dimension::Mass);
    let force = named("force", bench.force.as_ref()?, Dimension::Force);
    let rows: Vec<Row> = if let Some(header) = &bench.turn {
        let columns = [mass, force, named("turn", header, Dimension::Angle)];
        let found = named_rows(file, &columns, MOST_ROWS, diagnostics)?;
        found.into_iter().map(|[mass, force, turn]| Row { turn: Some(turn), mass, force_n: force.si }).collect()
    } else {
        let found = named_rows(file, &[mass, force], MOST_ROWS, diagnostics)?;
        found.into_iter().map(|[mass, force]| Row { turn: None, mass, force_n: force.si }).collect()
    };
    if let Some(row) = rows.iter().find(|r| r.mass.si < 0.0) {
        diagnostics.push(
            Diagnostic::error("E0830", row.mass.span, "a mass below zero")
                .label("this mass")
                .help("weigh the mass that hangs on the cable"),
        );
        return None;
    }
    Some(rows)
}

/// Rows that follow each other with one mass; where the turns begin anew, another run of that mass does.
fn groups(rows: &[Row]) -> impl Iterator<Item = &[Row]> {
    rows.chunk_by(|a, b| {
        let anew = a.turn.zip(b.turn).is_some_and(|(a, b)| b.si < a.si - PI);
        a.mass.si.to_bits() == b.mass.si.to_bits() && !anew
    })
}

/// Whole turns of a run. E0830: less than one, or samples too far apart.
fn whole_turns(group: &[Row], diagnostics: &mut Diagnostics) -> Option<u32> {
    let places: Vec<Cell> = group.iter().filter_map(|r| r.turn).collect();
    let (first, last) = (places.first()?, places.last()?);
    if let Some(pair) = places.windows(2).find(|p| (p[1].si - p[0].si).abs() > LARGEST_STEP_RAD) {
        let step = format_number((pair[1].si - pair[0].si) / TAU, 3);
        diagnostics.push(
            Diagnostic::error("E0830", pair[1].span, format!("{step} of a turn from one row to the next"))
                .label("this turn")
                .help("what varies within a turn needs at least four rows in each; give the turns with their fractions, counted upwards"),
        );
        return None;
    }
    let turned = (last.si - first.si) / TAU;
    let whole = (1_u32..=10_000).take_while(|n| f64::from(*n) <= turned + ROUNDING).last();
    if whole.is_none() {
        let grams = format_number(1e3 * group[0].mass.si, 4);
        diagnostics.push(
            Diagnostic::error("E0830", Span { end: last.span.end, ..first.span }, format!("the run of {grams} g has no whole turn"))
                .label(format!("{} of a turn", format_number(turned, 3)))
                .help("turn the input at least once with each mass: the torque varies within a turn, and its mean is that of whole turns"),
        );
    }
    whole
}

/// ∫ f dθ of a run between two turns, with f of turn and force, straight between the samples.
fn integral(samples: &[Sample], [from, to]: [f64; 2], f: impl Fn(f64, f64) -> f64) -> f64 {
    let piece = |pair: &[Sample]| {
        let ([a, force_a], [b, force_b]) = (pair[0], pair[1]);
        let (start, end) = (a.clamp(from, to), b.clamp(from, to));
        // A sample that repeats its turn is a step of no length.
        if (end - start).abs() <= 0.0 {
            return 0.0;
        }
        let at = |t: f64| f(t, force_a + (force_b - force_a) * (t - a) / (b - a));
        0.5 * (at(start) + at(end)) * (end - start)
    };
    samples.windows(2).map(piece).sum()
}

fn over_turns(samples: &[Sample], turns: u32, arm_m: f64, mass_kg: f64, output_nm: f64) -> Run {
    let start = samples[0][0];
    let turn = |n: u32| (start + f64::from(n) * TAU).min(samples[samples.len() - 1][0]);
    let means: Vec<f64> =
        (0..turns).map(|n| arm_m * integral(samples, [turn(n), turn(n + 1)], |_, force| force) / (turn(n + 1) - turn(n))).collect();
    let all = [start, turn(turns)];
    let share = 2.0 * arm_m / (all[1] - all[0]);
    let part = |f: fn(f64) -> f64| share * integral(samples, all, |t, force| force * f(t));
    let (cosine, sine) = (part(|t| sin_cos(t).1), part(|t| sin_cos(t).0));
    let estimate = Estimate::of_mean(&means, Confidence::P95);
    Run {
        mass_kg,
        output_nm,
        input_nm: estimate.value,
        turns: Some(turns),
        repeat_nm: (turns > 1).then_some(estimate),
        wave: Some(Wave { amplitude_nm: hypot(cosine, sine), phase_rad: atan2(sine, cosine).rem_euclid(TAU) }),
    }
}
