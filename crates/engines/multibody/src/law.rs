//! Elastic laws of springs: force over length, or torque over angle, with the energy stored.

use std::fmt;
use std::sync::Arc;

/// Force of a spring over its length (tension positive) or torque over its angle (against growth positive).
#[derive(Clone)]
pub enum Law {
    /// `preload + rate·(x − rest)`.
    Linear {
        /// Stiffness, N/m or N·m/rad.
        rate: f64,
        /// Length, m, or angle, rad, at which the force is the preload.
        rest: f64,
        /// Force, N, or torque, N·m, at rest.
        preload: f64,
    },
    /// Through measured points.
    Table(Table),
    /// Any other: force and stored energy, J, whose derivative it must be.
    Function(Arc<dyn Fn(f64) -> [f64; 2] + Send + Sync>),
}

impl Law {
    /// A linear spring without preload.
    pub fn linear(rate: f64, rest: f64) -> Self {
        Self::Linear { rate, rest, preload: 0.0 }
    }

    /// Force and stored energy at a length or angle.
    pub fn at(&self, x: f64) -> [f64; 2] {
        match self {
            Self::Linear { rate, rest, preload } => {
                let stretch = x - rest;
                [preload + rate * stretch, stretch * (preload + 0.5 * rate * stretch)]
            }
            Self::Table(table) => table.at(x),
            Self::Function(f) => f(x),
        }
    }
}

impl fmt::Debug for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Linear { rate, rest, preload } => write!(f, "Linear({rate}, {rest}, {preload})"),
            Self::Table(table) => write!(f, "{table:?}"),
            Self::Function(_) => f.write_str("Function"),
        }
    }
}

/// A smooth curve through points: cubic pieces with continuous slope that never overshoot, straight beyond the ends.
///
/// F. N. Fritsch & J. Butland, "A method for constructing local monotone piecewise cubic interpolants", SIAM J. Sci. Stat. Comput. 5
/// (1984). The energy is the exact integral, 0 at the first point.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    x: Vec<f64>,
    force: Vec<f64>,
    slope: Vec<f64>,
    energy: Vec<f64>,
}

/// Why points make no table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableError {
    /// Fewer than two points.
    TooFew,
    /// A value is not finite, or an abscissa is not above the one before it.
    Order {
        /// Which point.
        index: usize,
    },
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew => f.write_str("a table needs two points or more"),
            Self::Order { index } => write!(f, "point {index} of the table is not finite or does not lie above the one before it"),
        }
    }
}

impl std::error::Error for TableError {}

impl Table {
    /// The curve through points (length or angle, force or torque), in rising order of the first.
    ///
    /// # Errors
    /// [`TableError`] for fewer than two points, equal or falling abscissae, values that are not finite.
    pub fn new(points: &[[f64; 2]]) -> Result<Self, TableError> {
        if points.len() < 2 {
            return Err(TableError::TooFew);
        }
        for (index, p) in points.iter().enumerate() {
            let rises = index == 0 || p[0] > points[index - 1][0];
            if !(rises && p[0].is_finite() && p[1].is_finite()) {
                return Err(TableError::Order { index });
            }
        }
        let x: Vec<f64> = points.iter().map(|p| p[0]).collect();
        let force: Vec<f64> = points.iter().map(|p| p[1]).collect();
        let widths: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
        let secants: Vec<f64> = force.windows(2).zip(&widths).map(|(f, h)| (f[1] - f[0]) / h).collect();
        let last = secants.len() - 1;
        let mut slope = vec![secants[0]];
        slope.extend((1..x.len() - 1).map(|k| inner_slope([secants[k - 1], secants[k]], [widths[k - 1], widths[k]])));
        slope.push(secants[last]);
        let mut energy = vec![0.0];
        for (k, h) in widths.iter().enumerate() {
            // Integral of the Hermite cubic: trapezium and end-slope correction.
            let piece = h * (0.5 * (force[k] + force[k + 1]) + h / 12.0 * (slope[k] - slope[k + 1]));
            energy.push(energy[k] + piece);
        }
        Ok(Self { x, force, slope, energy })
    }

    fn at(&self, x: f64) -> [f64; 2] {
        let last = self.x.len() - 1;
        for end in [0, last] {
            let beyond = x - self.x[end];
            if (end == 0) == (beyond <= 0.0) && (end == 0 || beyond >= 0.0) {
                let (f, m) = (self.force[end], self.slope[end]);
                return [f + m * beyond, self.energy[end] + beyond * (f + 0.5 * m * beyond)];
            }
        }
        let k = self.x.partition_point(|knot| *knot <= x).clamp(1, last) - 1;
        let h = self.x[k + 1] - self.x[k];
        let s = (x - self.x[k]) / h;
        let (f, rise) = (self.force[k], self.force[k + 1] - self.force[k]);
        let (a, b) = (h * self.slope[k], h * self.slope[k + 1]);
        // f + a s + c s² + d s³
        let (c, d) = (3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise);
        let force = f + s * (a + s * (c + s * d));
        let energy = self.energy[k] + h * s * (f + s * (a / 2.0 + s * (c / 3.0 + s * d / 4.0)));
        [force, energy]
    }
}

/// Weighted harmonic mean of the secants; 0 at an extremum.
fn inner_slope([before, after]: [f64; 2], [h_before, h_after]: [f64; 2]) -> f64 {
    if before * after <= 0.0 {
        return 0.0;
    }
    let (w_before, w_after) = (2.0 * h_after + h_before, h_after + 2.0 * h_before);
    (w_before + w_after) / (w_before / before + w_after / after)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_of_a_line_is_the_line_with_its_energy() {
        let table = Law::Table(Table::new(&[[0.1, 2.0], [0.2, 4.0], [0.5, 10.0]]).unwrap());
        let line = Law::linear(20.0, 0.0);
        for x in [-0.3, 0.1, 0.15, 0.2, 0.43, 0.5, 0.9] {
            let ([f, e], [f0, e0]) = (table.at(x), line.at(x));
            assert!((f - f0).abs() < 1e-13 && (e - (e0 - 0.1)).abs() < 1e-13, "{x}: {f} {e}");
        }
    }

    #[test]
    fn force_is_the_derivative_of_energy_and_does_not_overshoot() {
        let table = Law::Table(Table::new(&[[0.0, 0.0], [1.0, 5.0], [1.5, 5.0], [3.0, 1.0]]).unwrap());
        let h = 1e-5;
        for knot in [0.0, 1.0, 1.5, 3.0] {
            let across = table.at(knot + h)[1] - table.at(knot - h)[1];
            assert!((across - 2.0 * h * table.at(knot)[0]).abs() < 1e-8, "{knot}: {across}");
        }
        for k in -10..40 {
            let x = 0.1 * f64::from(k) + 0.003;
            let slope = (table.at(x + h)[1] - table.at(x - h)[1]) / (2.0 * h);
            assert!((slope - table.at(x)[0]).abs() < 1e-8, "{x}");
            assert!(!(0.0..3.0).contains(&x) || (0.0..=5.0).contains(&table.at(x)[0]), "{x}");
        }
        assert_eq!(Table::new(&[[0.0, 0.0]]), Err(TableError::TooFew));
        assert_eq!(Table::new(&[[0.0, 0.0], [0.0, 1.0]]), Err(TableError::Order { index: 1 }));
    }
}
