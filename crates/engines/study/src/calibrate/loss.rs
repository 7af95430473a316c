//! How much a point that lies far away counts.

/// Losses of a residual `u` in units of the scatter. The constants give 95 % of the efficiency of least squares where the errors are
/// normal (tested): P. J. Huber & E. M. Ronchetti, "Robust Statistics", 2nd ed., Wiley 2009, section 7; A. E. Beaton & J. W. Tukey,
/// Technometrics 16, 147–185, 1974; the soft one is the pseudo-Huber loss, `√(1 + u²/c²)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// Squares: every point counts the same.
    Squares,
    /// Squares near by, straight lines beyond.
    Huber,
    /// The same without a kink in its slope.
    SoftL1,
    /// Far points do not count at all.
    Tukey,
}

impl Loss {
    /// Where it leaves the square, in units of the scatter.
    pub fn tuning(self) -> f64 {
        match self {
            Self::Squares => f64::INFINITY,
            Self::Huber => 1.345,
            Self::SoftL1 => 1.287_1,
            Self::Tukey => 4.685,
        }
    }

    /// The loss, half the square near 0.
    pub fn value(self, u: f64) -> f64 {
        let c = self.tuning();
        match self {
            Self::Squares => 0.5 * u * u,
            Self::Huber if u.abs() <= c => 0.5 * u * u,
            Self::Huber => c * (u.abs() - 0.5 * c),
            Self::SoftL1 => c * c * ((1.0 + u * u / (c * c)).sqrt() - 1.0),
            Self::Tukey => {
                let rest = (1.0 - u * u / (c * c)).max(0.0);
                c * c / 6.0 * (1.0 - rest * rest * rest)
            }
        }
    }

    /// Slope of the loss over u: the weight of a point in the next round of least squares.
    pub fn weight(self, u: f64) -> f64 {
        let c = self.tuning();
        match self {
            Self::Squares => 1.0,
            Self::Huber => (c / u.abs()).min(1.0),
            Self::SoftL1 => 1.0 / (1.0 + u * u / (c * c)).sqrt(),
            Self::Tukey => {
                let rest = (1.0 - u * u / (c * c)).max(0.0);
                rest * rest
            }
        }
    }

    /// Second derivative of the loss.
    pub fn bend(self, u: f64) -> f64 {
        let c = self.tuning();
        let part = u * u / (c * c);
        match self {
            Self::Squares => 1.0,
            Self::Huber => f64::from(u8::from(u.abs() <= c)),
            Self::SoftL1 => 1.0 / ((1.0 + part) * (1.0 + part).sqrt()),
            Self::Tukey if part < 1.0 => (1.0 - part) * (1.0 - 5.0 * part),
            Self::Tukey => 0.0,
        }
    }
}

/// Median of the absolute values of a normal variable: Φ⁻¹(3/4).
const NORMAL_MAD: f64 = 0.674_489_750_196_081_7;

/// Scatter of residuals by their median absolute value, which half of them may be anything for; those that as many parameters make small
/// are left out: J. O. Street, R. J. Carroll & D. Ruppert, The American Statistician 42(2), 152–154, 1988.
pub fn mad(residuals: &[f64], parameters: usize) -> f64 {
    let mut sizes: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let kept = &sizes[parameters.min(sizes.len().saturating_sub(1))..];
    let (low, high) = (kept.get((kept.len().max(1) - 1) / 2), kept.get(kept.len() / 2));
    low.zip(high).map_or(f64::NAN, |(a, b)| f64::midpoint(*a, *b) / NORMAL_MAD)
}

#[cfg(test)]
mod tests {
    use forcewright_base::quadrature::GaussLegendre;

    use super::*;
    use crate::sampling::normal::density;

    const ALL: [Loss; 4] = [Loss::Squares, Loss::Huber, Loss::SoftL1, Loss::Tukey];

    /// Efficiency `(E ψ')²/E ψ²` under the normal distribution, piece by piece between kinks.
    #[test]
    fn constants_give_95_per_cent_of_the_efficiency() {
        let rule = GaussLegendre::new(40);
        let mean = |loss: Loss, f: &dyn Fn(f64) -> f64| -> f64 {
            let ends = [0.0, loss.tuning().min(12.0), 12.0];
            ends.windows(2)
                .map(|e| 2.0 * (e[1] - e[0]) * rule.integrate(|t| f(e[0] + (e[1] - e[0]) * t) * density(e[0] + (e[1] - e[0]) * t)))
                .sum()
        };
        for loss in &ALL[1..] {
            let psi = |u: f64| loss.weight(u) * u;
            let bend = mean(*loss, &|u| loss.bend(u));
            let efficiency = bend * bend / mean(*loss, &|u| psi(u) * psi(u));
            assert!((efficiency - 0.95).abs() < 1e-4, "{loss:?}: {efficiency}");
        }
    }

    #[test]
    fn slopes_are_those_of_the_loss() {
        for loss in ALL {
            for u in [-7.0, -2.0, -1.0, -0.3, 0.4, 1.3, 3.0, 4.6, 9.0] {
                let h = 1e-5;
                let slope = (loss.value(u + h) - loss.value(u - h)) / (2.0 * h);
                assert!((slope - loss.weight(u) * u).abs() < 1e-8, "{loss:?} {u}");
                let bend = (loss.weight(u + h) * (u + h) - loss.weight(u - h) * (u - h)) / (2.0 * h);
                assert!((bend - loss.bend(u)).abs() < 1e-7, "{loss:?} {u}");
            }
        }
    }

    /// The median absolute value of evenly spaced normal quantiles is that of the distribution; far points do not change it much.
    #[test]
    fn scatter_by_the_median() {
        let mut sample: Vec<f64> = (0..999).map(|i| 2.0 * crate::sampling::normal::quantile((f64::from(i) + 0.5) / 999.0)).collect();
        assert!((mad(&sample, 0) / 2.0 - 1.0).abs() < 2e-3);
        sample.iter_mut().step_by(10).for_each(|v| *v = 1e6);
        assert!((mad(&sample, 0) / 2.0 - 1.0).abs() < 0.2);
        assert!(mad(&[], 0).is_nan());
    }
}
