//! The smooth pieces that profiles consist of, all with a parameter in [0, 1]: the common ground of every algorithm here.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, TAU};
use std::sync::LazyLock;

use forcewright_base::{maths, quadrature::GaussLegendre, roots};

use crate::bounds::Bounds;
use crate::vector::{Vector, add, along, angle, cross, distance, dot, left, mix, norm, rotate, scale, sub, unit};

/// Exact for the area under a cubic, whose integrand is of degree 5.
static AREA_RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(3));
static LENGTH_RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(12));
/// Halvings of a cubic in search of its length.
const LENGTH_DEPTH: usize = 12;
/// Samples of a cubic between which its nearest place is looked for.
const NEAREST_SAMPLES: usize = 12;
/// Halvings in the search for the angle under which a piece is seen; a point that is not separated by then lies on the piece.
const WINDING_DEPTH: usize = 48;

/// A line, an arc or a cubic in Bézier form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Piece {
    Line { from: Vector, to: Vector },
    Arc { from: Vector, to: Vector, centre: Vector, sweep_rad: f64 },
    Cubic([Vector; 4]),
}

impl Piece {
    /// The arc between two points of a circle; equal points are an arc of no length, not the whole circle.
    pub(crate) fn arc(from: Vector, to: Vector, centre: Vector, counterclockwise: bool) -> Self {
        let turn = angle(sub(from, centre), sub(to, centre));
        let sweep_rad = match (counterclockwise, turn < 0.0) {
            (true, true) => turn + TAU,
            (false, false) if turn > 0.0 => turn - TAU,
            _ => turn,
        };
        Self::Arc { from, to, centre, sweep_rad }
    }

    /// The arc that leaves `from` in the direction of a unit tangent and ends in `to`; a line if the three are in line.
    pub(crate) fn arc_by_tangent(from: Vector, tangent: Vector, to: Vector) -> Self {
        let chord = sub(to, from);
        let height = cross(tangent, chord);
        if height.abs() <= 1e-12 * norm(chord) {
            return Self::Line { from, to };
        }
        let centre = along(from, left(tangent), dot(chord, chord) / (2.0 * height));
        Self::Arc { from, to, centre, sweep_rad: 2.0 * angle(tangent, chord) }
    }

    pub(crate) fn from(&self) -> Vector {
        match self {
            Self::Line { from, .. } | Self::Arc { from, .. } => *from,
            Self::Cubic(control) => control[0],
        }
    }

    pub(crate) fn to(&self) -> Vector {
        match self {
            Self::Line { to, .. } | Self::Arc { to, .. } => *to,
            Self::Cubic(control) => control[3],
        }
    }

    pub(crate) fn point(&self, t: f64) -> Vector {
        match self {
            Self::Line { from, to } => mix(*from, *to, t),
            Self::Arc { to, .. } if t >= 1.0 => *to,
            Self::Arc { from, centre, sweep_rad, .. } => add(*centre, rotate(sub(*from, *centre), sweep_rad * t)),
            Self::Cubic(control) => casteljau(control, t).0[3],
        }
    }

    /// By the parameter.
    pub(crate) fn derivative(&self, t: f64) -> Vector {
        match self {
            Self::Line { from, to } => sub(*to, *from),
            Self::Arc { from, centre, sweep_rad, .. } => scale(left(rotate(sub(*from, *centre), sweep_rad * t)), *sweep_rad),
            Self::Cubic([a, b, c, d]) => {
                let (ab, bc, cd) = (sub(*b, *a), sub(*c, *b), sub(*d, *c));
                scale(mix(mix(ab, bc, t), mix(bc, cd, t), t), 3.0)
            }
        }
    }

    /// By the parameter, twice.
    fn second(&self, t: f64) -> Vector {
        match self {
            Self::Line { .. } => [0.0, 0.0],
            Self::Arc { from, centre, sweep_rad, .. } => scale(rotate(sub(*from, *centre), sweep_rad * t), -sweep_rad * sweep_rad),
            Self::Cubic([a, b, c, d]) => {
                let first = along(add(*a, *c), *b, -2.0);
                let last = along(add(*b, *d), *c, -2.0);
                scale(mix(first, last, t), 6.0)
            }
        }
    }

    /// Unit tangent; where the derivative vanishes, the direction from just before to just after.
    pub(crate) fn tangent(&self, t: f64) -> Vector {
        let derivative = self.derivative(t);
        if norm(derivative) > 0.0 {
            return unit(derivative);
        }
        unit(sub(self.point((t + 1e-6).min(1.0)), self.point((t - 1e-6).max(0.0))))
    }

    /// Curvature, 1/m, positive to the left.
    pub(crate) fn curvature(&self, t: f64) -> f64 {
        let derivative = self.derivative(t);
        let speed = norm(derivative);
        if speed > 0.0 { cross(derivative, self.second(t)) / (speed * speed * speed) } else { 0.0 }
    }

    pub(crate) fn reversed(&self) -> Self {
        match *self {
            Self::Line { from, to } => Self::Line { from: to, to: from },
            Self::Arc { from, to, centre, sweep_rad } => Self::Arc { from: to, to: from, centre, sweep_rad: -sweep_rad },
            Self::Cubic([a, b, c, d]) => Self::Cubic([d, c, b, a]),
        }
    }

    /// The part between two parameters.
    pub(crate) fn part(&self, start: f64, end: f64) -> Self {
        match self {
            Self::Line { .. } => Self::Line { from: self.point(start), to: self.point(end) },
            Self::Arc { centre, sweep_rad, .. } => {
                Self::Arc { from: self.point(start), to: self.point(end), centre: *centre, sweep_rad: sweep_rad * (end - start) }
            }
            Self::Cubic(control) => {
                let head = casteljau(control, end).0;
                let inner = if end > 0.0 { start / end } else { 0.0 };
                Self::Cubic(casteljau(&head, inner).1)
            }
        }
    }

    /// Twice the area between the piece and the point `origin`, exact, positive if the point lies to the left.
    pub(crate) fn twice_area(&self, origin: Vector) -> f64 {
        match self {
            Self::Line { from, to } => cross(sub(*from, origin), sub(*to, origin)),
            Self::Arc { from, to, centre, sweep_rad } => {
                let radius = sub(*from, *centre);
                cross(sub(*centre, origin), sub(*to, *from)) + dot(radius, radius) * sweep_rad
            }
            Self::Cubic(_) => AREA_RULE.integrate(|t| cross(sub(self.point(t), origin), self.derivative(t))),
        }
    }

    pub(crate) fn length(&self) -> f64 {
        match self {
            Self::Line { from, to } => distance(*from, *to),
            Self::Arc { from, centre, sweep_rad, .. } => distance(*from, *centre) * sweep_rad.abs(),
            Self::Cubic(_) => {
                let whole = LENGTH_RULE.integrate(|t| norm(self.derivative(t)));
                self.length_between(0.0, 1.0, whole, LENGTH_DEPTH)
            }
        }
    }

    fn length_between(&self, a: f64, b: f64, whole: f64, depth: usize) -> f64 {
        let rule = |a: f64, b: f64| (b - a) * LENGTH_RULE.integrate(|t| norm(self.derivative(a + (b - a) * t)));
        let middle = 0.5 * (a + b);
        let (first, second) = (rule(a, middle), rule(middle, b));
        if depth == 0 || (first + second - whole).abs() <= 1e-14 * whole {
            return first + second;
        }
        self.length_between(a, middle, first, depth - 1) + self.length_between(middle, b, second, depth - 1)
    }

    /// The smallest box, up to rounding.
    pub(crate) fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::of([self.from(), self.to()]);
        match self {
            Self::Line { .. } => {}
            Self::Arc { from, centre, sweep_rad, .. } => {
                let start = angle([1.0, 0.0], sub(*from, *centre));
                for quarter in -8..=8 {
                    let t = (f64::from(quarter) * FRAC_PI_2 - start) / sweep_rad;
                    if t > 0.0 && t < 1.0 {
                        bounds.include(self.point(t));
                    }
                }
            }
            Self::Cubic(_) => {
                for axis in [[1.0, 0.0], [0.0, 1.0]] {
                    for t in self.stationary(axis).into_iter().flatten() {
                        bounds.include(self.point(t));
                    }
                }
            }
        }
        bounds
    }

    /// Where a cubic stops moving along an axis.
    fn stationary(&self, axis: Vector) -> [Option<f64>; 2] {
        let (Self::Cubic([a, b, c, d]), inside) = (self, |t: f64| (t > 0.0 && t < 1.0).then_some(t)) else { return [None; 2] };
        let (p, q, r) = (dot(axis, sub(*b, *a)), dot(axis, sub(*c, *b)), dot(axis, sub(*d, *c)));
        // p (1−t)² + 2 q t (1−t) + r t² = 0
        let (square, half, constant) = (p - 2.0 * q + r, q - p, p);
        let root = (half * half - square * constant).max(0.0).sqrt();
        let stable = -(half + half.signum() * root);
        let mut found = [inside(stable / square), inside(constant / stable)];
        if let [Some(first), Some(second)] = found
            && first > second
        {
            found = [Some(second), Some(first)];
        }
        if found[0].is_none() {
            found.swap(0, 1);
        }
        found
    }

    /// Parameters at which the piece meets the line through a point with a unit normal, ascending.
    pub(crate) fn meets_line(&self, point: Vector, normal: Vector) -> Vec<f64> {
        let height = |t: f64| dot(normal, sub(self.point(t), point));
        match self {
            Self::Line { .. } => {
                let (a, b) = (height(0.0), height(1.0));
                if (a <= 0.0) == (b <= 0.0) { Vec::new() } else { vec![a / (a - b)] }
            }
            Self::Arc { from, centre, sweep_rad, .. } => {
                let radius = sub(*from, *centre);
                let cosine = dot(normal, sub(point, *centre)) / norm(radius);
                if cosine.is_nan() || cosine.abs() > 1.0 {
                    return Vec::new();
                }
                let middle = angle(radius, normal);
                let mut found: Vec<f64> = [-1.0, 1.0]
                    .iter()
                    .filter_map(|sign| {
                        let turn = (middle + sign * maths::acos(cosine)) * sweep_rad.signum();
                        let turn = turn.rem_euclid(TAU);
                        // A hit on an end counts in spite of rounding.
                        let turn = if TAU - turn < 1e-12 { 0.0 } else { turn };
                        let t = turn / sweep_rad.abs();
                        (t <= 1.0 + 1e-12).then_some(t.min(1.0))
                    })
                    .collect();
                found.sort_by(f64::total_cmp);
                found
            }
            Self::Cubic(_) => {
                let mut found = Vec::new();
                let mut start = 0.0;
                for end in self.stationary(normal).into_iter().flatten().chain([1.0]) {
                    if (height(start) <= 0.0) != (height(end) <= 0.0) {
                        found.extend(roots::root(height, start, end, 1e-15));
                    }
                    start = end;
                }
                found
            }
        }
    }

    /// The parameter of the place nearest to a point.
    pub(crate) fn nearest(&self, point: Vector) -> f64 {
        match self {
            Self::Line { from, to } => {
                let chord = sub(*to, *from);
                let square = dot(chord, chord);
                if square > 0.0 { (dot(sub(point, *from), chord) / square).clamp(0.0, 1.0) } else { 0.0 }
            }
            Self::Arc { from, centre, sweep_rad, .. } => {
                let turn = (angle(sub(*from, *centre), sub(point, *centre)) * sweep_rad.signum()).rem_euclid(TAU);
                let sweep = sweep_rad.abs();
                if turn <= sweep {
                    turn / sweep
                } else if turn - sweep < TAU - turn {
                    1.0
                } else {
                    0.0
                }
            }
            Self::Cubic(_) => {
                let square = |t: f64| {
                    let to = sub(self.point(t), point);
                    dot(to, to)
                };
                let at = |k: usize| k as f64 / NEAREST_SAMPLES as f64;
                let values: Vec<f64> = (0..=NEAREST_SAMPLES).map(|k| square(at(k))).collect();
                let mut best = if values[0] <= values[NEAREST_SAMPLES] { (0.0, values[0]) } else { (1.0, values[NEAREST_SAMPLES]) };
                for k in 0..=NEAREST_SAMPLES {
                    let (before, after) = (k.saturating_sub(1), (k + 1).min(NEAREST_SAMPLES));
                    if values[k] > values[before] || values[k] > values[after] {
                        continue;
                    }
                    let t = self.settle(point, roots::minimise(square, at(before), at(after), 1e-8).x);
                    if square(t) < best.1 {
                        best = (t, square(t));
                    }
                }
                best.0
            }
        }
    }

    /// Newton's method for a place whose normal passes through a point: a minimum of a square alone is known to half the digits only.
    fn settle(&self, point: Vector, start: f64) -> f64 {
        let mut t = start;
        for _ in 0..4 {
            let (to, by) = (sub(self.point(t), point), self.derivative(t));
            let slope = dot(by, by) + dot(to, self.second(t));
            if slope.is_nan() || slope <= 0.0 {
                return t;
            }
            t = (t - dot(to, by) / slope).clamp(0.0, 1.0);
        }
        t
    }

    /// The angle, rad, by which the direction from a point to the piece turns along it; `None` if the point lies on it.
    pub(crate) fn seen_from(&self, point: Vector) -> Option<f64> {
        self.seen(point, WINDING_DEPTH)
    }

    fn seen(&self, point: Vector, depth: usize) -> Option<f64> {
        // While the point is outside the hull the piece can be drawn tight onto its chord without passing it.
        let straight = matches!(self, Self::Line { .. });
        if straight || !self.hull().contains(point) {
            let (a, b) = (sub(self.from(), point), sub(self.to(), point));
            let turn = angle(a, b);
            let on_it = norm(a) == 0.0 || norm(b) == 0.0 || turn.abs() >= PI;
            return (!on_it).then_some(turn);
        }
        if depth == 0 {
            return None;
        }
        Some(self.part(0.0, 0.5).seen(point, depth - 1)? + self.part(0.5, 1.0).seen(point, depth - 1)?)
    }

    /// A box around the piece and its chord.
    fn hull(&self) -> Bounds {
        match self {
            Self::Cubic(control) => Bounds::of(*control),
            _ => self.bounds(),
        }
    }

    /// Number of equal steps of the parameter for chords that are wrong by no more than that.
    pub(crate) fn steps(&self, chord_error_m: f64) -> usize {
        let count = match self {
            Self::Line { .. } => 1.0,
            Self::Arc { from, centre, sweep_rad, .. } => {
                let versine = (chord_error_m / distance(*from, *centre)).min(1.0);
                // However coarse, a circle remains a hexagon.
                (sweep_rad.abs() / (2.0 * maths::acos(1.0 - versine)).clamp(1e-6, FRAC_PI_3)).ceil()
            }
            Self::Cubic(_) => {
                let bend = norm(self.second(0.0)).max(norm(self.second(1.0)));
                (bend / (8.0 * chord_error_m)).sqrt().ceil()
            }
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a positive whole number")]
        let count = count.clamp(1.0, 1e5) as usize;
        count
    }
}

/// Control points of the parts before and after a parameter.
fn casteljau([a, b, c, d]: &[Vector; 4], t: f64) -> ([Vector; 4], [Vector; 4]) {
    let (ab, bc, cd) = (mix(*a, *b, t), mix(*b, *c, t), mix(*c, *d, t));
    let (abc, bcd) = (mix(ab, bc, t), mix(bc, cd, t));
    let middle = mix(abc, bcd, t);
    ([*a, ab, abc, middle], [middle, bcd, cd, *d])
}
