//! The linearised equations of a network, and their linear algebra.

use std::sync::Arc;

use forcewright_base::dense::{Lu, Singular};

use crate::{
    element::{Basis, Coordinates, Element, RestShape},
    model::{Model, swing},
    network::is_zero,
};

/// Tables for one polynomial degree, and where the path starts.
#[derive(Debug)]
pub(crate) struct Resolution {
    pub(crate) degree: usize,
    pub(crate) basis: Arc<Basis>,
    pub(crate) rest: Arc<Vec<RestShape>>,
    /// The state in which the load begins: rest, or the end of the load before.
    pub(crate) initial: Vec<f64>,
}

impl Resolution {
    /// For a load that begins at rest.
    pub(crate) fn new(model: &Model, degree: usize) -> Self {
        let basis = Basis::new(degree);
        let rest = model.beams.iter().map(|b| RestShape::new(&basis, &b.info)).collect();
        let initial = vec![0.0; model.unknowns + model.beams.len() * basis.bubbles];
        Self { degree, basis: Arc::new(basis), rest: Arc::new(rest), initial }
    }

    /// For a load that begins in another state.
    pub(crate) fn starting_at(&self, initial: Vec<f64>) -> Self {
        Self { degree: self.degree, basis: Arc::clone(&self.basis), rest: Arc::clone(&self.rest), initial }
    }

    /// The part of a state that belongs to one piece.
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
            change: vec![0.0; resolution.initial.len()],
            evaluations: 0,
            factorisations: 0,
        }
    }

    /// Evaluates and factors the equations at state `x` and dimensionless control.
    ///
    /// # Errors
    /// [`Singular`] if the tangent, or that of the bubbles of a beam, has no inverse.
    pub(crate) fn linearise(&mut self, x: &[f64], control: f64) -> Result<(), Singular> {
        self.evaluate(x, control)?;
        self.factorisations += 1;
        self.lu.factor(self.model.solved, self.model.unknowns, &self.matrix)
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
        for (place, force) in &model.dead {
            self.residual[*place] -= force;
        }
        for (place, factor) in &model.pull {
            self.residual[*place] -= control * factor;
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
        for (end, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let freedom = &model.nodes[beam.nodes[end]];
            for (place, direction) in &freedom.translations {
                for (axis, component) in direction.iter().enumerate() {
                    let (force, factor) = (beam.force + axis, sign * component);
                    self.residual[*place] += factor * x[force];
                    self.residual[force] += factor * x[*place];
                    self.matrix[place * m + force] += factor;
                    self.matrix[force * m + place] += factor;
                }
            }
            let arm = beam.arms[end];
            if let Some(turn) = freedom.rotation.filter(|_| !is_zero(arm)) {
                self.scatter_arm(arm, sign, turn, beam.force, x);
            }
        }
    }

    /// The part of F·u of an end that moves with an arm: ±F·(R(φ) − 1) a.
    fn scatter_arm(&mut self, arm: [f64; 2], sign: f64, turn: usize, force: usize, x: &[f64]) {
        let m = self.model.unknowns;
        let moved = swing(arm, x[turn]);
        let [x0, y0] = [arm[0] + moved[0], arm[1] + moved[1]];
        // First derivative by φ: the turned arm's quarter turn; second: minus the turned arm.
        for (axis, slope) in [-y0, x0].into_iter().enumerate() {
            self.residual[force + axis] += sign * moved[axis];
            self.residual[turn] += sign * x[force + axis] * slope;
            self.matrix[turn * m + force + axis] += sign * slope;
            self.matrix[(force + axis) * m + turn] += sign * slope;
        }
        self.matrix[turn * m + turn] -= sign * (x[force] * x0 + x[force + 1] * y0);
    }

    /// Newton step at the linearised state, into [`System::change`].
    pub(crate) fn newton_step(&mut self) {
        let n = self.model.solved;
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
        let (n, m) = (self.model.solved, self.model.unknowns);
        self.change.fill(0.0);
        self.rhs[..n].fill(0.0);
        if self.model.kinematic {
            let (driven, p) = (self.model.driven(), self.model.projection);
            for row in 0..n {
                self.rhs[row] = -self.matrix[row * m + driven] / p;
            }
            self.change[driven] = 1.0 / p;
        }
        for (place, factor) in self.model.pull.iter().filter(|(place, _)| *place < n) {
            self.rhs[*place] = *factor;
        }
        self.lu.solve(&mut self.rhs[..n]);
        self.change[..n].copy_from_slice(&self.rhs[..n]);
        self.expand(0.0);
    }

    /// Replaces a right-hand side of the length of a state by the solution of the linearised equations, bubbles included. Unknowns
    /// that are not solved for are held: their equations are left out and their solution is 0. Returns, for each of these, the derivative
    /// by its value of what the right-hand side stands for.
    pub(crate) fn solve_state(&mut self, rhs: &mut [f64]) -> Vec<f64> {
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
        let n = self.model.solved;
        self.lu.solve(&mut unknowns[..n]);
        let m = self.model.unknowns;
        let held = (n..m).map(|row| {
            let answered: f64 = self.matrix[row * m..row * m + n].iter().zip(&unknowns[..n]).map(|(a, b)| a * b).sum();
            unknowns[row] - answered
        });
        let held = held.collect();
        unknowns[n..].fill(0.0);
        self.change.fill(0.0);
        self.change[..n].copy_from_slice(&unknowns[..n]);
        self.expand(0.0);
        for (x, change) in inner.iter_mut().zip(&self.change[self.model.unknowns..]) {
            *x += change;
        }
        held
    }

    /// Products of the rows that are not solved for with a change whose bubbles follow.
    pub(crate) fn rows_beyond(&self, change: &[f64]) -> Vec<f64> {
        (self.model.solved..self.model.unknowns).map(|row| self.row(row, change)).collect()
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

    /// Dimensionless force that holds an unknown which is not solved for, at the linearised state moved by [`System::change`]: right
    /// to second order.
    pub(crate) fn holding(&self, place: usize) -> f64 {
        self.residual[place] + self.row(place, &self.change)
    }

    /// Dimensionless stiffness dF/dΔ from the tangent.
    pub(crate) fn stiffness(&self, tangent: &[f64]) -> f64 {
        if self.model.kinematic {
            self.row(self.model.driven(), tangent) / self.model.projection
        } else {
            1.0 / self.model.along_drive(tangent)
        }
    }

    fn row(&self, place: usize, change: &[f64]) -> f64 {
        let m = self.model.unknowns;
        self.matrix[place * m..(place + 1) * m].iter().zip(change).map(|(a, b)| a * b).sum()
    }

    /// After a singular factorisation: a combination of unknowns without any effect.
    pub(crate) fn null_vector(&self, singular: Singular) -> Vec<f64> {
        self.lu.null_vector(singular.column)
    }
}
