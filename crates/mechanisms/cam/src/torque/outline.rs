//! The outline of the disc: two lobes, and between them what no roller uses.
//!
//! A lobe is the path of the roller offset by its radius. From its end the outline goes over a nose, where there is much room along a
//! circle about the shaft, then straight, and into a seat in which the roller of the other lobe rests at the start. All pieces share their
//! tangents; the only corner is that of an undercut. The outline is passed clockwise about the shaft, as the path is.

use std::f64::consts::PI;

use forcewright_base::maths;
use forcewright_curves::Segment;

use super::mechanism::Mechanism;
use crate::path::{Place, Vector, frame};

/// Radius of the nose, in roller radii.
const NOSE: f64 = 0.3;
/// Radius of the seat, in roller radii: a little more than the roller needs.
const SEAT: f64 = 1.05;
/// Angles about the shaft over which the outline may go straight, degrees, the first that fits: a longer line would come near the shaft, and
/// a long one to a lobe that rises little would come into the seat from below.
const STRAIGHT_DEG: [f64; 7] = [80.0, 60.0, 40.0, 20.0, 10.0, 5.0, 2.0];
/// Places of a lobe, and of each piece between lobes, that are looked at.
const LOOKS: u32 = 120;

/// What lies between the end of a lobe and the start of the other.
#[derive(Clone, Debug)]
pub(crate) struct Closing {
    /// Where the lobe ends and this begins, m.
    pub from_m: Vector,
    /// Its pieces; the last one ends where the other lobe begins.
    pub segments: Vec<Segment>,
}

/// λ of the start: where the roller stands while the disc is not turned, or as near to that as it comes.
pub(crate) fn start_m(mechanism: &Mechanism) -> f64 {
    let turn = mechanism.cut.purpose().turn_rad;
    let tried = (0..LOOKS).find_map(|i| mechanism.pose(turn * f64::from(i) / f64::from(4 * LOOKS)).ok());
    tried.map_or(mechanism.cut.range_m()[0], |pose| pose.lambda_m)
}

/// The surface of the cam below a place of the path.
pub(crate) fn surface(mechanism: &Mechanism, place: &Place) -> Vector {
    let [_, normal] = frame(place, mechanism.cut.sense());
    [0, 1].map(|i| place.at[i] - mechanism.roller_m * normal[i])
}

fn along(from: Vector, step: f64, direction: Vector) -> Vector {
    [from[0] + step * direction[0], from[1] + step * direction[1]]
}

fn angle([x, y]: Vector) -> f64 {
    maths::atan2(y, x)
}

fn turned([x, y]: Vector, by_rad: f64) -> Vector {
    let (sin, cos) = maths::sin_cos(by_rad);
    [cos * x - sin * y, sin * x + cos * y]
}

/// An angle in [0, 2π); rounding below zero is zero.
fn wrapped(angle_rad: f64) -> f64 {
    let whole = 2.0 * PI;
    let rest = angle_rad.rem_euclid(whole);
    if rest > whole - 1e-9 { 0.0 } else { rest }
}

/// What leads from a lobe that ends at λ to the other one; `None` where there is no room for it.
pub(crate) fn closing(mechanism: &Mechanism, start_m: f64, end_m: f64) -> Option<Closing> {
    STRAIGHT_DEG.iter().find_map(|degrees| joined(mechanism, [start_m, end_m], degrees * PI / 180.0))
}

/// The same with a straight piece over at most such an angle about the shaft.
fn joined(mechanism: &Mechanism, [start_m, end_m]: [f64; 2], straight_rad: f64) -> Option<Closing> {
    let (r, e) = (mechanism.roller_m, mechanism.springs.sense());
    let [first, last] = [start_m, end_m].map(|l| mechanism.at(l));
    let sense = mechanism.cut.sense();
    let ([t0, n0], [t1, n1]) = (frame(&first, sense), frame(&last, sense));
    let from_m = surface(mechanism, &last);
    let (nose, seat) = (NOSE * r, SEAT * r);
    let middle = along(from_m, -nose, n1);
    // The seat of the other lobe, half a turn away.
    let rest = along(first.at, seat - r, n0).map(|x| -x);
    let to_m = surface(mechanism, &first).map(|x| -x);
    let gap = wrapped(angle(middle) - angle(rest));
    let about_shaft = (gap - straight_rad).max(0.0);
    let second = turned(middle, -about_shaft);
    // The line that leaves the nose and comes to the seat: their inner tangent.
    let apart = [rest[0] - second[0], rest[1] - second[1]];
    let distance = maths::hypot(apart[0], apart[1]);
    let length = (distance * distance - (nose + seat) * (nose + seat)).max(0.0).sqrt();
    let heading = angle(apart) - e * maths::atan2(nose + seat, length);
    let away = turned([e, 0.0], heading + 0.5 * PI);
    let (leaves, comes) = (along(second, nose, away), along(rest, -seat, away));
    let into = wrapped(e * (angle(t0) + PI - heading));
    let over = if about_shaft > 0.0 {
        let level = angle(middle) - 0.5 * PI;
        [wrapped(e * (angle(t1) - level)), wrapped(e * (level - about_shaft - heading))]
    } else {
        [wrapped(e * (angle(t1) - heading)), 0.0]
    };
    if distance <= nose + seat || gap > 1.5 * PI || over.iter().any(|a| *a > PI) || into > 1.2 * PI {
        return None;
    }
    let arc = |to_m: Vector, centre_m: Vector, outwards: bool| Segment::Arc { to_m, centre_m, counterclockwise: outwards == (e < 0.0) };
    let mut segments = Vec::new();
    if about_shaft > 0.0 {
        let reach = maths::hypot(middle[0], middle[1]) + e * nose;
        let top = |at: Vector| turned([reach, 0.0], angle(at));
        segments.push(arc(top(middle), middle, true));
        segments.push(Segment::Arc { to_m: top(second), centre_m: [0.0; 2], counterclockwise: false });
    }
    segments.push(arc(leaves, second, true));
    segments.push(Segment::Line { to_m: comes });
    segments.push(arc(to_m, rest, false));
    // A piece without length is none.
    let mut before = from_m;
    segments.retain(|segment| {
        let [x, y] = [0, 1].map(|i| segment.end_m()[i] - before[i]);
        before = segment.end_m();
        maths::hypot(x, y) > 1e-9 * r
    });
    let closing = Closing { from_m, segments };
    closing.is_clear(mechanism, [start_m, end_m]).then_some(closing)
}

impl Closing {
    /// Points along it, without its first.
    pub(crate) fn points_m(&self) -> Vec<Vector> {
        let mut from = self.from_m;
        let mut all = Vec::new();
        for segment in &self.segments {
            let to = segment.end_m();
            for i in 1..=LOOKS {
                let u = f64::from(i) / f64::from(LOOKS);
                all.push(match segment {
                    Segment::Arc { centre_m, counterclockwise, .. } => {
                        let [a, b] = [from, to].map(|p| [p[0] - centre_m[0], p[1] - centre_m[1]]);
                        let sweep = angle(b) - angle(a);
                        let sweep = if *counterclockwise { wrapped(sweep) } else { -wrapped(-sweep) };
                        along(*centre_m, 1.0, turned(a, u * sweep))
                    }
                    _ => [0, 1].map(|i| from[i] + u * (to[i] - from[i])),
                });
            }
            from = to;
        }
        all
    }

    /// Whether no roller on its lobe comes into it.
    fn is_clear(&self, mechanism: &Mechanism, [start, end]: [f64; 2]) -> bool {
        let points = self.points_m();
        let free = mechanism.roller_m * (1.0 - 1e-6);
        (0..=LOOKS).all(|i| {
            let [x, y] = mechanism.at(start + (end - start) * f64::from(i) / f64::from(LOOKS)).at;
            // Both rollers; the closing of the other lobe is the same half a turn away.
            points.iter().all(|p| maths::hypot(p[0] - x, p[1] - y) >= free && maths::hypot(p[0] + x, p[1] + y) >= free)
        })
    }
}

/// Smallest and largest distance of the outline from the shaft's middle, m.
pub(crate) fn reach_m(mechanism: &Mechanism, [start, end]: [f64; 2], closing: &Closing) -> [f64; 2] {
    let lobe = (0..=4 * LOOKS).map(|i| surface(mechanism, &mechanism.at(start + (end - start) * f64::from(i) / f64::from(4 * LOOKS))));
    let all = lobe.chain(closing.points_m()).map(|[x, y]| maths::hypot(x, y));
    all.fold([f64::INFINITY, 0.0], |[least, most], d| [least.min(d), most.max(d)])
}
