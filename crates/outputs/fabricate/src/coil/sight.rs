//! What is seen of a wire from the side: contours where the surface turns away from the eye, rims of both ends, and what hides them.
//!
//! The eye is far away on the y axis; abscissas of the picture are z, ordinates x. A contour of a tube is the curve beside the projected
//! middle of the wire at its radius. A point is hidden where the tube, as an envelope of balls cut by the planes of its ends, has a point
//! in front of it.

use std::f64::consts::TAU;

use forcewright_base::maths;
use forcewright_model::{WirePiece, WireStation};

use super::{Wound, middle, millimetres};
use crate::shape::{MM_PER_M, Point};

/// What lies in front by less than that, in radii of the wire, hides nothing.
const FRONT: f64 = 1e-4;
/// Share of the tolerance that chords of the middle may be off, within what is possible. By a little more than that they hide less than the
/// wire, lest a contour be hidden by the chord beside it.
const CHORD: f64 = 0.25;
const LESS: f64 = 1.2;
/// Places of a turn, and of a radius of the wire, at which it is asked what is seen.
const PER_TURN: f64 = 96.0;
const PER_RADIUS: f64 = 2.0;
/// Most chords and places of a turn or a leg.
const MOST_CHORDS: f64 = 2000.0;
const MOST_PLACES: f64 = 500.0;

/// A point in the picture and how near it is to the eye, mm.
#[derive(Clone, Copy, Debug)]
struct Seen {
    at: Point,
    y: f64,
}

/// A chord of the middle of the wire.
struct Chord {
    from: Seen,
    to: Seen,
    /// Whether it is so near to the lower or the upper end that its balls reach beyond.
    is_at: [bool; 2],
}

/// A plane end: a point and the direction outwards, by z, x and y.
struct End {
    point: [f64; 3],
    outwards: [f64; 3],
}

/// The wire as it hides.
pub(super) struct Sight<'a> {
    wound: &'a Wound<'a>,
    tolerance: f64,
    /// Radius of the tube that hides, mm.
    hiding: f64,
    /// By their least z.
    chords: Vec<Chord>,
    longest: f64,
    ends: Vec<End>,
}

fn turned_round([x, y, z]: [f64; 3]) -> [f64; 3] {
    [z, x, y]
}

fn seen(point: [f64; 3]) -> Seen {
    Seen { at: [point[2], point[0]], y: point[1] }
}

impl<'a> Sight<'a> {
    /// With lines within `tolerance` mm.
    pub(super) fn new(wound: &'a Wound<'a>, tolerance: f64) -> Self {
        let radius = wound.radius;
        let (mut chords, mut below_m, mut sag) = (Vec::new(), 0.0, 0.0);
        let all_m = wound.line.length_m();
        let near_m = 1.1 * radius / MM_PER_M;
        for piece in wound.line.pieces() {
            let bend = maths::hypot(piece.radius_m(), piece.change_of_slope_m()) * MM_PER_M;
            let by_angle = piece.turned_rad() / (8.0 * CHORD * tolerance / bend).sqrt();
            let turns = (piece.turned_rad() / TAU).max(1.0);
            // Straight legs in parts, so that no chord is near to everything.
            let legs = piece.length_m() * MM_PER_M / (2.0 * radius);
            let count = if piece.radius_m().is_finite() { by_angle } else { legs }.ceil().clamp(1.0, turns * MOST_CHORDS);
            let step = piece.turned_rad() / count;
            sag = f64::max(sag, if step > 0.0 { bend * step * step / 8.0 } else { 0.0 });
            let mut k = 0.0;
            while k < count {
                let [from, to] = [k, k + 1.0].map(|k| seen(middle(&piece.at(k / count))));
                let [low_m, high_m] = [k, k + 1.0].map(|k| below_m + piece.length_m() * k / count);
                chords.push(Chord { from, to, is_at: [low_m < near_m, high_m > all_m - near_m] });
                k += 1.0;
            }
            below_m += piece.length_m();
        }
        let length = |chord: &Chord| (chord.to.at[0] - chord.from.at[0]).abs();
        let longest = chords.iter().map(length).fold(0.0, f64::max);
        chords.sort_by(|a, b| a.from.at[0].min(a.to.at[0]).total_cmp(&b.from.at[0].min(b.to.at[0])));
        let end = |is_upper: bool| {
            let station = wound.end(is_upper)?;
            let outwards = turned_round(station.tangent).map(|x| if is_upper { x } else { -x });
            Some(End { point: turned_round(middle(&station)), outwards })
        };
        let hiding = (radius - LESS * sag).max(0.5 * radius);
        Self { wound, tolerance, hiding, chords, longest, ends: [end(false), end(true)].into_iter().flatten().collect() }
    }

    /// All that is seen, as chains of points.
    pub(super) fn lines(&self) -> Vec<Vec<Point>> {
        let mut lines = Vec::new();
        for piece in self.wound.line.pieces() {
            let by_angle = PER_TURN * piece.turned_rad() / TAU;
            let count = by_angle
                .max(PER_RADIUS * piece.length_m() * MM_PER_M / self.wound.radius)
                .ceil()
                .clamp(1.0, (piece.turned_rad() / TAU).max(1.0) * MOST_PLACES);
            for side in [1.0, -1.0] {
                self.visible(|share| self.contour(piece, share, side), count, &mut lines);
            }
        }
        for is_upper in [false, true] {
            if let Some(station) = self.wound.end(is_upper) {
                self.visible(|share| Some(self.rim(&station, share)), PER_TURN, &mut lines);
            }
        }
        lines
    }

    /// A point of the contour on a side; none where the wire runs towards the eye.
    fn contour(&self, piece: &WirePiece, share: f64, side: f64) -> Option<Seen> {
        let station = piece.at(share);
        let [x, _, z] = station.tangent;
        let across = maths::hypot(x, z);
        let offset = side * self.wound.radius / across;
        let here = seen(middle(&station));
        (across > 1e-6).then(|| Seen { at: [here.at[0] + offset * x, here.at[1] - offset * z], y: here.y })
    }

    /// A point of the rim of an end.
    fn rim(&self, station: &WireStation, share: f64) -> Seen {
        let (sin, cos) = maths::sin_cos(TAU * share);
        seen(millimetres(station.around_m(self.wound.radius / MM_PER_M, [cos, sin])))
    }

    /// Appends the visible parts of a curve over [0, 1], with changes sought between so many places.
    fn visible(&self, curve: impl Fn(f64) -> Option<Seen>, count: f64, lines: &mut Vec<Vec<Point>>) {
        let is_visible = |share: f64| curve(share).is_some_and(|point| !self.is_hidden(&point));
        let mut from = is_visible(0.0).then_some(0.0);
        let mut k = 1.0;
        while k <= count {
            let (before, here) = ((k - 1.0) / count, k / count);
            if is_visible(here) != from.is_some() {
                let (mut low, mut high) = (before, here);
                for _ in 0..40 {
                    let middle = 0.5 * (low + high);
                    if is_visible(middle) == from.is_some() { low = middle } else { high = middle }
                }
                match from.take() {
                    Some(begin) => self.add(&curve, [begin, low], count, lines),
                    None => from = Some(high),
                }
            }
            k += 1.0;
        }
        if let Some(begin) = from {
            self.add(&curve, [begin, 1.0], count, lines);
        }
    }

    /// Appends a part of a curve in chords.
    fn add(&self, curve: &impl Fn(f64) -> Option<Seen>, [begin, end]: [f64; 2], count: f64, lines: &mut Vec<Vec<Point>>) {
        let parts = ((end - begin) * count / 4.0).ceil().max(1.0);
        let Some(first) = curve(begin) else { return };
        let mut line = vec![first.at];
        let mut k = 0.0;
        while k < parts {
            let [low, high] = [k, k + 1.0].map(|k| begin + (end - begin) * k / parts);
            self.refine(curve, [low, high], 12, &mut line);
            k += 1.0;
        }
        let size = |axis: usize| {
            let of = |pick: fn(f64, f64) -> f64, start: f64| line.iter().fold(start, |bound, point| pick(bound, point[axis]));
            of(f64::max, f64::NEG_INFINITY) - of(f64::min, f64::INFINITY)
        };
        // What is shorter than lines may be off is nothing.
        if size(0).max(size(1)) > 2.0 * self.tolerance {
            lines.push(line);
        }
    }

    /// Halves a part until its chord is near enough at three places.
    fn refine(&self, curve: &impl Fn(f64) -> Option<Seen>, [low, high]: [f64; 2], depth: u32, line: &mut Vec<Point>) {
        let Some(to) = curve(high).map(|point| point.at) else { return };
        let Some(&from) = line.last() else { return };
        let off = |share: f64| {
            let Some(point) = curve(low + share * (high - low)) else { return 0.0 };
            let ([u, v], [p, q]) = ([to[0] - from[0], to[1] - from[1]], [point.at[0] - from[0], point.at[1] - from[1]]);
            let length = maths::hypot(u, v);
            if length > 0.0 { ((u * q - v * p) / length).abs() } else { maths::hypot(p, q) }
        };
        if depth > 0 && [0.25, 0.5, 0.75].into_iter().map(off).fold(0.0, f64::max) > 0.9 * self.tolerance {
            let middle = 0.5 * (low + high);
            self.refine(curve, [low, middle], depth - 1, line);
            self.refine(curve, [middle, high], depth - 1, line);
        } else {
            line.push(to);
        }
    }

    fn is_hidden(&self, point: &Seen) -> bool {
        let reach = self.wound.radius;
        let first = self.chords.partition_point(|chord| chord.from.at[0].min(chord.to.at[0]) < point.at[0] - reach - self.longest);
        let near = self.chords[first..].iter().take_while(|chord| chord.from.at[0].min(chord.to.at[0]) <= point.at[0] + reach);
        near.into_iter().any(|chord| self.front(chord, point).is_some_and(|y| y > point.y + FRONT * reach))
    }

    /// How near to the eye the balls along a chord come behind or before a point of the picture.
    fn front(&self, chord: &Chord, point: &Seen) -> Option<f64> {
        let (from, to) = (&chord.from, &chord.to);
        let step = [to.at[0] - from.at[0], to.at[1] - from.at[1]];
        let aside = [point.at[0] - from.at[0], point.at[1] - from.at[1]];
        let radius = self.hiding;
        let length = maths::hypot(step[0], step[1]);
        // The middle of the ball that comes nearest: where the tube's slope towards the eye takes it.
        let (share, left) = if length > 1e-9 * radius {
            let (foot, off) = ((aside[0] * step[0] + aside[1] * step[1]) / length, (aside[0] * step[1] - aside[1] * step[0]) / length);
            let left = radius * radius - off * off;
            if left <= 0.0 {
                return None;
            }
            let slope = (to.y - from.y) / length;
            let best = (foot + slope * left.sqrt() / maths::hypot(1.0, slope)).clamp(0.0, length);
            (best / length, left - (best - foot) * (best - foot))
        } else {
            (if to.y > from.y { 1.0 } else { 0.0 }, radius * radius - aside[0] * aside[0] - aside[1] * aside[1])
        };
        if left <= 0.0 {
            return None;
        }
        let y = from.y + share * (to.y - from.y);
        self.cut(chord, point, [y - left.sqrt(), y + left.sqrt()])
    }

    /// The front of what the planes of the ends leave of a line of sight between two depths.
    fn cut(&self, chord: &Chord, point: &Seen, [mut back, mut front]: [f64; 2]) -> Option<f64> {
        for (end, _) in self.ends.iter().zip(chord.is_at).filter(|(_, is_at)| *is_at) {
            let [z, x, y] = end.outwards;
            // Outwards distance of the line of sight where y is that of the end's middle.
            let beyond = z * (point.at[0] - end.point[0]) + x * (point.at[1] - end.point[1]);
            if y.abs() < 1e-12 {
                if beyond > 1e-9 * self.wound.radius {
                    return None;
                }
            } else if y > 0.0 {
                front = front.min(end.point[2] - beyond / y);
            } else {
                back = back.max(end.point[2] - beyond / y);
            }
        }
        (front > back).then_some(front)
    }
}
