//! Whether the whole of a mirrored mechanism stays in the middle without a guide.
//!
//! Motions of the two halves together are along the mirror line, which the solved half has, or sideways with a rotation, which symmetry
//! keeps apart from it to second order. Against the latter the whole is twice as stiff as one half whose node makes the same motion.

use forcewright_base::maths;
use forcewright_beam::{Path, Point, Rotation, Support};

use crate::design::Design;
use crate::layout::Mirror;

/// Every so many stations are looked at.
const STRIDE: usize = 4;
/// Halvings of the interval in which swaying begins.
const HALVINGS: usize = 10;

/// How the whole layout resists sideways motion of the block between the halves, free to turn, with the displacement of the load held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sway {
    /// Least sideways force per sideways motion over the path, N/m; `None` where at some state not even the rotation is resisted.
    pub least_n_per_m: Option<f64>,
    /// Displacement of the load from which the block sways unless it is guided, m.
    pub from_m: Option<f64>,
}

/// Whether the load node is where the two halves are joined: on the mirror line, or beside it in a rigid block.
pub(crate) fn joins_halves(design: &Design) -> bool {
    let Some(mirror) = design.layout.mirror else { return false };
    let node = &design.network.nodes[design.load_node];
    let guided = matches!(node.support, Support::Slider { rotation: Rotation::Fixed, .. });
    guided || mirror.holds(&design.network, node.position_m)
}

impl Sway {
    /// Looks at every fourth state of a path, the last included; `None` where symmetry does not separate the motions, and for rows, planes
    /// and layers, which must be guided.
    pub(crate) fn of(design: &Design, path: &Path) -> Option<Self> {
        if !joins_halves(design) || design.layout.repeats() {
            return None;
        }
        let last = path.points.len().checked_sub(1)?;
        let looked_at = (0..last).step_by(STRIDE).chain([last]);
        let mut least: Option<f64> = None;
        let (mut turns_over, mut from_m) = (false, None);
        let mut upright = 0.0;
        for point in looked_at.map(|i| &path.points[i]) {
            let Some(block) = Block::of(design, path, point) else { continue };
            match block.lateral_n_per_m() {
                Some(lateral) => least = Some(least.map_or(lateral, |l: f64| l.min(lateral))),
                None => turns_over = true,
            }
            if block.stays() {
                upright = point.control;
            } else if from_m.is_none() {
                from_m = Some(begin(design, path, upright, point));
            }
        }
        let least_n_per_m = least.filter(|_| !turns_over);
        (least.is_some() || turns_over).then_some(Self { least_n_per_m, from_m })
    }
}

/// Where swaying begins that is there at `point` but not yet at the control `upright`.
fn begin(design: &Design, path: &Path, mut upright: f64, point: &Point) -> f64 {
    let (mut sways, mut from_m) = (point.control, point.displacement);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(upright, sways);
        let Ok(between) = path.at(middle) else { break };
        if Block::of(design, path, &between).is_none_or(|b| b.stays()) {
            upright = middle;
        } else {
            (sways, from_m) = (middle, between.displacement);
        }
    }
    from_m
}

/// Stiffness of the block against sideways motion and rotation about its place on the mirror line, whole layout.
struct Block {
    across_n_per_m: f64,
    mixed_n: f64,
    turn_nm: f64,
}

impl Block {
    fn of(design: &Design, path: &Path, point: &Point) -> Option<Self> {
        let mirror = design.layout.mirror?;
        let stiffness = path.output_stiffness(point)?;
        let node = design.network.nodes.get(design.load_node)?;
        let moved = point.nodes.get(design.load_node)?;
        let at = [0, 1].map(|i| node.position_m[i] + moved.displacement_m[i]);
        // Across the line and along it, a right-handed pair, and how far the node is from the line.
        let (across, along, lever_m) = match mirror {
            Mirror::X(line) => ([1.0, 0.0], [0.0, 1.0], at[0] - line),
            Mirror::Y(line) => ([0.0, 1.0], [-1.0, 0.0], at[1] - line),
        };
        // Sideways motion moves the node across; rotation turns it, and moves it along the line by its lever.
        let sideways = [across[0], across[1], 0.0];
        let turned = [lever_m * along[0], lever_m * along[1], 1.0];
        let form = |a: [f64; 3], b: [f64; 3]| -> f64 { (0..3).map(|i| (0..3).map(|j| a[i] * stiffness[i][j] * b[j]).sum::<f64>()).sum() };
        // To second order rotation also draws the node to the line, by lever·θ²/2, against the force that holds it there.
        let held_n = moved.force_n[0] * across[0] + moved.force_n[1] * across[1];
        let copies = design.copies();
        Some(Self {
            across_n_per_m: copies * form(sideways, sideways),
            mixed_n: copies * form(sideways, turned),
            turn_nm: copies * (form(turned, turned) - lever_m * held_n),
        })
    }

    /// Sideways force per sideways motion where the block turns freely, N/m; `None` if it would turn over.
    fn lateral_n_per_m(&self) -> Option<f64> {
        (self.turn_nm > 0.0).then(|| self.across_n_per_m - maths::powi(self.mixed_n, 2) / self.turn_nm)
    }

    fn stays(&self) -> bool {
        self.lateral_n_per_m().is_some_and(|k| k > 0.0)
    }
}
