//! Reads the data file of cables.

use forcewright_base::units::Dimension;
use toml::de::{DeTable, DeValue};

use super::{Bent, Catalogue, Construction, Size};
use crate::materials::file::{known_keys, optional_text, property, si, strings, text};

/// Keys of an entry.
const KEYS: &[&str] = &[
    "name",
    "aliases",
    "wires",
    "wires_across",
    "stiffness_over_square",
    "strength_over_square",
    "mass_over_square",
    "least_ratio",
    "desired_ratio",
    "note",
    "sizes",
];

/// Reads the data; the message says which entry and key is at fault.
pub(super) fn read(data: &str) -> Result<Catalogue, String> {
    let table = DeTable::parse(data).map_err(|error| error.to_string())?;
    known_keys(table.get_ref(), &["construction", "bent"])?;
    let entries = list(table.get_ref(), "construction")?;
    let bent_table = table.get_ref().get("bent").and_then(|item| item.get_ref().as_table()).ok_or("no [bent]")?;
    Ok(Catalogue {
        constructions: entries
            .iter()
            .map(|entry| construction(entry.get_ref().as_table().ok_or("`construction` is not a list of tables")?))
            .collect::<Result<_, _>>()?,
        bent: bent(bent_table).map_err(|error| format!("bent: {error}"))?,
    })
}

fn construction(table: &DeTable) -> Result<Construction, String> {
    let name = text(table, "name")?.to_owned();
    let read = || -> Result<Construction, String> {
        known_keys(table, KEYS)?;
        let sizes = if table.contains_key("sizes") { list(table, "sizes")? } else { &[] };
        Ok(Construction {
            aliases: strings(table, "aliases")?,
            wires: optional_number(table, "wires")?,
            wires_across: optional_number(table, "wires_across")?,
            stiffness_over_square_pa: property(table, "stiffness_over_square", Dimension::Stress)?,
            strength_over_square_pa: property(table, "strength_over_square", Dimension::Stress)?,
            mass_over_square_kg_per_m3: property(table, "mass_over_square", Dimension::Density)?,
            least_ratio: property(table, "least_ratio", Dimension::Ratio)?,
            desired_ratio: property(table, "desired_ratio", Dimension::Ratio)?,
            note: optional_text(table, "note")?.map(str::to_owned),
            sizes: sizes
                .iter()
                .map(|item| size(item.get_ref().as_table().ok_or("`sizes` is not a list of tables")?))
                .collect::<Result<_, _>>()?,
            name: name.clone(),
        })
    };
    read().map_err(|error| format!("{name}: {error}"))
}

fn size(table: &DeTable) -> Result<Size, String> {
    known_keys(table, &["diameter", "breaking_force", "mass_of_1_m"])?;
    Ok(Size {
        diameter_m: si(text(table, "diameter")?, Dimension::Length)?,
        breaking_force_n: property(table, "breaking_force", Dimension::Force)?.ok_or("no `breaking_force`")?,
        mass_kg_per_m: property(table, "mass_of_1_m", Dimension::Mass)?,
    })
}

fn bent(table: &DeTable) -> Result<Bent, String> {
    known_keys(table, &["source", "strength_left"])?;
    let pair = |item: &DeValue| -> Result<[f64; 2], String> {
        match item.as_array().map(|pair| pair.iter().map(|number| number_of(number.get_ref())).collect::<Option<Vec<_>>>()) {
            Some(Some(pair)) if pair.len() == 2 => Ok([pair[0], pair[1]]),
            _ => Err("`strength_left` is not a list of pairs".to_owned()),
        }
    };
    let strength_left: Vec<[f64; 2]> = list(table, "strength_left")?.iter().map(|item| pair(item.get_ref())).collect::<Result<_, _>>()?;
    if !strength_left.windows(2).all(|pair| pair[0][0] < pair[1][0]) {
        return Err("ratios are not ascending".to_owned());
    }
    Ok(Bent { strength_left, source: text(table, "source")?.to_owned() })
}

fn list<'a, 'i>(table: &'a DeTable<'i>, key: &str) -> Result<&'a [toml::Spanned<DeValue<'i>>], String> {
    let value = table.get(key).ok_or_else(|| format!("no `{key}`"))?;
    value.get_ref().as_array().map(|list| &list[..]).ok_or_else(|| format!("`{key}` is not a list"))
}

fn optional_number(table: &DeTable, key: &str) -> Result<Option<f64>, String> {
    let Some(value) = table.get(key) else { return Ok(None) };
    number_of(value.get_ref()).map(Some).ok_or_else(|| format!("`{key}` is not a number"))
}

fn number_of(value: &DeValue) -> Option<f64> {
    let written = match value {
        DeValue::Integer(integer) => integer.as_str(),
        DeValue::Float(float) => float.as_str(),
        _ => return None,
    };
    written.parse().ok()
}
