//! What the transmission does under a torque at rest: both modes, the blocked interval between them, and the way back.
//!
//! With k = (1 − R)/R the torque on the spring is k `τ_in`: that of the ring on its planets. Mode I ends at `τ_t`; then the bore holds the
//! ring, and the carrier turns once the hub slips, `τ_in/R` = `τ_out` + `τ_b`. Losses count at the output. Theory: `docs/theory/lavt.md`.

use forcewright_elements::wrap_spring::{Dimensions, Model, Options, WrapSpring, WrapSpringError};

use crate::design::{Built, Source};

/// What the transmission does as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Sun, carrier and ring turn together.
    ModeI,
    /// The spring holds ring, chassis and carrier: nothing turns.
    Blocked,
    /// The ring stands, the hub slips, the carrier turns slowly.
    ModeII,
    /// The spring slips on the hub and never reaches the bore: the torque is limited.
    SlipsBeforeShift,
    /// The spring slips on the hub and in the bore: the ring turns backwards, the torque is limited.
    SlipsInBore,
}

impl State {
    /// In words.
    pub fn word(self) -> &'static str {
        match self {
            Self::ModeI => "mode I",
            Self::Blocked => "blocked",
            Self::ModeII => "mode II",
            Self::SlipsBeforeShift => "slips before it shifts",
            Self::SlipsInBore => "slips in the bore",
        }
    }
}

/// Torques of a transmission, N·m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statics {
    /// R.
    pub ratio: f64,
    /// `τ_t`: the spring reaches the bore.
    pub transition_nm: f64,
    /// `τ_b`: the spring slips on the hub.
    pub hub_nm: f64,
    /// Largest torque on the spring that the bore holds; `None` where it is not reached.
    pub grip_nm: Option<f64>,
    /// Largest torque on the spring in the closing sense.
    pub lock_nm: f64,
    /// Parts that are lost in mode I and II.
    pub proportional: [f64; 2],
    /// Torques that are lost in mode I and II, at the output.
    pub constant_nm: [f64; 2],
}

/// The clutch of a transmission.
///
/// # Errors
/// Numbers that make no spring.
pub fn clutch(built: &Built, source: Source) -> Result<WrapSpring, WrapSpringError> {
    let [hub_interference_m, bore_opening_m] = built.gaps_m();
    let spring = &built.spring;
    let model = match source {
        Source::Corrected => Model::Corrected,
        Source::Paper => Model::Paper,
    };
    let dimensions = Dimensions {
        wire_m: spring.wire_m,
        neutral_radius_m: 0.5 * (spring.inner_m + spring.wire_m),
        young_modulus_pa: spring.young_pa,
        hub_interference_m,
        bore_opening_m,
        hub_turns: spring.hub_turns,
        bore_turns: spring.bore_turns,
        free_turns: spring.free_turns,
    };
    WrapSpring::new(&dimensions, Options { model, ..Options::default() })
}

impl Statics {
    /// The torques of a transmission with these coefficients of friction on hub and bore, at least 0.
    ///
    /// # Errors
    /// Friction below zero, or not a number.
    pub fn new(built: &Built, clutch: &WrapSpring, friction: [f64; 2], mesh_loss: f64) -> Result<Self, WrapSpringError> {
        let limits = clutch.limits_on(friction)?;
        let [one, two] = built.losses;
        Ok(Self {
            ratio: built.ratio(),
            transition_nm: limits.transition_nm,
            hub_nm: limits.hub_slip_nm,
            grip_nm: limits.grip_nm,
            lock_nm: limits.lock_nm,
            proportional: [one.proportional.unwrap_or(0.0), two.proportional.unwrap_or(mesh_loss)],
            constant_nm: [one.constant_nm, two.constant_nm],
        })
    }

    /// Torque on the spring over that at the input, k = (1 − R)/R.
    pub fn leverage(&self) -> f64 {
        (1.0 - self.ratio) / self.ratio
    }

    /// Input torque at which mode I ends, N·m; eq. (19). Where the spring slips first, that.
    pub fn transition_input_nm(&self) -> f64 {
        self.transition_nm.min(self.hub_nm) / self.leverage()
    }

    /// Output torque at which mode I ends, N·m.
    pub fn transition_output_nm(&self) -> f64 {
        self.mode_1_nm(self.transition_input_nm())
    }

    /// Input torque at which the hub slips while the output carries a torque, N·m.
    pub fn plateau_end_nm(&self, output_nm: f64) -> f64 {
        self.ratio * (output_nm + self.hub_nm + self.constant_nm[1]) / (1.0 - self.proportional[1])
    }

    /// Output torque below which mode II gives way to mode I, N·m; below 0 where even an unloaded output stays in mode II; `None` without
    /// a mode II.
    pub fn downshift_nm(&self) -> Option<f64> {
        self.grip_nm.map(|_| self.freely_nm(self.transition_nm / self.leverage()))
    }

    /// Largest input torque that is held, N·m: by the bore, or by the hub where the bore is not reached.
    pub fn held_input_nm(&self) -> f64 {
        self.grip_nm.unwrap_or(self.hub_nm) / self.leverage()
    }

    /// Largest input torque in the opening direction of the hand, N·m: there the spring tightens on the hub. Eq. (29).
    pub fn opening_input_nm(&self) -> f64 {
        self.lock_nm / self.leverage()
    }

    fn mode_1_nm(&self, input_nm: f64) -> f64 {
        ((1.0 - self.proportional[0]) * input_nm - self.constant_nm[0]).max(0.0)
    }

    /// Eq. (17), below 0 too.
    fn freely_nm(&self, input_nm: f64) -> f64 {
        (1.0 - self.proportional[1]) * input_nm / self.ratio - self.hub_nm - self.constant_nm[1]
    }

    fn mode_2_nm(&self, input_nm: f64) -> f64 {
        self.freely_nm(input_nm).max(0.0)
    }

    /// State and output torque (N·m) as the input torque grows from zero and the output gives way whenever it can.
    pub fn output(&self, input_nm: f64) -> (State, f64) {
        let shifts_nm = self.transition_input_nm();
        let carried_nm = self.transition_output_nm();
        if input_nm <= shifts_nm {
            return (State::ModeI, self.mode_1_nm(input_nm));
        }
        if self.grip_nm.is_none() {
            return (State::SlipsBeforeShift, carried_nm);
        }
        let held_nm = self.held_input_nm();
        let given_nm = self.mode_2_nm(input_nm.min(held_nm));
        if given_nm <= carried_nm {
            (if input_nm > held_nm { State::SlipsInBore } else { State::Blocked }, carried_nm)
        } else {
            (if input_nm > held_nm { State::SlipsInBore } else { State::ModeII }, given_nm)
        }
    }

    /// Power at the output over power at the input; `None` where nothing turns or something runs away.
    pub fn efficiency(&self, input_nm: f64) -> Option<f64> {
        match self.output(input_nm) {
            (State::ModeI, output_nm) if input_nm > 0.0 => Some(output_nm / input_nm),
            (State::ModeII, output_nm) => Some(self.ratio * output_nm / input_nm),
            _ => None,
        }
    }
}
