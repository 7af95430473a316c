//! Shapes through given points.
//!
//! The angle of a beam through n points between its ends is the polynomial of degree n, η(u) = `c_0` + … + `c_n` uⁿ, whose axis passes
//! through all of them in order. The places u of the points are unknown with it: a point fixes the axis across, not along. That gives
//! as many unknowns (length, n + 1 coefficients, n places) as equations (two per point and for the end). One point gives the arc of a
//! circle; points taken from a shape of degree n or less give that shape back.

use std::fmt;
use std::sync::LazyLock;

use forcewright_base::{dense::Lu, maths, quadrature::GaussLegendre};

use crate::shape::{Shape, ShapeError};

/// Rule on each piece between two points; the axis turns by less than a half turn there.
static RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(24));
/// Newton iterations for one set of points.
const ITERATIONS: usize = 40;
/// Distance between axis and point, relative to the length of the line through the points, that counts as none.
const CLOSE: f64 = 1e-13;
/// Largest turn of the line through the points at a point, as part of a half turn: beyond, its sense is a guess.
const SHARPEST: f64 = 0.9;
/// Most parts into which the way from the first guess to the points is divided.
const FINEST: usize = 16;

/// Why no shape passes through points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ThroughError {
    /// More points than [`Shape::MOST_POINTS`].
    TooMany {
        /// How many.
        count: usize,
    },
    /// A point lies on the one before it, or on the start; the end counts as the last point.
    OnTheOneBefore {
        /// Index of the point; the number of points for the end.
        point: usize,
    },
    /// The line through the points turns back at a point.
    TurnsBack {
        /// Index of the point.
        point: usize,
    },
    /// A curve was found, but between two points it does not run forward from the one to the other.
    Loops {
        /// Index of the point at the end of that piece; the number of points for the end.
        point: usize,
    },
    /// No curve was found.
    NotFound,
    /// The shape itself is impossible; [`ShapeError::TurnsTooMuch`] where so many points need coefficients that cancel each other.
    Shape(ShapeError),
}

impl fmt::Display for ThroughError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooMany { count } => write!(f, "{count} points, at most {} are accepted", Shape::MOST_POINTS),
            Self::OnTheOneBefore { .. } => write!(f, "a point lies on the one before it"),
            Self::TurnsBack { .. } => write!(f, "the line through the points turns back here"),
            Self::Loops { .. } => write!(f, "the smooth curve through the points turns back before this one"),
            Self::NotFound => write!(f, "no smooth curve was found through the points"),
            Self::Shape(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ThroughError {}

impl From<ShapeError> for ThroughError {
    fn from(error: ShapeError) -> Self {
        Self::Shape(error)
    }
}

impl Shape {
    /// Most points that [`Shape::through`] accepts.
    pub const MOST_POINTS: usize = 8;

    /// The shape that spans a chord and passes through points, both relative to its start, m, in their order. Its angle is a polynomial
    /// of as many bend coefficients as there are points; none gives a straight beam.
    ///
    /// Points are met to rounding. The curve is the one reached by Newton's method from places in proportion to the lengths of the
    /// straight line through the points; it is refused unless it runs forward along that line on every piece.
    ///
    /// # Errors
    /// [`ThroughError`] names the point at fault.
    ///
    /// ```
    /// use forcewright_beam::Shape;
    /// // Three points of a circle of radius 1 m.
    /// let arc = Shape::through([2.0, 0.0], &[[1.0, 1.0]])?;
    /// assert!((arc.length_m() - std::f64::consts::PI).abs() < 1e-14);
    /// # Ok::<(), forcewright_beam::ThroughError>(())
    /// ```
    pub fn through(chord_m: [f64; 2], points_m: &[[f64; 2]]) -> Result<Self, ThroughError> {
        let count = points_m.len();
        if count > Self::MOST_POINTS {
            return Err(ThroughError::TooMany { count });
        }
        if !points_m.iter().flatten().chain(&chord_m).all(|v| v.is_finite()) {
            return Err(ShapeError::NotFinite.into());
        }
        if count == 0 {
            return Ok(Self::from_chord(chord_m, &[])?);
        }
        let line = Line::new(chord_m, points_m)?;
        let unknowns = line.fit().ok_or(ThroughError::NotFound)?;
        line.check(&unknowns)?;
        Ok(Self::from_chord(chord_m, &unknowns.angle_rad[1..])?)
    }
}

/// The straight line through the points and the end, scaled to length 1.
struct Line {
    /// Points and the end, relative to the start.
    points: Vec<[f64; 2]>,
    /// Length of the line up to each.
    places: Vec<f64>,
    /// Direction of each piece, rad, without jumps.
    directions_rad: Vec<f64>,
}

/// What is solved for.
#[derive(Clone)]
struct Unknowns {
    /// Over the length of the line.
    length: f64,
    angle_rad: Vec<f64>,
    /// Of the points; increasing, in (0, 1).
    places: Vec<f64>,
}

impl Line {
    fn new(chord_m: [f64; 2], points_m: &[[f64; 2]]) -> Result<Self, ThroughError> {
        let all: Vec<[f64; 2]> = points_m.iter().copied().chain([chord_m]).collect();
        let mut before = [0.0; 2];
        let pieces: Vec<[f64; 2]> =
            all.iter().map(|p| [p[0] - std::mem::replace(&mut before[0], p[0]), p[1] - std::mem::replace(&mut before[1], p[1])]).collect();
        let lengths: Vec<f64> = pieces.iter().map(|[x, y]| maths::hypot(*x, *y)).collect();
        let total: f64 = lengths.iter().sum();
        if let Some(point) = lengths.iter().position(|l| *l <= 1e-6 * total) {
            return Err(ThroughError::OnTheOneBefore { point });
        }
        let mut directions_rad: Vec<f64> = Vec::with_capacity(pieces.len());
        for (index, [x, y]) in pieces.iter().enumerate() {
            let angle = maths::atan2(*y, *x);
            let Some(last) = directions_rad.last() else {
                directions_rad.push(angle);
                continue;
            };
            let turns = ((angle - last) / std::f64::consts::TAU).round();
            let turn = angle - last - turns * std::f64::consts::TAU;
            if turn.abs() > SHARPEST * std::f64::consts::PI {
                return Err(ThroughError::TurnsBack { point: index - 1 });
            }
            directions_rad.push(last + turn);
        }
        let mut sum = 0.0;
        let places = lengths
            .iter()
            .map(|l| {
                sum += l / total;
                sum
            })
            .collect();
        Ok(Self { points: all.iter().map(|[x, y]| [x / total, y / total]).collect(), places, directions_rad })
    }

    /// The mean angle on each piece is the direction of the line there.
    fn guess(&self) -> Option<Unknowns> {
        let n = self.points.len();
        let mut matrix = vec![0.0; n * n];
        let mut from = 0.0;
        for (row, &to) in matrix.chunks_exact_mut(n).zip(&self.places) {
            let (mut low, mut high) = (from, to);
            for (k, entry) in row.iter_mut().enumerate() {
                *entry = (high - low) / ((k + 1) as f64 * (to - from));
                (low, high) = (low * from, high * to);
            }
            from = to;
        }
        let mut angle_rad = self.directions_rad.clone();
        let mut lu = Lu::new();
        lu.factor(n, n, &matrix).ok()?;
        lu.solve(&mut angle_rad);
        Some(Unknowns { length: 1.0, angle_rad, places: self.places[..n - 1].to_vec() })
    }

    /// The curve through the points: straight from the guess, or else by way of curves through points in between.
    fn fit(&self) -> Option<Unknowns> {
        let guess = self.guess()?;
        let first = guess.positions();
        let mut parts = 1;
        while parts <= FINEST {
            let mut unknowns = Some(guess.clone());
            for part in 1..=parts {
                let share = part as f64 / parts as f64;
                let targets: Vec<[f64; 2]> =
                    first.iter().zip(&self.points).map(|(a, b)| [0, 1].map(|i| a[i] + share * (b[i] - a[i]))).collect();
                unknowns = unknowns.and_then(|u| u.solved(&targets));
            }
            if unknowns.is_some() {
                return unknowns;
            }
            parts *= 2;
        }
        None
    }

    /// Whether the curve runs forward along the line on every piece.
    fn check(&self, unknowns: &Unknowns) -> Result<(), ThroughError> {
        const SAMPLES: usize = 64;
        let mut from = 0.0;
        for (point, to) in unknowns.places.iter().copied().chain([1.0]).enumerate() {
            let ahead = (0..=SAMPLES).all(|i| {
                let angle = unknowns.angle_at(from + (to - from) * i as f64 / SAMPLES as f64);
                (angle - self.directions_rad[point]).abs() < std::f64::consts::FRAC_PI_2
            });
            if !ahead {
                return Err(ThroughError::Loops { point });
            }
            from = to;
        }
        Ok(())
    }
}

impl Unknowns {
    fn angle_at(&self, u: f64) -> f64 {
        self.angle_rad.iter().rev().fold(0.0, |sum, c| sum * u + c)
    }

    /// Where the points and the end of this curve are.
    fn positions(&self) -> Vec<[f64; 2]> {
        self.moments().iter().map(|m| [self.length * m[0][0], self.length * m[0][1]]).collect()
    }

    /// ∫₀ᵘ uᵏ (cos η, sin η) du up to each point and the end, for every power of the angle.
    fn moments(&self) -> Vec<Vec<[f64; 2]>> {
        let mut sums = vec![[0.0; 2]; self.angle_rad.len()];
        let mut from = 0.0;
        let mut all = Vec::with_capacity(self.places.len() + 1);
        for to in self.places.iter().copied().chain([1.0]) {
            for (&node, &weight) in RULE.nodes().iter().zip(RULE.weights()) {
                let u = from + (to - from) * node;
                let (sin, cos) = maths::sin_cos(self.angle_at(u));
                let mut factor = (to - from) * weight;
                for sum in &mut sums {
                    *sum = [sum[0] + factor * cos, sum[1] + factor * sin];
                    factor *= u;
                }
            }
            all.push(sums.clone());
            from = to;
        }
        all
    }

    /// Newton's method towards target points, each step shortened until it brings the curve nearer.
    fn solved(mut self, targets: &[[f64; 2]]) -> Option<Self> {
        let n = 2 * targets.len();
        let mut lu = Lu::new();
        let mut distance = self.distance(targets);
        for _ in 0..ITERATIONS {
            let moments = self.moments();
            let mut matrix = vec![0.0; n * n];
            let mut step = vec![0.0; n];
            for (point, (sums, target)) in moments.iter().zip(targets).enumerate() {
                let place = self.places.get(point).copied();
                let (sin, cos) = maths::sin_cos(self.angle_at(place.unwrap_or(1.0)));
                for axis in 0..2 {
                    let row = &mut matrix[(2 * point + axis) * n..][..n];
                    row[0] = sums[0][axis];
                    for (entry, sum) in row[1..].iter_mut().zip(sums) {
                        *entry = self.length * if axis == 0 { -sum[1] } else { sum[0] };
                    }
                    if place.is_some() {
                        row[1 + self.angle_rad.len() + point] = self.length * if axis == 0 { cos } else { sin };
                    }
                    step[2 * point + axis] = target[axis] - self.length * sums[0][axis];
                }
            }
            lu.factor(n, n, &matrix).ok()?;
            lu.solve(&mut step);
            let Some((next, reached)) = self.nearer(&step, targets, distance) else { break };
            (self, distance) = (next, reached);
            if distance <= 0.01 * CLOSE {
                break;
            }
        }
        (distance <= CLOSE).then_some(self)
    }

    /// The first shortening of a step that is possible and comes nearer.
    fn nearer(&self, step: &[f64], targets: &[[f64; 2]], distance: f64) -> Option<(Self, f64)> {
        let mut share = 1.0;
        while share > 1e-3 {
            let mut next = self.clone();
            next.length += share * step[0];
            let rest = next.angle_rad.iter_mut().chain(&mut next.places);
            for (value, change) in rest.zip(&step[1..]) {
                *value += share * change;
            }
            let ends = [0.0].into_iter().chain(next.places.iter().copied());
            let in_order = ends.zip(next.places.iter().copied().chain([1.0])).all(|(a, b)| a < b);
            if in_order && next.length > 0.0 {
                let reached = next.distance(targets);
                if reached < distance {
                    return Some((next, reached));
                }
            }
            share *= 0.5;
        }
        None
    }

    /// Largest distance of a point of this curve to its target, along an axis of coordinates.
    fn distance(&self, targets: &[[f64; 2]]) -> f64 {
        let positions = self.positions();
        positions
            .iter()
            .zip(targets)
            .flat_map(|(p, t)| [p[0] - t[0], p[1] - t[1]])
            .fold(0.0, |m: f64, d| if d.is_nan() { f64::INFINITY } else { m.max(d.abs()) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
        maths::hypot(a[0] - b[0], a[1] - b[1])
    }

    /// Least distance of a point to the axis of a shape.
    fn miss(shape: &Shape, point: [f64; 2]) -> f64 {
        let to = |u: f64| distance(shape.point_m(u), point);
        let mut u = (0..=80).map(|i| f64::from(i) / 80.0).min_by(|a, b| to(*a).total_cmp(&to(*b))).unwrap();
        for _ in 0..8 {
            let ([x, y], (sin, cos)) = (shape.point_m(u), maths::sin_cos(shape.angle_at(u)));
            u += ((point[0] - x) * cos + (point[1] - y) * sin) / shape.length_m();
        }
        to(u)
    }

    #[test]
    fn points_of_a_circle_give_the_circle() {
        for turn in [0.1, 1.0, -2.5, 4.7, 5.6] {
            let circle = Shape::new(vec![0.7, turn], 0.03).unwrap();
            for places in [&[0.5][..], &[0.3], &[0.2, 0.7], &[0.1, 0.4, 0.5, 0.9]] {
                let points: Vec<[f64; 2]> = places.iter().map(|u| circle.point_m(*u)).collect();
                let found = Shape::through(circle.chord_m(), &points);
                // One point far from the middle leaves a piece that turns back.
                let widest = places.iter().chain(&[1.0]).scan(0.0, |a, b| Some(b - std::mem::replace(a, *b))).fold(0.0, f64::max);
                if (turn * widest).abs() > PI {
                    assert!(found.is_err(), "{turn} {places:?}: {found:?}");
                    continue;
                }
                let found = found.unwrap_or_else(|e| panic!("{turn} {places:?}: {e}"));
                assert!((found.length_m() / 0.03 - 1.0).abs() < 1e-12, "{turn} {places:?}: {found:?}");
                assert!((found.angle_rad()[1] - turn).abs() < 1e-10, "{turn} {places:?}: {found:?}");
                assert!(found.angle_rad()[2..].iter().all(|c| c.abs() < 1e-9), "{turn} {places:?}: {found:?}");
            }
        }
    }

    #[test]
    fn points_of_a_shape_give_the_shape() {
        let shapes: [&[f64]; 5] = [
            &[0.459, 1.3092, -1.57],
            &[1.638, -0.756, 1.57],
            &[0.3, -4.0, 8.0, -4.0],
            &[2.394, 0.226, -1.148],
            &[0.1, 2.0, -7.0, 9.0, -4.0],
        ];
        for angle in shapes {
            let shape = Shape::new(angle.to_vec(), 0.034).unwrap();
            let count = angle.len() - 1;
            for extra in 0..2 {
                let places = (1..=count + extra).map(|i| i as f64 / (count + extra + 1) as f64 + if i % 2 == 0 { 0.03 } else { -0.02 });
                let points: Vec<[f64; 2]> = places.map(|u| shape.point_m(u)).collect();
                let found = Shape::through(shape.chord_m(), &points).unwrap();
                assert!((found.length_m() / 0.034 - 1.0).abs() < 1e-12, "{angle:?}: {found:?}");
                for u in [0.0, 0.1, 0.37, 0.5, 0.83, 1.0] {
                    assert!((found.angle_at(u) - shape.angle_at(u)).abs() < 1e-9, "{angle:?} at {u}: {found:?}");
                }
            }
        }
    }

    #[test]
    fn every_point_is_met() {
        let mut state = 12345_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / 9_007_199_254_740_992.0
        };
        for trial in 0..120 {
            let count = 1 + trial % 5;
            let waves = [0.008, 0.005, 0.002].map(|a| a * (2.0 * random() - 1.0));
            let points: Vec<[f64; 2]> = (1..=count)
                .map(|i| {
                    let x = (f64::from(i) + 0.3 * (random() - 0.5)) / f64::from(count + 1);
                    let y = waves.iter().zip([1.0, 2.0, 3.0]).map(|(a, k)| a * maths::sin(k * PI * x)).sum::<f64>();
                    [0.05 * x, y + 5e-5 * (random() - 0.5)]
                })
                .collect();
            let shape = Shape::through([0.05, 0.0], &points).unwrap_or_else(|e| panic!("{trial}: {e}: {points:?}"));
            assert!(distance(shape.chord_m(), [0.05, 0.0]) < 1e-15, "{shape:?}");
            for point in &points {
                assert!(miss(&shape, *point) < 1e-14, "{trial}: {:.1e} m beside {point:?}", miss(&shape, *point));
            }
        }
        // Most points, along a gentle curve.
        let points: Vec<[f64; 2]> =
            (1..=Shape::MOST_POINTS).map(|i| f64::from(u8::try_from(i).unwrap()) / 9.0).map(|x| [x, 0.2 * x * (1.0 - x)]).collect();
        let shape = Shape::through([1.0, 0.0], &points).unwrap();
        assert!(points.iter().all(|p| miss(&shape, *p) < 1e-13), "{shape:?}");
    }

    #[test]
    fn scale_and_place_change_nothing() {
        let points = [[0.01, 0.004], [0.02, 0.003]];
        let shape = Shape::through([0.03, 0.0], &points).unwrap();
        // A quarter turn and a factor of 1000.
        let turned = Shape::through([0.0, 30.0], &points.map(|[x, y]| [-1e3 * y, 1e3 * x])).unwrap();
        for (a, b) in shape.angle_rad().iter().zip(turned.angle_rad()).skip(1) {
            assert!((a - b).abs() < 1e-11, "{shape:?} {turned:?}");
        }
        assert!((turned.length_m() / shape.length_m() - 1e3).abs() < 1e-9);
        // Run backwards it is the same curve.
        let back = Shape::through([-0.03, 0.0], &[[-0.01, 0.003], [-0.02, 0.004]]).unwrap();
        assert!((back.length_m() - shape.length_m()).abs() < 1e-15);
    }

    #[test]
    fn what_cannot_be_is_named() {
        let through = Shape::through;
        assert_eq!(through([1.0, 0.0], &[[0.5, 0.0]; 9]), Err(ThroughError::TooMany { count: 9 }));
        assert_eq!(through([1.0, 0.0], &[[0.0, 0.0]]), Err(ThroughError::OnTheOneBefore { point: 0 }));
        assert_eq!(through([1.0, 0.0], &[[0.5, 0.1], [0.5, 0.1]]), Err(ThroughError::OnTheOneBefore { point: 1 }));
        assert_eq!(through([1.0, 0.0], &[[1.0, 0.0]]), Err(ThroughError::OnTheOneBefore { point: 1 }));
        assert_eq!(through([1.0, 0.0], &[[0.7, 0.0], [0.3, 0.01]]), Err(ThroughError::TurnsBack { point: 0 }));
        assert_eq!(through([1.0, 0.0], &[[f64::NAN, 0.0]]), Err(ThroughError::Shape(ShapeError::NotFinite)));
        assert_eq!(through([0.0, 0.0], &[]), Err(ThroughError::Shape(ShapeError::NoChord)));
        // The circle through a point near the end turns back on the long piece.
        assert_eq!(through([1.0, 0.0], &[[1.05, 0.1]]), Err(ThroughError::Loops { point: 0 }));
        assert!((through([1.0, 0.0], &[]).unwrap().length_m() - 1.0).abs() < 1e-15);
    }
}
