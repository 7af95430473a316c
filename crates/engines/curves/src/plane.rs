//! Smooth plane curves by their parameter.

use crate::vector::{Vector, cross, norm};

/// A place of a plane curve with its first two derivatives by the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Where, m.
    pub point_m: [f64; 2],
    /// First derivative, m per unit of the parameter.
    pub first_m: [f64; 2],
    /// Second derivative, m per unit of the parameter squared.
    pub second_m: [f64; 2],
}

impl CurvePoint {
    /// Signed curvature, 1/m: positive where the curve bends to the left. Not finite where the first derivative vanishes.
    pub fn curvature_per_m(&self) -> f64 {
        let speed = norm(self.first_m);
        cross(self.first_m, self.second_m) / (speed * speed * speed)
    }

    /// Unit normal to the left of the direction of the growing parameter. Not finite where the first derivative vanishes.
    pub fn left_normal(&self) -> [f64; 2] {
        let speed = norm(self.first_m);
        [-self.first_m[1] / speed, self.first_m[0] / speed]
    }

    pub(crate) fn is_finite(&self) -> bool {
        [self.point_m, self.first_m, self.second_m].iter().flatten().all(|x: &f64| x.is_finite())
    }
}

/// A plane curve that is twice differentiable in its parameter. What the parameter means does not matter.
pub trait PlaneCurve {
    /// First and last parameter, ascending.
    fn range(&self) -> [f64; 2];

    /// The place at a parameter in the range.
    fn at(&self, parameter: f64) -> CurvePoint;
}

/// The curve as seen in a mirror on the y axis, by the same parameter: from the right flank of a symmetric part to its left one. What was to
/// the left is to the right: distances to the left change their sign.
#[derive(Clone, Copy, Debug)]
pub struct Mirrored<C>(pub C);

impl<C: PlaneCurve> PlaneCurve for Mirrored<C> {
    fn range(&self) -> [f64; 2] {
        self.0.range()
    }

    fn at(&self, parameter: f64) -> CurvePoint {
        let flip = |[x, y]: Vector| [-x, y];
        let CurvePoint { point_m, first_m, second_m } = self.0.at(parameter);
        CurvePoint { point_m: flip(point_m), first_m: flip(first_m), second_m: flip(second_m) }
    }
}

impl<C: PlaneCurve + ?Sized> PlaneCurve for &C {
    fn range(&self) -> [f64; 2] {
        (**self).range()
    }

    fn at(&self, parameter: f64) -> CurvePoint {
        (**self).at(parameter)
    }
}
