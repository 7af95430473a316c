//! From the graph to its faces: joints, trimmed sides, closed boundaries, regions.

use super::block::Border;
use super::node::{self, Turn};
use super::walk::Walk;
use super::{Boundary, Joint, Network, Outline, OutlineError, Region, Tag};
use crate::chords;
use crate::piece::Piece;
use crate::profile::{Profile, Segment};
use crate::vector::{angle, cross, dot};

/// Lengths of the order of rounding, relative to the size of the network.
const EXACT: f64 = 1e-11;
/// Ends of sides in line that are one point, relative to the tolerance of the fit.
const JOIN: f64 = 1e-3;
/// Chords in which the result is looked at for boundaries that meet, relative to the size of the network, at least.
const LOOK: f64 = 1e-6;
/// Halvings in the search for the largest radius that fits.
const HALVINGS: usize = 40;
/// Directions that differ by less, rad, are the same; then the curvature decides which strip comes first.
const SAME_RAD: f64 = 1e-9;
/// The direction opposite to which the order round a node begins: one that strips seldom leave in.
const CUT: [f64; 2] = [-0.83, 0.56];

pub(super) fn outline(network: &Network, tolerance_m: f64) -> Result<Outline, OutlineError> {
    let faces = Faces::new(network, tolerance_m)?;
    let turns = faces.turns()?;
    let mut boundaries = Vec::new();
    let mut fit_error_m: f64 = 0.0;
    let mut seen = vec![false; faces.walks.len()];
    for first in 0..faces.walks.len() {
        let mut drawn = Drawn::default();
        let mut walk = first;
        while !seen[walk] {
            seen[walk] = true;
            let before = faces.before[walk];
            let (from, to) = (turns[before].at[1], turns[walk].at[0]);
            let side = &faces.walks[walk];
            if drawn.profile.is_none() {
                drawn.begin(side.side(from).point_m);
            }
            let (segments, error_m) = side.trimmed(from, to, faces.exact_m, tolerance_m)?;
            fit_error_m = fit_error_m.max(error_m);
            for segment in segments {
                drawn.push(segment, side.tag());
            }
            turns[walk].path.iter().for_each(|(piece, tag)| drawn.push(segment_of(piece), *tag));
            walk = faces.next[walk];
        }
        if let Some(boundary) = drawn.close() {
            boundaries.push((faces.part_of[first / 2], boundary));
        }
    }
    for (block, border) in faces.borders.iter().enumerate() {
        if !network.strips.iter().any(|strip| strip.ends.contains(&Joint::Block(block))) {
            let mut drawn = Drawn::default();
            drawn.begin(border.pieces[0].0.from());
            border.pieces.iter().for_each(|(piece, tag)| drawn.push(segment_of(piece), *tag));
            boundaries.extend(drawn.close().map(|boundary| (network.strips.len() + block, boundary)));
        }
    }
    let regions = regions(boundaries, tolerance_m.max(LOOK * faces.exact_m / EXACT))?;
    Ok(Outline { regions, fit_error_m })
}

fn segment_of(piece: &Piece) -> Segment {
    match *piece {
        Piece::Arc { to, centre, sweep_rad, .. } => Segment::Arc { to_m: to, centre_m: centre, counterclockwise: sweep_rad > 0.0 },
        _ => Segment::Line { to_m: piece.to() },
    }
}

/// A boundary that grows.
#[derive(Default)]
struct Drawn {
    profile: Option<Profile>,
    tags: Vec<Tag>,
}

impl Drawn {
    fn begin(&mut self, start_m: [f64; 2]) {
        self.profile = Some(Profile { start_m, segments: Vec::new() });
    }

    /// A spline begins where the segment before ends, to the last bit.
    fn push(&mut self, mut segment: Segment, tag: Tag) {
        if let Some(profile) = &mut self.profile {
            if let Segment::Spline(spline) = &mut segment {
                spline.control_m[0] = profile.segments.last().map_or(profile.start_m, Segment::end_m);
            }
            profile.segments.push(segment);
            self.tags.push(tag);
        }
    }

    /// Makes the last segment end in the start to the last bit.
    fn close(self) -> Option<Boundary> {
        let mut profile = self.profile?;
        let start_m = profile.start_m;
        match profile.segments.last_mut()? {
            Segment::Line { to_m } | Segment::Arc { to_m, .. } => *to_m = start_m,
            Segment::Spline(spline) => *spline.control_m.last_mut()? = start_m,
        }
        Some(Boundary { profile, tags: self.tags })
    }
}

/// The graph: every strip is passed twice, once in each direction; walk `2 k` is strip `k` from its start, `2 k + 1` from its end.
struct Faces<'a> {
    network: &'a Network<'a>,
    walks: Vec<Walk<'a>>,
    /// The walk that follows on the boundary, and the one before.
    next: Vec<usize>,
    before: Vec<usize>,
    borders: Vec<Border>,
    /// Places on borders: of each walk that begins in a block.
    anchors: Vec<f64>,
    /// Per walk: whether the next one is found by going on past the first place of the border.
    wraps: Vec<bool>,
    /// Per strip: the first strip of its connected part.
    part_of: Vec<usize>,
    exact_m: f64,
    /// Ends of sides that near are one point, m.
    join_m: f64,
}

impl<'a> Faces<'a> {
    fn new(network: &'a Network<'a>, tolerance_m: f64) -> Result<Self, OutlineError> {
        let exact_m = EXACT * network.extent_m();
        let walks: Vec<Walk> = network
            .strips
            .iter()
            .enumerate()
            .flat_map(|(index, strip)| [false, true].map(|reversed| Walk { strip, index, reversed }))
            .collect();
        let borders: Vec<Border> =
            network.blocks.iter().enumerate().map(|(k, block)| Border::new(k, block, exact_m)).collect::<Result<_, _>>()?;
        let mut anchors = vec![0.0; walks.len()];
        for (walk, anchor) in walks.iter().zip(&mut anchors) {
            if let Joint::Block(block) = walk.start() {
                let missing = OutlineError::NoMeeting { strip: walk.index, block };
                *anchor = borders[block].anchor(walk, tolerance_m, exact_m).ok_or(missing)?;
            }
        }
        let part_of = connected(network);
        let count = walks.len();
        let mut faces = Self {
            network,
            walks,
            next: vec![0; count],
            before: vec![0; count],
            borders,
            anchors,
            wraps: vec![false; count],
            part_of,
            exact_m,
            join_m: exact_m.max(JOIN * tolerance_m),
        };
        let joints = (0..network.nodes.len()).map(Joint::Node).chain((0..network.blocks.len()).map(Joint::Block));
        joints.for_each(|joint| faces.link(joint));
        Ok(faces)
    }

    /// Which walk follows which round a joint.
    fn link(&mut self, joint: Joint) {
        let mut leaving: Vec<usize> = (0..self.walks.len()).filter(|walk| self.walks[*walk].start() == joint).collect();
        self.sort(joint, &mut leaving);
        for (k, &walk) in leaving.iter().enumerate() {
            let after = leaving[(k + 1) % leaving.len()];
            // The walk that comes in on the same strip is passed the other way.
            let incoming = walk ^ 1;
            self.next[incoming] = after;
            self.before[after] = incoming;
            self.wraps[incoming] = k + 1 == leaving.len();
        }
    }

    /// Counterclockwise order of walks that leave a joint: by their places on the border of a block, then by direction, then, where
    /// directions are the same, by curvature.
    fn sort(&self, joint: Joint, leaving: &mut [usize]) {
        let key = |walk: usize| {
            let start = self.walks[walk].axis(0.0);
            match joint {
                Joint::Node(_) => (0.0, angle(CUT, start.tangent)),
                Joint::Block(block) => {
                    let place = self.anchors[walk];
                    (place, angle(self.borders[block].outward(place), start.tangent))
                }
            }
        };
        let count = leaving.len();
        leaving.sort_by(|a, b| key(*a).0.total_cmp(&key(*b).0).then(key(*a).1.total_cmp(&key(*b).1)));
        // What differs by rounding only is put in order pair by pair; round a node the last is followed by the first.
        let round = usize::from(matches!(joint, Joint::Block(_)));
        for _ in 0..count {
            for k in 0..count.saturating_sub(round) {
                let (here, there) = (k, (k + 1) % count);
                if self.swapped(key(leaving[here]), key(leaving[there]), leaving[here], leaving[there]) {
                    leaving.swap(here, there);
                }
            }
        }
    }

    /// Whether two walks with the same place are in the wrong order.
    fn swapped(&self, first: (f64, f64), second: (f64, f64), a: usize, b: usize) -> bool {
        let starts = [a, b].map(|walk| self.walks[walk].axis(0.0));
        let parallel = cross(starts[0].tangent, starts[1].tangent).abs() < SAME_RAD && dot(starts[0].tangent, starts[1].tangent) > 0.0;
        if (first.0 - second.0).abs() > SAME_RAD || a == b {
            return false;
        }
        if parallel {
            return starts[0].curvature_per_m > starts[1].curvature_per_m;
        }
        matches!(self.walks[a].start(), Joint::Block(_)) && first.1 > second.1
    }

    /// The corner after each walk, with its radius checked against its neighbours.
    fn turns(&self) -> Result<Vec<Turn>, OutlineError> {
        let mut turns = Vec::new();
        for walk in 0..self.walks.len() {
            let radius_m = self.radius_m(walk);
            let turn = self.turn(walk, radius_m).ok_or_else(|| self.misfit(walk, |radius_m| self.turn(walk, radius_m).is_some()))?;
            turns.push(turn);
        }
        for walk in 0..self.walks.len() {
            let (before, after) = (self.before[walk], walk);
            let (from, to) = (turns[before].at[1], turns[after].at[0]);
            if from <= to {
                continue;
            }
            // The fillets at both ends of a side meet: the one that reaches farther is too large.
            let error = if from > 1.0 - to {
                self.misfit(before, |radius_m| self.turn(before, radius_m).is_some_and(|turn| turn.at[1] <= to))
            } else {
                self.misfit(after, |radius_m| self.turn(after, radius_m).is_some_and(|turn| turn.at[0] >= from))
            };
            return Err(error);
        }
        Ok(turns)
    }

    fn joint_after(&self, walk: usize) -> Joint {
        self.walks[walk ^ 1].start()
    }

    fn radius_m(&self, walk: usize) -> f64 {
        match self.joint_after(walk) {
            Joint::Node(node) => self.network.nodes[node].fillet_m,
            Joint::Block(block) => self.network.blocks[block].fillet_m,
        }
    }

    fn turn(&self, walk: usize, radius_m: f64) -> Option<Turn> {
        let next = self.next[walk];
        let pair = [&self.walks[walk], &self.walks[next]];
        match self.joint_after(walk) {
            Joint::Node(node) => node::turn(node, &self.network.nodes[node], pair, radius_m, [self.exact_m, self.join_m]),
            Joint::Block(block) => {
                let border = &self.borders[block];
                let round = if self.wraps[walk] { border.pieces.len() as f64 } else { 0.0 };
                border.turn(pair, [self.anchors[walk ^ 1], self.anchors[next] + round], radius_m, self.exact_m)
            }
        }
    }

    /// The error of a fillet that does not fit, with the largest that does.
    fn misfit(&self, walk: usize, fits: impl Fn(f64) -> bool) -> OutlineError {
        let radius_m = self.radius_m(walk);
        let (mut fitting, mut too_large) = (0.0, radius_m);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (fitting + too_large);
            if fits(middle) {
                fitting = middle;
            } else {
                too_large = middle;
            }
        }
        let strips = [self.walks[walk].index, self.walks[self.next[walk]].index];
        OutlineError::Fillet { joint: self.joint_after(walk), strips, radius_m, largest_m: fitting }
    }
}

/// Per strip the first strip that it is connected with.
fn connected(network: &Network) -> Vec<usize> {
    let mut part_of: Vec<usize> = (0..network.strips.len()).collect();
    loop {
        let mut changed = false;
        for a in 0..part_of.len() {
            for b in 0..part_of.len() {
                let touching = network.strips[a].ends.iter().any(|end| network.strips[b].ends.contains(end));
                if touching && part_of[b] < part_of[a] {
                    part_of[a] = part_of[b];
                    changed = true;
                }
            }
        }
        if !changed {
            return part_of;
        }
    }
}

/// Sorts boundaries into outer ones and windows, and refuses those that meet.
fn regions(boundaries: Vec<(usize, Boundary)>, look_m: f64) -> Result<Vec<Region>, OutlineError> {
    let profiles: Vec<Profile> = boundaries.iter().map(|(_, boundary)| boundary.profile.clone()).collect();
    if let Some(meeting) = chords::first_meeting(&profiles, look_m) {
        let tags = [0, 1].map(|k: usize| boundaries[meeting.profiles[k]].1.tags[meeting.segments[k]]);
        return Err(OutlineError::Overlap { tags, at_m: meeting.at_m });
    }
    let mut regions: Vec<(usize, Region)> = Vec::new();
    let (outer, windows): (Vec<_>, Vec<_>) = boundaries.into_iter().partition(|(_, boundary)| boundary.profile.area_m2() > 0.0);
    for (part, outer) in outer {
        if regions.iter().any(|(other, _)| *other == part) {
            return Err(OutlineError::NotSimple);
        }
        regions.push((part, Region { outer, windows: Vec::new() }));
    }
    for (part, window) in windows {
        let region = regions.iter_mut().find(|(other, _)| *other == part).ok_or(OutlineError::NotSimple)?;
        region.1.windows.push(window);
    }
    regions.sort_by_key(|(part, _)| *part);
    for (k, (_, region)) in regions.iter().enumerate() {
        for (_, other) in regions.iter().enumerate().filter(|(other, _)| *other != k).map(|(_, pair)| pair) {
            let start_m = other.outer.profile.start_m;
            let in_window = region.windows.iter().any(|window| window.profile.contains(start_m));
            if region.outer.profile.contains(start_m) && !in_window {
                return Err(OutlineError::Overlap { tags: [region.outer.tags[0], other.outer.tags[0]], at_m: start_m });
            }
        }
    }
    Ok(regions.into_iter().map(|(_, region)| region).collect())
}
