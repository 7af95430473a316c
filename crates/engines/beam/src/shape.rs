//! Intrinsic shapes: the angle of an unloaded beam as a polynomial of its arc length.

use std::fmt;
use std::sync::LazyLock;

use forcewright_base::{maths, quadrature::GaussLegendre};

/// Points of the rule used on each panel of a shape integral.
const PANEL_POINTS: usize = 16;
static PANEL_RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(PANEL_POINTS));
/// Largest change of angle on a panel, rad, for which the rule is accurate to rounding.
const PANEL_TURN_RAD: f64 = 2.0;

/// The unloaded shape of a beam: η(u) = `c_0` + `c_1` u + … + `c_m` uᵐ over the dimensionless arc length u in [0, 1], and its length.
///
/// Lan, Wang & Chen 2010, eqs. (2) and (3).
///
/// ```
/// use forcewright_beam::Shape;
/// // A quarter circle of radius 1 m, from the origin to (1, 1).
/// let arc = Shape::from_chord([1.0, 1.0], &[std::f64::consts::FRAC_PI_2])?;
/// assert!((arc.length_m() - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
/// assert!(arc.angle_at(0.0).abs() < 1e-15);
/// # Ok::<(), forcewright_beam::ShapeError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    angle_rad: Vec<f64>,
    length_m: f64,
}

/// Why a shape is impossible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShapeError {
    /// The length is not in [`Shape::LENGTHS_M`].
    Length {
        /// The length, m.
        length_m: f64,
    },
    /// A coefficient or a coordinate is not a finite number.
    NotFinite,
    /// There is no coefficient at all.
    NoCoefficients,
    /// The angle may turn by more than [`Shape::LARGEST_TURN_RAD`].
    TurnsTooMuch {
        /// Bound on the turn, Σ k |`c_k`|, rad.
        turn_rad: f64,
    },
    /// Both ends are at the same place, so the chord has no direction.
    NoChord,
    /// The bend closes on itself: its chord is below a millionth of its length.
    ClosedLoop {
        /// Chord divided by length.
        chord_per_length: f64,
    },
}

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { length_m } => write!(f, "beam length is {length_m} m; it must be positive and of a technical size"),
            Self::NotFinite => write!(f, "a coefficient or coordinate of the shape is not a finite number"),
            Self::NoCoefficients => write!(f, "the shape has no coefficients; a straight beam has one, its angle"),
            Self::TurnsTooMuch { turn_rad } => write!(
                f,
                "the shape may turn by {turn_rad:.3e} rad, more than the {} rad that can be resolved; use smaller bend coefficients",
                Shape::LARGEST_TURN_RAD
            ),
            Self::NoChord => write!(f, "the beam starts and ends at the same place; move one of its nodes"),
            Self::ClosedLoop { chord_per_length } => write!(
                f,
                "the bend closes on itself (chord is {chord_per_length:.1e} of the length) and cannot span two nodes; use smaller bend coefficients"
            ),
        }
    }
}

impl std::error::Error for ShapeError {}

impl Shape {
    /// Possible lengths, m: far beyond any mechanism, and safe from overflow.
    pub const LENGTHS_M: std::ops::RangeInclusive<f64> = 1e-20..=1e20;
    /// Largest bound Σ k |`c_k`| (k ≥ 1) on the turn of a shape, rad.
    pub const LARGEST_TURN_RAD: f64 = 1e4;

    /// A shape from its angle coefficients `c_0 … c_m`, rad, and its length, m.
    ///
    /// # Errors
    /// [`ShapeError`] without coefficients, with numbers that are not finite, a length that is not positive, or an excessive turn.
    pub fn new(angle_rad: Vec<f64>, length_m: f64) -> Result<Self, ShapeError> {
        if angle_rad.is_empty() {
            return Err(ShapeError::NoCoefficients);
        }
        if !angle_rad.iter().all(|c| c.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        if !Self::LENGTHS_M.contains(&length_m) {
            return Err(ShapeError::Length { length_m });
        }
        let turn_rad = turn_bound(&angle_rad) + angle_rad[0].abs();
        if turn_rad > Self::LARGEST_TURN_RAD {
            return Err(ShapeError::TurnsTooMuch { turn_rad });
        }
        Ok(Self { angle_rad, length_m })
    }

    /// The shape with bend coefficients `c_1 … c_m`, rad, that spans a chord, m: `c_0` and the length follow from eq. (2) at u = 1.
    ///
    /// `c_0` is in (−2π, 2π]; both results are accurate to rounding. An empty `bend` is a straight beam.
    ///
    /// # Errors
    /// [`ShapeError`] if the chord is zero, the bend closes on itself or turns excessively, or a number is not finite.
    pub fn from_chord(chord_m: [f64; 2], bend_rad: &[f64]) -> Result<Self, ShapeError> {
        if !chord_m.iter().chain(bend_rad).all(|v| v.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        let distance_m = maths::hypot(chord_m[0], chord_m[1]);
        if distance_m == 0.0 {
            return Err(ShapeError::NoChord);
        }
        let mut angle_rad = vec![0.0];
        angle_rad.extend_from_slice(bend_rad);
        let mut shape = Self::new(angle_rad, 1.0)?;
        let [x, y] = shape.chord_m();
        let chord_per_length = maths::hypot(x, y);
        if chord_per_length < 1e-6 {
            return Err(ShapeError::ClosedLoop { chord_per_length });
        }
        shape.angle_rad[0] = maths::atan2(chord_m[1], chord_m[0]) - maths::atan2(y, x);
        shape.length_m = distance_m / chord_per_length;
        Self::new(shape.angle_rad, shape.length_m)
    }

    /// The coefficients `c_0 … c_m`, rad.
    pub fn angle_rad(&self) -> &[f64] {
        &self.angle_rad
    }

    /// Arc length, m.
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// Intrinsic angle η(u), rad; eq. (3).
    pub fn angle_at(&self, u: f64) -> f64 {
        self.angle_rad.iter().rev().fold(0.0, |sum, c| sum * u + c)
    }

    /// Slope dη/du, rad.
    pub fn slope_at(&self, u: f64) -> f64 {
        let terms = self.angle_rad.iter().enumerate().skip(1).rev();
        terms.fold(0.0, |sum, (k, c)| sum * u + k as f64 * c)
    }

    /// Position at u relative to the start of the beam, m; eq. (2). Accurate to rounding.
    pub fn point_m(&self, u: f64) -> [f64; 2] {
        // u outside [0, 1] is not on the beam.
        let u = if u.is_nan() { 0.0 } else { u.clamp(0.0, 1.0) };
        let [x, y] = integrate_direction(u, turn_bound(&self.angle_rad), |v| self.angle_at(v));
        [self.length_m * x, self.length_m * y]
    }

    /// From the start to the end, m.
    pub fn chord_m(&self) -> [f64; 2] {
        self.point_m(1.0)
    }

    /// ∫ uᵏ (cos η, sin η) du over the whole beam for k = 0 … m. Accurate to rounding.
    pub(crate) fn direction_moments(&self) -> Vec<[f64; 2]> {
        let mut sums = vec![[0.0; 2]; self.angle_rad.len()];
        let mut panels = 1.0;
        while panels * PANEL_TURN_RAD < turn_bound(&self.angle_rad) {
            panels += 1.0;
        }
        let mut start = 0.0;
        while start < panels {
            for (&node, &weight) in PANEL_RULE.nodes().iter().zip(PANEL_RULE.weights()) {
                let u = (start + node) / panels;
                let (sin, cos) = maths::sin_cos(self.angle_at(u));
                let mut factor = weight / panels;
                for sum in &mut sums {
                    sum[0] += factor * cos;
                    sum[1] += factor * sin;
                    factor *= u;
                }
            }
            start += 1.0;
        }
        sums
    }

    /// The part from one place to another, 0 ≤ `from` < `to` ≤ 1; the whole shape with its very numbers.
    pub(crate) fn part(&self, [from, to]: [f64; 2]) -> Self {
        if from <= 0.0 && to >= 1.0 {
            return self.clone();
        }
        // η(from + (to − from) v) in powers of v: Taylor shift by synthetic division, then scaling.
        let mut c = self.angle_rad.clone();
        for first in 0..c.len() {
            for k in (first..c.len() - 1).rev() {
                c[k] += from * c[k + 1];
            }
        }
        let mut scale = 1.0;
        for value in &mut c {
            *value *= scale;
            scale *= to - from;
        }
        Self { angle_rad: c, length_m: self.length_m * (to - from) }
    }

    /// The same beam run from its end to its start.
    pub fn reversed(&self) -> Self {
        // η_r(v) = η(1 − v) + π, expanded in powers of v by repeated synthetic division (Taylor shift to 1).
        let mut c = self.angle_rad.clone();
        let n = c.len();
        for first in 0..n {
            for k in (first..n - 1).rev() {
                c[k] += c[k + 1];
            }
        }
        for (k, value) in c.iter_mut().enumerate() {
            if k % 2 == 1 {
                *value = -*value;
            }
        }
        c[0] += std::f64::consts::PI;
        Self { angle_rad: c, length_m: self.length_m }
    }
}

/// Bound on the total change of angle, Σ k |`c_k`|, rad.
fn turn_bound(angle_rad: &[f64]) -> f64 {
    angle_rad.iter().enumerate().map(|(k, c)| k as f64 * c.abs()).sum()
}

/// ∫ (cos θ, sin θ) over [0, u] in panels on which θ changes little.
fn integrate_direction(u: f64, turn_rad: f64, angle: impl Fn(f64) -> f64) -> [f64; 2] {
    let rule = &*PANEL_RULE;
    let mut panels = 1.0;
    while panels * PANEL_TURN_RAD < turn_rad * u {
        panels += 1.0;
    }
    let width = u / panels;
    let (mut sum, mut start) = ([0.0; 2], 0.0);
    while start < panels {
        for (&node, &weight) in rule.nodes().iter().zip(rule.weights()) {
            let (sin, cos) = maths::sin_cos(angle((start + node) * width));
            sum[0] += weight * width * cos;
            sum[1] += weight * width * sin;
        }
        start += 1.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    fn close(a: [f64; 2], b: [f64; 2], tolerance: f64) {
        assert!((a[0] - b[0]).abs() < tolerance && (a[1] - b[1]).abs() < tolerance, "{a:?} {b:?}");
    }

    #[test]
    fn circle_in_closed_form() {
        let s = Shape::new(vec![0.3, 2.0], 1.5).unwrap();
        let radius = 1.5 / 2.0;
        for u in [0.0, 0.25, 1.0] {
            let a = 0.3 + 2.0 * u;
            let want = [radius * (maths::sin(a) - maths::sin(0.3)), radius * (maths::cos(0.3) - maths::cos(a))];
            close(s.point_m(u), want, 1e-15);
        }
        let many_turns = Shape::new(vec![0.0, 1e3], 1.0).unwrap();
        close(many_turns.chord_m(), [maths::sin(1e3) / 1e3, (1.0 - maths::cos(1e3)) / 1e3], 1e-15);
    }

    #[test]
    fn chord_is_spanned_to_rounding() {
        for bend in [vec![], vec![1.3092, -1.57], vec![20.0], vec![3.0, -5.0, 7.0, -4.0]] {
            for chord in [[0.028, 0.01877], [-3.0, 0.0], [0.0, -1e-9]] {
                let s = Shape::from_chord(chord, &bend).unwrap();
                close(s.chord_m(), chord, 4e-15 * maths::hypot(chord[0], chord[1]).max(s.length_m()));
                assert!(s.angle_at(0.0).abs() <= TAU);
            }
        }
    }

    #[test]
    fn slope_and_reversal() {
        let s = Shape::new(vec![0.1, 0.2, -0.7, 0.4], 2.0).unwrap();
        assert!((s.slope_at(0.5) - (0.2 - 0.7 + 3.0 * 0.4 * 0.25)).abs() < 1e-15);
        let r = s.reversed();
        for u in [0.0, 0.2, 0.9] {
            assert!((r.angle_at(u) - s.angle_at(1.0 - u) - PI).abs() < 1e-14);
        }
        let [x, y] = s.chord_m();
        close(r.chord_m(), [-x, -y], 1e-14);
    }

    #[test]
    fn parts_lie_on_the_whole() {
        let s = Shape::new(vec![0.1, 0.9, -0.7, 0.4], 2.0).unwrap();
        let part = s.part([0.2, 0.7]);
        let (from, to) = (s.point_m(0.2), s.point_m(0.7));
        close(part.chord_m(), [to[0] - from[0], to[1] - from[1]], 1e-15);
        assert!((part.angle_at(0.3) - s.angle_at(0.35)).abs() < 1e-15);
        assert_eq!(s.part([0.0, 1.0]), s);
    }

    #[test]
    fn impossible_shapes_are_named() {
        assert_eq!(Shape::new(vec![], 1.0), Err(ShapeError::NoCoefficients));
        assert_eq!(Shape::new(vec![0.0], 0.0), Err(ShapeError::Length { length_m: 0.0 }));
        assert!(Shape::new(vec![0.0], f64::NAN).is_err());
        assert_eq!(Shape::new(vec![f64::INFINITY], 1.0), Err(ShapeError::NotFinite));
        assert!(matches!(Shape::new(vec![0.0, 1e6], 1.0), Err(ShapeError::TurnsTooMuch { .. })));
        assert_eq!(Shape::from_chord([0.0, 0.0], &[1.0]), Err(ShapeError::NoChord));
        assert!(matches!(Shape::from_chord([1.0, 0.0], &[TAU]), Err(ShapeError::ClosedLoop { .. })));
        assert!(matches!(Shape::from_chord([1.0, f64::NAN], &[FRAC_PI_2]), Err(ShapeError::NotFinite)));
        assert!(matches!(Shape::from_chord([1.5e308, 1.5e308], &[]), Err(ShapeError::Length { .. })));
        let s = Shape::new(vec![0.0, 1.0], 1.0).unwrap();
        close(s.point_m(f64::NAN), [0.0, 0.0], 1e-300);
    }
}
