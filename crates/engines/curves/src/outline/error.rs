//! What can be wrong with a network of strips.

use std::fmt;

use super::{HalfWidth, Joint, Network, Strip, Tag};
use crate::bounds::Bounds;
use crate::fit::FitError;
use crate::vector::{distance, norm};

/// Why a network has no outline. Indices count from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum OutlineError {
    /// There is neither a strip nor a block.
    Empty,
    /// A strip ends in a node or block that does not exist.
    NoJoint {
        /// The strip.
        strip: usize,
        /// What it names.
        joint: Joint,
    },
    /// A number of a strip is not finite or out of range: its length, a width, a place of a width, or a point of its axis.
    Strip {
        /// The strip.
        strip: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// The axis of a strip does not end in its node.
    NotAtNode {
        /// The strip.
        strip: usize,
        /// The node.
        node: usize,
        /// How far from it the axis ends, m.
        distance_m: f64,
    },
    /// No strip ends in a node.
    LooseNode {
        /// The node.
        node: usize,
    },
    /// A node or a block has a radius that is negative or not finite, or a point that is not finite.
    Number {
        /// Where.
        joint: Joint,
    },
    /// A block is no simple polygon, or its corners cannot be rounded with its radius.
    Block {
        /// The block.
        block: usize,
    },
    /// A strip does not meet the border of a block in which it ends.
    NoMeeting {
        /// The strip.
        strip: usize,
        /// The block.
        block: usize,
    },
    /// A strip bends more tightly than half its width: its inner side would fold.
    TightBend {
        /// The strip.
        strip: usize,
        /// Where on its axis.
        u: f64,
        /// The radius of the axis there, m.
        radius_m: f64,
    },
    /// A fillet between two strips, or between a strip and a block, touches none of the places it should, or runs into the next one.
    Fillet {
        /// Where.
        joint: Joint,
        /// The strip before and the strip after it, counterclockwise round the joint.
        strips: [usize; 2],
        /// The radius asked for, m.
        radius_m: f64,
        /// The largest radius with which it would fit, all else unchanged, m; 0 if none does.
        largest_m: f64,
    },
    /// Two strips, or a strip and a block or a fillet, overlap away from their joint.
    Overlap {
        /// What meets.
        tags: [Tag; 2],
        /// Where, m.
        at_m: [f64; 2],
    },
    /// The boundaries do not enclose one piece of material per connected part: a strip crosses over another one.
    NotSimple,
    /// A side was not fitted.
    Fit(FitError),
}

impl fmt::Display for OutlineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "there are no strips and no blocks"),
            Self::NoJoint { strip, joint } => write!(f, "strip {strip} ends in {joint}, which does not exist"),
            Self::Strip { strip, what } => write!(f, "strip {strip}: {what}"),
            Self::NotAtNode { strip, node, distance_m } => {
                write!(f, "the axis of strip {strip} ends {distance_m} m from node {node}")
            }
            Self::LooseNode { node } => write!(f, "no strip ends in node {node}"),
            Self::Number { joint } => write!(f, "{joint} has a radius below 0 or a number that is not finite"),
            Self::Block { block } => write!(f, "block {block} is no simple polygon, or its corner radius does not fit"),
            Self::NoMeeting { strip, block } => write!(f, "strip {strip} does not meet the border of block {block}"),
            Self::TightBend { strip, u, radius_m } => {
                write!(f, "strip {strip} bends with a radius of {radius_m} m at u = {u}: less than half its width")
            }
            Self::Fillet { joint, strips: [a, b], radius_m, largest_m } => {
                write!(f, "a fillet of {radius_m} m between strips {a} and {b} at {joint} does not fit; ")?;
                if *largest_m > 0.0 { write!(f, "the largest that does is {largest_m} m") } else { write!(f, "nor does any other") }
            }
            Self::Overlap { tags: [a, b], at_m: [x, y] } => write!(f, "{a} and {b} overlap at ({x}, {y}) m"),
            Self::NotSimple => write!(f, "the boundaries enclose no connected piece of material: strips cross over each other"),
            Self::Fit(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for OutlineError {}

impl fmt::Display for Joint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Node(node) => write!(f, "node {node}"),
            Self::Block(block) => write!(f, "block {block}"),
        }
    }
}

impl fmt::Display for Tag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Side { strip, .. } => write!(f, "strip {strip}"),
            Self::Fillet { joint } => write!(f, "a fillet at {joint}"),
            Self::Round { node } | Self::Step { node } => write!(f, "the joint of node {node}"),
            Self::Cap { node } => write!(f, "the end at node {node}"),
            Self::Edge { block, .. } | Self::Corner { block, .. } => write!(f, "block {block}"),
        }
    }
}

/// Places at which a strip is looked at for numbers that are out of range.
const PROBES: usize = 200;

/// All that can be said before anything is computed.
pub(super) fn check(network: &Network, tolerance_m: f64) -> Result<(), OutlineError> {
    if !(tolerance_m > 0.0 && tolerance_m.is_finite()) {
        return Err(OutlineError::Fit(FitError::Tolerance { tolerance_m }));
    }
    if network.strips.is_empty() && network.blocks.is_empty() {
        return Err(OutlineError::Empty);
    }
    let radius = |radius_m: f64| radius_m >= 0.0 && radius_m.is_finite();
    for (k, node) in network.nodes.iter().enumerate() {
        if !(radius(node.fillet_m) && node.point_m.iter().all(|x| x.is_finite())) {
            return Err(OutlineError::Number { joint: Joint::Node(k) });
        }
    }
    for (k, block) in network.blocks.iter().enumerate() {
        let finite = block.corners_m.iter().flatten().all(|x| x.is_finite());
        if !(radius(block.fillet_m) && radius(block.corner_radius_m) && finite) {
            return Err(OutlineError::Number { joint: Joint::Block(k) });
        }
    }
    network.strips.iter().enumerate().try_for_each(|(k, strip)| check_strip(network, k, strip, tolerance_m))?;
    let loose = |node: &usize| !network.strips.iter().any(|strip| strip.ends.contains(&Joint::Node(*node)));
    (0..network.nodes.len()).find(loose).map_or(Ok(()), |node| Err(OutlineError::LooseNode { node }))
}

fn check_strip(network: &Network, k: usize, strip: &Strip, tolerance_m: f64) -> Result<(), OutlineError> {
    let wrong = |what| Err(OutlineError::Strip { strip: k, what });
    if !(strip.length_m > 0.0 && strip.length_m.is_finite()) {
        return wrong("its length must be finite and above 0");
    }
    let positive = |half: f64| half > 0.0 && half.is_finite();
    match &strip.half_width {
        HalfWidth::Constant(half_m) if !positive(*half_m) => return wrong("its half width must be finite and above 0"),
        HalfWidth::Linear(table) => {
            let at = |row: Option<&[f64; 2]>, place: f64| row.is_some_and(|row| (row[0] - place).abs() <= 0.0);
            let ends = at(table.first(), 0.0) && at(table.last(), 1.0) && table.len() > 1;
            if !(ends && table.windows(2).all(|rows| rows[0][0] < rows[1][0]) && table.iter().all(|row| positive(row[1]))) {
                return wrong("its half widths must be finite and above 0, at ascending places from 0 to 1");
            }
        }
        HalfWidth::Constant(_) => {}
    }
    let mut reached = Bounds::of([]);
    for probe in 0..=PROBES {
        let u = probe as f64 / PROBES as f64;
        let place = (strip.axis)(u);
        let numbers = [place.point_m[0], place.point_m[1], place.tangent[0], place.tangent[1], place.curvature_per_m];
        if !(numbers.iter().all(|x| x.is_finite()) && (norm(place.tangent) - 1.0).abs() < 1e-6) {
            return wrong("its axis must be finite, with tangents of length 1");
        }
        reached.include(place.point_m);
        let half_m = strip.half_width.at(u)[0];
        if place.curvature_per_m.abs() * half_m >= 1.0 {
            return Err(OutlineError::TightBend { strip: k, u, radius_m: 1.0 / place.curvature_per_m.abs() });
        }
    }
    if reached.extent_m() > strip.length_m * (1.0 + 1e-6) {
        return wrong("its axis reaches farther than its length");
    }
    for (joint, u) in strip.ends.into_iter().zip([0.0, 1.0]) {
        match joint {
            Joint::Node(node) => {
                let Some(known) = network.nodes.get(node) else { return Err(OutlineError::NoJoint { strip: k, joint }) };
                let distance_m = distance((strip.axis)(u).point_m, known.point_m);
                if distance_m > tolerance_m {
                    return Err(OutlineError::NotAtNode { strip: k, node, distance_m });
                }
            }
            Joint::Block(block) if block >= network.blocks.len() => return Err(OutlineError::NoJoint { strip: k, joint }),
            Joint::Block(_) => {}
        }
    }
    Ok(())
}
