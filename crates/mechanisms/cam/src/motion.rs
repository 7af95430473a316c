//! Prescribed motions of the slider, and the force that they need. Motions that follow from a force: [`crate::release`].

pub(crate) mod curves;

use std::f64::consts::PI;

use forcewright_base::maths;
use forcewright_multibody::{Ended, Ode, OdeSettings, integrate};

use crate::mechanism::{Drive, Instant, Mechanism, NotAssembled, Pose, Sense};

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

/// A motion of the slider: a stroke by its law, or a repetition of stroke, pause and the same stroke back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Its law.
    pub law: Law,
    /// Travel at the beginning, m.
    pub start_m: f64,
    /// How far, m.
    pub rise_m: f64,
    /// How long a stroke takes, s.
    pub duration_s: f64,
    /// How long the slider rests after the stroke, s.
    pub pause_s: f64,
    /// Whether it then moves back in the same time.
    pub returns: bool,
    /// A slower one to compare with, s.
    pub reference_s: Option<f64>,
}

impl Motion {
    /// Travel, speed and acceleration at a part u of the stroke's duration from 0 to 1.
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

    /// The same motion in another time; a pause stays as long as it is.
    pub fn lasting(&self, duration_s: f64) -> Self {
        Self { duration_s, ..*self }
    }

    /// Direction, time, and travel, speed and acceleration at even times of each phase.
    pub(crate) fn instants(&self) -> impl Iterator<Item = (Sense, f64, [f64; 3])> + '_ {
        self.phases().into_iter().flat_map(move |phase| {
            let time = move |i: usize| phase.start_s + phase.duration_s * i as f64 / phase.steps as f64;
            (0..=phase.steps).map(move |i| (phase.sense, time(i), phase.at(self, time(i))))
        })
    }

    /// The phases in their order.
    fn phases(&self) -> Vec<Phase> {
        let forth = if self.rise_m >= 0.0 { Sense::Up } else { Sense::Down };
        let back = if self.rise_m >= 0.0 { Sense::Down } else { Sense::Up };
        let mut all = vec![Phase { start_s: 0.0, duration_s: self.duration_s, sense: forth, from: 0.0, to: 1.0, steps: STEPS }];
        if self.pause_s > 0.0 {
            // At rest friction may hold either way: the middle of what the hand may give.
            let sense = Sense::Frictionless;
            all.push(Phase { start_s: self.duration_s, duration_s: self.pause_s, sense, from: 1.0, to: 1.0, steps: PAUSE_STEPS });
        }
        if self.returns {
            let start_s = self.duration_s + self.pause_s;
            all.push(Phase { start_s, duration_s: self.duration_s, sense: back, from: 1.0, to: 0.0, steps: STEPS });
        }
        all
    }
}

/// Part of a motion with friction one way.
#[derive(Clone, Copy, Debug)]
struct Phase {
    start_s: f64,
    duration_s: f64,
    sense: Sense,
    /// Parts of the stroke.
    from: f64,
    to: f64,
    /// Even, for Simpson's rule.
    steps: usize,
}

impl Phase {
    /// Travel, speed and acceleration at a time.
    fn at(&self, motion: &Motion, time_s: f64) -> [f64; 3] {
        let part = (time_s - self.start_s) / self.duration_s;
        let way = self.to - self.from;
        let [s, v, a] = motion.at(self.from + way * part);
        // Way back: the law is passed backwards, so that its speed turns and its acceleration stays.
        [s, way * v, way * way * a]
    }
}

/// An instant of a motion.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// s.
    pub time_s: f64,
    /// Travel, m.
    pub travel_m: f64,
    /// m/s.
    pub speed_m_per_s: f64,
    /// Way of a free slider to the right, m.
    pub sideways_m: f64,
    /// Forces in the motion.
    pub moving: Instant,
    /// Forces at rest at the same place, with the same friction.
    pub resting: Instant,
    /// Power that friction takes, W.
    pub lost_w: f64,
    /// Tension of the cable on which a weight hangs, N.
    pub cable_n: Option<f64>,
}

/// Steps of a stroke.
pub(crate) const STEPS: usize = 400;
/// Steps of a pause.
const PAUSE_STEPS: usize = 20;

/// Forces over a motion, at even times in each phase; a free slider goes sideways as its mass and the forces on it let it.
///
/// # Errors
/// [`NotAssembled`] if the mechanism does not reach a place on the way, or friction locks it there.
pub fn prescribed(mechanism: &Mechanism, motion: &Motion, sideways_m: Option<f64>) -> Result<Vec<Moment>, NotAssembled> {
    let mut all = Vec::new();
    let mut across = sideways_m.map(|x| [x, 0.0]);
    for phase in motion.phases() {
        let times: Vec<f64> = (0..=phase.steps).map(|i| phase.start_s + phase.duration_s * i as f64 / phase.steps as f64).collect();
        let ways = match across {
            Some(start) => Across { mechanism, motion, phase }.over(&times, start)?,
            None => vec![[0.0; 2]; times.len()],
        };
        across = across.and(ways.last().copied());
        let mut pose: Option<Pose> = None;
        for (time, [x, u]) in times.iter().zip(ways) {
            let [s, v, a] = phase.at(motion, *time);
            let here = mechanism.pose_near([s, x], pose.as_ref())?;
            let mut drive = Drive { at: [s, x], velocity: [v, u], acceleration: [a, 0.0] };
            if across.is_some() {
                drive.acceleration[1] = mechanism.free_acceleration(&here, &drive, phase.sense);
            }
            let found = moment(mechanism, &here, &drive, phase.sense, *time);
            // Friction locks the rollers, or the start is singular.
            if !(found.moving.force_n + found.resting.force_n).is_finite() {
                return Err(NotAssembled { side: 0, gap_m: f64::NAN });
            }
            all.push(found);
            pose = Some(here);
        }
    }
    Ok(all)
}

/// Everything about an instant whose position is known.
pub(crate) fn moment(mechanism: &Mechanism, pose: &Pose, drive: &Drive, sense: Sense, time_s: f64) -> Moment {
    let [moving, smooth] = mechanism.forces_in(pose, drive, [sense, Sense::Frictionless]);
    let resting = mechanism.forces(pose, &Drive { at: drive.at, ..Drive::default() }, sense);
    let lost_w = (moving.force_n - smooth.force_n) * drive.velocity[0] + (moving.guide_n - smooth.guide_n) * drive.velocity[1];
    let [travel_m, sideways_m] = drive.at;
    Moment { time_s, travel_m, speed_m_per_s: drive.velocity[0], sideways_m, moving, resting, lost_w, cable_n: None }
}

/// The sideways motion of a slider that is driven along its travel: what guides it is zero.
struct Across<'a> {
    mechanism: &'a Mechanism,
    motion: &'a Motion,
    phase: Phase,
}

/// Local error of a step, relative to a millimetre and the speed that belongs to it.
const ACCURACY: f64 = 1e-10;

impl Across<'_> {
    /// Way and speed sideways at given times.
    fn over(mut self, times: &[f64], start: [f64; 2]) -> Result<Vec<[f64; 2]>, NotAssembled> {
        let (Some(&start_s), Some(&end_s)) = (times.first(), times.last()) else { return Ok(Vec::new()) };
        let size = 1e-3;
        let settings = OdeSettings {
            start_s,
            end_s,
            accuracy: ACCURACY,
            sizes: &[size, size / self.phase.duration_s],
            outputs_s: times,
            max_steps: 200_000,
        };
        let run = integrate(&mut self, &start, &settings);
        match run.ended {
            Ended::Time => Ok(run.kept.iter().map(|(_, y)| [y[0], y[1]]).collect()),
            Ended::Failed(why) => Err(why),
            // It runs away from its axis.
            Ended::Event(_) | Ended::Steps | Ended::Settings => Err(NotAssembled { side: 0, gap_m: f64::NAN }),
        }
    }
}

impl Ode for Across<'_> {
    type Error = NotAssembled;

    fn rate(&mut self, time_s: f64, y: &[f64], out: &mut [f64]) -> Result<(), NotAssembled> {
        let [s, v, a] = self.phase.at(self.motion, time_s);
        let pose = self.mechanism.pose([s, y[0]])?;
        let drive = Drive { at: [s, y[0]], velocity: [v, y[1]], acceleration: [a, 0.0] };
        (out[0], out[1]) = (y[1], self.mechanism.free_acceleration(&pose, &drive, self.phase.sense));
        if out[1].is_finite() { Ok(()) } else { Err(NotAssembled { side: 0, gap_m: f64::NAN }) }
    }
}

impl Mechanism {
    /// Acceleration sideways with which nothing has to guide the slider, m/s²: the guide's force is a straight line of it.
    pub fn free_acceleration(&self, pose: &Pose, drive: &Drive, sense: Sense) -> f64 {
        let guide = |b: f64| self.forces(pose, &Drive { acceleration: [drive.acceleration[0], b], ..*drive }, sense).guide_n;
        let [still, one] = [guide(0.0), guide(1.0)];
        -still / (one - still)
    }
}

/// Integral over the moments of a motion, J from W: Simpson's rule where three are evenly spaced, else the trapezium's.
pub(crate) fn integral(moments: &[Moment], value: impl Fn(&Moment) -> f64) -> f64 {
    let mut sum = 0.0;
    let mut i = 0;
    while i + 1 < moments.len() {
        let step = moments[i + 1].time_s - moments[i].time_s;
        let next = moments.get(i + 2).map_or(0.0, |m| m.time_s - moments[i + 1].time_s);
        if (next - step).abs() < 1e-6 * step {
            sum += step / 3.0 * (value(&moments[i]) + 4.0 * value(&moments[i + 1]) + value(&moments[i + 2]));
            i += 2;
        } else {
            sum += 0.5 * step * (value(&moments[i]) + value(&moments[i + 1]));
            i += 1;
        }
    }
    sum
}
