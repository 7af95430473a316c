//! Elementary functions from one place.
//!
//! The standard library forwards `sin`, `exp`, … to the platform, and their last bits differ between platforms. A curve must be the
//! same everywhere, so the whole workspace calls these portable versions (`clippy.toml` refuses the others).

/// Sine of an angle in rad.
#[inline]
pub fn sin(x_rad: f64) -> f64 {
    libm::sin(x_rad)
}

/// Cosine of an angle in rad.
#[inline]
pub fn cos(x_rad: f64) -> f64 {
    libm::cos(x_rad)
}

/// Sine and cosine of an angle in rad.
#[inline]
pub fn sin_cos(x_rad: f64) -> (f64, f64) {
    libm::sincos(x_rad)
}

/// Tangent of an angle in rad.
#[inline]
pub fn tan(x_rad: f64) -> f64 {
    libm::tan(x_rad)
}

/// Arcsine, rad, for `x` in [−1, 1].
#[inline]
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}

/// Arccosine, rad, for `x` in [−1, 1].
#[inline]
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// Angle of the vector `(x, y)`, rad, in (−π, π].
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Exponential function.
#[inline]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Natural logarithm.
#[inline]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Decimal logarithm.
#[inline]
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

/// `ln(1 + x)`, without the loss of digits near 0.
#[inline]
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}

/// `exp(x) − 1`, without the loss of digits near 0.
#[inline]
pub fn exp_m1(x: f64) -> f64 {
    libm::expm1(x)
}

/// Complementary error function, `2/√π ∫ₓ^∞ exp(−t²) dt`.
#[inline]
pub fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}

/// Logarithm of the gamma function, for `x > 0`.
#[inline]
pub fn ln_gamma(x: f64) -> f64 {
    libm::lgamma(x)
}

/// `x` to the power `y`.
#[inline]
pub fn powf(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// `x` to a whole power, by repeated squaring.
pub fn powi(x: f64, n: i32) -> f64 {
    let (mut base, mut left, mut out) = (if n < 0 { 1.0 / x } else { x }, n.unsigned_abs(), 1.0);
    while left > 0 {
        if left & 1 == 1 {
            out *= base;
        }
        base *= base;
        left >>= 1;
    }
    out
}

/// Length of the vector `(x, y)` without overflow.
#[inline]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

/// Cube root.
#[inline]
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}
