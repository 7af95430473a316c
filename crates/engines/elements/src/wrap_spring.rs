//! Wrap spring of a selector clutch: a coil of round wire that sits tight on a hub, opens under torque, and grips a bore.
//!
//! One end of the coil is fastened to a body S. At the other end `N_A` turns hold a hub A by interference; the other `N_f` turns are free, and
//! `N_B` of them, next to S, stand in a bore B with a gap. A torque on S in the sense that opens the coil is carried to A until the coil reaches the bore at `τ_t`; then the bore
//! takes the rest, and at the hub the coil slips at `τ_b`. In the other sense the coil locks on the hub. The equations are those of Butin
//! et al. 2023 (`butin2023`), corrected: theory, evidence and limits in `docs/theory/wrap-spring.md`.
//!
//! | `butin2023` | here | unit |
//! | --- | --- | --- |
//! | `r_s`, `r_n`, EI | half of `wire_m`, `neutral_radius_m`, [`WrapSpring::flexural_n_m2`] | m, m, N·m² |
//! | `δr_a`, `δr_b` | `hub_interference_m`, `bore_opening_m` | m |
//! | `N_A`, `N_B`, `N_f` | `hub_turns`, `bore_turns`, `free_turns` | 1 |
//! | `τ_t`, `τ_b` | [`Limits::transition_nm`], [`Limits::hub_slip_nm`] | N·m |
//! | `ΔN_t` | [`WrapSpring::dead_turns`] | 1 |
//!
//! Limits: planar thin rod, linear elastic, round rigid coaxial hub and bore, one coefficient of Coulomb friction, no inertia.
//!
//! ```
//! use forcewright_elements::wrap_spring::{Dimensions, Options, State, WrapSpring};
//!
//! // Wire of 1 mm coiled to a mean radius of 8.7 mm, 0.6 mm tight on the hub, 0.5 mm from the bore.
//! let spring = WrapSpring::new(
//!     &Dimensions {
//!         wire_m: 1e-3,
//!         neutral_radius_m: 8.7e-3,
//!         young_modulus_pa: 210e9,
//!         hub_interference_m: 0.6e-3,
//!         bore_opening_m: 0.5e-3,
//!         hub_turns: 2.0,
//!         bore_turns: 3.0,
//!         free_turns: 6.0,
//!     },
//!     Options::default(),
//! )
//! .expect("a spring");
//! // It needs a friction of 0.163 to reach the bore at all, and one of 0.218 to hold 400 N·mm there.
//! assert!((spring.least_friction_to_reach().expect("it can") - 0.1634).abs() < 5e-5);
//! assert!((spring.least_friction_to_grip(0.4).expect("a torque").expect("it can") - 0.2178).abs() < 5e-5);
//! let limits = spring.limits(0.25).expect("a coefficient");
//! assert_eq!(limits.state(0.4), Ok(State::Gripped));
//! ```

mod limits;
mod making;
mod strength;
mod stress;
mod wear;

use std::f64::consts::{PI, TAU};
use std::fmt;

use forcewright_base::maths::{exp, exp_m1};
pub use limits::{Limits, State};
pub use making::{Coil, Effect, Hand, Leg, Sense, Winding, effect, leg, mean_diameter_tolerance_m, wire_tolerance_m};
pub use strength::{Duty, Endurance, Life, StaticStrength, Surface, endurance, static_strength};
pub use stress::{BendingFactors, Stresses, bending_pa, wahl_factors, winkler_factors};
pub use wear::{AxialWalk, HubWear};

/// Turns by which a hub of `N_A` turns counts less in the default model, for the end of the coil that lies free on it.
///
/// A cautious value: 17 % less torque in the closing sense at a friction of 0.15, as much as measurements were below the formula without it
/// (up to 20 %, Wiebusch 1939 as cited in `butin2023`). A rod with unilateral contact loses less, [`END_LOSS_ROD_TURNS`].
pub const END_LOSS_TURNS: f64 = 0.2;

/// What a thin rod loses at the two ends of its contact on a hub, in turns, as friction goes to 0: twice `(θ₀ − tan(θ₀/2))/2π` with the
/// root `θ₀ = 2.139` of `θ₀ = 2 sin θ₀ − sin θ₀ cos θ₀`, the angle by which the rod stands off behind its last point. Derived in
/// `docs/theory/wrap-spring.md`.
pub const END_LOSS_ROD_TURNS: f64 = 0.0999;

/// Flexural stiffness EI of round wire, N·m²: `E π d⁴/64`.
pub fn flexural_n_m2(wire_m: f64, young_modulus_pa: f64) -> f64 {
    let square = wire_m * wire_m;
    young_modulus_pa * PI * square * square / 64.0
}

/// Moment (N·m) that brings a coil from its free mean radius `r` to `r + δ`, linear in δ: `EI δ/r²`. Eq. (13) of `butin2023`. A negative δ
/// closes the coil.
pub fn linear_moment_nm(flexural_n_m2: f64, radius_m: f64, change_m: f64) -> f64 {
    flexural_n_m2 * change_m / (radius_m * radius_m)
}

/// The same for a thin wire that keeps its length, exact: `EI (1/r − 1/(r + δ)) = EI δ/(r (r + δ))`; δ above `−r`. A negative δ closes
/// the coil, which takes more than opening it by as much.
///
/// ```
/// use forcewright_elements::wrap_spring::{exact_moment_nm, linear_moment_nm};
///
/// // 0.5 mm on 8.7 mm: 5.43 % less than the linear one.
/// let ratio = exact_moment_nm(1.0, 8.7e-3, 0.5e-3) / linear_moment_nm(1.0, 8.7e-3, 0.5e-3);
/// assert!((ratio - 8.7 / 9.2).abs() < 1e-15);
/// ```
pub fn exact_moment_nm(flexural_n_m2: f64, radius_m: f64, change_m: f64) -> f64 {
    flexural_n_m2 * change_m / (radius_m * (radius_m + change_m))
}

/// Torque (N·m) at which a coil slips in the sense that opens it off its hub: `M (1 − e^−x)`, for the moment `M` that sits it there and
/// the exponent `x` = 2π μ times the turns. Eq. (12).
pub fn opening_slip_nm(moment_nm: f64, exponent: f64) -> f64 {
    -moment_nm * exp_m1(-exponent)
}

/// Torque (N·m) at which it slips in the sense that locks it: `M (e^x − 1)`. Eq. (11).
pub fn locking_slip_nm(moment_nm: f64, exponent: f64) -> f64 {
    moment_nm * exp_m1(exponent)
}

/// Largest torque (N·m) that a coil holds in a bore: `τ_t + (τ_A − τ_t) e^x` for the torque `τ_t` that brings it there and the torque
/// `τ_A` in the coil beyond the bore, of at least `τ_t`. The bore keeps the curvature of the coil: only what exceeds `τ_t` presses on it.
pub fn grip_nm(transition_nm: f64, far_nm: f64, exponent: f64) -> f64 {
    transition_nm + (far_nm - transition_nm) * exp(exponent)
}

/// Which equations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Model {
    /// Exact opening, finite turns on the hub less the loss of the end, and a bore that is pressed only by what exceeds `τ_t`.
    #[default]
    Corrected,
    /// As printed in `butin2023`: linear opening (13), endless turns on the hub (25), grip of the bore by (28). To compare with the paper:
    /// it promises more than a spring can hold.
    Paper,
}

/// How the radius at which friction acts enters the exponent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WireModel {
    /// At the middle of the wire: `2π N μ`.
    #[default]
    Thin,
    /// At the surface of the wire: `2π N μ (ρ − 1)/ρ` on a hub and `2π N μ (ρ + 1)/ρ` in a bore, `ρ = r_n/r_s`. The `ρ/(1 + ρ)` that is
    /// printed in eq. (10) holds for neither.
    Thick,
}

/// Choices of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Which equations. Default [`Model::Corrected`].
    pub model: Model,
    /// Turns by which the hub counts less, at least 0; not used by [`Model::Paper`]. Default [`END_LOSS_TURNS`].
    pub end_loss_turns: f64,
    /// Where friction acts. Default [`WireModel::Thin`].
    pub wire: WireModel,
}

impl Default for Options {
    fn default() -> Self {
        Self { model: Model::default(), end_loss_turns: END_LOSS_TURNS, wire: WireModel::default() }
    }
}

/// Dimensions of a wrap spring and of what it sits in. All radii are to the middle of the wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dimensions {
    /// Wire diameter d, m; above 0.
    pub wire_m: f64,
    /// Mean radius of the free coil `r_n`, m; above half of the wire diameter.
    pub neutral_radius_m: f64,
    /// Young's modulus, Pa; above 0.
    pub young_modulus_pa: f64,
    /// By how much the hub opens the coil, `δ_a`, m on the radius; above 0.
    pub hub_interference_m: f64,
    /// By how much the coil opens until it touches the bore, `δ_b`, m on the radius; above 0.
    pub bore_opening_m: f64,
    /// Turns on the hub; above 0.
    pub hub_turns: f64,
    /// Turns in the bore; at least 0.
    pub bore_turns: f64,
    /// All turns that are off the hub, those that come to lie in the bore among them: they open until the bore is reached. The `N_f` of
    /// eq. (30); at least `bore_turns`.
    pub free_turns: f64,
}

impl Dimensions {
    /// From diameters as on a drawing (m): hub and bore, and the outer diameter of the free coil, which both gaps share; `turns` on the hub, in
    /// the bore, and all off the hub. `δ_a` is half of
    /// what the hub exceeds the inner diameter of the coil by; `δ_b` half of what the bore exceeds its outer diameter by.
    pub fn from_diameters(wire_m: f64, outer_m: f64, hub_m: f64, bore_m: f64, young_modulus_pa: f64, turns: [f64; 3]) -> Self {
        Self {
            wire_m,
            neutral_radius_m: 0.5 * (outer_m - wire_m),
            young_modulus_pa,
            hub_interference_m: 0.5 * (hub_m - (outer_m - 2.0 * wire_m)),
            bore_opening_m: 0.5 * (bore_m - outer_m),
            hub_turns: turns[0],
            bore_turns: turns[1],
            free_turns: turns[2],
        }
    }
}

/// Why there is no such spring or state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrapSpringError {
    /// A number is not what its documentation asks for.
    Value {
        /// Name of the field or argument.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// The free coil has no hole: the wire is as thick as its mean diameter, or thicker.
    NoHole {
        /// Spring index `2 r_n/d`.
        index: f64,
    },
    /// There are no fatigue data for wire of this grade.
    NoFatigueData,
}

impl fmt::Display for WrapSpringError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value { name, value } => write!(f, "`{name}` cannot be {value}"),
            Self::NoHole { index } => {
                write!(f, "a coil cannot have a spring index of {index}; take a thinner wire or a larger radius")
            }
            Self::NoFatigueData => write!(f, "fatigue is assessed for the grades DM and DH only; the others are for static load"),
        }
    }
}

impl std::error::Error for WrapSpringError {}

/// A wrap spring prepared for many coefficients of friction and torques; nothing of it allocates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrapSpring {
    dimensions: Dimensions,
    options: Options,
    flexural_n_m2: f64,
    /// Moment that sits the coil on the hub, `M_A`.
    hub_moment_nm: f64,
    /// `τ_t`.
    transition_nm: f64,
    /// Exponents over the coefficient of friction, on the hub and in the bore.
    hub_exponent: f64,
    bore_exponent: f64,
}

impl WrapSpring {
    /// Checks dimensions and options.
    ///
    /// # Errors
    /// [`WrapSpringError::Value`], [`WrapSpringError::NoHole`]
    pub fn new(dimensions: &Dimensions, options: Options) -> Result<Self, WrapSpringError> {
        let d = dimensions;
        positive("wire_m", d.wire_m)?;
        positive("neutral_radius_m", d.neutral_radius_m)?;
        positive("young_modulus_pa", d.young_modulus_pa)?;
        positive("hub_interference_m", d.hub_interference_m)?;
        positive("bore_opening_m", d.bore_opening_m)?;
        positive("hub_turns", d.hub_turns)?;
        not_negative("bore_turns", d.bore_turns)?;
        not_negative("free_turns", d.free_turns)?;
        if d.free_turns < d.bore_turns {
            return Err(WrapSpringError::Value { name: "free_turns", value: d.free_turns });
        }
        not_negative("end_loss_turns", options.end_loss_turns)?;
        let index = 2.0 * d.neutral_radius_m / d.wire_m;
        if index <= 1.0 {
            return Err(WrapSpringError::NoHole { index });
        }
        let flexural_n_m2 = flexural_n_m2(d.wire_m, d.young_modulus_pa);
        let (moment, hub_turns): (fn(f64, f64, f64) -> f64, f64) = match options.model {
            Model::Corrected => (exact_moment_nm, (d.hub_turns - options.end_loss_turns).max(0.0)),
            Model::Paper => (linear_moment_nm, d.hub_turns),
        };
        let [inner, outer] = match options.wire {
            WireModel::Thin => [1.0, 1.0],
            WireModel::Thick => [1.0 - 1.0 / index, 1.0 + 1.0 / index],
        };
        Ok(Self {
            dimensions: *d,
            options,
            flexural_n_m2,
            hub_moment_nm: moment(flexural_n_m2, d.neutral_radius_m, d.hub_interference_m),
            transition_nm: moment(flexural_n_m2, d.neutral_radius_m, d.bore_opening_m),
            hub_exponent: TAU * hub_turns * inner,
            bore_exponent: TAU * d.bore_turns * outer,
        })
    }

    /// What it was made from.
    pub fn dimensions(&self) -> &Dimensions {
        &self.dimensions
    }

    /// Choices of the model.
    pub fn options(&self) -> Options {
        self.options
    }

    /// Flexural stiffness EI of the wire, N·m².
    pub fn flexural_n_m2(&self) -> f64 {
        self.flexural_n_m2
    }

    /// Spring index `D/d = r_n/r_s`, the ρ of the paper.
    pub fn index(&self) -> f64 {
        2.0 * self.dimensions.neutral_radius_m / self.dimensions.wire_m
    }

    /// Bending moment in the wire on the hub `M_A`, N·m.
    pub fn hub_moment_nm(&self) -> f64 {
        self.hub_moment_nm
    }

    /// Torque that opens the coil to the bore, `τ_t`, N·m.
    pub fn transition_nm(&self) -> f64 {
        self.transition_nm
    }

    /// Turns by which S turns against the hub before the bore is reached, from a coil without torque. Exact for a wire that keeps its
    /// length, `N_f δ_b/(r_n + δ_b)`; linear in [`Model::Paper`], `N_f δ_b/r_n`, eq. (30).
    ///
    /// With a planetary gear of ratio R ahead of it and a blocked output, the input turns `(1 − R)/R` times that, eq. (31).
    pub fn dead_turns(&self) -> f64 {
        let Dimensions { free_turns, neutral_radius_m, bore_opening_m, .. } = self.dimensions;
        match self.options.model {
            Model::Corrected => free_turns * bore_opening_m / (neutral_radius_m + bore_opening_m),
            Model::Paper => free_turns * bore_opening_m / neutral_radius_m,
        }
    }
}

fn positive(name: &'static str, value: f64) -> Result<(), WrapSpringError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(WrapSpringError::Value { name, value }) }
}

fn not_negative(name: &'static str, value: f64) -> Result<(), WrapSpringError> {
    if value >= 0.0 && value.is_finite() { Ok(()) } else { Err(WrapSpringError::Value { name, value }) }
}

fn finite(name: &'static str, value: f64) -> Result<(), WrapSpringError> {
    if value.is_finite() { Ok(()) } else { Err(WrapSpringError::Value { name, value }) }
}
