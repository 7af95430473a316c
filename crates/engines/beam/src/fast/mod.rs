//! Whole curves fast: force, stiffness and largest stress at given displacements, for the networks that most designs are.
//!
//! The general path ([`crate::trace`]) pivots everywhere, keeps every state and verifies each step twice. Here beams are condensed to
//! their end motions four at a time, one Newton iteration advances a step whose prediction is close, and values between the few
//! states are interpolated. What that costs is measured in every run: the last step's error by its size, the interpolation by a
//! second order, the polynomial degree by one iteration at a higher one. Whatever is not safe here (a straight inextensible beam at
//! rest, a fold, a load or rotation as drive, an unresolved shape) is handed to the general path.

mod curve;
mod kernel;
mod lanes;
mod network;
mod stencil;
mod stress;

pub use curve::{CurveSolver, Response};
