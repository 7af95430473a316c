//! The lower part of the profile of the cam, with the curvature of the path as a comb.

use std::fmt::Write as _;

use forcewright_base::units::{format_number, format_si};
use forcewright_model::{Item, Look, Role, Scene};

use super::{path, plate, surface, thin};
use crate::analysis::Behaviour;
use crate::design::Design;
use crate::parts::relief_m;
use crate::path::{Vector, curvature_per_m, frame};

/// Teeth of the comb.
const TEETH: usize = 60;
/// Length of a tooth where the roller is as large as the radius of curvature, in roller radii.
const LENGTH: f64 = 1.5;
/// How much of the path is shown, in roller radii upwards from its start: further up it is hardly curved.
const SHOWN: f64 = 6.0;
/// Longest tooth, as roller radius over radius of curvature: at the start of an undercut path it has no bounds.
const MOST: f64 = 2.0;

/// A place of the path as it was meant.
struct Tooth {
    foot: Vector,
    normal: Vector,
    /// Roller radius over radius of curvature.
    ratio: f64,
}

/// The right side of the cam with its path, as it was meant and as it is, and the curvature of the former.
pub(crate) fn comb(design: &Design, behaviour: &Behaviour) -> Scene {
    let end_m = end_m(design, behaviour);
    let top = behaviour.mechanism.paths[0].at(end_m).at[1];
    let lower = |points: Vec<Vector>| points.into_iter().filter(|p| p[1] <= top).collect::<Vec<_>>();
    let profile = lower(surface(behaviour, 0));
    let mut items = Vec::new();
    if let (Some(low), Some(high)) = (profile.first().copied(), profile.last().copied()) {
        let making = &design.making;
        let tension = behaviour.mechanism.springs.sense() > 0.0;
        let back = if tension { 0.0 } else { low[0].max(high[0]) + making.wall_m };
        let bottom = low[1] - making.base_m;
        let foot = relief_m(behaviour, 0);
        let foot = if tension { foot.min(low[0]) } else { foot.max(low[0]).min(back - 0.1 * making.wall_m) };
        let outline = [[back, high[1]], [back, bottom], [foot, bottom], [foot, low[1]]];
        items.push(plate(profile.into_iter().chain(outline).collect()));
    }
    let teeth = teeth(design, behaviour, end_m);
    let r = design.cut_roller_m;
    let tip = |tooth: &Tooth, ratio: f64| [0, 1].map(|i| tooth.foot[i] + LENGTH * r * ratio * tooth.normal[i]);
    items.extend(teeth.iter().map(|t| thin(vec![t.foot, tip(t, t.ratio)], Look::Comb, "curvature of the path, r/ϱ")));
    items.push(thin(teeth.iter().map(|t| tip(t, t.ratio)).collect(), Look::Comb, ""));
    items.push(thin(teeth.iter().map(|t| tip(t, 1.0)).collect(), Look::Limit, "r/ϱ = 1: undercut beyond"));
    items.push(thin(lower(path(behaviour, 0)), Look::Track, "path of the roller"));
    let most = teeth.iter().map(|t| t.ratio).fold(0.0, f64::max);
    let largest = if most < MOST { format_number(most, 3) } else { format!("{MOST} and more") };
    let mut description = format!(
        "The lower part of the right profile of the cam and of the path of its roller, with lines across as long as the path is curved: r/ϱ is at most {largest}."
    );
    if let Some(corner) = &behaviour.corners[0] {
        // The path as meant goes on below the corner, and the roller does not.
        let cut_off: Vec<Vector> = meant(behaviour, corner.lambda_m);
        items.push(Item::Line { points: cut_off, width_m: 0.0, role: Role::Undeformed, values: None });
        let travel = format_si(corner.travel_m, &design.units.travel, 3);
        items.push(Item::Marker { at: corner.at, label: format!("corner, up to s = {travel}") });
        let _ = write!(description, " The cam is undercut up to a travel of {travel}.");
    }
    Scene { items, scale: None, words: ["path as meant, cut off", "as made"], display: design.units.length.clone(), description }
}

/// λ where the picture ends, m.
fn end_m(design: &Design, behaviour: &Behaviour) -> f64 {
    let path = &behaviour.mechanism.paths[0];
    let [from, to] = behaviour.cut.range_m();
    let top = path.at(from).at[1] + SHOWN * design.cut_roller_m;
    let places = (1..=TEETH * TEETH).map(|i| from + (to - from) * i as f64 / (TEETH * TEETH) as f64);
    places.into_iter().find(|l| path.at(*l).at[1] >= top).unwrap_or(to)
}

fn teeth(design: &Design, behaviour: &Behaviour, to: f64) -> Vec<Tooth> {
    let path = &behaviour.mechanism.paths[0];
    let sense = behaviour.mechanism.springs.sense();
    let [from, _] = behaviour.cut.range_m();
    (0..=TEETH)
        .filter_map(|i| {
            let u = i as f64 / TEETH as f64;
            let p = path.designed(from + (to - from) * u * u);
            let [_, normal] = frame(&p, sense);
            let ratio = design.cut_roller_m * curvature_per_m(&p, sense);
            // Where the path begins with a right angle to the travel it may have no tangent.
            (ratio.is_finite() && normal[0].is_finite()).then_some(Tooth { foot: p.at, normal, ratio: ratio.clamp(-MOST, MOST) })
        })
        .collect()
}

/// The path as meant, up to a place.
fn meant(behaviour: &Behaviour, end_m: f64) -> Vec<Vector> {
    let path = &behaviour.mechanism.paths[0];
    let [from, _] = behaviour.cut.range_m();
    (0..=TEETH).map(|i| path.designed(from + (end_m - from) * i as f64 / TEETH as f64).at).collect()
}
