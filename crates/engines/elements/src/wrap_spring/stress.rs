//! Bending stress of curved round wire.

use std::f64::consts::PI;

use super::{WrapSpring, WrapSpringError, finite, not_negative};

/// Largest bending stress over that of a straight wire, at the inside and at the outside of the coil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BendingFactors {
    /// At the inside: above 1.
    pub inner: f64,
    /// At the outside: below 1.
    pub outer: f64,
}

/// Wahl's bending factors of round wire for a spring index `C = D/d` above 1: `(4C² ∓ C − 1)/(4C(C ∓ 1))`, the inner with the upper sign.
/// Shigley, eq. (10–43) (`budynas-nisbett2011`). The paper's `k_b`, eq. (22), is the inner one.
///
/// Not to be taken for Wahl's factor of shear stress ([`crate::springs::Helix::wahl`]).
///
/// # Errors
/// [`WrapSpringError::Value`]
pub fn wahl_factors(index: f64) -> Result<BendingFactors, WrapSpringError> {
    curved(index)?;
    let c = index;
    Ok(BendingFactors { inner: (4.0 * c * c - c - 1.0) / (4.0 * c * (c - 1.0)), outer: (4.0 * c * c + c - 1.0) / (4.0 * c * (c + 1.0)) })
}

/// The same by the theory of curved beams of Winkler and Bach for a round section, which Wahl's factors approximate: the neutral axis lies
/// at `½(R + √(R² − r²))` (Shigley, Table 3–4, and eq. 3–65).
///
/// # Errors
/// [`WrapSpringError::Value`]
pub fn winkler_factors(index: f64) -> Result<BendingFactors, WrapSpringError> {
    curved(index)?;
    // In wire radii: mean radius C, neutral axis n, eccentricity e; straight wire has M r/I = 4 M/(π r³).
    let neutral = 0.5 * (index + (index * index - 1.0).sqrt());
    // C − n without the loss of digits at a large index.
    let eccentricity = 0.5 / (index + (index * index - 1.0).sqrt());
    let factor = |offset: f64, radius: f64| offset / (4.0 * eccentricity * radius);
    Ok(BendingFactors { inner: factor(neutral - (index - 1.0), index - 1.0), outer: factor(index + 1.0 - neutral, index + 1.0) })
}

fn curved(index: f64) -> Result<(), WrapSpringError> {
    if index > 1.0 && index.is_finite() { Ok(()) } else { Err(WrapSpringError::Value { name: "index", value: index }) }
}

/// Bending stress of straight round wire, `32 M/(π d³)`, Pa.
pub fn bending_pa(moment_nm: f64, wire_m: f64) -> f64 {
    32.0 * moment_nm / (PI * wire_m * wire_m * wire_m)
}

/// Largest stresses in a wrap spring, at the inside of the coil, where opening pulls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stresses {
    /// Inner bending factor of Wahl for the free coil, `k_b`.
    pub factor: f64,
    /// Bending on the hub, Pa: there all the time.
    pub hub_pa: f64,
    /// Bending in the bore, Pa: whatever the torque, as the bore keeps the curvature.
    pub bore_pa: f64,
}

impl WrapSpring {
    /// Bending stresses where hub and bore keep the curvature. Eq. (21) of `butin2023` with the moments of hub and bore.
    pub fn stresses(&self) -> Stresses {
        let factor = self.factor();
        let bend = |moment_nm: f64| factor * bending_pa(moment_nm, self.dimensions.wire_m);
        Stresses { factor, hub_pa: bend(self.hub_moment_nm), bore_pa: bend(self.transition_nm) }
    }

    /// Bending stress (Pa) in turns that nothing supports under a torque (N·m) that they carry, eq. (21): for the free turns at most the
    /// slip torque of the hub; for turns between S and the bore the whole torque on S, which is why there should be none.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`]
    pub fn unsupported_pa(&self, torque_nm: f64) -> Result<f64, WrapSpringError> {
        finite("torque_nm", torque_nm)?;
        Ok(self.factor() * bending_pa(torque_nm.abs(), self.dimensions.wire_m))
    }

    /// Tension (Pa, over the whole section) where the coil leaves the hub while that holds a torque in the closing sense (N·m, at least 0):
    /// `(M_A + τ)/(r A)` at the mean radius on the hub. It adds to the bending there.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`]
    pub fn locked_tension_pa(&self, torque_nm: f64) -> Result<f64, WrapSpringError> {
        not_negative("torque_nm", torque_nm)?;
        let d = self.dimensions.wire_m;
        let area_m2 = 0.25 * PI * d * d;
        Ok((self.hub_moment_nm + torque_nm) / (self.hub_radius_m() * area_m2))
    }

    /// Mean radius of the coil on the hub, m.
    pub fn hub_radius_m(&self) -> f64 {
        self.dimensions.neutral_radius_m + self.dimensions.hub_interference_m
    }

    /// Mean radius of the coil in the bore, m.
    pub fn bore_radius_m(&self) -> f64 {
        self.dimensions.neutral_radius_m + self.dimensions.bore_opening_m
    }

    fn factor(&self) -> f64 {
        // The index is above 1: checked where the spring was made.
        let c = self.index();
        (4.0 * c * c - c - 1.0) / (4.0 * c * (c - 1.0))
    }
}
