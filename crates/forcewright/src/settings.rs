//! Values of a project by their paths, as settings of the command line have them.

use forcewright_contract::tree::{Item, Table, Value};

/// A value as it would stand behind `--set KEY=`, and what stands between its quotes.
pub(crate) fn typed(value: &Value) -> Option<String> {
    match value {
        Value::Text(text) if !text.contains(char::is_control) && !text.contains('"') => Some(text.clone()),
        Value::Number(number) if number.is_finite() => Some(number.to_string()),
        Value::Flag(flag) => Some(flag.to_string()),
        _ => None,
    }
}

/// Settings `KEY=VALUE` of a project with each place in a list turned into its whole list, as the project with them has it: lists of an
/// extended file are changed as a whole. `None` where nothing would differ.
pub(crate) fn whole_lists(settings: &[String], tree: &Table) -> Option<Vec<String>> {
    let whole = |setting: &String| {
        let (list, place) = setting.split_once('=')?.0.trim().rsplit_once('.')?;
        let place = matches!(place, "x" | "y") || place.parse::<usize>().is_ok();
        let value =
            value_at(tree, list).filter(|value| matches!(value, Value::List(items) if items.iter().all(|i| typed(&i.value).is_some())))?;
        place.then(|| format!("{list}={value}"))
    };
    let all: Vec<String> = settings.iter().map(|setting| whole(setting).unwrap_or_else(|| setting.clone())).collect();
    (all != settings).then_some(all)
}

/// The value at a path of the project, members of lists by their names or by their places from 1.
pub(crate) fn value_at<'t>(tree: &'t Table, path: &str) -> Option<&'t Value> {
    let mut parts = path.split('.').map(str::trim);
    let mut value = &tree.get(parts.next()?)?.item.value;
    for part in parts {
        value = match value {
            Value::Table(table) => &table.get(part)?.item.value,
            Value::List(items) => {
                let named = |item: &&Item| matches!(&item.value, Value::Table(t) if t.get("name").is_some_and(|n| matches!(&n.item.value, Value::Text(name) if name == part)));
                let place = match part {
                    "x" => Some(0),
                    "y" => Some(1),
                    part => part.parse::<usize>().ok().and_then(|n| n.checked_sub(1)),
                };
                &items.iter().find(named).or_else(|| items.get(place?))?.value
            }
            _ => return None,
        };
    }
    Some(value)
}
