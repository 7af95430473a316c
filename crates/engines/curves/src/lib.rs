//! Plane curves: closed profiles of lines, arcs and splines, and what is made of them. Theory: `docs/theory/curves.md`.

mod bounds;
mod chords;
pub mod fit;
pub mod outline;
mod piece;
mod profile;
mod spline;
mod vector;
pub mod walls;

pub use bounds::{Bounds, Motion};
pub use profile::{Nearest, Profile, ProfileError, Segment};
pub use spline::Spline;
