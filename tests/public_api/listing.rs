//! The list of the promised surface, from rustdoc's JSON.

use crate::signature::{arguments, bounds, function, generics, where_clause, written};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The crates whose types promised signatures may have.
const SHARED: [&str; 5] = ["core", "alloc", "std", "glam", "ratatui_core"];

/// The promised surface.
pub(crate) struct Listing {
    /// One line each, sorted by path.
    pub(crate) text: String,
    /// The number of items and methods.
    pub(crate) count: usize,
    /// Types in signatures that are neither promised nor from a re-exported crate.
    pub(crate) unpromised: Vec<String>,
}

/// Lists the promised surface.
pub(crate) fn listing(json: &Value) -> Listing {
    let mut surface = Surface { json, paths: BTreeMap::new(), lines: BTreeSet::new(), count: 0 };
    surface.walk(&json["root"], "");
    let promised: Vec<_> = surface.paths.clone().into_iter().collect();
    for (id, path) in &promised {
        surface.list(id, path);
    }
    let text = surface.lines.iter().flat_map(|(_, line)| [line, "\n"]).collect();
    Listing { text, count: surface.count, unpromised: surface.unpromised(&promised) }
}

struct Surface<'a> {
    json: &'a Value,
    /// The shortest path of each promised item.
    paths: BTreeMap<String, String>,
    /// Path and line.
    lines: BTreeSet<(String, String)>,
    count: usize,
}

/// The kind of an item and its contents.
fn inner(item: &Value) -> (&str, &Value) {
    let inner = item["inner"].as_object().and_then(|inner| inner.iter().next()).expect("an item has a kind");
    (inner.0, inner.1)
}

fn name(item: &Value) -> &str {
    item["name"].as_str().unwrap_or_default()
}

fn ids(list: &Value) -> impl Iterator<Item = &Value> {
    list.as_array().into_iter().flatten()
}

impl<'a> Surface<'a> {
    /// The item of that number, if it is promised or part of something that is.
    fn item(&self, id: &Value) -> Option<&'a Value> {
        self.json["index"].get(id.to_string())
    }

    fn add(&mut self, path: &str, line: String) {
        self.lines.insert((path.to_owned(), line));
    }

    /// Lists the items of a module.
    ///
    /// Its own level goes first, so that an item has its shortest path.
    fn walk(&mut self, module: &Value, path: &str) {
        let Some(module) = self.item(module) else { return };
        let mut modules = Vec::new();
        for id in ids(&module["inner"]["module"]["items"]) {
            let Some(item) = self.item(id) else { continue };
            match inner(item) {
                ("module", _) => modules.push((id, name(item).to_owned())),
                ("use", import) => self.take_import(import, path),
                _ => self.take(id, path, name(item)),
            }
        }
        for (module, name) in modules {
            let path = format!("{path}{name}::");
            self.add(&path, format!("mod {}", path.trim_end_matches("::")));
            self.walk(module, &path);
        }
    }

    fn take_import(&mut self, import: &Value, path: &str) {
        let name = import["name"].as_str().unwrap_or_default();
        let path_of_name = format!("{path}{name}");
        match self.item(&import["id"]) {
            Some(_) => self.take(&import["id"], path, name),
            None => {
                self.add(&path_of_name, format!("use {} as {path_of_name}", import["source"].as_str().unwrap_or("?")));
            }
        }
    }

    fn take(&mut self, id: &Value, path: &str, name: &str) {
        let path = format!("{path}{name}");
        match self.paths.get(&id.to_string()) {
            Some(first) => self.add(&path.clone(), format!("use {first} as {path}")),
            None => drop(self.paths.insert(id.to_string(), path)),
        }
    }

    /// Lists an item with all its parts.
    fn list(&mut self, id: &str, path: &str) {
        let item = &self.json["index"][id];
        let (kind, body) = inner(item);
        self.count += 1;
        let mark =
            if ids(&item["attrs"]).any(|attribute| attribute == "non_exhaustive") { "#[non_exhaustive] " } else { "" };
        let (parameters, conditions) = (generics(&body["generics"]), where_clause(&body["generics"]));
        let line = match kind {
            "function" => function(path, body),
            "constant" => format!("const {path}: {}", written(&body["type"])),
            "type_alias" => format!("type {path}{parameters} = {}{conditions}", written(&body["type"])),
            "trait" => format!("trait {path}{parameters}{}{conditions}", bounds(&body["bounds"], ": ")),
            kind => format!("{mark}{kind} {path}{parameters}{conditions}"),
        };
        self.add(path, line);
        self.list_fields(path, "field", body["kind"].get("plain").map_or(&body["kind"], |plain| &plain["fields"]));
        ids(&body["variants"]).for_each(|variant| self.list_variant(path, variant));
        if kind == "trait" {
            ids(&body["items"]).for_each(|member| self.list_member(path, member, true));
        }
        ids(&body["impls"]).for_each(|of| self.list_implementation(id, path, of));
    }

    /// Lists the fields that are public: named ones, or those of a tuple.
    fn list_fields(&mut self, path: &str, kind: &str, fields: &Value) {
        let fields = fields.get("tuple").unwrap_or(fields);
        for id in ids(fields) {
            let Some(field) = self.item(id) else { continue };
            let path = format!("{path}.{}", name(field));
            self.add(&path, format!("{kind} {path}: {}", written(&field["inner"]["struct_field"])));
        }
    }

    fn list_variant(&mut self, path: &str, id: &Value) {
        let Some(variant) = self.item(id) else { return };
        let path = format!("{path}::{}", name(variant));
        let kind = &variant["inner"]["variant"]["kind"];
        let payload: Vec<_> = ids(&kind["tuple"]).map(|field| self.item(field)).collect();
        let types =
            payload.iter().map(|field| field.map_or("_".into(), |field| written(&field["inner"]["struct_field"])));
        let types = types.collect::<Vec<_>>().join(", ");
        self.add(&path, if types.is_empty() { format!("variant {path}") } else { format!("variant {path}({types})") });
        self.list_fields(&path, "field", &kind["struct"]["fields"]);
    }

    /// Lists a method or a constant of a type or a trait.
    fn list_member(&mut self, owner: &str, id: &Value, of_trait: bool) {
        let Some(member) = self.item(id) else { return };
        if !of_trait && member["visibility"] != "public" {
            return;
        }
        self.count += 1;
        let path = format!("{owner}::{}", name(member));
        let line = match inner(member) {
            ("function", body) => function(&path, body),
            ("assoc_const", body) => format!("const {path}: {}", written(&body["type"])),
            (_, body) => format!("type {path}{}", bounds(&body["bounds"], ": ")),
        };
        self.add(&path, line);
    }

    /// Lists the methods of a type, or that it implements a trait of this surface or of another
    /// crate.
    fn list_implementation(&mut self, owner: &str, path: &str, id: &Value) {
        let Some(implementation) = self.item(id) else { return };
        let body = &implementation["inner"]["impl"];
        if body["trait"].is_null() {
            return ids(&body["items"]).for_each(|member| self.list_member(path, member, false));
        }
        let (is_auto, is_negative) = (body["is_synthetic"] == true, body["is_negative"] == true);
        let trait_name = body["trait"]["path"].as_str().unwrap_or_default();
        let trait_name = trait_name.rsplit("::").next().unwrap_or(trait_name);
        let is_of_interest = if is_auto { is_negative && ["Send", "Sync"].contains(&trait_name) } else { true };
        let is_inside = |id: &Value| self.is_of_crate(id) && !self.paths.contains_key(&id.to_string());
        if !body["blanket_impl"].is_null()
            || !is_of_interest
            || trait_name == "StructuralPartialEq"
            || is_inside(&body["trait"]["id"])
            || type_ids(&body["trait"]).iter().any(is_inside)
        {
            return;
        }
        let not = if is_negative { "!" } else { "" };
        // A trait of another type that has this one among its arguments stands with that type, if it is of this crate.
        let of = &body["for"];
        let is_own = of["resolved_path"]["id"].as_u64().is_some_and(|of| of.to_string() == owner);
        if !is_own && type_ids(of).iter().any(|id| self.is_of_crate(id)) {
            return;
        }
        let of = if is_own { path.to_owned() } else { written(of) };
        let line = format!("impl {not}{trait_name}{} for {of}", arguments(&body["trait"]["args"]));
        self.add(&format!("{path} "), line);
    }

    /// Returns whether a type or trait is this crate's.
    fn is_of_crate(&self, id: &Value) -> bool {
        self.json["paths"].get(id.to_string()).is_some_and(|summary| summary["crate_id"] == 0)
    }

    /// The types in what is listed that a user cannot name by this crate.
    fn unpromised(&self, promised: &[(String, String)]) -> Vec<String> {
        let mut found = BTreeSet::new();
        for (id, path) in promised {
            for of in self.parts(&self.json["index"][id]) {
                for id in type_ids(of) {
                    let Some(summary) = self.json["paths"].get(id.to_string()) else { continue };
                    let is_promised = self.paths.contains_key(&id.to_string());
                    let of_crate = self.json["external_crates"][summary["crate_id"].to_string()]["name"].as_str();
                    if !is_promised && !of_crate.is_some_and(|name| SHARED.contains(&name)) {
                        let names: Vec<_> = ids(&summary["path"]).filter_map(Value::as_str).collect();
                        found.insert(format!("{path} ({}): {}", name(of), names.join("::")));
                    }
                }
            }
        }
        found.into_iter().collect()
    }

    /// An item, its fields, variants and methods.
    fn parts(&self, item: &'a Value) -> Vec<&'a Value> {
        let (_, body) = inner(item);
        let own = |list: &'a Value| ids(list).filter_map(|id| self.item(id)).collect::<Vec<_>>();
        let mut parts = if body.get("sig").is_some() || body.get("type").is_some() { vec![item] } else { Vec::new() };
        let variants = own(&body["variants"]);
        let kinds = variants.iter().map(|variant| &variant["inner"]["variant"]["kind"]).chain([&body["kind"]]);
        for kind in kinds {
            let fields = [&kind["tuple"], &kind["struct"]["fields"], &kind["plain"]["fields"]];
            parts.extend(fields.into_iter().flat_map(own));
        }
        let inherent =
            own(&body["impls"]).into_iter().map(|of| &of["inner"]["impl"]).filter(|of| of["trait"].is_null());
        let methods = inherent.flat_map(|of| own(&of["items"])).chain(own(&body["items"]));
        parts.extend(methods.filter(|method| method["visibility"] != "crate"));
        parts
    }
}

/// The numbers of all types and traits that are named in a part of the JSON.
fn type_ids(part: &Value) -> Vec<Value> {
    let mut found = Vec::new();
    let mut left = vec![part];
    while let Some(value) = left.pop() {
        if let Some(fields) = value.as_object() {
            if let (Some(id), Some(_), Some(_)) = (fields.get("id"), fields.get("path"), fields.get("args")) {
                found.push(id.clone());
            }
            // The documentation links to types too.
            left.extend(fields.iter().filter(|(key, _)| *key != "links").map(|(_, value)| value));
        }
        left.extend(value.as_array().into_iter().flatten());
    }
    found
}
