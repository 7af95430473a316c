//! Cables: from the catalogue or by their values.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::text::closest;
use forcewright_base::units::{Dimension, Quantity, Unit, format_si};
use forcewright_contract::describe::{Located, Origin, Slot};
use forcewright_elements::cables::{self, Construction};
use forcewright_elements::materials::{self, Property};

use super::{Built, place_of, si};
use crate::geometry::{Drive, GeometryError, Layout};
use crate::spec::{self, Spec};
use crate::whole::small;

/// Cables of a drive at most: their neighbours are looked at in pairs, and all lie on the one helix of the input.
const MOST_CABLES: usize = 32;

/// A cable of the drive, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Cable {
    /// Construction of the catalogue, if it is from there.
    pub construction: Option<&'static Construction>,
    /// Nominal diameter, m.
    pub diameter_m: f64,
    /// AE, N.
    pub axial_stiffness_n: f64,
    /// Of the straight cable, N.
    pub breaking_n: Option<f64>,
    /// kg/m.
    pub mass_kg_per_m: Option<f64>,
    /// Least diameter of a drum over that of the cable.
    pub least_ratio: Option<f64>,
    /// Diameter of the outer wires, m.
    pub wire_m: Option<f64>,
    /// Young's modulus of the wires, Pa.
    pub wire_pa: Option<f64>,
    /// Along the cable, 1/K.
    pub expansion_per_k: Option<f64>,
    /// Part of its tension lost in bending round the input drum.
    pub bending_loss: Option<f64>,
    /// Groove lines of its two ends.
    pub lines: [i32; 2],
    /// At assembly, N.
    pub preload_n: f64,
    /// Part of it that bedding in and creep take.
    pub preload_loss: f64,
    /// Keys of the works that catalogue values were taken from.
    pub sources: Vec<&'static str>,
}

impl Cable {
    /// Preload after bedding in and at the temperature given, N. Drums and frame of one expansion make the whole path longer by
    /// α ΔT, the cable by its own: `ΔT_p = AE (α − α_c) ΔT`, the same everywhere.
    pub fn preload_left_n(&self, built: &Built) -> f64 {
        let apart = built.expansion_per_k.unwrap_or(0.0) - self.expansion_per_k.unwrap_or(0.0);
        let warmed = if built.warmer_k == 0.0 { 0.0 } else { self.axial_stiffness_n * apart * built.warmer_k };
        self.preload_n * (1.0 - self.preload_loss) + warmed
    }
}

/// E0703, E0708: cables that are complete, of one diameter, and not too many.
pub(super) fn cables_of(spec: &mut Spec, diagnostics: &mut Diagnostics) -> Option<Vec<Cable>> {
    let place = place_of(&spec.design);
    if spec.design.cables.is_empty() {
        return None;
    }
    if let Some(beyond) = spec.design.cables.get(MOST_CABLES) {
        let error = Diagnostic::error("E0708", beyond.name.span, format!("{} cables are more than a drive has", spec.design.cables.len()));
        diagnostics.push(error.label("one too many").help(format!("at most {MOST_CABLES}; fewer and thicker ones take less room")));
        return None;
    }
    let mut all: Vec<Cable> = Vec::new();
    for member in &mut spec.design.cables {
        let span = member.name.span;
        let Some(cable) = cable_of(&mut member.value, span, diagnostics) else { continue };
        if let Some(first) = all.first().filter(|f| (f.diameter_m / cable.diameter_m - 1.0).abs() > 1e-9) {
            let at = member.value.diameter.as_ref().or(None).map_or(span, |d| d.span);
            let mm = Unit::parse("mm").unwrap_or_else(|_| Unit::si(Dimension::Length));
            let error = Diagnostic::error("E0703", at, "cables of different diameters do not fit the same grooves");
            let one = format_si(first.diameter_m, &mm, 4);
            diagnostics.push(error.label("another diameter").help(format!("the first has {one}: give all cables of a drive one diameter")));
        }
        all.push(cable);
    }
    if all.is_empty() && !diagnostics.has_errors() {
        diagnostics.push(Diagnostic::error("E0703", place, "the drive has no cable").label("this table").help("add `[[design.cables]]`"));
    }
    Some(all)
}

fn cable_of(typed: &mut spec::Cable, span: Span, diagnostics: &mut Diagnostics) -> Option<Cable> {
    let before = diagnostics.errors();
    let construction = typed.catalogue.clone().and_then(|name| fill(typed, &name, diagnostics));
    if diagnostics.errors() > before {
        return None;
    }
    let mut missing = |slot: &Slot<Quantity>, key: &str, help: &str| {
        if slot.is_none() {
            let error = Diagnostic::error("E0703", span, format!("the cable's `{key}` is not known"));
            diagnostics.push(error.label("this cable").help(help.to_owned()));
        }
    };
    missing(&typed.diameter, "diameter", "give `diameter`, or `use = \"steel 7x19 1.5 mm\"`");
    let help = match construction {
        Some(construction) => {
            format!("no source gives it for {}: measure it at the preload it will have, and give `axial_stiffness`", construction.name)
        }
        None => "give `axial_stiffness`, or a construction of the catalogue with `use`".to_owned(),
    };
    missing(&typed.axial_stiffness, "axial_stiffness", &help);
    Some(Cable {
        construction,
        diameter_m: si(&typed.diameter)?,
        axial_stiffness_n: si(&typed.axial_stiffness)?,
        breaking_n: si(&typed.breaking_force),
        mass_kg_per_m: si(&typed.mass),
        least_ratio: si(&typed.min_bend_ratio),
        wire_m: si(&typed.wire_diameter),
        wire_pa: si(&typed.wire_modulus),
        expansion_per_k: si(&typed.expansion),
        bending_loss: si(&typed.bending_loss),
        // Placed when the number of turns is known.
        lines: [0, 0],
        preload_n: si(&typed.preload)?,
        preload_loss: si(&typed.preload_loss).unwrap_or(0.0),
        sources: construction.map_or_else(Vec::new, |c| sources_of(typed, c)),
    })
}

/// Splits `steel 7x19 1.5 mm` into a name and a diameter.
fn name_and_diameter(text: &str) -> (&str, Option<Quantity>) {
    let text = text.trim();
    let breaks: Vec<usize> = text.char_indices().filter(|(_, c)| c.is_whitespace()).map(|(i, _)| i).collect();
    // The unit may stand apart from its number.
    for at in breaks.iter().rev().take(2) {
        if let Ok(quantity) = Quantity::parse(text[*at..].trim(), Dimension::Length) {
            return (text[..*at].trim(), Some(quantity));
        }
    }
    (text, None)
}

/// Fills what the catalogue knows; the diameter of the name counts unless one is typed.
fn fill(typed: &mut spec::Cable, name: &Located<String>, diagnostics: &mut Diagnostics) -> Option<&'static Construction> {
    let (construction, diameter) = name_and_diameter(&name.value);
    let Some(entry) = cables::find(construction) else {
        let names: Vec<&str> = cables::catalogue().iter().map(|c| c.name.as_str()).collect();
        let aliases = cables::catalogue().iter().flat_map(|c| c.aliases.iter().map(String::as_str));
        let near = closest(construction, names.iter().copied().chain(aliases));
        let listed = format!("the catalogue has {}", names.join(", "));
        let error = Diagnostic::error("E0703", name.span, "no such cable in the catalogue").label("not known").unknown_word();
        diagnostics.push(error.help(near.map_or_else(|| listed.clone(), |n| format!("did you mean \"{n}\"? {listed}"))));
        return None;
    };
    if let (None, Some(value)) = (&typed.diameter, diameter) {
        typed.diameter = Some(Located { value, span: name.span, origin: Origin::File });
    }
    let diameter_m = si(&typed.diameter)?;
    let put = |slot: &mut Slot<Quantity>, value: Option<f64>, property: Option<&Property>, unit: &str| {
        if let (None, Some(value), Ok(unit)) = (&slot, value, Unit::parse(unit)) {
            let from = property.map_or_else(|| entry.name.clone(), |p| format!("{}, {} ({})", entry.name, p.kind, p.source));
            *slot =
                Some(Located { value: Quantity { si: value, unit, tolerance: None }, span: name.span, origin: Origin::Catalogue(from) });
        }
    };
    let listed = entry.size(diameter_m);
    let strength = listed.map(|s| &s.breaking_force_n).or(entry.strength_over_square_pa.as_ref());
    put(&mut typed.axial_stiffness, entry.axial_stiffness_n(diameter_m), entry.stiffness_over_square_pa.as_ref(), "N");
    put(&mut typed.breaking_force, entry.breaking_force_n(diameter_m), strength, "N");
    let mass = listed.and_then(|s| s.mass_kg_per_m.as_ref()).or(entry.mass_over_square_kg_per_m3.as_ref());
    put(&mut typed.mass, entry.mass_kg_per_m(diameter_m), mass, "g/m");
    put(&mut typed.min_bend_ratio, entry.least_ratio.as_ref().map(|p| p.value), entry.least_ratio.as_ref(), "");
    put(&mut typed.wire_diameter, entry.wire_m(diameter_m), None, "mm");
    let young = wire_modulus(entry);
    put(&mut typed.wire_modulus, young.map(|p| p.value), young, "GPa");
    Some(entry)
}

/// The steel that stands for the wires of a construction, in the catalogue of materials; only its modulus is used.
fn wire_material(construction: &str) -> Option<&'static str> {
    if construction.contains("stainless") {
        Some("1.4310 CP1100")
    } else if construction.contains("galvanised") {
        Some("EN 10270-1 SM 1 mm")
    } else {
        None
    }
}

/// Modulus of the wires of a construction.
fn wire_modulus(entry: &Construction) -> Option<&'static Property> {
    wire_material(&entry.name).and_then(materials::find)?.young_modulus_pa.as_ref()
}

/// Modulus of the wires of a construction, Pa; `None` where its wires are not known.
pub(crate) fn wire_modulus_pa(entry: &Construction) -> Option<f64> {
    Some(wire_modulus(entry)?.value)
}

/// Works behind the values that the catalogue filled in.
fn sources_of(typed: &spec::Cable, entry: &'static Construction) -> Vec<&'static str> {
    let filled = |slot: &Slot<Quantity>| matches!(slot, Some(Located { origin: Origin::Catalogue(_), .. }));
    let any = [&typed.axial_stiffness, &typed.breaking_force, &typed.min_bend_ratio, &typed.mass].into_iter().any(filled);
    let mut keys: Vec<&'static str> = Vec::new();
    for key in entry.properties().flat_map(Property::source_keys).filter(|_| any) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}

/// E0704: groove lines of the ends. By default cables lie as close to each other as they keep clear.
pub(super) fn place_lines(spec: &Spec, built: &mut Built, diagnostics: &mut Diagnostics) {
    let usual = usual_lines(built);
    let mut taken: Vec<i32> = Vec::new();
    for (index, (member, usual)) in spec.design.cables.iter().zip(usual).enumerate() {
        let beside = format!("`lines = [{}, {}]`", usual[0], usual[1]);
        let lines = match &member.value.lines {
            None => usual,
            Some(typed) => typed_lines(&typed.value).unwrap_or_else(|| {
                diagnostics.push(
                    Diagnostic::error("E0704", typed.span, "a cable has two ends, each on a groove line")
                        .label("not two whole numbers")
                        .help(format!("for this cable: {beside}")),
                );
                usual
            }),
        };
        if taken.contains(&lines[0]) {
            let at = member.value.lines.as_ref().map_or(member.name.span, |l| l.span);
            diagnostics.push(
                Diagnostic::error("E0704", at, format!("line {} is taken by another cable", lines[0]))
                    .label("the same first line")
                    .help(format!("cables lie side by side: {beside}")),
            );
        }
        taken.push(lines[0]);
        if let Some(cable) = built.cables.get_mut(index) {
            cable.lines = lines;
        }
    }
}

fn typed_lines(typed: &[f64]) -> Option<[i32; 2]> {
    match typed {
        [one, other] if one.fract() == 0.0 && other.fract() == 0.0 => Some([small(*one), small(*other)]),
        _ => None,
    }
}

/// Lines of all cables that keep clear of each other; where there are none, side by side.
fn usual_lines(built: &Built) -> Vec<[i32; 2]> {
    let count = built.cables.len();
    let turns = i32::try_from(built.extra_turns).unwrap_or(i32::MAX).saturating_add(1);
    let one = |apart: i32| Drive::new(Layout { cables: vec![[0, apart]], ..built.layout() });
    let (apart, drive) = match one(turns) {
        Err(GeometryError::Lines { nearest, .. }) => {
            let apart = i32::try_from(nearest).unwrap_or(turns);
            (apart, one(apart).ok())
        }
        drive => (turns, drive.ok()),
    };
    let beside = |i: usize| {
        let first = i32::try_from(i).unwrap_or(i32::MAX).saturating_mul(apart.saturating_add(1));
        [first, first.saturating_add(apart)]
    };
    drive.and_then(|d| d.clear_cables(count, 0.0)).unwrap_or_else(|| (0..count).map(beside).collect())
}
