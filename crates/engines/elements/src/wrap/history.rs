//! Loading, unloading and reversal of a drive: Coulomb friction with memory.

use forcewright_base::maths::{exp, exp_m1, ln};
use forcewright_base::quadrature::GaussLegendre;

use super::drive::{Drive, Hold};
use super::field::{Candidates, Field, Probe};
use super::{WrapError, finite, increasing_root};

/// Tension below which a side counts as loose, over the preload: `exp(−27.6)` is 1e-12.
const LOOSE_LOG: f64 = -27.6;

/// Tension above which a side is far from loose, over the preload: `exp(−10)`.
const TAUT_LOG: f64 = -10.0;

/// Cycles after which a loop must have closed.
const LONGEST_SETTLING: usize = 50;

/// Change of the displacement from cycle to cycle at which a loop counts as closed, over its width.
const CLOSED: f64 = 1e-12;

/// How far from the last state a guess may be.
const FARTHEST: f64 = 1.0;

/// How far above a guess the logarithm of a tension is looked for.
const BELIEVED: f64 = 0.5;

/// States that tell where to look for the next.
const TRAIL: usize = 3;

/// Points of the quadrature of the friction work.
const POINTS: usize = 12;

/// A drive that remembers how it was loaded.
#[derive(Clone, Debug)]
pub struct History {
    drive: Drive,
    /// On the output drum, by side.
    outputs: [Field; 2],
    input: Input,
    /// `ln(T/T_p)` in each span.
    logs: [f64; 2],
    /// Elongation of each side against rest, without the slide, m.
    elongations_m: [f64; 2],
    /// How far the cable has slipped over the whole input drum, m.
    slide_m: f64,
    displacement_m: f64,
    friction_j: f64,
    rule: GaussLegendre,
}

/// The cable on the input drum.
#[derive(Clone, Debug)]
enum Input {
    /// One wrap, seen from side 0.
    Shared(Field),
    /// A wrap for each side, seen from its span.
    Split([Field; 2]),
}

/// A state on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Displacement, m.
    pub displacement_m: f64,
    /// Tension of side 0 less that of side 1, N.
    pub force_n: f64,
    /// Tension in the free spans, N.
    pub tensions_n: [f64; 2],
    /// Angle that slipped in this step, of each side on the output and on the input drum, rad.
    pub slipped_rad: [[f64; 2]; 2],
    /// Whether slip reached the end of a wrap of each side on the output and on the input drum.
    pub at_end: [[bool; 2]; 2],
    /// `dF/dx` if the step went on in its direction, N/m; at rest and right after a reversal that of the spans.
    pub tangent_n_per_m: f64,
    /// Whether the cable slipped over the whole input drum.
    pub gross_slip: bool,
    /// Whether a side lost its tension (below 1e-12 of the preload).
    pub loose: bool,
}

/// A closed loop between a force and its opposite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// Displacements at the largest and at the smallest force, m.
    pub displacements_m: [f64; 2],
    /// Displacement at zero force after the largest less that after the smallest force, m.
    pub lost_motion_m: f64,
    /// Energy that friction takes in one cycle, J.
    pub lost_j: f64,
    /// Cycles until the loop closed.
    pub cycles: usize,
}

/// Candidate tensions of a side, prepared for a step.
struct Ahead<'a> {
    wraps: [Candidates<'a>; 2],
    from: f64,
    /// `T/T_p` where the step begins.
    from_ratio: f64,
    elongation_m: f64,
    span_m: f64,
}

/// A side with a candidate tension.
struct There {
    /// Tension over the preload.
    ratio: f64,
    /// Elongation against rest, m.
    elongation_m: f64,
    /// Its derivative by the logarithm of the tension, m.
    per_log_m: f64,
    /// On the output and on the input drum.
    probes: [Probe; 2],
}

impl Ahead<'_> {
    fn at(&self, log: f64) -> There {
        let ratio = exp(log);
        let probes = [self.wraps[0].probe(log, ratio), self.wraps[1].probe(log, ratio)];
        // Factored by the smaller tension, so that small steps keep their digits.
        let span_m = self.span_m * self.from_ratio * exp_m1(log - self.from);
        let drums_m = probes[0].elongation_m + probes[1].elongation_m;
        let per_log_m = probes[0].per_log_m + probes[1].per_log_m + self.span_m * ratio;
        There { ratio, elongation_m: self.elongation_m + span_m + drums_m, per_log_m, probes }
    }

    /// Elongation with a logarithm of the tension, and its derivative.
    fn elongation_m(&self, log: f64) -> (f64, f64) {
        let there = self.at(log);
        (there.elongation_m, there.per_log_m)
    }

    /// The logarithm of the tension at which the side has an elongation; the loosest if there is none.
    ///
    /// `guess` is where it may be; it changes the last digit only.
    fn log_at(&self, elongation_m: f64, guess: Option<f64>) -> f64 {
        let missing_m = elongation_m - self.elongation_m;
        if missing_m == 0.0 {
            return self.from;
        }
        // The span alone gives the largest change of the tension.
        let bound = self.from_ratio + missing_m / self.span_m;
        let root = |low: f64, high: f64, start: f64| increasing_root(|log| self.missing(log, elongation_m), low, high, start);
        if missing_m < 0.0 {
            // With a guess well inside, the side is not loose.
            if guess.is_none_or(|log| log < TAUT_LOG) && self.elongation_m(LOOSE_LOG).0 >= elongation_m {
                return LOOSE_LOG;
            }
            let start = guess.unwrap_or_else(|| if bound > 0.0 { ln(bound) } else { 0.5 * (LOOSE_LOG + self.from) });
            return root(LOOSE_LOG, self.from, start);
        }
        // From far above the root Newton's method comes down by one at a time, so a guess is believed a little way around itself only.
        if let Some(near) = guess.map(|log| log + BELIEVED).filter(|near| *near > self.from) {
            let found = root(self.from, near, near - BELIEVED);
            if found < near - 0.1 * BELIEVED {
                return found;
            }
        }
        root(self.from, ln(bound), ln(bound))
    }

    fn missing(&self, log: f64, elongation_m: f64) -> (f64, f64) {
        let (there_m, slope_m) = self.elongation_m(log);
        (there_m - elongation_m, slope_m)
    }
}

/// A state that a branch has passed.
struct Passed {
    displacement_m: f64,
    /// `ln(T/T_p)` of both sides.
    logs: [f64; 2],
    /// Their derivatives by the displacement, 1/m.
    slopes: [f64; 2],
}

/// Where the polynomial through states and their slopes (Hermite's) has the logarithms of the tensions at a displacement, m.
fn ahead_of(passed: &[Passed], displacement_m: f64) -> [f64; 2] {
    let mut logs = [0.0; 2];
    for (i, state) in passed.iter().enumerate() {
        let (mut basis, mut slope) = (1.0, 0.0);
        for (_, other) in passed.iter().enumerate().filter(|(j, _)| *j != i) {
            let per_gap = 1.0 / (state.displacement_m - other.displacement_m);
            basis *= (displacement_m - other.displacement_m) * per_gap;
            slope += per_gap;
        }
        let step_m = displacement_m - state.displacement_m;
        for (k, log) in logs.iter_mut().enumerate() {
            *log += basis * basis * ((1.0 - 2.0 * slope * step_m) * state.logs[k] + step_m * state.slopes[k]);
        }
    }
    logs
}

/// What can be loaded again and again until its loop closes.
pub(super) trait Loaded {
    /// Loads to a force, N, in one step without a reversal: the displacement there, m.
    fn loaded_m(&mut self, force_n: f64) -> Result<f64, WrapError>;
    /// Energy that friction took so far, J.
    fn lost_j(&self) -> f64;
}

impl Loaded for History {
    fn loaded_m(&mut self, force_n: f64) -> Result<f64, WrapError> {
        Ok(self.load_to(force_n)?.displacement_m)
    }

    fn lost_j(&self) -> f64 {
        self.friction_j
    }
}

/// The closed loop between a force and its opposite, from the present state on.
pub(super) fn settled(cables: &mut impl Loaded, force_n: f64) -> Result<Cycle, WrapError> {
    super::positive("force_n", force_n)?;
    let mut last = cables.loaded_m(force_n)?;
    for cycles in 1..=LONGEST_SETTLING {
        let before_j = cables.lost_j();
        let down_m = cables.loaded_m(0.0)?;
        let lowest_m = cables.loaded_m(-force_n)?;
        let up_m = cables.loaded_m(0.0)?;
        let highest_m = cables.loaded_m(force_n)?;
        if (highest_m - last).abs() <= CLOSED * (highest_m - lowest_m).abs() || cycles == LONGEST_SETTLING {
            let lost_j = cables.lost_j() - before_j;
            return Ok(Cycle { displacements_m: [highest_m, lowest_m], lost_motion_m: down_m - up_m, lost_j, cycles });
        }
        last = highest_m;
    }
    Err(WrapError::Value { name: "force_n", value: force_n })
}

impl History {
    /// A drive at rest.
    ///
    /// # Errors
    /// [`WrapError::EndlessWrap`] if a wrap is infinite, or so long that `exp(μΘ)` passes `exp(600)`.
    ///
    /// ```
    /// use forcewright_elements::wrap::{Drive, DriveSpec, Drum, History, Hold};
    ///
    /// let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    /// let drive = Drive::new(&DriveSpec {
    ///     input: drum(0.01), output: drum(0.05), hold: Hold::Friction { wrap_rad: 24.3 }, output_wraps_rad: [20.0; 2],
    ///     spans_m: [0.025; 2], axial_stiffness_n: 50e3, preload_n: 200.0,
    /// })
    /// .expect("a drive");
    /// let mut history = History::new(&drive).expect("finite wraps");
    /// let loaded = history.load_to(100.0).expect("held");
    /// // Without force again, some of the displacement stays.
    /// let left = history.load_to(0.0).expect("held").displacement_m / loaded.displacement_m;
    /// assert!(left > 0.05 && left < 0.5);
    /// ```
    pub fn new(drive: &Drive) -> Result<Self, WrapError> {
        let spec = drive.spec();
        let field = |drum: super::Drum, wrap_rad: f64| {
            let short = drum.friction * wrap_rad < super::drive::ENDLESS;
            let at_rest = || Field::at_rest(drum.radius_m, drum.friction, wrap_rad, spec.axial_stiffness_n, spec.preload_n);
            short.then(at_rest).ok_or(WrapError::EndlessWrap)
        };
        let [first_rad, second_rad] = spec.output_wraps_rad;
        let input = match spec.hold {
            Hold::Friction { wrap_rad } => Input::Shared(field(spec.input, wrap_rad)?),
            Hold::Fixed { wraps_rad } => Input::Split([field(spec.input, wraps_rad[0])?, field(spec.input, wraps_rad[1])?]),
        };
        Ok(Self {
            outputs: [field(spec.output, first_rad)?, field(spec.output, second_rad)?],
            input,
            drive: *drive,
            logs: [0.0; 2],
            elongations_m: [0.0; 2],
            slide_m: 0.0,
            displacement_m: 0.0,
            friction_j: 0.0,
            rule: GaussLegendre::new(POINTS),
        })
    }

    /// Displacement reached, m.
    pub fn displacement_m(&self) -> f64 {
        self.displacement_m
    }

    /// Energy that friction took so far, J.
    pub fn friction_j(&self) -> f64 {
        self.friction_j
    }

    /// Elastic energy of the cable, with that of the preload, J.
    pub fn elastic_j(&self) -> f64 {
        let spec = self.drive.spec();
        let drums: f64 = match &self.input {
            Input::Shared(field) => field.energy_j(),
            Input::Split(fields) => fields.iter().map(Field::energy_j).sum(),
        };
        let spans: f64 = (0..2)
            .map(|k| {
                let tension_n = spec.preload_n * exp(self.logs[k]);
                0.5 * tension_n * tension_n * spec.spans_m[k] / spec.axial_stiffness_n
            })
            .sum();
        drums + spans + self.outputs.iter().map(Field::energy_j).sum::<f64>()
    }

    /// Tension of a side (0 or 1) on the output drum at an angle from its span, N.
    pub fn output_tension_n(&self, side: usize, angle_rad: f64) -> f64 {
        self.outputs[side.min(1)].tension_n(angle_rad)
    }

    /// Tension on the input drum at an angle from the span of a side (0 or 1), N.
    pub fn input_tension_n(&self, side: usize, angle_rad: f64) -> f64 {
        match (&self.input, side) {
            (Input::Shared(field), 0) => field.tension_n(angle_rad),
            (Input::Shared(field), _) => field.turned().tension_n(angle_rad),
            (Input::Split(fields), _) => fields[side.min(1)].tension_n(angle_rad),
        }
    }

    /// Pieces of the tension fields, over all drums: a measure of what is remembered.
    pub fn zones(&self) -> usize {
        let input = match &self.input {
            Input::Shared(field) => field.knots().len(),
            Input::Split(fields) => fields.iter().map(|field| field.knots().len()).sum(),
        };
        input + self.outputs.iter().map(|field| field.knots().len()).sum::<usize>()
    }

    /// The next state, in one step without a reversal, at a displacement, m. Beyond gross slip the cable slides.
    ///
    /// # Errors
    /// [`WrapError::Value`] for a displacement that is not finite.
    ///
    /// ```
    /// # use forcewright_elements::wrap::{Drive, DriveSpec, Drum, History, Hold};
    /// # let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    /// # let drive = Drive::new(&DriveSpec {
    /// #     input: drum(0.01), output: drum(0.05), hold: Hold::Friction { wrap_rad: 24.3 }, output_wraps_rad: [20.0; 2],
    /// #     spans_m: [0.025; 2], axial_stiffness_n: 50e3, preload_n: 200.0,
    /// # }).expect("a drive");
    /// let mut history = History::new(&drive).expect("finite wraps");
    /// history.move_to(100e-6).expect("finite");
    /// // Back at the start the cable pulls the other way.
    /// assert!(history.move_to(0.0).expect("finite").force_n < 0.0 && history.friction_j() > 0.0);
    /// ```
    pub fn move_to(&mut self, displacement_m: f64) -> Result<Step, WrapError> {
        finite("displacement_m", displacement_m)?;
        let inputs = self.inputs();
        let sides = self.ahead(&inputs);
        let (step, Passed { logs, .. }) = self.step_to(&sides, displacement_m, [None; 2]);
        let slide_m = if step.gross_slip { displacement_m - sides[0].elongation_m(logs[0]).0 - self.slide_m } else { 0.0 };
        self.friction_j += slide_m.abs() * step.force_n.abs();
        self.slide_m += slide_m;
        self.take(logs, displacement_m, &inputs);
        Ok(step)
    }

    /// The states that one step would reach, without a reversal, at each of some displacements, m; the drive stays as it is. What lies
    /// between two turning points of a loop.
    ///
    /// # Errors
    /// [`WrapError::Value`] for a displacement that is not finite.
    ///
    /// ```
    /// # use forcewright_elements::wrap::{Drive, DriveSpec, Drum, History, Hold};
    /// # let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    /// # let drive = Drive::new(&DriveSpec {
    /// #     input: drum(0.01), output: drum(0.05), hold: Hold::Friction { wrap_rad: 24.3 }, output_wraps_rad: [20.0; 2],
    /// #     spans_m: [0.025; 2], axial_stiffness_n: 50e3, preload_n: 200.0,
    /// # }).expect("a drive");
    /// let mut history = History::new(&drive).expect("finite wraps");
    /// let ahead = history.along(&[50e-6, 100e-6]).expect("finite");
    /// let there = history.move_to(100e-6).expect("finite");
    /// assert!((ahead[1].force_n / there.force_n - 1.0).abs() < 1e-12);
    /// ```
    pub fn along(&self, displacements_m: &[f64]) -> Result<Vec<Step>, WrapError> {
        let inputs = self.inputs();
        let sides = self.ahead(&inputs);
        let mut steps: Vec<Step> = Vec::with_capacity(displacements_m.len());
        // Places are mostly given in their order: the tensions at the last few and their slopes tell where to look for the next.
        let mut passed: Vec<Passed> = Vec::with_capacity(TRAIL + 1);
        for displacement_m in displacements_m {
            finite("displacement_m", *displacement_m)?;
            let guess = match passed.as_slice() {
                [.., there] if passed.len() > 1 => {
                    let ahead = ahead_of(&passed, *displacement_m);
                    // Beyond that the polynomial of the last few is a fancy.
                    [0, 1].map(|k| Some(ahead[k]).filter(|log| (log - there.logs[k]).abs() <= FARTHEST))
                }
                _ => [None; 2],
            };
            let (step, here) = self.step_to(&sides, *displacement_m, guess);
            steps.push(step);
            if step.gross_slip || step.loose {
                passed.clear();
                continue;
            }
            if passed.len() == TRAIL {
                passed.remove(0);
            }
            passed.push(here);
        }
        Ok(steps)
    }

    /// The step to a displacement, m, and the logarithms of its tensions.
    fn step_to(&self, sides: &[Ahead<'_>; 2], displacement_m: f64, guess: [Option<f64>; 2]) -> (Step, Passed) {
        let wanted_m = displacement_m - self.slide_m;
        let mut logs = [sides[0].log_at(wanted_m, guess[0]), sides[1].log_at(-wanted_m, guess[1])];
        let over = (logs[0] - logs[1]).abs() > self.shared();
        if over {
            logs = self.slipping(sides, logs[0] > logs[1], logs);
        }
        let ends = [sides[0].at(logs[0]), sides[1].at(logs[1])];
        let slopes = [1.0 / ends[0].per_log_m, -1.0 / ends[1].per_log_m];
        (self.report(&ends, logs, displacement_m, over), Passed { displacement_m, logs, slopes })
    }

    /// The next state, in one step without a reversal, under a force, N.
    ///
    /// # Errors
    /// [`WrapError::GrossSlip`] beyond what friction holds now; the state stays as it was. [`WrapError::Value`] for a force that is not
    /// finite.
    pub fn load_to(&mut self, force_n: f64) -> Result<Step, WrapError> {
        finite("force_n", force_n)?;
        let inputs = self.inputs();
        let sides = self.ahead(&inputs);
        let logs = self.logs_under(&sides, force_n);
        if (logs[0] - logs[1]).abs() > self.shared() {
            let [a, b] = self.slipping(&sides, force_n > 0.0, logs).map(|log| self.drive.spec().preload_n * exp(log));
            return Err(WrapError::GrossSlip { capacity_n: (a - b).abs() });
        }
        // A loose side gives no displacement.
        let (firm, sign) = if logs[0] >= logs[1] { (0, 1.0) } else { (1, -1.0) };
        let displacement_m = self.slide_m + sign * sides[firm].elongation_m(logs[firm]).0;
        let step = Step { force_n, ..self.report(&[sides[0].at(logs[0]), sides[1].at(logs[1])], logs, displacement_m, false) };
        self.take(logs, displacement_m, &inputs);
        Ok(step)
    }

    /// The closed loop between a force (N, above 0) and its opposite, from the present state on. It takes a few cycles to close: the first
    /// loading leaves a trace.
    ///
    /// # Errors
    /// [`WrapError::GrossSlip`] beyond what friction holds, [`WrapError::Value`] if the force is not above 0.
    ///
    /// ```
    /// # use forcewright_elements::wrap::{Drive, DriveSpec, Drum, History, Hold};
    /// # let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    /// # let drive = Drive::new(&DriveSpec {
    /// #     input: drum(0.01), output: drum(0.05), hold: Hold::Friction { wrap_rad: 24.3 }, output_wraps_rad: [20.0; 2],
    /// #     spans_m: [0.025; 2], axial_stiffness_n: 50e3, preload_n: 200.0,
    /// # }).expect("a drive");
    /// let cycle = History::new(&drive).expect("finite wraps").cycle(40.0).expect("held");
    /// // With q = F/2: (r₁ + r₂) q²/(2 μ AE T_p).
    /// assert!((cycle.lost_motion_m / (0.06 * 400.0 / (2.0 * 0.15 * 50e3 * 200.0)) - 1.0).abs() < 0.02);
    /// ```
    pub fn cycle(&mut self, force_n: f64) -> Result<Cycle, WrapError> {
        settled(self, force_n)
    }

    fn shared(&self) -> f64 {
        match self.drive.spec().hold {
            Hold::Friction { wrap_rad } => self.drive.spec().input.friction * wrap_rad,
            Hold::Fixed { .. } => f64::INFINITY,
        }
    }

    /// The input drum as each side sees it.
    fn inputs(&self) -> [Field; 2] {
        match &self.input {
            Input::Shared(field) => [field.clone(), field.turned()],
            Input::Split(fields) => fields.clone(),
        }
    }

    fn ahead<'a>(&'a self, inputs: &'a [Field; 2]) -> [Ahead<'a>; 2] {
        let spec = self.drive.spec();
        [0, 1].map(|k| Ahead {
            wraps: [self.outputs[k].candidates(), inputs[k].candidates()],
            from: self.logs[k],
            from_ratio: exp(self.logs[k]),
            elongation_m: self.elongations_m[k],
            span_m: spec.preload_n * spec.spans_m[k] / spec.axial_stiffness_n,
        })
    }

    /// Tensions on the verge of gross slip: their ratio is given, and the cable as a whole is as long as before.
    fn slipping(&self, sides: &[Ahead<'_>; 2], first_is_taut: bool, logs: [f64; 2]) -> [f64; 2] {
        let (taut, slack) = if first_is_taut { (0, 1) } else { (1, 0) };
        let value = |log: f64| {
            let (a, b) = (sides[taut].elongation_m(log + self.shared()), sides[slack].elongation_m(log));
            (a.0 + b.0, a.1 + b.1)
        };
        let (low, high) = (logs[slack].min(logs[taut] - self.shared()), logs[slack].max(logs[taut] - self.shared()));
        let log = increasing_root(value, low, high, 0.5 * (low + high));
        let mut found = [log; 2];
        found[taut] = log + self.shared();
        found
    }

    /// Tensions with a given difference when the cable as a whole is as long as before.
    fn logs_under(&self, sides: &[Ahead<'_>; 2], force_n: f64) -> [f64; 2] {
        let (taut, slack) = if force_n < 0.0 { (1, 0) } else { (0, 1) };
        let ratio = force_n.abs() / self.drive.spec().preload_n;
        let value = |log: f64| {
            let tight = exp(log) + ratio;
            let (a, b) = (sides[taut].elongation_m(ln(tight)), sides[slack].elongation_m(log));
            (a.0 + b.0, a.1 * exp(log) / tight + b.1)
        };
        let mut high = 1.0;
        while value(high).0 < 0.0 && high < super::drive::ENDLESS {
            high *= 2.0;
        }
        let log = increasing_root(value, LOOSE_LOG, high, self.logs[slack]);
        let mut found = [log; 2];
        found[taut] = if ratio == 0.0 { log } else { ln(exp(log) + ratio) };
        found
    }

    fn report(&self, ends: &[There; 2], logs: [f64; 2], displacement_m: f64, gross_slip: bool) -> Step {
        let preload_n = self.drive.spec().preload_n;
        let tensions_n = [0, 1].map(|k| preload_n * ends[k].ratio);
        let stiffness = |k: usize| tensions_n[k] / ends[k].per_log_m;
        let firm = |k: usize| logs[k] > LOOSE_LOG + 1e-9;
        Step {
            displacement_m,
            force_n: tensions_n[0] - tensions_n[1],
            tensions_n,
            slipped_rad: [0, 1].map(|k| ends[k].probes.map(|probe| probe.front_rad)),
            at_end: [0, 1].map(|k| ends[k].probes.map(|probe| probe.at_end)),
            tangent_n_per_m: if gross_slip { 0.0 } else { (0..2).filter(|&k| firm(k)).map(stiffness).sum() },
            gross_slip,
            loose: !(firm(0) && firm(1)),
        }
    }

    fn take(&mut self, logs: [f64; 2], displacement_m: f64, inputs: &[Field; 2]) {
        self.elongations_m = {
            let sides = self.ahead(inputs);
            [0, 1].map(|k| sides[k].elongation_m(logs[k]).0)
        };
        for (output, log) in self.outputs.iter_mut().zip(logs) {
            self.friction_j += output.apply(log, &self.rule);
        }
        match &mut self.input {
            Input::Shared(field) => {
                self.friction_j += field.apply(logs[0], &self.rule);
                let mut other = field.turned();
                self.friction_j += other.apply(logs[1], &self.rule);
                *field = other.turned();
            }
            Input::Split(fields) => {
                for (field, log) in fields.iter_mut().zip(logs) {
                    self.friction_j += field.apply(log, &self.rule);
                }
            }
        }
        self.logs = logs;
        self.displacement_m = displacement_m;
    }
}
