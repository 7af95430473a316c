//! The cam of the paper `sanchez-salinas2022` in closed form: for a constant force without friction the roller's centre moves on
//! x = x0 + √(2As), y = s + √(l² − x0²) − √(l² − x²), and the cam is that path at the distance of the roller's radius.

#![allow(dead_code, reason = "each test file uses its part")]

use forcewright_curves::plane::{CurvePoint, PlaneCurve};

pub(crate) const A_M: f64 = 9.058e-3;
pub(crate) const BRACE_M: f64 = 0.2;
pub(crate) const START_M: f64 = 0.068;
pub(crate) const ROLLER_M: f64 = 0.016;

/// Where the offset has its cusp, by the abscissa of the roller's centre.
pub(crate) const CUSP_M: f64 = 0.071_056_222_112_110_95;

/// The right flank by the abscissa of the roller's centre, from the cusp to a travel of 240 mm.
pub(crate) struct Flank;

impl PlaneCurve for Flank {
    fn range(&self) -> [f64; 2] {
        [CUSP_M, START_M + (2.0 * A_M * 0.24).sqrt()]
    }

    fn at(&self, x: f64) -> CurvePoint {
        let brace = BRACE_M * BRACE_M - x * x;
        let f = (x - START_M) / A_M + x / brace.sqrt();
        let f1 = 1.0 / A_M + BRACE_M * BRACE_M / (brace * brace.sqrt());
        let f2 = 3.0 * BRACE_M * BRACE_M * x / (brace * brace * brace.sqrt());
        let y = (x - START_M) * (x - START_M) / (2.0 * A_M) + (BRACE_M * BRACE_M - START_M * START_M).sqrt() - brace.sqrt();
        let q = (1.0 + f * f).sqrt();
        // Offset to the left of the tangent (1, f): its derivative is the tangent times k.
        let k = 1.0 - ROLLER_M * f1 / (q * q * q);
        let k1 = -ROLLER_M * (f2 / (q * q * q) - 3.0 * f * f1 * f1 / (q * q * q * q * q));
        CurvePoint { point_m: [x - ROLLER_M * f / q, y + ROLLER_M / q], first_m: [k, f * k], second_m: [k1, f1 * k + f * k1] }
    }
}
