//! What can be wrong with a network, and how a path can end.

use std::fmt;

use crate::shape::ShapeError;

/// Why a network cannot be analysed at all. Indices count from 0 in the order of the input.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum NetworkError {
    /// There are no beams.
    NoBeams,
    /// More nodes or beams than [`crate::Network::LARGEST`].
    TooLarge {
        /// How many there are.
        count: usize,
    },
    /// A beam names a node that does not exist.
    NodeOutOfRange {
        /// The beam.
        beam: usize,
        /// The node it names.
        node: usize,
    },
    /// The drive names a node that does not exist.
    DriveOutOfRange {
        /// The node it names.
        node: usize,
    },
    /// A beam starts and ends at the same node.
    BeamOnOneNode {
        /// The beam.
        beam: usize,
    },
    /// No beam ends at a node.
    LooseNode {
        /// The node.
        node: usize,
    },
    /// A coordinate of a node is not a finite number.
    Position {
        /// The node.
        node: usize,
    },
    /// A direction is zero or not finite.
    Direction {
        /// The node with the slider or the drive.
        node: usize,
    },
    /// A property of a section is out of range.
    Section {
        /// The beam.
        beam: usize,
        /// Which property.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A shape is impossible.
    Shape {
        /// The beam.
        beam: usize,
        /// Why.
        source: ShapeError,
    },
    /// A shape does not end where its node is.
    DoesNotClose {
        /// The beam.
        beam: usize,
        /// Distance between the end of the shape and the node, m.
        gap_m: f64,
    },
    /// The places at which the thickness of a beam is given do not ascend from 0 to 1, or are too many.
    Profile {
        /// The beam.
        beam: usize,
    },
    /// More pieces between kinks of the thickness than [`crate::Network::MOST_PIECES`].
    TooManyPieces {
        /// How many there are.
        count: usize,
    },
    /// An arm is not finite.
    Arm {
        /// The beam.
        beam: usize,
    },
    /// The rigid zones at both ends of a beam leave too little of it to bend.
    AllRigid {
        /// The beam.
        beam: usize,
        /// Sum of the zones, m.
        rigid_m: f64,
    },
    /// More load stages than [`crate::Network::MOST_STAGES`].
    TooManyStages {
        /// How many there are.
        count: usize,
    },
    /// The end of a load stage is not a finite number.
    StageEnd {
        /// The stage.
        stage: usize,
    },
    /// Two loads prescribe the same motion, or two that are not perpendicular.
    DrivenTwice {
        /// The node.
        node: usize,
        /// The later of the two, counted from 0; the drive counts after all stages.
        stage: usize,
    },
    /// A part of the network can move without deforming.
    Mechanism {
        /// A node of that part.
        node: usize,
    },
    /// The drive acts on a motion that its node does not have.
    DriveBlocked {
        /// The node.
        node: usize,
    },
    /// A control value is negative, not finite, or not above the one before it.
    Stations {
        /// Its place in the list.
        index: usize,
    },
    /// A state is asked for at a negative displacement, or beyond the last station.
    States {
        /// Its place in the list.
        index: usize,
    },
    /// The accuracy is not in (0, 1).
    Accuracy {
        /// What was asked.
        accuracy: f64,
    },
}

impl fmt::Display for NetworkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoBeams => write!(f, "the network has no beams; add one"),
            Self::TooLarge { count } => {
                write!(f, "the network has {count} nodes or beams; at most {} are supported", crate::Network::LARGEST)
            }
            Self::NodeOutOfRange { beam, node } => write!(f, "beam {beam} ends at node {node}, which does not exist"),
            Self::DriveOutOfRange { node } => write!(f, "the drive acts on node {node}, which does not exist"),
            Self::BeamOnOneNode { beam } => write!(f, "beam {beam} starts and ends at the same node; split it in two"),
            Self::LooseNode { node } => write!(f, "no beam ends at node {node}; remove it"),
            Self::Position { node } => write!(f, "a coordinate of node {node} is not a finite number"),
            Self::Direction { node } => write!(f, "the direction given at node {node} is zero or not finite"),
            Self::Section { beam, what, value } => write!(f, "beam {beam}: {what} is {value}, out of its range"),
            Self::Shape { beam, ref source } => write!(f, "beam {beam}: {source}"),
            Self::DoesNotClose { beam, gap_m } => write!(
                f,
                "the shape of beam {beam} ends {gap_m:.3e} m away from its node; take the node from the shape, or the shape from the chord"
            ),
            Self::Profile { beam } => {
                write!(f, "beam {beam}: places of the thickness must ascend from 0 to 1, at most {} of them", crate::Network::MOST_PLACES)
            }
            Self::TooManyPieces { count } => write!(
                f,
                "thicknesses are given at so many places that beams fall into {count} pieces; at most {} are supported",
                crate::Network::MOST_PIECES
            ),
            Self::Arm { beam } => write!(f, "an arm of beam {beam} is not a finite number"),
            Self::AllRigid { beam, rigid_m } => write!(
                f,
                "beam {beam} is inside its joints over {rigid_m:.3e} m and has nothing left to bend; \
                 lengthen or thin it, spread the beams that meet there, or let joints be points"
            ),
            Self::TooManyStages { count } => {
                write!(f, "{count} load stages come before the drive; at most {} are supported", crate::Network::MOST_STAGES)
            }
            Self::StageEnd { stage } => write!(f, "the end of load stage {stage} is not a finite number"),
            Self::DrivenTwice { node, stage } => write!(
                f,
                "load {stage} prescribes a motion of node {node} that an earlier load prescribes already; \
                 two displacements of one node must be perpendicular"
            ),
            Self::Mechanism { node } => {
                write!(f, "the part around node {node} can move without deforming; support it, or make a hinge rigid")
            }
            Self::DriveBlocked { node } => {
                write!(f, "the drive acts on a motion that the support of node {node} does not allow; turn the drive or change the support")
            }
            Self::Stations { index } => {
                write!(f, "control value {index} is not a finite number above the one before it (the first: not below 0)")
            }
            Self::States { index } => write!(f, "displacement {index} of a state is not a number from 0 to the last station"),
            Self::Accuracy { accuracy } => write!(f, "accuracy is {accuracy}; it must be above 0 and below 1"),
        }
    }
}

impl std::error::Error for NetworkError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Shape { source, .. } => Some(source),
            _ => None,
        }
    }
}

/// How a path ended. Controls are in the unit of the drive: m, rad, N or N·m.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub enum Status {
    /// Every station was reached, to the accuracy asked.
    #[default]
    Complete,
    /// Every station was reached, but two resolutions still differ by more than the accuracy asked.
    NotResolved {
        /// Their difference relative to the largest force (or stress) of the path.
        error_estimate: f64,
        /// The accuracy asked.
        accuracy: f64,
    },
    /// A limit point: the path turns back, so there is no neighbouring equilibrium at a larger control.
    NoEquilibriumBeyond {
        /// The largest control reached.
        control: f64,
    },
    /// An inextensible beam is pulled straight: its ends cannot move any further apart, and the force grows without limit.
    PulledStraight {
        /// The largest control reached.
        control: f64,
        /// The beam.
        beam: usize,
    },
    /// The steps became too small without signs of a limit point.
    StepTooSmall {
        /// The largest control reached.
        control: f64,
    },
    /// The equations at rest do not determine the forces: the network is over-constrained for inextensible beams.
    OverConstrained {
        /// A beam whose force is undetermined.
        beam: usize,
    },
    /// The network can move without a force at rest.
    Mechanism {
        /// A node that moves.
        node: usize,
    },
    /// The budget of Newton iterations is spent.
    IterationLimit {
        /// The largest control reached.
        control: f64,
        /// The budget.
        limit: u64,
    },
    /// The path was followed through limit points for as long as is sensible, but did not come to the last station.
    TooLong {
        /// The control at which it ended.
        control: f64,
    },
    /// The caller asked to stop.
    Stopped {
        /// The largest control reached.
        control: f64,
    },
}

impl Status {
    /// Whether every station was reached to the accuracy asked.
    pub fn is_complete(&self) -> bool {
        matches!(self, Self::Complete)
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Complete => write!(f, "complete"),
            Self::NotResolved { error_estimate, accuracy } => write!(
                f,
                "reached the end, but the error is estimated at {error_estimate:.1e} of the largest value instead of {accuracy:.1e}; \
                 split strongly bent beams or accept the lower accuracy"
            ),
            Self::NoEquilibriumBeyond { control } => write!(
                f,
                "there is no neighbouring equilibrium beyond {control:.6e}: the path turns back (snap-through); \
                 stop before it, or drive the displacement instead of the force"
            ),
            Self::PulledStraight { control, beam } => write!(
                f,
                "beam {beam} is pulled straight at {control:.6e}: an inextensible beam gives way no further; \
                 stop before it, or allow stretching (the Reissner theory)"
            ),
            Self::StepTooSmall { control } => write!(
                f,
                "the steps became too small at {control:.6e}; the equilibrium may branch there: break the symmetry, or stop before it"
            ),
            Self::OverConstrained { beam } => write!(
                f,
                "the force in beam {beam} is undetermined at rest: inextensible beams are over-constrained here; \
                 allow stretching (the Reissner theory) or bend the beam a little"
            ),
            Self::Mechanism { node } => {
                write!(f, "node {node} can move at rest without a force; add a support or make a hinge rigid")
            }
            Self::IterationLimit { control, limit } => {
                write!(f, "stopped at {control:.6e} after {limit} Newton iterations; ask for a shorter range or a larger budget")
            }
            Self::TooLong { control } => write!(
                f,
                "the path was given up at {control:.6e}: it winds on without coming to the end of the range; ask for a shorter range"
            ),
            Self::Stopped { control } => write!(f, "stopped on request at {control:.6e}"),
        }
    }
}

/// Why a path has no point at a control.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum PathError {
    /// The control is negative, not finite, or beyond what was reached.
    OutOfReach {
        /// What was asked.
        control: f64,
        /// The largest control reached.
        reached: f64,
    },
    /// The equations did not converge between two known states.
    NotConverged {
        /// What was asked.
        control: f64,
    },
}

impl fmt::Display for PathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfReach { control, reached } => {
                write!(f, "{control:.6e} is not on the path, which reaches from 0 to {reached:.6e}; trace it further")
            }
            Self::NotConverged { control } => write!(f, "no equilibrium was found at {control:.6e}; add a station close to it"),
        }
    }
}

impl std::error::Error for PathError {}
