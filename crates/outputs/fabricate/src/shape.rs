//! A part that was checked, in millimetres.

use forcewright_base::maths;
use forcewright_curves::vector::{cross, dot, norm, scale, sub};
use forcewright_curves::{Profile, Segment, Spline};
use forcewright_model::{Plate, Turned};

use crate::error::{Boundary, Error, Place, Problem};

/// A point, mm.
pub(crate) type Point = [f64; 2];

/// A cubic by its Bézier points, mm.
pub(crate) type Bezier = [Point; 4];

/// Files are in millimetres.
pub(crate) const MM_PER_M: f64 = 1e3;
/// What rounding may leave open between ends that should meet, mm.
const GAP_MM: f64 = 1e-7;
/// Farthest coordinate, mm.
const FAR_MM: f64 = 1e6;

/// A segment of a closed boundary.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Edge {
    pub(crate) from: Point,
    pub(crate) to: Point,
    pub(crate) curve: Curve,
}

/// How an edge runs from its begin to its end.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Curve {
    Line,
    /// Part of a circle; counterclockwise when the sweep is positive.
    Arc {
        centre: Point,
        radius: f64,
        sweep_rad: f64,
    },
    /// Without kinks, in metres.
    Spline(Spline),
}

/// An arc by where it ends and its bulge, the tangent of a quarter of its angle; 0 is straight, positive counterclockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bulge {
    pub(crate) to: Point,
    pub(crate) bulge: f64,
}

/// A closed boundary of two edges or more, with material to its left.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Loop {
    pub(crate) boundary: Boundary,
    pub(crate) edges: Vec<Edge>,
}

/// A circle to be cut out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Circle {
    pub(crate) centre: Point,
    pub(crate) radius: f64,
}

/// What is to be made.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape {
    pub(crate) outline: Loop,
    pub(crate) cutouts: Vec<Loop>,
    pub(crate) holes: Vec<Circle>,
    pub(crate) depth: f64,
    /// Ends of the centre line of a half section; `None` for plates.
    pub(crate) axis: Option<[Point; 2]>,
}

impl Shape {
    /// Checks everything but whether boundaries meet, which is for [`crate::cap`] to see.
    pub(crate) fn new(part: &Plate) -> Result<Self, Error> {
        if !(1e-6..1e3).contains(&part.depth_m) {
            return Err(Error { place: Place::Part, problem: Problem::Depth { depth_m: part.depth_m } });
        }
        let cutout = |(index, profile)| Loop::new(Boundary::Cutout(index), profile);
        let hole = |(index, hole): (usize, &forcewright_model::Hole)| {
            let fail = |problem| Error { place: Place::Boundary(Boundary::Hole(index)), problem };
            if !(1e-6..1e3).contains(&hole.diameter_m) {
                return Err(fail(Problem::Diameter { diameter_m: hole.diameter_m }));
            }
            let centre = placed(hole.centre_m, FAR_MM).map_err(fail)?;
            Ok(Circle { centre, radius: 0.5 * hole.diameter_m * MM_PER_M })
        };
        Ok(Self {
            outline: Loop::new(Boundary::Outline, &part.outline)?,
            cutouts: part.cutouts.iter().enumerate().map(cutout).collect::<Result<_, _>>()?,
            holes: part.holes.iter().enumerate().map(hole).collect::<Result<_, _>>()?,
            depth: part.depth_m * MM_PER_M,
            axis: None,
        })
    }

    /// The half section of a turned part at the angle 0: z to the right, radii upwards, the centre line below.
    pub(crate) fn half_section(turned: &Turned) -> Result<Self, Error> {
        let profile = turned.half_section(0.0).map_err(|error| Error { place: Place::Part, problem: Problem::Turned(error) })?;
        Ok(Self {
            outline: Loop::new(Boundary::Outline, &profile)?,
            cutouts: Vec::new(),
            holes: Vec::new(),
            depth: 0.0,
            axis: Some([[0.0; 2], [turned.length_m() * MM_PER_M, 0.0]]),
        })
    }

    /// The outline and everything cut out, holes as two half circles: the outline first.
    pub(crate) fn loops(&self) -> impl Iterator<Item = Loop> {
        let holes = self.holes.iter().enumerate().map(|(index, circle)| circle.as_loop(index));
        std::iter::once(&self.outline).chain(&self.cutouts).cloned().chain(holes)
    }

    /// Least and greatest coordinates of the outline and the centre line, to a thousandth of a millimetre.
    pub(crate) fn extent(&self) -> [Point; 2] {
        let points: Vec<Point> = self.outline.points(1e-3).into_iter().chain(self.axis.into_iter().flatten()).collect();
        let bound = |of: fn(f64, f64) -> f64, start: f64| {
            points.iter().fold([start; 2], |bound, point| [of(bound[0], point[0]), of(bound[1], point[1])])
        };
        [bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY)]
    }
}

impl Circle {
    /// The boundary of a hole.
    pub(crate) fn as_loop(self, index: usize) -> Loop {
        Loop { boundary: Boundary::Hole(index), edges: self.halves(-std::f64::consts::PI) }
    }

    /// The boundary of what lies inside of it.
    pub(crate) fn as_outline(self) -> Loop {
        Loop { boundary: Boundary::Outline, edges: self.halves(std::f64::consts::PI) }
    }

    fn halves(self, sweep_rad: f64) -> Vec<Edge> {
        let Self { centre, radius } = self;
        let (right, left) = ([centre[0] + radius, centre[1]], [centre[0] - radius, centre[1]]);
        let half = |from, to| Edge { from, to, curve: Curve::Arc { centre, radius, sweep_rad } };
        vec![half(right, left), half(left, right)]
    }
}

impl Loop {
    fn new(boundary: Boundary, profile: &Profile) -> Result<Self, Error> {
        let whole = |problem| Error { place: Place::Boundary(boundary), problem };
        let start = placed(profile.start_m, FAR_MM).map_err(whole)?;
        let (mut edges, mut from) = (Vec::new(), start);
        for (index, segment) in profile.segments.iter().enumerate() {
            let fail = |problem| Error { place: Place::Segment(boundary, index), problem };
            let is_last = index + 1 == profile.segments.len();
            let added = edges_of(segment, from).map_err(fail)?;
            from = added.last().map_or(from, |edge| edge.to);
            edges.extend(added);
            if is_last {
                let gap = norm(sub(from, start));
                if gap > GAP_MM {
                    return Err(whole(Problem::NotClosed { gap_m: gap / MM_PER_M }));
                }
            }
        }
        // A closed spline alone is halved: a file wants edges with two ends.
        if let [Edge { curve: Curve::Spline(spline), .. }] = edges.as_slice() {
            let middle = 0.5 * (spline.knots[0] + spline.knots[spline.knots.len() - 1]);
            edges = spline.split(middle).ok_or_else(|| whole(Problem::SplineKnots))?.map(spline_edge).to_vec();
        }
        if edges.len() < 2 {
            return Err(whole(Problem::TooFewSegments));
        }
        if let Some(last) = edges.last_mut() {
            last.end_at(start);
        }
        let made = Self { boundary, edges };
        let made_m = made.profile();
        let (area, length) = (made_m.area_m2() * MM_PER_M * MM_PER_M, made_m.length_m() * MM_PER_M);
        if area.abs() <= GAP_MM * length {
            return Err(whole(Problem::NoArea));
        }
        if (area > 0.0) != (boundary == Boundary::Outline) {
            return Err(whole(Problem::Direction));
        }
        Ok(made)
    }

    /// The same in metres.
    fn profile(&self) -> Profile {
        Profile { start_m: metres(self.edges[0].from), segments: self.edges.iter().map(Edge::segment).collect() }
    }

    /// Corners of a polygon within `chord` mm of the boundary, all of them on it; the first edge begins at the first corner.
    pub(crate) fn points(&self, chord: f64) -> Vec<Point> {
        self.profile().tessellate(chord / MM_PER_M).into_iter().map(millimetres).collect()
    }

    /// Arcs within `chord` mm of splines, and everything else as it is, from the begin of the first edge.
    pub(crate) fn bulges(&self, chord: f64) -> Vec<Bulge> {
        let mut bulges = Vec::new();
        for edge in &self.edges {
            match &edge.curve {
                Curve::Line => bulges.push(Bulge { to: edge.to, bulge: 0.0 }),
                Curve::Arc { sweep_rad, .. } => {
                    // Readers differ on arcs beyond the half circle.
                    for (to, sweep) in edge.arc_ends(if sweep_rad.abs() > 3.2 { 2 } else { 1 }) {
                        bulges.push(Bulge { to, bulge: maths::tan(0.25 * sweep) });
                    }
                }
                Curve::Spline(spline) => {
                    spline.beziers_m().iter().for_each(|cubic| arcs_of_cubic(cubic, chord, &mut bulges));
                    if let Some(last) = bulges.last_mut() {
                        last.to = edge.to;
                    }
                }
            }
        }
        bulges
    }
}

fn metres(point: Point) -> [f64; 2] {
    point.map(|coordinate| coordinate / MM_PER_M)
}

fn millimetres(point_m: [f64; 2]) -> Point {
    scale(point_m, MM_PER_M)
}

/// Appends arcs within `chord` mm of a cubic in metres, or chords where it has no direction to keep, as in a cusp.
fn arcs_of_cubic(cubic_m: &[[f64; 2]; 4], chord: f64, out: &mut Vec<Bulge>) {
    let cubic = Spline { control_m: cubic_m.to_vec(), knots: vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0] };
    let chord_m = chord / MM_PER_M;
    // The distance is measured at places, and a tenth is left for what is between them.
    let Ok(arcs) = cubic.to_arcs(0.9 * chord_m) else {
        let chords = Profile { start_m: cubic_m[0], segments: vec![Segment::Spline(cubic)] }.tessellate(chord_m);
        let ends = chords.into_iter().skip(1).chain([cubic_m[3]]);
        return out.extend(ends.map(|to_m| Bulge { to: millimetres(to_m), bulge: 0.0 }));
    };
    let mut from_m = cubic_m[0];
    for segment in &arcs.segments {
        let to_m = segment.end_m();
        let bulge = match segment {
            Segment::Arc { centre_m, counterclockwise, .. } => {
                maths::tan(0.25 * sweep_rad(sub(from_m, *centre_m), sub(to_m, *centre_m), *counterclockwise))
            }
            _ => 0.0,
        };
        out.push(Bulge { to: millimetres(to_m), bulge });
        from_m = to_m;
    }
}

/// The angle from one spoke of a circle to another in a direction, positive counterclockwise, rad.
fn sweep_rad(from: [f64; 2], to: [f64; 2], counterclockwise: bool) -> f64 {
    let turn = maths::atan2(cross(from, to), dot(from, to));
    let full = std::f64::consts::TAU;
    match counterclockwise {
        true if turn < 0.0 => turn + full,
        false if turn > 0.0 => turn - full,
        _ => turn,
    }
}

impl Edge {
    /// The same in metres, from where the one before ends.
    fn segment(&self) -> Segment {
        let to_m = metres(self.to);
        match &self.curve {
            Curve::Line => Segment::Line { to_m },
            Curve::Arc { centre, sweep_rad, .. } => Segment::Arc { to_m, centre_m: metres(*centre), counterclockwise: *sweep_rad > 0.0 },
            Curve::Spline(spline) => Segment::Spline(spline.clone()),
        }
    }

    /// The cubics of a spline by their Bézier points, mm, from the begin of the edge to its end; none of other curves.
    pub(crate) fn beziers(&self) -> Vec<Bezier> {
        let Curve::Spline(spline) = &self.curve else { return Vec::new() };
        let mut cubics: Vec<Bezier> = spline.beziers_m().into_iter().map(|cubic| cubic.map(millimetres)).collect();
        if let Some(last) = cubics.last_mut() {
            last[3] = self.to;
        }
        cubics
    }

    /// The ends of equal parts of an arc, and the angle that each sweeps; none for other curves.
    pub(crate) fn arc_ends(&self, count: usize) -> Vec<(Point, f64)> {
        let Curve::Arc { centre, radius, sweep_rad } = self.curve else { return Vec::new() };
        let first = maths::atan2(self.from[1] - centre[1], self.from[0] - centre[0]);
        let step = sweep_rad / count as f64;
        let end = |k: usize| {
            let (sin, cos) = maths::sin_cos(first + step * k as f64);
            if k == count { self.to } else { [centre[0] + radius * cos, centre[1] + radius * sin] }
        };
        (1..=count).map(|k| (end(k), step)).collect()
    }

    /// Moves the end by what rounding left.
    fn end_at(&mut self, to: Point) {
        self.to = to;
        if let Curve::Spline(spline) = &mut self.curve
            && let Some(last) = spline.control_m.last_mut()
        {
            *last = metres(to);
        }
    }
}

/// A point in mm, if it is one.
fn placed(point_m: Point, farthest_mm: f64) -> Result<Point, Problem> {
    let point = point_m.map(|coordinate| coordinate * MM_PER_M);
    if !point.iter().all(|coordinate| coordinate.is_finite()) {
        return Err(Problem::NotFinite);
    }
    if point.iter().any(|coordinate| coordinate.abs() >= farthest_mm) {
        return Err(Problem::TooFar);
    }
    Ok(point)
}

/// The edges of a segment that begins at `from`: one, or one for each part of a spline between kinks.
fn edges_of(segment: &Segment, from: Point) -> Result<Vec<Edge>, Problem> {
    match segment {
        Segment::Line { to_m } => {
            let to = placed(*to_m, FAR_MM)?;
            if norm(sub(to, from)) <= GAP_MM {
                return Err(Problem::NoLength);
            }
            Ok(vec![Edge { from, to, curve: Curve::Line }])
        }
        Segment::Arc { to_m, centre_m, counterclockwise } => arc_edge(from, placed(*to_m, FAR_MM)?, *centre_m, *counterclockwise),
        Segment::Spline(spline) => spline_edges(spline, from),
    }
}

fn arc_edge(from: Point, to: Point, centre_m: Point, counterclockwise: bool) -> Result<Vec<Edge>, Problem> {
    let centre = placed(centre_m, 1e3 * FAR_MM)?;
    let (begin, end) = (sub(from, centre), sub(to, centre));
    let (first, last) = (norm(begin), norm(end));
    if norm(sub(to, from)) <= GAP_MM {
        return Err(Problem::NoLength);
    }
    // What the rounding of a far middle leaves is no fault of the arc.
    if (first - last).abs() > GAP_MM + 1e-14 * norm(centre) {
        return Err(Problem::NotCircular { difference_m: (first - last).abs() / MM_PER_M });
    }
    let sweep_rad = sweep_rad(begin, end, counterclockwise);
    let radius = 0.5 * (first + last);
    if radius * sweep_rad.abs() > 10.0 * FAR_MM {
        return Err(Problem::TooFar);
    }
    Ok(vec![Edge { from, to, curve: Curve::Arc { centre, radius, sweep_rad } }])
}

fn spline_edges(spline: &Spline, from: Point) -> Result<Vec<Edge>, Problem> {
    let (count, knots) = (spline.control_m.len(), &spline.knots);
    if count < 4 || knots.len() != count + 4 {
        return Err(Problem::SplineCounts { control: count, knots: knots.len() });
    }
    // Knots are scaled to [0, 1]: readers of files have absolute tolerances.
    let span = knots[count] - knots[0];
    let knots: Vec<f64> = knots.iter().map(|knot| (knot - knots[0]) / span).collect();
    if !(span.is_finite() && knots.iter().all(|knot| knot.is_finite())) {
        return Err(if span == 0.0 { Problem::SplineKnots } else { Problem::NotFinite });
    }
    let inside = &knots[4..count];
    let is_clamped = knots[3] <= 0.0 && knots[count + 3] <= 1.0;
    let is_ascending = knots.windows(2).all(|pair| pair[0] <= pair[1]);
    let is_whole = inside.windows(4).all(|four| four[0] < four[3]) && inside.iter().all(|&knot| 0.0 < knot && knot < 1.0);
    if !(is_clamped && is_ascending && is_whole) {
        return Err(Problem::SplineKnots);
    }
    let control = spline.control_m.iter().map(|&point| placed(point, FAR_MM)).collect::<Result<Vec<_>, _>>()?;
    let gap = norm(sub(control[0], from));
    if gap > GAP_MM {
        return Err(Problem::Apart { gap_m: gap / MM_PER_M });
    }
    if control.iter().all(|&point| norm(sub(point, from)) <= GAP_MM) {
        return Err(Problem::NoLength);
    }
    let mut edges = Vec::new();
    let mut rest = Spline { control_m: spline.control_m.clone(), knots };
    rest.control_m[0] = metres(from);
    while let Some(kink) = (4..rest.control_m.len().saturating_sub(2)).find(|&k| rest.knots[k] >= rest.knots[k + 2]) {
        let [low, high] = rest.split(rest.knots[kink]).ok_or(Problem::SplineKnots)?;
        edges.push(spline_edge(low));
        rest = high;
    }
    edges.push(spline_edge(rest));
    if let Some(first) = edges.first_mut() {
        first.from = from;
    }
    Ok(edges)
}

fn spline_edge(spline: Spline) -> Edge {
    let end = |point_m: Option<&[f64; 2]>| point_m.copied().map_or([f64::NAN; 2], millimetres);
    Edge { from: end(spline.control_m.first()), to: end(spline.control_m.last()), curve: Curve::Spline(spline) }
}
