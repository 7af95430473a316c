//! Machine elements: the material catalogue, line contact, springs, wrap springs, gears, cables, grooves and wrap friction; belts and gear
//! pairs to compare with. Theory: `docs/theory/elements.md`.

pub mod cables;
pub mod gears;
pub mod grooves;
pub mod hertz;
pub mod materials;
pub mod springs;
pub mod transmissions;
pub mod wrap;
pub mod wrap_spring;
