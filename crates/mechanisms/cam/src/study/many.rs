//! A design for studies that look at many: forces both ways over the window, and what follows from the whole stroke.

use forcewright_base::units::Dimension;
use forcewright_study::differences::{self, Steps};
use forcewright_study::evaluator::{Evaluation, Evaluator, Failure, Measure, Output, Variable, Workspace};

use super::knobs::Knobs;
use crate::analysis::{Behaviour, Measured, measure_scalars, moments};
use crate::cut::SIDES;
use crate::design::{Design, Requirements};
use crate::law::ForceLaw;
use crate::metrics::{CamMetrics, METRICS};
use crate::motion::Motion;
use crate::path::SidePath;

/// Panels of the window, each with a station in its middle.
pub(crate) const PANELS: usize = 40;
/// Stations over the window.
pub(crate) const STATIONS: usize = 2 * PANELS + 1;

/// Step of a difference, over values that are right to rounding and some digits more.
pub(crate) const STEP: f64 = 1e-5;

/// The metric of the motion that is compared with a slower one.
const SLOWER: &str = "peak_force_ratio_to";

/// Metrics that follow from the forces over the window.
const OF_FORCES: [&str; 13] = [
    "force_deviation",
    "force_mean",
    "force_up_mean",
    "force_up_sd",
    "force_up_max",
    "force_up_min",
    "force_down_mean",
    "force_down_sd",
    "force_down_max",
    "force_down_min",
    "loop_area",
    "hysteresis",
    "force_spread",
];

/// See the module.
pub(super) struct Many {
    knobs: Knobs,
    base: Design,
    /// The paths on the cam, where it is the same for all.
    paths: Option<[SidePath; SIDES]>,
    window_m: [f64; 2],
    wanted: Option<ForceLaw>,
    /// Metrics that are values of their own, after the forces.
    scalars: Vec<&'static str>,
    /// Metrics of the forces that a search limits, by their places in [`OF_FORCES`]: values after those.
    held: Vec<usize>,
    outputs: Vec<Output>,
    measures: Vec<Measure>,
    steps: Steps,
}

struct Room {
    design: Design,
}

impl Many {
    pub(super) fn new(design: &Design, knobs: Knobs) -> Self {
        let paths = if knobs.cuts() { None } else { design.cut().ok().map(|cut| design.paths(&cut)) };
        let nominal = Behaviour::of(design).ok();
        let window_m = nominal.as_ref().map_or([0.0, design.purpose.stroke_m], |b| b.window_m);
        let measured = nominal.map_or_else(Measured::none, |b| measure_scalars(design, &b));
        let limited = limited(design.requirements.as_ref());
        let mut scalars = scalars(&measured, &OF_FORCES, &limited, knobs.cuts());
        // The slower motion takes as long as the motion: it is computed for a limit only.
        scalars.retain(|name| *name != SLOWER || limited.contains(name));
        let held = held(&OF_FORCES, &limited, knobs.cuts());
        let force =
            |name: &str, index: usize| Output { name: name.to_owned(), unit: "N", values: index * STATIONS..(index + 1) * STATIONS };
        let mut outputs = vec![force("force_up", 0), force("force_down", 1), force("force", 2)];
        outputs.extend(outputs_of(scalars.iter().copied().chain(held.iter().map(|i| OF_FORCES[*i]))));
        let wanted = design.requirements.as_ref().and_then(|r| r.force.as_ref()).map(|(law, _)| law.clone());
        let slower = scalars.contains(&SLOWER);
        let motion = design.motion.map(|motion| Motion { reference_s: motion.reference_s.filter(|_| slower), ..motion });
        let base = Design { motion, ..design.clone() };
        let lengths = [design.built.min_length_m, design.built.max_length_m];
        let measures = measures(OF_FORCES.iter().chain(&scalars), design.requirements.as_ref(), lengths, design.moves());
        Self { knobs, base, paths, window_m, wanted, scalars, held, outputs, measures, steps: Steps::new(STEP) }
    }

    /// Travels at which forces are computed, m.
    pub(super) fn stations_m(&self) -> impl Iterator<Item = f64> + '_ {
        let [from, to] = self.window_m;
        (0..STATIONS).map(move |i| from + (to - from) * i as f64 / (STATIONS - 1) as f64)
    }

    /// Force that is required at each station; the level of the cut where none is.
    pub(super) fn wanted_n(&self) -> Vec<f64> {
        let law = self.wanted.as_ref().unwrap_or(&self.base.purpose.law);
        self.stations_m().map(|s| law.force_n(s)[0]).collect()
    }
}

/// What follows from forces over a window at [`STATIONS`] places, up, down and without friction: the order of [`OF_FORCES`].
pub(crate) fn of_forces(values: &[f64], wanted: Option<&[f64]>, [from, to]: [f64; 2]) -> [f64; OF_FORCES.len()] {
    let [up, down, still] = [0, 1, 2].map(|i| &values[i * STATIONS..(i + 1) * STATIONS]);
    let extent = |v: &[f64]| v.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
    let [[mean_up, spread_up], [mean_down, spread_down], [mean_still, _]] = [up, down, still].map(|forces| moments(forces, |f| *f));
    let ([up_min, up_max], [down_min, down_max]) = (extent(up), extent(down));
    let off = |v: &[f64], wanted: &[f64]| v.iter().zip(wanted).map(|(v, w)| (v / w - 1.0).abs()).fold(0.0, f64::max);
    let deviation = wanted.map_or(f64::NAN, |wanted| off(up, wanted).max(off(down, wanted)));
    let (high, low) = (up_max.max(down_max), up_min.min(down_min));
    [
        deviation,
        mean_still,
        mean_up,
        spread_up,
        up_max,
        up_min,
        mean_down,
        spread_down,
        down_max,
        down_min,
        (mean_up - mean_down) * (to - from),
        (mean_up - mean_down) / mean_still,
        (high - low) / (high + low),
    ]
}

/// Metrics that the requirements limit.
pub(crate) fn limited(requirements: Option<&Requirements>) -> Vec<&'static str> {
    let named = requirements.iter().flat_map(|r| &r.limits).map(|limit| METRICS[limit.metric].name);
    named.chain(requirements.and_then(|r| r.hysteresis).map(|_| "hysteresis")).collect()
}

/// Metrics that a study takes as values of their own: those that the design has, in the order of the list. A sample also takes what is
/// limited and the design lacks: it does not keep the limit, as in its analysis. A search could not begin.
pub(crate) fn scalars(measured: &Measured, of_curves: &[&str], limited: &[&str], search: bool) -> Vec<&'static str> {
    let taken = |name: &&str| measured.get(name).is_some() || (!search && limited.contains(name));
    METRICS.iter().map(|m| m.name).filter(|name| !of_curves.contains(name) && taken(name)).collect()
}

/// Metrics of the curves that a search has to keep to beside the band, by their places in the list.
pub(crate) fn held(of_curves: &[&str], limited: &[&str], search: bool) -> Vec<usize> {
    let is_held = |name: &str| search && limited.contains(&name) && !name.ends_with("_deviation");
    (0..of_curves.len()).filter(|i| is_held(of_curves[*i])).collect()
}

/// Outputs of single values, which follow those of the curves.
pub(crate) fn outputs_of(names: impl Iterator<Item = &'static str>) -> impl Iterator<Item = Output> {
    names.enumerate().map(|(index, name)| {
        let unit = METRICS.iter().find(|m| m.name == name).map_or("1", |m| m.dimension.si_symbol());
        Output { name: name.to_owned(), unit, values: 3 * STATIONS + index..3 * STATIONS + index + 1 }
    })
}

/// What a study measures: names of metrics, of which the requirements limit some.
pub(crate) fn measures<'a>(
    names: impl Iterator<Item = &'a &'static str>,
    requirements: Option<&Requirements>,
    [min_length_m, max_length_m]: [Option<f64>; 2],
    moves: bool,
) -> Vec<Measure> {
    let one = |name: &str| {
        let (mut lower, mut upper, mut requirement) = (f64::NEG_INFINITY, f64::INFINITY, "");
        match name {
            "force_deviation" | "torque_deviation" => {
                if let Some((_, band)) = requirements.and_then(|r| r.force.as_ref()) {
                    (upper, requirement) = (*band, name.split('_').next().unwrap_or(name));
                }
            }
            "hysteresis" => {
                if let Some(limit) = requirements.and_then(|r| r.hysteresis) {
                    (upper, requirement) = (limit, "hysteresis");
                }
            }
            "spring_length_max" => {
                if let Some(max) = max_length_m {
                    (upper, requirement) = (max, "spring_length");
                }
            }
            "spring_length_min" => {
                if let Some(min) = min_length_m {
                    (lower, requirement) = (min, "spring_solid");
                }
            }
            "contact_force_min" => (lower, requirement) = (0.0, "contact"),
            "contact_force_min_motion" if moves => (lower, requirement) = (0.0, "contact_motion"),
            _ => {}
        }
        for limit in requirements.iter().flat_map(|r| &r.limits).filter(|l| l.name::<CamMetrics>() == name) {
            lower = lower.max(limit.min.unwrap_or(lower));
            upper = upper.min(limit.max.unwrap_or(upper));
            requirement = METRICS[limit.metric].name;
        }
        let unit = METRICS.iter().find(|m| m.name == name).map_or(Dimension::Ratio, |m| m.dimension).si_symbol();
        Measure { name: name.to_owned(), requirement: requirement.to_owned(), unit, lower, upper }
    };
    names.map(|name| one(name)).collect()
}

impl Evaluator for Many {
    fn variables(&self) -> &[Variable] {
        &self.knobs.variables
    }

    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn stations(&self, output: usize) -> Vec<f64> {
        if output < 3 { self.stations_m().collect() } else { Vec::new() }
    }

    fn measures(&self) -> &[Measure] {
        &self.measures
    }

    fn workspace(&self) -> Workspace {
        Workspace::new(Room { design: self.base.clone() })
    }

    fn evaluate(&self, x: &[f64], derivatives: bool, out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        let failure = |reason: String| Failure { reason };
        let room = workspace.get::<Room>().ok_or_else(|| failure("the room is another evaluator's".to_owned()))?;
        room.design.clone_from(&self.base);
        self.knobs.apply(x, &mut room.design);
        let new;
        let paths = if let Some(paths) = &self.paths {
            paths
        } else {
            let cut = room.design.cut().map_err(|e| failure(format!("the cam cannot be cut: {e:?}")))?;
            new = room.design.paths(&cut);
            &new
        };
        let behaviour = Behaviour::sampled(&room.design, paths, self.window_m, 2 * PANELS, 2 * PANELS);
        if behaviour.stopped.is_some() || room.design.moves() != behaviour.motion.is_some() {
            return Err(failure("a brace misses the path of its roller".to_owned()));
        }
        out.values.clear();
        let window = &behaviour.window;
        out.values.extend(window.iter().map(|s| s.up.force_n));
        out.values.extend(window.iter().map(|s| s.down.force_n));
        out.values.extend(window.iter().map(|s| s.still.force_n));
        let measured = measure_scalars(&room.design, &behaviour);
        out.values.extend(self.scalars.iter().map(|name| measured.get(name).unwrap_or(f64::NAN)));
        let of_forces = of_forces(&out.values, None, self.window_m);
        out.values.extend(self.held.iter().map(|i| of_forces[*i]));
        out.jacobian.clear();
        if derivatives { self.differentiate(x, &vec![true; out.values.len()], out, workspace) } else { Ok(()) }
    }

    fn differentiate(&self, x: &[f64], rows: &[bool], out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        let mut steps = self.steps.at(self, x, workspace);
        self.knobs.without_seed(&mut steps);
        differences::jacobian_with_steps(self, x, &steps, out, workspace)?;
        differences::keep(rows, self.knobs.variables.len(), &mut out.jacobian);
        Ok(())
    }

    fn measure(&self, _: &[f64], values: &[f64], out: &mut Vec<f64>, _: &mut Workspace) {
        out.clear();
        if values.len() != 3 * STATIONS + self.scalars.len() + self.held.len() {
            out.resize(self.measures.len(), f64::NAN);
            return;
        }
        let wanted = self.wanted.as_ref().map(|_| self.wanted_n());
        out.extend(of_forces(values, wanted.as_deref(), self.window_m));
        out.extend(&values[3 * STATIONS..3 * STATIONS + self.scalars.len()]);
    }
}
