//! Curves as chords: where they meet, and where they are nearest.

use forcewright_base::roots;

use crate::bounds::Bounds;
use crate::piece::Piece;
use crate::profile::{Nearest, Profile, middle};
use crate::vector::{Vector, add, cross, distance, dot, norm, scale, sub};

/// Chord error of the first look for the nearest places, relative to the size of the profiles.
const FIRST_LOOK: f64 = 1e-4;
/// Chords shorter than that, relative to the size of all, are joined to their neighbours: their direction is rounding.
const SHORT: f64 = 1e-11;
/// Chords that near, relative to their lengths, touch.
const TOUCHING: f64 = 1e-12;

/// Two pieces of curves that meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Meeting {
    pub(crate) profiles: [usize; 2],
    pub(crate) segments: [usize; 2],
    pub(crate) at_m: Vector,
}

struct Chord {
    ends: [Vector; 2],
    profile: usize,
    segment: usize,
    /// Place in the profile and the number of chords there: neighbours share an end.
    index: usize,
    count: usize,
}

impl Chord {
    fn neighbours(&self, other: &Self) -> bool {
        let apart = self.index.abs_diff(other.index);
        self.profile == other.profile && (apart <= 1 || apart + 1 >= self.count)
    }

    fn bounds(&self) -> Bounds {
        Bounds::of(self.ends)
    }
}

fn chords(profiles: &[Profile], chord_error_m: f64) -> Vec<Chord> {
    let size = profiles.iter().fold(Bounds::of([]), |all, profile| all.union(profile.bounds())).extent_m();
    let mut all = Vec::new();
    for (number, profile) in profiles.iter().enumerate() {
        let first = all.len();
        let mut from = profile.start_m;
        for (segment, piece) in profile.pieces() {
            let steps = piece.steps(chord_error_m);
            for k in 1..=steps {
                let to = piece.point(k as f64 / steps as f64);
                if distance(from, to) > SHORT * size {
                    all.push(Chord { ends: [from, to], profile: number, segment, index: all.len() - first, count: 0 });
                    from = to;
                }
            }
        }
        let count = all.len() - first;
        for chord in &mut all[first..] {
            chord.count = count;
        }
        if let [start, .., end] = &mut all[first..] {
            end.ends[1] = start.ends[0];
        }
    }
    all
}

/// A place where curves meet that should not: the first from the left.
pub(crate) fn first_meeting(profiles: &[Profile], chord_error_m: f64) -> Option<Meeting> {
    let mut all = chords(profiles, chord_error_m);
    all.sort_by(|a, b| a.bounds().min_m[0].total_cmp(&b.bounds().min_m[0]));
    for (k, one) in all.iter().enumerate() {
        let box_of_one = one.bounds();
        for two in &all[k + 1..] {
            let box_of_two = two.bounds();
            if box_of_two.min_m[0] > box_of_one.max_m[0] {
                break;
            }
            if box_of_two.min_m[1] > box_of_one.max_m[1] || box_of_one.min_m[1] > box_of_two.max_m[1] {
                continue;
            }
            if let Some(at_m) = meeting(one, two) {
                let (one, two) = if (one.profile, one.index) <= (two.profile, two.index) { (one, two) } else { (two, one) };
                return Some(Meeting { profiles: [one.profile, two.profile], segments: [one.segment, two.segment], at_m });
            }
        }
    }
    None
}

fn meeting(one: &Chord, two: &Chord) -> Option<Vector> {
    let (a, b) = (sub(one.ends[1], one.ends[0]), sub(two.ends[1], two.ends[0]));
    if one.neighbours(two) {
        // They share an end and meet beyond it only if one folds back onto the other.
        let folded = cross(a, b).abs() <= 1e-9 * norm(a) * norm(b) && dot(a, b) < 0.0;
        return (folded || one.count < 3).then(|| middle(one.ends[1], two.ends[0]));
    }
    let (place, apart) = nearest_of_chords(one.ends, two.ends);
    (apart <= TOUCHING * (norm(a) + norm(b))).then(|| add(one.ends[0], scale(a, place[0])))
}

/// The nearest places of two profiles.
pub(crate) fn nearest(one: &Profile, two: &Profile) -> Option<Nearest> {
    let size = one.bounds().union(two.bounds()).extent_m();
    let chord_error_m = (FIRST_LOOK * size).max(f64::MIN_POSITIVE);
    if let Some(meeting) = crossing(one, two, chord_error_m) {
        return Some(meeting);
    }
    let (ones, twos) = (pieces_of_chords(one, chord_error_m), pieces_of_chords(two, chord_error_m));
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    let mut least = f64::INFINITY;
    for (i, a) in ones.iter().enumerate() {
        for (j, b) in twos.iter().enumerate() {
            let distance = nearest_of_chords(a.ends, b.ends).1;
            if distance <= least + 4.0 * chord_error_m {
                least = least.min(distance);
                pairs.push((distance, i, j));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Option<Nearest> = None;
    for (distance, i, j) in pairs {
        if best.is_some_and(|best| distance - 2.0 * chord_error_m >= best.distance_m) {
            break;
        }
        let found = refine(&ones[i], &twos[j]);
        if best.is_none_or(|best| found.distance_m < best.distance_m) {
            best = Some(found);
        }
    }
    best
}

/// Where the chords of two profiles cross.
fn crossing(one: &Profile, two: &Profile, chord_error_m: f64) -> Option<Nearest> {
    let both = [one.clone(), two.clone()];
    let all = chords(&both, chord_error_m);
    let (ones, twos): (Vec<&Chord>, Vec<&Chord>) = all.iter().partition(|chord| chord.profile == 0);
    for a in &ones {
        for b in &twos {
            if let Some([s, _]) = crossing_of_chords(a.ends, b.ends) {
                let at = add(a.ends[0], scale(sub(a.ends[1], a.ends[0]), s));
                return Some(Nearest { distance_m: 0.0, at_m: [at, at], segments: [a.segment, b.segment] });
            }
        }
    }
    None
}

/// A chord with the part of the curve above it.
struct Part {
    ends: [Vector; 2],
    segment: usize,
    piece: Piece,
}

fn pieces_of_chords(profile: &Profile, chord_error_m: f64) -> Vec<Part> {
    let mut parts = Vec::new();
    for (segment, piece) in profile.pieces() {
        let steps = piece.steps(chord_error_m);
        let at = |k: usize| k as f64 / steps as f64;
        for k in 0..steps {
            let piece = piece.part(at(k), at(k + 1));
            parts.push(Part { ends: [piece.from(), piece.to()], segment, piece });
        }
    }
    parts
}

fn refine(one: &Part, two: &Part) -> Nearest {
    let across = |s: f64| {
        let a = one.piece.point(s);
        let b = two.piece.point(two.piece.nearest(a));
        (distance(a, b), a, b)
    };
    let inside = roots::minimise(|s| across(s).0, 0.0, 1.0, 1e-9).x;
    let mut best = across(inside);
    for end in [0.0, 1.0] {
        let other = across(end);
        if other.0 < best.0 {
            best = other;
        }
    }
    Nearest { distance_m: best.0, at_m: [best.1, best.2], segments: [one.segment, two.segment] }
}

/// The nearest places of two straight pieces: parameters and distance.
pub(crate) fn nearest_of_chords(a: [Vector; 2], b: [Vector; 2]) -> ([f64; 2], f64) {
    let place = |from: Vector, to: Vector, point: Vector| {
        let chord = sub(to, from);
        let square = dot(chord, chord);
        if square > 0.0 { (dot(sub(point, from), chord) / square).clamp(0.0, 1.0) } else { 0.0 }
    };
    if let Some(both) = crossing_of_chords(a, b) {
        return (both, 0.0);
    }
    let at = |chord: [Vector; 2], t: f64| add(chord[0], scale(sub(chord[1], chord[0]), t));
    let candidates =
        [[0.0, place(b[0], b[1], a[0])], [1.0, place(b[0], b[1], a[1])], [place(a[0], a[1], b[0]), 0.0], [place(a[0], a[1], b[1]), 1.0]];
    let mut best = (candidates[0], f64::INFINITY);
    for [s, t] in candidates {
        let apart = distance(at(a, s), at(b, t));
        if apart < best.1 {
            best = ([s, t], apart);
        }
    }
    best
}

/// Where two straight pieces cross or touch, as parameters; pieces in line never do.
pub(crate) fn crossing_of_chords(a: [Vector; 2], b: [Vector; 2]) -> Option<[f64; 2]> {
    let (along_a, along_b, between) = (sub(a[1], a[0]), sub(b[1], b[0]), sub(b[0], a[0]));
    let denominator = cross(along_a, along_b);
    let (s, t) = (cross(between, along_b) / denominator, cross(between, along_a) / denominator);
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then_some([s, t])
}
