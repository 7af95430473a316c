//! Several cables side by side that remember how they were loaded.

use super::history::{Loaded, settled};
use super::{Bundle, Cycle, Drive, History, WrapError, finite, increasing_root};

/// Doublings of a displacement until a force is passed; beyond, the cables slip.
const MOST_DOUBLINGS: usize = 60;

/// Cables on the same drums that share one displacement, loaded, unloaded and reversed together.
#[derive(Clone, Debug)]
pub struct BundleHistory {
    /// Each kind of cable once, with how many are equal to it: their states are the same.
    kinds: Vec<(History, f64)>,
}

/// A state on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BundleStep {
    /// Shared displacement, m.
    pub displacement_m: f64,
    /// Sum of the forces of the cables, N.
    pub force_n: f64,
    /// Sum of the tangent stiffnesses, N/m, if the step went on in its direction.
    pub tangent_n_per_m: f64,
}

impl BundleHistory {
    /// Cables at rest.
    ///
    /// # Errors
    /// [`WrapError::EndlessWrap`] as of [`History::new`].
    pub fn new(bundle: &Bundle) -> Result<Self, WrapError> {
        let mut drives: Vec<(Drive, f64)> = Vec::new();
        for drive in bundle.cables() {
            match drives.iter_mut().find(|(known, _)| known == drive) {
                Some((_, count)) => *count += 1.0,
                None => drives.push((*drive, 1.0)),
            }
        }
        let kinds = drives.into_iter().map(|(drive, count)| Ok((History::new(&drive)?, count))).collect::<Result<_, WrapError>>()?;
        Ok(Self { kinds })
    }

    /// Displacement reached, m.
    pub fn displacement_m(&self) -> f64 {
        self.kinds.first().map_or(0.0, |(history, _)| history.displacement_m())
    }

    /// Energy that friction took so far, J.
    pub fn friction_j(&self) -> f64 {
        self.kinds.iter().map(|(history, count)| count * history.friction_j()).sum()
    }

    /// The states that one step would reach, without a reversal, at each of some displacements, m; the cables stay as they are.
    ///
    /// # Errors
    /// [`WrapError::Value`] for a displacement that is not finite.
    pub fn along(&self, displacements_m: &[f64]) -> Result<Vec<BundleStep>, WrapError> {
        let rest = |displacement_m: &f64| BundleStep { displacement_m: *displacement_m, force_n: 0.0, tangent_n_per_m: 0.0 };
        let mut all: Vec<BundleStep> = displacements_m.iter().map(rest).collect();
        for (history, count) in &self.kinds {
            for (sum, step) in all.iter_mut().zip(history.along(displacements_m)?) {
                sum.force_n += count * step.force_n;
                sum.tangent_n_per_m += count * step.tangent_n_per_m;
            }
        }
        Ok(all)
    }

    /// The next state, in one step without a reversal, at a displacement, m. A cable that slips keeps its force.
    ///
    /// # Errors
    /// [`WrapError::Value`] for a displacement that is not finite.
    pub fn move_to(&mut self, displacement_m: f64) -> Result<BundleStep, WrapError> {
        let mut sum = BundleStep { displacement_m, force_n: 0.0, tangent_n_per_m: 0.0 };
        for (history, count) in &mut self.kinds {
            let step = history.move_to(displacement_m)?;
            sum.force_n += *count * step.force_n;
            sum.tangent_n_per_m += *count * step.tangent_n_per_m;
        }
        Ok(sum)
    }

    /// The next state, in one step without a reversal, under a force, N, that the cables share as their stiffnesses make them.
    ///
    /// # Errors
    /// [`WrapError::GrossSlip`] beyond what all of them hold together; the state stays as it was. [`WrapError::Value`] for a force that is
    /// not finite.
    pub fn load_to(&mut self, force_n: f64) -> Result<BundleStep, WrapError> {
        finite("force_n", force_n)?;
        if let [(history, count)] = self.kinds.as_mut_slice() {
            let step = history.load_to(force_n / *count)?;
            return Ok(BundleStep { displacement_m: step.displacement_m, force_n, tangent_n_per_m: *count * step.tangent_n_per_m });
        }
        let displacement_m = self.displacement_under(force_n)?;
        Ok(BundleStep { force_n, ..self.move_to(displacement_m)? })
    }

    /// Where the sum of the forces is a force, m.
    fn displacement_under(&self, force_n: f64) -> Result<f64, WrapError> {
        let here_m = self.displacement_m();
        let now = self.along(&[here_m])?[0];
        let missing_n = force_n - now.force_n;
        if missing_n == 0.0 {
            return Ok(here_m);
        }
        let sign = missing_n.signum();
        // Reckoned from here in the direction of the step, so that the function rises from a negative value.
        let value = |step_m: f64| {
            let there = self.along(&[here_m + sign * step_m]).map_or([f64::NAN; 2], |s| [s[0].force_n, s[0].tangent_n_per_m]);
            (sign * (there[0] - force_n), there[1])
        };
        let first_m = missing_n.abs() / now.tangent_n_per_m;
        let mut far_m = first_m;
        for _ in 0..MOST_DOUBLINGS {
            if value(far_m).0 >= 0.0 {
                return Ok(here_m + sign * increasing_root(value, 0.0, far_m, first_m));
            }
            far_m *= 2.0;
        }
        Err(WrapError::GrossSlip { capacity_n: (force_n + sign * value(far_m).0).abs() })
    }

    /// The closed loop between a force (N, above 0) and its opposite, from the present state on; it takes a few cycles to close. The cables
    /// are then at the largest displacement.
    ///
    /// # Errors
    /// [`WrapError::GrossSlip`] beyond what friction holds, [`WrapError::Value`] if the force is not above 0.
    ///
    /// ```
    /// use forcewright_elements::wrap::{Bundle, BundleHistory, Drive, DriveSpec, Drum, History, Hold};
    ///
    /// let cable = |preload_n| {
    ///     let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    ///     Drive::new(&DriveSpec {
    ///         input: drum(0.01), output: drum(0.05), hold: Hold::Friction { wrap_rad: 24.3 }, output_wraps_rad: [20.0; 2],
    ///         spans_m: [0.025; 2], axial_stiffness_n: 50e3, preload_n,
    ///     })
    ///     .expect("a drive")
    /// };
    /// let alone = History::new(&cable(200.0)).expect("finite").cycle(40.0).expect("held");
    /// let two = Bundle::new(vec![cable(200.0); 2]).expect("two");
    /// let both = BundleHistory::new(&two).expect("finite").cycle(80.0).expect("held");
    /// assert!((both.lost_j / alone.lost_j - 2.0).abs() < 1e-9 && (both.lost_motion_m / alone.lost_motion_m - 1.0).abs() < 1e-9);
    /// ```
    pub fn cycle(&mut self, force_n: f64) -> Result<Cycle, WrapError> {
        settled(self, force_n)
    }
}

impl Loaded for BundleHistory {
    fn loaded_m(&mut self, force_n: f64) -> Result<f64, WrapError> {
        Ok(self.load_to(force_n)?.displacement_m)
    }

    fn lost_j(&self) -> f64 {
        self.friction_j()
    }
}
