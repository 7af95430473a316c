//! Cubic B-splines with clamped ends, by polar forms.
//!
//! A cubic has one symmetric function of three arguments, its polar form, that is linear in each and equals the cubic where the three are
//! equal; control points are its values at three knots in a row (L. Ramshaw, "Blossoming: a connect-the-dots approach to splines", 1987).
//! Points, Bézier forms and the control points of an interpolating spline all come from it.

use crate::bounds::Motion;
use crate::piece::Piece;
use crate::vector::{Vector, mix, norm};

/// A cubic B-spline with clamped ends: it begins in the first control point and ends in the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// Control points, m; at least four.
    pub control_m: Vec<[f64; 2]>,
    /// Knots, not decreasing, four more than control points; the first four are equal, and so are the last four.
    pub knots: Vec<f64>,
}

impl Spline {
    /// Whether the fields are what their documentation says and finite. All else here takes a spline that is not for the straight line to
    /// its last control point.
    #[expect(clippy::float_cmp, reason = "clamped knots are copies")]
    pub fn is_valid(&self) -> bool {
        let (count, knots) = (self.control_m.len(), &self.knots);
        count >= 4
            && knots.len() == count + 4
            && knots.iter().chain(self.control_m.iter().flatten()).all(|x| x.is_finite())
            && knots.windows(2).all(|pair| pair[0] <= pair[1])
            && knots[0] == knots[3]
            && knots[count] == knots[count + 3]
            && knots[3] < knots[count]
            && knots.windows(4).skip(1).take(count - 1).all(|four| four[0] < four[3])
    }

    /// The point at a parameter between the first and the last knot, m; beyond them the end. If not valid the last control point, or not a
    /// number if there is none.
    pub fn point_m(&self, parameter: f64) -> [f64; 2] {
        let count = self.control_m.len();
        if !self.is_valid() || parameter.is_nan() || parameter >= self.knots[count] {
            return self.control_m.last().copied().unwrap_or([f64::NAN; 2]);
        }
        let parameter = parameter.max(self.knots[3]);
        let span = self.knots.partition_point(|knot| *knot <= parameter) - 1;
        self.polar(span, [parameter; 3])
    }

    /// Control points of the Bézier form of each span of knots, m. Empty if not valid.
    pub fn beziers_m(&self) -> Vec<[[f64; 2]; 4]> {
        if !self.is_valid() {
            return Vec::new();
        }
        let spans = (3..self.control_m.len()).filter(|&k| self.knots[k] < self.knots[k + 1]);
        let mut cubics: Vec<[Vector; 4]> = spans
            .map(|span| {
                let (a, b) = (self.knots[span], self.knots[span + 1]);
                [[a, a, a], [a, a, b], [a, b, b], [b, b, b]].map(|arguments| self.polar(span, arguments))
            })
            .collect();
        // Neighbours share their point to the last bit, and the ends are the control points.
        for k in 1..cubics.len() {
            cubics[k][0] = cubics[k - 1][3];
        }
        if let (Some(first), Some(last)) = (self.control_m.first(), self.control_m.last()) {
            let end = cubics.len() - 1;
            cubics[0][0] = *first;
            cubics[end][3] = *last;
        }
        cubics
    }

    /// The same curve, passed the other way.
    pub fn reversed(&self) -> Self {
        let ends = self.knots.first().copied().unwrap_or(0.0) + self.knots.last().copied().unwrap_or(0.0);
        Self { control_m: self.control_m.iter().rev().copied().collect(), knots: self.knots.iter().rev().map(|knot| ends - knot).collect() }
    }

    /// The parts before and after a parameter between the first and the last knot; `None` if not valid, or not between them.
    ///
    /// By knots inserted until the parameter is a threefold one (`boehm1980`): the curve stays.
    pub fn split(&self, parameter: f64) -> Option<[Self; 2]> {
        let count = self.control_m.len();
        if !(self.is_valid() && self.knots[0] < parameter && parameter < self.knots[count]) {
            return None;
        }
        let mut all = self.clone();
        let below = |knots: &[f64]| knots.partition_point(|knot| *knot < parameter);
        while all.knots.partition_point(|knot| *knot <= parameter) - below(&all.knots) < 3 {
            all.insert(parameter);
        }
        let first = below(&all.knots);
        let (mut low, mut high) = (all.knots[..first + 3].to_vec(), all.knots[first..].to_vec());
        low.push(parameter);
        high.insert(0, parameter);
        let [before, after] = [&all.control_m[..first], &all.control_m[first - 1..]].map(<[[f64; 2]]>::to_vec);
        Some([Self { control_m: before, knots: low }, Self { control_m: after, knots: high }])
    }

    /// One more knot.
    fn insert(&mut self, parameter: f64) {
        let span = self.knots.partition_point(|knot| *knot <= parameter) - 1;
        let mut control_m = self.control_m[..=span - 3].to_vec();
        for i in span - 2..=span {
            let share = (parameter - self.knots[i]) / (self.knots[i + 3] - self.knots[i]);
            control_m.push(mix(self.control_m[i - 1], self.control_m[i], share));
        }
        control_m.extend_from_slice(&self.control_m[span..]);
        self.control_m = control_m;
        self.knots.insert(span + 1, parameter);
    }

    pub(crate) fn transformed(&self, motion: &Motion) -> Self {
        Self { control_m: self.control_m.iter().map(|point| motion.apply(*point)).collect(), knots: self.knots.clone() }
    }

    /// The polar form of the cubic on a span of knots (de Boor's recursion with an argument for each step).
    fn polar(&self, span: usize, arguments: [f64; 3]) -> Vector {
        let mut points: [Vector; 4] = std::array::from_fn(|k| self.control_m[span - 3 + k]);
        for (level, argument) in (1..).zip(arguments) {
            for k in (level..4).rev() {
                let (low, high) = (self.knots[span - 3 + k], self.knots[span + 1 + k - level]);
                points[k] = mix(points[k - 1], points[k], (argument - low) / (high - low));
            }
        }
        points[3]
    }

    /// The pieces from a start: cubics, or a line if not valid.
    pub(crate) fn pieces(&self, from: Vector) -> Vec<Piece> {
        let cubics = self.beziers_m();
        if cubics.is_empty() {
            let to = self.control_m.last().copied().unwrap_or(from);
            return vec![Piece::Line { from, to }];
        }
        cubics.into_iter().map(Piece::Cubic).collect()
    }

    /// Largest distance of its first control point from a place: 0 for a spline that begins there.
    pub(crate) fn gap_from(&self, place: Vector) -> f64 {
        self.control_m.first().map_or(0.0, |first| norm(crate::vector::sub(*first, place)))
    }
}
