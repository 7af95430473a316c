//! The smallest distance between the surfaces of beams in one state.
//!
//! Looked for are pairs of places on the axes whose distance is smallest among all neighbouring pairs: two places inside, an end and a
//! place inside, or two ends. Neighbours of a joint are the places on all beams that meet there; so beams that grow apart from a joint,
//! and the parts of a chain of beams, are not near each other, and the joint itself, where the distance is zero, is no such pair; nor are
//! two ends on one rigid body. From the distance of the axes goes half of either thickness: a beam is all that is within half its thickness
//! of its axis, so its ends are round.

use forcewright_base::maths;

use crate::{
    network::{Beam, Network, unit},
    state::{BeamState, Point},
};

/// Chords per axis between which pairs are looked for. Shorter waves of a beam are not seen.
const CHORDS: usize = 32;
/// Half width of the differences that give the slope and the curvature of an axis. An error of the slope moves the places, and the
/// distance only by its square.
const STEP: f64 = 1e-4;
/// Newton steps on one pair.
const ITERATIONS: usize = 60;
/// Change of a place that ends the search.
const SETTLED: f64 = 1e-13;
/// Places of one beam closer than that are the same place.
const SAME: f64 = 1e-6;
/// Distances relative to the size of the network that are none.
const TOUCH: f64 = 1e-9;
/// A pair along which the distance still falls by more than that, as part of the way, was not settled.
const STEEP: f64 = 1e-5;
/// A distance that falls less steeply than that along a beam does not fall.
const FLAT: f64 = 1e-7;

/// A line that a mechanism is mirrored on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflection {
    /// A point on it, m.
    pub point_m: [f64; 2],
    /// Its direction; any length but zero.
    pub direction: [f64; 2],
}

impl Reflection {
    /// The mirror image of a point, m.
    pub fn image(&self, point_m: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.turn([point_m[0] - self.point_m[0], point_m[1] - self.point_m[1]]);
        [self.point_m[0] + x, self.point_m[1] + y]
    }

    /// The mirror image of a vector.
    pub(crate) fn turn(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [a, b] = self.direction;
        let along = 2.0 * (a * x + b * y) / (a * a + b * b);
        [along * a - x, along * b - y]
    }
}

/// Where another copy of the network is: mirrored, shifted, or both, mirrored first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Image {
    /// The line that it is mirrored on, if it is.
    pub reflection: Option<Reflection>,
    /// How far it is shifted, m.
    pub shift_m: [f64; 2],
}

impl Image {
    /// Where a point of the network is in the copy, m.
    pub fn of(&self, point_m: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.reflection.map_or(point_m, |r| r.image(point_m));
        [x + self.shift_m[0], y + self.shift_m[1]]
    }

    /// A vector seen in the copy.
    fn turn(&self, vector: [f64; 2]) -> [f64; 2] {
        self.reflection.map_or(vector, |r| r.turn(vector))
    }

    fn is_shifted(&self) -> bool {
        self.shift_m.iter().any(|s| s.abs() > 0.0)
    }

    /// Whether a box stays parallel to the axes.
    fn keeps_axes(&self) -> bool {
        self.reflection.is_none_or(|r| r.direction[0] == 0.0 || r.direction[1] == 0.0)
    }
}

impl From<Reflection> for Image {
    fn from(reflection: Reflection) -> Self {
        Self { reflection: Some(reflection), ..Self::default() }
    }
}

/// A place on the axis of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Index of the beam.
    pub beam: usize,
    /// Where along it, in [0, 1].
    pub u: f64,
    /// There, m; of a copy there.
    pub point_m: [f64; 2],
}

/// The smallest distance between surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    /// Distance of the axes less half of both thicknesses, m; negative where the beams overlap. Axes that cross have distance zero.
    pub distance_m: f64,
    /// A place on the drawn network.
    pub first: Place,
    /// The place nearest to it.
    pub second: Place,
    /// The copy on which the second place is, by its index; `None` on the drawn network.
    pub image: Option<usize>,
}

/// The smallest distance between the surfaces of beams at rest, or in an equilibrium of the network; also to copies of it, which move
/// alike. `None` if no two places are nearest to each other, as in a single straight beam, or if the network has not passed
/// [`Network::check`]. The state must be one of this network.
///
/// The search begins at the nearest of 33 places per axis and ends at rounding; the thickness is that at the two places.
pub fn clearance(network: &Network, state: Option<&Point>, images: &[Image]) -> Option<Clearance> {
    if !is_sound(network, state, images) {
        return None;
    }
    let strands: Vec<Strand<'_>> = (0..network.beams.len()).map(|beam| Strand::new(network, state, beam)).collect();
    let joints = Joints::of(network, images);
    let search = Search { strands: &strands, joints: &joints, images, size_m: joints.size_m };
    let mut best: Option<Clearance> = None;
    for image in [None].into_iter().chain((0..images.len()).map(Some)) {
        // What a beam is to the mirror image of another one, that one is to its image; not so for what is shifted.
        let ordered = image.is_some_and(|i| images[i].is_shifted());
        for first in 0..strands.len() {
            for second in (if ordered { 0 } else { first })..strands.len() {
                search.pair(Pair { first, second, image }, &mut best);
            }
        }
    }
    best
}

/// The same pair of places in another state, or of the beams between them what has become of it; `None` where no two places of those
/// beams are nearest to each other any more. Cheaper than [`clearance`], but another pair may have become nearer.
pub fn clearance_near(network: &Network, state: Option<&Point>, images: &[Image], known: &Clearance) -> Option<Clearance> {
    if !is_sound(network, state, images) {
        return None;
    }
    let strands: Vec<Strand<'_>> = (0..network.beams.len()).map(|beam| Strand::bare(network, state, beam)).collect();
    let joints = Joints::of(network, images);
    let search = Search { strands: &strands, joints: &joints, images, size_m: joints.size_m };
    let pair = Pair { first: known.first.beam, second: known.second.beam, image: known.image };
    if pair.first.max(pair.second) >= strands.len() || known.image.is_some_and(|i| i >= images.len()) {
        return None;
    }
    search.settle(pair, [known.first.u, known.second.u])
}

/// Whether nodes exist, the state has all beams, and mirror lines have a direction.
fn is_sound(network: &Network, state: Option<&Point>, images: &[Image]) -> bool {
    let nodes = network.nodes.len();
    network.beams.iter().all(|b| b.start < nodes && b.end < nodes)
        && state.is_none_or(|s| s.beams.len() == network.beams.len())
        && images.iter().all(|i| i.reflection.is_none_or(|r| unit(r.direction).is_some()) && i.shift_m.iter().all(|s| s.is_finite()))
}

/// Half the thickness of a beam at a place, m.
fn half_thickness_m(network: &Network, beam: usize, u: f64) -> f64 {
    0.5 * network.beams[beam].thickness_at(u)
}

/// The axis of a beam in a state.
struct Strand<'a> {
    network: &'a Network,
    beam: usize,
    state: Option<&'a BeamState>,
    points: Vec<[f64; 2]>,
    low: [f64; 2],
    high: [f64; 2],
    /// Largest half thickness, m.
    half_m: f64,
    /// Longest chord between two samples, m.
    chord_m: f64,
}

impl<'a> Strand<'a> {
    /// Without samples.
    fn bare(network: &'a Network, state: Option<&'a Point>, beam: usize) -> Self {
        Self {
            network,
            beam,
            state: state.and_then(|s| s.beams.get(beam)),
            points: Vec::new(),
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
            half_m: 0.0,
            chord_m: 0.0,
        }
    }

    fn new(network: &'a Network, state: Option<&'a Point>, beam: usize) -> Self {
        let mut strand = Self::bare(network, state, beam);
        let points = strand.sampled();
        for (i, point) in points.iter().enumerate() {
            for (k, value) in point.iter().enumerate() {
                strand.low[k] = strand.low[k].min(*value);
                strand.high[k] = strand.high[k].max(*value);
            }
            strand.half_m = strand.half_m.max(half_thickness_m(network, beam, place(i)));
        }
        strand.chord_m = points.windows(2).map(|w| distance(w[0], w[1])).fold(0.0, f64::max);
        strand.points = points;
        strand
    }

    /// Samples of the axis, near enough to begin a search: laid from its angle, and stretched to its exact end.
    fn sampled(&self) -> Vec<[f64; 2]> {
        // Gauss–Legendre rule of two points on a chord.
        const PLACES: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
        let half_chord = 0.5 * self.network.beams[self.beam].shape.length_m() / CHORDS as f64;
        let mut at = self.at(0.0);
        let mut points = Vec::with_capacity(CHORDS + 1);
        points.push(at);
        for i in 0..CHORDS {
            for within in PLACES {
                let (sin, cos) = maths::sin_cos(self.angle_rad((i as f64 + within) / CHORDS as f64));
                at = [at[0] + half_chord * cos, at[1] + half_chord * sin];
            }
            points.push(at);
        }
        let end = self.at(1.0);
        let off = [end[0] - at[0], end[1] - at[1]];
        for (i, point) in points.iter_mut().enumerate() {
            *point = [point[0] + place(i) * off[0], point[1] + place(i) * off[1]];
        }
        points
    }

    fn angle_rad(&self, u: f64) -> f64 {
        self.state.map_or_else(|| self.network.beams[self.beam].shape.angle_at(u), |s| s.angle_rad(u))
    }

    fn at(&self, u: f64) -> [f64; 2] {
        if let Some(state) = self.state {
            return state.shape_m(u);
        }
        let beam = &self.network.beams[self.beam];
        let ([x, y], [a, b]) = (self.network.nodes[beam.start].position_m, beam.arms_m[0]);
        let point = beam.shape.point_m(u);
        [x + a + point[0], y + b + point[1]]
    }

    /// From one place to another next to it, m.
    fn step(&self, from: f64, to: f64) -> [f64; 2] {
        if let Some(state) = self.state {
            return state.step_m(from, to);
        }
        let [a, b] = [from, to].map(|u| self.at(u));
        [b[0] - a[0], b[1] - a[1]]
    }

    /// Position, slope and curvature by u.
    fn jet(&self, u: f64) -> [[f64; 2]; 3] {
        let centre = u.clamp(STEP, 1.0 - STEP);
        let point = self.at(u);
        let [back, on] = [self.step(centre, centre - STEP), self.step(centre, centre + STEP)];
        let second = [0, 1].map(|k| (on[k] + back[k]) / (STEP * STEP));
        let first = [0, 1].map(|k| (on[k] - back[k]) / (2.0 * STEP) + second[k] * (u - centre));
        [point, first, second]
    }

    /// Unit vector along the beam away from one of its ends.
    fn away(&self, end: usize) -> [f64; 2] {
        let [x, y] = if end == 0 { self.step(0.0, STEP) } else { self.step(1.0, 1.0 - STEP) };
        let length = maths::hypot(x, y);
        [x / length, y / length]
    }
}

/// Which ends are at the same place.
struct Joints {
    /// Per beam and end: the number of its place.
    place: Vec<[usize; 2]>,
    /// Per beam and end: the node, which as a rigid body joins ends at different places.
    node: Vec<[usize; 2]>,
    /// Per copy and place: whether it is at the same place there, as on a mirror line.
    shared: Vec<Vec<bool>>,
    size_m: f64,
}

impl Joints {
    fn of(network: &Network, images: &[Image]) -> Self {
        let lengths = network.beams.iter().map(|b| b.shape.length_m());
        let size_m = lengths.fold(0.0, f64::max);
        // Ends on the arms of a rigid body are where the arms end; two clamps at the same place are one place of the ground.
        let mut known: Vec<[f64; 2]> = Vec::new();
        let mut number = |at: [f64; 2]| {
            let found = known.iter().position(|p| distance(*p, at) <= TOUCH * size_m);
            found.unwrap_or_else(|| {
                known.push(at);
                known.len() - 1
            })
        };
        let ends = |b: &Beam| [(b.start, b.arms_m[0]), (b.end, b.arms_m[1])];
        let end = |(node, arm): (usize, [f64; 2])| [0, 1].map(|i| network.nodes[node].position_m[i] + arm[i]);
        let place = network.beams.iter().map(|b| ends(b).map(|e| number(end(e)))).collect();
        let node = network.beams.iter().map(|b| [b.start, b.end]).collect();
        let stays = |image: &Image| known.iter().map(|p| distance(image.of(*p), *p) <= TOUCH * size_m).collect();
        let shared = images.iter().map(stays).collect();
        Self { place, node, shared, size_m }
    }
}

/// Two axes, the second perhaps of a copy.
#[derive(Clone, Copy)]
struct Pair {
    first: usize,
    second: usize,
    image: Option<usize>,
}

struct Search<'a> {
    strands: &'a [Strand<'a>],
    joints: &'a Joints,
    images: &'a [Image],
    size_m: f64,
}

impl Search<'_> {
    fn image(&self, pair: Pair, point: [f64; 2]) -> [f64; 2] {
        pair.image.map_or(point, |i| self.images[i].of(point))
    }

    /// A direction seen in the copy.
    fn turned(&self, pair: Pair, vector: [f64; 2]) -> [f64; 2] {
        pair.image.map_or(vector, |i| self.images[i].turn(vector))
    }

    /// Whether a joint is at the same place in the copy.
    fn is_shared(&self, pair: Pair, joint: usize) -> bool {
        pair.image.is_some_and(|i| self.joints.shared[i][joint])
    }

    /// The smallest distance of a pair of beams, where it is below the best so far.
    fn pair(&self, pair: Pair, best: &mut Option<Clearance>) {
        let (one, other) = (&self.strands[pair.first], &self.strands[pair.second]);
        let halves = one.half_m + other.half_m;
        let corners = [self.image(pair, other.low), self.image(pair, other.high)];
        let skewed = pair.image.is_some_and(|i| !self.images[i].keeps_axes());
        let limit = |best: &Option<Clearance>| best.map_or(f64::INFINITY, |b| b.distance_m + halves);
        if !skewed && apart(one, corners) >= limit(best) {
            return;
        }
        let points: Vec<[f64; 2]> = other.points.iter().map(|p| self.image(pair, *p)).collect();
        let symmetric = pair.first == pair.second && !pair.image.is_some_and(|i| self.images[i].is_shifted());
        for (i, j, distance_m) in least(&one.points, &points, symmetric) {
            if pair.first == pair.second && pair.image.is_none() && i == j {
                continue;
            }
            // Between the samples it can be nearer by about a chord.
            if distance_m - one.chord_m - other.chord_m >= limit(best) {
                continue;
            }
            let Some(found) = self.settle(pair, [place(i), place(j)]) else { continue };
            if best.is_none_or(|b| found.distance_m < b.distance_m) {
                *best = Some(found);
            }
        }
    }

    /// The local minimum reached from two places; `None` if it is a joint or is none on the whole network.
    fn settle(&self, pair: Pair, start: [f64; 2]) -> Option<Clearance> {
        let (one, other) = (&self.strands[pair.first], &self.strands[pair.second]);
        let gap = |[u, v]: [f64; 2]| {
            let (p, q) = (one.at(u), self.image(pair, other.at(v)));
            [p[0] - q[0], p[1] - q[1]]
        };
        let square = |places| {
            let [x, y] = gap(places);
            x * x + y * y
        };
        let mut places = start;
        let mut value = square(places);
        for _ in 0..ITERATIONS {
            let (a, b) = (one.jet(places[0]), other.jet(places[1]));
            let (b1, b2) = (self.turned(pair, b[1]), self.turned(pair, b[2]));
            let d = gap(places);
            let gradient = [dot(d, a[1]), -dot(d, b1)];
            let hessian = [dot(a[1], a[1]) + dot(d, a[2]), -dot(a[1], b1), dot(b1, b1) - dot(d, b2)];
            let scale = [dot(a[1], a[1]), dot(b1, b1)];
            let step = newton_step(places, gradient, hessian, scale);
            // Along the step the square falls by twice that: less is rounding.
            if -dot(gradient, step) <= 1e-16 * value {
                break;
            }
            let mut share = 1.0;
            let mut moved = 0.0_f64;
            while share > 1e-6 {
                let next = [0, 1].map(|k| (places[k] + share * step[k]).clamp(0.0, 1.0));
                let reached = square(next);
                if reached < value {
                    moved = (0..2).map(|k| (next[k] - places[k]).abs()).fold(0.0, f64::max);
                    (places, value) = (next, reached);
                    break;
                }
                share *= 0.5;
            }
            if moved <= SETTLED {
                break;
            }
        }
        // So near to an end it is the end.
        let places = places.map(|u| {
            if u < SAME {
                0.0
            } else if u > 1.0 - SAME {
                1.0
            } else {
                u
            }
        });
        let (a, b, d) = (one.jet(places[0]), other.jet(places[1]), gap(places));
        let slopes = [dot(d, a[1]) / maths::hypot(a[1][0], a[1][1]), -dot(d, self.turned(pair, b[1])) / maths::hypot(b[1][0], b[1][1])];
        let slack = STEEP * maths::hypot(d[0], d[1]) + TOUCH * self.size_m;
        let falls = (0..2).any(|k| (places[k] > 0.0 && slopes[k] > slack) || (places[k] < 1.0 && slopes[k] < -slack));
        if falls { None } else { self.judge(pair, places) }
    }

    /// Whether a local minimum on two beams is one on the whole network, and its distance.
    fn judge(&self, pair: Pair, [u, v]: [f64; 2]) -> Option<Clearance> {
        let (one, other) = (&self.strands[pair.first], &self.strands[pair.second]);
        if pair.first == pair.second && pair.image.is_none() && (u - v).abs() < SAME {
            return None;
        }
        let (p, q) = (one.at(u), self.image(pair, other.at(v)));
        let (node, other_node) = (self.joint_at(pair.first, u), self.joint_at(pair.second, v));
        let axes_m = distance(p, q);
        if let (Some(a), Some(b)) = (node, other_node)
            && a == b
            && (pair.image.is_none() || self.is_shared(pair, a))
        {
            return None;
        }
        // Two ends on a rigid body stay as far apart as they were made.
        let body = |beam: usize, u: f64| end_at(u).map(|end| self.joints.node[beam][end]);
        if pair.image.is_none() && body(pair.first, u).is_some_and(|a| body(pair.second, v) == Some(a)) {
            return None;
        }
        // A beam that meets its image on the line does so in one joint.
        if pair.first == pair.second && axes_m <= TOUCH * self.size_m && node.is_some_and(|n| self.is_shared(pair, n)) {
            return None;
        }
        if axes_m > TOUCH * self.size_m {
            let towards = [(q[0] - p[0]) / axes_m, (q[1] - p[1]) / axes_m];
            let back = self.turned(pair, towards);
            let comes_nearer = |node: Option<usize>, towards: [f64; 2]| {
                node.is_some_and(|n| self.leaving(pair, n).any(|along| dot(along, towards) > FLAT))
            };
            // A reflection is its own inverse: what the image sees is turned back.
            if comes_nearer(node, towards) || comes_nearer(other_node, [-back[0], -back[1]]) {
                return None;
            }
        }
        let network = one.network;
        let halves = half_thickness_m(network, pair.first, u) + half_thickness_m(network, pair.second, v);
        Some(Clearance {
            distance_m: axes_m - halves,
            first: Place { beam: pair.first, u, point_m: p },
            second: Place { beam: pair.second, u: v, point_m: q },
            image: pair.image,
        })
    }

    /// The number of the joint at a place, if it is an end.
    fn joint_at(&self, beam: usize, u: f64) -> Option<usize> {
        end_at(u).map(|end| self.joints.place[beam][end])
    }

    /// Unit vectors along all beams that leave a joint, with those of the copy if it shares the joint.
    fn leaving(&self, pair: Pair, joint: usize) -> impl Iterator<Item = [f64; 2]> {
        let shared = self.is_shared(pair, joint);
        self.strands.iter().flat_map(move |strand| {
            let ends = (0..2).filter(move |end| self.joints.place[strand.beam][*end] == joint);
            ends.flat_map(move |end| {
                let along = strand.away(end);
                let image = shared.then(|| self.turned(pair, along));
                [Some(along), image].into_iter().flatten()
            })
        })
    }
}

/// Which end a place is, if it is one.
fn end_at(u: f64) -> Option<usize> {
    if u <= 0.0 {
        Some(0)
    } else if u >= 1.0 {
        Some(1)
    } else {
        None
    }
}

/// A step of Newton's method on half the squared distance; places at an end stay there where the distance falls beyond it. The matrix
/// is made positive definite, so that the step leads down.
fn newton_step(places: [f64; 2], gradient: [f64; 2], [a, b, c]: [f64; 3], scale: [f64; 2]) -> [f64; 2] {
    let held = [0, 1].map(|k| (places[k] <= 0.0 && gradient[k] > 0.0) || (places[k] >= 1.0 && gradient[k] < 0.0));
    let alone = |k: usize, curvature: f64| -gradient[k] / curvature.max(1e-3 * scale[k]);
    match held {
        [true, true] => [0.0; 2],
        [true, false] => [0.0, alone(1, c)],
        [false, true] => [alone(0, a), 0.0],
        [false, false] => {
            let mut damping = 0.0;
            loop {
                let (a, c) = (a + damping * scale[0], c + damping * scale[1]);
                let determinant = a * c - b * b;
                if a > 0.0 && determinant > 1e-9 * scale[0] * scale[1] {
                    return [(b * gradient[1] - c * gradient[0]) / determinant, (b * gradient[0] - a * gradient[1]) / determinant];
                }
                damping = 1e-6_f64.max(4.0 * damping);
                if damping > 1e9 {
                    return [0.0; 2];
                }
            }
        }
    }
}

/// Samples of two axes that are nearer to each other than all pairs of neighbours are. Of one axis with itself, or with its image, only
/// pairs in ascending order.
fn least(one: &[[f64; 2]], other: &[[f64; 2]], ordered: bool) -> Vec<(usize, usize, f64)> {
    let (rows, columns) = (one.len(), other.len());
    let mut squares = Vec::with_capacity(rows * columns);
    for p in one {
        squares.extend(other.iter().map(|q| (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1])));
    }
    let mut found = Vec::new();
    for i in 0..rows {
        for j in if ordered { i } else { 0 }..columns {
            let value = squares[i * columns + j];
            let is_least = (i.saturating_sub(1)..(i + 2).min(rows))
                .all(|k| squares[k * columns..][..columns][j.saturating_sub(1)..(j + 2).min(columns)].iter().all(|n| *n >= value));
            if is_least {
                found.push((i, j, value.sqrt()));
            }
        }
    }
    found
}

/// Distance between the frame of a strand and that of two corners, m.
fn apart(strand: &Strand<'_>, [a, b]: [[f64; 2]; 2]) -> f64 {
    let side = |k: usize| (strand.low[k] - a[k].max(b[k])).max(a[k].min(b[k]) - strand.high[k]).max(0.0);
    maths::hypot(side(0), side(1))
}

fn place(i: usize) -> f64 {
    i as f64 / CHORDS as f64
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    maths::hypot(a[0] - b[0], a[1] - b[1])
}
