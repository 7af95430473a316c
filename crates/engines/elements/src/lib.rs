//! Machine elements: what designs are made of. So far the material catalogue.

pub mod materials;
