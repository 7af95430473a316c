//! Springs wound of round wire: helices with straight legs. Lengths in metres.

mod clearance;
mod line;
mod space;

use std::f64::consts::PI;
use std::fmt;

use forcewright_base::maths;

pub use line::{WireKind, WireLine, WirePiece, WireStation};

/// Shortest length that can be made, and least gap between turns, m.
const LEAST_M: f64 = 1e-6;
/// Length that is too long, m.
const TOO_LONG_M: f64 = 1e3;
/// Most turns.
const MOST_TURNS: f64 = 1e3;
/// Least part of a turn.
const LEAST_TURNS: f64 = 1e-3;
/// An angle that cannot be meant, rad.
const FAR_RAD: f64 = 1e6;
/// By how much pitches may differ where windings meet, over the mean radius.
const SAME_PITCH: f64 = 1e-12;

/// A spring of round wire, wound around the z axis. Its windings begin with the middle of the wire at z = 0 and rise along z.
///
/// The middle of the wire is (R cos θ, ± R sin θ, z(θ)), turned by the start angle about z, with the mean radius R and plus for a
/// right-handed spring. Legs leave it along its tangent, at once or after a bend, so that the wire has no kink. Both ends are cut square to
/// the wire. There are no hooks or loops: of an extension spring this is the body alone.
///
/// ```
/// use forcewright_model::{Coil, CoilEnd, Winding};
///
/// // Ten close turns of 1 mm wire around 10 mm, one end bent along the axis.
/// let coil = Coil {
///     wire_m: 1e-3,
///     radius_m: 5.5e-3,
///     windings: vec![Winding::even(10.0, 1.1e-3)],
///     is_right_handed: true,
///     start_rad: 0.0,
///     ends: [CoilEnd::Cut, CoilEnd::Axial { bend_m: 1.5e-3, length_m: 3e-3 }],
/// };
/// coil.check()?;
/// assert!((coil.outer_diameter_m() - 12e-3).abs() < 1e-15);
/// # Ok::<(), forcewright_model::CoilError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Coil {
    /// Diameter of the wire, m.
    pub wire_m: f64,
    /// Radius of the middle of the wire about the axis, m; more than half the wire.
    pub radius_m: f64,
    /// From the lower end upwards; each begins with the pitch with which the one before ends.
    pub windings: Vec<Winding>,
    /// Wound like a common screw.
    pub is_right_handed: bool,
    /// Angle of the lower end of the windings about the axis, from x towards y, rad.
    pub start_rad: f64,
    /// How the wire ends, below and above.
    pub ends: [CoilEnd; 2],
}

/// Some turns, with a pitch that is constant or changes linearly with the angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Winding {
    /// How many; above 0.
    pub turns: f64,
    /// By how much the wire rises in a turn, at the lower and the upper end, m; at least 0.
    pub pitch_m: [f64; 2],
}

impl Winding {
    /// With a constant pitch (m).
    pub fn even(turns: f64, pitch_m: f64) -> Self {
        Self { turns, pitch_m: [pitch_m; 2] }
    }
}

/// How a wire goes on beyond its windings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoilEnd {
    /// Not at all: it is cut square.
    Cut,
    /// Straight, along the tangent.
    Tangential {
        /// Length of the straight leg, m.
        length_m: f64,
    },
    /// Bent away from the windings until it is parallel to the axis. The leg lies farther out than the windings, by what the bend takes.
    Axial {
        /// Radius of the bend in the middle of the wire, m; more than half the wire.
        bend_m: f64,
        /// Length of the straight leg, m.
        length_m: f64,
    },
    /// Bent by a right angle, straight away from the axis. The leg passes the axis at a distance of the bend's radius.
    Outward {
        /// Radius of the bend in the middle of the wire, m; more than half the wire.
        bend_m: f64,
        /// Length of the straight leg, m.
        length_m: f64,
    },
    /// Bent by a right angle, to the inside of the windings.
    Inward {
        /// Radius of the bend in the middle of the wire, m; more than half the wire.
        bend_m: f64,
        /// Length of the straight leg, m.
        length_m: f64,
    },
}

impl CoilEnd {
    /// Radius of its bend, if it has one, m.
    pub fn bend_m(&self) -> Option<f64> {
        match self {
            Self::Cut | Self::Tangential { .. } => None,
            Self::Axial { bend_m, .. } | Self::Outward { bend_m, .. } | Self::Inward { bend_m, .. } => Some(*bend_m),
        }
    }

    /// Length of its straight leg, m; 0 without.
    pub fn leg_m(&self) -> f64 {
        match self {
            Self::Cut => 0.0,
            Self::Tangential { length_m }
            | Self::Axial { length_m, .. }
            | Self::Outward { length_m, .. }
            | Self::Inward { length_m, .. } => *length_m,
        }
    }

    /// What it is: `leg along the axis`.
    pub fn words(&self) -> &'static str {
        match self {
            Self::Cut => "cut square",
            Self::Tangential { .. } => "leg along the tangent",
            Self::Axial { .. } => "leg along the axis",
            Self::Outward { .. } => "leg outwards",
            Self::Inward { .. } => "leg inwards",
        }
    }
}

/// Why a coil cannot be made. Windings and ends count from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoilError {
    /// The wire's diameter is not between a micrometre and a kilometre.
    Wire {
        /// Diameter, m.
        wire_m: f64,
    },
    /// The mean radius leaves no hole of a micrometre's radius, or is too large.
    Radius {
        /// Mean radius, m.
        radius_m: f64,
        /// Diameter of the wire, m.
        wire_m: f64,
    },
    /// There are no windings.
    Empty,
    /// A winding has less than a thousandth of a turn, or all have more than a thousand.
    Turns {
        /// The winding.
        winding: usize,
        /// Its turns.
        turns: f64,
    },
    /// A pitch is negative or not finite.
    Pitch {
        /// The winding.
        winding: usize,
        /// At its lower and upper end, m.
        pitch_m: [f64; 2],
    },
    /// The wire has a kink between two windings.
    Kink {
        /// The upper of the two.
        winding: usize,
        /// Pitch of the lower one where it ends, and of the upper one where it begins, m.
        pitch_m: [f64; 2],
    },
    /// The start angle is not within a million radians.
    Start {
        /// The angle, rad.
        start_rad: f64,
    },
    /// The length of a leg is not between a micrometre and a kilometre.
    Leg {
        /// The end.
        end: usize,
        /// Its length, m.
        length_m: f64,
    },
    /// A bend that is not wider than half the wire.
    Bend {
        /// The end.
        end: usize,
        /// Its radius in the middle of the wire, m.
        bend_m: f64,
        /// Diameter of the wire, m.
        wire_m: f64,
    },
    /// A pitch changes so fast that the wire would be bent more tightly than its own radius.
    Tight {
        /// The winding.
        winding: usize,
        /// Radius of curvature in the middle of the wire, m, or less.
        radius_m: f64,
    },
    /// Turns or legs touch or cross each other, or keep less than a micrometre apart.
    Touches {
        /// Where, in lengths of wire from the lower end, m.
        at_m: [f64; 2],
        /// From middle to middle of the wire, m.
        distance_m: f64,
        /// Diameter of the wire, m.
        wire_m: f64,
    },
}

impl fmt::Display for CoilError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Wire { wire_m } => write!(f, "a wire of {wire_m} m cannot be made"),
            Self::Radius { radius_m, wire_m } => write!(f, "a mean radius of {radius_m} m with a wire of {wire_m} m cannot be wound"),
            Self::Empty => write!(f, "there are no windings"),
            Self::Turns { winding, turns } => {
                write!(f, "winding {}: {turns} turns; a thousandth of a turn or more, and at most 1000 in all", winding + 1)
            }
            Self::Pitch { winding, pitch_m: [low, high] } => {
                write!(f, "winding {}: pitches of {low} m and {high} m; they must be finite and not negative", winding + 1)
            }
            Self::Kink { winding, pitch_m: [below, above] } => write!(
                f,
                "windings {winding} and {}: the pitch jumps from {below} m to {above} m, which would be a kink; let it change over part of a turn",
                winding + 1
            ),
            Self::Start { start_rad } => write!(f, "a start angle of {start_rad} rad; it must lie within a million radians"),
            Self::Leg { end, length_m } => write!(f, "the {} leg: a length of {length_m} m cannot be made", which(*end)),
            Self::Bend { end, bend_m, wire_m } => write!(
                f,
                "the bend at the {} end has a mean radius of {bend_m} m, a wire of {wire_m} m needs more than half its diameter",
                which(*end)
            ),
            Self::Tight { winding, radius_m } => {
                write!(f, "winding {}: the pitch changes so fast that the wire is bent to a radius of {radius_m} m", winding + 1)
            }
            Self::Touches { at_m: [one, other], distance_m, wire_m } => write!(
                f,
                "the wire of {wire_m} m touches itself: {one:.6} m and {other:.6} m from its lower end its middle is {distance_m} m apart"
            ),
        }
    }
}

impl std::error::Error for CoilError {}

fn which(end: usize) -> &'static str {
    if end == 0 { "lower" } else { "upper" }
}

impl Coil {
    /// All turns.
    pub fn turns(&self) -> f64 {
        self.windings.iter().map(|winding| winding.turns).sum()
    }

    /// By how much the middle of the wire rises along its windings, m.
    pub fn rise_m(&self) -> f64 {
        self.windings.iter().map(|winding| 0.5 * winding.turns * (winding.pitch_m[0] + winding.pitch_m[1])).sum()
    }

    /// Outer diameter of the windings, m: of the cylinder around them, which they touch everywhere.
    pub fn outer_diameter_m(&self) -> f64 {
        2.0 * self.radius_m + self.wire_m
    }

    /// Inner diameter of the windings, m.
    pub fn inner_diameter_m(&self) -> f64 {
        2.0 * self.radius_m - self.wire_m
    }

    /// The middle of the wire from its lower to its upper end.
    pub fn line(&self) -> WireLine {
        WireLine::new(self)
    }

    /// Length of the wire in its middle, m, with bends and legs.
    pub fn wire_length_m(&self) -> f64 {
        self.line().length_m()
    }

    /// Length of wire beyond the windings, m, below and above: bend and leg.
    pub fn ends_m(&self) -> [f64; 2] {
        let line = self.line();
        let of = |pieces: &mut dyn Iterator<Item = &WirePiece>| {
            pieces.take_while(|piece| piece.kind() != WireKind::Wound).map(WirePiece::length_m).sum()
        };
        [of(&mut line.pieces().iter()), of(&mut line.pieces().iter().rev())]
    }

    /// Its volume, m³: the area of the wire times the length of its middle. That is exact for every tube with flat ends that is bent less
    /// tightly than its own radius: what a bend takes inside it gives outside (Pappus' theorem, generalised by Goodman and Goodman,
    /// Generalizations of the theorems of Pappus, 1969).
    pub fn volume_m3(&self) -> f64 {
        0.25 * PI * self.wire_m * self.wire_m * self.wire_length_m()
    }

    /// Its surface, m², with both ends; exact for the same reason.
    pub fn surface_m2(&self) -> f64 {
        PI * self.wire_m * (self.wire_length_m() + 0.5 * self.wire_m)
    }

    /// Least and greatest x, y and z of the wire's surface, m.
    pub fn extent_m(&self) -> [[f64; 3]; 2] {
        let line = self.line();
        let reach = |sign: f64| {
            [0, 1, 2].map(|axis| {
                let mut towards = [0.0; 3];
                towards[axis] = sign;
                sign * line.reach_m(towards, 0.5 * self.wire_m)
            })
        };
        [reach(-1.0), reach(1.0)]
    }

    /// Its length along the axis over the wire, with bends and legs, m.
    pub fn length_m(&self) -> f64 {
        let [low, high] = self.extent_m();
        high[2] - low[2]
    }

    /// Whether it can be made. Values of a coil that cannot mean nothing.
    ///
    /// # Errors
    /// The first [`CoilError`] that is found.
    pub fn check(&self) -> Result<(), CoilError> {
        let (wire_m, radius_m) = (self.wire_m, self.radius_m);
        if !is_length(wire_m) {
            return Err(CoilError::Wire { wire_m });
        }
        if !is_length(radius_m) || radius_m - 0.5 * wire_m < LEAST_M {
            return Err(CoilError::Radius { radius_m, wire_m });
        }
        if self.windings.is_empty() {
            return Err(CoilError::Empty);
        }
        self.check_windings()?;
        if self.start_rad.is_nan() || self.start_rad.abs() > FAR_RAD {
            return Err(CoilError::Start { start_rad: self.start_rad });
        }
        for (end, each) in self.ends.iter().enumerate() {
            if *each != CoilEnd::Cut && !is_length(each.leg_m()) {
                return Err(CoilError::Leg { end, length_m: each.leg_m() });
            }
            match each.bend_m() {
                Some(bend_m) if !is_length(bend_m) || bend_m - 0.5 * wire_m < LEAST_M => {
                    return Err(CoilError::Bend { end, bend_m, wire_m });
                }
                _ => {}
            }
        }
        let nearest = clearance::nearest(self);
        if nearest.distance_m - wire_m < LEAST_M {
            return Err(CoilError::Touches { at_m: nearest.at_m, distance_m: nearest.distance_m, wire_m });
        }
        Ok(())
    }

    fn check_windings(&self) -> Result<(), CoilError> {
        let mut turns = 0.0;
        for (winding, each) in self.windings.iter().enumerate() {
            turns += each.turns;
            if !(each.turns >= LEAST_TURNS && turns <= MOST_TURNS) {
                return Err(CoilError::Turns { winding, turns: each.turns });
            }
            if !each.pitch_m.iter().all(|pitch_m| (0.0..TOO_LONG_M).contains(pitch_m)) {
                return Err(CoilError::Pitch { winding, pitch_m: each.pitch_m });
            }
            if let Some(below) = winding.checked_sub(1).and_then(|below| self.windings.get(below))
                && (below.pitch_m[1] - each.pitch_m[0]).abs() > SAME_PITCH * self.radius_m
            {
                return Err(CoilError::Kink { winding, pitch_m: [below.pitch_m[1], each.pitch_m[0]] });
            }
            let radius_m = self.least_curvature_radius_m(each);
            if radius_m - 0.5 * self.wire_m < LEAST_M {
                return Err(CoilError::Tight { winding, radius_m });
            }
        }
        Ok(())
    }

    /// A lower bound of the radius of curvature of a winding, m: `ℓ³/(R √(ℓ² + q′²))` with the rise q per radian and ℓ² = R² + q², where
    /// q is least. Where the pitch is constant it is the radius itself, `ℓ²/R`.
    fn least_curvature_radius_m(&self, winding: &Winding) -> f64 {
        let [low, high] = winding.pitch_m.map(|pitch_m| pitch_m / (2.0 * PI));
        let bend = (high - low) / (2.0 * PI * winding.turns);
        let length = maths::hypot(self.radius_m, low.min(high));
        length * length * length / (self.radius_m * maths::hypot(length, bend))
    }
}

/// Whether something so long can be made.
fn is_length(length_m: f64) -> bool {
    (LEAST_M..TOO_LONG_M).contains(&length_m)
}

#[cfg(test)]
mod tests;
