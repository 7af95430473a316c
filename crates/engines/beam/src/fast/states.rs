//! Converged states of a walk at given displacements, with their derivatives by parameters of the design and by the displacement.
//!
//! A state is predicted by the states of the walk and solved for. With its tangent H, derivatives of the whole state follow from one
//! right-hand side per parameter, `H dx/dp = −∂²ℒ/∂x∂p`, condensed beam by beam as the equations are. After that, any number of outputs
//! cost a product of two short rows per parameter.

use forcewright_base::dense::Lu;

use super::gradient::{Closure, Quantity, of_section, of_shape};
use super::kernel::Unknowns;
use super::lanes::{LANES, Lane};
use super::line::{BeamAt, DEPTH, ENDS, FIRST_MODE, FORCE, START, THICKNESS, fill_rule, fill_samples};
use super::mixed::{ANGLES, AXIAL, Answer, BENDING, Curvature, Field, LENGTH, SHEAR, dot, sum_of};
use super::walk::{GiveUp, Task, Walker};
use crate::counters::Counters;
use crate::gradient::Parameter;
use crate::section::Section;

/// Largest distance of a prediction of a state from it, rad: the walk knows better.
const LARGEST_CORRECTION: f64 = 0.02;
/// Largest distance of the tangent's state from the state per accuracy asked for: derivatives are wrong by some ten times it.
const TANGENT: f64 = 0.25;
/// The same for tight accuracies.
const TANGENT_TIGHT: f64 = 0.05;
/// Distances below this are rounding.
const ROUNDING: f64 = 1e-11;
const MOST_ITERATIONS: usize = 6;

/// What the parameters change in each beam.
#[derive(Clone, Debug, Default)]
struct Constants {
    /// Per group of beams: the number of constants, and a row of them per parameter and for the displacement, which changes none.
    groups: Vec<(usize, Vec<Lane>)>,
}

/// States at displacements asked for. Their buffers are used again.
#[derive(Debug, Default)]
pub(super) struct FastStates {
    pub(super) parameters: Vec<Parameter>,
    /// Those solved for come first.
    pub(super) states: Vec<FastState>,
    pub(super) count: usize,
    /// A rule on [0, 1], and places to look for the largest stress.
    pub(super) rule: Vec<[Lane; 2]>,
    pub(super) samples: Vec<f64>,
    constants: Constants,
    work: Work,
}

#[derive(Debug, Default)]
struct Work {
    lu: Lu,
    matrix: Vec<f64>,
    /// Derivatives of the network's unknowns: a row per unknown, a column per parameter.
    columns: Vec<f64>,
    column: Vec<f64>,
}

/// One state. Derivatives are by the parameters, then by the displacement.
#[derive(Clone, Debug, Default)]
pub(super) struct FastState {
    pub(super) displacement_m: f64,
    pub(super) force_n: f64,
    pub(super) stiffness_n_per_m: f64,
    pub(super) force_by: Vec<f64>,
    pub(super) stiffness_by: Vec<f64>,
    pub(super) beams: Vec<BeamAt>,
    /// Displacement in m and rotation of each node.
    pub(super) nodes: Vec<[f64; 3]>,
    /// A row of derivatives per node.
    pub(super) nodes_by: Vec<[f64; 3]>,
}

/// What a parameter changes in beam `index` beside its constants: the logarithms of thickness and depth, and the place of its start.
fn directly(parameter: Parameter, index: usize, start: usize, section: &Section) -> [f64; 4] {
    match parameter {
        Parameter::AllThickness => [1.0 / section.thickness_m, 0.0, 0.0, 0.0],
        Parameter::Thickness(beam) if beam == index => [1.0 / section.thickness_m, 0.0, 0.0, 0.0],
        Parameter::AllDepth => [0.0, 1.0 / section.depth_m, 0.0, 0.0],
        Parameter::Depth(beam) if beam == index => [0.0, 1.0 / section.depth_m, 0.0, 0.0],
        Parameter::NodeX(node) if node == start => [0.0, 0.0, 1.0, 0.0],
        Parameter::NodeY(node) if node == start => [0.0, 0.0, 0.0, 1.0],
        _ => [0.0; 4],
    }
}

impl Constants {
    fn prepare<const M: usize, const Q: usize, const E: usize>(&mut self, task: &Task, walker: &Walker<M, Q, E>, parameters: &[Parameter]) {
        self.groups.resize_with(walker.beams.len(), Default::default);
        for (g, four) in task.model.beams.chunks(LANES).enumerate() {
            let coefficients = four.iter().map(|b| b.info.shape.angle_rad().len()).max().unwrap_or(0);
            let (width, rows) = &mut self.groups[g];
            *width = ANGLES + coefficients;
            rows.clear();
            rows.resize(*width * (parameters.len() + 1), Lane::ZERO);
            for (lane, beam) in four.iter().enumerate() {
                let shape = &beam.info.shape;
                let closure = Closure::new(&walker.tables, &walker.beams[g], lane, shape.angle_rad().len(), shape.length_m());
                for (parameter, row) in parameters.iter().zip(rows.chunks_exact_mut(*width)) {
                    let mut add = |quantity: Quantity, factor: f64| {
                        let place = match quantity {
                            Quantity::Length => LENGTH,
                            Quantity::Bending => BENDING,
                            Quantity::Axial => AXIAL,
                            Quantity::Shear => SHEAR,
                            Quantity::Angle(k) => ANGLES + k,
                        };
                        row[place].0[lane] += factor;
                    };
                    let index = g * LANES + lane;
                    if !of_section(*parameter, index, &beam.info.section, &mut add) {
                        of_shape(*parameter, index, &beam.nodes, &closure, &mut add);
                    }
                }
            }
        }
    }

    /// What a column changes in a group.
    fn row(&self, group: usize, column: usize) -> &[Lane] {
        let (width, rows) = &self.groups[group];
        &rows[column * width..(column + 1) * width]
    }
}

/// A group of beams at a state, on the way to its derivatives.
struct GroupAt<const M: usize, const Q: usize> {
    field: Field<Q>,
    curvature: Curvature<M>,
    /// Per parameter.
    answers: Vec<Answer<M>>,
}

impl<const M: usize, const Q: usize, const E: usize> Walker<M, Q, E> {
    /// States at some displacements up to the last station, after the walk of the same task. `finer` solves for them if it is there; it
    /// has checked the resolution of the walk before.
    pub(super) fn solve_states<const N: usize, const R: usize, const D: usize>(
        &mut self,
        task: &Task,
        at_m: &[f64],
        (counters, out): (&mut Counters, &mut FastStates),
        mut finer: Option<&mut Walker<N, R, D>>,
    ) -> Result<(), GiveUp> {
        match &finer {
            Some(finer) => out.prepare(task, finer),
            None => out.prepare(task, self),
        }
        out.states.resize_with(out.states.len().max(at_m.len()), FastState::default);
        out.count = at_m.len();
        for (number, at_m) in at_m.iter().enumerate() {
            let at = at_m / task.model.length_m;
            let after = self.controls.partition_point(|c| *c < at);
            self.hermite.reset(task.tight());
            self.hermite.around(&self.controls, after.saturating_sub(1), task.states());
            self.interpolate(at, task.model.projection);
            out.states[number].displacement_m = *at_m;
            let Some(finer) = finer.as_deref_mut() else {
                self.solve_state(task, counters, (out, number))?;
                continue;
            };
            // The network is the same at every degree.
            std::mem::swap(&mut self.net, &mut finer.net);
            finer.x.clone_from(&self.x);
            finer.inner.clear();
            finer.inner.extend(self.inner.iter().map(widened));
            let solved = finer.solve_state(task, counters, (out, number));
            std::mem::swap(&mut self.net, &mut finer.net);
            solved?;
        }
        Ok(())
    }

    /// Solves for a state near the current one and differentiates it.
    fn solve_state(&mut self, task: &Task, counters: &mut Counters, (out, number): (&mut FastStates, usize)) -> Result<(), GiveUp> {
        let tangent = if task.tight() { TANGENT_TIGHT } else { TANGENT };
        let accepted = (tangent * task.accuracy).max(ROUNDING);
        for _ in 0..MOST_ITERATIONS {
            self.iterate(counters)?;
            let distance = self.size(&self.net.change, 1.0);
            if distance > LARGEST_CORRECTION || distance.is_nan() {
                break;
            }
            if distance <= accepted {
                return self.differentiate(task, (&out.parameters, &out.constants), &mut out.work, &mut out.states[number]);
            }
        }
        Err(GiveUp::Unsafe)
    }

    /// Derivatives at the state that was solved for, with the tangent of the last iteration.
    fn differentiate(
        &mut self,
        task: &Task,
        (parameters, constants): (&[Parameter], &Constants),
        work: &mut Work,
        out: &mut FastState,
    ) -> Result<(), GiveUp> {
        let (model, count) = (task.model, parameters.len());
        let stiffness_unit = model.force_n / model.length_m;
        out.force_n = self.net.reaction / model.projection * model.force_n;
        out.stiffness_n_per_m = self.net.slope / (model.projection * model.projection) * stiffness_unit;
        for tangent in &mut self.net.tangent {
            *tangent /= model.projection;
        }
        let free = self.net.unknowns - 1;
        work.columns.clear();
        work.columns.resize((free + 1) * count, 0.0);
        out.force_by.clear();
        out.force_by.resize(count, 0.0);
        let groups = self.answers(constants, &mut work.columns, &mut out.force_by);
        for by in &mut out.force_by {
            *by *= model.force_n;
        }
        out.force_by.push(out.stiffness_n_per_m);
        self.net.free_matrix(&mut work.matrix);
        work.lu.factor(free, free, &work.matrix).map_err(|_| GiveUp::Unsafe)?;
        work.lu.solve_columns(&mut work.columns[..free * count], count);
        self.place(task, &groups, out);
        out.stiffness_by.clear();
        for column in 0..=count {
            work.column.clear();
            if column == count {
                work.column.extend(self.net.tangent.iter().map(|t| t / model.length_m));
            } else {
                work.column.extend((0..free).map(|row| -work.columns[row * count + column]));
                // The displacement is held.
                work.column.push(0.0);
            }
            let mut stiffness_by = 0.0;
            self.differentiate_nodes(task, (column, count), &work.column, out);
            for (g, group) in groups.iter().enumerate() {
                let (ends, apart) = self.net.ends(g, &work.column);
                let change = self.condensed[g].expand_answer(group.answers.get(column).unwrap_or(&Answer::NONE), ends, apart);
                stiffness_by += group.curvature.along(&change, constants.row(g, column));
                let constants = constants.row(g, column);
                self.differentiate_beams(task, (g, group), (column, parameters), (&change, constants), out);
            }
            out.stiffness_by.push(stiffness_by * stiffness_unit);
        }
        Ok(())
    }

    /// All groups at the state, with their answers to the parameters, whose residuals at the ends are added to the columns, and the
    /// derivatives of the force.
    fn answers(&mut self, constants: &Constants, columns: &mut [f64], force_by: &mut [f64]) -> Vec<GroupAt<M, Q>> {
        let mut groups = Vec::with_capacity(self.beams.len());
        let (mut mixed, mut each, mut along) = (Vec::new(), Vec::new(), Vec::new());
        let count = force_by.len();
        self.net.clear();
        for (g, (beams, condensed)) in self.beams.iter().zip(&self.condensed).enumerate() {
            self.net.add(g, condensed);
            let coefficients = constants.groups[g].0 - ANGLES;
            let (ends, apart) = self.net.ends(g, &self.net.tangent);
            let tangent = condensed.expand(ends, apart, 0.0);
            let field = Field::new(&self.tables, beams, &self.inner[g]);
            let curvature = field.curvature(&self.tables, beams, &tangent, coefficients);
            field.mixed(&self.tables, beams, &self.inner[g], (coefficients, &mut mixed));
            each.clear();
            each.extend(mixed.iter().map(|residual| condensed.answer(residual)));
            along.clear();
            along.extend(mixed.iter().map(|residual| dot(residual, &tangent)));
            let mut answers = vec![Answer::NONE; count];
            for (column, (sum, force_by)) in answers.iter_mut().zip(force_by.iter_mut()).enumerate() {
                for ((answer, along), factor) in each.iter().zip(&along).zip(constants.row(g, column)) {
                    // Most parameters change few constants.
                    if *factor != Lane::ZERO {
                        sum.add(answer, *factor);
                        *force_by += sum_of(*along * *factor);
                    }
                }
                self.net.scatter(g, &sum.first, columns, (column, count));
            }
            groups.push(GroupAt { field, curvature, answers });
        }
        groups
    }

    /// Nodes and beams of a state.
    fn place(&self, task: &Task, groups: &[GroupAt<M, Q>], out: &mut FastState) {
        let model = task.model;
        out.nodes.clear();
        for node in model.nodes.iter().take(model.drawn_nodes) {
            let [x, y] = self.net.displacement(&node.translations, &self.x);
            out.nodes.push([x * model.length_m, y * model.length_m, self.net.rotation(node.rotation, &self.x)]);
        }
        out.nodes_by.clear();
        out.beams.resize_with(model.beams.len(), BeamAt::default);
        for (index, (beam, at)) in model.beams.iter().zip(&mut out.beams).enumerate() {
            let (g, lane) = (index / LANES, index % LANES);
            let (inner, section, shape) = (&self.inner[g], &beam.info.section, &beam.info.shape);
            at.ends = inner.ends.map(|v| v.0[lane]);
            at.force = inner.force.map(|v| v.0[lane]);
            let ([x, y, _], rest) = (out.nodes[beam.nodes[0]], task.network.nodes[beam.nodes[0]].position_m);
            at.start_m = [rest[0] + x, rest[1] + y];
            let beyond = self.tables.beyond(self.beams[g].bending, &groups[g].field.load);
            at.modes.clear();
            at.modes.extend(inner.bubbles.iter().chain(&beyond).map(|v| v.0[lane]));
            at.angle.clear();
            at.angle.extend_from_slice(shape.angle_rad());
            (at.length_m, at.thickness_m) = (shape.length_m(), section.thickness_m);
            at.soft = [beam.constants.axial, beam.constants.shear];
            let stretches = beam.constants.axial > 0.0;
            let bending = 0.5 * section.young_pa * section.thickness_m / at.length_m;
            at.stress = [bending, if stretches { model.force_n / section.area_m2() } else { 0.0 }];
            at.rows.clear();
        }
    }

    /// One column of the derivatives of the nodes.
    fn differentiate_nodes(&self, task: &Task, (column, count): (usize, usize), change: &[f64], out: &mut FastState) {
        let model = task.model;
        out.nodes_by.resize(model.drawn_nodes * (count + 1), [0.0; 3]);
        for (index, node) in model.nodes.iter().take(model.drawn_nodes).enumerate() {
            let [x, y] = self.net.displacement(&node.translations, change);
            out.nodes_by[index * (count + 1) + column] = [x * model.length_m, y * model.length_m, self.net.rotation(node.rotation, change)];
        }
    }

    /// One row of the derivatives of the coordinates of a group of beams.
    fn differentiate_beams(
        &self,
        task: &Task,
        (g, group): (usize, &GroupAt<M, Q>),
        (column, parameters): (usize, &[Parameter]),
        (change, constants): (&Unknowns<M>, &[Lane]),
        out: &mut FastState,
    ) {
        let beams = &self.beams[g];
        let load = group.field.load_change(&self.tables, beams, change, constants);
        let beyond = self.tables.beyond(beams.bending, &load);
        let four = task.model.beams.iter().enumerate().skip(g * LANES).take(LANES);
        for (lane, ((index, beam), at)) in four.zip(&mut out.beams[g * LANES..]).enumerate() {
            let (first, width) = (at.rows.len(), at.width());
            at.rows.resize(first + width, 0.0);
            let row = &mut at.rows[first..];
            for i in 0..2 {
                row[ENDS + i] = change.ends[i].0[lane];
                row[FORCE + i] = change.force[i].0[lane];
            }
            let node = out.nodes_by[beam.nodes[0] * (parameters.len() + 1) + column];
            let parameter = parameters.get(column);
            let [thickness, depth, x, y] = parameter.map_or([0.0; 4], |p| directly(*p, index, beam.nodes[0], &beam.info.section));
            (row[THICKNESS], row[DEPTH]) = (thickness, depth);
            (row[START], row[START + 1]) = (node[0] + x, node[1] + y);
            let (modes, own) = row[FIRST_MODE..].split_at_mut(M + E);
            for (target, value) in modes.iter_mut().zip(change.bubbles.iter().chain(&beyond)) {
                *target = value.0[lane];
            }
            // The modes beyond are the load over the stiffness.
            for (target, mode) in modes[M..].iter_mut().zip(&at.modes[M..]) {
                *target -= constants[BENDING].0[lane] * mode;
            }
            for (target, value) in own.iter_mut().zip(constants) {
                *target = value.0[lane];
            }
        }
    }
}

/// The same state with more bubbles.
fn widened<const M: usize, const N: usize>(at: &Unknowns<M>) -> Unknowns<N> {
    let mut wide = Unknowns { ends: at.ends, force: at.force, bubbles: [Lane::ZERO; N] };
    for (target, value) in wide.bubbles.iter_mut().zip(&at.bubbles) {
        *target = *value;
    }
    wide
}

impl FastStates {
    /// Starts anew for a list of parameters.
    pub(super) fn set(&mut self, parameters: &[Parameter]) {
        self.parameters.clear();
        self.parameters.extend_from_slice(parameters);
        self.count = 0;
    }

    /// What does not depend on the state.
    fn prepare<const M: usize, const Q: usize, const E: usize>(&mut self, task: &Task, walker: &Walker<M, Q, E>) {
        self.constants.prepare(task, walker, &self.parameters);
        fill_rule(&walker.tables.u, &walker.tables.weight, &mut self.rule);
        fill_samples(M + E, &mut self.samples);
    }
}
