//! Boxes along the axes, and rigid motions.

use crate::vector::{Vector, add, rotate, sub};

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Its lower left corner, m.
    pub min_m: [f64; 2],
    /// Its upper right corner, m.
    pub max_m: [f64; 2],
}

impl Bounds {
    /// The smallest box around points; of none an empty one, from +∞ to −∞.
    pub fn of(points_m: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let mut bounds = Self { min_m: [f64::INFINITY; 2], max_m: [f64::NEG_INFINITY; 2] };
        for point_m in points_m {
            bounds.include(point_m);
        }
        bounds
    }

    /// Grows to a point.
    pub fn include(&mut self, point_m: [f64; 2]) {
        *self = self.union(Self { min_m: point_m, max_m: point_m });
    }

    /// The smallest box around both.
    pub fn union(self, other: Self) -> Self {
        let both = |a: [f64; 2], b: [f64; 2], pick: fn(f64, f64) -> f64| [pick(a[0], b[0]), pick(a[1], b[1])];
        Self { min_m: both(self.min_m, other.min_m, f64::min), max_m: both(self.max_m, other.max_m, f64::max) }
    }

    /// Whether a point lies in it or on its border.
    pub fn contains(&self, point_m: [f64; 2]) -> bool {
        (0..2).all(|axis| self.min_m[axis] <= point_m[axis] && point_m[axis] <= self.max_m[axis])
    }

    /// The longer of its sides, m; 0 of an empty box.
    pub fn extent_m(&self) -> f64 {
        (self.max_m[0] - self.min_m[0]).max(self.max_m[1] - self.min_m[1]).max(0.0)
    }
}

/// A rigid motion of the plane: perhaps a reflection on the x axis, then a rotation about the origin, then a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    mirrored: bool,
    angle_rad: f64,
    shift_m: Vector,
}

impl Motion {
    /// A rotation about the origin and a shift after it.
    pub fn new(angle_rad: f64, shift_m: [f64; 2]) -> Self {
        Self { mirrored: false, angle_rad, shift_m }
    }

    /// The reflection on a line through a point. The direction may have any length but zero.
    pub fn mirror(point_m: [f64; 2], direction: [f64; 2]) -> Self {
        let angle_rad = 2.0 * forcewright_base::maths::atan2(direction[1], direction[0]);
        let through_origin = Self { mirrored: true, angle_rad, shift_m: [0.0; 2] };
        Self { shift_m: sub(point_m, through_origin.turn(point_m)), ..through_origin }
    }

    /// Whether left becomes right.
    pub fn is_mirrored(&self) -> bool {
        self.mirrored
    }

    /// The image of a point, m.
    pub fn apply(&self, point_m: [f64; 2]) -> [f64; 2] {
        add(self.turn(point_m), self.shift_m)
    }

    /// The image of a direction.
    pub fn turn(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        rotate(if self.mirrored { [x, -y] } else { [x, y] }, self.angle_rad)
    }
}
