//! A compliant mechanism in the measures of all families.

use forcewright_model::{Action, Duty, Stated};

use crate::analysis::{Behaviour, Measured};
use crate::design::Design;
use crate::force_curve::{ForceCurve, Interval};

/// Places of the range at which the slope is looked at.
const PLACES: usize = 400;
/// Places along a beam at which its faces are looked at.
const ALONG: usize = 60;

/// What it gives over the stretch that it is made for.
pub(crate) fn duty(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Duty {
    const SHORT: &str = "the path does not reach the end of the travel";
    let curve = behaviour.curve.as_ref().filter(|_| behaviour.whole);
    let wants_force = design.requirements.as_ref().is_some_and(|r| r.force.is_some());
    let whole = curve.map(|c| Interval { start: c.start(), end: c.end() });
    let range = if wants_force { measured.usable } else { whole };
    let (within, nothing) =
        if wants_force { ("inside the force band", "no stretch lies inside the force band") } else { ("over the travel", SHORT) };
    let extent = curve.zip(range).map(|(c, i)| c.extent(i));
    let steepest = curve.zip(range).map(|(c, i)| steepest_n_per_m(c, i));
    let work = curve.zip(range).map(|(c, i)| work_j(c, i));
    let mean = work.zip(range).map(|(work, i)| work / i.length());
    let pulls = extent.is_some_and(|(_, low)| low < 0.0);
    let variation = extent.filter(|(hi, lo)| !pulls && hi + lo > 0.0).map(|(hi, lo)| (hi - lo) / (hi + lo));
    let (box_m, box_basis) = box_of(design, behaviour);
    Duty {
        action: Action::Force,
        strength: Stated::new(mean, &format!("mean of the force {within}"), nothing),
        range: Stated::new(range.map(|i| i.length()), if wants_force { "travel inside the force band" } else { "the travel" }, nothing),
        work: Stated::new(work, &format!("integral of the force {within}"), nothing),
        variation: Stated::new(variation, &format!("of the force {within}"), if pulls { "the force changes its sign" } else { nothing }),
        stiffness: Stated::new(steepest, &format!("steepest slope of the force {within}"), nothing),
        loss: Stated::none("the hysteresis of the material is not modelled"),
        box_m,
        box_basis: box_basis.to_owned(),
    }
}

/// Work of the force over an interval, J, by Simpson's rule on as many places as its slope is looked at.
fn work_j(curve: &ForceCurve, Interval { start, end }: Interval) -> f64 {
    let at = |i: usize| curve.force(start + (end - start) * i as f64 / PLACES as f64);
    let weight = |i: usize| if i == 0 || i == PLACES { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
    (0..=PLACES).map(|i| weight(i) * at(i)).sum::<f64>() * (end - start) / (3.0 * PLACES as f64)
}

/// The largest size of the slope over an interval, N/m.
fn steepest_n_per_m(curve: &ForceCurve, Interval { start, end }: Interval) -> f64 {
    let at = |i: usize| curve.slope(start + (end - start) * i as f64 / PLACES as f64).abs();
    (0..=PLACES).map(at).fold(0.0, f64::max)
}

/// Width, height and depth of the beams with their thickness, in all copies, over the path, m, as far as they are known, and what they are.
fn box_of(design: &Design, behaviour: &Behaviour) -> (Vec<f64>, &'static str) {
    if design.layout.circle.is_some() {
        return (Vec::new(), "legs around an axis have no box along the axes");
    }
    let images = design.layout.images();
    let mut sides = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for state in behaviour.path.points.iter().flat_map(|point| &point.beams) {
        let mut at = state.shape_m(0.0);
        for i in 0..=ALONG {
            let u = i as f64 / ALONG as f64;
            if i > 0 {
                let [x, y] = state.step_m((i - 1) as f64 / ALONG as f64, u);
                at = [at[0] + x, at[1] + y];
            }
            let half_m = 0.5 * state.thickness_m(u);
            for image in &images {
                for (side, place) in sides.iter_mut().zip(image.of(at)) {
                    *side = [side[0].min(place - half_m), side[1].max(place + half_m)];
                }
            }
        }
    }
    let depth_m = design.network.beams.iter().map(|b| b.section.depth_m).fold(0.0, f64::max) * f64::from(design.layout.plates);
    let [width_m, height_m] = sides.map(|[low, high]| high - low);
    if !(width_m.is_finite() && height_m.is_finite()) {
        return (Vec::new(), "no state was reached");
    }
    if design.layout.layers > 1 {
        return (vec![width_m, height_m, depth_m], "one layer: beams over its travel, all copies; how far apart layers stand is not known");
    }
    (vec![width_m, height_m, depth_m], "beams over the travel, all copies, without pads and blocks")
}
