//! Quantiles of a stream of numbers: exact at first, then by bins whose width follows the range.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "ranks and numbers of bins are whole and below 2^53; places are below 4096"
)]

use forcewright_base::maths::powi;

use super::Fan;

/// Bins of one station, as many as values that are kept before.
const BINS: usize = Fan::EXACT;

/// Values up to `1e150` in size, in any number.
#[derive(Debug, Clone)]
pub(super) enum Quantiles {
    /// The values themselves, in the order in which they came.
    Values(Vec<f64>),
    /// How many values there are in each interval `[k w, (k + 1) w)`.
    Bins(Bins),
}

/// Bin `k` is kept at `k` modulo the number of bins: as never more bins are in use than there are, none is ever moved.
#[derive(Debug, Clone)]
pub(super) struct Bins {
    counts: Vec<u64>,
    /// First and last bin in use.
    first: i64,
    last: i64,
    /// A power of two.
    width: f64,
    /// One over it, as exact.
    per_width: f64,
}

impl Default for Quantiles {
    fn default() -> Self {
        Self::Values(Vec::new())
    }
}

impl Quantiles {
    #[inline]
    pub(super) fn add(&mut self, value: f64) {
        match self {
            Self::Bins(bins) => bins.add(value),
            Self::Values(values) => {
                values.push(value);
                if values.len() > Fan::EXACT {
                    *self = Self::Bins(Bins::of(values));
                }
            }
        }
    }

    /// The value of a rank, from 0, linear between whole ranks. There must be a value.
    pub(super) fn at(&self, rank: f64) -> f64 {
        let part = rank - rank.floor();
        let low = rank.floor() as u64;
        match self {
            Self::Values(values) => {
                let mut values = values.clone();
                if low as usize >= values.len() {
                    return f64::NAN;
                }
                let (_, value, above) = values.select_nth_unstable_by(low as usize, f64::total_cmp);
                let next = above.iter().copied().fold(f64::INFINITY, f64::min);
                between(*value, next, part)
            }
            Self::Bins(bins) => between(bins.value(low), bins.value(low + 1), part),
        }
    }

    /// Width of a bin, 0 while the values are kept.
    pub(super) fn width(&self) -> f64 {
        match self {
            Self::Values(_) => 0.0,
            Self::Bins(bins) => bins.width,
        }
    }
}

/// Exactly `low` where both are equal or the part is 0.
fn between(low: f64, high: f64, part: f64) -> f64 {
    if part > 0.0 { low + part * (high - low) } else { low }
}

impl Bins {
    /// Counts at least one value.
    fn of(values: &[f64]) -> Self {
        let min = values.iter().copied().fold(f64::INFINITY, f64::min);
        let max = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut width = powi(2.0, -500);
        while !fits(min, max, width) {
            width *= 2.0;
        }
        let (first, last) = (number(min, width) as i64, number(max, width) as i64);
        let mut bins = Self { counts: vec![0; BINS], first, last, width, per_width: 1.0 / width };
        for value in values {
            bins.add(*value);
        }
        bins
    }

    #[inline]
    fn add(&mut self, value: f64) {
        // Nearly every value falls between those before.
        let bin = floor(value * self.per_width);
        if self.first <= bin && bin <= self.last {
            self.counts[slot(bin)] += 1;
        } else {
            self.add_outside(value);
        }
    }

    /// The same for a value beyond those before.
    fn add_outside(&mut self, value: f64) {
        while !fits(value.min(self.first as f64 * self.width), value.max(self.last as f64 * self.width), self.width) {
            self.widen();
        }
        let bin = number(value, self.width) as i64;
        (self.first, self.last) = (self.first.min(bin), self.last.max(bin));
        self.counts[slot(bin)] += 1;
    }

    /// Joins bins in pairs: the grid of twice the width has every second border.
    fn widen(&mut self) {
        let mut joined = vec![0; BINS];
        for bin in self.first..=self.last {
            joined[slot(bin.div_euclid(2))] += self.counts[slot(bin)];
        }
        self.counts = joined;
        (self.first, self.last) = (self.first.div_euclid(2), self.last.div_euclid(2));
        self.width *= 2.0;
        self.per_width *= 0.5;
    }

    /// The value of a whole rank, as if the values of a bin were spread evenly over it.
    fn value(&self, rank: u64) -> f64 {
        let mut below = 0;
        for bin in self.first..=self.last {
            let here = self.counts[slot(bin)];
            if rank < below + here {
                return self.width * (bin as f64 + ((rank - below) as f64 + 0.5) / here as f64);
            }
            below += here;
        }
        self.width * (self.last as f64 + 1.0)
    }
}

/// Where a bin is kept.
#[inline]
fn slot(bin: i64) -> usize {
    const { assert!(BINS.is_power_of_two()) };
    bin as usize & (BINS - 1)
}

/// The number of the bin that holds a value: whole.
fn number(value: f64, width: f64) -> f64 {
    (value / width).floor()
}

/// The largest whole number not above a value; the nearest that there is, beyond 2^63.
#[inline]
fn floor(value: f64) -> i64 {
    let towards_zero = value as i64;
    if towards_zero as f64 > value { towards_zero.saturating_sub(1) } else { towards_zero }
}

/// Whether the bins reach from one value to the other, and are not so narrow that their numbers could not be told apart. Wider bins
/// always fit, and what fits for all values does for some: so the width depends on the values only, not on their order.
fn fits(min: f64, max: f64, width: f64) -> bool {
    let (first, last) = (number(min, width), number(max, width));
    first.abs().max(last.abs()) < 4.5e15 && last - first < BINS as f64
}
