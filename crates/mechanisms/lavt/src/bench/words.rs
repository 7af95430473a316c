//! The bench in words and metrics.

use std::fmt::Write as _;

use forcewright_base::units::{format_number, format_si};
use forcewright_elements::wrap_spring::WrapSpring;
use forcewright_model::{Statement, Warning};
use forcewright_study::sampling::Interval;

use super::figure::grams;
use super::{Bench, Friction, Known, Lines, Part, Shift};
use crate::design::{Design, Source};
use crate::metrics::Measured;
use crate::statics::{State, Statics, clutch};

/// The corrected clutch of a design: the paper's has no friction on the hub.
fn corrected(design: &Design) -> Option<WrapSpring> {
    clutch(&design.built, Source::Corrected).ok()
}

/// Constant loss of mode II that the project gives: what of the fitted one is not the slip.
fn other_nm(design: &Design) -> f64 {
    design.built.losses[1].constant_nm
}

/// Metrics of the bench.
pub(crate) fn measure(m: &mut Measured, design: &Design) {
    let Some(bench) = design.bench.as_deref() else { return };
    let mut set = |names: [&str; 3], known: Known| {
        m.set(names[0], known.value);
        m.set(names[1], known.interval.map(|i| i.low));
        m.set(names[2], known.interval.map(|i| i.high));
    };
    if let Some(one) = bench.modes[0] {
        set(["bench_loss_mode_1", "bench_loss_mode_1_low", "bench_loss_mode_1_high"], one.proportional);
        set(["bench_constant_mode_1", "bench_constant_mode_1_low", "bench_constant_mode_1_high"], one.constant_nm);
    }
    if let Some(two) = bench.modes[1] {
        set(["bench_loss_mode_2", "bench_loss_mode_2_low", "bench_loss_mode_2_high"], two.proportional);
        set(["bench_constant_mode_2", "bench_constant_mode_2_low", "bench_constant_mode_2_high"], two.constant_nm);
    }
    if let Some(shift) = bench.shift {
        set(["bench_crossing_output", "bench_crossing_output_low", "bench_crossing_output_high"], shift.crossing_nm);
        let [low, high] = shift.between_nm;
        m.set("bench_transition_output_low", low);
        m.set("bench_transition_output_high", high);
        m.set("bench_plateau_low", shift.plateau_nm.low);
        m.set("bench_plateau_high", shift.plateau_nm.high);
    }
    let friction = corrected(design).and_then(|c| bench.friction(&c, other_nm(design))).unwrap_or_default();
    m.set("bench_friction_hub", friction.value);
    m.set("bench_friction_hub_low", friction.low);
    m.set("bench_friction_hub_high", friction.high);
}

/// What the bench found, for the section on the model.
pub(crate) fn statements(design: &Design) -> Vec<Statement> {
    let Some(bench) = design.bench.as_deref() else { return Vec::new() };
    let words = Words { design, bench };
    let mut all = vec![words.method()];
    all.extend((0..2).filter_map(|mode| words.mode(mode)));
    all.extend(words.shift());
    all.extend(words.friction());
    all.push(words.not_identifiable());
    all.into_iter().map(|(title, text)| Statement { title: title.to_owned(), text }).collect()
}

struct Words<'a> {
    design: &'a Design,
    bench: &'a Bench,
}

type Titled = (&'static str, String);

impl Words<'_> {
    fn torque(&self, nm: f64) -> String {
        format_si(nm, &self.design.units.torque, 4)
    }

    fn between(&self, Interval { low, high }: Interval) -> String {
        format!("{} to {}", self.torque(low), self.torque(high))
    }

    fn known(&self, known: Known) -> String {
        match known.interval {
            Some(interval) => format!("{} ({})", self.torque(known.value), self.between(interval)),
            None => format!("{} (no interval: not determined)", self.torque(known.value)),
        }
    }

    fn method(&self) -> Titled {
        let Self { bench, .. } = self;
        let mut text = format!("{} runs. ", bench.runs.len());
        text.push_str(if bench.over_turns() {
            "The torque at the input of each is its mean over whole turns. "
        } else {
            "Without a column of turns the mean is that of all rows: a part of what varies once per turn stays in it. "
        });
        text.push_str(
            "Input torque is fitted over output torque, which the masses set; intervals are of 95 %, from the scatter about each line.",
        );
        let named = |part: Part| -> Vec<String> {
            let of = bench.runs.iter().enumerate().filter(|(i, _)| bench.part(*i) == part);
            of.map(|(_, r)| grams(r)).collect()
        };
        let (plateau, neither) = (named(Part::Plateau), named(Part::Neither));
        if matches!(bench.lines, Lines::Upward) {
            text.push_str(
                " The points bend upwards: the input torque rises faster at large loads, which no mode II does. Nothing is fitted.",
            );
        } else if !neither.is_empty() {
            let _ = write!(text, " Left out, as on neither line nor between them: {}.", neither.join(", "));
        }
        if !plateau.is_empty() {
            let _ = write!(text, " Left out, as between the lines of both modes, on the plateau: {}.", plateau.join(", "));
        }
        ("Bench", text)
    }

    fn mode(&self, index: usize) -> Option<Titled> {
        let mode = self.bench.modes[index]?;
        let title = ["Bench, mode I", "Bench, mode II"][index];
        let percent = |v: f64| format_number(100.0 * v, 3);
        let loss = match mode.proportional.interval {
            Some(i) => format!("{} % ({} to {} %)", percent(mode.proportional.value), percent(i.low), percent(i.high)),
            None => format!("{} % (no interval: not determined)", percent(mode.proportional.value)),
        };
        let gain = format_number((1.0 - mode.proportional.value) / if index == 0 { 1.0 } else { self.bench.ratio }, 4);
        let sign = if mode.constant_nm.value < 0.0 { "+" } else { "−" };
        let constant = self.torque(mode.constant_nm.value.abs());
        let mut text = format!(
            "τ_out = {gain} τ_in {sign} {constant} from {} runs. Proportional loss {loss}, constant {}{}.",
            mode.line.count,
            self.known(mode.constant_nm),
            ["", ", the slip on the hub with it"][index],
        );
        if mode.line.count > 2 {
            let _ = write!(text, " Scatter about the line {}.", self.torque(mode.line.variance().sqrt()));
        }
        Some((title, text))
    }

    fn shift(&self) -> Option<Titled> {
        let Shift { crossing_nm, crossing_input_nm, between_nm: [low, high], input_nm, plateau_nm } = self.bench.shift?;
        let mut text = format!("Between {} and {} at the output, by the masses alone. ", self.torque(low), self.torque(high));
        if plateau_nm.low > 0.0 {
            let _ = write!(
                text,
                "Mode I ends at {} at the input, and a plateau of {} follows; the lines would cross only at {} at the output.",
                self.between(input_nm),
                self.between(plateau_nm),
                self.torque(crossing_nm.value)
            );
        } else {
            let _ = write!(
                text,
                "No plateau is seen; it is at most {} wide. Without one it shifts where the lines cross, at {} at the output and {} at the input.",
                self.torque(plateau_nm.high),
                self.known(crossing_nm),
                self.known(crossing_input_nm)
            );
        }
        Some(("Bench, shift", text))
    }

    fn friction(&self) -> Option<Titled> {
        let Self { design, bench } = self;
        let ratio = bench.ratio;
        let clutch = corrected(design)?;
        let other_nm = other_nm(design);
        let slip = bench.slip_nm(other_nm)?;
        let Friction { value, low, high } = bench.friction(&clutch, other_nm)?;
        let number = |v: f64| format_number(v, 3);
        let mut text = if other_nm > 0.0 {
            format!("With {} of other constant losses, as the project has it, the hub slips at {}", self.torque(other_nm), self.known(slip))
        } else {
            format!("If nothing but the hub loses torque at any load in mode II, it slips at {}", self.known(slip))
        };
        let moment = self.torque(clutch.hub_moment_nm());
        let _ = match (value, low, high) {
            (Some(mu), Some(low), Some(high)) => {
                write!(
                    text,
                    ": a friction of {} ({} to {}) on the hub, whose interference has a moment of {moment}.",
                    number(mu),
                    number(low),
                    number(high)
                )
            }
            (Some(mu), Some(low), None) => write!(
                text,
                ": a friction of {}, at least {}; no upper end, as the interval reaches the moment of the interference, {moment}, which no friction exceeds.",
                number(mu),
                number(low)
            ),
            _ => write!(text, ": no friction explains that, as the moment of the interference is {moment}."),
        };
        if let Some(held_nm) = bench.largest_nm().map(|nm| nm * (1.0 - ratio) / ratio) {
            let _ = match bench.bore_friction(&clutch, slip.value) {
                Some(mu) => write!(text, " The bore held {}: a friction of at least {} there.", self.torque(held_nm), number(mu)),
                None => write!(
                    text,
                    " The bore held {}, which no friction explains: it slips on the hub below the {} at which it reaches the bore. Spring, hub and bore may not be coaxial, or not have these diameters.",
                    self.torque(held_nm),
                    self.torque(clutch.transition_nm())
                ),
            };
        }
        Some(("Bench, friction", text))
    }

    fn not_identifiable(&self) -> Titled {
        let mut text = String::from(
            "In mode II slip on the hub and constant losses of bearings and gears are one number; `losses.mode_2.constant`, where it is given, is taken off. Proportional losses of gears and bearings are one number as well. Of the friction in the bore only a lower bound is known, of the torque in the opening direction nothing.",
        );
        match &self.bench.lines {
            Lines::Both(_) => {
                text.push_str(" Where between two masses it shifts is known only by the assumption that there is no plateau.");
            }
            Lines::One(mode, _) => {
                let (seen, other) = [("I", "II"), ("II", "I")][*mode];
                let _ = write!(text, " All masses are in mode {seen}: nothing is known of mode {other} and of the shift.");
            }
            Lines::Upward => {}
        }
        ("Bench, not determined", text)
    }
}

/// W0830: the bench shows what the design does not.
pub(crate) fn warnings(design: &Design) -> Option<Warning> {
    let bench = design.bench.as_deref()?;
    let largest_nm = bench.largest_nm()?;
    let spring = clutch(&design.built, design.source).ok()?;
    let [_, friction] = design.frictions();
    let statics = Statics::new(&design.built, &spring, friction, 0.0).ok()?;
    let (state, _) = statics.output(largest_nm);
    matches!(state, State::SlipsBeforeShift | State::SlipsInBore).then(|| Warning {
        code: "W0830",
        message: format!(
            "the bench held {} in mode II, where the model says: {}, even with the largest friction",
            format_si(largest_nm, &design.units.torque, 4),
            state.word()
        ),
    })
}
