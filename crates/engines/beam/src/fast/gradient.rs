//! The gradient of the force from the states of a walk.
//!
//! F = dW/dΔ, so dF/dp is the derivative of ∂ℒ/∂p along the path (see `gradient.rs` of the general path). Both are known at each state
//! of the walk without solving for anything: the second is a contraction of the state with its tangent. Between the states, ∂ℒ/∂p is
//! interpolated by values and slopes and differentiated.

use super::hermite::Hermite;
use super::kernel::{Beams, Contraction, Tables, Unknowns};
use super::lanes::{LANES, Lane};
use super::walk::Task;
use crate::gradient::Parameter;
use crate::section::Section;

/// What a parameter changes in one beam: a place in [`Contraction`], and by how much.
#[derive(Clone, Copy, Debug)]
struct Entry {
    column: usize,
    lane: usize,
    quantity: Quantity,
    factor: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Quantity {
    Length,
    Bending,
    Axial,
    Shear,
    Angle(usize),
}

/// ∂ℒ/∂p and its derivative by the control at the states of a walk.
#[derive(Debug, Default)]
pub(super) struct ForceGradient {
    parameters: Vec<Parameter>,
    /// Per group of beams.
    entries: Vec<Vec<Entry>>,
    coefficients: Vec<usize>,
    contraction: Contraction,
    /// Row per state: values, then slopes.
    rows: Vec<f64>,
}

/// How `c_0` and the logarithm of the length follow from chord and bend; see `ChordSensitivity`.
pub(super) struct Closure {
    angle_by_chord: [f64; 2],
    stretch_by_chord: [f64; 2],
    /// ∫ uᵏ (cos η, sin η) du.
    moments: Vec<[f64; 2]>,
}

impl Closure {
    pub(super) fn new<const M: usize, const Q: usize, const E: usize>(
        tables: &Tables<M, Q, E>,
        beams: &Beams<Q>,
        lane: usize,
        coefficients: usize,
        length_m: f64,
    ) -> Self {
        let mut moments = vec![[0.0; 2]; coefficients];
        for q in 0..Q {
            let mut factor = tables.weight[q];
            for sum in &mut moments {
                sum[0] += factor * beams.cos[q].0[lane];
                sum[1] += factor * beams.sin[q].0[lane];
                factor *= tables.u[q];
            }
        }
        let [x, y] = moments[0];
        let scale = 1.0 / ((x * x + y * y) * length_m);
        Self { angle_by_chord: [-y * scale, x * scale], stretch_by_chord: [x * scale, y * scale], moments }
    }

    /// Change of `c_0` and of the logarithm of the length by the coefficient `c_k`.
    fn by_bend(&self, k: usize) -> [f64; 2] {
        let ([x, y], [a, b]) = (self.moments[0], self.moments[k]);
        let square = x * x + y * y;
        [-(x * a + y * b) / square, (x * b - y * a) / square]
    }
}

impl ForceGradient {
    /// Starts anew for a list of parameters.
    pub(super) fn set(&mut self, parameters: &[Parameter]) {
        self.parameters.clear();
        self.parameters.extend_from_slice(parameters);
    }

    /// What each parameter changes, in N per SI unit of the parameter. What does not exist changes nothing.
    pub(super) fn prepare<const M: usize, const Q: usize, const E: usize>(
        &mut self,
        task: &Task,
        tables: &Tables<M, Q, E>,
        beams: &[Beams<Q>],
    ) {
        self.entries.resize_with(beams.len(), Vec::new);
        self.coefficients.clear();
        for (g, four) in task.model.beams.chunks(LANES).enumerate() {
            self.entries[g].clear();
            self.coefficients.push(four.iter().map(|b| b.info.shape.angle_rad().len()).max().unwrap_or(0));
            for (lane, beam) in four.iter().enumerate() {
                let shape = &beam.info.shape;
                let count = shape.angle_rad().len();
                let closure = Closure::new(tables, &beams[g], lane, count, shape.length_m());
                let section = beam.info.section;
                let index = g * LANES + lane;
                let unit = task.model.force_n;
                for (column, parameter) in self.parameters.iter().enumerate() {
                    let mut add = |quantity: Quantity, factor: f64| {
                        if factor != 0.0 {
                            self.entries[g].push(Entry { column, lane, quantity, factor: unit * factor });
                        }
                    };
                    if !of_section(*parameter, index, &section, &mut add) {
                        of_shape(*parameter, index, &beam.nodes, &closure, &mut add);
                    }
                }
            }
        }
    }

    /// Makes room for some states.
    pub(super) fn start(&mut self, states: usize) {
        self.rows.clear();
        self.rows.resize(2 * states * self.parameters.len(), 0.0);
    }

    /// Adds a group of beams to the row of a state, given its tangent.
    pub(super) fn add<const M: usize, const Q: usize, const E: usize>(
        &mut self,
        state: usize,
        group: usize,
        tables: &Tables<M, Q, E>,
        beams: &Beams<Q>,
        change: (&Unknowns<M>, &Unknowns<M>),
    ) {
        self.contraction.contract(tables, beams, change, self.coefficients[group]);
        let count = self.parameters.len();
        let (values, slopes) = self.rows[2 * state * count..2 * (state + 1) * count].split_at_mut(count);
        let c = &self.contraction;
        for entry in &self.entries[group] {
            let [value, slope]: &[Lane; 2] = match entry.quantity {
                Quantity::Length => &c.length,
                Quantity::Bending => &c.bending,
                Quantity::Axial => &c.axial,
                Quantity::Shear => &c.shear,
                Quantity::Angle(k) => &c.angles[k],
            };
            values[entry.column] += entry.factor * value.0[entry.lane];
            slopes[entry.column] += entry.factor * slope.0[entry.lane];
        }
    }

    /// The gradient at the stations, a row each.
    pub(super) fn emit(&self, task: &Task, controls: &[f64], hermite: &mut Hermite, out: &mut Vec<f64>) {
        let count = self.parameters.len();
        out.clear();
        out.resize(count * task.stations_m.len(), 0.0);
        hermite.reset(task.tight());
        let mut interval = 0;
        for (station, row) in task.stations_m.iter().zip(out.chunks_exact_mut(count.max(1))) {
            let at = station / task.model.length_m;
            while interval + 2 < controls.len() && controls[interval + 1] < at {
                interval += 1;
            }
            hermite.around(controls, interval, task.states());
            hermite.place(at);
            for ((i, own), by) in hermite.weights().zip(hermite.slope) {
                // The slope of the interpolation, or where it knows no slopes, these interpolated.
                let [by_value, by_slope] = if task.tight() { [0.0, own[0]] } else { by };
                let (values, slopes) = self.rows[2 * i * count..2 * (i + 1) * count].split_at(count);
                for (sum, (value, slope)) in row.iter_mut().zip(values.iter().zip(slopes)) {
                    *sum += by_value * value + by_slope * slope;
                }
            }
        }
    }

    /// Room of all buffers.
    pub(super) fn room(&self) -> usize {
        self.rows.capacity() + self.entries.iter().map(Vec::capacity).sum::<usize>() + self.coefficients.capacity()
    }
}

/// What a parameter of the section changes in beam `index`; `false` if it is none. EI ∝ E w³ b, 1/EA ∝ 1/(E w b),
/// 1/kGA ∝ (1 + ν)/(E w b).
pub(super) fn of_section(parameter: Parameter, index: usize, section: &Section, add: &mut dyn FnMut(Quantity, f64)) -> bool {
    let (of, bending, value) = match parameter {
        Parameter::Thickness(beam) => (Some(beam), 3.0, section.thickness_m),
        Parameter::AllThickness => (None, 3.0, section.thickness_m),
        Parameter::Depth(beam) => (Some(beam), 1.0, section.depth_m),
        Parameter::AllDepth => (None, 1.0, section.depth_m),
        Parameter::Young(beam) => (Some(beam), 1.0, section.young_pa),
        Parameter::AllYoung => (None, 1.0, section.young_pa),
        Parameter::Poisson(beam) => (Some(beam), 0.0, 0.0),
        Parameter::AllPoisson => (None, 0.0, 0.0),
        _ => return false,
    };
    if of.is_some_and(|beam| beam != index) {
        return true;
    }
    if matches!(parameter, Parameter::Poisson(_) | Parameter::AllPoisson) {
        add(Quantity::Shear, section.poisson.map_or(0.0, |nu| 1.0 / (1.0 + nu)));
    } else {
        add(Quantity::Bending, bending / value);
        add(Quantity::Axial, -1.0 / value);
        add(Quantity::Shear, -1.0 / value);
    }
    true
}

/// What a node or a bend changes in beam `index`, which stays closed.
pub(super) fn of_shape(parameter: Parameter, index: usize, nodes: &[usize; 2], closure: &Closure, add: &mut dyn FnMut(Quantity, f64)) {
    // EI/L is the one constant that changes with the length.
    let closed = |add: &mut dyn FnMut(Quantity, f64), angle: f64, stretch: f64| {
        add(Quantity::Angle(0), angle);
        add(Quantity::Length, stretch);
        add(Quantity::Bending, -stretch);
    };
    match parameter {
        Parameter::Bend { beam, k } if beam == index && (1..closure.moments.len()).contains(&k) => {
            let [angle, stretch] = closure.by_bend(k);
            add(Quantity::Angle(k), 1.0);
            closed(add, angle, stretch);
        }
        Parameter::NodeX(node) | Parameter::NodeY(node) => {
            let axis = usize::from(matches!(parameter, Parameter::NodeY(_)));
            for (own, sign) in nodes.iter().zip([-1.0, 1.0]) {
                if *own == node {
                    closed(add, sign * closure.angle_by_chord[axis], sign * closure.stretch_by_chord[axis]);
                }
            }
        }
        _ => {}
    }
}
