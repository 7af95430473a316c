//! The legend below a figure.

use super::canvas::{Anchor, Canvas, Style};
use super::colour::{self, Paint};
use super::place::Rect;
use super::text;

const SIZE: f64 = 13.0;
const ROW: f64 = 19.0;
const SWATCH: f64 = 34.0;
const GAP: f64 = 18.0;
/// Colours in a swatch of values.
const STEPS: u8 = 10;

/// Opacity of tinted regions.
pub(super) const AREA: f64 = 0.2;

/// Radius of a measured point.
pub(super) const DOT: f64 = 2.4;

/// Attributes of measured points.
pub(super) fn dots(paint: Paint, open: bool) -> String {
    if open { format!(r#"{} stroke-width="1.2""#, Paint::fill_and_stroke(Paint::Paper, paint)) } else { paint.attributes("fill") }
}

/// What stands before a legend text.
#[derive(Clone, Debug)]
pub(super) enum Swatch {
    /// A line with a dash pattern (empty is solid) and small squares on it or not.
    Line { paint: Paint, width: f64, dash: &'static str, squares: bool },
    /// A line coloured by values; `faded` for a copy.
    Values { faded: bool },
    /// A hatched region.
    Band,
    /// A marked point.
    Point,
    /// A rigid part.
    Body,
    /// A solid that stays where it is.
    Plate,
    /// A rigid part that moves.
    Moving,
    /// A tinted region.
    Area { paint: Paint },
    /// Measured points, filled or open.
    Dots { paint: Paint, open: bool },
    /// A bar.
    Bar { paint: Paint },
}

/// One entry.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) swatch: Swatch,
    pub(super) text: String,
}

/// Draws entries in rows from `top` between `left` and `right`; returns where the next thing may start.
pub(super) fn draw(canvas: &mut Canvas, entries: &[Entry], left: f64, right: f64, top: f64) -> f64 {
    let style = Style::plain(SIZE);
    let (mut x, mut y) = (left, top);
    for entry in entries {
        let lines = text::wrap(&entry.text, SIZE, right - left - SWATCH - 8.0);
        let width = SWATCH + 8.0 + lines.iter().map(|l| style.width(l)).fold(0.0, f64::max);
        if x > left && (x + width > right || lines.len() > 1) {
            x = left;
            y += ROW;
        }
        swatch(canvas, &entry.swatch, x, y + 0.5 * ROW);
        for (i, line) in lines.iter().enumerate() {
            canvas.text(line, [x + SWATCH + 8.0, y + 14.0 + i as f64 * ROW], Anchor::Start, style);
        }
        if lines.len() > 1 {
            x = left;
            y += lines.len() as f64 * ROW;
        } else {
            x += width + GAP;
        }
    }
    if x > left { y + ROW } else { y }
}

fn swatch(canvas: &mut Canvas, swatch: &Swatch, x: f64, y: f64) {
    match swatch {
        Swatch::Line { paint, width, dash, squares } => {
            canvas.open_stroke(*paint, *width, &dashed(dash));
            canvas.polyline(&[[x, y], [x + SWATCH, y]], "");
            canvas.close();
            if *squares {
                let side = 6.0;
                let r = Rect::sized(x + 0.5 * (SWATCH - side), y - 0.5 * side, side, side);
                canvas.rect(&r, &paint.attributes("fill"));
            }
        }
        Swatch::Values { faded } => {
            canvas.open(&format!(r#"opacity="{}""#, if *faded { 0.5 } else { 1.0 }));
            let r = Rect::sized(x, y - 3.0, SWATCH, 6.0);
            canvas.rect(&r.grown(0.8), &Paint::Ink.attributes("fill"));
            for part in 0..STEPS {
                // Each reaches to the end under the next ones, so that no seam shines through.
                let left = r.x0 + f64::from(part) / f64::from(STEPS) * r.width();
                let level = part * ((colour::LEVELS - 1) / (STEPS - 1));
                canvas.rect(&Rect { x0: left, ..r }, &format!(r#"fill="{}""#, colour::of_level(level)));
            }
            canvas.close();
        }
        Swatch::Band => band(canvas, &Rect::sized(x, y - 7.0, SWATCH, 14.0)),
        Swatch::Body => {
            canvas.rect(
                &Rect::sized(x, y - 4.0, SWATCH, 8.0),
                &format!(r#"{} stroke-width="1.4""#, Paint::fill_and_stroke(Paint::Body, Paint::Ink)),
            );
        }
        Swatch::Plate => {
            canvas.rect(
                &Rect::sized(x + 0.5 * SWATCH - 9.0, y - 7.0, 18.0, 14.0),
                &format!(r#"{} stroke-width="1.4""#, Paint::fill_and_stroke(Paint::Body, Paint::Ink)),
            );
        }
        Swatch::Moving => {
            canvas.circle(
                [x + 0.5 * SWATCH, y],
                6.0,
                &format!(r#"{} stroke-width="2""#, Paint::fill_and_stroke(Paint::Paper, Paint::Main)),
            );
        }
        Swatch::Area { paint } => {
            let r = Rect::sized(x, y - 6.0, SWATCH, 12.0);
            canvas.rect(&r, &format!(r#"{} fill-opacity="{AREA}""#, paint.attributes("fill")));
        }
        Swatch::Dots { paint, open } => {
            canvas.open(&dots(*paint, *open));
            for part in [0.2, 0.5, 0.8] {
                canvas.circle([x + part * SWATCH, y], DOT, "");
            }
            canvas.close();
        }
        Swatch::Bar { paint } => canvas.rect(&Rect::sized(x, y - 5.0, SWATCH, 10.0), &paint.attributes("fill")),
        Swatch::Point => {
            canvas.circle([x + 0.5 * SWATCH, y], 4.5, &format!(r#"{} stroke-width="2""#, Paint::fill_and_stroke(Paint::Paper, Paint::Ink)));
        }
    }
}

/// A tinted and hatched region with its edges.
pub(super) fn band(canvas: &mut Canvas, r: &Rect) {
    canvas.rect(r, &format!(r#"{} fill-opacity="0.13""#, Paint::Band.attributes("fill")));
    canvas.open_stroke(Paint::Band, 1.0, "");
    canvas.hatch(r, 8.0, r#"stroke-opacity="0.45""#);
    canvas.segments(&[[[r.x0, r.y0], [r.x1, r.y0]], [[r.x0, r.y1], [r.x1, r.y1]]], "");
    canvas.close();
}

/// The attribute for a dash pattern; nothing for a solid line.
pub(super) fn dashed(dash: &str) -> String {
    if dash.is_empty() { String::new() } else { format!(r#"stroke-dasharray="{dash}""#) }
}
