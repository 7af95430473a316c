//! Derivatives of the values of a solved design by the numbers of the search.

use forcewright_base::maths;
use forcewright_beam::{Axis, CurveStates, Derivatives, Network, Output as Asked};
use forcewright_study::evaluator::Failure;

use super::super::knobs::Knob;
use super::super::mass::drawn_mass_kg;
use super::places::Place;
use super::{Block, CELLS, Curve, Search, WINDOW};

/// Rows of the Jacobian under construction.
pub(super) struct Rows<'a, 's> {
    pub(super) search: &'a Search,
    pub(super) x: &'a [f64],
    pub(super) curve: Curve<'a>,
    pub(super) states: &'a mut CurveStates<'s>,
    pub(super) network: &'a Network,
    pub(super) derivatives: &'a mut Derivatives,
}

impl Rows<'_, '_> {
    /// Writes the derivatives of a value into its row of zeros.
    pub(super) fn fill(&mut self, place: &Place, row: &mut [f64]) -> Result<(), Failure> {
        let knobs = &self.search.knobs;
        match *place {
            Place::Slope(i) => {
                let nodes: Vec<f64> = (0..=CELLS).map(|i| self.search.step_m(i)).collect();
                for (node, [_, slope]) in stencil::<6>(&nodes, nodes[i]) {
                    self.add_force(nodes[node], slope, row);
                }
            }
            Place::Window(window, at, end) => self.window(window, at, end, row),
            Place::WindowLength(window) => {
                for (index, factor) in [(0, -1.0), (WINDOW - 1, 1.0)] {
                    let [start, end] = self.search.place_in_window(self.x, window, index).1;
                    for (column, by) in [start, end].into_iter().filter_map(|(c, by)| Some((c?, by))) {
                        row[column] += factor * by;
                    }
                }
            }
            Place::Force(at) => self.add_force(at, 1.0, row),
            Place::ForceRatio([a, b]) => {
                let [upper, lower] = [a, b].map(|at| self.curve.index(at).map_or(0.0, |i| self.curve.response.force_n[i]));
                let lower_all = lower * self.search.copies;
                self.add_force(a, 1.0 / lower_all, row);
                self.add_force(b, -upper / (lower * lower_all), row);
            }
            Place::Stress { state, beam, u, face } => {
                let by = self.ask(state, Asked::Stress { beam, u, face })?;
                knobs.add_row(by, 1.0, row);
            }
            Place::Wall { state, beam, u, axis, sign } => {
                let by = self.ask(state, Asked::Position { beam, u, axis: if axis == 0 { Axis::X } else { Axis::Y } })?;
                knobs.add_row(by, sign, row);
                knobs.add_half_thickness(beam, &self.network.beams[beam], u, row);
            }
            Place::Mirror { state, beam, u, axis, sign } => {
                let by = self.ask(state, Asked::Position { beam, u, axis: if axis == 0 { Axis::X } else { Axis::Y } })?;
                knobs.add_row(by, 2.0 * sign, row);
                (0..2).for_each(|_| knobs.add_half_thickness(beam, &self.network.beams[beam], u, row));
            }
            Place::Gap { state, ends: [first, second], crossed } => {
                let by = self.ask(state, Asked::Gap { first, second, reflection: None })?;
                knobs.add_row(by, if crossed { -1.0 } else { 1.0 }, row);
                if crossed {
                    // The engine's distance is less half of both thicknesses too: once undone, once taken off.
                    for (beam, u) in [first, second] {
                        let own = &self.network.beams[beam];
                        (0..2).for_each(|_| knobs.add_half_thickness(beam, own, u, row));
                    }
                }
            }
            Place::LengthRatio(beam) => self.length_ratio(beam, row),
            Place::Mass => {
                let densities = self.search.blocks.iter().find_map(|b| if let Block::Mass(densities) = b { Some(densities) } else { None });
                drawn_mass_kg(self.network, densities.map_or(&[][..], |d| d), knobs, self.search.copies, row);
            }
        }
        Ok(())
    }

    /// Derivatives of an output at a state by the engine's parameters.
    fn ask(&mut self, state: usize, asked: Asked) -> Result<&[f64], Failure> {
        self.states.derivatives(state, &[asked], self.derivatives).map_err(|e| Failure { reason: e.to_string() })?;
        Ok(&self.derivatives.by_parameter)
    }

    /// Adds a factor times the derivatives of the force at a displacement that stays.
    fn add_force(&self, at_m: f64, factor: f64, row: &mut [f64]) {
        let Some(index) = self.curve.index(at_m) else { return };
        let count = self.search.knobs.parameters.len();
        let own = &self.curve.response.force_gradient[index * count..(index + 1) * count];
        self.search.knobs.add_row(own, factor * self.search.copies, row);
    }

    /// The force at a place of a window, which may be a node that moves with it.
    fn window(&self, window: usize, at: f64, end: Option<usize>, row: &mut [f64]) {
        let nodes: Vec<f64> = (0..WINDOW).map(|i| self.search.place_in_window(self.x, window, i).0).collect();
        for (node, [weight, _]) in stencil::<4>(&nodes, at) {
            self.add_force(nodes[node], weight, row);
        }
        let Some(end) = end else { return };
        let slope = self.curve.index(nodes[end]).map_or(0.0, |i| self.search.copies * self.curve.response.stiffness_n_per_m[i]);
        for (column, by) in self.search.place_in_window(self.x, window, end).1.iter().filter_map(|(c, by)| Some(((*c)?, *by))) {
            row[column] += slope * by;
        }
    }

    fn length_ratio(&self, index: usize, row: &mut [f64]) {
        let shape = &self.network.beams[index].shape;
        let [x, y] = shape.chord_m();
        let chord_m = maths::hypot(x, y);
        let Ok(closure) = shape.chord_sensitivity() else { return };
        for (knob, out) in self.search.knobs.each.iter().zip(row) {
            // At a given bend the ratio does not depend on where the nodes are.
            if let Knob::Bend { beam, k } = knob
                && *beam == index
            {
                *out = closure.length_by_bend_m.get(k - 1).copied().unwrap_or(0.0) / chord_m;
            }
        }
    }
}

/// Weights of the values at the `N` nodes next to a place, for the value and for the slope there: the polynomial through them.
fn stencil<const N: usize>(nodes: &[f64], at: f64) -> impl Iterator<Item = (usize, [f64; 2])> {
    let after = nodes.partition_point(|n| *n <= at);
    let first = after.saturating_sub(N / 2).min(nodes.len().saturating_sub(N));
    let own = &nodes[first..(first + N).min(nodes.len())];
    (0..own.len()).map(move |i| {
        let others = || (0..own.len()).filter(move |j| *j != i);
        let factor = |j: usize| (at - own[j]) / (own[i] - own[j]);
        let weight = others().map(factor).product();
        let slope = others().map(|j| others().filter(|k| *k != j).map(factor).product::<f64>() / (own[i] - own[j])).sum();
        (first + i, [weight, slope])
    })
}
