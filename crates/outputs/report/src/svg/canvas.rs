//! Writes SVG and remembers where texts are.

use std::fmt::Write as _;

use super::colour::Paint;
use super::place::{Rect, clip};
use super::text;
use crate::escape::escape;

/// Above the baseline, in font sizes.
const ASCENT: f64 = 0.86;
/// Below it.
const DESCENT: f64 = 0.24;
/// The faces asked for: what systems have; none is loaded.
const FONTS: &str = "'Segoe UI',Roboto,'Helvetica Neue',Arial,'Liberation Sans','DejaVu Sans',sans-serif";

/// A text and the box that it surely stays in.
#[derive(Clone, Debug)]
pub struct TextBox {
    /// The text as drawn.
    pub text: String,
    /// Its box; an upper bound for the usual sans-serif faces.
    pub rect: Rect,
}

/// A finished drawing.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The SVG element, without XML declaration.
    pub svg: String,
    /// Width of the view box.
    pub width: f64,
    /// Height of the view box.
    pub height: f64,
    /// All texts.
    pub texts: Vec<TextBox>,
}

/// Which end of a text its position is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text looks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    pub(super) size: f64,
    pub(super) bold: bool,
    pub(super) paint: Paint,
    /// Whether it is set off from what lies under it.
    pub(super) halo: bool,
}

impl Style {
    pub(super) const fn plain(size: f64) -> Self {
        Self { size, bold: false, paint: Paint::Ink, halo: false }
    }

    pub(super) const fn muted(size: f64) -> Self {
        Self { size, bold: false, paint: Paint::Muted, halo: false }
    }

    pub(super) const fn label(size: f64, paint: Paint) -> Self {
        Self { size, bold: true, paint, halo: true }
    }

    pub(super) fn width(&self, text: &str) -> f64 {
        text::width(text, self.size, self.bold)
    }

    pub(super) fn height(&self) -> f64 {
        (ASCENT + DESCENT) * self.size
    }

    pub(super) fn fit(&self, text: &str, max: f64) -> String {
        text::fit(text, self.size, self.bold, max)
    }
}

/// A number as it stands in SVG: two decimals, none if they are zero.
pub(super) fn n(value: f64) -> String {
    if !value.is_finite() {
        return "0".to_owned();
    }
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Collects elements.
#[derive(Debug, Default)]
pub(super) struct Canvas {
    body: String,
    texts: Vec<TextBox>,
}

impl Canvas {
    /// Raw element text.
    pub(super) fn raw(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    pub(super) fn open(&mut self, attributes: &str) {
        self.raw(&format!("<g {attributes}>"));
    }

    pub(super) fn close(&mut self) {
        self.raw("</g>");
    }

    /// A group that strokes with a paint.
    pub(super) fn open_stroke(&mut self, paint: Paint, width: f64, more: &str) {
        let space = if more.is_empty() { "" } else { " " };
        self.open(&format!(r#"fill="none" {} stroke-width="{}"{space}{more}"#, paint.attributes("stroke"), n(width)));
    }

    /// A path through points.
    pub(super) fn polyline(&mut self, points: &[[f64; 2]], attributes: &str) {
        if let Some(d) = path_data(points) {
            let space = if attributes.is_empty() { "" } else { " " };
            self.raw(&format!(r#"<path d="{d}"{space}{attributes}/>"#));
        }
    }

    /// Separate line segments in one path.
    pub(super) fn segments(&mut self, segments: &[[[f64; 2]; 2]], attributes: &str) {
        if segments.is_empty() {
            return;
        }
        let mut d = String::new();
        for [a, b] in segments {
            let _ = write!(d, "M{} {}L{} {}", n(a[0]), n(a[1]), n(b[0]), n(b[1]));
        }
        let space = if attributes.is_empty() { "" } else { " " };
        self.raw(&format!(r#"<path d="{d}"{space}{attributes}/>"#));
    }

    /// A closed polygon.
    pub(super) fn polygon(&mut self, points: &[[f64; 2]], attributes: &str) {
        if let Some(d) = path_data(points) {
            self.raw(&format!(r#"<path d="{d}Z" {attributes}/>"#));
        }
    }

    pub(super) fn rect(&mut self, r: &Rect, attributes: &str) {
        self.raw(&format!(
            r#"<rect x="{}" y="{}" width="{}" height="{}" {attributes}/>"#,
            n(r.x0),
            n(r.y0),
            n(r.width().max(0.0)),
            n(r.height().max(0.0))
        ));
    }

    pub(super) fn circle(&mut self, at: [f64; 2], radius: f64, attributes: &str) {
        self.raw(&format!(r#"<circle cx="{}" cy="{}" r="{}" {attributes}/>"#, n(at[0]), n(at[1]), n(radius)));
    }

    /// Slanted lines over a rectangle.
    pub(super) fn hatch(&mut self, r: &Rect, spacing: f64, attributes: &str) {
        let mut lines = Vec::new();
        let mut start = (r.x0 - r.height()) - (r.x0 - r.height()).rem_euclid(spacing);
        while start < r.x1 && lines.len() < 2000 {
            if let Some((a, b)) = clip([start, r.y1], [start + r.height(), r.y0], r) {
                lines.push([a, b]);
            }
            start += spacing;
        }
        self.segments(&lines, attributes);
    }

    /// A text by the place of its baseline.
    pub(super) fn text(&mut self, text: &str, at: [f64; 2], anchor: Anchor, style: Style) -> Rect {
        let width = style.width(text);
        let (left, word) = match anchor {
            Anchor::Start => (at[0], ""),
            Anchor::Middle => (at[0] - 0.5 * width, r#" text-anchor="middle""#),
            Anchor::End => (at[0] - width, r#" text-anchor="end""#),
        };
        let rect = Rect::sized(left, at[1] - ASCENT * style.size, width, style.height());
        if text.is_empty() {
            return rect;
        }
        let weight = if style.bold { r#" font-weight="600""# } else { "" };
        let (x, y, size, shown) = (n(at[0]), n(at[1]), n(style.size), escape(text));
        if style.halo {
            let halo = Paint::Paper.attributes("stroke");
            // The halo is a text of its own, so that programs without `paint-order` draw it behind too.
            self.raw(&format!(
                r#"<text x="{x}" y="{y}" font-size="{size}"{word}{weight} fill="none" {halo} stroke-width="4" stroke-linejoin="round" aria-hidden="true">{shown}</text>"#
            ));
        }
        let fill = style.paint.attributes("fill");
        self.raw(&format!(r#"<text x="{x}" y="{y}" font-size="{size}"{word}{weight} {fill}>{shown}</text>"#));
        self.texts.push(TextBox { text: text.to_owned(), rect });
        rect
    }

    /// A text filling a box that was made for it.
    pub(super) fn text_in(&mut self, text: &str, rect: &Rect, style: Style) {
        self.text(text, [0.5 * (rect.x0 + rect.x1), rect.y0 + ASCENT * style.size], Anchor::Middle, style);
    }

    /// The SVG element around everything.
    pub(super) fn finish(self, width: f64, height: f64, title: &str, description: &str) -> Drawing {
        let (w, h) = (n(width), n(height));
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" role=\"img\" font-family=\"{FONTS}\">\n\
             <title>{}</title>\n<desc>{}</desc>\n{}</svg>\n",
            escape(title),
            escape(description),
            self.body
        );
        Drawing { svg, width, height, texts: self.texts }
    }
}

/// `M x y L x y …`, or nothing for less than two points.
fn path_data(points: &[[f64; 2]]) -> Option<String> {
    let (first, rest) = points.split_first()?;
    if rest.is_empty() {
        return None;
    }
    let mut d = format!("M{} {}L", n(first[0]), n(first[1]));
    for (i, p) in rest.iter().enumerate() {
        let space = if i == 0 { "" } else { " " };
        let _ = write!(d, "{space}{} {}", n(p[0]), n(p[1]));
    }
    Some(d)
}
