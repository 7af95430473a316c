//! Strength of a coil in bending: static by EN 13906-3, fatigue by the percentages of Associated Spring.

use super::{WrapSpringError, not_negative, positive};
use crate::springs::{Grade, wire};

/// A static bending stress against what wire permits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticStrength {
    /// Least tensile strength of the wire, Pa.
    pub tensile_strength_pa: f64,
    /// Permissible bending stress, Pa.
    pub permissible_pa: f64,
    /// Stress over the permissible one.
    pub utilisation: f64,
}

/// A static bending stress (Pa, at least 0) in wire of a grade and diameter (m) against the permissible one of cold-coiled torsion springs,
/// 0.7 of the least tensile strength (`en13906-3`). The standard compares the stress without the factor of curvature; to give it with the
/// factor is cautious.
///
/// # Errors
/// [`WrapSpringError::Value`]: also for a diameter that the grade has no strength for.
pub fn static_strength(grade: &Grade, wire_m: f64, stress_pa: f64) -> Result<StaticStrength, WrapSpringError> {
    not_negative("stress_pa", stress_pa)?;
    let tensile_strength_pa = strength_pa(grade, wire_m)?;
    let permissible_pa = wire().bending_limit.value * tensile_strength_pa;
    Ok(StaticStrength { tensile_strength_pa, permissible_pa, utilisation: stress_pa / permissible_pa })
}

fn strength_pa(grade: &Grade, wire_m: f64) -> Result<f64, WrapSpringError> {
    positive("wire_m", wire_m)?;
    grade.tensile_strength_pa(wire_m).ok_or(WrapSpringError::Value { name: "wire_m", value: wire_m })
}

/// Number of cycles that data are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Life {
    /// 10⁵ cycles.
    HundredThousand,
    /// 10⁶ cycles.
    Million,
}

/// Treatment of the surface of the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// As coiled.
    AsCoiled,
    /// Shot-peened after coiling. The inside of close coils is hardly reached by shot.
    Peened,
}

/// Bending stresses of a cycle, with the inner factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Duty {
    /// Largest stress, Pa; at least 0.
    pub high_pa: f64,
    /// Least stress, Pa; 0 to the largest.
    pub low_pa: f64,
}

/// How a cycle lies against what the wire endures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Endurance {
    /// Largest stress that is endured when it falls to 0 in each cycle, Pa.
    pub pulsating_pa: f64,
    /// Amplitude that is endured without a mean stress, by Goodman's line through that, Pa.
    pub reversed_pa: f64,
    /// Factor by which the whole cycle may grow until it meets Goodman's line; infinite for none.
    pub safety: f64,
}

/// Endurance in bending of a wire of a grade and diameter (m), for a life and a surface.
///
/// Largest stress of a pulsating cycle over the tensile strength: 53 % at 10⁵ and 50 % at 10⁶ cycles, shot-peened 62 % and 60 %. These are
/// given for music wire (ASTM A228) and 302 stainless steel in Shigley, Table 10–10 (`budynas-nisbett2011`; after Associated Spring), for
/// springs without surging; the table itself could not be looked up again. Here they are used with the least strength of EN 10270-1 for
/// the grades DM and DH, the ones meant for dynamic load: an assumption. Other mean stresses by Goodman's line,
/// `σ_a/S_e + σ_m/R_m = 1/safety`.
///
/// # Errors
/// [`WrapSpringError::NoFatigueData`] for other grades; [`WrapSpringError::Value`] for a diameter that the grade has no strength for, or
/// stresses that are not as asked for.
pub fn endurance(grade: &Grade, wire_m: f64, life: Life, surface: Surface, duty: Duty) -> Result<Endurance, WrapSpringError> {
    if !["DM", "DH"].contains(&grade.name.as_str()) {
        return Err(WrapSpringError::NoFatigueData);
    }
    not_negative("high_pa", duty.high_pa)?;
    not_negative("low_pa", duty.low_pa)?;
    if duty.low_pa > duty.high_pa {
        return Err(WrapSpringError::Value { name: "low_pa", value: duty.low_pa });
    }
    let strength_pa = strength_pa(grade, wire_m)?;
    let share = match (surface, life) {
        (Surface::AsCoiled, Life::HundredThousand) => 0.53,
        (Surface::AsCoiled, Life::Million) => 0.50,
        (Surface::Peened, Life::HundredThousand) => 0.62,
        (Surface::Peened, Life::Million) => 0.60,
    };
    let half_pa = 0.5 * share * strength_pa;
    let reversed_pa = half_pa / (1.0 - 0.5 * share);
    let (amplitude_pa, mean_pa) = (0.5 * (duty.high_pa - duty.low_pa), 0.5 * (duty.high_pa + duty.low_pa));
    let used = amplitude_pa / reversed_pa + mean_pa / strength_pa;
    Ok(Endurance { pulsating_pa: share * strength_pa, reversed_pa, safety: 1.0 / used })
}
