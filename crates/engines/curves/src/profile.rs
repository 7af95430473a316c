//! Closed curves of lines, arcs and splines: the boundaries of parts.

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

/// A cubic B-spline with clamped ends: it begins in the first control point and ends in the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// Control points, m; at least four.
    pub control_m: Vec<[f64; 2]>,
    /// Knots, not decreasing, four more than control points; the first four are equal, and so are the last four.
    pub knots: Vec<f64>,
}

impl Segment {
    /// Where it ends, m.
    ///
    /// # Panics
    /// If a spline has no control points.
    pub fn end_m(&self) -> [f64; 2] {
        match self {
            Self::Line { to_m } | Self::Arc { to_m, .. } => *to_m,
            Self::Spline(spline) => spline.control_m[spline.control_m.len() - 1],
        }
    }
}
