//! A hand that closes: motor, transmission, finger and object from rest to the grasp.
//!
//! Brushed motor behind a voltage over time and a limit of the current; the clutch with its elastic coil, sticking and slipping on hub and
//! in bore; a finger with glove, inertia and an elastic object. The winding's inductance is left out: its time constant L/R is of tens of
//! microseconds, that of the rotor of ten milliseconds. Equations, events and limits: `docs/theory/lavt-closing.md`.

pub(crate) mod figures;
mod modes;
mod plant;
mod run;

use forcewright_elements::wrap_spring::WrapSpring;

use crate::design::Design;
use crate::statics::Statics;
use plant::{Coupling, Plant};

/// How it is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosingSettings {
    /// Local error of a step, relative to the sizes of the unknowns; 1e-4 … 1e-12. Default 1e-8.
    pub accuracy: f64,
    /// Time after the last change of the voltage at which a closing is given up, s. Default 30 s.
    pub patience_s: f64,
    /// Most steps between two events. Default 200 000.
    pub max_steps: usize,
}

impl Default for ClosingSettings {
    fn default() -> Self {
        Self { accuracy: 1e-8, patience_s: 30.0, max_steps: 200_000 }
    }
}

/// What the transmission does at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The coil is free of the bore: input and output turn as one, but for the winding of the coil.
    ModeI,
    /// The coil lies in the bore and the ring still turns: between the modes.
    Shifts,
    /// The bore holds the ring.
    ModeII,
    /// The coil slips on the hub without reaching the bore: the torque is limited.
    SlipsOnHub,
    /// The coil slips in the bore and on the hub: the torque is limited.
    SlipsInBore,
    /// A reduction of one speed.
    OneSpeed,
    /// Nothing turns.
    Stands,
}

impl Phase {
    /// In words.
    pub fn word(self) -> &'static str {
        match self {
            Self::ModeI => "mode I",
            Self::Shifts => "shifts",
            Self::ModeII => "mode II",
            Self::SlipsOnHub => "slips on the hub",
            Self::SlipsInBore => "slips in the bore",
            Self::OneSpeed => "one speed",
            Self::Stands => "stands",
        }
    }
}

/// How a closing ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The force that is wanted was reached, and the motor switched off.
    Reached,
    /// The motor stands.
    Stalled,
    /// The finger stands and the motor turns on: the clutch slips.
    Slips,
    /// At the object, whose stiffness is not known.
    Touched,
    /// Not within the time or the steps.
    Unfinished,
}

/// A state on the way. SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// s.
    pub time_s: f64,
    /// What the transmission does from here on.
    pub phase: Phase,
    /// Current of the motor, A.
    pub current_a: f64,
    /// Its rate, A/s.
    pub current_rate: f64,
    /// Speed of the transmission's input, rad/s.
    pub input_rad_per_s: f64,
    /// Its rate, rad/s².
    pub input_rate: f64,
    /// Speed of its output, rad/s.
    pub output_rad_per_s: f64,
    /// Torque at its input, N·m. While everything stands, the least that holds.
    pub input_nm: f64,
    /// Torque at the hub end of the coil, N·m.
    pub hub_nm: f64,
    /// Way of the finger, m.
    pub way_m: f64,
    /// Its rate, m/s.
    pub way_rate: f64,
    /// Force on the object, N.
    pub force_n: f64,
    /// Electric energy taken so far, J.
    pub electric_j: f64,
    /// Electric power, W.
    pub electric_w: f64,
}

/// Where the energy went, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// Taken by the motor at its terminals.
    pub electric: f64,
    /// Heat of the winding.
    pub joule: f64,
    /// Friction of the motor and its reduction.
    pub motor: f64,
    /// Slip of the coil on the hub.
    pub hub: f64,
    /// Slip of the coil in the bore.
    pub bore: f64,
    /// Losses of the modes, of the finger's reduction, of glove and joints.
    pub output: f64,
    /// In motion at the end.
    pub kinetic: f64,
    /// In coil and glove at the end.
    pub elastic: f64,
    /// In the object at the end.
    pub object: f64,
}

impl Energies {
    /// What is not accounted for: zero but for errors of the integration.
    pub fn residual_j(&self) -> f64 {
        self.electric - (self.joule + self.motor + self.hub + self.bore + self.output + self.kinetic + self.elastic + self.object)
    }
}

/// A closing of the hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Grasp {
    /// States from rest to the end: every 2 ms at first, then every hundredth of the time, and on both sides of every event.
    pub trace: Vec<Instant>,
    /// What the transmission did, each from its time (s) to the next.
    pub phases: Vec<(f64, Phase)>,
    /// When the object was touched first, s.
    pub touch_s: Option<f64>,
    /// When the coil reached the bore first, s.
    pub shift_s: Option<f64>,
    /// How it ended.
    pub ending: Ending,
    /// Where the energy went.
    pub energies: Energies,
    /// Changes of what sticks and slips.
    pub changes: usize,
    /// Times the equations were evaluated.
    pub evaluations: u64,
}

/// A cubic by its ends and their rates, at a share of the interval.
fn hermite(share: f64, length: f64, [a, b]: [f64; 2], [a_rate, b_rate]: [f64; 2]) -> f64 {
    let rest = 1.0 - share;
    let straight = a * rest * rest * (1.0 + 2.0 * share) + b * share * share * (3.0 - 2.0 * share);
    straight + length * share * rest * (a_rate * rest - b_rate * share)
}

impl Grasp {
    /// The last state.
    pub fn last(&self) -> Option<&Instant> {
        self.trace.last()
    }

    /// Force on the object in the end, N; `None` where none was grasped.
    pub fn force_n(&self) -> Option<f64> {
        matches!(self.ending, Ending::Reached | Ending::Stalled | Ending::Slips).then_some(())?;
        self.touch_s?;
        self.last().map(|l| l.force_n)
    }

    /// From rest to 95 % of the force in the end, s; the last time that it rises to it, as an impact may do so before.
    pub fn grasp_s(&self) -> Option<f64> {
        let wanted_n = 0.95 * self.force_n()?;
        let pair = self.trace.windows(2).rfind(|p| p[0].force_n < wanted_n && p[1].force_n >= wanted_n)?;
        let (a, b) = (pair[0], pair[1]);
        let length = b.time_s - a.time_s;
        // The force goes with the way, whose rate is known.
        let scale = (b.force_n - a.force_n) / (b.way_m - a.way_m);
        let at =
            |share: f64| a.force_n + scale * (hermite(share, length, [a.way_m, b.way_m], [a.way_rate, b.way_rate]) - a.way_m) - wanted_n;
        let share = forcewright_base::roots::root(at, 0.0, 1.0, 1e-12).unwrap_or(1.0);
        Some(a.time_s + share * length)
    }

    /// Electric energy of the grasp, J: until the wanted force, or until 95 % of that of a stall, as a stalled motor takes more for as long
    /// as it is left on. `None` where the clutch slips or nothing is grasped.
    pub fn energy_j(&self) -> Option<f64> {
        self.force_n()?;
        match self.ending {
            Ending::Reached => Some(self.energies.electric),
            Ending::Stalled => {
                let time_s = self.grasp_s()?;
                let pair = self.trace.windows(2).find(|p| p[0].time_s <= time_s && time_s < p[1].time_s)?;
                let (a, b) = (&pair[0], &pair[1]);
                let length = b.time_s - a.time_s;
                Some(hermite((time_s - a.time_s) / length, length, [a.electric_j, b.electric_j], [a.electric_w, b.electric_w]))
            }
            _ => None,
        }
    }

    /// Largest current, A, between the states of the trace too.
    pub fn peak_a(&self) -> f64 {
        self.peak(|i| [i.current_a, i.current_rate])
    }

    /// Largest speed of the transmission's input in either sense, rad/s, between the states of the trace too.
    pub fn peak_input_rad_per_s(&self) -> f64 {
        let [ahead, back] = [1.0, -1.0].map(|sign| self.peak(|i| [sign * i.input_rad_per_s, sign * i.input_rate]));
        ahead.max(back)
    }

    /// Largest of a quantity that comes with its rate, at least 0.
    fn peak(&self, of: impl Fn(&Instant) -> [f64; 2]) -> f64 {
        let ends = self.trace.iter().map(|i| of(i)[0]).fold(0.0, f64::max);
        let inside = self.trace.windows(2).filter_map(|p| {
            let ([from, from_rate], [to, to_rate]) = (of(&p[0]), of(&p[1]));
            let length = p[1].time_s - p[0].time_s;
            if length <= 0.0 || from_rate <= 0.0 || to_rate >= 0.0 {
                return None;
            }
            // Where the rate of the cubic is zero: one root, as it falls from above zero to below.
            let (rise, [u, v]) = (to - from, [length * from_rate, length * to_rate]);
            let (c, d) = (3.0 * rise - 2.0 * u - v, u + v - 2.0 * rise);
            let rate = |x: f64| u + x * (2.0 * c + 3.0 * d * x);
            let share = forcewright_base::roots::root(rate, 0.0, 1.0, 1e-12).ok()?;
            Some(hermite(share, length, [from, to], [from_rate, to_rate]))
        });
        inside.fold(ends, f64::max)
    }

    /// Whether it came to an end.
    pub fn is_finished(&self) -> bool {
        self.ending != Ending::Unfinished
    }
}

/// Force at the finger at which a grasp is done: that of the hand, or that of the required output torque; without both, none.
pub(crate) fn target_n(design: &Design) -> f64 {
    let Some(hand) = &design.hand else { return f64::INFINITY };
    let required = || Some(crate::analysis::finger_force_n(hand, design.requirements.as_ref()?.output_nm?));
    hand.force_n.or_else(required).unwrap_or(f64::INFINITY)
}

/// Closes the hand of a design. `None` where motor, hand, an inertia or the opening are not known, or the supply ends without voltage.
pub fn grasp(design: &Design, statics: &Statics, clutch: &WrapSpring) -> Option<Grasp> {
    grasp_with(design, statics, clutch, &ClosingSettings::default())
}

/// The same with settings of one's own.
pub fn grasp_with(design: &Design, statics: &Statics, clutch: &WrapSpring, settings: &ClosingSettings) -> Option<Grasp> {
    let coupling = Coupling::two_speed(&design.built, statics, clutch)?;
    let plant = Plant::new(design.motor.as_ref()?, design.hand.as_ref()?, coupling)?;
    run::closed(&plant, target_n(design), settings)
}

/// A reduction of one speed in place of the transmission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneSpeed {
    /// Turns of the input for one of the output, above 0.
    pub reduction: f64,
    /// Part of the torque that is lost, 0 … below 1.
    pub proportional: f64,
    /// Torque that is lost at any load, at the output, N·m.
    pub constant_nm: f64,
}

/// Closes the same hand by the same motor through a reduction of one speed.
pub fn grasp_one_speed(design: &Design, one: &OneSpeed, settings: &ClosingSettings) -> Option<Grasp> {
    let sound = one.reduction > 0.0 && one.reduction.is_finite() && (0.0..1.0).contains(&one.proportional) && one.constant_nm >= 0.0;
    let coupling = sound.then(|| Coupling::one_speed(one.reduction, one.proportional, one.constant_nm))?;
    let plant = Plant::new(design.motor.as_ref()?, design.hand.as_ref()?, coupling)?;
    run::closed(&plant, target_n(design), settings)
}

/// The reduction of one speed that closes as fast: that of mode I.
fn as_fast(statics: &Statics) -> OneSpeed {
    OneSpeed { reduction: 1.0, proportional: statics.proportional[0], constant_nm: statics.constant_nm[0] }
}

/// The one that gives an output torque with the same input torque as the transmission, with the losses of its gears.
fn as_strong(statics: &Statics, output_nm: f64) -> OneSpeed {
    let proportional = statics.proportional[1];
    let reduction = output_nm / (statics.plateau_end_nm(output_nm) * (1.0 - proportional));
    OneSpeed { reduction, proportional, constant_nm: 0.0 }
}
