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
    let box_m = design.layout.circle.is_none().then(|| box_m(design, behaviour)).flatten();
    Duty {
        action: Action::Force,
        strength: Stated::new(extent.map(|(hi, lo)| f64::midpoint(hi, lo)), &format!("middle of the force {within}"), nothing),
        range: Stated::new(range.map(|i| i.length()), &format!("travel {within}"), nothing),
        variation: Stated::new(extent.filter(|(hi, lo)| hi + lo > 0.0).map(|(hi, lo)| (hi - lo) / (hi + lo)), within, nothing),
        stiffness: Stated::new(steepest, &format!("steepest slope of the force {within}"), nothing),
        loss: Stated::none("the hysteresis of the material is not modelled"),
        box_basis: match (box_m, design.layout.circle) {
            (Some(_), _) if design.layout.layers > 1 => "beams over the travel, all copies; layers without the room between them",
            (Some(_), _) => "beams over the travel, all copies, without pads and blocks",
            (None, Some(_)) => "legs around an axis have no box along the axes",
            (None, None) => SHORT,
        }
        .to_owned(),
        box_m,
    }
}

/// The largest size of the slope over an interval, N/m.
fn steepest_n_per_m(curve: &ForceCurve, Interval { start, end }: Interval) -> f64 {
    let at = |i: usize| curve.slope(start + (end - start) * i as f64 / PLACES as f64).abs();
    (0..=PLACES).map(at).fold(0.0, f64::max)
}

/// Width, height and depth of the beams with their thickness, in all copies, over the path, m.
fn box_m(design: &Design, behaviour: &Behaviour) -> Option<[f64; 3]> {
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
    let layers = f64::from(design.layout.layers);
    // Layers stand behind each other along the load; which side that is does not change the volume.
    (width_m.is_finite() && height_m.is_finite()).then_some([width_m, height_m * layers, depth_m])
}
