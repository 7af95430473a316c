//! One Gauss–Newton step of a rigid motion.

use forcewright_base::dense::Lu;

use super::{Arm, RegistrationError};
use crate::vector::{dot, left, sub};

/// A small motion, and how well the points hold it.
pub(super) struct Step {
    pub(super) angle_rad: f64,
    pub(super) shift_m: [f64; 2],
    /// `√diag (Jᵀ W J)⁻¹` for angle and shifts, in 1/m and 1.
    pub(super) deviations: [f64; 3],
}

/// The step from the present motion, whose shift is given. Turns are taken about the middle of the points, in which angle and shift hardly
/// depend on one another, with lengths over the size of the cloud.
pub(super) fn step(arms: &[Arm], shift_m: [f64; 2], size: f64) -> Result<Step, RegistrationError> {
    let weights: f64 = arms.iter().map(|arm| arm.weight).sum();
    let mean = |axis: usize| arms.iter().map(|arm| arm.weight * arm.point_m[axis]).sum::<f64>() / weights;
    let middle = [mean(0), mean(1)];
    let (mut normal, mut right) = ([0.0; 9], [0.0; 3]);
    for arm in arms {
        let row = [dot(left(sub(arm.point_m, middle)), arm.normal) / size, arm.normal[0], arm.normal[1]];
        for i in 0..3 {
            right[i] -= arm.weight * row[i] * arm.error_m / weights;
            for j in 0..3 {
                normal[3 * i + j] += arm.weight * row[i] * row[j] / weights;
            }
        }
    }
    let inverse = inverse(&normal)?;
    let solution: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| inverse[3 * i + j] * right[j]).sum());
    // About the origin of the motion, p = R m + t: δt = δt′ + δθ · left(t − middle).
    let arm = left(sub(shift_m, middle)).map(|x| x / size);
    let shift = |axis: usize| solution[1 + axis] + solution[0] * arm[axis];
    let variance = |axis: usize| {
        let (both, own) = (inverse[1 + axis], inverse[4 * (1 + axis)]);
        own + arm[axis] * (2.0 * both + arm[axis] * inverse[0])
    };
    let deviation = |unit: f64| (unit.max(0.0) / weights).sqrt();
    Ok(Step {
        angle_rad: solution[0] / size,
        shift_m: [shift(0), shift(1)],
        deviations: [deviation(inverse[0]) / size, deviation(variance(0)), deviation(variance(1))],
    })
}

/// Inverse of a symmetric matrix of three rows with entries of the order of 1.
fn inverse(matrix: &[f64; 9]) -> Result<[f64; 9], RegistrationError> {
    /// A pivot as small as this is what rounding leaves of nothing.
    const LEAST_PIVOT: f64 = 1e-12;
    let mut lu = Lu::new();
    lu.factor(3, 3, matrix).map_err(|_| RegistrationError::Free)?;
    if lu.smallest_pivot().is_nan() || lu.smallest_pivot() <= LEAST_PIVOT {
        return Err(RegistrationError::Free);
    }
    let mut inverse = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    lu.solve_columns(&mut inverse, 3);
    Ok(inverse)
}
