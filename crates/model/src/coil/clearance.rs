//! How near a wire comes to itself.
//!
//! A tube is sound where its radius is less than that of curvature everywhere, and where the middles of parts of it that are farther from
//! each other along the wire than π times the least radius of curvature ρ keep more than its diameter apart: nearer parts of a curve are at
//! least as far apart as those of a circle of radius ρ (Schur's comparison theorem), that is 2ρ at πρ.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths;

use super::Coil;
use super::line::{WireKind, WirePiece};
use super::space::{Vector, distance};

/// Places of a turn at which windings are compared.
const PER_TURN: f64 = 48.0;
/// Most places of a leg.
const MOST_PLACES: f64 = 1000.0;

/// The two places nearest to each other.
pub(super) struct Nearest {
    /// In lengths of wire from the lower end, m.
    pub(super) at_m: [f64; 2],
    pub(super) distance_m: f64,
}

/// A piece with the length of wire below it.
struct Laid {
    piece: WirePiece,
    from_m: f64,
}

struct Wire {
    pieces: Vec<Laid>,
    length_m: f64,
    /// What lies nearer than that along the wire is not compared, m.
    apart_m: f64,
}

/// Of a coil whose numbers are sound.
pub(super) fn nearest(coil: &Coil) -> Nearest {
    let mut pieces = Vec::new();
    let mut length_m = 0.0;
    for &piece in coil.line().pieces() {
        pieces.push(Laid { piece, from_m: length_m });
        length_m += piece.length_m();
    }
    let bends = coil.ends.iter().filter_map(super::CoilEnd::bend_m);
    let windings = coil.windings.iter().map(|winding| coil.least_curvature_radius_m(winding));
    let wire = Wire { pieces, length_m, apart_m: PI * bends.chain(windings).fold(f64::INFINITY, f64::min) };
    let mut best = Nearest { at_m: [0.0; 2], distance_m: f64::INFINITY };
    wire.turns(coil, &mut best);
    let [below, above] = [wire.legs(coil, WireKind::Wound, false), wire.legs(coil, WireKind::Wound, true)];
    for &(at_m, step_m) in below.iter().chain(&above) {
        wire.leg_to_windings(coil, at_m, step_m, &mut best);
    }
    let mut pair = (f64::INFINITY, 0.0, 0.0, 0.0);
    for &(one_m, step_m) in &below {
        for &(other_m, _) in &above {
            let apart_m = wire.distance_m(one_m, other_m);
            if apart_m < pair.0 {
                pair = (apart_m, one_m, other_m, step_m);
            }
        }
    }
    if pair.0.is_finite() {
        wire.refine([pair.1, pair.2], pair.3.max(coil.wire_m), &mut best);
    }
    best
}

impl Wire {
    /// The middle of the wire at a length from the lower end. Within a winding of changing pitch lengths count as if its angle were
    /// proportional to them.
    fn at(&self, at_m: f64) -> Vector {
        let index = self.pieces.partition_point(|laid| laid.from_m <= at_m).saturating_sub(1);
        let laid = &self.pieces[index];
        laid.piece.at(((at_m - laid.from_m) / laid.piece.length_m()).clamp(0.0, 1.0)).point_m
    }

    fn distance_m(&self, one_m: f64, other_m: f64) -> f64 {
        if (one_m - other_m).abs() < self.apart_m { f64::INFINITY } else { distance(self.at(one_m), self.at(other_m)) }
    }

    /// A pattern search that halves its steps, beginning with `step_m`.
    fn refine(&self, at_m: [f64; 2], step_m: f64, best: &mut Nearest) {
        let mut here = (self.distance_m(at_m[0], at_m[1]), at_m);
        let mut step_m = step_m;
        for _ in 0..200 {
            let mut next = here;
            for (k, l) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (1.0, -1.0)] {
                let there = [here.1[0] + k * step_m, here.1[1] + l * step_m].map(|x| x.clamp(0.0, self.length_m));
                let distance_m = self.distance_m(there[0], there[1]);
                if distance_m < next.0 {
                    next = (distance_m, there);
                }
            }
            if next.0 < here.0 {
                here = next;
            } else {
                step_m *= 0.5;
            }
            if step_m < 1e-9 * self.length_m.min(1.0) {
                break;
            }
        }
        if here.0 < best.distance_m {
            *best = Nearest { at_m: here.1, distance_m: here.0 };
        }
    }

    /// Windings against the turn above. Farther turns are farther away, for the wire never sinks; those of less than half a turn are too.
    fn turns(&self, coil: &Coil, best: &mut Nearest) {
        let mut place = None;
        let mut least = f64::INFINITY;
        let mut try_at = |rad: f64| {
            if let (Some(one_m), Some(other_m)) = (self.wound_m(coil, rad), self.wound_m(coil, rad + TAU)) {
                let distance_m = self.distance_m(one_m, other_m);
                if distance_m < least {
                    least = distance_m;
                    place = Some([one_m, other_m]);
                }
            }
        };
        let mut begin = 0.0;
        for winding in &coil.windings {
            let turned = TAU * winding.turns;
            // Where the pitch is the same a turn further on, one place stands for all.
            let is_even = (winding.pitch_m[0] - winding.pitch_m[1]).abs() <= 0.0;
            let from = if is_even { (turned - TAU).max(0.0) } else { 0.0 };
            try_at(begin);
            let count = ((turned - from) / TAU * PER_TURN).ceil();
            let mut k = 0.0;
            while k <= count {
                try_at(begin + from + (turned - from) * k / count);
                k += 1.0;
            }
            begin += turned;
            try_at(begin - TAU);
        }
        try_at(begin - TAU * (1.0 + 1e-15));
        match place {
            Some(at_m) => self.refine(at_m, TAU * coil.radius_m / PER_TURN, best),
            // Less than a turn: its ends.
            None => {
                if let (Some(one_m), Some(other_m)) = (self.wound_m(coil, 0.0), self.wound_m(coil, begin)) {
                    self.refine([one_m, other_m], TAU * coil.radius_m / PER_TURN, best);
                }
            }
        }
    }

    /// The length of wire at an angle of the windings from their begin, if they go so far.
    fn wound_m(&self, coil: &Coil, rad: f64) -> Option<f64> {
        let mut wound = self.pieces.iter().filter(|laid| laid.piece.kind() == WireKind::Wound);
        let mut begin = 0.0;
        let all = TAU * coil.turns();
        if rad < -1e-9 || rad > all * (1.0 + 1e-12) {
            return None;
        }
        let mut found = None;
        for laid in wound.by_ref() {
            let share = (rad - begin) / laid.piece.turned_rad();
            found = Some(laid.from_m + share.clamp(0.0, 1.0) * laid.piece.length_m());
            if share <= 1.0 {
                break;
            }
            begin += laid.piece.turned_rad();
        }
        found
    }

    /// Places of what lies beyond the windings at an end, with the step between them, m.
    fn legs(&self, coil: &Coil, wound: WireKind, is_above: bool) -> Vec<(f64, f64)> {
        let middle = self.pieces.iter().position(|laid| laid.piece.kind() == wound).unwrap_or_default();
        let is_side = |index: usize| if is_above { index > middle } else { index < middle };
        let legs = self.pieces.iter().enumerate().filter(|(index, laid)| is_side(*index) && laid.piece.kind() != wound);
        let mut places = Vec::new();
        for (_, laid) in legs {
            let count = (laid.piece.length_m() / (0.25 * coil.wire_m)).ceil().clamp(4.0, MOST_PLACES);
            let step_m = laid.piece.length_m() / count;
            let mut k = 0.0;
            while k <= count {
                places.push((laid.from_m + step_m * k, step_m));
                k += 1.0;
            }
        }
        places
    }

    /// A place of a leg against the windings at about its height.
    fn leg_to_windings(&self, coil: &Coil, at_m: f64, step_m: f64, best: &mut Nearest) {
        let point = self.at(at_m);
        let angle = maths::atan2(point[1], point[0]) - coil.start_rad;
        let angle = if coil.is_right_handed { angle } else { -angle }.rem_euclid(TAU);
        let mut nearest = (f64::INFINITY, 0.0);
        let mut rise = 0.0;
        let mut begin = 0.0;
        for winding in &coil.windings {
            let (turned, grown) = (TAU * winding.turns, 0.5 * winding.turns * (winding.pitch_m[0] + winding.pitch_m[1]));
            let is_near = point[2] > rise - 2.0 * coil.wire_m && point[2] < rise + grown + 2.0 * coil.wire_m;
            // Right beside the place in each turn, and around.
            let mut span = [0.0, turned];
            let pitch_m = winding.pitch_m[0];
            if pitch_m > 0.0 && (winding.pitch_m[1] - pitch_m).abs() <= 0.0 {
                let turns = (point[2] - rise) / pitch_m;
                let room = 1.0 + 2.0 * coil.wire_m / pitch_m;
                span = [turns - room, turns + room].map(|turns| (TAU * turns).clamp(0.0, turned));
            }
            let last = (begin + span[1] - angle) / TAU * 8.0 + 1.0;
            let mut k = ((begin + span[0] - angle) / TAU).floor() * 8.0;
            while is_near && k <= last {
                let rad = angle + TAU * k / 8.0;
                if let Some(other_m) = self.wound_m(coil, rad.max(0.0)) {
                    let distance_m = self.distance_m(at_m, other_m);
                    if distance_m < nearest.0 {
                        nearest = (distance_m, other_m);
                    }
                }
                k += 1.0;
            }
            rise += grown;
            begin += turned;
        }
        // What is farther than the step to a neighbour and what it may hide cannot touch.
        if nearest.0 < 2.0 * coil.wire_m + step_m + TAU * coil.radius_m / 8.0 {
            self.refine([at_m, nearest.1], step_m.max(TAU * coil.radius_m / 16.0), best);
        }
    }
}
