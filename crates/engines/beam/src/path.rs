//! Equilibrium paths: stepping from rest, at increasing resolution.

use std::sync::Arc;

use crate::{
    assembly::{Resolution, System},
    counters::Counters,
    error::{NetworkError, PathError, Status},
    follow::{Followed, Start, bifurcations, follow},
    model::Model,
    network::{Follow, Joints, Network, Settings},
    output,
    overlap::Zones,
    stability::{Bifurcation, Fold, Jump},
    state::Point,
    stepping::{Knot, Run, Stepper, interpolate, larger},
};

/// Polynomial degrees of the rotation of a beam that are tried in turn.
pub(crate) const DEGREES: [usize; 8] = [6, 9, 12, 16, 22, 30, 38, 48];

/// The first degree worth trying: two degrees too low would be computed for nothing.
fn first_degree(accuracy: f64) -> usize {
    if accuracy >= 1e-4 {
        0
    } else if accuracy >= 1e-6 {
        1
    } else {
        2
    }
}

/// The first resolution only serves the comparison: it visits about this many stations.
const COMPARED: usize = 12;

/// An equilibrium path from rest.
#[derive(Debug, Clone)]
pub struct Path {
    /// The ends of the load stages before the drive that were reached, in order; all of them unless [`Path::status`] is about a stage:
    /// then it is about the first that is missing here, and there are no points.
    pub before: Vec<Point>,
    /// The stations reached, in order.
    pub points: Vec<Point>,
    /// How the path ended.
    pub status: Status,
    /// Difference between the two finest resolutions, relative to the largest force or stress, whichever is worse; `None` if only one
    /// was computed.
    pub error_estimate: Option<f64>,
    /// Polynomial degree of the rotation of each beam.
    pub degree: usize,
    /// Work done, all resolutions together.
    pub counters: Counters,
    /// With [`Follow::ToEnd`] the complete equilibrium path in its own order, through all limit points to the last station: every
    /// step, every limit point, every landing of a jump, and every station each time that the path passes it. Stretches on which the
    /// control falls, and unstable ones, are part of it; [`Point::branch`] and [`Point::instability`] tell them apart. Empty otherwise.
    ///
    /// A device that is driven slowly passes through the points before the first of [`Path::jumps`], then through those from its
    /// landing to the next one, and so on.
    pub whole: Vec<Point>,
    /// How [`Path::whole`] ended. Only where it is complete, the points beyond the first limit point are as accurate as asked.
    pub whole_status: Status,
    /// Limit points of the control in path order; the control falls after the first, rises after the second, and so on.
    pub folds: Vec<Fold>,
    /// What a slowly driven device jumps over.
    pub jumps: Vec<Jump>,
    /// Where stability changes without a limit point, in path order, with and without [`Follow::ToEnd`].
    pub bifurcations: Vec<Bifurcation>,
    model: Arc<Model>,
    zones: Arc<Zones>,
    resolution: Arc<Resolution>,
    /// That of [`Path::whole`].
    whole_resolution: Arc<Resolution>,
    knots: Arc<Vec<Knot>>,
}

/// The path of a network at given stations: ascending values ≥ 0 of the control, in the unit of the drive.
///
/// Starts at rest, which is an exact equilibrium, and never from another design's solution, so a path is a pure function of its
/// input. Steps are cubic Hermite extrapolations corrected by Newton's method and kept so short that the correction stays small;
/// every station is met exactly. The whole path is computed at increasing polynomial degree until forces and stresses of two
/// degrees agree to [`Settings::accuracy`]; the finer one is returned.
///
/// `progress` receives a growing fraction in [0, 1] after each step; `false` stops.
///
/// Failure to reach a station is not an error: [`Path::status`] says what was reached and why.
///
/// # Errors
/// [`NetworkError`] if the network, the stations or the settings make no sense.
///
/// ```
/// use forcewright_beam::{Beam, Drive, Network, Node, Section, Settings, Shape, Support, Theory, trace};
/// // A cantilever, 0.1 m long, bent to a half circle by a moment of π EI/L.
/// let section = Section { young_pa: 2e9, thickness_m: 1e-3, depth_m: 1e-2, poisson: None };
/// let nodes = vec![
///     Node { position_m: [0.0, 0.0], support: Support::Clamped },
///     Node { position_m: [0.1, 0.0], support: Support::Free },
/// ];
/// let beams = vec![Beam::new(0, 1, Shape::new(vec![0.0], 0.1)?, section)];
/// let network = Network::new(nodes, beams, Drive::Rotation { node: 1 });
/// let settings = Settings { theory: Theory::Inextensible, ..Settings::default() };
/// let path = trace(&network, &[std::f64::consts::PI], &settings, &mut |_| true)?;
/// assert!(path.status.is_complete());
/// let end = &path.points[0];
/// let moment = std::f64::consts::PI * section.bending_stiffness_n_m2() / 0.1;
/// assert!((end.force / moment - 1.0).abs() < 1e-10);
/// assert!((end.nodes[1].displacement_m[1] - 0.2 / std::f64::consts::PI).abs() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn trace(
    network: &Network,
    stations: &[f64],
    settings: &Settings,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Path, NetworkError> {
    network.check()?;
    let accuracy = settings.accuracy;
    if !(accuracy > 0.0 && accuracy < 1.0) {
        return Err(NetworkError::Accuracy { accuracy });
    }
    check_stations(stations)?;
    let zones = match settings.joints {
        Joints::Point => Zones::none(network),
        Joints::Overlap => Zones::of(network)?,
    };
    let model = Arc::new(Model::with_zones(network, settings.theory, &zones));
    let degrees = &DEGREES[first_degree(accuracy)..];
    let sample = thinned(stations);
    let mut counters = Counters::default();
    let mut coarser: Option<(Run, Arc<Resolution>)> = None;
    let mut error_estimate = None;
    let mut level = 0;
    let natural = if settings.follow == Follow::ToEnd { 0.5 } else { 1.0 };
    // A finer resolution begins anew, but progress never goes back.
    let mut furthest = 0.0_f64;
    let mut progress = |fraction: f64| {
        furthest = furthest.max(fraction);
        progress(furthest)
    };
    loop {
        // Half of what is left for each level: the number of levels is not known beforehand.
        let (done, share) = (1.0 - halves(level), halves(level + 1));
        let mut part = |fraction: f64| progress(natural * (done + share * fraction));
        let visited = if level == 0 { &sample } else { stations };
        let approach = Approach::new(&model, degrees[level], settings.iteration_limit, &mut counters, &mut part);
        let Approach { resolution, before, bifurcations, failed } = approach;
        let run = match failed {
            Some(status) => Run { points: Vec::new(), knots: Vec::new(), status },
            None => Stepper::new(&model, &resolution, settings.iteration_limit, &mut counters, &mut part).run(visited),
        };
        let hopeless = matches!(
            run.status,
            Status::Stopped { .. } | Status::IterationLimit { .. } | Status::OverConstrained { .. } | Status::Mechanism { .. }
        );
        let mut resolved = false;
        if let Some((before, _)) = &coarser {
            let estimate = difference(&model, &before.points, &run.points);
            error_estimate = Some(estimate);
            resolved = estimate <= accuracy && same_end(&before.status, &run.status);
        }
        level += 1;
        if hopeless || resolved || level == degrees.len() {
            let mut path = finish(model, (run, resolution), coarser, error_estimate, accuracy);
            (path.before, path.zones, path.bifurcations) = (before, Arc::new(zones), bifurcations);
            let mut rest = |fraction: f64| progress(0.5 + 0.5 * fraction);
            path.finish_whole(stations, settings, &mut counters, &mut rest);
            path.counters = counters;
            return Ok(path);
        }
        coarser = Some((run, resolution));
    }
}

/// The loads before the drive, at one resolution.
pub(crate) struct Approach {
    /// With the state in which the last load begins.
    pub(crate) resolution: Arc<Resolution>,
    /// The ends of the loads that were reached.
    pub(crate) before: Vec<Point>,
    /// Where stability changed on the way.
    pub(crate) bifurcations: Vec<Bifurcation>,
    /// Why not all of them were.
    pub(crate) failed: Option<Status>,
}

impl Approach {
    /// Carries out the loads before that of `model`, one after the other.
    pub(crate) fn new(model: &Model, degree: usize, budget: u64, counters: &mut Counters, progress: &mut dyn FnMut(f64) -> bool) -> Self {
        let mut loads: Vec<&Model> = Vec::new();
        let mut earlier = model.before.as_deref();
        while let Some(load) = earlier {
            loads.push(load);
            earlier = load.before.as_deref();
        }
        let mut resolution = Arc::new(Resolution::new(model, degree));
        let (mut before, mut changes) = (Vec::with_capacity(loads.len()), Vec::new());
        for load in loads.into_iter().rev() {
            let mut unseen = |_: f64| progress(0.0);
            let run = Stepper::new(load, &resolution, budget, counters, &mut unseen).run(&[load.end]);
            let start = Start { model: load, resolution: &resolution, knots: &run.knots, status: run.status };
            changes.extend(bifurcations(&start, budget, counters));
            let (Some(knot), Some(point)) = (run.knots.last(), run.points.into_iter().next_back()) else {
                return Self { resolution, before, bifurcations: changes, failed: Some(run.status) };
            };
            let next = resolution.starting_at(knot.state.clone());
            before.push(point);
            resolution = Arc::new(next);
        }
        Self { resolution, before, bifurcations: changes, failed: None }
    }
}

/// About [`COMPARED`] of the stations, the last included.
fn thinned(stations: &[f64]) -> Vec<f64> {
    let stride = stations.len().div_ceil(COMPARED).max(1);
    let from_the_end = stations.iter().rev().step_by(stride);
    let mut sample: Vec<f64> = from_the_end.copied().collect();
    sample.reverse();
    sample
}

/// 2⁻ⁿ.
fn halves(n: usize) -> f64 {
    (0..n).fold(1.0, |product, _| 0.5 * product)
}

pub(crate) fn check_stations(stations: &[f64]) -> Result<(), NetworkError> {
    let mut before = -1.0;
    for (index, &s) in stations.iter().enumerate() {
        // Written so that NaN fails. The first may be 0.
        if !(s.is_finite() && s > before && s >= 0.0) {
            return Err(NetworkError::Stations { index });
        }
        before = s;
    }
    Ok(())
}

/// Builds the answer from the finest run, or from the one before if the finest was cut short.
fn finish(
    model: Arc<Model>,
    finest: (Run, Arc<Resolution>),
    coarser: Option<(Run, Arc<Resolution>)>,
    error_estimate: Option<f64>,
    accuracy: f64,
) -> Path {
    let status = match finest.0.status {
        Status::Complete => match error_estimate {
            Some(e) if e <= accuracy => Status::Complete,
            other => Status::NotResolved { error_estimate: other.unwrap_or(f64::INFINITY), accuracy },
        },
        other => other,
    };
    let cut_short = matches!(status, Status::Stopped { .. } | Status::IterationLimit { .. });
    let (run, resolution) = match coarser {
        Some(before) if cut_short && before.0.knots.len() > finest.0.knots.len() => before,
        _ => finest,
    };
    Path {
        before: Vec::new(),
        points: run.points,
        status,
        error_estimate,
        degree: resolution.degree,
        counters: Counters::default(),
        whole: Vec::new(),
        whole_status: status,
        folds: Vec::new(),
        jumps: Vec::new(),
        bifurcations: Vec::new(),
        zones: Arc::new(Zones::default()),
        model,
        whole_resolution: Arc::clone(&resolution),
        resolution,
        knots: Arc::new(run.knots),
    }
}

/// Whether two resolutions ended alike.
pub(crate) fn same_end(a: &Status, b: &Status) -> bool {
    match (a, b) {
        (Status::Complete, Status::Complete) => true,
        (Status::NoEquilibriumBeyond { control: a }, Status::NoEquilibriumBeyond { control: b })
        | (Status::PulledStraight { control: a, .. }, Status::PulledStraight { control: b, .. })
        | (Status::StepTooSmall { control: a }, Status::StepTooSmall { control: b }) => (a - b).abs() <= 1e-4 * a.abs().max(b.abs()),
        _ => false,
    }
}

/// Largest difference of force and of the largest stress of a beam over the common stations, relative to the largest of the path.
fn difference(model: &Model, coarse: &[Point], fine: &[Point]) -> f64 {
    // Next to rest, forces and stresses are differences of angles: rounding. These floors are those of a rotation of 1e-6 rad.
    let mut largest_force = 1e-6 * model.reaction_unit();
    let mut largest_stress = 1e-6 * model.beams.iter().map(|b| b.info.stress_unit_pa()).fold(0.0, f64::max);
    let (mut force, mut stress) = (0.0_f64, 0.0_f64);
    let mut compared = coarse.iter().peekable();
    let mut nothing_compared = true;
    for b in fine {
        largest_force = largest_force.max(b.force.abs());
        largest_stress = b.beams.iter().fold(largest_stress, |m, s| m.max(s.peak_stress().stress_pa));
        // Both lists ascend and hold the same numbers where they meet.
        let Some(a) = compared.next_if(|a| a.control <= b.control) else { continue };
        nothing_compared &= a.control <= 0.0;
        force = larger(force, (a.force - b.force).abs());
        // Under force control the displacement carries the error. Below rounding it is none, however stiff the network is: a motion
        // that inextensible beams lock has a displacement of 0 and a stiffness without limit.
        let apart = (a.displacement - b.displacement).abs();
        if apart.is_nan() || apart > 1e-14 * model.displacement_unit() {
            force = larger(force, (a.stiffness * apart).abs());
        }
        for (a, b) in a.beams.iter().zip(&b.beams) {
            stress = larger(stress, (a.peak_stress().stress_pa - b.peak_stress().stress_pa).abs());
        }
    }
    if nothing_compared && fine.iter().any(|p| p.control > 0.0) {
        return f64::INFINITY;
    }
    larger(force / largest_force, stress / largest_stress)
}

impl Path {
    /// The equations of the path, and the resolution of its points and of [`Path::whole`].
    pub(crate) fn equations(&self) -> (&Model, [&Resolution; 2]) {
        (&self.model, [&self.resolution, &self.whole_resolution])
    }

    /// The resolution that a point was found with, if it is one of this path.
    pub(crate) fn resolution_of(&self, point: &Point) -> Option<&Resolution> {
        let own = point.stage == self.model.stage
            && point.beams.len() == self.model.spans.len()
            && point.beams.iter().zip(&self.model.spans).all(|(b, (_, line))| b.lies_on(line));
        [&self.resolution, &self.whole_resolution].into_iter().find(|r| own && r.initial.len() == point.state.len()).map(Arc::as_ref)
    }

    /// The rigid zones of the beams.
    pub(crate) fn zones(&self) -> &Zones {
        &self.zones
    }

    /// The largest control reached, in the unit of the drive.
    pub fn reach(&self) -> f64 {
        self.knots.last().map_or(0.0, |k| k.control * self.model.control_unit())
    }

    /// Adds what lies beyond limit points, if asked for, and bifurcations.
    fn finish_whole(&mut self, stations: &[f64], settings: &Settings, counters: &mut Counters, progress: &mut dyn FnMut(f64) -> bool) {
        let start = Start { model: &self.model, resolution: &self.resolution, knots: &self.knots, status: self.status };
        let followed = match settings.follow {
            Follow::StopAtLimit => {
                Followed { bifurcations: bifurcations(&start, settings.iteration_limit, counters), ..Followed::default() }
            }
            Follow::ToEnd => follow(&start, stations, settings, counters, progress),
        };
        if settings.follow == Follow::ToEnd {
            self.whole_status = followed.status;
        }
        (self.whole, self.folds, self.jumps) = (followed.whole, followed.folds, followed.jumps);
        self.bifurcations.extend(followed.bifurcations);
        if let Some(resolution) = followed.resolution {
            self.whole_resolution = resolution;
        }
    }

    /// Stiffness of the driven node against small motions (x, y, rotation) at a point of this path, the other nodes as their supports
    /// and loads hold them: forces (N, N, N·m) per motion (m, m, rad), symmetric; rows of a motion without meaning are 0. Its own support
    /// and the drive are left out, so a negative eigenvalue is a direction in which the node stays only if something guides it.
    ///
    /// `None` where the rest of the network is itself at a limit, or if the point is not of this path. Costs one Newton iteration.
    pub fn output_stiffness(&self, point: &Point) -> Option<[[f64; 3]; 3]> {
        let mut system = System::new(&self.model, self.resolution_of(point)?);
        system.evaluate(&point.state, point.control / self.model.control_unit()).ok()?;
        output::stiffness(&system, self.model.driven_node)
    }

    /// The exact equilibrium at any control between 0 and [`Path::reach`].
    ///
    /// # Errors
    /// [`PathError`] outside that range, or if the equations do not converge (next to a limit point).
    pub fn at(&self, control: f64) -> Result<Point, PathError> {
        let reached = self.reach();
        // Written so that NaN fails.
        if self.knots.is_empty() || !(control >= 0.0 && control <= reached * (1.0 + 4.0 * f64::EPSILON)) {
            return Err(PathError::OutOfReach { control, reached });
        }
        let wanted = control / self.model.control_unit();
        let after = self.knots.partition_point(|k| k.control < wanted).clamp(1, self.knots.len().max(2) - 1);
        let guess = match (self.knots.get(after - 1), self.knots.get(after)) {
            (Some(a), Some(b)) => interpolate(a, b, wanted),
            (Some(a), None) => a.state.clone(),
            _ => return Err(PathError::OutOfReach { control, reached }),
        };
        let mut counters = Counters::default();
        let mut go_on = |_: f64| true;
        let mut stepper = Stepper::new(&self.model, &self.resolution, u64::MAX, &mut counters, &mut go_on);
        stepper.solve_near(guess, wanted, control).ok_or(PathError::NotConverged { control })
    }
}
