//! Files for making the parts of a design.

mod page;

use forcewright_base::diagnostics::Explanation;
use forcewright_fabricate::{Error, Format, Options, Problem, write};
use forcewright_model::{Body, CheckState, Coil, CoilEnd, NoPart, Part, PartSet, Plate, Section, Turned};
use forcewright_report::json;
use serde_json::{Value, json};

use crate::{Loaded, VERSION};

/// The long stories of this command's codes.
pub(crate) const CODES: &[Explanation] = &[
    Explanation {
        code: "E0326",
        title: "a part that cannot be written",
        text: "The outline of a part is checked before anything is written: closed, in its direction, without crossings. This one fails, which a design that has a part should not; please report it with the file.",
    },
    Explanation {
        code: "E0327",
        title: "no finite-element model of this family",
        text: "`--format inp` writes plane finite-element models of plates. Parts that are turned, such as the drums of a cable drive, have none: write them as STEP, and let the program of finite elements mesh that solid.",
    },
];

/// Why a part has no file of this format.
fn not_written(part: &Part, format: Format, error: &Error) -> NoPart {
    if let Problem::OnlyPlates { .. } = error.problem {
        return NoPart {
            code: "E0327",
            message: format!("{} has no finite-element model in this family: {format} is for plates, and it is turned", part.name),
            help: "`--format step` writes the solid; let the program of finite elements mesh that".to_owned(),
        };
    }
    NoPart { code: "E0326", message: format!("{} as {format}: {error}", part.name), help: "please report this with the file".to_owned() }
}

/// The parts of a design with their files.
#[derive(Clone, Debug)]
pub struct Exported {
    /// What is made, and whether its process can make it.
    pub set: PartSet,
    /// Names and contents, part by part.
    pub files: Vec<(String, Vec<u8>)>,
    /// SHA-256 of the project.
    pub input_sha256: String,
    title: String,
    mechanism: &'static str,
}

impl Loaded {
    /// The parts of the design, each once in every format, as files that begin with `stem`.
    ///
    /// # Errors
    /// [`NoPart`] where the design cannot be made as it is drawn, or its outline cannot be written.
    pub fn export(&self, stem: &str, formats: &[Format], options: &Options) -> Result<Exported, NoPart> {
        let set = self.understood.parts()?;
        let mut files = Vec::new();
        for part in &set.parts {
            let name = if set.parts.len() == 1 { stem.to_owned() } else { format!("{stem}-{}", part.name) };
            let mut named: Vec<Format> = Vec::new();
            for format in formats {
                if named.contains(format) {
                    continue;
                }
                named.push(*format);
                let bytes = write(part, *format, options).map_err(|error| not_written(part, *format, &error))?;
                files.push((format!("{name}.{}", format.extension()), bytes));
            }
        }
        files.extend(set.sheets.iter().map(|sheet| (format!("{stem}-{}.csv", sheet.name), sheet.csv().into_bytes())));
        let title = set.parts.first().map_or_else(String::new, |p| p.title.clone());
        Ok(Exported { set, files, input_sha256: self.input_sha256.clone(), title, mechanism: self.family.id() })
    }
}

impl Exported {
    /// Whether the process can make every part, as far as that is asked.
    pub fn can_be_made(&self) -> bool {
        self.set.checks.iter().all(|c| !c.required || c.state == CheckState::Met)
    }

    /// The result document; SI units.
    pub fn document(&self) -> Value {
        json!({
            "schema": 1,
            "forcewright": VERSION,
            "mechanism": self.mechanism,
            "title": self.title,
            "input_sha256": self.input_sha256,
            "parts": self.set.parts.iter().map(part).collect::<Vec<_>>(),
            "checks": self.set.checks.iter().map(json::check).collect::<Vec<_>>(),
            "files": self.files.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(),
        })
    }
}

fn quantity(value: f64, unit: &str) -> Value {
    json!({ "value": value, "unit": unit })
}

fn part(part: &Part) -> Value {
    match &part.body {
        Body::Plate(body) => plate(part, body),
        Body::Turned(body) => turned(part, body),
        Body::Coil(body) => coil(part, body),
    }
}

fn plate(part: &Part, plate: &Plate) -> Value {
    let bounds = plate.outline.bounds();
    json!({
        "name": part.name,
        "material": part.material,
        "depth": quantity(plate.depth_m, "m"),
        "width": quantity(bounds.max_m[0] - bounds.min_m[0], "m"),
        "height": quantity(bounds.max_m[1] - bounds.min_m[1], "m"),
        "area": quantity(plate.area_m2(), "m^2"),
        "cut_length": quantity(plate.cut_length_m(), "m"),
        "mass": part.mass_kg().map(|kg| quantity(kg, "kg")),
        "fillets": plate.fillets.map(|f| json!({ "count": f.count, "radius": f.radius_m.map(|r| quantity(r, "m")) })),
        "volume": quantity(part.volume_m3(), "m^3"),
        "holes": plate.holes.len(),
        "notes": part.notes,
    })
}

fn turned(part: &Part, turned: &Turned) -> Value {
    let section = |section: &Section| match section {
        Section::Plain { length_m, radius_m } => json!({ "length": quantity(*length_m, "m"), "radius": quantity(*radius_m, "m") }),
        Section::Grooved(grooved) => json!({
            "length": quantity(grooved.length_m, "m"),
            "radius": quantity(section.radii_m()[1], "m"),
            "bottom_radius": quantity(section.radii_m()[0], "m"),
            "lead": quantity(grooved.lead_m, "m"),
            "starts": grooved.starts,
            "phase": quantity(grooved.phase_rad, "rad"),
        }),
    };
    let drillings = turned.drillings.iter().map(|drilling| {
        json!({
            "z": quantity(drilling.z_m, "m"),
            "angle": quantity(drilling.angle_rad, "rad"),
            "diameter": quantity(drilling.diameter_m, "m"),
            "depth": quantity(drilling.depth_m, "m"),
            "purpose": drilling.purpose,
        })
    });
    json!({
        "name": part.name,
        "material": part.material,
        "length": quantity(turned.length_m(), "m"),
        "diameter": quantity(2.0 * turned.largest_radius_m(), "m"),
        "bore": quantity(turned.bore_diameter_m, "m"),
        "sections": turned.sections.iter().map(section).collect::<Vec<_>>(),
        "drillings": drillings.collect::<Vec<_>>(),
        "mass": part.mass_kg().map(|kg| quantity(kg, "kg")),
        "volume": quantity(part.volume_m3(), "m^3"),
        "notes": part.notes,
    })
}

fn coil(part: &Part, coil: &Coil) -> Value {
    let end = |end: &CoilEnd| {
        json!({
            "kind": end.words(),
            "bend_radius": end.bend_m().map(|m| quantity(m, "m")),
            "leg": quantity(end.leg_m(), "m"),
        })
    };
    let windings =
        coil.windings.iter().map(|winding| json!({ "turns": winding.turns, "pitch": winding.pitch_m.map(|m| quantity(m, "m")) }));
    json!({
        "name": part.name,
        "material": part.material,
        "wire": quantity(coil.wire_m, "m"),
        "outer_diameter": quantity(coil.outer_diameter_m(), "m"),
        "inner_diameter": quantity(coil.inner_diameter_m(), "m"),
        "length": quantity(coil.length_m(), "m"),
        "wire_length": quantity(coil.wire_length_m(), "m"),
        "hand": if coil.is_right_handed { "right" } else { "left" },
        "start": quantity(coil.start_rad, "rad"),
        "windings": windings.collect::<Vec<_>>(),
        "ends": coil.ends.iter().map(end).collect::<Vec<_>>(),
        "mass": part.mass_kg().map(|kg| quantity(kg, "kg")),
        "volume": quantity(part.volume_m3(), "m^3"),
        "notes": part.notes,
    })
}
