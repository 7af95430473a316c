//! Plane curves: closed profiles of lines, arcs and splines, and what is made of them.

mod profile;

pub use profile::{Profile, Segment, Spline};
