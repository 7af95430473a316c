//! Reads the data file of belts and gears.

use forcewright_base::units::Dimension;
use toml::de::{DeTable, DeValue};

use super::{Belt, BeltSize, Data, GearSteel};
use crate::materials::Property;
use crate::materials::file::{known_keys, property, si, text};

/// Reads the data; the message says which entry and key is at fault.
pub(super) fn read(data: &str) -> Result<Data, String> {
    let table = DeTable::parse(data).map_err(|error| error.to_string())?;
    let table = table.get_ref();
    known_keys(table, &["belt", "gear"])?;
    let belts = tables(table, "belt")?.into_iter().map(belt).collect::<Result<_, _>>()?;
    let gear = table.get("gear").and_then(|item| item.get_ref().as_table()).ok_or("no [gear]")?;
    Ok(Data { belts, steel: steel(gear).map_err(|error| format!("gear: {error}"))? })
}

fn belt(table: &DeTable) -> Result<Belt, String> {
    known_keys(table, &["name", "pitch", "tooth_force", "teeth", "least_teeth", "sizes"])?;
    let size = |table: &DeTable| -> Result<BeltSize, String> {
        known_keys(table, &["width", "tension", "breaking", "stiffness"])?;
        Ok(BeltSize {
            width_m: si(text(table, "width")?, Dimension::Length)?,
            tension_n: si(text(table, "tension")?, Dimension::Force)?,
            breaking_n: si(text(table, "breaking")?, Dimension::Force)?,
            stiffness_n: si(text(table, "stiffness")?, Dimension::Force)?,
        })
    };
    Ok(Belt {
        name: text(table, "name")?.to_owned(),
        pitch_m: si(text(table, "pitch")?, Dimension::Length)?,
        tooth_n_per_m: needed(table, "tooth_force", Dimension::Stiffness)?,
        teeth: needed(table, "teeth", Dimension::Ratio)?,
        least_teeth: needed(table, "least_teeth", Dimension::Ratio)?,
        sizes: tables(table, "sizes")?.into_iter().map(size).collect::<Result<_, _>>()?,
    })
}

fn steel(table: &DeTable) -> Result<GearSteel, String> {
    known_keys(table, &["bending", "contact", "lewis", "lewis_source"])?;
    let pair = |item: &DeValue| -> Result<[f64; 2], String> {
        let list = item.as_array().ok_or("`lewis` is not a list of pairs")?;
        let numbers: Option<Vec<f64>> = list.iter().map(|number| number_of(number.get_ref())).collect();
        <[f64; 2]>::try_from(numbers.ok_or("`lewis` has something else than numbers")?)
            .map_err(|_| "`lewis` is not a list of pairs".to_owned())
    };
    let lewis = table.get("lewis").and_then(|list| list.get_ref().as_array()).ok_or("no list `lewis`")?;
    Ok(GearSteel {
        bending_pa: needed(table, "bending", Dimension::Stress)?,
        contact_pa: needed(table, "contact", Dimension::Stress)?,
        lewis_source: text(table, "lewis_source")?.to_owned(),
        lewis: lewis.iter().map(|item| pair(item.get_ref())).collect::<Result<_, _>>()?,
    })
}

fn needed(table: &DeTable, key: &str, dimension: Dimension) -> Result<Property, String> {
    property(table, key, dimension)?.ok_or_else(|| format!("no `{key}`"))
}

fn tables<'a, 'i>(table: &'a DeTable<'i>, key: &str) -> Result<Vec<&'a DeTable<'i>>, String> {
    let list = table.get(key).and_then(|list| list.get_ref().as_array()).ok_or_else(|| format!("no list `{key}`"))?;
    list.iter().map(|item| item.get_ref().as_table().ok_or_else(|| format!("`{key}` is not a list of tables"))).collect()
}

fn number_of(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Integer(integer) => integer.as_str().parse().ok(),
        DeValue::Float(float) => float.as_str().parse().ok(),
        _ => None,
    }
}
