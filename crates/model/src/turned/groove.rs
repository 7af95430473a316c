//! The profile of one groove in a plane through the axis.

use std::fmt;

use forcewright_base::maths;
use forcewright_curves::Segment;
use forcewright_curves::vector::{cross, distance, dot, sub};

use super::{SAME_M, TOO_LONG_M, is_length};

/// One groove and the land beside it: a chain of lines and arcs along the axis, by points (ζ, ρ) of a place along the axis and a radius.
/// It ends one spacing beyond its start and at the same radius; ζ = 0 is what is called the middle of the groove.
///
/// ζ never decreases along the chain: a tool can reach all of it from outside. Lines across the axis are allowed.
#[derive(Clone, Debug, PartialEq)]
pub struct Groove {
    /// Where the chain begins, m.
    pub start_m: [f64; 2],
    /// Two segments or more, lines and arcs, each from where the one before ends.
    pub segments: Vec<Segment>,
}

/// Why a profile is that of no groove. Segments count from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GrooveError {
    /// A measure is not what a groove can have.
    Measure {
        /// Which.
        name: &'static str,
        /// What it is, m, or rad for an angle.
        value: f64,
        /// What it must be.
        allowed: &'static str,
    },
    /// The groove is as wide as the spacing, or wider.
    NoLand {
        /// How wide it is, m.
        width_m: f64,
        /// From groove to groove, m.
        spacing_m: f64,
    },
    /// Fewer than two segments.
    TooFew,
    /// A spline, or a coordinate that is not finite or a kilometre away.
    Invalid {
        /// The segment.
        segment: usize,
    },
    /// The segment ends where it begins.
    NoLength {
        /// The segment.
        segment: usize,
    },
    /// The ends of an arc are not equally far from its middle.
    NotCircular {
        /// The segment.
        segment: usize,
        /// The difference, m.
        difference_m: f64,
    },
    /// The segment runs back along the axis, or on the one before.
    Backwards {
        /// The segment.
        segment: usize,
    },
    /// The chain does not end one spacing beyond its start at the same radius.
    Open {
        /// By how much it fails, m.
        gap_m: f64,
    },
    /// The chain begins farther from ζ = 0 than one spacing.
    Far {
        /// Where it begins, m.
        start_m: f64,
    },
}

impl fmt::Display for GrooveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Measure { name, value, allowed } => write!(f, "groove: {name} is {value}, it must be {allowed}"),
            Self::NoLand { width_m, spacing_m } => {
                write!(f, "groove: {width_m} m wide at {spacing_m} m from groove to groove, which leaves no land between")
            }
            Self::TooFew => write!(f, "groove: fewer than two segments"),
            Self::Invalid { segment } => write!(f, "groove, segment {}: neither a line nor an arc with finite numbers", segment + 1),
            Self::NoLength { segment } => write!(f, "groove, segment {}: ends where it begins", segment + 1),
            Self::NotCircular { segment, difference_m } => write!(
                f,
                "groove, segment {}: the ends of the arc are not equally far from its middle, they differ by {difference_m:e} m",
                segment + 1
            ),
            Self::Backwards { segment } => {
                write!(f, "groove, segment {}: runs back along the axis or on the one before; no tool reaches it from outside", segment + 1)
            }
            Self::Open { gap_m } => {
                write!(f, "groove: must end one spacing beyond its start at the same radius, and fails by {gap_m:e} m")
            }
            Self::Far { start_m } => write!(f, "groove: begins at {start_m} m along the axis, more than one spacing from its middle"),
        }
    }
}

impl std::error::Error for GrooveError {}

impl Groove {
    /// A round groove: an arc of the seat's radius, `depth_m` below the lands, with walls across the axis where it is deeper than that
    /// radius. Lengths in m; `radius_m` is that of the lands.
    ///
    /// # Errors
    /// [`GrooveError`] when the measures make no groove, or leave no land.
    pub fn round(radius_m: f64, spacing_m: f64, seat_radius_m: f64, depth_m: f64) -> Result<Self, GrooveError> {
        let seat = Seat::new(radius_m, spacing_m, seat_radius_m, depth_m)?;
        let arc = |chain: &mut Chain| chain.arc([seat.half_m, seat.wall_m], [0.0, seat.middle_m]);
        seat.finish(arc, radius_m, spacing_m)
    }

    /// A round groove with a slot of a width in its bottom, `slot_depth_m` deeper than the bottom of its seat. Lengths in m.
    ///
    /// # Errors
    /// [`GrooveError`] when the measures make no groove, or leave no land.
    pub fn undercut(
        radius_m: f64,
        spacing_m: f64,
        [seat_radius_m, depth_m]: [f64; 2],
        [slot_width_m, slot_depth_m]: [f64; 2],
    ) -> Result<Self, GrooveError> {
        let seat = Seat::new(radius_m, spacing_m, seat_radius_m, depth_m)?;
        let half_m = 0.5 * slot_width_m;
        if !is_length(slot_width_m) || half_m >= seat.half_m {
            return Err(measure("the width of the slot", slot_width_m, "less than that of the seat"));
        }
        let bottom_m = radius_m - depth_m - slot_depth_m;
        if !is_length(slot_depth_m) || bottom_m <= 0.0 {
            return Err(measure("the depth of the slot", slot_depth_m, "positive and end above the axis"));
        }
        let edge_m = seat.middle_m - (seat_radius_m * seat_radius_m - half_m * half_m).sqrt();
        let slotted = |chain: &mut Chain| {
            chain.arc([-half_m, edge_m], [0.0, seat.middle_m]);
            chain.line([-half_m, bottom_m]);
            chain.line([half_m, bottom_m]);
            chain.line([half_m, edge_m]);
            chain.arc([seat.half_m, seat.wall_m], [0.0, seat.middle_m]);
        };
        seat.finish(slotted, radius_m, spacing_m)
    }

    /// A vee: two flanks with an angle between them, joined by an arc of a radius at the bottom, or by a corner where that is 0.
    /// `angle_rad` lies in (0, π), `depth_m` is measured to the bottom of the arc; lengths in m.
    ///
    /// # Errors
    /// [`GrooveError`] when the measures make no groove, or leave no land.
    pub fn vee(radius_m: f64, spacing_m: f64, angle_rad: f64, bottom_radius_m: f64, depth_m: f64) -> Result<Self, GrooveError> {
        check_depth(radius_m, spacing_m, depth_m)?;
        if !(angle_rad > 1e-3 && angle_rad < std::f64::consts::PI - 1e-3) {
            return Err(measure("the angle of the vee", angle_rad, "between 0.001 and π − 0.001"));
        }
        let (sin, cos) = maths::sin_cos(0.5 * angle_rad);
        // Above the bottom, where the arc touches the flanks.
        let touch_m = bottom_radius_m * (1.0 - sin);
        if !(bottom_radius_m == 0.0 || is_length(bottom_radius_m)) || touch_m >= depth_m {
            return Err(measure("the radius at the bottom of the vee", bottom_radius_m, "0, or small enough for the depth"));
        }
        let (low_m, beside_m) = (radius_m - depth_m + touch_m, bottom_radius_m * cos);
        let half_m = beside_m + (depth_m - touch_m) * sin / cos;
        let mut chain = Chain::new([-half_m, radius_m]);
        chain.line([-beside_m, low_m]);
        if bottom_radius_m > 0.0 {
            chain.arc([beside_m, low_m], [0.0, radius_m - depth_m + bottom_radius_m]);
        }
        chain.line([half_m, radius_m]);
        chain.finish(radius_m, spacing_m)
    }

    /// The segments, each with where it begins, m.
    pub fn spans(&self) -> impl Iterator<Item = ([f64; 2], &Segment)> {
        let begins = std::iter::once(self.start_m).chain(self.segments.iter().map(Segment::end_m));
        begins.zip(&self.segments)
    }

    /// The least and the greatest radius, m.
    pub fn radii_m(&self) -> [f64; 2] {
        let mut radii_m = [self.start_m[1]; 2];
        let mut include = |m: f64| radii_m = [radii_m[0].min(m), radii_m[1].max(m)];
        for (from, segment) in self.spans() {
            let to = segment.end_m();
            include(to[1]);
            if let Segment::Arc { centre_m, counterclockwise, .. } = segment
                && from[0] < centre_m[0]
                && centre_m[0] < to[0]
            {
                let radius_m = distance(from, *centre_m);
                include(centre_m[1] + if *counterclockwise { -radius_m } else { radius_m });
            }
        }
        radii_m
    }

    /// ∫ρ² dζ along the chain, m³, in closed form.
    pub(super) fn squares_m3(&self) -> f64 {
        self.spans().map(|(from, segment)| squares_m3(from, segment)).sum()
    }

    /// ∫ρ⁴ dζ along the chain, m⁵, in closed form.
    pub(super) fn fourths_m5(&self) -> f64 {
        self.spans().map(|(from, segment)| fourths_m5(from, segment)).sum()
    }

    /// Whether it is the profile of grooves so far from each other, m.
    ///
    /// # Errors
    /// The first [`GrooveError`] that is found.
    pub fn check(&self, spacing_m: f64) -> Result<(), GrooveError> {
        if self.segments.len() < 2 {
            return Err(GrooveError::TooFew);
        }
        let is_point = |point: [f64; 2]| point.iter().all(|x| x.abs() < TOO_LONG_M);
        let mut before: Option<([f64; 2], &Segment)> = None;
        for (segment, (from, each)) in self.spans().enumerate() {
            let is_sound = match each {
                Segment::Line { to_m } => is_point(*to_m),
                Segment::Arc { to_m, centre_m, .. } => is_point(*to_m) && is_point(*centre_m),
                Segment::Spline(_) => false,
            };
            if !(is_sound && is_point(from)) {
                return Err(GrooveError::Invalid { segment });
            }
            if distance(from, each.end_m()) <= SAME_M {
                return Err(GrooveError::NoLength { segment });
            }
            if is_backwards(from, each, segment)? || before.is_some_and(|last| is_on_itself(last, (from, each))) {
                return Err(GrooveError::Backwards { segment });
            }
            before = Some((from, each));
        }
        let [along_m, out_m] = sub(self.segments[self.segments.len() - 1].end_m(), self.start_m);
        let gap_m = (along_m - spacing_m).abs().max(out_m.abs());
        if gap_m.is_nan() || gap_m > SAME_M {
            return Err(GrooveError::Open { gap_m });
        }
        if self.start_m[0].abs() > spacing_m {
            return Err(GrooveError::Far { start_m: self.start_m[0] });
        }
        let ends = (self.spans().last(), self.spans().next());
        if let (Some(last), Some(first)) = ends
            && is_on_itself(last, first)
        {
            return Err(GrooveError::Backwards { segment: 0 });
        }
        Ok(())
    }
}

/// The angle from the begin of an arc to its end, positive counterclockwise, rad; of half circles at most.
fn sweep_rad(from: [f64; 2], to: [f64; 2], centre: [f64; 2], counterclockwise: bool) -> f64 {
    let (a, b) = (sub(from, centre), sub(to, centre));
    let sweep_rad = maths::atan2(cross(a, b), dot(a, b)).abs();
    if counterclockwise { sweep_rad } else { -sweep_rad }
}

/// ∫ρ² dζ along a segment: with x and y from the middle of an arc, dζ = dx, ∫y dx = `½Δ(xy) − ½R²Δφ` and y² = R² − x².
fn squares_m3(from: [f64; 2], segment: &Segment) -> f64 {
    let to = segment.end_m();
    let Segment::Arc { centre_m: centre, counterclockwise, .. } = segment else {
        return (to[0] - from[0]) * (from[1] * from[1] + from[1] * to[1] + to[1] * to[1]) / 3.0;
    };
    let ([x, y], [u, v]) = (sub(from, *centre), sub(to, *centre));
    let square = x * x + y * y;
    let first = 0.5 * (u * v - x * y - square * sweep_rad(from, to, *centre, *counterclockwise));
    let second = (u - x) * (square - (x * x + x * u + u * u) / 3.0);
    centre[1] * centre[1] * (u - x) + 2.0 * centre[1] * first + second
}

/// ∫ρ⁴ dζ along a segment. On an arc ρ = c + y, and with `I_k` = ∫yᵏ dx: `I_k` (k + 1) = Δ(xyᵏ) + k R² `I_(k−2)`.
fn fourths_m5(from: [f64; 2], segment: &Segment) -> f64 {
    let to = segment.end_m();
    let Segment::Arc { centre_m: centre, counterclockwise, .. } = segment else {
        let [a, b] = [from[1], to[1]];
        return (to[0] - from[0]) * (a * a * a * a + a * a * a * b + a * a * b * b + a * b * b * b + b * b * b * b) / 5.0;
    };
    let ([x, y], [u, v]) = (sub(from, *centre), sub(to, *centre));
    let square = x * x + y * y;
    let zeroth = u - x;
    let first = 0.5 * (u * v - x * y - square * sweep_rad(from, to, *centre, *counterclockwise));
    let second = (u * v * v - x * y * y + 2.0 * square * zeroth) / 3.0;
    let third = (u * v * v * v - x * y * y * y + 3.0 * square * first) / 4.0;
    let fourth = (u * v * v * v * v - x * y * y * y * y + 4.0 * square * second) / 5.0;
    let c = centre[1];
    c * c * c * c * zeroth + 4.0 * c * c * c * first + 6.0 * c * c * second + 4.0 * c * third + fourth
}

/// Whether a segment runs against the axis: arcs counterclockwise above their middle or clockwise below do.
fn is_backwards(from: [f64; 2], segment: &Segment, index: usize) -> Result<bool, GrooveError> {
    let to = segment.end_m();
    let Segment::Arc { centre_m, counterclockwise, .. } = segment else { return Ok(to[0] - from[0] < -SAME_M) };
    let difference_m = (distance(from, *centre_m) - distance(to, *centre_m)).abs();
    if difference_m > SAME_M {
        return Err(GrooveError::NotCircular { segment: index, difference_m });
    }
    let side = if *counterclockwise { 1.0 } else { -1.0 };
    let is_beyond = |point: [f64; 2]| side * (point[1] - centre_m[1]) > SAME_M;
    Ok(to[0] <= from[0] || is_beyond(from) || is_beyond(to))
}

/// Whether both are lines across the axis, one outwards and one inwards.
fn is_on_itself(before: ([f64; 2], &Segment), after: ([f64; 2], &Segment)) -> bool {
    let rise = |(from, segment): ([f64; 2], &Segment)| match segment {
        Segment::Line { to_m } if (to_m[0] - from[0]).abs() <= SAME_M => to_m[1] - from[1],
        _ => 0.0,
    };
    rise(before) * rise(after) < 0.0
}

fn measure(name: &'static str, value: f64, allowed: &'static str) -> GrooveError {
    GrooveError::Measure { name, value, allowed }
}

fn check_depth(radius_m: f64, spacing_m: f64, depth_m: f64) -> Result<(), GrooveError> {
    for (name, value) in [("the radius of the lands", radius_m), ("the spacing", spacing_m)] {
        if !is_length(value) {
            return Err(measure(name, value, "a micrometre to a kilometre"));
        }
    }
    if is_length(depth_m) && depth_m < radius_m {
        return Ok(());
    }
    Err(measure("the depth", depth_m, "a micrometre or more, and end above the axis"))
}

/// The chain while it grows.
struct Chain {
    start_m: [f64; 2],
    segments: Vec<Segment>,
}

impl Chain {
    fn new(start_m: [f64; 2]) -> Self {
        Self { start_m, segments: Vec::new() }
    }

    fn line(&mut self, to_m: [f64; 2]) {
        self.segments.push(Segment::Line { to_m });
    }

    /// An arc below its middle.
    fn arc(&mut self, to_m: [f64; 2], centre_m: [f64; 2]) {
        self.segments.push(Segment::Arc { to_m, centre_m, counterclockwise: true });
    }

    /// Adds the land.
    fn finish(mut self, radius_m: f64, spacing_m: f64) -> Result<Groove, GrooveError> {
        let width_m = -2.0 * self.start_m[0];
        let groove_end_m = self.start_m[0] + spacing_m;
        self.line([groove_end_m, radius_m]);
        if spacing_m - width_m <= SAME_M {
            return Err(GrooveError::NoLand { width_m, spacing_m });
        }
        let groove = Groove { start_m: self.start_m, segments: self.segments };
        groove.check(spacing_m).map(|()| groove)
    }
}

/// Measures of a round seat.
#[expect(clippy::struct_field_names, reason = "identifiers carry their units")]
struct Seat {
    /// Half its width, m.
    half_m: f64,
    /// Radius of the middle of its arc, m.
    middle_m: f64,
    /// Radius at which walls begin, that of the lands without walls, m.
    wall_m: f64,
}

impl Seat {
    fn new(radius_m: f64, spacing_m: f64, seat_radius_m: f64, depth_m: f64) -> Result<Self, GrooveError> {
        check_depth(radius_m, spacing_m, depth_m)?;
        if !is_length(seat_radius_m) {
            return Err(measure("the radius of the seat", seat_radius_m, "a micrometre to a kilometre"));
        }
        let middle_m = radius_m - depth_m + seat_radius_m;
        if depth_m > seat_radius_m {
            return Ok(Self { half_m: seat_radius_m, middle_m, wall_m: middle_m });
        }
        Ok(Self { half_m: (depth_m * (2.0 * seat_radius_m - depth_m)).sqrt(), middle_m, wall_m: radius_m })
    }

    /// The chain of a seat between its walls, if it has such.
    fn finish(&self, seat: impl Fn(&mut Chain), radius_m: f64, spacing_m: f64) -> Result<Groove, GrooveError> {
        let mut chain = Chain::new([-self.half_m, radius_m]);
        let has_walls = radius_m - self.wall_m > SAME_M;
        if has_walls {
            chain.line([-self.half_m, self.wall_m]);
        }
        seat(&mut chain);
        if has_walls {
            chain.line([self.half_m, radius_m]);
        }
        chain.finish(radius_m, spacing_m)
    }
}
