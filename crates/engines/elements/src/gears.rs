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

mod corner;
mod fillet;
pub mod interference;
mod mesh;
pub mod planetary;
mod profile;
mod rack;
pub mod shift;
pub mod strength;
mod wheel;

use std::fmt;

use forcewright_curves::fit::FitError;

use crate::hertz::HertzError;

pub use mesh::{Backlash, Mesh, Path, Span, inverse_involute};
pub use profile::{GearOutline, Piece, Region, ReliefShape, TipRelief, ToothProfile};
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
    /// The spaces of a ring come to a point before they reach the root circle.
    PointedSpace {
        /// Radius at which the flanks meet, m.
        radius_m: f64,
    },
    /// The teeth of a ring reach into the base circle, where there is no involute.
    TipBelowBase {
        /// Tip radius, m.
        tip_radius_m: f64,
        /// Base radius, m.
        base_radius_m: f64,
    },
    /// Nothing of the flank is left between the fillet and the tip circle.
    NoFlank {
        /// Radius at which the flank would begin, m.
        form_radius_m: f64,
        /// Tip radius, m.
        tip_radius_m: f64,
    },
    /// Undercut from both sides goes through the tooth.
    CutOff {
        /// Radius at which nothing is left of the tooth, m.
        radius_m: f64,
    },
    /// An outline cannot be drawn as asked.
    Outline(FitError),
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
            Self::CentreDistance { centre_distance_m, .. } if centre_distance_m.is_nan() => {
                write!(f, "with these profile shifts no centre distance is without backlash; shift the profiles outwards")
            }
            Self::CentreDistance { centre_distance_m, least_m } => {
                write!(f, "there is no mesh at a centre distance of {centre_distance_m} m; it must be above {least_m} m")
            }
            Self::PointedSpace { radius_m } => {
                write!(f, "the spaces of the ring come to a point at a radius of {radius_m} m, below their root; shift the profile less")
            }
            Self::TipBelowBase { tip_radius_m, base_radius_m } => {
                write!(
                    f,
                    "the tip radius of the ring, {tip_radius_m} m, is not above its base radius of {base_radius_m} m; shorten the teeth or shift the profile outwards"
                )
            }
            Self::NoFlank { form_radius_m, tip_radius_m } => {
                write!(f, "a flank that begins at a radius of {form_radius_m} m does not reach the tip at {tip_radius_m} m")
            }
            Self::CutOff { radius_m } => {
                write!(f, "undercut leaves nothing of the tooth at a radius of {radius_m} m; shift the profile outwards or take more teeth")
            }
            Self::Outline(error) => write!(f, "the outline cannot be drawn: {error}"),
            Self::Contact(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for GearError {}

/// Involute function `inv α = tan α − α` of an angle in rad, |α| < π/2. ISO 21771-1.
pub fn involute(angle_rad: f64) -> f64 {
    forcewright_base::maths::tan(angle_rad) - angle_rad
}
