//! Vectors in space.

pub(super) type Vector = [f64; 3];

/// `a + factor·b`.
pub(super) fn along(a: Vector, b: Vector, factor: f64) -> Vector {
    [0, 1, 2].map(|k| a[k] + factor * b[k])
}

pub(super) fn scaled(a: Vector, factor: f64) -> Vector {
    a.map(|x| factor * x)
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

pub(super) fn unit(a: Vector) -> Vector {
    scaled(a, 1.0 / norm(a))
}

pub(super) fn distance(a: Vector, b: Vector) -> f64 {
    norm(along(a, b, -1.0))
}
