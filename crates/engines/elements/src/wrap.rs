//! Friction of a cable, or a wire, that is wrapped on drums: slip zones, a two-sided drive, loading and unloading, cables in parallel.
//!
//! Coulomb friction on a drum lets the tension of a cable change by `dT/dθ = ±μT` where it slips. Where it sticks, the tension stays what
//! it was: a slip zone grows inwards from the free span. Equation numbers are those of Longval & Gosselin (`longval-gosselin`), whose two sides
//! are made compatible here: both share one displacement. Theory and departures: `docs/theory/capstan.md`.
//!
//! | `longval-gosselin` | here | unit |
//! | --- | --- | --- |
//! | r₁, r₂ | `radius_m` of the input and of the output drum, to the middle of the cable | m |
//! | μ | `friction`, with the effect of a groove ([`crate::grooves`]) | 1 |
//! | `T_p`, AE, `L_f` | `preload_n`, `axial_stiffness_n`, `spans_m` | N, N, m |
//! | `θ_s`, δ | `slip_rad`, `elongation_m` | rad, m |
//! | `2 T_ℓ` | `force_n`: taut less slack tension | N |
//! | K, `K_t` | `tangent_n_per_m`, [`Drive::torsional_nm_per_rad`] | N/m, N·m/rad |
//!
//! Limits: cable without bending stiffness and weight, linear elastic, small strain; one coefficient of friction per drum for sticking and
//! slipping; no inertia, no creep.
//!
//! ```
//! use forcewright_elements::wrap::{Drive, DriveSpec, Drum, Hold};
//!
//! let drive = Drive::new(&DriveSpec {
//!     input: Drum { radius_m: 0.01, friction: 0.15 },
//!     output: Drum { radius_m: 0.05, friction: 0.15 },
//!     hold: Hold::Friction { wrap_rad: 24.3 },
//!     output_wraps_rad: [20.0; 2],
//!     spans_m: [0.025; 2],
//!     axial_stiffness_n: 50e3,
//!     preload_n: 200.0,
//! })
//! .expect("a drive");
//! // 2 N·m at the input: the taut side carries more than the half of it, as it is the stiffer one.
//! let state = drive.at_force(200.0).expect("held by friction");
//! assert!((state.tensions_n[0] - 314.72).abs() < 0.01 && (state.tensions_n[1] - 114.72).abs() < 0.01);
//! ```

mod bundle;
mod bundle_history;
mod drive;
mod field;
mod history;

use std::fmt;

pub use bundle::{Bundle, BundleState};
pub use bundle_history::{BundleHistory, BundleStep};
pub use drive::{Capacity, Drive, DriveSpec, Drum, Hold, PaperState, Shaft, State};
use forcewright_base::maths::{exp, exp_m1, ln_1p};
pub use history::{Cycle, History, Step};

/// Why there is no such state of a wrapped cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrapError {
    /// A number is not what its documentation asks for.
    Value {
        /// Name of the field or argument.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// The cable slips over the whole of its wrap before the force is reached.
    GrossSlip {
        /// Largest force that friction holds in this direction, N.
        capacity_n: f64,
    },
    /// The slack side of the paper's model would carry a negative tension.
    Slack {
        /// Force at which it becomes loose, N.
        limit_n: f64,
    },
    /// A drive with memory needs wraps of finite angle.
    EndlessWrap,
    /// A bundle without cables.
    NoCable,
}

impl fmt::Display for WrapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value { name, value } => write!(f, "`{name}` cannot be {value}"),
            Self::GrossSlip { capacity_n } => {
                write!(f, "the cable slips on the input drum at {capacity_n} N; wrap it further, raise preload or friction, or fix it")
            }
            Self::Slack { limit_n } => write!(f, "the slack side is loose from {limit_n} N on; raise the preload"),
            Self::EndlessWrap => write!(f, "unloading is followed on wraps of finite angle only"),
            Self::NoCable => write!(f, "a bundle needs at least one cable"),
        }
    }
}

impl std::error::Error for WrapError {}

/// Ratio of tensions that a wrap holds, `exp(μθ)`, for `friction` and `wrap_rad` (rad) of at least 0. Eq. (7).
///
/// ```
/// // One turn at μ = 0.15 holds 2.57 to 1.
/// assert!((forcewright_elements::wrap::holding_ratio(0.15, std::f64::consts::TAU) - 2.566).abs() < 1e-3);
/// ```
pub fn holding_ratio(friction: f64, wrap_rad: f64) -> f64 {
    exp(friction * wrap_rad)
}

/// A length of cable on a drum from the free span to where it is fastened or meets another zone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrap {
    /// Radius to the middle of the cable, m; above 0.
    pub radius_m: f64,
    /// Coefficient of friction; above 0.
    pub friction: f64,
    /// Angle from the span to the end, rad; above 0, may be infinite.
    pub wrap_rad: f64,
    /// Axial stiffness AE of the cable, N; above 0.
    pub axial_stiffness_n: f64,
}

/// A slip zone under a tension that differs from the preload.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slip {
    /// Tension at the span, N.
    pub tension_n: f64,
    /// Angle that slips, rad. Eqs. (10) to (13).
    pub slip_rad: f64,
    /// Whether it reaches the end of the wrap, which then carries more, or less, than the preload.
    pub at_end: bool,
    /// Tension at the inner end of the zone, N: the preload unless the zone reaches the end.
    pub far_tension_n: f64,
    /// Elongation of the zone against the preloaded state, m; negative where it shortens. Eqs. (15) to (21).
    pub elongation_m: f64,
    /// Derivative of the elongation by the tension, m/N. Eqs. (25) to (28).
    pub compliance_m_per_n: f64,
    /// `−μ` where the tension falls inwards, `μ` where it rises.
    log_slope_per_rad: f64,
}

impl Slip {
    /// Tension at an angle from the span, N; at the inner end from there on. Eqs. (8) and (9).
    pub fn tension_at_n(&self, angle_rad: f64) -> f64 {
        self.tension_n * exp(self.log_slope_per_rad * angle_rad.clamp(0.0, self.slip_rad))
    }
}

impl Wrap {
    /// The slip zone when the tension at the span goes from the preload to another value (N; both above 0).
    ///
    /// # Errors
    /// [`WrapError::Value`]
    ///
    /// ```
    /// use forcewright_elements::wrap::Wrap;
    ///
    /// let wrap = Wrap { radius_m: 0.05, friction: 0.15, wrap_rad: 20.0, axial_stiffness_n: 50e3 };
    /// let slip = wrap.slip(200.0, 300.0).expect("taut");
    /// assert!((slip.slip_rad - 1.5_f64.ln() / 0.15).abs() < 1e-12 && (slip.tension_at_n(slip.slip_rad) - 200.0).abs() < 1e-9);
    /// ```
    pub fn slip(&self, preload_n: f64, tension_n: f64) -> Result<Slip, WrapError> {
        positive("radius_m", self.radius_m)?;
        positive("friction", self.friction)?;
        positive("axial_stiffness_n", self.axial_stiffness_n)?;
        positive_or_infinite("wrap_rad", self.wrap_rad)?;
        positive("preload_n", preload_n)?;
        positive("tension_n", tension_n)?;
        let zone = Zone::new(self);
        let excess_n = tension_n - preload_n;
        let log = ln_1p(excess_n / preload_n);
        let sign = if log < 0.0 { -1.0 } else { 1.0 };
        let free = Free { change_n: excess_n, log, excess: log_excess(excess_n / preload_n, log) };
        let at_end = log.abs() >= zone.limit;
        let slip_rad = if at_end { self.wrap_rad } else { log.abs() / self.friction };
        Ok(Slip {
            tension_n,
            slip_rad,
            at_end,
            far_tension_n: if at_end { tension_n * exp(-sign * zone.limit) } else { preload_n },
            elongation_m: sign * zone.elongation_m(preload_n, tension_n, &free),
            compliance_m_per_n: zone.compliance_m_per_n(tension_n, &free),
            log_slope_per_rad: -sign * self.friction,
        })
    }
}

/// The tension at the span against the preload: difference, `ln(T/T_p)`, and `x − ln(1 + x)` for `x = T/T_p − 1`.
struct Free {
    change_n: f64,
    log: f64,
    excess: f64,
}

/// A zone prepared for many tensions.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Zone {
    /// `r/(μ AE)`, m/N.
    reach_m_per_n: f64,
    /// `μΘ`: logarithm of the tension ratio at which slip reaches the end.
    limit: f64,
    /// `1 − exp(−μΘ)`.
    shrink: f64,
    /// `exp(μΘ) − 1`.
    grow: f64,
    /// `μΘ − (1 − exp(−μΘ))` and `exp(μΘ) − 1 − μΘ`.
    rests: [f64; 2],
}

impl Zone {
    fn new(wrap: &Wrap) -> Self {
        let limit = wrap.friction * wrap.wrap_rad;
        let reach_m_per_n = wrap.radius_m / (wrap.friction * wrap.axial_stiffness_n);
        let (shrink, grow) = (-exp_m1(-limit), exp_m1(limit));
        Self { reach_m_per_n, limit, shrink, grow, rests: [log_excess(-shrink, -limit), log_excess(grow, limit)] }
    }

    /// Size of the elongation, at least 0. With the tension `T` at the span `∫(T(θ) − T_p) dθ = (T − T_p − T_p ln(T/T_p))/μ` over a zone
    /// that ends inside, and `(T(1 − e^{∓μΘ}) ∓ T_p μΘ)/±μ` over one that reaches the end.
    fn elongation_m(&self, preload_n: f64, tension_n: f64, free: &Free) -> f64 {
        let over_mu_n = if free.log.abs() < self.limit {
            preload_n * free.excess
        } else if free.log > 0.0 {
            free.change_n * self.shrink - preload_n * self.rests[0]
        } else if self.limit < 1.0 {
            -free.change_n * self.grow - preload_n * self.rests[1]
        } else {
            // On a long wrap `T exp(μΘ)` would lose the digits of a small tension.
            preload_n * (self.limit - exp(self.limit + free.log)) + tension_n
        };
        self.reach_m_per_n * over_mu_n
    }

    fn compliance_m_per_n(&self, tension_n: f64, free: &Free) -> f64 {
        let over_mu = if free.log.abs() < self.limit {
            free.change_n.abs() / tension_n
        } else if free.log > 0.0 {
            self.shrink
        } else {
            self.grow
        };
        self.reach_m_per_n * over_mu
    }
}

/// `x − ln(1 + x)` when the logarithm is known, without the loss of digits near 0.
///
/// With `s = x/(2 + x)`: `ln(1 + x) = 2(s + s³/3 + s⁵/5 + …)` (Abramowitz & Stegun 4.1.27) and `x − 2s = xs`.
fn log_excess(x: f64, log: f64) -> f64 {
    if x.abs() > 0.2 {
        return x - log;
    }
    let s = x / (2.0 + x);
    let q = s * s;
    // |s| ≤ 1/9: the next term is below 1e-17 of the sum.
    let series = 1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + q * (1.0 / 9.0 + q * (1.0 / 11.0 + q * (1.0 / 13.0 + q / 15.0)))));
    s * (x - 2.0 * q * series)
}

/// Root of an increasing function with its derivative between two ends, from a start: Newton's method, and bisection where that leaves the
/// bracket. If the ends do not bracket a root, the one nearer to it.
fn increasing_root(mut f: impl FnMut(f64) -> (f64, f64), mut low: f64, mut high: f64, start: f64) -> f64 {
    // Not `clamp`, which panics where rounding has turned the ends round.
    let mut x = start.max(low).min(high);
    let small = 1e-12 * low.abs().max(high.abs());
    let mut last = f64::INFINITY;
    for _ in 0..200 {
        let (value, slope) = f(x);
        if value == 0.0 {
            break;
        }
        if value > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - value / slope;
        let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        let step = (next - x).abs();
        let by_newton = newton.to_bits() == next.to_bits();
        x = next;
        // Newton's method squares the error: one step further it is below rounding.
        // Near a root at 0 rounding shows as steps that no longer shrink.
        let near = if by_newton { 1e-8 } else { 1e-16 };
        if step <= near * x.abs() || (by_newton && step <= small && step >= last) {
            break;
        }
        last = step;
    }
    x
}

fn positive(name: &'static str, value: f64) -> Result<(), WrapError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(WrapError::Value { name, value }) }
}

fn positive_or_infinite(name: &'static str, value: f64) -> Result<(), WrapError> {
    if value > 0.0 { Ok(()) } else { Err(WrapError::Value { name, value }) }
}

fn finite(name: &'static str, value: f64) -> Result<(), WrapError> {
    if value.is_finite() { Ok(()) } else { Err(WrapError::Value { name, value }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WRAP: Wrap = Wrap { radius_m: 0.05, friction: 0.15, wrap_rad: 6.0, axial_stiffness_n: 50e3 };

    /// The elongation is the integral of the strain, by quadrature of the tension over the zone; its derivative by differences. Zones that
    /// end inside and zones that reach the end, taut and slack.
    #[test]
    fn elongation_is_the_integral_of_the_strain() {
        let rule = forcewright_base::quadrature::GaussLegendre::new(30);
        let mut ends = 0;
        for tension_n in [20.0, 60.0, 82.0, 120.0, 199.0, 200.001, 250.0, 480.0, 500.0, 2000.0] {
            let slip = WRAP.slip(200.0, tension_n).unwrap();
            let strain = rule.integrate(|u| (slip.tension_at_n(u * slip.slip_rad) - 200.0) / 50e3);
            let expected = 0.05 * slip.slip_rad * strain;
            assert!((slip.elongation_m - expected).abs() < 1e-13 * expected.abs() + 1e-18, "{tension_n}: {slip:?}");
            let step = (1e-4 * tension_n).min(0.1 * (tension_n - 200.0).abs());
            let [more, less] = [step, -step].map(|d| WRAP.slip(200.0, tension_n + d).unwrap().elongation_m);
            let slope = (more - less) / (2.0 * step);
            assert!((slip.compliance_m_per_n - slope).abs() < 2e-7 * slope.abs() + 1e-11, "{tension_n}");
            assert!((slip.tension_at_n(1e9) / slip.far_tension_n - 1.0).abs() < 1e-14);
            ends += usize::from(slip.at_end);
        }
        assert_eq!(ends, 4);
    }

    /// Small differences keep their digits: δ → `r (ΔT)²/(2 μ AE T_p)`.
    #[test]
    fn small_differences_keep_their_digits() {
        for difference_n in [1e-3, -1e-3, 1e-6] {
            let slip = WRAP.slip(200.0, 200.0 + difference_n).unwrap();
            let q = (200.0 + difference_n) - 200.0;
            let leading = q.signum() * 0.05 * q * q / (2.0 * 0.15 * 50e3 * 200.0);
            assert!((slip.elongation_m / leading - 1.0).abs() < q.abs() / 200.0, "{difference_n}");
        }
        // Against the next term of the series at the seam of the two branches.
        for x in [0.199_999_999, 0.200_000_001, -0.199_999_999, -0.200_000_001] {
            let other = x - ln_1p(x);
            assert!((log_excess(x, ln_1p(x)) / other - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn endless_wraps_never_slip_to_their_end() {
        let slip = Wrap { wrap_rad: f64::INFINITY, ..WRAP }.slip(200.0, 1e-6).unwrap();
        assert!(!slip.at_end && slip.elongation_m.is_finite());
        assert_eq!(WRAP.slip(0.0, 1.0), Err(WrapError::Value { name: "preload_n", value: 0.0 }));
        assert_eq!(WRAP.slip(1.0, -1.0), Err(WrapError::Value { name: "tension_n", value: -1.0 }));
        assert!(Wrap { friction: f64::NAN, ..WRAP }.slip(1.0, 1.0).is_err());
        assert!(Wrap { wrap_rad: 0.0, ..WRAP }.slip(1.0, 1.0).is_err());
    }

    #[test]
    fn roots_are_found_from_anywhere() {
        for start in [-10.0, 0.0, 0.3, 5.0] {
            let x = increasing_root(|x| (x * x * x - 0.027, 3.0 * x * x), 0.0, 5.0, start);
            assert!((x - 0.3).abs() < 1e-15, "{start}: {x}");
        }
        // No root: the nearer end.
        assert!((increasing_root(|x| (x + 1.0, 1.0), 0.0, 5.0, 2.0)).abs() < 1e-12);
    }
}
