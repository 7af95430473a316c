//! How `c_0` and the length of a beam follow from its chord and its bend.

use forcewright_base::maths;

use crate::shape::{Shape, ShapeError};

/// Derivatives of the two quantities that [`Shape::from_chord`] computes.
///
/// From eq. (2) of Lan, Wang & Chen 2010 at u = 1, `L ∫ t(η) du = d` with the chord d: with T = ∫ t du, n = (−sin η, cos η) and
/// the quarter turn J, `dL T + L (dc_0 J T + Σ dc_k ∫ uᵏ n du) = dd`, of which T and J T pick one unknown each.
#[derive(Debug, Clone, PartialEq)]
pub struct ChordSensitivity {
    /// ∂`c_0`/∂d, rad/m.
    pub angle_by_chord_rad_per_m: [f64; 2],
    /// ∂L/∂d.
    pub length_by_chord: [f64; 2],
    /// ∂`c_0`/∂`c_k` for k = 1 … m.
    pub angle_by_bend: Vec<f64>,
    /// ∂L/∂`c_k` for k = 1 … m, m/rad.
    pub length_by_bend_m: Vec<f64>,
}

impl Shape {
    /// Derivatives of `c_0` and of the length of this shape if its chord and its bend `c_1 … c_m` are prescribed, as in
    /// [`Shape::from_chord`].
    ///
    /// # Errors
    /// [`ShapeError::ClosedLoop`] if the chord is below a millionth of the length.
    pub fn chord_sensitivity(&self) -> Result<ChordSensitivity, ShapeError> {
        let moments = self.direction_moments();
        let [x, y] = moments[0];
        let chord_per_length = maths::hypot(x, y);
        if chord_per_length < 1e-6 {
            return Err(ShapeError::ClosedLoop { chord_per_length });
        }
        let (square, length) = (chord_per_length * chord_per_length, self.length_m());
        // ∫ uᵏ n du is the quarter turn of ∫ uᵏ t du.
        let across = |m: &[f64; 2]| (x * m[1] - y * m[0]) / square;
        let along = |m: &[f64; 2]| (x * m[0] + y * m[1]) / square;
        Ok(ChordSensitivity {
            angle_by_chord_rad_per_m: [-y / (length * square), x / (length * square)],
            length_by_chord: [x / square, y / square],
            angle_by_bend: moments[1..].iter().map(|m| -along(m)).collect(),
            length_by_bend_m: moments[1..].iter().map(|m| length * across(m)).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn against_differences() {
        let (chord, bend) = ([0.03, -0.02], [1.3, -2.1, 0.8]);
        let exact = Shape::from_chord(chord, &bend).unwrap().chord_sensitivity().unwrap();
        // Fourth-order differences of (c_0, L).
        let slope = |at: &dyn Fn(f64) -> Shape, h: f64| {
            let value = |s: f64| {
                let shape = at(s);
                [shape.angle_rad()[0], shape.length_m()]
            };
            let (a, b, c, d) = (value(h), value(-h), value(2.0 * h), value(-2.0 * h));
            [0, 1].map(|i| (8.0 * (a[i] - b[i]) - (c[i] - d[i])) / (12.0 * h))
        };
        for axis in 0..2 {
            let got = slope(
                &|s| {
                    let mut moved = chord;
                    moved[axis] += s;
                    Shape::from_chord(moved, &bend).unwrap()
                },
                1e-5,
            );
            assert!((got[0] - exact.angle_by_chord_rad_per_m[axis]).abs() < 1e-8, "{got:?}");
            assert!((got[1] - exact.length_by_chord[axis]).abs() < 1e-10, "{got:?}");
        }
        for k in 0..bend.len() {
            let got = slope(
                &|s| {
                    let mut moved = bend;
                    moved[k] += s;
                    Shape::from_chord(chord, &moved).unwrap()
                },
                1e-3,
            );
            assert!((got[0] - exact.angle_by_bend[k]).abs() < 1e-10, "{got:?}");
            assert!((got[1] - exact.length_by_bend_m[k]).abs() < 1e-12, "{got:?}");
        }
    }

    #[test]
    fn a_ring_has_none() {
        let ring = Shape::new(vec![0.0, std::f64::consts::TAU], 1.0).unwrap();
        assert!(matches!(ring.chord_sensitivity(), Err(ShapeError::ClosedLoop { .. })));
    }
}
