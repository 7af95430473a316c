//! Exact gradients of an equilibrium by the design, without differences.
//!
//! The state x (bubbles, rotations, displacements, beam forces) makes a Lagrangian ℒ(x; p) stationary, H = ∂²ℒ/∂x². An output
//! y(x; p) then changes with a parameter p by implicit differentiation (M. B. Giles, N. A. Pierce, "An introduction to the adjoint
//! approach to design", Flow, Turbulence and Combustion 65, 2000):
//!
//! `dy/dp = ∂y/∂p − λ · ∂²ℒ/∂x∂p`, `H λ = ∂y/∂x`
//!
//! with the driven unknown held under a kinematic drive. One factorisation of H, of which the path has one for every station
//! anyway, serves all outputs; each output costs one right-hand side, however many parameters there are, as ∂²ℒ/∂x∂p only enters
//! contracted with λ. Two outputs need no right-hand side beyond the tangent τ = dx/dΔ of the path:
//!
//! - the force, F = dW/dΔ: `dF/dp = τ · ∂²ℒ/∂x∂p`, the derivative of ∂ℒ/∂p along the path;
//! - the displacement under a force drive, with dx/dF in place of τ: `dΔ/dp = −dx/dF · ∂²ℒ/∂x∂p`.
//!
//! The stiffness is `K = τᵀ H τ`, stationary in τ, so `dK/dp = ∂(τᵀ H τ)/∂p + ∂(τᵀ H τ)/∂x · dx/dp` with τ held.
//!
//! Loads before the drive leave unknowns behind that are held at values of their own, which depend on the design as well: the
//! derivative by such a value times that of the value, found at the end of the load before, is added.
//!
//! What is differentiated are the discrete equations and the recovery of the results from them, not their limit: the gradient is
//! that of the numbers reported.

mod closure;
mod compute;
mod derivatives;
mod design;
mod field;
mod seed;

use std::fmt;

pub use closure::ChordSensitivity;
pub use compute::Gradients;
pub use derivatives::Derivatives;
pub(crate) use {compute::NO_DISTANCE, derivatives::gap_m};

use crate::clearance::Reflection;
use crate::state::Face;
#[cfg(doc)]
use crate::state::{BeamState, Point};

/// A coordinate axis of the frame of the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// The first coordinate.
    X,
    /// The second coordinate.
    Y,
}

/// What is differentiated: a result at one point of a path, its control held.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Output {
    /// [`Point::force`], N or N·m. Constant under a force drive.
    Force,
    /// [`Point::displacement`], m or rad. Constant under a kinematic drive.
    Displacement,
    /// [`Point::stiffness`], N/m or N·m/rad.
    Stiffness,
    /// [`BeamState::stress_pa`] on one face, Pa, tension positive.
    Stress {
        /// The beam.
        beam: usize,
        /// Where along it, in [0, 1].
        u: f64,
        /// On which face.
        face: Face,
    },
    /// The largest stress magnitude, Pa. Its place moves with the design, which by the envelope theorem does not matter; where two
    /// places are equally stressed, this is the derivative of the one that [`BeamState::peak_stress`] names.
    PeakStress {
        /// Of which beam; `None` for the largest of all, [`Point::peak_stress`].
        beam: Option<usize>,
    },
    /// The largest stress magnitude of one face, [`BeamState::peak_stress_of_face`], Pa; as for both, its place does not matter.
    FacePeakStress {
        /// Of which beam.
        beam: usize,
        /// On which face.
        face: Face,
    },
    /// One coordinate of [`BeamState::shape_m`], m.
    Position {
        /// The beam.
        beam: usize,
        /// Where along it, in [0, 1].
        u: f64,
        /// Which coordinate.
        axis: Axis,
    },
    /// The distance between the surfaces of two beams at given places, m, as [`crate::clearance()`] finds them: the derivative of the
    /// clearance, since the places are those of least distance. Where axes cross there is none; it is that of the thicknesses alone.
    Gap {
        /// A beam and a place on it.
        first: (usize, f64),
        /// The other beam, or the same, and a place on it.
        second: (usize, f64),
        /// If the second place is on the mirror image, the mirror line.
        reflection: Option<Reflection>,
    },
    /// One coordinate of the displacement of a node from rest, m.
    NodeDisplacement {
        /// The node.
        node: usize,
        /// Which coordinate.
        axis: Axis,
    },
    /// The rotation of a node, rad.
    NodeRotation {
        /// The node.
        node: usize,
    },
}

/// What a design may change, with beams that stay closed: nodes and bends are given, `c_0` and lengths follow from the chords as in
/// [`crate::Shape::from_chord`]. Indices are those of the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Parameter {
    /// First coordinate of a node at rest, m; of a support or the driven node as well.
    NodeX(usize),
    /// Second coordinate of a node at rest, m.
    NodeY(usize),
    /// Bend coefficient `c_k` of a beam, rad.
    Bend {
        /// The beam.
        beam: usize,
        /// Which one, from 1.
        k: usize,
    },
    /// In-plane thickness of a beam, m; where it varies, the same amount everywhere.
    Thickness(usize),
    /// In-plane thickness of a beam at one of the places where it is given, m.
    ThicknessAt {
        /// The beam.
        beam: usize,
        /// Which place of [`crate::Beam::profile`], from 0.
        place: usize,
    },
    /// A coordinate of an arm of a beam, m: the node is held, the end of the beam moves.
    Arm {
        /// The beam.
        beam: usize,
        /// 0 for its start, 1 for its end.
        end: usize,
        /// Which coordinate.
        axis: Axis,
    },
    /// Depth of a beam, m.
    Depth(usize),
    /// Young's modulus of a beam, Pa.
    Young(usize),
    /// Poisson's ratio of a beam.
    Poisson(usize),
    /// Thickness of every beam, each changed by the same amount, m.
    AllThickness,
    /// Depth of every beam, m.
    AllDepth,
    /// Young's modulus of every beam, Pa.
    AllYoung,
    /// Poisson's ratio of every beam.
    AllPoisson,
}

/// Derivatives of one output by the quantities of one beam, in the unit of the output per SI unit.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamGradient {
    /// By `c_0 … c_m` one at a time, the length held; 1/rad. The beam then no longer reaches its node: the rest shape of the
    /// network is taken as free of stress all the same, so only combinations that keep beams closed have a meaning of their own.
    pub angle: Vec<f64>,
    /// By the length with all angles held, 1/m; the same remark applies.
    pub length: f64,
    /// By the bend coefficients `c_1 … c_m` of a closed beam, 1/rad.
    pub bend: Vec<f64>,
    /// By the in-plane thickness, 1/m; where it varies, by the same amount everywhere.
    pub thickness: f64,
    /// By the thickness at each place of [`crate::Beam::profile`], 1/m; empty if it is constant.
    pub profile: Vec<f64>,
    /// By the arms at start and end, the beam closed with its bend coefficients held, 1/m.
    pub arms: [[f64; 2]; 2],
    /// By the depth, 1/m.
    pub depth: f64,
    /// By Young's modulus, 1/Pa.
    pub young: f64,
    /// By Poisson's ratio; 0 if the beam is rigid in shear.
    pub poisson: f64,
}

/// Derivatives of one output by everything that describes the network, except directions.
#[derive(Debug, Clone, PartialEq)]
pub struct Gradient {
    /// Per beam, in the order of the network.
    pub beams: Vec<BeamGradient>,
    /// Per node: by its position at rest, the beams at it closed with their bend coefficients held; 1/m.
    pub nodes: Vec<[f64; 2]>,
    /// Per node: by its position at rest with the shapes of all beams held, 1/m. For parametrisations of one's own, together with
    /// [`BeamGradient::angle`] and [`BeamGradient::length`]; only an [`Output::Position`] depends on it.
    pub shift: Vec<[f64; 2]>,
}

impl Gradient {
    /// The derivative by one parameter; `None` if there is no such node, beam or coefficient.
    pub fn by(&self, parameter: Parameter) -> Option<f64> {
        let all = |f: &dyn Fn(&BeamGradient) -> f64| Some(self.beams.iter().map(f).sum());
        let one = |beam: usize| self.beams.get(beam);
        match parameter {
            Parameter::NodeX(node) => self.nodes.get(node).map(|n| n[0]),
            Parameter::NodeY(node) => self.nodes.get(node).map(|n| n[1]),
            Parameter::Bend { beam, k } => one(beam)?.bend.get(k.checked_sub(1)?).copied(),
            Parameter::Thickness(beam) => one(beam).map(|b| b.thickness),
            Parameter::ThicknessAt { beam, place } => one(beam)?.profile.get(place).copied(),
            Parameter::Arm { beam, end, axis } => one(beam)?.arms.get(end).map(|a| if axis == Axis::X { a[0] } else { a[1] }),
            Parameter::Depth(beam) => one(beam).map(|b| b.depth),
            Parameter::Young(beam) => one(beam).map(|b| b.young),
            Parameter::Poisson(beam) => one(beam).map(|b| b.poisson),
            Parameter::AllThickness => all(&|b| b.thickness),
            Parameter::AllDepth => all(&|b| b.depth),
            Parameter::AllYoung => all(&|b| b.young),
            Parameter::AllPoisson => all(&|b| b.poisson),
        }
    }
}

/// Why there is no gradient.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum GradientError {
    /// An output names a beam that does not exist.
    NoBeam {
        /// The beam.
        beam: usize,
    },
    /// An output names a node that does not exist.
    NoNode {
        /// The node.
        node: usize,
    },
    /// An output asks for a place that is not on a beam.
    NotOnBeam {
        /// The place asked for.
        u: f64,
    },
    /// The point does not belong to this path.
    ForeignPoint,
    /// There is no state of that number: the path ended before, or fewer were asked for.
    NoState {
        /// The number of the state, from 0.
        state: usize,
    },
    /// A limit point: the state has no derivative by the control, nor by the design.
    LimitPoint {
        /// The control there, in the unit of the drive.
        control: f64,
    },
    /// A beam ends where it starts, so that its bend and its chord do not determine it.
    ClosedLoop {
        /// The beam.
        beam: usize,
    },
}

impl fmt::Display for GradientError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoBeam { beam } => write!(f, "there is no beam {beam} to differentiate"),
            Self::NoNode { node } => write!(f, "there is no node {node} to differentiate"),
            Self::NotOnBeam { u } => write!(f, "u = {u} is not on a beam; it must be in [0, 1]"),
            Self::NoState { state } => write!(f, "there is no state {state} to differentiate; the path may have ended before it"),
            Self::ForeignPoint => write!(f, "the point is not an equilibrium of this path; take it from the path"),
            Self::LimitPoint { control } => {
                write!(f, "at {control:.6e} the path turns back and has no gradient; differentiate at another control")
            }
            Self::ClosedLoop { beam } => write!(f, "beam {beam} ends where it starts and cannot be held closed; split it in two"),
        }
    }
}

impl std::error::Error for GradientError {}

impl Axis {
    fn unit(self) -> [f64; 2] {
        match self {
            Self::X => [1.0, 0.0],
            Self::Y => [0.0, 1.0],
        }
    }
}
