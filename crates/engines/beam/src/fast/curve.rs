//! The curve of one design: steps, interpolation, error estimate.

use forcewright_base::maths;

use super::kernel::{Beams, Condensed, EXTRA, Tables, Unknowns, linearise};
use super::lanes::{LANES, Lane};
use super::network::{Net, add_scaled};
use super::stencil::Stencil;
use super::stress::{Sampling, Scratch, Slopes};
use crate::counters::Counters;
use crate::error::{NetworkError, Status};
use crate::model::Model;
use crate::network::{Drive, Joints, Network, Settings};
use crate::path::{check_stations, trace};

/// Largest distance between prediction and solution, rad, as in the general path.
const LARGEST_CORRECTION: f64 = 0.02;
/// A displacement counts this many times as much as a rotation.
const TRAVEL_WEIGHT: f64 = 6.0;
/// Largest change of a rotation in one step, rad.
const LARGEST_TURN: f64 = 0.4;
const MOST_ITERATIONS: usize = 6;
/// Walks with ever shorter steps before the general path is asked.
const ATTEMPTS: usize = 3;
const MOST_STEPS: usize = 400;
/// States used by the interpolation; two fewer give the lower order that estimates its error.
const STATES: usize = 8;
/// The same below the accuracy [`TIGHT`].
const MORE_STATES: usize = 10;
const TIGHT: f64 = 3e-5;

/// Force and stress over displacement.
#[derive(Clone, Debug, Default)]
pub struct Response {
    /// Force on the drive at each station, N; the drawn network.
    pub force_n: Vec<f64>,
    /// Its slope, N/m.
    pub stiffness_n_per_m: Vec<f64>,
    /// Largest stress over all beams and both faces at each station, Pa.
    pub stress_pa: Vec<f64>,
    /// The beam that carries it.
    pub stress_beam: Vec<usize>,
    /// How the path ended; stations beyond its end are missing.
    pub status: Status,
    /// Estimated error of the force, relative to the largest.
    pub error_estimate: f64,
    /// Whether the general path computed it.
    pub general: bool,
    /// Negative eigenvalues less multipliers at the end: 0 where the state is stable under prescribed displacement. `None` from the
    /// general path.
    pub instability: Option<i64>,
    /// Work done.
    pub counters: Counters,
}

/// Solves curves one after another in the same buffers. A curve depends on nothing but its own arguments.
#[derive(Debug)]
pub struct CurveSolver {
    small: Walker<5, 8>,
    medium: Walker<7, 11>,
    large: Walker<10, 15>,
    huge: Walker<15, 21>,
    response: Response,
}

impl Default for CurveSolver {
    fn default() -> Self {
        Self::new()
    }
}

impl CurveSolver {
    /// Empty buffers and the tables of all resolutions.
    pub fn new() -> Self {
        Self { small: Walker::new(), medium: Walker::new(), large: Walker::new(), huge: Walker::new(), response: Response::default() }
    }

    /// The curve of a network whose drive is a displacement, at ascending stations ≥ 0, m.
    ///
    /// The force is accurate to [`Settings::accuracy`] of the largest one by the estimate in the result; stress converges more slowly.
    ///
    /// # Errors
    /// [`NetworkError`] if network, stations or settings make no sense.
    pub fn solve(&mut self, network: &Network, stations_m: &[f64], settings: &Settings) -> Result<&Response, NetworkError> {
        network.check()?;
        check_stations(stations_m)?;
        if !(settings.accuracy > 0.0 && settings.accuracy < 1.0) {
            return Err(NetworkError::Accuracy { accuracy: settings.accuracy });
        }
        let model = Model::new(network, settings.theory);
        let mut counters = Counters::default();
        let plain = model.plain && settings.joints == Joints::Point;
        if plain && matches!(network.drive, Drive::Displacement { .. }) && !stations_m.is_empty() {
            let first = usize::from(settings.accuracy < 3e-7);
            for level in first..4 {
                let out = &mut self.response;
                let run = match level {
                    0 => self.small.run(&model, stations_m, settings.accuracy, &mut counters, out, Some(&self.medium.tables)),
                    1 => self.medium.run(&model, stations_m, settings.accuracy, &mut counters, out, Some(&self.large.tables)),
                    2 => self.large.run(&model, stations_m, settings.accuracy, &mut counters, out, Some(&self.huge.tables)),
                    _ => self.huge.run(&model, stations_m, settings.accuracy, &mut counters, out, None::<&Tables<15, 21>>),
                };
                match run {
                    Ok(()) => {
                        self.response.counters = counters;
                        return Ok(&self.response);
                    }
                    Err(GiveUp::Unresolved) => {}
                    Err(GiveUp::Unsafe) => break,
                }
            }
        }
        self.general(network, stations_m, settings, counters)
    }

    fn general(&mut self, network: &Network, stations_m: &[f64], settings: &Settings, before: Counters) -> Result<&Response, NetworkError> {
        let path = trace(network, stations_m, settings, &mut |_| true)?;
        let out = &mut self.response;
        out.clear();
        for point in &path.points {
            out.force_n.push(point.force);
            out.stiffness_n_per_m.push(point.stiffness);
            let (beam, peak) = point.peak_stress().map_or((0, 0.0), |(beam, peak)| (beam, peak.stress_pa));
            out.stress_pa.push(peak);
            out.stress_beam.push(beam);
        }
        out.status = path.status;
        out.error_estimate = path.error_estimate.unwrap_or(f64::INFINITY);
        out.general = true;
        out.instability = None;
        out.counters = before + path.counters;
        Ok(out)
    }
}

impl Response {
    fn clear(&mut self) {
        self.force_n.clear();
        self.stiffness_n_per_m.clear();
        self.stress_pa.clear();
        self.stress_beam.clear();
    }
}

/// Why a walk ended without a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GiveUp {
    /// A higher polynomial degree may do.
    Unresolved,
    /// The general path must decide.
    Unsafe,
}

/// A state with its derivative by the driven unknown.
#[derive(Clone, Debug, Default)]
struct Node<const M: usize> {
    control: f64,
    x: Vec<f64>,
    dx: Vec<f64>,
    inner: Vec<Unknowns<M>>,
    d_inner: Vec<Unknowns<M>>,
    extra: Vec<[Lane; EXTRA]>,
    force: f64,
}

/// Walks along a path with `M` bubbles and `Q` points per beam.
#[derive(Debug)]
struct Walker<const M: usize, const Q: usize> {
    tables: Tables<M, Q>,
    /// Slopes of the bubbles where stress is looked for.
    sampling: Sampling<M>,
    groups: Vec<Beams<Q>>,
    condensed: Vec<Condensed<M>>,
    nodes: Vec<Node<M>>,
    used: usize,
    x: Vec<f64>,
    inner: Vec<Unknowns<M>>,
}

impl<const M: usize, const Q: usize> Walker<M, Q> {
    fn new() -> Self {
        Self {
            tables: Tables::new(),
            sampling: Sampling::new(),
            groups: Vec::new(),
            condensed: Vec::new(),
            nodes: Vec::new(),
            used: 0,
            x: Vec::new(),
            inner: Vec::new(),
        }
    }

    fn run<const N: usize, const R: usize>(
        &mut self,
        model: &Model,
        stations_m: &[f64],
        accuracy: f64,
        counters: &mut Counters,
        out: &mut Response,
        finer: Option<&Tables<N, R>>,
    ) -> Result<(), GiveUp> {
        let mut net = Net::new(model, TRAVEL_WEIGHT);
        prepare(model, &self.tables, &mut self.groups);
        let end = stations_m[stations_m.len() - 1] / model.length_m;
        // Interpolation: as many states as its error asks for on curves like the paper's, and more where that is not enough.
        let mut longest = end / (8.0 * maths::powf(1e-4 / accuracy, 0.12).max(1.0));
        let (mut largest, mut interpolation, mut instability) = (0.0, f64::INFINITY, 0);
        for _ in 0..ATTEMPTS {
            self.walk(model, &mut net, end, longest, accuracy, counters)?;
            instability = net.instability;
            largest = self.nodes[..self.used].iter().fold(f64::MIN_POSITIVE, |m, n| m.max(n.force.abs()));
            interpolation = self.emit(model, stations_m, accuracy, out) / largest;
            if 2.0 * interpolation <= accuracy {
                break;
            }
            longest *= 0.6;
        }
        let resolution = match finer {
            Some(finer) => self.resolution_error(model, &mut net, finer, counters)? / largest,
            None => self.tail(),
        };
        // Each part is a difference of two orders at a few places; on random designs twice the larger one covers nearly all errors.
        let estimate = 2.0 * resolution.max(interpolation);
        if estimate > accuracy || estimate.is_nan() {
            return Err(if 2.0 * resolution <= accuracy { GiveUp::Unsafe } else { GiveUp::Unresolved });
        }
        out.status = Status::Complete;
        out.error_estimate = estimate;
        out.general = false;
        out.instability = Some(instability);
        Ok(())
    }

    /// Steps from rest to the end.
    fn walk(&mut self, model: &Model, net: &mut Net, end: f64, longest: f64, accuracy: f64, counters: &mut Counters) -> Result<(), GiveUp> {
        self.used = 0;
        self.x.clear();
        self.x.resize(net.unknowns, 0.0);
        self.inner.clear();
        self.inner.resize(self.groups.len(), Unknowns::default());
        // One Newton iteration squares the distance; what is left must be below the accuracy.
        let accepted = (0.12 * accuracy.sqrt()).min(LARGEST_CORRECTION);
        self.iterate(net, counters)?;
        self.keep(model, net, 0.0);
        let mut step = (LARGEST_TURN / size(net, &net.tangent, model.projection)).min(end) / 4.0;
        while self.nodes[self.used - 1].control < end {
            if self.used > MOST_STEPS {
                return Err(GiveUp::Unsafe);
            }
            let here = self.nodes[self.used - 1].control;
            let left = end - here;
            // Closer together near the ends, where interpolation has neighbours on one side only.
            let crowding = (here.min(left) / (0.2 * end)).clamp(0.16, 1.0).sqrt();
            let limit = (LARGEST_TURN / size(net, &net.tangent, model.projection)).min(longest * crowding);
            let length = step.min(limit);
            let target = if left <= 1.000_001 * length {
                end
            } else if left < 2.0 * length {
                here + 0.5 * left
            } else {
                here + length
            };
            match self.advance(model, net, target, accepted, counters)? {
                None => {
                    counters.rejected_steps += 1;
                    step = 0.4 * (target - here);
                    if step < 1e-4 * end {
                        return Err(GiveUp::Unsafe);
                    }
                }
                Some(distance) => {
                    counters.steps += 1;
                    // The prediction is of fourth order.
                    let ratio = 0.4 * accepted / distance.max(1e-300);
                    step = (target - here).max(1e-12) * (0.9 * ratio.sqrt().sqrt()).clamp(0.4, 2.5);
                }
            }
        }
        Ok(())
    }

    /// One step; the distance of the prediction, or `None` if it must be shorter.
    fn advance(
        &mut self,
        model: &Model,
        net: &mut Net,
        target: f64,
        accepted: f64,
        counters: &mut Counters,
    ) -> Result<Option<f64>, GiveUp> {
        self.predict(net, target, model.projection);
        let mut first = None;
        for _ in 0..MOST_ITERATIONS {
            self.iterate(net, counters)?;
            let distance = size(net, &net.change, 1.0);
            let start = *first.get_or_insert(distance);
            if start > LARGEST_CORRECTION || start.is_nan() {
                return Ok(None);
            }
            if distance <= accepted {
                self.keep(model, net, target);
                return Ok(Some(start));
            }
        }
        Ok(None)
    }

    /// Cubic Hermite extrapolation from two states, or the tangent of the first.
    fn predict(&mut self, net: &Net, target: f64, projection: f64) {
        let b = &self.nodes[self.used - 1];
        let ahead = target - b.control;
        if self.used < 2 {
            for (i, x) in self.x.iter_mut().enumerate() {
                *x = b.x[i] + ahead * b.dx[i];
            }
            for (inner, (u, d)) in self.inner.iter_mut().zip(b.inner.iter().zip(&b.d_inner)) {
                *inner = *u;
                add_scaled(inner, d, ahead);
            }
        } else {
            let a = &self.nodes[self.used - 2];
            let h = b.control - a.control;
            let s = ahead / h;
            let (back, slope_a, slope_b) = (s * s * (3.0 + 2.0 * s), h * s * s * (1.0 + s), h * s * (1.0 + s) * (1.0 + s));
            for (i, x) in self.x.iter_mut().enumerate() {
                *x = b.x[i] + back * (a.x[i] - b.x[i]) + slope_a * a.dx[i] + slope_b * b.dx[i];
            }
            for (g, inner) in self.inner.iter_mut().enumerate() {
                *inner = b.inner[g];
                add_scaled(inner, &a.inner[g], back);
                add_scaled(inner, &b.inner[g], -back);
                add_scaled(inner, &a.d_inner[g], slope_a);
                add_scaled(inner, &b.d_inner[g], slope_b);
            }
        }
        self.x[net.unknowns - 1] = target / projection;
    }

    /// One Newton iteration from the current state, which it corrects.
    fn iterate(&mut self, net: &mut Net, counters: &mut Counters) -> Result<(), GiveUp> {
        counters.newton_iterations += 1;
        counters.residual_evaluations += 1;
        counters.factorisations += 1;
        linearise_all(&self.tables, &self.groups, &self.x, &mut self.inner, &mut self.condensed, net)?;
        for (x, c) in self.x.iter_mut().zip(&net.change) {
            *x += c;
        }
        for (g, (inner, condensed)) in self.inner.iter_mut().zip(&self.condensed).enumerate() {
            let (ends, apart) = net.ends(g, &net.change);
            add_scaled(inner, &condensed.expand(ends, apart, 1.0), 1.0);
        }
        Ok(())
    }

    /// Stores the state and its derivative by the control.
    fn keep(&mut self, model: &Model, net: &Net, control: f64) {
        if self.nodes.len() == self.used {
            self.nodes.push(Node::default());
        }
        let node = &mut self.nodes[self.used];
        self.used += 1;
        node.control = control;
        node.force = net.reaction / model.projection;
        node.x.clone_from(&self.x);
        node.dx.clear();
        node.dx.extend(net.tangent.iter().map(|t| t / model.projection));
        node.inner.clone_from(&self.inner);
        for (g, inner) in node.inner.iter_mut().enumerate() {
            inner.ends = net.ends(g, &self.x).0;
        }
        node.extra.clear();
        node.extra.extend(self.condensed.iter().map(|c| c.extra));
        node.d_inner.clear();
        for (g, condensed) in self.condensed.iter().enumerate() {
            let (ends, apart) = net.ends(g, &node.dx);
            node.d_inner.push(condensed.expand(ends, apart, 0.0));
        }
    }

    /// Change of the force at the end, and half way, by one iteration with a higher degree: the error of this one.
    fn resolution_error<const N: usize, const R: usize>(
        &self,
        model: &Model,
        net: &mut Net,
        finer: &Tables<N, R>,
        counters: &mut Counters,
    ) -> Result<f64, GiveUp> {
        let mut groups = Vec::new();
        prepare(model, finer, &mut groups);
        let mut condensed = Vec::new();
        let mut worst = 0.0_f64;
        for at in [self.used - 1, self.used / 2] {
            let node = &self.nodes[at];
            let mut inner: Vec<Unknowns<N>> = node
                .inner
                .iter()
                .map(|u| {
                    let mut wide = Unknowns { ends: u.ends, force: u.force, ..Unknowns::default() };
                    wide.bubbles[..M].copy_from_slice(&u.bubbles);
                    wide
                })
                .collect();
            counters.residual_evaluations += 1;
            counters.factorisations += 1;
            linearise_all(finer, &groups, &node.x, &mut inner, &mut condensed, net)?;
            worst = worst.max((net.reaction / model.projection - node.force).abs());
        }
        Ok(worst)
    }

    /// For the highest degree, which has no finer one: the square of the last amplitudes relative to the largest.
    fn tail(&self) -> f64 {
        let node = &self.nodes[self.used - 1];
        let largest = |range: std::ops::Range<usize>| {
            node.inner
                .iter()
                .flat_map(|u| &u.bubbles[range.clone()])
                .fold(Lane::ZERO, |m, b| m.max(b.abs()))
                .0
                .into_iter()
                .fold(0.0, f64::max)
        };
        let ratio = largest(M - 2..M) / largest(0..M).max(f64::MIN_POSITIVE);
        ratio * ratio
    }

    /// Force, slope and stress at the stations. Returns the estimated interpolation error of the force, dimensionless.
    fn emit(&self, model: &Model, stations_m: &[f64], accuracy: f64, out: &mut Response) -> f64 {
        out.clear();
        let nodes = &self.nodes[..self.used];
        let places: Vec<f64> = nodes.iter().map(|n| n.control).collect();
        let states = if accuracy < TIGHT { MORE_STATES } else { STATES };
        let (mut wide, mut narrow) = (Stencil::new(states), Stencil::new(states - 2));
        let stress = Sampling::<M>::model(model);
        let mut scratch = Scratch::default();
        let mut state = vec![Slopes::<M>::default(); self.groups.len()];
        let mut worst = 0.0_f64;
        for station in stations_m {
            let at = station / model.length_m;
            wide.place(&places, at);
            narrow.place(&places, at);
            let sum = |first: usize, weights: &[f64]| nodes[first..].iter().zip(weights).map(|(n, w)| n.force * w).sum::<f64>();
            let force = sum(wide.first, wide.values());
            worst = worst.max((force - sum(narrow.first, narrow.values())).abs());
            out.force_n.push(force * model.force_n);
            out.stiffness_n_per_m.push(sum(wide.first, wide.slopes()) * model.force_n / model.length_m);
            state.fill(Slopes::default());
            for (node, w) in nodes[wide.first..].iter().zip(wide.values()) {
                for ((sum, u), extra) in state.iter_mut().zip(&node.inner).zip(&node.extra) {
                    sum.add_scaled(u, extra, *w);
                }
            }
            let (beam, peak) = self.sampling.peak(model, &stress, &state, &mut scratch);
            out.stress_pa.push(peak);
            out.stress_beam.push(beam);
        }
        worst
    }
}

/// Constants of all beams at the points of a rule, four to a group; the last group is filled up with quarter circles that nothing moves.
fn prepare<const M: usize, const Q: usize>(model: &Model, tables: &Tables<M, Q>, groups: &mut Vec<Beams<Q>>) {
    groups.clear();
    let one = Lane::splat(1.0);
    for four in model.beams.chunks(LANES) {
        let quarter = tables.u.map(|u| maths::sin_cos(std::f64::consts::FRAC_PI_2 * u));
        let mut beams = Beams {
            length: one,
            bending: one,
            axial: Lane::ZERO,
            shear: Lane::ZERO,
            soft: false,
            cos: quarter.map(|(_, cos)| Lane::splat(cos)),
            sin: quarter.map(|(sin, _)| Lane::splat(sin)),
        };
        for (lane, beam) in four.iter().enumerate() {
            let c = &beam.constants;
            beams.length.0[lane] = c.length;
            beams.bending.0[lane] = c.bending;
            beams.axial.0[lane] = c.axial;
            beams.shear.0[lane] = c.shear;
            beams.soft |= c.axial > 0.0 || c.shear > 0.0;
            for q in 0..Q {
                let (sin, cos) = maths::sin_cos(beam.info.shape.angle_at(tables.u[q]));
                beams.cos[q].0[lane] = cos;
                beams.sin[q].0[lane] = sin;
            }
        }
        groups.push(beams);
    }
}

/// Linearises all beams at a state and solves the network.
fn linearise_all<const M: usize, const Q: usize>(
    tables: &Tables<M, Q>,
    groups: &[Beams<Q>],
    x: &[f64],
    inner: &mut [Unknowns<M>],
    condensed: &mut Vec<Condensed<M>>,
    net: &mut Net,
) -> Result<(), GiveUp> {
    condensed.resize_with(groups.len(), Condensed::default);
    net.clear();
    for (group, beams) in groups.iter().enumerate() {
        let (ends, apart) = net.ends(group, x);
        inner[group].ends = ends;
        linearise(tables, beams, &inner[group], apart, &mut condensed[group]).map_err(|_| GiveUp::Unsafe)?;
        net.add(group, &condensed[group]);
    }
    net.solve().map_err(|_| GiveUp::Unsafe)
}

/// Weighted size of a change of the network's unknowns.
fn size(net: &Net, change: &[f64], divisor: f64) -> f64 {
    change.iter().zip(&net.weights).fold(0.0, |m: f64, (c, w)| {
        let here = (c * w / divisor).abs();
        // Keeps NaN.
        if here > m || here.is_nan() { here } else { m }
    })
}
