//! The slider let go: it moves as a pull, a hanging weight, the springs and its own mass make it move (`docs/theory/cam.md`, eqs. 10–12).
//!
//! On its guide one coordinate, the travel s. The force that a motion needs is a straight line of its acceleration, F = F₀(s, ṡ) + M(s) s̈,
//! so that the acceleration follows from what pulls. A slider without a guide has a second one, its way sideways: its acceleration there is
//! the one with which nothing guides the slider, and what is left is a straight line of s̈ again. Rolling resistance acts against the speed; at rest it holds the slider as long as the pull lies
//! between the forces up and down. The weight hangs on a cable that cannot push: where its tension would fall below zero, the weight
//! falls freely until the cable is taut again, and then both go on with one speed (momentum is kept, energy is lost).

use forcewright_multibody::{Ended, Ode, OdeSettings, integrate};

use crate::mechanism::{Drive, Mechanism, NotAssembled, Pose, Sense};
use crate::motion::{Moment, STEPS, moment};

/// What lets the slider go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Release {
    /// Constant pull along the travel, N; below zero against it.
    pub pull_n: f64,
    /// Mass that pulls along the travel by hanging on a cable over a pulley, kg.
    pub weight_kg: f64,
    /// Gravity of that mass, m/s².
    pub weight_m_per_s2: f64,
    /// Viscous damping of the slider, whichever way it moves, N·s/m.
    pub damping_n_s_per_m: f64,
    /// Where a slider that is free to move sideways is let go, m; `None` for one on its guide.
    pub sideways_m: Option<f64>,
    /// Travel from which it is let go at rest, m.
    pub start_m: f64,
    /// How long it is watched, s.
    pub duration_s: f64,
    /// Travels at which it runs against a stop, m.
    pub stops_m: [f64; 2],
}

/// How a motion ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// The time was over.
    Time,
    /// At a stop: the one at the start of the travel, or at its end.
    Stop {
        /// Whether at the end of the travel.
        far: bool,
    },
    /// At rest, held by friction.
    Rest,
    /// Where the mechanism cannot be assembled.
    NotAssembled(NotAssembled),
    /// The equations could not be integrated further.
    Unsettled,
}

/// A motion after the release.
#[derive(Clone, Debug)]
pub struct Released {
    /// At even times, and at the end.
    pub moments: Vec<Moment>,
    /// How it ended.
    pub end: End,
    /// When, s.
    pub time_s: f64,
    /// Lost to rolling resistance, J.
    pub friction_j: f64,
    /// Lost to damping, J.
    pub damping_j: f64,
    /// Lost where the cable became taut, J.
    pub catches_j: f64,
    /// How long the cable was slack, s.
    pub slack_s: f64,
    /// Way of the weight at the end, m, and its speed, m/s: those of the slider while the cable is taut.
    pub weight: [f64; 2],
    /// Way of a free slider sideways at the end, m, and its speed, m/s.
    pub sideways: [f64; 2],
}

/// Local error of a step relative to the stroke, and to the fastest speed and the energy that the pull could give.
const ACCURACY: f64 = 1e-12;
/// Changes of sense and of the cable before giving up.
const MOST_PHASES: usize = 2000;

/// State: travel, speed; work lost to rolling resistance and to damping; way and speed of the weight; way and speed sideways.
type State = [f64; 8];

/// Travel and way sideways, and their speeds.
#[derive(Clone, Copy, Debug)]
struct Moves {
    at: [f64; 2],
    velocity: [f64; 2],
}

impl Moves {
    fn of(y: &[f64]) -> Self {
        Self { at: [y[0], y[6]], velocity: [y[1], y[7]] }
    }

    fn drive(self, acceleration: [f64; 2]) -> Drive {
        Drive { at: self.at, velocity: self.velocity, acceleration }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Phase {
    /// `Frictionless` at rest, while the weight flies.
    sense: Sense,
    taut: bool,
}

/// Events of a phase.
const STANDS: usize = 0;
const NEAR_STOP: usize = 1;
const FAR_STOP: usize = 2;
const CABLE: usize = 3;

/// Lets the slider go.
pub fn release(mechanism: &Mechanism, release: &Release) -> Released {
    Run { mechanism, release, pose: None, phase: Phase { sense: Sense::Frictionless, taut: true }, catches_j: 0.0, slack_s: 0.0 }.go()
}

struct Run<'a> {
    mechanism: &'a Mechanism,
    release: &'a Release,
    /// Where the last position was found.
    pose: Option<Pose>,
    phase: Phase,
    catches_j: f64,
    slack_s: f64,
}

impl Run<'_> {
    fn go(mut self) -> Released {
        let r = *self.release;
        let times: Vec<f64> = (0..=STEPS).map(|i| r.duration_s * i as f64 / STEPS as f64).collect();
        let mut y: State = [r.start_m, 0.0, 0.0, 0.0, r.start_m, 0.0, r.sideways_m.unwrap_or(0.0), 0.0];
        let mut now = 0.0;
        let mut moments = Vec::new();
        let mut end = End::Unsettled;
        for count in 0..MOST_PHASES {
            match self.next_phase(&y) {
                Ok(phase) => self.phase = phase,
                Err(ended) => {
                    end = ended;
                    break;
                }
            }
            let sizes = self.sizes();
            let settings =
                OdeSettings { start_s: now, end_s: r.duration_s, accuracy: ACCURACY, sizes: &sizes, outputs_s: &times, max_steps: 100_000 };
            let run = integrate(&mut self, &y, &settings);
            let first = usize::from(count > 0 && run.kept.first().is_some_and(|k| k.0.to_bits() == now.to_bits()));
            moments.extend(run.kept[first.min(run.kept.len())..].iter().filter_map(|(time, state)| self.moment(*time, state)));
            if !self.phase.taut {
                self.slack_s += run.time_s - now;
            }
            now = run.time_s;
            y.copy_from_slice(&run.state);
            if let Some(ended) = self.after(&run.ended, &mut y) {
                end = ended;
                break;
            }
        }
        let late = moments.last().is_none_or(|m: &Moment| m.time_s < now);
        moments.extend(self.moment(now, &y).filter(|_| late));
        let [_, _, friction_j, damping_j, way, speed, across, across_speed] = y;
        let weight = if self.phase.taut { [y[0], y[1]] } else { [way, speed] };
        Released {
            moments,
            end,
            time_s: now,
            friction_j,
            damping_j,
            catches_j: self.catches_j,
            slack_s: self.slack_s,
            weight,
            sideways: [across, across_speed],
        }
    }

    /// Sizes of the unknowns that matter.
    fn sizes(&self) -> State {
        let r = self.release;
        let length = r.stops_m[1].max(1e-6);
        let speed = length / r.duration_s;
        let level = self.mechanism.paths[0].cut().purpose().law.levels_n().fold(0.0, f64::max);
        let energy = length * level;
        [length, speed, energy, energy, length, speed, length, speed]
    }

    /// What an end of the integration leads to; `None` to go on.
    fn after(&mut self, ended: &Ended<NotAssembled>, y: &mut State) -> Option<End> {
        match *ended {
            Ended::Time => Some(End::Time),
            Ended::Event(STANDS) => {
                y[1] = 0.0;
                None
            }
            Ended::Event(NEAR_STOP) => Some(End::Stop { far: false }),
            Ended::Event(FAR_STOP) => Some(End::Stop { far: true }),
            Ended::Event(_) if self.phase.taut => {
                (y[4], y[5]) = (y[0], y[1]);
                self.phase.taut = false;
                None
            }
            Ended::Event(_) => self.catch(y).err(),
            Ended::Failed(why) => Some(End::NotAssembled(why)),
            Ended::Steps | Ended::Settings => Some(End::Unsettled),
        }
    }

    /// The cable becomes taut: one speed afterwards, the momentum of slider and weight kept.
    fn catch(&mut self, y: &mut State) -> Result<(), End> {
        let moves = Moves::of(y);
        let pose = self.place(moves.at).map_err(End::NotAssembled)?;
        let sense = if y[1] < 0.0 { Sense::Down } else { Sense::Up };
        let [_, mass] = self.line(&pose, moves, sense);
        let [_, inertia] = self.line(&pose, moves, Sense::Frictionless);
        let weight = self.release.weight_kg;
        let both = (mass * y[1] + weight * y[5]) / (mass + weight);
        self.catches_j += 0.5 * (inertia * (y[1] * y[1] - both * both) + weight * (y[5] * y[5] - both * both));
        // Nothing pushes the slider sideways in the jerk.
        let jerk = Moves { velocity: [0.0; 2], ..moves };
        let [still, one] = [0.0, both - y[1]].map(|a| self.sideways(&pose, jerk, a, Sense::Frictionless));
        (y[1], y[4], y[5], y[7]) = (both, y[0], both, y[7] + one - still);
        self.phase.taut = true;
        Ok(())
    }

    /// Which way it goes on, or why it does not.
    fn next_phase(&mut self, y: &State) -> Result<Phase, End> {
        let weight = self.release.weight_kg;
        let moves = Moves::of(y);
        let pose = self.place(moves.at).map_err(End::NotAssembled)?;
        let [near, far] = self.release.stops_m;
        let mut phase = self.phase;
        if weight == 0.0 {
            phase.taut = true;
        }
        for _ in 0..2 {
            let hanging = if phase.taut { weight * self.release.weight_m_per_s2 } else { 0.0 };
            let pull = self.release.pull_n + hanging;
            phase.sense = if y[1] > 0.0 {
                Sense::Up
            } else if y[1] < 0.0 {
                Sense::Down
            } else {
                let [up, down] = [Sense::Up, Sense::Down].map(|sense| self.line(&pose, moves, sense)[0]);
                if pull > up {
                    Sense::Up
                } else if pull < down {
                    Sense::Down
                } else if phase.taut {
                    return Err(End::Rest);
                } else {
                    Sense::Frictionless
                }
            };
            // A cable that would have to push is slack.
            if phase.taut && weight > 0.0 && self.tension(&pose, moves, phase.sense) < 0.0 {
                phase.taut = false;
                continue;
            }
            break;
        }
        match phase.sense {
            Sense::Down if y[0] <= near => Err(End::Stop { far: false }),
            Sense::Up if y[0] >= far => Err(End::Stop { far: true }),
            _ => Ok(phase),
        }
    }

    fn place(&mut self, at: [f64; 2]) -> Result<Pose, NotAssembled> {
        let pose = self.mechanism.pose_near(at, self.pose.as_ref())?;
        self.pose = Some(pose);
        Ok(pose)
    }

    /// Acceleration sideways at one along the travel, m/s²: that with which only damping holds a free slider; zero on a guide.
    fn sideways(&self, pose: &Pose, moves: Moves, acceleration: f64, sense: Sense) -> f64 {
        if self.release.sideways_m.is_none() {
            return 0.0;
        }
        let held = |b: f64| self.mechanism.forces(pose, &moves.drive([acceleration, b]), sense).guide_n;
        let [still, one] = [held(0.0), held(1.0)];
        -(still + self.release.damping_n_s_per_m * moves.velocity[1]) / (one - still)
    }

    /// F₀ and M of F = F₀ + M s̈.
    fn line(&self, pose: &Pose, moves: Moves, sense: Sense) -> [f64; 2] {
        let force = |a: f64| {
            let drive = moves.drive([a, self.sideways(pose, moves, a, sense)]);
            self.mechanism.forces(pose, &drive, sense).force_n
        };
        let [still, one] = [force(0.0), force(1.0)];
        [still, one - still]
    }

    /// Acceleration of the slider along its travel.
    fn acceleration(&self, pose: &Pose, moves: Moves, phase: Phase) -> f64 {
        let r = self.release;
        let [force, mass] = self.line(pose, moves, phase.sense);
        let weight = if phase.taut { r.weight_kg } else { 0.0 };
        (r.pull_n + weight * r.weight_m_per_s2 - r.damping_n_s_per_m * moves.velocity[0] - force) / (mass + weight)
    }

    /// The motion with its accelerations.
    fn drive(&self, pose: &Pose, moves: Moves) -> Drive {
        let a = self.acceleration(pose, moves, self.phase);
        moves.drive([a, self.sideways(pose, moves, a, self.phase.sense)])
    }

    /// Tension of a taut cable, N.
    fn tension(&self, pose: &Pose, moves: Moves, sense: Sense) -> f64 {
        let r = self.release;
        r.weight_kg * (r.weight_m_per_s2 - self.acceleration(pose, moves, Phase { sense, taut: true }))
    }

    fn moment(&mut self, time_s: f64, y: &[f64]) -> Option<Moment> {
        let moves = Moves::of(y);
        let pose = self.place(moves.at).ok()?;
        let r = *self.release;
        let sense = self.phase.sense;
        let hanging = (r.weight_kg > 0.0).then_some(0.0);
        if sense == Sense::Frictionless || (y[1] == 0.0 && !self.moves(&pose, moves)) {
            let still = Drive { at: moves.at, ..Drive::default() };
            let mut all = moment(self.mechanism, &pose, &still, Sense::Frictionless, time_s);
            all.cable_n = hanging.map(|none| if self.phase.taut { r.weight_kg * r.weight_m_per_s2 } else { none });
            // Held by friction, it bears what pulls it.
            all.moving.force_n = r.pull_n + all.cable_n.unwrap_or(0.0);
            return Some(all);
        }
        let drive = self.drive(&pose, moves);
        let mut all = moment(self.mechanism, &pose, &drive, sense, time_s);
        let fall = r.weight_m_per_s2 - drive.acceleration[0];
        all.cable_n = hanging.map(|none| if self.phase.taut { r.weight_kg * fall } else { none });
        Some(all)
    }

    /// Whether a slider at rest sets off in the sense of the phase.
    fn moves(&self, pose: &Pose, moves: Moves) -> bool {
        let a = self.acceleration(pose, moves, self.phase);
        match self.phase.sense {
            Sense::Up => a > 0.0,
            Sense::Down => a < 0.0,
            Sense::Frictionless => false,
        }
    }
}

impl Ode for Run<'_> {
    type Error = NotAssembled;

    fn rate(&mut self, _time_s: f64, y: &[f64], out: &mut [f64]) -> Result<(), NotAssembled> {
        let Phase { sense, taut } = self.phase;
        let falls = self.release.weight_m_per_s2;
        let damping = self.release.damping_n_s_per_m;
        let moves = Moves::of(y);
        let pose = self.place(moves.at)?;
        if sense == Sense::Frictionless {
            // Held along its travel; a free slider swings on.
            let b = self.sideways(&pose, moves, 0.0, sense);
            out.copy_from_slice(&[0.0, 0.0, 0.0, damping * y[7] * y[7], y[5], falls, y[7], b]);
            return Ok(());
        }
        let drive = self.drive(&pose, moves);
        let [a, b] = drive.acceleration;
        if !(a + b).is_finite() {
            return Err(NotAssembled { side: 0, gap_m: f64::NAN });
        }
        let [v, u] = drive.velocity;
        let [rough, smooth] = [sense, Sense::Frictionless].map(|sense| self.mechanism.forces(&pose, &drive, sense));
        let lost = (rough.force_n - smooth.force_n) * v + (rough.guide_n - smooth.guide_n) * u;
        let weight = if taut { [v, a] } else { [y[5], falls] };
        out.copy_from_slice(&[v, a, lost, damping * (v * v + u * u), weight[0], weight[1], u, b]);
        Ok(())
    }

    fn events(&self) -> usize {
        4
    }

    fn event(&mut self, index: usize, _time_s: f64, y: &[f64]) -> f64 {
        let [near, far] = self.release.stops_m;
        let sense = self.phase.sense;
        match index {
            STANDS if sense == Sense::Up => y[1],
            STANDS if sense == Sense::Down => -y[1],
            NEAR_STOP if sense == Sense::Down => y[0] - near,
            FAR_STOP if sense == Sense::Up => far - y[0],
            CABLE if self.release.weight_kg == 0.0 => f64::NAN,
            CABLE if self.phase.taut => {
                let moves = Moves::of(y);
                self.place(moves.at).map_or(f64::NAN, |pose| self.tension(&pose, moves, sense))
            }
            // A little slack is none: it becomes taut where it is passed.
            CABLE => y[0] - y[4] + 1e-12 * far,
            _ => f64::NAN,
        }
    }
}
