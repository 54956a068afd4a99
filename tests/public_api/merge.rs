//! One JSON of rustdoc for two crates, the first of which re-exports items of the second.
//!
//! In the JSON of a crate, an item of another crate is only a number and a path. Here it becomes the number of the item
//! itself, from the JSON of that crate.

use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// The difference that keeps the second crate's numbers apart from the first one's.
const OFFSET: u64 = 1 << 32;

/// The keys whose numbers are those of items.
const ITEM_KEYS: [&str; 7] = ["id", "root", "items", "impls", "variants", "fields", "tuple"];

/// Returns the JSON of a crate together with the items of the crate `name`.
///
/// Re-exports of items that are hidden there are left out.
pub(crate) fn with_items_of(mut json: Value, mut of: Value, name: &str) -> Value {
    renumber(&mut of, &|id| id + OFFSET, &|krate| if krate == 0 { 0 } else { krate + OFFSET });
    let items = items_of_modules(&of);
    let found = |summary: &Value| {
        let path = summary["path"].as_array().and_then(|path| path.last());
        items.get(&(text(&summary["kind"]), path.map_or("", text))).copied()
    };
    let is_of = |summary: &Value| json["external_crates"][summary["crate_id"].to_string()]["name"] == *name;
    let ids: BTreeMap<u64, Option<u64>> = object(&json["paths"])
        .iter()
        .filter(|(_, summary)| is_of(summary))
        .map(|(id, summary)| (id.parse().expect("an item's number"), found(summary)))
        .collect();
    let is_hidden = |id: &Value| id.as_u64().is_some_and(|id| ids.get(&id) == Some(&None));
    let index = json["index"].as_object_mut().expect("a table");
    index.retain(|_, item| !is_hidden(&item["inner"]["use"]["id"]));
    renumber(&mut json, &|id| ids.get(&id).copied().flatten().unwrap_or(id), &|krate| krate);
    for part in ["index", "paths", "external_crates"] {
        let own = json[part].as_object_mut().expect("a table");
        // Of an item in both, the second crate has all.
        own.extend(object(&of[part]).clone());
    }
    json
}

/// Returns the numbers of the items in a crate's modules, by kind and name.
fn items_of_modules(json: &Value) -> BTreeMap<(&str, &str), u64> {
    let index = object(&json["index"]);
    let modules = index.values().filter_map(|item| item["inner"]["module"]["items"].as_array());
    let items = modules.flatten().filter_map(|id| {
        let item = index.get(&id.to_string())?;
        let id = item["inner"].get("use").map_or(id, |import| &import["id"]);
        let item = index.get(&id.to_string())?;
        let kind = object(&item["inner"]).keys().next()?;
        Some(((kind.as_str(), text(&item["name"])), id.as_u64()?))
    });
    items.collect()
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

fn object(value: &Value) -> &Map<String, Value> {
    value.as_object().expect("a table")
}

/// Changes all numbers of items and of crates.
fn renumber(json: &mut Value, item: &dyn Fn(u64) -> u64, krate: &dyn Fn(u64) -> u64) {
    for (part, change) in [("index", item), ("paths", item), ("external_crates", krate)] {
        let table = object(&json[part]).clone();
        let renumbered = |(id, value)| {
            let id: String = id;
            (change(id.parse().expect("a number")).to_string(), value)
        };
        json[part] = Value::Object(table.into_iter().map(renumbered).collect());
    }
    renumber_values(json, item, krate);
}

fn renumber_values(value: &mut Value, item: &dyn Fn(u64) -> u64, krate: &dyn Fn(u64) -> u64) {
    match value {
        Value::Object(fields) => {
            for (key, value) in fields.iter_mut() {
                if key == "crate_id" {
                    *value = json!(value.as_u64().map(krate));
                } else if ITEM_KEYS.contains(&&**key) {
                    renumber_ids(value, item);
                }
                renumber_values(value, item, krate);
            }
        }
        Value::Array(values) => values.iter_mut().for_each(|value| renumber_values(value, item, krate)),
        _ => {}
    }
}

/// Changes a number, or the numbers of an array.
fn renumber_ids(value: &mut Value, item: &dyn Fn(u64) -> u64) {
    match value {
        Value::Number(number) => *value = json!(number.as_u64().map(item)),
        Value::Array(values) => {
            values.iter_mut().filter(|value| value.is_number()).for_each(|value| renumber_ids(value, item));
        }
        _ => {}
    }
}
