//! How one number scatters.

use std::fmt;

use forcewright_base::quadrature::GaussLegendre;

use super::normal;
use forcewright_base::maths::exp;

/// Standard deviations from the middle of a tolerance zone to its ends, for a normal distribution.
pub const SIGMAS_IN_TOLERANCE: f64 = 3.0;

/// The form that a tolerance zone is given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Normal about the middle of the zone, whose ends are three standard deviations away: 0.27 % lie outside. For a controlled process.
    Normal,
    /// The same, but what lies outside has been sorted out.
    TruncatedNormal,
    /// Anything in the zone is as likely as anything else: the cautious choice if only the zone is known.
    Uniform,
    /// Rising linearly from the ends to the middle of the zone.
    Triangular,
}

/// Why numbers make no distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DistributionError {
    /// A parameter is infinite or not a number.
    NotFinite,
    /// A standard deviation or tolerance below zero.
    Negative {
        /// The value.
        width: f64,
    },
    /// The lower end is above the upper one, or the mode outside of both.
    Order {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// Practically nothing of the normal distribution lies between the ends.
    Empty {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
}

impl fmt::Display for DistributionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => write!(f, "a parameter of the distribution is infinite or not a number"),
            Self::Negative { width } => write!(f, "a standard deviation or tolerance cannot be negative, but is {width}"),
            Self::Order { low, high } => write!(f, "the ends {low} and {high} or the mode between them are out of order"),
            Self::Empty { low, high } => write!(f, "the normal distribution has nothing between {low} and {high}"),
        }
    }
}

impl std::error::Error for DistributionError {}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Normal,
    /// Bounds in standard deviations of the normal distribution from its middle.
    Truncated {
        middle: f64,
        sigma: f64,
        low: f64,
        high: f64,
    },
    Uniform {
        low: f64,
        high: f64,
    },
    Triangular {
        low: f64,
        mode: f64,
        high: f64,
    },
}

/// The distribution of one parameter, in the unit of the parameter. A width of zero is allowed: a constant.
///
/// ```
/// use forcewright_study::sampling::{Distribution, Form};
///
/// // A shaft of 17.6 mm h7, deviations 0 and −0.018 mm: centred in the zone, not on the nominal size.
/// let shaft = Distribution::from_deviations(17.6, -0.018, 0.0, Form::Normal)?;
/// assert!((shaft.mean() - 17.591).abs() < 1e-12 && (shaft.sd() - 0.003).abs() < 1e-12);
/// # Ok::<(), forcewright_study::sampling::DistributionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distribution {
    shape: Shape,
    mean: f64,
    sd: f64,
}

impl Distribution {
    /// Normal, by mean and standard deviation.
    ///
    /// # Errors
    /// Not finite, or a negative deviation.
    pub fn normal(mean: f64, sd: f64) -> Result<Self, DistributionError> {
        check_finite(&[mean, sd])?;
        check_width(sd)?;
        Ok(Self { shape: Shape::Normal, mean, sd })
    }

    /// Normal with the given mean and standard deviation *before* everything outside `[low, high]` was sorted out.
    ///
    /// # Errors
    /// Not finite, a negative deviation, ends out of order, or (practically) nothing between the ends.
    pub fn truncated_normal(middle: f64, sigma: f64, low: f64, high: f64) -> Result<Self, DistributionError> {
        check_finite(&[middle, sigma, low, high])?;
        check_width(sigma)?;
        check_order(low, high)?;
        let inside = (low..=high).contains(&middle);
        if sigma == 0.0 && inside {
            return Self::normal(middle, 0.0);
        }
        let (a, b) = ((low - middle) / sigma, (high - middle) / sigma);
        // The second condition refuses tails whose probability underflows or whose width is lost in rounding.
        if sigma == 0.0 || normal::between(a, b) < f64::MIN_POSITIVE {
            return Err(DistributionError::Empty { low, high });
        }
        let (shift, spread) = truncated_moments(a, b);
        let shape = Shape::Truncated { middle, sigma, low: a, high: b };
        Ok(Self { shape, mean: middle + sigma * shift, sd: sigma * spread })
    }

    /// Uniform between two ends.
    ///
    /// # Errors
    /// Not finite, or ends out of order.
    pub fn uniform(low: f64, high: f64) -> Result<Self, DistributionError> {
        check_finite(&[low, high])?;
        check_order(low, high)?;
        Ok(Self { shape: Shape::Uniform { low, high }, mean: low + 0.5 * (high - low), sd: (high - low) / 12.0_f64.sqrt() })
    }

    /// Triangular: from `low` up to the most frequent value, `mode`, and down to `high`.
    ///
    /// # Errors
    /// Not finite, or out of order.
    pub fn triangular(low: f64, mode: f64, high: f64) -> Result<Self, DistributionError> {
        check_finite(&[low, mode, high])?;
        if !(low <= mode && mode <= high) {
            return Err(DistributionError::Order { low, high });
        }
        let (left, right) = (mode - low, high - mode);
        // The variance (l² + m² + h² − lm − lh − mh) / 18, in differences.
        let sd = ((left * left + left * right + right * right) / 18.0).sqrt();
        Ok(Self { shape: Shape::Triangular { low, mode, high }, mean: mode + (right - left) / 3.0, sd })
    }

    /// From a nominal value and a tolerance `±`: the half width of the zone, three standard deviations of a normal distribution.
    ///
    /// # Errors
    /// Not finite, or a negative tolerance.
    pub fn from_tolerance(nominal: f64, plus_minus: f64, form: Form) -> Result<Self, DistributionError> {
        check_width(plus_minus)?;
        Self::from_deviations(nominal, -plus_minus, plus_minus, form)
    }

    /// From a nominal value and the lower and upper deviation from it, as an ISO 286 fit gives them. Every form is centred in the zone:
    /// the nominal size of an asymmetric zone may lie at its end or outside.
    ///
    /// # Errors
    /// Not finite, or deviations out of order.
    pub fn from_deviations(nominal: f64, lower: f64, upper: f64, form: Form) -> Result<Self, DistributionError> {
        check_finite(&[nominal, lower, upper])?;
        check_order(lower, upper)?;
        let middle = nominal + (lower + 0.5 * (upper - lower));
        let half = 0.5 * (upper - lower);
        let sigma = half / SIGMAS_IN_TOLERANCE;
        match form {
            Form::Normal => Self::normal(middle, sigma),
            Form::TruncatedNormal => Self::truncated_normal(middle, sigma, middle - half, middle + half),
            Form::Uniform => Self::uniform(middle - half, middle + half),
            Form::Triangular => Self::triangular(middle - half, middle, middle + half),
        }
    }

    /// Expected value.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation.
    pub fn sd(&self) -> f64 {
        self.sd
    }

    /// Half the width of the zone of tolerance: of a bounded distribution half the distance of its ends, of a normal one
    /// [`SIGMAS_IN_TOLERANCE`] standard deviations.
    pub fn half_width(&self) -> f64 {
        match self.shape {
            Shape::Normal => SIGMAS_IN_TOLERANCE * self.sd,
            Shape::Truncated { sigma, low, high, .. } => 0.5 * sigma * (high - low),
            Shape::Uniform { low, high } | Shape::Triangular { low, high, .. } => 0.5 * (high - low),
        }
    }

    /// Whether this is a normal distribution (a constant counts as one).
    pub(super) fn is_normal(&self) -> bool {
        self.shape == Shape::Normal
    }

    /// The value below which lies the probability `p`; the ends at 0 and 1, not a number outside [0, 1].
    ///
    /// ```
    /// use forcewright_study::sampling::{Distribution, Form};
    ///
    /// // A ± tolerance is three standard deviations: Φ(−3) = 0.13499 % lie below the zone.
    /// let beam_mm = Distribution::from_tolerance(0.85, 0.02, Form::Normal)?;
    /// assert!((beam_mm.quantile(0.001_349_898) - 0.83).abs() < 1e-10);
    /// # Ok::<(), forcewright_study::sampling::DistributionError>(())
    /// ```
    pub fn quantile(&self, p: f64) -> f64 {
        self.at(p, normal::quantile(p))
    }

    /// The value at the standard normal score `z`, `quantile(Φ(z))` without the detour for normal distributions.
    pub(super) fn at_score(&self, z: f64) -> f64 {
        self.at(normal::cdf(z), z)
    }

    fn at(&self, p: f64, z: f64) -> f64 {
        if !(0.0..=1.0).contains(&p) {
            return f64::NAN;
        }
        match self.shape {
            // Zero times an infinite score is no number, but a constant is one.
            Shape::Normal if self.sd == 0.0 => self.mean,
            Shape::Normal => self.mean + self.sd * z,
            Shape::Truncated { middle, sigma, low, high } => middle + sigma * truncated_quantile(low, high, p),
            Shape::Uniform { low, high } => (low + p * (high - low)).min(high),
            Shape::Triangular { low, mode, high } => {
                let (left, width) = (mode - low, high - low);
                if p * width <= left { low + (p * width * left).sqrt() } else { high - ((1.0 - p) * width * (high - mode)).sqrt() }
            }
        }
    }

    /// Probability of a value up to `x`.
    pub fn cdf(&self, x: f64) -> f64 {
        let step = |at: f64| if x < at { 0.0 } else { 1.0 };
        match self.shape {
            _ if x.is_nan() => f64::NAN,
            _ if self.sd == 0.0 => step(self.mean),
            Shape::Normal => normal::cdf((x - self.mean) / self.sd),
            Shape::Truncated { middle, sigma, low, high } => {
                let z = ((x - middle) / sigma).clamp(low, high);
                normal::between(low, z) / normal::between(low, high)
            }
            Shape::Uniform { low, high } => ((x - low) / (high - low)).clamp(0.0, 1.0),
            Shape::Triangular { low, mode, high } => {
                let (x, width) = (x.clamp(low, high), high - low);
                if x < mode {
                    (x - low) * (x - low) / (width * (mode - low))
                } else if x < high {
                    1.0 - (high - x) * (high - x) / (width * (high - mode))
                } else {
                    1.0
                }
            }
        }
    }
}

fn check_finite(values: &[f64]) -> Result<(), DistributionError> {
    if values.iter().all(|v| v.is_finite()) { Ok(()) } else { Err(DistributionError::NotFinite) }
}

fn check_width(width: f64) -> Result<(), DistributionError> {
    if width < 0.0 { Err(DistributionError::Negative { width }) } else { Ok(()) }
}

fn check_order(low: f64, high: f64) -> Result<(), DistributionError> {
    if low <= high { Ok(()) } else { Err(DistributionError::Order { low, high }) }
}

/// Quantile of the standard normal distribution between two bounds; counted from the side on which fewer digits are lost.
fn truncated_quantile(low: f64, high: f64, p: f64) -> f64 {
    let mass = normal::between(low, high);
    let from_above = low > 0.0 || (high > 0.0 && p > 0.5);
    let z =
        if from_above { -normal::quantile(normal::cdf(-high) + (1.0 - p) * mass) } else { normal::quantile(normal::cdf(low) + p * mass) };
    z.clamp(low, high)
}

/// Mean and standard deviation of the standard normal distribution between two bounds.
///
/// N. L. Johnson, S. Kotz, N. Balakrishnan, "Continuous Univariate Distributions", vol. 1, chapter 13. Between close bounds the
/// closed form cancels, and a Gauss rule is exact to rounding.
fn truncated_moments(low: f64, high: f64) -> (f64, f64) {
    if high - low < 0.5 {
        let rule = GaussLegendre::new(24);
        let (middle, width) = (0.5 * (low + high), high - low);
        // Relative to the density in the middle, which then need not be representable.
        let weight = |t: f64| exp(-0.5 * t * (t + 2.0 * middle));
        let moment = |power: fn(f64, f64) -> f64, about: f64| {
            rule.integrate(|u| {
                let t = (u - 0.5) * width;
                power(t, about) * weight(t)
            })
        };
        let mass = moment(|_, _| 1.0, 0.0);
        let mean = moment(|t, _| t, 0.0) / mass;
        return (middle + mean, (moment(|t, about| (t - about) * (t - about), mean) / mass).sqrt());
    }
    let mass = normal::between(low, high);
    let (at_low, at_high) = (normal::density(low) / mass, normal::density(high) / mass);
    let shift = at_low - at_high;
    (shift, (1.0 + low * at_low - high * at_high - shift * shift).max(0.0).sqrt())
}

#[cfg(test)]
mod tests;
