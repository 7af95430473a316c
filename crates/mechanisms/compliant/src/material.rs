//! The material: values of the project file, filled up from the catalogue.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::text::closest;
use forcewright_base::units::{Quantity, Unit, format_si};
use forcewright_contract::describe::{Located, Origin, Slot};
use forcewright_elements::materials::{self, Property};

use crate::spec;

/// Fills what the catalogue knows, and says in words where the data come from.
pub(crate) fn fill_material(material: &mut spec::Material, diagnostics: &mut Diagnostics) -> String {
    let mut origin = "project file".to_owned();
    if let Some(entry) = &material.catalogue {
        let span = entry.span;
        let Some(found) = materials::find(&entry.value) else {
            let help = "`forcewright materials` lists the catalogue; or leave `use` out and give the values yourself";
            let near = closest(&entry.value, materials::names());
            diagnostics.push(
                Diagnostic::error("E0308", span, "no such material in the catalogue")
                    .label("not known")
                    .help(near.map_or_else(|| help.to_owned(), |n| format!("did you mean \"{n}\"? {help}"))),
            );
            // What is missing for want of the entry need not be reported as well.
            return origin;
        };
        let fill = |slot: &mut Slot<Quantity>, property: Option<&Property>, symbol: &str| {
            if let (None, Some(property)) = (&slot, property)
                && let Ok(unit) = Unit::parse(symbol)
            {
                let value = Quantity { si: property.value, unit, tolerance: None };
                *slot = Some(Located {
                    value,
                    span,
                    origin: Origin::Catalogue(format!("{}, {} ({})", found.name, property.kind, property.source)),
                });
            }
        };
        fill(&mut material.young_modulus, found.young_modulus_pa.as_ref(), "GPa");
        fill(&mut material.poisson_ratio, found.poisson_ratio.as_ref(), "");
        fill(&mut material.yield_stress, found.yield_stress_pa.as_ref(), "MPa");
        fill(&mut material.density, found.density_kg_per_m3.as_ref(), "kg/m^3");
        let mut overridden = Vec::new();
        for (what, slot, property, symbol) in [
            ("young_modulus", &material.young_modulus, &found.young_modulus_pa, "GPa"),
            ("poisson_ratio", &material.poisson_ratio, &found.poisson_ratio, "1"),
            ("yield_stress", &material.yield_stress, &found.yield_stress_pa, "MPa"),
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

/// The entry that the project names.
pub(crate) fn catalogue_entry(material: &spec::Material) -> Option<&'static materials::Material> {
    materials::find(&material.catalogue.as_ref()?.value)
}

/// Sources of the values that the catalogue filled in, each once.
pub(crate) fn material_sources(material: &spec::Material) -> Vec<&'static str> {
    let Some(entry) = catalogue_entry(material) else { return Vec::new() };
    let taken = [
        (&material.young_modulus, &entry.young_modulus_pa),
        (&material.poisson_ratio, &entry.poisson_ratio),
        (&material.yield_stress, &entry.yield_stress_pa),
        (&material.density, &entry.density_kg_per_m3),
    ];
    let from_catalogue = |slot: &Slot<Quantity>| matches!(slot, Some(Located { origin: Origin::Catalogue(_), .. }));
    let mut keys: Vec<&'static str> = Vec::new();
    for key in taken.into_iter().filter(|(slot, _)| from_catalogue(slot)).filter_map(|(_, p)| p.as_ref()).flat_map(Property::source_keys) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}
