//! Materials: values of the project file, filled up from the catalogue, and which beam is of which.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::text::closest;
use forcewright_base::units::{Unit, format_si};
use forcewright_contract::catalogue::{Named, source_keys};
use forcewright_contract::describe::{Located, Origin};
use forcewright_elements::materials;

use crate::design::si;
use crate::spec::{self, Spec};

/// A material of a design. SI units.
#[derive(Clone, Debug)]
pub struct Material {
    /// Its name in the project file; `None` is that of all beams that name none.
    pub name: Option<String>,
    /// Yield stress, Pa, if known.
    pub yield_pa: Option<f64>,
    /// Largest stress of the tensile test, Pa, if known.
    pub tensile_pa: Option<f64>,
    /// What it endures, if known.
    pub fatigue: Option<Endured>,
    /// Density, kg/m³, if known.
    pub density_kg_per_m3: Option<f64>,
    /// Its entry of the catalogue, if it names one.
    pub entry: Option<&'static materials::Material>,
    /// Where its data come from, in words.
    pub origin: String,
    /// Keys of the works that catalogue values were taken from.
    pub sources: Vec<&'static str>,
    /// What the catalogue says about it.
    pub note: Option<&'static str>,
}

/// A stress that a material endures.
#[derive(Clone, Debug, PartialEq)]
pub struct Endured {
    /// Amplitude, half the range, Pa.
    pub amplitude_pa: f64,
    /// Number of cycles.
    pub cycles: f64,
    /// Lowest over highest stress of a cycle, if known.
    pub stress_ratio: Option<f64>,
    /// Where this is from, in words.
    pub origin: String,
}

/// The materials of a design, and those of its beams.
pub(crate) struct Used {
    /// Of at least one beam each: first that of the beams that name none.
    pub materials: Vec<Material>,
    /// By the index of the beam.
    pub of_beams: Vec<usize>,
}

/// The material that a beam names in the project file, else that of all.
pub(crate) fn typed_material<'a>(spec: &'a Spec, beam: &spec::Beam) -> Option<&'a spec::Material> {
    let Some(name) = &beam.material else { return Some(&spec.material.common) };
    spec.material.named.iter().find(|m| m.name.value == name.value).map(|m| &m.value)
}

/// Fills all materials from the catalogue. Reports names that no material has, and materials that no beam names.
pub(crate) fn fill_materials(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Used {
    let beams = || spec.design.beams.iter().map(|b| b.value.material.as_ref());
    let named = &spec.material.named;
    for name in beams().flatten().filter(|n| named.iter().all(|m| m.name.value != n.value)) {
        let help = match closest(&name.value, named.iter().map(|m| m.name.value.as_str())) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None if named.is_empty() => format!("describe it in a table `[material.{}]`", name.value),
            None => format!("the project has {}", named.iter().map(|m| m.name.value.as_str()).collect::<Vec<_>>().join(", ")),
        };
        diagnostics.push(
            Diagnostic::error("E0304", name.span, format!("there is no material `{}`", name.value))
                .label("not defined in `material`")
                .help(help),
        );
    }
    let is_used = |member: Option<&str>| beams().any(|b| b.map(|n| n.value.as_str()) == member);
    for member in named.iter().filter(|m| !is_used(Some(&m.name.value))) {
        diagnostics.push(
            Diagnostic::warning("W0509", member.name.span, format!("no beam is of the material `{}`", member.name.value))
                .label("not used")
                .help(format!("write `material = \"{}\"` at a beam, or remove the table", member.name.value)),
        );
    }
    let names: Vec<Option<String>> =
        [None].into_iter().chain(named.iter().map(|m| Some(m.name.value.clone()))).filter(|n| is_used(n.as_deref())).collect();
    let of_beams = beams().map(|b| names.iter().position(|n| n.as_ref() == b.map(|n| &n.value)).unwrap_or(0)).collect();
    let spec::Materials { common, named } = &mut spec.material.body;
    let materials = names.into_iter().filter_map(|name| {
        let material = match &name {
            None => &mut *common,
            Some(name) => named.iter_mut().find(|m| m.name.value == *name).map(|m| &mut m.value)?,
        };
        let origin = fill_material(material, diagnostics);
        Some(Material {
            yield_pa: si(material.yield_stress.as_ref()),
            tensile_pa: si(material.tensile_strength.as_ref()),
            fatigue: endured(material),
            density_kg_per_m3: si(material.density.as_ref()),
            entry: catalogue_entry(material),
            origin,
            sources: material_sources(material),
            note: catalogue_entry(material).and_then(|m| m.note.as_deref()),
            name,
        })
    });
    Used { materials: materials.collect(), of_beams }
}

/// Reports what a material of at least one beam lacks. `place` is that of its table.
pub(crate) fn check_complete(material: &spec::Material, place: Span, shear: bool, diagnostics: &mut Diagnostics) {
    // An unknown entry of the catalogue has been reported; what it would have given is not missing as well.
    if material.catalogue.as_ref().is_some_and(|c| materials::find(&c.value).is_none()) {
        return;
    }
    if material.young_modulus.is_none() {
        diagnostics.push(
            Diagnostic::error("E0302", place, "`young_modulus` is missing")
                .label("from this table")
                .help("give `use = \"POM-C\"` or another entry of the catalogue, or `young_modulus = \"2 GPa\"`"),
        );
    }
    if material.poisson_ratio.is_none() && shear && material.young_modulus.is_some() {
        diagnostics.push(
            Diagnostic::error("E0302", place, "`poisson_ratio` is missing")
                .label("from this table")
                .help("the Reissner model needs it for the shear stiffness; give it, or `use` a catalogue entry, or choose `model.beam = \"inextensible\"`"),
        );
    }
}

/// Fills what the catalogue knows, and says in words where the data come from.
fn fill_material(material: &mut spec::Material, diagnostics: &mut Diagnostics) -> String {
    let mut origin = "project file".to_owned();
    if let Some(entry) = &material.catalogue {
        // What is missing for want of the entry need not be reported as well.
        let Some(named) = Named::find(entry, diagnostics) else { return origin };
        let found = named.entry;
        named.fill(&mut material.young_modulus, found.young_modulus_pa.as_ref(), "GPa");
        named.fill(&mut material.poisson_ratio, found.poisson_ratio.as_ref(), "");
        named.fill(&mut material.yield_stress, found.yield_stress_pa.as_ref(), "MPa");
        named.fill(&mut material.tensile_strength, found.tensile_strength_pa.as_ref(), "MPa");
        named.fill(&mut material.density, found.density_kg_per_m3.as_ref(), "kg/m^3");
        let mut overridden = Vec::new();
        for (what, slot, property, symbol) in [
            ("young_modulus", &material.young_modulus, &found.young_modulus_pa, "GPa"),
            ("poisson_ratio", &material.poisson_ratio, &found.poisson_ratio, "1"),
            ("yield_stress", &material.yield_stress, &found.yield_stress_pa, "MPa"),
            ("tensile_strength", &material.tensile_strength, &found.tensile_strength_pa, "MPa"),
            ("density", &material.density, &found.density_kg_per_m3, "kg/m^3"),
        ] {
            if let (Some(Located { origin: Origin::File, value, .. }), Some(property), Ok(unit)) = (slot, property, Unit::parse(symbol)) {
                overridden.push(format!("{what} = {value} instead of {}", format_si(property.value, &unit, 4)));
            }
        }
        origin = format!("catalogue entry {}", found.name);
        if !overridden.is_empty() {
            origin = format!("{origin}; the project file overrides {}", overridden.join(", "));
        }
    }
    origin
}

/// What it endures by the project file, else by the catalogue.
fn endured(material: &spec::Material) -> Option<Endured> {
    let typed = &material.fatigue;
    if typed.present.is_some() {
        return Some(Endured {
            amplitude_pa: si(typed.amplitude.as_ref())?,
            cycles: si(typed.cycles.as_ref())?,
            // The cautious reading: pulsating data taken for reversed ones ask for more.
            stress_ratio: Some(si(typed.ratio.as_ref()).unwrap_or(-1.0)),
            origin: "project file".to_owned(),
        });
    }
    let known = catalogue_entry(material)?.fatigue.as_ref()?;
    let origin = format!("{}, {}", known.kind, known.source);
    Some(Endured { amplitude_pa: known.amplitude_pa, cycles: known.cycles, stress_ratio: known.stress_ratio, origin })
}

/// The entry that the project names.
fn catalogue_entry(material: &spec::Material) -> Option<&'static materials::Material> {
    materials::find(&material.catalogue.as_ref()?.value)
}

/// Sources of the values that the catalogue filled in, each once.
fn material_sources(material: &spec::Material) -> Vec<&'static str> {
    let Some(entry) = catalogue_entry(material) else { return Vec::new() };
    source_keys([
        (&material.young_modulus, entry.young_modulus_pa.as_ref()),
        (&material.poisson_ratio, entry.poisson_ratio.as_ref()),
        (&material.yield_stress, entry.yield_stress_pa.as_ref()),
        (&material.tensile_strength, entry.tensile_strength_pa.as_ref()),
        (&material.density, entry.density_kg_per_m3.as_ref()),
    ])
}
