//! A design for studies that look at many: force, stiffness and largest stress over the travel, and the metrics that follow from them.

use forcewright_base::units::Dimension;
use forcewright_beam::{BatchSolver, CurveSolver, DesignError, Network, Response, Settings, Shape, Status, Variant};
use forcewright_contract::metrics::Limit;
use forcewright_study::differences::{self, Steps};
use forcewright_study::evaluator::{Evaluation, Evaluator, Failure, Measure, Output, Variable, Workspace, one_by_one};

use super::knobs::{Knob, Knobs};
use crate::analysis::{PAPER_BAND, RANGE_FRACTION};
use crate::design::{Design, Requirements};
use crate::force_curve::{ForceCurve, Interval};
use crate::metrics::{CompliantMetrics, METRICS};

/// Displacements at which a curve is computed, rest included: between them it is a cubic.
const STATIONS: usize = 41;
/// Error of a curve where the file does not say, relative to the largest force: below the scatter of any process.
const ACCURACY: f64 = 1e-5;
/// The same where many designs are solved side by side: the finest with which that is possible.
const TOGETHER: f64 = 3e-5;
/// Steps of differences, for what has no derivatives of its own: the third root of the accuracy.
const STEP: f64 = 2e-2;
/// Difference of a beam from the one that spans its nodes with the same bends, relative to its length, up to which they are the same.
const SPANNED: f64 = 1e-9;

/// Metrics that follow from the curve, in the order of [`Evaluator::measures`], after what is required of force and travel.
const MEASURED: [&str; 10] = [
    "force_at_end",
    "range_ratio",
    "flat_ratio",
    "flat_force",
    "band_ratio",
    "force_local_max",
    "force_local_min",
    "stiffness_initial",
    "stiffness_min",
    "stress_max",
];

/// Why a design cannot be built.
const UNSPANNED: &str = "a beam does not span its nodes";

/// See the module.
pub(crate) struct Scatter {
    knobs: Knobs,
    base: Network,
    settings: Settings,
    /// Settings of designs that are solved side by side, if they can be.
    together: Option<Settings>,
    stations_m: Vec<f64>,
    copies: f64,
    requirements: Option<Requirements>,
    outputs: Vec<Output>,
    measures: Vec<Measure>,
    steps: Steps,
}

struct Room {
    curve: ForceCurve,
    solver: CurveSolver,
    batch: Option<BatchSolver>,
    network: Network,
    out: Evaluation,
}

impl Scatter {
    /// `accuracy` is what the file asks of `model.accuracy`: it then holds for every design, coarser or finer than this study would
    /// choose. The default of a single design is not meant for many.
    pub(crate) fn new(design: &Design, knobs: Knobs, accuracy: Option<f64>) -> Self {
        let last = STATIONS - 1;
        let output =
            |name: &str, unit, index: usize| Output { name: name.to_owned(), unit, values: index * STATIONS..(index + 1) * STATIONS };
        let settings = design.settings();
        let to = |usual: f64| Settings { accuracy: accuracy.unwrap_or(usual), ..settings };
        // A variant of a network has its thickness along beams, and beams that do not span their nodes by bends, from the template.
        let possible = to(TOGETHER).accuracy >= TOGETHER;
        let uniform = !knobs.each.iter().any(|knob| matches!(knob, Knob::ThicknessAt { .. }));
        Self {
            together: (possible && uniform && spanned(&design.network)).then_some(to(TOGETHER)),
            base: design.network.clone(),
            settings: to(ACCURACY),
            stations_m: (0..STATIONS).map(|i| design.load_end * i as f64 / last as f64).collect(),
            copies: design.copies(),
            requirements: design.requirements.clone(),
            outputs: vec![output("force", "N", 0), output("stiffness", "N/m", 1), output("stress", "Pa", 2)],
            measures: measures(design),
            steps: Steps::new(STEP),
            knobs,
        }
    }

    /// The vectors of a curve.
    fn take(&self, response: &Response, out: &mut Evaluation) -> Result<(), Failure> {
        if !matches!(response.status, Status::Complete) {
            return Err(Failure { reason: response.status.to_string() });
        }
        out.values.clear();
        out.values.extend(response.force_n.iter().map(|f| self.copies * f));
        out.values.extend(response.stiffness_n_per_m.iter().map(|k| self.copies * k));
        out.values.extend(&response.stress_pa);
        out.jacobian.clear();
        Ok(())
    }

    /// Derivatives of the forces by the numbers: a row per station. Not a number where the engine has none.
    fn forces_by_numbers(&self, x: &[f64], workspace: &mut Workspace) -> Result<Vec<f64>, Failure> {
        let failure = |reason: &str| Failure { reason: reason.to_owned() };
        let room = workspace.get::<Room>().ok_or_else(|| failure("the room is another evaluator's"))?;
        self.knobs.apply(&self.base, x, &mut room.network).ok_or_else(|| failure(UNSPANNED))?;
        let parameters = &self.knobs.parameters;
        let solved = room.solver.solve_with_gradient(&room.network, &self.stations_m, &self.settings, parameters);
        let response = solved.map_err(|error| Failure { reason: error.to_string() })?;
        if !matches!(response.status, Status::Complete) {
            return Err(Failure { reason: response.status.to_string() });
        }
        let columns = self.knobs.variables.len();
        let mut all = vec![0.0; STATIONS * columns];
        let each = response.force_gradient.chunks_exact(parameters.len().max(1)).zip(all.chunks_exact_mut(columns.max(1)));
        each.for_each(|(by_parameters, row)| self.knobs.add_row(by_parameters, self.copies, row));
        Ok(all)
    }

    /// Deviation and usable travel, and the metrics of [`MEASURED`] but the stress.
    fn of_curve(&self, curve: &ForceCurve) -> [Option<f64>; MEASURED.len() + 1] {
        let (end, travel) = (curve.end(), curve.end() - curve.start());
        let force = self.requirements.as_ref().and_then(|r| r.force);
        let travel_m = self.requirements.as_ref().and_then(|r| r.travel_m);
        let window = force.zip(travel_m).and_then(|((_, nominal), travel)| curve.best_window(travel, nominal));
        let flat = curve.longest_flat(force.map_or(PAPER_BAND, |(band, _)| band));
        let length = |i: Option<Interval>| i.map_or(0.0, |i| i.length());
        let within = force.and_then(|(band, nominal)| Some((band, nominal?)));
        let within = within.map(|(band, level)| length(curve.longest_within(level * (1.0 - band), level * (1.0 + band))));
        let max = curve.turning().find(|t| t.is_max);
        let min = max.and_then(|max| curve.turning().find(|t| !t.is_max && t.at > max.at));
        [
            window.map(|(_, deviation)| deviation),
            // Without a level of its own, the longest interval of the band is the flat one.
            force.map(|_| within.unwrap_or(length(flat))),
            Some(curve.force(end)),
            curve.range_start(RANGE_FRACTION).map(|c| (end - c) / travel),
            flat.map(|i| i.length() / travel),
            flat.map(|i| {
                let (hi, lo) = curve.extent(i);
                f64::midpoint(hi, lo)
            }),
            within.map(|length| length / travel),
            max.map(|turn| curve.force(turn.at)),
            min.map(|turn| curve.force(turn.at)),
            Some(curve.slope(0.0)),
            Some(curve.least_slope()),
        ]
    }
}

/// Whether every beam is the one that spans its nodes with its bends.
fn spanned(network: &Network) -> bool {
    network.beams.iter().all(|beam| {
        let [from, to] = [beam.start, beam.end].map(|n| network.nodes[n].position_m);
        let angles = beam.shape.angle_rad();
        let bends = angles.get(1..).unwrap_or_default();
        Shape::from_chord([to[0] - from[0], to[1] - from[1]], bends).is_ok_and(|own| {
            let turned = own.angle_rad().first().zip(angles.first()).map_or(0.0, |(a, b)| (a - b).abs());
            (own.length_m() / beam.shape.length_m() - 1.0).abs() <= SPANNED && turned <= SPANNED
        })
    })
}

/// What follows from the curve of a design, with what its requirements allow.
fn measures(design: &Design) -> Vec<Measure> {
    let free = (f64::NEG_INFINITY, f64::INFINITY);
    let measure = |name: &str, requirement: &str, unit, (lower, upper)| Measure {
        name: name.to_owned(),
        requirement: requirement.to_owned(),
        unit,
        lower,
        upper,
    };
    let requirements = design.requirements.as_ref();
    let force = requirements.and_then(|r| r.force);
    let travel_m = requirements.and_then(|r| r.travel_m).filter(|_| force.is_some());
    let mut all = vec![
        measure(
            "force_deviation",
            if force.is_some() { "force" } else { "" },
            "1",
            force.map_or(free, |(band, _)| (f64::NEG_INFINITY, band)),
        ),
        measure(
            "usable_travel",
            if travel_m.is_some() { "travel" } else { "" },
            Dimension::Length.si_symbol(),
            travel_m.map_or(free, |travel| (travel, f64::INFINITY)),
        ),
    ];
    for name in MEASURED {
        let Some((index, info)) = METRICS.iter().enumerate().find(|(_, info)| info.name == name) else { continue };
        let (mut bounds, mut requirement) = (free, "");
        match (name, requirements) {
            ("stiffness_min", Some(r)) => (bounds.0, requirement) = (r.stiffness_min, "stiffness"),
            ("stress_max", Some(_)) => {
                if let Some(allowed) = design.common_allowable_pa() {
                    (bounds.1, requirement) = (allowed, "stress");
                }
            }
            _ => {}
        }
        for limit in requirements.iter().flat_map(|r| &r.limits).filter(|l| l.metric == index) {
            bounds = (bounds.0.max(limit.min.unwrap_or(bounds.0)), bounds.1.min(limit.max.unwrap_or(bounds.1)));
            requirement = name;
        }
        all.push(measure(name, requirement, info.dimension.si_symbol(), bounds));
    }
    all
}

/// Requirements that these measures do not cover: what a study must say it has not looked at.
pub(crate) fn not_measured(design: &Design) -> Vec<&'static str> {
    let Some(requirements) = &design.requirements else { return Vec::new() };
    let mut missing = Vec::new();
    if requirements.envelope.is_some() {
        missing.push("envelope");
    }
    if requirements.stiffness_max.is_some() {
        missing.push("stiffness.max");
    }
    if requirements.stress.is_some() && design.common_allowable_pa().is_none() {
        missing.push("stress");
    }
    missing.extend(requirements.endurance());
    let limited = requirements.limits.iter().map(Limit::name::<CompliantMetrics>);
    missing.extend(limited.filter(|name| !MEASURED.contains(name)));
    missing
}

impl Evaluator for Scatter {
    fn variables(&self) -> &[Variable] {
        &self.knobs.variables
    }

    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn stations(&self, _: usize) -> Vec<f64> {
        self.stations_m.clone()
    }

    fn measures(&self) -> &[Measure] {
        &self.measures
    }

    fn workspace(&self) -> Workspace {
        let batch = self.together.as_ref().map(|_| BatchSolver::new());
        Workspace::new(Room {
            curve: ForceCurve::default(),
            solver: CurveSolver::new(),
            batch,
            network: self.base.clone(),
            out: Evaluation::default(),
        })
    }

    fn evaluate(&self, x: &[f64], derivatives: bool, out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        let failure = |reason: &str| Failure { reason: reason.to_owned() };
        let room = workspace.get::<Room>().ok_or_else(|| failure("the room is another evaluator's"))?;
        self.knobs.apply(&self.base, x, &mut room.network).ok_or_else(|| failure(UNSPANNED))?;
        let response =
            room.solver.solve(&room.network, &self.stations_m, &self.settings).map_err(|error| Failure { reason: error.to_string() })?;
        self.take(response, out)?;
        if derivatives { self.differentiate(x, &vec![true; out.values.len()], out, workspace) } else { Ok(()) }
    }

    /// Of forces as the engine has them, exact; of stiffnesses and stresses, and where the engine has none, by differences.
    fn differentiate(&self, x: &[f64], rows: &[bool], out: &mut Evaluation, workspace: &mut Workspace) -> Result<(), Failure> {
        let columns = self.knobs.variables.len();
        let forces = self.forces_by_numbers(x, workspace)?;
        let exact = forces.iter().all(|d| d.is_finite());
        if exact && !rows.iter().skip(STATIONS).any(|wanted| *wanted) {
            out.jacobian.clear();
            out.jacobian.resize(rows.len() * columns, 0.0);
        } else {
            self.steps.jacobian(self, x, out, workspace)?;
        }
        if exact {
            out.jacobian[..forces.len()].copy_from_slice(&forces);
        }
        differences::keep(rows, columns, &mut out.jacobian);
        Ok(())
    }

    fn measure(&self, _: &[f64], values: &[f64], out: &mut Vec<f64>, workspace: &mut Workspace) {
        out.clear();
        let [force_n, stiffness_n_per_m, stress_pa] = [0, 1, 2].map(|i| values.get(i * STATIONS..(i + 1) * STATIONS).unwrap_or_default());
        let Some(Room { curve, .. }) = workspace.get::<Room>().filter(|_| values.len() == 3 * STATIONS) else {
            out.resize(self.measures.len(), f64::NAN);
            return;
        };
        curve.set(&self.stations_m, force_n, stiffness_n_per_m);
        out.extend(self.of_curve(curve).map(|measure| measure.unwrap_or(f64::NAN)));
        out.push(stress_pa.iter().fold(0.0, |m: f64, s| m.max(*s)));
    }

    fn evaluate_all(&self, designs: &[f64], workspace: &mut Workspace, sink: &mut dyn FnMut(usize, Result<&Evaluation, &Failure>)) {
        let width = self.knobs.variables.len().max(1);
        let room = workspace.get::<Room>();
        let Some((settings, Room { batch: Some(batch), out, .. })) = self.together.as_ref().zip(room) else {
            return one_by_one(self, designs, workspace, sink);
        };
        let set = |index: usize, variant: &mut Variant| self.knobs.vary(&designs[index * width..(index + 1) * width], variant);
        batch.solve_variants(&self.base, designs.len() / width, set, &self.stations_m, settings, |index, solved| {
            let taken = match solved {
                Ok(response) => self.take(response, out),
                Err(DesignError::Shape { .. }) => Err(Failure { reason: UNSPANNED.to_owned() }),
                Err(error) => Err(Failure { reason: error.to_string() }),
            };
            match &taken {
                Ok(()) => sink(index, Ok(out)),
                Err(failure) => sink(index, Err(failure)),
            }
        });
    }
}

#[cfg(test)]
mod tests;
