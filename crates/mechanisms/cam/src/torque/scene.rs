//! The torque cam as a picture that moves over its turn, and its outline by itself.

use std::fmt::Write as _;

use forcewright_base::maths;
use forcewright_base::units::{format_number, format_si};
use forcewright_model::{Axis, Film, Frame, Item, Look, Role, Scene};

use super::analysis::{Behaviour, Station};
use super::design::Design;
use super::outline::{self, surface};
use crate::path::{Vector, curvature_per_m, frame};
use crate::scene::{FRAMES, plate, spring, thin};

/// Points along a lobe.
const SAMPLES: usize = 240;
/// Points of a circle.
const ROUND: usize = 120;
/// Teeth of the comb.
const TEETH: usize = 60;
/// Length of a tooth where the roller is as large as the radius of curvature, in roller radii.
const LENGTH: f64 = 1.5;
/// Longest tooth, as roller radius over radius of curvature.
const MOST: f64 = 2.0;

fn turned([x, y]: Vector, by_rad: f64) -> Vector {
    let (sin, cos) = maths::sin_cos(by_rad);
    [cos * x - sin * y, sin * x + cos * y]
}

fn opposite([x, y]: Vector) -> Vector {
    [-x, -y]
}

fn circle(radius_m: f64) -> Vec<Vector> {
    (0..=ROUND).map(|i| turned([radius_m, 0.0], std::f64::consts::TAU * i as f64 / ROUND as f64)).collect()
}

/// Half of the outline in the coordinates of the disc: a lobe, and what leads to the other.
fn half(behaviour: &Behaviour) -> Vec<Vector> {
    let mechanism = &behaviour.mechanism;
    let [_, to] = mechanism.cut.range_m();
    let start = outline::start_m(mechanism);
    // Below a corner the roller turns about it: the lobe begins there.
    let from = mechanism.corner.map_or(start, |c| c.lambda_m.max(start));
    let lobe = (0..=SAMPLES).map(|i| i as f64 / SAMPLES as f64).map(|u| surface(mechanism, &mechanism.at(from + (to - from) * u * u)));
    let closing = outline::closing(mechanism, start, to).map_or_else(Vec::new, |c| c.points_m());
    lobe.chain(closing).collect()
}

/// What is solid, in the coordinates of the disc: the disc, or a ring opened by a cut without width.
fn solid(design: &Design, half: &[Vector]) -> Vec<Vector> {
    let whole: Vec<Vector> = half.iter().copied().chain(half.iter().map(|p| opposite(*p))).collect();
    if design.built.extension {
        return whole;
    }
    let far = whole.iter().map(|[x, y]| maths::hypot(*x, *y)).fold(0.0, f64::max) + design.making.wall_m;
    let Some(first) = whole.first().copied() else { return whole };
    let rim = circle(far).into_iter().map(|p| turned(p, maths::atan2(first[1], first[0])));
    rim.chain([first]).chain(whole.iter().rev().copied()).collect()
}

/// The mechanism over its turn; `None` where no roller stands on the disc anywhere.
pub(super) fn film(design: &Design, behaviour: &Behaviour, axis: Axis) -> Option<Film> {
    let last = behaviour.stations.len().checked_sub(1)?;
    let half = half(behaviour);
    let disc = solid(design, &half);
    let mut places: Vec<usize> = (0..FRAMES).map(|i| (i * last + (FRAMES - 1) / 2) / (FRAMES - 1)).collect();
    places.dedup();
    let frames: Vec<Frame> = places.iter().map(|i| moved(design, behaviour, &disc, &behaviour.stations[*i])).collect();
    let stage = Scene {
        items: if design.built.extension { guides(behaviour) } else { Vec::new() },
        scale: None,
        words: ["as made", "moved"],
        display: design.units.length.clone(),
        description: "A disc on a shaft with two lobes, two rollers on it that move along level guides, and springs between their axles."
            .to_owned(),
    };
    Some(Film { axis, stage, chosen: frames.len() / 2, frames })
}

/// Both guides, as long as the rollers need them.
fn guides(behaviour: &Behaviour) -> Vec<Item> {
    let r = behaviour.mechanism.roller_m;
    let most = behaviour.stations.iter().map(|s| s.pose.radius_m[0]).fold(0.0, f64::max) + 1.5 * r;
    let gap = 0.45 * r;
    let rail = |[x, y]: Vector| thin(vec![[0.4 * x, y], [x, y]], Look::Rail, "guides of the rollers");
    [[most, gap], [most, -gap], [-most, gap], [-most, -gap]].map(rail).to_vec()
}

fn moved(design: &Design, behaviour: &Behaviour, disc: &[Vector], station: &Station) -> Frame {
    let r = behaviour.mechanism.roller_m;
    let turn = station.turn_rad();
    let mut items = vec![plate(disc.iter().map(|p| turned(*p, turn)).collect())];
    if let Some(shaft) = design.shaft_m {
        items.push(Item::Disc { centre: [0.0; 2], radius_m: 0.5 * shaft, role: Role::Named(Look::Moving, "shaft") });
        let mark = turned([0.5 * shaft, 0.0], turn);
        items.push(thin(vec![[0.0; 2], mark], Look::Rail, ""));
    }
    if let Some(corner) = &behaviour.mechanism.corner {
        let label = format!("undercut up to θ = {}", format_si(corner.turn_rad, &design.units.travel, 3));
        items.push(Item::Marker { at: turned(corner.at, turn), label });
    }
    if !design.built.extension {
        // Before the ring, which would hide them.
        items.extend(guides(behaviour));
    }
    let axles = [[station.pose.radius_m[0], 0.0], [-station.pose.radius_m[0], 0.0]];
    items.extend(axles.map(|centre| Item::Disc { centre, radius_m: r, role: Role::Named(Look::Moving, "rollers") }));
    items.push(spring(axles, 0.35 * r));
    items.extend(axles.map(|centre| Item::Disc { centre, radius_m: 0.25 * r, role: Role::Named(Look::Plate, "") }));
    let torque = |nm: f64| format_si(nm, &design.units.torque, 4);
    let mut note = format!("T = {}", torque(station.still.torque_nm));
    if behaviour.mechanism.arm_m > 0.0 || behaviour.mechanism.guide_friction > 0.0 {
        let _ = write!(note, " ({} up, {} down)", torque(station.up.torque_nm), torque(station.down.torque_nm));
    }
    Frame { at: turn, note, items }
}

/// The outline with the path of a roller and the curvature of it as a comb.
pub(super) fn comb(design: &Design, behaviour: &Behaviour) -> Scene {
    let mechanism = &behaviour.mechanism;
    let (cut, sense, r) = (&mechanism.cut, mechanism.cut.sense(), design.cut_roller_m);
    let [from, to] = cut.range_m();
    let at = |u: f64| from + (to - from) * u * u;
    let half = half(behaviour);
    let mut items = vec![plate(solid(design, &half))];
    let teeth: Vec<(Vector, Vector, f64)> = (0..=TEETH)
        .filter_map(|i| {
            let place = cut.place(at(i as f64 / TEETH as f64));
            let [_, normal] = frame(&place, sense);
            let ratio = r * curvature_per_m(&place, sense);
            (ratio.is_finite() && normal[0].is_finite()).then_some((place.at, normal, ratio.clamp(-MOST, MOST)))
        })
        .collect();
    let tip = |(foot, normal, _): &(Vector, Vector, f64), ratio: f64| [0, 1].map(|i| foot[i] + LENGTH * r * ratio * normal[i]);
    items.extend(teeth.iter().map(|t| thin(vec![t.0, tip(t, t.2)], Look::Comb, "curvature of the path, r/ϱ")));
    items.push(thin(teeth.iter().map(|t| tip(t, t.2)).collect(), Look::Comb, ""));
    items.push(thin(teeth.iter().map(|t| tip(t, 1.0)).collect(), Look::Limit, "r/ϱ = 1: undercut beyond"));
    let path = |place: &dyn Fn(f64) -> Vector| (0..=SAMPLES).map(|i| place(at(i as f64 / SAMPLES as f64))).collect::<Vec<_>>();
    items.push(thin(path(&|l| mechanism.at(l).at), Look::Track, "path of the roller"));
    items.push(thin(path(&|l| opposite(mechanism.at(l).at)), Look::Track, ""));
    if let Some(shaft) = design.shaft_m {
        items.push(thin(circle(0.5 * shaft), Look::Rail, "hole for the shaft"));
    }
    let most = teeth.iter().map(|t| t.2).fold(0.0, f64::max);
    let largest = if most < MOST { format_number(most, 3) } else { format!("{MOST} and more") };
    let mut description = format!(
        "The outline of the cam and the path of a roller, with lines across as long as the path is curved: r/ϱ is at most {largest}."
    );
    if let Some(corner) = &mechanism.corner {
        let cut_off = (0..=TEETH).map(|i| cut.place(from + (corner.lambda_m - from) * i as f64 / TEETH as f64).at).collect();
        items.push(Item::Line { points: cut_off, width_m: 0.0, role: Role::Undeformed, values: None });
        let turn = format_si(corner.turn_rad, &design.units.travel, 3);
        items.push(Item::Marker { at: corner.at, label: format!("corner, up to θ = {turn}") });
        let _ = write!(description, " The cam is undercut up to a turn of {turn}.");
    }
    Scene { items, scale: None, words: ["path as meant, cut off", "as made"], display: design.units.length.clone(), description }
}
