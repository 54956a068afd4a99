//! Types and signatures in rustdoc's JSON -> Rust.

use serde_json::Value;

fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or("?")
}

fn joined(parts: impl Iterator<Item = String>, between: &str) -> String {
    parts.collect::<Vec<_>>().join(between)
}

/// The last name of a path: where a type is defined is no part of the list.
fn last(path: &Value) -> &str {
    text(path).rsplit("::").next().unwrap_or("?")
}

/// A type.
pub(crate) fn written(of: &Value) -> String {
    let Some((kind, body)) = of.as_object().and_then(|of| of.iter().next()) else {
        return text(of).to_owned();
    };
    match &**kind {
        "resolved_path" => format!("{}{}", last(&body["path"]), arguments(&body["args"])),
        "generic" | "primitive" => text(body).to_owned(),
        "tuple" => match body.as_array().map_or(0, Vec::len) {
            1 => format!("({},)", written(&body[0])),
            _ => format!("({})", joined(list(body).map(written), ", ")),
        },
        "slice" => format!("[{}]", written(body)),
        "array" => format!("[{}; {}]", written(&body["type"]), text(&body["len"])),
        "impl_trait" => format!("impl {}", joined(list(body).map(bound), " + ")),
        "dyn_trait" => dynamic(body),
        "borrowed_ref" => {
            let lifetime = body["lifetime"].as_str().map(|name| format!("{name} ")).unwrap_or_default();
            format!("&{lifetime}{}{}", mutable(body), written(&body["type"]))
        }
        "raw_pointer" => format!("*{}{}", mutable(body), written(&body["type"])),
        "qualified_path" => qualified(body),
        "function_pointer" => {
            let (inputs, output) = (&body["sig"]["inputs"], &body["sig"]["output"]);
            format!("fn({}){}", joined(list(inputs).map(|input| written(&input[1])), ", "), returned(output))
        }
        _ => format!("{kind} {body}"),
    }
}

fn mutable(body: &Value) -> &str {
    if body["is_mutable"] == true { "mut " } else { "" }
}

fn dynamic(body: &Value) -> String {
    let traits =
        list(&body["traits"]).map(|of| format!("{}{}", last(&of["trait"]["path"]), arguments(&of["trait"]["args"])));
    let lifetime = body["lifetime"].as_str().map(str::to_owned);
    format!("dyn {}", joined(traits.chain(lifetime), " + "))
}

fn qualified(body: &Value) -> String {
    let (owner, name) = (written(&body["self_type"]), text(&body["name"]));
    match last(&body["trait"]["path"]) {
        "" | "?" => format!("{owner}::{name}"),
        of_trait => format!("<{owner} as {of_trait}{}>::{name}", arguments(&body["trait"]["args"])),
    }
}

/// Formats the generic arguments of a path, in angle brackets or in a closure's parentheses.
pub(crate) fn arguments(of: &Value) -> String {
    if let Some(of) = of.get("parenthesized") {
        return format!("({}){}", joined(list(&of["inputs"]).map(written), ", "), returned(&of["output"]));
    }
    let Some(of) = of.get("angle_bracketed") else { return String::new() };
    let arguments = list(&of["args"]).map(|argument| match argument.as_object().and_then(|of| of.iter().next()) {
        Some((kind, body)) if kind == "type" => written(body),
        Some((kind, body)) if kind == "const" => text(&body["expr"]).to_owned(),
        Some((_, body)) => text(body).to_owned(),
        None => text(argument).to_owned(),
    });
    let constraints = list(&of["constraints"]).map(|constraint| {
        let binding = &constraint["binding"];
        let name = text(&constraint["name"]);
        match binding.get("equality") {
            Some(equal) => format!("{name} = {}", written(equal.get("type").unwrap_or(equal))),
            None => format!("{name}{}", bounds(&binding["constraint"], ": ")),
        }
    });
    let all = joined(arguments.chain(constraints), ", ");
    if all.is_empty() { all } else { format!("<{all}>") }
}

fn returned(output: &Value) -> String {
    if output.is_null() { String::new() } else { format!(" -> {}", written(output)) }
}

fn bound(of: &Value) -> String {
    if let Some(lifetime) = of["outlives"].as_str() {
        return lifetime.to_owned();
    }
    let of = &of["trait_bound"];
    let maybe = if of["modifier"] == "maybe" { "?" } else { "" };
    format!("{maybe}{}{}", last(&of["trait"]["path"]), arguments(&of["trait"]["args"]))
}

/// Bounds behind `before`, if there are any.
pub(crate) fn bounds(of: &Value, before: &str) -> String {
    let all = joined(list(of).map(bound), " + ");
    if all.is_empty() { all } else { format!("{before}{all}") }
}

/// The parameters of an item in angle brackets, without those that stand for an `impl Trait`.
pub(crate) fn generics(of: &Value) -> String {
    let parameters = list(&of["params"]).filter(|parameter| parameter["kind"]["type"]["is_synthetic"] != true);
    let parameters = parameters.map(|parameter| {
        let (name, kind) = (text(&parameter["name"]), &parameter["kind"]);
        match kind.get("const") {
            Some(of) => format!("const {name}: {}", written(&of["type"])),
            None => format!("{name}{}", bounds(&kind["type"]["bounds"], ": ")),
        }
    });
    let all = joined(parameters, ", ");
    if all.is_empty() { all } else { format!("<{all}>") }
}

/// The conditions of an item.
pub(crate) fn where_clause(of: &Value) -> String {
    let conditions = list(&of["where_predicates"]).map(|condition| match condition.get("bound_predicate") {
        Some(of) => format!("{}{}", written(&of["type"]), bounds(&of["bounds"], ": ")),
        None => condition.to_string(),
    });
    let all = joined(conditions, ", ");
    if all.is_empty() { all } else { format!(" where {all}") }
}

/// A function of that path.
pub(crate) fn function(path: &str, body: &Value) -> String {
    let header = &body["header"];
    let words = [("is_const", "const "), ("is_async", "async "), ("is_unsafe", "unsafe ")];
    let words: String = words.into_iter().filter(|(key, _)| header[*key] == true).map(|(_, word)| word).collect();
    let inputs = list(&body["sig"]["inputs"]).map(|input| match (text(&input[0]), written(&input[1])) {
        ("self", of) if of == "Self" => "self".to_owned(),
        ("self", of) if of.starts_with('&') && of.ends_with("Self") => of.replace("Self", "self"),
        (name, of) => format!("{name}: {of}"),
    });
    let (inputs, output) = (joined(inputs, ", "), returned(&body["sig"]["output"]));
    let of = &body["generics"];
    format!("{words}fn {path}{}({inputs}){output}{}", generics(of), where_clause(of))
}
