//! Effective friction of a cable in a groove: friction acts on the sum of the pressures, the wrap only on their part towards the shaft.
//!
//! `μ′/μ = ∫p dφ / ∫p cos φ dφ` over the angle φ from the bottom of the seat. This is `longval-gosselin`, eqs. (37) to (42), where the angle is
//! counted from the edge of a full half circle. A factor of π/2 needs both that and a uniform pressure; makers' seats of 120 to 150° give
//! 1.17 to 1.36. Cosine pressure is what a cable has that wears the seat evenly.
//!
//! ```
//! use forcewright_elements::grooves::{Groove, Pressure};
//!
//! // A seat of 120° in all.
//! let seat = Groove::Round { half_angle_rad: 60.0_f64.to_radians(), pressure: Pressure::Cosine };
//! assert!((seat.friction_factor().expect("in range") - 1.1701).abs() < 1e-4);
//! ```

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;

use forcewright_base::maths::{cos, powf, sin, sin_cos};
use forcewright_base::quadrature::GaussLegendre;

/// Section of a groove.
#[derive(Clone, Debug, PartialEq)]
pub enum Groove {
    /// A smooth drum: the factor is 1.
    Flat,
    /// A round seat that touches the cable over an arc.
    Round {
        /// Half of the angle of contact ψ, rad; above 0, at most π/2.
        half_angle_rad: f64,
        /// Pressure over the seat.
        pressure: Pressure,
    },
    /// Two flat flanks that the cable touches at two points.
    Vee {
        /// Angle between a flank and the middle plane, rad; above 0, at most π/2.
        half_angle_rad: f64,
    },
    /// A round seat whose bottom is cut out, as on traction sheaves; cosine pressure.
    Undercut {
        /// Angle β of the undercut, rad; at least 0.
        undercut_rad: f64,
        /// Angle γ by which the seat falls short of a half circle, rad; at least 0, with β below π.
        opening_rad: f64,
    },
}

/// Pressure over a round seat; its size does not matter.
#[derive(Clone, Debug, PartialEq)]
pub enum Pressure {
    /// The same everywhere.
    Uniform,
    /// `cos φ`.
    Cosine,
    /// `cosⁿ φ` for n of at least 0. On a half circle that is `sinⁿ` of the paper's angle.
    CosinePower(f64),
    /// (Angle from the bottom of the seat, rad; pressure): angles ascending from −ψ to ψ, pressures at least 0 and not all 0, straight in
    /// between. A table that begins at 0 is taken for both halves.
    Table(Vec<[f64; 2]>),
}

/// Why a groove has no friction factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GrooveError {
    /// An angle is outside its range.
    Angle {
        /// Which.
        name: &'static str,
        /// What was given, rad.
        angle_rad: f64,
    },
    /// The exponent of the pressure is below 0 or not finite.
    Power {
        /// What was given.
        power: f64,
    },
    /// A table of pressure does not cover the seat in ascending angles, or presses nowhere.
    Table,
}

impl fmt::Display for GrooveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Angle { name, angle_rad } => write!(f, "`{name}` cannot be {angle_rad} rad"),
            Self::Power { power } => write!(f, "the pressure cannot follow the power {power} of the cosine"),
            Self::Table => {
                write!(f, "a table of pressure needs ascending angles over the whole seat and pressures of at least 0, not all 0")
            }
        }
    }
}

impl std::error::Error for GrooveError {}

impl Groove {
    /// Effective over real coefficient of friction, μ′/μ; at least 1.
    ///
    /// | groove | factor |
    /// | --- | --- |
    /// | flat | 1 |
    /// | round, uniform | `ψ / sin ψ` |
    /// | round, cosine | `2 sin ψ / (ψ + sin ψ cos ψ)` |
    /// | vee | `1 / sin` of the half angle |
    /// | undercut (EN 81-50, 5.11.2.3.1; `en81-50`) | `4 (cos γ/2 − sin β/2) / (π − β − γ − sin β + sin γ)` |
    ///
    /// Other pressures by quadrature: powers to 1e-12, tables exactly.
    ///
    /// # Errors
    /// [`GrooveError`]
    pub fn friction_factor(&self) -> Result<f64, GrooveError> {
        let in_quadrant = |angle_rad: f64| {
            let name = "half_angle_rad";
            if angle_rad > 0.0 && angle_rad <= FRAC_PI_2 { Ok(()) } else { Err(GrooveError::Angle { name, angle_rad }) }
        };
        match self {
            Self::Flat => Ok(1.0),
            Self::Vee { half_angle_rad } => in_quadrant(*half_angle_rad).map(|()| 1.0 / sin(*half_angle_rad)),
            Self::Round { half_angle_rad, pressure } => {
                in_quadrant(*half_angle_rad)?;
                round(*half_angle_rad, pressure)
            }
            Self::Undercut { undercut_rad, opening_rad } => undercut(*undercut_rad, *opening_rad),
        }
    }
}

fn round(half_angle_rad: f64, pressure: &Pressure) -> Result<f64, GrooveError> {
    let (s, c) = sin_cos(half_angle_rad);
    match pressure {
        Pressure::Uniform => Ok(half_angle_rad / s),
        Pressure::Cosine => Ok(2.0 * s / (half_angle_rad + s * c)),
        Pressure::CosinePower(power) if *power >= 0.0 && power.is_finite() => Ok(by_power(half_angle_rad, *power)),
        Pressure::CosinePower(power) => Err(GrooveError::Power { power: *power }),
        Pressure::Table(table) => by_table(half_angle_rad, table),
    }
}

/// Quadrature in `t` with `φ = ψ (1 − (1 − t)³)`, which smooths a power that is not whole where the pressure ends at π/2.
fn by_power(half_angle_rad: f64, power: f64) -> f64 {
    let rule = GaussLegendre::new(64);
    let moment = |power: f64| {
        rule.integrate(|t| {
            let left = 1.0 - t;
            let cosine = cos(half_angle_rad * (1.0 - left * left * left)).max(0.0);
            3.0 * left * left * powf(cosine, power)
        })
    };
    moment(power) / moment(power + 1.0)
}

/// The integrals of a pressure that is straight between the points, in closed form.
fn by_table(half_angle_rad: f64, table: &[[f64; 2]]) -> Result<f64, GrooveError> {
    let (Some([first_rad, _]), Some([last_rad, _])) = (table.first(), table.last()) else { return Err(GrooveError::Table) };
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * half_angle_rad;
    let covers = near(*last_rad, half_angle_rad) && (near(*first_rad, 0.0) || near(*first_rad, -half_angle_rad));
    let ascending = table.windows(2).all(|pair| pair[0][0] < pair[1][0]);
    let presses = table.iter().all(|[_, pressure]| *pressure >= 0.0 && pressure.is_finite());
    if !(covers && ascending && presses) {
        return Err(GrooveError::Table);
    }
    let (mut all, mut towards) = (0.0, 0.0);
    for pair in table.windows(2) {
        let [[a, p], [b, q]] = [pair[0], pair[1]];
        let slope = (q - p) / (b - a);
        all += 0.5 * (p + q) * (b - a);
        // ∫(p + m(φ − a)) cos φ dφ by parts.
        towards += q * sin(b) - p * sin(a) + slope * (cos(b) - cos(a));
    }
    if towards > 0.0 { Ok(all / towards) } else { Err(GrooveError::Table) }
}

/// Cosine pressure from β/2 to (π − γ)/2 on both sides: the integrals of `cos φ` over those of `cos² φ`.
fn undercut(undercut_rad: f64, opening_rad: f64) -> Result<f64, GrooveError> {
    for (name, angle_rad) in [("undercut_rad", undercut_rad), ("opening_rad", opening_rad)] {
        if !(0.0..PI).contains(&angle_rad) {
            return Err(GrooveError::Angle { name, angle_rad });
        }
    }
    if undercut_rad + opening_rad >= PI {
        return Err(GrooveError::Angle { name: "undercut_rad", angle_rad: undercut_rad });
    }
    let seat = PI - undercut_rad - opening_rad - sin(undercut_rad) + sin(opening_rad);
    Ok(4.0 * (cos(0.5 * opening_rad) - sin(0.5 * undercut_rad)) / seat)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(ours: f64, exact: f64, relative: f64) {
        assert!((ours / exact - 1.0).abs() < relative, "{ours} instead of {exact}");
    }

    fn seat(half_angle_rad: f64, pressure: Pressure) -> f64 {
        Groove::Round { half_angle_rad, pressure }.friction_factor().unwrap()
    }

    /// `∫sinⁿ / ∫sinⁿ⁺¹` over a half circle by the recurrence of the integrals, and n = 1/2 by the gamma function (DLMF 5.12.2).
    #[test]
    fn powers_on_a_half_circle_are_those_of_the_closed_forms() {
        for (power, factor) in [(0.0, FRAC_PI_2), (1.0, 4.0 / PI), (2.0, 3.0 * PI / 8.0), (3.0, 32.0 / (9.0 * PI))] {
            near(seat(FRAC_PI_2, Pressure::CosinePower(power)), factor, 1e-12);
        }
        let gamma = |x: f64| forcewright_base::maths::exp(forcewright_base::maths::ln_gamma(x));
        let integral = |n: f64| gamma(0.5 * (n + 1.0)) / gamma(0.5 * n + 1.0);
        for power in [0.25, 0.5, 1.5, 6.3] {
            near(seat(FRAC_PI_2, Pressure::CosinePower(power)), integral(power) / integral(power + 1.0), 1e-11);
        }
        near(seat(FRAC_PI_2, Pressure::Uniform), FRAC_PI_2, 1e-15);
        near(seat(FRAC_PI_2, Pressure::Cosine), 4.0 / PI, 1e-15);
    }

    /// Makers' seats, by quadrature of the definition; a narrow seat is a flat drum; a factor never falls below 1.
    #[test]
    fn narrow_seats_press_less() {
        for half_deg in [60.0_f64, 67.5, 75.0, 90.0] {
            let half = half_deg.to_radians();
            for (power, pressure) in [(0.0, Pressure::Uniform), (1.0, Pressure::Cosine)] {
                let factor = seat(half, pressure);
                near(seat(half, Pressure::CosinePower(power)), factor, 1e-12);
                assert!((1.17..=1.571).contains(&factor));
            }
        }
        for pressure in [Pressure::Uniform, Pressure::Cosine, Pressure::CosinePower(2.5)] {
            near(seat(1e-4, pressure), 1.0, 1e-8);
        }
        assert!(seat(1.0, Pressure::CosinePower(2.0)) < seat(1.0, Pressure::Cosine));
    }

    /// A table is exact for a pressure that is straight, and approaches another with the square of its step; both halves or one.
    #[test]
    fn tables_are_integrated_exactly() {
        let half = 1.1;
        let triangle = Pressure::Table(vec![[-half, 0.0], [0.0, 3.0], [half, 0.0]]);
        // ∫(1 − φ/ψ) cos φ dφ from 0 to ψ is (1 − cos ψ)/ψ.
        near(seat(half, triangle), 0.5 * half * half / (1.0 - cos(half)), 1e-14);
        near(seat(half, Pressure::Table(vec![[0.0, 3.0], [half, 0.0]])), 0.5 * half * half / (1.0 - cos(half)), 1e-14);
        near(seat(half, Pressure::Table(vec![[-half, 2.0], [half, 2.0]])), seat(half, Pressure::Uniform), 1e-15);
        let sampled = |n: u32| {
            let point = |i: u32| {
                let angle = half * f64::from(i) / f64::from(n);
                [angle, cos(angle) * cos(angle)]
            };
            seat(half, Pressure::Table((0..=n).map(point).collect()))
        };
        let [coarse, fine] = [20, 40].map(|n| sampled(n) - seat(half, Pressure::CosinePower(2.0)));
        assert!((coarse / fine - 4.0).abs() < 0.05 && fine.abs() < 1e-3, "{coarse} {fine}");
    }

    /// A seat with an undercut is the definition's integral without its bottom; without undercut and opening a half circle, with a narrow
    /// band left a groove that touches at two points.
    #[test]
    fn undercut_seats_have_their_limits() {
        let factor = |undercut_rad: f64, opening_rad: f64| Groove::Undercut { undercut_rad, opening_rad }.friction_factor().unwrap();
        near(factor(0.0, 0.0), 4.0 / PI, 1e-15);
        near(factor(0.0, 0.7), seat(0.5 * (PI - 0.7), Pressure::Cosine), 1e-14);
        // Contact at φ = 45° only: 1/cos φ.
        near(factor(FRAC_PI_2 - 1e-4, FRAC_PI_2), 2.0_f64.sqrt(), 1e-4);
        assert!(factor(1.5, 0.5) > factor(1.0, 0.5));
    }

    #[test]
    fn faults_are_named() {
        let round = |half_angle_rad, pressure| Groove::Round { half_angle_rad, pressure }.friction_factor();
        assert!(matches!(round(0.0, Pressure::Uniform), Err(GrooveError::Angle { .. })));
        assert!(matches!(round(1.6, Pressure::Uniform), Err(GrooveError::Angle { .. })));
        assert!(matches!(round(f64::NAN, Pressure::Cosine), Err(GrooveError::Angle { .. })));
        assert_eq!(round(1.0, Pressure::CosinePower(-1.0)), Err(GrooveError::Power { power: -1.0 }));
        for table in [
            vec![],
            vec![[0.0, 1.0]],
            vec![[0.0, 1.0], [0.9, 1.0]],
            vec![[0.0, 0.0], [1.0, 0.0]],
            vec![[0.0, -1.0], [1.0, 2.0]],
            vec![[-1.0, 1.0], [0.5, 1.0], [0.5, 1.0], [1.0, 1.0]],
        ] {
            assert_eq!(round(1.0, Pressure::Table(table)), Err(GrooveError::Table));
        }
        assert!(Groove::Vee { half_angle_rad: 0.0 }.friction_factor().is_err());
        assert!(Groove::Undercut { undercut_rad: 2.0, opening_rad: 2.0 }.friction_factor().is_err());
        assert!(Groove::Undercut { undercut_rad: -0.1, opening_rad: 0.0 }.friction_factor().is_err());
    }
}
