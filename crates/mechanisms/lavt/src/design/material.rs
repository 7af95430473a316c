//! What spring and gears are made of.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::units::{Quantity, Unit};
use forcewright_contract::catalogue::{Named, source_keys};
use forcewright_contract::describe::{Located, Origin, Slot};
use forcewright_elements::materials::Property;
use forcewright_elements::springs::{Grade, grade, wire};

use super::{place_of, si};
use crate::spec::Spec;

/// Wire of the spring, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct WireMaterial {
    /// Young's modulus, Pa.
    pub young_pa: f64,
    /// Least tensile strength, Pa.
    pub tensile_pa: Option<f64>,
    /// Density, kg/m³.
    pub density_kg_per_m3: Option<f64>,
    /// Grade of the catalogue.
    pub grade: Option<&'static Grade>,
    /// Sources of what the catalogue filled in.
    pub sources: Vec<&'static str>,
}

/// Material of the gears, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct GearMaterial {
    /// Young's modulus, Pa.
    pub young_pa: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Permissible bending stress at a root, Pa.
    pub bending_pa: Option<f64>,
    /// Permissible pressure between flanks, Pa.
    pub flank_pa: Option<f64>,
    /// Density, kg/m³.
    pub density_kg_per_m3: Option<f64>,
    /// Sources of what the catalogue filled in.
    pub sources: Vec<&'static str>,
}

fn fill(slot: &mut Slot<Quantity>, at: &Located<String>, value: f64, unit: &str, from: String) {
    if slot.is_none()
        && let Ok(unit) = Unit::parse(unit)
    {
        let value = Quantity { si: value, unit, tolerance: None };
        *slot = Some(Located { value, span: at.span, origin: Origin::Catalogue(from) });
    }
}

/// E0806: the wire. Values of the catalogue are written into the specification.
pub(super) fn wire_of(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<WireMaterial> {
    let diameter_m = si(&spec.design.spring.wire_diameter);
    let slots = &mut spec.material.spring.body;
    let mut sources = Vec::new();
    let mut named = None;
    if let Some(name) = &slots.catalogue {
        let bare = name.value.trim_start_matches("EN 10270-1").trim();
        named = grade(bare);
        let Some(found) = named else {
            let all: Vec<String> = wire().grades.iter().map(|g| format!("\"EN 10270-1 {}\"", g.name)).collect();
            let error = Diagnostic::error("E0806", name.span, format!("no such grade of spring wire: \"{}\"", name.value)).unknown_word();
            diagnostics
                .push(error.label("not known").help(format!("grades are {}; or leave `use` out and give the values", all.join(", "))));
            return None;
        };
        let text = |property: &Property| format!("EN 10270-1 {}, {} ({})", found.name, property.kind, property.source);
        let data = wire();
        for (slot, property, unit) in
            [(&mut slots.young_modulus, &data.young_modulus_pa, "GPa"), (&mut slots.density, &data.density_kg_per_m3, "kg/m^3")]
        {
            if slot.is_none() {
                sources.extend(property.source_keys());
            }
            fill(slot, name, property.value, unit, text(property));
        }
        match diameter_m.map(|d| found.tensile_strength_pa(d)) {
            Some(Some(strength_pa)) => {
                if slots.tensile_strength.is_none() {
                    sources.extend(found.at_1_mm_pa.source_keys());
                }
                fill(&mut slots.tensile_strength, name, strength_pa, "MPa", text(&found.at_1_mm_pa));
            }
            Some(None) if slots.tensile_strength.is_none() => {
                let at = spec.design.spring.wire_diameter.as_ref().map_or_else(|| place_of(&spec.design.spring), |l| l.span);
                let error = Diagnostic::error("E0806", at, "the standard has no strength for this diameter of wire").label("this wire");
                diagnostics.push(error.help("it has 0.3 mm to 20 mm; or give `material.spring.tensile_strength`"));
                return None;
            }
            _ => {}
        }
    }
    let slots = &spec.material.spring;
    let Some(young_pa) = si(&slots.young_modulus) else {
        let error = Diagnostic::error("E0806", place_of(slots), "the stiffness of the wire is not known").label("of this wire");
        diagnostics.push(error.help("add `use = \"EN 10270-1 SH\"`, or `young_modulus = \"206 GPa\"`"));
        return None;
    };
    sources.dedup();
    Some(WireMaterial { young_pa, tensile_pa: si(&slots.tensile_strength), density_kg_per_m3: si(&slots.density), grade: named, sources })
}

/// The gears' material, if the project gives one. Values of the catalogue are written into the specification.
pub(super) fn gears_of(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<GearMaterial> {
    spec.material.gears.present.as_ref()?;
    let mut sources = Vec::new();
    if let Some(name) = &spec.material.gears.catalogue {
        let named = Named::find(name, diagnostics)?;
        let entry = named.entry;
        let slots = &mut spec.material.gears.body;
        named.fill(&mut slots.young_modulus, entry.young_modulus_pa.as_ref(), "GPa");
        named.fill(&mut slots.poisson_ratio, entry.poisson_ratio.as_ref(), "1");
        named.fill(&mut slots.density, entry.density_kg_per_m3.as_ref(), "kg/m^3");
        sources = source_keys([
            (&slots.young_modulus, entry.young_modulus_pa.as_ref()),
            (&slots.poisson_ratio, entry.poisson_ratio.as_ref()),
            (&slots.density, entry.density_kg_per_m3.as_ref()),
        ]);
    }
    let slots = &spec.material.gears;
    let Some(young_pa) = si(&slots.young_modulus) else {
        let error = Diagnostic::error("E0302", place_of(slots), "the stiffness of the gears is not known").label("of this material");
        diagnostics.push(error.help("add `use`, or `young_modulus = \"206 GPa\"`"));
        return None;
    };
    Some(GearMaterial {
        young_pa,
        poisson: si(&slots.poisson_ratio).unwrap_or(0.3),
        bending_pa: si(&slots.bending_strength),
        flank_pa: si(&slots.flank_strength),
        density_kg_per_m3: si(&slots.density),
        sources,
    })
}
