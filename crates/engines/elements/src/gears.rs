//! Spur gears, external and internal, of the involute of a basic rack with profile shift.
//!
//! Symbols after ISO 21771-1. A ring is described by the external wheel whose material fills its spaces: same teeth, same shift. So a ring and a
//! pinion of equal shift mesh without backlash at the standard centre distance, and a positive shift moves the teeth of a ring outwards.
//!
//! | symbol | here | unit |
//! | --- | --- | --- |
//! | z, m, x | `teeth`, `module_m`, `profile_shift` | 1, m, modules |
//! | α | `Rack::pressure_angle_rad` | rad |
//! | `h_aP`, `h_fP`, `ρ_fP` | `Rack::addendum`, `dedendum`, `root_radius` | modules |
//! | r, `r_b`, `r_a`, `r_f` | `reference_radius_m`, `base_radius_m`, `tip_radius_m`, `root_radius_m` | m |

mod fillet;
pub mod interference;
mod mesh;
pub mod planetary;
mod rack;
pub mod strength;

mod wheel;

use std::fmt;

use crate::hertz::HertzError;

pub use mesh::{Mesh, Path, inverse_involute};
pub use rack::Rack;
pub use wheel::{Kind, Wheel, WheelSpec};

/// Why there is no such gear or mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GearError {
    /// A number is not what its documentation asks for.
    Value {
        /// Name of the field or argument.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// The flanks meet below the tip circle: the tooth is pointed.
    PointedTooth {
        /// Radius at which the flanks meet, m.
        radius_m: f64,
    },
    /// Two gears that cannot mesh: of unlike modules or pressure angles, two rings, or a ring with too few teeth more than its pinion.
    Mates {
        /// What does not fit.
        name: &'static str,
    },
    /// The base circles are too far apart, or too near, for a common tangent with a working pressure angle.
    CentreDistance {
        /// What was asked for, m; not a number if the shifts have no centre distance.
        centre_distance_m: f64,
        /// Limit `a cos α'` that it must exceed, m.
        least_m: f64,
    },
    /// The flanks have no Hertzian contact.
    Contact(HertzError),
}

impl fmt::Display for GearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value { name, value } => write!(f, "`{name}` cannot be {value}"),
            Self::PointedTooth { radius_m } => {
                write!(
                    f,
                    "the flanks of the tooth meet at a radius of {radius_m} m, below its tip; shift the profile less or shorten the tooth"
                )
            }
            Self::Mates { name } => write!(f, "these gears cannot mesh: {name}"),
            Self::CentreDistance { centre_distance_m, least_m } => {
                write!(f, "there is no mesh at a centre distance of {centre_distance_m} m; it must be above {least_m} m")
            }
            Self::Contact(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for GearError {}

/// Involute function `inv α = tan α − α` of an angle in rad, |α| < π/2. ISO 21771-1.
pub fn involute(angle_rad: f64) -> f64 {
    forcewright_base::maths::tan(angle_rad) - angle_rad
}
