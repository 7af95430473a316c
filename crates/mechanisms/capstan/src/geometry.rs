//! Geometry of a cable drive with two parallel drums.
//!
//! A cable is anchored on the output drum, winds off it, crosses a free span to the input drum, winds round that, returns over a second
//! span to the output drum, winds onto it and is anchored. The arrangement is that of `longval-gosselin`; the sections of that paper on
//! grooves and alignment are derived here again; theory and limits: `docs/theory/capstan-geometry.md`.
//!
//! | symbol | here | unit | meaning |
//! | --- | --- | --- | --- |
//! | r1, r2 | `input_radius_m`, `output_radius_m` | m | to the middle of the rope |
//! | d | `centre_distance_m` | m | of the two axes |
//! | R | `ratio` | 1 | r2/r1 |
//! | σ | `Belt::sign` | 1 | +1 crossed, −1 open |
//! | a | r1 + σ r2 | m | |
//! | γ | `tangent_angle_rad` | rad | cos γ = a/d, in (0, π) |
//! | `L_f` | `free_span_m` | m | √(d² − a²) |
//! | p | `pitch_m` | m | of the one helix on the input |
//! | β | `helix_angle_rad` | rad | tan β = p/(2π r1), on both drums |
//! | S, q | `starts`, `line_spacing_m` | 1, m | output grooves; q = R p/S |
//! | n | `extra_turns` | 1 | input wrap 2π(n+1) − 2γ |
//! | ε | `landing_pitches` | 1 | (`L_f` − a γ)/(π r1) = (1 + σR)(tan γ − γ)/π |
//!
//! **Frame.** The input's axis is z through the origin, the output's is parallel through (d, 0). A cable has two ends: it runs from end 0
//! anticlockwise round the input to end 1, and its axial coordinate grows all the way on a right-handed input (it falls on a left-handed
//! one). Everything is computed for the right hand, in the *climb* ζ = ±z.
//!
//! **Tangents.** A span is perpendicular to the radius at both of its ends, so it touches the input at the angles ±γ from the line of
//! centres; the output at π ± γ (crossed) or ±γ (open). One formula serves both belts: a crossed belt is an open one with a negative r2.
//!
//! **Alignment while turning.** Unrolled, a cable with the slope tan β everywhere is one straight line. A groove of lead `2π r tan β` that
//! turns by α walks by `r α tan β`; r1 α1 and r2 α2 are the same length of cable, hence both drums walk alike and the spans stay in line.
//! The output's lead is R p. Its hand is opposite on a crossed belt, where the drums turn against each other, and the same on an open one.
//!
//! **Alignment of the return.** From the outgoing tangent point on the output the cable climbs tan β (2 `L_f` + r1 (2π(n+1) − 2γ)) until it
//! is back on the output, 2γ further round, where the groove it came from has climbed σ R p γ/π. The difference is n + 1 + ε pitches.

mod alignment;
mod grooves;
mod occupancy;
mod path;

use std::f64::consts::{PI, TAU};
use std::fmt;

use forcewright_base::maths::atan2;

pub use alignment::{Aligned, Fleet};
pub use grooves::{Anchor, Band, GroovePath, Group, Seat, Tensioner, preload_travel_m};
pub use occupancy::{Arc, Nearest, Place};
pub use path::{CentreLine, Helix, Piece, Span, Station};

/// How the spans run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Belt {
    /// Between the drums from one side to the other: the drums turn against each other.
    Crossed,
    /// Along the outside: the drums turn alike.
    Open,
}

impl Belt {
    /// σ: +1 crossed, −1 open.
    pub fn sign(self) -> f64 {
        match self {
            Self::Crossed => 1.0,
            Self::Open => -1.0,
        }
    }
}

/// Hand of a helix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hand {
    /// z grows with the angle, as on a common screw.
    Right,
    /// z falls with the angle.
    Left,
}

impl Hand {
    /// +1 right, −1 left.
    pub fn sign(self) -> f64 {
        match self {
            Self::Right => 1.0,
            Self::Left => -1.0,
        }
    }

    /// The other one.
    pub fn opposite(self) -> Self {
        match self {
            Self::Right => Self::Left,
            Self::Left => Self::Right,
        }
    }
}

/// One of the two drums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drum {
    /// The pinion, with one groove.
    Input,
    /// The large drum, with `starts` grooves.
    Output,
}

/// What holds the rope sideways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// Helical grooves on both drums.
    Grooved,
    /// Smooth drums: the cable lays itself with the same slope everywhere (a straight line when unrolled), so that it walks as in grooves,
    /// lands where it lands, and has no groove to be out of line with. Line numbers then place the first ends only.
    Flat,
}

/// How the input drum is set against the output drum, axially or by turning it in its coupling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// The outgoing span of a cable on line 0 is in line with both of its grooves; the return span takes the mismatch.
    Outgoing,
    /// The compromise: the largest deviation of all spans is as small as it can be. With one cable both spans take half of the mismatch.
    Shared,
}

/// What a drive is built from. All lengths in m, angles in rad; radii to the middle of the rope.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// r1, above 0.
    pub input_radius_m: f64,
    /// r2, above 0.
    pub output_radius_m: f64,
    /// d, above r1 + r2.
    pub centre_distance_m: f64,
    /// Crossed or open.
    pub belt: Belt,
    /// p, above 0.
    pub pitch_m: f64,
    /// Hand of the input's helix.
    pub hand: Hand,
    /// S, at least 1.
    pub starts: u32,
    /// n: whole turns on the input beyond the single wrap of 2π − 2γ.
    pub extra_turns: u32,
    /// Angle by which the second group of output grooves is turned against the sense in which the cable runs over the output; a positive one
    /// moves the grooves on in the sense of the climb, by R p/2π per rad.
    pub second_phase_rad: f64,
    /// Travel of the output, at least 0.
    pub travel_rad: f64,
    /// Wrap on the output that always remains at ends 0 and 1, at least 0.
    pub guard_rad: [f64; 2],
    /// Diameter of the rope, above 0.
    pub rope_diameter_m: f64,
    /// Grooved or flat.
    pub surface: Surface,
    /// How the input is set.
    pub setting: Setting,
    /// The output's groove lines of ends 0 and 1 of each cable. Line j + S is the groove of line j one turn further.
    pub cables: Vec<[i32; 2]>,
}

/// Why there is no such geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GeometryError {
    /// A number is not finite, or below what it may be.
    Number {
        /// Which.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// There is no span: the drums, to the middle of the rope, touch or overlap.
    DrumsOverlap {
        /// What was given, m.
        centre_distance_m: f64,
        /// It must be above this, m.
        above_m: f64,
    },
    /// No groove on the output.
    NoStarts,
    /// No cable.
    NoCables,
    /// End 1 of a cable is nearer to another groove line than to the one stated.
    Lines {
        /// Which cable, from 0.
        cable: usize,
        /// From the stated line to where the cable lands, in line spacings; beyond ±½.
        off_lines: f64,
        /// The line next to where it lands.
        nearest: i64,
    },
    /// No cable of this number.
    NoSuchCable {
        /// What was asked for.
        cable: usize,
        /// How many there are.
        cables: usize,
    },
    /// The output angle is outside the travel.
    OutsideTravel {
        /// What was asked for, rad.
        output_rad: f64,
        /// It must be in [0, this], rad.
        travel_rad: f64,
    },
    /// No ratio aligns at this centre distance.
    NoRatio,
    /// More points or solutions were asked for than are given.
    TooMany {
        /// How many it would be.
        count: f64,
        /// The limit.
        limit: usize,
    },
}

impl fmt::Display for GeometryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number { name, value } => write!(f, "{name} is {value}: it must be a finite number in its range"),
            Self::DrumsOverlap { centre_distance_m, above_m } => {
                write!(f, "the drums overlap: their centres are {centre_distance_m} m apart and must be more than {above_m} m apart")
            }
            Self::NoStarts => write!(f, "the output drum has no groove"),
            Self::NoCables => write!(f, "there is no cable"),
            Self::Lines { cable, off_lines, nearest } => {
                write!(f, "end 1 of cable {cable} lands {off_lines:.3} line spacings from its line; the next line is {nearest}")
            }
            Self::NoSuchCable { cable, cables } => write!(f, "there is no cable {cable}; there are {cables}, counted from 0"),
            Self::OutsideTravel { output_rad, travel_rad } => {
                write!(f, "the output angle {output_rad} rad is outside the travel of 0 to {travel_rad} rad")
            }
            Self::NoRatio => write!(f, "no ratio aligns at this centre distance"),
            Self::TooMany { count, limit } => write!(f, "{count} were asked for; the limit is {limit}"),
        }
    }
}

impl std::error::Error for GeometryError {}

/// A drive whose numbers are in range.
///
/// ```
/// use forcewright_capstan::geometry::{Belt, Drive, Hand, Layout, Setting, Surface};
///
/// let drive = Drive::new(Layout {
///     input_radius_m: 0.010,
///     output_radius_m: 0.050,
///     centre_distance_m: 0.065,
///     belt: Belt::Crossed,
///     pitch_m: 0.002,
///     hand: Hand::Right,
///     starts: 5,
///     extra_turns: 3,
///     second_phase_rad: 0.0,
///     travel_rad: 270.0_f64.to_radians(),
///     guard_rad: [std::f64::consts::PI; 2],
///     rope_diameter_m: 0.0015,
///     surface: Surface::Grooved,
///     setting: Setting::Shared,
///     cables: vec![[0, 4]],
/// })?;
/// assert!((drive.free_span_m() - 0.025).abs() < 1e-15);
/// assert!((drive.mismatch_pitches(0)? - 0.0418).abs() < 1e-4);
/// # Ok::<(), forcewright_capstan::geometry::GeometryError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    layout: Layout,
    tangent_rad: f64,
    free_span_m: f64,
    /// Axial shift of the input groove in the sense of the climb, from the place where the outgoing span on line 0 is in line.
    input_shift_m: f64,
}

impl Drive {
    /// The drive of a layout.
    ///
    /// # Errors
    /// [`GeometryError`] for numbers out of range, drums that overlap, no starts, no cables, or a second line that is not the one next to
    /// where the cable lands.
    pub fn new(layout: Layout) -> Result<Self, GeometryError> {
        check(&layout)?;
        let (r1, r2, d) = (layout.input_radius_m, layout.output_radius_m, layout.centre_distance_m);
        let mut drive = Self {
            tangent_rad: tangent_rad(r1, r2, d, layout.belt),
            free_span_m: free_span_m(r1, r2, d, layout.belt),
            input_shift_m: 0.0,
            layout,
        };
        drive.check_lines()?;
        drive.input_shift_m = drive.setting_shift_m();
        drive.check_sizes()?;
        Ok(drive)
    }

    /// What it was built from.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// R = r2/r1.
    pub fn ratio(&self) -> f64 {
        self.layout.output_radius_m / self.layout.input_radius_m
    }

    /// γ, rad, in (0, π): where spans touch the input, from the line of centres. cos γ = (r1 + σ r2)/d.
    pub fn tangent_angle_rad(&self) -> f64 {
        self.tangent_rad
    }

    /// `L_f`, m: length of a free span seen along the axes, √(d² − (r1 + σ r2)²). With the climb it is longer by 1/cos β.
    pub fn free_span_m(&self) -> f64 {
        self.free_span_m
    }

    /// Climb of a span that is in line with its grooves, m: `L_f` tan β.
    pub fn span_rise_m(&self) -> f64 {
        self.free_span_m * self.slope()
    }

    /// tan β = p/(2π r1).
    pub fn slope(&self) -> f64 {
        self.layout.pitch_m / (TAU * self.layout.input_radius_m)
    }

    /// β, rad: between the grooves and the planes across the axes, the same on both drums.
    pub fn helix_angle_rad(&self) -> f64 {
        atan2(self.layout.pitch_m, TAU * self.layout.input_radius_m)
    }

    /// Hand of the helix on a drum: opposite ones on a crossed belt.
    pub fn hand(&self, drum: Drum) -> Hand {
        match (drum, self.layout.belt) {
            (Drum::Output, Belt::Crossed) => self.layout.hand.opposite(),
            _ => self.layout.hand,
        }
    }

    /// Radius of a drum to the middle of the rope, m.
    pub fn radius_m(&self, drum: Drum) -> f64 {
        match drum {
            Drum::Input => self.layout.input_radius_m,
            Drum::Output => self.layout.output_radius_m,
        }
    }

    /// Lead of the helix on a drum, m: p on the input, R p on the output.
    pub fn lead_m(&self, drum: Drum) -> f64 {
        TAU * self.lead_m_per_rad(drum)
    }

    /// Axial distance of neighbouring groove lines on the output, m: R p/S.
    pub fn line_spacing_m(&self) -> f64 {
        self.lead_m(Drum::Output) / f64::from(self.layout.starts)
    }

    /// Wrap on the input, rad: 2π(n+1) − 2γ for both belts.
    pub fn input_wrap_rad(&self) -> f64 {
        TAU * self.turns() - 2.0 * self.tangent_rad
    }

    /// Wraps on the output of ends 0 and 1 at an output angle, rad. The output angle is 0 where end 0 has its guard wrap only, and grows as
    /// end 0 winds up and end 1 unwinds.
    ///
    /// # Errors
    /// [`GeometryError::OutsideTravel`].
    pub fn output_wraps_rad(&self, output_rad: f64) -> Result<[f64; 2], GeometryError> {
        let [first, second] = self.layout.guard_rad;
        let angle = self.on_travel(output_rad)?;
        Ok([first + angle, second + (self.layout.travel_rad - angle)])
    }

    /// Least wraps on the output of ends 0 and 1 over the travel, rad: the guard wraps.
    pub fn least_output_wraps_rad(&self) -> [f64; 2] {
        self.layout.guard_rad
    }

    /// Angles by which the input and the output have turned about +z at an output angle, rad. While end 0 winds up, the input turns
    /// clockwise, the output clockwise too on an open belt.
    ///
    /// # Errors
    /// [`GeometryError::OutsideTravel`].
    pub fn turned_rad(&self, output_rad: f64) -> Result<[f64; 2], GeometryError> {
        let angle = self.on_travel(output_rad)?;
        Ok([-self.ratio() * angle, self.layout.belt.sign() * angle])
    }

    /// Axial walk of all tangent points from the start of the travel to an output angle, m, along z: ±R p/2π per rad of the output.
    ///
    /// # Errors
    /// [`GeometryError::OutsideTravel`].
    pub fn walk_m(&self, output_rad: f64) -> Result<f64, GeometryError> {
        Ok(self.layout.hand.sign() * self.walk_climb_m(self.on_travel(output_rad)?))
    }

    /// Axial walk over the whole travel, m, at least 0.
    pub fn travel_walk_m(&self) -> f64 {
        self.walk_climb_m(self.layout.travel_rad)
    }

    /// Distance between the ropes on the two drums where these are next to each other, m: d − r1 − r2 less the rope's diameter. Below 0
    /// ropes that pass there at the same height touch.
    pub fn drum_gap_m(&self) -> f64 {
        self.layout.centre_distance_m - self.layout.input_radius_m - self.layout.output_radius_m - self.layout.rope_diameter_m
    }

    /// n + 1.
    fn turns(&self) -> f64 {
        f64::from(self.layout.extra_turns) + 1.0
    }

    /// Climb per angle on a drum, m/rad: r tan β.
    fn lead_m_per_rad(&self, drum: Drum) -> f64 {
        self.radius_m(drum) * self.slope()
    }

    /// Walk in the sense of the climb, m.
    fn walk_climb_m(&self, output_rad: f64) -> f64 {
        self.lead_m_per_rad(Drum::Output) * output_rad
    }

    /// Numbers in their ranges may still make lengths that are not, or whose squares are not.
    fn check_sizes(&self) -> Result<(), GeometryError> {
        const MOST_M: f64 = 1e150;
        for cable in 0..self.layout.cables.len() {
            let bands = self.output_bands(cable)?.into_iter().chain([self.input_band(cable)?]).flat_map(|band| [band.from_m, band.to_m]);
            let lengths = [self.cable_length_m(cable)?, self.lead_m(Drum::Output), self.layout.centre_distance_m];
            if let Some(value) = bands.chain(lengths).find(|x| x.is_nan() || x.abs() > MOST_M) {
                return Err(GeometryError::Number { name: "a length of the drive", value });
            }
        }
        let pitches = self.layout.centre_distance_m.max(self.band(Drum::Output).length_m()) / self.layout.pitch_m;
        for (name, value) in [("size of the drive in pitches", pitches), ("slope of the grooves", self.slope())] {
            if !value.is_normal() {
                return Err(GeometryError::Number { name, value });
            }
        }
        Ok(())
    }

    /// An output angle inside the travel.
    fn on_travel(&self, output_rad: f64) -> Result<f64, GeometryError> {
        let travel_rad = self.layout.travel_rad;
        if (0.0..=travel_rad).contains(&output_rad) { Ok(output_rad) } else { Err(GeometryError::OutsideTravel { output_rad, travel_rad }) }
    }

    /// The lines of a cable.
    fn lines(&self, cable: usize) -> Result<[f64; 2], GeometryError> {
        let cables = &self.layout.cables;
        let lines = cables.get(cable).ok_or(GeometryError::NoSuchCable { cable, cables: cables.len() })?;
        Ok(lines.map(f64::from))
    }

    /// Angles about the output's axis where the spans of end 0 and end 1 touch it, rad.
    fn output_tangents_rad(&self) -> [f64; 2] {
        let towards = match self.layout.belt {
            Belt::Crossed => PI,
            Belt::Open => 0.0,
        };
        [towards + self.tangent_rad, towards - self.tangent_rad]
    }
}

/// γ without cancellation where the drums nearly touch: tan γ = `L_f`/(r1 + σ r2).
fn tangent_rad(r1_m: f64, r2_m: f64, d_m: f64, belt: Belt) -> f64 {
    atan2(free_span_m(r1_m, r2_m, d_m, belt), r1_m + belt.sign() * r2_m)
}

/// `L_f` = √((d − a)(d + a)), m.
fn free_span_m(r1_m: f64, r2_m: f64, d_m: f64, belt: Belt) -> f64 {
    let a = r1_m + belt.sign() * r2_m;
    // Two roots, so that neither tiny nor huge drums leave the range.
    (d_m - a).max(0.0).sqrt() * (d_m + a).max(0.0).sqrt()
}

/// The ranges of the numbers.
fn check(layout: &Layout) -> Result<(), GeometryError> {
    let above_zero = [
        ("input radius", layout.input_radius_m),
        ("output radius", layout.output_radius_m),
        ("centre distance", layout.centre_distance_m),
        ("pitch", layout.pitch_m),
        ("rope diameter", layout.rope_diameter_m),
    ];
    for (name, value) in above_zero {
        if !(value > 0.0 && value.is_finite()) {
            return Err(GeometryError::Number { name, value });
        }
    }
    let [first, second] = layout.guard_rad;
    for (name, value) in [("travel", layout.travel_rad), ("guard wrap of end 0", first), ("guard wrap of end 1", second)] {
        if !(value >= 0.0 && value.is_finite()) {
            return Err(GeometryError::Number { name, value });
        }
    }
    if !layout.second_phase_rad.is_finite() {
        return Err(GeometryError::Number { name: "phase of the second group", value: layout.second_phase_rad });
    }
    let above_m = layout.input_radius_m + layout.output_radius_m;
    if layout.centre_distance_m <= above_m {
        return Err(GeometryError::DrumsOverlap { centre_distance_m: layout.centre_distance_m, above_m });
    }
    if layout.starts == 0 {
        return Err(GeometryError::NoStarts);
    }
    if layout.cables.is_empty() {
        return Err(GeometryError::NoCables);
    }
    Ok(())
}
