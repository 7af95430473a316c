//! Files for making the parts of a design.

mod page;

use forcewright_base::diagnostics::Explanation;
use forcewright_fabricate::{Format, Options, write};
use forcewright_model::{CheckState, NoPart, Part, PartSet};
use forcewright_report::json;
use serde_json::{Value, json};

use crate::{Loaded, VERSION};

/// The long stories of this command's codes.
pub(crate) const CODES: &[Explanation] = &[Explanation {
    code: "E0326",
    title: "a part that cannot be written",
    text: "The outline of a part is checked before anything is written: closed, in its direction, without crossings. This one fails, which a design that has a part should not; please report it with the file.",
}];

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
                let bytes = write(part, *format, options).map_err(|error| NoPart {
                    code: "E0326",
                    message: format!("{} as {format}: {error}", part.name),
                    help: "please report this with the file".to_owned(),
                })?;
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

fn part(part: &Part) -> Value {
    let bounds = part.outline.bounds();
    let quantity = |value: f64, unit: &str| json!({ "value": value, "unit": unit });
    json!({
        "name": part.name,
        "material": part.material,
        "depth": quantity(part.depth_m, "m"),
        "width": quantity(bounds.max_m[0] - bounds.min_m[0], "m"),
        "height": quantity(bounds.max_m[1] - bounds.min_m[1], "m"),
        "area": quantity(part.area_m2(), "m^2"),
        "cut_length": quantity(part.cut_length_m(), "m"),
        "mass": part.mass_kg().map(|kg| quantity(kg, "kg")),
        "fillets": part.fillets.map(|f| json!({ "count": f.count, "radius": f.radius_m.map(|r| quantity(r, "m")) })),
        "volume": quantity(part.area_m2() * part.depth_m, "m^3"),
        "holes": part.holes.len(),
        "notes": part.notes,
    })
}
