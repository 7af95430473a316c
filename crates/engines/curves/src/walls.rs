//! Walls, gaps and places that a cutter does not reach, from boundaries alone.
//!
//! The circle that touches a boundary at a point, on the side of the material, and is as large as fits, has the radius
//! `min |d|²/(2 n·d)` over the vectors `d` to all other boundary points, `n` the unit normal to that side (a point of the medial axis; the
//! shrinking ball of J. Ma, S. W. Bae, S. Choi, "3D medial axis point approximation using nearest neighbors and the normal field", The
//! Visual Computer 28, 2012), and at most the radius of curvature. Where its two contacts are seen from its centre under at least 120°
//! they are the faces of a wall, and its diameter is the thickness of the wall: of a strip its width. Contacts under a smaller angle
//! belong to a corner, which is no wall. On the other side the same circles give gaps, and the largest cutter that reaches a point.

use forcewright_base::roots;

use crate::bounds::Bounds;
use crate::piece::Piece;
use crate::profile::Profile;
use crate::vector::{Vector, angle, dot, left, norm, rotate, scale, sub};

/// Sites per boundary length of all profiles together.
const SITES: f64 = 1200.0;
/// Fewest sites on a piece.
const FEWEST: usize = 4;
/// Contacts at least so far apart, in radii of the circle, are faces of a wall: 120° seen from its centre.
const OPPOSITE: f64 = 1.732_050_807_568_877_2;
/// Circles that are larger by less, relative, are the same circle.
const SAME: f64 = 1e-6;
/// Rounding of the coordinates of a point, relative to the size of all.
const ROUNDING: f64 = 4e-15;
/// Boundaries that turn by less, rad, have no corner: a cutter leaves less than 3e-6 of its radius there.
const KINK_RAD: f64 = 5e-3;
/// So near to the end of a piece, as part of it, its walls are looked at.
const BESIDE: f64 = 1e-6;
/// The narrowest places that are refined between sites.
const REFINED: usize = 16;

/// Where a boundary is: which profile, and which of its segments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Index of the profile.
    pub profile: usize,
    /// Index of its segment.
    pub segment: usize,
}

/// A narrow place of material or of the space between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Narrow {
    /// Diameter of the circle between the two faces, m.
    pub width_m: f64,
    /// Where it touches them, m.
    pub at_m: [[f64; 2]; 2],
    /// What it touches.
    pub places: [Place; 2],
}

/// Part of a boundary that a cutter cannot reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unreached {
    /// Where.
    pub place: Place,
    /// The worst point of it, m.
    pub at_m: [f64; 2],
    /// The largest radius of a cutter that reaches that point, m; 0 in a sharp corner.
    pub radius_m: f64,
}

/// The thinnest wall of the material to the left of all profiles. `None` if there are no two faces opposite each other.
///
/// Looked for at about 1200 sites of all boundaries together, and refined between them: a notch much shorter than that spacing may be
/// missed. A material wedge sharper than 60° is a wall that thins out.
pub fn thinnest_wall(profiles: &[Profile]) -> Option<Narrow> {
    Sites::new(profiles, 1.0).narrowest()
}

/// The narrowest gap between boundaries, to the right of them: what a cutter must pass. Found as [`thinnest_wall`] is; a fillet in a corner
/// of less than 60° is as narrow as twice its radius.
pub fn narrowest_gap(profiles: &[Profile]) -> Option<Narrow> {
    Sites::new(profiles, -1.0).narrowest()
}

/// Where a cutter of a radius would take material that should stay, if it were to touch the boundary there: corners that are too sharp,
/// slots that are too narrow. One entry per stretch of boundary, found at about 1200 sites of all boundaries together and in corners.
pub fn unreachable(profiles: &[Profile], cutter_radius_m: f64) -> Vec<Unreached> {
    let sites = Sites::new(profiles, -1.0);
    let mut found: Vec<Unreached> = Vec::new();
    for profile in 0..profiles.len() {
        let probes = sites.probes(profile);
        let missed = |probe: &Unreached| probe.radius_m < cutter_radius_m * (1.0 - SAME);
        // Begin where the cutter reaches, so that no stretch is cut in two.
        let first = probes.iter().position(|probe| !missed(probe)).unwrap_or(0);
        let in_turn = probes[first..].iter().chain(&probes[..first]);
        let mut going = false;
        for probe in in_turn {
            match found.last_mut() {
                Some(worst) if going && missed(probe) && probe.radius_m < worst.radius_m => *worst = *probe,
                _ if !going && missed(probe) => found.push(*probe),
                _ => {}
            }
            going = missed(probe);
        }
    }
    found
}

/// What a circle may touch: a smooth piece, or the corner at its end, where the normal turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Piece(usize),
    Corner(usize),
}

/// A point of the boundary, by a parameter in [0, 1] along the piece or round the corner.
struct Site {
    kind: Kind,
    x: f64,
    /// Distance of parameters to the neighbours.
    step: f64,
    point: Vector,
}

struct Sites {
    pieces: Vec<(Place, Piece)>,
    /// The piece that follows on the same profile.
    next: Vec<usize>,
    all: Vec<Site>,
    /// 1 for the side of the material, −1 for the other.
    sign: f64,
    extent_m: f64,
}

/// A boundary point with the unit normal to the side that is looked at.
struct Foot {
    point: Vector,
    normal: Vector,
    /// Curvature towards that side, 1/m.
    curvature_per_m: f64,
}

struct Circle {
    radius_m: f64,
    /// Its other contact, and how far that is.
    contact: (Kind, Vector),
    apart_m: f64,
}

impl Sites {
    fn new(profiles: &[Profile], sign: f64) -> Self {
        let (mut pieces, mut next) = (Vec::new(), Vec::new());
        for (profile, curve) in profiles.iter().enumerate() {
            let first = pieces.len();
            let drawn = curve.pieces().filter(|(_, piece)| piece.length() > 0.0);
            pieces.extend(drawn.map(|(segment, piece)| (Place { profile, segment }, piece)));
            next.extend(first + 1..pieces.len());
            if pieces.len() > first {
                next.push(first);
            }
        }
        let extent_m = profiles.iter().fold(Bounds::of([]), |all, profile| all.union(profile.bounds())).extent_m();
        let mut sites = Self { pieces, next, all: Vec::new(), sign, extent_m };
        let lengths: Vec<f64> = sites.pieces.iter().map(|(_, piece)| piece.length()).collect();
        let spacing_m = lengths.iter().sum::<f64>() / SITES;
        for (k, length) in lengths.into_iter().enumerate() {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a part of the number of sites")]
            let count = ((length / spacing_m).ceil() as usize).max(FEWEST);
            sites.place_on(Kind::Piece(k), count);
            // Only corners that point to the side looked at are touched by more than one circle.
            if sign * sites.turn(k) < -KINK_RAD {
                sites.place_on(Kind::Corner(k), 2 * FEWEST);
            }
        }
        sites
    }

    fn place_on(&mut self, kind: Kind, count: usize) {
        let step = 1.0 / count as f64;
        for k in 0..count {
            let x = (k as f64 + 0.5) * step;
            let point = self.at(kind, x).point;
            self.all.push(Site { kind, x, step, point });
        }
    }

    /// The angle, rad, by which the boundary turns at the end of a piece, positive to the left.
    fn turn(&self, piece: usize) -> f64 {
        angle(self.pieces[piece].1.tangent(1.0), self.pieces[self.next[piece]].1.tangent(0.0))
    }

    fn at(&self, kind: Kind, x: f64) -> Foot {
        match kind {
            Kind::Piece(k) => {
                let piece = &self.pieces[k].1;
                let normal = scale(left(piece.tangent(x)), self.sign);
                Foot { point: piece.point(x), normal, curvature_per_m: self.sign * piece.curvature(x) }
            }
            Kind::Corner(k) => {
                let tangent = rotate(self.pieces[k].1.tangent(1.0), x * self.turn(k));
                Foot { point: self.pieces[k].1.to(), normal: scale(left(tangent), self.sign), curvature_per_m: f64::NEG_INFINITY }
            }
        }
    }

    fn place(&self, kind: Kind) -> Place {
        let (Kind::Piece(k) | Kind::Corner(k)) = kind;
        self.pieces[k].0
    }

    /// The largest circle that touches a point and holds no other boundary point.
    fn circle(&self, foot: &Foot) -> Option<Circle> {
        let radius = |to: Vector| {
            let height = dot(foot.normal, to);
            // Next to the point itself the height is rounding; there the curvature counts.
            let height = height - ROUNDING * self.extent_m;
            if height > 0.0 { dot(to, to) / (2.0 * height) } else { f64::INFINITY }
        };
        let tightest = if foot.curvature_per_m > 0.0 { 1.0 / foot.curvature_per_m } else { f64::INFINITY };
        let radii: Vec<f64> = self.all.iter().map(|site| radius(sub(site.point, foot.point))).collect();
        let (nearest, _) = radii.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1))?;
        let site = &self.all[nearest];
        let (mut least, mut contact) = (radii[nearest], site.point);
        if let Kind::Piece(k) = site.kind {
            let (low, high) = ((site.x - 1.5 * site.step).max(0.0), (site.x + 1.5 * site.step).min(1.0));
            let by = |x: f64| radius(sub(self.pieces[k].1.point(x), foot.point));
            let inside = roots::minimise(by, low, high, 1e-10).x;
            for x in [inside, low, high] {
                if by(x) < least {
                    (least, contact) = (by(x), self.pieces[k].1.point(x));
                }
            }
        }
        let radius_m = least.min(tightest);
        if !radius_m.is_finite() {
            return None;
        }
        // An arc of the boundary is touched along its whole length: its far end counts.
        let mut found = Circle { radius_m, contact: (site.kind, contact), apart_m: norm(sub(contact, foot.point)) };
        if least > radius_m * (1.0 + SAME) {
            found.apart_m = 0.0;
        }
        for (other, _) in self.all.iter().zip(&radii).filter(|(_, radius)| **radius <= radius_m * (1.0 + SAME)) {
            let apart_m = norm(sub(other.point, foot.point));
            if apart_m > found.apart_m {
                (found.contact, found.apart_m) = ((other.kind, other.point), apart_m);
            }
        }
        Some(found)
    }

    /// The circle of a wall at a site.
    fn wall(&self, kind: Kind, x: f64) -> Option<(Vector, Circle)> {
        let foot = self.at(kind, x);
        let circle = self.circle(&foot)?;
        (circle.apart_m >= OPPOSITE * circle.radius_m).then_some((foot.point, circle))
    }

    fn narrowest(&self) -> Option<Narrow> {
        let mut walls: Vec<(f64, usize)> = Vec::new();
        for (index, site) in self.all.iter().enumerate() {
            walls.extend(self.wall(site.kind, site.x).map(|(_, circle)| (circle.radius_m, index)));
        }
        walls.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut refined: Vec<usize> = Vec::new();
        let mut best: Option<Narrow> = None;
        for (_, index) in walls {
            if refined.iter().any(|other| other.abs_diff(index) <= 2) {
                continue;
            }
            refined.push(index);
            let site = &self.all[index];
            let radius = |x: f64| self.wall(site.kind, x).map_or(f64::NAN, |(_, circle)| circle.radius_m);
            // In a corner itself every circle is too large: no wall ends there.
            let (low, high) = ((site.x - 1.5 * site.step).max(BESIDE), (site.x + 1.5 * site.step).min(1.0 - BESIDE));
            let inside = roots::minimise(radius, low, high, 1e-8).x;
            for x in [inside, site.x, low, high] {
                let Some((point, circle)) = self.wall(site.kind, x) else { continue };
                let width_m = 2.0 * circle.radius_m;
                if best.is_none_or(|best| width_m < best.width_m) {
                    let places = [self.place(site.kind), self.place(circle.contact.0)];
                    best = Some(Narrow { width_m, at_m: [point, circle.contact.1], places });
                }
            }
            if refined.len() == REFINED {
                break;
            }
        }
        best
    }

    /// The radii that reach the sites of a profile, in the order of its boundary; in sharp corners 0.
    fn probes(&self, profile: usize) -> Vec<Unreached> {
        let mut probes = Vec::new();
        for (k, (place, piece)) in self.pieces.iter().enumerate().filter(|(_, (place, _))| place.profile == profile) {
            for site in self.all.iter().filter(|site| site.kind == Kind::Piece(k)) {
                let radius_m = self.circle(&self.at(site.kind, site.x)).map_or(f64::INFINITY, |circle| circle.radius_m);
                probes.push(Unreached { place: *place, at_m: site.point, radius_m });
            }
            if self.turn(k) < -KINK_RAD {
                probes.push(Unreached { place: *place, at_m: piece.to(), radius_m: 0.0 });
            }
        }
        probes
    }
}

/// The thickness of material across an axis at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// The place on the axis.
    pub u: f64,
    /// From the axis to the boundary on its left and on its right, m.
    pub sides_m: [f64; 2],
}

impl Section {
    /// The thickness, m.
    pub fn thickness_m(&self) -> f64 {
        self.sides_m[0] + self.sides_m[1]
    }
}

/// The thickness of a part along an axis in it, straight across the axis, at the given places: from the boundaries alone, for instance
/// those read back from a file. `None` where the place does not lie in material.
///
/// ```
/// use forcewright_curves::{Profile, fit::Oriented, walls::thickness_along};
/// let plate = Profile::polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]]);
/// let axis = |u: f64| Oriented { point_m: [4.0 * u, 0.25], tangent: [1.0, 0.0] };
/// let section = thickness_along(&[plate], &axis, &[0.5])[0].expect("in the plate");
/// assert_eq!(section.sides_m, [0.75, 0.25]);
/// ```
pub fn thickness_along(profiles: &[Profile], axis: &dyn Fn(f64) -> crate::fit::Oriented, places: &[f64]) -> Vec<Option<Section>> {
    let pieces: Vec<Piece> = profiles.iter().flat_map(|profile| profile.pieces().map(|(_, piece)| piece)).collect();
    let section = |u: &f64| {
        let place = axis(*u);
        let rounds = profiles.iter().map(|profile| profile.winding(place.point_m)).sum::<Option<i32>>()?;
        if rounds <= 0 {
            return None;
        }
        let normal = left(place.tangent);
        let mut sides_m = [f64::INFINITY; 2];
        for piece in &pieces {
            for t in piece.meets_line(place.point_m, place.tangent) {
                let across = dot(normal, sub(piece.point(t), place.point_m));
                let side = usize::from(across < 0.0);
                sides_m[side] = sides_m[side].min(across.abs());
            }
        }
        (sides_m[0].is_finite() && sides_m[1].is_finite()).then_some(Section { u: *u, sides_m })
    };
    places.iter().map(section).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::OPPOSITE;

    #[test]
    fn contacts_of_a_wall_are_120_degrees_apart() {
        let seen_rad = 2.0 * forcewright_base::maths::asin(0.5 * OPPOSITE);
        assert!((seen_rad - 2.0 * PI / 3.0).abs() < 1e-14);
    }
}
