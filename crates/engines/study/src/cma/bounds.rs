//! A box as the image of all numbers: within the range everything is as it is; near to an end the way back is a parabola.
//!
//! The transformation of the program `pycma` (N. Hansen and others): the identity but for a margin at either end, where the value goes
//! to the end as a square does to its minimum; beyond it is mirrored, again and again. An optimum at the end of a range is an inner one of
//! the search, and the transformation has no kink.

/// Width of the margin, as part of the range.
const MARGIN: f64 = 0.05;

/// Ends of a coordinate; infinite without one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ends {
    pub(super) lower: f64,
    pub(super) upper: f64,
}

impl Ends {
    /// What is a large change of it.
    pub(super) fn scale(self, about: f64) -> f64 {
        let width = self.upper - self.lower;
        if width.is_finite() {
            width
        } else if about.abs() > 0.0 {
            about.abs()
        } else {
            1.0
        }
    }

    /// The value of a coordinate of the search, which is in the unit of the value.
    pub(super) fn value(self, y: f64, margin: f64) -> f64 {
        let (low, high) = (self.lower - margin, self.upper + margin);
        // Into the stretch between the vertices of the two parabolas.
        let y = match (low.is_finite(), high.is_finite()) {
            (true, true) => {
                let period = 2.0 * (high - low);
                let off = (y - low).rem_euclid(period);
                low + if off > 0.5 * period { period - off } else { off }
            }
            (true, false) => low + (y - low).abs(),
            (false, true) => high - (y - high).abs(),
            (false, false) => y,
        };
        let value = if y < self.lower + margin {
            self.lower + (y - low) * (y - low) / (4.0 * margin)
        } else if y > self.upper - margin {
            self.upper - (high - y) * (high - y) / (4.0 * margin)
        } else {
            y
        };
        value.clamp(self.lower, self.upper)
    }

    /// The coordinate whose value this is.
    pub(super) fn coordinate(self, value: f64, margin: f64) -> f64 {
        let value = value.clamp(self.lower, self.upper);
        if value < self.lower + margin {
            self.lower - margin + 2.0 * (margin * (value - self.lower)).sqrt()
        } else if value > self.upper - margin {
            self.upper + margin - 2.0 * (margin * (self.upper - value)).sqrt()
        } else {
            value
        }
    }
}

/// The coordinates that move: those whose range is more than a point.
#[derive(Clone, Debug)]
pub(super) struct Boxed {
    /// A value for each, moving or not.
    fixed: Vec<f64>,
    moving: Vec<(usize, Ends, f64, f64)>,
}

impl Boxed {
    /// `about` has a value for each coordinate.
    pub(super) fn new(lower: &[f64], upper: &[f64], about: &[f64]) -> Self {
        let all = lower.iter().zip(upper).zip(about).enumerate();
        let moving = all.clone().filter(|(_, ((l, u), _))| u > l).map(|(i, ((l, u), x))| {
            let ends = Ends { lower: *l, upper: *u };
            (i, ends, ends.scale(*x), x.clamp(*l, *u))
        });
        Self { fixed: all.clone().map(|(_, ((l, u), x))| x.clamp(*l, *u)).collect(), moving: moving.collect() }
    }

    /// How many move.
    pub(super) fn len(&self) -> usize {
        self.moving.len()
    }

    /// The values of a point of the search, whose coordinates are parts of the ranges.
    pub(super) fn values(&self, y: &[f64]) -> Vec<f64> {
        let mut x = self.fixed.clone();
        for ((index, ends, scale, about), y) in self.moving.iter().zip(y) {
            let origin = if ends.lower.is_finite() { ends.lower } else { *about };
            x[*index] = ends.value(origin + y * scale, MARGIN * scale);
        }
        x
    }

    /// The point of the search of these values.
    pub(super) fn point(&self, x: &[f64]) -> Vec<f64> {
        let of = |(index, ends, scale, about): &(usize, Ends, f64, f64)| {
            let origin = if ends.lower.is_finite() { ends.lower } else { *about };
            (ends.coordinate(x[*index], MARGIN * scale) - origin) / scale
        };
        self.moving.iter().map(of).collect()
    }

    /// A point from parts of the ranges in [0, 1); without ends, from one scale below to one above.
    pub(super) fn spread(&self, mut part: impl FnMut() -> f64) -> Vec<f64> {
        let mut x = self.fixed.clone();
        for (index, ends, scale, about) in &self.moving {
            let u = part();
            x[*index] = if (ends.upper - ends.lower).is_finite() {
                ends.lower + u * scale
            } else {
                (about + (2.0 * u - 1.0) * scale).clamp(ends.lower, ends.upper)
            };
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every number has a value within the ends, without a jump; values come back as they were.
    #[test]
    fn the_box_is_the_image_of_all_numbers() {
        let infinite = f64::INFINITY;
        for (lower, upper) in [(-1.0, 3.0), (2.0, infinite), (-infinite, -1.0), (-infinite, infinite)] {
            let ends = Ends { lower, upper };
            let mut before = ends.value(-30.0, 0.2);
            for i in 0..=60_000 {
                let y = -30.0 + f64::from(i) * 1e-3;
                let value = ends.value(y, 0.2);
                assert!(value >= lower && value <= upper && (value - before).abs() <= 1e-3 + 1e-12, "{y}: {value} after {before}");
                before = value;
                let back = ends.value(ends.coordinate(value, 0.2), 0.2);
                assert!((back - value).abs() < 1e-12, "{value} comes back as {back}");
            }
        }
        let ends = Ends { lower: -1.0, upper: 3.0 };
        assert!((ends.value(1.234, 0.2) - 1.234).abs() < 4.0 * f64::EPSILON, "inside all is as it is");
        assert!(ends.value(-1.2, 0.2) + 1.0 < 1e-15 && 3.0 - ends.value(3.2, 0.2) < 1e-15, "the ends are reached");
        assert!((ends.value(-1.3, 0.2) - ends.value(-1.1, 0.2)).abs() < 1e-12, "and mirrored");
    }
}
