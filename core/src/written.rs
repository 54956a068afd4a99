//! Values as written in a file, each with its span: reading from the syntax tree, and checking.
//!
//! A [`NodeReader`] continues after a fault, so that one run reports all faults. A value that is missing or has a fault
//! is `None`, and the fault has been reported. A [`Validator`] makes the checks that types cannot: that a radius is
//! positive, or that a coordinate is small enough for rays to be traced.

mod colors;
mod node_reader;
mod validator;

pub use colors::WrittenColor;
pub use node_reader::{Fields, NodeReader};
pub(crate) use node_reader::{description, group_of_values, values};
pub use validator::{Axis, Validator};

use crate::scene_text::{Span, SyntaxNode};
use std::fmt::Debug;

/// A value and its span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spanned<T> {
    /// The value as written.
    pub value: T,
    /// The range of the value in the text.
    pub span: Span,
}

/// A finite number.
pub type WrittenNumber = Spanned<f64>;

/// Three finite numbers: a point or a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenVector {
    /// The coordinates x, y and z.
    pub components: [WrittenNumber; 3],
    /// The range of the whole vector in the text.
    pub span: Span,
}

/// A type whose values are a name with fields in a scene file: `Sphere(center: ..., radius: ...)`.
pub trait InSceneFile {
    /// The type of the value as written.
    type Written: Clone + Debug + PartialEq;

    /// The name before the fields: "Sphere".
    const NAME: &'static str;

    /// The name of the kind of value with an article, for messages: "a Sphere".
    const OWNER: &'static str;

    /// The full form for messages: "Sphere(center: ..., radius: ...)".
    const FORM: &'static str;

    /// The names of the fields; for a surface, without those of every object, such as `material`.
    const FIELDS: &'static [&'static str];

    /// A sentence that says what the value is.
    const SUMMARY: &'static str;

    /// The meaning of each field, with its default after a semicolon, in the order of
    /// [`FIELDS`](Self::FIELDS).
    const MEANINGS: &'static [&'static str];

    /// Reads the value from its fields.
    fn read(reader: &mut NodeReader<'_>, fields: &Fields<'_>) -> Self::Written;

    /// Reads the value from its node, which is its name with the group of fields.
    fn read_node(reader: &mut NodeReader<'_>, node: &SyntaxNode<'_>) -> Option<Self::Written> {
        let fields = reader.fields(node, Self::OWNER, Self::FORM, Self::FIELDS)?;
        Some(Self::read(reader, &fields))
    }
}

/// An entry of the reference: a value with fields.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceEntry {
    /// The name: "Sphere".
    pub name: &'static str,
    /// The form with all required fields: "Sphere(center: ..., radius: ...)".
    pub form: &'static str,
    /// A sentence that says what the value is.
    pub summary: &'static str,
    /// The names of the fields.
    pub fields: &'static [&'static str],
    /// The meanings of the fields, each with the field's default after a semicolon.
    pub meanings: &'static [&'static str],
}

impl ReferenceEntry {
    /// Returns the entry of a type.
    pub(crate) const fn of<T: InSceneFile>() -> Self {
        Self { name: T::NAME, form: T::FORM, summary: T::SUMMARY, fields: T::FIELDS, meanings: T::MEANINGS }.checked()
    }

    /// Returns the entry; does not compile for a constant in which a field has no meaning.
    pub(crate) const fn checked(self) -> Self {
        assert!(self.fields.len() == self.meanings.len(), "each field has a meaning");
        self
    }
}
