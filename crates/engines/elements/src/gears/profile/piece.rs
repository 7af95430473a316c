//! The pieces of a drawn tooth as functions of a parameter in [0, 1], with two derivatives.

use forcewright_base::maths::{sin_cos, tan};
use forcewright_base::roots;
use forcewright_curves::fit::Oriented;
use forcewright_curves::plane::{CurvePoint, PlaneCurve};
use forcewright_curves::vector::{Vector, add, angle, left, norm, scale, unit};

/// What a piece of a tooth is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// Arc of the tip circle.
    Tip,
    /// Flank with tip relief.
    Relief,
    /// Involute flank.
    Flank,
    /// Between flank and root circle.
    Fillet,
    /// Arc of the root circle.
    Root,
}

/// A piece of a tooth, on the side that faces counterclockwise; the parameter runs from 0 towards the tip to 1 towards the root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// What it is.
    pub region: Region,
    pub(super) curve: Curve,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Curve {
    Arc(Arc),
    Flank(Flank),
    Trochoid(Trochoid),
}

/// Part of a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arc {
    pub(super) centre_m: Vector,
    pub(super) radius_m: f64,
    /// Directions from the centre at both ends, rad.
    pub(super) angles_rad: [f64; 2],
}

/// Part of an involute, perhaps relieved: `P = r_b e(θ) + s w e⊥(θ)` with `θ = ψ_b − (s w + c(w))/r_b`, s = 1 for an external gear and −1 for
/// a ring. w is the length of the tangent from the base circle to the point, so r² = `r_b`² + w²; c turns the point into the tooth by what is
/// taken off along that tangent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flank {
    /// s.
    pub(super) outwards: f64,
    pub(super) base_radius_m: f64,
    /// Half of the angle that the tooth takes at the base circle, `ψ_b`.
    pub(super) half_base_rad: f64,
    /// w at both ends, the tip first.
    pub(super) lengths_m: [f64; 2],
    /// What is taken off.
    pub(super) relief: Option<Relief>,
}

/// Taken off along the tangent to the base circle: nothing at one length of it, the amount at another, linear or parabolic between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Relief {
    pub(super) start_m: f64,
    pub(super) end_m: f64,
    pub(super) amount_m: f64,
    pub(super) parabolic: bool,
}

/// Envelope of the rounded tip of a rack, in the coordinates of the space that it cuts: the space lies about the x axis, and the flank at its
/// side of positive y. Parameter is the angle β of the common normal to the pitch line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trochoid {
    /// Reference radius, m.
    pub(super) radius_m: f64,
    /// Radius of the rounding ρ, m.
    pub(super) rounding_m: f64,
    /// Centre of the rounding: above the pitch line, and sideways from the middle of the space, m.
    pub(super) centre_m: Vector,
    /// β at both ends, the tip first.
    pub(super) angles_rad: [f64; 2],
    /// Half a pitch: from the middle of the space to the middle of the tooth, rad.
    pub(super) half_pitch_rad: f64,
}

fn e(angle_rad: f64) -> Vector {
    let (sin, cos) = sin_cos(angle_rad);
    [cos, sin]
}

impl PlaneCurve for Piece {
    fn range(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    fn at(&self, parameter: f64) -> CurvePoint {
        match &self.curve {
            Curve::Arc(arc) => arc.at(parameter),
            Curve::Flank(flank) => flank.at(parameter),
            Curve::Trochoid(trochoid) => trochoid.at(parameter),
        }
    }
}

impl Piece {
    /// Radii at its ends, m, the tip first.
    pub fn radii_m(&self) -> [f64; 2] {
        [0.0, 1.0].map(|u| norm(self.at(u).point_m))
    }

    /// Place and direction of the growing parameter, the latter also where the speed vanishes.
    pub(super) fn oriented(&self, parameter: f64) -> Oriented {
        let place = self.at(parameter);
        Oriented { point_m: place.point_m, tangent: unit(place.first_m) }
    }

    /// Half of the angle that the tooth takes at a radius (m) between the radii of the ends, rad. All pieces but the arcs of tip and root
    /// rise or fall all the way.
    pub(super) fn half_angle_rad(&self, radius_m: f64) -> f64 {
        match &self.curve {
            Curve::Flank(flank) => flank.half_angle_rad(radius_m),
            Curve::Arc(arc) => arc.polar_at_rad(radius_m),
            Curve::Trochoid(trochoid) => {
                let [tip, root] = trochoid.angles_rad;
                let miss = |beta: f64| norm(trochoid.in_space(beta).point_m) - radius_m;
                let beta = roots::root(miss, tip, root, 0.0).unwrap_or(if miss(tip) < 0.0 { tip } else { root });
                trochoid.half_pitch_rad - angle([1.0, 0.0], trochoid.in_space(beta).point_m)
            }
        }
    }
}

impl Arc {
    fn at(&self, u: f64) -> CurvePoint {
        let [from, to] = self.angles_rad;
        let sweep = to - from;
        let out = e(from + sweep * u);
        CurvePoint {
            point_m: add(self.centre_m, scale(out, self.radius_m)),
            first_m: scale(left(out), sweep * self.radius_m),
            second_m: scale(out, -sweep * sweep * self.radius_m),
        }
    }

    /// Direction of the place at a distance from the origin, for an arc that lies on the far side of its centre with growing polar angle.
    fn polar_at_rad(&self, radius_m: f64) -> f64 {
        let far = norm(self.centre_m);
        if far <= 0.0 {
            return self.angles_rad[1];
        }
        let towards = angle([1.0, 0.0], self.centre_m);
        // Law of cosines for the angle at the origin.
        let cos = (far * far + radius_m * radius_m - self.radius_m * self.radius_m) / (2.0 * far * radius_m);
        towards - forcewright_base::maths::acos(cos.clamp(-1.0, 1.0))
    }
}

impl Relief {
    /// c with its first two derivatives by w.
    fn at(&self, length_m: f64) -> [f64; 3] {
        let span = self.end_m - self.start_m;
        let t = (length_m - self.start_m) / span;
        if self.parabolic {
            [self.amount_m * t * t, 2.0 * self.amount_m * t / span, 2.0 * self.amount_m / (span * span)]
        } else {
            [self.amount_m * t, self.amount_m / span, 0.0]
        }
    }
}

impl Flank {
    /// w at a parameter: r² changes evenly, and so does the length of arc without relief.
    fn length_m(&self, u: f64) -> f64 {
        let [tip, root] = self.lengths_m;
        (tip * tip + u * (root * root - tip * tip)).max(0.0).sqrt()
    }

    fn at(&self, u: f64) -> CurvePoint {
        let Self { outwards: s, base_radius_m: base, half_base_rad, lengths_m: [tip, root], relief } = *self;
        let w = self.length_m(u);
        let [c, c1, c2] = relief.map_or([0.0; 3], |relief| relief.at(w));
        let out = e(half_base_rad - (s * w + c) / base);
        let across = left(out);
        // By w, θ' = −(s + c')/r_b: P' = (w/r_b)(1 + s c') e − c' e⊥.
        let turn = -(s + c1) / base;
        let [along, aside] = [w / base * (1.0 + s * c1), -c1];
        // Divided by w, as w dw/du is what is even: a flank from the base circle on has a direction there.
        let even = 0.5 * (root * root - tip * tip);
        let first = if w > 0.0 { add(scale(out, along / w), scale(across, aside / w)) } else { scale(out, 1.0 / base) };
        // d/dw of the components, and their turning with θ.
        let second_by_w = add(scale(out, (1.0 + s * c1) / base + w / base * s * c2 - aside * turn), scale(across, -c2 + along * turn));
        let first_by_w = scale(first, w);
        // w'' = −even²/w³.
        let second = add(scale(second_by_w, even * even / (w * w)), scale(first_by_w, -even * even / (w * w * w)));
        CurvePoint { point_m: add(scale(out, base), scale(across, s * w)), first_m: scale(first, even), second_m: second }
    }

    fn half_angle_rad(&self, radius_m: f64) -> f64 {
        let base = self.base_radius_m;
        let w = (radius_m * radius_m - base * base).max(0.0).sqrt();
        let c = self.relief.map_or(0.0, |relief| relief.at(w)[0]);
        self.half_base_rad - (self.outwards * w + c) / base + self.outwards * forcewright_base::maths::atan2(w, base)
    }
}

impl Trochoid {
    /// By β, in the coordinates of the space: `P = e^{−iφ}(r + η + iλ + ρ n)`, n = i `e^{iβ}`, λ = −η cot β, φ = (λ − ξ)/r; the normal n
    /// passes through the pitch point, so `P' = e^{−iφ} i n g` with g = ρ − η/(r sin²β) (ρ − η/sin β).
    pub(super) fn in_space(&self, beta: f64) -> CurvePoint {
        let Self { radius_m: r, rounding_m: rho, centre_m: [eta, xi], .. } = *self;
        let (sin, cos) = sin_cos(beta);
        let lambda = -eta * cos / sin;
        let back = e((xi - lambda) / r);
        let turned = |[x, y]: Vector| add(scale(back, x), scale(left(back), y));
        let point_m = turned([r + eta - rho * sin, lambda + rho * cos]);
        let tangent = turned([-cos, -sin]);
        let speed = rho - eta / (r * sin * sin) * (rho - eta / sin);
        let change = cos * eta / (r * sin * sin * sin) * (2.0 * rho - 3.0 * eta / sin);
        // The tangent turns by 1 − φ'.
        let turn = 1.0 - eta / (r * sin * sin);
        let second_m = add(scale(tangent, change), scale(left(tangent), speed * turn));
        CurvePoint { point_m, first_m: scale(tangent, speed), second_m }
    }

    /// In the coordinates of the tooth, whose middle is the x axis: mirrored, and turned by half a pitch.
    fn at(&self, u: f64) -> CurvePoint {
        let [tip, root] = self.angles_rad;
        let span = root - tip;
        let CurvePoint { point_m, first_m, second_m } = self.in_space(tip + span * u);
        let turned = e(self.half_pitch_rad);
        let image = |[x, y]: Vector| add(scale(turned, x), scale(left(turned), -y));
        CurvePoint { point_m: image(point_m), first_m: scale(image(first_m), span), second_m: scale(image(second_m), span * span) }
    }

    /// Polar angle of a place, from the middle of the space, rad.
    pub(super) fn polar_rad(&self, beta: f64) -> f64 {
        angle([1.0, 0.0], self.in_space(beta).point_m)
    }

    /// Whether the envelope has no cusp: g > 0 for η ≤ 0, and for any η if ρ < 4 r sin β, which suffices.
    pub(super) fn is_regular(&self) -> bool {
        let [tip, _] = self.angles_rad;
        self.centre_m[0] <= 0.0 || self.rounding_m < 4.0 * self.radius_m * sin_cos(tip).0
    }

    /// Whether it has any length.
    pub(super) fn has_length(&self) -> bool {
        self.rounding_m > 0.0 || self.centre_m[0].abs() > 1e-12 * self.radius_m
    }
}

/// Where the straight flank of a rack ends, `w = r sin α + η/sin α`, by the height of that end above the pitch line, m.
pub(super) fn first_length_m(radius_m: f64, alpha_rad: f64, height_m: f64) -> f64 {
    let (sin, _) = sin_cos(alpha_rad);
    radius_m * sin + height_m / sin
}

/// Centre of the rounding at the tip of a rack: below the datum line and sideways from the middle of its tooth, for a depth, a radius and half
/// the thickness at the datum line, all in one unit.
pub(super) fn rounding_centre(alpha_rad: f64, depth: f64, radius: f64, half_thickness: f64) -> Vector {
    let below = depth - radius;
    let (_, cos) = sin_cos(alpha_rad);
    [below, half_thickness - below * tan(alpha_rad) - radius / cos]
}
