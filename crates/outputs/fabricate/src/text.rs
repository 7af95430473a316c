//! Numbers and texts as files want them.

pub(crate) use forcewright_base::text::xml;
use forcewright_model::{Body, Coil, CoilEnd, Part, Plate, Section, Turned};

use crate::shape::MM_PER_M;

/// A length in mm: at most twelve decimals, none that say nothing.
pub(crate) fn length(mm: f64) -> String {
    decimals(mm, 12)
}

/// A number of the order of 1: at most fifteen decimals, none that say nothing.
pub(crate) fn ratio(value: f64) -> String {
    decimals(value, 15)
}

fn decimals(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// What people must know to make the part, a line each: title, material and size, holes or sections, notes.
pub(crate) fn remarks(part: &Part) -> Vec<String> {
    let material = part.material.as_deref().unwrap_or("not stated");
    let (size, details) = match &part.body {
        Body::Plate(plate) => (format!("Depth: {} mm.", length(plate.depth_m * MM_PER_M)), holes(plate)),
        Body::Turned(turned) => (format!("Length: {} mm.", length(turned.length_m() * MM_PER_M)), sections(turned)),
        Body::Coil(coil) => (format!("Wire: {} mm.", length(coil.wire_m * MM_PER_M)), windings(coil)),
    };
    let head = [part.title.clone(), format!("Material: {material}. {size}"), "All lengths in mm.".to_owned()];
    head.into_iter().chain(details).chain(part.notes.iter().cloned()).collect()
}

fn holes(plate: &Plate) -> Vec<String> {
    let line = |hole: &forcewright_model::Hole| {
        let [x, y] = hole.centre_m.map(|coordinate| length(coordinate * MM_PER_M));
        let diameter = length(hole.diameter_m * MM_PER_M);
        format!("Hole of diameter {diameter} at ({x}, {y}): {}", hole.purpose)
    };
    plate.holes.iter().map(line).collect()
}

/// Sections from z = 0 upwards, the bore, and the drillings, which no solid shows.
fn sections(turned: &Turned) -> Vec<String> {
    let mm = |m: f64| length(m * MM_PER_M);
    let degrees = |rad: f64| decimals(rad.to_degrees(), 6);
    let mut lines = Vec::new();
    for (section, pair) in turned.sections.iter().zip(turned.steps_m().windows(2)) {
        let place = format!("z = {} to {}", mm(pair[0]), mm(pair[1]));
        lines.push(match section {
            Section::Plain { radius_m, .. } => format!("{place}: diameter {}", mm(2.0 * radius_m)),
            Section::Grooved(grooved) => {
                let hand = if grooved.lead_m > 0.0 { "right" } else { "left" };
                let [bottom, top] = section.radii_m().map(|m| mm(2.0 * m));
                let (count, lead, phase) = (grooved.starts, mm(grooved.lead_m.abs()), degrees(grooved.phase_rad));
                let grooves = if count == 1 { "1 groove".to_owned() } else { format!("{count} grooves side by side") };
                format!(
                    "{place}: {grooves}, {hand}-handed, lead {lead}, diameter {top}, {bottom} at the bottom, \
                     middle of a groove at {phase} degrees where z = {}",
                    mm(pair[0])
                )
            }
        });
    }
    if turned.bore_diameter_m > 0.0 {
        lines.push(format!("Bore of diameter {}", mm(turned.bore_diameter_m)));
    }
    lines.extend(turned.drillings.iter().map(|drilling| {
        let [z, diameter, depth] = [drilling.z_m, drilling.diameter_m, drilling.depth_m].map(mm);
        let angle = degrees(drilling.angle_rad);
        format!("Drill diameter {diameter}, {depth} deep, at z = {z} and {angle} degrees, not cut into the solid: {}", drilling.purpose)
    }));
    lines
}

/// Diameters, windings from z = 0 upwards, ends, and the length of the wire, to a nanometre.
fn windings(coil: &Coil) -> Vec<String> {
    let mm = |m: f64| decimals(m * MM_PER_M, 6);
    let hand = if coil.is_right_handed { "right" } else { "left" };
    let [outer, mean, inner] = [coil.outer_diameter_m(), 2.0 * coil.radius_m, coil.inner_diameter_m()].map(mm);
    let mut lines =
        vec![format!("Diameter {outer} outside, {mean} mean, {inner} inside, {hand}-handed, {} turns", decimals(coil.turns(), 6))];
    for winding in &coil.windings {
        let [low, high] = winding.pitch_m;
        let turns = decimals(winding.turns, 6);
        let pitch = if (high - low).abs() > 0.0 { format!("{} to {}", mm(low), mm(high)) } else { mm(low) };
        lines.push(format!("{turns} turns with a pitch of {pitch}"));
    }
    for (name, end) in ["Lower", "Upper"].iter().zip(&coil.ends) {
        let bend = end.bend_m().map_or_else(String::new, |bend_m| format!(", bent to a mean radius of {}", mm(bend_m)));
        lines.push(match end {
            CoilEnd::Cut => format!("{name} end: {}", end.words()),
            _ => format!("{name} end: {} of {}{bend}, cut square", end.words(), mm(end.leg_m())),
        });
    }
    lines.push(format!("Wire {} long in its middle; {} long over all along the axis", mm(coil.wire_length_m()), mm(coil.length_m())));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_carry_no_rounding_noise() {
        for (value, want) in [(0.1 + 0.2, "0.3"), (-1e-13, "0"), (1e3, "1000"), (-12.5, "-12.5"), (0.0, "0")] {
            assert_eq!(length(value), want);
        }
        assert_eq!(ratio(1.0 / 3.0), "0.333333333333333");
    }
}
