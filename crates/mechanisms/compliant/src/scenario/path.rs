//! Where a tip that rests on a surface is: on the surface itself, or, of a round tip, on its offset curve.

use forcewright_base::maths::hypot;
use forcewright_base::roots;

use super::profile::Profile;

/// Below this slope the tip moves along a constant height.
const FLAT: f64 = 1e-9;
/// Parts of the way in which changes of a round tip's motion are looked for.
const PARTS: usize = 512;
/// Changes found in one part before the rest of it is taken as it is.
const MOST_CHANGES: usize = 16;
/// Places of a curved piece at which the touching point is looked for before it is refined.
const SEEDS: usize = 8;

/// The tip at a position. SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Height of the tip's lowest point.
    pub height_m: f64,
    /// Slope of its way, which is that of the surface where it touches.
    pub slope: f64,
    /// Where the surface is touched.
    pub at_m: f64,
}

/// A stretch on which the tip only rises, only falls, or stays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub from_m: f64,
    pub to_m: f64,
    /// 1 rising with the position, −1 falling, 0 at a constant height.
    pub rise: f64,
    /// The piece of the profile, of a sharp tip.
    piece: usize,
}

/// The way of a tip along a surface.
#[derive(Clone, Debug)]
pub struct TipPath {
    profile: Profile,
    radius_m: f64,
    stretches: Vec<Stretch>,
}

fn rise_of(slope: f64) -> f64 {
    if slope.abs() < FLAT { 0.0 } else { slope.signum() }
}

impl TipPath {
    /// The way of a tip of a radius, m; zero is a sharp point. The surface begins and ends with its profile.
    pub fn new(profile: Profile, radius_m: f64) -> Self {
        let mut path = Self { profile, radius_m, stretches: Vec::new() };
        path.stretches = if radius_m > 0.0 { path.round() } else { path.sharp() };
        path
    }

    /// The surface.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Radius of the tip, m.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    pub(super) fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    /// The tip at a position, m; at a corner of a sharp tip's way, on its later side.
    pub fn at(&self, x: f64) -> Touch {
        if self.radius_m > 0.0 { self.touch(x) } else { self.sharp_at(self.profile.piece(x), x) }
    }

    /// The tip at a position of a stretch, m: at its ends, on its own side of a corner.
    pub(super) fn within(&self, stretch: &Stretch, x: f64) -> Touch {
        if self.radius_m > 0.0 { self.touch(x) } else { self.sharp_at(stretch.piece, x) }
    }

    fn sharp_at(&self, piece: usize, x: f64) -> Touch {
        let (height_m, slope) = self.profile.within(piece, x);
        Touch { height_m, slope, at_m: x }
    }

    /// A sharp tip: each piece of the profile is monotone.
    fn sharp(&self) -> Vec<Stretch> {
        let z = self.profile.heights_m();
        let one = |piece: usize| {
            let [from_m, to_m] = self.profile.ends_m(piece);
            Stretch { from_m, to_m, rise: rise_of((z[piece + 1] - z[piece]) / (to_m - from_m)), piece }
        };
        (0..self.profile.pieces()).map(one).collect()
    }

    /// A round tip: stretches end where it begins to rise, to fall or to stay, and where it leaves one place of the surface for another.
    fn round(&self) -> Vec<Stretch> {
        let [first, last] = self.profile.extent_m();
        // Of a narrow surface far from zero, neighbouring numbers are further apart than that.
        let smallest = (1e-12 * (last - first)).max(4.0 * f64::EPSILON * first.abs().max(last.abs()));
        let mut all = Vec::new();
        let (mut from, mut l, mut left) = (first, first, self.touch(first));
        // A stretch's own direction is that of its middle: its ends are where that is in doubt.
        let mut close = |from_m: f64, to_m: f64| {
            all.push(Stretch { from_m, to_m, rise: rise_of(self.touch(f64::midpoint(from_m, to_m)).slope), piece: 0 });
        };
        for part in 1..=PARTS {
            let r = if part == PARTS { last } else { first + (last - first) * part as f64 / PARTS as f64 };
            let right = self.touch(r);
            for _ in 0..MOST_CHANGES {
                if alike((l, left), (r, right)) || r - l <= smallest {
                    break;
                }
                let (mut a, mut b) = (l, r);
                while b - a > smallest {
                    let m = f64::midpoint(a, b);
                    if alike((l, left), (m, self.touch(m))) { a = m } else { b = m }
                }
                close(from, a);
                (from, l, left) = (b, b, self.touch(b));
            }
            (l, left) = (r, right);
        }
        close(from, last);
        all
    }

    /// A round tip: its centre is on the highest circle around a point of the surface, max over x of h(x) + √(r² − (x − s)²).
    fn touch(&self, s: f64) -> Touch {
        let r = self.radius_m;
        let mut best = self.around(s, s);
        let (low, high) = (self.profile.piece(s - r), self.profile.piece(s + r));
        for piece in low..=high {
            let [x0, x1] = self.profile.ends_m(piece);
            let (from, to) = (x0.max(s - r), x1.min(s + r));
            // No point of the piece is higher than its ends, and none nearer than `aside`: the circle falls by at least aside²/2r there.
            let aside = (from - s).max(s - to).max(0.0);
            let z = self.profile.heights_m();
            if from > to || z[piece].max(z[piece + 1]) - aside * aside / (2.0 * r) < best.height_m {
                continue;
            }
            match self.profile.straight(piece) {
                Some(slope) => best = higher(best, self.on_line(piece, slope, s)),
                None => best = self.on_curve([from, to], s).into_iter().fold(best, higher),
            }
        }
        best
    }

    /// The highest circle around a point of a straight piece.
    fn on_line(&self, piece: usize, slope: f64, s: f64) -> Touch {
        let (r, [x0, x1]) = (self.radius_m, self.profile.ends_m(piece));
        let steep = hypot(1.0, slope);
        let best = s + r * slope / steep;
        if (x0..=x1).contains(&best) {
            let z0 = self.profile.heights_m()[piece];
            // r(√(1 + slope²) − 1) without cancellation.
            return Touch { height_m: z0 + slope * (s - x0) + r * slope * slope / (1.0 + steep), slope, at_m: best };
        }
        self.around(best.clamp(x0, x1).clamp(s - r, s + r), s)
    }

    /// The tip that touches the surface at a place.
    fn around(&self, x: f64, s: f64) -> Touch {
        let (r, u) = (self.radius_m, x - s);
        let up = ((r - u) * (r + u)).max(1e-24 * r * r).sqrt();
        Touch { height_m: self.profile.height_m(x) - u * u / (r + up), slope: u / up, at_m: x }
    }

    /// The highest circles around points of a curved piece: every local maximum between seeds, refined.
    fn on_curve(&self, [from, to]: [f64; 2], s: f64) -> Vec<Touch> {
        let place = |i: usize| from + (to - from) * i as f64 / SEEDS as f64;
        let value = |x: f64| self.around(x, s).height_m;
        let heights: Vec<f64> = (0..=SEEDS).map(|i| value(place(i))).collect();
        let gain = |x: f64| self.profile.within(self.profile.piece(x), x).1 - self.around(x, s).slope;
        let mut found = Vec::new();
        for i in 0..=SEEDS {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(SEEDS));
            if heights[i] < heights[before] || heights[i] < heights[after] {
                continue;
            }
            let x = roots::root(gain, place(before), place(after), 1e-15 * self.radius_m).unwrap_or_else(|_| place(i));
            found.push(higher(self.around(place(i), s), self.around(x, s)));
        }
        found
    }
}

fn higher(a: Touch, b: Touch) -> Touch {
    if b.height_m > a.height_m { b } else { a }
}

/// Whether the tip moves alike at two positions: the same way, and the touching point has moved with it and not jumped.
fn alike((l, left): (f64, Touch), (r, right): (f64, Touch)) -> bool {
    rise_of(left.slope).total_cmp(&rise_of(right.slope)).is_eq()
        && (right.at_m - left.at_m).abs() <= 4.0 * (r - l).abs() + f64::EPSILON * r.abs()
}
