//! Networks of large-deflection planar beams: equilibrium paths and stress.
//!
//! Beams have any smooth shape at rest ([`Shape`]) and meet at nodes, which may be rigid bodies, in rigid joints or hinges ([`Network`]).
//! One [`Drive`] moves or loads them, after any number of load stages. [`trace`] follows the equilibrium from rest and reports force,
//! stiffness, energy and stress ([`Path`], [`Point`], [`BeamState`]); [`Path::gradients`] differentiates it; [`CurveSolver`] computes
//! whole curves fast. Theory: `docs/theory/beam.md`.
//!
//! Model: C.-C. Lan, J.-H. Wang, Y.-H. Chen, "A Compliant Constant-Force Mechanism for Adaptive Robot End-Effector Operations",
//! ICRA 2010, extended by stretching and shear (E. Reissner, ZAMP 23, 1972); [`Theory`] chooses. Departures from the paper:
//!
//! - COMP-1: M = EI/L dφ/du. Eq. (4) lacks the 1/L that eq. (5) has; see [`BeamState::moment_nm`].
//!
//! Not modelled: contact between beams, self-weight, fillets, plasticity, and buckling out of the plane.
//!
//! SI units throughout. The same input gives the same bits on every machine.

mod arclength;
mod assembly;
mod clearance;
mod counters;
mod element;
mod error;
mod fast;
mod follow;
mod gradient;
mod model;
mod network;
mod output;
mod overlap;
mod path;
mod section;
mod shape;
mod stability;
mod state;
mod stepping;
mod through;

pub use clearance::{Clearance, Image, Place, Reflection, clearance, clearance_near};
pub use counters::Counters;
pub use error::{NetworkError, PathError, Status};
pub use fast::{BatchSolver, CurveSolver, CurveStates, DesignError, Response, Variant};
pub use gradient::{Axis, BeamGradient, ChordSensitivity, Derivatives, Gradient, GradientError, Gradients, Output, Parameter};
pub use network::{Beam, Drive, Follow, Joint, Joints, Network, Node, Rotation, Settings, Stage, Support, Theory};
pub use path::{Path, trace};
pub use section::Section;
pub use shape::{Shape, ShapeError};
pub use stability::{Bifurcation, Fold, Jump};
pub use state::{BeamState, Face, NodeState, PeakStress, Point};
pub use through::ThroughError;
