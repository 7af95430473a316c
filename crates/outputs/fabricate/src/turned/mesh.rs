//! A turned part as a closed mesh.
//!
//! Sides are ribbons between helices through the corners of the profile in chords. Each helix has corners of its own, shared by the
//! ribbons on both its sides, and the ends of ribbons have those where planes cut them; a ribbon is a convex strip in the plane of ζ and
//! τ = z − ζ, which is filled between its two sides by taking the lower next corner each time.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths;

use super::{Helical, Side, Stack, polar};
use crate::cap::{self, Polygon};
use crate::error::{Boundary, Error, Place, Problem};
use crate::mesh::Mesh;
use crate::shape::{MM_PER_M, Point};

/// Shares of the allowed distance: of the chords of a profile, of those of helices, and of what is skew between both.
const CHORD: f64 = 0.4;
const HELIX: f64 = 0.4;
const SKEW: f64 = 0.2;
/// Most corners of a mesh.
const MOST: f64 = 1e7;

/// The corners of a boundary across the axis, counterclockwise.
type Rim = Vec<usize>;

/// The body with facets within `chord` mm of it.
pub(crate) fn mesh(stack: &Stack, chord: f64) -> Result<Mesh, Error> {
    let about: f64 = stack.sides.iter().zip(stack.levels.windows(2)).map(|(side, ends)| corners(side, ends[1] - ends[0], chord)).sum();
    if about.is_nan() || about > MOST {
        return Err(Error { place: Place::Part, problem: Problem::TooManyCorners { corners: about, most: MOST } });
    }
    let mut growing = Growing { mesh: Mesh { corners: Vec::new(), triangles: Vec::new() } };
    let mut rims: Vec<[Rim; 2]> = Vec::new();
    for (side, ends) in stack.sides.iter().zip(stack.levels.windows(2)) {
        let ends = [ends[0], ends[1]];
        rims.push(match side {
            Side::Round { radius } => growing.cylinder(*radius, ends, chord, true),
            Side::Helical(helical) => growing.helix(helical, ends, chord),
        });
    }
    let bore = (stack.bore > 0.0).then(|| growing.cylinder(stack.bore, [0.0, stack.height()], chord, false));
    let last = rims.len();
    for level in 0..=last {
        let is_up = level == last || level > 0 && stack.is_larger_below(level);
        let below = (level > 0).then(|| &rims[level - 1][1]);
        let above = rims.get(level).map(|rim| &rim[0]);
        let bore = bore.as_ref().map(|rims| &rims[usize::from(level == last)]);
        let (outer, inner) = match (below, above) {
            (Some(below), Some(above)) => {
                if is_up {
                    (below, Some(above))
                } else {
                    (above, Some(below))
                }
            }
            (Some(rim), None) | (None, Some(rim)) => (rim, bore),
            (None, None) => continue,
        };
        growing.flat(outer, inner, is_up)?;
    }
    let mesh = growing.mesh;
    let is_folded = |triangle: &[usize; 3]| {
        let [a, b, c] = triangle.map(|corner| mesh.corners[corner].map(f32::to_bits));
        a == b || b == c || c == a
    };
    if mesh.triangles.iter().any(is_folded) {
        return Err(Error { place: Place::Part, problem: Problem::TooSmall });
    }
    Ok(mesh)
}

/// Corners of a circle whose chords are near enough.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a positive number; what is too many was refused before")]
fn round_corners(radius: f64, chord: f64) -> usize {
    // 1 − cos x = 2 sin²(x/2)
    let half = 2.0 * maths::asin((0.5 * chord / radius).sqrt().min(0.6));
    (PI / half).ceil().max(6.0) as usize
}

/// The greatest angle between corners of a helix, rad.
fn step_of_helix(helical: &Helical, chord: f64) -> f64 {
    TAU / round_corners(helical.radii[1], HELIX * chord) as f64
}

/// About how many corners a side has.
fn corners(side: &Side, height: f64, chord: f64) -> f64 {
    match side {
        Side::Round { radius } => 2.0 * round_corners(*radius, chord) as f64,
        Side::Helical(helical) => {
            let step = step_of_helix(helical, chord);
            let rows = height * helical.winding.abs() / step + 2.0;
            // Chords of an arc and parts of a line, as they are made.
            let of_span = |span: &super::Span| match span.arc {
                Some((_, radius, _, sweep)) => (sweep.abs() / (8.0 * CHORD * chord / radius).sqrt()).max(1.0),
                None => 1.0 + (span.to[1] - span.from[1]).abs() * step / (4.0 * SKEW * chord),
            };
            let chords: f64 = helical.spans.iter().map(of_span).sum();
            f64::from(helical.starts) * (chords + 1.0) * rows + TAU / step
        }
    }
}

/// The chords of one groove, by their corners (ζ, ρ), the last of them a spacing beyond the first.
fn chords(helical: &Helical, chord: f64, step: f64) -> Vec<Point> {
    let mut closed = helical.groove.clone();
    // Closed by a line far below, which no chord comes near.
    let end_m = closed.segments.last().map_or(closed.start_m, forcewright_curves::Segment::end_m);
    let below = |x: f64| forcewright_curves::Segment::Line { to_m: [x, -1.0] };
    closed.segments.extend([below(end_m[0]), below(closed.start_m[0])]);
    closed.segments.push(forcewright_curves::Segment::Line { to_m: closed.start_m });
    let corners = closed.tessellate(CHORD * chord / MM_PER_M);
    let mut corners: Vec<Point> =
        corners.into_iter().filter(|corner| corner[1] > -0.5).map(|corner| corner.map(|m| m * MM_PER_M)).collect();
    if let [first, .., last] = corners.as_mut_slice() {
        *last = [first[0] + helical.spacing, first[1]];
    }
    let mut fine = Vec::new();
    for pair in corners.windows(2) {
        let skew = (pair[1][1] - pair[0][1]).abs() * step / (4.0 * SKEW * chord);
        let parts = super::spline::count(skew);
        fine.extend((0..parts).map(|k| [0, 1].map(|x| pair[0][x] + (pair[1][x] - pair[0][x]) * k as f64 / parts as f64)));
    }
    fine.extend(corners.last());
    fine
}

/// The mesh while it grows.
struct Growing {
    mesh: Mesh,
}

impl Growing {
    #[allow(clippy::cast_possible_truncation, reason = "rounding to single precision is meant")]
    fn corner(&mut self, [x, y]: Point, z: f64) -> usize {
        self.mesh.corners.push([x as f32, y as f32, z as f32]);
        self.mesh.corners.len() - 1
    }

    /// A round wall, seen from outside or, as a bore, from inside: the corners at its lower and its upper end.
    fn cylinder(&mut self, radius: f64, ends: [f64; 2], chord: f64, is_outside: bool) -> [Rim; 2] {
        let count = round_corners(radius, chord);
        let [low, high] =
            ends.map(|z| -> Rim { (0..count).map(|k| self.corner(polar(radius, TAU * k as f64 / count as f64), z)).collect() });
        for k in 0..count {
            let next = (k + 1) % count;
            let quad = [[low[k], low[next], high[next]], [low[k], high[next], high[k]]];
            self.mesh.triangles.extend(quad.map(|[a, b, c]| if is_outside { [a, b, c] } else { [a, c, b] }));
        }
        [low, high]
    }

    /// The walls of helical grooves: the corners at their lower and their upper end.
    fn helix(&mut self, helical: &Helical, [low, high]: [f64; 2], chord: f64) -> [Rim; 2] {
        let height = high - low;
        let step = step_of_helix(helical, chord);
        let profile = chords(helical, chord, step);
        let (lines, is_right) = (profile.len() - 1, helical.winding > 0.0);
        let (rows, rise) = (super::spline::count(height * helical.winding.abs() / step), step / helical.winding.abs());
        // Grooves follow each other along ζ: those of a right-handed part clockwise.
        let angle = |start: u32| {
            let turn = TAU * f64::from(start) / f64::from(helical.starts);
            helical.phase + if is_right { -turn } else { turn }
        };
        let mut helices = Vec::new();
        for start in 0..helical.starts {
            for &[along, radius] in &profile[..lines] {
                helices.push(self.line(helical.winding, angle(start), [along, radius], [low, height], rows));
            }
        }
        let mut rims = [Rim::new(), Rim::new()];
        for index in 0..helices.len() {
            let (start, k) = (u32::try_from(index / lines).unwrap_or_default(), index % lines);
            let (here, next) = ([profile[k], profile[k + 1]], (index + 1) % helices.len());
            let mut ends = [0.0, height].map(|z| self.end(helical.winding, angle(start), here, [low, z], rise));
            let corner = |index: usize, row: usize| (helices[index][row], row as f64 / rows as f64 * height);
            let [left, right] = [(index, here[0][0]), (next, here[1][0])]
                .map(|(index, along)| (0..=rows).map(|row| (corner(index, row).0, corner(index, row).1 - along)).collect::<Vec<_>>());
            for (rim, (end, row)) in rims.iter_mut().zip(ends.iter().zip([0, rows])) {
                rim.push(helices[index][row]);
                rim.extend(end.iter().map(|corner| corner.0));
            }
            // The ends belong to the side that they rise to.
            let [bottom, top] = &mut ends;
            let (mut left, mut right) = (left, right);
            if left[0].1 > right[0].1 {
                // From the lowest corner, which is on the right.
                bottom.reverse();
                left = std::iter::once(right[0]).chain(bottom.drain(..)).chain(left).collect();
                top.reverse();
                right.append(top);
                right.extend(left.last());
            } else if left[0].1 < right[0].1 {
                right = std::iter::once(left[0]).chain(bottom.drain(..)).chain(right).collect();
                left.append(top);
                left.extend(right.last());
            }
            self.ribbon(&left, &right, is_right);
        }
        if is_right {
            for rim in &mut rims {
                rim.reverse();
            }
        }
        rims
    }

    /// Corners of a helix, from its lower end upwards.
    fn line(&mut self, winding: f64, angle: f64, [along, radius]: Point, [low, height]: [f64; 2], rows: usize) -> Vec<usize> {
        let at = |row: usize| height * (row as f64 / rows as f64);
        (0..=rows).map(|row| self.corner(polar(radius, angle + winding * (at(row) - along)), low + at(row))).collect()
    }

    /// Corners between both ends of where a plane cuts a ribbon, with their τ: in equal steps of it.
    fn end(&mut self, winding: f64, angle: f64, [from, to]: [Point; 2], [low, z]: [f64; 2], rise: f64) -> Vec<(usize, f64)> {
        let parts = super::spline::count((to[0] - from[0]).abs() / rise);
        let at = |k: usize| [0, 1].map(|x| from[x] + (to[x] - from[x]) * k as f64 / parts as f64);
        let mut corner = |[along, radius]: Point| (self.corner(polar(radius, angle + winding * (z - along)), low + z), z - along);
        (1..parts).map(|k| corner(at(k))).collect()
    }

    /// Triangles between two chains of corners whose second numbers ascend. Where both begin, or end, with the same corner they meet.
    fn ribbon(&mut self, left: &[(usize, f64)], right: &[(usize, f64)], is_right: bool) {
        let (mut i, mut j) = (0, 0);
        let mut add = |a: usize, b: usize, c: usize| self.mesh.triangles.push(if is_right { [a, c, b] } else { [a, b, c] });
        if left[0].0 == right[0].0 {
            add(left[0].0, right[1].0, left[1].0);
            (i, j) = (1, 1);
        }
        while i + 1 < left.len() || j + 1 < right.len() {
            let (next_left, next_right) = (left.get(i + 1), right.get(j + 1));
            match (next_left, next_right) {
                (Some(up), Some(beside)) if up.0 == beside.0 => {
                    add(left[i].0, right[j].0, up.0);
                    break;
                }
                (Some(up), beside) if beside.is_none_or(|beside| up.1 <= beside.1) => {
                    add(left[i].0, right[j].0, up.0);
                    i += 1;
                }
                (_, Some(beside)) => {
                    add(left[i].0, right[j].0, beside.0);
                    j += 1;
                }
                _ => break,
            }
        }
    }

    /// A plane within a rim and outside another one.
    fn flat(&mut self, outer: &[usize], inner: Option<&Rim>, is_up: bool) -> Result<(), Error> {
        let chain: Vec<usize> = outer.iter().chain(inner.into_iter().flat_map(|rim| rim.iter().rev())).copied().collect();
        let plane = |corner: &usize| [0, 1].map(|axis| f64::from(self.mesh.corners[*corner][axis]));
        let mut polygons = vec![Polygon::new(Boundary::Outline, chain[..outer.len()].iter().map(plane))?];
        if inner.is_some() {
            polygons.push(Polygon::new(Boundary::Hole(0), chain[outer.len()..].iter().map(plane))?);
        }
        if polygons.iter().map(|polygon| polygon.corners.len()).sum::<usize>() != chain.len() {
            return Err(Error { place: Place::Part, problem: Problem::TooSmall });
        }
        let triangles = cap::triangles(&polygons)?.into_iter().map(|triangle| triangle.map(|corner| chain[corner]));
        self.mesh.triangles.extend(triangles.map(|[a, b, c]| if is_up { [a, b, c] } else { [a, c, b] }));
        Ok(())
    }
}
