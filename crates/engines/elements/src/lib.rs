//! Machine elements: the material catalogue, line contact, springs. Theory: `docs/theory/elements.md`.

pub mod hertz;
pub mod materials;
pub mod springs;
