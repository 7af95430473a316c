//! One-dimensional roots and minima without derivatives.
//!
//! R. P. Brent, "Algorithms for Minimization without Derivatives", Prentice-Hall 1973, chapters 4 and 5.

use std::fmt;

/// Why no root was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RootError {
    /// The function has the same sign at both ends, so the interval need not contain a root.
    NoSignChange {
        /// Value at the left end.
        left: f64,
        /// Value at the right end.
        right: f64,
    },
    /// The function or an end of the interval is not a number.
    NotANumber {
        /// Where.
        x: f64,
    },
}

impl fmt::Display for RootError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSignChange { left, right } => {
                write!(f, "no sign change: the ends have {left} and {right}; widen the interval")
            }
            Self::NotANumber { x } => write!(f, "the function is not a number at {x}"),
        }
    }
}

impl std::error::Error for RootError {}

/// A root of `f` in `[a, b]`, wrong by at most `tolerance` plus rounding. `f(a)` and `f(b)` must differ in sign.
///
/// Brent's method, chapter 4: bisection, secant and inverse quadratic steps; never slower than a few times bisection.
///
/// # Errors
/// [`RootError`] if the ends have the same sign or a value is not a number.
///
/// ```
/// let root = forcewright_base::roots::root(|x| x * x - 2.0, 0.0, 2.0, 1e-15).expect("bracketed");
/// assert!((root - 2.0_f64.sqrt()).abs() < 1e-15);
/// ```
pub fn root(mut f: impl FnMut(f64) -> f64, a: f64, b: f64, tolerance: f64) -> Result<f64, RootError> {
    let mut value = |x: f64| {
        let y = f(x);
        if y.is_nan() || !x.is_finite() { Err(RootError::NotANumber { x }) } else { Ok(y) }
    };
    let (mut a, mut b) = (a, b);
    let (mut fa, mut fb) = (value(a)?, value(b)?);
    if fa == 0.0 {
        return Ok(a);
    }
    if fb == 0.0 {
        return Ok(b);
    }
    if (fa > 0.0) == (fb > 0.0) {
        return Err(RootError::NoSignChange { left: fa, right: fb });
    }
    let (mut c, mut fc) = (a, fa);
    let mut step = b - a;
    let mut last = step;
    // Brent's worst case is about (bits)² evaluations; in practice 10.
    for _ in 0..10_000 {
        if fc.abs() < fb.abs() {
            (a, b, c) = (b, c, b);
            (fa, fb, fc) = (fb, fc, fb);
        }
        let near = 2.0 * f64::EPSILON * b.abs() + 0.5 * tolerance.max(0.0);
        let half = 0.5 * (c - b);
        if half.abs() <= near || fb == 0.0 {
            break;
        }
        if last.abs() < near || fa.abs() <= fb.abs() {
            (step, last) = (half, half);
        } else {
            (step, last) = interpolated_step([a, b, c], [fa, fb, fc], half, near, step, last);
        }
        (a, fa) = (b, fb);
        b += if step.abs() > near { step } else { near.copysign(half) };
        fb = value(b)?;
        if (fb > 0.0) == (fc > 0.0) {
            (c, fc) = (a, fa);
            step = b - a;
            last = step;
        }
    }
    Ok(b)
}

/// Secant or inverse quadratic step if it is acceptable, else bisection; returns the step and the one before it.
fn interpolated_step(x: [f64; 3], y: [f64; 3], half: f64, near: f64, step: f64, last: f64) -> (f64, f64) {
    let s = y[1] / y[0];
    let (mut p, mut q);
    if x[0].to_bits() == x[2].to_bits() {
        p = 2.0 * half * s;
        q = 1.0 - s;
    } else {
        let (r, t) = (y[1] / y[2], y[0] / y[2]);
        p = s * (2.0 * half * t * (t - r) - (x[1] - x[0]) * (r - 1.0));
        q = (t - 1.0) * (r - 1.0) * (s - 1.0);
    }
    if p > 0.0 {
        q = -q;
    } else {
        p = -p;
    }
    if 2.0 * p < 3.0 * half * q - (near * q).abs() && p < (0.5 * last * q).abs() { (p / q, step) } else { (half, half) }
}

/// A local minimum found by [`minimise`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Minimum {
    /// Where, inside the interval.
    pub x: f64,
    /// The value there.
    pub value: f64,
}

/// A local minimum of `f` in `[a, b]`; the only one if `f` is unimodal there. The place is wrong by about `tolerance`, the value
/// by its square.
///
/// Brent's method, chapter 5: golden section with parabolic steps. The ends themselves are approached, not evaluated. Values that
/// are not numbers count as large.
///
/// ```
/// let m = forcewright_base::roots::minimise(|x| (x - 0.3) * (x - 0.3) + 1.0, 0.0, 1.0, 1e-9);
/// assert!((m.x - 0.3).abs() < 1e-7 && (m.value - 1.0).abs() < 1e-14);
/// ```
pub fn minimise(mut f: impl FnMut(f64) -> f64, a: f64, b: f64, tolerance: f64) -> Minimum {
    const GOLDEN: f64 = 0.381_966_011_250_105_1;
    let mut value = |x: f64| {
        let y = f(x);
        if y.is_nan() { f64::INFINITY } else { y }
    };
    let (mut a, mut b) = (a.min(b), a.max(b));
    let mut x = a + GOLDEN * (b - a);
    let (mut w, mut v) = (x, x);
    let mut fx = value(x);
    let (mut fw, mut fv) = (fx, fx);
    let (mut step, mut last) = (0.0_f64, 0.0_f64);
    for _ in 0..200 {
        let middle = 0.5 * (a + b);
        let near = f64::EPSILON.sqrt() * 1e-2 * x.abs() + tolerance.abs() / 3.0 + f64::MIN_POSITIVE;
        let spare = (x - middle).abs() - (2.0 * near - 0.5 * (b - a));
        if spare <= 0.0 || spare.is_nan() {
            break;
        }
        let parabola = (last.abs() > near).then(|| parabolic_step([x, w, v], [fx, fw, fv])).flatten();
        match parabola {
            Some(p) if p.abs() < (0.5 * last).abs() && a < x + p && x + p < b => {
                (step, last) = (p, step);
                let u = x + step;
                if u - a < 2.0 * near || b - u < 2.0 * near {
                    step = near.copysign(middle - x);
                }
            }
            _ => {
                last = if x < middle { b - x } else { a - x };
                step = GOLDEN * last;
            }
        }
        let u = x + if step.abs() >= near { step } else { near.copysign(step) };
        let fu = value(u);
        if fu <= fx {
            if u < x {
                b = x;
            } else {
                a = x;
            }
            (v, fv, w, fw, x, fx) = (w, fw, x, fx, u, fu);
        } else {
            if u < x {
                a = u;
            } else {
                b = u;
            }
            if fu <= fw || w.to_bits() == x.to_bits() {
                (v, fv, w, fw) = (w, fw, u, fu);
            } else if fu <= fv || v.to_bits() == x.to_bits() || v.to_bits() == w.to_bits() {
                (v, fv) = (u, fu);
            }
        }
    }
    Minimum { x, value: fx }
}

/// Step from the first point to the vertex of the parabola through three points.
fn parabolic_step(x: [f64; 3], y: [f64; 3]) -> Option<f64> {
    let r = (x[0] - x[1]) * (y[0] - y[2]);
    let q = (x[0] - x[2]) * (y[0] - y[1]);
    let step = ((x[0] - x[1]) * r - (x[0] - x[2]) * q) / (2.0 * (q - r));
    step.is_finite().then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maths;

    #[test]
    fn roots_in_closed_form() {
        let half_pi = root(maths::cos, 1.0, 3.0, 1e-15).unwrap();
        assert!((half_pi - std::f64::consts::FRAC_PI_2).abs() < 4e-16);
        // Flat root of order 9: bisection must take over.
        let flat = root(|x| maths::powi(x - 0.7, 9), 0.0, 2.0, 1e-12).unwrap();
        assert!((flat - 0.7).abs() < 1e-3, "{flat}");
        assert!((root(|x| x - 1.0, 5.0, -5.0, 0.0).unwrap() - 1.0).abs() < 1e-15);
        assert!(root(|x| x, 0.0, 1.0, 1e-9).unwrap().abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn few_evaluations_for_a_smooth_function() {
        let mut count = 0;
        let x = root(
            |x| {
                count += 1;
                maths::exp(x) - 2.0
            },
            0.0,
            1.0,
            1e-14,
        );
        assert!((x.unwrap() - std::f64::consts::LN_2).abs() < 1e-14 && count <= 10, "{count}");
    }

    #[test]
    fn no_sign_change_and_nan_are_named() {
        assert_eq!(root(|x| x * x + 1.0, -1.0, 1.0, 1e-9), Err(RootError::NoSignChange { left: 2.0, right: 2.0 }));
        assert!(matches!(root(|_| f64::NAN, 0.0, 1.0, 1e-9), Err(RootError::NotANumber { .. })));
        assert!(matches!(root(|x| x, f64::NEG_INFINITY, 1.0, 1e-9), Err(RootError::NotANumber { .. })));
    }

    #[test]
    fn minima_in_closed_form() {
        let m = minimise(|x| -maths::sin(x), 0.0, 3.0, 1e-9);
        assert!((m.x - std::f64::consts::FRAC_PI_2).abs() < 1e-7 && (m.value + 1.0).abs() < 1e-15);
        let m = minimise(|x| (x - 0.2).abs(), -1.0, 1.0, 1e-10);
        assert!((m.x - 0.2).abs() < 1e-9);
        let end = minimise(|x| x, 2.0, 3.0, 1e-9);
        assert!((end.x - 2.0).abs() < 1e-8);
        assert!(minimise(|_| f64::NAN, 0.0, 1.0, 1e-9).value.is_infinite());
    }
}
