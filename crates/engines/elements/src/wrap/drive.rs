//! A cable between two drums, loaded once from its preload.

use forcewright_base::maths::{exp_m1, ln_1p};
use forcewright_base::roots;

use super::{Free, Slip, Wrap, WrapError, Zone, finite, increasing_root, log_excess, positive, positive_or_infinite};

/// A drum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drum {
    /// Radius to the middle of the cable, m; above 0.
    pub radius_m: f64,
    /// Coefficient of friction of the cable on it, with the effect of a groove; above 0.
    pub friction: f64,
}

/// How the cable is held on the input drum, from which both sides leave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    /// By friction over one wrap that both sides share; the cable slips where their zones meet.
    Friction {
        /// Angle of the wrap, rad; above 0, may be infinite.
        wrap_rad: f64,
    },
    /// Fastened in between, with a wrap of its own for each side.
    Fixed {
        /// Angle from the span to the fastening of each side, rad; above 0, may be infinite.
        wraps_rad: [f64; 2],
    },
}

/// A cable that runs from a termination on the output drum over a free span to the input drum, and back to a second termination.
///
/// Side 0 is the one that a positive force tightens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveSpec {
    /// Input drum.
    pub input: Drum,
    /// Output drum.
    pub output: Drum,
    /// How the cable is held on the input drum.
    pub hold: Hold,
    /// Angle on the output drum from the span to the termination of each side, rad; above 0, may be infinite.
    pub output_wraps_rad: [f64; 2],
    /// Length of the free span of each side, m; above 0.
    pub spans_m: [f64; 2],
    /// Axial stiffness AE of the cable, N; above 0.
    pub axial_stiffness_n: f64,
    /// Tension at rest, the same everywhere, N; above 0.
    pub preload_n: f64,
}

/// One of the two shafts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shaft {
    /// Of the input drum, the output held.
    Input,
    /// Of the output drum, the input held.
    Output,
}

/// A state of a drive that was loaded from rest, in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Displacement between the circumferences of the drums that both sides share, m.
    pub displacement_m: f64,
    /// Tension of side 0 less that of side 1, N: torque over the radius of a drum.
    pub force_n: f64,
    /// Tension in the free span of each side, N.
    pub tensions_n: [f64; 2],
    /// Slip angles of each side on the output and on the input drum, rad. In the paper's names, for a positive force: `θ_s1`, `θ_s2` of
    /// side 0, `θ_s4`, `θ_s3` of side 1. Infinite on an endless wrap without tension.
    pub slip_rad: [[f64; 2]; 2],
    /// Where slip reaches the end of the wrap: the termination, or the fastening on the input drum. Stiffer than the paper's formulas.
    pub at_end: [[bool; 2]; 2],
    /// `dF/dx`, N/m, for a force that grows further.
    pub tangent_n_per_m: f64,
    /// `F/x`, N/m; the initial stiffness at rest.
    pub secant_n_per_m: f64,
    /// Whether the cable slips on the whole of the input drum.
    pub gross_slip: bool,
    /// Whether the slack side carries no tension.
    pub loose: bool,
}

/// The paper's state: both sides change their tension by half of the force, so that their displacements differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperState {
    /// Tensions of the taut and of the slack side, N.
    pub tensions_n: [f64; 2],
    /// Slip angles `θ_s1` … `θ_s4`, rad. Eqs. (10) to (13).
    pub slip_rad: [f64; 4],
    /// Elongations `δ_1` … `δ_4`, m; those of the slack side are negative. Eqs. (18) to (21).
    pub elongations_m: [f64; 4],
    /// Displacements that the taut and the slack side would need, with the free spans, m.
    pub displacements_m: [f64; 2],
    /// K of eq. (30), N/m; a tangent stiffness.
    pub stiffness_n_per_m: f64,
    /// `F/K`, m: the paper's displacement, which takes K for a secant. Eq. (34).
    pub displacement_m: f64,
}

/// What friction on the input drum can hold in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capacity {
    /// Force at which the cable begins to slip as a whole, N.
    pub force_n: f64,
    /// Displacement there, m.
    pub displacement_m: f64,
    /// Taut and slack tension there, N; their ratio is `exp(μΘ)`.
    pub tensions_n: [f64; 2],
}

/// Wraps that hold more than `exp(600)` count as endless: neither tension could be written down.
pub(super) const ENDLESS: f64 = 600.0;

/// A drive prepared for many states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    spec: DriveSpec,
    sides: [Side; 2],
    /// `μΘ` of the wrap that both sides share; infinite where none is.
    shared: f64,
    /// For positive and negative forces.
    capacities: [Option<Capacity>; 2],
}

/// One side: its span and its zones on the output and on the input drum.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side {
    preload_n: f64,
    span_m_per_n: f64,
    zones: [Zone; 2],
    frictions: [f64; 2],
}

/// Where a side is.
#[derive(Clone, Copy)]
struct Reached {
    tension_n: f64,
    /// Size of its change from the preload: keeps the digits that the tension of a small force loses.
    change_n: f64,
    displacement_m: f64,
    compliance_m_per_n: f64,
    /// `|ln(T/T_p)|`.
    log: f64,
}

impl Side {
    /// With a tension of `gain_n` above the preload.
    fn taut(&self, gain_n: f64) -> Reached {
        let u = gain_n / self.preload_n;
        let log = ln_1p(u);
        self.reached(gain_n, self.preload_n + gain_n, &Free { change_n: gain_n, log, excess: log_excess(u, log) })
    }

    /// With the tension `T_p exp(−log)`.
    fn slack(&self, log: f64) -> Reached {
        let u = exp_m1(-log);
        let change_n = self.preload_n * u;
        self.reached(-change_n, self.preload_n * (1.0 + u), &Free { change_n, log: -log, excess: log_excess(u, -log) })
    }

    fn reached(&self, change_n: f64, tension_n: f64, free: &Free) -> Reached {
        let mut displacement_m = self.span_m_per_n * change_n;
        let mut compliance_m_per_n = self.span_m_per_n;
        for zone in &self.zones {
            displacement_m += zone.elongation_m(self.preload_n, tension_n, free);
            compliance_m_per_n += zone.compliance_m_per_n(tension_n, free);
        }
        Reached { tension_n, change_n, displacement_m, compliance_m_per_n, log: free.log.abs() }
    }

    /// Displacement at which no tension is left; infinite with an endless wrap.
    fn loose_m(&self) -> f64 {
        self.preload_n * (self.span_m_per_n + self.zones.iter().map(|zone| zone.reach_m_per_n * zone.limit).sum::<f64>())
    }

    /// A logarithm of the slack tension with a larger displacement than this one.
    fn largest_log(&self, displacement_m: f64) -> f64 {
        let endless_m_per_n: f64 = self.zones.iter().filter(|zone| zone.limit.is_infinite()).map(|zone| zone.reach_m_per_n).sum();
        // On an endless wrap the displacement is at least r/(μAE) T_p (ln(T_p/T) − 1); with ends, the tension underflows first.
        if endless_m_per_n > 0.0 { 1.0 + displacement_m / (endless_m_per_n * self.preload_n) } else { 745.0 }
    }

    /// Coefficient of the square in the displacement for small changes of the tension.
    fn curvature_m_per_n2(&self) -> f64 {
        self.zones.iter().map(|zone| zone.reach_m_per_n).sum::<f64>() / (2.0 * self.preload_n)
    }

    /// Change of the tension at a displacement if zones were parabolas.
    fn first_change_n(&self, displacement_m: f64) -> f64 {
        let (half, c) = (0.5 * self.span_m_per_n, self.curvature_m_per_n2());
        displacement_m / (half + (half * half + c * displacement_m).sqrt())
    }

    fn taut_at(&self, displacement_m: f64) -> Reached {
        let value = |gain_n: f64| {
            let at = self.taut(gain_n);
            (at.displacement_m - displacement_m, at.compliance_m_per_n)
        };
        self.taut(increasing_root(value, 0.0, displacement_m / self.span_m_per_n, self.first_change_n(displacement_m)))
    }

    fn slack_at(&self, displacement_m: f64) -> Option<Reached> {
        if displacement_m >= self.loose_m() {
            return None;
        }
        let value = |log: f64| {
            let at = self.slack(log);
            (at.displacement_m - displacement_m, at.compliance_m_per_n * at.tension_n)
        };
        let start = first_log(self.first_change_n(displacement_m) / self.preload_n);
        Some(self.slack(increasing_root(value, 0.0, self.largest_log(displacement_m), start)))
    }

    fn slip_rad(&self, log: f64) -> ([f64; 2], [bool; 2]) {
        let angle = |k: usize| log.min(self.zones[k].limit) / self.frictions[k];
        ([angle(0), angle(1)], [log >= self.zones[0].limit, log >= self.zones[1].limit])
    }
}

/// `−ln(1 − u)` kept finite.
fn first_log(u: f64) -> f64 {
    -ln_1p(-u.min(0.95))
}

impl DriveSpec {
    fn checked(&self) -> Result<(), WrapError> {
        for drum in [self.input, self.output] {
            positive("radius_m", drum.radius_m)?;
            positive("friction", drum.friction)?;
        }
        match self.hold {
            Hold::Friction { wrap_rad } => positive_or_infinite("wrap_rad", wrap_rad)?,
            Hold::Fixed { wraps_rad } => wraps_rad.iter().try_for_each(|&wrap_rad| positive_or_infinite("wraps_rad", wrap_rad))?,
        }
        self.output_wraps_rad.iter().try_for_each(|&wrap_rad| positive_or_infinite("output_wraps_rad", wrap_rad))?;
        self.spans_m.iter().try_for_each(|&span_m| positive("spans_m", span_m))?;
        positive("axial_stiffness_n", self.axial_stiffness_n)?;
        positive("preload_n", self.preload_n)
    }

    fn side(&self, side: usize) -> Side {
        let input_rad = match self.hold {
            // Where the zones of the two sides meet, gross slip begins: neither sees an end before.
            Hold::Friction { .. } => f64::INFINITY,
            Hold::Fixed { wraps_rad } => wraps_rad[side],
        };
        let zone = |drum: Drum, wrap_rad: f64| {
            let wrap_rad = if drum.friction * wrap_rad < ENDLESS { wrap_rad } else { f64::INFINITY };
            Zone::new(&Wrap { radius_m: drum.radius_m, friction: drum.friction, wrap_rad, axial_stiffness_n: self.axial_stiffness_n })
        };
        Side {
            preload_n: self.preload_n,
            span_m_per_n: self.spans_m[side] / self.axial_stiffness_n,
            zones: [zone(self.output, self.output_wraps_rad[side]), zone(self.input, input_rad)],
            frictions: [self.output.friction, self.input.friction],
        }
    }
}

impl Drive {
    /// A drive of these numbers.
    ///
    /// # Errors
    /// [`WrapError::Value`]
    pub fn new(spec: &DriveSpec) -> Result<Self, WrapError> {
        spec.checked()?;
        let shared = match spec.hold {
            Hold::Friction { wrap_rad } if spec.input.friction * wrap_rad < ENDLESS => spec.input.friction * wrap_rad,
            _ => f64::INFINITY,
        };
        let mut drive = Self { spec: *spec, sides: [spec.side(0), spec.side(1)], shared, capacities: [None; 2] };
        drive.capacities = [drive.capacity_of(0), drive.capacity_of(1)];
        Ok(drive)
    }

    /// The numbers it was made of.
    pub fn spec(&self) -> &DriveSpec {
        &self.spec
    }

    /// Gross slip when side `taut` tightens: `x_taut = x_slack` and `T_taut/T_slack = exp(μΘ)`.
    fn capacity_of(&self, taut: usize) -> Option<Capacity> {
        if self.shared.is_infinite() {
            return None;
        }
        let (tight, slack) = (&self.sides[taut], &self.sides[1 - taut]);
        let reached = |log: f64| (tight.taut(self.spec.preload_n * exp_m1(log)), slack.slack(self.shared - log));
        let excess_m = |log: f64| {
            let (a, b) = reached(log);
            a.displacement_m - b.displacement_m
        };
        let log = roots::root(excess_m, 0.0, self.shared, 1e-15 * self.shared).ok()?;
        let (a, b) = reached(log);
        let tensions_n = [a.tension_n, b.tension_n];
        Some(Capacity { force_n: a.change_n + b.change_n, displacement_m: a.displacement_m, tensions_n })
    }

    /// Gross slip of the cable on the input drum when side 0 tightens, and when side 1 does; absent where it is fastened or its wrap
    /// endless. The paper's tensions would give `2 T_p tanh(μΘ/2)`, which is less.
    ///
    /// ```
    /// # use forcewright_elements::wrap::{Drive, DriveSpec, Drum, Hold};
    /// # let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    /// let spec = DriveSpec {
    ///     input: drum(0.01), output: drum(0.05), hold: Hold::Friction { wrap_rad: 5.4936 }, output_wraps_rad: [f64::INFINITY; 2],
    ///     spans_m: [0.025; 2], axial_stiffness_n: 50e3, preload_n: 200.0,
    /// };
    /// let capacity = Drive::new(&spec).expect("a drive").capacities()[0].expect("held by friction");
    /// assert!((capacity.force_n - 163.6).abs() < 0.1);
    /// ```
    pub fn capacities(&self) -> [Option<Capacity>; 2] {
        self.capacities
    }

    /// `AE/L_f` of both spans, N/m: the stiffness at rest, and a bound for any friction.
    pub fn initial_n_per_m(&self) -> f64 {
        self.sides.iter().map(|side| 1.0 / side.span_m_per_n).sum()
    }

    /// Torsional stiffness at a shaft for a stiffness along the cable, `K r²`, N·m/rad. Eq. (36).
    ///
    /// ```
    /// # use forcewright_elements::wrap::{Drive, DriveSpec, Drum, Hold, Shaft};
    /// # let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    /// # let spec = DriveSpec {
    /// #     input: drum(0.01), output: drum(0.05), hold: Hold::Friction { wrap_rad: 24.3 }, output_wraps_rad: [f64::INFINITY; 2],
    /// #     spans_m: [0.025; 2], axial_stiffness_n: 50e3, preload_n: 200.0,
    /// # };
    /// let drive = Drive::new(&spec).expect("a drive");
    /// assert!((drive.torsional_nm_per_rad(4e6, Shaft::Output) - 1e4).abs() < 1e-9);
    /// ```
    pub fn torsional_nm_per_rad(&self, stiffness_n_per_m: f64, shaft: Shaft) -> f64 {
        let radius_m = match shaft {
            Shaft::Input => self.spec.input.radius_m,
            Shaft::Output => self.spec.output.radius_m,
        };
        stiffness_n_per_m * radius_m * radius_m
    }

    /// The state under a force (N; torque over the radius of its drum; negative when side 1 tightens).
    ///
    /// # Errors
    /// [`WrapError::GrossSlip`] beyond what friction holds, [`WrapError::Value`] for a force that is not finite.
    pub fn at_force(&self, force_n: f64) -> Result<State, WrapError> {
        finite("force_n", force_n)?;
        let (taut, size_n) = (usize::from(force_n < 0.0), force_n.abs());
        if let Some(capacity) = self.capacities[taut].filter(|capacity| size_n > capacity.force_n) {
            return Err(WrapError::GrossSlip { capacity_n: capacity.force_n });
        }
        let (tight, slack) = (&self.sides[taut], &self.sides[1 - taut]);
        let preload_n = self.spec.preload_n;
        let alone = tight.taut((size_n - preload_n).max(0.0));
        if size_n > preload_n && alone.displacement_m >= slack.loose_m() {
            return Ok(self.state(taut, force_n, &alone, None));
        }
        let gain_n = |log: f64| (size_n + preload_n * exp_m1(-log)).max(0.0);
        let value = |log: f64| {
            let (a, b) = (tight.taut(gain_n(log)), slack.slack(log));
            (b.displacement_m - a.displacement_m, b.tension_n * (a.compliance_m_per_n + b.compliance_m_per_n))
        };
        let mut high = slack.largest_log(tight.taut(size_n).displacement_m).min(self.shared);
        if size_n < preload_n {
            high = high.min(-ln_1p(-size_n / preload_n));
        }
        let log = increasing_root(value, 0.0, high, first_log(self.first_drop_n(size_n) / preload_n));
        Ok(self.state(taut, force_n, &tight.taut(gain_n(log)), Some(&slack.slack(log))))
    }

    /// Loss of the slack side to the next order after the half of the force, for zones that do not reach an end: with
    /// `x(q) = Lq/AE ± r/(μAE) (q²/2T_p ∓ q³/3T_p²)` on both sides.
    fn first_drop_n(&self, force_n: f64) -> f64 {
        let (half_n, preload_n) = (0.5 * force_n, self.spec.preload_n);
        let span: f64 = self.sides.iter().map(|side| side.span_m_per_n).sum();
        let reach: f64 = self.sides.iter().flat_map(|side| &side.zones).map(|zone| zone.reach_m_per_n).sum();
        let part = half_n / preload_n;
        half_n * (1.0 - reach * part * part / (3.0 * (span + reach * part)))
    }

    /// The state at a displacement (m; negative when side 1 tightens). Beyond the beginning of gross slip the force stays what it was.
    ///
    /// # Errors
    /// [`WrapError::Value`] for a displacement that is not finite.
    ///
    /// ```
    /// # use forcewright_elements::wrap::{Drive, DriveSpec, Drum, Hold};
    /// # let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    /// # let spec = DriveSpec {
    /// #     input: drum(0.01), output: drum(0.05), hold: Hold::Friction { wrap_rad: 24.3 }, output_wraps_rad: [f64::INFINITY; 2],
    /// #     spans_m: [0.025; 2], axial_stiffness_n: 50e3, preload_n: 200.0,
    /// # };
    /// let drive = Drive::new(&spec).expect("a drive");
    /// let there = drive.at_displacement(80e-6).expect("finite");
    /// let back = drive.at_force(there.force_n).expect("held");
    /// assert!((back.displacement_m - 80e-6).abs() < 1e-18);
    /// ```
    pub fn at_displacement(&self, displacement_m: f64) -> Result<State, WrapError> {
        finite("displacement_m", displacement_m)?;
        let (taut, size_m) = (usize::from(displacement_m < 0.0), displacement_m.abs());
        let sign = if taut == 0 { 1.0 } else { -1.0 };
        if let Some(capacity) = self.capacities[taut].filter(|capacity| size_m >= capacity.displacement_m) {
            let at = self.at_force(sign * capacity.force_n)?;
            let secant_n_per_m = at.force_n / displacement_m;
            return Ok(State { displacement_m, tangent_n_per_m: 0.0, secant_n_per_m, gross_slip: true, ..at });
        }
        let (a, b) = (self.sides[taut].taut_at(size_m), self.sides[1 - taut].slack_at(size_m));
        let force_n = sign * (a.change_n + b.map_or(self.spec.preload_n, |b| b.change_n));
        Ok(State { displacement_m, ..self.state(taut, force_n, &a, b.as_ref()) })
    }

    /// What is reported of two sides; a slack side that is absent carries nothing.
    fn state(&self, taut: usize, force_n: f64, a: &Reached, b: Option<&Reached>) -> State {
        let (tight, slack) = (&self.sides[taut], &self.sides[1 - taut]);
        let log = b.map_or(f64::INFINITY, |b| b.log);
        let (a_rad, a_end) = tight.slip_rad(a.log);
        let (b_rad, b_end) = slack.slip_rad(log);
        let slack_n = b.map_or(0.0, |b| b.tension_n);
        let by_side = |x, y| if taut == 0 { [x, y] } else { [y, x] };
        let signed_m = if taut == 0 { a.displacement_m } else { -a.displacement_m };
        State {
            displacement_m: signed_m,
            force_n,
            tensions_n: if taut == 0 { [a.tension_n, slack_n] } else { [slack_n, a.tension_n] },
            slip_rad: by_side(a_rad, b_rad),
            at_end: if taut == 0 { [a_end, b_end] } else { [b_end, a_end] },
            tangent_n_per_m: 1.0 / a.compliance_m_per_n + b.map_or(0.0, |b| 1.0 / b.compliance_m_per_n),
            secant_n_per_m: if a.displacement_m > 0.0 { force_n / signed_m } else { self.initial_n_per_m() },
            gross_slip: self.capacities[taut].is_some_and(|capacity| force_n.abs() >= capacity.force_n),
            loose: b.is_none(),
        }
    }

    /// The model of `longval-gosselin` with `±T_ℓ` on the sides, for comparison, eqs. (10) to (34): ends of wraps and gross slip are not in
    /// it.
    ///
    /// # Errors
    /// [`WrapError::Slack`] from twice the preload on, [`WrapError::Value`] for a force that is not finite.
    ///
    /// ```
    /// # use forcewright_elements::wrap::{Drive, DriveSpec, Drum, Hold};
    /// # let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    /// # let spec = DriveSpec {
    /// #     input: drum(0.01), output: drum(0.05), hold: Hold::Friction { wrap_rad: 24.3 }, output_wraps_rad: [f64::INFINITY; 2],
    /// #     spans_m: [0.025; 2], axial_stiffness_n: 50e3, preload_n: 200.0,
    /// # };
    /// let paper = Drive::new(&spec).expect("a drive").paper_at_force(200.0).expect("taut");
    /// assert!((paper.stiffness_n_per_m - 433_436.5).abs() < 0.1);
    /// ```
    pub fn paper_at_force(&self, force_n: f64) -> Result<PaperState, WrapError> {
        finite("force_n", force_n)?;
        let (taut, preload_n) = (usize::from(force_n < 0.0), self.spec.preload_n);
        let half_n = 0.5 * force_n.abs();
        if half_n >= preload_n {
            return Err(WrapError::Slack { limit_n: 2.0 * preload_n });
        }
        let slips = |drum: Drum, tension_n: f64| -> Result<Slip, WrapError> {
            let Drum { radius_m, friction } = drum;
            Wrap { radius_m, friction, wrap_rad: f64::INFINITY, axial_stiffness_n: self.spec.axial_stiffness_n }.slip(preload_n, tension_n)
        };
        let (taut_n, slack_n) = (preload_n + half_n, preload_n - half_n);
        let Self { spec: DriveSpec { input, output, .. }, .. } = *self;
        let zones = [slips(output, taut_n)?, slips(input, taut_n)?, slips(input, slack_n)?, slips(output, slack_n)?];
        let spans_m_per_n = [self.sides[taut].span_m_per_n, self.sides[1 - taut].span_m_per_n];
        let stiffness = |a: &Slip, b: &Slip, span: f64| 1.0 / (a.compliance_m_per_n + span + b.compliance_m_per_n);
        let [one, two, three, four] = &zones;
        let stiffness_n_per_m = stiffness(one, two, spans_m_per_n[0]) + stiffness(three, four, spans_m_per_n[1]);
        let taut_m = one.elongation_m + two.elongation_m + spans_m_per_n[0] * half_n;
        let slack_m = spans_m_per_n[1] * half_n - three.elongation_m - four.elongation_m;
        Ok(PaperState {
            tensions_n: [taut_n, slack_n],
            slip_rad: zones.map(|zone| zone.slip_rad),
            elongations_m: zones.map(|zone| zone.elongation_m),
            displacements_m: [taut_m, slack_m],
            stiffness_n_per_m,
            displacement_m: force_n / stiffness_n_per_m,
        })
    }
}
