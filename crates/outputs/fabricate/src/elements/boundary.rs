//! The boundary of what is elastic: the outline without the grips.

use forcewright_curves::vector::{cross, dot, norm, sub};

use crate::elements::curve::Smooth;
use crate::error::Problem;
use crate::shape::{Point, Shape};

/// Points of a grip's border may be off it by this share of its size.
const OFF: f64 = 1e-6;
/// A fillet touches a border at no angle: its tip is left out where it is lower than this share of an element.
const TIP: f64 = 0.25;
/// More corners than any sensible boundary has.
const MOST_CORNERS: f64 = 1e5;

/// A convex region that moves as one, mm, counterclockwise.
#[derive(Clone, Debug)]
pub(crate) struct Region {
    pub(crate) corners: Vec<Point>,
}

impl Region {
    /// Unit vectors along its sides.
    fn sides(&self) -> impl Iterator<Item = (Point, Point, f64)> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(from, to)| {
            let along = sub(*to, *from);
            let length = norm(along);
            (*from, along.map(|x| x / length), length)
        })
    }

    fn off(&self) -> f64 {
        OFF * self.sides().map(|side| side.2).sum::<f64>()
    }

    /// Whether all points lie in it, or off it by no more than that.
    fn contains(&self, points: &[Point], off: f64) -> bool {
        points.iter().all(|p| self.is_near(*p, off))
    }

    fn is_near(&self, p: Point, off: f64) -> bool {
        self.sides().all(|(from, along, _)| cross(along, sub(p, from)) >= -off)
    }

    /// The place of its border nearest to a point, and how far along the border it is from the first corner.
    fn on_border(&self, p: Point) -> (Point, f64) {
        let (mut before, mut best) = (0.0, (f64::INFINITY, p, 0.0));
        for (from, along, length) in self.sides() {
            let t = dot(along, sub(p, from)).clamp(0.0, length);
            let place = [from[0] + t * along[0], from[1] + t * along[1]];
            let gap = norm(sub(p, place));
            if gap < best.0 {
                best = (gap, place, before + t);
            }
            before += length;
        }
        (best.1, best.2)
    }
}

/// A piece of a boundary between two of its corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub(super) ends: [usize; 2],
    /// The curve that it stands for, and from where to where.
    pub(super) curve: usize,
    pub(super) range: [f64; 2],
    /// The grip on whose border it lies.
    pub(super) grip: Option<usize>,
}

/// Closed boundaries as corners and sides, material to the left.
#[derive(Debug, Default)]
pub(super) struct Elastic {
    pub(super) corners: Vec<Point>,
    pub(super) curves: Vec<Smooth>,
    pub(super) sides: Vec<Side>,
}

/// The grip that covers each side of a closed boundary, or the tip of a fillet on it.
fn covered(places: &[[Point; 3]], grips: &[Region], tip: f64) -> Vec<Option<usize>> {
    let mut covering: Vec<Option<usize>> =
        places.iter().map(|points| grips.iter().position(|grip| grip.contains(points, grip.off()))).collect();
    let count = places.len();
    let strictly = covering.clone();
    for step in [1, count - 1] {
        for start in (0..count).filter(|k| strictly[*k].is_some()) {
            let Some(grip) = strictly[start] else { continue };
            let mut k = (start + step) % count;
            while covering[k].is_none() && grips[grip].contains(&places[k], tip) {
                covering[k] = Some(grip);
                k = (k + step) % count;
            }
        }
    }
    covering
}

/// Where the outline enters or leaves a grip.
struct Crossing {
    grip: usize,
    corner: usize,
    enters: bool,
}

impl Elastic {
    /// The boundary in sides no longer than `longest` mm.
    pub(super) fn new(shape: &Shape, grips: &[Region], longest: f64) -> Result<Self, Problem> {
        let mut made = Self::default();
        let mut crossings = Vec::new();
        for each in shape.loops() {
            made.add_loop(each.edges.iter().map(Smooth::of), grips, longest, &mut crossings)?;
        }
        made.close(grips, longest, &crossings)?;
        if made.sides.is_empty() {
            return Err(Problem::Mesh { what: "nothing lies between its grips" });
        }
        Ok(made)
    }

    /// The sides of a closed curve that no grip covers, and where it enters and leaves grips.
    fn add_loop(
        &mut self,
        curves: impl Iterator<Item = Smooth>,
        grips: &[Region],
        longest: f64,
        crossings: &mut Vec<Crossing>,
    ) -> Result<(), Problem> {
        let mut all = Vec::new();
        for curve in curves {
            let parts = curve.parts(longest);
            if self.corners.len() as f64 + parts > MOST_CORNERS {
                return Err(Problem::Mesh { what: "its boundary has too many elements; larger ones would do" });
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive and limited")]
            let count = parts as usize;
            let share = |k: usize| k as f64 / parts;
            all.extend((0..count).map(|k| (self.curves.len(), [share(k), share(k + 1)])));
            self.curves.push(curve);
        }
        let at = |curves: &[Smooth], curve: usize, t: f64| curves[curve].at(t);
        let places: Vec<[Point; 3]> =
            all.iter().map(|&(curve, [a, b])| [a, f64::midpoint(a, b), b].map(|t| at(&self.curves, curve, t))).collect();
        let covering = covered(&places, grips, TIP * longest);
        // A corner for each end of a side that is kept.
        let before = |k: usize| covering[(k + all.len() - 1) % all.len()];
        let corner: Vec<Option<usize>> = (0..all.len())
            .map(|k| {
                (covering[k].is_none() || before(k).is_none()).then(|| {
                    self.corners.push(at(&self.curves, all[k].0, all[k].1[0]));
                    self.corners.len() - 1
                })
            })
            .collect();
        for (k, &(curve, range)) in all.iter().enumerate() {
            match (before(k), covering[k], corner[k]) {
                (None, Some(grip), Some(corner)) => crossings.push(Crossing { grip, corner, enters: true }),
                (Some(grip), None, Some(corner)) => crossings.push(Crossing { grip, corner, enters: false }),
                _ => {}
            }
            if let (None, Some(from), Some(to)) = (covering[k], corner[k], corner[(k + 1) % all.len()]) {
                self.sides.push(Side { ends: [from, to], curve, range, grip: None });
            }
        }
        Ok(())
    }

    /// The borders of grips from where the outline enters to where it leaves, clockwise: what is elastic lies to the left.
    fn close(&mut self, grips: &[Region], longest: f64, crossings: &[Crossing]) -> Result<(), Problem> {
        for enter in crossings.iter().filter(|crossing| crossing.enters) {
            let grip = &grips[enter.grip];
            let border: f64 = grip.sides().map(|side| side.2).sum();
            let (foot, start) = grip.on_border(self.corners[enter.corner]);
            let clockwise = |p: Point| {
                let way = start - grip.on_border(p).1;
                if way < 0.0 { way + border } else { way }
            };
            let leaves = crossings.iter().filter(|crossing| crossing.grip == enter.grip && !crossing.enters);
            let nearest = leaves.min_by(|a, b| clockwise(self.corners[a.corner]).total_cmp(&clockwise(self.corners[b.corner])));
            let Some(leave) = nearest else {
                return Err(Problem::Mesh { what: "a grip is not left where it was entered" });
            };
            let end = self.corners[leave.corner];
            let (way, off) = (clockwise(end), grip.off());
            let mut stops: Vec<(f64, Point)> = grip.corners.iter().map(|p| (clockwise(*p), *p)).collect();
            stops.retain(|corner| corner.0 > off && corner.0 < way - off);
            stops.sort_by(|a, b| a.0.total_cmp(&b.0));
            // A tip that is left out leaves a step to the border.
            let steps = |p: Point| norm(sub(grip.on_border(p).0, p)) > off;
            let mut from = enter.corner;
            if steps(self.corners[from]) {
                from = self.add_line(from, None, foot, None, longest);
            }
            for (_, to) in stops {
                from = self.add_line(from, None, to, Some(enter.grip), longest);
            }
            if steps(end) {
                from = self.add_line(from, None, grip.on_border(end).0, Some(enter.grip), longest);
                self.add_line(from, Some(leave.corner), end, None, longest);
            } else {
                self.add_line(from, Some(leave.corner), end, Some(enter.grip), longest);
            }
        }
        Ok(())
    }

    /// A straight line in equal sides, from a corner to another or to a new one. Gives the last corner.
    fn add_line(&mut self, from: usize, known: Option<usize>, to: Point, grip: Option<usize>, longest: f64) -> usize {
        let line = Smooth::Line(self.corners[from], to);
        let parts = line.parts(longest).min(MOST_CORNERS);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive and limited")]
        let count = parts as usize;
        let curve = self.curves.len();
        let mut last = from;
        for k in 0..count {
            let range = [k as f64 / parts, (k + 1) as f64 / parts];
            let next = known.filter(|_| k + 1 == count).unwrap_or_else(|| {
                self.corners.push(line.at(range[1]));
                self.corners.len() - 1
            });
            self.sides.push(Side { ends: [last, next], curve, range, grip });
            last = next;
        }
        self.curves.push(line);
        last
    }
}
