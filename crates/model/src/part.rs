//! What is made: the only thing that exporters see. Lengths in metres.

use forcewright_curves::Profile;

use crate::Check;

/// A plate of constant thickness, cut or printed in one piece.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Short name, fit for a file name: `monolith`.
    pub name: String,
    /// What it is, for people.
    pub title: String,
    /// What it is made of; `None` if nothing was said.
    pub material: Option<String>,
    /// Its extent out of the plane, m.
    pub depth_m: f64,
    /// The outer boundary, counterclockwise.
    pub outline: Profile,
    /// Boundaries of what is cut out, clockwise.
    pub cutouts: Vec<Profile>,
    /// Round holes through the plate.
    pub holes: Vec<Hole>,
    /// What the maker must know, a sentence each.
    pub notes: Vec<String>,
}

/// The plates of a mechanism.
#[derive(Clone, Debug, Default)]
pub struct PartSet {
    /// One of each kind.
    pub parts: Vec<Part>,
    /// Whether the process can make them.
    pub checks: Vec<Check>,
}

/// Why a mechanism has no plates.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoPart {
    /// Stable code; `explain` knows it.
    pub code: &'static str,
    /// What is wrong, with the names of the project.
    pub message: String,
    /// What would help.
    pub help: String,
}

/// A round hole through a plate.
#[derive(Clone, Debug, PartialEq)]
pub struct Hole {
    /// Middle, m.
    pub centre_m: [f64; 2],
    /// Diameter, m.
    pub diameter_m: f64,
    /// What it is for: `M3 clearance`.
    pub purpose: String,
}
