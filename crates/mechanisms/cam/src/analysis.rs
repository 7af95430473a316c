//! From a design to what it does: forces over the stroke in both directions, and in a motion.

use std::sync::Arc;

use forcewright_base::maths;
use forcewright_base::quadrature::simpson_weight;
use forcewright_contract::metrics::Values;
use forcewright_elements::hertz::{LIFE_CYCLES, Life, Solid, line_contact, surface_life};

use crate::cut::{Cut, CutError, SIDES};
use crate::design::Design;
use crate::mechanism::{Drive, Instant, Mechanism, NotAssembled, Pose, Sense, Stop};
use crate::metrics::CamMetrics;
use crate::motion::{self, Moment, integral};
use crate::path::{Corner, SidePath, curvature_per_m, frame};
use crate::release::{End, Release, Released, release};

/// Stations over the stroke, for curves and pictures.
pub(crate) const STATIONS: usize = 480;
/// Panels of the window, for means; extremes are taken at their ends and middles.
pub(crate) const PANELS: usize = 400;
/// How far above the start of its travel a slider is taken where the start itself is singular, relative to the stroke.
pub(crate) const JUST_ABOVE: f64 = 1e-6;

/// From this part of the stroke on, a start that cannot be left is worth a word.
pub(crate) const LOCKED_FROM: f64 = 1e-4;

/// Forces at a travel.
#[derive(Clone, Copy, Debug)]
pub struct Station {
    /// Travel s, m.
    pub travel_m: f64,
    /// Where everything is without friction.
    pub pose: Pose,
    /// Without friction.
    pub still: Instant,
    /// Slider moving along its travel.
    pub up: Instant,
    /// Slider moving back.
    pub down: Instant,
    /// Way of a free slider to the right: without friction, up, down, m.
    pub sideways_m: [f64; 3],
}

impl Station {
    /// The sense in which its force is not a number: friction locks the rollers.
    fn locked(&self) -> Option<Sense> {
        let all = [(Sense::Frictionless, &self.still), (Sense::Up, &self.up), (Sense::Down, &self.down)];
        all.into_iter().find(|(_, i)| !(i.force_n + i.guide_n).is_finite()).map(|(sense, _)| sense)
    }
}

/// What a design does.
#[derive(Clone, Debug)]
pub struct Behaviour {
    /// The paths as cut.
    pub cut: Arc<Cut>,
    /// The mechanism.
    pub mechanism: Mechanism,
    /// Where the cam is undercut, right and left.
    pub corners: [Option<Corner>; SIDES],
    /// Over the stroke.
    pub stations: Vec<Station>,
    /// Where means are taken, m.
    pub window_m: [f64; 2],
    /// Over the window: two intervals per panel.
    pub window: Vec<Station>,
    /// Where the mechanism could not be assembled any more, or friction locks it: travel, and why.
    pub stopped: Option<(f64, Stop)>,
    /// The motion.
    pub motion: Option<Vec<Moment>>,
    /// The slower motion that it is compared with.
    pub reference: Option<Vec<Moment>>,
    /// How a release ended; its moments are those of the motion.
    pub release: Option<Released>,
    /// Times a path was evaluated.
    pub evaluations: u64,
}

impl Behaviour {
    /// Analyses a design.
    ///
    /// # Errors
    /// [`CutError`] where the cam cannot be cut.
    pub fn of(design: &Design) -> Result<Self, CutError> {
        let paths = design.paths(&design.cut()?);
        let lost_m = paths.iter().filter_map(|path| path.corner()).map(|c| c.travel_m).fold(0.0, f64::max);
        let stroke_m = design.purpose.stroke_m;
        let window_m = design.window_m.unwrap_or([lost_m.min(0.5 * stroke_m), stroke_m]);
        Ok(Self::sampled(design, &paths, window_m, STATIONS, 2 * PANELS))
    }

    /// What a design does on a cam whose paths are known ([`Design::paths`]), at so many intervals of the stroke, and of the window (an
    /// even number).
    pub fn sampled(design: &Design, paths: &[SidePath; SIDES], window_m: [f64; 2], over_stroke: usize, over_window: usize) -> Self {
        let mechanism = design.mechanism_on(paths);
        let cut = Arc::clone(paths[0].shared_cut());
        let corners = [0, 1].map(|side| mechanism.paths[side].corner().copied());
        let stroke_m = design.purpose.stroke_m;
        let mut evaluations = 0;
        let free = design.free_guide;
        let (stations, stopped) = scan(&mechanism, [0.0, stroke_m], over_stroke, free, &mut evaluations);
        // Where the slider comes to rest above the start of the window, the window begins there.
        let [from, to] = window_m;
        let window_m = [stations.first().map_or(from, |s| s.travel_m.max(from)), to];
        let (window, cut_short) = scan(&mechanism, window_m, over_window, free, &mut evaluations);
        let run = |m: &motion::Motion| {
            // A free slider begins where it rests.
            let start = if free { free_station(&mechanism, m.start_m, None).ok()?.sideways_m[0] } else { 0.0 };
            motion::prescribed(&mechanism, m, free.then_some(start)).ok()
        };
        let motion = design.motion.as_ref().and_then(run);
        let reference = design.motion.as_ref().and_then(|m| run(&m.lasting(m.reference_s?)));
        let released = design.release.as_ref().map(|r| let_go(&mechanism, r, &stations, stroke_m, free));
        let motion = motion.or_else(|| released.as_ref().map(|r| r.moments.clone()).filter(|moments| !moments.is_empty()));
        let stopped = stopped.or(cut_short);
        Self { cut, corners, stations, window_m, window, stopped, motion, reference, release: released, evaluations, mechanism }
    }

    /// Mean and standard deviation over the window, by Simpson's rule.
    pub fn moments(&self, value: impl Fn(&Station) -> f64) -> [f64; 2] {
        moments(&self.window, value)
    }

    /// Smallest and largest value over some stations.
    pub fn extent(stations: &[Station], value: impl Fn(&Station) -> f64) -> [f64; 2] {
        extent(stations, value)
    }
}

/// Mean and standard deviation over stations at even distances, an odd number of them, by Simpson's rule.
pub(crate) fn moments<S>(stations: &[S], value: impl Fn(&S) -> f64) -> [f64; 2] {
    let mean_of =
        |f: &dyn Fn(&S) -> f64| -> f64 { stations.iter().enumerate().map(|(i, s)| simpson_weight(i, stations.len()) * f(s)).sum() };
    let mean = mean_of(&value);
    let spread = mean_of(&|s| (value(s) - mean) * (value(s) - mean));
    [mean, spread.max(0.0).sqrt()]
}

/// Smallest and largest value over some stations.
pub(crate) fn extent<S>(stations: &[S], value: impl Fn(&S) -> f64) -> [f64; 2] {
    stations.iter().map(value).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

/// Lets the slider go. Its stops are the ends of the stroke; the one at the start lies where the rollers come to it, and a little above: on
/// a cam without undercut the mass seen by the slider grows without limit towards s = 0.
fn let_go(mechanism: &Mechanism, asked: &Release, stations: &[Station], stroke_m: f64, free: bool) -> Released {
    let near = stations.first().map_or(0.0, |s| s.travel_m).max(JUST_ABOVE * stroke_m);
    let start_m = asked.start_m.max(near);
    // A free slider is let go where nothing pushes it sideways.
    let sideways_m = free.then(|| free_station(mechanism, start_m, None).map_or(0.0, |station| station.sideways_m[0]));
    release(mechanism, &Release { start_m, stops_m: [near, stroke_m], sideways_m, ..*asked })
}

/// Forces at even travels; stops where a brace no longer reaches its path or friction locks the rollers. A scan from the very start begins where the slider comes to rest.
fn scan(
    mechanism: &Mechanism,
    [from, to]: [f64; 2],
    intervals: usize,
    free: bool,
    evaluations: &mut u64,
) -> (Vec<Station>, Option<(f64, Stop)>) {
    let mut stations: Vec<Station> = Vec::with_capacity(intervals + 1);
    for i in 0..=intervals {
        let s = from + (to - from) * i as f64 / intervals as f64;
        let near = stations.last();
        let at = |s: f64| if free { free_station(mechanism, s, near) } else { station(mechanism, s, near) };
        let found = match at(s) {
            // Springs without tension on a path along which a brace carries nothing: 0/0, whose limit is the force just above.
            Ok(station) if station.locked().is_some() => at(s + JUST_ABOVE * (to - from)).map(|above| Station { travel_m: s, ..above }),
            found => found,
        };
        let found = found.map_err(Stop::from).and_then(|station| match station.locked() {
            Some(sense) => Err(Stop::Locks(sense)),
            None => Ok(station),
        });
        match found {
            Ok(station) => {
                *evaluations += u64::from(station.pose.evaluations);
                stations.push(station);
            }
            // Springs, errors or the corner of an undercut may keep the slider above the start of its travel, or friction lock it there.
            Err(_) if from == 0.0 && stations.is_empty() && i < intervals / 10 => {}
            Err(why) => return (stations, Some((s, why))),
        }
    }
    (stations, None)
}

fn station(mechanism: &Mechanism, travel_m: f64, near: Option<&Station>) -> Result<Station, NotAssembled> {
    let pose = mechanism.pose_near([travel_m, 0.0], near.map(|n| &n.pose))?;
    let drive = Drive::rest(travel_m);
    let [still, up, down] = mechanism.forces_in(&pose, &drive, [Sense::Frictionless, Sense::Up, Sense::Down]);
    Ok(Station { travel_m, pose, still, up, down, sideways_m: [0.0; 3] })
}

/// A slider that is free to move sideways goes where nothing has to guide it.
fn free_station(mechanism: &Mechanism, travel_m: f64, near: Option<&Station>) -> Result<Station, NotAssembled> {
    let mut evaluations = 0;
    let mut settle = |sense: Sense, start: f64| -> Result<(f64, Pose, Instant), NotAssembled> {
        let mut at = |x: f64| {
            let pose = mechanism.pose_near([travel_m, x], near.map(|n| &n.pose))?;
            evaluations += pose.evaluations;
            let drive = Drive { at: [travel_m, x], ..Drive::default() };
            Ok((pose, mechanism.forces(&pose, &drive, sense)))
        };
        let (mut x, mut step) = (start, 1e-6);
        let (mut pose, mut here) = at(x)?;
        for _ in 0..40 {
            let (_, beside) = at(x + step)?;
            let slope = (beside.guide_n - here.guide_n) / step;
            let change = (here.guide_n / slope).clamp(-0.005, 0.005);
            if !change.is_finite() {
                break;
            }
            x -= change;
            (pose, here) = at(x)?;
            if change.abs() < 1e-13 {
                break;
            }
            step = (0.1 * change).abs().clamp(1e-9, 1e-6);
        }
        Ok((x, pose, here))
    };
    let start = near.map_or([0.0; 3], |n| n.sideways_m);
    let (x0, pose, still) = settle(Sense::Frictionless, start[0])?;
    let (x1, _, up) = settle(Sense::Up, start[1])?;
    let (x2, _, down) = settle(Sense::Down, start[2])?;
    Ok(Station { travel_m, pose: Pose { evaluations, ..pose }, still, up, down, sideways_m: [x0, x1, x2] })
}

/// Values of this family's metrics.
pub type Measured = Values<CamMetrics>;

/// Every metric that the behaviour has.
pub fn measure(design: &Design, behaviour: &Behaviour) -> Measured {
    let mut m = Measured::none();
    geometry(design, behaviour, &mut m);
    mass(design, &mut m);
    // The rest is about the whole stroke: a mechanism that does not reach its end has no such numbers.
    if behaviour.stopped.is_some() {
        return m;
    }
    forces(design, behaviour, &mut m);
    whole(design, behaviour, &mut m);
    m
}

/// What the whole stroke and the motion say.
fn whole(design: &Design, behaviour: &Behaviour, m: &mut Measured) {
    extents(behaviour, m);
    energy(behaviour, m);
    contact(behaviour, m);
    pressure(design, behaviour, m);
    profile(behaviour, m);
    moving(behaviour, m);
    work(behaviour, m);
}

/// Pressure between rollers and cam over the window.
fn pressure(design: &Design, behaviour: &Behaviour, m: &mut Measured) {
    let sense = behaviour.mechanism.springs.sense();
    let loads = behaviour.window.iter().flat_map(|station| {
        [0, 1].map(|side: usize| {
            let normal = [station.up, station.down].iter().map(|i| i.sides[side].normal_n).fold(0.0, f64::max);
            [normal, curvature_per_m(&station.pose.places[side], sense)]
        })
    });
    contact_pressure(&design.materials, design.built.thickness_m, behaviour.mechanism.roller_m, loads, m);
}

/// Largest pressure between rollers of a radius and a cam of a width, and how long the surfaces endure it, from normal forces and the
/// curvature of the path at each.
pub(crate) fn contact_pressure(
    materials: &[Option<crate::design::Material>; 2],
    width_m: Option<f64>,
    r: f64,
    loads: impl Iterator<Item = [f64; 2]>,
    m: &mut Measured,
) {
    let solid = |material: &Option<crate::design::Material>| {
        let material = material.as_ref()?;
        Some(Solid { young_modulus_pa: material.young_pa?, poisson_ratio: material.poisson? })
    };
    let [cam, roller] = materials;
    let (Some(solids), Some(width_m)) = (solid(cam).zip(solid(roller)), width_m) else { return };
    let mut most = 0.0_f64;
    for [normal, curvature] in loads {
        // The cam's own radius is that of the path less the roller's; a straight path has a straight cam, a hollow one a hollow cam.
        let own_m = if curvature.abs() < 1e-9 { f64::INFINITY } else { 1.0 / curvature - r };
        match line_contact(normal / width_m, [own_m, r], [solids.0, solids.1]) {
            Ok(contact) => most = most.max(contact.pressure_pa),
            // A corner, or no line of contact: nothing is said.
            Err(_) => return,
        }
    }
    m.set("hertz_pressure_max", most);
    let life = |material: &Option<crate::design::Material>| surface_life(most, material.as_ref()?.brinell?);
    let cycles = |life: Life| match life {
        Life::Shorter => LIFE_CYCLES[0],
        Life::Cycles(cycles) => cycles,
        Life::Longer => LIFE_CYCLES[1],
    };
    if let (Some(a), Some(b)) = (life(cam), life(roller)) {
        m.set("contact_life", cycles(a).min(cycles(b)));
    }
}

/// How far the profile is from the one that was meant.
fn profile(behaviour: &Behaviour, m: &mut Measured) {
    let errors: Vec<f64> = behaviour
        .window
        .iter()
        .flat_map(|s| (0..SIDES).filter_map(|side| behaviour.mechanism.paths[side].error_m(s.pose.lambda_m[side])))
        .collect();
    if !errors.is_empty() {
        m.set("profile_error_rms", (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt());
        m.set("profile_error_max", errors.iter().fold(0.0, |m: f64, e| m.max(e.abs())));
    }
}

/// Width and height over the stroke.
fn extents(behaviour: &Behaviour, m: &mut Measured) {
    let r = behaviour.mechanism.roller_m;
    let out = Behaviour::extent(&behaviour.stations, |s| s.pose.places[0].at[0] + s.pose.places[1].at[0])[1];
    m.set("width", out + 2.0 * r);
    let low = Behaviour::extent(&behaviour.stations, |s| s.pose.places[0].at[1].min(s.pose.places[1].at[1]))[0];
    let high = Behaviour::extent(&behaviour.stations, |s| s.pose.joints[0][1].max(s.pose.places[0].at[1]))[1];
    m.set("height", high - low + 2.0 * r);
}

/// Those that studies of many designs take as they are: all but what follows from the forces over the window.
pub(crate) fn measure_scalars(design: &Design, behaviour: &Behaviour) -> Measured {
    let mut m = Measured::none();
    geometry(design, behaviour, &mut m);
    mass(design, &mut m);
    whole(design, behaviour, &mut m);
    m
}

fn mass(design: &Design, m: &mut Measured) {
    let bodies = &design.built.bodies;
    let springs: f64 = design.built.springs.iter().map(|s| s.mass_kg).sum();
    m.set("moving_mass", bodies.slider_kg + 2.0 * (bodies.brace_kg + bodies.roller_kg) + springs);
}

fn geometry(design: &Design, behaviour: &Behaviour, m: &mut Measured) {
    let cut = &behaviour.cut;
    let sense = cut.purpose().springs.sense();
    let [from, to] = cut.range_m();
    let radius = |side: usize| {
        let path = &behaviour.mechanism.paths[side];
        // From the start of the path, where it is curved most, also where the cam is undercut there.
        let all = (0..=STATIONS).map(|i| from + (to - from) * (i as f64 / STATIONS as f64) * (i as f64 / STATIONS as f64));
        all.map(|l| curvature_per_m(&path.designed(l), sense)).fold(0.0, f64::max).recip()
    };
    m.set("path_curvature_radius_min", radius(0).min(radius(1)));
    let lost = behaviour.corners.iter().flatten().map(|c| c.travel_m).fold(0.0, f64::max);
    m.set("undercut_travel", lost);
    let height = |side: usize| {
        let place = |l: f64| {
            let p = behaviour.mechanism.paths[side].designed(l);
            let [_, normal] = frame(&p, sense);
            p.at[1] - design.cut_roller_m * normal[1]
        };
        place(to) - place(behaviour.corners[side].map_or(from, |c| c.lambda_m))
    };
    m.set("cam_length", height(0).max(height(1)));
}

fn forces(design: &Design, behaviour: &Behaviour, m: &mut Measured) {
    let window = &behaviour.window;
    let [mean, _] = behaviour.moments(|s| s.still.force_n);
    let [up, up_sd] = behaviour.moments(|s| s.up.force_n);
    let [down, down_sd] = behaviour.moments(|s| s.down.force_n);
    let [up_min, up_max] = Behaviour::extent(window, |s| s.up.force_n);
    let [down_min, down_max] = Behaviour::extent(window, |s| s.down.force_n);
    for (name, value) in [
        ("force_mean", mean),
        ("force_up_mean", up),
        ("force_up_sd", up_sd),
        ("force_up_max", up_max),
        ("force_up_min", up_min),
        ("force_down_mean", down),
        ("force_down_sd", down_sd),
        ("force_down_max", down_max),
        ("force_down_min", down_min),
    ] {
        m.set(name, value);
    }
    let (high, low) = (up_max.max(down_max), up_min.min(down_min));
    m.set("force_spread", (high - low) / (high + low));
    let [from, to] = behaviour.window_m;
    m.set("loop_area", (up - down) * (to - from));
    m.set("hysteresis", (up - down) / mean);
    if let Some((law, _)) = design.requirements.as_ref().and_then(|r| r.force.as_ref()) {
        let off = |s: &Station| {
            let [wanted, _] = law.force_n(s.travel_m);
            (s.up.force_n / wanted - 1.0).abs().max((s.down.force_n / wanted - 1.0).abs())
        };
        m.set("force_deviation", Behaviour::extent(window, off)[1]);
    }
}

/// Work over the stroke, and what of the force is weight.
fn energy(behaviour: &Behaviour, m: &mut Measured) {
    let s = &behaviour.stations;
    let work: f64 = s.windows(2).map(|p| 0.5 * (p[1].travel_m - p[0].travel_m) * (p[0].still.force_n + p[1].still.force_n)).sum();
    m.set("energy", work);
    if behaviour.mechanism.gravity_m_per_s2 == 0.0 {
        m.set("weight", 0.0);
        return;
    }
    let weightless = Mechanism { gravity_m_per_s2: 0.0, ..behaviour.mechanism.clone() };
    let [weight, _] = behaviour.moments(|s| {
        let drive = Drive { at: [s.travel_m, s.sideways_m[0]], ..Drive::default() };
        s.still.force_n - weightless.forces(&s.pose, &drive, Sense::Frictionless).force_n
    });
    m.set("weight", weight);
}

fn contact(behaviour: &Behaviour, m: &mut Measured) {
    let stations = &behaviour.stations;
    let all = |pick: &dyn Fn(&Instant) -> [f64; 2]| {
        let of = |s: &Station| {
            [s.up, s.down, s.still].iter().map(pick).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [c, d]| [a.min(c), b.max(d)])
        };
        stations.iter().map(of).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [c, d]| [a.min(c), b.max(d)])
    };
    let both = |pick: fn(&crate::mechanism::SideForces) -> f64| {
        move |i: &Instant| {
            let [a, b] = [pick(&i.sides[0]), pick(&i.sides[1])];
            [a.min(b), a.max(b)]
        }
    };
    let [normal_min, normal_max] = all(&both(|s| s.normal_n));
    m.set("contact_force_min", normal_min);
    m.set("contact_force_max", normal_max);
    let [brace_min, brace_max] = all(&both(|s| s.brace_n));
    m.set("brace_tension_min", brace_min);
    m.set("brace_tension_max", brace_max);
    let needed = |i: &Instant| i.sides.iter().map(|s| (s.tangential_n / s.normal_n).abs()).fold(0.0, f64::max);
    let in_motion = behaviour.motion.iter().flatten().map(|moment| needed(&moment.moving)).fold(0.0, f64::max);
    m.set("friction_needed_max", all(&both(|s| (s.tangential_n / s.normal_n).abs()))[1].max(in_motion));
    m.set("guide_force_max", all(&|i: &Instant| [i.guide_n.abs(); 2])[1]);
    let [length_min, length_max] = all(&|i: &Instant| [i.spring_m; 2]);
    m.set("spring_length_min", length_min);
    m.set("spring_length_max", length_max);
    m.set("spring_force_max", all(&|i: &Instant| [i.spring_n.abs(); 2])[1]);
    m.set("pressure_angle_max", Behaviour::extent(&behaviour.window, |s| pressure_angle(behaviour, s))[1]);
    let lateral = |s: &Station| {
        let x = 1e-6;
        let force = |x: f64| {
            let at = [s.travel_m, s.sideways_m[0] + x];
            let pose = behaviour.mechanism.pose_near(at, Some(&s.pose)).ok()?;
            Some(behaviour.mechanism.forces(&pose, &Drive { at, ..Drive::default() }, Sense::Frictionless).guide_n)
        };
        force(x).zip(force(-x)).map_or(f64::NAN, |(a, b)| (a - b) / (2.0 * x))
    };
    let sparse: Vec<Station> = behaviour.window.iter().step_by(behaviour.window.len().div_ceil(40)).copied().collect();
    m.set("lateral_stiffness_min", Behaviour::extent(&sparse, lateral)[0]);
}

/// The larger of the two angles between the pull of a brace and the path of its roller, rad.
pub(crate) fn pressure_angle(behaviour: &Behaviour, station: &Station) -> f64 {
    let sense = behaviour.mechanism.springs.sense();
    let of = |side: usize| {
        let place = &station.pose.places[side];
        let [along, _] = frame(place, sense);
        let joint = station.pose.joints[side];
        let brace = [joint[0] - place.at[0], joint[1] - place.at[1]];
        let (dot, cross) = (along[0] * brace[0] + along[1] * brace[1], along[0] * brace[1] - along[1] * brace[0]);
        maths::atan2(cross.abs(), dot.abs())
    };
    of(0).max(of(1))
}

fn moving(behaviour: &Behaviour, m: &mut Measured) {
    let Some(motion) = &behaviour.motion else { return };
    let most = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::NEG_INFINITY, f64::max);
    m.set("peak_force_ratio", most(&mut motion.iter().map(|i| i.moving.force_n / i.resting.force_n - 1.0)));
    if let Some(reference) = &behaviour.reference {
        m.set("peak_force_ratio_to", most(&mut motion.iter().zip(reference).map(|(a, b)| a.moving.force_n / b.moving.force_n - 1.0)));
    }
    m.set("force_max_motion", most(&mut motion.iter().map(|i| i.moving.force_n)));
    m.set("force_min_motion", -most(&mut motion.iter().map(|i| -i.moving.force_n)));
    let least = |i: &Moment| i.moving.sides[0].normal_n.min(i.moving.sides[1].normal_n);
    m.set("contact_force_min_motion", -most(&mut motion.iter().map(|i| -least(i))));
}

/// Speed, time, work and loss of a motion.
fn work(behaviour: &Behaviour, m: &mut Measured) {
    let Some(motion) = &behaviour.motion else { return };
    m.set("speed_max", motion.iter().map(|i| i.speed_m_per_s.abs()).fold(0.0, f64::max));
    m.set("work_in", integral(motion, |i| (i.moving.force_n * i.speed_m_per_s).max(0.0)));
    let Some(release) = &behaviour.release else {
        m.set("energy_lost", integral(motion, |i| i.lost_w));
        return;
    };
    m.set("energy_lost", release.friction_j + release.damping_j + release.catches_j);
    if matches!(release.end, End::Stop { .. }) {
        m.set("time_to_end", release.time_s);
        m.set("speed_end", motion.last().map(|i| i.speed_m_per_s.abs()));
    }
    m.set("slack_time", motion.iter().any(|i| i.cable_n.is_some()).then_some(release.slack_s));
}
