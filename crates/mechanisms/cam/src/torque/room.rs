//! What would let an outline close that does not: every change that is named was tried.

use std::f64::consts::PI;
use std::sync::Arc;

use forcewright_base::units::format_si;

use super::cut::Cut;
use super::design::Design;
use super::outline::{closing, start_m};
use crate::spec::{LARGEST_TURN_RAD, SMALLEST_TURN_RAD};

/// Step of the turns that are tried, rad.
const STEP_RAD: f64 = PI / 90.0;
/// How far a turn that is named lies inside the edge, rad: as much as it is rounded.
const INSIDE_RAD: f64 = PI / 1800.0;
/// Halvings of a step to find the edge.
const HALVINGS: usize = 20;
/// Diameters of rollers and start radii that are tried, as parts of what was typed, the smallest change first.
const ROLLERS: [f64; 4] = [0.9, 0.8, 0.6, 0.4];
const RADII: [f64; 8] = [1.05, 0.95, 1.1, 0.9, 1.25, 0.8, 1.5, 0.7];

/// Whether a disc can be cut whose outline closes, with rollers that do not run into each other.
pub(super) fn closes(design: &Design) -> bool {
    let Ok(cut) = Cut::new(design.purpose.clone()) else { return false };
    let cut = Arc::new(cut);
    let [from, to] = cut.range_m();
    let apart = [from, to].into_iter().all(|l| cut.at(l)[1].value() >= design.cut_roller_m);
    let mechanism = design.mechanism(&cut);
    apart && closing(&mechanism, start_m(&mechanism), to).is_some()
}

/// The largest turn below and the smallest above that of a design for which the outline closes, rad. It may close for turns on both sides
/// of some for which it does not, so that every one is tried.
fn turns_rad(design: &Design) -> [Option<f64>; 2] {
    let asked = design.purpose.turn_rad;
    let fits = |turn_rad: f64| {
        let mut other = design.clone();
        other.purpose.turn_rad = turn_rad;
        closes(&other)
    };
    [-1.0, 1.0].map(|way| {
        let turn = |i: u32| asked + way * STEP_RAD * f64::from(i);
        let mut tried = (1..).map(turn).take_while(|t| (SMALLEST_TURN_RAD..=LARGEST_TURN_RAD).contains(t));
        let mut good = tried.find(|t| fits(*t))?;
        let mut bad = good - way * STEP_RAD;
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(good, bad);
            *if fits(middle) { &mut good } else { &mut bad } = middle;
        }
        Some(good + way * INSIDE_RAD).filter(|t| fits(*t)).or(Some(good))
    })
}

/// The help of E0614.
pub(super) fn advice(design: &Design) -> String {
    let mut all = Vec::new();
    let [below, above] = turns_rad(design).map(|turn| turn.map(|t| format_si(t, &design.units.travel, 4)));
    if let Some(turn) = below {
        all.push(format!("a turn of {turn}"));
    }
    if let Some(turn) = above {
        all.push(format!("the longer turn of {turn}"));
    }
    let length = |m: f64| format_si(m, &design.units.length, 3);
    let smaller = ROLLERS.iter().find_map(|part| {
        let mut other = design.clone();
        for radius_m in [&mut other.cut_roller_m, &mut other.built.roller_m] {
            *radius_m *= part;
        }
        closes(&other).then(|| format!("rollers of {}", length(2.0 * other.cut_roller_m)))
    });
    let radius = RADII.iter().find_map(|part| {
        let mut other = design.clone();
        other.purpose.start_radius_m *= part;
        closes(&other).then(|| format!("a `start_radius` of {}, which changes the preload", length(other.purpose.start_radius_m)))
    });
    all.extend(smaller.into_iter().chain(radius));
    if all.is_empty() {
        return "no other turn, no rollers down to 40 % and no `start_radius` from 70 to 150 % let it close: choose another torque or other springs"
            .to_owned();
    }
    format!("each of these was tried, and closes it: {}", all.join("; "))
}
