//! What small errors of the profiles do to the forces at rest, to first order: two numbers per side and travel.
//!
//! A normal error e of a profile moves the roller of a fixed slider outwards by `δx = e/(n_x + n_y tan α)`, and the energy of the springs
//! with it; the force follows from the error and its slope e′ over the arc length (`docs/theory/cam.md`, eq. 9),
//!
//! δF = Σ over both sides of a e + b e′.
//!
//! Here a and b are exact derivatives of the equations of all bodies, for any force law, springs, weights, friction either way, and for a
//! mechanism with flaws of its own. Second-order terms are left out: halving an error quarters them.

use crate::cut::SIDES;
use crate::jet::Jet;
use crate::measured::RandomProfile;
use crate::mechanism::{Drive, Mechanism, NotAssembled, Pose};
use crate::path::NormalError;
use crate::rest::{RestForces, RestingRoller, SENSES};

/// Places per correlation length at which a random error is tabulated: its slope is exact to 1e-4, far better than first order is.
const COARSE: f64 = 2.0;

/// What an error of one side does to the forces at a travel; forces in the order of [`SENSES`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Influence {
    /// Arc length of the path at which the error counts, m.
    pub arc_m: f64,
    /// a: force per error, N/m.
    pub by_error_n_per_m: RestForces,
    /// b: force per slope of the error, N.
    pub by_slope_n: RestForces,
}

/// Forces at a travel with the influence of both profiles on them.
#[derive(Clone, Copy, Debug)]
pub struct InfluencedStation {
    /// Travel, m.
    pub travel_m: f64,
    /// Forces of the mechanism itself, N.
    pub forces_n: RestForces,
    /// Right and left.
    pub sides: [Influence; SIDES],
}

/// Forces of a mechanism at rest as straight lines of the errors of its profiles.
#[derive(Clone, Debug)]
pub struct ProfileInfluence {
    /// In the order of the travels asked for.
    pub stations: Vec<InfluencedStation>,
}

impl ProfileInfluence {
    /// The mechanism at given travels, m, which serve best in rising order.
    ///
    /// # Errors
    /// [`NotAssembled`] where a brace does not reach its path.
    pub fn new(mechanism: &Mechanism, travels_m: &[f64]) -> Result<Self, NotAssembled> {
        let mut near: Option<Pose> = None;
        let mut stations = Vec::with_capacity(travels_m.len());
        for &travel_m in travels_m {
            let pose = mechanism.pose_near([travel_m, 0.0], near.as_ref())?;
            let forces_n = mechanism.forces_in(&pose, &Drive::rest(travel_m), SENSES).map(|instant| instant.force_n);
            let right = influence(mechanism, &pose, 0);
            let left = if mechanism.symmetric([0.0; 3]) { right } else { influence(mechanism, &pose, 1) };
            stations.push(InfluencedStation { travel_m, forces_n, sides: [right, left] });
            near = Some(pose);
        }
        Ok(Self { stations })
    }

    /// Forces with an error of each profile, written over `out`.
    pub fn forces_n(&self, errors: [Option<&dyn NormalError>; SIDES], out: &mut Vec<RestForces>) {
        self.forces_with(|side, arc_m| errors[side].map(|error| error.at(arc_m)), out);
    }

    /// Forces with a random error of each profile, written over `out`: to first order those of the cam with [`RandomProfile::of`] its sides.
    pub fn random_n(&self, random: &RandomProfile, out: &mut Vec<RestForces>) {
        let waves = [0, 1].map(|side| {
            let arcs = self.stations.iter().map(|station| station.sides[side].arc_m);
            let range = arcs.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], arc| [low.min(arc), high.max(arc)]);
            random.wave(side).map(|wave| (wave.table(range, random.correlation_m / COARSE), wave))
        });
        // All stations at one place, as on the corner of an undercut, are no table.
        let error = |side: usize, arc_m: f64| {
            waves[side].as_ref().map(|(table, wave)| table.derivatives(arc_m).unwrap_or_else(|| wave.derivatives(arc_m)))
        };
        self.forces_with(error, out);
    }

    /// Standard deviation of the forces over all draws of a random error, N: value and slope of the error at a place are independent, of
    /// the deviations σ and σ/ℓ.
    pub fn deviations_n(&self, deviation_m: f64, correlation_m: f64) -> impl Iterator<Item = RestForces> + '_ {
        let slope = deviation_m / correlation_m;
        self.stations.iter().map(move |station| {
            std::array::from_fn(|i| {
                let variance = |side: &Influence| {
                    let (by_error, by_slope) = (side.by_error_n_per_m[i] * deviation_m, side.by_slope_n[i] * slope);
                    by_error * by_error + by_slope * by_slope
                };
                station.sides.iter().map(variance).sum::<f64>().sqrt()
            })
        })
    }

    fn forces_with(&self, error: impl Fn(usize, f64) -> Option<[f64; 3]>, out: &mut Vec<RestForces>) {
        out.clear();
        out.extend(self.stations.iter().map(|station| {
            let mut sum = station.forces_n;
            for (side, influence) in station.sides.iter().enumerate() {
                if let Some([e, slope, _]) = error(side, influence.arc_m) {
                    for (i, force) in sum.iter_mut().enumerate() {
                        *force += influence.by_error_n_per_m[i] * e + influence.by_slope_n[i] * slope;
                    }
                }
            }
            sum
        }));
    }
}

/// Derivatives of the forces by the error of a side and by its slope.
fn influence(mechanism: &Mechanism, pose: &Pose, side: usize) -> Influence {
    let sway = mechanism.paths[side].sway(pose.lambda_m[side]);
    let (place, joint) = (&pose.places[side], pose.joints[side]);
    let arm = [place.at[0] - joint[0], place.at[1] - joint[1]];
    let gear = arm[0] * place.slope[0] + arm[1] * place.slope[1];
    let mut found = Influence { arc_m: sway.arc_m, ..Influence::default() };
    for (cause, by) in [&mut found.by_error_n_per_m, &mut found.by_slope_n].into_iter().enumerate() {
        // λ gives way so that the brace keeps its length.
        let along = -(arm[0] * sway.at[cause][0] + arm[1] * sway.at[cause][1]) / gear;
        let mut moved = [0, 1].map(|i| RestingRoller::<Jet>::of(pose, i));
        for k in 0..2 {
            moved[side].at[k].0[1] = sway.at[cause][k] + along * place.slope[k];
            moved[side].slope[k].0[1] = sway.slope[cause][k] + along * place.bend[k];
        }
        *by = mechanism.at_rest(&moved, false).map(|force| force.derivative(1));
    }
    found
}
