//! A step of a task as a problem of smooth constrained optimisation.
//!
//! Unknowns are the variables, as parts of their ranges; the level of each band whose level is free; and the half width or the largest
//! value where that is what is minimised (the epigraph: minimise t with every value below t). A band |v/F − 1| ≤ t becomes
//! v − (1 + t)F ≤ 0 ≤ v − (1 − t)F, which is linear in F and in v.

use crate::evaluator::{Evaluation, Evaluator, Variable, Workspace};
use crate::nlp::{Problem, Rejected, Values};
use crate::optimise::Reserve;
use crate::task::{Goal, Limit, Step, Task};

/// A level is never taken below this part of its first value: at zero a band says nothing.
const LEAST_LEVEL: f64 = 1e-3;

/// Values further than this part of their scale inside a limit are not differentiated: a step that would break it fails by the value.
const NEAR: f64 = 0.3;

/// Where a constraint comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Source {
    /// A limit, by its index, and which of its values.
    Limit(usize, usize),
    /// Above (1) or below (−1) a band, by its index, at one of its values.
    Band(usize, usize, f64),
    /// The largest size of some values, above (1) or below (−1) zero.
    Largest(usize, f64),
}

/// A step as a problem.
pub(crate) struct Posing<'a> {
    evaluator: &'a dyn Evaluator,
    limits: &'a [Limit],
    step: &'a Step,
    reserve: &'a Reserve,
    workspace: Workspace,
    evaluation: Evaluation,
    /// Scale of the levels, SI: their first values.
    levels: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    constraint_lower: Vec<f64>,
    constraint_upper: Vec<f64>,
    pub(crate) sources: Vec<Source>,
    pub(crate) start: Vec<f64>,
    x: Vec<f64>,
    /// Whether the evaluation is that of `x`.
    current: bool,
    /// Values that are differentiated whether near to their limits or not: of the goal and of bands.
    always: Vec<bool>,
    /// Values near to their limits at the last point with derivatives: they may have multipliers there, which the next compares.
    near: Vec<bool>,
    /// Values that are differentiated.
    rows: Vec<bool>,
    /// Designs evaluated.
    pub(crate) evaluations: u64,
}

impl<'a> Posing<'a> {
    /// Poses a step at its start `x`, SI, some way inside the limits. `None` if the start has no values.
    pub(crate) fn new(task: &'a Task, step: &'a Step, x: &[f64], reserve: &'a Reserve) -> Option<Self> {
        let evaluator = task.evaluator.as_ref();
        let mut workspace = evaluator.workspace();
        let mut evaluation = Evaluation::default();
        evaluator.evaluate(x, false, &mut evaluation, &mut workspace).ok()?;
        let count = evaluation.values.len();
        let mut posing = Self {
            evaluator,
            limits: &task.limits,
            step,
            reserve,
            workspace,
            evaluation,
            levels: Vec::new(),
            lower: Vec::new(),
            upper: Vec::new(),
            constraint_lower: Vec::new(),
            constraint_upper: Vec::new(),
            sources: Vec::new(),
            start: Vec::new(),
            x: x.to_vec(),
            current: true,
            always: vec![false; count],
            near: vec![false; count],
            rows: Vec::new(),
            evaluations: 1,
        };
        posing.unknowns();
        posing.constraints();
        posing.always();
        Some(posing)
    }

    /// Whether a variable is held at its value.
    pub(crate) fn holds(&self, variable: usize) -> bool {
        self.step.held.contains(&variable)
    }

    fn unknowns(&mut self) {
        for (index, (variable, x)) in self.evaluator.variables().iter().zip(&self.x).enumerate() {
            let (low, high) = (inward(variable, variable.lower), inward(variable, variable.upper));
            let start = inward(variable, *x);
            let held = self.step.held.contains(&index);
            self.lower.push(if held { start } else { low });
            self.upper.push(if held { start } else { high });
            self.start.push(start);
        }
        let mut worst = 0.0_f64;
        for band in &self.step.bands {
            let values = &self.evaluation.values[band.values.clone()];
            let (high, low) = values.iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(h, l), v| (h.max(*v), l.min(*v)));
            let level = band.level.unwrap_or_else(|| f64::midpoint(high, low));
            let scale = if level.abs() > 0.0 { level.abs() } else { 1.0 };
            if band.level.is_none() {
                self.levels.push(scale);
                self.lower.push(LEAST_LEVEL);
                self.upper.push(f64::INFINITY);
                self.start.push(level.max(LEAST_LEVEL * scale) / scale);
            } else {
                self.levels.push(level);
            }
            if band.half_width.is_none() {
                worst = worst.max((high / scale - 1.0).abs()).max((low / scale - 1.0).abs());
            }
        }
        let top = match &self.step.goal {
            Goal::HalfWidth => worst,
            Goal::Largest { values, scale } => self.evaluation.values[values.clone()].iter().fold(0.0_f64, |m, v| m.max(v.abs())) / scale,
            _ => return,
        };
        self.lower.push(if matches!(self.step.goal, Goal::HalfWidth) { 0.0 } else { f64::NEG_INFINITY });
        self.upper.push(f64::INFINITY);
        self.start.push(top);
    }

    fn constraints(&mut self) {
        for (index, limit) in self.limits.iter().enumerate() {
            for at in limit.values.clone() {
                let [lower, upper] = inner_bounds(limit, self.reserve, at);
                self.constraint_lower.push(lower);
                self.constraint_upper.push(upper);
                self.sources.push(Source::Limit(index, at));
            }
        }
        for (index, band) in self.step.bands.iter().enumerate() {
            for at in band.values.clone() {
                for (side, lower, upper) in [(1.0, f64::NEG_INFINITY, 0.0), (-1.0, 0.0, f64::INFINITY)] {
                    self.constraint_lower.push(lower);
                    self.constraint_upper.push(upper);
                    self.sources.push(Source::Band(index, at, side));
                }
            }
        }
        if let Goal::Largest { values, .. } = &self.step.goal {
            for (at, side) in values.clone().flat_map(|at| [(at, 1.0), (at, -1.0)]) {
                self.constraint_lower.push(f64::NEG_INFINITY);
                self.constraint_upper.push(0.0);
                self.sources.push(Source::Largest(at, side));
            }
        }
    }

    /// What is differentiated at every point.
    fn always(&mut self) {
        for source in &self.sources {
            if let Source::Band(_, at, _) | Source::Largest(at, _) = source {
                self.always[*at] = true;
            }
        }
        match &self.step.goal {
            Goal::Values(weights) => weights.iter().for_each(|(at, _)| self.always[*at] = true),
            Goal::Squares { values, .. } => self.always[values.clone()].fill(true),
            Goal::HalfWidth | Goal::Variables(_) | Goal::Largest { .. } => {}
        }
    }

    /// Derivatives of what is near to its limit, here or at the last point with derivatives.
    fn differentiate(&mut self) -> Result<(), Rejected> {
        let mut near = vec![false; self.always.len()];
        for ((source, lower), upper) in self.sources.iter().zip(&self.constraint_lower).zip(&self.constraint_upper) {
            if let Source::Limit(limit, at) = *source {
                let value = self.evaluation.values[at] / self.limits[limit].scale;
                near[at] |= value - lower < NEAR || upper - value < NEAR;
            }
        }
        self.rows.clear();
        self.rows.extend(self.always.iter().zip(&self.near).zip(&near).map(|((always, before), near)| *always || *before || *near));
        let done = self.evaluator.differentiate(&self.x, &self.rows, &mut self.evaluation, &mut self.workspace);
        self.current = done.is_ok();
        done.map_err(|_| Rejected)?;
        self.near = near;
        Ok(())
    }

    /// The variables, SI, of a point.
    pub(crate) fn design(&self, y: &[f64]) -> Vec<f64> {
        self.evaluator.variables().iter().zip(y).map(|(v, y)| outward(v, *y)).collect()
    }

    /// The unknown that is the half width or the largest value, which comes last.
    fn top(&self) -> Option<usize> {
        matches!(self.step.goal, Goal::HalfWidth | Goal::Largest { .. }).then(|| self.lower.len() - 1)
    }

    fn objective(&self, y: &[f64], gradients: bool, out: &mut Values) {
        let values = &self.evaluation.values;
        let variables = self.evaluator.variables();
        out.gradient.fill(0.0);
        out.objective = 0.0;
        match &self.step.goal {
            Goal::HalfWidth | Goal::Largest { .. } => {
                if let Some(top) = self.top() {
                    out.objective = y[top];
                    out.gradient[top] = 1.0;
                }
            }
            Goal::Variables(weights) => {
                for (index, weight) in weights {
                    out.objective += weight * self.x[*index];
                    out.gradient[*index] += weight * variables[*index].scale();
                }
            }
            Goal::Values(weights) => {
                for (at, weight) in weights {
                    out.objective += weight * values[*at];
                    if gradients {
                        self.add_row(*at, *weight, &mut out.gradient);
                    }
                }
            }
            Goal::Squares { values: range, targets, scale } => {
                for (at, target) in range.clone().zip(targets) {
                    let miss = (values[at] - target) / scale;
                    out.objective += miss * miss;
                    if gradients {
                        self.add_row(at, 2.0 * miss / scale, &mut out.gradient);
                    }
                }
            }
        }
    }

    /// Adds `factor` times the derivatives of a value by the unknowns.
    fn add_row(&self, at: usize, factor: f64, row: &mut [f64]) {
        let variables = self.evaluator.variables();
        let own = &self.evaluation.jacobian[at * variables.len()..(at + 1) * variables.len()];
        for ((sum, derivative), variable) in row.iter_mut().zip(own).zip(variables) {
            *sum += factor * derivative * variable.scale();
        }
    }

    /// The goal at the start, in its own unit, and the largest violation there, relative to the scale of its limit. `None` where they
    /// are not numbers.
    pub(crate) fn standing(&mut self) -> Option<(f64, f64)> {
        let mut out = Values::default();
        let start = self.start.clone();
        self.evaluate(&start, false, &mut out).ok()?;
        let bounds = self.constraint_lower.iter().zip(&self.constraint_upper);
        let violation = out.constraints.iter().zip(bounds).fold(0.0_f64, |m, (v, (l, u))| m.max(l - v).max(v - u));
        Some((out.objective, violation))
    }

    /// Level of a band, its unknown if it is free, and its half width.
    fn band(&self, index: usize, y: &[f64]) -> (f64, Option<usize>, f64) {
        let band = &self.step.bands[index];
        let free = |i: usize| self.step.bands[..i].iter().filter(|b| b.level.is_none()).count();
        let place = self.evaluator.variables().len() + free(index);
        let half_width = band.half_width.or_else(|| self.top().map(|t| y[t])).unwrap_or(0.0);
        match band.level {
            Some(level) => (level, None, half_width),
            None => (y[place] * self.levels[index], Some(place), half_width),
        }
    }
}

/// The bounds of one value of a limit, in its scale, with the reserve inside them.
pub(crate) fn inner_bounds(limit: &Limit, reserve: &Reserve, at: usize) -> [f64; 2] {
    // A bound moves inwards by a part of its own size, or of what is a large change where it is zero.
    let inward = |bound: f64| match bound.abs() {
        f64::INFINITY => 0.0,
        0.0 => reserve.margin * limit.scale + reserve.of_limit(at),
        size => reserve.margin * size + reserve.of_limit(at),
    };
    [(limit.lower + inward(limit.lower)) / limit.scale, (limit.upper - inward(limit.upper)) / limit.scale]
}

/// A variable as a part of its range.
fn inward(variable: &Variable, x: f64) -> f64 {
    (x - variable.nominal) / variable.scale()
}

/// The variable of a part of its range, never outside of it.
fn outward(variable: &Variable, y: f64) -> f64 {
    (variable.nominal + y * variable.scale()).clamp(variable.lower, variable.upper)
}

impl Problem for Posing<'_> {
    fn lower(&self) -> &[f64] {
        &self.lower
    }

    fn upper(&self) -> &[f64] {
        &self.upper
    }

    fn constraint_lower(&self) -> &[f64] {
        &self.constraint_lower
    }

    fn constraint_upper(&self) -> &[f64] {
        &self.constraint_upper
    }

    /// The largest value is subtracted only; the half width is multiplied by levels, which may be free.
    fn is_linear(&self, variable: usize) -> bool {
        let fixed = || self.step.bands.iter().all(|band| band.level.is_some());
        self.top() == Some(variable) && (matches!(self.step.goal, Goal::Largest { .. }) || fixed())
    }

    fn evaluate(&mut self, y: &[f64], gradients: bool, out: &mut Values) -> Result<(), Rejected> {
        let x = self.design(y);
        if !self.current || x != self.x {
            self.x = x;
            self.evaluations += 1;
            self.current = self.evaluator.evaluate(&self.x, false, &mut self.evaluation, &mut self.workspace).is_ok();
            if !self.current {
                return Err(Rejected);
            }
        }
        if gradients {
            self.differentiate()?;
        }
        let unknowns = y.len();
        out.gradient.resize(unknowns, 0.0);
        out.constraints.resize(self.sources.len(), 0.0);
        self.objective(y, gradients, out);
        out.jacobian.clear();
        out.jacobian.resize(if gradients { unknowns * self.sources.len() } else { 0 }, 0.0);
        let mut nothing = Vec::new();
        for (index, source) in self.sources.iter().enumerate() {
            let row = if gradients { &mut out.jacobian[index * unknowns..(index + 1) * unknowns] } else { &mut nothing[..] };
            out.constraints[index] = match *source {
                Source::Limit(limit, at) => {
                    let scale = self.limits[limit].scale;
                    if gradients && self.rows[at] {
                        self.add_row(at, 1.0 / scale, row);
                    }
                    self.evaluation.values[at] / scale
                }
                Source::Band(band, at, side) => {
                    let (level, place, half_width) = self.band(band, y);
                    let (half_width, scale) = (half_width - self.reserve.of_band(at), self.levels[band].abs());
                    if gradients {
                        self.add_row(at, 1.0 / scale, row);
                        if let Some(place) = place {
                            row[place] -= (1.0 + side * half_width) * self.levels[band] / scale;
                        }
                        if self.step.bands[band].half_width.is_none()
                            && let Some(top) = self.top()
                        {
                            row[top] -= side * level / scale;
                        }
                    }
                    (self.evaluation.values[at] - (1.0 + side * half_width) * level) / scale
                }
                Source::Largest(at, side) => {
                    let (Goal::Largest { scale, .. }, Some(top)) = (&self.step.goal, self.top()) else { continue };
                    if gradients {
                        self.add_row(at, side / scale, row);
                        row[top] -= 1.0;
                    }
                    side * self.evaluation.values[at] / scale - y[top]
                }
            };
        }
        let finite = out.objective.is_finite() && out.constraints.iter().chain(&out.jacobian).chain(&out.gradient).all(|v| v.is_finite());
        if finite { Ok(()) } else { Err(Rejected) }
    }
}
