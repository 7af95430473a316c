//! What mechanisms of every family are compared by: what they give, over which range, how stiffly, with what loss, in how much room.

/// What a mechanism gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// A force, N, along a travel, m.
    Force,
    /// A torque, N·m, over a turn, rad.
    Torque,
}

/// A measure, and what it is of this mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct Stated {
    /// SI; `None` where it has none, or it is not known.
    pub value: Option<f64>,
    /// Which quantity of the mechanism it is; without a value, why not.
    pub basis: String,
    /// Whether the value is only a part of the whole, which is not known.
    pub at_least: bool,
}

impl Stated {
    /// A value, if it is known; else why it is not.
    pub fn new(value: Option<f64>, basis: &str, otherwise: &str) -> Self {
        let value = value.filter(|v| v.is_finite());
        Self { basis: if value.is_some() { basis } else { otherwise }.to_owned(), value, at_least: false }
    }

    /// One that there is not, and why.
    pub fn none(why: &str) -> Self {
        Self { value: None, basis: why.to_owned(), at_least: false }
    }

    /// The same times a factor.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { value: self.value.map(|v| v * factor).filter(|v| v.is_finite()), ..self }
    }
}

/// A mechanism of any family in the measures that all families share.
#[derive(Clone, Debug, PartialEq)]
pub struct Duty {
    /// What it gives.
    pub action: Action,
    /// How much of it: N, or N·m.
    pub strength: Stated,
    /// Over which travel, m, or turn, rad.
    pub range: Stated,
    /// Its own work over that range, without friction, J: the integral, not force times travel where the force varies.
    pub work: Stated,
    /// By how much it differs over that range: (max − min)/(max + min), without friction.
    pub variation: Stated,
    /// Its largest change with travel or turn: N/m, or N·m/rad.
    pub stiffness: Stated,
    /// The part of the work put in that is lost on the way through, in one direction.
    pub loss: Stated,
    /// Sides of the smallest box around it along its own axes, at its largest, m: three, or as many as are known.
    pub box_m: Vec<f64>,
    /// What the box holds; where sides are missing, why.
    pub box_basis: String,
}

impl Duty {
    /// The same seen through a lever, m: a force at its end is a torque about its pivot, and the other way round. It stays as it is where
    /// it already gives that.
    #[must_use]
    pub fn seen_as(self, action: Action, lever_m: f64) -> Self {
        let (strength, range) = match (self.action, action) {
            (Action::Force, Action::Torque) => (lever_m, 1.0 / lever_m),
            (Action::Torque, Action::Force) => (1.0 / lever_m, lever_m),
            _ => return self,
        };
        let stiffness = self.stiffness.times(strength / range);
        Self { action, strength: self.strength.times(strength), range: self.range.times(range), stiffness, ..self }
    }

    /// The sides of the box that are known, the longest first, m.
    pub fn sorted_box_m(&self) -> Vec<f64> {
        let mut sides = self.box_m.clone();
        sides.sort_by(|a, b| b.total_cmp(a));
        sides
    }

    /// Volume of the box, m³.
    pub fn volume_m3(&self) -> Option<f64> {
        (self.box_m.len() == 3).then(|| self.box_m.iter().product())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn force() -> Duty {
        let stated = |value: f64| Stated::new(Some(value), "given", "");
        Duty {
            action: Action::Force,
            strength: stated(50.0),
            range: stated(0.02),
            work: stated(1.0),
            variation: stated(0.05),
            stiffness: stated(400.0),
            loss: Stated::none("not modelled"),
            box_m: vec![0.1, 0.05, 0.01],
            box_basis: String::new(),
        }
    }

    /// The work of a force is that of the torque which it is on a lever, and the stiffness follows from both.
    #[test]
    fn a_lever_keeps_the_work() {
        let torque = force().seen_as(Action::Torque, 0.04);
        assert!((torque.strength.value.expect("known") - 2.0).abs() < 1e-15 && (torque.range.value.expect("known") - 0.5).abs() < 1e-15);
        let product = torque.strength.value.expect("known") * torque.range.value.expect("known");
        assert!((product - 1.0).abs() < 1e-15 && torque.work == force().work);
        assert!((torque.stiffness.value.expect("known") - 400.0 * 0.04 * 0.04).abs() < 1e-15);
        let back = torque.seen_as(Action::Force, 0.04);
        assert!((back.strength.value.expect("known") - 50.0).abs() < 1e-12 && back.variation == force().variation);
        assert_eq!(force().seen_as(Action::Force, 0.3), force());
    }

    /// What is not a number is not known.
    #[test]
    fn nonsense_is_not_known() {
        assert_eq!(Stated::new(Some(f64::NAN), "found", "the path ends before"), Stated::none("the path ends before"));
    }
}
