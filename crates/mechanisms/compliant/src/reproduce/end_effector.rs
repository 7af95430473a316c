//! Table 4: the end-effector's mechanism, eight legs that share the load.

use std::f64::consts::PI;

use forcewright_base::{maths, roots};
use forcewright_beam::Shape;

use super::{Solved, solve};
use crate::analysis::{Behaviour, measure};
use crate::scenario::{Join, Profile, Surface, SurfaceRun, TipPath};

const LEG: &str = include_str!("../../../../../reference/lan2010-table4.toml");
/// Two sub-mechanisms of four legs, section IV.
const LEGS: f64 = 8.0;
/// Least and largest force measured along the cam, N; section IV.
const MEASURED_N: [f64; 2] = [8.0, 8.59];
/// Height of the cam and the way of the stage over its rise, m; section IV. Its shape is not printed: a raised cosine.
const HEIGHT_M: f64 = 5e-3;
const WAY_M: f64 = 12.3e-3;
/// A cam that these legs follow within the measured forces, and the displacement at its foot, m.
const LOW_M: [f64; 2] = [3.2e-3, 1.82e-3];
/// Nodes as printed in Table 4, m.
const PRINTED_M: [[f64; 2]; 4] = [[10e-3, 2e-3], [9.9e-3, 5.5e-3], [1.5e-3, 6.4e-3], [0.0, 10e-3]];

/// One leg: its shapes with the nodes that follow, and the printed nodes with the shapes that follow.
pub(super) struct EndEffector {
    shapes: Solved,
    nodes: Solved,
}

impl EndEffector {
    pub(super) fn solve() -> Option<Self> {
        let shapes = solve(LEG, &[])?;
        let mut design = shapes.design.clone();
        for (node, printed) in design.network.nodes.iter_mut().zip(PRINTED_M) {
            node.position_m = printed;
        }
        for beam in &mut design.network.beams {
            let [from, to] = [beam.start, beam.end].map(|n| PRINTED_M[n]);
            beam.shape = Shape::from_chord([to[0] - from[0], to[1] - from[1]], &beam.shape.angle_rad()[1..]).ok()?;
        }
        let behaviour = Behaviour::of(&design, &mut |_| true).ok()?;
        let measured = measure(&design, &behaviour);
        Some(Self { shapes, nodes: Solved { design, behaviour, measured } })
    }

    /// The number of a row, in its unit; `id` without its `t4_`.
    pub(super) fn value(&self, id: &str) -> f64 {
        let (mm, mpa) = (1e3, 1e-6);
        let stress = super::stress_at(&self.shapes, HEIGHT_M);
        match id {
            "force_nodes" => LEGS * self.nodes.force(HEIGHT_M),
            "window_start" => mm * self.window()[0],
            "window_end" => mm * self.window()[1],
            "window" => mm * (self.window()[1] - self.window()[0]),
            "window_nodes" => mm * window(&self.nodes).map_or(f64::NAN, |[from, to]| to - from),
            "contact_min" => self.contact_n(HEIGHT_M, 0.0)[0],
            "contact_low_min" => self.contact_n(LOW_M[0], LOW_M[1])[0],
            "contact_low_max" => self.contact_n(LOW_M[0], LOW_M[1])[1],
            "stress" => mpa * stress,
            "safety" => self.shapes.design.yield_pa(0).map_or(f64::NAN, |yield_pa| yield_pa / stress),
            _ => self.numbered(id),
        }
    }

    /// `force_5`: at 5 mm; `node_2_x`, in mm.
    fn numbered(&self, id: &str) -> f64 {
        let parts: Vec<&str> = id.split('_').collect();
        match parts[..] {
            ["force", at] => at.parse::<f64>().map_or(f64::NAN, |at| LEGS * self.shapes.force(1e-3 * at)),
            ["node", number, axis] => {
                let node = number.parse::<usize>().ok().and_then(|n| self.shapes.design.network.nodes.get(n.checked_sub(1)?));
                node.map_or(f64::NAN, |n| 1e3 * n.position_m[usize::from(axis == "y")])
            }
            _ => f64::NAN,
        }
    }

    /// Least and largest contact force of eight legs without friction over the rise of a cam whose foot is at a displacement, N.
    fn contact_n(&self, height_m: f64, preload_m: f64) -> [f64; 2] {
        let part = |i: u32| f64::from(i) / 40.0;
        let way = (0..=40).map(|i| WAY_M * part(i)).collect();
        let heights = (0..=40).map(|i| 0.5 * height_m * (1.0 - maths::cos(PI * part(i)))).collect();
        let surface = Surface {
            path: TipPath::new(Profile::new(way, heights, Join::Smooth), 0.0),
            preload_m,
            guide_friction: 0.0,
            guide_load: 1.0,
            tip_friction: 0.0,
            there_and_back: false,
        };
        let run = self.shapes.behaviour.curve.as_ref().map(|curve| SurfaceRun::of(&surface, curve, curve.end()));
        run.and_then(|run| run.axial_n()).map_or([f64::NAN; 2], |range| range.map(|f| LEGS * f))
    }

    fn window(&self) -> [f64; 2] {
        window(&self.shapes).unwrap_or([f64::NAN; 2])
    }
}

/// Where the force of eight legs first reaches the least measured one, and where it last leaves the largest, m.
fn window(leg: &Solved) -> Option<[f64; 2]> {
    let curve = leg.behaviour.curve.as_ref()?;
    let first = curve.crossings(MEASURED_N[0] / LEGS).into_iter().next()?;
    let last = curve.crossings(MEASURED_N[1] / LEGS).into_iter().next_back()?;
    // Read off the curve; placed on the equilibrium.
    let placed = |near: f64, level: f64| {
        let excess = |x: f64| leg.behaviour.path.at(x).map_or(f64::NAN, |p| p.force - level / LEGS);
        roots::root(excess, near - 1e-5, near + 1e-5, 1e-12).unwrap_or(near)
    };
    Some([placed(first, MEASURED_N[0]), placed(last, MEASURED_N[1])])
}
