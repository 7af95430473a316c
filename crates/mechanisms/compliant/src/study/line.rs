//! The axis of a beam at a state, and where it comes near to a wall or to another beam.

use std::ops::Range;

use forcewright_base::maths;
use forcewright_beam::Network;

/// Beams that meet are kept apart only beyond this part of their lengths from the node that they share.
pub(super) const NEAR_JOINT: f64 = 0.125;
/// Steps of Newton's method from the nearest samples.
const STEPS: usize = 4;

/// Parts of the stretch next to a joint in which crossings are looked for.
const FINE: usize = 16;
/// Distance, relative to a length, at which two ends are in the same place: axes end there up to the accuracy of their curve.
const TOUCH: f64 = 1e-3;
/// Beams that leave a joint within this angle of each other, rad, count as crossing: the least bending makes them cross.
const SIDE_BY_SIDE: f64 = 0.02;

/// Places that a side of the polygons spans with which a search begins.
const STRIDE: usize = 2;

/// An axis: positions and their derivatives by u at even places; between them a cubic. Lengths in m.
pub(super) struct Line(Vec<[[f64; 2]; 2]>);

/// A point of a line with two derivatives by u.
struct Local {
    at: [f64; 2],
    by: [f64; 2],
    bend: [f64; 2],
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

impl Line {
    /// A line through at least two places.
    pub(super) fn new(places: Vec<[[f64; 2]; 2]>) -> Self {
        Self(places)
    }

    /// The point at a place, m.
    pub(super) fn at(&self, u: f64) -> [f64; 2] {
        self.local(u).at
    }

    fn cells(&self) -> usize {
        self.0.len() - 1
    }

    fn local(&self, u: f64) -> Local {
        let cells = self.cells() as f64;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place from 0 to 1 times a small count")]
        let cell = ((u * cells) as usize).min(self.cells() - 1);
        let t = u * cells - cell as f64;
        let ([from, m0], [to, m1]) = (self.0[cell], self.0[cell + 1]);
        let cubic = |axis: usize| {
            let (rise, a, b) = (to[axis] - from[axis], m0[axis] / cells, m1[axis] / cells);
            let (c, d) = (3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise);
            [from[axis] + t * (a + t * (c + t * d)), (a + t * (2.0 * c + 3.0 * t * d)) * cells, (2.0 * c + 6.0 * t * d) * cells * cells]
        };
        let [x, y] = [cubic(0), cubic(1)];
        Local { at: [x[0], y[0]], by: [x[1], y[1]], bend: [x[2], y[2]] }
    }

    /// Squared distance of the line from a point, m², and where it is least within a range.
    fn nearest_to(&self, point: [f64; 2], [low, high]: [f64; 2]) -> (f64, f64) {
        let place = |i: usize| (i as f64 / self.cells() as f64).clamp(low, high);
        let square = |u: f64| {
            let apart = minus(self.at(u), point);
            dot(apart, apart)
        };
        let all = (0..=self.cells()).map(|i| (i, square(place(i))));
        let best = all.reduce(|b, next| if next.1 < b.1 { next } else { b }).map_or(0, |b| b.0);
        let (mut u, most) = (place(best), 1.0 / self.cells() as f64);
        let nearby = [(u - most).max(low), (u + most).min(high)];
        for _ in 0..STEPS {
            let here = self.local(u);
            let apart = minus(here.at, point);
            let (slope, bend) = (dot(apart, here.by), dot(here.by, here.by) + dot(apart, here.bend));
            let step = if bend > 0.0 { -slope / bend } else { -slope.signum() * most };
            u = (u + step.clamp(-most, most)).clamp(nearby[0], nearby[1]);
        }
        (square(u), u)
    }

    /// The place between two others at which the distance to a wall across an axis is least; `sign` is that of what is inside, `half_m`
    /// half the thickness.
    pub(super) fn nearest_to_wall(&self, (axis, sign): (usize, f64), half_m: impl Fn(f64) -> f64, [low, high]: [f64; 2]) -> f64 {
        let count = self.cells() as f64;
        let inside = |i: &usize| (low..=high).contains(&(*i as f64 / count));
        let rooms = (0..=self.cells()).filter(inside).map(|i| (i as f64 / count, sign * self.0[i][0][axis] - half_m(i as f64 / count)));
        let best = rooms.reduce(|b, next| if next.1 < b.1 { next } else { b });
        let (mut u, most) = (best.map_or(low, |b| b.0), 1.0 / count);
        let nearby = [(u - most).max(low), (u + most).min(high)];
        for _ in 0..STEPS {
            // The thickness is linear between its places: its slope counts, its bend does not.
            let here = self.local(u);
            let away = 1e-3 * most;
            let taper = (half_m((u + away).min(1.0)) - half_m((u - away).max(0.0))) / ((u + away).min(1.0) - (u - away).max(0.0));
            let (slope, bend) = (sign * here.by[axis] - taper, sign * here.bend[axis]);
            let step = if bend > 0.0 { -slope / bend } else { -slope.signum() * most };
            u = (u + step.clamp(-most, most)).clamp(nearby[0], nearby[1]);
        }
        u
    }
}

/// The parts of two beams that are kept apart: without what is near a node that they share.
pub(super) fn apart(network: &Network, [a, b]: [usize; 2]) -> [[f64; 2]; 2] {
    let ends = |beam: usize| [network.beams[beam].start, network.beams[beam].end];
    let part = |beam: usize, with: usize| {
        let [start, end] = ends(beam).map(|node| if ends(with).contains(&node) { NEAR_JOINT } else { 0.0 });
        [start, 1.0 - end]
    };
    [part(a, b), part(b, a)]
}

/// Two places on two beams, as parts of their lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Nearest {
    pub(super) at: [f64; 2],
    /// Whether the axes cross: then the places are an end and what is next to it on the other beam.
    pub(super) crossed: bool,
}

/// Where two beams are nearest within two ranges. Where their axes cross, within the ranges or next to a joint, the end that would have to
/// be drawn the shortest way to the other beam until they do not.
pub(super) fn closest(lines: [&Line; 2], ranges: [[f64; 2]; 2]) -> Nearest {
    let (distance, u, v) = of_polygons(lines, ranges);
    let (u, v) = settled(lines, (u, v), ranges);
    let nearest = Nearest { at: [u, v], crossed: distance <= 0.0 };
    let reach = if nearest.crossed {
        ranges
    } else if cross_at_a_joint(lines, ranges) {
        [[0.0, 1.0]; 2]
    } else {
        // Axes that cross where their polygons do not are nearer than any thickness.
        return nearest;
    };
    let ends = [0, 1].into_iter().flat_map(|which| ranges[which].map(|end| (which, end)));
    // An end that is kept apart only from a joint on is not one that can be drawn through the other beam.
    let drawn = ends.filter(|(_, end)| matches!(*end, 0.0 | 1.0)).map(|(which, end)| {
        let (square, there) = lines[1 - which].nearest_to(lines[which].at(end), reach[1 - which]);
        (square, if which == 0 { [end, there] } else { [there, end] })
    });
    let shortest = drawn.reduce(|best, next| if next.0 < best.0 { next } else { best });
    shortest.map_or(nearest, |(_, at)| Nearest { at, crossed: true })
}

/// Whether two beams that share a node cross where they are not kept apart, so near to it that they cannot be far from each other anyway: a
/// short beam may pass through the beginning of a long one, and beams that leave a node side by side through each other.
fn cross_at_a_joint(lines: [&Line; 2], ranges: [[f64; 2]; 2]) -> bool {
    let joints = |which: usize| [(ranges[which][0] > 0.0, 0.0), (ranges[which][1] < 1.0, 1.0)].into_iter().filter(|j| j.0).map(|j| j.1);
    let lengths = lines.map(|line| dot(line.0[0][1], line.0[0][1]).sqrt());
    let longest = lengths[0].max(lengths[1]);
    let reach = (NEAR_JOINT * longest).min(lengths[0]).min(lengths[1]);
    let meet = |a: f64, b: f64| {
        let apart = minus(lines[0].at(a), lines[1].at(b));
        dot(apart, apart) <= TOUCH * TOUCH * longest * longest
    };
    let mut all = joints(0).flat_map(|a| joints(1).map(move |b| [a, b]));
    all.any(|joint| {
        meet(joint[0], joint[1]) && can_meet_again(lines, joint, lengths.map(|own| (reach / own).min(1.0))) && {
            // The same arc lengths of both, as far as the longer one is let through; closer together where they may cross after next to
            // nothing.
            let sides = [0, 1].map(|which| {
                let part = reach / (lengths[which] * (FINE * FINE) as f64);
                let at = |i: usize| lines[which].at((joint[which] - (i * i) as f64 * part).abs());
                let places: Vec<[f64; 2]> = (0..=FINE).map(at).collect();
                places.windows(2).map(|w| ([w[0], w[1]], Disc::around([w[0], w[1]]))).collect::<Vec<_>>()
            });
            let crosses = |i: usize, j: usize| {
                let [(own, disc), (its, other)] = [&sides[0][i], &sides[1][j]];
                !disc.surely_beyond(other, 0.0) && of_segments(*own, *its).0 == 0.0
            };
            // The first sides meet in the node: those that leave it side by side are about to cross.
            let (leaving, other) = (sides[0][0].0[1], sides[1][0].0[1]);
            let (apart, way) = (minus(leaving, other), minus(leaving, sides[0][0].0[0]));
            dot(apart, apart) <= SIDE_BY_SIDE * SIDE_BY_SIDE * dot(way, way)
                || (0..FINE).any(|i| (0..FINE).any(|j| i + j > 0 && crosses(i, j)))
        }
    })
}

/// Whether two lines that leave a joint can meet again within parts of their lengths: the triangle that they would enclose has no angle
/// left for it unless they turn by the angle between them at the joint.
fn can_meet_again(lines: [&Line; 2], joint: [f64; 2], parts: [f64; 2]) -> bool {
    let angle = |a: [f64; 2], b: [f64; 2]| maths::atan2((a[0] * b[1] - a[1] * b[0]).abs(), dot(a, b));
    let leaving = [0, 1].map(|which| {
        let by = lines[which].local(joint[which]).by;
        if joint[which] > 0.5 { [-by[0], -by[1]] } else { by }
    });
    let turned = |which: usize| -> f64 {
        let line = lines[which];
        let cells = line.cells();
        let last = (0..cells).find(|i| *i as f64 >= parts[which] * cells as f64).unwrap_or(cells);
        let place = |i: usize| if joint[which] > 0.5 { cells - i } else { i };
        (0..last).map(|i| angle(line.0[place(i)][1], line.0[place(i + 1)][1])).sum()
    };
    angle(leaving[0], leaving[1]) <= turned(0) + turned(1) + SIDE_BY_SIDE
}

/// Goes to the nearest places by Newton's method on half the squared distance.
fn settled(lines: [&Line; 2], (mut u, mut v): (f64, f64), [range_u, range_v]: [[f64; 2]; 2]) -> (f64, f64) {
    for _ in 0..STEPS {
        let (p, q) = (lines[0].local(u), lines[1].local(v));
        let apart = minus(q.at, p.at);
        let gradient = [-dot(apart, p.by), dot(apart, q.by)];
        // At an end that the gradient presses against, only the other place moves.
        let pressed = |at: f64, by: f64, [low, high]: [f64; 2]| (at <= low && by > 0.0) || (at >= high && by < 0.0);
        let held = [pressed(u, gradient[0], range_u), pressed(v, gradient[1], range_v)];
        let (uu, vv, uv) = (dot(p.by, p.by) - dot(apart, p.bend), dot(q.by, q.by) + dot(apart, q.bend), -dot(p.by, q.by));
        let determinant = uu * vv - uv * uv;
        let (du, dv) = match held {
            [false, false] if determinant > 0.0 && uu > 0.0 => {
                ((uv * gradient[1] - vv * gradient[0]) / determinant, (uv * gradient[0] - uu * gradient[1]) / determinant)
            }
            [false, true] if uu > 0.0 => (-gradient[0] / uu, 0.0),
            [true, false] if vv > 0.0 => (0.0, -gradient[1] / vv),
            _ => (0.0, 0.0),
        };
        let most = |line: &Line| 1.0 / line.cells() as f64;
        u = (u + du.clamp(-most(lines[0]), most(lines[0]))).clamp(range_u[0], range_u[1]);
        v = (v + dv.clamp(-most(lines[1]), most(lines[1]))).clamp(range_v[0], range_v[1]);
    }
    (u, v)
}

/// Squared distance of the polygons through the places, and where it is least; 0 where they cross.
fn of_polygons([one, other]: [&Line; 2], ranges: [[f64; 2]; 2]) -> (f64, f64, f64) {
    let cells = |line: &Line, [low, high]: [f64; 2]| {
        let count = line.cells() as f64;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "places from 0 to 1 times a small count")]
        let ends = ((low * count).round() as usize, (high * count).round() as usize);
        ends.0..ends.1
    };
    let (count_u, count_v) = (one.cells() as f64, other.cells() as f64);
    let mut best = (f64::INFINITY, 0.0, 0.0);
    let last = |line: &Line, i: usize, range: &Range<usize>| (i + STRIDE).min(range.end).min(line.cells());
    let (own, its) = (cells(one, ranges[0]), cells(other, ranges[1]));
    let sides: Vec<(usize, usize, Disc)> = its
        .clone()
        .step_by(STRIDE)
        .map(|j| {
            let j_end = last(other, j, &its);
            (j, j_end, Disc::around([other.0[j][0], other.0[j_end][0]]))
        })
        .collect();
    for i in own.clone().step_by(STRIDE) {
        let i_end = last(one, i, &own);
        let disc = Disc::around([one.0[i][0], one.0[i_end][0]]);
        for (j, j_end, other_disc) in &sides {
            if disc.surely_beyond(other_disc, best.0) {
                continue;
            }
            let (distance, s, t) = of_segments([one.0[i][0], one.0[i_end][0]], [other.0[*j][0], other.0[*j_end][0]]);
            if distance < best.0 {
                let along = |from: usize, to: usize, part: f64| from as f64 + part * (to - from) as f64;
                best = (distance, along(i, i_end, s) / count_u, along(*j, *j_end, t) / count_v);
            }
        }
    }
    best
}

/// The disc that a segment is a diameter of.
struct Disc {
    centre: [f64; 2],
    radius: f64,
}

impl Disc {
    fn around([from, to]: [[f64; 2]; 2]) -> Self {
        let along = minus(to, from);
        Self { centre: [0, 1].map(|axis| f64::midpoint(from[axis], to[axis])), radius: 0.5 * dot(along, along).sqrt() }
    }

    /// Whether the squares of all distances between two discs are larger than some square, rounding included.
    fn surely_beyond(&self, other: &Self, square: f64) -> bool {
        let apart = minus(other.centre, self.centre);
        let reach = (square.sqrt() + self.radius + other.radius) * (1.0 + 1e-9);
        dot(apart, apart) > reach * reach
    }
}

/// Squared distance of two segments, and the parts of them at which it is least: at an end of one of them, unless they cross.
fn of_segments(one: [[f64; 2]; 2], other: [[f64; 2]; 2]) -> (f64, f64, f64) {
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let (d, e, r) = (minus(one[1], one[0]), minus(other[1], other[0]), minus(other[0], one[0]));
    let turn = cross(d, e);
    if turn != 0.0 {
        let (s, t) = (cross(r, e) / turn, cross(r, d) / turn);
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            return (0.0, s, t);
        }
    }
    let to_segment = |p: [f64; 2], [from, to]: [[f64; 2]; 2]| {
        let (along, off) = (minus(to, from), minus(p, from));
        let part = (dot(off, along) / dot(along, along).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let rest = [off[0] - part * along[0], off[1] - part * along[1]];
        (dot(rest, rest), part)
    };
    let mut best = (f64::INFINITY, 0.0, 0.0);
    for (i, end) in [0.0, 1.0].into_iter().enumerate() {
        let (distance, part) = to_segment(one[i], other);
        if distance < best.0 {
            best = (distance, end, part);
        }
        let (distance, part) = to_segment(other[i], one);
        if distance < best.0 {
            best = (distance, part, end);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of a circle of radius 1 about (x, 0), from the top to the right.
    fn quarter(x: f64) -> Line {
        let angle = std::f64::consts::FRAC_PI_2;
        let place = |i: i32| {
            let (sin, cos) = maths::sin_cos(angle * f64::from(i) / 16.0);
            [[x + sin, cos], [angle * cos, -angle * sin]]
        };
        Line::new((0..=16).map(place).collect())
    }

    #[test]
    fn a_circle_is_nearest_to_a_wall_where_it_is_parallel_to_it() {
        // To a wall on the right at its end, to one above at its start; between two places at the nearer one.
        assert!((quarter(0.0).nearest_to_wall((0, -1.0), |_| 0.1, [0.0, 1.0]) - 1.0).abs() < 1e-6);
        assert!(quarter(0.0).nearest_to_wall((1, -1.0), |_| 0.1, [0.0, 1.0]).abs() < 1e-6);
        assert!((quarter(0.0).nearest_to_wall((0, -1.0), |_| 0.1, [0.2, 0.7]) - 0.7).abs() < 1e-12);
        // Thicker by a tenth per place: where the slope of the circle is a tenth.
        let u = quarter(0.0).nearest_to_wall((1, -1.0), |u| 0.1 * u, [0.0, 1.0]);
        let angle = std::f64::consts::FRAC_PI_2;
        assert!((angle * maths::sin(angle * u) - 0.1).abs() < 1e-4, "{u}");
    }

    #[test]
    fn two_circles_are_nearest_on_the_line_of_their_centres() {
        // The second is mirrored: its line runs over the left half.
        let mirrored = Line::new(quarter(-3.0).0.iter().map(|[at, by]| [[-at[0], at[1]], [-by[0], by[1]]]).collect());
        for (ranges, place) in [([[0.0, 1.0]; 2], 1.0), ([[0.0, 0.75]; 2], 0.75)] {
            let Nearest { at: [u, v], crossed } = closest([&quarter(0.0), &mirrored], ranges);
            assert!((u - place).abs() < 1e-6 && (v - place).abs() < 1e-6 && !crossed, "{u} {v}");
        }
    }

    /// A straight line between two points.
    fn straight(from: [f64; 2], to: [f64; 2]) -> Line {
        let by = minus(to, from);
        Line::new((0..=16).map(|i| [[0, 1].map(|a| from[a] + by[a] * f64::from(i) / 16.0), by]).collect())
    }

    #[test]
    fn lines_that_cross_are_undone_at_the_end_that_is_nearest_to_the_other() {
        let (across, along) = (straight([0.0, -1.0], [0.0, 3.0]), straight([-2.0, 0.0], [5.0, 0.0]));
        let Nearest { at: [u, v], crossed } = closest([&across, &along], [[0.0, 1.0]; 2]);
        assert!(crossed && u == 0.0 && (v - 2.0 / 7.0).abs() < 1e-6, "{u} {v}");
        // Where the near end belongs to a joint of both, the other line's.
        let Nearest { at: [u, v], crossed } = closest([&across, &along], [[0.125, 1.0], [0.0, 1.0]]);
        assert!(crossed && v == 0.0 && (u - 0.25).abs() < 1e-6, "{u} {v}");
        // The same whichever comes first.
        let Nearest { at, crossed } = closest([&along, &across], [[0.0, 1.0], [0.125, 1.0]]);
        assert!(crossed && at.map(f64::to_bits) == [v, u].map(f64::to_bits), "{at:?}");
    }

    #[test]
    fn crossings_next_to_a_joint_are_seen() {
        // Lines that only meet in a joint do not cross.
        let (short, long) = (straight([0.5, 0.5], [0.0, 0.0]), straight([0.0, 0.0], [10.0, 0.0]));
        assert!(!closest([&short, &long], [[0.0, 0.875], [0.125, 1.0]]).crossed);
        // Side by side at the joint counts; a tenth of a radian apart does not, unless they bend towards each other.
        let long = straight([0.0, 0.0], [10.0, 0.0]);
        let ranges = [[0.125, 1.0]; 2];
        assert!(closest([&straight([0.0, 0.0], [8.0, 0.1]), &long], ranges).crossed);
        assert!(!closest([&straight([0.0, 0.0], [8.0, 0.8]), &long], ranges).crossed);
        // y = 0.1 x − x², crosses at x = 0.1, long before the range begins.
        let place = |i: i32| {
            let x = f64::from(i) / 16.0;
            [[x, 0.1 * x - x * x], [1.0, 0.1 - 2.0 * x]]
        };
        let Nearest { at: [u, v], crossed } = closest([&Line::new((0..=16).map(place).collect()), &long], ranges);
        assert!(crossed && (u - 1.0).abs() < 1e-15 && (v - 0.1).abs() < 1e-6, "{u} {v}");
    }
}
