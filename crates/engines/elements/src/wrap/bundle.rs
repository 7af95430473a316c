//! Several cables side by side on the same drums.

use super::{Drive, State, WrapError, finite, increasing_root};

/// Cables on the same drums that share one displacement; each with its own preload, stiffness and wraps.
#[derive(Clone, Debug, PartialEq)]
pub struct Bundle {
    cables: Vec<Drive>,
}

/// A state of a bundle.
#[derive(Clone, Debug, PartialEq)]
pub struct BundleState {
    /// Shared displacement, m.
    pub displacement_m: f64,
    /// Sum of the forces of the cables, N.
    pub force_n: f64,
    /// Sum of their tangent stiffnesses, N/m.
    pub tangent_n_per_m: f64,
    /// Each cable, in the order given.
    pub cables: Vec<State>,
}

impl Bundle {
    /// Cables at rest at the same displacement. The drums are the same for all: radii that differ are not noticed.
    ///
    /// # Errors
    /// [`WrapError::NoCable`]
    pub fn new(cables: Vec<Drive>) -> Result<Self, WrapError> {
        if cables.is_empty() { Err(WrapError::NoCable) } else { Ok(Self { cables }) }
    }

    /// The cables.
    pub fn cables(&self) -> &[Drive] {
        &self.cables
    }

    /// Largest force in the direction of side 0 and in that of side 1, N: all cables slip; absent where one never does.
    pub fn capacities_n(&self) -> [Option<f64>; 2] {
        [0, 1].map(|taut| self.cables.iter().map(|cable| cable.capacities()[taut].map(|capacity| capacity.force_n)).sum())
    }

    /// The state at a displacement, m. A cable that slips keeps its force.
    ///
    /// # Errors
    /// [`WrapError::Value`] for a displacement that is not finite.
    ///
    /// ```
    /// # use forcewright_elements::wrap::{Bundle, Drive, DriveSpec, Drum, Hold};
    /// # let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    /// # let drive = Drive::new(&DriveSpec {
    /// #     input: drum(0.01), output: drum(0.05), hold: Hold::Friction { wrap_rad: 24.3 }, output_wraps_rad: [20.0; 2],
    /// #     spans_m: [0.025; 2], axial_stiffness_n: 50e3, preload_n: 200.0,
    /// # }).expect("a drive");
    /// let one_n = drive.at_displacement(50e-6).expect("finite").force_n;
    /// let three = Bundle::new(vec![drive; 3]).expect("three").at_displacement(50e-6).expect("finite");
    /// assert!((three.force_n - 3.0 * one_n).abs() < 1e-9);
    /// ```
    pub fn at_displacement(&self, displacement_m: f64) -> Result<BundleState, WrapError> {
        let cables: Vec<State> = self.cables.iter().map(|cable| cable.at_displacement(displacement_m)).collect::<Result<_, _>>()?;
        let force_n = cables.iter().map(|state| state.force_n).sum();
        let tangent_n_per_m = cables.iter().map(|state| state.tangent_n_per_m).sum();
        Ok(BundleState { displacement_m, force_n, tangent_n_per_m, cables })
    }

    /// The state under a force, N, that the cables share as their stiffnesses make them.
    ///
    /// # Errors
    /// [`WrapError::GrossSlip`] where all cables together do not hold it, [`WrapError::Value`] for a force that is not finite.
    ///
    /// ```
    /// use forcewright_elements::wrap::{Bundle, Drive, DriveSpec, Drum, Hold};
    ///
    /// let cable = |preload_n| {
    ///     let drum = |radius_m| Drum { radius_m, friction: 0.15 };
    ///     Drive::new(&DriveSpec {
    ///         input: drum(0.01), output: drum(0.05), hold: Hold::Friction { wrap_rad: 24.3 }, output_wraps_rad: [20.0; 2],
    ///         spans_m: [0.025; 2], axial_stiffness_n: 50e3, preload_n,
    ///     })
    ///     .expect("a drive")
    /// };
    /// let state = Bundle::new(vec![cable(220.0), cable(180.0)]).expect("two").at_force(300.0).expect("held");
    /// // The cable with more preload is stiffer and carries more.
    /// assert!((state.force_n - 300.0).abs() < 1e-9 && state.cables[0].force_n > state.cables[1].force_n);
    /// ```
    pub fn at_force(&self, force_n: f64) -> Result<BundleState, WrapError> {
        finite("force_n", force_n)?;
        let (taut, sign) = if force_n < 0.0 { (1, -1.0) } else { (0, 1.0) };
        let capacity_n = self.capacities_n()[taut];
        if let Some(capacity_n) = capacity_n.filter(|capacity_n| force_n.abs() > *capacity_n) {
            return Err(WrapError::GrossSlip { capacity_n });
        }
        // Equal cables share it equally.
        if let [first, rest @ ..] = self.cables.as_slice()
            && rest.iter().all(|cable| cable == first)
        {
            let count = self.cables.len() as f64;
            let state = first.at_force(force_n / count)?;
            let (displacement_m, tangent_n_per_m) = (state.displacement_m, count * state.tangent_n_per_m);
            return Ok(BundleState { displacement_m, force_n, tangent_n_per_m, cables: vec![state; self.cables.len()] });
        }
        // No cable is stiffer than at rest.
        let least_m = force_n.abs() / self.cables.iter().map(Drive::initial_n_per_m).sum::<f64>();
        let value = |size_m: f64| {
            self.at_displacement(sign * size_m)
                .map_or((f64::NAN, f64::NAN), |state| (sign * state.force_n - force_n.abs(), state.tangent_n_per_m))
        };
        let high_m = match capacity_n {
            Some(_) => {
                let slips_m = |cable: &Drive| cable.capacities()[taut].map_or(0.0, |capacity| capacity.displacement_m);
                self.cables.iter().map(slips_m).fold(least_m, f64::max)
            }
            None => doubled(least_m, |size_m| value(size_m).0 < 0.0),
        };
        self.at_displacement(sign * increasing_root(value, least_m, high_m, least_m))
    }
}

/// The first of a length, its double, … that is not too short; the last before overflow if none.
fn doubled(mut size_m: f64, too_short: impl Fn(f64) -> bool) -> f64 {
    while too_short(size_m) && (2.0 * size_m).is_finite() {
        size_m *= 2.0;
    }
    size_m
}
