//! What the lines of a bench say of losses, shift and friction.

use std::f64::consts::TAU;

use forcewright_base::maths::{ln, ln_1p};
use forcewright_elements::wrap_spring::WrapSpring;
use forcewright_study::regression::{Line, TwoLines};
use forcewright_study::sampling::Interval;

use super::{Bench, CONFIDENCE, Lines};

/// A number with its interval of 95 %; without one where the bench does not determine it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// The estimate.
    pub value: f64,
    /// Its interval.
    pub interval: Option<Interval>,
}

impl Known {
    /// Less a number that is known.
    fn less(self, number: f64) -> Self {
        let interval = self.interval.map(|i| Interval { low: i.low - number, high: i.high - number });
        Self { value: self.value - number, interval }
    }
}

/// A mode: `τ_out = (1 − λ) τ_in/R_k − c`, R₁ = 1, R₂ = R.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// λ.
    pub proportional: Known,
    /// c, N·m; in mode II with the torque of slip on the hub.
    pub constant_nm: Known,
    /// The line of input torque over output torque.
    pub line: Line,
}

/// Where it shifts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// Output torque at which the lines of both modes cross, N·m: that of the shift without a plateau, and the largest possible one with it.
    pub crossing_nm: Known,
    /// Input torque there, N·m.
    pub crossing_input_nm: Known,
    /// Output torques between which it shifts, from the loads alone, N·m.
    pub between_nm: [f64; 2],
    /// Input torques between which mode I ends, N·m, for every output torque of that.
    pub input_nm: Interval,
    /// Width of the plateau in input torque, N·m, for every output torque of that; from 0.
    pub plateau_nm: Interval,
}

impl Shift {
    /// Whether there is a plateau wherever it shifts between those loads.
    pub fn has_plateau(&self) -> bool {
        self.plateau_nm.low > 0.0
    }
}

/// Friction on the hub from the torque of slip; an end that is absent is not determined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction {
    /// The estimate.
    pub value: Option<f64>,
    /// Lower end of its interval of 95 %.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
}

/// λ and c of a line of input torque over output torque.
fn mode(line: Line, ratio: f64) -> Mode {
    let slope = line.slope_estimate(CONFIDENCE).interval;
    let loss = |slope: f64| 1.0 - ratio / slope;
    let interval = (slope.low > 0.0 && slope.high.is_finite()).then(|| Interval { low: loss(slope.low), high: loss(slope.high) });
    let (constant_nm, range) = line.intercept_over_slope(CONFIDENCE);
    Mode { proportional: Known { value: loss(line.slope), interval }, constant_nm: Known { value: constant_nm, interval: range }, line }
}

fn shift(two: &TwoLines) -> Shift {
    let known = |(value, interval)| Known { value, interval };
    let [low, high] = two.bracket;
    // The second line is the flatter one: the step falls with the output torque.
    let (most, least) = (two.step_at(low, CONFIDENCE).interval.high, two.step_at(high, CONFIDENCE).interval.low);
    let ends = [low, high].map(|x| two.lines[0].estimate_at(x, CONFIDENCE).interval);
    Shift {
        crossing_nm: known(two.crossing(CONFIDENCE)),
        crossing_input_nm: known(two.crossing_ordinate(CONFIDENCE)),
        between_nm: two.bracket,
        input_nm: Interval { low: ends[0].low, high: ends[1].high },
        plateau_nm: Interval { low: least.max(0.0), high: most.max(0.0) },
    }
}

/// Friction at which the hub slips at a torque in the corrected model, `−ln(1 − τ_b/M_A)/(2π (N_A − 0.2))`; absent where none does.
pub(super) fn friction_of(clutch: &WrapSpring, torque_nm: f64) -> Option<f64> {
    let turns = clutch.dimensions().hub_turns - clutch.options().end_loss_turns;
    let part = torque_nm / clutch.hub_moment_nm();
    (turns > 0.0 && 0.0 < part && part < 1.0).then(|| -ln_1p(-part) / (TAU * turns))
}

/// Losses of a mode, 0 or 1, with a transmission of this ratio.
pub(super) fn mode_of(lines: &Lines, index: usize, ratio: f64) -> Option<Mode> {
    let of = if index == 0 { 1.0 } else { ratio };
    match lines {
        Lines::Both(two) => two.lines.get(index).map(|line| mode(*line, of)),
        Lines::One(only, line) => (*only == index).then(|| mode(*line, of)),
        Lines::Upward => None,
    }
}

/// Where it shifts.
pub(super) fn shift_of(lines: &Lines) -> Option<Shift> {
    match lines {
        Lines::Both(two) => Some(shift(two)),
        _ => None,
    }
}

impl Bench {
    /// Torque of slip on the hub, N·m: what mode II loses at any load, less the constant loss of its bearings and gears that is known from
    /// elsewhere.
    pub fn slip_nm(&self, other_nm: f64) -> Option<Known> {
        Some(self.modes[1]?.constant_nm.less(other_nm))
    }

    /// Friction on the hub that follows from it in the corrected model of the clutch.
    pub fn friction(&self, clutch: &WrapSpring, other_nm: f64) -> Option<Friction> {
        let slip = self.slip_nm(other_nm)?;
        let interval = slip.interval;
        Some(Friction {
            value: friction_of(clutch, slip.value),
            // A torque below zero has no friction: the end is that of a friction of zero.
            low: interval.and_then(|i| if i.low > 0.0 { friction_of(clutch, i.low) } else { Some(0.0) }),
            high: interval.and_then(|i| friction_of(clutch, i.high)),
        })
    }

    /// Least friction in the bore that has held the largest input torque of mode II, with the torque `τ_b` on the hub: the inverse of
    /// `τ_S − τ_t = (τ_b − τ_t) e^(2π N_B μ)`. Absent where `τ_b` is not above `τ_t`: then no friction explains it.
    pub fn bore_friction(&self, clutch: &WrapSpring, slip_nm: f64) -> Option<f64> {
        let held_nm = self.largest_nm()? * (1.0 - self.ratio) / self.ratio - clutch.transition_nm();
        let pressing_nm = slip_nm - clutch.transition_nm();
        let turns = clutch.dimensions().bore_turns;
        (pressing_nm > 0.0 && held_nm > 0.0 && turns > 0.0).then(|| (ln(held_nm / pressing_nm) / (TAU * turns)).max(0.0))
    }

    /// Largest input torque of mode II, N·m.
    pub fn largest_nm(&self) -> Option<f64> {
        let second = match &self.lines {
            Lines::Both(two) => &self.runs[two.second_from..],
            Lines::One(1, _) => &self.runs[..],
            _ => return None,
        };
        second.iter().map(|r| r.input_nm).reduce(f64::max)
    }
}
