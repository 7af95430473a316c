//! Grooves as they are cut, anchors, bands and lengths of the drums, and what preload takes.
//!
//! Angles on a drum are those in space at the start of the travel: a place on a drum that has turned by α stands at its angle plus α.

use std::f64::consts::TAU;

use forcewright_base::maths::{acos, atan2};
use forcewright_base::roots::minimise;

use super::{Drive, Drum, GeometryError};

/// Most points of one groove.
const MOST_POINTS: usize = 1_000_000;

/// Which of the output's grooves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Those of ends 0.
    First,
    /// Those of ends 1: turned by the phase against the first.
    Second,
}

/// Where a cable ends on the output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// Angle on the output, rad, unwound: it tells turns apart.
    pub angle_rad: f64,
    /// z, m.
    pub z_m: f64,
    /// Where it is in space at the start of the travel, m.
    pub point_m: [f64; 3],
}

/// A part of a drum along its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Lower end, m.
    pub from_m: f64,
    /// Upper end, m.
    pub to_m: f64,
}

impl Band {
    /// Of two climbs in either order, mirrored for a left hand.
    fn new(up: f64, a: f64, b: f64) -> Self {
        Self { from_m: (up * a).min(up * b), to_m: (up * a).max(up * b) }
    }

    /// The band around two bands.
    fn around(self, other: Self) -> Self {
        Self { from_m: self.from_m.min(other.from_m), to_m: self.to_m.max(other.to_m) }
    }

    /// Its length, m.
    pub fn length_m(&self) -> f64 {
        self.to_m - self.from_m
    }
}

/// The path of a tool along one groove.
#[derive(Clone, Debug, PartialEq)]
pub struct GroovePath {
    /// Start, from 0; line j is start j modulo S.
    pub start: u32,
    /// (angle on the drum, rad; z, m) from the lower to the upper end of the section, angles unwound.
    pub points: Vec<[f64; 2]>,
}

/// Section of a round groove.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seat {
    /// Radius of the seat, m; at least that of the rope.
    pub radius_m: f64,
    /// From the bottom of the seat to the land, m; above 0, at most the rope's radius.
    pub depth_m: f64,
}

/// How a tensioner takes up cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tensioner {
    /// A screw that moves by its lead per turn, m.
    Screw {
        /// Lead, m.
        lead_m: f64,
    },
    /// A spool that winds the cable up.
    Spool {
        /// To the middle of the rope, m.
        radius_m: f64,
    },
}

impl Tensioner {
    /// Turn that takes up a length of cable, rad.
    ///
    /// # Errors
    /// [`GeometryError::Number`] unless its lead or radius is above 0.
    pub fn turn_rad(&self, travel_m: f64) -> Result<f64, GeometryError> {
        let (name, value, per_rad) = match *self {
            Self::Screw { lead_m } => ("lead of the tensioner", lead_m, lead_m / TAU),
            Self::Spool { radius_m } => ("radius of the tensioner", radius_m, radius_m),
        };
        if value > 0.0 && value.is_finite() { Ok(travel_m / per_rad) } else { Err(GeometryError::Number { name, value }) }
    }
}

/// Elongation of a cable that is drawn to its preload, m: T L0/AE of the length L0 without tension. `length_m` is that at the preload, as
/// [`Drive::cable_length_m`] gives it; L0 = L/(1 + T/AE). The preload is taken to be the same everywhere.
///
/// # Errors
/// [`GeometryError::Number`] unless the length and the preload are at least 0 and the stiffness AE is above 0.
pub fn preload_travel_m(length_m: f64, preload_n: f64, axial_stiffness_n: f64) -> Result<f64, GeometryError> {
    for (name, value, least) in
        [("length", length_m, 0.0), ("preload", preload_n, 0.0), ("axial stiffness", axial_stiffness_n, f64::MIN_POSITIVE)]
    {
        if !(value >= least && value.is_finite()) {
            return Err(GeometryError::Number { name, value });
        }
    }
    let strain = preload_n / axial_stiffness_n;
    Ok(length_m * strain / (1.0 + strain))
}

impl Drive {
    /// Anchors of a cable's ends 0 and 1.
    ///
    /// # Errors
    /// [`GeometryError::NoSuchCable`].
    pub fn anchors(&self, cable: usize) -> Result<[Anchor; 2], GeometryError> {
        let line = self.centre_line(cable, 0.0)?;
        let l = &self.layout;
        let [first, second] = self.output_tangents_rad();
        let angles = [first + l.belt.sign() * l.guard_rad[0], second - l.belt.sign() * (l.guard_rad[1] + l.travel_rad)];
        let points = [line.pieces[0].point_m(0.0), line.pieces[4].point_m(1.0)];
        Ok([0, 1].map(|end| Anchor { angle_rad: angles[end], z_m: points[end][2], point_m: points[end] }))
    }

    /// Bands of the output that ends 0 and 1 of a cable use over the travel, to the middle of the rope.
    ///
    /// # Errors
    /// [`GeometryError::NoSuchCable`].
    pub fn output_bands(&self, cable: usize) -> Result<[Band; 2], GeometryError> {
        let (climbs, l, lead) = (self.climbs_m(cable)?, &self.layout, self.lead_m_per_rad(Drum::Output));
        let up = l.hand.sign();
        Ok([
            Band::new(up, climbs[0] - lead * l.guard_rad[0], climbs[0] + lead * l.travel_rad),
            Band::new(up, climbs[3], climbs[3] + lead * (l.travel_rad + l.guard_rad[1])),
        ])
    }

    /// Band of the input that a cable uses over the travel, to the middle of the rope.
    ///
    /// # Errors
    /// [`GeometryError::NoSuchCable`].
    pub fn input_band(&self, cable: usize) -> Result<Band, GeometryError> {
        let climbs = self.climbs_m(cable)?;
        Ok(Band::new(self.layout.hand.sign(), climbs[1], climbs[2] + self.travel_walk_m()))
    }

    /// Band of a drum that all cables together use over the travel, to the middle of the rope.
    pub fn band(&self, drum: Drum) -> Band {
        let cables = 0..self.layout.cables.len();
        let each = |cable: usize| match drum {
            Drum::Input => self.input_band(cable).ok(),
            Drum::Output => self.output_bands(cable).ok().map(|[first, second]| first.around(second)),
        };
        cables.filter_map(each).reduce(Band::around).unwrap_or(Band { from_m: 0.0, to_m: 0.0 })
    }

    /// Length of a drum, m: its band and a margin at each end, from the middle of the outermost rope to the end face.
    ///
    /// # Errors
    /// [`GeometryError::Number`] unless the margins are at least 0.
    pub fn drum_length_m(&self, drum: Drum, margins_m: [f64; 2]) -> Result<f64, GeometryError> {
        for value in margins_m {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(GeometryError::Number { name: "margin at the end of a drum", value });
            }
        }
        Ok(self.band(drum).length_m() + margins_m[0] + margins_m[1])
    }

    /// z of a groove at an angle on its drum, m. `line` counts turns of the one groove on the input and lines on the output. On the input
    /// both groups are the same.
    pub fn groove_z_m(&self, drum: Drum, group: Group, line: f64, angle_rad: f64) -> f64 {
        let l = &self.layout;
        let lead = self.lead_m_per_rad(drum);
        let climb = match drum {
            Drum::Input => self.span_rise_m() + self.input_shift_m + line * l.pitch_m + lead * (angle_rad - self.tangent_rad),
            Drum::Output => {
                let phase = match group {
                    Group::First => 0.0,
                    Group::Second => l.second_phase_rad,
                };
                line * self.line_spacing_m() + lead * (phase - l.belt.sign() * (angle_rad - self.output_tangents_rad()[0]))
            }
        };
        l.hand.sign() * climb
    }

    /// Fleet angle up to which a rope leaves a round groove without touching its wall, rad.
    ///
    /// Where the span has run x from the tangent point, the rope has risen by h = √(r² + x²) − r from the bottom and moved sideways by x
    /// tan(fleet). With the rope's radius ρ and the seat's ρ + δ it touches the round at the sideways distance √(h(2δ − h)), or the edge of
    /// the land (half width w, depth t) at w − √(ρ² − (ρ + h − t)²). The least of their angles up to h = t is the limit. A rope that fits
    /// its seat exactly has none: 0.
    ///
    /// # Errors
    /// [`GeometryError::Number`] for a seat that is narrower than the rope, or whose depth is not above 0 and at most the rope's radius.
    pub fn wall_fleet_limit_rad(&self, drum: Drum, seat: Seat) -> Result<f64, GeometryError> {
        const STATIONS: usize = 400;
        let (rope, depth, radius) = (0.5 * self.layout.rope_diameter_m, seat.depth_m, self.radius_m(drum));
        let play = seat.radius_m - rope;
        if !(play >= 0.0 && play.is_finite()) {
            return Err(GeometryError::Number { name: "radius of the seat", value: seat.radius_m });
        }
        if !(depth > 0.0 && depth <= rope) {
            return Err(GeometryError::Number { name: "depth of the groove", value: depth });
        }
        let half_arc = acos(1.0 - depth / seat.radius_m);
        let half_width = (depth * (2.0 * seat.radius_m - depth)).sqrt();
        let sideways = |rise: f64| {
            let round = (rise * (2.0 * play - rise)).max(0.0).sqrt();
            let from_land = rope + rise - depth;
            let on_round = rise < 2.0 * play && atan2(round, play - rise) <= half_arc;
            if on_round { round } else { half_width - ((rope - from_land) * (rope + from_land)).max(0.0).sqrt() }
        };
        // Rises from 0 to the depth, denser near 0 where the angle changes fastest.
        let angle = |u: f64| {
            let rise = depth * u * u;
            atan2(sideways(rise), (rise * (2.0 * radius + rise)).sqrt())
        };
        let at = |i: usize| i as f64 / STATIONS as f64;
        let least = (1..=STATIONS).min_by(|&a, &b| angle(at(a)).total_cmp(&angle(at(b)))).unwrap_or(STATIONS);
        let near = minimise(angle, at(least - 1), at((least + 1).min(STATIONS)), 1e-12).value;
        // Where the rope leaves the bottom the limit is √(δ/r).
        Ok(near.min(angle(at(least))).min(atan2(play.sqrt(), radius.sqrt())).max(0.0))
    }

    /// Paths of a tool along all grooves of a drum in a section along its axis, one per start, with steps of at most `step_rad`.
    ///
    /// # Errors
    /// [`GeometryError::Number`] unless the section is ascending and the step above 0; [`GeometryError::TooMany`] for more than a million
    /// points in a groove.
    pub fn groove_paths(&self, drum: Drum, group: Group, section: Band, step_rad: f64) -> Result<Vec<GroovePath>, GeometryError> {
        if !(section.length_m() > 0.0 && section.length_m().is_finite()) {
            return Err(GeometryError::Number { name: "length of the section", value: section.length_m() });
        }
        if step_rad.is_nan() || step_rad <= 0.0 {
            return Err(GeometryError::Number { name: "step", value: step_rad });
        }
        let sweep = section.length_m() / self.lead_m_per_rad(drum);
        let steps = (sweep / step_rad).ceil().max(1.0);
        if steps.is_nan() || steps >= MOST_POINTS as f64 {
            return Err(GeometryError::TooMany { count: steps + 1.0, limit: MOST_POINTS });
        }
        let rad_per_m = self.hand(drum).sign() / self.lead_m_per_rad(drum);
        let starts = match drum {
            Drum::Input => 1,
            Drum::Output => self.layout.starts,
        };
        let path = |start: u32| {
            let at_zero_m = self.groove_z_m(drum, group, f64::from(start), 0.0);
            let mut points = Vec::new();
            let mut i = 0.0;
            while i <= steps {
                let z_m = section.from_m + section.length_m() * (i / steps);
                points.push([(z_m - at_zero_m) * rad_per_m, z_m]);
                i += 1.0;
            }
            GroovePath { start, points }
        };
        Ok((0..starts).map(path).collect())
    }
}
