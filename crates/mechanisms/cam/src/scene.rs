//! The mechanism as a picture at a travel of its slider.

use std::f64::consts::PI;

use forcewright_base::maths;
use forcewright_base::units::format_si;
use forcewright_model::{Item, Role, Scene, SupportKind};

use crate::analysis::{Behaviour, Station};
use crate::cut::SIDES;
use crate::design::Design;
use crate::path::{Vector, frame};

/// Points along a profile.
const SAMPLES: usize = 120;
/// Sides of a drawn circle.
const CORNERS: usize = 48;

/// Draws a design at a station.
pub(crate) fn scene(design: &Design, behaviour: &Behaviour, station: &Station) -> Scene {
    let artist = Artist { design, behaviour, thin_m: 0.004 * size_m(behaviour) };
    let mut items = Vec::new();
    artist.axis(&mut items);
    for side in 0..SIDES {
        artist.cam(&mut items, side);
        artist.path(&mut items, side);
    }
    for side in 0..SIDES {
        artist.roller(&mut items, station, side);
        artist.brace(&mut items, station, side);
    }
    artist.spring(&mut items, station);
    artist.slider(&mut items, station);
    artist.corner(&mut items);
    let s = format_si(station.travel_m, &design.units.travel, 4);
    let force = format_si(station.still.force_n, &design.units.force, 4);
    Scene {
        items,
        scale: None,
        words: ["path of the rollers", "mechanism"],
        display: design.units.length.clone(),
        description: format!(
            "The mechanism at a travel of {s}: cam, two rollers, springs between their axles, two braces and the slider, pulled with {force}."
        ),
    }
}

fn size_m(behaviour: &Behaviour) -> f64 {
    let cut = &behaviour.cut;
    let [from, to] = cut.range_m();
    let p = cut.at(0, to);
    p.y.value().max(p.x.value()) + cut.rise_m(0) + (to - from)
}

struct Artist<'a> {
    design: &'a Design,
    behaviour: &'a Behaviour,
    thin_m: f64,
}

/// Coordinates of a side in the picture: the left one is mirrored.
fn place(side: usize, [x, y]: Vector) -> Vector {
    if side == 0 { [x, y] } else { [-x, y] }
}

impl Artist<'_> {
    fn line(&self, points: Vec<Vector>, role: Role, width: f64) -> Item {
        Item::Line { points, width_m: width * self.thin_m, role, values: None }
    }

    fn axis(&self, items: &mut Vec<Item>) {
        let top = self.behaviour.stations.last().map_or(0.0, |s| s.pose.joints[0][1]);
        items.push(self.line(vec![[0.0, -0.1 * top], [0.0, 1.05 * top]], Role::Construction, 0.5));
    }

    /// Surface of the cam and what stands behind it.
    fn cam(&self, items: &mut Vec<Item>, side: usize) {
        let path = &self.behaviour.mechanism.paths[side];
        let sense = self.behaviour.mechanism.springs.sense();
        let [from, to] = self.behaviour.cut.range_m();
        let start = self.behaviour.corners[side].map_or(from, |c| c.lambda_m);
        let radius = self.behaviour.mechanism.roller_m;
        let surface: Vec<Vector> = (0..=SAMPLES)
            .map(|i| {
                let u = i as f64 / SAMPLES as f64;
                // Denser at the start, where it is curved most.
                let p = path.at(start + (to - start) * u * u);
                let [_, normal] = frame(&p, sense);
                place(side, [p.at[0] - radius * normal[0], p.at[1] - radius * normal[1]])
            })
            .collect();
        let (Some(first), Some(last)) = (surface.first().copied(), surface.last().copied()) else { return };
        let back = if sense > 0.0 { [0.0, 0.0] } else { [1.15 * first[0], 1.15 * first[0]] };
        let mut corners = surface;
        corners.extend([[back[1], last[1]], [back[0], first[1]]]);
        items.push(Item::Body { corners, role: Role::Undeformed });
    }

    fn path(&self, items: &mut Vec<Item>, side: usize) {
        let path = &self.behaviour.mechanism.paths[side];
        let [from, to] = self.behaviour.cut.range_m();
        let points = (0..=SAMPLES)
            .map(|i| {
                let u = i as f64 / SAMPLES as f64;
                place(side, path.at(from + (to - from) * u * u).at)
            })
            .collect();
        items.push(self.line(points, Role::Construction, 0.5));
    }

    fn circle(centre: Vector, radius: f64) -> Vec<Vector> {
        (0..=CORNERS)
            .map(|i| {
                let (sin, cos) = maths::sin_cos(2.0 * PI * i as f64 / CORNERS as f64);
                [centre[0] + radius * cos, centre[1] + radius * sin]
            })
            .collect()
    }

    fn roller(&self, items: &mut Vec<Item>, station: &Station, side: usize) {
        let centre = place(side, station.pose.places[side].at);
        let radius = self.behaviour.mechanism.roller_m;
        items.push(self.line(Self::circle(centre, radius), Role::Deformed, 1.0));
        items.push(self.line(Self::circle(centre, 0.2 * radius), Role::Rigid, 1.0));
    }

    fn brace(&self, items: &mut Vec<Item>, station: &Station, side: usize) {
        let ends = [station.pose.joints[side], station.pose.places[side].at].map(|p| place(side, p));
        items.push(self.line(ends.to_vec(), Role::Rigid, 2.0));
    }

    /// A zigzag between the axles.
    fn spring(&self, items: &mut Vec<Item>, station: &Station) {
        const TURNS: usize = 14;
        let [a, b] = [place(0, station.pose.places[0].at), place(1, station.pose.places[1].at)];
        let along = [b[0] - a[0], b[1] - a[1]];
        let length = maths::hypot(along[0], along[1]);
        let across = [-along[1] / length, along[0] / length];
        let wide = 0.35 * self.behaviour.mechanism.roller_m;
        let mut points = vec![a];
        for i in 0..=2 * TURNS {
            let t = 0.15 + 0.7 * i as f64 / (2 * TURNS) as f64;
            let out = if i == 0 || i == 2 * TURNS {
                0.0
            } else if i % 2 == 0 {
                wide
            } else {
                -wide
            };
            points.push([a[0] + t * along[0] + out * across[0], a[1] + t * along[1] + out * across[1]]);
        }
        points.push(b);
        items.push(self.line(points, Role::Undeformed, 0.7));
    }

    fn slider(&self, items: &mut Vec<Item>, station: &Station) {
        let at = station.pose.joints[0];
        let half = 0.6 * self.behaviour.mechanism.roller_m;
        let corners =
            vec![[at[0] - half, at[1] - half], [at[0] + half, at[1] - half], [at[0] + half, at[1] + half], [at[0] - half, at[1] + half]];
        items.push(Item::Body { corners, role: Role::Rigid });
        if !self.design.free_guide {
            let kind = SupportKind::Slider { direction: [0.0, 1.0], rotates: false };
            items.push(Item::Support { at, kind, outward: [1.0, 0.0] });
        }
        let force = format_si(station.still.force_n, &self.design.units.force, 4);
        let up = 3.0 * self.behaviour.mechanism.roller_m;
        items.push(Item::Arrow { from: [at[0], at[1] + half], to: [at[0], at[1] + half + up], label: format!("F = {force}") });
    }

    /// Where the cam is undercut.
    fn corner(&self, items: &mut Vec<Item>) {
        if let Some(corner) = &self.behaviour.corners[0] {
            let travel = format_si(corner.travel_m, &self.design.units.travel, 3);
            items.push(Item::Marker { at: corner.at, label: format!("undercut: corner, used below s = {travel}") });
        }
    }
}
