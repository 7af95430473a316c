//! Materials of flexures, springs and plates, each number with its source.
//!
//! The data are in `data/materials.toml`; sources are keys of `REFERENCES.bib`. A property that no source gives is absent, and a check
//! that needs it is then *not assessed*: nothing is assumed silently. A project file may override any value.
//!
//! ```
//! use forcewright_elements::materials;
//!
//! let pom = materials::find("pom").expect("in the catalogue");
//! let young = pom.young_modulus_pa.as_ref().expect("given");
//! assert_eq!((young.value, young.source.as_str()), (2.85e9, "hostaform-c9021"));
//! ```

pub(crate) mod file;

use std::fmt;
use std::sync::LazyLock;

const DATA: &str = include_str!("../data/materials.toml");

static CATALOGUE: LazyLock<Vec<Material>> =
    LazyLock::new(|| file::read(DATA).expect("the embedded catalogue is read in full by a test of this crate"));

/// Family of materials, by how they behave and are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Thermoplastic, moulded or machined from stock. Creeps.
    Polymer,
    /// Thermoplastic, laser-sintered or extruded in layers. Creeps; depends on orientation and machine.
    PrintedPolymer,
    /// Carbon and low-alloy steel.
    Steel,
    /// Stainless steel.
    StainlessSteel,
    /// Aluminium alloy.
    Aluminium,
    /// Titanium alloy.
    Titanium,
}

impl Class {
    /// All classes.
    pub const ALL: [Self; 6] = [Self::Polymer, Self::PrintedPolymer, Self::Steel, Self::StainlessSteel, Self::Aluminium, Self::Titanium];

    /// The name used in the data file and in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Polymer => "polymer",
            Self::PrintedPolymer => "printed polymer",
            Self::Steel => "steel",
            Self::StainlessSteel => "stainless steel",
            Self::Aluminium => "aluminium",
            Self::Titanium => "titanium",
        }
    }

    /// Whether stiffness and stress of this class drift under lasting load at room temperature.
    pub fn creeps(self) -> bool {
        matches!(self, Self::Polymer | Self::PrintedPolymer)
    }
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How far a value can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueKind {
    /// A lower limit that a standard or specification guarantees, or that follows from one.
    Minimum,
    /// A guide value of a maker or handbook: half of the parts may lie below it.
    Typical,
    /// Found by experiment on a stated material in the literature.
    Measured,
}

impl ValueKind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Minimum, Self::Typical, Self::Measured];

    /// The name used in the data file and in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Minimum => "minimum",
            Self::Typical => "typical",
            Self::Measured => "measured",
        }
    }
}

impl fmt::Display for ValueKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One number with what it is worth and where it is from.
#[derive(Clone, Debug, PartialEq)]
pub struct Property {
    /// Value in SI, in the unit that the field holding it names.
    pub value: f64,
    /// Minimum, typical or measured.
    pub kind: ValueKind,
    /// Key of `REFERENCES.bib`; where a value needs two sources, both keys with a comma between.
    pub source: String,
}

impl Property {
    /// The keys in [`Property::source`], one by one.
    pub fn source_keys(&self) -> impl Iterator<Item = &str> {
        source_keys(&self.source)
    }
}

/// Stress that a material endures for a number of cycles.
#[derive(Clone, Debug, PartialEq)]
pub struct Fatigue {
    /// Stress amplitude, half the range, in Pa; above 0.
    pub amplitude_pa: f64,
    /// Number of cycles endured; above 1.
    pub cycles: f64,
    /// Lowest over highest stress of a cycle: −1 is fully reversed, 0 pulsating. Absent if the source does not say.
    pub stress_ratio: Option<f64>,
    /// Minimum, typical or measured.
    pub kind: ValueKind,
    /// As [`Property::source`].
    pub source: String,
}

impl Fatigue {
    /// The keys in [`Fatigue::source`], one by one.
    pub fn source_keys(&self) -> impl Iterator<Item = &str> {
        source_keys(&self.source)
    }
}

/// Stiffness under a lasting load.
#[derive(Clone, Debug, PartialEq)]
pub struct CreepModulus {
    /// (Time under a constant load, s; stress over the strain then, Pa), times above 0 and ascending; at least one.
    pub values: Vec<[f64; 2]>,
    /// Minimum, typical or measured.
    pub kind: ValueKind,
    /// As [`Property::source`].
    pub source: String,
}

impl CreepModulus {
    /// The keys in [`CreepModulus::source`], one by one.
    pub fn source_keys(&self) -> impl Iterator<Item = &str> {
        source_keys(&self.source)
    }

    /// Creep modulus after a time, Pa: linear in the logarithm of the time between two values that are given; absent outside, where
    /// nothing was measured.
    ///
    /// ```
    /// use forcewright_elements::materials;
    ///
    /// let pom = materials::find("POM-C").and_then(|m| m.creep_modulus.as_ref()).expect("given");
    /// let hour = 3600.0;
    /// assert_eq!((pom.modulus_pa(hour), pom.modulus_pa(0.5 * hour)), (Some(2.5e9), None));
    /// ```
    pub fn modulus_pa(&self, time_s: f64) -> Option<f64> {
        let next = self.values.iter().position(|[at, _]| *at >= time_s)?;
        let [after, there] = self.values[next];
        if after <= time_s {
            return Some(there);
        }
        let [before, here] = *self.values.get(next.checked_sub(1)?)?;
        let part = forcewright_base::maths::ln(time_s / before) / forcewright_base::maths::ln(after / before);
        Some(here + (there - here) * part)
    }
}

fn source_keys(source: &str) -> impl Iterator<Item = &str> {
    source.split(',').map(str::trim)
}

/// A material of the catalogue, at room temperature.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name that reports print: `"POM-C"`.
    pub name: String,
    /// Other names under which [`find`] knows it: trade names, numbers, common words.
    pub aliases: Vec<String>,
    /// Family of the material.
    pub class: Class,
    /// Young's modulus, Pa; 1e8 to 1e12.
    pub young_modulus_pa: Option<Property>,
    /// Poisson's ratio; 0 to 0.5.
    pub poisson_ratio: Option<Property>,
    /// Density, kg/m³.
    pub density_kg_per_m3: Option<Property>,
    /// Stress at which linear elasticity must be given up, Pa: 0.2 % proof stress of metals, first maximum of the tensile curve of polymers
    /// (which lies far outside their linear range), static bending limit of spring steel; `note` says which.
    pub yield_stress_pa: Option<Property>,
    /// Largest stress of the tensile test, Pa: Rm of metals, and the first maximum of polymers that yield before they break.
    pub tensile_strength_pa: Option<Property>,
    /// Endured stress, if a source gives it.
    pub fatigue: Option<Fatigue>,
    /// Stiffness under a lasting load, if a source gives it; of classes that creep.
    pub creep_modulus: Option<CreepModulus>,
    /// What a user should know before trusting the numbers: creep, moisture, orientation, condition.
    pub note: Option<String>,
    /// All sources of this entry, keys of `REFERENCES.bib`, each once, in the order of the properties.
    pub sources: Vec<String>,
}

impl Material {
    /// Shear modulus of the isotropic solid, E / (2 (1 + ν)), in Pa; absent if either is.
    pub fn shear_modulus_pa(&self) -> Option<f64> {
        Some(self.young_modulus_pa.as_ref()?.value / (2.0 * (1.0 + self.poisson_ratio.as_ref()?.value)))
    }

    /// Yield stress over Young's modulus: how far a flexure of given length and thickness can bend. Howell, "Compliant Mechanisms",
    /// ranks flexure materials by it. Absent if either value is.
    pub fn yield_strain(&self) -> Option<f64> {
        Some(self.yield_stress_pa.as_ref()?.value / self.young_modulus_pa.as_ref()?.value)
    }

    fn properties(&self) -> impl Iterator<Item = &Property> {
        [&self.young_modulus_pa, &self.poisson_ratio, &self.density_kg_per_m3, &self.yield_stress_pa, &self.tensile_strength_pa]
            .into_iter()
            .flatten()
    }

    /// Young's modulus that is left under a lasting load after a time, as part of that at its beginning; 1 for classes that do not creep,
    /// absent where the catalogue does not say.
    pub fn modulus_left(&self, time_s: f64) -> Option<f64> {
        if !self.class.creeps() {
            return Some(1.0);
        }
        Some(self.creep_modulus.as_ref()?.modulus_pa(time_s)? / self.young_modulus_pa.as_ref()?.value)
    }

    /// Whether `query` names this material, comparing as [`find`] does.
    fn answers_to(&self, query: &str) -> bool {
        self.all_names().any(|name| folded(name) == query)
    }

    fn all_names(&self) -> impl Iterator<Item = &str> {
        std::iter::once(&self.name).chain(&self.aliases).map(String::as_str)
    }
}

/// All materials, in the order of the data file.
pub fn catalogue() -> &'static [Material] {
    &CATALOGUE
}

/// The material with this name or alias. Case, spaces and punctuation do not matter: `"pom c"` finds POM-C.
pub fn find(name: &str) -> Option<&'static Material> {
    let query = folded(name);
    catalogue().iter().find(|material| material.answers_to(&query))
}

/// Every name and alias that [`find`] knows, as written in the data file: for suggestions and documentation.
pub fn names() -> impl Iterator<Item = &'static str> {
    catalogue().iter().flat_map(Material::all_names)
}

/// All materials with a known [`Material::yield_strain`], the best for flexures first.
pub fn ranked_for_flexures() -> Vec<&'static Material> {
    let mut ranked: Vec<_> = catalogue().iter().filter_map(|m| Some((m.yield_strain()?, m))).collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    ranked.into_iter().map(|(_, material)| material).collect()
}

fn folded(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const REFERENCES: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../REFERENCES.bib"));

    fn value(property: Option<&Property>) -> f64 {
        property.unwrap().value
    }

    #[test]
    fn every_entry_is_complete_and_plausible() {
        assert!(catalogue().len() >= 15);
        for m in catalogue() {
            let young = value(m.young_modulus_pa.as_ref());
            let density = value(m.density_kg_per_m3.as_ref());
            let (youngs, densities) = match m.class {
                Class::Polymer | Class::PrintedPolymer => (0.3e9..6e9, 850.0..1500.0),
                Class::Steel => (200e9..215e9, 7700.0..7900.0),
                Class::StainlessSteel => (175e9..205e9, 7700.0..8100.0),
                Class::Aluminium => (65e9..75e9, 2600.0..2900.0),
                Class::Titanium => (100e9..120e9, 4300.0..4600.0),
            };
            assert!(youngs.contains(&young), "{}: E = {young} Pa", m.name);
            assert!(densities.contains(&density), "{}: {density} kg/m³", m.name);
            assert!((0.2..0.45).contains(&value(m.poisson_ratio.as_ref())), "{}: Poisson's ratio", m.name);
            let strain = m.yield_strain().unwrap();
            assert!((0.0005..0.1).contains(&strain), "{}: yield strain {strain}", m.name);
            assert!(m.note.is_some() || !m.class.creeps(), "{}: a polymer without a word on creep", m.name);
        }
    }

    #[test]
    fn fatigue_lies_below_yield() {
        let with_fatigue: Vec<_> = catalogue().iter().filter(|m| m.fatigue.is_some()).collect();
        assert!(!with_fatigue.is_empty());
        for m in with_fatigue {
            let fatigue = m.fatigue.as_ref().unwrap();
            assert!(fatigue.amplitude_pa > 0.0 && fatigue.amplitude_pa < value(m.yield_stress_pa.as_ref()), "{}", m.name);
            assert!(fatigue.cycles >= 1e5, "{}", m.name);
            assert!(fatigue.stress_ratio.is_none_or(|ratio| (-1.0..1.0).contains(&ratio)), "{}", m.name);
        }
    }

    #[test]
    fn tensile_strength_lies_at_yield_or_above() {
        for m in catalogue().iter().filter(|m| m.tensile_strength_pa.is_some()) {
            let (strength, yields) = (value(m.tensile_strength_pa.as_ref()), value(m.yield_stress_pa.as_ref()));
            assert!((1.0..1.5).contains(&(strength / yields)), "{}: {strength} {yields}", m.name);
        }
        // What can be judged for fatigue needs both.
        assert!(catalogue().iter().all(|m| m.fatigue.is_none() || m.tensile_strength_pa.is_some()));
    }

    #[test]
    fn creep_moduli_fall_and_are_not_drawn_out() {
        let with_creep: Vec<_> = catalogue().iter().filter(|m| m.creep_modulus.is_some()).collect();
        assert!(with_creep.len() >= 2);
        for m in with_creep {
            let creep = m.creep_modulus.as_ref().unwrap();
            assert!(m.class.creeps(), "{}", m.name);
            assert!(creep.values.windows(2).all(|w| w[0][0] < w[1][0] && w[0][1] > w[1][1]), "{}", m.name);
            assert!(creep.values.iter().all(|[t, e]| *t > 0.0 && *e > 0.0 && *e < value(m.young_modulus_pa.as_ref())), "{}", m.name);
        }
        let hour = 3600.0;
        let pom = find("POM-C").unwrap();
        // As printed, and half way in log t: √1000 h.
        for (time, modulus) in [(hour, 2.5e9), (31.622_776_601_683_793 * hour, 1.9e9), (1000.0 * hour, 1.3e9)] {
            let found = pom.modulus_left(time).unwrap() * 2.85e9;
            assert!((found / modulus - 1.0).abs() < 1e-12, "{time}: {found}");
        }
        assert_eq!((pom.modulus_left(0.9 * hour), pom.modulus_left(1001.0 * hour), pom.modulus_left(f64::NAN)), (None, None, None));
        assert_eq!((find("C75S").unwrap().modulus_left(1e9), find("PEEK").unwrap().modulus_left(hour)), (Some(1.0), None));
        // A single value holds at its time only.
        let nylon = find("PA66").unwrap();
        assert_eq!(nylon.modulus_left(999.0 * hour), None);
        assert!((nylon.modulus_left(1000.0 * hour).unwrap() - 0.54 / 1.4).abs() < 1e-15);
    }

    #[test]
    fn every_source_is_in_the_bibliography() {
        let keys: Vec<&str> = REFERENCES.lines().filter_map(|line| line.strip_prefix('@')?.split_once('{')?.1.strip_suffix(',')).collect();
        for (i, key) in keys.iter().enumerate() {
            assert!(!keys[..i].contains(key), "`{key}` twice in REFERENCES.bib");
        }
        for m in catalogue() {
            assert!(!m.sources.is_empty());
            for source in &m.sources {
                assert!(keys.contains(&source.as_str()), "{}: `{source}` is not in REFERENCES.bib", m.name);
            }
            for p in m.properties() {
                assert!(p.source_keys().all(|key| m.sources.iter().any(|s| s == key)), "{}", m.name);
            }
        }
    }

    #[test]
    fn names_are_unique() {
        let all: Vec<String> = names().map(folded).collect();
        for (i, name) in all.iter().enumerate() {
            assert!(!name.is_empty());
            assert!(!all[..i].contains(name), "`{name}` twice");
        }
    }

    #[test]
    fn found_by_name_alias_and_spelling() {
        for (query, name) in [
            ("POM", "POM-C"),
            ("pom c", "POM-C"),
            ("Acetal", "POM-C"),
            ("delrin", "POM-H"),
            ("1.4310", "1.4310 CP1100"),
            ("x10crni18-8", "1.4310 CP1100"),
            ("Spring Steel", "C75S"),
            ("7075 T6", "Al 7075-T6"),
            ("ti 6al 4v", "Ti-6Al-4V"),
            ("petg", "PETG FFF"),
        ] {
            assert_eq!(find(query).map(|m| m.name.as_str()), Some(name), "{query}");
        }
        assert_eq!(find("unobtainium"), None);
        assert_eq!(find(""), None);
        for name in names() {
            assert!(find(name).is_some(), "{name}");
        }
    }

    /// Shear moduli that the sources of E and ν state themselves: EN 10270-1, ASM Handbook vol. 2, MMPDS.
    #[test]
    fn shear_modulus_agrees_with_the_sources() {
        for (name, shear_pa) in [("spring wire", 81.5e9), ("7075", 26.9e9), ("Ti64", 42.7e9)] {
            let ours = find(name).unwrap().shear_modulus_pa().unwrap();
            assert!((ours / shear_pa - 1.0).abs() < 0.02, "{name}: {ours}");
        }
    }

    #[test]
    fn static_bending_limit_of_springs_is_seven_tenths_of_the_strength() {
        for (name, strength_pa) in [("C75S", 1200e6), ("spring wire 1 mm", 1980e6), ("spring wire 2 mm", 1760e6)] {
            let limit = value(find(name).unwrap().yield_stress_pa.as_ref());
            assert!((limit / (0.7 * strength_pa) - 1.0).abs() < 1e-12, "{name}: {limit}");
        }
    }

    #[test]
    fn polymers_lead_the_flexure_ranking() {
        let ranked = ranked_for_flexures();
        assert_eq!(ranked.len(), catalogue().len());
        assert!(ranked[0].class.creeps());
        assert_eq!(ranked.last().map(|m| m.name.as_str()), Some("1.4301"));
    }
}
