//! Settings of the command line, and the way to an extended file, written into a project file.

use toml_edit::{Array, DocumentMut, Item, Table, TableLike, Value};

use super::{EditError, member, put};
use crate::data::names_a_file;
use crate::tree::opposite;

/// The text with settings `KEY=VALUE` of the command line written into it, so that it stands without them. A `variant` that says
/// otherwise is changed as well.
///
/// # Errors
/// [`EditError`] names what is in the way.
pub fn with_settings(text: &str, settings: &[String], variant: Option<&str>) -> Result<String, EditError> {
    let mut document: DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| EditError::NotToml(e.message().to_owned()))?;
    for (key, value) in settings.iter().filter_map(|setting| setting.split_once('=')) {
        let value = value.trim();
        // A word that is no value of the language is a text, as it is where settings are read.
        let value = value.parse::<Value>().ok().filter(|v| !v.is_datetime()).unwrap_or_else(|| Value::from(value));
        lay(&mut document, &key.split('.').map(str::trim).collect::<Vec<_>>(), value, variant)?;
    }
    Ok(document.to_string())
}

/// The text with a text in quotes at a path of keys, none of which is a place in a list; tables that are missing are written.
///
/// # Errors
/// [`EditError`] names what is in the way.
pub fn with_text_at(text: &str, keys: &[&str], value: &str) -> Result<String, EditError> {
    let mut document: DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| EditError::NotToml(e.message().to_owned()))?;
    let in_the_way = || EditError::InTheWay(keys.join("."));
    let (last, tables) = keys.split_last().ok_or_else(in_the_way)?;
    let mut table: &mut dyn TableLike = document.as_table_mut();
    for key in tables {
        if !table.contains_key(key) {
            let mut new = Table::new();
            new.set_implicit(true);
            table.insert(key, Item::Table(new));
        }
        table = table.get_mut(key).and_then(Item::as_table_like_mut).ok_or_else(in_the_way)?;
    }
    match table.get_mut(last) {
        Some(old) => put(old.as_value_mut().ok_or_else(in_the_way)?, Value::from(value)),
        None => drop(table.insert(last, Item::Value(Value::from(value)))),
    }
    Ok(document.to_string())
}

/// Sets a value; of a table each entry, so that its other entries stay. A key of a table may have dots of its own.
fn lay(document: &mut DocumentMut, parts: &[&str], value: Value, variant: Option<&str>) -> Result<(), EditError> {
    match value {
        Value::InlineTable(table) => {
            table.into_iter().try_for_each(|(key, value)| lay(document, &[parts, &[key.as_str()]].concat(), value, variant))
        }
        mut value => {
            // Spaces of the table that it was typed in.
            value.decor_mut().clear();
            let new = New { path: &parts.join("."), value, list: None };
            set(document.as_table_mut(), parts, &new, true)?;
            let own = variant.and_then(|name| document.get_mut("variants")?.as_table_like_mut()?.get_mut(name)?.as_table_like_mut());
            own.map_or(Ok(()), |own| set(own, parts, &new, false))
        }
    }
}

/// The text for another folder: relative paths in `extends` and of files of data, in variants too, are led there through `way`, the path
/// from the new folder to the old one.
///
/// # Errors
/// [`EditError`] if the text is not TOML.
pub fn with_base_from(text: &str, way: &str) -> Result<String, EditError> {
    let mut document: DocumentMut = text.parse().map_err(|e: toml_edit::TomlError| EditError::NotToml(e.message().to_owned()))?;
    if let Some(base) = document.get_mut("extends").and_then(Item::as_value_mut) {
        lead(base, way);
    }
    lead_files(document.as_table_mut(), way);
    Ok(document.to_string())
}

fn lead(value: &mut Value, way: &str) {
    if let Some(path) = value.as_str().filter(|path| !std::path::Path::new(path).is_absolute()) {
        let led = Value::from(format!("{way}/{path}"));
        put(value, led);
    }
}

/// Leads the paths of all keys that name a file.
fn lead_files(table: &mut dyn TableLike, way: &str) {
    for (key, item) in table.iter_mut() {
        match item {
            Item::Value(value) if names_a_file(key.get()) => lead(value, way),
            Item::ArrayOfTables(list) => list.iter_mut().for_each(|table| lead_files(table, way)),
            Item::Value(Value::Array(list)) => {
                list.iter_mut().filter_map(Value::as_inline_table_mut).for_each(|table| lead_files(table, way));
            }
            other => {
                if let Some(inner) = other.as_table_like_mut() {
                    lead_files(inner, way);
                }
            }
        }
    }
}

/// What is written: a value, and the list to write where the one that it stands in is not there yet.
struct New<'a> {
    path: &'a str,
    value: Value,
    list: Option<Array>,
}

/// Sets a value below a table; where `create` is not set, only if its key is there.
fn set(table: &mut dyn TableLike, parts: &[&str], new: &New, create: bool) -> Result<(), EditError> {
    let in_the_way = || EditError::InTheWay(new.path.to_owned());
    let [key, rest @ ..] = parts else { return Err(in_the_way()) };
    // A list is never a coordinate: `envelope.x = [low, high]` is a key of a table.
    let inside = place_in_list(rest).is_some() && !new.value.is_array();
    // Where neither a list nor one to write is there, `x` and `y` are keys of a table, which a point of an extended file understands too.
    let lists =
        table.get(key).map_or(new.list.is_some() || !matches!(rest, ["x" | "y"]), |item| item.is_value() && !item.is_inline_table());
    if rest.is_empty() || (inside && lists) {
        if !create && !table.contains_key(key) {
            return Ok(());
        }
        if let Some(turned) = opposite(key).filter(|turned| new.value.is_str() && table.get(turned).is_some_and(Item::is_str)) {
            table.remove(turned);
        }
        return replace(table, key, place_in_list(rest), new).ok_or_else(in_the_way);
    }
    if !table.contains_key(key) {
        if !create {
            return Ok(());
        }
        let mut new = Table::new();
        new.set_implicit(true);
        table.insert(key, Item::Table(new));
    }
    let Some(item) = table.get_mut(key) else { return Err(in_the_way()) };
    if let Some(list) = item.as_array_of_tables_mut() {
        let [name, inner @ ..] = rest else { return Err(in_the_way()) };
        return match member(list, name, create) {
            Some(table) => set(table, inner, new, create),
            None => Ok(()),
        };
    }
    let Some(inner) = item.as_table_like_mut() else { return Err(in_the_way()) };
    set(inner, rest, new, create)
}

/// What the rest of a path means inside a point or a list, from 0.
fn place_in_list(rest: &[&str]) -> Option<usize> {
    match rest {
        ["x"] => Some(0),
        ["y"] => Some(1),
        [index] => index.parse::<usize>().ok().and_then(|i| i.checked_sub(1)),
        _ => None,
    }
}

/// Replaces a value, or one member of a list, and keeps the white space and the comment around it.
fn replace(table: &mut dyn TableLike, key: &str, place: Option<usize>, new: &New) -> Option<()> {
    let whole = || if place.is_some() { new.list.clone().map(Value::Array) } else { Some(new.value.clone()) };
    let Some(item) = table.get_mut(key) else {
        table.insert(key, Item::Value(whole()?));
        return Some(());
    };
    let old = item.as_value_mut()?;
    let fits = |list: &Array| new.list.as_ref().is_none_or(|all| all.len() == list.len());
    match (place, old.as_array_mut().filter(|list| fits(list))) {
        (Some(place), Some(list)) => put(list.get_mut(place)?, new.value.clone()),
        _ => put(old, whole()?),
    }
    Some(())
}
