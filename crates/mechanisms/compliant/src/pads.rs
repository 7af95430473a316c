//! Pads and blocks of the part against what moves: the smallest distance over the travel.
//!
//! The network knows beams only. The part has material where beams are held and where rigid bodies are, and a beam, or a block, may run
//! into that of another one although no two beams meet.

use forcewright_base::maths;
use forcewright_base::units::{Dimension, format_si};
use forcewright_beam::{Image, Point};
use forcewright_curves::outline::Joint;
use forcewright_model::{Check, CheckState, Sense};

use crate::analysis::Behaviour;
use crate::crossing::{axes_m, thickest_m};
use crate::design::Design;
use crate::parts::{Drawing, Solid};

/// States looked at besides rest, with the beams as chords: a distance is wrong by no more than their height over the axis. They are
/// those of the path, and none is solved anew: this is done for every design of a sweep.
const STATES: usize = 32;
/// Motions below that part of the travel are none.
const STILL: f64 = 1e-6;

/// The smallest distance of a beam or a block to a pad or block in which it does not end.
#[derive(Clone, Copy, Debug, PartialEq)]
struct NearPad {
    /// Displacement, m.
    at_m: f64,
    /// What comes near: the index of a beam, or else of a solid.
    beam: Option<usize>,
    other: usize,
    /// The solid that it comes near to.
    solid: usize,
    /// The distance, m; negative where they overlap.
    distance_m: f64,
}

/// A convex polygon or an open line, with the box around it.
struct Shape {
    points: Vec<[f64; 2]>,
    closed: bool,
    low: [f64; 2],
    high: [f64; 2],
    /// Half the thickness around it, m.
    half_m: f64,
}

impl Shape {
    fn new(points: Vec<[f64; 2]>, closed: bool, half_m: f64) -> Self {
        let bound = |k: usize, f: fn(f64, f64) -> f64, start: f64| points.iter().map(|p| p[k]).fold(start, f);
        let low = [0, 1].map(|k| bound(k, f64::min, f64::INFINITY) - half_m);
        let high = [0, 1].map(|k| bound(k, f64::max, f64::NEG_INFINITY) + half_m);
        Self { points, closed, low, high, half_m }
    }

    fn edges(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        let count = self.points.len();
        (0..if self.closed { count } else { count.saturating_sub(1) }).map(move |i| [self.points[i], self.points[(i + 1) % count]])
    }

    fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let right = |[[ax, ay], [bx, by]]: [[f64; 2]; 2]| (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax);
        self.closed && self.edges().filter(|e| right(*e)).count() % 2 == 1
    }

    /// At least this far apart, m.
    fn apart_m(&self, other: &Self) -> f64 {
        let off = |k: usize| (other.low[k] - self.high[k]).max(self.low[k] - other.high[k]).max(0.0);
        maths::hypot(off(0), off(1))
    }

    /// How far a convex polygon and another one are apart along the best of its normals, m: less than nothing where they overlap.
    fn separation_m(&self, other: &Self) -> f64 {
        let area = self.edges().map(|[a, b]| a[0] * b[1] - a[1] * b[0]).sum::<f64>();
        let beyond = |[a, b]: [[f64; 2]; 2]| {
            let (length, sign) = (maths::hypot(b[0] - a[0], b[1] - a[1]), area.signum());
            let normal = [sign * (b[1] - a[1]) / length, sign * (a[0] - b[0]) / length];
            other.points.iter().map(|p| (p[0] - a[0]) * normal[0] + (p[1] - a[1]) * normal[1]).fold(f64::INFINITY, f64::min)
        };
        self.edges().map(beyond).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Distance of the surfaces, m; less than nothing where they overlap.
    fn distance_m(&self, other: &Self) -> f64 {
        if self.closed && other.closed {
            let deep_m = self.separation_m(other).max(other.separation_m(self));
            if deep_m <= 0.0 {
                return deep_m;
            }
        }
        let inside = other.contains(self.points[0]) || self.contains(other.points[0]);
        let pairs = self.edges().flat_map(|a| other.edges().map(move |b| between(a, b)));
        let axes_m = pairs.fold(f64::INFINITY, f64::min);
        (if inside { -axes_m } else { axes_m }) - self.half_m - other.half_m
    }
}

/// Distance of two straight pieces, m.
fn between(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> f64 {
    let cross = |u: [f64; 2], v: [f64; 2]| u[0] * v[1] - u[1] * v[0];
    let sub = |p: [f64; 2], q: [f64; 2]| [p[0] - q[0], p[1] - q[1]];
    let (d, e, off) = (sub(a[1], a[0]), sub(b[1], b[0]), sub(b[0], a[0]));
    let n = cross(d, e);
    let (s, t) = (cross(off, e) / n, cross(off, d) / n);
    if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
        return 0.0;
    }
    let to = |p: [f64; 2], [from, end]: [[f64; 2]; 2]| {
        let (along, off) = (sub(end, from), sub(p, from));
        let square = along[0] * along[0] + along[1] * along[1];
        let part = if square > 0.0 { ((off[0] * along[0] + off[1] * along[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
        maths::hypot(off[0] - part * along[0], off[1] - part * along[1])
    };
    [to(a[0], b), to(a[1], b), to(b[0], a), to(b[1], a)].into_iter().fold(f64::INFINITY, f64::min)
}

/// Where a solid is in a state, m: its copy moves as its node does.
fn moved(design: &Design, solid: &Solid, image: &Image, point: &Point) -> Vec<[f64; 2]> {
    let state = &point.nodes[solid.node];
    let at = design.network.nodes[solid.node].position_m;
    let (from, to) = (image.of(at), image.of([at[0] + state.displacement_m[0], at[1] + state.displacement_m[1]]));
    let hand = if image.reflection.is_some() { -1.0 } else { 1.0 };
    let (sin, cos) = maths::sin_cos(hand * state.rotation_rad);
    let turn = |[x, y]: &[f64; 2]| {
        let [x, y] = [x - from[0], y - from[1]];
        [to[0] + cos * x - sin * y, to[1] + sin * x + cos * y]
    };
    solid.corners_m.iter().map(turn).collect()
}

/// The solids and the beams of a design, as they are looked at in every state.
struct Neighbours<'a> {
    design: &'a Design,
    drawing: &'a Drawing<'a>,
    /// Shifts of the rows beside the drawn one, and none.
    rows_m: Vec<[f64; 2]>,
    /// Per solid: whether it stays where it is.
    still: Vec<bool>,
}

impl Neighbours<'_> {
    /// The smallest distance in a state, if it is less than the one known.
    fn nearer(&self, point: &Point, at_m: f64, known: Option<NearPad>) -> Option<NearPad> {
        let (design, drawing) = (self.design, self.drawing);
        let solids: Vec<Vec<[f64; 2]>> = drawing.solids.iter().map(|s| moved(design, s, &drawing.images[s.copies[0]], point)).collect();
        let axes = axes_m(design, point).into_iter().zip(&design.network.beams);
        let beams: Vec<Shape> = axes.map(|(axis, beam)| Shape::new(axis, false, 0.5 * thickest_m(beam))).collect();
        let own: Vec<Shape> = solids.iter().map(|s| Shape::new(s.clone(), true, 0.0)).collect();
        let mut best = known;
        for [dx, dy] in &self.rows_m {
            let drawn = *dx == 0.0 && *dy == 0.0;
            for (index, corners) in solids.iter().enumerate() {
                let shape = Shape::new(corners.iter().map(|[x, y]| [x + dx, y + dy]).collect(), true, 0.0);
                let ends = |b: usize| drawn && drawing.ends[0][b].contains(&Joint::Block(index));
                let near_beams = beams.iter().enumerate().filter(|(b, _)| !ends(*b)).map(|(b, s)| (Some(b), 0, s));
                let other = |s: usize| {
                    drawing.solids[s].node != drawing.solids[index].node && !(self.still[s] && self.still[index]) && (s < index || !drawn)
                };
                let near_solids = own.iter().enumerate().filter(|(s, _)| other(*s)).map(|(s, shape)| (None, s, shape));
                for (beam, other, near) in near_beams.chain(near_solids) {
                    // Boxes that overlap say nothing of how deeply their contents do.
                    let apart_m = near.apart_m(&shape);
                    if apart_m > 0.0 && best.is_some_and(|b| apart_m >= b.distance_m) {
                        continue;
                    }
                    let distance_m = near.distance_m(&shape);
                    if best.is_none_or(|b| distance_m < b.distance_m) {
                        best = Some(NearPad { at_m, beam, other, solid: index, distance_m });
                    }
                }
            }
        }
        best
    }
}

/// COMP013: whether nothing runs into a pad or a block over the travel. `None` where the design has none, or is no part at all.
/// It is `required` of a part that is made, and of a design that says how its pads are made.
pub(crate) fn check(design: &Design, behaviour: &Behaviour, required: bool) -> Option<Check> {
    let drawing = Drawing::new(design).ok()?;
    let step_m = design.layout.rows.map(|r| r.step_m);
    let rows_m = [[0.0; 2]].into_iter().chain(step_m.into_iter().flat_map(|s| [s, s.map(|v| -v)])).collect();
    let last = behaviour.path.points.last()?;
    let still = drawing.solids.iter().map(|s| {
        let state = &last.nodes[s.node];
        let shift = maths::hypot(state.displacement_m[0], state.displacement_m[1]);
        shift <= STILL * last.displacement.abs() && state.rotation_rad.abs() <= STILL
    });
    let neighbours = Neighbours { design, drawing: &drawing, rows_m, still: still.collect() };
    let points = &behaviour.path.points;
    let (end, states) = (points.len() - 1, (points.len() - 1).clamp(1, STATES));
    let nearer = |best, i: usize| {
        let point = &points[i * end / states];
        neighbours.nearer(point, behaviour.delta_m(point), best)
    };
    let found = (0..=states).fold(None, nearer)?;
    let units = &design.units;
    let name = |s: usize| drawing.solids.get(s).map_or("?", |s| s.name.as_str());
    let what = match found.beam {
        Some(beam) => format!("beam {}", design.beam_names.get(beam).map_or("?", String::as_str)),
        None => format!("the block at {}", name(found.other)),
    };
    let met = found.distance_m >= 0.0;
    let partial = !behaviour.whole && met;
    let state = match (met, partial) {
        (_, true) => CheckState::NotAssessed,
        (true, _) => CheckState::Met,
        (false, _) => CheckState::Missed,
    };
    let place = format!("{what} to the pad or block at {}, Δ = {}", name(found.solid), format_si(found.at_m, &units.displacement, 4));
    Some(Check {
        code: "COMP013",
        name: "pads".to_owned(),
        title: format!("Distance to pads and blocks ({place})"),
        required,
        state,
        value: Some(found.distance_m).filter(|_| !partial),
        limit: Some(0.0),
        sense: Sense::AtLeast,
        dimension: Dimension::Length,
        display: units.length.clone(),
        margin: None,
        basis: "surfaces of beams and blocks to pads and blocks that they do not end in, at rest and over the travel".to_owned(),
        advice: match state {
            CheckState::Met => None,
            CheckState::Missed => Some(format!("{what} runs into it: make `parts.pad` smaller, move a node, or shorten the travel")),
            CheckState::NotAssessed => Some("the path ends before the full travel; see the status".to_owned()),
        },
    })
}
