//! Pictures of plates as they are cut: outline with its windows and holes, overall size, narrow places.

use std::fmt::Write as _;

use forcewright_base::units::{Unit, format_si};
use forcewright_curves::{Bounds, Profile};
use forcewright_model::{Part, PartSet};

use super::canvas::{Anchor, Canvas, Drawing, Style, n};
use super::colour::Paint;
use super::place::{BESIDE, Placer, Rect, from_edge};
use super::scene::SceneSize;
use super::symbols;
use super::ticks;

/// Room for the dimension lines below, on the left beside their text, and around the rest.
const DIMENSION: f64 = 58.0;
const MARGIN: f64 = 40.0;
const EDGE: f64 = 14.0;
/// From the plate to its dimension line.
const OFF: f64 = 24.0;
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

/// Draws plates in their common plane.
pub(super) fn draw(set: &PartSet, size: SceneSize, title: &str, caption: &str) -> Drawing {
    let bounds = set.parts.iter().fold(Bounds::of([]), |all, part| all.union(part.outline.bounds()));
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
    for part in &set.parts {
        plate(&mut canvas, &mut placer, part, &view);
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

/// A plate: what is left of its outline after windows and holes.
fn plate(canvas: &mut Canvas, placer: &mut Placer, part: &Part, view: &View) {
    let holes = part.holes.iter().map(|h| Profile::circle(h.centre_m, 0.5 * h.diameter_m));
    let mut d = String::new();
    for profile in std::iter::once(part.outline.clone()).chain(part.cutouts.iter().cloned()).chain(holes) {
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
    let one = |part: &Part| {
        let [width, height] = part.size_m().map(|m| shown(m, &set.display));
        let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
        format!(
            "{}: {width} × {height}, {} thick, {}, {}.",
            part.name,
            shown(part.depth_m, &set.display),
            count(part.cutouts.len(), "window"),
            count(part.holes.len(), "hole")
        )
    };
    set.parts.iter().map(one).collect::<Vec<_>>().join(" ")
}

fn shown(m: f64, unit: &Unit) -> String {
    format_si(m, unit, 4)
}
