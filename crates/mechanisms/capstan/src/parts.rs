//! What is made of a drive: its drums as turned parts, and the tables that a workshop needs.
//!
//! Only the drums: flanges, shafts and the frame are the business of the machine around. The grooves are those of
//! [`geometry`](crate::geometry): line by line where the cable lies. Drillings are told, not cut.

mod drum;
mod sheets;

use forcewright_base::units::{Dimension, format_number, format_si};
use forcewright_contract::judge::Comparison;
use forcewright_elements::grooves::Groove as Friction;
use forcewright_model::{Body, Check, NoPart, Part, PartSet, Sense};

use crate::design::Design;
use crate::geometry::{Drive, Drum};
use drum::{DRUMS, Made, SLOT_DEPTH, name_of, no_drum, spacing_m};

/// Upper flanks that hang over by more sag when they are printed without support, rad: 45°.
const OVERHANG_RAD: f64 = std::f64::consts::FRAC_PI_4;

/// The drums of a drive, their tables, and what can be said of making them.
///
/// # Errors
/// E0730 where the numbers make no drum, E0731 where the two groups of output grooves cannot be cut beside each other.
pub(crate) fn parts(design: &Design) -> Result<PartSet, NoPart> {
    let geometry = design.built.geometry().map_err(|error| no_drum(&error))?;
    let both = |clearance_m: f64| DRUMS.iter().map(|drum| Made::new(design, &geometry, *drum, clearance_m)).collect::<Result<Vec<_>, _>>();
    let made = both(0.0)?;
    let inertia: Vec<Option<[f64; 2]>> = made
        .iter()
        .map(|m| design.making.density_kg_per_m3.map(|density| [m.body.volume_m3(), m.body.polar_moment_m5()].map(|x| density * x)))
        .collect();
    let sheets = sheets::sheets(design, &geometry, &made, &inertia)?;
    let checks = made.iter().flat_map(|m| checks(design, &geometry, m)).collect();
    let mut parts: Vec<Part> = made.into_iter().map(|m| part(design, &geometry, m, None)).collect();
    // Flat drums have nothing to be wider.
    if let Some(clearance_m) = design.making.clearance_m.filter(|_| design.built.seat.groove != Friction::Flat) {
        parts.extend(both(clearance_m)?.into_iter().map(|m| part(design, &geometry, m, Some(clearance_m))));
    }
    Ok(PartSet { parts, marks: Vec::new(), sheets, display: design.units.length.clone(), checks })
}

/// A drum as a part; for printing where a clearance is given.
fn part(design: &Design, geometry: &Drive, made: Made, clearance_m: Option<f64>) -> Part {
    let name = name_of(made.drum);
    let shown = if made.drum == Drum::Input { "Input" } else { "Output" };
    let (name, title) = match clearance_m {
        None => (format!("{name}-drum"), format!("{shown} drum")),
        Some(_) => (format!("{name}-drum-print"), format!("{shown} drum, for printing")),
    };
    let mut notes = notes(design, geometry, &made);
    if let Some(clearance_m) = clearance_m {
        notes.push(printing(design, &made, clearance_m));
    }
    Part {
        name,
        title,
        count: usize::from(clearance_m.is_none()),
        material: None,
        density_kg_per_m3: design.making.density_kg_per_m3,
        notes,
        body: Body::Turned(made.body),
    }
}

/// What the maker must know.
fn notes(design: &Design, geometry: &Drive, made: &Made) -> Vec<String> {
    let length = |m: f64| format_si(m, &design.units.length, 5);
    let mut notes = vec![
        "The x axis points from the input's to the output's axis at the start of the travel; z counts from the lower end face.".to_owned(),
        "Flanges, keys and tensioners are not in the solid.".to_owned(),
    ];
    if !made.body.drillings.is_empty() {
        notes.push(
            "The holes for the cables are not in the solid: the table `drillings` places them; their depth is a proposal.".to_owned(),
        );
    }
    let Some(groove) = &made.groove else {
        notes.push("A flat drum: the cable lays itself, the paths of the geometry are where it runs true.".to_owned());
        return notes;
    };
    let per_mm = 1e-3 * geometry.landing_pitches_per_m();
    notes.push(format!(
        "The distance of the axes matters: for each 0.1 mm the cable lands {} of a pitch beside its groove. So does the lead, which must be the same on both drums in relation to their radii.",
        format_number(0.1 * per_mm, 3)
    ));
    match &design.built.seat.groove {
        // Smaller than the cable, an arc between the flanks stays below it.
        Friction::Vee { .. } => notes.push(format!(
            "The flanks meet at a radius of {}; the bottom may be rounded with a radius up to {}.",
            length(groove.radii_m()[0]),
            length(0.25 * design.built.cable_m())
        )),
        Friction::Undercut { .. } => notes.push(format!(
            "The slot is deeper than the seat by {}: a proposal, so that a worn cable does not reach its bottom.",
            length(SLOT_DEPTH * design.built.cable_m())
        )),
        Friction::Flat | Friction::Round { .. } => {}
    }
    if made.stretches.len() > 1 {
        notes.push("Each group of grooves has its own stretch, with a plain relief between for the tool to run out.".to_owned());
    }
    notes
}

/// How to print it.
fn printing(design: &Design, made: &Made, clearance_m: f64) -> String {
    let overhang_rad = made.overhang_rad().unwrap_or(0.0);
    let verdict = if overhang_rad > OVERHANG_RAD {
        "more than 45°: their edges sag without support, so fine layers, or a touch with a round file"
    } else {
        "no more than 45°, which prints without support"
    };
    format!(
        "For printing: grooves wider by {} on all sides. Print with the axis upright, so that the layers lie across the axis; the upper flanks then hang over by up to {}°, {verdict}.",
        format_si(clearance_m, &design.units.length, 4),
        format_number(overhang_rad.to_degrees(), 3)
    )
}

/// What can be said of making a drum.
fn checks(design: &Design, geometry: &Drive, made: &Made) -> Vec<Check> {
    let name = name_of(made.drum);
    let base = |code: &'static str, name: String, title: String, value: f64, limit: Option<f64>| Comparison {
        code,
        name,
        title,
        required: false,
        value: Some(value),
        limit,
        sense: Sense::AtLeast,
        dimension: Dimension::Length,
        display: design.units.length.clone(),
        scale: Some(design.built.cable_m()),
        basis: String::new(),
        fix: String::new(),
        missing: String::new(),
        partial: false,
        broken: false,
    };
    let mut all = Vec::new();
    let least_m = made.body.sections.iter().map(|s| s.radii_m()[0]).fold(f64::INFINITY, f64::min);
    if made.body.bore_diameter_m > 0.0 {
        let wall_m = least_m - 0.5 * made.body.bore_diameter_m;
        let wall = base("CAPS020", format!("{name}_wall"), format!("Wall of the {name} drum"), wall_m, Some(design.built.cable_m()));
        let basis = "wall between the bore and the bottom of the grooves or the relief; a cable's diameter is asked for, so that a turn does not press its own mark through".to_owned();
        let fix = format!("`parts.{name}_bore` smaller, or a larger drum");
        all.push(Comparison { basis, fix, ..wall }.judge());
    }
    if let Some(groove) = &made.groove {
        let start_m = groove.start_m[0];
        let land_m = spacing_m(geometry, made.drum) + 2.0 * start_m;
        let (least_m, required) = design.making.least_wall;
        let land = base("CAPS021", format!("{name}_land"), format!("Land between the grooves of the {name} drum"), land_m, Some(least_m));
        let length = |m: f64| format_si(m, &design.units.length, 4);
        let fix = format!(
            "`groove.pitch` of at least {}, shallower grooves, or a process with a smaller `parts.least_wall`",
            length(1.0005 * design.built.pitch_m * (1.0 + (least_m - land_m) / spacing_m(geometry, made.drum)))
        );
        let basis = "land between neighbouring grooves along the axis against `parts.least_wall`; without it against 0.2 mm, our choice for turned metal".to_owned();
        all.push(Comparison { basis, fix, required, ..land }.judge());
    }
    if made.drum == Drum::Input && design.built.fastened {
        let turned = geometry.ratio() * geometry.layout().travel_rad;
        let pin = Comparison {
            dimension: Dimension::Angle,
            display: design.units.angle.clone(),
            basis: "wrap on the input drum against the turn of the input over the travel: a pin must stay under the cable".to_owned(),
            fix: "more `extra_turns`, or less travel".to_owned(),
            required: true,
            ..base(
                "CAPS022",
                "pin".to_owned(),
                "The pin on the input drum stays under the cable".to_owned(),
                geometry.input_wrap_rad(),
                Some(turned),
            )
        };
        all.push(pin.judge());
    }
    all
}
