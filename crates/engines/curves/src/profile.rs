//! Closed curves of lines, arcs and splines: the boundaries of parts.

use std::fmt;

use crate::bounds::{Bounds, Motion};
use crate::chords;
use crate::piece::Piece;
use crate::spline::Spline;
use crate::vector::{distance, scale};

/// A closed curve. Around material counterclockwise, around a hole clockwise: material lies to the left.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Where the first segment begins and the last one ends, m.
    pub start_m: [f64; 2],
    /// Segments in their order, each from where the one before ends.
    pub segments: Vec<Segment>,
}

/// A piece of a profile, from where the one before ends.
#[derive(Clone, Debug, PartialEq)]
pub enum Segment {
    /// Straight.
    Line {
        /// Its end, m.
        to_m: [f64; 2],
    },
    /// Part of a circle; never the whole circle, which is two arcs.
    Arc {
        /// Its end, m.
        to_m: [f64; 2],
        /// The middle of the circle, m.
        centre_m: [f64; 2],
        /// The direction in which it is passed.
        counterclockwise: bool,
    },
    /// A smooth curve.
    Spline(Spline),
}

impl Segment {
    /// Where it ends, m; not a number if a spline has no control points.
    pub fn end_m(&self) -> [f64; 2] {
        match self {
            Self::Line { to_m } | Self::Arc { to_m, .. } => *to_m,
            Self::Spline(spline) => spline.control_m.last().copied().unwrap_or([f64::NAN; 2]),
        }
    }

    fn pieces(&self, from: [f64; 2]) -> Vec<Piece> {
        match self {
            Self::Line { to_m } => vec![Piece::Line { from, to: *to_m }],
            Self::Arc { to_m, centre_m, counterclockwise } => vec![Piece::arc(from, *to_m, *centre_m, *counterclockwise)],
            Self::Spline(spline) => spline.pieces(from),
        }
    }

    /// The same curve from its end to its start.
    fn reversed(&self, from: [f64; 2]) -> Self {
        match self {
            Self::Line { .. } => Self::Line { to_m: from },
            Self::Arc { centre_m, counterclockwise, .. } => {
                Self::Arc { to_m: from, centre_m: *centre_m, counterclockwise: !counterclockwise }
            }
            Self::Spline(spline) => Self::Spline(spline.reversed()),
        }
    }
}

/// Why a profile is none. Segments count from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProfileError {
    /// There are no segments.
    Empty,
    /// A coordinate is not a finite number, or a spline is not valid ([`Spline::is_valid`]).
    Invalid {
        /// The segment.
        segment: usize,
    },
    /// The ends of an arc are not equally far from its middle, or are the same point.
    Arc {
        /// The segment.
        segment: usize,
        /// The difference of the distances, m.
        difference_m: f64,
    },
    /// A spline does not begin where the segment before ends.
    Gap {
        /// The segment.
        segment: usize,
        /// The distance, m.
        gap_m: f64,
    },
    /// The last segment does not end in the start.
    Open {
        /// The distance, m.
        gap_m: f64,
    },
    /// The curve meets itself.
    Crossing {
        /// The two segments; a segment that turns back on itself is named twice.
        segments: [usize; 2],
        /// Where, m.
        at_m: [f64; 2],
    },
}

impl fmt::Display for ProfileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "the profile has no segments"),
            Self::Invalid { segment } => write!(f, "segment {segment} has no valid numbers"),
            Self::Arc { segment, difference_m } => {
                write!(f, "the ends of arc {segment} differ by {difference_m} m in their distance from its middle, or are one point")
            }
            Self::Gap { segment, gap_m } => write!(f, "segment {segment} begins {gap_m} m from the end of the one before"),
            Self::Open { gap_m } => write!(f, "the profile ends {gap_m} m from its start"),
            Self::Crossing { segments: [a, b], at_m: [x, y] } => write!(f, "segments {a} and {b} meet at ({x}, {y}) m"),
        }
    }
}

impl std::error::Error for ProfileError {}

impl Profile {
    /// A circle of two arcs, counterclockwise.
    pub fn circle(centre_m: [f64; 2], radius_m: f64) -> Self {
        let [x, y] = centre_m;
        let half = |to_m| Segment::Arc { to_m, centre_m, counterclockwise: true };
        Self { start_m: [x + radius_m, y], segments: vec![half([x - radius_m, y]), half([x + radius_m, y])] }
    }

    /// A polygon with its corners in this order.
    pub fn polygon(corners_m: &[[f64; 2]]) -> Self {
        let start_m = corners_m.first().copied().unwrap_or_default();
        let lines = corners_m.iter().skip(1).chain(corners_m.first());
        Self { start_m, segments: lines.map(|to_m| Segment::Line { to_m: *to_m }).collect() }
    }

    /// The area to the left, m²: negative if passed clockwise. Exact: closed form for lines and arcs, Gauss quadrature that is exact for
    /// the quintic under each span of a spline.
    ///
    /// ```
    /// let circle = forcewright_curves::Profile::circle([3.0, 4.0], 2.0);
    /// assert!((circle.area_m2() - 4.0 * std::f64::consts::PI).abs() < 1e-14);
    /// ```
    pub fn area_m2(&self) -> f64 {
        0.5 * self.pieces().map(|(_, piece)| piece.twice_area(self.start_m)).sum::<f64>()
    }

    /// Its length, m; of splines to about 1e-14 of it.
    pub fn length_m(&self) -> f64 {
        self.pieces().map(|(_, piece)| piece.length()).sum()
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Bounds {
        self.pieces().fold(Bounds::of([self.start_m]), |bounds, (_, piece)| bounds.union(piece.bounds()))
    }

    /// The same curve, passed the other way.
    pub fn reversed(&self) -> Self {
        let mut froms = vec![self.start_m];
        froms.extend(self.segments.iter().map(Segment::end_m));
        let segments = self.segments.iter().zip(&froms).rev().map(|(segment, from)| segment.reversed(*from)).collect();
        Self { start_m: froms[froms.len() - 1], segments }
    }

    /// The image under a rigid motion. A mirror image is passed the other way, so that material stays to the left; its segments are then
    /// in reverse order.
    pub fn transformed(&self, motion: &Motion) -> Self {
        let segment = |segment: &Segment| match segment {
            Segment::Line { to_m } => Segment::Line { to_m: motion.apply(*to_m) },
            Segment::Arc { to_m, centre_m, counterclockwise } => Segment::Arc {
                to_m: motion.apply(*to_m),
                centre_m: motion.apply(*centre_m),
                counterclockwise: *counterclockwise != motion.is_mirrored(),
            },
            Segment::Spline(spline) => Segment::Spline(spline.transformed(motion)),
        };
        let image = Self { start_m: motion.apply(self.start_m), segments: self.segments.iter().map(segment).collect() };
        if motion.is_mirrored() { image.reversed() } else { image }
    }

    /// Whether it is a closed curve that does not meet itself.
    ///
    /// It is looked at as chords within `tolerance_m` of it: a crossing less deep than that may be missed, and curves that come closer
    /// than that to each other may be taken to meet.
    ///
    /// # Errors
    /// The first [`ProfileError`] that is found. Ends may be apart, and the ends of an arc unequally far from its middle, by `tolerance_m`.
    pub fn check(&self, tolerance_m: f64) -> Result<(), ProfileError> {
        self.check_segments(tolerance_m)?;
        match chords::first_meeting(std::slice::from_ref(self), tolerance_m) {
            Some(meeting) => Err(ProfileError::Crossing { segments: meeting.segments, at_m: meeting.at_m }),
            None => Ok(()),
        }
    }

    fn check_segments(&self, tolerance_m: f64) -> Result<(), ProfileError> {
        if self.segments.is_empty() {
            return Err(ProfileError::Empty);
        }
        let finite = |point: [f64; 2]| point.iter().all(|x| x.is_finite());
        let mut from = self.start_m;
        for (segment, shape) in self.segments.iter().enumerate() {
            let valid = match shape {
                Segment::Line { to_m } => finite(*to_m),
                Segment::Arc { to_m, centre_m, .. } => finite(*to_m) && finite(*centre_m),
                Segment::Spline(spline) => spline.is_valid(),
            };
            if !valid || !finite(from) {
                return Err(ProfileError::Invalid { segment });
            }
            match shape {
                Segment::Arc { to_m, centre_m, .. } => {
                    let difference_m = (distance(from, *centre_m) - distance(*to_m, *centre_m)).abs();
                    if difference_m > tolerance_m || distance(from, *to_m) <= 0.0 {
                        return Err(ProfileError::Arc { segment, difference_m });
                    }
                }
                Segment::Spline(spline) if spline.gap_from(from) > tolerance_m => {
                    return Err(ProfileError::Gap { segment, gap_m: spline.gap_from(from) });
                }
                _ => {}
            }
            from = shape.end_m();
        }
        let gap_m = distance(from, self.start_m);
        if gap_m > tolerance_m { Err(ProfileError::Open { gap_m }) } else { Ok(()) }
    }

    /// How often it goes round a point, counterclockwise; `None` if the point lies on it (to about 1e-14 of its size).
    pub fn winding(&self, point_m: [f64; 2]) -> Option<i32> {
        let turn = self.pieces().map(|(_, piece)| piece.seen_from(point_m)).sum::<Option<f64>>()?;
        #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
        let rounds = (turn / std::f64::consts::TAU).round() as i32;
        Some(rounds)
    }

    /// Whether a point lies inside or on it, whichever way it is passed.
    pub fn contains(&self, point_m: [f64; 2]) -> bool {
        self.winding(point_m) != Some(0)
    }

    /// Corners of a polygon within a chord error of the curve, without the repeated start. Ends of segments are among them.
    pub fn tessellate(&self, chord_error_m: f64) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        for (_, piece) in self.pieces() {
            let steps = piece.steps(chord_error_m);
            points.extend((0..steps).map(|k| piece.point(k as f64 / steps as f64)));
        }
        points
    }

    /// The smallest distance to another profile and where it is; 0 where they cross. `None` if one has no segments.
    ///
    /// Found between chords, refined on the curves to about 1e-9 of the distance.
    pub fn distance_to(&self, other: &Self) -> Option<Nearest> {
        chords::nearest(self, other)
    }

    /// Smooth pieces with the segment that each belongs to.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = (usize, Piece)> {
        let mut from = self.start_m;
        self.segments.iter().enumerate().flat_map(move |(k, segment)| {
            let pieces = segment.pieces(from);
            from = pieces.last().map_or(from, Piece::to);
            pieces.into_iter().map(move |piece| (k, piece))
        })
    }
}

/// The nearest places of two profiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Their distance, m.
    pub distance_m: f64,
    /// The place on either, m.
    pub at_m: [[f64; 2]; 2],
    /// The segment of either.
    pub segments: [usize; 2],
}

/// The middle between two points.
pub(crate) fn middle(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    scale(crate::vector::add(a, b), 0.5)
}
