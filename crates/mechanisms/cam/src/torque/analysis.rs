//! From a design to what it does: torque over the turn in both directions, and the forces with it.

use std::sync::Arc;

use forcewright_base::maths;

use super::cut::{Cut, CutError};
use super::design::Design;
use super::mechanism::{Instant, Mechanism, NotAssembled, Pose, Stop};
use super::motion::{Moment, prescribed};
use super::outline;
use crate::analysis::{JUST_ABOVE, Measured, PANELS, STATIONS, contact_pressure, extent, moments};
use crate::mechanism::Sense;
use crate::path::{curvature_per_m, frame};

/// Forces at a turn.
#[derive(Clone, Copy, Debug)]
pub struct Station {
    /// Where everything is.
    pub pose: Pose,
    /// Without friction.
    pub still: Instant,
    /// Disc turned against the springs.
    pub up: Instant,
    /// Disc turned back.
    pub down: Instant,
}

impl Station {
    /// Turn θ, rad.
    pub fn turn_rad(&self) -> f64 {
        self.pose.turn_rad
    }

    fn all(&self) -> [&Instant; 3] {
        [&self.still, &self.up, &self.down]
    }

    /// The sense in which its torque is not a number: friction locks the rollers.
    fn locked(&self) -> Option<Sense> {
        let senses = [Sense::Frictionless, Sense::Up, Sense::Down];
        senses.into_iter().zip(self.all()).find(|(_, i)| !i.torque_nm.is_finite()).map(|(sense, _)| sense)
    }
}

/// What a design does.
#[derive(Clone, Debug)]
pub struct Behaviour {
    /// The mechanism.
    pub mechanism: Mechanism,
    /// Over the turn.
    pub stations: Vec<Station>,
    /// Where means are taken, rad.
    pub window_rad: [f64; 2],
    /// Over the window: two intervals per panel.
    pub window: Vec<Station>,
    /// Where no roller stands on the path any more, or friction locks it: turn, and why.
    pub stopped: Option<(f64, Stop)>,
    /// The motion.
    pub motion: Option<Vec<Moment>>,
    /// Times the path was evaluated.
    pub evaluations: u64,
}

impl Behaviour {
    /// Analyses a design.
    ///
    /// # Errors
    /// [`CutError`] where the disc cannot be cut.
    pub fn of(design: &Design) -> Result<Self, CutError> {
        let cut = Arc::new(Cut::new(design.purpose.clone())?);
        let mechanism = design.mechanism(&cut);
        let whole = design.purpose.turn_rad;
        let lost = mechanism.corner.map_or(0.0, |c| c.turn_rad);
        let window_rad = design.window_rad.unwrap_or([lost.min(0.5 * whole), whole]);
        let motion = design.motion.as_ref().and_then(|m| prescribed(&mechanism, m).ok());
        Ok(Self { motion, ..Self::sampled(mechanism, window_rad, STATIONS, 2 * PANELS) })
    }

    /// What a mechanism does at so many intervals of the turn, and of the window (an even number).
    pub fn sampled(mechanism: Mechanism, window_rad: [f64; 2], over_turn: usize, over_window: usize) -> Self {
        let whole = mechanism.cut.purpose().turn_rad;
        let mut evaluations = 0;
        let (stations, stopped) = scan(&mechanism, [0.0, whole], over_turn, &mut evaluations);
        // Where the roller comes to rest beyond the start of the window, the window begins there.
        let [from, to] = window_rad;
        let window_rad = [stations.first().map_or(from, |s| s.turn_rad().max(from)), to];
        let (window, cut_short) = scan(&mechanism, window_rad, over_window, &mut evaluations);
        Self { stations, window_rad, window, stopped: stopped.or(cut_short), motion: None, evaluations, mechanism }
    }
}

/// Forces at even turns. A scan from the very start begins where the roller comes to rest.
fn scan(mechanism: &Mechanism, [from, to]: [f64; 2], intervals: usize, evaluations: &mut u64) -> (Vec<Station>, Option<(f64, Stop)>) {
    let mut stations: Vec<Station> = Vec::with_capacity(intervals + 1);
    for i in 0..=intervals {
        let turn = from + (to - from) * i as f64 / intervals as f64;
        let found = match station(mechanism, turn) {
            // Springs without tension on a path that leaves straight outwards: 0/0, whose limit is the torque just above.
            Ok(s) if s.locked().is_some() => {
                let above = station(mechanism, turn + JUST_ABOVE * (to - from));
                above.map(|above| Station { pose: Pose { turn_rad: turn, ..above.pose }, ..above })
            }
            found => found,
        };
        let found = found.map_err(Stop::NotAssembled).and_then(|station| match station.locked() {
            Some(sense) => Err(Stop::Locks(sense)),
            None => Ok(station),
        });
        match found {
            Ok(station) => {
                *evaluations += u64::from(station.pose.evaluations);
                stations.push(station);
            }
            // The corner of an undercut may keep the roller beyond the start, or friction lock it there.
            Err(_) if from == 0.0 && stations.is_empty() && i < intervals / 10 => {}
            Err(why) => return (stations, Some((turn, why))),
        }
    }
    (stations, None)
}

/// Forces at a turn.
///
/// # Errors
/// [`NotAssembled`] where no roller stands on the path.
fn station(mechanism: &Mechanism, turn_rad: f64) -> Result<Station, NotAssembled> {
    let pose = mechanism.pose(turn_rad)?;
    let [still, up, down] = [Sense::Frictionless, Sense::Up, Sense::Down].map(|sense| mechanism.at_rest(&pose, sense));
    Ok(Station { pose, still, up, down })
}

/// Every metric that the behaviour has.
pub(crate) fn measure(design: &Design, behaviour: &Behaviour) -> Measured {
    let mut m = Measured::none();
    path(behaviour, &mut m);
    outline(design, behaviour, &mut m);
    mass(behaviour, &mut m);
    // The rest is about the whole turn: a mechanism that does not reach its end has no such numbers.
    if behaviour.stopped.is_some() {
        return m;
    }
    torques(design, behaviour, &mut m);
    whole(design, behaviour, &mut m);
    m
}

/// What the whole turn and the motion say.
fn whole(design: &Design, behaviour: &Behaviour, m: &mut Measured) {
    forces(behaviour, m);
    moving(behaviour, m);
    let sense = behaviour.mechanism.cut.sense();
    let loads = behaviour.window.iter().map(|s| [s.up.normal_n.max(s.down.normal_n).max(0.0), curvature_per_m(&s.pose.place, sense)]);
    contact_pressure(&design.materials, design.built.thickness_m, behaviour.mechanism.roller_m, loads, m);
    // Without friction the work is what the springs store.
    if let (Some(first), Some(last)) = (behaviour.stations.first(), behaviour.stations.last()) {
        m.set("energy", behaviour.mechanism.springs.energy_j(first.still.spring_m, last.still.spring_m));
    }
}

/// Those that studies of many designs take as they are: all but what follows from the torques over the window, and from the outline.
pub(crate) fn measure_scalars(design: &Design, behaviour: &Behaviour) -> Measured {
    let mut m = Measured::none();
    path(behaviour, &mut m);
    mass(behaviour, &mut m);
    whole(design, behaviour, &mut m);
    m
}

fn mass(behaviour: &Behaviour, m: &mut Measured) {
    let b = &behaviour.mechanism.bodies;
    m.set("moving_mass", 2.0 * (b.follower_kg + b.roller_kg) + behaviour.mechanism.springs.mass_kg());
}

fn path(behaviour: &Behaviour, m: &mut Measured) {
    let mechanism = &behaviour.mechanism;
    let (cut, sense) = (&mechanism.cut, mechanism.cut.sense());
    let [from, to] = cut.range_m();
    // From the start of the path, where it is curved most, also where the cam is undercut there.
    let all = (0..=STATIONS).map(|i| from + (to - from) * (i as f64 / STATIONS as f64) * (i as f64 / STATIONS as f64));
    let most = all.map(|l| curvature_per_m(&cut.place(l), sense)).fold(0.0, f64::max);
    // A path that is nowhere convex has no such radius.
    m.set("path_curvature_radius_min", (most > 0.0).then(|| most.recip()));
    m.set("undercut_turn", mechanism.corner.map_or(0.0, |c| c.turn_rad));
}

/// Size of the disc, and what is left of it about the shaft.
pub(crate) fn outline(design: &Design, behaviour: &Behaviour, m: &mut Measured) {
    let mechanism = &behaviour.mechanism;
    let [_, to] = mechanism.cut.range_m();
    let start = outline::start_m(mechanism);
    if let Some(closing) = outline::closing(mechanism, start, to) {
        let [least, most] = outline::reach_m(mechanism, [start, to], &closing);
        if design.built.extension {
            m.set("disc_diameter", 2.0 * most);
            m.set("hub_wall", design.shaft_m.map(|d| least - 0.5 * d));
        } else {
            m.set("disc_diameter", 2.0 * (most + design.making.wall_m));
        }
    }
}

fn torques(design: &Design, behaviour: &Behaviour, m: &mut Measured) {
    let window = &behaviour.window;
    let [mean, _] = moments(window, |s| s.still.torque_nm);
    let [up, up_sd] = moments(window, |s| s.up.torque_nm);
    let [down, down_sd] = moments(window, |s| s.down.torque_nm);
    let [up_min, up_max] = extent(window, |s| s.up.torque_nm);
    let [down_min, down_max] = extent(window, |s| s.down.torque_nm);
    for (name, value) in [
        ("torque_mean", mean),
        ("torque_up_mean", up),
        ("torque_up_sd", up_sd),
        ("torque_up_max", up_max),
        ("torque_up_min", up_min),
        ("torque_down_mean", down),
        ("torque_down_sd", down_sd),
        ("torque_down_max", down_max),
        ("torque_down_min", down_min),
    ] {
        m.set(name, value);
    }
    let (high, low) = (up_max.max(down_max), up_min.min(down_min));
    m.set("torque_spread", (high - low) / (high + low));
    let [from, to] = behaviour.window_rad;
    m.set("loop_area", (up - down) * (to - from));
    m.set("hysteresis", (up - down) / mean);
    if let Some((law, _)) = design.requirements.as_ref().and_then(|r| r.force.as_ref()) {
        let off = |s: &Station| {
            let [wanted, _] = law.force_n(s.turn_rad());
            (s.up.torque_nm / wanted - 1.0).abs().max((s.down.torque_nm / wanted - 1.0).abs())
        };
        m.set("torque_deviation", extent(window, off)[1]);
    }
}

fn forces(behaviour: &Behaviour, m: &mut Measured) {
    let stations = &behaviour.stations;
    let all = |pick: &dyn Fn(&Instant) -> f64| {
        let instants: Vec<&Instant> = stations.iter().flat_map(Station::all).collect();
        extent(&instants, |i| pick(i))
    };
    let [normal_min, normal_max] = all(&|i| i.normal_n);
    m.set("contact_force_min", normal_min);
    m.set("contact_force_max", normal_max);
    let needed = |i: &Instant| (i.tangential_n / i.normal_n).abs();
    let in_motion = behaviour.motion.iter().flatten().map(|moment| needed(&moment.moving)).fold(0.0, f64::max);
    m.set("friction_needed_max", all(&needed)[1].max(in_motion));
    m.set("guide_force_max", all(&|i| i.guide_n.abs())[1]);
    let [length_min, length_max] = all(&|i| i.spring_m);
    m.set("spring_length_min", length_min);
    m.set("spring_length_max", length_max);
    m.set("spring_force_max", all(&|i| i.spring_n.abs())[1]);
    m.set("pressure_angle_max", extent(&behaviour.window, |s| pressure_angle(&behaviour.mechanism, s))[1]);
    m.set("width", length_max + 2.0 * behaviour.mechanism.roller_m);
}

fn moving(behaviour: &Behaviour, m: &mut Measured) {
    let Some(motion) = &behaviour.motion else { return };
    let [least, most] = extent(motion, |i| i.moving.torque_nm);
    m.set("torque_max_motion", most);
    m.set("torque_min_motion", least);
    m.set("peak_torque_ratio", extent(motion, |i| i.moving.torque_nm / i.resting.torque_nm - 1.0)[1]);
    m.set("contact_force_min_motion", extent(motion, |i| i.moving.normal_n)[0]);
    m.set("turn_speed_max", extent(motion, |i| i.speed_rad_per_s.abs())[1]);
}

/// Angle between the guide of a roller and the normal of the cam, rad.
pub(crate) fn pressure_angle(mechanism: &Mechanism, station: &Station) -> f64 {
    let place = &station.pose.place;
    let [_, [nx, ny]] = frame(place, mechanism.cut.sense());
    let [x, y] = place.at;
    maths::atan2((x * ny - y * nx).abs(), (x * nx + y * ny).abs())
}
