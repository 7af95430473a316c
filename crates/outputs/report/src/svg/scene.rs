//! Pictures of mechanisms.

use forcewright_base::units::{Unit, format_si};
use forcewright_model::{ColourScale, Item, Look, Role, Scene};

use super::canvas::{Anchor, Canvas, Drawing, Style, n};
use super::colour::{self, Paint};
use super::legend::{self, Entry, Swatch};
use super::place::{BESIDE, Placer, Rect, distance, from_edge};
use super::symbols;
use super::ticks;
use crate::words::{over_unit, with_minus};

/// Size of a picture in drawing units; about a CSS pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneSize {
    /// Of the whole drawing.
    pub width: f64,
    /// The mechanism is drawn at most this high; scale and legend are added.
    pub max_height: f64,
}

impl Default for SceneSize {
    fn default() -> Self {
        Self { width: 760.0, max_height: 560.0 }
    }
}

/// Room around the mechanism for symbols and texts.
const MARGIN: f64 = 46.0;
pub(super) const EDGE: f64 = 14.0;
const LABEL: Style = Style::label(14.0, Paint::Ink);
const SMALL: Style = Style::muted(13.0);
const TITLE: Style = Style { size: 14.0, bold: true, paint: Paint::Ink, halo: false };

/// From metres to the drawing.
#[derive(Clone, Copy, Debug)]
struct View {
    scale: f64,
    middle: [f64; 2],
    centre: [f64; 2],
}

impl View {
    fn at(&self, p: [f64; 2]) -> Option<[f64; 2]> {
        let x = self.centre[0] + (ticks::sane(p[0])? - self.middle[0]) * self.scale;
        let y = self.centre[1] - (ticks::sane(p[1])? - self.middle[1]) * self.scale;
        (x.is_finite() && y.is_finite()).then_some([x, y])
    }

    fn thickness(&self, width_m: f64) -> f64 {
        let width = width_m * self.scale;
        if width.is_finite() { width.clamp(1.4, 80.0) } else { 1.4 }
    }

    fn radius(&self, radius_m: f64) -> f64 {
        let radius = radius_m * self.scale;
        if radius.is_finite() { radius.clamp(0.7, 4000.0) } else { 0.7 }
    }
}

/// Draws a picture.
pub(super) fn draw(scene: &Scene, size: SceneSize, title: &str, caption: &str) -> Drawing {
    let mut sheet = Sheet::new(&scene.items, scene.scale.as_ref(), size);
    let mut canvas = Canvas::default();
    let mut placer = sheet.placer();
    sheet.things(&mut canvas, &scene.items, &mut placer);
    sheet.labels(&mut canvas, &scene.items, &mut placer);
    let bottom = sheet.below(&mut canvas, scene, &entries(&scene.items, scene));
    let words = if caption.is_empty() { scene.description.clone() } else { format!("{caption} {}", scene.description) };
    canvas.finish(sheet.width, bottom, title, words.trim())
}

/// The paper of a picture: how large what is drawn on it becomes.
pub(super) struct Sheet<'a> {
    pub(super) width: f64,
    height: f64,
    view: View,
    scale: Option<&'a ColourScale>,
}

impl<'a> Sheet<'a> {
    /// A sheet on which all these things have room.
    pub(super) fn new<'b>(items: impl IntoIterator<Item = &'b Item>, scale: Option<&'a ColourScale>, size: SceneSize) -> Self {
        let side = |v: f64, least: f64, usual: f64| if v.is_finite() { v.clamp(least, 4000.0) } else { usual };
        let (width, max_height) = (side(size.width, 360.0, 760.0), side(size.max_height, 240.0, 560.0));
        let (view, height) = fit(items, width, max_height);
        Self { width, height, view, scale }
    }

    /// Moves everything down to make room above it.
    pub(super) fn lower(&mut self, by: f64) {
        self.height += by;
        self.view.centre[1] += by;
    }

    pub(super) fn placer(&self) -> Placer {
        Placer::new(Rect::sized(EDGE, 4.0, self.width - 2.0 * EDGE, self.height - 8.0))
    }

    /// Draws everything but texts.
    pub(super) fn things(&self, canvas: &mut Canvas, items: &[Item], placer: &mut Placer) {
        let symbol = (0.014 * (self.width + self.height)).clamp(11.0, 20.0);
        let coloured: Vec<Coloured> = items.iter().filter_map(|i| Coloured::of(i, &self.view, self.scale)).collect();
        let mut done = Vec::new();
        for item in items {
            match Coloured::of(item, &self.view, self.scale) {
                // All lines of a role at once, so that their joints are clean.
                Some(line) if !done.contains(&line.role) => {
                    done.push(line.role);
                    paint_coloured(canvas, &coloured, line.role);
                }
                Some(_) => {}
                None => paint(canvas, item, &self.view, symbol, placer),
            }
        }
        for line in &coloured {
            placer.add_line(&line.at, line.width, 1.0);
        }
    }

    /// Texts, when everything that they must not cover is known; returns their boxes.
    pub(super) fn labels(&self, canvas: &mut Canvas, items: &[Item], placer: &mut Placer) -> Vec<Rect> {
        labels(canvas, placer, items, &self.view)
    }

    /// Scale bar, colours and legend; returns the height of the whole drawing.
    pub(super) fn below(&mut self, canvas: &mut Canvas, scene: &Scene, entries: &[Entry]) -> f64 {
        let mut below = self.height;
        let bar = scale_bar(canvas, &self.view, &scene.display, self.width, below);
        if let Some(scale) = &scene.scale {
            let left = (bar + 40.0).max(0.4 * self.width);
            below = colour_bar(canvas, scale, left, self.width - EDGE - 14.0, below);
        } else {
            below += 44.0;
        }
        legend::draw(canvas, entries, EDGE, self.width - EDGE, below + 8.0) + 6.0
    }
}

fn points(item: &Item) -> &[[f64; 2]] {
    match item {
        Item::Line { points, .. } => points,
        Item::Body { corners, .. } => corners,
        Item::Support { at, .. } | Item::Hinge { at } | Item::Label { at, .. } | Item::Marker { at, .. } => std::slice::from_ref(at),
        Item::Disc { centre, .. } => std::slice::from_ref(centre),
        Item::Arrow { .. } => &[],
    }
}

/// Places that an item reaches beyond its points.
fn beyond(item: &Item) -> Vec<[f64; 2]> {
    match item {
        Item::Arrow { from, to, .. } => vec![*from, *to],
        Item::Disc { centre: [x, y], radius_m: r, .. } => vec![[x - r, y - r], [x + r, y + r]],
        _ => Vec::new(),
    }
}

/// The largest scale at which everything fits, and the height that the picture then takes.
fn fit<'a>(items: impl IntoIterator<Item = &'a Item>, width: f64, max_height: f64) -> (View, f64) {
    let all: Vec<[f64; 2]> = items
        .into_iter()
        .flat_map(|i| points(i).iter().copied().chain(beyond(i)))
        .filter_map(|p| Some([ticks::sane(p[0])?, ticks::sane(p[1])?]))
        .collect();
    let r = if all.is_empty() { Rect::sized(0.0, 0.0, 0.0, 0.0) } else { symbols::around(&all) };
    let extent = |a: f64, b: f64| (b - a).max(1e-3 * a.abs().max(b.abs())).max(1e-290);
    let (w, h) = (extent(r.x0, r.x1), extent(r.y0, r.y1));
    let scale = ((width - 2.0 * MARGIN) / w).min((max_height - 2.0 * MARGIN) / h);
    let height = ((r.y1 - r.y0) * scale + 2.0 * MARGIN).clamp(2.0 * MARGIN + 40.0, max_height);
    let middle = [0.5 * r.x0 + 0.5 * r.x1, 0.5 * r.y0 + 0.5 * r.y1];
    (View { scale, middle, centre: [0.5 * width, 0.5 * height] }, height)
}

/// Draws everything but coloured lines and texts.
fn paint(canvas: &mut Canvas, item: &Item, view: &View, symbol: f64, placer: &mut Placer) {
    match item {
        Item::Line { points, width_m, role, .. } => {
            let at: Vec<[f64; 2]> = points.iter().filter_map(|p| view.at(*p)).collect();
            let width = view.thickness(*width_m);
            match role {
                Role::Undeformed | Role::Named(Look::Plate | Look::Opening | Look::Moving | Look::Rail | Look::Wire | Look::Limit, _) => {
                    placer.add_line(&at, 1.5, 0.6);
                }
                Role::Deformed | Role::DeformedCopy | Role::Rigid | Role::RigidCopy | Role::Named(Look::Bar, _) => {
                    placer.add_line(&at, width, 1.0);
                }
                Role::UndeformedCopy => placer.add_line(&at, 1.5, 0.5),
                Role::Construction | Role::Envelope | Role::Plane | Role::PlaneCopy | Role::Named(..) => placer.add_line(&at, 1.0, 0.3),
            }
            plain(canvas, &at, width, *role);
        }
        Item::Body { corners, role } => {
            let at: Vec<[f64; 2]> = corners.iter().filter_map(|p| view.at(*p)).collect();
            match role {
                Role::Deformed | Role::DeformedCopy => {
                    canvas.polygon(&at, &format!(r#"{} stroke-width="1.4""#, Paint::fill_and_stroke(Paint::Body, Paint::Ink)));
                }
                Role::Plane => canvas.polygon(&at, &format!(r#"{} stroke-width="1""#, Paint::fill_and_stroke(Paint::Main, Paint::Ink))),
                Role::PlaneCopy => canvas.polygon(&at, &format!(r#"{} stroke-width="1""#, Paint::fill_and_stroke(Paint::Body, Paint::Ink))),
                Role::Named(look, _) => canvas.polygon(&at, &filled(*look)),
                _ => canvas.polygon(&at, &format!(r#"fill="none" {}"#, outline(*role))),
            }
            if matches!(role, Role::Deformed | Role::DeformedCopy) && !at.is_empty() {
                placer.add_solid(symbols::around(&at));
            }
            if let Some(first) = at.first() {
                let closed: Vec<[f64; 2]> = at.iter().chain([first]).copied().collect();
                placer.add_line(&closed, 1.5, if matches!(role, Role::Deformed) { 1.0 } else { 0.6 });
            }
        }
        Item::Disc { centre, radius_m, role } => {
            if let Some(p) = view.at(*centre) {
                disc(canvas, placer, p, view.radius(*radius_m), *role);
            }
        }
        Item::Support { at, kind, outward } => {
            if let Some(p) = view.at(*at) {
                placer.add_solid(symbols::support(canvas, p, *kind, *outward, symbol));
            }
        }
        Item::Hinge { at } => {
            if let Some(p) = view.at(*at) {
                symbols::hinge(canvas, p, symbol);
                placer.add_solid(Rect::sized(p[0] - 0.4 * symbol, p[1] - 0.4 * symbol, 0.8 * symbol, 0.8 * symbol));
            }
        }
        Item::Arrow { from, to, .. } => {
            if let (Some(a), Some(b)) = (view.at(*from), view.at(*to)) {
                symbols::arrow(canvas, a, b);
                placer.add_line(&[a, b], 12.0, 1.0);
            }
        }
        Item::Marker { at, .. } => {
            if let Some(p) = view.at(*at) {
                symbols::ring(canvas, p);
                placer.add_solid(Rect::sized(p[0] - 9.0, p[1] - 9.0, 18.0, 18.0));
            }
        }
        Item::Label { .. } => {}
    }
}

/// A round body.
fn disc(canvas: &mut Canvas, placer: &mut Placer, at: [f64; 2], radius: f64, role: Role) {
    let attributes = match role {
        Role::Named(look, _) => filled(look),
        Role::Deformed | Role::DeformedCopy => format!(r#"{} stroke-width="1.4""#, Paint::fill_and_stroke(Paint::Body, Paint::Ink)),
        _ => format!(r#"fill="none" {}"#, outline(role)),
    };
    canvas.circle(at, radius, &attributes);
    let ring: Vec<[f64; 2]> = (0..=16_u8)
        .map(|i| {
            let (sin, cos) = forcewright_base::maths::sin_cos(f64::from(i) * std::f64::consts::PI / 8.0);
            [at[0] + radius * cos, at[1] + radius * sin]
        })
        .collect();
    placer.add_line(&ring, 2.0, 1.0);
}

/// How a named body is painted.
fn filled(look: Look) -> String {
    match look {
        Look::Plate => format!(r#"{} stroke-width="1.4" stroke-linejoin="round""#, Paint::fill_and_stroke(Paint::Body, Paint::Ink)),
        Look::Opening => format!(r#"{} stroke-width="1.4" stroke-linejoin="round""#, Paint::fill_and_stroke(Paint::Paper, Paint::Ink)),
        Look::Moving => format!(r#"{} stroke-width="2" stroke-linejoin="round""#, Paint::fill_and_stroke(Paint::Paper, Paint::Main)),
        Look::Bar => format!(r#"{} stroke-width="0.8""#, Paint::fill_and_stroke(Paint::Body, Paint::Ink)),
        Look::Rail | Look::Axis | Look::Track | Look::Wire | Look::Comb | Look::Limit => format!(r#"fill="none" {}"#, stroked(look)),
    }
}

/// Paint, width and dashes of a named line.
fn line_of(look: Look) -> (Paint, f64, &'static str) {
    match look {
        Look::Plate | Look::Opening | Look::Bar => (Paint::Ink, 1.4, ""),
        Look::Moving => (Paint::Main, 2.0, ""),
        Look::Rail => (Paint::Muted, 1.4, ""),
        Look::Axis => (Paint::Muted, 1.0, "14 4 2 4"),
        Look::Track => (Paint::Third, 1.3, "7 3.5"),
        Look::Wire => (Paint::Second, 1.5, ""),
        Look::Comb => (Paint::Main, 1.0, ""),
        Look::Limit => (Paint::Limit, 1.2, "9 3"),
    }
}

fn stroked(look: Look) -> String {
    let (paint, width, dash) = line_of(look);
    let (space, dash) = (if dash.is_empty() { "" } else { " " }, legend::dashed(dash));
    format!(r#"{} stroke-width="{width}"{space}{dash}"#, paint.attributes("stroke"))
}

/// Stroke of what is only outlined.
fn outline(role: Role) -> String {
    if let Role::Named(look, _) = role {
        return stroked(look);
    }
    let (paint, width, dash) = match role {
        Role::Undeformed => (Paint::Reference, 1.4, "5 3.5"),
        Role::UndeformedCopy => (Paint::Reference, 1.0, "2.5 3.5"),
        Role::Construction => (Paint::Muted, 1.0, "14 4 2 4"),
        Role::Envelope => (Paint::Limit, 1.2, "9 3"),
        Role::Plane | Role::PlaneCopy => (Paint::Ink, 1.0, ""),
        Role::Deformed | Role::DeformedCopy | Role::Rigid | Role::RigidCopy | Role::Named(..) => (Paint::Ink, 1.4, ""),
    };
    format!(r#"{} stroke-width="{width}" {}"#, paint.attributes("stroke"), legend::dashed(dash))
}

/// A line without values: thin and dashed as made, thick under load, edged where it is rigid.
fn plain(canvas: &mut Canvas, at: &[[f64; 2]], width: f64, role: Role) {
    match role {
        Role::Deformed | Role::DeformedCopy => {
            let opacity = if role == Role::DeformedCopy { r#" opacity="0.5""# } else { "" };
            canvas.open_stroke(Paint::Main, width, &format!(r#"stroke-linejoin="round"{opacity}"#));
            canvas.polyline(at, "");
            canvas.close();
        }
        Role::Rigid | Role::RigidCopy | Role::Named(Look::Bar, _) => {
            let opacity = if role == Role::RigidCopy { r#" opacity="0.5""# } else { "" };
            for (paint, width) in [(Paint::Ink, width + 1.6), (Paint::Body, width)] {
                canvas.open_stroke(paint, width, &format!(r#"stroke-linejoin="round"{opacity}"#));
                canvas.polyline(at, "");
                canvas.close();
            }
        }
        _ => canvas.polyline(at, &format!(r#"fill="none" {}"#, outline(role))),
    }
}

/// A line coloured by its values, in the drawing.
#[derive(Clone, Debug)]
struct Coloured {
    at: Vec<[f64; 2]>,
    levels: Vec<u8>,
    width: f64,
    role: Role,
}

impl Coloured {
    fn of(item: &Item, view: &View, scale: Option<&ColourScale>) -> Option<Self> {
        let Item::Line { points, width_m, role: role @ (Role::Deformed | Role::DeformedCopy), values: Some(values) } = item else {
            return None;
        };
        let max = scale?.max;
        let (at, levels): (Vec<_>, Vec<_>) = points
            .iter()
            .enumerate()
            .filter_map(|(i, p)| Some((view.at(*p)?, colour::level(values.get(i).copied().unwrap_or(f64::NAN), max))))
            .unzip();
        Some(Self { at, levels, width: view.thickness(*width_m), role: *role })
    }

    fn ends(&self) -> impl Iterator<Item = ([f64; 2], u8)> {
        let end = |at: Option<&[f64; 2]>, level: Option<&u8>| Some((*at?, *level?));
        end(self.at.first(), self.levels.first()).into_iter().chain(end(self.at.last(), self.levels.last()))
    }
}

/// Lines of one role: dark edges first, then the colours; ends that meet are rounded.
fn paint_coloured(canvas: &mut Canvas, lines: &[Coloured], role: Role) {
    let lines: Vec<&Coloured> = lines.iter().filter(|l| l.role == role).collect();
    let joints: Vec<([f64; 2], u8, f64)> = lines
        .iter()
        .flat_map(|l| l.ends().map(|(p, level)| (p, level, l.width)))
        .filter(|(p, ..)| lines.iter().flat_map(|l| l.ends()).filter(|(q, _)| distance(*p, *q) < 0.05).count() > 1)
        .collect();
    canvas.open(if role == Role::DeformedCopy { r#"opacity="0.5""# } else { r#"opacity="1""# });
    canvas.open(&Paint::Ink.attributes("fill"));
    for (p, _, width) in &joints {
        canvas.circle(*p, 0.5 * width + 0.8, "");
    }
    canvas.close();
    for line in &lines {
        canvas.open_stroke(Paint::Ink, line.width + 1.6, r#"stroke-linejoin="round""#);
        canvas.polyline(&line.at, "");
        canvas.close();
    }
    for (p, level, width) in &joints {
        canvas.circle(*p, 0.5 * width, &format!(r#"fill="{}""#, colour::of_level(*level)));
    }
    for line in &lines {
        canvas.open(&format!(r#"fill="none" stroke-width="{}" stroke-linejoin="round""#, n(line.width)));
        runs(canvas, line);
        canvas.close();
    }
    canvas.close();
}

/// Runs of equal colour.
fn runs(canvas: &mut Canvas, line: &Coloured) {
    let mut run: Vec<[f64; 2]> = Vec::new();
    let mut current = None;
    for (ends, levels) in line.at.windows(2).zip(line.levels.windows(2)) {
        let parts = levels[0].abs_diff(levels[1]).max(1);
        let back = 0.7 / distance(ends[0], ends[1]).max(0.7);
        let place = |t: f64| [0, 1].map(|c| ends[0][c] + t * (ends[1][c] - ends[0][c]));
        for i in 0..parts {
            let level = if levels[0] < levels[1] { levels[0] + i } else { levels[0] - i };
            if current != Some(level) {
                flush(canvas, &run, current);
                // A little overlap, so that no seam shines through.
                run = vec![place(f64::from(i) / f64::from(parts) - if run.is_empty() { 0.0 } else { back })];
                current = Some(level);
            }
            run.push(place(f64::from(i + 1) / f64::from(parts)));
        }
    }
    flush(canvas, &run, current);
}

fn flush(canvas: &mut Canvas, run: &[[f64; 2]], level: Option<u8>) {
    if let Some(level) = level {
        canvas.polyline(run, &format!(r#"stroke="{}""#, colour::of_level(level)));
    }
}

fn labels(canvas: &mut Canvas, placer: &mut Placer, items: &[Item], view: &View) -> Vec<Rect> {
    let mut taken = Vec::new();
    for item in items {
        let (at, text, style) = match item {
            Item::Arrow { from, to, label } => {
                // Nearer to the tail, which is the free end of a force that pushes.
                ([0, 1].map(|i| 0.7 * from[i] + 0.3 * to[i]), label, LABEL)
            }
            Item::Label { at, text } => (*at, text, Style::label(13.0, Paint::Muted)),
            Item::Marker { at, label } => (*at, label, Style::label(14.0, Paint::Limit)),
            _ => continue,
        };
        let Some(p) = view.at(at) else { continue };
        let text = style.fit(text, view.centre[0]);
        if text.is_empty() {
            continue;
        }
        // An arrow's label needs no leader as long as it is near.
        let beside = if matches!(item, Item::Arrow { .. }) { 40.0 } else { BESIDE };
        if let Some(placed) = placer.place(p, style.width(&text), style.height(), beside) {
            let radius = if matches!(item, Item::Marker { .. }) { symbols::RING + 1.1 } else { 0.0 };
            if let Some(leader) = placed.leader.and_then(|l| from_edge(l, radius)) {
                canvas.segments(&[leader], &format!(r#"fill="none" {} stroke-width="1""#, style.paint.attributes("stroke")));
            }
            canvas.text_in(&text, &placed.rect, style);
            taken.push(placed.rect);
        }
    }
    taken
}

/// A bar of round length; returns where it ends.
fn scale_bar(canvas: &mut Canvas, view: &View, unit: &Unit, width: f64, top: f64) -> f64 {
    let wanted = unit.from_si(0.16 * width / view.scale);
    let length = ticks::round_below(wanted);
    let px = unit.to_si(length) * view.scale;
    let px = if px.is_finite() { px.clamp(4.0, 0.3 * width) } else { 4.0 };
    let (x, y) = (EDGE, top + 18.0);
    canvas.open_stroke(Paint::Ink, 1.6, "");
    canvas.segments(&[[[x, y], [x + px, y]], [[x, y - 5.0], [x, y + 5.0]], [[x + px, y - 5.0], [x + px, y + 5.0]]], "");
    canvas.close();
    let text = SMALL.fit(&format_si(unit.to_si(length), unit, 3), 0.35 * width);
    let rect = canvas.text(&text, [x, y + 22.0], Anchor::Start, SMALL);
    (x + px).max(rect.x1)
}

/// The scale of the colours with its unit, its end and the limit; returns the place below.
fn colour_bar(canvas: &mut Canvas, scale: &ColourScale, left: f64, right: f64, top: f64) -> f64 {
    let title = over_unit(&scale.label, &scale.display);
    canvas.text(&TITLE.fit(&title, right - left), [left, top + 12.0], Anchor::Start, TITLE);
    let max = ticks::sane(scale.display.from_si(scale.max)).filter(|m| *m > 1e-290).unwrap_or(1.0);
    let limit = scale.limit.as_ref().and_then(|(v, name)| Some((ticks::sane(scale.display.from_si(*v)).filter(|v| *v > 0.0)?, name)));
    // A limit a little beyond the end is shown on an empty stretch; one far beyond is only told.
    let end = limit.as_ref().map_or(max, |(l, _)| if *l > max && *l < 1.6 * max { 1.02 * l } else { max });
    let at = |v: f64| left + (v / end).clamp(0.0, 1.0) * (right - left);
    let mut y = top + 20.0;
    if let Some((value, name)) = &limit {
        let style = Style::label(13.0, Paint::Limit);
        let beyond = if *value > end { " →" } else { "" };
        let text = format!("{name} {}{beyond}", with_minus(&format_si(scale.display.to_si(*value), &scale.display, 4)));
        let text = style.fit(&text, right + 14.0 - left);
        let half = 0.5 * style.width(&text);
        let middle = at(*value).clamp(left + half, (right + 14.0 - half).max(left + half));
        canvas.text(&text, [middle, y + 12.0], Anchor::Middle, Style { halo: false, ..style });
        y += 24.0;
    }
    let bar = Rect { x0: left, y0: y, x1: right, y1: y + 13.0 };
    let length = at(max) - left;
    for level in 0..colour::LEVELS {
        // Each reaches to the end under the next ones, so that no seam shines through.
        let done = f64::from(level) / f64::from(colour::LEVELS) * length;
        let r = Rect::sized(left + done, bar.y0, length - done, bar.height());
        canvas.rect(&r, &format!(r#"fill="{}""#, colour::of_level(level)));
    }
    canvas.rect(&bar, &format!(r#"fill="none" {} stroke-width="1""#, Paint::Ink.attributes("stroke")));
    if let Some((value, _)) = limit.filter(|(v, _)| *v <= end) {
        let x = at(value);
        canvas.open(&format!(r#"{} stroke-width="2.4""#, Paint::fill_and_stroke(Paint::Limit, Paint::Limit)));
        canvas.segments(&[[[x, bar.y0 - 2.0], [x, bar.y1 + 3.0]]], "");
        canvas.polygon(&[[x, bar.y0 - 1.0], [x - 5.0, bar.y0 - 8.0], [x + 5.0, bar.y0 - 8.0]], r#"stroke-width="0""#);
        canvas.close();
    }
    bar_ticks(canvas, max, &at, [bar.y1 + 17.0, right + 14.0]);
    bar.y1 + 22.0
}

/// Numbers below the bar: zero, round values, and the end. `place` is the baseline and the right edge of the drawing.
fn bar_ticks(canvas: &mut Canvas, max: f64, at: &dyn Fn(f64) -> f64, place: [f64; 2]) {
    let [baseline, right] = place;
    let last = forcewright_base::units::format_number(max, 4);
    let middle = at(max).min(right - 0.5 * SMALL.width(&last));
    let taken = canvas.text(&last, [middle, baseline], Anchor::Middle, SMALL).grown(5.0);
    let round = ticks::cover(0.0, max, 5);
    let mut edge = f64::NEG_INFINITY;
    for (value, label) in round.values.iter().zip(&round.labels).filter(|(v, _)| **v < max) {
        let half = 0.5 * SMALL.width(label);
        let x = at(*value);
        if x + half < taken.x0 && x - half > edge {
            canvas.text(label, [x, baseline], Anchor::Middle, SMALL);
            edge = x + half + 5.0;
        }
    }
}

/// What the line styles mean, for those that occur.
pub(super) fn entries(items: &[Item], scene: &Scene) -> Vec<Entry> {
    let count =
        |role: Role| items.iter().filter(|i| matches!(i, Item::Line { role: r, .. } | Item::Body { role: r, .. } if *r == role)).count();
    let coloured =
        |role: Role| scene.scale.is_some() && items.iter().any(|i| matches!(i, Item::Line { role: r, values: Some(_), .. } if *r == role));
    let line = |paint, width, dash| Swatch::Line { paint, width, dash, squares: false };
    let loaded = |role, paint, faded| if coloured(role) { Swatch::Values { faded } } else { line(paint, 5.0, "") };
    let construction = if count(Role::Construction) == 1 { "mirror line" } else { "construction line" };
    let is_rigid = |i: &Item| {
        matches!(i, Item::Line { role: Role::Rigid | Role::RigidCopy, .. } | Item::Body { role: Role::Deformed | Role::DeformedCopy, .. })
    };
    let rigid = items.iter().any(is_rigid).then(|| Entry { swatch: Swatch::Body, text: "rigid".to_owned() });
    let [made, loaded_word] = scene.words;
    let lines = [
        (Role::Undeformed, line(Paint::Reference, 1.4, "5 3.5"), made.to_owned()),
        (Role::Deformed, loaded(Role::Deformed, Paint::Main, false), loaded_word.to_owned()),
        (Role::UndeformedCopy, line(Paint::Reference, 1.0, "2.5 3.5"), format!("copy {made}")),
        (Role::DeformedCopy, loaded(Role::DeformedCopy, Paint::Reference, true), format!("copy {loaded_word}")),
        (Role::Construction, line(Paint::Muted, 1.0, "14 4 2 4"), construction.to_owned()),
        (Role::Envelope, line(Paint::Limit, 1.2, "9 3"), "envelope".to_owned()),
    ];
    let lines = lines.into_iter().filter(|(role, ..)| count(*role) > 0).map(|(_, swatch, text)| Entry { swatch, text });
    let hinge = items.iter().any(|i| matches!(i, Item::Hinge { .. }));
    let hinge = hinge.then(|| Entry { swatch: Swatch::Point, text: "hinge".to_owned() });
    named(items).into_iter().chain(lines).chain(rigid).chain(hinge).collect()
}

/// Things with words of their own, in the order in which they are drawn.
fn named(items: &[Item]) -> Vec<Entry> {
    let mut seen = Vec::new();
    for item in items {
        let (Item::Line { role, .. } | Item::Body { role, .. } | Item::Disc { role, .. }) = item else { continue };
        if let Role::Named(look, word) = role
            && !word.is_empty()
            && !seen.contains(&(*look, *word))
        {
            seen.push((*look, *word));
        }
    }
    let swatch = |look: Look| {
        let (paint, width, dash) = line_of(look);
        match look {
            Look::Plate => Swatch::Plate,
            Look::Bar => Swatch::Body,
            Look::Moving => Swatch::Moving,
            Look::Opening | Look::Rail | Look::Axis | Look::Track | Look::Wire | Look::Comb | Look::Limit => {
                Swatch::Line { paint, width, dash, squares: false }
            }
        }
    };
    seen.into_iter().map(|(look, word)| Entry { swatch: swatch(look), text: word.to_owned() }).collect()
}
