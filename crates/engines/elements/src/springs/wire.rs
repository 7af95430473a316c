//! Spring wire and its data file.

use std::sync::LazyLock;

use forcewright_base::maths::log10;
use forcewright_base::units::Dimension;
use toml::de::{DeTable, DeValue};

use crate::materials::Property;
use crate::materials::file::{known_keys, property, si, text};

const DATA: &str = include_str!("../../data/spring_wire.toml");

static WIRE: LazyLock<Wire> = LazyLock::new(|| read(DATA).expect("the embedded data are read in full by a test of this crate"));

/// Patented cold-drawn spring wire of EN 10270-1, as in `data/spring_wire.toml`.
#[derive(Clone, Debug, PartialEq)]
pub struct Wire {
    /// Shear modulus, Pa.
    pub shear_modulus_pa: Property,
    /// Young's modulus, Pa.
    pub young_modulus_pa: Property,
    /// Density, kg/m³.
    pub density_kg_per_m3: Property,
    /// Permissible shear stress of an extension spring at its largest force, over the least tensile strength.
    pub extension_limit: Property,
    /// Permissible shear stress of a compression spring at its solid length, over the least tensile strength.
    pub compression_limit: Property,
    /// Permissible static bending stress of a torsion spring, over the least tensile strength.
    pub bending_limit: Property,
    /// Diameters that makers stock, m, ascending.
    pub diameters_m: Vec<f64>,
    /// Nominal diameters and the deviation (±) permitted up to each, m, ascending; from 0.28 mm on.
    pub diameter_tolerances_m: Vec<[f64; 2]>,
    /// Grades by rising strength.
    pub grades: Vec<Grade>,
}

/// A grade of spring wire.
#[derive(Clone, Debug, PartialEq)]
pub struct Grade {
    /// `"SM"`, `"DM"`, `"SH"` or `"DH"`.
    pub name: String,
    /// What it is for, in words.
    pub purpose: String,
    /// Least tensile strength of a wire of 1 mm, Pa.
    pub at_1_mm_pa: Property,
    /// By which it is less for ten times the diameter, Pa.
    pub per_decade_pa: f64,
}

impl Grade {
    /// Least tensile strength `R_m` (Pa) of a wire diameter (m); absent outside 0.3 … 20 mm, which the standard has for all grades here.
    pub fn tensile_strength_pa(&self, wire_m: f64) -> Option<f64> {
        (0.3e-3..=20e-3).contains(&wire_m).then(|| self.at_1_mm_pa.value - self.per_decade_pa * log10(wire_m / 1e-3))
    }
}

/// The data of spring wire.
pub fn wire() -> &'static Wire {
    &WIRE
}

/// A grade by its name; case does not matter.
pub fn grade(name: &str) -> Option<&'static Grade> {
    wire().grades.iter().find(|grade| grade.name.eq_ignore_ascii_case(name))
}

fn read(data: &str) -> Result<Wire, String> {
    let table = DeTable::parse(data).map_err(|error| error.to_string())?;
    known_keys(table.get_ref(), &["wire", "grade"])?;
    let common = table.get_ref().get("wire").and_then(|item| item.get_ref().as_table()).ok_or("no [wire]")?;
    known_keys(
        common,
        &[
            "shear_modulus",
            "young_modulus",
            "density",
            "extension_limit",
            "compression_limit",
            "bending_limit",
            "diameter_tolerances",
            "diameters",
        ],
    )?;
    let needed = |key: &str, dimension: Dimension| property(common, key, dimension)?.ok_or_else(|| format!("no `{key}`"));
    let grades = table.get_ref().get("grade").and_then(|list| list.get_ref().as_array()).ok_or("no [[grade]]")?;
    let diameters = common.get("diameters").and_then(|list| list.get_ref().as_array()).ok_or("no `diameters`")?;
    let tolerances = common.get("diameter_tolerances").and_then(|list| list.get_ref().as_array()).ok_or("no `diameter_tolerances`")?;
    let diameter = |item: &DeValue| si(item.as_str().ok_or("a diameter is not text")?, Dimension::Length);
    Ok(Wire {
        shear_modulus_pa: needed("shear_modulus", Dimension::Stress)?,
        young_modulus_pa: needed("young_modulus", Dimension::Stress)?,
        density_kg_per_m3: needed("density", Dimension::Density)?,
        extension_limit: needed("extension_limit", Dimension::Ratio)?,
        compression_limit: needed("compression_limit", Dimension::Ratio)?,
        bending_limit: needed("bending_limit", Dimension::Ratio)?,
        diameters_m: diameters.iter().map(|item| diameter(item.get_ref())).collect::<Result<_, _>>()?,
        diameter_tolerances_m: tolerances.iter().map(|item| read_tolerance(item.get_ref())).collect::<Result<_, _>>()?,
        grades: grades
            .iter()
            .map(|item| read_grade(item.get_ref().as_table().ok_or("`grade` is not a list of tables")?))
            .collect::<Result<_, _>>()?,
    })
}

fn read_tolerance(item: &DeValue) -> Result<[f64; 2], String> {
    let pair = item.as_array().ok_or("a tolerance is not a list")?;
    let length = |item: &DeValue| si(item.as_str().ok_or("a tolerance is not text")?, Dimension::Length);
    match (pair.len(), pair.first(), pair.get(1)) {
        (2, Some(up_to), Some(tolerance)) => Ok([length(up_to.get_ref())?, length(tolerance.get_ref())?]),
        _ => Err("a tolerance is not a pair".to_owned()),
    }
}

fn read_grade(table: &DeTable) -> Result<Grade, String> {
    known_keys(table, &["name", "use", "at_1_mm", "per_decade"])?;
    Ok(Grade {
        name: text(table, "name")?.to_owned(),
        purpose: text(table, "use")?.to_owned(),
        at_1_mm_pa: property(table, "at_1_mm", Dimension::Stress)?.ok_or("no `at_1_mm`")?,
        per_decade_pa: si(text(table, "per_decade")?, Dimension::Stress)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const REFERENCES: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../REFERENCES.bib"));

    /// Least strengths (N/mm²) as wire makers print them from the table of EN 10270-1.
    #[test]
    fn strengths_are_those_of_the_table() {
        let medium = [
            (0.3, 2370.0),
            (0.5, 2200.0),
            (0.8, 2050.0),
            (1.0, 1980.0),
            (1.4, 1870.0),
            (2.0, 1760.0),
            (2.5, 1690.0),
            (3.2, 1610.0),
            (4.0, 1530.0),
            (5.0, 1460.0),
            (7.0, 1350.0),
            (10.0, 1240.0),
            (20.0, 1020.0),
        ];
        let high = [(0.3, 2660.0), (0.35, 2600.0), (0.4, 2560.0), (0.45, 2510.0)];
        let check = |name: &str, table: &[(f64, f64)], below: f64, above: f64| {
            for (diameter_mm, strength_mpa) in table {
                let ours = grade(name).unwrap().tensile_strength_pa(1e-3 * diameter_mm).unwrap();
                let ratio = ours / (1e6 * strength_mpa);
                assert!(1.0 - below <= ratio && ratio <= 1.0 + above, "{name} {diameter_mm}: {ratio}");
            }
        };
        check("SM", &medium, 0.0035, 0.0035);
        check("dm", &medium, 0.0035, 0.0035);
        check("SH", &high, 0.006, 0.0);
        check("DH", &high, 0.006, 0.0);
        assert_eq!(grade("SL"), None);
        let sm = grade("SM").unwrap();
        assert_eq!((sm.tensile_strength_pa(0.29e-3), sm.tensile_strength_pa(21e-3), sm.tensile_strength_pa(f64::NAN)), (None, None, None));
    }

    #[test]
    fn the_data_are_complete_and_their_sources_known() {
        let wire = wire();
        assert!(wire.diameters_m.windows(2).all(|pair| pair[0] < pair[1]) && wire.diameters_m.len() > 30);
        // An isotropic solid: E/G = 2(1 + ν) with ν between 0.25 and 0.3.
        assert!(wire.diameter_tolerances_m.windows(2).all(|pair| pair[0][0] < pair[1][0] && pair[0][1] < pair[1][1]));
        let ratio = wire.young_modulus_pa.value / wire.shear_modulus_pa.value;
        assert!((2.5..2.6).contains(&ratio), "{ratio}");
        let limits = [&wire.extension_limit, &wire.compression_limit];
        assert!(limits.iter().all(|limit| (0.4..0.6).contains(&limit.value)));
        let properties = [&wire.shear_modulus_pa, &wire.young_modulus_pa, &wire.density_kg_per_m3]
            .into_iter()
            .chain(limits)
            .chain([&wire.bending_limit]);
        for property in properties.chain(wire.grades.iter().map(|grade| &grade.at_1_mm_pa)) {
            for key in property.source_keys() {
                assert!(REFERENCES.contains(&format!("{{{key},")), "`{key}` is not in REFERENCES.bib");
            }
        }
    }

    #[test]
    fn faults_are_named() {
        for (old, new, expected) in [
            ("per_decade = \"740 MPa\"", "", "no `per_decade`"),
            ("\"0.3 mm\"", "\"0.3 MPa\"", "`0.3 MPa`"),
            ("density = ", "densty = ", "unknown key `densty`"),
            ("[wire]", "[wires]", "unknown key `wires`"),
        ] {
            let message = read(&DATA.replacen(old, new, 1)).unwrap_err();
            assert!(message.contains(expected), "{message}");
        }
    }
}
