//! The Sobol sequence with random access, plain or scrambled.

use std::fmt;
use std::sync::Arc;

use super::joe_kuo::JOE_KUO;
use super::scramble::{Scramble, mixed};

/// Binary digits of an index and columns of a generator matrix.
const DIGITS: usize = 52;

/// Why there is no such sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SobolError {
    /// More dimensions than there are direction numbers for.
    TooManyDimensions {
        /// How many were asked for.
        dimensions: usize,
    },
}

impl fmt::Display for SobolError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooManyDimensions { dimensions } => {
                write!(f, "{dimensions} dimensions asked for; direction numbers are there for {}", Sobol::MAX_DIMENSIONS)
            }
        }
    }
}

impl std::error::Error for SobolError {}

/// A Sobol sequence in `[0, 1)^d`: any `2^k` points that begin at a multiple of `2^k` fill the cube evenly.
///
/// I. M. Sobol', "On the distribution of points in a cube and the approximate evaluation of integrals", USSR Computational Mathematics
/// and Mathematical Physics 7(4), 86–112, 1967; direction numbers of Joe & Kuo 2008 (`new-joe-kuo-6`); in the order of I. A. Antonov
/// and V. M. Saleev 1979 (Gray code), in which it is commonly published. Every point is a function of its index alone, so that points
/// can be computed in any order, on any number of threads, and a study can go on where it stopped.
///
/// A scrambled sequence has the same evenness, each point by itself is uniformly distributed, and means over `n` points have no bias:
/// for smooth functions their standard deviation falls nearly as `n^(−3/2)` (A. B. Owen, "Scrambled net variance for integrals of
/// smooth functions", Annals of Statistics 25(4), 1541–1562, 1997), for none is it much above that of plain Monte Carlo (Owen,
/// "Scrambling Sobol' and Niederreiter–Xing points", Journal of Complexity 14(4), 466–489, 1998). Use powers of two.
///
/// ```
/// use forcewright_study::sampling::Sobol;
///
/// // ∫ (3x²)(3y²) over the unit square is 1.
/// let sobol = Sobol::scrambled(2, 1)?;
/// let mut point = [0.0; 2];
/// let mut sum = 0.0;
/// for i in 0..4096 {
///     sobol.point(i, &mut point);
///     sum += 9.0 * point[0] * point[0] * point[1] * point[1];
/// }
/// assert!((sum / 4096.0 - 1.0).abs() < 2e-5);
/// # Ok::<(), forcewright_study::sampling::SobolError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Sobol {
    /// Of each dimension the columns of its generator matrix, first digit in bit 63.
    columns: Arc<[[u64; DIGITS]]>,
    /// One per dimension; none for the plain sequence.
    scrambles: Vec<Scramble>,
}

impl Sobol {
    /// Dimensions for which there are direction numbers.
    pub const MAX_DIMENSIONS: usize = JOE_KUO.len() + 1;

    /// Points in the sequence; from there on it repeats.
    pub const MAX_POINTS: u64 = 1 << DIGITS;

    /// The sequence as published. Its first point is the origin, where no quantile of an unbounded distribution is finite.
    ///
    /// # Errors
    /// More than [`Self::MAX_DIMENSIONS`].
    pub fn plain(dimensions: usize) -> Result<Self, SobolError> {
        if dimensions > Self::MAX_DIMENSIONS {
            return Err(SobolError::TooManyDimensions { dimensions });
        }
        Ok(Self { columns: (0..dimensions).map(generator_matrix).collect(), scrambles: Vec::new() })
    }

    /// The sequence after Owen's nested uniform scrambling, in the open cube `(0, 1)^d`. The seed decides all.
    ///
    /// # Errors
    /// More than [`Self::MAX_DIMENSIONS`].
    pub fn scrambled(dimensions: usize, seed: u64) -> Result<Self, SobolError> {
        Self::plain(dimensions).map(|plain| plain.with_scramble(seed))
    }

    /// The same sequence, scrambled anew; shares the tables.
    pub fn with_scramble(&self, seed: u64) -> Self {
        let scrambles = (0..self.dimensions() as u64).map(|dimension| Scramble::new(seed, dimension)).collect();
        Self { columns: Arc::clone(&self.columns), scrambles }
    }

    /// Coordinates of a point.
    pub fn dimensions(&self) -> usize {
        self.columns.len()
    }

    /// Writes the point of an index (modulo [`Self::MAX_POINTS`]). Coordinates beyond the dimensions are left as they are, and a
    /// shorter slice gets the first coordinates.
    pub fn point(&self, index: u64, out: &mut [f64]) {
        let index = index % Self::MAX_POINTS;
        let gray = index ^ index >> 1;
        for (dimension, (columns, out)) in self.columns.iter().zip(out).enumerate() {
            let (mut fraction, mut left) = (0, gray);
            while left != 0 {
                fraction ^= columns[left.trailing_zeros() as usize];
                left &= left - 1;
            }
            *out = match self.scrambles.get(dimension) {
                None => (fraction >> 11) as f64 * UNIT,
                Some(scramble) => middle_of_cell(scramble.apply(fraction)),
            };
        }
    }

    /// Writes the points `first`, `first + 1`, … as the rows of `out`, as many as fit.
    pub fn fill(&self, first: u64, out: &mut [f64]) {
        if self.dimensions() > 0 {
            for (i, row) in out.chunks_exact_mut(self.dimensions()).enumerate() {
                self.point(first.wrapping_add(i as u64), row);
            }
        }
    }
}

/// 2⁻⁵³.
const UNIT: f64 = 0.5 * f64::EPSILON;

/// The middle of the cell of width 2⁻⁵² in which the fraction lies: exact, and never 0 or 1.
fn middle_of_cell(fraction: u64) -> f64 {
    (fraction >> 12 << 1 | 1) as f64 * UNIT
}

/// Columns `v₁ … v₅₂` of a dimension: `v_k = m_k / 2^k`, by the recurrence of Joe & Kuo 2008 on whole columns.
fn generator_matrix(dimension: usize) -> [u64; DIGITS] {
    let mut columns = [0; DIGITS];
    let Some(before) = dimension.checked_sub(1) else {
        for (k, column) in columns.iter_mut().enumerate() {
            *column = 1 << (63 - k);
        }
        return columns;
    };
    let (polynomial, initial) = JOE_KUO[before];
    let degree = initial.len();
    for k in 0..DIGITS {
        columns[k] = if let Some(m) = initial.get(k) {
            u64::from(*m) << (63 - k)
        } else {
            let last = columns[k - degree];
            let middle = (1..degree).filter(|i| polynomial >> (degree - i) & 1 == 1);
            middle.fold(last ^ last >> degree, |sum, i| sum ^ columns[k - i])
        };
    }
    columns
}

/// Several independent scrambles of the same number of Sobol points: their scatter measures the error of what is computed from them.
///
/// Sample `i` is point `i / replicates` of replicate `i % replicates`, so a study may stop after any multiple of the replicates,
/// or go on with more points later: samples that were there before do not change.
///
/// ```
/// let replicates = forcewright_study::sampling::Replicates::new(2, 8, 42)?;
/// let mut rows = [0.0; 2 * 8];
/// replicates.fill(0, &mut rows);
/// assert!(rows.iter().all(|u| 0.0 < *u && *u < 1.0));
/// assert_eq!(replicates.replicate_of(11), 3);
/// # Ok::<(), forcewright_study::sampling::SobolError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Replicates {
    sequences: Vec<Sobol>,
}

impl Replicates {
    /// Scrambles a sequence as often as asked (at least once), each time with a seed of its own derived from `seed`.
    ///
    /// # Errors
    /// More than [`Sobol::MAX_DIMENSIONS`].
    pub fn new(dimensions: usize, replicates: usize, seed: u64) -> Result<Self, SobolError> {
        let plain = Sobol::plain(dimensions)?;
        let seed_of = |replicate: usize| mixed(mixed(seed) ^ replicate as u64);
        Ok(Self { sequences: (0..replicates.max(1)).map(|replicate| plain.with_scramble(seed_of(replicate))).collect() })
    }

    /// How many scrambles there are.
    pub fn count(&self) -> usize {
        self.sequences.len()
    }

    /// Coordinates of a sample.
    pub fn dimensions(&self) -> usize {
        self.sequences.first().map_or(0, Sobol::dimensions)
    }

    /// The replicate to which a sample belongs.
    #[allow(clippy::cast_possible_truncation, reason = "less than the number of replicates")]
    pub fn replicate_of(&self, sample: u64) -> usize {
        (sample % self.sequences.len() as u64) as usize
    }

    /// Writes one sample.
    pub fn sample(&self, sample: u64, out: &mut [f64]) {
        self.sequences[self.replicate_of(sample)].point(sample / self.sequences.len() as u64, out);
    }

    /// Writes the samples `first`, `first + 1`, … as the rows of `out`, as many as fit.
    pub fn fill(&self, first: u64, out: &mut [f64]) {
        if self.dimensions() > 0 {
            for (i, row) in out.chunks_exact_mut(self.dimensions()).enumerate() {
                self.sample(first.wrapping_add(i as u64), row);
            }
        }
    }
}

#[cfg(test)]
mod tests;
