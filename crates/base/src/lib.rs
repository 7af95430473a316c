//! What everything else stands on: elementary functions, numerics, units, diagnostics. Layer 0: depends on no other room.

pub mod dense;
pub mod diagnostics;
pub mod fits;
pub mod general;
pub mod inertia;
pub mod maths;
pub mod orthogonal;
pub mod quadrature;
pub mod roots;
pub mod text;
pub mod units;
