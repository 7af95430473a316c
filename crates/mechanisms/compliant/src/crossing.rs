//! Where beams pass through each other, through themselves or through the mirrored half. The equations know nothing of it: there is no
//! contact in them.
//!
//! Only axes are tested: thickness is not. Beams touch with their faces before their axes meet, so what is found is late rather than
//! early, and beams that rub against each other without passing through are not found.

use forcewright_base::maths;
use forcewright_beam::{Beam, BeamState, Path, Point, Theory};

use crate::design::Design;
use crate::layout::Mirror;

/// Chords along the axis of each beam.
const CHORDS: usize = 32;
/// Gauss–Legendre rule of three points on a chord: place within it and weight.
const RULE: [(f64, f64); 3] = [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
/// Most states looked at, besides rest.
const STATES: usize = 24;
/// Halvings between two states: less than 1 % of their distance remains.
const HALVINGS: usize = 7;
/// Chords of one beam that are that far apart in their order, or less, are neighbours.
const NEIGHBOURS: usize = 2;
/// Around a shared node chords of two beams are not compared, over that many thicknesses of arc length.
const JOINT_THICKNESSES: f64 = 1.5;
/// Distances below this, relative to the size of the network, are none.
const TOUCH: f64 = 1e-9;

/// Axes that meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Displacement of the load node at which it is seen first, m.
    pub displacement_m: f64,
    /// Index of the beam.
    pub first: usize,
    /// Index of the other beam, the same for a beam that passes through itself; `None` is the mirror line, on which the beam meets its
    /// own mirror image.
    pub second: Option<usize>,
}

/// The first crossing between rest and the end of a path, if there is one; of several at once, that of the lowest beam indices.
///
/// Only axes are tested, thickness is not: the faces of the beams meet earlier. Axes that touch count as crossed.
///
/// Looks at rest and at up to 24 states of the path, at 33 points per beam, and halves the interval in which the crossing begins until
/// less than 1 % of it remains. What is crossed only in between, or between two points of an axis, is not seen.
///
/// Around a node that two beams share, the parts of both are not compared over 1.5 thicknesses or over 1/32 of the longer beam, whichever
/// is more.
pub fn first_crossing(design: &Design, path: &Path) -> Option<Crossing> {
    let found = of_the_drawn(design, path)?;
    Some(Crossing { displacement_m: design.layers() * found.displacement_m, ..found })
}

/// The same with the displacement of the drawn network.
fn of_the_drawn(design: &Design, path: &Path) -> Option<Crossing> {
    let mut axes = Axes::at_rest(design);
    if let Some((first, second)) = axes.crossing() {
        return Some(Crossing { displacement_m: 0.0, first, second });
    }
    let count = path.points.len();
    let states = count.min(STATES);
    let mut clear = 0.0;
    for state in 1..=states {
        let point = path.points.get(state * count / states - 1)?;
        axes.move_to(point);
        if let Some(pair) = axes.crossing() {
            return Some(begin(&mut axes, path, clear, point, pair));
        }
        clear = point.control;
    }
    None
}

/// Where a crossing begins that is at `point` but not yet at the control `clear`.
fn begin(axes: &mut Axes<'_>, path: &Path, mut clear: f64, point: &Point, pair: (usize, Option<usize>)) -> Crossing {
    let mut crossed = point.control;
    let mut found = Crossing { displacement_m: point.displacement, first: pair.0, second: pair.1 };
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(clear, crossed);
        // Without an equilibrium there, the answer stays as coarse as it is.
        let Ok(point) = path.at(middle) else { break };
        axes.move_to(&point);
        if let Some((first, second)) = axes.crossing() {
            found = Crossing { displacement_m: point.displacement, first, second };
            crossed = middle;
        } else {
            clear = middle;
        }
    }
    found
}

/// A rectangle along the axes of coordinates.
#[derive(Clone, Copy)]
struct Frame {
    low: [f64; 2],
    high: [f64; 2],
}

impl Frame {
    const EMPTY: Self = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    fn of(points: &[[f64; 2]]) -> Self {
        points.iter().fold(Self::EMPTY, |frame, p| Self {
            low: [frame.low[0].min(p[0]), frame.low[1].min(p[1])],
            high: [frame.high[0].max(p[0]), frame.high[1].max(p[1])],
        })
    }

    fn meets(&self, other: &Self, slack: f64) -> bool {
        (0..2).all(|k| self.low[k] <= other.high[k] + slack && other.low[k] <= self.high[k] + slack)
    }
}

/// The axes of all beams in one state.
struct Axes<'a> {
    design: &'a Design,
    /// One after the other, [`CHORDS`] + 1 points per beam, m.
    points: Vec<[f64; 2]>,
    /// Around each beam.
    frames: Vec<Frame>,
    /// Distances below it are none, m.
    touch_m: f64,
    /// Side of the mirror line on which most of the network is drawn; 0 without a mirror line.
    side: f64,
}

impl<'a> Axes<'a> {
    fn at_rest(design: &'a Design) -> Self {
        let count = design.network.beams.len();
        let mut points = Vec::with_capacity(count * (CHORDS + 1));
        for beam in &design.network.beams {
            let [x, y] = design.start_m(beam);
            points.extend((0..=CHORDS).map(|i| {
                let p = beam.shape.point_m(place(i));
                [x + p[0], y + p[1]]
            }));
        }
        let Frame { low, high } = Frame::of(&points);
        let touch_m = TOUCH * (high[0] - low[0]).max(high[1] - low[1]);
        let side = design.layout.mirror.map_or(0.0, |mirror| {
            let sides = points.iter().map(|p| offset(mirror, *p)).filter(|d| d.abs() > touch_m).map(f64::signum);
            if sides.sum::<f64>() < 0.0 { -1.0 } else { 1.0 }
        });
        let mut axes = Self { design, points, frames: Vec::with_capacity(count), touch_m, side };
        axes.frame();
        axes
    }

    fn move_to(&mut self, point: &Point) {
        self.points.clear();
        let network = &self.design.network;
        for (beam, state) in network.beams.iter().zip(&point.beams) {
            let rest = network.nodes.get(beam.start).map_or([0.0; 2], |n| n.position_m);
            let moved = point.nodes.get(beam.start).map_or([0.0; 2], |n| n.displacement_m);
            lay(beam, state, self.design.theory, [rest[0] + moved[0], rest[1] + moved[1]], &mut self.points);
        }
        self.frame();
    }

    fn frame(&mut self) {
        self.frames.clear();
        self.frames.extend(self.points.chunks_exact(CHORDS + 1).map(Frame::of));
    }

    /// The lowest beam that crosses something, and what: the lowest beam, or else the mirror line.
    fn crossing(&self) -> Option<(usize, Option<usize>)> {
        let count = self.frames.len().min(self.design.network.beams.len());
        (0..count).find_map(|first| {
            let other = (first..count).find(|second| self.meet(first, *second));
            (other.is_some() || self.is_beyond_mirror(first)).then_some((first, other))
        })
    }

    fn axis(&self, beam: usize) -> &[[f64; 2]] {
        self.points.chunks_exact(CHORDS + 1).nth(beam).unwrap_or(&[])
    }

    fn is_beyond_mirror(&self, beam: usize) -> bool {
        self.design.layout.mirror.is_some_and(|mirror| self.axis(beam).iter().any(|p| self.side * offset(mirror, *p) < -self.touch_m))
    }

    /// Whether two beams meet, or one meets itself, elsewhere than at a node they share.
    fn meet(&self, first: usize, second: usize) -> bool {
        let (frames, slack) = (&self.frames, self.touch_m);
        if !frames[first].meets(&frames[second], slack) {
            return false;
        }
        let joints = Joints::of(self.design, first, second, slack);
        let (one, other) = (self.axis(first), self.axis(second));
        one.windows(2).enumerate().any(|(i, a)| {
            let frame = Frame::of(a);
            let after = if first == second { i + NEIGHBOURS + 1 } else { 0 };
            frame.meets(&frames[second], slack)
                && other.windows(2).enumerate().skip(after).any(|(j, b)| {
                    frame.meets(&Frame::of(b), slack) && segments_meet([a[0], a[1]], [b[0], b[1]], slack) && !joints.hide(i, j)
                })
        })
    }
}

/// Which ends of two beams are joined, so that they meet there rightly.
struct Joints {
    /// Chords that lie at least partly in the joint, of either beam.
    hidden: [usize; 2],
    /// Whether the start or the end of the first is joined to the start or the end of the second.
    joined: [[bool; 2]; 2],
}

impl Joints {
    fn of(design: &Design, first: usize, second: usize, touch_m: f64) -> Self {
        let (one, other) = (&design.network.beams[first], &design.network.beams[second]);
        // Where the ends are at rest; two clamps at the same place are one place of the ground.
        let ends = |beam: &Beam| [design.start_m(beam), design.end_m(beam)];
        let same = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).abs().max((p[1] - q[1]).abs()) <= touch_m;
        let joined = if first == second {
            let [from, to] = ends(one);
            [[false, same(from, to)], [false; 2]]
        } else {
            ends(one).map(|a| ends(other).map(|b| same(a, b)))
        };
        let chord = |length: f64| length / CHORDS as f64;
        let lengths = [one.shape.length_m(), other.shape.length_m()];
        let reach = (JOINT_THICKNESSES * thickest_m(one).max(thickest_m(other))).max(chord(lengths[0].max(lengths[1])));
        let hidden = lengths.map(|length| (0..CHORDS).take_while(|i| *i as f64 * chord(length) < reach).count());
        Self { hidden, joined }
    }

    /// Whether a chord of the first and a chord of the second beam both belong to one joint.
    fn hide(&self, i: usize, j: usize) -> bool {
        let near = |chord: usize, hidden: usize| [chord < hidden, CHORDS - 1 - chord.min(CHORDS - 1) < hidden];
        let (one, other) = (near(i, self.hidden[0]), near(j, self.hidden[1]));
        (0..2).any(|a| (0..2).any(|b| self.joined[a][b] && one[a] && other[b]))
    }
}

/// Largest thickness of a beam, m.
pub(crate) fn thickest_m(beam: &Beam) -> f64 {
    if beam.profile.is_empty() { beam.section.thickness_m } else { beam.profile.iter().map(|p| p[1]).fold(0.0, f64::max) }
}

/// The axis of every beam in a state as 32 chords, m.
pub(crate) fn axes_m(design: &Design, point: &Point) -> Vec<Vec<[f64; 2]>> {
    let axis = |(beam, state): (&Beam, &BeamState)| {
        let (rest, moved) = (design.network.nodes[beam.start].position_m, point.nodes[beam.start].displacement_m);
        let mut points = Vec::with_capacity(CHORDS + 1);
        lay(beam, state, design.theory, [rest[0] + moved[0], rest[1] + moved[1]], &mut points);
        points
    };
    design.network.beams.iter().zip(&point.beams).map(axis).collect()
}

/// Lays the deformed axis of a beam from its start: what [`BeamState::shape_m`] gives, but each chord goes on from the one before, for a
/// fraction of the work.
fn lay(beam: &Beam, state: &BeamState, theory: Theory, start: [f64; 2], points: &mut Vec<[f64; 2]>) {
    // Rigid ends, starts on a body and varying thickness are left to the engine.
    let [from, to] = state.flexible();
    let on_arm = beam.arms_m[0].iter().any(|v| v.abs() > 0.0);
    if on_arm || !beam.profile.is_empty() || from > 0.0 || to < 1.0 {
        points.extend((0..=CHORDS).map(|i| state.shape_m(place(i))));
        return;
    }
    let (axial, shear) = match theory {
        Theory::Inextensible => (0.0, 0.0),
        Theory::Reissner => (1.0 / beam.section.axial_stiffness_n(), 1.0 / beam.section.shear_stiffness_n()),
    };
    let chord = beam.shape.length_m() / CHORDS as f64;
    let [h, v] = state.force_n;
    let mut at = start;
    points.push(at);
    for i in 0..CHORDS {
        for (within, weight) in RULE {
            let (sin, cos) = maths::sin_cos(state.angle_rad((i as f64 + within) / CHORDS as f64));
            let (stretch, slide) = (1.0 + axial * (h * cos + v * sin), shear * (v * cos - h * sin));
            at[0] += chord * weight * (stretch * cos - slide * sin);
            at[1] += chord * weight * (stretch * sin + slide * cos);
        }
        points.push(at);
    }
}

fn place(i: usize) -> f64 {
    i as f64 / CHORDS as f64
}

/// Distance from the mirror line, m; its sign is the side.
fn offset(mirror: Mirror, [x, y]: [f64; 2]) -> f64 {
    match mirror {
        Mirror::X(at) => x - at,
        Mirror::Y(at) => y - at,
    }
}

/// Whether two segments whose frames meet have a point in common, to within `touch_m`.
///
/// An end on the other segment counts: axes that cross do so at a sampled point as often as symmetry wants it.
fn segments_meet(a: [[f64; 2]; 2], b: [[f64; 2]; 2], touch_m: f64) -> bool {
    let apart = |line: [[f64; 2]; 2], ends: [[f64; 2]; 2]| {
        let [p, q] = ends.map(|end| side(line, end, touch_m));
        p * q > 0
    };
    !apart(a, b) && !apart(b, a)
}

/// Side of a line on which a point lies: 1 left, −1 right, 0 on it to within `touch_m`, which is far above rounding.
fn side([from, to]: [[f64; 2]; 2], point: [f64; 2], touch_m: f64) -> i8 {
    let (along, aside) = ([to[0] - from[0], to[1] - from[1]], [point[0] - from[0], point[1] - from[1]]);
    let area = along[0] * aside[1] - along[1] * aside[0];
    let none = touch_m * (along[0].abs() + along[1].abs());
    i8::from(area > none) - i8::from(area < -none)
}

#[cfg(test)]
mod tests {
    use forcewright_base::diagnostics::Diagnostics;
    use forcewright_contract::project::{Choices, Project};
    use forcewright_contract::read;

    use super::*;
    use crate::{Behaviour, Spec};

    fn design(beam: &str) -> Design {
        let text = include_str!("../../../../examples/compliant/lan-table3.toml");
        let choices = Choices { variant: None, set: vec!["load.travel=40 mm".to_owned(), format!("model.beam={beam}")] };
        let mut project = Project::from_text("test.toml", text, &choices);
        let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
        crate::design::resolve(&mut spec, &mut Diagnostics::default()).unwrap()
    }

    #[test]
    fn axes_are_laid_where_the_engine_has_them() {
        for beam in ["reissner", "inextensible"] {
            let design = design(beam);
            let path = Behaviour::of(&design, &mut |_| true).unwrap().path;
            let mut axes = Axes::at_rest(&design);
            for point in [path.points.len() / 3, path.points.len() - 1].map(|i| &path.points[i]) {
                axes.move_to(point);
                let exact = point.beams.iter().flat_map(|b| (0..=CHORDS).map(|i| b.shape_m(place(i))));
                let away = exact.zip(&axes.points).map(|(p, q)| (p[0] - q[0]).abs().max((p[1] - q[1]).abs())).fold(0.0, f64::max);
                // Without stretching the axes differ by more than 1e-6 m.
                assert!(away < 1e-10, "{beam}: {away:.1e} m");
            }
        }
    }
}
