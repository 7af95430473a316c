//! Room: the smallest distance between beams, and of the beams to the sides of the envelope, over the travel.

use forcewright_base::roots;
use forcewright_beam::{BeamState, Clearance, Point, clearance, clearance_near};

use crate::analysis::Behaviour;
use crate::design::{Design, Envelope};

/// States looked at, besides rest, before the least is refined between its neighbours.
const STATES: usize = 12;
/// Places per beam at which its faces are looked at, before the least is refined between its neighbours.
const PLACES: usize = 40;
/// Distances below that part of half a thickness are none.
const TOUCH: f64 = 1e-9;
/// Width to which a displacement is refined, as part of the travel.
const REFINED: f64 = 1e-4;

/// The smallest distance between beams on a path.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    /// Displacement, m.
    pub at_m: f64,
    /// The distance and its places.
    pub clearance: Clearance,
}

/// The smallest distance to the sides of the envelope on a path.
#[derive(Clone, Copy, Debug)]
pub struct Margin {
    /// Displacement, m.
    pub at_m: f64,
    /// Index of the beam.
    pub beam: usize,
    /// Where along it.
    pub u: f64,
    /// The distance, m; negative outside.
    pub margin_m: f64,
}

/// The smallest distance between the surfaces of beams from rest to the end of the path, copies in the plane included; `None` where no two
/// of them face each other.
///
/// Looks at rest and at 12 states, and refines the displacement between the neighbours of the least.
pub fn nearest(design: &Design, behaviour: &Behaviour) -> Option<Nearest> {
    let images = design.layout.neighbours();
    let network = &design.network;
    let whole = |point: &Point| {
        let clearance = clearance(network, Some(point), &images)?;
        Some(Nearest { at_m: behaviour.delta_m(point), clearance })
    };
    let near = |point: &Point, known: &Nearest| {
        let clearance = clearance_near(network, Some(point), &images, &known.clearance)?;
        Some(Nearest { at_m: behaviour.delta_m(point), clearance })
    };
    least(behaviour, whole, near, |n| n.clearance.distance_m)
}

/// The smallest distance between the plates of neighbours around an axis over the path, m; `None` without such a layout.
pub(crate) fn gap_around_m(design: &Design, behaviour: &Behaviour) -> Option<f64> {
    let circle = design.layout.circle?;
    let inner = |state: &BeamState| {
        let off = |u: f64, [x, y]: [f64; 2]| {
            let [ox, oy] = circle.axis_m;
            (x - ox) * circle.outward[0] + (y - oy) * circle.outward[1] - 0.5 * state.thickness_m(u)
        };
        least_along(state, off).1
    };
    let of = |point: &Point| point.beams.iter().map(inner).reduce(f64::min);
    let inner_m = least(behaviour, of, |point, _| of(point), |inner_m| *inner_m)?;
    let depth_m = design.network.beams.iter().map(|b| b.section.depth_m).fold(0.0, f64::max);
    design.layout.gap_around_m(inner_m, depth_m)
}

/// The smallest distance of the beams, with their thickness, to the sides of an envelope from rest to the end of the path.
///
/// Only the drawn network is looked at: the envelope of [`crate::Requirements`] is the one in which its copies are in theirs. As for the clearance, a beam is all that is within
/// half its thickness of its axis: its ends are round, and one that ends on a side sticks out by half its thickness.
pub fn margin(behaviour: &Behaviour, envelope: &Envelope) -> Option<Margin> {
    let of = |point: &Point| {
        let all = point.beams.iter().enumerate().map(|(beam, state)| {
            let (u, margin_m) = beam_margin(state, envelope);
            Margin { at_m: behaviour.delta_m(point), beam, u, margin_m }
        });
        all.reduce(|best, next| if next.margin_m < best.margin_m { next } else { best })
    };
    least(behaviour, of, |point, _| of(point), |m| m.margin_m)
}

/// Where a beam is nearest to the sides, and how near, m.
fn beam_margin(state: &BeamState, envelope: &Envelope) -> (f64, f64) {
    let at = |u: f64, [x, y]: [f64; 2]| {
        let sides = [x - envelope.low_m[0], envelope.high_m[0] - x, y - envelope.low_m[1], envelope.high_m[1] - y];
        let half_m = 0.5 * state.thickness_m(u);
        let margin_m = sides.into_iter().fold(f64::INFINITY, f64::min) - half_m;
        // A face on a side touches it, whatever rounding says.
        if margin_m.abs() <= TOUCH * half_m { 0.0 } else { margin_m }
    };
    least_along(state, at)
}

/// The least along a beam of a quantity of the place and of where it is: where, and how much.
fn least_along(state: &BeamState, of: impl Fn(f64, [f64; 2]) -> f64) -> (f64, f64) {
    let place = |i: usize| i as f64 / PLACES as f64;
    let mut point = state.shape_m(0.0);
    let mut best = (0, of(0.0, point));
    for i in 1..=PLACES {
        let [x, y] = state.step_m(place(i - 1), place(i));
        point = [point[0] + x, point[1] + y];
        let value = of(place(i), point);
        if value < best.1 {
            best = (i, value);
        }
    }
    let at = |u: f64| of(u, state.shape_m(u));
    let known = (place(best.0), at(place(best.0)));
    let found = roots::minimise(at, place(best.0.saturating_sub(1)), place((best.0 + 1).min(PLACES)), 1e-7);
    if found.value < known.1 { (found.x, found.value) } else { known }
}

/// The least of a quantity over the states of a path, refined between two neighbours of the least; `near` follows a known one.
fn least<T: Copy>(
    behaviour: &Behaviour,
    of: impl Fn(&Point) -> Option<T>,
    near: impl Fn(&Point, &T) -> Option<T>,
    value: impl Fn(&T) -> f64,
) -> Option<T> {
    let points = &behaviour.path.points;
    let last = points.len().checked_sub(1)?;
    let states = last.clamp(1, STATES);
    let stations: Vec<&Point> = (0..=states).map(|i| &points[i * last / states]).collect();
    let found: Vec<Option<T>> = stations.iter().map(|p| of(p)).collect();
    let size = |t: &Option<T>| t.as_ref().map_or(f64::INFINITY, &value);
    let best = (0..found.len()).reduce(|b, i| if size(&found[i]) < size(&found[b]) { i } else { b })?;
    let answer = found[best]?;
    let (left, right) = (stations[best.saturating_sub(1)].control, stations[(best + 1).min(states)].control);
    let at = |x: f64| behaviour.path.at(x).ok().and_then(|p| near(&p, &answer));
    // Next to an end the least is that end, unless it falls inwards.
    let inside = if best == 0 || best == states {
        let inwards = if best == 0 { left + 0.01 * (right - left) } else { right - 0.01 * (right - left) };
        size(&at(inwards)) < value(&answer)
    } else {
        true
    };
    if !inside || left >= right {
        return Some(answer);
    }
    let refined = roots::minimise(|x| size(&at(x)), left, right, REFINED * right);
    let found = [behaviour.path.at(refined.x).ok().and_then(|p| of(&p)), at(refined.x)];
    Some(found.into_iter().flatten().fold(answer, |best, next| if value(&next) < value(&best) { next } else { best }))
}
