//! Contact of two cylinders along a line: pressure, stress below the surface, first yield, and fatigue of steel surfaces.
//!
//! | Johnson 1985 | here | unit |
//! | --- | --- | --- |
//! | P | load over length, `load_n_per_m` | N/m |
//! | R | `1 / curvature_per_m`, of both bodies together | m |
//! | E* | `contact_modulus_pa` | Pa |
//! | a, p₀ | `half_width_m`, `pressure_pa` | m, Pa |
//!
//! Elastic half-spaces without friction: the half width must be small against the radii.
//!
//! ```
//! use forcewright_elements::hertz::{self, Solid};
//!
//! // A steel roller of 16 mm radius on a steel plate, 50 N over 10 mm.
//! let steel = Solid { young_modulus_pa: 206e9, poisson_ratio: 0.3 };
//! let contact = hertz::line_contact(5000.0, [0.016, f64::INFINITY], [steel, steel]).expect("convex on flat");
//! assert!((contact.pressure_pa / 106.1e6 - 1.0).abs() < 1e-3 && contact.half_width_m < 0.1e-3);
//! ```

use std::f64::consts::PI;
use std::fmt;

use forcewright_base::maths::powf;
use forcewright_base::roots;

/// An elastic body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Young's modulus, Pa; above 0.
    pub young_modulus_pa: f64,
    /// Poisson's ratio; −1 to 0.5.
    pub poisson_ratio: f64,
}

/// Why there is no Hertzian line contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HertzError {
    /// Young's modulus is not above 0 or Poisson's ratio is not in −1 … 0.5.
    Solid {
        /// The body.
        solid: Solid,
    },
    /// The load is negative or not finite: bodies do not hold on to each other.
    Load {
        /// What was given, N/m.
        load_n_per_m: f64,
    },
    /// The bodies fit each other, or one is sharper than its hollow: the contact is not a narrow strip.
    Conforming {
        /// 1/R₁ + 1/R₂, 1/m.
        curvature_per_m: f64,
    },
}

impl fmt::Display for HertzError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Solid { solid } => {
                let Solid { young_modulus_pa, poisson_ratio } = solid;
                write!(f, "no elastic body has a modulus of {young_modulus_pa} Pa and a Poisson's ratio of {poisson_ratio}")
            }
            Self::Load { load_n_per_m } => write!(f, "a contact cannot carry {load_n_per_m} N/m; the load must press, or be 0"),
            Self::Conforming { curvature_per_m } => {
                write!(
                    f,
                    "surfaces with a relative curvature of {curvature_per_m}/m do not touch along a line; a hollow must be wider than what lies in it"
                )
            }
        }
    }
}

impl std::error::Error for HertzError {}

/// A strip of contact between parallel cylinders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineContact {
    /// Half of the width of the strip, m.
    pub half_width_m: f64,
    /// Largest pressure, in the middle, Pa.
    pub pressure_pa: f64,
    /// Largest shear stress below the surface, Pa.
    pub shear_pa: f64,
    /// Where it is, m below the middle.
    pub shear_depth_m: f64,
}

/// Line contact of two bodies: load over length (N/m, at least 0), radii (m; negative for a hollow, infinite for a plane), and what
/// they are made of. K. L. Johnson, "Contact Mechanics", Cambridge 1985, eqs. (4.43) to (4.45) and (4.49) (`johnson1985`).
///
/// # Errors
/// [`HertzError`]
pub fn line_contact(load_n_per_m: f64, radii_m: [f64; 2], solids: [Solid; 2]) -> Result<LineContact, HertzError> {
    let modulus_pa = contact_modulus_pa(solids)?;
    let curvature_per_m = relative_curvature_per_m(radii_m)?;
    if !(load_n_per_m >= 0.0 && load_n_per_m.is_finite()) {
        return Err(HertzError::Load { load_n_per_m });
    }
    let half_width_m = (4.0 * load_n_per_m / (PI * modulus_pa * curvature_per_m)).sqrt();
    let pressure_pa = (load_n_per_m * modulus_pa * curvature_per_m / PI).sqrt();
    // From (4.49) the shear stress is largest where (z/a)⁴ + (z/a)² = 1, half of the square root of five less one.
    let depth = (0.5 * (5.0_f64.sqrt() - 1.0)).sqrt();
    let shear = depth - depth * depth / (1.0 + depth * depth).sqrt();
    Ok(LineContact { half_width_m, pressure_pa, shear_pa: shear * pressure_pa, shear_depth_m: depth * half_width_m })
}

/// The load (N/m) at which the largest pressure has a value (Pa): the square of that of [`line_contact`].
///
/// # Errors
/// [`HertzError`]
pub fn load_at_pressure_n_per_m(pressure_pa: f64, radii_m: [f64; 2], solids: [Solid; 2]) -> Result<f64, HertzError> {
    Ok(PI * pressure_pa * pressure_pa / (contact_modulus_pa(solids)? * relative_curvature_per_m(radii_m)?))
}

/// `1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂`, Pa.
///
/// # Errors
/// [`HertzError::Solid`]
pub fn contact_modulus_pa(solids: [Solid; 2]) -> Result<f64, HertzError> {
    let mut compliance_per_pa = 0.0;
    for solid in solids {
        let Solid { young_modulus_pa, poisson_ratio } = solid;
        if !(young_modulus_pa > 0.0 && young_modulus_pa.is_finite() && (-1.0..=0.5).contains(&poisson_ratio)) {
            return Err(HertzError::Solid { solid });
        }
        compliance_per_pa += (1.0 - poisson_ratio * poisson_ratio) / young_modulus_pa;
    }
    Ok(1.0 / compliance_per_pa)
}

/// `1/R₁ + 1/R₂`, 1/m.
fn relative_curvature_per_m(radii_m: [f64; 2]) -> Result<f64, HertzError> {
    let curvature_per_m = 1.0 / radii_m[0] + 1.0 / radii_m[1];
    if curvature_per_m > 0.0 && curvature_per_m.is_finite() { Ok(curvature_per_m) } else { Err(HertzError::Conforming { curvature_per_m }) }
}

/// Stresses below the middle of the strip over the largest pressure: across the strip, along it, into the depth. Depth in half widths.
/// Johnson, eqs. (4.49a) and (4.49b); along the strip from plane strain.
fn stresses_below(depth: f64, poisson_ratio: f64) -> [f64; 3] {
    let root = (1.0 + depth * depth).sqrt();
    let (across, into) = (-((1.0 + 2.0 * depth * depth) / root - 2.0 * depth), -1.0 / root);
    [across, poisson_ratio * (across + into), into]
}

/// The largest pressure (Pa) at which nothing yields, for a yield stress (Pa) and Poisson's ratio of the weaker body, by the criterion of
/// von Mises: 1.79 times the yield stress for ν = 0.3 (Johnson, section 6.1). The first yield is below the surface.
///
/// Absent if the yield stress is not above 0 or Poisson's ratio is not in 0 … 0.5.
pub fn first_yield_pressure_pa(yield_stress_pa: f64, poisson_ratio: f64) -> Option<f64> {
    if !(yield_stress_pa > 0.0 && yield_stress_pa.is_finite() && (0.0..=0.5).contains(&poisson_ratio)) {
        return None;
    }
    let equivalent = |depth: f64| {
        let [x, y, z] = stresses_below(depth, poisson_ratio);
        (0.5 * ((x - y) * (x - y) + (y - z) * (y - z) + (z - x) * (z - x))).sqrt()
    };
    // For a small Poisson's ratio the surface itself, where σ_x = σ_z = −p₀, is worse than the inside.
    let inside = -roots::minimise(|depth| -equivalent(depth), 0.2, 2.0, 1e-9).value;
    Some(yield_stress_pa / inside.max(equivalent(0.0)))
}

/// Largest pressure (Pa) that the surface of a through-hardened steel endures for a number of load cycles, by its Brinell hardness.
///
/// `S_C = 2.76 HB − 70 MPa` for 1e8 cycles of steel on steel, a correlation of rolling tests, and a change with the power −0.056 of the
/// cycles from 1e4 to 1e10: Budynas & Nisbett, "Shigley's Mechanical Engineering Design", 9th ed., section 6–16, eqs. (6–67) and (6–68)
/// (`budynas-nisbett2011`). The book states no reliability: ask for a margin.
///
/// Absent, that is not assessed, for other numbers of cycles, and for a hardness outside 100 … 400, the range of steels that are not
/// case-hardened.
pub fn surface_strength_pa(brinell: f64, cycles: f64) -> Option<f64> {
    let known = (100.0..=400.0).contains(&brinell) && (LIFE_CYCLES[0]..=LIFE_CYCLES[1]).contains(&cycles);
    known.then(|| (2.76e6 * brinell - 70e6) * powf(cycles / 1e8, LIFE_POWER))
}

/// Power of the cycles in the surface strength.
const LIFE_POWER: f64 = -0.056;

/// Cycles for which [`surface_strength_pa`] is known.
pub const LIFE_CYCLES: [f64; 2] = [1e4, 1e10];

/// Life of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Life {
    /// Fewer cycles than the lower of [`LIFE_CYCLES`].
    Shorter,
    /// Load cycles.
    Cycles(f64),
    /// More cycles than the upper of [`LIFE_CYCLES`].
    Longer,
}

/// Cycles of a largest pressure (Pa, above 0) that a steel surface endures: [`surface_strength_pa`] the other way round. Absent where
/// that is.
pub fn surface_life(pressure_pa: f64, brinell: f64) -> Option<Life> {
    let strength_pa = surface_strength_pa(brinell, 1e8).filter(|_| pressure_pa > 0.0)?;
    let cycles = 1e8 * powf(pressure_pa / strength_pa, 1.0 / LIFE_POWER);
    Some(if cycles < LIFE_CYCLES[0] {
        Life::Shorter
    } else if cycles > LIFE_CYCLES[1] {
        Life::Longer
    } else {
        Life::Cycles(cycles)
    })
}

/// Buckingham's load-stress factor `K₁ = π S_C² / E*` (Pa): the load over length times the relative curvature that the surface endures.
/// Shigley, 9th ed., eq. (6–64).
///
/// # Errors
/// [`HertzError::Solid`]
pub fn load_stress_factor_pa(strength_pa: f64, solids: [Solid; 2]) -> Result<f64, HertzError> {
    Ok(PI * strength_pa * strength_pa / contact_modulus_pa(solids)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: Solid = Solid { young_modulus_pa: 206e9, poisson_ratio: 0.3 };
    const NYLON: Solid = Solid { young_modulus_pa: 2.8e9, poisson_ratio: 0.4 };

    fn near(ours: f64, exact: f64, relative: f64) {
        assert!((ours / exact - 1.0).abs() < relative, "{ours} instead of {exact}");
    }

    /// Shigley's form (6–59) and (6–60), in diameters and without E*: the same contact written by others.
    #[test]
    fn agrees_with_the_form_in_diameters() {
        let (force_n, length_m, diameters_m) = (1234.0, 0.025, [0.04, 0.11]);
        let bodies = [STEEL, NYLON].map(|s| (1.0 - s.poisson_ratio * s.poisson_ratio) / s.young_modulus_pa);
        let b = (2.0 * force_n / (PI * length_m) * (bodies[0] + bodies[1]) / (1.0 / diameters_m[0] + 1.0 / diameters_m[1])).sqrt();
        let contact = line_contact(force_n / length_m, diameters_m.map(|d| 0.5 * d), [STEEL, NYLON]).unwrap();
        near(contact.half_width_m, b, 1e-14);
        near(contact.pressure_pa, 2.0 * force_n / (PI * b * length_m), 1e-14);
        // 0.30 p₀ at 0.78 a (Johnson, below eq. (4.49)).
        near(contact.shear_pa / contact.pressure_pa, 0.300_283_106, 1e-8);
        near(contact.shear_depth_m / contact.half_width_m, 0.786_151_378, 1e-8);
    }

    /// The pressure is half an ellipse over the strip, so that the load is π/2 a p₀; pressures on the two bodies balance the curvatures:
    /// p₀ / E* = a / 2R. A plane is the limit of a large radius, a hollow lowers the pressure.
    #[test]
    fn load_and_shape_are_in_balance() {
        for radii_m in [[0.016, 0.03], [0.016, f64::INFINITY], [0.016, -0.02]] {
            let contact = line_contact(4e4, radii_m, [STEEL, STEEL]).unwrap();
            near(0.5 * PI * contact.half_width_m * contact.pressure_pa, 4e4, 1e-14);
            let curvature = 1.0 / radii_m[0] + 1.0 / radii_m[1];
            near(contact.pressure_pa / contact_modulus_pa([STEEL, STEEL]).unwrap(), 0.5 * contact.half_width_m * curvature, 1e-14);
            near(load_at_pressure_n_per_m(contact.pressure_pa, radii_m, [STEEL, STEEL]).unwrap(), 4e4, 1e-14);
        }
        let pressure = |second_m: f64| line_contact(4e4, [0.016, second_m], [STEEL, NYLON]).unwrap().pressure_pa;
        near(pressure(1e9), pressure(f64::INFINITY), 1e-9);
        assert!(pressure(-0.1) < pressure(f64::INFINITY) && pressure(f64::INFINITY) < pressure(0.1));
        // No load, no strip.
        assert!(line_contact(0.0, [0.1, 0.1], [STEEL, STEEL]).unwrap().half_width_m.abs() < f64::MIN_POSITIVE);
    }

    /// Printed by Johnson for ν = 0.3: 1.79 Y by von Mises, 1.67 Y by Tresca (half the yield stress as shear).
    #[test]
    fn first_yield_is_that_of_the_book() {
        near(first_yield_pressure_pa(1.0, 0.3).unwrap(), 1.79, 3e-3);
        let contact = line_contact(1e5, [0.02, 0.02], [STEEL, STEEL]).unwrap();
        near(0.5 / (contact.shear_pa / contact.pressure_pa), 1.67, 4e-3);
        // The strip at the surface is squeezed alike across and into the depth: by 1 − 2ν of the pressure more than along.
        near(first_yield_pressure_pa(1.0, 0.0).unwrap(), 1.0, 1e-12);
        assert_eq!(first_yield_pressure_pa(-1.0, 0.3), None);
        assert_eq!(first_yield_pressure_pa(1.0, 0.6), None);
    }

    /// Shigley, below eq. (6–67) and eq. (6–68): 239 kpsi at 1e8 and 271 kpsi at 1e7 cycles give a power of −0.055; 0.4 HB − 10 kpsi.
    #[test]
    fn surfaces_endure_what_the_book_says() {
        let kpsi = 6.894_757e6;
        near(surface_strength_pa(300.0, 1e8).unwrap(), (0.4 * 300.0 - 10.0) * kpsi, 2e-3);
        near(surface_strength_pa(250.0, 1e7).unwrap() / surface_strength_pa(250.0, 1e8).unwrap(), 271.0 / 239.0, 5e-3);
        let strength = surface_strength_pa(200.0, 3e6).unwrap();
        match surface_life(strength, 200.0) {
            Some(Life::Cycles(cycles)) => near(cycles, 3e6, 1e-12),
            other => panic!("{other:?}"),
        }
        assert_eq!((surface_life(0.1 * strength, 200.0), surface_life(3.0 * strength, 200.0)), (Some(Life::Longer), Some(Life::Shorter)));
        for (brinell, cycles) in [(90.0, 1e8), (650.0, 1e8), (200.0, 1e3), (200.0, 1e11), (f64::NAN, 1e8)] {
            assert_eq!(surface_strength_pa(brinell, cycles), None);
        }
        assert_eq!(surface_life(1e8, 500.0), None);
        // The factor is the load at that pressure times the relative curvature.
        let load = load_at_pressure_n_per_m(strength, [0.02, 0.05], [STEEL, STEEL]).unwrap();
        near(load_stress_factor_pa(strength, [STEEL, STEEL]).unwrap(), load * (1.0 / 0.02 + 1.0 / 0.05), 1e-14);
    }

    #[test]
    fn faults_are_named() {
        let both = [STEEL, STEEL];
        assert!(matches!(line_contact(1.0, [0.02, -0.02], both), Err(HertzError::Conforming { .. })));
        assert!(matches!(line_contact(1.0, [0.02, -0.01], both), Err(HertzError::Conforming { .. })));
        assert!(matches!(line_contact(1.0, [0.0, 0.1], both), Err(HertzError::Conforming { .. })));
        assert!(matches!(line_contact(-1.0, [0.1, 0.1], both), Err(HertzError::Load { .. })));
        assert!(matches!(line_contact(f64::NAN, [0.1, 0.1], both), Err(HertzError::Load { .. })));
        let bad = Solid { young_modulus_pa: 0.0, ..STEEL };
        assert_eq!(line_contact(1.0, [0.1, 0.1], [STEEL, bad]), Err(HertzError::Solid { solid: bad }));
    }
}
