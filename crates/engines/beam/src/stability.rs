//! Stability of an equilibrium, and the places of a path where it changes.

use forcewright_base::inertia::inertia;

use crate::{
    arclength::{ArcKnot, Border},
    stepping::Stepper,
};

/// A limit point of the control: the path turns back, or turns forward again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fold {
    /// Place in [`crate::Path::whole`].
    pub index: usize,
    /// Value of the control: m, rad, N or N·m after the drive. Wrong by the accuracy of the path; the place on the path is found to
    /// 1e-9 of a step, and the control is stationary there.
    pub control: f64,
    /// Displacement of the driven node along the drive, m, or its rotation, rad.
    pub displacement: f64,
    /// Force on the driven node along the drive, N, or moment, N·m.
    pub force: f64,
}

/// What a slowly driven device does at a limit point: it leaves the path and, after some motion that is not computed here, rests on a
/// later stable stretch of it at the same control.
///
/// Later stretches of this path only: if the equilibrium has other branches, the device may come to rest on one of those.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    /// Place of the limit point in [`crate::Path::whole`].
    pub from: usize,
    /// Place of the landing in [`crate::Path::whole`].
    pub to: usize,
    /// The control at both: m, rad, N or N·m after the drive.
    pub control: f64,
    /// Displacement along the drive before, m or rad. The same as after under a kinematic drive.
    pub displacement_before: f64,
    /// Displacement along the drive after, m or rad.
    pub displacement_after: f64,
    /// Force along the drive before, N or N·m. The same as after under a dead load.
    pub force_before: f64,
    /// Force along the drive after, N or N·m.
    pub force_after: f64,
    /// Energy set free, J: strain energy lost, plus the work of a dead load during the jump.
    pub released_j: f64,
}

/// A place where the number of unstable motions changes while the control goes on: another path crosses or touches this one there,
/// and a real device, never quite symmetric, will leave this one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bifurcation {
    /// Under which load: that of [`crate::Network::before`] with this number, or the drive, whose number is the next.
    pub stage: usize,
    /// Value of the control, found to about 1e-6 of a step: m, rad, N or N·m after the drive.
    pub control: f64,
    /// Displacement of the driven node along the drive, m, or its rotation, rad.
    pub displacement: f64,
    /// Force on the driven node along the drive, N, or moment, N·m.
    pub force: f64,
    /// [`crate::Point::instability`] before it.
    pub before: usize,
    /// [`crate::Point::instability`] after it.
    pub after: usize,
}

/// Halvings of a step in which the number of unstable motions changes.
const HALVINGS: u32 = 24;
/// Changes within one step that are told apart.
const MOST_IN_A_STEP: usize = 4;

impl Stepper<'_> {
    /// Number of unstable motions at the state that was just linearised.
    ///
    /// By the additivity of inertia (E. V. Haynsworth, Linear Algebra Appl. 1, 1968) the negative eigenvalues of the full tangent are
    /// those of the bubbles and those of the condensed tangent together. Each multiplier accounts for one of them.
    pub(crate) fn instability(&self) -> usize {
        let system = &self.system;
        let condensed = inertia(system.model.solved, system.model.unknowns, &system.matrix).negative;
        let bubbles: usize = system.elements.iter().map(crate::element::Element::negative_bubbles).sum();
        (condensed + bubbles).saturating_sub(2 * system.model.beams.len())
    }

    /// Displacement and force along the drive, SI, at a knot that was just solved for.
    pub(crate) fn displacement_and_force(&self, knot: &ArcKnot) -> [f64; 2] {
        let model = self.system.model;
        let control = knot.control * model.control_unit();
        if model.kinematic {
            [control, self.reaction() * model.reaction_unit()]
        } else {
            [self.driven_displacement(&knot.state) * model.displacement_unit(), control]
        }
    }

    /// All changes of stability along the knots apart from those at limit points.
    pub(crate) fn bifurcations(&mut self, border: &mut Border, knots: &[ArcKnot]) -> Vec<Bifurcation> {
        let mut found = Vec::new();
        for pair in knots.windows(2) {
            let (mut from, mut before) = (pair[0].way, pair[0].instability[1]);
            for _ in 0..MOST_IN_A_STEP {
                if before == pair[1].instability[0] {
                    break;
                }
                let Some((place, after, bifurcation)) = self.first_change(border, &pair[0], &pair[1], (from, before)) else { break };
                found.push(bifurcation);
                (from, before) = (place, after);
            }
        }
        found
    }

    /// The first change found by halving between a place with a given number and the end of a step: place and number behind it.
    fn first_change(&mut self, border: &mut Border, a: &ArcKnot, b: &ArcKnot, from: (f64, usize)) -> Option<(f64, usize, Bifurcation)> {
        let (mut low, mut high, mut after) = (from.0, b.way, b.instability[0]);
        let mut last = None;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            // On the point itself the bordered tangent has no inverse either: close enough.
            let Some(knot) = self.knot_between(border, a, b, middle) else { break };
            last = Some((knot.control, self.displacement_and_force(&knot)));
            if knot.instability[0] == from.1 {
                low = middle;
            } else {
                (high, after) = (middle, knot.instability[0]);
            }
        }
        let (control, [displacement, force]) = last?;
        let control = control * self.system.model.control_unit();
        Some((high, after, Bifurcation { stage: self.system.model.stage, control, displacement, force, before: from.1, after }))
    }
}
