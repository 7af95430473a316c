//! A tip that is pushed along the load and also moved across it: both forces over a map of places.

mod results;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::maths::hypot;
use forcewright_base::units::{Quantity, format_si};
use forcewright_beam::{Drive, Network, NetworkError, Path, Point, Rotation, Stage, Status, Support, trace};
use forcewright_contract::describe::{Located, Slot};
use forcewright_contract::family::Progress;

use super::keys;
use crate::design::Design;
use crate::layout::Layout;
use crate::loads::{Control, Loads};
use crate::spec::Spec;

pub(crate) use results::{curves, figures, fix, limits, missing, model, status, warnings};

/// Displacements δ of a map where the project names no number.
const PLACES: u32 = 11;
/// Displacements Δ of a map where the project names no number.
const LEVELS: u32 = 5;
/// Places nearer than this part of the travel are the same.
const SAME: f64 = 1e-9;

/// Where the tip is moved. SI, whole layout.
#[derive(Clone, Debug, PartialEq)]
pub struct Lateral {
    /// Least and largest displacement δ across the load, m; δ counts along the load's direction turned by 90° counter-clockwise.
    pub travel_m: [f64; 2],
    /// The part of it that metrics look at, m.
    pub window_m: [f64; 2],
    /// Least and largest displacement Δ along the load, m.
    pub axial_m: [f64; 2],
    /// Number of displacements δ in equal steps over the travel; the ends of the window are further ones.
    pub places: u32,
    /// Number of displacements Δ in equal steps.
    pub levels: u32,
}

impl Lateral {
    /// All δ, ascending, m: equal steps over the travel, and the ends of the window.
    fn places_m(&self) -> Vec<f64> {
        let mut all = steps(self.travel_m, self.places);
        let same = SAME * (self.travel_m[1] - self.travel_m[0]);
        for end in self.window_m {
            match all.iter_mut().find(|x| (**x - end).abs() <= same) {
                Some(place) => *place = end,
                None => all.push(end),
            }
        }
        all.sort_by(f64::total_cmp);
        all
    }
}

/// Equal steps from one value to another, both included. What is zero but for rounding is zero.
fn steps([from, to]: [f64; 2], count: u32) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1);
    let step = |i: u32| if i == last { to } else { from + (to - from) * f64::from(i) / f64::from(last) };
    (0..=last).map(step).map(|x| if x.abs() < SAME * (to - from) { 0.0 } else { x }).collect()
}

/// What acts on the tip at a place, whole layout. SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipState {
    /// Force on the tip along the load, N.
    pub axial_n: f64,
    /// Force on the tip across the load, N, positive along positive δ.
    pub lateral_n: f64,
    /// Rotation of the tip, rad, counter-clockwise.
    pub rotation_rad: f64,
    /// Largest stress of all beams, Pa.
    pub stress_pa: f64,
    /// The beam whose stress is nearest to what is allowed in it, or largest where nothing is known of that, and its largest stress, Pa.
    pub loaded: (usize, f64),
    /// Elastic energy, J.
    pub energy_j: f64,
}

/// Why states of a row are missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shortfall {
    /// The unloaded tip does not come so far across the load.
    Across(Status),
    /// Moved across, the tip is not pushed so far along the load.
    Along {
        /// The last Δ that was reached, m; `None` where it is none of the map.
        reached_m: Option<f64>,
        /// How the path ended.
        status: Status,
    },
    /// States are unstable although both displacements are held.
    Branches {
        /// The last Δ before, m; `None` where it is none of the map.
        reached_m: Option<f64>,
    },
    /// The tip was moved across in another shape than nearer to the middle: on the way there the mechanism jumps.
    Jumps {
        /// The last δ of the shape that the map has, m.
        from_m: f64,
    },
}

impl Shortfall {
    /// Whether the rest was not computed, on request.
    fn on_request(self) -> bool {
        matches!(self, Self::Across(Status::Stopped { .. }) | Self::Along { status: Status::Stopped { .. }, .. })
    }
}

/// All Δ at one δ.
#[derive(Clone, Debug)]
pub struct Row {
    /// The displacement δ, m.
    pub lateral_m: f64,
    /// Whether metrics look at it.
    pub counts: bool,
    /// The states, by the index of [`LateralMap::axial_m`]; `None` where there is none.
    pub states: Vec<Option<TipState>>,
    /// Why not all are there.
    pub shortfall: Option<Shortfall>,
}

impl Row {
    /// Its place and its states, if all are there.
    fn whole(&self) -> Option<(f64, Vec<TipState>)> {
        Some((self.lateral_m, self.states.iter().copied().collect::<Option<_>>()?))
    }
}

/// Forces on the tip over displacements along and across the load.
#[derive(Clone, Debug)]
pub struct LateralMap {
    /// The displacements Δ, m, ascending.
    pub axial_m: Vec<f64>,
    /// One row per δ, ascending.
    pub rows: Vec<Row>,
    /// Whether the rest of it was not computed, on request.
    pub interrupted: bool,
}

/// What is measured on a map, over its window. SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Least and largest lateral force, N.
    pub lateral_n: [f64; 2],
    /// Mean lateral force, N.
    pub lateral_mean_n: f64,
    /// Largest magnitude of the lateral force, N.
    pub lateral_max_n: f64,
    /// (max − min)/|max + min| of the lateral force; `None` where it is as large to one side as to the other.
    pub lateral_spread: Option<f64>,
    /// Least and largest axial force, N.
    pub axial_n: [f64; 2],
    /// Mean axial force, N.
    pub axial_mean_n: f64,
    /// (max − min)/|max + min| of the axial force.
    pub axial_spread: Option<f64>,
    /// The same at one Δ, for the Δ where it is largest.
    pub axial_coupling: Option<f64>,
    /// Largest stress, Pa.
    pub stress_pa: f64,
    /// Largest rotation of the tip, rad.
    pub rotation_rad: f64,
}

/// Rows whose energies differ by what the lateral force does on the way between them, but for this part of what the whole force would do,
/// are of one shape.
const LINKED: f64 = 0.02;
/// How often the way between two rows is halved to see whether they are.
const HALVINGS: usize = 8;

/// A mean below this part of the largest value is rounding.
const ROUNDING: f64 = 1e-12;

/// Least and largest of some values; infinite, the wrong way round, without values.
fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

/// A middle smaller than this part of the variation is rounding.
const NO_MIDDLE: f64 = 1e-6;

/// (max − min)/|max + min|: half the variation over the middle; beyond 1 where the sign changes, `None` where the middle is zero.
fn spread(values: impl Iterator<Item = f64>) -> Option<f64> {
    let [low, high] = extent(values);
    ((high + low).abs() > NO_MIDDLE * (high - low)).then(|| (high - low) / (high + low).abs())
}

/// Weights of the trapezoidal rule for a mean.
fn weights(x: &[f64]) -> Vec<f64> {
    let whole = x.last().zip(x.first()).map_or(0.0, |(b, a)| b - a);
    let at = |i: usize| {
        let left = if i > 0 { x[i] - x[i - 1] } else { 0.0 };
        let right = x.get(i + 1).map_or(0.0, |next| next - x[i]);
        0.5 * (left + right) / whole
    };
    (0..x.len()).map(at).collect()
}

impl LateralMap {
    /// Solves the map of a design: per δ one path, on which the tip is first moved across the load, free along it, and then pushed along it.
    ///
    /// Mechanisms are elastic: where the states of a region are stable with both displacements held, and of one sheet, its forces do not
    /// depend on the order in which its places are reached. Rows of another sheet than that in the middle are dropped.
    ///
    /// # Errors
    /// [`NetworkError`] if the network makes no sense.
    pub fn of(design: &Design, lateral: &Lateral, progress: Progress<'_>) -> Result<Self, NetworkError> {
        let axial_m = steps(lateral.axial_m, lateral.levels);
        let places = lateral.places_m();
        let same = SAME * (lateral.travel_m[1] - lateral.travel_m[0]);
        let mut map = Self { axial_m, rows: Vec::with_capacity(places.len()), interrupted: false };
        for (index, lateral_m) in places.iter().enumerate() {
            let done = index as f64 / places.len() as f64;
            let mut part = |fraction: f64| progress(done + fraction / places.len() as f64);
            let counts = *lateral_m >= lateral.window_m[0] - same && *lateral_m <= lateral.window_m[1] + same;
            let (states, shortfall) = Carried { design, lateral_m: *lateral_m }.row(&map.axial_m, &mut part)?;
            map.rows.push(Row { lateral_m: *lateral_m, counts, states, shortfall });
            if shortfall.is_some_and(Shortfall::on_request) {
                map.interrupted = true;
                break;
            }
        }
        if !map.interrupted {
            map.end_at_jumps(design, progress)?;
        }
        Ok(map)
    }

    /// Drops rows of another shape than that in the middle. Each row is followed from rest along its own way; that neighbours lie on one
    /// sheet of states shows in their energies.
    fn end_at_jumps(&mut self, design: &Design, progress: Progress<'_>) -> Result<(), NetworkError> {
        let middle = (0..self.rows.len()).min_by(|a, b| self.rows[*a].lateral_m.abs().total_cmp(&self.rows[*b].lateral_m.abs()));
        let Some(middle) = middle else { return Ok(()) };
        let ways: [Vec<usize>; 2] = [(middle..self.rows.len()).collect(), (0..=middle).rev().collect()];
        for way in ways {
            let mut jumped: Option<f64> = None;
            for pair in way.windows(2) {
                let (near, far) = (&self.rows[pair[0]], &self.rows[pair[1]]);
                if jumped.is_none()
                    && let (Some(from), Some(to)) = (near.whole(), far.whole())
                {
                    let Some(linked) = self.linked(design, [&from, &to], HALVINGS, progress)? else {
                        self.interrupted = true;
                        return Ok(());
                    };
                    jumped = (!linked).then_some(near.lateral_m);
                }
                if let Some(from_m) = jumped {
                    let far = &mut self.rows[pair[1]];
                    far.states.fill(None);
                    far.shortfall = far.shortfall.or(Some(Shortfall::Jumps { from_m }));
                }
            }
        }
        Ok(())
    }

    /// Whether two complete rows, a place and its states each, are of one sheet; `None` if that was not found out, on request.
    fn linked(
        &self,
        design: &Design,
        [from, to]: [&(f64, Vec<TipState>); 2],
        halvings: usize,
        progress: Progress<'_>,
    ) -> Result<Option<bool>, NetworkError> {
        let way_m = to.0 - from.0;
        let near = |(a, b): (&TipState, &TipState)| {
            let left_j = b.energy_j - a.energy_j - 0.5 * way_m * (a.lateral_n + b.lateral_n);
            let force_n = hypot(a.axial_n, a.lateral_n).max(hypot(b.axial_n, b.lateral_n));
            left_j.abs() <= LINKED * way_m.abs() * force_n
        };
        if from.1.iter().zip(&to.1).all(near) {
            return Ok(Some(true));
        }
        let Some(fewer) = halvings.checked_sub(1) else { return Ok(Some(false)) };
        let lateral_m = 0.5 * (from.0 + to.0);
        let (states, shortfall) = Carried { design, lateral_m }.row(&self.axial_m, &mut |_| progress(1.0))?;
        if shortfall.is_some_and(Shortfall::on_request) {
            return Ok(None);
        }
        let Some(states) = states.into_iter().collect::<Option<Vec<TipState>>>() else { return Ok(Some(false)) };
        let middle = (lateral_m, states);
        match self.linked(design, [from, &middle], fewer, progress)? {
            Some(true) => self.linked(design, [&middle, to], fewer, progress),
            other => Ok(other),
        }
    }

    /// How many rows the map of a motion has.
    pub fn places(lateral: &Lateral) -> usize {
        lateral.places_m().len()
    }

    /// The first row with missing states, of those that count if there is one.
    pub fn shortfall(&self) -> Option<&Row> {
        let fails = |row: &&Row| row.shortfall.is_some();
        self.rows.iter().filter(|row| row.counts).find(fails).or_else(|| self.rows.iter().find(fails))
    }

    /// The state in which a beam is nearest to what is allowed in it: its place (Δ, δ), m, the beam, its stress, Pa, and that over what
    /// `allowed` says, Pa. Of all rows, whether metrics look at them or not; `None` where nothing is allowed or known.
    pub fn worst_stress(&self, allowed: impl Fn(usize) -> Option<f64>) -> Option<([f64; 2], usize, f64, f64)> {
        let of = |row: &Row, level: usize, state: &TipState| {
            let (beam, stress_pa) = state.loaded;
            Some(([*self.axial_m.get(level)?, row.lateral_m], beam, stress_pa, stress_pa / allowed(beam)?))
        };
        let states = self.rows.iter().flat_map(|row| row.states.iter().enumerate().map(move |(level, state)| (row, level, state)));
        let all = states.filter_map(|(row, level, state)| of(row, level, state.as_ref()?));
        // The first of equals, for the same answer everywhere.
        all.reduce(|best, next| if next.3 > best.3 { next } else { best })
    }

    /// What is measured over the window; `None` where a state of it is missing.
    pub fn summary(&self) -> Option<Summary> {
        if self.interrupted {
            return None;
        }
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.counts).collect();
        let states: Vec<Vec<TipState>> = rows.iter().map(|row| row.states.iter().copied().collect()).collect::<Option<_>>()?;
        let across = weights(&rows.iter().map(|row| row.lateral_m).collect::<Vec<_>>());
        let along = weights(&self.axial_m);
        let mean = |force: fn(&TipState) -> f64| -> f64 {
            let of_row = |row: &Vec<TipState>| row.iter().zip(&along).map(|(s, w)| w * force(s)).sum::<f64>();
            states.iter().zip(&across).map(|(row, w)| w * of_row(row)).sum()
        };
        let all = || states.iter().flatten();
        let largest_n = extent(all().map(|s| s.lateral_n.abs()))[1];
        // What is left of a sum of opposite forces is rounding.
        let lateral_mean_n = Some(mean(|s| s.lateral_n)).filter(|f| f.abs() > ROUNDING * largest_n).unwrap_or(0.0);
        let at_level = |level: usize| spread(states.iter().filter_map(|row| row.get(level)).map(|s| s.axial_n));
        Some(Summary {
            lateral_n: extent(all().map(|s| s.lateral_n)),
            lateral_mean_n,
            lateral_max_n: largest_n,
            lateral_spread: spread(all().map(|s| s.lateral_n)),
            axial_n: extent(all().map(|s| s.axial_n)),
            axial_mean_n: mean(|s| s.axial_n),
            axial_spread: spread(all().map(|s| s.axial_n)),
            axial_coupling: (0..self.axial_m.len()).map(at_level).try_fold(0.0, |most: f64, s| Some(most.max(s?))),
            stress_pa: extent(all().map(|s| s.stress_pa))[1],
            rotation_rad: extent(all().map(|s| s.rotation_rad.abs()))[1],
        })
    }
}

/// The direction in which δ counts: that of the load turned by 90° counter-clockwise.
fn across([x, y]: [f64; 2]) -> [f64; 2] {
    [-y, x]
}

/// A tip that has been moved across the load.
struct Carried<'a> {
    design: &'a Design,
    lateral_m: f64,
}

type States = Vec<Option<TipState>>;

impl Carried<'_> {
    /// The states at displacements Δ, m, of the whole layout, and why some are missing.
    fn row(&self, axial_m: &[f64], progress: Progress<'_>) -> Result<(States, Option<Shortfall>), NetworkError> {
        let mut states = vec![None; axial_m.len()];
        let settings = self.design.settings();
        let start = trace(&self.network(1.0), &[0.0], &settings, progress)?;
        let Some(unloaded) = start.points.first() else { return Ok((states, Some(Shortfall::Across(start.status)))) };
        if start.before.iter().chain([unloaded]).any(|p| p.instability > 0) || !start.bifurcations.is_empty() {
            return Ok((states, Some(Shortfall::Branches { reached_m: None })));
        }
        // Moved across, the free tip has also moved along the load: its travel counts from there, in either sense.
        let moved_m = dot(unloaded.nodes[self.design.load_node].displacement_m, self.design.direction);
        let mut shortfall = None;
        for sense in [1.0, -1.0] {
            let ways: Vec<(usize, f64)> = axial_m.iter().enumerate().map(|(i, x)| (i, sense * (x - moved_m))).collect();
            let mut ways: Vec<(usize, f64)> =
                ways.into_iter().filter(|(_, way)| if sense > 0.0 { *way >= 0.0 } else { *way > 0.0 }).collect();
            ways.sort_by(|a, b| a.1.total_cmp(&b.1));
            if ways.is_empty() {
                continue;
            }
            let stations: Vec<f64> = ways.iter().map(|w| w.1).collect();
            let path = trace(&self.network(sense), &stations, &settings, progress)?;
            let sound = sound(&path);
            for ((level, _), point) in ways.iter().zip(path.points.iter().take(sound)) {
                states[*level] = Some(self.state(point));
            }
            if sound < ways.len() {
                let reached_m = sound.checked_sub(1).map(|last| axial_m[ways[last].0]);
                let branches = sound < path.points.len() || !path.bifurcations.is_empty();
                let why = if branches { Shortfall::Branches { reached_m } } else { Shortfall::Along { reached_m, status: path.status } };
                shortfall = shortfall.or(Some(why));
            }
        }
        Ok((states, shortfall))
    }

    /// The network with the guide of the tip taken along: both motions of the load node are prescribed.
    fn network(&self, sense: f64) -> Network {
        let Design { network, load_node: node, direction, .. } = self.design;
        let mut moved = network.clone();
        if let Some(tip) = moved.nodes.get_mut(*node) {
            tip.support = match tip.support {
                Support::Slider { rotation: Rotation::Free, .. } => Support::Free,
                _ => Support::Parallel,
            };
        }
        moved.before = vec![Stage { drive: Drive::Displacement { node: *node, direction: across(*direction) }, to: self.lateral_m }];
        moved.drive = Drive::Displacement { node: *node, direction: direction.map(|d| sense * d) };
        moved
    }

    fn state(&self, point: &Point) -> TipState {
        let Design { load_node, direction, .. } = self.design;
        let (tip, copies) = (point.nodes[*load_node], self.design.copies());
        TipState {
            axial_n: copies * dot(tip.force_n, *direction),
            lateral_n: copies * dot(tip.force_n, across(*direction)),
            rotation_rad: tip.rotation_rad,
            stress_pa: point.peak_stress().map_or(0.0, |(_, s)| s.stress_pa),
            loaded: self.loaded(point),
            energy_j: copies * point.energy_j,
        }
    }
}

impl Carried<'_> {
    /// The beam that is nearest to what is allowed in it, and its stress.
    fn loaded(&self, point: &Point) -> (usize, f64) {
        let stresses = point.beams.iter().map(|beam| beam.peak_stress().stress_pa).enumerate();
        let part = |(beam, stress): &(usize, f64)| stress / self.design.allowable_pa(*beam).unwrap_or(f64::MAX);
        // The first of equals, for the same answer everywhere.
        stresses.reduce(|best, next| if part(&next) > part(&best) { next } else { best }).unwrap_or_default()
    }
}

/// How many points of a path come before it branches.
fn sound(path: &Path) -> usize {
    let branch = path.bifurcations.first().map_or(f64::INFINITY, |b| if b.stage == 0 { -1.0 } else { b.control });
    path.points.iter().take_while(|p| p.instability == 0 && p.control <= branch).count()
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The lateral motion of a project, if it has one. Faults are reported.
pub(crate) fn resolve(spec: &Spec, network: &Network, loads: &Loads, layout: &Layout, diagnostics: &mut Diagnostics) -> Option<Lateral> {
    let typed = &spec.scenario.lateral;
    let place = typed.present.as_ref()?.span;
    check_held(network, loads, layout, place, diagnostics);
    let si = |slot: &Slot<[Quantity; 2]>| slot.as_ref().map(|s| [s.value[0].si, s.value[1].si]);
    let (travel_m, axial_m) = (si(&typed.travel)?, si(&typed.axial)?);
    let window_m = si(&typed.window).unwrap_or(travel_m);
    let shown = &typed.travel.as_ref()?.value;
    ascends(typed.travel.as_ref(), diagnostics);
    ascends(typed.window.as_ref(), diagnostics);
    ascends(typed.axial.as_ref(), diagnostics);
    let within = |[low, high]: [f64; 2], inner: [f64; 2]| inner[0] >= low && inner[1] <= high;
    if let Some(window) = typed.window.as_ref().filter(|_| !within(travel_m, window_m)) {
        let [low, high] = travel_m.map(|x| format_si(x, &shown[0].unit, 6));
        let help = format!("the window is a part of `travel`, from {low} to {high}");
        diagnostics
            .push(Diagnostic::error("E0204", window.span, "the window goes beyond the lateral travel").label("this window").help(help));
    }
    let reach_m = layout.layers() * loads.end;
    if let Some(axial) = typed.axial.as_ref().filter(|_| loads.control == Control::Travel && !within([0.0, reach_m], axial_m)) {
        let end = format_si(reach_m, &axial.value[0].unit, 6);
        let help = format!("from 0 to the travel of the load, {end}");
        diagnostics.push(
            Diagnostic::error("E0204", axial.span, "the map goes beyond the travel of the load").label("these displacements").help(help),
        );
    }
    let count = |slot: &Slot<u32>, default| slot.as_ref().map_or(default, |s| s.value);
    Some(Lateral { travel_m, window_m, axial_m, places: count(&typed.places, PLACES), levels: count(&typed.levels, LEVELS) })
}

fn ascends(range: Option<&Located<[Quantity; 2]>>, diagnostics: &mut Diagnostics) {
    let Some(range) = range.filter(|r| r.value[1].si - r.value[0].si < keys::SHORTEST_M) else { return };
    diagnostics.push(
        Diagnostic::error("E0204", range.span, "a range that does not ascend")
            .label("from, to")
            .help("give the smaller of two displacements first"),
    );
}

/// The scenario moves the guide of the tip, of one layout whose copies all go the same way.
fn check_held(network: &Network, loads: &Loads, layout: &Layout, place: Span, diagnostics: &mut Diagnostics) {
    let mut refuse = |message: &str, help: &str| {
        diagnostics.push(Diagnostic::error("E0521", place, message).label("this scenario").help(help));
    };
    if loads.control != Control::Travel || !loads.before.is_empty() {
        refuse("a lateral motion needs one load that prescribes a displacement", "give `travel` instead of `force`, and no load before it");
        return;
    }
    let [dx, dy] = loads.direction;
    let guided = network
        .nodes
        .get(loads.drive.node())
        .is_some_and(|n| matches!(n.support, Support::Slider { direction: [x, y], .. } if (x * dy - y * dx).abs() < 1e-9));
    if !guided {
        refuse(
            "a lateral motion takes along the guide of the tip; the load node has none along the load",
            "hold the load node by `support = \"slider\"` along the load, with `rotation = \"free\"` where nothing keeps its angle",
        );
    }
    if layout.mirror.is_some() || layout.circle.is_some() || layout.layers > 1 {
        refuse(
            "moved across the load, the copies of this layout do not go the same way",
            "draw the whole mechanism instead of `mirror`, `circular` or `series`; `plates` and `array` may stay",
        );
    }
}
