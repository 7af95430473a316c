//! The mechanism as a picture that moves over its travel, and its cam by itself.

mod comb;

use std::fmt::Write as _;

use forcewright_base::maths;
use forcewright_base::units::format_si;
use forcewright_model::{Axis, Film, Frame, Item, Look, Role, Scene};

use crate::analysis::{Behaviour, Station};
use crate::cut::SIDES;
use crate::design::Design;
use crate::parts::relief_m;
use crate::path::{Vector, frame};

pub(crate) use comb::comb;

/// Points along a profile.
const SAMPLES: usize = 120;
/// Frames over the travel.
pub(crate) const FRAMES: usize = 25;
/// Windings of a drawn spring.
const TURNS: usize = 14;

/// The mechanism over its travel; `None` where it could not be assembled anywhere.
pub(crate) fn film(design: &Design, behaviour: &Behaviour, axis: Axis) -> Option<Film> {
    let last = behaviour.stations.len().checked_sub(1)?;
    let artist = Artist { design, behaviour };
    let mut places: Vec<usize> = (0..FRAMES).map(|i| (i * last + (FRAMES - 1) / 2) / (FRAMES - 1)).collect();
    places.dedup();
    let frames: Vec<Frame> = places.iter().map(|i| artist.frame(&behaviour.stations[*i])).collect();
    let description =
        "Cam, two rollers on it, springs between their axles, two braces and the slider that they hold, with the force that pulls it.";
    let stage = Scene {
        items: artist.stage(),
        scale: None,
        words: ["as made", "moved"],
        display: design.units.length.clone(),
        description: description.to_owned(),
    };
    Some(Film { axis, stage, chosen: frames.len() / 2, frames })
}

struct Artist<'a> {
    design: &'a Design,
    behaviour: &'a Behaviour,
}

/// Coordinates of a side in the picture: the left one is mirrored.
fn place(side: usize, [x, y]: Vector) -> Vector {
    if side == 0 { [x, y] } else { [-x, y] }
}

/// The profile of the cam on a side, upwards from where it begins, in the coordinates of the side.
fn surface(behaviour: &Behaviour, side: usize) -> Vec<Vector> {
    let path = &behaviour.mechanism.paths[side];
    let sense = behaviour.mechanism.springs.sense();
    let [from, to] = behaviour.cut.range_m();
    let start = behaviour.corners[side].map_or(from, |c| c.lambda_m);
    let radius = behaviour.mechanism.roller_m;
    let one = |i: usize| {
        let u = i as f64 / SAMPLES as f64;
        // Denser at the start, where it is curved most.
        let p = path.at(start + (to - start) * u * u);
        let [_, normal] = frame(&p, sense);
        [p.at[0] - radius * normal[0], p.at[1] - radius * normal[1]]
    };
    (0..=SAMPLES).map(one).collect()
}

/// The path of a roller's centre as made, upwards, in the coordinates of the side.
fn path(behaviour: &Behaviour, side: usize) -> Vec<Vector> {
    let path = &behaviour.mechanism.paths[side];
    let [from, to] = behaviour.cut.range_m();
    (0..=SAMPLES).map(|i| i as f64 / SAMPLES as f64).map(|u| path.at(from + (to - from) * u * u).at).collect()
}

pub(crate) fn thin(points: Vec<Vector>, look: Look, word: &'static str) -> Item {
    Item::Line { points, width_m: 0.0, role: Role::Named(look, word), values: None }
}

pub(crate) fn plate(corners: Vec<Vector>) -> Item {
    Item::Body { corners, role: Role::Named(Look::Plate, "cam") }
}

/// A zigzag between the axles.
pub(crate) fn spring([a, b]: [Vector; 2], wide: f64) -> Item {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = maths::hypot(along[0], along[1]);
    let across = [-along[1] / length, along[0] / length];
    let mut points = vec![a];
    for i in 0..=2 * TURNS {
        let t = 0.12 + 0.76 * i as f64 / (2 * TURNS) as f64;
        let out = match i {
            0 => 0.0,
            i if i == 2 * TURNS => 0.0,
            i if i % 2 == 0 => wide,
            _ => -wide,
        };
        points.push([a[0] + t * along[0] + out * across[0], a[1] + t * along[1] + out * across[1]]);
    }
    points.push(b);
    thin(points, Look::Wire, "springs")
}

impl Artist<'_> {
    /// Half the side of the slider, m.
    fn half_m(&self) -> f64 {
        0.6 * self.behaviour.mechanism.roller_m
    }

    /// What stays where it is.
    fn stage(&self) -> Vec<Item> {
        let mut items = self.cams();
        let heights = || self.behaviour.stations.iter().map(|s| s.pose.joints[0][1]);
        let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
        let r = self.behaviour.mechanism.roller_m;
        let foot = items.iter().filter_map(|i| if let Item::Body { corners, .. } = i { Some(corners) } else { None }).flatten();
        let foot = foot.map(|c| c[1]).fold(0.0, f64::min);
        items.push(thin(vec![[0.0, foot - 0.5 * r], [0.0, high + 4.5 * r]], Look::Axis, "axis"));
        items.extend((0..SIDES).map(|side| {
            let points = path(self.behaviour, side).into_iter().map(|p| place(side, p)).collect();
            thin(points, Look::Track, "path of the rollers")
        }));
        if !self.design.free_guide {
            let (x, out) = (1.25 * self.half_m(), 1.4 * self.half_m());
            items.extend([x, -x].map(|x| thin(vec![[x, low - out], [x, high + out]], Look::Rail, "guide of the slider")));
        }
        items.extend(self.corner());
        items
    }

    /// The plate between the rollers, or those outside them, as they are made: with their base below the start of the profile.
    fn cams(&self) -> Vec<Item> {
        let making = &self.design.making;
        let sides = [0, 1].map(|side| surface(self.behaviour, side));
        let (Some(low), Some(low_left)) = (sides[0].first().copied(), sides[1].first().copied()) else { return Vec::new() };
        if self.behaviour.mechanism.springs.sense() > 0.0 {
            let bottom = low[1].min(low_left[1]) - making.base_m;
            let left = sides[1].iter().rev().map(|p| place(1, *p));
            let [right_foot, left_foot] = [0, 1].map(|side| relief_m(self.behaviour, side).min(sides[side][0][0]));
            let base = [[-left_foot, low_left[1]], [-left_foot, bottom], [right_foot, bottom], [right_foot, low[1]]];
            return vec![plate(sides[0].iter().copied().chain(left).chain(base).collect())];
        }
        let one = |(side, profile): (usize, &Vec<Vector>)| {
            let (low, high) = (*profile.first()?, *profile.last()?);
            let out = low[0].max(high[0]) + making.wall_m;
            let bottom = low[1] - making.base_m;
            let foot = relief_m(self.behaviour, side).max(low[0]).min(out - 0.1 * making.wall_m);
            let back = [[out, high[1]], [out, bottom], [foot, bottom], [foot, low[1]]];
            Some(plate(profile.iter().copied().chain(back).map(|p| place(side, p)).collect()))
        };
        sides.iter().enumerate().filter_map(one).collect()
    }

    /// Where the cam is undercut.
    fn corner(&self) -> Option<Item> {
        let (side, corner) = self.behaviour.corners.iter().enumerate().find_map(|(side, c)| Some((side, c.as_ref()?)))?;
        let travel = format_si(corner.travel_m, &self.design.units.travel, 3);
        Some(Item::Marker { at: place(side, corner.at), label: format!("undercut up to s = {travel}") })
    }

    fn frame(&self, station: &Station) -> Frame {
        let mut items = vec![self.spring(station)];
        let r = self.behaviour.mechanism.roller_m;
        for side in 0..SIDES {
            let centre = place(side, station.pose.places[side].at);
            items.push(Item::Disc { centre, radius_m: r, role: Role::Named(Look::Moving, "rollers") });
        }
        for side in 0..SIDES {
            let ends = [station.pose.joints[side], station.pose.places[side].at].map(|p| place(side, p));
            items.push(Item::Line {
                points: ends.to_vec(),
                width_m: 0.35 * r,
                role: Role::Named(Look::Bar, "braces, slider"),
                values: None,
            });
            items.push(Item::Disc { centre: ends[1], radius_m: 0.25 * r, role: Role::Named(Look::Plate, "") });
        }
        items.extend(self.slider(station));
        Frame { at: station.travel_m, note: self.note(station), items }
    }

    /// The forces of a frame, and where a free slider is.
    fn note(&self, station: &Station) -> String {
        let force = |n: f64| format_si(n, &self.design.units.force, 4);
        let mut note = format!("F = {}", force(station.still.force_n));
        if self.design.built.arm_m > 0.0 {
            let _ = write!(note, " ({} up, {} down)", force(station.up.force_n), force(station.down.force_n));
        }
        if self.design.free_guide {
            let [still, ..] = station.sideways_m;
            let side = if still < 0.0 { "left" } else { "right" };
            let _ = write!(note, ", slider {} {side}", format_si(still.abs(), &self.design.units.length, 3));
        }
        note
    }

    fn spring(&self, station: &Station) -> Item {
        let axles = [place(0, station.pose.places[0].at), place(1, station.pose.places[1].at)];
        spring(axles, 0.35 * self.behaviour.mechanism.roller_m)
    }

    /// The slider with its joint and the force that pulls it, as long as it is large.
    fn slider(&self, station: &Station) -> [Item; 3] {
        let [x, y] = station.pose.joints[0];
        let half = self.half_m();
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[a, b]: Vector| [x + a * half, y + b * half]).to_vec();
        let force = format_si(station.still.force_n, &self.design.units.force, 4);
        let most = self.behaviour.stations.iter().map(|s| s.still.force_n.abs()).fold(f64::MIN_POSITIVE, f64::max);
        let long = 3.5 * self.behaviour.mechanism.roller_m * station.still.force_n / most;
        let (from, to) = ([x, y + half], [x, y + half + long]);
        // A force that pushes points at the slider.
        let (from, to) = if long < 0.0 { ([x, y + half - long], from) } else { (from, to) };
        [
            Item::Body { corners, role: Role::Named(Look::Bar, "braces, slider") },
            Item::Disc { centre: [x, y], radius_m: 0.4 * half, role: Role::Named(Look::Plate, "") },
            Item::Arrow { from, to, label: format!("F = {force}") },
        ]
    }
}
