//! Torque and turn: the cables of a drive between its two drums.
//!
//! Wrap friction is that of `forcewright_elements::wrap`; here is how a drive becomes one. On a helix of angle β friction acts with μ cos β per
//! angle of the drum, an angle is r/cos β of cable, and a tension has the lever r cos β; virtual work of a small turn φ is then F r cos β φ = F x.

use forcewright_base::maths;
use forcewright_elements::wrap::{Bundle, BundleHistory, BundleState, Cycle, Drive, DriveSpec, Drum, Hold, State, WrapError};

use crate::design::{Built, Source};

/// Where a drive stands in its travel: lengths and angles that its statics need.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Length of each free span along the cable, m.
    pub span_m: f64,
    /// Angle of the helices, rad.
    pub helix_rad: f64,
    /// Wrap on the input drum of both sides, rad: from each span to the pin where the cables are fastened, else halves of one wrap.
    pub input_wraps_rad: [f64; 2],
    /// Wrap of each cable's two ends on the output drum, rad.
    pub output_wraps_rad: Vec<[f64; 2]>,
}

/// A drive at a place of its travel.
#[derive(Clone, Debug)]
pub struct Statics {
    bundle: Bundle,
    /// Of input and output, m.
    levers_m: [f64; 2],
    source: Source,
}

/// The drive under a torque.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// At the output, N·m.
    pub torque_nm: f64,
    /// Turn of the output, input held, rad.
    pub turn_rad: f64,
    /// Difference of the tensions of all cables, N.
    pub force_n: f64,
    /// dF/dx, N/m.
    pub tangent_n_per_m: f64,
    /// F/x, N/m.
    pub secant_n_per_m: f64,
    /// Tensions of each cable: side 0 and side 1, N.
    pub tensions_n: Vec<[f64; 2]>,
    /// Slip angles of each cable: by side, on the output and on the input drum, rad.
    pub slip_rad: Vec<[[f64; 2]; 2]>,
    /// Whether slip of a cable reaches a termination.
    pub at_end: bool,
    /// Whether slip of a fastened cable reaches its pin on the input drum.
    pub at_pin: bool,
}

/// A torque–turn loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// Turn between the two rests at zero torque, rad.
    pub lost_motion_rad: f64,
    /// Energy lost per cycle, J.
    pub lost_j: f64,
    /// From rest to the torque, back, and up again: turns (rad) and torques (N·m).
    pub branches: [Vec<[f64; 2]>; 3],
}

impl Statics {
    /// The drive at a place.
    ///
    /// # Errors
    /// [`WrapError`] where a number is not what a wrap needs.
    pub fn new(built: &Built, place: &Place, source: Source) -> Result<Self, WrapError> {
        let cos = if built.helix_correction { maths::cos(place.helix_rad) } else { 1.0 };
        let friction = built.friction * built.groove_factor * cos;
        let drum = |radius_m: f64| Drum { radius_m: radius_m / cos, friction };
        let hold = if built.fastened {
            Hold::Fixed { wraps_rad: place.input_wraps_rad }
        } else {
            Hold::Friction { wrap_rad: place.input_wraps_rad.iter().sum() }
        };
        let [input_m, output_m] = built.radii_m;
        let cable = |(cable, wraps): (&crate::design::Cable, &[f64; 2])| {
            Drive::new(&DriveSpec {
                input: drum(input_m),
                output: drum(output_m),
                hold,
                output_wraps_rad: *wraps,
                spans_m: [place.span_m; 2],
                axial_stiffness_n: cable.axial_stiffness_n,
                preload_n: cable.preload_left_n(built),
            })
        };
        let drives = built.cables.iter().zip(&place.output_wraps_rad).map(cable).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { bundle: Bundle::new(drives)?, levers_m: built.radii_m.map(|r| r * cos), source })
    }

    /// Lever of a tension about the input and about the output axis, m.
    pub fn levers_m(&self) -> [f64; 2] {
        self.levers_m
    }

    /// Stiffness at the output at rest, N·m/rad.
    pub fn initial_nm_per_rad(&self) -> f64 {
        let sum: f64 = self.bundle.cables().iter().map(Drive::initial_n_per_m).sum();
        self.torsional(sum, 1)
    }

    /// A stiffness along the cable (N/m) about the input (0) or the output (1), N·m/rad. `longval-gosselin`, eq. (36).
    pub fn torsional(&self, stiffness_n_per_m: f64, shaft: usize) -> f64 {
        let lever_m = self.levers_m[shaft.min(1)];
        stiffness_n_per_m * lever_m * lever_m
    }

    /// Torque at the output at which the cables slip over the whole input drum, the smaller of both directions, N·m; `None` where they never
    /// do.
    pub fn gross_slip_nm(&self) -> Option<f64> {
        let lever_m = self.levers_m[1];
        match self.source {
            Source::Corrected => {
                let [one, other] = self.bundle.capacities_n();
                one.into_iter().chain(other).reduce(f64::min).map(|force_n| force_n * lever_m)
            }
            Source::Paper => Some(self.bundle.cables().iter().map(paper_capacity_n).sum::<f64>() * lever_m),
        }
    }

    /// The drive, loaded from rest by a torque at the output, N·m.
    ///
    /// # Errors
    /// [`WrapError::GrossSlip`] or [`WrapError::Slack`] beyond what it holds.
    pub fn under(&self, torque_nm: f64) -> Result<Loaded, WrapError> {
        let force_n = torque_nm / self.levers_m[1];
        match self.source {
            Source::Corrected => Ok(self.loaded(&self.bundle.at_force(force_n)?)),
            Source::Paper => self.paper(force_n),
        }
    }

    /// The drive, loaded from rest to a turn of the output, rad; as computed by the corrected model.
    ///
    /// # Errors
    /// [`WrapError::Value`] for a turn that is not finite.
    pub fn turned(&self, turn_rad: f64) -> Result<Loaded, WrapError> {
        Ok(self.loaded(&self.bundle.at_displacement(turn_rad * self.levers_m[1])?))
    }

    fn loaded(&self, state: &BundleState) -> Loaded {
        let reaches = |drum: usize| state.cables.iter().any(|s: &State| s.at_end.iter().any(|side| side[drum]));
        let secant_n_per_m = if state.displacement_m == 0.0 { state.tangent_n_per_m } else { state.force_n / state.displacement_m };
        Loaded {
            torque_nm: state.force_n * self.levers_m[1],
            turn_rad: state.displacement_m / self.levers_m[1],
            force_n: state.force_n,
            tangent_n_per_m: state.tangent_n_per_m,
            secant_n_per_m,
            tensions_n: state.cables.iter().map(|s| s.tensions_n).collect(),
            slip_rad: state.cables.iter().map(|s| s.slip_rad).collect(),
            at_end: reaches(0),
            // Without a pin the zones of both sides meet instead.
            at_pin: reaches(1),
        }
    }

    /// The paper's state; its cables are equal and share the force.
    fn paper(&self, force_n: f64) -> Result<Loaded, WrapError> {
        let cables = self.bundle.cables();
        let count = cables.len() as f64;
        let Some(cable) = cables.first() else { return Err(WrapError::NoCable) };
        let state = cable.paper_at_force(force_n / count)?;
        let [taut_out, taut_in, slack_in, slack_out] = state.slip_rad;
        let tangent_n_per_m = count * state.stiffness_n_per_m;
        Ok(Loaded {
            torque_nm: force_n * self.levers_m[1],
            turn_rad: state.displacement_m / self.levers_m[1],
            force_n,
            tangent_n_per_m,
            // Eq. (34) takes the tangent stiffness for a secant.
            secant_n_per_m: tangent_n_per_m,
            tensions_n: vec![state.tensions_n; cables.len()],
            slip_rad: vec![[[taut_out, taut_in], [slack_out, slack_in]]; cables.len()],
            at_end: false,
            at_pin: false,
        })
    }

    /// The loop between a torque at the output (N·m, above 0) and its opposite, with `points` on each of its branches.
    ///
    /// # Errors
    /// [`WrapError::GrossSlip`] beyond what friction holds, [`WrapError::EndlessWrap`].
    pub fn cycle(&self, torque_nm: f64, points: usize) -> Result<Loop, WrapError> {
        let lever_m = self.levers_m[1];
        let force_n = torque_nm / lever_m;
        let mut history = BundleHistory::new(&self.bundle)?;
        let first_m = history.clone().load_to(force_n)?.displacement_m;
        let branch = |history: &BundleHistory, [from_m, to_m]: [f64; 2]| -> Result<Vec<[f64; 2]>, WrapError> {
            let places: Vec<f64> = (0..=points).map(|i| from_m + (to_m - from_m) * i as f64 / points.max(1) as f64).collect();
            Ok(history.along(&places)?.iter().map(|s| [s.displacement_m / lever_m, s.force_n * lever_m]).collect())
        };
        let fresh = branch(&history, [0.0, first_m])?;
        let Cycle { displacements_m: [highest_m, lowest_m], lost_motion_m, lost_j, .. } = history.cycle(force_n)?;
        let back = branch(&history, [highest_m, lowest_m])?;
        history.load_to(-force_n)?;
        let forth = branch(&history, [lowest_m, highest_m])?;
        Ok(Loop { lost_motion_rad: lost_motion_m / lever_m, lost_j, branches: [fresh, back, forth] })
    }
}

/// Gross slip with the paper's tensions: `2 T_p tanh(μΘ/2)`; at most `2 T_p`.
fn paper_capacity_n(drive: &Drive) -> f64 {
    let spec = drive.spec();
    match spec.hold {
        Hold::Friction { wrap_rad } => spec.preload_n * 2.0 * (1.0 - 2.0 / (maths::exp(spec.input.friction * wrap_rad) + 1.0)),
        Hold::Fixed { .. } => 2.0 * spec.preload_n,
    }
}
