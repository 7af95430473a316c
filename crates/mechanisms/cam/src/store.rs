//! The work that springs store from where a path starts, and the travel that a wanted force gets for it: what all cams share.
//!
//! The travel may be a length with a force, or an angle with a torque: their product is a work either way.

use forcewright_base::roots;

use crate::jet::Jet;
use crate::law::ForceLaw;
use crate::springs::Bank;

/// Springs from their length at the start on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Store<'a> {
    pub springs: &'a Bank,
    /// Length of the springs at the start of the path, m.
    pub start_length_m: f64,
}

impl Store<'_> {
    /// Force P of the springs where they are deformed by λ, and its slope.
    pub(crate) fn force_n(&self, lambda_m: f64) -> [f64; 2] {
        let sense = self.springs.sense();
        let [tension, rate] = self.springs.tension_n(self.start_length_m + sense * lambda_m);
        [sense * tension, rate]
    }

    /// Energy of the springs beyond that at the start, J.
    pub(crate) fn energy_j(&self, lambda_m: f64) -> f64 {
        let start = self.start_length_m;
        self.springs.energy_j(start, start + self.springs.sense() * lambda_m)
    }

    /// The deformation at which so much energy is stored, m.
    pub(crate) fn deformation_m(&self, energy_j: f64) -> Option<f64> {
        if energy_j <= 0.0 {
            return Some(0.0);
        }
        if self.springs.is_straight() {
            let [force, rate] = self.force_n(0.0);
            let force = force.max(0.0);
            let discriminant = force * force + 2.0 * rate * energy_j;
            return Some(2.0 * energy_j / (force + discriminant.max(0.0).sqrt())).filter(|l| l.is_finite() && discriminant >= 0.0);
        }
        let mut most = 0.1 * self.start_length_m;
        let far = 20.0 * self.start_length_m;
        while self.energy_j(most) < energy_j {
            most *= 2.0;
            if most > far {
                return None;
            }
        }
        let guess = roots::root(|l| self.energy_j(l) - energy_j, 0.0, most, 1e-14).ok()?;
        Some(guess)
    }

    /// Travel over deformation without friction: W(s) = E(λ), s′ = P/F(s).
    pub(crate) fn travel(&self, law: &ForceLaw, lambda_m: f64) -> Jet {
        let [force, rate] = self.force_n(lambda_m);
        let spring = Jet([force, rate, 0.0, 0.0]);
        if law.is_constant() {
            let over = 1.0 / law.force_n(0.0)[0];
            return Jet([self.energy_j(lambda_m) * over, force * over, 0.5 * rate * over, 0.0]);
        }
        let place = law.place_m(self.energy_j(lambda_m));
        let [level, slope] = law.force_n(place);
        let mut s = Jet::constant(place);
        // Each round makes one more derivative exact.
        for order in 1..4 {
            let demanded = (s + -place) * slope + level;
            s.0[order] = (spring / demanded).0[order - 1] / order as f64;
        }
        s
    }
}
