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
//! What is differentiated are the discrete equations and the recovery of the results from them, not their limit: the gradient is
//! that of the numbers reported.

mod closure;
mod field;
mod seed;

use std::fmt;

pub use closure::ChordSensitivity;
use field::{BeamRhs, Field, Sensitivity};
use seed::{Seed, polished_place};

use crate::{
    assembly::{Model, Resolution, System},
    counters::Counters,
    path::Path,
    state::{BeamState, Face, Point},
};

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
    /// One coordinate of [`BeamState::shape_m`], m.
    Position {
        /// The beam.
        beam: usize,
        /// Where along it, in [0, 1].
        u: f64,
        /// Which coordinate.
        axis: Axis,
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
    /// In-plane thickness of a beam, m.
    Thickness(usize),
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
    /// By the in-plane thickness, 1/m.
    pub thickness: f64,
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
            Self::ForeignPoint => write!(f, "the point is not an equilibrium of this path; take it from the path"),
            Self::LimitPoint { control } => {
                write!(f, "at {control:.6e} the path turns back and has no gradient; differentiate at another control")
            }
            Self::ClosedLoop { beam } => write!(f, "beam {beam} ends where it starts and cannot be held closed; split it in two"),
        }
    }
}

impl std::error::Error for GradientError {}

/// Computes gradients at points of one path; see [`Path::gradients`].
#[derive(Debug)]
pub struct Gradients<'p> {
    model: &'p Model,
    resolution: &'p Resolution,
    system: System<'p>,
    closures: Vec<ChordSensitivity>,
    tangent: Vec<f64>,
    newton_steps: u64,
}

/// How an output depends on the state and the design: what is left to solve for.
struct Dependence {
    /// By the state.
    rhs: Vec<f64>,
    /// By the beams, the state held.
    explicit: Vec<Sensitivity>,
    /// By the positions of the nodes at rest, dimensionless.
    shift: Vec<[f64; 2]>,
    /// SI unit of the derivatives above.
    unit: f64,
}

impl Path {
    /// Prepares gradients at points of this path.
    ///
    /// ```
    /// use forcewright_beam::{Beam, Drive, Joint, Network, Node, Output, Parameter, Section, Settings, Shape, Support, trace};
    /// // A cantilever of 0.1 m, its end pushed 20 mm sideways.
    /// let section = Section { young_pa: 2e9, thickness_m: 1e-3, depth_m: 1e-2, poisson: None };
    /// let (start_joint, end_joint) = (Joint::Rigid, Joint::Rigid);
    /// let network = Network {
    ///     nodes: vec![
    ///         Node { position_m: [0.0, 0.0], support: Support::Clamped },
    ///         Node { position_m: [0.1, 0.0], support: Support::Free },
    ///     ],
    ///     beams: vec![Beam { start: 0, end: 1, shape: Shape::new(vec![0.0], 0.1)?, section, start_joint, end_joint }],
    ///     drive: Drive::Displacement { node: 1, direction: [0.0, 1.0] },
    /// };
    /// let path = trace(&network, &[0.02], &Settings::default(), &mut |_| true)?;
    /// let gradient = &path.gradients()?.at(&path.points[0], &[Output::Force])?[0];
    /// // Force is proportional to depth.
    /// let by_depth = gradient.by(Parameter::Depth(0)).unwrap_or_default();
    /// assert!((by_depth * section.depth_m / path.points[0].force - 1.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`GradientError::ClosedLoop`].
    pub fn gradients(&self) -> Result<Gradients<'_>, GradientError> {
        let (model, resolution) = self.equations();
        let mut closures = Vec::with_capacity(model.beams.len());
        for (beam, b) in model.beams.iter().enumerate() {
            closures.push(b.info.shape.chord_sensitivity().map_err(|_| GradientError::ClosedLoop { beam })?);
        }
        Ok(Gradients { model, resolution, system: System::new(model, resolution), closures, tangent: Vec::new(), newton_steps: 0 })
    }
}

/// A Newton step from a point of the path, rad and units of length, is below this.
const LARGEST_RESIDUE: f64 = 1e-5;

impl Gradients<'_> {
    /// Work done so far: one evaluation and one factorisation per call of [`Gradients::at`].
    pub fn counters(&self) -> Counters {
        Counters {
            newton_iterations: self.newton_steps,
            residual_evaluations: self.system.evaluations,
            factorisations: self.system.factorisations,
            ..Counters::default()
        }
    }

    /// The gradients of some outputs at a point of the path, one of [`Path::points`] or from [`Path::at`].
    ///
    /// # Errors
    /// [`GradientError`] if an output names what does not exist, the point is not of this path, or it is a limit point.
    pub fn at(&mut self, point: &Point, outputs: &[Output]) -> Result<Vec<Gradient>, GradientError> {
        outputs.iter().try_for_each(|output| self.check(output))?;
        let state = self.raw_state(point)?;
        let control = point.control / self.model.control_unit();
        let limit = GradientError::LimitPoint { control: point.control };
        self.system.linearise(&state, control).map_err(|_| limit)?;
        self.system.newton_step();
        self.newton_steps += 1;
        let motions = self.model.nodes.iter().flat_map(|n| n.translations.iter().map(|t| t.0).chain(n.rotation));
        // Written so that NaN fails.
        if !motions.into_iter().all(|i| self.system.change[i].abs() < LARGEST_RESIDUE) {
            return Err(GradientError::ForeignPoint);
        }
        self.system.tangent();
        self.tangent.clone_from(&self.system.change);
        let fields: Vec<Field> = (0..self.model.beams.len())
            .map(|beam| {
                let at = self.resolution.coordinates(self.model, beam, &state);
                Field::new(&self.resolution.basis, &self.resolution.rest[beam], self.model.beams[beam].constants, at)
            })
            .collect();
        Ok(outputs.iter().map(|output| self.differentiate(*output, point, &fields)).collect())
    }

    fn check(&self, output: &Output) -> Result<(), GradientError> {
        let beams = self.model.beams.len();
        match *output {
            Output::Stress { beam, .. } | Output::PeakStress { beam: Some(beam) } | Output::Position { beam, .. } if beam >= beams => {
                Err(GradientError::NoBeam { beam })
            }
            Output::Stress { u, .. } | Output::Position { u, .. } if !(0.0..=1.0).contains(&u) => Err(GradientError::NotOnBeam { u }),
            Output::NodeDisplacement { node, .. } | Output::NodeRotation { node } if node >= self.model.nodes.len() => {
                Err(GradientError::NoNode { node })
            }
            _ => Ok(()),
        }
    }

    /// The unknowns and bubbles that a point was made from.
    fn raw_state(&self, point: &Point) -> Result<Vec<f64>, GradientError> {
        let (model, bubbles) = (self.model, self.resolution.basis.bubbles);
        let modes = self.resolution.basis.points();
        let same = point.nodes.len() == model.nodes.len()
            && point.beams.len() == model.beams.len()
            && point.beams.iter().all(|b| b.modes_rad.len() == modes);
        if !same {
            return Err(GradientError::ForeignPoint);
        }
        let mut x = vec![0.0; self.resolution.state_len(model)];
        for (freedom, node) in model.nodes.iter().zip(&point.nodes) {
            for (place, direction) in &freedom.translations {
                x[*place] = field::dot(*direction, node.displacement_m) / model.length_m;
            }
            if let Some(place) = freedom.rotation {
                x[place] = node.rotation_rad;
            }
        }
        for (index, (beam, state)) in model.beams.iter().zip(&point.beams).enumerate() {
            for (place, rotation) in beam.ends.iter().zip([state.start_rotation_rad, state.end_rotation_rad]) {
                if let Some(place) = place {
                    x[*place] = rotation;
                }
            }
            x[beam.force] = state.force_n[0] / model.force_n;
            x[beam.force + 1] = state.force_n[1] / model.force_n;
            // The recovery returns the bubbles solved for, and adds more.
            let first = model.unknowns + index * bubbles;
            x[first..first + bubbles].copy_from_slice(&state.modes_rad[..bubbles]);
        }
        Ok(x)
    }

    fn differentiate(&mut self, output: Output, point: &Point, fields: &[Field]) -> Gradient {
        let mut parts = self.dependence(output, point, fields);
        let contracted = match output {
            // Under a kinematic drive the displacement is the control, under a force drive the force is.
            Output::Force if self.model.kinematic => Some((&self.tangent, 1.0)),
            Output::Displacement if !self.model.kinematic => Some((&self.tangent, -1.0)),
            Output::Force | Output::Displacement => None,
            _ => {
                self.system.solve_state(&mut parts.rhs);
                Some((&parts.rhs, -1.0))
            }
        };
        if let Some((change, factor)) = contracted {
            for (beam, field) in fields.iter().enumerate() {
                let change = self.resolution.coordinates(self.model, beam, change);
                field.add_mixed(&change, factor, &mut parts.explicit[beam]);
            }
        }
        self.in_si(&parts)
    }

    fn dependence(&self, output: Output, point: &Point, fields: &[Field]) -> Dependence {
        let model = self.model;
        let none = |b: &crate::assembly::BeamModel| Sensitivity::new(b.info.shape.angle_rad().len());
        let mut parts = Dependence {
            rhs: vec![0.0; self.resolution.state_len(model)],
            explicit: model.beams.iter().map(none).collect(),
            shift: vec![[0.0; 2]; model.nodes.len()],
            unit: 1.0,
        };
        match output {
            Output::Force => parts.unit = model.reaction_unit(),
            Output::Displacement => parts.unit = model.displacement_unit(),
            Output::Stiffness => self.add_stiffness(&mut parts, fields),
            Output::Stress { beam, u, face } => self.add_stress(&mut parts, &point.beams[beam], &fields[beam], (beam, u, face, 1.0)),
            Output::PeakStress { beam } => {
                let beam = beam.or_else(|| point.peak_stress().map(|p| p.0)).unwrap_or(0);
                let (state, peak) = (&point.beams[beam], point.beams[beam].peak_stress());
                let u = polished_place(state, peak.u, peak.face, fields[beam].constants.axial > 0.0);
                let sign = if peak.tension { 1.0 } else { -1.0 };
                self.add_stress(&mut parts, state, &fields[beam], (beam, u, peak.face, sign));
            }
            Output::Position { beam, u, axis } => {
                let (axis, start) = (axis.unit(), model.beams[beam].nodes[0]);
                parts.unit = model.length_m;
                parts.shift[start] = axis;
                self.add_translation(&mut parts, start, axis);
                let mut seed = Seed::new(&fields[beam], &point.beams[beam], parts.explicit[beam].angles.len());
                seed.add_position(u, axis);
                self.take(&mut parts, beam, seed.close());
            }
            Output::NodeDisplacement { node, axis } => {
                parts.unit = model.length_m;
                self.add_translation(&mut parts, node, axis.unit());
            }
            Output::NodeRotation { node } => {
                if let Some(place) = model.nodes[node].rotation {
                    parts.rhs[place] = 1.0;
                }
            }
        }
        parts
    }

    fn add_translation(&self, parts: &mut Dependence, node: usize, axis: [f64; 2]) {
        for (place, direction) in &self.model.nodes[node].translations {
            parts.rhs[*place] += field::dot(*direction, axis);
        }
    }

    fn add_stress(&self, parts: &mut Dependence, state: &BeamState, field: &Field, at: (usize, f64, Face, f64)) {
        let (beam, u, face, sign) = at;
        let mut seed = Seed::new(field, state, parts.explicit[beam].angles.len());
        seed.add_stress(u, face, sign, self.model.force_n);
        self.take(parts, beam, seed.close());
    }

    fn add_stiffness(&self, parts: &mut Dependence, fields: &[Field]) {
        let model = self.model;
        parts.unit = model.reaction_unit() / model.displacement_unit();
        // The tangent under a force drive is dx/dF.
        let scale = if model.kinematic { 1.0 } else { self.system.stiffness(&self.tangent) };
        let by_displacement: Vec<f64> = self.tangent.iter().map(|t| scale * t).collect();
        for (beam, field) in fields.iter().enumerate() {
            let change = self.resolution.coordinates(model, beam, &by_displacement);
            let mut rhs = BeamRhs::new(self.resolution.basis.bubbles);
            let mut sum = Sensitivity::new(parts.explicit[beam].angles.len());
            field.add_curvature(&change, &mut sum, &mut rhs);
            self.take(parts, beam, (rhs, sum));
        }
    }

    /// Adds the part of one beam.
    fn take(&self, parts: &mut Dependence, beam: usize, (rhs, explicit): (BeamRhs, Sensitivity)) {
        let bubbles = self.resolution.basis.bubbles;
        let first = self.model.unknowns + beam * bubbles;
        for (target, value) in parts.rhs[first..first + bubbles].iter_mut().zip(&rhs.bubbles) {
            *target += value;
        }
        let values = [rhs.ends[0], rhs.ends[1], rhs.force[0], rhs.force[1]];
        for (place, value) in self.model.beams[beam].places().iter().zip(values) {
            if let Some(place) = place {
                parts.rhs[*place] += value;
            }
        }
        parts.explicit[beam].add(&explicit, 1.0);
    }

    /// From logarithmic derivatives by dimensionless constants to the quantities of the network.
    fn in_si(&self, parts: &Dependence) -> Gradient {
        let unit = parts.unit;
        let shift: Vec<[f64; 2]> = parts.shift.iter().map(|s| s.map(|v| v * unit / self.model.length_m)).collect();
        let mut nodes = shift.clone();
        let mut beams = Vec::with_capacity(self.model.beams.len());
        for ((model, s), closure) in self.model.beams.iter().zip(&parts.explicit).zip(&self.closures) {
            let section = model.info.section();
            let angle: Vec<f64> = s.angles.iter().map(|a| unit * a).collect();
            // EI/L ∝ E w³ b/L, 1/EA ∝ 1/(E w b), 1/kGA ∝ (1 + ν)/(E w b).
            let soft = s.axial + s.shear;
            let length = unit * (s.length - s.bending) / model.info.shape.length_m();
            for (i, (by_angle, by_length)) in closure.angle_by_chord_rad_per_m.iter().zip(closure.length_by_chord).enumerate() {
                let by_chord = angle[0] * by_angle + length * by_length;
                nodes[model.nodes[0]][i] -= by_chord;
                nodes[model.nodes[1]][i] += by_chord;
            }
            let closed = closure.angle_by_bend.iter().zip(&closure.length_by_bend_m);
            beams.push(BeamGradient {
                bend: angle[1..].iter().zip(closed).map(|(own, (a, l))| own + angle[0] * a + length * l).collect(),
                angle,
                length,
                thickness: unit * (3.0 * s.bending - soft + s.thickness) / section.thickness_m,
                depth: unit * (s.bending - soft + s.depth) / section.depth_m,
                young: unit * (s.bending - soft) / section.young_pa,
                poisson: section.poisson.map_or(0.0, |nu| unit * s.shear / (1.0 + nu)),
            });
        }
        Gradient { beams, nodes, shift }
    }
}

impl Axis {
    fn unit(self) -> [f64; 2] {
        match self {
            Self::X => [1.0, 0.0],
            Self::Y => [0.0, 1.0],
        }
    }
}
