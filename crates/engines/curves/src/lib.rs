//! Plane curves: closed profiles of lines, arcs and splines, and what is made of them. Theory: `docs/theory/curves.md`.

mod bounds;
mod chords;
pub mod fit;
pub mod outline;
mod piece;
pub mod plane;
mod profile;
pub mod registration;
pub mod smoothing;
mod spline;
pub mod vector;
pub mod walls;
pub mod waviness;

pub use bounds::{Bounds, Motion};
pub use profile::{Nearest, Profile, ProfileError, Segment};
pub use spline::Spline;
