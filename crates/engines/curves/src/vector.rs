//! Vectors of the plane.

use forcewright_base::maths;

/// A point or a vector; all lengths in one unit.
pub type Vector = [f64; 2];

/// The sum.
pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

/// The difference.
pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1]]
}

/// A multiple.
pub fn scale(a: Vector, factor: f64) -> Vector {
    [a[0] * factor, a[1] * factor]
}

/// `a + factor · b`.
pub fn along(a: Vector, b: Vector, factor: f64) -> Vector {
    [a[0] + factor * b[0], a[1] + factor * b[1]]
}

/// From `a` at 0 to `b` at 1, exact at both.
pub fn mix(a: Vector, b: Vector, t: f64) -> Vector {
    [(1.0 - t) * a[0] + t * b[0], (1.0 - t) * a[1] + t * b[1]]
}

/// The inner product.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The outer product: positive if `b` points to the left of `a`.
pub fn cross(a: Vector, b: Vector) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Turned by a quarter counterclockwise.
pub fn left(a: Vector) -> Vector {
    [-a[1], a[0]]
}

/// Turned by a quarter clockwise.
pub fn right(a: Vector) -> Vector {
    [a[1], -a[0]]
}

/// The length.
pub fn norm(a: Vector) -> f64 {
    maths::hypot(a[0], a[1])
}

/// How far two points are apart.
pub fn distance(a: Vector, b: Vector) -> f64 {
    norm(sub(a, b))
}

/// Of length 1; the zero vector stays.
pub fn unit(a: Vector) -> Vector {
    let length = norm(a);
    if length > 0.0 { scale(a, 1.0 / length) } else { a }
}

/// The signed angle from `a` to `b`, rad, in (−π, π].
pub fn angle(a: Vector, b: Vector) -> f64 {
    maths::atan2(cross(a, b), dot(a, b))
}

/// Turned counterclockwise by an angle, rad.
pub fn rotate(a: Vector, angle_rad: f64) -> Vector {
    let (sin, cos) = maths::sin_cos(angle_rad);
    [cos * a[0] - sin * a[1], sin * a[0] + cos * a[1]]
}
