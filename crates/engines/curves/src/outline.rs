//! The outline of a part made of strips and blocks in one piece: flexure beams, pads and rigid bodies.
//!
//! Strips run between nodes and blocks as the edges of a plane graph run between its vertices. Each boundary of the part is a face of that
//! graph: it follows the right-hand side of a strip outward from one vertex to the next, there turns through a joint onto the next strip
//! counterclockwise, and so on until it is back. So every side of every strip occurs once, trimmed at its joints, and no Boolean operation
//! on areas is needed. What this cannot see, strips that run into each other away from their joints, is looked for in the result.

use crate::fit::FitError;
use crate::profile::Profile;

mod assemble;
mod block;
mod contact;
mod error;
mod node;
mod walk;

pub use error::OutlineError;

/// A place on the axis of a strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisPoint {
    /// Where, m.
    pub point_m: [f64; 2],
    /// Unit tangent in the direction of the growing parameter.
    pub tangent: [f64; 2],
    /// Curvature, 1/m, positive to the left.
    pub curvature_per_m: f64,
}

/// Half the width of a strip, measured across its axis.
#[derive(Clone, Debug, PartialEq)]
pub enum HalfWidth {
    /// The same everywhere, m.
    Constant(f64),
    /// At ascending places `u` from 0 to 1, m, and linear between them: pairs of place and half width.
    Linear(Vec<[f64; 2]>),
}

/// A vertex of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Joint {
    /// The node with that index.
    Node(usize),
    /// The block with that index.
    Block(usize),
}

/// A band of material along an axis.
pub struct Strip<'a> {
    /// The axis by `u` in [0, 1], which is the length from its start divided by its whole length: smooth, of speed `length_m`.
    pub axis: Box<dyn Fn(f64) -> AxisPoint + 'a>,
    /// Length of the axis, m.
    pub length_m: f64,
    /// Half its width.
    pub half_width: HalfWidth,
    /// Where its axis starts and ends. At a node both are the same point; in a block the axis ends inside or on its border.
    pub ends: [Joint; 2],
}

/// The end of a strip that meets no other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cap {
    /// Half a circle round the node.
    Round,
    /// Straight across.
    Square,
}

/// A point in which strips end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Where, m.
    pub point_m: [f64; 2],
    /// Radius of the fillets between the strips that meet here, m; 0 for sharp corners.
    pub fillet_m: f64,
    /// What a single strip ends with.
    pub cap: Cap,
}

/// A polygon of material into which strips run.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Its corners in either order, m.
    pub corners_m: Vec<[f64; 2]>,
    /// Radius of its rounded corners, m; 0 for sharp ones.
    pub corner_radius_m: f64,
    /// Radius of the fillets between its edges and strips, m; 0 for sharp corners.
    pub fillet_m: f64,
}

/// Strips, and what they end in.
pub struct Network<'a> {
    /// Points in which strips end.
    pub nodes: Vec<Node>,
    /// Polygons into which strips run.
    pub blocks: Vec<Block>,
    /// Bands of material.
    pub strips: Vec<Strip<'a>>,
}

/// A side of a strip, seen in the direction of its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// To the left.
    Left,
    /// To the right.
    Right,
}

/// What a segment of an outline is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tag {
    /// The side of a strip.
    Side {
        /// The strip.
        strip: usize,
        /// Which side.
        side: Side,
    },
    /// An arc in a re-entrant corner, tangent to its neighbours (but for a step lower than its radius, which it meets at the edge).
    Fillet {
        /// Where.
        joint: Joint,
    },
    /// An arc round a node, on the outer side of strips that meet.
    Round {
        /// The node.
        node: usize,
    },
    /// The straight end of a strip that goes on as a thinner one.
    Step {
        /// The node.
        node: usize,
    },
    /// The end of a single strip.
    Cap {
        /// The node.
        node: usize,
    },
    /// Part of an edge of a block; edge `k` joins corners `k` and `k + 1`.
    Edge {
        /// The block.
        block: usize,
        /// The edge.
        edge: usize,
    },
    /// A rounded corner of a block.
    Corner {
        /// The block.
        block: usize,
        /// The corner.
        corner: usize,
    },
}

/// A closed boundary whose segments say what they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// The curve.
    pub profile: Profile,
    /// What each of its segments is.
    pub tags: Vec<Tag>,
}

/// A connected piece of material.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Its outer boundary, counterclockwise.
    pub outer: Boundary,
    /// Boundaries of the windows in it, clockwise.
    pub windows: Vec<Boundary>,
}

/// The outline of a network.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Pieces of material that are not connected, in the order of their first strip, then of their first block.
    pub regions: Vec<Region>,
    /// The largest distance of a side from its curve that was measured, m; lines and arcs are exact.
    pub fit_error_m: f64,
}

impl Outline {
    /// All boundaries: of each region the outer one, then its windows.
    pub fn boundaries(&self) -> impl Iterator<Item = &Boundary> {
        self.regions.iter().flat_map(|region| std::iter::once(&region.outer).chain(&region.windows))
    }

    /// All boundaries without their tags.
    pub fn profiles(&self) -> Vec<Profile> {
        self.boundaries().map(|boundary| boundary.profile.clone()).collect()
    }

    /// The area of material, m².
    pub fn area_m2(&self) -> f64 {
        self.boundaries().map(|boundary| boundary.profile.area_m2()).sum()
    }
}

impl Network<'_> {
    /// The outline, with sides of strips that are neither straight nor circular as splines within `tolerance_m` of them.
    ///
    /// Across its axis a strip has the given width; the sides of a constant width are the curves at half the width from the axis. A fillet
    /// is the circle of its radius that touches both of its neighbours nearest to the joint. On the outer side of a node strips are
    /// joined by an arc round the node, or directly where they are in line; `docs/theory/curves.md` has the cases of unequal widths. The
    /// result has been looked at for boundaries that meet (to `tolerance_m`, at least a millionth of its size).
    ///
    /// # Errors
    /// [`OutlineError`]: numbers that make no sense, fillets that do not fit, strips that overlap.
    pub fn outline(&self, tolerance_m: f64) -> Result<Outline, OutlineError> {
        error::check(self, tolerance_m)?;
        assemble::outline(self, tolerance_m)
    }

    /// Size of the whole, m: what lengths of the order of rounding are compared with.
    fn extent_m(&self) -> f64 {
        let axes = self.strips.iter().flat_map(|strip| [0.0, 0.25, 0.5, 0.75, 1.0].map(|u| (strip.axis)(u).point_m));
        let corners = self.blocks.iter().flat_map(|block| block.corners_m.iter().copied());
        crate::bounds::Bounds::of(axes.chain(corners)).extent_m()
    }
}

impl From<FitError> for OutlineError {
    fn from(error: FitError) -> Self {
        Self::Fit(error)
    }
}
