//! Motions of the slider, and the force that they need.

use std::f64::consts::PI;

use forcewright_base::maths;

use crate::mechanism::{Drive, Instant, Mechanism, NotAssembled, Sense};

/// How the slider moves over time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// u − sin(2πu)/2π: eq. (17) of Sánchez-Salinas et al.
    Cycloidal,
    /// 10u³ − 15u⁴ + 6u⁵.
    Polynomial,
    /// u.
    Uniform,
}

/// A motion of the slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Its law.
    pub law: Law,
    /// Travel at the beginning, m.
    pub start_m: f64,
    /// How far, m.
    pub rise_m: f64,
    /// How long, s.
    pub duration_s: f64,
    /// A slower one to compare with, s.
    pub reference_s: Option<f64>,
}

impl Motion {
    /// Travel, speed and acceleration at a part u of the duration from 0 to 1.
    pub fn at(&self, u: f64) -> [f64; 3] {
        let [p, v, a] = match self.law {
            Law::Cycloidal => {
                let (sin, cos) = maths::sin_cos(2.0 * PI * u);
                [u - sin / (2.0 * PI), 1.0 - cos, 2.0 * PI * sin]
            }
            Law::Polynomial => {
                let w = 1.0 - u;
                [u * u * u * (10.0 + u * (6.0 * u - 15.0)), 30.0 * u * u * w * w, 60.0 * u * w * (1.0 - 2.0 * u)]
            }
            Law::Uniform => [u, 1.0, 0.0],
        };
        let t = self.duration_s;
        [self.start_m + self.rise_m * p, self.rise_m * v / t, self.rise_m * a / (t * t)]
    }

    /// The same motion in another time.
    pub fn lasting(&self, duration_s: f64) -> Self {
        Self { duration_s, ..*self }
    }
}

/// An instant of a motion.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// s.
    pub time_s: f64,
    /// Travel, m.
    pub travel_m: f64,
    /// Forces in the motion.
    pub moving: Instant,
    /// Forces at rest at the same place, with the same friction.
    pub resting: Instant,
}

/// Steps between the ends.
pub(crate) const STEPS: usize = 400;

/// Forces over a motion, at even times.
///
/// # Errors
/// [`NotAssembled`] if the mechanism does not reach a place on the way.
pub(crate) fn run(mechanism: &Mechanism, motion: &Motion) -> Result<Vec<Moment>, NotAssembled> {
    let sense = if motion.rise_m >= 0.0 { Sense::Up } else { Sense::Down };
    let mut pose = None;
    (0..=STEPS)
        .map(|i| {
            let u = i as f64 / STEPS as f64;
            let [s, v, a] = motion.at(u);
            let here = mechanism.pose_near([s, 0.0], pose.as_ref())?;
            let drive = Drive { at: [s, 0.0], velocity: [v, 0.0], acceleration: [a, 0.0] };
            let moving = mechanism.forces(&here, &drive, sense);
            let resting = mechanism.forces(&here, &Drive::rest(s), sense);
            pose = Some(here);
            Ok(Moment { time_s: u * motion.duration_s, travel_m: s, moving, resting })
        })
        .collect()
}
