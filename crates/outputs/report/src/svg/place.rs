//! Where a label goes: beside its point, on no other text and on as little of the drawing as possible.

use forcewright_base::maths;

/// A rectangle, in drawing units, y downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Left.
    pub x0: f64,
    /// Top.
    pub y0: f64,
    /// Right.
    pub x1: f64,
    /// Bottom.
    pub y1: f64,
}

impl Rect {
    /// By its corner and size.
    pub(super) fn sized(x: f64, y: f64, width: f64, height: f64) -> Self {
        Self { x0: x, y0: y, x1: x + width, y1: y + height }
    }

    pub(super) fn width(&self) -> f64 {
        self.x1 - self.x0
    }

    pub(super) fn height(&self) -> f64 {
        self.y1 - self.y0
    }

    pub(super) fn grown(&self, by: f64) -> Self {
        Self { x0: self.x0 - by, y0: self.y0 - by, x1: self.x1 + by, y1: self.y1 + by }
    }

    /// Whether two rectangles share more than an edge.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.x0 < other.x1 && other.x0 < self.x1 && self.y0 < other.y1 && other.y0 < self.y1
    }

    /// Whether another rectangle lies inside.
    pub fn contains(&self, other: &Self) -> bool {
        self.x0 <= other.x0 && self.y0 <= other.y0 && self.x1 >= other.x1 && self.y1 >= other.y1
    }

    fn nearest(&self, p: [f64; 2]) -> [f64; 2] {
        [p[0].clamp(self.x0, self.x1), p[1].clamp(self.y0, self.y1)]
    }
}

/// The part of the segment a–b inside a rectangle (Liang and Barsky 1984), if there is any.
pub(super) fn clip(a: [f64; 2], b: [f64; 2], r: &Rect) -> Option<([f64; 2], [f64; 2])> {
    let d = [b[0] - a[0], b[1] - a[1]];
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (slope, room) in [(-d[0], a[0] - r.x0), (d[0], r.x1 - a[0]), (-d[1], a[1] - r.y0), (d[1], r.y1 - a[1])] {
        if slope.abs() < 1e-12 {
            if room < 0.0 {
                return None;
            }
        } else if slope < 0.0 {
            enter = enter.max(room / slope);
        } else {
            leave = leave.min(room / slope);
        }
    }
    let at = |t: f64| [a[0] + t * d[0], a[1] + t * d[1]];
    (enter <= leave).then(|| (at(enter), at(leave)))
}

/// Length of a segment.
pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    maths::hypot(b[0] - a[0], b[1] - a[1])
}

/// A leader from the edge of the circle around its point; nothing if it ends inside.
pub(super) fn from_edge([from, to]: [[f64; 2]; 2], radius: f64) -> Option<[[f64; 2]; 2]> {
    let part = radius / distance(from, to);
    (part < 1.0).then(|| [[0, 1].map(|i| from[i] + part * (to[i] - from[i])), to])
}

/// Where a label was put.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    /// Its box.
    pub(super) rect: Rect,
    /// A line from the point to the box, where the box is not right beside the point.
    pub(super) leader: Option<[[f64; 2]; 2]>,
}

/// Distances at which a label is tried.
const DISTANCES: [f64; 10] = [7.0, 11.0, 16.0, 24.0, 34.0, 48.0, 66.0, 90.0, 120.0, 160.0];
/// Beyond this distance a leader usually joins point and label.
pub(super) const BESIDE: f64 = 12.0;
/// Directions tried, in sixteenths of a turn from the right, counter-clockwise; the first are preferred.
const DIRECTIONS: [u8; 16] = [2, 14, 6, 10, 4, 12, 0, 8, 1, 15, 7, 9, 3, 13, 5, 11];

/// A piece of a line: ends, half thickness, how bad it is to cover it.
type Line = ([f64; 2], [f64; 2], f64, f64);

/// What is already drawn, and finds room for labels.
#[derive(Clone, Debug)]
pub(super) struct Placer {
    area: Rect,
    texts: Vec<Rect>,
    lines: Vec<Line>,
    solids: Vec<Rect>,
}

impl Placer {
    /// Room for labels inside `area`.
    pub(super) fn new(area: Rect) -> Self {
        Self { area, texts: Vec::new(), lines: Vec::new(), solids: Vec::new() }
    }

    /// Something that must never be covered.
    pub(super) fn add_text(&mut self, rect: Rect) {
        self.texts.push(rect);
    }

    /// A line of some thickness that should not be covered; `weight` is 1 for a result and less for a reference.
    pub(super) fn add_line(&mut self, points: &[[f64; 2]], thickness: f64, weight: f64) {
        self.lines.extend(points.windows(2).map(|w| (w[0], w[1], 0.5 * thickness, weight)));
    }

    /// An area that should not be covered.
    pub(super) fn add_solid(&mut self, rect: Rect) {
        self.solids.push(rect);
    }

    /// Whether a box lies inside and on no text.
    pub(super) fn can_hold(&self, rect: &Rect) -> bool {
        self.area.contains(rect) && !self.texts.iter().any(|t| t.overlaps(&rect.grown(2.0)))
    }

    /// How much of the drawing a box would cover.
    pub(super) fn covered(&self, rect: &Rect) -> f64 {
        let lines: f64 = self
            .lines
            .iter()
            .filter_map(|(a, b, half, weight)| Some((clip(*a, *b, &rect.grown(half + 2.0))?, weight)))
            .map(|((a, b), weight)| weight * (1.0 + distance(a, b)))
            .sum();
        lines + 25.0 * self.solids.iter().filter(|s| s.overlaps(rect)).count() as f64
    }

    /// Best place for a box of the given size near a point, with a leader if it is farther than `beside`; `None` if there is no room at
    /// all. The place is then taken.
    pub(super) fn place(&mut self, point: [f64; 2], width: f64, height: f64, beside: f64) -> Option<Placed> {
        let mut best: Option<(f64, Placed)> = None;
        for (d, distance) in DISTANCES.into_iter().enumerate() {
            for (preference, direction) in DIRECTIONS.into_iter().enumerate() {
                let (sin, cos) = maths::sin_cos(f64::from(direction) * std::f64::consts::PI / 8.0);
                let centre = [point[0] + cos * (distance + 0.5 * width), point[1] - sin * (distance + 0.5 * height)];
                let rect = Rect::sized(centre[0] - 0.5 * width, centre[1] - 0.5 * height, width, height);
                if !self.can_hold(&rect) {
                    continue;
                }
                let leader = self.leader(point, &rect, distance > beside);
                if leader.is_some_and(|[a, b]| self.texts.iter().any(|t| clip(a, b, t).is_some())) {
                    continue;
                }
                let cost = self.covered(&rect) + 5.0 * d as f64 + 0.2 * preference as f64;
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, Placed { rect, leader }));
                }
            }
        }
        let placed = best.map(|b| b.1).or_else(|| self.anywhere(point, width, height))?;
        self.texts.push(placed.rect);
        if let Some(leader) = placed.leader {
            self.add_line(&leader, 1.0, 1.0);
        }
        Some(placed)
    }

    fn leader(&self, point: [f64; 2], rect: &Rect, wanted: bool) -> Option<[[f64; 2]; 2]> {
        (wanted && self.area.grown(1.0).contains(&Rect::sized(point[0], point[1], 0.0, 0.0))).then(|| {
            // Boxes are upper bounds: the text itself begins a little inside.
            let inset = 0.06 * rect.width();
            [point, Rect { x0: rect.x0 + inset, x1: rect.x1 - inset, ..*rect }.nearest(point)]
        })
    }

    /// The nearest free place on a coarse grid, for crowded drawings.
    fn anywhere(&self, point: [f64; 2], width: f64, height: f64) -> Option<Placed> {
        let mut best: Option<(f64, Rect)> = None;
        let mut y = self.area.y0;
        while y + height <= self.area.y1 {
            let mut x = self.area.x0;
            while x + width <= self.area.x1 {
                let rect = Rect::sized(x, y, width, height);
                let cost = distance(point, rect.nearest(point));
                if best.is_none_or(|(least, _)| cost < least) && self.can_hold(&rect) {
                    best = Some((cost, rect));
                }
                x += 12.0;
            }
            y += 12.0;
        }
        best.map(|(far, rect)| Placed { rect, leader: self.leader(point, &rect, far > BESIDE) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_are_clipped() {
        let r = Rect::sized(0.0, 0.0, 10.0, 10.0);
        assert_eq!(clip([-5.0, 5.0], [15.0, 5.0], &r), Some(([0.0, 5.0], [10.0, 5.0])));
        assert_eq!(clip([-5.0, 11.0], [15.0, 11.0], &r), None);
        assert!(clip([-1.0, 2.0], [2.0, -1.5], &r).is_some());
        assert!(clip([-3.0, 2.0], [2.0, -3.0], &r).is_none());
    }

    #[test]
    fn a_leader_begins_outside_its_circle() {
        let [from, to] = from_edge([[1.0, 2.0], [4.0, 6.0]], 2.5).unwrap();
        assert!(distance(from, [2.5, 4.0]) < 1e-12 && distance(to, [4.0, 6.0]) < 1e-12);
        assert!(from_edge([[1.0, 2.0], [4.0, 6.0]], 5.5).is_none() && from_edge([[0.0; 2]; 2], 1.0).is_none());
    }

    #[test]
    fn many_labels_at_one_point_do_not_overlap() {
        let mut placer = Placer::new(Rect::sized(0.0, 0.0, 300.0, 200.0));
        let placed: Vec<Rect> = (0..12).filter_map(|_| placer.place([150.0, 100.0], 40.0, 14.0, BESIDE)).map(|p| p.rect).collect();
        assert_eq!(placed.len(), 12);
        for (i, a) in placed.iter().enumerate() {
            assert!(placed[i + 1..].iter().all(|b| !a.overlaps(b)));
        }
        assert!(placer.place([0.0, 0.0], 301.0, 10.0, BESIDE).is_none());
        assert!(placer.place([f64::NAN, 0.0], 30.0, 10.0, BESIDE).is_none_or(|p| p.rect.x0.is_finite()));
    }

    #[test]
    fn a_label_keeps_off_lines() {
        let mut placer = Placer::new(Rect::sized(0.0, 0.0, 300.0, 200.0));
        placer.add_line(&[[0.0, 200.0], [300.0, 0.0]], 2.0, 1.0);
        let placed = placer.place([150.0, 100.0], 40.0, 14.0, BESIDE).unwrap();
        assert!(placer.covered(&placed.rect) < 1e-9);
    }
}
