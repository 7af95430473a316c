//! A design for an optimiser: forces, stresses, places and lengths that its goal and its requirements speak of, each smooth in the
//! design where the metric that people read has kinks, with exact derivatives.

use std::ops::Range;

use forcewright_base::maths;
use forcewright_beam::{Axis, CurveSolver, CurveStates, Derivatives, Face, Network, Output as Asked, Settings, Status, Support, Theory};
use forcewright_study::evaluator::{Evaluation, Evaluator, Failure, Measure, Output, Variable, Workspace};

use super::knobs::{Knob, Knobs};
use super::line::{Line, apart, closest};
use crate::design::{Design, Envelope};

/// Parts of the travel at whose ends the stiffness is looked at.
const CELLS: usize = 40;
/// Nodes of a window, those of Chebyshev and Lobatto, which lie close together near the ends: between two neighbours the force is a cubic.
const WINDOW: usize = 17;
/// Parts of the travel at which stress and places are looked at; rest is added for places.
const STATES: [f64; 3] = [0.4, 0.7, 1.0];
/// Places along a beam at which its distance to walls and to other beams is looked at.
const PLACES: usize = 16;
/// Newton iterations that a design is worth: what asks for many times as many as a useful one is given up.
const MOST_ITERATIONS: u64 = 1000;
/// Error of a curve, relative to the largest force: what a line search needs.
const ACCURACY: f64 = 1e-5;

/// Where a window begins or ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Edge {
    /// At a displacement, m.
    Fixed(f64),
    /// At the value of a variable of its own, by its index after those of the design.
    Moves(usize),
}

/// A vector of values.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Block {
    /// Stiffness at even steps of the travel, N/m.
    Slopes,
    /// Largest and least force between each two neighbouring nodes of the window, N.
    Window,
    /// Length of the window, m.
    WindowLength,
    /// Forces at displacements of its own, N.
    Forces(Vec<f64>),
    /// F(a)/F(b) − 1 at the displacements a and b.
    ForceRatio([f64; 2]),
    /// Stress of each beam at some places, of the right face or of both, at each state but rest, Pa; tension is positive.
    Stress,
    /// Distance of each beam at each state to each side of a box that is not infinitely far away, m.
    Envelope(Envelope),
    /// Distance of each pair of beams at each state, m.
    Clearance(Vec<[usize; 2]>),
    /// Arc length over chord of each beam.
    LengthRatio,
}

/// See the module.
pub(super) struct Search {
    pub(super) knobs: Knobs,
    variables: Vec<Variable>,
    base: Network,
    settings: Settings,
    copies: f64,
    travel_m: f64,
    window: Option<[Edge; 2]>,
    blocks: Vec<Block>,
    outputs: Vec<Output>,
    /// Per node and axis: whether the search does not move it along that axis, and whether the load does not either.
    still: Vec<[Still; 2]>,
}

/// Whether a node stays where it is.
#[derive(Clone, Copy, Debug)]
struct Still {
    /// From design to design.
    at_rest: bool,
    /// Over the travel too.
    always: bool,
}

impl Still {
    fn at(self, state: usize) -> bool {
        if state == 0 { self.at_rest } else { self.always }
    }
}

struct Room {
    solver: CurveSolver,
    network: Network,
    derivatives: Derivatives,
    stations_m: Vec<f64>,
}

/// Rows of the Jacobian under construction; without derivatives they have no columns.
struct Rows<'a> {
    out: &'a mut Evaluation,
    columns: usize,
    derivatives: bool,
}

impl Rows<'_> {
    fn push(&mut self, value: f64) -> &mut [f64] {
        self.out.values.push(value);
        let first = self.out.jacobian.len();
        if self.derivatives {
            self.out.jacobian.resize(first + self.columns, 0.0);
        }
        &mut self.out.jacobian[first..]
    }
}

impl Search {
    pub(super) fn new(design: &Design, knobs: Knobs, own: Vec<Variable>, window: Option<[Edge; 2]>, blocks: Vec<Block>) -> Self {
        let settings = design.settings();
        let mut variables = knobs.variables.clone();
        variables.extend(own);
        let mut search = Self {
            base: design.network.clone(),
            settings: Settings {
                accuracy: settings.accuracy.max(ACCURACY),
                iteration_limit: settings.iteration_limit.min(MOST_ITERATIONS),
                ..settings
            },
            copies: design.copies(),
            travel_m: design.load_end,
            variables,
            window,
            outputs: Vec::new(),
            still: still(&design.network, &knobs),
            knobs,
            blocks,
        };
        let mut from = 0;
        for block in &search.blocks {
            let (name, unit, count) = search.describe(block);
            search.outputs.push(Output { name: name.to_owned(), unit, values: from..from + count });
            from += count;
        }
        search
    }

    fn describe(&self, block: &Block) -> (&'static str, &'static str, usize) {
        let beams = self.base.beams.len();
        match block {
            Block::Slopes => ("stiffness", "N/m", CELLS),
            Block::Window => ("window force", "N", 2 * (WINDOW - 1)),
            Block::WindowLength => ("window length", "m", 1),
            Block::Forces(at) => ("force", "N", at.len()),
            Block::ForceRatio(_) => ("force ratio", "1", 1),
            Block::Stress => ("stress", "Pa", self.faces().len() * beams * (PLACES + 1) * STATES.len()),
            Block::Envelope(envelope) => {
                let all = (0..=STATES.len()).flat_map(|state| (0..beams).map(move |beam| (state, beam)));
                let of_side =
                    |axis: usize| all.clone().map(|(state, beam)| 1 + self.by_themselves(state, beam, axis).count()).sum::<usize>();
                ("envelope margin", "m", sides(envelope).iter().map(|side| of_side(side.0)).sum())
            }
            Block::Clearance(pairs) => ("clearance", "m", pairs.len() * (STATES.len() + 1)),
            Block::LengthRatio => ("length ratio", "1", beams),
        }
    }

    /// Faces whose stress is looked at: without stretching the left face carries the opposite of the right one.
    fn faces(&self) -> &'static [Face] {
        if self.settings.theory == Theory::Inextensible { &[Face::Right] } else { &[Face::Left, Face::Right] }
    }

    /// Places of a block's values among all.
    pub(super) fn values(&self, block: &Block) -> Range<usize> {
        let index = self.blocks.iter().position(|b| b == block);
        index.and_then(|i| self.outputs.get(i)).map_or(0..0, |o| o.values.clone())
    }

    /// A displacement of the window, m, and its derivatives by the two edges.
    fn place_in_window(&self, x: &[f64], index: usize) -> (f64, [(Option<usize>, f64); 2]) {
        let Some(edges) = self.window else { return (0.0, [(None, 0.0); 2]) };
        let part = 0.5 * (1.0 - maths::cos(std::f64::consts::PI * index as f64 / (WINDOW - 1) as f64));
        let own = self.knobs.variables.len();
        let [start, end] = edges.map(|edge| match edge {
            Edge::Fixed(at) => (at, None),
            Edge::Moves(index) => (x[own + index], Some(own + index)),
        });
        let at = start.0 + part * (end.0 - start.0);
        (at.clamp(0.0, self.travel_m), [(start.1, 1.0 - part), (end.1, part)])
    }

    /// All displacements at which the force is wanted, ascending, each once; the last is the whole travel.
    fn stations(&self, x: &[f64], out: &mut Vec<f64>) {
        out.clear();
        for block in &self.blocks {
            match block {
                Block::Slopes => out.extend((1..CELLS).map(|i| self.travel_m * i as f64 / CELLS as f64)),
                Block::Window => out.extend((0..WINDOW).map(|i| self.place_in_window(x, i).0)),
                Block::Forces(at) => out.extend(at),
                Block::ForceRatio(at) => out.extend(at),
                _ => {}
            }
        }
        out.push(self.travel_m);
        out.retain(|s| *s > 0.0 && *s <= self.travel_m);
        out.sort_by(f64::total_cmp);
        out.dedup();
    }

    /// Adds the rows of the force at a displacement: value, and where derivatives are wanted their row. `along` are the derivatives of the
    /// displacement by variables.
    fn force(&self, curve: &Curve<'_>, at_m: f64, factor: f64, row: &mut [f64], along: &[(Option<usize>, f64)]) -> f64 {
        let Some(index) = curve.index(at_m) else { return 0.0 };
        let (response, count) = (curve.states.response(), self.knobs.parameters.len());
        let factor = factor * self.copies;
        if !row.is_empty() {
            let own = &response.force_gradient[index * count..(index + 1) * count];
            self.knobs.add_row(own, factor, row);
            for (column, by) in along.iter().filter_map(|(c, by)| Some(((*c)?, *by))) {
                row[column] += factor * response.stiffness_n_per_m[index] * by;
            }
        }
        factor * response.force_n[index]
    }

    fn fill(&self, block: &Block, x: &[f64], curve: &mut Curve<'_>, network: &Network, rows: &mut Rows<'_>) -> Result<(), Failure> {
        match block {
            Block::Slopes => self.slopes(curve, rows),
            Block::Window => self.window(x, curve, rows),
            Block::WindowLength => {
                let [(start, from), (end, to)] = [0, WINDOW - 1].map(|i| self.place_in_window(x, i));
                let row = rows.push(end - start);
                if !row.is_empty() {
                    from[0].0.into_iter().for_each(|c| row[c] -= 1.0);
                    to[1].0.into_iter().for_each(|c| row[c] += 1.0);
                }
            }
            Block::Forces(at) => {
                for at in at {
                    let row = rows.push(0.0);
                    let value = self.force(curve, *at, 1.0, row, &[]);
                    rows.set(value);
                }
            }
            Block::ForceRatio([a, b]) => {
                let (upper, lower) = (self.force(curve, *a, 1.0, &mut [], &[]), self.force(curve, *b, 1.0, &mut [], &[]));
                let row = rows.push(upper / lower - 1.0);
                self.force(curve, *a, 1.0 / lower, row, &[]);
                self.force(curve, *b, -upper / (lower * lower), row, &[]);
            }
            Block::Stress => {
                // At places that stay where they are: the largest stress of a beam has a kink wherever another place becomes the largest.
                let places = (0..=PLACES).flat_map(|i| self.faces().iter().map(move |face| (i as f64 / PLACES as f64, *face)));
                let of_beam = |beam| places.clone().map(move |(u, face)| Asked::Stress { beam, u, face });
                let asked: Vec<Asked> = (0..self.base.beams.len()).flat_map(of_beam).collect();
                for state in 1..=STATES.len() {
                    curve.ask(state, &asked, |value, by, _| {
                        let row = rows.push(value);
                        self.knobs.add_row(by, 1.0, row);
                    })?;
                }
            }
            Block::Envelope(envelope) => {
                for state in 0..=STATES.len() {
                    for side in sides(envelope) {
                        for beam in 0..network.beams.len() {
                            self.wall(curve, (state, beam), side, network, rows)?;
                        }
                    }
                }
            }
            Block::Clearance(pairs) => {
                for state in 0..=STATES.len() {
                    for [a, b] in pairs {
                        let (u, v) = closest([&curve.lines[state][*a], &curve.lines[state][*b]], apart(network, [*a, *b]));
                        curve.ask(state, &[Asked::Gap { first: (*a, u), second: (*b, v), reflection: None }], |value, by, _| {
                            let row = rows.push(value);
                            self.knobs.add_row(by, 1.0, row);
                        })?;
                    }
                }
            }
            Block::LengthRatio => self.length_ratios(network, rows),
        }
        Ok(())
    }

    /// Stiffness at even steps. Its derivatives are the slopes of those of the force.
    fn slopes(&self, curve: &Curve<'_>, rows: &mut Rows<'_>) {
        let step = |i: usize| if i == CELLS { self.travel_m } else { self.travel_m * i as f64 / CELLS as f64 };
        let nodes: Vec<f64> = (0..=CELLS).map(step).collect();
        for at in &nodes[1..] {
            let Some(index) = curve.index(*at) else { continue };
            let row = rows.push(self.copies * curve.states.response().stiffness_n_per_m[index]);
            if row.is_empty() {
                continue;
            }
            for (node, [_, slope]) in stencil(&nodes, *at) {
                self.force(curve, nodes[node], slope, row, &[]);
            }
        }
    }

    /// Extremes of the force between the nodes of the window. Where one lies inside, its place does not matter to first order; at a node
    /// it moves with the window.
    fn window(&self, x: &[f64], curve: &Curve<'_>, rows: &mut Rows<'_>) {
        let places: Vec<_> = (0..WINDOW).map(|i| self.place_in_window(x, i)).collect();
        let nodes: Vec<f64> = places.iter().map(|p| p.0).collect();
        let found: Vec<Option<usize>> = nodes.iter().map(|at| curve.index(*at)).collect();
        let response = curve.states.response();
        let of = |values: &[f64], i: usize| found[i].map_or(0.0, |index| self.copies * values[index]);
        for cell in 0..WINDOW - 1 {
            let width = nodes[cell + 1] - nodes[cell];
            let forces = [cell, cell + 1].map(|i| of(&response.force_n, i));
            let rises = [cell, cell + 1].map(|i| width * of(&response.stiffness_n_per_m, i));
            for sign in [1.0, -1.0] {
                let (part, value) = extreme(forces, rises, sign);
                let row = rows.push(value);
                if row.is_empty() {
                    continue;
                }
                let at = nodes[cell] + part * width;
                for (node, [weight, _]) in stencil(&nodes, at) {
                    self.force(curve, nodes[node], weight, row, &[]);
                }
                let end = if part <= 0.0 { Some(cell) } else { (part >= 1.0).then_some(cell + 1) };
                if let Some(end) = end {
                    for (column, by) in places[end].1.iter().filter_map(|(c, by)| Some(((*c)?, *by))) {
                        row[column] += of(&response.stiffness_n_per_m, end) * by;
                    }
                }
            }
        }
    }

    /// Places of a beam at which its distance to a wall is looked at by itself: next to an end that nothing moves across the wall. The
    /// distance of that end is one that no search can change, and that of the place next to it stands for the direction in which the
    /// beam leaves it.
    fn by_themselves(&self, state: usize, beam: usize, axis: usize) -> impl Iterator<Item = usize> {
        let own = &self.base.beams[beam];
        let [start, end] = [own.start, own.end].map(|node| self.still[node][axis].at(state));
        start.then_some(1).into_iter().chain(end.then_some(PLACES - 1))
    }

    /// Distance of a beam with its thickness to one side of the box: at the places that are looked at by themselves, and where it is least
    /// of the others.
    fn wall(
        &self,
        curve: &mut Curve<'_>,
        (state, beam): (usize, usize),
        (axis, sign, wall): (usize, f64, f64),
        network: &Network,
        rows: &mut Rows<'_>,
    ) -> Result<(), Failure> {
        let own = &network.beams[beam];
        let place = |i: usize| i as f64 / PLACES as f64;
        let still = |node: usize| 2 * usize::from(self.still[node][axis].at(state));
        let range = [place(still(own.start)), place(PLACES - still(own.end))];
        let least = curve.lines[state][beam].nearest_to_wall((axis, sign), |u| 0.5 * own.thickness_at(u), range);
        let side = if axis == 0 { Axis::X } else { Axis::Y };
        for u in self.by_themselves(state, beam, axis).map(place).chain([least]) {
            let half_m = 0.5 * own.thickness_at(u);
            curve.ask(state, &[Asked::Position { beam, u, axis: side }], |value, by, _| {
                let row = rows.push(sign * (value - wall) - half_m);
                self.knobs.add_row(by, sign, row);
                if !row.is_empty() {
                    self.knobs.add_half_thickness(beam, own, u, row);
                }
            })?;
        }
        Ok(())
    }

    fn length_ratios(&self, network: &Network, rows: &mut Rows<'_>) {
        for (index, beam) in network.beams.iter().enumerate() {
            let [x, y] = beam.shape.chord_m();
            let chord_m = maths::hypot(x, y);
            let ratio = beam.shape.length_m() / chord_m;
            let row = rows.push(ratio);
            if row.is_empty() {
                continue;
            }
            let Ok(closure) = beam.shape.chord_sensitivity() else { continue };
            for (knob, out) in self.knobs.each.iter().zip(row) {
                // At a given bend the ratio does not depend on where the nodes are.
                if let Knob::Bend { beam, k } = knob
                    && *beam == index
                {
                    *out = closure.length_by_bend_m.get(k - 1).copied().unwrap_or(0.0) / chord_m;
                }
            }
        }
    }
}

impl Rows<'_> {
    /// Sets the value that was pushed last.
    fn set(&mut self, value: f64) {
        if let Some(last) = self.out.values.last_mut() {
            *last = value;
        }
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

/// Weights of the values at the four nodes next to a place, for the value and for the slope there: the cubic through them.
fn stencil(nodes: &[f64], at: f64) -> impl Iterator<Item = (usize, [f64; 2])> {
    let after = nodes.partition_point(|n| *n <= at);
    let first = after.saturating_sub(2).min(nodes.len().saturating_sub(4));
    let four = &nodes[first..(first + 4).min(nodes.len())];
    (0..four.len()).map(move |i| {
        let others = || (0..four.len()).filter(move |j| *j != i);
        let factor = |j: usize| (at - four[j]) / (four[i] - four[j]);
        let weight = others().map(factor).product();
        let slope = others().map(|j| others().filter(|k| *k != j).map(factor).product::<f64>() / (four[i] - four[j])).sum();
        (first + i, [weight, slope])
    })
}

/// Which nodes stay where they are along which axis.
fn still(network: &Network, knobs: &Knobs) -> Vec<[Still; 2]> {
    let moves = |node: usize, axis: usize| {
        knobs.each.iter().any(|knob| match knob {
            Knob::NodeX(other) => *other == node && axis == 0,
            Knob::NodeY(other) => *other == node && axis == 1,
            Knob::NodeOn { node: other, from, to } => *other == node && from[axis].to_bits() != to[axis].to_bits(),
            _ => false,
        })
    };
    let held = |node: usize, axis: usize| match network.nodes[node].support {
        Support::Clamped | Support::Pinned => true,
        Support::Slider { direction, .. } => direction[axis] == 0.0,
        Support::Free | Support::Parallel => false,
    };
    let still = |node, axis| Still { at_rest: !moves(node, axis), always: held(node, axis) && !moves(node, axis) };
    (0..network.nodes.len()).map(|node| [0, 1].map(|axis| still(node, axis))).collect()
}

/// Sides of a box that are not infinitely far away: the axis, the sign of what is inside, the place.
fn sides(envelope: &Envelope) -> Vec<(usize, f64, f64)> {
    let all = (0..2).flat_map(|axis| [(axis, 1.0, envelope.low_m[axis]), (axis, -1.0, envelope.high_m[axis])]);
    all.filter(|(.., wall)| wall.is_finite()).collect()
}

/// A solved curve with its states.
struct Curve<'a> {
    states: CurveStates<'a>,
    /// The axes of the beams at the states, if they are looked at.
    lines: Vec<Vec<Line>>,
    stations_m: &'a [f64],
    derivatives: &'a mut Derivatives,
    parameters: usize,
}

impl Curve<'_> {
    fn index(&self, at_m: f64) -> Option<usize> {
        self.stations_m.binary_search_by(|s| s.total_cmp(&at_m)).ok()
    }

    /// Draws the axes of all beams at all states.
    fn draw(&mut self, beams: usize) -> Result<(), Failure> {
        for state in 0..self.states.count() {
            let mut all = Vec::with_capacity(beams);
            for beam in 0..beams {
                let mut line = Vec::new();
                self.states.line_m(state, beam, PLACES, &mut line).map_err(|e| Failure { reason: e.to_string() })?;
                all.push(Line::new(line));
            }
            self.lines.push(all);
        }
        Ok(())
    }

    /// Shows outputs at a state: the value, its derivatives by the parameters, and by the displacement.
    fn ask(&mut self, state: usize, asked: &[Asked], mut show: impl FnMut(f64, &[f64], f64)) -> Result<(), Failure> {
        self.states.derivatives(state, asked, self.derivatives).map_err(|e| Failure { reason: e.to_string() })?;
        let found = &*self.derivatives;
        for (index, (value, rate)) in found.value.iter().zip(&found.by_control).enumerate() {
            show(*value, &found.by_parameter[index * self.parameters..(index + 1) * self.parameters], *rate);
        }
        Ok(())
    }
}

impl Evaluator for Search {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn numbers(&self, x: &[f64]) -> Vec<(String, f64)> {
        self.knobs.numbers(x)
    }

    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn measures(&self) -> &[Measure] {
        &[]
    }

    fn workspace(&self) -> Workspace {
        Workspace::new(Room {
            solver: CurveSolver::new(),
            network: self.base.clone(),
            derivatives: Derivatives::default(),
            stations_m: Vec::new(),
        })
    }

    fn evaluate(&self, x: &[f64], derivatives: bool, out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        let failure = |reason: &str| Failure { reason: reason.to_owned() };
        let Some(Room { solver, network, derivatives: buffer, stations_m }) = workspace.get::<Room>() else {
            return Err(failure("the room is another evaluator's"));
        };
        self.knobs.apply(&self.base, x, network).ok_or_else(|| failure("a beam does not span its nodes"))?;
        self.stations(x, stations_m);
        let parameters = if derivatives { &self.knobs.parameters[..] } else { &[] };
        let looks = self.blocks.iter().any(|b| matches!(b, Block::Stress | Block::Envelope(_) | Block::Clearance(_)));
        let states_m: Vec<f64> =
            if looks { [0.0].into_iter().chain(STATES.map(|part| part * self.travel_m)).collect() } else { Vec::new() };
        let states = solver
            .solve_with_states(network, stations_m, &self.settings, parameters, &states_m)
            .map_err(|error| Failure { reason: error.to_string() })?;
        if !matches!(states.response().status, Status::Complete) {
            return Err(Failure { reason: states.response().status.to_string() });
        }
        let mut curve = Curve { states, lines: Vec::new(), stations_m, derivatives: buffer, parameters: parameters.len() };
        if self.blocks.iter().any(|b| matches!(b, Block::Envelope(_) | Block::Clearance(_))) {
            curve.draw(network.beams.len())?;
        }
        out.values.clear();
        out.jacobian.clear();
        let mut rows = Rows { out, columns: self.variables.len(), derivatives };
        self.blocks.iter().try_for_each(|block| self.fill(block, x, &mut curve, network, &mut rows))
    }

    fn measure(&self, _: &[f64], _: &[f64], out: &mut Vec<Option<f64>>) {
        out.clear();
    }
}
