//! JSON values with their path in the document, which faults show as the position.

use crate::mesh_file::fault::{MeshFault, shown};
use serde_json::{Map, Value};
use std::fmt::{self, Write};

/// A JSON value and its path in the document.
#[derive(Clone, Copy)]
pub(super) struct Json<'a> {
    value: &'a Value,
    path: JsonPath<'a>,
}

/// A path in a JSON document, such as `meshes[2].primitives`. Steps after the sixth are dropped.
///
/// An array needs no allocation, which matters because a path is extended for every value but shown only in a fault.
/// The deepest values that are read are fields of
/// `materials[0].pbrMetallicRoughness.baseColorTexture.extensions.X`.
#[derive(Clone, Copy)]
struct JsonPath<'a> {
    steps: [Option<JsonStep<'a>>; 6],
}

#[derive(Clone, Copy)]
enum JsonStep<'a> {
    Field(&'a str),
    Item(usize),
}

impl<'a> JsonPath<'a> {
    fn with_step(mut self, step: JsonStep<'a>) -> Self {
        if let Some(free) = self.steps.iter_mut().find(|step| step.is_none()) {
            *free = Some(step);
        }
        self
    }
}

impl fmt::Display for JsonPath<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.steps.iter().flatten().enumerate() {
            match step {
                JsonStep::Item(index) => write!(f, "[{index}]")?,
                JsonStep::Field(name) if i == 0 => f.write_str(name)?,
                JsonStep::Field(name) => write!(f, ".{name}")?,
            }
        }
        Ok(())
    }
}

impl<'a> Json<'a> {
    pub(super) fn root(value: &'a Value) -> Result<Self, MeshFault> {
        let root = Self { value, path: JsonPath { steps: [None; 6] } };
        root.object().map(|_| root)
    }

    /// Returns a fault whose message starts with this value's path.
    #[cold]
    pub(super) fn fault(self, message: impl fmt::Display) -> MeshFault {
        let mut text = self.path.to_string();
        if !text.is_empty() {
            text.push_str(": ");
        }
        // The result is ignored because writing to a string cannot fail.
        let _ = write!(text, "{message}");
        MeshFault::of_file(text)
    }

    #[cold]
    fn mismatch(self, wanted: &str) -> MeshFault {
        let found = match self.value {
            Value::Null => "null".to_owned(),
            Value::Bool(value) => value.to_string(),
            Value::Number(number) => number.to_string(),
            Value::String(string) => shown(string.as_bytes()),
            Value::Array(_) => "a list".to_owned(),
            Value::Object(_) => "an object".to_owned(),
        };
        self.fault(format!("expected {wanted}, found {found}"))
    }

    fn object(self) -> Result<&'a Map<String, Value>, MeshFault> {
        self.value.as_object().ok_or_else(|| self.mismatch("an object"))
    }

    /// Returns the field `name` of this object, if it exists.
    pub(super) fn field(self, name: &'static str) -> Result<Option<Self>, MeshFault> {
        let path = self.path.with_step(JsonStep::Field(name));
        Ok(self.object()?.get(name).map(|value| Self { value, path }))
    }

    /// Returns the field `name` of this object; a fault if it is missing.
    pub(super) fn required(self, name: &'static str) -> Result<Self, MeshFault> {
        self.field(name)?.ok_or_else(|| self.fault(format!("the field {name} is missing")))
    }

    /// Returns the extension `name` of this value, if it has it.
    ///
    /// An extension that is not an object is ignored, and counted by [`count_faulty_extensions`].
    pub(super) fn extension(self, name: &'static str) -> Result<Option<Self>, MeshFault> {
        let is_object = |json: &Self| json.value.is_object();
        let Some(extensions) = self.field("extensions")?.filter(is_object) else { return Ok(None) };
        Ok(extensions.field(name)?.filter(is_object))
    }

    /// Returns the items of the list in the field `name`; no items if the field is missing.
    pub(super) fn list(self, name: &'static str) -> Result<impl Iterator<Item = Self> + use<'a>, MeshFault> {
        let list = self.field(name)?;
        let items = list.map_or(Ok(&[][..]), Self::items)?;
        Ok(items.iter().enumerate().filter_map(move |(i, value)| {
            list.map(|list| Self { value, path: list.path.with_step(JsonStep::Item(i)) })
        }))
    }

    fn items(self) -> Result<&'a [Value], MeshFault> {
        self.value.as_array().map(Vec::as_slice).ok_or_else(|| self.mismatch("a list"))
    }

    /// Returns the number of items of the list in the field `name`; 0 if the field is missing.
    pub(super) fn list_len(self, name: &'static str) -> Result<usize, MeshFault> {
        self.field(name)?.map_or(Ok(0), |list| list.items().map(<[Value]>::len))
    }

    /// Resolves this value as an index into the list `name` of the root object. Returns the index
    /// and the item.
    pub(super) fn item_of(self, root: Json<'a>, name: &'static str) -> Result<(usize, Self), MeshFault> {
        let index = self.index()?;
        let list = root.field(name)?;
        let items = list.map_or(Ok(&[][..]), Self::items)?;
        let count = items.len();
        let missing = || self.fault(format!("{name}[{index}] does not exist: the file has {count}"));
        let value = items.get(index).ok_or_else(missing)?;
        let path = root.path.with_step(JsonStep::Field(name)).with_step(JsonStep::Item(index));
        Ok((index, Self { value, path }))
    }

    /// Returns the value as a non-negative integer.
    pub(super) fn index(self) -> Result<usize, MeshFault> {
        // In JSON, 1.0 is the same number as 1. Up to 2^53 the conversion is exact.
        let whole = |number: f64| (number.fract() == 0.0 && (0.0..=9e15).contains(&number)).then_some(number as u64);
        let number = self.value.as_u64().or_else(|| self.value.as_f64().and_then(whole));
        let number = number.and_then(|number| usize::try_from(number).ok());
        number.ok_or_else(|| self.mismatch("a whole number that is not negative"))
    }

    /// Returns the field `name` as a non-negative integer, or `default` if it is missing.
    pub(super) fn index_or(self, name: &'static str, default: usize) -> Result<usize, MeshFault> {
        self.field(name)?.map_or(Ok(default), Self::index)
    }

    pub(super) fn string(self) -> Result<&'a str, MeshFault> {
        self.value.as_str().ok_or_else(|| self.mismatch("a string"))
    }

    pub(super) fn is_true(self, name: &'static str) -> Result<bool, MeshFault> {
        let Some(field) = self.field(name)? else { return Ok(false) };
        field.value.as_bool().ok_or_else(|| field.mismatch("true or false"))
    }

    pub(super) fn number(self) -> Result<f64, MeshFault> {
        self.value.as_f64().filter(|number| number.is_finite()).ok_or_else(|| self.mismatch("a finite number"))
    }

    /// Returns the field `name` as a list of numbers; empty if it is missing.
    pub(super) fn any_numbers(self, name: &'static str) -> Result<Vec<f64>, MeshFault> {
        self.list(name)?.map(Self::number).collect()
    }

    /// Returns the field `name` as exactly `N` numbers; `None` if it is missing.
    pub(super) fn numbers<const N: usize>(self, name: &'static str) -> Result<Option<[f64; N]>, MeshFault> {
        let Some(list) = self.field(name)? else { return Ok(None) };
        let wanted = || list.fault(format!("expected {N} numbers"));
        let items: &[Value; N] = list.items()?.try_into().map_err(|_| wanted())?;
        let mut numbers = [0.0; N];
        for (number, value) in numbers.iter_mut().zip(items) {
            *number = Self { value, ..list }.number()?;
        }
        Ok(Some(numbers))
    }
}

/// Returns the number of extensions in a document that are not objects, and of fields `extensions`.
///
/// [`Json::extension`] ignores them.
pub(super) fn count_faulty_extensions(document: &Value) -> usize {
    match document {
        Value::Array(items) => items.iter().map(count_faulty_extensions).sum(),
        Value::Object(fields) => fields.iter().map(|(name, value)| count_faulty_extensions_of(name, value)).sum(),
        _ => 0,
    }
}

/// Returns the number of faulty extensions in the field of an object.
// No deep recursion: the parser refuses documents that are nested more than 127 levels deep.
fn count_faulty_extensions_of(name: &str, value: &Value) -> usize {
    match (name, value) {
        // Programs write there what they like.
        ("extras", _) => 0,
        ("extensions", Value::Object(extensions)) => {
            let is_faulty = |value: &&Value| !value.is_object();
            extensions.values().filter(is_faulty).count() + count_faulty_extensions(value)
        }
        ("extensions", _) => 1,
        _ => count_faulty_extensions(value),
    }
}
