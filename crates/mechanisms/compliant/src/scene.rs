//! The mechanism as a picture: as made, and at the end of its travel with its stress in colour.

use forcewright_base::maths;
use forcewright_base::units::format_si;
use forcewright_beam::{Beam, BeamState, Drive, Image, Joint, Point, Rotation, Support};
use forcewright_model::{ColourScale, Item, Role, Scene, SupportKind};

use crate::analysis::{Behaviour, Measured};
use crate::design::Design;

/// Points drawn per beam.
const SAMPLES: usize = 49;

/// Draws a design, and its last state if there is one.
pub(crate) fn scene(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Scene {
    let last = behaviour.path.points.last();
    let artist = Artist { design, size_m: size_m(design), pitch_m: pitch_m(design) };
    let mut items = Vec::new();
    artist.mirror_line(&mut items);
    artist.envelope(&mut items);
    artist.beams(&mut items, None);
    artist.bodies(&mut items, None);
    if let Some(point) = last {
        artist.block(&mut items, point);
        artist.beams(&mut items, Some(point));
        artist.bodies(&mut items, Some(point));
    }
    artist.supports(&mut items, last);
    artist.hinges(&mut items, last);
    artist.labels(&mut items);
    if let Some(point) = last {
        artist.load(&mut items, behaviour, point);
        artist.held_loads(&mut items, point);
        artist.peak(&mut items, measured, (point, behaviour.delta_m(point)));
        artist.nearest(&mut items, measured, behaviour.delta_m(point));
    }
    artist.planes(&mut items);
    let largest = last.and_then(Point::peak_stress).map_or(0.0, |(_, peak)| peak.stress_pa);
    let limit = design.common_allowable_pa().map(|pa| (pa, "allowed".to_owned()));
    let scale_end = limit.as_ref().map_or(largest, |(pa, _)| largest.max(*pa));
    let reached = last.map_or_else(String::new, |p| format_si(behaviour.delta_m(p), &design.units.displacement, 4));
    Scene {
        items,
        scale: Some(ColourScale {
            label: "largest |σ| over both faces".to_owned(),
            display: design.units.stress.clone(),
            max: scale_end,
            limit,
        }),
        words: ["as made", "under load"],
        display: design.units.length.clone(),
        description: format!(
            "The mechanism as made (outline) and at Δ = {reached} (coloured by stress): {} beams and {} nodes{}{}.",
            design.network.beams.len(),
            design.drawn.len(),
            match design.bodies.len() {
                0 => String::new(),
                1 => ", a rigid body".to_owned(),
                n => format!(", {n} rigid bodies"),
            },
            design.layout.words()
        ),
    }
}

/// Largest extent of the drawn network, m.
fn size_m(design: &Design) -> f64 {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for beam in &design.network.beams {
        let start = design.start_m(beam);
        for i in 0..=8 {
            let p = beam.shape.point_m(f64::from(i) / 8.0);
            for k in 0..2 {
                low[k] = low[k].min(start[k] + p[k]);
                high[k] = high[k].max(start[k] + p[k]);
            }
        }
    }
    for node in &design.drawn {
        for k in 0..2 {
            low[k] = low[k].min(node.position_m[k]);
            high[k] = high[k].max(node.position_m[k]);
        }
    }
    (high[0] - low[0]).max(high[1] - low[1])
}

/// A part of a beam that is drawn as one line.
struct Piece {
    from: f64,
    to: f64,
    chords: usize,
    width_m: f64,
    rigid: bool,
}

impl Piece {
    fn place(&self, i: usize) -> f64 {
        self.from + (self.to - self.from) * i as f64 / self.chords as f64
    }
}

/// How a beam is drawn: outlined as one line; under load its rigid ends apart, and in short pieces where its thickness varies.
fn pieces(beam: &Beam, state: Option<&BeamState>) -> Vec<Piece> {
    let chords = SAMPLES - 1;
    let Some(state) = state else {
        return vec![Piece { from: 0.0, to: 1.0, chords, width_m: beam.thickness_at(0.5), rigid: false }];
    };
    let [from, to] = state.flexible();
    let width_m = |u: f64| beam.thickness_at(u);
    let mut all = Vec::new();
    if from > 0.0 {
        all.push(Piece { from: 0.0, to: from, chords: 1, width_m: width_m(0.5 * from), rigid: true });
    }
    if to < 1.0 {
        all.push(Piece { from: to, to: 1.0, chords: 1, width_m: width_m(0.5 * (to + 1.0)), rigid: true });
    }
    if beam.profile.is_empty() {
        all.push(Piece { from, to, chords, width_m: width_m(0.5), rigid: false });
        return all;
    }
    let cut = |i: usize| from + (to - from) * i as f64 / chords as f64;
    all.extend((0..chords).map(|i| Piece {
        from: cut(i),
        to: cut(i + 1),
        chords: 1,
        width_m: width_m(f64::midpoint(cut(i), cut(i + 1))),
        rigid: false,
    }));
    all
}

/// A point of the axis, at rest or under load.
fn axis_point(state: Option<&BeamState>, beam: &Beam, start: [f64; 2], u: f64) -> [f64; 2] {
    state.map_or_else(
        || {
            let p = beam.shape.point_m(u);
            [start[0] + p[0], start[1] + p[1]]
        },
        |state| state.shape_m(u),
    )
}

/// The corners of a band of a half width around points: of the square ends of a bar around two, of a polygon around more.
///
/// Each point is widened to a small square; the hull of all is the outline.
fn outline(points: Vec<[f64; 2]>, half_m: f64) -> Vec<[f64; 2]> {
    // Squares along the line through the two points that are farthest apart, so that a bar is a rectangle.
    let pairs = points.iter().enumerate().flat_map(|(i, p)| points.iter().skip(i + 1).map(move |q| [q[0] - p[0], q[1] - p[1]]));
    let longest = pairs.reduce(|a, b| if maths::hypot(b[0], b[1]) > maths::hypot(a[0], a[1]) { b } else { a }).unwrap_or([1.0, 0.0]);
    let length = maths::hypot(longest[0], longest[1]);
    let [x, y] = if length > 0.0 { longest.map(|v| half_m * v / length) } else { [half_m, 0.0] };
    let around = |p: [f64; 2]| [[x - y, y + x], [-x - y, x - y], [y - x, -x - y], [x + y, y - x]].map(|c| [p[0] + c[0], p[1] + c[1]]);
    hull(points.into_iter().flat_map(around).collect())
}

/// The corners of the convex hull of points, counterclockwise (A. M. Andrew, Information Processing Letters 9 (1979)).
pub(crate) fn hull(mut all: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let turns = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let size = all.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    all.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..]
                && turns(a, b, p) <= 1e-15 * size * size
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut all.iter().copied());
    hull.extend(half(&mut all.iter().rev().copied()));
    hull
}

struct Artist<'a> {
    design: &'a Design,
    size_m: f64,
    /// From a layer to the next one, m.
    pitch_m: f64,
}

/// Room that a layer takes along the load, m, with some air.
fn pitch_m(design: &Design) -> f64 {
    let d = design.direction;
    let along = |p: [f64; 2]| p[0] * d[0] + p[1] * d[1];
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for beam in &design.network.beams {
        let start = design.start_m(beam);
        for i in 0..SAMPLES {
            let at = along(axis_point(None, beam, start, i as f64 / (SAMPLES - 1) as f64));
            (low, high) = (low.min(at), high.max(at));
        }
    }
    let rows = design.layout.rows.map_or(0.0, |r| f64::from(r.count - 1) * along(r.step_m).abs());
    1.2 * (high - low) + rows
}

/// A vector seen in a copy.
fn turned(image: &Image, v: [f64; 2]) -> [f64; 2] {
    let (zero, tip) = (image.of([0.0, 0.0]), image.of(v));
    [tip[0] - zero[0], tip[1] - zero[1]]
}

impl Artist<'_> {
    /// The copies beside the drawn network. Each layer stands on the block of the one before, and moves with it.
    fn copies(&self, state: Option<&Point>) -> Vec<Image> {
        let layout = &self.design.layout;
        let rise_m = self.pitch_m - state.map_or(0.0, |s| s.displacement);
        let images = layout.images();
        let layer = |index: u32| {
            let by = self.design.direction.map(|d| -f64::from(index) * rise_m * d);
            images.iter().map(move |i| Image { shift_m: [i.shift_m[0] + by[0], i.shift_m[1] + by[1]], ..*i })
        };
        (0..layout.layers).flat_map(layer).skip(1).collect()
    }

    fn beams(&self, items: &mut Vec<Item>, state: Option<&Point>) {
        let copies = self.copies(state);
        for (index, beam) in self.design.network.beams.iter().enumerate() {
            let start = self.design.start_m(beam);
            let state = state.map(|s| &s.beams[index]);
            let (role, copy) =
                if state.is_some() { (Role::Deformed, Role::DeformedCopy) } else { (Role::Undeformed, Role::UndeformedCopy) };
            for piece in pieces(beam, state) {
                let (role, copy) = if piece.rigid { (Role::Rigid, Role::RigidCopy) } else { (role, copy) };
                let at = |i: usize| axis_point(state, beam, start, piece.place(i));
                let line: Vec<[f64; 2]> = (0..=piece.chords).map(at).collect();
                let values = state.filter(|_| !piece.rigid).map(|state| {
                    let stress = |i: usize| {
                        let [left, right] = state.stress_pa(piece.place(i));
                        left.abs().max(right.abs())
                    };
                    (0..=piece.chords).map(stress).collect::<Vec<_>>()
                });
                let width_m = piece.width_m;
                for image in &copies {
                    let points = line.iter().map(|p| image.of(*p)).collect();
                    items.push(Item::Line { points, width_m, role: copy, values: values.clone() });
                }
                items.push(Item::Line { points: line, width_m, role, values });
            }
        }
    }

    /// Unit vector from the mechanism into the ground at a node: against the beams that leave it.
    fn outward(&self, node: usize) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for beam in &self.design.network.beams {
            if beam.start == node {
                let (sin, cos) = maths::sin_cos(beam.shape.angle_at(0.0));
                sum = [sum[0] - cos, sum[1] - sin];
            }
            if beam.end == node {
                let (sin, cos) = maths::sin_cos(beam.shape.angle_at(1.0));
                sum = [sum[0] + cos, sum[1] + sin];
            }
        }
        let length = maths::hypot(sum[0], sum[1]);
        if length > 1e-9 { [sum[0] / length, sum[1] / length] } else { [0.0, -1.0] }
    }

    fn has_block(&self) -> bool {
        let guided = matches!(self.design.network.nodes[self.design.load_node].support, Support::Slider { rotation: Rotation::Fixed, .. });
        guided && (self.design.layout.mirror.is_some() || self.design.layout.repeats())
    }

    /// Where a node of the network is, m: moved, if there is a state.
    fn place_m(&self, node: usize, state: Option<&Point>) -> [f64; 2] {
        let [x, y] = self.design.network.nodes[node].position_m;
        state.map_or([x, y], |s| [x + s.nodes[node].displacement_m[0], y + s.nodes[node].displacement_m[1]])
    }

    /// Support symbols; what slides is where it has come to.
    fn supports(&self, items: &mut Vec<Item>, state: Option<&Point>) {
        // Of the layers behind the first, the block of the one before is the ground.
        let copies: Vec<Image> = self.design.layout.images().into_iter().skip(1).collect();
        for (index, node) in self.design.network.nodes.iter().enumerate() {
            if self.has_block() && index == self.design.load_node {
                continue;
            }
            let kind = match node.support {
                Support::Free => continue,
                Support::Clamped => SupportKind::Clamped,
                Support::Pinned => SupportKind::Pinned,
                Support::Parallel => SupportKind::Parallel,
                Support::Slider { direction, rotation } => SupportKind::Slider { direction, rotates: rotation == Rotation::Free },
            };
            let (at, outward) = (self.place_m(index, state), self.outward(index));
            items.push(Item::Support { at, kind, outward });
            for image in &copies {
                let kind = match kind {
                    SupportKind::Slider { direction, rotates } => SupportKind::Slider { direction: turned(image, direction), rotates },
                    other => other,
                };
                items.push(Item::Support { at: image.of(at), kind, outward: turned(image, outward) });
            }
        }
    }

    /// Hinges at the ends of beams, but for those on a pin, whose symbol says so.
    fn hinges(&self, items: &mut Vec<Item>, state: Option<&Point>) {
        let beams = self.design.network.beams.iter().flat_map(|b| [(b.start, b.start_joint), (b.end, b.end_joint)]);
        let mut nodes: Vec<usize> = beams.filter(|(_, joint)| *joint == Joint::Hinged).map(|(node, _)| node).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let turns =
            |n: &usize| matches!(self.design.network.nodes[*n].support, Support::Pinned | Support::Slider { rotation: Rotation::Free, .. });
        for node in nodes.into_iter().filter(|n| !turns(n)) {
            let at = self.place_m(node, state);
            items.extend(self.copies(state).iter().map(|image| Item::Hinge { at: image.of(at) }));
            items.push(Item::Hinge { at });
        }
    }

    /// Planes that the picture does not show, since it looks at one of them: around an axis, or plates behind each other. They are drawn
    /// beside it as they are seen along the load, smaller.
    fn planes(&self, items: &mut Vec<Item>) {
        let layout = &self.design.layout;
        if layout.circle.is_none() && layout.plates == 1 {
            return;
        }
        let points = || items.iter().flat_map(|i| if let Item::Line { points, .. } = i { points.as_slice() } else { &[] });
        let bound = |k: usize, f: fn(f64, f64) -> f64, start: f64| points().map(|p| p[k]).fold(start, f);
        let right_m = bound(0, f64::max, f64::NEG_INFINITY);
        let middle_m = f64::midpoint(bound(1, f64::min, f64::INFINITY), bound(1, f64::max, f64::NEG_INFINITY));
        let outlines = self.seen_along();
        let reach_m = outlines.iter().flatten().map(|p| maths::hypot(p[0], p[1])).fold(f64::MIN_POSITIVE, f64::max);
        let scale = (0.3 * self.size_m / reach_m).min(1.0);
        let centre = [right_m + 0.45 * self.size_m, middle_m];
        let place = |p: &[f64; 2]| [centre[0] + scale * p[0], centre[1] + scale * p[1]];
        for (index, corners) in outlines.iter().enumerate() {
            let role = if index == 0 { Role::Plane } else { Role::PlaneCopy };
            items.push(Item::Body { corners: corners.iter().map(place).collect(), role });
        }
        let below = [centre[0], centre[1] - scale * reach_m - 0.03 * self.size_m];
        items.push(Item::Label { at: below, text: format!("seen along the load: {} planes", outlines.len()) });
    }

    /// Every plate of a layer seen along the load, around the axis or the middle of the plates, the drawn one first.
    fn seen_along(&self) -> Vec<Vec<[f64; 2]>> {
        let layout = &self.design.layout;
        let beams = &self.design.network.beams;
        let depth_m = beams.iter().map(|b| b.section.depth_m).fold(0.0, f64::max);
        let d = self.design.direction;
        let (origin, outward) = layout.circle.map_or(([0.0; 2], [-d[1], d[0]]), |c| (c.axis_m, c.outward));
        let images = layout.images();
        let ends = beams.iter().flat_map(|b| {
            let start = self.design.start_m(b);
            (0..SAMPLES).map(move |i| axis_point(None, b, start, i as f64 / (SAMPLES - 1) as f64))
        });
        let off = |p: [f64; 2]| (p[0] - origin[0]) * outward[0] + (p[1] - origin[1]) * outward[1];
        let all: Vec<f64> = ends.flat_map(|p| images.iter().map(move |i| i.of(p))).map(off).collect();
        let (mut low, mut high) =
            (all.iter().copied().fold(f64::INFINITY, f64::min), all.iter().copied().fold(f64::NEG_INFINITY, f64::max));
        if layout.circle.is_none() {
            (low, high) = (0.5 * (low - high), 0.5 * (high - low));
        }
        let around = layout.circle.map_or(1, |c| c.count);
        let mut outlines = Vec::new();
        for leg in 0..around {
            let (sin, cos) = maths::sin_cos(std::f64::consts::TAU * f64::from(leg) / f64::from(around));
            for plate in 0..layout.plates {
                // Plates stand behind each other with some air between them.
                let at = 1.3 * depth_m * (f64::from(plate) - 0.5 * f64::from(layout.plates - 1));
                let corners =
                    [[low, at - 0.5 * depth_m], [high, at - 0.5 * depth_m], [high, at + 0.5 * depth_m], [low, at + 0.5 * depth_m]];
                outlines.push(corners.map(|[x, y]| [cos * x - sin * y, sin * x + cos * y]).to_vec());
            }
        }
        outlines
    }

    fn mirror_line(&self, items: &mut Vec<Item>) {
        let Some(mirror) = self.design.layout.mirror else { return };
        // Along the load, from well below to well above the mechanism.
        let centre = self.design.network.nodes[self.design.load_node].position_m;
        let image = mirror.image(centre);
        let middle = [f64::midpoint(centre[0], image[0]), f64::midpoint(centre[1], image[1])];
        let d = self.design.direction;
        let (back, ahead) = (0.22 * self.size_m, 1.12 * self.size_m);
        let at = |t: f64| [middle[0] + t * d[0], middle[1] + t * d[1]];
        items.push(Item::Line { points: vec![at(-back), at(ahead)], width_m: 0.0, role: Role::Construction, values: None });
    }

    /// The rigid blocks that join the copies at the moved node, one per layer. A copy that no other one in the plane faces has nothing to
    /// be joined with there.
    fn block(&self, items: &mut Vec<Item>, point: &Point) {
        if !self.has_block() || (self.design.layout.images().len() == 1 && self.design.layout.layers == 1) {
            return;
        }
        let node = self.design.load_node;
        let at = self.design.network.nodes[node].position_m;
        let d = self.design.direction;
        let height = 0.06 * self.size_m;
        let images = self.design.layout.images();
        let moved = point.nodes[node].displacement_m;
        for layer in 0..self.design.layout.layers {
            let corners = |shift: [f64; 2], rise_m: f64| {
                let up = f64::from(layer) * rise_m;
                let place = |image: &Image| {
                    let p = image.of([at[0] + shift[0], at[1] + shift[1]]);
                    [p[0] - up * d[0], p[1] - up * d[1]]
                };
                let ends = images.iter().map(place);
                ends.flat_map(|p| [p, [p[0] - height * d[0], p[1] - height * d[1]]]).collect()
            };
            items.push(Item::Body { corners: hull(corners([0.0, 0.0], self.pitch_m)), role: Role::Undeformed });
            let rise_m = self.pitch_m - point.displacement;
            let block: Vec<[f64; 2]> = corners(moved, rise_m);
            if layer + 1 < self.design.layout.layers {
                items.push(Item::Body { corners: hull([&block[..], &self.feet(layer + 1, rise_m)].concat()), role: Role::Rigid });
            }
            items.push(Item::Body { corners: hull(block), role: Role::Deformed });
        }
    }

    /// Where a layer under load stands on the one before: its held nodes and a little below them.
    fn feet(&self, layer: u32, rise_m: f64) -> Vec<[f64; 2]> {
        let d = self.design.direction;
        let up = f64::from(layer) * rise_m;
        let held = self.design.network.nodes.iter().filter(|n| matches!(n.support, Support::Clamped | Support::Pinned));
        let images = self.design.layout.images();
        let all = held.flat_map(|n| images.iter().map(|i| i.of(n.position_m)));
        let below = 0.02 * self.size_m;
        all.flat_map(|[x, y]| [up, up - below].map(|by| [x - by * d[0], y - by * d[1]])).collect()
    }

    fn labels(&self, items: &mut Vec<Item>) {
        for node in &self.design.drawn {
            items.push(Item::Label { at: node.position_m, text: node.name.clone() });
        }
    }

    fn load(&self, items: &mut Vec<Item>, behaviour: &Behaviour, point: &Point) {
        let node = self.design.load_node;
        let at = self.design.network.nodes[node].position_m;
        let centre = match self.design.layout.mirror {
            Some(mirror) if self.has_block() => {
                let image = mirror.image(at);
                [f64::midpoint(at[0], image[0]), f64::midpoint(at[1], image[1])]
            }
            _ => at,
        };
        // On the last layer, and on its last row.
        let d = self.design.direction;
        let rise_m = f64::from(self.design.layout.layers - 1) * (self.pitch_m - point.displacement);
        let rows_m = self.design.layout.rows.map_or(0.0, |r| f64::from(r.count - 1) * -(r.step_m[0] * d[0] + r.step_m[1] * d[1])).max(0.0);
        let centre = [centre[0] - (rise_m + rows_m) * d[0], centre[1] - (rise_m + rows_m) * d[1]];
        let moved = point.nodes[node].displacement_m;
        let gap = if self.has_block() { 0.07 } else { 0.02 } * self.size_m;
        let head = [centre[0] + moved[0] - gap * d[0], centre[1] + moved[1] - gap * d[1]];
        let tail = [head[0] - 0.22 * self.size_m * d[0], head[1] - 0.22 * self.size_m * d[1]];
        let units = &self.design.units;
        let label = format!(
            "F = {} at Δ = {}",
            format_si(behaviour.force_n(point), &units.force, 4),
            format_si(behaviour.delta_m(point), &units.displacement, 4)
        );
        items.push(Item::Arrow { from: tail, to: head, label });
    }

    /// Rigid bodies: the hull of their nodes, as wide as their thickest beam.
    fn bodies(&self, items: &mut Vec<Item>, state: Option<&Point>) {
        let (role, copy) = if state.is_some() { (Role::Deformed, Role::DeformedCopy) } else { (Role::Undeformed, Role::UndeformedCopy) };
        for body in &self.design.bodies {
            let at = |n: &usize| self.design.drawn.get(*n).map(|d| state.map_or(d.position_m, |point| self.design.moved_m(d, point)));
            let beams = self.design.network.beams.iter();
            let ends = beams.flat_map(|b| [(b.start, b.thickness_at(0.0)), (b.end, b.thickness_at(1.0))]);
            let thickest_m = ends.filter(|(node, _)| *node == body.node).map(|(_, w)| w).fold(0.01 * self.size_m, f64::max);
            let corners = outline(body.members.iter().filter_map(at).collect(), 0.5 * thickest_m);
            for image in self.copies(state) {
                items.push(Item::Body { corners: corners.iter().map(|p| image.of(*p)).collect(), role: copy });
            }
            items.push(Item::Body { corners, role });
        }
    }

    /// What earlier loads hold: an arrow for a force or a travel, words for what turns.
    fn held_loads(&self, items: &mut Vec<Item>, point: &Point) {
        let design = self.design;
        for (stage, drawn) in design.network.before.iter().zip(&design.loaded) {
            let Some(drawn) = design.drawn.get(*drawn) else { continue };
            let at = design.moved_m(drawn, point);
            let text = format!("held: {}", crate::statements::amount(design, &stage.drive, stage.to));
            let (Drive::Displacement { direction: d, .. } | Drive::Force { direction: d, .. }) = stage.drive else {
                items.push(Item::Label { at, text });
                continue;
            };
            // Beside the arrow of the last load, which may come the same way.
            let aside = if drawn.node == design.load_node { 0.05 * self.size_m } else { 0.0 };
            let end = |back: f64| [at[0] - back * d[0] - aside * d[1], at[1] - back * d[1] + aside * d[0]];
            let (head, tail) = (end(0.02 * self.size_m), end(0.16 * self.size_m));
            for image in self.copies(Some(point)) {
                items.push(Item::Arrow { from: image.of(tail), to: image.of(head), label: String::new() });
            }
            items.push(Item::Arrow { from: tail, to: head, label: text });
        }
    }

    fn envelope(&self, items: &mut Vec<Item>) {
        let Some(envelope) = self.design.requirements.as_ref().and_then(|r| r.asked_envelope) else { return };
        let ([left, bottom], [right, top]) = (envelope.low_m, envelope.high_m);
        // An open side has no corner to draw.
        if [left, bottom, right, top].iter().all(|v| v.is_finite()) {
            let points = vec![[left, bottom], [right, bottom], [right, top], [left, top], [left, bottom]];
            items.push(Item::Line { points, width_m: 0.0, role: Role::Envelope, values: None });
        }
    }

    /// The place where beams come nearest to each other, if the picture shows the state.
    fn nearest(&self, items: &mut Vec<Item>, measured: &Measured, delta_m: f64) {
        let Some(nearest) = measured.nearest else { return };
        let shown = nearest.at_m <= 0.0 || nearest.at_m >= delta_m * (1.0 - 1e-9);
        if shown {
            let (p, q) = (nearest.clearance.first.point_m, nearest.clearance.second.point_m);
            let at = [f64::midpoint(p[0], q[0]), f64::midpoint(p[1], q[1])];
            let label = format!("clearance {}", format_si(nearest.clearance.distance_m, &self.design.units.length, 3));
            items.push(Item::Marker { at, label });
        }
    }

    fn peak(&self, items: &mut Vec<Item>, measured: &Measured, (point, delta_m): (&Point, f64)) {
        // Marked only where the picture shows the state in which it occurs.
        let Some(largest) = measured.stress.filter(|s| s.at_m >= delta_m * (1.0 - 1e-9)) else { return };
        let at = point.beams[largest.beam].shape_m(largest.peak.u);
        items.push(Item::Marker { at, label: format!("σ max {}", format_si(largest.peak.stress_pa, &self.design.units.stress, 3)) });
    }
}
