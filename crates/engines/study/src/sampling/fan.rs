//! A fan of curves: statistics of many curves, station by station, in flat memory.

mod quantiles;

use quantiles::Quantiles;

/// Values larger than this have no square: they are not counted as values.
const LARGEST: f64 = 1e150;

/// What is known of the values at one station, all in the unit of the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Curves that had a value here.
    pub count: u64,
    /// Curves that had none (not a number, infinite, or above 1e150 in size).
    pub missing: u64,
    /// Mean of the values; not a number if there is none.
    pub mean: f64,
    /// Standard deviation of the population behind the values (division by `count − 1`); not a number below two values.
    pub sd: f64,
    /// Smallest value; not a number if there is none.
    pub min: f64,
    /// Largest value; not a number if there is none.
    pub max: f64,
}

/// Statistics of many curves that have their values at the same stations.
///
/// Count, mean, standard deviation and extremes are exact to rounding (B. P. Welford, Technometrics 4(3), 419–420, 1962). Quantiles are
/// exact up to [`Fan::EXACT`] curves. Beyond that, the values of a station are kept as counts in bins of equal width, so that memory
/// does not grow: 32 kB per station. The width is the smallest power of two for which 4096 bins reach from the smallest to the largest
/// value, which makes a quantile wrong by at most 1/2047 of the range ([`Fan::quantile_error`]) – a bound, where sketches such as P² or
/// the t-digest have none. As bins are counts on a grid that depends on the values only, quantiles do not depend on the order of the
/// curves; mean and standard deviation do in their last bits, so curves must be added in the order of their samples.
///
/// ```
/// use forcewright_study::sampling::Fan;
///
/// let mut fan = Fan::new(2);
/// for i in 0..=100 {
///     fan.add(&[f64::from(i), 1.0]);
/// }
/// assert_eq!(fan.quantile(0, 0.05), 5.0);
/// assert_eq!((fan.station(0).mean, fan.station(1).sd), (50.0, 0.0));
/// ```
#[derive(Debug, Clone)]
pub struct Fan {
    stations: Vec<Tally>,
    curves: u64,
}

/// Stations that values are added to in turn: as many as hide that each has to wait for its mean.
const BLOCK: usize = 8;

#[derive(Debug, Clone)]
struct Tally {
    count: u64,
    mean: f64,
    /// Sum of the squared distances from the mean.
    squares: f64,
    min: f64,
    max: f64,
    quantiles: Quantiles,
}

impl Fan {
    /// Curves up to which quantiles are exact.
    pub const EXACT: usize = 4096;

    /// Nothing added yet.
    pub fn new(stations: usize) -> Self {
        let empty =
            Tally { count: 0, mean: 0.0, squares: 0.0, min: f64::INFINITY, max: f64::NEG_INFINITY, quantiles: Quantiles::default() };
        Self { stations: vec![empty; stations], curves: 0 }
    }

    /// Adds the next curve. Where it has no value, or is too short, it counts as missing; values beyond the last station are ignored.
    pub fn add(&mut self, curve: &[f64]) {
        self.add_all(&std::iter::once(curve));
    }

    /// Adds the next curves, with the same result as one after the other, but station by station: about four times as fast for a
    /// thousand.
    pub fn add_all<'a>(&mut self, curves: &(impl Iterator<Item = &'a [f64]> + Clone)) {
        self.curves += curves.clone().map(|_| 1).sum::<u64>();
        for (block, tallies) in self.stations.chunks_mut(BLOCK).enumerate() {
            for curve in curves.clone() {
                for (tally, &value) in tallies.iter_mut().zip(curve.get(block * BLOCK..).unwrap_or_default()) {
                    // Written so that NaN fails as well.
                    if value.abs() <= LARGEST {
                        tally.add(value);
                    }
                }
            }
        }
    }

    /// Number of stations.
    pub fn stations(&self) -> usize {
        self.stations.len()
    }

    /// Number of curves added.
    pub fn curves(&self) -> u64 {
        self.curves
    }

    /// What is known at a station; beyond the last one every curve is missing.
    pub fn station(&self, station: usize) -> Station {
        let none = Station { count: 0, missing: self.curves, mean: f64::NAN, sd: f64::NAN, min: f64::NAN, max: f64::NAN };
        match self.stations.get(station) {
            Some(t) if t.count > 0 => Station {
                count: t.count,
                missing: self.curves - t.count,
                mean: t.mean,
                // 0/0 of a single value is no number, as documented.
                sd: (t.squares / (t.count as f64 - 1.0)).sqrt(),
                min: t.min,
                max: t.max,
            },
            _ => none,
        }
    }

    /// The value below which lies the part `p`, in [0, 1], of the values at a station: linear between the ordered values, of which the
    /// first is the quantile of 0 and the last that of 1 (type 7 of R. J. Hyndman, Y. Fan, "Sample quantiles in statistical packages",
    /// The American Statistician 50(4), 361–365, 1996). Not a number without values, or for another `p`.
    pub fn quantile(&self, station: usize, p: f64) -> f64 {
        match self.stations.get(station) {
            Some(t) if t.count > 0 && (0.0..=1.0).contains(&p) => t.quantiles.at((t.count - 1) as f64 * p).clamp(t.min, t.max),
            _ => f64::NAN,
        }
    }

    /// How far a quantile at this station may be from that of the values themselves; 0 as long as it is exact.
    pub fn quantile_error(&self, station: usize) -> f64 {
        self.stations.get(station).map_or(0.0, |t| t.quantiles.width())
    }
}

impl Tally {
    #[inline]
    fn add(&mut self, value: f64) {
        self.count += 1;
        let before = value - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (value - self.mean);
        // Neither is a number without value, and both seldom change.
        if value < self.min {
            self.min = value;
        }
        if value > self.max {
            self.max = value;
        }
        self.quantiles.add(value);
    }
}

#[cfg(test)]
mod tests;
