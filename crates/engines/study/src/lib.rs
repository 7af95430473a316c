//! Studies of designs: they see numbers in and numbers out, never a mechanism.

pub mod calibrate;
pub mod cma;
pub mod differences;
pub mod evaluator;
pub mod nlp;
pub mod optimise;
pub mod pareto;
mod posing;
mod random;
pub mod regression;
pub mod sampling;
pub mod task;
pub mod tolerance;
