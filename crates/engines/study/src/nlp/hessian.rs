//! The quasi-Newton approximation of the Hessian of the Lagrangian.
//!
//! Damped BFGS: M. J. D. Powell, "A fast algorithm for nonlinearly constrained optimization calculations", Numerical Analysis
//! (Dundee 1977), Lecture Notes in Mathematics 630, Springer 1978; Nocedal & Wright, "Numerical Optimization", 2nd ed.,
//! procedure 18.2. The first matrix is scaled before its first update as in their eq. (6.20).

/// A symmetric positive definite matrix, row-major.
#[derive(Debug, Clone)]
pub(super) struct Hessian {
    n: usize,
    matrix: Vec<f64>,
    fresh: bool,
    step_image: Vec<f64>,
}

/// Below this part of the predicted curvature the measured one is damped.
const DAMPING: f64 = 0.2;

impl Hessian {
    pub(super) fn identity(n: usize) -> Self {
        let mut hessian = Self { n, matrix: vec![0.0; n * n], fresh: true, step_image: vec![0.0; n] };
        hessian.reset();
        hessian
    }

    pub(super) fn matrix(&self) -> &[f64] {
        &self.matrix
    }

    /// Whether nothing has been learnt since the last reset.
    pub(super) fn is_fresh(&self) -> bool {
        self.fresh
    }

    pub(super) fn reset(&mut self) {
        self.set_diagonal(1.0);
        self.fresh = true;
    }

    fn set_diagonal(&mut self, value: f64) {
        self.matrix.fill(0.0);
        for j in 0..self.n {
            self.matrix[j * self.n + j] = value;
        }
    }

    /// `H·v`.
    pub(super) fn times(&self, v: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.extend(self.matrix.chunks_exact(self.n.max(1)).map(|row| dot(row, v)));
    }

    /// Learns from a step and the change of the gradient of the Lagrangian along it. Returns false if the matrix had degenerated and
    /// was reset.
    pub(super) fn update(&mut self, step: &[f64], change: &[f64]) -> bool {
        let curvature = dot(step, change);
        if self.fresh {
            // Between 1e-4 and 1e4 of the scaled problem; a straight Lagrangian (curvature 0) teaches nothing about its scale.
            let first = dot(change, change) / curvature;
            if curvature > 0.0 && first.is_finite() {
                self.set_diagonal(first.clamp(1e-4, 1e4));
            }
            self.fresh = false;
        }
        let mut image = std::mem::take(&mut self.step_image);
        self.times(step, &mut image);
        let predicted = dot(step, &image);
        let sound = predicted > 0.0 && predicted.is_finite() && curvature.is_finite();
        if sound {
            let theta = if curvature >= DAMPING * predicted { 1.0 } else { (1.0 - DAMPING) * predicted / (predicted - curvature) };
            let damped: Vec<f64> = change.iter().zip(&image).map(|(y, h)| theta * y + (1.0 - theta) * h).collect();
            let damped_curvature = dot(step, &damped);
            for i in 0..self.n {
                for j in 0..=i {
                    let entry = self.matrix[i * self.n + j] - image[i] * image[j] / predicted + damped[i] * damped[j] / damped_curvature;
                    self.matrix[i * self.n + j] = entry;
                    self.matrix[j * self.n + i] = entry;
                }
            }
        }
        self.step_image = image;
        let healthy = sound && (0..self.n).all(|j| (1e-14..1e14).contains(&self.matrix[j * self.n + j]));
        if !healthy {
            self.reset();
        }
        healthy
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After conjugate steps on a quadratic form BFGS has its Hessian: the secant equation holds for all of them.
    #[test]
    fn learns_a_quadratic_form() {
        let form = [[4.0, 1.0], [1.0, 3.0]];
        let image = |s: [f64; 2]| [dot(&form[0], &s), dot(&form[1], &s)];
        let mut hessian = Hessian::identity(2);
        // (1, 0) and (1, −4) are conjugate: (1, 0)·A·(1, −4)ᵀ = 4 − 4.
        for s in [[1.0, 0.0], [1.0, -4.0]] {
            assert!(hessian.update(&s, &image(s)));
        }
        for (got, want) in hessian.matrix().iter().zip([4.0, 1.0, 1.0, 3.0]) {
            assert!((got - want).abs() < 1e-14, "{:?}", hessian.matrix());
        }
    }

    /// Negative curvature is damped: what is learnt along the step is 0.2 of what was predicted (Nocedal & Wright, procedure 18.2).
    #[test]
    fn stays_positive_along_negative_curvature() {
        let mut hessian = Hessian::identity(2);
        hessian.update(&[0.0, 1.0], &[0.0, 1.0]);
        hessian.update(&[1.0, 0.0], &[-7.0, 0.0]);
        for (got, want) in hessian.matrix().iter().zip([0.2, 0.0, 0.0, 1.0]) {
            assert!((got - want).abs() < 1e-14, "{:?}", hessian.matrix());
        }
        assert!(!hessian.update(&[1.0, 0.0], &[f64::NAN, 0.0]) && hessian.is_fresh());
    }
}
