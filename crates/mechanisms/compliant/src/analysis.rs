//! From a design to its behaviour: the equilibrium path, the force curve, the stress, the metrics.

use std::borrow::Cow;

use forcewright_base::units::Unit;
use forcewright_beam::{Beam, Follow, Jump, NetworkError, Path, PeakStress, Point, Settings, Status, trace};
use forcewright_contract::family::Progress;

use crate::design::Design;
use crate::force_curve::{Extrema, ForceCurve, Interval, Turn};
use crate::metrics::METRICS;
use crate::room::{Margin, Nearest, gap_around_m, margin, nearest};
use crate::scenario::{LateralMap, SurfaceRun};
use crate::stack::Stack;
use crate::sway::Sway;

/// Stations of the first attempt, and the most that are tried to keep the interpolation between them below its share of the error.
const STATIONS: [usize; 4] = [128, 256, 512, 1024];
/// Interpolation error accepted, relative to the largest force.
const INTERPOLATION: f64 = 1e-7;
/// Parts of the distance of two stations in which a change of the tangent's sign is looked for.
const TURN_PARTS: u32 = 8;
/// The paper's operational range starts where the force reaches this fraction of its end value (section II).
pub(crate) const RANGE_FRACTION: f64 = 0.95;

/// What a design does. SI; displacements, forces and energies are those of the whole layout, but for those of the path.
#[derive(Clone, Debug)]
pub struct Behaviour {
    /// The path of the drawn network: [`Self::delta_m`] and [`Self::force_n`] say what its states are for the whole layout.
    pub path: Path,
    /// Force over displacement of the whole layout, if at least two stations were reached.
    pub curve: Option<ForceCurve>,
    /// Copies of the drawn network that share the force.
    pub copies: f64,
    /// Layers that share the displacement.
    pub layers: f64,
    /// Whether the whole travel was reached.
    pub whole: bool,
    /// Where the states become unstable although the displacement is held, m: a real part leaves the computed path there.
    pub unstable_from_m: Option<f64>,
    /// The first load before the last one on whose way a real part leaves the computed path, counted from 0, and the part of the load.
    pub branching_load: Option<(usize, f64)>,
    /// Interpolation error of the curve relative to the largest force.
    pub interpolation_error: f64,
    /// What a slowly driven device does where the path ends at a limit point; `None` where it does not, or where that is not known.
    pub snap: Option<Snap>,
    /// What layers in series do, where there are any.
    pub stack: Option<Stack>,
    /// How the whole layout resists sideways, where symmetry separates that from the motion along the load.
    pub sway: Option<Sway>,
    /// Forces on the tip where it also moves across the load, if the project has such a motion.
    pub lateral: Option<LateralMap>,
}

/// What a slowly driven device does at the limit point at which its path ends. SI, of the drawn network.
#[derive(Clone, Copy, Debug)]
pub enum Snap {
    /// It jumps to a later stretch of the path.
    Lands(Jump),
    /// Up to the end of the load there is nothing on this path to land on.
    Nowhere,
}

/// The largest stress of a path and where it is.
#[derive(Clone, Copy, Debug)]
pub struct LargestStress {
    /// Displacement, m.
    pub at_m: f64,
    /// Index of the beam.
    pub beam: usize,
    /// The stress.
    pub peak: PeakStress,
}

impl Behaviour {
    /// Solves a design.
    ///
    /// # Errors
    /// [`NetworkError`] if the network makes no sense; a design that was resolved has been checked.
    pub fn of(design: &Design, progress: Progress<'_>) -> Result<Self, NetworkError> {
        let settings = design.settings();
        let mut result = None;
        // A map is a path per place.
        let share = design.lateral.as_ref().map_or(1.0, |lateral| 1.0 / (1.0 + LateralMap::places(lateral) as f64));
        // A second attempt begins anew, but progress never goes back.
        let mut furthest = 0.0_f64;
        let mut progress = |fraction: f64| {
            furthest = furthest.max(fraction);
            progress(furthest)
        };
        for count in STATIONS {
            let stations: Vec<f64> = (0..=count).map(|i| design.load_end * i as f64 / count as f64).collect();
            let path = trace(&design.network, &stations, &settings, &mut |f| progress(share * f))?;
            let behaviour = Self::from_path(path, design);
            let enough = behaviour.interpolation_error <= INTERPOLATION || !behaviour.whole;
            result = Some(behaviour);
            if enough {
                break;
            }
        }
        let mut behaviour = result.ok_or(NetworkError::NoBeams)?;
        // Of layers in series one would jump before the others.
        let alone = design.layout.layers == 1;
        if alone && matches!(behaviour.path.status, Status::NoEquilibriumBeyond { .. }) && !behaviour.path.points.is_empty() {
            behaviour.snap = snap(design, &settings, &mut |f| progress(share * f))?;
        }
        behaviour.sway = Sway::of(design, &behaviour.path);
        let mut rest = |f: f64| progress(share + (1.0 - share) * f);
        behaviour.lateral = design.lateral.as_ref().map(|lateral| LateralMap::of(design, lateral, &mut rest)).transpose()?;
        behaviour.stack = behaviour.curve.as_ref().filter(|_| design.layout.layers > 1).map(|c| Stack::of(c, design.layout.layers));
        Ok(behaviour)
    }

    fn from_path(path: Path, design: &Design) -> Self {
        let (copies, layers) = (design.copies(), design.layers());
        let unstable = path.points.iter().find(|p| p.instability > 0);
        let unstable_from_m = unstable
            .map(|p| layers * first_branch(&path, path.before.len()).map_or(p.displacement, |b| b.displacement.min(p.displacement)));
        let branching_load = (0..path.before.len()).find_map(|stage| {
            let reached = path.before[stage].control.abs();
            let branch = first_branch(&path, stage).map(|b| b.control.abs() / reached);
            branch.or((path.before[stage].instability > 0).then_some(1.0)).map(|part| (stage, part))
        });
        let whole = matches!(path.status, Status::Complete | Status::NotResolved { .. });
        let curve = force_curve(&path.points, [copies, layers]);
        let largest = path.points.iter().map(|p| copies * p.force.abs()).fold(0.0, f64::max);
        let interpolation_error = curve.as_ref().map_or(0.0, |c| if largest > 0.0 { c.error_n() / largest } else { 0.0 });
        Self {
            path,
            curve,
            copies,
            layers,
            whole,
            unstable_from_m,
            branching_load,
            interpolation_error,
            snap: None,
            stack: None,
            sway: None,
            lateral: None,
        }
    }

    /// The part of it that a real part follows: all, or what lies before the path branches, which is then not the whole travel. Metrics
    /// and checks are those of this part.
    pub fn trusted(&self, design: &Design) -> Cow<'_, Self> {
        let before = |p: &&Point| p.instability == 0 && self.unstable_from_m.is_none_or(|from| self.delta_m(p) <= from);
        let count = if self.branching_load.is_some() { 0 } else { self.path.points.iter().take_while(before).count() };
        if count == self.path.points.len() {
            return Cow::Borrowed(self);
        }
        let mut path = self.path.clone();
        path.points.truncate(count);
        let sway = Sway::of(design, &path);
        Cow::Owned(Self { whole: false, curve: force_curve(&path.points, [self.copies, self.layers]), path, sway, ..self.clone() })
    }

    /// Displacement of the whole layout in a state of the drawn network, m.
    pub fn delta_m(&self, point: &Point) -> f64 {
        self.layers * point.displacement
    }

    /// Force of the whole layout, N.
    pub fn force_n(&self, point: &Point) -> f64 {
        self.copies * point.force
    }

    /// Stiffness of the whole layout, N/m.
    pub fn stiffness_n_per_m(&self, point: &Point) -> f64 {
        self.copies / self.layers * point.stiffness
    }

    /// Elastic energy of the whole layout, J.
    pub fn energy_j(&self, point: &Point) -> f64 {
        self.copies * self.layers * point.energy_j
    }

    /// The largest stress up to the end of the path.
    pub fn largest_stress(&self) -> Option<LargestStress> {
        self.worst_stress(|_| 1.0)
    }

    /// The largest stress relative to a strength that each beam has, Pa, refined between stations where it is largest inside. Beams of
    /// infinite strength are left out.
    pub fn worst_stress(&self, strength_pa: impl Fn(usize) -> f64) -> Option<LargestStress> {
        let load = |s: &LargestStress| s.peak.stress_pa / strength_pa(s.beam);
        let of = |point: &Point| {
            let all = point.beams.iter().enumerate().filter(|(beam, _)| strength_pa(*beam).is_finite());
            let all = all.map(|(beam, state)| LargestStress { at_m: self.delta_m(point), beam, peak: state.peak_stress() });
            // The first of equals, for the same answer everywhere.
            all.reduce(|best, next| if load(&next) > load(&best) { next } else { best })
        };
        let points = &self.path.points;
        let stations: Vec<LargestStress> = points.iter().filter_map(of).collect();
        let falling: Vec<f64> = stations.iter().map(|s| -load(s)).collect();
        let best = (0..stations.len()).reduce(|b, i| if falling[i] < falling[b] { i } else { b })?;
        if !may_be_inside(&falling, best) {
            return stations.get(best).copied();
        }
        let value = |x: f64| self.path.at(x).ok().and_then(|p| of(&p));
        let (left, right) = (points[best.saturating_sub(1)].control, points[(best + 1).min(points.len() - 1)].control);
        let found = forcewright_base::roots::minimise(|x| value(x).map_or(f64::NAN, |s| -load(&s)), left, right, 1e-6 * right);
        value(found.x).filter(|s| load(s) > -falling[best]).or(stations.get(best).copied())
    }

    /// The displacement at which the first beam reaches its strength, Pa, which may be infinite, m.
    pub fn travel_at_stress(&self, strength_pa: impl Fn(usize) -> f64) -> Option<f64> {
        let excess = |p: &Point| {
            let all = p.beams.iter().enumerate().map(|(beam, state)| state.peak_stress().stress_pa - strength_pa(beam));
            all.reduce(|a, b| if b > a { b } else { a }).unwrap_or(f64::NAN)
        };
        let first = self.path.points.iter().position(|p| excess(p) >= 0.0)?;
        let (before, after) = (self.path.points.get(first.checked_sub(1)?)?, &self.path.points[first]);
        let at = |x: f64| self.path.at(x).map_or(f64::NAN, |p| excess(&p));
        let found = forcewright_base::roots::root(at, before.control, after.control, 1e-12 * after.control).ok()?;
        self.displacement_at(found)
    }

    /// The displacement at a value of the control, m.
    fn displacement_at(&self, control: f64) -> Option<f64> {
        self.path.at(control).ok().map(|p| self.delta_m(&p))
    }

    /// Least tangent stiffness of the whole layout over the path, N/m, and where, m.
    pub fn least_stiffness(&self) -> Option<(f64, f64)> {
        self.extreme_stiffness(1.0)
    }

    /// Largest tangent stiffness of the whole layout over the path, N/m, and where, m.
    pub fn largest_stiffness(&self) -> Option<(f64, f64)> {
        self.extreme_stiffness(-1.0).map(|(value, at)| (-value, at))
    }

    /// Least value of the stiffness times `sign`, N/m, refined between stations, and where, m.
    fn extreme_stiffness(&self, sign: f64) -> Option<(f64, f64)> {
        let points = &self.path.points;
        let values: Vec<f64> = points.iter().map(|p| sign * self.stiffness_n_per_m(p)).collect();
        let best = (0..values.len()).reduce(|b, i| if values[i] < values[b] { i } else { b })?;
        let station = (values[best], self.delta_m(&points[best]));
        if !may_be_inside(&values, best) {
            return Some(station);
        }
        let value = |x: f64| self.path.at(x).map_or(f64::NAN, |p| sign * self.stiffness_n_per_m(&p));
        let (left, right) = (best.saturating_sub(1), (best + 1).min(points.len() - 1));
        let right = points[right].control;
        let found = forcewright_base::roots::minimise(value, points[left].control, right, 1e-6 * right);
        let inside = self.displacement_at(found.x).filter(|_| found.value < station.0);
        Some(inside.map_or(station, |at| (found.value, at)))
    }

    /// First local maximum of the force and first minimum after it, found on the curve and placed where the tangent vanishes: next to a
    /// limit point the force turns too quickly to be read between stations, and where it soars the curve between them overshoots.
    pub fn extrema(&self) -> Extrema {
        let turns = self.curve.as_ref().map_or_else(Vec::new, ForceCurve::turns);
        let max = turns.iter().filter(|t| t.is_max).find_map(|t| self.placed(t));
        let after = |from: f64| move |t: &&Turn| !t.is_max && t.at > from;
        let min = max.and_then(|(from, _)| turns.iter().filter(after(from)).find_map(|t| self.placed(t)));
        Extrema { max, min }
    }

    /// Displacement and force of the extremum near one that was read off the curve, if the tangent changes its sign there.
    fn placed(&self, read: &Turn) -> Option<(f64, f64)> {
        let points = &self.path.points;
        let after = points.partition_point(|p| self.delta_m(p) <= read.at).clamp(1, points.len() - 1);
        let (left, right) = (points[after - 1].control, points[after].control);
        let sign = if read.is_max { 1.0 } else { -1.0 };
        let stiffness = |x: f64| self.path.at(x).map_or(f64::NAN, |p| sign * p.stiffness);
        let turns = |[a, b]: [f64; 2]| a >= 0.0 && b < 0.0;
        // Both stations say it, or the curve turns twice between them.
        let (from, to) = if turns([after - 1, after].map(|i| sign * points[i].stiffness)) {
            (left, right)
        } else {
            let place = |i: u32| left + (right - left) * f64::from(i) / f64::from(TURN_PARTS);
            let values: Vec<f64> = (0..=TURN_PARTS).map(|i| stiffness(place(i))).collect();
            let part = (0..TURN_PARTS).zip(values.windows(2)).find(|(_, v)| turns([v[0], v[1]]))?.0;
            (place(part), place(part + 1))
        };
        let exact = forcewright_base::roots::root(stiffness, from, to, 1e-14 * right).ok()?;
        self.path.at(exact).ok().map(|p| (self.delta_m(&p), self.force_n(&p)))
    }

    /// Where a force-driven device would jump: from the first local maximum, to the displacement beyond it that carries the same force
    /// again, if the path reaches it.
    pub fn jump(&self) -> Option<(f64, Option<f64>)> {
        let curve = self.curve.as_ref()?;
        let Extrema { max, min } = self.extrema();
        let (from, level) = max?;
        // The force falls first: the same level is passed again only beyond the minimum.
        let to = min.and_then(|(dip, _)| curve.crossings(level).into_iter().find(|x| *x > dip));
        Some((from, to))
    }
}

/// The force of the whole layout over the displacement; `None` for fewer than two states, or where the displacement turns back, as it
/// may under a growing force.
fn force_curve(points: &[Point], [copies, layers]: [f64; 2]) -> Option<ForceCurve> {
    let pick = |f: fn(&Point) -> f64, scale: f64| points.iter().map(|p| scale * f(p)).collect::<Vec<_>>();
    let ascends = points.windows(2).all(|p| p[0].displacement < p[1].displacement);
    (points.len() >= 2 && ascends)
        .then(|| ForceCurve::new(pick(|p| p.displacement, layers), pick(|p| p.force, copies), pick(|p| p.stiffness, copies / layers)))
}

/// Stations at which the path is followed beyond its limit point.
const BEYOND: usize = 32;

/// Follows a path that ends at a limit point up to the end of the load, only to see what a device does there.
fn snap(design: &Design, settings: &Settings, progress: Progress<'_>) -> Result<Option<Snap>, NetworkError> {
    let settings = Settings { follow: Follow::ToEnd, accuracy: settings.accuracy.max(1e-6), ..*settings };
    let stations: Vec<f64> = (1..=BEYOND).map(|i| design.load_end * i as f64 / BEYOND as f64).collect();
    let path = trace(&design.network, &stations, &settings, progress)?;
    // A device that has left the path before the limit point does not come there.
    let Some(fold) = path.folds.first() else { return Ok(None) };
    if path.whole.iter().take(fold.index).any(|p| p.instability > 0) {
        return Ok(None);
    }
    // A landing is where the control is that of the limit point again: it lies within the load or nowhere on this path.
    Ok(match (path.jumps.first(), path.whole_status) {
        (Some(jump), _) => Some(Snap::Lands(*jump)),
        (None, Status::Complete | Status::NotResolved { .. } | Status::NoEquilibriumBeyond { .. }) => Some(Snap::Nowhere),
        _ => None,
    })
}

/// Where the states become unstable under one of the loads, if that is a branch and not a limit point.
fn first_branch(path: &Path, stage: usize) -> Option<&forcewright_beam::Bifurcation> {
    path.bifurcations.iter().find(|b| b.stage == stage && b.after > b.before)
}

/// Whether a value below that of the least station may lie beside it: between two neighbours, or next to an end where the parabola
/// through three stations falls inwards.
fn may_be_inside(values: &[f64], least: usize) -> bool {
    let n = values.len();
    let falls = |end: f64, next: f64, after: f64| -3.0 * end + 4.0 * next - after < 0.0;
    n >= 3 && (least > 0 || falls(values[0], values[1], values[2])) && (least + 1 < n || falls(values[n - 1], values[n - 2], values[n - 3]))
}

/// What is needed again for checks and pictures.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// Values by the index of [`METRICS`]; `None` where the metric has no value for this design.
    values: Vec<Option<f64>>,
    /// The longest interval within the required band, around the nominal force if one is given.
    pub usable: Option<Interval>,
    /// Largest stress and its place.
    pub stress: Option<LargestStress>,
    /// Largest stress relative to the yield stress of its beam, among the beams whose yield stress is known.
    pub loaded: Option<LargestStress>,
    /// Least stiffness and its displacement.
    pub stiffness: Option<(f64, f64)>,
    /// Smallest distance between beams.
    pub nearest: Option<Nearest>,
    /// Smallest distance to the envelope, where one is required.
    pub margin: Option<Margin>,
    /// What happens along the surface of the scenario, where there is one.
    pub surface: Option<SurfaceRun>,
}

impl Measured {
    /// A metric by name.
    pub fn get(&self, name: &str) -> Option<f64> {
        let index = METRICS.iter().position(|m| m.name == name)?;
        self.values.get(index).copied().flatten()
    }

    /// A metric by its index.
    pub fn value(&self, index: usize) -> Option<f64> {
        self.values.get(index).copied().flatten()
    }

    /// The way along a surface: it needs the curve as far as the surface is high, and layers that move alike.
    fn surface(&mut self, design: &Design, behaviour: &Behaviour, curve: &ForceCurve) {
        let apart_m = behaviour.stack.as_ref().and_then(|s| s.apart_from_m).unwrap_or(f64::INFINITY);
        let run = design.surface.as_ref().map(|surface| SurfaceRun::of(surface, curve, curve.end().min(apart_m)));
        let range = run.as_ref().and_then(SurfaceRun::axial_n);
        self.set("contact_force_max", range.map(|[_, most]| most));
        self.set("contact_force_min", range.map(|[least, _]| least));
        self.set("contact_force_mean", run.as_ref().and_then(SurfaceRun::mean_n));
        self.set("contact_force_spread", range.map(|[least, most]| (most - least) / (most + least)).filter(|s| s.is_finite()));
        self.set("transverse_force_max", run.as_ref().and_then(SurfaceRun::transverse_n));
        self.surface = run;
    }

    /// What happens on the map of axial and lateral displacements.
    fn lateral(&mut self, map: &LateralMap) {
        let Some(summary) = map.summary() else { return };
        self.set("lateral_force_mean", summary.lateral_mean_n);
        self.set("lateral_force_max", summary.lateral_max_n);
        self.set("lateral_force_spread", summary.lateral_spread);
        self.set("axial_force_mean", summary.axial_mean_n);
        self.set("axial_force_spread", summary.axial_spread);
        self.set("axial_force_coupling", summary.axial_coupling);
        self.set("tip_stress_max", summary.stress_pa);
        self.set("tip_rotation_max", summary.rotation_rad);
    }

    fn set(&mut self, name: &str, value: impl Into<Option<f64>>) {
        if let Some(index) = METRICS.iter().position(|m| m.name == name) {
            self.values[index] = value.into();
        }
    }
}

/// Band used for the flat interval where the project asks for none: the paper's 5 % (section II).
pub(crate) const PAPER_BAND: f64 = 0.05;

/// Every metric that the behaviour has; of [`Behaviour::trusted`], those that a real part has.
pub fn measure(design: &Design, behaviour: &Behaviour) -> Measured {
    let mut m = Measured { values: vec![None; METRICS.len()], ..Measured::default() };
    m.set("length_ratio_max", length_ratio(design));
    m.set("mass", mass_kg(design));
    if let Some(map) = &behaviour.lateral {
        m.lateral(map);
    }
    let Some(curve) = &behaviour.curve else { return m };
    m.set("stiffness_initial", behaviour.path.points.first().map(|p| behaviour.stiffness_n_per_m(p)));
    let Extrema { max, min } = behaviour.extrema();
    m.set("force_local_max", max.map(|(_, f)| f));
    m.set("force_local_max_at", max.map(|(x, _)| x));
    m.set("force_local_min", min.map(|(_, f)| f));
    m.set("force_local_min_at", min.map(|(x, _)| x));
    let beams = 0..design.network.beams.len();
    if beams.clone().all(|beam| design.allowable_pa(beam).is_some()) {
        m.set("travel_at_allowable_stress", behaviour.travel_at_stress(|beam| design.allowable_pa(beam).unwrap_or(f64::INFINITY)));
    }
    // Of a path that ends early these are only the values so far: checks use them, metrics do not.
    m.stiffness = behaviour.least_stiffness();
    m.stress = behaviour.largest_stress();
    let one_yield = design.materials.iter().all(|other| other.yield_pa.is_some() && other.yield_pa == design.yield_pa(0));
    m.loaded = if one_yield { m.stress } else { behaviour.worst_stress(|beam| design.yield_pa(beam).unwrap_or(f64::INFINITY)) };
    m.nearest = nearest(design, behaviour);
    m.margin = design.requirements.as_ref().and_then(|r| r.envelope).and_then(|envelope| margin(behaviour, &envelope));
    m.surface(design, behaviour, curve);
    // The rest is about the whole travel: a path that ends before has no such numbers.
    if !behaviour.whole {
        return m;
    }
    let (end, travel) = (curve.end(), curve.end() - curve.start());
    m.set("force_at_end", curve.force(end));
    m.set("energy_at_end", behaviour.path.points.last().map(|p| behaviour.energy_j(p)));
    let start = curve.range_start(RANGE_FRACTION);
    m.set("range_start", start);
    m.set("range_ratio", start.map(|c| (end - c) / travel));
    let force = design.requirements.as_ref().and_then(|r| r.force);
    let band = force.map_or(PAPER_BAND, |(band, _)| band);
    let flat = curve.longest_flat(band);
    m.set("flat_start", flat.map(|i| i.start));
    m.set("flat_end", flat.map(|i| i.end));
    m.set("flat_ratio", flat.map(|i| i.length() / travel));
    m.set(
        "flat_force",
        flat.map(|i| {
            let (hi, lo) = curve.extent(i);
            f64::midpoint(hi, lo)
        }),
    );
    m.usable = flat;
    if let Some((band, Some(nominal))) = force {
        let within = curve.longest_within(nominal * (1.0 - band), nominal * (1.0 + band));
        m.set("band_start", within.map(|i| i.start));
        m.set("band_end", within.map(|i| i.end));
        m.set("band_ratio", within.map_or(0.0, |i| i.length() / travel));
        m.usable = within;
    }
    m.set("stiffness_min", m.stiffness.map(|(k, _)| k));
    let between = m.nearest.map(|n| n.clearance.distance_m);
    m.set("clearance_min", [between, gap_around_m(design, behaviour)].into_iter().flatten().reduce(f64::min));
    m.set("envelope_margin", m.margin.map(|e| e.margin_m));
    m.set("lateral_stiffness_min", behaviour.sway.and_then(|s| s.least_n_per_m));
    m.set("stress_max", m.stress.map(|s| s.peak.stress_pa));
    m.set("stress_inner_face", inner_face_pa(design, behaviour, m.stress));
    if beams.clone().all(|beam| design.yield_pa(beam).is_some()) {
        m.set("safety_factor", m.loaded.and_then(|s| Some(design.yield_pa(s.beam)? / s.peak.stress_pa)).filter(|f| f.is_finite()));
    }
    m
}

/// Thickness over radius of a beam as made, at a place.
pub(crate) fn curvature_ratio(beam: &Beam, u: f64) -> f64 {
    beam.thickness_at(u) * beam.shape.slope_at(u).abs() / beam.shape.length_m()
}

/// The stress at the inner face of a curved bar of rectangular section over that of a straight one, to first order in thickness over
/// radius (Winkler's theory in `timoshenko1956`).
pub(crate) fn inner_face_factor(beam: &Beam, u: f64) -> f64 {
    1.0 + curvature_ratio(beam, u) / 3.0
}

/// Largest stress with that factor, Pa: of every beam at every state where its stress is largest, and of the largest of all.
fn inner_face_pa(design: &Design, behaviour: &Behaviour, largest: Option<LargestStress>) -> Option<f64> {
    let of = |index: usize, peak: PeakStress| Some(inner_face_factor(design.network.beams.get(index)?, peak.u) * peak.stress_pa);
    let states = behaviour.path.points.iter().flat_map(|p| p.beams.iter().enumerate());
    let all = states.filter_map(|(index, state)| of(index, state.peak_stress()));
    all.chain(largest.and_then(|s| of(s.beam, s.peak))).reduce(f64::max)
}

fn length_ratio(design: &Design) -> Option<f64> {
    let ratio = |b: &Beam| {
        let [x, y] = b.shape.chord_m();
        b.shape.length_m() / forcewright_base::maths::hypot(x, y)
    };
    design.network.beams.iter().map(ratio).reduce(f64::max)
}

/// Volume of a beam, m³: the thickness is linear between places.
pub(crate) fn volume_m3(beam: &Beam) -> f64 {
    if beam.profile.is_empty() {
        return beam.section.area_m2() * beam.shape.length_m();
    }
    let mean_m: f64 = beam.profile.windows(2).map(|p| (p[1][0] - p[0][0]) * f64::midpoint(p[0][1], p[1][1])).sum();
    mean_m * beam.section.depth_m * beam.shape.length_m()
}

/// Mass of all beams of the whole layout, kg, if every density is known.
pub(crate) fn mass_kg(design: &Design) -> Option<f64> {
    let beams = design.network.beams.iter().enumerate();
    let masses = beams.map(|(i, b)| Some(design.material_of(i)?.density_kg_per_m3? * volume_m3(b)));
    Some(design.copies() * design.layers() * masses.sum::<Option<f64>>()?)
}

/// The unit in which people are shown a metric.
pub(crate) fn display_unit(design: &Design, index: usize) -> Unit {
    use forcewright_base::units::Dimension as D;
    let Some(info) = METRICS.get(index) else { return Unit::si(D::Ratio) };
    let limit = design.requirements.iter().flat_map(|r| &r.limits).find(|l| l.metric == index).map(|l| l.unit.clone());
    let named = |symbol: &str| Unit::parse(symbol).unwrap_or_else(|_| Unit::si(info.dimension));
    limit.unwrap_or_else(|| match info.dimension {
        D::Length => design.units.displacement.clone(),
        D::Force => design.units.force.clone(),
        D::Stress => design.units.stress.clone(),
        D::Stiffness => design.units.stiffness.clone(),
        D::Energy => named("mJ"),
        D::Mass => named("g"),
        D::Angle => named("deg"),
        D::Ratio
            if info.name == "range_ratio"
                || info.name == "flat_ratio"
                || info.name == "band_ratio"
                || info.name.ends_with("_force_spread")
                || info.name == "axial_force_coupling" =>
        {
            named("%")
        }
        other => Unit::si(other),
    })
}
