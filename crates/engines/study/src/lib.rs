//! Studies of designs: they see numbers in and numbers out, never a mechanism.

pub mod nlp;
pub mod sampling;
