//! Torques at which a wrap spring slips, the friction it needs, and the state it is in.

use forcewright_base::maths::{exp, ln_1p};
use forcewright_base::roots;

use super::{Model, WrapSpring, WrapSpringError, finite, grip_nm, locking_slip_nm, not_negative, opening_slip_nm};

/// Torques that differ by less, relative to them, are equal.
const ROUNDING: f64 = 1e-12;

/// What a wrap spring does under a torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// No torque: the coil sits on the hub, away from the bore.
    Free,
    /// The coil opens and carries the torque to the hub.
    Opening,
    /// The coil slips on the hub and has not reached the bore: a torque limiter, which never shifts.
    SlipsBeforeShift,
    /// The coil lies in the bore, and the hub still holds: A, B and S are blocked together.
    AtBore,
    /// The coil slips on the hub, and the bore holds the torque: the clutch has shifted.
    Gripped,
    /// The coil slips on the hub and in the bore: more than the bore holds.
    SlipsInBore,
    /// A torque in the closing sense, held by the hub.
    Locked,
    /// A torque in the closing sense that is more than the hub holds.
    SlipsLocked,
}

/// Torques of a wrap spring at one coefficient of friction. With a large product of friction and turns they may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Torque that opens the coil to the bore, `τ_t`, N·m.
    pub transition_nm: f64,
    /// Torque at which the coil slips on the hub in the opening sense, `τ_b`, N·m: also the drag of an overrunning hub.
    pub hub_slip_nm: f64,
    /// Torque at which the coil slips on the hub in the closing sense, where friction tightens it, N·m.
    pub lock_nm: f64,
    /// Largest torque on S that the bore holds with the hub slipping, N·m; absent if the coil slips before it reaches the bore.
    pub grip_nm: Option<f64>,
}

impl Limits {
    /// The state under a torque on S (N·m), positive in the opening sense, when it grows from 0. A limit itself counts to the state below
    /// it, but a coil that slips on the hub at `τ_t` exactly does not shift.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`]: the torque is not finite.
    pub fn state(&self, torque_nm: f64) -> Result<State, WrapSpringError> {
        finite("torque_nm", torque_nm)?;
        Ok(if torque_nm < 0.0 {
            if -torque_nm <= self.lock_nm { State::Locked } else { State::SlipsLocked }
        } else if torque_nm <= 0.0 {
            State::Free
        } else {
            match self.grip_nm {
                None if torque_nm <= self.hub_slip_nm => State::Opening,
                None => State::SlipsBeforeShift,
                Some(_) if torque_nm <= self.transition_nm => State::Opening,
                Some(_) if torque_nm <= self.hub_slip_nm => State::AtBore,
                Some(grip_nm) if torque_nm <= grip_nm => State::Gripped,
                Some(_) => State::SlipsInBore,
            }
        })
    }

    /// Largest torque on S in the opening sense that is held, N·m: by the bore, or by the hub where the bore holds less or is not reached.
    pub fn largest_nm(&self) -> f64 {
        self.grip_nm.unwrap_or(0.0).max(self.hub_slip_nm)
    }
}

impl WrapSpring {
    /// The torques at a coefficient of friction; at least 0.
    ///
    /// In [`Model::Corrected`] a coil with `τ_b ≤ τ_t` slips before it shifts, and else `τ_S − τ_t ≤ (τ_b − τ_t) e^(2π N_B μ)`. In
    /// [`Model::Paper`] the bore is reached for `τ_b ≥ τ_t` and holds `τ_b (e^(2π N_B μ) − 1)`, eq. (28), without the condition that the
    /// state in between be one of equilibrium.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`]
    pub fn limits(&self, friction: f64) -> Result<Limits, WrapSpringError> {
        self.limits_on([friction; 2])
    }

    /// The same with a coefficient of friction on the hub and one in the bore.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`]
    pub fn limits_on(&self, [hub_friction, bore_friction]: [f64; 2]) -> Result<Limits, WrapSpringError> {
        not_negative("friction", hub_friction)?;
        not_negative("friction", bore_friction)?;
        let transition_nm = self.transition_nm;
        let hub = self.hub_exponent * hub_friction;
        let bore = self.bore_exponent * bore_friction;
        let lock_nm = locking_slip_nm(self.hub_moment_nm, hub);
        let (hub_slip_nm, grip_nm) = match self.options.model {
            Model::Corrected => {
                let slip_nm = opening_slip_nm(self.hub_moment_nm, hub);
                (slip_nm, (slip_nm > transition_nm).then(|| grip_nm(transition_nm, slip_nm, bore)))
            }
            Model::Paper => {
                let slip_nm = self.hub_moment_nm;
                // The paper's optimum has both equal, up to rounding.
                (slip_nm, (slip_nm >= transition_nm * (1.0 - ROUNDING)).then(|| locking_slip_nm(slip_nm, bore)))
            }
        };
        Ok(Limits { transition_nm, hub_slip_nm, lock_nm, grip_nm })
    }

    /// Torque at which the coil slips on the hub, N·m, for a coefficient of friction of at least 0: the cheap piece of [`WrapSpring::limits`]
    /// (one exponential).
    pub fn hub_slip_nm(&self, friction: f64) -> f64 {
        match self.options.model {
            Model::Corrected => opening_slip_nm(self.hub_moment_nm, self.hub_exponent * friction),
            Model::Paper => self.hub_moment_nm,
        }
    }

    /// Least coefficient of friction with which the coil reaches the bore before it slips; absent if none is enough.
    ///
    /// Corrected: `τ_b = τ_t`, that is `−ln(1 − τ_t/M_A)/(2π N_eff)`, and none unless the hub is tighter than the bore is wide. The paper
    /// instead asks that the bore then holds what the hub slips at, eq. (26): `ln(1 + δ_a/δ_b)/(2π N_B)`, which becomes its (27) for
    /// `δ_a = δ_b`.
    pub fn least_friction_to_reach(&self) -> Option<f64> {
        match self.options.model {
            Model::Corrected => {
                let ratio = self.transition_nm / self.hub_moment_nm;
                (ratio < 1.0 && self.hub_exponent > 0.0).then(|| -ln_1p(-ratio) / self.hub_exponent)
            }
            Model::Paper => {
                let ratio = self.hub_moment_nm / self.transition_nm;
                (ratio >= 1.0 - ROUNDING && self.bore_exponent > 0.0).then(|| ln_1p(ratio) / self.bore_exponent)
            }
        }
    }

    /// Least coefficient of friction with which the bore holds a torque on S (N·m, at least 0) while the hub slips; absent if none is
    /// enough. At least the friction needed to reach the bore; in [`Model::Paper`] that of eq. (28) alone.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`]
    pub fn least_friction_to_grip(&self, torque_nm: f64) -> Result<Option<f64>, WrapSpringError> {
        not_negative("torque_nm", torque_nm)?;
        let Some(reach) = self.least_friction_to_reach() else { return Ok(None) };
        Ok(match self.options.model {
            Model::Paper => Some(ln_1p(torque_nm / self.hub_moment_nm) / self.bore_exponent),
            Model::Corrected if torque_nm <= self.transition_nm => Some(reach),
            Model::Corrected => self.friction_to_exceed(torque_nm - self.transition_nm, reach),
        })
    }

    /// Root of `τ_b(μ) − τ_t = excess · e^(−2π N_B μ)`: the left side grows from 0 at `reach`, the right side does not grow.
    fn friction_to_exceed(&self, excess_nm: f64, reach: f64) -> Option<f64> {
        let beyond = |mu: f64| {
            let slip_nm = opening_slip_nm(self.hub_moment_nm, self.hub_exponent * mu);
            slip_nm - self.transition_nm - excess_nm * exp(-self.bore_exponent * mu)
        };
        if self.bore_exponent <= 0.0 && self.hub_moment_nm - self.transition_nm <= excess_nm {
            return None;
        }
        // `reach` may be 0 by underflow.
        let mut high = (2.0 * reach).max(1e-6);
        while beyond(high) <= 0.0 {
            high *= 2.0;
            if !high.is_finite() {
                return None;
            }
        }
        roots::root(beyond, reach, high, 1e-15 * high).ok()
    }

    /// Least coefficient of friction with which the hub holds a torque in the closing sense (N·m, at least 0); absent if there is no turn
    /// to hold it. Eq. (29).
    ///
    /// # Errors
    /// [`WrapSpringError::Value`]
    pub fn least_friction_to_lock(&self, torque_nm: f64) -> Result<Option<f64>, WrapSpringError> {
        not_negative("torque_nm", torque_nm)?;
        Ok((self.hub_exponent > 0.0).then(|| ln_1p(torque_nm / self.hub_moment_nm) / self.hub_exponent))
    }

    /// Mean radius (m) to which an unsupported part of the coil opens under a torque (N·m) that it carries; absent where the wire would be
    /// straight. A negative torque closes it.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`]
    pub fn open_radius_m(&self, torque_nm: f64) -> Result<Option<f64>, WrapSpringError> {
        finite("torque_nm", torque_nm)?;
        let radius_m = self.dimensions.neutral_radius_m;
        let curvature_per_m = 1.0 / radius_m - torque_nm / self.flexural_n_m2;
        Ok((curvature_per_m > 0.0).then(|| 1.0 / curvature_per_m))
    }
}
