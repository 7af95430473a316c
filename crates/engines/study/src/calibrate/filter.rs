//! A low-pass filter without delay, for records of a bench.

use std::f64::consts::PI;
use std::fmt;

use forcewright_base::maths::{sin, tan};

/// Butterworth's low-pass filter run forwards and backwards: no phase, and half the amplitude at the cut-off (of one pass, 1/√2).
///
/// S. Butterworth, "On the theory of filter amplifiers", Experimental Wireless 7, 536–541, 1930; sections by the bilinear transform with
/// the cut-off prewarped; ends by odd reflection and the steady state, F. Gustafsson, "Determining the initial states in forward-backward
/// filtering", IEEE Trans. Signal Processing 44(4), 988–992, 1996.
#[derive(Clone, Debug, PartialEq)]
pub struct Filter {
    sections: Vec<Section>,
    pad: usize,
}

/// `y = b₀ x + b₁ x₋₁ + b₂ x₋₂ − a₁ y₋₁ − a₂ y₋₂`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

/// Why there is no filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterError {
    /// The order is not between 1 and 8.
    Order(u32),
    /// The cut-off is not between 0 and half the sampling rate.
    CutOff {
        /// The cut-off over the sampling rate.
        part: f64,
    },
}

impl fmt::Display for FilterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Order(order) => write!(f, "a filter of order {order}: 1 to 8 are possible"),
            Self::CutOff { part } => write!(f, "the cut-off is {part:.3} of the sampling rate; it must be below one half"),
        }
    }
}

impl std::error::Error for FilterError {}

/// Logarithm of what is left of an end, negative.
const FORGOTTEN: f64 = 24.0;
/// The same of what may be left of it where a record is too short for more: its ends are then off by a thousandth of its width.
const NEARLY_FORGOTTEN: f64 = 7.0;
/// Periods of the cut-off that a record has at least: what is slower is no error of it.
const LEAST_PERIODS: f64 = 3.0;

impl Filter {
    /// Of an order from 1 to 8, with a cut-off as a part of the sampling rate, below one half.
    ///
    /// # Errors
    /// [`FilterError`] outside of these.
    pub fn new(order: u32, part: f64) -> Result<Self, FilterError> {
        if !(1..=8).contains(&order) {
            return Err(FilterError::Order(order));
        }
        if !(part > 0.0 && part < 0.5) {
            return Err(FilterError::CutOff { part });
        }
        let w = tan(PI * part);
        let mut sections: Vec<Section> = (0..order / 2)
            .map(|k| {
                // 1/(s² + 2 s sin θ + 1) of the pair of poles, with s = (1/w)(1 − z⁻¹)/(1 + z⁻¹).
                let damping = 2.0 * sin(PI * f64::from(2 * k + 1) / f64::from(2 * order));
                let whole = 1.0 + damping * w + w * w;
                let b = w * w / whole;
                Section { b: [b, 2.0 * b, b], a: [2.0 * (w * w - 1.0) / whole, (1.0 - damping * w + w * w) / whole] }
            })
            .collect();
        if order % 2 == 1 {
            let b = w / (1.0 + w);
            sections.push(Section { b: [b, b, 0.0], a: [(w - 1.0) / (1.0 + w), 0.0] });
        }
        // The slowest pole forgets an end to the last digits within so many rows.
        let rate = forgetting(order, part);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, and cut off at a million")]
        let pad = (FORGOTTEN / rate).min(1e6).ceil() as usize;
        Ok(Self { sections, pad })
    }

    /// The least cut-off of an order for a record of so many rows, as a part of the sampling rate: below it, what the ends do not know of the
    /// time before and after moves the whole record. 0.5 and more where no cut-off will do.
    pub fn least(order: u32, rows: usize) -> f64 {
        LEAST_PERIODS.max(NEARLY_FORGOTTEN / forgetting(order, 1.0)) / rows.max(1) as f64
    }

    /// The record without what is faster.
    pub fn run(&self, record: &[f64]) -> Vec<f64> {
        let n = record.len();
        let (Some(first), Some(last)) = (record.first(), record.last()) else { return Vec::new() };
        let pad = self.pad.min(n - 1);
        let head = (1..=pad).rev().map(|i| 2.0 * first - record[i]);
        let tail = (1..=pad).map(|i| 2.0 * last - record[n - 1 - i]);
        let mut all: Vec<f64> = head.chain(record.iter().copied()).chain(tail).collect();
        for _ in 0..2 {
            self.sections.iter().for_each(|s| s.pass(&mut all));
            all.reverse();
        }
        all[pad..pad + n].to_vec()
    }
}

/// By what part, logarithmic, the slowest pole forgets from row to row.
fn forgetting(order: u32, part: f64) -> f64 {
    2.0 * PI * part * sin(PI / f64::from(2 * order))
}

impl Section {
    /// One pass, from the steady state of the first value; the gain at rest is 1.
    fn pass(&self, all: &mut [f64]) {
        let Some(first) = all.first().copied() else { return };
        let ([mut x1, mut x2], [mut y1, mut y2]) = ([first; 2], [first; 2]);
        for value in all {
            let x = *value;
            let y = self.b[0] * x + self.b[1] * x1 + self.b[2] * x2 - self.a[0] * y1 - self.a[1] * y2;
            (x2, x1, y2, y1) = (x1, x, y1, y);
            *value = y;
        }
    }
}

#[cfg(test)]
mod tests {
    use forcewright_base::maths::{cos, powf};

    use super::*;

    /// A wave in the middle of a long record keeps its phase, and its amplitude is the square of Butterworth's `1/√(1 + (tan/tan)^2n)`.
    #[test]
    fn amplitudes_are_butterworths_and_phases_are_kept() {
        for order in 1..=8 {
            for (cut, part) in [(0.1, 0.02), (0.1, 0.1), (0.1, 0.2), (0.3, 0.1), (0.02, 0.05)] {
                let n = 6001_u32;
                let wave: Vec<f64> = (0..n).map(|i| cos(2.0 * PI * part * (f64::from(i) - 3000.0))).collect();
                let found = Filter::new(order, cut).unwrap().run(&wave);
                let want = 1.0 / (1.0 + powf(tan(PI * part) / tan(PI * cut), 2.0 * f64::from(order)));
                for i in 2990..3010 {
                    assert!((found[i] - want * wave[i]).abs() < 1e-9, "{order} {cut} {part}: {} {}", found[i], want * wave[i]);
                }
            }
        }
    }

    /// A straight line goes through unchanged to both ends, and so does a record turned round.
    #[test]
    fn lines_stay_and_time_has_no_direction() {
        let filter = Filter::new(4, 0.05).unwrap();
        let line: Vec<f64> = (0..300).map(|i| 3.0 - 0.02 * f64::from(i)).collect();
        let bent: Vec<f64> = line.iter().map(|v| v + sin(v * 7.0)).collect();
        assert!(filter.run(&line).iter().zip(&line).all(|(a, b)| (a - b).abs() < 1e-9));
        let mut turned: Vec<f64> = bent.iter().rev().copied().collect();
        turned = filter.run(&turned);
        turned.reverse();
        assert!(filter.run(&bent).iter().zip(&turned).skip(100).take(100).all(|(a, b)| (a - b).abs() < 1e-4));
        assert!(filter.run(&[]).is_empty() && (filter.run(&[2.0])[0] - 2.0).abs() < 1e-12);
    }

    /// With the least cut-off a ramp stays where it is to a thousandth of its width, and so do its ends after a wave was taken away; with a
    /// tenth of it, it leaves the record.
    #[test]
    fn from_the_least_cut_off_on_a_record_stays_where_it_is() {
        for order in 1..=8 {
            for rows in [40_u32, 200, 1000] {
                let least = Filter::least(order, rows as usize);
                let ramp: Vec<f64> = (0..rows).map(|i| f64::from(i) / f64::from(rows - 1)).collect();
                let off = |part: f64| {
                    let found = Filter::new(order, part).unwrap().run(&ramp);
                    found.iter().zip(&ramp).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
                };
                assert!(least < 0.5 && off(least) < 2e-3, "{order} {rows}: {least} {}", off(least));
                assert!(order == 1 || off(0.1 * least) > 0.05, "{order} {rows}: {}", off(0.1 * least));
            }
        }
    }

    #[test]
    fn what_is_no_filter() {
        assert_eq!(Filter::new(0, 0.1), Err(FilterError::Order(0)));
        assert_eq!(Filter::new(2, 0.5), Err(FilterError::CutOff { part: 0.5 }));
        assert!(Filter::new(2, f64::NAN).is_err());
    }
}
