//! A design for an optimiser: forces, stresses, places and lengths that its goal and its requirements speak of, each smooth in the
//! design where the metric that people read has kinks, with exact derivatives.

mod places;
mod rows;

use std::ops::Range;

use forcewright_base::maths;
use forcewright_beam::{CurveSolver, CurveStates, Derivatives, Face, Network, Response, Settings, Status, Support, Theory};
use forcewright_study::evaluator::{Evaluation, Evaluator, Failure, Measure, Output, Variable, Workspace};

use super::knobs::{Knob, Knobs};
use super::line::Line;
use super::task::Wanted;
use crate::design::{Design, Envelope};
use crate::layout::Mirror;
use places::{Filling, Place};
use rows::Rows;

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
/// Error of a curve where the file asks for none, relative to the largest force: what a line search needs. The design found is analysed
/// in full.
const ACCURACY: f64 = 1e-4;

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
    /// Largest and least force between each two neighbouring nodes of a window, by its index, N.
    Window(usize),
    /// Length of a window, m.
    WindowLength(usize),
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
    /// Distance of each beam at each state to its mirror image, m: twice that to the line. Beams that keep to their own side of it are no
    /// nearer to the images of others than one of them is to its own.
    Mirror(Mirror),
    /// Arc length over chord of each beam.
    LengthRatio,
    /// Mass of all beams of the whole layout, kg, by the density of each drawn one, kg/m³.
    Mass(Vec<f64>),
}

impl Block {
    /// Whether it looks at where beams are.
    fn is_of_places(&self) -> bool {
        matches!(self, Self::Envelope(_) | Self::Clearance(_) | Self::Mirror(_))
    }
}

/// See the module.
pub(super) struct Search {
    pub(super) knobs: Knobs,
    variables: Vec<Variable>,
    base: Network,
    settings: Settings,
    copies: f64,
    travel_m: f64,
    windows: Vec<[Edge; 2]>,
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

/// What was computed for a design, for its derivatives.
struct Room {
    solver: CurveSolver,
    network: Network,
    derivatives: Derivatives,
    /// The design, while the solver has its curve.
    x: Vec<f64>,
    stations_m: Vec<f64>,
    /// Where each value comes from.
    places: Vec<Place>,
}

impl Search {
    /// `given` is the accuracy that the file asks for.
    pub(super) fn new(design: &Design, knobs: Knobs, given: Option<f64>, wanted: &Wanted) -> Self {
        let settings = design.settings();
        let mut variables = knobs.variables.clone();
        variables.extend(wanted.variables.iter().cloned());
        let mut search = Self {
            base: design.network.clone(),
            settings: Settings {
                accuracy: given.unwrap_or(ACCURACY),
                iteration_limit: settings.iteration_limit.min(MOST_ITERATIONS),
                ..settings
            },
            copies: design.copies(),
            travel_m: design.load_end,
            variables,
            windows: wanted.windows.clone(),
            outputs: Vec::new(),
            still: still(&design.network, &knobs),
            knobs,
            blocks: wanted.blocks.clone(),
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
            Block::Window(_) => ("window force", "N", 2 * (WINDOW - 1)),
            Block::WindowLength(_) => ("window length", "m", 1),
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
            Block::Mirror(_) => ("clearance of the mirrored half", "m", beams * (STATES.len() + 1)),
            Block::LengthRatio => ("length ratio", "1", beams),
            Block::Mass(_) => ("mass", "kg", 1),
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

    /// A displacement of a window, m, and its derivatives by the two edges.
    fn place_in_window(&self, x: &[f64], window: usize, index: usize) -> (f64, [(Option<usize>, f64); 2]) {
        let Some(edges) = self.windows.get(window).copied() else { return (0.0, [(None, 0.0); 2]) };
        let part = 0.5 * (1.0 - maths::cos(std::f64::consts::PI * index as f64 / (WINDOW - 1) as f64));
        let own = self.knobs.variables.len();
        let [start, end] = edges.map(|edge| match edge {
            Edge::Fixed(at) => (at, None),
            Edge::Moves(index) => (x[own + index], Some(own + index)),
        });
        let at = start.0 + part * (end.0 - start.0);
        (at.clamp(0.0, self.travel_m), [(start.1, 1.0 - part), (end.1, part)])
    }

    /// The displacement at a number of even steps, m.
    fn step_m(&self, i: usize) -> f64 {
        if i == CELLS { self.travel_m } else { self.travel_m * i as f64 / CELLS as f64 }
    }

    /// Places of a beam at which its distance to a wall is looked at by itself: next to an end that nothing moves across the wall. The
    /// distance of that end is one that no search can change, and that of the place next to it stands for the direction in which the
    /// beam leaves it.
    fn by_themselves(&self, state: usize, beam: usize, axis: usize) -> impl Iterator<Item = usize> + use<> {
        let own = &self.base.beams[beam];
        let [start, end] = [own.start, own.end].map(|node| self.still[node][axis].at(state));
        start.then_some(1).into_iter().chain(end.then_some(PLACES - 1))
    }

    /// All displacements at which the force is wanted, ascending, each once; the last is the whole travel.
    fn stations(&self, x: &[f64], out: &mut Vec<f64>) {
        out.clear();
        for block in &self.blocks {
            match block {
                Block::Slopes => out.extend((1..CELLS).map(|i| self.step_m(i))),
                Block::Window(window) => out.extend((0..WINDOW).map(|i| self.place_in_window(x, *window, i).0)),
                Block::Forces(at) => out.extend(at),
                Block::ForceRatio(at) => out.extend(at),
                _ => {}
            }
        }
        out.push(self.travel_m);
        out.retain(|s| *s >= 0.0 && *s <= self.travel_m);
        out.sort_by(f64::total_cmp);
        out.dedup();
    }
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

impl Search {
    /// Solves the curve of a design, with its states.
    fn solve(&self, x: &[f64], room: &mut Room) -> Result<(), Failure> {
        let failure = |reason: String| Failure { reason };
        room.x.clear();
        self.knobs.apply(&self.base, x, &mut room.network).ok_or_else(|| failure("a beam does not span its nodes".to_owned()))?;
        self.stations(x, &mut room.stations_m);
        let looks = self.blocks.iter().any(|b| *b == Block::Stress || b.is_of_places());
        let states_m: Vec<f64> =
            if looks { [0.0].into_iter().chain(STATES.map(|part| part * self.travel_m)).collect() } else { Vec::new() };
        // The design to begin with is looked at however hard that is; of the others there are many.
        room.solver.set_hasty(!self.knobs.variables.iter().zip(x).all(|(v, x)| v.nominal.to_bits() == x.to_bits()));
        let (stations_m, parameters) = (&room.stations_m, &self.knobs.parameters);
        let solved = room.solver.solve_with_states(&room.network, stations_m, &self.settings, parameters, &states_m);
        let states = solved.map_err(|error| failure(error.to_string()))?;
        if !matches!(states.response().status, Status::Complete) {
            return Err(failure(states.response().status.to_string()));
        }
        Ok(())
    }

    /// Values of the design that was solved, and where each comes from.
    fn fill(&self, x: &[f64], room: &mut Room, out: &mut Evaluation) -> Result<(), Failure> {
        room.places.clear();
        out.values.clear();
        let states = room.solver.states();
        let lines = if self.blocks.iter().any(Block::is_of_places) { drawn(&states, room.network.beams.len())? } else { Vec::new() };
        let curve = Curve { response: states.response(), stations_m: &room.stations_m };
        let mut filling = Filling {
            search: self,
            x,
            states: &states,
            curve,
            lines,
            network: &room.network,
            values: &mut out.values,
            places: &mut room.places,
        };
        self.blocks.iter().try_for_each(|block| filling.add(block))?;
        room.x.extend_from_slice(x);
        Ok(())
    }
}

/// The axes of all beams at all states.
fn drawn(states: &CurveStates<'_>, beams: usize) -> Result<Vec<Vec<Line>>, Failure> {
    let line = |state: usize, beam: usize| {
        let mut places = Vec::with_capacity(PLACES + 1);
        states.line_m(state, beam, PLACES, &mut places).map_err(|e| Failure { reason: e.to_string() })?;
        Ok(Line::new(places))
    };
    (0..states.count()).map(|state| (0..beams).map(|beam| line(state, beam)).collect()).collect()
}

/// A force curve at its stations.
#[derive(Clone, Copy)]
struct Curve<'a> {
    response: &'a Response,
    stations_m: &'a [f64],
}

impl Curve<'_> {
    /// The number of the station at a displacement.
    fn index(&self, at_m: f64) -> Option<usize> {
        self.stations_m.binary_search_by(|s| s.total_cmp(&at_m)).ok()
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
            x: Vec::new(),
            stations_m: Vec::new(),
            places: Vec::new(),
        })
    }

    fn evaluate(&self, x: &[f64], derivatives: bool, out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        let room = workspace.get::<Room>().ok_or_else(foreign)?;
        self.solve(x, room)?;
        self.fill(x, room, out)?;
        out.jacobian.clear();
        if derivatives { self.differentiate(x, &vec![true; out.values.len()], out, workspace) } else { Ok(()) }
    }

    fn differentiate(&self, x: &[f64], rows: &[bool], out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        let room = workspace.get::<Room>().ok_or_else(foreign)?;
        if room.x != x {
            self.solve(x, room)?;
            self.fill(x, room, out)?;
        }
        let Room { solver, network, derivatives, places, stations_m, .. } = room;
        let mut states = solver.states();
        let response = states.response();
        let columns = self.variables.len();
        out.jacobian.clear();
        out.jacobian.resize(places.len() * columns, 0.0);
        let mut all = Rows { search: self, x, curve: Curve { response, stations_m }, states: &mut states, network, derivatives };
        for ((place, row), _) in places.iter().zip(out.jacobian.chunks_exact_mut(columns.max(1))).zip(rows).filter(|(_, wanted)| **wanted) {
            all.fill(place, row)?;
        }
        Ok(())
    }

    fn measure(&self, _: &[f64], _: &[f64], out: &mut Vec<f64>, _: &mut Workspace) {
        out.clear();
    }
}

fn foreign() -> Failure {
    Failure { reason: "the room is another evaluator's".to_owned() }
}
