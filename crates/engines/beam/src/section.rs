//! Rectangular cross-sections.

/// A rectangular cross-section of one linear elastic material.
///
/// Lan, Wang & Chen 2010, section 2.1: in-plane thickness w, out-of-plane thickness t, flexural rigidity E I with I = t w³/12.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Young's modulus E, Pa; positive.
    pub young_pa: f64,
    /// Thickness in the plane of motion, w, m; positive.
    pub thickness_m: f64,
    /// Depth out of the plane, t in the paper, m; positive.
    pub depth_m: f64,
    /// Poisson's ratio ν, in (−1, 0.5]; `None` makes the section rigid in shear.
    pub poisson: Option<f64>,
}

impl Section {
    /// Area A = w t, m².
    pub fn area_m2(&self) -> f64 {
        self.thickness_m * self.depth_m
    }

    /// Bending stiffness E I = E w³ t/12, N·m².
    pub fn bending_stiffness_n_m2(&self) -> f64 {
        self.young_pa * self.thickness_m * self.thickness_m * self.thickness_m * self.depth_m / 12.0
    }

    /// Axial stiffness E A = E w t, N.
    pub fn axial_stiffness_n(&self) -> f64 {
        self.young_pa * self.area_m2()
    }

    /// Shear stiffness κ G A = 5/6 · E/(2(1+ν)) · w t, N; infinite without Poisson's ratio.
    ///
    /// Factor 5/6 of the rectangle: by equal shear energy (`timoshenko-goodier1970`).
    pub fn shear_stiffness_n(&self) -> f64 {
        match self.poisson {
            Some(nu) => 5.0 / 6.0 * self.axial_stiffness_n() / (2.0 * (1.0 + nu)),
            None => f64::INFINITY,
        }
    }

    /// Bending stress at the faces per bending moment, w/(2 I), 1/m³.
    pub fn face_stress_per_moment_per_m3(&self) -> f64 {
        6.0 / (self.depth_m * self.thickness_m * self.thickness_m)
    }

    /// The first quantity out of its range, if any.
    pub(crate) fn fault(&self) -> Option<(&'static str, f64)> {
        let positive = [("Young's modulus", self.young_pa), ("thickness", self.thickness_m), ("depth", self.depth_m)];
        for (what, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Some((what, value));
            }
        }
        if let Some(nu) = self.poisson
            && !(nu > -1.0 && nu <= 0.5)
        {
            return Some(("Poisson's ratio", nu));
        }
        // Products of extreme inputs must not leave the range of f64 later.
        let stiffness = [self.bending_stiffness_n_m2(), self.axial_stiffness_n()];
        for value in stiffness {
            if !(1e-60..=1e60).contains(&value) {
                return Some(("stiffness of the section", value));
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stiffness_of_the_paper_section() {
        // E = 2 GPa, w = 1 mm, t = 10 mm: E I = 2e9·1e-9·0.01/12.
        let s = Section { young_pa: 2e9, thickness_m: 1e-3, depth_m: 1e-2, poisson: Some(0.35) };
        assert!((s.bending_stiffness_n_m2() - 1.0 / 600.0).abs() < 1e-17);
        assert!((s.axial_stiffness_n() - 2e4).abs() < 1e-9);
        assert!((s.shear_stiffness_n() - 2e4 / 3.24).abs() < 1e-9);
        // w/(2 I) = 0.5e-3 / (0.01·1e-9/12).
        assert!((s.face_stress_per_moment_per_m3() - 6e8).abs() < 1e-3);
        assert!(Section { poisson: None, ..s }.shear_stiffness_n().is_infinite());
        assert_eq!(s.fault(), None);
        assert!(Section { poisson: Some(f64::NAN), ..s }.fault().is_some());
        assert!(Section { young_pa: 1e300, thickness_m: 1e10, ..s }.fault().is_some());
        assert!(Section { thickness_m: 1e-200, ..s }.fault().is_some());
    }
}
