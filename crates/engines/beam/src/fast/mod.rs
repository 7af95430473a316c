//! Whole curves fast: force, stiffness and largest stress at given displacements, for the networks that most designs are.
//!
//! The general path ([`crate::trace`]) pivots everywhere, keeps every state and verifies each step twice. Here beams are condensed to
//! their end motions four at a time, one or two Newton iterations advance a step whose prediction is close, and values between the few
//! states are interpolated; so are the derivatives of the force by the design, which a state and its tangent contain. What that costs
//! is measured in every run: the last step's error by its size, the interpolation by leaving each state out, the polynomial degree by
//! one iteration at a higher one. Whatever is not safe here (a straight inextensible beam at rest, a fold, a load or rotation as
//! drive, an unresolved shape) is handed to the general path.

#![allow(clippy::inline_always, reason = "what is not inlined has no wide vector instructions: see `lanes::Vectors`")]

mod batch;
mod curve;
mod gradient;
mod hermite;
mod kernel;
mod lanes;
mod line;
mod mixed;
mod network;
mod outputs;
mod states;
mod stress;
mod walk;

pub use batch::{BatchSolver, DesignError, Variant};
pub use curve::{CurveSolver, Response};
pub use outputs::CurveStates;
