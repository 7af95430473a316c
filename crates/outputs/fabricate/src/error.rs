//! What keeps a part from being written, and where.

use std::fmt;

use forcewright_model::{CoilError, TurnedError};

use crate::Format;

/// Why no file was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    /// Where it is.
    pub place: Place,
    /// What it is.
    pub problem: Problem,
}

/// A place in what was given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The options.
    Options,
    /// The part as a whole.
    Part,
    /// A boundary.
    Boundary(Boundary),
    /// A segment of a boundary, counted from 0.
    Segment(Boundary, usize),
}

/// A boundary of a part; numbers count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// The outer one.
    Outline,
    /// One of `Plate::cutouts`.
    Cutout(usize),
    /// One of `Plate::holes`.
    Hole(usize),
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// An option out of its range.
    Option {
        /// The field.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The largest allowed.
        largest: f64,
    },
    /// The depth is not between a micrometre and a kilometre.
    Depth {
        /// As given, m.
        depth_m: f64,
    },
    /// The diameter is not between a micrometre and a kilometre.
    Diameter {
        /// As given, m.
        diameter_m: f64,
    },
    /// A coordinate or a knot is infinite or no number.
    NotFinite,
    /// A coordinate is a kilometre or more from the origin, the middle of an arc a thousand, or an arc is longer than ten.
    TooFar,
    /// No segments, or a single one that is no curve.
    TooFewSegments,
    /// A segment ends where it begins, though it is no closed spline.
    NoLength,
    /// The ends of an arc lie at different distances from its middle.
    NotCircular {
        /// The difference, m.
        difference_m: f64,
    },
    /// A spline has fewer than four control points, or not four knots more than control points.
    SplineCounts {
        /// Number of control points.
        control: usize,
        /// Number of knots.
        knots: usize,
    },
    /// Knots of a spline decrease, are more than threefold inside, or not fourfold at the ends.
    SplineKnots,
    /// A spline begins elsewhere than where the segment before ends.
    Apart {
        /// Distance between the two, m.
        gap_m: f64,
    },
    /// The last segment does not end where the first begins.
    NotClosed {
        /// Distance between the two, m.
        gap_m: f64,
    },
    /// The boundary encloses nothing.
    NoArea,
    /// The outline runs clockwise, or a cutout counterclockwise.
    Direction,
    /// The boundary touches or crosses itself.
    MeetsItself,
    /// The boundary touches or crosses this one.
    Meets(Boundary),
    /// A cutout or hole that lies outside the outline or inside of another.
    Misplaced,
    /// Too small for the mesh: fewer than three corners are left after rounding to single precision.
    TooSmall,
    /// No mesh of finite elements can be made.
    Mesh {
        /// Why, in words that follow a colon.
        what: &'static str,
    },
    /// The turned part is none.
    Turned(TurnedError),
    /// The coil is none.
    Coil(CoilError),
    /// The format has no turned or wound parts.
    OnlyPlates {
        /// The format.
        format: Format,
    },
    /// A mesh with more corners than any program wants.
    TooManyCorners {
        /// About how many.
        corners: f64,
        /// The most that are written.
        most: f64,
    },
}

impl fmt::Display for Boundary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Outline => write!(f, "outline"),
            Self::Cutout(index) => write!(f, "cutout {}", index + 1),
            Self::Hole(index) => write!(f, "hole {}", index + 1),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Options => write!(f, "options"),
            Self::Part => write!(f, "part"),
            Self::Boundary(boundary) => write!(f, "{boundary}"),
            Self::Segment(boundary, index) => write!(f, "{boundary}, segment {}", index + 1),
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Option { name, value, largest } => write!(f, "{name} is {value} m, allowed are 1e-9 m to {largest:e} m"),
            Self::Depth { depth_m } => write!(f, "a depth of {depth_m} m cannot be made"),
            Self::Diameter { diameter_m } => write!(f, "a diameter of {diameter_m} m cannot be made"),
            Self::NotFinite => write!(f, "a coordinate or knot is not finite"),
            Self::TooFar => write!(f, "reaches a kilometre or more from the origin"),
            Self::TooFewSegments => write!(f, "too few segments to enclose anything"),
            Self::NoLength => write!(f, "ends where it begins"),
            Self::NotCircular { difference_m } => {
                write!(f, "the ends of the arc are not equally far from its middle: they differ by {difference_m:e} m")
            }
            Self::SplineCounts { control, knots } => {
                write!(
                    f,
                    "a spline of {control} control points and {knots} knots; it needs four points or more, and four knots more than points"
                )
            }
            Self::SplineKnots => write!(f, "knots must not decrease, be fourfold at both ends, and at most threefold between"),
            Self::Apart { gap_m } => write!(f, "begins {gap_m:e} m from where the segment before ends"),
            Self::NotClosed { gap_m } => write!(f, "not closed: its end is {gap_m:e} m from its start"),
            Self::NoArea => write!(f, "encloses no area"),
            Self::Direction => write!(f, "runs the wrong way: the outline must be counterclockwise, cutouts clockwise"),
            Self::MeetsItself => write!(f, "touches or crosses itself"),
            Self::Meets(other) => write!(f, "touches or crosses {other}"),
            Self::Misplaced => write!(f, "lies outside the outline or inside another cutout"),
            Self::TooSmall => write!(f, "too small to be written in single precision"),
            Self::Mesh { what } => write!(f, "no mesh of finite elements: {what}"),
            Self::Turned(error) => write!(f, "{error}"),
            Self::Coil(error) => write!(f, "{error}"),
            Self::OnlyPlates { format } => {
                write!(
                    f,
                    "{format} is for plates only; write a turned or wound part as STEP and let the program of finite elements mesh that"
                )
            }
            Self::TooManyCorners { corners, most } => {
                write!(f, "a mesh of {corners:.0} corners, allowed are {most:.0}; a larger facet_error_m makes fewer, STEP needs none")
            }
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.problem)
    }
}

impl std::error::Error for Error {}
