//! Reads the catalogue's data file.

use super::{Class, CreepModulus, Fatigue, Material, Property, ValueKind};
use forcewright_base::units::{Dimension, Quantity};
use toml::de::{DeTable, DeValue};

/// Keys of an entry.
const KEYS: &[&str] = &[
    "name",
    "aliases",
    "class",
    "young_modulus",
    "poisson_ratio",
    "density",
    "yield_stress",
    "tensile_strength",
    "fatigue",
    "creep_modulus",
    "note",
];

/// Reads a catalogue; the message says which entry and key is at fault.
pub(crate) fn read(text: &str) -> Result<Vec<Material>, String> {
    let table = DeTable::parse(text).map_err(|error| error.to_string())?;
    let entries = table.get_ref().get("material").and_then(|list| list.get_ref().as_array()).ok_or("no [[material]]")?;
    if table.get_ref().len() != 1 {
        return Err("only [[material]] is known".to_owned());
    }
    entries.iter().map(|entry| material(entry.get_ref().as_table().ok_or("`material` is not a list of tables")?)).collect()
}

fn material(table: &DeTable) -> Result<Material, String> {
    let name = text(table, "name")?.to_owned();
    let named = |error: String| format!("{name}: {error}");
    known_keys(table, KEYS).map_err(named)?;
    let class = text(table, "class").map_err(named)?;
    let mut material = Material {
        aliases: strings(table, "aliases").map_err(named)?,
        class: Class::ALL.into_iter().find(|c| c.name() == class).ok_or_else(|| named(format!("class `{class}`")))?,
        young_modulus_pa: property(table, "young_modulus", Dimension::Stress).map_err(named)?,
        poisson_ratio: property(table, "poisson_ratio", Dimension::Ratio).map_err(named)?,
        density_kg_per_m3: property(table, "density", Dimension::Density).map_err(named)?,
        yield_stress_pa: property(table, "yield_stress", Dimension::Stress).map_err(named)?,
        tensile_strength_pa: property(table, "tensile_strength", Dimension::Stress).map_err(named)?,
        fatigue: fatigue(table).map_err(named)?,
        creep_modulus: creep_modulus(table).map_err(named)?,
        note: optional_text(table, "note").map_err(named)?.map(str::to_owned),
        sources: Vec::new(),
        name,
    };
    let cited: Vec<String> = material
        .properties()
        .flat_map(Property::source_keys)
        .chain(material.fatigue.iter().flat_map(Fatigue::source_keys))
        .chain(material.creep_modulus.iter().flat_map(CreepModulus::source_keys))
        .map(str::to_owned)
        .collect();
    for source in cited {
        if !material.sources.contains(&source) {
            material.sources.push(source);
        }
    }
    Ok(material)
}

pub(crate) fn property(table: &DeTable, key: &str, dimension: Dimension) -> Result<Option<Property>, String> {
    let Some(inner) = inner_table(table, key, &["value", "kind", "source"])? else { return Ok(None) };
    let read = || -> Result<Property, String> {
        Ok(Property { value: si(text(inner, "value")?, dimension)?, kind: kind(inner)?, source: text(inner, "source")?.to_owned() })
    };
    read().map(Some).map_err(|error| format!("{key}: {error}"))
}

fn fatigue(table: &DeTable) -> Result<Option<Fatigue>, String> {
    let Some(inner) = inner_table(table, "fatigue", &["amplitude", "cycles", "ratio", "kind", "source"])? else { return Ok(None) };
    let read = || -> Result<Fatigue, String> {
        Ok(Fatigue {
            amplitude_pa: si(text(inner, "amplitude")?, Dimension::Stress)?,
            cycles: si(text(inner, "cycles")?, Dimension::Ratio)?,
            stress_ratio: optional_text(inner, "ratio")?.map(|ratio| si(ratio, Dimension::Ratio)).transpose()?,
            kind: kind(inner)?,
            source: text(inner, "source")?.to_owned(),
        })
    };
    read().map(Some).map_err(|error| format!("fatigue: {error}"))
}

fn creep_modulus(table: &DeTable) -> Result<Option<CreepModulus>, String> {
    let Some(inner) = inner_table(table, "creep_modulus", &["values", "kind", "source"])? else { return Ok(None) };
    let value = |item: &DeValue| -> Result<[f64; 2], String> {
        let table = item.as_table().ok_or("`values` is not a list of tables")?;
        known_keys(table, &["time", "value"])?;
        Ok([si(text(table, "time")?, Dimension::Time)?, si(text(table, "value")?, Dimension::Stress)?])
    };
    let read = || -> Result<CreepModulus, String> {
        let list = inner.get("values").and_then(|list| list.get_ref().as_array()).ok_or("no list `values`")?;
        let values: Vec<[f64; 2]> = list.iter().map(|item| value(item.get_ref())).collect::<Result<_, _>>()?;
        let ascending = values.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        if !ascending || !values.first().is_some_and(|[time_s, _]| *time_s > 0.0) {
            return Err("times are not ascending from above 0".to_owned());
        }
        Ok(CreepModulus { values, kind: kind(inner)?, source: text(inner, "source")?.to_owned() })
    };
    read().map(Some).map_err(|error| format!("creep_modulus: {error}"))
}

fn kind(table: &DeTable) -> Result<ValueKind, String> {
    let name = text(table, "kind")?;
    ValueKind::ALL.into_iter().find(|k| k.name() == name).ok_or_else(|| format!("kind `{name}`"))
}

pub(crate) fn si(quantity: &str, dimension: Dimension) -> Result<f64, String> {
    Quantity::parse(quantity, dimension).map(|q| q.si).map_err(|error| format!("`{quantity}`: {error:?}"))
}

fn inner_table<'a, 'i>(table: &'a DeTable<'i>, key: &str, known: &[&str]) -> Result<Option<&'a DeTable<'i>>, String> {
    let Some(value) = table.get(key) else { return Ok(None) };
    let inner = value.get_ref().as_table().ok_or_else(|| format!("`{key}` is not a table"))?;
    known_keys(inner, known).map_err(|error| format!("{key}: {error}"))?;
    Ok(Some(inner))
}

pub(crate) fn known_keys(table: &DeTable, known: &[&str]) -> Result<(), String> {
    let unknown = table.keys().map(toml::Spanned::get_ref).find(|key| !known.contains(&key.as_ref()));
    unknown.map_or(Ok(()), |key| Err(format!("unknown key `{key}`")))
}

pub(crate) fn text<'a>(table: &'a DeTable, key: &str) -> Result<&'a str, String> {
    optional_text(table, key)?.ok_or_else(|| format!("no `{key}`"))
}

pub(crate) fn optional_text<'a>(table: &'a DeTable, key: &str) -> Result<Option<&'a str>, String> {
    let Some(value) = table.get(key) else { return Ok(None) };
    value.get_ref().as_str().map(Some).ok_or_else(|| format!("`{key}` is not text"))
}

pub(crate) fn strings(table: &DeTable, key: &str) -> Result<Vec<String>, String> {
    let Some(value) = table.get(key) else { return Ok(Vec::new()) };
    let not_texts = || format!("`{key}` is not a list of texts");
    let list = value.get_ref().as_array().ok_or_else(not_texts)?;
    list.iter().map(|item| DeValue::as_str(item.get_ref()).map(str::to_owned).ok_or_else(not_texts)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEAST: &str = "[[material]]\nname = \"X\"\nclass = \"steel\"\n";

    #[test]
    fn a_missing_property_is_absent() {
        let read = read(LEAST).unwrap();
        assert_eq!(read.len(), 1);
        assert_eq!(read[0].young_modulus_pa, None);
        assert_eq!(read[0].shear_modulus_pa(), None);
        assert_eq!(read[0].yield_strain(), None);
        assert!(read[0].sources.is_empty());
    }

    #[test]
    fn units_become_si_and_sources_are_collected_once() {
        let text = format!(
            "{LEAST}young_modulus = {{ value = \"2 GPa\", kind = \"measured\", source = \"a, b\" }}\n\
             density = {{ value = \"1.4 g/cm^3\", kind = \"typical\", source = \"b\" }}\n"
        );
        let x = &read(&text).unwrap()[0];
        let young = Property { value: 2e9, kind: ValueKind::Measured, source: "a, b".to_owned() };
        assert_eq!(x.young_modulus_pa, Some(young));
        let density = x.density_kg_per_m3.as_ref().unwrap().value;
        assert!((density - 1400.0).abs() < 1e-9, "{density}");
        assert_eq!(x.sources, ["a", "b"]);
    }

    #[test]
    fn faults_are_named() {
        for (line, expected) in [
            ("young_modulus = { value = \"2 mm\", kind = \"typical\", source = \"a\" }", "young_modulus: `2 mm`"),
            ("young_modulus = { value = \"2 GPa\", kind = \"guess\", source = \"a\" }", "kind `guess`"),
            ("young_modulus = { value = \"2 GPa\", kind = \"typical\" }", "no `source`"),
            ("youngs_modulus = \"2 GPa\"", "unknown key `youngs_modulus`"),
            ("creep_modulus = { values = [], kind = \"typical\", source = \"a\" }", "creep_modulus: times are not ascending"),
            (
                "creep_modulus = { values = [{ time = \"2 h\", value = \"2 GPa\" }, { time = \"2 h\", value = \"1 GPa\" }] }",
                "not ascending",
            ),
            ("creep_modulus = { values = [{ time = \"2 mm\", value = \"2 GPa\" }] }", "creep_modulus: `2 mm`"),
            ("aliases = \"Y\"", "`aliases` is not a list of texts"),
        ] {
            let message = read(&format!("{LEAST}{line}\n")).unwrap_err();
            assert!(message.starts_with("X: ") && message.contains(expected), "{message}");
        }
        assert!(read("").is_err());
    }
}
