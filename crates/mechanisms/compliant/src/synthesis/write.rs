//! A sized shape as sections of a project file.

use std::fmt::Write as _;

use forcewright_base::maths;
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_contract::edit;
use forcewright_contract::synthesis::Proposal;

use super::catalogue::{self, Solved, Stop};
use super::room::{Copies, Room};
use super::sizing::{Asked, Size};

/// Digits of what people read and make, thickness and depth, and of the size, of which all coordinates are multiples anyhow.
const DIGITS: i32 = 4;
const SIZE_DIGITS: i32 = 7;
/// How far a search may move a node, of the size of the shape, and change a bend, rad, or the section.
const NODES: f64 = 0.02;
const BENDS: f64 = 0.3;
const SECTION: f64 = 0.2;

/// A proposal for a size; `round` counts its corrections.
pub(super) fn proposal(asked: &Asked, size: &Size, length: &Unit, round: f64) -> Option<Proposal> {
    let shape = catalogue::solved(size.shape)?;
    let stop = shape.stops.get(size.stop)?;
    // A thickness is cut off rather than rounded: the stress follows it.
    let thickness_m = rounded(size.thickness_m, DIGITS, f64::floor);
    let stiffer = maths::powi(size.thickness_m / thickness_m, 3);
    let depth_m = if asked.nominal_n.is_some() { size.depth_m * stiffer } else { size.depth_m };
    let size = Size {
        thickness_m,
        depth_m: rounded(depth_m, DIGITS, f64::round).min(asked.depth_max_m),
        scale: rounded(size.scale, SIZE_DIGITS, f64::ceil),
        ..*size
    };
    let room = Room::of(asked, shape, stop, size.copies);
    Some(Proposal {
        topology: shape.topology.name,
        title: shape.title.clone(),
        sections: sections(asked, shape, &room, &size, travel_m(stop, &size))?,
        settings: settings(asked, &room, &size),
        sizes: told(asked, stop, &room, &size, length),
        state: state(&size, round),
        cost: size.cost_m3(&room),
        parts: shape.beams * size.copies.count() as usize,
    })
}

/// Travel of the whole, m.
fn travel_m(stop: &Stop, size: &Size) -> f64 {
    size.scale * stop.travel_m * f64::from(size.copies.layers)
}

/// The sizes for people. Of a design that a search has gone on from the room is that before it, as its nodes moved little, with the new
/// thickness.
fn told(asked: &Asked, stop: &Stop, room: &Room, size: &Size, length: &Unit) -> Vec<(&'static str, String)> {
    let show = |si: f64| format_si(si, length, 4);
    let [width, height] = room.extent_m(size.scale, size.thickness_m).map(show);
    let mut all = vec![("Room", format!("{width} × {height}"))];
    if asked.rows > 1 || asked.layers > 1 {
        all.push(("Copies", in_words(size.copies)));
    }
    all.extend([
        ("Thickness", show(size.thickness_m)),
        ("Depth", if size.plates > 1 { format!("{} × {}", size.plates, show(size.depth_m)) } else { show(size.depth_m) }),
        ("Travel", show(travel_m(stop, size))),
    ]);
    all
}

/// `2 rows, 3 layers`.
fn in_words(copies: Copies) -> String {
    let all = [(copies.rows, "rows"), (copies.layers, "layers")];
    let several: Vec<String> = all.iter().filter(|(n, _)| *n > 1).map(|(n, what)| format!("{n} {what}")).collect();
    if several.is_empty() { "1".to_owned() } else { several.join(", ") }
}

/// A proposal after a search that may have changed thickness and depth, m.
pub(super) fn searched(asked: &Asked, proposal: &Proposal, [thickness_m, depth_m]: [Option<f64>; 2], length: &Unit) -> Option<Proposal> {
    let (old, round) = read(&proposal.state)?;
    let (thickness_m, depth_m) = (thickness_m.unwrap_or(old.thickness_m), depth_m.unwrap_or(old.depth_m));
    let shape = catalogue::solved(old.shape)?;
    let stop = shape.stops.get(old.stop)?;
    let room = Room::of(asked, shape, stop, old.copies);
    let size = Size { thickness_m, depth_m, ..old };
    let size = Size { cost_m3: size.cost_m3(&room), ..size };
    Some(Proposal { sizes: told(asked, stop, &room, &size, length), state: state(&size, round), cost: size.cost_m3, ..proposal.clone() })
}

/// A size as the numbers of a proposal.
fn state(size: &Size, round: f64) -> Vec<f64> {
    let Size { shape, stop, scale, thickness_m, depth_m, plates, copies: Copies { rows, beside, layers }, cost_m3 } = *size;
    let [shape, stop] = [shape, stop].map(|index| index as f64);
    let [plates, rows, layers] = [plates, rows, layers].map(f64::from);
    vec![shape, stop, scale, thickness_m, depth_m, plates, cost_m3, round, rows, f64::from(u8::from(beside)), layers]
}

/// The size and the number of corrections of a proposal.
pub(super) fn read(state: &[f64]) -> Option<(Size, f64)> {
    let [shape, stop, scale, thickness_m, depth_m, plates, cost_m3, round, rows, beside, layers] = *state else { return None };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small whole numbers, written by `state`")]
    let size = Size {
        shape: shape as usize,
        stop: stop as usize,
        scale,
        thickness_m,
        depth_m,
        plates: plates as u32,
        copies: Copies { rows: rows as u32, beside: beside > 0.5, layers: layers as u32 },
        cost_m3,
    };
    Some((size, round))
}

/// To so many digits.
fn rounded(value: f64, digits: i32, how: fn(f64) -> f64) -> f64 {
    let place = maths::log10(value).floor();
    if !place.is_finite() {
        return value;
    }
    #[allow(clippy::cast_possible_truncation, reason = "the decimal exponent of a double")]
    let shift = digits - 1 - place as i32;
    let ten = |n: i32| maths::powi(10.0, n);
    // What is a decimal but for rounding stays that decimal.
    let cut = |v: f64| if (v - v.round()).abs() < 1e-7 { v.round() } else { how(v) };
    if shift >= 0 { cut(value * ten(shift)) / ten(shift) } else { cut(value / ten(-shift)) * ten(-shift) }
}

/// `[design]`, `[layout]`, `[load]` and the search that may go on from there.
fn sections(asked: &Asked, shape: &Solved, room: &Room, size: &Size, travel_m: f64) -> Option<String> {
    let value = |path: &str, dimension: Dimension, si: f64| match path {
        "design.thickness" => Some(size.thickness_m),
        "design.depth" => Some(size.depth_m),
        "load.travel" => Some(travel_m),
        _ => (path.starts_with("design.") && dimension == Dimension::Length).then_some(si * size.scale),
    };
    let numbers = shape.numbers.iter().enumerate();
    let changed: Vec<(usize, f64)> = numbers.filter_map(|(i, n)| Some((i, value(&n.path, n.dimension, n.si)?))).collect();
    let text = edit::with_values(shape.topology.text, &shape.numbers, &changed, None).ok()?;
    let (from, to) = (text.find("[design]")?, text.find("[model]")?);
    let mut own = text.get(from..to)?.trim_end().to_owned();
    own = own.replace("[layout]\n", &format!("[layout]\n{}", copies(room, size)));
    Some(format!("\n# Sized by `forcewright synthesise`.\n{}{own}\n{}", shape.made, search(asked, shape, room, size)))
}

/// The lines of `[layout]` for plates, rows and layers.
fn copies(room: &Room, size: &Size) -> String {
    let mut text = String::new();
    if size.plates > 1 {
        let _ = writeln!(text, "plates = {}", size.plates);
    }
    if size.copies.rows > 1 {
        let spacing = mm(rounded(room.spacing_m(size.scale, size.thickness_m), SIZE_DIGITS, f64::ceil));
        // Rows that follow each other along the load need no direction.
        let direction = if size.copies.beside { ", direction = [1, 0]" } else { "" };
        let _ = writeln!(text, "array = {{ count = {}, spacing = {spacing}{direction} }}", size.copies.rows);
    }
    if size.copies.layers > 1 {
        let _ = writeln!(text, "series = {}", size.copies.layers);
    }
    text
}

/// A length as it stands in a file.
fn mm(si: f64) -> String {
    format!("\"{} mm\"", format_number(1e3 * si, SIZE_DIGITS.unsigned_abs() as usize))
}

/// `[optimise]`: what may still change a little. Shapes given by their angles have nothing that may.
fn search(asked: &Asked, shape: &Solved, room: &Room, size: &Size) -> String {
    let bends = shape.numbers.iter().any(|n| n.path.ends_with(".bend.1"));
    if !bends {
        return String::new();
    }
    // Around what was sized, and within what can be made.
    let range = |si: f64, [least, most]: [f64; 2]| {
        let ends = [((1.0 - SECTION) * si).max(least).min(si), ((1.0 + SECTION) * si).min(most).max(si)];
        format!("{{ range = [{}, {}] }}", mm(ends[0]), mm(ends[1]))
    };
    // Where a force is asked for, the stretch around it; the flattest may lie elsewhere.
    let longest = if asked.nominal_n.is_some() { "band_ratio" } else { "flat_ratio" };
    let mut text = format!(
        "\n[optimise]\nobjective = {{ maximise = \"{longest}\" }}\n[optimise.variables]\n\"design.thickness\" = {}\n\"design.depth\" = {}\n\"design.beams.*.bend\" = {{ within = {BENDS} }}\n",
        range(size.thickness_m, [asked.thickness_min_m, room.thickest_m(size.scale, asked.room_m)]),
        range(size.depth_m, [asked.depth_min_m.unwrap_or(0.0), asked.depth_max_m]),
    );
    let largest = shape.stops.last().map_or(0.0, |s| s.room_m().into_iter().fold(0.0, f64::max));
    for node in free_nodes(shape.topology.text) {
        let _ = writeln!(text, "\"design.nodes.{node}.at\" = {{ within = {} }}", mm(NODES * size.scale * largest));
    }
    text
}

/// The nodes of a shape that nothing holds.
fn free_nodes(text: &str) -> Vec<&str> {
    let lines = text.lines().skip_while(|l| *l != "[design.nodes]").skip(1).take_while(|l| l.starts_with('n'));
    lines.filter(|l| !l.contains("support")).filter_map(|l| l.split(' ').next()).collect()
}

/// What `solve` is to test besides what the user asks for: the beams in their part of the room, where there is one, as an envelope around
/// the drawing; and the stress at the inner face of curved beams, where a stress is limited.
fn settings(asked: &Asked, room: &Room, size: &Size) -> Vec<String> {
    let mut all = Vec::new();
    if asked.room_m[0].is_finite() {
        let sides = room.envelope_m(size.scale, size.thickness_m, asked.room_m);
        let side = |(key, [low, high]): (&str, [f64; 2])| format!("requirements.envelope.{key}=[{}, {}]", mm(low), mm(high));
        all.extend(["x", "y"].into_iter().zip(sides).map(side));
    }
    if let Some(allowed_pa) = asked.stress_pa {
        let allowed_mpa = rounded(1e-6 * allowed_pa, SIZE_DIGITS, f64::floor);
        all.push(format!(
            "requirements.limits.stress_inner_face.max=\"{} MPa\"",
            format_number(allowed_mpa, SIZE_DIGITS.unsigned_abs() as usize)
        ));
    }
    all
}
