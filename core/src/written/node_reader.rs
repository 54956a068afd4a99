//! The reader of typed values from nodes of the syntax tree.

use super::{Spanned, WrittenNumber, WrittenVector};
use crate::checks;
use crate::progress::Reporter;
use crate::scene_text::{Body, Faults, Field, Group, Name, Span, SyntaxNode, Value, clipped, quoted};
use crate::text::{closest, listed};

/// A reader of typed values that reports faults and continues.
pub struct NodeReader<'f> {
    faults: &'f mut Faults,
    reporter: &'f Reporter<'f>,
}

/// The fields of a group, found by name.
pub struct Fields<'n> {
    entries: &'n [Field<'n>],
    /// The group's owner for messages: "a Sphere".
    owner: &'static str,
    /// The span at which missing fields are reported.
    head: Span,
    /// The fields that are given under a misspelt name, and so are not reported as missing.
    misspelt: Vec<&'static str>,
}

impl<'n> Fields<'n> {
    /// Returns the first field called `name` in the group.
    pub(crate) fn field(&self, name: &str) -> Option<&'n Field<'n>> {
        self.entries.iter().find(|field| field.name.text == name)
    }

    /// Returns the value of the field called `name`.
    pub(crate) fn get(&self, name: &str) -> Option<&'n SyntaxNode<'n>> {
        self.field(name).map(|field| &field.value)
    }

    /// Returns the span of the name before the fields, for faults of the whole group.
    pub(crate) fn head(&self) -> Span {
        self.head
    }

    /// Returns whether the field is given, under its name or a misspelt one.
    pub(crate) fn is_given_or_misspelt(&self, name: &str) -> bool {
        self.misspelt.contains(&name) || self.field(name).is_some()
    }
}

impl<'f> NodeReader<'f> {
    pub(crate) fn new(faults: &'f mut Faults, reporter: &'f Reporter<'f>) -> Self {
        Self { faults, reporter }
    }

    pub(crate) fn fault(&mut self, span: Span, message: impl FnOnce() -> String) {
        self.faults.add(span, message);
    }

    /// Reports a value of the wrong type; `wanted` describes the right one.
    pub(crate) fn mismatch(&mut self, node: &SyntaxNode<'_>, wanted: &str) {
        self.fault(node.span, || format!("expected {wanted}, found {}", description(node)));
    }

    // Groups ------------------------------------------------------------------------------------------------------

    /// Returns the fields of a node, and reports those that are not in `known` or are given twice.
    ///
    /// `owner` is the name of the value with an article, and `form` its full form, for messages.
    pub(crate) fn fields<'n>(
        &mut self,
        node: &'n SyntaxNode<'n>,
        owner: &'static str,
        form: &str,
        known: &[&'static str],
    ) -> Option<Fields<'n>> {
        let Value::Group(group) = &node.value else {
            self.mismatch(node, form);
            return None;
        };
        let entries: &[_] = match &group.body {
            Body::Fields(entries) => entries,
            Body::Values(values) if values.is_empty() => &[],
            other => {
                let found = if *other == Body::Nothing { "none" } else { "values without names" };
                self.fault(node.head(), || format!("expected fields, as in {form}; found {found}"));
                return None;
            }
        };
        Some(Fields { entries, owner, head: node.head(), misspelt: self.check_names(entries, owner, known) })
    }

    /// Reports unknown and duplicate fields, and returns the fields that the unknown ones were
    /// probably meant to be.
    fn check_names(&mut self, entries: &[Field<'_>], owner: &str, known: &[&'static str]) -> Vec<&'static str> {
        let mut seen = vec![false; known.len()];
        let mut misspelt = Vec::new();
        for Field { name, .. } in entries {
            match known.iter().position(|&known| known == name.text) {
                // The suggestion is stored, so that a misspelt required field is not reported as missing as well.
                None => self.fault(name.span, || {
                    let meant = meant_field(name.text, known);
                    misspelt.extend(meant);
                    unknown_field_message(name.text, meant, owner, known)
                }),
                Some(i) if seen[i] => self.fault(name.span, || format!("duplicate field \"{}\"", name.text)),
                Some(i) => seen[i] = true,
            }
        }
        misspelt
    }

    /// Reads a required field, and reports it if it is missing.
    pub(crate) fn required<T>(
        &mut self,
        fields: &Fields<'_>,
        name: &str,
        read: impl FnOnce(&mut Self, &SyntaxNode<'_>) -> Option<T>,
    ) -> Option<T> {
        let Some(node) = fields.get(name) else {
            // A field with a misspelt name has been reported already.
            if !fields.is_given_or_misspelt(name) {
                let owner = fields.owner;
                self.fault(fields.head, || format!("missing field \"{name}\"; {owner} needs one"));
            }
            return None;
        };
        read(self, node)
    }

    /// Reads an optional field, where `None` in the file means the same as leaving it out.
    pub(crate) fn optional<T>(
        &mut self,
        fields: &Fields<'_>,
        name: &str,
        read: impl FnOnce(&mut Self, &SyntaxNode<'_>) -> Option<T>,
    ) -> Option<T> {
        let node = fields.get(name)?;
        // Files written by serde have `None` for absent values.
        if is_word(node, "None") {
            return None;
        }
        read(self, node)
    }

    /// Reads an optional field in which the word `None` is a value, not the absence of one.
    pub(crate) fn optional_keeping_none<T>(
        &mut self,
        fields: &Fields<'_>,
        name: &str,
        read: impl FnOnce(&mut Self, &SyntaxNode<'_>) -> Option<T>,
    ) -> Option<T> {
        read(self, fields.get(name)?)
    }

    /// Reads the name of a group, which must be one of `known`.
    ///
    /// `kind` and `form` describe the value in messages.
    pub(crate) fn group_name<'n>(
        &mut self,
        node: &'n SyntaxNode<'n>,
        kind: &str,
        form: &str,
        known: &[&'static str],
    ) -> Option<&'static str> {
        let Value::Group(group) = &node.value else {
            self.mismatch(node, form);
            return None;
        };
        let Some(name) = group.name else {
            self.fault(node.head(), || format!("expected {form}, found (...) without a name before it"));
            return None;
        };
        let found = known.iter().copied().find(|&known| known == name.text);
        if found.is_none() {
            self.fault(name.span, || unknown_variant_message(name, kind, known));
        }
        found
    }

    /// Reads one of the words in `all`, and returns its value.
    ///
    /// `kind` describes the words in messages.
    pub(crate) fn choice<T: Copy>(
        &mut self,
        node: &SyntaxNode<'_>,
        kind: &str,
        all: &[(&'static str, T)],
    ) -> Option<T> {
        let words: Vec<_> = all.iter().map(|&(word, _)| word).collect();
        let wanted = format!("{kind} ({})", listed(&words).replace(" and ", " or "));
        match &node.value {
            Value::Group(group) => match (&**group, group.name) {
                (Group { body: Body::Nothing, .. }, Some(_)) => {
                    let word = self.group_name(node, kind, &wanted, &words)?;
                    return all.iter().find(|(known, _)| *known == word).map(|&(_, value)| value);
                }
                _ => self.mismatch(node, &wanted),
            },
            // Quotes are the most likely mistake, so they have a separate message.
            Value::String(string) if words.contains(&&**string) => {
                self.fault(node.span, || format!("expected {wanted}; write {string} without quotes"));
            }
            _ => self.mismatch(node, &wanted),
        }
        None
    }

    /// Returns the values of all items that can be read; fewer if the reporter is cancelled.
    pub(crate) fn read_all<'n, T>(
        &mut self,
        items: &'n [SyntaxNode<'n>],
        read: impl Fn(&mut Self, &'n SyntaxNode<'n>) -> Option<T>,
    ) -> Vec<T> {
        let reporter = self.reporter;
        items.iter().take_while(|_| !reporter.is_cancelled()).filter_map(|item| read(self, item)).collect()
    }

    /// Returns the items of `[...]`, or of `(...)` without names; other values are reported.
    pub(crate) fn list<'n>(&mut self, node: &'n SyntaxNode<'n>, wanted: &str) -> Option<&'n [SyntaxNode<'n>]> {
        if let Some(items) = values(node) {
            return Some(items);
        }
        if matches!(&node.value, Value::Group(group) if group.name.is_some()) {
            let message = || format!("expected {wanted}, found {}; put it in brackets [...]", description(node));
            self.fault(node.head(), message);
        } else {
            self.fault(node.head(), || format!("expected {wanted}, found {}", description(node)));
        }
        None
    }

    // Values --------------------------------------------------------------------------------------------------------

    pub(crate) fn boolean(&mut self, node: &SyntaxNode<'_>) -> Option<bool> {
        if let Value::Bool(value) = node.value {
            return Some(value);
        }
        self.mismatch(node, "true or false");
        None
    }

    /// Reads a quoted string. `wanted` describes it in the message of a fault.
    pub(crate) fn text(&mut self, node: &SyntaxNode<'_>, wanted: &str) -> Option<Spanned<String>> {
        let Value::String(text) = &node.value else {
            self.mismatch(node, wanted);
            return None;
        };
        Some(Spanned { value: text.to_string(), span: node.span })
    }

    /// Reads a finite number.
    pub(crate) fn number(&mut self, node: &SyntaxNode<'_>) -> Option<WrittenNumber> {
        let Value::Number(value) = node.value else {
            self.mismatch(node, "a number");
            return None;
        };
        match checks::finite(value) {
            Ok(value) => Some(Spanned { value, span: node.span }),
            Err(message) => {
                self.fault(node.span, || message.into_owned());
                None
            }
        }
    }

    pub(crate) fn point(&mut self, node: &SyntaxNode<'_>) -> Option<WrittenVector> {
        self.vector(node, "a point (x, y, z)")
    }

    pub(crate) fn direction(&mut self, node: &SyntaxNode<'_>) -> Option<WrittenVector> {
        self.vector(node, "a direction (x, y, z)")
    }

    /// Reads the two edges of a parallelogram, and returns them with their span.
    pub(crate) fn two_edges(&mut self, node: &SyntaxNode<'_>) -> Option<([WrittenVector; 2], Span)> {
        let Some(items) = values(node).filter(|items| items.len() == 2) else {
            self.mismatch(node, "two edges [(x, y, z), (x, y, z)]");
            return None;
        };
        let edges = self.read_all(items, Self::direction);
        Some((edges.try_into().ok()?, node.span))
    }

    fn vector(&mut self, node: &SyntaxNode<'_>, wanted: &str) -> Option<WrittenVector> {
        let components = self.numbers(node, wanted)?;
        Some(WrittenVector { components, span: node.span })
    }

    /// Reads exactly `N` numbers in parentheses or brackets.
    pub(crate) fn numbers<const N: usize>(
        &mut self,
        node: &SyntaxNode<'_>,
        wanted: &str,
    ) -> Option<[WrittenNumber; N]> {
        let Some(items) = values(node).filter(|items| items.len() == N) else {
            self.mismatch(node, wanted);
            return None;
        };
        // Reads all numbers before a fault ends the function, so that each fault is reported.
        let read: Vec<_> = items.iter().map(|item| self.number(item)).collect();
        let numbers: Option<Vec<_>> = read.into_iter().collect();
        numbers?.try_into().ok()
    }
}

/// Returns the values of `[...]` or of `(...)` without names, or `None` for other nodes.
pub(crate) fn values<'n>(node: &'n SyntaxNode<'n>) -> Option<&'n [SyntaxNode<'n>]> {
    match &node.value {
        Value::List(items) => Some(items),
        Value::Group(group) => match &**group {
            Group { name: None, body: Body::Values(items) } => Some(items),
            _ => None,
        },
        _ => None,
    }
}

fn is_word(node: &SyntaxNode<'_>, word: &str) -> bool {
    matches!(&node.value, Value::Group(group)
        if group.body == Body::Nothing && group.name.is_some_and(|name| name.text == word))
}

/// Returns the field that an unknown name was probably meant to be.
///
/// Its name has a similar spelling, or is called `name` in other programs.
fn meant_field(name: &str, known: &[&'static str]) -> Option<&'static str> {
    const ALSO_CALLED: [(&str, &str); 13] = [
        ("look_at", "target"),
        ("lookat", "target"),
        ("from", "eye"),
        ("position", "eye"),
        ("position", "center"),
        ("start", "from"),
        ("end", "to"),
        ("thickness", "tube_radius"),
        ("tube", "tube_radius"),
        ("power", "intensity"),
        ("color", "material"),
        ("color", "reflectance"),
        ("ior", "index"),
    ];
    // A name of three letters or more may be an abbreviation, such as `pos` for `position`. Shorter ones fit too many
    // names.
    let longer = || known.iter().find(|known| name.len() >= 3 && known.starts_with(name)).copied();
    closest(name, known.iter().copied()).or_else(longer).or_else(|| {
        let meant = ALSO_CALLED.iter().filter(|(other, _)| *other == name).map(|&(_, meant)| meant);
        meant.into_iter().find(|meant| known.contains(meant))
    })
}

fn unknown_field_message(name: &str, meant: Option<&str>, owner: &str, known: &[&str]) -> String {
    let unknown = format!("unknown field {}", quoted(name));
    match meant {
        Some(meant) => format!("{unknown}; did you mean \"{meant}\"?"),
        None if known.len() == 1 => format!("{unknown}; {owner} has only {}", listed(known)),
        None => format!("{unknown}; {owner} has {}", listed(known)),
    }
}

fn unknown_variant_message(name: Name<'_>, kind: &str, known: &[&str]) -> String {
    let unknown = format!("{} is not {kind}", clipped(name.text));
    match (closest(name.text, known.iter().copied()), known) {
        (Some(meant), _) => format!("{unknown}; did you mean {meant}?"),
        (None, [only]) => format!("{unknown}; there is only {only}"),
        (None, _) => format!("{unknown}; there are {}", listed(known)),
    }
}

/// Returns the description of a node for a message about a value of the wrong type.
pub(crate) fn description(node: &SyntaxNode<'_>) -> String {
    match &node.value {
        Value::Bool(value) => value.to_string(),
        Value::Number(_) => "a number".to_owned(),
        Value::String(string) => format!("the string {}", quoted(string)),
        Value::List(items) => group_of_values(items, "a list of"),
        Value::Map(_) => "a map {...}".to_owned(),
        Value::Group(group) => match (group.name, &group.body) {
            (Some(name), Body::Nothing) => format!("the word {}", clipped(name.text)),
            (Some(name), _) => format!("{}(...)", clipped(name.text)),
            (None, Body::Values(items)) => group_of_values(items, "a group of"),
            (None, _) => "a group of named fields".to_owned(),
        },
    }
}

/// Returns the description of values in brackets for a message, such as "3 numbers".
pub(crate) fn group_of_values(items: &[SyntaxNode<'_>], a_group_of: &str) -> String {
    let numbers = items.iter().all(|item| matches!(item.value, Value::Number(_)));
    match (items.len(), numbers) {
        (0, _) => "nothing in brackets".to_owned(),
        (1, true) => "1 number in brackets".to_owned(),
        (n, true) => format!("{n} numbers"),
        (1, false) => format!("{a_group_of} 1 value"),
        (n, false) => format!("{a_group_of} {n} values"),
    }
}
