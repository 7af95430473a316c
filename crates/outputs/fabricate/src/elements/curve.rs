//! Edges with a parameter in [0, 1] that runs about evenly along them.

use std::f64::consts::FRAC_PI_8;

use forcewright_base::maths;
use forcewright_curves::vector::{cross, dot, mix, norm, sub};

use crate::shape::{Bezier, Curve, Edge, Point};

/// A smooth curve between two points, mm.
#[derive(Clone, Debug)]
pub(super) enum Smooth {
    Line(Point, Point),
    Arc {
        centre: Point,
        radius: f64,
        first_rad: f64,
        sweep_rad: f64,
    },
    /// Cubics, each with the share of the whole length at its end.
    Cubics(Vec<(Bezier, f64)>),
}

impl Smooth {
    pub(super) fn of(edge: &Edge) -> Self {
        match &edge.curve {
            Curve::Line => Self::Line(edge.from, edge.to),
            Curve::Arc { centre, radius, sweep_rad } => {
                let from = sub(edge.from, *centre);
                Self::Arc { centre: *centre, radius: *radius, first_rad: maths::atan2(from[1], from[0]), sweep_rad: *sweep_rad }
            }
            Curve::Spline(_) => {
                let mut sum = 0.0;
                let mut pieces: Vec<(Bezier, f64)> = Vec::new();
                for piece in edge.beziers() {
                    sum += legs(&piece).map(norm).iter().sum::<f64>();
                    pieces.push((piece, sum));
                }
                for piece in &mut pieces {
                    piece.1 /= sum;
                }
                Self::Cubics(pieces)
            }
        }
    }

    pub(super) fn at(&self, t: f64) -> Point {
        match self {
            Self::Line(from, to) => [0, 1].map(|k| from[k] * (1.0 - t) + to[k] * t),
            Self::Arc { centre, radius, first_rad, sweep_rad } => {
                let (sin, cos) = maths::sin_cos(first_rad + sweep_rad * t);
                [centre[0] + radius * cos, centre[1] + radius * sin]
            }
            Self::Cubics(pieces) => {
                let index = pieces.partition_point(|piece| piece.1 < t).min(pieces.len() - 1);
                let before = if index == 0 { 0.0 } else { pieces[index - 1].1 };
                let (piece, end) = &pieces[index];
                cubic_at(piece, ((t - before) / (end - before)).clamp(0.0, 1.0))
            }
        }
    }

    /// In how many equal parts it is cut so that none is longer than `longest`, nor turns by more than a sixteenth of a circle.
    pub(super) fn parts(&self, longest: f64) -> f64 {
        let (length, turn_rad) = match self {
            Self::Line(from, to) => (norm(sub(*to, *from)), 0.0),
            Self::Arc { radius, sweep_rad, .. } => (radius * sweep_rad.abs(), sweep_rad.abs()),
            Self::Cubics(pieces) => {
                let legs: Vec<Point> = pieces.iter().flat_map(|(piece, _)| legs(piece)).filter(|leg| norm(*leg) > 0.0).collect();
                let turn = |pair: &[Point]| maths::atan2(cross(pair[0], pair[1]), dot(pair[0], pair[1])).abs();
                (legs.iter().copied().map(norm).sum(), legs.windows(2).map(turn).sum())
            }
        };
        (length / longest).max(turn_rad / FRAC_PI_8).ceil().max(1.0)
    }
}

fn legs(piece: &Bezier) -> [Point; 3] {
    [0, 1, 2].map(|i| sub(piece[i + 1], piece[i]))
}

/// The point of a cubic at `t` in [0, 1], by de Casteljau's algorithm.
fn cubic_at(&[a, b, c, d]: &Bezier, t: f64) -> Point {
    let (p, q, r) = (mix(a, b, t), mix(b, c, t), mix(c, d, t));
    mix(mix(p, q, t), mix(q, r, t), t)
}
