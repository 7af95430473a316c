//! Paths on which rollers run, and the path of a roller's centre beside a surface.

use std::fmt;
use std::sync::Arc;

use forcewright_base::maths;

/// Point of a plane curve with its derivatives by the parameter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PathPoint {
    /// Coordinates, m.
    pub point_m: [f64; 2],
    /// First derivative, m per unit of the parameter.
    pub first: [f64; 2],
    /// Second derivative.
    pub second: [f64; 2],
    /// Third derivative; used only where the curve is the surface, not the path of the centre.
    pub third: [f64; 2],
}

/// A plane curve `p(u)`, three times differentiable, with `p′ ≠ 0`. Outside its range it must go on smoothly: a step that is refused
/// later may look there.
pub trait Curve: Send + Sync {
    /// Point and derivatives at a parameter.
    fn at(&self, u: f64) -> PathPoint;
}

impl<F: Fn(f64) -> PathPoint + Send + Sync> Curve for F {
    fn at(&self, u: f64) -> PathPoint {
        self(u)
    }
}

/// A curve in the frame of the body that carries it.
#[derive(Clone)]
pub enum Path {
    /// A straight line; the parameter is the length from a point, m.
    Line {
        /// The point, m.
        point_m: [f64; 2],
        /// Direction, rad.
        direction_rad: f64,
    },
    /// A circle, counter-clockwise; the parameter is the angle from the x axis, rad.
    Circle {
        /// Centre, m.
        centre_m: [f64; 2],
        /// Radius, m.
        radius_m: f64,
    },
    /// Any other.
    Curve(Arc<dyn Curve>),
}

impl Path {
    /// Wraps a curve.
    pub fn curve(curve: impl Curve + 'static) -> Self {
        Self::Curve(Arc::new(curve))
    }

    /// Point and derivatives at a parameter.
    pub fn at(&self, u: f64) -> PathPoint {
        match self {
            Self::Line { point_m, direction_rad } => {
                let (s, c) = maths::sin_cos(*direction_rad);
                PathPoint { point_m: [point_m[0] + c * u, point_m[1] + s * u], first: [c, s], ..PathPoint::default() }
            }
            Self::Circle { centre_m, radius_m: r } => {
                let (s, c) = maths::sin_cos(u);
                PathPoint {
                    point_m: [centre_m[0] + r * c, centre_m[1] + r * s],
                    first: [-r * s, r * c],
                    second: [-r * c, -r * s],
                    third: [r * s, -r * c],
                }
            }
            Self::Curve(curve) => curve.at(u),
        }
    }
}

impl fmt::Debug for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line { point_m, direction_rad } => write!(f, "Line({point_m:?}, {direction_rad})"),
            Self::Circle { centre_m, radius_m } => write!(f, "Circle({centre_m:?}, {radius_m})"),
            Self::Curve(_) => f.write_str("Curve"),
        }
    }
}

/// What a [`Path`] of a contact is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Follows {
    /// The path of the roller's centre.
    Centre,
    /// The surface on which the roller rolls; its centre then keeps the roller's radius from it.
    Surface,
}

/// A side of a curve, seen along its rising parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Counter-clockwise from its tangent.
    Left,
    /// Clockwise from its tangent.
    Right,
}

impl Side {
    /// +1 on the left, −1 on the right.
    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }
}

/// Path of the roller's centre with what rolling needs, in the frame of the body that carries it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CentrePoint {
    pub(crate) point: [f64; 2],
    pub(crate) first: [f64; 2],
    pub(crate) second: [f64; 2],
    /// Unit tangent of the given curve.
    pub(crate) tangent: [f64; 2],
    /// `first = speed · tangent`; negative where the surface bends more tightly than the roller (undercut).
    pub(crate) speed: f64,
    /// Derivative of the speed by the parameter.
    pub(crate) speed_rate: f64,
}

/// The centre's path; `offset_m` is the distance to the left of a surface, 0 if the path is that of the centre already.
///
/// With unit normal n to the left, curvature κ = p′×p″/v³ and v = |p′|: c = p + ρ n, c′ = (1 − ρκ) p′, c″ = (1 − ρκ) p″ − ρκ′ p′.
pub(crate) fn centre_path(path: &Path, u: f64, offset_m: f64) -> CentrePoint {
    let p = path.at(u);
    let v2 = dot(p.first, p.first);
    let v = v2.sqrt();
    let tangent = [p.first[0] / v, p.first[1] / v];
    let v_rate = dot(tangent, p.second);
    if offset_m == 0.0 {
        return CentrePoint { point: p.point_m, first: p.first, second: p.second, tangent, speed: v, speed_rate: v_rate };
    }
    let curvature = cross(p.first, p.second) / (v2 * v);
    let curvature_rate = cross(p.first, p.third) / (v2 * v) - 3.0 * curvature * v_rate / v;
    let stretch = 1.0 - offset_m * curvature;
    let stretch_rate = -offset_m * curvature_rate;
    CentrePoint {
        point: [p.point_m[0] - offset_m * tangent[1], p.point_m[1] + offset_m * tangent[0]],
        first: [stretch * p.first[0], stretch * p.first[1]],
        second: [stretch * p.second[0] + stretch_rate * p.first[0], stretch * p.second[1] + stretch_rate * p.first[1]],
        tangent,
        speed: stretch * v,
        speed_rate: stretch_rate * v + stretch * v_rate,
    }
}

pub(crate) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(crate) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// A quarter turn counter-clockwise: `k × a`.
pub(crate) fn turn(a: [f64; 2]) -> [f64; 2] {
    [-a[1], a[0]]
}

pub(crate) fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}
