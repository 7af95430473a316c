//! From `[measurements]` and `[calibrate]` to parameters with intervals, and a variant of the project that has them.

#[cfg(test)]
mod coverage;
#[cfg(test)]
mod derivatives;
mod document;
mod page;
mod picture;
mod points;
mod wording;
mod writing;

use std::fmt;
use std::path::Path;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Explanation, Sources, Span};
use forcewright_contract::calibration::{Record, Wanted};
use forcewright_contract::project::Files;
use forcewright_model::{Axis, Report};
use forcewright_study::calibrate::{
    Bench, BenchParameter, CalibrateError, Curve, CurveError, Fit, Limits, Measured, Model, Parameter, Plan, Stop, Watch, fit,
};
use forcewright_study::evaluator::{Evaluation, Evaluator};
use forcewright_study::sampling::Confidence;

use crate::{Loaded, Refused};
use points::{Points, REACH};
use writing::Found;

/// Codes of calibrations beyond those of the project file.
pub(crate) const CODES: &[Explanation] = &[
    Explanation {
        code: "E0907",
        title: "the design of the file has no curve",
        text: "A calibration begins with the numbers of the file. That design does not reach the end of its travel, or cannot be built; `forcewright solve` says why. Exit code 3.",
    },
    Explanation {
        code: "E0911",
        title: "nothing to look for",
        text: "A calibration changes at least one number: `parameters` names numbers of the design by their paths, or by patterns with `*`, and numbers of the bench.\n\n    [calibrate]\n    parameters = { \"material.young_modulus\" = {}, \"bench.offset.y\" = {} }",
    },
    Explanation {
        code: "W0901",
        title: "measured points are left out",
        text: "Points that were measured where the design's curve is not computed, or on the other branch than the one asked for, do not count. Where a point lies is judged with the zero and the compliance of the bench that were found, if they were looked for, else with those of the file. Curves are computed from rest to `load.travel` (compliant), over `window` (cam), up to the required torque (cable drive, transmission).",
    },
    Explanation {
        code: "W0902",
        title: "parameters are not determined",
        text: "The measured curve hardly changes when these parameters change together as the message says, so that it cannot tell their values: of a modulus of elasticity and a depth it knows the product. The intervals say so too.\n\nTake one of them out of the calibration, give it a `prior`, or measure something else that tells them apart.",
    },
    Explanation {
        code: "W0903",
        title: "parameters are hardly told apart",
        text: "The errors of two estimates go together almost entirely: if one is too large, so is the other, or too small. Each interval is right by itself; their combination is known far better than either.\n\nIf the combination is what matters, nothing needs to be done. Else measure where the two act differently (further along the travel, the other way, another load), or take one out of the calibration and type what is known of it; a `prior` narrows the other only as far as it is sure itself.",
    },
    Explanation {
        code: "W0904",
        title: "an estimate rests on its prior",
        text: "The measurement adds next to nothing to what the file says of this parameter: its interval is that of the `prior`.",
    },
    Explanation {
        code: "W0905",
        title: "something is not explained",
        text: "No values of the parameters bring the curve to the measured points: what is left is systematic, as runs of signs or the lack of fit show. The message says where and how much. The estimates absorb as much of it as they can, so they are not to be trusted as material data, and their intervals are too narrow.\n\nWhere signs alternate from row to row, the file has two curves (a tangent and a secant stiffness, two columns in one), or rows that ring: an amplifier or a controller that overshoots. Those are no errors of independent measurements.\n\nWhat is missing may be in the model (joints of finite size: `model.joints = \"overlap\"`, friction, play), on the bench (`bench.offset`, `bench.compliance`), or in a number that is not looked for. Exit code 1.",
    },
    Explanation {
        code: "W0906",
        title: "an estimate lies at a bound",
        text: "The measured curve would be met better beyond the range that was allowed. Widen `range` if that is possible; else something else is wrong that this parameter tries to make up for.",
    },
    Explanation {
        code: "W0907",
        title: "the measurement contradicts a prior",
        text: "What was measured and the prior differ by more than three standard deviations of their difference. Either the prior was too sure, or the model lacks something that this parameter tries to make up for.",
    },
    Explanation {
        code: "W0908",
        title: "points beyond the end of the curve",
        text: "With the zero or the compliance of the bench that was found, points that count lie beyond the places for which the design's curve is computed, and leaving them out would bring them back in: the choice of points and the estimate do not settle. There the curve goes straight on, which is no model of anything. Compute further (`load.travel`, `window`, the required torque), or leave out the ends of the record.",
    },
    Explanation {
        code: "W0909",
        title: "too few points to judge",
        text: "Whether the parameters explain a curve shows in what they leave: with few points beyond the number of parameters any pattern can be chance. Points at one place, however many, show no curve at all: at least three places more than there are parameters are needed. Nothing contradicts the estimates, and nothing confirms the model. Measure at more places; a dozen beyond the number of parameters is enough.",
    },
    Explanation {
        code: "W0910",
        title: "rows that repeat each other",
        text: "Every row counts as a measurement of its own, but for two kinds that tell nothing new and count once: a row that repeats the one before it to the last digit, as of a logger that writes faster than it measures or a display that stands, and a table that begins again from its first row, as when it was pasted twice. Rows that repeat others in other ways count, and are told of from a twentieth of the points on: if they are copies, remove them, since with them intervals are too narrow (of every point twice, 88 % for 95 %). Rows that agree because a display shows few digits are measurements, and may stay.",
    },
    Explanation {
        code: "W0911",
        title: "points far off the others",
        text: "These points lie more than four robust standard deviations off what the other points say, and more where points are few: about one good measurement in a hundred has such a point. Where every point counts the same (`loss = \"squares\"`), they draw the estimates to themselves and widen all intervals.\n\nLook at the rows. What was written down wrongly is corrected or left out; where such points come again and again, let them count little:\n\n    [calibrate]\n    loss = \"tukey\"",
    },
];

/// Why there are no parameters.
#[derive(Debug)]
pub enum NoCalibration {
    /// The project asks for what cannot be done.
    Refused(Refused),
    /// The search could not begin: the design of the file has no curve.
    NoStart(Refused),
}

impl fmt::Display for NoCalibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(refused) | Self::NoStart(refused) => f.write_str(&refused.render(false)),
        }
    }
}

impl std::error::Error for NoCalibration {}

/// Parameters from a measured curve.
pub struct Calibrated {
    /// What was found.
    pub fit: Fit,
    /// The unit in which people are shown each parameter.
    pub units: Vec<String>,
    /// The same as a factor: SI value of one unit.
    pub unit_sizes: Vec<f64>,
    /// The points that counted.
    pub points: Points,
    /// Rows of the file that repeat others as copies do, and are not among them.
    pub copied_rows: usize,
    /// The curve as it is drawn, branch by branch, over the range of its points.
    lines: Vec<picture::Line>,
    /// How many of them lie beyond the ends of the curve, on the bench that was found.
    pub beyond: usize,
    /// Name of the measurement.
    pub measurement: String,
    /// Abscissa and ordinate, in the units of the file.
    pub axes: [Axis; 2],
    /// Confidence of all intervals.
    pub confidence: Confidence,
    /// The variant that has the estimates.
    pub variant: String,
    /// The project file with this variant, comments kept; where a place for it was named.
    pub text: Option<String>,
    /// The design of the file.
    pub before: Report,
    /// What was said about the study.
    pub diagnostics: Diagnostics,
    /// The texts that they point into.
    pub sources: Sources,
}

/// A calibration that is ready to run.
struct Ready {
    evaluator: Box<dyn Evaluator>,
    wanted: Wanted,
    points: Points,
    bench: Bench,
    axes: [Axis; 2],
    measurement: String,
    record: Record,
    branch: &'static str,
    place: Span,
}

/// Choices of points, at most, each with the bench that the last one led to.
const MOST_CHOICES: usize = 8;

impl Loaded {
    /// Looks for the parameters of `[calibrate]` that bring the design's curve to what was measured. With a `target`, the project file
    /// with a variant that has the estimates is written for that place. The result depends on the project alone: the same bits with any
    /// number of threads. Told to stop by `watch`, it keeps the best parameters so far.
    ///
    /// # Errors
    /// [`NoCalibration`]: nothing to calibrate or to compare with, data that cannot be read, or a design without a curve.
    pub fn calibrate(&self, files: &dyn Files, target: Option<&Path>, watch: Watch<'_>) -> Result<Calibrated, NoCalibration> {
        let mut diagnostics = Diagnostics::default();
        let before = self.solve(&self.name(), "", &mut |_| true);
        let ready = self.calibration(&before, &mut diagnostics).filter(|_| !diagnostics.has_errors());
        let Some(mut ready) = ready else { return Err(NoCalibration::Refused(self.refused(diagnostics))) };
        let variant = self.variant_of_estimates();
        let written = |ready: &Ready, values: &[f64]| {
            let Some(target) = target else { return Ok(None) };
            self.with_estimates((files, target), &variant, &ready.written(values)).map(Some).map_err(NoCalibration::Refused)
        };
        // What cannot be written is refused before the work, not after.
        written(&ready, &ready.parameters().iter().map(|p| p.start).collect::<Vec<_>>())?;
        let section = &self.understood.studies().calibrate;
        let plan = Plan { loss: section.loss(), confidence: section.confidence(), ..Plan::default() };
        let found = ready.choose(&plan, watch).and_then(|()| {
            let parameters = ready.parameters();
            ready.fitted(&parameters, [&ready.points.y, &ready.points.raw], &plan, watch)
        });
        let found = found.map_err(|error| self.no_fit(&error, ready.place))?;
        let values: Vec<f64> = found.parameters.iter().map(|p| p.estimate.value).collect();
        let text = written(&ready, &values)?;
        let (units, unit_sizes) = wording::units(&ready.wanted, &ready.axes);
        let lines = ready.lines(&values);
        let beyond = ready.points.beyond(&ready.bench_at(&values));
        ready.say_what_is_left_out(&mut diagnostics);
        let mut calibrated = Calibrated {
            fit: found,
            units,
            unit_sizes,
            points: ready.points,
            copied_rows: ready.record.copies,
            lines,
            beyond,
            measurement: ready.measurement,
            axes: ready.axes,
            confidence: plan.confidence,
            variant,
            text,
            before,
            diagnostics,
            sources: self.project.sources.clone(),
        };
        calibrated.warn(ready.place);
        Ok(calibrated)
    }

    /// Why there is no fit, at the section that asks for one.
    fn no_fit(&self, error: &NoFit, place: Span) -> NoCalibration {
        let mut diagnostics = Diagnostics::default();
        match error {
            NoFit::NoCurve(error) => diagnostics.push(no_curve(place, &error.to_string())),
            NoFit::Study(error @ CalibrateError::NoStart(_)) => {
                let help = "`forcewright solve` says how far the design of the file comes";
                diagnostics.push(Diagnostic::error("E0907", place, error.to_string()).label("begins with it").help(help));
                return NoCalibration::NoStart(self.refused(diagnostics));
            }
            NoFit::Study(error) => {
                let code = if matches!(error, CalibrateError::TooFew { .. }) { "E0904" } else { "E0906" };
                let help = "parameters need a value inside a range, and two points more than there are of them";
                diagnostics.push(Diagnostic::error(code, place, error.to_string()).label("this calibration").help(help));
            }
        }
        NoCalibration::Refused(self.refused(diagnostics))
    }

    /// What the sections of the project ask for. `None` after an error.
    fn calibration(&self, before: &Report, diagnostics: &mut Diagnostics) -> Option<Ready> {
        let studies = self.understood.studies();
        let section = &studies.calibrate;
        let Some(present) = &section.present else {
            diagnostics.push(
                Diagnostic::error("E0317", self.project.root, "there is no `[calibrate]`")
                    .label("from this file")
                    .help("add `[measurements.curve]` with `file`, `x`, `y`, and `[calibrate]` with `parameters = { \"material.young_modulus\" = {} }`"),
            );
            return None;
        };
        let place = present.span;
        if section.parameters.is_empty() {
            diagnostics.push(
                Diagnostic::error("E0911", self.place_of(&["calibrate", "parameters"]), "no number is looked for")
                    .label("nothing stands here")
                    .help("name one, `parameters = { \"material.young_modulus\" = {} }`, or one of the bench, `\"bench.offset.y\" = {}`"),
            );
            return None;
        }
        let measurement = section.of(&studies.measurements, place, diagnostics)?;
        let probe = self.understood.evaluator(&[], diagnostics)?;
        let Some(axes) = axes(&*probe, before) else {
            diagnostics.push(no_curve(place, "the studies of this design have no curve that its analysis shows"));
            return None;
        };
        let dimensions = [axes[0].dimension, axes[1].dimension];
        let stations = probe.stations(0);
        let ascending = stations.first() <= stations.last();
        let wanted = section.wanted(self.understood.numbers(), dimensions, diagnostics);
        let bench = measurement.value.bench(dimensions, diagnostics);
        let curve = compared(&*probe, before, &axes);
        let record = measurement.record(dimensions, (ascending, &curve), diagnostics);
        let (wanted, bench, record) = (wanted?, bench?, record?);
        if !wanted.begins_inside(&measurement.value, &bench, diagnostics) {
            return None;
        }
        let free: Vec<_> = wanted.design.iter().map(|d| d.free.clone()).collect();
        // What the probe said is said again.
        *diagnostics = Diagnostics::default();
        let evaluator = self.understood.evaluator(&free, diagnostics)?;
        let branch = section.branch.as_ref().map_or("both", |b| b.value);
        let points = Points::of(&record, &*evaluator, &bench, branch);
        let (count, least) = (points.x.len(), wanted.least_points());
        let ranges = points.ranges(&record, &axes, branch);
        if count < least {
            let named = measurement.value.file.as_ref().map_or(place, |f| f.span);
            diagnostics.push(
                Diagnostic::error("E0904", named, few_points(count, &record, least))
                    .label("measured here")
                    .help(format!("{ranges}: {REACH}")),
            );
            return None;
        }
        let [mut x, mut y] = axes;
        [x.display, y.display] = record.units.clone();
        let (axes, measurement) = ([x, y], measurement.name.value.clone());
        Some(Ready { evaluator, wanted, points, bench, axes, measurement, record, branch, place })
    }
}

/// Why there is no fit.
enum NoFit {
    NoCurve(CurveError),
    Study(CalibrateError),
}

impl Ready {
    /// What is looked for, as the search sees it.
    fn parameters(&self) -> Vec<Parameter> {
        let mut all = parameters(&self.wanted, &self.points, &self.bench);
        self.give_sizes(&mut all);
        all
    }

    /// A number that is 0 has no size of its own: a large change of it is one that changes the curve by as much as there is, if its range is
    /// not less.
    fn give_sizes(&self, all: &mut [Parameter]) {
        let without = |p: &Parameter| p.start.abs() <= 0.0 && !p.name.starts_with("bench.");
        if !all.iter().any(without) {
            return;
        }
        let start: Vec<f64> = all.iter().map(|p| p.start).collect();
        let mut out = Evaluation::default();
        let known = self.curve().is_ok_and(|model| model.predict(&start, true, &mut model.room(), &mut out).is_ok());
        let size = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
        let columns = all.len();
        for (column, parameter) in all.iter_mut().enumerate().filter(|(_, p)| known && without(p)) {
            let slope = size(&mut out.jacobian.iter().skip(column).step_by(columns).copied());
            let own = size(&mut self.points.y.iter().copied()) / slope;
            if own.is_finite() && own > 0.0 {
                parameter.scale = parameter.scale.min(own);
            }
        }
    }

    /// The bench with what was found of it.
    fn bench_at(&self, values: &[f64]) -> Bench {
        let inner = self.evaluator.variables().len();
        let mut bench = self.bench;
        self.wanted.bench.iter().zip(values.iter().skip(inner)).for_each(|(own, value)| bench.set(own.which, *value));
        bench
    }

    /// Chooses the points that lie where the curve is computed on the bench that they lead to: with the zero of the file some would be kept
    /// or dropped wrongly.
    fn choose(&mut self, plan: &Plan, watch: Watch<'_>) -> Result<(), NoFit> {
        if !self.wanted.bench.iter().any(|b| b.which != BenchParameter::OffsetY) {
            return Ok(());
        }
        let quick = Plan { profiles: false, ..plan.clone() };
        let mut before: Vec<Points> = Vec::new();
        for _ in 0..MOST_CHOICES {
            let found = self.fitted(&self.parameters(), [&self.points.y, &self.points.raw], &quick, watch)?;
            let values: Vec<f64> = found.parameters.iter().map(|p| p.estimate.value).collect();
            let next = Points::of(&self.record, &*self.evaluator, &self.bench_at(&values), self.branch);
            let same = next.branches == self.points.branches;
            if same || found.stop == Stop::Interrupted || next.x.len() < self.wanted.least_points() {
                return Ok(());
            }
            before.push(std::mem::replace(&mut self.points, next));
            if before.iter().any(|other| other.branches == self.points.branches) {
                break;
            }
        }
        // Some points lead to a bench that puts them beyond the end, and without them to one that does not: they are kept, and told of.
        let most = before.into_iter().max_by_key(|points| points.x.len());
        if let Some(most) = most.filter(|most| most.x.len() > self.points.x.len()) {
            self.points = most;
        }
        Ok(())
    }

    fn say_what_is_left_out(&self, diagnostics: &mut Diagnostics) {
        let Points { left_out, .. } = self.points;
        if left_out > 0 {
            let ranges = self.points.ranges(&self.record, &self.axes, self.branch);
            let message = format!("{left_out} of {} measured points do not count: {ranges}", self.record.x.len());
            diagnostics.push(Diagnostic::warning("W0901", self.place, message).label("of this calibration").help(REACH));
        }
    }

    /// The curve at the places of the points.
    fn curve(&self) -> Result<Curve<'_>, CurveError> {
        let free = self.wanted.bench.iter().map(|b| b.which).collect();
        Curve::new(&*self.evaluator, self.bench, free, self.points.branches.clone())
    }

    /// The fit to ordinates at the places of the points, filtered and as measured.
    fn fitted(&self, parameters: &[Parameter], [y, raw]: [&[f64]; 2], plan: &Plan, watch: Watch<'_>) -> Result<Fit, NoFit> {
        let model = self.curve().map_err(NoFit::NoCurve)?;
        let counts: Vec<usize> = self.points.branches.iter().map(|b| b.x.len()).collect();
        let measured = Measured { x: &self.points.x, y, raw, branches: &counts };
        fit(&model, parameters, measured, plan, watch).map_err(NoFit::Study)
    }

    /// Parameters as they are written.
    fn written(&self, values: &[f64]) -> Found<'_> {
        let inner = self.evaluator.variables().len();
        let bench = self.wanted.bench.iter().zip(values[inner..].iter().copied()).collect();
        Found { design: self.evaluator.numbers(&values[..inner]), bench, measurement: &self.measurement, axes: &self.axes }
    }
}

fn no_curve(place: Span, why: &str) -> Diagnostic {
    Diagnostic::error("E0908", place, why).label("this calibration").help("`forcewright solve` shows the curves of the design")
}

/// What curve is compared, in words: `tangent stiffness at the output over torque at the output`.
fn compared(evaluator: &dyn Evaluator, before: &Report, axes: &[Axis; 2]) -> String {
    let [x, y] = axes.each_ref().map(|axis| {
        // Without its symbol, and in the middle of a sentence.
        let label = axis.label.rsplit_once(' ').filter(|(_, symbol)| symbol.chars().count() == 1).map_or(&*axis.label, |(label, _)| label);
        let mut letters = label.chars();
        letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
    });
    let tangent = if before.outcome.mechanism == "capstan" { "tangent " } else { "" };
    let both = if evaluator.outputs().first().is_some_and(|o| o.name.ends_with("_up")) { ", up and down," } else { "" };
    format!("{tangent}{y}{both} over {x}")
}

/// That points are too few.
fn few_points(count: usize, record: &Record, least: usize) -> String {
    let can = format!("{count} of {} {} can be compared", record.x.len(), if record.x.len() == 1 { "point" } else { "points" });
    match record.copies {
        0 => format!("{can}, {least} are needed"),
        copies => {
            let (rows, are) = if copies == 1 { ("row", "is a copy") } else { ("rows", "are copies") };
            format!("{can}, {least} are needed; {copies} more {rows} {are}, to the last digit")
        }
    }
}

/// The axes of the curve that studies see: of the analysis, the one with its name, else the first with its ordinate.
fn axes(evaluator: &dyn Evaluator, report: &Report) -> Option<[Axis; 2]> {
    let output = evaluator.outputs().first().filter(|o| !evaluator.stations(0).is_empty() && !o.values.is_empty())?;
    let curves = || report.outcome.curves.iter().filter(|c| c.y.dimension.si_symbol() == output.unit);
    let named = curves().find(|c| c.name == output.name || output.name.strip_suffix("_up") == Some(c.name));
    named.or_else(|| curves().next()).map(|c| [c.x.clone(), c.y.clone()])
}

/// What is looked for, as the search sees it.
fn parameters(wanted: &Wanted, points: &Points, bench: &Bench) -> Vec<Parameter> {
    let extent = |v: &[f64]| {
        let [low, high] = v.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
        (high - low).max(f64::MIN_POSITIVE)
    };
    let (width, height) = (extent(&points.x), extent(&points.y).max(points.y.iter().fold(0.0, |m: f64, y| m.max(y.abs()))));
    let of_design = wanted.design.iter().map(|d| {
        let (si, span) = (d.free.number.si, d.free.upper - d.free.lower);
        // A number that is 0 has no size of its own.
        let scale = if si.abs() > 0.0 { si.abs() } else { Some(span).filter(|s| s.is_finite()).unwrap_or(1.0) };
        let limits = Limits { lower: d.free.lower, upper: d.free.upper };
        Parameter { name: d.free.number.path.clone(), start: si, limits, scale, prior: d.prior }
    });
    let of_bench = wanted.bench.iter().map(|b| {
        let (start, scale, usual) = match b.which {
            BenchParameter::OffsetX => (bench.offset[0], width, [-width, width]),
            BenchParameter::OffsetY => (bench.offset[1], height, [-height, height]),
            BenchParameter::Compliance => (bench.compliance, width / height, [0.0, width / height]),
        };
        let or = |typed: f64, usual: f64| if typed.is_finite() { typed } else { usual };
        let limits = Limits { lower: or(b.limits.lower, usual[0].min(start)), upper: or(b.limits.upper, usual[1].max(start)) };
        Parameter { name: b.path.to_owned(), start, limits, scale, prior: b.prior }
    });
    of_design.chain(of_bench).collect()
}

impl Calibrated {
    /// Whether the search came to its end.
    pub fn converged(&self) -> bool {
        self.fit.stop == Stop::Converged
    }

    /// Whether it came to its end, all is determined, within its range, and nothing is left unexplained, as far as the points are enough to
    /// judge: if they are not, it is not sound.
    pub fn sound(&self) -> bool {
        self.determined() && self.fit.residuals.judged && !self.fit.residuals.unexplained
    }

    /// Whether it came to its end, and all is determined, within its range.
    pub(crate) fn determined(&self) -> bool {
        let held = self.fit.parameters.iter().any(|p| p.at.is_some());
        let open = self.fit.parameters.iter().any(|p| p.error.is_infinite());
        let loose =
            self.fit.identified.loose.iter().any(|l| l.changes.iter().all(|(i, _)| self.fit.parameters[*i].parameter.prior.is_none()));
        self.converged() && !held && !open && !loose
    }
}
