//! Networks that several tests build, and the mechanism of the paper.

#![allow(dead_code, reason = "each test file uses its part")]

use std::f64::consts::PI;
use std::sync::LazyLock;

use forcewright_base::{maths, quadrature::GaussLegendre};
use forcewright_curves::outline::{AxisPoint, Block, Cap, HalfWidth, Joint, Network, Node, Strip};

/// Two panels of 24 points are exact to rounding for the turns of the tests.
static RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(24));

/// An axis whose angle is a polynomial of the place on it: η(u) = c0 + c1 u + …, from a start, of a length.
#[derive(Clone, Debug)]
pub(crate) struct Intrinsic {
    pub(crate) start_m: [f64; 2],
    pub(crate) angle_rad: Vec<f64>,
    pub(crate) length_m: f64,
}

impl Intrinsic {
    /// From one point to another with the given bend c1, c2, …
    pub(crate) fn between(from: [f64; 2], to: [f64; 2], bend: &[f64]) -> Self {
        let mut angle_rad = vec![0.0];
        angle_rad.extend(bend);
        let unit = Self { start_m: [0.0; 2], angle_rad: angle_rad.clone(), length_m: 1.0 }.point(1.0);
        let chord = [to[0] - from[0], to[1] - from[1]];
        angle_rad[0] = maths::atan2(chord[1], chord[0]) - maths::atan2(unit[1], unit[0]);
        Self { start_m: from, angle_rad, length_m: maths::hypot(chord[0], chord[1]) / maths::hypot(unit[0], unit[1]) }
    }

    pub(crate) fn angle(&self, u: f64) -> f64 {
        self.angle_rad.iter().rev().fold(0.0, |sum, c| sum * u + c)
    }

    pub(crate) fn point(&self, u: f64) -> [f64; 2] {
        let panel = |a: f64, b: f64, f: fn(f64) -> f64| (b - a) * RULE.integrate(|t| f(self.angle(a + (b - a) * t)));
        let sum = |f: fn(f64) -> f64| panel(0.0, 0.5 * u, f) + panel(0.5 * u, u, f);
        [self.start_m[0] + self.length_m * sum(maths::cos), self.start_m[1] + self.length_m * sum(maths::sin)]
    }

    pub(crate) fn at(&self, u: f64) -> AxisPoint {
        let (sin, cos) = maths::sin_cos(self.angle(u));
        let slope = self.angle_rad.iter().enumerate().skip(1).rev().fold(0.0, |sum, (k, c)| sum * u + k as f64 * c);
        AxisPoint { point_m: self.point(u), tangent: [cos, sin], curvature_per_m: slope / self.length_m }
    }

    pub(crate) fn strip(&self, half_m: f64, ends: [Joint; 2]) -> Strip<'static> {
        let own = self.clone();
        Strip { axis: Box::new(move |u| own.at(u)), length_m: self.length_m, half_width: HalfWidth::Constant(half_m), ends }
    }
}

/// A straight strip.
pub(crate) fn straight(from: [f64; 2], to: [f64; 2], half_m: f64, ends: [Joint; 2]) -> Strip<'static> {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length_m = maths::hypot(dx, dy);
    let tangent = [dx / length_m, dy / length_m];
    let axis = move |u: f64| AxisPoint { point_m: [from[0] + u * dx, from[1] + u * dy], tangent, curvature_per_m: 0.0 };
    Strip { axis: Box::new(axis), length_m, half_width: HalfWidth::Constant(half_m), ends }
}

/// Part of a circle, counterclockwise if the sweep is positive.
pub(crate) fn circular(centre: [f64; 2], radius: f64, start_rad: f64, sweep_rad: f64, half_m: f64, ends: [Joint; 2]) -> Strip<'static> {
    let axis = move |u: f64| {
        let (sin, cos) = maths::sin_cos(start_rad + u * sweep_rad);
        let sign = sweep_rad.signum();
        AxisPoint {
            point_m: [centre[0] + radius * cos, centre[1] + radius * sin],
            tangent: [-sign * sin, sign * cos],
            curvature_per_m: sign / radius,
        }
    };
    Strip { axis: Box::new(axis), length_m: radius * sweep_rad.abs(), half_width: HalfWidth::Constant(half_m), ends }
}

pub(crate) fn node(point_m: [f64; 2], fillet_m: f64) -> Node {
    Node { point_m, fillet_m, cap: Cap::Square }
}

/// A block along the axes.
pub(crate) fn pad(min_m: [f64; 2], max_m: [f64; 2], fillet_m: f64) -> Block {
    let corners_m = vec![min_m, [max_m[0], min_m[1]], max_m, [min_m[0], max_m[1]]];
    Block { corners_m, corner_radius_m: 0.0, fillet_m }
}

/// Straight strips of equal width from the origin in given directions, with square ends.
pub(crate) fn star(directions_rad: &[f64], length_m: f64, half_m: f64, fillet_m: f64) -> Network<'static> {
    let mut nodes = vec![node([0.0, 0.0], fillet_m)];
    let mut strips = Vec::new();
    for (k, direction) in directions_rad.iter().enumerate() {
        let (sin, cos) = maths::sin_cos(*direction);
        let end = [length_m * cos, length_m * sin];
        nodes.push(node(end, 0.0));
        strips.push(straight([0.0, 0.0], end, half_m, [Joint::Node(0), Joint::Node(k + 1)]));
    }
    Network { nodes, blocks: Vec::new(), strips }
}

/// The area that a fillet adds in a corner: r² (cot(θ/2) − (π − θ)/2).
pub(crate) fn fillet_area(radius: f64, corner_rad: f64) -> f64 {
    radius * radius * (1.0 / maths::tan(0.5 * corner_rad) - 0.5 * (PI - corner_rad))
}

/// The beams of Table 3 of C.-C. Lan, J.-H. Wang, Y.-H. Chen (ICRA 2010), shapes from its nodes, m.
#[expect(clippy::approx_constant, reason = "as printed")]
pub(crate) fn lan_beams() -> [Intrinsic; 4] {
    let mm = |x: f64, y: f64| [x * 1e-3, y * 1e-3];
    let [n1, n2, n3, n4, n5] = [mm(2.5, 0.0), mm(34.5, 0.0), mm(30.5, 18.77), mm(12.44, 24.0), mm(2.5, 40.0)];
    [
        Intrinsic::between(n1, n3, &[1.3092, -1.5707]),
        Intrinsic::between(n2, n3, &[-0.756, 1.5707]),
        Intrinsic::between(n3, n4, &[0.3013, 1.5707]),
        Intrinsic::between(n4, n5, &[0.226, -1.148]),
    ]
}

/// Half the mechanism of Table 3: beams 1 mm wide between pads of 10 mm × 8 mm, with fillets of a radius.
pub(crate) fn lan_half(fillet_m: f64) -> Network<'static> {
    let beams = lan_beams();
    let joints = [
        [Joint::Block(0), Joint::Node(0)],
        [Joint::Block(1), Joint::Node(0)],
        [Joint::Node(0), Joint::Node(1)],
        [Joint::Node(1), Joint::Block(2)],
    ];
    let strips = beams.iter().zip(joints).map(|(beam, ends)| beam.strip(0.5e-3, ends)).collect();
    let mm = |x: f64, y: f64| [x * 1e-3, y * 1e-3];
    Network {
        nodes: vec![node(mm(30.5, 18.77), fillet_m), node(mm(12.44, 24.0), fillet_m)],
        blocks: vec![
            pad(mm(-2.5, -8.0), mm(7.5, 0.0), fillet_m),
            pad(mm(29.5, -8.0), mm(39.5, 0.0), fillet_m),
            pad(mm(-2.5, 40.0), mm(7.5, 48.0), fillet_m),
        ],
        strips,
    }
}
