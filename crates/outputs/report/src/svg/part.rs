//! Pictures of parts: plates as they are cut, with windows and holes, turned parts cut along their axis, springs from the side; overall size, narrow places.

use std::fmt::Write as _;

use forcewright_base::units::{Unit, format_number, format_si};
use forcewright_curves::{Bounds, Motion, Profile};
use forcewright_model::{Body, Part, PartSet, Plate, Turned};

use super::canvas::{Anchor, Canvas, Drawing, Style, n};
use super::colour::Paint;
use super::place::{BESIDE, Placer, Rect, from_edge};
use super::scene::SceneSize;
use super::spring::Wire;
use super::symbols;
use super::ticks;

/// Room for the dimension lines below, on the left beside their text, and around the rest.
const DIMENSION: f64 = 58.0;
const MARGIN: f64 = 40.0;
const EDGE: f64 = 14.0;
/// From the plate to its dimension line.
const OFF: f64 = 24.0;
/// From a turned part to the one before it, in its largest radius.
const ROOM: f64 = 0.3;
/// Chords of curves, in drawing units.
const CHORD: f64 = 0.05;
const SMALL: Style = Style::plain(13.0);

/// From metres to the drawing.
struct View {
    scale: f64,
    low: [f64; 2],
    origin: [f64; 2],
}

impl View {
    fn at(&self, p: [f64; 2]) -> [f64; 2] {
        [self.origin[0] + (p[0] - self.low[0]) * self.scale, self.origin[1] - (p[1] - self.low[1]) * self.scale]
    }
}

/// What is drawn of a part, in metres: boundaries or the wire of a spring, and the ends of a centre line.
#[derive(Default)]
struct Shown {
    boundaries: Vec<Profile>,
    axis: Option<[[f64; 2]; 2]>,
    wire: Option<Wire>,
}

impl Shown {
    fn bounds(&self) -> Bounds {
        let all = self.boundaries.iter().fold(Bounds::of([]), |all, profile| all.union(profile.bounds()));
        self.wire.iter().fold(all, |all, wire| all.union(wire.bounds))
    }
}

/// Plates lie where they are, in their common plane; one that would lie on another follows to the right, and so do turned parts and
/// springs, axes upright.
fn shown_parts(set: &PartSet) -> Vec<Shown> {
    let mut bounds = Bounds::of([]);
    let mut laid: Vec<Bounds> = Vec::new();
    let mut plates = Vec::new();
    for plate in set.parts.iter().filter_map(Part::plate) {
        let own = plate.outline.bounds();
        let shift_m = if laid.iter().any(|other| overlap(other, &own)) {
            let room_m = ROOM * 0.5 * (own.max_m[0] - own.min_m[0]);
            [bounds.max_m[0] + room_m - own.min_m[0], bounds.min_m[1] - own.min_m[1]]
        } else {
            [0.0; 2]
        };
        let shown = plate_boundaries(plate, &Motion::new(0.0, shift_m));
        let moved = shown.boundaries[0].bounds();
        bounds = bounds.union(moved);
        laid.push(moved);
        plates.push(shown);
    }
    let mut plates = plates.into_iter();
    let one = |part: &Part| {
        let corner = |room_m: f64| {
            let left_m = if bounds.max_m[0].is_finite() { bounds.max_m[0] + room_m } else { 0.0 };
            [left_m, if bounds.min_m[1].is_finite() { bounds.min_m[1] } else { 0.0 }]
        };
        let shown = match &part.body {
            Body::Plate(_) => return plates.next().unwrap_or_default(),
            Body::Turned(turned) => {
                let radius_m = turned.largest_radius_m();
                let [left_m, low_m] = corner(ROOM * radius_m);
                sections(turned, [left_m + radius_m, low_m])
            }
            Body::Coil(coil) => match Wire::new(coil, corner(ROOM * 0.5 * coil.outer_diameter_m())) {
                Some((wire, axis_m)) => Shown { boundaries: Vec::new(), axis: Some(axis_m), wire: Some(wire) },
                None => Shown::default(),
            },
        };
        bounds = bounds.union(shown.bounds());
        shown
    };
    set.parts.iter().map(one).collect()
}

fn overlap(a: &Bounds, b: &Bounds) -> bool {
    (0..2).all(|k| a.min_m[k] < b.max_m[k] && b.min_m[k] < a.max_m[k])
}

/// The outline first.
fn plate_boundaries(plate: &Plate, place: &Motion) -> Shown {
    let holes = plate.holes.iter().map(|h| Profile::circle(h.centre_m, 0.5 * h.diameter_m));
    let all = std::iter::once(plate.outline.clone()).chain(plate.cutouts.iter().cloned()).chain(holes);
    Shown { boundaries: all.map(|profile| profile.transformed(place)).collect(), axis: None, wire: None }
}

/// Both halves of a body cut along its axis, the foot of which is at a point. Nothing of a body that cannot be made.
fn sections(turned: &Turned, foot_m: [f64; 2]) -> Shown {
    // From (z, radius) to the right of an upright axis, and from there to the left.
    let upright = Motion::mirror([0.0; 2], [1.0, 1.0]);
    let placed = Motion::new(0.0, foot_m);
    let half = |angle_rad: f64| turned.half_section(angle_rad).map(|profile| profile.transformed(&upright));
    let right = half(0.0).map(|profile| profile.transformed(&placed));
    let left = half(std::f64::consts::PI).map(|profile| profile.transformed(&Motion::mirror([0.0; 2], [0.0, 1.0])).transformed(&placed));
    let end_m = [foot_m[0], foot_m[1] + turned.length_m()];
    Shown { boundaries: right.into_iter().chain(left).collect(), axis: Some([foot_m, end_m]), wire: None }
}

/// Draws plates in their common plane, turned parts and springs beside them.
pub(super) fn draw(set: &PartSet, size: SceneSize, title: &str, caption: &str) -> Drawing {
    let parts = shown_parts(set);
    let bounds = parts.iter().fold(Bounds::of([]), |all, part| all.union(part.bounds()));
    let extent = |k: usize| ticks::sane(bounds.max_m[k] - bounds.min_m[k]).filter(|e| *e > 0.0).unwrap_or(1.0);
    let (w, h) = (extent(0), extent(1));
    let texts = [w, h].map(|length_m| format_si(length_m, &set.display, 4));
    let beside = DIMENSION + SMALL.width(&texts[1]);
    let scale = ((size.width - beside - MARGIN) / w).min((size.max_height - DIMENSION - MARGIN) / h);
    let height = h * scale + DIMENSION + MARGIN;
    let left = beside + 0.5 * (size.width - beside - MARGIN - w * scale);
    let view = View { scale, low: bounds.min_m, origin: [left, height - DIMENSION] };
    let mut canvas = Canvas::default();
    let mut placer = Placer::new(Rect::sized(EDGE, 4.0, size.width - 2.0 * EDGE, height - 8.0));
    for part in &parts {
        body(&mut canvas, &mut placer, part, &view);
    }
    let corners = [view.at(bounds.min_m), view.at(bounds.max_m)];
    for (k, text) in texts.iter().enumerate() {
        dimension(&mut canvas, &mut placer, k, corners, text);
    }
    for mark in &set.marks {
        symbols::ring(&mut canvas, view.at(mark.at_m));
        let [x, y] = view.at(mark.at_m);
        placer.add_solid(Rect::sized(x - 9.0, y - 9.0, 18.0, 18.0));
    }
    let style = Style::label(14.0, Paint::Limit);
    for mark in &set.marks {
        let text = style.fit(&mark.text, 0.5 * size.width);
        if let Some(placed) = placer.place(view.at(mark.at_m), style.width(&text), style.height(), BESIDE) {
            if let Some(leader) = placed.leader.and_then(|l| from_edge(l, symbols::RING + 1.1)) {
                canvas.segments(&[leader], &format!(r#"fill="none" {} stroke-width="1""#, Paint::Limit.attributes("stroke")));
            }
            canvas.text_in(&text, &placed.rect, style);
        }
    }
    canvas.finish(size.width, height + 4.0, title, format!("{caption} {}", words(set)).trim())
}

/// What is between the boundaries of a part, or its wire, and its centre line.
fn body(canvas: &mut Canvas, placer: &mut Placer, part: &Shown, view: &View) {
    if let Some(wire) = &part.wire {
        wire.draw(canvas, placer, view.scale, |p| view.at(p));
    } else {
        between(canvas, placer, part, view);
    }
    if let Some(axis) = part.axis {
        let dashes = r#"stroke-dasharray="12 3 2 3""#;
        canvas.open_stroke(Paint::Muted, 1.0, dashes);
        canvas.segments(&[axis.map(|p| view.at(p))], "");
        canvas.close();
    }
}

/// What is between the boundaries of a part.
fn between(canvas: &mut Canvas, placer: &mut Placer, part: &Shown, view: &View) {
    let mut d = String::new();
    for profile in &part.boundaries {
        let at: Vec<[f64; 2]> = profile.tessellate(CHORD / view.scale).into_iter().map(|p| view.at(p)).collect();
        for (i, p) in at.iter().enumerate() {
            let _ = write!(d, "{}{} {}", if i == 0 { "M" } else { "L" }, n(p[0]), n(p[1]));
        }
        d.push('Z');
        let closed: Vec<[f64; 2]> = at.iter().chain(at.first()).copied().collect();
        placer.add_line(&closed, 1.5, 1.0);
    }
    let paint = Paint::fill_and_stroke(Paint::Body, Paint::Ink);
    canvas.raw(&format!(r#"<path d="{d}" {paint} fill-rule="evenodd" stroke-width="1" stroke-linejoin="round"/>"#));
}

/// The width below (`k` 0) or the height on the left (`k` 1), between lower left and upper right corner.
fn dimension(canvas: &mut Canvas, placer: &mut Placer, k: usize, [low, high]: [[f64; 2]; 2], text: &str) {
    let place = |along: f64, off: f64| if k == 0 { [along, low[1] + off] } else { [low[0] - off, along] };
    let (from, to) = (low[k], high[k]);
    let ends = [place(from, OFF), place(to, OFF)];
    let ticks = [from, to].map(|at| [place(at, 5.0), place(at, OFF + 5.0)]);
    canvas.open_stroke(Paint::Muted, 1.0, "");
    canvas.segments(&[ends, ticks[0], ticks[1]], "");
    canvas.close();
    placer.add_line(&ends, 1.0, 1.0);
    let rect = if k == 0 {
        canvas.text(text, [0.5 * (from + to), low[1] + OFF + 18.0], Anchor::Middle, SMALL)
    } else {
        canvas.text(text, [low[0] - OFF - 8.0, 0.5 * (from + to) + 4.0], Anchor::End, SMALL)
    };
    placer.add_text(rect);
}

/// What the picture shows, for those who cannot see it.
fn words(set: &PartSet) -> String {
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let one = |part: &Part| match &part.body {
        Body::Plate(plate) => {
            let [width, height] = plate.size_m().map(|m| shown(m, &set.display));
            format!(
                "{}: {width} × {height}, {} thick, {}, {}.",
                part.name,
                shown(plate.depth_m, &set.display),
                count(plate.cutouts.len(), "window"),
                count(plate.holes.len(), "hole")
            )
        }
        Body::Turned(turned) => {
            let [diameter, length] = [2.0 * turned.largest_radius_m(), turned.length_m()].map(|m| shown(m, &set.display));
            format!("{}: diameter {diameter}, {length} long, {}.", part.name, count(turned.sections.len(), "section"))
        }
        Body::Coil(coil) => {
            let [wire, diameter, length] = [coil.wire_m, coil.outer_diameter_m(), coil.length_m()].map(|m| shown(m, &set.display));
            let turns = format_number(coil.turns(), 4);
            format!("{}: wire {wire}, diameter {diameter}, {length} long, {turns} turns.", part.name)
        }
    };
    set.parts.iter().map(one).collect::<Vec<_>>().join(" ")
}

fn shown(m: f64, unit: &Unit) -> String {
    format_si(m, unit, 4)
}
