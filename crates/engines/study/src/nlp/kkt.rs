//! Optimality conditions at a point.
//!
//! Nocedal & Wright, "Numerical Optimization", 2nd ed., eqs. (12.34).

use super::model::{Model, Point, violations};
use super::outcome::KktResidual;

/// Above this largest multiplier (scaled) stationarity is measured relative to the multipliers, as A. Wächter and L. T. Biegler do, "On
/// the implementation of an interior-point filter line-search algorithm", Mathematical Programming 106 (2006), section 2.1.
const LARGE_MULTIPLIER: f64 = 100.0;

/// `∇f − Jᵀλ`.
pub(super) fn lagrangian_gradient(point: &Point, multipliers: &[f64], out: &mut Vec<f64>) {
    out.clear();
    out.extend_from_slice(&point.gradient);
    let n = point.z.len();
    for (i, y) in multipliers.iter().enumerate().filter(|(_, y)| **y != 0.0) {
        for (r, a) in out.iter_mut().zip(&point.jacobian[i * n..(i + 1) * n]) {
            *r -= y * a;
        }
    }
}

/// Residual at a point with multipliers of the constraints; fills in those of the bounds.
///
/// A variable takes a multiplier where the quadratic programme held it at its bound (`held`), with the sign that the bound allows.
pub(super) fn residual(model: &Model<'_>, point: &Point, multipliers: &[f64], held: &[f64], bounds: &mut Vec<f64>) -> KktResidual {
    let mut gradient = Vec::new();
    lagrangian_gradient(point, multipliers, &mut gradient);
    let (mut stationarity, mut complementarity) = (0.0_f64, 0.0_f64);
    bounds.clear();
    for (j, r) in gradient.iter().enumerate() {
        let side = if *r > 0.0 { model.lower[j] } else { model.upper[j] };
        let distance = (side - point.z[j]).abs();
        let mu = if held[j] * r > 0.0 && distance.is_finite() { *r } else { 0.0 };
        stationarity = stationarity.max((r - mu).abs());
        if mu != 0.0 {
            complementarity = complementarity.max(mu.abs() * distance);
        }
        bounds.push(mu);
    }
    for (i, y) in multipliers.iter().enumerate().filter(|(_, y)| **y != 0.0) {
        let bound = if *y > 0.0 { model.row_lower[i] } else { model.row_upper[i] };
        complementarity = complementarity.max((y * (point.constraints[i] - bound)).abs());
    }
    let scale = multipliers.iter().chain(bounds.iter()).fold(LARGE_MULTIPLIER, |m, y| m.max(y.abs())) / LARGE_MULTIPLIER;
    let feasibility = violations(&point.constraints, &model.row_lower, &model.row_upper).fold(0.0, f64::max);
    KktResidual { stationarity: stationarity / scale, complementarity, feasibility }
}
