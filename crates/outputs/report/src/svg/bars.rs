//! Bar charts: causes below each other, bars to both sides of zero.

use std::fmt::Write as _;

use forcewright_base::units::format_number;
use forcewright_model::{BarRow, Bars};

use super::canvas::{Anchor, Canvas, Drawing, Style};
use super::colour::Paint;
use super::legend::{self, Entry, Swatch};
use super::place::Rect;
use super::plot::look;
use super::text;
use super::ticks::{self, Ticks};
use crate::words::{over_unit, with_minus};

const EDGE: f64 = 14.0;
const TOP: f64 = 10.0;
/// Height of a bar, and of the gap between rows.
const BAR: f64 = 15.0;
const GAP: f64 = 12.0;
const NAME: Style = Style::plain(13.0);
const VALUE: Style = Style::muted(13.0);
const TITLE: Style = Style { size: 14.0, bold: true, paint: Paint::Ink, halo: false };
const DIGITS: usize = 3;

/// Draws a bar chart.
pub(super) fn draw(bars: &Bars, width: f64, title: &str, caption: &str) -> Drawing {
    let values = || bars.rows.iter().flat_map(|r| r.ends.iter().flatten()).filter_map(|v| shown(bars, *v)).chain([0.0]);
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let x = ticks::cover(low, high, 6);
    let names: Vec<String> = bars.rows.iter().map(|r| NAME.fit(&r.label, 0.42 * width)).collect();
    let widest = |texts: &[String], style: Style| texts.iter().map(|t| style.width(t)).fold(0.0, f64::max);
    let told: Vec<Vec<String>> = bars.rows.iter().map(|row| numbers(bars, row)).collect();
    let left = EDGE + widest(&names, NAME) + 12.0;
    let right = EDGE + told.iter().map(|t| widest(t, VALUE)).fold(0.0, f64::max) + 10.0;
    let each = BAR * bars.series.len().max(1) as f64;
    let height = bars.rows.len() as f64 * (each + GAP) + GAP;
    let area = Rect { x0: left, y0: TOP, x1: width - right, y1: TOP + height };
    let at = |v: f64| area.x0 + ((v - x.low) / (x.high - x.low)).clamp(0.0, 1.0) * area.width();
    let mut canvas = Canvas::default();
    let below = axis(&mut canvas, bars, &x, &area, width);
    for (i, row) in bars.rows.iter().enumerate() {
        let top = area.y0 + GAP + i as f64 * (each + GAP);
        canvas.text(&names[i], [area.x0 - 10.0, top + 0.5 * each + 4.5], Anchor::End, NAME);
        for (k, ((_, stroke), ends)) in bars.series.iter().zip(&row.ends).enumerate() {
            let y = top + BAR * k as f64;
            let (paint, ..) = look(*stroke);
            // The lower value of the cause is an outline, the upper one is filled.
            let edge = format!(r#"fill="none" {} stroke-width="1.3""#, Paint::Ink.attributes("stroke"));
            for (end, look) in [(ends[1], paint.attributes("fill")), (ends[0], edge)] {
                let Some(v) = shown(bars, end) else { continue };
                let (a, b) = (at(0.0).min(at(v)), at(0.0).max(at(v)));
                canvas.rect(&Rect { x0: a, y0: y + 2.0, x1: b, y1: y + BAR - 2.0 }, &look);
            }
            canvas.text(&told[i][k], [width - EDGE, y + 0.5 * BAR + 4.5], Anchor::End, VALUE);
        }
    }
    canvas.open_stroke(Paint::Ink, 1.4, "");
    canvas.segments(&[[[at(0.0), area.y0], [at(0.0), area.y1]]], "");
    canvas.close();
    let entries: Vec<Entry> =
        bars.series.iter().map(|(text, stroke)| Entry { swatch: Swatch::Bar { paint: look(*stroke).0 }, text: text.clone() }).collect();
    let bottom = legend::draw(&mut canvas, &entries, EDGE, width - EDGE, below);
    canvas.finish(width, bottom + 6.0, title, description(bars, &told, caption).trim())
}

/// A value in the unit shown, if it can be drawn.
fn shown(bars: &Bars, si: f64) -> Option<f64> {
    ticks::sane(si).and_then(|v| ticks::sane(bars.axis.display.from_si(v)))
}

/// Both ends of each bar of a row as numbers.
fn numbers(bars: &Bars, row: &BarRow) -> Vec<String> {
    let number = |si: f64| {
        shown(bars, si).map_or_else(
            || "–".to_owned(),
            |v| {
                let text = with_minus(&format_number(v + 0.0, DIGITS));
                if v > 0.0 { format!("+{text}") } else { text }
            },
        )
    };
    (0..bars.series.len())
        .map(|k| row.ends.get(k).map_or_else(|| "–".to_owned(), |[a, b]| format!("{} … {}", number(*a), number(*b))))
        .collect()
}

/// Grid, numbers and title of the axis; returns the place below them.
fn axis(canvas: &mut Canvas, bars: &Bars, x: &Ticks, area: &Rect, width: f64) -> f64 {
    let step = area.width() / (x.values.len().max(2) - 1) as f64;
    let lines: Vec<_> = (0..x.values.len()).map(|i| area.x0 + i as f64 * step).map(|at| [[at, area.y0], [at, area.y1]]).collect();
    canvas.open_stroke(Paint::Grid, 1.0, "");
    canvas.segments(&lines, "");
    canvas.close();
    let mut edge = f64::NEG_INFINITY;
    for (line, label) in lines.iter().zip(&x.labels) {
        let half = 0.5 * VALUE.width(label);
        let at = line[0][0];
        if at - half > edge {
            canvas.text(label, [at, area.y1 + 19.0], Anchor::Middle, VALUE);
            edge = at + half + 6.0;
        }
    }
    let mut y = area.y1 + 42.0;
    for line in text::wrap(&over_unit(&bars.axis.label, &bars.axis.display), TITLE.size * 1.13, width - 2.0 * EDGE) {
        let half = 0.5 * TITLE.width(&line);
        let middle = (0.5 * (area.x0 + area.x1)).clamp(EDGE + half, (width - EDGE - half).max(EDGE + half));
        canvas.text(&line, [middle, y], Anchor::Middle, TITLE);
        y += 19.0;
    }
    y - 4.0
}

/// The chart in words, for those who cannot see it.
fn description(bars: &Bars, told: &[Vec<String>], caption: &str) -> String {
    let mut out = format!("{caption} {}.", over_unit(&bars.axis.label, &bars.axis.display));
    for (row, told) in bars.rows.iter().zip(told) {
        for ((name, _), text) in bars.series.iter().zip(told) {
            let _ = write!(out, " {}, {name}: {text}.", row.label);
        }
    }
    out
}
