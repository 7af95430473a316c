//! Pictures that move: every frame in one drawing, all but one of them hidden until the page's style shows them.

use std::fmt::Write as _;

use forcewright_base::units::{format_number, format_si};
use forcewright_model::{Film, Item};

use super::canvas::{Anchor, Canvas, Drawing, Style};
use super::scene::{EDGE, SceneSize, Sheet, entries};
use super::text;
use crate::words::with_minus;

/// Above the picture, for what is said of a frame.
const HEAD: f64 = 26.0;
const BASELINE: f64 = 19.0;
const SAID: Style = Style::plain(15.0);
/// Significant digits of a frame's place.
const DIGITS: usize = 4;
const SHORT: usize = 3;

/// Which frames a drawing holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Frames {
    /// The chosen one.
    Chosen,
    /// All, to be shown one at a time by the style for a figure.
    All,
}

/// The class of a frame, of its button and of its label.
pub(crate) fn class(frame: usize) -> String {
    format!("k{frame}")
}

/// The place of a frame with its unit.
fn place(film: &Film, at: f64) -> String {
    let unit = &film.axis.display;
    if unit.from_si(at).is_finite() { with_minus(&format_si(at, unit, DIGITS)) } else { "–".to_owned() }
}

/// The same for a narrow label: without its unit.
pub(crate) fn short_place(film: &Film, at: f64) -> String {
    let shown = film.axis.display.from_si(at) + 0.0;
    if shown.is_finite() { with_minus(&format_number(shown, SHORT)) } else { "–".to_owned() }
}

/// The index of the frame that is seen at first; `None` without frames.
pub(crate) fn chosen(film: &Film) -> Option<usize> {
    film.frames.len().checked_sub(1).map(|last| film.chosen.min(last))
}

/// What is said of a frame.
pub(crate) fn said(film: &Film, frame: usize) -> String {
    film.frames.get(frame).map_or_else(String::new, |f| {
        let place = format!("{} = {}", film.axis.label, place(film, f.at));
        if f.note.is_empty() { place } else { format!("{place}: {}", f.note) }
    })
}

/// Draws a film; `page_id` is the element around it for whose buttons the style is written.
pub(super) fn draw(film: &Film, size: SceneSize, title: &str, caption: &str, frames: Frames, page_id: &str) -> Drawing {
    let stage = &film.stage;
    let everything = film.frames.iter().flat_map(|f| &f.items).chain(&stage.items);
    let mut sheet = Sheet::new(everything, stage.scale.as_ref(), size);
    sheet.lower(HEAD);
    let mut canvas = Canvas::default();
    if frames == Frames::All {
        canvas.raw(&format!("<style>{}</style>", style(page_id, film.frames.len())));
    }
    let mut placer = sheet.placer();
    sheet.things(&mut canvas, &stage.items, &mut placer);
    // The texts that stay keep off whatever moves.
    let mut crowd = placer.clone();
    for frame in &film.frames {
        sheet.things(&mut Canvas::default(), &frame.items, &mut crowd);
    }
    for taken in sheet.labels(&mut canvas, &stage.items, &mut crowd) {
        placer.add_text(taken);
    }
    placer.add_text(super::place::Rect { x0: EDGE, y0: 0.0, x1: sheet.width - EDGE, y1: HEAD });
    let chosen = chosen(film);
    for (i, frame) in film.frames.iter().enumerate() {
        if frames == Frames::Chosen && chosen != Some(i) {
            continue;
        }
        // An attribute, not a style: a page without its style shows the chosen frame.
        let hidden = if chosen == Some(i) { "" } else { r#" display="none""# };
        canvas.open(&format!(r#"class="k {}"{hidden}"#, class(i)));
        let mut placer = placer.clone();
        sheet.things(&mut canvas, &frame.items, &mut placer);
        sheet.labels(&mut canvas, &frame.items, &mut placer);
        let words = text::fit(&said(film, i), SAID.size, SAID.bold, sheet.width - 2.0 * EDGE);
        canvas.text(&words, [EDGE, BASELINE], Anchor::Start, SAID);
        canvas.close();
    }
    let shown: Vec<Item> =
        stage.items.iter().chain(chosen.and_then(|i| film.frames.get(i)).iter().flat_map(|f| &f.items)).cloned().collect();
    let bottom = sheet.below(&mut canvas, stage, &entries(&shown, stage));
    let mut words = String::from(caption);
    for part in [&stage.description, &span(film)] {
        if !words.is_empty() && !part.is_empty() {
            words.push(' ');
        }
        words.push_str(part);
    }
    canvas.finish(sheet.width, bottom, title, &words)
}

/// How far the frames go, in words.
fn span(film: &Film) -> String {
    match (film.frames.first(), film.frames.last()) {
        (Some(a), Some(b)) if film.frames.len() > 1 => {
            format!("{} frames, {} from {} to {}.", film.frames.len(), film.axis.label, place(film, a.at), place(film, b.at))
        }
        _ => String::new(),
    }
}

/// What shows the frame whose button is pressed, or whose label the pointer is on where the browser can tell (`:has()`).
fn style(id: &str, frames: usize) -> String {
    let mut out = format!(
        "#{id}>input:checked~svg>.k{{display:none}}\n@media screen and (hover:hover){{#{id}:has(>.strip>label.f:hover)>svg>g.k{{display:none}}}}\n"
    );
    let mut hover = String::new();
    for i in 0..frames {
        let k = class(i);
        let _ = write!(out, "#{id}>.{k}:checked~svg>.{k}{{display:inline}}");
        let _ = write!(out, "#{id}>.{k}:checked~.strip>.{k}{{background:var(--fw-main);color:var(--fw-paper)}}");
        let _ = writeln!(hover, "#{id}:has(>.strip>label.{k}:hover)>svg>g.k.{k}{{display:inline}}");
    }
    let _ = write!(out, "\n@media screen and (hover:hover){{\n{hover}}}");
    out
}
