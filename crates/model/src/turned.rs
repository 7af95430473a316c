//! What is made on a lathe: a stack of plain and helically grooved sections around the z axis. Lengths in metres.

mod groove;
mod section;

use std::f64::consts::PI;
use std::fmt;

use forcewright_curves::Profile;

pub use groove::{Groove, GrooveError};

/// Shortest length that can be made, m.
const LEAST_M: f64 = 1e-6;
/// Length that is too long, m.
const TOO_LONG_M: f64 = 1e3;
/// Points nearer to each other are one, m.
const SAME_M: f64 = 1e-10;
/// Most grooves that cross a line along a section.
const MOST_GROOVES: f64 = 1e4;
/// A phase that cannot be meant, rad.
const FAR_RAD: f64 = 1e6;
/// Most grooves side by side.
const MOST_STARTS: u32 = 1000;

/// A turned body: sections one upon another along z, the first of them from z = 0, around a round bore.
///
/// ```
/// use forcewright_model::{Groove, Grooved, Section, Turned};
///
/// // A drum of 20 mm with five right-handed grooves for a cable of 2 mm, and a flange.
/// let groove = Groove::round(0.020, 2.6e-3, 1.05e-3, 0.8e-3)?;
/// let grooved = Grooved { length_m: 0.030, lead_m: 13e-3, starts: 5, phase_rad: 0.0, groove };
/// let flange = Section::Plain { length_m: 0.003, radius_m: 0.024 };
/// let drum = Turned { bore_diameter_m: 0.008, sections: vec![flange, Section::Grooved(grooved)], drillings: Vec::new() };
/// drum.check()?;
/// assert!((drum.length_m() - 0.033).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Turned {
    /// Diameter of the round bore all through, m; 0 if there is none.
    pub bore_diameter_m: f64,
    /// From z = 0 upwards. Between neighbours there is a clear step: the one is larger than the other at every angle.
    pub sections: Vec<Section>,
    /// Holes from outside. They are told in tables and drawings, but cut into no solid, and no volume is without them.
    pub drillings: Vec<Drilling>,
}

/// A part of a turned body between two planes across its axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Section {
    /// A cylinder.
    Plain {
        /// Along the axis, m.
        length_m: f64,
        /// Its radius, m.
        radius_m: f64,
    },
    /// With grooves that run out through both its ends.
    Grooved(Grooved),
}

/// A section with helical grooves side by side.
///
/// The point (ζ, ρ) of its profile in groove k appears, at height z above the lower end of the section, at the radius ρ and the angle
/// φ + 2π(z − ζ)/lead + 2πk/starts, with the phase φ.
#[derive(Clone, Debug, PartialEq)]
pub struct Grooved {
    /// Along the axis, m.
    pub length_m: f64,
    /// By how much a groove rises in a turn, m; positive is right-handed.
    pub lead_m: f64,
    /// Number of grooves side by side, 1 to 1000.
    pub starts: u32,
    /// Angle of the middle of groove 0, where ζ = 0, at the lower end of the section, from the x axis towards y, rad.
    pub phase_rad: f64,
    /// One groove and the land beside it.
    pub groove: Groove,
}

/// A round hole from outside towards the axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Drilling {
    /// Height of its middle above the lower end of the body, m.
    pub z_m: f64,
    /// Its angle from the x axis towards y, rad.
    pub angle_rad: f64,
    /// Its diameter, m.
    pub diameter_m: f64,
    /// From the surface inwards, m.
    pub depth_m: f64,
    /// What it is for: `end of the cable`.
    pub purpose: String,
}

/// Why a turned body cannot be made. Sections and drillings count from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TurnedError {
    /// There are no sections.
    Empty,
    /// The length is not between a micrometre and a kilometre.
    Length {
        /// The section.
        section: usize,
        /// Its length, m.
        length_m: f64,
    },
    /// The radius is not between a micrometre and a kilometre.
    Radius {
        /// The section.
        section: usize,
        /// Its smallest or largest radius, m.
        radius_m: f64,
    },
    /// The lead is not finite or zero, or the phase not within a million radians.
    Lead {
        /// The section.
        section: usize,
        /// Its lead, m.
        lead_m: f64,
    },
    /// No grooves, or more than a thousand.
    Starts {
        /// The section.
        section: usize,
        /// How many.
        starts: u32,
    },
    /// From groove to groove it is less than a micrometre, or less than the ten thousandth part of the length.
    Spacing {
        /// The section.
        section: usize,
        /// From groove to groove, m.
        spacing_m: f64,
    },
    /// The profile of the groove is none.
    Groove {
        /// The section.
        section: usize,
        /// Why.
        error: GrooveError,
    },
    /// A section is neither larger nor smaller than the next one at every angle, by a micrometre at least.
    Step {
        /// The lower of the two.
        section: usize,
        /// Least and greatest radius of the lower and of the upper one, m.
        radii_m: [[f64; 2]; 2],
    },
    /// The bore leaves no wall of a micrometre.
    Bore {
        /// Its diameter, m.
        diameter_m: f64,
        /// The section with the least radius.
        section: usize,
        /// That radius, m.
        radius_m: f64,
    },
    /// The drilling is beside the body, or its diameter or depth is no length that can be made.
    Drilling {
        /// The drilling.
        drilling: usize,
    },
}

impl fmt::Display for TurnedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "there are no sections"),
            Self::Length { section, length_m } => write!(f, "section {}: a length of {length_m} m cannot be made", section + 1),
            Self::Radius { section, radius_m } => write!(f, "section {}: a radius of {radius_m} m cannot be made", section + 1),
            Self::Lead { section, lead_m } => {
                write!(f, "section {}: the lead ({lead_m} m) must be finite and not zero, the phase within a million radians", section + 1)
            }
            Self::Starts { section, starts } => write!(f, "section {}: {starts} grooves side by side, allowed are 1 to 1000", section + 1),
            Self::Spacing { section, spacing_m } => write!(
                f,
                "section {}: {spacing_m} m from groove to groove; it must be a micrometre or more, and leave at most 10000 grooves along the section",
                section + 1
            ),
            Self::Groove { section, error } => write!(f, "section {}: {error}", section + 1),
            Self::Step { section, radii_m: [[a, b], [c, d]] } => write!(
                f,
                "sections {} and {} overlap: radii {a} m to {b} m and {c} m to {d} m; one must be larger than the other everywhere",
                section + 1,
                section + 2
            ),
            Self::Bore { diameter_m, section, radius_m } => {
                write!(f, "a bore of {diameter_m} m leaves no wall in section {} with its least radius of {radius_m} m", section + 1)
            }
            Self::Drilling { drilling } => {
                write!(f, "drilling {} is beside the body, or has no diameter or depth that can be made", drilling + 1)
            }
        }
    }
}

impl std::error::Error for TurnedError {}

impl Turned {
    /// Its length along the axis, m.
    pub fn length_m(&self) -> f64 {
        self.sections.iter().map(Section::length_m).sum()
    }

    /// Its largest radius, m; 0 without sections.
    pub fn largest_radius_m(&self) -> f64 {
        self.sections.iter().map(|section| section.radii_m()[1]).fold(0.0, f64::max)
    }

    /// Heights of the lower ends of all sections and of the upper end of the last one, m.
    pub fn steps_m(&self) -> Vec<f64> {
        let mut steps_m = vec![0.0];
        for section in &self.sections {
            steps_m.push(steps_m[steps_m.len() - 1] + section.length_m());
        }
        steps_m
    }

    /// Its volume, m³, in closed form: the same area across every section, (π/spacing)·∫ρ² dζ over one groove in a grooved one.
    /// Drillings are not taken off.
    pub fn volume_m3(&self) -> f64 {
        let bore_m2 = 0.25 * PI * self.bore_diameter_m * self.bore_diameter_m;
        self.sections.iter().map(|section| section.length_m() * (section.area_m2() - bore_m2)).sum()
    }

    /// ∫r² dV about its axis, m⁵, in closed form: (π/2)(length/spacing)·∫ρ⁴ dζ in a grooved section. Drillings are not taken off. Times the
    /// density it is the moment of inertia.
    pub fn polar_moment_m5(&self) -> f64 {
        let bore_m = 0.5 * self.bore_diameter_m;
        let bore_m4 = 0.5 * PI * bore_m * bore_m * bore_m * bore_m;
        self.sections.iter().map(|section| section.length_m() * (section.polar_m4() - bore_m4)).sum()
    }

    /// Whether it can be made.
    ///
    /// # Errors
    /// The first [`TurnedError`] that is found.
    pub fn check(&self) -> Result<(), TurnedError> {
        if self.sections.is_empty() {
            return Err(TurnedError::Empty);
        }
        for (index, section) in self.sections.iter().enumerate() {
            section.check(index)?;
        }
        if !is_length(self.length_m()) {
            return Err(TurnedError::Length { section: self.sections.len() - 1, length_m: self.length_m() });
        }
        for (section, pair) in self.sections.windows(2).enumerate() {
            let radii_m = [pair[0].radii_m(), pair[1].radii_m()];
            let [[a, b], [c, d]] = radii_m;
            if a - d < LEAST_M && c - b < LEAST_M {
                return Err(TurnedError::Step { section, radii_m });
            }
        }
        let least = |(section, each): (usize, &Section)| (section, each.radii_m()[0]);
        let thinnest = self.sections.iter().enumerate().map(least).min_by(|a, b| a.1.total_cmp(&b.1));
        let (section, radius_m) = thinnest.unwrap_or_default();
        let diameter_m = self.bore_diameter_m;
        if !(diameter_m == 0.0 || is_length(diameter_m)) || radius_m - 0.5 * diameter_m < LEAST_M {
            return Err(TurnedError::Bore { diameter_m, section, radius_m });
        }
        let is_sound = |each: &Drilling| {
            (0.0..=self.length_m()).contains(&each.z_m)
                && each.angle_rad.is_finite()
                && is_length(each.diameter_m)
                && is_length(each.depth_m)
        };
        match self.drillings.iter().position(|each| !is_sound(each)) {
            Some(drilling) => Err(TurnedError::Drilling { drilling }),
            None => Ok(()),
        }
    }

    /// What lies on one side of the axis in the half plane at an angle: abscissas are z, ordinates radii. Counterclockwise.
    ///
    /// # Errors
    /// When it cannot be made ([`Turned::check`]).
    pub fn half_section(&self, angle_rad: f64) -> Result<Profile, TurnedError> {
        self.check()?;
        Ok(section::half(self, angle_rad))
    }
}

impl Section {
    /// Along the axis, m.
    pub fn length_m(&self) -> f64 {
        match self {
            Self::Plain { length_m, .. } => *length_m,
            Self::Grooved(grooved) => grooved.length_m,
        }
    }

    /// Its grooves, if it has such.
    pub fn grooved(&self) -> Option<&Grooved> {
        match self {
            Self::Grooved(grooved) => Some(grooved),
            Self::Plain { .. } => None,
        }
    }

    /// Its least and its greatest radius, m.
    pub fn radii_m(&self) -> [f64; 2] {
        match self {
            Self::Plain { radius_m, .. } => [*radius_m; 2],
            Self::Grooved(grooved) => grooved.groove.radii_m(),
        }
    }

    /// Area within its outer boundary, m²; the same at every height.
    pub fn area_m2(&self) -> f64 {
        match self {
            Self::Plain { radius_m, .. } => PI * radius_m * radius_m,
            Self::Grooved(grooved) => PI / grooved.spacing_m() * grooved.groove.squares_m3(),
        }
    }

    /// ∫r² dA within its outer boundary, m⁴; the same at every height.
    fn polar_m4(&self) -> f64 {
        match self {
            Self::Plain { radius_m, .. } => 0.5 * PI * radius_m * radius_m * radius_m * radius_m,
            Self::Grooved(grooved) => 0.5 * PI / grooved.spacing_m() * grooved.groove.fourths_m5(),
        }
    }

    fn check(&self, section: usize) -> Result<(), TurnedError> {
        let length_m = self.length_m();
        if !is_length(length_m) {
            return Err(TurnedError::Length { section, length_m });
        }
        if let Self::Grooved(grooved) = self {
            grooved.check(section)?;
        }
        match self.radii_m().into_iter().find(|radius_m| !is_length(*radius_m)) {
            Some(radius_m) => Err(TurnedError::Radius { section, radius_m }),
            None => Ok(()),
        }
    }
}

impl Grooved {
    /// From groove to groove along the axis, m.
    pub fn spacing_m(&self) -> f64 {
        self.lead_m.abs() / f64::from(self.starts)
    }

    fn check(&self, section: usize) -> Result<(), TurnedError> {
        let (lead_m, starts) = (self.lead_m, self.starts);
        if !(lead_m.is_finite() && self.phase_rad.abs() < FAR_RAD) || lead_m == 0.0 {
            return Err(TurnedError::Lead { section, lead_m });
        }
        if !(1..=MOST_STARTS).contains(&starts) {
            return Err(TurnedError::Starts { section, starts });
        }
        let spacing_m = self.spacing_m();
        if !is_length(spacing_m) || self.length_m > MOST_GROOVES * spacing_m {
            return Err(TurnedError::Spacing { section, spacing_m });
        }
        self.groove.check(spacing_m).map_err(|error| TurnedError::Groove { section, error })
    }
}

/// Whether something so long can be made.
fn is_length(length_m: f64) -> bool {
    (LEAST_M..TOO_LONG_M).contains(&length_m)
}

#[cfg(test)]
mod tests;
