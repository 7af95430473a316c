//! The middle of the wire of a coil, with a frame that goes along.

use std::f64::consts::{PI, TAU};

use forcewright_base::maths;
use forcewright_base::quadrature::GaussLegendre;

use super::space::{Vector, along, cross, dot, norm, scaled, unit};
use super::{Coil, CoilEnd, Winding};

/// A place of the wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WireStation {
    /// Middle of the wire, m.
    pub point_m: [f64; 3],
    /// Unit vector along the wire, upwards.
    pub tangent: [f64; 3],
    /// Unit vector across the wire; in windings away from the axis.
    pub normal: [f64; 3],
    /// `tangent × normal`.
    pub binormal: [f64; 3],
}

/// What a piece of a wire is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WireKind {
    /// A straight leg.
    Straight,
    /// The arc between windings and a leg.
    Bend,
    /// A winding.
    Wound,
}

/// A smooth piece of the middle of a wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WirePiece {
    curve: Curve,
    /// Against the sense in which the curve was laid.
    is_reversed: bool,
    length_m: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Curve {
    Wound(Wound),
    /// From a point with a tangent around a centre in the direction `towards`, with the normal that the wire has at its begin.
    Bend {
        from: Vector,
        tangent: Vector,
        towards: Vector,
        normal: Vector,
        radius_m: f64,
        angle_rad: f64,
    },
    Straight {
        from: Vector,
        tangent: Vector,
        normal: Vector,
        length_m: f64,
    },
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Wound {
    radius_m: f64,
    /// Where it begins, and how far it goes, rad.
    from_rad: f64,
    turned_rad: f64,
    z_m: f64,
    /// Rise per radian at its begin and its end, m.
    slopes_m: [f64; 2],
    /// 1 for right-handed, −1 for left-handed coils.
    hand: f64,
    /// Sine and cosine of the start angle.
    start: (f64, f64),
}

impl Wound {
    fn at(&self, share: f64) -> WireStation {
        let [low, high] = self.slopes_m;
        let (sin, cos) = maths::sin_cos(self.from_rad + share * self.turned_rad);
        let z = self.z_m + self.turned_rad * share * (low + 0.5 * (high - low) * share);
        let tangent = unit([-self.radius_m * sin, self.radius_m * cos, low + (high - low) * share]);
        let placed = |[x, y, z]: Vector| {
            let y = self.hand * y;
            [self.start.1 * x - self.start.0 * y, self.start.0 * x + self.start.1 * y, z]
        };
        WireStation::new(placed([self.radius_m * cos, self.radius_m * sin, z]), placed(tangent), placed([cos, sin, 0.0]))
    }

    /// `∫√(R² + q²) dθ` with q linear in θ: in closed form, or by Gauss's rule where q hardly changes and that would cancel.
    fn length_m(&self) -> f64 {
        let [low, high] = self.slopes_m;
        let squared = self.radius_m * self.radius_m;
        let length = |q: f64| maths::hypot(self.radius_m, q);
        if (high - low).abs() < 0.1 * length(low.min(high)) {
            return self.turned_rad * GaussLegendre::new(10).integrate(|x| length(low + (high - low) * x));
        }
        let primitive = |q: f64| {
            let x = q / self.radius_m;
            // asinh x for x ≥ 0.
            let asinh = maths::ln_1p(x + x * x / (1.0 + maths::hypot(1.0, x)));
            0.5 * (q * length(q) + squared * asinh)
        };
        self.turned_rad * (primitive(high) - primitive(low)) / (high - low)
    }
}

impl WireStation {
    fn new(point_m: Vector, tangent: Vector, normal: Vector) -> Self {
        Self { point_m, tangent, normal, binormal: cross(tangent, normal) }
    }

    /// A point of the wire's surface: at a radius (m) from the middle, by cosine and sine of the angle from the normal to the binormal.
    pub fn around_m(&self, radius_m: f64, [cos, sin]: [f64; 2]) -> [f64; 3] {
        [0, 1, 2].map(|k| self.point_m[k] + radius_m * (cos * self.normal[k] + sin * self.binormal[k]))
    }
}

impl WirePiece {
    fn new(curve: Curve, is_reversed: bool) -> Self {
        let length_m = match &curve {
            Curve::Wound(wound) => wound.length_m(),
            Curve::Bend { radius_m, angle_rad, .. } => radius_m * angle_rad,
            Curve::Straight { length_m, .. } => *length_m,
        };
        Self { curve, is_reversed, length_m }
    }

    /// What it is.
    pub fn kind(&self) -> WireKind {
        match self.curve {
            Curve::Wound(_) => WireKind::Wound,
            Curve::Bend { .. } => WireKind::Bend,
            Curve::Straight { .. } => WireKind::Straight,
        }
    }

    /// Its length, m.
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// The angle by which it goes around the axis or the centre of its bend, rad; 0 if it is straight.
    pub fn turned_rad(&self) -> f64 {
        match &self.curve {
            Curve::Wound(wound) => wound.turned_rad,
            Curve::Bend { angle_rad, .. } => *angle_rad,
            Curve::Straight { .. } => 0.0,
        }
    }

    /// Radius of that, m; infinite if it is straight.
    pub fn radius_m(&self) -> f64 {
        match &self.curve {
            Curve::Wound(wound) => wound.radius_m,
            Curve::Bend { radius_m, .. } => *radius_m,
            Curve::Straight { .. } => f64::INFINITY,
        }
    }

    /// By how much its rise per radian changes in a radian, m; 0 if its pitch is constant.
    pub fn change_of_slope_m(&self) -> f64 {
        match &self.curve {
            Curve::Wound(wound) => (wound.slopes_m[1] - wound.slopes_m[0]) / wound.turned_rad,
            Curve::Bend { .. } | Curve::Straight { .. } => 0.0,
        }
    }

    /// The place at a share of its angle, or of its length if it is straight; 0 at its lower end, 1 at its upper.
    pub fn at(&self, share: f64) -> WireStation {
        let share = if self.is_reversed { 1.0 - share } else { share };
        let station = match &self.curve {
            Curve::Wound(wound) => wound.at(share),
            Curve::Bend { from, tangent, towards, normal, radius_m, angle_rad } => {
                let (sin, cos) = maths::sin_cos(share * angle_rad);
                let versed = 2.0 * maths::sin(0.5 * share * angle_rad) * maths::sin(0.5 * share * angle_rad);
                let point_m = along(along(*from, *tangent, radius_m * sin), *towards, radius_m * versed);
                // What of the normal lies in the plane of the bend turns with the tangent.
                let inside = dot(*normal, *towards);
                let turned = along(along(*normal, *towards, -inside * versed), *tangent, -inside * sin);
                WireStation::new(point_m, along(scaled(*tangent, cos), *towards, sin), turned)
            }
            Curve::Straight { from, tangent, normal, length_m } => {
                WireStation::new(along(*from, *tangent, share * length_m), *tangent, *normal)
            }
        };
        if self.is_reversed { WireStation::new(station.point_m, scaled(station.tangent, -1.0), station.normal) } else { station }
    }
}

/// The middle of the wire of a coil.
#[derive(Clone, Debug, PartialEq)]
pub struct WireLine {
    pieces: Vec<WirePiece>,
}

impl WireLine {
    pub(super) fn new(coil: &Coil) -> Self {
        let (mut windings, mut from_rad, mut z_m) = (Vec::new(), 0.0, 0.0);
        for &Winding { turns, pitch_m } in &coil.windings {
            let wound = Wound {
                radius_m: coil.radius_m,
                from_rad,
                turned_rad: TAU * turns,
                z_m,
                slopes_m: pitch_m.map(|m| m / TAU),
                hand: if coil.is_right_handed { 1.0 } else { -1.0 },
                start: maths::sin_cos(coil.start_rad),
            };
            windings.push(WirePiece::new(Curve::Wound(wound), false));
            from_rad += TAU * turns;
            z_m += 0.5 * turns * (pitch_m[0] + pitch_m[1]);
        }
        let (Some(first), Some(last)) = (windings.first(), windings.last()) else { return Self { pieces: Vec::new() } };
        let (below, above) = (first.at(0.0), last.at(1.0));
        let mut pieces = leg(&coil.ends[0], below, -1.0);
        pieces.reverse();
        let above = leg(&coil.ends[1], above, 1.0);
        pieces.extend(windings);
        pieces.extend(above);
        Self { pieces }
    }

    /// Its pieces from the lower end upwards; tangents and normals are continuous.
    pub fn pieces(&self) -> &[WirePiece] {
        &self.pieces
    }

    /// Its length, m.
    pub fn length_m(&self) -> f64 {
        self.pieces.iter().map(WirePiece::length_m).sum()
    }

    /// How far the surface of a wire of this radius (m) reaches in a direction, m: the greatest of `c·e + r √(1 − (t·e)²)`.
    pub(super) fn reach_m(&self, towards: Vector, wire_radius_m: f64) -> f64 {
        let of = |station: &WireStation| {
            let across = cross(station.tangent, towards);
            dot(station.point_m, towards) + wire_radius_m * norm(across)
        };
        let one = |piece: &WirePiece| {
            let parts = parts(piece);
            let at = |k: f64| of(&piece.at((k / parts).clamp(0.0, 1.0)));
            let mut best = (0.0, at(0.0));
            let mut k = 1.0;
            while k <= parts {
                let value = at(k);
                best = if value > best.1 { (k, value) } else { best };
                k += 1.0;
            }
            // By thirds around the best.
            let (mut low, mut high) = (best.0 - 1.0, best.0 + 1.0);
            for _ in 0..60 {
                let third = (high - low) / 3.0;
                if at(low + third) < at(high - third) { low += third } else { high -= third }
            }
            at(0.5 * (low + high)).max(best.1)
        };
        self.pieces.iter().map(one).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Parts of a piece between which nothing is missed: 48 in a turn.
fn parts(piece: &WirePiece) -> f64 {
    (48.0 * piece.turned_rad() / TAU).ceil().max(1.0)
}

/// The leg at an end, from the windings outwards, with its pieces passed upwards. `sign` is −1 at the lower end.
fn leg(end: &CoilEnd, station: WireStation, sign: f64) -> Vec<WirePiece> {
    let WireStation { point_m, normal, .. } = station;
    let tangent = scaled(station.tangent, sign);
    let is_reversed = sign < 0.0;
    let straight = |from, tangent, normal, length_m| WirePiece::new(Curve::Straight { from, tangent, normal, length_m }, is_reversed);
    let (direction, bend_m, length_m) = match *end {
        CoilEnd::Cut => return Vec::new(),
        CoilEnd::Tangential { length_m } => return vec![straight(point_m, tangent, normal, length_m)],
        CoilEnd::Axial { bend_m, length_m } => ([0.0, 0.0, sign], bend_m, length_m),
        CoilEnd::Outward { bend_m, length_m } => (normal, bend_m, length_m),
        CoilEnd::Inward { bend_m, length_m } => (scaled(normal, -1.0), bend_m, length_m),
    };
    let (forward, aside) = (dot(tangent, direction), norm(cross(tangent, direction)));
    let angle_rad = maths::atan2(aside, forward).min(PI);
    let towards = unit(along(direction, tangent, -forward));
    let bend = WirePiece::new(Curve::Bend { from: point_m, tangent, towards, normal, radius_m: bend_m, angle_rad }, is_reversed);
    let end = bend.at(if is_reversed { 0.0 } else { 1.0 });
    vec![bend, straight(end.point_m, direction, end.normal, length_m)]
}
