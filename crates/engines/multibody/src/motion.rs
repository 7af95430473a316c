//! Prescribed motions: functions of time with their first two derivatives.

use std::f64::consts::TAU;
use std::fmt;
use std::sync::Arc;

use forcewright_base::maths;

/// A function of time `f(t)` for a driver, m or rad. Rows need `f`, `ḟ` and `f̈`.
#[derive(Clone)]
pub enum Motion {
    /// A fixed value.
    Constant(f64),
    /// `start + rate·t + acceleration·t²/2`.
    Polynomial {
        /// Value at time 0.
        start: f64,
        /// First derivative at time 0, per s.
        rate: f64,
        /// Second derivative, per s².
        acceleration: f64,
    },
    /// `mean + amplitude·sin(rate·t + phase)`.
    Harmonic {
        /// Mean value.
        mean: f64,
        /// Amplitude.
        amplitude: f64,
        /// Circular frequency, rad/s.
        rate_rad_per_s: f64,
        /// Phase at time 0, rad.
        phase_rad: f64,
    },
    /// A cycloid from rest to rest, `start + stroke·(τ − sin(2πτ)/2π)` with `τ = t/duration` in [0, 1]; at rest before and after.
    /// Sánchez-Salinas et al. 2022, eq. (17).
    Cycloid {
        /// Value at time 0.
        start: f64,
        /// Change over the duration.
        stroke: f64,
        /// Duration, s, > 0.
        duration_s: f64,
    },
    /// Any other: value, first and second derivative at a time.
    Function(Arc<dyn Fn(f64) -> [f64; 3] + Send + Sync>),
}

impl Motion {
    /// Value, first and second derivative.
    pub fn at(&self, time_s: f64) -> [f64; 3] {
        match self {
            Self::Constant(value) => [*value, 0.0, 0.0],
            Self::Polynomial { start, rate, acceleration } => {
                [start + time_s * (rate + 0.5 * acceleration * time_s), rate + acceleration * time_s, *acceleration]
            }
            Self::Harmonic { mean, amplitude, rate_rad_per_s: w, phase_rad } => {
                let (s, c) = maths::sin_cos(w * time_s + phase_rad);
                [mean + amplitude * s, amplitude * w * c, -amplitude * w * w * s]
            }
            Self::Cycloid { start, stroke, duration_s } => {
                let tau = (time_s / duration_s).clamp(0.0, 1.0);
                let (s, c) = maths::sin_cos(TAU * tau);
                let rate = stroke / duration_s;
                [start + stroke * (tau - s / TAU), rate * (1.0 - c), rate / duration_s * TAU * s]
            }
            Self::Function(f) => f(time_s),
        }
    }
}

impl fmt::Debug for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => write!(f, "Constant({value})"),
            Self::Polynomial { start, rate, acceleration } => write!(f, "Polynomial({start}, {rate}, {acceleration})"),
            Self::Harmonic { mean, amplitude, rate_rad_per_s, phase_rad } => {
                write!(f, "Harmonic({mean}, {amplitude}, {rate_rad_per_s}, {phase_rad})")
            }
            Self::Cycloid { start, stroke, duration_s } => write!(f, "Cycloid({start}, {stroke}, {duration_s})"),
            Self::Function(_) => f.write_str("Function"),
        }
    }
}
