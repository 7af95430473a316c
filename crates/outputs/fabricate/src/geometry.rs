//! Plane geometry of arcs and splines: area, points, chords, arcs in the place of splines. All lengths in one unit, mm.

use forcewright_base::maths;

/// A point or a vector.
pub(crate) type Point = [f64; 2];

/// A cubic as its four Bézier points.
pub(crate) type Bezier = [Point; 4];

pub(crate) fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(crate) fn norm(a: Point) -> f64 {
    maths::hypot(a[0], a[1])
}

/// `a + t b`.
pub(crate) fn along(a: Point, t: f64, b: Point) -> Point {
    [a[0] + t * b[0], a[1] + t * b[1]]
}

fn between(a: Point, b: Point, t: f64) -> Point {
    // Exact at both ends.
    [a[0] * (1.0 - t) + b[0] * t, a[1] * (1.0 - t) + b[1] * t]
}

/// A clamped cubic B-spline; see `forcewright_curves::Spline`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spline {
    pub(crate) control: Vec<Point>,
    pub(crate) knots: Vec<f64>,
}

impl Spline {
    /// The polynomial pieces in their order.
    ///
    /// The Bézier points of the piece over `[a, b]` are the blossom at `(a, a, a)`, `(a, a, b)`, `(a, b, b)`, `(b, b, b)`.
    pub(crate) fn beziers(&self) -> Vec<Bezier> {
        let spans = (3..self.control.len()).filter(|&span| self.knots[span] < self.knots[span + 1]);
        let piece = |span: usize| {
            let (a, b) = (self.knots[span], self.knots[span + 1]);
            [[a, a, a], [a, a, b], [a, b, b], [b, b, b]].map(|arguments| self.blossom(span, arguments))
        };
        spans.map(piece).collect()
    }

    /// De Boor's algorithm with an argument of its own at each level.
    fn blossom(&self, span: usize, arguments: [f64; 3]) -> Point {
        let mut points = [self.control[span - 3], self.control[span - 2], self.control[span - 1], self.control[span]];
        for (level, argument) in arguments.into_iter().enumerate() {
            for j in (level + 1..4).rev() {
                let (low, high) = (self.knots[span - 3 + j], self.knots[span + j - level]);
                points[j] = between(points[j - 1], points[j], (argument - low) / (high - low));
            }
        }
        points[3]
    }

    /// The two parts before and after the knot `t`, which lies between the ends.
    pub(crate) fn split(mut self, t: f64) -> (Self, Self) {
        while self.knots.partition_point(|&knot| knot <= t) - self.knots.partition_point(|&knot| knot < t) < 3 {
            self.insert(t);
        }
        let first = self.knots.partition_point(|&knot| knot < t);
        let (mut low, mut high) = (self.knots[..first + 3].to_vec(), self.knots[first..].to_vec());
        low.push(t);
        high.insert(0, t);
        (Self { control: self.control[..first].to_vec(), knots: low }, Self { control: self.control[first - 1..].to_vec(), knots: high })
    }

    /// Boehm's insertion of one knot; the curve stays.
    fn insert(&mut self, t: f64) {
        let span = self.knots.partition_point(|&knot| knot <= t) - 1;
        let mut control = self.control[..=span - 3].to_vec();
        for i in span - 2..=span {
            let share = (t - self.knots[i]) / (self.knots[i + 3] - self.knots[i]);
            control.push(between(self.control[i - 1], self.control[i], share));
        }
        control.extend_from_slice(&self.control[span..]);
        self.control = control;
        self.knots.insert(span + 1, t);
    }
}

/// Twice the area swept from the origin along a cubic.
pub(crate) fn twice_swept(b: &Bezier) -> f64 {
    let c = |i: usize, j: usize| cross(b[i], b[j]);
    (6.0 * c(0, 1) + 3.0 * c(0, 2) + c(0, 3) + 3.0 * c(1, 2) + 3.0 * c(1, 3) + 6.0 * c(2, 3)) / 10.0
}

/// The point of a cubic at `t` in [0, 1].
pub(crate) fn cubic_at(b: &Bezier, t: f64) -> Point {
    let (p, q, r) = (between(b[0], b[1], t), between(b[1], b[2], t), between(b[2], b[3], t));
    between(between(p, q, t), between(q, r, t), t)
}

/// The parts of a cubic before and after `t`.
fn halves(b: &Bezier, t: f64) -> (Bezier, Bezier) {
    let (p, q, r) = (between(b[0], b[1], t), between(b[1], b[2], t), between(b[2], b[3], t));
    let (s, u) = (between(p, q, t), between(q, r, t));
    let middle = between(s, u, t);
    ([b[0], p, s, middle], [middle, u, r, b[3]])
}

/// Appends the ends of equal steps in the parameter whose chords lie within `chord` of the cubic.
///
/// A chord over a step `h` is off by at most `h² max|B″|/8`, and `|B″|` is largest at an end.
pub(crate) fn chords_of_cubic(b: &Bezier, chord: f64, out: &mut Vec<Point>) {
    let bend = |i: usize| norm(sub(sub(b[i + 2], b[i + 1]), sub(b[i + 1], b[i])));
    let steps = (6.0 * bend(0).max(bend(1)) / (8.0 * chord)).sqrt().ceil().max(1.0);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, and bounded by the size of parts")]
    let count = steps as usize;
    out.extend((1..count).map(|step| cubic_at(b, step as f64 / steps)));
    out.push(b[3]);
}

/// Number of equal chords of an arc that lie within `chord` of it; six or more for the whole circle.
pub(crate) fn chord_count(radius: f64, sweep_rad: f64, chord: f64) -> usize {
    // r (1 − cos(φ/2)) ≤ r φ²/8.
    let widest = (8.0 * chord / radius).sqrt().min(std::f64::consts::FRAC_PI_3);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, and bounded by the size of parts")]
    let count = (sweep_rad.abs() / widest).ceil().max(1.0) as usize;
    count
}

/// An arc by where it ends and its bulge, the tangent of a quarter of its angle; 0 is straight, positive counterclockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bulge {
    pub(crate) to: Point,
    pub(crate) bulge: f64,
}

/// Appends arcs within `chord` of the cubic that join each other and its ends with common tangents.
///
/// Pairs of arcs (biarcs) with tangent lengths equal, after Bolton: Biarc curves. Computer-Aided Design 7(2), 1975; where a pair is too
/// far off, the cubic is halved. The distance is measured at 15 points of each piece, and a tenth is left for what is between them.
pub(crate) fn arcs_of_cubic(b: &Bezier, chord: f64, out: &mut Vec<Bulge>) {
    halved_into_arcs(b, chord, 0, out);
}

fn halved_into_arcs(b: &Bezier, chord: f64, depth: usize, out: &mut Vec<Bulge>) {
    // A cusp has no tangent to keep, and pieces around it shrink below any bound.
    const DEEPEST: usize = 24;
    if let Some(pair) = biarc(b)
        && strays_from(b, &pair) <= 0.9 * chord
    {
        out.extend(pair);
    } else if depth == DEEPEST {
        out.push(Bulge { to: b[3], bulge: 0.0 });
    } else {
        let (first, second) = halves(b, 0.5);
        halved_into_arcs(&first, chord, depth + 1, out);
        halved_into_arcs(&second, chord, depth + 1, out);
    }
}

/// Two arcs with the ends and end tangents of the cubic; `None` where that would take more than a third of a circle.
fn biarc(b: &Bezier) -> Option<[Bulge; 2]> {
    let (begin, end) = (direction([b[0], b[1], b[2], b[3]])?, direction([b[3], b[2], b[1], b[0]])?);
    let end = [-end[0], -end[1]];
    let v = sub(b[3], b[0]);
    let straight = dot(v, along(begin, 1.0, end));
    let opening = sub(begin, end);
    if straight <= 0.0 {
        return None;
    }
    let length = dot(v, v) / (straight + (straight * straight + dot(opening, opening) * dot(v, v)).sqrt());
    let joint = between(along(b[0], length, begin), along(b[3], -length, end), 0.5);
    let bulge = |chord: Point, tangent: Point| cross(tangent, chord) / (norm(chord) + dot(tangent, chord));
    let back = sub(b[0], joint);
    let first = Bulge { to: joint, bulge: bulge([-back[0], -back[1]], begin) };
    // Seen from its end, the second arc bends the other way.
    let second = Bulge { to: b[3], bulge: -bulge(sub(joint, b[3]), [-end[0], -end[1]]) };
    let widest = 0.5;
    (first.bulge.abs() < widest && second.bulge.abs() < widest).then_some([first, second])
}

/// Direction in which a cubic leaves its first point; `None` when all points are one.
fn direction(b: Bezier) -> Option<Point> {
    let size = norm(sub(b[1], b[0])).max(norm(sub(b[2], b[0]))).max(norm(sub(b[3], b[0])));
    let leaves = b[1..].iter().map(|&point| sub(point, b[0])).find(|&leg| norm(leg) > 1e-9 * size)?;
    let length = norm(leaves);
    Some([leaves[0] / length, leaves[1] / length])
}

/// Largest distance of points of the cubic from the pair of arcs.
fn strays_from(b: &Bezier, pair: &[Bulge; 2]) -> f64 {
    let joint = pair[0].to;
    let first_chord = sub(joint, b[0]);
    let second_chord = sub(b[3], joint);
    let tangent = along(first_chord, norm(first_chord) / norm(second_chord), second_chord);
    let distance = |k: u32| {
        let point = cubic_at(b, f64::from(k) / 16.0);
        let is_first = dot(sub(point, joint), tangent) < 0.0;
        if is_first { from_arc(point, b[0], pair[0]) } else { from_arc(point, joint, pair[1]) }
    };
    (1..16).map(distance).fold(0.0, f64::max)
}

/// Distance of a point from the circle through `from` and the end of the arc; sound for the straight arc too.
fn from_arc(point: Point, from: Point, arc: Bulge) -> f64 {
    let chord = sub(arc.to, from);
    let length = norm(chord);
    let unit = [chord[0] / length, chord[1] / length];
    let offset = sub(point, between(from, arc.to, 0.5));
    let (u, v) = (dot(unit, offset), cross(unit, offset));
    // The circle in the frame of its chord, times the height s of its crown: s(u² + v² − l²/4) − (s² − l²/4) v = 0.
    let (crown, quarter) = (-0.5 * arc.bulge * length, 0.25 * length * length);
    let excess = crown * (u * u + v * v - quarter) - (crown * crown - quarter) * v;
    let middle = norm([crown * u, crown * v - 0.5 * (crown * crown - quarter)]);
    excess.abs() / (middle + 0.5 * (crown * crown + quarter))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A curve with an inflection, three spans.
    fn wave() -> Spline {
        Spline {
            control: vec![[0.0, 0.0], [1.0, 2.0], [3.0, 2.5], [5.0, -2.0], [8.0, 0.0], [9.0, 1.0]],
            knots: vec![0.0, 0.0, 0.0, 0.0, 0.3, 0.5, 1.0, 1.0, 1.0, 1.0],
        }
    }

    /// The Cox–de Boor recursion, as it is written in textbooks.
    fn textbook(spline: &Spline, t: f64) -> Point {
        fn basis(knots: &[f64], i: usize, degree: usize, t: f64) -> f64 {
            if degree == 0 {
                return f64::from(u8::from(knots[i] <= t && t < knots[i + 1]));
            }
            let part = |above: f64, below: f64, of: f64| if below > 0.0 { above / below * of } else { 0.0 };
            part(t - knots[i], knots[i + degree] - knots[i], basis(knots, i, degree - 1, t))
                + part(knots[i + degree + 1] - t, knots[i + degree + 1] - knots[i + 1], basis(knots, i + 1, degree - 1, t))
        }
        let mut sum = [0.0; 2];
        for (i, &point) in spline.control.iter().enumerate() {
            sum = along(sum, basis(&spline.knots, i, 3, t), point);
        }
        sum
    }

    #[test]
    fn bezier_pieces_and_split_halves_are_the_spline() {
        let spline = wave();
        let ends = [0.0, 0.3, 0.5, 1.0];
        for (k, piece) in spline.beziers().iter().enumerate() {
            for s in [0.1, 0.4, 0.9] {
                let want = textbook(&spline, ends[k] + s * (ends[k + 1] - ends[k]));
                assert!(norm(sub(cubic_at(piece, s), want)) < 1e-14, "piece {k} at {s}");
            }
        }
        for t in [0.4, 0.3] {
            let (low, high) = spline.clone().split(t);
            for (half, s) in [(&low, 0.1), (&low, t - 1e-9), (&high, t), (&high, 0.8)] {
                assert!(norm(sub(textbook(half, s), textbook(&spline, s))) < 1e-14, "split at {t}, point {s}");
            }
            assert_eq!(low.control.len() + 4, low.knots.len());
            assert_eq!(high.control.len() + 4, high.knots.len());
        }
    }

    #[test]
    fn chords_keep_their_distance_and_hardly_more() {
        for chord in [1e-1, 1e-3] {
            for piece in wave().beziers() {
                let mut points = vec![piece[0]];
                chords_of_cubic(&piece, chord, &mut points);
                let steps = points.len() - 1;
                let mut worst: f64 = 0.0;
                for (k, ends) in points.windows(2).enumerate() {
                    let straight = Bulge { to: ends[1], bulge: 0.0 };
                    for s in 1..20 {
                        let t = (k as f64 + f64::from(s) / 20.0) / steps as f64;
                        worst = worst.max(from_arc(cubic_at(&piece, t), ends[0], straight));
                    }
                }
                assert!(worst <= chord && worst > 0.1 * chord, "{worst} for {chord}");
            }
        }
        assert_eq!(chord_count(10.0, std::f64::consts::TAU, 10.0), 6);
        let (radius, chord) = (10.0, 1e-3);
        let step = std::f64::consts::TAU / chord_count(radius, std::f64::consts::TAU, chord) as f64;
        let sagitta = radius * (1.0 - maths::cos(0.5 * step));
        assert!(sagitta <= chord && sagitta > 0.97 * chord);
    }

    #[test]
    fn arcs_follow_a_cubic_with_common_tangents() {
        let mut counts = Vec::new();
        for chord in [1e-2, 1e-3, 1e-4] {
            let mut from = [0.0, 0.0];
            let mut before: Option<f64> = None;
            let mut count = 0;
            for piece in wave().beziers() {
                let mut arcs = Vec::new();
                arcs_of_cubic(&piece, chord, &mut arcs);
                for k in 0..=4000 {
                    let point = cubic_at(&piece, f64::from(k) / 4000.0);
                    let starts = std::iter::once(piece[0]).chain(arcs.iter().map(|arc| arc.to));
                    let nearest = starts.zip(&arcs).filter(|(start, arc)| {
                        let along_chord = dot(sub(point, *start), sub(arc.to, *start)) / dot(sub(arc.to, *start), sub(arc.to, *start));
                        (-0.1..=1.1).contains(&along_chord)
                    });
                    let distance = nearest.map(|(start, arc)| from_arc(point, start, *arc)).fold(f64::INFINITY, f64::min);
                    assert!(distance <= chord, "{distance} at {k} for {chord}");
                }
                for arc in &arcs {
                    let chord_angle = maths::atan2(arc.to[1] - from[1], arc.to[0] - from[0]);
                    let half = 2.0 * maths::atan2(arc.bulge, 1.0);
                    if let Some(before) = before {
                        let turn = chord_angle - half - before;
                        assert!(maths::sin(0.5 * turn).abs() < 1e-9, "a kink of {turn} rad");
                    }
                    before = Some(chord_angle + half);
                    from = arc.to;
                }
                count += arcs.len();
            }
            counts.push(count);
        }
        // The error of arcs falls with the third power of their length.
        assert!(counts[2] as f64 / (counts[0] as f64) < 7.0, "{counts:?}");
    }

    #[test]
    fn the_swept_area_of_a_cubic_is_that_of_quadrature() {
        let rule = forcewright_base::quadrature::GaussLegendre::new(4);
        for b in wave().beziers() {
            let slope = |t: f64| {
                let q = [sub(b[1], b[0]), sub(b[2], b[1]), sub(b[3], b[2])];
                let s = between(between(q[0], q[1], t), between(q[1], q[2], t), t);
                [3.0 * s[0], 3.0 * s[1]]
            };
            let want = rule.integrate(|t| cross(cubic_at(&b, t), slope(t)));
            assert!((twice_swept(&b) - want).abs() < 1e-13 * want.abs().max(1.0));
        }
    }
}
