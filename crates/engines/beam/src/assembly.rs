//! From a network to a small system of equations, and its linear algebra.

use std::sync::Arc;

use forcewright_base::dense::{Lu, Singular};

use crate::{
    element::{Basis, Constants, Coordinates, Element, RestShape},
    network::{Drive, Joint, Network, Rotation, Support, Theory, unit},
    state::BeamInfo,
};

/// Where the motion of a node is found among the unknowns.
#[derive(Debug, Clone, Default)]
pub(crate) struct NodeFreedom {
    /// Unknown and its direction, at most two.
    pub(crate) translations: Vec<(usize, [f64; 2])>,
    /// Unknown of the rotation; `None` if held or without any beam that turns with it.
    pub(crate) rotation: Option<usize>,
}

/// A beam with the places of its unknowns.
#[derive(Debug)]
pub(crate) struct BeamModel {
    pub(crate) constants: Constants,
    pub(crate) nodes: [usize; 2],
    /// Unknowns of the end rotations; `None` if held.
    pub(crate) ends: [Option<usize>; 2],
    /// Unknown of H; that of V follows.
    pub(crate) force: usize,
    pub(crate) info: Arc<BeamInfo>,
}

impl BeamModel {
    /// Unknowns of (`φ_A`, `φ_B`, H, V).
    pub(crate) fn places(&self) -> [Option<usize>; 4] {
        [self.ends[0], self.ends[1], Some(self.force), Some(self.force + 1)]
    }
}

/// A dimensionless network with numbered unknowns. The driven one is the last.
#[derive(Debug)]
pub(crate) struct Model {
    /// Unit of length, m: the longest beam.
    pub(crate) length_m: f64,
    /// Unit of force, N: the largest bending stiffness divided by the square of the unit of length.
    pub(crate) force_n: f64,
    pub(crate) nodes: Vec<NodeFreedom>,
    pub(crate) beams: Vec<BeamModel>,
    /// Number of unknowns, without bubbles.
    pub(crate) unknowns: usize,
    /// Driven displacement per driven unknown: the cosine between the drive and the guide.
    pub(crate) projection: f64,
    /// Whether the driven unknown is prescribed.
    pub(crate) kinematic: bool,
    /// Whether the drive turns.
    turning: bool,
}

impl Model {
    /// `network` must have passed [`Network::check`].
    pub(crate) fn new(network: &Network, theory: Theory) -> Self {
        let length_m = network.beams.iter().map(|b| b.shape.length_m()).fold(0.0, f64::max);
        let stiffness = network.beams.iter().map(|b| b.section.bending_stiffness_n_m2()).fold(0.0, f64::max);
        let (nodes, count, projection) = number_nodes(network);
        let mut model = Self {
            length_m,
            force_n: stiffness / (length_m * length_m),
            nodes,
            beams: Vec::with_capacity(network.beams.len()),
            unknowns: count,
            projection,
            kinematic: network.drive.is_kinematic(),
            turning: matches!(network.drive, Drive::Rotation { .. } | Drive::Moment { .. }),
        };
        for beam in &network.beams {
            let mut end = |node: usize, joint: Joint| match joint {
                Joint::Rigid => model.nodes[node].rotation,
                Joint::Hinged => {
                    model.unknowns += 1;
                    Some(model.unknowns - 1)
                }
            };
            let ends = [end(beam.start, beam.start_joint), end(beam.end, beam.end_joint)];
            let force = model.unknowns;
            model.unknowns += 2;
            let length = beam.shape.length_m() / length_m;
            let soft = |stiffness_n: f64| if theory == Theory::Reissner { model.force_n / stiffness_n } else { 0.0 };
            let constants = Constants {
                length,
                bending: beam.section.bending_stiffness_n_m2() / stiffness / length,
                axial: soft(beam.section.axial_stiffness_n()),
                shear: soft(beam.section.shear_stiffness_n()),
            };
            let start_m = network.nodes[beam.start].position_m;
            let info = Arc::new(BeamInfo::new(start_m, beam, theory));
            model.beams.push(BeamModel { constants, nodes: [beam.start, beam.end], ends, force, info });
        }
        model.move_driven_last(network.drive.node());
        model
    }

    /// Swaps the number of the driven unknown, which [`number_nodes`] gives as 0, with the last one.
    fn move_driven_last(&mut self, node: usize) {
        let last = self.unknowns;
        // The last place is new and the place 0 is dropped: all others move down by one.
        let rename = |i: &mut usize| *i = if *i == 0 { last - 1 } else { *i - 1 };
        debug_assert!(node < self.nodes.len(), "checked before");
        for n in &mut self.nodes {
            n.translations.iter_mut().for_each(|(i, _)| rename(i));
            n.rotation.iter_mut().for_each(rename);
        }
        for b in &mut self.beams {
            b.ends.iter_mut().flatten().for_each(rename);
            rename(&mut b.force);
        }
    }

    /// Unit of the control, SI.
    pub(crate) fn control_unit(&self) -> f64 {
        if self.kinematic { self.displacement_unit() } else { self.reaction_unit() }
    }

    /// Unit of the driven displacement or rotation, SI.
    pub(crate) fn displacement_unit(&self) -> f64 {
        if self.turning { 1.0 } else { self.length_m }
    }

    /// Unit of the conjugate force or moment, SI.
    pub(crate) fn reaction_unit(&self) -> f64 {
        if self.turning { self.force_n * self.length_m } else { self.force_n }
    }

    /// Place of the driven unknown.
    pub(crate) fn driven(&self) -> usize {
        self.unknowns - 1
    }

    /// Displacement of a node in units of length.
    pub(crate) fn displacement(&self, node: usize, x: &[f64]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (i, direction) in &self.nodes[node].translations {
            sum[0] += direction[0] * x[*i];
            sum[1] += direction[1] * x[*i];
        }
        sum
    }

    /// Rotation of an unknown that may be held.
    pub(crate) fn rotation(unknown: Option<usize>, x: &[f64]) -> f64 {
        unknown.map_or(0.0, |i| x[i])
    }
}

/// Numbers the motions of the nodes: the driven one is 0. Returns them, the count and the projection of the drive.
fn number_nodes(network: &Network) -> (Vec<NodeFreedom>, usize, f64) {
    let mut count = 1;
    let mut next = || {
        count += 1;
        count - 1
    };
    let mut projection = 1.0;
    let mut nodes = Vec::with_capacity(network.nodes.len());
    for (index, node) in network.nodes.iter().enumerate() {
        let driven = network.drive.node() == index;
        let drive = match network.drive {
            Drive::Displacement { direction, .. } | Drive::Force { direction, .. } if driven => unit(direction),
            _ => None,
        };
        let mut freedom = NodeFreedom::default();
        match (node.support, drive) {
            (Support::Free, drive) => {
                let d = drive.unwrap_or([1.0, 0.0]);
                freedom.translations.push((if drive.is_some() { 0 } else { next() }, d));
                freedom.translations.push((next(), [-d[1], d[0]]));
            }
            (Support::Slider { direction, .. }, drive) => {
                let s = unit(direction).unwrap_or([1.0, 0.0]);
                if let Some(d) = drive {
                    projection = s[0] * d[0] + s[1] * d[1];
                }
                freedom.translations.push((if drive.is_some() { 0 } else { next() }, s));
            }
            (Support::Clamped | Support::Pinned, _) => {}
        }
        let held = matches!(node.support, Support::Clamped | Support::Slider { rotation: Rotation::Fixed, .. });
        if !held && network.turns_beams(index) {
            let turned = driven && matches!(network.drive, Drive::Rotation { .. } | Drive::Moment { .. });
            freedom.rotation = Some(if turned { 0 } else { next() });
        }
        nodes.push(freedom);
    }
    (nodes, count, projection)
}

/// Tables for one polynomial degree.
#[derive(Debug)]
pub(crate) struct Resolution {
    pub(crate) degree: usize,
    pub(crate) basis: Basis,
    pub(crate) rest: Vec<RestShape>,
}

impl Resolution {
    pub(crate) fn new(model: &Model, degree: usize) -> Self {
        let basis = Basis::new(degree);
        let rest = model.beams.iter().map(|b| RestShape::new(&basis, |u| b.info.shape.angle_at(u))).collect();
        Self { degree, basis, rest }
    }

    /// Length of a state: the unknowns, then the bubbles of each beam.
    pub(crate) fn state_len(&self, model: &Model) -> usize {
        model.unknowns + model.beams.len() * self.basis.bubbles
    }

    /// The part of a state that belongs to one beam.
    pub(crate) fn coordinates<'a>(&self, model: &Model, beam: usize, x: &'a [f64]) -> Coordinates<'a> {
        let b = &model.beams[beam];
        let first = model.unknowns + beam * self.basis.bubbles;
        Coordinates {
            ends: b.ends.map(|end| Model::rotation(end, x)),
            force: [x[b.force], x[b.force + 1]],
            bubbles: &x[first..first + self.basis.bubbles],
        }
    }
}

/// The linearised equations at one state, with all buffers.
#[derive(Debug)]
pub(crate) struct System<'a> {
    pub(crate) model: &'a Model,
    pub(crate) resolution: &'a Resolution,
    pub(crate) elements: Vec<Element>,
    pub(crate) matrix: Vec<f64>,
    pub(crate) residual: Vec<f64>,
    lu: Lu,
    rhs: Vec<f64>,
    /// Newton step or tangent, of the length of a state.
    pub(crate) change: Vec<f64>,
    pub(crate) evaluations: u64,
    pub(crate) factorisations: u64,
}

impl<'a> System<'a> {
    pub(crate) fn new(model: &'a Model, resolution: &'a Resolution) -> Self {
        let m = model.unknowns;
        Self {
            model,
            resolution,
            elements: model.beams.iter().map(|_| Element::new(resolution.basis.bubbles)).collect(),
            matrix: vec![0.0; m * m],
            residual: vec![0.0; m],
            lu: Lu::new(),
            rhs: vec![0.0; m],
            change: vec![0.0; resolution.state_len(model)],
            evaluations: 0,
            factorisations: 0,
        }
    }

    /// Number of unknowns that are solved for.
    pub(crate) fn solved(&self) -> usize {
        self.model.unknowns - usize::from(self.model.kinematic)
    }

    /// Evaluates and factors the equations at state `x` and dimensionless control.
    ///
    /// # Errors
    /// [`Singular`] if the tangent, or that of the bubbles of a beam, has no inverse.
    pub(crate) fn linearise(&mut self, x: &[f64], control: f64) -> Result<(), Singular> {
        self.evaluate(x, control)?;
        self.factorisations += 1;
        self.lu.factor(self.solved(), self.model.unknowns, &self.matrix)
    }

    /// Evaluates the equations without factoring them: at a limit point the tangent has no inverse.
    ///
    /// # Errors
    /// [`Singular`] if the tangent of the bubbles of a beam has no inverse.
    pub(crate) fn evaluate(&mut self, x: &[f64], control: f64) -> Result<(), Singular> {
        let (model, resolution) = (self.model, self.resolution);
        self.evaluations += 1;
        self.matrix.fill(0.0);
        self.residual.fill(0.0);
        for (index, beam) in model.beams.iter().enumerate() {
            let at = resolution.coordinates(model, index, x);
            self.elements[index].linearise(&resolution.basis, &resolution.rest[index], &beam.constants, at)?;
            self.scatter(index, x);
        }
        if !model.kinematic {
            self.residual[model.driven()] -= control * model.projection;
        }
        Ok(())
    }

    /// Adds one condensed beam.
    fn scatter(&mut self, index: usize, x: &[f64]) {
        let (model, m) = (self.model, self.model.unknowns);
        let (beam, element) = (&model.beams[index], &self.elements[index]);
        let places = beam.places();
        for (i, row) in places.iter().enumerate() {
            let Some(row) = row else { continue };
            self.residual[*row] += element.gradient[i];
            for (j, column) in places.iter().enumerate() {
                if let Some(column) = column {
                    self.matrix[row * m + column] += element.matrix[i][j];
                }
            }
        }
        // F·(u_B − u_A).
        for (node, sign) in beam.nodes.iter().zip([-1.0, 1.0]) {
            for (place, direction) in &model.nodes[*node].translations {
                for (axis, component) in direction.iter().enumerate() {
                    let (force, factor) = (beam.force + axis, sign * component);
                    self.residual[*place] += factor * x[force];
                    self.residual[force] += factor * x[*place];
                    self.matrix[place * m + force] += factor;
                    self.matrix[force * m + place] += factor;
                }
            }
        }
    }

    /// Newton step at the linearised state, into [`System::change`].
    pub(crate) fn newton_step(&mut self) {
        let n = self.solved();
        for (target, value) in self.rhs[..n].iter_mut().zip(&self.residual) {
            *target = -value;
        }
        self.lu.solve(&mut self.rhs[..n]);
        self.change.fill(0.0);
        self.change[..n].copy_from_slice(&self.rhs[..n]);
        self.expand(1.0);
    }

    /// Derivative of the state by the control at the linearised state, into [`System::change`].
    pub(crate) fn tangent(&mut self) {
        let (n, m) = (self.solved(), self.model.unknowns);
        let p = self.model.projection;
        self.change.fill(0.0);
        if self.model.kinematic {
            for row in 0..n {
                self.rhs[row] = -self.matrix[row * m + m - 1] / p;
            }
            self.change[m - 1] = 1.0 / p;
        } else {
            self.rhs.fill(0.0);
            self.rhs[m - 1] = p;
        }
        self.lu.solve(&mut self.rhs[..n]);
        self.change[..n].copy_from_slice(&self.rhs[..n]);
        self.expand(0.0);
    }

    /// Replaces a right-hand side of the length of a state by the solution of the linearised equations, bubbles included. Under a
    /// kinematic drive the driven unknown is held: its equation is left out and its solution is 0.
    pub(crate) fn solve_state(&mut self, rhs: &mut [f64]) {
        let bubbles = self.resolution.basis.bubbles;
        let (unknowns, inner) = rhs.split_at_mut(self.model.unknowns);
        for (index, beam) in self.model.beams.iter().enumerate() {
            let part = &mut inner[index * bubbles..(index + 1) * bubbles];
            if part.iter().all(|v| *v == 0.0) {
                continue;
            }
            let left = self.elements[index].project(part);
            for (place, value) in beam.places().iter().zip(left) {
                if let Some(place) = place {
                    unknowns[*place] -= value;
                }
            }
            self.elements[index].solve_inner(part);
        }
        let n = self.solved();
        self.lu.solve(&mut unknowns[..n]);
        unknowns[n..].fill(0.0);
        self.change.fill(0.0);
        self.change[..n].copy_from_slice(&unknowns[..n]);
        self.expand(0.0);
        for (x, change) in inner.iter_mut().zip(&self.change[self.model.unknowns..]) {
            *x += change;
        }
    }

    pub(crate) fn expand(&mut self, residual: f64) {
        let bubbles = self.resolution.basis.bubbles;
        let (unknowns, inner) = self.change.split_at_mut(self.model.unknowns);
        for (index, beam) in self.model.beams.iter().enumerate() {
            let [a, b] = beam.ends.map(|end| Model::rotation(end, unknowns));
            let change = [a, b, unknowns[beam.force], unknowns[beam.force + 1]];
            self.elements[index].expand(change, residual, &mut inner[index * bubbles..(index + 1) * bubbles]);
        }
    }

    /// Dimensionless reaction on a kinematic drive at the linearised state moved by [`System::change`]: right to second order.
    pub(crate) fn reaction(&self) -> f64 {
        (self.residual[self.model.driven()] + self.driven_row(&self.change)) / self.model.projection
    }

    /// Dimensionless stiffness dF/dΔ from the tangent.
    pub(crate) fn stiffness(&self, tangent: &[f64]) -> f64 {
        if self.model.kinematic {
            self.driven_row(tangent) / self.model.projection
        } else {
            1.0 / (self.model.projection * tangent[self.model.driven()])
        }
    }

    fn driven_row(&self, change: &[f64]) -> f64 {
        let m = self.model.unknowns;
        self.matrix[(m - 1) * m..].iter().zip(change).map(|(a, b)| a * b).sum()
    }

    /// After a singular factorisation: a combination of unknowns without any effect.
    pub(crate) fn null_vector(&self, singular: Singular) -> Vec<f64> {
        self.lu.null_vector(singular.column)
    }
}
