//! How near ropes come to each other.
//!
//! All turns on a drum have the same lead, so the distance of two points depends only on the angle t between them along the helix:
//! g(t) = 2r²(1 − cos t) + (Δ + c t)², with the climb c per angle and Δ the axial distance of the two helices at t = 0. Two arcs
//! offer an interval of t; the least of g there is found turn by turn, where g is convex, and at the ends of the interval.

use std::f64::consts::{FRAC_PI_2, TAU};

use forcewright_base::maths::sin;
use forcewright_base::roots::root;

use super::path::{Piece, Span, span_distance};
use super::{Drive, Drum, GeometryError};

/// Where two ropes are next to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// On a drum.
    On(Drum),
    /// Between the drums: two spans pass each other.
    Between,
}

/// A part of a cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arc {
    /// On the output at end 0.
    First,
    /// Outgoing span, from end 0 to the input.
    Outgoing,
    /// On the input.
    Input,
    /// Return span, from the input to end 1.
    Return,
    /// On the output at end 1.
    Second,
}

/// The least distance of two parts of cables, or of two turns of one part, over the travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Where.
    pub place: Place,
    /// Cable and part of each.
    pub parts: [(usize, Arc); 2],
    /// Least distance of the middles of the ropes in space, m.
    pub distance_m: f64,
    /// The same between the surfaces of the ropes, m; below 0 they would overlap.
    pub clearance_m: f64,
    /// Side by side on a drum: axial distance at the same angle, in pitches of the input. Else (between the drums, or where the end of one is
    /// beside the other) the distance in pitches.
    pub pitches: f64,
    /// Output angles at which they are so near, rad: from, to.
    pub output_rad: [f64; 2],
    /// A place on the first part where they are so near, m, in space at the first of these output angles.
    pub point_m: [f64; 3],
}

/// A helix on a drum: along the climb, from the angle `start` over `wrap`.
#[derive(Clone, Copy)]
struct Turns {
    radius_m: f64,
    /// Climb per angle, m/rad.
    lead: f64,
    start: f64,
    wrap: f64,
    /// Climb at `start`, m.
    climb: f64,
}

/// Squared distance and angle between the nearest points.
#[derive(Clone, Copy)]
struct Close {
    squared: f64,
    angle: f64,
    /// Axial distance of the two helices at the same angle, m.
    axial: f64,
    /// Whether the two arcs pass each other there, so that neither ends at the nearest point.
    beside: bool,
}

/// The interval of angles between two arcs, and their axial distance at angle 0.
struct Between {
    turns: Turns,
    low: f64,
    high: f64,
    axial: f64,
    /// Whether both are one arc: then the low end of the interval is no end of a rope.
    itself: bool,
}

impl Between {
    fn new(a: Turns, b: Turns) -> Self {
        Self {
            turns: a,
            low: b.start - (a.start + a.wrap),
            high: b.start + b.wrap - a.start,
            axial: (b.climb - b.lead * b.start) - (a.climb - a.lead * a.start),
            itself: false,
        }
    }

    /// Two different turns of one arc: places at least three quarters of a turn apart, if it is so long.
    fn itself(a: Turns) -> Option<Self> {
        (a.wrap > 3.0 * FRAC_PI_2).then_some(Self { turns: a, low: 3.0 * FRAC_PI_2, high: a.wrap, axial: 0.0, itself: true })
    }

    fn squared(&self, angle: f64) -> f64 {
        let (r, up) = (self.turns.radius_m, self.axial + self.turns.lead * angle);
        let half = sin(0.5 * angle);
        4.0 * r * r * half * half + up * up
    }

    /// Axial distance on the same angle, k turns on.
    fn axial_at(&self, turn: f64) -> f64 {
        self.axial + TAU * turn * self.turns.lead
    }

    fn close(&self, angle: f64) -> Close {
        Close { squared: self.squared(angle), angle, axial: self.axial_at((angle / TAU).round()).abs(), beside: false }
    }

    /// The least within a quarter turn of k whole turns.
    fn near_turn(&self, turn: f64) -> Option<Close> {
        let (low, high) = ((self.low - TAU * turn).max(-FRAC_PI_2), (self.high - TAU * turn).min(FRAC_PI_2));
        if low > high {
            return None;
        }
        let (r, c, up) = (self.turns.radius_m, self.turns.lead, self.axial_at(turn));
        let slope = |u: f64| r * r * sin(u) + c * (up + c * u);
        let (u, beside) = if slope(low) > 0.0 {
            // On a helix so steep that it only leaves itself no turn lies beside another.
            if self.itself {
                return None;
            }
            (low, false)
        } else if slope(high) < 0.0 {
            (high, false)
        } else {
            (root(slope, low, high, 0.0).unwrap_or(low), true)
        };
        let half = sin(0.5 * u);
        let climb = up + c * u;
        Some(Close { squared: 4.0 * r * r * half * half + climb * climb, angle: TAU * turn + u, axial: up.abs(), beside })
    }

    /// The least of all; helices that differ axially by less than `ignored` are one groove and are passed over.
    fn least(&self, ignored: f64) -> Option<Close> {
        // The turn at which both helices are nearest, and those beside it, as far as the interval has them.
        let (first, last) = ((self.low / TAU).floor(), (self.high / TAU).ceil());
        let level = (-self.axial / (TAU * self.turns.lead)).round().max(first).min(last);
        let turns = [level - 2.0, level - 1.0, level, level + 1.0, level + 2.0];
        let ends = if self.itself { None } else { Some([self.close(self.low), self.close(self.high)]) };
        turns
            .into_iter()
            .filter_map(|turn| self.near_turn(turn))
            .chain(ends.into_iter().flatten())
            .filter(|close| close.axial >= ignored)
            .min_by(|a, b| a.squared.total_cmp(&b.squared))
    }
}

impl Drive {
    /// The least distance of every two parts of cables over the travel, nearest first: turns of one part, parts of one cable, parts of
    /// different cables; on each drum, and of spans between the drums. A part with less than three quarters of a turn has no second turn.
    ///
    /// Cables that follow each other on one groove are as far apart as their ends. A span that is in line with its grooves leaves the
    /// neighbouring turns of a drum behind; one that leans towards them by the fleet angle φ nears them while it still lies low, from h to
    /// no less than h − ¾φ (2hφr²)^⅓, the least of (h − φx)² + (x²/2r)² to first order in φ. That is not counted here.
    pub fn occupancy(&self) -> Vec<Nearest> {
        let mut found = Vec::new();
        for a in 0..self.layout.cables.len() {
            for b in a..self.layout.cables.len() {
                for (first, second) in [(Arc::Input, Arc::Input), (Arc::First, Arc::First), (Arc::Second, Arc::Second)] {
                    found.extend(self.nearest_on_drum((a, first), (b, second)));
                }
                found.extend(self.nearest_on_drum((a, Arc::First), (b, Arc::Second)));
                found.extend(self.nearest_spans((a, Arc::Outgoing), (b, Arc::Return)));
                if a != b {
                    found.extend(self.nearest_on_drum((a, Arc::Second), (b, Arc::First)));
                    for (first, second) in [(Arc::Outgoing, Arc::Outgoing), (Arc::Return, Arc::Return), (Arc::Return, Arc::Outgoing)] {
                        found.extend(self.nearest_spans((a, first), (b, second)));
                    }
                }
            }
        }
        found.sort_by(|a, b| a.distance_m.total_cmp(&b.distance_m));
        found
    }

    /// The nearest of [`occupancy`](Self::occupancy); none if no part has a neighbour.
    pub fn nearest(&self) -> Option<Nearest> {
        self.occupancy().into_iter().next()
    }

    /// Lines of several cables that keep clear of each other: each ends on the line next to where it lands, and the first lines are as few
    /// lines apart as leave the clearance between all ropes over the travel. None if 100 lines apart are not enough, or for more than 20
    /// cables.
    ///
    /// On a crossed belt they are at least n + 2 apart if R = S: n + 1 apart, the return span of a cable passes the outgoing span of the
    /// next at inv γ/π of a pitch only.
    pub fn clear_cables(&self, count: usize, clearance_m: f64) -> Option<Vec<[i32; 2]>> {
        const MOST_APART: i32 = 100;
        const MOST_CABLES: i32 = 20;
        let apart = i32::try_from(self.nearest_lines_apart()).ok()?;
        let count = i32::try_from(count).ok().filter(|count| (1..=MOST_CABLES).contains(count))?;
        (1..=MOST_APART).map(|between| (0..count).map(|i| [i * between, (i * between).saturating_add(apart)]).collect::<Vec<_>>()).find(
            |cables| {
                let tried = Self::new(super::Layout { cables: cables.clone(), ..self.layout.clone() });
                tried.is_ok_and(|drive| drive.nearest().is_none_or(|near| near.clearance_m >= clearance_m))
            },
        )
    }

    /// Least distance between the middles of different grooves on the output, as far as cables use them over the travel, m. Grooves that
    /// coincide are one. Below the width of a groove they run into each other, as those of a second group with a phase do where a first
    /// group passes. None if there is one groove only, without a second turn.
    pub fn groove_distance_m(&self) -> Option<f64> {
        // Two helices that differ by less are one within what can be made.
        let same = 1e-6 * self.layout.pitch_m;
        let travel = self.layout.travel_rad;
        let mut used = Vec::new();
        for cable in 0..self.layout.cables.len() {
            used.extend(self.turns_of(cable, Arc::First, travel).ok());
            used.extend(self.turns_of(cable, Arc::Second, 0.0).ok());
        }
        let mut least: Option<f64> = None;
        for (i, &a) in used.iter().enumerate() {
            let others = used[i + 1..].iter().map(|&b| Between::new(a, b)).chain(Between::itself(a));
            for close in others.filter_map(|between| between.least(same)) {
                let distance = close.squared.sqrt();
                least = Some(least.map_or(distance, |least| least.min(distance)));
            }
        }
        least
    }

    /// An arc at an output angle, along the climb; angles on the drum.
    fn turns_of(&self, cable: usize, arc: Arc, output_rad: f64) -> Result<Turns, GeometryError> {
        let (climbs, against) = (self.climbs_m(cable)?, self.layout.belt.sign());
        let [first, second] = self.output_tangents_rad().map(|angle| -against * angle);
        let [first_wrap, second_wrap] = self.output_wraps_rad(output_rad)?;
        let lead = self.lead_m_per_rad(if arc == Arc::Input { Drum::Input } else { Drum::Output });
        let (start, wrap, climb) = match arc {
            Arc::First => (first - self.layout.guard_rad[0], first_wrap, climbs[0] - lead * self.layout.guard_rad[0]),
            Arc::Second => (second + output_rad, second_wrap, climbs[3] + lead * output_rad),
            Arc::Input | Arc::Outgoing | Arc::Return => (self.tangent_rad, self.input_wrap_rad(), climbs[1]),
        };
        let drum = if arc == Arc::Input { Drum::Input } else { Drum::Output };
        Ok(Turns { radius_m: self.radius_m(drum), lead, start, wrap, climb })
    }

    /// The least distance of two arcs on one drum.
    fn nearest_on_drum(&self, a: (usize, Arc), b: (usize, Arc)) -> Option<Nearest> {
        let travel = self.layout.travel_rad;
        // Ends 0 are longest at the end of the travel, ends 1 at its start; the interval between an end 0 and an end 1 does not change.
        let longest = if a.1 == Arc::First && b.1 == Arc::First { travel } else { 0.0 };
        let [first, second] = [a, b].map(|(cable, arc)| self.turns_of(cable, arc, longest).ok());
        let (first, second) = (first?, second?);
        let between = if a == b { Between::itself(first)? } else { Between::new(first, second) };
        let close = between.least(0.0)?;
        let distance = close.squared.sqrt();
        let reach = close.angle.abs();
        let [guard, guard_second] = self.layout.guard_rad;
        let output_rad = match (a.1, b.1) {
            (Arc::First, Arc::First) => [(reach - guard).clamp(0.0, travel), travel],
            (Arc::Second, Arc::Second) => [0.0, (guard_second + travel - reach).clamp(0.0, travel)],
            _ => [0.0, travel],
        };
        let at = |angle: f64| -> Option<[f64; 3]> {
            let (one, two) = (self.turns_of(a.0, a.1, output_rad[0]).ok()?, self.turns_of(b.0, b.1, output_rad[0]).ok()?);
            // The middle of all places on the first arc that have a neighbour so far along the helix.
            let from = one.start.max(two.start - angle);
            let place = 0.5 * (from + (one.start + one.wrap).min(two.start + two.wrap - angle));
            let line = self.centre_line(a.0, output_rad[0]).ok()?;
            let piece = line.pieces[match a.1 {
                Arc::First => 0,
                Arc::Second => 4,
                _ => 2,
            }];
            Some(piece.point_m(if one.wrap > 0.0 { ((place - one.start) / one.wrap).clamp(0.0, 1.0) } else { 0.0 }))
        };
        let drum = if a.1 == Arc::Input { Drum::Input } else { Drum::Output };
        Some(self.nearest_of(
            Place::On(drum),
            [a, b],
            distance,
            if close.beside { close.axial } else { distance },
            output_rad,
            at(close.angle)?,
        ))
    }

    /// The distance of two spans, which walk together.
    fn nearest_spans(&self, a: (usize, Arc), b: (usize, Arc)) -> Option<Nearest> {
        let span = |(cable, arc): (usize, Arc)| -> Option<Span> {
            match self.centre_line(cable, 0.0).ok()?.pieces[if arc == Arc::Outgoing { 1 } else { 3 }] {
                Piece::Span(span) => Some(span),
                Piece::Helix(_) => None,
            }
        };
        let first = span(a)?;
        let (distance, [fraction, _]) = span_distance(first, span(b)?);
        let point = Piece::Span(first).point_m(fraction);
        Some(self.nearest_of(Place::Between, [a, b], distance, distance, [0.0, self.layout.travel_rad], point))
    }

    fn nearest_of(
        &self,
        place: Place,
        parts: [(usize, Arc); 2],
        distance_m: f64,
        axial_m: f64,
        output_rad: [f64; 2],
        point_m: [f64; 3],
    ) -> Nearest {
        Nearest {
            place,
            parts,
            distance_m,
            clearance_m: distance_m - self.layout.rope_diameter_m,
            pitches: axial_m / self.layout.pitch_m,
            output_rad,
            point_m,
        }
    }
}
