//! A turned part that was checked, in millimetres.

mod mesh;
mod solid;
mod spline;

use std::f64::consts::TAU;

use forcewright_base::maths;
use forcewright_curves::vector::{cross, distance, dot, sub};
use forcewright_curves::{Profile, Segment};
use forcewright_model::{Grooved, Section, Turned};

use crate::error::{Error, Place, Problem};
use crate::shape::{MM_PER_M, Point};

pub(crate) use mesh::mesh;
pub(crate) use solid::{curve, knots, write};
pub(crate) use spline::{DEGREE, fitted_within};

/// Sections one upon another around a bore.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stack {
    /// Radius of the bore, 0 without.
    bore: f64,
    /// Heights of the ends of sections: one more than there are sections.
    levels: Vec<f64>,
    sides: Vec<Side>,
}

/// The outside of a section.
#[derive(Clone, Debug, PartialEq)]
enum Side {
    Round { radius: f64 },
    Helical(Helical),
}

/// Helical grooves. Above the lower end of the section by `z`, the point (ζ, ρ) of the profile lies at the angle
/// `phase + winding·(z − ζ)`, and at those of the other grooves.
#[derive(Clone, Debug, PartialEq)]
struct Helical {
    /// Angle for a length along the axis, rad/mm; positive is right-handed.
    winding: f64,
    starts: u32,
    phase: f64,
    /// From groove to groove along the axis.
    spacing: f64,
    /// The profile in metres; the last of its segments is the line or arc that ends a spacing beyond the start.
    groove: Profile,
    spans: Vec<Span>,
    /// Least and greatest radius.
    radii: [f64; 2],
}

/// A segment of the profile, by points (ζ, ρ).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Span {
    from: Point,
    to: Point,
    /// Middle, radius, angle of the begin and swept angle of an arc.
    arc: Option<(Point, f64, f64, f64)>,
}

impl Stack {
    /// # Errors
    /// When it cannot be made ([`Turned::check`]).
    pub(crate) fn new(turned: &Turned) -> Result<Self, Error> {
        turned.check().map_err(|error| Error { place: Place::Part, problem: Problem::Turned(error) })?;
        let side = |section: &Section| match section {
            Section::Plain { radius_m, .. } => Side::Round { radius: radius_m * MM_PER_M },
            Section::Grooved(grooved) => Side::Helical(Helical::new(grooved)),
        };
        Ok(Self {
            bore: 0.5 * turned.bore_diameter_m * MM_PER_M,
            levels: turned.steps_m().into_iter().map(|m| m * MM_PER_M).collect(),
            sides: turned.sections.iter().map(side).collect(),
        })
    }

    fn height(&self) -> f64 {
        self.levels[self.levels.len() - 1]
    }

    /// Whether the section below a step is the larger one.
    fn is_larger_below(&self, step: usize) -> bool {
        self.sides[step - 1].radii()[0] > self.sides[step].radii()[1]
    }
}

impl Side {
    fn radii(&self) -> [f64; 2] {
        match self {
            Self::Round { radius } => [*radius; 2],
            Self::Helical(helical) => helical.radii,
        }
    }
}

impl Helical {
    fn new(grooved: &Grooved) -> Self {
        let groove = &grooved.groove;
        let spans = groove.spans().map(|(from, segment)| Span::new(from, segment)).collect();
        Self {
            winding: TAU / (grooved.lead_m * MM_PER_M),
            starts: grooved.starts,
            phase: grooved.phase_rad,
            spacing: grooved.spacing_m() * MM_PER_M,
            groove: Profile { start_m: groove.start_m, segments: groove.segments.clone() },
            spans,
            radii: groove.radii_m().map(|m| m * MM_PER_M),
        }
    }

    /// Angle of the middle of a groove where z is 0, rad.
    fn angle(&self, groove: u32) -> f64 {
        self.phase + TAU * f64::from(groove) / f64::from(self.starts)
    }
}

impl Span {
    fn new(from_m: [f64; 2], segment: &Segment) -> Self {
        let mm = |point: [f64; 2]| point.map(|m| m * MM_PER_M);
        let (from, to) = (mm(from_m), mm(segment.end_m()));
        let Segment::Arc { centre_m, counterclockwise, .. } = segment else { return Self { from, to, arc: None } };
        let centre = mm(*centre_m);
        let (a, b) = (sub(from, centre), sub(to, centre));
        let sweep = maths::atan2(cross(a, b), dot(a, b)).abs();
        let sweep = if *counterclockwise { sweep } else { -sweep };
        Self { from, to, arc: Some((centre, distance(from, centre), maths::atan2(a[1], a[0]), sweep)) }
    }

    /// The point (ζ, ρ) at a share of the length.
    fn at(&self, share: f64) -> Point {
        match self.arc {
            Some((centre, radius, first, sweep)) => {
                let (sin, cos) = maths::sin_cos(first + share * sweep);
                [centre[0] + radius * cos, centre[1] + radius * sin]
            }
            None => [0, 1].map(|k| self.from[k] + share * (self.to[k] - self.from[k])),
        }
    }
}

/// A point of a plane across the axis at a radius and an angle.
fn polar(radius: f64, angle: f64) -> Point {
    let (sin, cos) = maths::sin_cos(angle);
    [radius * cos, radius * sin]
}
