//! Values of a solved design, and where each of them comes from.

use forcewright_base::maths;
use forcewright_beam::{CurveStates, Face, Network};
use forcewright_study::evaluator::Failure;

use super::super::line::{Line, NEAR_JOINT, Nearest, apart, closest};
use super::super::mass::drawn_mass_kg;
use super::{Block, CELLS, Curve, PLACES, STATES, Search, WINDOW, sides};
use crate::layout::Mirror;

/// Where a value comes from: what its derivatives are taken of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    /// The stiffness at a number of even steps.
    Slope(usize),
    /// The force at a place of a window, by its index, at a displacement, m, and the node of the window that it moves with.
    Window(usize, f64, Option<usize>),
    /// Of a window, by its index.
    WindowLength(usize),
    /// The force at a displacement, m.
    Force(f64),
    /// F(a)/F(b) − 1.
    ForceRatio([f64; 2]),
    Stress {
        state: usize,
        beam: usize,
        u: f64,
        face: Face,
    },
    /// The distance of a beam at `u` from a wall across an axis; `sign` is that of what is inside.
    Wall {
        state: usize,
        beam: usize,
        u: f64,
        axis: usize,
        sign: f64,
    },
    /// The distance of a beam at `u` from its mirror image across an axis; `sign` is that of its own side.
    Mirror {
        state: usize,
        beam: usize,
        u: f64,
        axis: usize,
        sign: f64,
    },
    /// The distance of two beams at places on them; less the distance where they have crossed.
    Gap {
        state: usize,
        ends: [(usize, f64); 2],
        crossed: bool,
    },
    LengthRatio(usize),
    Mass,
}

/// Values under construction.
pub(super) struct Filling<'a> {
    pub(super) search: &'a Search,
    pub(super) x: &'a [f64],
    pub(super) states: &'a CurveStates<'a>,
    pub(super) curve: Curve<'a>,
    /// The axes of the beams at the states, if they are looked at.
    pub(super) lines: Vec<Vec<Line>>,
    pub(super) network: &'a Network,
    pub(super) values: &'a mut Vec<f64>,
    pub(super) places: &'a mut Vec<Place>,
}

impl Filling<'_> {
    fn push(&mut self, value: f64, place: Place) {
        self.values.push(value);
        self.places.push(place);
    }

    /// Force of the whole layout at a displacement, N.
    fn force(&self, at_m: f64) -> f64 {
        self.curve.index(at_m).map_or(0.0, |i| self.search.copies * self.curve.response.force_n[i])
    }

    /// Its slope, N/m.
    fn slope(&self, at_m: f64) -> f64 {
        self.curve.index(at_m).map_or(0.0, |i| self.search.copies * self.curve.response.stiffness_n_per_m[i])
    }

    /// Adds the values of a block.
    pub(super) fn add(&mut self, block: &Block) -> Result<(), Failure> {
        match block {
            Block::Slopes => (1..=CELLS).for_each(|i| self.push(self.slope(self.search.step_m(i)), Place::Slope(i))),
            Block::Window(window) => self.window(*window),
            Block::WindowLength(window) => {
                let [from, to] = [0, WINDOW - 1].map(|i| self.search.place_in_window(self.x, *window, i).0);
                self.push(to - from, Place::WindowLength(*window));
            }
            Block::Forces(at) => at.iter().for_each(|at| self.push(self.force(*at), Place::Force(*at))),
            Block::ForceRatio([a, b]) => self.push(self.force(*a) / self.force(*b) - 1.0, Place::ForceRatio([*a, *b])),
            Block::Stress => self.stresses()?,
            Block::Envelope(envelope) => {
                for state in 0..=STATES.len() {
                    for side in sides(envelope) {
                        (0..self.network.beams.len()).for_each(|beam| self.wall((state, beam), side));
                    }
                }
            }
            Block::Clearance(pairs) => {
                for state in 0..=STATES.len() {
                    for pair in pairs {
                        self.gap(state, *pair);
                    }
                }
            }
            Block::Mirror(mirror) => {
                for state in 0..=STATES.len() {
                    (0..self.network.beams.len()).for_each(|beam| self.mirrored(state, beam, *mirror));
                }
            }
            Block::LengthRatio => {
                for (index, beam) in self.network.beams.iter().enumerate() {
                    let [x, y] = beam.shape.chord_m();
                    self.push(beam.shape.length_m() / maths::hypot(x, y), Place::LengthRatio(index));
                }
            }
            Block::Mass(densities) => {
                let mass_kg = drawn_mass_kg(self.network, densities, &self.search.knobs, 0.0, &mut []);
                self.push(self.search.copies * mass_kg, Place::Mass);
            }
        }
        Ok(())
    }

    /// Extremes of the force between the nodes of a window. Where one lies inside, its place does not matter to first order; at a node
    /// it moves with the window.
    fn window(&mut self, window: usize) {
        let nodes: Vec<f64> = (0..WINDOW).map(|i| self.search.place_in_window(self.x, window, i).0).collect();
        for (cell, ends) in nodes.windows(2).enumerate() {
            let width = ends[1] - ends[0];
            let (forces, rises) = ([0, 1].map(|i| self.force(ends[i])), [0, 1].map(|i| width * self.slope(ends[i])));
            for sign in [1.0, -1.0] {
                let (part, value) = extreme(forces, rises, sign);
                let end = if part <= 0.0 { Some(cell) } else { (part >= 1.0).then_some(cell + 1) };
                self.push(value, Place::Window(window, ends[0] + part * width, end));
            }
        }
    }

    /// Stresses at places that stay where they are: the largest of a beam has a kink wherever another place becomes the largest.
    fn stresses(&mut self) -> Result<(), Failure> {
        for state in 1..=STATES.len() {
            for beam in 0..self.network.beams.len() {
                for u in (0..=PLACES).map(|i| i as f64 / PLACES as f64) {
                    for face in self.search.faces() {
                        let value = self.states.stress_pa(state, beam, u, *face).map_err(|e| Failure { reason: e.to_string() })?;
                        self.push(value, Place::Stress { state, beam, u, face: *face });
                    }
                }
            }
        }
        Ok(())
    }

    /// Distance of a beam with its thickness to one side of the box: at the places that are looked at by themselves, and where it is least
    /// of the others.
    fn wall(&mut self, (state, beam): (usize, usize), (axis, sign, wall): (usize, f64, f64)) {
        let own = &self.network.beams[beam];
        let place = |i: usize| i as f64 / PLACES as f64;
        let still = |node: usize| 2 * usize::from(self.search.still[node][axis].at(state));
        let range = [place(still(own.start)), place(PLACES - still(own.end))];
        let line = &self.lines[state][beam];
        let least = line.nearest_to_wall((axis, sign), |u| 0.5 * own.thickness_at(u), range);
        for u in self.search.by_themselves(state, beam, axis).map(place).chain([least]) {
            self.values.push(sign * (line.at(u)[axis] - wall) - 0.5 * own.thickness_at(u));
            self.places.push(Place::Wall { state, beam, u, axis, sign });
        }
    }

    /// Distance of a beam from its mirror image: where it is least, but not next to a node on the line, in which they meet.
    fn mirrored(&mut self, state: usize, beam: usize, mirror: Mirror) {
        let (axis, line_m) = match mirror {
            Mirror::X(at) => (0, at),
            Mirror::Y(at) => (1, at),
        };
        let own = &self.network.beams[beam];
        let off = |node: usize| self.network.nodes[node].position_m[axis] - line_m;
        // The side on which the network was drawn: of its farthest node.
        let farthest = (0..self.network.nodes.len()).map(off).fold(0.0_f64, |most, next| if next.abs() > most.abs() { next } else { most });
        let sign = farthest.signum();
        let held = |node: usize| if off(node) == 0.0 { NEAR_JOINT } else { 0.0 };
        let line = &self.lines[state][beam];
        let u = line.nearest_to_wall((axis, sign), |u| 0.5 * own.thickness_at(u), [held(own.start), 1.0 - held(own.end)]);
        self.values.push(2.0 * sign * (line.at(u)[axis] - line_m) - own.thickness_at(u));
        self.places.push(Place::Mirror { state, beam, u, axis, sign });
    }

    /// Distance of two beams; where their axes cross, how far they are from not crossing.
    fn gap(&mut self, state: usize, [a, b]: [usize; 2]) {
        let [one, other] = [a, b].map(|beam| &self.lines[state][beam]);
        let Nearest { at: [u, v], crossed } = closest([one, other], apart(self.network, [a, b]));
        let [p, q] = [one.at(u), other.at(v)];
        let distance = maths::hypot(q[0] - p[0], q[1] - p[1]);
        let half_m = 0.5 * (self.network.beams[a].thickness_at(u) + self.network.beams[b].thickness_at(v));
        let value = if crossed { -distance } else { distance } - half_m;
        self.push(value, Place::Gap { state, ends: [(a, u), (b, v)], crossed });
    }
}

/// Where a cubic over [0, 1] with given values and slopes at its ends is largest, or least for a negative sign, and that value.
fn extreme(values: [f64; 2], slopes: [f64; 2], sign: f64) -> (f64, f64) {
    let rise = values[1] - values[0];
    let (c, d) = (3.0 * rise - 2.0 * slopes[0] - slopes[1], slopes[0] + slopes[1] - 2.0 * rise);
    let at = |t: f64| values[0] + t * (slopes[0] + t * (c + t * d));
    // Roots of slope + 2ct + 3dt²: the stable form, without a difference of nearly equal numbers.
    let square = c * c - 3.0 * d * slopes[0];
    let inside = if square > 0.0 {
        let q = -(c + if c < 0.0 { -square.sqrt() } else { square.sqrt() });
        [q / (3.0 * d), slopes[0] / q]
    } else {
        [f64::NAN; 2]
    };
    let ends = if sign * values[0] >= sign * values[1] { (0.0, values[0]) } else { (1.0, values[1]) };
    inside.into_iter().filter(|t| *t > 0.0 && *t < 1.0).fold(ends, |best, t| if sign * at(t) > sign * best.1 { (t, at(t)) } else { best })
}
