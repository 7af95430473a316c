//! What can be wrong with a model, and how a computation ended.

use std::fmt;

/// Why a description is no mechanism.
#[derive(Debug, Clone, PartialEq)]
pub enum ModelError {
    /// A value is not a finite number.
    NotFinite {
        /// Name of the part.
        part: String,
        /// Which value.
        what: &'static str,
    },
    /// A value is out of its range.
    OutOfRange {
        /// Name of the part.
        part: String,
        /// Which value.
        what: &'static str,
        /// The value.
        value: f64,
        /// The range, in words.
        range: &'static str,
    },
    /// A part refers to a body or contact that the model does not have.
    Unknown {
        /// Name of the part.
        part: String,
    },
    /// A part joins a body to itself.
    SameBody {
        /// Name of the part.
        part: String,
    },
}

impl ModelError {
    pub(crate) fn not_finite(part: &str, what: &'static str) -> Self {
        Self::NotFinite { part: part.to_owned(), what }
    }

    pub(crate) fn out_of_range(part: &str, what: &'static str, value: f64, range: &'static str) -> Self {
        Self::OutOfRange { part: part.to_owned(), what, value, range }
    }
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { part, what } => write!(f, "{part}: {what} is not a finite number"),
            Self::OutOfRange { part, what, value, range } => write!(f, "{part}: {what} is {value}, allowed is {range}"),
            Self::Unknown { part } => write!(f, "{part}: refers to a body or contact that this model does not have"),
            Self::SameBody { part } => write!(f, "{part}: joins a body to itself"),
        }
    }
}

impl std::error::Error for ModelError {}

/// Why the parts could not be put together.
#[derive(Debug, Clone, PartialEq)]
pub enum AssemblyError {
    /// Newton's method came to rest where a constraint is not satisfied: the mechanism cannot be closed near the guess.
    Unsatisfied {
        /// The row that is missed most, relative to the size of the mechanism.
        row: String,
        /// By how much, m or rad.
        by: f64,
        /// Whether the rows depend on each other there (stretched or folded links): the nearest it can get.
        singular: bool,
        /// Coordinates there.
        nearest: Vec<f64>,
    },
    /// A value became infinite or not a number.
    NotFinite {
        /// The first row where.
        row: String,
    },
    /// The guess has the wrong number of coordinates, or a held coordinate does not exist.
    WrongSize,
}

impl fmt::Display for AssemblyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsatisfied { row, by, singular, .. } => {
                let why = if *singular { "; it is stretched or folded there, lengths do not fit" } else { "; try a guess nearer to it" };
                write!(f, "cannot be assembled: \"{row}\" is missed by {by:.3e}{why}")
            }
            Self::NotFinite { row } => write!(f, "cannot be assembled: \"{row}\" is not a finite number"),
            Self::WrongSize => f.write_str("cannot be assembled: the guess or the held coordinates do not belong to this mechanism"),
        }
    }
}

impl std::error::Error for AssemblyError {}

/// How a computation over time ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Stop {
    /// At the end asked for.
    Reached,
    /// At a terminal event.
    Event {
        /// Which of the events asked for.
        index: usize,
    },
    /// The start does not satisfy the constraints and cannot be mended.
    NotAssembled(AssemblyError),
    /// Inverse dynamics needs a driver for every freedom.
    NotDriven {
        /// Freedoms without a driver.
        freedom: usize,
        /// The coordinate that is most free.
        coordinate: String,
    },
    /// A velocity row has no position row to replace it; use [`crate::Kinematics::Baumgarte`].
    NotIntegrable {
        /// The row.
        row: String,
    },
    /// The equations have no unique solution: a dead centre, or a coordinate that nothing holds and that has no mass.
    Singular {
        /// Row or coordinate that depends on the others.
        part: String,
    },
    /// The positions left the constraints and could not be brought back.
    Drift {
        /// The row that is missed most.
        row: String,
    },
    /// The step that the accuracy asks for is too small.
    StepTooSmall,
    /// The number of steps allowed was used up.
    TooManySteps,
    /// A force, motion or state became infinite or not a number.
    NotFinite,
    /// The settings make no sense: times that do not rise, no steps, an accuracy that is not positive, a start of the wrong size.
    Settings,
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reached => f.write_str("reached the end"),
            Self::Event { index } => write!(f, "stopped at event {index}"),
            Self::NotAssembled(error) => error.fmt(f),
            Self::NotDriven { freedom, coordinate } => write!(f, "{freedom} freedoms have no driver; \"{coordinate}\" is the most free"),
            Self::NotIntegrable { row } => write!(f, "\"{row}\" constrains velocities only; integrate the kinematics instead"),
            Self::Singular { part } => write!(f, "singular: \"{part}\" is not determined"),
            Self::Drift { row } => write!(f, "\"{row}\" drifted and could not be restored"),
            Self::StepTooSmall => f.write_str("the step became too small: the motion is not smooth here"),
            Self::TooManySteps => f.write_str("too many steps"),
            Self::NotFinite => f.write_str("a force or state is not a finite number"),
            Self::Settings => f.write_str("times, steps, accuracy or start make no sense"),
        }
    }
}
